import {isRow, type Json, type Row} from '../json';
import {many, t} from '../language';
import {column, type Chart, type Picture, type Ribbon, type Section, type Solid, type Table, type Vector} from '../picture';
import type {Answer} from '../service';
import {about, label, measured, number, term, unit, withUnit} from '../words';
import {facts, figure, figures, readings, text} from './facts';
import {without, type Context} from './context';
import {bounds, partner, tube} from './geometry';
import {axesBefore, axesOf, coneTool, sectionOf, type Curves} from './mill';

const round = 180; // sections of the picture, for any requested number

export async function groove(_: Row, answer: Answer, context: Context): Promise<Picture> {
  const {request, result} = answer;
  const sections = result['sections'] as Row;
  const omega = column(sections['omega_deg']);
  const x = {name: 'ω', unit: '°', values: omega};
  const chart = (id: string, title: string, names: [string, string][], more: Partial<Chart> = {}): Chart => ({
    id,
    title,
    link: 'groove',
    unit: unit(names[0]?.[0] ?? ''),
    x,
    period: (omega[0] as number) + 360,
    ...more,
    series: names
      .filter(([name]) => name in sections)
      .map(([name, tone]) => ({name: label(name, 'sections'), about: about(name, 'sections'), values: column(sections[name]), tone, width: 2})),
  });
  const curves = await curvesOf(request, context);
  return {
    solid: solid(request, context, curves),
    section: named(sectionOf('groove', curves, omega), sections),
    charts: [
      chart('height', t('Height of the groove'), [['height_mm', 'after']], {zero: true}),
      chart(
        'area',
        t('Areas of the section'),
        [
          ['area_a_mm2', 'series-0'],
          ['area_b_mm2', 'series-1'],
          ['area_c_mm2', 'series-2'],
          ['area_d_mm2', 'series-3'],
          ['area_e_mm2', 'series-4'],
        ],
        {zero: true},
      ),
      chart('angle', t('Groove angle'), [['groove_angle_deg', 'after']], {height: 160}),
      chart('twist', t('Twist of the ruling'), [['twist_deg', 'outer']], {height: 150, zero: true}),
    ].filter((each) => each.series.length > 0),
    figures: figures(result, ['filler_area_mm2', 'height_min_mm', 'height_max_mm', 'weld_length_mm', 'filler_volume_mm3']),
    said: t('Filler {area} in every section; the groove is {low} to {high} high.', {
      area: measured('filler_area_mm2', Number(result['filler_area_mm2'])),
      low: measured('height_min_mm', Number(result['height_min_mm'])),
      high: measured('height_max_mm', Number(result['height_max_mm'])),
    }),
    readout: (i) => readings(sections, i, Object.keys(sections).slice(0, 10), 'sections'),
  };
}

/** The section with the points and areas that its columns name, of the filler between P1, P2 and P3. */
function named(section: Section, sections: Row): Section {
  const of = (name: string) => column(sections[name]);
  const [xs, ys] = ['x', 'y'].map((axis) => ['p1', 'p2', 'p3'].map((name) => of(`${name}_${axis}_mm`))) as [number[][], number[][]];
  const areas = ['a', 'b', 'c', 'd', 'e'].map((name) => [name.toUpperCase(), of(`area_${name}_mm2`)] as const);
  const {moved: flat} = section.at(0);
  const right = flat ? bounds((xs[1] as number[]).map((x) => flat([x, 0])[0]))[1] : 0;
  return {
    ...section,
    high: [Math.max(section.high[0], 1.15 * right), section.high[1]],
    at: (i) => {
      const {title, lines, moved} = section.at(i);
      if (!moved) return {title, lines};
      const points = xs.map((x, k) => ({at: moved([x[i] as number, (ys[k] as number[])[i] as number]), text: `P${k + 1}`}));
      return {
        title,
        lines: [...lines, {points: points.map(({at}) => at), tone: 'after'}],
        points,
        note: t('areas {areas} mm²', {areas: areas.map(([name, values]) => `${name} ${number(values[i] as number, 'mm²')}`).join(', ')}),
      };
    },
  };
}

const most = (values: Json | undefined) => column(values).reduce((a, b) => Math.max(a, b), 0);

/** The curves of the groove, as finely as the picture needs them. */
async function curvesOf(request: Row, context: Context): Promise<Curves> {
  const finer = await context.ask('grooves', {...without(request), sections: round});
  const curves = finer.result['curves'] as Row;
  const points = (name: string): Vector[] => {
    const curve = curves[name] as Row;
    const [xs, ys, zs] = [column(curve['x_mm']), column(curve['y_mm']), column(curve['z_mm'])];
    return xs.map((x, i) => [x, ys[i] as number, zs[i] as number]);
  };
  return {omega: column((finer.result['sections'] as Row)['omega_deg']), points: ['c1', 'c2', 'c3', 'c4'].map(points) as Curves['points']};
}

