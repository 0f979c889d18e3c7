// A stranger's way through the console: from a blank job to a program, its file and a link, and from a node to its parts.
import {strict as assert} from 'node:assert';
import {answered, open, pixels, then} from '../browser.mjs';
import {fromStart, press, tabTo} from '../keyboard.mjs';

const clean = (page) => {
  assert.deepEqual(page.faults, [], 'errors in the browser');
  assert.deepEqual(page.strangers, [], 'requests to others');
};
const pill = (page) => page.locator('#verdict .pill').innerText();
const endpoint = (page) => page.locator('#endpoints [aria-current]').getAttribute('data-endpoint');

async function byKeyboard({browser, origin}) {
  const page = await open(browser, origin);
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write'], {origin});
  await answered(page);
  await then(page, () => press(page, '#blank'));
  assert.ok(await page.evaluate(() => document.activeElement.closest('#form') !== null), 'a blank job begins in its form');
  // Two more tubes and a plate in addition to the one tube and the one partner of a blank job.
  const kinds = async () => (await page.locator('#form .tubes tbody tr, #form .card').count());
  const before = await kinds();
  await then(page, () => press(page, '[aria-label^="Add to partners: tube"]'));
  const focused = () => page.evaluate(() => document.activeElement.dataset.pointer ?? document.activeElement.outerHTML.slice(0, 60));
  assert.match(await focused(), new RegExp(`^/cutters/${before}/`), 'the focus is in the tube that was added');
  await tabTo(page, `[data-pointer="/cutters/${before}/clocking_deg"]`);
  await then(page, () => page.keyboard.type('180'));
  await then(page, () => press(page, '[aria-label="Add to partners: plane"]'));
  assert.match(await focused(), new RegExp(`^/cutters/${before + 1}/`), 'and in the plate');
  assert.equal(await kinds(), before + 2);
  await tabTo(page, `[data-pointer="/cutters/${before}/inclination_deg"]`, {key: 'Shift+Tab'});
  const was = await page.locator('#answer-json, #verdict').first().innerText();
  await then(page, () => page.keyboard.press('Shift+ArrowUp'));
  assert.equal(await page.locator(`[data-pointer="/cutters/${before}/inclination_deg"]`).inputValue(), '70');
  assert.match(await pill(page), /ok|review/, was);

  await then(page, () => press(page, '[data-onward=parts]'));
  assert.equal(await endpoint(page), 'parts');
  assert.match(await pill(page), /ok|review/, await page.locator('#verdict').innerText());
  assert.ok((await pixels(page)).share > 0.03, 'the part is seen');

  const steps = await tabTo(page, '[data-onward=pulse-schedules]');
  assert.ok(steps <= 12, `${steps} steps from the part to its pulses`);
  await then(page, () => page.keyboard.press('Enter'));
  assert.equal(await endpoint(page), 'pulse-schedules');
  assert.match(await pill(page), /ok|review/, await page.locator('#verdict').innerText());

  await press(page, '[data-onward=files]');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'tab-downloads');
  const [file] = await Promise.all([page.waitForEvent('download'), press(page, '[data-media="text/x-gcode"]')]);
  assert.match(file.suggestedFilename(), /-[0-9a-f]{8}\.ngc$/);

  await press(page, '#share', {most: 120});
  await page.getByText('Link copied').waitFor();
  const link = new URL(await page.evaluate(() => navigator.clipboard.readText()));
  const told = await page.locator('#verdict .said').innerText();
  clean(page);
  await page.context().close();
  const other = await open(browser, origin, link.hash);
  await answered(other);
  assert.equal(await other.locator('#verdict .said').innerText(), told);
  clean(other);
  await other.context().close();
}

/** Every member of a node is chosen by its name, and its part is that of the same member. */
async function throughTheNode({browser, origin}, width, theme) {
  const page = await open(browser, origin, '#/nodes/k-joint-with-tables', {width, height: 844, theme});
  await answered(page);
  await pixels(page);
  await page.locator('.canvas canvas').scrollIntoViewIfNeeded();
  const names = await page.locator('.labels .shown').evaluateAll((spans) => spans.map((span) => {
    const {x, y, width: w, height: h} = span.getBoundingClientRect();
    return {name: span.textContent, x: x + w / 2, y: y + h / 2};
  }));
  assert.deepEqual(names.map(({name}) => name).sort(), (await page.locator('#items [role=option] b').allInnerTexts()).sort());
  for (const {name, x, y} of names) {
    await page.mouse.click(x, y);
    assert.equal((await page.locator('.facts h3').innerText()).split('\n')[0].trim(), name);
  }
  const last = names[names.length - 1].name;
  await then(page, () => page.locator('#open-item').click());
  assert.equal(await endpoint(page), 'parts');
  assert.match(await pill(page), /ok|review/, await page.locator('#verdict').innerText());
  await page.locator('#tab-json').click();
  assert.equal(JSON.parse(await page.locator('#request-json').innerText()).member, last);
  await page.waitForURL(/#\/parts\/~/);
  await then(page, () => page.goBack());
  assert.equal((await page.locator('.facts h3').innerText()).split('\n')[0].trim(), last, 'what was chosen is so again');
  clean(page);
  await page.context().close();
}

export const checks = {
  'a blank job, three tubes and a plate, to a program and a link, by the keyboard': byKeyboard,
  'the errors of a refused job are two keys from the start of the page': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/bevel-tables/table-1-torch-45-deg', {draws: false});
    await answered(page);
    const wall = page.locator('[data-pointer="/target/wall_mm"]');
    assert.equal(await page.locator('#to-errors').count(), 0, 'without an error there is no link to it');
    await then(page, () => wall.fill('0'));
    await fromStart(page);
    assert.ok(await tabTo(page, '#to-errors') <= 2);
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => document.activeElement.dataset.to), '/target/wall_mm');
    await page.keyboard.press('Enter');
    assert.ok(await wall.evaluate((node) => node === document.activeElement), 'the error leads to its field');
    await page.keyboard.press('Control+a');
    await then(page, () => page.keyboard.type('5'));
    assert.equal(await page.locator('#to-errors').count(), 0);
    clean(page);
    await page.context().close();
  },
  'a node leads to its parts': (given) => throughTheNode(given, 1280, 'light'),
  'a node leads to its parts at 390 px, dark': (given) => throughTheNode(given, 390, 'dark'),

  'what an answer leads on to is answered': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const leads = page.locator('#onward [data-onward]:not([data-onward=files], [data-onward=program])');
    const go = (hash) => then(page, () => page.evaluate((to) => {
      location.hash = to;
    }, `#/${hash}`));
    for (const [hash, count] of [['bevel-tables/tube-laser-branch', 2], ['bevel-tables/source-000-table-1-as-published', 0], ['intersections/two-tubes-by-axis', 1],
      ['parts/k-joint-brace', 2], ['mill-paths/case-a-end-up', 1]]) {
      await go(hash);
      assert.equal(await leads.count(), count, hash);
      for (let i = 0; i < count; ++i) {
        await then(page, () => leads.nth(i).click());
        assert.notEqual(await pill(page), 'refused', `${hash}: ${await page.locator('#verdict').innerText()}`);
        await page.waitForURL(/~/);
        await go(hash);
      }
    }
    clean(page);
    await page.context().close();
  },
};
