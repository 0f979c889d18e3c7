// PCF, CSV and DXF: axes and sizes as in the file, and unreadable items by their line, row or
// handle.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {columnsOf, fromCsv, fromDxf, fromPcf, layersOf, unitOf} from '../dist/index.js';

const apart = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));
const spool = readFileSync(new URL('data/pipe-spool.pcf', import.meta.url), 'utf8');
const ids = ({notUnderstood}) => notUnderstood.map(({id}) => id);

test('a PCF spool: pipes, elbow, and planes where fittings begin', () => {
  const {frame, notUnderstood} = fromPcf(spool, {schedule: 'SCH 40'});
  assert.deepEqual(notUnderstood, []);
  assert.equal(frame.members.length, 6);
  assert.deepEqual(frame.members[3], {id: 'pipe 4', start_mm: [600, 0, 84.15], end_mm: [600, 0, 700], size: 'NPS 4 SCH 40'});
  const [elbow, flange, ...planes] = frame.others;
  assert.deepEqual(elbow, {kind: 'elbow', id: 'elbow 1', outer_diameter_mm: 168.3, bend_radius_mm: 228.6, bend_deg: 90,
    axis: {point_mm: [2400, 0, 0], direction: [1, 0, 0]}, inwards: [0, 0, 1]});
  assert.deepEqual(flange, {kind: 'plane', id: 'flange 1', point_mm: [89, 0, 0], normal: [1, 0, 0]});
  assert.deepEqual(planes.map(({id, point_mm, normal}) => [id, point_mm, normal]), [
    ['elbow 1 end/1', [2400, 0, 0], [-1, 0, 0]], ['elbow 1 end/2', [2628.6, 0, 228.6], [0, 0, 1]], ['valve 1', [600, 0, 700], [0, 0, -1]]]);
  // The pipes beyond the elbow's ends are square; the vent on its back is cut by it.
  assert.deepEqual(frame.joints.map(({between, kind, end}) => [...between, kind, end]), [
    ['pipe 1', 'flange 1', 'set_on', 'start'], ['pipe 2', 'elbow 1 end/1', 'set_on', 'finish'], ['pipe 3', 'elbow 1 end/2', 'set_on', 'start'],
    ['pipe 4', 'valve 1', 'set_on', 'finish'], ['pipe 1', 'pipe 2', 'butt', undefined], ['pipe 6', 'elbow 1', 'set_on', 'start']]);
});

test('the committed example is what the import gives', () => {
  const {frame} = fromPcf(spool, {schedule: 'SCH 40', fields: {kerf_mm: 2, allowances: {clamping_mm: 100}}});
  const example = readFileSync(new URL('../../../examples/frames/pipe-spool-from-pcf.json', import.meta.url), 'utf8');
  assert.deepEqual(JSON.parse(JSON.stringify(frame)), JSON.parse(example));
});

test('the same spool in inches, in hundredths and with DN bores is the same frame', () => {
  const points = /^( +(?:END-POINT|CENTRE-POINT|CO-ORDS) +)(\S+) +(\S+) +(\S+)/gm;
  const by = (k, digits) => (text) => text.replace(points, (_, head, ...xyz) => head + xyz.slice(0, 3).map((v) => (Number(v) * k).toFixed(digits)).join(' '));
  const [mine] = [fromPcf(spool, {schedule: 'SCH 40'})];
  const others = {
    inches: by(1 / 25.4, 12)(spool).replace('UNITS-CO-ORDS MM', 'UNITS-CO-ORDS INCH'),
    hundredths: by(100, 2)(spool).replace('UNITS-CO-ORDS MM', 'UNITS-CO-ORDS MM-HUNDREDTH'),
    DN: spool.replace('UNITS-BORE INCH', 'UNITS-BORE MM').replace(/^( +END-POINT.*?) ([642])( BW)?$/gm, (_, head, n, end = '') => `${head} ${{6: 150, 4: 100, 2: 50}[n]}${end}`),
  };
  for (const [name, text] of Object.entries(others)) {
    assert.notEqual(text, spool);
    const other = fromPcf(text, {schedule: 'SCH 40'});
    assert.deepEqual(other.notUnderstood, mine.notUnderstood, name);
    mine.frame.members.forEach(({start_mm, end_mm, ...rest}, i) => {
      const {start_mm: start, end_mm: end, ...size} = other.frame.members[i];
      assert.ok(apart(start_mm, start) <= 1e-6 && apart(end_mm, end) <= 1e-6, `${name}: ${rest.id}`);
      assert.deepEqual(size, rest, name);
    });
    assert.deepEqual(other.frame.others.map(({id}) => id), ['elbow 1', 'flange 1', 'elbow 1 end/1', 'elbow 1 end/2', 'valve 1'], name);
    assert.ok(apart(other.frame.others[1].point_mm, [89, 0, 0]) <= 1e-6, name);
    assert.ok(Math.abs(other.frame.others[0].bend_radius_mm - 228.6) <= 1e-6, name);
    assert.ok(apart(other.frame.others[0].axis.point_mm, [2400, 0, 0]) <= 1e-6, name);
  }
  const forgotten = fromPcf(others.inches.replace('UNITS-CO-ORDS INCH', 'UNITS-CO-ORDS MM'), {schedule: 'SCH 40'});
  assert.ok(apart(forgotten.frame.members[0].end_mm, [1200, 0, 0]) > 1, 'another unit is seen');
});

