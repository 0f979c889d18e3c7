import {sizeNamed} from '../catalogue.js';
import {clean, exact, type Found, type FrameOptions, frameOf, full, type Imported, type Member, names, nothing, rounded, type Size} from '../frame.js';
import {distance, type Vector} from '../geometry.js';
import {decimal, type LengthUnit} from '../units.js';
import {examples, type Field, fields} from './columns.js';
import {Nodes} from './nodes.js';
import {lengthSaid, type Mark, markOf, numberSaid, Trouble} from './numbers.js';
import {cellsOf, membersTable, nodeTables, type Row, rowsOf, type Table, unitIn} from './tables.js';

export {type Field, fields} from './columns.js';

export interface CsvMapping extends FrameOptions {
  /** Which column, by its heading, states a field. Without an entry it is found by the usual headings. */
  columns?: Partial<Record<Field, string>>;
  /** Of lengths whose column states no unit; default mm. */
  unit?: LengthUnit;
  /** Of all rows, where no column states it. */
  size?: Size;
  /**
   * A second text, with the table of nodes that members name. It may also be part of the first
   * text.
   */
  nodes?: string;
  /** The mark of decimals, if the numbers leave it open ("1,234"). */
  decimal?: Mark;
}

/** Fields whose columns are missing. */
class Missing extends Error {
  constructor(readonly fields: Field[]) {
    super();
  }
}

/** Returns the columns as read without a mapping: the start for a mapper. */
export function columnsOf(text: string): {headings: string[]; columns: Partial<Record<Field, string>>; nodes: boolean} {
  const rows = rowsOf(text);
  const {headings, columns} = membersTable(rows);
  return {headings, columns, nodes: nodeTables(rows).length > 0};
}

const lengthFields = fields.filter((field) => /_[xyz]$|diameter|radius|wall/.test(field));
const axes = ['x', 'y', 'z'] as const;

interface Reading {
  table: Table<Field>;
  cells: (row: Row, field: Field) => string | undefined;
  nodes: Nodes;
  mark: Mark;
  mapping: CsvMapping;
}

function lengthIn({table, cells, mapping, mark}: Reading, row: Row, field: Field): number {
  const said = cells(row, field);
  if (said === undefined) throw new Trouble(`it has no ${field}`);
  return lengthSaid(said, field, unitIn(table, field) ?? mapping.unit ?? 'mm', mark);
}

/** "114.3x6.3", in mm, with or without a word before it, or a listed name. */
function sizeSaid(said: string, mark: Mark): Size {
  const listed = sizeNamed(said.slice(0, 64));
  if (listed) return {size: listed.name};
  const [, outer, wall] = /^(?:[A-Za-zØ⌀]{0,6} ?)(\d[\d.,]{0,12}) ?[xX×*] ?(\d[\d.,]{0,12})(?: ?mm)?$/.exec(said.slice(0, 64)) ?? [];
  const [outer_diameter_mm, wall_mm] = [outer, wall].map((each) => numberSaid(each ?? '', mark)) as [number, number];
  if (!(outer_diameter_mm > 0 && wall_mm > 0 && wall_mm < outer_diameter_mm / 2))
    throw new Trouble(`its size is not one that GET /v1/tubes lists: ${clean(said.slice(0, 64))}`);
  return {outer_diameter_mm, wall_mm};
}

function sizeIn(reading: Reading, row: Row): Size {
  const {cells, mapping, mark, table} = reading;
  const size = cells(row, 'size');
  if (size !== undefined) return sizeSaid(size, mark);
  const given = (['outer_diameter', 'radius', 'wall'] as const).filter((field) => cells(row, field) !== undefined);
  if (given.length === 0 && mapping.size) return mapping.size;
  const has = (field: Field) => table.columns[field] !== undefined;
  const missing: Field[] = [...(has('outer_diameter') || has('radius') ? [] : ['outer_diameter' as const]), ...(has('wall') ? [] : ['wall' as const])];
  if (missing.length > 0) throw new Missing(missing);
  const byRadius = cells(row, 'outer_diameter') === undefined && (cells(row, 'radius') !== undefined || !has('outer_diameter'));
  const outer = byRadius ? 2 * lengthIn(reading, row, 'radius') : lengthIn(reading, row, 'outer_diameter');
  const wall = lengthIn(reading, row, 'wall');
  if (!(outer > 0 && wall > 0 && wall < outer / 2)) throw new Trouble(`a wall of ${exact(wall)} mm does not go with ${exact(outer)} mm outside`);
  return {outer_diameter_mm: exact(outer), wall_mm: exact(wall)};
}

