/**
 * Several replicas, by their addresses or behind one: conditions and targets of repeats. Every call
 * is pure, so a repeat is safe.
 */
import {isProblem} from './errors.js';

export const RETRYABLE = new Set([429, 502, 503]);
const PINNED = new Set(['numerics_mismatch', 'machine_mismatch']);  // a replica of the version that the request pins would answer
const PIN_MS = 5000;  // time for which other replicas are tried behind addresses of several
const PIN_AGAIN = 20;  // refusals by only one name, after which there is no other behind an address
const STREAMS = 32;  // at most
// at a time; if all of them name known replicas, there is no other behind an address
const PROBES = 4;
const PROBE_MS = 2000;
const COUNT_MS = 60_000;  // how long a number of replicas is believed

/** One address of the service, or those of several replicas. */
export type Addresses = string | readonly string[];

export interface RetryOptions {
  /** How often one call is sent at most to each address. */
  attempts?: number;
  /** Longest wait between two attempts, even if `Retry-After` is longer. */
  longestWaitMs?: number;
  fetch?: (request: Request) => Promise<Response>;
}

export function addressesOf(addresses: Addresses): string[] {
  const all = (typeof addresses === 'string' ? [addresses] : [...addresses]).map((one) => one.replace(/\/$/, ''));
  if (all.length === 0) throw new TypeError('no address of the service');
  return all;
}

export const waitFor = (ms: number, signal: AbortSignal): Promise<void> => new Promise((resolve, reject) => {
  const stop = () => {
    clearTimeout(timer);
    reject(signal.reason);
  };
  const timer = setTimeout(() => {
    signal.removeEventListener('abort', stop);
    resolve();
  }, ms);
  if (signal.aborted) stop();
  else signal.addEventListener('abort', stop, {once: true});
});

/** Returns the wait that the service requests, or `otherwise`. */
export const retryAfterMs = (reply: Response | undefined, otherwise: number): number => {
  const asked = Number(reply?.headers.get('Retry-After') ?? NaN);
  return Number.isFinite(asked) ? 1000 * asked : otherwise;
};

export const nameOf = (reply: Response): string => reply.headers.get('Tubecut-Replica') ?? '';

/** Returns whether a problem means that this replica is not the pinned one. */
export const refusesPin = (status: number, problem: unknown): boolean => status === 409 && isProblem(problem) && PINNED.has(problem.code);

/**
 * Tracks whether there may be another replica than those that have refused a pin: an address not
 * tried yet, or behind one of them a replica to which the proxy has not sent a request. If others
 * send requests too, its choice is random.
 */
export class Others {
  readonly #left: Set<string>;
  readonly #names = new Map<string, Set<string>>();
  readonly #until = Date.now() + PIN_MS;
  #asked = 0;

  constructor(addresses: Iterable<string>) {
    this.#left = new Set(addresses);
  }

  async mayBe(address: string, name: string, signal: AbortSignal): Promise<boolean> {
    this.#left.delete(address);
    this.#names.set(address, (this.#names.get(address) ?? new Set()).add(name));
    this.#asked += 1;
    if (this.#left.size > 0) return true;
    const oneEach = [...this.#names.values()].every(({size}) => size === 1);
    const often = this.#asked >= PIN_AGAIN * this.#names.size;  // however long each answer took
    if (often && (oneEach || Date.now() > this.#until)) return false;
    // Two parts that alternate would meet the same replica each time, so the wait is random and
    // memoryless, and grows with the number of tries.
    await waitFor(-(30 + 8 * this.#asked) * Math.log(1 - Math.random()), signal);
    return true;
  }
}

/** The same request to another address. */
async function sentTo(address: string, base: string, request: Request): Promise<Request> {
  if (address === base) return request.clone();
  const body = await request.clone().arrayBuffer();
  const {method, headers, signal, credentials} = request;
  const {pathname, search} = new URL(request.url);
  const path = pathname.slice(new URL(base).pathname.replace(/\/$/, '').length);
  return new Request(address + path + search, {method, headers, signal, credentials, ...(body.byteLength > 0 ? {body} : {})});
}

/**
 * Returns a fetch that repeats safe requests, at the addresses in turn, beginning with the one that
 * answered last. If one refuses a pin, tries the others. `addresses` are those of replicas; the
 * first is the one that requests name.
 */
export function retryingFetch(options: RetryOptions = {}, addresses: Addresses = ''): (request: Request) => Promise<Response> {
  const {attempts = 4, longestWaitMs = 5000, fetch: send = fetch} = options;
  const all = addressesOf(addresses);
  const base = all[0] ?? '';
  let first = 0;
  return async (request) => {
    const others = new Others(all);
    let attempt = 1;
    for (let turn = 0; ; ++turn) {
      const index = (first + turn) % all.length;
      const address = all[index] ?? base;
      let reply: Response | undefined;
      try {
        reply = await send(await sentTo(address, base, request));
        if (reply.status === 409 && refusesPin(409, await reply.clone().json().catch(() => undefined))) {
          if (!(await others.mayBe(address, nameOf(reply), request.signal))) return reply;
          await reply.body?.cancel();
          continue;
        }
        if (!RETRYABLE.has(reply.status)) {
          first = index;
          return reply;
        }
        if (attempt >= attempts * all.length) return reply;
        await reply.body?.cancel();
      } catch (error) {
        if (request.signal.aborted || attempt >= attempts * all.length) throw error;
      }
      const wait = attempt % all.length === 0 ? retryAfterMs(reply, 100 * 2 ** (attempt / all.length)) : 0;
      await waitFor(Math.min(longestWaitMs, wait), request.signal);
      attempt += 1;
    }
  };
}

const counted = new Map<string, {count: number; until: number}>();

/** Returns the number of replicas, as far as the addresses and the names in answers show. */
export async function replicasAt(addresses: readonly string[], send: typeof fetch, headers: Record<string, string>, signal: AbortSignal): Promise<number> {
  const key = addresses.join(' ');
  const known = counted.get(key);
  if (known && Date.now() < known.until) return known.count;
  const names = new Set<string>();
  for (const address of addresses) {
    for (let before = -1; names.size > before && names.size < STREAMS;) {
      before = names.size;
      // Side by side, so that each has a connection of its own.
      for (const name of await Promise.all(Array.from({length: PROBES}, () => nameBehind(address, send, headers, signal)))) if (name) names.add(name);
    }
  }
  const count = Math.min(Math.max(addresses.length, names.size), STREAMS);
  if (names.size > 0) counted.set(key, {count, until: Date.now() + COUNT_MS});
  return count;
}

/** Returns the name of the replica that answers; undefined without an answer or a name. */
async function nameBehind(address: string, send: typeof fetch, headers: Record<string, string>, signal: AbortSignal): Promise<string> {
  const late = new AbortController();
  const stop = () => late.abort();
  const timer = setTimeout(stop, PROBE_MS);
  signal.addEventListener('abort', stop, {once: true});
  try {
    const reply = await send(`${address}/v1/version`, {headers, signal: late.signal});
    await reply.arrayBuffer();
    return nameOf(reply);
  } catch {
    return '';
  } finally {
    clearTimeout(timer);
    signal.removeEventListener('abort', stop);
  }
}
