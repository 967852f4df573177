// The built-in scene: a still picture and, for each frame, the part of it that differs.
const FRAME_MS = (scene) => 1000 / scene.frames_per_second;

class SceneSource {
  constructor(scene) {
    Object.assign(this, { name: 'scene', scene, width: scene.width, height: scene.height, mirror: false, running: false });
    this.canvas = hiddenCanvas(scene.width, scene.height);
    this.context = this.canvas.getContext('2d');
  }

  async open() {
    const picture = (jpeg) => createImageBitmap(new Blob([bytesOf(jpeg)], { type: 'image/jpeg' }));
    this.still ??= await picture(this.scene.still);
    this.patches ??= await Promise.all(this.scene.frames.map(({ jpeg }) => picture(jpeg)));
  }

  // Every frame comes in its turn; a slow machine shows them slower. After the last one comes the first, as a new beginning.
  start(onFrame) {
    this.running = true;
    let [number, due] = [0, performance.now()];
    const next = (now) => {
      if (!this.running) return;
      if (now >= due) {
        due = Math.max(due + FRAME_MS(this.scene), now - FRAME_MS(this.scene));
        this.#draw(number);
        const { hand } = this.scene.frames[number];
        onFrame(this.canvas, (1e6 * number) / this.scene.frames_per_second, { number, truth: hand, isFirst: number === 0 });
        number = (number + 1) % this.scene.frames.length;
      }
      requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  }

  stop() {
    this.running = false;
  }

  #draw(number) {
    const { x, y } = this.scene.frames[number];
    this.context.drawImage(this.still, 0, 0);
    this.context.drawImage(this.patches[number], x, y);
  }
}
