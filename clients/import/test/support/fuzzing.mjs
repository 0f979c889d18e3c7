// Files that are cut, doubled, exchanged and garbled at random, by a seed: each gives a valid
// frame or part, or none, and a list with the reasons.
import assert from 'node:assert/strict';
import {readdirSync, readFileSync} from 'node:fs';
import {fromCsv, fromDxf, fromIfc, fromNc1, fromPcf, layersOf} from '../../dist/index.js';
import {models} from './models.mjs';
import {samples} from './nc1_files.mjs';
import {file} from './profiles.mjs';
import {pick, random} from './random.mjs';
import {spool} from './spools.mjs';
import {bytes} from './step.mjs';
import {table} from './tables.mjs';

const field = new URL('../data/field/', import.meta.url);
const ofField = readdirSync(field).sort().map((name) => [name.replace(/^.*\./, ''), readFileSync(new URL(name, field), 'utf8')]);
const pairs = (...all) => all.map(([code, value]) => `${code}\n${value}\n`).join('');
const dxf = pairs([0, 'SECTION'], [2, 'HEADER'], [9, '$INSUNITS'], [70, 4], [0, 'ENDSEC'], [0, 'SECTION'], [2, 'ENTITIES'], [0, 'LINE'], [5, '1'], [8, 'L'], [10, 0], [20, 0], [30, 0], [11, 900], [21, 0], [31, 0],
  [0, 'LWPOLYLINE'], [5, '2'], [8, 'L'], [90, 3], [10, 0], [20, 0], [42, 0.4], [10, 90], [20, 90], [10, 300], [20, 90], [0, 'ARC'], [5, '3'], [8, 'L'], [10, 0], [20, 0], [30, 10], [40, 300], [50, 90], [51, 180], [0, 'ENDSEC'], [0, 'EOF']);

const strange = ['*', '$', '#1', '#999999', '()', "'", '"', ',', ';', '=', '\t', '\n', '\0', '-', '1e999', 'NaN', '0', '-1', '1e-320', '99999999999999999999', '__proto__', 'constructor', '0x10', '\u202e', '\ud800', 'é', '\u001b[31m', 'END-POINT', 'TAP-CONNECTION', 'OLET', 'IFCPOLYLINE', '.T.', '(', ')', '/*', '*/'];

const strangeInNc1 = ['BO', 'IK', 'AK', 'EN', '** ', '** shape: ', '; ', 'l', 'w', 'g', '-1', '1e999', 'NaN', '0', '99999999999999999999', '__proto__', '\0', '\n', ',', '\u202e', '\ud800', 'é', '\u001b[31m', 'RO', 'M', 'v', 'u'];

