/** Bodies that cut a tube, by signed distance: of each the surface that lies `grown` outside its own. Frame: the target's, z into the kept member. */
import type {Json} from './json.js';
import {across, add, cross, dot, type Frame, inFrame, directionIn, lineDistance, mul, norm, RAD, sub, unit, type V3} from './space.js';

export interface Solid {
  id: string;
  distance: (p: V3) => number; // below 0 inside
  normal: (p: V3) => V3; // outwards
  top: (x: number, y: number) => number | undefined; // highest z of the body over a place of the target's section
  /** By how much the surface moves, normal to itself, for each mm of its radius; a body without radius has none. */
  rate: number | undefined;
  convex: boolean;
}

export type Body = {[name: string]: Json};
export type Numbers = {[name: string]: number};
export interface Size {
  outer_diameter_mm: number;
  wall_mm: number;
}

const v3 = (value: Json | undefined): V3 => value as unknown as V3;
const num = (value: Json | undefined, otherwise = 0): number => (typeof value === 'number' ? value : otherwise);

/** Sizes by name. CHS names state their own. */
export function sizeOf(body: Body, sizes: ReadonlyMap<string, Size>): Size {
  if (typeof body.size !== 'string') return {outer_diameter_mm: num(body.outer_diameter_mm), wall_mm: num(body.wall_mm)};
  const known = sizes.get(body.size);
  if (known) return known;
  const chs = /^CHS ([0-9.]+)x([0-9.]+)$/.exec(body.size);
  if (chs) return {outer_diameter_mm: Number(chs[1]), wall_mm: Number(chs[2])};
  throw new Error(`unknown size ${body.size}: give the answer of GET /v1/tubes`);
}

/** A section that is not round. */
export interface Section {
  height_mm: number;
  width_mm: number;
  wall_mm: number;
  corner_radius_mm: number;
  inner_corner_radius_mm?: number; // without it, corners are concentric
}
export const isSection = (body: Body): boolean => (body.kind ?? 'round') !== 'round' || /^(?!NPS |CHS )./.test(String(body.size ?? ''));

/** Outside, by the wall, as the standards calculate; names of sizes end in their standard. */
const corners: {[standard: string]: (wall: number) => number} = {
  en_10210: (t) => 1.5 * t,
  en_10219: (t) => (t <= 6 ? 2 : t <= 10 ? 2.5 : 3) * t,
  astm_a500: (t) => 2 * t,
};

/** The section of a target or member that is not round. */
export function sectionOf(body: Body, sections: ReadonlyMap<string, Section>): Section {
  if (typeof body.size === 'string') {
    const known = sections.get(body.size);
    if (known) return known;
    const named = /^[RS]HS ([0-9.]+)x([0-9.]+)x([0-9.]+) EN (10210|10219)$/.exec(body.size);
    if (!named) throw new Error(`unknown size ${body.size}: give the answer of GET /v1/tubes`);
    const [height_mm, width_mm, wall_mm] = named.slice(1, 4).map(Number) as [number, number, number];
    return nominal(`en_${named[4]}`, {height_mm, width_mm, wall_mm});
  }
  const [height_mm, width_mm, wall_mm] = [num(body.height_mm), num(body.width_mm), num(body.wall_mm)];
  if (typeof body.corners === 'string') return nominal(body.corners, {height_mm, width_mm, wall_mm});
  const round = body.kind === 'flat_oval_tube' ? Math.min(height_mm, width_mm) / 2 : num(body.corner_radius_mm);
  const bore = typeof body.inner_corner_radius_mm === 'number' ? {inner_corner_radius_mm: body.inner_corner_radius_mm} : {};
  return {height_mm, width_mm, wall_mm, corner_radius_mm: round, ...bore};
}

/** Hot-finished corners are not concentric. */
function nominal(standard: string, sides: Pick<Section, 'height_mm' | 'width_mm' | 'wall_mm'>): Section {
  const bore = standard === 'en_10210' ? {inner_corner_radius_mm: sides.wall_mm} : {};
  return {...sides, corner_radius_mm: corners[standard](sides.wall_mm), ...bore};
}

export const girthOf = (s: Section): number => 2 * (s.height_mm + s.width_mm) - (8 - 2 * Math.PI) * s.corner_radius_mm;

