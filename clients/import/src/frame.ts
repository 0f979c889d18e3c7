import {limits} from './limits.js';
import {cross, distance, dot, length, minus, times, unit, type Vector} from './geometry.js';
import type {Section} from './sections.js';

/**
 * The result of all importers: a request of POST /v1/frames and the items of the file that are not
 * in it. `frame` is null if no member was found.
 */
export interface Imported {
  frame: Frame | null;
  notUnderstood: NotUnderstood[];
  /** Values that the file lacks and the import needs: options to set before the next run. */
  asks: Ask[];
  /** Where members and others come from, if the file has names of its own for them. */
  sources: Source[];
}

/**
 * `id` as the file counts: #12 of IFC, "line 12" of PCF, "row 12" of CSV, "handle 2F" of DXF. A reason that begins with
 * "assumed" is of something that is in the frame, by a value that the file does not state.
 */
export interface NotUnderstood {
  id: string;
  type: string;
  reason: string;
  /** IFC: the GlobalId. */
  guid?: string;
}

/**
 * A missing option. `key` is the item that needs it, `likely` the probable values, the most likely
 * first: no value is assumed.
 */
export interface Ask {
  option: 'bore' | 'schedule' | 'unit' | 'nodes' | 'decimal' | 'column' | 'corner';
  key?: string;
  count: number;
  likely: string[];
  text: string;
}

/** An id of the frame, and the entity that it represents. */
export interface Source {
  id: string;
  entity: string;
  type: string;
  guid?: string;
}

/** By millimetres, or by a name that GET /v1/tubes lists. */
export type Size = {outer_diameter_mm: number; wall_mm: number} | {size: string};

interface Run {
  id: string;
  start_mm: Vector;
  end_mm: Vector;
  priority?: number;
}
export type Round = Run & Size;
/** A round tube, or one of another section, whose height lies along `up`. */
export type Member = Round | (Run & Section & {up: Vector});

export interface Axis {
  point_mm: Vector;
  direction: Vector;
}

export type Other =
  | {kind: 'plane'; id: string; point_mm: Vector; normal: Vector}
  | {kind: 'rectangular_tube'; id: string; width_mm: number; height_mm: number; corner_radius_mm: number; axis: Axis; up: Vector}
  | {kind: 'elbow'; id: string; outer_diameter_mm: number; bend_radius_mm: number; bend_deg: number; axis: Axis; inwards: Vector};

export interface Joint {
  between: [string, string];
  kind: 'set_on' | 'mitre' | 'butt';
  end?: 'start' | 'finish';
  hole?: 'cut';
}

/** A request of POST /v1/frames. Values that no file contains come from `FrameOptions`. */
export interface Frame {
  members: Member[];
  others?: Other[];
  joints?: Joint[];
  connect: {within_mm: number};
  merge_in_line?: boolean;
  defaults: Record<string, unknown>;
  kerf_mm: number;
  [field: string]: unknown;
}

export interface FrameOptions {
  /** An end joins bodies within this distance, in mm (`connect` of the request). Default 5. */
  within_mm?: number;
  /** This point of the file, in mm, is the frame's origin: for coordinates of a country, where the service takes a kilometre. */
  origin_mm?: Vector;
  /** Members that continue in line become one piece (`merge_in_line` of the request). */
  merge_in_line?: boolean;
  /** Fields of the request instead of ours: `defaults`, `kerf_mm`, `torch`, ... */
  fields?: Record<string, unknown>;
}

/**
 * The result of a reader. An other's length is its extent along its axis, which the request does
 * not contain; `from` is its entity, `why` the reason for which a rectangular tube is no member.
 */
export interface Found {
  members: Member[];
  others: {other: Other; length_mm?: number; from?: {id: string; type: string; guid?: string}; why?: string}[];
  joints: Joint[];
  notUnderstood: NotUnderstood[];
  asks: Ask[];
  sources: Source[];
}

export const nothing = (): Found => ({members: [], others: [], joints: [], notUnderstood: [], asks: [], sources: []});

/** mm: `within_mm` if nobody states it. */
export const nearby = 5;

const sampled = {
  defaults: {root_surface: 'inner', groove: {rule: 'half_dihedral'}, smoothing: {method: 'none'}},
  kerf_mm: 0,
  sampling: {tolerance_mm: 0.1},
};

/** Removes the rounding errors of a change of units: 0.1143 m is 114.3 mm. */
export const exact = (mm: number): number => Number(mm.toPrecision(12));
const tidy = (v: number): number => Math.round(v * 1e9) / 1e9 + 0;
/** To 1e-9: of points in mm, of directions as they are. */
export const rounded = (v: Vector): Vector => [tidy(v[0]), tidy(v[1]), tidy(v[2])];

