#!/usr/bin/env node
// node dist/main.js FILE [options] > request.json
import {readFileSync, writeFileSync} from 'node:fs';
import {extname} from 'node:path';
import {parseArgs} from 'node:util';
import {
  boreMap,
  type CornerOptions,
  fields,
  fromCsv,
  fromDxf,
  fromIfc,
  fromNc1,
  fromPcf,
  type Imported,
  type ImportedPart,
  lengths,
  type LengthUnit,
  printed,
  type Size,
  standards,
} from './index.js';

const usage = `usage: node dist/main.js FILE [options] > request.json

FILE is .ifc, .pcf, .csv, .tsv, .txt (a table) or .dxf, which become a frame, or .nc1, .nc or .dstv (NC1 of one tube), which becomes a part.
Items that are not in it, and assumptions, go to the standard error, one per line.

  --within MM          an end joins bodies within this distance (5)
  --origin X,Y,Z       this point of the file, in mm, is the frame's origin; the service takes 1 km about it
  --merge-in-line      members that continue in line become one piece
  --fields JSON        fields of the request instead of ours, for example {"kerf_mm": 2}
  --sources FILE       writes a CSV of the ids of the frame with their entities and GUIDs
  --corner CORNER      IFC, CSV, DXF, NC1: corners of rectangular tubes that the file does not state or draws too sharp to be cut:
                       en_10219 (cold formed), en_10210 (hot finished), astm_a500, or the radius outside in mm
  --schedule NAME      PCF: of pipes whose wall the file does not state, for example "SCH 40"
  --bore BORE=SIZE     PCF: meaning of a bore: "152.4=NPS 6", "160=DN 150", "168=168.3" (outside diameter in mm), "168=168.3x7.11"
  --wall-attribute A   PCF: the attribute that states a wall (WALL-THICKNESS)
  --unit UNIT          CSV, DXF: mm, cm, m, in or ft, of lengths that state no unit; default: mm for CSV, the drawing's unit for DXF
  --column FIELD=NAME  CSV: the column of a field (${fields.join(', ')})
  --no-headings        CSV: no row has headings; --column then names columns by their numbers from 1
  --nodes FILE         CSV: the table of nodes, if it is not in the same file (columns node, x, y, z)
  --decimal MARK       CSV: comma or point, if the numbers leave it open
  --size SIZE          CSV: of rows without their own, "114.3x6.3" (mm), "NPS 4 SCH 40" or "RHS 60x40x3 EN 10219"
  --layer NAME=SIZE    DXF: the size of a layer's tubes; the other layers are listed

ends with 0, 1 (no frame or part could be made), 2 (wrong usage), 3 (a frame or a part, and something is not in it or was assumed),
4 (options are missing: the last lines state which; the standard output has the part that could be read without them)
`;

class Usage extends Error {}

/** "114.3x6.3" in mm, or a name of the service's. */
function sizeOf(text: string): Size {
  const found = /^(\d+(?:\.\d+)?)\s*x\s*(\d+(?:\.\d+)?)$/.exec(text);
  return found ? {outer_diameter_mm: Number(found[1]), wall_mm: Number(found[2])} : {size: text};
}

function pairs(given: string[] | undefined, option: string): [string, string][] {
  return (given ?? []).map((each) => {
    const at = each.indexOf('=');
    if (at < 1) throw new Usage(`--${option} takes NAME=VALUE, not ${each}`);
    return [each.slice(0, at), each.slice(at + 1)];
  });
}

function unitOf(text: string | undefined): {unit?: LengthUnit} {
  if (text === undefined) return {};
  if (!Object.keys(lengths).includes(text)) throw new Usage(`--unit is one of ${Object.keys(lengths).join(', ')}`);
  return {unit: text as LengthUnit};
}

function objectOf(text: string): Record<string, unknown> {
  try {
    const value: unknown = JSON.parse(text);
    if (value && typeof value === 'object' && !Array.isArray(value)) return value as Record<string, unknown>;
  } catch {
    // reported below
  }
  throw new Usage('--fields is no JSON object');
}

function originOf(text: string): [number, number, number] {
  const [x, y, z, ...rest] = text.split(',').map((each) => (each.trim() === '' ? Number.NaN : Number(each)));
  if (x === undefined || y === undefined || z === undefined || rest.length > 0 || ![x, y, z].every(Number.isFinite)) throw new Usage('--origin is X,Y,Z in mm');
  return [x, y, z];
}

function asked() {
  try {
    const text = {type: 'string'} as const;
    const list = {type: 'string', multiple: true} as const;
    const options = {
      within: text,
      origin: text,
      corner: text,
      fields: text,
      schedule: text,
      'merge-in-line': {type: 'boolean'} as const,
      sources: text,
      bore: list,
      nodes: text,
      decimal: text,
      'wall-attribute': text,
      unit: text,
      column: list,
      'no-headings': {type: 'boolean'} as const,
      size: text,
      layer: list,
    };
    return parseArgs({allowPositionals: true, options});
  } catch (failure) {
    throw new Usage((failure as Error).message);
  }
}

function boresOf(given: string[] | undefined): {bores?: Record<string, string>} {
  if (given === undefined) return {};
  const bores = Object.fromEntries(pairs(given, 'bore'));
  try {
    boreMap(bores);
  } catch (failure) {
    throw new Usage(`--bore: ${(failure as Error).message}`);
  }
  return {bores};
}

