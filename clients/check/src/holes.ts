/** Holes of a chord for a branch, in the chord's frame (docs/theory/intersections-and-bevels.md, section 8). */
import {anglesOf, axialB, type Columns, grooveOf, local} from './bevel.js';
import type {Scope} from './report.js';
import {leavePlaces, type TorchLine} from './wall.js';
import {axisOf, type Body, type Size, sizeOf, tube} from './solids.js';
import {across, add, cross, dot, highest, integral, lineDistance, mix, mul, norm, onTube, RAD, sub, unit, type V3} from './space.js';

export interface Hole {
  outer: number; // radii of the chord
  inner: number;
  branchOuter: number;
  branchInner: number;
  q: V3; // foot of the common perpendicular, on the branch's axis
  d: V3; // out of the chord
  x: V3; // the branch's own frame
  y: V3;
  placement: {a: number; b: number; s: number; h: number};
  kind: string;
  gap: number;
  depth: number;
  groove: Body;
  tilt: string;
  kerf: number;
  torch: {min: number; max: number};
}

/** The four numbers of a line: between the axes, of the perpendicular, along it, up to it. */
export function numbersOf(point: V3, d: V3): {a: number; b: number; s: number; h: number; q: V3} {
  const sine = Math.hypot(d[0], d[1]);
  const [cosB, sinB] = [-d[1] / sine, d[0] / sine];
  const way = (-point[0] * sinB + point[1] * cosB) / sine;
  const q = add(point, mul(d, way));
  return {a: Math.atan2(sine, d[2]), b: Math.atan2(sinB, cosB), s: -(point[0] * cosB + point[1] * sinB), h: q[2], q};
}

export function holeOf(request: Body, chord: Size, sizes: ReadonlyMap<string, Size>): Hole {
  const branch = request.branch as Body;
  const joint = request.joint as Body;
  const size = sizeOf(branch, sizes);
  const [point, along] = axisOf(branch);
  const {q, ...placement} = numbersOf(point, along);
  const x: V3 = [-Math.cos(placement.b), -Math.sin(placement.b), 0];
  const torch = (request.torch ?? {}) as {min_deg?: number; max_deg?: number};
  return {
    outer: chord.outer_diameter_mm / 2,
    inner: chord.outer_diameter_mm / 2 - chord.wall_mm,
    branchOuter: size.outer_diameter_mm / 2,
    branchInner: size.outer_diameter_mm / 2 - size.wall_mm,
    q,
    d: along,
    x,
    y: cross(along, x),
    placement,
    kind: String(joint.kind),
    gap: (joint.gap_mm as number | undefined) ?? 0,
    depth: (joint.depth_mm as number | undefined) ?? chord.wall_mm,
    groove: request.groove as Body,
    tilt: String(request.tilt ?? 'axial'),
    kerf: (request.kerf_mm as number | undefined) ?? 0,
    torch: {min: torch.min_deg ?? -80, max: torch.max_deg ?? 80},
  };
}

const wrapped = (deg: number) => ((((deg + 180) % 360) + 360) % 360) - 180;

