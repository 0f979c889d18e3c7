import {Vector3} from 'three';
import type {Solid} from '../picture';

/** A side to look from. */
export type Side = 'first' | 'front' | 'right' | 'top';

/** Lenses, as degrees of view: the narrow one looks from so far that lines along the view are parallel within 0.4 %. */
export const lens = {wide: 28, parallel: 0.3};

/** The direction to the eye. Front is the side nearest to that of the first view; a trace off straight above, where a view has no up. */
export function towards({eye = [1, -1, 0.7], up = [0, 0, 1]}: Pick<Solid, 'eye' | 'up'>, side: Side): Vector3 {
  const first = new Vector3(...eye).normalize();
  if (side === 'first') return first;
  const above = new Vector3(...up).normalize();
  const level = first.clone().addScaledVector(above, -first.dot(above));
  const [x, y, z] = level.toArray().map(Math.abs) as [number, number, number];
  const front =
    x >= y && x >= z ? new Vector3(Math.sign(level.x), 0, 0) : y >= z ? new Vector3(0, Math.sign(level.y), 0) : new Vector3(0, 0, Math.sign(level.z));
  if (side === 'front') return front;
  if (side === 'right') return above.clone().cross(front);
  return above.addScaledVector(front, 1e-3).normalize();
}

/** How far to go on when a model needs another distance: nothing for a small change, so that the picture is steady. */
export const refit = (before: number, now: number): number => (now > 1.03 * before || now < 0.6 * before ? now / before : 1);
