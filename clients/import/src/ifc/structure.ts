import {after, cross, distance, identity, length, type Matrix, minus, placed, turned, unit, type Vector} from '../geometry.js';
import {limits} from '../limits.js';
import {usualUp} from '../sections.js';
import {type Context, type Piece, wayOf} from './curves.js';
import {type Line, type Model, told, Trouble} from './model.js';
import {inWorld, point} from './placement.js';
import {type Section, sectionOf} from './profiles.js';
import {type Body, prism} from './solids.js';

/** Entities by their relations: of structural members, profiles and products. */
export interface Relations {
  profiles: Map<number, Line[]>;
  products: Map<number, number[]>;
  eccentric: Set<number>;
}

interface Codes {
  IFCRELASSOCIATESMATERIAL: number;
  IFCRELASSOCIATESPROFILEPROPERTIES: number;
  IFCRELASSIGNSTOPRODUCT: number;
  IFCRELCONNECTSWITHECCENTRICITY: number;
}

/** Returns the readable relations; if one is broken, its members have no profile. */
export function relations(model: Model, codes: Codes): Relations {
  const out: Relations = {profiles: new Map(), products: new Map(), eccentric: new Set()};
  const each = (code: number, read: (line: Line) => void): void => {
    if (code === undefined) return; // not of this schema
    for (const id of model.all(code))
      try {
        read(model.line(id));
      } catch (failure) {
        if (!(failure instanceof Trouble)) throw failure;
      }
  };
  const push = <T>(map: Map<number, T[]>, key: number, value: T): void => {
    const list = map.get(key) ?? [];
    list.push(value);
    map.set(key, list);
  };
  each(codes.IFCRELASSOCIATESMATERIAL, (line) => {
    const material = model.of(line, 'RelatingMaterial');
    for (const id of model.ids(line, 'RelatedObjects')) push(out.profiles, id, material);
  });
  each(codes.IFCRELASSOCIATESPROFILEPROPERTIES, (line) => {
    const profile = model.of(line, 'RelatingProfileProperties');
    for (const id of model.ids(line, 'RelatedObjects')) push(out.profiles, id, profile);
  });
  each(codes.IFCRELASSIGNSTOPRODUCT, (line) => {
    const product = model.of(line, 'RelatingProduct');
    for (const id of model.ids(line, 'RelatedObjects')) push(out.products, id, product.id);
  });
  each(codes.IFCRELCONNECTSWITHECCENTRICITY, (line) => out.eccentric.add(model.of(line, 'RelatingStructuralMember').id));
  return out;
}

/** The profiles that a material or a set of properties names. */
function profilesOf(model: Model, line: Line, depth = 0): Line[] {
  if (depth > limits.depth) throw new Trouble(`${told(line)} is nested too deep`);
  const one = (name: string): Line[] => {
    const found = model.maybe(line, name);
    return found ? [found] : [];
  };
  switch (line.type) {
    case 'IfcMaterialProfileSetUsage':
    case 'IfcMaterialProfileSetUsageTapering': {
      if (line.type.endsWith('Tapering')) throw new Trouble(`${told(line)} is tapered`);
      const cardinal = model.maybeNumber(line, 'CardinalPoint');
      if (cardinal !== undefined && cardinal !== 5 && cardinal !== 10)
        throw new Trouble(`${told(line)} has its axis at CardinalPoint ${cardinal}, not in the middle (5 or 10)`);
      return profilesOf(model, model.of(line, 'ForProfileSet'), depth + 1);
    }
    case 'IfcMaterialProfileSet':
      return model.list(line, 'MaterialProfiles', limits.points).flatMap((each) => profilesOf(model, each, depth + 1));
    case 'IfcMaterialProfile':
    case 'IfcMaterialProfileWithOffsets':
      if (line.type.endsWith('Offsets')) throw new Trouble(`${told(line)} is offset from the axis`);
      return one('Profile');
    default:
      return 'ProfileDefinition' in line.attributes ? one('ProfileDefinition') : [];
  }
}

function vertex(model: Model, line: Line): Vector {
  if (line.type !== 'IfcVertexPoint') throw new Trouble(`${told(line)} is no IfcVertexPoint`);
  return point(model, model.of(line, 'VertexGeometry'));
}

