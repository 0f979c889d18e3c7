import type {NotUnderstood} from '../frame.js';
import {after, cross, dot, length, type Matrix, minus, placed, times, turned, unit, type Vector} from '../geometry.js';
import {type Arc, type Context, directrix, filleted, tangentAt} from './curves.js';
import {limits} from '../limits.js';
import {type Line, told, Trouble} from './model.js';
import {type Box, boxScaled, type Section, sectionOf} from './profiles.js';
import {axes, direction, maybeAxes, operator, point, scaleOf} from './placement.js';

/**
 * A body's shape, in the world and in the file's unit. `corner` of a tube: mitred to the tube before it. `turned` is
 * false if the file does not state how a box lies about its axis.
 */
export type Body =
  | {kind: 'tube'; from: Vector; to: Vector; outer: number; wall: number; corner?: boolean}
  | ({kind: 'box'; from: Vector; to: Vector; up: Vector; profile: Line; turned?: false} & Box)
  | {kind: 'bend'; from: Vector; direction: Vector; inwards: Vector; radius: number; angle: number; outer: number};

export interface Reading extends Context {
  notes: NotUnderstood[];
  /**
   * Number of bodies that may still be read in the whole file, so that no file can nest them
   * without end.
   */
  budget: {steps: number};
  depth?: number;
}

/** A section swept along a straight line: from and to are the middles of its ends, in the world. */
export function prism(section: Section, place: Matrix, depth: number, who: Line): Body {
  const whole = after(place, section.place);
  const scale = scaleOf(whole, who);
  const [from, to] = [whole.origin, placed(whole, [0, 0, depth])];
  if (section.kind === 'ring') return {kind: 'tube', from, to, outer: section.outer * scale, wall: section.wall * scale};
  return {kind: 'box', from, to, up: unit(whole.y) as Vector, profile: who, ...boxScaled(section, scale)};
}

function extruded(reading: Reading, solid: Line, world: Matrix): Body[] {
  const {model} = reading;
  const profile = model.of(solid, 'SweptArea');
  const section = sectionOf(reading, profile);
  const way = direction(model, model.of(solid, 'ExtrudedDirection'));
  if (Math.hypot(way[0], way[1]) > 1e-9) throw new Trouble(`${told(solid)} is extruded at a slant`);
  const depth = model.positive(solid, 'Depth');
  return [prism(section, after(world, maybeAxes(model, solid, 'Position')), way[2] * depth, profile)];
}

/** Turned about an axis in the profile's plane: a bend. */
function revolved(reading: Reading, solid: Line, world: Matrix): Body[] {
  const {model} = reading;
  const profile = model.of(solid, 'SweptArea');
  const section = sectionOf(reading, profile);
  if (section.kind !== 'ring') throw new Trouble(`${told(profile)} is no round tube`);
  const {outer} = section;
  const axis = model.of(solid, 'Axis');
  const given = model.maybe(axis, 'Axis');
  const about: Vector = given ? direction(model, given) : [0, 0, 1];
  if (Math.abs(about[2]) > 1e-9) throw new Trouble(`${told(solid)} is turned about an axis that is not in its profile's plane`);
  if (reading.radians === undefined) throw new Trouble(`${told(solid)} is turned by an angle, and the project has no unit of them`);
  const angle = model.positive(solid, 'Angle') * reading.radians;
  const place = after(world, maybeAxes(model, solid, 'Position'));
  const from = section.place.origin;
  const at = point(model, model.of(axis, 'Location'));
  const foot = minus(from, at);
  const out = minus(foot, times(about, dot(foot, about)));
  const centre = minus(from, out);
  return [bend({from, to: from, centre, normal: about, angle}, place, outer, scaleOf(place, solid))];
}

function bend(piece: Arc, place: Matrix, outer: number, scale: number): Body {
  const [from, centre] = [placed(place, piece.from), placed(place, piece.centre)];
  const inwards = minus(centre, from);
  const way = unit(turned(place, cross(piece.normal, minus(piece.from, piece.centre))));
  if (!way) throw new Trouble('a bend without a radius');
  return {kind: 'bend', from, direction: way, inwards: unit(inwards) as Vector, radius: length(inwards), angle: piece.angle, outer: outer * scale};
}

