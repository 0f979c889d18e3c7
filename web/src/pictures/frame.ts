import {rowsOf, type Json, type Row} from '../json';
import {many, t} from '../language';
import {heightsOf, reachOf, type Assembly, type Frame, type MemberPart, type Partner, type Picture, type Solid, type Table, type Vector} from '../picture';
import type {Answer} from '../service';
import {shownUnit} from '../units';
import {choice, sentences, term, withUnit} from '../words';
import type {Context} from './context';
import {figures, text} from './facts';
import {itemsOf, lightsOf, size, standings, told, toneOf, type Told} from './frame_items';
import {platesIn, plateTable} from './frame_plates';
import {add, bounds, dot, frame, partner, placed, squareEnd, tube, unitVector, vector, type Sizes} from './geometry';
import {finished} from './part';
import {openingsOf} from './section_part';
import {endOf, girthOf, shellOf, squareShell, type ShellEnd} from './section_solid';

const link = 'frame';

/** Returns the finished parts in their positions in the world. */
export async function wholeFrame(_: Row, answer: Answer, context: Context): Promise<Picture> {
  const given = told(answer);
  const {result, request} = answer;
  const totals = result['totals'] as Row;
  const notCut = rowsOf(result['not_cut']);
  const plates = rowsOf(request['plates']);
  const said = [
    many(given.members.length, '{n} member', '{n} members'),
    many(given.cuts.length, '{n} different part', '{n} different parts'),
    many(given.joints.length, '{n} joint', '{n} joints'),
    ...(plates.length ? [many(plates.length, '{n} plate', '{n} plates')] : []),
  ].join(t(', '));
  return {
    solid: solidOf(given, rowsOf(request['others']), context.sizes, said),
    charts: [],
    figures: figures(
      totals,
      Object.keys(totals).filter((key) => key !== 'made' || totals['made'] !== totals['members']),
      'totals',
    ),
    said: t('{text}; {mass} in all.', {text: said, mass: withUnit(Number(totals['mass_kg']), 'kg')}),
    inspected: {link, lists: itemsOf(given)},
    tables: [cutList(given.cuts), ...plateTable(given), ...(notCut.length ? [notCutTable(notCut)] : [])],
  };
}

function cutList(cuts: Row[]): Table {
  const lengths = ['long_mm', 'blank_mm', 'girth_mm', 'mass_kg', 'weld_mm'];
  const head = ['part', 'count'].map((key) => term(key, 'cut_list'));
  return {
    id: 'cut_list',
    title: t('Cut list'),
    names: true,
    head: [
      ...head,
      {text: `${t('size')} ${shownUnit('mm')}`, about: t('Outer diameter × wall, or height × width × wall.')},
      ...lengths.map((key) => term(key, 'cut_list')),
      term('verdict'),
    ],
    rows: cuts.map((cut) => [
      {text: String(cut['part']), about: (cut['members'] as string[]).join(', ')},
      text('count', cut['count']),
      size(cut),
      ...lengths.map((key) => text(key, cut[key])),
      choice(cut['verdict']),
    ]),
  };
}

const notCutTable = (rows: Row[]): Table => ({
  id: 'not_cut',
  title: t('Not cut'),
  names: true,
  head: ['id', 'end', 'why'].map((key) => term(key)),
  rows: rows.map((row) => [String(row['id']), ...['end', 'why'].map((key) => text(key, row[key]))]),
});

function solidOf(given: Told, others: Row[], sizes: Sizes, said: string): Solid {
  const lines = rowsOf(given.answer.request['members']);
  const assembly = assemblyOf(given, lines);
  const corners = assembly.members.flatMap(({part, frame: to}) => {
    const own = assembly.parts[part] as MemberPart;
    const outer = reachOf(own);
    return bounds(heightsOf(own).flat()).flatMap((z) => [-outer, outer].map((x) => placed(to, [x, x, z])));
  });
  const plates = platesIn(given);
  corners.push(...plates.flatMap(({frame: to, outline}) => outline.map(([x, y]) => placed(to, [x, y, 0]))));
  const box = [0, 1, 2].map((k) => bounds(corners.map((p) => p[k] as number)));
  const centre = box.map(([low, high]) => (low + high) / 2) as Vector;
  const extent = box.map(([low, high]) => high - low);
  const there = standings.filter((standing) => given.standing.includes(standing));
  return {
    link,
    tubes: [],
    assembly,
    plates,
    partners: partners(given, lines, others, sizes),
    legend: [...there.map((standing) => ({tone: toneOf(standing), text: choice(standing)})), ...(plates.length ? [{tone: 'plate', text: t('plate')}] : [])],
    told: sentences(
      t('{text}.', {text: said}),
      there.map((standing) => `${choice(standing)}: ${given.standing.filter((each) => each === standing).length}`).join(', '),
    ),
    centre,
    size: Math.hypot(...extent),
    eye: eyeOn(extent),
    up: [0, 0, 1],
  };
}

