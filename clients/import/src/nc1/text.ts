import {clean} from '../frame.js';
import {limits} from '../limits.js';
import {decimal} from '../units.js';

/** The reason why a file, a block or a row is not read. */
export class Trouble extends Error {}

/** The 24 lines after ST, by the standard's order. */
const fields = [
  'order',
  'drawing',
  'phase',
  'piece',
  'grade',
  'quantity',
  'profile',
  'code',
  'length',
  'height',
  'width',
  'flange',
  'web',
  'radius',
  'weight',
  'paint',
  'web start cut',
  'web end cut',
  'flange start cut',
  'flange end cut',
] as const;
export type HeaderField = (typeof fields)[number];
const texts = 4; // lines of free text that end the header

/** The letters that name a face: front, top, bottom, behind. */
export type Face = 'v' | 'o' | 'u' | 'h';

/** Numbers of a row, each with the letter that clings to it. */
export interface Row {
  line: number;
  face: Face | undefined;
  values: {value: number; letter: string}[];
  text: string;
}

/** A block with the comments of its own, which stand before it. */
export interface Block {
  code: string;
  line: number;
  rows: Row[];
  comments: string[];
}

export interface Nc1 {
  header: Map<HeaderField, string>;
  texts: string[];
  blocks: Block[];
  comments: string[];
  ended: boolean;
}

const blockCode = /^(?:AK|IK|BO|SI|KO|PU|KA|SC|TO|UE|PR|IN|BR|EN|E\d)$/;
const longest = 400; // characters of a row; only SI has a text

/** UTF-8, or Latin 1 if it is not. */
export function textOf(file: Uint8Array | string): string {
  if (typeof file === 'string') return file;
  try {
    return new TextDecoder('utf-8', {fatal: true}).decode(file);
  } catch {
    return new TextDecoder('latin1').decode(file);
  }
}

const value = /^\s*,?\s*([-+]?(?:\d+(?:\.\d*)?|\.\d+))([a-zA-Z]?)(?![\w.])/;

/** Splits a row of numbers; throws if something else is in it. */
function rowOf(text: string, line: number): Row {
  const shown = clean(text.trim().slice(0, 60));
  if (text.length > longest) throw new Trouble(`the line has ${text.length} characters, and at most ${longest} are read`);
  const first = /^\s*([vouhVOUH])(?=[\s,\d.+-])/.exec(text);
  let rest = first ? text.slice(first[0].length) : text;
  const values: Row['values'] = [];
  for (let found = value.exec(rest); found; found = value.exec(rest)) {
    values.push({value: decimal(found[1]), letter: (found[2] as string).toLowerCase()});
    rest = rest.slice(found[0].length);
  }
  if (rest.trim() !== '' || values.length === 0) throw new Trouble(`"${shown}" is not a row of numbers`);
  if (values.some((each) => !Number.isFinite(each.value))) throw new Trouble(`"${shown}" has a number that is too long`);
  return {line, face: first?.[1]?.toLowerCase() as Face | undefined, values, text: ''};
}

/** A text to be marked: face, x, y, angle, height, text. */
function markOf(text: string, line: number): Row {
  const found = /^\s*[vouhVOUH]?[\s,]*[-+.\d]+[a-z]?[\s,]+[-+.\d]+[a-z]?[\s,]+[-+.\d]+[a-z]?[\s,]+\d+(?:\.\d*)?[a-z]?(?:\s|$)/.exec(text.slice(0, longest));
  if (!found) throw new Trouble(`"${clean(text.trim().slice(0, 60))}" is not face, x, y, angle, height and text`);
  return {...rowOf(found[0], line), text: text.slice(found[0].length)};
}

/** Reads the lines of a file into its header and blocks. Rows that it cannot read go to `lost`. */
export function parsed(text: string, lost: (line: number, code: string, reason: string) => void): Nc1 {
  const lines = text.replace(/^\uFEFF/, '').split(/\r\n|\n|\r/, limits.lines + 1);
  if (lines.length > limits.lines) throw new Trouble(`it has more than ${limits.lines} lines, which is the limit: split the part`);
  const file: Nc1 = {header: new Map(), texts: [], blocks: [], comments: [], ended: false};
  const head: string[] = [];
  let [begun, before] = [false, [] as string[]];
  let block: Block | undefined;
  for (const [i, line] of lines.entries()) {
    const trimmed = line.trim();
    if (trimmed.startsWith('**')) {
      const comment = trimmed.slice(2).trim();
      file.comments.push(comment);
      before.push(comment);
    } else if (!begun) {
      if (trimmed !== '' && trimmed !== 'ST') throw new Trouble(`it does not begin with ST: line ${i + 1} is "${clean(trimmed.slice(0, 40))}"`);
      begun = trimmed === 'ST';
    } else if (block === undefined && head.length < fields.length + texts && !(head.length > 8 && blockCode.test(trimmed))) {
      head.push(trimmed);
      before = [];
    } else if (blockCode.test(trimmed)) {
      file.ended = trimmed === 'EN';
      if (file.ended) break;
      block = {code: trimmed, line: i + 1, rows: [], comments: before};
      before = [];
      file.blocks.push(block);
    } else if (trimmed !== '' && block) {
      try {
        block.rows.push(block.code === 'SI' ? markOf(line, i + 1) : rowOf(line, i + 1));
      } catch (failure) {
        if (!(failure instanceof Trouble)) throw failure;
        lost(i + 1, block.code, failure.message);
      }
    } else if (trimmed !== '') lost(i + 1, 'NC1', `"${clean(trimmed.slice(0, 40))}" is in no block`);
  }
  if (!begun) throw new Trouble('it has no ST, with which each NC1 file begins');
  if (head.length < 14) throw new Trouble(`its header has ${head.length} lines, and the profile needs the first 14: the file is cut off`);
  for (const [i, field] of fields.entries()) file.header.set(field, head[i] ?? '');
  file.texts = head.slice(fields.length).filter((each) => each !== '' && each !== '-');
  return file;
}

/** A number of the header. */
export function headerNumber({header}: Nc1, field: HeaderField): number {
  const text = (header.get(field) ?? '').split(field === 'length' ? ',' : '\n')[0]?.trim() ?? '';
  const found = decimal(text);
  if (Number.isFinite(found) && Math.abs(found) < 1e7) return found;
  const comma = /^\d+,\d+$/.test(text) ? ': write it with a point' : '';
  throw new Trouble(`its ${field} "${clean(text.slice(0, 40))}" is not a number${comma}`);
}
