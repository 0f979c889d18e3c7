/** Members by centre-lines: frames of their ends, and who cuts them (docs/theory/intersections-and-bevels.md, section 1.1 and 1.3). */
import type {Cut} from './bevel.js';
import type {Scope} from './report.js';
import {axisOf, type Body, boxOf, isSection, plane, sectionOf, type Solid, sizeOf, tube} from './solids.js';
import {add, across, cross, directionIn, dot, type Frame, inFrame, lineDistance, mul, norm, RAD, skew, sub, unit, type V3} from './space.js';
import {checkProfile} from './profiles.js';
import {boreOf, outsideOf} from './outline.js';
import {checkSectionProfile} from './section_curves.js';
import {checkSectionEnd} from './section_ends.js';
import {checkEnd, cutBy, type Knowledge, NO_SIZE} from './tables.js';

export interface Statement {
  kind: string;
  gap_mm: number;
  depth_mm?: number;
  plane?: string;
}

const v3 = (value: unknown) => value as V3;
export const byId = (list: Body[], id: unknown): Body => {
  const found = list.find((member) => member.id === id);
  if (!found) throw new Error(`no member ${id}`);
  return found;
};

export const axisOfMember = (member: Body): [V3, V3] => [v3(member.start_mm), unit(sub(v3(member.end_mm), v3(member.start_mm)))];

/** The work point of an end, and the direction from there into the member. */
export function endOf(member: Body, end: string): [V3, V3] {
  const [from, to] = end === 'start' ? ['start_mm', 'end_mm'] : ['end_mm', 'start_mm'];
  return [v3(member[from]), unit(sub(v3(member[to]), v3(member[from])))];
}

/** The statement of either of two members of their joint. */
export function stated(one: Body, other: Body): Statement | undefined {
  const of = (member: Body, partner: Body) => ((member.joints ?? []) as Body[]).find((joint) => joint.member === partner.id);
  return (of(one, other) ?? of(other, one)) as unknown as Statement | undefined;
}

/** The plane between two mitred ends, in the world: through the middle of the axes' nearest points, leaning alike to both. */
export function mitrePlane(a: [V3, V3], b: [V3, V3]): [V3, V3] {
  const [[p, u], [q, w]] = [a, b];
  const normal = unit(sub(u, w));
  const perpendicular = cross(u, w);
  const square = dot(perpendicular, perpendicular);
  if (square < Math.sin(0.5 * RAD) ** 2) return [mul(add(p, q), 0.5), normal];
  const between = sub(q, p);
  const s = dot(cross(between, w), perpendicular) / square;
  const t = dot(cross(between, u), perpendicular) / square;
  return [mul(add(add(p, mul(u, s)), add(q, mul(w, t))), 0.5), normal];
}

/** The member as a partner in the frame, by its joint with the target. */
/** How far a request keeps a cut off every partner, mm. */
interface Kept {
  coating: number;
  root: number;
}
const keptOff = ({coating_mm, root_gap_mm}: Body): Kept => ({coating: (coating_mm as number | undefined) ?? 0, root: (root_gap_mm as number | undefined) ?? 0});

export function partnerBy(member: Body, target: [V3, V3], joint: Statement, kept: Kept, frame: Frame, know: Knowledge): Solid {
  const away = kept.coating + Math.max(joint.gap_mm, kept.root); // stated both, they are equal
  const id = String(member.id);
  if (joint.kind === 'mitre') {
    const near = norm(sub(v3(member.start_mm), target[0])) <= norm(sub(v3(member.end_mm), target[0])) ? 'start' : 'finish';
    const [point, normal] = mitrePlane(target, endOf(member, near));
    return plane(id, inFrame(frame, point), directionIn(frame, normal), kept.coating + Math.max(joint.gap_mm / 2, kept.root));
  }
  if (isSection(member)) {
    const section = sectionOf(member, know.sections);
    return boxOf(member, section, joint.kind === 'set_in' ? -(joint.depth_mm ?? section.wall_mm) : away, frame);
  }
  const {outer_diameter_mm, wall_mm} = sizeOf(member, know.sizes);
  const radius = outer_diameter_mm / 2 + (joint.kind === 'set_in' ? -(joint.depth_mm ?? wall_mm) : away);
  const [point, along] = axisOfMember(member);
  return tube(id, inFrame(frame, point), directionIn(frame, along), radius);
}

