// IFC files with rectangular tubes drawn at random. Their axes and the direction of their height come from plain
// matrices, without any code of the reader.
import {between, pick, random} from './random.mjs';
import {moved, product, rotation, shift, Step} from './step.mjs';

const unitsInMm = {metre: 1000, millimetre: 1, centimetre: 10, inch: 25.4, foot: 304.8};
const rigid = (next, reach) => product(shift(...[0, 1, 2].map(() => between(next, -reach, reach))), rotation(2, 360 * next()), rotation(0, 360 * next()), rotation(1, 360 * next()));
const column = (m, j) => [m[0][j], m[1][j], m[2][j]];
const along = (m, d) => moved(m, d).map((v, i) => v - moved(m, [0, 0, 0])[i]);
const unit = (v) => v.map((each) => each / Math.hypot(...v));
const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
/** Mirrored and scaled in its plane, or in space. */
const operator = (m, k, mirrored) => m.map((row) => [row[0] * k, row[1] * k * (mirrored ? -1 : 1), row[2] * k, row[3]]);

/** Sizes in mm with corners that can be cut; the file may lack the inner radius. */
function sizes(next) {
  const wall = pick(next, [2, 3, 4, 5, 6.3, 8]);
  const [height, width] = [0, 1].map(() => Math.round(between(next, 10 * wall, 30 * wall)));
  const outer = pick(next, [1.5, 2, 2.5]) * wall;
  return {height, width, wall, outer, inner: pick(next, [undefined, wall, outer - wall])};
}

