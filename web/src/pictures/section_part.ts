import {isRow, rowsOf, type Row} from '../json';
import {many, t} from '../language';
import {pressed} from '../preset';
import {column, type Frame, type Partner, type Picture, type Solid, type Table, type Vector} from '../picture';
import type {Answer} from '../service';
import {about, choice, label, sentence, sentences, shown, withUnit, type Term} from '../words';
import {rangeOf, tinted} from './cut';
import {facts, figures} from './facts';
import {gapScale, gapsOf, webFigures} from './gaps';
import {table} from './generic';
import {bounds, frame, partner, placed, placedFrom, seenFrom, strokesOf, type Sizes} from './geometry';
import {sectionCharts, sectionReadings} from './section';
import {edgesOf, girthOf, outside, wallBetween} from './section_solid';

type Side = 'start' | 'finish';
const sides: Side[] = ['start', 'finish'];

/** What was asked of an end, with what counts for both. */
function askedOf(request: Row, side: Side): Row {
  const ends = isRow(request['ends']) ? request['ends'] : {};
  return {...request, ...(isRow(ends[side]) ? ends[side] : {})};
}

/** A whole member that is not round: lengths on its faces, check dimensions, and each end as the table it is. */
export function sectionPart({request, result}: Answer, sizes: Sizes): Picture {
  const section = result['section'] as Row;
  const endOf = (side: Side) => (result['ends'] as Row)[side] as Row;
  const lengths = result['lengths'] as Row;
  const charts = sides.flatMap((side) => {
    const asked = askedOf(request, side);
    if (!rowsOf(asked['cutters']).length) return []; // square: nothing to draw over the girth
    const drawn = sectionCharts(asked, endOf(side), section, `cut-${side}`);
    return drawn.map((chart) => ({...chart, id: `${chart.id}-${side}`, title: t('{part}: {text}', {part: sentence(choice(side)), text: chart.title})}));
  });
  const cutouts = rowsOf(result['cutouts']).reduce((sum, group) => sum + rowsOf(group['instances']).length, 0);
  const ranges = sides.map((side) => t('{part}: {text}.', {part: sentence(choice(side)), text: rangeOf(column((endOf(side)['points'] as Row)['b_deg']))}));
  const first = [
    t('{length} from tip to tip', {length: withUnit(Number(lengths['long_mm']), 'mm')}),
    ...(cutouts ? [many(cutouts, 'with {n} cut-out', 'with {n} cut-outs')] : []),
  ];
  return {
    solid: solidOf(request, result, sizes),
    charts,
    figures: [...webFigures(result), ...figures(lengths, Object.keys(lengths))],
    tables: [
      faceTable(result),
      ...['check_dimensions', 'sequence'].filter((key) => rowsOf(result[key]).length).map((key) => table(key, rowsOf(result[key]))),
      facts('section', section),
    ],
    readout: (i, link) => sectionReadings(endOf(link === 'cut-finish' ? 'finish' : 'start')['points'] as Row, i),
    said: sentences(t('{text}.', {text: first.join(t(', '))}), ...ranges),
  };
}

/** The four faces as they are measured and sawn: their lengths, and how each end cuts them. */
export function faceTable(result: Row): Table {
  const lengths = result['side_lengths'] as Row;
  const ends = result['ends'] as Row;
  const faces = sides.map((side) => rowsOf((ends[side] as Row)['faces']));
  // A blade is named only where one plane cuts the end.
  const keys = sides.flatMap((side, s) => ['angle_deg', 'saw_tilt_deg'].filter((key) => faces[s]?.some((face) => key in face)).map((key) => ({side, s, key})));
  const head = ({side, key}: {side: Side; key: string}): Term => ({
    text: `${t('{part}: {text}', {part: choice(side), text: label(key, 'faces')})} °`,
    about: about(key, 'faces'),
  });
  const value = (row: Row | undefined, key: string) => (row && key in row ? shown(key, Number(row[key])) : '–');
  return {
    id: 'faces',
    title: sentence(label('faces')),
    head: [
      label('face'),
      {text: `${label('length_mm')} mm`, about: about('face_mm', 'side_lengths')},
      ...keys.map(head),
      {text: `${label('corner_mm', 'side_lengths')} mm`, about: about('corner_mm', 'side_lengths')},
    ],
    rows: [0, 1, 2, 3].map((i) => [
      String(i + 1),
      shown('length_mm', column(lengths['face_mm'])[i] as number),
      ...keys.map(({s, key}) => value(faces[s]?.[i], key)),
      shown('length_mm', column(lengths['corner_mm'])[i] as number),
    ]),
  };
}

