import type {components} from '../../clients/typescript/src/schema';
import type {Json, Row} from './json';
import {headed, KeyNeeded} from './key';
import {later, t} from './language';

type Contract = components['schemas'];
export type Example = Omit<Contract['Examples']['examples'][number], 'body'> & {body: Row};
export type Endpoint = Contract['Version']['endpoints'][number];
export type Machine = {name: string; machine: Row};
export type Tube = Contract['Tubes']['tubes'][number];

export type Issue = Contract['Problem']['errors'][number];
/** The service's own, or one made here: no answer came, or one that cannot be read. */
export type Problem = Partial<Omit<Contract['Problem'], 'code'>> & {code: Contract['Problem']['code'] | 'unreachable' | 'unreadable_answer'; title: string};
export type Check = Contract['Verification']['checks'][number];
export type Warning = Contract['Warnings'][number];
/** Of any endpoint: its pictures know the content of the result. */
export interface Answer {
  job: Contract['Job'];
  request: Row;
  result: Row;
  parts?: Row[]; // of a frame
  verification: {passed: boolean; checks: Check[]};
  verdict: Contract['Verdict'];
  warnings: Warning[];
}

/** As the service judges a check: a value under its limit holds, however far under; NaN does not. */
export const holds = (check: Check) => check.value <= check.limit;

/** The service's answer or problem, and its time. */
export interface Reply {
  answer?: Answer;
  problem?: Problem;
  /** Answer and request as they were sent, byte by byte: hashes are of these. */
  text?: string;
  sent?: string;
  milliseconds: number;
}

export const path = (endpoint: string) => `/v1/${endpoint}`;

/** No answer came: this is not a refusal, and no change of the request would fix it. */
export const away: Problem = {
  code: 'unreachable',
  status: 0,
  title: later('The service cannot be reached.'),
  action: later('It may have been stopped, or the network is down. Your input is kept, and is computed as soon as the service is back.'),
};

/** Whether the service, or what is behind a proxy, is away. */
export const gone = ({problem}: Reply) =>
  problem !== undefined && (problem.code === away.code || (problem.code === 'unreadable_answer' && Number(problem.status) >= 500));

/** The service did not answer. */
export class Away extends Error {}

export async function fetched<T>(address: string): Promise<T> {
  const reply = await fetch(address, {headers: headed()}).catch(() => {
    throw new Away(t(away.title));
  });
  if (reply.status === 401) throw new KeyNeeded(`${address} answered 401`);
  if (reply.status >= 500) throw new Away(t('{address} answered {status}', {address, status: reply.status}));
  if (!reply.ok) throw new Error(t('{address} answered {status}', {address, status: reply.status}));
  return (await reply.json()) as T;
}

/** `signal` cancels it; then ignore the result. */
export async function ask(endpoint: string, body: Json, signal?: AbortSignal): Promise<Reply> {
  const start = performance.now();
  const sent = JSON.stringify(body);
  let reply: Response, text: string;
  try {
    reply = await fetch(path(endpoint), {
      method: 'POST',
      body: sent,
      headers: headed({'Content-Type': 'application/json', Accept: 'application/json'}),
      ...(signal ? {signal} : {}),
    });
    text = await reply.text();
  } catch {
    // a browser gives only "TypeError"
    return {problem: away, milliseconds: performance.now() - start};
  }
  const milliseconds = performance.now() - start;
  try {
    const json = JSON.parse(text) as Json;
    if (reply.ok) return {answer: json as unknown as Answer, text, sent, milliseconds};
    return {problem: json as unknown as Problem, milliseconds};
  } catch {
    // for example a proxy's page
    return {
      problem: {code: 'unreadable_answer', title: t('The answer (status {status}) is no JSON.', {status: reply.status}), status: reply.status},
      milliseconds,
    };
  }
}

const patience = 300; // ms for an answer that a newer question waits for

/** One question at a time. Of those that come meanwhile the newest waits for the answer, so that the picture follows a value that is dragged; an
 *  answer that takes too long for that, or is of another job, is broken off. */
export class Latest {
  private busy: {controller: AbortController; since: number} | null = null;
  private next: ((signal: AbortSignal) => Promise<void>) | null = null;
  private due = 0;

  run(task: (signal: AbortSignal) => Promise<void>, another: boolean): void {
    if (this.busy) {
      const {controller, since} = this.busy;
      this.next = task;
      clearTimeout(this.due);
      if (another) controller.abort();
      else this.due = window.setTimeout(() => controller.abort(), patience - (performance.now() - since));
      return;
    }
    const controller = new AbortController();
    this.busy = {controller, since: performance.now()};
    void task(controller.signal).finally(() => {
      clearTimeout(this.due);
      this.busy = null;
      const next = this.next;
      this.next = null;
      if (next) this.run(next, false);
    });
  }
}
