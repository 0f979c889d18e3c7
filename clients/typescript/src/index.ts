/** Typed client of the tubecut service. Paths, requests and answers are those of openapi.yaml. */
import createFetchClient, {type Client, type ClientOptions} from 'openapi-fetch';
import type {components, paths} from './schema.js';

export type {components, operations, paths} from './schema.js';

type Media = 'application/json' | 'application/problem+json';
export type Schemas = components['schemas'];
export type Problem = Schemas['Problem'];
export type TubecutClient = Client<paths, Media>;

/** A refusal or failure told by the service: which fields, what they were, what the limits are. */
export class ProblemError extends Error {
  constructor(readonly problem: Problem) {
    super(`${problem.status} ${problem.code}: ${problem.detail}`);
    this.name = 'ProblemError';
  }
}

/** The answer's body is not what the contract says, or there is none. */
export class ContractError extends Error {
  override name = 'ContractError';
}

export interface RetryOptions {
  /** How often one call is sent at most. */
  attempts?: number;
  /** Longest wait between two attempts, whatever `Retry-After` asks for. */
  longestWaitMs?: number;
  fetch?: (request: Request) => Promise<Response>;
}

const RETRYABLE = new Set([429, 502, 503]);

const waitFor = (ms: number, signal: AbortSignal): Promise<void> => new Promise((resolve, reject) => {
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

const waitMs = (reply: Response | undefined, attempt: number, longest: number): number => {
  const asked = Number(reply?.headers.get('Retry-After') ?? NaN);
  return Math.min(longest, Number.isFinite(asked) ? 1000 * asked : 100 * 2 ** attempt);
};

/** A fetch that repeats what is safe to repeat. Every call of tubecut is pure, so each of them is. */
export function retryingFetch(options: RetryOptions = {}): (request: Request) => Promise<Response> {
  const {attempts = 4, longestWaitMs = 5000, fetch: send = fetch} = options;
  return async (request) => {
    for (let attempt = 1; ; ++attempt) {
      let reply: Response | undefined;
      try {
        reply = await send(request.clone());
        if (!RETRYABLE.has(reply.status) || attempt >= attempts) return reply;
        await reply.body?.cancel();
      } catch (error) {
        if (request.signal.aborted || attempt >= attempts) throw error;
      }
      await waitFor(waitMs(reply, attempt, longestWaitMs), request.signal);
    }
  };
}

export type TubecutOptions = Omit<ClientOptions, 'baseUrl' | 'fetch'> & {retry?: RetryOptions};

/** The client of one service: `POST` and `GET` take the contract's paths and check their arguments at compile time. */
export function tubecut(baseUrl: string, {retry, ...rest}: TubecutOptions = {}): TubecutClient {
  return createFetchClient<paths, Media>({...rest, baseUrl, fetch: retryingFetch(retry)});
}

interface Reply<Data> {
  data?: Data;
  error?: unknown;
  response: Response;
}

const isProblem = (error: unknown): error is Problem =>
  typeof error === 'object' && error !== null && 'code' in error && 'errors' in error;

/** What a call was answered, or a thrown ProblemError. */
export async function answered<Data>(call: Promise<Reply<Data>>): Promise<NonNullable<Data>> {
  const {data, error, response} = await call;
  if (response.ok && data !== undefined && data !== null) return data;
  if (isProblem(error)) throw new ProblemError(error);
  throw new ContractError(`${response.status} from ${response.url} without a problem document`);
}

type JsonPost = {post: {requestBody: {content: {'application/json': unknown}}}};
export type PostPath = {[P in keyof paths]: paths[P] extends JsonPost ? P : never}[keyof paths];
export type RequestBody<P extends PostPath> = paths[P]['post']['requestBody']['content']['application/json'];
export type Answer<P extends PostPath> = paths[P]['post']['responses'][200]['content']['application/json'];
export type Answered<P extends PostPath> = Answer<P> & {result: NonNullable<Answer<P>['result']>};

export interface JobOptions {
  /** Echoed as `job.id`. */
  jobId?: string;
  signal?: AbortSignal;
}

/**
 * One job: its whole answer with `result`, or a thrown ProblemError. Stricter than `client.POST`, whose inference lets unknown
 * fields of a literal through: here they do not compile.
 */
export async function post<P extends PostPath>(
    client: TubecutClient, path: P, body: RequestBody<P>, {jobId, signal}: JobOptions = {}): Promise<Answered<P>> {
  const send = client.POST as (path: P, init: object) => Promise<Reply<Answer<P>>>;
  const data = await answered(send(path, {
    body, ...(jobId === undefined ? {} : {headers: {'Job-Id': jobId}}), ...(signal === undefined ? {} : {signal}),
  }));
  if (data.result === undefined) throw new ContractError('an answer without result');
  return data as Answered<P>;
}

/** What the service calls the media types of its documents (docs/formats.md). */
export const FORMATS = {
  cbor: 'application/cbor', csv: 'text/csv', svg: 'image/svg+xml', dxf: 'image/vnd.dxf', glb: 'model/gltf-binary', stl: 'model/stl',
  nc1: 'application/x-dstv', gcode: 'text/x-gcode', st: 'text/x-iec61131-st',
} as const;
type Content<P extends PostPath> = paths[P]['post']['responses'][200]['content'];
/** The formats that the endpoint has. */
export type Format<P extends PostPath> = {
  [F in keyof typeof FORMATS]: (typeof FORMATS)[F] extends keyof Content<P> ? F : never
}[keyof typeof FORMATS];
/** The options of its formats: view, mirror, and those of G-code. Which of them a format reads is the service's to say. */
export type FormatOptions<P extends PostPath> = Omit<NonNullable<paths[P]['post']['parameters']['query']>, 'format' | 'validate_only'>;

/** The same answer as a drawing, table or machine file, or a thrown ProblemError. */
export async function documentOf<P extends PostPath>(
    client: TubecutClient, path: P, body: RequestBody<P>, format: Format<P>, options?: FormatOptions<P>,
    {jobId, signal}: JobOptions = {}): Promise<Blob> {
  const send = client.POST as (path: P, init: object) => Promise<Reply<Blob>>;
  return answered(send(path, {
    body, params: {query: {...options, format}}, parseAs: 'blob',
    ...(jobId === undefined ? {} : {headers: {'Job-Id': jobId}}), ...(signal === undefined ? {} : {signal}),
  }));
}

/** One job of a batch; its body is the endpoint's own. */
export type BatchLine = {
  [P in PostPath]: P extends `/v1/${infer Endpoint}` ? {id: string; endpoint: Endpoint; body: RequestBody<P>; format?: never} : never
}[PostPath];
/** One that is answered by a document. */
export type DocumentLine = {
  [P in PostPath]: P extends `/v1/${infer Endpoint}` ?
    {id: string; endpoint: Endpoint; body: RequestBody<P>; format: Format<P>; options?: FormatOptions<P>} : never
}[PostPath];
type Reported = Pick<Schemas['BatchReply'], 'id' | 'line' | 'status' | 'verdict'>;
export type BatchReply = Reported & {body: Record<string, unknown>};
export type DocumentReply = {id: string; line: number; status: 200; verdict?: NonNullable<Reported['verdict']>; document: Blob};
export type BatchSummary = Schemas['BatchSummary']['summary'];

export interface BatchOptions {
  /** Ends the batch and the work on it. */
  signal?: AbortSignal;
  headers?: Record<string, string>;
  fetch?: typeof fetch;
}

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
      if (done) break;
    }
  } finally {
    await reader.cancel().catch(() => undefined);  // left early: the service stops
  }
  if (rest !== '') throw new ContractError('the batch was cut off within a line');
}

