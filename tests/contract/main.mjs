// The contract held against the running service: node main.mjs SUITE --server BINARY --contract openapi.yaml [--seed N] [--endpoint ID]
import {parseArgs} from 'node:util';
import {answers} from './suites/answers.mjs';
import {editsRefused} from './suites/edits_refused.mjs';
import {fields} from './suites/fields.mjs';
import {gltf} from './suites/gltf.mjs';
import {http} from './suites/http.mjs';
import {mutants} from './suites/mutants.mjs';
import {valid} from './suites/valid.mjs';
import {Contract} from './schemas.mjs';
import {Service} from './service.mjs';

const SUITES = {valid, edits: editsRefused, fields, http, answers, mutants, gltf};
const SHOWN = 12;

class Report {
  faults = [];

  fault(about, lines) {
    for (const line of [lines].flat()) this.faults.push(`${about}: ${line}`);
  }

  expect(condition, about, line) {
    if (!condition) this.fault(about, line);
  }
}

const {values, positionals: [suite]} = parseArgs({allowPositionals: true,
  options: {server: {type: 'string'}, contract: {type: 'string'}, seed: {type: 'string'}, endpoint: {type: 'string'}}});
if (!SUITES[suite] || !values.server || !values.contract) {
  console.error(`usage: node main.mjs ${Object.keys(SUITES).join('|')} --server BINARY --contract FILE [--seed N] [--endpoint ID]`);
  process.exit(2);
}
const seed = Number(values.seed ?? Date.now() % 2 ** 31);
console.log(`suite ${suite}, seed ${seed}`);

const service = await Service.start(values.server);
const report = new Report();
try {
  const contract = await new Contract(values.contract).learn(service, values.endpoint);
  const facts = await SUITES[suite]({service, contract, report, seed});
  for (const fact of facts) console.log(fact);
  report.expect(service.alive, 'service', 'it ended');
} finally {
  const code = await service.stop();
  report.expect(code === 0, 'service', `it ended with ${code}`);
}
// One of each kind first: equal words with other digits are the same kind.
const kinds = new Map(report.faults.map((fault) => [fault.slice(0, 120).replace(/\d+/g, '#'), fault]));
for (const fault of [...kinds.values()].slice(0, SHOWN)) console.log(`FAULT ${fault}`);
console.log(`${service.asked} requests, ${report.faults.length} faults`);
process.exitCode = report.faults.length ? 1 : 0;
