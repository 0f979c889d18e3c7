import {isRow, rowsOf, type Json, type Row} from './json';
import {t} from './language';
import {column} from './picture';
import {without, type Context} from './pictures/context';
import {tube} from './pictures/geometry';
import type {Contract} from './schema';
import {path, type Answer} from './service';
import {choice} from './words';

/** A job that an answer leads to. */
export interface Lead {
  name: string;
  endpoint: string;
  body: Row;
}

/** Default cut of a member. */
export const usualCut: Row = {
  root_surface: 'inner',
  groove: {rule: 'half_dihedral'},
  kerf_mm: 1.5,
  smoothing: {method: 'envelope', limits: {machine: 'five_axis_cutter', speed_mm_min: 600}},
};
export const usualMotion: Row = {machine: 'five_axis_cutter', motion: {speed: {mm_min: 600}}};

/** The type of machines that move the torch across the tube, as tubes that are not round require. */
export const acrossTube = 'tube_table';

/** How a section is cut: on a machine that swings the torch if a bevel needs it. If the service has none, undefined. */
export function sectionMotion(bevels: number[], machines: Context['machines']): Row | undefined {
  const swings = (machine: Row) => rowsOf(machine['axes']).some(({name}) => name === 'B');
  const square = bevels.every((b) => Math.abs(b) < 1e-6);
  const found = [...machines].find(([, machine]) => machine['type'] === acrossTube && (square || swings(machine)));
  return found && {...usualMotion, machine: found[0]};
}

const ofEnd = ['cutters', 'root_surface', 'groove', 'contact', 'root_face_mm', 'root_gap_mm', 'coating_mm', 'smoothing'];
const ofPart = ['preset', 'reference', 'kerf_mm', 'sampling', 'torch'];
const ofContour = ['phi_deg', 'b_deg', 'beam_mm', 'torch_inner_mm', 'torch_outer_mm', 'corner'];

const picked = (row: Row, keys: string[]): Row => Object.fromEntries(keys.flatMap((key) => (key in row ? [[key, row[key] as Json]] : [])));

/** Where an answer leads: from curve to cut, from cut to part and pulses, from groove to mill path and on. */
export function leadsOf(endpoint: string, body: Row, answer: Answer, {sizes, machines}: Pick<Context, 'sizes' | 'machines'>, contract: Contract): Lead[] {
  const own = without(body);
  if (endpoint === 'intersections')
    return [{name: t('Cut and bevel'), endpoint: 'bevel-tables', body: {...picked(own, ['target', 'cutters', 'node']), ...usualCut}}];
  const round = !isRow(answer.result['section']);
  // Those for comparison only (`inward`) are cut by no machine.
  if (endpoint === 'bevel-tables' && answer.result['b_sign'] !== 'inward') {
    const motion = round ? usualMotion : sectionMotion(bevelsOf(answer.result), machines);
    return [
      {name: t('Part'), endpoint: 'parts', body: partOf(body, answer.result)},
      ...(motion ? [{name: t('Pulses'), endpoint: 'pulse-schedules', body: {cut: own, ...motion}}] : []),
    ];
  }
  if (endpoint === 'parts') return round ? pulsesOf(answer, sizes) : sectionPulses(own, answer, machines);
  if (endpoint === 'grooves') {
    const schema = contract.request(path('mill-paths')) ?? {};
    return [{name: t('Mill path'), endpoint: 'mill-paths', body: contract.make(schema, {groove: own}) as Row}];
  }
  if (endpoint === 'mill-paths') return [{name: t('Pulses'), endpoint: 'pulse-schedules', body: {mill_path: own, ...usualMotion, machine: 'cone_mill'}}];
  return [];
}

/** The member of a node, or the tube that is cut, square at its other end and a little longer than the cut is high. */
function partOf(body: Row, result: Row): Row {
  const shared = picked(body, ofPart);
  if (isRow(body['node'])) return {...picked(body['node'], ['members', 'connect', 'member']), ...picked(body, ofEnd), ...shared};
  const points = result['points'] as Row;
  const high = [...column(points['z_outer_mm']), ...column(points['z_inner_mm'])].reduce((a, b) => Math.max(a, b), 0);
  const length = Math.ceil((high + Number(result['developed_length_mm'])) / 50) * 50;
  return {target: {...(body['target'] as Row), length_mm: length}, ends: {start: picked(body, ofEnd), finish: {square_at_mm: 0}}, ...shared};
}

export const bevelsOf = (end: Row) => column((end['points'] as Row)['b_deg']);

/** The pulses of each end that others cut: the end is a cut of its own, in its own frame. */
function sectionPulses(body: Row, {result}: Answer, machines: Context['machines']): Lead[] {
  if (!isRow(body['target'])) return [];
  const {length_mm: _, ...target} = body['target'];
  return Object.entries(isRow(body['ends']) ? body['ends'] : {}).flatMap(([side, end]) => {
    const motion = sectionMotion(bevelsOf((result['ends'] as Row)[side] as Row), machines);
    if (!motion || !isRow(end) || !rowsOf(end['cutters']).length) return [];
    const cut: Row = {...picked(body, [...ofEnd, ...ofPart]), ...picked(end, ofEnd), target};
    return [{name: t('Pulses, {end}', {end: choice(side)}), endpoint: 'pulse-schedules', body: {cut: without(cut), ...motion}}];
  });
}

/** The pulses of each end that others cut. */
function pulsesOf({request, result}: Answer, sizes: Context['sizes']): Lead[] {
  const {outer, wall} = tube(request['target'] ?? rowsOf(request['members']).find((each) => each['id'] === request['member']), sizes);
  return Object.entries(result['ends'] as Row).flatMap(([side, given]) => {
    const end = given as Row;
    if (Number(end['weld_mm']) === 0) return []; // square
    const contour: Row = {...picked(end, ['surface', 'scrap', 'b_sign']), outer_diameter_mm: outer, wall_mm: wall, closed: true};
    return [
      {
        name: t('Pulses, {end}', {end: choice(side)}),
        endpoint: 'pulse-schedules',
        body: {contour: {...contour, points: picked(end['points'] as Row, ofContour)}, ...usualMotion},
      },
    ];
  });
}
