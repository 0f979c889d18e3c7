/** Feed curves of a cut-off machine, from the linkage's triangle (docs/theory/feed-curves.md). */
import type {Scope} from './report.js';
import type {Body} from './solids.js';
import {highest} from './space.js';

type Numbers = {[name: string]: number};

interface Linkage {
  arm: number;
  distance: number;
  offset: number;
  gamma: number;
  rest: number;
  alpha: number;
  k: number;
}

const num = (v: unknown, otherwise = 0): number => (typeof v === 'number' ? v : otherwise);

function linkageOf(request: Body, k: number): Linkage {
  const l = request.linkage as Numbers;
  const [distance, offset] = [l.pivot_distance_mm, l.pivot_offset_mm];
  return {
    arm: l.arm_mm,
    distance,
    offset,
    gamma: Math.acos(offset / distance),
    rest: l.rest_angle_rad ?? (num(l.rest_angle_deg) * Math.PI) / 180,
    alpha: l.slot_angle_rad ?? (num(l.slot_angle_deg) * Math.PI) / 180,
    k,
  };
}

/** Direction of the slot from the arm's pin, when the arm stands at theta: from the pin towards the plate's pivot. */
function slot(l: Linkage, theta: number): number {
  const [px, py] = [l.arm * Math.cos(theta), l.arm * Math.sin(theta)];
  const [qx, qy] = [l.distance * Math.cos(l.gamma), l.distance * Math.sin(l.gamma)];
  return Math.atan2(py - qy, px - qx);
}

/** The feed at a stroke: the tangent of the slot plate's lean over the pivot's offset. */
export function feedAt(l: Linkage, y: number): number {
  const lean = (theta: number) => Math.PI - l.alpha - slot(l, theta);
  return l.offset * (Math.tan(lean(l.rest)) - Math.tan(lean(l.rest + l.k * y)));
}

/** The stroke at a feed: the plate's direction, then the pin's place on the arm's circle by the law of sines. */
function strokeAt(l: Linkage, x: number): number {
  const lean = Math.atan(Math.tan(Math.PI - l.alpha - slot(l, l.rest)) - x / l.offset);
  const beta = Math.PI - l.alpha - lean;
  return (beta + Math.asin((l.distance / l.arm) * Math.sin(l.gamma - beta)) - l.rest) / l.k;
}

/** The first two rates of the stroke by the feed, from the same two steps in turn. */
function rates(l: Linkage, x: number): [number, number] {
  const t = Math.tan(Math.PI - l.alpha - slot(l, l.rest)) - x / l.offset;
  const beta = Math.PI - l.alpha - Math.atan(t);
  const [b1, b2] = [1 / (l.offset * (1 + t * t)), (2 * t) / (l.offset ** 2 * (1 + t * t) ** 2)];
  const rho = l.distance / l.arm;
  const [s, c] = [rho * Math.sin(l.gamma - beta), rho * Math.cos(l.gamma - beta)];
  const w = Math.sqrt(1 - s * s);
  const [q1, q2] = [1 - c / w, -s / w + (c * c * s) / w ** 3]; // of beta + asin(s), where s' = -c and c' = s
  return [(q1 * b1) / l.k, (q2 * b1 ** 2 + q1 * b2) / l.k];
}

/** The third, by a central difference of the second. */
const third = (l: Linkage, x: number): number => (rates(l, x + 1e-3)[1] - rates(l, x - 1e-3)[1]) / 2e-3;

