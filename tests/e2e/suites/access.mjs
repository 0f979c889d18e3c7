import {strict as assert} from 'node:assert';
import {createRequire} from 'node:module';
import {answered, formed, open, then} from '../browser.mjs';

const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');

async function sound(page, where) {
  // Playwright's own evaluation is not held by the page's Content-Security-Policy.
  const {readFile} = await import('node:fs/promises');
  await page.evaluate(await readFile(axe, 'utf8'));
  const {violations, passes} = await page.evaluate(() => window.axe.run());
  assert.ok(passes.length > 10, 'axe looked at nothing');
  const serious = violations.filter(({impact}) => impact === 'serious' || impact === 'critical')
    .map(({id, nodes}) => `${where} ${id}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 160)).join(' | ')}`);
  assert.deepEqual(serious, []);
}

const cases = [[1280, 800, 'light'], [1280, 800, 'dark'], [390, 844, 'light'], [390, 844, 'dark']];
export const checks = Object.fromEntries(cases.map(([width, height, theme]) => [`${width} px, ${theme}`, async ({browser, origin}) => {
  const page = await open(browser, origin, '#/bevel-tables/table-1-torch-45-deg', {width, height, theme});
  await answered(page);
  await page.locator('#view-before').waitFor();
  await sound(page, 'answer');
  for (const tab of theme === 'light' ? ['json', 'downloads'] : []) {
    await page.locator(`#tab-${tab}`).click();
    await sound(page, tab);
  }
  await formed(page);
  await then(page, () => page.locator('[data-pointer="/target/wall_mm"]').fill('0'));
  await sound(page, 'refused');
  for (const hash of width > 1000 && theme === 'light' ? ['nodes', 'holes', 'feed-curves', 'pulse-schedules', 'mill-paths'] : []) {
    await then(page, () => page.locator(`#endpoints [data-endpoint="${hash}"]`).click());
    await sound(page, hash);
  }
  if (width > 1000 || theme === 'dark') {  // members beside their picture, and one of them told
    await then(page, () => page.evaluate(() => {
      location.hash = '#/frames/jacket-node-with-set-in-stubs?item=1';
    }));
    await page.locator('#open-item').waitFor();
    await sound(page, 'a frame');
  }
  if (width > 1000) {  // a short table: axe takes a minute for one of 368 rows
    await then(page, () => page.locator('#endpoints [data-endpoint="grooves"]').click());
    await page.locator('#tab-table').click();
    await sound(page, 'table');
  }
  await page.context().close();
}]));
