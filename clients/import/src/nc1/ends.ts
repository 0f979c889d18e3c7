import {exact} from '../frame.js';
import {type Edge, type EdgePoint, endsOf, type Frame, planeThrough, type Slope} from './outlines.js';
import type {PartEnd} from './part.js';
import type {Stated, StatedEnd} from './stated.js';
import {type Block, type Face, headerNumber, type Nc1} from './text.js';

export interface Reading {
  file: Nc1;
  frame: Frame;
  stated: Stated;
  tell(id: string, type: string, reason: string): void;
}
export type Which = 'start' | 'finish';

/** An end: x where it meets the axis, and its request once the work point is known. */
export interface FoundEnd {
  x: number;
  kerf?: number;
  request(work: number, kerf: number): PartEnd;
}

const flat = 0.011; // mm: within it an end is square; files have two decimals
const straight = 0.05; // mm: within it an outline lies on a plane
const tidy = (v: number): number => Math.round(v * 1e9) / 1e9 + 0;
const shown = (v: number): string => String(Number(v.toPrecision(4)));

/** A normal in the part's frame, seen from an end, which has y and z in reverse at the finish. */
const seen = ([x, y, z]: [number, number, number], which: Which): [number, number, number] =>
  which === 'start' ? [tidy(x), tidy(y), tidy(z)] : [tidy(x), tidy(-y), tidy(-z)];
const into = (x: number, work: number, which: Which): number => tidy(which === 'start' ? x - work : work - x);

function squareEnd(x: number, which: Which, kerf?: number): FoundEnd {
  return {
    x,
    ...(kerf === undefined ? {} : {kerf}),
    request: (work, all) => ({square_at_mm: into(x, work, which), ...(kerf === undefined || kerf === all ? {} : {kerf_mm: kerf})}),
  };
}

function planeEnd(x: number, normal: [number, number, number], rest: Record<string, unknown>, which: Which, kerf?: number): FoundEnd {
  return {
    x,
    ...(kerf === undefined ? {} : {kerf}),
    request: (work, all) => ({
      cutters: [{kind: 'plane', point_mm: [0, 0, into(x, work, which)], normal: seen(normal, which)}],
      ...rest,
      ...(kerf === undefined || kerf === all ? {} : {kerf_mm: kerf}),
    }),
  };
}

/** Without a groove both edges lie on the plane, as a saw leaves them. */
const sawn = {root_surface: 'inner', groove: {rule: 'none'}, smoothing: {method: 'none'}};

/** Returns the edges of one end, one of each outline, and the outlines that have no such edge. */
function edgesOf({file, frame}: Reading, which: Which): {edges: Edge[]; odd: Block[]} {
  const [edges, odd]: [Edge[], Block[]] = [[], []];
  for (const block of file.blocks) {
    if (block.code !== 'AK') continue;
    const face = block.rows[0]?.face;
    const curved = block.rows.some(({values}) => (values[2]?.value ?? 0) !== 0 || values[1]?.letter);
    const found = face && !curved && (frame.kind === 'faces' || face === 'v') ? endsOf(frame, block, face) : undefined;
    if (found) edges.push(found[which === 'start' ? 0 : 1]);
    else odd.push(block);
  }
  return {edges, odd};
}

/** x of the outermost point of all outlines. */
function tipOf({file}: Reading, which: Which): number | undefined {
  const all = file.blocks.filter(({code}) => code === 'AK').flatMap(({rows}) => rows.map(({values}) => values[0]?.value ?? 0));
  if (all.length === 0) return undefined;
  return which === 'start' ? all.reduce((a, b) => Math.min(a, b)) : all.reduce((a, b) => Math.max(a, b));
}

/** How far a leaning edge is from the plane: its outline is the outer edge's or the bore's, whichever reaches further. */
function leaning({points, face}: Edge, {b, c, a}: Slope, {wall}: Frame): number {
  const inwards: Record<Face, [number, number]> = {o: [-wall, 0], u: [wall, 0], v: [0, -wall], h: [0, wall]};
  const [dx, dy] = inwards[face];
  const off = ({x, y, at}: EdgePoint, share: number): number => Math.abs(at - a - b * (x + share * dx) - c * (y + share * dy));
  return points.reduce((most, point) => Math.max(most, Math.min(off(point, 0), off(point, 1))), 0);
}

interface Fitted {
  plane: Slope;
  off: number;
}
function fitted({frame}: Reading, edges: Edge[]): Fitted | undefined {
  const upright = edges.filter(({leans}) => !leans);
  const points = (upright.length > 0 ? upright : edges).flatMap((edge) => edge.points);
  const plane = planeThrough(points, Math.max(frame.height, frame.width) / 2);
  if (!plane) return undefined;
  const sloped = Math.hypot(plane.b, plane.c) > 1e-9;
  const rest = sloped ? edges.filter(({leans}) => leans).map((edge) => leaning(edge, plane, frame)) : [];
  return {plane, off: rest.reduce((most, off) => Math.max(most, off), plane.off)};
}

const angles: Record<Which, ['web start cut', 'flange start cut'] | ['web end cut', 'flange end cut']> = {
  start: ['web start cut', 'flange start cut'],
  finish: ['web end cut', 'flange end cut'],
};

