// The WebAssembly module: pictures in, numbers out.
const ANSWER_NUMBERS = 19;
const BLOB_NUMBERS = 7;
const PARTICLE_NUMBERS = 5;
const SEED = 1;

class Tracker {
  // Null where the browser cannot run the module.
  static async load(base64) {
    try {
      const { instance } = await WebAssembly.instantiate(bytesOf(base64));
      return new Tracker(instance.exports);
    } catch {
      return null;
    }
  }

  constructor(module) {
    this.module = module;
  }

  // Begins anew; `choice` has width, height, side, particles, distance and, where it is known, shoulder.
  begin({ width, height, side, particles, distance, shoulder }) {
    const [u, v] = shoulder ?? [NaN, NaN];
    this.#check(this.module.begin(width, height, side === 'left' ? 1 : 0, particles, SEED, distance, u, v));
    [this.width, this.height] = [width, height];
  }

  // Takes a picture's pixels, red, green, blue, opacity, and finds face, blobs and hands.
  see(pixels) {
    new Uint8Array(this.module.memory.buffer, this.module.picture(), pixels.length).set(pixels);
    this.#check(this.module.see());
  }

  // Moves the arm on to the last picture, which was taken at this time, microseconds.
  track(timeUs) {
    this.#check(this.module.track(timeUs));
    return this.#answer();
  }

  calibrate(u, v) {
    this.#check(this.module.calibrate(u, v));
  }

  forgetCalibration() {
    this.#check(this.module.forget_calibration());
  }

  // The last skin mask as a picture.
  skin() {
    const bytes = new Uint8ClampedArray(this.module.memory.buffer, this.module.skin(), 4 * this.width * this.height);
    return new ImageData(bytes.slice(), this.width, this.height);
  }

  // Blobs; the places that may be the tracked hand once a face is known.
  blobs() {
    return this.#rows(this.module.blobs(), this.module.blob_count(), BLOB_NUMBERS)
      .map(([u, v, uu, uv, vv, area, likelihood]) => ({ u, v, uu, uv, vv, area, likelihood }));
  }

  particles() {
    return this.#rows(this.module.particles(), this.module.particle_count(), PARTICLE_NUMBERS)
      .map(([u, v, elbowU, elbowV, weight]) => ({ u, v, elbowU, elbowV, weight }));
  }

  #answer() {
    const n = this.#rows(this.module.answer(), 1, ANSWER_NUMBERS)[0];
    return {
      status: ['tracking', 'predicted', 'lost', 'uncertain'][n[0]],
      shoulder: [n[1], n[2]], elbow: [n[3], n[4]], hand: [n[5], n[6]],
      handM: [n[7], n[8], n[9]], handStdM: n[10], sampleSize: n[11], likelihood: n[12], carrier: n[13], edges: n[14],
      head: Number.isFinite(n[16]) ? { u: n[16], v: n[17], width: n[18] } : null,
    };
  }

  #rows(address, count, numbers) {
    const all = new Float32Array(this.module.memory.buffer, address, count * numbers);
    return Array.from({ length: count }, (_, row) => [...all.subarray(row * numbers, (row + 1) * numbers)]);
  }

  // A call that was refused returns the length of its text.
  #check(length) {
    if (length === 0) return;
    throw new RangeError(new TextDecoder().decode(new Uint8Array(this.module.memory.buffer, this.module.text(), length)));
  }
}
