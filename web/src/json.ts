/** JSON values and the pointers (RFC 6901) that the service names fields by. */
export type Json = null | boolean | number | string | Json[] | {[key: string]: Json};
export type Row = {[key: string]: Json};

export const isRow = (value: unknown): value is Row => typeof value === 'object' && value !== null && !Array.isArray(value);

/** Returns the objects of a list; [] if it is not a list. */
export const rowsOf = (value: unknown) => (Array.isArray(value) ? value.filter(isRow) : []);

export const clone = <T>(value: T): T => JSON.parse(JSON.stringify(value)) as T;

const escaped = (key: string) => key.replace(/~/g, '~0').replace(/\//g, '~1');
const unescaped = (key: string) => key.replace(/~1/g, '/').replace(/~0/g, '~');

export const join = (pointer: string, key: string | number) => `${pointer}/${escaped(String(key))}`;
export const keys = (pointer: string) => pointer.split('/').slice(1).map(unescaped);

export function at(root: Json | undefined, pointer: string): Json | undefined {
  let value: Json | undefined = root;
  for (const key of keys(pointer)) {
    if (Array.isArray(value)) value = value[Number(key)];
    else if (isRow(value)) value = value[key];
    else return undefined;
  }
  return value;
}

/** The root with another value at `pointer`, with the objects on the way to it; `undefined` removes what is there. Only what holds the value is
 *  copied, so that what is drawn of the rest stays as it is, and every state before is still there to go back to. */
export const put = (root: Row, pointer: string, value: Json | undefined): Row => replaced(root, keys(pointer), value) as Row;

function replaced(holder: Json | undefined, [key = '', ...rest]: string[], value: Json | undefined): Json {
  if (Array.isArray(holder)) {
    const index = Number(key);
    const made = rest.length ? replaced(holder[index], rest, value) : value;
    return [...holder.slice(0, index), ...(made === undefined ? [] : [made]), ...holder.slice(index + 1)];
  }
  const row = {...(isRow(holder) ? holder : {})};
  const made = rest.length ? replaced(row[key], rest, value) : value;
  if (made === undefined) delete row[key];
  else row[key] = made;
  return row;
}

/** The value `now` with every part of `was` that is equal to its own in the place of that part. */
export function sharing(was: Json | undefined, now: Json): Json {
  if (was === now || typeof was !== 'object' || typeof now !== 'object' || was === null || now === null) return now;
  if (Array.isArray(now)) {
    if (!Array.isArray(was)) return now;
    const all = now.map((each, i) => sharing(was[i], each));
    return all.length === was.length && all.every((each, i) => each === was[i]) ? was : all;
  }
  if (Array.isArray(was)) return now;
  const all = Object.fromEntries(Object.entries(now).map(([key, each]) => [key, sharing(was[key], each)]));
  const names = Object.keys(all);
  return names.length === Object.keys(was).length && names.every((key) => key in was && all[key] === was[key]) ? was : all;
}
