import {signal} from '@preact/signals';
import {Selection} from './frame/selection';
import {originalOf, said} from './hint';
import {History} from './history';
import {at, clone, isRow, put, sharing, type Json, type Row} from './json';
import type {Contract, Schema} from './schema';
import type {Issue} from './service';
import {quantity} from './units';

/** Names that the service lists, by the fields that they fill. */
export type Choices = Record<string, string[]> & {machine: string[]; size: string[]; rectangular_size: string[]};
const rectangular = 'rectangular_tube';
interface Complaint {
  id: string;
  text: string;
  /** The service's own words. */
  original: string;
}
type Complaints = ReadonlyMap<string, Complaint[]>; // by the pointer of their field
const none: Complaints = new Map();

const root = () => document.getElementById('form');
const nodeAt = (attribute: string, pointer: string, tag = '') => root()?.querySelector<HTMLElement>(`${tag}[data-${attribute}="${CSS.escape(pointer)}"]`);

/** Returns the field of a pointer, or of its nearest container. */
function nearest(pointer: string): HTMLElement | null {
  for (let to = pointer; ; to = to.slice(0, to.lastIndexOf('/'))) {
    const found = nodeAt('pointer', to) ?? nodeAt('holds', to, 'select') ?? nodeAt('holds', to);
    if (found || to === '') return found ?? null;
  }
}

/** The request in the form. Never checks values: the service does, and names the field. */
export class Form {
  /** What the fields are drawn of; what is typed meanwhile is in `body` and in the fields themselves. Of another `build` they are drawn anew. */
  readonly drawn = signal<{schema: Schema; body: Row; build: number}>({schema: {}, body: {}, build: 0});
  body: Row = {};
  readonly history = new History();
  /** Writes what is typed and not yet written, by field. */
  readonly pending = new Set<() => void>();
  /** The request as the service understood it: its defaults are the fields' placeholders. */
  readonly echo = signal<Row>({});
  readonly complaints = signal(none);
  readonly folds = new Map<string, boolean>(); // opened or closed by hand, by pointer
  /** The rows of the list that a table shows in full; the form has the fields of one of them. */
  readonly selection = new Selection();
  tabled: string | undefined; // pointer of that list
  private towards: string | undefined;

  constructor(
    readonly contract: Contract,
    readonly choices: Choices,
    private readonly changed: () => void,
  ) {}

  show(schema: Schema, body: Row): void {
    this.body = body;
    this.history.begin(body);
    this.drawn.value = {schema, body, build: this.drawn.value.build + 1};
    this.echo.value = {}; // of another job
    this.complaints.value = none;
    this.selection.choose(null);
  }

  /**
   * `towards`: then the first field in the new part, or the nearest to the removed one, gets the
   * focus; else it stays.
   */
  replace(body: Row, towards?: string): void {
    this.body = body;
    this.history.record(body);
    this.redraw(towards);
  }

  /** A value with the kind that its size has: tubes of both kinds are named by `size` alone. */
  private meant(value: Json | undefined): Json | undefined {
    if (!isRow(value)) return value;
    if (isRow(value['target'])) return {...value, target: this.meant(value['target']) as Json};
    return 'size' in value && !('kind' in value) && this.choices.rectangular_size.includes(String(value['size'])) ? {...value, kind: rectangular} : value;
  }

  branchOf(branches: Schema[], value: Json | undefined): number {
    return this.contract.branchOf(branches, this.meant(value));
  }

  /** The names that a field has a choice of, by the kind of what it is in. */
  namesFor(pointer: string): string[] | undefined {
    const slash = pointer.lastIndexOf('/');
    const [key, within] = [pointer.slice(slash + 1), this.meant(at(this.body, pointer.slice(0, slash)))];
    return key === 'size' && isRow(within) && within['kind'] === rectangular ? this.choices.rectangular_size : this.choices[key];
  }

  /** What is at a pointer, written in another branch; a size stays only if tubes of that kind have it. */
  rewrite(pointer: string, branch: Schema): void {
    const old = at(this.body, pointer); // what is drawn may be older
    const kind = this.contract.resolve(branch.properties?.['kind'] ?? {}).const;
    const sizes = kind === rectangular ? this.choices.rectangular_size : this.choices.size;
    const kept = isRow(old) && 'size' in old && !sizes.includes(String(old['size'])) ? put(old, '/size', undefined) : old;
    const made = this.contract.make(branch, kept, pointer.slice(pointer.lastIndexOf('/') + 1));
    if (pointer) this.replace(this.fitted(put(this.body, pointer, made)), pointer);
    else this.replace(made as Row);
  }

  /** The request in the branch that its tube needs: what that one does not have is left out, because the service refuses it. */
  private fitted(body: Row): Row {
    const branches = this.contract.branches(this.drawn.value.schema);
    const before = branches[this.branchOf(branches, this.body)];
    if (!before) return body;
    const alike = this.contract.alike(branches, before);
    const needed = alike[this.branchOf(alike, body)] as Schema;
    return needed === before ? body : (this.contract.make(needed, body) as Row);
  }

  /** One step of several changes, made in a copy. */
  change(act: (copy: Row) => void): void {
    const copy = clone(this.body);
    act(copy);
    this.replace(sharing(this.body, copy) as Row);
  }

  private redraw(towards?: string, {build} = this.drawn.value): void {
    this.towards = towards;
    this.drawn.value = {...this.drawn.value, body: this.body, build};
    this.complaints.value = none;
    this.changed();
  }

  /** Writes all that is typed, before the job is saved or another one takes its place. */
  flush(): void {
    for (const write of [...this.pending]) write();
  }

