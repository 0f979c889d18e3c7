/** Paths of a cone mill round a groove: poses of the tool from the axes, and its distance from the groove (docs/theory/grooves-and-milling.md). */
import {areaOf, chordAt, heightOf, type Joint, jointOf, sectionAt} from './grooves.js';
import type {Scope} from './report.js';
import type {Body, Numbers} from './solids.js';
import {highest, RAD, wrapped} from './space.js';

type Columns = {[name: string]: number[]};
type Dist = (mill: Mill, pose: Pose, at: number, point: [number, number]) => number;

interface Mill {
  tip: number; // radius
  half: number;
  length: number;
}

/** The axis in the axial plane at omega: tip centre and direction from there into the spindle. */
interface Pose {
  omega: number;
  s: number;
  y: number;
  lean: number; // of the direction over the section
}

interface Setup {
  up: boolean;
  pivot: number;
  zero: number;
  turn: number;
  direction: number;
  overrun: number;
}

/** Groove surface: root and edge of a section, from heights at every half degree. */
class Surface {
  private readonly heights: number[];
  private readonly count = 720;

  constructor(
    readonly joint: Joint,
    area: number,
  ) {
    this.heights = Array.from({length: this.count}, (_, i) => heightOf(joint, sectionAt(joint, (i * 2 * Math.PI) / this.count), area));
  }

  root = (omega: number): number => chordAt(this.joint, this.joint.rho, omega);

  /** Lagrange's polynomial through the eight nearest heights. */
  height(omega: number): number {
    const at = (omega / (2 * Math.PI)) * this.count;
    const first = Math.floor(at) - 3;
    let sum = 0;
    for (let i = 0; i < 8; i += 1) {
      let weight = 1;
      for (let k = 0; k < 8; k += 1) if (k !== i) weight *= (at - first - k) / (i - k);
      sum += weight * this.heights[(((first + i) % this.count) + this.count) % this.count];
    }
    return sum;
  }

  at(omega: number, v: number): [number, number] {
    return [this.joint.rho + v * this.joint.H, this.root(omega) + v * this.height(omega)];
  }
}

/** Along the axis from the tip, and off it. */
function inTool({omega, s: s0, y: y0, lean}: Pose, at: number, [s, y]: [number, number]): [number, number] {
  const [x, aside] = [s * Math.cos(at - omega) - s0, s * Math.sin(at - omega)];
  const [c, n] = [Math.cos(lean), Math.sin(lean)];
  return [x * c + (y - y0) * n, Math.hypot((y - y0) * c - x * n, aside)];
}

/** Distance from the flank, which has no end; below 0 inside the tool. */
function flank(mill: Mill, pose: Pose, at: number, point: [number, number]): number {
  const [along, off] = inTool(pose, at, point);
  return (off - mill.tip) * Math.cos(mill.half) - along * Math.sin(mill.half);
}

/** Distance from the whole cutter, between its tip and its length. */
function cutter(mill: Mill, pose: Pose, at: number, point: [number, number]): number {
  const [along, off] = inTool(pose, at, point);
  const [c, n] = [Math.cos(mill.half), Math.sin(mill.half)];
  const side = (off - mill.tip) * c - along * n;
  const way = (off - mill.tip) * n + along * c; // along the flank
  const long = mill.length / c;
  if (side > 0 && way >= 0 && way <= long) return side;
  if (along >= 0 && along <= mill.length) if (side <= 0) return Math.max(side, -along, along - mill.length);
  const rim = (a: number, r: number) => (off > r ? Math.hypot(along - a, off - r) : Math.abs(along - a));
  return along < 0 || way < 0 ? rim(0, mill.tip) : rim(mill.length, mill.tip + mill.length * Math.tan(mill.half));
}

