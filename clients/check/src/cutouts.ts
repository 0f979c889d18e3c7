/** Cut-outs: edges on their shapes, the beam next to them, areas and volumes, places and webs (docs/theory/cutouts.md). */
import {girth, girthAt, type Outline, outOf, walk, wallAt} from './outline.js';
import type {Scope} from './report.js';
import type {Row} from './section_ends.js';
import {around, chainOf, type Flat, type Instance, offChain, placesOf, type Segment} from './shapes.js';
import type {Body, Numbers} from './solids.js';
import {add, cross, dot, mul, norm, onTube, RAD, sub, unit, type V3} from './space.js';

const list = (v: unknown) => (v ?? []) as Body[];

/** The tube that is cut: a round one has `outer` and `bore` of equal sides and corners. */
export interface Host {
  outer: Outline;
  bore: Outline;
  wall: number;
  work: number; // of the start, in the part's frame
  length: number; // between the work points
  rows?: {start: Row[]; finish: Row[]};
  longest?: number; // z of the finish's long point
}

const isRound = ({outer}: Host): boolean => outer.r === outer.a && outer.a === outer.b;

/** The tangent plane at an anchor: `along` the tube, `across` it. */
interface Plane {
  origin: V3;
  across: V3;
  normal: V3;
}

/** Where a cut-out's anchor lies, by z and the girth outside. */
interface Anchor {
  z: number;
  s: number;
}

function anchorOf(host: Host, asked: Body, one: Instance, finishLong: number): Anchor {
  const at = asked.at as Body;
  const number = at as unknown as Numbers;
  const finish = at.from === 'finish';
  const zero = at.z_zero === 'long_point' ? (finish ? finishLong : 0) : host.work + (finish ? host.length : 0);
  const z = zero + (finish ? -number.z_mm : number.z_mm) + one.along;
  const whole = girth(host.outer);
  const half = at.opposite ? 2 : 0;
  if ('face' in at) {
    const face = one.face === undefined ? (number.face - 1 + half) % 4 : one.face - 1;
    return {z, s: (whole / 4) * face + (number.offset_mm ?? 0) + one.round};
  }
  const s = 'phi_deg' in at ? (number.phi_deg * whole) / 360 : number.girth_mm;
  if (isRound(host)) return {z, s: s + (half * whole) / 4 + one.round};
  const {face} = walk(host.outer, s);
  const offset = ((s - (whole / 4) * (face - 1) + 1.5 * whole) % whole) - whole / 2;
  return {z, s: (whole / 4) * (one.face === undefined ? (face - 1 + half) % 4 : one.face - 1) + offset + one.round};
}

function planeAt(host: Host, {z, s}: Anchor): Plane {
  const {x, y, normal} = walk(host.outer, s);
  return {origin: [x, y, z], across: [-normal[1], normal[0], 0], normal};
}

const inPlane = ({origin, across}: Plane, p: V3): Flat => [p[2] - origin[2], dot(sub(p, origin), across)];

/** Places of a group's rows in space: both edges, and the axis of the beam at both walls. */
interface Places {
  outer: V3[];
  inner: V3[];
  beam: [V3, V3][]; // at the bore and outside
}

function placesOfRows(host: Host, points: {[name: string]: number[]}): Places {
  const z = (name: string, otherwise: string) => points[name] ?? points[otherwise];
  if (isRound(host)) {
    const on = (rho: number, phi: string, height: string): V3[] => points[phi].map((deg, i) => onTube(rho, deg * RAD, points[height][i]));
    const axis = on(host.bore.a, 'torch_phi_inner_deg', 'torch_z_inner_mm');
    return {
      outer: on(host.outer.a, 'phi_deg', 'z_mm'),
      inner: on(host.bore.a, 'phi_inner_deg', 'z_inner_mm'),
      beam: on(host.outer.a, 'torch_phi_deg', 'torch_z_mm').map((p, i) => [axis[i], p]),
    };
  }
  const outside = (s: string, height: string): V3[] =>
    points[s].map((at, i) => {
      const {x, y} = walk(host.outer, at);
      return [x, y, points[height][i]];
    });
  const inside = (s: string, outer: string, height: number[]): V3[] =>
    points[s]
      ? points[s].map((at, i) => {
          const {x, y} = walk(host.bore, at);
          return [x, y, height[i]];
        })
      : points[outer].map((at, i) => {
          const here = walk(host.outer, at);
          const e = wallAt(host.bore, here);
          return [here.x - e * here.normal[0], here.y - e * here.normal[1], height[i]];
        });
  const axis = inside('torch_girth_inner_mm', 'torch_girth_mm', z('torch_z_inner_mm', 'torch_z_mm'));
  return {
    outer: outside('girth_mm', 'z_mm'),
    inner: inside('girth_inner_mm', 'girth_mm', z('z_inner_mm', 'z_mm')),
    beam: outside('torch_girth_mm', 'torch_z_mm').map((p, i) => [axis[i], p]),
  };
}

