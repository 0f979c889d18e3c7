import {clean, type names} from '../frame.js';
import {limits} from '../limits.js';
import {acrossOf, faces, type Frame} from './outlines.js';
import type {Cutout, CutoutShape, Mark, Piece, Point, Round, TextMark} from './part.js';
import {type StatedShape, statedShape, statedText, titleOf} from './stated.js';
import {type Block, type Face, type Row, Trouble} from './text.js';

/** Adds to the list of items that are not read, or are read by an assumption. */
export type Tell = (line: number, type: string, reason: string) => void;

export interface Openings {
  frame: Frame;
  ours: boolean;
  /** x of the start's work point, from which the request counts. */
  start: number;
  name: ReturnType<typeof names>;
  tell: Tell;
  cutouts: Cutout[];
  /** Of the part, as its slits state it: they are as wide. */
  kerf?: number;
  /** Line and block of each cut-out. */
  from: {id: string; line: number; type: string}[];
  marks: Mark[];
  texts: TextMark[];
  /** Number of cut-outs that a part has no place for. */
  over: number;
  slots: {line: number; count: number; turned: boolean};
}

const tidy = (v: number): number => Math.round(v * 1e9) / 1e9 + 0;
const same = 2e-3; // mm: of a number in the file's three decimals
const shown = (v: number): string => String(Number(v.toPrecision(6)));

/** A place on the outside, and the way from it to y of the file, as a drawing's height. */
interface Spot {
  at: {z_mm: number} & Round;
  /** The drawing's y of a y of the file. */
  up(y: number): number;
}

/** On a round tube that is drawn face by face, a face's cut-outs are projected from its middle. */
function spotOf({frame, start}: Openings, face: Face, x: number, y: number): Spot {
  const z_mm = tidy(x - start);
  const across = acrossOf(frame, face);
  if (frame.kind === 'developed') {
    const girth = frame.girth;
    return {at: {z_mm, girth_mm: tidy((((-y % girth) + girth) % girth) % girth)}, up: (v) => v - y};
  }
  const {face: number, sign} = faces[face];
  if (frame.round) return {at: {z_mm, phi_deg: 90 * (number - 1)}, up: (v) => -sign * (v - across / 2)};
  return {at: {z_mm, face: number, offset_mm: tidy(sign * (y - across / 2))}, up: (v) => -sign * (v - y)};
}

/** The sense of a turn in the file, in the contract's angle from +z to growing girth. */
const turnedBy = ({frame}: Openings, face: Face, deg: number): number => (frame.kind === 'developed' ? -deg : faces[face].sign * deg) + 0;

function add(to: Openings, block: Block, line: number, cutout: Cutout): void {
  if (to.cutouts.length >= limits.cutouts) {
    to.over += 1;
    return;
  }
  to.cutouts.push(cutout);
  to.from.push({id: cutout.id, line, type: block.code});
}

/** A circle in a drawing whose origin is not its middle. */
function shifted(radius: number, up: number): CutoutShape {
  const arc = (to: number): Piece => ({kind: 'arc', to_mm: [to, up], centre_mm: [0, up], sense: 'ccw'});
  return {kind: 'contour', start_mm: [-radius, up], pieces: [arc(radius), arc(-radius)]};
}

const kinds: Record<string, string> = {g: 'a thread', l: 'a left-hand thread', m: 'a punch mark', s: 'a countersink'};

