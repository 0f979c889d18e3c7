// IFC files drawn at random: profiles with voids, derived ones, structural members, "*" for omitted
// values, names and GUIDs.
import {between, pick, random} from './random.mjs';
import {moved, product, rotation, shift, Step} from './step.mjs';

const unitsInMm = {metre: 1000, millimetre: 1, centimetre: 10, inch: 25.4, foot: 304.8};
/** Typed in from EN 10210-2 and ASME B36.10M. */
const listed = [[114.3, 6.3, 'CHS 114.3x6.3'], [60.3, 3.2, 'CHS 60.3x3.2'], [219.1, 12.5, 'CHS 219.1x12.5'], [168.3, 7.11, 'NPS 6 SCH 40'], [457, 12.7, 'NPS 18 XS'], [1219, 9.53, 'NPS 48 STD'], [76.1, 5, 'CHS 76.1x5']];
const rigid = (next, reach) => product(shift(...[0, 1, 2].map(() => between(next, -reach, reach))), rotation(2, 360 * next()), rotation(0, 360 * next()), rotation(1, 360 * next()));
const uuid = (next) => [8, 4, 4, 4, 12].map((n) => Array.from({length: n}, () => Math.floor(16 * next()).toString(16)).join('')).join('-');
const ifcGuid = (next) => `${Math.floor(4 * next())}${Array.from({length: 21}, () => '0123456789ABCDEFGHIJabcdefghij_$'[Math.floor(32 * next())]).join('')}`;

/** A closed outline of two arcs, four arcs, or a circle. */
function circle(step, radius, middle, way) {
  const on = (deg) => [middle[0] + radius * Math.cos((deg * Math.PI) / 180), middle[1] + radius * Math.sin((deg * Math.PI) / 180)];
  const place = () => step.add('IFCAXIS2PLACEMENT2D', step.point(middle), '$');
  if (way === 'circle') return step.add('IFCCIRCLE', place(), radius);
  if (way === 'indexed') {
    const list = step.add('IFCCARTESIANPOINTLIST2D', `(${[0, 90, 180, 270].map((deg) => step.list(on(deg))).join(',')})`);
    return step.add('IFCINDEXEDPOLYCURVE', list, '(IFCARCINDEX((1,2,3)),IFCARCINDEX((3,4,1)))', '.F.');
  }
  const arcs = [[0, 90], [90, 180], [180, 270], [270, 360]].map(([a, b]) => {
    const rad = (deg) => `(IFCPARAMETERVALUE(${((deg * Math.PI) / 180).toFixed(14)}))`;
    const curve = step.add('IFCTRIMMEDCURVE', step.add('IFCCIRCLE', place(), radius), rad(a), rad(b), '.T.', '.PARAMETER.');
    return step.add('IFCCOMPOSITECURVESEGMENT', '.CONTINUOUS.', '.T.', curve);
  });
  return step.add('IFCCOMPOSITECURVE', `(${arcs.join(',')})`, '.F.');
}

/** A rectangle about the origin, its corners round by `r`. */
function rectangle(step, w, h, r, closed = true) {
  if (r === 0) {
    const corners = [[-w / 2, -h / 2], [0, -h / 2], [w / 2, -h / 2], [w / 2, h / 2], [-w / 2, h / 2]];
    return step.add('IFCPOLYLINE', `(${(closed ? [...corners, corners[0]] : corners).map(step.point).join(',')})`);
  }
  const [x, y, c] = [w / 2, h / 2, r * (1 - Math.SQRT1_2)];
  const points = [[-x + r, -y], [x - r, -y], [x - c, -y + c], [x, -y + r], [x, y - r], [x - c, y - c], [x - r, y], [-x + r, y], [-x + c, y - c], [-x, y - r], [-x, -y + r], [-x + c, -y + c]];
  const list = step.add('IFCCARTESIANPOINTLIST2D', `(${points.map(step.list).join(',')})`);
  return step.add('IFCINDEXEDPOLYCURVE', list, '(IFCLINEINDEX((1,2)),IFCARCINDEX((2,3,4)),IFCLINEINDEX((4,5)),IFCARCINDEX((5,6,7)),IFCLINEINDEX((7,8)),IFCARCINDEX((8,9,10)),IFCLINEINDEX((10,11)),IFCARCINDEX((11,12,1)))', '.F.');
}

