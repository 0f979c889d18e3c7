// A tube that is not round in the console: the places of its rows in space, and the files that it has.
import {strict as assert} from 'node:assert';
import {test} from 'node:test';
import {load} from './load.mjs';

const {cornersOf, edgesOf, outside, wallBetween} = await load('src/pictures/section_solid.ts');
const {faceTable, partnersOf} = await load('src/pictures/section_part.ts');
const {placedFrom, seenFrom} = await load('src/pictures/geometry.ts');
const {printable} = await load('src/files.ts');
const {leadsOf} = await load('src/onward.ts');

const shapes = [[100, 50, 8], [50, 100, 8], [80, 80, 0], [60, 60, 30], [120, 40, 20]];
const girthOf = ([height, width, r]) => 2 * (height + width) - (8 - 2 * Math.PI) * r;
const rowOf = ([height, width, r]) => ({height_mm: height, width_mm: width, corner_radius_mm: r});

/** The distance of a place from a rectangle with round corners. */
function off([x, y], [height, width, r]) {
  const [u, v] = [Math.abs(x) - height / 2 + r, Math.abs(y) - width / 2 + r];
  return Math.hypot(Math.max(u, 0), Math.max(v, 0)) + Math.min(Math.max(u, v), 0) - r;
}

test('the way round an outline is on it, as long as the girth, and counter-clockwise from the middle of face 1', () => {
  for (const shape of shapes) {
    const girth = girthOf(shape), section = rowOf(shape), count = 720;
    assert.deepEqual(outside(section, 0).map((v) => Number(v.toFixed(9))), [shape[0] / 2, 0]);
    const places = Array.from({length: count}, (_, i) => outside(section, girth * i / count));
    let length = 0, area = 0;
    places.forEach((a, i) => {
      const b = places[(i + 1) % count];
      assert.ok(Math.abs(off(a, shape)) < 1e-9, `${shape} at ${i}: ${a}`);
      length += Math.hypot(b[0] - a[0], b[1] - a[1]);
      area += (a[0] * b[1] - a[1] * b[0]) / 2;
    });
    assert.ok(Math.abs(length - girth) < 0.01 * girth && length <= girth + 1e-9, `${shape}: ${length} of ${girth}`);
    assert.ok(Math.abs(area - (shape[0] * shape[1] - (4 - Math.PI) * shape[2] ** 2)) < 0.01 * area, `${shape}: ${area}`);
  }
});

test('the inner edge lies one wall inside, along the normal', () => {
  const shape = [100, 50, 8], girth = girthOf(shape);
  const points = {girth_mm: [0, girth / 4, girth / 2], normal_deg: [0, 90, 180], wall_mm: [4, 4, 4], z_inner_mm: [1, 2, 3], z_outer_mm: [4, 5, 6]};
  const [outer, inner] = edgesOf(rowOf(shape), points);
  assert.deepEqual(outer.map(([, , z]) => z), [4, 5, 6]);
  inner.forEach(([x, y, z], i) => {
    assert.equal(z, i + 1);
    assert.ok(Math.abs(off([x, y], [92, 42, 4])) < 1e-9);
  });
});

test('files and options that only round tubes have are not offered', () => {
  const options = ['lead_mm', 'tabs', 'tab_mm', 'tabs_of', 'start_deg', 'marks', 'passes', 'pivot_length_mm'].map((name) => ({name}));
  const formats = ['text/csv', 'image/svg+xml', 'text/x-gcode', 'model/step', 'application/x-dstv', 'image/vnd.dxf'].map((media) => ({media, views: ['chart', 'section'], options}));
  assert.deepEqual(printable(formats, true), formats);
  assert.deepEqual(printable(formats, false).map(({media, views}) => [media, views]),
    ['text/csv', 'image/svg+xml', 'text/x-gcode', 'image/vnd.dxf'].map((media) => [media, ['chart']]));
  assert.deepEqual(printable(formats, false)[2].options.map(({name}) => name), ['lead_mm', 'pivot_length_mm']);
  assert.deepEqual(printable(formats, false, true)[2].options.map(({name}) => name), ['lead_mm', 'marks', 'pivot_length_mm']);
  for (const type of ['application/x-dstv', 'model/step']) assert.ok(printable(formats, false, true).some(({media}) => media === type), type);
});

test('corners are where the outline is round', () => {
  for (const shape of shapes) {
    const [height, width, r] = shape, section = rowOf(shape), corners = cornersOf(section);
    assert.equal(corners.length, r > 0 ? 4 : 0);
    for (const [from, to] of corners) {
      for (const girth of [from, (from + to) / 2, to]) {
        const [x, y] = outside(section, girth);
        assert.ok(Math.abs(Math.hypot(Math.abs(x) - height / 2 + r, Math.abs(y) - width / 2 + r) - r) < 1e-9, `${shape} at ${girth}`);
      }
    }
  }
});

