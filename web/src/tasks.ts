import {later} from './language';

/** The tasks of a user, in the order of the pages: each with its endpoints and the examples to begin with. */
export interface Task {
  id: string;
  name: string;
  about: string;
  endpoints: string[];
  examples: string[];
}

export const tasks: Task[] = [
  {
    id: 'joint',
    name: later('A joint'),
    about: later('One end of a tube, cut to fit the tubes that it meets: bevel table, template, weld groove.'),
    endpoints: ['bevel-tables', 'intersections', 'nodes', 'holes', 'grooves'],
    examples: ['bevel-tables/source-000-table-1', 'bevel-tables/shs-brace-on-shs-chord', 'nodes/k-joint-with-tables', 'holes/set-on-branch'],
  },
  {
    id: 'part',
    name: later('A part'),
    about: later('A whole tube with both ends, holes and cut-outs: lengths, drawings, program, CAD model.'),
    endpoints: ['parts'],
    examples: ['parts/base-post', 'parts/chord-with-holes', 'parts/gate-rail-of-60x40-mitred', 'parts/rack-upright'],
  },
  {
    id: 'frame',
    name: later('A frame'),
    about: later('All members in one job, typed or imported: cut list, warnings by member, packet for the shop.'),
    endpoints: ['frames'],
    examples: ['frames/roll-cage-of-12', 'frames/truss-of-19', 'frames/rhs-gate', 'frames/rhs-trailer'],
  },
  {
    id: 'machine',
    name: later('My machine'),
    about: later('Pulses, feed curves and mill paths within the limits of one machine, replayed before they run.'),
    endpoints: ['pulse-schedules', 'replays', 'feed-curves', 'mill-paths'],
    examples: [
      'pulse-schedules/table-1-on-the-five-axis-cutter',
      'pulse-schedules/square-tube-on-a-tube-table',
      'pulse-schedules/square-post-on-a-tube-table',
      'mill-paths/case-a-end-up',
      'feed-curves/cut-off-194-mm-whole-cycle',
    ],
  },
];

/** Items by task; those of no task, such as pages that this console does not know yet, come last. */
export function byTask<T>(items: T[], endpointOf: (item: T) => string): {task: Task | undefined; items: T[]}[] {
  const of = (task: Task | undefined) => items.filter((item) => tasks.find(({endpoints}) => endpoints.includes(endpointOf(item))) === task);
  return [...tasks, undefined].map((task) => ({task, items: of(task)})).filter(({items: own}) => own.length > 0);
}
