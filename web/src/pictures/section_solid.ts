import type {Row} from '../json';
import {column, type Shell, type Solid, type Vector} from '../picture';
import {bounds, partner, type Sizes} from './geometry';

export const edgeOf = (points: Row): Vector[] => {
  const [x, y, z] = ['x_mm', 'y_mm', 'z_mm'].map((key) => column(points[key])) as [number[], number[], number[]];
  return x.map((at, i) => [at, y[i] as number, z[i] as number]);
};

/** The place outside at a way round from the middle of face 1, which lies at +x. */
export function outside(section: Row, girth: number): [x: number, y: number] {
  const [height, width, r] = ['height_mm', 'width_mm', 'corner_radius_mm'].map((key) => Number(section[key])) as [number, number, number];
  const flats = [width - 2 * r, height - 2 * r] as const; // of faces 1 and 3; of 2 and 4
  const arc = (Math.PI / 2) * r;
  let rest = girth + flats[0] / 2;
  for (let turn = 0; ; turn += 1) {
    const flat = flats[turn % 2] as number;
    // Of a face: its normal, and the direction of growing girth.
    const [nx, ny] = [Math.round(Math.cos((turn * Math.PI) / 2)), Math.round(Math.sin((turn * Math.PI) / 2))];
    const away = (turn % 2 ? width : height) / 2;
    const along = Math.min(rest, flat) - flat / 2;
    const [x, y] = [nx * (away - r) - ny * along, ny * (away - r) + nx * along];
    const angle = r > 0 ? Math.max(0, rest - flat) / r : 0;
    if (rest <= flat + arc || turn > 4) return [x + r * (nx * Math.cos(angle) - ny * Math.sin(angle)), y + r * (ny * Math.cos(angle) + nx * Math.sin(angle))];
    rest -= flat + arc;
  }
}

/** The whole way round outside. */
export function girthOf(section: Row): number {
  const [height, width, r] = ['height_mm', 'width_mm', 'corner_radius_mm'].map((key) => Number(section[key])) as [number, number, number];
  return 2 * (height + width) - (8 - 2 * Math.PI) * r;
}

/** The stretches of the way round where the outline is round, from the corner after face 1 on. */
export function cornersOf(section: Row): [from: number, to: number][] {
  const [height, width, r] = ['height_mm', 'width_mm', 'corner_radius_mm'].map((key) => Number(section[key])) as [number, number, number];
  const arc = (Math.PI / 2) * r;
  const flats = [width - 2 * r, height - 2 * r];
  let at = (flats[0] as number) / 2;
  return [1, 2, 3, 4].flatMap((face): [number, number][] => {
    const from = at;
    at = from + arc + (flats[face % 2] as number);
    return r > 0 ? [[from, from + arc]] : [];
  });
}

/** Both edges of a table, row by row: the inner one at the end of each line across the wall. */
export function edgesOf(section: Row, points: Row): [outer: Vector[], inner: Vector[]] {
  const of = (name: string) => column(points[name]);
  const [wall, normal, zInner] = [of('wall_mm'), of('normal_deg'), of('z_inner_mm')];
  const places = of('girth_mm').map((girth) => outside(section, girth));
  const outer = places.map(([x, y], i): Vector => [x, y, of('z_outer_mm')[i] as number]);
  const inner = places.map(([x, y], i): Vector => {
    const nu = ((normal[i] as number) * Math.PI) / 180;
    return [x - (wall[i] as number) * Math.cos(nu), y - (wall[i] as number) * Math.sin(nu), zInner[i] as number];
  });
  return [outer, inner];
}

/** One wall's edge of an end: the way round, ascending, and the place. */
interface Curve {
  girth: number[];
  at: Vector[];
}

/** The place at a way round; where a curve jumps, before the jump or after it. */
function placeAt({girth, at}: Curve, whole: number, way: number, after: boolean): Vector {
  const next = girth.findIndex((each) => (after ? each > way : each >= way));
  const last = girth.length - 1;
  const [i, j] = [next < 0 ? last : next - 1, next < 0 ? 0 : next];
  const [a, b] = [at[i < 0 ? last : i] as Vector, at[j] as Vector];
  const from = i < 0 ? (girth[last] as number) - whole : (girth[i] as number);
  const to = next < 0 ? (girth[0] as number) + whole : (girth[j] as number);
  const share = to > from ? (way - from) / (to - from) : 0;
  return [0, 1, 2].map((k) => (a[k] as number) + share * ((b[k] as number) - (a[k] as number))) as Vector;
}

