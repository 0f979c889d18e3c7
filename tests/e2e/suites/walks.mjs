// The walks of ../walks.md, step by step: four users, by the mouse and by the keyboard only.
// If TUBECUT_DRAWINGS=all is set, each walks at every combination of width, theme and language.
import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {answered, open, pixels, then} from '../browser.mjs';
import {byKeys, byMouse} from '../keyboard.mjs';
import {barred} from '../seen.mjs';

const widths = [390, 1280, 1920];
const themes = ['light', 'dark'];
const locales = ['en-US', 'zh-CN'];
const field = (pointer) => `[data-pointer="${pointer}"]`;

/** A walk: its page, the hands that use it, and the checks of what it shows. */
class Walk {
  constructor(page, {width, keys}) {
    Object.assign(this, {page, width, keys, hands: keys ? byKeys(page) : byMouse(page)});
  }

  /** Does a step that asks the service, and waits for the answer. */
  asks = (act) => then(this.page, act);
  press = (selector) => this.hands.press(selector);
  follow = (selector) => this.asks(() => this.press(selector));

  /** Changes a field of the form, which a phone shows on demand. */
  async change(pointer, text) {
    const edit = this.page.locator('#edit');
    if (await edit.isVisible() && await edit.getAttribute('aria-expanded') === 'false') await this.press('#edit');
    await this.asks(() => this.hands.enter(field(pointer), text));
  }

  async save(selector, name) {
    const [file] = await Promise.all([this.page.waitForEvent('download', {timeout: 60000}), this.press(selector)]);
    assert.match(file.suggestedFilename(), name);
    return readFile(await file.path());
  }

  /** The verdict is one of these: good, warn, bad. */
  async judged(...tones) {
    const verdict = this.page.locator('#verdict .verdict');
    const tone = (await verdict.getAttribute('class')).split(' ').find((each) => /good|warn|bad/.test(each));
    assert.ok(tones.includes(tone), `${tone}: ${await verdict.innerText()}`);
  }

  /** The name of the chosen member or joint. */
  chosen = async () => (await this.page.locator('.facts h3').innerText()).split('\n')[0].trim();

  /** If the page draws, at least this share of its canvas is covered. */
  async drawn(least) {
    if (this.keys) return;
    const {share} = await pixels(this.page);
    assert.ok(share > least, `${share} of the canvas is covered`);
  }

  async endpoint(id) {
    assert.equal(await this.page.locator('#endpoints [aria-current]').getAttribute('data-endpoint'), id);
  }

  /** The page has no error, asks no other server and is no wider than the screen. */
  async works(where) {
    assert.deepEqual(this.page.faults, [], `${where}: errors in the browser`);
    assert.deepEqual(this.page.strangers, [], `${where}: requests to others`);
    assert.ok(await this.page.evaluate(() => document.documentElement.scrollWidth) <= this.width, `${where}: wider than the screen`);
  }

  /** It works, and axe finds nothing. */
  async sound(where) {
    await this.works(where);
    assert.deepEqual(await barred(this.page), [], `${where}: axe`);
  }
}

async function fabricator(walk) {
  const {page} = walk;
  // 1. The start page.
  assert.equal(await page.locator('[data-task]').count(), 4);
  await walk.sound('start');
  await walk.follow('[data-new=bevel-tables]');
  await walk.judged('good');
  // 2. The tubes.
  for (const [pointer, value] of [['/target/outer_diameter_mm', '48.3'], ['/target/wall_mm', '3.2'], ['/cutters/0/outer_diameter_mm', '60.3'], ['/cutters/0/inclination_deg', '45']]) {
    await walk.change(pointer, value);
  }
  await walk.judged('good', 'warn');
  // 3. An error at its field.
  await walk.change('/target/wall_mm', '0');
  await walk.judged('bad');
  assert.equal(await page.locator(field('/target/wall_mm')).getAttribute('aria-invalid'), 'true');
  await walk.sound('refused');
  await walk.change('/target/wall_mm', '3.2');
  await walk.judged('good', 'warn');
  // 4. The model and the chart.
  await walk.drawn(0.02);
  await walk.hands.point('bevel');
  assert.match(await page.locator('#chart-bevel .under').innerText(), /\d/);
  await walk.sound('joint');
  // 5. The template.
  await walk.press('[data-onward=files]');
  await walk.hands.pick('purpose', 'drawing');
  await walk.press('[data-shows=template]');
  await page.locator('#drawing svg').waitFor();
  await walk.sound('template');
  assert.match(String((await walk.save('[data-media="application/pdf"]', /\.pdf$/)).subarray(0, 5)), /%PDF-/);
  // 6. The part.
  await walk.follow('[data-onward=parts]');
  await walk.endpoint('parts');
  await walk.judged('good', 'warn');
  // 7. The work order.
  await walk.press('[data-onward=files]');
  await walk.hands.pick('purpose', 'drawing');
  await walk.press('[data-shows=work_order]');
  await page.locator('#drawing svg').waitFor();
  await walk.sound('work order');
  // 8. The job as a file, and from the list of recent jobs.
  const {target} = JSON.parse(await walk.save('#save-job', /\.json$/));
  assert.deepEqual([target.outer_diameter_mm, target.wall_mm], [48.3, 3.2]);
  await walk.follow('.brand');
  await walk.follow('#recent li a');
  await walk.judged('good', 'warn');
}

