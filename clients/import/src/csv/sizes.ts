import {sizeNamed} from '../catalogue.js';
import {clean, exact, type Size} from '../frame.js';
import {type Corners, cornersStated, isHollow, isSided, type Section, type Sides, sidesSaid, type Standard, standardSaid, uncut} from '../sections.js';
import {type Field, fields} from './columns.js';
import type {CsvMapping} from './index.js';
import type {Nodes} from './nodes.js';
import {lengthSaid, type Mark, numberSaid, Trouble} from './numbers.js';
import {type Row, type Table, unitIn} from './tables.js';

export interface Reading {
  table: Table<Field>;
  cells: (row: Row, field: Field) => string | undefined;
  nodes: Nodes;
  mark: Mark;
  mapping: CsvMapping;
}

/** Fields whose columns are missing. */
export class Missing extends Error {
  constructor(readonly fields: Field[]) {
    super();
  }
}
/** A rectangular tube without its corners. */
export class Cornerless extends Error {}

const sectionFields: readonly Field[] = ['height', 'width', 'corner_radius', 'inner_corner_radius'];
export const upFields = ['up_x', 'up_y', 'up_z'] as const;

/** Those of sections count only if a row has one: a table of round tubes may have the height of something else. */
export function lengthFields(reading: Omit<Reading, 'mark'>): Field[] {
  const round = fields.filter((field) => /^(?:start|end)_[xyz]$|^outer_diameter$|^radius$|^wall$/.test(field));
  return reading.table.rows.some((row) => isSection(reading, row)) ? [...round, ...sectionFields] : round;
}
/** Fields whose numbers show the mark of decimals. */
export function numberFields(reading: Omit<Reading, 'mark'>): Field[] {
  const all = lengthFields(reading);
  return all.includes('height') ? [...all, ...upFields] : all;
}

export function lengthIn({table, cells, mapping, mark}: Reading, row: Row, field: Field): number {
  const said = cells(row, field);
  if (said === undefined) throw new Trouble(`it has no ${field}`);
  return lengthSaid(said, field, unitIn(table, field) ?? mapping.unit ?? 'mm', mark);
}

type Kind = 'round' | 'square' | 'rectangular_tube' | 'flat_oval_tube';
/** Words of the column of kinds, without spaces and marks. HSS is not among them because it may be round or not. */
const kinds: Record<string, Kind> = {
  ...named('round', ['round', 'roundtube', 'chs', 'circular', 'pipe', 'circle', 'ro']),
  ...named('square', ['square', 'squaretube', 'shs', 'quadratisch', 'qro', 'qhp']),
  ...named('rectangular_tube', ['rectangulartube', 'rectangular', 'rectangle', 'rhs', 'box', 'rechteckig', 'rro', 'rhp']),
  ...named('flat_oval_tube', ['flatovaltube', 'flatoval', 'oval', 'racetrack']),
};
function named(kind: Kind, words: string[]): Record<string, Kind> {
  return Object.fromEntries(words.map((word) => [word, kind]));
}

type Cells = Reading['cells'];
const wordIn = (cells: Cells, row: Row): string =>
  (cells(row, 'kind') ?? '')
    .slice(0, 64)
    .toLowerCase()
    .replace(/[\s_.-]/g, '');
function kindIn(cells: Cells, row: Row): Kind | undefined {
  const word = wordIn(cells, row);
  return Object.hasOwn(kinds, word) ? kinds[word] : undefined;
}

/** Has the row a section of its own? An outside diameter makes it round, and a size for all rows counts where it has no wall. */
function isSection({cells, mapping}: Omit<Reading, 'mark'>, row: Row): boolean {
  const has = (field: Field): boolean => cells(row, field) !== undefined;
  const kind = kindIn(cells, row);
  if (has('size') || kind === 'round') return false;
  return kind !== undefined || (has('height') && has('width') && !has('outer_diameter') && (has('wall') || !mapping.size));
}

function sectionIn(reading: Reading, row: Row): Section {
  const {cells, table} = reading;
  const kind = kindIn(cells, row);
  if (kind === undefined && !['', 'hss'].includes(wordIn(cells, row)))
    throw new Trouble(`its kind is not known: ${clean((cells(row, 'kind') ?? '').slice(0, 80))}`);
  if (kind === undefined && cells(row, 'radius') !== undefined)
    throw new Trouble('it has a height, a width and a radius: state kind (round, rectangular) or the column of corner_radius');
  const only = (['height', 'width'] as const).filter((field) => cells(row, field) !== undefined);
  const [first, second] = kind === 'square' && only.length === 1 && only[0] ? [only[0], only[0]] : (['height', 'width'] as const);
  const missing = [...new Set([first, second, 'wall' as const])].filter((field) => table.columns[field] === undefined);
  if (missing.length > 0) throw new Missing(missing);
  const [height_mm, width_mm, wall_mm] = [first, second, 'wall' as const].map((field) => exact(lengthIn(reading, row, field))) as [number, number, number];
  const sides = {height_mm, width_mm, wall_mm};
  if (!isHollow(sides)) throw new Trouble(`a wall of ${wall_mm} mm does not go with sides of ${height_mm} and ${width_mm} mm`);
  if (kind === 'square' && height_mm !== width_mm) throw new Trouble(`it is square, and its sides are ${height_mm} and ${width_mm} mm`);
  return kind === 'flat_oval_tube' ? {kind, ...sides} : withCorners(reading, row, sides);
}