export function boxes(seed) {
  const next = random(seed + 7000);
  const name = pick(next, Object.keys(unitsInMm));
  const mm = unitsInMm[name];
  const schema = pick(next, ['IFC4', 'IFC4', 'IFC2X3', 'IFC4X3']);
  const modern = schema !== 'IFC2X3';
  const step = new Step(schema);
  step.units(name);
  const members = [], assumed = [];
  const parent = rigid(next, 20000 / mm);
  const placed = step.placement(parent);

  /** A profile with its place in its plane: shifted and turned, then derived or mirrored. */
  const profile = ({height, width, wall, outer, inner}, {middle = false} = {}) => {
    const turn = 360 * next();
    const at = middle ? [0, 0] : [between(next, -80, 80) / mm, between(next, -80, 80) / mm];
    const [c, s] = [Math.cos((turn * Math.PI) / 180), Math.sin((turn * Math.PI) / 180)];
    const position = step.add('IFCAXIS2PLACEMENT2D', step.point(at), step.direction([c, s]));
    const id = step.add('IFCRECTANGLEHOLLOWPROFILEDEF', '.AREA.', '$', position, width / mm, height / mm, wall / mm, inner === undefined ? '$' : inner / mm, outer / mm);
    const place = product(shift(...at, 0), rotation(2, turn));
    const way = middle ? 'plain' : pick(next, ['plain', 'plain', 'derived', ...(modern ? ['mirrored'] : [])]);
    if (way === 'plain') return {id, place, scale: 1};
    if (way === 'mirrored') return {id: step.add('IFCMIRROREDPROFILEDEF', '.AREA.', '$', id, '*', '$'), place: product([[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], place), scale: 1};
    const [k, flipped] = [pick(next, [1, 1.25, 2]), next() < 0.5];
    const own = product(shift(between(next, -9, 9) / mm, between(next, -9, 9) / mm, 0), rotation(2, 360 * next()));
    const [x, y] = [0, 1].map((j) => step.direction(column(own, j).slice(0, 2).map((v) => (j === 1 && flipped ? -v : v))));
    const move = step.add('IFCCARTESIANTRANSFORMATIONOPERATOR2D', x, y, step.point(column(own, 3).slice(0, 2)), k);
    // Only the plane is scaled, not the length of the tube.
    const flat = own.map((row) => [row[0] * k, row[1] * k * (flipped ? -1 : 1), row[2], row[3]]);
    return {id: step.add('IFCDERIVEDPROFILEDEF', '.AREA.', '$', id, move, '$'), place: product(flat, place), scale: k};
  };
  const member = (id, size, all, long, scale, profileId) => {
    const ends = [0, long].map((z) => moved(all, [0, 0, z]).map((v) => v * mm));
    members.push({id, ends, up: unit(along(all, [0, 1, 0])), ...Object.fromEntries(Object.entries(size).map(([key, value]) => [key, value && value * scale]))});
    if (size.inner === undefined) assumed.push([profileId, /^assumed: .* has no InnerFilletRadius/]);
  };

  /** A beam of one body. */
  const beam = (id, {down = false} = {}) => {
    const size = sizes(next);
    const {id: section, place, scale} = profile(size);
    const [own, solid, long] = [rigid(next, 8000 / mm), rigid(next, 500 / mm), between(next, 500, 5000) / mm];
    const item = step.add('IFCEXTRUDEDAREASOLID', section, step.axes(solid), step.direction([0, 0, down ? -1 : 1]), long);
    step.product(pick(next, ['IFCBEAM', 'IFCCOLUMN', 'IFCMEMBER']), id, step.placement(own, placed), step.body([item]));
    member(id, size, product(parent, own, solid, place), down ? -long : long, scale, section);
  };

  /** The same body at another place, larger, and perhaps mirrored. */
  const mapped = (id) => {
    const size = sizes(next);
    const {id: section, place, scale} = profile(size);
    const [own, origin, to, long] = [rigid(next, 8000 / mm), rigid(next, 300 / mm), rigid(next, 3000 / mm), between(next, 500, 2500) / mm];
    const solid = step.add('IFCEXTRUDEDAREASOLID', section, step.axes(shift(0, 0, 0)), step.direction([0, 0, 1]), long);
    const inner = step.add('IFCSHAPEREPRESENTATION', '$', "'Body'", "'SweptSolid'", `(${solid})`);
    const map = step.add('IFCREPRESENTATIONMAP', step.axes(origin), inner);
    const [k, flipped] = [pick(next, [1, 1, 2]), next() < 0.5];
    const [x, y, z] = [0, 1, 2].map((j) => step.direction(column(to, j).map((v) => (j === 1 && flipped ? -v : v))));
    const target = step.add('IFCCARTESIANTRANSFORMATIONOPERATOR3D', x, y, step.point(column(to, 3)), k, z);
    step.product('IFCMEMBER', id, step.placement(own, placed), step.body([step.add('IFCMAPPEDITEM', map, target)]));
    member(id, size, product(parent, own, operator(to, k, flipped), origin, place), long, scale * k, section);
  };

  /** An edge of an analysis model; its Axis is stated in its placement, and IFC 2x3 has none. */
  const edge = (id) => {
    const size = sizes(next);
    const {id: section, place} = profile(size, {middle: true});
    const own = rigid(next, 8000 / mm);
    const upright = !modern && next() < 0.3;
    const run = upright ? between(next, 500, 5000) / mm : undefined;
    const ends = upright ? [[0, 0, 0], [0, 0, run]] : [0, 1].map(() => [0, 1, 2].map(() => between(next, -3000, 3000) / mm));
    const world = upright ? shift(...column(own, 3)) : own;
    const vertices = ends.map((p) => step.add('IFCVERTEXPOINT', step.point(p)));
    const drawn = step.add('IFCTOPOLOGYREPRESENTATION', '$', "'Reference'", "'Edge'", `(${step.add('IFCEDGE', ...vertices)})`);
    const axis = [0, 1, 2].map(() => between(next, -1, 1));
    const entity = step.add('IFCSTRUCTURALCURVEMEMBER', `'${String(step.lines.length).padStart(22, '1')}'`, '$', `'${id}'`, '$', '$', step.placement(world),
      step.add('IFCPRODUCTDEFINITIONSHAPE', '$', '$', `(${drawn})`), '.RIGID_JOINED_MEMBER.', ...(modern ? [step.direction(axis)] : []));
    const guid = `'${String(step.lines.length).padStart(22, '2')}'`;
    if (modern) step.add('IFCRELASSOCIATESMATERIAL', guid, '$', '$', '$', `(${entity})`, step.add('IFCMATERIALPROFILE', '$', '$', '$', section, '$', '$'));
    else step.add('IFCRELASSOCIATESPROFILEPROPERTIES', guid, '$', '$', '$', `(${entity})`, step.add('IFCGENERALPROFILEPROPERTIES', '$', section, ...Array(5).fill('$')), '$', '$');
    const [a, b] = ends.map((p) => moved(world, p));
    const z = unit(b.map((v, i) => v - a[i]));
    const up = modern ? along(world, axis) : upright ? [1, 0, 0] : [0, 0, 1];
    const y = unit(cross(z, cross(up, z)));
    const x = cross(y, z);
    const frame = [0, 1, 2].map((i) => [x[i], y[i], z[i], a[i]]);
    member(id, size, product([...frame, [0, 0, 0, 1]], place), Math.hypot(...b.map((v, i) => v - a[i])), 1, section);
    if (!modern) assumed.push([entity, /^assumed: .* has no Axis: the height lies along \+z, and of a tube within 1 deg of the vertical along \+x$/]);
  };

  beam('along', {});
  beam('down', {down: true});
  mapped('mapped');
  edge('edge');
  return {seed, name: `${seed} ${name} ${schema}`, text: step.text(), members, assumed};
}

/** A tee of two rectangular tubes in mm, and its IFC file in a placement and a unit. */
export function tee(seed) {
  const next = random(seed + 9000);
  const lean = between(next, 50, 130);
  const [c, s] = [Math.cos((lean * Math.PI) / 180), Math.sin((lean * Math.PI) / 180)];
  const chord = {id: 'chord', start_mm: [-1000, 0, 0], end_mm: [1000, 0, 0], height_mm: 120, width_mm: 80, wall_mm: 5, up: [0, 0, 1]};
  const post = {id: 'post', start_mm: [0, 0, 0], end_mm: [900 * c, 0, 900 * s], height_mm: 60, width_mm: 40, wall_mm: 4, up: [s, 0, -c]};
  const radii = ({wall_mm}) => ({corner_radius_mm: 2 * wall_mm, inner_corner_radius_mm: wall_mm});
  const members = [chord, post].map((each) => ({...each, kind: 'rectangular_tube', ...radii(each)}));
  const unitName = pick(next, Object.keys(unitsInMm));
  const mm = unitsInMm[unitName];
  const step = new Step(pick(next, ['IFC4', 'IFC2X3']));
  step.units(unitName);
  const world = rigid(next, 20000 / mm);
  for (const {id, start_mm, end_mm, height_mm, width_mm, wall_mm, corner_radius_mm, inner_corner_radius_mm, up} of members) {
    const run = end_mm.map((v, i) => v - start_mm[i]);
    const z = unit(run);
    const turn = 360 * next();
    const x = cross(up, z);
    const own = product([...[0, 1, 2].map((i) => [x[i], up[i], z[i], start_mm[i] / mm]), [0, 0, 0, 1]], rotation(2, -turn));
    const [cos, sin] = [Math.cos((turn * Math.PI) / 180), Math.sin((turn * Math.PI) / 180)];
    const position = step.add('IFCAXIS2PLACEMENT2D', step.point([0, 0]), step.direction([cos, sin]));
    const section = step.add('IFCRECTANGLEHOLLOWPROFILEDEF', '.AREA.', '$', position, ...[width_mm, height_mm, wall_mm, inner_corner_radius_mm, corner_radius_mm].map((v) => v / mm));
    const solid = step.add('IFCEXTRUDEDAREASOLID', section, step.axes(shift(0, 0, 0)), step.direction([0, 0, 1]), Math.hypot(...run) / mm);
    step.product('IFCBEAM', id, step.placement(product(world, own)), step.body([solid]));
  }
  return {members, text: step.text()};
}
