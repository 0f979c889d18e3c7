import {limits} from '../limits.js';

/**
 * Attributes that the schema derives from others, and that are "*" in a file: web-ifc skips these,
 * and only these.
 */
const derived: Record<string, [from: number, to: number]> = {
  IFCSIUNIT: [0, 0],
  IFCORIENTEDEDGE: [0, 1],
  IFCGEOMETRICREPRESENTATIONSUBCONTEXT: [2, 5],
  IFCMIRROREDPROFILEDEF: [3, 3],
};
const [star, dollar, quote, slash, open, close, comma, semicolon, equals, hash] = [..."*$'/(),;=#"].map((each) => each.charCodeAt(0)) as number[];
const space = (byte: number): boolean => byte === 32 || (byte >= 9 && byte <= 13);

export interface Normalised {
  bytes: Uint8Array;
  /** Entities that are too long to be read. */
  long: Set<number>;
}

/**
 * Returns a copy in which "*" marks derived attributes, and "$" all other missing ones, as the
 * schema requires: web-ifc drops a "*", so one in another place would shift the attributes after
 * it. One pass over any file.
 */
export function normalised(given: Uint8Array): Normalised {
  const bytes = given.slice();
  const long = new Set<number>();
  let [depth, argument, from, id, word] = [0, 0, 0, -1, -1];
  let range: [number, number] | undefined;
  for (let i = 0; i < bytes.length; ++i) {
    const byte = bytes[i] as number;
    if (byte === quote) {
      const end = bytes.indexOf(quote as number, i + 1);
      i = end < 0 ? bytes.length : end;
    } else if (byte === slash && bytes[i + 1] === star) {
      i = endOfComment(bytes, i + 2);
    } else if (byte === semicolon) {
      if (i - from > limits.statement && id >= 0) long.add(id);
      [depth, argument, from, id, word, range] = [0, 0, i + 1, -1, -1, undefined];
    } else if (byte === hash && depth === 0 && id < 0) {
      id = numberAt(bytes, i + 1);
    } else if (byte === equals && depth === 0) {
      word = i + 1;
    } else if (byte === open) {
      if (++depth === 1 && word >= 0) range = rangeOf(bytes, word, i);
    } else if (byte === close) {
      --depth;
    } else if (byte === comma) {
      if (depth === 1) ++argument;
    } else if ((byte === star || byte === dollar) && depth > 0 && alone(bytes, i)) {
      const isDerived = depth === 1 && range !== undefined && argument >= range[0] && argument <= range[1];
      bytes[i] = (isDerived ? star : dollar) as number;
    }
  }
  return {bytes, long};
}

function endOfComment(bytes: Uint8Array, from: number): number {
  for (let at = bytes.indexOf(star as number, from); at >= 0; at = bytes.indexOf(star as number, at + 1)) if (bytes[at + 1] === slash) return at + 1;
  return bytes.length;
}

/** At most 15 digits, because longer ones are not entity numbers. */
function numberAt(bytes: Uint8Array, from: number): number {
  let value = 0;
  for (let i = from; i < from + 15; ++i) {
    const digit = (bytes[i] ?? 0) - 48;
    if (digit < 0 || digit > 9) return i > from ? value : -1;
    value = 10 * value + digit;
  }
  return -1;
}

function rangeOf(bytes: Uint8Array, from: number, to: number): [number, number] | undefined {
  if (to - from > 64) return undefined;
  const name = String.fromCharCode(...bytes.subarray(from, to))
    .trim()
    .toUpperCase();
  return Object.hasOwn(derived, name) ? derived[name] : undefined;
}

/** Is it all of an attribute? */
function alone(bytes: Uint8Array, at: number): boolean {
  let [before, behind] = [at - 1, at + 1];
  while (before > 0 && at - before < 64 && space(bytes[before] as number)) --before;
  while (behind < bytes.length && behind - at < 64 && space(bytes[behind] as number)) ++behind;
  return (bytes[before] === open || bytes[before] === comma) && (bytes[behind] === close || bytes[behind] === comma);
}
