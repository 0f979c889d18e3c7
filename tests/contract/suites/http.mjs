// Bodies that are no JSON, methods, media types, Accept and query: each a problem of its own status, and the service lives.
import fc from 'fast-check';
import {problemFaults} from '../check.mjs';
import {each} from '../service.mjs';

const TORN = 400;  // bodies cut or with one byte changed, each endpoint
const NESTED = 33;

const malformed = (good) => [
  '', ' ', '{', '}', '{"target":', '{"a":1,}', '[1,]', "{'a':1}", '{a:1}', '{"a":01}', '{"a":+1}', '{"a":.5}', '{"a":1.}', '{"a":0x10}',
  '{"a":NaN}', '{"a":Infinity}', '{"a":-Infinity}', '{"a":1e}', '{"a":-}', '{"a":1,"a":2}',
  '{"a":"\u0001"}', '{"a":"\\ud800"}', '{"a":"\\x"}', '{"a":tru}', '/* c */ {}', '{} {}', `${good}x`, `${good}\0`, `\ufeff${good}`,
  Buffer.from([0x7b, 0x22, 0xff, 0x22, 0x3a, 0x31, 0x7d]), Buffer.from([0xc0, 0x80]), '['.repeat(200000),
  '['.repeat(NESTED) + ']'.repeat(NESTED),
];

const isJson = (bytes) => {
  try {
    JSON.parse(new TextDecoder('utf-8', {fatal: true}).decode(bytes));
    return true;
  } catch {
    return false;
  }
};

const torn = (good) => fc.record({at: fc.nat(good.length - 1), how: fc.constantFrom('cut', 'change', 'insert', 'remove'), byte: fc.nat(255)})
  .map(({at, how, byte}) => {
    const bytes = Buffer.from(good);
    const [head, tail] = [bytes.subarray(0, at), bytes.subarray(at + 1)];
    if (how === 'cut') return head;
    if (how === 'remove') return Buffer.concat([head, tail]);
    return Buffer.concat([head, Buffer.from([byte]), how === 'change' ? tail : bytes.subarray(at)]);
  }).filter((bytes) => !isJson(bytes));

async function bytesRefused({service, contract, report, seed, problem}, endpoint, good) {
  const bodies = [...malformed(good), ...fc.sample(torn(good), {seed, numRuns: TORN})];
  await each(bodies, async (body) => {
    const reply = await service.ask(endpoint.path, {body});
    const about = `${endpoint.id} ${JSON.stringify(body.toString().slice(0, 60))}`;
    report.fault(about, problemFaults(contract, problem, reply));
    if (reply.status !== 400) return report.fault(about, `status ${reply.status}`);
    const {code, detail} = JSON.parse(reply.text);
    const offset = Number(/ at byte (\d+)$/.exec(detail)?.[1] ?? NaN);
    report.expect(code === 'unreadable_json' && offset >= 0 && offset <= Buffer.byteLength(body), about, `${code}: ${detail}`);
  });
  return bodies.length;
}

const words = (endpoint) => [
  {status: 405, method: 'GET'}, {status: 405, method: 'PUT'}, {status: 405, method: 'DELETE'}, {status: 405, method: 'PATCH'},
  {status: 405, method: 'OPTIONS'},
  {status: 415, headers: {'Content-Type': 'text/plain'}}, {status: 415, headers: {'Content-Type': 'application/x-www-form-urlencoded'}},
  {status: 415, headers: {'Content-Type': 'application/jsonp'}}, {status: 415, headers: {'Content-Type': ''}},
  {status: 415, headers: {'Content-Encoding': 'gzip'}},
  {status: 406, headers: {Accept: 'image/png'}}, {status: 406, headers: {Accept: 'text/*, image/webp;q=0.5'}},
  {status: 406, query: '?format=xml'}, {status: 406, query: '?format=JSON'},
  {status: 400, query: '?formt=json'}, {status: 400, query: '?validate_only=yes'}, {status: 400, query: '?validate_only'},
  {status: 400, query: '?x=%00'}, {status: 400, headers: {'Job-Id': 'a'.repeat(129)}},
  {status: 404, path: `${endpoint.path}/`}, {status: 404, path: `${endpoint.path}x`}, {status: 404, path: '/v2/intersections'}, {status: 404, path: '/'},
  {status: 200, headers: {'Content-Type': 'application/json; charset=utf-8'}}, {status: 200, headers: {'Content-Type': 'Application/JSON'}},
  {status: 200, headers: {Accept: '*/*'}}, {status: 200, headers: {Accept: 'image/png, application/json;q=0.1'}},
  {status: 200, query: '?format=cbor'}, {status: 200, query: '?validate_only=false&format=json'},
];

async function wordsKept({service, contract, report, problem}, endpoint, body) {
  for (const {status, path = endpoint.path, query = '', method = 'POST', headers = {}} of words(endpoint)) {
    const reply = await service.ask(path + query, {method, headers, body: ['GET', 'OPTIONS'].includes(method) ? undefined : body});
    const about = `${endpoint.id} ${method} ${path}${query} ${JSON.stringify(headers)}`;
    report.expect(reply.status === status, about, `status ${reply.status}`);
    if (reply.status !== 200) report.fault(about, problemFaults(contract, problem, reply));
    if (status === 405) report.expect(/\bPOST\b/.test(reply.headers.allow ?? ''), about, `Allow ${reply.headers.allow}`);
    if (status === 406) report.expect(/application\/json.*application\/cbor/.test(JSON.parse(reply.text).detail), about, 'does not list what there is');
  }
  const sent = {'Job-Id': 'order 7/3', 'Idempotency-Key': 'k1', 'X-Request-Id': 'r1', traceparent: `00-${'a'.repeat(32)}-${'b'.repeat(16)}-01`};
  const reply = await service.ask(endpoint.path, {body, headers: sent});
  for (const [name, value] of Object.entries(sent)) report.expect(reply.headers[name.toLowerCase()] === value, endpoint.id, `${name} is not echoed`);
  report.expect(JSON.parse(reply.text).job.id === 'order 7/3', endpoint.id, 'Job-Id is not the job id');
  report.expect(/compute;dur=/.test(reply.headers['server-timing']), endpoint.id, 'Server-Timing');
}

export async function http(given) {
  const context = {...given, problem: given.contract.problem()};
  let bodies = 0;
  for (const endpoint of given.contract.posts()) {
    const good = JSON.stringify(endpoint.examples[0].body);
    bodies += await bytesRefused(context, endpoint, good);
    await wordsKept(context, endpoint, good);
  }
  for (const {path} of given.contract.gets()) {
    const reply = await given.service.ask(path, {body: '{}'});
    given.report.expect(reply.status === 405, path, `POST ${reply.status}`);
    given.report.fault(path, problemFaults(given.contract, context.problem, reply));
  }
  return [`${bodies} malformed bodies`];
}