/** How a wall is cut, by its request; `over`: over a corner of a tube that is not round. */
function wallOf(host: Host, request: Body, asked: Body, over: boolean): string {
  if (!isRound(host) && !over) return 'flat';
  if (asked.wall === 'developed') return 'developed';
  const tilt = asked.tilt ?? (asked.countersink ? 'free' : request.preset === 'tube_laser' ? 'none' : 'axial');
  return tilt === 'free' ? 'prism' : 'square_from_bore';
}

/** Areas on both walls and the metal between, of a shape: developed once, else shadows of a straight tool. */
function takenBy(host: Host, chain: Segment[], wall: string): [number, number, number] {
  const [R, r] = [host.outer.a, host.bore.a];
  const area = around(chain, (y) => -y);
  if (wall === 'flat') return [area, area, area * host.wall];
  const ring = (R * R - r * r) / 2;
  if (wall === 'developed') return [area, (area * r) / R, (area * ring) / R];
  const shadow = (rho: number) => around(chain, (y) => -rho * Math.asin(y / rho));
  if (wall === 'square_from_bore') return [(shadow(r) * R) / r, shadow(r), (shadow(r) * ring) / r];
  const sector = (rho: number, y: number) => (y * Math.sqrt(rho * rho - y * y) + rho * rho * Math.asin(y / rho)) / 2;
  return [shadow(R), shadow(r), around(chain, (y) => sector(r, y) - sector(R, y))];
}

/** The least radius that the kerf leaves in a corner. */
const leastRadius = (host: Host, wall: string, kerf: number): number | undefined =>
  wall === 'flat' || wall === 'prism' ? kerf / 2 : wall === 'developed' ? (kerf / 2) * (host.outer.a / host.bore.a) ** 2 : undefined;

const near = (a: number, b: number, whole: number): number => {
  const off = (((a - b) % whole) + whole) % whole;
  return Math.min(off, whole - off);
};

