// Opens pages of `sinew report` in Chromium and looks at them as a person would: picture, slider, keys, values, themes.
//
//     node report.mjs PATH_OF_SINEW
//
// The browser is Debian's `chromium`, or the one that CHROMIUM names.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { makeRuns } from './runs.mjs';

const sinew = process.argv[2];
assert(sinew && existsSync(sinew), 'give the path of the command sinew, as target/release/sinew');
const executablePath = process.env.CHROMIUM || '/usr/bin/chromium';
assert(existsSync(executablePath), `there is no browser at ${executablePath}: install the package chromium, or name one by CHROMIUM`);

const folder = mkdtempSync(join(tmpdir(), 'sinew-report-'));
const browser = await chromium.launch({ executablePath, args: ['--no-sandbox'] });
let checks = 0;
const check = (is, what) => {
  assert(is, what);
  checks += 1;
};
const equal = (found, wanted, what) => {
  assert.deepEqual(found, wanted, what);
  checks += 1;
};

function report(name, ...runs) {
  const page = join(folder, `${name}.html`);
  execFileSync(sinew, ['report', ...runs, '--out', page]);
  return page;
}

// A page that may neither complain nor ask for anything.
async function open(file, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1360, height: 900 }, ...options });
  page.troubles = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && page.troubles.push(message.text()));
  page.on('pageerror', (error) => page.troubles.push(error.message));
  page.on('request', (request) => {
    const isOwn = request.url() === pathToFileURL(file).href || request.url().startsWith('data:') || request.url().startsWith('blob:');
    if (!isOwn) page.troubles.push(`asked for ${request.url()}`);
  });
  const begun = performance.now();
  await page.goto(pathToFileURL(file).href, { waitUntil: 'load' });
  await page.waitForSelector('footer');
  console.log(`${file.split('/').pop()}: open after ${Math.round(performance.now() - begun)} ms`);
  return page;
}

async function close(page) {
  equal(page.troubles, [], 'the console is silent and nothing is loaded');
  await page.close();
}

// Rows of a table without quoted cells, as objects.
function rows(path) {
  const [heading, ...lines] = readFileSync(path, 'utf8').trim().split('\n').map((line) => line.split(','));
  return lines.map((cells) => Object.fromEntries(heading.map((name, index) => [name, cells[index]])));
}

const place = (page) => page.locator('.transport .place').textContent();
const shown = (page) => page.locator('.player img').first().getAttribute('data-frame');
const source = (page) => page.locator('.player img').first().getAttribute('src');

async function slide(page, value) {
  await page.locator('.transport input').evaluate((slider, to) => {
    slider.value = to;
    slider.dispatchEvent(new Event('input'));
  }, value);
}

// Moves the pointer over a plot and compares the values in the box with the table's.
async function pointer(page, plot, table, columns, only = () => true) {
  const byFrame = new Map(table.filter(only).map((row) => [row.frame, row]));
  const area = page.locator(`[data-plot="${plot}"] > svg`).first();
  await area.scrollIntoViewIfNeeded();
  const size = await area.boundingBox();
  const frames = new Set();
  for (const share of [0.15, 0.3, 0.45, 0.6, 0.75, 0.9]) {
    await area.hover({ position: { x: size.width * share, y: Math.min(size.height / 2, 90) } });
    const heading = await page.locator('#pointer .x').textContent();
    const frame = heading.match(/^frame (\S+),/)[1];
    frames.add(frame);
    for (const [series, column] of Object.entries(columns)) {
      const raw = await page.locator(`#pointer .row[data-series="${series}"]`).getAttribute('data-raw');
      equal(raw, byFrame.get(frame)[column], `${plot}: ${series} of frame ${frame}`);
    }
  }
  check(frames.size >= 4, `${plot}: the pointer found several frames`);
  await page.mouse.move(2, 2);
}

async function player(page) {
  equal(await shown(page), '0', 'it begins with the first frame');
  const first = await source(page);
  check(first.startsWith('data:image/jpeg;base64,'), 'the picture is inside the page');
  await slide(page, 57);
  equal([await shown(page), (await place(page)).startsWith('frame 57 (58 of 120')], ['57', true], 'the slider moves the frame');
  check((await source(page)) !== first, 'another frame is another picture');
  check(await page.locator('.player img').first().evaluate((image) => image.decode().then(() => image.naturalWidth > 300)), 'the picture can be seen');
  for (const [key, frame] of [['ArrowRight', '58'], ['ArrowLeft', '57'], ['Shift+ArrowRight', '67'], ['End', '119'], ['ArrowRight', '119'], ['Home', '0'], ['ArrowLeft', '0']]) {
    await page.keyboard.press(key);
    equal(await shown(page), frame, key);
  }
  await page.keyboard.press('Space');
  await page.waitForFunction(() => Number(document.querySelector('.player img').dataset.frame) >= 3);
  await page.keyboard.press('Space');
  const stopped = await shown(page);
  await page.waitForTimeout(300);
  equal(await shown(page), stopped, 'space plays and stops');
}

