// Opens the live page in Chromium: its built-in scene, a fake camera that shows the same scene, and browsers that lack something.
//
//     cargo run --release -p sinew-live-page -- --out FOLDER --for-tests
//     node live.mjs FOLDER [PICTURE.png]
//
// PICTURE gets what the page looks like.
// The browser is Debian's `chromium`, or the one that CHROMIUM names.
import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { compareBits } from './live_bits.mjs';
import { isOnPalm, leftOut, people } from './people.mjs';

const folder = process.argv[2];
assert(folder && existsSync(join(folder, 'index.html')), 'give the folder that sinew-live-page wrote');
const executablePath = process.env.CHROMIUM || '/usr/bin/chromium';
assert(existsSync(executablePath), `there is no browser at ${executablePath}: install the package chromium, or name one by CHROMIUM`);

const truth = JSON.parse(readFileSync(join(folder, 'camera.json'), 'utf8'));
const MAX_BYTES = 3_200_000;
const MAX_FIRST_MS = 3000;
const MAX_ERROR = 0.05 * truth.width;
const FRAMES = process.env.SINEW_SHORT_TESTS ? 80 : 200;

const cameraOf = (video) => ['--use-fake-device-for-media-stream', `--use-file-for-fake-video-capture=${video}`];
const fakeCamera = cameraOf(join(folder, 'camera.y4m'));
const allowed = ['--use-fake-ui-for-media-stream'];
let checks = 0;
const check = (is, what) => {
  assert(is, what);
  checks += 1;
};

// The page as any server gives it; cameras want a secure place, and localhost is one.
const html = readFileSync(join(folder, 'index.html'));
const asked = [];
const server = createServer((request, response) => {
  asked.push(request.url);
  response.writeHead(request.url === '/' ? 200 : 404, { 'content-type': 'text/html; charset=utf-8' });
  response.end(request.url === '/' ? html : '');
});
await new Promise((done) => server.listen(0, '127.0.0.1', done));
const served = `http://localhost:${server.address().port}/`;
const file = pathToFileURL(join(folder, 'index.html')).href;

// Calls `use` with the page in a browser with these switches; the page may neither complain nor ask for anything.
async function visit(name, { args = [], address = served, before, forgiven }, use) {
  const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', ...args] });
  try {
    const page = await browser.newPage({ viewport: { width: 1200, height: 900 } });
    const troubles = [];
    page.on('console', (message) => ['error', 'warning'].includes(message.type()) && troubles.push(message.text()));
    page.on('pageerror', (error) => troubles.push(error.stack));
    page.on('request', (request) => {
      const url = request.url();
      if (url !== address && !url.startsWith('data:') && !url.startsWith('blob:')) troubles.push(`asked for ${url}`);
    });
    await page.addInitScript(watchFrames, { codeWidth: truth.code_width_px, codeHeight: truth.code_height_px });
    if (before) await page.addInitScript(before);
    await page.goto(address);
    await page.waitForSelector('html[data-ready]');
    await use(page);
    assert.deepEqual(troubles.filter((trouble) => !forgiven?.test(trouble)), [], `${name}: the console is silent and nothing is loaded`);
    checks += 1;
    console.log(`${name}: ok`);
  } finally {
    await browser.close();
  }
}

// In the page: keeps what each frame gave, with the number that is written in the fake camera's pictures.
function watchFrames({ codeWidth, codeHeight }) {
  window.frames_ = [];
  document.addEventListener('sinew-frame', ({ detail }) => {
    const { pixels, answer, milliseconds, timeUs, number, firstMs } = detail;
    const isWhite = (square) => pixels.data[4 * ((codeHeight >> 1) * pixels.width + codeWidth * square + (codeWidth >> 1))] > 128;
    const hasCode = isWhite(0) && !isWhite(1);
    const code = hasCode ? [2, 3, 4, 5, 6, 7, 8, 9].reduce((sum, square) => 2 * sum + isWhite(square), 0) : null;
    window.frames_.push({ code, number, answer, milliseconds, timeUs, firstMs, at: performance.now() });
  });
}