/** The first position: the whole generatrix on the ruling, on the air side. */
function initial(surface: Surface, mill: Mill, setup: Setup, omega: number): Pose {
  const {H} = surface.joint;
  const h = surface.height(omega);
  const ruling = Math.atan2(h, H);
  const way = (setup.direction > 0 ? 0 : mill.length / Math.cos(mill.half)) - setup.overrun;
  const lean = setup.direction > 0 ? ruling - mill.half : ruling + mill.half - Math.PI;
  const [s, y] = [surface.joint.rho + way * Math.cos(ruling), surface.root(omega) + way * Math.sin(ruling)];
  return {omega, s: s + setup.direction * mill.tip * Math.sin(lean), y: y - setup.direction * mill.tip * Math.cos(lean), lean};
}

/** Axes of the machine: x and z of the swing's pivot, B from its z axis, C of the branch. */
interface Axes {
  c: number;
  x: number;
  z: number;
  b: number;
}

function axesOf(setup: Setup, pose: Pose): Axes {
  const side = setup.up ? -1 : 1;
  return {
    c: setup.turn - side * pose.omega,
    x: pose.s + setup.pivot * Math.cos(pose.lean),
    z: setup.zero + side * (pose.y + setup.pivot * Math.sin(pose.lean)),
    b: Math.PI / 2 - side * pose.lean,
  };
}

function poseOf(setup: Setup, {c, x, z, b}: Axes): Pose {
  const side = setup.up ? -1 : 1;
  const lean = side * (Math.PI / 2 - b);
  return {
    omega: side * (setup.turn - c),
    s: x - setup.pivot * Math.cos(lean),
    y: side * (z - setup.zero) - setup.pivot * Math.sin(lean),
    lean,
  };
}

/** All that a path is checked by: the groove, the tool, and the machine's rows. */
interface Path {
  surface: Surface;
  mill: Mill;
  setup: Setup;
  rows: Columns;
  side: number; // of the machine's z, along the branch or against it
  pivot: boolean; // B turns about the swing's pivot, not about the tip
  check: Numbers;
}

/** The pose with the increments of the machine. */
function moved({setup, side, pivot}: Path, pose: Pose, dz: number, db: number): Pose {
  if (!pivot) return {...pose, y: pose.y + side * dz, lean: pose.lean - side * db};
  const axes = axesOf(setup, pose);
  return {...poseOf(setup, {...axes, z: axes.z + dz, b: axes.b + db}), omega: pose.omega};
}

/** The axes of a row, in mm and radians. */
const rowOf = ({rows}: Path, i: number): Axes => ({c: rows.c_deg[i] * RAD, x: rows.x_mm[i], z: rows.z_mm[i], b: rows.b_deg[i] * RAD});

export function checkMill(scope: Scope, request: Body, result: Body): void {
  const groove = request.groove as Body;
  if ((groove.area_in ?? 'axial') !== 'axial') {
    scope.not('', 'heights of a groove of equal normal areas are not in the answer');
    return;
  }
  const joint = jointOf(groove);
  const [m, s] = [request.mill as Numbers, request.setup as unknown as Numbers & {mount: string}];
  const up = (request.setup as Body).mount === 'end_up';
  const setup = {
    up,
    pivot: s.pivot_length_mm ?? 0,
    zero: s.z_zero_mm ?? 0,
    turn: (s.c_zero_deg ?? 0) * RAD,
    direction: s.direction ?? 1,
    overrun: s.overrun_mm ?? 0,
  };
  const optimise = (request.optimise ?? {}) as Body;
  const path: Path = {
    surface: new Surface(joint, areaOf(joint, groove.filler as Numbers)),
    mill: {tip: m.tip_radius_mm, half: m.half_angle_deg * RAD, length: m.length_mm},
    setup,
    rows: result.positions as unknown as Columns,
    side: up ? -1 : 1,
    pivot: optimise.hold === 'pivot',
    check: {points: 11, window_deg: 40, pitch_deg: 1, qualify_mm: 0.5, ...(request.check as Numbers | undefined)},
  };
  path.rows.omega_deg.forEach((deg, i) => checkPosition(scope, path, deg * RAD, i, String(optimise.bias)));
  const optimised = path.rows.optimised.flatMap((found, i) => (found ? [i] : []));
  const count = (request.positions as number | undefined) ?? 90;
  scope.same('mill_positions', optimised.length, count, 0, '');
  optimised.forEach((row, i) => scope.same('mill_omega', path.rows.omega_deg[row], (360 * i) / count, 1e-9, 'deg', `row ${row}`));
  const figures = ['overcut', 'undercut', 'gap', 'grid_overcut', 'grid_undercut'].flatMap((name) => [`${name}_before_mm`, `${name}_mm`]);
  scope.not('positions/evaluations', 'how often the search of the service measured');
  scope.covers(...['omega_deg', 'c_deg', 'x_mm', 'z_mm', 'b_deg', 'dz_mm', 'db_deg', ...figures].map((name) => `positions/${name}`));
  const face = -(result.swept as Numbers).root_face_min_mm <= path.check.qualify_mm;
  scope.equal('qualified', result.qualified, face && (path.rows.qualified as unknown as boolean[]).every((held) => held));
  checkSwept(
    scope.under('swept'),
    path,
    result.swept as Numbers,
    path.rows.omega_deg.map((_, i) => i),
  );
  checkSwept(scope.under('swept_at_positions'), path, result.swept_at_positions as Numbers, optimised);
  if (result.probe) checkProbe(scope, path, result.probe as Body);
}

