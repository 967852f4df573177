// The module gives the bits that the machine that built the page gives to the same frames.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

const SIZE = [640, 480];
const PARTICLES = 50;
const SEED = 1;

// Runs the page's module over the frames in `folder`; gives the number of frames.
export async function compareBits(folder) {
  const html = readFileSync(join(folder, 'index.html'), 'utf8');
  const data = JSON.parse(html.match(/<script type="application\/json" id="data">(.*?)<\/script>/s)[1]);
  const { instance } = await WebAssembly.instantiate(Buffer.from(data.module, 'base64'));
  assert.deepEqual(WebAssembly.Module.imports(await WebAssembly.compile(Buffer.from(data.module, 'base64'))), [], 'the module asks for nothing');
  const module = instance.exports;
  const bits = JSON.parse(readFileSync(join(folder, 'bits.json'), 'utf8'));
  const frames = readFileSync(join(folder, 'frames.rgba'));
  const numbers = (address, count) => [...new Uint32Array(module.memory.buffer, address, count)];
  const [u, v, distance] = bits.shoulder;
  assert.equal(module.begin(...SIZE, 0, PARTICLES, SEED, distance, u, v), 0);
  const length = 4 * SIZE[0] * SIZE[1];
  for (const [frame, answer] of bits.answers.entries()) {
    new Uint8Array(module.memory.buffer, module.picture(), length).set(frames.subarray(frame * length, (frame + 1) * length));
    assert.equal(module.see(), 0);
    assert.equal(module.track(frame * bits.step_us), 0);
    assert.deepEqual(numbers(module.answer(), answer.length), answer, `answer to frame ${frame}`);
    assert.deepEqual(numbers(module.blobs(), 7 * module.blob_count()), bits.blobs[frame], `blobs of frame ${frame}`);
  }
  return bits.answers.length;
}