/** A flat frame is looked at from before its plane. */
function eyeOn(extent: number[]): Vector {
  const least = Math.min(...extent);
  if (least > 0.35 * Math.max(...extent)) return [0.75, -1, 0.5];
  if (least === extent[0]) return [1, -0.3, 0.3];
  return least === extent[1] ? [0.3, -1, 0.3] : [0.15, -0.6, 1];
}

/** A member without a part is drawn as the tube it would be cut from. */
function assemblyOf(given: Told, lines: Row[]): Assembly {
  const parts = given.cuts.map((cut, i): MemberPart => {
    const line = lines.find((each) => each['id'] === cut['part']);
    if ('height_mm' in cut) return sectionMember(cut, given.parts[i], line);
    const dimensions = {outer: Number(cut['outer_diameter_mm']), wall: Number(cut['wall_mm'])};
    const made = given.parts[i]?.['answer'] as unknown as Answer | undefined;
    if (made) return finished(made.result, dimensions);
    return {...finishedPlain(dimensions), to: squareEnd(line ? lengthOf(line) : 0)};
  });
  const members = given.members.map((member, i) => ({
    name: String(member['id']),
    part: given.part[i] as number,
    frame: frame(member['frame']) ?? along(lines[i] as Row),
    tone: toneOf(given.standing[i] as string),
  }));
  const {request} = given.answer;
  const others = rowsOf(request['others']);
  return {parts, members, lights: lightsOf(given), joints: jointsOf(given, {parts, members}, lines, [...others, ...rowsOf(request['plates'])])};
}

/** A part that is not round; if it is missing, its tube from work point to work point. */
function sectionMember(cut: Row, given: Row | undefined, line: Row | undefined): MemberPart {
  const made = given?.['answer'] as unknown as Answer | undefined;
  const section = made ? (made.result['section'] as Row) : {...cut, corner_radius_mm: 2 * Number(cut['wall_mm'])};
  const points = ['start', 'finish'].map((side) => made && ((made.result['ends'] as Row)[side] as Row)['points']) as [Row?, Row?];
  const ends = points.map((each, i) => (each ? endOf(section, each) : squareShell(section, i && line ? lengthOf(line) : 0))) as [ShellEnd, ShellEnd];
  const girth = girthOf(section);
  return {...shellOf(ends, {outer: girth, inner: girth}), openings: made ? openingsOf(section, made.result) : []};
}

/** Returns the joints: where branches end on their partners, or pass through them. */
function jointsOf(given: Told, {parts, members}: Pick<Assembly, 'parts' | 'members'>, lines: Row[], others: Row[]): Assembly['joints'] {
  const places = new Map(members.map(({name}, i) => [name, i]));
  return given.joints.flatMap((joint, j) => {
    const [branch, chord] = [places.get(String(joint['branch'])), places.get(String(joint['chord']))];
    const other = others.find((each) => each['id'] === joint['chord']);
    if (branch === undefined || (chord === undefined && !other)) return [];
    const {frame: own, part: at} = members[branch] as Assembly['members'][number];
    const ends = heightsOf(parts[at] as MemberPart).map((z) => placed(own, [0, 0, bounds(z).reduce((a, b) => a + b) / 2])) as [Vector, Vector];
    const [origin, along, flat] = chord === undefined ? [...placeOf(other as Row), isFlat(other as Row)] : [...axisOf(lines[chord] as Row), false];
    const off = (p: Vector) => distance(p, origin, along, flat);
    const middle = joint['kind'] === 'through' ? (flat ? crossing : passing)(ends, origin, along) : undefined;
    const item = given.members.length + j;
    return [{at: middle ?? ends.reduce((a, b) => (off(b) < off(a) ? b : a)), item, of: chord === undefined ? [branch] : [branch, chord]}];
  });
}

const isFlat = (other: Row) => other['kind'] === 'plane' || 'thickness_mm' in other;
const axisOf = (line: Row): [Vector, Vector] => {
  const [start, end] = lineOf(line);
  return [start, unitVector(add(end, start, -1))];
};

