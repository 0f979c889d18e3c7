import {clean, exact, type Found, type FrameOptions, frameOf, full, type Imported, type Member, names, nothing, rounded, type Size} from '../frame.js';
import {cross, distance, length, minus, unit, type Vector} from '../geometry.js';
import {type CornerOptions, cornersToState, standards, usually, usualUp} from '../sections.js';
import {decimal, type LengthUnit} from '../units.js';
import {examples, type Field, type Places} from './columns.js';
import {Nodes} from './nodes.js';
import {type Mark, markOf, numberSaid, Trouble} from './numbers.js';
import {Cornerless, lengthFields, lengthIn, Missing, numberFields, type Reading, sizeIn, sizesMissing, upFields} from './sizes.js';
import {cellsOf, type Columns, membersTable, nodeTables, type Row, rowsOf, type Table, unitIn} from './tables.js';

export {type Field, fields} from './columns.js';

export interface CsvMapping extends FrameOptions, CornerOptions {
  /**
   * Which column states a field: by its heading, or by its index from 0; null if none does. Without
   * an entry it is found by the usual headings.
   */
  columns?: Columns;
  /** Whether a row has headings; by default, if one is known or has more words than numbers. */
  headings?: boolean;
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

export interface ColumnsFound {
  /** Of the columns; empty if no row has them. */
  headings: string[];
  /** By heading. */
  columns: Partial<Record<Field, string>>;
  /** By index from 0. */
  places: Places<Field>;
  /** The first rows below the headings. */
  rows: string[][];
  /** Is there a table of nodes? */
  nodes: boolean;
}

/** Returns the columns as read without a mapping, and the first rows: the start for a mapper. */
export function columnsOf(text: string, mapping: Pick<CsvMapping, 'headings'> = {}, most = 20): ColumnsFound {
  const all = rowsOf(text);
  const {headings, columns: places, top, headed} = membersTable(all, {}, mapping.headings);
  const columns = Object.fromEntries(Object.entries(places).map(([field, at]) => [field, headings[at] as string]));
  const from = Math.max(top, 0) + (headed ? 1 : 0);
  const rows = all.slice(from, from + most).map(({cells}) => cells);
  return {headings, columns, places, rows, nodes: nodeTables(all).length > 0};
}

const axes = ['x', 'y', 'z'] as const;

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
const columnsMissing = (reading: Reading): Field[] => [...pointsMissing(reading), ...sizesMissing(reading)];

/** Where the section's height lies; undefined if the row does not state it. */
function upIn({cells, mark}: Reading, row: Row, run: Vector): Vector | undefined {
  const said = upFields.map((field) => cells(row, field));
  if (said.every((each) => each === undefined)) return undefined;
  const up = said.map((each) => numberSaid(each ?? '', mark)) as Vector;
  const across = unit(up) && unit(run) && cross(unit(up) as Vector, unit(run) as Vector);
  if (!up.every(Number.isFinite) || !across) throw new Trouble('its up_x, up_y and up_z are no direction');
  if (length(across) < 1e-6) throw new Trouble('its up lies along it');
  return rounded(unit(up) as Vector);
}

/** Without `up` if it needs one and the row has none. */
function memberOf(reading: Reading, row: Row): Omit<Member, 'id'> & {up?: Vector} {
  const [start_mm, end_mm] = [pointIn(reading, row, 'start'), pointIn(reading, row, 'end')];
  if (distance(start_mm, end_mm) === 0) throw new Trouble('it has no length');
  const said = reading.cells(row, 'priority');
  const priority = said === undefined ? undefined : decimal(said);
  if (priority !== undefined && !Number.isInteger(priority)) throw new Trouble(`its priority is no number: ${clean((said ?? '').slice(0, 80))}`);
  const size = sizeIn(reading, row);
  const up = 'kind' in size ? upIn(reading, row, minus(end_mm, start_mm)) : undefined;
  return {start_mm, end_mm, ...size, ...(up && {up}), ...(priority === undefined ? {} : {priority})};
}

const runOf = ({start_mm, end_mm}: Omit<Member, 'id'>): Vector => minus(end_mm, start_mm);
const rowsNamed = (rows: number[]): string =>
  `${rows.length === 1 ? 'row' : 'rows'} ${rows.slice(0, 5).join(', ')}${rows.length > 5 ? ` and ${rows.length - 5} more` : ''}`;

function readRows(reading: Reading, found: Found): void {
  const name = names();
  const missing = new Map<Field, number[]>();
  const [cornerless, lyingAsUsual]: [number[], number[]] = [[], []];
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
      const lying = 'kind' in member && member.up === undefined;
      if (lying) lyingAsUsual.push(row.number);
      found.members.push({id: name(reading.cells(row, 'id'), `row ${row.number}`), ...member, ...(lying && {up: usualUp(runOf(member))})} as Member);
    } catch (failure) {
      if (failure instanceof Missing)
        for (const field of failure.fields) {
          const rows = missing.get(field) ?? [];
          rows.push(row.number);
          missing.set(field, rows);
        }
      else if (failure instanceof Cornerless) cornerless.push(row.number);
      else if (failure instanceof Trouble) found.notUnderstood.push({id: `row ${row.number}`, type: 'CSV', reason: failure.message});
      else throw failure;
    }
  }
  for (const [field, rows] of missing) {
    const reason = `there is no column for ${field} (such as ${examples(field)}): ${rowsNamed(rows)} cannot be read`;
    found.notUnderstood.push({id: 'file', type: 'CSV', reason});
  }
  if (lyingAsUsual.length > 0)
    found.notUnderstood.push({id: 'file', type: 'CSV', reason: `assumed: no up_x, up_y and up_z for ${rowsNamed(lyingAsUsual)}: ${usually}`});
  if (cornerless.length > 0) {
    const text = `no corners are stated for the rectangular tubes of ${rowsNamed(cornerless)}: state --corner, ${cornersToState}`;
    found.asks.push({option: 'corner', count: cornerless.length, likely: [...standards], text});
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
    ...lengthFields(reading)
      .filter((field) => table.columns[field] !== undefined)
      .map((field) => unitIn(table, field)),
    ...(byNode ? nodes.tables.flatMap((each) => axes.map((axis) => unitIn(each, axis))) : []),
  ];
  const stated = [...new Set(units.filter((unit) => unit !== undefined && unit !== 'mm'))] as LengthUnit[];
  if (stated.length > 0 && units.includes(undefined))
    ask('unit', stated, `some columns are in ${stated.join(' and ')}, and others state no unit: state --unit ${stated[0]} or --unit mm`);
}

