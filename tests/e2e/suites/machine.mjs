// A machine and a post of one's own: made in a form, checked by the service, downloaded, and loaded by another service.
import {strict as assert} from 'node:assert';
import {mkdir, mkdtemp, readFile, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {Service} from '../../contract/service.mjs';
import {faint, openPlain as open} from '../browser.mjs';
import {fromStart, tabTo} from '../keyboard.mjs';
import {barred} from '../seen.mjs';

const docs = await readFile(new URL('../../../docs/machines.md', import.meta.url), 'utf8');
/** A file of docs/machines.md. */
const written = (name) => JSON.parse(new RegExp(`> ${name} <<'END'\\n([^]*?)\\nEND`).exec(docs)[1]);
const field = (page, pointer) => page.locator(`[data-pointer="${pointer}"]`);
const state = (page, part, text) => page.locator(`[data-state=${part}]`, {hasText: text}).waitFor();
const own = async (given, size) => {
  const page = await open(given.browser, given.origin, '#/own-machine', size);
  await page.locator('[data-download=post]:enabled').waitFor();
  return page;
};
const clean = async (page) => {
  // A refused post is a refused query (400), which the browser logs as an error.
  assert.deepEqual(page.faults.filter((each) => !/status of 400/.test(each)), [], 'errors in the browser');
  assert.deepEqual(page.strangers, [], 'requests to others');
  await page.context().close();
};
const openFile = (page, name, value) =>
  page.locator('#own-file').setInputFiles({name, mimeType: 'application/json', buffer: Buffer.from(typeof value === 'string' ? value : JSON.stringify(value))});
async function download(page, part, folder) {
  const [file] = await Promise.all([page.waitForEvent('download'), page.locator(`[data-download=${part}]`).click()]);
  await file.saveAs(join(folder, file.suggestedFilename()));
  return file.suggestedFilename();
}
// Without the lines that differ by version, name and part.
const moves = (program) => program.split('\n').filter((line) => !line.startsWith('('));

async function seen(given, width, theme, locale) {
  const page = await own(given, {width, height: 844, theme, locale});
  for (const fold of await page.locator('#own-machine details').all()) await fold.evaluate((node) => { node.open = true; });
  assert.deepEqual(await barred(page), []);
  assert.deepEqual(await faint(page), []);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= width, 'the page is as wide as the screen');
  await clean(page);
}

