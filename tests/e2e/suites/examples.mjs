// Every example as people see it: its picture, and words and numbers that need no dictionary.
import {strict as assert} from 'node:assert';
import {createHash} from 'node:crypto';
import {readFileSync} from 'node:fs';
import {answered, open} from '../browser.mjs';
import {barred, faultsOf, unseen, visited} from '../seen.mjs';

/** Names of fields, checks and warnings without a row in the glossary. */
async function unnamed(service) {
  const rows = new Set([...readFileSync(new URL('../../../docs/glossary.md', import.meta.url), 'utf8').matchAll(/^\| `([^`]+)` \| [^|]+ \|/gm)].map(([, name]) => name));
  const contract = JSON.parse((await service.ask('/openapi.json', {method: 'GET'})).text);
  const found = new Set(contract.components.schemas.WarningCode.enum);
  const seen = new Set();
  const walk = (given) => {
    if (typeof given !== 'object' || given === null || seen.has(given)) return;
    seen.add(given);
    if (given.$ref) walk(contract.components.schemas[given.$ref.split('/').pop()]);
    for (const [name, inner] of Object.entries(given.properties ?? {})) {
      found.add(name);
      walk(inner);
    }
    for (const inner of [...(given.oneOf ?? []), ...(given.allOf ?? []), ...(given.anyOf ?? []), given.items, given.additionalProperties]) walk(inner);
  };
  const {examples} = JSON.parse((await service.ask('/v1/examples', {method: 'GET'})).text);
  for (const {endpoint, body} of examples) {
    const {post} = contract.paths[`/v1/${endpoint}`];
    walk(post.requestBody.content['application/json'].schema);
    walk(post.responses['200'].content['application/json'].schema);
    const {verification} = JSON.parse((await service.post(`/v1/${endpoint}`, body)).text);
    for (const {name} of verification.checks) found.add(name);
  }
  assert.ok(found.size > 500);
  const named = (name) => rows.has(name) || /^(hole|start|finish|cut)_/.test(name) && rows.has(name.replace(/^[a-z]+_/, '')); // `hole_gap` is the gap of a hole
  return [...found].filter((name) => !named(name));
}

async function sound(given, how) {
  const {wrong, kinds, visits} = await visited(given, how);
  console.log(`      ${visits} examples of ${kinds} kinds, seed ${given.seed ?? SEED}`);
  assert.equal(wrong.join('\n'), '');
  assert.ok(kinds > 5 && visits > kinds, 'too few examples were visited');
}

const SEED = '1';

/** About one example of `of`, others for another seed. */
const sample = (of, seed = SEED) => ({endpoint, name}) => createHash('sha256').update(`${seed} ${endpoint}/${name}`).digest()[0] < 256 / of;

export const checks = {
  'fields, checks and warnings have a name': async ({service}) => assert.deepEqual(await unnamed(service), []),
  'the rules find what they look for': () => {
    const names = new Set(['wall_mm']);
    assert.deepEqual(faultsOf('wall_mm is 1234.5678 or 7.1e-15 mm, -0 and NaN, Object', names), ['wall_mm', '1234.5678', '7.1e-15', '-0', 'NaN', 'Object']);
    assert.deepEqual(faultsOf('0.01 mm, 123456, 12000000, a1b2c3d4e5f6, 22:04, −0.5, B from -0.5', names), []);
  },
  'and in a page': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const found = async () => [...await unseen(page), ...await barred(page)];
    assert.deepEqual(await found(), []);
    await page.evaluate(() => {
      document.querySelector('#figures').insertAdjacentHTML('beforeend', '<h3 id="narrow">wide words in a narrow place</h3><button id="mute"></button>');
      Object.assign(document.querySelector('#narrow').style, {display: 'block', width: '40px', whiteSpace: 'nowrap'});
      document.querySelector('#form label').removeAttribute('title');
    });
    assert.deepEqual((await found()).map((each) => each.split(/: ?/)[0]), ['clipped', 'no hint', 'button-name']);
    await page.context().close();
  },
  // The first of each kind and one of ten others, of which a third with every tab; all of them: ./dev soak pages
  'at 1280 and 390 px, light and dark; some with every tab, to axe too': (given) => sound(given, {chosen: sample(10, given.seed), whole: sample(30, given.seed)}),
};
