/** The key of a service that asks for one: in this page's memory alone, in no storage, address or link. */
let key = '';
let count = 0;

export const keyed = () => key !== '';
/** How many keys were given: the form that asks is another after each. */
export const tried = () => count;
export function give(given: string): void {
  key = given;
  count += 1;
}

/** A request's headers with the key in its own one, which leaves `Authorization` to a proxy in front. */
export const headed = (headers: Record<string, string> = {}): Record<string, string> => (key ? {...headers, 'X-Api-Key': key} : headers);

/** The service answered 401. */
export class KeyNeeded extends Error {}
