/** Shapes of cut-outs in the plane that touches the tube at their anchor: closed chains of lines and arcs, and the places they repeat at. */
import type {Body, Numbers} from './solids.js';
import {integral, RAD} from './space.js';

export type Flat = readonly [number, number]; // along the tube, and across the way the girth grows

export interface Segment {
  from: Flat;
  to: Flat;
  centre?: Flat; // of an arc, which turns by `sweep` about it
  sweep?: number;
}

const rotated = ([x, y]: Flat, angle: number): Flat => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];
const far = (a: Flat, b: Flat): number => Math.hypot(a[0] - b[0], a[1] - b[1]);

export const pointOf = (s: Segment, share: number): Flat => {
  if (!s.centre) return [s.from[0] + share * (s.to[0] - s.from[0]), s.from[1] + share * (s.to[1] - s.from[1])];
  const [x, y] = rotated([s.from[0] - s.centre[0], s.from[1] - s.centre[1]], share * (s.sweep as number));
  return [s.centre[0] + x, s.centre[1] + y];
};

/** A closed line through corners, each rounded by `r` if that is more than 0. */
function rounded(corners: Flat[], r: number): Segment[] {
  const n = corners.length;
  const cuts = corners.map((at, i) => {
    const [before, after] = [corners[(i + n - 1) % n], corners[(i + 1) % n]];
    const way = (to: Flat): Flat => [(to[0] - at[0]) / far(to, at), (to[1] - at[1]) / far(to, at)];
    const [p, q] = [way(before), way(after)];
    const entry: Flat = [at[0] + r * p[0], at[1] + r * p[1]];
    const leave: Flat = [at[0] + r * q[0], at[1] + r * q[1]];
    const centre: Flat = [at[0] + r * (p[0] + q[0]), at[1] + r * (p[1] + q[1])];
    return {entry, leave, centre, sweep: (Math.PI / 2) * Math.sign(q[0] * p[1] - q[1] * p[0])};
  });
  return cuts.flatMap(({entry, leave, centre, sweep}, i) => {
    const next = cuts[(i + 1) % n].entry;
    const arc: Segment[] = r > 0 ? [{from: entry, to: leave, centre, sweep}] : [];
    return far(leave, next) > 1e-12 ? [...arc, {from: leave, to: next}] : arc;
  });
}

/** A line of some length along the tube, as wide as its round ends. */
const obround = (length: number, width: number): Segment[] => {
  const [half, r] = [(length - width) / 2, width / 2];
  const arcs: Segment[] = [
    {from: [half, -r], to: [half, r], centre: [half, 0], sweep: Math.PI},
    {from: [-half, r], to: [-half, -r], centre: [-half, 0], sweep: Math.PI},
  ];
  if (half < 1e-12) return arcs;
  return [arcs[0], {from: [half, r], to: [-half, r]}, arcs[1], {from: [-half, -r], to: [half, -r]}];
};

/** The chain of a shape; nothing if it needs a reader of its own. `radius`: of a rectangle's corners that the request leaves to the kerf. */
export function chainOf(shape: Body, kerf: number, radius: number): Segment[] | undefined {
  const number = shape as unknown as Numbers;
  const turn = (number.angle_deg ?? 0) * RAD;
  const turned = (chain: Segment[]): Segment[] =>
    chain.map((s) => ({...s, from: rotated(s.from, turn), to: rotated(s.to, turn), ...(s.centre ? {centre: rotated(s.centre, turn)} : {})}));
  switch (shape.kind) {
    case 'circle':
      return turned(obround(number.diameter_mm, number.diameter_mm));
    case 'slot':
      return turned(obround(number.length_mm, number.width_mm));
    case 'slit':
      return turned(obround(number.length_mm + kerf, kerf));
    case 'rectangle': {
      const [a, b] = [number.along_mm / 2, number.round_mm / 2];
      const corners: Flat[] = [
        [a, -b],
        [a, b],
        [-a, b],
        [-a, -b],
      ];
      return turned(rounded(corners, number.corner_radius_mm ?? (shape.corners === 'as_cut' ? 0 : radius)));
    }
    case 'contour': {
      // The drawing is seen from outside with the start on the left, so its y runs against the girth.
      const side = shape.mirrored ? 1 : -1;
      const place = (p: unknown): Flat => [(p as number[])[0], side * (p as number[])[1]];
      let from = place(shape.start_mm);
      return turned(
        (shape.pieces as Body[]).map((piece): Segment => {
          const segment: Segment = {from, to: place(piece.to_mm)};
          if (piece.kind === 'arc') {
            const centre = place(piece.centre_mm);
            const sense = (piece.sense === 'ccw' ? 1 : -1) * side * 1;
            const angle = (p: Flat) => Math.atan2(p[1] - centre[1], p[0] - centre[0]);
            let sweep = (angle(segment.to) - angle(from)) * sense;
            while (sweep <= 1e-9) sweep += 2 * Math.PI;
            Object.assign(segment, {centre, sweep: sweep * sense});
          }
          from = segment.to;
          return segment;
        }),
      );
    }
    default:
      return undefined;
  }
}