const frames = (page) => page.evaluate(() => window.frames_);
const forget = (page) => page.evaluate(() => void (window.frames_ = []));
const waitForFrames = (page, count) => page.waitForFunction((wanted) => window.frames_.length >= wanted, count, { timeout: 60_000 });
const noticed = (page, name) => page.waitForSelector(`[data-notice="${name}"]`);
const mean = (numbers) => numbers.reduce((sum, number) => sum + number, 0) / numbers.length;
const distance = ([u, v], [x, y]) => Math.hypot(u - x, v - y);

// Clicks where the picture's pixel is shown.
async function clickAt(page, [u, v]) {
  const at = await page.locator('#view').evaluate((view, [across, down]) => {
    const box = view.getBoundingClientRect();
    const scale = Math.min(box.width / view.width, box.height / view.height);
    const side = view.classList.contains('mirrored') ? -1 : 1;
    return [box.width / 2 + (side * (across - view.width / 2)) * scale, box.height / 2 + (down - view.height / 2) * scale];
  }, [u, v]);
  await page.locator('#view').click({ position: { x: at[0], y: at[1] } });
}

async function set(page, id, value) {
  await page.locator(`#${id}`).evaluate((input, to) => {
    input.value = to;
    input.dispatchEvent(new Event('input'));
    input.dispatchEvent(new Event('change'));
  }, value);
}

// Frames in a second and milliseconds of each part; printed, not asserted.
function tellSpeed(name, list) {
  const rate = (1000 * (list.length - 1)) / (list.at(-1).at - list[0].at);
  const parts = Object.keys(list[0].milliseconds).map((part) => `${part} ${mean(list.map(({ milliseconds }) => milliseconds[part])).toFixed(2)} ms`);
  console.log(`${name}: ${rate.toFixed(1)} frames a second; ${parts.join(', ')}`);
}

function tellErrors(name, errors) {
  const within = errors.filter((error) => error <= MAX_ERROR).length;
  console.log(`${name}: ${within} of ${errors.length} frames within 5 % of the width; greatest error ${(100 * Math.max(...errors) / truth.width).toFixed(1)} %, mean ${(100 * mean(errors) / truth.width).toFixed(1)} %`);
}

async function builtInScene(page) {
  await page.locator('#use-scene').click();
  if (process.argv[3]) {
    await page.locator('#show-particles').check();
    await page.locator('#show-timing').check();
  }
  await waitForFrames(page, FRAMES);
  const list = (await frames(page)).slice(0, FRAMES);
  assert.deepEqual(list.map(({ number }) => number), [...Array(FRAMES).keys()], 'every frame comes in its turn');
  const errors = list.map(({ answer, number }) => distance(answer.hand, truth.hands[number]));
  if (process.argv[3]) await page.screenshot({ path: process.argv[3] });
  tellErrors('built-in scene', errors);
  tellSpeed('built-in scene', list);
  check(errors.every((error) => error <= MAX_ERROR), 'the built-in scene is tracked');
  check(await page.locator('#use-scene').getAttribute('aria-pressed') === 'true', 'the source is shown');
  const hands = list.slice(0, 60).map(({ answer }) => answer.hand);
  await page.locator('#use-scene').click();
  await forget(page);
  await page.waitForFunction(() => window.frames_.some(({ number }, at, all) => number === 59 && all.some((one) => one.number === 0)));
  const again = await frames(page);
  const begun = again.findIndex(({ number }) => number === 0);
  assert.deepEqual(again.slice(begun, begun + 60).map(({ answer }) => answer.hand), hands, 'the same scene gives the same numbers');
  checks += 1;
}

// What was drawn, as one number.
const drawn = (page) => page.locator('#view').evaluate((view) => {
  const { data } = view.getContext('2d').getImageData(0, 0, view.width, view.height);
  return data.reduce((sum, value, at) => (sum * 31 + value + at) % 1_000_003, 0);
});

