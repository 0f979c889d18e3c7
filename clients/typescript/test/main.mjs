// The types held by the compiler, then dist/ against the running service: node test/main.mjs --server BINARY
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {Service} from '../../../tests/contract/service.mjs';
import {compile, readmeModule, ROOT} from './compile.mjs';

const example = (path) => JSON.parse(readFileSync(join(ROOT, '../../examples', path), 'utf8'));

const {values} = parseArgs({options: {server: {type: 'string'}}});
if (!values.server) throw new Error('usage: node test/main.mjs --server BINARY');

const {faults, expected} = compile();
assert.deepEqual(faults, [], faults.join('\n'));
console.log(`right.ts and the README compile; ${expected} wrong calls do not`);

const {answered, batch, documentOf, FORMATS, post, ProblemError, retryingFetch, tubecut, UnreachableError} = await import('../dist/index.js');
const replicas = await import('./replicas.mjs');
const frames = await import('./frames.mjs');

async function computesTableOne({client}) {
  const {job, result, verification, verdict} =
    await post(client, '/v1/bevel-tables', example('bevel-tables/source-000-table-1.json'), {jobId: 'B1 start'});
  assert.equal(job.id, 'B1 start');
  assert.equal(result.points.b_deg.length, 360);
  assert.ok(Math.abs(result.developed_length_mm - 60 * Math.PI) < 1e-9);
  const junctions = result.events.filter(({kind, surface}) => kind === 'junction' && surface === 'inner');
  // tests/golden/intersections-and-bevels.json, r = 30
  const golden = [8.15031871504, 96.77994016832, 222.07933889144, 258.49203232178, 327.60425740354];
  assert.equal(junctions.length, golden.length);
  junctions.forEach(({phi_deg}, i) => assert.ok(Math.abs(phi_deg - golden[i]) < 1e-9));
  assert.ok(verification.passed && verification.checks.length > 0);
  assert.equal(verdict.status, 'ok');
}

async function chainsTableToSchedule({client}) {
  const body = example('pulse-schedules/table-1-on-the-five-axis-cutter.json');
  const {result} = await post(client, '/v1/pulse-schedules', body);
  for (const [axis, counts] of Object.entries(result.counts)) {
    assert.equal(counts.length, result.periods);
    assert.equal(counts.reduce((sum, n) => sum + n, 0), result.total[axis]);
  }
}

async function tellsEveryWrongField({client}) {
  const body = {target: {outer_diameter_mm: 70, wall_mm: 0}, cutters: [], kerf: 1};
  await assert.rejects(post(client, '/v1/bevel-tables', body), (error) => {
    assert.ok(error instanceof ProblemError);
    assert.equal(error.problem.status, 422);
    const pointers = error.problem.errors.map(({pointer}) => pointer);
    for (const pointer of ['/target/wall_mm', '/cutters', '/kerf', '/groove']) assert.ok(pointers.includes(pointer), pointer);
    return true;
  });
}

async function reachesFormatsAndCatalogues({client}) {
  const body = example('bevel-tables/source-000-table-1.json');
  const {data} = await client.POST('/v1/bevel-tables', {body, params: {query: {format: 'csv'}}, parseAs: 'text'});
  assert.ok(data.split('\n').length > 360);
  const {endpoints} = await answered(client.GET('/v1/version'));
  assert.ok(endpoints.some(({id}) => id === 'bevel-tables'));
  const whole = await answered(client.POST('/v1/bevel-tables', {body, params: {query: {validate_only: true}}}));
  assert.equal(whole.result, undefined);
}

