// Running means of what a frame takes, milliseconds, and of the frames in a second.
class Timing {
  constructor() {
    this.means = {};
    this.last = null;
  }

  add(now, parts) {
    if (this.last !== null) this.#mean('between', now - this.last);
    this.last = now;
    for (const [name, milliseconds] of Object.entries(parts)) this.#mean(name, milliseconds);
  }

  #mean(name, value) {
    const before = this.means[name];
    this.means[name] = before === undefined ? value : before + 0.05 * (value - before);
  }

  rows() {
    const { between, picture = 0, vision = 0, tracker = 0, drawing = 0 } = this.means;
    const length = (milliseconds) => `${milliseconds.toFixed(1)} ms`;
    const rows = { 'taking the picture': length(picture), vision: length(vision), tracker: length(tracker), drawing: length(drawing) };
    return between ? { 'frames a second': (1000 / between).toFixed(1), ...rows } : rows;
  }
}
