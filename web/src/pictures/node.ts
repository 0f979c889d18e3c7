import {isRow, rowsOf, type Json, type Row} from '../json';
import {many, t} from '../language';
import {usualCut} from '../onward';
import {column, type Assembly, type EndCurve, type Facts, type Frame, heightsOf, type Item, type MemberPart, type Picture, type Vector} from '../picture';
import type {Answer} from '../service';
import {choice, sentence, term} from '../words';
import {atPhi} from './cut';
import {figures, text} from './facts';
import {size} from './frame_items';
import type {Context} from './context';
import {add, bounds, dot, frame, onTube, placed, radians, squareEnd, tube, vector, type Sizes} from './geometry';
import {edgeOf, girthOf, shellOf, squareShell, type ShellEnd} from './section_solid';

const link = 'node';

/** The whole node in the world, every end as it is cut; a click on a member leads to its part. */
export async function node(body: Row, answer: Answer, context: Context): Promise<Picture> {
  const members = rowsOf(answer.request['members']);
  let ends = answer.result['ends'] as Row[];
  if (!body['include']) {
    // the curves are for the picture only
    const whole = await context.ask('nodes', {...body, include: ['profiles']});
    ends = whole.result['ends'] as Row[];
  }
  const cut = ends.filter((end) => (end['cut_by'] as Row[]).length > 0);
  const free = ends.filter((end) => end['free']).length;
  const said = [
    many(members.length, '{n} member', '{n} members'),
    many(cut.length, '{n} end cut', '{n} ends cut'),
    many(free, '{n} free end', '{n} free ends'),
  ].join(t(', '));
  const assembly = assemblyOf(members, ends, context.sizes);
  const corners = assembly.members.flatMap(({part, frame: to}) => {
    return bounds(heightsOf(assembly.parts[part] as MemberPart).flat()).map((z) => placed(to, [0, 0, z]));
  });
  const box = [0, 1, 2].map((k) => bounds(corners.map((p) => p[k] as number)));
  return {
    solid: {
      link,
      tubes: [],
      assembly,
      partners: [],
      told: said,
      centre: box.map(([low, high]) => (low + high) / 2) as Vector,
      size: Math.hypot(...box.map(([low, high]) => high - low)),
      eye: [0.3, -1, 0.4],
      up: [0, 0, 1],
    },
    charts: [],
    said: t('{text}.', {text: said}),
    inspected: {link, lists: [{id: 'members', title: t('Members'), items: members.map((_, i) => item(answer.request, members, ends, i, context.sizes))}]},
    figures: [
      {name: t('members'), value: String(members.length)},
      {name: t('cut ends'), value: String(cut.length)},
      {name: t('free ends'), value: String(free)},
    ],
    tables: [whoCutsWhom(cut)],
  };
}

const placements = ['inclination_deg', 'clocking_deg', 'offset_mm', 'height_mm'];

const whoCutsWhom = (cut: Row[]) => ({
  title: t('Who cuts whom'),
  names: true as const,
  head: [t('member'), t('end'), t('cut by'), ...placements.map((key) => term(key)), term('gap_mm'), term('eccentricity_mm')],
  rows: cut.flatMap((end) =>
    (end['cut_by'] as Row[]).map((by) => {
      const p = by['placement']; // a mitre is by a plane
      return [
        String(end['member']),
        choice(end['end']),
        String(by['member']),
        ...placements.map((key) => (isRow(p) ? text(key, p[key]) : '–')),
        text('gap_mm', by['gap_mm']),
        text('eccentricity_mm', by['eccentricity_mm']),
      ];
    }),
  ),
});

const tone = (i: number) => `partner-${i % 6}`;
const lineOf = (member: Row): [Vector, Vector] => [vector(member['start_mm']), vector(member['end_mm'])];
const lengthOf = (member: Row) => Math.hypot(...add(...(lineOf(member).reverse() as [Vector, Vector]), -1));
const endOf = (ends: Row[], id: Json | undefined, side: string) => ends.find((end) => end['member'] === id && end['end'] === side) as Row;

function item(request: Row, members: Row[], ends: Row[], i: number, sizes: Sizes): Item {
  const member = members[i] as Row;
  const id = String(member['id']);
  const own = ['start', 'finish'].map((side) => endOf(ends, id, side)) as [Row, Row];
  const section = own[0]['section'];
  const round = tube(member, sizes);
  const dimensions: Row = isRow(section)
    ? {height_mm: section['height_mm'] as Json, width_mm: section['width_mm'] as Json, wall_mm: section['wall_mm'] as Json}
    : {outer_diameter_mm: round.outer, wall_mm: round.wall};
  const cutters = own.flatMap((end) => rowsOf(end['cut_by']).map((by) => String(by['member'])));
  const facts = (): Facts => ({
    said: own.map((end) => {
      const by = rowsOf(end['cut_by']).map((each) => String(each['member']));
      return t('{part}: {text}.', {part: sentence(choice(end['end'])), text: by.length ? t('cut by {names}', {names: by.join(', ')}) : t('free')});
    }),
    figures: figures({...dimensions, length_mm: lengthOf(member)}, [...Object.keys(dimensions), 'length_mm']),
    warnings: [],
    leads: [...new Set(cutters)].map((name) => ({name, to: members.findIndex((each) => each['id'] === name)})).filter(({to}) => to >= 0),
    opens: {name: t('Go on to its part'), endpoint: 'parts', body: partOf(request, id)},
  });
  return {name: id, detail: size(dimensions), mark: {text: '', tone: tone(i)}, facts};
}