// The rail ends 40 mm before the axis of its post.
const sheet = `name\tx1\ty1\tz1\tx2\ty2\tz2\tod\twall
left post\t0\t0\t0\t0\t0\t1200\t60.3\t4
right post\t1500\t0\t0\t1500\t0\t1200\t60.3\t4
rail\t0\t0\t900\t1460\t0\t900\t48.3\t3.2
brace\t0\t0\t200\t1500\t0\t850\t48.3\t3.2
`;

async function builder(walk) {
  const {page} = walk;
  // 1. A new frame.
  await walk.follow('[data-new=frames]');
  await walk.judged('good');
  // 2. The table of a spreadsheet.
  await walk.press('#paste-table');
  const box = page.locator('#imported textarea');
  await box.waitFor();
  assert.ok(await box.evaluate((node) => node === document.activeElement), 'the field of the table has the focus');
  await page.evaluate((text) => navigator.clipboard.writeText(text), sheet);
  await walk.asks(() => page.keyboard.press('Control+v'));
  assert.deepEqual(await page.locator('#items [role=option] b').allInnerTexts(), ['left post', 'right post', 'rail', 'brace']);
  await walk.drawn(0.003);
  // 3. The warning, by its member.
  await walk.judged('warn');
  assert.deepEqual(await page.locator('.by-member > ul > li > b').allInnerTexts(), ['rail']);
  await walk.press('.by-member > ul > li > button');
  assert.match(await walk.chosen(), /^rail/);
  await walk.sound('frame');
  // 4. The end of the rail, in the table of members.
  await walk.hands.cell(2, 4);
  await page.keyboard.type('1500');
  await walk.asks(() => page.keyboard.press('Enter'));
  await walk.judged('good');
  assert.equal(await page.locator('.by-member').count(), 0);
  // 5. A joint.
  await walk.hands.tab('joints');
  await walk.hands.item(0);
  assert.match(await walk.chosen(), /post/);
  assert.ok(await page.locator('.facts .figure').count() > 3);
  await walk.sound('joint');
  // 6. The part of a member.
  await walk.hands.tab('members');
  await walk.hands.item(3);
  assert.match(await walk.chosen(), /^brace/);
  await walk.follow('#open-item');
  await walk.endpoint('parts');
  await walk.judged('good');
  await walk.sound('part');
  await page.waitForURL(/#\/parts\/~/);
  await walk.asks(() => page.goBack());
  assert.match(await walk.chosen(), /^brace/);
  // 7. The packet.
  await walk.press('[data-onward=files]');
  await walk.hands.pick('purpose', 'packet');
  await walk.sound('packet');
  assert.equal(String((await walk.save('#panel [data-media="application/zip"]', /\.zip$/)).subarray(0, 2)), 'PK');
}

async function owner(walk) {
  const {page} = walk;
  const is = (part, sound) => page.locator(sound ? `[data-download=${part}]:enabled` : `[data-download=${part}]:disabled`).waitFor();
  // 1. The page of the own machine.
  await walk.follow('[data-task=machine] a[href="#/own-machine"]');
  await is('post', true);
  await walk.sound('own machine');
  // 2. The post to start from.
  await walk.hands.choose('[data-start=post]', 'linuxcnc');
  await walk.press('[data-take=post]');
  await page.locator('#own-program').waitFor();
  // 3. A limit from the data sheet, at first with an error.
  await walk.hands.enter(field('/machine/axes/0/v_max'), '-3');
  await is('machine', false);
  assert.equal(await page.locator(field('/machine/axes/0/v_max')).getAttribute('aria-invalid'), 'true');
  await walk.sound('an error');
  await walk.press('[data-to="/machine/axes/0/v_max"]');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.pointer), '/machine/axes/0/v_max');
  await walk.hands.enter(field('/machine/axes/0/v_max'), '90');
  await is('machine', true);
  // 4. The names, and the program of the coupon.
  await walk.hands.enter(field('/machine/name'), 'shop_table');
  await walk.hands.enter(field('/post/name'), 'shop_post');
  await page.locator('#own-program', {hasText: 'post shop_post'}).waitFor();
  // 5. Both files.
  const machine = JSON.parse(await walk.save('[data-download=machine]', /^shop_table\.json$/));
  assert.deepEqual([machine.name, machine.axes[0].v_max], ['shop_table', 90]);
  assert.equal(JSON.parse(await walk.save('[data-download=post]', /^shop_post\.json$/)).name, 'shop_post');
  // 6. The pulses of the coupon.
  await walk.follow('#own-pulses');
  await walk.endpoint('pulse-schedules');
  await walk.judged('good', 'warn');
  await walk.hands.slide('#player input');
  assert.ok(Number(await page.locator('#player input').inputValue()) > 0);
  await walk.sound('pulses');
  // 7. A part.
  await walk.follow('.brand');
  await walk.follow('[data-task=part] [href="#/parts/chord-with-holes"]');
  await walk.judged('good', 'warn');
  // 8. Its program.
  await walk.press('[data-onward=program]');
  await walk.hands.enter('[data-option=lead_mm]', '5');
  await walk.press('#preview');
  await page.locator('#program li').first().waitFor();
  await walk.press('#play');
  assert.match(await page.locator('#player output').innerText(), /\d/);
  assert.equal(await page.locator('#program [aria-current=true]').count(), 1);
  await walk.sound('program');
  assert.match(String(await walk.save('[data-media="text/x-gcode"]', /\.ngc$/)), /^G21/m);
}