function mutant(next, text, other, odd = strange) {
  let out = text;
  for (let n = 1 + Math.floor(4 * next()); n > 0; --n) {
    const [a, b] = [0, 1].map(() => Math.floor(next() * out.length)).sort((p, q) => p - q);
    out = pick(next, [
      () => out.slice(0, a) + pick(next, odd) + out.slice(a),
      () => out.slice(0, a) + out.slice(Math.min(b, a + 40)),
      () => out.slice(0, a) + out.slice(a, Math.min(b, a + 300)).repeat(2) + out.slice(a),
      () => out.slice(0, a),
      () => out.replace(/#\d+(?=[,)])/g, (all) => (next() < 0.02 ? `#${1 + Math.floor(60 * next())}` : all)),
      () => out.replace(/-?\d+\.?\d*/g, (all) => (next() < 0.02 ? pick(next, odd) : all)),
      () => out.slice(0, a) + other.slice(a, b) + out.slice(b),
      () => {
        const lines = out.split('\n');
        const [i, j] = [0, 1].map(() => Math.floor(next() * lines.length));
        [lines[i], lines[j]] = [lines[j], lines[i]];
        return lines.join('\n');
      },
    ])();
  }
  return out;
}

const isPoint = (p) => Array.isArray(p) && p.length === 3 && p.every(Number.isFinite);

/** Properties of a part: numbers in it are numbers, and everything that a request must have is there. */
function soundPart({target, ends, cutouts = [], marks = [], kerf_mm: kerf}, told) {
  const numbers = (value) => (typeof value === 'object' && value !== null ? Object.values(value).every(numbers) : typeof value !== 'number' || Number.isFinite(value));
  assert.ok(numbers([target, ends, cutouts, marks, kerf]) && kerf >= 0 && target.length_mm > 0, told);
  if (target.kind === undefined) assert.ok(target.wall_mm > 0 && 2 * target.wall_mm < target.outer_diameter_mm, told);
  else assert.ok(target.wall_mm > 0 && 2 * target.wall_mm < Math.min(target.height_mm, target.width_mm), told);
  for (const end of [ends.start, ends.finish]) assert.ok(typeof end.square_at_mm === 'number' || isPoint(end.cutters[0].normal), told);
  const ids = cutouts.map(({id}) => id);
  assert.ok(new Set(ids).size === ids.length && ids.length <= 2000 && ids.every((id) => id.length > 0 && id.length <= 64), told);
  for (const {shape} of cutouts) assert.ok(shape.kind !== 'contour' || (shape.pieces.length > 0 && shape.pieces.length <= 500), told);
  for (const {text} of marks) assert.ok(text.length > 0 && text.length <= 64, told);
}

/** Properties of every import. */
export function sound({frame, part, notUnderstood, asks, sources}, told) {
  for (const {id, type, reason} of notUnderstood)
    for (const each of [id, type, reason]) assert.ok(typeof each === 'string' && !/[\u0000-\u001f\u007f-\u009f\u2028\u2029]/.test(each) && each.length <= 600, told);
  assert.ok(Array.isArray(asks) && Array.isArray(sources), told);
  if (part) {
    soundPart(part, told);
    return;
  }
  if (!frame) {
    assert.ok(notUnderstood.length > 0, `${told}: no frame, and an empty list`);
    return;
  }
  const {members, others = [], joints = []} = frame;
  assert.ok(members.length > 0 && members.length <= 10000 && others.length <= 1000, told);
  const ids = [...members, ...others].map(({id}) => id);
  assert.equal(new Set(ids).size, ids.length, `${told}: an id twice`);
  for (const id of ids) assert.ok(id.length > 0 && id.length <= 64, told);
  for (const each of members) {
    assert.ok(isPoint(each.start_mm) && isPoint(each.end_mm), told);
    if (each.kind !== undefined) {
      assert.ok(isPoint(each.up) && each.height_mm > 0 && each.width_mm > 0 && each.wall_mm > 0 && 2 * each.wall_mm < Math.min(each.height_mm, each.width_mm), told);
      assert.ok(each.kind === 'flat_oval_tube' || typeof each.corners === 'string' || each.corner_radius_mm > each.wall_mm, told);
    } else assert.ok(typeof each.size === 'string' || (each.outer_diameter_mm > 0 && each.wall_mm > 0 && each.wall_mm < each.outer_diameter_mm / 2), told);
  }
  for (const {between} of joints) assert.ok(between.length === 2 && between.every((id) => ids.includes(id)), `${told}: ${between}`);
  const keys = joints.map(({between}) => [...between].sort().join('\n'));
  assert.equal(new Set(keys).size, keys.length, `${told}: a joint twice`);
}

const read = {
  ifc: (text, next) => fromIfc(bytes(text), pick(next, [{}, {corner_radius_mm: 5}, {corners: 'en_10219'}])),
  pcf: (text, next) => fromPcf(text, pick(next, [{}, {schedule: 'SCH 40'}, {bores: {152.4: 'NPS 6', 4: '114.3'}, schedule: 'STD'}])),
  csv: (text, next) => fromCsv(text, pick(next, [{}, {unit: 'm'}, {nodes: 'node,x,y,z\n1,0,0,0\n2,5,5,5\n'}, {size: {size: 'NPS 2 STD'}}, {corners: 'en_10210'}, {size: {size: 'RHS 60x40x3'}, corner_radius_mm: 6}])),
  dxf: (text, next) => {
    let layers = [];
    try {
      layers = layersOf(text);
    } catch (failure) {
      assert.match(failure.message, /^it cannot be read/);
    }
    const size = pick(next, [{outer_diameter_mm: 60.3, wall_mm: 3}, {size: 'SHS 40x3 EN 10219'}]);
    return fromDxf(text, Object.fromEntries(layers.map((layer) => [layer, size])));
  },
};

/** Case `number` of a seed: its kind, and the result. */
export async function fuzz(seed, number) {
  const next = random(seed * 1000003 + number);
  const small = () => ({
    ifc: pick(next, [() => pick(next, models).text, () => file(1 + Math.floor(300 * next())).text])(),
    pcf: spool(1 + Math.floor(300 * next())).text,
    csv: table(1 + Math.floor(300 * next())).text,
    dxf,
  });
  const kind = pick(next, ['ifc', 'pcf', 'pcf', 'csv', 'csv', 'dxf']);
  const base = next() < 0.2 ? pick(next, ofField.filter(([of]) => of === kind || kind === 'dxf'))[1] : small()[kind];
  const text = mutant(next, base, small()[kind]);
  const found = await read[kind](text, next);
  sound(found, `seed ${seed}, case ${number}, ${kind}`);
  return {kind, frame: found.frame !== null};
}

/** The same of NC1, which is a part: a sequence of its own, so that the cases of the others stay. */
export function fuzzNc1(seed, number) {
  const next = random(seed * 1000003 + number);
  const text = mutant(next, pick(next, samples), pick(next, samples), strangeInNc1);
  const found = fromNc1(text, pick(next, [{}, {corners: 'en_10219'}, {fields: {kerf_mm: 1}}]));
  sound(found, `seed ${seed}, case ${number}, NC1`);
  return {kind: 'nc1', part: found.part !== null};
}
