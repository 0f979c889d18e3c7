// Code that must not compile. Each directive names the compiler's code and a word of its message;
// main.mjs checks both.
import {documentOf, frame, frameLines, post, tubecut, type BatchLine, type DocumentLine} from '../src/index.js';
import {joint} from './right.js';

const client = tubecut('http://127.0.0.1:8080');
const tube = {kind: 'tube', outer_diameter_mm: 110, inclination_deg: 85} as const;

export async function calls(): Promise<void> {
  // @ts-expect-error 2345 /v1/bevel-table
  await client.POST('/v1/bevel-table', {body: joint});

  // @ts-expect-error 2345 PathsWithMethod
  await client.GET('/v1/bevel-tables', {});

  // @ts-expect-error 2554 Expected 2 arguments
  await client.POST('/v1/bevel-tables');

  // @ts-expect-error 2322 wall_mm
  await client.POST('/v1/intersections', {body: {target: {outer_diameter_mm: 70}, cutters: [tube]}});

  // @ts-expect-error 2322 half_dihedral
  await client.POST('/v1/bevel-tables', {body: {preset: 'tube_laser', node: {members: [], connect: {within_mm: 1}, member: 'B1', end: 'start'}, kerf_mm: 0.2, groove: {rule: 'half_dihedral'}}});

  // @ts-expect-error 2322 'string' is not assignable to type 'number'
  await client.POST('/v1/intersections', {body: {target: {outer_diameter_mm: '70', wall_mm: 5}, cutters: [tube]}});

  // @ts-expect-error 2561 surfaces
  await post(client, '/v1/intersections', {target: {outer_diameter_mm: 70, wall_mm: 5}, cutters: [tube], surface: 'both'});

  // @ts-expect-error 2353 outer_diameter
  await post(client, '/v1/intersections', {target: {outer_diameter: 70, wall_mm: 5}, cutters: [tube]});

  // @ts-expect-error 2345 machine, motion
  await post(client, '/v1/pulse-schedules', {cut: joint});

  // @ts-expect-error 2322 "outside"
  await client.POST('/v1/bevel-tables', {body: {...joint, root_surface: 'outside'}});

  // @ts-expect-error 2820 "half_dihedral"
  await client.POST('/v1/bevel-tables', {body: {...joint, groove: {rule: 'half_dihedal'}}});

  // @ts-expect-error 2322 '"sphere"' is not assignable
  await client.POST('/v1/intersections', {body: {...joint, cutters: [{kind: 'sphere', outer_diameter_mm: 110}]}});

  // @ts-expect-error 2322 'string' is not assignable to type 'boolean | undefined'
  await client.POST('/v1/bevel-tables', {body: joint, params: {query: {validate_only: 'yes'}}});

  const {result: table} = await post(client, '/v1/bevel-tables', joint);
  // @ts-expect-error 2339 b_degrees
  table.points.b_degrees;

  // @ts-expect-error 2322 'number[]' is not assignable to type 'string[]'
  const text: string[] = table.points.b_deg;

  const whole = await client.POST('/v1/bevel-tables', {body: joint});
  // @ts-expect-error 18048 possibly 'undefined'
  whole.data.job;

  // @ts-expect-error 2322 'number' is not assignable
  const lines: BatchLine[] = [{id: '1', endpoint: 'intersections', body: {target: {outer_diameter_mm: 70, wall_mm: 5}, cutters: [tube], surfaces: 1}}];
  console.log(lines);

  // @ts-expect-error 2345 '"gcode"' is not assignable
  await documentOf(client, '/v1/nodes', {members: [], connect: {within_mm: 1}}, 'gcode');

  // @ts-expect-error 2322 "fanuc"
  await documentOf(client, '/v1/bevel-tables', joint, 'gcode', {speed_mm_min: 600, dialect: 'fanuc'});

  // @ts-expect-error 2353 speed
  await documentOf(client, '/v1/bevel-tables', joint, 'gcode', {speed: 600});

  // @ts-expect-error 2322 "gcode"
  const files: DocumentLine[] = [{id: '2', endpoint: 'replays', body: {} as never, format: 'gcode'}];
  console.log(files);

  const roof = {members: [], defaults: {root_surface: 'inner', groove: {rule: 'none'}, smoothing: {method: 'none'}}, kerf_mm: 1} as const;
  // @ts-expect-error 2353 within
  await frame('http://127.0.0.1:8080', {...roof, members: [], connect: {within: 1}});

  // @ts-expect-error 2353 format
  for await (const line of frameLines('http://127.0.0.1:8080', {...roof, members: []}, {format: 'csv'})) console.log(line);

  // @ts-expect-error 2345 '"gcode"' is not assignable
  await documentOf(client, '/v1/frames', {...roof, members: []}, 'gcode');

  // @ts-expect-error 2367 no overlap
  if (whole.data?.verdict.status === 'fine') console.log(text);
}
