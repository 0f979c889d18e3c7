import {exact} from '../frame.js';
import {after, cross, distance, dot, identity, length, type Matrix, minus, placed, times, unit, type Vector} from '../geometry.js';
import {limits} from '../limits.js';
import {type Arc, type Context, joined, type Piece, wayOf} from './curves.js';
import {type Line, told, Trouble} from './model.js';
import {axes, maybeAxes, operator2d} from './placement.js';

/** A tube's section about its own middle, in the profile's unit; `place` is where its middle and axes lie in the profile's plane. */
export type Section = {place: Matrix} & ({kind: 'ring'; outer: number; wall: number} | ({kind: 'box'} & Box));

/** Width along x, height along y. Of the outer corner, undefined is sharp; of the inner one, not stated. */
export interface Box {
  width: number;
  height: number;
  wall: number;
  corner: number | undefined;
  inner: number | undefined;
}

/** A profile in another scale. */
export const boxScaled = ({width, height, wall, corner, inner}: Box, k: number): Box => ({
  width: width * k,
  height: height * k,
  wall: wall * k,
  corner: corner && corner * k,
  inner: inner && inner * k,
});

function ring({model}: Context, profile: Line): Section {
  const radius = model.positive(profile, 'Radius');
  const wall = model.positive(profile, 'WallThickness');
  if (wall >= radius) throw new Trouble(`${told(profile)} has a wall of ${wall} and a radius of ${radius}`);
  return {kind: 'ring', outer: 2 * radius, wall, place: maybeAxes(model, profile, 'Position')};
}

function box({model}: Context, profile: Line): Section {
  const [corner, inner] = [model.maybeNumber(profile, 'OuterFilletRadius') ?? 0, model.maybeNumber(profile, 'InnerFilletRadius')];
  const [wall, width, height] = [model.positive(profile, 'WallThickness'), model.positive(profile, 'XDim'), model.positive(profile, 'YDim')];
  if (2 * wall >= Math.min(width, height)) throw new Trouble(`${told(profile)} has a wall of ${wall} and sides of ${width} and ${height}`);
  if (corner < 0 || (inner ?? 0) < 0) throw new Trouble(`${told(profile)} has a corner radius that is less than 0`);
  return {kind: 'box', width, height, wall, corner: corner || undefined, inner, place: maybeAxes(model, profile, 'Position')};
}

interface Outline {
  middle: Vector;
  shape: {kind: 'circle'; radius: number} | {kind: 'rectangle'; x: Vector; width: number; height: number; corner: number};
}

const close = 1e-6; // of its size: how far an outline may be from the shape that it is taken for

/** Full arcs about one middle. */
function circle(pieces: Piece[], who: string): Outline | undefined {
  const arcs = pieces.filter((each): each is Arc => 'centre' in each);
  const [first] = arcs;
  if (!first || arcs.length < pieces.length) return undefined;
  const radius = distance(first.centre, first.from);
  const alike = arcs.every(({centre, from}) => distance(centre, first.centre) <= close * radius && Math.abs(distance(centre, from) - radius) <= close * radius);
  const turn = arcs.reduce((sum, {angle, normal}) => sum + angle * Math.sign(dot(normal, first.normal)), 0);
  if (!alike) return undefined;
  if (Math.abs(Math.abs(turn) - 2 * Math.PI) > close) throw new Trouble(`${who} has an outline that is not closed`);
  return {middle: first.centre, shape: {kind: 'circle', radius}};
}

/** Four sides square to each other, with corners that are sharp or of one radius. */
function rectangle(pieces: Piece[]): Outline | undefined {
  const sides = straightened(pieces.filter((each) => !('centre' in each)));
  const arcs = pieces.filter((each): each is Arc => 'centre' in each);
  if (sides.length !== 4 || (arcs.length !== 0 && arcs.length !== 4)) return undefined;
  const [a, b, c, d] = sides.map(({from, to}) => minus(to, from)) as [Vector, Vector, Vector, Vector];
  const size = length(a) + length(b);
  const x = unit(a);
  const corner = arcs[0] ? distance(arcs[0].centre, arcs[0].from) : 0;
  const square =
    x &&
    Math.abs(dot(a, b)) <= close * length(a) * length(b) &&
    length(minus(a, times(c, -1))) <= close * size &&
    length(minus(b, times(d, -1))) <= close * size;
  const round = arcs.every(({centre, from, angle}) => Math.abs(distance(centre, from) - corner) <= close * size && Math.abs(angle - Math.PI / 2) <= 1e-4);
  if (!square || !round) return undefined;
  const middle = sides.reduce<Vector>((sum, {from, to}) => [sum[0] + (from[0] + to[0]) / 8, sum[1] + (from[1] + to[1]) / 8, 0], [0, 0, 0]);
  return {middle, shape: {kind: 'rectangle', x, width: length(a) + 2 * corner, height: length(b) + 2 * corner, corner}};
}

/** Sides that go on in line made one, also over the place where the outline begins. */
function straightened(pieces: Piece[]): Piece[] {
  const out: Piece[] = [];
  for (const piece of pieces) {
    const last = out[out.length - 1];
    if (last && goesOn(last, piece)) out[out.length - 1] = {from: last.from, to: piece.to};
    else out.push(piece);
  }
  const [first, last] = [out[0], out[out.length - 1]];
  if (first && last && first !== last && goesOn(last, first)) return [...out.slice(1, -1), {from: last.from, to: first.to}];
  return out;
}

