/** Typed client of the tubecut service. Paths, requests and answers are those of openapi.yaml. */
import createFetchClient, {type Client, type ClientOptions} from 'openapi-fetch';
import type {components, paths} from './schema.js';
import {ContractError, isProblem, ProblemError} from './errors.js';
import {addressesOf, retryingFetch, type Addresses, type RetryOptions} from './replicas.js';

export {batch, type BatchOptions, type BatchReply, type BatchSummary, type DocumentReply} from './batch.js';
export {frame, type Frame, type FrameHead, frameLines, type FrameLine, type FrameOptions, type FramePart, type FrameSummary} from './frame.js';
export type {LineOptions, Progress} from './lines.js';
export {progressBar, type ProgressBarOptions, type Terminal} from './progress.js';
export {ContractError, type Problem, ProblemError, UnreachableError} from './errors.js';
export {type Addresses, retryingFetch, type RetryOptions} from './replicas.js';
export type {components, operations, paths} from './schema.js';

type Media = 'application/json' | 'application/problem+json';
export type Schemas = components['schemas'];
export type TubecutClient = Client<paths, Media>;

export type TubecutOptions = Omit<ClientOptions, 'baseUrl' | 'fetch'> & {retry?: RetryOptions};

/**
 * Returns the client of one service: `POST` and `GET` take the contract's paths and check their
 * arguments at compile time. Several addresses are replicas, tried in turn if one is away, full, or
 * lacks a pinned version.
 */
export function tubecut(baseUrl: Addresses, {retry, ...rest}: TubecutOptions = {}): TubecutClient {
  const [first = ''] = addressesOf(baseUrl);
  return createFetchClient<paths, Media>({querySerializer: {array: {style: 'form', explode: false}}, ...rest, baseUrl: first, fetch: retryingFetch(retry, baseUrl)});
}

interface Reply<Data> {
  data?: Data;
  error?: unknown;
  response: Response;
}

/** Returns the data of a call's answer, or throws a ProblemError. */
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

function sent<P extends PostPath, Data = Answer<P>>(
    client: TubecutClient, path: P, body: RequestBody<P>, {jobId, signal}: JobOptions, init: object = {}): Promise<NonNullable<Data>> {
  const send = client.POST as (path: P, init: object) => Promise<Reply<Data>>;
  return answered(send(path, {
    body, ...init, ...(jobId === undefined ? {} : {headers: {'Job-Id': jobId}}), ...(signal === undefined ? {} : {signal}),
  }));
}

/** Everything but the result: with the real verdict. */
export function validated<P extends PostPath>(client: TubecutClient, path: P, body: RequestBody<P>, options: JobOptions = {}): Promise<NonNullable<Answer<P>>> {
  return sent(client, path, body, options, {params: {query: {validate_only: true}}});
}

type Points = Schemas['BevelPoints'];
/** Columns that a table has only with certain options: a land, zones, a preset. */
type ByOption = 'z_face_mm' | 'b_face_deg' | 'zone' | 'root_gap_mm' | 'gap_inner_mm' | 'gap_outer_mm' | 'bevelled_gap_inner_mm' | 'bevelled_gap_outer_mm';
type Table<Named extends keyof Schemas, Of, Optional extends keyof Of> = Omit<Schemas[Named], 'points'> & {points: Required<Omit<Of, Optional>> & Pick<Of, Optional>};
type RoundTable = Table<'BevelTable', Points, ByOption>;
type SectionPoints = Schemas['SectionBevelPoints'];
type SectionTable = Table<'SectionBevelTable', SectionPoints, ByOption & keyof SectionPoints>;
type Whole<T, S> = Omit<T, 'result'> & {result: S extends SectionKind ? SectionTable : RoundTable};
/** A target whose kind is not round. */
type SectionKind = {kind: 'rectangular_tube' | 'flat_oval_tube'};
type Columns = Schemas['BevelColumns'] | Schemas['SectionBevelColumns'];
/** A table of which no columns are named has them all. */
type Seen<P extends PostPath, C, S> = P extends '/v1/bevel-tables' ? (C extends Columns ? Answered<P> : Whole<Answered<P>, S>) : Answered<P>;
type Naming<P extends PostPath, C, S> = P extends '/v1/bevel-tables' ? {columns?: C; target?: S} : unknown;

/**
 * One job: its whole answer with `result`, or a thrown ProblemError. Stricter than `client.POST`, whose inference lets unknown
 * fields of a literal through: here they do not compile.
 */
export async function post<P extends PostPath, C extends Columns | undefined = undefined, S = undefined>(
    client: TubecutClient, path: P, body: RequestBody<P> & Naming<P, C, S>, options: JobOptions = {}): Promise<Seen<P, C, S>> {
  const data = await sent(client, path, body, options);
  if (data.result === undefined) throw new ContractError('an answer without result');
  return data as Seen<P, C, S>;
}

/** Short names of the media types of the service's documents (docs/formats.md). */
export const FORMATS = {
  cbor: 'application/cbor', csv: 'text/csv', svg: 'image/svg+xml', dxf: 'image/vnd.dxf', glb: 'model/gltf-binary', stl: 'model/stl',
  step: 'model/step', nc1: 'application/x-dstv', gcode: 'text/x-gcode', st: 'text/x-iec61131-st', zip: 'application/zip', pdf: 'application/pdf',
} as const;
type Content<P extends PostPath> = paths[P]['post']['responses'][200]['content'];
/** The formats that the endpoint has. */
export type Format<P extends PostPath> = {
  [F in keyof typeof FORMATS]: (typeof FORMATS)[F] extends keyof Content<P> ? F : never
}[keyof typeof FORMATS];
/**
 * The options of its formats: view, mirror, those of G-code, and the files of a frame's packet. The
 * service decides which of them a format reads.
 */
export type FormatOptions<P extends PostPath> = Omit<NonNullable<paths[P]['post']['parameters']['query']>, 'format' | 'validate_only'>;

/** The same answer as a drawing, table or machine file, or a thrown ProblemError. */
export async function documentOf<P extends PostPath>(
    client: TubecutClient, path: P, body: RequestBody<P>, format: Format<P>, options?: FormatOptions<P>,
    job: JobOptions = {}): Promise<Blob> {
  return sent<P, Blob>(client, path, body, job, {params: {query: {...options, format}}, parseAs: 'blob'});
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