/** The frame of an end: with `up` on that side, else so that the first partner has clocking 0. */
export function frameOf(member: Body, end: string, first: Body | undefined): Frame {
  const [origin, z] = endOf(member, end);
  if (member.up) {
    const x = unit(across(v3(member.up), z));
    return {origin, x, y: cross(z, x), z};
  }
  const along = first ? axisOfMember(first)[1] : ([1, 0, 0] as V3);
  const y = mul(unit(across(along, z)), -1);
  return {origin, x: cross(y, z), y, z};
}

/** A table or profile of one end of a node, by the ids of the members that cut it. */
export function cutOfNode(request: Body, ids: string[], know: Knowledge): Cut {
  const node = request.node as Body;
  const members = node.members as Body[];
  const target = byId(members, node.member);
  const partners = ids.map((id) => byId(members, id));
  const frame = frameOf(target, String(node.end), partners[0]);
  return cutInFrame(request, members, target, String(node.end), ids, frame, know);
}

export function cutInFrame(request: Body, members: Body[], target: Body, end: string, ids: string[], frame: Frame, know: Knowledge): Cut {
  const own = endOf(target, end);
  const kept = keptOff(request);
  const solids = ids.map((id) => {
    const member = byId(members, id);
    return partnerBy(member, own, stated(target, member) ?? found(own, member), kept, frame, know);
  });
  const {outer_diameter_mm, wall_mm} = isSection(target) ? NO_SIZE : sizeOf(target, know.sizes);
  return cutBy(request, outer_diameter_mm / 2, wall_mm, solids);
}

/** Of two that state nothing: in line they are mitred, else the one is set on the other. */
function found([point, along]: [V3, V3], member: Body): Statement {
  const near = norm(sub(v3(member.start_mm), point)) <= norm(sub(v3(member.end_mm), point)) ? 'start' : 'finish';
  const inLine = dot(along, endOf(member, near)[1]) < -Math.cos(15 * RAD);
  return {kind: inLine ? 'mitre' : 'set_on', gap_mm: 0};
}

/** From a point to the axis of a member, between its ends. */
function toAxis(p: V3, member: Body): number {
  const [a, b] = [v3(member.start_mm), v3(member.end_mm)];
  const along = sub(b, a);
  const t = Math.min(1, Math.max(0, dot(sub(p, a), along) / dot(along, along)));
  return norm(sub(p, add(a, mul(along, t))));
}

export function checkNodes(scope: Scope, request: Body, result: Body, know: Knowledge): void {
  const members = request.members as Body[];
  const options = {...(request.tables as Body | undefined), sampling: request.sampling ?? null} as Body;
  for (const made of result.ends as Body[]) {
    const ends = scope.under('ends/*');
    const where = `${made.member} ${made.end}`;
    const target = byId(members, made.member);
    const f = made.frame as Body;
    const frame: Frame = {origin: v3(f.origin_mm), x: v3(f.x), y: v3(f.y), z: v3(f.z)};
    const own = endOf(target, String(made.end));
    ends.most('frame', skew(frame), 1e-12, '', where);
    ends.most('frame_origin', norm(sub(frame.origin, own[0])), 2e-10, 'mm', where);
    ends.most('frame_axis', norm(sub(frame.z, own[1])), 1e-12, '', where);
    if (target.up) ends.most('frame_up', norm(sub(frame.x, unit(across(v3(target.up), frame.z)))), 1e-9, '', where);
    ends.covers('frame/origin_mm/*', 'frame/x/*', 'frame/y/*', 'frame/z/*');
    const partners = (made.cut_by as Body[]).map((by): Solid => {
      const other = byId(members, by.member);
      const joint = by.joint as unknown as Statement;
      const says = stated(target, other);
      if (says) ends.equal('joint', joint.kind, says.kind, where);
      ends.equal('joint', joint.gap_mm, says?.gap_mm ?? 0, where);
      const axis = axisOfMember(other);
      ends.same('gap', by.gap_mm as number, toAxis(own[0], other), 1e-12 * (1 + norm(own[0]) + (by.gap_mm as number)), 'mm', where);
      ends.covers('cut_by/*/gap_mm', 'cut_by/*/joint/gap_mm');
      if (by.placement) checkPlacement(ends, by, axis, frame, own, where);
      else checkMitre(ends, by, other, own, frame, where);
      return partnerBy(other, own, joint, {coating: 0, root: 0}, frame, know);
    });
    if (isSection(target)) {
      checkSectionOfNode(ends, request, made, target, partners, {own, frame, know, options});
      continue;
    }
    const {outer_diameter_mm, wall_mm} = sizeOf(target, know.sizes);
    for (const profile of made.profiles as Body[]) {
      checkProfile(ends.under('profiles/*'), cutBy(options, outer_diameter_mm / 2, wall_mm, partners), profile, request.sampling);
    }
    const kept = keptOff(options);
    if (made.table) {
      const solids = (made.cut_by as Body[]).map((by) => partnerBy(byId(members, by.member), own, by.joint as unknown as Statement, kept, frame, know));
      checkEnd(ends.under('table'), cutBy(options, outer_diameter_mm / 2, wall_mm, solids), made.table as Body, know);
    }
  }
}

