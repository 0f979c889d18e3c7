import {boreOf} from './bores.js';
import {type Axis, exact, type Found, type FrameOptions, frameOf, type Imported, names, nothing, rounded, type Size} from './frame.js';
import {cross, distance, dot, length, minus, times, unit, type Vector} from './geometry.js';

export interface PcfOptions extends FrameOptions {
  /** Of pipes whose wall the file does not tell: 'SCH 40', 'STD', 'XS', ... as GET /v1/tubes has them. */
  schedule?: string;
  /** The attribute that tells a pipe's wall; WALL-THICKNESS without it. */
  wallAttribute?: string;
}

interface Component {
  line: number;
  type: string;
  attributes: {name: string; words: string[]}[];
}

interface Units {
  coordinates: number; // mm
  bore: 'INCH' | 'MM';
}

// Joints, marks of the drawing, and things without a tube's body.
const silent = /^(WELD|SUPPORT|MESSAGE-.*|END-CONNECTION-.*|END-POSITION-.*)$/;
const somewhere = /-POINT$|^CO-ORDS$/;
const coordinateUnits: Record<string, number> = {MM: 1, 'MM-HUNDREDTH': 0.01, INCH: 25.4};

class Trouble extends Error {}

/** A component begins at the margin, its attributes are indented. */
function components(text: string): Component[] {
  const out: Component[] = [];
  text.split(/\r\n|\n|\r/).forEach((line, i) => {
    const [name, ...words] = line.trim().split(/\s+/);
    if (!name) return;
    const component = out[out.length - 1];
    if (/^\s/.test(line) && component) component.attributes.push({name, words});
    else out.push({line: i + 1, type: name, attributes: [{name, words}]});
  });
  return out;
}

/** What a file must say before its numbers mean anything. */
function units(all: Component[]): Units {
  const said = (name: string) => all.find(({type}) => type === name)?.attributes[0]?.words[0]?.toUpperCase();
  const [coordinates, bore] = [said('UNITS-CO-ORDS'), said('UNITS-BORE')];
  const mm = coordinateUnits[coordinates ?? ''];
  if (mm === undefined) throw new Trouble(`UNITS-CO-ORDS is ${coordinates ?? 'missing'}; known are ${Object.keys(coordinateUnits).join(', ')}`);
  if (bore !== 'INCH' && bore !== 'MM') throw new Trouble(`UNITS-BORE is ${bore ?? 'missing'}; known are INCH and MM`);
  return {coordinates: mm, bore};
}

const numberOf = (word: string | undefined): number => (word !== undefined && /^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$/.test(word) ? Number(word) : Number.NaN);

