// Tables whose columns a person matches: by index, in any order, under any heading or none, the frame is the same.
import {strict as assert} from 'node:assert';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {columnsOf, fields, fromCsv} from '../dist/index.js';
import {pick, random} from './support/random.mjs';

const names = ['id', 'start_x', 'start_y', 'start_z', 'end_x', 'end_y', 'end_z', 'outer_diameter', 'wall'];
const rows = [['chord', 0, 0, 0, 1200.5, 0, 0, 88.9, 5], ['left', 300, 0, 0, 300, 0, 800.25, 48.3, 3.2], ['right', 900, 0, 0, 900, 0, 800, 48.3, 3.2]];
const members = rows.map(([id, a, b, c, d, e, f, outer, wall]) => ({id, start_mm: [a, b, c], end_mm: [d, e, f], outer_diameter_mm: outer, wall_mm: wall}));
const text = (table, mark, decimal = '.') => table.map((row) => row.map((cell) => `${cell}`.replace('.', decimal)).join(mark)).join('\n');
const only = (columns) => ({...Object.fromEntries(fields.map((field) => [field, null])), ...columns});

test('in any order, under any heading or none, columns by index give the same frame', () => {
  let count = 0;
  for (let seed = 1; seed <= 60; seed += 1) {
    const draw = random(seed);
    const order = names.map((_, i) => [draw(), i]).sort(([a], [b]) => a - b).map(([, i]) => i);
    const more = draw() < 0.5 ? [`note ${Math.floor(draw() * 9)}`] : [];
    const shuffled = rows.map((row) => [...order.map((i) => row[i]), ...more]);
    const [mark, decimal] = pick(draw, [[',', '.'], [';', ','], ['\t', ','], [';', '.'], ['|', '.']]);
    const headings = draw() < 0.5;
    const top = [...order.map((i) => `column ${'abcdefghi'[i]}`), ...more.map(() => 'remark')];
    const title = draw() < 0.3 ? 'Tubes of the gate\n\n' : '';
    const columns = only(Object.fromEntries(order.map((i, at) => [names[i], at])));
    const given = title + text(headings ? [top, ...shuffled] : shuffled, mark, decimal);
    const found = fromCsv(given, {columns, headings});
    assert.deepEqual(found.notUnderstood, [], given);
    assert.deepEqual(found.frame.members, members, given);
    assert.deepEqual(fromCsv(given, {columns}).frame.members, members, 'it is seen whether a row has headings');
    const start = columnsOf(given);
    assert.deepEqual([start.headings.length > 0, start.rows.length], [headings, 3]);
    count += 1;
  }
  assert.equal(count, 60);
});

test('two columns of one heading are told apart, and a known heading can mean nothing', () => {
  const table = `id,x,y,z,x,y,z,wall,OD,wall\n${text(rows.map((row) => [...row.slice(0, 7), 1, ...row.slice(7)]), ',')}`;
  const columns = Object.fromEntries(names.map((name, i) => [name, i < 7 ? i : i + 1]));
  assert.deepEqual(fromCsv(table, {columns}).frame.members, members);
  const depth = `id,x1,y1,z1,x2,y2,z2,OD,wall,priority\n${text(rows.map((row) => [...row, 'low']), ',')}`;
  assert.equal(fromCsv(depth).notUnderstood.filter(({reason}) => /its priority is no number/.test(reason)).length, 3);
  assert.deepEqual(fromCsv(depth, {columns: {priority: null}}).frame.members, members);
});

test('the preview has at most 20 rows, and a column that is not there is listed', () => {
  const long = `${names.join()}\n${text(Array.from({length: 50}, (_, i) => [`m${i}`, ...rows[0].slice(1)]), ',')}`;
  const {headings, places, rows: first} = columnsOf(long);
  assert.deepEqual([headings, first.length, first[19][0]], [names, 20, 'm19']);
  assert.deepEqual(places, Object.fromEntries(names.map((name, i) => [name, i])));
  const lost = fromCsv(long, {columns: {wall: 9}});
  assert.equal(lost.frame, null);
  assert.match(lost.notUnderstood[0].reason, /there is no column of index 9 for wall/);
  for (const empty of ['', '\n', ';;;', 'a']) assert.equal(fromCsv(empty, {columns: only({id: 0}), headings: false}).frame, null, empty);
});

test('the command takes numbers of columns from 1, and refuses others', () => {
  const folder = mkdtempSync(join(tmpdir(), 'columns-'));
  try {
    const file = join(folder, 'tubes.csv');
    writeFileSync(file, text(rows, ';', ','));
    const run = (...more) => execFileSync(process.execPath, [fileURLToPath(new URL('../dist/main.js', import.meta.url)), file, '--no-headings', ...more],
      {encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe']});
    const columns = names.flatMap((name, i) => ['--column', `${name}=${i + 1}`]);
    assert.deepEqual(JSON.parse(run(...columns)).members, members);
    assert.throws(() => run('--column', 'wall=gauge'), ({status, stderr}) => status === 2 && /takes the number of a column/.test(stderr));
  } finally {
    rmSync(folder, {recursive: true});
  }
});
