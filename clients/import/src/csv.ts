/// <reference path="./papaparse.d.ts" />
import Papa from 'papaparse';
import {exact, type FrameOptions, frameOf, type Imported, type Member, names, nothing, rounded, type Size} from './frame.js';
import {distance, type Vector} from './geometry.js';
import {lengths, type LengthUnit} from './units.js';

/** What a member's row tells, by the names of the request's fields; of points the axes one by one. */
export const fields = ['id', 'start_x', 'start_y', 'start_z', 'end_x', 'end_y', 'end_z', 'outer_diameter', 'wall', 'size', 'priority'] as const;
export type Field = (typeof fields)[number];

export interface CsvMapping extends FrameOptions {
  /** Which column, by its heading, tells a field. Without an entry the column of that name, or that name with `_mm`. */
  columns?: Partial<Record<Field, string>>;
  /** Of all lengths; mm without it. */
  unit?: LengthUnit;
  /** Of all rows, where no column tells it. */
  size?: Size;
}

class Trouble extends Error {}

const plain = (heading: string): string =>
  heading
    .trim()
    .toLowerCase()
    .replace(/[\s-]+/g, '_')
    .replace(/_mm$/, '');

/** The columns as they would be read without a mapping: what a mapper begins with. */
export function columnsOf(text: string): {headings: string[]; columns: Partial<Record<Field, string>>} {
  const headings = Papa.parse<string[]>(text, {preview: 1, skipEmptyLines: 'greedy'}).data[0] ?? [];
  const columns = Object.fromEntries(
    fields.flatMap((field) =>
      headings
        .filter((each) => plain(each) === field)
        .slice(0, 1)
        .map((each) => [field, each]),
    ),
  );
  return {headings, columns};
}

type Cells = (field: Field) => string | undefined;

function numberIn(cells: Cells, field: Field): number {
  const text = cells(field);
  if (text === undefined) throw new Trouble(`it has no ${field}`);
  const value = /^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$/.test(text) ? Number(text) : Number.NaN;
  if (!Number.isFinite(value)) throw new Trouble(`its ${field} is no number: ${text}`);
  return value;
}

function sizeIn(cells: Cells, mm: number, all: Size | undefined): Size {
  const size = cells('size');
  if (size !== undefined) return {size};
  if (cells('outer_diameter') === undefined && cells('wall') === undefined && all) return all;
  const [outer, wall] = [numberIn(cells, 'outer_diameter') * mm, numberIn(cells, 'wall') * mm];
  if (!(outer > 0 && wall > 0 && wall < outer / 2)) throw new Trouble(`a wall of ${exact(wall)} mm does not go with ${exact(outer)} mm outside`);
  return {outer_diameter_mm: exact(outer), wall_mm: exact(wall)};
}

function memberOf(cells: Cells, id: string, mapping: CsvMapping): Member {
  const mm = lengths[mapping.unit ?? 'mm'];
  const at = (end: 'start' | 'end'): Vector => rounded((['x', 'y', 'z'] as const).map((axis) => numberIn(cells, `${end}_${axis}`) * mm) as Vector);
  const [start_mm, end_mm] = [at('start'), at('end')];
  if (distance(start_mm, end_mm) === 0) throw new Trouble('it has no length');
  const size = sizeIn(cells, mm, mapping.size);
  return {id, start_mm, end_mm, ...size, ...(cells('priority') === undefined ? {} : {priority: numberIn(cells, 'priority')})};
}

/** A member a row, the columns by their headings. */
export function fromCsv(text: string, mapping: CsvMapping = {}): Imported {
  const found = nothing();
  const {data, errors} = Papa.parse<string[]>(text.replace(/^\uFEFF/, ''), {skipEmptyLines: false});
  for (const {row, message, type} of errors) if (type === 'Quotes') found.notUnderstood.push({id: `row ${(row ?? 0) + 1}`, type: 'CSV', reason: message});
  const top = data.findIndex((row) => row.some((cell) => cell.trim() !== ''));
  const headings = (data[top] ?? []).map((each) => each.trim());
  const columns = {...columnsOf(headings.map((each) => `"${each.replace(/"/g, '""')}"`).join(',')).columns, ...mapping.columns};
  const missing = Object.entries(columns).filter(([, heading]) => !headings.includes(heading));
  for (const [field, heading] of missing) found.notUnderstood.push({id: 'file', type: 'CSV', reason: `there is no column "${heading}" for ${field}`});
  const name = names();
  data.forEach((row, i) => {
    if (i <= top || missing.length > 0 || row.every((cell) => cell.trim() === '')) return;
    const cells: Cells = (field) => {
      const heading = columns[field];
      const cell = heading === undefined ? undefined : row[headings.indexOf(heading)]?.trim();
      return cell === '' ? undefined : cell;
    };
    try {
      const member = memberOf(cells, '', mapping);
      found.members.push({...member, id: name(cells('id'), `row ${i + 1}`)});
    } catch (failure) {
      if (!(failure instanceof Trouble)) throw failure;
      found.notUnderstood.push({id: `row ${i + 1}`, type: 'CSV', reason: failure.message});
    }
  });
  return frameOf(found, mapping);
}
