import type {Block, Face, Row} from './text.js';

/** How the blocks of a file lie on the tube. */
export interface Frame {
  /** A round tube, developed on one face; a tube drawn face by face. */
  kind: 'developed' | 'faces';
  round: boolean;
  height: number;
  width: number;
  wall: number;
  girth: number;
}

/** A point of an end's outer edge, in the part's frame: x to face 1 or phi 0, y to face 2; `at` along the tube. */
export interface EdgePoint {
  x: number;
  y: number;
  at: number;
}
/** One face's edge of an end; it leans if the file states a weld preparation for it. */
export interface Edge {
  face: Face;
  points: EdgePoint[];
  leans: boolean;
}

/** The way across a face: the face of the part, and whether its y grows the way girth does. */
export const faces: Record<Face, {face: number; sign: 1 | -1; tall: boolean}> = {
  o: {face: 1, sign: 1, tall: false},
  v: {face: 2, sign: -1, tall: true},
  u: {face: 3, sign: -1, tall: false},
  h: {face: 4, sign: 1, tall: true},
};
export const acrossOf = (frame: Frame, face: Face): number => (frame.kind === 'developed' ? frame.girth : faces[face].tall ? frame.height : frame.width);

/** A place on the outside of the part, on the sharp rectangle where the tube has faces. */
export function placeOf(frame: Frame, face: Face, at: number, y: number): EdgePoint {
  if (frame.kind === 'developed') {
    const phi = (-2 * Math.PI * y) / frame.girth;
    return {x: (frame.height / 2) * Math.cos(phi), y: (frame.height / 2) * Math.sin(phi), at};
  }
  const [tall, wide] = [frame.height / 2, frame.width / 2];
  if (face === 'v' || face === 'h') return {x: y - tall, y: face === 'v' ? wide : -wide, at};
  return {x: face === 'o' ? tall : -tall, y: y - wide, at};
}

const near = 0.02; // mm: of a point at the side of an outline; files have two or three decimals

const first = ({values}: Row): number => values[0]?.value ?? Number.NaN;
const second = ({values}: Row): number => values[1]?.value ?? Number.NaN;
/** The weld preparation of the way that begins at a row. */
const prepared = ({values}: Row): boolean => values.slice(3).some(({value}) => value !== 0);

/**
 * Divides an outline into the edges of its two ends, the start's first. Undefined if the outline does not go along both sides
 * once: it has a notch there, or is not as wide as its face.
 */
export function endsOf(frame: Frame, {rows}: Block, face: Face): [Edge, Edge] | undefined {
  const across = acrossOf(frame, face);
  const sideOf = (row: Row): 0 | 1 | undefined => (Math.abs(second(row)) <= near ? 0 : Math.abs(second(row) - across) <= near ? 1 : undefined);
  const open =
    rows.length > 1 && first(rows[0] as Row) === first(rows[rows.length - 1] as Row) && second(rows[0] as Row) === second(rows[rows.length - 1] as Row);
  const ring = open ? rows.slice(0, -1) : rows;
  const along = ring.map((row, i) => sideOf(row) !== undefined && sideOf(row) === sideOf(ring[(i + 1) % ring.length] as Row));
  const begins = along.findIndex((side, i) => side && !along[(i + 1) % ring.length]);
  if (begins < 0) return undefined;
  const chains: Row[][] = [];
  for (let i = 1; i <= ring.length; ++i) {
    const at = (begins + i) % ring.length;
    if (along[(at - 1 + ring.length) % ring.length]) chains.push([]);
    chains[chains.length - 1]?.push(ring[at] as Row);
  }
  // A side of more than two points has chains of one point each.
  const edges = chains.filter((chain) => chain.length > 1 && sideOf(chain[0] as Row) !== sideOf(chain[chain.length - 1] as Row));
  const notches = chains.some((chain) => chain.length > 1 && !edges.includes(chain));
  if (edges.length !== 2 || notches) return undefined;
  const mean = (chain: Row[]): number => chain.reduce((sum, row) => sum + first(row), 0) / chain.length;
  const [start, finish] = edges.sort((a, b) => mean(a) - mean(b)) as [Row[], Row[]];
  const edge = (chain: Row[]): Edge => ({
    face,
    points: chain.map((row) => placeOf(frame, face, first(row), second(row))),
    leans: chain.slice(0, -1).some(prepared),
  });
  return [edge(start), edge(finish)];
}

/** The plane at = a + b x + c y. */
export interface Slope {
  a: number;
  b: number;
  c: number;
  /** Largest distance of a point from it, along the tube. */
  off: number;
  /** Whether points lie at two places or more along x, and along y. */
  known: {b: boolean; c: boolean};
}

/** Solves three equations; undefined if they do not determine the unknowns. */
function solved(m: number[][]): number[] | undefined {
  for (let i = 0; i < m.length; ++i) {
    const pivot = m.slice(i).reduce((best, row) => (Math.abs(row[i] as number) > Math.abs(best[i] as number) ? row : best));
    const at = m.indexOf(pivot);
    [m[i], m[at]] = [pivot, m[i] as number[]];
    if (Math.abs(pivot[i] as number) < 1e-9) return undefined;
    for (const row of m)
      if (row !== pivot) {
        const by = (row[i] as number) / (pivot[i] as number);
        row.forEach((_, k) => {
          row[k] = (row[k] as number) - by * (pivot[k] as number);
        });
      }
  }
  return m.map((row, i) => (row[m.length] as number) / (row[i] as number));
}

const spread = (values: number[]): number =>
  values.reduce((most, v) => Math.max(most, v), -Infinity) - values.reduce((least, v) => Math.min(least, v), Infinity);

/** The nearest plane to points, by least squares; a slope that the points leave open is 0. */
export function planeThrough(points: EdgePoint[], size: number): Slope | undefined {
  if (points.length === 0) return undefined;
  const known = {b: spread(points.map(({x}) => x)) > 0.1 * size, c: spread(points.map(({y}) => y)) > 0.1 * size};
  const middle = points.reduce((sum, {at}) => sum + at, 0) / points.length;
  const columns = points.map(({x, y}) => [1, ...(known.b ? [x / size] : []), ...(known.c ? [y / size] : [])]);
  const count = (columns[0] as number[]).length;
  const matrix = Array.from({length: count}, (_, i) => [
    ...Array.from({length: count}, (_, j) => columns.reduce((sum, row) => sum + (row[i] as number) * (row[j] as number), 0)),
    columns.reduce((sum, row, k) => sum + (row[i] as number) * ((points[k] as EdgePoint).at - middle), 0),
  ]);
  const found = solved(matrix);
  if (!found) return undefined;
  const rest = found.slice(1).map((each) => each / size);
  const [a, b, c] = [(found[0] as number) + middle, known.b ? (rest.shift() as number) : 0, known.c ? (rest.shift() as number) : 0];
  const off = points.reduce((most, {x, y, at}) => Math.max(most, Math.abs(at - a - b * x - c * y)), 0);
  return {a, b, c, off, known};
}
