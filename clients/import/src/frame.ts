import {cross, distance, dot, length, minus, times, unit, type Vector} from './geometry.js';

/** What all importers give: a request of POST /v1/frames and what of the file is not in it. `frame` is null where no member was found. */
export interface Imported {
  frame: Frame | null;
  notUnderstood: NotUnderstood[];
}

/** `id` as the file counts: #12 of IFC, "line 12" of PCF, "row 12" of CSV, "handle 2F" of DXF. */
export interface NotUnderstood {
  id: string;
  type: string;
  reason: string;
}

/** By millimetres, or by a name that GET /v1/tubes lists. */
export type Size = {outer_diameter_mm: number; wall_mm: number} | {size: string};

export type Member = {id: string; start_mm: Vector; end_mm: Vector; priority?: number} & Size;

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
}

/** A request of POST /v1/frames. What no file tells is as `FrameOptions` say. */
export interface Frame {
  members: Member[];
  others?: Other[];
  joints?: Joint[];
  connect: {within_mm: number};
  defaults: Record<string, unknown>;
  kerf_mm: number;
  [field: string]: unknown;
}

export interface FrameOptions {
  /** An end joins what it comes as near as this to, in mm (`connect` of the request). 5 without it. */
  within_mm?: number;
  /** This point of the file, in mm, is the frame's origin: for coordinates of a country, where the service takes a kilometre. */
  origin_mm?: Vector;
  /** Fields of the request instead of ours: `defaults`, `kerf_mm`, `torch`, ... */
  fields?: Record<string, unknown>;
}

/** What a reader found. An other's length is how far it goes along its axis; the request knows it without end. */
export interface Found {
  members: Member[];
  others: {other: Other; length_mm?: number}[];
  joints: Joint[];
  notUnderstood: NotUnderstood[];
}

export const nothing = (): Found => ({members: [], others: [], joints: [], notUnderstood: []});

const sampled = {
  defaults: {root_surface: 'inner', groove: {rule: 'half_dihedral'}, smoothing: {method: 'none'}},
  kerf_mm: 0,
  sampling: {tolerance_mm: 0.1},
};

/** Lengths lose what came in by a change of units: 0.1143 m is 114.3 mm. */
export const exact = (mm: number): number => Number(mm.toPrecision(12));
const tidy = (v: number): number => Math.round(v * 1e9) / 1e9 + 0;
/** To 1e-9: of points in mm, of directions as they are. */
export const rounded = (v: Vector): Vector => [tidy(v[0]), tidy(v[1]), tidy(v[2])];

const unwanted = /[\p{C}\p{Zl}\p{Zp}\u{FFFC}-\u{10FFFF}]+/gu; // what the contract takes for no text
const longest = 64; // characters of an id, by the contract

/** Gives ids: the name a file has where it is one of its own, else that name and `mark`. */
export function names(): (name: string | undefined, mark: string) => string {
  const taken = new Set<string>();
  return (name, mark) => {
    const clean = (name ?? '').replace(unwanted, ' ').trim();
    const tries = [clean.slice(0, longest).trim(), clean ? `${clean.slice(0, longest - mark.length - 1).trim()} ${mark}` : mark];
    for (let n = 2; tries.every((id) => !id || taken.has(id)); ++n) tries.push(`${mark} (${n})`);
    const id = tries.find((each) => each && !taken.has(each)) as string;
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

/** The service finds the joints of members; those with the others are stated. */
function withOthers(found: Found, within: number): Joint[] {
  const joints: Joint[] = [];
  for (const {other, length_mm} of found.others)
    for (const member of found.members)
      for (const [end, at, run] of ends(member)) {
        const box = other.kind === 'rectangular_tube' && atBox(other, length_mm ?? Infinity, at, run, within);
        const bend = other.kind === 'elbow' && atBend(other, at, run, within);
        if (box || bend) joints.push({between: [member.id, other.id], kind: 'set_on', end});
      }
  return joints;
}

const sized = (m: Member): string => ('size' in m ? m.size : `${m.outer_diameter_mm} x ${m.wall_mm}`);
const near = 1e-3; // mm, rad: of ends that meet in line

/** Ends of alike tubes that meet in line are face to face: by nearness alone they would be said to be parallel. */
function inLine(members: Member[]): Joint[] {
  const cells = new Map<string, [Member, Vector, Vector][]>();
  const joints = new Map<string, Joint>();
  for (const member of members)
    for (const [, at, run] of ends(member)) {
      const key = at.map((v) => Math.round(v / 10)).join();
      for (const [other, point, way] of cells.get(key) ?? []) {
        const apart = length(cross(run, way)) / length(run) / length(way);
        if (other === member || distance(at, point) > near || apart > 1e-9 || dot(run, way) > 0 || sized(other) !== sized(member)) continue;
        joints.set(`${other.id}\n${member.id}`, {between: [other.id, member.id], kind: 'butt'});
      }
      // In the neighbouring cells as well: a pair may lie on both sides of a border.
      for (const x of [-1, 0, 1])
        for (const y of [-1, 0, 1])
          for (const z of [-1, 0, 1]) {
            const beside = [x, y, z].map((step, i) => Math.round((at[i as 0] + step * near) / 10)).join();
            const cell = cells.get(beside) ?? [];
            if (!cell.some(([one, point]) => one === member && point === at)) cell.push([member, at, run]);
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

/** The request of what was found, and what was not. */
export function frameOf(given: Found, options: FrameOptions = {}): Imported {
  const found = options.origin_mm ? moved(given, options.origin_mm) : given;
  const {members, notUnderstood} = found;
  if (members.length === 0) return {frame: null, notUnderstood};
  const within = options.within_mm ?? 5;
  const others = found.others.map(({other}) => other);
  const stated = new Set(found.joints.map(({between}) => [...between].sort().join('\n')));
  const more = [...inLine(members), ...withOthers(found, within)].filter(({between}) => !stated.has([...between].sort().join('\n')));
  const joints = [...found.joints, ...more];
  const frame = {
    members,
    ...(others.length > 0 ? {others} : {}),
    ...(joints.length > 0 ? {joints} : {}),
    connect: {within_mm: within},
    ...sampled,
    ...options.fields,
  };
  return {frame, notUnderstood};
}

/** As text that is good to read and to edit: a member, an other, a joint a line. */
export function printed(frame: Frame): string {
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
