// The table of members and the warnings of a frame: what is pasted, renamed, removed and fixed.
import {strict as assert} from 'node:assert';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {load} from './load.mjs';

const frame = await load('src/frame/members.ts');
const {summarise} = await load('src/frame/warnings.ts');
const example = (name) => JSON.parse(readFileSync(new URL(`../../examples/frames/${name}.json`, import.meta.url)));
const sizes = new Map([['CHS 60.3x4', {outer: 60.3, wall: 4}], ['CHS 48.3x3.2', {outer: 48.3, wall: 3.2}]]);
const column = (id) => frame.columns.find((each) => each.id === id);
const ids = (body) => body.members.map(({id}) => id);
const references = (body) => [...(body.joints ?? []).flatMap(({between}) => between), ...(body.ends ?? []).map(({member}) => member)];

test('a copied table that is pasted gives the same members', () => {
  for (const name of ['roll-cage-of-12', 'truss-of-19', 'truss-of-500']) {
    const body = example(name);
    const text = frame.copyCells(body, body.members.map((_, i) => i));
    const empty = {members: []};
    const rows = frame.pasteCells(empty, frame.cellsOf(text), [], {row: 0, column: 0}, sizes);
    assert.equal(rows.length, body.members.length);
    assert.deepEqual(empty.members, body.members.map(({up: _, ...member}) => member), name);
  }
});

test('cells are pasted from the active one on, decimal commas are read, rows are added', () => {
  const body = {members: [{id: 'A', start_mm: [0, 0, 0], end_mm: [1, 0, 0], size: 'CHS 60.3x4'}, {id: 'B', start_mm: [0, 0, 0], end_mm: [2, 0, 0], size: 'CHS 60.3x4'}]};
  const rows = frame.pasteCells(body, frame.cellsOf('1,5\t2\r\n3\t4\r\n5\t6\r\n'), [0, 1], {row: 1, column: frame.columns.indexOf(column('end x'))}, sizes);
  assert.deepEqual(rows, [1, 2, 3]);
  assert.deepEqual(body.members.map(({end_mm}) => end_mm.slice(0, 2)), [[1, 0], [1.5, 2], [3, 4], [5, 6]]);
  assert.equal(new Set(ids(body)).size, 4, 'new members have names of their own');
});

test('headings in any order lead to their columns, a known name to its member', () => {
  const body = example('truss-of-19');
  const [first] = ids(body);
  const lines = `Wall (mm)\tName\tOD\tX1\n7\t${first}\t99\t-3\n6\textra\t50\t1`;
  frame.pasteCells(body, frame.cellsOf(lines), [0], {row: 0, column: 0}, sizes);
  assert.equal(body.members.length, 20);
  const {start_mm, outer_diameter_mm, wall_mm, size} = body.members[0];
  assert.deepEqual([start_mm[0], outer_diameter_mm, wall_mm, size], [-3, 99, 7, undefined]);
  const {id, outer_diameter_mm: diameter} = body.members[19];
  assert.deepEqual([id, diameter], ['extra', 50]);
});

test('a renamed member keeps its joints and ends, and a taken name is refused', () => {
  const body = {...example('roll-cage-of-12'), ends: [{member: 'diagonal', end: 'start', kerf_mm: 1}]};
  const before = references(body);
  frame.renameMember(body, ids(body).indexOf('diagonal'), 'brace');
  assert.deepEqual(references(body), before.map((id) => (id === 'diagonal' ? 'brace' : id)));
  const whole = structuredClone(body);
  for (const taken of ['windscreen', 'floor']) {
    frame.renameMember(body, 0, taken);
    assert.match(frame.nameRefused(body, 0, taken), /is taken/);
  }
  assert.equal(frame.nameRefused(body, 0, ids(body)[0]), undefined);
  assert.deepEqual(body, whole);
});

test('a changed copy shares what stayed equal, and is equal to the copy', async () => {
  const {sharing} = await load('src/json.ts');
  const was = example('truss-of-19');
  const now = structuredClone(was);
  now.members[3].wall_mm = 9;
  const made = sharing(was, now);
  assert.deepEqual(made, now);
  assert.ok(made.members.every((member, i) => (member === was.members[i]) === (i !== 3)));
  assert.equal(sharing(was, structuredClone(was)), was);
});

test('removed members leave no reference to them', () => {
  const body = {...example('roll-cage-of-12'), ends: [{member: 'diagonal', end: 'start', kerf_mm: 1}]};
  const gone = new Set([0, 8]);
  const names = ids(body).filter((_, i) => gone.has(i));
  frame.removeMembers(body, gone);
  assert.equal(body.members.length, 10);
  assert.ok(references(body).every((id) => !names.includes(id)));
  assert.equal(body.ends, undefined);
});

test('new names are free, number on and keep leading zeros', () => {
  assert.equal(frame.freeName(new Set(), 'P1'), 'P1');
  assert.equal(frame.freeName(new Set(['P1', 'P2']), 'P1'), 'P3');
  assert.equal(frame.freeName(new Set(['P09', 'P10']), 'P09'), 'P11');
  assert.equal(frame.freeName(new Set(['brace']), 'brace'), 'brace 2');
  const body = example('truss-of-19');
  for (let i = 0; i < 30; ++i) frame.addMember(body, i % 19);
  assert.equal(new Set(ids(body)).size, 49);
  const {start_mm, end_mm} = body.members[48];
  assert.ok(Math.hypot(...start_mm.map((v, i) => v - end_mm[i])) > 100);
});

