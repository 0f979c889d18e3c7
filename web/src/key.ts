/**
 * The key of a service that requires one: only in this page's memory, in no storage, address or
 * link.
 */
let key = '';
let count = 0;

export const keyed = () => key !== '';
/** Number of given keys, so that the form is new after each. */
export const tried = () => count;
export function give(given: string): void {
  key = given;
  count += 1;
}

/** A request's headers with the key in its own one, which leaves `Authorization` to a proxy in front. */
export const headed = (headers: Record<string, string> = {}): Record<string, string> => (key ? {...headers, 'X-Api-Key': key} : headers);

/** The service answered 401. */
export class KeyNeeded extends Error {}
