// Clicks in the picture, and the same by keys: arrows move a cross, Enter clicks.
const STEP_PX = 8;

function watchPointer(canvas, isMirrored, onClick) {
  const cross = { at: null };
  const clamped = ([u, v]) => [Math.min(Math.max(u, 0), canvas.width - 1), Math.min(Math.max(v, 0), canvas.height - 1)];
  const click = (at) => onClick(...clamped(at).map(Math.floor));
  canvas.addEventListener('click', (event) => {
    if (event.detail === 0) return;
    const box = canvas.getBoundingClientRect();
    // The picture keeps its shape inside of the element.
    const scale = Math.min(box.width / canvas.width, box.height / canvas.height);
    const u = (event.clientX - box.left - 0.5 * box.width) / scale;
    const v = (event.clientY - box.top - 0.5 * box.height) / scale;
    click([0.5 * canvas.width + (isMirrored() ? -u : u), 0.5 * canvas.height + v]);
  });
  canvas.addEventListener('keydown', (event) => {
    const across = isMirrored() ? -STEP_PX : STEP_PX;
    const move = { ArrowLeft: [-across, 0], ArrowRight: [across, 0], ArrowUp: [0, -STEP_PX], ArrowDown: [0, STEP_PX] }[event.key];
    cross.at ??= [canvas.width >> 1, canvas.height >> 1];
    if (move) cross.at = clamped([cross.at[0] + move[0], cross.at[1] + move[1]]);
    else if (event.key === 'Enter' || event.key === ' ') click(cross.at);
    else if (event.key === 'Escape') cross.at = null;
    else return;
    event.preventDefault();
  });
  canvas.addEventListener('focus', () => {
    if (canvas.matches(':focus-visible')) cross.at ??= [canvas.width >> 1, canvas.height >> 1];
  });
  canvas.addEventListener('blur', () => {
    cross.at = null;
  });
  return cross;
}
