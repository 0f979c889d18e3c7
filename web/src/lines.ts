import {isRow, type Json} from './json';
import {chinese, t} from './language';
import {choice, holder, isWord, measured, place, sentence} from './words';

/** Fields with names and texts that somebody gave. */
export const named = new Set([
  'id',
  'name',
  'member',
  'to',
  'between',
  'order',
  'part',
  'drawing',
  'revision',
  'heat',
  'customer_id',
  'material',
  'size',
  'machine',
  'dxf',
]);

/** The fields of a request in the words of the form, one a line; a list of numbers is one. */
export function linesOf(value: Json, pointer = ''): [name: string, value: string][] {
  const name = () => sentence(place(pointer));
  const key = pointer.slice(pointer.lastIndexOf('/') + 1);
  if (typeof value === 'number') return [[name(), measured(key, value)]];
  if (typeof value === 'string') return [[name(), isWord(value) || (chinese() && !named.has(holder(`${pointer}/`))) ? choice(value) : value]];
  if (typeof value === 'boolean') return [[name(), value ? t('yes') : t('no')]];
  if (Array.isArray(value) && value.every((each) => typeof each === 'number'))
    return [[name(), value.length > 12 ? t('{n} numbers', {n: value.length}) : value.map((each) => measured(key, each as number)).join(', ')]];
  const entries = Array.isArray(value) ? value.map((each, i) => [String(i), each] as const) : isRow(value) ? Object.entries(value) : [];
  return entries.flatMap(([part, each]) => linesOf(each as Json, `${pointer}/${part}`));
}
