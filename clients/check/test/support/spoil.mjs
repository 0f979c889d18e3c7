// Answers with one number wrong, sealed again: their hashes are right.
import {createHash} from 'node:crypto';

// How well the service states a number, by the end of its member's name, and who says so; the first that fits holds. A member without an entry has no stated accuracy.
const accuracies = [
  // docs/theory/intersections-and-bevels.md, 5.6, 5.7 and 7
  [/torch_line\/(gouge|left)_mm$/, (v) => Math.max(2e-3, 0.008 * v)],
  [/(gouge|left)_phi_deg$/, undefined],  // where of many places it is greatest
  [/penetration\/depth_mm$/, 3e-4],
  [/penetration\/(phi_deg|radius_mm|z_mm|cutter)$/, undefined],  // a place, found to within that depth
  [/events\/\*\/phi_deg$/, (1e-12 * 180) / Math.PI],
  [/events\/\*\/z_/, (_, {kind} = {}) => (kind === 'junction' ? 1e-10 : 1e-5)],
  [/fit_up\/(least_between_nodes|greatest_root_between_nodes)_mm$/, 1e-3],  // the check gap_stated
  [/smoothed_area\//, (v) => 1e-6 * (1 + v)],
  [/(^|\/)(cutter|from|to|index)(\/\*)?$/, 0.1],  // indices: another one
  [/^\/(counts|total|report\/peak)\/|^\/periods$/, 0.1],  // pulses and periods: another one
  // feed-curves.md, 7: golden grids within 1e-12; extremes by a search
  [/max_cylinder_(acceleration|jerk)|_error|ripple|drift|time_at_peak/, undefined],
  [/^\/(work|table|cycle|tool|geometry)\//, (v) => 1e-9 * (1 + Math.abs(v))],
  // grooves-and-milling.md
  [/^\/swept.*root_face/, undefined],  // the deepest of sampled places
  [/^\/swept/, 1e-6],  // the check swept
  [/certificate_mm/, 1e-8],
  [/standoff_growth|feed_at_peak|^\/report\/(?!time_s)/, undefined],
  [/^\/(height_(min|max)|least_area)|ellipse_a|_mm3$/, undefined],  // found on sections; as large as the sine is small
  [/_mm2(\/\*)?$/, 3e-7],
  [/twist_deg/, 1e-5],
  // pulse-schedules.md, 9: against the smoothed path
  [/^\/(invariants|blind_spot)/, undefined],
  // parts.md: 2.9e-12 mm of a part of some metres
  [/mass_kg|volume_mm3|groove_mm3/, undefined],
  [/members\/\*\/frame\/origin_mm|joints\/\*\/fit_up/, undefined],  // along its axis a part may stand anywhere within `alike_within_mm`
  [/^\/(lengths|check_dimensions|cut_list|totals|sequence|marks)/, 3e-9],
  [/turns$/, undefined],
  [/placement\/.*_mm$|cut_by\/\*\/(gap|eccentricity)_mm$/, 3e-9],  // 1e-12 of the lengths involved
  [/overlaps\//, undefined],  // climbed to by halved steps, from the deepest of 624 places
  [/missing_mm$/, undefined],
  [/length_mm$/, (v) => 1e-7 * (1 + Math.abs(v))],  // the checks of lengths
  [/(root_mm|face_mm|least_mm|gap_inner_mm|gap_outer_mm)$/, 1e-6],  // the checks fit_up and gap_map
  [/max_(slope|curvature)/, (v) => 1e-9 * v],
  [/_deg$/, 1e-9],
  [/_mm$/, 1e-10],
  [/\/(x|y|z)\/\*$/, 1e-12],
];

const accuracyOf = (pointer, value, parent) => {
  const found = accuracies.find(([pattern]) => pattern.test(pointer.replace(/\/\*$/, (end) => (/\/(x|y|z)\/\*$/.test(pointer) ? end : ''))));
  return typeof found?.[1] === 'function' ? found[1](value, parent) : found?.[1];
};

/** Every number of the result that has a stated accuracy, by pointer with `*` for any index: [holder, key] of each. */
export function numbers(result) {
  const found = new Map();
  const walk = (value, pointer, holder, key, parent) => {
    if (typeof value === 'number') {
      if (accuracyOf(pointer, value, parent) === undefined) return;
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
