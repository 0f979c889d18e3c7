import {isRow, rowsOf, type Row} from '../json';
import {later, t} from '../language';
import {column, type Chart, type CutTube, type Picture, type Played, type Series, type Solid, type Table, type Tool, type Vector} from '../picture';
import type {Answer} from '../service';
import {shownUnit} from '../units';
import {choice, label, measured, number, term, type Term, withUnit} from '../words';
import {bevelTable, farEnd, joint} from './cut';
import {without, type Context} from './context';
import {figures, type Told} from './facts';
import {bounds, onTube, radians} from './geometry';
import {groove} from './groove';
import {coneTool} from './mill';

const link = 'motion';
const tones = ['series-0', 'series-1', 'series-2', 'series-3', 'series-4', 'series-5'];
const most = 3000; // points that a chart is drawn with; a schedule may have 400 000 periods
// periods up to which the torch's path is requested, because its answer is ten times as long
const replayed = 100000;
const mean = 25; // periods over which the rounding of pulses averages out

export async function schedule(body: Row, answer: Answer, context: Context): Promise<Picture> {
  const way = await wayOf(body, answer, context);
  const machine = machineOf(answer.request['machine'], context);
  const times = timesOf(answer.result);
  const solid = (await source(body, context)) ?? (way && !way.section ? contourSolid(way, answer.result) : undefined);
  return {
    ...(solid ? {solid: {...solid, link, ...toolOf(answer, machine, way, times)}} : {}),
    charts: scheduleCharts(answer, machine, way),
    ...motionFacts(answer, way),
    played: playedOf(answer.result, times),
  };
}

export const machineOf = (machine: unknown, context: Context) => (isRow(machine) ? machine : context.machines.get(String(machine)));

/** Returns the shape that is being cut, if the request contains it: shown next to the pulses. */
async function source(body: Row, context: Context): Promise<Solid | undefined> {
  for (const [key, endpoint, draw] of [
    ['cut', 'bevel-tables', bevelTable],
    ['mill_path', 'grooves', groove],
  ] as const) {
    const inner = body[key];
    if (!isRow(inner)) continue;
    const request = key === 'mill_path' && isRow(inner['groove']) ? inner['groove'] : inner;
    const answer = await context.ask(endpoint, without(request));
    return (await draw(request, answer, context)).solid;
  }
  return undefined;
}

/** The torch at the end of each period, with the first place before them: on both walls. */
export interface Way {
  outer: number; // radii
  inner: number;
  on: number; // surface of the speed
  phi: number[]; // degrees
  zOuter: number[];
  zInner: number[];
  b: number[];
  /** Of a tube that is not round: places of the tip and of the edge inside, in the tube's frame. */
  section?: {tip: Vector[]; edge: Vector[]; reach: number};
}

/** Returns the path of the pulses, by the service's own replay. */
export async function wayOf(body: Row, answer: Answer, context: Context): Promise<Way | undefined> {
  const {request, result} = answer;
  const [cut, contour] = [request['cut'], request['contour']];
  if ((!isRow(cut) && !isRow(contour)) || Number(result['periods']) > replayed) return undefined;
  const again = await context.ask('replays', {
    ...without(body, new Set(['reference', 'log', 'numerics', 'accept'])),
    schedule: Object.fromEntries(['period_us', 'counts', 'start'].map((key) => [key, result[key]])) as Row,
  });
  const path = again.result['path'] as Row;
  if ('normal_deg' in path) return sectionWay(path, cut as Row, request, context);
  const given = isRow(contour) ? contour : await targetOf(cut as Row, context);
  const outer = Number(given['outer_diameter_mm']) / 2;
  const inner = outer - Number(given['wall_mm']);
  const radius = given['surface'] === 'outer' ? outer : inner;
  const machine = machineOf(request['machine'], context) ?? {};
  const sigma = machine['b_positive'] === 'outer_edge_into_part' ? -1 : 1;
  const b = column(path['b_deg']);
  const z = column(path['z_mm']);
  const at = (r: number) => z.map((v, i) => v - sigma * (r - radius) * Math.tan((b[i] as number) * radians));
  const on = (request['motion'] as Row)['speed_on'] === 'inner' ? inner : outer;
  return {outer, inner, on, phi: column(path['phi_deg']), zOuter: at(outer), zInner: at(inner), b};
}

