// Thirty IFC files, each with the axes and sizes that it must come back with, in mm.
import {moved, product, rotation, shift, Step, stretch} from './step.mjs';

const unitsInMm = {metre: 1000, millimetre: 1, centimetre: 10, inch: 25.4, foot: 304.8};

/** Numbers from 0 to 1, always the same. */
function random(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

const rigid = (next, reach) => product(shift(...[0, 1, 2].map(() => (next() - 0.5) * reach)), rotation(2, 360 * next()), rotation(0, 360 * next()), rotation(1, 360 * next()));

const sizes = [[114.3, 6.3], [60.3, 3.91], [219.1, 12.5], [48.3, 2.6], [88.9, 5]];
// Returns the shortest decimal number in the unit that equals `mm`, as a user would write it.
const inUnit = (mm, unit) => Number((mm / unitsInMm[unit]).toPrecision(14));

function circle(step, radius, wall, place) {
  const at = place ? step.add('IFCAXIS2PLACEMENT2D', step.point(place.at), step.direction(place.x)) : '$';
  return step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', '$', step.schema === 'IFC4' ? at : place ? at : step.add('IFCAXIS2PLACEMENT2D', step.point([0, 0]), '$'), radius, wall);
}

/** A beam in `depth` placements, one in the other, its solid placed in it and its profile shifted and turned in that. */
function extruded({unit, schema, type, depth, seed, down = false}) {
  const next = random(seed);
  const mm = unitsInMm[unit];
  const step = new Step(schema);
  step.units(unit);
  const members = [];
  let world = shift(0, 0, 0), parent = '$';
  for (let level = 0; level < depth; ++level) {
    const m = rigid(next, 20000 / mm);
    world = product(world, m);
    parent = step.placement(m, parent);
  }
  for (const [i, [outer, wall]] of sizes.entries()) {
    const own = rigid(next, 8000 / mm), solid = rigid(next, 500 / mm);
    const at = [(next() - 0.5) * 200 / mm, (next() - 0.5) * 200 / mm];
    const turn = 360 * next() * Math.PI / 180;
    const long = (500 + 4000 * next()) / mm;
    const profile = circle(step, inUnit(outer / 2, unit), inUnit(wall, unit), {at, x: [Math.cos(turn), Math.sin(turn)]});
    const item = step.add('IFCEXTRUDEDAREASOLID', profile, step.axes(solid), step.direction([0, 0, down ? -1 : 1]), long);
    step.product(type, `M${i}`, step.placement(own, parent), step.body([item]));
    const all = product(world, own, solid);
    const ends = [[...at, 0], [...at, down ? -long : long]].map((p) => moved(all, p).map((v) => v * mm));
    members.push({id: `M${i}`, ends, outer, wall});
  }
  return {name: `${type} ${unit} ${schema} in ${depth}${down ? ' downwards' : ''}`, text: step.text(), members, others: []};
}

/** Disks swept along two points. */
function swept({unit, schema, seed}) {
  const next = random(seed);
  const mm = unitsInMm[unit];
  const step = new Step(schema);
  step.units(unit);
  const world = rigid(next, 5000 / mm);
  const members = sizes.map(([outer, wall], i) => {
    const points = [0, 1].map(() => [0, 1, 2].map(() => ((next() - 0.5) * 6000) / mm));
    const line = step.add('IFCPOLYLINE', `(${points.map(step.point).join(',')})`);
    const inner = inUnit(outer / 2 - wall, unit);
    const params = schema === 'IFC4' ? ['$', '$'] : [0, 1];
    const solid = step.add('IFCSWEPTDISKSOLID', line, inUnit(outer / 2, unit), inner, ...params);
    step.product(schema === 'IFC4' ? 'IFCPIPESEGMENT' : 'IFCFLOWSEGMENT', `S${i}`, step.placement(world), step.body([solid]));
    return {id: `S${i}`, ends: points.map((p) => moved(world, p).map((v) => v * mm)), outer, wall};
  });
  return {name: `swept ${unit} ${schema}`, text: step.text(), members, others: []};
}

/** One shape at five places, by mapped items with a scale. */
function mapped({unit, schema, seed, scale}) {
  const next = random(seed);
  const mm = unitsInMm[unit];
  const step = new Step(schema);
  step.units(unit);
  const [outer, wall] = sizes[0];
  const long = 1500 / mm;
  const solid = step.add('IFCEXTRUDEDAREASOLID', circle(step, inUnit(outer / 2, unit), inUnit(wall, unit)), step.axes(shift(0, 0, 0)), step.direction([0, 0, 1]), long);
  const inner = step.add('IFCSHAPEREPRESENTATION', '$', "'Body'", "'SweptSolid'", `(${solid})`);
  const origin = rigid(next, 300 / mm);
  const map = step.add('IFCREPRESENTATIONMAP', step.axes(origin), inner);
  const members = [0, 1, 2, 3, 4].map((i) => {
    const to = rigid(next, 3000 / mm), world = rigid(next, 9000 / mm);
    const [x, y, z] = [0, 1, 2].map((j) => step.direction([to[0][j], to[1][j], to[2][j]]));
    const target = step.add('IFCCARTESIANTRANSFORMATIONOPERATOR3D', x, y, step.point([to[0][3], to[1][3], to[2][3]]), scale === 1 ? '$' : scale, z);
    step.product('IFCCOLUMN', `C${i}`, step.placement(world), step.body([step.add('IFCMAPPEDITEM', map, target)]));
    const all = product(world, to, stretch(scale), origin);
    return {id: `C${i}`, ends: [[0, 0, 0], [0, 0, long]].map((p) => moved(all, p).map((v) => v * mm)), outer: outer * scale, wall: wall * scale};
  });
  return {name: `mapped ${unit} ${schema} times ${scale}`, text: step.text(), members, others: []};
}

/** A pipe of two straights and the bend between them, by the ways that a centre-line can be written in. */
function bent({unit, way, seed}) {
  const next = random(seed);
  const mm = unitsInMm[unit];
  const step = new Step('IFC4');
  step.units(unit);
  const world = rigid(next, 4000 / mm);
  const [a, b, radius] = [800 / mm, 600 / mm, 228.6 / mm];
  const turn = Math.PI / 3;
  // Along x, then about the centre above it, then on.
  const out = (t) => [a + radius * Math.sin(t), radius * (1 - Math.cos(t)), 0];
  const last = [out(turn)[0] + b * Math.cos(turn), out(turn)[1] + b * Math.sin(turn), 0];
  const points = [[0, 0, 0], [a, 0, 0], out(turn / 2), out(turn), last];
  const curves = {
    indexed: () => {
      const list = step.add('IFCCARTESIANPOINTLIST3D', `(${points.map(step.list).join(',')})`);
      return step.add('IFCINDEXEDPOLYCURVE', list, '(IFCLINEINDEX((1,2)),IFCARCINDEX((2,3,4)),IFCLINEINDEX((4,5)))', '.F.');
    },
    composite: () => {
      const straight = (p, q) => step.add('IFCPOLYLINE', `(${step.point(p)},${step.point(q)})`);
      const centre = step.add('IFCAXIS2PLACEMENT3D', step.point([a, radius, 0]), '$', '$');
      const arc = step.add('IFCTRIMMEDCURVE', step.add('IFCCIRCLE', centre, radius), `(IFCPARAMETERVALUE(${-Math.PI / 2}))`, `(IFCPARAMETERVALUE(${turn - Math.PI / 2}))`, '.T.', '.PARAMETER.');
      const segment = (curve, same) => step.add('IFCCOMPOSITECURVESEGMENT', '.CONTINUOUS.', same ? '.T.' : '.F.', curve);
      return step.add('IFCCOMPOSITECURVE', `(${segment(straight(points[0], points[1]), true)},${segment(arc, true)},${segment(straight(points[4], points[3]), false)})`, '.F.');
    },
    rounded: () => step.add('IFCPOLYLINE', `(${[points[0], [a + radius * Math.tan(turn / 2), 0, 0], last].map(step.point).join(',')})`),
  };
  const line = curves[way]();
  const [outer, wall] = sizes[4];
  const kind = way === 'rounded' ? 'IFCSWEPTDISKSOLIDPOLYGONAL' : 'IFCSWEPTDISKSOLID';
  const solid = step.add(kind, line, inUnit(outer / 2, unit), inUnit(outer / 2 - wall, unit), '$', '$', ...(way === 'rounded' ? [radius] : []));
  step.product('IFCMEMBER', 'bent', step.placement(world), step.body([solid]));
  const at = (p) => moved(world, p).map((v) => v * mm);
  const along = (d) => moved(world, d).map((v, i) => v - moved(world, [0, 0, 0])[i]);
  return {
    name: `bent ${unit} ${way}`, text: step.text(),
    members: [{id: 'bent/1', ends: [at(points[0]), at(points[1])], outer, wall}, {id: 'bent/3', ends: [at(points[3]), at(last)], outer, wall}],
    others: [{kind: 'elbow', id: 'bent/2', outer_diameter_mm: outer, bend_radius_mm: 228.6, bend_deg: 60, point: at(points[1]), direction: along([1, 0, 0]), side: ['inwards', along([0, 1, 0])]}],
  };
}

/** A fitting turned out of its profile, and a square tube whose profile is turned. */
function bendAndBox({unit, schema, seed}) {
  const next = random(seed);
  const mm = unitsInMm[unit];
  const step = new Step(schema);
  step.units(unit);
  const world = rigid(next, 4000 / mm);
  const [outer, wall] = sizes[2];
  const radius = 304.8 / mm;
  const axis = step.add('IFCAXIS1PLACEMENT', step.point([radius, 0, 0]), step.direction([0, 1, 0]));
  const turned = step.add('IFCREVOLVEDAREASOLID', circle(step, inUnit(outer / 2, unit), inUnit(wall, unit)), step.axes(shift(0, 0, 0)), axis, Math.PI / 2);
  const frame = step.placement(world);
  step.product(schema === 'IFC4' ? 'IFCPIPEFITTING' : 'IFCFLOWFITTING', 'bend', frame, step.body([turned]));
  const c = Math.cos(0.3), s = Math.sin(0.3), long = 2500 / mm;
  const place = step.add('IFCAXIS2PLACEMENT2D', step.point([10 / mm, 20 / mm]), step.direction([c, s]));
  const profile = step.add('IFCRECTANGLEHOLLOWPROFILEDEF', '.AREA.', '$', place, inUnit(120, unit), inUnit(80, unit), inUnit(6, unit), inUnit(6, unit), inUnit(12, unit));
  step.product('IFCBEAM', 'box', frame, step.body([step.add('IFCEXTRUDEDAREASOLID', profile, step.axes(shift(0, 0, 0)), step.direction([0, 0, 1]), long)]));
  const tube = step.add('IFCEXTRUDEDAREASOLID', circle(step, inUnit(48.3 / 2, unit), inUnit(2.6, unit)), step.axes(rotation(1, 90)), step.direction([0, 0, 1]), 1000 / mm);
  const foot = product(world, shift(10 / mm, 20 / mm, 1200 / mm));
  step.product('IFCMEMBER', 'brace', step.placement(foot), step.body([tube]));
  const at = (m, p) => moved(m, p).map((v) => v * mm);
  const along = (d) => moved(world, d).map((v, i) => v - moved(world, [0, 0, 0])[i]);
  return {
    name: `bend and box ${unit} ${schema}`, text: step.text(),
    members: [
      {id: 'box', ends: [0, long].map((z) => at(world, [10 / mm, 20 / mm, z])), section: {height_mm: 80, width_mm: 120, wall_mm: 6, corner_radius_mm: 12, inner_corner_radius_mm: 6}, up: along([-s, c, 0])},
      {id: 'brace', ends: [at(foot, [0, 0, 0]), at(foot, [1000 / mm, 0, 0])], outer: 48.3, wall: 2.6},
    ],
    others: [
      // About +y, from the origin with the centre at +x: it leaves towards +z.
      {kind: 'elbow', id: 'bend', outer_diameter_mm: outer, bend_radius_mm: 304.8, bend_deg: 90, point: at(world, [0, 0, 0]), direction: along([0, 0, 1]), side: ['inwards', along([1, 0, 0])]},
    ],
  };
}

export const models = [
  ...['metre', 'millimetre', 'centimetre', 'inch', 'foot'].flatMap((unit, i) => [
    extruded({unit, schema: 'IFC4', type: 'IFCBEAM', depth: 1 + i, seed: 10 + i}),
    extruded({unit, schema: 'IFC2X3', type: 'IFCCOLUMN', depth: 5 - i, seed: 20 + i}),
  ]),
  extruded({unit: 'metre', schema: 'IFC4', type: 'IFCMEMBER', depth: 0, seed: 30}),
  extruded({unit: 'inch', schema: 'IFC4', type: 'IFCPIPESEGMENT', depth: 3, seed: 31, down: true}),
  extruded({unit: 'millimetre', schema: 'IFC2X3', type: 'IFCFLOWSEGMENT', depth: 2, seed: 32, down: true}),
  ...['metre', 'inch'].flatMap((unit, i) => [swept({unit, schema: 'IFC4', seed: 40 + i}), swept({unit, schema: 'IFC2X3', seed: 50 + i})]),
  mapped({unit: 'metre', schema: 'IFC4', seed: 60, scale: 1}),
  mapped({unit: 'millimetre', schema: 'IFC2X3', seed: 61, scale: 1}),
  mapped({unit: 'inch', schema: 'IFC4', seed: 62, scale: 2}),
  ...['indexed', 'composite', 'rounded'].flatMap((way, i) => [bent({unit: 'metre', way, seed: 70 + i}), bent({unit: 'millimetre', way, seed: 80 + i})]),
  bendAndBox({unit: 'millimetre', schema: 'IFC4', seed: 90}),
  bendAndBox({unit: 'metre', schema: 'IFC2X3', seed: 91}),
  bendAndBox({unit: 'foot', schema: 'IFC4', seed: 92}),
];
