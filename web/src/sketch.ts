import {isRow, rowsOf, type Json, type Row} from './json';
import type {Partner, Vector} from './picture';
import {add, partner, tube, unitVector, vector, type Sizes} from './pictures/geometry';

/** A small picture of a request: tubes as lines as wide as they are, the far ones first. */
export interface Sketch {
  lines: {from: [number, number]; to: [number, number]; width: number; tone: string}[];
}
interface Bar {
  from: Vector;
  to: Vector;
  width: number;
  tone: string;
}

export const sketchSize = [160, 96] as const;
const margin = 6;
const longest = 9; // a longer tube, in widths, would be a hair
const cutout = 'bore';
const most = 600; // bars

/** Across: of a round tube its diameter, of others the mean of height and width, if need be by the name of the size. */
function widthOf(row: Row, sizes: Sizes): number {
  const [height, width] = [Number(row['height_mm']), Number(row['width_mm'])];
  if (height > 0 && width > 0) return (height + width) / 2;
  const named = /^(?:SHS|RHS|HSS) (\d+(?:\.\d+)?)x(\d+(?:\.\d+)?)x/.exec(String(row['size'] ?? ''));
  return named ? (Number(named[1]) + Number(named[2])) / 2 : tube(row, sizes).outer;
}

const toned = (tone: number) => `partner-${tone % 6}`;

/** A partner as a straight bar; planes are not drawn. */
function barOf(given: Partner): Bar | undefined {
  if (given.kind === 'plane') return undefined;
  const width = given.kind === 'box' ? (given.width + given.height) / 2 : 2 * given.radius;
  const half = typeof given.half === 'number' ? given.half : given.half[0];
  return {from: add(given.point, given.direction, -half), to: add(given.point, given.direction, half), width, tone: toned(given.tone)};
}

const partnersOf = (rows: Row[], reach: number, sizes: Sizes): Bar[] => rows.flatMap((row, i) => barOf(partner(row, i, [0, 0, 0], reach, sizes)) ?? []);

/** Both ends of a member that is given by points. */
function memberBar(row: Row, tone: string, sizes: Sizes): Bar {
  return {from: vector(row['start_mm']), to: vector(row['end_mm']), width: widthOf(row, sizes), tone};
}

/** Cut-outs as dark strokes along the tube, where they are and about as long. */
function cutoutBars(body: Row, length: number, width: number): Bar[] {
  return rowsOf(body['cutouts']).flatMap((each) => {
    const [at, shape, pattern] = ['at', 'shape', 'pattern'].map((key) => (isRow(each[key]) ? each[key] : {})) as [Row, Row, Row];
    const along = isRow(pattern['along']) ? pattern['along'] : pattern;
    const long = Number(shape['diameter_mm'] ?? shape['along_mm'] ?? shape['length_mm'] ?? width / 4);
    const across = Number(shape['diameter_mm'] ?? shape['round_mm'] ?? shape['width_mm'] ?? width / 4);
    return Array.from({length: Math.min(40, Number(along['count'] ?? 1))}, (_, i): Bar => {
      const from = Number(at['z_mm'] ?? 0) + i * Number(along['pitch_mm'] ?? 0);
      const z = at['from'] === 'finish' ? length - from : from;
      return {from: [0, 0, z - long / 2], to: [0, 0, z + long / 2], width: Math.min(across, 0.7 * width), tone: cutout};
    });
  });
}

/** A tube that is cut, from its work point along its axis, and its partners. */
function targetBars(body: Row, sizes: Sizes): Bar[] {
  const target = body['target'] as Row;
  const width = widthOf(target, sizes);
  const ends = isRow(body['ends']) ? body['ends'] : {};
  const own = (side: string) => (isRow(ends[side]) ? rowsOf((ends[side] as Row)['cutters']) : []);
  const length = Math.min(Number(target['length_mm'] ?? 4 * width), longest * width);
  const shown = length / Number(target['length_mm'] ?? length);
  const finish = partnersOf(own('finish'), 3 * width, sizes).map((bar): Bar => {
    const there = ([x, y, z]: Vector): Vector => [x, -y, length - z];
    return {...bar, from: there(bar.from), to: there(bar.to)};
  });
  return [
    {from: [0, 0, 0], to: [0, 0, length], width, tone: 'steel'},
    ...partnersOf([...rowsOf(body['cutters']), ...own('start')], 3 * width, sizes),
    ...finish,
    ...cutoutBars(body, Number(target['length_mm']), width).map((bar): Bar => ({...bar, from: [0, 0, shown * bar.from[2]], to: [0, 0, shown * bar.to[2]]})),
  ];
}

