// Several replicas: batches that go in parts, replicas that die, are full or lack a pinned version.
// Most of them are fakes.
import assert from 'node:assert/strict';
import {mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import http from 'node:http';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {Service} from '../../../tests/contract/service.mjs';
import {ROOT} from './compile.mjs';

const {answered, batch, ContractError, post, ProblemError, retryingFetch, tubecut, UnreachableError} = await import('../dist/index.js');

const example = (path) => JSON.parse(readFileSync(join(ROOT, '../../examples', path), 'utf8'));
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const busy = {type: '', title: '', status: 503, code: 'overloaded', detail: '', request_id: '', retryable: true, action: '', errors: []};
const mismatch = {...busy, status: 409, code: 'numerics_mismatch', retryable: false};
const jobs = (count, body = {}) => Array.from({length: count}, (_, n) => ({id: `größer ${n}`, endpoint: 'intersections', body}));
const opened = new Set();

async function listening(server) {
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  opened.add(server);
  return `http://127.0.0.1:${server.address().port}`;
}

const bodyOf = async (request) => {
  const parts = [];
  for await (const one of request) parts.push(one);
  return Buffer.concat(parts).toString('utf8');
};

// POST /v1/batches by its contract; each option makes it fail in a way.
class StandIn {
  constructor({name = 'a', pauseMs = 0, diesAfter = Infinity, full = 0, refusedOnce = [], answersAs = {}, numerics = 1} = {}) {
    Object.assign(this, {name, pauseMs, diesAfter, full, refusedOnce: new Set(refusedOnce), answersAs, numerics, received: [], hungUp: 0, singles: 0});
  }

  async start() {
    this.url = await listening(http.createServer((request, reply) => this.answer(request, reply).catch(() => reply.destroy())));
    return this;
  }

  statusOf({id, body}) {
    if (this.refusedOnce.delete(id)) return [503, busy];
    return (body.numerics ?? this.numerics) === this.numerics ? [200, {job: {id, numerics: this.numerics}, result: {}}] : [409, mismatch];
  }

  async answer(request, reply) {
    reply.setHeader('Tubecut-Replica', this.name);
    const text = await bodyOf(request);
    const whole = (status, body) => reply.writeHead(status, {'Content-Type': 'application/json'}).end(JSON.stringify(body));
    if (request.url === '/v1/version') return whole(200, {});
    if (request.url !== '/v1/batches') {
      this.singles += 1;
      return whole(...this.statusOf({id: 'one', body: JSON.parse(text)}));
    }
    if (this.full > 0) {
      this.full -= 1;
      return whole(503, busy);
    }
    const lines = text.trimEnd().split('\n').map((line) => JSON.parse(line));
    const done = [];
    this.received.push(done);
    reply.once('close', () => { this.hungUp += reply.writableFinished ? 0 : 1; });
    reply.writeHead(200);
    for (const [i, line] of lines.entries()) {
      if (done.length >= this.diesAfter) {
        await sleep(50);  // the written bytes have arrived
        return reply.destroy();
      }
      if (this.pauseMs) await sleep(this.pauseMs);
      if (reply.destroyed) return undefined;
      done.push(line.id);
      const [status, body] = this.statusOf(line);
      reply.write(`${JSON.stringify({id: this.answersAs[line.id] ?? line.id, line: i + 1, status, body})}\n`);
    }
    return reply.end(`{"summary":{"items":${lines.length},"answered":0,"refused":0,"unanswered":0}}\n`);
  }

  get count() {
    return this.received.flat().length;
  }
}

// One address before several: each request is the next one's.
async function inTurn(urls) {
  const asked = urls.map(() => 0);
  let turn = 0;
  const server = http.createServer((request, reply) => {
    const i = turn++ % urls.length;
    const onward = http.request(urls[i] + request.url, {method: request.method, headers: request.headers}, (got) => {
      reply.writeHead(got.statusCode, got.headers);
      got.pipe(reply);
    });
    onward.on('error', () => reply.destroy());
    reply.on('close', () => onward.destroy());
    request.on('data', (data) => { asked[i] += data.toString('latin1').split('\n').length - 1; });
    request.pipe(onward);
  });
  return {url: await listening(server), asked};
}

// Each line is answered once, under its own number; the replies by their ids, and the summary.
async function whole(addresses, lines, options) {
  const replies = new Map();
  const stream = batch(addresses, lines, options);
  let step = await stream.next();
  for (; !step.done; step = await stream.next()) {
    assert.ok(!replies.has(step.value.id), `${step.value.id} comes twice`);
    replies.set(step.value.id, step.value);
  }
  assert.deepEqual(lines.map(({id}) => replies.get(id)?.line), lines.map((_, i) => i + 1));
  assert.deepEqual([replies.size, step.value.items, step.value.unanswered], [lines.length, lines.length, 0]);
  return {replies, summary: step.value};
}

const standIns = (...options) => Promise.all(options.map((one) => new StandIn(one).start()));
const urls = (replicas) => replicas.map(({url}) => url);

async function completesWhatTheFirstLeft() {
  const [first, second] = await standIns({diesAfter: 13}, {});
  await whole(urls([first, second]), jobs(50), {streams: 1});
  assert.deepEqual([first.count, second.count], [13, 37]);
}

async function sharesABatchAmongAddresses() {
  const replicas = await standIns({pauseMs: 10}, {pauseMs: 10}, {pauseMs: 10});
  const told = [];
  await whole(urls(replicas), jobs(90), {progress: (...numbers) => told.push(numbers)});
  const shares = replicas.map(({count}) => count);
  assert.ok(Math.min(...shares) > 20 && shares.reduce((a, b) => a + b) === 90, `${shares}`);
  assert.deepEqual(told, Array.from({length: 90}, (_, i) => [i + 1, 90, 0]));
}

async function givesASlowReplicaFewer() {
  const [quick, slow] = await standIns({pauseMs: 1}, {pauseMs: 100});
  await whole(urls([quick, slow]), jobs(90));
  assert.ok(slow.count < 45, `${slow.count}`);
}

async function sharesABatchBehindOneAddress({server}) {
  const services = await Promise.all([0, 1, 2].map((i) => Service.start(server, '--replica', `r${i}`, '--slots', '1')));
  try {
    const proxy = await inTurn(services.map(({port}) => `http://127.0.0.1:${port}`));
    const lines = jobs(300, example('intersections/source-000-table-1.json'));
    const {replies} = await whole(proxy.url, lines);
    assert.ok([...replies.values()].every(({status}) => status === 200));
    assert.equal(proxy.asked.reduce((a, b) => a + b), 300);
    assert.ok(Math.min(...proxy.asked) > 20, `${proxy.asked}`);
    proxy.asked.fill(0);
    await whole(proxy.url, lines.slice(0, 90), {streams: 1});
    assert.deepEqual([...proxy.asked].sort((a, b) => a - b), [0, 0, 90]);
  } finally {
    for (const one of services) assert.equal(await one.stop(), 0);
  }
}

async function sendsABatchWholeToOneReplica() {
  const [one] = await standIns({});
  await whole(one.url, jobs(90));
  assert.deepEqual(one.received.map(({length}) => length), [90]);
}

async function goesOnWhereReplicasDieOrAreFull() {
  const lines = jobs(120);
  const replicas = await standIns({diesAfter: 5}, {full: 2}, {refusedOnce: lines.filter((_, i) => i % 7 === 0).map(({id}) => id)});
  await whole(urls(replicas), lines);
  assert.ok(replicas[0].count > 0);

  const [full] = await standIns({full: 2, refusedOnce: [lines[3].id, lines[7].id]});
  await whole(full.url, lines.slice(0, 10));
  assert.deepEqual(full.received.map(({length}) => length), [10, 2]);
}

async function survivesAReplicaKilledMidway({server}) {
  const services = await Promise.all([0, 1].map(() => Service.start(server)));
  const lines = jobs(200, example('intersections/source-000-table-1.json'));
  const seen = [];
  for await (const {id, status} of batch(services.map(({port}) => `http://127.0.0.1:${port}`), lines)) {
    assert.equal(status, 200);
    seen.push(id);
    if (seen.length === 20) services[0].child.kill('SIGKILL');
  }
  assert.deepEqual(seen.sort(), lines.map(({id}) => id).sort());
  assert.equal(await services[1].stop(), 0);
}

async function endsWithTheFaultOfAPart() {
  const wrong = await standIns({answersAs: {'größer 61': 'größer 99'}}, {answersAs: {'größer 61': 'größer 99'}});
  await assert.rejects(whole(urls(wrong), jobs(62)), ContractError);
  const dead = await standIns({diesAfter: 0}, {diesAfter: 0});
  await assert.rejects(whole(urls(dead), jobs(60), {patienceMs: 300}), UnreachableError);
  await assert.rejects(whole('http://127.0.0.1:9', jobs(1), {patienceMs: 300}), UnreachableError);
  const faulty = async () => new Response('{"id":"a"\n', {status: 200});
  await assert.rejects(whole('http://127.0.0.1:9', jobs(1), {fetch: faulty}), ContractError);
  assert.throws(() => tubecut([]), TypeError);
}

async function readsNoFurtherThanNeeded() {
  const replicas = await standIns({}, {});
  let taken = 0;
  function* endless() {
    for (; taken < 1e6; ++taken) yield {id: `${taken}`, endpoint: 'intersections', body: {}};
  }
  const seen = new Set();
  for await (const {id, line} of batch(urls(replicas), endless())) {
    assert.equal(id, `${line - 1}`);
    seen.add(id);
    if (seen.size === 5000) break;
  }
  assert.ok(seen.size === 5000 && taken < 12_000, `${taken} read for ${seen.size}`);
}

async function hangsUpWhereTheCallerStops() {
  for (const count of [1, 2]) {
    const replicas = await standIns(...Array.from({length: count}, () => ({pauseMs: 20})));
    for await (const _ of batch(urls(replicas), jobs(200))) break;
    for (let i = 0; i < 500 && replicas.some(({hungUp}) => hungUp === 0); ++i) await sleep(10);
    for (const one of replicas) assert.ok(one.hungUp > 0 && one.count < 40, `${one.hungUp} ${one.count}`);
  }
}

async function findsPinsAmongStandIns() {
  const replicas = await standIns({name: 'old', numerics: 1}, {name: 'new', numerics: 2});
  const {url} = await inTurn(urls(replicas));
  for (const addresses of [urls(replicas), url]) {
    const client = tubecut(addresses);
    for (const numerics of [1, 2, 2, 1]) assert.equal((await post(client, '/v1/intersections', {numerics})).job.numerics, numerics);
    const lines = jobs(60).map((line, i) => ({...line, body: {numerics: 1 + i % 2}}));
    const {replies, summary} = await whole(addresses, lines);
    assert.deepEqual(lines.map(({id}) => replies.get(id).body.job?.numerics), lines.map(({body}) => body.numerics));
    assert.equal(summary.refused, 0);
  }
  const nobody = await whole(replicas[0].url, jobs(30, {numerics: 77}));
  assert.deepEqual([nobody.summary.answered, nobody.summary.refused], [0, 30]);
  const before = replicas[0].singles;
  await assert.rejects(post(tubecut(replicas[0].url), '/v1/intersections', {numerics: 77}),
    (error) => error instanceof ProblemError && error.problem.code === 'numerics_mismatch');
  assert.equal(replicas[0].singles - before, 20, 'one name alone is asked no longer');
}

async function findsThePinnedMachine({server}) {
  const folder = mkdtempSync(join(tmpdir(), 'tubecut-'));
  const services = [];
  try {
    const plain = await Service.start(server);
    const {machines} = await answered(tubecut(`http://127.0.0.1:${plain.port}`).GET('/v1/machines'));
    await plain.stop();
    const cell = machines.find((one) => one.machine.type === 'five_axis_cutter').machine;
    for (const pivot_length_mm of [150, 151]) {
      const own = join(folder, `${pivot_length_mm}`);
      mkdirSync(own);
      writeFileSync(join(own, 'cell.json'), JSON.stringify({...cell, name: 'cell-7', pivot_length_mm}));
      services.push(await Service.start(server, '--machines', own, '--replica', `r${pivot_length_mm}`));
    }
    const addresses = services.map(({port}) => `http://127.0.0.1:${port}`);
    const body = {...example('pulse-schedules/square-cut-from-a-bare-contour.json'), machine: 'cell-7'};
    const alone = await Promise.all(addresses.map((one) => post(tubecut(one), '/v1/pulse-schedules', body)));
    const pins = alone.map(({request}) => request.machine_sha256);
    assert.notEqual(...pins);
    for (const where of [addresses, (await inTurn(addresses)).url]) {
      for (const [i, machine_sha256] of pins.entries()) {
        const {job} = await post(tubecut(where), '/v1/pulse-schedules', {...body, machine_sha256});
        assert.equal(job.result_sha256, alone[i].job.result_sha256);
      }
    }
  } finally {
    for (const one of services) await one.stop();
    rmSync(folder, {recursive: true});
  }
}

async function asksTheNextAddress({base}) {
  const body = example('intersections/source-000-table-1.json');
  const client = tubecut(['http://127.0.0.1:9', base]);
  assert.equal((await post(client, '/v1/intersections', body, {jobId: 'B1'})).job.id, 'B1');
  await answered(client.GET('/v1/limits'));
  const sent = [];
  const watched = retryingFetch({attempts: 2, longestWaitMs: 1, fetch: async ({url}) => { sent.push(url); throw new TypeError('refused'); }},
    ['http://a.example/x/', 'http://b.example']);
  await assert.rejects(watched(new Request('http://a.example/x/v1/limits?a=b')), /refused/);
  assert.deepEqual(sent, ['http://a.example/x/v1/limits?a=b', 'http://b.example/v1/limits?a=b', 'http://a.example/x/v1/limits?a=b', 'http://b.example/v1/limits?a=b']);
}

export const tests = [completesWhatTheFirstLeft, sharesABatchAmongAddresses, givesASlowReplicaFewer, sharesABatchBehindOneAddress,
  sendsABatchWholeToOneReplica, goesOnWhereReplicasDieOrAreFull, survivesAReplicaKilledMidway, endsWithTheFaultOfAPart, readsNoFurtherThanNeeded,
  hangsUpWhereTheCallerStops, findsPinsAmongStandIns, findsThePinnedMachine, asksTheNextAddress];

export function close() {
  for (const one of opened) {
    one.closeAllConnections();
    one.close();
  }
}