function solid(request: Row, context: Context, {points: [c1, c2, c3, c4]}: Curves): Solid {
  const ribbons: Ribbon[] = [
    {a: c1, b: c2, tone: 'inner'},
    {a: c2, b: c3, tone: 'inner'},
    {a: c3, b: c4, tone: 'bevel'},
  ];
  const all = [...c1, ...c2, ...c3, ...c4];
  const [low, high] = bounds(all.map((p) => p[2]));
  const branch = tube(request['branch'], context.sizes),
    chord = tube(request['chord'], context.sizes);
  const inclination = Number(request['inclination_deg'] ?? 90),
    eccentricity = Number(request['eccentricity_mm'] ?? 0);
  const middle: Vector = [0, 0, (low + high) / 2];
  return {
    link: 'groove',
    tubes: [],
    ribbons,
    lines: [c1, c2, c3, c4].map((line, i) => ({points: line, tone: i === 3 ? 'after' : 'ink'})),
    partners: [
      partner(
        {kind: 'tube', outer_diameter_mm: branch.outer, axis: {point_mm: [0, 0, 0], direction: [0, 0, 1]}},
        0,
        [0, 0, high + 0.2 * branch.outer],
        0.4 * branch.outer,
        context.sizes,
      ),
      partner(
        {kind: 'tube', outer_diameter_mm: chord.outer, inclination_deg: inclination, clocking_deg: 180, offset_mm: eccentricity},
        1,
        middle,
        0.9 * branch.outer,
        context.sizes,
      ),
    ],
    centre: middle,
    size: 1.1 * branch.outer,
    eye: [0.7, -0.9, 0.75],
    up: [0, 0, 1],
  };
}

export async function millPath(_: Row, answer: Answer, context: Context): Promise<Picture> {
  const {request, result} = answer;
  const p = result['positions'] as Row;
  const inner = request['groove'] as Row;
  const cut = await context.ask('grooves', without(inner));
  const shape = await groove(inner, cut, context);
  const x = {name: 'ω', unit: '°', values: column(p['omega_deg'])};
  const tool = coneTool(answer.request, axesOf(p), axesBefore(p, answer.request));
  const chart = (id: string, title: string, names: [string, string, boolean?][], more: Partial<Chart> = {}): Chart => ({
    id,
    title,
    link: 'mill',
    unit: unit(names[0]?.[0] ?? ''),
    x,
    period: (x.values[0] as number) + 360,
    ...more,
    series: names
      .filter(([name]) => name in p)
      .map(([name, tone, dashed]) => ({
        name: label(name, 'positions'),
        about: about(name, 'positions'),
        values: column(p[name]),
        tone,
        ...(dashed ? {dash: [5, 4]} : {}),
        width: dashed ? 1.5 : 2,
      })),
  });
  return {
    ...(shape.solid ? {solid: {...shape.solid, link: 'mill', tool}} : {}),
    section: sectionOf('mill', await curvesOf(inner, context), x.values, tool),
    beforeAfter: true,
    charts: [
      chart(
        'overcut',
        t('Overcut and undercut, before and after'),
        [
          ['overcut_before_mm', 'before', true],
          ['undercut_before_mm', 'floor', true],
          ['overcut_mm', 'after'],
          ['undercut_mm', 'outer'],
        ],
        {zero: true, height: 220},
      ),
      chart('xz', t('X and Z of the mill'), [
        ['x_mm', 'outer'],
        ['z_mm', 'inner'],
      ]),
      chart('b', t('B of the mill'), [['b_deg', 'after']], {height: 150}),
      chart(
        'correction',
        t('Correction found'),
        [
          ['dz_mm', 'series-2'],
          ['db_deg', 'series-3'],
        ],
        {height: 150, zero: true},
      ),
    ],
    figures: [
      {name: t('positions'), value: String(x.values.length)},
      figure('qualified', result['qualified']),
      ...figures(result['swept'] as Row, ['flank_min_mm', 'flank_max_mm', 'stock_left_max_mm', 'root_face_min_mm']),
    ],
    said: t('{positions}; overcut at most {overcut}, undercut {undercut}.', {
      positions: many(x.values.length, '{n} position', '{n} positions'),
      overcut: withUnit(most(p['overcut_mm']), 'mm'),
      undercut: withUnit(most(p['undercut_mm']), 'mm'),
    }),
    tables: [facts('swept', result['swept'] as Row), ...probed(result['probe'])],
    readout: (i) =>
      readings(p, i, ['omega_deg', 'c_deg', 'x_mm', 'z_mm', 'b_deg', 'overcut_before_mm', 'overcut_mm', 'undercut_mm', 'certificate_mm'], 'positions'),
  };
}

/** Returns the requested points, and the deepest ones. */
function probed(probe: Json | undefined): Table[] {
  if (!isRow(probe)) return [];
  const keys = ['omega_deg', 'ruling_deg', 'v', 'distance_before_mm', 'distance_mm'];
  const row = (name: string, place: Row) => [name, ...keys.map((key) => text(key, place[key]))];
  const asked = (probe['points'] as Row[]).map((place, i) => row(t('point {n}', {n: i + 1}), place));
  const deepest = ['overcut_before', 'undercut_before'].map((key) => {
    const {distance_mm: distance, ...place} = probe[key] as Row;
    return row(label(key), {...place, distance_before_mm: distance as Json});
  });
  const after = ['overcut', 'undercut'].map((key) => row(label(key), probe[key] as Row));
  return [{title: t('Distance from the mill'), head: ['', ...keys.map((key) => term(key))], rows: [...asked, ...deepest, ...after]}];
}
