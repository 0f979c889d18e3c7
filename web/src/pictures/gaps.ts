import type {Row} from '../json';
import {t} from '../language';
import {number, withUnit} from '../words';
import {column, type Chart, type Gaps, type Picture} from '../picture';

/** Returns, for an end that is cut square, the remaining gaps at its two edges. */
export function gapsOf(points: Row): Gaps | undefined {
  if (!points['gap_outer_mm']) return undefined;
  const [inner, outer] = [column(points['gap_inner_mm']), column(points['gap_outer_mm'])];
  return {inner, outer, most: [...inner, ...outer].reduce((a, b) => Math.max(a, b), 0)};
}

export const gapScale = (most: number): [string, string] => [t('gap 0'), withUnit(most, 'mm')];

const overPhi = (points: Row) => ({x: {name: 'φ', unit: '°', values: column(points['phi_deg'])}, period: 360});

/** The gap of the square cut over phi, or what else is the way round, and of the same end with a bevel. */
export function gapChart(
  points: Row,
  shared: Pick<Chart, 'link' | 'partners' | 'partnerNames' | 'turn'>,
  over: Pick<Chart, 'x' | 'period' | 'bands' | 'marks'> = overPhi(points),
): Chart {
  const of = (name: string) => column(points[name]);
  return {
    ...shared,
    id: 'gap',
    title: t('Gap to the partner'),
    unit: 'mm',
    ...over,
    height: 205,
    zero: true,
    series: [
      {name: t('outside'), values: of('gap_outer_mm'), tone: 'after', width: 2.2},
      {name: t('inside'), values: of('gap_inner_mm'), tone: 'inner', width: 1.5},
      {name: t('outside with a bevel'), values: of('bevelled_gap_outer_mm'), tone: 'floor', dash: [5, 4]},
      {name: t('inside with a bevel'), values: of('bevelled_gap_inner_mm'), tone: 'before', dash: [2, 3]},
    ],
  };
}

/** Returns the figures that a laser shop needs for an end. */
export function gapFigures(result: Row): Picture['figures'] {
  const laser = result['tube_laser'] as Row;
  const greatest = (name: string) => number(Number((laser[name] as Row)['greatest_mm']), 'mm');
  const tongue = laser['tongue'] as Row | undefined;
  return [
    {name: t('greatest gap'), value: greatest('gap'), unit: 'mm'},
    {name: t('with a bevel'), value: greatest('bevelled_gap'), unit: 'mm'},
    {name: t('reach of the cut'), value: number(Number(laser['reach_mm']), 'mm'), unit: 'mm'},
    ...(tongue ? [{name: t('narrowest tongue'), value: number(Number(tongue['width_mm']), 'mm'), unit: 'mm'}] : []),
    {name: t('cut length'), value: number(Number(result['length_mm']), 'mm'), unit: 'mm'},
  ];
}

/** And of a part, of its ends and between them. */
export function webFigures(result: Row): Picture['figures'] {
  const laser = result['tube_laser'] as Row | undefined;
  const ends = Object.values(result['ends'] as Row).flatMap((end) => ((end as Row)['tube_laser'] as Row | undefined)?.['gap'] ?? []);
  const gap = ends.reduce<number>((most, each) => Math.max(most, Number((each as Row)['greatest_mm'])), 0);
  const of = (name: string, key: string, text: string) => {
    const found = laser?.[name] as Row | undefined;
    return found ? [{name: text, value: number(Number(found[key]), 'mm'), unit: 'mm'}] : [];
  };
  return [
    ...(ends.length ? [{name: t('greatest gap'), value: number(gap, 'mm'), unit: 'mm'}] : []),
    ...of('web', 'width_mm', t('narrowest web')),
    ...of('hole_to_end', 'width_mm', t('hole to end')),
    ...of('seam_to_hole', 'girth_mm', t('seam to hole')),
  ];
}
