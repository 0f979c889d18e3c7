import {strict as assert} from 'node:assert';
import {readFileSync} from 'node:fs';
import {faint, open} from '../browser.mjs';

/** Texts that do not fit, and how light the page's ground is. */
const unread = (page) => page.evaluate(() => {
  const wrong = [];
  for (const node of document.querySelectorAll('body *')) {
    const own = [...node.childNodes].some((each) => each.nodeType === 3 && /\S/.test(each.data));
    if (!(node instanceof HTMLElement) || !own || !node.checkVisibility() || node.matches('option, script')) continue;
    const what = `${node.className || node.tagName} ${node.textContent.slice(0, 40)}`;
    if (/hidden|clip/.test(getComputedStyle(node).overflowX) && node.scrollWidth > node.clientWidth + 1) wrong.push(`clipped: ${what}`);
    if (node.getBoundingClientRect().right > innerWidth + 1 && !node.closest('pre, textarea')) wrong.push(`off the page: ${what}`);
  }
  if (document.documentElement.scrollWidth > innerWidth) wrong.push(`the page is ${document.documentElement.scrollWidth} px wide`);
  return {wrong: [...new Set(wrong)], ground: Number(/\d+/.exec(getComputedStyle(document.body).backgroundColor)[0]) / 255};
});

export const checks = {
  'every operation is listed and an example runs': async ({browser, origin, service}) => {
    const {paths} = JSON.parse((await service.ask('/openapi.json', {method: 'GET'})).text);
    const operations = Object.values(paths).reduce((sum, path) => sum + Object.keys(path).length, 0);
    const page = await open(browser, origin, '', {at: '/docs'});
    await page.locator('.opblock').first().waitFor({timeout: 60000});
    assert.equal(await page.locator('.opblock').count(), operations);
    const block = page.locator('#operations-cuts-bevelTables');
    await block.locator('.opblock-summary-control').click();
    const examples = block.locator('.examples-select select, select.examples-select-element');
    await examples.first().waitFor();
    assert.ok((await examples.first().locator('option').count()) > 3, 'the examples of the service');
    await block.getByRole('button', {name: 'Execute'}).click();
    await block.locator('.live-responses-table .response-col_status').first().waitFor({timeout: 60000});
    assert.match(await block.locator('.live-responses-table tbody .response-col_status').first().innerText(), /200/);
    for (const colorScheme of ['light', 'dark']) {
      await page.emulateMedia({colorScheme});
      for (const [width, height] of [[1280, 800], [390, 844]]) {
        await page.setViewportSize({width, height});
        const {wrong, ground} = await unread(page);
        assert.equal([...wrong, ...await faint(page)].join('\n'), '', `${width} px, ${colorScheme}`);
        assert.ok(colorScheme === 'dark' ? ground < 0.2 : ground > 0.8, `${colorScheme} on a ground of ${ground}`);
      }
    }
    await page.locator('#theme').click();
    assert.ok((await unread(page)).ground > 0.8, 'light when asked for');
    assert.deepEqual(page.faults, []);
    assert.deepEqual(page.strangers, []);
    await page.context().close();
  },
  'the words of docs/glossary.md stand on a page that console and reference lead to': async ({browser, origin}) => {
    const page = await open(browser, origin, '', {at: '/docs'});
    await page.getByRole('link', {name: 'Words'}).click();
    await page.locator('table').first().waitFor();
    const told = readFileSync(new URL('../../../docs/glossary.md', import.meta.url), 'utf8');
    const rows = told.split('\n').filter((line) => /^\| (?!symbol|word \||on the wire)/.test(line)).length;
    assert.ok(rows > 60);
    assert.equal(await page.locator('tbody tr').count(), rows);
    assert.match(await page.locator('tbody').first().innerText(), /目标管/);
    assert.deepEqual(page.faults, []);
    assert.deepEqual(page.strangers, []);
    await page.context().close();
    const console = await open(browser, origin, '', {at: '/'});
    assert.equal(await console.getByRole('link', {name: 'Words'}).getAttribute('href'), '/glossary');
    await console.context().close();
  },
};