export function file(seed) {
  const next = random(seed + 900);
  const unit = pick(next, Object.keys(unitsInMm));
  const mm = unitsInMm[unit];
  const schema = pick(next, ['IFC4', 'IFC4', 'IFC2X3', 'IFC4X3']);
  const modern = schema !== 'IFC2X3';
  const step = new Step(modern ? schema : 'IFC2X3');
  step.units(unit);
  const missing = () => pick(next, ['$', '*']);
  const size = () => {
    const [outer, wall, name] = pick(next, listed);
    const off = pick(next, [0, 0, 5e-5, -5e-5, 5e-4, -5e-4]); // within and beyond a ten-thousandth of a mm
    return {outer: outer + off, wall, expect: Math.abs(off) < 1e-4 ? {size: name} : {outer_diameter_mm: outer + off, wall_mm: wall}};
  };
  const label = (i) => {
    const kind = pick(next, ['name', 'tag', 'guid as tag', 'uuid as tag', 'only a guid']);
    const name = {name: `Brace ${i}`, tag: pick(next, [`B${i}`, `${1000 + i}`]), 'guid as tag': `Brace ${i}`, 'uuid as tag': `Brace ${i}`}[kind];
    const tag = {name: '$', tag: `'${name}'`, 'guid as tag': `'${ifcGuid(next)}'`, 'uuid as tag': `'${pick(next, ['', 'ID'])}${uuid(next).toUpperCase()}'`, 'only a guid': `'${uuid(next)}'`}[kind];
    return {name, tag, text: kind === 'tag' || kind === 'only a guid' ? '$' : `'${name}'`};
  };
  const members = [], boxes = [], reasons = [];
  const profile = ({outer, wall}) => {
    const [r, t] = [outer / 2 / mm, wall / mm];
    const at = [between(next, -50, 50) / mm, between(next, -50, 50) / mm];
    const position = () => step.add('IFCAXIS2PLACEMENT2D', step.point(at), missing());
    const way = pick(next, ['hollow', 'void', 'derived', ...(modern ? ['mirrored'] : [])]);
    if (way === 'void') {
      const ways = ['circle', 'composite', ...(modern ? ['indexed'] : [])];
      return {id: step.add('IFCARBITRARYPROFILEDEFWITHVOIDS', '.AREA.', missing(), circle(step, r, at, pick(next, ways)), `(${circle(step, r - t, at, pick(next, ways))})`), at};
    }
    const hollow = step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', missing(), position(), r, t);
    if (way === 'hollow') return {id: hollow, at};
    if (way === 'mirrored') return {id: step.add('IFCMIRROREDPROFILEDEF', '.AREA.', missing(), hollow, '*', missing()), at: [-at[0], at[1]]};
    const origin = [between(next, -9, 9) / mm, between(next, -9, 9) / mm];
    const operator = step.add('IFCCARTESIANTRANSFORMATIONOPERATOR2D', missing(), missing(), step.point(origin), missing());
    return {id: step.add('IFCDERIVEDPROFILEDEF', '.AREA.', missing(), hollow, operator, missing()), at: [at[0] + origin[0], at[1] + origin[1]]};
  };
  const guids = new Map();
  const element = (type, {text, tag}, placement, shape) => {
    const own = ifcGuid(next);
    const tail = modern ? [missing()] : [];
    const id = step.add(type, `'${own}'`, missing(), text, missing(), missing(), placement, shape, tag, ...tail);
    guids.set(id, own);
    return id;
  };
  const finished = (each, id) => ({...each, guid: guids.get(id), id: each.name ?? id});
  const analysis = seed % 3 === 0;
  for (let i = 0; i < 3; ++i) {
    const {outer, wall, expect} = size();
    const long = between(next, 500, 5000) / mm;
    const world = rigid(next, 20000 / mm);
    const ends = (at, from, to, place) => [[...at, from], [...at, to]].map((p) => moved(place, p).map((v) => v * mm));
    const named = label(i);
    if (!analysis) {
      const {id: section, at} = profile({outer, wall});
      const solid = step.add('IFCEXTRUDEDAREASOLID', section, modern ? pick(next, ['$', '*', step.axes(shift(0, 0, 0))]) : step.axes(shift(0, 0, 0)), step.direction([0, 0, 1]), long);
      const id = element(pick(next, ['IFCBEAM', 'IFCCOLUMN', 'IFCMEMBER']), named, step.placement(world), step.body([solid]));
      members.push(finished({name: named.name, ends: ends(at, 0, long, world), expect}, id));
      continue;
    }
    const vertices = [[0, 0, 0], [0, 0, long]].map((p) => step.add('IFCVERTEXPOINT', step.point(p)));
    const kind = pick(next, ['edge', 'oriented', 'curve']);
    const line = () => step.add('IFCPOLYLINE', `(${[[0, 0, 0], [0, 0, long]].map(step.point).join(',')})`);
    const plain = kind === 'curve' ? step.add('IFCEDGECURVE', ...vertices, line(), '.T.') : step.add('IFCEDGE', ...vertices);
    const edge = kind === 'oriented' ? step.add('IFCORIENTEDEDGE', missing(), missing(), plain, pick(next, ['.T.', '.F.'])) : plain;
    const context = step.add('IFCGEOMETRICREPRESENTATIONCONTEXT', missing(), "'Model'", '3', missing(), step.axes(shift(0, 0, 0)), missing());
    const drawn = step.add('IFCTOPOLOGYREPRESENTATION', context, "'Reference'", "'Edge'", `(${edge})`);
    const shape = step.add('IFCPRODUCTDEFINITIONSHAPE', missing(), missing(), `(${drawn})`);
    const own = ifcGuid(next);
    const tail = modern ? [step.direction([1, 0, 0])] : [];
    const text = named.name === undefined ? '$' : `'${named.name}'`;
    const id = step.add('IFCSTRUCTURALCURVEMEMBER', `'${own}'`, missing(), text, missing(), missing(), step.placement(world), shape, '.RIGID_JOINED_MEMBER.', ...tail);
    guids.set(id, own);
    const section = step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', missing(), modern ? missing() : step.add('IFCAXIS2PLACEMENT2D', step.point([0, 0]), missing()), outer / 2 / mm, wall / mm);
    if (modern) {
      const one = step.add('IFCMATERIALPROFILE', missing(), missing(), missing(), section, missing(), missing());
      const set = step.add('IFCMATERIALPROFILESET', missing(), missing(), `(${one})`, missing());
      const material = pick(next, [one, set, step.add('IFCMATERIALPROFILESETUSAGE', set, pick(next, ['$', '5', '10']), missing())]);
      step.add('IFCRELASSOCIATESMATERIAL', `'${ifcGuid(next)}'`, missing(), missing(), missing(), `(${id})`, material);
    } else {
      const properties = step.add('IFCGENERALPROFILEPROPERTIES', missing(), section, ...Array(5).fill('$'));
      step.add('IFCRELASSOCIATESPROFILEPROPERTIES', `'${ifcGuid(next)}'`, missing(), missing(), missing(), `(${id})`, properties, '$', '$');
    }
    members.push(finished({name: named.name, ends: ends([0, 0], 0, long, world), expect}, id));
  }
  // Rectangular tubes: one that a round tube ends at, one far away, as profiles of their own or with voids.
  const [w, h, t] = [200 / mm, 100 / mm, 8 / mm];
  const round = next() < 0.7 ? 16 / mm : 0;
  let open = 0; // whose corners are not stated
  for (const touched of [true, false]) {
    const place = product(shift(between(next, -9000, 9000) / mm, 0, (touched ? 6e5 : 8e5) / mm), rotation(2, 360 * next()));
    const hollow = next() < 0.5 || (round > 0 && !modern);
    const section = hollow
      ? step.add('IFCRECTANGLEHOLLOWPROFILEDEF', '.AREA.', missing(), modern ? missing() : step.add('IFCAXIS2PLACEMENT2D', step.point([0, 0]), missing()), w, h, t, missing(), round > 0 ? round : missing())
      : step.add('IFCARBITRARYPROFILEDEFWITHVOIDS', '.AREA.', missing(), rectangle(step, w, h, round), `(${rectangle(step, w - 2 * t, h - 2 * t, round > 0 ? round - t : 0)})`);
    const solid = step.add('IFCEXTRUDEDAREASOLID', section, step.axes(shift(0, 0, 0)), step.direction([0, 0, 1]), 3000 / mm);
    const name = touched ? 'box' : 'far box';
    const id = element('IFCBEAM', {text: `'${name}'`, tag: '$'}, step.placement(place), step.body([solid]));
    if (round === 0) {
      open += 1;
      reasons.push([id, /sharp/]);
    } else {
      const up = moved(place, [0, 1, 0]).map((v, i) => v - moved(place, [0, 0, 0])[i]);
      boxes.push({id: name, ends: [0, 3000 / mm].map((z) => moved(place, [0, 0, z]).map((v) => v * mm)), sides: [100, 200, 8], inner: hollow ? undefined : 8, up});
      if (hollow) reasons.push([section, /^assumed: .* has no InnerFilletRadius/]);
    }
    if (!touched) continue;
    const foot = product(place, shift(100 / mm, 0, 1500 / mm), rotation(1, 90));
    const pipe = step.add('IFCEXTRUDEDAREASOLID', step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', missing(), modern ? missing() : step.add('IFCAXIS2PLACEMENT2D', step.point([0, 0]), missing()), 30 / mm, 3 / mm),
      step.axes(shift(0, 0, 0)), step.direction([0, 0, 1]), 900 / mm);
    const own = element('IFCMEMBER', {text: "'on the box'", tag: '$'}, step.placement(foot), step.body([pipe]));
    members.push(finished({name: 'on the box', ends: [[0, 0, 0], [0, 0, 900 / mm]].map((p) => moved(foot, p).map((v) => v * mm)), expect: {outer_diameter_mm: 60, wall_mm: 3}}, own));
  }
  return {seed, text: step.text(), members, boxes, reasons, open, analysis};
}
