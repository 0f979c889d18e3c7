import {isRow, type Json} from './json';
import {choice, isWord, measured, place, sentence} from './words';

/** The fields of a request in the words of the form, one a line; a list of numbers is one. */
export function linesOf(value: Json, pointer = ''): [name: string, value: string][] {
  const name = () => sentence(place(pointer));
  const key = pointer.slice(pointer.lastIndexOf('/') + 1);
  if (typeof value === 'number') return [[name(), measured(key, value)]];
  if (typeof value === 'string') return [[name(), isWord(value) ? choice(value) : value]];
  if (typeof value === 'boolean') return [[name(), value ? 'yes' : 'no']];
  if (Array.isArray(value) && value.every((each) => typeof each === 'number'))
    return [[name(), value.length > 12 ? `${value.length} numbers` : value.map((each) => measured(key, each as number)).join(', ')]];
  const entries = Array.isArray(value) ? value.map((each, i) => [String(i), each] as const) : isRow(value) ? Object.entries(value) : [];
  return entries.flatMap(([part, each]) => linesOf(each as Json, `${pointer}/${part}`));
}
