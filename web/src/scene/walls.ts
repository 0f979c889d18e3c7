import {BufferGeometry, Float32BufferAttribute, Group, Mesh} from 'three';
import type {EndCurve, HoledTube} from '../picture';
import {around, face, rims, type Span, steel, strip, tintOf} from './meshes';

/** Of meshes whose front is the outside of a closed body: its walls and its ends. */
export const closed = {closed: true};

/** The same faces, seen from the other side. */
function flipped(geometry: BufferGeometry): BufferGeometry {
  const [index, normals] = [geometry.getIndex(), geometry.getAttribute('normal')];
  if (index) geometry.setIndex(Array.from(index.array).reverse());
  for (let i = 0; i < normals.count; ++i) normals.setXYZ(i, -normals.getX(i), -normals.getY(i), -normals.getZ(i));
  return geometry;
}

/** A member with its holes: each wall in columns of constant phi, `step` degrees wide at most, each column open where a hole is. */
export function holedTube(tube: HoledTube, span: Span, step = 2): Group {
  const group = new Group();
  for (const [side, radius, tone] of [
    ['outer', tube.outer, 'steel'],
    ['inner', tube.inner, 'bore'],
  ] as const) {
    const holes = tube.holes.map((hole) => hole[side]);
    const wall = new Mesh(openWall(radius, edge(tube.from, side), edge(tube.to, side), holes, step, side === 'inner'), steel(tone));
    wall.name = side;
    wall.userData = closed;
    group.add(wall);
  }
  for (const hole of tube.holes) {
    const inside = hole.inner.phi.map((p, i) => around(tube.inner, p, hole.inner.z[i] as number));
    const outside = hole.outer.phi.map((p, i) => around(tube.outer, p, hole.outer.z[i] as number));
    const tint = tintOf(hole.b, hole.gaps, span);
    const bevel = new Mesh(strip(inside, outside, true, undefined, tint), face(Boolean(tint)));
    group.add(bevel, ...rims(inside, outside));
  }
  for (const end of [tube.from, tube.to]) {
    const inside = end.phi.map((p, i) => around(tube.inner, p, end.zInner[i] as number));
    const outside = end.phi.map((p, i) => around(tube.outer, p, end.zOuter[i] as number));
    const tint = tintOf(end.b, end.gaps, span);
    const ring = strip(inside, outside, true, undefined, tint);
    const cut = new Mesh(end === tube.to ? flipped(ring) : ring, tint ? face(true) : steel('bore'));
    cut.userData = closed;
    group.add(cut, ...rims(inside, outside));
  }
  return group;
}

interface Curve {
  phi: number[];
  z: number[];
}
const turn = (p: number) => ((p % 360) + 360) % 360;

/** One wall's edge of an end, in the order of phi. */
function edge(end: EndCurve, side: 'outer' | 'inner'): Curve {
  const order = end.phi.map((_, i) => i).sort((a, b) => turn(end.phi[a] as number) - turn(end.phi[b] as number));
  const z = side === 'outer' ? end.zOuter : end.zInner;
  return {phi: order.map((i) => turn(end.phi[i] as number)), z: order.map((i) => z[i] as number)};
}

/** An end with a point every `step` degrees, for a view from afar. */
export function thinned(end: EndCurve, step: number): EndCurve {
  const phi = Array.from({length: 360 / step}, (_, i) => step * i);
  return {phi, zInner: heights(edge(end, 'inner'), phi), zOuter: heights(edge(end, 'outer'), phi)};
}

/** z of an edge at ascending angles. */
function heights({phi, z}: Curve, angles: number[]): number[] {
  const last = phi.length - 1;
  const all = [(phi[last] as number) - 360, ...phi, (phi[0] as number) + 360];
  const values = [z[last] as number, ...z, z[0] as number];
  let i = 0;
  return angles.map((angle) => {
    while (i + 2 < all.length && (all[i + 1] as number) <= angle) ++i;
    const [a, b] = [all[i] as number, all[i + 1] as number];
    const t = b > a ? (angle - a) / (b - a) : 0;
    return (values[i] as number) * (1 - t) + (values[i + 1] as number) * t;
  });
}

/** A wall between two edges, open where holes are. Every point of a curve begins a column, so that within one all edges are straight. */
function openWall(radius: number, from: Curve, to: Curve, holes: Curve[], step: number, inwards: boolean): BufferGeometry {
  const columns = stopsOf([from, to, ...holes], step);
  const [starts, ends] = [heights(from, columns), heights(to, columns)];
  const positions: number[] = [],
    normals: number[] = [],
    index: number[] = [];
  let before: {low: number; high: number; at: string} | undefined; // a side of the last quad, which the next one shares if no hole begins there
  const side = (phi: number, low: number, high: number) => {
    const at = `${phi} ${low} ${high}`;
    if (before?.at === at) return before;
    const first = positions.length / 3;
    positions.push(...around(radius, phi, low), ...around(radius, phi, high));
    normals.push(...around(inwards ? -1 : 1, phi, 0), ...around(inwards ? -1 : 1, phi, 0));
    return {low: first, high: first + 1, at};
  };
  const quad = (p: number, q: number, low: [number, number], high: [number, number]) => {
    const [a, b] = [side(p, low[0], high[0]), side(q, low[1], high[1])];
    if (inwards) index.push(a.low, b.high, b.low, a.low, a.high, b.high);
    else index.push(a.low, b.low, b.high, a.low, b.high, a.high);
    before = b;
  };
  for (let i = 0; i + 1 < columns.length; ++i) {
    const [p, q] = [columns[i] as number, columns[i + 1] as number];
    let low: [number, number] = [starts[i] as number, starts[i + 1] as number];
    const gaps = holes
      .map((hole) => opening(hole, p, q))
      .filter((gap): gap is Opening => gap !== null)
      .sort((a, b) => a.from[0] - b.from[0]);
    for (const gap of gaps) {
      quad(p, q, low, gap.from);
      low = gap.to;
    }
    quad(p, q, low, [ends[i] as number, ends[i + 1] as number]);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new Float32BufferAttribute(normals, 3));
  geometry.setIndex(index);
  return geometry;
}

/** All angles that curves have a point at, and every `step` degrees, once each. */
function stopsOf(curves: Curve[], step: number): number[] {
  const all = [...Array.from({length: 360 / step + 1}, (_, i) => step * i), ...curves.flatMap((curve) => curve.phi.map(turn))].sort((a, b) => a - b);
  return all.filter((angle, i) => i === 0 || angle - (all[i - 1] as number) > 1e-7);
}

/** z at both sides of a column, where a hole begins and where it ends. */
interface Opening {
  from: [number, number];
  to: [number, number];
}
function opening(hole: Curve, p: number, q: number): Opening | null {
  const middle = (p + q) / 2;
  const edges: [number, number][] = [];
  hole.phi.forEach((a, i) => {
    const j = (i + 1) % hole.phi.length;
    const way = (((((hole.phi[j] as number) - a + 540) % 360) + 360) % 360) - 180; // the short one, across the seam too
    if (way === 0) return;
    const offset = ((((middle - a + 180) % 360) + 360) % 360) - 180;
    const share = offset / way;
    if (share < 0 || share >= 1) return;
    const z = (angle: number) => (hole.z[i] as number) + (((hole.z[j] as number) - (hole.z[i] as number)) * (offset + angle - middle)) / way;
    edges.push([z(p), z(q)]);
  });
  if (edges.length < 2) return null;
  edges.sort((a, b) => a[0] + a[1] - b[0] - b[1]);
  return {from: edges[0] as [number, number], to: edges[edges.length - 1] as [number, number]};
}