  /** All fields anew, such as in another unit. */
  refresh(): void {
    this.flush();
    this.drawn.value = {...this.drawn.value, body: this.body, build: this.drawn.value.build + 1};
  }

  /** Back to the state before, or on to the one after: all fields are made anew, because what was typed is in them alone. */
  go(by: 1 | -1): void {
    this.flush();
    const step = this.history.go(by);
    if (!step) return;
    this.body = step.body;
    this.redraw(step.field, {...this.drawn.value, build: this.drawn.value.build + 1});
  }

  /** Keeps the fields as they were drawn. */
  stands(): void {
    const {towards} = this;
    this.towards = undefined;
    if (towards === undefined) return;
    (root()?.querySelector<HTMLElement>(`[data-pointer^="${CSS.escape(towards)}\\/"]`) ?? nearest(towards))?.focus();
  }

  write(pointer: string, value: Json | undefined): void {
    this.body = put(this.body, pointer, value);
    this.history.record(this.body, pointer);
    this.changed();
  }

  put(pointer: string, value: Json | undefined): void {
    this.replace(put(this.body, pointer, value), pointer);
  }

  removeRow(pointer: string): void {
    if (at(this.echo.value, pointer) !== undefined) this.echo.value = put(this.echo.value, pointer, undefined); // another row's hints are not those of the next
    this.put(pointer, undefined);
  }

  /** Shows each at the field that a problem names, or at its container. */
  complain(issues: Issue[]): void {
    const found = new Map<string, Complaint[]>();
    issues.forEach((issue, index) => {
      const {pointer, holds} = nearest(issue.pointer)?.dataset ?? {};
      const to = pointer ?? holds;
      if (to !== undefined) found.set(to, [...(found.get(to) ?? []), {id: `complaint-${index}`, text: said(issue), original: originalOf(issue)}]);
    });
    this.complaints.value = found.size ? found : none;
  }

  /** Shows the row of the table that a pointer leads into. */
  select(pointer: string): void {
    const row = this.tabled && pointer.startsWith(`${this.tabled}/`) ? Number(pointer.slice(this.tabled.length + 1).split('/')[0]) : NaN;
    if (Number.isInteger(row)) this.selection.choose(row);
  }

  /** Brings the field of a pointer, or of its container, into view. */
  focus(pointer: string): void {
    const input = nearest(pointer);
    if (!input) return;
    for (let holder = input.closest('details'); holder; holder = holder.parentElement?.closest('details') ?? null) holder.open = true;
    input.scrollIntoView({block: 'center', behavior: 'instant'});
    input.focus();
  }
}

/**
 * Gives every value enough room to be read whole: a field gets the whole line, a cell of a table
 * its needed width.
 */
export function roomy(inputs: Iterable<Element>): void {
  const texts = [...inputs].filter((input): input is HTMLInputElement => input instanceof HTMLInputElement && input.type === 'text');
  for (const input of texts) {
    if (input.closest('td')) input.style.minWidth = '';
    input.closest('.field')?.classList.remove('roomy');
  }
  const clipped = texts.filter((input) => input.scrollWidth > input.clientWidth).map((input) => [input, input.scrollWidth] as const);
  for (const [input, needed] of clipped) {
    if (input.closest('td')) input.style.minWidth = `${needed + 2}px`;
    input.closest('.field')?.classList.add('roomy');
  }
}

function step(input: HTMLInputElement, by: number): void {
  const now = quantity(input.value || input.placeholder, '');
  if (now === undefined) return;
  input.value = String(Number((now + by).toFixed(6)));
  input.dispatchEvent(new Event('input', {bubbles: true}));
}

/** Up and down change a number by 1, with Shift by 10, with Alt by 0.1. */
export function nudge(event: KeyboardEvent): void {
  if (event.key !== 'ArrowUp' && event.key !== 'ArrowDown') return;
  event.preventDefault();
  step(event.currentTarget as HTMLInputElement, (event.key === 'ArrowUp' ? 1 : -1) * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1));
}

/** Dragging a unit changes the number before it. */
export function scrub(event: PointerEvent): void {
  const grip = event.currentTarget as HTMLElement;
  const input = grip.parentElement?.querySelector('input');
  if (!input) return;
  event.preventDefault();
  grip.setPointerCapture(event.pointerId);
  let taken = 0;
  grip.onpointermove = ({clientX}) => {
    if (!grip.hasPointerCapture(event.pointerId)) return;
    const steps = Math.round((clientX - event.clientX) / 4);
    if (steps !== taken) step(input, steps - taken);
    taken = steps;
  };
}

/** A number where one was typed, in the unit of the wire; anything else goes to the service as it is, to be refused by name. */
export function typed(text: string, textual: boolean, unit: string): Json | undefined {
  if (text === '') return undefined;
  return textual ? text : (quantity(text, unit) ?? text);
}

/** A list as it is typed: as JSON, or numbers separated by commas or semicolons. */
export function listed(text: string, unit: string): Json | undefined {
  if (!text.trim()) return undefined;
  if (!/^\s*[[{"]/.test(text)) {
    const numbers = text.split(text.includes(';') ? ';' : /,\s*/).map((each) => quantity(each, unit));
    if (numbers.every((each) => each !== undefined)) return numbers as number[];
  }
  try {
    return JSON.parse(text) as Json;
  } catch {
    return text;
  }
}

/** Returns runs of equal kinds: the kind, its start, its end. */
export function runsOf<T>(kinds: T[]): [T, number, number][] {
  const out: [T, number, number][] = [];
  kinds.forEach((kind, i) => {
    const last = out[out.length - 1];
    if (last && last[0] === kind) last[2] = i + 1;
    else out.push([kind, i, i + 1]);
  });
  return out;
}