// characters that the contract does not permit in texts
const unwanted = /[\p{C}\p{Zl}\p{Zp}\u{FFFC}-\u{10FFFF}]+/gu;
const longest = 64; // characters of an id, by the contract

/** Gives ids: the name a file has where it is one of its own, else that name and `mark`, else `mark` and a number. */
export function names(): (name: string | undefined, mark: string) => string {
  const taken = new Set<string>();
  const numbers = new Map<string, number>(); // where to go on with a mark, so that many of one name take no longer
  return (name, mark) => {
    const clean = (name ?? '')
      .slice(0, 10 * longest)
      .replace(unwanted, ' ')
      .trim();
    const tries = [clean.slice(0, longest).trim(), clean ? `${clean.slice(0, Math.max(0, longest - mark.length - 1)).trim()} ${mark}` : mark];
    let id = tries.find((each) => each.trim() && !taken.has(each));
    for (let n = numbers.get(mark) ?? 2; id === undefined; ++n) {
      numbers.set(mark, n + 1);
      if (!taken.has(`${mark} (${n})`)) id = `${mark} (${n})`;
    }
    taken.add(id);
    return id;
  };
}

type Which = 'start' | 'finish';
const ends = (m: Member): [Which, Vector, Vector][] => [
  ['start', m.start_mm, minus(m.end_mm, m.start_mm)],
  ['finish', m.end_mm, minus(m.start_mm, m.end_mm)],
];

/** Is the end at the rectangular tube's walls, and not a piece of it in line? */
function atBox(other: Other & {kind: 'rectangular_tube'}, long: number, at: Vector, run: Vector, within: number): boolean {
  const z = unit(other.axis.direction) as Vector;
  const off = minus(at, other.axis.point_mm);
  const along = dot(off, z);
  const y = unit(minus(other.up, times(z, dot(other.up, z)))) as Vector;
  const [across, up] = [Math.abs(dot(off, cross(y, z))), Math.abs(dot(off, y))];
  return along >= -within && along <= long + within && across <= other.width_mm / 2 + within && up <= other.height_mm / 2 + within && slanted(run, z);
}

const slanted = (run: Vector, z: Vector): boolean => length(cross(run, z)) > 1e-3 * length(run);

/** Is the end on the bend, between its ends? The pipes that go on from it are square. */
function atBend(other: Other & {kind: 'elbow'}, at: Vector, run: Vector, within: number): boolean {
  const z = unit(other.axis.direction) as Vector;
  const inwards = unit(other.inwards) as Vector;
  const radius = other.bend_radius_mm;
  const off = minus(minus(at, other.axis.point_mm), times(inwards, radius));
  const [along, out, beside] = [dot(off, z), -dot(off, inwards), dot(off, cross(z, inwards))];
  const turn = Math.atan2(along, out);
  const tangent = minus(times(z, Math.cos(turn)), times(inwards, -Math.sin(turn)));
  const near = Math.hypot(Math.hypot(along, out) - radius, beside) <= other.outer_diameter_mm / 2 + within;
  return near && turn > 0 && turn < (other.bend_deg * Math.PI) / 180 && slanted(run, tangent);
}

/** No point of it is farther from where it begins. */
const reachOf = (other: Exclude<Other, {kind: 'plane'}>, long: number): number =>
  other.kind === 'elbow' ? 2 * other.bend_radius_mm + other.outer_diameter_mm : long + other.width_mm + other.height_mm;

/** The service finds the joints of members; those with the others are stated. */
function withOthers(found: Found, within: number): Joint[] {
  const joints: Joint[] = [];
  const all = found.members.flatMap((member) => ends(member).map((each) => [member, ...each] as const));
  for (const {other, length_mm} of found.others) {
    if (other.kind === 'plane') continue;
    const reach = reachOf(other, length_mm ?? Infinity) + within;
    for (const [member, end, at, run] of all) {
      if (distance(at, other.axis.point_mm) > reach) continue;
      const box = other.kind === 'rectangular_tube' && atBox(other, length_mm ?? Infinity, at, run, within);
      const bend = other.kind === 'elbow' && atBend(other, at, run, within);
      if (box || bend) joints.push({between: [member.id, other.id], kind: 'set_on', end});
    }
  }
  return joints;
}

const sized = (m: Size): string => ('size' in m ? m.size : `${m.outer_diameter_mm} x ${m.wall_mm}`);
const near = 1e-3; // mm, rad: of ends that meet in line
const crowd = 64; // ends at one place: no node has more

/**
 * Ends of equal round tubes that meet in line are face to face: by only nearness they would be
 * reported as parallel. Of other sections the service knows which way they are turned.
 */
