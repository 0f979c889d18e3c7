/** One cut end of a tube that is not round, row by row in its own frame (docs/theory/sections.md, sections 2 to 5). */
import {type Columns, type Cut, grooveOf, zoneAt} from './bevel.js';
import {girth, girthAt, outOf, seams, type Station, walk, wallAt} from './outline.js';
import type {Scope} from './report.js';
import {aboveAt, apart, checkEvents, checkStation, envelopeAt, type Event, jumpsOf, lengthOf, type SectionCut} from './section_curves.js';
import {checkMutations, checkSmoothing} from './smoothing.js';
import type {Body} from './solids.js';
import {cross, dot, highest, mul, norm, RAD, sub, UP, type V3} from './space.js';
import {type Knowledge, machineOf} from './tables.js';

/** A row of the table: the place outside, the metal behind it, the edges from the bore outwards. */
export interface Row {
  s: number;
  at: Station;
  wall: number;
  edges: [number, number][]; // metal from the bore, and z
  torch: [number, number]; // z of the beam's axis at the bore and outside
}

export const pointAt = ({at, wall}: Row, w: number): [number, number] => [at.x - (wall - w) * at.normal[0], at.y - (wall - w) * at.normal[1]];

export function rowsOfSection({cut, outer, bore}: SectionCut, columns: Columns): Row[] {
  const col = (name: string) => columns[name] as number[];
  return col('girth_mm').map((s, i): Row => {
    const at = walk(outer, s);
    const wall = wallAt(bore, at);
    const edges: [number, number][] = [[0, col('z_inner_mm')[i]]];
    if (columns.z_face_mm && cut.face > 0) edges.push([cut.face, col('z_face_mm')[i]]);
    edges.push([wall, col('z_outer_mm')[i]]);
    return {s, at, wall, edges, torch: [col('torch_inner_mm')[i], col('torch_outer_mm')[i]]};
  });
}

/** The row at a share of the way from row i to the next: its edges and the beam's axis run straight there. */
export function between({outer, bore}: SectionCut, rows: Row[], i: number, u: number): Row {
  const [a, b] = [rows[i], rows[(i + 1) % rows.length]];
  const span = i + 1 < rows.length ? b.s - a.s : b.s + girth(outer) - a.s;
  const s = a.s + u * span;
  const at = walk(outer, s);
  const wall = wallAt(bore, at);
  const mix = (p: number, q: number) => p + u * (q - p);
  const last = a.edges.length - 1;
  return {
    s,
    at,
    wall,
    edges: a.edges.map(([w, z], k): [number, number] => [k === last ? wall : w, mix(z, b.edges[k][1])]),
    torch: [mix(a.torch[0], b.torch[0]), mix(a.torch[1], b.torch[1])],
  };
}

/** Height of the finished wall, so much metal from the bore. */
export function heightAt({edges}: Row, w: number): number {
  const k = Math.max(
    0,
    Math.min(
      edges.length - 2,
      edges.slice(1).findIndex(([to]) => w <= to + 1e-12),
    ),
  );
  const [[w0, z0], [w1, z1]] = [edges[k], edges[k + 1]];
  return z0 + ((w - w0) / (w1 - w0)) * (z1 - z0);
}

/** The least B of a straight cut from `from` metal off the bore at height z that enters no partner further out. */
function steepest(cut: Cut, row: Row, from: number, z: number): number {
  let most = -Math.PI / 2;
  for (const partner of cut.partners) {
    const [x, y] = pointAt(row, from);
    const start = partner.top(x, y);
    if (start !== undefined && Math.abs(start - z) < 1e-9 * (1 + Math.abs(z))) {
      const n = partner.normal([x, y, start]);
      most = Math.max(most, Math.atan2(-dot(n, row.at.normal), n[2]));
      if (partner.convex) continue;
    }
    const slope = (w: number) => {
      const top = partner.top(...pointAt(row, w));
      return top === undefined ? -Math.PI / 2 : Math.atan2(top - z, w - from);
    };
    most = Math.max(most, highest(slope, from + 1e-6 * (row.wall - from), row.wall, 64)[1]);
  }
  return most;
}

