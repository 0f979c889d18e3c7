// The sides that a model is looked at from, when it is fitted anew, and a request as lines on paper.
import {strict as assert} from 'node:assert';
import {test} from 'node:test';
import {load} from './load.mjs';

const {refit, towards} = await load('src/scene/views.ts');
const {linesOf} = await load('src/lines.ts');
const rounded = (vector) => vector.toArray().map((v) => Math.round(v) + 0);

test('front, right and top are square to each other, and front is the side of the first view', () => {
  for (const [eye, up, front, right] of [
    [[1, -2, 0.7], [0, 0, 1], [0, -1, 0], [1, 0, 0]],
    [[0.55, 1, -0.45], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    [[0.95, -0.75, -0.95], [0, 0, -1], [1, 0, 0], [0, -1, 0]],
  ]) {
    const solid = {eye, up};
    assert.deepEqual(rounded(towards(solid, 'front')), front);
    assert.deepEqual(rounded(towards(solid, 'right')), right);
    assert.deepEqual(rounded(towards(solid, 'top')), up);
    assert.ok(Math.abs(towards(solid, 'first').length() - 1) < 1e-12);
  }
});

test('a model that has grown is fitted anew, a change of a few per cent is not', () => {
  assert.equal(refit(100, 200), 2);
  assert.equal(refit(100, 50), 0.5);
  for (const now of [101, 99, 70]) assert.equal(refit(100, now), 1);
});

test('a request on paper has a line for every value, in the words of the form', () => {
  const lines = linesOf({target: {id: '<b>rail</b>', wall_mm: 5}, cutters: [{kind: 'plane', normal: [1, 0, 1]}], kerf_mm: 1.5, closed: true});
  assert.deepEqual(lines.map(([, value]) => value), ['<b>rail</b>', '5 mm', 'plane', '1, 0, 1', '1.5 mm', 'yes']);
  assert.ok(lines.every(([name]) => name && !name.includes('_')));
});
