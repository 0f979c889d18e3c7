/** The outlines of a tube that is not round: rounded rectangles, outside and of the bore (docs/theory/sections.md, section 1). */
import type {Scope} from './report.js';
import {type Body, girthOf, type Numbers, type Section} from './solids.js';
import type {V3} from './space.js';

export interface Outline {
  a: number; // half the side along x
  b: number; // and along y
  r: number; // of the corners
}

/** A place of an outline, with its outward normal. */
export interface Station {
  x: number;
  y: number;
  normal: V3;
  face: number; // on a corner, the face before it
  onCorner: boolean;
}

const QUARTER = Math.PI / 2;

export const outsideOf = (s: Section): Outline => ({a: s.height_mm / 2, b: s.width_mm / 2, r: s.corner_radius_mm});
export const boreOf = (s: Section): Outline => ({
  a: s.height_mm / 2 - s.wall_mm,
  b: s.width_mm / 2 - s.wall_mm,
  r: s.inner_corner_radius_mm ?? Math.max(0, s.corner_radius_mm - s.wall_mm),
});
export const girth = ({a, b, r}: Outline): number => 4 * (a + b) - (8 - 2 * Math.PI) * r;
const areaOf = ({a, b, r}: Outline): number => 4 * a * b - (4 - Math.PI) * r * r;

/** How far a place lies outside, and the direction of the nearest way out. */
export function outOf({a, b, r}: Outline, x: number, y: number): {off: number; normal: V3} {
  const [e, f] = [Math.abs(x) - a + r, Math.abs(y) - b + r];
  const [m, n] = e > 0 && f > 0 ? [e / Math.hypot(e, f), f / Math.hypot(e, f)] : e > f ? [1, 0] : [0, 1];
  return {off: (e > 0 && f > 0 ? Math.hypot(e, f) : Math.max(e, f)) - r, normal: [m * Math.sign(x), n * Math.sign(y), 0]};
}

/** Flats and corners in turn from the beginning of face 1: of each its length. */
const pieces = ({a, b, r}: Outline): number[] => [0, 1, 2, 3].flatMap((face) => [2 * ((face % 2 ? a : b) - r), QUARTER * r]);

/** Where the curvature changes, by the girth from the middle of face 1. */
export function seams(of: Outline): number[] {
  const whole = girth(of);
  let at = -(of.b - of.r);
  return pieces(of).map((length) => {
    at += length;
    return ((at % whole) + whole) % whole;
  });
}

export function walk(of: Outline, s: number): Station {
  const {a, b, r} = of;
  const whole = girth(of);
  let rest = (((s + b - r) % whole) + whole) % whole;
  const all = pieces(of);
  let i = 0;
  while (i < 7 && rest > all[i]) {
    rest -= all[i];
    i += 1;
  }
  const face = i >> 1;
  const [away, along] = face % 2 ? [b, a] : [a, b];
  const angle = i % 2 ? rest / (r || 1) : 0;
  const flat = i % 2 ? along - r : rest - along + r;
  const [u, v] = [away - r + r * Math.cos(angle), flat + r * Math.sin(angle)];
  const turn = (p: number, q: number): [number, number] =>
    [
      [p, q],
      [-q, p],
      [-p, -q],
      [q, -p],
    ][face] as [number, number];
  const [x, y] = turn(u, v);
  return {x, y, normal: [...turn(Math.cos(angle), Math.sin(angle)), 0], face: face + 1, onCorner: i % 2 === 1};
}

/** The girth of a place of the outline. */
export function girthAt(of: Outline, x: number, y: number): number {
  const {normal} = outOf(of, x, y);
  const [mx, my] = [Math.max(of.r - of.a, Math.min(of.a - of.r, x)), Math.max(of.r - of.b, Math.min(of.b - of.r, y))];
  const nu = ((Math.atan2(normal[1], normal[0]) % (4 * QUARTER)) + 4 * QUARTER) % (4 * QUARTER);
  const quarters = nu / QUARTER;
  const flats = [of.b, of.a, of.b, of.a].map((half) => 2 * (half - of.r));
  const near = Math.round(quarters);
  const whole = girth(of);
  if (Math.abs(quarters - near) < 1e-12) {
    const face = near % 4;
    const before = face ? flats[0] / 2 + flats.slice(1, face).reduce((sum, each) => sum + each, 0) + flats[face] / 2 : 0;
    return (before + face * QUARTER * of.r + [my, -mx, -my, mx][face] + whole) % whole;
  }
  const corner = Math.floor(quarters);
  return flats[0] / 2 + flats.slice(1, corner + 1).reduce((sum, each) => sum + each, 0) + of.r * nu;
}

/** Metal from a place outside straight in to the bore. */
export function wallAt(bore: Outline, {x, y, normal}: Pick<Station, 'x' | 'y' | 'normal'>): number {
  const off = (e: number) => outOf(bore, x - e * normal[0], y - e * normal[1]).off;
  let [low, high] = [0, off(0)];
  while (off(high) > 0) [low, high] = [high, high + (bore.a + bore.b) / 64];
  for (let i = 0; i < 100 && high > low; i += 1) {
    const middle = (low + high) / 2;
    if (middle === low || middle === high) break;
    if (off(middle) > 0) low = middle;
    else high = middle;
  }
  return high;
}

/** The sizes that an answer states of its section. */
export function checkSection(scope: Scope, section: Section, stated: Body): void {
  const made = stated as unknown as Numbers;
  for (const name of ['height_mm', 'width_mm', 'wall_mm', 'corner_radius_mm'] as const) scope.same('section', made[name], section[name], 1e-10, 'mm', name);
  const [outer, bore] = [outsideOf(section), boreOf(section)];
  scope.same('section', made.inner_corner_radius_mm, bore.r, 1e-10, 'mm', 'inner_corner_radius_mm');
  scope.same('section', made.girth_mm, girthOf(section), 1e-10, 'mm', 'girth_mm');
  scope.same('section', made.bore_girth_mm, girth(bore), 1e-10, 'mm', 'bore_girth_mm');
  const area = areaOf(outer) - areaOf(bore);
  scope.same('section', made.area_mm2, area, 1e-11 * area, 'mm2', 'area_mm2');
  scope.same('section', made.mass_kg_per_m, area * 7.85e-3, 1e-11 * area, 'kg/m', 'mass_kg_per_m');
  scope.covers('section');
}