async function demoPage(runs) {
  const page = await open(report('demo', runs.demo));
  const track = rows(join(runs.demo, 'track.csv'));
  await player(page);
  await pointer(page, 'arm hand_likelihood', track, { right: 'hand_likelihood' });
  await pointer(page, 'arm effective_sample_size', track, { right: 'effective_sample_size' });
  await pointer(page, 'arm space right', track, { x: 'hand_x_m', y: 'hand_y_m', z: 'hand_z_m' });
  await pointer(page, 'arm angles right', track, { elevation: 'elevation_rad', flexion: 'flexion_rad' });
  await pointer(page, 'arm path', track, {});
  const plot = page.locator('[data-plot="arm hand_likelihood"] > svg');
  const size = await plot.boundingBox();
  await plot.click({ position: { x: size.width * 0.5, y: 60 } });
  const frame = await shown(page);
  check(Number(frame) > 40 && Number(frame) < 75, `a click in a plot goes to its frame, ${frame}`);
  const value = Number(await page.locator('[data-plot="arm hand_likelihood"] .legend .at').first().textContent());
  check(Math.abs(value - Number(track[Number(frame)].hand_likelihood)) < 1e-3, 'the legend shows the value of the frame');
  await tables(page, join(runs.demo, 'track.csv'));
  await close(page);
}

async function tables(page, file) {
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  const table = page.locator('[data-table="track.csv"]');
  await table.locator('summary').click();
  await table.locator('tbody tr').first().waitFor();
  equal(await table.locator('tbody tr').count(), 50, 'a table opens with its first rows');
  await table.getByText('Show all 120 rows').click();
  equal(await table.locator('tbody tr').count(), 120, 'and shows all');
  await table.locator('[data-copy]').click();
  await page.waitForFunction(() => document.querySelector('[data-copy="track.csv"]').textContent === 'Copied');
  equal(await page.evaluate(() => navigator.clipboard.readText()), readFileSync(file, 'utf8'), 'a copied table is the file');
}

// On paper: dark ink on no ground, nothing to press, and no table that is not open.
async function printed(file) {
  const page = await open(file, { colorScheme: 'dark' });
  await page.emulateMedia({ media: 'print' });
  const ink = await page.locator('h1').evaluate((heading) => getComputedStyle(heading).color);
  equal(ink, 'rgb(27, 35, 48)', 'ink is dark on paper');
  equal(await page.locator('.transport').first().isVisible(), false, 'no slider on paper');
  equal(await page.locator('details:not([open])').first().isVisible(), false, 'no closed table on paper');
  check(await page.locator('.plot > svg').first().isVisible(), 'plots are on paper');
  await close(page);
}

async function themes(file) {
  const ground = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await open(file, { colorScheme: 'light' });
  const dark = await open(file, { colorScheme: 'dark' });
  const grounds = [await ground(light), await ground(dark)];
  check(grounds[0] !== grounds[1], 'the page follows the system');
  await light.locator('button.theme').click();
  equal(await ground(light), grounds[1], 'the button darkens');
  await light.locator('button.theme').click();
  equal(await ground(light), grounds[0], 'and lightens');
  await close(light);
  await close(dark);
}

async function twoRuns(runs) {
  const page = await open(report('two', runs.demo, runs.other));
  equal(await page.locator('.player img').count(), 2, 'two players');
  await slide(page, 30);
  const frames = await page.locator('.player img').evaluateAll((images) => images.map((image) => image.dataset.frame));
  equal(frames, ['30', '30'], 'one slider for both');
  const axes = await page.locator('[data-plot="arm error_m"] > svg').evaluateAll((all) => all.map((one) => [...one.querySelectorAll('text')].map((text) => text.textContent).join(' ')));
  equal([axes.length, axes[0] === axes[1]], [2, true], 'the axes are the same');
  const tops = await page.locator('[data-plot="arm error_m"]').evaluateAll((all) => all.map((one) => Math.round(one.getBoundingClientRect().top)));
  equal(tops[0], tops[1], 'they stand beside each other');
  await close(page);
}

