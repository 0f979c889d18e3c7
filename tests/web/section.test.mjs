// A tube that is not round in the console: the places of its rows in space, and the files that it has.
import {strict as assert} from 'node:assert';
import {test} from 'node:test';
import {load} from './load.mjs';

const {edgesOf, outside} = await load('src/pictures/section_solid.ts');
const {printable} = await load('src/files.ts');

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

test('files that only round tubes have are not offered', () => {
  const formats = ['text/csv', 'image/svg+xml', 'text/x-gcode', 'model/step', 'application/x-dstv', 'image/vnd.dxf'].map((media) => ({media, views: ['chart', 'section'], options: []}));
  assert.deepEqual(printable(formats, true), formats);
  assert.deepEqual(printable(formats, false).map(({media, views}) => [media, views]),
    ['text/csv', 'image/svg+xml', 'image/vnd.dxf'].map((media) => [media, ['chart']]));
});
