/** Pulse schedules: limits of every axis, sums, and the torch's way against a contour (docs/theory/pulse-schedules.md). */
import type {Scope} from './report.js';
import type {Body, Numbers} from './solids.js';
import {cross, dot, RAD, type V3, wrapped} from './space.js';

interface Axis {
  name: string;
  pulses_per_unit?: number;
  pulses_per_turn?: number;
  v_max: number;
  a_max: number;
  j_max?: number | null;
  n_max?: number | null;
  soft_min?: number | null;
  soft_max?: number | null;
}

type Counts = {[name: string]: number[]};
const list = (v: unknown) => (v ?? []) as Body[];
const scale = (axis: Axis): number => axis.pulses_per_unit ?? (axis.pulses_per_turn as number) / 360;
const largest = (values: number[]): number => values.reduce((most, v) => Math.max(most, Math.abs(v)), 0);
const steps = (values: number[]): number[] => values.map((v, i) => v - (i > 0 ? values[i - 1] : 0));

/** Members that follow from more than counts and machine, and why. */
const undetermined = {
  'report/max_use': 'of the motion before it is rounded to pulses: only that the pulses keep the limits',
  'report/closure': 'only that it is at most one pulse',
  report: 'of the smoothed path of the service, which is in no answer',
  start: 'only the travel from there, and the way along the contour',
  events: 'their places on the smoothed path of the service, which is in no answer',
};

export function checkSchedule(scope: Scope, request: Body, result: Body, machine: Body | undefined): void {
  const [counts, total, start, report] = [result.counts as unknown as Counts, result.total as Numbers, result.start as Numbers, result.report as Body];
  const period = (result.period_us as number) * 1e-6;
  const periods = result.periods as number;
  for (const [what, why] of Object.entries(undetermined)) scope.not(what, why);
  scope.same('schedule_time', report.time_s as number, periods * period, 1e-10 * (1 + periods * period), 's');
  scope.covers('periods', 'period_us', 'report/time_s');
  const peaks = report.peak as Numbers;
  for (const [name, sum] of Object.entries(total)) {
    const n = counts[name] ?? [];
    scope.same(
      'total',
      sum,
      n.reduce((all, v) => all + v, 0),
      0,
      'pulses',
      name,
    );
    scope.same('peak', peaks[name], largest(n), 0, 'pulses', name);
    scope.most('whole_pulses', n.every(Number.isInteger) ? 0 : 1, 0, '', name);
    scope.same('schedule_periods', n.length, counts[name] ? periods : 0, 0, '', name);
    scope.covers(`counts/${name}`, `total/${name}`, `report/peak/${name}`);
  }
  checkTimes(scope, result, period);
  if (!machine) scope.not('', 'the machine is not given: see --machines');
  else {
    scope.same('schedule_period', result.period_us as number, machine.period_us as number, 0, 'us');
    const jerk = ((request.motion ?? {}) as Body).jerk !== false;
    for (const axis of machine.axes as unknown as Axis[])
      checkAxis(scope, axis, counts[axis.name] ?? [], start[axis.name], period, jerk, report, !result.segments); // of a part, uses are of its cuts only
  }
  for (const axis of list(((result.comparison as Body | undefined)?.naive as Body | undefined)?.axes)) checkNaive(scope, axis);
  if (machine) checkWay(scope, request, machine, counts, start, periods);
}

/** Segments follow each other without gaps and take the times that are stated. */
function checkTimes(scope: Scope, result: Body, period: number): void {
  const [segments, times] = [list(result.segments), result.times as Numbers | undefined];
  if (!times) return;
  const of = (kind: string) => segments.filter((s) => s.kind === kind).reduce((sum, s) => sum + ((s.to as number) - (s.from as number)) * period, 0);
  segments.forEach((segment, i) => scope.same('segments_join', segment.from as number, i ? (segments[i - 1].to as number) : 0, 0, 'periods', i));
  scope.same('segments_join', segments[segments.length - 1].to as number, result.periods as number, 0, 'periods');
  for (const kind of ['cut', 'pierce', 'rapid', 'mark']) {
    if (times[`${kind}_s`] !== undefined) scope.same('times', times[`${kind}_s`], of(kind), 1e-9 * (1 + of(kind)), 's', kind);
    scope.covers(`times/${kind}_s`);
  }
  scope.same('times', times.total_s, (result.periods as number) * period, 1e-9 * (1 + times.total_s), 's');
  scope.covers('times/total_s', 'segments/*/from', 'segments/*/to');
}