function swept(reading: Reading, solid: Line, world: Matrix): Body[] {
  const {model} = reading;
  const radius = model.positive(solid, 'Radius');
  const inner = model.positive(solid, 'InnerRadius');
  if (inner >= radius) throw new Trouble(`${told(solid)} has an InnerRadius of ${inner} and a Radius of ${radius}`);
  const scale = scaleOf(world, solid);
  const fillet = model.maybeNumber(solid, 'FilletRadius') ?? 0;
  const line = directrix(reading, solid);
  const pieces = fillet > 0 ? filleted(line, fillet, told(solid)) : line;
  return pieces.map((piece, i) => {
    const before = pieces[i - 1];
    const sharp = before !== undefined && length(cross(tangentAt(before, 'to'), tangentAt(piece, 'from'))) > 1e-6;
    if ('centre' in piece || (before && 'centre' in before)) {
      if (sharp) throw new Trouble(`${told(solid)} has a directrix with a corner at an arc`);
    }
    if ('centre' in piece) return bend(piece, world, 2 * radius, scale);
    const [from, to] = [placed(world, piece.from), placed(world, piece.to)];
    return {kind: 'tube', from, to, outer: 2 * radius * scale, wall: (radius - inner) * scale, ...(sharp ? {corner: true} : {})};
  });
}

function mapped(reading: Reading, item: Line, world: Matrix): Body[] {
  const {model} = reading;
  const source = model.of(item, 'MappingSource');
  const place = after(after(world, operator(model, model.of(item, 'MappingTarget'))), axes(model, model.of(source, 'MappingOrigin')));
  return bodies(reading, model.list(model.of(source, 'MappedRepresentation'), 'Items'), place);
}

/** Imports the tube whole and lists its cuts. Follows a cut in a cut in a cut without recursion. */
function cut(reading: Reading, solid: Line, world: Matrix): Body[] {
  const {model} = reading;
  let at = solid;
  const notes: NotUnderstood[] = [];
  for (; at.type === 'IfcBooleanClippingResult' || at.type === 'IfcBooleanResult'; at = model.of(at, 'FirstOperand')) {
    if (model.text(at, 'Operator') !== 'DIFFERENCE') throw new Trouble(`${told(at)} is no difference`);
    notes.push({id: `#${at.id}`, type: at.type, reason: 'this cut is not in the frame: the tube is whole'});
    if (notes.length > limits.clips) throw new Trouble(`${told(solid)} has more than ${limits.clips} cuts`);
  }
  const found = bodies(reading, [at], world);
  reading.notes.push(...notes);
  return found;
}

const kinds: Record<string, (reading: Reading, item: Line, world: Matrix) => Body[]> = {
  IfcExtrudedAreaSolid: extruded,
  IfcRevolvedAreaSolid: revolved,
  IfcSweptDiskSolid: swept,
  IfcSweptDiskSolidPolygonal: swept,
  IfcMappedItem: mapped,
  IfcBooleanClippingResult: cut,
  IfcBooleanResult: cut,
};

export function bodies(given: Reading, items: Line[], world: Matrix): Body[] {
  const reading = {...given, depth: (given.depth ?? 0) + 1};
  const out: Body[] = [];
  for (const item of items) {
    const kind = Object.hasOwn(kinds, item.type) ? kinds[item.type] : undefined;
    if (!kind) throw new Trouble(`${told(item)} is no solid that is known`);
    if (reading.depth > limits.depth) throw new Trouble(`${told(item)} is nested more than ${limits.depth} deep`);
    if (--reading.budget.steps < 0) throw new Trouble(`${told(item)} is one of more than ${limits.steps} bodies, and no more are read`);
    out.push(...kind(reading, item, world));
    if (out.length > limits.members) throw new Trouble(`${told(item)} is one of more than ${limits.members} bodies of a product`);
  }
  return out;
}
