import {isRow, type Row} from './json';
import {later} from './language';

/** The whole state of the page in its hash, so that a link is a job:
 *  `#/bevel-tables/source-000-table-1?view=before`, or `#/bevel-tables/~.<deflated body>` once edited. */
export interface Place {
  endpoint: string;
  example?: string;
  body?: Row;
  /** Of a job that is kept in this browser, because it is too long for a link. */
  draft?: string;
  view: Record<string, string>;
}

const toText = (bytes: Uint8Array) =>
  btoa(String.fromCharCode(...bytes))
    .replace(/\+/g, '-')
    .replace(/\//g, '_')
    .replace(/=+$/, '');
const toBytes = (text: string) => Uint8Array.from(atob(text.replace(/-/g, '+').replace(/_/g, '/')), (c) => c.charCodeAt(0));

async function through(bytes: Uint8Array, stream: GenericTransformStream): Promise<Uint8Array> {
  const piped = new Blob([bytes]).stream().pipeThrough(stream as ReadableWritablePair);
  return new Uint8Array(await new Response(piped).arrayBuffer());
}

const largest = 24000; // characters; longer addresses do not survive mail and chat
const mark = '~'; // marks a job in full, as opposed to the name of an example
const local = '@'; // marks the id of a draft
const sealed = '.'; // deflated with a checksum (zlib): without one, another character in the middle can be another job

/** If a job is too long for an address, the address names its draft. */
export async function written(place: Place & {draft: string}): Promise<string> {
  const search = new URLSearchParams(place.view).toString();
  const view = search ? `?${search}` : '';
  let job = place.example ?? '';
  if (place.body) {
    const bytes = new TextEncoder().encode(JSON.stringify(place.body));
    job = mark + sealed + (bytes.length > 20 * largest ? '' : toText(await through(bytes, new CompressionStream('deflate'))));
    if (job.length > largest || job.length === 2) return `#/${place.endpoint}/${local}${place.draft}${view}`;
  }
  return `#/${place.endpoint}/${job}${view}`;
}

export const tooLong = (hash: string) => hash.includes(`/${local}`);

/**
 * Returns the content of a link, or the reason why it cannot be trusted. Null if the hash is not a
 * link to a job.
 */
export async function read(hash: string): Promise<Place | {damage: string} | null> {
  if (!hash.startsWith('#/') || hash === '#/') return null;
  const match = /^#\/([a-z-]+)(?:\/([^?]*))?(?:\?(.*))?$/.exec(hash);
  if (!match) return {damage: later('The link names an unknown endpoint.')};
  const place: Place = {endpoint: match[1] as string, view: Object.fromEntries(new URLSearchParams(match[3] ?? ''))};
  try {
    const job = decodeURIComponent(match[2] ?? '');
    if (job.startsWith(local)) return {...place, draft: job.slice(1)};
    if (job === mark) return {damage: later('The job was too long for a link: its request can be copied as JSON instead.')};
    if (job.startsWith(mark)) return {...place, body: await unpacked(job.slice(1))};
    return job ? {...place, example: job} : place;
  } catch {
    return {damage: later('A part of it is missing or was changed on the way, so the job in it cannot be read.')};
  }
}

async function unpacked(text: string): Promise<Row> {
  const format = text.startsWith(sealed) ? 'deflate' : 'deflate-raw'; // links of old have no checksum
  const bytes = await through(toBytes(text.replace(sealed, '')), new DecompressionStream(format));
  const body: unknown = JSON.parse(new TextDecoder('utf-8', {fatal: true}).decode(bytes));
  if (!isRow(body)) throw new Error('no job');
  return body;
}