/** Checks all cut-outs of a part; returns the metal that they take, or nothing if some shape is not covered. */
export function checkCutouts(scope: Scope, request: Body, result: Body, host: Host): number | undefined {
  const all = list(request.cutouts);
  const groups = list(result.cutouts);
  if (!groups.length) {
    scope.most('cutouts', list(request.cutouts).length, 0, '');
    return 0;
  }
  const whole = girth(host.outer);
  const finishLong = host.longest ?? Math.max(...(host.rows?.finish ?? []).flatMap(({edges}) => edges.map(([, z]) => z)));
  const kerf = (request.kerf_mm as number | undefined) ?? 0;
  const density = (request.density_kg_m3 as number | undefined) ?? 7850;
  let taken: number | undefined = 0;
  const edges = new Map<string, Places>();
  for (const group of groups) {
    const asked = all.find(({id}) => id === group.id);
    const own = scope.under('cutouts/*', `${scope.title}cut-out: `);
    const figures = group as unknown as Numbers;
    const instances = list(group.instances) as unknown as (Numbers & {id: string})[];
    if (taken !== undefined) taken += figures.volume_mm3 * instances.length;
    own.same('mass', figures.mass_kg, figures.volume_mm3 * 1e-9 * density, 1e-12 * (1 + figures.mass_kg), 'kg', String(group.id));
    own.same('turns', figures.turns, 0, 0, '');
    own.covers('mass_kg', 'turns');
    const places = placesOfRows(host, group.points as unknown as {[name: string]: number[]});
    if (group.wall !== 'countersink') instances.forEach((one) => edges.set(`${one.id} ${group.side}`, moved(host, places, instances[0], one)));
    if (!asked || group.hole) {
      own.not('', 'of holes for branches only places and mass are checked');
      taken = undefined;
      continue;
    }
    checkInstances(own, host, asked, group, instances, places, finishLong, whole);
    const far = group.side === 'far';
    const expected = placesOf(String(asked.id), asked.pattern as Body | undefined, whole);
    const first = expected.find(({name}) => name === instances[0].id);
    if (!first) {
      own.most('instances', NaN, 0, '', instances[0].id);
      continue;
    }
    const plane = planeAt(host, anchorOf(host, asked, first, finishLong));
    if (group.wall === 'countersink') {
      checkCone(own, host, asked, group, plane, places);
      continue;
    }
    const wall = String(group.wall);
    const over = !isRound(host) && 'normal_deg' in (group.points as Body);
    own.equal('wall', wall, wallOf(host, request, asked, over), String(group.id));
    const chain = chainOf(asked.shape as Body, kerf, leastRadius(host, wall, kerf) ?? NaN);
    if (!chain || chain.some(({from}) => Number.isNaN(from[0] + from[1]))) {
      own.not('points', 'the shape needs a reader or a radius that is not covered');
      own.not('volume_mm3', 'as of points');
      taken = undefined;
      continue;
    }
    const cut = {chain, wall, far, kerf: (asked.shape as Body).kind === 'slit' ? 0 : kerf};
    if (over) {
      checkOver(own, host, cut, group, {...plane, s: anchorOf(host, asked, first, finishLong).s}, places);
      own.not('volume_mm3', 'over a corner areas and volume are not computed again');
      taken = undefined;
    } else checkShape(own, host, cut, group, plane, places);
  }
  for (const asked of all)
    for (const {name} of placesOf(String(asked.id), asked.pattern as Body | undefined, whole))
      scope.most('cutout_left_out', groups.some((group) => list(group.instances).some(({id}) => id === name)) ? 0 : 1, 0, '', name);
  checkReport(scope, result, host, edges);
  return taken;
}

/** Where the beam runs along the tube at each instance, in the order of the answer. */
export function beamSpans(result: Body): [number, number][] {
  return list(result.cutouts).flatMap((group) => {
    const points = group.points as unknown as {[name: string]: number[]};
    const z = ['torch_z_mm', 'torch_z_inner_mm'].flatMap((name) => points[name] ?? []);
    const all = list(group.instances) as unknown as Numbers[];
    return all.map((one): [number, number] => [Math.min(...z) + one.z_mm - all[0].z_mm, Math.max(...z) + one.z_mm - all[0].z_mm]);
  });
}

/** The rows of another instance, turned and moved from those of the first. */
function moved(host: Host, places: Places, first: Numbers, one: Numbers): Places {
  const dz = one.z_mm - first.z_mm;
  const ds = one.girth_mm - first.girth_mm;
  const place = (outline: Outline, p: V3): V3 => {
    const s = girthAt(outline, p[0], p[1]);
    const turn = isRound(host) ? (ds * girth(outline)) / girth(host.outer) : faceTurn(host, outline, first, one) + (one.offset_mm - first.offset_mm);
    const {x, y} = walk(outline, s + turn);
    return [x, y, p[2] + dz];
  };
  return {
    outer: places.outer.map((p) => place(host.outer, p)),
    inner: places.inner.map((p) => place(host.bore, p)),
    beam: [],
  };
}

/** From the middle of one face to that of another, along an outline. */
const faceTurn = (host: Host, outline: Outline, first: Numbers, one: Numbers): number => {
  const middle = (face: number) => (girth(outline) / 4) * (face - 1);
  return isRound(host) ? 0 : middle(one.face) - middle(first.face);
};