async function engineer(walk) {
  const {page} = walk;
  const said = () => page.locator('#verdict .said').innerText();
  // 1. A feed curve.
  await walk.follow('[data-task=machine] [href^="#/feed-curves/"]');
  await walk.judged('good', 'warn');
  await walk.hands.point('speed');
  assert.match(await page.locator('#chart-speed .under').innerText(), /\d/);
  await walk.sound('feed curve');
  // 2. Another feed.
  const before = await said();
  await walk.change('/cut/feed_mm_s', '0.8');
  await walk.judged('good', 'warn');
  assert.notEqual(await said(), before);
  // 3. Its data.
  await walk.press('[data-onward=files]');
  await walk.hands.pick('purpose', 'data');
  assert.ok((await walk.save('[data-media="text/csv"]', /\.csv$/)).length > 100);
  // 4. A groove.
  await walk.follow('#endpoints [data-endpoint=grooves]');
  await walk.change('/filler/height_mm', '13');
  await walk.judged('good', 'warn');
  await walk.sound('groove');
  // 5. Its mill path.
  await walk.follow('[data-onward=mill-paths]');
  await walk.endpoint('mill-paths');
  await walk.judged('good', 'warn');
  await walk.sound('mill path');
  // 6. The pulses, faster than the machine can.
  await walk.follow('[data-onward=pulse-schedules]');
  await walk.judged('good');
  await walk.change('/motion/speed/mm_min', '60000');
  await walk.judged('warn');
  await walk.sound('pulses');
  await walk.press('#verdict .show');
  assert.ok(await page.locator('.chart .under', {hasText: /\d/}).count() > 0);
  // 7. The independent checks.
  await walk.press('#check-independently');
  await page.locator('#opinion [data-passed=true]').waitFor({timeout: 60000});
  await walk.press('#opinion > button');
  // 8. The link.
  await walk.press('#share');
  await page.waitForURL(/#\/pulse-schedules\/~/);
  await page.locator('#share').evaluate(async (button) => {
    const end = Date.now() + 5000;
    while (!/#\/pulse-schedules\/~/.test(await navigator.clipboard.readText()) && Date.now() < end) await new Promise((done) => setTimeout(done, 20, button));
  });
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), page.url());
}

const users = {
  'a fabricator with one joint': {user: fabricator, mouse: [[390, 'dark', 'zh-CN']], keys: [[1280, 'light', 'en-US']]},
  'a builder of frames': {user: builder, mouse: [[1920, 'light', 'zh-CN']], keys: [[390, 'light', 'en-US']]},
  'an owner of a LinuxCNC table': {user: owner, mouse: [[390, 'light', 'en-US']], keys: [[1920, 'dark', 'zh-CN']]},
  'a process engineer': {user: engineer, mouse: [[1920, 'dark', 'en-US']], keys: [[1280, 'light', 'zh-CN']]},
};

/** With the keyboard, the page draws no 3D, because its pictures cost a third of the time. */
async function walked({browser, origin}, user, [width, theme, locale], keys) {
  const page = await open(browser, origin, '#/', {width, height: width < 1000 ? 844 : 900, theme, locale, draws: !keys});
  try {
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write'], {origin});
    await answered(page);
    assert.equal(await page.locator('html').getAttribute('lang'), locale.slice(0, 2) === 'zh' ? 'zh-CN' : 'en');
    assert.equal(await page.locator('html').getAttribute('data-theme'), theme);
    const walk = new Walk(page, {width, keys});
    await user(walk);
    await walk.works('at the end');
  } finally {
    await page.context().close();
  }
}

const every = widths.flatMap((width) => themes.flatMap((theme) => locales.map((locale) => [width, theme, locale])));
const {TUBECUT_DRAWINGS: drawings} = process.env;
const chosen = (few) => (drawings === 'all' ? every : few);
export const checks = Object.fromEntries(Object.entries(users).flatMap(([name, {user, mouse, keys}]) => [
  ...chosen(mouse).map((look) => [`${name}: ${look.join(', ')}`, (given) => walked(given, user, look, false)]),
  ...chosen(keys).map((look) => [`${name}, by the keyboard: ${look.join(', ')}`, (given) => walked(given, user, look, true)]),
]));
