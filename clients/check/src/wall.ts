/** The finished wall of one end as a machine cuts it, straight from row to row, against partners and the beam's axes. */
import {type Columns, type Cut, anglesOf, envelope, local, required, rootRadius} from './bevel.js';
import type {Scope} from './report.js';
import type {Body} from './solids.js';
import {highest, integral, onTube, RAD, root, type V3} from './space.js';

export interface Event {
  kind: string;
  surface: string;
  phi_deg: number;
  z_from_mm: number;
  z_to_mm: number;
  from: number;
  to: number;
}

/** Where partners are lost on a surface, in radians. */
export const jumpsOf = (events: Event[], surface: string): number[] =>
  events.filter((event) => event.kind === 'jump' && event.surface === surface).map((event) => event.phi_deg * RAD);

interface Row {
  phi: number;
  edges: [number, number][]; // radius and z, from the bore outwards
  torch: [number, number]; // height of the beam's axis at the bore, and its slope across the wall
}

/** Rows of a whole turn; the first one comes once more behind the last. */
export function rowsOf(cut: Cut, columns: Columns): Row[] {
  const col = (name: string) => columns[name] as number[];
  const t = cut.outer - cut.inner;
  const rows = col('phi_deg').map((phi, i): Row => {
    const at = (name: string) => col(name)[i];
    const edges: [number, number][] = [[cut.inner, at('z_inner_mm')]];
    if (columns.z_face_mm && cut.face > 0) edges.push([cut.inner + cut.face, at('z_face_mm')]);
    edges.push([cut.outer, at('z_outer_mm')]);
    return {phi: phi * RAD, edges, torch: [at('torch_inner_mm'), (at('torch_outer_mm') - at('torch_inner_mm')) / t]};
  });
  const first = rows[0];
  return [...rows, {...first, phi: first.phi + 2 * Math.PI}];
}

export interface Place {
  rho: number;
  phi: number;
  z: number;
}

/** The wall at the share `u` of the way from row i to the next, `v` of the way across. */
export function wallAt(rows: Row[], i: number, u: number, v: number): Place {
  const [a, b] = [rows[i], rows[i + 1]];
  const edges = a.edges.map(([rho, z], k): [number, number] => [rho, z + u * (b.edges[k][1] - z)]);
  const from = edges[0][0];
  const rho = from + v * (edges[edges.length - 1][0] - from);
  const k = Math.min(
    edges.length - 2,
    edges.slice(1).findIndex(([r]) => rho <= r + 1e-12),
  );
  const [[r0, z0], [r1, z1]] = [edges[Math.max(k, 0)], edges[Math.max(k, 0) + 1]];
  return {rho, phi: a.phi + u * (b.phi - a.phi), z: z0 + ((rho - r0) / (r1 - r0)) * (z1 - z0)};
}

/** The finished wall's height at (rho, phi). */
export function wallOver(rows: Row[], rho: number, phi: number): number {
  const first = rows[0].phi;
  let turned = (phi - first) % (2 * Math.PI);
  if (turned < -1e-12) turned += 2 * Math.PI;
  const at = first + turned;
  let i = 0;
  while (i + 2 < rows.length && rows[i + 1].phi < at) i += 1;
  const [a, b] = [rows[i], rows[i + 1]];
  const edges = a.edges;
  const [from, to] = [edges[0][0], edges[edges.length - 1][0]];
  return wallAt(rows, i, b.phi > a.phi ? Math.min(1, Math.max(0, (at - a.phi) / (b.phi - a.phi))) : 0, (rho - from) / (to - from)).z;
}

/** How deep a place lies in the partners. */
const depthIn = (cut: Cut, {rho, phi, z}: Place) => -Math.min(...cut.partners.map((partner) => partner.distance(onTube(rho, phi, z))));

export interface Penetration {
  depth_mm: number;
  phi_deg: number;
  radius_mm: number;
  z_mm: number;
  cutter: number;
}

