#!/usr/bin/env node
// node dist/main.js FILE [options] > frame.json
import {readFileSync} from 'node:fs';
import {extname} from 'node:path';
import {parseArgs} from 'node:util';
import {fields, fromCsv, fromDxf, fromIfc, fromPcf, type Imported, lengths, type LengthUnit, printed, type Size} from './index.js';

const usage = `usage: node dist/main.js FILE [options] > frame.json

FILE is .ifc, .pcf, .csv or .dxf. What was not understood goes to the standard error, a line each.

  --within MM          an end joins what it comes as near as this to (5)
  --origin X,Y,Z       this point of the file, in mm, is the frame's origin; the service takes 1 km about it
  --fields JSON        fields of the request instead of ours, for example {"kerf_mm": 2}
  --corner MM          IFC: corner radius of rectangular tubes that the file draws sharp; without it they are not understood
  --schedule NAME      PCF: of pipes whose wall the file does not tell, for example "SCH 40"
  --wall-attribute A   PCF: the attribute that tells a wall (WALL-THICKNESS)
  --unit UNIT          CSV, DXF: mm, cm, m, in or ft; CSV is in mm without it, DXF in what the drawing tells
  --column FIELD=NAME  CSV: the column of a field (${fields.join(', ')})
  --size SIZE          CSV: of rows without their own, "114.3x6.3" (mm) or "NPS 4 SCH 40"
  --layer NAME=SIZE    DXF: the size of what is drawn on a layer; the others are not understood

ends with 0, 1 (no frame could be made), 2 (wrong usage), 3 (a frame, and something that was not understood)
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
    // said below
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
      'wall-attribute': text,
      unit: text,
      column: list,
      size: text,
      layer: list,
    };
    return parseArgs({allowPositionals: true, options});
  } catch (failure) {
    throw new Usage((failure as Error).message);
  }
}

async function imported(): Promise<Imported> {
  const {values, positionals} = asked();
  const [file, ...rest] = positionals;
  if (file === undefined || rest.length > 0) throw new Usage('one FILE');
  const [within, corner] = [values.within, values.corner].map((each) => (each === undefined ? undefined : Number(each)));
  if (within !== undefined && !(within >= 0)) throw new Usage('--within is a number of mm');
  if (corner !== undefined && !(corner > 0)) throw new Usage('--corner is a number of mm, more than 0');
  const common = {
    ...(within === undefined ? {} : {within_mm: within}),
    ...(values.origin === undefined ? {} : {origin_mm: originOf(values.origin)}),
    ...(values.fields === undefined ? {} : {fields: objectOf(values.fields)}),
  };
  const columns = Object.fromEntries(pairs(values.column, 'column'));
  for (const field of Object.keys(columns)) if (!(fields as readonly string[]).includes(field)) throw new Usage(`--column knows no field ${field}`);
  const layers = Object.fromEntries(pairs(values.layer, 'layer').map(([layer, size]) => [layer, sizeOf(size)]));
  const unit = unitOf(values.unit);
  const {schedule, 'wall-attribute': wallAttribute, size} = values;
  const readers: Record<string, (bytes: Buffer) => Imported | Promise<Imported>> = {
    '.ifc': (bytes) => fromIfc(bytes, {...common, ...(corner === undefined ? {} : {corner_radius_mm: corner})}),
    '.pcf': (bytes) => fromPcf(bytes.toString(), {...common, ...(schedule ? {schedule} : {}), ...(wallAttribute ? {wallAttribute} : {})}),
    '.csv': (bytes) => fromCsv(bytes.toString(), {...common, ...unit, columns, ...(size ? {size: sizeOf(size)} : {})}),
    '.dxf': (bytes) => fromDxf(bytes.toString(), layers, {...common, ...unit}),
  };
  const reader = readers[extname(file).toLowerCase()];
  if (!reader) throw new Usage(`${file} is none of ${Object.keys(readers).join(', ')}`);
  return reader(readFileSync(file));
}

try {
  const {frame, notUnderstood} = await imported();
  for (const {id, type, reason} of notUnderstood) console.error(`${id} ${type}: ${reason}`);
  if (frame) process.stdout.write(printed(frame));
  else console.error('no member was found: there is no frame');
  process.exitCode = !frame ? 1 : notUnderstood.length > 0 ? 3 : 0;
} catch (failure) {
  const wrong = failure instanceof Usage;
  console.error(wrong ? `${failure.message}\n\n${usage}` : (failure as Error).message);
  process.exitCode = wrong ? 2 : 1;
}
