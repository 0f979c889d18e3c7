// IFC files drawn at random: profiles with voids, structural members, "*", names, listed sizes,
// rectangular tubes. The expected result of each is known.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {fromIfc} from '../dist/index.js';
import {file} from './support/profiles.mjs';
import {bytes, shift, Step} from './support/step.mjs';

const apart = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));
const files = Array.from({length: 210}, (_, i) => file(i + 1));

test('210 files come back as they were drawn', async () => {
  for (const {seed, text, members, boxes, reasons, open} of files) {
    const {frame, notUnderstood, sources, asks} = await fromIfc(bytes(text));
    const told = `file ${seed}: ${JSON.stringify(notUnderstood)}`;
    assert.deepEqual(asks.map(({option, count}) => [option, count]), open > 0 ? [['corner', open]] : [], told);
    const listed = notUnderstood.filter(({id}) => id !== 'file');
    assert.deepEqual(listed.map(({id}) => id).sort(), reasons.map(([id]) => id).sort(), told);
    for (const [id, reason] of reasons) assert.match(notUnderstood.find((each) => each.id === id).reason, reason);
    for (const {guid, reason} of listed) if (!/^assumed/.test(reason)) assert.match(guid, /^[0-3][0-9A-Za-z_$]{21}$/);
    assert.deepEqual(frame.members.map(({id}) => id).sort(), [...members, ...boxes].map(({id}) => id).sort(), told);
    for (const {id, ends, sides, inner, up} of boxes) {
      const {start_mm, end_mm, up: found, ...rest} = frame.members.find((each) => each.id === id);
      assert.ok(apart(start_mm, ends[0]) < 1e-5 && apart(end_mm, ends[1]) < 1e-5, told);
      // A profile that is drawn may begin at either side.
      const [across, along] = [Math.abs(found.reduce((sum, v, i) => sum + v * up[i], 0)), rest.height_mm < rest.width_mm];
      assert.ok(Math.abs(across - (along ? 1 : 0)) < 1e-8, `${told} ${id} is turned`);
      assert.deepEqual([rest.height_mm, rest.width_mm].sort((p, q) => p - q).map((v) => Number(v.toFixed(6))), sides.slice(0, 2), told);
      assert.ok(Math.abs(rest.wall_mm - sides[2]) < 1e-6 && Math.abs(rest.corner_radius_mm - 16) < 1e-6, told);
      assert.ok(inner === undefined ? rest.inner_corner_radius_mm === undefined : Math.abs(rest.inner_corner_radius_mm - inner) < 1e-6, told);
    }
    for (const {id, ends, expect, guid} of members) {
      const {start_mm, end_mm, id: _, ...size} = frame.members.find((each) => each.id === id);
      assert.ok(apart(start_mm, ends[0]) < 1e-5 && apart(end_mm, ends[1]) < 1e-5, `${told} ${id}: ${start_mm}, ${end_mm}, not ${ends}`);
      if (expect.size) assert.deepEqual(size, expect, told);
      else assert.ok(apart([size.outer_diameter_mm, size.wall_mm], [expect.outer_diameter_mm, expect.wall_mm]) < 1e-8, `${told} ${JSON.stringify(size)}`);
      assert.equal(sources.find((each) => each.id === id).guid, guid, told);
    }
    assert.deepEqual([frame.others, frame.joints], [undefined, undefined], told); // the service finds where a tube ends at a box
  }
  assert.ok(files.filter(({analysis}) => analysis).length >= 60 && files.filter(({text}) => /[(,]\*[,)]/.test(text)).length >= 200);
});

const spoil = async (edit) => {
  const step = new Step('IFC4');
  step.units('millimetre');
  edit(step);
  return fromIfc(bytes(step.text()));
};
const solid = (step, profile) => step.add('IFCEXTRUDEDAREASOLID', profile, '$', step.direction([0, 0, 1]), 1000);
const outline = (step, n, r, [x, y] = [0, 0]) => {
  const points = Array.from({length: n}, (_, i) => step.point([x + r * Math.cos((2 * Math.PI * i) / n), y + r * Math.sin((2 * Math.PI * i) / n)]));
  return step.add('IFCPOLYLINE', `(${[...points, points[0]].join(',')})`);
};
const ring = (step, r, at = [0, 0]) => step.add('IFCCIRCLE', step.add('IFCAXIS2PLACEMENT2D', step.point(at), '$'), r);
const voids = (step, outer, ...inner) => step.add('IFCARBITRARYPROFILEDEFWITHVOIDS', '.AREA.', '$', outer, `(${inner.join(',')})`);

