/** Frames: every part by itself, every joint in the world, and the cut list. */
import {axisOfMember, byId, endOf, mitrePlane} from './nodes.js';
import {checkPart} from './parts.js';
import {checkSectionPart} from './section_parts.js';
import {Scope} from './report.js';
import {type Body, boxOf, girthOf, isSection, onOutline, plane, sectionOf, type Solid, sizeOf, solid, tube} from './solids.js';
import {add, type Frame, lineDistance, mul, norm, onTube, RAD, skew, sub, toWorld, type V3} from './space.js';
import type {Knowledge} from './tables.js';

type Numbers = {[name: string]: number};
const list = (v: unknown) => (v ?? []) as Body[];
const v3 = (v: unknown) => v as V3;

export function checkFrame(scope: Scope, answer: Body, know: Knowledge): void {
  const [request, result] = [answer.request as Body, answer.result as Body];
  const made = new Map<string, Body>();
  for (const part of list(answer.parts)) {
    if (!part.answer) continue;
    const inner = part.answer as Body;
    made.set(String(part.part), inner);
    const own = new Scope(scope.report, '/parts/*/answer/result', `${part.part}: `);
    if ((inner.result as Body).section) checkSectionPart(own, inner.request as Body, inner.result as Body, know);
    else checkPart(own, inner.request as Body, inner.result as Body, know);
  }
  checkCutList(scope, request, result, made, know);
  const pieces = new Set(list(result.merged).flatMap((row) => [row.id, ...((row.members ?? []) as string[])]));
  const members = list(result.members);
  for (const member of members) checkPlace(scope, request, member, made, pieces);
  for (const joint of list(result.joints)) {
    checkJoint(scope, request, joint, members, made, pieces, know);
    checkStated(scope, request, joint, members, made);
  }
  if (result.plates) scope.not('plates', 'of plates only the statements of their joints are looked at');
  scope.covers('joints/*/gap_mm', 'joints/*/depth_mm').not('joints/*/fit_up', 'only that end and hole keep the gap in the world, within alike_within_mm');
}

function checkCutList(scope: Scope, request: Body, result: Body, made: Map<string, Body>, know: Knowledge): void {
  const rows = list(result.cut_list);
  const totals = result.totals as Numbers;
  let [blank, mass, count, all] = [0, 0, 0, 0];
  const members = list(request.members);
  scope.not('cut_list/*/differs_at_most_mm', 'only that it is 0 of a part made once, and else within alike_within_mm');
  for (const row of rows) {
    const n = row.count as number;
    const ids = row.members as string[];
    const where = String(row.part);
    all += n;
    scope.same('cut_list_count', n, ids.length, 0, '', where);
    const own = members.find(({id}) => id === row.part);
    const section = own && isSection(own) ? sectionOf(own, know.sections) : undefined;
    const size = own && ((section ?? sizeOf(own, know.sizes)) as unknown as Numbers);
    for (const name of ['outer_diameter_mm', 'height_mm', 'width_mm', 'wall_mm'])
      if (size && (name in size || name in row)) scope.same('cut_list_size', row[name] as number, size[name] ?? Number.NaN, 1e-9, 'mm', where);
    scope.most('cut_list_alike', row.differs_at_most_mm as number, n > 1 ? alike(request) : 0, 'mm', where);
    const part = made.get(where);
    if (!part) continue;
    const lengths = (part.result as Body).lengths as Numbers;
    count += n;
    blank += n * (row.blank_mm as number);
    mass += n * (row.mass_kg as number);
    for (const name of ['long_mm', 'blank_mm', 'weld_mm', 'mass_kg']) scope.same('cut_list', row[name] as number, lengths[name], 1e-10, '', `${where} ${name}`);
    const girth = section ? girthOf(section) : Math.PI * (row.outer_diameter_mm as number);
    scope.same('cut_list', row.girth_mm as number, girth, 1e-12 * (1 + (row.girth_mm as number)), 'mm', where);
  }
  for (const [name, own] of [
    ['members', all],
    ['made', count],
    ['parts', made.size],
    ['blank_mm', blank],
    ['mass_kg', mass],
  ] as const) {
    scope.same('totals', totals[name], own, 1e-13 * own, '', name);
    scope.covers(`totals/${name}`);
  }
  scope.covers(
    ...['count', 'outer_diameter_mm', 'height_mm', 'width_mm', 'wall_mm', 'long_mm', 'blank_mm', 'girth_mm', 'weld_mm', 'mass_kg'].map(
      (name) => `cut_list/*/${name}`,
    ),
  );
}

const frameOf = (member: Body): Frame | undefined => {
  const f = member.frame as Body | undefined;
  return f && {origin: v3(f.origin_mm), x: v3(f.x), y: v3(f.y), z: v3(f.z)};
};

