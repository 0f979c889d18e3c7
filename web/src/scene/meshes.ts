import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CatmullRomCurve3,
  Color,
  CylinderGeometry,
  DoubleSide,
  ExtrudeGeometry,
  Float32BufferAttribute,
  FrontSide,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  Quaternion,
  ShaderMaterial,
  Shape,
  SphereGeometry,
  TubeGeometry,
  Vector3,
  type Material,
} from 'three';
import {colour, partnerColour} from '../dom';
import type {CutTube, Frame, Gaps, Partner, Ribbon, Shell, Tool, Vector} from '../picture';
import {close} from './cap';

const radians = Math.PI / 180;
export const toVector = (v: Vector) => new Vector3(...v);

let stops: Color[] = [];
let rampOf: string | null = null;

/** From cool to warm: flat cuts to steep ones, small gaps to large. */
function shade(share: number, into: Color): Color {
  const t = Math.min(1, Math.max(0, share));
  const theme = document.documentElement.dataset['theme'] ?? '';
  if (theme !== rampOf) {
    stops = ['bevel-low', 'bevel-mid', 'bevel-high'].map((name) => new Color(colour(name)));
    rampOf = theme;
  }
  return t < 0.5 ? into.lerpColors(stops[0] as Color, stops[1] as Color, 2 * t) : into.lerpColors(stops[1] as Color, stops[2] as Color, 2 * t - 1);
}

/** The bevels that all cuts of a picture are tinted by. */
export type Span = [number, number] | undefined;
/** Of each edge's point: by its gap where gaps are shown, else both edges by the bevel. */
type Tint = (i: number, outer: boolean) => Color;
export function tintOf(b: number[] | undefined, gaps: Gaps | undefined, span: Span): Tint | undefined {
  if (gaps) return (i, outer) => shade(((outer ? gaps.outer : gaps.inner)[i] as number) / (gaps.most || 1), new Color());
  return b && span && ((i) => shade(((b[i] as number) - span[0]) / (span[1] - span[0]), new Color()));
}

export function matrix(frame: Frame | undefined): Matrix4 {
  const m = new Matrix4();
  if (!frame) return m;
  return m.makeBasis(toVector(frame.x), toVector(frame.y), toVector(frame.z)).setPosition(...frame.origin);
}

export const around = (radius: number, phi: number, z: number): Vector => [radius * Math.cos(phi * radians), radius * Math.sin(phi * radians), z];

/** Quads between two rows of points, closed round; normals as given or from the faces. */
export function strip(a: Vector[], b: Vector[], closed: boolean, normals?: [Vector[], Vector[]], tint?: Tint): BufferGeometry {
  const positions: number[] = [],
    directions: number[] = [],
    colours: number[] = [],
    index: number[] = [];
  a.forEach((p, i) => {
    positions.push(...p, ...(b[i] as Vector));
    if (normals) directions.push(...(normals[0][i] as Vector), ...(normals[1][i] as Vector));
    if (tint) {
      for (const c of [tint(i, false), tint(i, true)]) colours.push(c.r, c.g, c.b);
    }
  });
  const count = closed ? a.length : a.length - 1;
  for (let i = 0; i < count; ++i) {
    const j = (i + 1) % a.length;
    index.push(2 * i, 2 * j, 2 * i + 1, 2 * j, 2 * j + 1, 2 * i + 1);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3));
  if (tint) geometry.setAttribute('color', new Float32BufferAttribute(colours, 3));
  geometry.setIndex(index);
  if (normals) geometry.setAttribute('normal', new Float32BufferAttribute(directions, 3));
  else geometry.computeVertexNormals();
  return geometry;
}

// Materials are kept: a shader that is let go with the last material using it is compiled anew for the next picture.
const materials = new Map<string, Material>();
function kept<M extends Material>(name: string, make: () => M): M {
  const key = `${name} ${document.documentElement.dataset['theme']}`;
  const found = materials.get(key) ?? make();
  materials.set(key, found);
  return found as M;
}

// A little further off than it is: an edge drawn on it is whole.
const behind = {polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1};
export const metal = (name: string, hue: string) => kept(name, () => new MeshLambertMaterial({color: hue, side: DoubleSide, ...behind}));
export const steel = (tone: string) => metal(tone, colour(tone));
/** Of many members in one mesh, which have their colours at the vertices. Of a closed body without a section, the faces towards the eye do. */
export const crowded = (hue: string, closed: boolean) =>
  kept(`crowd ${hue} ${closed}`, () => new MeshLambertMaterial({color: hue, vertexColors: true, side: closed ? FrontSide : DoubleSide, ...behind}));