function checkInstances(
  scope: Scope,
  host: Host,
  asked: Body,
  group: Body,
  instances: (Numbers & {id: string})[],
  places: Places,
  finishLong: number,
  whole: number,
): void {
  const expected = placesOf(String(asked.id), asked.pattern as Body | undefined, whole);
  const far = group.side === 'far';
  const z = places.outer.map((p) => p[2] - instances[0].z_mm);
  const [low, high] = [Math.min(...z), Math.max(...z)];
  const points = group.points as unknown as {[name: string]: number[]};
  const round = points.girth_mm ?? points.phi_deg.map((deg) => deg * RAD * host.outer.a);
  const reach = [Math.min(...round), Math.max(...round)].map((s) => s - instances[0].girth_mm);
  for (const one of instances) {
    const want = expected.find(({name}) => name === one.id);
    scope.most('instance_named', want ? 0 : 1, 0, '', one.id);
    if (!want) continue;
    const anchor = anchorOf(host, asked, want, finishLong);
    const fine = 2e-10 * (1 + host.length / 1000);
    scope.same('instance_z', one.z_mm, anchor.z, fine, 'mm', one.id);
    scope.same('instance_from_finish', one.from_finish_mm, finishLong - one.z_mm, fine, 'mm', one.id);
    scope.same('instance_reach', one.z_from_mm, one.z_mm + low, fine, 'mm', one.id);
    scope.same('instance_reach', one.z_to_mm, one.z_mm + high, fine, 'mm', one.id);
    if (isRound(host)) {
      scope.most('instance_girth', near(one.girth_mm, anchor.s, whole), 3e-10, 'mm', one.id);
      scope.same('instance_phi', one.phi_deg, (one.girth_mm * 360) / whole, 1e-9, 'deg', one.id);
    } else {
      const {x, y} = walk(host.outer, anchor.s);
      const here = walk(host.outer, one.girth_mm);
      // A wall square to the outside begins on the bore.
      const square = far && group.wall === 'square_from_bore';
      const e = square ? wallAt(host.bore, here) : 0;
      const opposite: V3 = far ? mirrored(square ? host.bore : host.outer, host, anchor) : [x, y, 0];
      const off = Math.hypot(here.x - e * here.normal[0] - opposite[0], here.y - e * here.normal[1] - opposite[1]);
      scope.most('instance_girth', off, 3e-10, 'mm', one.id);
      scope.most('instance_offset', near(one.girth_mm, (whole / 4) * (one.face - 1) + one.offset_mm, whole), 3e-10, 'mm', one.id);
    }
    const [from, to] = reach.map((off) => off + one.girth_mm);
    scope.most('instance_span', near(one.girth_from_mm, from, whole), 3e-10, 'mm', one.id);
    scope.same('instance_span', one.girth_to_mm - one.girth_from_mm, to - from, 3e-10, 'mm', one.id);
  }
  scope.covers(
    ...['z_mm', 'from_finish_mm', 'z_from_mm', 'z_to_mm', 'girth_mm', 'girth_from_mm', 'girth_to_mm', 'phi_deg', 'face', 'offset_mm'].map(
      (name) => `instances/*/${name}`,
    ),
  );
}

/** The place of an outline straight through the tube from an anchor, along its normal. */
function mirrored(outline: Outline, host: Host, anchor: Anchor): V3 {
  const {x, y, normal} = walk(host.outer, anchor.s);
  const at = (way: number): V3 => [x - way * normal[0], y - way * normal[1], 0];
  let [low, high] = [x * normal[0] + y * normal[1], 4 * (host.outer.a + host.outer.b)];
  for (let i = 0; i < 100; i += 1) {
    const middle = (low + high) / 2;
    const [p, q] = at(middle);
    if (outOf(outline, p, q).off < 0) low = middle;
    else high = middle;
  }
  return at(high);
}

interface Cut {
  chain: Segment[];
  wall: string;
  far: boolean;
  kerf: number;
}

