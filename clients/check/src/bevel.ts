/** One cut end: its columns row by row against the partners, in the frame of the end (docs/theory/intersections-and-bevels.md). */
import type {Body} from './solids.js';
import type {Solid} from './solids.js';
import type {Scope} from './report.js';
import {highest, onTube, RAD, type V3} from './space.js';

export type Columns = {[name: string]: number[] | undefined};

export interface Cut {
  inner: number; // radii of the target
  outer: number;
  partners: Solid[]; // grown by coating and root gap
  root: 'inner' | 'outer';
  contact: string;
  groove: Body;
  dihedral: string;
  face: number; // height of the land
  kerf: number;
  torch: {min: number; max: number};
  untilted: boolean; // a head that stays at B = 0
  smoothing: Body;
  metal?: Solid[]; // the partners without gap and coating
  setIn?: ReadonlySet<number>; // partners that the end is set into: flush, without groove
}

export const rootRadius = (cut: Cut) => (cut.root === 'inner' ? cut.inner : cut.outer);

/** The highest partner over a place of the target's surface, and its height. */
export function envelope(cut: Cut, rho: number, phi: number): {z: number; by: number} {
  let [z, by] = [-Infinity, -1];
  cut.partners.forEach((partner, i) => {
    const top = partner.top(rho * Math.cos(phi), rho * Math.sin(phi));
    if (top !== undefined && top > z) [z, by] = [top, i];
  });
  return {z, by};
}

/** Whether the outside passes all partners somewhere. */
export const isOpen = (cut: Cut) => Array.from({length: 720}, (_, i) => envelope(cut, cut.outer, (i * Math.PI) / 360).by).includes(-1);

/** How much the highest partner lies above z at most; at a jump, where it is lost, on the lower side. */
export function above(cut: Cut, rho: number, phi: number, z: number, jumps: number[]): number {
  const near = jumps.some((jump) => Math.abs(Math.sin((jump - phi) / 2)) < 1e-9);
  return (near ? Math.min(envelope(cut, rho, phi - 1e-8).z, envelope(cut, rho, phi + 1e-8).z) - 1e-2 : envelope(cut, rho, phi).z) - z;
}

/** A normal by its parts along the radius, the girth and the axis. */
export function local(n: V3, phi: number): V3 {
  const [c, s] = [Math.cos(phi), Math.sin(phi)];
  return [n[0] * c + n[1] * s, n[1] * c - n[0] * s, n[2]];
}

export interface Angles {
  psi: number;
  gamma: number;
  flush: number;
}

export function anglesOf([r, p, z]: V3): Angles {
  return {psi: Math.atan2(Math.hypot(p, z), -r), gamma: Math.atan2(p, z), flush: Math.atan2(-r, z)};
}

/** B of a groove in the normal section, seen in the axial plane: the plane of the tangent and the bevel line meets it there. */
export const axialB = (groove: number, n: V3): number => {
  const {psi} = anglesOf(n);
  const tau = Math.PI / 2 - psi + groove;
  return Math.atan2(Math.sin(tau) * Math.sin(psi), Math.cos(tau) * n[2]);
};

interface Zone {
  id: string;
  dihedral_deg: [number, number];
  groove_deg: [number, number];
  root_gap_mm?: number;
}

/** Groove angle and root gap of a table of zones at a dihedral, in degrees, and the zone's name. */
export function zoneAt(groove: Body, psi: number): {groove: number; gap: number; zone: string} | undefined {
  const zones = (groove.zones as unknown as Zone[]).slice().sort((a, b) => a.dihedral_deg[0] - b.dihedral_deg[0]);
  const half = ((groove.overlap_deg as number | undefined) ?? 0) / 2;
  const held = (zone: Zone) => {
    const [[from, to], [first, second]] = [zone.dihedral_deg, zone.groove_deg];
    const t = to > from ? Math.min(1, Math.max(0, (psi - from) / (to - from))) : 0;
    return first + t * (second - first);
  };
  for (let i = 0; i + 1 < zones.length; i += 1) {
    const [below, above] = [zones[i], zones[i + 1]];
    const [from, to] = [above.dihedral_deg[0] - half, below.dihedral_deg[1] + half];
    if (to <= from || psi < from || psi > to) continue;
    const w = (psi - from) / (to - from);
    const gap = (1 - w) * (below.root_gap_mm ?? 0) + w * (above.root_gap_mm ?? 0);
    return {groove: (1 - w) * held(below) + w * held(above), gap, zone: w > 0.5 ? above.id : below.id};
  }
  const zone = zones.find(({dihedral_deg: [from, to]}) => psi >= from - 1e-9 && psi <= to + 1e-9);
  return zone && {groove: held(zone), gap: zone.root_gap_mm ?? 0, zone: zone.id};
}