/** The first position, the increments, and both depths: at the contacts, and on the ruling with the deepest point. */
function checkPosition(scope: Scope, path: Path, omega: number, row: number, bias: string): void {
  const {surface, mill, setup, rows, check} = path;
  const at = (name: string) => rows[name][row];
  const where = `row ${row}`;
  const start = initial(surface, mill, setup, omega);
  const [own, stated] = [axesOf(setup, moved(path, start, at('dz_mm'), at('db_deg') * RAD)), rowOf(path, row)];
  scope.most('mill_c', Math.abs(wrapped((stated.c - own.c) / RAD)), 2e-9, 'deg', where);
  for (const name of ['x', 'z'] as const) scope.same('mill_axes', stated[name], own[name], 2e-10 + 1e-12 * Math.abs(own[name]), 'mm', where);
  scope.most('mill_b', Math.abs(wrapped((stated.b - own.b) / RAD)), 2e-9, 'deg', where);
  const [n, pitch, reach] = [check.points, check.pitch_deg * RAD, Math.floor(check.window_deg / check.pitch_deg + 1e-9)];
  for (const [end, pose] of [
    ['_before_mm', start],
    ['_mm', {...poseOf(setup, stated), omega}],
  ] as const) {
    const off = (ruling: number, k: number) => flank(mill, pose, ruling, surface.at(ruling, k / (n - 1)));
    const grid = Array.from({length: 2 * reach + 1}, (_, i) => Array.from({length: n}, (_, k) => off(omega + (i - reach) * pitch, k)));
    const deepest = Math.min(...grid.map((ruling) => Math.min(...ruling)));
    const most = (list: number[]) => Math.max(0, ...list);
    scope.same('mill_grid', at(`grid_overcut${end}`), Math.max(0, -deepest), 3e-10, 'mm', where);
    const alike = grid.filter((ruling) => Math.min(...ruling) < deepest + 1e-9).map((ruling) => Math.abs(most(ruling) - at(`grid_undercut${end}`)));
    scope.most('mill_grid', Math.min(...alike), 3e-10, 'mm', where);
    const contacts = Array.from({length: n}, (_, k) => {
      const nearest = grid.reduce((best, ruling, i) => (ruling[k] < grid[best][k] ? i : best), 0);
      const centre = omega + (nearest - reach) * pitch;
      return highest((ruling) => -off(ruling, k), centre - pitch, centre + pitch, 4, 1e-6);
    });
    const gaps = contacts.map(([, value]) => -value);
    scope.same('mill_overcut', at(`overcut${end}`), most(gaps.map((gap) => -gap)), 3e-10, 'mm', where);
    scope.same('mill_undercut', at(`undercut${end}`), most(gaps), 3e-10, 'mm', where);
    const gap = most(gaps.map(Math.abs));
    scope.same('mill_gap', at(`gap${end}`), gap, 3e-10, 'mm', where);
    if (end === '_before_mm') continue;
    scope.equal('qualified', rows.qualified[row], at('overcut_mm') <= check.qualify_mm && at('undercut_mm') <= check.qualify_mm, where);
    if (bias === 'no_overcut') scope.not('positions/certificate_mm', 'without overcut, the bound is not described');
    else
      scope.covers('positions/certificate_mm').same(
        'mill_certificate',
        at('certificate_mm'),
        gap -
          leastGap(
            path,
            pose,
            contacts.map(([ruling], k) => [ruling, k / (n - 1)]),
            gaps,
          ),
        3e-8 + 1e-8 * gap,
        'mm',
        where,
      );
  }
}

