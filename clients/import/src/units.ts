/** mm of a unit of length, by the names that options use. */
export const lengths = {mm: 1, cm: 10, m: 1000, in: 25.4, ft: 304.8} as const;
export type LengthUnit = keyof typeof lengths;
