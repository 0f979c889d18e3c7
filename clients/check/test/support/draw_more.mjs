// Requests of the endpoints whose answers are of whole parts, of machines and of grooves.
function contour(r) {
  const [tilt, lean, lift, turn] = [r.number(0, 15, 0), r.number(0, 20, 0), r.number(0, 15, 1), r.number(0, 360, 0)];
  const phi = Array.from({length: 72}, (_, i) => i * 5);
  const wave = (deg, k) => Math.cos(((k * deg + turn) * Math.PI) / 180);
  return {surface: r.one(['outer', 'inner']), outer_diameter_mm: r.number(40, 80, 1), wall_mm: 4, closed: true, scrap: '-z', b_sign: 'outer_edge_to_plus_z',
    phi_deg: phi, z_mm: phi.map((deg) => lift * wave(deg, 2)), b_deg: phi.map((deg) => lean + tilt * wave(deg, 1))};
}

const cut = (r) => ({
  contour: contour(r), machine: r.one(['five_axis_cutter', 'five_axis_cutter', 'crawler', 'generic']),
  motion: {speed: {mm_min: r.number(600, 1500, 0)}, ...(r.chance(0.5) ? {lead: {radius_mm: r.number(3, 6, 1)}} : {})},
});

const joint = (r) => {
  const branch = r.number(120, 240, 1);
  return {
    chord: {outer_diameter_mm: r.number(branch * 1.5, branch * 2.4, 1), wall_mm: 16}, branch: {outer_diameter_mm: branch, wall_mm: r.number(10, 16, 1)},
    root_face: {height_mm: 3, width_mm: 2}, inclination_deg: r.number(60, 90, 0), eccentricity_mm: r.number(-8, 8, 1), filler: {area_mm2: r.number(120, 260, 0)},
  };
};

export const more = (target, options, {cutouts, rectangular, widthOf}) => ({
  parts: (r) => {
    const section = r.chance(0.5);
    const tube = section ? rectangular(r) : target(r);
    const width = widthOf(tube);
    const length = r.number(800, 3000, 0);
    const partner = () => ({kind: 'tube', outer_diameter_mm: r.number(width * 1.05, width * 3, 1), inclination_deg: r.number(45, 135, 1), clocking_deg: r.number(0, 360, 0),
      offset_mm: r.number(-width / 8, width / 8, 1), height_mm: 0});
    const end = () => {
      const {kerf_mm, torch, root_surface, ...rest} = options(r);
      return {cutters: Array.from({length: r.whole(1, 2)}, partner), root_surface, ...rest};
    };
    const holes = section ? [] : Array.from({length: r.whole(0, 2)}, (_, i) => ({
      branch: {id: `branch ${i}`, outer_diameter_mm: r.number(15, width * 0.6, 1), wall_mm: 2, inclination_deg: r.number(60, 120, 0), clocking_deg: r.number(0, 360, 0),
        offset_mm: 0, height_mm: (length * (i + 1)) / 3},
      joint: {kind: r.one(['set_on', 'set_in']), gap_mm: 1}, groove: {rule: r.one(['half_dihedral', 'none'])},
    }));
    return {target: {...tube, length_mm: length}, ends: {start: end(), finish: end()}, ...(holes.length ? {holes} : r.chance(0.6) ? {cutouts: cutouts(r, tube, length)} : {}),
      sampling: {tolerance_mm: r.number(0.05, 0.2)}, kerf_mm: r.one([0, 1.5])};
  },
  'pulse-schedules': cut,
  replays: cut, // of the schedule that this request gives
  'feed-curves': (r) => ({
    linkage: {arm_mm: r.number(400, 460, 0), pivot_distance_mm: r.number(320, 350, 0), pivot_offset_mm: r.number(80, 100, 0), rest_angle_rad: 1.3, slot_angle_rad: r.number(1.66, 1.72, 3),
      ...r.one([{rad_per_mm: r.number(4e-4, 6e-4, 6)}, {calibrate: {feed_mm: 12, stroke_mm: r.number(60, 90, 1)}}])},
    cut: {start_feed_mm: r.number(5, 12), end_feed_mm: r.number(20, 28), feed_mm_s: r.number(0.5, 2)},
    fit: r.one([{method: 'minimax', degree: r.whole(2, 6)}, {method: 'auto', tolerance_ratio: 0.005}]), table: {points: r.whole(20, 100)},
    tool: {disc_rev_min: r.number(200, 400, 0), blades: r.whole(2, 6), corner_radius_mm: 0.4, kerf_mm: 4}, tube: {outer_diameter_mm: r.number(100, 200, 0), wall_mm: 8},
  }),
  grooves: (r) => ({...joint(r), sections: r.whole(12, 36), ...(r.chance(0.3) ? {compare: {rule: 'fixed', bevel_deg: r.number(30, 50, 0)}} : {})}),
  'mill-paths': (r) => ({
    groove: joint(r), mill: {half_angle_deg: r.number(12, 25, 0), tip_radius_mm: r.number(6, 20, 1), length_mm: r.number(60, 90, 0)},
    setup: {mount: r.one(['end_up', 'end_down']), pivot_length_mm: r.number(0, 200, 0), z_zero_mm: r.number(0, 400, 0), c_zero_deg: r.number(0, 360, 0),
      overrun_mm: r.one([0, 0, 1]), direction: r.one([1, 1, -1])},
    positions: r.whole(60, 90), optimise: {method: r.one(['chebyshev', 'chebyshev', 'none']), hold: r.one(['tip', 'tip', 'pivot'])},
    ...(r.chance(0.5) ? {probe: [58, 200].map((at) => ({omega_deg: at + r.number(0, 9, 1), ruling_deg: at + r.number(0, 9, 1), v: r.number(0, 1)}))} : {}),
  }),
  frames: (r) => ({
    defaults: {root_surface: 'inner', groove: {rule: 'half_dihedral'}, smoothing: {method: 'none'}}, kerf_mm: 1.5, sampling: {tolerance_mm: 0.1},
    joints: [{between: ['brace 1', 'chord'], kind: r.one(['set_on', 'set_in']), gap_mm: r.number(0, 2, 1)}],
    members: [
      {id: 'chord', start_mm: [-800, 0, 0], end_mm: [800, 0, 0], outer_diameter_mm: r.number(150, 220, 1), wall_mm: r.number(6, 10, 1), priority: 0},
      ...[1, -1].slice(0, r.whole(1, 2)).map((side) => ({
        id: `brace ${side}`, start_mm: [side * r.number(120, 200, 0), 0, 0], end_mm: [side * r.number(400, 900, 0), r.number(-100, 100, 0), 700],
        outer_diameter_mm: r.number(50, 90, 1), wall_mm: r.number(3, 5, 1), priority: 1,
      })),
    ],
  }),
});