/** The place outside at a way round from the middle of face 1, which lies at +x. */
export function onOutline({height_mm, width_mm, corner_radius_mm: r}: Section, girth: number): [number, number] {
  const arc = (Math.PI / 2) * r;
  let rest = girth + width_mm / 2 - r;
  for (let face = 0; ; face += 1) {
    const [away, flat] = face % 2 ? [width_mm / 2, height_mm - 2 * r] : [height_mm / 2, width_mm - 2 * r];
    const turn = (face * Math.PI) / 2;
    const angle = r > 0 ? Math.min(Math.max(rest - flat, 0) / r, Math.PI / 2) : 0;
    if (rest <= flat + arc || face > 4) {
      const [out, along] = [away - r + r * Math.cos(angle), Math.min(rest, flat) - flat / 2 + r * Math.sin(angle)];
      return [out * Math.cos(turn) - along * Math.sin(turn), out * Math.sin(turn) + along * Math.cos(turn)];
    }
    rest -= flat + arc;
  }
}

/** A member that is not round as a partner: its height lies along its `up`. */
export function boxOf(member: Body, section: Section, grown: number, frame?: Frame): Solid {
  const [from, to] = [v3(member.start_mm), v3(member.end_mm)];
  const turn = (d: V3) => (frame ? directionIn(frame, d) : d);
  const d = unit(sub(to, from));
  const v = unit(across(v3(member.up), d));
  const half = [section.width_mm / 2 + grown, section.height_mm / 2 + grown, Math.max(0, section.corner_radius_mm + grown)] as const;
  return box(String(member.id), frame ? inFrame(frame, from) : from, turn(cross(v, d)), turn(v), ...half);
}

/** The axis of a partner that is given by angles or by its own line: a point and a unit direction. */
export function axisOf(body: Body): [V3, V3] {
  const axis = body.axis as Body | undefined;
  if (axis) return [v3(axis.point_mm), unit(v3(axis.direction))];
  const [a, b, s, h] = [num(body.inclination_deg) * RAD, num(body.clocking_deg) * RAD, num(body.offset_mm), num(body.height_mm)];
  return [
    [-s * Math.cos(b), -s * Math.sin(b), h],
    [Math.sin(a) * Math.sin(b), -Math.sin(a) * Math.cos(b), Math.cos(a)],
  ];
}

/** The body in the frame, of which its request has world coordinates; without a frame the request is of the target's. */
export function solid(body: Body, grown: number, sizes: ReadonlyMap<string, Size>, frame?: Frame): Solid {
  const place = (p: V3) => (frame ? inFrame(frame, p) : p);
  const turn = (d: V3) => (frame ? directionIn(frame, d) : d);
  const id = String(body.id ?? '');
  if (body.kind === 'plane') return plane(id, place(v3(body.point_mm)), turn(unit(v3(body.normal))), grown);
  const [point, along] = axisOf(body);
  const [q, d] = [place(point), turn(along)];
  const diameter = () => sizeOf(body, sizes).outer_diameter_mm / 2;
  if (body.kind === 'rectangular_tube') {
    const v = unit(across(turn(v3(body.up)), d));
    const [a, b, c] = [num(body.width_mm) / 2 + grown, num(body.height_mm) / 2 + grown, num(body.corner_radius_mm) + grown];
    return box(id, q, cross(v, d), v, a, b, c);
  }
  if (body.kind === 'cone') return cone(id, q, d, diameter(), num(body.half_angle_deg) * RAD, grown);
  if (body.kind === 'elbow')
    return elbow(id, q, d, unit(across(turn(v3(body.inwards)), d)), num(body.bend_radius_mm), num(body.bend_deg) * RAD, diameter() + grown);
  return tube(id, q, d, diameter() + grown);
}

export function plane(id: string, q: V3, along: V3, grown: number): Solid {
  const n = along[2] < 0 ? mul(along, -1) : along;
  return {
    id,
    convex: true,
    rate: undefined,
    distance: (p) => dot(sub(p, q), n) - grown,
    normal: () => n,
    top: (x, y) => q[2] + (grown - n[0] * (x - q[0]) - n[1] * (y - q[1])) / n[2],
  };
}

export function tube(id: string, point: V3, d: V3, r: number): Solid {
  const q = across(point, d); // the place of the axis nearest to the origin keeps the most digits
  return {
    id,
    convex: true,
    rate: 1,
    distance: (p) => lineDistance(p, q, d) - r,
    normal: (p) => unit(across(sub(p, q), d)),
    top: (x, y) => last([x, y, 0], q, d, r, 0),
  };
}

/** The largest z at which the line over (x, y) lies `r + k s` from the axis, s the way along the axis. */
function last(p: V3, q: V3, d: V3, r: number, k: number): number | undefined {
  const w = across([0, 0, 1], d);
  const m = across(sub(p, q), d);
  const s = dot(sub(p, q), d);
  // |m + z w|^2 = (r + k (s + z d_z))^2
  const [f, g] = [r + k * s, k * d[2]];
  const a = dot(w, w) - g * g;
  const b = dot(m, w) - f * g;
  const beside = norm(cross(m, w));
  const square = k === 0 ? (norm(w) * r - beside) * (norm(w) * r + beside) : b * b - a * (dot(m, m) - f * f);
  if (square < 0) return undefined;
  const z = (-b + Math.sqrt(square)) / a;
  return f + g * z >= 0 ? z : undefined;
}

