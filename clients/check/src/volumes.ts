/** Metal of a round part: below a cut, and in a hole (docs/theory/parts.md). */
import type {Cut} from './bevel.js';
import type {Body} from './solids.js';
import {add, mul, onTube, RAD, sub, type V3} from './space.js';

/** Metal of the target below a cut, from z = 0: the edges straight between rows, and across the wall. */
export function under(cut: Cut, points: {[name: string]: number[]}): number {
  const phi = points.phi_deg;
  const radii = points.z_face_mm && cut.face > 0 ? [cut.inner, cut.inner + cut.face, cut.outer] : [cut.inner, cut.outer];
  const columns = radii.map((_, k) => (k === 0 ? 'z_inner_mm' : k === radii.length - 1 ? 'z_outer_mm' : 'z_face_mm'));
  const around = columns.map((name) => {
    const z = points[name];
    return phi.reduce((sum, deg, i) => {
      const last = i + 1 === phi.length;
      const next = last ? phi[0] + 360 : phi[i + 1];
      return sum + ((z[i] + z[last ? 0 : i + 1]) / 2) * (next - deg) * RAD;
    }, 0);
  });
  let volume = 0;
  for (let k = 0; k + 1 < radii.length; k += 1) {
    const [a, t, from, to] = [radii[k], radii[k + 1] - radii[k], around[k], around[k + 1]];
    volume += from * (a * t + (t * t) / 2) + (to - from) * ((a * t) / 2 + (t * t) / 3);
  }
  return volume;
}

/** Metal that holes take: of each the area between its wall's lines, on cylinders across the wall. */
export function plugs(holes: Body[], R: number, r: number): number {
  const count = 24;
  let volume = 0;
  for (const hole of holes) {
    const points = hole.points as unknown as {[name: string]: number[]};
    const column = (name: string) => points[name];
    const lines = column('phi_deg').map((deg, i): [V3, V3] => [
      onTube(r, column('phi_inner_deg')[i] * RAD, column('z_inner_mm')[i]),
      onTube(R, deg * RAD, column('z_mm')[i]),
    ]);
    for (let k = 0; k < count; k += 1) {
      const rho = r + ((k + 0.5) / count) * (R - r);
      const ring = lines.map(([a, b]): [number, number] => {
        const d = sub(b, a);
        const [p, q, c] = [d[0] ** 2 + d[1] ** 2, a[0] * d[0] + a[1] * d[1], a[0] ** 2 + a[1] ** 2 - rho * rho];
        const u = (-q + Math.sqrt(Math.max(0, q * q - p * c))) / p;
        const at_ = add(a, mul(d, u));
        return [Math.atan2(at_[1], at_[0]), at_[2]];
      });
      const centre = ring[0][0];
      const area = ring.reduce((sum, [phi, z], i) => {
        const [next, up] = ring[(i + 1) % ring.length];
        const [s, t] = [phi, next].map((angle) => Math.atan2(Math.sin(angle - centre), Math.cos(angle - centre))) as [number, number];
        return sum + (s * up - t * z) / 2;
      }, 0);
      volume += Math.abs(area) * rho * ((R - r) / count);
    }
  }
  return volume;
}
