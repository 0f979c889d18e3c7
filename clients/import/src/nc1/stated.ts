import {decimal} from '../units.js';
import type {Countersink, CutoutShape, Piece, Point} from './part.js';

/** The end that our own files state in a comment; x as in the blocks, the normal in the part's frame. */
export interface StatedEnd {
  x: number;
  kerf: number;
  /** Of an end that is not square. */
  plane?: {normal: [number, number, number]; rest: Record<string, unknown>};
}

export interface Stated {
  ours: boolean;
  work?: [start: number, finish: number];
  corners?: {outside: number; inside: number};
  start?: StatedEnd;
  finish?: StatedEnd;
}

/** A cut-out as its comment states it; x and y of its anchor as in its block. */
export interface StatedShape {
  shape: CutoutShape;
  wall: string;
  tilt: string;
  countersink?: Countersink;
  /** Of a slit, as wide as the beam. */
  kerf?: number;
  x: number;
  y: number;
}

const groups = (text: string): string[] => text.split(';').map((each) => each.trim());
/** The fields of a line "name value; name value", by the names that it may have. */
function valuesOf(text: string, names: readonly string[]): Map<string, string> {
  const found = new Map<string, string>();
  for (const each of groups(text)) {
    const name = names.find((one) => each === one || each.startsWith(`${one} `));
    if (name !== undefined) found.set(name, each.slice(name.length).trim());
  }
  return found;
}
const numbers = (text: string | undefined): number[] => (text ?? '').split(/ x | /).map(decimal);

const isWhole = (value: unknown): boolean =>
  typeof value === 'number' ? Number.isFinite(value) : typeof value !== 'object' || value === null || Object.values(value).every(isWhole);

function grooveOf(text: string): Record<string, unknown> | undefined {
  const half = /^half the dihedral, cap (\S+)$/.exec(text);
  const fixed = /^fixed (\S+)$/.exec(text);
  if (half) return {rule: 'half_dihedral', cap_deg: decimal(half[1])};
  if (fixed) return {rule: 'fixed', angle_deg: decimal(fixed[1])};
  return text === 'none' || text === 'square' ? {rule: text} : undefined;
}

const contacts = ['inner', 'outer', 'auto', 'none'];
const lengths = {'root face': 'root_face_mm', 'root gap': 'root_gap_mm', coating: 'coating_mm'} as const;

function endOf(text: string): StatedEnd | undefined {
  const found = valuesOf(text, ['square at x', 'plane at x', 'normal', 'groove', 'contact', 'root face', 'root gap', 'root', 'coating', 'kerf']);
  const kerf = decimal(found.get('kerf'));
  const square = decimal(found.get('square at x'));
  if (!(kerf >= 0)) return undefined;
  if (Number.isFinite(square)) return {x: square, kerf};
  const x = decimal(found.get('plane at x'));
  const [nx, ny, nz, ...more] = numbers(found.get('normal'));
  const groove = grooveOf(found.get('groove') ?? '');
  const sizes = Object.entries(lengths).map(([name, field]) => [field, decimal(found.get(name))] as const);
  const [contact, root] = [found.get('contact'), found.get('root')];
  if (![x, nx, ny, nz, ...sizes.map(([, value]) => value)].every(Number.isFinite) || more.length > 0 || !nz || !groove || !isWhole(groove)) return undefined;
  if (!contact || !contacts.includes(contact) || !root || !['inner', 'outer'].includes(root)) return undefined;
  const rest = {
    root_surface: root,
    groove,
    contact,
    ...Object.fromEntries(sizes.filter(([, value]) => value !== 0)),
    smoothing: {method: 'none'},
  };
  return {x, kerf, plane: {normal: [nx as number, ny as number, nz], rest}};
}

/** Reads the lines that our own files have in addition; if another program wrote the file, returns only that. */
export function statedBy(comments: string[]): Stated {
  const out: Stated = {ours: comments.some((each) => /^tubecut \d/.test(each))};
  if (!out.ours) return out;
  for (const each of comments) {
    const [, work, finish] = /^work points: x (\S+) and (\S+)$/.exec(each) ?? [];
    if (Number.isFinite(decimal(work)) && Number.isFinite(decimal(finish))) out.work = [decimal(work), decimal(finish)];
    const [outside, inside] = (/^corner radii: (\S+) outside, (\S+) inside$/.exec(each)?.slice(1) ?? []).map(decimal);
    if (outside !== undefined && inside !== undefined && outside > 0 && inside >= 0) out.corners = {outside, inside};
    const end = /^end (start|finish): (.*)$/.exec(each);
    const found = end && endOf(end[2] as string);
    if (found) out[end[1] as 'start' | 'finish'] = found;
  }
  return out;
}

const pointOf = ([x, y]: number[]): Point => [x as number, y as number];

/**
 * The centre, moved to where it is as far from both ends: the contract's arcs are exact to 1e-6 mm, and the file's numbers to 1e-9.
 */
function centred(from: Point, to: Point, centre: Point): Point {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const long = dx * dx + dy * dy;
  if (long === 0) return centre;
  const off = ((from[0] + to[0]) / 2 - centre[0]) * dx + ((from[1] + to[1]) / 2 - centre[1]) * dy;
  return [centre[0] + (off * dx) / long, centre[1] + (off * dy) / long];
}

