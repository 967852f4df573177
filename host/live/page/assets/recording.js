// In place of the tracker where there is no WebAssembly: what it made of the built-in scene when the page was built.
class Recording {
  constructor(frames) {
    this.frames = frames;
    this.frame = null;
  }

  begin() {}

  see(_pixels, number) {
    this.frame = this.frames[number];
  }

  track() {
    const { status, joints, likelihood } = this.frame;
    const [shoulder, elbow, hand] = joints;
    return { status, shoulder, elbow, hand, likelihood, carrier: this.frame.carrier };
  }

  blobs() {
    return this.frame.blobs.map(([u, v, uu, uv, vv, area, likelihood]) => ({ u, v, uu, uv, vv, area, likelihood }));
  }
}