/** The corners of its row, else those of its size's name, else those that the caller states. */
function withCorners(reading: Reading, row: Row, {corners: own, ...sides}: Sides & {corners?: Standard | undefined}): Section {
  const corners = cornersIn(reading, row) ?? (own ? {corners: own} : cornersStated(reading.mapping));
  if (!corners) throw new Cornerless();
  const why = uncut(sides, corners);
  if (why !== undefined) throw new Trouble(why);
  return {kind: 'rectangular_tube', ...sides, ...corners};
}

function cornersIn(reading: Reading, row: Row): Corners | undefined {
  const {cells} = reading;
  const said = cells(row, 'corners');
  if (cells(row, 'corner_radius') !== undefined) {
    if (said !== undefined) throw new Trouble('it has both corners and a corner_radius');
    const inner = cells(row, 'inner_corner_radius') === undefined ? {} : {inner_corner_radius_mm: exact(lengthIn(reading, row, 'inner_corner_radius'))};
    return {corner_radius_mm: exact(lengthIn(reading, row, 'corner_radius')), ...inner};
  }
  if (cells(row, 'inner_corner_radius') !== undefined) throw new Trouble('it has an inner_corner_radius and no corner_radius');
  if (said === undefined) return undefined;
  const corners = standardSaid(said);
  if (!corners) throw new Trouble(`its corners are of no standard that is known: ${clean(said.slice(0, 80))}`);
  return {corners};
}

/** "114.3x6.3", in mm, with or without a word before it, or a listed name. */
function sizeSaid(said: string, mark: Mark): Size {
  const listed = sizeNamed(said.slice(0, 64));
  if (listed) return {size: listed.name};
  const [, outer, wall] = /^(?:[A-Za-zØ⌀]{0,6} ?)(\d[\d.,]{0,12}) ?[xX×*] ?(\d[\d.,]{0,12})(?: ?mm)?$/.exec(said.slice(0, 64)) ?? [];
  const [outer_diameter_mm, wall_mm] = [outer, wall].map((each) => numberSaid(each ?? '', mark)) as [number, number];
  if (isSided(said) || !(outer_diameter_mm > 0 && wall_mm > 0 && wall_mm < outer_diameter_mm / 2))
    throw new Trouble(`its size is not one that GET /v1/tubes lists: ${clean(said.slice(0, 64))}`);
  return {outer_diameter_mm, wall_mm};
}

export function sizeIn(reading: Reading, row: Row): Size | Section {
  const {cells, mapping, mark, table} = reading;
  const size = cells(row, 'size');
  if (size !== undefined) {
    const sides = sidesSaid(size, (text) => numberSaid(text, mark));
    return sides ? withCorners(reading, row, sides) : sizeSaid(size, mark);
  }
  if (isSection(reading, row)) return sectionIn(reading, row);
  const given = (['outer_diameter', 'radius', 'wall'] as const).filter((field) => cells(row, field) !== undefined);
  if (given.length === 0 && mapping.size) {
    const sides = 'size' in mapping.size ? sidesSaid(mapping.size.size) : undefined;
    return sides ? withCorners(reading, row, sides) : mapping.size;
  }
  const missing = roundMissing(table);
  if (missing.length > 0) throw new Missing(missing);
  const has = (field: Field) => table.columns[field] !== undefined;
  const byRadius = cells(row, 'outer_diameter') === undefined && (cells(row, 'radius') !== undefined || !has('outer_diameter'));
  const outer = byRadius ? 2 * lengthIn(reading, row, 'radius') : lengthIn(reading, row, 'outer_diameter');
  const wall = lengthIn(reading, row, 'wall');
  if (!(outer > 0 && wall > 0 && wall < outer / 2)) throw new Trouble(`a wall of ${exact(wall)} mm does not go with ${exact(outer)} mm outside`);
  return {outer_diameter_mm: exact(outer), wall_mm: exact(wall)};
}

/** Columns that a round tube lacks, by its sizes. */
function roundMissing({columns}: Table<Field>): Field[] {
  const has = (field: Field) => columns[field] !== undefined;
  return [...(has('outer_diameter') || has('radius') ? [] : ['outer_diameter' as const]), ...(has('wall') ? [] : ['wall' as const])];
}

/** Columns of sizes that no row can do without. */
export function sizesMissing(reading: Reading): Field[] {
  const {table, mapping} = reading;
  if (table.columns.size !== undefined || mapping.size || table.rows.some((row) => isSection(reading, row))) return [];
  return roundMissing(table);
}
