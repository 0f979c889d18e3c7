/** Vectors, turns and frames; quadrature and searches of one variable. */
export type V3 = readonly [number, number, number];

export interface Frame {
  x: V3;
  y: V3;
  z: V3;
  origin: V3;
}

export const UP: V3 = [0, 0, 1];
export const RAD = Math.PI / 180;
/** An angle in degrees, from -180 on and below 180. */
export const wrapped = (deg: number): number => ((((deg + 180) % 360) + 360) % 360) - 180;
export const add = (a: V3, b: V3): V3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: V3, b: V3): V3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const mul = (a: V3, k: number): V3 => [a[0] * k, a[1] * k, a[2] * k];
export const dot = (a: V3, b: V3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: V3, b: V3): V3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const norm = (a: V3): number => Math.hypot(a[0], a[1], a[2]);
export const unit = (a: V3): V3 => mul(a, 1 / norm(a));
export const across = (a: V3, axis: V3): V3 => sub(a, mul(axis, dot(a, axis)));
export const mix = (a: V3, b: V3, t: number): V3 => add(mul(a, 1 - t), mul(b, t));

/** A point of the cylinder of radius `rho` about z. */
export const onTube = (rho: number, phi: number, z: number): V3 => [rho * Math.cos(phi), rho * Math.sin(phi), z];

export const inFrame = (f: Frame, p: V3): V3 => directionIn(f, sub(p, f.origin));
export const directionIn = (f: Frame, d: V3): V3 => [dot(d, f.x), dot(d, f.y), dot(d, f.z)];
export const toWorld = (f: Frame, p: V3): V3 => add(f.origin, directionToWorld(f, p));
export const directionToWorld = (f: Frame, d: V3): V3 => add(add(mul(f.x, d[0]), mul(f.y, d[1])), mul(f.z, d[2]));

/** How far the frame is from a right-handed one of unit axes. */
export const skew = (f: Frame): number =>
  Math.max(
    ...[f.x, f.y, f.z].map((v) => Math.abs(norm(v) - 1)),
    Math.abs(dot(f.x, f.y)),
    Math.abs(dot(f.y, f.z)),
    Math.abs(dot(f.z, f.x)),
    norm(sub(cross(f.x, f.y), f.z)),
  );

/** Distance of a point to the line through `q` along the unit vector `d`. */
export const lineDistance = (p: V3, q: V3, d: V3): number => norm(cross(sub(p, q), d));

const nodes = [0.1834346424956498, 0.525532409916329, 0.7966664774136267, 0.9602898564975363];
const weights = [0.362683783378362, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763];

/** The integral of f from a to b: Gauss' rule of eight points, halved until both halves agree with the whole, or `depth` is used up. */
export function integral(f: (t: number) => number, a: number, b: number, tolerance: number, depth = 24): number {
  const whole = gauss(f, a, b);
  const split = (from: number, to: number, value: number, allowed: number, left: number): number => {
    const middle = (from + to) / 2;
    const [first, second] = [gauss(f, from, middle), gauss(f, middle, to)];
    if (left === 0 || Math.abs(first + second - value) <= allowed) return first + second;
    return split(from, middle, first, allowed / 2, left - 1) + split(middle, to, second, allowed / 2, left - 1);
  };
  return split(a, b, whole, tolerance, depth);
}

function gauss(f: (t: number) => number, a: number, b: number): number {
  const [c, h] = [(a + b) / 2, (b - a) / 2];
  let sum = 0;
  for (let i = 0; i < 4; i += 1) sum += weights[i] * (f(c - h * nodes[i]) + f(c + h * nodes[i]));
  return sum * h;
}

/** Where f changes its sign between a and b, to the last digit. */
export function root(f: (t: number) => number, a: number, b: number): number {
  const below = f(a) < 0;
  for (let i = 0; i < 200; i += 1) {
    const middle = (a + b) / 2;
    if (middle === a || middle === b) break;
    if (f(middle) < 0 === below) a = middle;
    else b = middle;
  }
  return (a + b) / 2;
}

/** The place and value of the largest f between a and b: the best of `count` samples, then golden sections about it down to `width` of their step. */
export function highest(f: (t: number) => number, a: number, b: number, count = 24, width = 1e-9): [number, number] {
  let best = a;
  let value = f(a);
  const step = (b - a) / count;
  for (let i = 1; i <= count; i += 1) {
    const v = f(a + i * step);
    if (v > value) [best, value] = [a + i * step, v];
  }
  let [low, high] = [Math.max(a, best - step), Math.min(b, best + step)];
  const g = (Math.sqrt(5) - 1) / 2;
  let [s, t] = [high - g * (high - low), low + g * (high - low)];
  let [left, right] = [f(s), f(t)];
  for (let i = 0; i < 48 && high - low > width * step; i += 1) {
    if (left > value) [best, value] = [s, left];
    if (right > value) [best, value] = [t, right];
    if (left >= right) {
      [high, t, right] = [t, s, left];
      s = high - g * (high - low);
      left = f(s);
    } else {
      [low, s, left] = [s, t, right];
      t = low + g * (high - low);
      right = f(t);
    }
  }
  return [best, value];
}
