/** Parts: both ends and the holes of a member in one frame, and what follows from them (docs/theory/parts.md). */
import {type Columns, type Cut, envelope, isOpen} from './bevel.js';
import {beamSpans, checkCutouts} from './cutouts.js';
import {checkHole, type Hole, holeOf, numbersOf} from './holes.js';
import {axisOfMember, byId, cutInFrame, endOf, partnerBy, stated} from './nodes.js';
import type {Scope} from './report.js';
import {axisOf, type Body, isSection, type Size, sizeOf, solid} from './solids.js';
import {across, cross, directionIn, dot, type Frame, inFrame, lineDistance, mul, norm, onTube, RAD, skew, sub, unit, type V3} from './space.js';
import {checkEnd, cutBy, type Knowledge, NO_SIZE} from './tables.js';
import {checkTexts} from './texts.js';
import {plugs, under} from './volumes.js';

type Numbers = {[name: string]: number};
const v3 = (v: unknown) => v as V3;
const list = (v: unknown) => (v ?? []) as Body[];
const num = (v: unknown, otherwise = 0): number => (typeof v === 'number' ? v : otherwise);
type Side = 'start' | 'finish';

/** The part's frame turned about x, so that z runs into the member from its finish. */
export const turned = (f: Frame): Frame => ({origin: f.origin, x: f.x, y: mul(f.y, -1), z: mul(f.z, -1)});
/** From the start's own frame to the finish's: p = (x, -y, L - z). */
const atFinish = (f: Frame, length: number): Frame => {
  const flip = (d: V3): V3 => [d[0], -d[1], -d[2]];
  return {origin: [f.origin[0], -f.origin[1], length - f.origin[2]], x: flip(f.x), y: flip(f.y), z: flip(f.z)};
};

const signed = [
  'developed_mm',
  'z_inner_mm',
  'z_outer_mm',
  'tau_deg',
  'flush_deg',
  'dz_per_branch_mm',
  'dz_per_chord_mm',
  'b_raw_deg',
  'b_required_deg',
  'b_deg',
  'torch_inner_mm',
  'torch_outer_mm',
  'z_face_mm',
  'b_face_deg',
  'phi_deg',
];

/** The finish's table as its own end sees it: phi and z run backwards, elevations change their sign, rows come in reverse. */
export function mirrored(end: Body): Body {
  const whole = end.length_mm as number;
  const back = (v: unknown) => (typeof v === 'number' ? -v : v);
  const points = Object.fromEntries(
    Object.entries(end.points as Body).map(([name, column]) => {
      const rows = (column as unknown[]).slice().reverse();
      return [name, name === 'length_mm' ? rows.map((v) => whole - (v as number)) : signed.includes(name) ? rows.map(back) : rows];
    }),
  );
  const flip = (body: Body, names: string[]) =>
    ({...body, ...Object.fromEntries(names.filter((name) => body[name] !== undefined).map((name) => [name, back(body[name])]))}) as Body;
  const events = list(end.events).map((e) => ({
    ...flip(e, ['phi_deg']),
    z_from_mm: -(e.z_to_mm as number),
    z_to_mm: -(e.z_from_mm as number),
    from: e.to,
    to: e.from,
  }));
  const laser = end.tube_laser as Body | undefined;
  const sub_ = (name: string, names: string[]) => (laser?.[name] ? {[name]: flip(laser[name] as Body, names)} : {});
  return {
    ...end,
    points,
    events,
    mutations: list(end.mutations).map((m) => flip(m, ['phi_deg'])),
    torch_binds: list(end.torch_binds).map((b) => ({...b, from_phi_deg: back(b.to_phi_deg), to_phi_deg: back(b.from_phi_deg)})),
    penetration: flip(end.penetration as Body, ['phi_deg', 'z_mm']),
    torch_line: flip(end.torch_line as Body, ['gouge_phi_deg', 'left_phi_deg']),
    ...(laser ? {tube_laser: {...laser, ...sub_('gap', ['phi_deg']), ...sub_('bevelled_gap', ['phi_deg']), ...sub_('tongue', ['phi_deg', 'z_mm'])}} : {}),
  } as unknown as Body;
}

