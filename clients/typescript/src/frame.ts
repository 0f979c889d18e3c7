/** A frame of any size: its answer, then each different part as it is done. */
import {ContractError, isProblem, ProblemError, UnreachableError, type Problem} from './errors.js';
import type {RequestBody, Schemas} from './index.js';
import {Down, Full, linesOf, Run, type LineOptions} from './lines.js';
import {Others, refusesPin, RETRYABLE, waitFor, type Addresses} from './replicas.js';

/**
 * The frame's first line: members, joints, cut list, the uncut ends. Its parts are still to be
 * made.
 */
export type FrameHead = Schemas['FrameBegun'];
/**
 * A part, with the name of its first member: the answer of `/v1/parts`, or the reason for its
 * absence.
 */
export type FramePart =
  {id: string; status: 200; answer: Schemas['PartsResponse']; problem?: never} | {id: string; status: number; problem: Problem; answer?: never};
export interface FrameSummary {items: number; answered: number; refused: number}
/** `head` comes first and `summary` last. */
export type FrameLine = {head: FrameHead; part?: never; summary?: never} | {part: FramePart; head?: never; summary?: never} |
  {summary: FrameSummary; head?: never; part?: never};

export interface FrameOptions extends LineOptions {
  /** Echoed as `job.id`. */
  jobId?: string;
}

export interface Frame {head: FrameHead; parts: Map<string, FramePart>; summary: FrameSummary}

type Wire = FrameHead | Schemas['BatchReply'] | Schemas['BatchSummary'];

function parsed(text: string): Wire {
  try {
    return JSON.parse(text) as Wire;
  } catch {
    throw new ContractError(`an unreadable line of a frame: ${text.slice(0, 100)}`);
  }
}

function partOf({id, status, body}: Schemas['BatchReply'], names: ReadonlySet<string>): FramePart {
  if (id === null || !names.has(id)) throw new ContractError(`a part ${id}, which the frame has not`);
  if (status === 200) return {id, status, answer: body as unknown as Schemas['PartsResponse']};
  if (!isProblem(body)) throw new ContractError(`part ${id} has ${status} without a problem document`);
  return {id, status, problem: body};
}

/** The answer and every part once, from one replica or several: parts known already do not come again. */
async function* asked(run: Run, body: string, headers: Record<string, string>): AsyncGenerator<FrameHead | FramePart> {
  let names: Set<string> | undefined;
  let left = new Set<string>();
  const tried = new Set<string>();
  const others = new Others(run.addresses);
  while (!names || left.size > 0) {
    const before = left.size;
    const address = run.next(tried);
    let wait = 100;
    let name = '';
    run.begin(address);
    try {
      for await (const text of linesOf(run, `${address}/v1/frames`, headers, body, (told) => { name = told; })) {
        const line = parsed(text);
        if ('summary' in line) break;
        if ('result' in line) {
          if (names) continue;
          names = new Set(line.result.cut_list.map(({part}) => part));
          left = new Set(names);
          yield line;
        } else if (!RETRYABLE.has(line.status)) {
          const part = partOf(line, names ?? left);
          if (!left.delete(part.id)) continue;
          run.goesOn();
          yield part;
        }
      }
      run.answered(address);
    } catch (error) {
      if (error instanceof Down) run.isDown(address);
      else if (error instanceof Full) wait = error.waitMs;
      else if (!(error instanceof ProblemError && refusesPin(error.problem.status, error.problem) && await others.mayBe(address, name, run.signal))) throw error;
      tried.add(address);
    } finally {
      run.end(address);
    }
    if (tried.size === run.addresses.length) tried.clear();
    if (names && left.size === 0) return;
    if (run.lastsTooLong(wait)) throw new UnreachableError(`${left.size} parts of the frame are unanswered; tried ${run.addresses.join(', ')}`);
    if (left.size === before) await waitFor(wait, run.signal);
  }
}

/**
 * Yields line by line: the frame, every different part once as it is done, a summary. Each part has
 * its own budget, but `post(client, '/v1/frames', ...)` has one for all; values that need the
 * finished parts (weld and fit-up of joints, totals) are only in that answer. If a replica dies or
 * is full, requests the rest from the next. If you leave the loop, the work ends.
 */
export async function* frameLines(baseUrl: Addresses, body: RequestBody<'/v1/frames'>, options: FrameOptions = {}): AsyncGenerator<FrameLine, void> {
  const {jobId, progress} = options;
  const run = new Run(baseUrl, options);
  const summary = {items: 0, answered: 0, refused: 0};
  try {
    for await (const one of asked(run, JSON.stringify(body), {'Content-Type': 'application/json', ...(jobId === undefined ? {} : {'Job-Id': jobId})})) {
      const begun = 'result' in one;
      if (begun) summary.items = one.result.cut_list.length;
      else summary[one.answer ? 'answered' : 'refused'] += 1;
      progress?.(summary.answered + summary.refused, summary.items, summary.refused);
      yield begun ? {head: one} : {part: one};
    }
    yield {summary};
  } finally {
    run.stop();
  }
}

/**
 * Returns the lines of a frame, gathered: each part by its name, which `head.result.members` has
 * for each member.
 */
export async function frame(baseUrl: Addresses, body: RequestBody<'/v1/frames'>, options: FrameOptions = {}): Promise<Frame> {
  const parts = new Map<string, FramePart>();
  let made: FrameHead | undefined;
  for await (const {head, part, summary} of frameLines(baseUrl, body, options)) {
    if (head) made = head;
    else if (part) parts.set(part.id, part);
    else if (summary && made) return {head: made, parts, summary};
  }
  throw new ContractError('a frame without a summary');
}
