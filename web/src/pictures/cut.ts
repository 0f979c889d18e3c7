import {isRow, type Json, type Row} from '../json';
import {later, many, t} from '../language';
import {column, type Band, type Chart, type CutTube, type Mark, type Picture, type Solid} from '../picture';
import type {Answer} from '../service';
import {choice, number, sentence, term, type Term, withUnit} from '../words';
import type {Context} from './context';
import {at, figure, readings} from './facts';
import {gapChart, gapFigures, gapsOf, gapScale} from './gaps';
import {bounds, partner, radians, tube, type Sizes} from './geometry';
import {isSection, sectionCurves, sectionTable} from './section';

interface Joint {
  outer: number;
  wall: number;
  cutters: Row[];
  names: string[];
}

/** Target and cutters in the target's frame; those of a node come from where the service places them. */
export async function joint(request: Row, context: Context): Promise<Joint> {
  if (isRow(request['target'])) {
    const {outer, wall} = tube(request['target'], context.sizes);
    const cutters = (request['cutters'] as Row[] | undefined) ?? [];
    return {outer, wall, cutters, names: cutters.map((each, i) => String(each['id'] ?? t('partner {n}', {n: i + 1})))};
  }
  const node = request['node'] as Row;
  const members = node['members'] as Row[];
  const own = members.find((member) => member['id'] === node['member']);
  const {outer, wall} = tube(own, context.sizes);
  const answer = await context.ask('nodes', {members, connect: node['connect'] as Json});
  const ends = answer.result['ends'] as Row[];
  const end = ends.find((each) => each['member'] === node['member'] && each['end'] === node['end']);
  const cutters = ((end?.['cut_by'] ?? []) as Row[]).map(
    (cut): Row =>
      isRow(cut['plane']) // of a mitre
        ? {kind: 'plane', id: cut['member'] as Json, ...cut['plane']}
        : {
            kind: 'tube',
            id: cut['member'] as Json,
            outer_diameter_mm: tube(
              members.find((m) => m['id'] === cut['member']),
              context.sizes,
            ).outer,
            ...(cut['placement'] as Row),
          },
  );
  return {outer, wall, cutters, names: cutters.map((each) => String(each['id']))};
}

export async function bevelTable(_: Row, answer: Answer, context: Context): Promise<Picture> {
  if (isSection(answer)) return sectionTable(answer, context.sizes);
  const given = await joint(answer.request, context);
  return tablePicture(answer.request, answer.result, given, context.sizes, 'cut');
}

export function tablePicture(request: Row, result: Row, given: Joint, sizes: Sizes, link: string): Picture {
  const points = result['points'] as Row;
  const cut = cutOf(request, result, given);
  const phi = column(points['phi_deg']),
    developed = column(points['developed_mm']),
    partners = column(points['cutter']);
  const b = column(points['b_deg']),
    raw = column(points['b_raw_deg']),
    required = column(points['b_required_deg']);
  const whole = Number(result['developed_length_mm']);
  const along = (angle: number) => (whole * angle) / 360;
  const torch = isRow(request['torch']) ? request['torch'] : {};
  const z = (name: string) => column(points[name]);
  const events = onRoot(request, result);
  const shared = {link, partners, partnerNames: given.names, turn: whole};
  const charts: Chart[] = [
    {
      ...shared,
      id: 'bevel',
      title: t('Cutting angle B'),
      unit: '°',
      x: {name: later('developed length'), unit: 'mm', values: developed},
      period: whole,
      height: 205,
      series: [
        {name: t('before'), about: t('As the groove requires it.'), values: raw, tone: 'before', dash: [5, 4]},
        {name: t('least that clears'), about: t('With less, a partner would enter the wall.'), values: required, tone: 'floor', width: 1},
        {name: t('after'), about: t('As the torch follows it.'), values: b, tone: 'after', width: 2.2},
      ],
      bands: bandsOf(result, along),
      marks: mutationsOf(result, along, phi, raw),
      limits: [
        {y: Number(torch['min_deg'] ?? NaN), text: t('torch limit')},
        {y: Number(torch['max_deg'] ?? NaN), text: t('torch limit')},
      ].filter((l) => Number.isFinite(l.y)),
    },
    {
      ...shared,
      id: 'height',
      title: t('Height z of the cut'),
      unit: 'mm',
      x: {name: 'φ', unit: '°', values: phi},
      period: 360,
      height: 150,
      series: [
        {name: t('outer edge'), values: z('z_outer_mm'), tone: 'outer', width: 2},
        {name: t('inner edge'), values: z('z_inner_mm'), tone: 'inner', width: 1.5, dash: [5, 4]},
      ],
      marks: events.map((event) => ({x: Number(event['phi_deg']), tone: 'mark', text: t('junction')})),
    },
    wrapChart(phi, z('z_outer_mm'), z('z_inner_mm'), partners, given.outer / 2, link, given.names),
  ];
  const {gaps} = cut;
  if (gaps) charts.splice(0, 1, gapChart(points, shared));
  return {
    solid: {...solidOf(cut, given, sizes, link), ...(gaps ? {scale: gapScale(gaps.most)} : tinted([...b, ...raw]))},
    charts,
    beforeAfter: !gaps,
    figures: gaps ? gapFigures(result) : figuresOf(result, events.length, b, raw),
    tables: tablesOf(result, given.names),
    readout: (i) => readout(points, given.names, i),
    said: Number.isFinite(Number(torch['max_deg']))
      ? t('{range}, torch limit {limit}.', {range: sentence(rangeOf(b)), limit: withUnit(torchLimit(torch, b), '°')})
      : t('{text}.', {text: sentence(rangeOf(b))}),
  };
}