function pointOf(component: Component, name: string, {coordinates}: Units, nth = 0): {at: Vector; bore: number} {
  const words = component.attributes.filter((each) => each.name === name)[nth]?.words;
  if (!words) throw new Trouble(`it has no ${nth === 0 ? '' : 'second '}${name}`);
  const at = words.slice(0, 3).map((word) => numberOf(word) * coordinates);
  if (at.length < 3 || at.some(Number.isNaN)) throw new Trouble(`its ${name} is no point: ${words.join(' ')}`);
  return {at: at as Vector, bore: numberOf(words[3]?.replace(/[A-Z"]+$/i, ''))}; // 6BW: the kind of end may stand without a space
}

function boreAt(component: Component, given: Units): {nps: string; outer_diameter_mm: number} {
  const [a, b] = [0, 1].map((nth) => pointOf(component, 'END-POINT', given, nth).bore) as [number, number];
  if (Number.isNaN(a) || Number.isNaN(b)) throw new Trouble('it has no nominal bore');
  if (a !== b) throw new Trouble(`its ends have different bores, ${a} and ${b}`);
  const bore = boreOf(a, given.bore);
  if (!bore) throw new Trouble(`${a} ${given.bore} is no nominal bore that is known`);
  return bore;
}

/** By the wall that the file has, else by the schedule that was asked for. */
function sizeOf(component: Component, given: Units, options: PcfOptions): Size {
  const bore = boreAt(component, given);
  const name = options.wallAttribute ?? 'WALL-THICKNESS';
  const words = component.attributes.find((each) => each.name === name)?.words;
  if (!words) {
    if (!options.schedule) throw new Trouble(`it has no ${name}, and no schedule was given`);
    return {size: `NPS ${bore.nps} ${options.schedule}`};
  }
  const [, number, unitName] = /^([\d.]+)\s*(MM|INCH|IN|")?$/i.exec(words.join(' ')) ?? [];
  const inches = unitName ? unitName.toUpperCase() !== 'MM' : given.bore === 'INCH';
  const wall = numberOf(number) * (inches ? 25.4 : 1);
  if (!(wall > 0) || wall >= bore.outer_diameter_mm / 2) throw new Trouble(`its ${name} is no wall of NPS ${bore.nps}: ${words.join(' ')}`);
  return {outer_diameter_mm: bore.outer_diameter_mm, wall_mm: exact(wall)};
}

type Reader = (component: Component, given: Units, found: Found, name: (mark: string) => string, options: PcfOptions) => void;

const pipe: Reader = (component, given, found, name, options) => {
  const [from, to] = [0, 1].map((nth) => pointOf(component, 'END-POINT', given, nth).at) as [Vector, Vector];
  if (distance(from, to) === 0) throw new Trouble('it has no length');
  const size = sizeOf(component, given, options);
  found.members.push({id: name('pipe'), start_mm: rounded(from), end_mm: rounded(to), ...size});
};

/** CENTRE-POINT is where the two legs' lines meet. */
const elbow: Reader = (component, given, found, name) => {
  const [from, to] = [0, 1].map((nth) => pointOf(component, 'END-POINT', given, nth).at) as [Vector, Vector];
  const corner = pointOf(component, 'CENTRE-POINT', given).at;
  const {outer_diameter_mm} = boreAt(component, given);
  const [first, second] = [unit(minus(corner, from)), unit(minus(to, corner))];
  const [a, b] = [distance(from, corner), distance(corner, to)];
  if (!first || !second || Math.abs(a - b) > 1e-3 * a) throw new Trouble(`its legs are ${a} and ${b} mm long`);
  const across = minus(second, times(first, dot(second, first)));
  const inwards = length(across) > 1e-9 ? unit(across) : undefined;
  if (!inwards) throw new Trouble('its ends are in line');
  const angle = Math.atan2(length(cross(first, second)), dot(first, second));
  const axis: Axis = {point_mm: rounded(from), direction: rounded(first)};
  const bend_radius_mm = Math.round((a / Math.tan(angle / 2)) * 1e6) / 1e6; // of coordinates that were written with few digits
  const bend_deg = Math.round(((angle * 180) / Math.PI) * 1e9) / 1e9;
  found.others.push({other: {kind: 'elbow', id: name('elbow'), outer_diameter_mm, bend_radius_mm, bend_deg, axis, inwards: rounded(inwards)}});
};

/** A plane at each end that a pipe of the file ends at; settled when all pipes are known. */
const flange: Reader = (component, given, found, name) => {
  const points = [0, 1].map((nth) => pointOf(component, 'END-POINT', given, nth).at) as [Vector, Vector];
  const at = found.members.flatMap((member) =>
    points.flatMap((p) =>
      (['start', 'finish'] as const)
        .map((end) => ({member, end, p, from: end === 'start' ? member.start_mm : member.end_mm, to: end === 'start' ? member.end_mm : member.start_mm}))
        .filter(({from}) => distance(from, p) < 1e-3),
    ),
  );
  const one = at[0];
  if (!one) throw new Trouble('no pipe ends at it');
  if (at.length > 1) throw new Trouble('more than one pipe ends at it');
  const id = name('flange');
  found.others.push({other: {kind: 'plane', id, point_mm: rounded(one.from), normal: rounded(unit(minus(one.to, one.from)) as Vector)}});
  found.joints.push({between: [one.member.id, id], kind: 'set_on', end: one.end});
};

const readers: Record<string, Reader> = {PIPE: pipe, ELBOW: elbow, BEND: elbow, FLANGE: flange};

function every(text: string, found: Found, options: PcfOptions): void {
  const all = components(text);
  const given = units(all);
  const id = names();
  const counts = new Map<string, number>();
  const called = (kind: string): string => {
    counts.set(kind, (counts.get(kind) ?? 0) + 1);
    return id(`${kind} ${counts.get(kind)}`, '');
  };
  const missed: [number, string, string][] = [];
  for (const later of [false, true]) // flanges after the pipes that they are on
    for (const component of all) {
      const {line, type, attributes} = component;
      const body = readers[type] || attributes.some(({name}) => somewhere.test(name)); // else it tells of the file
      if (!body || silent.test(type) || later !== (type === 'FLANGE')) continue;
      try {
        const reader = readers[type];
        if (!reader) throw new Trouble(`${type} is not imported`);
        reader(component, given, found, called, options);
      } catch (failure) {
        if (!(failure instanceof Trouble)) throw failure;
        missed.push([line, type, failure.message]);
      }
    }
  missed.sort(([a], [b]) => a - b);
  found.notUnderstood.push(...missed.map(([line, type, reason]) => ({id: `line ${line}`, type, reason})));
}

/** Pipes, elbows and flanges of a piping component file as a frame. */
export function fromPcf(text: string, options: PcfOptions = {}): Imported {
  const found = nothing();
  try {
    every(text, found, options);
  } catch (failure) {
    if (!(failure instanceof Trouble)) throw failure;
    found.notUnderstood.push({id: 'file', type: 'PCF', reason: failure.message});
  }
  return frameOf(found, options);
}
