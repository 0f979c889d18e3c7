import {
  AmbientLight,
  DirectionalLight,
  Group,
  HemisphereLight,
  InstancedMesh,
  Mesh,
  PerspectiveCamera,
  Raycaster,
  Scene,
  TOUCH,
  Vector2,
  Vector3,
  WebGLRenderer,
  type BufferGeometry,
  type Object3D,
  type Plane,
} from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import {t} from '../language';
import {chosen, chosenTogether, listen, point, pointed} from '../links';
import type {Solid, Vector} from '../picture';
import {Cap, close} from './cap';
import {Labels} from './labels';
import {Members} from './members';
import {Beam, Cone, cutTube, drawnLine, matrix, partnerMesh, ribbon} from './meshes';
import {Measure, snapped} from './measure';
import {openings} from './openings';
import {plateMesh} from './plates';
import {boxOf, placeOf, planeOf, type Slice} from './slice';
import {lens, refit, towards, type Side} from './views';
import {holedTube} from './walls';

// Drawn pixels per page pixel, in each direction. Without a graphics card one takes 30 ms and four
// take 90, so a changing picture is drawn coarse, and once more fine when nothing has changed for a
// moment.
const coarse = 1,
  fine = 2;
const settled = 250; // ms
const touch = 6; // pixels by which a member may be missed
const still = 4; // pixels that a click may move

/** The joint in 3D. Draws only when something changed. */
export class Stage {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(lens.wide, 1, 1, 100000);
  private controls: OrbitControls;
  private content = new Group();
  private partners = new Group();
  private beam = new Beam();
  private cone: Cone | null = null;
  private members: Members | null = null;
  private readonly labels: Labels;
  private solid: Solid | null = null;
  private before = false;
  private seen = '';
  private forget: (() => void)[] = [];
  private pressed: PointerEvent | null = null;
  private waiting = false;
  private settling = 0;
  private side: Side = 'first';
  private fitted = 1; // the distance at which the model is seen whole
  private measure = new Measure();
  private readonly cap = new Cap();
  private measuring: ((points: [Vector3, Vector3] | undefined) => void) | null = null;
  private slice: Slice | null = null;
  private turned = false; // by hand; until then the view fits the frame

  constructor(private readonly root: HTMLElement) {
    // Kept, so that the picture can be read back (copied, tested) after it was shown.
    this.renderer = new WebGLRenderer({antialias: false, alpha: true, preserveDrawingBuffer: true, stencil: true});
    const {domElement} = this.renderer;
    domElement.tabIndex = 0;
    domElement.setAttribute('role', 'img');
    root.append(domElement);
    this.labels = new Labels(root);
    const key = new DirectionalLight(0xffffff, 1.7),
      fill = new DirectionalLight(0xffffff, 0.55);
    key.position.set(0.6, 0.9, 1);
    fill.position.set(-1, -0.3, 0.4);
    this.camera.add(key, fill);
    this.scene.add(this.cap, this.camera, new AmbientLight(0xffffff, 0.55), new HemisphereLight(0xffffff, 0x8899aa, 0.7));
    this.controls = this.control();
    domElement.addEventListener('pointermove', (event) => this.hover(event));
    domElement.addEventListener('pointerleave', () => this.solid && !this.solid.tool && point(this.solid.link, null));
    domElement.addEventListener('pointerdown', (event) => {
      this.pressed = event;
    });
    domElement.addEventListener('click', (event) => this.choose(event));
    // One finger scrolls the page; two turn the model, and the page stays.
    const two = (event: TouchEvent) => event.touches.length > 1 && event.preventDefault();
    domElement.addEventListener('touchstart', two, {passive: false});
    domElement.addEventListener('touchmove', two, {passive: false});
    domElement.addEventListener('keydown', (event) => this.turn(event));
    new ResizeObserver(() => this.fit()).observe(root);
    this.fit();
  }

  private control(): OrbitControls {
    const controls = new OrbitControls(this.camera, this.renderer.domElement);
    controls.touches = {TWO: TOUCH.DOLLY_ROTATE};
    this.renderer.domElement.style.touchAction = 'pan-x pan-y'; // the controls forbid both
    controls.addEventListener('change', () => this.draw());
    controls.addEventListener('start', () => {
      this.turned = true;
    });
    return controls;
  }

