// The program of a part before it is saved: its lines and time, the tube that turns under the torch, one cursor for text and picture.
import {strict as assert} from 'node:assert';
import {readFileSync} from 'node:fs';
import {answered, faint, open, pixels, then} from '../browser.mjs';
import {unseen} from '../seen.mjs';

const line = (page) => page.locator('#program [aria-current=true]');

async function previewed({browser, origin, service}, name, {width, theme}, more = {}) {
  const page = await open(browser, origin, `#/parts/${name}?tab=downloads`, {width, height: 844, theme});
  await answered(page);
  const before = await pixels(page);
  await page.locator('[data-onward=program]').click();
  assert.ok(await page.locator('#panel [name=purpose][value=program]').isChecked());
  const options = {lead_mm: '5', ...more};
  for (const [name, value] of Object.entries(options)) await page.locator(`[data-option=${name}]`).fill(value);
  await page.locator('#preview').click();
  await page.locator('#program li').first().waitFor();
  const body = readFileSync(new URL(`../../../examples/parts/${name}.json`, import.meta.url));
  const {text} = await service.ask(`/v1/parts?format=gcode&speed_mm_min=600&${new URLSearchParams(options)}`, {body});
  const [, length, seconds] = /, ([\d.]+) mm in ([\d.]+) s with the way down/.exec(text);
  assert.ok(Math.abs(parseFloat(await page.locator('#program-time').innerText()) - seconds) < 0.2);
  assert.ok((await page.locator('#program figcaption').innerText()).includes(`${Math.round(length)}`.slice(0, -1)));
  const after = await pixels(page);
  assert.notEqual(after.sum, before.sum, 'the moves are drawn');
  return {page, text};
}

export const checks = {
  'a program is previewed, and its cursor is that of the picture': async (given) => {
    const {page, text} = await previewed(given, 'chord-with-holes', {width: 1280, theme: 'light'});
    const cuts = [...text.matchAll(/^\(cut: (.*)\)$/gm)].map(([, cut]) => cut);
    assert.ok(cuts.length > 2);
    assert.equal(await page.locator('.timeline').getAttribute('aria-label'), `Time line: ${cuts.join(', ')}`);
    assert.equal(await page.locator('#play').innerText(), 'Next event');
    const seen = new Set();
    for (const cut of cuts) {
      await page.locator('#play').click();
      assert.ok((await page.locator('#player output').innerText()).endsWith(cut));
      const [number, code] = (await line(page).innerText()).split(/ (.*)/);
      assert.equal(code, text.split('\n')[Number(number) - 1]);
      seen.add((await pixels(page)).sum);
    }
    assert.equal(seen.size, cuts.length, 'the tube turns');
    await page.locator('#program li', {hasText: 'G1'}).first().click();
    assert.match(await line(page).innerText(), /G1/);
    await page.locator('#program .listing').press('ArrowDown');
    assert.equal(await line(page).count(), 1);
    await then(page, () => page.locator('[data-pointer="/kerf_mm"]').fill('2'));
    assert.equal(await page.locator('#program').count(), 0, 'of another request it is gone');
    assert.ok(await page.locator('#player').isHidden());
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'a square tube turns under the torch, and leads to its pulses': async (given) => {
    const {page, text} = await previewed(given, 'shs-base-post', {width: 1280, theme: 'light'}, {pivot_length_mm: '0'});
    for (const name of ['tabs', 'passes', 'start_deg']) assert.equal(await page.locator(`#panel [data-option=${name}]`).count(), 0, name);
    assert.equal(await page.locator('#panel [data-option=machine]').count(), 1, 'the tube table has a process table');
    const cuts = [...text.matchAll(/^\(cut: (.*)\)$/gm)].map(([, cut]) => cut);
    assert.equal(await page.locator('.timeline').getAttribute('aria-label'), `Time line: ${cuts.join(', ')}`);
    const seen = new Set();
    for (const cut of cuts.slice(0, 5)) {
      await page.locator('#play').click();
      assert.ok((await page.locator('#player output').innerText()).endsWith(cut));
      seen.add((await pixels(page)).sum);
    }
    assert.equal(seen.size, 5, 'the tube turns');
    await then(page, () => page.locator('[data-onward=pulse-schedules]').click());
    assert.match(await page.locator('#verdict .pill').innerText(), /ok|review/);
    const time = page.locator('#player input');
    const pictures = new Set();
    for (const share of [0.1, 0.4, 0.7]) {
      await time.fill(String(Math.round(share * Number(await time.getAttribute('max')))));
      pictures.add((await pixels(page)).sum);
    }
    assert.equal(pictures.size, 3, 'under the pulses too');
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'the preview is readable on a phone, dark': async (given) => {
    const {page} = await previewed(given, 'table-1-with-a-square-far-end', {width: 390, theme: 'dark'});
    assert.deepEqual(await faint(page), []);
    assert.deepEqual((await unseen(page)).filter((each) => !/LI|listing/.test(each)), []);
    await page.context().close();
  },
};