function inLine(members: Member[]): Joint[] {
  const round = members.filter((each): each is Round => !('kind' in each));
  const cells = new Map<string, [Round, Vector, Vector][]>();
  const joints = new Map<string, Joint>();
  for (const member of round)
    for (const [, at, run] of ends(member)) {
      const key = at.map((v) => Math.round(v / 10)).join();
      for (const [other, point, way] of cells.get(key) ?? []) {
        const apart = length(cross(run, way)) / length(run) / length(way);
        if (other === member || distance(at, point) > near || apart > 1e-9 || dot(run, way) > 0 || sized(other) !== sized(member)) continue;
        joints.set(`${other.id}\n${member.id}`, {between: [other.id, member.id], kind: 'butt'});
      }
      // In the neighbouring cell as well, if the point is at a border: a pair may lie on both sides.
      const [xs, ys, zs] = at.map((v) => [...new Set([-near, near].map((step) => Math.round((v + step) / 10)))]) as [number[], number[], number[]];
      for (const beside of xs.flatMap((x) => ys.flatMap((y) => zs.map((z) => `${x},${y},${z}`)))) {
        const cell = cells.get(beside) ?? [];
        if (cell.length < crowd) cell.push([member, at, run]);
        cells.set(beside, cell);
      }
    }
  return [...joints.values()];
}

/** The same, seen from another origin. */
function moved({members, others, ...rest}: Found, origin: Vector): Found {
  const from = (p: Vector): Vector => rounded(minus(p, origin));
  const of = (other: Other): Other =>
    other.kind === 'plane' ? {...other, point_mm: from(other.point_mm)} : {...other, axis: {...other.axis, point_mm: from(other.axis.point_mm)}};
  return {
    ...rest,
    members: members.map((member) => ({...member, start_mm: from(member.start_mm), end_mm: from(member.end_mm)})),
    others: others.map(({other, ...more}) => ({...more, other: of(other)})),
  };
}

/**
 * A rectangular tube that is no member is sent if a tube ends at it, because it cuts nothing else. It is listed in any
 * case, because it is not made.
 */
function boxesTouched(found: Found, joints: Joint[]): {others: Found['others']; rest: NotUnderstood[]} {
  const joined = new Set(joints.flatMap(({between}) => between));
  const rest: NotUnderstood[] = [];
  const others = found.others.filter(({other, from, why}) => {
    if (other.kind !== 'rectangular_tube') return true;
    const touched = joined.has(other.id);
    const size = `${exact(other.width_mm)} x ${exact(other.height_mm)} mm`;
    const as = touched ? 'it only cuts the tubes that end at it, and is no member' : 'it is not in the frame';
    const reason = `a rectangular tube of ${size}, named ${other.id}: ${as}, because ${why ?? 'it is no member'}`;
    rest.push({id: from?.id ?? other.id, type: from?.type ?? 'rectangular_tube', reason, ...(from?.guid === undefined ? {} : {guid: from.guid})});
    return touched;
  });
  return {others, rest};
}

/**
 * If the service takes fewer: first omits bodies that join nothing, then the frame is too large and
 * the list states it.
 */
function fitted(found: Found, others: Found['others'], joints: Joint[]): Found['others'] {
  if (others.length <= limits.others) return others;
  const joined = new Set(joints.flatMap(({between}) => between));
  const needed = others.filter(({other}) => joined.has(other.id));
  if (needed.length > limits.others)
    found.notUnderstood.push({
      id: 'file',
      type: 'frame',
      reason: `${needed.length} others cut tubes here, and a frame has at most ${limits.others}: split the model`,
    });
  return needed;
}

const printable = ({id, type, reason, ...more}: NotUnderstood): NotUnderstood => ({id: clean(id), type: clean(type), reason: clean(reason), ...more});
/** A file's text in a message: without control characters, and not longer than can be read. */
export const clean = (text: string): string => (text.length > 500 ? `${text.slice(0, 500)} ...` : text).replace(unwanted, ' ');

function listed(notUnderstood: NotUnderstood[]): NotUnderstood[] {
  const shown = notUnderstood.slice(0, limits.listed).map(printable);
  const more = notUnderstood.length - shown.length;
  return more > 0 ? [...shown, {id: 'file', type: 'list', reason: `${more} more things are not in the frame`}] : shown;
}

/** Why there is no frame, if nothing else states it. */
function empty({notUnderstood, asks, sources}: Found, rest: NotUnderstood[], format: string): Imported {
  const all = [...notUnderstood, ...rest];
  if (!all.some(({id}) => id === 'file')) {
    const square = rest.length > 0 ? `; it has ${rest.length} rectangular ${rest.length === 1 ? 'tube' : 'tubes'}` : '';
    const reason = `there is no frame because the file has no tube that can be read as a member${square}`;
    all.push({id: 'file', type: format, reason});
  }
  return {frame: null, notUnderstood: listed(all), asks, sources};
}

