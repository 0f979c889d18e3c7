// A frame by its lines: all at once or part by part, replicas that die or are full, callers that leave.
import assert from 'node:assert/strict';
import {readdirSync, readFileSync} from 'node:fs';
import http from 'node:http';
import {join} from 'node:path';
import {ROOT} from './compile.mjs';

const {frame, frameLines, post, ProblemError, progressBar, UnreachableError, validated} = await import('../dist/index.js');

const folder = join(ROOT, '../../examples/frames');
const example = (name) => JSON.parse(readFileSync(join(folder, `${name}.json`), 'utf8'));
const cage = example('roll-cage-of-12');
const spoiled = example('truss-of-19');
spoiled.members.find(({id}) => id === 'P0').outer_diameter_mm = 120;  // wider than its chords
const busy = {type: '', title: '', status: 503, code: 'overloaded', detail: '', request_id: '', retryable: true, action: '', errors: []};
const opened = new Set();

/** The real service's lines by a stand-in, which each option makes fail in a way. */
async function standIn(base, {diesAfter = Infinity, full = 0, refusedOnce = [], pauseMs = 0} = {}) {
  const told = {received: [], hungUp: false};
  const refused = new Set(refusedOnce);
  const server = http.createServer(async (request, reply) => {
    const chunks = [];
    for await (const chunk of request) chunks.push(chunk);
    if (full-- > 0) {
      reply.writeHead(503, {'Content-Type': 'application/problem+json'}).end(JSON.stringify(busy));
      return;
    }
    const headers = {'Content-Type': 'application/json', Accept: 'application/x-ndjson'};
    const real = await (await fetch(base + request.url, {method: 'POST', headers, body: Buffer.concat(chunks)})).text();
    const [head, ...rest] = real.trimEnd().split('\n');
    const summary = rest.pop();
    const ids = [];
    told.received.push(ids);
    reply.on('close', () => { told.hungUp ||= !reply.writableFinished; });
    reply.writeHead(200, {'Content-Type': 'application/x-ndjson', 'Tubecut-Replica': 'a'});
    reply.write(`${head}\n`);
    for (const text of rest) {
      await new Promise((done) => setTimeout(done, Math.max(pauseMs, ids.length === diesAfter ? 50 : 0)));
      if (ids.length === diesAfter) return reply.destroy();
      const line = JSON.parse(text);
      ids.push(line.id);
      reply.write(`${refused.delete(line.id) ? JSON.stringify({...line, status: 503, body: busy}) : text}\n`);
    }
    reply.end(`${summary}\n`);
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  opened.add(server);
  return Object.assign(told, {url: `http://127.0.0.1:${server.address().port}`});
}

async function whole({client}, addresses, body) {
  const lines = [];
  for await (const line of frameLines(addresses, body)) lines.push(line);
  const {head} = lines.shift(), {summary} = lines.pop();
  const made = new Map((await post(client, '/v1/frames', body)).parts.map((part) => [part.part, part]));
  assert.deepEqual(lines.map(({part}) => part.id).sort(), [...made.keys()].sort());
  for (const {part} of lines) {
    if (part.answer) assert.equal(part.answer.job.result_sha256, made.get(part.id).answer.job.result_sha256);
    else assert.equal(part.problem.code, made.get(part.id).problem.code);
  }
  const answered = lines.filter(({part}) => part.answer).length;
  assert.deepEqual(summary, {items: lines.length, answered, refused: lines.length - answered});
  assert.equal(head.result.cut_list.length, lines.length);
  return lines.map(({part}) => part);
}

async function givesEveryPartOfAFrame({client, base}) {
  const names = readdirSync(folder).map((file) => file.replace('.json', ''));
  assert.ok(names.length >= 10);
  for (const name of names) await whole({client}, base, example(name));
  const [refused] = (await whole({client}, base, spoiled)).filter(({problem}) => problem);
  assert.equal(refused.id, 'P0');
}

async function gathersAFrameAndTellsItsProgress({base}) {
  const told = [];
  const {head, parts, summary} = await frame(base, example('truss-of-500'), {jobId: 'roof', progress: (...numbers) => told.push(numbers)});
  assert.equal(head.job.id, 'roof');
  assert.equal(head.result.members.length, 500);
  assert.ok(parts.size > 10 && summary.answered === parts.size);
  assert.deepEqual(told, Array.from({length: parts.size + 1}, (_, n) => [n, parts.size, 0]));
  for (const {part} of head.result.members) assert.equal(parts.get(part).answer.verdict.status, 'ok');
}

async function refusesWhatTheServiceRefuses({base}) {
  await assert.rejects(frame(base, {...cage, kerf_mm: -1}), (error) => error instanceof ProblemError && error.problem.errors[0].pointer === '/kerf_mm');
  await assert.rejects(frame(base, {...cage, numerics: 999}), (error) => error instanceof ProblemError && error.problem.code === 'numerics_mismatch');
  await assert.rejects(frame('http://127.0.0.1:9', cage, {patienceMs: 300}), UnreachableError);
}

async function completesAFrameThatBrokeOff({client, base}) {
  const first = await standIn(base, {diesAfter: 5}), second = await standIn(base, {full: 1, refusedOnce: ['harness', 'main top']});
  const parts = await whole({client}, ['http://127.0.0.1:9', first.url, second.url], cage);
  assert.deepEqual(parts.slice(0, 5).map(({id}) => id), first.received[0]);
  assert.equal(second.received.filter((ids) => ids.includes('harness')).length, 2);
  const dying = await standIn(base, {diesAfter: 0});
  await assert.rejects(frame(dying.url, cage, {patienceMs: 500}), UnreachableError);
}

async function hangsUpOnAFrame({base}) {
  const slow = await standIn(base, {pauseMs: 800});
  let seen = 0;
  for await (const _ of frameLines(slow.url, cage)) if (++seen === 2) break;
  const stop = new AbortController();
  const slower = await standIn(base, {pauseMs: 100});
  await assert.rejects(async () => {
    for await (const _ of frameLines(slower.url, cage, {signal: stop.signal})) stop.abort();
  }, {name: 'AbortError'});
  const until = Date.now() + 10_000;
  while (!(slow.hungUp && slower.hungUp) && Date.now() < until) await new Promise((done) => setTimeout(done, 10));
  assert.ok(slow.hungUp && slower.hungUp);
  assert.ok(slow.received[0].length < 10);
}

async function validatesWithoutAResult({client}) {
  const dry = await validated(client, '/v1/frames', cage, {jobId: 'dry'});
  assert.deepEqual([dry.job.id, 'result' in dry, 'parts' in dry], ['dry', false, false]);
  await assert.rejects(validated(client, '/v1/frames', {...cage, kerf_mm: -1}), ProblemError);
}

async function drawsABar() {
  let now = 0;
  let text = '';
  const bar = progressBar({isTTY: true, write: (more) => { text += more; }}, {width: 10, now: () => now});
  now = 2000;
  bar(500, 1000, 3);
  bar(501, 1000, 3);  // too soon to be drawn
  now = 4000;
  bar(1000, 1000, 3);
  bar.close();
  assert.equal(text, '\r\x1b[K[#####     ] 500/1000  3 refused  250/s  2 s left\r\x1b[K[##########] 1000/1000  3 refused  250/s\n');
  const silent = progressBar({write: () => assert.fail('no terminal')});
  silent(1, 2, 0);
  silent.close();
}

export const tests = [givesEveryPartOfAFrame, gathersAFrameAndTellsItsProgress, refusesWhatTheServiceRefuses, completesAFrameThatBrokeOff, hangsUpOnAFrame,
  validatesWithoutAResult, drawsABar];

export function close() {
  for (const one of opened) {
    one.closeAllConnections();
    one.close();
  }
}
