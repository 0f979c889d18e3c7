import {strict as assert} from 'node:assert';
import {answered, formed, open, then} from '../browser.mjs';
import {barred} from '../seen.mjs';

const sound = async (page, where) => assert.deepEqual((await barred(page)).map((each) => `${where} ${each}`), []);

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
  // members next to their picture, and one of them described
  if (width > 1000 || theme === 'dark') {
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
