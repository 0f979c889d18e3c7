import type {Row} from './json';

/** The whole state of the page in its hash, so that a link is a job:
 *  `#/bevel-tables/source-000-table-1?view=before`, or `#/bevel-tables/~<deflated body>` once edited. */
export interface Place {
  endpoint: string;
  example?: string;
  body?: Row;
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

export async function written(place: Place): Promise<string> {
  const view = new URLSearchParams(place.view).toString();
  let job = place.example ?? '';
  if (place.body) {
    const bytes = new TextEncoder().encode(JSON.stringify(place.body));
    if (bytes.length > 20 * largest) return `#/${place.endpoint}`;
    job = '~' + toText(await through(bytes, new CompressionStream('deflate-raw')));
    if (job.length > largest) return `#/${place.endpoint}`;
  }
  return `#/${place.endpoint}/${job}${view ? `?${view}` : ''}`;
}

export async function read(hash: string): Promise<Place | null> {
  const match = /^#\/([a-z-]+)(?:\/([^?]*))?(?:\?(.*))?$/.exec(hash);
  if (!match) return null;
  const place: Place = {endpoint: match[1] as string, view: Object.fromEntries(new URLSearchParams(match[3] ?? ''))};
  const job = match[2] ?? '';
  if (!job.startsWith('~')) return {...place, example: job || undefined} as Place;
  try {
    const bytes = await through(toBytes(job.slice(1)), new DecompressionStream('deflate-raw'));
    return {...place, body: JSON.parse(new TextDecoder().decode(bytes)) as Row};
  } catch {
    return place; // a link cut short: the endpoint's first example
  }
}