/** The groove angle that the rule wants at the dihedral, both in radians; of `square` there is B only. */
export function grooveOf(groove: Body, psi: number): number | undefined {
  switch (groove.rule) {
    case 'half_dihedral':
      return Math.min(psi / 2, ((groove.cap_deg as number | undefined) ?? 45) * RAD);
    case 'fixed':
      return (groove.angle_deg as number) * RAD;
    case 'none':
      return 0;
    case 'zones': {
      const found = zoneAt(groove, psi / RAD);
      return found && found.groove * RAD;
    }
    default:
      return undefined;
  }
}

/** The least B with which a straight cut from (rho, z) enters no partner up to radius `to`: along the partner it starts on, else the steepest line to a section. */
export function required(cut: Cut, phi: number, rho: number, z: number, to: number): number {
  let steepest = -Math.PI / 2;
  const [c, s] = [Math.cos(phi), Math.sin(phi)];
  for (const partner of cut.partners) {
    const start = partner.top(rho * c, rho * s);
    if (start !== undefined && Math.abs(start - z) < 1e-9 * (1 + Math.abs(z))) {
      steepest = Math.max(steepest, anglesOf(local(partner.normal(onTube(rho, phi, start)), phi)).flush);
      if (partner.convex) continue;
    }
    const slope = (at: number) => {
      const top = partner.top(at * c, at * s);
      return top === undefined ? -Math.PI / 2 : Math.atan2(top - z, at - rho);
    };
    const [, value] = highest(slope, rho + 1e-6 * (to - rho), to, 64);
    steepest = Math.max(steepest, value);
  }
  return steepest;
}

const angle = 3e-9; // deg: answers state 1e-9
const place = (cut: Cut, z: number) => 3e-13 * (cut.outer + Math.abs(z)) + 2e-11;