async function knowsEveryFormatAndOption({client, base}) {
  const {endpoints} = await answered(client.GET('/v1/version'));
  const media = new Set(endpoints.flatMap(({formats}) => formats));
  media.delete('application/json');
  assert.deepEqual(new Set(Object.values(FORMATS)), media);
  const body = example('bevel-tables/source-000-table-1.json');
  for (const format of Object.keys(FORMATS).filter((name) => !['st', 'zip'].includes(name))) {
    const content = await documentOf(client, '/v1/bevel-tables', body, format, format === 'gcode' ? {speed_mm_min: 600} : {});
    assert.equal(content.type.split(';')[0], FORMATS[format]);
    assert.ok(content.size > 1000, format);
  }
  const packet = await documentOf(client, '/v1/frames', example('frames/truss-of-19.json'), 'zip', {files: ['nc1', 'gcode'], speed_mm_min: 600});
  const text = Buffer.from(await packet.arrayBuffer()).toString('latin1');
  assert.equal(packet.type, FORMATS.zip);
  assert.ok(text.startsWith('PK') && ['.nc1', '.ngc', 'manifest.json'].every((name) => text.includes(name)) && !text.includes('.step'));
  const {paths, components} = await (await fetch(`${base}/openapi.json`)).json();
  const names = paths['/v1/bevel-tables'].post.parameters.map(({$ref}) => components.parameters[$ref.split('/').pop()])
    .filter((one) => one.in === 'query' && !['format', 'validate_only', 'view'].includes(one.name)).map(({name}) => name);
  assert.ok(names.length > 6);
  for (const name of names) {  // each arrives: no format takes this value
    await assert.rejects(documentOf(client, '/v1/bevel-tables', body, 'csv', {[name]: 'never'}), (error) => {
      assert.ok(error instanceof ProblemError);
      assert.equal(error.problem.errors[0].pointer, `?${name}`);
      return true;
    });
  }
}

async function repeatsWhatIsRetryable({base}) {
  const statuses = [];
  const flaky = async (request) => {
    const reply = statuses.length < 2 ? new Response('', {status: 503, headers: {'Retry-After': '0'}}) : await fetch(request);
    statuses.push(reply.status);
    return reply;
  };
  const body = example('intersections/source-000-table-1.json');
  await post(tubecut(base, {retry: {fetch: flaky}}), '/v1/intersections', body);
  assert.deepEqual(statuses, [503, 503, 200]);

  let sent = 0;
  const dead = retryingFetch({attempts: 3, longestWaitMs: 1, fetch: async () => { ++sent; throw new TypeError('refused'); }});
  await assert.rejects(dead(new Request(base)), /refused/);
  assert.equal(sent, 3);

  sent = 0;
  await assert.rejects(post(tubecut(base, {retry: {fetch: (request) => { ++sent; return fetch(request); }}}),
    '/v1/intersections', {}), ProblemError);
  assert.equal(sent, 1, 'a 422 is not repeated');
}

async function streamsABatch({base}) {
  const body = example('intersections/source-000-table-1.json');
  const lines = Array.from({length: 50}, (_, n) => ({id: `größer ${n}`, endpoint: 'intersections', body: n === 20 ? {} : body}));
  const statuses = new Map();
  const stream = batch(base, lines);
  let step = await stream.next();
  for (; !step.done; step = await stream.next()) statuses.set(step.value.id, step.value.status);
  assert.deepEqual(step.value, {items: 50, answered: 49, refused: 1, unanswered: 0});
  assert.deepEqual(new Set(statuses.keys()), new Set(lines.map(({id}) => id)));
  assert.equal(statuses.get('größer 20'), 422);

  const cut = async () => new Response('{"id"', {status: 200});
  await assert.rejects(async () => { for await (const _ of batch(base, lines.slice(0, 1), {fetch: cut, patienceMs: 300})); }, UnreachableError);
  for await (const _ of batch(base, lines)) break;  // leaving early ends it
}

