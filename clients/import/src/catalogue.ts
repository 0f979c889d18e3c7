/**
 * The sizes that GET /v1/tubes lists, so that an import needs no service: a test compares the two. ASME B36.10M-2018 (table 1, SI
 * columns, DN by ISO 6708), then EN 10210-2:2006 and what EN 10219-2:2006 and EN 10255:2004 add to it. Names of one wall are joined by "=".
 */
const pipes: [nps: string, dn: number, outer_diameter_mm: number, walls: string][] = [
  ['1/8', 6, 10.3, 'SCH 40=STD 1.73, SCH 80=XS 2.41'],
  ['1/4', 8, 13.7, 'SCH 40=STD 2.24, SCH 80=XS 3.02'],
  ['3/8', 10, 17.1, 'SCH 40=STD 2.31, SCH 80=XS 3.2'],
  ['1/2', 15, 21.3, 'SCH 40=STD 2.77, SCH 80=XS 3.73, SCH 160 4.78, XXS 7.47'],
  ['3/4', 20, 26.7, 'SCH 40=STD 2.87, SCH 80=XS 3.91, SCH 160 5.56, XXS 7.82'],
  ['1', 25, 33.4, 'SCH 40=STD 3.38, SCH 80=XS 4.55, SCH 160 6.35, XXS 9.09'],
  ['1-1/4', 32, 42.2, 'SCH 40=STD 3.56, SCH 80=XS 4.85, SCH 160 6.35, XXS 9.7'],
  ['1-1/2', 40, 48.3, 'SCH 40=STD 3.68, SCH 80=XS 5.08, SCH 160 7.14'],
  ['2', 50, 60.3, 'SCH 40=STD 3.91, SCH 80=XS 5.54, SCH 160 8.74, XXS 11.07'],
  ['2-1/2', 65, 73, 'SCH 40=STD 5.16, SCH 80=XS 7.01, SCH 160 9.53, XXS 14.02'],
  ['3', 80, 88.9, 'SCH 40=STD 5.49, SCH 80=XS 7.62, SCH 160 11.13, XXS 15.24'],
  ['3-1/2', 90, 101.6, 'SCH 40=STD 5.74, SCH 80=XS 8.08'],
  ['4', 100, 114.3, 'SCH 40=STD 6.02, SCH 80=XS 8.56, SCH 120 11.13, SCH 160 13.49, XXS 17.12'],
  ['5', 125, 141.3, 'SCH 40=STD 6.55, SCH 80=XS 9.53, SCH 120 12.7, SCH 160 15.88, XXS 19.05'],
  ['6', 150, 168.3, 'SCH 40=STD 7.11, SCH 80=XS 10.97, SCH 120 14.27, SCH 160 18.26, XXS 21.95'],
  [
    '8',
    200,
    219.1,
    'SCH 20 6.35, SCH 30 7.04, SCH 40=STD 8.18, SCH 60 10.31, SCH 80=XS 12.7, SCH 100 15.09, SCH 120 18.26, SCH 140 20.62, XXS 22.23, SCH 160 23.01',
  ],
  ['10', 250, 273, 'SCH 20 6.35, SCH 30 7.8, SCH 40=STD 9.27, SCH 60=XS 12.7, SCH 80 15.09, SCH 100 18.26, SCH 120 21.44, SCH 140 25.4, SCH 160 28.58'],
  [
    '12',
    300,
    323.8,
    'SCH 20 6.35, SCH 30 8.38, STD 9.53, SCH 40 10.31, XS 12.7, SCH 60 14.27, SCH 80 17.48, SCH 100 21.44, SCH 120 25.4, SCH 140 28.58, SCH 160 33.32',
  ],
  [
    '14',
    350,
    355.6,
    'SCH 10 6.35, SCH 20 7.92, SCH 30=STD 9.53, SCH 40 11.13, XS 12.7, SCH 60 15.09, SCH 80 19.05, SCH 100 23.83, SCH 120 27.79, SCH 140 31.75, SCH 160 35.71',
  ],
  [
    '16',
    400,
    406.4,
    'SCH 10 6.35, SCH 20 7.92, SCH 30=STD 9.53, SCH 40=XS 12.7, SCH 60 16.66, SCH 80 21.44, SCH 100 26.19, SCH 120 30.96, SCH 140 36.53, SCH 160 40.49',
  ],
  [
    '18',
    450,
    457,
    'SCH 10 6.35, SCH 20 7.92, STD 9.53, SCH 30 11.13, XS 12.7, SCH 40 14.27, SCH 60 19.05, SCH 80 23.83, SCH 100 29.36, SCH 120 34.93, SCH 140 39.67, SCH 160 45.24',
  ],
  [
    '20',
    500,
    508,
    'SCH 10 6.35, SCH 20=STD 9.53, SCH 30=XS 12.7, SCH 40 15.09, SCH 60 20.62, SCH 80 26.19, SCH 100 32.54, SCH 120 38.1, SCH 140 44.45, SCH 160 50.01',
  ],
  ['22', 550, 559, 'STD 9.53, XS 12.7'],
  [
    '24',
    600,
    610,
    'SCH 10 6.35, SCH 20=STD 9.53, XS 12.7, SCH 30 14.27, SCH 40 17.48, SCH 60 24.61, SCH 80 30.96, SCH 100 38.89, SCH 120 46.02, SCH 140 52.37, SCH 160 59.54',
  ],
  ['26', 650, 660, 'STD 9.53, XS 12.7'],
  ['28', 700, 711, 'STD 9.53, XS 12.7'],
  ['30', 750, 762, 'STD 9.53, XS 12.7'],
  ['32', 800, 813, 'STD 9.53, XS 12.7'],
  ['34', 850, 864, 'STD 9.53, XS 12.7'],
  ['36', 900, 914, 'STD 9.53, XS 12.7'],
  ['38', 950, 965, 'STD 9.53, XS 12.7'],
  ['40', 1000, 1016, 'STD 9.53, XS 12.7'],
  ['42', 1050, 1067, 'STD 9.53, XS 12.7'],
  ['44', 1100, 1118, 'STD 9.53, XS 12.7'],
  ['46', 1150, 1168, 'STD 9.53, XS 12.7'],
  ['48', 1200, 1219, 'STD 9.53, XS 12.7'],
];
const hollows: [outer_diameter_mm: number, walls: string][] = [
  [21.3, '2.3 2.6 3.2'],
  [26.9, '2.3 2.6 3.2'],
  [33.7, '2.6 3.2 4'],
  [42.4, '2.6 3.2 4'],
  [48.3, '2.6 3.2 4 5'],
  [60.3, '2.6 3.2 4 5'],
  [76.1, '2.6 3.2 4 5'],
  [88.9, '3.2 4 5 6.3'],
  [101.6, '3.2 4 5 6.3 8 10'],
  [114.3, '3.2 4 5 6.3 8 10'],
  [139.7, '4 5 6.3 8 10 12.5'],
  [168.3, '4 5 6.3 8 10 12.5'],
  [177.8, '5 6.3 8 10 12.5'],
  [193.7, '5 6.3 8 10 12.5 16'],
  [219.1, '5 6.3 8 10 12.5 16 20'],
  [244.5, '5 6.3 8 10 12.5 16 20 25'],
  [273, '5 6.3 8 10 12.5 16 20 25'],
  [323.9, '5 6.3 8 10 12.5 16 20 25'],
  [355.6, '6.3 8 10 12.5 16 20 25'],
  [406.4, '6.3 8 10 12.5 16 20 25 30 40'],
  [457, '6.3 8 10 12.5 16 20 25 30 40'],
  [508, '6.3 8 10 12.5 16 20 25 30 40 50'],
  [610, '6.3 8 10 12.5 16 20 25 30 40 50'],
  [711, '6.3 8 10 12.5 16 20 25 30 40 50 60'],
  // EN 10219-2
  [21.3, '2 2.5 3'],
  [26.9, '2 2.5 3'],
  [33.7, '2 2.5 3'],
  [42.4, '2 2.5 3'],
  [48.3, '2 2.5 3'],
  [60.3, '2 2.5 3'],
  [76.1, '2 2.5 3'],
  [88.9, '2 2.5 3'],
  [101.6, '2.5 3'],
  [114.3, '2.5 3'],
  [139.7, '3'],
  [168.3, '3'],
  // EN 10255
  [60.3, '3.6 4.5'],
  [76.1, '3.6 4.5'],
  [114.3, '4.5 5.4'],
  [139.7, '5.4'],
  [165.1, '5 5.4'],
];