/** Both edges on the shape's prism, or on the shape laid on the wall; the beam next to the wall; the metal that is taken. */
function checkShape(scope: Scope, host: Host, {chain, wall, far, kerf}: Cut, group: Body, plane: Plane, places: Places): void {
  const [R, r] = [host.outer.a, host.bore.a];
  const developed = (p: V3): Flat => {
    const turned = Math.atan2(dot(p, plane.across), dot(p, plane.normal));
    return [p[2] - plane.origin[2], R * (far ? turned - Math.sign(turned) * Math.PI : turned)];
  };
  const name = String(group.id);
  places.outer.forEach((p, i) => {
    const q = places.inner[i];
    const where = `${name} row ${i}`;
    if (wall === 'developed') {
      scope.most('edge_on_shape', offChain(chain, developed(p)), 1e-10, 'mm', where);
      scope.most('wall_square', norm(sub(q, [(p[0] * r) / R, (p[1] * r) / R, p[2]])), 1e-10, 'mm', where);
    } else if (wall === 'square_from_bore') {
      scope.most('edge_on_shape', offChain(chain, inPlane(plane, q)), 1e-10, 'mm', where);
      scope.most('wall_square', norm(sub(q, [(p[0] * r) / R, (p[1] * r) / R, p[2]])), 1e-10, 'mm', where);
    } else {
      scope.most('edge_on_shape', offChain(chain, inPlane(plane, p)), 1e-10, 'mm', where);
      scope.most('edge_on_shape', offChain(chain, inPlane(plane, q)), 1e-10, 'mm', where);
      scope.most('wall_straight', norm(cross(sub(p, q), plane.normal)), 1e-10, 'mm', where);
    }
  });
  const [outer, inner, volume] = takenBy(host, chain, wall);
  const figures = group as unknown as Numbers;
  scope.same('area', figures.area_outer_mm2 / outer, 1, 1e-10, '', name);
  scope.same('area', figures.area_inner_mm2 / inner, 1, 1e-10, '', name);
  scope.same('cutout_volume', figures.volume_mm3 / volume, 1, 1e-10, '', name);
  scope.covers('area_outer_mm2', 'area_inner_mm2', 'volume_mm3');
  checkLengthOf(scope, host, group);
  if (wall === 'flat' || wall === 'prism')
    places.beam.forEach((axis, i) => {
      for (const at of axis) scope.same('beam_off_shape', kerf > 0 ? offChain(chain, inPlane(plane, at)) : 0, kerf / 2, 3e-10, 'mm', `${name} row ${i}`);
    });
  else checkBeam(scope, kerf, name, places);
  const columns = ['phi_deg', 'z_mm', 'phi_inner_deg', 'z_inner_mm', 'girth_mm', 'torch_phi_deg', 'torch_z_mm', 'torch_phi_inner_deg', 'torch_z_inner_mm'];
  scope.covers(...[...columns, 'torch_girth_mm', 'b_deg', 'a_deg'].map((column) => `points/${column}`));
  checkAngles(scope, group, places, name);
}

/** Over a corner: a prism along the anchor's normal, its edge on the bore, or the shape laid on the outside; the beam next to the wall. */
function checkOver(scope: Scope, host: Host, {chain, wall, far, kerf}: Cut, group: Body, plane: Plane & {s: number}, places: Places): void {
  const name = String(group.id);
  const whole = girth(host.outer);
  places.outer.forEach((p, i) => {
    const q = places.inner[i];
    const where = `${name} row ${i}`;
    const here = walk(host.outer, girthAt(host.outer, p[0], p[1]));
    const square = Math.abs((q[0] - p[0]) * here.normal[1] - (q[1] - p[1]) * here.normal[0]);
    const round = girthAt(host.outer, p[0], p[1]) - plane.s;
    const b = round - whole * Math.round(round / whole);
    if (wall === 'developed') scope.most('edge_on_shape', offChain(chain, [p[2] - plane.origin[2], b]), 1e-9, 'mm', where);
    else scope.most('edge_on_shape', offChain(chain, inPlane(plane, q)), 1e-9, 'mm', where);
    if (wall === 'prism') scope.most('edge_on_shape', offChain(chain, inPlane(plane, p)), 1e-9, 'mm', where);
    else scope.most('wall_square', square, 1e-9, 'mm', where);
    scope.most('edge_on_side', (dot(p, plane.normal) - dot(q, plane.normal)) * (far ? 1 : -1), 1e-9, 'mm', where);
    const points = group.points as unknown as {[column: string]: (number | boolean)[]};
    const turned = (Math.atan2(here.normal[1], here.normal[0]) / RAD - Number(points.normal_deg[i])) / 360;
    scope.most('normal', 360 * Math.abs(turned - Math.round(turned)), 1e-9, 'deg', where);
  });
  checkLengthOf(scope, host, group);
  if (wall === 'prism')
    places.beam.forEach((axis, i) => {
      for (const at of axis) scope.same('beam_off_shape', kerf > 0 ? offChain(chain, inPlane(plane, at)) : 0, kerf / 2, 1e-9, 'mm', `${name} row ${i}`);
    });
  else checkBeam(scope, kerf, name, places);
  const columns = [
    'girth_mm',
    'normal_deg',
    'z_mm',
    'girth_inner_mm',
    'z_inner_mm',
    'torch_girth_mm',
    'torch_z_mm',
    'torch_girth_inner_mm',
    'torch_z_inner_mm',
  ];
  scope.covers(...[...columns, 'b_deg', 'a_deg'].map((column) => `points/${column}`));
  checkAngles(scope, group, places, name);
}