/** The part lies along its member: on its axis, as far from its work points as the part's own ends are. */
function checkPlace(scope: Scope, request: Body, member: Body, made: Map<string, Body>, pieces: Set<unknown>): void {
  const frame = frameOf(member);
  const part = made.get(String(member.part));
  if (!frame || !part) return;
  const where = String(member.id);
  scope.most('member_frame', skew(frame), 1e-11, '', where);
  scope.covers('members/*/frame/origin_mm/*', ...['x', 'y', 'z'].map((name) => `members/*/frame/${name}/*`));
  if (pieces.has(member.id)) {
    scope.not('members', 'of members made of pieces only the frames are looked at');
    return;
  }
  const own = byId(list(request.members), member.id);
  const [point, along] = axisOfMember(own);
  const size = norm(point) + norm(v3(own.end_mm));
  scope.most(
    'member_axis',
    Math.max(lineDistance(frame.origin, point, along), size * Math.min(norm(sub(frame.z, along)), norm(add(frame.z, along)))),
    1e-8 + 1e-12 * size,
    'mm',
    where,
  );
}

/** Weld and groove of a joint are those of the end that is set on, or of the hole that is cut for the branch. */
function checkStated(scope: Scope, request: Body, joint: Body, members: Body[], made: Map<string, Body>): void {
  const says = list(request.joints).find(({between}) => [joint.branch, joint.chord].every((id) => (between as unknown[]).includes(id)));
  if (says)
    for (const name of ['gap_mm', 'depth_mm']) if (says[name] !== undefined) scope.equal('joint', joint[name], says[name], `${joint.branch} on ${joint.chord}`);
  const inside = joint.kind === 'set_in' || joint.kind === 'through';
  const place = members.find(({id}) => id === joint[inside ? 'chord' : 'branch']);
  const part = place && (made.get(String(place.part))?.result as Body | undefined);
  if (!part) return;
  const holes = list(part.holes).map((hole) => hole.length_mm as number);
  const ends = (Object.values(part.ends as Body) as Body[]).filter((end) => (end.cutter_ids as string[]).length === 1); // of several partners each has its share
  const through = () => holes.flatMap((one, i) => holes.slice(i + 1).map((other) => one + other)); // in and out
  const welds = joint.kind === 'through' ? through() : inside ? holes : ends.map((end) => end.weld_mm as number);
  const where = `${joint.branch} on ${joint.chord}`;
  const check = (name: string, own: number[]) => {
    const stated = joint[name] as number | undefined;
    if (stated === undefined || !own.length) return;
    scope.most('joint_figures', Math.min(...own.map((each) => Math.abs(each - stated))), 1e-9 * (1 + stated), '', where);
    scope.covers(`joints/*/${name}`);
  };
  check('weld_mm', welds);
  if (!inside)
    check(
      'groove_mm3',
      ends.map((end) => end.groove_mm3 as number),
    );
}

/** Edges of a part's end in the world. */
function edges(member: Body, made: Map<string, Body>, side: string, know: Knowledge): V3[] {
  const frame = frameOf(member);
  const part = made.get(String(member.part));
  if (!frame || !part) return [];
  const points = (((part.result as Body).ends as Body)[side] as Body).points as unknown as {[name: string]: number[]};
  const target = (part.request as Body).target as Body;
  if (isSection(target)) {
    const section = sectionOf(target, know.sections);
    return points.girth_mm.flatMap((girth, i) => {
      const [x, y] = onOutline(section, girth);
      const [nu, t] = [points.normal_deg[i] * RAD, points.wall_mm[i]];
      return [toWorld(frame, [x - t * Math.cos(nu), y - t * Math.sin(nu), points.z_inner_mm[i]]), toWorld(frame, [x, y, points.z_outer_mm[i]])];
    });
  }
  const {outer_diameter_mm: D, wall_mm: t} = target as unknown as Numbers;
  const R = (D ?? 0) / 2;
  return points.phi_deg.flatMap((deg, i) => [
    toWorld(frame, onTube(R - (t ?? 0), deg * RAD, points.z_inner_mm[i])),
    toWorld(frame, onTube(R, deg * RAD, points.z_outer_mm[i])),
  ]);
}