/** The path around a tube that is not round: the tip keeps to the normal of the wall outside. */
async function sectionWay(path: Row, cut: Row, request: Row, context: Context): Promise<Way> {
  const {result} = await context.ask('bevel-tables', without(cut));
  const section = result['section'] as Row;
  const [height, width, wall] = ['height_mm', 'width_mm', 'wall_mm'].map((key) => Number(section[key])) as [number, number, number];
  const machine = machineOf(request['machine'], context) ?? {};
  const sigma = machine['b_positive'] === 'outer_edge_into_part' ? -1 : 1;
  const [phi, x, y, zOuter, b] = ['normal_deg', 'x_mm', 'y_mm', 'z_mm', 'b_deg'].map((key) => column(path[key])) as [
    number[],
    number[],
    number[],
    number[],
    number[],
  ];
  const zInner = zOuter.map((z, i) => z + sigma * wall * Math.tan((b[i] as number) * radians));
  const tip = phi.map((_, i): Vector => [x[i] as number, y[i] as number, zOuter[i] as number]);
  const edge = tip.map(([u, v], i): Vector => {
    const [nx, ny] = onTube(wall, phi[i] as number, 0);
    return [u - nx, v - ny, zInner[i] as number];
  });
  const reach = Math.hypot(height, width) / 2;
  return {outer: reach, inner: reach - wall, on: reach, phi, zOuter, zInner, b, section: {tip, edge, reach}};
}

/** Returns diameter, wall and the root's surface of the target. */
async function targetOf(cut: Row, context: Context): Promise<Row> {
  const {outer, wall} = await joint(cut, context);
  return {outer_diameter_mm: outer, wall_mm: wall, surface: cut['root_surface'] ?? 'inner'};
}

/** The periods that charts are drawn at: of more than fit, the first and the middle one of each stretch. */
interface Times {
  every: number;
  period: number; // s
  periods: number[];
}
function timesOf(result: Row): Times {
  const counts = result['counts'] as Row;
  const total = column(counts[Object.keys(counts)[0] ?? '']).length;
  const every = total <= most ? 1 : 2 * Math.ceil(total / most);
  const step = Math.max(1, every / 2);
  return {every, period: Number(result['period_us']) * 1e-6, periods: Array.from({length: Math.ceil(total / step)}, (_, i) => i * step)};
}

/**
 * Returns the minimum and the maximum of each interval, in their order, so that no peak is lost.
 */
function extremes(values: number[], {every, periods}: Times): number[] {
  if (every === 1) return values;
  return periods.map((from, i) => {
    const start = i % 2 ? from - every / 2 : from;
    const stretch = values.slice(start, start + every);
    const [low, high] = bounds(stretch);
    const rising = stretch.indexOf(low) < stretch.indexOf(high);
    return (i % 2 === 0) === rising ? low : high;
  });
}

export function scheduleCharts(answer: Answer, machine: Row | undefined, way: Way | undefined): Chart[] {
  const {result, request} = answer;
  const counts = result['counts'] as Row;
  const times = timesOf(result);
  const {period, periods} = times;
  const axes = Object.keys(counts);
  const segments = rowsOf(result['segments']);
  // A part's events are too many for labels, so its rapids and strokes are bands.
  const marks = segments.length ? [] : rowsOf(result['events']).map((e) => ({x: Number(e['period']) * period, tone: 'mark', text: choice(e['what'])}));
  const bands = segments
    .filter((s) => s['kind'] === 'rapid' || s['kind'] === 'mark')
    .map((s) => ({
      from: Number(s['from']) * period,
      to: Number(s['to']) * period,
      ...(s['kind'] === 'mark' ? {tone: 'mark', text: t('marking')} : {tone: 'ink-soft', text: t('rapid')}),
    }));
  const each = (make: (pulses: number[], axis: string) => number[]): Series[] =>
    axes.map((axis, i) => ({name: axis, tone: tones[i % tones.length] as string, values: make(column(counts[axis]), axis)}));
  const shared = {
    link,
    x: {name: later('time'), unit: 's', values: periods.map((i) => i * period)},
    pace: period,
    unit: '',
    marks,
    bands,
    zero: true,
    ...roundOf(way, periods),
  };
  const charts: Chart[] = [{...shared, id: 'pulses', title: t('Pulses per period'), series: each((pulses) => extremes(pulses, times)), height: 210}];
  if (machine) {
    const of = (pulses: number[], axis: string) => extremes(shares(pulses, machine, axis, period), times);
    charts.unshift({
      ...shared,
      id: 'speed',
      title: t('Speed of each axis, fraction of its limit'),
      unit: '%',
      series: each(of),
      limits: [{y: 100, text: t('the limit of each axis')}],
      within: 100,
    });
  }
  if (way) charts.unshift(tipChart(shared, request, way, times, rowsOf((result['report'] as Row)['slow'])));
  const naive = (result['comparison'] as Row | undefined)?.['naive'] as Row | undefined;
  if (naive) charts.push(beforeChart(shared, naive, machine, axes, times));
  return [...charts, {...shared, id: 'positions', title: t('Pulses since the start'), series: each((pulses) => summed(pulses, periods)), height: 150}];
}

