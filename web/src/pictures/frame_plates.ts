import {rowsOf, type Json, type Row} from '../json';
import {many, t} from '../language';
import type {Inspected, Item, Plate, Table, Vector} from '../picture';
import type {Answer} from '../service';
import {shownUnit} from '../units';
import {term} from '../words';
import {figures, text} from './facts';
import {add, dot, radians, unitVector, vector} from './geometry';

type Flat = Plate['outline'][number];
/** An answer with its joints. */
interface Joined {
  answer: Answer;
  joints: Row[];
}

const platesOf = (given: Joined) => rowsOf(given.answer.result['plates']);
const idsOf = (plate: Row) => plate['ids'] as string[];
/** "250 × 250 × 20" */
const size = (plate: Row) => ['width_mm', 'height_mm', 'thickness_mm'].map((key) => text(key, plate[key])).join(' × ');

/** Returns every plate at its place in the world. */
export function platesIn(given: Joined): Plate[] {
  const kinds = new Map(platesOf(given).flatMap((kind) => idsOf(kind).map((id) => [id, kind])));
  return rowsOf(given.answer.request['plates']).flatMap((asked) => {
    const kind = kinds.get(String(asked['id']));
    if (!kind) return [];
    const z = unitVector(vector(asked['normal']));
    const up = vector(asked['up']);
    const y = unitVector(add(up, z, -dot(up, z)));
    const x: Vector = [y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]];
    return [
      {
        frame: {origin: vector(asked['point_mm']), x, y, z},
        thickness: Number(kind['thickness_mm']),
        outline: contour(kind['outline'] as Row),
        holes: rowsOf(kind['holes']).map(contour),
      },
    ];
  });
}

/** Returns the corners of a contour, and points of its arcs no more than 7.5 deg apart. */
function contour(row: Row): Flat[] {
  const [x, y] = (row['at_mm'] ?? [0, 0]) as Flat;
  if ('diameter_mm' in row) return arc([x, y], Number(row['diameter_mm']) / 2, 0, 2 * Math.PI);
  const out: Flat[] = [];
  let from = row['start_mm'] as Flat;
  for (const piece of rowsOf(row['pieces'])) {
    const to = piece['to_mm'] as Flat;
    out.push(from, ...(piece['kind'] === 'arc' ? between(from, to, piece) : []));
    from = to;
  }
  return out;
}

function between(from: Flat, to: Flat, piece: Row): Flat[] {
  const centre = piece['centre_mm'] as Flat;
  const sense = piece['sense'] === 'ccw' ? 1 : -1;
  const angle = (p: Flat) => Math.atan2(p[1] - centre[1], p[0] - centre[0]);
  const turn = (sense * (angle(to) - angle(from)) + 4 * Math.PI) % (2 * Math.PI) || 2 * Math.PI;
  return arc(centre, Math.hypot(from[0] - centre[0], from[1] - centre[1]), angle(from), sense * turn).slice(1);
}

/** Returns the first point of an arc and those on it; not its end. */
function arc([x, y]: Flat, radius: number, from: number, turn: number): Flat[] {
  const count = Math.max(2, Math.ceil(Math.abs(turn) / (7.5 * radians)));
  const at = (i: number) => from + (turn * i) / count;
  return Array.from({length: count}, (_, i): Flat => [x + radius * Math.cos(at(i)), y + radius * Math.sin(at(i))]);
}

export function plateTable(given: Joined): Table[] {
  const plates = platesOf(given);
  if (plates.length === 0) return [];
  const keys = ['area_mm2', 'mass_kg', 'web_mm'];
  return [
    {
      id: 'plates',
      title: t('Plates'),
      names: true,
      head: [
        ...['plate', 'count'].map((key) => term(key, 'plates')),
        {text: `${t('size')} ${shownUnit('mm')}`, about: t('Width × height × thickness.')},
        term('holes', 'plates'),
        ...keys.map((key) => term(key, 'plates')),
      ],
      rows: plates.map((plate) => [
        {text: String(plate['plate']), about: idsOf(plate).join(', ')},
        text('count', plate['count']),
        size(plate),
        String(rowsOf(plate['holes']).length),
        ...keys.map((key) => (key in plate ? text(key, plate[key]) : '')),
      ]),
    },
  ];
}

/** Returns the different plates, each with the members on it, by their places in the list of items. */
export function plateItems(given: Joined, place: Map<string, number>): Inspected['lists'] {
  const plates = platesOf(given);
  return plates.length ? [{id: 'plates', title: t('Plates'), items: plates.map((plate) => plateItem(given, plate, place))}] : [];
}

function plateItem(given: Joined, plate: Row, place: Map<string, number>): Item {
  return {
    name: String(plate['plate']),
    detail: [size(plate), many(Number(plate['count']), '{n} piece', '{n} pieces')].join(t(', ')),
    facts: () => ({
      said: [
        plate['count'] === 1 ? t('The only one of its kind.') : t('{n} alike, made as {part}.', {n: Number(plate['count']), part: String(plate['plate'])}),
      ],
      figures: figures(plate, ['thickness_mm', 'width_mm', 'height_mm', 'area_mm2', 'mass_kg', 'web_mm'], 'plates'),
      warnings: [],
      leads: membersOn(given, plate).flatMap((name) => (place.has(name) ? [{name, to: place.get(name) as number}] : [])),
    }),
  };
}

export const membersOn = (given: Joined, plate: Row): string[] =>
  given.joints.filter((joint) => idsOf(plate).includes(String(joint['chord']))).map((joint) => String(joint['branch']));

/** The members that each plate's item lights up. */
export const plateLights = (given: Joined, placed: (ids: Json[]) => number[]): number[][] => platesOf(given).map((plate) => placed(membersOn(given, plate)));