/** One end's partners in its own frame; without any it is square. */
export function cutOfEnd(request: Body, made: Body, side: Side, frame: Frame, know: Knowledge): Cut {
  if (request.members) {
    const members = list(request.members);
    const target = byId(members, request.member);
    const cut = cutInFrame(request, members, target, side, (made.cutter_ids ?? []) as string[], side === 'start' ? frame : turned(frame), know);
    const into = ((made.cutter_ids ?? []) as string[]).flatMap((id, i) => (stated(target, byId(members, id))?.kind === 'set_in' ? [i] : []));
    const ids = (made.cutter_ids ?? []) as string[];
    const bare = ids.map((id) =>
      partnerBy(byId(members, id), endOf(target, side), {kind: 'set_on', gap_mm: 0}, {coating: 0, root: 0}, side === 'start' ? frame : turned(frame), know),
    );
    return {...cut, metal: bare.map((body, i) => (cut.partners[i]?.rate === undefined ? cut.partners[i] : body)), setIn: new Set(into)};
  }
  const target = request.target as Body;
  const {outer_diameter_mm, wall_mm} = isSection(target) ? NO_SIZE : sizeOf(target, know.sizes);
  const end = (request.ends as Body)[side] as Body;
  const options = {...request, ...end, kerf_mm: end.kerf_mm ?? request.kerf_mm ?? 0} as Body;
  const own = side === 'start' ? frame : atFinish(turned(frame), target.length_mm as number);
  const coating = num(end.coating_mm);
  const joints = list(end.joints);
  const partners = list(end.cutters).map((body, i) => {
    const joint = joints.find(({cutter}) => cutter === i);
    const off = !joint ? num(end.root_gap_mm) : joint.kind === 'set_in' ? -num(joint.depth_mm) : num(joint.gap_mm) / (joint.kind === 'mitre' ? 2 : 1);
    return solid(body, off + (joint?.kind === 'set_in' ? 0 : coating), know.sizes, own);
  });
  return {
    ...cutBy(options, outer_diameter_mm / 2, wall_mm, partners),
    metal: list(end.cutters).map((body) => solid(body, 0, know.sizes, own)),
    setIn: new Set(joints.filter(({kind}) => kind === 'set_in').map(({cutter}) => cutter as number)),
  };
}

export function checkPart(scope: Scope, request: Body, result: Body, know: Knowledge): void {
  const f = result.frame as Body;
  const frame: Frame = {origin: v3(f.origin_mm), x: v3(f.x), y: v3(f.y), z: v3(f.z)};
  scope.most('part_frame', skew(frame), 1e-12, '');
  const {target, axis, length} = bodyOf(request);
  scope.most('part_axis', norm(sub(frame.z, axis[1])) + lineDistance(frame.origin, ...axis) / (1 + norm(frame.origin)), 3e-12, '');
  scope.covers('frame/origin_mm/*', ...['x', 'y', 'z'].map((name) => `frame/${name}/*`));
  if (request.members && request.datum === 'up') scope.most('part_up', norm(sub(frame.x, unit(across(v3(request.up ?? target.up), frame.z)))), 1e-9, '');
  const {outer_diameter_mm, wall_mm} = sizeOf(target, know.sizes);
  const ends = {} as {[side in Side]: Body};
  const cuts = {} as {[side in Side]: Cut};
  for (const side of ['start', 'finish'] as const) {
    const made = (result.ends as Body)[side] as Body;
    ends[side] = made;
    cuts[side] = cutOfEnd(request, made, side, frame, know);
    const own = scope.under(`ends/${side}`, `${scope.title}${side}: `);
    checkEnd(own, cuts[side], side === 'start' ? made : mirrored(made), know);
    checkSides(own, cuts[side], made, side, outer_diameter_mm / 2);
    if (cuts[side].partners.length === 0) {
      const square = request.members ? 0 : num(((request.ends as Body)[side] as Body).square_at_mm);
      const z = (side === 'start' ? square : length - square) - dot(sub(frame.origin, axis[0]), axis[1]);
      for (const at of (made.points as unknown as Columns).z_outer_mm as number[]) own.same('square_at', at, z, 2e-10 * (1 + length / 1000), 'mm');
    }
  }
  const holes = checkPartHoles(scope, request, result, frame, know, {outer_diameter_mm, wall_mm});
  checkFigures(scope, request, result, ends, cuts, holes, length);
  checkMarks(scope, request, result, ends, outer_diameter_mm / 2, frame);
}

