/** Points, directions and rigid motions with a scale; a matrix is its three axes and its origin, in columns. */
export type Vector = [number, number, number];

export interface Matrix {
  x: Vector;
  y: Vector;
  z: Vector;
  origin: Vector;
}

export const identity: Matrix = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], origin: [0, 0, 0]};

export const add = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a: Vector, k: number): Vector => [a[0] * k, a[1] * k, a[2] * k];
export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a: Vector): number => Math.hypot(a[0], a[1], a[2]);
export const distance = (a: Vector, b: Vector): number => length(minus(a, b));
export const cross = (a: Vector, b: Vector): Vector => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** Returns the direction of a vector; undefined for a zero vector. */
export function unit(a: Vector): Vector | undefined {
  const long = length(a);
  return long > 0 && Number.isFinite(long) ? times(a, 1 / long) : undefined;
}

export const turned = (m: Matrix, v: Vector): Vector => add(add(times(m.x, v[0]), times(m.y, v[1])), times(m.z, v[2]));
export const placed = (m: Matrix, p: Vector): Vector => add(turned(m, p), m.origin);

/** First `inner`, then `outer`. */
export const after = (outer: Matrix, inner: Matrix): Matrix => ({
  x: turned(outer, inner.x),
  y: turned(outer, inner.y),
  z: turned(outer, inner.z),
  origin: placed(outer, inner.origin),
});
