// The command line, without a service: exit status, table, what is not covered.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {createHash} from 'node:crypto';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {sha256} from '../dist/json.js';
import {seal} from './support/spoil.mjs';

const main = fileURLToPath(new URL('../dist/main.js', import.meta.url));
const run = (input, ...options) => spawnSync(process.execPath, [main, ...options, '-'], {input, encoding: 'utf8'});

// A tube of 60 mm on a plane across it: the curve is a circle at z = 0.
const flat = () => {
  const phi = Array.from({length: 8}, (_, i) => i * 45);
  const profile = (surface, radius) => ({surface, radius_mm: radius, points: {phi_deg: phi, z_mm: phi.map(() => 0), cutter: phi.map(() => 0)}, events: [],
    length_mm: 2 * Math.PI * radius, developed_length_mm: 2 * Math.PI * radius});
  return seal({
    job: {endpoint: 'intersections'},
    request: {target: {outer_diameter_mm: 60, wall_mm: 4}, cutters: [{kind: 'plane', point_mm: [0, 0, 0], normal: [0, 0, 1]}], sampling: {uniform_points: 8}},
    result: {profiles: [profile('inner', 26), profile('outer', 30)]},
  });
};

test('a sound answer exits with 0 and states every check with value and bound', () => {
  const {status, stdout} = run(JSON.stringify(flat()));
  assert.equal(status, 0, stdout);
  assert.match(stdout, /^ok +on_partner +0 +\d/m);
  assert.match(stdout, /all \d+ checks hold\n$/);
});

test('a wrong one exits with 1 and names the place', () => {
  const wrong = flat();
  wrong.result.profiles[1].points.z_mm[3] = 1e-6;
  const {status, stdout} = run(JSON.stringify(seal(wrong)));
  assert.equal(status, 1);
  assert.match(stdout, /^FAILS +on_partner.*row 3$/m);
});

test('what is no answer, and wrong usage, exit with 2', () => {
  assert.equal(run('{"title": 1').status, 2);
  assert.equal(spawnSync(process.execPath, [main, '--nonsense']).status, 2);
  assert.equal(spawnSync(process.execPath, [main]).status, 2);
});

test('a result without its members fails', () => {
  const bare = flat();
  bare.result = {};
  const {status, stdout} = run(JSON.stringify(seal(bare)));
  assert.equal(status, 1);
  assert.match(stdout, /^FAILS +readable/m);
});

test('numbers that no check covers are listed', () => {
  const more = flat();
  more.result.unheard_of = [1, 2];
  assert.match(run(JSON.stringify(seal(more))).stdout, /^not checked {2}\/result\/unheard_of$/m);
});

test('SHA-256 is that of others, at every length about a block', () => {
  for (const length of [0, 1, 55, 56, 63, 64, 65, 119, 120, 1000]) {
    const text = 'ä'.repeat(length >> 1) + 'x'.repeat(length % 2);
    assert.equal(sha256(text), createHash('sha256').update(text).digest('hex'));
  }
});

test('the packed file is run by npx, offline, from any folder', () => {
  const folder = mkdtempSync(join(tmpdir(), 'tubecut-check-'));
  try {
    const npm = (program, ...given) => spawnSync(program, given, {cwd: folder, encoding: 'utf8', env: {...process.env, npm_config_cache: join(folder, 'cache'), npm_config_update_notifier: 'false'}});
    const packed = npm('npm', 'pack', '--silent', fileURLToPath(new URL('..', import.meta.url)));
    assert.equal(packed.status, 0, packed.stderr);
    writeFileSync(join(folder, 'answer.json'), JSON.stringify(flat()));
    const {status, stdout, stderr} = npm('npx', '--offline', '--yes', `--package=./${packed.stdout.trim()}`, 'tubecut-check', 'answer.json');
    assert.equal(status, 0, stderr);
    assert.match(stdout, /all \d+ checks hold\n$/);
  } finally {
    rmSync(folder, {recursive: true});
  }
});