/** The member that is cut, its axis in the coordinates of the part's frame, and the way between its work points. */
function bodyOf(request: Body): {target: Body; axis: [V3, V3]; length: number} {
  if (!request.members) {
    const target = request.target as Body;
    return {
      target,
      axis: [
        [0, 0, 0],
        [0, 0, 1],
      ],
      length: target.length_mm as number,
    };
  }
  const target = byId(list(request.members), request.member);
  return {target, axis: axisOfMember(target), length: norm(sub(v3(target.end_mm), v3(target.start_mm)))};
}

/** The statements of an end of its outer edge and its weld. */
function checkSides(scope: Scope, cut: Cut, made: Body, side: Side, R: number): void {
  const points = made.points as unknown as {[name: string]: number[]};
  const [phi, z] = [points.phi_deg, points.z_outer_mm];
  const [low, high] = [Math.min(...z), Math.max(...z)];
  for (const [name, value] of [
    ['long_point', side === 'start' ? low : high],
    ['short_point', side === 'start' ? high : low],
  ] as const) {
    const stated_ = made[name] as Numbers;
    const i = phi.findIndex((deg) => Math.abs(deg - stated_.phi_deg) < 1e-9);
    scope.same('edge_points', stated_.z_mm, i < 0 ? NaN : z[i], 1e-10, 'mm', name);
    scope.same('edge_points', stated_.z_mm, value, 0.011, 'mm', name);
    scope.same('edge_girth', stated_.girth_mm, R * stated_.phi_deg * RAD, 1e-12 * (1 + R), 'mm', name);
    scope.covers(...['phi_deg', 'girth_mm', 'z_mm'].map((member) => `${name}/${member}`));
  }
  const welded = cut.partners.length > 0 && cut.setIn?.size !== cut.partners.length; // the weld of a set-in end is that of the hole
  scope.same('weld', made.weld_mm as number, welded ? (made.length_mm as number) : 0, 1e-11 * (1 + R), 'mm');
  scope.covers('weld_mm');
  if (cut.partners.length === 0) {
    scope.same('groove_volume', made.groove_mm3 as number, 0, 0, 'mm3');
    scope.covers(
      'groove_mm3',
      ...Object.keys(points)
        .filter((name) => name !== 'zone')
        .map((name) => `points/${name}`),
    );
    for (const name of ['groove_deg', 'tau_deg', 'gamma_deg', 'flush_deg', 'b_raw_deg', 'b_required_deg', 'gap_mm', 'dz_per_branch_mm', 'cutter'])
      for (const value of points[name] ?? []) scope.same('square_end', value, 0, 1e-12, '', name);
    for (const value of points.dihedral_deg ?? []) scope.same('square_end', value, 90, 1e-12, 'deg');
    return;
  }
  if (isOpen(cut)) return; // its groove has no other side there
  const own = welded ? grooveVolume(cut, side === 'start' ? made : mirrored(made)) : 0;
  scope.same('groove_volume', made.groove_mm3 as number, own, 5e-3 * Math.abs(own) + 2e-3 * (made.length_mm as number) * (cut.outer - cut.inner), 'mm3');
  scope.covers('groove_mm3');
}

