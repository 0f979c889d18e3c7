/** Pulse schedules: limits of every axis, sums, and the torch's way against a contour (docs/theory/pulse-schedules.md). */
import type {Scope} from './report.js';
import type {Body} from './solids.js';
import {RAD} from './space.js';

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

type Numbers = {[name: string]: number};
type Counts = {[name: string]: number[]};
const list = (v: unknown) => (v ?? []) as Body[];
const scale = (axis: Axis): number => axis.pulses_per_unit ?? (axis.pulses_per_turn as number) / 360;
const largest = (values: number[]): number => values.reduce((most, v) => Math.max(most, Math.abs(v)), 0);
const steps = (values: number[]): number[] => values.map((v, i) => v - (i > 0 ? (values[i - 1] as number) : 0));

export function checkSchedule(scope: Scope, request: Body, result: Body, machine: Body | undefined): void {
  const [counts, total, start, report] = [
    result['counts'] as unknown as Counts,
    result['total'] as Numbers,
    result['start'] as Numbers,
    result['report'] as Body,
  ];
  const period = (result['period_us'] as number) * 1e-6;
  const periods = result['periods'] as number;
  scope.same('schedule_time', report['time_s'] as number, periods * period, 1e-10 * (1 + periods * period), 's');
  scope.covers('periods', 'period_us', 'report/time_s');
  const peaks = report['peak'] as Numbers;
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
    scope.same('peak', peaks[name] as number, largest(n), 0, 'pulses', name);
    scope.most('whole_pulses', n.every(Number.isInteger) ? 0 : 1, 0, '', name);
    scope.same('schedule_periods', n.length, counts[name] ? periods : 0, 0, '', name);
    scope.covers(`counts/${name}`, `total/${name}`, `report/peak/${name}`);
  }
  checkTimes(scope, result, period);
  if (!machine) scope.not('', 'the machine is not given: see --machines');
  else {
    scope.same('schedule_period', result['period_us'] as number, machine['period_us'] as number, 0, 'us');
    const jerk = ((request['motion'] ?? {}) as Body)['jerk'] !== false;
    for (const axis of machine['axes'] as unknown as Axis[])
      checkAxis(scope, axis, counts[axis.name] ?? [], start[axis.name], period, jerk, report, !result['segments']); // of a part, uses are of its cuts only
  }
  for (const axis of list(((result['comparison'] as Body | undefined)?.['naive'] as Body | undefined)?.['axes'])) checkNaive(scope, axis);
  if (request['contour'] && machine?.['type'] === 'five_axis_cutter') checkWay(scope, request, machine, counts, start, periods);
}

/** Segments follow each other without gaps and take the times that are stated. */
function checkTimes(scope: Scope, result: Body, period: number): void {
  const [segments, times] = [list(result['segments']), result['times'] as Numbers | undefined];
  if (!times) return;
  const of = (kind: string) => segments.filter((s) => s['kind'] === kind).reduce((sum, s) => sum + ((s['to'] as number) - (s['from'] as number)) * period, 0);
  segments.forEach((segment, i) =>
    scope.same('segments_join', segment['from'] as number, i ? ((segments[i - 1] as Body)['to'] as number) : 0, 0, 'periods', i),
  );
  scope.same('segments_join', (segments[segments.length - 1] as Body)['to'] as number, result['periods'] as number, 0, 'periods');
  for (const kind of ['cut', 'pierce', 'rapid', 'mark']) {
    if (times[`${kind}_s`] !== undefined) scope.same('times', times[`${kind}_s`] as number, of(kind), 1e-9 * (1 + of(kind)), 's', kind);
    scope.covers(`times/${kind}_s`);
  }
  scope.same('times', times['total_s'] as number, (result['periods'] as number) * period, 1e-9 * (1 + (times['total_s'] as number)), 's');
  scope.covers('times/total_s', 'segments/*/from', 'segments/*/to');
}

