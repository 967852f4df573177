// Frames one after the other: the picture of each run, its skeleton, its numbers; one slider for all runs.

class PlayerView {
  constructor(player, tables) {
    this.player = player;
    this.table = player.table ? tables.get(player.table) : null;
    const block = player.pictures ? document.getElementById(player.pictures) : null;
    this.pictures = block ? JSON.parse(block.textContent) : [];
    this.figures = player.figures.map((figure) => new FigureView(figure, tables));
    this.image = element('img', { alt: 'the frame with what was found drawn on it' });
    this.lack = element('p', { class: 'no-picture' }, 'no picture of this frame');
    this.told = element('div', { class: 'told' });
    const picture = this.pictures.some(Boolean) ? element('div', { class: 'picture' }, this.image, this.lack) : null;
    const figures = this.figures.length ? element('div', { class: 'figures' }, this.figures.map((figure) => figure.node)) : null;
    this.node = element('div', { class: 'player' }, picture, figures, this.told);
  }

  get count() {
    return this.player.frames.length;
  }

  // Shows the `index`-th frame, or the last one; gives its name.
  show(index) {
    const at = Math.min(index, this.count - 1);
    const frame = this.player.frames[at];
    const picture = this.pictures[at];
    this.image.hidden = !picture;
    this.lack.hidden = Boolean(picture);
    if (picture) this.image.src = `data:image/jpeg;base64,${picture}`;
    this.image.dataset.frame = frame;
    for (const figure of this.figures) figure.show(frame);
    this.tell(frame);
    return frame;
  }

  tell(frame) {
    if (!this.table || !this.player.told.length) return;
    const columns = this.player.told.map((name) => [name, this.table.index(name)]).filter(([, index]) => index >= 0);
    const heading = element('tr', {}, columns.map(([name]) => element('th', {}, name)));
    const rows = this.table.rowsOfFrame(frame).map((row) => element('tr', {}, columns.map(([, index]) => element('td', {}, row[index]))));
    this.told.replaceChildren(element('table', {}, heading, rows));
  }
}

// The bar at the foot of the page: play, slider, keys.
class Transport {
  constructor(players, onShow) {
    Object.assign(this, { players, onShow });
    this.count = Math.max(...players.map((player) => player.count));
    this.index = 0;
    this.slider = element('input', { type: 'range', min: 0, max: this.count - 1, value: 0, step: 1, 'aria-label': 'frame' });
    this.slider.addEventListener('input', () => this.go(Number(this.slider.value)));
    this.place = element('span', { class: 'place' });
    this.button = element('button', { class: 'play', title: 'space' }, 'Play');
    this.button.addEventListener('click', () => this.toggle());
    this.node = element('div', { class: 'transport' }, this.button, this.slider, this.place);
    document.addEventListener('keydown', (event) => this.key(event));
  }

  go(index) {
    this.index = Math.min(Math.max(index, 0), this.count - 1);
    this.slider.value = this.index;
    const frames = this.players.map((player) => player.show(this.index));
    const rate = this.rate();
    const time = rate ? `, ${(this.index / rate).toFixed(2)} s` : '';
    const longest = frames[this.players.findIndex((player) => player.count === this.count)];
    this.place.textContent = `frame ${longest} (${this.index + 1} of ${this.count}${time})`;
    this.onShow(frames);
  }

  rate() {
    return this.players.map((player) => player.player.rate_hz).find(Boolean);
  }

  toggle() {
    if (this.timer) {
      clearInterval(this.timer);
      this.timer = null;
    } else {
      if (this.index === this.count - 1) this.go(0);
      const pause = 1000 / Math.min(this.rate() || 15, 30);
      this.timer = setInterval(() => {
        if (this.index === this.count - 1) this.toggle();
        else this.go(this.index + 1);
      }, pause);
    }
    this.button.textContent = this.timer ? 'Pause' : 'Play';
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const inField = event.target !== this.slider && ['INPUT', 'SELECT', 'TEXTAREA'].includes(event.target.tagName);
    const presses = event.key === ' ' && ['BUTTON', 'SUMMARY'].includes(event.target.tagName);
    if (inField || presses) return;
    const step = event.shiftKey ? 10 : 1;
    const actions = {
      ArrowRight: () => this.go(this.index + step),
      ArrowLeft: () => this.go(this.index - step),
      Home: () => this.go(0),
      End: () => this.go(this.count - 1),
      ' ': () => this.toggle(),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  }
}
