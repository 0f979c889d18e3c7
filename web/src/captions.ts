import words from 'virtual:words';
import type {Dictionary} from './chinese';
import {chinese} from './language';
import {filled} from './texts';

// The service writes English, and so do the readers of models. Their captions and reasons are few, some of them with values.

interface Pattern {
  found: RegExp;
  names: string[];
  said: string;
}
interface Captions {
  whole: Map<string, string>;
  patterns: Pattern[];
}

const places = /\{(\w+)\}/g;
/** One letter is a place of a number, `hole` one of a hole's number, `entity` one of IFC; other places take any text. */
const kinds: Record<string, string> = {hole: 'H\\d+', entity: '#\\d+ \\w+'};
const placeOf = (name: string) => `(${kinds[name] ?? (name.length === 1 ? '[-+]?\\d.*?' : '.+?')})`;
/** Places of several captions: between two of them, in English and in Chinese. */
const lists: Record<string, [RegExp, string]> = {list: [/[,;] /, '，'], choices: [/ or /, ' 或 '], causes: [/, and /, '；']};
const literally = (text: string) => text.replace(/[\\^$.*+?()[\]|]/g, '\\$&');

function patternOf(english: string, said: string): Pattern {
  const names = [...english.matchAll(places)].map(([, name]) => name as string);
  const parts = english.split(/\{\w+\}/).map(literally);
  const source = parts.map((part, i) => (i < names.length ? part + placeOf(names[i] as string) : part)).join('');
  return {found: new RegExp(`^${source}$`), names, said};
}

/** Names of the glossary, by their English ones. */
function* namesIn(dictionary: Dictionary): Generator<[english: string, translated: string]> {
  for (const kind of ['fields', 'values'] as const) {
    for (const [key, [english]] of Object.entries(words[kind])) {
      const said = dictionary.words[kind][key]?.[0];
      if (said) yield [english, said];
    }
  }
}

const made = new WeakMap<object, Captions>();
function captionsOf(table: Record<string, string>, names?: Dictionary): Captions {
  const found = made.get(table);
  if (found) return found;
  const all = Object.entries(table);
  const fixed = all.filter(([english]) => !english.includes('{'));
  const captions = {
    whole: new Map([...(names ? namesIn(names) : []), ...fixed]),
    // The longest first, because a short one also fits the texts of a longer one.
    patterns: all
      .filter(([english]) => english.includes('{'))
      .sort(([a], [b]) => b.length - a.length)
      .map(([english, said]) => patternOf(english, said)),
  };
  made.set(table, captions);
  return captions;
}

function captioned(text: string, captions: Captions): string {
  const whole = captions.whole.get(text);
  if (whole !== undefined) return whole;
  for (const {found, names, said} of captions.patterns) {
    const values = found.exec(text)?.slice(1);
    if (!values) continue;
    const inner = (name: string, value: string) => {
      const [split, joined] = lists[name] ?? [];
      if (split && joined)
        return value
          .split(split)
          .map((each) => captioned(each, captions))
          .join(joined);
      return name.startsWith('caption') ? captioned(value, captions) : value.trim();
    };
    return filled(said, Object.fromEntries(names.map((name, i) => [name, inner(name, values[i] as string)])));
  }
  const list = text.split(', ');
  return list.length > 1 && list.every((each) => captions.whole.has(each)) ? list.map((each) => captions.whole.get(each)).join('，') : text;
}

/** Returns a caption of the service in the language of the page; if it is unknown, the text itself. */
export function caption(text: string): string {
  const dictionary = chinese();
  return dictionary ? captioned(text, captionsOf(dictionary.captions, dictionary)) : text;
}

/** The same of a reason that a reader of models gives, or of a place in its file. */
export function cause(text: string): string {
  const dictionary = chinese();
  return dictionary ? captioned(text, captionsOf(dictionary.reasons)) : text;
}
