import {type Columns, type Cut, checkRows} from './bevel.js';
import {checkMutations, checkSmoothing} from './smoothing.js';
import {
  checkBinds,
  checkEvents,
  checkLength,
  checkPenetration,
  checkTorchLine,
  checkUntilted,
  type Event,
  jumpsOf,
  type Penetration,
  rowsOf,
  type TorchLine,
} from './wall.js';
import type {Scope} from './report.js';
import {type Body, isSection, type Section, type Size, type Solid, sizeOf, solid} from './solids.js';

export interface Knowledge {
  sizes: ReadonlyMap<string, Size>;
  sections: ReadonlyMap<string, Section>;
  machines: ReadonlyMap<string, Body>;
}

/** Of a section, whose outlines are not part of its cut. */
export const NO_SIZE: Size = {outer_diameter_mm: 0, wall_mm: 0};
const num = (v: unknown, otherwise: number) => (typeof v === 'number' ? v : otherwise);

export function cutOf(request: Body, know: Knowledge): Cut {
  const target = request.target as Body;
  const {outer_diameter_mm, wall_mm} = isSection(target) ? NO_SIZE : sizeOf(target, know.sizes);
  const grown = num(request.coating_mm, 0) + num(request.root_gap_mm, 0);
  const partners: Solid[] = (request.cutters as Body[]).map((body) => solid(body, grown, know.sizes));
  return cutBy(request, outer_diameter_mm / 2, wall_mm, partners);
}

export function cutBy(request: Body, outer: number, wall: number, partners: Solid[]): Cut {
  const torch = (request.torch ?? {}) as Body;
  return {
    inner: outer - wall,
    outer,
    partners,
    root: request.root_surface === 'outer' ? 'outer' : 'inner',
    contact: String(request.contact ?? 'inner'),
    groove: request.groove as Body,
    dihedral: String(request.dihedral ?? 'weld_side'),
    face: num(request.root_face_mm, 0),
    kerf: num(request.kerf_mm, 0),
    torch: {min: num(torch.min_deg, -80), max: num(torch.max_deg, 80)},
    untilted: request.preset === 'tube_laser',
    smoothing: (request.smoothing ?? {method: 'none'}) as Body,
  };
}

/** A table in its end's own frame, whole. */
export function checkEnd(scope: Scope, cut: Cut, result: Body, know: Knowledge): void {
  const points = result.points as Body;
  const columns = points as unknown as Columns;
  const events = result.events as unknown as Event[];
  if (result.b_sign === 'inward' || cut.dihedral !== 'weld_side') {
    scope.not('points', 'made for comparison with a source, never for cutting');
    return;
  }
  checkRows(scope, cut, columns, points.zone as string[] | undefined, [jumpsOf(events, cut.root), [...jumpsOf(events, 'inner'), ...jumpsOf(events, 'outer')]]);
  if (!needed.every((name) => columns[name])) return;
  for (const surface of ['inner', 'outer'] as const) if (cut.partners.length) checkEvents(scope, cut, events, surface, true);
  checkLength(scope, cut, columns.phi_deg as number[], columns.length_mm, events, result as unknown as {length_mm: number; developed_length_mm: number});
  const limits = cut.smoothing.limits as Body | undefined;
  checkSmoothing(scope, cut, columns, result, machineOf(limits?.machine, know));
  checkMutations(scope, cut, columns, result);
  checkBinds(scope, cut, columns, result.torch_binds as Body[]);
  const rows = rowsOf(cut, columns);
  checkPenetration(scope, cut, rows, result.penetration as unknown as Penetration);
  checkTorchLine(scope, cut, rows, result.torch_line as unknown as TorchLine);
  if (cut.untilted || columns.gap_inner_mm) checkUntilted(scope, cut, columns, result.tube_laser as never);
}

const needed = ['phi_deg', 'z_inner_mm', 'z_outer_mm', 'torch_inner_mm', 'torch_outer_mm', 'b_deg'];

export const machineOf = (choice: unknown, know: Knowledge): Body | undefined =>
  typeof choice === 'string' ? know.machines.get(choice) : (choice as Body | undefined);
