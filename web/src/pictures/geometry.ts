import {isRow, type Json, type Row} from '../json';
import type {EndCurve, Frame, Partner, Vector} from '../picture';

export const radians = Math.PI / 180;
export const vector = (value: Json | undefined): Vector => (Array.isArray(value) && value.length === 3 ? value.map(Number) : [0, 0, 1]) as Vector;
export const add = (a: Vector, b: Vector, s = 1): Vector => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const dot = (a: Vector, b: Vector) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const unitVector = (a: Vector): Vector => {
  const length = Math.hypot(...a) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
};

export type Sizes = Map<string, {outer: number; wall: number}>;

/** Outer diameter and wall, also of a tube given by the name of its size. */
export function tube(given: Json | undefined, sizes: Sizes): {outer: number; wall: number} {
  const row = isRow(given) ? given : {};
  const named = typeof row['size'] === 'string' ? sizes.get(row['size']) : undefined;
  return {outer: Number(row['outer_diameter_mm'] ?? named?.outer ?? 50), wall: Number(row['wall_mm'] ?? named?.wall ?? 3)};
}

/** The axis line of a tube given by angles: docs/theory/intersections-and-bevels.md, section 1. */
function axisByAngles(row: Row): {point: Vector; direction: Vector} {
  const a = Number(row['inclination_deg'] ?? 90) * radians,
    b = Number(row['clocking_deg'] ?? 0) * radians;
  const s = Number(row['offset_mm'] ?? 0),
    h = Number(row['height_mm'] ?? 0);
  return {
    point: [-s * Math.cos(b), -s * Math.sin(b), h],
    direction: [Math.sin(a) * Math.sin(b), -Math.sin(a) * Math.cos(b), Math.cos(a)],
  };
}

/**
 * Returns the shape of a cutter, of length `half` in both directions from the point nearest to
 * `near`.
 */
export function partner(row: Row, tone: number, near: Vector, reach: number, sizes: Sizes): Partner {
  if (row['kind'] === 'plane') return {kind: 'plane', point: nearestOnPlane(row, near), normal: unitVector(vector(row['normal'])), half: reach * 0.7, tone};
  const given = isRow(row['axis']) ? {point: vector(row['axis']['point_mm']), direction: unitVector(vector(row['axis']['direction']))} : axisByAngles(row);
  const {outer} = tube(row, sizes);
  const half = reach * 0.7 + outer * 0.35;
  if (row['kind'] === 'elbow') {
    return {
      kind: 'elbow',
      ...given,
      inwards: vector(row['inwards']),
      radius: outer / 2,
      bend: Number(row['bend_radius_mm']),
      angle: Number(row['bend_deg']) * radians,
      half: [reach * 0.5, reach * 0.5],
      tone,
    };
  }
  const along = dot(add(near, given.point, -1), given.direction);
  const point = add(given.point, given.direction, along);
  if (row['kind'] === 'cone') {
    const slope = Math.tan(Number(row['half_angle_deg']) * radians);
    return {kind: 'cone', point, direction: given.direction, radius: outer / 2 + slope * along, slope, half, tone};
  }
  if (row['kind'] === 'rectangular_tube') {
    return {
      kind: 'box',
      point,
      direction: given.direction,
      up: vector(row['up']),
      width: Number(row['width_mm']),
      height: Number(row['height_mm']),
      corner: Number(row['corner_radius_mm']),
      half,
      tone,
    };
  }
  return {kind: 'tube', point, direction: given.direction, radius: outer / 2, half, tone};
}

function nearestOnPlane(row: Row, near: Vector): Vector {
  const normal = unitVector(vector(row['normal']));
  return add(near, normal, -dot(add(near, vector(row['point_mm']), -1), normal));
}

export function frame(value: Json | undefined): Frame | undefined {
  return isRow(value) ? {origin: vector(value['origin_mm']), x: vector(value['x']), y: vector(value['y']), z: vector(value['z'])} : undefined;
}

export const placed = (to: Frame | undefined, p: Vector): Vector => (to ? add(add(add(to.origin, to.x, p[0]), to.y, p[1]), to.z, p[2]) : p);

export const onTube = (radius: number, phi: number, z: number): Vector => [radius * Math.cos(phi * radians), radius * Math.sin(phi * radians), z];

/**
 * Returns the strokes of all texts of a part in space. `at` places a point of the outside; no chord
 * goes further round than `step` mm.
 */
export function strokesOf(result: Row, step: number, at: (girth: number, z: number) => Vector): Vector[][] {
  const marks = (Array.isArray(result['marks']) ? result['marks'] : []).filter(isRow);
  const strokes = marks.flatMap(({lettering}) => (isRow(lettering) ? (lettering['strokes'] as Row[]) : []));
  return strokes.map((stroke) => {
    const [girth, z] = [stroke['girth_mm'], stroke['z_mm']] as [number[], number[]];
    return girth.flatMap((to, i): Vector[] => {
      const [from, low] = [girth[i - 1] ?? to, z[i - 1] ?? (z[i] as number)];
      const parts = i === 0 ? 1 : Math.max(1, Math.ceil(Math.abs(to - from) / step));
      return Array.from({length: parts}, (_, k) => (k + 1) / parts).map((share) => at(from + share * (to - from), low + share * ((z[i] as number) - low)));
    });
  });
}

export function bounds(values: number[]): [number, number] {
  return [values.reduce((a, b) => Math.min(a, b), Infinity), values.reduce((a, b) => Math.max(a, b), -Infinity)];
}

export function squareEnd(z: number): EndCurve {
  const phi = Array.from({length: 96}, (_, i) => 3.75 * i);
  const flat = phi.map(() => z);
  return {phi, zInner: flat, zOuter: flat};
}

const turnedInto = (to: Frame, v: Vector): Vector => [dot(v, to.x), dot(v, to.y), dot(v, to.z)];

function carried(given: Partner, place: (p: Vector) => Vector, turn: (v: Vector) => Vector): Partner {
  const point = place(given.point);
  if (given.kind === 'plane') return {...given, point, normal: turn(given.normal)};
  const direction = turn(given.direction);
  if (given.kind === 'box') return {...given, point, direction, up: turn(given.up)};
  if (given.kind === 'elbow') return {...given, point, direction, inwards: turn(given.inwards)};
  return {...given, point, direction};
}

/** Transforms a partner, given in the coordinates of `to`, into the frame `to`. */
export const seenFrom = (to: Frame | undefined, given: Partner): Partner =>
  to
    ? carried(
        given,
        (p) => turnedInto(to, add(p, to.origin, -1)),
        (v) => turnedInto(to, v),
      )
    : given;

/** Transforms a partner, given in the frame `from`, into the coordinates of that frame. */
export const placedFrom = (from: Frame, given: Partner): Partner =>
  carried(
    given,
    (p) => placed(from, p),
    (v) => placed({...from, origin: [0, 0, 0]}, v),
  );
