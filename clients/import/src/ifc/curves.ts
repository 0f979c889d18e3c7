import {add, cross, distance, dot, length, minus, placed, times, unit, type Vector} from '../geometry.js';
import {limits} from '../limits.js';
import {type Line, type Model, told, Trouble} from './model.js';
import {axes, direction, point, towards} from './placement.js';

/** A straight piece, or an arc about the unit vector `normal` from `from` through `angle` (rad, more than 0). */
export type Arc = {from: Vector; to: Vector; centre: Vector; normal: Vector; angle: number};
export type Piece = {from: Vector; to: Vector} | Arc;
/** `range` is how far the curve's parameter goes, where it is known. */
interface Way {
  pieces: Piece[];
  range?: number;
}

export interface Context {
  model: Model;
  radians: number | undefined;
  codes: {line: number; arc: number};
  /** How many curves the one that is read lies in. */
  nested?: number;
}

const straight = (points: Vector[]): Piece[] => points.slice(1).map((to, i) => ({from: points[i] as Vector, to}));

function polyline({model}: Context, line: Line): Way {
  const points = model.list(line, 'Points', limits.points).map((each) => point(model, each));
  return {pieces: straight(points), range: points.length - 1};
}

/** The arc from a over b to c. */
function arcThrough(a: Vector, b: Vector, c: Vector, who: string): Piece {
  const [p, q] = [minus(b, a), minus(c, a)];
  const n = cross(p, q);
  const square = dot(n, n);
  const normal = unit(n);
  if (!normal || square < 1e-18 * dot(p, p) * dot(q, q)) throw new Trouble(`${who} has an arc of three points in line`);
  const to = times(add(times(cross(q, n), -dot(p, p)), times(cross(p, n), dot(q, q))), -1 / (2 * square));
  const centre = add(a, to);
  const angle = turnFrom(minus(a, centre), minus(c, centre), normal);
  return {from: a, to: c, centre, normal, angle};
}

/** By how much (0 to 2 pi) `a` is turned about `normal` to look as `b` does. */
const turnFrom = (a: Vector, b: Vector, normal: Vector): number => {
  const angle = Math.atan2(dot(cross(a, b), normal), dot(a, b));
  return angle > 0 ? angle : angle + 2 * Math.PI;
};

function indexed({model, codes}: Context, line: Line): Way {
  const points = model.vectors(model.of(line, 'Points'), 'CoordList');
  const at = (index: number): Vector => {
    const found = points[index - 1];
    if (!found) throw new Trouble(`${told(line)} names its point ${index}, of ${points.length}`);
    return found;
  };
  if (points.length > limits.points) throw new Trouble(`${told(line)} has more than ${limits.points} points`);
  const segments = model.selected(line, 1);
  if (segments.length > limits.points) throw new Trouble(`${told(line)} has more than ${limits.points} segments`);
  if (segments.length === 0) return {pieces: straight(points)};
  const pieces = segments.flatMap(({code, values}) => {
    if (code === codes.line) return straight(values.map(at));
    const [a, b, c] = values.map(at);
    if (code !== codes.arc || !a || !b || !c) throw new Trouble(`${told(line)} has a segment that is neither a line nor an arc`);
    return [arcThrough(a, b, c, told(line))];
  });
  return {pieces};
}

const backwards = (piece: Piece): Piece =>
  'centre' in piece ? {...piece, from: piece.to, to: piece.from, normal: times(piece.normal, -1)} : {from: piece.to, to: piece.from};

function composite(context: Context, line: Line): Way {
  let range: number | undefined = 0;
  const nested = (context.nested ?? 0) + 1;
  if (nested > limits.depth) throw new Trouble(`${told(line)} is nested more than ${limits.depth} deep`);
  let count = 0;
  const pieces = context.model.list(line, 'Segments', limits.points).flatMap((segment) => {
    if (!segment.type.endsWith('CompositeCurveSegment')) throw new Trouble(`${told(segment)} is no IfcCompositeCurveSegment`);
    const way = wayOf({...context, nested}, context.model.of(segment, 'ParentCurve'));
    count += way.pieces.length;
    if (count > limits.points) throw new Trouble(`${told(line)} has more than ${limits.points} pieces`);
    range = range === undefined || way.range === undefined ? undefined : range + way.range;
    return context.model.flag(segment, 'SameSense') ? way.pieces : way.pieces.map(backwards).reverse();
  });
  return range === undefined ? {pieces} : {pieces, range};
}

/** Where a trimmed curve begins and ends, by its basis curve's parameter. */
function trims({model}: Context, line: Line, parameterOf: (p: Vector) => number, perUnit: () => number): [number, number] {
  const byPoint = model.text(line, 'MasterRepresentation') === 'CARTESIAN';
  const one = (name: string): number => {
    const given = model.mixed(line, name);
    if (given.line && (byPoint || given.number === undefined)) return parameterOf(point(model, given.line));
    if (given.number === undefined) throw new Trouble(`${told(line)} has no ${name}`);
    return given.number * perUnit();
  };
  return [one('Trim1'), one('Trim2')];
}

function lineOf({model}: Context, line: Line): {from: Vector; step: Vector; magnitude: number} {
  const vector = model.of(line, 'Dir');
  const magnitude = model.positive(vector, 'Magnitude');
  return {from: point(model, model.of(line, 'Pnt')), step: times(direction(model, model.of(vector, 'Orientation')), magnitude), magnitude};
}

