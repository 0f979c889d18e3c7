#!/usr/bin/env node
import {readFileSync} from 'node:fs';
import {parseArgs} from 'node:util';
import {certify} from './index.js';
import type {Json} from './json.js';
import {table} from './table.js';

const usage = `usage: tubecut-check [--request FILE] [--tubes FILE] [--machines FILE] [--json] ANSWER

Checks an answer of the tubecut service by formulas of its own. ANSWER is the JSON as the service sent it; - is the standard input.
  --request FILE   the request as it was sent: each of its members must be in the answer's echo
  --tubes FILE     the answer of GET /v1/tubes, if the request names sizes such as NPS 4 SCH 40
  --machines FILE  the answer of GET /v1/machines, if the request names a machine
  --json           the certificate as JSON, not as a table
Exit status: 0 all checks hold, 1 one does not, 2 wrong usage or no answer.`;

const fail = (text: string): never => {
  console.error(text);
  process.exit(2);
};

const read = (path: string): string => {
  try {
    return readFileSync(path === '-' ? 0 : path, 'utf8');
  } catch (error) {
    return fail((error as Error).message);
  }
};

const given = (() => {
  try {
    const text = {type: 'string'} as const;
    return parseArgs({
      options: {request: text, tubes: text, machines: text, json: {type: 'boolean'}, help: {type: 'boolean', short: 'h'}},
      allowPositionals: true,
    });
  } catch (error) {
    return fail(`${(error as Error).message}\n${usage}`);
  }
})();

const {values, positionals} = given;
if (values.help) {
  console.log(usage);
  process.exit(0);
}
const [answer] = positionals;
if (answer === undefined || positionals.length > 1) fail(usage);

try {
  const names: {[name: string]: Json} = {};
  for (const name of ['tubes', 'machines'] as const) if (values[name] !== undefined) names[name] = JSON.parse(read(values[name])) as Json;
  const request = values.request === undefined ? undefined : read(values.request);
  const certificate = certify(read(answer as string), request, names);
  console.log(values.json ? JSON.stringify(certificate, null, 2) : table(certificate));
  process.exitCode = certificate.passed ? 0 : 1;
} catch (error) {
  fail(`this is no answer of the service: ${(error as Error).message}`);
}