async function batchesDocuments({base, client}) {
  const body = example('bevel-tables/source-000-table-1.json');
  const table = {endpoint: 'bevel-tables', body};
  const lines = [
    {id: 'größer', ...table, format: 'csv'}, {id: 'B1', ...table}, {id: 'no speed', ...table, format: 'gcode'},
    {id: 'cut', ...table, format: 'gcode', options: {speed_mm_min: 600, axial: 'z'}}, {id: 'wrong', endpoint: 'bevel-tables', body: {}},
    {id: 'solid', ...table, format: 'stl', options: {view: 'before'}}, {id: 'no view', ...table, format: 'stl', options: {view: 'chart'}},
  ];
  const asked = [];
  const watched = (url, init) => { asked.push(url); return fetch(url, init); };
  const replies = new Map();
  const stream = batch(base, lines, {fetch: watched});
  let step = await stream.next();
  for (; !step.done; step = await stream.next()) replies.set(step.value.id, step.value);
  assert.deepEqual(step.value, {items: 7, answered: 4, refused: 3, unanswered: 0});
  assert.deepEqual(asked.filter((url) => url !== `${base}/v1/version`), [`${base}/v1/batches`]);
  assert.deepEqual(lines.map(({id}) => replies.get(id).line), [1, 2, 3, 4, 5, 6, 7]);
  assert.deepEqual(lines.map(({id}) => replies.get(id).status), [200, 200, 400, 200, 422, 200, 406]);
  assert.equal(replies.get('no speed').body.errors[0].pointer, '?speed_mm_min');
  assert.equal(replies.get('B1').body.verdict.status, 'ok');
  for (const line of [lines[0], lines[3], lines[5]]) {
    const {verdict, document, ...more} = replies.get(line.id);
    const alone = await documentOf(client, '/v1/bevel-tables', body, line.format, line.options, line.id === 'größer' ? {} : {jobId: line.id});
    assert.equal(verdict, 'ok');
    assert.equal(document.type, FORMATS[line.format]);
    assert.deepEqual(Buffer.from(await document.arrayBuffer()), Buffer.from(await alone.arrayBuffer()));
    assert.deepEqual(Object.keys(more), ['id', 'line', 'status']);
  }

  const documents = Array.from({length: 20}, (_, n) => ({id: `${n}`, ...table, format: 'csv'}));
  for await (const _ of batch(base, documents)) break;  // leaving early ends the work
  const stop = new AbortController();
  await assert.rejects(async () => {
    for await (const _ of batch(base, documents, {signal: stop.signal})) stop.abort();
  }, {name: 'AbortError'});
}

async function runsItsPage({base}) {
  const folder = mkdtempSync(join(tmpdir(), 'tubecut-'));
  const page = join(ROOT, 'dist/readme.mjs');
  const made = execFileSync(values.server, ['new-key', 'shop'], {encoding: 'utf8'});
  const [key] = /tc_[A-Za-z0-9_-]+/.exec(made);
  writeFileSync(join(folder, 'keys'), `${/^shop .*$/m.exec(made)[0]}\n`);
  const keyed = await Service.start(values.server, '--keys', join(folder, 'keys'));
  try {
    const locked = `http://127.0.0.1:${keyed.port}`;
    await assert.rejects(post(tubecut(locked), '/v1/intersections', {}), (error) => error.problem.code === 'unauthorized');
    const {code, printed} = readmeModule();
    assert.ok(printed.length >= 8);
    for (const url of ['http://127.0.0.1:8080', 'https://tubecut.example:8443']) assert.ok(code.includes(url), url);
    writeFileSync(page, code.replaceAll('http://127.0.0.1:8080', base).replaceAll('https://tubecut.example:8443', locked));
    const lines = execFileSync(process.execPath, [page], {encoding: 'utf8', env: {...process.env, TUBECUT_KEY: key}});
    assert.deepEqual(lines.trimEnd().split('\n'), printed);
  } finally {
    assert.equal(await keyed.stop(), 0);
    rmSync(page, {force: true});
    rmSync(folder, {recursive: true});
  }
}

const service = await Service.start(values.server);
const base = `http://127.0.0.1:${service.port}`;
try {
  for (const test of [computesTableOne, chainsTableToSchedule, tellsEveryWrongField, reachesFormatsAndCatalogues, knowsEveryFormatAndOption,
    repeatsWhatIsRetryable, streamsABatch, batchesDocuments, runsItsPage, ...frames.tests, ...replicas.tests]) {
    await test({base, client: tubecut(base), server: values.server});
    console.log(`ok ${test.name}`);
  }
} finally {
  frames.close();
  replicas.close();
  assert.equal(await service.stop(), 0);
}