/** The stated place lies on the wall and as deep as stated, and no place that is looked at lies deeper. */
export function checkPenetration(scope: Scope, cut: Cut, rows: Row[], stated: Penetration): void {
  if (cut.partners.length === 0) {
    scope.most('penetration_stated', Math.abs(stated.depth_mm), 0, 'mm');
    scope.covers('penetration/depth_mm');
    return;
  }
  const phi = stated.phi_deg * RAD;
  if (stated.depth_mm > 0) {
    scope.same('penetration_on_wall', stated.z_mm, wallOver(rows, stated.radius_mm, phi), 1e-9 * (1 + Math.abs(stated.z_mm)), 'mm');
    const deep = -(cut.partners[stated.cutter]?.distance(onTube(stated.radius_mm, phi, stated.z_mm)) ?? NaN);
    scope.same('penetration_stated', stated.depth_mm, deep, 1e-9 * (1 + cut.outer), 'mm');
  }
  let deepest = -Infinity;
  for (let i = 0; i + 1 < rows.length; i += 1)
    for (const u of [0, 0.25, 0.5, 0.75]) for (const v of [0, 0.2, 0.5, 0.8, 1]) deepest = Math.max(deepest, depthIn(cut, wallAt(rows, i, u, v)));
  scope.most('penetration_deepest', Math.max(0, deepest) - stated.depth_mm, 1e-3, 'mm');
  scope.covers('penetration/depth_mm', 'penetration/phi_deg', 'penetration/radius_mm', 'penetration/z_mm', 'penetration/cutter');
}

/** From a place to the nearest axis of the beam, which runs through all rows and straight between them. */
function toBeam(cut: Cut, rows: Row[], i: number, place: Place): number {
  const count = rows.length - 1;
  const off = (row: number, u: number): number => {
    const k = ((row % count) + count) % count;
    const [a, b] = [rows[k], rows[k + 1]];
    const [at, slope] = [a.torch[0] + u * (b.torch[0] - a.torch[0]), a.torch[1] + u * (b.torch[1] - a.torch[1])];
    const turned = place.phi - a.phi - u * (b.phi - a.phi);
    const along = place.z - at - slope * (place.rho * Math.cos(turned) - cut.inner);
    return Math.hypot(place.rho * Math.sin(turned), along / Math.hypot(1, slope));
  };
  const window = Math.asin(Math.min(1, (1.5 * cut.kerf) / cut.inner));
  const sections: number[] = [i];
  for (const way of [-1, 1])
    for (let k = i + way; Math.abs(k - i) < count; k += way) {
      const near = rows[((k % count) + count) % count].phi;
      const apart = Math.abs(Math.atan2(Math.sin(near - place.phi), Math.cos(near - place.phi)));
      sections.push(k);
      if (apart > window) break;
    }
  return Math.min(...[...new Set(sections)].map((k) => -highest((u) => -off(k, u), 0, 1, 2, 1e-2)[1]));
}

export interface TorchLine {
  gouge_mm: number;
  gouge_phi_deg: number;
  left_mm: number;
  left_phi_deg: number;
}

export function leavePlaces(scope: Scope): void {
  for (const name of ['gouge_phi_deg', 'left_phi_deg']) scope.not(`torch_line/${name}`, 'one of many places that are nearly alike');
}