/** "B from 18.7 to 72.6°" */
export function rangeOf(b: number[]): string {
  const [low, high] = bounds(b).map((each) => number(each, '°')) as [string, string];
  if (low === high) return low === '0' ? t('square to the wall') : t('B is {b}° all round', {b: low});
  return t('B from {low} to {high}°', {low, high});
}

/** The end of the torch's range that the cut is nearer to. */
function torchLimit(torch: Row, b: number[]): number {
  const [low, high] = bounds(b);
  const [least, most] = [Number(torch['min_deg']), Number(torch['max_deg'])];
  return low - least < most - high ? least : most;
}

/** The tint of cuts with these bevels, before and after alike; a band of 10° at least, so that a cut of one angle has one colour. */
export function tinted(b: number[]): Pick<Solid, 'scale' | 'tint'> {
  const [low, high] = bounds(b).map((each, i) => (i ? Math.ceil(each - 0.05) : Math.floor(each + 0.05))) as [number, number];
  const span: [number, number] = high - low < 10 ? [Math.floor((low + high) / 2) - 5, Math.floor((low + high) / 2) + 5] : [low, high];
  return {tint: span, scale: [`B ${span[0]}°`, `${span[1]}°`]};
}

function wrapChart(phi: number[], outer: number[], inner: number[], partners: number[], radius: number, link: string, names: string[]): Chart {
  const scale = radius * radians;
  return {
    id: 'wrap',
    title: t('Wrap'),
    link,
    unit: 'mm',
    partners,
    partnerNames: names,
    x: {name: later('round the outside, mm for mm'), unit: 'mm', values: phi.map((p) => p * scale)},
    period: 360 * scale,
    series: [
      {name: t('outside'), values: outer, tone: 'outer', width: 2},
      {name: t('inside'), values: inner, tone: 'inner', width: 1, dash: [4, 3]},
    ],
    wrap: {lines: [0, 90, 180, 270, 360].map((p) => ({x: p * scale, text: p === 360 ? '' : p === 0 ? t('φ 0° seam') : `${p}°`}))},
  };
}

/** The end before smoothing keeps its root edge; the other edge follows from B: z_outer = z_inner + t tan B (or its mirror). */
function cutOf(request: Row, result: Row, given: Joint): CutTube {
  const points = result['points'] as Row;
  const zInner = column(points['z_inner_mm']),
    zOuter = column(points['z_outer_mm']);
  const b = column(points['b_deg']),
    raw = column(points['b_raw_deg']);
  const sign = result['b_sign'] === 'inward' ? -1 : 1;
  const shift = b.map((angle, i) => sign * given.wall * (Math.tan(angle * radians) - Math.tan((raw[i] as number) * radians)));
  const atInner = request['root_surface'] === 'inner';
  return {
    outer: given.outer / 2,
    inner: given.outer / 2 - given.wall,
    phi: column(points['phi_deg']),
    zInner,
    zOuter,
    b,
    gaps: gapsOf(points),
    before: {
      b: raw,
      zInner: atInner ? zInner : zInner.map((z, i) => z + (shift[i] as number)),
      zOuter: atInner ? zOuter.map((z, i) => z - (shift[i] as number)) : zOuter,
    },
    far: farEnd(zInner, zOuter, given.outer),
    tone: 'target',
    marks: onRoot(request, result).map((event) => ({
      phi: Number(event['phi_deg']),
      z: Number(event['z_from_mm']),
      radius: event['surface'] === 'inner' ? given.outer / 2 - given.wall : given.outer / 2,
    })),
  };
}

