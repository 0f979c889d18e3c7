import type {Row} from '../json';
import {column, type Solid, type Vector} from '../picture';
import {choice} from '../words';
import {bounds, partner, type Sizes} from './geometry';

const edgeOf = (points: Row): Vector[] => {
  const [x, y, z] = ['x_mm', 'y_mm', 'z_mm'].map((key) => column(points[key])) as [number[], number[], number[]];
  return x.map((at, i) => [at, y[i] as number, z[i] as number]);
};

/** The place on a closed line that is nearest to p, seen along the tube. */
function nearest(line: Vector[], p: Vector): Vector {
  let best = line[0] as Vector;
  let least = Number.POSITIVE_INFINITY;
  line.forEach((a, i) => {
    const b = line[(i + 1) % line.length] as Vector;
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const long = dx * dx + dy * dy;
    const share = long > 0 ? Math.min(1, Math.max(0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / long)) : 0;
    const at: Vector = [a[0] + share * dx, a[1] + share * dy, a[2] + share * (b[2] - a[2])];
    const off = Math.hypot(p[0] - at[0], p[1] - at[1]);
    if (off < least) [least, best] = [off, at];
  });
  return best;
}

/** The end in space: both walls from the cut on, and the cut between them. */
export function sectionSolid(outerPoints: Row, innerPoints: Row, cutters: Row[], sizes: Sizes): Solid {
  const [outer, inner] = [edgeOf(outerPoints), edgeOf(innerPoints)];
  const [low, high] = bounds([...outer, ...inner].map((p) => p[2]));
  const size = 2 * Math.max(...outer.map((p) => Math.hypot(p[0], p[1])));
  const far = high + 0.9 * size;
  const closed = (line: Vector[]) => [...line, line[0] as Vector];
  const end = (line: Vector[]) => closed(line).map(([x, y]): Vector => [x, y, far]);
  const middle = (low + high) / 2;
  return {
    link: choice('outer'),
    tubes: [],
    ribbons: [
      {a: closed(outer), b: end(outer), tone: 'target'},
      {a: closed(inner), b: end(inner), tone: 'inner'},
      {a: closed(outer), b: closed(outer).map((p) => nearest(inner, p)), tone: 'bevel'},
    ],
    lines: [outer, inner].map((line) => ({points: closed(line), tone: 'ink'})),
    partners: cutters.map((row, i) => partner(row, i, [0, 0, middle], Math.max(1.3 * size, high - low), sizes)),
    centre: [0, 0, middle + 0.2 * size],
    size: Math.max(1.35 * size, 0.8 * (high - low + size)),
    eye: [0.95, -0.75, -0.95],
    up: [0, 0, -1],
  };
}