/** A row of BO: face, x, y, diameter, depth, and of a slot the way between its centres, its width and its angle. */
function bore(to: Openings, block: Block, row: Row, face: Face): void {
  const [x, y, diameter, depth, length, width, angle] = row.values;
  if (!x || !y || !diameter) throw new Trouble('a hole needs x, y and a diameter');
  if (row.values.length > 7) throw new Trouble(`a hole has at most 7 numbers, and this one has ${row.values.length}`);
  if (diameter.letter) throw new Trouble(`${kinds[diameter.letter] ?? `kind ${diameter.letter}`} is not read`);
  if (!(diameter.value > 0)) throw new Trouble(`a hole of ${shown(diameter.value)} mm is a punch mark`);
  if (depth && depth.value > 0 && depth.value < to.frame.wall - same)
    throw new Trouble(`a blind hole of ${shown(depth.value)} mm in a wall of ${shown(to.frame.wall)} mm is not read`);
  const long = length?.value ?? 0;
  const wide = width?.value ?? 0;
  if (wide !== 0 && Math.abs(wide - diameter.value) > same)
    throw new Trouble(`a slot that is ${shown(wide)} mm wide, and ${shown(diameter.value)} mm at its ends, is not read: draw it as IK`);
  const spot = spotOf(to, face, x.value, y.value);
  const id = to.name(undefined, `BO ${to.cutouts.length + 1}`);
  const off = spot.up(y.value);
  const turn = turnedBy(to, face, angle?.value ?? 0);
  if (long !== 0) {
    if (Math.abs(off) > same) throw new Trouble('a slot off the middle of a round tube that is drawn face by face is not read');
    to.slots.line ||= row.line;
    to.slots.count += 1;
    to.slots.turned ||= turn % 90 !== 0;
    const shape = {kind: 'slot', length_mm: tidy(Math.abs(long) + diameter.value), width_mm: diameter.value, ...(turn === 0 ? {} : {angle_deg: turn})} as const;
    add(to, block, row.line, {id, shape, at: spot.at});
  } else if (Math.abs(off) > same) add(to, block, row.line, {id, shape: shifted(diameter.value / 2, tidy(off)), at: spot.at});
  else add(to, block, row.line, {id, shape: {kind: 'circle', diameter_mm: diameter.value}, at: spot.at});
}

/** Removes points within `by` of the line between their neighbours (Douglas and Peucker). */
function thinned(points: Point[], by: number): Point[] {
  const keep = new Set([0, points.length - 1]);
  const open: [number, number][] = [[0, points.length - 1]];
  for (let part = open.pop(); part; part = open.pop()) {
    const [from, to] = part;
    const [a, b] = [points[from] as Point, points[to] as Point];
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const long = Math.hypot(dx, dy);
    let [worst, at] = [by, -1];
    for (let i = from + 1; i < to; ++i) {
      const [px, py] = [(points[i] as Point)[0] - a[0], (points[i] as Point)[1] - a[1]];
      const off = long > 0 ? Math.abs(px * dy - py * dx) / long : Math.hypot(px, py);
      if (off > worst) [worst, at] = [off, i];
    }
    if (at < 0) continue;
    keep.add(at);
    open.push([from, at], [at, to]);
  }
  return points.filter((_, i) => keep.has(i));
}

/** The rows of a block as closed outlines; a block may have several. */
function loopsOf({rows}: Block): Row[][] {
  const out: Row[][] = [];
  let loop: Row[] = [];
  for (const row of rows) {
    const [x, y] = row.values;
    if (!x || !y) throw new Trouble(`line ${row.line} has no x and y`);
    const [begin] = loop;
    loop.push(row);
    if (begin && loop.length > 2 && Math.hypot((begin.values[0]?.value ?? 0) - x.value, (begin.values[1]?.value ?? 0) - y.value) <= same) {
      out.push(loop);
      loop = [];
    }
  }
  const [begin, last] = [loop[0]?.values, loop[loop.length - 1]?.values];
  if (begin && last) {
    const gap = Math.hypot((begin[0]?.value ?? 0) - (last[0]?.value ?? 0), (begin[1]?.value ?? 0) - (last[1]?.value ?? 0));
    throw new Trouble(`the contour is open by ${shown(gap)} mm, and at most ${same} mm are closed: repeat its first point at its end`);
  }
  return out;
}