/** The column of the way along the outer edge, which runs straight from row to row on the developed outside. */
function checkLengthOf(scope: Scope, host: Host, group: Body): void {
  const points = group.points as unknown as {[name: string]: number[]};
  const round = isRound(host) ? points.phi_deg.map((deg) => deg * RAD * host.outer.a) : points.girth_mm;
  let way = 0;
  points.z_mm.forEach((z, i) => {
    scope.same('developed', points.developed_mm[i], way, 2e-10 + 1e-12 * way, 'mm', `${group.id} row ${i}`);
    const k = (i + 1) % round.length;
    way += Math.hypot(near(round[k], round[i], girth(host.outer)), points.z_mm[k] - z);
  });
  scope.same('length', group.length_mm as number, way, 2e-10 + 1e-12 * way, 'mm', String(group.id));
  scope.covers('points/developed_mm', 'length_mm');
}

/** From a line to the nearest place of a piece of another. */
function between(axis: [V3, V3], from: V3, to: V3): number {
  const d = unit(sub(axis[1], axis[0]));
  const off = (p: V3) => cross(sub(p, axis[0]), d);
  const [a, b] = [off(from), off(to)];
  const way = sub(b, a);
  const square = dot(way, way);
  const share = square > 0 ? Math.min(1, Math.max(0, -dot(a, way) / square)) : 0;
  return norm(add(a, mul(way, share)));
}

/** No wall line comes nearer to a beam's axis than half the kerf, and each row's own is near, unless a corner keeps the beam off. */
function checkBeam(scope: Scope, kerf: number, name: string, places: Places): void {
  if (kerf === 0) return;
  const n = places.beam.length;
  places.beam.forEach((axis, i) => {
    let least = Infinity;
    for (let k = 0; k < n; k += 1)
      if (norm(sub(places.outer[k], axis[1])) < 3 * kerf + norm(sub(places.outer[i], axis[1])))
        least = Math.min(least, between(axis, places.inner[k], places.outer[k]));
    scope.most('beam_clear', kerf / 2 - least, 5e-3, 'mm', `${name} row ${i}`);
    scope.most('beam_near', between(axis, places.inner[i], places.outer[i]) - kerf / 2, 5 * kerf, 'mm', `${name} row ${i}`);
  });
}

/** B: the beam's lean along the tube in the plane through the axis of the tube; A: across it. */
function checkAngles(scope: Scope, group: Body, places: Places, name: string): void {
  const points = group.points as unknown as {[name: string]: number[]};
  points.b_deg.forEach((deg, i) => {
    const [inner, outer] = places.beam[i];
    const way = sub(outer, inner);
    if (Math.abs(way[2]) < 1e-12) scope.same('b', deg, 0, 1e-9, 'deg', `${name} row ${i}`);
  });
}

