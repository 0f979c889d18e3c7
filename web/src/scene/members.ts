import {
  BufferGeometry,
  Color,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  Line,
  LineSegments,
  type Matrix4,
  Mesh,
  type PerspectiveCamera,
  type Plane,
  Ray,
  type Raycaster,
  Vector3,
} from 'three';
import {colour} from '../dom';
import {type Assembly, heightsOf, type MemberPart, reachOf} from '../picture';
import {close} from './cap';
import {Crowd, type Piece} from './crowd';
import {crowded, ink, matrix, metal, shell} from './meshes';
import {openings} from './openings';
import {closed, holedTube, thinned} from './walls';

const many = 60; // members, from which each is seen so small that a few columns and its outer edges do
const crowd = 240; // members, from which fewer do
const columns = {fine: 4, coarse: 15, coarsest: 20}; // degrees

/** A member's axis in the world. */
interface Axis {
  start: Vector3;
  end: Vector3;
  bar: [Vector3, Vector3]; // that much shorter as round ends are long
  radius: number;
}

export type Joint = NonNullable<Assembly['joints']>[number];

/** The members of a frame: each part's meshes once, shown in each place that it is made for. */
export class Members extends Group {
  readonly axes: Axis[];
  private readonly meshes: {mesh: InstancedMesh; of: number[]}[] = [];
  private readonly crowds: Crowd[] = []; // of members that are seen from afar
  private cutBy: Plane[] = [];

  constructor(readonly assembly: Assembly) {
    super();
    const {parts, members} = assembly;
    const placed = members.map(({frame}) => matrix(frame));
    this.axes = members.map(({part}, i) => axisOf(parts[part] as MemberPart, placed[i] as Matrix4));
    const lines: number[] = [];
    const afar = members.length > many;
    const step = members.length > crowd ? columns.coarsest : afar ? columns.coarse : columns.fine;
    const pieces: Record<string, Piece[]> = {'outer closed': [], 'bore closed': [], outer: [], bore: [], openings: []};
    parts.forEach((part, k) => {
      const of = members.flatMap((member, i) => (member.part === k ? [i] : []));
      const places = of.map((i) => placed[i] as Matrix4);
      const made = meshesOf(part, step);
      for (const each of made.children) {
        if (each instanceof Mesh && afar) {
          const own = pieces[`${sideOf(each)}${each.userData === closed ? ' closed' : ''}`];
          places.forEach((place, n) => own?.push({geometry: each.geometry, place, member: of[n] as number}));
        } else if (each instanceof Mesh) this.instance(each, of, places);
        else if (each instanceof Line && (!afar || each.name === 'outer')) places.forEach((place) => trace(each, place, lines));
        if (each instanceof Line) each.geometry.dispose();
      }
    });
    for (const [name, own] of Object.entries(pieces)) {
      const hue = name.startsWith('outer') ? '#ffffff' : '#a0a0a0';
      const materials = {whole: crowded(hue, name.endsWith('closed')), cut: crowded(hue, false)};
      if (own.length === 0) continue;
      const all = new Crowd(own, materials);
      this.crowds.push(all);
      this.add(name === 'openings' ? all : close(all));
    }
    const edges = new BufferGeometry();
    edges.setAttribute('position', new Float32BufferAttribute(lines, 3));
    this.add(new LineSegments(edges, ink('edge')));
    this.light(new Set(), new Set());
  }

  private instance(source: Mesh, of: number[], places: Matrix4[]): void {
    const mesh = new InstancedMesh(source.geometry, sideOf(source) === 'outer' ? metal('member', '#ffffff') : metal('member bore', '#a0a0a0'), of.length);
    places.forEach((place, n) => mesh.setMatrixAt(n, place));
    this.meshes.push({mesh, of});
    this.add(sideOf(source) === 'openings' ? mesh : close(mesh));
  }

  /** Of a section, whose cut shows the inside of the walls. */
  set planes(planes: Plane[]) {
    this.cutBy = planes;
    for (const each of this.crowds) each.material = planes.length ? each.materials.cut : each.materials.whole;
  }