export const face = (tinted: boolean) =>
  kept(
    `face ${tinted}`,
    () => new MeshLambertMaterial({color: tinted ? 0xffffff : colour('bevel-mid'), vertexColors: tinted, side: DoubleSide, flatShading: true, ...behind}),
  );
export const ink = (tone: string) => kept(`line ${tone}`, () => new LineBasicMaterial({color: colour(tone)}));
/** Seen through everything: the cursor. */
const signal = () => kept('signal', () => new MeshBasicMaterial({color: colour('mark'), depthTest: false, transparent: true}));

function outline(points: Vector[], tone: string, closed = true): Line {
  const all = closed ? [...points, points[0] as Vector] : points;
  return new Line(new BufferGeometry().setFromPoints(all.map(toVector)), ink(tone));
}

/** Walls, bevel surface, far end, edges and junctions of one cut end. */
export function cutTube(tube: CutTube, before: boolean, span: Span): Group {
  const group = new Group();
  const {phi} = tube;
  const chosen = before && tube.before ? tube.before : tube;
  const innerEdge = phi.map((p, i) => around(tube.inner, p, chosen.zInner[i] as number));
  const outerEdge = phi.map((p, i) => around(tube.outer, p, chosen.zOuter[i] as number));
  const innerFar = phi.map((p) => around(tube.inner, p, tube.far)),
    outerFar = phi.map((p) => around(tube.outer, p, tube.far));
  const out = phi.map((p) => around(1, p, 0)),
    into = phi.map((p) => around(-1, p, 0));
  const wall = tube.tone === 'target' ? steel('steel') : metal(`member ${tube.tone}`, partnerColour(tube.tone));
  const outside = new Mesh(strip(outerEdge, outerFar, true, [out, out]), wall);
  outside.name = 'wall';
  group.add(outside, new Mesh(strip(innerFar, innerEdge, true, [into, into]), steel('bore')));
  const b = before && tube.before ? tube.before.b : tube.b;
  const tint = tintOf(b, tube.gaps, span);
  const bevel = new Mesh(strip(innerEdge, outerEdge, true, undefined, tint), face(Boolean(tint)));
  bevel.name = 'wall';
  group.add(bevel, new Mesh(strip(innerFar, outerFar, true), steel('bore')));
  close(group);
  group.add(outline(innerEdge, 'edge'), outline(outerEdge, 'edge'));
  if (tube.tone === 'target') group.add(outline(outerFar, 'edge'));
  const ball = new SphereGeometry(tube.outer * 0.035, 16, 12);
  for (const mark of tube.marks) {
    const dot = new Mesh(
      ball,
      kept('mark', () => new MeshBasicMaterial({color: colour('mark')})),
    );
    dot.position.set(...around(mark.radius, mark.phi, mark.z));
    group.add(dot);
  }
  group.applyMatrix4(matrix(tube.frame));
  return group;
}

export function rims(inside: Vector[], outside: Vector[]): Line[] {
  const outer = outline(outside, 'edge');
  outer.name = 'outer';
  return [outline(inside, 'edge'), outer];
}

/** Seen through where one looks straight at it, solid where it turns away: a partner that hides nothing. */
function glass(tone: number): ShaderMaterial {
  return new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    side: DoubleSide,
    uniforms: {tint: {value: new Color(partnerColour(tone))}},
    vertexShader: `varying vec3 n; varying vec3 eye;
      void main() { vec4 p = modelViewMatrix * vec4(position, 1.0); n = normalMatrix * normal; eye = -p.xyz; gl_Position = projectionMatrix * p; }`,
    fragmentShader: `uniform vec3 tint; varying vec3 n; varying vec3 eye;
      void main() { float rim = 1.0 - abs(dot(normalize(n), normalize(eye))); gl_FragColor = vec4(tint, 0.05 + 0.42 * rim * rim * rim);
      #include <colorspace_fragment>
      }`,
  });
}

const turned = (direction: Vector) => new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), toVector(direction).normalize());

