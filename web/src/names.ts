import {tasks} from './tasks';
import {sentence} from './words';

/** Names of the pages, in their order. */
const endpointNames: Record<string, string> = {
  'bevel-tables': 'Cut and bevel',
  intersections: 'Intersection',
  nodes: 'Node',
  holes: 'Hole',
  parts: 'Part',
  frames: 'Frame',
  'pulse-schedules': 'Pulses',
  replays: 'Replay',
  'feed-curves': 'Feed curve',
  grooves: 'Groove',
  'mill-paths': 'Mill path',
};
export const endpointOrder = tasks.flatMap(({endpoints}) => endpoints);
export const endpointName = (id: string) => endpointNames[id] ?? sentence(id.replace(/-/g, ' '));

/** Names of examples whose file names are not self-explanatory. */
const exampleNames: Record<string, string> = {
  'bevel-tables/source-000-table-1': 'Four tubes at one node, from a published table',
  'bevel-tables/source-000-table-1-as-published': 'The same four tubes, with the published angles',
  'bevel-tables/source-002-offset-pair': 'A branch off its chord’s axis',
  'bevel-tables/k-joint-from-centre-lines': 'A brace of a K joint, from centre-lines',
  'bevel-tables/mitre': 'A mitre: two tubes end at a plane',
  'bevel-tables/table-1-five-axis-at-600-mm-min': 'Four tubes, within a machine’s speeds',
  'bevel-tables/table-1-torch-45-deg': 'Four tubes, a torch that leans 45°',
  'bevel-tables/tube-laser-branch': 'A branch cut square by a tube laser',
  'bevel-tables/shs-brace-on-shs-chord': 'A square brace on a square chord',
  'bevel-tables/zones': 'Groove angles by a welding code’s zones',
  'intersections/source-000-table-1': 'Four tubes at one node, from a published table',
  'intersections/shs-k-joint': 'A square tube, a round chord and a brace',
  'intersections/two-tubes-by-axis': 'Two tubes, given by their axes',
  'nodes/source-002-offset-pair': 'A branch off its chord’s axis',
  'nodes/k-joint-from-centre-lines': 'A K joint, from centre-lines',
  'nodes/k-joint-with-tables': 'A K joint, with the tables of its cuts',
  'frames/rhs-gate': 'A gate of rectangular tubes by a tube laser',
  'frames/rhs-trailer': 'A trailer frame of rectangular tubes',
  'frames/rhs-rack': 'A storage rack of square and rectangular tubes',
  'frames/rhs-truss-with-gap-k-joints': 'A truss of square tubes with gap K joints',
  'nodes/rhs-t-joint': 'A rectangular post and a round brace on a rectangular chord',
  'nodes/stated-mitre': 'A mitre, stated by a member',
  'parts/table-1-with-a-square-far-end': 'A tube cut by four others, its far end square',
  'parts/k-joint-brace': 'A brace of a K joint',
  'parts/chord-with-holes': 'A chord with two holes',
  'parts/base-post': 'A base post with bolt holes, drain and window',
  'parts/rack-upright': 'A rack upright with staggered slots',
  'parts/perforated-tube': 'A perforated tube',
  'parts/tube-laser-chord': 'A chord cut square by a tube laser',
  'parts/gate-rail-of-60x40-mitred': 'A gate rail of 60 × 40, mitred',
  'frames/jacket-node-with-set-in-stubs': 'A jacket node with set-in stubs',
  'frames/k-node-with-plate-and-square-brace': 'A K node with a plate and a square brace',
  'frames/roll-cage-of-12': 'A roll cage of 12 members',
  'frames/truss-of-19': 'A truss of 19 members',
  'pulse-schedules/table-1-on-the-five-axis-cutter': 'Four tubes on the five-axis cutter',
  'pulse-schedules/source-000-table-1-before-and-after': 'Why a plan: jumps of B at full speed',
  'pulse-schedules/source-001-mill-path': 'A groove on the cone mill',
  'pulse-schedules/source-002-offset-pair-on-the-crawler': 'A branch on the crawler',
  'pulse-schedules/square-tube-on-a-tube-table': 'A square tube on a tube table',
  'pulse-schedules/two-ends-and-four-holes-of-a-part': 'A whole part: two ends and four holes',
  'feed-curves/source-004-table-1-as-printed': 'A published feed curve, as printed',
  'feed-curves/source-004-table-1-as-solved': 'A published feed curve, as solved',
  'feed-curves/source-004-table-3-as-printed': 'Published feed curve, three points, as printed',
  'feed-curves/source-004-table-3-as-solved': 'Published feed curve, three points, as solved',
  'feed-curves/cut-off-194-mm-whole-cycle': 'A tube of 194 mm cut off, whole cycle',
};
const kept: [RegExp, string][] = [
  [/^case ([a-z]) /, 'case $1: '],
  [/(\d+) mm min/g, '$1 mm/min'],
  [/(\d+) deg\b/g, '$1°'],
];
export const exampleName = (endpoint: string, name: string) =>
  exampleNames[`${endpoint}/${name}`] ?? sentence(kept.reduce((text, [from, to]) => text.replace(from, to), name.replace(/-/g, ' ')));

/** Heads of the narrow columns of a list of tubes. */
const short: Record<string, string> = {outer_diameter_mm: 'Ø', inclination_deg: 'incl.', clocking_deg: 'clock'};
export const brief = (name: string, otherwise: string) => short[name] ?? otherwise;

/** Tabs under the pictures. */
export const tabs: [string, string][] = [
  ['proof', 'Proof'],
  ['motion', 'Pulses and speed'],
  ['table', 'Table'],
  ['json', 'JSON'],
  ['downloads', 'Files'],
];
