import {isRow, type Row} from '../json';
import {column, type Chart, type Picture, type Series} from '../picture';
import type {Answer} from '../service';
import {measured, number, powers, residual, spelled, unit, withUnit} from '../units';
import {about, check, choice, label, term} from '../words';
import {bevelTable} from './cut';
import {groove} from './groove';
import {without, type Context} from './context';
import {at, facts, figure, figures, text, type Told} from './facts';

const tones = ['series-0', 'series-1', 'series-2', 'series-3', 'series-4', 'series-5'];
const most = 3000; // points that a chart is drawn with; a schedule may have 400 000 periods

export async function schedule(body: Row, answer: Answer, context: Context): Promise<Picture> {
  const picture = await source(body, context);
  const machine = answer.request['machine'];
  const charts = scheduleCharts(answer.result, isRow(machine) ? machine : context.machines.get(String(machine)));
  return {...(picture?.solid ? {solid: picture.solid} : {}), charts, ...motionFacts(answer.result)};
}

/** What is being cut, where the request tells: shown beside the pulses. */
async function source(body: Row, context: Context): Promise<Picture | undefined> {
  for (const [key, endpoint, draw] of [
    ['cut', 'bevel-tables', bevelTable],
    ['mill_path', 'grooves', groove],
  ] as const) {
    const inner = body[key];
    if (!isRow(inner)) continue;
    const request = key === 'mill_path' && isRow(inner['groove']) ? inner['groove'] : inner;
    const answer = await context.ask(endpoint, without(request));
    return draw(request, answer, context);
  }
  return undefined;
}

export function scheduleCharts(result: Row, machine: Row | undefined): Chart[] {
  const counts = result['counts'] as Row;
  const period = Number(result['period_us']) * 1e-6;
  const axes = Object.keys(counts);
  const total = column(counts[axes[0] ?? '']).length;
  const every = Math.max(1, Math.ceil(total / most));
  const indices = Array.from({length: Math.ceil(total / every)}, (_, i) => i * every);
  const seconds = {name: 'time', unit: 's', values: indices.map((i) => i * period)};
  const events = ((result['events'] ?? []) as Row[]).map((e) => ({x: Number(e['period']) * period, tone: 'mark', text: choice(e['what'])}));
  const each = (make: (pulses: number[]) => (number | null)[]): Series[] =>
    axes.map((axis, i) => ({name: axis, tone: tones[i % tones.length] as string, values: make(column(counts[axis]))}));
  const mean = (pulses: number[]) =>
    indices.map((i) => {
      let sum = 0;
      const end = Math.min(i + every, pulses.length);
      for (let k = i; k < end; ++k) sum += pulses[k] as number;
      return sum / (end - i);
    });
  const position = (pulses: number[]) => {
    let sum = 0,
      k = 0;
    return indices.map((i) => {
      for (; k <= i; ++k) sum += pulses[k] as number;
      return sum;
    });
  };
  const shared = {link: 'motion', x: seconds, unit: ''};
  return [
    {
      ...shared,
      id: 'pulses',
      title: every > 1 ? `Pulses per period, mean of ${every}` : 'Pulses per period',
      series: each(mean),
      marks: events,
      height: 230,
      zero: true,
    },
    ...(machine
      ? [
          {
            ...shared,
            id: 'speed',
            title: 'Speed, share of each axis’s limit',
            unit: '%',
            marks: events,
            zero: true,
            series: axes.map((axis, i) => ({
              name: axis,
              tone: tones[i % tones.length] as string,
              values: shares(mean(column(counts[axis])), machine, axis, period),
            })),
          },
        ]
      : []),
    {...shared, id: 'positions', title: 'Pulses since the start', series: each(position), marks: events, zero: true, height: 150},
  ];
}

/** Pulses per period as speed in per cent of what the axis may do. */
function shares(pulses: number[], machine: Row, axis: string, period: number): number[] {
  const given = ((machine['axes'] ?? []) as Row[]).find((each) => each['name'] === axis) ?? {};
  const perUnit = Number(given['pulses_per_unit'] ?? Number(given['pulses_per_turn']) / 360);
  return pulses.map((count) => (100 * Math.abs(count)) / perUnit / period / Number(given['v_max']));
}