function pieceOf(text: string, from: Point): Piece | undefined {
  const line = /^line to (\S+) (\S+)$/.exec(text);
  const arc = /^arc (cw|ccw) to (\S+) (\S+) about (\S+) (\S+)$/.exec(text);
  const found = (line ?? arc)?.slice(line ? 1 : 2).map(decimal) ?? [];
  if (found.length === 0 || !found.every(Number.isFinite)) return undefined;
  const to_mm = pointOf(found);
  if (!arc) return {kind: 'line', to_mm};
  return {kind: 'arc', to_mm, centre_mm: centred(from, to_mm, pointOf(found.slice(2))), sense: arc[1] as 'cw' | 'ccw'};
}

function contourOf(count: number, start: Point, lines: string[]): CutoutShape | undefined {
  const pieces: Piece[] = [];
  let at = start;
  for (const each of lines.slice(0, count)) {
    const piece = pieceOf(each, at);
    if (!piece) return undefined;
    pieces.push(piece);
    at = piece.to_mm;
  }
  return pieces.length === count && count > 0 ? {kind: 'contour', start_mm: start, pieces} : undefined;
}

function shapeOf(text: string, lines: string[]): CutoutShape | undefined {
  const [first = ''] = groups(text);
  const [kind = '', rest = ''] = [/^\w+/.exec(first)?.[0], first.replace(/^\w+ /, '')];
  const [a, b] = numbers(rest) as [number, number];
  const found = valuesOf(text, ['corners', 'turned', 'as cut', 'mirrored', 'pierce']);
  const turned = found.has('turned') ? {angle_deg: decimal(found.get('turned'))} : {};
  const corners = found.has('as cut') ? ({corners: 'as_cut'} as const) : {};
  if (kind === 'circle') return {kind, diameter_mm: a, ...turned};
  if (kind === 'slit') return {kind, length_mm: a, ...(found.get('pierce') === 'end' ? {pierce: 'end' as const} : {}), ...turned};
  if (kind === 'slot') return {kind, length_mm: a, width_mm: b, ...turned};
  if (kind === 'rectangle') return {kind, along_mm: a, round_mm: b, corner_radius_mm: decimal(found.get('corners')), ...corners, ...turned};
  const drawn = /^contour of (\d{1,4}) pieces from (\S+) (\S+)$/.exec(first);
  const contour = drawn && contourOf(Number(drawn[1]), [decimal(drawn[2]), decimal(drawn[3])], lines);
  return contour ? {...contour, ...corners, ...turned, ...(found.has('mirrored') ? {mirrored: true} : {})} : undefined;
}

/** The cut-out that the comments before a block state; undefined if they do not state all of it. */
export function statedShape(comments: string[]): StatedShape | undefined {
  const at = comments.findIndex((each) => each.startsWith('shape: '));
  if (at < 0) return undefined;
  const text = (comments[at] as string).slice('shape: '.length);
  const shape = shapeOf(text, comments.slice(at + 1));
  const found = valuesOf(text, ['wall', 'tilt', 'at x', 'y', 'countersink', 'sunk at', 'kerf']);
  const [wall, tilt] = [found.get('wall'), found.get('tilt')];
  const [x, y] = [decimal(found.get('at x')), decimal(found.get('y'))];
  if (!wall || !['normal', 'through', 'developed'].includes(wall) || !tilt || !['axial', 'free', 'none'].includes(tilt)) return undefined;
  const sink = found.has('countersink') ? {countersink: {diameter_mm: decimal(found.get('countersink')), angle_deg: decimal(found.get('sunk at'))}} : {};
  const kerf = found.has('kerf') ? {kerf: decimal(found.get('kerf'))} : {};
  const out = shape && {shape, wall, tilt, ...sink, ...kerf, x, y};
  return isWhole(out) ? out : undefined;
}

/** A text as its comment states it. */
export interface StatedText {
  id: string;
  x: number;
  girth: number;
  angle: number;
  height: number;
  mirrored: boolean;
  overCorner: boolean;
}
/** The text that the comments before a block state; undefined if they do not state all of it. */
export function statedText(comments: string[]): StatedText | undefined {
  const line = comments.map((each) => /^text: (.*?); id (.*)$/.exec(each)).find(Boolean);
  if (!line) return undefined;
  const found = valuesOf(line[1] as string, ['at x', 'girth', 'angle', 'height', 'mirrored', 'over corner']);
  const [x, girth, angle, height] = ['at x', 'girth', 'angle', 'height'].map((name) => decimal(found.get(name))) as [number, number, number, number];
  const out = {id: line[2] as string, x, girth, angle, height, mirrored: found.has('mirrored'), overCorner: found.has('over corner')};
  return isWhole(out) ? out : undefined;
}

export interface Title {
  name: string;
  far: boolean;
}
/** Name of the cut-out of a block, and whether it is the far side of one through both walls. */
export function titleOf(comments: string[]): Title | undefined {
  const found = comments
    .map((each) => /^cut-out (.*), (?:square to the (?:tube|face)|its walls parallel)(?:, (?:a straight tool passes|its size on the bore))?$/.exec(each))
    .find(Boolean);
  if (!found) return undefined;
  const name = found[1] as string;
  return name.endsWith(' far') ? {name: name.slice(0, -' far'.length), far: true} : {name, far: false};
}
