/// <reference path="../papaparse.d.ts" />
import Papa from 'papaparse';
import type {NotUnderstood} from '../frame.js';
import type {LengthUnit} from '../units.js';
import {type Field, isMembers, isNodes, membersIn, type NodeField, nodesIn, type Places, plain} from './columns.js';
import {unitNamed} from './numbers.js';

export interface Row {
  cells: string[];
  number: number; // in the file, from 1
}

/** One table of a text: the meaning of its columns, and its rows. */
export interface Table<F extends string> {
  headings: string[]; // empty if no row has them
  columns: Places<F>;
  units: (LengthUnit | undefined)[]; // of the columns, if the table states them
  rows: Row[];
}

const filled = ({cells}: Row): boolean => cells.some((cell) => cell !== '');
const spaced = (line: string): string[] => (line.trim().split(/ {2,}/).length > 2 ? line.trim().split(/ {2,}/) : line.trim().split(/\s+/));
const isHeading = (row: string[]): boolean => isMembers(row) || isNodes(row);

/** Have most lines as many cells as the last, and more than one? Above them may be titles. */
const even = (rows: string[][]): boolean => {
  const last = rows[rows.length - 1]?.length ?? 0;
  return last > 1 && 2 * rows.filter(({length}) => length === last).length >= rows.length;
};

/**
 * Returns the column separator: the one that makes one of the first lines a heading, else the one
 * that gives most of them as many cells; undefined if no separator does.
 */
function separatorOf(lines: string[]): string | undefined {
  const first = lines
    .filter((line) => line.trim() !== '')
    .slice(0, 50)
    .map((line) => line.slice(0, 4000));
  const cells = (line: string, mark: string): string[] => line.split(mark).map((each) => each.replace(/"/g, '').trim());
  const marks = ['\t', ';', ',', '|'];
  return (
    marks.find((mark) => first.some((line) => isHeading(cells(line, mark)))) ??
    (first.some((line) => isHeading(spaced(line))) ? ' ' : undefined) ??
    // Because a comma may be the mark of decimals, the others come before it.
    ['\t', ';', '|', ','].find((mark) => even(first.map((line) => cells(line, mark)))) ??
    (even(first.map(spaced)) && !first.some((line) => marks.some((mark) => mark !== ',' && line.includes(mark))) ? ' ' : undefined)
  );
}

/** The cells of a text, whatever parts them: comma, semicolon, tab, bar or spaces. */
export function rowsOf(given: string, notUnderstood: NotUnderstood[] = []): Row[] {
  const text = given.replace(/^\uFEFF/, '');
  const lines = text.split(/\r\n|\n|\r/);
  const mark = separatorOf(lines.slice(0, 200));
  if (mark === ' ') return lines.map((line, i) => ({cells: spaced(line), number: i + 1}));
  const {data, errors} = Papa.parse<string[]>(text, {skipEmptyLines: false, ...(mark ? {delimiter: mark} : {})});
  for (const {row, message, type} of errors) if (type === 'Quotes') notUnderstood.push({id: `row ${(row ?? 0) + 1}`, type: 'CSV', reason: message});
  const ruled = mark === '|';
  return data
    .map((cells, i) => ({cells: cells.map((cell) => cell.trim()), number: i + 1}))
    .filter(({cells}) => !ruled || !cells.every((cell) => /^[:+-]*$/.test(cell)));
}

interface Rows {
  all: Row[];
  top: number; // the row of headings; without one, the first of data
  headed: boolean;
}

/** `ends`: is a row the heading of the next table? A row of data may look like one of its own: nodes named N1 and N2. */
function table<F extends string>({all, top, headed}: Rows, columns: Places<F>, ends: (row: string[]) => boolean): Table<F> {
  const headings = headed ? (all[top]?.cells ?? []) : [];
  const next = all.findIndex(({cells}, i) => i > top && ends(cells));
  const below = all.slice(Math.max(top, 0) + (headed ? 1 : 0), next < 0 ? all.length : next).filter(filled);
  const first = below[0];
  const told = first?.cells.every((cell) => cell === '' || unitNamed(cell) !== undefined || /^[-–()[\]]+$/.test(cell)) ? first : undefined;
  const units = (headed ? headings : (told?.cells ?? [])).map((each, i) => (headed ? plain(each).unit : undefined) ?? (told && unitNamed(told.cells[i] ?? '')));
  return {headings, columns, units, rows: told ? below.slice(1) : below};
}

/** Which column states each field: by its heading, or by its index from 0; null if none does. */
export type Columns = Partial<Record<Field, string | number | null>>;

/** Titles above a table fill fewer cells than its rows: half of the widest is the first of the table. */
function firstWide(rows: Row[]): number {
  const count = ({cells}: Row) => cells.filter((cell) => cell !== '').length;
  const most = rows.slice(0, 200).reduce((sum, row) => Math.max(sum, count(row)), 0);
  return rows.findIndex((row) => filled(row) && count(row) >= most / 2 && !isNodes(row.cells));
}

/** Are more cells words than numbers? */
const isWordy = (cells: string[]): boolean => {
  const said = cells.filter((cell) => cell !== '');
  return said.filter((cell) => !/^[-+]?[\d.,]*\d/.test(cell)).length > said.length / 2;
};

/**
 * Returns the members' table: the first with such headings, or with those that a mapping names,
 * else the start of the text. `lost` are columns of the mapping that it does not have.
 */
export function membersTable(
  rows: Row[],
  given: Columns = {},
  headed?: boolean,
): Table<Field> & {top: number; headed: boolean; lost: [field: Field, column: string | number][]} {
  const named = Object.values(given).filter((each): each is string => typeof each === 'string');
  const byName = named.length > 0 ? rows.findIndex(({cells}) => named.every((each) => cells.includes(each.trim()))) : -1;
  const own = rows.findIndex(({cells}) => isMembers(cells));
  const known = byName >= 0 ? byName : own;
  const top = known >= 0 && headed !== false ? known : firstWide(rows);
  const hasHeadings = headed ?? (known >= 0 || named.length > 0 || isWordy(rows[top]?.cells ?? []));
  const headings = hasHeadings ? (rows[top]?.cells ?? []) : [];
  const width = rows.slice(Math.max(top, 0)).reduce((most, {cells}) => Math.max(most, cells.length), 0);
  const lost: [Field, string | number][] = [];
  const places: Places<Field> = {};
  for (const [field, column] of Object.entries(given) as [Field, string | number | null][]) {
    if (column === null) continue;
    const at = typeof column === 'number' ? column : headings.indexOf(column.trim());
    if (at >= 0 && at < width) places[field] = at;
    else lost.push([field, column]);
  }
  const taken = new Set(Object.values(places));
  const found = Object.entries(membersIn(headings)).filter(([field, at]) => !(field in given) && !taken.has(at));
  return {...table<Field>({all: rows, top, headed: hasHeadings}, {...Object.fromEntries(found), ...places}, isNodes), top, headed: hasHeadings, lost};
}

export function nodeTables(rows: Row[]): Table<NodeField>[] {
  return rows.flatMap(({cells}, i) => (isNodes(cells) ? [table<NodeField>({all: rows, top: i, headed: true}, nodesIn(cells), isMembers)] : []));
}

/**
 * Returns the cell of a row in the column of a field; undefined if it is empty or there is no such
 * column.
 */
export const cellsOf =
  <F extends string>({columns}: Table<F>) =>
  ({cells}: Row, field: F): string | undefined =>
    cells[columns[field] ?? -1] || undefined;

export const unitIn = <F extends string>({columns, units}: Table<F>, field: F): LengthUnit | undefined => units[columns[field] ?? -1];
