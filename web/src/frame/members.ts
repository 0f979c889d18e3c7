import {clone, rowsOf, type Json, type Row} from '../json';
import {t} from '../language';

/** A column of the members' table: a field, or one coordinate of a point. */
export interface Column {
  id: string;
  key: string;
  axis?: number;
  textual?: true;
}
const point = (key: string, short: string): Column[] => ['x', 'y', 'z'].map((each, axis) => ({id: `${short} ${each}`, key, axis}));
export const columns: Column[] = [
  {id: 'id', key: 'id', textual: true},
  ...point('start_mm', 'start'),
  ...point('end_mm', 'end'),
  {id: 'size', key: 'size', textual: true},
  {id: 'diameter', key: 'outer_diameter_mm'},
  {id: 'wall', key: 'wall_mm'},
  {id: 'priority', key: 'priority'},
];

export type Sizes = ReadonlyMap<string, {outer: number; wall: number}>;
export const membersOf = (body: Row): Row[] => rowsOf(body['members']);
const idOf = (member: Row) => String(member['id'] ?? '');

export function cellValue(member: Row, {key, axis}: Column): Json | undefined {
  const value = member[key];
  return axis === undefined ? value : Array.isArray(value) ? value[axis] : undefined;
}

/** Diameter and wall of a member that is given by its size. */
export function impliedOf(member: Row, {key}: Column, sizes: Sizes): number | undefined {
  const size = sizes.get(String(member['size']));
  return key === 'outer_diameter_mm' ? size?.outer : key === 'wall_mm' ? size?.wall : undefined;
}

/** Writes one cell. A size replaces diameter and wall, either of these replaces the size. */
export function writeCell(member: Row, column: Column, value: Json | undefined, sizes: Sizes): void {
  const {key, axis} = column;
  if (axis !== undefined) {
    const was = Array.isArray(member[key]) ? [...member[key]] : [0, 0, 0];
    was[axis] = value ?? 0;
    member[key] = was;
    return;
  }
  if (key === 'size' && value !== undefined) for (const each of ['outer_diameter_mm', 'wall_mm']) delete member[each];
  if ((key === 'outer_diameter_mm' || key === 'wall_mm') && 'size' in member && value !== undefined) {
    const size = sizes.get(String(member['size']));
    delete member['size'];
    Object.assign(member, {outer_diameter_mm: size?.outer ?? 60, wall_mm: size?.wall ?? 4});
  }
  if (value === undefined) delete member[key];
  else member[key] = value;
}

/** `like` if nothing has that name, else with the next free number after the one that it ends with. */
export function freeName(taken: ReadonlySet<string>, like: string): string {
  if (!taken.has(like)) return like;
  const [, stem = like, digits = '1'] = /^(.*?)(\d+)$/.exec(like) ?? [undefined, /\d$/.test(like) ? like : `${like} `];
  for (let number = Number(digits) + 1; ; ++number) {
    const name = stem + String(number).padStart(digits.startsWith('0') ? digits.length : 0, '0');
    if (!taken.has(name)) return name;
  }
}
export const namesOf = (body: Row): Set<string> => new Set([...membersOf(body), ...rowsOf(body['others']), ...rowsOf(body['plates'])].map(idOf));

/** Why a member cannot have a name. */
export function nameRefused(body: Row, index: number, to: string): string | undefined {
  if (to === '') return t('A member needs a name.');
  return membersOf(body)[index]?.['id'] !== to && namesOf(body).has(to) ? t('The name "{name}" is taken.', {name: to}) : undefined;
}

/** Gives a member another name that is free, also in every joint and end that refers to it. */
export function renameMember(body: Row, index: number, to: string): void {
  const members = membersOf(body);
  const member = members[index];
  if (!member || nameRefused(body, index, to)) return;
  const from = member['id'] as Json;
  member['id'] = to;
  if (members.some((each) => each['id'] === from)) return; // references stay with the other one of that name
  for (const joint of rowsOf(body['joints'])) {
    if (Array.isArray(joint['between'])) joint['between'] = joint['between'].map((each) => (each === from ? to : each));
  }
  for (const end of rowsOf(body['ends'])) if (end['member'] === from) end['member'] = to;
}

