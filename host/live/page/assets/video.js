// Frames of a video element: of a camera or of a file.
class VideoSource {
  constructor(name, mirror) {
    Object.assign(this, { name, mirror, running: false, video: document.createElement('video') });
    Object.assign(this.video, { muted: true, playsInline: true, autoplay: false });
  }

  get width() {
    return this.video.videoWidth;
  }

  get height() {
    return this.video.videoHeight;
  }

  // Calls back for each picture that arrives; those that come while one is being worked on are left out.
  start(onFrame) {
    this.running = true;
    let last = -Infinity;
    const step = (timeMs) => {
      // A file that plays again; the times of a camera may jitter.
      const isFirst = this.name === 'video' && timeMs < last;
      last = timeMs;
      onFrame(this.video, Math.max(0, 1000 * timeMs), { isFirst });
    };
    if (this.video.requestVideoFrameCallback) this.#onVideoFrames(step);
    else this.#onRepaints(step);
  }

  #onVideoFrames(step) {
    const next = (now, { captureTime, mediaTime }) => {
      if (!this.running) return;
      this.video.requestVideoFrameCallback(next);
      step(this.name === 'camera' ? (captureTime ?? now) : 1000 * mediaTime);
    };
    this.video.requestVideoFrameCallback(next);
  }

  #onRepaints(step) {
    let shown = null;
    const next = () => {
      if (!this.running) return;
      requestAnimationFrame(next);
      if (this.video.currentTime === shown) return;
      shown = this.video.currentTime;
      step(1000 * shown);
    };
    requestAnimationFrame(next);
  }

  stop() {
    this.running = false;
    this.video.pause();
    for (const track of this.video.srcObject?.getTracks() ?? []) track.stop();
    if (this.video.src) URL.revokeObjectURL(this.video.src);
    this.video.srcObject = null;
    this.video.removeAttribute('src');
  }

  static async camera(onGone) {
    const source = new VideoSource('camera', true);
    const wanted = { width: { ideal: 640 }, height: { ideal: 480 }, frameRate: { ideal: 30 } };
    const stream = await navigator.mediaDevices.getUserMedia({ video: wanted, audio: false });
    stream.getVideoTracks()[0].addEventListener('ended', onGone);
    source.video.srcObject = stream;
    await source.video.play();
    return source;
  }

  static async file(file) {
    const source = new VideoSource('video', false);
    source.video.loop = true;
    source.video.src = URL.createObjectURL(file);
    await source.video.play();
    if (source.width === 0) throw new Error('no pictures');
    return source;
  }
}