/** Every row by itself: root, angles, groove, B, edges, torch and rates. */
export function checkRows(scope: Scope, cut: Cut, rows: Columns, zones: string[] | undefined, [jumps, anyJumps]: [number[], number[]]): void {
  const col = (name: string) => rows[name] as number[];
  const rho = rootRadius(cut);
  const t = cut.outer - cut.inner;
  const has = (...names: string[]) => names.every((name) => rows[name] !== undefined);
  if (!has('phi_deg', 'cutter', 'z_inner_mm', 'z_outer_mm', 'b_deg')) {
    scope.not('points', 'columns are left out');
    return;
  }
  const face = rows.z_face_mm && cut.face > 0 ? cut.face : 0;
  const weldSide = cut.dihedral === 'weld_side';
  for (let i = 0; i < col('phi_deg').length; i += 1) {
    const at = (name: string) => col(name)[i];
    const phi = at('phi_deg') * RAD;
    const [zi, zo, b] = [at('z_inner_mm'), at('z_outer_mm'), at('b_deg') * RAD];
    const where = `row ${i}`;
    const fine = place(cut, Math.max(Math.abs(zi), Math.abs(zo)));
    const steep = Math.abs(Math.tan(b));
    if (has('developed_mm')) scope.most('developed', Math.abs(at('developed_mm') - rho * phi), 1e-10 + 1e-13 * rho * 7, 'mm', where);
    // The wall between the edges runs at B, from the land's outer edge if there is one.
    const from = face ? at('z_face_mm') : zi;
    scope.same('edges_at_b', zo - from, (t - face) * Math.tan(b), fine * (1 + steep), 'mm', where);
    if (face) scope.same('land_at_b_face', at('z_face_mm') - zi, face * Math.tan(at('b_face_deg') * RAD), fine, 'mm', where);
    if (has('beam_mm')) scope.same('beam', at('beam_mm'), t / Math.cos(b), fine, 'mm', where);
    if (has('torch_inner_mm', 'torch_outer_mm')) {
      scope.same('torch_at_b', at('torch_outer_mm') - at('torch_inner_mm'), t * Math.tan(b), fine * (1 + steep), 'mm', where);
      const drop = zo - at('torch_outer_mm');
      if (cut.kerf === 0) scope.same('torch_on_edge', drop, 0, fine, 'mm', where);
      else scope.most('torch_clears_edge', cut.kerf / 2 / Math.cos(b) - drop, 1e-9 + 1e-12 * Math.abs(zo), 'mm', where);
    }
    scope.most('torch_range', Math.max(cut.torch.min - b / RAD, b / RAD - cut.torch.max), 1e-9, 'deg', where);
    // Where the root's generator leaves the partners.
    const by = at('cutter');
    const partner = cut.partners[by];
    if (cut.partners.length) scope.most('active_partner', partner ? 0 : NaN, 1e-7 * (1 + rho / 10), 'mm', where);
    if (!partner) continue;
    const own = partner.top(rho * Math.cos(phi), rho * Math.sin(phi));
    scope.most('active_partner', own === undefined ? 0 : above(cut, rho, phi, own, jumps), 1e-7 * (1 + rho / 10), 'mm', where);
    if (own === undefined) continue;
    const zRoot = cut.root === 'inner' ? zi : zo;
    const n = local(partner.normal(onTube(rho, phi, own)), phi);
    const {psi, gamma, flush} = anglesOf(n);
    const touching = cut.contact === 'inner' || cut.contact === 'none';
    if (touching && (cut.contact === 'none' || cut.root === 'inner')) {
      scope.most('root_on_partner', Math.abs(zRoot - own) * n[2], fine, 'mm', where);
    }
    for (const [edge, radius, z] of [
      ['inner', cut.inner, zi],
      ['outer', cut.outer, zo],
    ] as const) {
      if (cut.contact === 'none') continue;
      const least = Math.min(...cut.partners.map((other) => other.distance(onTube(radius, phi, z))));
      scope.most(`${edge}_edge_clear`, -least, 1e-7, 'mm', where);
    }
    if (!weldSide) continue;
    const grazing = (1e-14 * (cut.outer + Math.abs(own))) / Math.max(n[2], 1e-9); // the root's own rounding, where the generator only touches
    const loose = angle + 1e-12 / Math.max(Math.abs(Math.sin(psi)), 1e-3) / RAD + grazing / RAD;
    if (has('dihedral_deg')) scope.same('dihedral', at('dihedral_deg'), psi / RAD, loose, 'deg', where);
    if (has('gamma_deg')) scope.same('gamma', at('gamma_deg'), gamma / RAD, loose + 1e-11 / Math.max(Math.hypot(n[1], n[2]), 1e-9), 'deg', where);
    if (has('flush_deg')) scope.same('flush', at('flush_deg'), flush / RAD, loose + 1e-11 / Math.max(Math.hypot(n[0], n[2]), 1e-9), 'deg', where);
    for (const [name, rate] of [
      ['dz_per_branch_mm', -n[0] / n[2]],
      ['dz_per_chord_mm', partner.rate === undefined ? undefined : partner.rate / n[2]],
    ] as const) {
      const found = rows[name]?.[i];
      if (found === undefined || found === null || rate === undefined) continue;
      scope.same(name.replace('_mm', ''), found, rate, 2e-10 + 1e-12 * (1 + Math.abs(rate) / n[2] ** 2) + grazing / n[2] ** 2, '', where);
    }
    if (!has('groove_deg', 'tau_deg', 'b_raw_deg')) continue;
    scope.same('tau', at('tau_deg'), 90 - psi / RAD + at('groove_deg'), loose, 'deg', where);
    const wanted = cut.setIn?.has(by) && cut.groove.rule !== 'square' ? 0 : grooveOf(cut.groove, psi);
    if (wanted !== undefined) scope.same('groove', at('groove_deg'), wanted / RAD, loose, 'deg', where);
    if (zones && cut.groove.rule === 'zones') {
      const {zone} = zoneAt(cut.groove, psi / RAD) ?? {zone: ''};
      scope.equal('zone', zones[i], zone, where);
    }
    const rule = wanted === undefined ? 0 : axialB(wanted, n) / RAD;
    scope.same('b_rule', at('b_raw_deg'), Math.min(cut.torch.max, Math.max(cut.torch.min, rule)), loose * (1 + 1 / Math.max(n[2], 1e-6)), 'deg', where);
    if (has('b_required_deg') && !jumps.some((jump) => Math.abs(Math.sin((jump - phi) / 2)) < 1e-9)) {
      const needs = (at: number, z: number) => (face ? required(cut, at, cut.inner + face, z, cut.outer) : required(cut, at, rho, own, cut.outer)) / RAD;
      const stated = at('b_required_deg');
      // Where a partner is lost on the other surface, rounding decides whether it counts.
      const lost = anyJumps.some((jump) => Math.abs(Math.sin((jump - phi) / 2)) < 1e-9);
      const sides = (lost ? [phi - 1e-9, phi + 1e-9] : [phi]).map((side) => needs(side, face ? at('z_face_mm') : own));
      const need = sides.reduce((best, one) => (Math.abs(one - stated) < Math.abs(best - stated) ? one : best));
      const loosely = (cut.partners.every(({convex}) => convex) ? 5e-9 : 5e-6) + grazing / RAD + 1e-11 / Math.max(Math.hypot(n[0], n[2]), 1e-9);
      scope.same('b_required', stated, need, lost ? 0.05 : loosely, 'deg', where);
    }
    if (has('gap_mm')) {
      scope.same('root_gap', at('gap_mm'), zRoot - own, 2e-10 + 1e-12 * Math.abs(own) + 10 * grazing, 'mm', where);
    }
  }
  scope.covers(
    ...['phi_deg', 'cutter', 'z_inner_mm', 'z_outer_mm', 'b_deg', 'developed_mm', 'beam_mm', 'torch_inner_mm', 'torch_outer_mm'].map((n) => `points/${n}`),
  );
  if (face) scope.covers('points/z_face_mm', 'points/b_face_deg');
  if (weldSide) {
    scope.covers(
      ...[
        'dihedral_deg',
        'gamma_deg',
        'flush_deg',
        'dz_per_branch_mm',
        'dz_per_chord_mm',
        'groove_deg',
        'tau_deg',
        'b_raw_deg',
        'b_required_deg',
        'gap_mm',
        'zone',
      ].map((n) => `points/${n}`),
    );
  }
}
