import words from 'virtual:words';
import type {Dictionary} from './chinese';
import {chinese} from './language';
import {filled} from './texts';

// The service writes English. Its drawings and lists have few captions, some of them with values.

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
/** One letter is a place of a number, `hole` one of a hole's number; other places take any text. */
const kinds: Record<string, string> = {hole: 'H\\d+'};
const placeOf = (name: string) => `(${kinds[name] ?? (name.length === 1 ? '[-+]?\\d.*?' : '.+?')})`;
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

const made = new WeakMap<Dictionary, Captions>();
function captionsOf(dictionary: Dictionary): Captions {
  const found = made.get(dictionary);
  if (found) return found;
  const all = Object.entries(dictionary.captions);
  const fixed = all.filter(([english]) => !english.includes('{'));
  const captions = {
    whole: new Map([...namesIn(dictionary), ...fixed]),
    // The longest first, because a short one also fits the texts of a longer one.
    patterns: all
      .filter(([english]) => english.includes('{'))
      .sort(([a], [b]) => b.length - a.length)
      .map(([english, said]) => patternOf(english, said)),
  };
  made.set(dictionary, captions);
  return captions;
}

function captioned(text: string, captions: Captions): string {
  const whole = captions.whole.get(text);
  if (whole !== undefined) return whole;
  for (const {found, names, said} of captions.patterns) {
    const values = found.exec(text)?.slice(1);
    if (!values) continue;
    const inner = (name: string, value: string) => {
      if (name === 'list')
        return value
          .split(/[,;] /)
          .map((each) => captioned(each, captions))
          .join('，');
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
  return dictionary ? captioned(text, captionsOf(dictionary)) : text;
}