export function checkFeed(scope: Scope, request: Body, result: Body): void {
  const [geometry, work, table] = [result.geometry as Numbers, result.work as Numbers, result.table as unknown as {[name: string]: number[]}];
  const given = request.linkage as Body;
  const l = linkageOf(request, geometry.rad_per_mm);
  const at = (name: string) => work[name];
  if (typeof given.rad_per_mm === 'number') scope.same('linkage', geometry.rad_per_mm, given.rad_per_mm, 1e-15, '');
  else {
    const pair = given.calibrate as Numbers;
    scope.same('calibration', feedAt(l, pair.stroke_mm), pair.feed_mm, 1e-9 * (1 + Math.abs(pair.feed_mm)), 'mm');
  }
  const v = at('feed_mm_s');
  const cut = request.cut as Numbers;
  const start = cut.start_feed_mm ?? num(cut.clearance_mm) - num(cut.slowdown_mm);
  const end = cut.end_feed_mm ?? num(cut.clearance_mm) + num(cut.wall_mm) + num(cut.overcut_mm);
  const fine = 1e-10 * (1 + Math.abs(start) + Math.abs(end));
  scope.same('work_feed', at('start_feed_mm'), start, fine, 'mm');
  scope.same('work_feed', at('end_feed_mm'), end, fine, 'mm');
  scope.same('work_feed', v, cut.feed_mm_s, fine, 'mm/s');
  scope.same('work_time', at('duration_s') * v, end - start, fine, 'mm');
  for (const side of ['start', 'end'])
    scope.same('work_stroke', at(`${side}_stroke_mm`), strokeAt(l, at(`${side}_feed_mm`)), 1e-9 * (1 + Math.abs(at(`${side}_stroke_mm`))), 'mm');
  const extreme = (f: (x: number) => number) => highest(f, start, end, 400);
  const speed = (x: number) => v * rates(l, x)[0];
  const [peak, fastest] = extreme(speed);
  scope.same('work_speed', at('max_cylinder_speed_mm_s') / fastest, 1, 1e-9, '');
  scope.same('work_speed', at('min_cylinder_speed_mm_s') / -extreme((x) => -speed(x))[1], 1, 1e-9, '');
  scope.same('work_acceleration', at('max_cylinder_acceleration_mm_s2') / extreme((x) => Math.abs(v * v * rates(l, x)[1]))[1], 1, 1e-3, '');
  scope.same('work_jerk', at('max_cylinder_jerk_mm_s3') / extreme((x) => Math.abs(v ** 3 * third(l, x)))[1], 1, 1e-3, '');
  if (work.time_at_peak_s !== undefined) scope.same('work_peak', start + v * work.time_at_peak_s, peak, 1e-5 * (end - start), 'mm');
  scope.covers('geometry/rad_per_mm', ...Object.keys(work).map((name) => `work/${name}`));
  table.t_s.forEach((t, i) => {
    const [x, where] = [start + v * t, `row ${i}`];
    const [g1, g2] = rates(l, x);
    const row = (name: string) => table[name][i];
    scope.same('table_feed', row('feed_mm'), x, 1e-10 * (1 + Math.abs(x)), 'mm', where);
    scope.same('table_stroke', row('stroke_mm'), strokeAt(l, x), 1e-10 * (1 + Math.abs(row('stroke_mm'))), 'mm', where);
    scope.same('table_inverse', feedAt(l, row('stroke_mm')), x, 1e-10 * (1 + Math.abs(x) + l.offset), 'mm', where);
    scope.same('table_speed', row('cylinder_speed_mm_s'), v * g1, 1e-10 * (1 + Math.abs(v * g1)), 'mm/s', where);
    scope.same('table_acceleration', row('cylinder_acceleration_mm_s2'), v * v * g2, 1e-10 * (1 + Math.abs(v * v * g2)), 'mm/s2', where);
  });
  scope.covers(...Object.keys(table).map((name) => `table/${name}`));
  const fitted = (name: string, fit: Body) => checkFit(scope.under(name), fit, (t) => speed(start + v * t), l, start, v, (end - start) / v);
  fitted('fit', result.fit as Body);
  for (const fit of (result.comparison ?? []) as Body[]) fitted('comparison/*', fit);
  checkGeometry(scope, l, geometry);
  if (result.cycle) checkCycle(scope.under('cycle'), request, work, result.cycle as Numbers, l);
  if (result.tool) checkTool(scope.under('tool'), request, result.tool as Numbers, v, num((result.fit as Numbers).tool_ripple));
}