interface Seen {
  own: [V3, V3];
  frame: Frame;
  know: Knowledge;
  options: Body;
}

function checkSectionOfNode(ends: Scope, request: Body, made: Body, target: Body, partners: Solid[], {own, frame, know, options}: Seen): void {
  const section = sectionOf(target, know.sections);
  const whole = (solids: Solid[]) => ({cut: cutBy(options, 0, 0, solids), outer: outsideOf(section), bore: boreOf(section)});
  for (const profile of (made.profiles ?? []) as Body[]) checkSectionProfile(ends.under('profiles/*'), whole(partners), profile);
  if (!made.table) return;
  const kept = keptOff(options);
  const members = request.members as Body[];
  const solids = (made.cut_by as Body[]).map((by) => partnerBy(byId(members, by.member), own, by.joint as unknown as Statement, kept, frame, know));
  checkSectionEnd(ends.under('table'), whole(solids), made.table as Body, know);
}

/** The placement's own line is the partner's axis. */
function checkPlacement(scope: Scope, by: Body, [point, along]: [V3, V3], frame: Frame, own: [V3, V3], where: string): void {
  const placement = by.placement as {[name: string]: number};
  const [q, d] = axisOf(placement as unknown as Body);
  const [p, e] = [inFrame(frame, point), directionIn(frame, along)];
  const size = 1 + norm(p) + Math.abs(placement.height_mm);
  scope.most('placement_axis', lineDistance(q, p, e), 3e-12 * size, 'mm', where);
  scope.most('placement_direction', norm(cross(d, e)), 1e-11, '', where);
  scope.most('placement_foot', Math.abs(dot(sub(q, [0, 0, q[2]]), e)), 3e-12 * size, 'mm', where);
  scope.same('placement_inclination', Math.cos(placement.inclination_deg * RAD), dot(d, [0, 0, 1]), 1e-12, '', where);
  const apart = Math.abs(dot(sub(point, own[0]), unit(cross(along, own[1]))));
  scope.same('eccentricity', by.eccentricity_mm as number, apart, 3e-12 * size, 'mm', where);
  scope.covers('cut_by/*/eccentricity_mm', ...['inclination_deg', 'clocking_deg', 'offset_mm', 'height_mm'].map((name) => `cut_by/*/placement/${name}`));
}

function checkMitre(scope: Scope, by: Body, other: Body, own: [V3, V3], frame: Frame, where: string): void {
  const made = by.plane as Body;
  if ((by.joint as Body).plane !== 'bisecting') {
    scope.not('cut_by/*/plane', 'a mitre from corner to corner');
    return;
  }
  const near = norm(sub(v3(other.start_mm), own[0])) <= norm(sub(v3(other.end_mm), own[0])) ? 'start' : 'finish';
  const [point, normal] = mitrePlane(own, endOf(other, near));
  const [p, n] = [inFrame(frame, point), directionIn(frame, normal)];
  scope.most('mitre_normal', norm(sub(v3(made.normal), n)), 1e-9, '', where);
  scope.most('mitre_point', Math.abs(dot(sub(v3(made.point_mm), p), n)), 1e-9 * (1 + norm(p)), 'mm', where);
  scope.covers('cut_by/*/plane/normal/*');
}
