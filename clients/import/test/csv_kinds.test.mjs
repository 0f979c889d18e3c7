// Tables drawn at random: headings, units, marks of decimals and of columns, nodes. The expected
// result of each is known from its making.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {fromCsv} from '../dist/index.js';
import {table} from './support/tables.mjs';

const apart = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));
const tables = Array.from({length: 240}, (_, i) => table(i + 1));
const optionsOf = ({nodes, unit}) => ({...(nodes ? {nodes} : {}), ...(unit ? {unit} : {})});

test('240 tables come back as they were meant', () => {
  for (const each of tables) {
    const {seed, text, members} = each;
    const {frame, notUnderstood, asks} = fromCsv(text, optionsOf(each));
    const told = `table ${seed}: ${JSON.stringify([asks, notUnderstood.slice(0, 3)])}\n${text.slice(0, 900)}`;
    assert.deepEqual([asks, notUnderstood], [[], []], told);
    assert.deepEqual(frame.members.map(({id}) => id), members.map(({id}) => id), told);
    for (const [i, {ends, size}] of members.entries()) {
      const {start_mm, end_mm, id: _, ...found} = frame.members[i];
      assert.ok(apart(start_mm, ends[0]) < 1e-4 && apart(end_mm, ends[1]) < 1e-4, told);
      if (size.size) assert.deepEqual(found, size, told);
      else assert.ok(Math.abs(found.outer_diameter_mm - size.outer_diameter_mm) < 1e-3 && Math.abs(found.wall_mm - size.wall_mm) < 1e-3, `${JSON.stringify(found)} ${told}`);
    }
  }
  assert.ok(tables.filter(({byNodes}) => byNodes).length >= 100 && tables.filter(({text}) => /\d,\d/.test(text)).length >= 60);
});

test('each missing column is told once, and nothing else', () => {
  let count = 0;
  for (const each of tables)
    for (const {heading, field} of each.columns.filter(({field: of}) => of)) {
      const {frame, notUnderstood} = fromCsv(each.without(heading), {...optionsOf(each), unit: each.unit ?? 'mm'});
      assert.equal(frame, null);
      assert.deepEqual(notUnderstood.map(({id}) => id), ['file'], JSON.stringify(notUnderstood));
      assert.match(notUnderstood[0].reason, new RegExp(`no column for ${field} `));
      ++count;
    }
  assert.ok(count >= 400, `${count}`);
  const bare = fromCsv('id,start_x,start_y,end_x\nA,1,2,3\nB,1,2,3\n');
  assert.deepEqual(bare.notUnderstood.map(({reason}) => /no column for (\w+)/.exec(reason)?.[1]), ['start_z', 'end_y', 'end_z', 'outer_diameter', 'wall']);
});

test('what is not certain is requested', () => {
  const asks = (text, options) => fromCsv(text, options).asks.map(({option}) => option);
  const heads = 'id;x1;y1;z1;x2;y2;z2;od;wall\n';
  assert.deepEqual(asks(`${heads}A;1,234;0;0;2,345;0;0;60;3\n`), ['decimal']);
  assert.deepEqual(fromCsv(`${heads}A;1,234;0;0;2,345;0;0;60;3\n`, {decimal: ','}).frame.members[0].end_mm, [2.345, 0, 0]);
  assert.equal(fromCsv(`${heads}A;1,234;0;0;2,345;0;0;60;3\n`, {decimal: '.'}).frame, null);
  assert.deepEqual(asks(`${heads}A;0;0;0;30;0;0;1.2;0.05\n`), ['unit'], 'no tube is 1.2 mm thick');
  assert.equal(fromCsv(`${heads}A;0;0;0;30;0;0;1.2;0.05\n`, {unit: 'm'}).frame.members[0].outer_diameter_mm, 1200);
  assert.deepEqual(asks('m,node_a,node_b,od_m,t_m\n1,1,2,0.8,0.02\n'), ['nodes']);
  assert.deepEqual(asks('m,node_a,node_b,od_m,t_m\n1,1,2,0.8,0.02\n', {nodes: 'node,x,y,z\n1,0,0,0\n2,9,0,0\n'}), ['unit']);
});

test('nodes that are missing, doubtful or no points are told', () => {
  const members = 'id,n1,n2,od,wall\nA,1,2,60,3\nB,2,3,60,3\nC,3,4,60,3\nD,2,5,60,3\n';
  const {frame, notUnderstood} = fromCsv(members, {nodes: 'node,x,y,z\n1,0,0,0\n2.0,500,0,0\n3,0,0,900\n3,0,0,901\n4,1,x,1\n,1,1,1\n'});
  assert.deepEqual(frame.members.map(({id}) => id), ['A']);
  assert.deepEqual(notUnderstood.map(({id, type}) => `${id} ${type}`), ['row 5 node', 'row 6 node', 'row 7 node', 'row 3 CSV', 'row 4 CSV', 'row 5 CSV']);
});

test('units of cells and a row of units count', () => {
  const inches = fromCsv('id\tX1\tY1\tZ1\tX2\tY2\tZ2\tOD\twall\nA\t0\t0\t0\t40"\t0\t0\t2 3/8"\t0.154"\nB\t0\t0\t0\t0\t1 m\t0\t60.3 mm\t3.91 mm\n');
  assert.deepEqual(inches.notUnderstood, []);
  assert.deepEqual(inches.frame.members.map(({end_mm, outer_diameter_mm, wall_mm}) => [...end_mm, outer_diameter_mm, wall_mm]), [[1016, 0, 0, 60.325, 3.9116], [0, 1000, 0, 60.3, 3.91]]);
  const row = fromCsv('id,X1,Y1,Z1,X2,Y2,Z2,OD,wall\n,m,m,m,m,m,m,mm,mm\nA,0,0,0,1.5,0,0,60.3,3.91\n');
  assert.deepEqual([row.notUnderstood, row.frame.members[0].end_mm, row.frame.members[0].outer_diameter_mm], [[], [1500, 0, 0], 60.3]);
});