/** The part of a member, cut as the node's tables are, or as usual. */
function partOf(request: Row, member: string): Row {
  const tables = isRow(request['tables']) ? request['tables'] : {};
  const {dihedral: _, ...cut} = {...usualCut, ...tables};
  return {members: request['members'] as Json, connect: request['connect'] as Json, member, ...cut};
}

/** Returns every member from end to end; if it extends far beyond the node, only the near part. */
function assemblyOf(members: Row[], ends: Row[], sizes: Sizes): Assembly {
  const widest = Math.max(...members.map((member) => widthOf(endOf(ends, member['id'], 'start')['section'], member, sizes)));
  const joints = ends.filter((end) => rowsOf(end['cut_by']).length).map((end) => vector((end['frame'] as Row)['origin_mm']));
  const parts = members.map((member): MemberPart => {
    const {outer, wall} = tube(member, sizes);
    const [start, finish] = ['start', 'finish'].map((side) => endOf(ends, member['id'], side)) as [Row, Row];
    const to = frame(start['frame']) as Frame;
    const along = joints.map((point) => dot(add(point, to.origin, -1), to.z));
    const [low, high] = joints.length ? bounds(along) : [-Infinity, Infinity];
    const [least, most] = [Math.max(0, low - 2.2 * widest), Math.min(lengthOf(member), high + 2.2 * widest)];
    if (isRow(start['section'])) return shellBetween(start, finish, to, start['section'], [least, most]);
    const radii: [number, number] = [outer / 2, outer / 2 - wall];
    return {
      outer: radii[0],
      inner: radii[1],
      from: curveOf(start) ?? squareEnd(least),
      to: seen(finish, to, radii) ?? squareEnd(most),
      holes: [],
    };
  });
  return {
    parts,
    members: members.map((member, i) => ({
      name: String(member['id']),
      part: i,
      frame: frame(endOf(ends, member['id'], 'start')['frame']) as Frame,
      tone: tone(i),
    })),
    lights: members.map((_, i) => [i]),
  };
}

const widthOf = (section: Json | undefined, member: Row, sizes: Sizes) =>
  isRow(section) ? Math.hypot(Number(section['height_mm']), Number(section['width_mm'])) : tube(member, sizes).outer;

/** A member that is not round, in the frame of its start; an end without curves is cut square. */
function shellBetween(start: Row, finish: Row, to: Frame, section: Row, [low, high]: [number, number]): MemberPart {
  const wall = Number(section['wall_mm']);
  const bore = {
    height_mm: Number(section['height_mm']) - 2 * wall,
    width_mm: Number(section['width_mm']) - 2 * wall,
    corner_radius_mm: Number(section['inner_corner_radius_mm']),
  };
  const whole = {outer: girthOf(section), inner: girthOf(bore)};
  const from = shellEnd(start) ?? squareShell(section, low, bore);
  return shellOf([from, turnedRound(shellEnd(finish), whole, frame(finish['frame']) as Frame, to) ?? squareShell(section, high, bore)], whole);
}

function shellEnd(end: Row): ShellEnd | undefined {
  const [outer, inner] = ['outer', 'inner'].map((surface) => {
    const points = rowsOf(end['profiles']).find((each) => each['surface'] === surface)?.['points'] as Row | undefined;
    return points && {girth: column(points['girth_mm']), at: edgeOf(points)};
  });
  return outer && inner && {outer, inner};
}

/** A finish, which is seen from its own end, in the frame of the start: its way round runs against it. */
function turnedRound(end: ShellEnd | undefined, whole: {outer: number; inner: number}, own: Frame, to: Frame): ShellEnd | undefined {
  if (!end) return undefined;
  const turned = ({girth, at}: ShellEnd['outer'], all: number) => {
    const points = at.map((p) => add(placed(own, p), to.origin, -1)).map((p): Vector => [dot(p, to.x), dot(p, to.y), dot(p, to.z)]);
    const order = girth.map((_, i) => i).reverse();
    const way = (i: number) => (all - (girth[i] as number)) % all;
    order.sort((a, b) => way(a) - way(b));
    return {girth: order.map(way), at: order.map((i) => points[i] as Vector)};
  };
  return {outer: turned(end.outer, whole.outer), inner: turned(end.inner, whole.inner)};
}

function curveOf(end: Row): EndCurve | undefined {
  const profiles = rowsOf(end['profiles']);
  const [outside, inside] = ['outer', 'inner'].map((surface) => profiles.find((each) => each['surface'] === surface)?.['points'] as Row | undefined);
  if (!outside || !inside) return undefined;
  const phi = column(outside['phi_deg']);
  return {phi, zOuter: column(outside['z_mm']), zInner: atPhi(inside, phi)};
}

/** The finish's curve in the frame of the start. */
function seen(finish: Row, to: Frame, [outer, inner]: [number, number]): EndCurve | undefined {
  const curve = curveOf(finish);
  if (!curve) return undefined;
  const own = frame(finish['frame']);
  const turned = (radius: number, z: number[]) => curve.phi.map((phi, i) => add(placed(own, onTube(radius, phi, z[i] as number)), to.origin, -1));
  const [outside, inside] = [turned(outer, curve.zOuter), turned(inner, curve.zInner)];
  return {
    phi: outside.map((p) => Math.atan2(dot(p, to.y), dot(p, to.x)) / radians),
    zOuter: outside.map((p) => dot(p, to.z)),
    zInner: inside.map((p) => dot(p, to.z)),
  };
}