/** Each difference of rounded positions is off by half a pulse for each term at most, so by 1, 2 and 4 pulses. */
function checkAxis(scope: Scope, axis: Axis, n: number[], start: number | undefined, T: number, jerk: boolean, report: Body, single: boolean): void {
  const k = scale(axis);
  const where = axis.name;
  const second = steps(n);
  if (axis.n_max) scope.most('pulses_per_period', largest(n), axis.n_max, 'pulses', where);
  scope.most('speed', largest(n), axis.v_max * k * T * (1 + 1e-6) + 1, 'pulses', where);
  scope.most('acceleration', largest([...second, n.length ? -n[n.length - 1] : 0]), axis.a_max * k * T * T * (1 + 1e-6) + 2, 'pulses', where);
  if (axis.j_max && jerk) scope.most('jerk', largest(steps(second)), axis.j_max * k * T ** 3 * (1 + 1e-6) + 4, 'pulses', where);
  if (start !== undefined) for (const off of beyond(axis, n, start)) scope.most('travel', off, 0.51, 'pulses', where);
  const use = report.max_use as Numbers;
  const [v, ratio] = [use[`v_${axis.name}`], use[`n_${axis.name}`]];
  if (v !== undefined) {
    if (single) scope.same('use_of_speed', v * axis.v_max * k * T, largest(n), 1, 'pulses', where);
    if (ratio !== undefined && axis.n_max) scope.same('use_of_counter', ratio * axis.n_max, v * axis.v_max * k * T, 1e-6 * axis.n_max, 'pulses', where);
    scope.covers(`report/max_use/v_${axis.name}`, `report/max_use/n_${axis.name}`);
  }
  const closure = (report.closure as Numbers)[axis.name];
  if (closure !== undefined) scope.most('closure', Math.abs(closure), 1, 'pulses', where);
}

/** Figures of a contour at full speed: peak, and the largest step as a counter of 16 bits reads it. */
function checkNaive(scope: Scope, axis: Body): void {
  const where = String(axis.name);
  const largest_ = axis.largest_step_pulses as number;
  scope.same('naive_peak', axis.peak_pulses as number, largest((axis.pulses ?? []) as number[]), 0.5 + 1e-9, 'pulses', where);
  scope.same('naive_16_bits', axis.step_in_16_bits as number, new Int16Array([largest_])[0], 0, 'pulses', where);
  scope.covers('comparison/naive/axes/*/peak_pulses', 'comparison/naive/axes/*/step_in_16_bits', 'comparison/naive/axes/*/largest_step_pulses');
}

type Way = {phi: number; z: number; b: number}[];

