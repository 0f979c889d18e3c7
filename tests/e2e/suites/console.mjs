import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {answered, answers, open, pixels, then} from '../browser.mjs';

const table1 = JSON.parse(await readFile(new URL('../../../examples/bevel-tables/source-000-table-1.json', import.meta.url)));
const field = (page, pointer) => page.locator(`[data-pointer="${pointer}"]`);
const clean = (page) => {
  assert.deepEqual(page.faults, [], 'errors in the browser');
  assert.deepEqual(page.strangers, [], 'requests to others');
};
const pill = (page) => page.locator('#verdict .pill').innerText();

async function computes({browser, origin, service}, width, height) {
  const {text} = await service.post('/v1/bevel-tables', table1);
  const answer = JSON.parse(text);
  const page = await open(browser, origin, undefined, {width, height});
  await answered(page);
  assert.equal(await pill(page), answer.verdict.status);
  const count = answer.result.points.phi_deg.length;
  assert.equal(count, 360);
  for (const chart of ['bevel', 'height', 'wrap']) {
    assert.equal(await page.locator(`#chart-${chart} .plot`).getAttribute('data-points'), String(count), chart);
  }
  const {share} = await pixels(page);
  assert.ok(share > 0.05, `${share} of the 3D canvas is covered`);
  const {scroll, seen} = await page.evaluate(() => ({scroll: document.documentElement.scrollWidth, seen: innerWidth}));
  assert.ok(scroll <= seen, `the page is ${scroll} px wide`);
  await page.locator('#tab-json').click();
  const shown = await page.locator('#answer-json').innerText();
  assert.ok(shown.includes(answer.job.result_sha256), 'the answer as JSON');
  clean(page);
  await page.context().close();
}

