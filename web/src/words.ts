import words from 'virtual:words';
import type {Words} from '../glossary/words';
import {keys} from './json';
import {chinese, t} from './language';
import {shownUnit, toShown} from './units';

// How values, names and sentences are written for people: numbers with their units, then words.

/** Units by how names on the wire end; the longest first. */
const units: [string, string][] = [
  ['_deg_per_mm2', '°/mm²'],
  ['_deg_per_mm', '°/mm'],
  ['_rad_per_mm', 'rad/mm'],
  ['rad_per_mm', 'rad/mm'],
  ['_deg_mm', '° mm'],
  ['_kg_m3', 'kg/m³'],
  ['_kg_per_m', 'kg/m'],
  ['_per_hour', '1/h'],
  ['_rev_min', '1/min'],
  ['_mm_min', 'mm/min'],
  ['mm_min', 'mm/min'],
  ['_m_min', 'm/min'],
  ['_mm_s3', 'mm/s³'],
  ['_mm_s2', 'mm/s²'],
  ['_mm_s', 'mm/s'],
  ['_mm3_s', 'mm³/s'],
  ['_mm3', 'cm³'],
  ['_mm2', 'mm²'],
  ['_mm', 'mm'],
  ['_deg', '°'],
  ['_rad', 'rad'],
  ['_ms', 'ms'],
  ['_us', 'µs'],
  ['_um', 'µm'],
  ['_kg', 'kg'],
  ['_pulses', 'pulses'],
  ['relative_error', '%'],
  ['_ripple', '%'],
  ['_s', 's'],
];

export const unit = (name: string): string => units.find(([ending]) => name.endsWith(ending))?.[1] ?? '';

/** The service's own spelling of a unit, as in `verification`. */
export const spelled = (text: string) => (text === 'mm3' ? 'mm³' : unit(`_${text}`) || (text === 'ratio' ? '' : text));

const places: Record<string, number> = {
  in: 3,
  'in/min': 1,
  'in/s': 3,
  mm: 2,
  '°': 1,
  '%': 1,
  ms: 1,
  µs: 0,
  µm: 2,
  kg: 2,
  'mm/min': 0,
  'm/min': 1,
  'mm/s': 2,
  '1/h': 1,
};
const most = 6; // significant digits that anybody is shown
const rounding = 1e-9; // below it, a length or an angle is rounding error

/** The one way that numbers are written for people: 0.01 mm, 0.1°, a time to a digit that means something; without the unit. `unit` is one of the
 *  wire; the number is in the unit that is shown. */
export function number(given: number, unit = ''): string {
  const [value, of] = [toShown(given, unit), shownUnit(unit)];
  if (!Number.isFinite(value)) return '–';
  if (Math.abs(value) < rounding) return '0';
  const size = Math.abs(value);
  const digits = of === 's' ? (size >= 100 ? 1 : size >= 10 ? 2 : 3) : places[of];
  if (digits === undefined && Number.isInteger(value) && size < 10 ** most) return String(value); // a count
  const rounded = digits === undefined ? Number(value.toPrecision(4)) : Number(value.toFixed(digits));
  if (digits === undefined ? size < 1e-6 : rounded === 0) return tiny(value);
  const short = Number(rounded.toPrecision(most));
  return short >= 1e15 ? short.toExponential() : String(short);
}

/** A nonzero value that would read as 0. */
const tiny = (value: number) => (Math.abs(value) < 0.001 ? '< 0.001' : String(Number(value.toPrecision(1))));

/** A coefficient, which may be as small as it likes: six digits and a power of ten. */
export function powers(value: number): string {
  const [digits, power] = value.toExponential(5).split('e') as [string, string];
  const plain = Math.abs(Number(power)) < 4;
  return plain ? String(Number(value.toPrecision(most))) : `${Number(digits)} · 10^${Number(power)}`;
}

/** A residual or its limit: nothing but 0 reads as 0. */
export const residual = (value: number, of: string) => (value !== 0 && Math.abs(value) < rounding ? '< 0.001' : number(value, of));

export const withUnit = (value: number, of: string) => beside(number(value, of), of);
export const beside = (text: string, of: string) => `${text}${!of || of.startsWith('°') ? '' : ' '}${shownUnit(of)}`;

/** Fractions are shown in per cent, volumes in cm³. */
const scales: Record<string, number> = {'%': 100, 'cm³': 0.001};
export const scaled = (name: string, value: number) => value * (scales[unit(name)] ?? 1);
/** A field's value, and with its unit. */
export const shown = (name: string, value: number) => number(scaled(name, value), unit(name));
export const measured = (name: string, value: number) => withUnit(scaled(name, value), unit(name));

/** Returns the ticks of an axis, with enough places to distinguish them. */
export function ticks(values: number[]): string[] {
  const step = values.length > 1 ? Math.abs((values[1] as number) - (values[0] as number)) : 1;
  const digits = Math.min(8, (Number(step.toPrecision(3)).toFixed(8).replace(/0+$/, '').split('.')[1] ?? '').length);
  return values.map((value) => String(Number(value.toFixed(digits))));
}

/**
 * Returns the name of a wire name, and its sentence: docs/glossary.md. `within` is the name of its
 * container.
 */
