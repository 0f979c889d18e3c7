import {type Drawing, drawingOf, type Drawn} from './drawing.js';
import {exact, full, type Found, type FrameOptions, frameOf, type Imported, type Member, names, nothing, rounded, type Size} from './frame.js';
import {limits} from './limits.js';
import {distance, minus, times, type Vector} from './geometry.js';
import {type CornerOptions, cornersStated, cornersToState, type Section, sidesSaid, standards, uncut, usually, usualUp} from './sections.js';
import {lengths, type LengthUnit} from './units.js';

export interface DxfOptions extends FrameOptions, CornerOptions {
  /** Of the drawing, if it has no $INSUNITS. */
  unit?: LengthUnit;
}

class Trouble extends Error {}
/** A layer of rectangular tubes whose corners nobody states. */
class Cornerless extends Trouble {}

// $INSUNITS, of those that a drawing of tubes is in.
const units: Record<number, LengthUnit> = {1: 'in', 2: 'ft', 4: 'mm', 5: 'cm', 6: 'm'};

/** Flat entities are drawn in a plane of their own; only the world's is read. */
function flat({extrusion: [x, y, z]}: Drawn): void {
  if (x !== 0 || y !== 0 || z !== 1) throw new Trouble('it is drawn in a plane of its own (extrusion direction)');
}

const finite = (p: Vector): Vector => {
  if (!p.every(Number.isFinite)) throw new Trouble('it has a coordinate that is no number');
  return p;
};

interface Arc {
  centre: Vector;
  radius: number;
  from: number;
  angle: number;
}
type Piece = {from: Vector; to: Vector} | Arc;

function line({points: [from], end}: Drawn): Piece[] {
  if (!from || !end) throw new Trouble('it has no two points');
  return [{from: finite([from.x, from.y, from.z]), to: finite(end)}];
}

/** bulge: the tangent of a quarter of the arc's angle, positive anticlockwise. */
function bulged(from: Vector, to: Vector, bulge: number): Arc {
  const angle = 4 * Math.atan(bulge);
  const chord = distance(from, to);
  const away = chord / 2 / Math.tan(angle / 2) / chord; // from the middle to the centre, in chords, to the left
  const centre: Vector = [(from[0] + to[0]) / 2 - (to[1] - from[1]) * away, (from[1] + to[1]) / 2 + (to[0] - from[0]) * away, from[2]];
  return {centre, radius: distance(centre, from), from: Math.atan2(from[1] - centre[1], from[0] - centre[0]), angle};
}

const [closed, curveFit, splineFit, in3d, mesh, polyface] = [1, 2, 4, 8, 16, 64]; // bits of code 70

function polyline(entity: Drawn): Piece[] {
  const {points, flags, type} = entity;
  const light = type === 'LWPOLYLINE';
  if (!light && flags & (mesh | polyface)) throw new Trouble('it is a mesh');
  if (!light && flags & (curveFit | splineFit)) throw new Trouble('it is fitted by a curve');
  if (points.length < 2) throw new Trouble('it has no two points');
  if (points.length > limits.points) throw new Trouble(`it has ${points.length} points, and at most ${limits.points} are read`);
  const spatial = !light && (flags & in3d) !== 0;
  if (light || points.some(({bulge}) => bulge)) flat(entity);
  const at = (p: Drawn['points'][0]): Vector => finite([p.x, p.y, light ? entity.elevation : spatial ? p.z : p.z || entity.elevation]);
  const next = flags & closed ? [...points.slice(1), points[0] as Drawn['points'][0]] : points.slice(1);
  return next.map((p, i) => {
    const one = points[i] as Drawn['points'][0];
    const [from, to] = [at(one), at(p)];
    if (!Number.isFinite(one.bulge)) throw new Trouble('it has a bulge that is no number');
    return one.bulge ? bulged(from, to, one.bulge) : {from, to};
  });
}

function arc(entity: Drawn): Piece[] {
  flat(entity);
  const {
    points: [centre],
    radius,
    angles,
  } = entity;
  if (!centre || !(radius > 0) || !angles.every(Number.isFinite)) throw new Trouble('it has no centre, radius or angles');
  const [from, to] = angles.map((deg) => (deg * Math.PI) / 180) as [number, number];
  const whole = 2 * Math.PI;
  return [{centre: finite([centre.x, centre.y, centre.z]), radius, from, angle: (((to - from) % whole) + whole) % whole || whole}];
}

const kinds: Record<string, (entity: Drawn) => Piece[]> = {LINE: line, LWPOLYLINE: polyline, POLYLINE: polyline, ARC: arc};

/** The size of a layer's tubes: a name of a rectangular one is a section, which needs corners. */
function sizeOf(layer: string, size: Size, options: CornerOptions): Size | Section {
  const sides = 'size' in size ? sidesSaid(size.size) : undefined;
  if (!sides) return size;
  const {corners: own, ...rest} = sides;
  const corners = own ? {corners: own} : cornersStated(options);
  if (!corners) throw new Cornerless(`the corners of layer ${layer} are not stated: state --corner, ${cornersToState}`);
  const why = uncut(rest, corners);
  if (why !== undefined) throw new Trouble(why);
  return {kind: 'rectangular_tube', ...rest, ...corners};
}