function cone(id: string, q: V3, d: V3, r: number, half: number, grown: number): Solid {
  const k = Math.tan(half);
  const wide = r + grown / Math.cos(half);
  return {
    id,
    convex: true,
    rate: Math.cos(half),
    distance: (p) => (lineDistance(p, q, d) - wide - k * dot(sub(p, q), d)) * Math.cos(half),
    normal: (p) => sub(mul(unit(across(sub(p, q), d)), Math.cos(half)), mul(d, Math.sin(half))),
    top: (x, y) => last([x, y, 0], q, d, wide, k),
  };
}

/** A rounded rectangle of half sides a along u and b along v, corners of radius c. */
function box(id: string, q: V3, u: V3, v: V3, a: number, b: number, c: number): Solid {
  const local = (p: V3): [number, number] => [dot(sub(p, q), u), dot(sub(p, q), v)];
  const off = (s: number, t: number) => {
    const [e, f] = [Math.abs(s) - a + c, Math.abs(t) - b + c];
    return (e > 0 && f > 0 ? Math.hypot(e, f) : Math.max(e, f)) - c;
  };
  const normal = (p: V3): V3 => {
    const [s, t] = local(p);
    const [e, f] = [Math.abs(s) - a + c, Math.abs(t) - b + c];
    const [m, n] = e > 0 && f > 0 ? [e / Math.hypot(e, f), f / Math.hypot(e, f)] : e > f ? [1, 0] : [0, 1];
    return add(mul(u, m * Math.sign(s)), mul(v, n * Math.sign(t)));
  };
  return {
    id,
    convex: true,
    rate: undefined,
    distance: (p) => off(...local(p)),
    normal,
    top: (x, y) => {
      const [s, t] = local([x, y, 0]);
      const [m, n] = [u[2], v[2]];
      const places: number[] = [];
      for (const side of [-1, 1]) {
        if (m) places.push((side * a - s) / m);
        if (n) places.push((side * b - t) / n);
        for (const other of [-1, 1]) {
          const [e, f] = [s - side * (a - c), t - other * (b - c)];
          const [l, h] = [m * m + n * n, m * e + n * f];
          const square = l * c * c - (m * f - n * e) ** 2;
          if (square >= 0) places.push((-h + Math.sqrt(square)) / l);
        }
      }
      const met = places.filter((z) => Math.abs(off(s + m * z, t + n * z)) < 1e-8);
      return met.length ? Math.max(...met) : undefined;
    },
  };
}

/** An arc of a torus from q, where its centre line runs along d and bends towards `inwards`, with both legs. */
function elbow(id: string, q: V3, d: V3, inwards: V3, bend: number, angle: number, r: number): Solid {
  const centre = add(q, mul(inwards, bend));
  const far = (t: number) => add(centre, add(mul(inwards, -bend * Math.cos(t)), mul(d, bend * Math.sin(t))));
  const leave = add(mul(d, Math.cos(angle)), mul(inwards, Math.sin(angle)));
  const axis = cross(inwards, d);
  /** The centre line's nearest point. */
  const nearest = (p: V3): V3 => {
    const points: V3[] = [];
    const [s, t] = [dot(sub(p, q), d), dot(sub(p, far(angle)), leave)];
    points.push(add(q, mul(d, Math.min(0, s))), add(far(angle), mul(leave, Math.max(0, t))));
    const flat = across(sub(p, centre), axis);
    const turned = Math.atan2(dot(flat, d), -dot(flat, inwards));
    if (turned > 0 && turned < angle) points.push(add(centre, mul(unit(flat), bend)));
    return points.reduce((best, next) => (norm(sub(p, next)) < norm(sub(p, best)) ? next : best));
  };
  const distance = (p: V3) => norm(sub(p, nearest(p))) - r;
  const normal = (p: V3) => unit(sub(p, nearest(p)));
  return {
    id,
    convex: false,
    rate: 1,
    distance,
    normal,
    top: (x, y) => {
      const reach = 100 * (bend + r);
      let z = q[2] + reach;
      for (let i = 0; i < 3000 && z > q[2] - reach; i += 1) {
        const off = distance([x, y, z]);
        if (off < 1e-7) {
          for (let k = 0; k < 4; k += 1) z -= distance([x, y, z]) / Math.max(normal([x, y, z])[2], 1e-4);
          return z;
        }
        z -= off;
      }
      return undefined;
    },
  };
}