test('a size replaces diameter and wall, and either of these replaces the size', () => {
  const member = {id: 'A', start_mm: [0, 0, 0], end_mm: [1, 0, 0], size: 'CHS 48.3x3.2'};
  frame.writeCell(member, column('wall'), 5, sizes);
  assert.deepEqual(member, {id: 'A', start_mm: [0, 0, 0], end_mm: [1, 0, 0], outer_diameter_mm: 48.3, wall_mm: 5});
  frame.writeCell(member, column('size'), 'CHS 60.3x4', sizes);
  assert.deepEqual(member, {id: 'A', start_mm: [0, 0, 0], end_mm: [1, 0, 0], size: 'CHS 60.3x4'});
});

test('filling down copies a value, and numbers names', () => {
  const body = example('truss-of-19');
  frame.fillDown(body, [2, 5, 7], column('end z'), sizes);
  assert.deepEqual([5, 7].map((i) => body.members[i].end_mm[2]), [body.members[2].end_mm[2], body.members[2].end_mm[2]]);
  frame.fillDown(body, [0, 1, 2], column('id'), sizes);
  assert.equal(new Set(ids(body)).size, 19);
});

test('search finds every word, and order is that of the values', () => {
  const body = example('truss-of-500');
  const found = frame.foundRows(body, 'brace b');
  assert.ok(found.length > 10 && found.every((row) => /brace/i.test(body.members[row].id) && /b/i.test(body.members[row].id)));
  assert.deepEqual(frame.foundRows(body, 'no such member'), []);
  const all = body.members.map((_, i) => i);
  const rising = frame.sortRows(body, all, column('start x'), false, sizes);
  assert.deepEqual([...rising].sort((a, b) => a - b), all);
  assert.ok(rising.every((row, i) => i === 0 || body.members[rising[i - 1]].start_mm[0] <= body.members[row].start_mm[0]));
  const names = frame.sortRows({members: ['P10', 'P9', 'P1'].map((id) => ({id}))}, [0, 1, 2], column('id'), false, sizes);
  assert.deepEqual(names, [2, 1, 0]);
});

const warn = (code, pointer, detail) => ({code, severity: 'cut', pointer, detail, action: ''});

test('warnings are grouped by member, a pair is counted once', () => {
  const body = example('roll-cage-of-12');
  const {counts, groups} = summarise([
    warn('members_overlap', '/members/8', 'it and harness share metal, up to 2 mm deep, at 0, 0, 0 mm'),
    warn('members_overlap', '/members/9', 'it and diagonal share metal, up to 2 mm deep, at 0, 0, 0 mm'),
    warn('free_end', '/members/1/end_mm', 'main right meets no member here, and misses diagonal by 22.8673 mm'),
    warn('end_open', '/members/8/end_mm', ''),
  ], body);
  assert.deepEqual(counts, [['members_overlap', 1], ['free_end', 1], ['end_open', 1]]);
  assert.deepEqual(groups.map(({name, reported}) => [name, reported.length]), [['main right', 1], ['diagonal', 2]]);
});

test('fixes change the request as they state', () => {
  const body = example('roll-cage-of-12');
  const [{reported: [{fixes}]}] = summarise([warn('free_end', '/members/1/end_mm', 'main right meets no member here, and misses diagonal by 22.8673 mm')], body).groups;
  assert.deepEqual(fixes.map(({name}) => name), ['Raise within to 24 mm', 'Square the end']);
  const [raise, square] = fixes;
  raise.apply(body);
  assert.deepEqual(body.connect, {within_mm: 24});
  square.apply(body);
  square.apply(body);
  const planes = body.others.filter(({id}) => id === 'square main right finish');
  assert.equal(planes.length, 1);
  assert.deepEqual(planes[0].point_mm, body.members[1].end_mm);
  assert.deepEqual(body.joints.at(-1).between, ['main right', 'square main right finish']);
  frame.removeMembers(body, new Set([1]));
  assert.ok(!body.others.some(({id}) => id === 'square main right finish'));
  const corner = {members: ['a', 'b'].map((id) => ({id})), joints: [{between: ['b', 'a'], kind: 'set_on'}]};
  const detail = 'cut by a up to 20 mm beyond that member\'s end; both end here, so state a mitre of the two, or lengthen a by 20 mm';
  const [{reported: [{fixes: [mitre]}]}] = summarise([warn('ghost_contact', '/members/1/start_mm', detail)], corner).groups;
  mitre.apply(corner);
  assert.deepEqual(corner.joints, [{between: ['b', 'a'], kind: 'mitre'}]);
  const line = {members: [0, 1].map((i) => ({id: `P${i}`, start_mm: [i * 500, 0, 0], end_mm: [i * 500 + 510, 0, 0], outer_diameter_mm: 60, wall_mm: 4}))};
  const overlap = warn('members_overlap', '/members/0', 'it and P1 share metal, up to 4 mm deep, at 0, 0, 0 mm');
  const [{reported: [{fixes: [merge]}]}] = summarise([overlap], line).groups;
  assert.equal(merge.name, 'Merge in line');
  line.members[1].end_mm = [1000, 300, 0];
  assert.deepEqual(summarise([overlap], line).groups[0].reported[0].fixes, []);
});
