// One run after the other: a source of pictures, the tracker, and what is drawn of both.
const SHOWN_EVERY_MS = 200;
// Numbers with so many digits; a joint behind the camera has no pixel.
const rounded = (numbers, digits) => (numbers.every(Number.isFinite) ? numbers.map((number) => number.toFixed(digits)).join(', ') : '–');

class App {
  constructor(tracker, scene, recording) {
    Object.assign(this, { tracker, scene, recording, source: null, shoulder: null, run: 0 });
    this.work = hiddenCanvas(640, 480);
    this.context = this.work.getContext('2d', { willReadFrequently: true });
    this.mask = hiddenCanvas(640, 480);
    this.view = element('view').getContext('2d');
    this.pointer = watchPointer(element('view'), () => element('mirror').checked, (u, v) => this.click(u, v));
  }

  // Stops what runs and starts what `open` gives; `trouble` names the notice if it gives nothing.
  async play(open, trouble) {
    this.stop();
    clearNotices();
    const run = ++this.run;
    const asked = performance.now();
    try {
      const source = await open();
      if (run !== this.run) return source.stop();
      this.#start(source, asked);
    } catch (error) {
      if (run === this.run) this.trouble(trouble(error));
    }
  }

  #start(source, asked) {
    this.#fit(source);
    Object.assign(this, { source, asked, firstMs: null, timing: new Timing(), shownMs: 0, error: null });
    this.setMirror(source.mirror);
    this.shoulder = null;
    if (source.name === 'scene') this.#knowScene(source.scene);
    element('stop').disabled = false;
    this.#press(source.name);
    this.begin();
    source.start((picture, timeUs, about) => this.#guarded(() => this.frame(picture, timeUs, about)));
  }

  // A module that has trapped answers nothing more.
  #guarded(work) {
    try {
      work();
    } catch (error) {
      if (!this.tracker || !(error instanceof WebAssembly.RuntimeError)) throw error;
      this.tracker = null;
      this.trouble('tracker-stopped');
    }
  }

  // Makes room for the source's pictures; whether that has changed anything.
  #fit(source) {
    const [width, height] = fitted(source.width, source.height);
    if (this.work.width === width && this.work.height === height) return false;
    for (const canvas of [this.work, this.mask, element('view')]) Object.assign(canvas, { width, height });
    return true;
  }

  // The person of the built-in scene is known.
  #knowScene({ shoulder, distance }) {
    this.shoulder = shoulder;
    setDistance(distance);
    setSide('right');
  }

  stop() {
    this.run += 1;
    this.source?.stop();
    this.source = null;
    element('stop').disabled = true;
    this.#press(null);
  }

  trouble(name) {
    this.stop();
    notice(name, () => this.playScene());
  }

  playScene() {
    return this.play(async () => {
      const source = new SceneSource(this.scene);
      await source.open();
      return source;
    }, () => 'video-unplayable');
  }

  // The tracker begins anew with what is chosen now.
  begin() {
    if (!this.source) return;
    this.engine = this.tracker ?? this.recording;
    this.engine.begin({ width: this.work.width, height: this.work.height, shoulder: this.shoulder, ...settings() });
    this.errors = [];
  }

  frame(picture, timeUs, about) {
    const clock = [performance.now()];
    // A telephone that is turned gives pictures of another size, in which the shoulder is elsewhere.
    const isTurned = this.#fit(this.source);
    if (isTurned) this.shoulder = null;
    if (isTurned || about.isFirst) this.begin();
    const { width, height } = this.work;
    this.context.drawImage(picture, 0, 0, width, height);
    const pixels = this.context.getImageData(0, 0, width, height);
    clock.push(performance.now());
    this.engine.see(pixels.data, about.number);
    clock.push(performance.now());
    const answer = this.engine.track(timeUs);
    clock.push(performance.now());
    this.answer = answer;
    if (answer.status === 'tracking') this.firstMs ??= clock[3] - this.asked;
    this.#draw(answer, about.truth);
    clock.push(performance.now());
    const [begun, taken, seen, tracked, drawn] = clock;
    const milliseconds = { picture: taken - begun, vision: seen - taken, tracker: tracked - seen, drawing: drawn - tracked };
    this.timing.add(begun, milliseconds);
    this.#show(answer, about.truth, drawn);
    const detail = { source: this.source.name, pixels, timeUs, answer, milliseconds, number: about.number, firstMs: this.firstMs };
    document.dispatchEvent(new CustomEvent('sinew-frame', { detail }));
  }

  #draw(answer, truth) {
    const canSkin = isShown('skin') && this.engine.skin;
    if (canSkin) this.mask.getContext('2d').putImageData(this.engine.skin(), 0, 0);
    this.view.drawImage(this.work, 0, 0);
    drawOverlay(this.view, {
      skin: canSkin ? this.mask : null,
      blobs: isShown('blobs') ? this.engine.blobs() : null,
      particles: isShown('particles') && this.engine.particles ? this.engine.particles() : null,
      answer: { ...answer, drawn: isShown('arm') },
      truth,
      pointer: this.pointer.at,
    });
  }

  #show(answer, truth, now) {
    if (truth) this.errors.push(Math.hypot(answer.hand[0] - truth[0], answer.hand[1] - truth[1]));
    if (now - this.shownMs < SHOWN_EVERY_MS) return;
    this.shownMs = now;
    const rows = { status: answer.status, 'hand, pixels': rounded(answer.hand, 0) };
    if (answer.handM) rows['hand, metres'] = rounded(answer.handM, 2);
    rows[answer.head ? 'places' : 'blobs'] = String(this.engine.blobs().length);
    rows['is a hand'] = `${Math.round(100 * answer.likelihood)} %`;
    if (answer.sampleSize) rows['effective particles'] = answer.sampleSize.toFixed(0);
    rows.face = answer.head ? 'found' : 'none';
    rows.shoulder = this.shoulder ? 'placed' : answer.head ? 'by the face' : 'guessed';
    if (this.firstMs !== null) rows['found after'] = `${(this.firstMs / 1000).toFixed(2)} s`;
    if (this.errors.length) rows['greatest error so far'] = `${((100 * Math.max(...this.errors)) / this.work.width).toFixed(1)} % of the width`;
    showRows(element('answers'), rows);
    showRows(element('timing'), this.timing.rows());
  }

  // A click on the hand teaches its skin, one on the shoulder says where that is.
  click(u, v) {
    if (!this.source || !this.tracker) return;
    try {
      if (chosen('click') === 'hand') {
        this.tracker.calibrate(u, v);
        element('how').textContent = `The skin at ${u}, ${v} was learnt. Reset goes back to the skin of the face, or the usual one.`;
      } else {
        this.shoulder = [u, v];
        this.begin();
        element('how').textContent = `The shoulder is at ${u}, ${v}. Set its distance too.`;
      }
      clearNotices();
    } catch (error) {
      notice('refused', null, error.message);
    }
  }

  reset() {
    if (this.tracker?.width) this.tracker.forgetCalibration();
    this.shoulder = null;
    if (this.source?.name === 'scene') this.#knowScene(this.source.scene);
    this.begin();
    tellHow();
  }

  setMirror(isMirrored) {
    element('mirror').checked = isMirrored;
    element('view').classList.toggle('mirrored', isMirrored);
  }

  #press(name) {
    for (const source of ['camera', 'video', 'scene']) element(`use-${source}`).setAttribute('aria-pressed', String(source === name));
  }
}