/** Between the finished wall and the partners: the wall is straight between its rows, the partners are not. */
function grooveVolume(cut: Cut, end: Body): number {
  const points = end.points as unknown as {[name: string]: number[]};
  const phi = points.phi_deg;
  const [count, parts] = [12, 4];
  const metal = {...cut, partners: cut.metal ?? cut.partners};
  const t = cut.outer - cut.inner;
  const face = points.z_face_mm ? cut.face : 0;
  const section = (i: number, share: number, deg: number): number => {
    const [zi, zf, zo] = ['z_inner_mm', face ? 'z_face_mm' : 'z_inner_mm', 'z_outer_mm'].map((name) => {
      const [from, to] = [points[name][i], points[name][(i + 1) % phi.length]];
      return from + share * (to - from);
    });
    let area = 0;
    for (let k = 0; k < count; k += 1) {
      const v = ((k + 0.5) / count) * t;
      const z = v < face ? zi + ((zf - zi) * v) / face : zf + ((zo - zf) * (v - face)) / (t - face);
      const top = envelope(metal, cut.inner + v, deg * RAD).z;
      if (top > -Infinity) area += Math.max(0, z - top) * (cut.inner + v) * (t / count);
    }
    return area;
  };
  return phi.reduce((sum, deg, i) => {
    const width = (i + 1 < phi.length ? phi[i + 1] : phi[0] + 360) - deg;
    for (let k = 0; k < parts; k += 1) sum += (section(i, (k + 0.5) / parts, deg + ((k + 0.5) / parts) * width) * width * RAD) / parts;
    return sum;
  }, 0);
}

function checkPartHoles(scope: Scope, request: Body, result: Body, frame: Frame, know: Knowledge, chord: Size): Body[] {
  const asked = list(request.holes).map((hole): [string, Hole] => {
    if (hole.branch) {
      const [point, along] = axisOf(hole.branch as Body);
      return [
        String((hole.branch as Body).id ?? ''),
        placed(holeOf({...request, ...hole}, chord, know.sizes), inFrame(frame, point), directionIn(frame, along)),
      ];
    }
    const members = list(request.members);
    const [target, branch] = [byId(members, request.member), byId(members, hole.member)];
    const joint = (hole.joint ?? stated(target, branch) ?? {kind: 'set_on'}) as Body;
    const [point, along] = axisOfMember(branch);
    const way = awayFrom(axisOfMember(target), branch) ? along : mul(along, -1);
    const body = {...request, ...hole, joint, branch: {...sizeOf(branch, know.sizes), axis: {point_mm: point, direction: way}}} as unknown as Body;
    return [String(hole.member), placed(holeOf(body, chord, know.sizes), inFrame(frame, point), directionIn(frame, way))];
  });
  const holes = list(result.holes);
  for (const made of holes) {
    const candidates = asked.filter(([id]) => id === made.branch);
    if (!candidates.length) {
      scope.not('holes', `no hole is asked for ${made.branch}`);
      continue;
    }
    // A branch that both ends of a member alike are may have two: the one whose axis this hole stands about.
    const off = ([, hole]: [string, Hole]): number => {
      const points = made.points as unknown as Columns;
      const p = onTube(hole.outer, (points.phi_deg as number[])[0] * RAD, (points.z_mm as number[])[0]);
      return Math.abs(lineDistance(p, hole.q, hole.d) - hole.branchOuter);
    };
    const [, own] = candidates.reduce((best, next) => (off(next) < off(best) ? next : best));
    checkHole(scope.under('holes/*', `${scope.title}hole: `), own, made);
  }
  return holes;
}

/** Whether the branch runs away from the chord's axis from its start on: its nearer end is its start. */
function awayFrom([q, d]: [V3, V3], branch: Body): boolean {
  return lineDistance(v3(branch.start_mm), q, d) <= lineDistance(v3(branch.end_mm), q, d);
}

/** The hole with its branch along another line, in another frame. */
function placed(hole: Hole, point: V3, along: V3): Hole {
  const {q, ...placement} = numbersOf(point, along);
  const x: V3 = [-Math.cos(placement.b), -Math.sin(placement.b), 0];
  return {...hole, q, d: along, x, y: cross(along, x), placement};
}

