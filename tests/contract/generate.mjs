// Requests from the schemas, and requests of joints that can be made.
import {readFileSync} from 'node:fs';
import fc from 'fast-check';
import {branchOf, groups} from './edits.mjs';

const NUMERICS = Number(/numerics\(\) { return (\d+)/.exec(readFileSync(new URL('../../api/version.cpp', import.meta.url), 'utf8'))[1]);
const LONGEST = 1024;  // characters of a text; a file's belong to the tests of limits
const MANY = 6;  // elements more than the fewest; long lists belong to the tests of limits

function number({minimum, maximum, exclusiveMinimum, exclusiveMaximum}) {
  const min = minimum ?? exclusiveMinimum ?? -1e9;
  const max = maximum ?? exclusiveMaximum ?? 1e9;
  const range = {min, max, minExcluded: minimum === undefined && exclusiveMinimum !== undefined,
    maxExcluded: maximum === undefined && exclusiveMaximum !== undefined, noNaN: true};
  const inside = (value) => !(range.minExcluded && value === min) && !(range.maxExcluded && value === max);
  return fc.oneof(
    {weight: 6, arbitrary: fc.integer({min: 0, max: 4096}).map((k) => min + (max - min) * k / 4096).filter(inside)},
    {weight: 2, arbitrary: fc.double(range)},
    {weight: 1, arbitrary: fc.constantFrom(...[min, max, 0, (min + max) / 2].filter((v) => v >= min && v <= max && inside(v)))});
}

// Small ones mostly: the cost of an answer grows with them.
function integer({minimum, maximum}) {
  const low = Math.min(maximum, minimum + 100);
  return fc.oneof({weight: 30, arbitrary: fc.integer({min: minimum, max: low})},
    {weight: 1, arbitrary: fc.integer({min: minimum, max: Math.min(maximum, 2000)})});
}

const ASCII = '^[ -~]+$';
const HASH = '^[0-9a-f]{64}$';
const ascii = fc.integer({min: 32, max: 126}).map((code) => String.fromCharCode(code));
const letter = fc.oneof({weight: 9, arbitrary: ascii}, {weight: 1, arbitrary: fc.constantFrom(...'äØß÷ſĲж注字𠮷⌀–')});
const text = (pattern, min, max) => pattern === HASH ? fc.hexaString({minLength: 64, maxLength: 64}) : fc.array(pattern === ASCII ? ascii : letter, {minLength: min, maxLength: max && Math.min(max, LONGEST)}).map((all) => all.join('')).filter((made) => made === '' || /[\p{L}\p{N}\p{P}\p{S}]/u.test(made));  // something to see in it

// Of each group of which an object has exactly one member, one is kept.
function object(contract, schema) {
  const either = groups(schema);
  const members = Object.entries(schema.properties ?? {}).map(([name, property]) => [name, fromSchema(contract, property)]);
  const all = fc.record(Object.fromEntries(members), {requiredKeys: [...(schema.required ?? []), ...either.flat()]});
  return fc.tuple(all, ...either.map((group) => fc.constantFrom(...group))).map(([value, ...kept]) => {
    const dropped = either.flat().filter((name) => !kept.includes(name));
    return Object.fromEntries(Object.entries(value).filter(([name]) => !dropped.includes(name)));
  });
}

// Returns an arbitrary of the values that a schema of the contract describes; `contract.validator`
// decides the rest.
export function fromSchema(contract, given) {
  if (given === true) return fc.constantFrom(null, 1, 'text', [1, 2]);
  if (given.not) {  // a request within another has not all that it may have by itself
    const barred = contract.resolve(given.not).required ?? [];
    const {not: _, ...rest} = given;
    return fromSchema(contract, rest).map((value) => Object.fromEntries(Object.entries(value).filter(([name]) => !barred.includes(name))));
  }
  const schema = contract.resolve(given);
  if ('const' in schema) return fc.constant(schema.const);
  if (schema.enum) return fc.constantFrom(...schema.enum);
  if (schema.oneOf) return fc.oneof(...schema.oneOf.map((branch) => fromSchema(contract, branch)));
  if (Array.isArray(schema.type)) return fc.oneof(...schema.type.map((type) => fromSchema(contract, {...schema, type})));
  switch (schema.type) {
    case 'null': return fc.constant(null);
    case 'object': return object(contract, schema);
    case 'array':
      return fc.array(fromSchema(contract, schema.items), {minLength: schema.minItems ?? 0,
        maxLength: Math.min(schema.maxItems ?? MANY, (schema.minItems ?? 0) + MANY)});
    case 'integer': return integer(schema);
    case 'number': return number(schema);
    case 'boolean': return fc.boolean();
    case 'string': return text(schema.pattern, schema.minLength, schema.maxLength);
    default: throw new Error(`no generator for ${JSON.stringify(schema)}`);
  }
}

const between = (min, max) => fc.integer({min: 0, max: 1000}).map((k) => min + (max - min) * k / 1000);
const maybe = (name, arbitrary) => fc.option(arbitrary, {nil: undefined}).map((v) => (v === undefined ? {} : {[name]: v}));
const joined = (...parts) => fc.tuple(...parts).map((values) => Object.assign({}, ...values));

// A tube with a chord that every generator meets, braces that may be met, and sometimes an end plane below them.
const joint = fc.record({
  radius: between(10, 120), wall: between(0.03, 0.3), chord: between(1.3, 3), lean: between(50, 130), turn: between(-360, 360),
  aside: between(-0.9, 0.9),
  braces: fc.array(fc.record({size: between(0.6, 1.3), lean: between(30, 150), turn: between(0, 360), aside: between(-0.3, 0.3),
    height: between(-0.2, 0.5)}), {maxLength: 3}),
  byAxis: fc.boolean(), plane: fc.boolean(), named: fc.boolean(),
}).map((j) => {
  const id = (text) => (j.named ? {id: text} : {});
  const chord = {kind: 'tube', ...id('chord'), outer_diameter_mm: 2 * j.radius * j.chord};
  const lean = j.lean * Math.PI / 180;
  const place = j.byAxis
    ? {axis: {point_mm: [0, 0, 0], direction: [0, -Math.sin(lean), Math.cos(lean)]}}
    : {inclination_deg: j.lean, clocking_deg: j.turn, offset_mm: j.aside * j.radius * (j.chord - 1)};
  const braces = j.braces.map((b, i) => ({kind: 'tube', ...id(`brace ${i}`), outer_diameter_mm: 2 * j.radius * b.size,
    inclination_deg: b.lean, clocking_deg: b.turn, offset_mm: b.aside * j.radius, height_mm: b.height * j.radius}));
  const plane = {kind: 'plane', point_mm: [0, 0, j.radius], normal: [0.1, 0, 1]};
  return {
    target: {...id('B1'), outer_diameter_mm: 2 * j.radius, wall_mm: Math.max(0.5, j.radius * j.wall)},
    cutters: [{...chord, ...place}, ...braces, ...(j.plane ? [plane] : [])],
  };
});

const points = fc.integer({min: 24, max: 90}).map((n) => ({sampling: {uniform_points: n}}));
const sampling = fc.oneof(
  {weight: 4, arbitrary: points},
  {weight: 1, arbitrary: fc.record({tolerance_mm: between(0.3, 3), metric: fc.constantFrom('developed', 'chord')}).map((s) => ({sampling: s}))},
  {weight: 1, arbitrary: fc.record({uniform_points: fc.integer({min: 8, max: 48}), tolerance_mm: between(0.5, 3)}).map((s) => ({sampling: s}))});

const common = joined(
  maybe('reference', fc.record({part: text('', 1, 12), heat: text('', 1, 64)})),
  maybe('log', fc.constant('inline')),
  maybe('numerics', fc.constant(NUMERICS)));

const limits = fc.oneof(
  fc.record({max_slope_deg_per_mm: between(0.5, 10), max_curvature_deg_per_mm2: between(0.1, 3)}),
  fc.record({machine: fc.constant('five_axis_cutter'), speed_mm_min: between(100, 2000), use: between(0.2, 1)},
    {requiredKeys: ['machine', 'speed_mm_min']}));
const envelope = fc.record({method: fc.constant('envelope'), limits, refine: fc.boolean(), mutation_limit_deg: between(1, 30)},
  {requiredKeys: ['method', 'limits']});
const untreated = fc.record({method: fc.constant('none'), mutation_limit_deg: between(1, 30)}, {requiredKeys: ['method']});
const hermite = fc.record({method: fc.constant('hermite'), transition_points: fc.integer({min: 4, max: 6}), mutation_limit_deg: between(40, 90)});

// No kerf, or one that a beam can have.
const kerf = fc.oneof({weight: 1, arbitrary: fc.constant(0)}, {weight: 9, arbitrary: between(0.01, 4)});

const groove = fc.oneof(
  fc.record({rule: fc.constant('half_dihedral'), cap_deg: between(20, 60)}, {requiredKeys: ['rule']}),
  fc.record({rule: fc.constant('fixed'), angle_deg: between(0, 60)}),
  fc.constant({rule: 'none'}), fc.constant({rule: 'square'}));

// Root, contact and dihedral as the table of combinations has them; hermite promises nothing, so without contact and on a bare grid.
const ways = fc.oneof(
  {weight: 3, arbitrary: joined(fc.record({root_surface: fc.constant('inner'), contact: fc.constantFrom('inner', 'none'),
    smoothing: fc.oneof(envelope, untreated)}), sampling)},
  {weight: 3, arbitrary: joined(fc.record({root_surface: fc.constant('outer'), contact: fc.constant('none'),
    dihedral: fc.constantFrom('weld_side', 'inside', 'as_published'), smoothing: fc.oneof(envelope, untreated)}), sampling)},
  {weight: 1, arbitrary: joined(fc.record({root_surface: fc.constantFrom('inner', 'outer'), contact: fc.constant('none'), smoothing: hermite}),
    points)});

const torch = fc.record({min_deg: between(-89, -80), max_deg: between(80, 89)}, {requiredKeys: []});
const accept = fc.record({max_root_gap_mm: between(0, 2), max_extra_bevel_deg: between(0, 20), max_b_deg: between(10, 80)}, {requiredKeys: []});

// A chord and a branch that reaches it all round, also next to the chord's bore.
const hole = fc.record({
  radius: between(30, 300), wall: between(0.03, 0.15), size: between(0.2, 0.7), branchWall: between(0.06, 0.25), lean: between(45, 135),
  turn: between(-360, 360), aside: between(-0.15, 0.15), along: between(-300, 300), byAxis: fc.boolean(), named: fc.boolean(),
}).map((h) => {
  const id = (text) => (h.named ? {id: text} : {});
  const wall = Math.max(0.5, h.radius * h.wall);
  const branch = (h.radius - wall) * h.size;
  const lean = h.lean * Math.PI / 180;
  const place = h.byAxis
    ? {axis: {point_mm: [h.aside * branch, 0, h.along], direction: [0, -Math.sin(lean), Math.cos(lean)]}}
    : {inclination_deg: h.lean, clocking_deg: h.turn, offset_mm: h.aside * branch, height_mm: h.along};
  return {
    chord: {...id('chord'), outer_diameter_mm: 2 * h.radius, wall_mm: wall},
    branch: {...id('B1'), outer_diameter_mm: 2 * branch, wall_mm: Math.max(0.5, branch * h.branchWall), ...place},
  };
});
const holeJoint = fc.oneof(
  fc.record({kind: fc.constantFrom('set_on', 'through', 'set_in'), gap_mm: between(0, 2)}, {requiredKeys: ['kind']}),
  fc.record({kind: fc.constant('set_in'), gap_mm: between(0, 2), depth_mm: between(2, 10)}));

// A node from centre-lines: a chord that passes and braces on its sides, or two that end in a mitre.
const pi = Math.PI;
const passing = fc.record({
  radius: between(50, 250), wall: between(0.03, 0.12), tilt: between(-0.5, 0.5), braces: fc.array(fc.record({
    size: between(0.3, 0.85), wall: between(0.05, 0.2), lean: between(40, 140), around: between(0, 360), along: between(-0.4, 0.4),
    aside: between(-0.1, 0.1)}), {minLength: 1, maxLength: 4}),
}).map(({radius, wall, tilt, braces}) => {
  const along = [Math.cos(tilt), Math.sin(tilt), 0];
  const across = [-Math.sin(tilt), Math.cos(tilt), 0];
  const sum = (...terms) => [0, 1, 2].map((k) => terms.reduce((total, [factor, vector]) => total + factor * vector[k], 0));
  const up = [0, 0, 1];
  const chord = {id: 'C', start_mm: sum([-20 * radius, along]), end_mm: sum([20 * radius, along]), outer_diameter_mm: 2 * radius,
    wall_mm: Math.max(0.5, wall * radius)};
  return [chord, ...braces.map((b, i) => {
    // Each has its own sector around the chord, so that no brace lies along another.
    const around = (b.around / 2 + 360 * i) / braces.length * pi / 180;
    const side = sum([Math.cos(around), across], [Math.sin(around), up]);
    const lean = b.lean * pi / 180;
    const away = sum([Math.cos(lean), along], [Math.sin(lean), side]);
    const start = sum([b.along * radius, along], [b.aside * radius, sum([-Math.sin(around), across], [Math.cos(around), up])]);
    return {id: `B${i}`, start_mm: start, end_mm: sum([1, start], [18 * radius, away]), outer_diameter_mm: 2 * radius * b.size,
      wall_mm: Math.max(0.5, b.wall * radius * b.size), priority: i + 1};
  })];
});
const mitred = fc.record({radius: between(20, 150), wall: between(0.05, 0.2), angle: between(50, 130)}).map(({radius, wall, angle}) => {
  const tube = (id, end) => ({id, start_mm: [0, 0, 0], end_mm: end, outer_diameter_mm: 2 * radius, wall_mm: Math.max(0.5, wall * radius)});
  const turn = angle * pi / 180;
  return [tube('leg', [12 * radius, 0, 0]), tube('rail', [12 * radius * Math.cos(turn), 0, 12 * radius * Math.sin(turn)])];
});
const members = fc.oneof({weight: 4, arbitrary: passing}, {weight: 1, arbitrary: mitred});
const connected = fc.tuple(members, between(5, 40), fc.boolean()).map(([all, within, byName]) => ({members: all, connect: byName
  ? all.slice(1).map(({id}, i) => ({member: id, end: 'start', to: all.slice(0, i + 1).map((other) => other.id)}))
  : {within_mm: within}}));

// The endpoint's examples with every number that is no count moved by up to a thousandth. Not those of hundreds of members: alike no more, each would be a
// part of its own.
function nearExamples(contract, endpoint) {
  const examples = endpoint.examples.filter(({body}) => !(body.members?.length > 100));
  const move = (given, value, turns) => {
    if (given === true || value === null) return value;
    const schema = branchOf(contract, contract.resolve(given), value);
    if (Array.isArray(value)) return value.map((item) => move(schema.items, item, turns));
    if (value !== null && typeof value === 'object') {
      return Object.fromEntries(Object.entries(value).map(([name, item]) => [name, move(schema.properties?.[name] ?? schema.additionalProperties, item, turns)]));
    }
    return schema.type === 'number' ? value * (1 + turns() / 1e6) : value;
  };
  return fc.tuple(fc.constantFrom(...examples), fc.infiniteStream(fc.integer({min: -1000, max: 1000})))
    .map(([{body}, stream]) => move(endpoint.request, body, () => stream.next().value))
    .filter((body) => endpoint.validRequest(body));
}

const BATCH = 20;  // made at a time: bodies of a schedule are large

// Yields `count` values of an arbitrary, made on demand.
export function* drawn(arbitrary, seed, count) {
  for (let done = 0; done < count; done += BATCH) {
    yield* fc.sample(arbitrary, {seed: seed + done, numRuns: Math.min(BATCH, count - done)});
  }
}

// Returns the number of requests that a suite draws: `few`, because every change waits for them, or `all` in `./dev soak requests`.
export const drawings = (few, all) => (process.env.TUBECUT_DRAWINGS === 'all' ? all : few);

// Returns the number of requests that a suite sends to an endpoint. If the endpoint has no generator of its own, the number is smaller, because its
// requests are near its examples, and many of those are expensive. With TUBECUT_RUNS=100000 every endpoint gets the whole number, in ten minutes.
const FEW_RUNS = Number(process.env.TUBECUT_RUNS ?? drawings(20, 60));
export const hasGenerator = (endpoint) => own[endpoint.id] !== undefined;
export const runsOf = (endpoint, whole) => (hasGenerator(endpoint) ? whole : Math.min(whole, FEW_RUNS));

// Requests that should be answered with 200. An endpoint without a generator of its own starts from its examples.
export function sound(contract, endpoint) {
  return own[endpoint.id] ?? nearExamples(contract, endpoint);
}

// Cut square by a tube laser: the values of its preset are given or omitted.
const untilted = joined(fc.record({preset: fc.constant('tube_laser'), kerf_mm: kerf}),
  fc.oneof(fc.constant({}), fc.record({root_surface: fc.constantFrom('inner', 'outer'), contact: fc.constant('none')}), fc.record({contact: fc.constant('auto')})),
  maybe('groove', fc.constantFrom({}, {rule: 'square'})), maybe('smoothing', fc.constantFrom({}, {method: 'none'})), maybe('root_face_mm', fc.constant(0)));
const laserAccept = fc.record({max_gap_mm: between(0, 5), max_reach_mm: between(0, 300), min_tongue_mm: between(0, 40), max_root_gap_mm: between(0, 2)}, {requiredKeys: []});

const holeAccept = fc.record({max_root_gap_mm: between(0, 2), max_b_deg: between(10, 80)}, {requiredKeys: []});
// hermite requires a bare grid.
const tables = fc.record({
  include: fc.constantFrom(['tables'], ['tables', 'profiles']),
  tables: joined(fc.record({groove, kerf_mm: kerf}), fc.oneof(
    fc.record({root_surface: fc.constant('inner'), contact: fc.constantFrom('inner', 'auto', 'none'), smoothing: fc.oneof(envelope, untreated)}),
    fc.record({root_surface: fc.constant('outer'), contact: fc.constantFrom('outer', 'none'), smoothing: fc.oneof(envelope, untreated)}))),
});

// A rectangular brace on a rectangular chord, by its node. The kerf is less than the corner radius.
const rectangularEnd = fc.record({height: between(80, 200), width: between(80, 200), wall: between(3, 8), side: between(0.3, 0.7), lean: between(50, 130),
  oval: fc.boolean()}).map(({height, width, wall, side, lean, oval}) => {
  const small = side * Math.min(height, width);
  const turn = lean * pi / 180;
  const brace = oval ? {kind: 'flat_oval_tube'} : {kind: 'rectangular_tube', corners: 'en_10219'};
  return {node: {
    members: [
      {id: 'C', start_mm: [-900, 0, 0], end_mm: [900, 0, 0], kind: 'rectangular_tube', height_mm: height, width_mm: width, wall_mm: wall,
        corner_radius_mm: 2 * wall, up: [0, 0, 1]},
      {id: 'B0', start_mm: [0, 0, 0], end_mm: [900 * Math.cos(turn), 0, 900 * Math.sin(turn)], ...brace, height_mm: small, width_mm: 0.8 * small,
        wall_mm: Math.max(0.5, 0.05 * small), up: [0, 1, 0], priority: 1}],
    connect: {within_mm: 5}, member: 'B0', end: 'start'}};
});
const rectangularWays = fc.record({root_surface: fc.constant('inner'), contact: fc.constantFrom('inner', 'auto', 'none'),
  smoothing: fc.oneof(envelope, untreated), groove, kerf_mm: between(0.01, 0.9)});
const rectangularLaser = fc.record({preset: fc.constant('tube_laser'), kerf_mm: between(0.01, 0.9)});
const laserSectionAccept = fc.record({max_gap_mm: between(0, 5), max_reach_mm: between(0, 300), max_root_gap_mm: between(0, 2)}, {requiredKeys: []});

const own = {
  intersections: joined(joint, sampling, maybe('surfaces', fc.constantFrom('inner', 'outer', 'both')), common),
  holes: joined(hole, fc.record({joint: holeJoint, groove, kerf_mm: kerf}), maybe('tilt', fc.constantFrom('axial', 'free', 'none')), sampling,
    maybe('torch', torch), maybe('accept', holeAccept), common),
  nodes: joined(connected, fc.oneof(fc.constant({}), fc.constant({include: ['profiles']}), tables), sampling, common),
  'bevel-tables': fc.oneof({weight: 4, arbitrary: joined(joint, ways, fc.record({groove, kerf_mm: kerf}), maybe('torch', torch), maybe('accept', accept), common)},
    {weight: 1, arbitrary: joined(joint, untilted, sampling, maybe('torch', torch), maybe('accept', laserAccept), common)},
    {weight: 1, arbitrary: joined(rectangularEnd, rectangularWays, sampling, maybe('torch', torch), maybe('accept', accept), common)},
    {weight: 1, arbitrary: joined(rectangularEnd, rectangularLaser, sampling, maybe('torch', torch), maybe('accept', laserSectionAccept), common)}),
};
