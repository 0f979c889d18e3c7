// The examples, the catalogues, and the relations between answers: the echoed request, CBOR,
// validate_only.
import assert from 'node:assert/strict';
import {decode} from '../cbor.mjs';
import {answerFaults} from '../check.mjs';
import {drawings, drawn, hasGenerator, sound} from '../generate.mjs';
import {member, parseRaw, print} from '../raw.mjs';
import {each} from '../service.mjs';

// Requests drawn for each endpoint. An endpoint without a generator gets FEW, because they are near its examples, which are all requested too. With the
// examples, 20 requests of the generators reach 661 members of answers; 60 reach 668. TUBECUT_SOUND gives another number to every endpoint:
// ./dev soak requests takes 60.
const SOUND = Number(process.env.TUBECUT_SOUND ?? drawings(10, 20));
const FEW = Number(process.env.TUBECUT_SOUND ?? drawings(2, 4));

const same = (a, b) => {
  try {
    assert.deepEqual(a, b);
    return true;
  } catch {
    return false;
  }
};

/** `first` is the reply to `body`, 200. */
async function answerPromises({service, contract, report}, endpoint, name, body, first) {
  const about = `${endpoint.id} ${name}`;
  report.fault(about, answerFaults(contract, endpoint, body, first.text));
  const answer = JSON.parse(first.text);

  const echoed = print(member(parseRaw(first.text), 'request'));
  const second = await service.ask(endpoint.path, {body: echoed});
  const withoutTimes = (text) => ({...JSON.parse(text), log: undefined});
  report.expect(same(withoutTimes(second.text), withoutTimes(first.text)), about, 'the echoed request gives another answer');
  if (body.log === undefined) report.expect(second.text === first.text, about, 'the echoed request gives other bytes');

  const binary = await service.post(endpoint.path, body, {headers: {Accept: 'application/cbor'}});
  if (binary.status !== 200) return report.fault(about, `CBOR: ${binary.status} ${binary.text.slice(0, 500)}`);
  report.expect(binary.headers['content-type'] === 'application/cbor', about, `CBOR has type ${binary.headers['content-type']}`);
  report.expect(same({...decode(binary.body), log: undefined}, {...answer, log: undefined}), about, 'CBOR differs from JSON');

  const dry = await service.post(`${endpoint.path}?validate_only=true`, body);
  report.fault(`${about} validate_only`, answerFaults(contract, endpoint, body, dry.text, {validateOnly: true}));
  const checked = JSON.parse(dry.text);
  for (const field of ['job', 'request', 'verification', 'verdict', 'warnings']) {
    report.expect(same(checked[field], answer[field]), about, `validate_only has another ${field}`);
  }
}

async function catalogues({service, contract, report}) {
  for (const {path, valid} of contract.gets()) {
    const reply = await service.ask(path, {method: 'GET'});
    report.expect(reply.status === 200, path, `status ${reply.status}`);
    if (valid) report.fault(path, contract.faults(valid, JSON.parse(reply.text)));
    const head = await service.ask(path, {method: 'HEAD'});
    report.expect(head.status === 200 && head.body.length === 0, path, `HEAD ${head.status}`);
  }
  const json = await service.ask('/openapi.json', {method: 'GET'});
  report.expect(same(JSON.parse(json.text), contract.document), '/openapi.json', 'differs from openapi.yaml');
  const known = JSON.parse((await service.ask('/v1/errors', {method: 'GET'})).text).errors.map((e) => e.code);
  for (const endpoint of contract.posts()) {
    report.expect(endpoint.codes.length > 0, endpoint.id, 'has no x-problem-codes');
    for (const code of endpoint.codes) report.expect(known.includes(code), endpoint.id, `x-problem-codes has ${code}`);
  }
}

export async function answers(context) {
  await catalogues(context);
  const endpoints = context.contract.posts();
  const {examples} = context.contract;
  for (const endpoint of endpoints) {
    context.report.expect(endpoint.examples.length > 0, endpoint.id, 'has no example');
    for (const {name, body} of endpoint.examples) {
      context.report.fault(`example ${name}`, context.contract.faults(endpoint.validRequest, body));
      const first = await context.service.post(endpoint.path, body);
      if (first.status === 200) await answerPromises(context, endpoint, name, body, first);
      else context.report.fault(`${endpoint.id} ${name}`, `${first.status} ${first.text.slice(0, 500)}`);
    }
    await each(drawn(sound(context.contract, endpoint), context.seed, hasGenerator(endpoint) ? SOUND : FEW), async (body, i) => {
      const first = await context.service.post(endpoint.path, body);
      if (first.status === 200) await answerPromises(context, endpoint, `sound ${i}`, body, first);
    });
  }
  return [`${examples.length} examples, ${SOUND} sound requests for each endpoint with a generator, ${FEW} for each other of ${endpoints.length}`];
}
