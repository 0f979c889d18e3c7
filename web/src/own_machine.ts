import {signal} from '@preact/signals';
import {Form} from './form';
import {isRow, type Json, type Row} from './json';
import {headed} from './key';
import {t} from './language';
import type {Contract, Schema} from './schema';
import {ask, away, fetched, Latest, type Example, type Issue, type Problem} from './service';

export const parts = ['machine', 'post'] as const;
export type Part = (typeof parts)[number];
/** The errors that the service finds in a file; undefined until it answers. */
export type State = Issue[] | undefined;

/** The first coupon of docs/machines.md: a saddle, square to the wall. */
const coupon: Row = {
  target: {outer_diameter_mm: 48.3, wall_mm: 3.2},
  cutters: [{kind: 'tube', outer_diameter_mm: 60.3, inclination_deg: 90, clocking_deg: 0, offset_mm: 0}],
  preset: 'tube_laser',
  kerf_mm: 1.4,
  reference: {part: 'coupon'},
};
const metal = 3.2; // mm of the coupon in the beam
const motion: Row = {speed: {mm_min: 600}};

const schema: Schema = {
  properties: {machine: {$ref: '#/components/schemas/Machine'}, post: {$ref: '#/components/schemas/Post'}},
  required: [...parts],
};

const key = 'own-machine';
/** Without a storage nothing is remembered. */
function stored(): Row {
  try {
    const read: unknown = JSON.parse(localStorage.getItem(key) ?? '{}');
    return isRow(read) ? read : {};
  } catch {
    return {};
  }
}

/** The row of a process table that a program of the coupon takes: its options, as a query has them. */
export function optionsOf(machine: Row): Record<string, string> {
  const process = isRow(machine['process']) ? machine['process'] : {};
  const rows = (Array.isArray(process['rows']) ? process['rows'] : []).filter(isRow).filter((row) => Number(row['metal_max_mm']) >= metal);
  const [row] = rows.sort((a, b) => Number(a['metal_max_mm']) - Number(b['metal_max_mm']));
  const of: [string, Json | undefined][] = row
    ? [
        ['speed_mm_min', row['speed_mm_min']],
        ['lead_mm', row['shortest_lead_mm']],
        ['pierce_height_mm', row['pierce_height_mm']],
        ['pierce_delay_s', row['pierce_delay_s']],
        ['cut_height_mm', row['cut_height_mm']],
        ['clearance_mm', process['clearance_mm']],
        ['torch', 'on'],
      ]
    : [['speed_mm_min', 600]];
  const all: [string, Json | undefined][] = [['pivot_length_mm', machine['pivot_length_mm'] ?? 0], ...of];
  return Object.fromEntries(all.flatMap(([name, value]) => (value === undefined ? [] : [[name, String(value)]])));
}

/** A file of `--machines` or `--posts`, and its name. */
export const fileOf = (part: Part, value: Row): [name: string, text: string] => [
  `${String(value['name'] || part).replace(/[^\w.-]+/g, '_')}.json`,
  `${JSON.stringify(value, null, 2)}\n`,
];

/** Whether a file is a machine or a post; null if it is neither. */
export function partOf(read: unknown): Part | null {
  if (!isRow(read)) return null;
  if (Array.isArray(read['axes'])) return 'machine';
  return isRow(read['axes']) || read['kind'] === 'point_pairs' ? 'post' : null;
}

/** Errors of the service at the fields of the form. */
export const placed = ({errors = []}: Partial<Problem>): Issue[] =>
  errors.map((issue) => ({...issue, pointer: issue.pointer.replace(/^\?post(?=\/|$)/, '/post')}));
const within = (part: Part) => (issue: Issue) => issue.pointer === `/${part}` || issue.pointer.startsWith(`/${part}/`);

interface Shelf {
  name: string;
  value: Row;
}

/** A machine and a post that are made here: the form of both, and the service's word about them. */
export class OwnMachine {
  readonly form: Form;
  readonly shelves = signal<Record<Part, Shelf[]>>({machine: [], post: []});
  readonly states = signal<Record<Part, State>>({machine: undefined, post: undefined});
  readonly program = signal('');
  readonly stale = signal(false); // the program is of values before these
  readonly others = signal<Issue[]>([]); // errors that are at no field of the two files
  readonly trouble = signal<string>(''); // no answer, or a file that is neither
  readonly changes = signal(0);
  readonly started = signal<{part: Part; name: string} | undefined>(undefined); // until the next change
  private readonly latest = new Latest();

  constructor(
    contract: Contract,
    private readonly examples: Example[],
  ) {
    this.form = new Form(contract, {machine: [], size: [], rectangular_size: []}, () => this.changed());
    this.form.show(schema, {});
    for (const axis of ['along', 'out', 'across', 'turn', 'swing', 'tilt']) this.form.folds.set(`/post/axes/${axis}`, false);
  }