/** One hole: its edges in space against the branch, its angles, its torch line. */
export function checkHole(scope: Scope, hole: Hole, result: Body): void {
  const points = result.points as unknown as Columns;
  const far = result.side === 'far';
  const setOn = hole.kind === 'set_on';
  const rho = setOn ? hole.branchInner : hole.branchOuter + hole.gap;
  const surface = setOn ? hole.outer : hole.inner;
  const count = (points.phi_deg as number[]).length;
  const fine = 2e-10 * (1 + hole.outer / 100);
  const square = hole.tilt === 'none';
  /** Out of the chord along the branch, on this side of it. */
  const out = far ? mul(hole.d, -1) : hole.d;
  const speed = (w: number) => {
    const m = add(mul(hole.x, Math.cos(w)), mul(hole.y, Math.sin(w)));
    const foot = add(hole.q, mul(m, rho));
    const N = unit(across(add(foot, mul(hole.d, onSurface(foot, hole.d, surface, far))), [0, 0, 1]));
    const T = unit(cross(N, m));
    return rho / Math.abs(dot(T, cross(hole.d, m)));
  };
  for (let i = 0; i < count; i += 1) {
    const at = (name: string) => (points[name] as number[])[i];
    const where = `row ${i}`;
    const O = onTube(hole.outer, at('phi_deg') * RAD, at('z_mm'));
    const I = onTube(hole.inner, at('phi_inner_deg') * RAD, at('z_inner_mm'));
    const TO = onTube(hole.outer, at('torch_phi_deg') * RAD, at('torch_z_mm'));
    const TI = onTube(hole.inner, at('torch_phi_inner_deg') * RAD, at('torch_z_inner_mm'));
    const D = unit(sub(TO, TI));
    const P = setOn ? O : I;
    scope.same('hole_developed', at('developed_mm'), hole.outer * at('phi_deg') * RAD, 1e-10 + 1e-12 * hole.outer, 'mm', where);
    scope.same('hole_beam', at('beam_mm'), norm(sub(TO, TI)), fine, 'mm', where);
    const [r, p, z] = local(D, at('torch_phi_deg') * RAD);
    scope.same('hole_b', at('b_deg'), Math.atan2(z, r) / RAD, 3e-9, 'deg', where);
    scope.same('hole_a', at('a_deg'), Math.atan2(p, r) / RAD, 3e-9, 'deg', where);
    const wall = unit(sub(O, I));
    const beside = square ? norm(cross(wall, unit(across(O, [0, 0, 1])))) + norm(cross(D, unit(across(TO, [0, 0, 1])))) : norm(cross(wall, D)); // square to the tube each, else parallel
    scope.most('hole_wall_parallel', beside * norm(sub(O, I)), 2 * fine, 'mm', where);
    scope.most('hole_kerf', hole.kerf / 2 - lineDistance(P, TO, D), 1e-7, 'mm', where);
    if (square) scope.same('hole_groove', at('groove_deg'), at('dihedral_deg') - 90, 3e-9, 'deg', where); // its wall is square to the chord where it touches
    const m = unit(across(sub(P, hole.q), hole.d));
    if (!square) {
      scope.same('hole_on_branch', lineDistance(P, hole.q, hole.d), rho, fine, 'mm', where);
      const phase = Math.atan2(dot(m, hole.y), dot(m, hole.x)) / RAD;
      scope.most('hole_phase', Math.abs(wrapped(phase - at('branch_phi_deg'))), 3e-9, 'deg', where);
      const N = unit(across(P, [0, 0, 1]));
      const psi = Math.atan2(norm(cross(N, m)), -dot(N, m));
      scope.same('hole_dihedral', at('dihedral_deg'), psi / RAD, 4e-9, 'deg', where);
      const g = unit(sub(N, mul(m, dot(N, m))));
      scope.same('hole_groove', at('groove_deg'), Math.atan2(dot(D, m), dot(D, g)) / RAD, 4e-9, 'deg', where);
      if (hole.tilt === 'free' && !setOn) {
        const wanted = hole.groove.rule === 'square' ? Math.max(0, psi - Math.PI / 2) : (grooveOf(hole.groove, psi) ?? 0);
        const bound = Math.min(wanted, hole.torch.max * RAD + psi - Math.PI / 2);
        scope.same('hole_rule', at('groove_deg'), bound / RAD, 4e-9, 'deg', where);
      }
    }
    for (const edge of setOn ? [] : [O, I])
      scope.most('hole_clears_branch', hole.branchOuter + hole.gap - lineDistance(edge, hole.q, hole.d), 1e-6, 'mm', where);
    scope.most('hole_leaves', -dot(P, out) + dot(hole.q, out) - 3 * hole.outer, 0, 'mm', where);
    const [here, next] = [points.branch_phi_deg as number[], points.length_mm as number[]];
    const [a, b] = [here[i], here[(i + 1) % count]];
    const stated = i + 1 < count ? next[i + 1] - next[i] : (result.length_mm as number) - next[i] + next[0];
    const own = Math.abs(integral(speed, a * RAD, (a + wrapped(b - a)) * RAD, 1e-11)); // the far hole runs against the branch's phase
    scope.same('hole_length', stated, own, 1e-7 + 1e-7 * own, 'mm', where);
  }
  scope.equal('turns', result.turns, 0);
  scope.covers('length_mm', 'turns', ...Object.keys(points).map((name) => `points/${name}`));
  checkFitUp(scope, hole, result, points);
  checkBeam(scope, hole, result, points);
}

/** The way along d from `foot` to the cylinder of radius r about z: the higher meeting, on the far side the lower. */
function onSurface(foot: V3, d: V3, r: number, far: boolean): number {
  const [a, b, c] = [d[0] ** 2 + d[1] ** 2, foot[0] * d[0] + foot[1] * d[1], foot[0] ** 2 + foot[1] ** 2 - r * r];
  const side = Math.sqrt(Math.max(0, b * b - a * c));
  return (-b + (far ? -side : side)) / a;
}

/** Gap of a place of the hole's wall to the branch, or of the branch's end to the chord. */
type Fit = {root: V3; face: V3; off: (p: V3) => number}; // root and face: radius, phase and height