/** The angles of a partner's surface at the root, whose outline has its own normal there, and B of a groove by the bevel's normal. */
function anglesAt(n: V3, normal: V3, own: V3): {psi: number; gamma: number; flush: number; bOf: (groove: number) => number} {
  const line = cross(n, own);
  const t = norm(line) > 0 ? mul(line, 1 / norm(line)) : line;
  const g = cross(t, n);
  return {
    psi: Math.atan2(norm(cross(n, normal)), -dot(n, normal)),
    gamma: Math.atan2(dot(n, cross(UP, own)), n[2]),
    flush: Math.atan2(-dot(n, normal), n[2]),
    bOf: (groove) => {
      const m = sub(mul(n, Math.cos(groove)), mul(g, Math.sin(groove)));
      return Math.atan2(-dot(m, normal), m[2]);
    },
  };
}

const listed = ['girth_mm', 'normal_deg', 'face', 'on_corner', 'wall_mm', 'cutter', 'z_inner_mm', 'z_outer_mm', 'b_deg', 'torch_inner_mm', 'torch_outer_mm'];
const reckoned = ['dihedral_deg', 'gamma_deg', 'flush_deg', 'groove_deg', 'b_raw_deg', 'b_required_deg', 'gap_mm', 'zone', 'developed_mm', 'beam_mm', 'corner'];

/** A table in its end's own frame, whole. */
export function checkSectionEnd(scope: Scope, whole: SectionCut, result: Body, know: Knowledge): void {
  const columns = result.points as unknown as Columns;
  if (!listed.every((name) => columns[name])) {
    scope.not('points', 'columns are left out');
    return;
  }
  const {cut, outer, bore} = whole;
  const events = (result.events ?? []) as unknown as Event[];
  const rows = rowsOfSection(whole, columns);
  const rules = checkRows(scope, whole, rows, result, events);
  for (const [surface, of] of [
    ['inner', bore],
    ['outer', outer],
  ] as const)
    if (cut.partners.length) checkEvents(scope, cut, of, events, surface);
  checkLengths(scope, whole, rows, columns, result, events);
  const turned = {...columns, phi_deg: columns.girth_mm};
  const steps = ((result.mutations ?? []) as Body[]).map((step) => ({...step, phi_deg: step.girth_mm}));
  const asRound = {...result, mutations: steps} as unknown as Body;
  checkSmoothing(scope, cut, turned, asRound, machineOf((cut.smoothing.limits as Body | undefined)?.machine, know));
  checkMutations(scope, cut, turned, asRound);
  scope.covers('mutations/*/girth_mm');
  checkBinds(scope, cut, rows, columns, rules, (result.torch_binds ?? []) as Body[]);
  checkPenetration(scope, whole, rows, result.penetration as unknown as {[name: string]: number});
  checkGouge(scope, whole, rows, result.torch_line as unknown as {[name: string]: number});
  checkGaps(scope, cut, rows, columns, result.tube_laser as Body | undefined);
}

