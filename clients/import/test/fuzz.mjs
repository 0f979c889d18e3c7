// node test/fuzz.mjs --seconds N [--seed S]: garbled files to the importers until the time is over; ends with 1 at the first that breaks a promise.
import {parseArgs} from 'node:util';
import {fuzz, fuzzNc1} from './support/fuzzing.mjs';

const {values} = parseArgs({options: {seconds: {type: 'string'}, seed: {type: 'string', default: '1'}}});
const seconds = Number(values.seconds);
if (!(seconds > 0)) throw new Error('usage: node test/fuzz.mjs --seconds N [--seed S]');
const until = Date.now() + seconds * 1000;
let [cases, frames, parts, slowest] = [0, 0, 0, 0];
for (; Date.now() < until; ++cases) {
  const begun = Date.now();
  if ((await fuzz(Number(values.seed), cases)).frame) ++frames;
  if (fuzzNc1(Number(values.seed), cases).part) ++parts;
  slowest = Math.max(slowest, Date.now() - begun);
}
console.log(`importers: ${cases} cases of seed ${values.seed}, ${frames} with a frame, as many of NC1, ${parts} with a part, the slowest ${slowest} ms`);
