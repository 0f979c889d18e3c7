import {type Catalogued, type Nominal, nominals, sizeNamed} from './catalogue.js';
import {decimal} from './units.js';

/** A pipe by its outside diameter; `nps` if it is a nominal size, `wall_mm` if a map states it. */
export interface Bore {
  name: string;
  outer_diameter_mm: number;
  nps?: string;
  wall_mm?: number;
}

const close = (a: number, b: number): boolean => Math.abs(a - b) <= 1e-5 * Math.abs(b); // as files print the same number
const nominal = ({nps, outer_diameter_mm}: Nominal): Bore => ({name: `NPS ${nps}`, outer_diameter_mm, nps});
const found = (test: (each: Nominal) => boolean): Bore | undefined => {
  const row = nominals.find(test);
  return row && nominal(row);
};

/** The nominal size of a bore in inches (NPS) or in mm (DN). */
export const boreOf = (value: number, unit: 'INCH' | 'MM'): Bore | undefined => found(({inches, dn}) => close(value, unit === 'INCH' ? inches : dn));

/** Ways in which programs write bores, apart from the standard's. */
const conventions: {told: string; unit: 'INCH' | 'MM'; fits(value: number, each: Nominal): boolean}[] = [
  {told: 'NPS x 25.4', unit: 'MM', fits: (value, {inches}) => Math.abs(value - inches * 25.4) <= 0.06},
  {told: 'its outside diameter in mm', unit: 'MM', fits: (value, {outer_diameter_mm: outer}) => Math.abs(value - outer) <= 0.003 * outer},
  {told: 'NPS in inches', unit: 'MM', fits: (value, {inches}) => close(value, inches)},
  {told: 'DN', unit: 'MM', fits: (value, {dn}) => close(value, dn)},
  {told: 'its outside diameter in inches', unit: 'INCH', fits: (value, {outer_diameter_mm: outer}) => Math.abs(value * 25.4 - outer) <= 0.003 * outer},
  {told: 'DN', unit: 'INCH', fits: (value, {dn}) => close(value, dn)},
];

/** A bore that is not nominal in its unit, and its probable meanings, the most likely first. */
export interface Unrecognised {
  value: number;
  count: number;
  likely: {size: string; because: string}[];
}

/** Evaluates the bores of a file together: a meaning that explains more of them is more likely. */
export function unrecognised(counts: Map<number, number>, unit: 'INCH' | 'MM'): Unrecognised[] {
  const values = [...counts.keys()];
  const odd = values.filter((value) => !boreOf(value, unit));
  const ways = conventions
    .filter((way) => way.unit === unit)
    .map((way) => ({...way, explains: values.filter((value) => nominals.some((each) => way.fits(value, each))).length}))
    .sort((a, b) => b.explains - a.explains);
  // If one other way explains every bore, those that look nominal may be meant so as well: 6 and 4 of a file in mm.
  // And if every bore is a DN and an NPS, and one is below DN 15: 6 is more often 6 in than DN 6.
  const small = unit === 'MM' && values.some((value) => value < 15) && values.every((value) => boreOf(value, 'INCH'));
  const all = small || (odd.length > 0 && ways[0]?.explains === values.length) ? values : odd;
  return all.map((value) => {
    const sizes = ways.flatMap(({told, fits}) => nominals.filter((each) => fits(value, each)).map(({nps}) => ({size: `NPS ${nps}`, because: told})));
    const likely = sizes.filter(({size}, i) => sizes.findIndex((each) => each.size === size) === i);
    return {value, count: counts.get(value) ?? 0, likely};
  });
}

const listed = ({name, outer_diameter_mm, wall_mm}: Catalogued): Bore => ({name, outer_diameter_mm, wall_mm});

/**
 * Returns the bore of a map's text: "NPS 6", "DN 150", "168.3" (outside diameter in mm),
 * "168.3x7.11" or a listed size.
 */
export function boreSaid(said: string): Bore | undefined {
  const text = said.trim().slice(0, 64);
  const size = sizeNamed(text);
  if (size) return {...listed(size), ...(/^NPS (\S+)/.test(size.name) ? {nps: size.name.split(' ')[1] as string} : {})};
  const nps = /^(?:NPS|DN)\s*(\S+)$/i.exec(text)?.[1];
  if (nps !== undefined) return /^DN/i.test(text) ? boreOf(decimal(nps), 'MM') : found((each) => each.nps === nps || each.inches === decimal(nps));
  const [outer, wall, ...rest] = text.split(/[x×]/i).map((each) => decimal(each.trim()));
  if (outer === undefined || !(outer > 0) || rest.length > 0) return undefined;
  const known = found((each) => close(outer, each.outer_diameter_mm));
  const bore = {name: `${outer} mm`, ...known, outer_diameter_mm: outer};
  if (wall === undefined) return bore;
  return wall > 0 && wall < outer / 2 ? {...bore, wall_mm: wall} : undefined;
}

/** A map of bores, by their numbers. */
export function boreMap(said: Record<string, string>): Map<number, Bore> {
  return new Map(
    Object.entries(said).map(([key, value]) => {
      const bore = boreSaid(value);
      if (!Number.isFinite(decimal(key))) throw new Error(`${key} is not a bore`);
      if (!bore) throw new Error(`${value} is not a size of pipe: state "NPS 6", "DN 150", "168.3" (outside diameter in mm) or "168.3x7.11"`);
      return [decimal(key), bore];
    }),
  );
}

export const mapped = (map: Map<number, Bore>, value: number): Bore | undefined => [...map].find(([key]) => close(value, key))?.[1];

/** Every nominal size, for whoever holds this table against another. */
export const bores: readonly {nps: string; outer_diameter_mm: number}[] = nominals.map(({nps, outer_diameter_mm}) => ({nps, outer_diameter_mm}));