/** What the beam takes from the wall and leaves on it, sampled: as stated within 2e-3 mm or 0.8 %, and a share for the samples. */
export function checkTorchLine(scope: Scope, cut: Cut, rows: Row[], stated: TorchLine): void {
  leavePlaces(scope);
  if (cut.kerf === 0) {
    scope.most('gouge_stated', Math.max(Math.abs(stated.gouge_mm), Math.abs(stated.left_mm)), 1e-9, 'mm');
    scope.covers('torch_line/gouge_mm', 'torch_line/left_mm');
    return;
  }
  if (rows.some((row, i) => i > 0 && row.phi - rows[i - 1].phi < 1e-12)) {
    scope.not('torch_line', 'at a jump the wall has a step');
    return;
  }
  const off = (i: number, u: number, v: number) => toBeam(cut, rows, i, wallAt(rows, i, u, v)) - cut.kerf / 2;
  // The land below a bevel is a pass of its own: what is left on it is not counted.
  const bare = cut.face > 0 ? (cut.face + 1e-9) / (cut.outer - cut.inner) : 0;
  type Found = [number, number, number, number]; // value, section, shares along and across
  const better = (now: Found, value: number, i: number, u: number, v: number): Found => (value > now[0] ? [value, i, u, v] : now);
  let [deepest, thickest]: Found[] = [
    [0, 0, 0, 0],
    [0, 0, 0, bare],
  ] as [Found, Found];
  const look = (i: number, u: number, v: number) => {
    const value = off(i, u, v);
    deepest = better(deepest, -value, i, u, v);
    if (v >= bare) thickest = better(thickest, value, i, u, v);
  };
  for (let i = 0; i + 1 < rows.length; i += 1) for (const u of [0, 0.5]) for (const v of [0, 0.5, 1]) look(i, u, v);
  for (const phi of [stated.gouge_phi_deg, stated.left_phi_deg]) {
    const turned = (((phi * RAD - rows[0].phi) % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI);
    let i = 0;
    while (i + 2 < rows.length && rows[i + 1].phi - rows[0].phi < turned) i += 1;
    for (const k of [i - 1, i, i + 1]) if (k >= 0 && k + 1 < rows.length) for (let u = 0; u < 8; u += 1) for (let v = 0; v <= 4; v += 1) look(k, u / 8, v / 4);
  }
  /** Uphill from the best place, by steps that are halved. */
  const climbed = (from: Found, sign: number): number => {
    let best = from;
    for (let step = 0.125; step > 1e-3; step /= 2)
      for (const [du, dv] of [
        [step, 0],
        [-step, 0],
        [0, step],
        [0, -step],
      ] as const) {
        const [u, v] = [Math.min(1, Math.max(0, best[2] + du)), Math.min(1, Math.max(sign > 0 ? bare : 0, best[3] + dv))];
        best = better(best, sign * off(best[1], u, v), best[1], u, v);
      }
    return best[0];
  };
  const [gouge, left] = [climbed(deepest, -1), climbed(thickest, 1)];
  scope.most('gouge_bound', gouge, 0.0125, 'mm');
  scope.same('gouge_stated', stated.gouge_mm, gouge, 4e-3, 'mm');
  scope.same('left_stated', stated.left_mm, left, 6e-3 + 0.08 * left, 'mm');
  scope.covers('torch_line/gouge_mm', 'torch_line/left_mm');
}

/** Where a partner is lost or bent: on both sides the curve has a partner's height, or ends where a lost one's surface runs along the tube. */
export function checkSides(
  scope: Scope,
  cut: Cut,
  event: Pick<Event, 'kind' | 'z_from_mm' | 'z_to_mm' | 'from' | 'to'>,
  height: (by: number) => number | undefined,
  placeAt: (z: number) => V3,
  where: string,
): void {
  for (const [z, by] of [
    [event.z_from_mm, event.from],
    [event.z_to_mm, event.to],
  ] as const) {
    const partner = cut.partners[by];
    const touching = partner ? root((t) => partner.normal(placeAt(t))[2], z - 0.5, z + 0.5) : NaN;
    const heights = [height(by) ?? NaN, touching, event.kind === 'kink' ? z : NaN].filter((found) => !Number.isNaN(found));
    scope.most('event_z', heights.length ? Math.min(...heights.map((found) => Math.abs(found - z))) : NaN, 3e-5, 'mm', where);
  }
}

/** Junctions where two partners are equally high, jumps where one is lost; between them one partner stays the highest. */
export function checkEvents(scope: Scope, cut: Cut, events: Event[], surface: 'inner' | 'outer', whole: boolean): void {
  const rho = surface === 'inner' ? cut.inner : cut.outer;
  const mine = events.filter((event) => event.surface === surface);
  const height = (by: number, phi: number) => cut.partners[by]?.top(rho * Math.cos(phi), rho * Math.sin(phi));
  for (const event of mine) {
    const phi = event.phi_deg * RAD;
    const where = `phi ${event.phi_deg}`;
    if (event.kind === 'junction') {
      const difference = (at: number) => (height(event.from, at) ?? -Infinity) - (height(event.to, at) ?? -Infinity);
      const own = root(difference, phi - 1e-6, phi + 1e-6);
      scope.same('junction_phi', event.phi_deg, own / RAD, 3e-10, 'deg', where);
      scope.same('junction_z', event.z_from_mm, event.z_to_mm, 3e-10 + 3e-13 * Math.abs(event.z_to_mm), 'mm', where);
      scope.same('junction_z', event.z_from_mm, height(event.from, phi) ?? NaN, 1e-9 + 1e-11 * Math.abs(event.z_to_mm), 'mm', where);
    } else {
      checkSides(
        scope,
        cut,
        event,
        (by) => height(by, phi),
        (z) => onTube(rho, phi, z),
        where,
      );
    }
  }
  if (!whole) return;
  const count = 1440;
  const labels = Array.from({length: count}, (_, i) => envelope(cut, rho, (i * 2 * Math.PI) / count).by);
  for (let i = 0; i < count; i += 1) {
    const [a, b] = [labels[i], labels[(i + 1) % count]];
    if (a === b || a < 0 || b < 0 || same(cut, a, b, rho, (i * 2 * Math.PI) / count)) continue; // an end that passes beside its partners is a warning
    const from = (i * 360) / count - 1e-9;
    const met = mine.some(({phi_deg}) => {
      const turned = (((phi_deg - from) % 360) + 360) % 360;
      return turned <= 360 / count + 2e-9;
    });
    scope.most('events_missing', met ? 0 : 1, 0, '', `phi ${from.toFixed(3)}`);
  }
  scope.covers('events/*/phi_deg', 'events/*/z_from_mm', 'events/*/z_to_mm', 'events/*/from', 'events/*/to');
}

const same = (cut: Cut, a: number, b: number, rho: number, phi: number) =>
  Math.abs((cut.partners[a]?.top(rho * Math.cos(phi), rho * Math.sin(phi)) ?? 0) - (cut.partners[b]?.top(rho * Math.cos(phi), rho * Math.sin(phi)) ?? 0)) <
  1e-9;

/** Length of the root curve between two phases: its slope against the circumference is gamma. Jumps between add their height. */
export function curveLength(cut: Cut, rho: number, from: number, to: number, events: Event[], surface: string): number {
  const speed = (phi: number) => {
    const {z, by} = envelope(cut, rho, phi);
    const partner = cut.partners[by];
    if (!partner) return rho;
    const {gamma} = anglesOf(local(partner.normal(onTube(rho, phi, z)), phi));
    return rho / Math.max(Math.cos(gamma), 1e-12);
  };
  const inside = events
    .filter((event) => event.surface === surface)
    .flatMap((event) => {
      const phi = from + ((((event.phi_deg * RAD - from) % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI));
      return phi < Math.max(to, from + 1e-12) - 1e-13 ? [{phi, event}] : [];
    });
  const jump = inside.find(({event}) => event.kind === 'jump');
  if (to - from < 1e-12) return jump ? Math.abs(jump.event.z_to_mm - jump.event.z_from_mm) : 0;
  const corners = [from, ...inside.map(({phi}) => phi).sort((a, b) => a - b), to];
  let sum = inside
    .filter(({event, phi}) => event.kind === 'jump' && phi > from + 1e-12)
    .reduce((all, {event}) => all + Math.abs(event.z_to_mm - event.z_from_mm), 0);
  for (let i = 0; i + 1 < corners.length; i += 1) {
    const [a, b] = [corners[i], corners[i + 1]];
    if (b - a < 1e-14) continue;
    const folded = (t: number) => speed(a + (b - a) * Math.sin((Math.PI * t) / 2) ** 2) * (b - a) * (Math.PI / 2) * Math.sin(Math.PI * t);
    const found = integral(folded, 0, 1, 1e-10 * (b - a) * rho + 1e-13, 12);
    // Next to a jump the slope has few digits left; a rising curve is no longer than its two sides, and nearly as short as its chord where it is that steep.
    const jumpAt = (phi: number) =>
      events.find((event) => event.kind === 'jump' && event.surface === surface && Math.abs(Math.sin((event.phi_deg * RAD - phi) / 2)) < 1e-12);
    const arc = rho * (b - a);
    const rise = Math.abs((jumpAt(b)?.z_from_mm ?? envelope(cut, rho, b).z) - (jumpAt(a)?.z_to_mm ?? envelope(cut, rho, a).z));
    sum += rise > 100 * arc && found > rise + arc ? Math.hypot(rise, arc) : found;
  }
  return sum;
}

/** The column `length_mm`, if there is one, and the length of the whole curve. */
export function checkLength(
  scope: Scope,
  cut: Cut,
  phi: number[],
  length: number[] | undefined,
  events: Event[],
  whole: {length_mm: number; developed_length_mm: number},
  rho = rootRadius(cut),
  surface: string = cut.root,
): void {
  scope.same('developed_length', whole.developed_length_mm, 2 * Math.PI * rho, 1e-12 * (1 + rho), 'mm');
  const jumps = jumpsOf(events, surface);
  let total = 0;
  phi.forEach((at, i) => {
    const next = i + 1 < phi.length ? phi[i + 1] : phi[0] + 360;
    const own = curveLength(cut, rho, at * RAD, next * RAD, events, surface);
    total += own;
    if (!length) return;
    const stated = i + 1 < phi.length ? length[i + 1] - length[i] : whole.length_mm - length[i] + length[0];
    // Beside a jump the curve is as steep as its generator.
    const steep = jumps.some((jump) => Math.cos(jump - ((at + next) / 2) * RAD) > Math.cos(((next - at) / 2 + 1) * RAD));
    scope.same('length', stated, own, (steep ? 1e-5 : 1e-7) + (steep ? 1e-6 : 1e-8) * own, 'mm', `row ${i}`);
  });
  scope.same('length_of_all', whole.length_mm, total, 1e-6 + 1e-9 * total + 3e-5 * jumps.length, 'mm');
  scope.covers('length_mm', 'developed_length_mm');
  if (length) scope.covers('points/length_mm');
}

/** What the torch's range costs, where it binds: of the rule's B, and of root gap. */
export function checkBinds(scope: Scope, cut: Cut, columns: Columns, binds: Body[]): void {
  const has = ['phi_deg', 'b_deg', 'b_raw_deg', 'gap_mm', 'tau_deg', 'gamma_deg'].every((name) => columns[name]);
  if (!has || !binds.length) return;
  const col = (name: string) => columns[name] as number[];
  const phi = col('phi_deg');
  const turned = (deg: number) => ((deg % 360) + 360) % 360;
  for (const bind of binds) {
    const [from, to] = [bind.from_phi_deg as number, bind.to_phi_deg as number];
    const inside = phi.flatMap((at, i) => (turned(at - from) <= turned(to - from) + 1e-9 ? [i] : []));
    const rule = (i: number) => {
      const [tau, gamma] = [col('tau_deg')[i] * RAD, col('gamma_deg')[i] * RAD];
      return Math.atan2(Math.sin(tau), Math.cos(tau) * Math.cos(gamma)) / RAD;
    };
    const lifted = cut.contact === 'auto' && cut.groove.rule !== 'square' && columns.b_required_deg;
    const lost = inside.map((i) => Math.max(Math.abs(rule(i) - col('b_raw_deg')[i]), lifted ? col('b_required_deg')[i] - cut.torch.max : 0));
    const flat = Math.min(1, ...inside.map((i) => Math.max(1e-4, Math.cos(col('gamma_deg')[i] * RAD))));
    scope.same('torch_binds_gap', bind.root_gap_mm as number, Math.max(...inside.map((i) => col('gap_mm')[i])), 3e-10, 'mm', `phi ${from}`);
    scope.same('torch_binds_groove', bind.groove_lost_deg as number, Math.max(0, ...lost), 3e-9 + 1e-12 / flat ** 2, 'deg', `phi ${from}`);
    for (const end of [from, to])
      scope.most('torch_binds_phi', Math.min(...phi.map((at) => Math.abs(turned(at - end + 180) - 180))), 1e-9, 'deg', `phi ${end}`);
  }
  scope.covers(...['from_phi_deg', 'to_phi_deg', 'root_gap_mm', 'groove_lost_deg'].map((name) => `torch_binds/*/${name}`));
}

interface Laser {
  gap?: {greatest_mm: number; phi_deg: number; edge: string};
  bevelled_gap?: {greatest_mm: number; phi_deg: number; edge: string};
  reach_mm: number;
  tongue?: {width_mm: number; phi_deg: number; z_mm: number; radius_mm: number};
}

/** A head that never tilts: gaps of both edges, those of a flush cut, travel, and the tongue where it is stated. */
export function checkUntilted(scope: Scope, cut: Cut, columns: Columns, laser: Laser | undefined): void {
  const phi = columns.phi_deg as number[];
  const least = (rho: number, at: number, z: number) => Math.min(...cut.partners.map((partner) => partner.distance(onTube(rho, at, z))));
  const col = (name: string) => columns[name] as number[];
  const gaps = ['gap_inner_mm', 'gap_outer_mm', 'bevelled_gap_inner_mm', 'bevelled_gap_outer_mm'];
  if (gaps.every((name) => columns[name]) && cut.partners.length) {
    phi.forEach((deg, i) => {
      const at = deg * RAD;
      const z = envelope(cut, cut.inner, at).z;
      const flush = z + (cut.outer - cut.inner) * Math.tan(Math.max(-85 * RAD, required(cut, at, cut.inner, z, cut.outer)));
      const own = [
        least(cut.inner, at, col('z_inner_mm')[i]),
        least(cut.outer, at, col('z_outer_mm')[i]),
        least(cut.inner, at, z),
        least(cut.outer, at, flush),
      ];
      gaps.forEach((name, k) => scope.same(name.replace('_mm', ''), col(name)[i], own[k], 1e-7, 'mm', `row ${i}`));
    });
    scope.covers(...gaps.map((name) => `points/${name}`));
  }
  if (!laser) return;
  for (const [name, prefix] of [
    ['gap', 'gap'],
    ['bevelled_gap', 'bevelled_gap'],
  ] as const) {
    const stated = laser[name];
    if (!stated || !columns[`${prefix}_inner_mm`]) continue;
    const both = ['inner', 'outer'].map((edge) => Math.max(...col(`${prefix}_${edge}_mm`)));
    scope.same('greatest_gap', stated.greatest_mm, Math.max(...both), 1e-9, 'mm', name);
    const i = phi.findIndex((deg) => Math.abs(deg - stated.phi_deg) < 1e-9);
    scope.same('greatest_gap_at', stated.greatest_mm, i < 0 ? NaN : col(`${prefix}_${stated.edge}_mm`)[i], 1e-9, 'mm', name);
    scope.covers(`tube_laser/${name}/greatest_mm`, `tube_laser/${name}/phi_deg`);
  }
  const torch = [...col('torch_inner_mm'), ...col('torch_outer_mm')];
  scope.same('reach', laser.reach_mm, Math.max(...torch) - Math.min(...torch), 1e-9, 'mm');
  scope.covers('tube_laser/reach_mm');
  if (laser.tongue) checkTongue(scope, cut, rowsOf(cut, columns), laser.tongue);
}

/** Both ways from the tip, the edge has fallen by one wall; in between lies the tongue's width. */
function checkTongue(scope: Scope, cut: Cut, rows: Row[], tongue: {width_mm: number; phi_deg: number; z_mm: number; radius_mm: number}): void {
  const {radius_mm: rho, z_mm: tip} = tongue;
  const k = Math.abs(rho - cut.inner) < Math.abs(rho - cut.outer) ? 0 : rows[0].edges.length - 1;
  const wall = cut.outer - cut.inner;
  const n = rows.length - 1;
  const z = (i: number) => rows[((i % n) + n) % n].edges[k][1];
  const phi = (i: number) => rows[((i % n) + n) % n].phi + 2 * Math.PI * Math.floor(i / n);
  const start = rows.findIndex((row) => Math.abs(row.phi / RAD - tongue.phi_deg) < 1e-9);
  scope.same('tongue_tip', tip, start < 0 ? NaN : z(start), 1e-9, 'mm');
  scope.same('tongue_radius', rho, k ? cut.outer : cut.inner, 1e-9, 'mm');
  const reach = (way: number) => {
    for (let i = start; Math.abs(i - start) < n; i += way) {
      const [a, b] = [z(i), z(i + way)];
      if (b >= tip + wall) return Math.abs(phi(i) + ((tip + wall - a) / (b - a)) * (phi(i + way) - phi(i)) - phi(start));
    }
    return NaN;
  };
  scope.same('tongue_width', tongue.width_mm, rho * (reach(1) + reach(-1)), 3e-10, 'mm');
  scope.covers(...['width_mm', 'phi_deg', 'z_mm', 'radius_mm'].map((name) => `tube_laser/tongue/${name}`));
}