/** A chord and the branch on it: by angles or an axis. */
function chordBars(body: Row, sizes: Sizes): Bar[] {
  const [chord, branch] = [body['chord'], body['branch']] as [Row, Row];
  const width = widthOf(chord, sizes);
  const row: Row = {kind: 'tube', clocking_deg: 90, ...branch, inclination_deg: branch['inclination_deg'] ?? body['inclination_deg'] ?? 90};
  const {point, direction} = partner(row, 0, [0, 0, 0], 3 * width, sizes) as Extract<Partner, {kind: 'tube'}>;
  const middle = Number(row['height_mm'] ?? point[2]);
  return [
    {from: [0, 0, middle - 1.6 * width], to: [0, 0, middle + 1.6 * width], width, tone: 'partner-0'},
    {from: point, to: add(point, unitVector(direction), 2 * width), width: widthOf(branch, sizes), tone: 'steel'},
  ];
}

function barsOf(body: Row, sizes: Sizes): {bars: Bar[]; lying: boolean} {
  for (const key of ['cut', 'part', 'mill_path', 'groove', 'node']) {
    const inner = isRow(body[key]) ? barsOf(body[key] as Row, sizes) : undefined;
    if (inner?.bars.length) return inner;
  }
  const members = rowsOf(body['members']).filter((row) => Array.isArray(row['start_mm']) && Array.isArray(row['end_mm']));
  if (members.length) {
    const own: Json | undefined = body['member'];
    return {bars: members.slice(0, most).map((row, i) => memberBar(row, own === undefined || row['id'] === own ? 'steel' : toned(i), sizes)), lying: false};
  }
  if (isRow(body['chord']) && isRow(body['branch'])) return {bars: chordBars(body, sizes), lying: true};
  if (isRow(body['target'])) return {bars: targetBars(body, sizes), lying: isRow(body['ends'])};
  return {bars: [], lying: false};
}

/** Seen from the front, the right and above: right, up, towards the eye. */
function seen([x, y, z]: Vector): Vector {
  const [c, s, up, tilt] = [Math.cos(0.55), Math.sin(0.55), Math.cos(0.38), Math.sin(0.38)];
  const [right, deep] = [c * x + s * y, -s * x + c * y];
  return [right, up * z + tilt * deep, -up * deep + tilt * z];
}

/** The sketch of a request, or undefined if it holds no tube with a place. */
export function sketched(body: Row, sizes: Sizes): Sketch | undefined {
  const {bars, lying} = barsOf(body, sizes);
  if (!bars.length) return undefined;
  const laid = ([x, y, z]: Vector): Vector => (lying ? [z, y, x] : [x, y, z]);
  const flat = bars.map((bar) => ({...bar, from: seen(laid(bar.from)), to: seen(laid(bar.to))}));
  flat.sort((a, b) => Number(a.tone === cutout) - Number(b.tone === cutout) || a.from[2] + a.to[2] - b.from[2] - b.to[2]);
  const over = (k: 0 | 1) => flat.flatMap(({from, to, width}) => [Math.min(from[k], to[k]) - width / 2, Math.max(from[k], to[k]) + width / 2]);
  const [left, right, low, high] = [Math.min(...over(0)), Math.max(...over(0)), Math.min(...over(1)), Math.max(...over(1))];
  const scale = Math.min((sketchSize[0] - 2 * margin) / (right - left), (sketchSize[1] - 2 * margin) / (high - low));
  const put = ([u, v]: Vector): [number, number] => [sketchSize[0] / 2 + scale * (u - (left + right) / 2), sketchSize[1] / 2 - scale * (v - (low + high) / 2)];
  return {lines: flat.map(({from, to, width, tone}) => ({from: put(from), to: put(to), width: Math.max(1.6, scale * width), tone}))};
}