/** Of a point to a plane by its normal, or to an axis by its direction. */
function distance(p: Vector, origin: Vector, direction: Vector, flat: boolean): number {
  const from = add(p, origin, -1);
  const rise = dot(from, direction);
  return flat ? Math.abs(rise) : Math.hypot(...add(from, direction, -rise));
}

/** Where a line crosses a plane. */
function crossing([start, end]: [Vector, Vector], origin: Vector, normal: Vector): Vector {
  const [from, to] = [start, end].map((p) => dot(add(p, origin, -1), normal)) as [number, number];
  const share = from === to ? 0.5 : from / (from - to);
  return add(start, add(end, start, -1), Math.min(1, Math.max(0, share)));
}

/** Where a line passes an axis. */
function passing([start, end]: [Vector, Vector], origin: Vector, axis: Vector): Vector {
  const across = (v: Vector) => add(v, axis, -dot(v, axis));
  const [way, from] = [across(add(end, start, -1)), across(add(start, origin, -1))];
  const share = dot(way, way) > 0 ? -dot(way, from) / dot(way, way) : 0.5;
  return add(start, add(end, start, -1), Math.min(1, Math.max(0, share)));
}

const finishedPlain = ({outer, wall}: {outer: number; wall: number}) => ({outer: outer / 2, inner: outer / 2 - wall, from: squareEnd(0), holes: []});

const lineOf = (row: Row): [Vector, Vector] => [vector(row['start_mm']), vector(row['end_mm'])];
const lengthOf = (row: Row) => Math.hypot(...add(...(lineOf(row).reverse() as [Vector, Vector]), -1));

/** A frame with z along a centre-line, and x on the side of its `up`, if it has one. */
function along(row: Row): Frame {
  const [start, end] = lineOf(row);
  const z = unitVector(add(end, start, -1));
  const least = z.map(Math.abs).indexOf(Math.min(...z.map(Math.abs)));
  const axis = row['up'] ? vector(row['up']) : ([0, 1, 2].map((k) => (k === least ? 1 : 0)) as Vector);
  const x = unitVector(add(axis, z, -dot(axis, z)));
  return {origin: start, x, y: [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]], z};
}

/** Returns the other bodies, in the size that their joints need. */
function partners(given: Told, lines: Row[], others: Row[], sizes: Sizes): Partner[] {
  const byId = new Map(lines.map((line) => [line['id'], line]));
  return others.map((other, tone) => {
    const [origin, direction] = placeOf(other);
    const joined = given.joints.filter((joint) => joint['chord'] === other['id']).map((joint) => byId.get(joint['branch'] as Json) as Row);
    const off = (p: Vector) => distance(p, origin, direction, other['kind'] === 'plane');
    const ends = joined.map((line) => lineOf(line).reduce((a, b) => (off(b) < off(a) ? b : a)));
    const near = ends.length ? ends.reduce<Vector>((sum, p) => add(sum, p, 1 / ends.length), [0, 0, 0]) : origin;
    const spread = Math.max(0, ...ends.map((p) => Math.hypot(...add(p, near, -1))));
    const widest = Math.max(...joined.map((line) => tube(line, sizes).outer), 0) || tube(other, sizes).outer;
    const body = partner(other, tone, near, 1.45 * spread + 2 * widest, sizes);
    return body.kind === 'elbow' ? {...body, half: legsOf(body, ends, widest)} : body;
  });
}

/** A point of a body and its normal or axis. */
function placeOf(other: Row): [Vector, Vector] {
  const axis = (other['axis'] ?? other) as Row;
  return [vector(axis['point_mm']), unitVector(vector(axis['direction'] ?? axis['normal']))];
}

/** Returns the lengths of a bend's straight legs that its joints need. */
function legsOf({point, direction, inwards, bend, angle}: Extract<Partner, {kind: 'elbow'}>, ends: Vector[], least: number): [number, number] {
  const towards = unitVector(add(inwards, direction, -dot(inwards, direction)));
  const out = add(direction.map((v) => v * Math.cos(angle)) as Vector, towards, Math.sin(angle));
  const arcEnd = add(add(point, towards, bend * (1 - Math.cos(angle))), direction, bend * Math.sin(angle));
  const leg = (from: Vector, way: Vector) => least + Math.max(0, ...ends.map((p) => dot(add(p, from, -1), way)));
  return [leg(point, direction.map((v) => -v) as Vector), leg(arcEnd, out)];
}
