import type {Row} from '../json';
import {column, type Picture, type Solid, type Vector} from '../picture';
import type {Answer} from '../service';
import {choice, number, term} from '../words';
import type {Context} from './context';
import {figure, plural, readings} from './facts';
import {bounds, partner, type Sizes} from './geometry';

/** Returns whether an answer of intersections is of a tube that is not round: its points are counted by the girth. */
export const ofSection = (result: Row): boolean => 'section' in result;

const edgeOf = (points: Row): Vector[] => {
  const [x, y, z] = ['x_mm', 'y_mm', 'z_mm'].map((key) => column(points[key])) as [number[], number[], number[]];
  return x.map((at, i) => [at, y[i] as number, z[i] as number]);
};

/** The place on a closed line that is nearest to p, seen along the tube. */
function nearest(line: Vector[], p: Vector): Vector {
  let best = line[0] as Vector;
  let least = Number.POSITIVE_INFINITY;
  line.forEach((a, i) => {
    const b = line[(i + 1) % line.length] as Vector;
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const long = dx * dx + dy * dy;
    const share = long > 0 ? Math.min(1, Math.max(0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / long)) : 0;
    const at: Vector = [a[0] + share * dx, a[1] + share * dy, a[2] + share * (b[2] - a[2])];
    const off = Math.hypot(p[0] - at[0], p[1] - at[1]);
    if (off < least) [least, best] = [off, at];
  });
  return best;
}

function solid(outer: Vector[], inner: Vector[], cutters: Row[], sizes: Sizes): Solid {
  const [low, high] = bounds([...outer, ...inner].map((p) => p[2]));
  const size = 2 * Math.max(...outer.map((p) => Math.hypot(p[0], p[1])));
  const far = high + 0.9 * size;
  const closed = (line: Vector[]) => [...line, line[0] as Vector];
  const end = (line: Vector[]) => closed(line).map(([x, y]): Vector => [x, y, far]);
  const middle = (low + high) / 2;
  return {
    link: 'cut',
    tubes: [],
    ribbons: [
      {a: closed(outer), b: end(outer), tone: 'target'},
      {a: closed(inner), b: end(inner), tone: 'inner'},
      {a: closed(outer), b: closed(outer).map((p) => nearest(inner, p)), tone: 'bevel'},
    ],
    lines: [outer, inner].map((line) => ({points: closed(line), tone: 'ink'})),
    partners: cutters.map((row, i) => partner(row, i, [0, 0, middle], Math.max(1.3 * size, high - low), sizes)),
    centre: [0, 0, middle + 0.2 * size],
    size: Math.max(1.35 * size, 0.8 * (high - low + size)),
    eye: [0.95, -0.75, -0.95],
    up: [0, 0, -1],
  };
}

/** The cut of a rectangular, square or flat oval tube: its height round the girth, and the end in space. */
export function sectionCut(answer: Answer, context: Context): Picture {
  const cutters = (answer.request['cutters'] as Row[] | undefined) ?? [];
  const names = cutters.map((each, i) => String(each['id'] ?? `partner ${i + 1}`));
  const section = answer.result['section'] as Row;
  const profiles = answer.result['profiles'] as Row[];
  const bySurface = (surface: string) => profiles.find((p) => p['surface'] === surface) ?? (profiles[0] as Row);
  const [outer, inner] = ['outer', 'inner'].map((surface) => bySurface(surface)['points'] as Row) as [Row, Row];
  const events = profiles.flatMap((p) => p['events'] as Row[]);
  const partners = column(outer['cutter']);
  const chart = (points: Row, surface: string, girth: number) => ({
    id: `height-${surface}`,
    title: `Height z of the cut, ${choice(surface)} edge`,
    link: surface === 'outer' ? 'cut' : 'bore',
    unit: 'mm',
    x: {name: 'girth', unit: 'mm', values: column(points['girth_mm'])},
    period: girth,
    partners: column(points['cutter']),
    partnerNames: names,
    height: 220,
    series: [{name: 'z', values: column(points['z_mm']), tone: surface, width: 2}],
    marks: events.filter((e) => e['surface'] === surface && e['from'] !== e['to']).map((e) => ({x: Number(e['girth_mm']), tone: 'mark', text: 'junction'})),
  });
  return {
    solid: solid(edgeOf(outer), edgeOf(inner), cutters, context.sizes),
    charts: [chart(outer, 'outer', Number(section['girth_mm'])), chart(inner, 'inner', Number(section['bore_girth_mm']))],
    figures: [
      ...profiles.map((p) => ({...figure('length_mm', p['length_mm']), name: `length, ${choice(p['surface'])} edge`})),
      ...['girth_mm', 'bore_girth_mm', 'mass_kg_per_m'].map((key) => figure(key, section[key])),
    ],
    tables: events.length
      ? [
          {
            title: 'Junctions and corners',
            head: ['kind', 'wall', term('girth_mm'), term('z_mm'), 'from', 'to'],
            rows: events.map((row) => [
              choice(row['kind']),
              choice(row['surface']),
              number(Number(row['girth_mm']), 'mm'),
              number(Number(row['z_from_mm']), 'mm'),
              names[Number(row['from'])] ?? '',
              names[Number(row['to'])] ?? '',
            ]),
          },
        ]
      : [],
    said: `The cut meets ${plural(new Set(partners).size, 'partner')}.`,
    readout: (i, link) => {
      const points = link === 'bore' ? inner : outer;
      const of = column(points['cutter']);
      return [...readings(points, i, ['girth_mm', 'z_mm', 'x_mm', 'y_mm']), ['partner', names[of[i % of.length] as number] ?? '']];
    },
  };
}