/** Where the beam enters the contour's cylinder before the first period and after each one, its height exact; of a mill or plain axes nothing. */
function wayOf(machine: Body, counts: Counts, start: Numbers, periods: number, tube: {outer: number; surface: number}): Way {
  const axes = machine.axes as unknown as Axis[];
  const path = axes.map((axis) => {
    const at = [start[axis.name]];
    for (let i = 0; i < periods; i += 1) at.push(at[i] + (counts[axis.name]?.[i] ?? 0) / scale(axis));
    return at;
  });
  const column = (name: string) => path[axes.findIndex((axis) => axis.name === name)] ?? Array(periods + 1).fill(0);
  const sign = machine.b_positive === 'outer_edge_into_part' ? 1 : -1;
  const num = (name: string) => (machine[name] as number | undefined) ?? 0;
  const at = (phi: number, z: number, height: number, b: number) => ({phi, z: z - height * Math.tan(b * RAD), b});
  if (machine.type === 'five_axis_cutter') {
    const [C, Y, B] = ['C', 'Y', 'B'].map(column);
    return C.map((phi, i) => at(phi, Y[i], tube.outer - tube.surface + (num('pivot_length_mm') + num('standoff_mm')) * Math.cos(B[i] * RAD), sign * B[i]));
  }
  if (machine.type === 'crawler') {
    const [S, E, B] = ['S', 'E', 'B'].map(column);
    const height = tube.outer - tube.surface + (machine.swing_center === 'pivot' ? num('pivot_length_mm') : 0);
    return S.map((s, i) => at(s / (tube.outer + num('wheel_offset_mm')) / RAD, E[i], height, sign * B[i]));
  }
  if (machine.type === 'tube_table') {
    // Of a round tube, whose table has no use for its axis across.
    const [A, Y, B] = ['A', 'Y', 'B'].map(column);
    return A.map((turn, i) => at(-turn, Y[i], tube.outer - tube.surface + (num('pivot_length_mm') + num('standoff_mm')) * Math.cos(B[i] * RAD), sign * B[i]));
  }
  if (machine.type !== 'generic') return [];
  const maps = machine.maps as unknown as Numbers[];
  return path[0].map((_, i) => {
    // Cramer's rule of the normal equations: there may be more axes than coordinates.
    const rows = maps.map((map, k): [V3, number] => [[map.k_phi ?? 0, map.k_z ?? 0, map.k_b ?? 0], path[k][i] - (map.k_0 ?? 0)]);
    const sum = (f: (row: V3, value: number) => number) => rows.reduce((all, [row, value]) => all + f(row, value), 0);
    const [a, b, c] = [0, 1, 2].map((k): V3 => [0, 1, 2].map((l) => sum((row) => row[k] * row[l])) as unknown as V3);
    const right = [0, 1, 2].map((k) => sum((row, value) => row[k] * value)) as unknown as V3;
    const whole = dot(a, cross(b, c));
    return {phi: dot(right, cross(b, c)) / whole, z: dot(a, cross(right, c)) / whole, b: (sign * dot(a, cross(b, right))) / whole};
  });
}

/** The torch comes as near to each place of a closed contour as the smoothing permits. */
function checkWay(scope: Scope, request: Body, machine: Body, counts: Counts, start: Numbers, periods: number): Way {
  const contour = request.contour as (Body & {outer_diameter_mm: number; wall_mm: number}) | undefined;
  if (!contour) return [];
  const outer = contour.outer_diameter_mm / 2;
  const R = contour.surface === 'inner' ? outer - contour.wall_mm : outer;
  const way = wayOf(machine, counts, start, periods, {outer, surface: R});
  const [phi, z] = [contour.phi_deg as number[] | undefined, contour.z_mm as number[] | undefined];
  if (!phi || !z || contour.closed !== true || !way.length) return way;
  const motion = request.motion as Numbers;
  const eps = (motion.eps_tip_mm ?? 0.1) + 0.15; // rounding of pulses and the sag of the contour's chords
  const sector = (motion as unknown as Body).sector;
  const off = (i: number) => way.reduce((least, at) => Math.min(least, Math.hypot(R * wrapped(at.phi - phi[i]) * RAD, at.z - z[i])), Infinity);
  if (!sector) scope.most('contour_is_cut', Math.max(...phi.map((_, i) => off(i))), eps, 'mm');
  return way;
}