/** An arc's outside diameter must be a number: it has no name in the request. */
function add(found: Found, piece: Piece, id: string, size: Size | Section, mm: number): void {
  if (!('centre' in piece)) {
    if (distance(piece.from, piece.to) === 0) throw new Trouble('it has no length');
    const up = 'kind' in size ? {up: usualUp(minus(piece.to, piece.from))} : {};
    found.members.push({id, start_mm: rounded(times(piece.from, mm)), end_mm: rounded(times(piece.to, mm)), ...size, ...up} as Member);
    return;
  }
  if (!('outer_diameter_mm' in size)) throw new Trouble('an arc needs a size in mm');
  const {centre, radius, from, angle} = piece;
  const out: Vector = [Math.cos(from), Math.sin(from), 0];
  const turn = Math.sign(angle);
  found.others.push({
    other: {
      kind: 'elbow',
      id,
      outer_diameter_mm: size.outer_diameter_mm,
      bend_radius_mm: exact(radius * mm),
      bend_deg: exact((Math.abs(angle) * 180) / Math.PI),
      axis: {
        point_mm: rounded(times([centre[0] + radius * out[0], centre[1] + radius * out[1], centre[2]], mm)),
        direction: rounded([-turn * out[1], turn * out[0], 0]),
      },
      inwards: rounded(times(out, -1)),
    },
  });
}

function parsed(text: string): Drawing {
  try {
    return drawingOf(text);
  } catch (failure) {
    throw new Trouble(`it cannot be read: ${failure instanceof Error ? failure.message : String(failure)}`);
  }
}

/** Returns the layers with entities: those that need sizes. */
export function layersOf(text: string): string[] {
  return [
    ...new Set(
      parsed(text)
        .entities.filter(({type}) => Object.hasOwn(kinds, type))
        .map(({layer}) => layer),
    ),
  ].sort();
}

/** Returns $INSUNITS of a drawing; undefined if it is missing or unknown. */
export const unitOf = (text: string): LengthUnit | undefined => units[parsed(text).unit];

function every(text: string, sizesByLayer: Record<string, Size>, found: Found, options: DxfOptions): void {
  const drawing = parsed(text);
  const unit = options.unit ?? units[drawing.unit];
  if (!unit) throw new Trouble('the drawing does not state its unit ($INSUNITS), and no unit was given');
  const mm = lengths[unit];
  const name = names();
  const sided = new Set<string>();
  const cornerless = new Map<string, number>();
  for (const entity of drawing.entities) {
    if (full(found)) return;
    const mark = `handle ${entity.handle}`;
    try {
      const kind = Object.hasOwn(kinds, entity.type) ? kinds[entity.type] : undefined;
      if (!kind) throw new Trouble(`${entity.type} is not imported`);
      if (entity.inPaperSpace) throw new Trouble('it is drawn on a sheet, not in the model');
      const given = Object.hasOwn(sizesByLayer, entity.layer) ? sizesByLayer[entity.layer] : undefined;
      if (!given) throw new Trouble(`no size was given for layer ${entity.layer}`);
      const size = sizeOf(entity.layer, given, options);
      const pieces = kind(entity);
      const one = nothing();
      pieces.forEach((piece, i) => add(one, piece, name(`${entity.layer} ${entity.handle}${pieces.length > 1 ? `/${i + 1}` : ''}`, mark), size, mm));
      found.members.push(...one.members);
      found.others.push(...one.others);
      if ('kind' in size) sided.add(entity.layer);
    } catch (failure) {
      if (!(failure instanceof Trouble)) throw failure;
      if (failure instanceof Cornerless) cornerless.set(failure.message, (cornerless.get(failure.message) ?? 0) + 1);
      found.notUnderstood.push({id: mark, type: entity.type, reason: failure.message});
    }
  }
  for (const [text, count] of cornerless) found.asks.push({option: 'corner', count, likely: [...standards], text});
  for (const layer of sided)
    found.notUnderstood.push({id: `layer ${layer}`, type: 'DXF', reason: `assumed: a line does not show how a tube is turned: ${usually}`});
}

/** Lines, polylines and arcs of a drawing as centre-lines; each layer's tubes are of one size. */
export function fromDxf(text: string, sizesByLayer: Record<string, Size>, options: DxfOptions = {}): Imported {
  const found = nothing();
  try {
    every(text, sizesByLayer, found, options);
  } catch (failure) {
    if (!(failure instanceof Trouble)) throw failure;
    found.notUnderstood.push({id: 'file', type: 'DXF', reason: failure.message});
  }
  return frameOf(found, options, 'DXF');
}
