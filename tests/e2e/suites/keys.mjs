// Console and API reference of a service that requires a key.
import {strict as assert} from 'node:assert';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {Service} from '../../contract/service.mjs';
import {answered, formed, openPlain as open, then} from '../browser.mjs';

/** Runs `check` with a service that knows one key. */
async function asked({browser, server}, check) {
  const folder = mkdtempSync(join(tmpdir(), 'keys-'));
  const make = (name) => {
    const made = execFileSync(server, ['new-key', name], {encoding: 'utf8'});
    return {key: /^tc_\S+$/m.exec(made)[0], line: new RegExp(`^${name} .*$`, 'm').exec(made)[0]};
  };
  const own = make('shop');
  const file = join(folder, 'keys');
  writeFileSync(file, `${own.line}\n`);
  const service = await Service.start(server, '--keys', file);
  try {
    await check({browser, service, key: own.key, origin: `http://127.0.0.1:${service.port}`});
  } finally {
    await service.stop();
    rmSync(folder, {recursive: true});
  }
}

const field = (page) => page.locator('.unlock input');
async function enter(page, key) {
  await field(page).fill(key);
  await page.getByRole('button', {name: 'Use this key'}).click();
}

/** Nothing that outlives the page, and nothing that is passed on, holds the key. */
async function forgets(page, key) {
  const kept = await page.evaluate(() => JSON.stringify([{...localStorage}, {...sessionStorage}, document.cookie, history.state, location.href]));
  assert.ok(!kept.includes(key), `kept: ${kept}`);
  assert.ok(!page.asked.some((url) => url.includes(key)), 'in an address');
}

async function visit(browser, origin, hash, more) {
  const page = await open(browser, origin, hash, more);
  page.asked = [];
  page.on('request', (request) => page.asked.push(request.url()));
  await field(page).waitFor();
  return page;
}

export const checks = {
  'the console asks for the key, and works with it': (given) => asked(given, async ({browser, origin, key}) => {
    for (const width of [1280, 390]) {
      const page = await visit(browser, origin, '#/bevel-tables/mitre', {width});
      assert.match(await page.locator('#verdict').innerText(), /requires an API key/);
      assert.ok(await page.locator('#forget').isHidden());
      await enter(page, 'Schlüssel');
      await page.getByText('A key cannot contain such characters.').waitFor();
      await enter(page, 'tc_0000');
      await page.getByText('Invalid API key.').waitFor();
      await enter(page, ` ${key} `);
      await answered(page);
      assert.equal(await page.locator('#verdict .pill').innerText(), 'ok');
      assert.equal(await field(page).count(), 0);
      const {scroll, seen} = await page.evaluate(() => ({scroll: document.documentElement.scrollWidth, seen: innerWidth}));
      assert.ok(scroll <= seen, `the page is ${scroll} px wide`);
      await formed(page);
      await then(page, () => page.locator('[data-pointer="/target/wall_mm"]').fill('4'));
      await page.locator('#tab-downloads').click();
      await page.locator('#panel [value=data]').check();
      const [file] = await Promise.all([page.waitForEvent('download'), page.locator('[data-media="text/csv"]').first().click()]);
      assert.match(file.suggestedFilename(), /\.csv$/);
      await page.waitForURL(/~/);
      await forgets(page, key);
      assert.ok(!(await page.content()).includes(key), 'in the page');
      await page.locator('#forget').click();
      await field(page).waitFor();
      assert.match(page.url(), /~/, 'the job is still in the address');
      await enter(page, key);
      await answered(page);
      assert.equal(await page.locator('[data-pointer="/target/wall_mm"]').inputValue(), '4');
      assert.deepEqual(page.faults, []);
      assert.deepEqual(page.strangers, []);
      await page.context().close();
    }
  }),

  'a curl of the console names the key by its variable': (given) => asked(given, async ({browser, origin, key}) => {
    const page = await visit(browser, origin, '#/bevel-tables/mitre');
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write'], {origin});
    await enter(page, key);
    await answered(page);
    await page.locator('#tab-json').click();
    await page.getByRole('button', {name: 'Copy as curl'}).click();
    await page.getByRole('button', {name: 'Copied'}).waitFor();
    const command = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(!command.includes(key));
    const {verdict} = JSON.parse(execFileSync('sh', ['-c', command], {encoding: 'utf8', env: {...process.env, TUBECUT_KEY: key}}));
    assert.equal(verdict.status, 'ok');
    await page.context().close();
  }),

  'the API reference asks for the key, and sends it': (given) => asked(given, async ({browser, origin, key}) => {
    const page = await visit(browser, origin, '', {at: '/docs'});
    await enter(page, key);
    const block = page.locator('#operations-catalogues-version');
    await block.locator('.opblock-summary-control').click({timeout: 60000});
    await block.getByRole('button', {name: 'Execute'}).click();
    const status = block.locator('.live-responses-table tbody .response-col_status').first();
    await status.waitFor({timeout: 60000});
    assert.match(await status.innerText(), /200/);
    assert.ok(!(await page.content()).includes(key), 'in the page, such as in the curl beside the answer');
    const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', {name: 'openapi.yaml', exact: true}).click()]);
    assert.equal(file.suggestedFilename(), 'openapi.yaml');
    await forgets(page, key);
    assert.deepEqual(page.faults, []);
    assert.deepEqual(page.strangers, []);
    await page.context().close();
  }),
};
