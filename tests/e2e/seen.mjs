// Checks the visible parts of an example against the console's rules for texts and drawings.
import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {createRequire} from 'node:module';
import {answered, faint, formed, open, pixels, then} from './browser.mjs';

const axe = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** Every name of the contract that no text for people would have: those of more words than one. */
export function wireNames(contract) {
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

/**
 * Returns the faults of a text, by this page's rules: numbers of six digits at most, no rounding
 * errors, no wire names.
 */
export function faultsOf(text, names) {
  const words = (text.match(/\b[a-z0-9]+(?:_[a-z0-9]+)+\b/g) ?? []).filter((word) => names.has(word));
  const long = (text.match(/(?<![\w.])-?\d+(?:\.\d+)?(?!\d|[\w.]*[a-df-zA-Z_]| …)/g) ?? []).filter((number) => {
    const digits = number.replace('-', '').replace('.', '').replace(/^0+/, '');
    return (number.includes('.') ? digits : digits.replace(/0+$/, '')).length > 6;
  });
  const odd = text.match(/(?<!\w)\d+(?:\.\d+)?e[-+]?\d+(?!\w)|(?<![\w.–])-0(?![\w.,])|(?<!\w)(?:NaN|undefined|null|Infinity|Object|\[object)/g) ?? [];
  return [...words, ...long, ...odd];
}

/** Returns texts that do not fit in their place, and fields without a label. */
export const unseen = (page) => page.evaluate(() => {
  const shown = (node) => node.checkVisibility() && !node.closest('.canvas, .uplot, .skip');
  const labels = new Set(document.querySelectorAll('label, legend, th, td, dt, dd, summary, button, figcaption, h3, .name, .unit, .figure, .card-head, [role=option]'));
  const clipped = [...document.querySelectorAll('body *')].filter((node) => {
    if (!(node instanceof HTMLElement) || !shown(node) || !/\S/.test(node.textContent) || node.matches('select, option, script')) return false;
    const hides = /hidden|clip/.test(getComputedStyle(node).overflowX);
    return (hides || (labels.has(node) && node.clientWidth > 0)) && node.scrollWidth > node.clientWidth + 1;
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

/**
 * Serious faults that axe finds. The rows of a long table are alike: of each the first few stay.
 * The others leave the page meanwhile, because axe walks through all that is there, also what it is
 * told to leave out: a table of 360 rows took it four times as long. The table keeps its place.
 */
export async function barred(page) {
  // Playwright's own evaluation is not held by the page's Content-Security-Policy.
  if (!await page.evaluate(() => 'axe' in window)) await page.evaluate(axe);
  const {violations, passes} = await page.evaluate(async () => {
    const tables = [...document.querySelectorAll('table')].map((table) => ({table, style: table.getAttribute('style'), width: table.offsetWidth, height: table.offsetHeight}));
    const alike = [...document.querySelectorAll('tbody')].map((body) => [body, [...body.rows].slice(5)]);
    for (const [, rows] of alike) rows.forEach((row) => row.remove());
    for (const {table, width, height} of tables) Object.assign(table.style, {minWidth: `${width}px`, marginBottom: `${height - table.offsetHeight}px`});
    try {
      return await window.axe.run({exclude: ['.uplot']}, {resultTypes: ['violations']});
    } finally {
      for (const [body, rows] of alike) body.append(...rows);
      for (const {table, style} of tables) table.style.cssText = style ?? '';
    }
  });
  assert.ok(passes.length > 10, 'axe looked at nothing');
  return violations.map(({id, nodes}) => `${id}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 160)).join(' | ')}`);
}

export const unfolded = async (page) => {
  await formed(page);
  await page.evaluate(() => document.querySelectorAll('#form details').forEach((fold) => {
    fold.open = true;
  }));
};

export async function drawn(page, ratio) {
  const points = await page.locator('.chart .plot').evaluateAll((plots) => plots.map((plot) => Number(plot.dataset.points)));
  const solid = await page.locator('#solid').isVisible();
  if (await page.locator('#trouble').isVisible()) return [await page.locator('#trouble').innerText()];
  if (solid) {
    const {share} = await pixels(page, ratio);
    if (share < 0.005) return [`${share} of the 3D canvas is covered`];
  }
  return solid || (points.length && points.every((count) => count > 1)) ? [] : ['no picture'];
}

/** Returns the faults of the visible words, layout and colours. */
async function read(page, names) {
  const text = await page.evaluate(() => document.body.innerText);
  const hints = await page.locator('[title]').evaluateAll((nodes) => nodes.map((node) => node.title).join('\n'));
  return [...new Set([...faultsOf(text, names), ...faultsOf(hints, names).map((each) => `${each} in a hint`), ...await unseen(page)])];
}

const WIDE = {width: 1280, height: 800};
const NARROW = {width: 390, height: 844};
const named = ({size, theme}) => `${size.width} px ${theme}`;

/** Resizes the page and switches its theme, because both are cheaper than a second visit. */
async function show(page, {size, theme}) {
  await Promise.all([page.setViewportSize(size), page.emulateMedia({colorScheme: theme})]);  // laid out and drawn once
  await page.locator(`:root[data-theme=${theme}]`).waitFor();
}

/**
 * Checks of each view of an example. `tabs`: every tab is read; `axe`: each is given to axe too.
 */
function looksAt({whole, first, every}) {
  const both = [{size: WIDE, theme: 'light', words: true, tabs: first || every, axe: every}, {size: NARROW, theme: 'dark', words: true, tabs: first || every, axe: every}];
  if (whole) return [...both, {size: NARROW, theme: 'light', words: true, tabs: true, axe: true}, {size: WIDE, theme: 'dark', words: true, tabs: true, axe: true}];
  return first ? [...both, {size: NARROW, theme: 'light'}, {size: WIDE, theme: 'dark'}] : both;
}

/** Returns the faults of one view of the open example. */
async function faultsIn(page, look, names) {
  await show(page, look);
  const found = (faults, where) => faults.map((fault) => `${named(look)} ${where}: ${fault}`);
  const wrong = [...found(await drawn(page, 'coarse'), 'picture'), ...found(await faint(page), 'colours')];
  if (look.words) {
    await unfolded(page);
    wrong.push(...found(await read(page, names), 'proof'));
  }
  if (look.axe) wrong.push(...found(await barred(page), 'axe'));
  for (const tab of look.tabs ? ['table', 'downloads', 'proof'] : []) {
    await page.locator(`#tab-${tab}`).click();
    if (tab === 'proof') continue;  // read above; it stays open
    wrong.push(...found(await read(page, names), tab));
    if (look.axe) wrong.push(...found(await barred(page), `${tab} axe`));
  }
  return wrong;
}

/** Visits each chosen example once, at both widths and in both themes, and lists the faults of each.
 * `chosen` selects examples in addition to the first of each kind. `whole` selects those of which
 * every tab is read and given to axe in two of the four views, `every` all of them in all four; for
 * the others, the first of each kind has its tabs read.
 */
export async function visited({browser, origin, service}, {chosen = () => true, whole = () => false, every = false, tell = () => {}} = {}) {
  const contract = JSON.parse((await service.ask('/openapi.json', {method: 'GET'})).text);
  const names = wireNames(contract);
  const {examples} = JSON.parse((await service.ask('/v1/examples', {method: 'GET'})).text);
  assert.ok(examples.length > 40);
  const wrong = [];
  const kinds = new Set();
  let visits = 0;
  const page = await open(browser, origin, undefined, WIDE);
  await answered(page);
  let at = 'bevel-tables/source-000-table-1';
  for (const {endpoint, name} of examples) {
    const example = `${endpoint}/${name}`;
    if (kinds.has(endpoint) && !every && !chosen({endpoint, name})) continue;
    visits += 1;
    if (example !== at) {
      await then(page, () => page.evaluate((to) => {
        location.hash = to;
      }, `#/${example}`));
    }
    at = example;
    const looks = looksAt({every, whole: every || whole({endpoint, name}), first: !kinds.has(endpoint)});
    if (looks.length === 2 && page.viewportSize().width === NARROW.width) looks.reverse();  // one resize per example
    for (const look of looks) wrong.push(...(await faultsIn(page, look, names)).map((fault) => `${example} at ${fault}`));
    kinds.add(endpoint);
    tell(example);
  }
  wrong.push(...page.faults.map((fault) => `in the browser: ${fault}`));
  await page.context().close();
  return {wrong, kinds: kinds.size, visits};
}
