// Rectangular tubes as members: of IFC files, tables and drawings. Axes, sizes and the direction of the height are known
// from other formulas; the service cuts them. TUBECUT_SERVER is the binary.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Service} from '../../../tests/contract/service.mjs';
import {fromCsv, fromDxf, fromIfc} from '../dist/index.js';
import {boxes, tee} from './support/boxes.mjs';
import {between, pick, random} from './support/random.mjs';
import {bytes, rotation, shift, Step} from './support/step.mjs';

let service;
before(async () => {
  service = await Service.start(process.env.TUBECUT_SERVER);
});
after(() => service.stop());
const asked = async (frame, query = '') => {
  const {status, text} = await service.ask(`/v1/frames${query}`, {body: JSON.stringify(frame)});
  return {status, body: JSON.parse(text)};
};

const apart = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));
/** A section is its own mirror image, so its height may lie either way. */
const turned = (a, b) => Math.min(apart(a, b), apart(a, b.map((v) => -v)));
const files = Array.from({length: 150}, (_, i) => boxes(i + 1));

function faults({frame}, {members}) {
  const out = frame?.members.length === members.length ? [] : [`${frame?.members.length} members`];
  for (const {id, ends, up, height, width, wall, outer, inner} of members) {
    const found = frame?.members.find((each) => each.id === id);
    if (!found) { out.push(`no ${id}`); continue; }
    const wrong = (what, ok) => ok || out.push(`${id}: ${what}`);
    wrong('ends elsewhere', apart(found.start_mm, ends[0]) <= 1e-6 && apart(found.end_mm, ends[1]) <= 1e-6);
    wrong(`is turned: ${found.up}, not ${up}`, turned(found.up, up) <= 1e-6);
    const sizes = [[found.height_mm, height], [found.width_mm, width], [found.wall_mm, wall], [found.corner_radius_mm, outer]];
    wrong(`is ${JSON.stringify(found)}`, found.kind === 'rectangular_tube' && sizes.every(([a, b]) => Math.abs(a - b) <= 1e-8));
    wrong('inner radius', inner === undefined ? !('inner_corner_radius_mm' in found) : Math.abs(found.inner_corner_radius_mm - inner) <= 1e-8);
  }
  return out;
}

test('150 IFC files of rectangular tubes come back as they were drawn, and the service takes them', async () => {
  for (const file of files) {
    const found = await fromIfc(bytes(file.text));
    assert.deepEqual(faults(found, file), [], file.name);
    assert.deepEqual(found.asks, [], file.name);
    assert.deepEqual(found.notUnderstood.map(({id}) => id).sort(), file.assumed.map(([id]) => id).sort(), file.name);
    for (const [id, reason] of file.assumed) assert.ok(found.notUnderstood.some((each) => each.id === id && reason.test(each.reason)), file.name);
    const {status, body} = await asked(found.frame, '?validate_only=true');
    assert.equal(status, 200, `${file.name}: ${JSON.stringify(body.errors)}`);
  }
});