/** Removes members with the joints, ends and squaring planes that refer to them. */
export function removeMembers(body: Row, indices: ReadonlySet<number>): void {
  const members = membersOf(body);
  const left = members.filter((_, i) => !indices.has(i));
  const kept = new Set(left.map(idOf));
  const gone = new Set(members.map(idOf).filter((id) => !kept.has(id)));
  body['members'] = left;
  const planes = new Set([...gone].flatMap((id) => ['start', 'finish'].map((end) => squareName(id, end))));
  const filtered = (key: string, keep: (row: Row) => boolean) => {
    if (!Array.isArray(body[key])) return;
    const rest = rowsOf(body[key]).filter(keep);
    if (rest.length) body[key] = rest;
    else delete body[key];
  };
  filtered('joints', ({between}) => !(Array.isArray(between) && between.some((each) => gone.has(String(each)))));
  filtered('ends', ({member}) => !gone.has(String(member)));
  filtered('others', (other) => !planes.has(idOf(other)));
}

export const squareName = (id: string, end: string) => `square ${id} ${end}`;

/** A member that begins where another ends, across it. */
export function addMember(body: Row, after?: number): number {
  const members = membersOf(body);
  const last = members[after ?? members.length - 1];
  const names = namesOf(body);
  const [start, end] = [last?.['start_mm'], last?.['end_mm']].map((at) => (Array.isArray(at) ? at.map(Number) : [0, 0, 0])) as [number[], number[]];
  const rise = end.map((v, i) => Math.abs(v - (start[i] as number)));
  const upright = (rise[2] as number) > Math.max(rise[0] as number, rise[1] as number);
  const made: Row = {
    ...(last ? clone(last) : {outer_diameter_mm: 60.3, wall_mm: 4}),
    id: last ? freeName(names, idOf(last)) : 'member 1',
    start_mm: [...end],
    end_mm: end.map((v, i) => v + (i === (upright ? 0 : 2) ? 500 : 0)),
  };
  delete made['up']; // that of another direction
  body['members'] = [...members, made];
  return members.length;
}

/** Copies a column's value from the first of the rows to the others; names are numbered on. */
export function fillDown(body: Row, rows: number[], column: Column, sizes: Sizes): void {
  const members = membersOf(body);
  const [first, ...others] = rows;
  const source = members[first as number];
  if (!source) return;
  for (const row of others) {
    if (column.id === 'id') renameMember(body, row, freeName(namesOf(body), idOf(source)));
    else writeCell(members[row] as Row, column, cellValue(source, column), sizes);
  }
}

/** What a cell's text is as a value: a number, with point or comma, or the text itself. */
export function parseCell(text: string, {textual}: Column): Json | undefined {
  const said = text.trim();
  if (said === '') return undefined;
  const value = Number(said.replace(',', '.'));
  return textual || !Number.isFinite(value) ? said : value;
}

/** The cells of a spreadsheet's text. */
export function cellsOf(text: string): string[][] {
  const lines = text.replace(/\r\n?/g, '\n').replace(/\n+$/, '').split('\n');
  const mark = text.includes('\t') ? '\t' : text.includes(';') ? ';' : '\t';
  return lines.map((line) => line.split(mark).map((cell) => cell.trim().replace(/^"(.*)"$/, '$1')));
}

