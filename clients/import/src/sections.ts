import {length, type Vector} from './geometry.js';
import {decimal} from './units.js';

/** Standards by whose rules the service makes corners, by its names, the most likely first. */
export const standards = ['en_10219', 'en_10210', 'astm_a500'] as const;
export type Standard = (typeof standards)[number];

/** By a standard's rule, or outside in mm; without the inner radius the corners are concentric. */
export type Corners = {corners: Standard} | Radii;
export interface Radii {
  corner_radius_mm: number;
  inner_corner_radius_mm?: number;
}

export interface Sides {
  height_mm: number;
  width_mm: number;
  wall_mm: number;
}
export type Section = ({kind: 'rectangular_tube'} & Sides & Corners) | ({kind: 'flat_oval_tube'} & Sides);

export interface CornerOptions {
  /** Outside, of rectangular tubes whose corners the file does not state or draws too sharp to be cut, in mm. */
  corner_radius_mm?: number;
  /** The same by a standard's rule; a radius counts before it. */
  corners?: Standard;
}

export const cornersStated = ({corner_radius_mm, corners}: CornerOptions): Corners | undefined =>
  corner_radius_mm !== undefined ? {corner_radius_mm} : corners && {corners};

/** The choices, in words for a message. */
export const cornersToState = 'en_10219 (cold formed), en_10210 (hot finished), astm_a500, or the radius outside in mm';

/** "en_10219", "EN 10219-2:2006", "ASTM A500". */
export function standardSaid(said: string): Standard | undefined {
  const number = /^(?:EN|DIN EN|ASTM)?[ _]?(10219|10210|A ?500)(?:[-/: ][-/:\dAM ]{0,12})?$/i.exec(said.trim().slice(0, 64))?.[1];
  return standards.find((each) => number !== undefined && each.endsWith(number.replace(' ', '').toLowerCase()));
}

/** The radii of a standard by the wall, as the service calculates them: docs/theory/sections.md, 1.3. */
function radiiOf(corners: Corners, wall: number): [outer: number, inner: number] {
  if (!('corners' in corners)) return [corners.corner_radius_mm, corners.inner_corner_radius_mm ?? Math.max(corners.corner_radius_mm - wall, 0)];
  if (corners.corners === 'en_10210') return [1.5 * wall, wall];
  const outer = corners.corners === 'astm_a500' || wall <= 6 ? 2 : wall <= 10 ? 2.5 : 3;
  return [outer * wall, (outer - 1) * wall];
}

const hair = 1e-9; // relative: added by rounding

/**
 * Returns why the service cannot cut corners (docs/theory/sections.md, 1.4); undefined if it can.
 * It is checked here because the service refuses a whole frame for one such member.
 */
export function uncut({height_mm, width_mm, wall_mm: wall}: Sides, corners: Corners): string | undefined {
  const [outer, inner] = radiiOf(corners, wall);
  const side = Math.min(height_mm, width_mm);
  const shown = (v: number): number => Number(v.toPrecision(6));
  if (2 * outer > side * (1 + hair)) return `a corner radius of ${shown(outer)} mm is more than half the side of ${shown(side)} mm`;
  if (2 * inner > side - 2 * wall + side * hair) return `an inner corner radius of ${shown(inner)} mm is more than half the bore's side`;
  const furtherIn = wall + inner - outer; // of the centre of the bore's corner
  const inside = furtherIn <= hair * wall ? outer - wall : inner - Math.SQRT2 * furtherIn;
  if (inside < 0.05 * wall * (1 - hair)) return `corners of ${shown(outer)} mm are too sharp to be cut in a wall of ${shown(wall)} mm`;
  const diagonal = Math.SQRT2 * wall - (Math.SQRT2 - 1) * (outer - inner);
  return diagonal < 0.5 * wall ? `an inner corner radius of ${shown(inner)} mm leaves less than half the wall at a corner of ${shown(outer)} mm` : undefined;
}

const [square, rectangular] = ['shs|qro|qhp|square', 'rhs|rro|rhp|rect'].map((words) => new RegExp(`^(?:${words})(?![a-z])`, 'i')) as [RegExp, RegExp];
/** Does a size begin with a word that no round tube has? */
export const isSided = (said: string): boolean => square.test(said) || rectangular.test(said);

/** A size of sides and wall, with its standard if it has one: "RHS 60x40x3 EN 10219", "60x40x3", "SHS 40x3". */
export function sidesSaid(said: string, number: (text: string) => number = decimal): (Sides & {corners?: Standard}) | undefined {
  const found = /^(?:[A-Za-z]{1,6} ?)?(\d[\d.,]{0,12}) ?[xX×*] ?(\d[\d.,]{0,12})(?: ?[xX×*] ?(\d[\d.,]{0,12}))?(?: ?mm)?(?: (.{1,24}))?$/.exec(
    said.trim().slice(0, 64),
  );
  const [, first, second, third, rest] = found ?? [];
  if (first === undefined || second === undefined || (third === undefined && !square.test(said.trim()))) return undefined;
  const corners = rest === undefined ? undefined : standardSaid(rest);
  if (rest !== undefined && corners === undefined) return undefined;
  const [height_mm, width_mm, wall_mm] = (third === undefined ? [first, first, second] : [first, second, third]).map(number) as [number, number, number];
  return isHollow({height_mm, width_mm, wall_mm}) ? {height_mm, width_mm, wall_mm, ...(corners && {corners})} : undefined;
}

export const isHollow = ({height_mm, width_mm, wall_mm}: Sides): boolean =>
  height_mm > 0 && width_mm > 0 && wall_mm > 0 && 2 * wall_mm < Math.min(height_mm, width_mm);

const plumb = Math.sin(Math.PI / 180);
/**
 * Where the height lies if nobody states it: up, as of most beams. Within a degree of the vertical it is +x, because there
 * the rounding of coordinates would turn it.
 */
export const usualUp = (run: Vector): Vector => (Math.hypot(run[0], run[1]) <= plumb * length(run) ? [1, 0, 0] : [0, 0, 1]);
export const usually = 'the height lies along +z, and of a tube within 1 deg of the vertical along +x';