  /**
   * If the picture belongs to another `job`, the view is a fresh one; if to the same, it keeps its
   * rotation.
   */
  show(solid: Solid, before: boolean, label: string, job: number): void {
    this.solid = solid;
    this.before = before;
    this.renderer.domElement.setAttribute(
      'aria-label',
      [`${label}.`, solid.told ? `${solid.told}.` : '', t('Arrow keys turn it, plus and minus zoom, Home resets.')].filter(Boolean).join(' '),
    );
    release(this.content);
    this.scene.remove(this.content);
    this.content = new Group();
    this.partners = new Group();
    this.content.add(
      ...solid.tubes.map((tube) => cutTube(tube, before, solid.tint)),
      ...(solid.holed ?? []).map((tube) => close(holedTube(tube, solid.tint))),
      ...(solid.ribbons ?? []).map((each) => (solid.closed ? close(ribbon(each, solid.tint)) : ribbon(each, solid.tint))),
      ...(solid.plates ?? []).map(plateMesh),
      ...(solid.openings?.length ? [openings(solid.openings)] : []),
      ...(solid.lines ?? []).map((l) => drawnLine(l.points, l.tone)),
      this.partners,
    );
    this.members = solid.assembly ? new Members(solid.assembly) : null;
    if (this.members) this.content.add(this.members);
    this.labels.show(solid.assembly?.members.map(({name}) => name) ?? [], solid.assembly?.joints ?? []);
    if (solid.partners.length) this.partners.add(...solid.partners.map(partnerMesh));
    this.renderer.domElement.dataset['state'] = before ? 'before' : 'after';
    this.renderer.domElement.dataset['plates'] = String(solid.plates?.length ?? 0);
    this.renderer.domElement.dataset['members'] = String(this.members?.axes.length ?? 0);
    this.beam = new Beam();
    this.content.add(this.beam);
    this.measure = new Measure();
    this.content.add(this.measure);
    this.measuring?.(undefined);
    this.cone = solid.tool?.kind === 'cone' ? new Cone(solid.tool) : null;
    if (this.cone) this.content.add(this.cone);
    this.scene.add(this.content);
    this.cut();
    const view = JSON.stringify([job, solid.link, solid.eye, solid.up]);
    if (view !== this.seen) this.reset();
    else this.move(new Vector3(...solid.centre), refit(this.fitted, this.needed()));
    this.seen = view;
    this.forget.forEach((each) => each());
    this.forget = [listen(solid.link, (index) => this.follow(index)), listen(chosen(solid.link), () => this.light())];
    this.follow(pointed(solid.link));
    this.controls.update();
    this.draw();
  }