/** Every row by itself; returns B of the rule before the torch's range. */
function checkRows(scope: Scope, {cut, outer, bore}: SectionCut, rows: Row[], result: Body, events: Event[]): (number | undefined)[] {
  const points = result.points as unknown as {[name: string]: number[]} & {on_corner: boolean[]; corner?: boolean[]; zone?: string[]};
  const [whole, inside] = [girth(outer), girth(bore)];
  const rootOutside = cut.root === 'outer';
  const jumps = {inner: jumpsOf(events, 'inner'), outer: jumpsOf(events, 'outer')};
  const face = points.z_face_mm && cut.face > 0 ? cut.face : 0;
  const touching = cut.contact === 'inner' || cut.contact === 'none';
  const has = (name: string) => points[name] !== undefined;
  return rows.map((row, i): number | undefined => {
    const at = (name: string) => points[name][i];
    const where = `row ${i}`;
    const {wall} = row;
    const [zi, zo, b] = [at('z_inner_mm'), at('z_outer_mm'), at('b_deg') * RAD];
    const fine = 3e-13 * (outer.a + outer.b + Math.max(Math.abs(zi), Math.abs(zo))) + 5e-11;
    const steep = 1 + Math.abs(Math.tan(b));
    checkStation(scope, outer, row.s, points, i);
    scope.same('wall', at('wall_mm'), wall, 1e-10, 'mm', where);
    if (has('developed_mm')) scope.same('developed', at('developed_mm'), row.s * (rootOutside ? 1 : inside / whole), 2e-10, 'mm', where);
    const from = face ? at('z_face_mm') : zi;
    scope.same('edges_at_b', zo - from, (wall - face) * Math.tan(b), 3 * fine * steep, 'mm', where);
    if (face) scope.same('land_at_b_face', from - zi, face * Math.tan(at('b_face_deg') * RAD), 3 * fine, 'mm', where);
    if (has('beam_mm')) scope.same('beam', at('beam_mm'), wall / Math.cos(b), 3 * fine * steep, 'mm', where);
    scope.same('torch_at_b', row.torch[1] - row.torch[0], wall * Math.tan(b), 3 * fine * steep, 'mm', where);
    const drop = zo - row.torch[1];
    if (cut.kerf === 0) scope.same('torch_on_edge', drop, 0, fine, 'mm', where);
    else scope.most('torch_clears_edge', cut.kerf / 2 / Math.cos(b) - drop, 1e-9 + 1e-12 * Math.abs(zo), 'mm', where);
    scope.most('torch_range', Math.max(cut.torch.min - b / RAD, b / RAD - cut.torch.max), 1e-9, 'deg', where);
    if (cut.partners.length === 0) return undefined;
    const by = at('cutter');
    const partner = cut.partners[by];
    const [x, y] = rootOutside ? [row.at.x, row.at.y] : pointAt(row, 0);
    const own = partner?.top(x, y);
    scope.most('active_partner', own === undefined ? (partner ? 0 : NaN) : 0, 0, '', where);
    if (!partner || own === undefined) return undefined;
    const of = rootOutside ? outer : bore;
    const s = girthAt(of, x, y);
    const lost = jumps[cut.root];
    scope.most('active_partner', aboveAt(cut, of, s, own, lost), 1e-7 * (1 + (outer.a + outer.b) / 10), 'mm', where);
    const n = partner.normal([x, y, own]);
    const zRoot = rootOutside ? zo : zi;
    if (touching && (cut.contact === 'none' || !rootOutside)) scope.most('root_on_partner', Math.abs(zRoot - own) * n[2], 3 * fine, 'mm', where);
    if (cut.contact !== 'none')
      for (const [edge, place] of [
        ['inner', [...pointAt(row, 0), zi]],
        ['outer', [...pointAt(row, wall), zo]],
      ] as [string, V3][])
        scope.most(`${edge}_edge_clear`, -Math.min(...cut.partners.map((other) => other.distance(place))), 1e-7, 'mm', where);
    const {psi, gamma, flush, bOf} = anglesAt(n, row.at.normal, rootOutside ? row.at.normal : outOf(bore, x, y).normal);
    const grazing = (1e-13 * (outer.a + outer.b + Math.abs(own))) / Math.max(n[2], 1e-9);
    const loose = 3e-9 + 1e-12 / Math.max(Math.abs(Math.sin(psi)), 1e-3) / RAD + grazing / RAD;
    const atSeam = [...seams(of)].some((seam) => apart(seam, s, girth(of)) < 1e-7); // the side whose normal counts is not told
    if (has('dihedral_deg')) scope.same('dihedral', at('dihedral_deg'), psi / RAD, loose, 'deg', where);
    if (has('flush_deg'))
      scope.same('flush', at('flush_deg'), flush / RAD, loose + 1e-11 / Math.max(Math.hypot(dot(n, row.at.normal), n[2]), 1e-9), 'deg', where);
    if (has('gamma_deg') && Math.sin(psi) > 1e-6 && !atSeam)
      scope.same('gamma', at('gamma_deg'), gamma / RAD, loose + 1e-11 / Math.max(Math.abs(n[2]), 1e-9), 'deg', where);
    if (has('gap_mm')) scope.same('root_gap', at('gap_mm'), zRoot - own, 5e-10 + 1e-12 * Math.abs(own) + 10 * grazing, 'mm', where);
    if (!has('groove_deg') || !has('b_raw_deg')) return undefined;
    const wanted = cut.setIn?.has(by) && cut.groove.rule !== 'square' ? 0 : grooveOf(cut.groove, psi);
    if (wanted !== undefined) scope.same('groove', at('groove_deg'), wanted / RAD, loose, 'deg', where);
    if (points.zone && cut.groove.rule === 'zones') scope.equal('zone', points.zone[i], zoneAt(cut.groove, psi / RAD)?.zone ?? '', where);
    const rule = wanted === undefined ? 0 : bOf(wanted) / RAD;
    const clamped = Math.min(cut.torch.max, Math.max(cut.torch.min, rule));
    if (!atSeam || cut.groove.rule === 'square') scope.same('b_rule', at('b_raw_deg'), clamped, loose * (1 + 1 / Math.max(n[2], 1e-6)), 'deg', where);
    const anyJump = lost.some((jump) => apart(jump, s, girth(of)) < 1e-6);
    if (has('b_required_deg') && !rootOutside && !anyJump) {
      const need = steepest(cut, row, face, face ? at('z_face_mm') : own) / RAD;
      scope.same('b_required', at('b_required_deg'), need, (cut.partners.every(({convex}) => convex) ? 5e-9 : 1e-6) + grazing / RAD, 'deg', where);
    }
    return rule;
  });
}