/** A countersink: each line of its wall lies on the cone about the anchor's normal. */
function checkCone(scope: Scope, host: Host, asked: Body, group: Body, plane: Plane, places: Places): void {
  const {diameter_mm, angle_deg} = asked.countersink as unknown as Numbers;
  const hole = (asked.shape as unknown as Numbers).diameter_mm;
  const made = group.countersink as unknown as Numbers;
  const half = (angle_deg / 2) * RAD;
  const depth = (diameter_mm - hole) / 2 / Math.tan(half);
  scope.same('countersink', made.diameter_mm, diameter_mm, 1e-12, 'mm');
  scope.same('countersink', made.angle_deg, angle_deg, 1e-12, 'deg');
  scope.same('countersink', made.depth_mm, depth, 1e-10, 'mm');
  scope.same('countersink', made.land_mm, Math.max(0, host.wall - depth), 1e-10, 'mm');
  const fromAxis = (p: V3): number => Math.hypot(...inPlane(plane, p));
  const offCone = (p: V3): number => (fromAxis(p) - diameter_mm / 2 - dot(sub(p, plane.origin), plane.normal) * Math.tan(half)) * Math.cos(half);
  places.outer.forEach((p, i) => {
    const q = places.inner[i];
    const through = offCone(q) * Math.sign(fromAxis(q)) > -1e-6 && fromAxis(q) > hole / 2 - 1e-6; // else the circle's own wall is left there
    scope.most('cone', Math.abs(offCone(p)), 1e-10, 'mm', `${group.id} row ${i}`);
    scope.most('cone', Math.min(Math.abs(fromAxis(q) - hole / 2), through ? Math.abs(offCone(q)) : Infinity), 1e-10, 'mm', `${group.id} row ${i}`);
  });
  checkLengthOf(scope, host, group);
  scope.covers('countersink/diameter_mm', 'countersink/angle_deg', 'countersink/depth_mm', 'countersink/land_mm');
  const columns = ['phi_deg', 'z_mm', 'phi_inner_deg', 'z_inner_mm', 'girth_mm', 'girth_inner_mm'];
  scope.covers(...columns.map((column) => `points/${column}`)).not('volume_mm3', 'of a countersink only its edges are checked');
}

/** The narrowest web: as long as it is stated between the places it names, and no shorter one among the rows. */
function checkReport(scope: Scope, result: Body, host: Host, edges: Map<string, Places>): void {
  const report = result.cutout_report as Body | undefined;
  if (!report) return;
  const web = report.web as (Body & Numbers) | undefined;
  const own = scope.under('cutout_report', `${scope.title}cut-outs: `);
  for (const name of ['web', 'to_end'] as const) {
    const one = report[name] as (Body & Numbers) | undefined;
    if (!one) continue;
    const [from, to] = [one.from, one.to] as unknown as [Numbers, Numbers];
    const inner = isRound(host) ? Math.abs(one.radius_mm - host.bore.a) < 1e-9 : (one as Body).surface === 'inner';
    const of = inner ? host.bore : host.outer;
    const s = (p: Numbers) => (isRound(host) ? p.phi_deg * RAD * of.a : p.girth_mm);
    own.same('web', one.width_mm, Math.hypot(near(s(from), s(to), girth(of)), from.z_mm - to.z_mm), 3e-10, 'mm', name);
    own.covers(`${name}/width_mm`, `${name}/radius_mm`, ...['from', 'to'].flatMap((p) => ['phi_deg', 'girth_mm', 'z_mm'].map((m) => `${name}/${p}/${m}`)));
  }
  own.not('net_section', 'the least section is not looked for');
  if (!web || edges.size > 60) return;
  const rings = [...edges.values()].map((places) =>
    (['outer', 'inner'] as const).map((side) => {
      const of = side === 'outer' ? host.outer : host.bore;
      return places[side].map((p): Flat => [p[2], girthAt(of, p[0], p[1])]);
    }),
  );
  const ids = [...edges.keys()];
  let least = Infinity;
  for (let i = 0; i < rings.length; i += 1)
    for (let k = 0; k < i; k += 1) {
      if (ids[i] === ids[k]) continue;
      rings[i].forEach((ring, side) => {
        const whole = girth(side ? host.bore : host.outer);
        for (const [z, s] of ring) for (const [y, t] of rings[k][side]) least = Math.min(least, Math.hypot(z - y, near(s, t, whole)));
      });
    }
  own.most('web_narrowest', web.width_mm - least, 1e-6, 'mm');
}
