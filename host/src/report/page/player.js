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
    this.shown = element('div', { class: 'shown' });
    const picture = this.pictures.some(Boolean) ? element('div', { class: 'picture' }, this.image, this.lack) : null;
    const figures = this.figures.length ? element('div', { class: 'figures' }, this.figures.map((figure) => figure.node)) : null;
    this.node = element('div', { class: 'player' }, picture, figures, this.shown);
  }

  get count() {
    return this.player.frames.length;
  }

  get rate() {
    return this.player.rate_hz;
  }

  // Seconds from the frame numbered 0 to each frame, as plots over time have them.
  times() {
    const numbers = this.player.frames.map(Number);
    return numbers.map((number, index) => (Number.isFinite(number) ? number : index) / this.rate);
  }

  // Shows the `index`-th frame, or the last one; gives its name.
  show(index) {
    const at = Math.min(index, this.count - 1);
    const frame = this.player.frames[at];
    this.frame = frame;
    const picture = this.pictures[at];
    this.image.hidden = !picture;
    this.lack.hidden = Boolean(picture);
    if (picture) this.image.src = `data:image/jpeg;base64,${picture}`;
    this.image.dataset.frame = frame;
    for (const figure of this.figures) figure.show(frame);
    this.showRow(frame);
    return frame;
  }

  showRow(frame) {
    if (!this.table || !this.player.shown.length) return;
    const columns = this.player.shown.map((name) => [name, this.table.index(name)]).filter(([, index]) => index >= 0);
    const heading = element('tr', {}, columns.map(([name]) => element('th', {}, name)));
    const rows = this.table.rowsOfFrame(frame).map((row) => element('tr', {}, columns.map(([, index]) => element('td', {}, row[index]))));
    this.shown.replaceChildren(element('table', {}, heading, rows));
  }
}

// Moments that are no farther apart are one, seconds: a rate's frames are written with so many digits.
const SAME_MOMENT_S = 1e-6;

// All moments at which a run has a frame, seconds, in order.
function moments(times) {
  const all = times.flat().sort((a, b) => a - b);
  return all.filter((time, index) => index === 0 || time - all[index - 1] > SAME_MOMENT_S);
}

// Seconds between two frames that are shown, at least.
const MIN_PAUSE_S = 1 / 30;

// The bar at the foot of the page: play, slider, keys. It goes from frame to frame; where runs have different frame rates, from one moment at
// which a run has a frame to the next.
class Transport {
  constructor(players, onShow) {
    Object.assign(this, { players, onShow });
    const rates = new Set(players.map((player) => player.rate));
    this.isByTime = rates.size > 1 && [...rates].every((rate) => rate > 0);
    this.times = this.isByTime ? players.map((player) => player.times()) : [];
    this.stops = moments(this.times);
    this.count = this.isByTime ? this.stops.length : Math.max(...players.map((player) => player.count));
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
    const frames = this.players.map((player, at) => player.show(this.indexOf(at)));
    this.place.textContent = this.isByTime ? this.moment(frames) : this.number(frames);
    this.onShow();
  }

  // Which frame the `at`-th player shows: the last that there is by now, or the first one.
  indexOf(at) {
    if (!this.isByTime) return this.index;
    const later = this.times[at].findIndex((time) => time > this.stops[this.index] + SAME_MOMENT_S);
    return later < 0 ? this.times[at].length - 1 : Math.max(later - 1, 0);
  }

  // Goes to the `index`-th frame of the `at`-th player.
  goToFrame(at, index) {
    const isThere = (stop) => Math.abs(stop - this.times[at][index]) <= SAME_MOMENT_S;
    this.go(this.isByTime ? this.stops.findIndex(isThere) : index);
  }

  moment(frames) {
    const names = frames.length > 3 ? '' : `, frames ${frames.join(', ')}`;
    return `${this.stops[this.index].toFixed(2)} s (${this.index + 1} of ${this.count}${names})`;
  }

  number(frames) {
    const rate = this.rate();
    const time = rate ? `, ${(this.index / rate).toFixed(2)} s` : '';
    const longest = frames[this.players.findIndex((player) => player.count === this.count)];
    return `frame ${longest} (${this.index + 1} of ${this.count}${time})`;
  }

  rate() {
    return this.players.map((player) => player.rate).find(Boolean);
  }

  // The place after the present one when playing, and the seconds until then.
  next() {
    if (!this.isByTime) return [this.index + 1, Math.max(1 / (this.rate() || 15), MIN_PAUSE_S)];
    const now = this.stops[this.index];
    const later = this.stops.findIndex((stop) => stop >= now + MIN_PAUSE_S - SAME_MOMENT_S);
    const index = later < 0 ? this.count - 1 : later;
    return [index, this.stops[index] - now];
  }

  toggle() {
    if (this.timer) {
      clearTimeout(this.timer);
      this.timer = null;
    } else {
      if (this.index === this.count - 1) this.go(0);
      this.play();
    }
    this.button.textContent = this.timer ? 'Pause' : 'Play';
  }

  play() {
    const [index, pause] = this.next();
    this.timer = setTimeout(() => {
      this.go(index);
      if (this.index === this.count - 1) this.toggle();
      else this.play();
    }, 1000 * pause);
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