async function controls(page) {
  await page.locator('#use-scene').click();
  await waitForFrames(page, 30);
  await set(page, 'particles', 300);
  check((await page.locator('#particles-shown').textContent()) === '300', 'the number of particles is shown');
  await page.locator('#show-timing').check();
  await page.waitForFunction(() => document.querySelector('#timing').textContent.includes('vision'));
  check((await page.locator('#answers').textContent()).includes('placed'), 'the scene’s shoulder is known');
  await page.locator('#stop').click();
  const count = (await frames(page)).length;
  await page.waitForTimeout(200);
  check((await frames(page)).length === count, 'stop stops');
  check(await page.locator('#stop').isDisabled(), 'and cannot be pressed again');
  const ground = (scheme) => page.emulateMedia({ colorScheme: scheme }).then(() => page.evaluate(() => getComputedStyle(document.body).backgroundColor));
  check((await ground('light')) !== (await ground('dark')), 'light and dark');
  // By keys alone: from the first control to the scene, then a cross in the picture.
  await page.locator('#use-camera').focus();
  await page.keyboard.press('Tab');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await waitForFrames(page, count + 10);
  await page.locator('#stop').focus();
  await page.keyboard.press('Tab');
  check(await page.evaluate(() => document.activeElement.id === 'view'), 'the picture can be reached by keys');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Enter');
  check((await page.locator('#how').textContent()).includes('328, 240'), 'Enter clicks where the cross is');
  await page.locator('#show-particles').check();
  await waitForFrames(page, count + 20);
  await page.locator('#stop').click();
  check(Number.isFinite(await drawn(page)), 'the picture is drawn');
}

async function camera(page) {
  await page.locator('#use-camera').click();
  await page.waitForFunction(() => window.frames_.at(-1)?.firstMs != null, null, { timeout: 20_000 });
  const first = (await frames(page)).at(-1).firstMs;
  console.log(`camera: first frame tracked ${Math.round(first)} ms after the camera was asked for`);
  check(first <= MAX_FIRST_MS, `the first frame is tracked within 3 s, not ${first} ms`);
  check((await page.locator('#answers').textContent()).includes('guessed'), 'nothing is known of the person');
  await forget(page);
  await waitForFrames(page, FRAMES);
  const errorsOf = (list) => list.map(({ answer, code }) => distance(answer.hand, truth.hands[code]));
  const guessed = (await frames(page)).slice(0, FRAMES);
  check(guessed.every(({ code }) => code !== null && code < truth.hands.length), 'every picture shows its number');
  tellErrors('camera, shoulder guessed', errorsOf(guessed));
  // As a person would: the distance by the slider, the shoulder by a click.
  await set(page, 'distance', truth.distance.toFixed(2));
  await page.locator('input[name="click"][value="shoulder"]').check();
  await clickAt(page, truth.shoulder);
  check((await page.locator('#how').textContent()).includes('The shoulder is at'), 'the shoulder is placed');
  await forget(page);
  await waitForFrames(page, FRAMES + 2);
  // The tracker has just begun anew; it may take two frames to find the hand.
  const list = (await frames(page)).slice(2, FRAMES + 2);
  const errors = errorsOf(list);
  const steps = list.slice(1).map(({ code }, at) => Math.abs(code - list[at].code));
  console.log(`camera: ${new Set(list.map(({ code }) => code)).size} different pictures, ${steps.filter((step) => step > 1).length} times some were left out`);
  tellErrors('camera, shoulder placed', errors);
  tellSpeed('camera', list);
  check(errors.every((error) => error <= MAX_ERROR), `the hand is within 5 % of the width in ${FRAMES} frames`);
  await calibration(page);
}

// A person whose face is in view needs no click: soon a tracked hand is where the reference has a palm. How often is printed; the score of the
// command, whose bits the module has, holds it.
const faceInView = ({ name, palms }) => async (page) => {
  await page.locator('#use-camera').click();
  await waitForFrames(page, FRAMES);
  const list = await frames(page);
  const timeOf = (frame) => (frame ? frame.at - list[0].at : Infinity);
  const isOnHand = ({ answer, code }) => isOnPalm(answer.hand, palms[code]);
  const tracked = list.filter(({ answer: { status } }) => status === 'tracking');
  const judged = tracked.filter((frame) => isOnHand(frame) !== null);
  const [face, hand] = [list.find(({ answer }) => answer.head), judged.find(isOnHand)].map(timeOf);
  console.log(`${name}: the face after ${Math.round(face)} ms, a hand after ${Math.round(hand)} ms`);
  console.log(`${name}: ${tracked.length} of ${list.length} frames are tracked; ${judged.filter(isOnHand).length} of ${judged.length} with a reference are on a palm`);
  check(hand <= MAX_FIRST_MS, `${name}: the first hand is tracked within 3 s, not ${hand} ms`);
  check((await page.locator('#answers').textContent()).includes('by the face'), 'the shoulder is that of the face');
  tellSpeed(name, list);
};