/** The plate's elevation at rest and its height on the rod; the strokes at which its tangent has its poles. */
function checkGeometry(scope: Scope, l: Linkage, geometry: Numbers): void {
  const lean = Math.PI - l.alpha - slot(l, l.rest);
  const rest = Math.atan(Math.tan(lean));
  scope.same('linkage', geometry.slot_elevation_deg * (Math.PI / 180), rest, 1e-11, 'rad');
  scope.same('linkage', geometry.rod_height_mm, l.offset * Math.tan(rest), 1e-11 * l.offset * (1 + Math.tan(rest) ** 2), 'mm');
  scope.covers('geometry/slot_elevation_deg', 'geometry/rod_height_mm');
  if (l.arm <= l.distance) return; // the range ends where the slot is tangent to the arm's circle
  for (const [name, pole] of [
    ['stroke_low_mm', 1],
    ['stroke_high_mm', -1],
  ] as const) {
    const beta = Math.PI - l.alpha - (pole * Math.PI) / 2;
    const own = (beta + Math.asin((l.distance / l.arm) * Math.sin(l.gamma - beta)) - l.rest) / l.k;
    scope.same('stroke_limits', geometry[name], own, 1e-9 * (1 + Math.abs(own)), 'mm', name);
    scope.covers(`geometry/${name}`);
  }
  const peak = geometry.feed_at_peak_mm;
  if (peak === undefined) return;
  const speed = (x: number) => rates(l, x)[0];
  scope.same('peak_feed', rates(l, peak)[1] / (speed(peak) / l.offset), 0, 1e-8, '');
  scope.covers('geometry/feed_at_peak_mm');
}

/** Times and places of a cycle that follow from each other and from the linkage. */
function checkCycle(scope: Scope, request: Body, work: Numbers, cycle: Numbers, l: Linkage): void {
  const asked = request.cycle as Numbers;
  const at = (name: string) => cycle[name];
  const same = (name: string, own: number, fine = 1e-10) => {
    scope.same('cycle', at(name), own, fine * (1 + Math.abs(own)), '', name);
    scope.covers(name);
  };
  const v = work.feed_mm_s;
  same('work_end_s', at('work_start_s') + work.duration_s);
  scope.covers('work_start_s');
  same('cycle_s', at('end_s') + num(asked.handling_s));
  scope.covers('end_s');
  same('pieces_per_hour', 3600 / at('cycle_s'));
  same('stop_feed_mm', feedAt(l, at('stop_stroke_mm')));
  scope.covers('stop_stroke_mm');
  same('overshoot_mm', at('stop_feed_mm') - work.end_feed_mm);
  for (const [side, x] of [
    ['in', work.start_feed_mm],
    ['out', work.end_feed_mm],
  ] as const) {
    same(`speed_${side}_mm_s`, v * rates(l, x)[0], 1e-9);
    same(`acceleration_step_${side}_mm_s2`, Math.abs(v * v * rates(l, x)[1]), 1e-9);
  }
  for (const way of ['approach', 'return']) scope.most('cycle_speed', at(`${way}_peak_mm_s`), asked.max_cylinder_speed_mm_s * (1 + 1e-9), 'mm/s');
  const target = asked.target_per_hour;
  if (target && cycle.estimated_feed_mm_s !== undefined) {
    const left = 3600 / target - (at('cycle_s') - work.duration_s);
    same('estimated_feed_mm_s', (work.end_feed_mm - work.start_feed_mm) / left, 1e-9);
  }
}

