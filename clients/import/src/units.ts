/** mm of a unit of length, by the names that options use. */
export const lengths = {mm: 1, cm: 10, m: 1000, in: 25.4, ft: 304.8} as const;
export type LengthUnit = keyof typeof lengths;

const longest = 64; // characters of a number: longer texts are not numbers

/** A decimal number with a point, or NaN. Linear in the text. */
export const decimal = (text: string | undefined): number =>
  text !== undefined && text.length <= longest && /^[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?$/.test(text) ? Number(text) : Number.NaN;
