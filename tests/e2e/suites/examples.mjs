// Every example as people see it: its picture, and words and numbers that need no dictionary.
import {strict as assert} from 'node:assert';
import {readFileSync} from 'node:fs';
import {answered, faint, formed, open, pixels, then} from '../browser.mjs';

/** Every name of the contract that no text for people would have: those of more words than one. */
function wireNames(contract) {
  const names = new Set();
  const walk = (value) => {
    if (typeof value !== 'object' || value === null) return;
    for (const name of [...Object.keys(value.properties ?? {}), ...(value.enum ?? []), value.const]) {
      if (typeof name === 'string' && name.includes('_')) names.add(name);
    }
    Object.values(value).forEach(walk);
  };
  walk(contract);
  assert.ok(names.size > 300);
  return names;
}

/** What is wrong with a text, by the rules of how this page writes: numbers of six digits at most, no rounding's leftovers, no wire names. */
function faultsOf(text, names) {
  const words = (text.match(/\b[a-z0-9]+(?:_[a-z0-9]+)+\b/g) ?? []).filter((word) => names.has(word));
  const long = (text.match(/(?<![\w.])-?\d+(?:\.\d+)?(?!\d|[\w.]*[a-df-zA-Z_]| …)/g) ?? []).filter((number) => {
    const digits = number.replace('-', '').replace('.', '').replace(/^0+/, '');
    return (number.includes('.') ? digits : digits.replace(/0+$/, '')).length > 6;
  });
  const odd = text.match(/(?<!\w)\d+(?:\.\d+)?e[-+]?\d+(?!\w)|(?<![\w.–])-0(?![\w.,])|(?<!\w)(?:NaN|undefined|null|Infinity|\[object)/g) ?? [];
  return [...words, ...long, ...odd];
}

/** Texts that do not fit where they stand, and fields that say nothing of themselves. */
const unseen = (page) => page.evaluate(() => {
  const shown = (node) => node.checkVisibility() && !node.closest('.canvas, .uplot, .skip');
  const clipped = [...document.querySelectorAll('body *')].filter((node) => {
    if (!(node instanceof HTMLElement) || !shown(node) || !/\S/.test(node.textContent) || node.matches('select, option, script')) return false;
    const style = getComputedStyle(node);
    return /hidden|clip/.test(style.overflowX) && node.scrollWidth > node.clientWidth + 1;
  }).map((node) => `clipped: ${node.className || node.tagName} ${node.textContent.slice(0, 60)}`);
  const pen = document.createElement('canvas').getContext('2d');
  const cut = [...document.querySelectorAll('select')].filter(shown).filter((node) => {
    pen.font = getComputedStyle(node).font;
    return pen.measureText(node.selectedOptions[0]?.text ?? '').width > node.clientWidth - 26;  // its arrow
  }).map((node) => `clipped choice: ${node.selectedOptions[0].text}`);
  const silent = [...document.querySelectorAll('#form input, #form select, #form textarea, #form summary, #form button')]
    .filter((node) => shown(node) && !node.closest('[title]:not([title=""])')).map((node) => `no hint: ${node.dataset.pointer ?? node.outerHTML.slice(0, 80)}`);
  const wide = document.documentElement.scrollWidth > innerWidth ? [`the page is ${document.documentElement.scrollWidth} px wide`] : [];
  return [...clipped, ...cut, ...silent, ...wide];
});

const unfolded = async (page) => {
  await formed(page);
  await page.evaluate(() => document.querySelectorAll('#form details').forEach((fold) => {
    fold.open = true;
  }));
};

async function drawn(page, ratio) {
  const points = await page.locator('.chart .plot').evaluateAll((plots) => plots.map((plot) => Number(plot.dataset.points)));
  const solid = await page.locator('#solid').isVisible();
  if (await page.locator('#trouble').isVisible()) return [await page.locator('#trouble').innerText()];
  if (solid) {
    const {share} = await pixels(page, ratio);
    if (share < 0.02) return [`${share} of the 3D canvas is covered`];
  }
  return solid || (points.length && points.every((count) => count > 1)) ? [] : ['no picture'];
}

const other = (theme) => (theme === 'light' ? 'dark' : 'light');

async function every({browser, origin, service}, width, height, theme) {
  const contract = JSON.parse((await service.ask('/openapi.json', {method: 'GET'})).text);
  const names = wireNames(contract);
  const {examples} = JSON.parse((await service.ask('/v1/examples', {method: 'GET'})).text);
  assert.ok(examples.length > 40);
  const page = await open(browser, origin, '', {width, height, theme});
  await answered(page);
  const wrong = [];
  const seen = new Set();
  for (const {endpoint, name} of examples) {
    if (endpoint !== 'bevel-tables' || name !== 'source-000-table-1') {
      await then(page, () => page.evaluate((to) => {
        location.hash = to;
      }, `#/${endpoint}/${name}`));
    }
    const look = async (where) => {
      const text = await page.evaluate(() => document.body.innerText);
      const hints = await page.locator('[title]').evaluateAll((nodes) => nodes.map((node) => node.title).join('\n'));
      const faults = [...faultsOf(text, names), ...faultsOf(hints, names).map((each) => `${each} in a hint`), ...await unseen(page)];
      wrong.push(...[...new Set(faults)].map((fault) => `${endpoint}/${name} ${where}: ${fault}`));
    };
    wrong.push(...(await drawn(page)).map((fault) => `${endpoint}/${name}: ${fault}`));
    await unfolded(page);
    await look('proof');
    wrong.push(...(await faint(page)).map((fault) => `${endpoint}/${name}: ${fault}`));
    if (!seen.has(endpoint)) {
      for (const tab of ['table', 'downloads', 'proof']) {
        await page.locator(`#tab-${tab}`).click();
        if (tab !== 'proof') await look(tab);
      }
      await page.emulateMedia({colorScheme: other(theme)});  // what differs by it are colours: one example of each kind
      await page.locator(`:root[data-theme=${other(theme)}]`).waitFor();
      wrong.push(...[...await drawn(page, 'coarse'), ...await faint(page)].map((fault) => `${endpoint}/${name}, ${other(theme)}: ${fault}`));
      await page.emulateMedia({colorScheme: theme});
    }
    seen.add(endpoint);
  }
  assert.equal(wrong.join('\n'), '');
  assert.deepEqual(page.faults, [], 'errors in the browser');
  await page.context().close();
}

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

export const checks = {
  'fields, checks and warnings have a name': async ({service}) => assert.deepEqual(await unnamed(service), []),
  'the rules find what they look for': () => {
    const names = new Set(['wall_mm']);
    assert.deepEqual(faultsOf('wall_mm is 1234.5678 or 7.1e-15 mm, -0 and NaN', names), ['wall_mm', '1234.5678', '7.1e-15', '-0', 'NaN']);
    assert.deepEqual(faultsOf('0.01 mm, 123456, 12000000, a1b2c3d4e5f6, 22:04, −0.5, B from -0.5', names), []);
  },
  'at 1280 px': (given) => every(given, 1280, 800, 'light'),
  'at 390 px, dark': (given) => every(given, 390, 844, 'dark'),
};