/** The two edges that face the other member at a row: the hole's own, or for a set-on branch those of its end. */
function fitOf(hole: Hole, points: Columns, i: number): Fit {
  const at = (name: string) => (points[name] as number[])[i];
  if (hole.kind !== 'set_on') {
    const face: V3 = [hole.outer, at('phi_deg') * RAD, at('z_mm')];
    const root: V3 = [hole.inner, at('phi_inner_deg') * RAD, at('z_inner_mm')];
    return {root, face, off: (p) => lineDistance(p, hole.q, hole.d) - hole.branchOuter};
  }
  const [w, end] = [at('branch_phi_deg') * RAD, endBy(hole, at('branch_phi_deg') * RAD)];
  return {root: [hole.branchInner, w, end.inner], face: [hole.branchOuter, w, end.outer], off: (p) => lineDistance(p, ...chordOf(hole)) - hole.outer};
}

/** The chord's axis in the branch's frame. */
const chordOf = ({placement: {a, s}}: Hole): [V3, V3] => axisOf({inclination_deg: a / RAD, clocking_deg: 0, offset_mm: s, height_mm: 0});

/** The branch's end at its phase: root on the chord with the gap, or on the cylinder as deep as it is set in; B the rule's, flush at least. */
function endBy(hole: Hole, phi: number): {inner: number; outer: number; b: number} {
  const [Q, E] = chordOf(hole);
  const R = hole.kind === 'set_in' ? hole.outer - hole.depth : hole.outer + hole.gap;
  const inner = tube('', Q, E, R).top(hole.branchInner * Math.cos(phi), hole.branchInner * Math.sin(phi)) ?? NaN;
  const n = local(unit(across(sub(onTube(hole.branchInner, phi, inner), Q), E)), phi);
  const {psi, flush} = anglesOf(n);
  const rule = hole.kind === 'set_in' ? flush : hole.groove.rule === 'square' ? 0 : axialB(grooveOf(hole.groove, psi) ?? 0, n);
  const b = Math.min(hole.torch.max * RAD, Math.max(rule, flush));
  return {inner, outer: inner + (hole.branchOuter - hole.branchInner) * Math.tan(b), b};
}

/** Gaps between the hole and the branch at both edges, the least across, and along straight lines between the rows. */
function checkFitUp(scope: Scope, hole: Hole, result: Body, points: Columns): void {
  const fit = result.fit_up as unknown as {[name: string]: number[]};
  const rows = (points.phi_deg as number[]).map((_, i) => fitOf(hole, points, i));
  const leastOf = ({root, face, off}: Fit): number => -highest((v) => -off(mix(onTube(...root), onTube(...face), v)), 0, 1, 4, 1e-5)[1];
  const near = (a: V3, b: V3): V3 => [b[0], a[1] + Math.atan2(Math.sin(b[1] - a[1]), Math.cos(b[1] - a[1])), b[2]];
  let [least, widest] = [Infinity, -Infinity];
  rows.forEach((row, i) => {
    const own = leastOf(row);
    scope.same('hole_fit_up', fit.root_mm[i], row.off(onTube(...row.root)), 1e-9, 'mm', `row ${i}`);
    scope.same('hole_fit_up', fit.face_mm[i], row.off(onTube(...row.face)), 1e-9, 'mm', `row ${i}`);
    // Where the least gap lies inside the wall, answers have that of a few places across it, up to 0.02 mm wider.
    const inside = own < Math.min(row.off(onTube(...row.root)), row.off(onTube(...row.face))) - 1e-9;
    scope.same('hole_least', fit.least_mm[i], own, inside ? 0.02 : 1e-7, 'mm', `row ${i}`);
    const next = rows[(i + 1) % rows.length];
    for (let u = 0; u < 1; u += 0.25) {
      const between: Fit = {root: mix(row.root, near(row.root, next.root), u), face: mix(row.face, near(row.face, next.face), u), off: row.off};
      least = Math.min(least, leastOf(between));
      widest = Math.max(widest, row.off(onTube(...between.root)));
    }
  });
  scope.same('hole_least_between', Number(fit.least_between_nodes_mm), least, hole.tilt === 'none' ? 0.02 : 3e-3, 'mm');
  scope.same('hole_root_between', Number(fit.greatest_root_between_nodes_mm), widest, 3e-3, 'mm');
  scope.covers('fit_up/root_mm', 'fit_up/face_mm', 'fit_up/least_mm', 'fit_up/least_between_nodes_mm', 'fit_up/greatest_root_between_nodes_mm');
}

