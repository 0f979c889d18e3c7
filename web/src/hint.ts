import type {Json} from './json';
import {chinese, t} from './language';
import type {Schema} from './schema';
import type {Issue, Problem} from './service';
import {toShown} from './units';
import {about, beside, choice, isWord, holder, label, lastKey, plain, saidOf, sentence, sentences, spelled, unit, withUnit} from './words';

export const called = (pointer: string) => label(lastKey(pointer), holder(pointer));

/** Returns the meaning of a field, its range and its default. */
export function hintOf(schema: Schema, pointer: string): string {
  const mark = unit(lastKey(pointer));
  const of = (value: number) => beside(String(Math.abs(value) < 1e-6 ? 0 : Number(toShown(value, mark).toPrecision(4))), mark);
  const low = schema.minimum ?? schema.exclusiveMinimum,
    high = schema.maximum ?? schema.exclusiveMaximum;
  const range =
    low === undefined
      ? high === undefined
        ? ''
        : t('At most {high}.', {high: of(high)})
      : high === undefined
        ? t('At least {low}.', {low: of(low)})
        : t('From {low} to {high}.', {low: of(low), high: of(high)});
  const otherwise = schema.default === undefined || typeof schema.default === 'object' ? '' : t('Without it: {value}.', {value: choice(schema.default)});
  return sentences(
    t('{text}.', {text: sentence(called(pointer))}),
    about(lastKey(pointer), holder(pointer)),
    sentence(described(schema.description ?? '')),
    range,
    otherwise,
  );
}

/** Returns a description of the contract. In Chinese an untranslated one is omitted, because an English sentence in a Chinese hint helps nobody. */
function described(text: string): string {
  const translated = t(text);
  if (chinese()) return translated === text ? '' : translated;
  return text ? plain(text).replace(/\.?$/, '.') : '';
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
  const translated = saidOf('errors', issue.code);
  if (translated) return inChinese(issue, ...translated);
  const bound = typeof issue.limit === 'number' ? withUnit(issue.limit, spelled(issue.unit ?? '')) : issue.limit;
  const limit = bound === null || bound === undefined || typeof bound === 'object' ? '' : ` (limit ${bound})`;
  return sentence(issue.hint ? `${code}: ${plain(issue.hint)}` : plain(`${code}${limit}`).trim());
}

const simple = (value: unknown): value is string | number | boolean => ['string', 'number', 'boolean'].includes(typeof value);

/** Meaning, value and limit with their unit, action. */
function inChinese({got: given, limit, unit: of}: Issue, meaning: string, action: string): string {
  const mark = spelled(of ?? '');
  const measured = (value: Json) => (typeof value === 'number' ? withUnit(value, mark) : got(value));
  const values = [
    ...(simple(given) ? [t('given {value}', {value: measured(given)})] : []),
    ...(simple(limit) ? [t('limit {value}', {value: measured(limit)})] : []),
  ].join(t(', '));
  const [, sentence = meaning, stop = ''] = /^(.*?)([。.]?)$/.exec(meaning) ?? [];
  return `${sentence}${values ? `（${values}）` : ''}${stop}${action}`;
}

/** Returns the service's own words for a problem at a field if the page is Chinese, because they have values that the code lacks. */
export const originalOf = ({hint}: Issue): string => (chinese() && hint ? plain(hint) : '');

/** Returns the reason for a refusal, in a sentence or two. */
export function refusalOf({code, title, detail = ''}: Problem): string {
  const translated = saidOf('errors', code)?.join('');
  return plain(`${translated ?? t(title)} ${detail}`).trim();
}