function contour(to: Openings, block: Block, loop: Row[], face: Face): void {
  const line = loop[0]?.line ?? block.line;
  const curved = loop.find(({values}) => (values[2]?.value ?? 0) !== 0 || values[1]?.letter);
  if (curved) throw new Trouble(`it has a radius or a notch in line ${curved.line}, and the side on which it lies is not known: draw arcs as short lines`);
  if (loop.length > limits.points) throw new Trouble(`the contour has ${loop.length} points, and at most ${limits.points} are read: draw it coarser`);
  const full = loop.map(({values}): Point => [values[0]?.value ?? 0, values[1]?.value ?? 0]);
  full[full.length - 1] = full[0] as Point;
  // From the point that is furthest from the first, because a ring has no two ends to begin with.
  const [x0, y0] = full[0] as Point;
  const far = full.reduce(
    (best, [x, y], i) => (Math.hypot(x - x0, y - y0) > Math.hypot((full[best] as Point)[0] - x0, (full[best] as Point)[1] - y0) ? i : best),
    0,
  );
  const points = [...thinned(full.slice(0, far + 1), 1e-3).slice(0, -1), ...thinned(full.slice(far), 1e-3)].filter(
    ([x, y], i, all) => i === 0 || Math.hypot(x - (all[i - 1] as Point)[0], y - (all[i - 1] as Point)[1]) > 1e-6,
  );
  if (points.length < 4) throw new Trouble('the contour encloses nothing');
  if (points.length - 1 > limits.pieces)
    throw new Trouble(`the contour has ${points.length - 1} lines, and a cut-out has at most ${limits.pieces}: draw it coarser`);
  const middle = (k: 0 | 1): number => {
    const all = points.map((p) => p[k]);
    return tidy((all.reduce((a, b) => Math.max(a, b)) + all.reduce((a, b) => Math.min(a, b))) / 2);
  };
  const [x, y] = [middle(0), middle(1)];
  const spot = spotOf(to, face, x, y);
  const drawn = points.map(([px, py]): Point => [tidy(px - x), tidy(spot.up(py))]);
  const id = to.name(titleOf(block.comments)?.name, `IK ${to.cutouts.length + 1}`);
  const pieces = drawn.slice(1).map((to_mm): Piece => ({kind: 'line', to_mm}));
  const wall = to.frame.round && to.frame.kind === 'faces' ? 'normal' : 'developed';
  add(to, block, line, {id, shape: {kind: 'contour', corners: 'as_cut', start_mm: drawn[0] as Point, pieces}, at: spot.at, wall});
  if (to.ours && !titleOf(block.comments))
    to.tell(
      line,
      block.code,
      'assumed: a hole for a branch is an opening with this outline, square to the tube; its branch is not stated, and its bevel is not read',
    );
  else if (loop.some(({values}) => values.slice(3).some(({value}) => value !== 0)))
    to.tell(line, block.code, 'assumed: its wall is square to the tube; the angles of its weld preparation are not read');
}

/** How far a block lies from the shape that its comments state, mm. */
function apart(to: Openings, {code, rows}: Block, {shape, x, y}: StatedShape): number {
  const girth = to.frame.kind === 'developed' ? to.frame.girth : Number.POSITIVE_INFINITY;
  const round = (v: number): number => (Number.isFinite(girth) ? Math.abs(v - girth * Math.round(v / girth)) : Math.abs(v));
  const first = rows[0]?.values ?? [];
  if (code === 'BO') {
    const size = shape.kind === 'circle' ? shape.diameter_mm - (first[2]?.value ?? Number.NaN) : Number.NaN;
    return Math.max(Math.abs((first[0]?.value ?? Number.NaN) - x), round((first[1]?.value ?? Number.NaN) - y), Math.abs(size));
  }
  if (shape.kind === 'contour') return 0;
  const half = (k: 0 | 1): number => {
    const all = rows.map(({values}) => values[k]?.value ?? Number.NaN);
    return (all.reduce((most, v) => Math.max(most, v), -Infinity) + all.reduce((least, v) => Math.min(least, v), Infinity)) / 2;
  };
  // The rows of a symmetric shape lie about its anchor; between two of them its outermost point may lie.
  return Math.max(0, Math.max(Math.abs(half(0) - x), round(half(1) - y)) - 0.25);
}

/** A block of ours, by its comments: true if they state all of it. */
function stated(to: Openings, block: Block, face: Face): boolean {
  if (!to.ours) return false;
  const title = titleOf(block.comments);
  if (!title) return false;
  const near = title.far && to.cutouts.find(({id, wall}) => wall === 'through' && id === clean(title.name));
  if (near) return true;
  const found = statedShape(block.comments);
  if (!found) return false;
  const off = apart(to, block, found);
  if (!(off <= same)) {
    to.tell(
      block.line,
      block.code,
      `its comment states a shape ${Number.isFinite(off) ? `${shown(off)} mm from the block` : 'that the block is not'}: the block is read`,
    );
    return false;
  }
  const {at} = spotOf(to, face, found.x, found.y);
  const {wall, tilt, countersink} = found;
  if (found.kerf !== undefined) to.kerf = found.kerf;
  const more = {...(wall === 'normal' ? {} : {wall}), ...(tilt === 'axial' ? {} : {tilt}), ...(countersink ? {countersink} : {})};
  add(to, block, block.line, {id: to.name(title.name, `${block.code} ${to.cutouts.length + 1}`), shape: found.shape, at, ...more});
  return true;
}