// Clicks on the hand while it rests; again where it had moved on before the click came.
async function clickOnHand(page) {
  const rests = truth.hands.map((hand, code) => truth.hands.slice(Math.max(0, code - 10), code + 11).every((other) => distance(hand, other) < 8));
  for (let attempt = 0; attempt < 20; attempt += 1) {
    const at = await page.waitForFunction((resting) => {
      const { code } = window.frames_.at(-1);
      return resting[code] && { code };
    }, rests);
    const hand = truth.hands[(await at.jsonValue()).code];
    await clickAt(page, hand);
    if (distance(truth.hands[(await frames(page)).at(-1).code], hand) < 8) return;
    await page.locator('#reset').click();
  }
  assert.fail('the hand never rested under a click');
}

// A click on the hand teaches its skin, and reset forgets it.
async function calibration(page) {
  await page.locator('input[name="click"][value="hand"]').check();
  await clickOnHand(page);
  check((await page.locator('#how').textContent()).includes('was learnt'), 'a click on the hand is taken');
  await forget(page);
  await waitForFrames(page, 60);
  const list = (await frames(page)).slice(10);
  const errors = list.map(({ answer: { hand }, code }) => distance(hand, truth.hands[code]));
  tellErrors('camera, after a click on the hand', errors);
  // A blob carries the estimate; how likely it is a hand depends on the pixel that was clicked on.
  const found = list.filter(({ answer: { status } }, at) => ['tracking', 'uncertain'].includes(status) && errors[at] <= MAX_ERROR);
  check(found.length >= 0.9 * list.length, `the hand is found with the learnt skin in ${found.length} of ${list.length} frames`);
  await page.locator('#reset').click();
  check((await page.locator('#how').textContent()).includes('Click on the hand'), 'reset forgets');
}

async function offersScene(page, name) {
  await noticed(page, name);
  await page.locator('[data-notice] button').click();
  await waitForFrames(page, 20);
  const { answer, number } = (await frames(page)).at(-1);
  check(distance(answer.hand, truth.hands[number]) <= MAX_ERROR, `${name}: the built-in scene is tracked`);
  check((await page.locator('[data-notice]').count()) === 0, `${name}: the notice goes`);
}

const ask = (name) => async (page) => {
  await page.locator('#use-camera').click();
  await offersScene(page, name);
};

// What a script in the page would try in order to send a picture somewhere; the browser refuses it all, and says so in the console.
async function policy(page) {
  const before = asked.length;
  const ways = await page.evaluate(async (address) => {
    const refused = (promise) => promise.then(() => 'sent', () => 'refused');
    const shown = (tag, attributes) => new Promise((done, fail) => {
      const node = Object.assign(document.createElement(tag), { onload: done, onerror: fail, ...attributes });
      document.body.append(node);
    });
    const socket = () => new Promise((done, fail) => {
      const socket = new WebSocket(address.replace('http', 'ws'));
      Object.assign(socket, { onopen: done, onerror: fail });
    });
    return [
      await refused(fetch(`${address}leak`)),
      await refused(shown('img', { src: `${address}leak.png` })),
      await refused(shown('script', { src: `${address}leak.js` })),
      await refused(socket()),
    ];
  }, served);
  assert.deepEqual(ways, Array(4).fill('refused'), 'nothing can be sent');
  checks += 1;
  check(asked.slice(before).every((url) => !url.includes('leak')), `the server was asked for ${asked.slice(before)}`);
}

// A module that traps at its 30th picture.
function trap() {
  const instantiate = WebAssembly.instantiate;
  WebAssembly.instantiate = async (bytes) => {
    const { exports } = (await instantiate(bytes)).instance;
    let left = 30;
    const see = () => {
      left -= 1;
      if (left < 0) throw new WebAssembly.RuntimeError('unreachable');
      return exports.see();
    };
    return { instance: { exports: { ...exports, see } } };
  };
}