export function partnerMesh(partner: Partner): Group {
  const group = new Group();
  const material = kept(`glass ${partner.tone}`, () => glass(partner.tone));
  const line = kept(`partner line ${partner.tone}`, () => new LineBasicMaterial({color: partnerColour(partner.tone)}));
  const mesh = shapeOf(partner, material, line);
  group.add(...mesh);
  if (partner.kind !== 'elbow') group.position.set(...partner.point);
  return group;
}

function shapeOf(partner: Partner, material: ShaderMaterial, line: LineBasicMaterial): (Mesh | Line | LineSegments)[] {
  if (partner.kind === 'plane') {
    const plane = new Mesh(
      new PlaneGeometry(2 * partner.half, 2 * partner.half),
      kept(
        `plane ${partner.tone}`,
        () => new MeshBasicMaterial({color: partnerColour(partner.tone), transparent: true, opacity: 0.16, side: DoubleSide, depthWrite: false}),
      ),
    );
    const edge = outlineOf(
      [
        [-1, -1],
        [1, -1],
        [1, 1],
        [-1, 1],
      ].map(([x, y]) => [Number(x) * partner.half, Number(y) * partner.half, 0]),
      line,
    );
    const q = new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), toVector(partner.normal).normalize());
    for (const each of [plane, edge]) each.quaternion.copy(q);
    return [plane, edge];
  }
  if (partner.kind === 'box') return box(partner, material, line);
  if (partner.kind === 'elbow') return elbow(partner, material);
  const slope = partner.kind === 'cone' ? partner.slope : 0;
  const top = Math.max(0, partner.radius + slope * partner.half),
    bottom = Math.max(0, partner.radius - slope * partner.half);
  const body = new Mesh(new CylinderGeometry(top, bottom, 2 * partner.half, 96, 1, true), material);
  const rings = [
    [top, partner.half],
    [bottom, -partner.half],
  ].map(([r, y]) =>
    outlineOf(
      Array.from({length: 96}, (_, i) => [Number(r) * Math.cos((i * Math.PI) / 48), Number(y), Number(r) * Math.sin((i * Math.PI) / 48)]),
      line,
    ),
  );
  const all = [body, ...rings];
  for (const each of all) each.quaternion.copy(turned(partner.direction));
  return all;
}

function box(partner: Extract<Partner, {kind: 'box'}>, material: ShaderMaterial, line: LineBasicMaterial): (Mesh | Line)[] {
  const w = partner.width / 2,
    h = partner.height / 2,
    r = partner.corner;
  const section = new Shape()
    .moveTo(-w + r, -h)
    .lineTo(w - r, -h)
    .absarc(w - r, -h + r, r, -Math.PI / 2, 0, false)
    .lineTo(w, h - r)
    .absarc(w - r, h - r, r, 0, Math.PI / 2, false)
    .lineTo(-w + r, h)
    .absarc(-w + r, h - r, r, Math.PI / 2, Math.PI, false)
    .lineTo(-w, -h + r)
    .absarc(-w + r, -h + r, r, Math.PI, 1.5 * Math.PI, false);
  const body = new Mesh(
    new ExtrudeGeometry(section, {depth: 2 * partner.half, bevelEnabled: false, curveSegments: 8}).translate(0, 0, -partner.half),
    material,
  );
  const z = toVector(partner.direction).normalize();
  const y = toVector(partner.up);
  y.addScaledVector(z, -y.dot(z)).normalize();
  const q = new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(new Vector3().crossVectors(y, z), y, z));
  const ends = [-partner.half, partner.half].map((at) =>
    outlineOf(
      section.getPoints(8).map((p): Vector => [p.x, p.y, at]),
      line,
    ),
  );
  const all = [body, ...ends];
  for (const each of all) each.quaternion.copy(q);
  return all;
}

function elbow(partner: Extract<Partner, {kind: 'elbow'}>, material: ShaderMaterial): Mesh[] {
  const along = toVector(partner.direction).normalize(),
    start = toVector(partner.point);
  const inwards = toVector(partner.inwards);
  inwards.addScaledVector(along, -inwards.dot(along)).normalize();
  const onArc = (t: number) =>
    start
      .clone()
      .addScaledVector(inwards, partner.bend * (1 - Math.cos(t)))
      .addScaledVector(along, partner.bend * Math.sin(t));
  const arc = Array.from({length: 49}, (_, i) => onArc((partner.angle * i) / 48));
  const out = along.clone().multiplyScalar(Math.cos(partner.angle)).addScaledVector(inwards, Math.sin(partner.angle));
  const leg = (length: number) => Array.from({length: 8}, (_, i) => ((i + 1) * length) / 8);
  const [before, after] = partner.half;
  const path = [
    ...leg(before)
      .map((s) => start.clone().addScaledVector(along, -s))
      .reverse(),
    ...arc,
    ...leg(after).map((s) => (arc[48] as Vector3).clone().addScaledVector(out, s)),
  ];
  return [new Mesh(new TubeGeometry(new CatmullRomCurve3(path), 160, partner.radius, 64, false), material)];
}