/** Both sides of a joint where they stand: the branch's end touches the chord's surface with its gap, and the chord's hole the branch's. */
function checkJoint(scope: Scope, request: Body, joint: Body, members: Body[], made: Map<string, Body>, pieces: Set<unknown>, know: Knowledge): void {
  const [branch, chord] = [String(joint.branch), String(joint.chord)];
  const where = `${branch} on ${chord}`;
  const place = members.find(({id}) => id === branch);
  const own = list(request.members).find(({id}) => id === branch);
  if (pieces.has(branch) || pieces.has(chord) || !place || !own || !frameOf(place) || !made.get(String(place.part))) return;
  if (!['outer_diameter_mm', 'kind', 'size'].some((name) => name in ((made.get(String(place.part)) as Body).request as {target: Body}).target)) {
    scope.not('joints', 'the part is of a named size');
    return;
  }
  const body = list(request.members).find(({id}) => id === chord) ?? list(request.others).find(({id}) => id === chord);
  if (!body) return;
  const gap = joint.gap_mm as number;
  const kind = joint.kind;
  if (kind === 'set_on' || kind === 'set_in' || (kind === 'mitre' && joint.plane === 'bisecting')) {
    const middle = mul(add(v3(own.start_mm), v3(own.end_mm)), 0.5);
    const surfaces = kind === 'mitre' ? [between(own, body, gap, 'start'), between(own, body, gap, 'finish')] : [seat(joint, body, gap, middle, know)];
    const part = (made.get(String(place.part)) as Body).result as Body;
    const found = ['start', 'finish'].map((side, i) => {
      const surface = surfaces[Math.min(i, surfaces.length - 1)];
      const least = Math.min(...edges(place, made, side, know).map((p) => surface.distance(p)));
      const others = (((part.ends as Body)[side] as Body).cutter_ids as string[]).length !== 1; // that may keep the end off this chord
      return {least, others};
    });
    const near = found.reduce((best, next) => (Math.abs(next.least) < Math.abs(best.least) ? next : best));
    scope.most('joint_in_world', near.others ? -near.least : Math.abs(near.least), alike(request) + tolerance(request), 'mm', where);
  }
  if (joint.hole === 'cut') checkHoleInWorld(scope, joint, own, chord, members, made, know, where, alike(request));
}

const alike = (request: Body): number => ((request.alike_within_mm as number | undefined) ?? 0.02) + 1e-5;
const tolerance = (request: Body): number => ((request.sampling as Numbers | undefined)?.tolerance_mm ?? 0.05) + 1e-5;

/** The surface that the branch's end lies on. */
function seat(joint: Body, body: Body, gap: number, middle: V3, know: Knowledge): Solid {
  if (body.kind === 'plane') return facing(solid(body, 0, know.sizes), middle, gap);
  if ('start_mm' in body && isSection(body)) return boxOf(body, sectionOf(body, know.sections), gap);
  if (body.kind && body.kind !== 'round') return solid(body, gap, know.sizes);
  const {outer_diameter_mm, wall_mm} = sizeOf(body, know.sizes);
  const [point, along] = axisOfMember(body);
  return tube(String(body.id), point, along, outer_diameter_mm / 2 + (joint.kind === 'set_in' ? -((joint.depth_mm as number | undefined) ?? wall_mm) : gap));
}

/** The plane between two mitred members, half the gap towards the one. */
function between(own: Body, other: Body, gap: number, side: string): Solid {
  const mine = endOf(own, side);
  const near = norm(sub(v3(other.start_mm), mine[0])) <= norm(sub(v3(other.end_mm), mine[0])) ? 'start' : 'finish';
  const [point, normal] = mitrePlane(mine, endOf(other, near));
  return facing(plane('', point, normal, 0), mul(add(v3(own.start_mm), v3(own.end_mm)), 0.5), gap / 2);
}

/** The plane's distance grows towards the member, from `gap` off the plane on. */
function facing(flat: Solid, middle: V3, gap: number): Solid {
  const side = Math.sign(flat.distance(middle));
  return {...flat, distance: (p) => side * flat.distance(p) - gap};
}

/** Some hole of the chord stands where the branch is: its wall keeps the gap off it at the root. */
function checkHoleInWorld(
  scope: Scope,
  joint: Body,
  branch: Body,
  chord: string,
  members: Body[],
  made: Map<string, Body>,
  know: Knowledge,
  where: string,
  most: number,
): void {
  const place = members.find(({id}) => id === chord);
  const frame = place && frameOf(place);
  const part = place && made.get(String(place.part));
  if (!frame || !part || joint.kind === 'set_on') return;
  const target = (part.request as Body).target as Numbers;
  if (isSection(branch) || isSection(target as unknown as Body)) {
    scope.not('joints', 'holes in or for tubes that are not round are not looked at');
    return;
  }
  const r = target.outer_diameter_mm / 2 - target.wall_mm;
  const [point, along] = axisOfMember(branch);
  const wanted = sizeOf(branch, know.sizes).outer_diameter_mm / 2 + (joint.gap_mm as number);
  const off = list((part.result as Body).holes).map((hole) => {
    const points = hole.points as unknown as {[name: string]: number[]};
    const gaps = points.phi_inner_deg.map((deg, i) => lineDistance(toWorld(frame, onTube(r, deg * RAD, points.z_inner_mm[i])), point, along) - wanted);
    return Math.abs(Math.min(...gaps));
  });
  scope.most('hole_in_world', Math.min(...off), most, 'mm', where);
}