/** If tubes have less than 5 mm, the service does not accept them, so the numbers are not mm. */
function tooThin({members, asks}: Found, mapping: CsvMapping, table: Table<Field>): boolean {
  const outers = members.flatMap((member) => ('kind' in member ? [member.height_mm] : 'size' in member ? [] : [member.outer_diameter_mm]));
  const unstated =
    mapping.unit === undefined &&
    (['outer_diameter', 'radius', ...(members.some((each) => 'kind' in each) ? (['height', 'width'] as const) : [])] as const).every(
      (field) => table.columns[field] === undefined || unitIn(table, field) === undefined,
    );
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
  const table = membersTable(rows, mapping.columns, mapping.headings);
  const nodes = new Nodes([...nodeTables(rows), ...(mapping.nodes === undefined ? [] : nodeTables(rowsOf(mapping.nodes, found.notUnderstood)))]);
  for (const [field, column] of table.lost) {
    const said = typeof column === 'number' ? `of index ${column}` : `"${column}"`;
    found.notUnderstood.push({id: 'file', type: 'CSV', reason: `there is no column ${said} for ${field}`});
  }
  if (table.lost.length > 0) return frameOf(found, mapping, 'CSV');
  const cells = cellsOf(table);
  const counted = numberFields({table, cells, nodes, mapping});
  const numbers = [
    ...table.rows.flatMap((row) => counted.map((field) => cells(row, field) ?? '')),
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
