/** Parts of tubes that are not round: both ends in one frame, and their figures (docs/theory/parts.md, docs/theory/sections.md). */
import type {Columns} from './bevel.js';
import {beamSpans, checkCutouts} from './cutouts.js';
import {boreOf, checkSection, girth, outsideOf, walk} from './outline.js';
import {beyondKerf, checkClocking, cutOfEnd, ownLengths} from './parts.js';
import type {Scope} from './report.js';
import type {SectionCut} from './section_curves.js';
import {between, checkSectionEnd, heightAt, type Row, rowsOfSection} from './section_ends.js';
import {type Body, type Numbers, sectionOf} from './solids.js';
import {type Frame, norm, RAD, skew, UP, type V3} from './space.js';
import type {Knowledge} from './tables.js';
import {checkTexts} from './texts.js';

const list = (v: unknown) => (v ?? []) as Body[];
const num = (v: unknown, otherwise = 0): number => (typeof v === 'number' ? v : otherwise);
const v3 = (v: unknown) => v as V3;
type Side = 'start' | 'finish';

const backward = [
  'girth_mm',
  'normal_deg',
  'developed_mm',
  'z_inner_mm',
  'z_outer_mm',
  'z_face_mm',
  'flush_deg',
  'b_raw_deg',
  'b_required_deg',
  'b_deg',
  'b_face_deg',
  'torch_inner_mm',
  'torch_outer_mm',
];

/** The finish's table as its own end sees it: girth and z run backwards, rows come in reverse, face 2 is face 4. */
function mirroredSection(end: Body): Body {
  const whole = end.length_mm as number;
  const back = (v: unknown) => (typeof v === 'number' ? -v : v);
  const on = (end.points as {[name: string]: unknown[]}).on_corner;
  const points = Object.fromEntries(
    Object.entries(end.points as Body).map(([name, column]) => {
      const rows = column as unknown[];
      const made =
        name === 'length_mm'
          ? rows.map((v) => whole - (v as number))
          : name === 'face'
            ? rows.map((v, i) => (on[i] ? 5 - (v as number) : [1, 4, 3, 2][(v as number) - 1]))
            : backward.includes(name)
              ? rows.map(back)
              : rows;
      return [name, made.slice().reverse()];
    }),
  );
  const flip = (body: unknown, names: string[]) =>
    body && {...(body as Body), ...Object.fromEntries(names.filter((name) => name in (body as Body)).map((name) => [name, back((body as Body)[name])]))};
  const laser = end.tube_laser as Body | undefined;
  return {
    ...end,
    points,
    events: list(end.events).map((e) => ({...e, girth_mm: back(e.girth_mm), z_from_mm: back(e.z_to_mm), z_to_mm: back(e.z_from_mm), from: e.to, to: e.from})),
    mutations: list(end.mutations).map((m) => flip(m, ['girth_mm'])),
    torch_binds: list(end.torch_binds).map((b) => ({...b, from_girth_mm: back(b.to_girth_mm), to_girth_mm: back(b.from_girth_mm)})),
    penetration: flip(end.penetration, ['girth_mm', 'z_mm']),
    ...(laser ? {tube_laser: {...laser, gap: flip(laser.gap, ['girth_mm']), bevelled_gap: flip(laser.bevelled_gap, ['girth_mm'])}} : {}),
  } as unknown as Body;
}

export function checkSectionPart(scope: Scope, request: Body, result: Body, know: Knowledge): void {
  const f = result.frame as Body;
  const frame: Frame = {origin: v3(f.origin_mm), x: v3(f.x), y: v3(f.y), z: v3(f.z)};
  scope.most('part_frame', skew(frame), 1e-12, '');
  if (!request.target) {
    scope.not('', 'parts of nodes that are not round are not covered');
    return;
  }
  const target = request.target as Body;
  const section = sectionOf(target, know.sections);
  checkSection(scope, section, result.section as Body);
  const length = target.length_mm as number;
  const work = -frame.origin[2]; // of the start, in the part's frame
  scope.most('part_axis', norm([frame.origin[0], frame.origin[1], 0]) + norm([frame.z[0], frame.z[1], frame.z[2] - 1]), 3e-12, '');
  scope.covers('frame/origin_mm/*', ...['x', 'y', 'z'].map((name) => `frame/${name}/*`));
  const whole = {} as {[side in Side]: SectionCut};
  const rows = {} as {[side in Side]: Row[]};
  for (const side of ['start', 'finish'] as const) {
    const made = (result.ends as Body)[side] as Body;
    whole[side] = {cut: cutOfEnd(request, made, side, frame, know), outer: outsideOf(section), bore: boreOf(section)};
    const own = scope.under(`ends/${side}`, `${scope.title}${side}: `);
    const tabbed = list(((request.ends as Body)[side] as Body).end_tabs).length > 0;
    if (tabbed) own.not('', 'of ends with tabs only the figures of the part are checked');
    else checkSectionEnd(own, whole[side], side === 'start' ? made : mirroredSection(made), know);
    rows[side] = rowsOfSection(whole[side], made.points as unknown as Columns);
    checkEndFigures(own, whole[side], made, side, rows[side], tabbed);
    if (whole[side].cut.partners.length > 0) continue;
    const square = num(((request.ends as Body)[side] as Body).square_at_mm);
    const z = (side === 'start' ? square : length - square) + work;
    for (const row of rows[side]) for (const [, at] of row.edges) own.same('square_at', at, z, 2e-10 * (1 + length / 1000), 'mm');
  }
  const volume = checkCutouts(scope, request, result, {outer: outsideOf(section), bore: boreOf(section), wall: section.wall_mm, work, length, rows});
  checkFigures(scope, request, result, whole, rows, {volume, length});
  checkClocking(scope, request, result);
  checkMarks(scope, result, rows);
  checkTexts(scope, request, result);
}