/** A column at a phase, straight between its rows. */
function at(points: {[name: string]: number[]}, name: string, deg: number): number {
  const [phi, z] = [points.phi_deg, points[name]];
  const first = phi[0];
  const turn = first + ((((deg - first) % 360) + 360) % 360);
  let i = 0;
  while (i + 1 < phi.length && phi[i + 1] <= turn) i += 1;
  const [a, b] = [phi[i], i + 1 < phi.length ? phi[i + 1] : first + 360];
  const next = z[(i + 1) % z.length];
  return b > a ? z[i] + ((turn - a) / (b - a)) * (next - z[i]) : z[i];
}

/** Where the kerf ends beyond a place of the beam's axis: half of it along the tube, across a beam that leans by b. */
export const beyondKerf = (torch: number, b: number, kerf: number, way: 1 | -1) => torch + (way * 0.5 * kerf) / Math.cos(b);

/** The lengths of a part by their names. */
export const ownLengths = (ends: {[side in Side]: Body}, length: number, tip: number, throat: number, blank: number) =>
  [
    ['work_point_mm', length],
    ['long_mm', tip],
    ['short_mm', throat],
    ['blank_mm', blank],
    ['weld_mm', num(ends.start.weld_mm) + num(ends.finish.weld_mm)],
  ] as const;

function checkFigures(
  scope: Scope,
  request: Body,
  result: Body,
  ends: {[side in Side]: Body},
  cuts: {[side in Side]: Cut},
  holes: Body[],
  length: number,
): void {
  const [s, e] = [ends.start.points, ends.finish.points] as unknown as [{[name: string]: number[]}, {[name: string]: number[]}];
  const [R, r] = [cuts.start.outer, cuts.start.inner];
  const col = (points: {[name: string]: number[]}, name: string) => points[name];
  const both = (points: {[name: string]: number[]}) => [...col(points, 'z_inner_mm'), ...col(points, 'z_outer_mm')];
  const fine = 2e-10 * (1 + length / 1000);
  const lengths = result.lengths as Numbers;
  const tip = Math.max(...both(e)) - Math.min(...both(s));
  const throat = Math.min(...both(e)) - Math.max(...both(s));
  const border = (points: {[name: string]: number[]}, way: 1 | -1) =>
    col(points, 'b_deg').flatMap((b, i) =>
      ['torch_inner_mm', 'torch_outer_mm'].map((name) => beyondKerf(col(points, name)[i], b * RAD, num(request.kerf_mm), way)),
    );
  const spare = (request.allowances ?? {}) as Numbers;
  scope.same('datum_z', Math.min(...both(s)), 0, fine, 'mm');
  const blank = Math.max(...border(e, 1)) - Math.min(...border(s, -1)) + num(spare.clamping_mm) + num(spare.facing_mm);
  for (const [name, own] of ownLengths(ends, length, tip, throat, blank)) {
    scope.same('lengths', lengths[name], own, 3 * fine, 'mm', name);
    scope.covers(`lengths/${name}`);
  }
  const spans = holes.map((hole): [number, number] => {
    const z = ['z_mm', 'z_inner_mm'].flatMap((name) => (hole.points as {[name: string]: number[]})[name]);
    return [Math.min(...z), Math.max(...z)];
  });
  const alone = spans.every(
    ([low, high], i) => low > Math.max(...both(s)) && high < Math.min(...both(e)) && spans.every(([from, to], k) => k === i || to < low || from > high),
  );
  const round = {a: R, b: R, r: R};
  const {axis} = bodyOf(request);
  const taken = checkCutouts(scope, request, result, {
    outer: round,
    bore: {a: r, b: r, r},
    wall: R - r,
    work: dot(sub(axis[0], v3((result.frame as Body).origin_mm)), axis[1]),
    length,
    longest: Math.max(...both(e)),
  });
  const own = lengths.volume_mm3;
  if (alone && taken !== undefined) {
    const volume = under(cuts.finish, e) - under(cuts.start, s) - plugs(holes, R, r) - taken;
    scope.same('volume', own / volume, 1, holes.length ? 5e-4 : taken ? 1e-7 : 1e-9, '');
    scope.covers('lengths/volume_mm3');
  } else scope.not('lengths/volume_mm3', 'holes that may meet each other or an end, and cut-outs that are not covered, are not taken together');
  scope.same('mass', lengths.mass_kg, own * 1e-9 * num(request.density_kg_m3, 7850), 1e-12 * (1 + lengths.mass_kg), 'kg');
  scope.covers('lengths/mass_kg');
  for (const dimension of list(result.check_dimensions)) {
    const value = dimensionOf(String(dimension.name), s, e, ends, R, r, tip, throat, dimension.value_mm as number);
    if (value === undefined) scope.not('check_dimensions', `${dimension.name} is unknown`);
    else scope.same('check_dimensions', dimension.value_mm as number, value, 3 * fine, 'mm', String(dimension.name));
  }
  scope.covers('check_dimensions/*/value_mm');
  checkClocking(scope, request, result);
}

