import {BufferAttribute, BufferGeometry, Mesh, ShapeUtils, Vector2, Vector3} from 'three';
import type {Vector} from '../picture';
import {steel, toVector} from './meshes';

/** Flat openings, as one mesh over the walls that they are in. */
export function openings(edges: Vector[][]): Mesh {
  const positions: number[] = [];
  for (const edge of edges) {
    const at = edge.map(toVector);
    const origin = at[0] as Vector3;
    // Newell's normal, because three neighbouring points may lie on one line.
    const normal = at.reduce((sum, p, i) => sum.add(p.clone().cross(at[(i + 1) % at.length] as Vector3)), new Vector3()).normalize();
    const side = new Vector3(0, 0, 1);
    const across = side.clone().cross(normal).normalize();
    const flat = at.map((p) => {
      const from = p.clone().sub(origin);
      return new Vector2(from.dot(side), from.dot(across));
    });
    for (const corners of ShapeUtils.triangulateShape(flat, [])) for (const i of corners) positions.push(...(at[i] as Vector3).toArray());
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
  geometry.computeVertexNormals();
  const mesh = new Mesh(geometry, steel('bore'));
  mesh.name = 'openings';
  return mesh;
}
