// Inputs from real work, in data/field: the service's answer to each. TUBECUT_SERVER is the binary.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {Service} from '../../../tests/contract/service.mjs';
import {fromCsv, fromIfc, fromPcf} from '../dist/index.js';

const at = (name) => new URL(`data/field/${name}`, import.meta.url);
const text = (name) => readFileSync(at(name), 'utf8');
const run = (name, ...more) => spawnSync(process.execPath, [new URL('../dist/main.js', import.meta.url).pathname, at(name).pathname, ...more], {encoding: 'utf8'});
let service;
before(async () => {
  service = await Service.start(process.env.TUBECUT_SERVER);
});
after(() => service.stop());
const asked = async (frame) => {
  const {status, text: reply} = await service.ask('/v1/frames', {body: JSON.stringify(frame)});
  const body = JSON.parse(reply);
  assert.equal(status, 200, JSON.stringify(body.errors));
  return {...body, count: body.result.cut_list.reduce((sum, {count}) => sum + count, 0), codes: body.warnings.map(({code}) => code)};
};

test('bores as NPS x 25.4 are requested, then every pipe is there', async () => {
  const first = run('pcf_bore_nps_times_25_4.pcf');
  assert.equal(first.status, 4);
  assert.equal(first.stdout, '');
  assert.match(first.stderr, /152\.4 MM is the bore of 3 components, probably NPS 6 .*--bore "152\.4=NPS 6"/);
  assert.match(first.stderr, /101\.6 MM is the bore of 1 component, probably NPS 4 /);
  assert.match(first.stderr, /state: --bore "152\.4=NPS 6" --bore "101\.6=NPS 4" --schedule\n/);
  const then = run('pcf_bore_nps_times_25_4.pcf', '--bore', '152.4=NPS 6', '--bore', '101.6=DN 100', '--schedule', 'SCH 40');
  assert.equal(then.status, 0, then.stderr);
  const frame = JSON.parse(then.stdout);
  assert.deepEqual(frame.members.map(({size}) => size), ['NPS 6 SCH 40', 'NPS 6 SCH 40', 'NPS 4 SCH 40']);
  assert.equal((await asked(frame)).count, 3);
});

test('a tap connection with a pipe has its hole cut, one without is listed', async () => {
  const {frame, notUnderstood} = fromPcf(text('pcf_tap_connection.pcf'), {schedule: 'SCH 40'});
  assert.deepEqual(notUnderstood.map(({id, type}) => [id, type]), [['line 12', 'TAP-CONNECTION']]);
  const {result, count} = await asked(frame);
  assert.deepEqual(result.joints.map(({branch, chord, kind, hole}) => [branch, kind, chord, hole]), [['pipe 2', 'set_on', 'pipe 1', 'cut']]);
  assert.equal(count, 2);
});

test('pipes between fittings are square and as long as they are drawn', async () => {
  const {frame, notUnderstood} = fromPcf(text('pcf_fittings_between_pipes.pcf'));
  assert.deepEqual(notUnderstood, []);
  for (const within of [frame.connect.within_mm, 200]) {
    const {codes, verdict, count} = await asked({...frame, connect: {within_mm: within}});
    if (within === 5) assert.equal(verdict.status, 'ok');
    assert.ok(!codes.includes('free_end'), `${codes}`);
    assert.equal(count, 5);
  }
});

test('a structural member is a tube', async () => {
  const {frame, notUnderstood} = await fromIfc(readFileSync(at('ifc_structural_member_silent.ifc')));
  assert.deepEqual(notUnderstood, []);
  assert.deepEqual(frame.members, [{id: 'brace', start_mm: [0, 0, 0], end_mm: [3000, 0, 0], size: 'CHS 114.3x6.3'}]);
  assert.equal((await asked(frame)).count, 1);
});

