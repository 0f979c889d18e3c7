// The table of a frame's members: filled from a spreadsheet, searched, changed; one choice for it, the form and the picture; warnings with their fixes.
import {strict as assert} from 'node:assert';
import {readFileSync} from 'node:fs';
import {answered, faint, formed, open, pixels, then} from '../browser.mjs';
import {barred, unseen} from '../seen.mjs';

const example = (name) => JSON.parse(readFileSync(new URL(`../../../examples/frames/${name}.json`, import.meta.url)));
const table = (page) => page.locator('#members .sheet');
const cell = (page, row, column) => page.locator(`#cell-${row}-${column}`);
const rows = (page) => page.locator('#members .rows [role=row]');
const count = async (page) => (await page.locator('#members h3 .soft').innerText()).trim();
async function request(page) {
  await page.locator('#tab-json').click();
  return JSON.parse(await page.locator('#request-json').innerText());
}
async function frame(browser, origin, name, size) {
  const page = await open(browser, origin, `#/frames/${name}`, size);
  await answered(page);
  await pixels(page);
  return page;
}
const clean = async (page) => {
  assert.deepEqual(page.faults, []);
  await page.context().close();
};
const paste = (page, text) => table(page).evaluate((node, data) => {
  const clipboardData = new DataTransfer();
  clipboardData.setData('text/plain', data);
  node.dispatchEvent(new ClipboardEvent('paste', {clipboardData, bubbles: true, cancelable: true}));
}, text);