/** Each difference of rounded positions is off by half a pulse for each term at most, so by 1, 2 and 4 pulses. */
function checkAxis(scope: Scope, axis: Axis, n: number[], start: number | undefined, T: number, jerk: boolean, report: Body, single: boolean): void {
  const k = scale(axis);
  const where = axis.name;
  const second = steps(n);
  if (axis.n_max) scope.most('pulses_per_period', largest(n), axis.n_max, 'pulses', where);
  scope.most('speed', largest(n), axis.v_max * k * T * (1 + 1e-6) + 1, 'pulses', where);
  scope.most('acceleration', largest([...second, n.length ? -(n[n.length - 1] as number) : 0]), axis.a_max * k * T * T * (1 + 1e-6) + 2, 'pulses', where);
  if (axis.j_max && jerk) scope.most('jerk', largest(steps(second)), axis.j_max * k * T ** 3 * (1 + 1e-6) + 4, 'pulses', where);
  if (start !== undefined) {
    let [at, low, high] = [0, 0, 0];
    for (const v of n) {
      at += v;
      [low, high] = [Math.min(low, at), Math.max(high, at)];
    }
    if (typeof axis.soft_min === 'number') scope.most('travel', (axis.soft_min - start) * k - low, 0.51, 'pulses', where);
    if (typeof axis.soft_max === 'number') scope.most('travel', (start - axis.soft_max) * k + high, 0.51, 'pulses', where);
  }
  const use = report['max_use'] as Numbers;
  const [v, ratio] = [use[`v_${axis.name}`], use[`n_${axis.name}`]];
  if (v !== undefined) {
    if (single) scope.same('use_of_speed', v * axis.v_max * k * T, largest(n), 1, 'pulses', where);
    if (ratio !== undefined && axis.n_max) scope.same('use_of_counter', ratio * axis.n_max, v * axis.v_max * k * T, 1e-6 * axis.n_max, 'pulses', where);
    scope.covers(`report/max_use/v_${axis.name}`, `report/max_use/n_${axis.name}`);
  }
  const closure = (report['closure'] as Numbers)[axis.name];
  if (closure !== undefined) scope.most('closure', Math.abs(closure), 1, 'pulses', where);
}

/** Figures of a contour at full speed: peak, and the largest step as a counter of 16 bits reads it. */
function checkNaive(scope: Scope, axis: Body): void {
  const where = String(axis['name']);
  const largest_ = axis['largest_step_pulses'] as number;
  scope.same('naive_peak', axis['peak_pulses'] as number, largest((axis['pulses'] ?? []) as number[]), 0.5 + 1e-9, 'pulses', where);
  scope.same('naive_16_bits', axis['step_in_16_bits'] as number, new Int16Array([largest_])[0] as number, 0, 'pulses', where);
  scope.covers('comparison/naive/axes/*/peak_pulses', 'comparison/naive/axes/*/step_in_16_bits', 'comparison/naive/axes/*/largest_step_pulses');
}

/** The beam is a line through the pivot: where it meets the contour's cylinder, it is on the contour for as long as it cuts. */
function checkWay(scope: Scope, request: Body, machine: Body, counts: Counts, start: Numbers, periods: number): void {
  const contour = request['contour'] as Body;
  const [phi, z] = [contour['phi_deg'] as number[] | undefined, contour['z_mm'] as number[] | undefined];
  if (!phi || !z || contour['closed'] !== true) return;
  const R = (contour['outer_diameter_mm'] as number) / 2 - (contour['surface'] === 'inner' ? (contour['wall_mm'] as number) : 0);
  const sign = machine['b_positive'] === 'outer_edge_into_part' ? 1 : -1;
  const axes = machine['axes'] as unknown as Axis[];
  const path = axes.map((axis) => {
    const at = [start[axis.name] as number];
    for (let i = 0; i < periods; i += 1) at.push((at[i] as number) + (counts[axis.name]?.[i] ?? 0) / scale(axis));
    return at;
  });
  const of = (name: string, i: number) => (path[axes.findIndex((axis) => axis.name === name)] as number[] | undefined)?.[i] ?? 0;
  const met = Array.from(
    {length: periods + 1},
    (_, i) => [of('C', i), of('Y', i) - (of('Z1', i) + of('Z2', i) - R) * Math.tan(of('B', i) * sign * RAD)] as const,
  );
  const eps = ((request['motion'] as Numbers)['eps_tip_mm'] ?? 0.1) + 0.15; // rounding of pulses and the sag of the contour's chords
  let worst = 0;
  phi.forEach((deg, i) => {
    let least = Infinity;
    for (const [turn, height] of met) {
      const aside = R * Math.atan2(Math.sin((turn - deg) * RAD), Math.cos((turn - deg) * RAD));
      least = Math.min(least, Math.hypot(aside, height - (z[i] as number)));
    }
    worst = Math.max(worst, least);
  });
  scope.most('contour_is_cut', worst, eps, 'mm');
}