/** What the beam takes from the hole's wall and leaves on it, sampled along straight lines between the rows. */
function checkBeam(scope: Scope, hole: Hole, result: Body, points: Columns): void {
  const stated = result.torch_line as unknown as TorchLine;
  leavePlaces(scope);
  const n = (points.phi_deg as number[]).length;
  const column = (name: string) => points[name] as number[];
  const edge = (rho: number, phi: string, z: string) => column(phi).map((deg, i) => onTube(rho, deg * RAD, column(z)[i]));
  const [O, I] = [edge(hole.outer, 'phi_deg', 'z_mm'), edge(hole.inner, 'phi_inner_deg', 'z_inner_mm')];
  const [TO, TI] = [edge(hole.outer, 'torch_phi_deg', 'torch_z_mm'), edge(hole.inner, 'torch_phi_inner_deg', 'torch_z_inner_mm')];
  const at = (list: V3[], i: number) => list[((i % n) + n) % n];
  const between = (list: V3[], i: number, u: number) => mix(at(list, i), at(list, i + 1), u);
  const far = 2 * hole.kerf + 0.5 + 2 * Math.max(...TO.map((p, k) => norm(sub(p, at(TO, k + 1)))));
  if (hole.kerf === 0) {
    scope.most('hole_gouge_stated', Math.max(Math.abs(stated.gouge_mm), Math.abs(stated.left_mm)), 1e-9, 'mm');
    scope.covers('torch_line/gouge_mm', 'torch_line/left_mm');
    return;
  }
  let [gouge, left] = [0, 0];
  for (let i = 0; i < n; i += 1)
    for (const u of [0, 0.25, 0.5, 0.75])
      for (const v of [0, 0.5, 1]) {
        const p = mix(between(I, i, u), between(O, i, u), v);
        const off = (k: number, s: number) => lineDistance(p, between(TI, k, s), unit(sub(between(TO, k, s), between(TI, k, s))));
        let nearest = Infinity;
        for (let k = 0; k < n; k += 1) {
          if (Math.min(norm(sub(p, at(TO, k))), norm(sub(p, at(TI, k)))) > far + hole.outer - hole.inner) continue;
          const reach = norm(sub(at(TO, k), at(TO, k + 1))) + norm(sub(at(TI, k), at(TI, k + 1)));
          if (off(k, 0.5) - reach > hole.kerf / 2 + 0.5 || off(k, 0.5) - reach > nearest) continue;
          nearest = Math.min(nearest, -highest((s) => -off(k, s), 0, 1, 2, 1e-2)[1]);
        }
        gouge = Math.max(gouge, hole.kerf / 2 - nearest);
        left = Math.max(left, nearest - hole.kerf / 2);
      }
  scope.most('hole_gouge', gouge, 0.0125, 'mm');
  scope.same('hole_gouge_stated', stated.gouge_mm, gouge, 4e-3, 'mm');
  scope.same('hole_left_stated', stated.left_mm, left, 6e-3 + 0.02 * left, 'mm');
  scope.covers('torch_line/gouge_mm', 'torch_line/left_mm');
}

/** The branch's own end, of which the chord with the gap is the one partner. */
export function checkBranchEnd(scope: Scope, hole: Hole, branch: Body): void {
  const {a, s} = hole.placement;
  const cutter = branch.cutter as {[name: string]: number};
  const R = hole.kind === 'set_in' ? hole.outer - hole.depth : hole.outer + hole.gap;
  scope.same('branch_cutter', cutter.outer_diameter_mm, 2 * R, 3e-10, 'mm');
  scope.same('branch_cutter', cutter.inclination_deg * RAD, a, 1e-11, 'rad');
  for (const [name, value] of [
    ['clocking_deg', 0],
    ['offset_mm', s],
    ['height_mm', 0],
  ] as const)
    scope.same('branch_cutter', cutter[name], value, 3e-10, '', name);
  const points = branch.points as unknown as Columns;
  const [Q, E] = axisOf(cutter as unknown as Body);
  const t = hole.branchOuter - hole.branchInner;
  (points.phi_deg as number[]).forEach((deg, i) => {
    const phi = deg * RAD;
    const at = (name: string) => (points[name] as number[])[i];
    const where = `row ${i}`;
    const own = endBy(hole, phi);
    scope.same('branch_root', lineDistance(onTube(hole.branchInner, phi, at('z_inner_mm')), Q, E), R, 3e-10 * (1 + R / 100), 'mm', where);
    scope.same('branch_edges', at('z_outer_mm') - at('z_inner_mm'), t * Math.tan(at('b_deg') * RAD), 3e-10 * (1 + Math.abs(Math.tan(own.b))), 'mm', where);
    scope.same('branch_b', at('b_deg'), own.b / RAD, 4e-9, 'deg', where);
  });
  scope.covers(...Object.keys(points).map((name) => `points/${name}`), ...Object.keys(cutter).map((name) => `cutter/${name}`));
}

export function checkHoles(scope: Scope, request: Body, result: Body, sizes: ReadonlyMap<string, Size>): void {
  const hole = holeOf(request, sizeOf(request.chord as Body, sizes), sizes);
  for (const made of result.holes as Body[]) checkHole(scope.under('holes/*'), hole, made);
  if (result.branch) checkBranchEnd(scope.under('branch'), hole, result.branch as Body);
}