test('PCF: just what is wrong is listed', () => {
  const whole = fromPcf(spool, {schedule: 'SCH 40'});
  const cases = [
    ['a thing of its own kind', spool.replace('VALVE', 'CHAMBER'), undefined, ['line 49'], 6],
    ['a word about the file', spool.replace('MATERIALS', 'PROJECT-IDENTIFIER X\nMATERIALS'), undefined, [], 6],
    ['no schedule', spool, {}, ['line 9', 'line 18', 'line 22', 'line 37', 'line 41', 'line 45', 'line 49', 'file'], 1],
    ['another elbow', spool.replace('CENTRE-POINT 2628.6000 0.0000   0.0000', 'CENTRE-POINT 2600.0000 0.0000   0.0000'), undefined, ['line 26'], 6],
    ['an unknown bore', spool.replace(/4 BW/g, '4.7 BW'), undefined, ['line 37', 'line 49', 'file'], 5],
    ['two bores', spool.replace('1200.0000   0.0000   0.0000 6 BW', '1200.0000   0.0000   0.0000 4 BW'), undefined, ['line 9', 'line 18'], 5],
    ['no number', spool.replace('600.0000   0.0000  84.1500', '600.0000   x.0000  84.1500'), undefined, ['line 37', 'line 49'], 5],
    ['one point', spool.replace('    END-POINT   600.0000   0.0000 700.0000 4 BW\n    ITEM', '    ITEM'), undefined, ['line 37', 'line 48'], 5],
    ['too thick', spool.replace('7.11 MM', '7.11 INCH'), undefined, ['line 32'], 5],
    ['a flange at no pipe', spool.replace(/89\.0000( +0\.0000 +0\.0000 6 BW\n +SKEY)/, '88.0000$1'), undefined, ['line 9'], 6],
  ];
  for (const [name, text, options = {schedule: 'SCH 40'}, expected, members] of cases) {
    if (name !== 'no schedule') assert.notEqual(text, spool, name);
    const found = fromPcf(text, options);
    assert.deepEqual(ids(found), expected, `${name}: ${JSON.stringify(found.notUnderstood)}`);
    assert.equal(found.frame.members.length, members, name);
  }
  for (const unit of ['UNITS-CO-ORDS MM', 'UNITS-BORE INCH']) {
    const {frame, notUnderstood} = fromPcf(spool.replace(unit, ''), {schedule: 'SCH 40'});
    assert.equal(frame, null);
    assert.deepEqual(notUnderstood.map(({id, type}) => [id, type]), [['file', 'PCF']]);
    assert.match(notUnderstood[0].reason, new RegExp(unit.split(' ')[0]));
  }
});

const csv = `id,start_x,start_y,start_z,end_x,end_y,end_z,outer_diameter,wall,size,priority
chord,-900,0,0,900,0,0,219.1,10,,0
"brace, left",-40,0,0,-850,0,810,,,CHS 114.3x6.3,1
brace,40,0,0,850,0.5,810,114.3,6.3,,1
`;

test('CSV: columns by name, by a mapper, in another unit', () => {
  const {frame, notUnderstood} = fromCsv(csv);
  assert.deepEqual(notUnderstood, []);
  assert.deepEqual(frame.members, [
    {id: 'chord', start_mm: [-900, 0, 0], end_mm: [900, 0, 0], outer_diameter_mm: 219.1, wall_mm: 10, priority: 0},
    {id: 'brace, left', start_mm: [-40, 0, 0], end_mm: [-850, 0, 810], size: 'CHS 114.3x6.3', priority: 1},
    {id: 'brace', start_mm: [40, 0, 0], end_mm: [850, 0.5, 810], outer_diameter_mm: 114.3, wall_mm: 6.3, priority: 1},
  ]);
  const german = `\uFEFFName;X1;Y1;Z1;X2;Y2;Z2\nP1;0;0;0;39.370078740157;0;0\n;0;0;0;0;10;0\nP1;0;0;0;0;0;10\n`;
  const columns = {id: 'Name', start_x: 'X1', start_y: 'Y1', start_z: 'Z1', end_x: 'X2', end_y: 'Y2', end_z: 'Z2'};
  const mapped = fromCsv(german, {columns, unit: 'in', size: {outer_diameter_mm: 48.3, wall_mm: 2.6}});
  assert.deepEqual(mapped.notUnderstood, []);
  assert.deepEqual(mapped.frame.members.map(({id}) => id), ['P1', 'row 3', 'P1 row 4']);
  assert.ok(apart(mapped.frame.members[0].end_mm, [1000, 0, 0]) < 1e-6);
  assert.deepEqual(mapped.frame.members[1].end_mm, [0, 254, 0]);
  assert.deepEqual(columnsOf('ID, Start X [mm],end-x,wall_mm').columns, {id: 'ID', start_x: 'Start X [mm]', end_x: 'end-x', wall: 'wall_mm'});
});

