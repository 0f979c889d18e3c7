/** Smoothed B: never below what is wanted, within slope and curvature, and of the stated area. */
import type {Columns, Cut} from './bevel.js';
import type {Scope} from './report.js';
import type {Body} from './solids.js';

/** B before smoothing at each row: what the rule wants, or more where a partner would be entered. */
export function wanted(cut: Cut, columns: Columns): number[] {
  const [raw, need] = [columns.b_raw_deg as number[], columns.b_required_deg as number[]];
  return raw.map((b, i) => {
    if (cut.untilted) return b;
    if (cut.contact === 'none') return b;
    const both = Math.max(b, need[i]);
    return cut.contact === 'auto' ? Math.min(both, cut.torch.max) : both;
  });
}

const hasJump = (result: Body) => (result.events as Body[]).some(({kind}) => kind === 'jump');

export function checkSmoothing(scope: Scope, cut: Cut, columns: Columns, result: Body, machine: Body | undefined): void {
  const has = ['b_deg', 'b_raw_deg', 'b_required_deg', 'developed_mm', 'length_mm', 'phi_deg'].every((name) => columns[name]);
  if (!has || cut.dihedral !== 'weld_side') return;
  const b = columns.b_deg as number[];
  const from = wanted(cut, columns);
  const limits = result.limits as {[name: string]: number} | undefined;
  const method = cut.smoothing.method;
  if (method === 'none' && !hasJump(result)) b.forEach((value, i) => scope.same('b_unsmoothed', value, from[i], 1e-9, 'deg', `row ${i}`));
  if (method !== 'envelope') return;
  b.forEach((value, i) => scope.most('b_above_wanted', from[i] - value, 2e-9, 'deg', `row ${i}`));
  const [K, A] = limitsOf(scope, cut, limits, machine);
  if (K === undefined || A === undefined) return;
  const along = columns[cut.smoothing.along === 'length' ? 'length_mm' : 'developed_mm'] as number[];
  const whole = result[cut.smoothing.along === 'length' ? 'length_mm' : 'developed_length_mm'] as number;
  const n = b.length;
  const at = (list: number[], i: number) => list[((i % n) + n) % n];
  const step = (i: number) => (((i % n) + n) % n === n - 1 ? whole + at(along, 0) - at(along, n - 1) : at(along, i + 1) - at(along, i));
  const slope = (i: number) => (at(b, i + 1) - at(b, i)) / step(i);
  let area = 0;
  for (let i = 0; i < n; i += 1) {
    if (step(i) <= 0) continue;
    const share = (step(i) + step(i - 1)) / 2;
    scope.most('slope', Math.abs(slope(i)), K * (1 + 1e-9) + 1e-12 / step(i), 'deg/mm', `row ${i}`);
    if (step(i - 1) > 0)
      scope.most(
        'second_difference',
        Math.abs(slope(i) - slope(i - 1)) / share,
        A * (1 + 1e-6) + 1e-12 / (share * Math.min(step(i), step(i - 1))),
        'deg/mm2',
        `row ${i}`,
      );
    area += share * (at(b, i) - from[i]);
  }
  const stated = result.smoothed_area as {area_deg_mm: number; least_deg_mm: number} | undefined;
  if (!stated) return;
  scope.same('smoothed_area_least', stated.least_deg_mm, stated.area_deg_mm, 2e-6 * (1 + stated.area_deg_mm), 'deg mm');
  if (hasJump(result)) {
    scope.not('smoothed_area', 'at a jump, B before smoothing is not in the columns');
    return;
  }
  scope.same('smoothed_area', stated.area_deg_mm, area, 1e-7 * (1 + area), 'deg mm');
  scope.covers('smoothed_area/area_deg_mm', 'smoothed_area/least_deg_mm');
}

/** Slope and curvature as requested, or what a machine's swing axis can do at the speed. */
function limitsOf(scope: Scope, cut: Cut, stated: {[name: string]: number} | undefined, machine: Body | undefined): [number | undefined, number | undefined] {
  const asked = cut.smoothing.limits as Body;
  let limits: [number, number] | undefined;
  if (typeof asked.max_slope_deg_per_mm === 'number') limits = [asked.max_slope_deg_per_mm, asked.max_curvature_deg_per_mm2 as number];
  else if (machine) {
    const axis = (machine.axes as Body[]).find(({name}) => name === 'B');
    const [use, speed] = [(asked.use as number | undefined) ?? 0.8, (asked.speed_mm_min as number) / 60];
    if (axis) limits = [(use * (axis.v_max as number)) / speed, (use * (axis.a_max as number)) / speed ** 2];
  }
  if (!limits) {
    scope.not('limits', 'the machine is not given: see --machines');
    return stated ? [stated.max_slope_deg_per_mm, stated.max_curvature_deg_per_mm2] : [undefined, undefined];
  }
  if (stated) {
    scope.same('limits', stated.max_slope_deg_per_mm / limits[0], 1, 1e-12, '');
    scope.same('limits', stated.max_curvature_deg_per_mm2 / limits[1], 1, 1e-12, '');
    scope.covers('limits/max_slope_deg_per_mm', 'limits/max_curvature_deg_per_mm2');
  }
  return limits;
}

/** Steps of B before smoothing that exceed the limit, each once. */
export function checkMutations(scope: Scope, cut: Cut, columns: Columns, result: Body): void {
  const phi = columns.phi_deg;
  if (!phi || !columns.b_raw_deg || !columns.b_required_deg || cut.dihedral !== 'weld_side') return;
  if (hasJump(result)) {
    scope.not('mutations', 'at a jump, B before smoothing is not in the columns');
    return;
  }
  const limit = (cut.smoothing.mutation_limit_deg as number | undefined) ?? 10;
  const from = wanted(cut, columns);
  const steps = from.flatMap((b, i): {phi_deg: number; next_deg: number; step_deg: number}[] => {
    const next = from[(i + 1) % from.length];
    const step = {phi_deg: phi[i], next_deg: phi[(i + 1) % phi.length], step_deg: next - b};
    return Math.abs(next - b) > limit ? [step] : [];
  });
  const stated = result.mutations as unknown as {phi_deg: number; step_deg: number}[];
  scope.same('mutations', stated.length, steps.length, 0, '');
  for (const {phi_deg, step_deg} of stated) {
    const near = steps.map((step) => Math.min(Math.abs(step.phi_deg - phi_deg), Math.abs(step.next_deg - phi_deg)) + Math.abs(step.step_deg - step_deg));
    scope.most('mutation', Math.min(...near), 1e-9 * 4, 'deg', `phi ${phi_deg}`);
  }
  scope.covers('mutations/*/phi_deg', 'mutations/*/step_deg');
  const limits = result.limits as Body | undefined;
  if (limits) {
    scope.same('limits', limits.mutation_limit_deg as number, limit, 0, 'deg');
    scope.covers('limits/mutation_limit_deg');
  }
}