/** Reads the cut-outs of a block, row by row or contour by contour, and lists those that it cannot read. */
export function openings(to: Openings, block: Block): void {
  let face: Face | undefined;
  const faceOf = (row: Row | undefined): Face => {
    face = row?.face ?? face;
    if (!face) throw new Trouble('its first row names no face: v, o, u or h');
    if (to.frame.kind === 'developed' && face !== 'v') throw new Trouble(`it is on face ${face}, and a developed tube has only face v`);
    return face;
  };
  const trying = (line: number, act: () => void): void => {
    try {
      act();
    } catch (failure) {
      if (!(failure instanceof Trouble)) throw failure;
      to.tell(line, block.code, failure.message);
    }
  };
  trying(block.line, () => {
    if (block.rows.length === 0) throw new Trouble('it has no rows');
    if (stated(to, block, faceOf(block.rows[0]))) return;
    if (block.code === 'BO') for (const row of block.rows) trying(row.line, () => bore(to, block, row, faceOf(row)));
    else for (const loop of loopsOf(block)) trying(loop[0]?.line ?? block.line, () => contour(to, block, loop, faceOf(loop[0])));
  });
}

/** A text of ours, by its comment and its row: true if they state all of it. */
function ownText(to: Openings, block: Block): boolean {
  const found = to.ours ? statedText(block.comments) : undefined;
  const [row] = block.rows;
  if (!found || !row || row.text.trim() === '') return false;
  const {id, x, girth, angle, height, mirrored, overCorner} = found;
  const written = row.values[3]?.value ?? Number.NaN;
  const off = Math.max(Math.abs((row.values[0]?.value ?? Number.NaN) - x), Math.abs(written - height));
  if (!(off <= same)) {
    to.tell(block.line, 'SI', 'its comment states another text than the block: the block is read');
    return false;
  }
  const more = {...(mirrored ? {mirrored} : {}), ...(overCorner ? {over_corner: true} : {})};
  const turned = angle === 0 ? {} : {angle_deg: angle};
  to.texts.push({id: clean(id), at: {z_mm: tidy(x - to.start), girth_mm: girth}, text: row.text, height_mm: height, ...turned, ...more});
  return true;
}

/** A text of another program becomes a mark: where its base line begins and how it turns is not known. */
export function texts(to: Openings, block: Block): void {
  if (ownText(to, block)) return;
  let face: Face | undefined;
  for (const row of block.rows) {
    face = row.face ?? face;
    const [x, y] = row.values;
    const text = clean(row.text).trim().slice(0, 64);
    if (!face || !x || !y || text === '') {
      to.tell(row.line, 'SI', 'a mark needs a face, x, y and a text');
      continue;
    }
    const {frame} = to;
    const at = spotOf(to, face, x.value, y.value).at;
    if (frame.round)
      to.marks.push({text, z_mm: at.z_mm, phi_deg: 'girth_mm' in at ? tidy((at.girth_mm / frame.girth) * 360) : 'phi_deg' in at ? at.phi_deg : 0});
    else if ('face' in at) to.marks.push({text, z_mm: at.z_mm, girth_mm: alongGirth(frame, at.face, at.offset_mm)});
    to.tell(row.line, 'SI', `assumed: "${text}" is a mark at this place, because it is not known where its letters begin and how they turn`);
  }
}

/** Girth of a place on a face, from the middle of face 1. */
function alongGirth({height, width, girth}: Frame, face: number, offset: number): number {
  const [tall, wide] = [height, width];
  const corner = (2 * (tall + wide) - girth) / 4; // by which a corner shortens the way
  const middle = [0, (tall + wide) / 2 - corner, tall + wide - 2 * corner, (3 * (tall + wide)) / 2 - 3 * corner][face - 1] as number;
  return tidy((((middle + offset) % girth) + girth) % girth);
}