const heightOut = (whole: SectionCut, rows: Row[], s: number, side: Side): number => {
  const all = girth(whole.outer);
  const at = (((s - rows[0].s) % all) + all) % all;
  const found: number[] = [];
  rows.forEach((row, i) => {
    const [from, to] = [row.s - rows[0].s, i + 1 < rows.length ? rows[i + 1].s - rows[0].s : all];
    if (at < from - 1e-9 || at > to + 1e-9) return;
    const u = to > from ? Math.min(1, Math.max(0, (at - from) / (to - from))) : 0;
    const [a, b] = [row.edges, rows[(i + 1) % rows.length].edges].map((edges) => edges[edges.length - 1][1]);
    found.push(a + u * (b - a));
  });
  return side === 'start' ? Math.max(...found) : Math.min(...found); // at a jump the part ends where it is shorter
};

/** The figures of an end: its outer edge, weld and faces. */
function checkEndFigures(scope: Scope, whole: SectionCut, made: Body, side: Side, rows: Row[], tabbed: boolean): void {
  const {cut, outer} = whole;
  const edge = rows.map(({edges}) => edges[edges.length - 1][1]);
  const [low, high] = [Math.min(...edge), Math.max(...edge)];
  for (const [name, value] of [
    ['long_point', side === 'start' ? low : high],
    ['short_point', side === 'start' ? high : low],
  ] as const) {
    const stated = made[name] as unknown as Numbers;
    const found = rows.flatMap(({s}, i) => (Math.abs(s - stated.girth_mm) < 3e-10 ? [Math.abs(edge[i] - stated.z_mm)] : []));
    scope.most('edge_points', Math.min(...found), 1e-10, 'mm', name);
    scope.same('edge_points', stated.z_mm, value, 0.011, 'mm', name);
    scope.covers(`${name}/girth_mm`, `${name}/z_mm`);
  }
  for (const face of list(made.faces) as unknown as Numbers[]) {
    const k = face.face - 1;
    const [far, half] = k % 2 ? [girth(outer) / 4, outer.a - outer.r] : [0, outer.b - outer.r];
    const middle = far + (k > 1 ? girth(outer) / 2 : 0);
    const z = (s: number) => heightOut(whole, rows, s, side);
    scope.same('faces', face.girth_mm, middle, 3e-10, 'mm', `face ${face.face}`);
    scope.same('faces', face.z_mm, z(middle), 3e-10, 'mm', `face ${face.face}`);
    scope.same('faces', face.corner_z_mm, z(middle + half + (Math.PI / 4) * outer.r), 3e-10, 'mm', `corner ${face.face}`);
    if (face.angle_deg !== undefined && half > 0)
      scope.same('faces', face.angle_deg, Math.atan2(z(middle + half) - z(middle - half), 2 * half) / RAD, 3e-9, 'deg', `face ${face.face}`);
    if (face.saw_tilt_deg === undefined) continue;
    const n = cut.partners[0]?.normal([0, 0, 0]) ?? UP; // without partners it is square
    const [c, s] = (
      [
        [1, 0],
        [0, 1],
        [-1, 0],
        [0, -1],
      ] as const
    )[k];
    const tilt = Math.asin(n[0] * c + n[1] * (side === 'finish' ? -s : s)) / RAD;
    scope.same('faces', face.saw_tilt_deg, tilt, 3e-9, 'deg', `face ${face.face}`);
  }
  scope.covers(...['face', 'girth_mm', 'z_mm', 'corner_z_mm', 'angle_deg', 'saw_tilt_deg'].map((name) => `faces/*/${name}`));
  if (tabbed) return;
  const welded = cut.partners.length > 0 && cut.setIn?.size !== cut.partners.length;
  scope.same('weld', made.weld_mm as number, welded ? (made.length_mm as number) : 0, 1e-9 * (1 + outer.a + outer.b), 'mm');
  scope.covers('weld_mm');
  if (!welded) {
    scope.same('groove_volume', made.groove_mm3 as number, 0, 0, 'mm3');
    scope.covers('groove_mm3');
  } else scope.not('groove_mm3', 'the volume to the partners is not summed');
}

