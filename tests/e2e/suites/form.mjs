// The form follows the contract: whatever can be added to a request has fields and can be removed, and no click is lost.
import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {deflateRawSync} from 'node:zlib';
import {answered, openPlain as open, then} from '../browser.mjs';

/** Answers every job within the page with a refusal, so that only the form works; `asked` is the last request. */
const stub = (page) => page.evaluate(() => {
  const real = window.fetch;
  window.fetch = async (to, given) => {
    if (given?.method !== 'POST') return real(to, given);
    window.asked = given.body;
    return new Response(JSON.stringify({code: 'bad_choice', title: 'Stub.', status: 422, errors: []}), {status: 422});
  };
});

/** Adds and removes each thing that can be added in the form, and whatever can be added to that, once per kind. What is wrong, and how many there were.
 *  Runs in the page, because a thousand clicks from outside take minutes. */
const addedAndRemoved = (page, known) => page.evaluate(async (before) => {
  const form = document.getElementById('form');
  const seen = new Set(before);
  const wrong = [];
  const press = async (button) => {
    const answers = document.body.dataset.answers;
    button.click();
    const end = Date.now() + 5000;
    while (document.body.dataset.answers === answers && Date.now() < end) await new Promise((done) => setTimeout(done));
    if (document.body.dataset.answers === answers) wrong.push(`${button.outerHTML.slice(0, 120)} does nothing`);
  };
  const held = (to) => to.split('/').slice(1).reduce((value, key) => value?.[key], JSON.parse(window.asked));
  const walk = async (within) => {
    const adders = [...form.querySelectorAll('[data-adds]')].map((node) => ({to: node.dataset.adds, name: node.textContent}));
    for (const {to, name} of adders) {
      const kind = `${to.replace(/\/\d+/g, '/#')} ${name}`;
      if (!to.startsWith(within) || seen.has(kind)) continue;
      seen.add(kind);
      const was = window.asked;
      await press([...form.querySelectorAll(`[data-adds="${to}"]`)].find((node) => node.textContent === name));
      if (held(to) === undefined) wrong.push(`${kind} is not in the request`);
      const fields = [...form.querySelectorAll(`[data-pointer="${to}"], [data-pointer^="${to}/"], select[data-holds="${to}"]`)];
      if (!fields.length) wrong.push(`${kind} has no fields`);
      await walk(`${to}/`);
      const removers = form.querySelectorAll(`[data-removes="${to}"]`);
      if (removers.length !== 1) wrong.push(`${kind} has ${removers.length} ways to remove it`);
      else await press(removers[0]);
      if (was && window.asked !== was) wrong.push(`${kind} is not removed wholly: ${was} is ${window.asked}`);
    }
  };
  await walk('');
  return {wrong, seen: [...seen]};
}, known);