test('CSV: just the wrong rows are listed', () => {
  const rows = csv.trimEnd().split('\n');
  const wrong = {
    'no wall': 'a,0,0,0,1,0,0,60.3,,,1', 'no number': 'a,0,zero,0,1,0,0,60.3,3,,1', 'a comma for a point': 'a,0,0,0,"1,5",0,0,60.3,3,,1',
    'no length': 'a,1,2,3,1,2,3,60.3,3,,1', 'a wall too thick': 'a,0,0,0,1,0,0,60.3,40,,1', 'too short': 'a,0,0',
  };
  for (const [name, row] of Object.entries(wrong)) {
    const found = fromCsv([...rows.slice(0, 2), row, ...rows.slice(2)].join('\r\n'));
    assert.deepEqual(ids(found), ['row 3'], name);
    assert.equal(found.frame.members.length, 3, name);
  }
  const lost = fromCsv(csv, {columns: {wall: 'thickness'}});
  assert.equal(lost.frame, null);
  assert.match(lost.notUnderstood[0].reason, /no column "thickness" for wall/);
  const dropped = fromCsv(csv.replace('wall', 'other'));
  assert.deepEqual(dropped.notUnderstood.map(({id, reason}) => [id, /no column for wall .*rows 2, 4 /.test(reason)]), [['file', true]]);
  assert.deepEqual(dropped.frame.members.map(({id}) => id), ['brace, left']);
});

const pair = (...all) => all.map(([code, value]) => `${code}\n${value}\n`).join('');
const drawing = (units, ...entities) =>
  pair([0, 'SECTION'], [2, 'HEADER'], ...(units === undefined ? [] : [[9, '$INSUNITS'], [70, units]]), [0, 'ENDSEC'], [0, 'SECTION'], [2, 'ENTITIES']) +
  entities.join('') + pair([0, 'ENDSEC'], [0, 'EOF']);
const line = (handle, layer, [a, b, c], [d, e, f]) => pair([0, 'LINE'], [5, handle], [8, layer], [10, a], [20, b], [30, c], [11, d], [21, e], [31, f]);
const lw = (handle, layer, points, more = []) => pair([0, 'LWPOLYLINE'], [5, handle], [8, layer], [90, points.length], ...more,
  ...points.flatMap(([x, y, bulge]) => [[10, x], [20, y], ...(bulge ? [[42, bulge]] : [])]));
const poly = (handle, layer, points) => pair([0, 'POLYLINE'], [5, handle], [8, layer], [66, 1], [70, 8]) +
  points.map(([x, y, z], i) => pair([0, 'VERTEX'], [5, `${handle}${i}`], [8, layer], [10, x], [20, y], [30, z], [70, 32])).join('') + pair([0, 'SEQEND'], [5, `${handle}F`]);
const arc = (handle, layer, [x, y, z], radius, from, to, more = []) =>
  pair([0, 'ARC'], [5, handle], [8, layer], [10, x], [20, y], [30, z], [40, radius], ...more, [50, from], [51, to]);

const sizes = {CHORD: {outer_diameter_mm: 88.9, wall_mm: 5}, BRACE: {size: 'CHS 48.3x3.2'}};
const text = drawing(4, line('A1', 'CHORD', [0, 0, 0], [4000, 0, 0]), line('A2', 'BRACE', [500, 0, 0.25], [1000, 0, 500]),
  poly('A3', 'BRACE', [[0, 0, 500], [1000, 0, 500], [1000, 800, 700]]), lw('A4', 'CHORD', [[0, 0], [300, 0, Math.tan(Math.PI / 8)], [500, 200], [500, 900]], [[38, 50]]),
  arc('A5', 'CHORD', [0, 0, 10], 300, 90, 180));

