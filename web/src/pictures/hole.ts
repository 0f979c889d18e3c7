import type {Json, Row} from '../json';
import {later, t} from '../language';
import {column, type Chart, type HoledTube, type Picture} from '../picture';
import type {Answer} from '../service';
import {choice, number, sentence, sentences} from '../words';
import type {Context} from './context';
import {rangeOf, tinted} from './cut';
import {readings} from './facts';
import {bounds, partner, radians, squareEnd, tube} from './geometry';

export async function hole(_: Row, answer: Answer, context: Context): Promise<Picture> {
  const {request, result} = answer;
  const chord = tube(request['chord'], context.sizes);
  const holes = result['holes'] as Row[];
  const branch = request['branch'] as Row;
  const points = holes.map((each) => ascending(each['points'] as Row, each['points'] as Row));
  const z = points.flatMap((p) => column(p['z_mm']));
  const [low, high] = bounds(z);
  const first = points[0] as Row;
  const holed: HoledTube = {
    outer: chord.outer / 2,
    inner: chord.outer / 2 - chord.wall,
    from: squareEnd(low - 0.8 * chord.outer),
    to: squareEnd(high + 0.8 * chord.outer),
    holes: points.map(opening),
  };
  const middle = (low + high) / 2;
  const at = (bounds(column(first['phi_deg'])).reduce((a, b) => a + b) / 2) * radians;
  const charts = holes.flatMap((each, i) => holeCharts(each, i, holes.length, chord.outer / 2));
  return {
    solid: {
      link: 'hole-0',
      tubes: [],
      holed: [holed],
      partners: [partner({kind: 'tube', ...branch}, 0, [0, 0, middle], 1.4 * chord.outer, context.sizes)],
      ...tinted(holed.holes.flatMap((each) => each.b)),
      centre: [0, 0, middle],
      size: 1.7 * chord.outer,
      eye: [Math.cos(at - 0.5), Math.sin(at - 0.5), 0.45],
      up: [0, 0, 1],
    },
    charts,
    said: sentences(...points.map((p, i) => sentence(t('{text}.', {text: `${count(holes, i)}${rangeOf(column(p['b_deg']))}`})))),
    figures: holes.flatMap((each) => {
      const fit = each['fit_up'] as Row | undefined;
      return [
        {
          name: t('length of the {side} hole', {side: choice(each['side'])}),
          value: number(Number(each['length_mm']), 'mm'),
          unit: 'mm',
          about: t('Along its root.'),
        },
        ...(fit
          ? [
              {
                name: t('least gap'),
                value: number(Number(fit['least_between_nodes_mm']), 'mm'),
                unit: 'mm',
                about: t('Between hole and branch, across the wall.'),
              },
              {
                name: t('greatest root gap'),
                value: number(Number(fit['greatest_root_between_nodes_mm']), 'mm'),
                unit: 'mm',
                about: t('Between hole and branch, at the root.'),
              },
            ]
          : []),
      ];
    }),
    readout: (i, link) => {
      const own = points[Number(link.replace('hole-', ''))] ?? first;
      return readings(own, i, ['branch_phi_deg', 'phi_deg', 'z_mm', 'b_deg', 'dihedral_deg', 'beam_mm']);
    },
  };
}

const count = (holes: Row[], i: number) => (holes.length > 1 ? t('{side} hole: ', {side: sentence(choice((holes[i] as Row)['side']))}) : '');

export const opening = (points: Row): HoledTube['holes'][number] => ({
  outer: {phi: column(points['phi_deg']), z: column(points['z_mm'])},
  inner: {phi: column(points['phi_inner_deg']), z: column(points['z_inner_mm'])},
  b: column(points['b_deg']),
});

/** Columns in the order of the branch's phi, from 0: a far hole is cut the other way round, and from another start. */
function ascending(row: Row, points: Row): Row {
  const phi = column(points['branch_phi_deg']).map((p) => ((p % 360) + 360) % 360);
  const order = phi.map((_, i) => i).sort((a, b) => (phi[a] as number) - (phi[b] as number));
  const sorted = Object.entries(row).map(([key, values]): [string, Json] => {
    if (!Array.isArray(values)) return [key, values];
    return [key, key === 'branch_phi_deg' ? order.map((i) => phi[i] as number) : order.map((i) => values[i] as Json)];
  });
  return Object.fromEntries(sorted);
}

export function holeCharts(each: Row, i: number, count: number, radius: number): Chart[] {
  const p = ascending(each['points'] as Row, each['points'] as Row);
  const which = count > 1 ? `, ${each['branch'] ? String(each['branch']) : choice(each['side'])}` : '';
  const x = {name: later('branch φ'), unit: '°', values: column(p['branch_phi_deg'])};
  const shared = {link: `hole-${i}`, x, period: (x.values[0] as number) + 360};
  const fit = each['fit_up'] && ascending(each['fit_up'] as Row, each['points'] as Row);
  const scale = radius * radians;
  return [
    {
      id: `bevel-${i}`,
      title: `${t('Cutting angle B round the hole')}${which}`,
      ...shared,
      unit: '°',
      series: [
        {name: 'B', values: column(p['b_deg']), tone: 'after', width: 2.2},
        {name: t('groove'), values: column(p['groove_deg']), tone: 'before', dash: [5, 4]},
      ],
    },
    {
      id: `place-${i}`,
      title: `${t('Where it lies on the chord')}${which}`,
      ...shared,
      unit: 'mm',
      series: [
        {name: 'z', values: column(p['z_mm']), tone: 'outer', width: 2},
        {name: t('around'), values: column(p['phi_deg']).map((v) => v * scale), tone: 'inner'},
      ],
    },
    ...(fit
      ? [
          {
            id: `fit-${i}`,
            title: `${t('Gap to the branch')}${which}`,
            ...shared,
            unit: 'mm',
            zero: true,
            height: 150,
            series: [
              {name: t('at the root'), values: column(fit['root_mm']), tone: 'after', width: 2},
              {name: t('at the face'), values: column(fit['face_mm']), tone: 'before'},
              {name: t('least across the wall'), values: column(fit['least_mm']), tone: 'floor'},
            ],
          },
        ]
      : []),
  ];
}
