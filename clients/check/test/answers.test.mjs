// Answers of the running service: all examples and drawn ones hold, spoilt ones do not. TUBECUT_SERVER is the binary.
import assert from 'node:assert/strict';
import {readdirSync, readFileSync, statSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {Service} from '../../../tests/contract/service.mjs';
import {certify} from '../dist/index.js';
import {endpoints, random, requests} from './support/draw.mjs';
import {seal, spoil} from './support/spoil.mjs';

const DRAWN = Number(process.env.CHECK_DRAWN ?? 24);
const SPOILT = Number(process.env.CHECK_SPOILT ?? 200);
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

// Drawn answers, those that the service refuses left out.
async function drawn(count, seed) {
  const answers = [];
  for (const {endpoint, request} of requests(seed)) {
    if (answers.length === count) break;
    const body = JSON.stringify(request);
    const {status, text} = await ask(`/v1/${endpoint}`, body);
    assert.ok(status === 200 || status === 422, `${status} ${body}`);
    if (status === 200) answers.push({request: body, text});
  }
  return answers;
}

test('drawn answers raise no false alarm; of those spoilt at one number 99 in 100 are found', {timeout: 7_200_000}, async (t) => {
  const answers = await drawn(DRAWN, SEED);
  for (const {request, text} of answers) assert.deepEqual(failures(certify(text, request, names)), [], request);
  const r = random(SEED + 1);
  const missed = new Map();
  for (let i = 0; i < SPOILT; i += 1) {
    const {text} = answers[i % answers.length];
    const {pointer, from, to, text: wrong} = spoil(JSON.parse(text), r);
    if (certify(wrong, undefined, names).passed) missed.set(pointer, [...(missed.get(pointer) ?? []), `${from} -> ${to}`]);
  }
  const count = [...missed.values()].flat().length;
  t.diagnostic(`${answers.length} drawn, ${SPOILT - count} of ${SPOILT} spoilt found; not: ${JSON.stringify(Object.fromEntries(missed))}`);
  assert.ok(count <= SPOILT / 100, JSON.stringify(Object.fromEntries(missed)));
});

test('a changed character of request or result changes a hash', async () => {
  const [{text}] = await drawn(1, SEED + 2);
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
  const [{text, request}] = await drawn(1, SEED + 3);
  const other = JSON.parse(request);
  other.target.outer_diameter_mm += 0.01;
  assert.deepEqual(certify(text, JSON.stringify(other), names).checks.filter(({passed}) => !passed).map(({name}) => name), ['request_echo']);
});