const entryIn = ({fields}: Words, key: string, within: string) => fields[`${within}.${key}`] ?? fields[key];
const entry = (key: string, within: string) => entryIn(chinese()?.words ?? words, key, within) ?? entryIn(words, key, within);
export const label = (key: string, within = '') => entry(key, within)?.[0] ?? t(spaced(key));
export const about = (key: string, within = '') => entry(key, within)?.[1] ?? '';
const englishLabel = (key: string, within = '') => entryIn(words, key, within)?.[0] ?? spaced(key);

const spaced = (text: string) => text.replace(/_/g, ' ');
/** Begins with a capital, but for a symbol, which has its own case. */
export const sentence = (text: string) => (/^[a-z][a-z’'-]/.test(text) ? text.charAt(0).toUpperCase() + text.slice(1) : text);

/** Sentences one after the other. */
export const sentences = (...all: string[]) => all.filter(Boolean).join(chinese() ? '' : ' ');
/** Returns meaning and action of a code in Chinese, or undefined if the page is English. */
export const saidOf = (kind: 'errors' | 'warnings', code: string) => chinese()?.codes[kind][code];

/** A text with more details on hover. */
export type Term = string | {text: string; about: string};
export const text = (term: Term) => (typeof term === 'string' ? term : term.text);
export const hint = (term: Term) => (typeof term === 'string' ? undefined : term.about || undefined);
/** A field's name with its unit. */
export function term(key: string, within = ''): Term {
  const mark = unit(key);
  return {text: label(key, within) + (mark ? ` ${shownUnit(mark)}` : ''), about: about(key, within)};
}

/** A warning's code, or one of a field's choices. */
export const choice = (value: unknown) => chinese()?.words.values[String(value)]?.[0] ?? t(englishChoice(value));
const englishChoice = (value: unknown) => words.values[String(value)]?.[0] ?? spaced(String(value));

export const isWord = (name: string) => name in words.values;

type Kind = keyof Pick<Words, 'checks' | 'limits'>;
/** A check of the proof, of an end or a hole too; one of `limits` may be used up. */
export function check(name: string): {name: string; about: string; kind: Kind} {
  for (let [of, rest] = ['', name]; rest; ) {
    for (const kind of ['checks', 'limits'] as const) {
      const found = chinese()?.words[kind][rest] ?? words[kind][rest];
      if (found) return {name: of ? t('{part}: {check}', {part: t(spaced(of)), check: found[0]}) : found[0], about: found[1], kind};
    }
    const cut = rest.indexOf('_');
    if (cut < 0) break;
    of = name.slice(0, name.length - rest.length + cut);
    rest = rest.slice(cut + 1);
  }
  return {name: t(spaced(name)), about: '', kind: 'checks'};
}

/** Returns the name of the nearest object or list that contains a pointer's target. */
export const holder = (pointer: string) =>
  keys(pointer)
    .slice(0, -1)
    .filter((key) => !/^\d+$/.test(key))
    .pop() ?? '';
export const lastKey = (pointer: string) => pointer.slice(pointer.lastIndexOf('/') + 1);

/** Where a pointer leads, in words: `/cutters/1/wall_mm` is "Partners 2, wall". */
export const place = (pointer: string): string => sentence(placed(pointer, label).join(t(', '))) || t('The request');

function placed(pointer: string, called: typeof label): string[] {
  const path = keys(pointer);
  const out: string[] = [];
  path.forEach((key, i) => {
    if (/^\d+$/.test(key) && out.length) out[out.length - 1] += ` ${Number(key) + 1}`;
    else
      out.push(
        called(
          key,
          path
            .slice(0, i)
            .filter((each) => !/^\d+$/.test(each))
            .pop(),
        ),
      );
  });
  return out;
}

/** A sentence of the service for people: names in English words as the rest of it, numbers short, one sign for degrees. Names out of a list, such as
 *  those of machines, stay as they are, because they are what is entered. */
export const plain = (said: string) =>
  said
    .split(/(\w+(?:\|\w+)+)/)
    .map((text, i) => (i % 2 ? text.split('|').map(called).join(', ') : worded(text)))
    .join('');

const called = (name: string) => words.values[name]?.[0] ?? name;

const worded = (said: string) =>
  said
    .replace(/(?!\/v1\/)(?<![\w/])(?:\/[a-z_0-9]+)+\/[a-z_0-9]+/g, (pointer) => sentence(placed(pointer, englishLabel).join(', ')))
    .replace(/\b[a-z][a-z0-9]*(?:_[a-z0-9]+)+\b/g, (name) => words.fields[name]?.[0] ?? englishChoice(name))
    .replace(/-?\d+\.\d+(?:e[-+]?\d+)?/g, (digits) => (digits.length > 7 ? number(Number(digits)) : digits))
    .replace(/(\d+(?:\.\d+)?) (deg|mm(?:\/min|\/s)?)(?![\w/²³])/g, (all, digits, of) =>
      Number(digits) < 0.01 ? all : beside(number(Number(digits), of === 'deg' ? '°' : of), of === 'deg' ? '°' : of),
    )
    .replace(/(\d+\.\d+)(?= to -?[\d.]+ deg\b)/g, (digits) => number(Number(digits), '°'))
    .replace(/(\d) deg\b/g, '$1°')
    .replace(/\bphi\b/g, 'φ')
    .replace(/\bdeg\b/g, '°');
