/** Curves of an end that is not round, on one of its outlines: places, heights, events, lengths (docs/theory/sections.md, section 2). */
import type {Cut} from './bevel.js';
import {girth, type Outline, seams, walk} from './outline.js';
import type {Scope} from './report.js';
import type {Body, Solid} from './solids.js';
import {integral, norm, RAD, root, sub} from './space.js';
import {checkSides} from './wall.js';

/** A cut, of which `inner` and `outer` say nothing, and the outlines that it goes round. */
export interface SectionCut {
  cut: Cut;
  outer: Outline;
  bore: Outline;
}

export interface Event {
  kind: string;
  surface: string;
  girth_mm: number;
  z_from_mm: number;
  z_to_mm: number;
  from: number;
  to: number;
}

/** The highest partner over a place of the section. */
export function envelopeAt(partners: Solid[], x: number, y: number): {z: number; by: number} {
  let [z, by] = [-Infinity, -1];
  partners.forEach((partner, i) => {
    const top = partner.top(x, y);
    if (top !== undefined && top > z) [z, by] = [top, i];
  });
  return {z, by};
}

export const apart = (s: number, other: number, whole: number): number => {
  const off = (((s - other) % whole) + whole) % whole;
  return Math.min(off, whole - off);
};

/** As `above` of a round tube: at a jump, where a partner is lost, on the lower side. */
export function aboveAt(cut: Cut, of: Outline, s: number, z: number, jumps: number[]): number {
  const height = (at: number) => {
    const {x, y} = walk(of, at);
    return envelopeAt(cut.partners, x, y).z;
  };
  const near = jumps.some((jump) => apart(jump, s, girth(of)) < 1e-7);
  return (near ? Math.min(height(s - 1e-7), height(s + 1e-7)) - 1e-2 : height(s)) - z;
}

export const jumpsOf = (events: Event[], surface: string): number[] => events.filter((e) => e.kind === 'jump' && e.surface === surface).map((e) => e.girth_mm);

/** The curve of one outline: places, heights, events and length. */
export function checkSectionProfile(scope: Scope, whole: SectionCut, profile: Body): void {
  const surface = String(profile.surface);
  const of = surface === 'inner' ? whole.bore : whole.outer;
  const points = profile.points as unknown as {[name: string]: number[]} & {on_corner: boolean[]};
  const events = profile.events as unknown as Event[];
  const jumps = jumpsOf(events, surface);
  const {cut} = whole;
  points.girth_mm.forEach((s, i) => {
    const where = `row ${i}`;
    const [x, y, z, by] = [points.x_mm[i], points.y_mm[i], points.z_mm[i], points.cutter[i]];
    checkStation(scope, of, s, points, i);
    const at = walk(of, s);
    scope.most('place', Math.hypot(x - at.x, y - at.y), 1e-10, 'mm', where);
    const partner = cut.partners[by];
    const fine = 1e-10 + 3e-13 * (of.a + of.b + Math.abs(z));
    scope.most('on_partner', Math.abs(partner?.distance([x, y, z]) ?? NaN), fine, 'mm', where);
    if (!jumps.some((jump) => apart(jump, s, girth(of)) < 1e-7)) scope.same('height', z, partner?.top(x, y) ?? NaN, 5e-10 + 1e-12 * Math.abs(z), 'mm', where);
    scope.most('none_above', aboveAt(cut, of, s, z, jumps), 1e-7 * (1 + (of.a + of.b) / 10), 'mm', where);
  });
  checkEvents(scope, cut, of, events, surface);
  const places = points.girth_mm;
  const total = places.reduce((sum, s, i) => sum + lengthOf(cut, of, s, i + 1 < places.length ? places[i + 1] : places[0] + girth(of), events, surface), 0);
  scope.same('developed_length', profile.developed_length_mm as number, girth(of), 1e-12 * (1 + girth(of)), 'mm');
  scope.same('length_of_all', profile.length_mm as number, total, 1e-6 + 1e-8 * total + 3e-5 * jumps.length, 'mm');
  scope.covers(
    'length_mm',
    'developed_length_mm',
    ...['girth_mm', 'normal_deg', 'face', 'on_corner', 'x_mm', 'y_mm', 'z_mm', 'cutter'].map((n) => `points/${n}`),
  );
}

export function checkStation(scope: Scope, of: Outline, s: number, points: {[name: string]: number[]} & {on_corner: boolean[]}, i: number): void {
  const at = walk(of, s);
  const where = `row ${i}`;
  const turned = points.normal_deg[i] * RAD;
  scope.most('normal', norm(sub(at.normal, [Math.cos(turned), Math.sin(turned), 0])), 5e-11, '', where);
  if (seams(of).some((seam) => apart(seam, s, girth(of)) < 1e-7)) return; // either side of a seam may be named
  scope.same('face', points.face[i], at.face, 0, '', where);
  scope.equal('on_corner', points.on_corner[i], at.onCorner, where);
}

