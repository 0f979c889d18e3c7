import type {LengthUnit} from '../units.js';
import {unitNamed} from './numbers.js';

/**
 * Fields of a member's row, by the names of the request's; for points the axes one by one, or two
 * nodes.
 */
export const fields = [
  'id',
  'start_x',
  'start_y',
  'start_z',
  'end_x',
  'end_y',
  'end_z',
  'node_a',
  'node_b',
  'outer_diameter',
  'radius',
  'wall',
  'size',
  'priority',
  'kind',
  'height',
  'width',
  'corner_radius',
  'inner_corner_radius',
  'corners',
  'up_x',
  'up_y',
  'up_z',
] as const;
export type Field = (typeof fields)[number];
export const nodeFields = ['node', 'x', 'y', 'z'] as const;
export type NodeField = (typeof nodeFields)[number];

const axis = (ends: string[], from: string): string[] =>
  ends.flatMap((end) => (/^\d$/.test(end) ? [`${from}${end}`, `${from}_${end}`] : [`${end}_${from}`, `${from}_${end}`, `${end}${from}`, `${from}${end}`]));
const first = ['start', 'begin', 'from', 'a', 'i', '1'];
const second = ['end', 'finish', 'to', 'b', 'j', '2'];
const nodes = (ends: string[]): string[] =>
  ends.flatMap((end) => ['node', 'joint', 'point', 'n'].flatMap((word) => [`${word}_${end}`, `${word}${end}`, `${end}_${word}`, `${end}${word}`]));

/** Headings that are read without a mapping, the plainest first. */
const headings: Record<Field, string[]> = {
  id: ['id', 'name', 'member', 'mark', 'tag', 'label', 'element', 'member_id', 'member_no', 'member_name', 'element_id', 'bar', 'frame', 'no', 'number', 'nr'],
  start_x: axis(first, 'x'),
  start_y: axis(first, 'y'),
  start_z: axis(first, 'z'),
  end_x: axis(second, 'x'),
  end_y: axis(second, 'y'),
  end_z: axis(second, 'z'),
  node_a: [...nodes(first), 'i', 'from', 'start', 'joint1'],
  node_b: [...nodes(second), 'j', 'to', 'end', 'joint2'],
  outer_diameter: ['outer_diameter', 'outside_diameter', 'od', 'o_d', 'diameter', 'dia', 'd', 'outer_dia', 'outside_dia', 'aussendurchmesser', 'durchmesser'],
  radius: ['radius', 'outer_radius', 'r', 'or'],
  wall: ['wall', 'wall_thickness', 'thickness', 't', 'wt', 'thk', 'wand', 'wanddicke', 'wandstaerke'],
  size: ['size', 'section', 'profile', 'cross_section', 'section_name', 'querschnitt', 'profil'],
  priority: ['priority'],
  kind: ['kind', 'section_kind', 'section_type', 'tube_kind'],
  height: ['height', 'h', 'depth', 'section_height', 'hoehe', 'höhe'],
  width: ['width', 'b', 'w', 'breadth', 'section_width', 'breite'],
  corner_radius: ['corner_radius', 'outer_corner_radius', 'corner_r', 'ro', 'r_o', 'eckradius'],
  inner_corner_radius: ['inner_corner_radius', 'ri', 'r_i'],
  corners: ['corners', 'corner_standard', 'section_standard'],
  up_x: axis(['up'], 'x'),
  up_y: axis(['up'], 'y'),
  up_z: axis(['up'], 'z'),
};
const nodeHeadings: Record<NodeField, string[]> = {
  node: ['node', 'joint', 'point', 'id', 'node_id', 'joint_id', 'name', 'label', 'number', 'no', 'nr', 'node_no', 'knoten'],
  x: ['x', 'x_coord', 'coord_x', 'x_coordinate'],
  y: ['y', 'y_coord', 'coord_y', 'y_coordinate'],
  z: ['z', 'z_coord', 'coord_z', 'z_coordinate'],
};

interface Heading {
  plain: string;
  unit?: LengthUnit;
}

/** A heading without case, spaces and unit: "Start X [mm]" is start_x, in mm. */
export function plain(heading: string): Heading {
  const text = heading.slice(0, 80).trim().toLowerCase();
  const [, word, unitName] =
    /^([^([,]+?)[ _]?[([,] ?([^)\]]{1,12}?) ?[)\]]?$/.exec(text) ?? /^(.+?)(?:[_ ]in[_ ]|[_ ])([a-z]{1,11})$/.exec(text) ?? /^(.+?)("|″)$/.exec(text) ?? [];
  const unit = unitName === undefined ? undefined : unitNamed(unitName);
  const name = (unit && word !== undefined ? word : text)
    .replace(/[\s.\-/]+/g, '_')
    .replace(/^_|_$/g, '')
    .replace(/ß/g, 'ss');
  return unit ? {plain: name, unit} : {plain: name};
}

/** Columns in which a heading is looked for. */
const widest = 1000;

/** Where the column of each field is in a row, from 0. */
export type Places<F extends string> = Partial<Record<F, number>>;

function match<F extends string>(row: string[], known: Record<F, string[]>): Places<F> {
  const words = row.slice(0, widest).map(plain);
  const taken = new Set<number>();
  const out: Places<F> = {};
  for (const field of Object.keys(known) as F[])
    for (const name of known[field]) {
      const at = words.findIndex((each, i) => each.plain === name && !taken.has(i));
      if (at < 0) continue;
      taken.add(at);
      out[field] = at;
      break;
    }
  return out;
}

/** Coordinates are matched before nodes, so that only "start" and "end" are nodes. */
export const membersIn = (row: string[]): Places<Field> => match(row, headings);
export const nodesIn = (row: string[]): Places<NodeField> => match(row, nodeHeadings);

const has = (columns: Places<string>, ...names: string[]): boolean => names.every((name) => columns[name] !== undefined);
/** Rows of numbers are not headings; because they are most rows, this is checked first. */
const wordy = (row: string[]): boolean => row.length > 1 && row.slice(0, widest).filter((cell) => /^[^\d.,+-]/.test(cell)).length > 1;
export const isMembers = (row: string[]): boolean => {
  if (!wordy(row)) return false;
  const columns = membersIn(row);
  return has(columns, 'start_x', 'end_x') || has(columns, 'start_y', 'end_y') || has(columns, 'node_a', 'node_b');
};
export const isNodes = (row: string[]): boolean => wordy(row) && has(nodesIn(row), 'node', 'x', 'y') && !isMembers(row);

/** Examples for a message. */
export const examples = (field: Field | NodeField): string =>
  ((headings as Record<string, string[]>)[field] ?? (nodeHeadings as Record<string, string[]>)[field] ?? []).slice(0, 3).join(', ');
