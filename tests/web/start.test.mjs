// The start page's data: tasks that hold every page, examples that are there, and sketches of requests.
import {strict as assert} from 'node:assert';
import {existsSync, readdirSync, readFileSync} from 'node:fs';
import {test} from 'node:test';
import {load} from './load.mjs';

const {byTask, tasks} = await load('src/tasks.ts');
const {sketched, sketchSize} = await load('src/sketch.ts');
const folder = new URL('../../examples/', import.meta.url);
const examples = readdirSync(folder, {withFileTypes: true}).filter((each) => each.isDirectory() && each.name !== 'commissioning')
  .flatMap(({name: endpoint}) => readdirSync(new URL(`${endpoint}/`, folder)).filter((file) => file.endsWith('.json'))
    .map((file) => ({endpoint, name: file.slice(0, -5), body: JSON.parse(readFileSync(new URL(`${endpoint}/${file}`, folder)))})));

test('every example belongs to a task, and those that a task shows are there', () => {
  assert.ok(examples.length > 60);
  const groups = byTask(examples, ({endpoint}) => endpoint);
  assert.deepEqual(groups.map(({task}) => task?.id), ['joint', 'part', 'frame', 'machine']);
  assert.equal(groups.reduce((sum, {items}) => sum + items.length, 0), examples.length);
  for (const key of tasks.flatMap((task) => task.examples)) assert.ok(existsSync(new URL(`${key}.json`, folder)), key);
  assert.deepEqual(byTask([{id: 'new'}], ({id}) => id), [{task: undefined, items: [{id: 'new'}]}], 'an unknown page is listed too');
});

test('a sketch of every example with a tube lies in its frame', () => {
  let seen = 0;
  for (const {endpoint, name, body} of examples) {
    const sketch = sketched(body, new Map());
    if (!sketch) {
      assert.match(endpoint, /feed-curves|pulse-schedules|replays/, `${endpoint}/${name} has a sketch`);
      continue;
    }
    seen += 1;
    assert.ok(sketch.lines.length > 0 && sketch.lines.length <= 1000);
    for (const {from, to, width} of sketch.lines) {
      assert.ok(width > 0);
      for (const [x, y] of [from, to]) assert.ok(x >= 0 && x <= sketchSize[0] && y >= 0 && y <= sketchSize[1], `${endpoint}/${name}: ${x}, ${y}`);
    }
  }
  assert.ok(seen > 50, `${seen}`);
});

test('of two members the nearer one is drawn last, and one twice as wide is twice as wide', () => {
  const member = (id, y, outer_diameter_mm) => ({id, start_mm: [0, y, 0], end_mm: [1000, y, 0], outer_diameter_mm});
  const {lines: [far, near]} = sketched({members: [member('near', 0, 100), member('far', 500, 200)]}, new Map());
  assert.ok(Math.abs(far.width / near.width - 2) < 1e-9);
  assert.ok(near.from[1] > far.from[1], 'lower in the picture');
});
