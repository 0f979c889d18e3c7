// Requirements of every answer and every problem. Each function returns the list of complaints.
import {createHash} from 'node:crypto';
import {member, parseRaw, print, without} from './raw.mjs';

const sha256 = (text) => createHash('sha256').update(text).digest('hex');

function columnFaults(points, where) {
  const lengths = new Set(Object.values(points).map((column) => column.length));
  return lengths.size === 1 ? [] : [`columns of ${where} have lengths ${[...lengths]}`];
}

function columns(value, where = '') {
  if (Array.isArray(value)) return value.flatMap((item) => columns(item, `${where}/*`));
  if (value === null || typeof value !== 'object') return [];
  return Object.entries(value).flatMap(([name, item]) =>
    (name === 'points' && !Array.isArray(item) ? columnFaults(item, `${where}/points`) : columns(item, `${where}/${name}`)));
}

// A member that was sent is echoed as it was sent; numbers stay the same doubles.
function echoFaults(sent, echo, where = '/request') {
  if (sent === null || typeof sent !== 'object') return sent === echo ? [] : [`${where} echoes ${echo}, sent ${sent}`];
  if (echo === undefined) return [`${where} is not echoed`];
  return Object.entries(sent).flatMap(([name, value]) => echoFaults(value, echo[name], `${where}/${name}`));
}

// The parts of a frame are next to its result: each is a separate answer, whose hash is in its row
// of the cut list.
function partFaults(contract, tree, {parts, result}) {
  const endpoint = {id: 'parts', validResponse: contract.validPart};
  const texts = member(tree, 'parts').items.map((part) => member(part, 'answer'));
  return parts.flatMap(({answer}, i) => {
    if (!answer) return [];
    const faults = answerFaults(contract, endpoint, answer.request, print(texts[i])).map((fault) => `parts/${i}: ${fault}`);
    if (result?.cut_list[i]?.result_sha256 !== answer.job.result_sha256) faults.push(`parts/${i}: its hash is not in the cut list`);
    return faults;
  });
}

// The text of a JSON answer to `sent`.
export function answerFaults(contract, endpoint, sent, text, {validateOnly = false} = {}) {
  let body;
  try {
    body = JSON.parse(text);
  } catch (error) {
    return [`not JSON: ${error.message}`];
  }
  const faults = contract.faults(endpoint.validResponse, body);
  if (faults.length) return faults;
  const tree = parseRaw(text);
  const request = print(without(member(tree, 'request'), ['reference', 'log']));
  if (sha256(request) !== body.job.input_sha256) faults.push('input_sha256 is not that of the request printed');
  if (validateOnly === 'result' in body) faults.push(`result is ${validateOnly ? 'there' : 'missing'}`);
  const whole = !(body.request.columns ?? body.request.tables?.columns);  // else the hash is of more than is printed
  if ('result' in body && whole && sha256(print(member(tree, 'result'))) !== body.job.result_sha256) {
    faults.push('result_sha256 is not that of the result printed');
  }
  if (endpoint.id === 'frames') {
    if (validateOnly === 'parts' in body) faults.push(`parts are ${validateOnly ? 'there' : 'missing'}`);
    else if ('parts' in body) faults.push(...partFaults(contract, tree, body));
  }
  if (body.job.endpoint !== endpoint.id) faults.push(`endpoint ${body.job.endpoint}`);
  if ((sent.log === 'inline') !== ('log' in body)) faults.push('log');
  if (body.verification.checks.length === 0 && !body.result?.invariants?.length) faults.push('nothing was verified');
  for (const check of body.verification.checks) {
    if (!(check.value <= check.limit)) faults.push(`check ${check.name}: ${check.value} > ${check.limit}`);
  }
  return [...faults, ...echoFaults(sent, body.request), ...columns(body.result)];
}

// One reply with an error status.
export function problemFaults(contract, valid, reply) {
  if (reply.status >= 500) return [`status ${reply.status}: ${reply.text.slice(0, 2000)}`];
  const type = reply.headers['content-type'];
  if (type !== 'application/problem+json') return [`content type ${type}`];
  const body = JSON.parse(reply.text);
  const faults = contract.faults(valid, body);
  if (faults.length) return faults;
  if (body.status !== reply.status) faults.push(`status ${body.status} in the body, ${reply.status} outside`);
  if (body.type !== `/v1/errors#${body.code}`) faults.push(`type ${body.type}`);
  if (body.request_id !== reply.headers['x-request-id']) faults.push('request_id is not X-Request-Id');
  if (body.retryable !== [429, 502, 503].includes(reply.status)) faults.push(`retryable ${body.retryable}`);
  for (const field of ['title', 'detail', 'action']) if (!body[field]) faults.push(`${field} is empty`);
  return faults;
}
