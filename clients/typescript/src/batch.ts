/** Many jobs over all replicas: parts side by side, each id answered once. */
import {ContractError, isProblem, refusal, UnreachableError} from './errors.js';
import type {BatchLine, DocumentLine, Schemas} from './index.js';
import {addressesOf, nameOf, Others, refusesPin, replicasAt, RETRYABLE, retryAfterMs, waitFor, type Addresses} from './replicas.js';

const MEDIA = 'application/x-ndjson';
const PART_BYTES = 4 << 20;  // the service takes 8 MiB
const AHEAD = 2000;  // lines read before they are sent
const PART_LINES = 8;  // at least, so that a replica of several slots has work for each
const STREAMS = 32;  // at most
const UNTAKEN = 256;  // answers that wait for a slow caller; then the service waits too
const AWAY_MS = 5000;  // how long a replica that was down is asked last
const LONGEST_WAIT_MS = 10_000;

type Line = BatchLine | DocumentLine;
type Reported = Pick<Schemas['BatchReply'], 'id' | 'line' | 'status' | 'verdict'>;
export type BatchReply = Reported & {body: Record<string, unknown>};
export type DocumentReply = {id: string; line: number; status: 200; verdict?: NonNullable<Reported['verdict']>; document: Blob};
export type BatchSummary = Schemas['BatchSummary']['summary'];

export interface BatchOptions {
  /** Ends the batch and the work on it. */
  signal?: AbortSignal;
  headers?: Record<string, string>;
  fetch?: typeof fetch;
  /** Parts at a time; else as many as there are replicas. 1: one after the other. */
  streams?: number;
  /** How long it goes on while no replica answers. */
  patienceMs?: number;
  /** Called with each answer: how many there are, of how many lines where that is known, how many of them refusals. */
  progress?: (done: number, total: number | undefined, refused: number) => void;
}

/** A line as it is sent; `at` is its number in the whole batch, from 1. */
interface Job {at: number; id: string; text: string; bytes: number}
interface Answered {at: number; reply: Schemas['BatchReply']}

/** This replica could not be reached, or broke off. */
class Down extends Error {}

/** It has no room for the batch. */
class Full extends Error {
  constructor(readonly waitMs: number) { super(); }
}

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