function checkLengths(scope: Scope, {cut, outer, bore}: SectionCut, rows: Row[], columns: Columns, result: Body, events: Event[]): void {
  const of = cut.root === 'outer' ? outer : bore;
  const places = rows.map((row) => (cut.root === 'outer' ? row.s : girthAt(of, ...pointAt(row, 0))));
  const length = columns.length_mm;
  const whole = result.length_mm as number;
  const jumps = jumpsOf(events, cut.root);
  let total = 0;
  places.forEach((s, i) => {
    const last = i + 1 === places.length;
    const way = (last ? places[0] : places[i + 1]) - s;
    const to = s + (way < -1e-9 ? way + girth(of) : Math.max(0, way));
    const own = lengthOf(cut, of, s, to, events, cut.root);
    total += own;
    if (!length) return;
    const stated = last ? whole - length[i] + length[0] : length[i + 1] - length[i];
    const steep = jumps.length > 0;
    scope.same('length', stated, own, (steep ? 1e-4 : 1e-7) + (steep ? 1e-5 : 1e-8) * own, 'mm', `row ${i}`);
  });
  scope.same('developed_length', result.developed_length_mm as number, girth(of), 1e-12 * (1 + girth(of)), 'mm');
  scope.same('length_of_all', whole, total, 1e-6 + 1e-8 * total + 1e-4 * jumps.length, 'mm');
  scope.covers('length_mm', 'developed_length_mm', ...(length ? ['points/length_mm'] : []), ...[...listed, ...reckoned].map((name) => `points/${name}`));
  if (columns.z_face_mm && cut.face > 0) scope.covers('points/z_face_mm', 'points/b_face_deg');
}

