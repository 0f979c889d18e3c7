/** Many jobs over all replicas: parts side by side, each id answered once. */
import {ContractError, UnreachableError} from './errors.js';
import type {BatchLine, DocumentLine, Schemas} from './index.js';
import {Down, Full, linesOf, NDJSON, Run, type LineOptions} from './lines.js';
import {Others, refusesPin, replicasAt, RETRYABLE, waitFor, type Addresses} from './replicas.js';

const PART_BYTES = 4 << 20;  // the service takes 8 MiB
const AHEAD = 2000;  // lines read before they are sent
const PART_LINES = 8;  // at least, so that a replica of several slots has work for each
const STREAMS = 32;  // at most
const UNTAKEN = 256;  // answers that wait for a slow caller; then the service waits too

type Line = BatchLine | DocumentLine;
type Reported = Pick<Schemas['BatchReply'], 'id' | 'line' | 'status' | 'verdict'>;
export type BatchReply = Reported & {body: Record<string, unknown>};
export type DocumentReply = {id: string; line: number; status: 200; verdict?: NonNullable<Reported['verdict']>; document: Blob};
export type BatchSummary = Schemas['BatchSummary']['summary'];

export interface BatchOptions extends LineOptions {
  /** Parts at a time; else as many as there are replicas. 1: one after the other. */
  streams?: number;
}

/** A line as it is sent; `at` is its number in the whole batch, from 1. */
interface Job {at: number; id: string; text: string; bytes: number}
interface Answered {at: number; reply: Schemas['BatchReply']}

const bytesOf = (base64: string): Uint8Array => {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
};

/** A document as a Blob; an answer or a Problem as it is. */
function replyOf({at, reply: {media, document, document_base64, ...told}}: Answered): BatchReply | DocumentReply {
  const content = document ?? (document_base64 === undefined ? undefined : bytesOf(document_base64));
  return {...told, line: at, ...(content === undefined ? {} : {document: new Blob([content], {type: media})})} as BatchReply | DocumentReply;
}

/** The lines not sent yet, read as far ahead as a part may be large. */
class Waiting {
  readonly #lines: Iterator<Line>;
  readonly #ahead: Job[] = [];
  #bytes = 0;
  #read = 0;
  #ended = false;

  constructor(lines: Iterable<Line>) {
    this.#lines = lines[Symbol.iterator]();
  }

  /** How many there are now: all, or as many as one POST may have. */
  fill(): number {
    while (!this.#ended && this.#ahead.length < AHEAD && this.#bytes < PART_BYTES) {
      const {done, value} = this.#lines.next();
      if (done) {
        this.#ended = true;
        break;
      }
      const text = `${JSON.stringify(value)}\n`;
      const bytes = new TextEncoder().encode(text).length;
      this.#ahead.push({at: ++this.#read, id: value.id, text, bytes});
      this.#bytes += bytes;
    }
    return this.#ahead.length;
  }