/** A polynomial's three forms are one, and its errors are what they are stated to be. */
function checkFit(scope: Scope, fit: Body, speed: (t: number) => number, l: Linkage, start: number, v: number, duration: number): void {
  const T = fit.duration_s as number;
  const [chebyshev, scaled, seconds, rounded] = ['chebyshev', 'scaled', 'seconds', 'seconds_rounded'].map((name) => fit[name] as number[]) as [
    number[],
    number[],
    number[],
    number[],
  ];
  const power = (list: number[], x: number) => list.reduceRight((sum, c) => sum * x + c, 0);
  const series = (u: number) => chebyshev.reduce((sum, c, n) => sum + c * Math.cos(n * Math.acos(Math.min(1, Math.max(-1, u)))), 0);
  const size = Math.abs(chebyshev[0]);
  scope.same('fit_duration', T, duration, 1e-10 * (1 + duration), 's');
  // As many places as coefficients, one more: any coefficient that is off shows at one of them.
  for (let i = 0; i <= chebyshev.length; i += 1) {
    const t = (T * i) / chebyshev.length;
    const u = (2 * t) / T - 1;
    scope.same('fit_forms', power(scaled, u), series(u), 1e-11 * size, 'mm/s', `t ${t}`);
    scope.same('fit_forms', power(seconds, t), series(u), 1e-11 * size, 'mm/s', `t ${t}`);
  }
  scope.equal('fit_degree', [scaled.length, seconds.length, rounded.length, chebyshev.length], Array(4).fill((fit.degree as number) + 1));
  const digits = fit.digits as number;
  const significant = (c: number) => c.toExponential().split('e')[0].replace(/[-.]/g, '').length;
  scope.most('fit_digits', Math.max(...rounded.map(significant)), digits, 'digits');
  rounded.forEach((c, i) =>
    scope.same('fit_rounded', c, Number(seconds[i].toPrecision(digits)), Math.abs(c) * 10 ** -Math.min(digits, 14) * 3.1 + 1e-300, '', i),
  );
  const worst = (f: (t: number) => number) => highest((t) => Math.abs(f(t)), 0, T, 600)[1];
  const off = (p: (t: number) => number) => (t: number) => p(t) / speed(t) - 1;
  const near = (name: string, own: number, share: number, least: number) => scope.same(name, fit[name] as number, own, share * own + least, '');
  near('max_relative_error', worst(off((t) => power(seconds, t))), 2e-3, 1e-12);
  near('rounded_max_relative_error', worst(off((t) => power(rounded, t))), 2e-3, 1e-12);
  const y0 = strokeAt(l, start);
  const stroke = (t: number) => y0 + seconds.reduce((sum, c, n) => sum + (c * t ** (n + 1)) / (n + 1), 0);
  const feed = (t: number) => feedAt(l, stroke(t));
  near(
    'tool_position_error_mm',
    worst((t) => feed(t) - start - v * t),
    2e-3,
    1e-9,
  );
  near(
    'tool_ripple',
    worst((t) => power(seconds, t) / rates(l, feed(t))[0] / v - 1),
    2e-3,
    1e-9,
  );
  scope.same('fit_end_drift', fit.end_drift_mm as number, feed(T) - start - v * T, 1e-10 * (1 + v * T), 'mm');
  scope.same('fit_end_drift', fit.cylinder_end_drift_mm as number, stroke(T) - strokeAt(l, start + v * T), 1e-10 * (1 + v * T), 'mm');
  scope.covers('chebyshev', 'scaled', 'seconds', 'seconds_rounded', 'duration_s', 'degree', 'digits');
  scope.covers('max_relative_error', 'rounded_max_relative_error', 'tool_position_error_mm', 'tool_ripple', 'end_drift_mm', 'cylinder_end_drift_mm');
}

function checkTool(scope: Scope, request: Body, found: Numbers, v: number, ripple: number): void {
  const [tool, tube, cut] = [request.tool as Numbers, request.tube as Numbers | undefined, request.cut as Numbers];
  const [n, blades, r, kerf] = ['disc_rev_min', 'blades', 'corner_radius_mm', 'kerf_mm'].map((name) => tool[name]) as [number, number, number, number];
  const turn = (60 * v) / n;
  const expected: {[name: string]: number | undefined} = {
    feed_per_revolution_mm: turn,
    feed_per_blade_mm: turn / blades,
    feed_per_blade_low_mm: (turn / blades) * (1 - ripple),
    feed_per_blade_high_mm: (turn / blades) * (1 + ripple),
    roughness_um: (1000 * (turn / blades) ** 2) / (8 * r),
    roughness_one_blade_um: (1000 * turn ** 2) / (8 * r),
  };
  const [D, t] = [tube?.outer_diameter_mm, tube?.wall_mm ?? cut.wall_mm];
  if (D !== undefined && t !== undefined) {
    const area = Math.PI * t * (D - t);
    Object.assign(expected, {
      cutting_speed_outside_m_min: (Math.PI * D * n) / 1000,
      cutting_speed_bore_m_min: (Math.PI * (D - 2 * t) * n) / 1000,
      revolutions_through_wall: t / turn,
      through_wall_s: t / v,
      chip_rate_mm3_s: Math.PI * D * kerf * v,
      chip_volume_mm3: area * kerf,
    });
  }
  for (const [name, value] of Object.entries(found)) {
    const own = expected[name];
    if (own === undefined) continue;
    scope.same('tool', value / own, 1, 1e-11, '', name);
    scope.covers(name);
  }
}
