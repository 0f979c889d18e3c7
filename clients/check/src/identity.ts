/** That the answer is what the service sent, and of the request that was sent to it. */
import {elements, type Json, type Member, members, sha256, without} from './json.js';
import type {Scope} from './report.js';

/** Hashes over the bytes of the members: of the result whole, of the request without reference and log; of the parts of a frame too. */
export function checkHashes(scope: Scope, text: string, at = 0): void {
  const top = members(text, at);
  const job = JSON.parse(slice(text, top.get('job'))) as {[name: string]: string};
  const [request, result, parts] = [top.get('request'), top.get('result'), top.get('parts')];
  if (request) scope.equal('input_sha256', sha256(without(text, request.value, ['reference', 'log'])), job.input_sha256);
  const asked = request ? members(text, request.value) : new Map();
  if (result && !asked.has('columns') && !isPart(text, asked.get('tables'))) scope.equal('result_sha256', sha256(slice(text, result)), job.result_sha256);
  else if (result) scope.not('job/result_sha256', 'the answer has some columns, its hash is of all');
  if (!parts || !result) return;
  const rows = (JSON.parse(slice(text, result)) as {cut_list: {part: string; result_sha256?: string}[]}).cut_list;
  for (const part of elements(text, parts.value)) {
    const made = members(text, part);
    const answer = made.get('answer');
    if (!answer) continue;
    checkHashes(scope, text, answer.value);
    const inner = members(text, answer.value).get('result');
    const row = rows.find(({part: name}) => name === JSON.parse(slice(text, made.get('part'))));
    if (inner) scope.equal('cut_list_sha256', sha256(slice(text, inner)), row?.result_sha256);
  }
}

const slice = (text: string, member: Member | undefined) => (member ? text.slice(member.value, member.to) : 'null');
const isPart = (text: string, tables: Member | undefined) => tables !== undefined && members(text, tables.value).has('columns');

/** Every member of the request is in its echo, and alike; angles in degrees may be echoed in radians, and back. */
export function checkRequest(scope: Scope, sent: Json, echo: Json, pointer = '/request'): void {
  if (typeof sent === 'number') {
    scope.most('request_echo', typeof echo === 'number' ? Math.abs(sent - echo) / (1 + Math.abs(sent)) : NaN, 1e-12, '', pointer);
  } else if (Array.isArray(sent)) {
    const list = Array.isArray(echo) ? echo : [];
    scope.most('request_echo', sent.length === list.length ? 0 : NaN, 0, '', pointer);
    sent.forEach((item, i) => checkRequest(scope, item, list[i] ?? null, `${pointer}/${i}`));
  } else if (sent && typeof sent === 'object') {
    const names = echo && typeof echo === 'object' && !Array.isArray(echo) ? echo : {};
    for (const [name, value] of Object.entries(sent)) {
      const other = name.replace(/_deg$/, '_rad');
      if (names[name] !== undefined) checkRequest(scope, value, names[name], `${pointer}/${name}`);
      else if (names[other] !== undefined && typeof value === 'number') checkRequest(scope, (value * Math.PI) / 180, names[other], `${pointer}/${name}`);
      else scope.not(`request_echo${pointer}/${name}`, 'the answer does not echo it');
    }
  } else scope.equal('request_echo', echo, sent, pointer);
}
