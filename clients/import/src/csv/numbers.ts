import {clean} from '../frame.js';
import {decimal, lengths, type LengthUnit} from '../units.js';

/** Why a row is not in the frame. */
export class Trouble extends Error {}

const units: Record<string, LengthUnit> = {
  mm: 'mm',
  millimetre: 'mm',
  millimetres: 'mm',
  millimeter: 'mm',
  millimeters: 'mm',
  cm: 'cm',
  m: 'm',
  metre: 'm',
  metres: 'm',
  meter: 'm',
  meters: 'm',
  in: 'in',
  inch: 'in',
  inches: 'in',
  '"': 'in',
  '″': 'in',
  "''": 'in',
  zoll: 'in',
  ft: 'ft',
  feet: 'ft',
  foot: 'ft',
  "'": 'ft',
};

/** A unit of length by its name, as tables write it. */
export const unitNamed = (name: string): LengthUnit | undefined => {
  const key = name
    .trim()
    .toLowerCase()
    .replace(/^[([]|[)\]]$/g, '')
    .trim();
  return Object.hasOwn(units, key) ? units[key] : undefined;
};

export type Mark = '.' | ',';
const thousands = /^[-+]?\d{1,3}(?:[.,]\d{3}){1,8}$/;
const withComma = /^[-+]?\d{0,40},\d{1,40}(?:[eE][-+]?\d{1,4})?$/;

/**
 * Returns the decimal mark of a table's numbers; undefined if, like "1,234", they do not show it.
 */
export function markOf(cells: string[]): Mark | undefined {
  let [comma, point, unclear] = [false, false, false];
  for (const cell of cells) {
    const text = cell.trim().split(/[\s"'″]/, 1)[0] ?? '';
    if (text.length > 64) continue;
    if (thousands.test(text) && text.includes(',')) unclear = true;
    else if (withComma.test(text) || /^[-+]?\d{1,3}(?:\.\d{3}){1,8},\d+$/.test(text)) comma = true;
    else if (/^[-+]?\d{0,40}\.\d/.test(text)) point = true;
  }
  if (comma && !point) return ',';
  if (point || !unclear) return '.';
  return undefined;
}

/** "1 1/2", "1-1/2" or "3/4", as inches are written. */
function fraction(text: string): number {
  const [, whole, over, under] = /^(?:(\d{1,6})[ -])?(\d{1,4})\/(\d{1,4})$/.exec(text) ?? [];
  return over === undefined || Number(under) === 0 ? Number.NaN : Number(whole ?? 0) + Number(over) / Number(under);
}

/** Returns a number as the table writes it; NaN if it is not a number. */
export function numberSaid(text: string, mark: Mark): number {
  if (mark === '.') return decimal(/^[-+]?\d{1,3}(?:,\d{3}){1,8}(?:\.\d*)?$/.test(text) && text.includes('.') ? text.replace(/,/g, '') : text);
  return text.includes(',') || thousands.test(text) ? decimal(text.replace(/\./g, '').replace(',', '.')) : decimal(text);
}

/** A length in mm. A unit in the cell counts before that of its column. */
export function lengthSaid(said: string, field: string, unit: LengthUnit, mark: Mark): number {
  const text = said.slice(0, 80).trim();
  const [, number, own] = /^([-+]?[\d.,/ -]*[\d.,](?:[eE][-+]?\d+)?) ?([a-z"'″]{0,12})$/i.exec(text) ?? [];
  const of = own ? unitNamed(own) : unit;
  const value = number === undefined ? Number.NaN : numberSaid(number, mark);
  const inches = of === 'in' && Number.isNaN(value) && number !== undefined ? fraction(number) : value;
  if (of === undefined || !Number.isFinite(inches)) throw new Trouble(`its ${field} is no number: ${clean(said.slice(0, 80))}`);
  return inches * lengths[of];
}
