/** Grooves of equal area between a branch and its chord, section by section (docs/theory/grooves-and-milling.md). */
import type {Scope} from './report.js';
import type {Body, Numbers} from './solids.js';
import {cross, dot, integral, mul, RAD, root, sub, type V3, unit} from './space.js';

type Table = {[name: string]: number[]};

export interface Joint {
  R: number; // of the chord
  r: number; // of the branch
  rho: number; // of the root
  H: number; // of the root over the weld face's foot
  width: number; // of the weld face on the chord
  a: number;
  ecc: number;
  inner: number;
  face: number;
}

export function jointOf(request: Body): Joint {
  const [chord, branch, face] = [request.chord as Numbers, request.branch as Numbers, request.root_face as Numbers];
  const r = branch.outer_diameter_mm / 2;
  const inner = r - branch.wall_mm;
  const H = branch.wall_mm - face.width_mm;
  return {
    R: chord.outer_diameter_mm / 2,
    r,
    rho: inner + face.width_mm,
    H,
    width: 2 * H,
    a: (request.inclination_deg as number) * RAD,
    ecc: (request.eccentricity_mm as number | undefined) ?? 0,
    inner,
    face: face.height_mm,
  };
}

/** Height of the chord over a place of the section at omega, by its distance from the branch's axis. */
export function chordAt(j: Joint, s: number, omega: number): number {
  const aside = s * Math.sin(omega) + j.ecc;
  return (s * Math.cos(omega) * Math.cos(j.a) + Math.sqrt((j.R - aside) * (j.R + aside))) / Math.sin(j.a);
}

/** Where the weld face ends on the chord: the first place as far outwards from the root as the face is wide. */
function weldEnd(j: Joint, omega: number): [number, number] {
  const y = chordAt(j, j.rho, omega);
  const far = (s: number) => Math.hypot(s - j.rho, chordAt(j, s, omega) - y) - j.width;
  let to = j.rho + j.width;
  if (far(to) < 0) return [to, chordAt(j, to, omega)]; // on a level chord, by rounding
  if (!(far(to) >= 0)) to = j.rho + j.width * (1 - 1e-9);
  // The distance may pass the width before the outermost place: the first sign change counts.
  const steps = 400;
  for (let i = 1; i <= steps; i += 1) {
    const s = j.rho + (j.width * i) / steps;
    if (far(s) >= 0) {
      to = s;
      break;
    }
  }
  const s = root(far, to - j.width / steps, to);
  return [s, chordAt(j, s, omega)];
}

/** Area between the chord and the straight line from one place of a section to another, below the chord. */
const bow = (j: Joint, omega: number, from: number, to: number): number => {
  const [a, b] = [chordAt(j, from, omega), chordAt(j, to, omega)];
  return integral((s) => chordAt(j, s, omega) - a - ((b - a) * (s - from)) / (to - from), from, to, 1e-12);
};

export interface Section {
  y1: number;
  s2: number;
  y2: number;
  bow: number;
}

export function sectionAt(j: Joint, omega: number): Section {
  const y1 = chordAt(j, j.rho, omega);
  const [s2, y2] = weldEnd(j, omega);
  return {y1, s2, y2, bow: bow(j, omega, j.rho, s2)};
}

/** The area of filler below a groove line that ends `h` above the root: triangle of root, line's end and weld end, less the bow. */
export const fillerOf = (j: Joint, {y1, s2, y2, bow: below}: Section, h: number): number => (h * (s2 - j.rho) - j.H * (y2 - y1)) / 2 - below;
export const heightOf = (j: Joint, {y1, s2, y2, bow: below}: Section, area: number): number => (2 * (area + below) + j.H * (y2 - y1)) / (s2 - j.rho);

/** The filler's area: as requested, or of its height in one section. */
export function areaOf(j: Joint, filler: Numbers): number {
  return filler.area_mm2 ?? fillerOf(j, sectionAt(j, (filler.at_deg ?? 0) * RAD), filler.height_mm);
}