/** Of one cut round a tube: the angle at each point; none if the tube turns back meanwhile, or if the way round is no circle. */
function roundOf(way: Way | undefined, periods: number[]): Pick<Chart, 'round'> {
  if (!way || way.section) return {};
  const phi = periods.map((i) => way.phi[i + 1] ?? way.phi[i] ?? 0);
  const rises = phi.every((each, i) => i === 0 || each >= (phi[i - 1] as number)) && (phi[phi.length - 1] as number) > (phi[0] as number);
  return rises ? {round: {phi, perDegree: way.outer * radians}} : {};
}

/**
 * Returns the cut without a plan: the maximum that any segment requires, of the segments in an
 * interval of time.
 */
function beforeChart(
  shared: Omit<Chart, 'id' | 'title' | 'series' | 'height'>,
  naive: Row,
  machine: Row | undefined,
  axes: string[],
  {period, periods}: Times,
): Chart {
  const ends = column(naive['end_s']);
  const step = ((periods[1] ?? 1) - (periods[0] ?? 0)) * period;
  const most = (pulses: number[]) => {
    let k = 0;
    return periods.map((from) => {
      while (k < ends.length && (ends[k] as number) <= from * period) ++k;
      let found = 0;
      for (let i = k; i < ends.length && (i === 0 || (ends[i - 1] as number) < from * period + step); ++i) found = Math.max(found, pulses[i] as number);
      return found;
    });
  };
  const limits = new Set(axes.flatMap((axis) => (machine ? [Number(axisOf(machine, axis)['n_max'] ?? 0)] : [])).filter((value) => value > 0));
  return {
    ...shared,
    id: 'before',
    title: t('Before: pulses per period at constant speed'),
    marks: [],
    series: rowsOf(naive['axes'])
      .filter(({name}) => axes.includes(String(name)))
      .map(({name, pulses}, i) => ({name: String(name), tone: tones[i % tones.length] as string, values: most(column(pulses))})),
    limits: [...limits].map((y) => ({y, text: t('the capacity of a period')})),
    height: 210,
  };
}

const summed = (pulses: number[], periods: number[]) => {
  let [sum, k] = [0, 0];
  return periods.map((i) => {
    for (; k <= i; ++k) sum += pulses[k] as number;
    return sum;
  });
};

/** mm/min, over the last 25 periods. */
function tipSpeeds({on, outer, inner, phi, zOuter, zInner, section}: Way, period: number): number[] {
  const z = on === inner && on !== outer ? zInner : zOuter;
  const tip = section?.tip;
  const between = (from: number, to: number) => {
    if (!tip) return Math.hypot(on * radians * ((phi[to] as number) - (phi[from] as number)), (z[to] as number) - (z[from] as number));
    const [a, b] = [tip[from] as Vector, tip[to] as Vector];
    return Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  };
  return phi.slice(1).map((_, i) => {
    const to = i + 1;
    const from = Math.max(0, to - mean);
    return (60 * between(from, to)) / ((to - from) * period);
  });
}

function tipChart(shared: Omit<Chart, 'id' | 'title' | 'series'>, request: Row, way: Way, times: Times, slow: Row[]): Chart {
  const asked = Number(((request['motion'] as Row)['speed'] as Row)['mm_min'] ?? NaN);
  return {
    ...shared,
    id: 'tip',
    title: t('Speed of the cut'),
    unit: 'mm/min',
    height: 210,
    series: [
      {
        name: t('tip'),
        about: t('Mean of 25 periods, on the wall of the requested speed.'),
        values: extremes(tipSpeeds(way, times.period), times),
        tone: 'after',
        width: 2,
      },
    ],
    bands: slow.map((zone) => ({from: Number(zone['from']) * times.period, to: Number(zone['to']) * times.period, tone: 'bad', text: t('slow')})),
    ...(Number.isFinite(asked) ? {limits: [{y: asked, text: t('asked for')}], within: asked} : {}),
  };
}

