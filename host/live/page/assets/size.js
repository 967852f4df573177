// At most 640 x 480 pixels, or 480 x 640 for a picture that stands upright.
function fitted(width, height) {
  const [long, short] = [Math.max(width, height), Math.min(width, height)];
  const scale = Math.min(1, 640 / long, 480 / short);
  return [Math.max(1, Math.floor(width * scale)), Math.max(1, Math.floor(height * scale))];
}
