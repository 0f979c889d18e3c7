// NC1 of other programs, refusals and lists. The service takes what is imported; TUBECUT_SERVER is the binary.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Service} from '../../../tests/contract/service.mjs';
import {fromNc1} from '../dist/index.js';
import {bores, developed, file, mitredFaces, outline, pipe, squareFaces} from './support/nc1_files.mjs';

let service;
before(async () => {
  service = await Service.start(process.env.TUBECUT_SERVER);
});
after(() => service.stop());
const asked = async (part) => {
  const {status, text} = await service.ask('/v1/parts', {body: JSON.stringify(part)});
  assert.equal(status, 200, text.slice(0, 800));
  return JSON.parse(text).result;
};
const said = ({notUnderstood}) => notUnderstood.map(({id, type, reason}) => `${id} ${type}: ${reason}`);
const refused = (text, pattern) => {
  const {part, notUnderstood} = fromNc1(text);
  assert.equal(part, null);
  const {id, type, reason} = notUnderstood[notUnderstood.length - 1];
  assert.deepEqual([id, type], ['file', 'NC1']);
  assert.match(reason, pattern);
};

test('a rectangular tube with holes on three faces', async () => {
  const holes = [bores(['o', 89.01, 's', 20, 17.5], ['o', 174.93, 's', 18, 17.5]), bores(['u', 61.98, 's', 20, 17.5]), bores(['v', 500, 'u', 25, 9, 0], ['', 540, '', 25, 9, 0])];
  const found = fromNc1(file({blocks: [...squareFaces(), ...holes]}));
  assert.deepEqual(said(found), []);
  const {part} = found;
  assert.deepEqual(part.target, {id: 'R-3', kind: 'rectangular_tube', height_mm: 60, width_mm: 40, wall_mm: 4, corner_radius_mm: 8, length_mm: 1000});
  assert.deepEqual(part.ends, {start: {square_at_mm: 0}, finish: {square_at_mm: 0}});
  assert.deepEqual(part.reference, {order: 'A-12', drawing: '7', material: 'S355J2H', quantity: 2});
  assert.deepEqual(part.cutouts.map(({id, shape, at}) => [id, shape.diameter_mm, at.z_mm, at.face, at.offset_mm]), [
    ['BO 1', 17.5, 89.01, 1, 0], ['BO 2', 17.5, 174.93, 1, -2], ['BO 3', 17.5, 61.98, 3, 0], ['BO 4', 9, 500, 2, 5], ['BO 5', 9, 540, 2, 5]]);
  assert.deepEqual(found.sources[0], {id: 'BO 1', entity: 'line 52', type: 'BO'});
  assert.equal((await asked(part)).cutouts.length, 5);
});

test('a mitre by a saw is a plane, and each end is read by itself', async () => {
  const rise = 33.59;
  const found = fromNc1(file({saw: [-29.24, 0, 0, 0], blocks: mitredFaces(rise)}));
  assert.deepEqual(said(found).map((each) => each.replace(/^line \d+/, 'line')), ['line AK: assumed: the start is cut flush with its plane, without a groove']);
  const {start, finish} = found.part.ends;
  assert.deepEqual(finish, {square_at_mm: 0});
  assert.equal(start.cutters.length, 1);
  const [nx, ny, nz] = start.cutters[0].normal;
  assert.ok(Math.abs(-nx / nz - rise / 60) < 1e-3 && Math.abs(ny) < 1e-9, `${start.cutters[0].normal}`);
  assert.ok(Math.abs(found.part.target.length_mm - (1000 - rise / 2)) < 0.02);
  const {lengths, ends} = await asked(found.part);
  assert.ok(Math.abs(lengths.long_mm - 1000) < 0.02 && ends.start, `${lengths.long_mm}`);
});