test('DXF: lines, polylines and arcs, sizes by layer', () => {
  const {frame, notUnderstood} = fromDxf(text, sizes);
  assert.deepEqual(notUnderstood, []);
  const runs = frame.members.map(({id, start_mm, end_mm, ...size}) => [id, start_mm, end_mm, size]);
  assert.deepEqual(runs, [
    ['CHORD A1', [0, 0, 0], [4000, 0, 0], sizes.CHORD],
    ['BRACE A2', [500, 0, 0.25], [1000, 0, 500], sizes.BRACE],
    ['BRACE A3/1', [0, 0, 500], [1000, 0, 500], sizes.BRACE],
    ['BRACE A3/2', [1000, 0, 500], [1000, 800, 700], sizes.BRACE],
    ['CHORD A4/1', [0, 0, 50], [300, 0, 50], sizes.CHORD],
    ['CHORD A4/3', [500, 200, 50], [500, 900, 50], sizes.CHORD],
  ]);
  const [bulge, quarter] = frame.others;
  assert.equal(bulge.id, 'CHORD A4/2');
  assert.ok(Math.abs(bulge.bend_deg - 90) < 1e-9 && Math.abs(bulge.bend_radius_mm - 200) < 1e-9);
  assert.deepEqual([bulge.axis.point_mm, bulge.axis.direction, bulge.inwards], [[300, 0, 50], [1, 0, 0], [0, 1, 0]]);
  assert.ok(Math.abs(quarter.bend_deg - 90) < 1e-9 && quarter.bend_radius_mm === 300);
  assert.deepEqual([quarter.axis.point_mm, quarter.axis.direction, quarter.inwards], [[0, 300, 10], [-1, 0, 0], [0, -1, 0]]);
  assert.deepEqual(layersOf(text), ['BRACE', 'CHORD']);
  assert.equal(unitOf(text), 'mm');
});

test('DXF: clockwise bulges, units and what is not understood', () => {
  const clockwise = fromDxf(drawing(1, lw('B1', 'CHORD', [[0, 0, -Math.tan(Math.PI / 8)], [10, 10]])).replace('CHORD', 'CHORD'), {CHORD: sizes.CHORD, L: sizes.CHORD});
  assert.equal(clockwise.frame, null, 'an arc alone is no member');
  const inches = fromDxf(drawing(1, line('B2', 'CHORD', [0, 0, 0], [10, 0, 0]), lw('B3', 'CHORD', [[0, 0, -Math.tan(Math.PI / 8)], [10, 10]])), sizes);
  assert.deepEqual(inches.frame.members[0].end_mm, [254, 0, 0]);
  const [bend] = inches.frame.others;
  // From the origin to (10, 10) in a clockwise quarter about (10, 0): it sets out along +y.
  assert.deepEqual([bend.axis.point_mm, bend.axis.direction, bend.inwards], [[0, 0, 0], [0, 1, 0], [1, 0, 0]]);
  assert.ok(Math.abs(bend.bend_radius_mm - 254) < 1e-9);
  for (const units of [undefined, 0]) {
    const without = drawing(units, line('B4', 'CHORD', [0, 0, 0], [10, 0, 0]));
    assert.equal(fromDxf(without, sizes).frame, null);
    assert.match(fromDxf(without, sizes).notUnderstood[0].reason, /does not state its unit/);
    assert.deepEqual(fromDxf(without, sizes, {unit: 'm'}).frame.members[0].end_mm, [10000, 0, 0]);
  }
  const circle = pair([0, 'CIRCLE'], [5, 'C1'], [8, 'CHORD'], [10, 0], [20, 0], [40, 5]);
  const odd = fromDxf(drawing(4, line('C0', 'CHORD', [0, 0, 0], [9, 0, 0]), circle, line('C2', 'NOTES', [0, 0, 0], [1, 1, 1]), line('C3', 'CHORD', [1, 1, 1], [1, 1, 1]),
    arc('C4', 'BRACE', [0, 0, 0], 5, 0, 90), arc('C5', 'CHORD', [0, 0, 0], 500, 0, 90, [[210, 0], [220, 0], [230, -1]]),
    poly('C6', 'CHORD', [[0, 0, 0], [5, 0, 0], [5, 5, 0]]).replace('70\n8\n', '70\n64\n'), line('C7', 'CHORD', [0, 0, 0], [7, 0, 0]).replace('8\n', '67\n1\n8\n')), sizes);
  assert.deepEqual(ids(odd), ['handle C1', 'handle C2', 'handle C3', 'handle C4', 'handle C5', 'handle C6', 'handle C7']);
  assert.deepEqual(odd.frame.members.map(({id}) => id), ['CHORD C0']);
  for (const broken of ['', 'hello', '0\nSECTION\n'])
    assert.equal(fromDxf(broken, sizes).notUnderstood[0].id, 'file', broken);
});
