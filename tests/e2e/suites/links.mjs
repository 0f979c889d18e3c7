// Opening links, and the message without a verdict: a damaged link, a service that is away.
import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {deflateRawSync} from 'node:zlib';
import {answered, formed, open, pixels, then} from '../browser.mjs';

const table1 = JSON.parse(await readFile(new URL('../../../examples/bevel-tables/source-000-table-1.json', import.meta.url)));
const field = (page, pointer) => page.locator(`[data-pointer="${pointer}"]`);
const verdict = (page) => page.locator('#verdict').innerText();
const go = (page, hash) => page.evaluate((to) => {
  location.hash = to;
}, hash);

async function damaged(page, what) {
  assert.match(await verdict(page), /This link is damaged\./, what);
  assert.equal(await page.locator('#verdict .pill').innerText(), 'no job', what);
  assert.equal(await page.locator('.good').count(), 0, `${what}: a verdict`);
  assert.equal(await page.locator('#details').innerText(), '', `${what}: a proof`);
  assert.equal(await page.locator('#form input').count(), 0, `${what}: a request`);
  assert.equal(await page.locator('.chart').count(), 0, `${what}: charts`);
  assert.equal(await page.locator('.canvas').isVisible(), false, `${what}: a solid`);
}

async function editedLink(browser, origin) {
  const page = await open(browser, origin);
  await answered(page);
  await then(page, () => field(page, '/cutters/0/inclination_deg').fill('80'));
  await page.waitForURL(/#\/bevel-tables\/~/);
  return {page, hash: new URL(page.url()).hash};
}

export const checks = {
  'a damaged link opens no other job': async ({browser, origin}) => {
    const {page, hash} = await editedLink(browser, origin);
    const start = hash.indexOf('~') + 2;
    const links = {
      'cut short': hash.slice(0, -7),
      'cut to its mark': hash.slice(0, start),
      'an example cut short': '#/bevel-tables/source-000-ta',
      'an endpoint changed': hash.replace('bevel', 'bevle'),
    };
    // One character replaced, all along the link: each may be another valid job.
    for (let at = start; at < hash.length; at += Math.ceil((hash.length - start) / 12)) {
      links[`character ${at} changed`] = hash.slice(0, at) + (hash[at] === 'A' ? 'B' : 'A') + hash.slice(at + 1);
    }
    for (const [what, link] of Object.entries(links)) {
      await then(page, () => go(page, link));
      await damaged(page, what);
    }
    await then(page, () => page.locator('#endpoints [data-endpoint=holes]').click());
    assert.match(await verdict(page), /^ok/);
    await page.context().close();
    const fresh = await open(browser, origin, links['cut short']);
    await answered(fresh);
    await damaged(fresh, 'as the first page');
    assert.deepEqual(fresh.faults, []);
    await fresh.context().close();
  },

  'a link is followed though the job before writes its address meanwhile': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    await then(page, () => page.evaluate((to) => {
      const before = location.href;
      location.hash = to;
      history.replaceState(null, '', before);
    }, '#/holes/through-brace'));
    await page.waitForURL(/#\/holes\/through-brace/);
    assert.equal(await page.locator('#endpoints [aria-current]').getAttribute('data-endpoint'), 'holes');
    await page.context().close();
  },

  'an answer that comes late is of no damaged link': async ({browser, origin}) => {
    const {page, hash} = await editedLink(browser, origin);
    let release;
    const held = new Promise((done) => {
      release = done;
    });
    await page.route('**/v1/bevel-tables', async (route) => {
      await held;
      await route.continue();
    });
    const asked = page.waitForRequest('**/v1/bevel-tables');
    await field(page, '/cutters/0/inclination_deg').fill('75');
    await asked;
    await then(page, () => go(page, hash.slice(0, -7)));
    await damaged(page, 'before the answer');
    const late = page.waitForResponse('**/v1/bevel-tables');
    release();
    await late;
    await page.waitForTimeout(300);
    await damaged(page, 'after the answer');
    await page.context().close();
  },

  'a slow answer that a newer question waits for is broken off': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const [asked, broken] = [[], []];
    page.on('requestfailed', (request) => broken.push(JSON.parse(request.postData()).cutters?.[0].inclination_deg));
    await page.route('**/v1/bevel-tables', async (route) => {
      const tilt = JSON.parse(route.request().postData()).cutters[0].inclination_deg;
      asked.push(tilt);
      if (tilt === 80 || tilt === 70) return;  // never answered
      await route.continue();
    });
    const tilt = field(page, '/cutters/0/inclination_deg');
    await tilt.fill('80');
    await tilt.blur();
    await then(page, () => tilt.fill('75'));
    assert.deepEqual([asked, broken], [[80, 75], [80]]);
    assert.equal(await page.locator('.stale').count(), 0);
    await page.locator('#tab-json').click();
    assert.equal(JSON.parse(await page.locator('#request-json').innerText()).cutters[0].inclination_deg, 75);
    // Another job does not wait at all.
    await tilt.fill('70');
    await tilt.blur();
    await then(page, () => go(page, '#/holes/set-in-branch'));
    assert.deepEqual(broken, [80, 70]);
    assert.match(await verdict(page), /^ok/);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'links of old, without a checksum, open their job': async ({browser, origin}) => {
    const body = structuredClone(table1);
    body.cutters[0].inclination_deg = 77;
    const page = await open(browser, origin, `#/bevel-tables/~${deflateRawSync(JSON.stringify(body)).toString('base64url')}`);
    await answered(page);
    assert.equal(await field(page, '/cutters/0/inclination_deg').inputValue(), '77');
    await page.locator('.skip').focus();
    await page.keyboard.press('Enter');
    await page.waitForTimeout(500);
    assert.equal(await field(page, '/cutters/0/inclination_deg').inputValue(), '77', 'the way past the form keeps the job');
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'another job is seen as a fresh page shows it': async ({browser, origin}) => {
    const other = 'tube-on-elbow';
    const fresh = await open(browser, origin, `#/bevel-tables/${other}`);
    await answered(fresh);
    const {sum} = await pixels(fresh);
    await fresh.context().close();
    const page = await open(browser, origin);
    await answered(page);
    await page.locator('.canvas canvas').focus();
    for (const key of ['ArrowLeft', 'ArrowLeft', '+', '+', '+']) await page.keyboard.press(key);
    const turned = await pixels(page);
    await then(page, () => field(page, '/cutters/0/inclination_deg').fill('85.001'));
    assert.ok(Math.abs((await pixels(page)).share - turned.share) < 0.01, 'an edit leaves the view');
    await then(page, () => page.locator('#example').selectOption(other));
    assert.equal((await pixels(page)).sum, sum, 'the view of the last job was kept');
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'a service that is away is said to be, and asked again': async ({browser, origin}) => {
    const page = await open(browser, origin, undefined, {width: 390, height: 844});
    await answered(page);
    await formed(page);
    await page.route('**/v1/**', (route) => route.abort('connectionrefused'));
    await then(page, () => field(page, '/target/wall_mm').fill('6'));
    assert.match(await verdict(page), /^no answer\s+The service cannot be reached\./);
    assert.doesNotMatch(await page.locator('body').innerText(), /TypeError|refused/);
    assert.equal(await page.locator('[aria-invalid]').count(), 0);
    await page.locator('#tab-downloads').click();
    await page.locator('#panel [value=data]').check();
    await page.locator('[data-media="text/csv"]').first().click();
    await page.locator('#panel [role=status]', {hasText: 'The service cannot be reached.'}).waitFor();
    await then(page, () => page.locator('#again').click());
    assert.match(await verdict(page), /cannot be reached/);
    await then(page, () => page.unroute('**/v1/**'));
    assert.match(await verdict(page), /^ok/);
    assert.equal(await field(page, '/target/wall_mm').inputValue(), '6');
    await page.context().close();
  },

  'a service that goes away while the page loads': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    await page.route('**/v1/**', (route) => route.abort('connectionrefused'));
    await page.reload();
    await page.locator('#again').waitFor();
    assert.match(await verdict(page), /could not start.*\s+The service cannot be reached\./s);
    assert.doesNotMatch(await verdict(page), /TypeError/);
    await page.unroute('**/v1/**');
    await answered(page);
    assert.match(await verdict(page), /^ok/);
    await page.context().close();
  },
};