export function checkEvents(scope: Scope, cut: Cut, of: Outline, events: Event[], surface: string): void {
  const mine = events.filter((event) => event.surface === surface);
  const whole = girth(of);
  const place = (s: number): [number, number] => {
    const {x, y} = walk(of, s);
    return [x, y];
  };
  const height = (by: number, s: number) => cut.partners[by]?.top(...place(s));
  /** Where faces are flush, rounding decides whether a line along one of them meets it. */
  const heightNear = (by: number, s: number): [number, number] => {
    const exact = height(by, s);
    const nearby = [s - 1e-6, s + 1e-6].map((at) => height(by, at)).find((z) => z !== undefined);
    return exact === undefined ? [nearby ?? NaN, 1e-4] : [exact, 0];
  };
  const edges = seams(of);
  for (const event of mine) {
    const s = event.girth_mm;
    const where = `girth ${s}`;
    if (event.kind === 'tangent_line') {
      scope.most('seam', Math.min(...edges.map((seam) => apart(seam, s, whole))), 1e-10, 'mm', where);
      const [z, loose] = heightNear(event.from, s);
      scope.most('seam', Math.abs(event.z_from_mm - z), 3e-10 + 1e-12 * Math.abs(event.z_to_mm) + loose, 'mm', where);
    } else if (event.kind === 'junction') {
      const difference = (at: number) => (height(event.from, at) ?? -Infinity) - (height(event.to, at) ?? -Infinity);
      const sides = [heightNear(event.from, s), heightNear(event.to, s)];
      const [z, loose] = sides.find(([at]) => !Number.isNaN(at)) ?? [NaN, 0];
      if (Math.abs(difference(s)) > 1e-9 && !loose) scope.same('junction_girth', s, root(difference, s - 1e-5, s + 1e-5), 3e-10, 'mm', where);
      scope.same('junction_z', event.z_from_mm, event.z_to_mm, 3e-10 + 3e-13 * Math.abs(event.z_to_mm), 'mm', where);
      if (Number.isNaN(z)) continue; // along a face of both partners that is flush with the tube's own
      scope.same('junction_z', event.z_from_mm, z, 3e-10 + 1e-11 * Math.abs(event.z_to_mm) + loose, 'mm', where);
    } else {
      checkSides(
        scope,
        cut,
        event,
        (by) => height(by, s),
        (z) => [...place(s), z],
        where,
      );
    }
  }
  const count = 1440;
  const labels = Array.from({length: count}, (_, i) => envelopeAt(cut.partners, ...place((i * whole) / count)).by);
  for (let i = 0; i < count; i += 1) {
    const [a, b] = [labels[i], labels[(i + 1) % count]];
    if (a === b || a < 0 || b < 0) continue;
    const s = (i * whole) / count;
    if (Math.abs((height(a, s) ?? 0) - (height(b, s) ?? 0)) < 1e-9) continue;
    const met = mine.some(({girth_mm}) => (((girth_mm - s + 1e-8) % whole) + whole) % whole <= whole / count + 2e-8);
    scope.most('events_missing', met ? 0 : 1, 0, '', `girth ${s.toFixed(3)}`);
  }
  scope.covers('events/*/girth_mm', 'events/*/z_from_mm', 'events/*/z_to_mm', 'events/*/from', 'events/*/to');
}

/** Length of the curve on an outline between two girths, as `curveLength` of a round tube. */
export function lengthOf(cut: Cut, of: Outline, from: number, to: number, events: Event[], surface: string): number {
  const whole = girth(of);
  const speed = (s: number) => {
    const {x, y, normal} = walk(of, s);
    const {z, by} = envelopeAt(cut.partners, x, y);
    const partner = cut.partners[by];
    if (!partner) return 1;
    const n = partner.normal([x, y, z]);
    return 1 / Math.max(Math.cos(Math.atan2(n[1] * normal[0] - n[0] * normal[1], n[2])), 1e-12);
  };
  const inside = (places: number[]) => places.map((s) => from + ((((s - from) % whole) + whole) % whole)).filter((s) => s < Math.max(to, from + 1e-12) - 1e-12);
  const mine = events.filter((event) => event.surface === surface);
  const jumps = mine.filter(({kind}) => kind === 'jump');
  if (to - from < 1e-9) {
    const jump = jumps.find(({girth_mm}) => apart(girth_mm, from, whole) < 1e-9);
    return jump ? Math.abs(jump.z_to_mm - jump.z_from_mm) : 0;
  }
  const corners = [from, ...inside([...mine.map(({girth_mm}) => girth_mm), ...seams(of)]).sort((a, b) => a - b), to];
  let sum = 0;
  for (const jump of jumps) for (const s of inside([jump.girth_mm])) if (s > from + 1e-9) sum += Math.abs(jump.z_to_mm - jump.z_from_mm);
  for (let i = 0; i + 1 < corners.length; i += 1) {
    const [a, b] = [corners[i], corners[i + 1]];
    if (b - a < 1e-13) continue;
    const folded = (t: number) => speed(a + (b - a) * Math.sin((Math.PI * t) / 2) ** 2) * (b - a) * (Math.PI / 2) * Math.sin(Math.PI * t);
    sum += integral(folded, 0, 1, 1e-10 * (b - a) + 1e-13, 12);
  }
  return sum;
}
