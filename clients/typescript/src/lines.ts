/**
 * One POST whose answer comes in lines, and the shared state of its repeats at replicas: addresses,
 * time limit, and cancellation.
 */
import {refusal} from './errors.js';
import {addressesOf, nameOf, RETRYABLE, retryAfterMs, type Addresses} from './replicas.js';

export const NDJSON = 'application/x-ndjson';
const AWAY_MS = 5000;  // time for which a replica that was down is tried last
const LONGEST_WAIT_MS = 10_000;

/** Called with each answer: how many there are, of how many where that is known, how many of them refusals. */
export type Progress = (done: number, total: number | undefined, refused: number) => void;

export interface LineOptions {
  /** Ends it and the work on it. */
  signal?: AbortSignal;
  headers?: Record<string, string>;
  fetch?: typeof fetch;
  /** How long it goes on while no replica answers. */
  patienceMs?: number;
  progress?: Progress;
}

/** This replica could not be reached, or broke off. */
export class Down extends Error {}

/** It has no room for this. */
export class Full extends Error {
  constructor(readonly waitMs: number) { super(); }
}

/** Whole lines that are not blank, because a blank one only says that the service still works; the stream may break off anywhere. */
async function* textLines(body: ReadableStream<Uint8Array>): AsyncGenerator<string> {
  const decoder = new TextDecoder();
  const reader = body.getReader();
  let rest = '';
  try {
    for (;;) {
      const {done, value} = await reader.read();
      const lines = (rest + decoder.decode(value, {stream: !done})).split('\n');
      rest = lines.pop() ?? '';
      yield* lines.filter((line) => line.trim() !== '');
      if (done) return;
    }
  } finally {
    await reader.cancel().catch(() => undefined);  // left early: the service stops
  }
}

/** Shared state of the POSTs of one batch or frame. */
export class Run {
  readonly addresses: string[];
  readonly send: typeof fetch;
  readonly headers: Record<string, string>;
  readonly #patienceMs: number;
  readonly #stop = new AbortController();
  readonly #parts = new Map<string, number>();
  readonly #away = new Map<string, number>();
  readonly #unlink: () => void;
  #giveUp = 0;
  #first = 0;

  constructor(addresses: Addresses, {fetch: send = fetch, headers = {}, patienceMs = 30_000, signal}: LineOptions) {
    this.addresses = addressesOf(addresses);
    this.send = send;
    this.headers = headers;
    this.#patienceMs = patienceMs;
    const stop = () => this.#stop.abort(signal?.reason);
    signal?.addEventListener('abort', stop, {once: true});
    this.#unlink = () => signal?.removeEventListener('abort', stop);
    if (signal?.aborted) stop();
    this.goesOn();
  }

  get signal(): AbortSignal { return this.#stop.signal; }
  /** It ends here, for whatever reason. */
  stop(): void {
    this.#unlink();
    this.#stop.abort();
  }
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

/** The lines of one POST; `told` gets the name of who gives them. They never end well by themselves: the caller leaves at the summary. */
export async function* linesOf(run: Run, url: string, headers: Record<string, string>, body: string, told: (name: string) => void): AsyncGenerator<string, never> {
  const broken = (error: unknown): never => {
    if (run.signal.aborted) throw run.signal.reason;
    throw new Down(String(error));
  };
  const reply = await run.send(url, {method: 'POST', headers: {...run.headers, ...headers, Accept: NDJSON}, body, signal: run.signal}).catch(broken);
  told(nameOf(reply));
  if (RETRYABLE.has(reply.status)) {
    await reply.body?.cancel();
    throw new Full(Math.min(LONGEST_WAIT_MS, Math.max(100, retryAfterMs(reply, 0))));
  }
  if (!reply.ok || !reply.body) throw await refusal(reply);
  const lines = textLines(reply.body);
  try {
    for (;;) {
      const {done, value} = await lines.next().catch(broken);
      if (done) throw new Down('the answer broke off before its summary');
      yield value;
    }
  } finally {
    await lines.return(undefined);
  }
}
