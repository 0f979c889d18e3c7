import type {Row} from '../json';
import {label, short4, unit} from '../names';

/** A row's scalars as a table: name, value, unit. */
export function facts(title: string, row: Row) {
  return {
    title,
    head: ['', '', ''],
    rows: Object.entries(row)
      .filter(([, v]) => typeof v !== 'object')
      .map(([k, v]) => [label(k), typeof v === 'number' ? short4(v) : String(v), unit(k)]),
  };
}