const axisOf = (machine: Row, name: string) => rowsOf(machine['axes']).find((each) => each['name'] === name) ?? {};

/** Pulses to a millimetre or a degree. */
function perUnit(machine: Row, axis: string): number {
  const given = axisOf(machine, axis);
  return Number(given['pulses_per_unit'] ?? Number(given['pulses_per_turn']) / 360);
}

/** Returns pulses per period as speed in per cent of the axis' limit. */
const shares = (pulses: number[], machine: Row, axis: string, period: number) =>
  pulses.map((count) => (100 * Math.abs(count)) / perUnit(machine, axis) / period / Number(axisOf(machine, axis)['v_max']));

const playedOf = (result: Row, {every, period, periods}: Times): Played => ({
  link,
  seconds: periods.map((i) => i * period),
  events: rowsOf(result['events']).map((e) => ({
    at: Math.min(periods.length - 1, Math.round(Number(e['period']) / Math.max(1, every / 2))),
    text: [choice(e['what']), ...(e['cut'] ? [String(e['cut'])] : [])].join(' · '),
  })),
});

/** Returns the moving tool: the torch, or the mill by its axes. */
function toolOf({request, result}: Answer, machine: Row | undefined, way: Way | undefined, {periods}: Times): {tool?: Tool} {
  if (way?.section) {
    const {tip, edge, reach} = way.section;
    const of = <T>(values: T[]) => periods.map((i) => values[i + 1] as T);
    return {tool: {kind: 'torch', inner: of(edge), outer: of(tip), size: reach, turn: of(way.phi)}};
  }
  if (way) {
    const on = (radius: number, z: number[]) => periods.map((i) => onTube(radius, way.phi[i + 1] as number, z[i + 1] as number));
    return {tool: {kind: 'torch', inner: on(way.inner, way.zInner), outer: on(way.outer, way.zOuter), size: way.outer}};
  }
  if (!isRow(request['mill_path']) || !machine) return {};
  const axis = (name: string) => {
    const pulses = summed(column((result['counts'] as Row)[name]), periods);
    return periods.map((_, i) => Number((result['start'] as Row)[name]) + (pulses[i] ?? 0) / perUnit(machine, name));
  };
  const [c, x, z, b] = ['C', 'X', 'Z', 'B'].map(axis) as [number[], number[], number[], number[]];
  return {
    tool: coneTool(
      request['mill_path'],
      c.map((turn, i) => ({c: turn, x: x[i] as number, z: z[i] as number, b: b[i] as number})),
    ),
  };
}

/**
 * Returns a tube cut along the first turn of the torch's path, if no request contains more;
 * undefined for less than a turn.
 */
function contourSolid(way: Way, result: Row): Solid | undefined {
  const begin = Number(rowsOf(result['events']).find((e) => e['what'] === 'cut_start')?.['period'] ?? 0);
  const start = way.phi[begin] as number;
  const turned = (i: number) => Math.abs((way.phi[i] as number) - start);
  const step = Math.max(1, Math.ceil(way.phi.length / 2000));
  const turn = way.phi.flatMap((_, i) => (i >= begin && (i - begin) % step === 0 && turned(i) < 360 - 1e-6 ? [i] : []));
  if (turned(turn[turn.length - 1] as number) < 350) return undefined;
  const of = (values: number[]) => turn.map((i) => values[i] as number);
  const [zInner, zOuter] = [of(way.zInner), of(way.zOuter)];
  const [low, high] = bounds([...zInner, ...zOuter]);
  const cut: CutTube = {
    outer: way.outer,
    inner: way.inner,
    phi: of(way.phi),
    zInner,
    zOuter,
    far: farEnd(zInner, zOuter, 2 * way.outer),
    marks: [],
    tone: 'target',
  };
  const middle = (low + high) / 2;
  const size = Math.max(2.7 * way.outer, 0.8 * (high - low + 2 * way.outer));
  return {link, tubes: [cut], partners: [], centre: [0, 0, middle + 0.4 * way.outer], size, eye: [0.95, -0.75, -0.95], up: [0, 0, -1]};
}

