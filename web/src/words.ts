import words from 'virtual:words';
import type {Words} from '../glossary/words';
import {keys} from './json';
import {number, unit} from './units';

/** What a name on the wire is called, and its sentence: docs/glossary.md. `within` is the name of what holds it. */
const entry = (key: string, within: string) => words.fields[`${within}.${key}`] ?? words.fields[key];
export const label = (key: string, within = '') => entry(key, within)?.[0] ?? spaced(key);
export const about = (key: string, within = '') => entry(key, within)?.[1] ?? '';

const spaced = (text: string) => text.replace(/_/g, ' ');
/** Begins with a capital, but for a symbol, which has its own case. */
export const sentence = (text: string) => (/^[a-z][a-z’'-]/.test(text) ? text.charAt(0).toUpperCase() + text.slice(1) : text);

/** A text that is told more about where one points at it. */
export type Term = string | {text: string; about: string};
export const text = (term: Term) => (typeof term === 'string' ? term : term.text);
export const hint = (term: Term) => (typeof term === 'string' ? undefined : term.about || undefined);
/** A field's name with its unit. */
export function term(key: string, within = ''): Term {
  const mark = unit(key);
  return {text: label(key, within) + (mark ? ` ${mark}` : ''), about: about(key, within)};
}

/** A warning's code, or one of a field's choices. */
export const choice = (value: unknown) => words.values[String(value)]?.[0] ?? spaced(String(value));

type Kind = keyof Pick<Words, 'checks' | 'limits'>;
/** A check of the proof, of an end or a hole too; one of `limits` may be used up. */
export function check(name: string): {name: string; about: string; kind: Kind} {
  for (let [of, rest] = ['', name]; rest; ) {
    for (const kind of ['checks', 'limits'] as const) {
      const found = words[kind][rest];
      if (found) return {name: of ? `${spaced(of)}: ${found[0]}` : found[0], about: found[1], kind};
    }
    const cut = rest.indexOf('_');
    if (cut < 0) break;
    of = name.slice(0, name.length - rest.length + cut);
    rest = rest.slice(cut + 1);
  }
  return {name: spaced(name), about: '', kind: 'checks'};
}

/** The name of the nearest object or list that holds what a pointer names. */
export const holder = (pointer: string) =>
  keys(pointer)
    .slice(0, -1)
    .filter((key) => !/^\d+$/.test(key))
    .pop() ?? '';
export const lastKey = (pointer: string) => pointer.slice(pointer.lastIndexOf('/') + 1);

/** Where a pointer leads, in words: `/cutters/1/wall_mm` is "Partners 2, wall". */
export function place(pointer: string): string {
  const path = keys(pointer);
  const out: string[] = [];
  path.forEach((key, i) => {
    if (/^\d+$/.test(key) && out.length) out[out.length - 1] += ` ${Number(key) + 1}`;
    else
      out.push(
        label(
          key,
          path
            .slice(0, i)
            .filter((each) => !/^\d+$/.test(each))
            .pop(),
        ),
      );
  });
  return sentence(out.join(', ')) || 'The request';
}

/** A sentence of the service for people: names in words, numbers short, one sign for degrees. */
export const plain = (said: string) =>
  said
    .replace(/(?:\/[a-z_0-9]+)+\/[a-z_0-9]+/g, (pointer) => place(pointer))
    .replace(/\b[a-z][a-z0-9]*(?:_[a-z0-9]+)+\b/g, (name) => words.fields[name]?.[0] ?? choice(name))
    .replace(/-?\d+\.\d+(?:e[-+]?\d+)?/g, (digits) => (digits.length > 7 ? number(Number(digits)) : digits))
    .replace(/(\d+\.\d+) (deg|mm)\b(?![/²³])/g, (all, digits, of) => (Number(digits) < 0.01 ? all : `${number(Number(digits), of === 'mm' ? of : '°')} ${of}`))
    .replace(/(\d+\.\d+)(?= to -?[\d.]+ deg\b)/g, (digits) => number(Number(digits), '°'))
    .replace(/(\d) deg\b/g, '$1°')
    .replace(/\bphi\b/g, 'φ')
    .replace(/\bdeg\b/g, '°');
