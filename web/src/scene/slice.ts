import {Box3, type Object3D, Plane, Vector3} from 'three';

export const axes = ['x', 'y', 'z'] as const;

/** A plane that cuts the model: across an axis, at a share of the model's extent along it; the half before it is kept, or the other. */
export interface Slice {
  axis: (typeof axes)[number];
  share: number;
  other: boolean;
}

/** The box round some parts of the model. */
export const boxOf = (parts: Object3D[]): Box3 => parts.reduce((box, part) => box.expandByObject(part), new Box3());

/** The place of the plane on its axis, mm; undefined of a model without extent. */
export const placeOf = ({axis, share}: Slice, {min, max}: Box3): number | undefined =>
  max[axis] > min[axis] ? min[axis] + share * (max[axis] - min[axis]) : undefined;

/** Of the plane's two sides, three draws the one that its normal points at. */
export function planeOf({axis, other}: Slice, at: number): Plane {
  const way = other ? 1 : -1;
  const normal = new Vector3();
  normal[axis] = way;
  return new Plane(normal, -way * at);
}
