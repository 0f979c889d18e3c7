import {signal} from '@preact/signals';
import {later} from '../language';
import type {Chart, Mark} from '../picture';
import type {Warning} from '../service';
import {choice} from '../words';

/** Units of the way around a round tube, and of the time that it takes. */
export type Axis = 'mm' | '°' | 's';

const angle = {name: 'φ', unit: '°'};
const length = {name: later('developed length'), unit: 'mm'};

/** The axes that a chart can have: of a turn of known length both measures, of a cut over time all. */
export const axesOf = ({turn, round}: Chart): Axis[] => (turn !== undefined ? ['mm', '°'] : round ? ['mm', '°', 's'] : []);

/** The axis of charts of which nobody has chosen one: time if they have it. */
export const usualAxis = (charts: Chart[]): Axis => (charts.some(({round}) => round) ? 's' : 'mm');

/** Values over one measure at the places that another measure has; both rise. */
function between(from: number[], to: number[]): (value: number) => number {
  return (value) => {
    const next = from.findIndex((each) => each >= value);
    if (next <= 0) return to[next < 0 ? to.length - 1 : 0] ?? value;
    const [a, b] = [from[next - 1] as number, from[next] as number];
    const share = b > a ? (value - a) / (b - a) : 1;
    return (to[next - 1] as number) + share * ((to[next] as number) - (to[next - 1] as number));
  };
}

/** The chart over another measure of the same turn. */
export function over(chart: Chart, axis: Axis): Chart {
  const {turn, round, x, period} = chart;
  if (!axesOf(chart).includes(axis) || x.unit === axis) return chart;
  const name = axis === '°' ? angle : length;
  if (round) {
    const values = round.phi.map((phi) => (axis === '°' ? phi : phi * round.perDegree));
    return {...moved(chart, between(x.values, values)), x: {...name, values}};
  }
  const scale = axis === '°' ? 360 / (turn as number) : (turn as number) / 360;
  const across = (value: number) => scale * value;
  return {...moved(chart, across), x: {...name, values: x.values.map(across)}, ...(period === undefined ? {} : {period: across(period)})};
}

/** Its bands and marks at other places. */
const moved = ({bands, marks, ...chart}: Chart, to: (value: number) => number): Chart => ({
  ...chart,
  ...(bands && {bands: bands.map((band) => ({...band, from: to(band.from), to: to(band.to)}))}),
  ...(marks && {marks: marks.map((mark) => ({...mark, x: to(mark.x)}))}),
});

const key = 'axis';
/** The axis that was chosen last, of all pages; without a storage nothing is remembered. */
export const chosenAxis = signal<Axis | undefined>(stored());
function stored(): Axis | undefined {
  try {
    const kept = localStorage.getItem(key);
    return (['mm', '°', 's'] as const).find((each) => each === kept);
  } catch {
    return undefined;
  }
}
export function chooseAxis(axis: Axis): void {
  chosenAxis.value = axis;
  try {
    localStorage.setItem(key, axis);
  } catch {
    /* not remembered */
  }
}

/** Where a warning says that it applies: on the way round, at an angle of a groove, or in periods. */
interface Span {
  of: 'phi' | 'girth' | 'omega' | 'period';
  from: number;
  to: number;
}
export function spanOf({detail}: Pick<Warning, 'detail'>): Span | undefined {
  const found = /\b(phi|girth|omega|periods?) (-?[\d.]+)(?: to (-?[\d.]+))?/.exec(detail);
  if (!found) return undefined;
  const [, of = '', from = '', to = from] = found;
  return {of: of.replace(/s$/, '') as Span['of'], from: Number(from), to: Number(to.replace(/\.$/, ''))};
}

/** The span in the chart's own measure, if it has the one that the warning is stated in. */
export function placedOn({x, turn, pace, period}: Chart, span: Span): [from: number, to: number] | undefined {
  const scaled = (scale: number): [number, number] => {
    const [from, to] = [scale * span.from, scale * span.to];
    const back = period !== undefined && from >= period ? period : 0; // beyond a whole turn
    return [from - back, to - back];
  };
  if (span.of === 'phi' && x.unit === '°' && x.name === angle.name) return scaled(1);
  if (span.of === 'phi' && turn !== undefined) return scaled(turn / 360);
  if (span.of === 'girth' && x.name === 'girth') return scaled(1);
  if (span.of === 'omega' && x.name === 'ω') return scaled(1);
  if (span.of === 'period' && pace !== undefined) return scaled(pace);
  return undefined;
}

/** Of a part, the charts of the end that the warning points at. */
const concerns = ({id}: Chart, {pointer}: Warning) => {
  const end = /^\/ends\/(start|finish)\b/.exec(pointer)?.[1];
  return end ? id.endsWith(`-${end}`) : !/-(start|finish)$/.test(id);
};

/** The chart that shows a warning, and the point of it that the warning begins at. */
export function shownAt(charts: Chart[], warning: Warning): {chart: Chart; index: number} | undefined {
  const span = spanOf(warning);
  for (const chart of span ? charts : []) {
    const place = concerns(chart, warning) ? placedOn(chart, span as Span) : undefined;
    if (!place) continue;
    const off = (value: number) => Math.abs(value - place[0]);
    const index = chart.x.values.reduce((best, value, i, all) => (off(value) < off(all[best] as number) ? i : best), 0);
    return {chart, index};
  }
  return undefined;
}

/** The charts with the warnings of the answer in them, each in the first chart that has its measure. */
export function warned(charts: Chart[], warnings: Warning[]): Chart[] {
  return warnings.reduce((all, warning) => {
    const chart = shownAt(all, warning)?.chart;
    const [from, to] = (chart && placedOn(chart, spanOf(warning) as Span)) ?? [];
    if (!chart || from === undefined || to === undefined) return all;
    const text = choice(warning.code);
    const close = (a: number, b: number) => Math.abs(a - b) < 0.002 * (chart.period ?? Math.abs(to));
    if (chart.bands?.some((band) => band.text === text || (close(band.from, from) && close(band.to, to)))) return all; // is there already
    const mark: Mark = {x: from, tone: 'bad', text};
    const more = to > from ? {bands: [...(chart.bands ?? []), {from, to, tone: 'bad', text}]} : {marks: [...(chart.marks ?? []), mark]};
    return all.map((each) => (each === chart ? {...chart, ...more} : each));
  }, charts);
}