test('a saw\'s angle that the outline does not have is listed, and is a plane where there is no outline', () => {
  assert.ok(said(fromNc1(file({saw: [0, 45, 0, 0], blocks: squareFaces()}))).some((each) => /header finish: a saw's angle of 45 deg, and the outline is square/.test(each)));
  const found = fromNc1(file({saw: [0, 60.8, 0, 0], blocks: []}));
  assert.deepEqual(said(found), ["header finish: assumed: a plane by the saw's angle of 60.8 deg, because the file has no AK"]);
  const [nx, , nz] = found.part.ends.finish.cutters[0].normal;
  // The side of face 1 is the shorter one, as if an outline drew it.
  const drawn = fromNc1(file({blocks: [outline('v', [[0, 0], [1000, 0], [892.64, 60], [0, 60], [0, 0]])]}));
  assert.match(said(drawn).join('\n'), /assumed: the finish is square across the faces that have no outline/);
  const [x, , z] = drawn.part.ends.finish.cutters[0].normal;
  assert.ok(Math.abs(nx / nz - x / z) < 1e-3, `${nx / nz} ${x / z}`);
  assert.ok(Math.abs(found.part.target.length_mm - drawn.part.target.length_mm) < 0.01);
  assert.match(said(fromNc1(file({saw: [0, 0, 30, 0]})))[0], /30 deg across the flange and no AK/);
});

test('a developed pipe: a plane by 72 points, holes round it', async () => {
  const girth = Math.PI * 100;
  const found = fromNc1(file({...pipe, weight: 11.713, blocks: [developed(40), bores(['v', 500, 'u', girth / 4, 20], ['v', 600, 'u', girth, 20, 5]), outline('v', [[700, 100], [760, 100], [760, 140], [700, 140], [700, 100]], 'IK')]}));
  assert.deepEqual(said(found).map((each) => each.replace(/^line \d+/, 'line')), ['line AK: assumed: the start is cut flush with its plane, without a groove']);
  const {cutouts, ends, target} = found.part;
  assert.ok(Math.abs(target.length_mm - 980) < 0.01, `${target.length_mm}`);
  assert.ok(Math.abs(ends.start.cutters[0].normal[0] - 0.4) < 1e-3, `${ends.start.cutters[0].normal}`);
  assert.ok(Math.abs(cutouts[0].at.girth_mm - 0.75 * girth) < 0.01 && girth - cutouts[1].at.girth_mm < 0.01);
  assert.deepEqual([cutouts[2].wall, cutouts[2].shape.pieces.length], ['developed', 4]);
  const {lengths, cutouts: made} = await asked(found.part);
  assert.ok(Math.abs(lengths.long_mm - 1000) < 0.02, `${lengths.long_mm}`);
  assert.ok(Math.abs(made[2].area_outer_mm2 - 2400) < 1e-3);
});

test('a pipe that is drawn face by face', async () => {
  const face = (name) => outline(name, [[0, 0], [1000, 0], [1000, 100], [0, 100], [0, 0]]);
  const found = fromNc1(file({...pipe, blocks: ['v', 'o', 'u', 'h'].map(face).concat(bores(['v', 300, 'u', 50, 22], ['o', 400, 'u', 50, 22], ['v', 500, 'u', 60, 10]))}));
  assert.deepEqual(said(found), []);
  assert.deepEqual(found.part.cutouts.map(({at, shape}) => [at.phi_deg, shape.kind]), [[90, 'circle'], [0, 'circle'], [90, 'contour']]);
  const {cutouts} = await asked(found.part);
  // A hole that is drilled off the middle lies nearer to face o: of the bore's radius, 5 to 15 mm off.
  const points = cutouts[2].points.phi_deg;
  for (const [phi, off] of [[Math.max(...points), 5], [Math.min(...points), 15]]) assert.ok(Math.abs(90 - phi - (Math.asin(off / 45) * 180) / Math.PI) < 0.01, `${phi}`);
});

test('slots: the way between centres, turned on faces whose y runs against the girth', async () => {
  const found = fromNc1(file({blocks: [...squareFaces(), bores(['v', 300, 's', 30, 9, 0, 20, 0, 0], ['o', 400, 's', 20, 9, 0, 8, 9, 30]), 'BO\n  v     500.00s     30.00      9.00       0.00l     20.00       0.00      90.00']}));
  assert.deepEqual(said(found).map((each) => each.replace(/^line \d+/, 'line')), ['line BO: assumed: x and y of a slot are its middle, and its angle grows from x to y; of 3 slots']);
  assert.deepEqual(found.part.cutouts.map(({shape}) => shape), [{kind: 'slot', length_mm: 29, width_mm: 9}, {kind: 'slot', length_mm: 17, width_mm: 9, angle_deg: 30}, {kind: 'slot', length_mm: 29, width_mm: 9, angle_deg: -90}]);
  await asked(found.part);
});

test('unsupported items are listed with their line, their limit and their fix', () => {
  const blocks = [
    ...squareFaces(),
    'BO\n  v 100.00s 30.00 9.00g\n  v 120.00s 30.00 9.00 2.00\n  v 140.00s 30.00 0.00\n  v 160.00s 30.00 9.00 0.00 20.00 15.00 0.00\n  v 180.00s what 9.00\n  v 200.00s 30.00 9.00m\n  v 220.00s',
    'IK\n  v 300.00u 10.00 0.00\n  340.00 10.00 0.00\n  340.00 40.00 0.00',
    'IK\n  v 400.00u 10.00 5.00\n  440.00 10.00 0.00\n  440.00 40.00 0.00\n  400.00 10.00 0.00',
    'SI\n  v 200.00u 30.00 0.00 5 T1\n  v 10.00u',
    'KO\n  v 10.00u 10.00 0.00\n  v 20.00u 10.00 0.00',
    'KO\n  v 10.00u 10.00 0.00',
    'PU\n  v 10.00u 10.00 0.00',
  ];
  const found = fromNc1(file({head: ['A', '7', '53', 'R', 'S355', 'two'], texts: ['RAL 7016', '', '', ''], blocks, end: ['']}));
  const list = said(found).join('\n');
  for (const words of [/line 52 BO: a thread is not read/, /line 53 BO: a blind hole of 2 mm in a wall of 4 mm/, /a hole of 0 mm is a punch mark/, /a slot that is 15 mm wide, and 9 mm at its ends, is not read: draw it as IK/,
    /line 56 BO: "v 180\.00s what 9\.00" is not a row of numbers/, /line 57 BO: a punch mark is not read/, /a hole needs x, y and a diameter/,
    /line 59 IK: the contour is open by 50 mm, and at most 0\.002 mm are closed: repeat its first point/, /line 64 IK: it has a radius or a notch in line 64.*: draw arcs as short lines/,
    /SI: assumed: "T1" is a mark/, /SI: "v 10\.00u" is not face, x, y, angle, height and text/, /KO: 2 blocks \(contours to be marked\) are not read/, /PU: 1 block \(punch marks\) is not read/,
    /header phase: 53/, /header quantity: two is not a whole number/, /header text: RAL 7016/, /file NC1: it has no EN at its end/]) assert.match(list, words);
  assert.deepEqual(found.part.marks, [{text: 'T1', z_mm: 200, girth_mm: found.part.marks[0].girth_mm}]);
  assert.equal(found.part.cutouts, undefined);
});

test('a mark on a face lies on its middle', async () => {
  const {part} = fromNc1(file({blocks: [...squareFaces(), 'SI\n  v 200.00u 30.00 0.00 5 T1\n  u 300.00u 20.00 0.00 5r R-3 left']}));
  const {section, marks} = await asked(part);
  assert.deepEqual(part.marks.map(({text}) => text), ['T1', 'R-3 left']);
  const girth = marks.filter(({text}) => part.marks.some((each) => each.text === text)).map((each) => each.girth_mm / section.girth_mm);
  // The middles of faces 2 and 3 of 60 x 40: a quarter and half of the way round.
  assert.ok(Math.abs(girth[0] - 0.25) < 1e-9 && Math.abs(girth[1] - 0.5) < 1e-9, `${girth}`);
});

test('an end that is no plane is not guessed: it is listed with its distance from one', () => {
  const girth = Math.PI * 100;
  const fish = Array.from({length: 73}, (_, i) => [20 * Math.sin((4 * Math.PI * i) / 72), (girth * i) / 72]).reverse();
  const coped = fromNc1(file({...pipe, blocks: [outline('v', [...fish, [1000, 0], [1000, girth], fish[0]])]}));
  assert.match(said(coped).join('\n'), /the start is no plane: its outline lies up to 2\d(\.\d+)? mm off the nearest plane, and at most 0\.05 mm are one.*square at its outermost point.*state its partner/);
  assert.deepEqual(coped.part.ends, {start: {square_at_mm: 0}, finish: {square_at_mm: 0}});
  const notched = fromNc1(file({blocks: [outline('v', [[0, 0], [400, 0], [400, 10], [500, 10], [500, 0], [1000, 0], [1000, 60], [0, 60], [0, 0]])]}));
  assert.match(said(notched).join('\n'), /the outline of face v does not go once along both sides: it has a notch, a radius or another width\n.*the start is not known/);
  const radius = fromNc1(file({blocks: ['AK\n  v 0.00u 0.00 0.00\n  1000.00 0.00 10.00\n  1000.00 60.00 0.00\n  0.00 60.00 0.00\n  0.00 0.00 0.00']}));
  assert.match(said(radius).join('\n'), /a notch, a radius/);
});

test('blocks that a hand changed in a file of ours count before their comments', async () => {
  const body = {target: {outer_diameter_mm: 88.9, wall_mm: 5, length_mm: 600}, ends: {start: {square_at_mm: 0}, finish: {square_at_mm: 0}}, kerf_mm: 1, sampling: {uniform_points: 36},
    cutouts: [{id: 'bolt', shape: {kind: 'circle', diameter_mm: 18}, at: {z_mm: 200, phi_deg: 90}}, {id: 'door', shape: {kind: 'slot', length_mm: 40, width_mm: 20}, at: {z_mm: 300, phi_deg: 90}}]};
  const {status, text} = await service.ask('/v1/parts?format=nc1', {body: JSON.stringify(body)});
  assert.equal(status, 200, text);
  const bore = /^  v     200\.000u .*$/m.exec(text)[0];
  const moved = fromNc1(text.replace(bore, bore.replace('200.000', '222.000')));
  assert.match(said(moved).join('\n'), /BO: its comment states a shape 22 mm from the block: the block is read/);
  assert.deepEqual(moved.part.cutouts.map(({id, at}) => [id, at.z_mm]).sort(), [['BO 2', 222], ['door', 300]]);
  const longer = fromNc1(text.replaceAll('     600.000 ', '     650.000 '));
  assert.match(said(longer).join('\n'), /finish AK: its comment states another end than its outline: the outline is read/);
  assert.equal(longer.part.target.length_mm + 0 * longer.part.ends.finish.square_at_mm, 600);
  assert.equal(longer.part.ends.finish.square_at_mm, -50);
  await asked(longer.part);
});

test('holes for branches and marks of partners in a file of ours are listed', async () => {
  const body = readFileSync(new URL('../../../examples/parts/chord-with-holes.json', import.meta.url), 'utf8');
  const {text} = await service.ask('/v1/parts?format=nc1', {body});
  const found = fromNc1(text);
  assert.deepEqual(said(found).map((each) => each.replace(/^line \d+/, 'line')), [
    ...Array(2).fill('line IK: assumed: a hole for a branch is an opening with this outline, square to the tube; its branch is not stated, and its bevel is not read'),
    'comments marks: 2 marks of partners are not read']);
  await asked(found.part);
});

test('a flat oval of ours comes back', async () => {
  const body = {preset: 'tube_laser', target: {id: 'F', kind: 'flat_oval_tube', height_mm: 40, width_mm: 100, wall_mm: 3, length_mm: 900}, kerf_mm: 0.2, sampling: {uniform_points: 72},
    ends: {start: {square_at_mm: 0}, finish: {cutters: [{kind: 'plane', point_mm: [0, 0, 0], normal: [0, 0.5, 1]}]}}, cutouts: [{id: 'a', shape: {kind: 'circle', diameter_mm: 9}, at: {z_mm: 300, face: 1, offset_mm: 12}, wall: 'through'}]};
  const {text} = await service.ask('/v1/parts?format=nc1', {body: JSON.stringify(body)});
  const found = fromNc1(text);
  assert.deepEqual([said(found), found.part.target.kind], [[], 'flat_oval_tube']);
  const [one, other] = [await asked(body), await asked({...found.part, sampling: body.sampling})];
  assert.ok(Math.abs(one.lengths.volume_mm3 / other.lengths.volume_mm3 - 1) < 1e-7);
});

test('CRLF, Latin 1, a comma between columns, a header without its last lines', () => {
  const text = file({head: ['Geländer', '7', '1', 'Träger', 'S355', '1'], blocks: [...squareFaces(), 'BO\n  v, 300.00s, 30.00, 9.00']});
  const latin = Uint8Array.from(text.replace(/\n/g, '\r\n'), (c) => c.charCodeAt(0));
  for (const each of [text, text.replace(/\n/g, '\r\n'), `\uFEFF${text}`, latin, new TextEncoder().encode(text)]) {
    const {part, notUnderstood} = fromNc1(each);
    assert.deepEqual([part.target.id, part.reference.order, part.cutouts.length, notUnderstood], ['Träger', 'Geländer', 1, []]);
  }
  const short = file({texts: [], blocks: squareFaces()});
  assert.deepEqual(said(fromNc1(short)), []);
});

test('corners that cannot be cut are requested', () => {
  for (const radius of [0, 4]) {
    const text = file({radius, blocks: squareFaces()});
    const {part, asks} = fromNc1(text);
    assert.deepEqual([part, asks.map(({option, likely}) => [option, likely[0]])], [null, [['corner', 'en_10219']]]);
    assert.equal(fromNc1(text, {corners: 'en_10219'}).part.target.corners, 'en_10219');
    assert.equal(fromNc1(text, {corner_radius_mm: 7}).part.target.corner_radius_mm, 7);
  }
});

test('refusals state the fault, the limit and the fix', () => {
  const blocks = squareFaces();
  refused(file({code: 'I', profile: 'HEB400', blocks}), /profile code I \(HEB400\) is not a tube: this reader takes RO \(round tube\) and M \(rectangular tube\); write the file with one of these codes/);
  for (const code of ['RU', 'L', 'U', 'B', 'SO', '']) refused(file({code, blocks}), /profile code .* is not a tube/);
  refused('%\nO1000\nG90', /does not begin with ST: line 1 is "%"/);
  refused('', /has no ST/);
  refused('ST\n  A\n  B\nEN\n', /header has \d+ lines, and the profile needs the first 14/);
  refused(file({length: 'long', blocks: []}), /its length "long" is not a number/);
  refused(file({blocks: []}).replace('      60.00', '      60,00'), /its height "60,00" is not a number: write it with a point/);
  refused(file({wall: 30, blocks}), /a wall of 30 mm is not less than half of the side of 40 mm/);
  refused(file({wall: 0, blocks}), /no wall thickness/);
  refused(file({...pipe, width: 80, blocks}), /height of 100 mm and its width of 80 mm are not one diameter/);
  refused(file({...pipe, blocks: [outline('v', [[0, 0], [1000, 0], [1000, 200], [0, 200], [0, 0]])]}), /outline is 200 mm high, so it is not known whether y is measured round the tube: .* 100 mm \(face by face\) or 314\.16 mm high \(developed\)/);
  refused(file({...pipe, blocks: []}), /it has no AK, so it is not known/);
  refused(file({length: '0.00', blocks: []}), /ends lie 0 mm apart, which must be more than 0/);
});

test('the command line chooses the reader by the ending', () => {
  const folder = mkdtempSync(join(tmpdir(), 'tubecut-nc1-'));
  try {
    const run = (name, text, ...more) => {
      writeFileSync(join(folder, name), text);
      return spawnSync(process.execPath, [new URL('../dist/main.js', import.meta.url).pathname, join(folder, name), ...more], {encoding: 'utf8'});
    };
    const good = file({blocks: [...squareFaces(), bores(['v', 300, 's', 30, 9])]});
    for (const name of ['a.nc1', 'a.nc', 'A.DSTV']) {
      const {status, stdout, stderr} = run(name, good, '--fields', '{"kerf_mm": 2}', '--sources', join(folder, 'of.csv'));
      assert.deepEqual([status, stderr, JSON.parse(stdout).kerf_mm, JSON.parse(stdout).cutouts.length], [0, '', 2, 1]);
    }
    assert.equal(run('a.nc1', file({code: 'I', blocks: []})).status, 1);
    assert.match(run('a.nc1', file({radius: 0, blocks: []})).stderr, /state: --corner en_10219\nthere is no part\n$/);
    assert.equal(run('a.nc1', file({radius: 0, blocks: []}), '--corner', 'astm_a500').status, 0);
    assert.equal(run('a.nc1', file({blocks: [...squareFaces(), 'PU\n  v 1.00 1.00']})).status, 3);
  } finally {
    rmSync(folder, {recursive: true});
  }
});