/** Metal below a cut, from z = 0: by lines across the wall, at places between the rows where the wall may change. */
function under(whole: SectionCut, rows: Row[]): number {
  const nodes = [0.1127016653792583, 0.5, 0.8872983346207417];
  const weights = [5 / 18, 8 / 18, 5 / 18];
  let volume = 0;
  rows.forEach((row, i) => {
    const span = i + 1 < rows.length ? rows[i + 1].s - row.s : girth(whole.outer) - row.s + rows[0].s;
    if (span < 1e-12) return;
    const parts = Math.max(1, Math.ceil(span));
    for (let part = 0; part < parts; part += 1)
      nodes.forEach((node, k) => {
        const line = between(whole, rows, i, (part + node) / parts);
        const kappa = line.at.onCorner ? 1 / whole.outer.r : 0;
        let across = 0;
        for (let e = 0; e + 1 < line.edges.length; e += 1) {
          const [[w0], [w1]] = [line.edges[e], line.edges[e + 1]];
          for (const [share, weight] of nodes.map((n, j) => [n, weights[j]] as const)) {
            const w = w0 + share * (w1 - w0);
            across += weight * (w1 - w0) * heightAt(line, Math.min(w1, w)) * (1 - kappa * (line.wall - w));
          }
        }
        volume += (weights[k] * span * across) / parts;
      });
  });
  return volume;
}

function checkFigures(
  scope: Scope,
  request: Body,
  result: Body,
  whole: {[side in Side]: SectionCut},
  rows: {[side in Side]: Row[]},
  {volume, length}: {volume: number | undefined; length: number},
): void {
  const z = (side: Side) => rows[side].flatMap(({edges}) => edges.map(([, at]) => at));
  const [s, e] = [z('start'), z('finish')];
  const lengths = result.lengths as unknown as Numbers;
  const fine = 2e-10 * (1 + length / 1000);
  const [tip, throat] = [Math.max(...e) - Math.min(...s), Math.min(...e) - Math.max(...s)];
  const border = (side: Side, way: 1 | -1) =>
    rows[side].flatMap(({torch}, i) => {
      const b = ((((result.ends as Body)[side] as Body).points as unknown as Columns).b_deg as number[])[i] * RAD;
      return torch.map((z) => beyondKerf(z, b, num(request.kerf_mm), way));
    });
  const spare = (request.allowances ?? {}) as unknown as Numbers;
  const blank = Math.max(...border('finish', 1)) - Math.min(...border('start', -1)) + num(spare.clamping_mm) + num(spare.facing_mm);
  const ends = result.ends as {[side in Side]: Body};
  scope.same('datum_z', Math.min(...s), 0, fine, 'mm');
  for (const [name, own] of ownLengths(ends, length, tip, throat, blank)) {
    scope.same('lengths', lengths[name], own, 5 * fine, 'mm', name);
    scope.covers(`lengths/${name}`);
  }
  const metal = under(whole.finish, rows.finish) - under(whole.start, rows.start);
  if (volume === undefined) scope.not('lengths/volume_mm3', 'not every cut-out is covered');
  else {
    scope.same('volume', lengths.volume_mm3 / (metal - volume), 1, 5e-9, '');
    scope.covers('lengths/volume_mm3');
  }
  scope.same('mass', lengths.mass_kg, lengths.volume_mm3 * 1e-9 * num(request.density_kg_m3, 7850), 1e-12 * (1 + lengths.mass_kg), 'kg');
  scope.covers('lengths/mass_kg');
  const sides = result.side_lengths as unknown as {face_mm: number[]; corner_mm: number[]};
  const faces = (side: Side) => list(ends[side].faces) as unknown as Numbers[];
  for (const k of [0, 1, 2, 3]) {
    scope.same('side_lengths', sides.face_mm[k], faces('finish')[k].z_mm - faces('start')[k].z_mm, 3e-10, 'mm', `face ${k + 1}`);
    scope.same('side_lengths', sides.corner_mm[k], faces('finish')[k].corner_z_mm - faces('start')[k].corner_z_mm, 3e-10, 'mm', `corner ${k + 1}`);
  }
  scope.covers('side_lengths/face_mm', 'side_lengths/corner_mm');
  for (const dimension of list(result.check_dimensions)) {
    const value = dimensionOf(String(dimension.name), whole, rows, ends, [tip, throat], dimension.value_mm as number);
    if (value === undefined) scope.not('check_dimensions', `${dimension.name} is unknown`);
    else scope.same('check_dimensions', dimension.value_mm as number, value, 1e-9 * (1 + length / 1000), 'mm', String(dimension.name));
  }
  scope.covers('check_dimensions/*/value_mm');
}