/** The least of the largest gap that any two increments reach if gaps change evenly with them: of all triples, the one that leaves most. */
function leastGap(path: Path, pose: Pose, contacts: [number, number][], gaps: number[]): number {
  const step = 1e-5;
  const poses = [moved(path, pose, step, 0), moved(path, pose, -step, 0), moved(path, pose, 0, step), moved(path, pose, 0, -step)];
  const rates = contacts.map(([ruling, v]) => {
    const [a, b, c, d] = poses.map((other) => flank(path.mill, other, ruling, path.surface.at(ruling, v)));
    return [(a - b) / (2 * step), (c - d) / (2 * step)];
  });
  const turn = (i: number, k: number) => rates[i][0] * rates[k][1] - rates[k][0] * rates[i][1];
  let least = 0;
  for (let i = 0; i < gaps.length; i += 1)
    for (let k = i + 1; k < gaps.length; k += 1)
      for (let l = k + 1; l < gaps.length; l += 1) {
        const [a, b, c] = [turn(k, l), turn(l, i), turn(i, k)];
        const size = Math.abs(a) + Math.abs(b) + Math.abs(c);
        if (size > 0) least = Math.max(least, Math.abs(a * gaps[i] + b * gaps[k] + c * gaps[l]) / size);
      }
  return least;
}

/** The motion straight in all axes from one of the chosen rows to the next; of a place the least distance from the tool on its way. */
class Motion {
  private readonly axes: Axes[];
  private readonly poses: Pose[];

  constructor(
    private readonly path: Path,
    chosen: number[],
  ) {
    this.axes = chosen.map((row) => rowOf(path, row));
    this.poses = this.axes.map((axes) => poseOf(path.setup, axes));
  }

  private index = (i: number) => ((i % this.axes.length) + this.axes.length) % this.axes.length;

  /** Between row i, which may lie turns away, and the next. */
  pose(i: number, u: number): Pose {
    const [a, b] = [this.axes[this.index(i)], this.axes[this.index(i + 1)]];
    const to = (name: 'x' | 'z' | 'b') => a[name] + u * (b[name] - a[name]);
    return poseOf(this.path.setup, {c: a.c + u * wrapped((b.c - a.c) / RAD) * RAD, x: to('x'), z: to('z'), b: to('b')});
  }

  /** Rows near a ruling, as many degrees apart. */
  near(ruling: number, apart: number): number[] {
    const step = Math.max(1, Math.floor((apart * this.axes.length) / 360));
    return this.axes.flatMap((_, i) =>
      i % step === 0 && (this.axes.length < 12 || Math.abs(wrapped((this.poses[i].omega - ruling) / RAD)) < this.path.check.window_deg) ? [i] : [],
    );
  }

  /** The way between rows is searched if the nearest row's value is wanted. */
  least(dist: Dist, ruling: number, point: [number, number], rows: number[], wanted: (value: number) => boolean = () => true): number {
    let [best, value] = [0, Infinity];
    const nearer = (i: number) => {
      const found = dist(this.path.mill, this.poses[this.index(i)], ruling, point);
      const lower = found < value;
      if (lower) [best, value] = [i, found];
      return lower;
    };
    rows.forEach(nearer);
    for (const way of [-1, 1]) while (nearer(best + way));
    if (!wanted(value)) return value;
    const off = (i: number) => (u: number) => -dist(this.path.mill, this.pose(i, u), ruling, point);
    return Math.min(value, ...[best - 1, best].map((i) => -highest(off(i), 0, 1, Math.max(4, Math.ceil(360 / this.axes.length)), 1e-4)[1]));
  }
}