function dimensionOf(
  name: string,
  s: {[name: string]: number[]},
  e: {[name: string]: number[]},
  ends: {[side in Side]: Body},
  R: number,
  r: number,
  tip: number,
  throat: number,
  given: number,
): number | undefined {
  const outside = (deg: number) => at(e, 'z_outer_mm', deg) - at(s, 'z_outer_mm', deg);
  const quarter = /^length_at_(\d+)$/.exec(name);
  if (quarter) return outside(Number(quarter[1]));
  const whole: {[name: string]: number} = {girth: 2 * Math.PI * R, wall: R - r, tip_to_tip: tip, throat_to_throat: throat};
  if (name in whole) return whole[name];
  const [, side, what] = /^(start|finish)_(long_girth|crown_chord|overhang)$/.exec(name) ?? [];
  if (side) {
    const end = ends[side as Side];
    const [long, short] = [end.long_point as Numbers, end.short_point as Numbers];
    if (what === 'long_girth') return long.girth_mm;
    const place = (p: Numbers) => onTube(R, p.phi_deg * RAD, p.z_mm);
    if (what === 'crown_chord') return norm(sub(place(long), place(short)));
    const points = side === 'start' ? s : e;
    const over = points.z_outer_mm.map((z, i) => (z - points.z_inner_mm[i]) * (side === 'start' ? 1 : -1));
    const [most, least] = [Math.max(0, ...over), Math.min(0, ...over)];
    return (Math.abs(most + least) < 1e-9 ? given < 0 : -least > most) ? least : most; // alike on both sides: either is the widest
  }
  const [, other, which] = /^length_at_(start|finish)_(long|short)$/.exec(name) ?? [];
  if (other) return outside((ends[other as Side][`${which}_point`] as Numbers).phi_deg);
  return undefined;
}

/** The side towards which a partner of an end leans, in the coordinates of its request: where its axis, or the plane, rises into the member. */
export function checkClocking(scope: Scope, request: Body, result: Body): void {
  if (request.members) return;
  const lean = (side: Side): number | undefined => {
    const body = list(((request.ends as Body)[side] as Body).cutters)[0];
    if (!body) return undefined;
    const n = body.kind === 'plane' ? unit(v3(body.normal)) : axisOf(body)[1];
    if (Math.abs(n[2]) < 1e-9 || Math.hypot(n[0], n[1]) < 1e-9) return undefined;
    const way = (body.kind === 'plane' ? -1 : 1) * Math.sign(n[2]);
    return Math.atan2(way * n[1], way * n[0]) / RAD;
  };
  const [s, f] = [lean('start'), lean('finish')];
  if (s === undefined || f === undefined) return;
  const off = (result.clocking_between_ends_deg as number) + f + s;
  scope.most('clocking', Math.abs(((((off + 180) % 360) + 360) % 360) - 180), 1e-9, 'deg');
  scope.covers('clocking_between_ends_deg');
}

