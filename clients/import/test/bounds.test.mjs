// No file blocks an import: endless, nested or huge ones end with a line in the list. And garbled
// files, always the same ones.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {fromCsv, fromDxf, fromIfc, fromNc1, fromPcf} from '../dist/index.js';
import {fuzz, fuzzNc1, sound} from './support/fuzzing.mjs';
import {hostile} from './support/hostile.mjs';
import {bytes} from './support/step.mjs';

const read = {ifc: (text) => fromIfc(bytes(text)), pcf: (text) => fromPcf(text), csv: (text) => fromCsv(text), nc1: (text) => fromNc1(text), dxf: (text) => fromDxf(text, {L: {outer_diameter_mm: 60.3, wall_mm: 3}})};
for (const [name, kind, make, reason] of hostile)
  test(`bounded: ${name}`, {timeout: 120000}, async (of) => {
    const text = make();
    const begun = performance.now();
    const found = await read[kind](text);
    of.diagnostic(`${Math.round(performance.now() - begun)} ms`);
    assert.ok(found.notUnderstood.some((each) => reason.test(each.reason)), JSON.stringify(found.notUnderstood.slice(0, 3)).slice(0, 900));
    sound(found, name);
  });

test('500 garbled files', async () => {
  const counts = {};
  for (let i = 0; i < 500; ++i) {
    const {kind, frame} = await fuzz(1, i);
    counts[kind] = (counts[kind] ?? 0) + 1;
    if (frame) counts.frame = (counts.frame ?? 0) + 1;
  }
  assert.ok(['ifc', 'pcf', 'csv', 'dxf', 'frame'].every((kind) => counts[kind] >= 50), JSON.stringify(counts));
});

test('2000 garbled NC1 files', () => {
  let parts = 0;
  for (let i = 0; i < 2000; ++i) parts += fuzzNc1(1, i).part ? 1 : 0;
  assert.ok(parts >= 500 && parts <= 1900, `${parts} parts`);
});
