// Ties the controls to the application.
const HOW = 'Look at the camera: the face gives skin, shoulders and scale. Click on the hand where its skin is not found. Where the arm does not reach the hand, click on the shoulder (chosen at the side) and set its distance. By keys: arrows move a cross in the picture, Enter clicks.';
const data = JSON.parse(element('data').textContent);

function tellHow() {
  element('how').textContent = HOW;
}

async function main() {
  const tracker = await Tracker.load(data.module);
  const app = new App(tracker, data.scene, new Recording(data.scene.frames));
  tellHow();
  tellSettings();
  const playCamera = () => {
    if (!navigator.mediaDevices?.getUserMedia) return app.trouble('camera-insecure');
    return app.play(() => VideoSource.camera(() => app.trouble('camera-gone')), cameraTrouble);
  };
  element('use-camera').addEventListener('click', playCamera);
  element('use-scene').addEventListener('click', () => app.playScene());
  element('use-video').addEventListener('click', () => element('video-file').click());
  element('video-file').addEventListener('change', ({ target }) => {
    const [file] = target.files;
    target.value = '';
    if (file) app.play(() => VideoSource.file(file), () => 'video-unplayable');
  });
  element('stop').addEventListener('click', () => app.stop());
  element('reset').addEventListener('click', () => app.reset());
  element('mirror').addEventListener('change', ({ target }) => app.setMirror(target.checked));
  element('show-timing').addEventListener('change', ({ target }) => {
    element('timing').hidden = !target.checked;
  });
  for (const id of ['particles', 'distance']) element(id).addEventListener('input', tellSettings);
  for (const input of document.querySelectorAll('#particles, #distance, input[name="side"]')) input.addEventListener('change', () => app.begin());
  if (!tracker) {
    for (const id of ['use-camera', 'use-video', 'reset', 'particles', 'distance']) element(id).disabled = true;
    notice('no-webassembly', () => app.playScene());
  }
  document.documentElement.dataset.ready = 'true';
}

main();
