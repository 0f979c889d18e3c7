import {isRow, type Json, type Row} from '../json';
import {later, many, t} from '../language';
import {column, type Band, type Chart, type Mark, type Picture, type Table} from '../picture';
import type {Answer} from '../service';
import {choice, number, term} from '../words';
import {facts, figure, figures, readings} from './facts';
import {gapChart, gapsOf} from './gaps';
import {bounds, type Sizes} from './geometry';
import {cornersOf, edgeOf, edgesOf, sectionSolid} from './section_solid';

/** Pictures of a target that is not round: charts along the girth, and the end in space. */
export const isSection = (answer: Answer) => isRow(answer.result['section']);

const rowsIn = (row: Row, name: string) => (row[name] ?? []) as Row[];

function namesOf(request: Row): string[] {
  return rowsIn(request, 'cutters').map((each, i) => String(each['id'] ?? t('partner {n}', {n: i + 1})));
}

/** Ends of flats are seen at the strip of faces; junctions, jumps and kinks are marked. */
const marksOf = (events: Row[], surface: Json | undefined): Mark[] =>
  events
    .filter((event) => event['surface'] === surface && event['kind'] !== 'tangent_line')
    .map((event) => ({x: Number(event['girth_mm']), tone: 'mark', text: choice(event['kind'])}));

function eventTable(events: Row[], names: string[]): Table {
  const name = (value: Json | undefined) => names[Number(value)] ?? String(value);
  return {
    title: t('Junctions and ends of flats'),
    head: [t('kind'), t('wall'), term('girth_mm'), term('z_mm'), t('from'), t('to')],
    rows: events.map((row) => [
      choice(row['kind']),
      choice(row['surface']),
      number(Number(row['girth_mm']), 'mm'),
      number(Number(row['z_from_mm']), 'mm'),
      name(row['from']),
      name(row['to']),
    ]),
  };
}

function bandsOf(result: Row, girth: number): Band[] {
  return rowsIn(result, 'torch_binds').flatMap((row) => {
    const [from, to] = [Number(row['from_girth_mm']), Number(row['to_girth_mm'])];
    const band = {tone: 'bad', text: t('torch range binds')};
    if (to <= girth) return [{from, to, ...band}];
    return [
      {from, to: girth, ...band},
      {from: 0, to: to - girth, ...band},
    ];
  });
}

/** Where the outline is round. */
const cornerBands = (section: Row): Band[] => cornersOf(section).map(([from, to]) => ({from, to, tone: 'steel', text: t('corner')}));

/** One end over the girth: its bevel, or where the cut is square its gaps, and its two edges. */
export function sectionCharts(request: Row, end: Row, section: Row, link: string): Chart[] {
  const points = end['points'] as Row;
  const of = (name: string) => column(points[name]);
  const [b, raw] = [of('b_deg'), of('b_raw_deg')];
  const girth = Number(section['girth_mm']);
  const torch = isRow(request['torch']) ? request['torch'] : {};
  const shared = {
    link,
    x: {name: later('girth'), unit: 'mm', values: of('girth_mm')},
    period: girth,
    partners: of('cutter'),
    partnerNames: namesOf(request),
    marks: marksOf(rowsIn(end, 'events'), request['root_surface']),
    bands: cornerBands(section),
  };
  const charts: Chart[] = [
    {
      ...shared,
      id: 'bevel',
      title: t('Cutting angle B'),
      unit: '°',
      height: 205,
      series: [
        {name: t('before'), about: t('As the groove requires it.'), values: raw, tone: 'before', dash: [5, 4]},
        {name: t('least that clears'), about: t('With less, a partner would enter the wall.'), values: of('b_required_deg'), tone: 'floor', width: 1},
        {name: t('after'), about: t('As the torch follows it.'), values: b, tone: 'after', width: 2.2},
      ],
      bands: [...shared.bands, ...bandsOf(end, girth)],
      limits: ['min_deg', 'max_deg'].map((name) => ({y: Number(torch[name] ?? NaN), text: t('torch limit')})).filter((l) => Number.isFinite(l.y)),
    },
    {
      ...shared,
      id: 'height',
      title: t('Height z of the cut'),
      unit: 'mm',
      height: 150,
      series: [
        {name: t('outer edge'), values: of('z_outer_mm'), tone: 'outer', width: 2},
        {name: t('inner edge'), values: of('z_inner_mm'), tone: 'inner', width: 1.5, dash: [5, 4]},
      ],
    },
  ];
  if (gapsOf(points)) charts.splice(0, 1, gapChart(points, shared, shared));
  return charts;
}

