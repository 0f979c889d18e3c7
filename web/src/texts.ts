// Apart from language.ts, because a worker has texts too, but not their translation.

export type Values = Record<string, string | number>;

/** Returns a text with values in the places that are named after them. */
export const filled = (text: string, values: Values): string =>
  text.replace(/\{(\w+)\}/g, (place, name: string) => (Object.hasOwn(values, name) ? String(values[name]) : place));

/** Marks a text that is translated when it is shown, because the language may change until then. */
export const later = (text: string): string => text;
