// An import is a request of the running service; the command line; other agreements. TUBECUT_SERVER
// is the binary.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Service} from '../../../tests/contract/service.mjs';
import {catalogue, fromIfc, fromPcf} from '../dist/index.js';
import {models} from './support/models.mjs';
import {bytes} from './support/step.mjs';

const here = (path) => new URL(path, import.meta.url);
let service;
before(async () => {
  service = await Service.start(process.env.TUBECUT_SERVER);
});
after(() => service.stop());
const asked = async (frame, query = '') => {
  const {status, text} = await service.ask(`/v1/frames${query}`, {body: JSON.stringify(frame)});
  return {status, body: JSON.parse(text)};
};

test('every IFC frame is a request that the service takes', async () => {
  for (const {name, text} of models) {
    const {frame} = await fromIfc(bytes(text));
    const {status, body} = await asked(frame, '?validate_only=true');
    assert.equal(status, 200, `${name}: ${JSON.stringify(body.errors)}`);
  }
});

test('a PCF spool becomes finished parts', async () => {
  const {frame} = fromPcf(readFileSync(here('data/pipe-spool.pcf'), 'utf8'), {schedule: 'SCH 40'});
  const {status, body} = await asked(frame);
  assert.equal(status, 200, JSON.stringify(body.errors));
  assert.equal(body.verdict.status, 'ok');
  assert.equal(body.result.cut_list.reduce((sum, {count}) => sum + count, 0), 6);
  const made = body.result.joints.map(({branch, chord, kind}) => `${branch} ${kind} ${chord}`);
  for (const joint of ['pipe 4 set_on pipe 1', 'pipe 5 set_on pipe 2', 'pipe 6 set_on elbow 1', 'pipe 1 set_on flange 1']) assert.ok(made.includes(joint), made.join());
});

test('a brace on a square tube of an IFC file is cut by it', async () => {
  const {frame} = await fromIfc(bytes(models.find(({name}) => name === 'bend and box millimetre IFC4').text));
  const {status, body} = await asked(frame);
  assert.equal(status, 200, JSON.stringify(body.errors));
  assert.deepEqual(body.result.joints.map(({branch, chord}) => [branch, chord]), [['brace', 'box']]);
});

test('the sizes are those that the service lists, all of them, in its order', async () => {
  const {tubes} = JSON.parse((await service.ask('/v1/tubes', {method: 'GET'})).text);
  assert.deepEqual(catalogue, tubes.map(({size, outer_diameter_mm, wall_mm}) => ({name: size, outer_diameter_mm, wall_mm})));
});

test('the console builds with the same parsers', () => {
  const of = (path) => JSON.parse(readFileSync(here(path), 'utf8')).dependencies;
  const mine = of('../package.json');
  const theirs = of('../../../web/package.json');
  for (const [name, version] of Object.entries(mine)) assert.equal(theirs[name], version, name);
});

test('the command line: the frame, what was not understood, how it ended', () => {
  const folder = mkdtempSync(join(tmpdir(), 'tubecut-import-'));
  const main = here('../dist/main.js').pathname;
  const run = (...given) => spawnSync(process.execPath, [main, ...given], {encoding: 'utf8'});
  try {
    const pcf = run(here('data/pipe-spool.pcf').pathname, '--schedule', 'SCH 40', '--fields', '{"kerf_mm": 2, "allowances": {"clamping_mm": 100}}');
    assert.equal(pcf.status, 0, pcf.stderr);
    assert.equal(pcf.stderr, '');
    assert.equal(pcf.stdout, readFileSync(here('../../../examples/frames/pipe-spool-from-pcf.json'), 'utf8'));
    const file = (name, text) => {
      writeFileSync(join(folder, name), text);
      return join(folder, name);
    };
    const ifc = run(file('a.ifc', models[0].text), '--within', '12');
    assert.equal(ifc.status, 0, ifc.stderr);
    assert.equal(ifc.stderr, '');
    const frame = JSON.parse(ifc.stdout);
    assert.deepEqual([frame.members.length, frame.connect], [models[0].members.length, {within_mm: 12}]);
    const moved = JSON.parse(run(file('a.ifc', models[0].text), '--origin', '100,-200.5,3').stdout);
    moved.members.forEach(({start_mm}, i) => start_mm.forEach((v, axis) => assert.ok(Math.abs(v + [100, -200.5, 3][axis] - frame.members[i].start_mm[axis]) < 1e-6)));
    const csv = run(file('a.csv', 'name,start_x,start_y,start_z,end_x,end_y,end_z\nA,0,0,0,1,0,0\n'), '--column', 'id=name', '--unit', 'm', '--size', '60.3x3.91');
    assert.equal(csv.status, 0, csv.stderr);
    assert.deepEqual(JSON.parse(csv.stdout).members, [{id: 'A', start_mm: [0, 0, 0], end_mm: [1000, 0, 0], outer_diameter_mm: 60.3, wall_mm: 3.91}]);
    assert.equal(run(file('b.ifc', 'no model')).status, 1);
    assert.equal(run(join(folder, 'missing.csv')).status, 1);
    for (const wrong of [[], ['a.doc'], ['a.csv', 'b.csv'], ['a.pcf', '--bore', '152.4=big'], ['a.csv', '--decimal', 'x'], ['a.csv', '--unit', 'mile'], ['a.csv', '--column', 'x=y'], ['a.csv', '--nothing'], ['a.csv', '--fields', '3'], ['a.csv', '--origin', '1,2'], ['a.csv', '--origin', '1,,2'], ['a.csv', '--within', '-1'], ['a.csv', '--corner', '0'], ['a.csv', '--corner', 'en_10218']]) {
      const {status, stderr} = run(...wrong);
      assert.equal(status, 2, wrong.join(' '));
      assert.match(stderr, /usage: /);
    }
  } finally {
    rmSync(folder, {recursive: true});
  }
});