  /**
   * Returns the next jobs; empty at the end. With several streams fewer towards the end, so that
   * they end together.
   */
  part(streams: number): Job[] {
    let count = this.fill();
    if (streams > 1) {
      const share = Math.ceil(count / (this.#ended ? 2 * streams : streams));
      count = Math.max(share, Math.min(PART_LINES, Math.ceil(count / streams)));
    }
    let size = 0;
    let taken = 0;
    for (const {bytes} of this.#ahead.slice(0, count)) {
      if (taken > 0 && size + bytes > PART_BYTES) break;
      size += bytes;
      taken += 1;
    }
    this.#bytes -= size;
    return this.#ahead.splice(0, taken);
  }
}

/** The answers of one POST; `told` gets the name of who gives them. Ends when the stream has its summary. */
async function* streamed(run: Run, address: string, jobs: Job[], told: (name: string) => void): AsyncGenerator<Answered> {
  for await (const text of linesOf(run, `${address}/v1/batches`, {'Content-Type': NDJSON}, jobs.map((job) => job.text).join(''), told)) {
    const answer = parsed(text);
    if ('summary' in answer) return;
    const job = jobs[answer.line - 1];
    if (!job || (answer.id !== null && answer.id !== job.id)) throw new ContractError(`an answer to ${answer.id}, which was not requested`);
    yield {at: job.at, reply: answer};
  }
}

function parsed(text: string): Schemas['BatchReply'] | Schemas['BatchSummary'] {
  try {
    return JSON.parse(text) as Schemas['BatchReply'] | Schemas['BatchSummary'];
  } catch {
    throw new ContractError(`an unreadable line of a batch: ${text.slice(0, 100)}`);
  }
}

/**
 * Yields every job of a part once. If a replica dies, is full, or lacks a pinned version, requests
 * the rest from the next.
 */
async function* part(run: Run, jobs: Job[]): AsyncGenerator<Answered> {
  const left = new Map(jobs.map((job) => [job.at, job]));
  const tried = new Set<string>();
  const others = new Others(run.addresses);
  run.goesOn();
  while (left.size > 0) {
    const before = left.size;
    const elsewhere: Answered[] = [];
    const address = run.next(tried);
    let wait = 100;
    let name = '';
    run.begin(address);
    try {
      for await (const one of streamed(run, address, [...left.values()], (told) => { name = told; })) {
        if (RETRYABLE.has(one.reply.status) || !left.has(one.at)) continue;  // sent again below, or known already
        if (refusesPin(one.reply.status, one.reply.body)) {
          elsewhere.push(one);
          continue;
        }
        left.delete(one.at);
        run.goesOn();
        yield one;
      }
      run.answered(address);
      if (elsewhere.length > 0 && await others.mayBe(address, name, run.signal)) tried.add(address);
      else for (const one of elsewhere) if (left.delete(one.at)) yield one;  // as they are refused everywhere, so they are
    } catch (error) {
      if (error instanceof Down) run.isDown(address);
      else if (error instanceof Full) wait = error.waitMs;
      else throw error;
      tried.add(address);
    } finally {
      run.end(address);
    }
    if (tried.size === run.addresses.length) tried.clear();
    if (left.size > 0 && run.lastsTooLong(wait)) throw new UnreachableError(`${left.size} jobs of the batch are unanswered; tried ${run.addresses.join(', ')}`);
    if (left.size === before) await waitFor(wait, run.signal);
  }
}

/** Answers from parts to the caller; if it is full, the parts wait. */
class Queue<T> {
  readonly #items: T[] = [];
  #change: () => void = () => undefined;
  #changed = this.#next();

  #next(): Promise<void> {
    return new Promise((resolve) => { this.#change = resolve; });
  }

  #tell(): void {
    const change = this.#change;
    this.#changed = this.#next();
    change();
  }

  async put(item: T): Promise<void> {
    while (this.#items.length >= UNTAKEN) await this.#changed;
    this.#items.push(item);
    this.#tell();
  }

  async take(): Promise<T> {
    while (this.#items.length === 0) await this.#changed;
    const [item] = this.#items.splice(0, 1) as [T];
    this.#tell();
    return item;
  }
}

type Event = Answered | 'ended' | {failed: unknown};

/** Parts side by side. One that is done makes room for the next, so a slow replica gets fewer. */
async function* spread(run: Run, waiting: Waiting, streams: number): AsyncGenerator<Answered> {
  const events = new Queue<Event>();
  const work = async (jobs: Job[]): Promise<void> => {
    try {
      for await (const one of part(run, jobs)) {
        await events.put(one);
        if (run.signal.aborted) return;
      }
      await events.put('ended');
    } catch (failed) {
      await events.put({failed});
    }
  };
  let active = 0;
  for (;;) {
    for (let jobs: Job[]; active < streams && (jobs = waiting.part(streams)).length > 0; ++active) void work(jobs);
    if (active === 0) return;
    const got = await events.take();
    if (got === 'ended') active -= 1;
    else if ('failed' in got) throw got.failed;
    else yield got;
  }
}

/**
 * Answers many jobs, each once and as soon as it is done: with a DocumentReply if the line names a
 * format. One POST is the work of one replica, so they go in parts, one for each replica at a time:
 * addresses, or names of replicas behind them (a proxy sends every request to another). If a
 * replica dies or is full, its rest goes to the next; if it refuses a pin, the line goes to others.
 * Returns the summary.
 */
export function batch(baseUrl: Addresses, lines: Iterable<BatchLine>, options?: BatchOptions): AsyncGenerator<BatchReply, BatchSummary>;
export function batch(
    baseUrl: Addresses, lines: Iterable<Line>, options?: BatchOptions): AsyncGenerator<BatchReply | DocumentReply, BatchSummary>;
export async function* batch(
    baseUrl: Addresses, lines: Iterable<Line>, options: BatchOptions = {}): AsyncGenerator<BatchReply | DocumentReply, BatchSummary> {
  const {progress} = options;
  const run = new Run(baseUrl, options);
  const total = Array.isArray(lines) ? lines.length : undefined;
  const summary = {items: 0, answered: 0, refused: 0, unanswered: 0};
  try {
    const waiting = new Waiting(lines);
    const streams = waiting.fill() > 1 ? options.streams ?? await replicasAt(run.addresses, run.send, run.headers, run.signal) : 1;
    for await (const one of spread(run, waiting, Math.min(streams, STREAMS))) {
      summary.items += 1;
      summary[one.reply.status === 200 ? 'answered' : 'refused'] += 1;
      progress?.(summary.items, total, summary.refused);
      yield replyOf(one);
    }
    return summary;
  } finally {
    run.stop();
  }
}