/** Marks and the order of cuts: where they stand along the part. */
function checkMarks(scope: Scope, request: Body, result: Body, ends: {[side in Side]: Body}, R: number, frame: Frame): void {
  const marks = list(result.marks) as unknown as (Numbers & {kind: string; text: string})[];
  const [s, e] = [ends.start.points, ends.finish.points] as unknown as [{[name: string]: number[]}, {[name: string]: number[]}];
  const [from, to] = [at(s, 'z_outer_mm', 0), at(e, 'z_outer_mm', 0)];
  checkTexts(scope, request, result);
  for (const mark of marks.filter(({kind}) => kind !== 'text')) {
    const phi = mark.phi_deg;
    scope.same('mark_girth', mark.girth_mm, R * phi * RAD, 1e-10 * (1 + R), 'mm', mark.text);
    const middle = (from + to) / 2;
    const [low, high] = mark.kind === 'datum_line' ? [from, to] : [middle, middle];
    if (mark.kind !== 'partner') {
      for (const [z, own] of [
        [mark.z_from_mm, low],
        [mark.z_to_mm, high],
      ] as const)
        scope.same('marks', z, own, 3e-10 * (1 + Math.abs(own) / 1000), 'mm', mark.text);
      scope.same('marks', phi, 0, 1e-9, 'deg', mark.text);
      continue;
    }
    scope.same('marks', mark.z_from_mm, mark.z_to_mm, 1e-10, 'mm', mark.text);
    const lines: [V3, V3][] = request.members
      ? list(request.members)
          .filter(({id}) => id === mark.text)
          .map((m) => [inFrame(frame, axisOfMember(m)[0]), directionIn(frame, axisOfMember(m)[1])])
      : list(request.holes)
          .map((h) => h.branch as Body)
          .filter((b) => b.id === mark.text)
          .map((b) => [inFrame(frame, axisOf(b)[0]), directionIn(frame, axisOf(b)[1])]);
    const place = onTube(R, phi * RAD, mark.z_from_mm);
    const off = lines.map(([q, d]) => lineDistance(place, q, d));
    for (const m of list(request.marks).filter(({text}) => text === mark.text))
      off.push(norm(sub(place, inFrame(frame, onTube(R, (m.phi_deg as number) * RAD, m.z_mm as number)))));
    if (off.length) scope.most('marks', Math.min(...off), 3e-10 * (1 + R / 10), 'mm', mark.text);
  }
  scope.covers(...['phi_deg', 'girth_mm', 'z_from_mm', 'z_to_mm'].map((name) => `marks/*/${name}`));
  const spans = beamSpans(result);
  for (const step of list(result.sequence) as unknown as (Numbers & {what: string})[]) {
    const torch = (points: {[name: string]: number[]}, names: string[]) => names.flatMap((name) => points[name]);
    if (step.what === 'cutout') {
      const [low, high] = spans[step.index] ?? [NaN, NaN];
      scope.same('sequence', step.z_from_mm, low, 3e-10, 'mm', step.what);
      scope.same('sequence', step.z_to_mm, high, 3e-10, 'mm', step.what);
      continue;
    }
    const mark = marks[step.index];
    const hole = list(result.holes)[step.index];
    const z =
      step.what === 'mark'
        ? [mark?.z_from_mm, mark?.z_to_mm]
        : step.what === 'hole'
          ? torch((hole?.points ?? {}) as never, ['torch_z_mm', 'torch_z_inner_mm'])
          : torch(step.what === 'start' ? s : e, ['torch_inner_mm', 'torch_outer_mm']);
    scope.same('sequence', step.z_from_mm, Math.min(...z), 3e-10, 'mm', step.what);
    scope.same('sequence', step.z_to_mm, Math.max(...z), 3e-10, 'mm', step.what);
  }
  scope.covers('sequence/*/z_from_mm', 'sequence/*/z_to_mm', 'sequence/*/index');
}