  async begin(): Promise<void> {
    try {
      const [{machines}, {posts}] = await Promise.all([
        fetched<{machines: {name: string; machine: Row; process?: Row}[]}>('/v1/machines'),
        fetched<{posts: {name: string; post: Row}[]}>('/v1/posts'),
      ]);
      this.shelves.value = {
        machine: machines.map(({name, machine, process}) => ({name, value: {...machine, ...(process ? {process} : {})}})),
        post: posts.map(({name, post}) => ({name, value: post})),
      };
    } catch (failure) {
      this.trouble.value = failure instanceof Error ? failure.message : String(failure);
      return;
    }
    const kept = stored();
    const body = Object.fromEntries(parts.map((part) => [part, isRow(kept[part]) ? kept[part] : this.copied(part, this.shelves.value[part][0]?.name)]));
    this.form.show(schema, body as Row);
    this.check();
  }

  private copied(part: Part, name: string | undefined): Row {
    const found = this.shelves.value[part].find((each) => each.name === name);
    return {...(found?.value ?? {}), name: part === 'machine' ? 'my_machine' : 'my_post'};
  }

  part(part: Part): Row {
    const value = this.form.body[part];
    return isRow(value) ? value : {};
  }

  /** Begins with one that the service lists. */
  startFrom(part: Part, name: string): void {
    this.put(part, this.copied(part, name));
    this.started.value = {part, name};
  }

  put(part: Part, value: Row): void {
    this.form.change((copy) => {
      copy[part] = value;
    });
    this.form.refresh(); // a field that was typed in would keep its text
  }

  async open(file: File): Promise<void> {
    let read: unknown;
    try {
      read = JSON.parse(await file.text());
    } catch {
      read = undefined;
    }
    const part = partOf(read);
    if (part) this.put(part, read as Row);
    else this.trouble.value = t('{file} is no file of a machine or a post.', {file: file.name});
  }

  /** The same in another unit or language. */
  refresh(): void {
    this.form.refresh();
    this.form.complain(parts.flatMap((part) => this.states.value[part] ?? []));
  }

  /** Whether the service lists one of this name: one that is built in would keep this file from loading. */
  taken(part: Part): boolean {
    return this.shelves.value[part].some(({name}) => name === this.part(part)['name']);
  }

  private changed(): void {
    this.changes.value += 1;
    this.started.value = undefined;
    try {
      localStorage.setItem(key, JSON.stringify(this.form.body));
    } catch {
      /* not remembered */
    }
    this.check();
  }

  private check(): void {
    this.latest.run(async (signal) => {
      const [machine, post] = [this.part('machine'), this.part('post')];
      const [motions, program] = await Promise.all([ask('pulse-schedules?validate_only=true', this.job(machine), signal), this.ask(machine, post, signal)]);
      if (signal.aborted) return;
      this.take(machine, motions.problem, program);
    }, false);
  }

  /** A schedule of the coupon; a machine that takes mill paths gets the published one. */
  job(machine: Row): Row {
    const milled = this.examples.find(({endpoint, body}) => endpoint === 'pulse-schedules' && body['machine'] === 'cone_mill');
    return machine['type'] === 'cone_mill' && milled ? {...milled.body, machine} : {cut: coupon, machine, motion};
  }

  private async ask(machine: Row, post: Row, signal: AbortSignal): Promise<{text: string} | {problem: Partial<Problem>}> {
    const query = new URLSearchParams({format: 'gcode', ...optionsOf(machine), post: JSON.stringify(post)});
    try {
      const reply = await fetch(`/v1/bevel-tables?${query}`, {
        method: 'POST',
        body: JSON.stringify(coupon),
        headers: headed({'Content-Type': 'application/json'}),
        signal,
      });
      const text = await reply.text();
      return reply.ok ? {text} : {problem: JSON.parse(text) as Problem};
    } catch {
      return {problem: away};
    }
  }

  private take(machine: Row, motions: Partial<Problem> | undefined, program: {text: string} | {problem: Partial<Problem>}): void {
    const unnamed: Issue = {code: 'missing_field', pointer: '/machine/name', got: null, limit: null, unit: '', hint: t('a file of a machine needs a name')};
    const of = 'problem' in program ? program.problem : undefined;
    const about = {
      machine: [...placed(motions ?? {}), ...(machine['name'] ? [] : [unnamed])].filter(within('machine')),
      post: placed(of ?? {}).filter(within('post')),
    };
    const silent = (problem: Partial<Problem> | undefined) => Boolean(problem && !problem.errors?.length); // it names no field
    const states = {machine: silent(motions) ? undefined : about.machine, post: silent(of) ? undefined : about.post};
    const why = [motions, of].find(silent);
    this.states.value = states;
    this.trouble.value = why ? (why.detail ?? t(why.title ?? '')) : '';
    this.others.value = [...placed(motions ?? {}), ...placed(of ?? {})].filter((issue) => !parts.some((part) => within(part)(issue)));
    const current = 'text' in program && states.machine?.length === 0;
    if (current) this.program.value = program.text;
    this.stale.value = !current;
    this.form.complain([...about.machine, ...about.post]);
  }
}
