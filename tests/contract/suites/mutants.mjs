// Would the check see a server that answers otherwise? Every object of real answers loses, renames and gains a member.
import {answerFaults} from '../check.mjs';
import {drawn, runsOf, sound} from '../generate.mjs';
import {objects, parseRaw, print} from '../raw.mjs';

const BODIES = 40;

// The request of a part that could not be made is open in the contract, because it may exceed the limits of its endpoint.
const OPEN = '/parts/*/request';

// A lost member that the contract leaves open is seen by the hashes and the echo; columns are never open.
// Maps whose keys are names of the request, of axes for example, are open too.
const closedBySchema = (maps, kind, place) =>
  !maps.has(place.split('/').pop()) && (kind !== 'drop' || place.endsWith('/points'));

// Names of the properties that are such maps.
function mapsOf(node, found = new Set()) {
  for (const [name, property] of Object.entries(node?.properties ?? {})) {
    if (property.additionalProperties?.type) found.add(name);
  }
  if (node !== null && typeof node === 'object') for (const child of Object.values(node)) mapsOf(child, found);
  return found;
}

const MUTATIONS = {
  drop: (node, i) => node.members.splice(i, 1),
  rename: (node, i) => { node.members[i] = [`${node.members[i][0]}_`, node.members[i][1]]; },
  add: (node) => node.members.push(['extra', {leaf: '1'}]),
};

// Every mutation of an answer not seen before, as text.
function* mutated(tree, done) {
  for (const [place, node] of objects(tree)) {
    if (place.startsWith(OPEN)) continue;
    const kept = node.members;
    for (const [kind, change] of Object.entries(MUTATIONS)) {
      for (let i = 0; i < (kind === 'add' ? 1 : kept.length); i += 1) {
        const name = `${kind} ${place}/${kind === 'add' ? 'extra' : kept[i][0]}`;
        if (done.has(name)) continue;
        done.add(name);
        node.members = [...kept];
        change(node, i);
        const text = print(tree);
        node.members = kept;
        yield {kind, place, name, text};
      }
    }
  }
}

export async function mutants({service, contract, report, seed}) {
  const maps = mapsOf(contract.document);
  const counts = {drop: 0, rename: 0, add: 0, bySchema: 0};
  for (const endpoint of contract.posts()) {
    const done = new Set();
    for (const body of drawn(sound(contract, endpoint), seed, runsOf(endpoint, BODIES))) {
      const reply = await service.post(endpoint.path, body);
      if (reply.status !== 200) continue;
      const tree = parseRaw(reply.text);
      report.fault(`${endpoint.id} as it is`, answerFaults(contract, endpoint, body, print(tree)));
      for (const {kind, place, name, text} of mutated(tree, done)) {
        report.expect(answerFaults(contract, endpoint, body, text).length > 0, `${endpoint.id} ${name}`, 'was not seen');
        const bySchema = contract.faults(endpoint.validResponse, JSON.parse(text)).length > 0;
        if (closedBySchema(maps, kind, place)) report.expect(bySchema, `${endpoint.id} ${name}`, 'is open in the schema');
        counts[kind] += 1;
        counts.bySchema += bySchema ? 1 : 0;
      }
    }
    report.expect(done.size > 0, endpoint.id, 'no answer to mutate');
  }
  return [`mutations seen: ${JSON.stringify(counts)}`];
}