const headings: [RegExp, string][] = [
  [/^(id|name|member|mark)$/, 'id'],
  [/^(start|from|begin)?[ _]*x[ _]*(1|start)?$/, 'start x'],
  [/^(start|from|begin)?[ _]*y[ _]*(1|start)?$/, 'start y'],
  [/^(start|from|begin)?[ _]*z[ _]*(1|start)?$/, 'start z'],
  [/^(end|to|finish)?[ _]*x[ _]*(2|end)?$/, 'end x'],
  [/^(end|to|finish)?[ _]*y[ _]*(2|end)?$/, 'end y'],
  [/^(end|to|finish)?[ _]*z[ _]*(2|end)?$/, 'end z'],
  [/^(size|section|profile)$/, 'size'],
  [/^(diameter|outer[ _]diameter|od|ø|d)$/, 'diameter'],
  [/^(wall|thickness|t)$/, 'wall'],
  [/^priority$/, 'priority'],
];
const columnNamed = (text: string): Column | undefined => {
  const said = text
    .toLowerCase()
    .replace(/[ _]*[([]?\bmm\b[)\]]?$/, '')
    .trim();
  const found = headings.find(([pattern]) => pattern.test(said))?.[1];
  return columns.find(({id}) => id === found);
};

/** The columns that a first line names, or nothing if it is a line of values. */
export function headOf(line: string[]): (Column | undefined)[] | undefined {
  const named = line.map(columnNamed);
  const numeric = line.some((cell) => cell !== '' && Number.isFinite(Number(cell.replace(',', '.'))));
  return !numeric && named.filter(Boolean).length >= 2 ? named : undefined;
}

/** Puts a spreadsheet's cells in: under its own headings, by name; else from a cell on, to the right and down, with new members after the last row.
 *  Returns the rows that were written. */
export function pasteCells(body: Row, cells: string[][], rows: number[], at: {row: number; column: number}, sizes: Sizes): number[] {
  const head = headOf(cells[0] ?? []);
  const named = head ?? cells[0]?.map((_, i) => columns[at.column + i]) ?? [];
  const byName = new Map(membersOf(body).map((member, i) => [idOf(member), i]));
  const idAt = head?.findIndex((column) => column?.id === 'id') ?? -1;
  const from = Math.max(0, rows.indexOf(at.row));
  return (head ? cells.slice(1) : cells).map((line, i) => {
    const known = head ? byName.get(line[idAt] ?? '') : rows[from + i];
    const row = known ?? addMember(body);
    const member = membersOf(body)[row] as Row;
    line.forEach((cell, k) => {
      const column = named[k];
      const value = column && parseCell(cell, column);
      if (!column || value === undefined) return;
      if (column.id !== 'id') writeCell(member, column, value, sizes);
      else renameMember(body, row, member['id'] === value ? String(value) : freeName(namesOf(body), String(value)));
    });
    return row;
  });
}

/** The cells of rows as a spreadsheet takes them, under headings that `pasteCells` reads. */
export function copyCells(body: Row, rows: number[]): string {
  const members = membersOf(body);
  const lines = rows.map((row) => columns.map((column) => String(cellValue(members[row] as Row, column) ?? '')));
  return [columns.map(({id}) => id), ...lines].map((line) => line.join('\t')).join('\n');
}

/** The rows whose name, size or other texts contain every word that is searched for. */
export function foundRows(body: Row, search: string, more: (row: number) => string = () => ''): number[] {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  return membersOf(body).flatMap((member, i) => {
    const text = `${idOf(member)} ${member['size'] ?? `${member['outer_diameter_mm']}x${member['wall_mm']}`} ${more(i)}`.toLowerCase();
    return words.every((word) => text.includes(word)) ? [i] : [];
  });
}

/** Rows in the order of a column: numbers by value, texts as people count. */
export function sortRows(body: Row, rows: number[], column: Column, falling: boolean, sizes: Sizes): number[] {
  const members = membersOf(body);
  const key = (row: number) => cellValue(members[row] as Row, column) ?? impliedOf(members[row] as Row, column, sizes) ?? '';
  const sign = falling ? -1 : 1;
  return [...rows].sort((a, b) => {
    const [p, q] = [key(a), key(b)];
    const order = typeof p === 'number' && typeof q === 'number' ? p - q : String(p).localeCompare(String(q), undefined, {numeric: true});
    return sign * order || a - b;
  });
}
