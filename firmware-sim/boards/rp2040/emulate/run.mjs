// Runs the image `walker` on an emulated RP2040: clocks, timers, interrupts, GPIO and serial line of
// the chip, not only its processor. Fails where the board does not start, or does not follow the arm
// of the recording while the walker breaks in.
//
//     npm ci && node run.mjs ../target/thumbv6m-none-eabi/release/walker
//
// The emulator counts the cycles of a Cortex-M0+ and knows nothing of the time that flash takes.

import { readFileSync } from 'node:fs';
import { ConsoleLogger, GPIOPinState, LogLevel, Simulator } from 'rp2040js';

const CLOCK_HZ = 133e6;
// The first frame comes after the skin table was learned; then there are four a second.
const SECONDS = 6;
const MIN_FRAMES = 6;
// The person stands at 1.25 m, and the arm is 0.63 m long.
const DEPTH_MM = [600, 1900];
// Flash as the processor sees it, and the vector table behind the 256 bytes of the second boot stage,
// which is what that stage jumps to.
const FLASH = 0x10000000;
const VECTORS = FLASH + 0x100;
const LED = 25;

/** Copies the segments of an ELF file for 32 bits into flash. */
function load(mcu, image) {
  const view = new DataView(image.buffer, image.byteOffset, image.byteLength);
  const [first, size, count] = [view.getUint32(28, true), view.getUint16(42, true), view.getUint16(44, true)];
  for (let segment = 0; segment < count; segment++) {
    const field = (index) => view.getUint32(first + segment * size + 4 * index, true);
    const [type, offset, physical, bytes] = [field(0), field(1), field(3), field(4)];
    if (type === 1 && bytes > 0) mcu.flash.set(image.subarray(offset, offset + bytes), physical - FLASH);
  }
}

function fail(message) {
  console.error(`error: ${message}`);
  process.exit(1);
}

const simulator = new Simulator();
const { rp2040: mcu, clock } = simulator;
mcu.logger = new ConsoleLogger(LogLevel.Error);
load(mcu, readFileSync(process.argv[2] ?? fail('the first argument is the image: target/thumbv6m-none-eabi/release/walker')));
mcu.core.VTOR = VECTORS;
mcu.core.SP = mcu.readUint32(VECTORS);
mcu.core.PC = mcu.readUint32(VECTORS + 4) & ~1;

const lines = [];
let line = '';
mcu.uart[0].onByte = (byte) => {
  line += String.fromCharCode(byte);
  if (byte !== 10) return;
  lines.push(line.trim());
  console.log(line.trim());
  line = '';
};

let [wasLit, busyCycles, instructions, idleNanoseconds] = [false, 0, 0, 0];
while (busyCycles / CLOCK_HZ + idleNanoseconds / 1e9 < SECONDS) {
  if (mcu.core.waiting) {
    const nanoseconds = clock.nanosToNextAlarm;
    idleNanoseconds += nanoseconds;
    clock.tick(nanoseconds);
  } else {
    const cycles = mcu.core.executeInstruction();
    busyCycles += cycles;
    instructions += 1;
    clock.tick((cycles * 1e9) / CLOCK_HZ);
  }
  if (mcu.gpio[LED].value === GPIOPinState.High) wasLit = true;
}

if (lines.length < MIN_FRAMES) fail(`${lines.length} frames in ${SECONDS} s; at least ${MIN_FRAMES} were expected`);
if (!wasLit) fail('the LED was never lit');
const depth = Number(/^\[-?\d+, -?\d+, (-?\d+)\] mm in \d+ ms$/.exec(lines.at(-1))?.[1]);
if (!(depth >= DEPTH_MM[0] && depth <= DEPTH_MM[1])) fail(`the last line is ${JSON.stringify(lines.at(-1))}: no arm at 1.25 m`);
const times = lines.map((text) => Number(/in (\d+) ms$/.exec(text)[1]));
const meanMs = Math.round(times.reduce((sum, ms) => sum + ms) / times.length);
console.log(`${lines.length} frames, ${meanMs} ms each in the mean; ${(busyCycles / instructions).toFixed(2)} cycles an instruction`);
