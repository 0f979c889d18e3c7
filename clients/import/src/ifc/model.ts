import type {IfcAPI} from 'web-ifc';
import type {Vector} from '../geometry.js';
import {limits} from '../limits.js';

/** Why something of the file cannot be read; it names the entity that is to blame. */
export class Trouble extends Error {}

/** One entity: its number, its type as the schema writes it, its attributes by name. */
export interface Line {
  id: number;
  type: string;
  attributes: Record<string, unknown>;
}

type Value = {type?: number; value?: unknown};
/** Of a measure or as it is: 2x3 has plain numbers where 4 has measures. */
const plain = (each: Value | number | null | undefined): unknown => (each !== null && typeof each === 'object' ? each.value : each);
const reference = 5; // web-ifc's mark of a value that is another entity's number

export const told = (line: Line): string => `#${line.id} ${line.type}`;

/** An open file. If an item does not exist, its methods throw a Trouble. */
export class Model {
  private readonly lines = new Map<number, Line>();

  constructor(
    private readonly api: IfcAPI,
    private readonly handle: number,
    /** Entities that are too long to be read. */
    private readonly long: ReadonlySet<number> = new Set(),
  ) {}

  line(id: number): Line {
    const known = this.lines.get(id);
    if (known) return known;
    if (this.long.has(id)) throw new Trouble(`#${id} is longer than ${limits.statement} bytes`);
    let attributes: unknown;
    let type = '';
    try {
      attributes = this.api.GetLine(this.handle, id);
      type = this.api.GetNameFromTypeCode(this.api.GetLineType(this.handle, id));
    } catch {
      throw new Trouble(`#${id} cannot be read`);
    }
    if (!attributes || typeof attributes !== 'object') throw new Trouble(`#${id} is not there`);
    const line = {id, type, attributes: attributes as Record<string, unknown>};
    this.lines.set(id, line);
    return line;
  }

  /** The numbers of a type's entities and of those derived from it, in the file's order. */
  all(type: number): number[] {
    const ids = this.api.GetLineIDsWithType(this.handle, type, true);
    return Array.from({length: ids.size()}, (_, i) => ids.get(i)).sort((a, b) => a - b);
  }

  private value(line: Line, name: string): Value | undefined {
    return (line.attributes[name] ?? undefined) as Value | undefined;
  }

  maybe(line: Line, name: string): Line | undefined {
    const value = this.value(line, name);
    return value?.type === reference && typeof value.value === 'number' ? this.line(value.value) : undefined;
  }

  of(line: Line, name: string): Line {
    const found = this.maybe(line, name);
    if (!found) throw new Trouble(`${told(line)} has no ${name}`);
    return found;
  }

  list(line: Line, name: string, most: number = limits.statement): Line[] {
    const values = line.attributes[name];
    if (!Array.isArray(values)) throw new Trouble(`${told(line)} has no ${name}`);
    if (values.length > most) throw new Trouble(`${told(line)} has ${values.length} ${name}, and at most ${most} are read`);
    return values.map((each: Value) => {
      if (each?.type !== reference || typeof each.value !== 'number') throw new Trouble(`${told(line)} has a ${name} that is no entity`);
      return this.line(each.value);
    });
  }

  /** The numbers of the entities of a list, which need not be read. */
  ids(line: Line, name: string): number[] {
    const values = line.attributes[name];
    if (!Array.isArray(values)) throw new Trouble(`${told(line)} has no ${name}`);
    return values.flatMap((each: Value) => (each?.type === reference && typeof each.value === 'number' ? [each.value] : []));
  }

  maybeNumber(line: Line, name: string): number | undefined {
    const value = plain(this.value(line, name));
    return typeof value === 'number' && Number.isFinite(value) ? value : undefined;
  }

  number(line: Line, name: string): number {
    const value = this.maybeNumber(line, name);
    if (value === undefined) throw new Trouble(`${told(line)} has no ${name}`);
    return value;
  }

  /** Of a length: more than nothing. */
  positive(line: Line, name: string): number {
    const value = this.number(line, name);
    if (!(value > 0)) throw new Trouble(`${told(line)} has a ${name} of ${value}`);
    return value;
  }

  text(line: Line, name: string): string | undefined {
    const value = plain(this.value(line, name));
    return typeof value === 'string' && value !== '' ? value : undefined;
  }

  /** A logical value; web-ifc gives them as such or as letters. */
  flag(line: Line, name: string): boolean {
    const value = plain(this.value(line, name));
    return value === true || value === 'T';
  }

  /** Two or three numbers as a vector. */
  vector(line: Line, name: string): Vector {
    const values = line.attributes[name];
    if (!Array.isArray(values)) throw new Trouble(`${told(line)} has no ${name}`);
    return this.triple(line, values as Value[]);
  }

  vectors(line: Line, name: string): Vector[] {
    const rows = line.attributes[name];
    if (!Array.isArray(rows)) throw new Trouble(`${told(line)} has no ${name}`);
    return rows.map((row: Value[]) => this.triple(line, row));
  }

  private triple(line: Line, values: Value[]): Vector {
    const [x, y, z] = values.map(plain);
    if (values.length < 2 || values.length > 3) throw new Trouble(`${told(line)} is no point or direction`);
    const out = [x, y, values.length === 2 ? 0 : z];
    if (out.some((each) => typeof each !== 'number' || !Number.isFinite(each))) throw new Trouble(`${told(line)} has a coordinate that is no number`);
    return out as Vector;
  }

  /** A list of values of which each is a select: its type's code and its numbers. GetLine forgets the types. */
  selected(line: Line, place: number): {code: number; values: number[]}[] {
    const raw = this.api.GetRawLineData(this.handle, line.id) as {arguments?: unknown[]};
    const list = raw.arguments?.[place];
    if (!Array.isArray(list)) return [];
    return list.map((each: {typecode?: number; value?: Value[]}) => ({
      code: each.typecode ?? 0,
      values: (Array.isArray(each.value) ? each.value : []).map(({value}) => Number(value)),
    }));
  }

  /** The items of a list that may be entities or numbers, as a trimmed curve's ends. */
  mixed(line: Line, name: string): {line?: Line; number?: number} {
    const values = line.attributes[name];
    if (!Array.isArray(values)) throw new Trouble(`${told(line)} has no ${name}`);
    const out: {line?: Line; number?: number} = {};
    for (const each of values as Value[])
      if (each?.type === reference && typeof each.value === 'number') out.line = this.line(each.value);
      else {
        const value = plain(each);
        if (typeof value === 'number') out.number = value;
      }
    return out;
  }
}