const bytesOf = (base64: string): Uint8Array => {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
};

/** A document as a Blob; an answer or a Problem as it is. */
function replyOf({media, document, document_base64, ...told}: Schemas['BatchReply']): BatchReply | DocumentReply {
  const content = document ?? (document_base64 === undefined ? undefined : bytesOf(document_base64));
  return (content === undefined ? told : {...told, document: new Blob([content], {type: media})}) as BatchReply | DocumentReply;
}

/**
 * Many jobs in one request: each answer as soon as it is done, a DocumentReply where the line names a format. Returns the summary; a
 * stream that ends without one was cut off, and is thrown as a ContractError: the jobs not answered may be sent again.
 */
export function batch(baseUrl: string, lines: Iterable<BatchLine>, options?: BatchOptions): AsyncGenerator<BatchReply, BatchSummary>;
export function batch(
    baseUrl: string, lines: Iterable<BatchLine | DocumentLine>, options?: BatchOptions): AsyncGenerator<BatchReply | DocumentReply, BatchSummary>;
export async function* batch(
    baseUrl: string, lines: Iterable<BatchLine | DocumentLine>, {signal, headers, fetch: send = fetch}: BatchOptions = {},
): AsyncGenerator<BatchReply | DocumentReply, BatchSummary> {
  const media = 'application/x-ndjson';
  const reply = await send(`${baseUrl.replace(/\/$/, '')}/v1/batches`, {
    method: 'POST', headers: {...headers, 'Content-Type': media, Accept: media},
    body: Array.from(lines, (line) => `${JSON.stringify(line)}\n`).join(''), ...(signal === undefined ? {} : {signal}),
  });
  if (!reply.ok || !reply.body) {
    const error: unknown = await reply.json().catch(() => undefined);
    if (isProblem(error)) throw new ProblemError(error);
    throw new ContractError(`${reply.status} from ${reply.url} without a problem document`);
  }
  for await (const text of textLines(reply.body)) {
    const answer = JSON.parse(text) as Schemas['BatchReply'] | Schemas['BatchSummary'];
    if ('summary' in answer) return answer.summary;
    yield replyOf(answer);
  }
  throw new ContractError('the batch was cut off: no summary');
}
