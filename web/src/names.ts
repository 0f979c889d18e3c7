import {later, t} from './language';
import {tasks} from './tasks';
import {sentence} from './words';

/** Names of the pages, in their order. */
const endpointNames: Record<string, string> = {
  'bevel-tables': later('Cut and bevel'),
  intersections: later('Intersection'),
  nodes: later('Node'),
  holes: later('Hole'),
  parts: later('Part'),
  frames: later('Frame'),
  'pulse-schedules': later('Pulses'),
  replays: later('Replay'),
  'feed-curves': later('Feed curve'),
  grooves: later('Groove'),
  'mill-paths': later('Mill path'),
};
export const endpointOrder = tasks.flatMap(({endpoints}) => endpoints);
export const endpointName = (id: string) => t(endpointNames[id] ?? sentence(id.replace(/-/g, ' ')));

/** Names of examples whose file names are not self-explanatory. */
const exampleNames: Record<string, string> = {
  'bevel-tables/source-000-table-1': later('Four tubes at one node, from a published table'),
  'bevel-tables/source-000-table-1-as-published': later('The same four tubes, with the published angles'),
  'bevel-tables/source-002-offset-pair': later('A branch off its chord’s axis'),
  'bevel-tables/k-joint-from-centre-lines': later('A brace of a K joint, from centre-lines'),
  'bevel-tables/mitre': later('A mitre: two tubes end at a plane'),
  'bevel-tables/table-1-five-axis-at-600-mm-min': later('Four tubes, within a machine’s speeds'),
  'bevel-tables/table-1-torch-45-deg': later('Four tubes, a torch that leans 45°'),
  'bevel-tables/tube-laser-branch': later('A branch cut square by a tube laser'),
  'bevel-tables/shs-brace-on-shs-chord': later('A square brace on a square chord'),
  'bevel-tables/zones': later('Groove angles by a welding code’s zones'),
  'intersections/source-000-table-1': later('Four tubes at one node, from a published table'),
  'intersections/shs-k-joint': later('A square tube, a round chord and a brace'),
  'intersections/two-tubes-by-axis': later('Two tubes, given by their axes'),
  'nodes/source-002-offset-pair': later('A branch off its chord’s axis'),
  'nodes/k-joint-from-centre-lines': later('A K joint, from centre-lines'),
  'nodes/k-joint-with-tables': later('A K joint, with the tables of its cuts'),
  'frames/rhs-gate': later('A gate of rectangular tubes by a tube laser'),
  'frames/sign-frame-with-tab-and-slot': later('A sign frame with tabs and slots'),
  'frames/shelf-arms-on-a-round-post': later('Shelf arms with tabs on a round post'),
  'frames/rhs-trailer': later('A trailer frame of rectangular tubes'),
  'frames/rhs-rack': later('A storage rack of square and rectangular tubes'),
  'frames/rhs-truss-with-gap-k-joints': later('A truss of square tubes with gap K joints'),
  'nodes/rhs-t-joint': later('A rectangular post and a round brace on a rectangular chord'),
  'nodes/stated-mitre': later('A mitre, stated by a member'),
  'parts/table-1-with-a-square-far-end': later('A tube cut by four others, its far end square'),
  'parts/k-joint-brace': later('A brace of a K joint'),
  'parts/chord-with-holes': later('A chord with two holes'),
  'parts/base-post': later('A base post with bolt holes, drain and window'),
  'parts/rack-upright': later('A rack upright with staggered slots'),
  'parts/perforated-tube': later('A perforated tube'),
  'parts/chs-brace-with-gusset-slits': later('A brace with slits for gussets'),
  'parts/rhs-door-frame-with-countersinks': later('A door jamb with countersunk holes and a slit'),
  'parts/shs-gate-post': later('A gate post with vent holes at its corners'),
  'parts/shs-chord-with-branches-over-corners': later('A square rail with branches over its corners'),
  'parts/tube-laser-chord': later('A chord cut square by a tube laser'),
  'parts/gate-rail-of-60x40-mitred': later('A gate rail of 60 × 40, mitred'),
  'frames/jacket-node-with-set-in-stubs': later('A jacket node with set-in stubs'),
  'frames/k-node-with-plate-and-square-brace': later('A K node with a plate and a square brace'),
  'frames/roll-cage-of-12': later('A roll cage of 12 members'),
  'frames/truss-of-19': later('A truss of 19 members'),
  'pulse-schedules/table-1-on-the-five-axis-cutter': later('Four tubes on the five-axis cutter'),
  'pulse-schedules/source-000-table-1-before-and-after': later('Why a plan: jumps of B at full speed'),
  'pulse-schedules/source-001-mill-path': later('A groove on the cone mill'),
  'pulse-schedules/source-002-offset-pair-on-the-crawler': later('A branch on the crawler'),
  'pulse-schedules/square-tube-on-a-tube-table': later('A square tube on a tube table'),
  'pulse-schedules/square-post-on-a-tube-table': later('A whole square post on a tube table'),
  'pulse-schedules/two-ends-and-four-holes-of-a-part': later('A whole part: two ends and four holes'),
  'feed-curves/source-004-table-1-as-printed': later('A published feed curve, as printed'),
  'feed-curves/source-004-table-1-as-solved': later('A published feed curve, as solved'),
  'feed-curves/source-004-table-3-as-printed': later('Published feed curve, three points, as printed'),
  'feed-curves/source-004-table-3-as-solved': later('Published feed curve, three points, as solved'),
  'feed-curves/cut-off-194-mm-whole-cycle': later('A tube of 194 mm cut off, whole cycle'),
};
const kept: [RegExp, string][] = [
  [/^case ([a-z]) /, 'case $1: '],
  [/(\d+) mm min/g, '$1 mm/min'],
  [/(\d+) deg\b/g, '$1°'],
];
export const exampleName = (endpoint: string, name: string) =>
  t(exampleNames[`${endpoint}/${name}`] ?? sentence(kept.reduce((text, [from, to]) => text.replace(from, to), name.replace(/-/g, ' '))));

/** Heads of the narrow columns of a list of tubes. */
const short: Record<string, string> = {outer_diameter_mm: 'Ø', inclination_deg: later('incl.'), clocking_deg: later('clock')};
export const brief = (name: string, otherwise: string) => short[name] ?? otherwise;

/** Tabs under the pictures. */
export const tabs: [string, string][] = [
  ['proof', later('Proof')],
  ['motion', later('Pulses and speed')],
  ['table', later('Table')],
  ['json', 'JSON'],
  ['downloads', later('Files')],
];
