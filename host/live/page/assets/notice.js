// What went wrong, in words, with a way out: the built-in scene.
const REASONS = {
  'no-webassembly': 'This browser cannot run the tracker: it has no WebAssembly with vector instructions, or it is switched off. The built-in scene can be played with what the tracker made of it when the page was built.',
  'no-camera': 'There is no camera. Connect one and press Camera again, choose a video file, or look at the built-in scene.',
  'camera-refused': 'The camera was refused. Allow it for this page in the browser’s address bar and press Camera again, choose a video file, or look at the built-in scene.',
  'camera-busy': 'The camera gives no pictures; another program may be using it. Close that and press Camera again, or look at the built-in scene.',
  'camera-insecure': 'The browser gives cameras only to files and to secure pages. Open this file itself or serve it on localhost, or look at the built-in scene.',
  'camera-gone': 'The camera has stopped. Press Camera to start it again.',
  'video-unplayable': 'This file cannot be played as a video here. Try MP4 (H.264) or WebM, or look at the built-in scene.',
  'tracker-stopped': 'The tracker has stopped by a fault of its own. Load the page again; the built-in scene can be played with what the tracker made of it when the page was built.',
  refused: 'That was refused: ',
};

function clearNotices() {
  element('notices').replaceChildren();
}

// Shows the notice of that name; `more` is added to its text, `playScene` plays the built-in scene.
function notice(name, playScene, more = '') {
  const box = made('div', '', { class: 'notice', 'data-notice': name });
  box.append(made('p', REASONS[name] + more));
  if (playScene) {
    const button = made('button', 'Play the built-in scene');
    button.addEventListener('click', playScene);
    box.append(button);
  }
  element('notices').replaceChildren(box);
}

// Name of the notice for what getUserMedia answered.
function cameraTrouble(error) {
  if (error.name === 'NotFoundError' || error.name === 'OverconstrainedError') return 'no-camera';
  if (error.name === 'NotAllowedError' || error.name === 'SecurityError') return 'camera-refused';
  return 'camera-busy';
}