const outlineOf = (points: number[][], line: LineBasicMaterial) =>
  new Line(new BufferGeometry().setFromPoints([...points, points[0] as number[]].map((p) => new Vector3(p[0], p[1], p[2]))), line);

/** A member that is not round. */
export function shell({walls, cuts}: Shell): Group {
  const group = new Group();
  for (const [side, [from, to]] of Object.entries(walls)) {
    const mesh = new Mesh(strip(from, to, true), steel(side === 'outer' ? 'steel' : 'bore'));
    mesh.name = side;
    group.add(mesh);
  }
  for (const {inner, outer} of cuts) group.add(new Mesh(strip(inner, outer, true), steel('bore')), ...rims(inner, outer));
  return group;
}

export function ribbon(given: Ribbon, span: Span): Mesh {
  const tone = given.tone === 'bevel' ? 'bevel-mid' : given.tone;
  const tint = tintOf(given.bevel, given.gaps, span);
  if (tint) return new Mesh(strip(given.a, given.b, true, undefined, tint), face(true));
  return new Mesh(strip(given.a, given.b, true), steel(tone));
}

export const drawnLine = (points: Vector[], tone: string) => outline(points, tone);

/** The torch's line at one point: through both edges, and out to where the torch would be. */
export class Beam extends LineSegments {
  constructor() {
    super(
      new BufferGeometry(),
      kept('beam', () => new LineBasicMaterial({color: colour('mark'), depthTest: false, transparent: true})),
    );
    this.renderOrder = 1;
    this.geometry.setAttribute('position', new BufferAttribute(new Float32Array(6), 3));
    this.visible = false;
    this.frustumCulled = false;
    const head = new Mesh(new BoxGeometry(1, 1, 1), signal());
    head.renderOrder = 1;
    this.add(head);
  }

  put(tube: CutTube, before: boolean, i: number): void {
    const chosen = before && tube.before ? tube.before : tube;
    const phi = tube.phi[i] as number;
    this.aim(around(tube.inner, phi, chosen.zInner[i] as number), around(tube.outer, phi, chosen.zOuter[i] as number), tube.outer, tube.frame);
  }

  /**
   * Along the wall from its inner edge to its outer one, and beyond by the `size` of the target.
   */
  aim(inner: Vector, outer: Vector, size: number, frame?: Frame): void {
    const [a, b] = [toVector(inner), toVector(outer)];
    const out = b.clone().sub(a).normalize();
    const tip = b.clone().addScaledVector(out, size * 0.75);
    const back = a.clone().addScaledVector(out, -size * 0.08);
    const m = matrix(frame);
    const p = this.geometry.getAttribute('position') as BufferAttribute;
    [back, tip].forEach((v, k) => {
      v.applyMatrix4(m);
      p.setXYZ(k, v.x, v.y, v.z);
    });
    p.needsUpdate = true;
    const head = this.children[0] as Mesh;
    head.position.copy(tip);
    head.scale.set(size * 0.09, size * 0.34, size * 0.09);
    head.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), tip.clone().sub(back).normalize());
    this.visible = true;
  }
}

/** A mill's cutter, where the cursor is: its face and its flank. */
export class Cone extends Mesh {
  constructor(private readonly tool: Extract<Tool, {kind: 'cone'}>) {
    super(
      new CylinderGeometry(tool.back, tool.tip, tool.length, 64),
      kept('cutter', () => new MeshLambertMaterial({color: colour('after'), transparent: true, opacity: 0.72, side: DoubleSide, depthWrite: false})),
    );
    this.visible = false;
  }

  put(pose: {tip: Vector; axis: Vector} | undefined): void {
    this.visible = pose !== undefined;
    if (!pose) return;
    this.position.copy(toVector(pose.tip)).addScaledVector(toVector(pose.axis), this.tool.length / 2);
    this.quaternion.copy(turned(pose.axis));
  }
}