export function motionFacts(result: Row): Told {
  const report = (result['report'] ?? {}) as Row;
  const use = (report['max_use'] ?? {}) as Record<string, number>;
  const what: Record<string, string> = {v: 'speed', a: 'acceleration', j: 'jerk', n: 'pulses per period'};
  const axes = [...new Set(Object.keys(use).map((key) => key.slice(2)))];
  const names = ['time_s', 'ideal_s', 'length_mm', 'dev_tip_mm', 'dev_b_deg', 'sag_mm', 'min_tip_mm_min', 'slow_s'];
  const period = Number(result['period_us']) * 1e-6;
  const counts = result['counts'] as Row;
  const total = column(counts[Object.keys(counts)[0] ?? '']).length;
  const every = Math.max(1, Math.ceil(total / most));
  return {
    figures: figures(report, names, 'report'),
    said: `${measured('time_s', Number(report['time_s']))} for ${measured('length_mm', Number(report['length_mm']))} of cut; ${limiting(use)}.`,
    tables: [
      {
        title: 'Use of the machine’s limits',
        head: ['axis', ...Object.values(what)],
        rows: axes.map((axis) => [axis, ...Object.keys(what).map((key) => withUnit(100 * (use[`${key}_${axis}`] ?? 0), '%'))]),
      },
      {
        title: 'Events',
        head: [term('period'), 'time s', term('what')],
        rows: ((result['events'] ?? []) as Row[]).map((e) => [String(e['period']), number(Number(e['period']) * period, 's'), choice(e['what'])]),
      },
    ],
    readout: (i) => [
      ['time', withUnit(i * every * period, 's')],
      ...Object.keys(counts).map((axis): [string, string] => [axis, `${column(counts[axis])[i * every] ?? 0} pulses`]),
    ],
  };
}

/** Which limits the motion runs at. */
function limiting(use: Record<string, number>): string {
  const axes = [...new Set(Object.entries(use).flatMap(([key, share]) => (share > 0.98 ? [key.slice(2)] : [])))];
  return axes.length ? `at the limits of ${axes.join(', ')}` : 'no axis at its limits';
}

export async function replay(_: Row, answer: Answer): Promise<Picture> {
  const {result} = answer;
  const path = result['path'] as Row;
  const z = column(path['z_mm']);
  const every = Math.max(1, Math.ceil(z.length / most));
  const thin = (values: number[]) => values.filter((_v, i) => i % every === 0);
  const x = {name: 'period', unit: '', values: thin(z.map((_v, i) => i))};
  const one = (id: string, title: string, name: string, tone: string): Chart[] =>
    name in path
      ? [{id, title, link: 'replay', unit: unit(name), x, series: [{name: label(name), about: about(name), values: thin(column(path[name])), tone, width: 2}]}]
      : [];
  const invariants = result['invariants'] as Row[];
  return {
    charts: [
      ...one('z', 'z of the torch', 'z_mm', 'outer'),
      ...one('b', 'B of the torch', 'b_deg', 'after'),
      ...one('phi', 'φ of the tube', 'phi_deg', 'inner'),
    ],
    figures: [
      figure('deviation_mm', result['deviation_mm']),
      {name: 'invariants held', value: `${invariants.filter((i) => i['passed']).length} of ${invariants.length}`},
    ],
    said: `The tool stays within ${measured('deviation_mm', Number(result['deviation_mm']))} of the contour.`,
    tables: [
      {
        title: 'Invariants',
        head: ['invariant', 'held', 'value', 'limit', 'unit'],
        rows: invariants.map((i) => {
          const {name, about} = check(String(i['name']));
          const mark = spelled(String(i['unit']));
          return [{text: name, about}, i['passed'] ? 'yes' : 'NO', residual(Number(i['value']), mark), residual(Number(i['limit']), mark), mark];
        }),
      },
    ],
  };
}