export const checks = {
  'whatever can be added has fields and can be removed': async ({browser, origin, service}) => {
    const {endpoints} = JSON.parse((await service.ask('/v1/version', {method: 'GET'})).text);
    const page = await open(browser, origin);
    await answered(page);
    await stub(page);
    const wrong = [];
    let count = 0;
    for (const {id} of endpoints) {
      let known = [];
      const walk = async () => {
        const found = await addedAndRemoved(page, known);
        known = found.seen;
        wrong.push(...found.wrong.map((each) => `${id}: ${each}`));
      };
      await then(page, () => page.locator(`#endpoints [data-endpoint="${id}"]`).evaluate((link) => link.click()));
      await walk();
      if (id !== 'replays') {  // a replay begins with another page's answer
        await then(page, () => page.locator('#blank').click());
        const ways = page.getByLabel('Given by', {exact: true});
        const most = await ways.count() ? await ways.locator('option').count() : 1;
        for (let way = 0; way < most; ++way) {
          if (most > 1) await then(page, () => ways.selectOption({index: way}));
          await walk();
        }
      }
      count += known.length;
    }
    assert.deepEqual(wrong, []);
    assert.ok(count > 150, `${count} things were added`);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'a click that takes the focus from a field is not lost, and nothing moves under it': async ({browser, origin}) => {
    for (const size of [{width: 1280, height: 800}, {width: 390, height: 844}]) {
      const page = await open(browser, origin, '#/bevel-tables/mitre', size);
      await answered(page);
      if (size.width < 800) await page.locator('#edit').click();
      const buttons = page.locator('#form > .offers:last-child button');
      const most = await buttons.count();
      assert.ok(most > 2);
      for (let i = 0; i < most; ++i) {
        const field = page.locator('[data-pointer="/kerf_mm"]');
        await field.focus();
        await page.locator('#hint img').waitFor();  // the highest of hints
        const button = buttons.nth(most - 1 - i);
        const name = await button.innerText();
        await button.scrollIntoViewIfNeeded();
        const {x, y, width, height} = await button.boundingBox();
        await page.mouse.move(x + width / 2, y + height / 2);
        await page.mouse.down();
        await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
        assert.ok(Math.abs((await button.boundingBox()).y - y) < 1, `${name} moved under the pointer`);
        await then(page, () => page.mouse.up());
        assert.equal(await page.getByRole('button', {name, exact: true}).count(), 0, `${name} was added`);
        await then(page, () => page.locator('#reset').click());
      }
      assert.deepEqual(page.faults, []);
      await page.context().close();
    }
  },

  'every change is undone and redone': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const field = (pointer) => page.locator(`[data-pointer="${pointer}"]`);
    const rows = page.locator('table.tubes tbody tr');
    const tilt = field('/cutters/0/inclination_deg');
    assert.ok(await page.locator('#undo').isDisabled());
    for (const text of ['8', '80']) await then(page, () => tilt.fill(text));  // typed into one field: one step
    await then(page, () => page.getByRole('button', {name: /^Add to partners: tube/}).first().click());
    await then(page, () => page.locator('#preset').click());
    await then(page, () => page.getByRole('button', {name: 'Remove row 1', exact: true}).click());
    await then(page, () => field('/kerf_mm').fill('2'));
    assert.equal(await rows.count(), 4);
    await page.locator('body').press('Control+z');
    await then(page, () => page.locator('#undo').click());
    assert.equal(await rows.count(), 5);
    assert.equal(await tilt.inputValue(), '80');
    await then(page, () => page.locator('#undo').click());
    assert.equal(await page.locator('#preset').getAttribute('aria-pressed'), 'false');
    await then(page, () => page.locator('#undo').click());
    assert.equal(await rows.count(), 4);
    await then(page, () => tilt.press('Control+z'));
    assert.equal(await tilt.inputValue(), '85');
    assert.equal(await page.evaluate(() => document.activeElement.dataset.pointer), '/cutters/0/inclination_deg');
    assert.ok(await page.locator('#undo').isDisabled());
    await then(page, () => tilt.press('Control+y'));
    assert.equal(await tilt.inputValue(), '80');
    for (let i = 0; i < 4; ++i) await then(page, () => page.locator('#redo').click());
    assert.equal(await rows.count(), 4);
    assert.equal(await field('/kerf_mm').inputValue(), '2');
    assert.ok(await page.locator('#redo').isDisabled());
    await then(page, () => page.locator('#undo').click());
    await then(page, () => field('/target/wall_mm').fill('6'));  // another way from here
    assert.ok(await page.locator('#redo').isDisabled());
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'sizes and machines are chosen out of a list, and what a refusal repeats is spelled as it is entered': async ({browser, origin, service}) => {
    const page = await open(browser, origin, '#/parts/chord-with-holes');
    await answered(page);
    const size = page.locator('[data-pointer="/members/1/size"]');
    const kept = await size.inputValue();
    await size.click();
    assert.ok(await page.locator('.choices [role=option]').count() > 20, 'a click shows the list');
    await then(page, async () => {
      await size.fill('114.3 6.3');
      await page.keyboard.press('Enter');
    });
    assert.equal(await size.inputValue(), 'CHS 114.3x6.3');
    assert.notEqual(await page.locator('#verdict .pill').innerText(), 'refused');
    await size.fill('no such size');
    await size.blur();
    assert.equal(await size.inputValue(), 'CHS 114.3x6.3', 'no free text is taken');
    await size.fill(kept.replace('CHS ', '').replace('x', ' X '));
    await then(page, () => page.locator('.choices [role=option]', {hasText: kept}).first().click());
    assert.equal(await size.inputValue(), kept);
    assert.equal(await page.locator('.choices').count(), 0);
    await page.context().close();

    const {machines} = JSON.parse((await service.ask('/v1/machines', {method: 'GET'})).text);
    const body = JSON.parse(await readFile(new URL('../../../examples/pulse-schedules/table-1-on-the-five-axis-cutter.json', import.meta.url)));
    const link = (job) => `#/pulse-schedules/~${deflateRawSync(JSON.stringify(job)).toString('base64url')}`;
    const other = await open(browser, origin, link({...body, machine: 'no_such_machine'}));
    await answered(other);
    const said = await other.locator('#verdict').innerText();
    for (const name of ['no_such_machine', ...machines.map((each) => each.name)]) assert.ok(said.includes(name), `${name} in: ${said}`);
    const machine = other.locator('[data-pointer="/machine"]');
    await machine.click();
    await machine.fill('');
    assert.deepEqual(await other.locator('.choices [role=option]').allInnerTexts(), machines.map((each) => each.name));
    await then(other, async () => {
      await machine.fill('five axis');
      await other.keyboard.press('Enter');
    });
    assert.match(await other.locator('#verdict .pill').innerText(), /ok|review/);
    assert.deepEqual([...page.faults, ...other.faults], []);
    await other.context().close();
  },
};
