import type {Chart} from '../picture';
import {shownUnit, toShown} from '../units';

/** A chart in the units that are shown; the pictures themselves are made in those of the wire. */
export function inShownUnits(chart: Chart): Chart {
  const {x, unit, period, series, bands, marks, limits, within, wrap} = chart;
  if (shownUnit(unit) === unit && shownUnit(x.unit) === x.unit) return chart;
  const across = (value: number) => toShown(value, x.unit);
  const up = (value: number) => toShown(value, unit);
  return {
    ...chart,
    unit: shownUnit(unit),
    x: {...x, unit: shownUnit(x.unit), values: x.values.map(across)},
    series: series.map((each) => ({...each, values: each.values.map((value) => (value === null ? null : up(value)))})),
    ...(period === undefined ? {} : {period: across(period)}),
    ...(bands && {bands: bands.map((each) => ({...each, from: across(each.from), to: across(each.to)}))}),
    ...(marks && {marks: marks.map((each) => ({...each, x: across(each.x), ...(each.y === undefined ? {} : {y: up(each.y)})}))}),
    ...(limits && {limits: limits.map((each) => ({...each, y: up(each.y)}))}),
    ...(within === undefined ? {} : {within: up(within)}),
    ...(wrap && {wrap: {lines: wrap.lines.map((each) => ({...each, x: across(each.x)}))}}),
  };
}