// Thirty frames at 15 Hz beside thirty at 30 Hz: moments are thirtieths of a second for the first second, then fifteenths.
async function twoRates(runs) {
  const page = await open(report('rates', runs.slow, runs.fast));
  const frames = () => page.locator('.player img').evaluateAll((images) => images.map((image) => image.dataset.frame));
  equal(await page.locator('.transport input').getAttribute('max'), '44', 'the slider goes from moment to moment');
  equal(await frames(), ['0', '0'], 'both begin together');
  await slide(page, 20);
  equal([await frames(), (await place(page)).startsWith('0.67 s (21 of 45, frames 10, 20')], [['10', '20'], true], 'the slider goes by time');
  await page.keyboard.press('ArrowRight');
  equal(await frames(), ['10', '21'], 'a step is to the next frame of either run');
  await page.keyboard.press('ArrowRight');
  equal(await frames(), ['11', '22'], 'frames of one moment are shown together');
  await slide(page, 32);
  equal(await frames(), ['17', '29'], 'a run that has ended shows its last frame');
  await page.keyboard.press('End');
  equal(await frames(), ['29', '29'], 'the end is that of the longer run');
  const plot = page.locator('[data-plot="arm hand_likelihood"] > svg').last();
  await plot.scrollIntoViewIfNeeded();
  const size = await plot.boundingBox();
  await plot.click({ position: { x: size.width * 0.3, y: 60 } });
  const [slow, fast] = (await frames()).map(Number);
  check(fast > 4 && fast < 29 && slow === Math.floor(fast / 2), `a click goes to the moment of a frame, ${slow} beside ${fast}`);
  await page.keyboard.press('Home');
  await page.keyboard.press('Space');
  await page.waitForFunction(() => Number(document.querySelectorAll('.player img')[1].dataset.frame) >= 6);
  await page.keyboard.press('Space');
  const [played, beside] = (await frames()).map(Number);
  equal(played, Math.min(Math.floor(beside / 2), 29), 'playing keeps them together');
  await close(page);
}

async function motionPage(runs) {
  const page = await open(report('walk', runs.walk));
  const estimates = rows(join(runs.walk, 'estimates.csv'));
  await pointer(page, 'cyclic cadence', estimates, { cadence: 'cadence_per_min' });
  await pointer(page, 'cyclic likelihood', estimates, { 'log-likelihood': 'log_likelihood' });
  await pointer(page, 'cyclic angles left leg', estimates, { 'l knee': 'l_knee_rad', 'l ankle': 'l_ankle_rad' });
  check((await page.locator('[data-plot="cyclic cadence"] .band').count()) > 0, 'the cadence has its band');
  const bones = () => page.locator('.player .bone').evaluateAll((all) => all.map((bone) => bone.getAttribute('d')).join());
  const before = await bones();
  equal(await page.locator('.player .bone').count(), 13, 'the figure is drawn from numbers');
  await page.keyboard.press('Shift+ArrowRight');
  check((await bones()) !== before, 'and moves with the slider');
  await close(page);
}

async function hostilePage(runs) {
  const evil = '</script><script>window.broken=1</script><img src=x onerror="window.broken=2">';
  const run = join(folder, '<i>run');
  cpSync(runs.demo, run, { recursive: true });
  const quoted = `"${evil.replaceAll('"', '""')}"`;
  writeFileSync(join(run, 'track.csv'), readFileSync(join(run, 'track.csv'), 'utf8').replaceAll('frame_0000.png', quoted));
  writeFileSync(join(run, 'run.json'), readFileSync(join(run, 'run.json'), 'utf8').replaceAll('"gaussian"', JSON.stringify(evil)));
  const page = await open(report('hostile', run));
  equal(await page.evaluate(() => window.broken), undefined, 'no name runs');
  equal(await page.locator('.shown td').first().textContent(), evil, 'a name is shown as it is');
  equal(await page.locator('.run-name').first().textContent(), run, 'so is the folder');
  await close(page);
}

async function otherPages(runs) {
  const counts = { body: 10, arms: 6, bodies: 4, broken: 0 };
  for (const [name, plots] of Object.entries(counts)) {
    const page = await open(report(name, runs[name]));
    check((await page.locator('[data-plot] > svg path').count()) >= plots, `${name} has its plots`);
    check((await page.locator('[data-plot]').count()) >= plots, `${name} has its plots`);
    if (name === 'broken') {
      check((await page.locator('.notice.missing').count()) >= 2, 'what is missing is reported');
      await page.keyboard.press('End');
      check((await place(page)).includes('120 of 120'), 'the pictures are there without the table');
    }
    if (name === 'bodies') {
      const text = await page.locator('[data-plot^="evaluate body error_m"] .legend').textContent();
      check(text.includes('guided'), 'the models are named');
    }
    await close(page);
  }
}

try {
  const runs = makeRuns(sinew, folder);
  await demoPage(runs);
  await themes(join(folder, 'demo.html'));
  await printed(join(folder, 'demo.html'));
  await twoRuns(runs);
  await twoRates(runs);
  await motionPage(runs);
  await hostilePage(runs);
  await otherPages(runs);
  console.log(`${checks} checks of the pages passed`);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