/** From a place to the nearest point of the chain. */
export function offChain(chain: Segment[], p: Flat): number {
  return Math.min(
    ...chain.map((s) => {
      const ends = Math.min(far(p, s.from), far(p, s.to));
      if (!s.centre) {
        const [dx, dy] = [s.to[0] - s.from[0], s.to[1] - s.from[1]];
        const square = dx * dx + dy * dy;
        const share = ((p[0] - s.from[0]) * dx + (p[1] - s.from[1]) * dy) / square;
        return share > 0 && share < 1 ? Math.abs((p[0] - s.from[0]) * dy - (p[1] - s.from[1]) * dx) / Math.sqrt(square) : ends;
      }
      const start = Math.atan2(s.from[1] - s.centre[1], s.from[0] - s.centre[0]);
      const sweep = s.sweep as number;
      const turn = (Math.atan2(p[1] - s.centre[1], p[0] - s.centre[0]) - start) * Math.sign(sweep);
      const inside = ((turn % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI) <= Math.abs(sweep);
      return inside ? Math.abs(far(p, s.centre) - far(s.from, s.centre)) : ends;
    }),
  );
}

/** The integral of f(across) d(along) round the chain, by its sense from the inside on the left: of f = -across it is the area. */
export function around(chain: Segment[], f: (across: number) => number): number {
  const ring = (g: (y: number) => number) =>
    chain.reduce((sum, s) => {
      const length = s.centre ? Math.abs(s.sweep as number) * far(s.from, s.centre) : far(s.from, s.to);
      const speed = (u: number): number => {
        if (!s.centre) return s.to[0] - s.from[0];
        return -(s.sweep as number) * (pointOf(s, u)[1] - s.centre[1]);
      };
      return sum + integral((u) => g(pointOf(s, u)[1]) * speed(u), 0, 1, 1e-11 * (1 + length), 20);
    }, 0);
  return ring(f) * Math.sign(ring((y) => -y));
}

/** An instance: its name and how far it lies from the anchor along the tube, and round it on the outside; `face` after that of the anchor. */
export interface Instance {
  name: string;
  along: number;
  round: number;
  face?: number;
}

/** The places of a pattern; `whole` is the girth. */
export function placesOf(id: string, pattern: Body | undefined, whole: number): Instance[] {
  const number = (body: Body, name: string): number => (typeof body[name] === 'number' ? (body[name] as number) : 0);
  const pitch = (body: Body): number => (number(body, 'pitch_deg') * whole) / 360 + number(body, 'pitch_round_mm');
  if (!pattern) return [{name: id, along: 0, round: 0}];
  const count = (body: Body) => Array.from({length: body.count as number}, (_, i) => i);
  switch (pattern.kind) {
    case 'linear':
      return count(pattern).map((i) => ({name: `${id}.${i}`, along: i * number(pattern, 'pitch_mm'), round: i * pitch(pattern)}));
    case 'round': {
      const step = 'pitch_deg' in pattern || 'pitch_round_mm' in pattern ? pitch(pattern) : whole / (pattern.count as number);
      return count(pattern).map((i) => ({name: `${id}.${i}`, along: 0, round: i * step}));
    }
    case 'grid': {
      const [along, round] = [pattern.along as Body, pattern.round as Body];
      const [dz, ds] = [number(along, 'pitch_mm'), pitch(round)];
      const moved = (by: string, step: number) => (pattern.stagger === by ? ((pattern.stagger_mm as number | undefined) ?? step / 2) : 0);
      return count(along).flatMap((i) =>
        count(round).map((j) => ({
          name: `${id}.${i}.${j}`,
          along: i * dz + (j % 2) * moved('along', dz),
          round: j * ds + (i % 2) * moved('round', ds),
        })),
      );
    }
    default:
      return (pattern.faces as number[]).flatMap((face) =>
        placesOf(`${id}.${face - 1}`, pattern.each as Body | undefined, whole).map((one) => ({...one, face})),
      );
  }
}
