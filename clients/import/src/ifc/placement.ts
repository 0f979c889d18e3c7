import {add, after, cross, dot, identity, length, type Matrix, minus, times, unit, type Vector} from '../geometry.js';
import {limits} from '../limits.js';
import {type Line, type Model, told, Trouble} from './model.js';

const X: Vector = [1, 0, 0];
const Y: Vector = [0, 1, 0];
const Z: Vector = [0, 0, 1];

export function point(model: Model, line: Line): Vector {
  if (line.type !== 'IfcCartesianPoint') throw new Trouble(`${told(line)} is no IfcCartesianPoint`);
  return model.vector(line, 'Coordinates');
}

export function direction(model: Model, line: Line): Vector {
  const found = unit(model.vector(line, 'DirectionRatios'));
  if (!found) throw new Trouble(`${told(line)} has no direction`);
  return found;
}

const maybeDirection = (model: Model, line: Line, name: string): Vector | undefined => {
  const found = model.maybe(line, name);
  return found && direction(model, found);
};

/** IfcFirstProjAxis: the direction across z that is nearest to the one that is given. */
function firstAxis(line: Line, z: Vector, given: Vector | undefined): Vector {
  const v = given ?? (length(cross(z, X)) > 1e-9 ? X : Y);
  const across = minus(v, times(z, dot(v, z)));
  const found = length(across) > 1e-9 ? unit(across) : undefined;
  if (!found) throw new Trouble(`${told(line)} has two directions that are one`);
  return found;
}

/** IfcAxis2Placement3D, IfcAxis2Placement2D. */
export function axes(model: Model, line: Line): Matrix {
  const origin = point(model, model.of(line, 'Location'));
  if (line.type === 'IfcAxis2Placement2D') {
    const x = maybeDirection(model, line, 'RefDirection') ?? X;
    return {x, y: cross(Z, x), z: Z, origin};
  }
  if (line.type !== 'IfcAxis2Placement3D') throw new Trouble(`${told(line)} is no placement that is known`);
  const z = maybeDirection(model, line, 'Axis') ?? Z;
  const x = firstAxis(line, z, maybeDirection(model, line, 'RefDirection'));
  return {x, y: cross(z, x), z, origin};
}

/** Of an attribute that may be left out: where it is, in the middle of things. */
export const maybeAxes = (model: Model, line: Line, name: string): Matrix => {
  const found = model.maybe(line, name);
  return found ? axes(model, found) : identity;
};

/**
 * Returns the position of a product in the world: its placement in that of its parent, and so on.
 */
export function inWorld(model: Model, placement: Line): Matrix {
  let out = identity;
  const seen = new Set<number>();
  for (let at: Line | undefined = placement; at; at = model.maybe(at, 'PlacementRelTo')) {
    if (at.type !== 'IfcLocalPlacement') throw new Trouble(`${told(at)} is no IfcLocalPlacement`);
    if (seen.size > limits.points) throw new Trouble(`${told(at)} is placed in more than ${limits.points} others`);
    if (seen.has(at.id)) throw new Trouble(`${told(at)} is placed by itself`);
    seen.add(at.id);
    out = after(axes(model, model.of(at, 'RelativePlacement')), out);
  }
  return out;
}

/** IfcCartesianTransformationOperator3D, with one scale or three. */
export function operator(model: Model, line: Line): Matrix {
  if (!line.type.startsWith('IfcCartesianTransformationOperator3D')) throw new Trouble(`${told(line)} is no transformation in space`);
  const z = maybeDirection(model, line, 'Axis3') ?? Z;
  const x = firstAxis(line, z, maybeDirection(model, line, 'Axis1'));
  const right = cross(z, x);
  const given = maybeDirection(model, line, 'Axis2');
  const y = given && dot(given, right) < 0 ? times(right, -1) : right;
  const scale = model.maybeNumber(line, 'Scale') ?? 1;
  const [second, third] = ['Scale2', 'Scale3'].map((name) => model.maybeNumber(line, name) ?? scale) as [number, number];
  const origin = point(model, model.of(line, 'LocalOrigin'));
  return {x: times(x, scale), y: times(y, second), z: times(z, third), origin};
}

/** IfcCartesianTransformationOperator2D, with one scale or two. */
export function operator2d(model: Model, line: Line): Matrix {
  if (!line.type.startsWith('IfcCartesianTransformationOperator2D')) throw new Trouble(`${told(line)} is no transformation in the plane`);
  const x = maybeDirection(model, line, 'Axis1') ?? X;
  const left = cross(Z, x);
  const given = maybeDirection(model, line, 'Axis2');
  const y = given && dot(given, left) < 0 ? times(left, -1) : left;
  const scale = model.maybeNumber(line, 'Scale') ?? 1;
  return {x: times(x, scale), y: times(y, model.maybeNumber(line, 'Scale2') ?? scale), z: Z, origin: point(model, model.of(line, 'LocalOrigin'))};
}

/** The one scale of a matrix. */
export function scaleOf(m: Matrix, line: Line): number {
  const [x, y, z] = [length(m.x), length(m.y), length(m.z)];
  const even = Math.max(x, y, z) - Math.min(x, y, z) <= 1e-9 * x;
  if (!(x > 0) || !even) throw new Trouble(`${told(line)} is scaled differently in its directions`);
  return x;
}

export const towards = (a: Vector, v: Vector, k: number): Vector => add(a, times(v, k));