export function motionFacts({result}: Answer, way?: Way): Told {
  const report = (result['report'] ?? {}) as Row;
  const use = (report['max_use'] ?? {}) as Record<string, number>;
  const what: Record<string, string> = {v: t('speed'), a: t('acceleration'), j: t('jerk'), n: t('pulses per period')};
  const axes = [...new Set(Object.keys(use).map((key) => key.slice(2)))];
  const names = ['time_s', 'ideal_s', 'length_mm', 'dev_tip_mm', 'dev_b_deg', 'sag_mm', 'min_tip_mm_min', 'slow_s'];
  const {period, periods} = timesOf(result);
  const counts = result['counts'] as Row;
  const speeds = way ? tipSpeeds(way, period) : [];
  const naive = (result['comparison'] as Row | undefined)?.['naive'] as Row | undefined;
  const unplanned = ['peak_pulses', 'periods_over', 'largest_step_pulses', 'step_in_16_bits'];
  return {
    figures: [...figures(report, names, 'report'), ...figures((result['times'] ?? {}) as Row, ['cut_s', 'pierce_s', 'rapid_s', 'mark_s'], 'times')],
    said: t('{time} for {length} of cut; {limits}.', {
      time: measured('time_s', Number(report['time_s'])),
      length: measured('length_mm', Number(report['length_mm'])),
      limits: limiting(use),
    }),
    tables: [
      {
        title: t('Use of the machine’s limits'),
        head: [t('axis'), ...Object.values(what)],
        rows: axes.map((axis) => [axis, ...Object.keys(what).map((key) => withUnit(100 * (use[`${key}_${axis}`] ?? 0), '%'))]),
      },
      ...(naive
        ? [
            {
              title: t('Before: every segment at the requested speed'),
              head: [t('axis'), ...unplanned.map((key) => term(key))],
              rows: rowsOf(naive['axes']).map((axis): (Term | string)[] => [String(axis['name']), ...unplanned.map((key) => String(axis[key] ?? '–'))]),
            },
          ]
        : []),
      rowsOf(result['segments']).length ? cutsOf(result, period) : eventsOf(result, period),
    ],
    readout: (i) => {
      const at = periods[i % periods.length] as number;
      return [
        [t('time'), withUnit(at * period, 's')],
        ...(way ? placeOf(way, at + 1, speeds[at] as number) : []),
        ...Object.keys(counts).map((axis): [Term, string] => [axis, withUnit(column(counts[axis])[at] ?? 0, 'pulses')]),
      ];
    },
  };
}

const eventsOf = (result: Row, period: number): Table => ({
  title: t('Events'),
  head: [term('period'), `${t('time')} s`, term('what')],
  rows: rowsOf(result['events']).map((e) => [String(e['period']), number(Number(e['period']) * period, 's'), choice(e['what'])]),
});

/**
 * Returns the steps of a part's program: each cut or stroke with the rapid and the pierce before
 * it.
 */
function cutsOf(result: Row, period: number): Table {
  const seconds = (segment: Row | undefined) => (segment ? number((Number(segment['to']) - Number(segment['from'])) * period, 's') : '–');
  const segments = rowsOf(result['segments']);
  const of = (i: number, kind: string) => [segments[i - 1], segments[i - 2]].find((s) => s?.['kind'] === kind && s['name'] === segments[i]?.['name']);
  return {
    title: t('Cuts in their order'),
    head: [term('cut'), ...[t('from'), t('rapid'), t('pierce'), t('cut')].map((each) => `${each} s`), `${t('length')} ${shownUnit('mm')}`],
    rows: segments.flatMap((s, i) =>
      s['kind'] === 'cut' || s['kind'] === 'mark'
        ? [
            [
              String(s['name']),
              number(Number(s['from']) * period, 's'),
              seconds(of(i, 'rapid')),
              seconds(of(i, 'pierce')),
              seconds(s),
              number(Number((s['report'] as Row)['length_mm']), 'mm'),
            ],
          ]
        : [],
    ),
  };
}

const placeOf = (way: Way, i: number, speed: number): [Term, string][] => [
  [t('speed of the cut'), withUnit(speed, 'mm/min')],
  [label(way.section ? 'normal_deg' : 'phi_deg'), withUnit(way.phi[i] as number, '°')],
  [t('z outside'), withUnit(way.zOuter[i] as number, 'mm')],
  [t('B of the machine'), withUnit(way.b[i] as number, '°')],
];

/** Which limits the motion runs at. */
function limiting(use: Record<string, number>): string {
  const axes = [...new Set(Object.entries(use).flatMap(([key, share]) => (share > 0.98 ? [key.slice(2)] : [])))];
  return axes.length ? t('at the limits of {axes}', {axes: axes.join(', ')}) : t('no axis at its limits');
}