/** What the motion leaves, at the rulings of every degree, and how deep it enters the root face. */
function checkSwept(scope: Scope, path: Path, stated: Numbers, chosen: number[]): void {
  const motion = new Motion(path, chosen);
  const {surface, check} = path;
  let [least, most, stock] = [Infinity, -Infinity, -Infinity];
  let deepest = Infinity;
  for (let deg = 0; deg < 360; deg += 1) {
    const ruling = deg * RAD;
    const rows = motion.near(ruling, 6);
    for (let k = 0; k < check.points; k += 1) {
      const point = surface.at(ruling, k / (check.points - 1));
      const value = motion.least(flank, ruling, point, rows);
      [least, most] = [Math.min(least, value), Math.max(most, value)];
      const reached = motion.least(cutter, ruling, point, rows, (found) => found > stock);
      stock = Math.max(stock, reached);
    }
    const [s, y] = surface.at(ruling, 0);
    for (const share of [0, 0.25, 0.5, 0.75, 1])
      deepest = Math.min(
        deepest,
        motion.least(cutter, ruling, [s, y - share * surface.joint.face], rows, (found) => found < deepest + 0.1),
      );
  }
  const own = {flank_min_mm: least, flank_max_mm: most, stock_left_max_mm: stock, root_face_min_mm: deepest};
  for (const [name, value] of Object.entries(own)) {
    const sampled = name.startsWith('root'); // the deepest place lies between the samples
    scope.same(sampled ? 'mill_root_face' : 'mill_swept', stated[name], value, sampled ? 0.04 : 3e-6, 'mm', name);
    scope.covers(name);
  }
}

/** Points of the surface and their distance from the flank: in the first position, and on the way between two rows. */
function checkProbe(scope: Scope, path: Path, probe: Body): void {
  const {surface, setup, mill, rows} = path;
  const motion = new Motion(path, [...rows.omega_deg.keys()]);
  const measured = (point: Numbers, before: boolean, name: string) => {
    const [omega, ruling] = [point.omega_deg * RAD, point.ruling_deg * RAD];
    const place = surface.at(ruling, point.v);
    const own = [-place[0] * Math.sin(ruling), place[0] * Math.cos(ruling), place[1]];
    ['x_mm', 'y_mm', 'z_mm'].forEach((axis, k) => scope.same('probe_place', point[axis], own[k], 3e-10 + 1e-12 * Math.abs(own[k]), 'mm', name));
    const next = rows.omega_deg.findIndex((deg) => deg > point.omega_deg + 1e-9);
    const i = (next < 0 ? rows.omega_deg.length : next) - 1;
    const [from, to] = [rows.omega_deg[i], next < 0 ? 360 : rows.omega_deg[next]];
    const pose = before ? initial(surface, mill, setup, omega) : motion.pose(i, (point.omega_deg - from) / (to - from));
    return flank(mill, pose, ruling, place);
  };
  (probe.points as unknown as Numbers[]).forEach((point, i) => {
    for (const before of [true, false])
      scope.same('probe_distance', point[before ? 'distance_before_mm' : 'distance_mm'], measured(point, before, `point ${i}`), 3e-10, 'mm', `point ${i}`);
  });
  for (const side of ['overcut', 'undercut'])
    for (const end of ['_before', '']) {
      const found = probe[`${side}${end}`] as Numbers;
      scope.same('probe_distance', found.distance_mm, measured(found, end !== '', side), 3e-10, 'mm', side);
      const most = Math.max(...rows[`${side}${end}_mm`]);
      scope.same('probe_deepest', Math.max(0, side === 'overcut' ? -found.distance_mm : found.distance_mm), most, 3e-10, 'mm', side);
    }
  for (const each of ['points/*', 'overcut', 'undercut', 'overcut_before', 'undercut_before'])
    scope.covers(...['omega_deg', 'ruling_deg', 'v', 'x_mm', 'y_mm', 'z_mm', 'distance_mm', 'distance_before_mm'].map((name) => `probe/${each}/${name}`));
}