  /** Looks at another point from the same side, as far away, or farther by a factor if the model has grown. */
  private move(centre: Vector3, by: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(by);
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).add(offset);
    if (by !== 1) this.reach(this.fitted * by);
  }

  /** From where the model is seen whole, from the side that is chosen. */
  private needed(): number {
    if (!this.solid) return 1;
    return this.members?.distance(this.camera, towards(this.solid, this.side), new Vector3(...this.solid.centre)) ?? this.away(this.solid.size);
  }

  /** Sets the near and the far limit of the view for a distance. */
  private reach(distance: number): void {
    this.fitted = distance;
    const depth = this.camera.fov === lens.parallel ? 8 : 50; // from afar less, or near places would be told apart badly
    this.camera.near = distance / depth;
    this.camera.far = distance * depth;
    this.camera.updateProjectionMatrix();
    this.renderer.domElement.dataset['distance'] = distance.toPrecision(6);
  }

  /** Looks from a side of the model, the whole of it. */
  look(side: Side): void {
    this.side = side;
    this.reset(side);
  }

  /** Draws lines along the view parallel, or as the eye sees them. */
  parallel(on: boolean): void {
    const before = this.away(1);
    this.camera.fov = on ? lens.parallel : lens.wide;
    this.move(this.controls.target.clone(), this.away(1) / before);
    this.controls.update();
    this.draw();
  }

  /** Tells of two points that are clicked, from now on; nothing ends it. */
  measured(tell: ((points: [Vector3, Vector3] | undefined) => void) | null): void {
    this.measuring = tell;
    this.measure.removeFromParent();
    this.measure = new Measure();
    this.content.add(this.measure);
    this.renderer.domElement.classList.toggle('measuring', tell !== null);
    this.draw();
  }

  /** Leaves out one side of a plane, or nothing. Returns the plane's place, mm. */
  sliced(slice: Slice | null): number | undefined {
    this.slice = slice;
    const at = this.cut();
    this.draw();
    return at;
  }

  private cut(): number | undefined {
    const parts = this.content.children.filter((part) => ![this.partners, this.measure, this.beam].includes(part as Group));
    const box = this.slice ? boxOf(parts) : undefined;
    const at = this.slice && box ? placeOf(this.slice, box) : undefined;
    this.renderer.clippingPlanes = this.slice && at !== undefined ? [planeOf(this.slice, at)] : [];
    this.cap.put(this.renderer.clippingPlanes[0] as Plane | undefined, box);
    if (this.members) this.members.planes = this.renderer.clippingPlanes as Plane[];
    return at;
  }

  /** Whether the plane leaves a point. */
  private readonly kept = ({point: seen}: {point: Vector3}) => this.renderer.clippingPlanes.every((plane: Plane) => plane.distanceToPoint(seen) >= 0);

  private takePoint(event: MouseEvent): void {
    const solids: Object3D[] = [];
    for (const part of this.content.children)
      if (![this.partners, this.measure, this.beam].includes(part as Group)) part.traverse((node) => node instanceof Mesh && solids.push(node));
    const hit = this.ray(event).intersectObjects(solids, false).find(this.kept);
    if (!hit) return;
    const {clientWidth, clientHeight} = this.root;
    const at = this.content.worldToLocal(snapped(hit, this.camera, clientWidth, clientHeight).clone());
    const dot = (4 * 2 * this.camera.position.distanceTo(hit.point) * Math.tan((this.camera.fov * Math.PI) / 360)) / clientHeight;
    this.measuring?.(this.measure.take(at, dot));
    this.draw();
  }

  partnersShown(shown: boolean): void {
    this.partners.visible = shown;
    this.draw();
  }

  reset(side: Side = 'first'): void {
    if (!this.solid) return;
    this.turned = false;
    this.side = side;
    const {centre, up = [0, 0, 1]} = this.solid;
    this.camera.up.set(...up);
    // The controls read the upward direction when they are made.
    this.controls.dispose();
    this.controls = this.control();
    this.controls.target.set(...centre);
    const distance = this.needed();
    this.camera.position.copy(towards(this.solid, side).multiplyScalar(distance).add(this.controls.target));
    this.reach(distance);
    this.controls.update();
    this.draw();
  }

  /** From where something of a size is seen whole. */
  private away(size: number): number {
    return (size / Math.tan((this.camera.fov * Math.PI) / 360) / Math.min(1, this.camera.aspect)) * 0.72;
  }

  /** Draws at the next frame, once for any number of calls. */
  draw(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.now();
    });
  }

  private now(): void {
    this.render(coarse);
    clearTimeout(this.settling);
    this.settling = window.setTimeout(() => this.render(fine), settled);
  }

  private render(ratio: number): void {
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    this.cap.render(this.renderer, this.scene, this.camera);
    if (this.members && this.solid) {
      const {clientWidth, clientHeight} = this.root;
      this.labels.place(this.members, this.camera, clientWidth, clientHeight, ...this.lit(this.members, this.solid.link), pointed(chosen(this.solid.link)));
    }
    this.renderer.domElement.dataset['drawn'] = ratio === fine ? 'fine' : 'coarse';
  }

  private fit(): void {
    const {clientWidth: width, clientHeight: height} = this.root;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.turned) this.reset(this.side);
    this.now(); // before the page is painted: another size has cleared the canvas
  }

  /** The members that are chosen, and those pointed at. */
  private lit(members: Members, link: string): [Set<number>, Set<number>] {
    const all = [pointed(chosen(link)), ...chosenTogether(link)].flatMap((item) => [...members.of(item)]);
    return [new Set(all), members.of(pointed(link))];
  }

  private light(): void {
    if (this.members && this.solid) this.members.light(...this.lit(this.members, this.solid.link));
    this.draw();
  }

  private follow(index: number | null): void {
    if (this.members) this.light();
    const {tool, tubes = []} = this.solid ?? {};
    const tube = tubes[0];
    const poses = tool?.kind === 'cone' ? (this.before && tool.before) || tool.poses : [];
    this.cone?.put(index === null ? undefined : poses[index % poses.length]);
    const turns = tool?.kind === 'torch' ? tool.turn : undefined;
    this.content.rotation.z = index === null || !turns ? 0 : (-(turns[index % turns.length] ?? 0) * Math.PI) / 180;
    if (index !== null && tool?.kind === 'torch')
      this.beam.aim(tool.inner[index % tool.inner.length] as Vector, tool.outer[index % tool.outer.length] as Vector, tool.size);
    else if (index === null || !tube || tubes.length !== 1) this.beam.visible = false;
    else this.beam.put(tube, this.before, index % tube.phi.length); // a closed curve's end is its beginning
    this.draw();
  }

  private ray(event: MouseEvent): Raycaster {
    const box = this.renderer.domElement.getBoundingClientRect();
    const at = new Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    return ray;
  }

  /** The item that is seen there: a joint's dot, or a member. */
  private item(event: MouseEvent): number | null {
    const box = this.renderer.domElement.getBoundingClientRect();
    const joint = this.labels.under(event.clientX - box.left, event.clientY - box.top);
    if (joint !== null) return joint;
    const pixel = (2 * Math.tan((this.camera.fov * Math.PI) / 360)) / this.root.clientHeight;
    return this.members?.under(this.ray(event), touch * pixel) ?? null;
  }

  /** If a click turned nothing, it selects a member, or clears the selection. */
  private choose(event: MouseEvent): void {
    const from = this.pressed;
    if (from && Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > still) return;
    if (this.measuring) this.takePoint(event);
    else if (this.members && this.solid) point(chosen(this.solid.link), this.item(event));
  }

  private hover(event: PointerEvent): void {
    if (this.members && this.solid && event.buttons === 0) {
      const over = this.item(event);
      this.renderer.domElement.classList.toggle('over', over !== null);
      point(this.solid.link, over);
      return;
    }
    const tube = this.solid?.tubes[0];
    if (this.solid?.tool) return; // its points are in time, which no point of the cut shows
    if (!tube || !this.solid || this.solid.tubes.length !== 1 || event.buttons !== 0) return;
    const ray = this.ray(event);
    const walls: Object3D[] = [];
    this.content.traverse((node) => node.name === 'wall' && walls.push(node));
    const hit = ray.intersectObjects(walls).find(this.kept);
    if (!hit) {
      point(this.solid.link, null);
      return;
    }
    const local = hit.point.applyMatrix4(matrix(tube.frame).invert());
    point(this.solid.link, nearest(tube.phi, (Math.atan2(local.y, local.x) * 180) / Math.PI));
  }

  private turn(event: KeyboardEvent): void {
    const step = 0.12;
    const offset = this.camera.position.clone().sub(this.controls.target);
    const side = new Vector3().crossVectors(this.camera.up, offset).normalize();
    if (event.key === 'ArrowLeft') offset.applyAxisAngle(this.camera.up, -step);
    else if (event.key === 'ArrowRight') offset.applyAxisAngle(this.camera.up, step);
    else if (event.key === 'ArrowUp') offset.applyAxisAngle(side, -step);
    else if (event.key === 'ArrowDown') offset.applyAxisAngle(side, step);
    else if (event.key === '+' || event.key === '=') offset.multiplyScalar(0.9);
    else if (event.key === '-') offset.multiplyScalar(1.1);
    else {
      if (event.key === 'Home') this.reset();
      return;
    }
    event.preventDefault();
    this.turned = true;
    this.camera.position.copy(offset.add(this.controls.target));
    this.controls.update();
    this.draw();
  }
}

function nearest(phi: number[], angle: number): number {
  const turn = (a: number) => Math.abs(((((a - angle + 180) % 360) + 360) % 360) - 180);
  let best = 0;
  phi.forEach((p, i) => {
    if (turn(p) < turn(phi[best] as number)) best = i;
  });
  return best;
}

/** Frees a group's memory on the graphics card; keeps its materials for the next. */
function release(group: Group): void {
  group.traverse((node) => {
    const {geometry} = node as Mesh as {geometry?: BufferGeometry};
    geometry?.dispose();
    if (node instanceof InstancedMesh) node.dispose();
  });
}
