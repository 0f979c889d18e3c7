import type {Json} from './json';
import type {Schema} from './schema';
import type {Issue} from './service';
import {toShown} from './units';
import {about, beside, choice, isWord, holder, label, lastKey, plain, sentence, spelled, unit, withUnit} from './words';

export const called = (pointer: string) => label(lastKey(pointer), holder(pointer));

/** Returns the meaning of a field, its range and its default. */
export function hintOf(schema: Schema, pointer: string): string {
  const mark = unit(lastKey(pointer));
  const of = (value: number) => beside(String(Math.abs(value) < 1e-6 ? 0 : Number(toShown(value, mark).toPrecision(4))), mark);
  const low = schema.minimum ?? schema.exclusiveMinimum,
    high = schema.maximum ?? schema.exclusiveMaximum;
  const range =
    low === undefined ? (high === undefined ? '' : `At most ${of(high)}.`) : high === undefined ? `At least ${of(low)}.` : `From ${of(low)} to ${of(high)}.`;
  const otherwise = schema.default === undefined || typeof schema.default === 'object' ? '' : `Without it: ${choice(schema.default)}.`;
  const told = schema.description ? plain(schema.description).replace(/\.?$/, '.') : '';
  return [`${sentence(called(pointer))}.`, about(lastKey(pointer), holder(pointer)), sentence(told), range, otherwise].filter(Boolean).join(' ');
}

/** Returns the value that applies if nothing is entered. */
export const offered = (value: Json, mark = ''): string => {
  if (typeof value === 'number') return String(Number(toShown(value, mark).toPrecision(6)));
  return Array.isArray(value) ? value.map((each) => offered(each, mark)).join(', ') : choice(value);
};

/** A value as a refusal repeats it: names that people enter stay as they are. */
export const got = (value: Json) => (typeof value === 'string' ? (isWord(value) ? choice(value) : `“${value}”`) : offered(value));

/** Returns a problem's text for a field. */
export function said(issue: Issue): string {
  const code = choice(issue.code);
  const bound = typeof issue.limit === 'number' ? withUnit(issue.limit, spelled(issue.unit ?? '')) : issue.limit;
  const limit = bound === null || bound === undefined || typeof bound === 'object' ? '' : ` (limit ${bound})`;
  return sentence(issue.hint ? `${code}: ${plain(issue.hint)}` : plain(`${code}${limit}`).trim());
}