function dimensionOf(
  name: string,
  whole: {[side in Side]: SectionCut},
  rows: {[side in Side]: Row[]},
  ends: {[side in Side]: Body},
  [tip, throat]: [number, number],
  given: number,
): number | undefined {
  const {outer, bore} = whole.start;
  const known: {[name: string]: number} = {
    height: 2 * outer.a,
    width: 2 * outer.b,
    wall: outer.a - bore.a,
    girth: girth(outer),
    tip_to_tip: tip,
    throat_to_throat: throat,
  };
  if (name in known) return known[name];
  const outside = (s: number) => heightOut(whole.finish, rows.finish, s, 'finish') - heightOut(whole.start, rows.start, s, 'start');
  const face = /^length_on_face_([1-4])$/.exec(name);
  if (face) return outside((girth(outer) / 4) * (Number(face[1]) - 1));
  const [, side, what] = /^(start|finish)_(long_girth|crown_chord|overhang)$/.exec(name) ?? [];
  const point = (end: Body, which: string) => end[`${which}_point`] as unknown as Numbers;
  if (side) {
    const end = ends[side as Side];
    const [long, short] = [point(end, 'long'), point(end, 'short')];
    if (what === 'long_girth') return long.girth_mm;
    const place = (p: Numbers): V3 => {
      const {x, y} = walk(outer, p.girth_mm);
      return [x, y, p.z_mm];
    };
    const [a, b] = [place(long), place(short)];
    if (what === 'crown_chord') return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    const over = rows[side as Side].map(({edges}) => (edges[edges.length - 1][1] - edges[0][1]) * (side === 'start' ? 1 : -1));
    const [most, least] = [Math.max(0, ...over), Math.min(0, ...over)];
    return (Math.abs(most + least) < 1e-9 ? given < 0 : -least > most) ? least : most;
  }
  const [, other, which] = /^length_at_(start|finish)_(long|short)$/.exec(name) ?? [];
  return other ? outside(point(ends[other as Side], which).girth_mm) : undefined;
}

/** Marks on the datum line; the order of cuts: where each lies along the part. */
function checkMarks(scope: Scope, result: Body, rows: {[side in Side]: Row[]}): void {
  const faces = (side: Side) => (list(((result.ends as Body)[side] as Body).faces) as unknown as Numbers[])[0].z_mm;
  const [from, to] = [faces('start'), faces('finish')];
  for (const mark of list(result.marks) as unknown as (Numbers & {kind: string})[]) {
    if (mark.kind !== 'datum_line' && mark.kind !== 'part_mark') continue;
    const middle = (from + to) / 2;
    const [low, high] = mark.kind === 'datum_line' ? [from, to] : [middle, middle];
    scope.same('marks', mark.z_from_mm, low, 1e-9, 'mm', mark.kind);
    scope.same('marks', mark.z_to_mm, high, 1e-9, 'mm', mark.kind);
    scope.same('marks', mark.girth_mm, 0, 1e-9, 'mm', mark.kind);
  }
  const spans = beamSpans(result);
  for (const step of list(result.sequence) as unknown as (Numbers & {what: string})[]) {
    if (step.what === 'cutout') {
      const [low, high] = spans[step.index] ?? [NaN, NaN];
      scope.same('sequence', step.z_from_mm, low, 3e-10, 'mm', step.what);
      scope.same('sequence', step.z_to_mm, high, 3e-10, 'mm', step.what);
    }
    if (step.what !== 'start' && step.what !== 'finish') continue;
    const z = rows[step.what as Side].flatMap(({edges}) => edges.map(([, at]) => at));
    scope.same('sequence', step.z_from_mm, Math.min(...z), 3e-10, 'mm', step.what);
    scope.same('sequence', step.z_to_mm, Math.max(...z), 3e-10, 'mm', step.what);
  }
  scope.covers('sequence/*/z_from_mm', 'sequence/*/z_to_mm', 'sequence/*/index', ...['girth_mm', 'z_from_mm', 'z_to_mm'].map((name) => `marks/*/${name}`));
}
