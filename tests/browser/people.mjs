// Recorded people as the picture of Chromium's fake camera, with where their palms are. The clips are not part of the repository.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const CLIPS = fileURLToPath(new URL('../../../shared/data/video/asl/', import.meta.url));
// One person in long sleeves, one with bare arms.
const NAMES = ['yes', 'bird'];
// A hand is on a palm within this part of its size, as docs/hands_over_time.md has it.
const NEAR_PALM = 0.35;

// Why the clips are left out; null if they are not. With CI=true they are needed, unless SINEW_WITHOUT_DATA is true.
export function leftOut() {
  const { CI, SINEW_WITHOUT_DATA } = process.env;
  const why = !existsSync(CLIPS) ? '../shared/data is not beside the project'
    : spawnSync('ffmpeg', ['-version']).error ? 'ffmpeg is missing: `apt-get install ffmpeg` gives it' : null;
  assert(why === null || CI !== 'true' || SINEW_WITHOUT_DATA === 'true', `people before the camera: ${why}`);
  return why;
}

function ffmpeg(...args) {
  const { status, stderr, stdout } = spawnSync('ffmpeg', ['-v', 'error', ...args], { maxBuffer: 1 << 28 });
  assert.equal(status, 0, `ffmpeg ${args.join(' ')}: ${stderr}`);
  return stdout;
}

// Writes a number along the upper edge, as the built-in scene's camera has it: white, black, then eight bits.
function mark(planes, number, { width, height, codeWidth, codeHeight }) {
  const squares = [1, 0, ...[...Array(8).keys()].map((bit) => (number >> (7 - bit)) & 1)];
  for (const [square, isWhite] of squares.entries()) {
    for (let v = 0; v < codeHeight; v += 1) planes.fill(isWhite ? 235 : 16, v * width + square * codeWidth, v * width + (square + 1) * codeWidth);
  }
  for (const chroma of [width * height, 1.25 * width * height]) {
    for (let v = 0; v < codeHeight / 2; v += 1) planes.fill(128, chroma + (v * width) / 2, chroma + (v * width) / 2 + 5 * codeWidth);
  }
}

// The reference's palms in each frame; a cell is empty where none was found.
function palmsOf(name) {
  const [head, ...rows] = readFileSync(join(CLIPS, `${name}_points.csv`), 'utf8').trim().split(/\r?\n/).map((line) => line.split(','));
  const at = (row, column) => row[head.indexOf(column)];
  return rows.map((row) => ['1', '2'].filter((palm) => at(row, `palm${palm}_u_px`)).map((palm) => (
    [`palm${palm}_u_px`, `palm${palm}_v_px`, `size${palm}_px`].map((column) => Number(at(row, column))))));
}

// Writes each clip to `folder` as a file that Chromium takes for a camera. It runs to and fro, so that nothing jumps where it begins anew.
export function people(folder, code) {
  const size = { width: 640, height: 480, ...code };
  const bytes = 1.5 * size.width * size.height;
  return NAMES.map((name) => {
    const raw = ffmpeg('-i', join(CLIPS, `${name}.mkv`), '-f', 'rawvideo', '-pix_fmt', 'yuv420p', '-');
    const frames = Array.from({ length: raw.length / bytes }, (_, frame) => raw.subarray(frame * bytes, (frame + 1) * bytes));
    frames.forEach((planes, number) => mark(planes, number, size));
    const shown = [...frames, ...frames.slice(1, -1).reverse()].flatMap((planes) => [Buffer.from('FRAME\n'), planes]);
    const path = join(folder, `${name}.y4m`);
    writeFileSync(path, Buffer.concat([Buffer.from(`YUV4MPEG2 W${size.width} H${size.height} F30:1 Ip A1:1 C420jpeg\n`), ...shown]));
    return { name, path, palms: palmsOf(name) };
  });
}

// Whether a hand is on one of a frame's palms; null where the reference has none.
export function isOnPalm([u, v], palms) {
  return palms?.length ? palms.some(([palmU, palmV, size]) => Math.hypot(u - palmU, v - palmV) <= NEAR_PALM * size) : null;
}