export const checks = {
  'a new frame connects its members, and what is added has a new name and is cut': async ({browser, origin}) => {
    const page = await frame(browser, origin, 'truss-of-19');
    await then(page, () => page.locator('#blank').click());
    assert.ok((await request(page)).connect.within_mm > 0);
    for (let i = 0; i < 2; ++i) await then(page, () => page.locator('#member-add').click());
    const {members} = await request(page);
    assert.equal(new Set(members.map(({id}) => id)).size, 4);
    assert.deepEqual(members[2].start_mm, members[1].end_mm);
    assert.equal(await page.locator('.canvas canvas').getAttribute('data-members'), '4');
    await clean(page);
  },

  'a cell is changed by the keyboard; a new name goes to the joints, a taken one is refused': async ({browser, origin}) => {
    const page = await frame(browser, origin, 'roll-cage-of-12');
    await cell(page, 5, 0).click();
    await table(page).press('Enter');
    const editor = page.locator('#members .here input');
    await editor.fill('screen');
    await then(page, () => editor.press('Enter'));
    assert.equal(await table(page).getAttribute('aria-activedescendant'), 'cell-6-0', 'Enter goes down');
    const {members, joints} = await request(page);
    assert.equal(members[5].id, 'screen');
    assert.equal(joints.filter(({between}) => between.includes('screen')).length, 2);
    assert.ok(!JSON.stringify(joints).includes('windscreen'));
    await cell(page, 5, 0).dblclick();
    await editor.fill('floor');
    await editor.press('Enter');
    assert.match(await page.locator('#members [role=status]').innerText(), /"floor" is taken/);
    await cell(page, 5, 9).click();
    await page.keyboard.type('3,25');
    await then(page, () => editor.press('Tab'));
    assert.equal((await request(page)).members[5].wall_mm, 3.25);
    await cell(page, 5, 9).click();
    await page.keyboard.type('99');
    await editor.press('Escape');
    assert.equal((await request(page)).members[5].wall_mm, 3.25, 'Escape keeps the value');
    await then(page, async () => {
      await cell(page, 5, 9).click();
      await page.keyboard.type('x');
      await editor.press('Enter');
    });
    assert.equal(await cell(page, 5, 9).getAttribute('aria-invalid'), 'true');
    await clean(page);
  },

  'a spreadsheet is pasted, rows are chosen, filled down, deleted and brought back': async ({browser, origin}) => {
    const page = await frame(browser, origin, 'truss-of-19');
    const before = await request(page);
    await cell(page, 0, 0).click();
    await then(page, () => paste(page, 'name\tx1\ty1\tz1\tx2\ty2\tz2\tod\twall\nnew a\t0\t0\t0\t0\t-800\t0\t42,4\t3\nnew b\t1000\t0\t0\t1000\t-800\t0\t42,4\t3\n'));
    assert.equal(await count(page), '21');
    await page.locator('#members [aria-selected=true]').first().waitFor();
    const pasted = await request(page);
    assert.deepEqual(pasted.members.slice(19).map(({id, end_mm, outer_diameter_mm}) => [id, end_mm, outer_diameter_mm]), [['new a', [0, -800, 0], 42.4], ['new b', [1000, -800, 0], 42.4]]);
    assert.deepEqual(pasted.members.slice(0, 19), before.members);
    await table(page).focus();
    await table(page).press('Control+Home');
    await cell(page, 1, 6).click();
    await cell(page, 3, 6).click({modifiers: ['Shift']});
    assert.equal(await page.locator('#members [aria-selected=true]').count(), 3);
    await then(page, () => page.locator('#member-fill').click());
    const filled = (await request(page)).members.slice(1, 4).map(({end_mm}) => end_mm[2]);
    assert.equal(new Set(filled).size, 1);
    const whole = await request(page);
    await cell(page, 6, 0).click({modifiers: ['Control']});
    await table(page).focus();
    await then(page, () => table(page).press('Delete'));
    assert.equal(await count(page), '17');
    const left = await request(page);
    const gone = whole.members.map(({id}) => id).filter((id) => !left.members.some((each) => each.id === id));
    assert.equal(gone.length, 4);
    assert.ok(!gone.some((id) => JSON.stringify(left.joints ?? []).includes(`"${id}"`)));
    await then(page, () => page.locator('#member-undo').click());
    assert.deepEqual(await request(page), whole);
    await clean(page);
  },

  'table, form, list and picture have one choice': async ({browser, origin}) => {
    const page = await frame(browser, origin, 'roll-cage-of-12');
    const name = page.locator('[data-pointer$="/id"][data-pointer^="/members/"]');
    await cell(page, 3, 0).click();
    assert.equal(await name.inputValue(), 'side left');
    assert.match(await page.locator('.facts h3').innerText(), /^side left/);
    assert.deepEqual(await page.locator('.labels .chosen').allInnerTexts(), ['side left']);
    await page.locator('#item-8').click();
    assert.equal(await name.inputValue(), 'diagonal');
    assert.equal(await page.locator('#members .active').locator('[role=gridcell]').nth(1).innerText(), 'diagonal');
    await cell(page, 1, 0).click();
    await cell(page, 2, 0).click({modifiers: ['Control']});
    await pixels(page);
    assert.deepEqual((await page.locator('.labels .chosen').allInnerTexts()).sort(), ['main right', 'main top']);
    await page.locator('button[aria-label="Next row"]').click();
    assert.match(await page.locator('.facts h3').innerText(), /^side left/);
    await clean(page);
  },

  'warnings are counted by kind, grouped by member, shown and fixed with one click': async ({browser, origin}) => {
    const page = await frame(browser, origin, 'roll-cage-of-12');
    const kinds = page.locator('.kinds button');
    assert.deepEqual(await kinds.allInnerTexts(), ['Free end 5']);
    const groups = page.locator('.by-member > ul > li');
    assert.equal(await groups.count(), 5);
    await page.locator('button[aria-label="Show side left"]').click();
    assert.match(await page.locator('.facts h3').innerText(), /^side left/);
    await then(page, () => groups.first().locator('.fix', {hasText: 'Square the end'}).click());
    assert.deepEqual(await kinds.allInnerTexts(), ['Free end 4']);
    const {others, members} = await request(page);
    assert.deepEqual(others.at(-1).point_mm, members[1].end_mm);
    const raise = groups.first().locator('.fix', {hasText: 'Raise within'});
    const within = Number((await raise.innerText()).match(/[\d.]+/)[0]);
    await then(page, () => raise.click());
    assert.equal((await request(page)).connect.within_mm, within);
    await clean(page);
  },

  'a member of 500 is found, and only what is seen is drawn': async ({browser, origin}) => {
    const page = await frame(browser, origin, 'truss-of-500');
    assert.equal(await count(page), '500');
    assert.ok(await rows(page).count() < 60);
    await table(page).focus();
    await table(page).press('Control+End');
    const last = example('truss-of-500').members.length - 1;
    await cell(page, last, 0).waitFor();
    const {id} = example('truss-of-500').members[347];
    await page.locator('#members input[type=search]').fill(id);
    await cell(page, 347, 0).waitFor();
    assert.equal(await cell(page, 347, 0).innerText(), id);
    await cell(page, 347, 0).click();
    assert.match(await page.locator('.facts h3').innerText(), new RegExp(`^${id}`));
    assert.ok(await page.locator('#items [aria-selected=true]').isVisible());
    await page.locator('#members input[type=search]').fill('no such name');
    assert.equal(await count(page), '0 of 500');
    await page.locator('#members input[type=search]').fill('');
    await page.locator('#members .head button', {hasText: 'Start x'}).click();
    assert.equal(await page.locator('#members [aria-sort=ascending]').count(), 1);
    const starts = (await page.locator('#members .rows [role=row]').evaluateAll((all) => all
      .sort((a, b) => Number(a.getAttribute('aria-rowindex')) - Number(b.getAttribute('aria-rowindex'))).map((row) => Number(row.children[2].textContent))));
    assert.ok(starts.every((x, i) => i === 0 || starts[i - 1] <= x), String(starts));
    await clean(page);
  },

  'the table is readable and usable at both widths and themes': async ({browser, origin}) => {
    for (const [width, theme] of [[1280, 'dark'], [390, 'light']]) {
      const page = await frame(browser, origin, 'roll-cage-of-12', {width, height: 844, theme});
      await formed(page);
      await cell(page, 3, 0).click();
      assert.deepEqual(await unseen(page), []);
      assert.deepEqual(await faint(page), []);
      assert.deepEqual(await barred(page), []);
      await clean(page);
    }
  },
};
