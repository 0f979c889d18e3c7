import {isRow, type Json, type Row} from '../json';
import {label, sentence, short4, unit} from '../names';
import {column, type Chart, type Picture, type Table} from '../picture';
import type {Answer} from '../service';
import {facts} from './facts';

export const text = (value: Json | undefined): string =>
  typeof value === 'number' ? short4(value) : value === undefined || value === null ? '' : typeof value === 'object' ? JSON.stringify(value) : String(value);

/** Any answer: numbers as figures, lists as tables, columns of one length as charts. */
export async function generic(_: Row, answer: Answer): Promise<Picture> {
  const picture: Picture = {charts: [], figures: [], tables: []};
  walk(answer.result, '', picture);
  return picture;
}

function walk(row: Row, path: string, picture: Picture): void {
  const scalars = Object.entries(row).filter(([, v]) => typeof v !== 'object');
  if (path && scalars.length) picture.tables?.push(facts(sentence(label(path)), Object.fromEntries(scalars)));
  else picture.figures.push(...scalars.map(([k, v]) => ({name: label(k), value: text(v), unit: unit(k)})));
  for (const [key, value] of Object.entries(row)) {
    if (isRow(value)) {
      const chart = columns(key, value);
      if (chart) picture.charts.push(chart);
      else walk(value, key, picture);
    } else if (Array.isArray(value) && isRow(value[0])) picture.tables?.push(table(key, value as Row[]));
  }
}

export function table(key: string, rows: Row[]): Table {
  const names = [...new Set(rows.flatMap((row) => Object.keys(row)))].filter((name) => rows.some((row) => typeof row[name] !== 'object'));
  return {
    id: key,
    title: sentence(label(key)),
    head: names.map((n) => `${label(n)} ${unit(n)}`.trim()),
    rows: rows.map((row) => names.map((n) => text(row[n]))),
  };
}

function columns(key: string, row: Row): Chart | undefined {
  const lists = Object.entries(row).filter(([, v]) => Array.isArray(v) && typeof v[0] === 'number');
  const length = (lists[0]?.[1] as Json[] | undefined)?.length ?? 0;
  if (lists.length < 2 || length < 3 || lists.some(([, v]) => (v as Json[]).length !== length)) return undefined;
  const [first, ...others] = lists as [[string, Json], ...[string, Json][]];
  return {
    id: key,
    title: sentence(label(key)),
    link: key,
    unit: '',
    x: {name: label(first[0]), unit: unit(first[0]), values: column(first[1])},
    series: others.slice(0, 6).map(([name, values], i) => ({name: label(name), values: column(values), tone: `series-${i}`})),
  };
}
