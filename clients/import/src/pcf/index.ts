import {type Axis, type Found, type FrameOptions, frameOf, full, type Imported, type Member, names, nearby, nothing, rounded} from '../frame.js';
import {cross, distance, dot, length, minus, times, unit, type Vector} from '../geometry.js';
import {Fittings} from './fittings.js';
import {type SizeOptions, Sizes} from './sizes.js';
import {type Component, components, pointOf, Trouble, type Units, unitsOf} from './text.js';

export interface PcfOptions extends FrameOptions, SizeOptions {}

// Joints, marks of the drawing, and things without a tube's body.
const silent = /^(WELD|SUPPORT|BOLT|MESSAGE-.*|END-CONNECTION-.*|END-POSITION-.*)$/;
const somewhere = /-POINT$|^CO-ORDS$/;
const pipes = /^PIPE(-FIXED)?$/;
const elbows = /^(ELBOW|BEND)$/;
const tubes = /^(PIPE|PIPE-FIXED|ELBOW|BEND)$/;

interface Reading {
  units: Units;
  sizes: Sizes;
  found: Found;
  pipeOf: Map<Component, Member>;
}

function pipe(component: Component, name: string, {units, sizes, found, pipeOf}: Reading): void {
  const [from, to] = [0, 1].map((nth) => pointOf(component, 'END-POINT', units, nth).at) as [Vector, Vector];
  if (distance(from, to) === 0) throw new Trouble('it has no length');
  const member = {id: name, start_mm: rounded(from), end_mm: rounded(to), ...sizes.of(component)};
  found.members.push(member);
  pipeOf.set(component, member);
}

/** CENTRE-POINT is where the two legs' lines meet. */
function elbow(component: Component, name: string, {units, sizes, found}: Reading): void {
  const [from, to] = [0, 1].map((nth) => pointOf(component, 'END-POINT', units, nth).at) as [Vector, Vector];
  const corner = pointOf(component, 'CENTRE-POINT', units).at;
  const {outer_diameter_mm} = sizes.bore(component);
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
  found.others.push({other: {kind: 'elbow', id: name, outer_diameter_mm, bend_radius_mm, bend_deg, axis, inwards: rounded(inwards)}});
}

const word = (type: string): string => (pipes.test(type) ? 'pipe' : elbows.test(type) ? 'elbow' : type.toLowerCase().slice(0, 32));

function every(text: string, found: Found, options: PcfOptions): void {
  const all = components(text);
  const units = unitsOf(all);
  const id = names();
  const counts = new Map<string, number>();
  const called = (type: string): string => {
    const kind = word(type);
    counts.set(kind, (counts.get(kind) ?? 0) + 1);
    return id(`${kind} ${counts.get(kind)}`, '');
  };
  // Components without a point describe the file.
  const placed = all.filter(({type, attributes}) => !silent.test(type) && (tubes.test(type) || attributes.some(({name}) => somewhere.test(name))));
  const reading: Reading = {units, sizes: new Sizes(all, units, options, tubes), found, pipeOf: new Map()};
  const trying = ({line, type}: Component, read: () => void): void => {
    try {
      read();
    } catch (failure) {
      if (!(failure instanceof Trouble)) throw failure;
      found.notUnderstood.push({id: `line ${line}`, type, reason: failure.message});
    }
  };
  const elbowNames = new Map<Component, string>();
  for (const component of placed.filter(({type}) => tubes.test(type))) {
    if (full(found)) return;
    const name = called(component.type);
    elbowNames.set(component, name);
    trying(component, () => (pipes.test(component.type) ? pipe : elbow)(component, name, reading));
  }
  // Then the bodies that the pipes meet.
  const fittings = new Fittings(found, placed, units, reading.pipeOf, options.within_mm ?? nearby);
  for (const component of placed) {
    if (elbows.test(component.type)) trying(component, () => fittings.planes(component, `${elbowNames.get(component)} end`));
    else if (!pipes.test(component.type)) trying(component, () => fittings.read(component, called(component.type)));
    fittings.taps(component);
  }
  const place = ({id: at}: {id: string}): number => Number(at.slice('line '.length));
  found.notUnderstood.sort((a, b) => place(a) - place(b));
  found.asks.push(...reading.sizes.asks());
}

/** Pipes, elbows, fittings and branches of a piping component file as a frame. */
export function fromPcf(text: string, options: PcfOptions = {}): Imported {
  const found = nothing();
  try {
    every(text, found, options);
  } catch (failure) {
    if (!(failure instanceof Trouble)) throw failure;
    found.notUnderstood.push({id: 'file', type: 'PCF', reason: failure.message});
  }
  return frameOf(found, options, 'PCF');
}