export async function feedCurve(_: Row, answer: Answer): Promise<Picture> {
  const {request, result} = answer;
  const table = result['table'] as Row,
    fit = result['fit'] as Row | undefined;
  const t = column(table['t_s']),
    speed = column(table['cylinder_speed_mm_s']);
  const fitted = fit ? t.map((time) => polynomial(column(fit['seconds']), time)) : [];
  const x = {name: 'time', unit: 's', values: t};
  const work = result['work'] as Row;
  const charts: Chart[] = [
    {
      id: 'speed',
      title: 'Cylinder speed that keeps the feed constant',
      link: 'feed',
      unit: 'mm/s',
      x,
      height: 250,
      series: [
        {name: 'exact', values: speed, tone: 'before', width: 4},
        ...(fit ? [{name: `polynomial of degree ${fit['degree']}`, values: fitted, tone: 'after', width: 1.5}] : []),
      ],
    },
    ...(fit
      ? [
          {
            id: 'error',
            title: 'Relative error of the polynomial',
            link: 'feed',
            unit: '%',
            x,
            zero: true,
            height: 170,
            series: [{name: 'error', values: speed.map((v, i) => 100 * ((fitted[i] as number) / v - 1)), tone: 'after'}],
          },
        ]
      : []),
    {
      id: 'stroke',
      title: 'Stroke of the cylinder and feed of the tool',
      link: 'feed',
      unit: 'mm',
      x,
      height: 170,
      series: [
        {name: 'stroke', values: column(table['stroke_mm']), tone: 'outer', width: 2},
        {name: 'feed', values: column(table['feed_mm']), tone: 'inner'},
      ],
    },
  ];
  const comparison = (result['comparison'] ?? []) as Row[];
  return {
    charts,
    said: `The tool feeds ${measured('feed_mm_s', Number(work['feed_mm_s']))} for ${measured('duration_s', Number(work['duration_s']))}; the cylinder goes from ${measured('min_cylinder_speed_mm_s', Number(work['min_cylinder_speed_mm_s']))} to ${measured('max_cylinder_speed_mm_s', Number(work['max_cylinder_speed_mm_s']))}.`,
    figures: [
      ...figures(work, ['duration_s', 'min_cylinder_speed_mm_s', 'max_cylinder_speed_mm_s']),
      ...figures(fit, ['degree', 'max_relative_error', 'tool_position_error_mm']),
      ...figures(result['cycle'] as Row | undefined, ['cycle_s', 'pieces_per_hour']),
      ...figures(result['tool'] as Row | undefined, ['feed_per_blade_mm', 'cutting_speed_outside_m_min']),
    ],
    tables: [
      ...(fit
        ? [
            {
              title: 'Polynomial in seconds, to six digits',
              head: ['power', 'coefficient'],
              rows: column(fit['seconds_rounded']).map((c, i) => [
                {text: `t^${i}`, about: 'To six digits here; whole in the files and in the JSON.'},
                powers(c),
              ]),
            },
          ]
        : []),
      ...(comparison.length
        ? [
            {
              title: 'Methods compared',
              head: compared.map((key) => term(key)),
              rows: comparison.map((c) => compared.map((key) => text(key, c[key]))),
            },
          ]
        : []),
      ...['geometry', 'cycle', 'tool'].filter((key) => isRow(result[key])).map((key) => facts(key, result[key] as Row)),
      ...(isRow(request['linkage']) ? [facts('linkage', request['linkage'], 'Linkage as understood')] : []),
    ],
    readout: (i) => [
      ['time', at(table, 't_s', i)],
      ['cylinder', at(table, 'cylinder_speed_mm_s', i)],
      ['feed', at(table, 'feed_mm', i)],
      ['stroke', at(table, 'stroke_mm', i)],
    ],
  };
}

const compared = ['method', 'degree', 'max_relative_error', 'tool_position_error_mm'];

const polynomial = (c: number[], t: number) => c.reduceRight((sum, each) => sum * t + each, 0);
