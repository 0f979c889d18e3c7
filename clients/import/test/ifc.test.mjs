// Thirty IFC files whose axes are known: they come back within 1e-6 mm, with equal sizes. And
// spoilt ones: only the spoilt items are listed.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {catalogue, fromIfc} from '../dist/index.js';
import {models} from './support/models.mjs';
import {bytes, rotation, shift, Step} from './support/step.mjs';
import {written} from './support/written.mjs';

const apart = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));
const size = (v) => Math.hypot(...v);
const read = (text, options) => fromIfc(bytes(text), options);

/** As numbers; a listed size by its name. */
const measured = (member) => catalogue.find(({name}) => name === member.size) ?? member;

/** Returns the faults of an import, in words; nothing if it is as expected. */
function faults({frame, notUnderstood}, {members, others, joints = []}) {
  const out = notUnderstood.map(({id, reason}) => `${id}: ${reason}`);
  if (!frame) return [...out, 'no frame'];
  const wrong = (what, ok) => ok || out.push(what);
  wrong(`${frame.members.length} members`, frame.members.length === members.length);
  for (const {id, ends: [start, end], outer, wall, section, up} of members) {
    const found = frame.members.find((each) => each.id === id);
    if (!found) { out.push(`no ${id}`); continue; }
    wrong(`${id} starts ${apart(found.start_mm, start)} mm off`, apart(found.start_mm, start) <= 1e-6);
    wrong(`${id} ends ${apart(found.end_mm, end)} mm off`, apart(found.end_mm, end) <= 1e-6);
    if (section) {
      for (const [key, value] of Object.entries(section)) wrong(`${id} ${key} ${found[key]}`, Math.abs(found[key] - value) < 1e-8);
      wrong(`${id} is turned`, found.kind === 'rectangular_tube' && apart(found.up, up) <= 1e-8);
      continue;
    }
    const is = measured(found);
    wrong(`${id} is ${is.outer_diameter_mm} x ${is.wall_mm}`, Math.abs(is.outer_diameter_mm - outer) < 1e-9 && Math.abs(is.wall_mm - wall) < 1e-9);
  }
  wrong('others', (frame.others ?? []).length === others.length);
  for (const {id, point, direction, side: [name, side], ...rest} of others) {
    const found = frame.others?.find((each) => each.id === id);
    if (!found) { out.push(`no ${id}`); continue; }
    for (const [key, value] of Object.entries(rest)) wrong(`${id} ${key} ${found[key]}`, typeof value === 'number' ? Math.abs(found[key] - value) < 1e-8 : found[key] === value);
    wrong(`${id} begins elsewhere`, apart(found.axis.point_mm, point) <= 1e-6);
    wrong(`${id} goes elsewhere`, apart(found.axis.direction, direction) <= 1e-8);
    wrong(`${id} looks elsewhere`, apart(found[name], side) <= 1e-8);
  }
  for (const joint of joints) wrong(`no joint ${joint.between}`, (frame.joints ?? []).some((each) => JSON.stringify(each) === JSON.stringify(joint)));
  return out;
}

test('there are thirty files', () => assert.ok(models.length + written.length >= 30, `${models.length + written.length}`));

for (const model of models)
  test(`axes and sizes: ${model.name}`, async () => assert.deepEqual(faults(await read(model.text), model), []));

for (const model of written)
  test(`axes and sizes: ${model.name}`, async () => assert.deepEqual(faults(await fromIfc(await model.bytes()), model), []));

// The comparison itself must be able to fail.
const nested = models.filter(({name}) => / in [2-5]/.test(name));