test('a wall goes straight along the tube from one edge to the other, whatever points each has, and over a jump', () => {
  const at = (girth, z) => ({girth, at: z.map((height) => [3, 4, height])});
  const [from, to] = wallBetween(40, at([0, 10, 10, 30], [0, 5, 7, 9]), at([0, 20], [100, 120]));
  assert.equal(from.length, 6);
  for (const place of [...from, ...to]) assert.deepEqual(place.slice(0, 2), [3, 4]);
  assert.deepEqual(from.map(([, , z]) => z), [0, 0, 5, 7, 8, 9]);
  assert.deepEqual(to.map(([, , z]) => z), [100, 100, 110, 110, 120, 110]);
});

const part = {
  frame: {origin_mm: [0, 0, -27], x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], in: 'start'},
  lengths: {work_point_mm: 1200},
  side_lengths: {face_mm: [1197, 1170, 1140, 1170], corner_mm: [1196.1, 1141.8, 1141.8, 1196.1]},
  ends: {
    start: {points: {z_outer_mm: [0, 57]}, faces: [1, 2, 3, 4].map((face) => ({face, angle_deg: 45, saw_tilt_deg: -45}))},
    finish: {points: {z_outer_mm: [1197, 1197]}, faces: [1, 2, 3, 4].map((face) => (face === 1 ? {face} : {face, angle_deg: 0}))},
  },
};

test('the faces as a table: a blade only where a plane cuts, and no angle of a face without a flat', () => {
  const {head, rows} = faceTable(part);
  assert.equal(head.length, 6);
  assert.deepEqual(rows[0], ['1', '1197', '45', '-45', '–', '1196.1']);
  assert.deepEqual(rows[2], ['3', '1140', '45', '-45', '0', '1141.8']);
});

test('the partners of both ends lie at their ends', () => {
  const stile = {kind: 'rectangular_tube', width_mm: 60, height_mm: 60, corner_radius_mm: 6, axis: {point_mm: [5, 10, 0], direction: [1, 0, 0]}, up: [0, 0, 1]};
  const request = {ends: {start: {cutters: [{kind: 'plane', point_mm: [0, 0, 0], normal: [1, 0, 1]}]}, finish: {cutters: [stile]}}};
  const [plane, box] = partnersOf(request, part, 60, new Map());
  assert.ok(Math.abs(plane.normal[0] * plane.point[0] + plane.normal[2] * (plane.point[2] - 27)) < 1e-9, 'through the work point of the start');
  assert.deepEqual(box.point.slice(1), [-10, 1227]);
  assert.deepEqual(box.up.map(Math.round).map((v) => v + 0), [0, 0, -1]);
});

test('a frame carries a body there and back', () => {
  const frame = {origin: [1, 2, 3], x: [0, 1, 0], y: [-1, 0, 0], z: [0, 0, 1]};
  const box = {kind: 'box', point: [4, 5, 6], direction: [1, 0, 0], up: [0, 0, 1], width: 1, height: 1, corner: 0, half: 1, tone: 0};
  assert.deepEqual(seenFrom(frame, placedFrom(frame, box)), box);
});

test('each end that others cut leads to its pulses, on a machine that swings the torch if its bevel needs it', () => {
  const table = {type: 'tube_table', axes: ['A', 'X', 'Y', 'Z'].map((name) => ({name}))};
  const swinging = {type: 'tube_table', axes: [...table.axes, {name: 'B'}]};
  const plane = {kind: 'plane', point_mm: [0, 0, 0], normal: [1, 0, 1]};
  const body = {target: {size: 'SHS 80x80x4', length_mm: 900}, ends: {start: {square_at_mm: 0}, finish: {cutters: [plane]}}, kerf_mm: 1, reference: {order: '7'}};
  const leads = (b_deg, machines) => leadsOf('parts', body, {result: {section: {}, ends: {start: {points: {b_deg: [0]}}, finish: {points: {b_deg}}}}}, {sizes: new Map(), machines: new Map(machines)});
  const found = leads([0, 0], [['round', {type: 'five_axis_cutter', axes: [{name: 'B'}]}], ['square', table]]);
  assert.deepEqual(found.map(({name, endpoint}) => [name, endpoint]), [['Pulses, finish', 'pulse-schedules']]);
  assert.deepEqual(found[0].body.cut, {target: {size: 'SHS 80x80x4'}, cutters: [plane], kerf_mm: 1});
  assert.equal(found[0].body.machine, 'square');
  assert.deepEqual(leads([0, 12], [['square', table]]), []);
  assert.equal(leads([0, 12], [['square', table], ['own', swinging]])[0].body.machine, 'own');
});
