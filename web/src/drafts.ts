import type {Row} from './json';

/** A job that was changed here: kept in this browser at every change. */
export interface Draft {
  id: string;
  endpoint: string;
  body: Row;
  /** When it was changed last, ms since 1970. */
  changed: number;
}

const most = 50; // of older ones none is kept
const held = new Map<string, Draft>(); // of this page; all there is if the browser keeps nothing
let opening: Promise<IDBDatabase | null> | undefined;

const settled = <T>(request: IDBRequest<T>) =>
  new Promise<T>((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });

/** Nothing where the browser refuses, such as in a private window. */
function database(): Promise<IDBDatabase | null> {
  opening ??= new Promise((resolve) => {
    try {
      const request = indexedDB.open('tubecut', 1);
      request.onupgradeneeded = () => request.result.createObjectStore('drafts', {keyPath: 'id'});
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => resolve(null);
    } catch {
      resolve(null);
    }
  });
  return opening;
}

async function within<T>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => Promise<T>): Promise<T | undefined> {
  const open = await database();
  if (!open) return undefined;
  try {
    return await act(open.transaction('drafts', mode).objectStore('drafts'));
  } catch {
    return undefined; // no room left: the page still has it
  }
}

export const newId = () => Array.from(crypto.getRandomValues(new Uint8Array(9)), (byte) => byte.toString(36).padStart(2, '0')).join('');

let writing: Promise<unknown> | undefined;
let next: Draft | undefined;
let last: Draft | undefined;

/** Keeps a draft. Of changes that come while one is being written the last is. */
export function keep(draft: Draft): void {
  held.set(draft.id, draft);
  next = last = draft;
  writing ??= (async () => {
    while (next) {
      const one: Draft = next;
      next = undefined;
      await within('readwrite', (store) => settled(store.put(one)));
    }
    writing = undefined;
  })();
}

// A page that is left may take a write that has begun with it. This storage is written at once; the next page puts the draft where it belongs.
const leaving = 'draft';
globalThis.addEventListener?.('pagehide', () => {
  if (!writing || !last) return;
  try {
    sessionStorage.setItem(leaving, JSON.stringify(last));
  } catch {
    // too large, or refused
  }
});

/** Takes over the draft that the page before this one could not write. */
export function takeOver(): void {
  try {
    const left = sessionStorage.getItem(leaving);
    sessionStorage.removeItem(leaving);
    if (left) keep(JSON.parse(left) as Draft);
  } catch {
    // refused, or of no draft
  }
}

export const draftOf = async (id: string): Promise<Draft | undefined> =>
  held.get(id) ?? (await within('readonly', (store) => settled(store.get(id) as IDBRequest<Draft | undefined>)));

/** The newest first. */
export async function recent(): Promise<Draft[]> {
  const stored = (await within('readonly', (store) => settled(store.getAll() as IDBRequest<Draft[]>))) ?? [];
  const all = [...new Map([...stored.map((each) => [each.id, each] as const), ...held]).values()].sort((a, b) => b.changed - a.changed);
  const old = all.slice(most);
  if (old.length) void within('readwrite', (store) => Promise.all(old.map(({id}) => settled(store.delete(id)))));
  return all.slice(0, most);
}

export async function forget(id: string): Promise<void> {
  held.delete(id);
  await within('readwrite', (store) => settled(store.delete(id)));
}
