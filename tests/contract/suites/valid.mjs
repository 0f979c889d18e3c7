// Bodies that are valid by the schema are answered, or refused with one of the endpoint's own codes; sound joints are answered.
import fc from 'fast-check';
import {answerFaults, problemFaults} from '../check.mjs';
import {fromSchema, sound} from '../generate.mjs';
import {each} from '../service.mjs';

const ANY = 1200;     // bodies from the schema alone, each endpoint
const SOUND = 1100;   // sound joints
const ENOUGH = 1000;  // of them answered

// The faults of one reply to a body valid by the schema.
function replyFaults({contract, problem}, endpoint, body, reply) {
  if (reply.status === 200) return answerFaults(contract, endpoint, body, reply.text);
  const faults = problemFaults(contract, problem, reply);
  if (faults.length) return faults;
  const {code, errors} = JSON.parse(reply.text);
  if (reply.status === 409 && code === 'numerics_mismatch' && 'numerics' in body) return [];
  if (reply.status !== 422) return [`status ${reply.status} ${code}`];
  const named = new Set([code, ...errors.map((e) => e.code)]);
  return [...named].filter((c) => !endpoint.codes.includes(c)).map((c) => `${c} is not one of the endpoint's codes: ${reply.text}`);
}

// The smallest body that shows the same kind of fault.
async function smallest(judge, arbitrary, seed, runs) {
  const found = await fc.check(fc.asyncProperty(arbitrary, async (body) => (await judge(body)).length === 0), {seed, numRuns: runs});
  return found.failed ? JSON.stringify(found.counterexample[0]) : 'not found again';
}

async function run(context, endpoint, name, arbitrary, runs) {
  const {service, report, seed} = context;
  const counts = {};
  const judge = async (body) => {
    const reply = await service.post(endpoint.path, body);
    const code = [200, 599].includes(reply.status) ? reply.status : JSON.parse(reply.text).code;
    counts[code] = (counts[code] ?? 0) + 1;
    return replyFaults(context, endpoint, body, reply);
  };
  let failed = false;
  await each(fc.sample(arbitrary, {seed, numRuns: runs}), async (body) => {
    const faults = await judge(body);
    if (faults.length && !failed) {
      failed = true;
      report.fault(`${endpoint.id} ${name}`, `${faults[0]}\n  smallest: ${await smallest(judge, arbitrary, seed, runs)}`);
    } else if (faults.length) {
      report.fault(`${endpoint.id} ${name}`, faults[0]);
    }
  });
  return counts;
}

export async function valid(given) {
  const context = {...given, problem: given.contract.problem()};
  const facts = [];
  for (const endpoint of given.contract.posts()) {
    const all = fromSchema(given.contract, endpoint.request).filter((body) => endpoint.validRequest(body));
    const any = await run(context, endpoint, 'any', all, ANY);
    const good = await run(context, endpoint, 'sound', sound(given.contract, endpoint), SOUND);
    given.report.expect(good['200'] >= ENOUGH, endpoint.id, `only ${good['200']} of ${SOUND} sound requests were answered`);
    facts.push(`${endpoint.id}: valid by schema ${JSON.stringify(any)}`, `${endpoint.id}: sound ${JSON.stringify(good)}`);
  }
  return facts;
}
