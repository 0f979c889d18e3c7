// Bodies that are valid by the schema are answered, or refused with one of the endpoint's own codes; sound joints are answered.
import fc from 'fast-check';
import {answerFaults, problemFaults} from '../check.mjs';
import {drawings, drawn, fromSchema, hasGenerator, runsOf, sound} from '../generate.mjs';
import {each} from '../service.mjs';

const ANY = drawings(250, 800);      // bodies from only the schema, each endpoint
const CROSSED = drawings(180, 600);  // sound joints with members of such
const SOUND = drawings(330, 1100);   // sound joints
const ENOUGH = SOUND / 1.1;          // of them answered
const HALF = 0.5;     // of those made from examples
const SEARCHED = 300;  // bodies, for a smaller one that shows the same fault
const SEARCH_MS = 5000;

// Without pins of the numerics version and of machines, of itself or of a request inside.
const PINS = {numerics: 'numerics_mismatch', machine_sha256: 'machine_mismatch'};
const unpinned = (value) => {
  if (Array.isArray(value)) return value.map(unpinned);
  if (value?.constructor !== Object) return value;
  return Object.fromEntries(Object.entries(value).filter(([name]) => !(name in PINS)).map(([name, inner]) => [name, unpinned(inner)]));
};
const pinned = (body) => JSON.stringify(body) !== JSON.stringify(unpinned(body));

// A pin is refused before anything is computed: in one of ten only.
const seldomPinned = (bodies) => fc.tuple(bodies, fc.nat(9)).map(([body, k]) => {
  return k === 0 ? body : unpinned(body);
});

// Sound joints of which some members come from bodies of only the schema.
const crossed = (endpoint, sounds, any) => fc.tuple(sounds, any, fc.infiniteStream(fc.nat(3))).map(([body, other, stream]) => ({
  ...body, ...Object.fromEntries(Object.entries(unpinned(other)).filter(() => stream.next().value === 0)),
})).filter((body) => endpoint.validRequest(body));

// The faults of one reply to a body valid by the schema.
function replyFaults({contract, problem}, endpoint, body, reply) {
  if (reply.status === 200) return answerFaults(contract, endpoint, body, reply.text);
  if (reply.status === 599) return [reply.text];
  const {code, errors} = JSON.parse(reply.text);
  if (code === 'over_budget' && endpoint.path === '/v1/frames') return [];  // it may require more than a minute's work
  const faults = problemFaults(contract, problem, reply);
  if (faults.length) return faults;
  if (reply.status === 409 && Object.values(PINS).includes(code) && pinned(body)) return [];
  if (reply.status !== 422) return [`status ${reply.status} ${code}`];
  const named = new Set([code, ...errors.map((e) => e.code)]);
  return [...named].filter((c) => !endpoint.codes.includes(c)).map((c) => `${c} is not one of the endpoint's codes: ${reply.text}`);
}

// The smallest body that shows a fault, from one that did.
async function smallest(judge, arbitrary, seed) {
  const batch = fc.asyncProperty(arbitrary, async (body) => (await judge(body)).length === 0);
  const found = await fc.check(batch, {seed, numRuns: SEARCHED, interruptAfterTimeLimit: SEARCH_MS});
  return found.counterexample ? JSON.stringify(found.counterexample[0]) : 'not found again';
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
  const taken = await each(drawn(arbitrary, seed, runsOf(endpoint, runs)), async (body) => {
    const faults = await judge(body);
    if (faults.length && !failed) {
      failed = true;
      const less = await smallest(judge, arbitrary, seed);
      report.fault(`${endpoint.id} ${name}`, `${faults[0]}\n  body: ${JSON.stringify(body).slice(0, 40000)}\n  smallest: ${less.slice(0, 40000)}`);
    } else if (faults.length) {
      report.fault(`${endpoint.id} ${name}`, faults[0]);
    }
  });
  return {counts, taken};
}

export async function valid(given) {
  const context = {...given, problem: given.contract.problem()};
  const facts = [];
  let answered = 0;
  for (const endpoint of given.contract.posts()) {
    const all = seldomPinned(fromSchema(given.contract, endpoint.request).filter((body) => endpoint.validRequest(body)));
    const sounds = sound(given.contract, endpoint);
    const any = await run(context, endpoint, 'any', all, ANY);
    const mixed = await run(context, endpoint, 'crossed', crossed(endpoint, sounds, all), CROSSED);
    const good = await run(context, endpoint, 'sound', sounds, SOUND);
    const least = good.taken * (hasGenerator(endpoint) ? ENOUGH / SOUND : HALF);
    given.report.expect(good.counts['200'] >= least, endpoint.id, `only ${good.counts['200']} of ${good.taken} sound requests were answered`);
    for (const [name, {counts}] of Object.entries({any, mixed, good})) {
      facts.push(`${endpoint.id} ${name} ${JSON.stringify(counts)}`);
      answered += counts['200'] ?? 0;
    }
  }
  return [...facts, `${answered} answered`];
}
