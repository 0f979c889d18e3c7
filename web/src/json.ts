/** JSON values and the pointers (RFC 6901) that the service names fields by. */
export type Json = null | boolean | number | string | Json[] | {[key: string]: Json};
export type Row = {[key: string]: Json};

export const isRow = (value: unknown): value is Row => typeof value === 'object' && value !== null && !Array.isArray(value);

/** The objects of a list; of what is no list, none. */
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

/** Writes into `root`, making the objects on the way; `undefined` removes a member. */
export function put(root: Row, pointer: string, value: Json | undefined): void {
  const path = keys(pointer);
  const last = path.pop() as string;
  let holder: Json = root;
  for (const key of path) {
    const inner: Json | undefined = Array.isArray(holder) ? holder[Number(key)] : (holder as Row)[key];
    if (typeof inner === 'object' && inner !== null) holder = inner;
    else holder = (holder as Row)[key] = {};
  }
  if (Array.isArray(holder)) {
    if (value === undefined) holder.splice(Number(last), 1);
    else holder[Number(last)] = value;
  } else if (value === undefined) delete (holder as Row)[last];
  else (holder as Row)[last] = value;
}