export const checks = {
  'Table 1 at 1280 px': (given) => computes(given, 1280, 800),
  'Table 1 at 390 px': (given) => computes(given, 390, 844),

  'it is painted within a second, and is small': async ({browser, origin}) => {
    const paints = [];
    for (let i = 0; i < 3; ++i) {
      const page = await open(browser, origin);
      await answered(page);
      await pixels(page);
      const {paint, came} = await page.evaluate(() => ({
        paint: performance.getEntriesByName('first-contentful-paint')[0].startTime,
        came: performance.getEntriesByType('resource').map(({name, encodedBodySize}) => [new URL(name).pathname, encodedBodySize]).filter(([name]) => /^.assets/.test(name)),
      }));
      paints.push(paint);
      assert.ok(came.some(([name]) => /stage-/.test(name)) && !came.some(([name]) => /importer|ifc/.test(name)), `came: ${came}`);
      const bytes = came.reduce((sum, [, size]) => sum + size, 0);
      assert.ok(bytes > 100000 && bytes < 300000, `${bytes} bytes of script and style, the 3D with them`);
      await page.context().close();
    }
    assert.ok(Math.min(...paints) < 1000, `first paints after ${paints} ms`);  // the least: others may have the processor
  },

  'before and after': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const after = await pixels(page);
    await page.locator('#view-before').click();
    await page.locator('#view-before[aria-pressed=true]').waitFor();
    const before = await pixels(page);
    assert.notEqual(before.sum, after.sum, 'the picture did not change');
    await page.waitForURL(/view=before/);
    await page.locator('#view-after').click();
    assert.equal((await pixels(page)).sum, after.sum, 'the picture did not come back');
    clean(page);
    await page.context().close();
  },

  'an edit is computed, kept in the address, and shared': async ({browser, origin, service}) => {
    const page = await open(browser, origin);
    await answered(page);
    await then(page, () => field(page, '/cutters/0/inclination_deg').fill('80'));
    await page.waitForURL(/#\/bevel-tables\/~/);
    const edited = structuredClone(table1);
    edited.cutters[0].inclination_deg = 80;
    const {job} = JSON.parse((await service.post('/v1/bevel-tables', edited)).text);
    const other = await open(browser, origin, new URL(page.url()).hash);
    await answered(other);
    await other.locator('#tab-json').click();
    assert.ok((await other.locator('#answer-json').innerText()).includes(job.input_sha256));
    await then(page, () => page.locator('#reset').click());
    assert.equal(await field(page, '/cutters/0/inclination_deg').inputValue(), '85');
    clean(page);
    clean(other);
    await page.context().close();
    await other.context().close();
  },

  'a refused field is named where it is': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const wall = field(page, '/target/wall_mm');
    await then(page, () => wall.fill('0'));
    assert.equal(await pill(page), 'refused');
    assert.equal(await wall.getAttribute('aria-invalid'), 'true');
    const note = page.locator(`#${await wall.getAttribute('aria-describedby')}`);
    assert.match(await note.innerText(), /0\.5/);
    await then(page, () => field(page, '/cutters/2/inclination_deg').fill('abc'));
    assert.equal(await field(page, '/cutters/2/inclination_deg').getAttribute('aria-invalid'), 'true', 'text where a number belongs');
    await page.locator('#verdict li [data-to="/target/wall_mm"]').click();
    assert.equal(await page.evaluate(() => document.activeElement.dataset.pointer), '/target/wall_mm');
    await then(page, () => wall.fill('5'));
    await then(page, () => field(page, '/cutters/2/inclination_deg').fill('35'));
    assert.equal(await pill(page), 'ok');
    assert.equal(await page.locator('[aria-invalid]').count(), 0);
    clean(page);
    await page.context().close();
  },

  'what is typed stands as it is typed, refused or not; a unit is dragged': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    for (const pointer of ['/cutters/1/outer_diameter_mm', '/target/wall_mm']) {
      const input = field(page, pointer);
      const was = await input.inputValue();
      await then(page, () => input.fill('0'));
      assert.equal(await input.getAttribute('aria-invalid'), 'true', pointer);
      for (const [key, value] of [['.', '0.'], ['0', '0.0'], ['Backspace', '0.'], ['7', '0.7']]) {
        await then(page, () => input.press(key));
        assert.equal(await input.inputValue(), value, pointer);
      }
      await then(page, () => input.fill(was));
      assert.equal(await page.locator('[aria-invalid], .complaint').count(), 0, pointer);
    }
    const diameter = field(page, '/target/outer_diameter_mm');
    const {x, y} = await page.locator('.box', {has: diameter}).locator('.unit').boundingBox();
    await page.mouse.move(x + 4, y + 4);
    await page.mouse.down();
    await then(page, () => page.mouse.move(x + 44, y + 4));
    await page.mouse.up();
    await page.mouse.move(x + 84, y + 4);
    assert.equal(await diameter.inputValue(), '80');
    clean(page);
    await page.context().close();
  },

  'a node is built by hand': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    await then(page, () => page.getByRole('button', {name: /^Add to partners: tube/}).first().click());
    assert.equal(await page.locator('table.tubes tbody tr').count(), 5);
    await then(page, () => page.getByRole('button', {name: 'Remove row 5'}).click());
    assert.equal(await page.locator('table.tubes tbody tr').count(), 4);
    await then(page, () => page.getByRole('button', {name: 'Add to partners: plane'}).click());
    assert.equal(await page.locator('.card').count(), 1, 'the plane is a card');
    assert.equal(await page.locator('table.tubes tbody tr').count(), 4, 'the tubes stay a table');
    assert.notEqual(await pill(page), 'refused');
    clean(page);
    await page.context().close();
  },

  'every endpoint shows its first example, and a job of one’s own from the fewest fields': async ({browser, origin, service}) => {
    const {endpoints} = JSON.parse((await service.ask('/v1/version', {method: 'GET'})).text);
    const page = await open(browser, origin);
    await answered(page);
    const shown = async (id) => assert.ok(await page.locator('.chart, .canvas').count() > 0, `${id} shows nothing`);
    for (const {id} of endpoints) {
      const link = page.locator(`#endpoints [data-endpoint="${id}"]`);
      assert.equal(await link.count(), 1, id);
      if (await link.getAttribute('aria-current') === null) await then(page, () => link.click());
      assert.match(await pill(page), /ok|review/, id);
      await shown(id);
      if (['frames', 'replays'].includes(id)) continue;
      await then(page, () => page.locator('#blank').click());
      assert.notEqual(await pill(page), 'refused', `${id}: ${await page.locator('#verdict').innerText()}`);
      await shown(id);
    }
    assert.ok(await answers(page) >= endpoints.length);
    clean(page);
    await page.context().close();
  },

  'what counts where nothing is entered moves with its row': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const [first, second] = [field(page, '/cutters/0/inclination_deg'), field(page, '/cutters/1/inclination_deg')];
    const kept = await second.getAttribute('placeholder');
    assert.notEqual(await first.getAttribute('placeholder'), kept);
    await page.route('**/v1/**', () => {});  // never answered: the page shows only its own content
    await page.getByRole('button', {name: 'Remove row 1', exact: true}).click();
    assert.equal(await first.getAttribute('placeholder'), kept);
    await page.context().close();
  },

  'by keyboard, with one cursor in all views': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const tilt = field(page, '/cutters/0/inclination_deg');
    await tilt.focus();
    await then(page, () => page.keyboard.press('ArrowDown'));
    assert.equal(await tilt.inputValue(), '84');
    await page.locator('#chart-bevel .plot').focus();
    for (let i = 0; i < 3; ++i) await page.keyboard.press('ArrowRight');
    await page.locator('#readout dd').first().waitFor();
    assert.equal(await page.locator('#readout dd').first().innerText(), '2°');
    const at = await page.evaluate(() => [...document.querySelectorAll('.u-cursor-x')].map((line) => line.getBoundingClientRect().x));
    assert.equal(at.length, 3);
    assert.ok(at.every((x) => Math.abs(x - at[0]) < 2), `cursors at ${at}`);
    await page.locator('.canvas canvas').focus();
    await page.keyboard.press('Home');
    const still = await pixels(page);
    await page.keyboard.press('ArrowLeft');
    assert.notEqual((await pixels(page)).sum, still.sum, 'the arrow keys turn the solid');
    await page.keyboard.press('Home');
    assert.equal((await pixels(page)).sum, still.sum);
    await page.locator('#tab-proof').focus();
    await page.keyboard.press('ArrowRight');
    assert.equal(await page.locator('[role=tab][aria-selected=true]').getAttribute('id'), 'tab-motion');
    clean(page);
    await page.context().close();
  },

  'the cut end tells its values under the pointer': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    await pixels(page);
    const box = await page.locator('.canvas canvas').boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height * 0.7);
    await page.locator('#readout:not(.idle) dd', {hasText: /\d/}).first().waitFor();
    assert.ok((await page.locator('#readout dd', {hasText: /\d/}).count()) >= 8);
    clean(page);
    await page.context().close();
  },

  'pulses of the cut': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/bevel-tables/source-000-table-1?tab=motion');
    await answered(page);
    await page.locator('.motion #chart-pulses').waitFor();
    await page.locator('.motion #chart-speed').waitFor();
    await then(page, () => page.locator('#open-pulses').click());
    assert.equal(await page.locator('#endpoints [aria-current]').getAttribute('data-endpoint'), 'pulse-schedules');
    assert.notEqual(await pill(page), 'refused');
    clean(page);
    await page.context().close();
  },

  'copied as curl': async ({browser, origin, service}) => {
    const page = await open(browser, origin, '#/bevel-tables/source-000-table-1?tab=json');
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write'], {origin});
    await answered(page);
    await page.getByRole('button', {name: 'Copy as curl'}).click();
    await page.getByRole('button', {name: 'Copied'}).waitFor();
    const line = await page.evaluate(() => navigator.clipboard.readText());
    const [, body, address] = /--data '(.*)' (\S+)$/.exec(line);
    assert.equal(address, `${origin}/v1/bevel-tables`);
    assert.equal((await service.ask('/v1/bevel-tables', {body})).status, 200);
    assert.deepEqual(JSON.parse(body), table1);
    await page.context().close();
  },
};