/** By its coordinates, or by the node that it names. */
function pointIn(reading: Reading, row: Row, end: 'start' | 'end'): Vector {
  const {table, cells, nodes} = reading;
  const columns = axes.map((axis): Field => `${end}_${axis}`);
  const node: Field = end === 'start' ? 'node_a' : 'node_b';
  if (columns.every((field) => table.columns[field] === undefined) && table.columns[node] !== undefined) {
    const name = cells(row, node);
    if (name === undefined) throw new Trouble(`it has no ${node}`);
    return nodes.at(name);
  }
  return rounded(columns.map((field) => lengthIn(reading, row, field)) as Vector);
}

/** Which columns of points a row would need. */
function pointsMissing({table}: Reading): Field[] {
  const lacks = (field: Field) => table.columns[field] === undefined;
  return (['start', 'end'] as const).flatMap((end) => {
    const columns = axes.map((axis): Field => `${end}_${axis}`);
    const byNode = columns.every(lacks) && (!lacks('node_a') || !lacks('node_b'));
    const node: Field = end === 'start' ? 'node_a' : 'node_b';
    return byNode ? [node].filter(lacks) : columns.filter(lacks);
  });
}

/** Columns that no row can do without; those of sizes only if each row needs them. */
function columnsMissing(reading: Reading): Field[] {
  const {table, mapping} = reading;
  const has = (field: Field) => table.columns[field] !== undefined;
  const sizes: Field[] =
    has('size') || mapping.size
      ? []
      : [...(has('outer_diameter') || has('radius') ? [] : ['outer_diameter' as const]), ...(has('wall') ? [] : ['wall' as const])];
  return [...pointsMissing(reading), ...sizes];
}

function memberOf(reading: Reading, row: Row): Omit<Member, 'id'> {
  const [start_mm, end_mm] = [pointIn(reading, row, 'start'), pointIn(reading, row, 'end')];
  if (distance(start_mm, end_mm) === 0) throw new Trouble('it has no length');
  const said = reading.cells(row, 'priority');
  const priority = said === undefined ? undefined : decimal(said);
  if (priority !== undefined && !Number.isInteger(priority)) throw new Trouble(`its priority is no number: ${clean((said ?? '').slice(0, 80))}`);
  return {start_mm, end_mm, ...sizeIn(reading, row), ...(priority === undefined ? {} : {priority})};
}

const rowsNamed = (rows: number[]): string => `${rows.slice(0, 5).join(', ')}${rows.length > 5 ? ` and ${rows.length - 5} more` : ''}`;

function readRows(reading: Reading, found: Found): void {
  const name = names();
  const missing = new Map<Field, number[]>();
  const never = columnsMissing(reading);
  for (const field of never)
    missing.set(
      field,
      reading.table.rows.map(({number}) => number),
    );
  for (const row of never.length > 0 ? [] : reading.table.rows) {
    if (full(found)) return;
    try {
      const member = memberOf(reading, row);
      found.members.push({id: name(reading.cells(row, 'id'), `row ${row.number}`), ...member} as Member);
    } catch (failure) {
      if (failure instanceof Missing)
        for (const field of failure.fields) {
          const rows = missing.get(field) ?? [];
          rows.push(row.number);
          missing.set(field, rows);
        }
      else if (failure instanceof Trouble) found.notUnderstood.push({id: `row ${row.number}`, type: 'CSV', reason: failure.message});
      else throw failure;
    }
  }
  for (const [field, rows] of missing) {
    const reason = `there is no column for ${field} (such as ${examples(field)}): ${rows.length === 1 ? 'row' : 'rows'} ${rowsNamed(rows)} cannot be read`;
    found.notUnderstood.push({id: 'file', type: 'CSV', reason});
  }
}