export function checkGroove(scope: Scope, request: Body, result: Body): void {
  const j = jointOf(request);
  const rows = result.sections as unknown as Table;
  const axial = (request.area_in ?? 'axial') === 'axial';
  const area = result.filler_area_mm2 as number;
  const fine = 5e-11 * (1 + j.R / 100);
  const filler = request.filler as Numbers;
  if (filler.area_mm2 !== undefined) scope.same('filler', area, filler.area_mm2, 1e-9, 'mm2');
  else if (axial) scope.same('filler', heightOf(j, sectionAt(j, (filler.at_deg ?? 0) * RAD), area), filler.height_mm, 1e-9 * (1 + j.R / 100), 'mm');
  const curves = result.curves as unknown as {[name: string]: Table};
  rows.omega_deg.forEach((deg, i) => {
    const at = (name: string) => rows[name][i];
    const [omega, where] = [deg * RAD, `section ${i}`];
    const own = sectionAt(j, omega);
    scope.same('omega', deg, (360 * i) / rows.omega_deg.length, 1e-10, 'deg', where);
    scope.same('phi', at('phi_deg'), (((deg + 270) % 360) + 360) % 360, 1e-9, 'deg', where);
    const h = at('height_mm');
    for (const [name, value] of [
      ['root_z_mm', own.y1],
      ['p1_x_mm', j.rho],
      ['p1_y_mm', own.y1],
      ['p2_x_mm', own.s2],
      ['p2_y_mm', own.y2],
      ['p3_x_mm', j.r],
      ['p3_y_mm', own.y1 + h],
    ] as const)
      scope.same('section_points', at(name), value, 3 * fine, 'mm', `${where} ${name}`);
    const D = fillerOf(j, own, h);
    const loose = 1e-9 * (1 + area);
    scope.same('filler_area', at('area_d_mm2'), D, loose, 'mm2', where);
    if (axial) scope.same('equal_area', D, area, loose, 'mm2', where);
    scope.same('area_sum', at('area_a_mm2') + at('area_b_mm2') + at('area_c_mm2') + at('area_d_mm2') - at('area_e_mm2'), 0, loose, 'mm2', where);
    scope.same('area_a', at('area_a_mm2'), (j.H * h) / 2, loose, 'mm2', where);
    scope.same('area_c', at('area_c_mm2'), own.bow, loose, 'mm2', where);
    scope.same('groove_angle', Math.tan(at('groove_angle_deg') * RAD), j.H / h, 1e-10, '', where);
    const flat = j.R / Math.abs(Math.sin(omega));
    const endless = flat > 1e9 * j.R; // a pair of lines, stated as 0 or, because a sine is seldom 0, as any great length
    if (!endless) scope.same('ellipse', at('ellipse_a_mm'), flat, 1e-9 * (1 + flat), 'mm', where);
    else scope.equal('ellipse', at('ellipse_a_mm') === 0 || at('ellipse_a_mm') > 1e9 * j.R, true, where);
    for (const [name, s, z] of [
      ['c1', j.inner, own.y1 - j.face],
      ['c2', j.rho, own.y1 - j.face],
      ['c3', j.rho, own.y1],
      ['c4', j.r, own.y1 + h],
    ] as const) {
      const curve = curves[name];
      const point: V3 = [-s * Math.sin(omega), s * Math.cos(omega), z];
      (['x_mm', 'y_mm', 'z_mm'] as const).forEach((axis, k) => scope.same('curves', curve[axis][i], point[k], 3 * fine, 'mm', `${where} ${name}`));
    }
  });
  scope.covers(
    ...Object.keys(rows)
      .filter((name) => !['twist_deg', 'area_b_mm2', 'area_e_mm2'].includes(name))
      .map((name) => `sections/${name}`),
    'sections/area_b_mm2',
    'sections/area_e_mm2',
  );
  for (const name of ['c1', 'c2', 'c3', 'c4']) scope.covers(...['x_mm', 'y_mm', 'z_mm'].map((axis) => `curves/${name}/${axis}`));
  scope.covers('filler_area_mm2');
  if (axial) checkWhole(scope, j, result, rows, area, (request.compare as Numbers | undefined)?.bevel_deg);
}