function trimmed(context: Context, line: Line): Way {
  const {model} = context;
  const basis = model.of(line, 'BasisCurve');
  const same = model.flag(line, 'SenseAgreement');
  if (basis.type === 'IfcLine') {
    const {from, step} = lineOf(context, basis);
    const [a, b] = trims(
      context,
      line,
      (p) => dot(minus(p, from), step) / dot(step, step),
      () => 1,
    );
    return {pieces: [{from: towards(from, step, a), to: towards(from, step, b)}], range: Math.abs(b - a)};
  }
  if (basis.type !== 'IfcCircle') throw new Trouble(`${told(basis)} is neither a line nor a circle`);
  const place = axes(model, model.of(basis, 'Position'));
  const radius = model.positive(basis, 'Radius');
  const perUnit = () => {
    if (context.radians === undefined) throw new Trouble(`${told(line)} is trimmed by angles, and the project has no unit of them`);
    return context.radians;
  };
  const angleOf = (p: Vector) => Math.atan2(dot(minus(p, place.origin), place.y), dot(minus(p, place.origin), place.x));
  const [a, b] = trims(context, line, angleOf, perUnit);
  const at = (angle: number) => placed(place, [radius * Math.cos(angle), radius * Math.sin(angle), 0]);
  const whole = 2 * Math.PI;
  const angle = (((same ? b - a : a - b) % whole) + whole) % whole || whole;
  const piece = {from: at(a), to: at(b), centre: place.origin, normal: times(place.z, same ? 1 : -1), angle};
  return context.radians === undefined ? {pieces: [piece]} : {pieces: [piece], range: angle / context.radians};
}

const kinds: Record<string, (context: Context, line: Line) => Way> = {
  IfcPolyline: polyline,
  IfcIndexedPolyCurve: indexed,
  IfcCompositeCurve: composite,
  IfcTrimmedCurve: trimmed,
};

/** The pieces of a curve, as it is drawn. */
export function wayOf(context: Context, line: Line): Way {
  const kind = Object.hasOwn(kinds, line.type) ? kinds[line.type] : undefined;
  if (!kind) throw new Trouble(`${told(line)} is no curve that is known`);
  return kind(context, line);
}

/** The centre-line of a swept disk, whole or between its two parameters. */
export function directrix(context: Context, solid: Line): Piece[] {
  const {model} = context;
  const line = model.of(solid, 'Directrix');
  const [first, last] = [model.maybeNumber(solid, 'StartParam'), model.maybeNumber(solid, 'EndParam')];
  if (line.type === 'IfcLine') {
    const {from, step} = lineOf(context, line);
    if (first === undefined || last === undefined) throw new Trouble(`${told(solid)} goes along a line without end`);
    return [{from: towards(from, step, first), to: towards(from, step, last)}];
  }
  const {pieces, range} = wayOf(context, line);
  const whole = (first === undefined || first === 0) && (last === undefined || (range !== undefined && Math.abs(last - range) <= 1e-6 * range));
  if (!whole) throw new Trouble(`${told(solid)} goes along a part of its directrix, by StartParam and EndParam`);
  return joined(pieces, told(solid));
}

/** Pieces end to end, straight ones that go on in line made one. */
export function joined(pieces: Piece[], who: string): Piece[] {
  const out: Piece[] = [];
  for (const piece of pieces) {
    if (distance(piece.from, piece.to) === 0) continue;
    const last = out[out.length - 1];
    const size = distance(piece.from, piece.to);
    if (last && distance(last.to, piece.from) > 1e-6 * size) throw new Trouble(`${who} has a directrix with a gap in it`);
    const [u, v] = [last && tangentAt(last, 'to'), tangentAt(piece, 'from')];
    const goesOn = last && u && !('centre' in last) && !('centre' in piece) && dot(u, v) > 0 && length(cross(u, v)) < 1e-9;
    if (goesOn) out[out.length - 1] = {from: last.from, to: piece.to};
    else out.push(piece);
  }
  if (out.length === 0) throw new Trouble(`${who} has a directrix without length`);
  return out;
}

/** Which way a piece goes, at its beginning or its end. */
export function tangentAt(piece: Piece, at: 'from' | 'to'): Vector {
  const way = 'centre' in piece ? cross(piece.normal, minus(piece[at], piece.centre)) : minus(piece.to, piece.from);
  return unit(way) as Vector;
}

/** Corners rounded by a radius (IfcSweptDiskSolidPolygonal). */
export function filleted(pieces: Piece[], radius: number, who: string): Piece[] {
  const out: Piece[] = [];
  let rest = pieces[0] as Piece;
  for (const next of pieces.slice(1)) {
    const [u, v] = [tangentAt(rest, 'to'), tangentAt(next, 'from')];
    const normal = unit(cross(u, v));
    if (!normal || 'centre' in rest || 'centre' in next) throw new Trouble(`${who} cannot be rounded by its FilletRadius`);
    const angle = Math.atan2(length(cross(u, v)), dot(u, v));
    const cut = radius * Math.tan(angle / 2);
    if (cut >= distance(rest.from, rest.to) || cut >= distance(next.from, next.to)) throw new Trouble(`${who} has no room for its FilletRadius`);
    const [from, to] = [towards(next.from, u, -cut), towards(next.from, v, cut)];
    const centre = add(from, times(cross(normal, u), radius));
    out.push({from: rest.from, to: from}, {from, to, centre, normal, angle});
    rest = {from: to, to: next.to};
  }
  return [...out, rest];
}
