// How values are entered: in mm or in inches, as people write them, and nothing is refused or moves while they type.
import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {answered, answers, openPlain as open, then} from '../browser.mjs';

const table1 = JSON.parse(await readFile(new URL('../../../examples/bevel-tables/source-000-table-1.json', import.meta.url)));
const field = (page, pointer) => page.locator(`[data-pointer="${pointer}"]`);
async function request(page) {
  const tab = page.locator('#tab-json');
  if (await tab.getAttribute('aria-selected') !== 'true') await tab.click();
  return JSON.parse(await page.locator('#request-json').innerText());
}

export const checks = {
  'lengths are entered and shown in mm or inches, and the request is in mm': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const diameter = field(page, '/target/outer_diameter_mm');
    await then(page, () => diameter.fill('24.15*2'));
    assert.equal((await request(page)).target.outer_diameter_mm, 48.3);
    await then(page, () => diameter.fill('2-3/8in'));
    assert.equal((await request(page)).target.outer_diameter_mm, 60.325);
    const cut = page.locator('.figure', {hasText: /^Cut length/});
    const mm = Number.parseFloat(await cut.locator('b').innerText());
    await then(page, () => page.locator('#units').click());
    assert.equal(await diameter.inputValue(), '2.375');
    assert.equal(await page.locator('.box', {has: diameter}).locator('.unit').innerText(), 'in');
    assert.match(await cut.locator('b').innerText(), / in$/);
    assert.ok(Math.abs(25.4 * Number.parseFloat(await cut.locator('b').innerText()) - mm) < 0.03, 'the same length');
    await then(page, () => diameter.fill('1.75'));
    assert.equal((await request(page)).target.outer_diameter_mm, 44.45);
    await then(page, () => diameter.fill('60.3mm'));
    assert.equal((await request(page)).target.outer_diameter_mm, 60.3);
    await page.reload();
    await answered(page);
    assert.equal(await page.locator('#units').innerText(), 'inch', 'remembered');
    await then(page, () => page.locator('#units').click());
    assert.equal(await diameter.inputValue(), '60.3');
    assert.deepEqual(await request(page), {...table1, target: {...table1.target, outer_diameter_mm: 60.3}});
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'what is typed is of the job that it was typed in': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/bevel-tables/source-000-table-1');
    await answered(page);
    await field(page, '/target/wall_mm').fill('6');  // no pause after it
    await then(page, () => page.evaluate(() => {
      location.hash = '#/intersections/source-000-table-1';
    }));
    await page.waitForTimeout(600);
    assert.equal((await request(page)).target.wall_mm, 5);
    await page.locator('#tab-proof').click();
    await field(page, '/target/wall_mm').fill('7');
    const [file] = await Promise.all([page.waitForEvent('download'), page.locator('#save-job').click()]);
    assert.equal(JSON.parse(await readFile(await file.path(), 'utf8')).target.wall_mm, 7);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'nothing is checked in the middle of a number, and nothing moves': async ({browser, origin}) => {
    for (const size of [{width: 1280, height: 800}, {width: 390, height: 844}]) {
      const page = await open(browser, origin, undefined, size);
      await answered(page);
      if (size.width < 800) await page.locator('#edit').click();
      const wall = field(page, '/target/wall_mm');
      const shown = size.width < 800 ? '.pick, [data-pointer="/target/wall_mm"]' : '#pictures, #verdict';  // a phone has the pictures under the form
      const places = () => page.locator(shown).evaluateAll((nodes) => nodes.map((node) => node.getBoundingClientRect().top + document.documentElement.scrollTop));
      const before = await places();
      const count = await answers(page);
      await wall.focus();
      await page.keyboard.press('Control+a');
      await page.evaluate(() => {
        const input = document.activeElement;
        window.seen = [];
        new MutationObserver(() => window.seen.push(input.getAttribute('aria-invalid'))).observe(input, {attributes: true, attributeFilter: ['aria-invalid']});
      });
      await page.keyboard.type('0.7');  // 0 is refused
      await page.keyboard.press('Tab');
      await answered(page, count + 1);
      assert.equal(await wall.inputValue(), '0.7');
      assert.deepEqual(await page.evaluate(() => window.seen.filter(Boolean)), [], 'refused while it was typed');
      await then(page, () => wall.fill('0'));
      assert.equal(await page.locator('#verdict .pill').innerText(), 'refused');
      assert.deepEqual(await places(), before, 'the page moved');
      assert.deepEqual(page.faults, []);
      await page.context().close();
    }
  },
};