/** Figures of the whole turn, by 720 sections of our own. */
function checkWhole(scope: Scope, j: Joint, result: Body, rows: Table, area: number, bevel: number | undefined): void {
  const count = 720;
  const all = Array.from({length: count}, (_, i) => sectionAt(j, (2 * Math.PI * i) / count));
  const heights = all.map((section) => heightOf(j, section, area));
  const z = (i: number) => all[(i + count) % count].y1;
  const slope = (list: (i: number) => number, i: number) => ((list(i + 1) - list(i - 1)) * 8 - (list(i + 2) - list(i - 2))) / ((12 * 2 * Math.PI) / count);
  const length = all.reduce((sum, _, i) => sum + Math.hypot(j.rho, slope(z, i)), 0) * ((2 * Math.PI) / count);
  scope.same('weld_length', (result.weld_length_mm as number) / length, 1, 2e-7, '');
  // The service states extremes of these 720 sections.
  const extremes = {height_min_mm: Math.min(...heights), height_max_mm: Math.max(...heights)};
  for (const [name, own] of Object.entries(extremes)) scope.same('heights', (result[name] as number) / own, 1, 3e-9, '', name);
  scope.same('least_area', (result.least_area_mm2 as number) / Math.max(...all.map((section) => fillerOf(j, section, 0))), 1, 3e-9, '');
  const volume = (h: (i: number) => number) =>
    all.reduce((sum, section, i) => sum + momentOf(j, section, (2 * Math.PI * i) / count, h(i)), 0) * ((2 * Math.PI) / count);
  scope.same('filler_volume', (result.filler_volume_mm3 as number) / volume((i) => heights[i]), 1, 2e-6, '');
  rows.omega_deg.forEach((deg, i) => {
    const omega = deg * RAD;
    const own = twistAt(j, omega, (at) => heightOf(j, sectionAt(j, at), area));
    scope.same('twist', rows.twist_deg[i], own / RAD, 1e-5, 'deg', `section ${i}`);
  });
  scope.covers('weld_length_mm', 'height_min_mm', 'height_max_mm', 'least_area_mm2', 'filler_volume_mm3', 'sections/twist_deg');
  const compare = result.compare as Body | undefined;
  if (!compare) return;
  const h = compare.height_mm as number;
  // B is measured from the square cut, so its tangent is the height over the wall; that of `groove_angle_deg`, from the axis, is the inverse.
  scope.same('compare_height', h, j.H * Math.tan((bevel as number) * RAD), 1e-10 * (1 + j.H), 'mm');
  (compare.filler_area_mm2 as number[]).forEach((found, i) => {
    scope.same('compare_area', found, fillerOf(j, sectionAt(j, rows.omega_deg[i] * RAD), h), 1e-9 * (1 + found), 'mm2', `section ${i}`);
  });
  scope.same('compare_volume', (compare.filler_volume_mm3 as number) / volume(() => h), 1, 2e-6, '');
  scope.covers('compare/height_mm', 'compare/filler_area_mm2', 'compare/filler_volume_mm3');
}

/** First moment of a section's filler about the branch's axis: what a turn by one radian sweeps. */
function momentOf(j: Joint, {y1, s2, y2}: Section, omega: number, h: number): number {
  const triangle = (h * (s2 - j.rho) - j.H * (y2 - y1)) / 2;
  const below = integral((s) => s * (chordAt(j, s, omega) - y1 - ((y2 - y1) * (s - j.rho)) / (s2 - j.rho)), j.rho, s2, 1e-10);
  return (triangle * (j.rho + j.r + s2)) / 3 - below;
}

/** The turn of the groove surface's normal along a ruling. */
function twistAt(j: Joint, omega: number, height: (omega: number) => number): number {
  const place = (at: number, edge: number): V3 => {
    const s = edge ? j.r : j.rho;
    return [-s * Math.sin(at), s * Math.cos(at), chordAt(j, j.rho, at) + edge * height(at)];
  };
  const along = (edge: number): V3 => {
    const step = (h: number) => sub(place(omega + h, edge), place(omega - h, edge));
    return sub(mul(step(1e-3), 8), step(2e-3));
  };
  const ruling = sub(place(omega, 1), place(omega, 0));
  const [low, high] = [unit(cross(along(0), ruling)), unit(cross(along(1), ruling))];
  return Math.atan2(dot(cross(high, low), unit(ruling)), dot(low, high));
}