function checkBinds(scope: Scope, cut: Cut, rows: Row[], columns: Columns, rules: (number | undefined)[], binds: Body[]): void {
  const [raw, gap, required] = [columns.b_raw_deg, columns.gap_mm, columns.b_required_deg];
  if (!raw || !gap || !binds.length) return;
  const whole = rows.length ? Math.max(...rows.map(({s}) => s)) + 1 : 0;
  for (const bind of binds) {
    const [from, to] = [bind.from_girth_mm as number, bind.to_girth_mm as number];
    const inside = rows.flatMap(({s}, i) => (s >= from - 1e-9 && s <= to + 1e-9 ? [i] : []));
    if (to > whole || !inside.length) {
      scope.not('torch_binds', 'across the datum');
      return;
    }
    for (const end of [from, to]) scope.most('torch_binds_girth', Math.min(...rows.map(({s}) => Math.abs(s - end))), 3e-10, 'mm', `girth ${end}`);
    const lifted = cut.contact === 'auto' && cut.groove.rule !== 'square' && required;
    const lost = inside.map((i) => Math.max(Math.abs((rules[i] ?? raw[i]) - raw[i]), lifted ? required[i] - cut.torch.max : 0));
    scope.same('torch_binds_gap', bind.root_gap_mm as number, Math.max(...inside.map((i) => gap[i])), 3e-10, 'mm', `girth ${from}`);
    scope.same('torch_binds_groove', bind.groove_lost_deg as number, Math.max(0, ...lost), 3e-9, 'deg', `girth ${from}`);
  }
  scope.covers(...['from_girth_mm', 'to_girth_mm', 'root_gap_mm', 'groove_lost_deg'].map((name) => `torch_binds/*/${name}`));
}

/** The stated place lies on the wall and as deep as stated, and no place that is looked at lies deeper. */
function checkPenetration(scope: Scope, whole: SectionCut, rows: Row[], stated: {[name: string]: number}): void {
  const {cut, outer, bore} = whole;
  if (cut.partners.length === 0) {
    scope.most('penetration_stated', Math.abs(stated.depth_mm), 0, 'mm');
    scope.covers('penetration/depth_mm');
    return;
  }
  const depth = (row: Row, w: number) => -Math.min(...cut.partners.map((partner) => partner.distance([...pointAt(row, w), heightAt(row, w)])));
  if (stated.depth_mm > 0) {
    const at = walk(outer, stated.girth_mm);
    const place: V3 = [at.x - stated.below_outside_mm * at.normal[0], at.y - stated.below_outside_mm * at.normal[1], stated.z_mm];
    const deep = -(cut.partners[stated.cutter]?.distance(place) ?? NaN);
    scope.same('penetration_stated', stated.depth_mm, deep, 1e-9 * (1 + outer.a + outer.b), 'mm');
    const before = rows.findIndex(({s}) => s > stated.girth_mm + 1e-12);
    const i = (before < 0 ? rows.length : before || rows.length) - 1;
    const span = i + 1 < rows.length ? rows[i + 1].s - rows[i].s : girth(outer) - rows[i].s + rows[0].s;
    const way = (stated.girth_mm - rows[i].s + girth(outer)) % girth(outer);
    const row = between(whole, rows, i, span > 0 ? way / span : 0);
    scope.same('penetration_on_wall', stated.z_mm, heightAt(row, wallAt(bore, at) - stated.below_outside_mm), 1e-8 * (1 + Math.abs(stated.z_mm)), 'mm');
  }
  let deepest = 0;
  rows.forEach((_, i) => {
    for (const u of [0, 0.25, 0.5, 0.75]) {
      const row = between(whole, rows, i, u);
      for (const v of [0, 0.2, 0.5, 0.8, 1]) deepest = Math.max(deepest, depth(row, v * row.wall));
    }
  });
  scope.most('penetration_deepest', deepest - stated.depth_mm, 1e-3, 'mm');
  scope.covers(...['depth_mm', 'girth_mm', 'below_outside_mm', 'z_mm', 'cutter'].map((name) => `penetration/${name}`));
}