test('a placement that is dropped is seen in every nested file', async () => {
  assert.ok(nested.length >= 8);
  for (const model of nested) {
    const text = model.text.replace(/(IFCLOCALPLACEMENT\()#\d+/, '$1$');
    assert.notEqual(text, model.text);
    assert.ok(faults(await read(text), model).length > 0, model.name);
  }
});

test('a unit that is dropped or another is seen in every file', async () => {
  for (const model of models) {
    const dropped = await read(model.text.replace(/(IFCUNITASSIGNMENT\(\()#\d+,/, '$1'));
    assert.equal(dropped.frame, null, model.name);
    assert.equal(dropped.notUnderstood.length, 1);
    assert.match(dropped.notUnderstood[0].reason, /no unit of length/);
    const last = model.text.match(/#\d+=IFCSIUNIT\(\*,\.LENGTHUNIT\.[^;]*;/)[0];
    const other = model.text.replace(last, last.replace(/\.MILLI\.|\.CENTI\.|\$/, '.KILO.'));
    assert.ok(faults(await read(other), model).length > 0, model.name);
  }
});

test('a profile that is turned, shifted or smaller is seen', async () => {
  const model = models[0];
  for (const edit of [/(#\d+=IFCCIRCLEHOLLOWPROFILEDEF\(\.AREA\.,\$,)#\d+/, /(IFCEXTRUDEDAREASOLID\(#\d+,)#\d+/]) {
    const text = model.text.replace(edit, '$1$');
    assert.notEqual(text, model.text);
    assert.ok(faults(await read(text), model).length > 0);
  }
});

/** Three good beams and a spoilt item between them. */
function spoilt(edit, schema = 'IFC4') {
  const step = new Step(schema);
  step.units('millimetre');
  const solid = (profile) => step.add('IFCEXTRUDEDAREASOLID', profile, '$', step.direction([0, 0, 1]), 1000);
  const ring = () => step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', 50, 5);
  const beam = (name, x, item, placement = step.placement(shift(x, 0, 0))) => step.product('IFCBEAM', name, placement, step.body([item]));
  beam('A', 0, solid(ring()));
  const id = edit({step, solid, ring, beam});
  beam('B', 500, solid(ring()));
  beam('C', 900, solid(ring()));
  return {text: step.text(), id};
}

const spoils = {
  'an unknown profile': [({step, solid, beam}) => beam('X', 200, solid(step.add('IFCISHAPEPROFILEDEF', '.AREA.', '$', '$', 100, 200, 6, 9, 12, '$', '$'))), /IfcIShapeProfileDef is no tube/],
  'a solid rod': [({step, solid, beam}) => beam('X', 200, solid(step.add('IFCCIRCLEPROFILEDEF', '.AREA.', '$', '$', 50))), /IfcCircleProfileDef is no tube/],
  'a missing wall': [({step, solid, beam}) => beam('X', 200, solid(step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', 50, '$'))), /has no WallThickness/],
  'a wall as thick as the radius': [({step, solid, beam}) => beam('X', 200, solid(step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', 50, 50))), /has a wall of 50/],
  'a swept rod': [({step, beam}) => beam('X', 200, step.add('IFCSWEPTDISKSOLID', step.add('IFCPOLYLINE', `(${step.point([0, 0, 0])},${step.point([0, 0, 9])})`), 5, '$', '$', '$')), /has no InnerRadius/],
  'a broken reference to a profile': [({solid, beam}) => beam('X', 200, solid('#9999')), /#9999 is not there/],
  'a broken reference to a placement': [({solid, ring, beam}) => beam('X', 200, solid(ring()), '#9998'), /#9998 is not there/],
  'no placement': [({solid, ring, beam}) => beam('X', 200, solid(ring()), '$'), /has no ObjectPlacement/],
  'a placement that is placed by itself': [({step, solid, ring, beam}) => {
    const item = solid(ring());
    const axes = step.axes(shift(0, 0, 0));
    return beam('X', 200, item, step.add('IFCLOCALPLACEMENT', `#${step.lines.length + 1}`, axes));
  }, /is placed by itself/],
  'a slanted extrusion': [({step, ring, beam}) => beam('X', 200, step.add('IFCEXTRUDEDAREASOLID', ring(), '$', step.direction([0.1, 0, 1]), 1000)), /at a slant/],
  'a square tube with sharp corners': [({step, solid, beam}) => beam('X', 0, step.add('IFCEXTRUDEDAREASOLID', step.add('IFCRECTANGLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', 100, 100, 5, '$', '$'), step.axes(rotation(1, 90)), step.direction([0, 0, 1]), 1000)), /without OuterFilletRadius/],
  'a faceted body': [({step, beam}) => beam('X', 200, step.add('IFCFACETEDBREP', step.add('IFCCLOSEDSHELL', '()'))), /IfcFacetedBrep is no solid that is known/],
  'another kind of product': [({step, solid, ring}) => step.product('IFCPLATE', 'X', step.placement(shift(0, 0, 0)), step.body([solid(ring())])), /IfcPlate is not imported/],
};
for (const [name, [edit, reason]] of Object.entries(spoils))
  test(`listed, and nothing else: ${name}`, async () => {
    const {text, id} = spoilt(edit);
    const {frame, notUnderstood, asks} = await read(text);
    assert.deepEqual(frame.members.map((member) => member.id), ['A', 'B', 'C']);
    assert.equal(notUnderstood.filter((each) => each.id !== 'file').length, 1, JSON.stringify(notUnderstood));
    assert.equal(notUnderstood[0].id, id);
    assert.match(notUnderstood[0].reason, reason);
    assert.ok(notUnderstood[0].type.startsWith('Ifc'), notUnderstood[0].type);
    assert.deepEqual(asks.map(({option, count}) => [option, count]), /corners/.test(name) ? [['corner', 1]] : []);
  });

test('corners that are drawn sharp are as the caller says', async () => {
  const {text, id} = spoilt(spoils['a square tube with sharp corners'][0]);
  for (const corners of [{corner_radius_mm: 7.5}, {corners: 'en_10219'}]) {
    const {frame, notUnderstood} = await read(text, corners);
    assert.deepEqual([notUnderstood, frame.others], [[], undefined]);
    const {start_mm, end_mm, up, ...rest} = frame.members.find((each) => each.id === 'X');
    assert.deepEqual(rest, {id: 'X', kind: 'rectangular_tube', height_mm: 100, width_mm: 100, wall_mm: 5, ...corners});
    assert.ok(apart(start_mm, [0, 0, 0]) < 1e-9 && apart(end_mm, [1000, 0, 0]) < 1e-9 && apart(up, [0, 1, 0]) < 1e-9);
  }
  // Too sharp for the wall: it cuts the tube that ends at it, as before there were such members.
  const small = await read(text, {corner_radius_mm: 5});
  assert.deepEqual(small.frame.others.map(({id: name, corner_radius_mm}) => [name, corner_radius_mm]), [['X', 5]]);
  assert.deepEqual(small.notUnderstood.map((each) => each.id), [id]);
  assert.match(small.notUnderstood[0].reason, /only cuts the tubes that end at it, and is no member, because corners of 5 mm are too sharp to be cut in a wall of 5 mm/);
  const own = models.find(({name}) => name === 'bend and box metre IFC2X3');
  assert.deepEqual(faults(await read(own.text, {corner_radius_mm: 8}), own), [], 'a radius of its own stays');
});

test('a cut tube is imported whole, and its cut is listed', async () => {
  let clipping;
  const {text} = spoilt(({step, solid, ring, beam}) => {
    const half = step.add('IFCHALFSPACESOLID', step.add('IFCPLANE', step.axes(rotation(0, 30))), '.F.');
    clipping = step.add('IFCBOOLEANCLIPPINGRESULT', '.DIFFERENCE.', solid(ring()), half);
    return beam('X', 200, clipping);
  });
  const {frame, notUnderstood} = await read(text);
  assert.deepEqual(frame.members.map((member) => member.id), ['A', 'X', 'B', 'C']);
  assert.deepEqual(notUnderstood.map(({id, type}) => [id, type]), [[clipping, 'IfcBooleanClippingResult']]);
});

test('what shares a name gets its number with it', async () => {
  const {text, id} = spoilt(({solid, ring, beam}) => beam('A', 200, solid(ring())));
  const {frame} = await read(text);
  assert.deepEqual(frame.members.map((member) => member.id), ['A', `A ${id}`, 'B', 'C']);
});

test('a corner of a swept disk is a mitre, as the schema says; three points in line are one tube', async () => {
  const step = new Step();
  step.units('millimetre');
  const points = [[0, 0, 0], [500, 0, 0], [1000, 0, 0], [1000, 800, 0]];
  const solid = step.add('IFCSWEPTDISKSOLID', step.add('IFCPOLYLINE', `(${points.map(step.point).join(',')})`), 30, 26, '$', '$');
  step.product('IFCMEMBER', 'L', step.placement(shift(0, 0, 0)), step.body([solid]));
  const {frame} = await read(step.text());
  assert.deepEqual(frame.members.map(({id, start_mm, end_mm}) => [id, start_mm, end_mm]), [['L/1', [0, 0, 0], [1000, 0, 0]], ['L/2', [1000, 0, 0], [1000, 800, 0]]]);
  assert.deepEqual(frame.joints, [{between: ['L/1', 'L/2'], kind: 'mitre'}]);
});

test('what is no IFC file is said to be none', async () => {
  for (const text of ['', 'hello', models[0].text.replace("'IFC4'", "'IFC9'"), models[0].text.slice(0, 300)]) {
    const {frame, notUnderstood} = await read(text);
    assert.equal(frame, null);
    assert.equal(notUnderstood.length, 1);
    assert.equal(notUnderstood[0].id, 'file');
  }
  assert.deepEqual(faults(await read(models[0].text), models[0]), [], 'and the next one is read');
});

test('directions stay unit vectors', async () => {
  for (const model of models.filter(({others}) => others.length > 0))
    for (const other of (await read(model.text)).frame.others) assert.ok(Math.abs(size(other.axis.direction) - 1) < 1e-8);
});