  /** Highlights the selection, and the hovered items a little less. */
  light(chosen: Set<number>, pointed: Set<number>): void {
    const {members} = this.assembly;
    const accent = new Color(colour('chosen'));
    const hues = new Map<string, Color>();
    for (const {tone} of members) if (!hues.has(tone)) hues.set(tone, new Color(colour(tone)));
    const hue = (i: number) => {
      const own = hues.get(members[i]?.tone as string) as Color;
      return chosen.has(i) ? accent : pointed.has(i) ? own.clone().lerp(accent, 0.6) : own;
    };
    for (const each of this.crowds) each.paint(hue);
    for (const {mesh, of} of this.meshes) {
      of.forEach((i, n) => mesh.setColorAt(n, hue(i)));
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
  }

  /** Whether a section leaves a point. */
  private readonly kept = (point: Vector3) => this.cutBy.every((plane) => plane.distanceToPoint(point) >= 0);

  /** The members of an item. */
  of(item: number | null): Set<number> {
    return new Set(item === null ? [] : this.assembly.lights[item]);
  }

  /**
   * Returns the position of a member's name: at its middle, or another point that no other member
   * hides; undefined if a section leaves nothing of it.
   */
  place(i: number, eye: Vector3): Vector3 | undefined {
    const {start, end} = this.axes[i] as Axis;
    const places = [0.5, 0.35, 0.65, 0.2, 0.8, 0.08, 0.92].map((share) => start.clone().lerp(end, share)).filter(this.kept);
    const open = places.find((at) => this.near(new Ray(eye, at.clone().sub(eye).normalize()), 0) === i);
    return open ?? places[0];
  }

  /** Where a joint is, if one of its members is the first to be seen there. */
  joint({at, of}: Joint, eye: Vector3): Vector3 | undefined {
    const place = new Vector3(...at);
    if (!this.kept(place)) return undefined;
    const first = this.near(new Ray(eye, place.clone().sub(eye).normalize()), 0);
    return first === null || of.includes(first) ? place : undefined;
  }

  /** How far off a camera that looks at `centre` sees them all. */
  distance(camera: PerspectiveCamera, towards: Vector3, centre: Vector3): number {
    const side = new Vector3().crossVectors(camera.up, towards).normalize();
    const above = new Vector3().crossVectors(towards, side);
    const tall = Math.tan((camera.fov * Math.PI) / 360) * 0.94; // a margin
    return this.axes.reduce((most, {start, end, radius}) => {
      const needed = [start, end].map((p) => {
        const off = p.clone().sub(centre);
        const half = Math.max((Math.abs(off.dot(side)) + radius) / camera.aspect, Math.abs(off.dot(above)) + radius);
        return off.dot(towards) + half / tall;
      });
      return Math.max(most, ...needed);
    }, 0);
  }

  /** The member that is seen along a ray, else the one that it passes the closest, by the angle `slack` at most. */
  under(caster: Raycaster, slack: number): number | null {
    const seen = this.meshes.flatMap(({mesh, of}) => caster.intersectObject(mesh).map((hit) => ({member: of[hit.instanceId as number] as number, hit})));
    const near = [...this.axes.keys()].filter((i) => this.crowds.length && this.passes(caster.ray, i));
    seen.push(...this.crowds.flatMap((each) => each.hits(caster, near)));
    const first = seen.sort((a, b) => a.hit.distance - b.hit.distance).find(({hit}) => this.kept(hit.point));
    return first?.member ?? this.near(caster.ray, slack);
  }

  /** Whether a ray comes so near to a member's axis that it may meet the member. */
  private passes(ray: Ray, i: number): boolean {
    const {start, end, radius} = this.axes[i] as Axis;
    return ray.distanceSqToSegment(start, end) < (3 * radius) ** 2; // an end that is cut at a slant reaches beyond the axis
  }

  /** As `under`, of round bars with round ends: quick, and not to be clicked by. */
  private near(ray: Ray, slack: number): number | null {
    const on = new Vector3();
    let best = {i: -1, miss: slack, enters: Infinity};
    for (const [i, {bar, radius}] of this.axes.entries()) {
      const apart = Math.sqrt(Math.max(0, ray.distanceSqToSegment(...bar, on))); // below 0 by rounding
      if (!this.kept(on)) continue;
      const depth = on.distanceTo(ray.origin);
      const miss = Math.max(0, apart - radius) / depth;
      const enters = depth - Math.sqrt(Math.max(0, radius ** 2 - apart ** 2));
      if (miss < best.miss || (miss === best.miss && enters < best.enters)) best = {i, miss, enters};
    }
    return best.i < 0 ? null : best.i;
  }
}

const sideOf = ({name}: Mesh) => (name === 'outer' || name === 'openings' ? name : 'bore');

function meshesOf(part: MemberPart, step: number): Group {
  if ('cuts' in part) {
    const drawn = shell(part);
    return part.openings?.length ? drawn.add(openings(part.openings)) : drawn;
  }
  const ends = step === columns.fine ? {} : {from: thinned(part.from, step), to: thinned(part.to, step)};
  return holedTube({...part, ...ends}, undefined, step);
}

function axisOf(part: MemberPart, place: Matrix4): Axis {
  const [low, high] = heightsOf(part).map(mean) as [number, number];
  const outer = reachOf(part);
  const at = (z: number) => new Vector3(0, 0, z).applyMatrix4(place);
  const end = Math.min(outer, (high - low) / 2);
  return {start: at(low), end: at(high), bar: [at(low + end), at(high - end)], radius: outer};
}
const mean = (values: number[]) => values.reduce((a, b) => a + b, 0) / values.length;

/** A line's stretches, moved to where they belong. */
function trace(line: Line, place: Matrix4, into: number[]): void {
  const points = line.geometry.getAttribute('position');
  const at = (i: number) => new Vector3().fromBufferAttribute(points, i).applyMatrix4(place);
  for (let i = 0; i + 1 < points.count; ++i) into.push(...at(i), ...at(i + 1));
}
