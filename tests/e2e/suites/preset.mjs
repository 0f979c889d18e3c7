// The tube laser's button: the request with it and without it, and the gap it shows.
import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {answered, open, pixels, then} from '../browser.mjs';

const example = async (name) => JSON.parse(await readFile(new URL(`../../../examples/${name}.json`, import.meta.url)));
const pill = (page) => page.locator('#verdict .pill').innerText();
const press = (page) => then(page, () => page.locator('#preset').click());
const pressed = (page) => page.locator('#preset').getAttribute('aria-pressed');
const clean = (page) => assert.deepEqual(page.faults, [], 'errors in the browser');

async function asked(page) {
  await page.locator('#tab-json').click();
  return JSON.parse(await page.locator('#request-json').innerText());
}

/** The scale of the tint begins and ends within 2° of the bevels there are. */
async function spanned(page, {points, ends = {}, holes = []}) {
  const b = [points, ...Object.values(ends).map((end) => end.points), ...holes.map((hole) => hole.points)].flatMap((each) => [...(each?.b_deg ?? []), ...(each === points ? each?.b_raw_deg ?? [] : [])]);
  const [low, high] = (await page.locator('#scale').innerText()).split('\n').map((text) => Number.parseFloat(text.replace('B ', '')));
  assert.ok(Math.abs(low - Math.min(...b)) < 2 && Math.abs(high - Math.max(...b)) < 2, `${low} to ${high} of ${Math.min(...b)} to ${Math.max(...b)}`);
}

async function pressedAndReleased({browser, origin, service}, name, chart, width) {
  const page = await open(browser, origin, `#/${name}`, {width, height: 844});
  await answered(page);
  assert.equal(await pressed(page), 'false');
  const tilted = await pixels(page);
  await spanned(page, JSON.parse((await service.post(`/v1/${name.split('/')[0]}`, await example(name))).text).result);
  await press(page);
  assert.equal(await pressed(page), 'true');
  const body = await asked(page);
  const {text} = await service.post(`/v1/${name.split('/')[0]}`, body);
  const answer = JSON.parse(text);
  assert.equal(answer.request.preset, 'tube_laser');
  assert.ok((await page.locator('#answer-json').innerText()).includes(answer.job.result_sha256));
  const tables = answer.result.ends ? Object.values(answer.result.ends) : [answer.result];
  const most = Math.max(0, ...tables.flatMap(({points}) => [...(points.gap_inner_mm ?? []), ...(points.gap_outer_mm ?? [])]));
  assert.ok(most > 0.5 || answer.result.ends, `a gap of ${most} mm`);
  const [low, high] = (await page.locator('#scale').innerText()).split('\n');
  assert.equal(low, 'gap 0');
  assert.ok(Number.parseFloat(high) >= most - 0.01, `${high} of ${most} mm`);
  if (chart) assert.equal(await page.locator(`#chart-${chart} .plot`).getAttribute('data-points'), String(tables[0].points.phi_deg.length));
  assert.notEqual((await pixels(page)).sum, tilted.sum, 'the picture did not change');
  const scroll = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(scroll <= width, `the page is ${scroll} px wide`);
  await press(page);
  assert.equal(await pressed(page), 'false');
  assert.deepEqual(await asked(page), await example(name));
  assert.equal((await pixels(page)).sum, tilted.sum, 'the picture did not come back');
  clean(page);
  await page.context().close();
}

export const checks = {
  'a bevelled end is cut square, and again as before': (given) => pressedAndReleased(given, 'bevel-tables/source-000-table-1', 'gap', 1280),
  'the same at 390 px': (given) => pressedAndReleased(given, 'bevel-tables/source-000-table-1', 'gap', 390),
  'a chord with its holes too': (given) => pressedAndReleased(given, 'parts/chord-with-holes', '', 1280),

  'a job that came with the preset goes on without it as the service understood it': async ({browser, origin}) => {
    for (const name of ['bevel-tables/tube-laser-branch', 'parts/tube-laser-chord']) {
      const page = await open(browser, origin, `#/${name}`);
      await answered(page);
      assert.equal(await pressed(page), 'true');
      const cut = (await pixels(page)).share;
      await press(page);
      assert.ok(['ok', 'review'].includes(await pill(page)), `${name}: ${await page.locator('#verdict').innerText()}`);
      const body = await asked(page);
      assert.equal(body.preset, undefined);
      assert.deepEqual((body.ends?.finish ?? body).groove, {rule: 'square'});
      assert.ok(Math.abs((await pixels(page)).share - cut) < 0.02);
      clean(page);
      await page.context().close();
    }
  },

  'no other page has the button': async ({browser, origin}) => {
    for (const name of ['holes/set-in-branch', 'nodes/mitre']) {
      const page = await open(browser, origin, `#/${name}`);
      await answered(page);
      assert.equal(await page.locator('#preset').isVisible(), false, name);
      await page.context().close();
    }
  },
};