test('a profile or a placement that is dropped is seen', async () => {
  let seen = 0;
  for (const file of files.slice(0, 40)) {
    for (const edit of [/(IFCRECTANGLEHOLLOWPROFILEDEF\(\.AREA\.,\$,)#\d+/, /(IFCLOCALPLACEMENT\()#\d+/]) {
      const text = file.text.replace(edit, '$1$');
      assert.notEqual(text, file.text);
      if (faults(await fromIfc(bytes(text)), file).length > 0) ++seen;
    }
    const swapped = file.text.replace(/(IFCRECTANGLEHOLLOWPROFILEDEF\(\.AREA\.,\$,#\d+,)([^,]+),([^,]+)/, '$1$3,$2');
    if (swapped !== file.text) assert.ok(faults(await fromIfc(bytes(swapped)), file).length > 0, file.name);
  }
  assert.equal(seen, 80);
});

test('a tee is cut the same wherever its file places it, and however its profiles are turned', async () => {
  for (let seed = 1; seed <= 12; ++seed) {
    const {members, text} = tee(seed);
    const {frame, notUnderstood} = await fromIfc(bytes(text));
    assert.deepEqual(notUnderstood, []);
    const [placed, drawn] = await Promise.all([frame, {...frame, members}].map((each) => asked(each)));
    for (const {status, body} of [placed, drawn]) assert.equal(status, 200, JSON.stringify(body.errors));
    assert.deepEqual(placed.body.result.joints.map(({branch, kind, chord}) => [branch, kind, chord]), [['post', 'set_on', 'chord']]);
    const lengths = ({body}) => new Map(body.result.cut_list.map((each) => [each.members[0], [each.long_mm, each.weld_mm, each.girth_mm]]));
    for (const [id, list] of lengths(drawn)) list.forEach((v, i) => assert.ok(Math.abs(v - lengths(placed).get(id)[i]) < 1e-4, `${seed} ${id}: ${list}, ${lengths(placed).get(id)}`));
    const other = await asked({...frame, members: frame.members.map((each) => ({...each, height_mm: each.width_mm, width_mm: each.height_mm}))});
    assert.ok(Math.abs(lengths(other).get('post')[0] - lengths(drawn).get('post')[0]) > 1, 'height and width exchanged are seen');
  }
});

/** Beams of one profile each, `sizes` as they stand in the file. */
function beams(...sizes) {
  const step = new Step('IFC4');
  step.units('millimetre');
  const ids = sizes.map((size, i) => {
    const profile = step.add('IFCRECTANGLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', ...size);
    const solid = step.add('IFCEXTRUDEDAREASOLID', profile, step.axes(rotation(1, 90)), step.direction([0, 0, 1]), 1000);
    step.product('IFCBEAM', `B${i + 1}`, step.placement(shift(0, 900 * i, 0)), step.body([solid]));
    return profile;
  });
  return {text: step.text(), ids};
}

test('corners that the service does not cut are requested, never sent and never changed without a word', async () => {
  // Sharp; as much as the wall; less than it; round; more than half the side; an inner radius that leaves no metal.
  const {text, ids} = beams([100, 80, 5, '$', '$'], [100, 80, 5, '$', 5], [100, 80, 5, 0, 4], [100, 80, 5, 5, 10], [100, 80, 5, '$', 45], [100, 80, 5, 0, 20]);
  const open = await fromIfc(bytes(text));
  assert.deepEqual(open.frame.members.map(({id}) => id), ['B4']);
  assert.deepEqual(open.asks.map(({option, count, likely}) => [option, count, likely]), [['corner', 5, ['en_10219', 'en_10210', 'astm_a500']]]);
  assert.deepEqual(open.notUnderstood.map(({id}) => id).filter((id) => id !== 'file').length, 5);
  for (const stated of [{corners: 'en_10219'}, {corners: 'en_10210'}, {corners: 'astm_a500'}, {corner_radius_mm: 8}]) {
    const {frame, notUnderstood, asks} = await fromIfc(bytes(text), stated);
    assert.deepEqual(asks, []);
    assert.deepEqual(frame.members.map(({id, corners, corner_radius_mm}) => [id, {...(corners && {corners}), ...(corner_radius_mm && {corner_radius_mm})}]),
      ['B1', 'B2', 'B3', 'B4', 'B5', 'B6'].map((id) => [id, id === 'B4' ? {corner_radius_mm: 10} : stated]));
    // The first is drawn sharp, as the caller knows; of the others the file states something else.
    assert.deepEqual(notUnderstood.map(({id}) => id), [ids[1], ids[2], ids[4], ids[5]]);
    for (const {reason} of notUnderstood) assert.match(reason, /^assumed: of #\d+ Ifc.*: its corners are those stated for such tubes/);
    assert.equal((await asked(frame)).status, 200);
  }
  for (const wrong of [[100, 80, 40, '$', '$'], [100, 80, 5, -1, 10]]) assert.equal((await fromIfc(bytes(beams(wrong).text), {corners: 'en_10219'})).frame, null);
});

test('what the importer does not send for its corners the service refuses, and what it sends is accepted', async () => {
  const next = random(3);
  const counts = [0, 0];
  const {members: _, ...common} = (await fromIfc(bytes(beams([100, 80, 5, 5, 10]).text))).frame;
  for (let i = 0; i < 200; ++i) {
    const wall = between(next, 1, 8);
    const [a, b] = [between(next, 2.1, 9) * wall + 5, between(next, 2.1, 9) * wall + 5];
    const [outer, inner] = [between(next, 0, 4) * wall, between(next, 0, 2) * wall];
    const {frame} = await fromIfc(bytes(beams([a, b, wall, inner, outer]).text));
    const member = {id: 'B1', start_mm: [0, 0, 0], end_mm: [1000, 0, 0], kind: 'rectangular_tube', width_mm: a, height_mm: b, wall_mm: wall, corner_radius_mm: outer, inner_corner_radius_mm: inner, up: [0, 0, 1]};
    const {status, body} = await asked(frame ?? {...common, members: [member]}, '?validate_only=true');
    if (frame) assert.notEqual(status, 422, JSON.stringify([member, body.errors]));
    else assert.deepEqual([status, body.errors[0].code], [422, 'out_of_range'], JSON.stringify(member));
    ++counts[frame ? 0 : 1];
  }
  assert.ok(counts.every((count) => count > 30), `${counts}`);
});

const heads = 'id,x1,y1,z1,x2,y2,z2';
test('tables with sections come back as they were meant', async () => {
  for (let seed = 1; seed <= 120; ++seed) {
    const next = random(seed + 400);
    const [comma, inUnit] = [next() < 0.4, pick(next, ['mm', 'cm', 'm', 'in'])];
    const mm = {mm: 1, cm: 10, m: 1000, in: 25.4}[inUnit];
    const [mark, number] = [comma ? ';' : ',', (v) => (comma ? String(v).replace('.', ',') : String(v))];
    const way = pick(next, ['radii', 'standard', 'sizes', 'stated']);
    const members = Array.from({length: 5}, (_, i) => {
      const [h, w, t] = [Math.round(between(next, 40, 90)), Math.round(between(next, 40, 90)), pick(next, [2, 3, 4])];
      const ends = [0, 1].map(() => [0, 1, 2].map(() => Math.round(between(next, -9000, 9000)) + 0.25));
      const up = i % 2 ? [0, 1, 2].map(() => Number(between(next, -1, 1).toFixed(4))) : undefined;
      return {id: `M${i}`, h, w, t, ends, up};
    });
    const given = members.map(({id, h, w, t, ends, up}) => {
      const length = (v) => number(Number((v / mm).toPrecision(13)));
      const size = {
        radii: [h, w, t, 2 * t, t].map(length), standard: [h, w, t].map(length).concat('EN 10219-2'), stated: [h, w, t].map(length), sizes: [pick(next, [`RHS ${h}x${w}x${t} EN 10219`, `${h}x${w}x${t} EN10219`, `rhs ${h}x${w}x${t} en 10219-2`])],
      }[way];
      return [id, ...ends.flat().map(length), ...size, ...(up ?? ['', '', '']).map(number)].join(mark);
    });
    const columns = {
      radii: ['Height', pick(next, ['b', 'Width']), 't', 'corner radius', 'inner corner radius'], standard: ['h', 'b', 'wall', 'corners'], stated: ['height', 'width', 'wall'], sizes: ['section'],
    }[way];
    const text = [[...heads.split(','), ...columns, 'up_x', 'up_y', 'up_z'].join(mark), ...given].join('\n');
    const found = fromCsv(text, {unit: inUnit, decimal: comma ? ',' : '.', ...(way === 'stated' ? {corners: 'en_10219'} : {})});
    const told = `${seed} ${JSON.stringify([found.notUnderstood, found.asks])}\n${text}`;
    assert.deepEqual(found.notUnderstood.map(({reason}) => /^assumed: .* rows 2, 4, 6: the height lies along \+z/.test(reason)), [true], told);
    members.forEach(({id, h, w, t, ends, up}, i) => {
      const {start_mm, end_mm, up: is, ...rest} = found.frame.members[i];
      assert.ok(apart(start_mm, ends[0]) < 1e-6 && apart(end_mm, ends[1]) < 1e-6, told);
      assert.ok(apart(is, up ? up.map((v) => v / Math.hypot(...up)) : [0, 0, 1]) < 1e-8, told);
      const corners = way === 'radii' ? {corner_radius_mm: 2 * t, inner_corner_radius_mm: t} : {corners: 'en_10219'};
      assert.deepEqual(rest, {id, kind: 'rectangular_tube', height_mm: h, width_mm: w, wall_mm: t, ...corners}, told);
    });
    if (seed % 10 === 0) assert.ok((await asked(found.frame)).status < 500, told);
  }
});

test('a table may mix round, square, rectangular and oval tubes', async () => {
  const text = `${heads},kind,od,height,width,wall,corner_radius,size
A,0,0,0,2000,0,0,round,114.3,,,5,,
B,0,0,0,0,0,1500,SHS,,60,,4,8,
C,2000,0,0,2000,0,1500,rectangular tube,,80,40,4,8,
D,0,900,0,2000,900,0,flat oval,,60,30,2,,
E,0,0,1500,2000,0,1500,,,,,,,SHS 50x3 EN 10210
F,1000,0,0,1000,0,700,,,,,,,CHS 60.3x3.2
`;
  const {frame, notUnderstood} = fromCsv(text);
  const sizes = frame.members.map(({id: _, start_mm, end_mm, ...rest}) => rest);
  const [z, x] = [{up: [0, 0, 1]}, {up: [1, 0, 0]}];
  assert.deepEqual(sizes, [
    {outer_diameter_mm: 114.3, wall_mm: 5}, {kind: 'rectangular_tube', height_mm: 60, width_mm: 60, wall_mm: 4, corner_radius_mm: 8, ...x},
    {kind: 'rectangular_tube', height_mm: 80, width_mm: 40, wall_mm: 4, corner_radius_mm: 8, ...x}, {kind: 'flat_oval_tube', height_mm: 60, width_mm: 30, wall_mm: 2, ...z},
    {kind: 'rectangular_tube', height_mm: 50, width_mm: 50, wall_mm: 3, corners: 'en_10210', ...z}, {size: 'CHS 60.3x3.2'}]);
  assert.deepEqual(notUnderstood.map(({id, reason}) => [id, /rows 3, 4, 5, 6/.test(reason)]), [['file', true]]);
  const {status, body} = await asked(frame);
  assert.equal(status, 200, JSON.stringify(body.errors));
});

test('tables: what is wrong or not certain of a section is told', () => {
  const columns = `${heads},h,b,wall,corner_radius,up_x,up_y,up_z\nA,0,0,0,900,0,0,60,40,3,6,0,0,1\n`;
  const cases = [
    ['B,0,0,0,900,0,0,60,40,20,6,,,', /wall of 20 mm does not go with sides of 60 and 40/], ['B,0,0,0,900,0,0,60,40,3,3,,,', /too sharp to be cut/],
    ['B,0,0,0,900,0,0,60,40,3,6,1,0,0', /up lies along it/], ['B,0,0,0,900,0,0,60,40,3,6,1,,', /no direction/], ['B,0,0,0,900,0,0,60,40,3,6,0,0,0', /no direction/],
    ['B,0,0,0,900,0,0,60,40,,6,0,0,1', /has no wall/], ['B,0,0,0,900,0,0,60,,3,6,0,0,1', /no column for outer_diameter/],
  ];
  for (const [row, reason] of cases) {
    const {frame, notUnderstood} = fromCsv(`${columns}${row}\n`);
    assert.deepEqual(frame.members.map(({id}) => id), ['A'], row);
    assert.ok(notUnderstood.length === 1 && reason.test(notUnderstood[0].reason), `${row}: ${JSON.stringify(notUnderstood)}`);
  }
  const one = (rest, options) => fromCsv(`${heads}${rest}`, options);
  const open = one(',h,b,t\nA,0,0,0,900,0,0,60,40,3\nB,0,0,0,900,0,0,60,40,3\n');
  assert.deepEqual([open.frame, open.asks.map(({option, count}) => [option, count])], [null, [['corner', 2]]]);
  assert.match(one(',h,b,t,r\nA,0,0,0,900,0,0,60,40,3,6\n').notUnderstood[0].reason, /a radius: state kind .* or the column of corner_radius/);
  assert.equal(one(',h,b,t,r\nA,0,0,0,900,0,0,60,40,3,6\n', {columns: {corner_radius: 'r'}}).frame.members[0].corner_radius_mm, 6);
  assert.match(one(',kind,h,b,t\nA,0,0,0,900,0,0,IPE,60,40,3\n').notUnderstood[0].reason, /kind is not known: IPE/);
  assert.match(one(',size\nA,0,0,0,900,0,0,RHS 60x3\n').notUnderstood[0].reason, /its size is not one/);
  assert.deepEqual(one(',h,b,t\nA,0,0,0,1,0,0,0.06,0.04,0.003\n', {corners: 'en_10219'}).asks.map(({option}) => option), ['unit']);
  assert.match(one(',h,b\nA,0,0,0,900,0,0,60,40\n').notUnderstood[0].reason, /no column for wall/);
});

test('tables of round tubes stay as they were beside other columns', () => {
  const row = (more, cells, options) => fromCsv(`${heads},od,wall${more}\nA,0,0,0,900,0,0,60.3,3.2${cells}\n`, options);
  const plain = row('', '').frame;
  for (const [more, cells] of [[',height,width', ',500,300'], [',kind', ',brace'], [',h [m],b', ',5,"x"'], [',kind,height', ',column,3'], [',up_x', ',7'], [',corners', ',none']])
    assert.deepEqual(row(more, cells), {frame: plain, notUnderstood: [], asks: [], sources: []}, more);
  const sized = (more, cells) => fromCsv(`${heads}${more}\nA,0,0,0,900,0,0${cells}\n`, {size: {outer_diameter_mm: 60.3, wall_mm: 3.2}});
  assert.deepEqual(sized(',height,width', ',500,300'), {frame: plain, notUnderstood: [], asks: [], sources: []});
});

test('a size of rectangular tubes for all rows, or for a layer of a drawing', async () => {
  const csv = (options) => fromCsv(`${heads}\nA,0,0,0,900,0,0\nB,0,0,0,0,0,900\n`, options);
  const rhs = {kind: 'rectangular_tube', height_mm: 60, width_mm: 40, wall_mm: 3, corners: 'en_10219'};
  const sizes = ({frame}) => frame.members.map(({id: _, start_mm, end_mm, ...rest}) => rest);
  const expected = [{...rhs, up: [0, 0, 1]}, {...rhs, up: [1, 0, 0]}];
  assert.deepEqual(sizes(csv({size: {size: 'RHS 60x40x3 EN 10219'}})), expected);
  assert.deepEqual(sizes(csv({size: {size: '60x40x3'}, corners: 'en_10219'})), expected);
  assert.deepEqual(csv({size: {size: '60x40x3'}}).asks.map(({option}) => option), ['corner']);
  const pairs = (...all) => all.map(([code, value]) => `${code}\n${value}\n`).join('');
  const line = (handle, layer, x, z) => pairs([0, 'LINE'], [5, handle], [8, layer], [10, 0], [20, 0], [30, 0], [11, x], [21, 0], [31, z]);
  const drawing = `${pairs([0, 'SECTION'], [2, 'HEADER'], [9, '$INSUNITS'], [70, 4], [0, 'ENDSEC'], [0, 'SECTION'], [2, 'ENTITIES'])}${line('1', 'R', 900, 0)}${line('2', 'R', 0, 900)}${
    line('3', 'C', -900, 0)}${pairs([0, 'ENDSEC'], [0, 'EOF'])}`;
  const chs = {size: 'CHS 60.3x3.2'};
  const drawn = fromDxf(drawing, {R: {size: 'RHS 60x40x3 EN 10219'}, C: chs});
  assert.deepEqual(sizes(drawn), [...expected, chs]);
  assert.deepEqual(drawn.notUnderstood.map(({id, reason}) => [id, /^assumed: .*the height lies along \+z/.test(reason)]), [['layer R', true]]);
  assert.equal((await asked(drawn.frame)).status, 200);
  const open = fromDxf(drawing, {R: {size: 'RHS 60x40x3'}, C: chs});
  assert.deepEqual([open.frame.members.length, open.asks.map(({option, count}) => [option, count])], [1, [['corner', 2]]]);
  assert.deepEqual(sizes(fromDxf(drawing, {R: {size: 'RHS 60x40x3'}, C: chs}, {corners: 'en_10219'})), [...expected, chs]);
});
