// The axes of charts: two measures of one turn, and the places of warnings.
import {strict as assert} from 'node:assert';
import {test} from 'node:test';
import {load} from './load.mjs';

const {axesOf, over, shownAt, spanOf, usualAxis, warned} = await load('src/pictures/axis.ts');
const turn = 720;
const chart = (id, more = {}) => ({
  id, title: id, link: 'cut', unit: 'mm', x: {name: 'φ', unit: '°', values: [0, 90, 180, 270]}, period: 360, turn,
  series: [{name: 'z', values: [1, 2, 3, 4], tone: 'after'}], marks: [{x: 45, tone: 'mark', text: 'junction'}], bands: [{from: 90, to: 180, tone: 'bad', text: 'slow'}], ...more,
});
const warning = (detail, more = {}) => ({code: 'torch_range_binds', severity: 'cut', pointer: '/torch', detail, action: '', ...more});

test('a turn is measured by its length or its angle, there and back', () => {
  const given = chart('height');
  assert.deepEqual(axesOf(given), ['mm', '°']);
  assert.deepEqual(axesOf(chart('wrap', {turn: undefined})), []);
  const long = over(given, 'mm');
  assert.deepEqual([long.x.name, long.x.unit, long.x.values, long.period], ['developed length', 'mm', [0, 180, 360, 540], 720]);
  assert.deepEqual([long.marks[0].x, long.bands[0].from, long.bands[0].to], [90, 180, 360]);
  assert.deepEqual(over(long, '°'), given);
  assert.equal(over(given, '°'), given);
  assert.deepEqual(long.series, given.series);
});

test('a cut over time is also over its angle and its length, where it never turns back', () => {
  const timed = chart('tip', {x: {name: 'time', unit: 's', values: [0, 1, 2, 3]}, period: undefined, turn: undefined, pace: 0.004, round: {phi: [10, 10, 190, 370], perDegree: 2},
    marks: [{x: 1.5, tone: 'mark', text: 'turn'}, {x: 9, tone: 'mark', text: 'later'}], bands: [{from: 0, to: 3, tone: 'bad', text: 'slow'}]});
  assert.deepEqual([axesOf(timed), usualAxis([timed]), usualAxis([chart('height')])], [['mm', '°', 's'], 's', 'mm']);
  const angle = over(timed, '°');
  assert.deepEqual([angle.x.name, angle.x.unit, angle.x.values], ['φ', '°', [10, 10, 190, 370]]);
  assert.deepEqual([angle.marks.map(({x}) => x), angle.bands[0].from, angle.bands[0].to], [[100, 370], 10, 370]);
  assert.deepEqual(over(timed, 'mm').x.values, [20, 20, 380, 740]);
  assert.equal(over(timed, 's'), timed);
  const turned = chart('height');
  assert.equal(over(turned, 's'), turned, 'a turn without a speed has no time');
});

test('a warning lies where its text says, in the measure of the chart', () => {
  assert.deepEqual(spanOf(warning('girth 264.492 to 348.039 mm, up to 7.5 deg of groove lost')), {of: 'girth', from: 264.492, to: 348.039});
  assert.deepEqual(spanOf(warning('by up to 2.17 mm, at phi 158.21 deg')), {of: 'phi', from: 158.21, to: 158.21});
  assert.deepEqual(spanOf(warning('periods 341 to 471: down to 72.7 mm/min')), {of: 'period', from: 341, to: 471});
  assert.equal(spanOf(warning('cut by leg up to 79.3 mm beyond')), undefined);
  for (const [axis, from, to] of [['°', 100, 140], ['mm', 200, 280]]) {
    const [found] = warned([over(chart('bevel'), axis)], [warning('phi 100 to 140 deg, up to 5 deg lost')]);
    assert.deepEqual(found.bands.at(-1), {from, to, tone: 'bad', text: 'torch range binds'}, axis);
  }
  const pulses = chart('tip', {x: {name: 'time', unit: 's', values: [0, 1, 2]}, period: undefined, turn: undefined, pace: 0.004});
  assert.deepEqual(warned([pulses], [warning('periods 250 to 500: slow', {code: 'slow_zone'})])[0].bands.at(-1), {from: 1, to: 2, tone: 'bad', text: 'slow zone'});
});

test('a warning is shown once, in the first chart that can, of the end that it points at', () => {
  const charts = ['bevel-start', 'bevel-finish'].map((id) => chart(id));
  const of = (end) => warning('phi 180 to 200 deg', {pointer: `/ends/${end}/torch`});
  const {chart: shown, index} = shownAt(charts, of('finish'));
  assert.deepEqual([shown.id, index], ['bevel-finish', 2]);
  const both = warned(charts, [of('start'), of('start')]);
  assert.deepEqual(both.map(({bands}) => bands.length), [2, 1]);
  assert.equal(shownAt(charts, warning('phi 180 deg')), undefined, 'which end is not known');
  assert.deepEqual(warned([chart('bevel')], [warning('nowhere')]), [chart('bevel')]);
});