/** Returns the options that are needed before the numbers have a meaning. */
function asked(reading: Omit<Reading, 'mark'> & {mark: Mark | undefined}, found: Found): void {
  const {table, nodes, mapping, mark} = reading;
  const count = table.rows.length;
  const ask = (option: 'nodes' | 'unit' | 'decimal', likely: string[], text: string) => found.asks.push({option, count, likely, text});
  if (mark === undefined)
    ask('decimal', [',', '.'], 'numbers such as 1,234 do not show whether the comma is the mark of decimals: state --decimal comma or --decimal point');
  const byNode = table.columns.node_a !== undefined && table.columns.node_b !== undefined && table.columns.start_x === undefined;
  if (byNode && nodes.tables.length === 0)
    ask('nodes', [], 'the members name nodes, and there is no table of nodes: state --nodes FILE, with the columns node, x, y and z');
  if (mapping.unit !== undefined) return;
  const units = [
    ...lengthFields.filter((field) => table.columns[field] !== undefined).map((field) => unitIn(table, field)),
    ...(byNode ? nodes.tables.flatMap((each) => axes.map((axis) => unitIn(each, axis))) : []),
  ];
  const stated = [...new Set(units.filter((unit) => unit !== undefined && unit !== 'mm'))] as LengthUnit[];
  if (stated.length > 0 && units.includes(undefined))
    ask('unit', stated, `some columns are in ${stated.join(' and ')}, and others state no unit: state --unit ${stated[0]} or --unit mm`);
}

/** If tubes have less than 5 mm, the service does not accept them, so the numbers are not mm. */
function tooThin({members, asks}: Found, mapping: CsvMapping, table: Table<Field>): boolean {
  const outers = members.flatMap((member) => ('size' in member ? [] : [member.outer_diameter_mm]));
  const unstated =
    mapping.unit === undefined &&
    (['outer_diameter', 'radius'] as const).every((field) => table.columns[field] === undefined || unitIn(table, field) === undefined);
  if (!unstated || outers.length === 0 || outers.some((outer) => outer >= 5)) return false;
  const most = Math.max(...outers.slice(0, 1000));
  asks.push({
    option: 'unit',
    count: members.length,
    likely: ['m', 'in'],
    text: `the thickest tube would be ${exact(most)} mm: state --unit (m, in, ...), because no column states a unit`,
  });
  return true;
}

/** A member a row, the columns by their headings. */
export function fromCsv(text: string, mapping: CsvMapping = {}): Imported {
  const found = nothing();
  const rows = rowsOf(text, found.notUnderstood);
  const table = membersTable(rows, mapping.columns);
  const nodes = new Nodes([...nodeTables(rows), ...(mapping.nodes === undefined ? [] : nodeTables(rowsOf(mapping.nodes, found.notUnderstood)))]);
  const lost = Object.entries(table.columns).filter(([, heading]) => !table.headings.includes(heading.trim()));
  for (const [field, heading] of lost) found.notUnderstood.push({id: 'file', type: 'CSV', reason: `there is no column "${heading}" for ${field}`});
  if (lost.length > 0) return frameOf(found, mapping, 'CSV');
  const cells = cellsOf(table);
  const numbers = [
    ...table.rows.flatMap((row) => lengthFields.map((field) => cells(row, field) ?? '')),
    ...nodes.tables.flatMap((each) => {
      const of = cellsOf(each);
      return each.rows.flatMap((row) => axes.map((axis) => of(row, axis) ?? ''));
    }),
  ];
  const mark = mapping.decimal ?? markOf(numbers);
  const reading = {table, cells, nodes, mark, mapping};
  asked(reading, found);
  if (mark === undefined || found.asks.length > 0) return frameOf(found, mapping, 'CSV');
  nodes.read(mapping.unit ?? 'mm', mark, found);
  readRows({...reading, mark}, found);
  if (tooThin(found, mapping, table)) found.members.length = 0;
  return frameOf(found, mapping, 'CSV');
}
