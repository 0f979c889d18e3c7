/** The one cursor of each group of views: an index into their common points, or nothing. */
type Listener = (index: number | null) => void;
const groups = new Map<string, Set<Listener>>();
const last = new Map<string, number | null>();
let quiet = false;

export function listen(link: string, listener: Listener): () => void {
  const group = groups.get(link) ?? new Set();
  groups.set(link, group.add(listener));
  return () => group.delete(listener);
}

/**
 * Moves the cursor. Views move their own meanwhile, so their reports are echoes and are ignored.
 */
export function point(link: string, index: number | null): void {
  if (quiet || last.get(link) === index) return;
  last.set(link, index);
  quiet = true;
  groups.get(link)?.forEach((listener) => listener(index));
  quiet = false;
}

/** The selection stays when the cursor leaves: a separate group. */
export const chosen = (link: string) => `${link}, chosen`;

/** Items that are chosen together with that of the cursor, for example rows of a table. */
const together = new Map<string, number[]>();
export const chosenTogether = (link: string): number[] => together.get(link) ?? [];
export function chooseTogether(link: string, items: number[]): void {
  if (chosenTogether(link).join() === items.join()) return;
  together.set(link, items);
  groups.get(chosen(link))?.forEach((listener) => listener(pointed(chosen(link))));
}

/** Nothing is pointed at, nor chosen. */
export const rest = () => {
  together.clear();
  for (const link of groups.keys()) point(link, null);
};

export const pointed = (link: string) => last.get(link) ?? null;
