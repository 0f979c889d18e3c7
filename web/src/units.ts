import {signal} from '@preact/signals';
import {t} from './language';

/** The system that lengths are entered and shown in. Requests, answers and files are in mm whatever it is. */
export type System = 'mm' | 'inch';
const stored = (): System => {
  try {
    return localStorage.getItem('units') === 'inch' ? 'inch' : 'mm';
  } catch {
    return 'mm'; // without a storage nothing is remembered
  }
};
export const system = signal<System>(stored());
export function choose(wanted: System): void {
  system.value = wanted;
  try {
    localStorage.setItem('units', wanted);
  } catch {
    /* not remembered */
  }
}

const inch = 25.4; // mm, exactly
/** What each unit is called in inches, and how many of it make one of those. */
const inInches: Record<string, [name: string, size: number]> = {
  mm: ['in', inch],
  'mm²': ['in²', inch ** 2],
  'cm³': ['in³', (inch / 10) ** 3],
  'mm³/s': ['in³/s', inch ** 3],
  'mm/min': ['in/min', inch],
  'm/min': ['in/min', inch / 1000],
  'mm/s': ['in/s', inch],
  'mm/s²': ['in/s²', inch],
  'mm/s³': ['in/s³', inch],
  '°/mm': ['°/in', 1 / inch],
  '°/mm²': ['°/in²', 1 / inch ** 2],
  'rad/mm': ['rad/in', 1 / inch],
};
const other = (unit: string) => (system.value === 'inch' ? inInches[unit] : undefined);

/** A unit of the wire as it is shown. */
export const shownUnit = (unit: string): string => other(unit)?.[0] ?? t(unit);
/** A value in a unit of the wire as it is shown, and back. */
export const toShown = (value: number, unit: string): number => value / (other(unit)?.[1] ?? 1);
/** Without the digits that only the conversion makes: 24.15 in is 613.41 mm. */
export const toWire = (value: number, unit: string): number => Number((value * (other(unit)?.[1] ?? 1)).toPrecision(14));

const lengths: Record<string, number> = {
  mm: 1,
  cm: 10,
  m: 1000,
  in: inch,
  '"': inch,
  '″': inch,
  '”': inch,
  ft: 12 * inch,
  "'": 12 * inch,
  '′': 12 * inch,
  '’': 12 * inch,
};
const token = /\s*(?:((?:\d+[-\s])?\d+\/\d+(?![\d.,])|(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?)|(mm|cm|m|in|ft|["″”'′’])(?![a-z])|([-+*/()]))/y;

/** A number that is typed: of a unit of the wire, or of none. With what it is a length of, or not. */
interface Amount {
  value: number;
  length: boolean;
}

/**
 * Computes what is typed, in the unit of the wire: "24.15*2", "2-3/8", "1.75in", "5' 6-1/2\"". Returns undefined for what is no number.
 * A bare number is in the unit that is shown; a unit is taken only where lengths are entered.
 */
export function quantity(text: string, unit: string): number | undefined {
  const tokens = split(text);
  if (!tokens) return undefined;
  const bare = (amount: Amount): number => (amount.length ? amount.value : toWire(amount.value, unit));
  let at = 0;
  const take = (wanted: RegExp): string | undefined => {
    const found = tokens[at];
    if (found === undefined || !wanted.test(found)) return undefined;
    at += 1;
    return found;
  };
  const measured = (value: number): Amount => {
    const name = unit === 'mm' ? take(/^(mm|cm|m|in|ft|["″”'′’])$/) : undefined;
    return name ? {value: value * (lengths[name] as number), length: true} : {value, length: false};
  };
  const primary = (): Amount => {
    if (take(/^\($/)) {
      const inner = sum();
      if (!take(/^\)$/)) throw new SyntaxError(text);
      return inner.length ? inner : measured(inner.value);
    }
    const digits = take(/^[\d.,]/);
    if (digits === undefined) throw new SyntaxError(text);
    const first = measured(numeral(digits));
    // Inches after feet: 5' 6-1/2".
    if (!first.length || !/^[\d.,]/.test(tokens[at] ?? '')) return first;
    const rest = measured(numeral(tokens[at++] as string));
    return {value: first.value + (rest.length ? rest.value : rest.value * inch), length: true};
  };
  const signed = (): Amount => {
    const sign = take(/^[-+]$/);
    if (!sign) return primary();
    const {value, length} = signed();
    return {value: sign === '-' ? -value : value, length};
  };
  const product = (): Amount => {
    let left = signed();
    for (let by = take(/^[*/]$/); by; by = take(/^[*/]$/)) {
      const right = signed();
      if (right.length && (left.length ? by === '*' : by === '/')) throw new SyntaxError(text); // an area, or 1 over a length
      const value = by === '*' ? left.value * right.value : left.value / right.value;
      left = {value, length: left.length !== right.length};
    }
    return left;
  };
  const sum = (): Amount => {
    let left = product();
    for (let by = take(/^[-+]$/); by; by = take(/^[-+]$/)) {
      const right = product();
      const length = left.length || right.length;
      const [a, b] = length ? [bare(left), bare(right)] : [left.value, right.value];
      left = {value: by === '+' ? a + b : a - b, length};
    }
    return left;
  };
  try {
    const value = bare(sum());
    return at === tokens.length && Number.isFinite(value) ? Number(value.toPrecision(14)) : undefined;
  } catch {
    return undefined;
  }
}

function split(text: string): string[] | undefined {
  const tokens: string[] = [];
  token.lastIndex = 0;
  for (const given = text.trim(); token.lastIndex < given.length; ) {
    const found = token.exec(given);
    if (!found) return undefined;
    tokens.push((found[1] ?? found[2] ?? found[3]) as string);
  }
  return tokens;
}

/** "2-3/8", "3/8", "1,5" or "1.5". */
function numeral(text: string): number {
  const [, whole = '0', over, under] = /^(?:(\d+)[-\s])?(\d+)\/(\d+)$/.exec(text) ?? [];
  return over === undefined ? Number(text.replace(',', '.')) : Number(whole) + Number(over) / Number(under);
}

/** Returns a value of the wire as its field shows it. A field that nobody changes keeps its value in full. */
export const entered = (value: number, unit: string): string => (other(unit) ? String(Number(toShown(value, unit).toPrecision(6))) : String(value));