/** A replay: the torch's way from the counts, and the invariants that follow from counts and machine alone. */
export function checkReplay(scope: Scope, request: Body, result: Body, machine: Body | undefined): void {
  const schedule = request.schedule as Body;
  const [counts, start] = [schedule.counts as unknown as Counts, schedule.start as unknown as Numbers];
  const invariants = new Map(list(result.invariants).map((row) => [String(row.name), row as unknown as {value: number; limit: number; passed: boolean}]));
  for (const [name, {value, limit, passed}] of invariants) scope.equal('invariant_passed', passed, value <= limit, name);
  if (invariants.has('I10')) scope.same('deviation', result.deviation_mm as number, invariants.get('I10')?.value ?? NaN, 1e-12, 'mm');
  if (!machine) {
    scope.not('', 'the machine is not given: see --machines');
    return;
  }
  const T = (schedule.period_us as number) * 1e-6;
  const periods = Math.max(0, ...Object.values(counts).map((column) => column.length));
  const jerk = (request.motion as Body).jerk !== false;
  const axes = machine.axes as unknown as Axis[];
  const used = axes.filter((axis) => counts[axis.name]);
  /** Of all axes the value that uses most of its limit. */
  const worst = (values: [number, number][]) => values.reduce((most, next) => (next[0] / next[1] > most[0] / most[1] ? next : most), [-Infinity, 1]);
  const fraction = Object.values(counts)
    .flat()
    .reduce((most, n) => Math.max(most, Math.abs(n - Math.round(n))), 0);
  const bound = (axis: Axis, n: number, limit: number, rounding: number): [number, number] => [n, limit * scale(axis) + rounding - 1e-6];
  const rest = (axis: Axis) => [...counts[axis.name], 0];
  const own: {[name: string]: [number, number?]} = {
    I1: [fraction, 0],
    I4: worst(used.filter((axis) => axis.n_max).map((axis) => [largest(counts[axis.name]), axis.n_max as number])),
    I5: worst(used.map((axis) => bound(axis, largest(counts[axis.name]), axis.v_max * T, 1))),
    I6: worst(used.map((axis) => bound(axis, largest(steps(rest(axis))), axis.a_max * T * T, 2))),
    I7: worst(
      used.filter((axis) => axis.j_max && jerk).map((axis) => bound(axis, largest(steps(steps([...rest(axis), 0]))), (axis.j_max as number) * T ** 3, 4)),
    ),
    I8: [Math.max(...axes.flatMap((axis) => beyond(axis, counts[axis.name] ?? [], start[axis.name]))), 0.51],
  };
  for (const [name, [value, limit]] of Object.entries(own)) {
    const stated = invariants.get(name);
    if (!stated) continue;
    scope.same('invariants', stated.value, value, 1e-6, '', name);
    if (limit !== undefined) scope.same('invariant_limits', stated.limit, limit, 2e-6, '', name);
  }
  scope.not('blind_spot', 'of errors that counts cannot show, by the smoothed path of the service');
  scope.not('invariants', 'the others are against the smoothed path of the service, which is in no answer');
  const stated = result.path as unknown as {[name: string]: number[]};
  const way = checkWay(scope, request, machine, counts, start, periods);
  if (!way.length && stated.z_mm.length) scope.not('path', 'the tube is not in the request');
  if (!way.length) return;
  scope.same('replay_periods', stated.phi_deg.length, way.length, 0, '');
  way.forEach(({phi, z, b}, i) => {
    const where = `period ${i}`;
    scope.same('replay_phi', stated.phi_deg[i], phi, 2e-9, 'deg', where);
    scope.same('replay_z', stated.z_mm[i], z, 5e-10, 'mm', where);
    scope.same('replay_b', stated.b_deg[i], b, 2e-9, 'deg', where);
  });
  scope.covers('path/phi_deg', 'path/z_mm', 'path/b_deg', 'deviation_mm');
}

/** How far an axis goes past either end of its travel, in pulses. */
function beyond(axis: Axis, n: number[], start: number): number[] {
  let [at, low, high] = [0, 0, 0];
  for (const v of n) {
    at += v;
    [low, high] = [Math.min(low, at), Math.max(high, at)];
  }
  const k = scale(axis);
  return [
    ...(typeof axis.soft_min === 'number' ? [(axis.soft_min - start) * k - low] : []),
    ...(typeof axis.soft_max === 'number' ? [(start - axis.soft_max) * k + high] : []),
  ];
}