/** The edges of all cut-outs, slightly outside: the first of each group, and the others moved from it. */
export function openingsOf(section: Row, result: Row): Vector[][] {
  return rowsOf(result['cutouts']).flatMap((group) => {
    const points = group['points'] as Row;
    const [girth, z] = [column(points['girth_mm']), column(points['z_mm'])];
    const instances = rowsOf(group['instances']);
    const [first] = instances as [Row];
    return instances.map((each) =>
      girth.map((at, i): Vector => {
        const [x, y] = outside(section, at + Number(each['girth_mm']) - Number(first['girth_mm']));
        return [1.002 * x, 1.002 * y, (z[i] as number) + Number(each['z_mm']) - Number(first['z_mm'])];
      }),
    );
  });
}

/** The member on its side, face 1 up, its start to the left. */
function solidOf(request: Row, result: Row, sizes: Sizes): Solid {
  const section = result['section'] as Row;
  const points = sides.map((side) => ((result['ends'] as Row)[side] as Row)['points'] as Row) as [Row, Row];
  const edges = points.map((each) => edgesOf(section, each)) as [[Vector[], Vector[]], [Vector[], Vector[]]];
  const walls = [0, 1].map((of) =>
    wallBetween(
      Number(section['girth_mm']),
      ...(points.map((each, i) => ({girth: column(each['girth_mm']), at: (edges[i] as Vector[][])[of] as Vector[]})) as [Curve, Curve]),
    ),
  ) as [[Vector[], Vector[]], [Vector[], Vector[]]];
  const [low, high] = bounds(edges.flat(2).map((p) => p[2]));
  const across = 2 * bounds(edges.flat(2).map((p) => Math.hypot(p[0], p[1])))[1];
  const gaps = points.map(gapsOf);
  const most = pressed(request) ? gaps.reduce((a, each) => Math.max(a, each?.most ?? 0), 0) : 0;
  const b = points.map((each) => column(each['b_deg']));
  const openings = openingsOf(section, result);
  return {
    link: 'part',
    tubes: [],
    openings,
    closed: true,
    ribbons: [
      {a: walls[0][0], b: walls[0][1], tone: 'steel'},
      {a: walls[1][0], b: walls[1][1], tone: 'bore'},
      ...edges.map(([outer, inner], i) => ({
        a: inner,
        b: outer,
        tone: 'bevel',
        ...(pressed(request) ? {gaps: {...(gaps[i] ?? {inner: inner.map(() => 0), outer: outer.map(() => 0)}), most}} : {bevel: b[i] as number[]}),
      })),
    ],
    ...(pressed(request) ? {scale: gapScale(most)} : tinted(b.flat())),
    lines: [
      ...edges.flat().map((points) => ({points, tone: 'edge'})),
      ...openings.map((points) => ({points: [...points, points[0] as Vector], tone: 'edge'})),
      ...rowsOf(result['marks'])
        .filter((mark) => mark['kind'] === 'datum_line')
        .map((mark) => {
          const [x, y] = outside(section, Number(mark['girth_mm']));
          return {points: [mark['z_from_mm'], mark['z_to_mm']].map((z): Vector => [1.002 * x, 1.002 * y, Number(z)]), tone: 'mark'};
        }),
      ...strokesOf(result, Math.max(0.5, 0.05 * Number(section['corner_radius_mm'])), (girth, z): Vector => {
        const whole = girthOf(section);
        const [x, y] = outside(section, ((girth % whole) + whole) % whole);
        return [1.002 * x, 1.002 * y, z];
      }).map((points) => ({points, tone: 'mark'})),
    ],
    partners: partnersOf(request, result, across, sizes),
    centre: [0, 0, (low + high) / 2],
    size: Math.max(1.35 * across, 0.86 * (high - low + across)),
    eye: [0.55, 1, -0.45],
    up: [1, 0, 0],
  };
}
type Curve = Parameters<typeof wallBetween>[1];

/** The cutters of both ends, where they are in the part's frame. Each is given in its end's own: z into the member, x along the height. */
export function partnersOf(request: Row, result: Row, across: number, sizes: Sizes): Partner[] {
  const to = frame(result['frame']) as Frame;
  const length = Number((result['lengths'] as Row)['work_point_mm']);
  const own: Record<Side, Frame> = {
    start: {origin: [0, 0, 0], x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]},
    finish: {origin: [0, 0, length], x: [1, 0, 0], y: [0, -1, 0], z: [0, 0, -1]},
  };
  return sides.flatMap((side) => {
    const [low, high] = bounds(column((((result['ends'] as Row)[side] as Row)['points'] as Row)['z_outer_mm']));
    const z = placed(to, [0, 0, (low + high) / 2])[2];
    const near: Vector = [0, 0, side === 'start' ? z : length - z];
    return rowsOf(askedOf(request, side)['cutters']).map((row, i) => seenFrom(to, placedFrom(own[side], partner(row, i, near, 1.3 * across, sizes))));
  });
}
