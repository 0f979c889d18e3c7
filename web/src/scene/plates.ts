import {BufferGeometry, ExtrudeGeometry, Group, LineSegments, Mesh, type Object3D, Path, Shape, Vector2, Vector3} from 'three';
import type {Plate} from '../picture';
import {close} from './cap';
import {ink, matrix, steel} from './meshes';

/** A plate: its face in its own plane, the metal behind it, its edges drawn. */
export function plateMesh({frame, thickness, outline, holes}: Plate): Object3D {
  const points = (of: Plate['outline']) => of.map(([x, y]) => new Vector2(x, y));
  const shape = new Shape(points(outline));
  shape.holes = holes.map((hole) => new Path(points(hole)));
  const body = close(
    new Group().add(new Mesh(new ExtrudeGeometry(shape, {depth: thickness, bevelEnabled: false}).translate(0, 0, -thickness), steel('plate'))),
  );
  const edges = [outline, ...holes].flatMap((chain) =>
    chain.flatMap((from, i) => {
      const to = chain[(i + 1) % chain.length] as Plate['outline'][number];
      return [0, -thickness].flatMap((z) => [new Vector3(...from, z), new Vector3(...to, z)]);
    }),
  );
  body.add(new LineSegments(new BufferGeometry().setFromPoints(edges), ink('edge')));
  body.applyMatrix4(matrix(frame));
  return body;
}