/** A wall between two edges, in columns along the tube: one at every point of either, because the ends have points of their own. */
export function wallBetween(whole: number, from: Curve, to: Curve): [from: Vector[], to: Vector[]] {
  const columns = [from, to].flatMap((own, side) =>
    own.girth.map((way, i) => {
      const before = own.girth[i + 1] === way && own.girth[i - 1] !== way;
      const mine = own.at[i] as Vector;
      const other = placeAt(side ? from : to, whole, way, !before);
      return {way, rank: before ? 0 : 1, a: side ? other : mine, b: side ? mine : other};
    }),
  );
  columns.sort((a, b) => a.way - b.way || a.rank - b.rank);
  return [columns.map(({a}) => a), columns.map(({b}) => b)];
}

/** One end of a member: each edge over its own way round. */
export interface ShellEnd {
  outer: Curve;
  inner: Curve;
}

/** An end of a finished part, by its rows. */
export function endOf(section: Row, points: Row): ShellEnd {
  const girth = column(points['girth_mm']);
  const [outer, inner] = edgesOf(section, points);
  return {outer: {girth, at: outer}, inner: {girth, at: inner}};
}

/** An end that is cut square. `bore`: if its way round is its own. */
export function squareShell(section: Row, z: number, bore?: Row): ShellEnd {
  const steps = 6; // of a corner
  const line = (of: Row): Curve => {
    const girth = [0, ...cornersOf(of).flatMap(([from, to]) => Array.from({length: steps + 1}, (_, i) => from + ((to - from) * i) / steps))];
    return {girth, at: girth.map((way): Vector => [...outside(of, way), z])};
  };
  const outer = line(section);
  if (bore) return {outer, inner: line(bore)};
  const [halfX, halfY, r, wall] = [
    Number(section['height_mm']) / 2,
    Number(section['width_mm']) / 2,
    Number(section['corner_radius_mm']),
    Number(section['wall_mm']),
  ];
  const inner = outer.at.map(([x, y]): Vector => {
    const beyond = (at: number, half: number) => Math.max(0, Math.abs(at) - half + r) * Math.sign(at);
    const [dx, dy] = [beyond(x, halfX), beyond(y, halfY)];
    const off = Math.hypot(dx, dy) || 1;
    return [x - (wall * dx) / off, y - (wall * dy) / off, z];
  });
  return {outer, inner: {girth: outer.girth, at: inner}};
}

/** The member between two ends, seen in one frame. `whole`: the ways round outside, and round the bore if its curves have ways of their own. */
export function shellOf([from, to]: [ShellEnd, ShellEnd], whole: {outer: number; inner: number}): Shell {
  const closed = ([a, b]: [Vector[], Vector[]]): [Vector[], Vector[]] => [
    [...a, a[0] as Vector],
    [...b, b[0] as Vector],
  ];
  const cut = ({outer, inner}: ShellEnd) => ({outer: outer.at, inner: outer.at.map((p) => nearest(inner.at, p))});
  return {
    reach: Math.max(...from.outer.at.map(([x, y]) => Math.hypot(x, y))),
    walls: {
      outer: closed(wallBetween(whole.outer, from.outer, to.outer)),
      bore: closed(wallBetween(whole.inner, from.inner, to.inner)),
    },
    cuts: [cut(from), cut(to)],
  };
}

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
export function sectionSolid(link: string, [outer, inner]: [Vector[], Vector[]], cutters: Row[], sizes: Sizes): Solid {
  const [low, high] = bounds([...outer, ...inner].map((p) => p[2]));
  const size = 2 * Math.max(...outer.map((p) => Math.hypot(p[0], p[1])));
  const far = high + 0.9 * size;
  const closed = (line: Vector[]) => [...line, line[0] as Vector];
  const end = (line: Vector[]) => closed(line).map(([x, y]): Vector => [x, y, far]);
  const middle = (low + high) / 2;
  return {
    link,
    tubes: [],
    ribbons: [
      {a: closed(outer), b: end(outer), tone: 'steel'},
      {a: closed(inner), b: end(inner), tone: 'bore'},
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
