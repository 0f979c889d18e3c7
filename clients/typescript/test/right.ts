// Code that must compile. Never run.
import {answered, batch, documentOf, frame, frameLines, post, progressBar, tubecut, validated, type BatchLine, type DocumentLine, type RequestBody, type Schemas} from '../src/index.js';

const client = tubecut('http://127.0.0.1:8080');

export const joint = {
  target: {outer_diameter_mm: 70, wall_mm: 5},
  cutters: [
    {kind: 'tube', outer_diameter_mm: 110, inclination_deg: 85},
    {kind: 'tube', outer_diameter_mm: 70, axis: {point_mm: [0, 0, 0], direction: [0, -1, 1]}},
    {kind: 'plane', point_mm: [0, 0, 20], normal: [0, 0, 1]},
  ],
  root_surface: 'inner',
  groove: {rule: 'half_dihedral'},
  kerf_mm: 1.5,
  smoothing: {method: 'envelope', limits: {max_slope_deg_per_mm: 5, max_curvature_deg_per_mm2: 1}},
} satisfies Schemas['BevelTablesRequest'];

export const square = {
  preset: 'tube_laser',
  target: joint.target,
  cutters: joint.cutters,
  kerf_mm: 0.2,
  accept: {max_gap_mm: 3, min_tongue_mm: 10},
} satisfies Schemas['BevelTablesRequest'];

export const brace = {
  ...joint,
  target: {kind: 'rectangular_tube', height_mm: 80, width_mm: 80, wall_mm: 4, corners: 'en_10219'},
} satisfies Schemas['BevelTablesRequest'];

export async function calls(): Promise<number> {
  const {result: table, verification} = await post(client, '/v1/bevel-tables', joint, {jobId: 'B1 start'});
  const passed: true = verification.passed;
  const columns: number[] = table.points.b_deg;
  const sign: string = table.b_sign;
  const {result: narrow} = await post(client, '/v1/bevel-tables', {...joint, columns: ['phi_deg', 'b_deg']});
  const named: number[] | undefined = narrow.points.b_deg;

  const {result: section} = await post(client, '/v1/bevel-tables', brace);
  const girth: number[] = section.points.girth_mm;
  const radius: number = section.section.corner_radius_mm;

  const whole = await answered(client.POST('/v1/bevel-tables', {
    body: joint,
    params: {query: {validate_only: true}, header: {'Job-Id': 'B1 start'}},
  }));
  const status: 'ok' | 'review' | 'reject' = whole.verdict.status;

  const laser = await post(client, '/v1/bevel-tables', square);
  const gap: number | undefined = laser.result.tube_laser?.gap?.greatest_mm;
  const outer: number[] | undefined = laser.result.points.gap_outer_mm;

  const csv = await client.POST('/v1/bevel-tables', {body: joint, params: {query: {format: 'csv'}}, parseAs: 'text'});
  const text: string | undefined = csv.data;

  const {result: schedule} = await post(client, '/v1/pulse-schedules',
    {cut: joint, machine: 'five_axis_cutter', motion: {speed: {mm_min: 600}}});
  const periods: number = schedule.periods;

  const refused = await client.POST('/v1/intersections', {body: {target: {size: 'NPS 4 SCH 40'}, cutters: joint.cutters}});
  const pointer: string | undefined = refused.error?.errors[0]?.pointer;

  const program: Blob = await documentOf(client, '/v1/bevel-tables', joint, 'gcode',
    {speed_mm_min: 600, dialect: 'qtplasmac', torch: 'on', acknowledge: 'root_opens', axial: 'z', lead_mm: 3, pivot_length_mm: 200});
  const sheet = await documentOf(client, '/v1/parts',
    {members: [], connect: {within_mm: 1}, member: 'B1', root_surface: 'inner', groove: {rule: 'none'}, kerf_mm: 1.5, smoothing: {method: 'none'}}, 'svg', {view: 'work_order'}, {jobId: 'B1'});

  const packet: Blob = await documentOf(client, '/v1/frames', {} as RequestBody<'/v1/frames'>, 'zip', {files: ['nc1', 'step']});

  const jobs: BatchLine[] = [{id: '1', endpoint: 'bevel-tables', body: joint}];
  for await (const {body, verdict} of batch('http://127.0.0.1:8080', jobs)) console.log(body['job'], verdict);
  const files: DocumentLine[] = [{id: '2', endpoint: 'bevel-tables', body: joint, format: 'svg', options: {view: 'template', mirror: true}}];
  for await (const reply of batch('http://127.0.0.1:8080', [...jobs, ...files])) {
    const size: number = 'document' in reply ? reply.document.size : reply.line;
    console.log(size, program.size, sheet.size, packet.size);
  }

  const replicas = ['http://10.0.0.1:8080', 'http://10.0.0.2:8080'] as const;
  const stream = batch(replicas, jobs, {streams: 2, patienceMs: 5000, progress: (done, total, refused) => console.log(done, total ?? '?', refused)});
  const {done} = await stream.next();
  await post(tubecut(replicas, {retry: {attempts: 2}}), '/v1/bevel-tables', joint);
  console.log(done);

  const roof = {
    members: [{id: 'A', start_mm: [0, 0, 0], end_mm: [1000, 0, 0], size: 'CHS 60.3x4'}],
    joints: [{between: ['A', 'floor'], kind: 'set_on', gap_mm: 1}], others: [{kind: 'plane', id: 'floor', point_mm: [0, 0, 0], normal: [1, 0, 0]}],
    defaults: {root_surface: 'inner', groove: {rule: 'none'}, smoothing: {method: 'none'}}, kerf_mm: 1,
  } satisfies Schemas['FramesRequest'];
  for await (const {head, part, summary} of frameLines(replicas, roof, {jobId: 'roof', patienceMs: 5000})) {
    const rows: number | undefined = head?.result.cut_list.length;
    const code: string | undefined = part?.problem?.code;
    const long: number | undefined = part?.answer?.result?.lengths.long_mm;
    console.log(rows, code, long, summary?.refused);
  }
  const gathered = await frame(replicas, roof, {progress: progressBar(process.stderr)});
  const first: string | undefined = gathered.parts.get(gathered.head.result.members[0]?.part ?? '')?.id;
  const dry = await validated(client, '/v1/frames', roof);
  console.log(first, dry.verdict.status);

  const limits = await answered(client.GET('/v1/limits'));
  return Number(passed) + columns.length + sign.length + status.length + (text?.length ?? 0) + periods + (pointer?.length ?? 0) +
    Object.keys(limits).length + (gap ?? 0) + (outer?.length ?? 0);
}
