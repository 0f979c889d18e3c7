/// <reference path="../papaparse.d.ts" />
import Papa from 'papaparse';
import type {NotUnderstood} from '../frame.js';
import type {LengthUnit} from '../units.js';
import {type Field, isMembers, isNodes, membersIn, type NodeField, nodesIn, plain} from './columns.js';
import {unitNamed} from './numbers.js';

export interface Row {
  cells: string[];
  number: number; // in the file, from 1
}

/** One table of a text: the meaning of its columns, and its rows. */
export interface Table<F extends string> {
  headings: string[];
  columns: Partial<Record<F, string>>;
  units: (LengthUnit | undefined)[]; // of the columns, if the table states them
  rows: Row[];
}

const filled = ({cells}: Row): boolean => cells.some((cell) => cell !== '');
const spaced = (line: string): string[] => (line.trim().split(/ {2,}/).length > 2 ? line.trim().split(/ {2,}/) : line.trim().split(/\s+/));
const isHeading = (row: string[]): boolean => isMembers(row) || isNodes(row);

/**
 * Returns the column separator: the one that makes one of the first lines a heading; undefined if
 * no separator does.
 */
function separatorOf(lines: string[]): string | undefined {
  const first = lines
    .filter((line) => line.trim() !== '')
    .slice(0, 50)
    .map((line) => line.slice(0, 4000));
  const cells = (line: string, mark: string): string[] => line.split(mark).map((each) => each.replace(/"/g, '').trim());
  return (
    ['\t', ';', ',', '|'].find((mark) => first.some((line) => isHeading(cells(line, mark)))) ??
    (first.some((line) => isHeading(spaced(line))) ? ' ' : undefined)
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

/** `ends`: is a row the heading of the next table? A row of data may look like one of its own: nodes named N1 and N2. */
function table<F extends string>(rows: Row[], top: number, columns: Partial<Record<F, string>>, ends: (row: string[]) => boolean): Table<F> {
  const headings = rows[top]?.cells ?? [];
  const next = rows.findIndex(({cells}, i) => i > top && ends(cells));
  const below = rows.slice(top + 1, next < 0 ? rows.length : next).filter(filled);
  const first = below[0];
  const told = first?.cells.every((cell) => cell === '' || unitNamed(cell) !== undefined || /^[-–()[\]]+$/.test(cell)) ? first : undefined;
  const units = headings.map((each, i) => plain(each).unit ?? (told && unitNamed(told.cells[i] ?? '')));
  return {headings, columns, units, rows: told ? below.slice(1) : below};
}

/**
 * Returns the members' table: the first with such headings, or with those that a mapping names,
 * else the start of the text.
 */
export function membersTable(rows: Row[], given: Partial<Record<Field, string>> = {}): Table<Field> {
  const named = Object.values(given);
  const byName = named.length > 0 ? rows.findIndex(({cells}) => named.every((each) => cells.includes(each.trim()))) : -1;
  const own = rows.findIndex(({cells}) => isMembers(cells));
  const top = byName >= 0 ? byName : own >= 0 ? own : rows.findIndex((row) => filled(row) && !isNodes(row.cells));
  const headings = rows[top]?.cells ?? [];
  const found = Object.entries(membersIn(headings)).filter(([, heading]) => !named.some((each) => each.trim() === heading.trim()));
  return table<Field>(rows, top, {...Object.fromEntries(found), ...given}, isNodes);
}

export function nodeTables(rows: Row[]): Table<NodeField>[] {
  return rows.flatMap(({cells}, i) => (isNodes(cells) ? [table<NodeField>(rows, i, nodesIn(cells), isMembers)] : []));
}

/**
 * Returns the cell of a row in the column of a field; undefined if it is empty or there is no such
 * column.
 */
export function cellsOf<F extends string>({headings, columns}: Table<F>): (row: Row, field: F) => string | undefined {
  const at = new Map<F, number>(Object.entries(columns).map(([field, heading]) => [field as F, headings.indexOf((heading as string).trim())]));
  return ({cells}, field) => cells[at.get(field) ?? -1] || undefined;
}

export function unitIn<F extends string>({headings, columns, units}: Table<F>, field: F): LengthUnit | undefined {
  const heading = columns[field];
  return heading === undefined ? undefined : units[headings.indexOf(heading.trim())];
}
