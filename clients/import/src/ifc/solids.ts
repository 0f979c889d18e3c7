import type {NotUnderstood} from '../frame.js';
import {after, cross, dot, length, type Matrix, minus, placed, times, turned, unit, type Vector} from '../geometry.js';
import {type Arc, type Context, directrix, filleted, tangentAt} from './curves.js';
import {type Line, told, Trouble} from './model.js';
import {axes, direction, maybeAxes, operator, point, scaleOf} from './placement.js';

/** What a body is made of, in the world and in the file's unit. `corner`: mitred to the tube before it. */
export type Body =
  | {kind: 'tube'; from: Vector; to: Vector; outer: number; wall: number; corner?: boolean}
  | {kind: 'box'; from: Vector; to: Vector; width: number; height: number; corner_radius: number; up: Vector}
  | {kind: 'bend'; from: Vector; direction: Vector; inwards: Vector; radius: number; angle: number; outer: number};

interface Reading extends Context {
  notes: NotUnderstood[];
  corner: number | undefined; // of rectangular tubes that tell none, in the file's unit
}

/** A ring's size, in the units of its own coordinates. */
function ring({model}: Reading, profile: Line): {outer: number; wall: number} {
  const radius = model.positive(profile, 'Radius');
  const wall = model.positive(profile, 'WallThickness');
  if (wall >= radius) throw new Trouble(`${told(profile)} has a wall of ${wall} and a radius of ${radius}`);
  return {outer: 2 * radius, wall};
}

function box({model, corner}: Reading, profile: Line, scale: number) {
  const own = model.maybeNumber(profile, 'OuterFilletRadius') ?? 0;
  const corner_radius = own > 0 ? own * scale : corner;
  if (corner_radius === undefined) throw new Trouble(`${told(profile)} has no OuterFilletRadius: the service takes no sharp corners`);
  model.positive(profile, 'WallThickness');
  return {width: model.positive(profile, 'XDim') * scale, height: model.positive(profile, 'YDim') * scale, corner_radius};
}

function extruded(reading: Reading, solid: Line, world: Matrix): Body[] {
  const {model} = reading;
  const profile = model.of(solid, 'SweptArea');
  if (!/^Ifc(Circle|Rectangle)HollowProfileDef$/.test(profile.type)) throw new Trouble(`${told(profile)} is no tube`);
  const way = direction(model, model.of(solid, 'ExtrudedDirection'));
  if (Math.hypot(way[0], way[1]) > 1e-9) throw new Trouble(`${told(solid)} is extruded at a slant`);
  const depth = model.positive(solid, 'Depth');
  const place = after(after(world, maybeAxes(model, solid, 'Position')), maybeAxes(model, profile, 'Position'));
  const scale = scaleOf(place, solid);
  const [from, to] = [place.origin, placed(place, [0, 0, way[2] * depth])];
  if (profile.type === 'IfcCircleHollowProfileDef') {
    const {outer, wall} = ring(reading, profile);
    return [{kind: 'tube', from, to, outer: outer * scale, wall: wall * scale}];
  }
  return [{kind: 'box', from, to, up: unit(place.y) as Vector, ...box(reading, profile, scale)}];
}

/** Turned about an axis in the profile's plane: a bend. */
function revolved(reading: Reading, solid: Line, world: Matrix): Body[] {
  const {model} = reading;
  const profile = model.of(solid, 'SweptArea');
  if (profile.type !== 'IfcCircleHollowProfileDef') throw new Trouble(`${told(profile)} is no tube`);
  const {outer} = ring(reading, profile);
  const axis = model.of(solid, 'Axis');
  const given = model.maybe(axis, 'Axis');
  const about: Vector = given ? direction(model, given) : [0, 0, 1];
  if (Math.abs(about[2]) > 1e-9) throw new Trouble(`${told(solid)} is turned about an axis that is not in its profile's plane`);
  if (reading.radians === undefined) throw new Trouble(`${told(solid)} is turned by an angle, and the project has no unit of them`);
  const angle = model.positive(solid, 'Angle') * reading.radians;
  const place = after(world, maybeAxes(model, solid, 'Position'));
  const from = maybeAxes(model, profile, 'Position').origin;
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

/** The tube is imported whole; what is cut from it is listed. */
function cut(reading: Reading, solid: Line, world: Matrix): Body[] {
  const {model} = reading;
  if (model.text(solid, 'Operator') !== 'DIFFERENCE') throw new Trouble(`${told(solid)} is no difference`);
  const found = bodies(reading, [model.of(solid, 'FirstOperand')], world);
  reading.notes.push({id: `#${solid.id}`, type: solid.type, reason: 'this cut is not in the frame: the tube is whole'});
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

export function bodies(reading: Reading, items: Line[], world: Matrix): Body[] {
  return items.flatMap((item) => {
    const kind = kinds[item.type];
    if (!kind) throw new Trouble(`${told(item)} is no solid that is known`);
    return kind(reading, item, world);
  });
}
