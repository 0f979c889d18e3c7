// The form in the console: a request is rewritten for another tube without losing what that one has too.
import {strict as assert} from 'node:assert';
import {test} from 'node:test';
import {load} from './load.mjs';

const {Form} = await load('src/form.ts');
const {Contract} = await load('src/schema.ts');

const number = {type: 'number'}, text = {type: 'string'};
const row = (properties, ...required) => ({type: 'object', additionalProperties: false, required, properties});
const end = {oneOf: [row({cutters: {type: 'array', minItems: 1, items: row({wall_mm: number}, 'wall_mm')}}, 'cutters'), row({square_at_mm: number}, 'square_at_mm')]};
const ends = row({start: end, finish: end}, 'start', 'finish');
const round = {kind: {const: 'round', default: 'round'}, id: text};
const box = {kind: {const: 'rectangular_tube', default: 'rectangular_tube'}, id: text};
const rounds = {oneOf: [row({...round, outer_diameter_mm: number}, 'outer_diameter_mm'), row({...round, size: text}, 'size')]};
const boxes = {oneOf: [row({...box, height_mm: number}, 'kind', 'height_mm'), row({...box, size: text}, 'size')]};
const accept = (...names) => row(Object.fromEntries(names.map((name) => [name, number])));
const schema = {oneOf: [
  row({members: {type: 'array', items: number}}, 'members'),
  row({target: rounds, ends, holes: {type: 'array', items: number}, datum: {enum: ['up', 'seam']}, accept: accept('max_b_deg', 'min_web_mm')}, 'target', 'ends'),
  row({target: boxes, ends, datum: {const: 'up', default: 'up'}, accept: accept('max_b_deg')}, 'target', 'ends'),
]};
const choices = {machine: [], size: ['CHS 60.3x4'], rectangular_size: ['SHS 60x60x4 EN 10219']};

function formOf(body) {
  const contract = new Contract({components: {schemas: {}}});
  const form = new Form(contract, choices, () => {});
  form.show(schema, body);
  const branches = contract.branches(schema);
  const branch = () => form.branchOf(branches, form.body);
  const tubes = () => contract.branches(contract.together(branches, branches[branch()]).properties.target);
  return {form, branch, tubes, contract};
}

const job = {
  target: {id: 'rail', outer_diameter_mm: 60},
  ends: {start: {square_at_mm: 5}, finish: {cutters: [{wall_mm: 7}, {wall_mm: 8}]}},
  holes: [1],
  datum: 'seam',
  accept: {max_b_deg: 3, min_web_mm: 4},
};

test('all kinds of tubes are offered together, each under a name of its own', () => {
  const {tubes, contract} = formOf(job);
  const names = tubes().map((each) => contract.branchName(tubes(), each));
  assert.equal(names.length, 4);
  assert.equal(new Set(names).size, 4, names.join());
});

test('another kind of tube keeps the ends, and leaves out what it does not have', () => {
  const {form, branch, tubes} = formOf(job);
  assert.equal(branch(), 1);
  form.rewrite('/target', tubes()[2]);
  assert.equal(branch(), 2);
  assert.deepEqual(form.body, {target: {kind: 'rectangular_tube', id: 'rail', height_mm: 80}, ends: job.ends, accept: {max_b_deg: 3}});
  form.rewrite('/target', tubes()[0]);
  assert.equal(branch(), 1);
  assert.deepEqual(form.body, {target: {kind: 'round', id: 'rail', outer_diameter_mm: 60}, ends: job.ends, accept: {max_b_deg: 3}});
});

test('a size is one of its kind, which its name tells too', () => {
  const {form, branch, tubes} = formOf({...job, target: {size: 'CHS 60.3x4'}});
  assert.equal(branch(), 1);
  assert.deepEqual(form.namesFor('/target/size'), choices.size);
  form.rewrite('/target', tubes()[3]);
  assert.deepEqual(form.body.target, {kind: 'rectangular_tube', size: 'SHS 60x60x4 EN 10219'});
  assert.deepEqual(form.namesFor('/target/size'), choices.rectangular_size);
  assert.equal(formOf({target: {size: 'SHS 60x60x4 EN 10219'}, ends: job.ends}).branch(), 2);
  assert.equal(formOf({...job, target: {size: 'SHS 60x60x4 EN 10219'}}).branch(), 2, 'with fields that it does not have, too');
});