test('profiles with voids that are no tubes are listed with the reason', async () => {
  const cases = [
    [(step) => voids(step, outline(step, 24, 50), outline(step, 24, 45)), /polygon of 24 sides on a circle of 100/],
    [(step) => voids(step, ring(step, 50), ring(step, 45, [1, 0])), /a void that is 1 off its middle/],
    [(step) => voids(step, ring(step, 50), ring(step, 55)), /larger than its outline/],
    [(step) => voids(step, ring(step, 50), ring(step, 10, [20, 0]), ring(step, 10, [-20, 0])), /2 voids/],
    [(step) => voids(step, outline(step, 4, 50), ring(step, 20)), /its outline is a rectangle and its void a circle/],
    [(step) => voids(step, outline(step, 4, 50), outline(step, 3, 20)), /neither a circle nor a rectangle/],
    [(step) => voids(step, outline(step, 4, 50), outline(step, 4, 20, [3, 0])), /wall is not the same/],
    [(step) => voids(step, outline(step, 5, 50), outline(step, 5, 20)), /neither a circle nor a rectangle/],
  ];
  for (const [profile, reason] of cases) {
    const {frame, notUnderstood} = await spoil((step) => step.product('IFCBEAM', 'X', step.placement(shift(0, 0, 0)), step.body([solid(step, profile(step))])));
    assert.equal(frame, null);
    assert.match(notUnderstood[0].reason, reason);
    assert.match(notUnderstood[1].reason, /no tube that can be read/);
  }
});

test('structural members that are not certain are listed with the reason', async () => {
  const member = (change) => spoil((step) => {
    const vertices = [[0, 0, 0], [3000, 0, 0]].map((p) => step.add('IFCVERTEXPOINT', step.point(p)));
    const edges = Array.from({length: change.edges ?? 1}, () => step.add('IFCEDGE', ...vertices));
    const drawn = step.add('IFCTOPOLOGYREPRESENTATION', '$', '$', '$', `(${edges.join(',')})`);
    const shape = step.add('IFCPRODUCTDEFINITIONSHAPE', '$', '$', `(${drawn})`);
    const id = step.add(change.type ?? 'IFCSTRUCTURALCURVEMEMBER', "'0000000000000000000002'", '$', "'S'", '$', '$', '$', shape, '.RIGID_JOINED_MEMBER.', '$');
    const profiles = Array.from({length: change.profiles ?? 1}, () => step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', 57.15, 6.3));
    const set = step.add('IFCMATERIALPROFILESET', '$', '$', `(${profiles.map((each) => step.add('IFCMATERIALPROFILE', '$', '$', '$', each, '$', '$')).join(',')})`, '$');
    const material = change.cardinal ? step.add('IFCMATERIALPROFILESETUSAGE', set, String(change.cardinal), '$') : change.plain ? step.add('IFCMATERIAL', "'S355'", '$', '$') : set;
    step.add('IFCRELASSOCIATESMATERIAL', "'0000000000000000000003'", '$', '$', '$', `(${id})`, material);
    if (change.eccentric) step.add('IFCRELCONNECTSWITHECCENTRICITY', "'0000000000000000000004'", '$', '$', '$', id, '$', '$', '$', '$', '$', '$');
  });
  const good = await member({});
  assert.deepEqual(good.frame.members, [{id: 'S', start_mm: [0, 0, 0], end_mm: [3000, 0, 0], size: 'CHS 114.3x6.3'}], 'its placement may be left out');
  for (const [change, reason] of [[{cardinal: 2}, /CardinalPoint 2/], [{profiles: 2}, /more than one profile/], [{plain: true}, /no profile/], [{edges: 2}, /not one straight edge/],
    [{type: 'IFCSTRUCTURALCURVEMEMBERVARYING'}, /is not imported/], [{eccentric: true}, /eccentric/]]) {
    const {frame, notUnderstood} = await member(change);
    assert.equal(frame, null, JSON.stringify(change));
    assert.match(notUnderstood[0].reason, reason);
  }
});
