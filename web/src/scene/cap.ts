import {
  AlwaysStencilFunc,
  type Box3,
  DoubleSide,
  InvertStencilOp,
  KeepStencilOp,
  Mesh,
  MeshBasicMaterial,
  NotEqualStencilFunc,
  type Object3D,
  type Plane,
  PlaneGeometry,
  type PerspectiveCamera,
  type Scene,
  Vector3,
  type WebGLRenderer,
} from 'three';
import {colour} from '../dom';

const layer = 1; // of closed bodies
const off = 1e-4; // of the model's size: the plane itself is cut off

/** Marks the meshes of a closed body. */
export const close = (body: Object3D): Object3D => {
  body.traverse((node) => node instanceof Mesh && node.layers.enable(layer));
  return body;
};

/** Draws nothing, and counts at each pixel whether the number of faces is odd. */
const parity = new MeshBasicMaterial({
  side: DoubleSide,
  colorWrite: false,
  depthWrite: false,
  depthTest: false,
  stencilWrite: true,
  stencilFunc: AlwaysStencilFunc,
  stencilFail: KeepStencilOp,
  stencilZFail: InvertStencilOp,
  stencilZPass: InvertStencilOp,
});

/**
 * The cut face of a section. A line of sight that meets an odd number of the faces that are left passes the plane inside a
 * body, whichever way the faces are turned.
 */
export class Cap extends Mesh<PlaneGeometry, MeshBasicMaterial> {
  constructor() {
    super(
      new PlaneGeometry(1, 1),
      new MeshBasicMaterial({side: DoubleSide, stencilWrite: true, stencilRef: 0, stencilFunc: NotEqualStencilFunc, stencilZPass: KeepStencilOp}),
    );
    this.visible = false;
    this.renderOrder = 1;
  }

  /** On a plane through the model, or nowhere. */
  put(plane: Plane | undefined, box: Box3 | undefined): void {
    this.visible = Boolean(plane && box);
    if (!plane || !box) return;
    const size = box.getSize(new Vector3()).length();
    this.material.color.set(colour('section'));
    this.scale.setScalar(2 * size);
    this.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), plane.normal);
    plane.projectPoint(box.getCenter(new Vector3()), this.position).addScaledVector(plane.normal, off * size);
  }

  /** Renders the scene, with this face if it is on a plane. */
  render(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera): void {
    if (this.visible) {
      renderer.clear();
      renderer.autoClear = false;
      scene.overrideMaterial = parity;
      camera.layers.set(layer);
      renderer.render(scene, camera);
      scene.overrideMaterial = null;
      camera.layers.set(0);
    }
    renderer.render(scene, camera);
    renderer.autoClear = true;
  }
}
