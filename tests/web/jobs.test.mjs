// Requests as values: what is changed, what is undone, which endpoint a request is of, and how a name is found.
import {strict as assert} from 'node:assert';
import {readdirSync, readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import test from 'node:test';
import {load} from './load.mjs';

const {parse} = createRequire(new URL('../contract/', import.meta.url))('yaml');
const contractText = readFileSync(new URL('../../openapi.yaml', import.meta.url), 'utf8');
const examples = new URL('../../examples/', import.meta.url);

const {put, at} = await load('src/json.ts');
const {History} = await load('src/history.ts');
const {jobOf} = await load('src/recognise.ts');
const {Contract} = await load('src/schema.ts');
const {found, onlyOne} = await load('src/search.ts');

test('a change copies only what holds it', () => {
  const before = {a: [{b: 1}, {b: 2}], c: {d: [1, 2, 3]}};
  const kept = structuredClone(before);
  const after = put(before, '/a/1/b', 5);
  assert.deepEqual(before, kept);
  assert.equal(at(after, '/a/1/b'), 5);
  assert.notEqual(after.a, before.a);
  assert.equal(after.a[0], before.a[0]);
  assert.equal(after.c, before.c);
  assert.deepEqual(put(before, '/a/0', undefined).a, [{b: 2}]);
  assert.deepEqual(put(before, '/c', undefined), {a: before.a});
  assert.deepEqual(put({}, '/x/y~1z', 1), {x: {'y/z': 1}});
  assert.deepEqual(put(before, '/a/2', {b: 3}).a.length, 3);
});

test('undo leads through every state and back, edits of one field being one step', () => {
  const history = new History();
  history.begin({n: 0});
  for (let n = 1; n <= 5; ++n) history.record({n}, n < 3 ? '/n' : undefined);  // 1 and 2 are one step
  const seen = [];
  for (let step = history.go(-1); step; step = history.go(-1)) seen.push(step.body.n);
  assert.deepEqual(seen, [4, 3, 2, 0]);
  assert.equal(history.undoable.value, false);
  assert.equal(history.go(1).body.n, 2);
  assert.equal(history.go(1).body.n, 3);
  history.record({n: 9});
  assert.equal(history.redoable.value, false);
  assert.equal(history.go(-1).body.n, 3);
});

test('every example is known by its fields', () => {
  const contract = new Contract(parse(contractText));
  const endpoints = readdirSync(examples).filter((name) => contract.request(`/v1/${name}`)).map((id) => ({id}));
  let count = 0;
  for (const {id} of endpoints) {
    for (const name of readdirSync(new URL(id, examples)).filter((each) => each.endsWith('.json'))) {
      const text = readFileSync(new URL(`${id}/${name}`, examples), 'utf8');
      const job = jobOf(text, contract, endpoints, 'grooves');
      assert.equal(job?.endpoint, id, name);
      assert.deepEqual(job.body, JSON.parse(text));
      count += 1;
    }
  }
  assert.ok(count > 40);
  assert.equal(jobOf('no JSON', contract, endpoints, 'frames'), null);
  assert.equal(jobOf('[1]', contract, endpoints, 'frames'), null);
  assert.equal(jobOf('{"colour": "red"}', contract, endpoints, 'frames'), null);
  assert.deepEqual(jobOf('{"job": {"endpoint": "holes"}, "request": {"a": 1}}', contract, endpoints, 'frames'), {endpoint: 'holes', body: {a: 1}});
});

test('a name is found by its parts, however they are spelled', () => {
  const sizes = ['CHS 114.3x6.3', 'CHS 114.3x10', 'CHS 60.3x5', 'NPS 2-1/2 SCH 40', 'NPS 12 SCH 40', 'NPS 1/2 SCH 40'];
  assert.equal(onlyOne(sizes, '114.3 6.3'), 'CHS 114.3x6.3');
  assert.equal(onlyOne(sizes, 'chs 60.3 X 5'), 'CHS 60.3x5');
  assert.equal(onlyOne(sizes, 'CHS 114,3x6,3'), 'CHS 114.3x6.3');
  assert.equal(onlyOne(sizes, 'chs'), undefined);
  assert.equal(onlyOne(sizes, '999'), undefined);
  assert.deepEqual(found(sizes, '1/2'), ['NPS 1/2 SCH 40', 'NPS 2-1/2 SCH 40']);
  assert.deepEqual(found(sizes, ''), sizes);
  for (const size of sizes) assert.equal(found(sizes, size)[0], size);
  assert.equal(onlyOne(['fanuc_style', 'siemens_style'], 'fanuc style'), 'fanuc_style');
});
