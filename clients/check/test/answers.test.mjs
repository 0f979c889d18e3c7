// Answers of the running service: all examples and drawn ones hold, spoilt ones do not. TUBECUT_SERVER is the binary.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdtempSync, readdirSync, readFileSync, rmSync, statSync, symlinkSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {Service} from '../../../tests/contract/service.mjs';
import {certify} from '../dist/index.js';
import {endpoints, random, requests} from './support/draw.mjs';
import {seal, spoil, unstated} from './support/spoil.mjs';

const DRAWN = Number(process.env.CHECK_DRAWN ?? 22);
const SPOILT = Number(process.env.CHECK_SPOILT ?? 60);
const SEED = Number(process.env.CHECK_SEED ?? 50);
const examples = new URL('../../../examples/', import.meta.url);

let service;
let names;
before(async () => {
  service = await Service.start(process.env.TUBECUT_SERVER);
  const of = async (name) => JSON.parse((await service.ask(`/v1/${name}`, {method: 'GET'})).text);
  names = {tubes: await of('tubes'), machines: await of('machines')};
});
after(() => service.stop());

const failures = ({checks}) => checks.filter(({passed}) => !passed).map(({name, value, limit, where}) => `${name}: ${value} > ${limit} ${where}`);
// A connection that was idle while this program computed may be closed already.
const ask = async (path, body) => {
  const reply = await service.ask(path, {body});
  return reply.status === 599 ? service.ask(path, {body}) : reply;
};
const files = (folder) => readdirSync(folder).flatMap((name) => {
  const path = new URL(name, folder);
  return statSync(path).isDirectory() ? files(new URL(`${name}/`, folder)) : name.endsWith('.json') ? [path] : [];
});

// A frame of hundreds of parts takes minutes; CHECK_FRAMES=all has them too.
const large = (file) => process.env.CHECK_FRAMES !== 'all' && file.pathname.includes('/frames/') && !/k-node|jacket/.test(file.pathname);

test('every example holds', async () => {
  let count = 0;
  for (const file of files(examples).filter((path) => !large(path))) {
    const endpoint = file.pathname.split('/').at(-2);
    const request = readFileSync(file, 'utf8');
    const {status, text} = await ask(`/v1/${endpoint}`, request);
    assert.equal(status, 200, `${file.pathname}: ${text.slice(0, 300)}`);
    const certificate = certify(text, request, names);
    assert.deepEqual(failures(certificate), [], file.pathname);
    count += 1;
  }
  assert.ok(count >= 40, `${count} examples`);
});

// Drawn answers one by one, those that the service refuses left out.
async function* drawn(count, seed, of = endpoints) {
  for (const {endpoint, request} of requests(seed, of)) {
    if (count === 0) return;
    if (endpoint === 'replays') {
      const made = await ask('/v1/pulse-schedules', JSON.stringify(request));
      if (made.status !== 200) continue;
      request.schedule = JSON.parse(made.text).result;
    }
    const body = JSON.stringify(request);
    const {status, text} = await ask(`/v1/${endpoint}`, body);
    assert.ok(status === 200 || status === 422, `${status} ${body}`);
    if (status !== 200) continue;
    count -= 1;
    yield {endpoint, request: body, text};
  }
}

test('drawn answers raise no false alarm; of those spoilt at one number 99 in 100 are found', {timeout: 14_400_000}, async (t) => {
  const r = random(SEED + 1);
  const [alarms, missed, counts] = [[], {}, {}];
  let [i, spoilt, lost] = [0, 0, 0];
  for await (const {endpoint, request, text} of drawn(DRAWN, SEED)) {
    counts[endpoint] = (counts[endpoint] ?? 0) + 1;
    const failed = failures(certify(text, request, names));
    if (failed.length) alarms.push(`${endpoint}: ${failed.join('; ')}\n${request}`);
    i += 1;
    for (; spoilt < (SPOILT * i) / DRAWN; spoilt += 1) {
      const {pointer, from, to, text: wrong} = spoil(JSON.parse(text), r);
      if (!certify(wrong, undefined, names).passed) continue;
      lost += 1;
      (missed[`${endpoint} ${pointer}`] ??= []).push(`${from} -> ${to}`);
    }
    // Not a diagnostic, because those come at the end of a test.
    if (process.env.CHECK_DRAWN && i % 50 === 0) console.error(`${i} drawn, ${spoilt - lost} of ${spoilt} spoilt found, ${alarms.length} false alarms`);
  }
  t.diagnostic(`${JSON.stringify(counts)}: ${alarms.length} false alarms; ${spoilt - lost} of ${spoilt} spoilt found; not: ${JSON.stringify(missed)}`);
  assert.deepEqual(alarms, []);
  assert.ok(lost <= Math.ceil(SPOILT / 100), JSON.stringify(missed));
});

test('a changed character of request or result changes a hash', async () => {
  const {value: {text}} = await drawn(1, SEED + 2).next();
  for (const member of ['"request":', '"result":']) {
    const at = text.indexOf(member);
    const digit = at + text.slice(at).search(/\d/);
    const wrong = text.slice(0, digit) + ((Number(text[digit]) + 1) % 10) + text.slice(digit + 1);
    const {checks} = certify(wrong, undefined, names);
    assert.equal(checks.find(({name}) => name === (member === '"result":' ? 'result_sha256' : 'input_sha256')).passed, false);
  }
  const sealed = seal(JSON.parse(text));
  assert.equal(sealed.job.result_sha256, JSON.parse(text).job.result_sha256, 'sealing an untouched answer keeps its hash');
});

test('an answer to another request is found', async () => {
  const {value: {text, request}} = await drawn(1, SEED + 3).next();
  const other = JSON.parse(request);
  other.target.wall_mm += 0.01;
  assert.deepEqual(certify(text, JSON.stringify(other), names).checks.filter(({passed}) => !passed).map(({name}) => name), ['request_echo']);
});

test('docs/checker.md lists the members that are not spoilt, and no other', () => {
  const page = readFileSync(new URL('../../../docs/checker.md', import.meta.url), 'utf8');
  const table = page.slice(page.indexOf('| members | the checker | why |'));
  assert.deepEqual([...table.matchAll(/^\| `(.*?)` \|/gm)].map(([, members]) => members).sort(), [...unstated].sort());
});

test('the example of docs/checker.md prints what the page says', async () => {
  const page = readFileSync(new URL('../../../docs/checker.md', import.meta.url), 'utf8');
  const [, script] = /```sh\n(.*?)```/s.exec(page);
  const folder = mkdtempSync(join(tmpdir(), 'tubecut-check-'));
  try {
    for (const name of ['clients', 'examples']) symlinkSync(fileURLToPath(new URL(`../../../${name}`, import.meta.url)), join(folder, name));
    const shell = spawn('bash', ['-euc', script.replaceAll('127.0.0.1:8080', `127.0.0.1:${service.port}`)], {cwd: folder, stdio: ['ignore', 'pipe', 'inherit']});
    let printed = '';
    for await (const some of shell.stdout) printed += some;
    const [, said] = /last line is `(.*?)`/.exec(page);
    assert.equal(printed.trim(), said);
  } finally {
    rmSync(folder, {recursive: true});
  }
});
