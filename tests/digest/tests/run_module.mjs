// Prints the digests of a WebAssembly module: node run_module.mjs MODULE FRAMES SUBJECTS
import { readFileSync } from 'node:fs';

const [file, frames, subjects] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(readFileSync(file));
for (let index = 0; index < Number(subjects); index++) {
    const digest = BigInt.asUintN(64, instance.exports.digest(index, Number(frames)));
    console.log(digest.toString(16));
}
