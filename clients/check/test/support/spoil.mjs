// Answers with one number wrong, sealed again: their hashes are right.
import {createHash} from 'node:crypto';

// How well the service states a number, by its pointer: the first that fits holds. Who states it: docs/theory, openapi.yaml, or a check of the answer itself
// by its bound. A text instead of an accuracy is the row of docs/checker.md that says why there is none; a number that nothing fits is an error.
const share = (of) => (v) => of * (1 + Math.abs(v));
const pathInvariants = 'invariants: I2, I3, I9 to I16';
const another = 0.1; // of indices and counts: another one
const accuracies = [
  // intersections-and-bevels.md, 5.6, 5.7 and 7; penetration_stated, gouge_stated, left_stated, hole_gap_stated, area_excess
  [/torch_line\/(gouge|left)_mm$/, (v) => Math.max(2e-3, 0.008 * v)],
  [/(gouge|left)_(phi_deg|girth_mm)$/, 'torch_line: gouge_phi_deg, left_phi_deg, gouge_girth_mm'],
  [/penetration\/depth_mm$/, 3e-4],
  [/penetration\/(phi_deg|radius_mm|girth_mm|below_outside_mm|z_mm|cutter)$/, 'penetration: phi_deg, radius_mm, girth_mm, below_outside_mm, z_mm, cutter'],
  [/(mutations\/\*|tube_laser\/.*)\/girth_mm$/, 1e-9],
  // cutouts.md: `bored_points`, `developed_points`, `prism_points`, `areas`, `volumes`, `webs`
  [/^\/cutouts\/\*\/points\/(torch_|[ab]_deg)/, 'cutouts: points/torch_*, a_deg, b_deg'],
  [/^\/cutout_report\/net_section\//, 'cutout_report: net_section'],
  [/^\/cutout_report\/.*\/(from|to)\/|^\/cutout_report\/.*radius_mm$/, 'cutout_report: from, to, radius_mm'],
  [/^\/section\/|^\/cutouts\/.*\/area_/, (v) => 1e-9 * (1 + v)],
  [/events\/\*\/phi_deg$/, (1e-12 * 180) / Math.PI],
  [/events\/\*\/z_/, (_, {kind} = {}) => (kind === 'junction' ? 1e-10 : 1e-5)],
  [/fit_up\/(least_between_nodes|greatest_root_between_nodes)_mm$/, 1e-3],
  [/smoothed_area\//, share(1e-6)],
  [/(^|\/)(cutter|from|to|index|face)(\/\*)?$|turns$/, another],
  [/overlaps\//, 'overlaps'],
  [/missing_mm$/, 'missing_mm'],
  [/events\/\*\/period$/, 'events: period'],
  [/^\/(counts|total|report\/peak)\/|^\/(periods|period_us)$|^\/fit\/(degree|digits)$/, another],
  // Feed curves: work_acceleration, fit_speed_error, fit_rounded, fit_tool_ripple, fit_tool_position, fit_end_drift, fit_forms
  [/max_cylinder_(acceleration|jerk)/, (v) => 1e-3 * v],
  [/_error|_ripple/, (v) => 2e-3 * v],
  [/drift_mm$/, 1e-9],
  [/(time|feed)_at_peak/, 'time_at_peak_s, feed_at_peak_mm'],
  [/seconds_rounded\/\*$/, (v, {digits}) => 10 ** (Math.floor(Math.log10(Math.abs(v))) + 1 - digits)], // feed-curves.md, 8
  [/^\/(work|table|cycle|tool|geometry|fit)\//, share(1e-9)],
  // Grooves: heights, least_area, filler_volume, twist, filler_area
  [/^\/height_(min|max)_mm|^\/least_area_mm2/, (v) => 1e-9 * v],
  [/filler_volume_mm3$/, (v) => 2e-5 * v],
  [/ellipse_a_mm/, share(1e-9)],
  [/_mm2(\/\*)?$/, 3e-7],
  [/twist_deg/, 1e-5],
  // Mill paths: swept, root_face, certificate, probe
  [/^\/swept/, 1e-6],
  [/certificate_mm/, 1e-8],
  [/evaluations/, 'positions: evaluations'],
  [/^\/probe\/.*\/v$/, 1e-10],
  // Schedules and replays: pulses are whole, the bound of a difference is stated to 1e-6 pulses
  [/^\/report\/max_use\/[vn]_/, 'report/max_use: v_*, n_*'],
  [/^\/report\/max_use\//, 'report/max_use: a_*, j_*'],
  [/^\/report\/time_s$/, share(1e-9)],
  [/^\/report\/closure|closing_residual/, 'report: closure, closing_residual_pulses'],
  [/^\/start\//, 'start'],
  [/^\/report\//, 'report: other members'],
  [/^\/invariants/, (_, {name}) => (/^I[145678]$/.test(name) ? 1e-6 : pathInvariants)],
  [/^\/blind_spot/, 'blind_spot'],
  // Parts and frames: volume, placed, check_dimensions, joint_in_world; parts.md, 7
  [/mass_kg|volume_mm3/, (v) => 1e-9 * v],
  [/groove_mm3/, 'groove_mm3'],
  [/^\/joints\/.*fit_up/, 1e-5],
  [/differs_at_most_mm/, 'cut_list: differs_at_most_mm'],
  [/members\/\*\/frame\/origin_mm/, 0.02], // `alike_within_mm`
  [/^\/(lengths|check_dimensions|cut_list|totals|sequence|marks)/, 3e-9],
  [/placement\/.*_mm$|cut_by\/\*\/(gap|eccentricity)_mm$/, 3e-9], // 1e-12 of the lengths involved
  [/(length|weld)_mm$/, share(1e-7)], // the checks of lengths
  [/^\/ends\/(start|finish)\/points\/(z_|torch_|gap_mm)/, 1e-9], // placed, in the part's frame
  [/(root_mm|face_mm|least_mm|gap_inner_mm|gap_outer_mm)$/, 1e-6], // fit_up, gap_map
  [/max_(slope|curvature)/, (v) => 1e-9 * v],
  [/_deg$/, 1e-9],
  [/_mm$/, 1e-10],
  [/\/(x|y|z|normal)\/\*$/, 1e-12],
];

function accuracyOf(pointer, value, parent) {
  const plain = /\/(x|y|z|normal|seconds_rounded)\/\*$/.test(pointer) ? pointer : pointer.replace(/\/\*$/, '');
  const found = accuracies.find(([pattern]) => pattern.test(plain));
  if (!found) throw new Error(`no accuracy is stated of ${pointer}: spoil.mjs and docs/checker.md must say why`);
  return typeof found[1] === 'function' ? found[1](value, parent) : found[1];
}

/** The rows of docs/checker.md: members without a stated accuracy. */
export const unstated = [...accuracies.map(([, accuracy]) => accuracy).filter((accuracy) => typeof accuracy === 'string'), pathInvariants];

/** Every number of the result that has a stated accuracy, by pointer with `*` for any index: [holder, key] of each. */
export function numbers(result) {
  const found = new Map();
  const walk = (value, pointer, holder, key, parent) => {
    if (typeof value === 'number') {
      if (typeof accuracyOf(pointer, value, parent) === 'string') return;
      found.set(pointer, [...(found.get(pointer) ?? []), [holder, key, parent]]);
    } else if (Array.isArray(value)) value.forEach((item, i) => walk(item, `${pointer}/*`, value, i, parent));
    else if (value && typeof value === 'object') for (const [name, item] of Object.entries(value)) walk(item, `${pointer}/${name}`, value, name, value);
  };
  walk(result, '');
  return found;
}

const sha256 = (value) => createHash('sha256').update(JSON.stringify(value)).digest('hex');

/** Hashes of an answer as they must be for what it holds. */
export function seal(answer) {
  for (const part of answer.parts ?? []) {
    if (!part.answer) continue;
    seal(part.answer);
    answer.result.cut_list.find((row) => row.part === part.part).result_sha256 = part.answer.job.result_sha256;
  }
  const {reference, log, ...request} = answer.request;
  answer.job.input_sha256 = sha256(request);
  answer.job.result_sha256 = sha256(answer.result);
  return answer;
}

/** One number of a copy of the answer, off by ten times its accuracy either way: {pointer, text}. Members are drawn alike, however many numbers they hold. */
export function spoil(answer, r) {
  const copy = structuredClone(answer);
  const all = numbers(copy.result);
  const pointer = r.one([...all.keys()]);
  const [holder, key, parent] = r.one(all.get(pointer));
  const from = holder[key];
  holder[key] = from + r.one([-1, 1]) * 10 * accuracyOf(pointer, from, parent);
  return {pointer, from, to: holder[key], text: JSON.stringify(seal(copy))};
}