/** Readers stop here: the rest of the file would not change the answer. */
export const full = ({members}: Found): boolean => members.length > limits.members;

function tooMany({notUnderstood, asks, sources}: Found): Imported {
  const reason = `there is no frame because the file has more than ${limits.members} tubes, which is more than a frame can have: split the model`;
  return {frame: null, notUnderstood: listed([...notUnderstood, {id: 'file', type: 'frame', reason}]), asks, sources};
}

// mm: beyond it, a coordinate is not plausible and 1e-9 mm are lost in rounding
const farthest = 1e9;
const isPoint = (p: Vector): boolean => p.every((v) => Math.abs(v) <= farthest);
const isLength = (v: number): boolean => v > 0 && v <= farthest;
const lengthsOf = (m: Member): number[] => ('kind' in m ? [m.height_mm, m.width_mm, m.wall_mm] : 'size' in m ? [] : [m.outer_diameter_mm, m.wall_mm]);
const isMember = (m: Member): boolean => isPoint(m.start_mm) && isPoint(m.end_mm) && lengthsOf(m).every(isLength);

function isOther(other: Other): boolean {
  if (other.kind === 'plane') return isPoint(other.point_mm);
  const sizes =
    other.kind === 'elbow' ? [other.outer_diameter_mm, other.bend_radius_mm, other.bend_deg] : [other.width_mm, other.height_mm, other.corner_radius_mm];
  return isPoint(other.axis.point_mm) && isPoint(other.axis.direction) && sizes.every(isLength);
}

/** Lists numbers that are implausibly large, with the members joined to them. */
function possible(found: Found): Found {
  const lost = [...found.members.filter((each) => !isMember(each)), ...found.others.map(({other}) => other).filter((each) => !isOther(each))].map(({id}) => id);
  if (lost.length === 0) return found;
  const gone = new Set(lost);
  const of = new Map(found.sources.map((each) => [each.id, each]));
  const notes = lost.map((id) => ({id: of.get(id)?.entity ?? id, type: of.get(id)?.type ?? 'tube', reason: 'its size or its place is beyond any frame'}));
  return {
    ...found,
    members: found.members.filter(({id}) => !gone.has(id)),
    others: found.others.filter(({other}) => !gone.has(other.id)),
    joints: found.joints.filter(({between}) => !between.some((id) => gone.has(id))),
    notUnderstood: [...found.notUnderstood, ...notes],
  };
}

/** Returns the request of the found items, and the list of the others. */
export function frameOf(given: Found, options: FrameOptions, format: string): Imported {
  const found = possible(options.origin_mm ? moved(given, options.origin_mm) : given);
  found.notUnderstood.push(...found.asks.map(({text}) => ({id: 'file', type: format, reason: text})));
  const {members, notUnderstood, asks} = found;
  if (full(found)) return tooMany(found);
  const within = options.within_mm ?? nearby;
  const stated = new Set(found.joints.map(({between}) => [...between].sort().join('\n')));
  const near = [...(options.merge_in_line ? [] : inLine(members)), ...withOthers(found, within)];
  const joints = [...found.joints, ...near.filter(({between}) => !stated.has([...between].sort().join('\n')))];
  const {others: touched, rest} = boxesTouched(found, joints);
  if (members.length === 0) return empty(found, rest, format);
  const others = fitted(found, touched, joints).map(({other}) => other);
  const frame = {
    members,
    ...(others.length > 0 ? {others} : {}),
    ...(joints.length > 0 ? {joints} : {}),
    connect: {within_mm: within},
    ...(options.merge_in_line ? {merge_in_line: true} : {}),
    ...sampled,
    ...options.fields,
  };
  const ids = new Set([...members, ...others].map(({id}) => id));
  return {frame, notUnderstood: listed([...notUnderstood, ...rest]), asks, sources: found.sources.filter(({id}) => ids.has(id))};
}

/** As text that is good to read and to edit: a member, an other, a joint, a cut-out a line. */
export function printed(frame: Record<string, unknown>): string {
  const spaced = (value: unknown): string => {
    if (Array.isArray(value)) return `[${value.map(spaced).join(', ')}]`;
    if (value === null || typeof value !== 'object') return JSON.stringify(value);
    const fields = Object.entries(value).map(([key, each]) => `${JSON.stringify(key)}: ${spaced(each)}`);
    return `{${fields.join(', ')}}`;
  };
  const lines = Object.entries(frame).map(([key, value]) => {
    const list = Array.isArray(value) && value.length > 0 && typeof value[0] === 'object';
    return `  ${JSON.stringify(key)}: ${list ? `[\n${value.map((each) => `    ${spaced(each)}`).join(',\n')}\n  ]` : spaced(value)}`;
  });
  return `{\n${lines.join(',\n')}\n}\n`;
}