/** The other wall's junctions lie on its own curve, which the bevel may leave behind. */
const onRoot = (request: Row, result: Row) => ((result['events'] ?? []) as Row[]).filter((event) => event['surface'] === request['root_surface']);

export const farEnd = (zInner: number[], zOuter: number[], diameter: number) => bounds([...zInner, ...zOuter])[1] + 0.9 * diameter;

export function solidOf(cut: CutTube, given: Joint, sizes: Sizes, link: string): Solid {
  const [low, high] = bounds([...cut.zInner, ...cut.zOuter]);
  const middle = (low + high) / 2;
  const reach = Math.max(1.3 * given.outer, high - low);
  return {
    link,
    tubes: [cut],
    partners: given.cutters.map((row, i) => partner(row, i, [0, 0, middle], reach, sizes)),
    centre: [0, 0, middle + 0.2 * given.outer],
    size: Math.max(1.35 * given.outer, 0.8 * (high - low + given.outer)),
    eye: [0.95, -0.75, -0.95],
    up: [0, 0, -1],
  };
}

function bandsOf(result: Row, along: (phi: number) => number): Band[] {
  const bands: Band[] = [];
  const span = (row: Row, tone: string, text: string) => {
    const from = along(Number(row['from_phi_deg'])),
      to = along(Number(row['to_phi_deg']));
    if (to > along(360)) bands.push({from, to: along(360), tone, text}, {from: 0, to: to - along(360), tone, text});
    else if (from <= to) bands.push({from, to, tone, text});
    else bands.push({from, to: along(360), tone, text}, {from: 0, to, tone, text}); // across the seam
  };
  for (const row of (result['windows'] ?? []) as Row[]) span(row, 'window', t('smoothed window'));
  for (const row of (result['torch_binds'] ?? []) as Row[]) span(row, 'bad', t('torch range binds'));
  return bands;
}

function mutationsOf(result: Row, along: (phi: number) => number, phi: number[], raw: number[]): Mark[] {
  return ((result['mutations'] ?? []) as Row[]).map((row) => {
    const at = Number(row['phi_deg']);
    const index = phi.findIndex((p) => p >= at - 1e-9);
    return {x: along(at), y: raw[Math.max(0, index)] ?? 0, tone: 'mark', text: t('mutation')};
  });
}

function figuresOf(result: Row, junctions: number, b: number[], raw: number[]): Picture['figures'] {
  const [low, high] = bounds(b);
  const extra = b.reduce((most, angle, i) => Math.max(most, Math.abs(angle - (raw[i] as number))), 0);
  return [
    {name: t('least B'), value: number(low, '°'), unit: '°', about: t('Of the finished cut.')},
    {name: t('greatest B'), value: number(high, '°'), unit: '°', about: t('Of the finished cut.')},
    {name: t('B moved by at most'), value: number(extra, '°'), unit: '°', about: t('By smoothing, between before and after.')},
    {name: t('mutations'), value: String(((result['mutations'] ?? []) as Row[]).length), about: t('Steps of B before smoothing.')},
    {name: t('junctions'), value: String(junctions), about: t('Where the cut passes from one partner to the next.')},
    {name: t('cut length'), value: number(Number(result['length_mm']), 'mm'), unit: 'mm', about: t('Along the cut.')},
  ];
}

function tablesOf(result: Row, names: string[]): Picture['tables'] {
  const tables: Picture['tables'] = [];
  const mutations = (result['mutations'] ?? []) as Row[];
  if (mutations.length) {
    tables.push({
      title: t('Mutations'),
      head: [term('phi_deg'), term('step_deg')],
      rows: mutations.map((row) => [number(Number(row['phi_deg']), '°'), number(Number(row['step_deg']), '°')]),
    });
  }
  const events = (result['events'] ?? []) as Row[];
  if (events.length) tables.push(eventTable(events, names));
  return tables;
}