test('a file of rectangular tubes only is a frame', async () => {
  const {status, stdout, stderr} = run('ifc_only_rectangular.ifc');
  assert.deepEqual([status, stderr], [0, '']);
  const frame = JSON.parse(stdout);
  assert.deepEqual(frame.members, [{id: 'C1', start_mm: [0, 0, 0], end_mm: [0, 0, 3000], kind: 'rectangular_tube', height_mm: 200, width_mm: 100, wall_mm: 6.3,
    corner_radius_mm: 12.6, inner_corner_radius_mm: 6.3, up: [0, 1, 0]}]);
  const {result, verdict} = await asked(frame);
  assert.equal(verdict.status, 'ok');
  assert.deepEqual(result.cut_list.map(({members, height_mm, width_mm, wall_mm, long_mm}) => [members, height_mm, width_mm, wall_mm, long_mm]), [[['C1'], 200, 100, 6.3, 3000]]);
});

test('profiles with voids: the round tube is in the frame, the corners of the square one are requested', async () => {
  const {status, stderr} = run('ifc_shs_as_profile_with_voids.ifc');
  assert.equal(status, 4);
  assert.match(stderr, /^#47 IfcColumn: .*sharp corners.*\n.*1 rectangular tube has corners.*\n.*state: --corner en_10219\n$/);
  const round = {id: 'C1', start_mm: [0, 0, 0], end_mm: [0, 0, 3000], size: 'CHS 114.3x6.3'};
  const shs = {id: 'C2', start_mm: [2000, 0, 0], end_mm: [2000, 0, 3000], kind: 'rectangular_tube', height_mm: 100, width_mm: 100, wall_mm: 6};
  const all = async (options) => {
    const {frame, notUnderstood} = await fromIfc(readFileSync(at('ifc_shs_as_profile_with_voids.ifc')), options);
    assert.equal((await asked(frame)).count, frame.members.length);
    return [frame.members, notUnderstood.map(({id, guid, reason}) => [id, guid, /too sharp to be cut in a wall of 6 mm|sharp corners|state --corner/.exec(reason)?.[0]])];
  };
  const listed = (reason) => ['#47', '0000000000000000000004', reason];
  assert.deepEqual(await all({}), [[round], [listed('sharp corners'), ['file', undefined, 'state --corner']]]);
  assert.deepEqual(await all({corner_radius_mm: 6}), [[round], [listed('too sharp to be cut in a wall of 6 mm')]]);
  for (const corners of [{corner_radius_mm: 9}, {corners: 'en_10210'}]) assert.deepEqual(await all(corners), [[round, {...shs, ...corners, up: [0, 1, 0]}], []]);
});

test('members by node numbers need the table of nodes, and no more', async () => {
  const members = text('csv_members_by_node_numbers.csv');
  assert.deepEqual(fromCsv(members).asks.map(({option}) => option), ['nodes']);
  const nodes = 'node,x_m,y_m,z_m\n1,0,0,0\n2,12,0,0\n3,6,0,9\n';
  for (const {frame, notUnderstood} of [fromCsv(members, {nodes}), fromCsv(`${members}\n${nodes}`), fromCsv(members, {nodes: nodes.replaceAll('_m', ''), unit: 'm'})]) {
    assert.deepEqual(notUnderstood, []);
    assert.deepEqual(frame.members[1], {id: '2', start_mm: [12000, 0, 0], end_mm: [6000, 0, 9000], outer_diameter_mm: 800, wall_mm: 20});
    assert.equal((await asked(frame)).count, 3);
  }
});

test('pieces in line are stated as such if they are to be merged', () => {
  for (const [name, more, members] of [['csv_in_line_pieces_rounded.csv', {}, 2], ['csv_fe_bay_split_at_nodes.csv', {unit: 'm'}, 8]]) {
    const {frame, notUnderstood} = fromCsv(text(name), {...more, merge_in_line: true});
    assert.deepEqual(notUnderstood, []);
    assert.deepEqual([frame.members.length, frame.merge_in_line, frame.joints], [members, true, undefined]);
  }
  assert.deepEqual(fromCsv(text('csv_fe_bay_split_at_nodes.csv')).asks.map(({option}) => option), ['unit']);
  const merged = run('csv_in_line_pieces_rounded.csv', '--merge-in-line');
  assert.equal(JSON.parse(merged.stdout).merge_in_line, true);
});
