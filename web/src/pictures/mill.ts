import {isRow, type Row} from '../json';
import {t} from '../language';
import {column, type Section, type SectionLine, type Tool, type Vector} from '../picture';
import {number} from '../words';
import {add, radians} from './geometry';

/** The mill's axes at one place, mm and degrees. */
interface Axes {
  c: number;
  x: number;
  z: number;
  b: number;
}
interface Pose {
  tip: Vector; // centre of the face
  axis: Vector; // to the spindle
}

const spindle = (b: number): Vector => [Math.sin(b * radians), 0, Math.cos(b * radians)];

/** The tool seen from the tube, in the frame of the groove's curves: docs/theory/grooves-and-milling.md, section 6. */
function poseOf({c, x, z, b}: Axes, setup: Row): Pose {
  const axis = spindle(b);
  const tip = add([x, 0, z - Number(setup['z_zero_mm'] ?? 0)], axis, -Number(setup['pivot_length_mm'] ?? 0));
  const turn = (c - Number(setup['c_zero_deg'] ?? 0)) * radians;
  const seen = ([u, v, w]: Vector): Vector => {
    const [p, q] = [Math.cos(turn) * u + Math.sin(turn) * v, Math.cos(turn) * v - Math.sin(turn) * u];
    return setup['mount'] === 'end_up' ? [q, p, -w] : [-q, p, w];
  };
  return {tip: seen(tip), axis: seen(axis)};
}

export type Cone = Extract<Tool, {kind: 'cone'}>;

/** The cone at each place of the axes; and, where given, before the correction. */
export function coneTool(request: Row, axes: Axes[], before?: Axes[]): Cone {
  const [mill, setup] = [request['mill'] as Row, request['setup'] as Row];
  const [tip, length] = [Number(mill['tip_radius_mm']), Number(mill['length_mm'])];
  const poses = (given: Axes[]) => given.map((each) => poseOf(each, setup));
  const back = tip + length * Math.tan(Number(mill['half_angle_deg']) * radians);
  return {kind: 'cone', tip, back, length, poses: poses(axes), ...(before ? {before: poses(before)} : {})};
}

export function axesOf(positions: Row): Axes[] {
  const [x, z, b] = ['x_mm', 'z_mm', 'b_deg'].map((key) => column(positions[key])) as [number[], number[], number[]];
  return column(positions['c_deg']).map((c, i) => ({c, x: x[i] as number, z: z[i] as number, b: b[i] as number}));
}

/**
 * Returns the axes before the correction: because the tip is held, X and Z had moved so that B
 * turns about it.
 */
export function axesBefore(positions: Row, request: Row): Axes[] {
  const [dz, db] = [column(positions['dz_mm']), column(positions['db_deg'])];
  const pivot = Number((request['setup'] as Row)['pivot_length_mm'] ?? 0);
  const held = isRow(request['optimise']) && request['optimise']['hold'] === 'pivot';
  return axesOf(positions).map((at, i) => {
    const out = {...at, b: at.b - (db[i] as number), z: at.z - (dz[i] as number)};
    if (held) return out;
    const arm = add(spindle(at.b), spindle(out.b), -1);
    return {...out, x: out.x - pivot * arm[0], z: out.z - pivot * arm[2]};
  });
}

/** Radius and height, in the half plane of a section. */
type Flat = [number, number];

/** The groove's curves 1 to 4 at an angle: each as radius and height. */
export interface Curves {
  omega: number[];
  points: [Vector[], Vector[], Vector[], Vector[]];
}

function cornersAt({omega, points}: Curves, at: number): Flat[] {
  const count = omega.length;
  const place = ((((at - (omega[0] as number)) % 360) + 360) % 360) / (360 / count);
  const [i, t] = [Math.floor(place) % count, place - Math.floor(place)];
  const flat = (p: Vector): Flat => [Math.hypot(p[0], p[1]), p[2]];
  return points.map((curve) => {
    const [a, b] = [flat(curve[i] as Vector), flat(curve[(i + 1) % count] as Vector)];
    return [a[0] * (1 - t) + b[0] * t, a[1] * (1 - t) + b[1] * t];
  });
}

/** The cutter's outline where its axis lies in the half plane. */
function outline({tip: point, axis}: Pose, {tip, back, length}: Cone): Flat[] {
  const out = Math.hypot(point[0], point[1]);
  const unit: Flat = [point[0] / out, point[1] / out];
  const along: Flat = [axis[0] * unit[0] + axis[1] * unit[1], axis[2]];
  const at = (u: number, v: number): Flat => [out + u * along[0] - v * along[1], point[2] + u * along[1] + v * along[0]];
  return [at(0, -tip), at(0, tip), at(length, back), at(length, -back)];
}

/** The wall, the groove in it and the cutter, cut through at the cursor: everything that the plane shows, at one scale. */
export function sectionOf(link: string, curves: Curves, omega: number[], tool?: Cone): Section {
  const all = omega.map((at) => cornersAt(curves, at));
  const high = Math.max(...all.map((corners) => (corners[3] as Flat)[1] - (corners[0] as Flat)[1]));
  const [thin, thick] = [(all[0]?.[0] as Flat)[0], (all[0]?.[3] as Flat)[0]];
  const wall = thick - thin;
  const reach = tool ? 2 * tool.tip : 0;
  return {
    link,
    count: omega.length,
    low: [-0.5 * wall, -0.3 * wall - reach * 0.6],
    high: [wall + Math.max(wall, reach * 1.2), high + 1.2 * wall],
    at: (i) => {
      const corners = all[i % all.length] as Flat[];
      const base = (corners[0] as Flat)[1];
      const moved = (flat: Flat[]): Flat[] => flat.map(([s, z]) => [s - thin, z - base]);
      const top = base + high + 2 * wall;
      const lines: SectionLine[] = [{points: moved([...corners, [thick, top], [thin, top]]), tone: 'steel'}];
      if (tool?.before) lines.push({points: moved(outline(tool.before[i % all.length] as Pose, tool)), tone: 'before', dashed: true});
      if (tool) lines.push({points: moved(outline(tool.poses[i % all.length] as Pose, tool)), tone: 'after'});
      return {title: t('Section at ω {angle}°', {angle: number(omega[i % all.length] as number, '°')}), lines, moved: ([s, z]) => [s - thin, z - base]};
    },
  };
}
