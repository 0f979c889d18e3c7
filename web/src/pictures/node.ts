import {isRow, type Row} from '../json';
import {column, type CutTube, type Picture, type Vector} from '../picture';
import type {Answer} from '../service';
import {choice, term} from '../words';
import {plural, text} from './facts';
import type {Context} from './context';
import {add, bounds, frame, placed, plainTube, tube, vector} from './geometry';
import {atPhi} from './cut';

/** The whole node in the world, every end as it is cut. */
export async function node(body: Row, answer: Answer, context: Context): Promise<Picture> {
  const members = body['members'] as Row[];
  let ends = answer.result['ends'] as Row[];
  if (!body['include']) {
    // the curves are for the picture only
    const whole = await context.ask('nodes', {...body, include: ['profiles']});
    ends = whole.result['ends'] as Row[];
  }
  const cut = ends.filter((end) => (end['cut_by'] as Row[]).length > 0);
  const biggest = Math.max(...members.map((member) => tube(member, context.sizes).outer));
  const tubes = ends.map((end) => endTube(end, members, context));
  const centre = middle(cut.length ? cut : ends);
  return {
    solid: {link: 'node', tubes, partners: [], centre, size: 2.7 * biggest, eye: [0.3, -1, 0.4], up: [0, 0, 1]},
    charts: [],
    said: `${plural(members.length, 'member')}, ${plural(cut.length, 'end')} cut, ${plural(ends.filter((e) => e['free']).length, 'free end')}.`,
    figures: [
      {name: 'members', value: String(members.length)},
      {name: 'cut ends', value: String(cut.length)},
      {name: 'free ends', value: String(ends.filter((e) => e['free']).length)},
    ],
    tables: [
      {
        title: 'Who cuts whom',
        head: ['member', 'end', 'cut by', ...placed4.map((key) => term(key)), term('gap_mm'), term('eccentricity_mm')],
        rows: cut.flatMap((end) =>
          (end['cut_by'] as Row[]).map((by) => {
            const p = by['placement']; // a mitre is by a plane
            return [
              String(end['member']),
              choice(end['end']),
              String(by['member']),
              ...placed4.map((key) => (isRow(p) ? text(key, p[key]) : '–')),
              text('gap_mm', by['gap_mm']),
              text('eccentricity_mm', by['eccentricity_mm']),
            ];
          }),
        ),
      },
    ],
  };
}

const placed4 = ['inclination_deg', 'clocking_deg', 'offset_mm', 'height_mm'];

function endTube(end: Row, members: Row[], context: Context): CutTube {
  const index = members.findIndex((member) => member['id'] === end['member']);
  const member = members[index] as Row;
  const {outer, wall} = tube(member, context.sizes);
  const length = Math.hypot(...add(vector(member['end_mm']), vector(member['start_mm']), -1));
  const to = frame(end['frame']);
  const profiles = (end['profiles'] ?? []) as Row[];
  const outside = profiles.find((p) => p['surface'] === 'outer'),
    inside = profiles.find((p) => p['surface'] === 'inner');
  const far = length / 2; // half a member belongs to each of its ends
  if (!outside || !inside) return plainTube(outer, wall, far, index, to);
  const points = outside['points'] as Row;
  const phi = column(points['phi_deg']),
    zOuter = column(points['z_mm']),
    zInner = atPhi(inside['points'] as Row, phi);
  return {
    ...(to ? {frame: to} : {}),
    outer: outer / 2,
    inner: outer / 2 - wall,
    phi,
    zOuter,
    zInner,
    far: Math.max(far, bounds([...zOuter, ...zInner])[1] + outer * 0.2),
    marks: [],
    tone: index,
  };
}

function middle(ends: Row[]): Vector {
  const points = ends.map((end) => {
    const profile = ((end['profiles'] ?? []) as Row[])[0];
    const z = profile ? bounds(column((profile['points'] as Row)['z_mm'])) : [0, 0];
    return placed(frame(end['frame']), [0, 0, ((z[0] as number) + (z[1] as number)) / 2]);
  });
  return points.reduce<Vector>((sum, p) => add(sum, p, 1 / points.length), [0, 0, 0]);
}
