import {caption} from '../captions';
import {isRow, type Json, type Row} from '../json';
import {t} from '../language';
import type {Figure, Picture, Table} from '../picture';
import {column} from '../picture';
import {shownUnit} from '../units';
import {about, choice, label, measured, sentence, shown, type Term, unit} from '../words';

/** Fields with captions of the service in them. */
const captions = new Set(['name', 'measured_from', 'changes_with', 'what', 'tool']);

/** A value of an answer as people read it, without its unit. */
export function text(key: string, value: Json | undefined): string {
  if (typeof value === 'number') return shown(key, value);
  if (typeof value === 'boolean') return value ? t('yes') : t('no');
  if (Array.isArray(value)) return value.map((each) => text(key, each)).join(', ');
  if (value === undefined || value === null) return '';
  if (!isRow(value)) return captions.has(key) ? caption(choice(value)) : choice(value);
  return Object.entries(value)
    .map(([name, each]) => (typeof each === 'number' ? `${label(name)} ${measured(name, each)}` : `${label(name)} ${text(name, each)}`))
    .join(', ');
}

export const figure = (key: string, value: Json | undefined, within = ''): Figure => ({
  name: label(key, within),
  value: text(key, value),
  unit: unit(key),
  about: about(key, within),
});
export const figures = (row: Row | undefined, keys: string[], within = '') =>
  keys.filter((key) => row && key in row).map((key) => figure(key, row?.[key], within));

/** A row's scalars as a table: name, value, unit. */
export function facts(key: string, row: Row, title = sentence(label(key))): Table {
  return {
    title,
    head: ['', '', ''],
    rows: Object.entries(row)
      .filter(([, v]) => typeof v !== 'object')
      .map(([k, v]) => [{text: label(k, key), about: about(k, key)}, text(k, v), shownUnit(unit(k))]),
  };
}

/** The readout of columns at a point: each by the name of its field, or by another. */
export const readings = (rows: Row, i: number, keys: string[], within = 'points'): [Term, string][] =>
  keys.filter((key) => Array.isArray(rows[key])).map((key) => [{text: label(key, within), about: about(key, within)}, at(rows, key, i)]);

export function at(rows: Row, key: string, i: number): string {
  const values = column(rows[key]);
  return measured(key, values[i % values.length] as number);
}

export type Told = Pick<Picture, 'figures' | 'tables' | 'readout' | 'said'>;