export interface Catalogued {
  name: string;
  outer_diameter_mm: number;
  wall_mm: number;
}

/** A nominal size: NPS in inches, DN in mm. */
export interface Nominal {
  nps: string;
  inches: number;
  dn: number;
  outer_diameter_mm: number;
}

/** "1-1/2" as 1.5. */
function inchesOf(nps: string): number {
  const [whole, part] = nps.includes('/') ? (nps.includes('-') ? nps.split('-') : ['0', nps]) : [nps, '0/1'];
  const [over, under] = (part as string).split('/').map(Number) as [number, number];
  return Number(whole) + over / under;
}

export const nominals: readonly Nominal[] = pipes.map(([nps, dn, outer_diameter_mm]) => ({nps, inches: inchesOf(nps), dn, outer_diameter_mm}));

export const catalogue: readonly Catalogued[] = [
  ...pipes.flatMap(([nps, , outer_diameter_mm, walls]) =>
    walls.split(', ').flatMap((each) => {
      const at = each.lastIndexOf(' ');
      const names = each.slice(0, at).split('=');
      return names.map((schedule) => ({name: `NPS ${nps} ${schedule}`, outer_diameter_mm, wall_mm: Number(each.slice(at + 1))}));
    }),
  ),
  ...hollows.flatMap(([outer, walls]) => walls.split(' ').map((wall) => ({name: `CHS ${outer}x${wall}`, outer_diameter_mm: outer, wall_mm: Number(wall)}))),
];

const byName = new Map(catalogue.map((each) => [each.name, each]));

/** The size of that name; upper and lower case and the number of spaces do not matter. */
export const sizeNamed = (name: string): Catalogued | undefined =>
  byName.get(name) ??
  byName.get(
    name
      .trim()
      .replace(/\s+/g, ' ')
      .toUpperCase()
      .replace(/(\d)X(\d)/, '$1x$2'),
  );

const same = 1e-4; // mm: less than any two listed sizes differ by

/** The first listed size with these measures. */
export const sizeMeasuring = (outer: number, wall: number): Catalogued | undefined =>
  catalogue.find((each) => Math.abs(each.outer_diameter_mm - outer) <= same && Math.abs(each.wall_mm - wall) <= same);
