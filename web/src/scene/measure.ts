import {
  type BufferAttribute,
  BufferGeometry,
  Group,
  InstancedMesh,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
  Vector3,
  type Camera,
  type Intersection,
} from 'three';
import {colour} from '../dom';

const near = 12; // px, within which a corner is taken

/** The corner of the triangle that was hit, if it is seen near enough, else the place itself. */
export function snapped(hit: Intersection, camera: Camera, width: number, height: number): Vector3 {
  const {object, face, point} = hit;
  if (!face || !(object instanceof Mesh) || object instanceof InstancedMesh) return point;
  const place = (object.geometry as BufferGeometry).getAttribute('position') as BufferAttribute;
  const pixels = (p: Vector3) => {
    const at = p.clone().project(camera);
    return [(at.x * width) / 2, (at.y * height) / 2] as const;
  };
  const [u, v] = pixels(point);
  const off = (p: Vector3) => {
    const [x, y] = pixels(p);
    return Math.hypot(x - u, y - v);
  };
  const corners = [face.a, face.b, face.c].map((i) => new Vector3().fromBufferAttribute(place, i).applyMatrix4(object.matrixWorld));
  const best = corners.reduce((a, b) => (off(b) < off(a) ? b : a));
  return off(best) <= near ? best : point;
}

/** Two points on the model, and the line between them; they turn with it. */
export class Measure extends Group {
  private points: Vector3[] = [];

  /** A point more; after two the next begins anew. Returns both, if there are two. */
  take(point: Vector3, size: number): [Vector3, Vector3] | undefined {
    this.points = this.points.length === 2 ? [point] : [...this.points, point];
    this.clear();
    const material = new MeshBasicMaterial({color: colour('chosen'), depthTest: false, transparent: true});
    for (const each of this.points) {
      const dot = new Mesh(new SphereGeometry(size, 12, 8), material);
      dot.position.copy(each);
      dot.renderOrder = 2;
      this.add(dot);
    }
    if (this.points.length < 2) return undefined;
    const line = new Line(
      new BufferGeometry().setFromPoints(this.points),
      new LineBasicMaterial({color: colour('chosen'), depthTest: false, transparent: true}),
    );
    line.renderOrder = 2;
    this.add(line);
    return this.points as [Vector3, Vector3];
  }
}
