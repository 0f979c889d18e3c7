/** Curves of an intersection: every point on its partner, no partner above, lengths and events. */
import {above, type Cut} from './bevel.js';
import type {Scope} from './report.js';
import type {Body} from './solids.js';
import {onTube, RAD} from './space.js';
import {checkEvents, checkLength, type Event, jumpsOf} from './wall.js';

export function checkProfile(scope: Scope, whole: Cut, profile: Body, sampling: unknown): void {
  const surface = profile.surface as 'inner' | 'outer';
  const cut: Cut = {...whole, root: surface};
  const rho = surface === 'inner' ? cut.inner : cut.outer;
  const points = profile.points as unknown as {[name: string]: number[]};
  scope.same('profile_radius', profile.radius_mm as number, rho, 1e-12 * (1 + rho), 'mm');
  const [phi, z, cutter] = [points.phi_deg, points.z_mm, points.cutter];
  const events = profile.events as unknown as Event[];
  const jumps = jumpsOf(events, surface);
  const {uniform_points, tolerance_mm} = (sampling ?? {}) as {uniform_points?: number; tolerance_mm?: number};
  const known = events.map(({phi_deg}) => phi_deg % 360);
  phi.forEach((deg, i) => {
    const at = deg * RAD;
    if (uniform_points && tolerance_mm === undefined && !known.some((event) => Math.abs(event - deg) < 1e-9)) {
      const step = (deg * uniform_points) / 360;
      scope.most('uniform', (Math.abs(step - Math.round(step)) * 360) / uniform_points, 1e-10, 'deg', `row ${i}`);
    }
    const [height, by] = [z[i], cutter[i]];
    const top = cut.partners[by]?.top(rho * Math.cos(at), rho * Math.sin(at)) ?? NaN;
    const fine = 1e-10 + 3e-13 * (rho + Math.abs(height));
    const lost = jumps.some((jump) => Math.abs(jump - at) < 1e-9);
    scope.most('on_partner', Math.abs(cut.partners[by]?.distance(onTube(rho, at, height)) ?? NaN), fine, 'mm', `row ${i}`);
    if (!lost) scope.same('height', height, top, 5e-10 + 1e-12 * Math.abs(height), 'mm', `row ${i}`);
    scope.most('none_above', above(cut, rho, at, height, jumps), 1e-7 * (1 + rho / 10), 'mm', `row ${i}`);
  });
  checkEvents(scope, cut, events, surface, true);
  const {length_mm, developed_length_mm} = profile as unknown as {length_mm: number; developed_length_mm: number};
  checkLength(scope, cut, phi, undefined, events, {length_mm, developed_length_mm}, rho, surface);
  scope.covers('radius_mm', 'points/phi_deg', 'points/z_mm', 'points/cutter');
}