function goesOn(a: Piece, b: Piece): boolean {
  const [u, v] = [minus(a.to, a.from), minus(b.to, b.from)];
  const size = length(u) + length(v);
  return distance(a.to, b.from) <= close * size && dot(u, v) > 0 && length(cross(u, v)) <= 1e-9 * length(u) * length(v);
}

function outline(context: Context, line: Line): Outline {
  const {model} = context;
  if (line.type === 'IfcCircle')
    return {middle: axes(model, model.of(line, 'Position')).origin, shape: {kind: 'circle', radius: model.positive(line, 'Radius')}};
  const pieces = joined(wayOf(context, line).pieces, told(line));
  const [first, last] = [pieces[0] as Piece, pieces[pieces.length - 1] as Piece];
  if (distance(first.from, last.to) > close * Math.max(...pieces.map(({from, to}) => distance(from, to)))) throw new Trouble(`${told(line)} is not closed`);
  const found = circle(pieces, told(line)) ?? rectangle(pieces);
  if (found) return found;
  const round = regular(pieces);
  throw new Trouble(
    round
      ? `${told(line)} is a polygon of ${pieces.length} sides on a circle of ${exact(2 * round)}: whether a round tube is meant is not certain`
      : `${told(line)} is neither a circle nor a rectangle`,
  );
}

/** The radius of a circle that all corners lie on, if there are many. */
function regular(pieces: Piece[]): number | undefined {
  if (pieces.length < 8 || pieces.some((each) => 'centre' in each)) return undefined;
  const middle = times(
    pieces.reduce<Vector>((sum, {from}) => [sum[0] + from[0], sum[1] + from[1], 0], [0, 0, 0]),
    1 / pieces.length,
  );
  const radii = pieces.map(({from}) => distance(from, middle));
  const most = Math.max(...radii);
  return most - Math.min(...radii) <= 1e-3 * most ? most : undefined;
}

/** An outline with one void in its middle: a tube, if both are circles or rectangles. */
function withVoid(context: Context, profile: Line): Section {
  const {model} = context;
  const voids = model.list(profile, 'InnerCurves');
  if (voids.length !== 1 || !voids[0]) throw new Trouble(`${told(profile)} has ${voids.length} voids, and a tube has one`);
  const [outer, inner] = [outline(context, model.of(profile, 'OuterCurve')), outline(context, voids[0])];
  const [a, b] = [outer.shape, inner.shape];
  const off = distance(outer.middle, inner.middle);
  if (a.kind === 'circle' && b.kind === 'circle') {
    if (b.radius >= a.radius) throw new Trouble(`${told(profile)} has a void that is larger than its outline`);
    if (off > close * a.radius) throw new Trouble(`${told(profile)} has a void that is ${exact(off)} off its middle`);
    return {kind: 'ring', outer: 2 * a.radius, wall: a.radius - b.radius, place: {...identity, origin: outer.middle}};
  }
  if (a.kind !== 'rectangle' || b.kind !== 'rectangle') throw new Trouble(`${told(profile)} is no tube: its outline is a ${a.kind} and its void a ${b.kind}`);
  const turned = Math.min(Math.abs(dot(a.x, b.x)), Math.abs(cross(a.x, b.x)[2]));
  const [width, height] = Math.abs(dot(a.x, b.x)) > 0.5 ? [b.width, b.height] : [b.height, b.width];
  const [side, floor] = [(a.width - width) / 2, (a.height - height) / 2];
  const even = side > 0 && Math.abs(side - floor) <= close * a.width && turned <= close && off <= close * a.width;
  if (!even) throw new Trouble(`${told(profile)} is no tube: its wall is not the same all around`);
  const place = {x: a.x, y: cross([0, 0, 1], a.x), z: identity.z, origin: outer.middle};
  return {kind: 'box', width: a.width, height: a.height, wall: side, corner: a.corner || undefined, inner: b.corner, place};
}

/** Another profile, moved in its plane. */
function derivedFrom(context: Context, profile: Line, depth: number): Section {
  const {model} = context;
  const parent = sectionOf(context, model.of(profile, 'ParentProfile'), depth + 1);
  const mirror: Matrix = {...identity, x: [-1, 0, 0]};
  const move = profile.type === 'IfcMirroredProfileDef' ? mirror : operator2d(model, model.of(profile, 'Operator'));
  const scale = length(move.x);
  if (Math.abs(length(move.y) - scale) > 1e-9 * scale) throw new Trouble(`${told(profile)} is scaled differently in its directions`);
  const place = after(move, parent.place);
  // A tube's section is its own mirror image, so only its centre and rotation matter.
  const x = unit(place.x) as Vector;
  const own = {x, y: cross([0, 0, 1], x), z: identity.z, origin: placed(move, parent.place.origin)};
  if (parent.kind === 'ring') return {kind: 'ring', outer: parent.outer * scale, wall: parent.wall * scale, place: own};
  return {kind: 'box', ...boxScaled(parent, scale), place: own};
}

const kinds: Record<string, (context: Context, profile: Line, depth: number) => Section> = {
  IfcCircleHollowProfileDef: ring,
  IfcRectangleHollowProfileDef: box,
  IfcArbitraryProfileDefWithVoids: withVoid,
  IfcDerivedProfileDef: derivedFrom,
  IfcMirroredProfileDef: derivedFrom,
};

/** The section of a profile that is a tube. */
export function sectionOf(context: Context, profile: Line, depth = 0): Section {
  const kind = Object.hasOwn(kinds, profile.type) ? kinds[profile.type] : undefined;
  if (!kind) throw new Trouble(`${told(profile)} is no tube`);
  if (depth > limits.depth) throw new Trouble(`${told(profile)} is nested too deep`);
  return kind(context, profile, depth);
}