/** Returns the straight line of an edge; for oriented edges, that of the named one. */
function edge(context: Context, given: Line): Piece[] {
  const {model} = context;
  let line = given;
  for (let depth = 0; line.type === 'IfcOrientedEdge'; ++depth) {
    if (depth > limits.depth) throw new Trouble(`${told(given)} is nested too deep`);
    line = model.of(line, 'EdgeElement');
  }
  if (line.type !== 'IfcEdge' && line.type !== 'IfcEdgeCurve' && line.type !== 'IfcSubedge') return wayOf(context, line).pieces;
  const [from, to] = [vertex(model, model.of(line, 'EdgeStart')), vertex(model, model.of(line, 'EdgeEnd'))];
  const curve = model.maybe(line, 'EdgeGeometry');
  if (curve && curve.type !== 'IfcLine' && !straight(wayOf(context, curve).pieces)) throw new Trouble(`${told(curve)} is not straight`);
  return [{from, to}];
}

const straight = (pieces: Piece[]): boolean => {
  const way = pieces[0] && unit(minus(pieces[0].to, pieces[0].from));
  return (
    way !== undefined &&
    pieces.every(
      ({from, to, ...arc}) =>
        !('centre' in arc) &&
        Math.abs(cross(way, minus(to, from))[0]) + Math.abs(cross(way, minus(to, from))[1]) + Math.abs(cross(way, minus(to, from))[2]) <=
          1e-9 * distance(from, to),
    )
  );
};

/** A structural member may have no placement. */
function worldOf(model: Model, member: Line): Matrix {
  const placement = model.maybe(member, 'ObjectPlacement');
  return placement ? inWorld(model, placement) : identity;
}

/** The one axis of a structural member, in the world. */
function axisOf(context: Context, member: Line): {from: Vector; to: Vector} {
  const {model} = context;
  const world = worldOf(model, member);
  const representations = model.list(model.of(member, 'Representation'), 'Representations', limits.points);
  const drawn = representations.filter(({type}) => type === 'IfcTopologyRepresentation');
  const all = drawn.length > 0 ? drawn : representations;
  if (all.length !== 1 || !all[0]) throw new Trouble(`${told(member)} has ${all.length === 0 ? 'no' : 'more than one'} representation`);
  const pieces = model.list(all[0], 'Items', limits.points).flatMap((item) => edge(context, item));
  const [only, ...more] = pieces;
  if (!only || more.length > 0 || 'centre' in only) throw new Trouble(`${told(member)} is not one straight edge`);
  if (distance(only.from, only.to) === 0) throw new Trouble(`${told(member)} has no length`);
  return {from: placed(world, only.from), to: placed(world, only.to)};
}

/** A member of a structural analysis model: its edge with its profile about it. */
export function structural(reading: Context, member: Line, {profiles, eccentric}: Relations): Body {
  const {model} = reading;
  if (member.type !== 'IfcStructuralCurveMember') throw new Trouble(`${member.type} is not imported`);
  const named = (profiles.get(member.id) ?? []).flatMap((each) => profilesOf(model, each));
  const own = named.filter((each, i) => named.findIndex(({id}) => id === each.id) === i);
  if (own.length !== 1 || !own[0]) throw new Trouble(`${told(member)} has ${own.length === 0 ? 'no profile' : 'more than one profile'}`);
  if (eccentric.has(member.id)) throw new Trouble(`${told(member)} has an eccentric connection: where its tube lies is not certain`);
  const section: Section = sectionOf(reading, own[0]);
  const size = section.kind === 'ring' ? section.outer : section.width;
  if (distance(section.place.origin, [0, 0, 0]) > 1e-9 * size) throw new Trouble(`${told(own[0])} lies off its axis`);
  const {from, to} = axisOf(reading, member);
  const z = unit(minus(to, from)) as Vector;
  const stated = upOf(model, member, z);
  const y = stated ?? (unit(cross(z, cross(usualUp(z), z))) as Vector);
  const place: Matrix = {x: cross(y, z), y, z, origin: from};
  const body = prism(section, after(place, identity), distance(from, to), own[0]);
  return body.kind === 'box' && stated === undefined ? {...body, turned: false} : body;
}

/**
 * Returns the profile's y: across the edge, like the member's Axis (its local z), which is stated in its placement;
 * undefined if it has none, or one along its edge.
 */
function upOf(model: Model, member: Line, z: Vector): Vector | undefined {
  const axis = model.maybe(member, 'Axis');
  const stated = axis && unit(turned(worldOf(model, member), model.vector(axis, 'DirectionRatios')));
  const across = stated && cross(z, cross(stated, z));
  return across && length(across) > 1e-6 ? unit(across) : undefined;
}
