import {isRow, type Json, type Row} from '../json';
import {column, type Chart, type Picture, type Table} from '../picture';
import type {Answer} from '../service';
import {about, label, sentence, term, unit} from '../words';
import {facts, figure, text} from './facts';

/** Any answer: numbers as figures, lists as tables, columns of one length as charts. */
export async function generic(_: Row, answer: Answer): Promise<Picture> {
  const picture: Picture = {charts: [], figures: [], tables: []};
  walk(answer.result, '', picture);
  return picture;
}

function walk(row: Row, path: string, picture: Picture): void {
  const scalars = Object.entries(row).filter(([, v]) => typeof v !== 'object');
  if (path && scalars.length) picture.tables?.push(facts(path, Object.fromEntries(scalars)));
  else picture.figures.push(...scalars.map(([k, v]) => figure(k, v)));
  for (const [key, value] of Object.entries(row)) {
    if (isRow(value)) {
      const chart = columns(key, value);
      if (chart) picture.charts.push(chart);
      else walk(value, key, picture);
    } else if (Array.isArray(value) && isRow(value[0])) picture.tables?.push(table(key, value as Row[]));
  }
}

/** Returns a list of rows; only numbers may come from JSON with any number of digits. */
export function table(key: string, rows: Row[]): Table {
  const names = [...new Set(rows.flatMap((row) => Object.keys(row)))].filter((name) => rows.some((row) => !isRow(row[name])));
  return {
    id: key,
    title: sentence(label(key)),
    head: names.map((name) => term(name, key)),
    rows: rows.map((row) => names.map((name) => text(name, row[name]))),
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
    x: {name: label(first[0], key), unit: unit(first[0]), values: column(first[1])},
    series: others.slice(0, 6).map(([name, values], i) => ({name: label(name, key), about: about(name, key), values: column(values), tone: `series-${i}`})),
  };
}