/** Whole lines; the stream may break off anywhere. */
async function* textLines(body: ReadableStream<Uint8Array>): AsyncGenerator<string> {
  const decoder = new TextDecoder();
  const reader = body.getReader();
  let rest = '';
  try {
    for (;;) {
      const {done, value} = await reader.read();
      const lines = (rest + decoder.decode(value, {stream: !done})).split('\n');
      rest = lines.pop() ?? '';
      yield* lines;
      if (done) return;
    }
  } finally {
    await reader.cancel().catch(() => undefined);  // left early: the service stops
  }
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

  /** The next ones; none at the end. For several streams fewer towards the end, so that they end together. */
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

/** What the parts of one batch share: where they ask, how long, and whether it goes on. */
class Run {
  readonly addresses: string[];
  readonly send: typeof fetch;
  readonly headers: Record<string, string>;
  readonly #patienceMs: number;
  readonly #stop = new AbortController();
  readonly #parts = new Map<string, number>();
  readonly #away = new Map<string, number>();
  #giveUp = 0;
  #first = 0;

  constructor(addresses: Addresses, {fetch: send = fetch, headers = {}, patienceMs = 30_000}: BatchOptions) {
    this.addresses = addressesOf(addresses);
    this.send = send;
    this.headers = headers;
    this.#patienceMs = patienceMs;
    this.goesOn();
  }

  get signal(): AbortSignal { return this.#stop.signal; }
  stop(reason?: unknown): void { this.#stop.abort(reason); }
  goesOn(): void { this.#giveUp = Date.now() + this.#patienceMs; }
  lastsTooLong(wait: number): boolean { return Date.now() + wait > this.#giveUp; }

  begin(address: string): void { this.#parts.set(address, this.#at(address) + 1); }
  end(address: string): void { this.#parts.set(address, this.#at(address) - 1); }
  #at(address: string): number { return this.#parts.get(address) ?? 0; }

  isDown(address: string): void { this.#away.set(address, Date.now() + AWAY_MS); }
  answered(address: string): void {
    this.#first = this.addresses.indexOf(address);
    this.#away.delete(address);
  }

  /** One not tried yet, not lately down, with the fewest parts at work; of such the one that answered last, and those after it. */
  next(tried: ReadonlySet<string>): string {
    const now = Date.now();
    const turns = [...this.addresses.slice(this.#first), ...this.addresses.slice(0, this.#first)].filter((one) => !tried.has(one));
    const cost = (one: string) => ((this.#away.get(one) ?? 0) > now ? 1e6 : 0) + this.#at(one);
    return turns.reduce((best, one) => (cost(one) < cost(best) ? one : best));
  }
}

/** The answers of one POST; `told` gets the name of who gives them. Ends when the stream has its summary. */
async function* streamed(run: Run, address: string, jobs: Job[], told: (name: string) => void): AsyncGenerator<Answered> {
  const broken = (error: unknown): never => {
    if (run.signal.aborted) throw run.signal.reason;
    throw new Down(String(error));
  };
  const reply = await run.send(`${address}/v1/batches`, {
    method: 'POST', headers: {...run.headers, 'Content-Type': MEDIA, Accept: MEDIA}, body: jobs.map(({text}) => text).join(''), signal: run.signal,
  }).catch(broken);
  if (RETRYABLE.has(reply.status)) {
    await reply.body?.cancel();
    throw new Full(Math.min(LONGEST_WAIT_MS, Math.max(100, retryAfterMs(reply, 0))));
  }
  if (!reply.ok || !reply.body) throw await refusal(reply);
  told(nameOf(reply));
  const lines = textLines(reply.body);
  try {
    for (;;) {
      const {done, value: text} = await lines.next().catch(broken);
      if (done) throw new Down('the batch broke off before its summary');
      const answer = parsed(text);
      if ('summary' in answer) return;
      const job = jobs[answer.line - 1];
      if (!job || (answer.id !== null && answer.id !== job.id)) throw new ContractError(`an answer to ${answer.id}, which was not asked`);
      yield {at: job.at, reply: answer};
    }
  } finally {
    await lines.return(undefined);
  }
}

function parsed(text: string): Schemas['BatchReply'] | Schemas['BatchSummary'] {
  try {
    return JSON.parse(text) as Schemas['BatchReply'] | Schemas['BatchSummary'];
  } catch {
    throw new ContractError(`an unreadable line of a batch: ${text.slice(0, 100)}`);
  }
}

/** Every job of a part once. What a dead or full replica left, or does not have as it is pinned, is asked of the next. */
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

/** What parts hand to the caller; a full one makes them wait. */
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
 * Many jobs, each answered once and as soon as it is done: a DocumentReply where the line names a format. One POST is the work of one replica,
 * so they go in parts, as many at a time as there are replicas: addresses, or names of replicas behind them (a proxy sends every request to
 * another). What a dead or full replica left is sent to the next; what a line pins is asked of others where one refuses it. Returns the summary.
 */
export function batch(baseUrl: Addresses, lines: Iterable<BatchLine>, options?: BatchOptions): AsyncGenerator<BatchReply, BatchSummary>;
export function batch(
    baseUrl: Addresses, lines: Iterable<Line>, options?: BatchOptions): AsyncGenerator<BatchReply | DocumentReply, BatchSummary>;
export async function* batch(
    baseUrl: Addresses, lines: Iterable<Line>, options: BatchOptions = {}): AsyncGenerator<BatchReply | DocumentReply, BatchSummary> {
  const {signal, progress} = options;
  const run = new Run(baseUrl, options);
  const stop = () => run.stop(signal?.reason);
  signal?.addEventListener('abort', stop, {once: true});
  if (signal?.aborted) stop();
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
    signal?.removeEventListener('abort', stop);
    run.stop();
  }
}
