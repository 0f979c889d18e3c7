import {isRow, rowsOf, type Row} from '../json';
import {many, t} from '../language';
import {pressed} from '../preset';
import {column, type EndCurve, type Frame, type HoledTube, type Partner, type Picture, type Solid} from '../picture';
import type {Answer} from '../service';
import {choice, sentence, sentences, withUnit} from '../words';
import type {Context} from './context';
import {rangeOf, tablePicture, tinted} from './cut';
import {figures} from './facts';
import {gapScale, gapsOf, webFigures} from './gaps';
import {table} from './generic';
import {bounds, frame, onTube, partner, placed, radians, seenFrom, strokesOf, tube, type Sizes} from './geometry';
import {holeCharts, opening} from './hole';
import {isSection} from './section';
import {sectionPart} from './section_part';

const member = (request: Row, id: unknown) => rowsOf(request['members']).find((each) => each['id'] === id);

/** A whole member: lengths, check dimensions, and each end as the table it is. */
export async function part(_: Row, answer: Answer, context: Context): Promise<Picture> {
  if (isSection(answer)) return sectionPart(answer, context.sizes);
  const {result, request} = answer;
  const {outer, wall} = tube(request['target'] ?? member(request, request['member']), context.sizes);
  const ends = result['ends'] as Row;
  const given = isRow(request['ends']) ? request['ends'] : {};
  const holes = rowsOf(result['holes']);
  const charts = Object.entries(ends).flatMap(([side, end]) => {
    const own = end as Row;
    const asked: Row = {...request, ...(isRow(given[side]) ? given[side] : {})};
    const cutters = rowsOf(asked['cutters']).map((each, i) => String(each['id'] ?? t('partner {n}', {n: i + 1})));
    const names = cutters.length ? cutters : ((own['cutter_ids'] ?? []) as string[]);
    if (!names.length) return []; // square: nothing to draw over phi
    const drawn = tablePicture(asked, own, {outer, wall, cutters: [], names}, context.sizes, `cut-${side}`);
    return drawn.charts.map((chart) => ({...chart, id: `${chart.id}-${side}`, title: t('{part}: {text}', {part: sentence(choice(side)), text: chart.title})}));
  });
  return {
    solid: solidOf(request, result, {outer, wall}, context.sizes),
    charts: [...charts, ...holes.flatMap((hole, i) => holeCharts(hole, i, holes.length, outer / 2))],
    figures: [...webFigures(result), ...figures(result['lengths'] as Row, Object.keys(result['lengths'] as Row))],
    said: said(
      result,
      holes.length,
      rowsOf(result['cutouts']).reduce((sum, group) => sum + rowsOf(group['instances']).length, 0),
    ),
    tables: ['check_dimensions', 'sequence'].filter((key) => rowsOf(result[key]).length).map((key) => table(key, rowsOf(result[key]))),
  };
}

/** "Cut to 812.4 mm, with two holes. Start: B from ..." */
function said(result: Row, holes: number, openings: number): string {
  const lengths = result['lengths'] as Row;
  const ends = Object.entries(result['ends'] as Row).map(([side, end]) => endSaid(side, endCurve(end as Row).b ?? []));
  const first = [
    t('{length} from tip to tip', {length: withUnit(Number(lengths['long_mm']), 'mm')}),
    ...(holes ? [many(holes, '{n} hole', '{n} holes')] : []),
    ...(openings ? [many(openings, '{n} cut-out', '{n} cut-outs')] : []),
  ];
  return sentences(t('{text}.', {text: first.join(t(', '))}), ...ends);
}

/** "Start: B from 18.7 to 72.6°." */
const endSaid = (side: string, b: number[]) => t('{part}: {text}.', {part: sentence(choice(side)), text: rangeOf(b)});

function endCurve(end: Row): EndCurve {
  const points = end['points'] as Row;
  const gaps = gapsOf(points);
  return {phi: column(points['phi_deg']), zInner: column(points['z_inner_mm']), zOuter: column(points['z_outer_mm']), b: column(points['b_deg']), gaps};
}

const endsOf = (result: Row): [EndCurve, EndCurve] => {
  const ends = result['ends'] as Row;
  return [endCurve(ends['start'] as Row), endCurve(ends['finish'] as Row)];
};
/** From where to where it goes along its axis. */
export const reach = (from: EndCurve, to: EndCurve) => bounds([...from.zInner, ...from.zOuter, ...to.zInner, ...to.zOuter]);

/** Cut-outs that a mesh has as holes; of more, only the edges are drawn. */
const mostOpen = 200;

/** Every cut-out of the answer: the first of each group, and the others moved from it. */
function cutouts(result: Row): HoledTube['holes'] {
  return rowsOf(result['cutouts']).flatMap((group) => {
    const first = opening(group['points'] as Row);
    const instances = rowsOf(group['instances']);
    const [phi, z] = ['phi_deg', 'z_mm'].map((key) => Number((instances[0] as Row)[key])) as [number, number];
    return instances.map((each) => {
      const moved = (edge: {phi: number[]; z: number[]}) => ({
        phi: edge.phi.map((at) => at + Number(each['phi_deg']) - phi),
        z: edge.z.map((at) => at + Number(each['z_mm']) - z),
      });
      return {...first, outer: moved(first.outer), inner: moved(first.inner)};
    });
  });
}
const open = (all: HoledTube['holes']) => (all.length > mostOpen ? [] : all);

