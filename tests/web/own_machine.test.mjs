// A machine and a post that are made in the console: the options of the coupon's program, the files, the places of errors.
import {strict as assert} from 'node:assert';
import {readdirSync, readFileSync} from 'node:fs';
import {test} from 'node:test';
import {load} from './load.mjs';

const {fileOf, optionsOf, partOf, placed} = await load('src/own_machine.ts');
const row = (metal_max_mm, more = {}) => ({material: 'S235', metal_max_mm, kerf_mm: 1.4, speed_mm_min: 2400, pierce_height_mm: 3.8, pierce_delay_s: 0.3, cut_height_mm: 1.5, shortest_lead_mm: 2.5, ...more});

test('the coupon takes the thinnest row that its metal does not exceed', () => {
  const process = {clearance_mm: 20, rows: [row(6, {speed_mm_min: 1500}), row(3.5), row(2, {speed_mm_min: 9000})]};
  assert.deepEqual(optionsOf({process}), {pivot_length_mm: '0', speed_mm_min: '2400', lead_mm: '2.5', pierce_height_mm: '3.8', pierce_delay_s: '0.3',
    cut_height_mm: '1.5', clearance_mm: '20', torch: 'on'});
  assert.equal(optionsOf({pivot_length_mm: 150, process: {rows: [row(6)]}}).pivot_length_mm, '150');
  for (const machine of [{}, {process: {rows: []}}, {process: {rows: [row(2)]}}, {process: 3}, {process: {rows: 'x'}}])
    assert.deepEqual(optionsOf(machine), {pivot_length_mm: '0', speed_mm_min: '600'}, 'without a row the torch stays off');
});

test('a file has the name of its machine, whatever that is', () => {
  assert.equal(fileOf('machine', {name: 'rotary_table'})[0], 'rotary_table.json');
  assert.equal(fileOf('post', {name: '../our table/ü'})[0], '.._our_table_.json');
  assert.equal(fileOf('post', {})[0], 'post.json');
  assert.deepEqual(JSON.parse(fileOf('machine', {name: 'a', axes: [1]})[1]), {name: 'a', axes: [1]});
});

test('an opened file is told by its axes', () => {
  const folder = new URL('../../posts/', import.meta.url);
  const posts = readdirSync(folder).map((file) => JSON.parse(readFileSync(new URL(file, folder))));
  assert.ok(posts.length > 3);
  for (const post of posts) assert.equal(partOf(post), 'post', post.name);
  assert.equal(partOf({type: 'generic', axes: [{name: 'A'}]}), 'machine');
  for (const other of [null, 3, [], {}, {members: []}, {axes: 'A'}]) assert.equal(partOf(other), null);
});

test('errors of a post are at its fields, errors of others stay', () => {
  const at = (pointer) => placed({errors: [{code: 'bad_text', pointer}]})[0].pointer;
  assert.equal(at('?post/axes/turn/letter'), '/post/axes/turn/letter');
  assert.equal(at('?post'), '/post');
  assert.equal(at('?post_axis'), '?post_axis');
  assert.equal(at('/machine/axes/1/v_max'), '/machine/axes/1/v_max');
  assert.deepEqual(placed({}), []);
});
