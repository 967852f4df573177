// Draws what was found over the picture.
const COLOURS = { blob: '#ffd54a', carrier: '#25e0c8', arm: '#ff5a36', predicted: '#b48cff', particle: '#ffffff', truth: '#ffffff', pointer: '#ffffff', head: '#7fb4ff' };

// The ellipse of a blob's second moments, two standard deviations wide.
function drawBlob(context, blob, isCarrier) {
  const [middle, half] = [0.5 * (blob.uu + blob.vv), 0.5 * (blob.uu - blob.vv)];
  const radius = Math.hypot(half, blob.uv);
  const [long, short] = [middle + radius, Math.max(0, middle - radius)].map((variance) => 2 * Math.sqrt(variance));
  context.beginPath();
  context.ellipse(blob.u, blob.v, long, short, 0.5 * Math.atan2(blob.uv, half), 0, 2 * Math.PI);
  context.globalAlpha = 0.35 + 0.65 * blob.likelihood;
  context.lineWidth = isCarrier ? 3 : 1.5;
  context.strokeStyle = isCarrier ? COLOURS.carrier : COLOURS.blob;
  context.stroke();
  context.globalAlpha = 1;
}

function drawParticles(context, particles) {
  const most = Math.max(...particles.map(({ weight }) => weight), 1e-9);
  context.fillStyle = context.strokeStyle = COLOURS.particle;
  for (const { u, v, elbowU, elbowV, weight } of particles) {
    context.globalAlpha = 0.15 + 0.65 * (weight / most);
    context.lineWidth = 0.6;
    context.beginPath();
    context.moveTo(elbowU, elbowV);
    context.lineTo(u, v);
    context.stroke();
    context.fillRect(u - 1.5, v - 1.5, 3, 3);
  }
  context.globalAlpha = 1;
}

function drawArm(context, { status, shoulder, elbow, hand }) {
  if (status === 'lost') return;
  context.strokeStyle = context.fillStyle = status === 'tracking' ? COLOURS.arm : COLOURS.predicted;
  context.lineWidth = 4;
  context.lineJoin = context.lineCap = 'round';
  context.setLineDash(status === 'tracking' ? [] : [8, 8]);
  context.beginPath();
  for (const [u, v] of [shoulder, elbow, hand]) context.lineTo(u, v);
  context.stroke();
  context.setLineDash([]);
  for (const [[u, v], radius] of [[shoulder, 4], [elbow, 4], [hand, 8]]) {
    context.beginPath();
    context.arc(u, v, radius, 0, 2 * Math.PI);
    context.fill();
  }
}

function drawCross(context, [u, v], size, colour) {
  context.strokeStyle = colour;
  context.lineWidth = 1.5;
  context.beginPath();
  for (const [du, dv] of [[1, 0], [0, 1]]) {
    context.moveTo(u - size * du, v - size * dv);
    context.lineTo(u + size * du, v + size * dv);
  }
  context.stroke();
}

// The box of the face.
function drawHead(context, { u, v, width }) {
  context.strokeStyle = COLOURS.head;
  context.lineWidth = 1.5;
  context.strokeRect(u - width / 2, v - width / 2, width, width);
}

// `shown` says which parts are wanted; those that are null were not given.
function drawOverlay(context, { skin, blobs, particles, answer, truth, pointer }) {
  if (skin) context.drawImage(skin, 0, 0);
  for (const [index, blob] of (blobs ?? []).entries()) drawBlob(context, blob, index === answer.carrier);
  if (answer.head && blobs) drawHead(context, answer.head);
  if (particles) drawParticles(context, particles);
  if (answer.drawn) drawArm(context, answer);
  if (truth) drawCross(context, truth, 9, COLOURS.truth);
  if (pointer) drawCross(context, pointer, 16, COLOURS.pointer);
}