/** The finished part in its own frame. */
export function finished(result: Row, {outer, wall}: {outer: number; wall: number}): HoledTube {
  const [from, to] = endsOf(result);
  const holes = rowsOf(result['holes']).map((hole) => opening(hole['points'] as Row));
  return {outer: outer / 2, inner: outer / 2 - wall, from, to, holes: [...holes, ...open(cutouts(result))]};
}

/** The member on its side, the datum line up, its start to the left. */
function solidOf(request: Row, result: Row, {outer, wall}: {outer: number; wall: number}, sizes: Sizes): Solid {
  const [from, to] = endsOf(result);
  const [low, high] = reach(from, to);
  const openings = rowsOf(result['holes']).map((hole) => ({...opening(hole['points'] as Row), fit: hole['fit_up'] as Row}));
  const cuts = laser(request, [from, to], openings);
  const own = cutouts(result);
  const flat = ({phi}: {phi: number[]}) => ({inner: phi.map(() => 0), outer: phi.map(() => 0), most: cuts?.most ?? 0});
  const holes = [
    ...openings.map((hole, i) => ({...hole, gaps: cuts?.holes[i]})),
    ...open(own).map((each) => ({...each, gaps: cuts ? flat(each.outer) : undefined})),
  ];
  const edges = own.length > mostOpen ? own : [];
  const datum = rowsOf(result['marks']).filter((mark) => mark['kind'] === 'datum_line');
  return {
    link: 'part',
    tubes: [],
    holed: [{outer: outer / 2, inner: outer / 2 - wall, from: {...from, gaps: cuts?.ends[0]}, to: {...to, gaps: cuts?.ends[1]}, holes}],
    ...(cuts ? {scale: gapScale(cuts.most)} : tinted([from, to, ...openings].flatMap(({b}) => b ?? []))),
    lines: [
      ...datum.map((mark) => ({
        points: [mark['z_from_mm'], mark['z_to_mm']].map((z) => onTube(1.002 * (outer / 2), Number(mark['phi_deg']), Number(z))),
        tone: 'mark' as const,
      })),
      ...strokesOf(result, 0.025 * outer, (girth, z) => onTube(1.002 * (outer / 2), girth / (outer / 2) / radians, z)).map((points) => ({
        points,
        tone: 'mark' as const,
      })),
      ...edges.map(({outer: edge}) => ({
        points: [...edge.phi, edge.phi[0] as number].map((phi, i) => onTube(1.002 * (outer / 2), phi, edge.z[i % edge.z.length] as number)),
        tone: 'mark' as const,
      })),
    ],
    partners: partners(request, result, outer, sizes),
    centre: [0, 0, (low + high) / 2],
    size: Math.max(1.35 * outer, 0.86 * (high - low + outer)),
    eye: [0.55, 1, -0.45],
    up: [1, 0, 0],
  };
}

/**
 * Returns the gaps of every cut on one scale, for a part that is cut square; an end without a weld
 * has no gaps.
 */
function laser(request: Row, ends: EndCurve[], holes: {fit: Row}[]) {
  if (!pressed(request)) return undefined;
  const fits = holes.map(({fit}) => ({inner: column(fit['root_mm']), outer: column(fit['face_mm'])}));
  const all = [...ends.flatMap(({gaps}) => gaps ?? []), ...fits];
  const most = all.reduce((a, {inner, outer}) => Math.max(a, ...bounds([...inner, ...outer])), 0);
  const scaled = (gaps: {inner: number[]; outer: number[]}) => ({...gaps, most});
  const none = ({phi}: EndCurve) => ({inner: phi.map(() => 0), outer: phi.map(() => 0)});
  return {most, ends: ends.map((end) => scaled(end.gaps ?? none(end))), holes: fits.map(scaled)};
}

/** The tubes that cut the ends, and those whose holes it has, where they are in the part's frame. */
function partners(request: Row, result: Row, outer: number, sizes: Sizes): Partner[] {
  const to = frame(result['frame']) as Frame;
  if ((result['frame'] as Row)['in'] === 'start') {
    const start = (request['ends'] as Row)['start'] as Row;
    return rowsOf(start['cutters']).map((row, i) => seenFrom(to, partner(row, i, placed(to, [0, 0, 0]), 2 * outer, sizes)));
  }
  const places = [
    ...Object.values(result['ends'] as Row).flatMap((end) => {
      const z = bounds(endCurve(end as Row).zOuter);
      return (((end as Row)['cutter_ids'] ?? []) as string[]).map((id) => ({id, z: (z[0] + z[1]) / 2}));
    }),
    ...rowsOf(result['holes']).map((hole) => {
      const z = bounds(column((hole['points'] as Row)['z_mm']));
      return {id: hole['branch'], z: (z[0] + z[1]) / 2};
    }),
  ];
  return places.flatMap(({id, z}, i) => {
    const other = member(request, id);
    if (!other) return [];
    const [start, end] = [column(other['start_mm']), column(other['end_mm'])];
    const row = {...other, kind: 'tube', axis: {point_mm: start, direction: end.map((v, k) => v - (start[k] as number))}};
    return [seenFrom(to, partner(row, i, placed(to, [0, 0, z]), 2 * outer, sizes))];
  });
}
