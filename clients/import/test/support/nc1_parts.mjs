// Drawn parts of POST /v1/parts whose NC1 a reader must turn into the same part again: round and
// rectangular, ends square or cut by a plane, cut-outs of every shape and wall.
import {between, pick, random} from './random.mjs';

const round3 = (v) => Math.round(v * 1000) / 1000;

function shapeOf(next, size) {
  const turned = next() < 0.5 ? {angle_deg: round3(between(next, -180, 180))} : {};
  const [a, b] = [round3(0.4 * size), round3(0.25 * size)];
  return pick(next, [
    () => ({kind: 'circle', diameter_mm: round3(size)}),
    () => ({kind: 'slot', length_mm: round3(size), width_mm: round3(0.4 * size), ...turned}),
    () => ({kind: 'rectangle', along_mm: round3(0.8 * size), round_mm: round3(0.55 * size), corner_radius_mm: round3(0.12 * size), ...turned}),
    () => ({kind: 'rectangle', along_mm: round3(0.5 * size), round_mm: round3(0.8 * size), corner_radius_mm: 0, corners: 'as_cut', ...turned}),
    // A door with a round side.
    () => ({kind: 'contour', corners: 'as_cut', start_mm: [-a, -b], pieces: [{kind: 'line', to_mm: [a, -b]},
      {kind: 'arc', to_mm: [a, b], centre_mm: [a, 0], sense: 'ccw'}, {kind: 'line', to_mm: [-a, b]}, {kind: 'line', to_mm: [round3(-1.2 * a), round3(0.1 * b)]}, {kind: 'line', to_mm: [-a, -b]}],
    ...turned, ...(next() < 0.5 ? {mirrored: true} : {})}),
  ])();
}

const grooves = [
  {groove: {rule: 'none'}, root_surface: 'inner'},
  {groove: {rule: 'square'}, root_surface: 'inner', contact: 'auto'},
  {groove: {rule: 'half_dihedral', cap_deg: 40}, root_surface: 'inner', root_gap_mm: 1.5, coating_mm: 0.1},
  {groove: {rule: 'fixed', angle_deg: 30}, root_surface: 'inner', root_face_mm: 0.5},
  {groove: {rule: 'none'}, root_surface: 'outer', contact: 'outer'},
];

function endOf(next, flush) {
  if (next() < 0.4) return {square_at_mm: pick(next, [0, 0, round3(between(next, -20, 20))])};
  const [slope, side] = [between(next, 0.05, 0.7), between(next, 0, 2 * Math.PI)];
  const normal = [slope * Math.cos(side), slope * Math.sin(side), 1].map(round3);
  const cutter = {kind: 'plane', id: 'cut', point_mm: [round3(between(next, -10, 10)), 0, round3(between(next, -15, 15))], normal};
  return {cutters: [cutter], smoothing: {method: 'none'}, ...(flush ? grooves[0] : pick(next, grooves)), ...(next() < 0.2 ? {kerf_mm: 1} : {})};
}

function roundTarget(next) {
  const outer_diameter_mm = round3(between(next, 40, 250));
  return {outer_diameter_mm, wall_mm: round3(between(next, 2, Math.min(10, 0.1 * outer_diameter_mm)))};
}

function rectangularTarget(next) {
  const [height_mm, width_mm] = [round3(between(next, 40, 200)), round3(between(next, 40, 200))];
  const wall_mm = round3(between(next, 2, 6));
  const corners = pick(next, [{corners: 'en_10219'}, {corners: 'en_10210'}, {corners: 'astm_a500'}, {corner_radius_mm: round3(2.2 * wall_mm)},
    {corner_radius_mm: round3(2 * wall_mm), inner_corner_radius_mm: round3(1.1 * wall_mm)}]);
  return {kind: 'rectangular_tube', height_mm, width_mm, wall_mm, ...corners};
}

/** Case `number` of a seed. `plain`: only of features that the blocks state without comments, ends square or flush, walls square to the tube. */
export function drawnPart(seed, number, plain = false) {
  const next = random(seed * 7919 + number);
  const isRound = next() < 0.5;
  const target = isRound ? roundTarget(next) : rectangularTarget(next);
  const across = isRound ? target.outer_diameter_mm : Math.min(target.height_mm, target.width_mm) - 2 * 3.2 * target.wall_mm;
  const most = Math.min(60, 0.45 * across);
  const count = most < 5 ? 0 : Math.floor(5 * next());
  const clear = 1.5 * (isRound ? target.outer_diameter_mm : Math.max(target.height_mm, target.width_mm)) + 80;
  const kerf_mm = pick(next, [0, 0.3, 1.5]);
  const cutouts = Array.from({length: count}, (_, i) => {
    const size = between(next, Math.min(8, most), most);
    const face = 1 + Math.floor(4 * next());
    const at = {z_mm: round3(clear + 200 * i), ...(next() < 0.3 ? {z_zero: 'long_point'} : {}),
      ...(isRound ? pick(next, [{phi_deg: round3(between(next, -360, 360))}, {girth_mm: round3(between(next, 0, 400))}]) : {face, offset_mm: round3(between(next, -0.15, 0.15) * across)}),
      ...(next() < 0.2 ? {opposite: true} : {})};
    const wall = pick(next, ['normal', 'developed', 'through']);
    const tilt = isRound && !plain && wall !== 'developed' && next() < 0.3 ? {tilt: 'free'} : {};
    const turned = isRound ? {} : {angle_deg: round3(between(next, -180, 180))};
    const slit = !plain && kerf_mm > 0 && next() < 0.25;
    const shape = slit ? {kind: 'slit', length_mm: round3(size), ...turned, ...(next() < 0.5 ? {pierce: 'end'} : {})} : shapeOf(next, size);
    const sunk = !plain && shape.kind === 'circle' && wall !== 'developed';
    const countersink = sunk ? {countersink: {diameter_mm: round3(1.3 * size + 1), angle_deg: pick(next, [60, 90])}} : {};
    const pattern = next() < 0.3 ? {pattern: {kind: 'linear', count: 2, pitch_mm: round3(between(next, 80, 110))}} : {};
    return {id: `${pick(next, ['bolt', 'slot far', 'door, big', 'Stütze'])} ${i}`, shape, at, wall, ...tilt, ...pattern, ...countersink};
  });
  const flush = plain && isRound;
  const end = () => (plain && !isRound ? {square_at_mm: round3(between(next, -20, 20))} : endOf(next, flush));
  const finish = next() < 0.3 && cutouts.length > 0 ? cutouts[cutouts.length - 1] : undefined;
  if (finish) Object.assign(finish.at, {from: 'finish', z_mm: round3(clear)});
  return {
    target: {id: `P${number}`, ...target, length_mm: round3(2 * clear + 200 * Math.max(count, 1) + between(next, 100, 300))},
    ends: {start: end(), finish: end()},
    ...(cutouts.length > 0 ? {cutouts} : {}),
    kerf_mm,
    ...(isRound && next() < 0.3 ? {datum: 'seam', seam_deg: 33} : {}),
    density_kg_m3: pick(next, [7850, 7850, 2700, 8000]),
    sampling: {uniform_points: 72},
    ...(next() < 0.5 ? {reference: {order: 'A 7', part: `R${number}`, material: 'S355J2H', quantity: 3}} : {}),
  };
}
