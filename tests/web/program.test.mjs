// G-code as the console reads it: its times and lengths are those that the program states, its places those of the cut.
import {strict as assert} from 'node:assert';
import {test} from 'node:test';
import {load} from './load.mjs';

const {parseProgram, placeOf, rapidSpeed} = await load('src/program.ts');
const head = ['(tube 60 x 4 mm)', '(units mm, deg, mm/min)', '(X0: the long point of the start, z 0, +X: from the start to the finish)'];

test('a turn at a feed takes the time of the circumference', () => {
  const turn = Array.from({length: 36}, (_, i) => `G1 X10 A${10 * (i + 1)} F[#<speed_mm_min> / ${Math.PI * 60 / 36}]`);
  const {moves, time, length} = parseProgram([...head, '#<speed_mm_min> = 600', '(cut: start)', 'G0 X10 A0', 'M3', 'G4 P0.5', 'G93', ...turn, 'G94', 'M5'].join('\n'));
  assert.ok(Math.abs(time.cut - Math.PI * 60 / 10) < 1e-9);
  assert.ok(Math.abs(length - Math.PI * 60) < 1e-9);
  assert.equal(time.pierce, 0.5);
  assert.deepEqual([...new Set(moves.map(({kind}) => kind))], ['rapid', 'pierce', 'cut']);
  assert.ok(moves.every(({cut}) => cut === 'start'));
});

test('comments, block numbers, capitals and other words for the dwell are read', () => {
  for (const [dwell, comment] of [['G04 X1.5', (text) => `(${text.toUpperCase()})`], ['G4 F1.5', (text) => `;${text}`]]) {
    const lines = [...head.map((line) => comment(line.slice(1, -1))), 'N10 G21 G90 G94', comment('cut: hole 1'), 'N20 G00 X100 A0 B0', 'N30 M03', `N40 ${dwell}`, 'N50 G93', 'N60 G01 X110 F60.0'];
    const {moves, time} = parseProgram(lines.join('\r\n'));
    assert.equal(time.pierce, 1.5);
    assert.equal(time.cut, 1);
    assert.ok(Math.abs(time.rapid) < 1e-12 || time.rapid >= 100 / rapidSpeed.mm_s);
    assert.deepEqual(moves.at(-1), {line: 9, kind: 'cut', seconds: 1, x: 110, phi: 0, out: 30, across: 0, b: 0, cut: lines[4].includes('HOLE') ? 'HOLE 1' : 'hole 1'});
  }
});

test('the tip is found from the pivot', () => {
  const {moves} = parseProgram([...head, '(X and Z carry the pivot of the torch, 150 mm from its tip, Z0: the axis of the tube)', 'G0 X100 A0 B30', 'G1 X100 A1 B-30 F100'].join('\n'));
  assert.deepEqual(moves.map(({x}) => Math.round(x * 1e9) / 1e9), [25, 175]);
});

test('a program in other units has its lines, and no moves that would be wrong', () => {
  const {lines, moves} = parseProgram('(units inch, deg, inch/min)\nG0 X1 A0\nG1 X2 F10\n');
  assert.deepEqual([lines.length, moves.length], [3, 0]);
});

test('around a section the tip is where Y and Z put it, turned with the tube, and the length is its way', () => {
  const square = ['(tube 80 x 40 x 3 mm, corners 6 mm outside)', '(units mm, deg, mm/min)', '(X0: the work point, z -2.5, +X: from the cut into the kept tube)'];
  const {moves, length, tube} = parseProgram([...square, '(X, Y and Z carry the pivot of the torch, 100 mm from its tip, Z0: the axis of the tube)',
    'G0 X10 Y0 Z140 A0 B0', 'G1 X10 Y-20 Z140 A0 B0 F600', 'G1 X10 Y-10 Z120 A90 B0 F600', 'G1 X60 Y-10 Z106.6025403784 A90 B30 F600'].join('\n'));
  assert.deepEqual([tube.round, tube.wall, tube.zero, tube.reach], [false, 3, -2.5, Math.hypot(40, 20)]);
  const places = moves.map((move) => placeOf(move, tube.zero).map((value) => Number(value.toFixed(6))));
  assert.deepEqual(places, [[40, 0, 7.5], [40, 20, 7.5], [-10, 20, 7.5], [-10, 20, 7.5]]);
  assert.ok(Math.abs(length - 70) < 1e-6, `${length}`);
});