function eventTable(events: Row[], names: string[]) {
  const name = (value: Json | undefined) => names[Number(value)] ?? String(value);
  return {
    title: t('Junctions'),
    head: [t('kind'), t('wall'), term('phi_deg'), term('z_mm'), t('from'), t('to')],
    rows: events.map((row) => [
      choice(row['kind']),
      choice(row['surface']),
      number(Number(row['phi_deg']), '°'),
      number(Number(row['z_from_mm']), 'mm'),
      name(row['from']),
      name(row['to']),
    ]),
  };
}

function readout(points: Row, names: string[], i: number): [Term, string][] {
  const of = (...keys: string[]) => readings(points, i, keys);
  const cutter = column(points['cutter']);
  return [
    ...of('phi_deg', 'developed_mm'),
    [t('partner'), names[cutter[i % cutter.length] as number] ?? ''],
    ...of('b_raw_deg', 'b_deg', 'dihedral_deg', 'z_outer_mm', 'z_inner_mm', 'gap_mm', 'beam_mm', 'gap_outer_mm', 'gap_inner_mm'),
  ];
}

export async function intersection(_: Row, answer: Answer, context: Context): Promise<Picture> {
  if (isSection(answer)) return sectionCurves(answer, context.sizes);
  const given = await joint(answer.request, context);
  const profiles = answer.result['profiles'] as Row[];
  const bySurface = (surface: string) => profiles.find((p) => p['surface'] === surface) ?? (profiles[0] as Row);
  const outer = bySurface('outer'),
    inner = bySurface('inner');
  const outerPoints = outer['points'] as Row;
  const phi = column(outerPoints['phi_deg']),
    zOuter = column(outerPoints['z_mm']);
  const zInner = atPhi(inner['points'] as Row, phi);
  const partners = column(outerPoints['cutter']);
  const events = profiles.flatMap((p) => p['events'] as Row[]);
  const cut: CutTube = {
    outer: given.outer / 2,
    inner: given.outer / 2 - given.wall,
    phi,
    zInner,
    zOuter,
    far: farEnd(zInner, zOuter, given.outer),
    tone: 'target',
    marks: events.map((e) => ({
      phi: Number(e['phi_deg']),
      z: Number(e['z_from_mm']),
      radius: e['surface'] === 'inner' ? given.outer / 2 - given.wall : given.outer / 2,
    })),
  };
  return {
    solid: solidOf(cut, given, context.sizes, 'cut'),
    charts: [
      {
        id: 'height',
        title: t('Height z of the cut'),
        link: 'cut',
        unit: 'mm',
        x: {name: 'φ', unit: '°', values: phi},
        period: 360,
        partners,
        partnerNames: given.names,
        height: 240,
        series: [
          {name: t('outside'), values: zOuter, tone: 'outer', width: 2},
          {name: t('inside'), values: zInner, tone: 'inner', dash: [5, 4]},
        ],
        marks: events.map((e) => ({x: Number(e['phi_deg']), tone: 'mark', text: t('junction')})),
      },
      wrapChart(phi, zOuter, zInner, partners, given.outer / 2, 'cut', given.names),
    ],
    figures: profiles.map((p) => ({...figure('length_mm', p['length_mm']), name: t('length, {surface} edge', {surface: choice(p['surface'])})})),
    tables: events.length ? [eventTable(events, given.names)] : [],
    said: t('The cut meets {partners} and has {junctions}.', {
      partners: many(new Set(partners).size, '{n} partner', '{n} partners'),
      junctions: many(events.length, '{n} junction', '{n} junctions'),
    }),
    readout: (i) => [
      ['φ', at({phi_deg: phi}, 'phi_deg', i)],
      [t('z outside'), at({z_mm: zOuter}, 'z_mm', i)],
      [t('z inside'), at({z_mm: zInner}, 'z_mm', i)],
      [t('partner'), given.names[partners[i % partners.length] as number] ?? ''],
    ],
  };
}

/** A profile read at other angles; the walls are sampled each at its own. */
export function atPhi(points: Row, phi: number[]): number[] {
  const from = column(points['phi_deg']),
    z = column(points['z_mm']);
  let i = 0;
  return phi.map((angle) => {
    while (i + 1 < from.length && (from[i + 1] as number) <= angle) ++i;
    const a = from[i] as number,
      next = (i + 1) % from.length;
    const b = next === 0 ? (from[0] as number) + 360 : (from[next] as number);
    const t = b > a ? Math.min(1, Math.max(0, (angle - a) / (b - a))) : 0;
    return (z[i] as number) * (1 - t) + (z[next] as number) * t;
  });
}