async function trapped(page) {
  await page.locator('#use-scene').click();
  await offersScene(page, 'tracker-stopped');
}

async function badVideo(page) {
  const path = join(scratch, 'broken.mp4');
  writeFileSync(path, 'this is no video');
  await page.locator('#video-file').setInputFiles(path);
  await offersScene(page, 'video-unplayable');
}

// A video of an upright telephone, recorded by the browser itself.
async function video(page) {
  const bytes = await page.evaluate(async () => {
    const canvas = Object.assign(document.createElement('canvas'), { width: 540, height: 960 });
    const context = canvas.getContext('2d');
    const recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: 'video/webm' });
    const parts = [];
    recorder.ondataavailable = ({ data }) => data.size && parts.push(data);
    const paint = async (frame) => {
      context.fillStyle = 'rgb(60, 90, 140)';
      context.fillRect(0, 0, 540, 960);
      context.fillStyle = 'rgb(200, 140, 110)';
      context.beginPath();
      context.arc(225 + 2 * (frame % 45), 600, 45, 0, 2 * Math.PI);
      context.fill();
      await new Promise((done) => setTimeout(done, 33));
    };
    // A recorder needs a while to begin, and a busy machine leaves pictures out: it goes on until enough came.
    recorder.start(100);
    for (let frame = 0; frame < 45 || (parts.length < 8 && frame < 600); frame += 1) await paint(frame);
    const stopped = new Promise((done) => { recorder.onstop = done; });
    recorder.stop();
    await stopped;
    return [...new Uint8Array(await new Blob(parts).arrayBuffer())];
  });
  const path = join(scratch, 'upright.webm');
  writeFileSync(path, Buffer.from(bytes));
  await page.locator('#video-file').setInputFiles(path);
  await waitForFrames(page, 3);
  assert.deepEqual(await page.locator('#view').evaluate((view) => [view.width, view.height]), [360, 640], 'an upright video stays upright');
  const { answer } = (await frames(page)).at(-1);
  check(answer.status === 'tracking' && Math.abs(answer.hand[1] - 400) < 32, `the disc is tracked: ${answer.status} at ${answer.hand}`);
}

const scratch = mkdtempSync(join(tmpdir(), 'sinew-live-'));
try {
  const bytes = statSync(join(folder, 'index.html')).size;
  console.log(`download: ${bytes} bytes`);
  check(bytes < MAX_BYTES, `the download has ${bytes} bytes`);
  const compared = await compareBits(folder);
  check(compared >= 20, `only ${compared} frames were compared`);
  console.log(`the module gives the bits of this machine in ${compared} frames`);
  await visit('the file itself', { address: file }, builtInScene);
  await visit('controls', {}, controls);
  await visit('fake camera', { args: [...fakeCamera, ...allowed] }, camera);
  const why = leftOut();
  if (why) console.log(`left out: people before the camera: ${why}`);
  const clips = why ? [] : people(scratch, { codeWidth: truth.code_width_px, codeHeight: truth.code_height_px });
  for (const clip of clips) await visit(`a face, ${clip.name}`, { args: [...cameraOf(clip.path), ...allowed] }, faceInView(clip));
  await visit('video file', {}, video);
  await visit('broken video', {}, badVideo);
  await visit('camera refused', { args: fakeCamera }, ask('camera-refused'));
  await visit('no camera', { args: allowed }, ask('no-camera'));
  await visit('no cameras at all', { before: () => Object.defineProperty(navigator, 'mediaDevices', { value: undefined }) }, ask('camera-insecure'));
  await visit('no WebAssembly', { before: () => delete window.WebAssembly }, (page) => offersScene(page, 'no-webassembly'));
  await visit('the policy', { forgiven: /Content Security Policy|violates|^asked for/ }, policy);
  await visit('a trap', { before: trap }, trapped);
  console.log(`${checks} checks of the live page passed`);
} finally {
  server.close();
  rmSync(scratch, { recursive: true, force: true });
}
