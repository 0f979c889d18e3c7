/** JSON with the place of every value in its text: the hashes of an answer are over the bytes of its members, as they were sent. */
export type Json = null | boolean | number | string | Json[] | {[name: string]: Json};

export interface Member {
  from: number; // of the name's first quote
  value: number; // where the value begins
  to: number; // behind the value
}

/** Where the value that begins at `at` ends. */
function end(text: string, at: number): number {
  let depth = 0;
  for (let i = at; i < text.length; i += 1) {
    const c = text[i];
    if (c === '"') {
      i = closing(text, i);
      if (depth === 0) return i + 1;
    } else if (c === '{' || c === '[') depth += 1;
    else if (c === '}' || c === ']') {
      if (depth === 0) return i;
      depth -= 1;
      if (depth === 0) return i + 1;
    } else if (depth === 0 && c === ',') return i;
  }
  return text.length;
}

/** The quote that ends the string which begins at `at`. */
function closing(text: string, at: number): number {
  for (let i = at + 1; i < text.length; i += 1) {
    if (text[i] === '\\') i += 1;
    else if (text[i] === '"') return i;
  }
  throw new SyntaxError('a string has no end');
}

const space = (text: string, at: number) => {
  while (at < text.length && ' \t\r\n'.includes(text[at])) at += 1;
  return at;
};

/** The members of the object that begins at `at`, by name. */
export function members(text: string, at = 0): Map<string, Member> {
  const found = new Map<string, Member>();
  let i = space(text, space(text, at) + 1);
  while (text[i] === '"') {
    const from = i;
    const close = closing(text, i);
    const value = space(text, space(text, close + 1) + 1);
    const to = end(text, value);
    found.set(JSON.parse(text.slice(from, close + 1)) as string, {from, value, to});
    i = space(text, to);
    if (text[i] === ',') i = space(text, i + 1);
  }
  return found;
}

/** The object that begins at `at`, as it is written, but for the members `names`. */
export function without(text: string, at: number, names: string[]): string {
  const kept = [...members(text, at)].filter(([name]) => !names.includes(name)).map(([, {from, to}]) => text.slice(from, to));
  return `{${kept.join(',')}}`;
}

/** The values that begin the elements of the array at `at`. */
export function elements(text: string, at: number): number[] {
  const found: number[] = [];
  let i = space(text, at + 1);
  while (i < text.length && text[i] !== ']') {
    found.push(i);
    i = space(text, end(text, i));
    if (text[i] === ',') i = space(text, i + 1);
  }
  return found;
}

/** SHA-256 of a text in UTF-8 (FIPS 180-4): in hexadecimal digits. Own, because a browser has one only on pages of https. */
export function sha256(text: string): string {
  const data = new TextEncoder().encode(text);
  const padded = new Uint8Array(((data.length + 72) >> 6) << 6);
  padded.set(data);
  padded[data.length] = 128;
  const view = new DataView(padded.buffer);
  view.setUint32(padded.length - 8, Math.floor(data.length / 0x20000000));
  view.setUint32(padded.length - 4, (data.length << 3) >>> 0);
  const state = start.slice();
  const w = new Uint32Array(64);
  for (let block = 0; block < padded.length; block += 64) {
    for (let i = 0; i < 16; i += 1) w[i] = view.getUint32(block + 4 * i);
    for (let i = 16; i < 64; i += 1) {
      const [a, b] = [w[i - 15], w[i - 2]];
      w[i] = w[i - 16] + (turn(a, 7) ^ turn(a, 18) ^ (a >>> 3)) + w[i - 7] + (turn(b, 17) ^ turn(b, 19) ^ (b >>> 10));
    }
    let [a, b, c, d, e, f, g, h] = state as unknown as [number, number, number, number, number, number, number, number];
    for (let i = 0; i < 64; i += 1) {
      const one = (h + (turn(e, 6) ^ turn(e, 11) ^ turn(e, 25)) + ((e & f) ^ (~e & g)) + rounds[i] + w[i]) >>> 0;
      const two = ((turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + ((a & b) ^ (a & c) ^ (b & c))) >>> 0;
      [h, g, f, e, d, c, b, a] = [g, f, e, (d + one) >>> 0, c, b, a, (one + two) >>> 0];
    }
    [a, b, c, d, e, f, g, h].forEach((v, i) => {
      state[i] = (state[i] + v) >>> 0;
    });
  }
  return state.map((v) => v.toString(16).padStart(8, '0')).join('');
}

const turn = (v: number, by: number) => (v >>> by) | (v << (32 - by));
/** The first 32 bits behind the point of the `root`-th root of each of the first `count` primes. */
function digits(count: number, root: number): number[] {
  const primes: number[] = [];
  for (let n = 2; primes.length < count; n += 1) if (primes.every((p) => n % p)) primes.push(n);
  return primes.map((p) => {
    const scaled = BigInt(p) << BigInt(32 * root);
    let low = 0n;
    let high = 1n << 40n;
    while (high - low > 1n) {
      const middle = (low + high) >> 1n;
      if (middle ** BigInt(root) <= scaled) low = middle;
      else high = middle;
    }
    return Number(low & 0xffffffffn);
  });
}
const rounds = digits(64, 3);
const start = digits(8, 2);
