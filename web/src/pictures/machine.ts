import {isRow, type Row} from '../json';
import {later, t} from '../language';
import {column, type Chart, type Picture} from '../picture';
import type {Answer} from '../service';
import {shownUnit} from '../units';
import {about, check, label, measured, powers, residual, spelled, term, unit} from '../words';
import {at, facts, figure, figures, text} from './facts';

const most = 3000; // points that a chart is drawn with; a replay may have 400 000 periods

export async function replay(_: Row, answer: Answer): Promise<Picture> {
  const {result} = answer;
  const path = result['path'] as Row;
  const z = column(path['z_mm']);
  const every = Math.max(1, Math.ceil(z.length / most));
  const thin = (values: number[]) => values.filter((_v, i) => i % every === 0);
  const x = {name: later('period'), unit: '', values: thin(z.map((_v, i) => i))};
  const one = (id: string, title: string, name: string, tone: string): Chart[] =>
    name in path
      ? [{id, title, link: 'replay', unit: unit(name), x, series: [{name: label(name), about: about(name), values: thin(column(path[name])), tone, width: 2}]}]
      : [];
  const invariants = result['invariants'] as Row[];
  return {
    charts: [
      ...one('z', t('z of the torch'), 'z_mm', 'outer'),
      ...one('b', t('B of the torch'), 'b_deg', 'after'),
      ...one('phi', t('φ of the tube'), 'phi_deg', 'inner'),
    ],
    figures: [
      figure('deviation_mm', result['deviation_mm']),
      {name: t('invariants held'), value: t('{some} of {all}', {some: invariants.filter((i) => i['passed']).length, all: invariants.length})},
    ],
    said: t('The tool stays within {deviation} of the contour.', {deviation: measured('deviation_mm', Number(result['deviation_mm']))}),
    tables: [
      {
        title: t('Invariants'),
        head: [t('invariant'), t('held'), t('value'), t('limit'), t('unit')],
        rows: invariants.map((i) => {
          const {name, about} = check(String(i['name']));
          const mark = spelled(String(i['unit']));
          return [
            {text: name, about},
            i['passed'] ? t('yes') : t('NO'),
            residual(Number(i['value']), mark),
            residual(Number(i['limit']), mark),
            shownUnit(mark),
          ];
        }),
      },
    ],
  };
}

export async function feedCurve(_: Row, answer: Answer): Promise<Picture> {
  const {request, result} = answer;
  const table = result['table'] as Row,
    fit = result['fit'] as Row | undefined;
  const times = column(table['t_s']),
    speed = column(table['cylinder_speed_mm_s']);
  const fitted = fit ? times.map((time) => polynomial(column(fit['seconds']), time)) : [];
  const x = {name: later('time'), unit: 's', values: times};
  const work = result['work'] as Row;
  const charts: Chart[] = [
    {
      id: 'speed',
      title: t('Cylinder speed that keeps the feed constant'),
      link: 'feed',
      unit: 'mm/s',
      x,
      height: 250,
      series: [
        {name: t('exact'), values: speed, tone: 'before', width: 4},
        ...(fit ? [{name: t('polynomial of degree {degree}', {degree: Number(fit['degree'])}), values: fitted, tone: 'after', width: 1.5}] : []),
      ],
    },
    ...(fit
      ? [
          {
            id: 'error',
            title: t('Relative error of the polynomial'),
            link: 'feed',
            unit: '%',
            x,
            zero: true,
            height: 170,
            series: [{name: t('error'), values: speed.map((v, i) => 100 * ((fitted[i] as number) / v - 1)), tone: 'after'}],
          },
        ]
      : []),
    {
      id: 'stroke',
      title: t('Stroke of the cylinder and feed of the tool'),
      link: 'feed',
      unit: 'mm',
      x,
      height: 170,
      series: [
        {name: t('stroke'), values: column(table['stroke_mm']), tone: 'outer', width: 2},
        {name: t('feed'), values: column(table['feed_mm']), tone: 'inner'},
      ],
    },
  ];
  const comparison = (result['comparison'] ?? []) as Row[];
  return {
    charts,
    said: t('The tool feeds {feed} for {time}; the cylinder goes from {low} to {high}.', {
      feed: measured('feed_mm_s', Number(work['feed_mm_s'])),
      time: measured('duration_s', Number(work['duration_s'])),
      low: measured('min_cylinder_speed_mm_s', Number(work['min_cylinder_speed_mm_s'])),
      high: measured('max_cylinder_speed_mm_s', Number(work['max_cylinder_speed_mm_s'])),
    }),
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
              title: t('Polynomial in seconds, to six digits'),
              head: [t('power'), t('coefficient')],
              rows: column(fit['seconds_rounded']).map((c, i) => [
                {text: `t^${i}`, about: t('To six digits here; whole in the files and in the JSON.')},
                powers(c),
              ]),
            },
          ]
        : []),
      ...(comparison.length
        ? [
            {
              title: t('Methods compared'),
              head: compared.map((key) => term(key)),
              rows: comparison.map((c) => compared.map((key) => text(key, c[key]))),
            },
          ]
        : []),
      ...['geometry', 'cycle', 'tool'].filter((key) => isRow(result[key])).map((key) => facts(key, result[key] as Row)),
      ...(isRow(request['linkage']) ? [facts('linkage', request['linkage'], t('Linkage as understood'))] : []),
    ],
    readout: (i) => [
      [t('time'), at(table, 't_s', i)],
      [t('cylinder'), at(table, 'cylinder_speed_mm_s', i)],
      [t('feed'), at(table, 'feed_mm', i)],
      [t('stroke'), at(table, 'stroke_mm', i)],
    ],
  };
}

const compared = ['method', 'degree', 'max_relative_error', 'tool_position_error_mm'];

const polynomial = (c: number[], time: number) => c.reduceRight((sum, each) => sum * time + each, 0);
