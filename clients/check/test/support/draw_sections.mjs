// Tubes that are not round, and cut-outs of both kinds of tubes.
export const widthOf = (tube) => tube.outer_diameter_mm ?? Math.hypot(tube.height_mm, tube.width_mm);

export function rectangular(r) {
  const wall_mm = r.number(2, 6, 1);
  const side = () => r.number(8 * wall_mm, 150, 1);
  if (r.chance(0.1)) return {kind: 'flat_oval_tube', height_mm: r.number(40, 60, 1), width_mm: r.number(80, 120, 1), wall_mm};
  const corners = r.one([{corners: 'en_10219'}, {corners: 'en_10210'}, {corners: 'astm_a500'}, {corner_radius_mm: r.number(1.3 * wall_mm, 2.5 * wall_mm)}]);
  return {kind: 'rectangular_tube', height_mm: side(), width_mm: side(), wall_mm, ...corners};
}

const shape = (r, most) => r.one([
  () => ({kind: 'circle', diameter_mm: r.number(4, most, 1)}),
  () => ({kind: 'slot', length_mm: r.number(most, 1.6 * most, 1), width_mm: r.number(4, most, 1), angle_deg: r.one([0, 90, r.number(0, 360, 0)])}),
  () => ({kind: 'rectangle', along_mm: r.number(6, 2 * most, 1), round_mm: r.number(6, most, 1), angle_deg: r.one([0, 0, 90, r.number(0, 360, 0)]), ...(r.chance(0.5) ? {corner_radius_mm: r.number(1.5, 2.9)} : {})}),
  () => ({kind: 'contour', start_mm: [-most / 2, -most / 3], mirrored: r.chance(0.5), angle_deg: r.number(0, 360, 0), corners: 'as_cut',
    pieces: [{kind: 'line', to_mm: [most / 2, -most / 3]}, {kind: 'arc', to_mm: [most / 2, most / 3], centre_mm: [most / 2, 0], sense: 'ccw'}, {kind: 'line', to_mm: [-most / 2, -most / 3]}]}),
])();

const pattern = (r, most, section) => r.one([
  () => ({}),
  () => ({pattern: {kind: 'linear', count: r.whole(2, 4), pitch_mm: r.number(2.5 * most, 4 * most, 1)}}),
  () => (section ? {pattern: {kind: 'faces', faces: [1, 2, 3, 4], each: {kind: 'linear', count: 2, pitch_mm: r.number(2.5 * most, 4 * most, 1)}}} : {pattern: {kind: 'round', count: r.whole(2, 3)}}),
  () => (section ? {} : {pattern: {kind: 'grid', along: {count: 2, pitch_mm: r.number(3 * most, 4 * most, 1)}, round: {count: 2, pitch_deg: 180}, ...(r.chance(0.5) ? {stagger: r.one(['along', 'round'])} : {})}}),
])();

/** Cut-outs in the middle of a tube, apart from one another. */
export function cutouts(r, tube, length) {
  const section = tube.outer_diameter_mm === undefined;
  const most = Math.max(6, Math.min(section ? (Math.min(tube.height_mm, tube.width_mm) - 6 * tube.wall_mm) * 0.8 : tube.outer_diameter_mm * 0.35, 40));
  return Array.from({length: r.whole(1, 3)}, (_, i) => {
    const at = section
      ? r.one([{face: r.whole(1, 4), offset_mm: r.number(-2, 2, 1)}, {face: r.whole(1, 4), opposite: true}])
      : r.one([{phi_deg: r.number(-90, 360, 0)}, {girth_mm: r.number(0, 100, 1), opposite: true}]);
    const bolt = {shape: {kind: 'circle', diameter_mm: r.number(4, 6, 1)}, countersink: {diameter_mm: r.number(8, 11, 1), angle_deg: r.one([82, 90, 120])}};
    return {
      id: `c${i}`, ...(r.chance(0.15) ? bolt : {shape: shape(r, most), ...r.one([{wall: 'through'}, {wall: 'normal'}, {wall: 'normal', tilt: 'free'}, {wall: 'developed'}])}),
      at: {z_mm: (length * (i + 1)) / 4, ...at, ...r.one([{}, {from: 'finish'}, {z_zero: 'long_point'}])}, ...pattern(r, most, section),
    };
  });
}
