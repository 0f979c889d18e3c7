// PCF files drawn at random: units, conventions of bores, fittings, elbows, taps and olets. The
// expected result of each is known from its making.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {catalogue, fromPcf} from '../dist/index.js';
import {spool} from './support/spools.mjs';

const apart = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));
const near = 2e-3; // mm: rounding error of the files' digits
const spools = Array.from({length: 240}, (_, i) => spool(i + 1));

test('there are 240 files, with each thing many times', () => {
  const all = (of) => spools.reduce((sum, each) => sum + each[of].length, 0);
  assert.ok(all('planes') > 1500 && all('branches') > 150 && all('listed') > 100);
  assert.ok(spools.filter(({map}) => map).length >= 100);
});

for (const each of spools) {
  const {seed, text, members, planes, branches, listed, map, used} = each;
  test(`PCF ${seed}`, () => {
    if (map) {
      const {asks, notUnderstood} = fromPcf(text);
      const bores = asks.filter(({option}) => option === 'bore');
      assert.equal(bores.length, used.length, 'each bore is requested once, all at once');
      for (const [value, size] of used) {
        const ask = bores.find(({key}) => Math.abs(Number(key) - value) <= 1e-5 * value);
        assert.ok(ask?.likely.includes(size), `${value} is ${size}, not ${ask?.likely}`);
        assert.ok(ask.count > 0 && notUnderstood.some(({reason}) => reason === ask.text));
      }
    }
    const {frame, notUnderstood, asks} = fromPcf(text, map ? {bores: map} : {});
    assert.deepEqual(asks, []);
    assert.deepEqual(notUnderstood.map(({type}) => type).sort(), listed.sort(), JSON.stringify(notUnderstood));
    assert.equal(frame.members.length, members.length);
    for (const [i, {id, ends, outer, wall}] of members.entries()) {
      const {id: name, start_mm, end_mm, outer_diameter_mm, wall_mm} = frame.members[i];
      assert.equal(name, id);
      assert.ok(apart(start_mm, ends[0]) <= near && apart(end_mm, ends[1]) <= near, `${id}: ${start_mm} ${end_mm}, not ${ends}`);
      assert.ok(Math.abs(outer_diameter_mm - outer) < 1e-9 && Math.abs(wall_mm - wall) < 1e-6, `${id}: ${outer_diameter_mm} x ${wall_mm}, not ${outer} x ${wall}`);
    }
    const others = new Map((frame.others ?? []).map((other) => [other.id, other]));
    const joints = frame.joints ?? [];
    const atPlanes = joints.filter(({between: [, other]}) => others.get(other)?.kind === 'plane');
    assert.equal(atPlanes.length, planes.length, 'a plane where a fitting begins, and nowhere else');
    for (const {member, end, at} of planes) {
      const joint = atPlanes.find(({between: [id], end: which}) => id === member && which === end);
      assert.ok(joint, `${member} has no plane at its ${end}`);
      const {point_mm, normal} = others.get(joint.between[1]);
      const {start_mm, end_mm} = frame.members.find(({id}) => id === member);
      const run = (end === 'start' ? 1 : -1);
      const along = end_mm.map((v, i) => run * (v - start_mm[i]) / apart(start_mm, end_mm));
      assert.ok(apart(point_mm, at) <= near && apart(normal, along) <= 1e-8, `${member} ${end}`);
    }
    const holes = joints.filter(({hole}) => hole === 'cut').map(({between}) => between.join(' on ')).sort();
    assert.deepEqual(holes, branches.map((pair) => pair.join(' on ')).sort());
  });
}

test('a schedule gives the walls of listed sizes, and only of these', () => {
  for (const {text, used} of spools.filter(({map}) => !map).slice(0, 60)) {
    const bare = text.replace(/^ +WALL-THICKNESS.*(\r?\n)/gm, '');
    const asked = fromPcf(bare);
    assert.deepEqual(asked.asks.map(({option}) => option), ['schedule']);
    const {frame, notUnderstood} = fromPcf(bare, {schedule: 'SCH 160'});
    for (const member of frame?.members ?? []) assert.ok(catalogue.some(({name}) => name === member.size), member.size);
    const lacking = used.filter(([, size]) => !catalogue.some(({name}) => name === `${size} SCH 160`));
    assert.equal(notUnderstood.some(({reason}) => /lists no SCH 160/.test(reason)), lacking.length > 0);
  }
});

test('a map may state walls, and is refused if it states no size', () => {
  const {text} = spools.find(({map, listed}) => map && listed.length === 0);
  const bare = text.replace(/^ +WALL-THICKNESS.*(\r?\n)/gm, '');
  const keys = fromPcf(bare).asks.filter(({option}) => option === 'bore').map(({key}) => key);
  const {frame, asks} = fromPcf(bare, {bores: Object.fromEntries(keys.map((key) => [key, '168.3x7.11']))});
  assert.deepEqual(asks, []);
  assert.ok(frame.members.every(({outer_diameter_mm, wall_mm}) => outer_diameter_mm === 168.3 && wall_mm === 7.11));
  for (const bad of ['', 'x', '0', '-5', 'NPS 7', 'DN 7', '10x5', '10x0', '10x2x3']) assert.throws(() => fromPcf(text, {bores: {[keys[0]]: bad}}), /is not a size/);
  assert.throws(() => fromPcf(text, {bores: {six: 'NPS 6'}}), /six is not a bore/);
});

test('bores of a file in mm that are all inches are requested, also those that would be a DN', () => {
  const {text} = spool(2);
  const pipes = [6, 4, 8].map((n, i) => `PIPE\n    END-POINT ${i * 5000} 0 0 ${n}\n    END-POINT ${i * 5000} 900 0 ${n}\n    WALL-THICKNESS 2 MM\n`).join('');
  const {frame, asks} = fromPcf(`UNITS-BORE MM\nUNITS-CO-ORDS MM\n${pipes}`);
  assert.ok(text.length > 0);
  assert.equal(frame, null);
  assert.deepEqual(asks.map(({key, likely}) => [key, likely[0]]), [['6', 'NPS 6'], ['4', 'NPS 4'], ['8', 'NPS 8']]);
  const alone = fromPcf(`UNITS-BORE MM\nUNITS-CO-ORDS MM\n${pipes.split('PIPE').slice(0, 2).join('PIPE')}`);
  assert.deepEqual(alone.asks.map(({key, likely}) => [key, likely]), [['6', ['NPS 6', 'NPS 1/8']]], 'DN 6 is not assumed');
});