/** How deep the beam enters the finished wall, sampled: never more than stated. */
function checkGouge(scope: Scope, whole: SectionCut, rows: Row[], stated: {[name: string]: number}): void {
  const {cut} = whole;
  scope.not('torch_line/gouge_girth_mm', 'one of many places that are nearly alike');
  if (cut.kerf === 0) {
    scope.most('gouge_stated', Math.abs(stated.gouge_mm), 1e-9, 'mm');
    scope.covers('torch_line/gouge_mm');
    return;
  }
  const beams = rows.flatMap((_, i) => [0, 0.25, 0.5, 0.75].map((u) => between(whole, rows, i, u)));
  const toAxis = (place: V3, {at, wall, torch}: Row): number => {
    const d: V3 = [at.normal[0], at.normal[1], (torch[1] - torch[0]) / wall];
    return norm(cross(sub(place, [at.x, at.y, torch[1]]), d)) / norm(d);
  };
  const wide = girth(whole.outer);
  let deepest = 0;
  for (let i = 0; i < beams.length; i += 2) {
    const row = beams[i];
    const near = beams.filter(({s}) => apart(s, row.s, wide) < 1.5 * cut.kerf + 1);
    for (const v of [0, 0.5, 1]) {
      const place: V3 = [...pointAt(row, v * row.wall), heightAt(row, v * row.wall)];
      for (const beam of near) deepest = Math.max(deepest, cut.kerf / 2 - toAxis(place, beam));
    }
  }
  scope.most('gouge_bound', deepest, 0.0125, 'mm');
  scope.most('gouge_stated', deepest - stated.gouge_mm, 1e-3, 'mm');
  scope.covers('torch_line/gouge_mm');
}

/** A head that never tilts: gaps of both edges, those of a flush cut, and its travel. */
function checkGaps(scope: Scope, cut: Cut, rows: Row[], columns: Columns, laser: Body | undefined): void {
  const least = (place: V3) => Math.min(...cut.partners.map((partner) => partner.distance(place)));
  const names = ['gap_inner_mm', 'gap_outer_mm', 'bevelled_gap_inner_mm', 'bevelled_gap_outer_mm'];
  const col = (name: string) => columns[name] as number[];
  if (names.every((name) => columns[name]) && cut.partners.length) {
    rows.forEach((row, i) => {
      const {z} = envelopeAt(cut.partners, ...pointAt(row, 0));
      const flush = z + row.wall * Math.tan(Math.max(-85 * RAD, steepest(cut, row, 0, z)));
      const own = [
        least([...pointAt(row, 0), col('z_inner_mm')[i]]),
        least([...pointAt(row, row.wall), col('z_outer_mm')[i]]),
        least([...pointAt(row, 0), z]),
        least([...pointAt(row, row.wall), flush]),
      ];
      names.forEach((name, k) => scope.same(name.replace('_mm', ''), col(name)[i], own[k], 1e-7, 'mm', `row ${i}`));
    });
    scope.covers(...names.map((name) => `points/${name}`));
  }
  if (!laser) return;
  for (const [name, prefix] of [
    ['gap', 'gap'],
    ['bevelled_gap', 'bevelled_gap'],
  ] as const) {
    const stated = laser[name] as {greatest_mm: number; girth_mm: number; edge: string} | undefined;
    if (!stated || !columns[`${prefix}_inner_mm`]) continue;
    const both = ['inner', 'outer'].map((edge) => Math.max(...col(`${prefix}_${edge}_mm`)));
    scope.same('greatest_gap', stated.greatest_mm, Math.max(...both), 1e-9, 'mm', name);
    const i = rows.findIndex(({s}) => Math.abs(s - stated.girth_mm) < 1e-9);
    scope.same('greatest_gap_at', stated.greatest_mm, i < 0 ? NaN : col(`${prefix}_${stated.edge}_mm`)[i], 1e-9, 'mm', name);
    scope.covers(`tube_laser/${name}/greatest_mm`, `tube_laser/${name}/girth_mm`);
  }
  const z = [...col('z_inner_mm'), ...col('z_outer_mm')];
  scope.same('reach', laser.reach_mm as number, Math.max(...z) - Math.min(...z), 1e-9, 'mm');
  scope.covers('tube_laser/reach_mm');
}