/** The values of a row of an end, at the cursor. */
export const sectionReadings = (points: Row, i: number) =>
  readings(points, i, [
    ...['girth_mm', 'normal_deg', 'face', 'b_raw_deg', 'b_deg', 'dihedral_deg'],
    ...['z_outer_mm', 'z_inner_mm', 'gap_mm', 'beam_mm', 'gap_outer_mm', 'gap_inner_mm'],
  ]);

export function sectionTable(answer: Answer, sizes: Sizes): Picture {
  const {request, result} = answer;
  const points = result['points'] as Row,
    section = result['section'] as Row;
  const [low, high] = bounds(column(points['b_deg']));
  const laser = isRow(result['tube_laser']) ? result['tube_laser'] : undefined;
  const gap = laser && isRow(laser['gap']) ? laser['gap'] : undefined;
  return {
    solid: sectionSolid('cut', edgesOf(section, points), rowsIn(request, 'cutters'), sizes),
    charts: sectionCharts(request, result, section, 'cut'),
    figures: [
      {name: t('least B'), value: number(low, '°'), unit: '°', about: t('Of the finished cut.')},
      {name: t('greatest B'), value: number(high, '°'), unit: '°', about: t('Of the finished cut.')},
      ...figures(gap, ['greatest_mm'], 'gap'),
      figure('length_mm', result['length_mm']),
    ],
    tables: [facts('section', section), eventTable(rowsIn(result, 'events'), namesOf(request))],
    readout: (i) => sectionReadings(points, i),
    said: t('{text}.', {
      text: low === high ? t('B is {b}° all round', {b: number(low, '°')}) : t('B from {low} to {high}°', {low: number(low, '°'), high: number(high, '°')}),
    }),
  };
}

export function sectionCurves(answer: Answer, sizes: Sizes): Picture {
  const {request, result} = answer;
  const names = namesOf(request);
  const profiles = rowsIn(result, 'profiles');
  const events = profiles.flatMap((profile) => rowsIn(profile, 'events'));
  const on = (surface: string) => (profiles.find((each) => each['surface'] === surface) ?? (profiles[0] as Row))['points'] as Row;
  return {
    solid: sectionSolid('outer', [edgeOf(on('outer')), edgeOf(on('inner'))], rowsIn(request, 'cutters'), sizes),
    charts: profiles.map((profile): Chart => {
      const points = profile['points'] as Row;
      const surface = choice(profile['surface']);
      const link = String(profile['surface']);
      return {
        id: `height-${link}`,
        title: t('Height z, {surface} edge', {surface}),
        link,
        unit: 'mm',
        x: {name: later('girth'), unit: 'mm', values: column(points['girth_mm'])},
        period: Number(profile['developed_length_mm']),
        partners: column(points['cutter']),
        partnerNames: names,
        height: 200,
        series: [{name: t('{surface} edge', {surface}), values: column(points['z_mm']), tone: 'outer', width: 2}],
        marks: marksOf(events, profile['surface']),
      };
    }),
    figures: profiles.map((profile) => ({
      ...figure('length_mm', profile['length_mm']),
      name: t('length, {surface} edge', {surface: choice(profile['surface'])}),
    })),
    tables: [facts('section', result['section'] as Row), eventTable(events, names)],
    readout: (i, link) => {
      const profile = profiles.find((each) => each['surface'] === link);
      return profile ? readings(profile['points'] as Row, i, ['girth_mm', 'normal_deg', 'face', 'z_mm']) : [];
    },
    said: t('The cut meets {partners}.', {
      partners: many(new Set(profiles.flatMap((profile) => column((profile['points'] as Row)['cutter']))).size, '{n} partner', '{n} partners'),
    }),
  };
}