export const checks = {
  'it is reached from the start page, and the way back leads to a job': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/');
    const scripts = [];
    page.on('request', (request) => scripts.push(new URL(request.url()).pathname));
    await page.locator('[data-task=machine] a[href="#/own-machine"]').click();
    await state(page, 'post', 'ok');
    assert.ok(scripts.some((path) => /own_machine-.*\.js$/.test(path)), 'its script comes when it is opened');
    assert.equal(await page.locator('#endpoints [aria-current=page]').getAttribute('href'), '#/own-machine');
    assert.equal(await page.title(), 'Own machine and post – tubecut');
    for (const width of [1280, 390]) {
      await page.setViewportSize({width, height: 800});
      await page.goto(`${origin}/#/holes`);
      await page.locator('#verdict .pill').waitFor();
      await page.goto(`${origin}/#/own-machine`);
      await state(page, 'post', 'ok');
      const tab = page.locator('#endpoints [aria-current=page]');
      const [nav, link] = [await page.locator('#endpoints').boundingBox(), await tab.boundingBox()];
      assert.ok(link.x >= nav.x - 1 && link.x + link.width <= nav.x + nav.width + 1, `its tab is in sight at ${width} px`);
    }
    await page.setViewportSize({width: 1280, height: 800});
    await page.locator('.skip').focus();
    await page.keyboard.press('Enter');
    await state(page, 'post', 'ok');
    assert.ok(await page.locator('#own-machine').isVisible(), 'the skip link stays on the page');
    await page.locator('#endpoints [data-endpoint=holes]').click();
    await page.locator('#verdict .pill').waitFor();
    assert.equal(await page.locator('#own-machine').count(), 0);
    assert.ok(await page.locator('#form').isVisible());
    await clean(page);
  },

  'each part of it is accessible at 1280 px, light': (given) => seen(given, 1280, 'light', 'en-US'),
  'the same in Chinese at 390 px, dark': (given) => seen({...given}, 390, 'dark', 'zh-CN'),

  'an error appears at its field and in the list, which leads to it; undo brings the value back': async (given) => {
    const page = await own(given);
    await field(page, '/machine/axes/1/v_max').fill('-3');
    await state(page, 'machine', '1 error');
    assert.equal(await field(page, '/machine/axes/1/v_max').getAttribute('aria-invalid'), 'true');
    assert.ok(await page.locator('[data-download=machine]').isDisabled());
    assert.ok(await page.locator('[data-download=post]').isEnabled());
    const turn = field(page, '/post/axes/turn/decimals');
    await turn.evaluate((node) => { node.closest('details').open = true; });
    await turn.fill('99');
    await state(page, 'post', '1 error');
    await page.locator('#own-stale').waitFor();
    await page.locator('#units').click();
    assert.equal(await page.locator('.box', {has: field(page, '/machine/pivot_length_mm')}).locator('.unit').innerText(), 'in');
    assert.equal(await turn.getAttribute('aria-invalid'), 'true', 'in the other unit the errors are still there');
    await page.locator('#units').click();
    await turn.evaluate((node) => { node.closest('details').open = false; });
    await page.locator('[data-to="/post/axes/turn/decimals"]').click();
    assert.ok(await turn.evaluate((node) => node === document.activeElement && node.checkVisibility()));
    await page.keyboard.press('Control+z');
    await state(page, 'post', 'ok');
    assert.notEqual(await field(page, '/post/axes/turn/decimals').inputValue(), '99');
    await field(page, '/machine/name').fill('');
    await state(page, 'machine', '2 errors');
    await field(page, '/machine/name').fill('shop_table');
    await field(page, '/machine/axes/1/v_max').fill('90');
    await state(page, 'machine', 'ok');
    // Lines of a program are lines of the field.
    await field(page, '/post/modes').fill('G21 G40\nG64 P0.05');
    await page.locator('#own-program', {hasText: 'G64 P0.05'}).waitFor();
    await clean(page);
  },

  'while a file has an error, the program is marked as out of date': async (given) => {
    const page = await own(given);
    const [program, old] = [page.locator('#own-program'), page.locator('#own-stale')];
    const before = await program.innerText();
    for (const [pointer, wrong, right] of [['/machine/axes/0/v_max', '-3', '90'], ['/post/name', '', 'shop_post']]) {
      assert.equal(await old.count(), 0);
      await field(page, pointer).fill(wrong);
      await old.waitFor();
      assert.equal(await program.innerText(), before, 'the last valid one stays');
      assert.match(await program.getAttribute('class'), /old/);
      assert.equal(await program.getAttribute('aria-describedby'), 'own-stale');
      assert.deepEqual(await faint(page), []);
      await field(page, pointer).fill(right);
      await old.waitFor({state: 'detached'});
      assert.doesNotMatch(await program.getAttribute('class'), /old/);
    }
    await page.locator('#own-program', {hasText: 'post shop_post'}).waitFor();
    await clean(page);
  },

  'from the start of the page, the errors are two keys away': async (given) => {
    const page = await own(given);
    const link = page.locator('#to-errors');
    assert.equal(await link.count(), 0, 'without an error there is no link to it');
    await field(page, '/machine/axes/1/v_max').fill('-3');
    await state(page, 'machine', '1 error');
    assert.deepEqual(await barred(page), []);
    await fromStart(page);
    assert.ok(await tabTo(page, '#to-errors') <= 2);
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => document.activeElement.dataset.to), '/machine/axes/1/v_max');
    await page.keyboard.press('Enter');
    assert.ok(await field(page, '/machine/axes/1/v_max').evaluate((node) => node === document.activeElement));
    await page.keyboard.press('Control+a');
    await page.keyboard.type('90');
    await state(page, 'machine', 'ok');
    assert.equal(await link.count(), 0);
    await clean(page);
  },

  'the files of docs/machines.md are opened, named, downloaded, and another service starts with them': async (given) => {
    const page = await own(given);
    const folder = await mkdtemp(join(tmpdir(), 'own-machine-'));
    try {
      await openFile(page, 'rotary_table.json', written('machines/rotary_table.json'));
      await openFile(page, 'our_table.json', written('posts/our_table.json'));
      await page.locator('#own-program', {hasText: 'post our_table'}).waitFor();
      await openFile(page, 'other.json', '{"members": []}');
      await page.locator('[role=status]', {hasText: 'other.json is no file of a machine or a post'}).waitFor();
      await field(page, '/machine/name').fill('shop_table');
      const text = page.locator('[data-text=post]');
      await text.evaluate((node) => { node.closest('details').open = true; });
      await text.fill((await text.inputValue()).replace('"our_table"', '"shop_post"'));
      await text.blur();
      await page.locator('#own-program', {hasText: 'post shop_post'}).waitFor();
      await state(page, 'machine', 'ok');
      const program = await page.locator('#own-program').innerText();
      for (const part of ['machine', 'post']) await mkdir(join(folder, `${part}s`));
      assert.equal(await download(page, 'machine', join(folder, 'machines')), 'shop_table.json');
      assert.equal(await download(page, 'post', join(folder, 'posts')), 'shop_post.json');
      const service = await Service.start(given.server, '--machines', join(folder, 'machines'), '--posts', join(folder, 'posts'));
      try {
        const listed = async (path) => JSON.parse((await service.ask(path, {method: 'GET'})).text);
        const {machines} = await listed('/v1/machines');
        assert.equal(machines.find(({name}) => name === 'shop_table').process.rows.length, 2);
        assert.ok((await listed('/v1/posts')).posts.some(({name}) => name === 'shop_post'));
        // By name, with the values of the table, it is the program that the page showed.
        const saddle = {target: {outer_diameter_mm: 48.3, wall_mm: 3.2}, preset: 'tube_laser', kerf_mm: 1.4,
          cutters: [{kind: 'tube', outer_diameter_mm: 60.3, inclination_deg: 90, clocking_deg: 0, offset_mm: 0}], reference: {part: 'coupon'}};
        const query = 'format=gcode&post=shop_post&machine=shop_table&material=S235&pivot_length_mm=0&torch=on';
        const reply = await service.ask(`/v1/bevel-tables?${query}`, {body: JSON.stringify(saddle)});
        assert.equal(reply.status, 200, reply.text.slice(0, 300));
        assert.ok(moves(program).length > 100);
        assert.deepEqual(moves(reply.text.trimEnd()), moves(program.trimEnd()));
      } finally {
        await service.stop();
      }
      // It is kept, and goes on to its pulses.
      await page.reload();
      await state(page, 'machine', 'ok');
      assert.equal(await field(page, '/machine/name').inputValue(), 'shop_table');
      await page.locator('#own-pulses').click();
      await page.locator('#verdict .pill', {hasText: 'ok'}).waitFor();
      assert.equal(await page.locator('#endpoints [aria-current=page]').getAttribute('data-endpoint'), 'pulse-schedules');
      await clean(page);
    } finally {
      await rm(folder, {recursive: true});
    }
  },

  'an arrow key in the list of starts changes no value; its button does, and undo brings the edits back': async (given) => {
    const page = await own(given);
    for (const part of ['machine', 'post']) {
      await field(page, `/${part}/name`).fill('edited');
      const [list, take] = [page.locator(`[data-start=${part}]`), page.locator(`[data-take=${part}]`)];
      assert.ok(await take.isDisabled(), 'there is nothing to start from yet');
      await list.focus();
      for (let i = 0; i < 3; ++i) await page.keyboard.press('ArrowDown');
      const name = await list.inputValue();
      assert.notEqual(name, '');
      assert.equal(await field(page, `/${part}/name`).inputValue(), 'edited');
      await page.keyboard.press('Tab');
      await page.keyboard.press('Enter');
      await page.locator('.started', {hasText: name}).waitFor();
      assert.equal(await field(page, `/${part}/name`).inputValue(), `my_${part}`);
      if (part === 'machine') await page.locator('#unstart').click();
      else await page.keyboard.press('Control+z');
      assert.equal(await field(page, `/${part}/name`).inputValue(), 'edited');
      assert.ok(await take.evaluate((node) => node === document.activeElement), 'the button has the focus');
      assert.equal(await page.locator('.started').innerText(), '');
      await state(page, part, 'ok');
    }
    await clean(page);
  },

  'each machine and each post of the service is a start without errors': async (given) => {
    const page = await own(given);
    for (const part of ['machine', 'post']) {
      const names = await page.locator(`[data-start=${part}] option`).allInnerTexts();
      assert.ok(names.length > 4, `${names}`);
      for (const name of names.slice(1)) {
        await field(page, `/${part}/name`).fill('');
        await state(page, part, '1 error');
        await page.locator(`[data-start=${part}]`).selectOption(name);
        await page.locator(`[data-take=${part}]`).click();
        await state(page, part, 'ok');
        assert.equal(await field(page, `/${part}/name`).inputValue(), `my_${part}`);
      }
    }
    await clean(page);
  },
};