function columnsOf(given: string[] | undefined, numbered: boolean): {columns: Record<string, string | number>; headings?: false} {
  const said = pairs(given, 'column');
  for (const [field, column] of said) {
    if (!(fields as readonly string[]).includes(field)) throw new Usage(`--column knows no field ${field}`);
    if (numbered && !/^[1-9]\d{0,3}$/.test(column)) throw new Usage(`--column ${field}=${column}: with --no-headings it takes the number of a column, from 1`);
  }
  if (!numbered) return {columns: Object.fromEntries(said)};
  return {columns: Object.fromEntries(said.map(([field, column]) => [field, Number(column) - 1])), headings: false};
}

function decimalOf(text: string | undefined): {decimal?: '.' | ','} {
  if (text === undefined) return {};
  if (text !== 'comma' && text !== 'point') throw new Usage('--decimal is comma or point');
  return {decimal: text === 'comma' ? ',' : '.'};
}

function cornerOf(text: string | undefined): CornerOptions {
  if (text === undefined) return {};
  const corners = standards.find((each) => each === text);
  if (corners) return {corners};
  const corner_radius_mm = Number(text);
  if (!(corner_radius_mm > 0)) throw new Usage(`--corner is one of ${standards.join(', ')}, or a number of mm, more than 0`);
  return {corner_radius_mm};
}

const quoted = (cell: string): string => (/[",\n]/.test(cell) ? `"${cell.replace(/"/g, '""')}"` : cell);
const table = ({sources}: Imported | ImportedPart): string =>
  [['id', 'entity', 'type', 'guid'], ...sources.map(({id, entity, type, guid}) => [id, entity, type, guid ?? ''])]
    .map((row) => `${row.map(quoted).join(',')}\n`)
    .join('');

/** The options that are missing, as they would be written. */
function missing({asks}: Imported | ImportedPart): string[] {
  const bores = asks.filter(({option}) => option === 'bore').map(({key, likely}) => `--bore "${key}=${likely[0] ?? 'SIZE'}"`);
  const others = [
    ...new Set(asks.filter(({option}) => option !== 'bore').map(({option, likely}) => `--${option}${option === 'corner' ? ` ${likely[0]}` : ''}`)),
  ];
  return asks.length === 0 ? [] : [`Options are missing. Check the likely values, then state: ${[...bores, ...others].join(' ')}`];
}

async function imported(): Promise<Imported | ImportedPart> {
  const {values, positionals} = asked();
  const [file, ...rest] = positionals;
  if (file === undefined || rest.length > 0) throw new Usage('one FILE');
  const within = values.within === undefined ? undefined : Number(values.within);
  if (within !== undefined && !(within >= 0)) throw new Usage('--within is a number of mm');
  const corner = cornerOf(values.corner);
  const common = {
    ...(within === undefined ? {} : {within_mm: within}),
    ...(values.origin === undefined ? {} : {origin_mm: originOf(values.origin)}),
    ...(values['merge-in-line'] ? {merge_in_line: true} : {}),
    ...(values.fields === undefined ? {} : {fields: objectOf(values.fields)}),
  };
  const tableColumns = columnsOf(values.column, values['no-headings'] === true);
  const layers = Object.fromEntries(pairs(values.layer, 'layer').map(([layer, size]) => [layer, sizeOf(size)]));
  const unit = unitOf(values.unit);
  const {schedule, 'wall-attribute': wallAttribute, size, nodes} = values;
  const [bores, mark] = [boresOf(values.bore), decimalOf(values.decimal)];
  const ofTables = {...unit, ...mark, ...corner, ...tableColumns, ...(size ? {size: sizeOf(size)} : {})};
  const csv = (bytes: Buffer) => fromCsv(bytes.toString(), {...common, ...ofTables, ...(nodes === undefined ? {} : {nodes: readFileSync(nodes, 'utf8')})});
  const nc1 = (bytes: Buffer) => fromNc1(bytes, {...corner, ...(common.fields ? {fields: common.fields} : {})});
  const readers: Record<string, (bytes: Buffer) => Imported | ImportedPart | Promise<Imported>> = {
    '.ifc': (bytes) => fromIfc(bytes, {...common, ...corner}),
    '.pcf': (bytes) => fromPcf(bytes.toString(), {...common, ...(schedule ? {schedule} : {}), ...bores, ...(wallAttribute ? {wallAttribute} : {})}),
    '.csv': csv,
    '.tsv': csv,
    '.txt': csv,
    '.dxf': (bytes) => fromDxf(bytes.toString(), layers, {...common, ...unit, ...corner}),
    '.nc1': nc1,
    '.nc': nc1,
    '.dstv': nc1,
  };
  const reader = readers[extname(file).toLowerCase()];
  if (!reader) throw new Usage(`${file} is none of ${Object.keys(readers).join(', ')}`);
  const found = await reader(readFileSync(file));
  if (values.sources !== undefined) writeFileSync(values.sources, table(found));
  return found;
}

try {
  const found = await imported();
  const {notUnderstood} = found;
  const request = 'part' in found ? found.part : found.frame;
  for (const {id, type, reason} of notUnderstood) console.error(`${id} ${type}: ${reason}`);
  for (const line of missing(found)) console.error(line);
  if (request) process.stdout.write(printed(request));
  else console.error(`there is no ${'part' in found ? 'part' : 'frame'}`);
  process.exitCode = found.asks.length > 0 ? 4 : !request ? 1 : notUnderstood.length > 0 ? 3 : 0;
} catch (failure) {
  const wrong = failure instanceof Usage;
  console.error(wrong ? `${failure.message}\n\n${usage}` : (failure as Error).message);
  process.exitCode = wrong ? 2 : 1;
}
