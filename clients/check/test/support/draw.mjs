// Requests of everyday sizes, drawn from a seed.
import {more} from './draw_more.mjs';
import {cutouts, rectangular, widthOf} from './draw_sections.mjs';

export function random(seed) {
  let state = seed >>> 0;
  const next = () => {  // mulberry32
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
  const between = (low, high) => low + (high - low) * next();
  const round = (value, digits = 2) => Number(value.toFixed(digits));
  return {
    next, between,
    number: (low, high, digits) => round(between(low, high), digits),
    whole: (low, high) => Math.floor(between(low, high + 1)),
    one: (list) => list[Math.floor(next() * list.length)],
    chance: (share) => next() < share,
  };
}

const groove = (r) => r.one([{rule: 'half_dihedral'}, {rule: 'half_dihedral', cap_deg: r.number(20, 45, 0)}, {rule: 'fixed', angle_deg: r.number(10, 45, 0)}, {rule: 'none'}]);
const smoothing = (r) => r.one([
  {method: 'none'},
  {method: 'envelope', limits: {max_slope_deg_per_mm: r.number(1, 5), max_curvature_deg_per_mm2: r.number(0.1, 1)}},
  {method: 'envelope', along: 'length', limits: {machine: 'five_axis_cutter', speed_mm_min: r.number(300, 1200, 0)}},
]);
const sampling = (r) => r.one([{tolerance_mm: r.number(0.02, 0.1)}, {uniform_points: r.whole(60, 200)}]);
const options = (r) => ({
  root_surface: 'inner', groove: groove(r), kerf_mm: r.one([0, 1.5, 2.4]), smoothing: smoothing(r), contact: r.one(['inner', 'inner', 'auto']),
  root_gap_mm: r.one([0, 0, 2]), torch: r.one([undefined, {min_deg: -60, max_deg: 60}]),
});
const target = (r) => ({outer_diameter_mm: r.number(40, 200, 1), wall_mm: r.number(3, 8, 1)});

function partner(r, width) {
  const axis = () => ({point_mm: [r.number(-width / 8, width / 8), 0, r.number(-20, 20)], direction: [r.number(-0.3, 0.3), 1, r.number(-0.6, 0.6)]});
  return r.one([
    () => ({kind: 'tube', outer_diameter_mm: r.number(width * 1.05, width * 3, 1), inclination_deg: r.number(35, 145, 1), clocking_deg: r.number(0, 360, 0), offset_mm: r.number(-width / 8, width / 8, 1), height_mm: r.number(-20, 20, 0)}),
    () => ({kind: 'tube', outer_diameter_mm: r.number(width * 1.3, width * 3, 1), axis: axis()}),
    () => ({kind: 'plane', point_mm: [0, 0, r.number(-20, 20)], normal: [r.number(-0.7, 0.7), r.number(-0.7, 0.7), 1]}),
    () => ({kind: 'cone', outer_diameter_mm: r.number(width * 1.6, width * 3, 1), half_angle_deg: r.number(-12, 12, 1), axis: axis()}),
    () => ({kind: 'rectangular_tube', width_mm: r.number(width * 1.3, width * 2, 0), height_mm: r.number(width, width * 2, 0), corner_radius_mm: r.number(4, 12, 0), axis: axis(), up: [0, 0, 1]}),
  ])();
}

const drawers = {
  intersections: (r) => {
    const tube = r.chance(0.4) ? rectangular(r) : target(r);
    return {target: tube, cutters: Array.from({length: r.whole(1, 3)}, () => partner(r, widthOf(tube))), sampling: sampling(r)};
  },
  'bevel-tables': (r) => {
    const tube = r.chance(0.4) ? rectangular(r) : target(r);
    const cutters = Array.from({length: r.whole(1, 3)}, () => partner(r, widthOf(tube)));
    if (r.chance(0.15)) return {preset: 'tube_laser', target: tube, cutters, sampling: sampling(r), kerf_mm: r.one([0, 0.2])};
    return {target: tube, cutters, sampling: sampling(r), ...options(r)};
  },
  holes: (r) => {
    const chord = r.number(90, 300, 1);
    const branch = r.number(30, chord * 0.75, 1);
    const kind = r.one(['set_on', 'set_in', 'through']);
    return {
      chord: {outer_diameter_mm: chord, wall_mm: r.number(4, 10, 1)},
      branch: {outer_diameter_mm: branch, wall_mm: r.number(2.5, Math.min(8, branch / 6), 1), inclination_deg: r.number(45, 135, 0), clocking_deg: r.number(0, 360, 0),
        offset_mm: r.number(-(chord - branch) / 8, (chord - branch) / 8, 1), height_mm: r.number(0, 500, 0)},
      joint: {kind, gap_mm: r.one([0, 1, 2])}, groove: r.one([{rule: 'half_dihedral'}, {rule: 'fixed', angle_deg: 30}, {rule: 'none'}, {rule: 'square'}]),
      tilt: r.one(['axial', 'free', 'free', 'none']), kerf_mm: r.one([0, 1.5]), sampling: r.one([{tolerance_mm: 0.05}, {uniform_points: 72}]),
    };
  },
  nodes: (r) => ({
    members: [
      {id: 'chord', start_mm: [-1500, 0, 0], end_mm: [1500, 0, 0], outer_diameter_mm: r.number(150, 260, 1), wall_mm: r.number(6, 12, 1)},
      ...Array.from({length: r.whole(1, 3)}, (_, i) => ({
        id: `brace ${i}`, start_mm: [r.number(-200, 200, 0), r.number(-20, 20, 0), 0], end_mm: [r.number(-1200, 1200, 0), r.number(-700, 700, 0), r.number(800, 1400, 0)],
        outer_diameter_mm: r.number(50, 120, 1), wall_mm: r.number(3, 6, 1), priority: i + 1,
        ...(r.chance(0.4) ? {up: [r.number(0.2, 1), r.number(-1, 1), 0]} : {}),
        ...(r.chance(0.5) ? {joints: [{member: 'chord', kind: 'set_on', gap_mm: r.number(0, 3, 1)}]} : {}),
      })),
    ],
    connect: {within_mm: 50}, include: ['profiles', 'tables'], sampling: {tolerance_mm: 0.05}, tables: options(r),
  }),
  ...more(target, options, {cutouts, rectangular, widthOf}),
};

export const endpoints = Object.keys(drawers);
const slow = ['mill-paths', 'frames']; // to check: once in eight rounds

/** {endpoint, request} without end, alternating between the endpoints. */
export function* requests(seed, of = endpoints) {
  const r = random(seed);
  for (let round = 0; ; round += 1)
    for (const endpoint of of) {
      if (slow.includes(endpoint) && round % 8 !== 4) continue;
      yield {endpoint, request: JSON.parse(JSON.stringify(drawers[endpoint](r)))};
    }
}
