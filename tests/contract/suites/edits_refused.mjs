// One edit that the schema calls invalid: a problem that names the edited field and nothing else.
import fc from 'fast-check';
import {problemFaults} from '../check.mjs';
import {edits} from '../edits.mjs';
import {drawings, hasGenerator, sound} from '../generate.mjs';
import {each} from '../service.mjs';

const BODIES = drawings(25, 60);      // sound requests to edit, each endpoint
const FEW = drawings(3, 6);           // of an endpoint without a generator
const EDITS = drawings(1200, 3600);   // at most, each endpoint
const IN_ALL = drawings(1700, 5000);  // at least
const KINDS = ['type', 'range', 'choice', 'count', 'missing', 'unknown', 'exclusive', 'root'];

// Where a replica has less memory than the contract allows bodies, a longer one is refused before any field of it is read.
function editFaults(contract, problem, edit, reply, tooLong) {
  if (reply.status < 400) return [`answered ${reply.status}`];
  if (tooLong && reply.status === 413) return problemFaults(contract, problem, reply);
  const faults = problemFaults(contract, problem, reply);
  if (faults.length) return faults;
  const body = JSON.parse(reply.text);
  const named = body.errors.map((e) => e.pointer);
  if (!named.includes(edit.pointers[0])) return [`names ${JSON.stringify(named)}, not ${edit.pointers[0]} (${body.code}, ${body.detail})`];
  const others = named.filter((pointer) => !edit.pointers.includes(pointer));
  if (others.length) return [`names ${JSON.stringify(others)} besides ${edit.pointers[0]}`];
  return new Set(named).size < named.length ? [`names one field twice: ${JSON.stringify(body.errors)}`] : [];
}

export async function editsRefused({service, contract, report, seed}) {
  const problem = contract.problem();
  const room = JSON.parse((await service.ask('/v1/limits', {method: 'GET'})).text).limits.body_large_max_bytes;
  const counts = Object.fromEntries(KINDS.map((kind) => [kind, 0]));
  let sent = 0;
  for (const endpoint of contract.posts()) {
    const bodies = fc.sample(sound(contract, endpoint), {seed, numRuns: hasGenerator(endpoint) ? BODIES : FEW});
    const all = bodies.flatMap((body) => edits(contract, endpoint.request, body));
    const chosen = fc.sample(fc.shuffledSubarray(all, {minLength: all.length}), {seed, numRuns: 1})[0].slice(0, EDITS);
    await each(chosen, async (edit) => {
      const body = edit.apply();
      if (endpoint.validRequest(body)) return;
      const reply = await service.post(endpoint.path, body);
      counts[edit.kind] += 1;
      sent += 1;
      const faults = editFaults(contract, problem, edit, reply, Buffer.byteLength(JSON.stringify(body)) > room);
      if (faults.length) report.fault(`${endpoint.id} ${edit.kind} ${edit.pointers[0]}`, `${faults[0]}\n  body ${JSON.stringify(body).slice(0, 1200)}`);
    });
  }
  report.expect(sent >= IN_ALL, 'edits', `only ${sent} of ${IN_ALL}`);
  for (const kind of KINDS) report.expect(counts[kind] > 0, 'edits', `none of kind ${kind}`);
  return [`${sent} edits ${JSON.stringify(counts)}`];
}
