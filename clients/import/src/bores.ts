/** Nominal sizes with their outside diameters in mm: ASME B36.10M-2018 (table 1, SI), DN by ISO 6708. Walls are the service's: GET /v1/tubes. */
const rows: [nps: string, inches: number, dn: number, outer_diameter_mm: number][] = [
  ['1/2', 0.5, 15, 21.3],
  ['3/4', 0.75, 20, 26.7],
  ['1', 1, 25, 33.4],
  ['1-1/4', 1.25, 32, 42.2],
  ['1-1/2', 1.5, 40, 48.3],
  ['2', 2, 50, 60.3],
  ['2-1/2', 2.5, 65, 73],
  ['3', 3, 80, 88.9],
  ['3-1/2', 3.5, 90, 101.6],
  ['4', 4, 100, 114.3],
  ['5', 5, 125, 141.3],
  ['6', 6, 150, 168.3],
  ['8', 8, 200, 219.1],
  ['10', 10, 250, 273],
  ['12', 12, 300, 323.8],
  ['14', 14, 350, 355.6],
  ['16', 16, 400, 406.4],
  ['18', 18, 450, 457],
  ['20', 20, 500, 508],
  ['24', 24, 600, 610],
];

export interface Bore {
  nps: string;
  outer_diameter_mm: number;
}

/** The nominal size of a bore in inches or in mm (DN); none where there is no such. */
export function boreOf(value: number, unit: 'INCH' | 'MM'): Bore | undefined {
  const row = rows.find(([, inches, dn]) => (unit === 'INCH' ? inches : dn) === value);
  return row && {nps: row[0], outer_diameter_mm: row[3]};
}

/** Every nominal size, for whoever holds this table against another. */
export const bores: readonly Bore[] = rows.map(([nps, , , outer_diameter_mm]) => ({nps, outer_diameter_mm}));