/** The saw's angles of the header, deg; 0 if they are not numbers. */
function sawAngles({file}: Reading, which: Which): [web: number, flange: number] {
  return angles[which].map((field) => {
    try {
      return headerNumber(file, field);
    } catch {
      return 0;
    }
  }) as [number, number];
}

/** An end without an outline: by the saw's angles. The web's turns the cut in face v; where the flange's turns it is not known. */
function byHeader(reading: Reading, which: Which): FoundEnd {
  const {file, frame, tell} = reading;
  const [web, flange] = sawAngles(reading, which);
  const tip = which === 'start' ? 0 : headerNumber(file, 'length');
  if (flange !== 0) tell('header', which, `a cut of ${shown(flange)} deg across the flange and no AK: this end is square in the request; state its plane`);
  else if (Math.abs(web) >= 89) tell('header', which, `a cut of ${shown(web)} deg is not read: this end is square in the request`);
  if (web === 0 || flange !== 0 || Math.abs(web) >= 89) return squareEnd(tip, which);
  tell('header', which, `assumed: a plane by the saw's angle of ${shown(web)} deg, because the file has no AK`);
  const slope = -Math.tan((web * Math.PI) / 180);
  const x = tip + (which === 'start' ? 1 : -1) * Math.abs(slope) * (frame.height / 2);
  return planeEnd(exact(x), [-slope, 0, 1], sawn, which);
}

function byOutline(reading: Reading, which: Which): FoundEnd {
  const {tell, frame} = reading;
  const tip = tipOf(reading, which);
  if (tip === undefined) return byHeader(reading, which);
  const {edges, odd} = edgesOf(reading, which);
  const line = (odd[0] ?? reading.file.blocks.find(({code}) => code === 'AK'))?.line ?? 0;
  const found = fitted(reading, edges);
  if (!found || odd.length > 0) {
    // Told once, of both ends.
    if (which === 'start')
      for (const {line: at, rows} of odd)
        tell(`line ${at}`, 'AK', `the outline of face ${rows[0]?.face ?? 'none'} does not go once along both sides: it has a notch, a radius or another width`);
    if (!found) {
      tell(`line ${line}`, 'AK', `the ${which} is not known: it is square at its outermost point in the request; state its cut`);
      return squareEnd(tip, which);
    }
  }
  const {plane, off} = found;
  const points = edges.flatMap((edge) => edge.points);
  const [least, most] = [points.reduce((v, {at}) => Math.min(v, at), Infinity), points.reduce((v, {at}) => Math.max(v, at), -Infinity)];
  const web = sawAngles(reading, which)[0];
  const leans = edges.some((edge) => edge.leans);
  if (most - least <= flat) {
    if (leans) tell(`line ${line}`, 'AK', `assumed: the ${which} is square; the angles of its weld preparation are not read`);
    if (web !== 0) tell('header', which, `a saw's angle of ${shown(web)} deg, and the outline is square: the outline is read`);
    return squareEnd((least + most) / 2, which);
  }
  if (off > straight) {
    const far = `its outline lies up to ${shown(off)} mm off the nearest plane, and at most ${straight} mm are one`;
    tell(`line ${line}`, 'AK', `the ${which} is no plane: ${far}. It is square at its outermost point in the request; state its partner`);
    return squareEnd(tip, which);
  }
  const slope = (Math.atan(-plane.b) * 180) / Math.PI;
  if (web !== 0 && Math.abs(slope - web) > 0.1)
    tell('header', which, `a saw's angle of ${shown(web)} deg, and the outline has ${shown(slope)} deg: the outline is read`);
  if (!plane.known.b || !plane.known.c) tell(`line ${line}`, 'AK', `assumed: the ${which} is square across the faces that have no outline`);
  if (frame.round && leans) tell(`line ${line}`, 'AK', `the angles of the weld preparation of the ${which} are not read`);
  tell(`line ${line}`, 'AK', `assumed: the ${which} is cut flush with its plane, without a groove`);
  return planeEnd(exact(plane.a), [-plane.b, -plane.c, 1], sawn, which);
}

/** Returns true if the outline lies near the end that our own comment states. A groove moves the outer edge off a plane. */
function agrees(reading: Reading, which: Which, {x, plane}: StatedEnd): boolean {
  const points = edgesOf(reading, which).edges.flatMap((edge) => edge.points);
  if (points.length === 0) return false;
  if (!plane) return points.every(({at}) => Math.abs(at - x) <= 2e-3);
  const [nx, ny, nz] = plane.normal;
  // A bevel and a square wall move the outer edge by some walls at most.
  const room = 8 * reading.frame.wall * (1 + Math.hypot(nx, ny) / Math.abs(nz));
  return points.every((p) => Math.abs(p.at - x + (nx * p.x + ny * p.y) / nz) <= room);
}

/** Reads an end by our own comment, else by its outlines, else by the saw's angles. */
export function endOfPart(reading: Reading, which: Which): FoundEnd {
  const own = reading.stated[which];
  if (own && agrees(reading, which, own))
    return own.plane ? planeEnd(own.x, own.plane.normal, own.plane.rest, which, own.kerf) : squareEnd(own.x, which, own.kerf);
  if (own) reading.tell(which, 'AK', 'its comment states another end than its outline: the outline is read');
  return byOutline(reading, which);
}
