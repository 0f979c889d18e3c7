// The page shows the service's answer: its checks, its curves, its parts, the sent values.
import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {answered, formed, open, pixels, then} from '../browser.mjs';

const field = (page, pointer) => page.locator(`[data-pointer="${pointer}"]`);
const clean = (page) => assert.deepEqual(page.faults, [], 'errors in the browser');
const examplesOf = async (service) => JSON.parse((await service.ask('/v1/examples', {method: 'GET'})).text).examples;
const hashOf = ({endpoint, name}) => `#/${endpoint}/${name}`;

/** The page, with the service's answers of `endpoint` changed. */
async function changed(page, endpoint, change) {
  await page.route(`**/v1/${endpoint}`, async (route) => {
    const reply = await route.fetch();
    const answer = await reply.json();
    change(answer);
    await route.fulfill({response: reply, json: answer});
  });
}

/** Where the cursor of a chart is, as it is walked along by the keyboard. */
async function walked(page, chart) {
  const plot = page.locator(`#chart-${chart} .plot`);
  const points = Number(await plot.getAttribute('data-points'));
  await plot.focus();
  await page.keyboard.press('Escape');
  const places = [];
  for (let i = 0; i < points; i += 10) {
    await page.keyboard.press(i === 0 ? 'ArrowRight' : 'Shift+ArrowRight');
    places.push(await plot.evaluate((node) => {
      const [line, over] = [node.querySelector('.u-cursor-x'), node.querySelector('.u-over')].map((each) => each.getBoundingClientRect());
      return (line.right - over.left) / over.width;
    }));
  }
  return places;
}

async function whole({browser, origin}, width, height) {
  for (const hash of ['bevel-tables/zones', 'pulse-schedules/table-1-on-the-five-axis-cutter', 'replays/square-cut', 'feed-curves/source-004-table-1-as-solved']) {
    const page = await open(browser, origin, `#/${hash}`, {width, height});
    await answered(page);
    await formed(page);
    const clipped = () => page.evaluate(() => [...document.querySelectorAll('#form input[type=text]')]
      .filter((input) => input.offsetParent && input.scrollWidth > input.clientWidth).map((input) => `${input.dataset.pointer} ${input.value}`));
    await page.evaluate(() => document.fonts.ready.then(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))));
    assert.deepEqual(await clipped(), [], hash);
    for (const fold of await page.locator('#form details:not([open]) > summary').all()) if (await fold.isVisible()) await fold.click();
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.deepEqual(await clipped(), [], `${hash}, unfolded`);
    if (hash.startsWith('bevel-tables')) {
      await then(page, () => field(page, '/cutters/0/outer_diameter_mm').fill('323.91234567'));
      await then(page, () => field(page, '/target/outer_diameter_mm').fill('168.30000000000123'));
      assert.deepEqual(await clipped(), [], 'as typed');
      const scroll = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(scroll <= width, `the page is ${scroll} px wide`);
    }
    clean(page);
    await page.context().close();
  }
}

export const checks = {
  'the names and joints of a frame are those that its section leaves': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/frames/truss-of-19');
    await answered(page);
    await pixels(page);
    const shown = async () => (await page.locator('.labels .shown').allInnerTexts()).filter(Boolean);
    const whole = await shown();
    await page.locator('#view-section').click();
    await pixels(page);
    const first = await shown();
    await page.locator('#view-other').click();
    await pixels(page);
    const other = await shown();
    const {members} = JSON.parse(await (await page.request.get(`${origin}/v1/examples`)).text()).examples.find(({name}) => name === 'truss-of-19').body;
    const [x] = (await page.locator('#sliced').innerText()).match(/[\d.]+/);
    const runs = (names) => members.filter(({id}) => names.includes(id)).map(({start_mm, end_mm}) => [start_mm[0], end_mm[0]]);
    assert.ok(first.length > 3 && other.length > 3 && whole.length > 6);
    assert.ok(runs(first).every((ends) => Math.min(...ends) <= Number(x)), `${first} before ${x}`);
    assert.ok(runs(other).every((ends) => Math.max(...ends) >= Number(x)), `${other} after ${x}`);
    await page.context().close();
  },

  'a section shows the cut faces of walls, and only those': async ({browser, origin}) => {
    /** The share of the canvas that has the colour of cut faces. */
    const cut = async (page) => {
      await pixels(page);
      return page.evaluate(() => {
        const from = document.querySelector('.canvas canvas');
        const copy = Object.assign(document.createElement('canvas'), {width: from.width, height: from.height});
        const pen = copy.getContext('2d');
        pen.drawImage(from, 0, 0);
        const {data} = pen.getImageData(0, 0, copy.width, copy.height);
        const wanted = getComputedStyle(document.documentElement).getPropertyValue('--section').trim();
        const [r, g, b] = [1, 3, 5].map((i) => parseInt(wanted.slice(i, i + 2), 16));
        let count = 0;
        for (let i = 0; i < data.length; i += 4) if (Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 12) count += 1;
        return count / (data.length / 4);
      });
    };
    // A cut end, a tube with holes, one that is not round, and members of a frame.
    for (const [hash, axis] of [['#/bevel-tables/source-000-table-1', 'x'], ['#/parts/chord-with-holes', 'y'], ['#/parts/shs-base-post', 'y'], ['#/frames/truss-of-19', 'y']]) {
      const page = await open(browser, origin, hash);
      await answered(page);
      if (await page.locator('#view-partners').isVisible()) await page.locator('#view-partners').click();
      assert.ok(await cut(page) < 1e-4, `${hash}: nothing is cut`);
      await page.locator('#view-section').click();
      await page.locator('.slicing select').selectOption(axis);
      const found = Math.max(await cut(page), await page.locator('#view-other').click().then(() => cut(page))); // one half hides its cut
      const {share} = await pixels(page);
      assert.ok(found > 1e-4 && found < 0.7 * share, `${hash}: ${found} of ${share}`);
      await page.locator('#view-section').click();
      assert.ok(await cut(page) < 1e-4, `${hash}: whole again`);
      assert.deepEqual(page.faults, []);
      await page.context().close();
    }
  },

  'a section leaves one half of the model or the other, and what it leaves out is not measured': async ({browser, origin}) => {
    for (const [width, hash, theme] of [[1280, '#/parts/shs-base-post', 'light'], [390, '#/bevel-tables/source-000-table-1', 'dark']]) {
      const page = await open(browser, origin, hash, {theme, width, height: 844});
      await answered(page);
      await page.locator('[data-side=front]').click();
      await page.locator('#view-parallel').click();
      if (await page.locator('#view-partners').isVisible()) await page.locator('#view-partners').click();
      const whole = (await pixels(page)).share;
      await page.locator('#view-section').click();
      await page.locator('.slicing select').selectOption('z');
      const [half, place] = [(await pixels(page)).share, await page.locator('#sliced').innerText()];
      await page.locator('#view-other').click();
      const other = (await pixels(page)).share;
      assert.ok(half < 0.9 * whole && other < 0.9 * whole, `${half} and ${other} of ${whole}`);
      assert.ok(Math.abs(half + other - whole) < 0.12 * whole, `${half} and ${other} make ${whole}`);
      await page.locator('#view-measure').click();
      const {x, y, width: w, height} = await page.locator('.canvas canvas').boundingBox();
      await page.locator('.slicing input').focus();
      await page.keyboard.press('End');
      assert.notEqual(await page.locator('#sliced').innerText(), place);
      assert.ok((await pixels(page)).share < 0.1 * whole, 'at the end nothing is left');
      for (const share of [0.45, 0.55]) await page.mouse.click(x + share * w, y + height / 2);
      assert.match(await page.locator('#measured').innerText(), /Click two points/, 'there is nothing to click');
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= width, 'the page is as wide as the screen');
      await page.locator('#view-section').click();
      assert.ok(Math.abs((await pixels(page)).share - whole) < 0.02 * whole, 'the whole is back');
      await page.context().close();
    }
  },

  'a model is seen from its sides, measured, fitted as it grows, and printed in light colours': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/parts/shs-base-post', {theme: 'dark'});
    await answered(page);
    const canvas = page.locator('.canvas canvas');
    const seen = [(await pixels(page)).sum];
    for (const side of ['front', 'right', 'top']) {
      await page.locator(`[data-side=${side}]`).click();
      seen.push((await pixels(page)).sum);
    }
    await page.locator('[data-side=front]').click();
    await page.locator('#view-parallel').click();
    seen.push((await pixels(page)).sum);
    assert.equal(new Set(seen).size, 5, 'each view is another picture');
    assert.equal(await canvas.evaluate((node) => node.style.touchAction), 'pan-x pan-y', 'one finger scrolls the page');
    await page.locator('#view-measure').click();
    assert.match(await page.locator('#measured').innerText(), /Click two points/);
    const {x, y, width, height} = await canvas.boundingBox();
    for (const share of [0.3, 0.7]) await page.mouse.click(x + share * width, y + height / 2);
    await page.locator('#measured', {hasText: 'mm (x'}).waitFor();
    const [length, , , along] = (await page.locator('#measured').innerText()).match(/[\d.]+/g).map(Number);
    assert.ok(length > 300 && length < 900 && Math.abs(length - along) < 30, `${length}, ${along} of them along the member`);
    const far = async () => Number(await canvas.getAttribute('data-distance'));
    const before = await far();
    await then(page, () => field(page, '/target/length_mm').fill('1800'));
    assert.ok(await far() > 1.7 * before, `${before} mm, then ${await far()}`);
    await page.evaluate(() => {
      window.print = () => {
        const {right} = document.querySelector('#chart-gap-finish canvas').getBoundingClientRect();
        window.paper = {theme: document.documentElement.dataset.theme, text: document.querySelector('#paper').innerText, head: document.querySelector('.top').checkVisibility(), right};
      };
    });
    await page.locator('#print').click();
    await page.locator('body:not(.paper)').waitFor();
    const paper = await page.evaluate(() => window.paper);
    assert.deepEqual([paper.theme, paper.head], ['light', false]);
    assert.match(paper.text, /^tubecut: Part[^]*1800 mm[^]*balcony 7/);
    assert.ok(paper.right > 600 && paper.right <= 700, `the chart is as wide as the paper: ${paper.right}`);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
    clean(page);
    await page.context().close();
  },

  'one switch sets the axis of the charts of every page: developed length, angle or time': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/pulse-schedules/table-1-on-the-five-axis-cutter');
    await answered(page);
    const axes = () => page.locator('[data-axis]').evaluateAll((all) => all.map((each) => [each.dataset.axis, each.getAttribute('aria-pressed')].join(' ')));
    const under = (id) => page.locator(`#chart-${id} .under`);
    assert.deepEqual(await axes(), ['mm false', '° false', 's true'], 'a schedule is over time until somebody chooses');
    await page.locator('#chart-speed .plot').focus();
    for (let i = 0; i < 8; ++i) await page.keyboard.press('Shift+ArrowRight');
    const [time] = (await under('speed').innerText()).match(/^[\d.]+ s/);
    await page.locator('[data-axis="°"]').focus();
    await page.keyboard.press('Enter');
    await under('speed').getByText(/^\d+(\.\d)?°/).first().waitFor();
    const angle = Number.parseFloat(await under('speed').innerText());
    assert.ok(angle > 271 && angle < 657, `${angle}`);
    await page.locator('[data-axis=mm]').click();
    const length = Number.parseFloat(await under('pulses').innerText());
    assert.ok(Math.abs(length - 35 * angle * Math.PI / 180) < 0.3, `${length} mm is ${angle} deg on a tube of 70`);
    await page.locator('[data-axis=s]').click();
    assert.ok((await under('tip').innerText()).startsWith(time), 'the cursor stays at its point');
    await page.locator('[data-axis="°"]').click();
    await then(page, () => page.locator('#endpoints [data-endpoint=bevel-tables]').click());
    assert.deepEqual(await axes(), ['mm false', '° true'], 'chosen for all pages');
    await page.reload();
    await answered(page);
    assert.deepEqual(await axes(), ['mm false', '° true'], 'and remembered');
    await then(page, () => page.evaluate(() => { location.hash = '#/pulse-schedules/square-tube-on-a-tube-table'; }));
    assert.deepEqual(await axes(), [], 'the normal of a square tube stands still on its flats');
    clean(page);
    await page.context().close();
  },

  'a chart shows its values, zooms, hides and changes its axis, and warnings lead to it': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/bevel-tables/table-1-torch-45-deg');
    await answered(page);
    const [bevel, height] = ['bevel', 'height'].map((id) => page.locator(`#chart-${id}`));
    await page.locator('#verdict .show').first().click();
    assert.match(await bevel.locator('.under').innerText(), /^52\.89 mm\s/, 'at the beginning of the warning');
    assert.equal(await bevel.locator('.under i').count(), 3, 'a value of each line');
    assert.ok((await bevel.locator('figcaption').innerText()).includes('root opens'), 'a warning in its chart');
    await page.locator('[data-axis="°"]').click();
    assert.match(await bevel.locator('.under').innerText(), /^101°/);
    await page.locator('[data-axis=mm]').click();
    const area = await height.locator('.u-over').boundingBox();
    const drag = async (from, to) => {
      await page.mouse.move(area.x + from * area.width, area.y + 30);
      await page.mouse.down();
      await page.mouse.move(area.x + to * area.width, area.y + 30, {steps: 3});
      await page.mouse.up();
    };
    const span = async (chart) => ((await chart.locator('.plot').getAttribute('data-span')) ?? '').split(' ').filter(Boolean).map(Number);
    await drag(0.25, 0.5);
    const [from, to] = await span(height);
    assert.ok(to > from && Math.abs(2 * from - to) < 0.06 * to, `${from} to ${to}`);
    assert.deepEqual(await span(bevel), [from, to], 'charts of one axis together');
    await bevel.locator('.unzoom').click();
    assert.deepEqual(await span(height), []);
    await height.locator('.plot').focus();
    await page.keyboard.press('+');
    assert.equal((await span(height)).length, 2);
    await page.keyboard.press('0');
    assert.deepEqual(await span(height), []);
    const drawing = () => bevel.locator('canvas').evaluate((canvas) => canvas.toDataURL());
    const before = await drawing();
    const key = bevel.locator('.key', {hasText: 'least that clears'});
    await key.click();
    assert.equal(await key.getAttribute('aria-pressed'), 'false');
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.notEqual(await drawing(), before);
    await then(page, () => page.evaluate(() => {
      location.hash = '#/grooves/case-a-right-angle';
    }));
    assert.deepEqual((await page.locator('#section [data-point]').allTextContents()).map((text) => text.trim()), ['P1', 'P2', 'P3']);
    assert.match(await page.locator('#section figcaption').innerText(), /areas A 60, B 0, C 0, D 120, E 180 mm²/);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'a value far under its limit holds, as the service says': async ({browser, origin, service}) => {
    const under = [];
    for (const example of await examplesOf(service)) {
      const {verification} = JSON.parse((await service.post(`/v1/${example.endpoint}`, example.body)).text);
      if (verification.passed && verification.checks.some((check) => check.value < -check.limit)) under.push(example);
    }
    assert.ok(under.length > 0, 'no example has such a check');
    const kinds = new Map(under.map((example) => [example.endpoint, example]));
    for (const example of kinds.values()) {
      const page = await open(browser, origin, hashOf(example));
      await answered(page);
      assert.match(await page.locator('#verdict').innerText(), /(\d+) of \1 checks of the answer passed/, hashOf(example));
      assert.equal(await page.locator('tr.failed').count(), 0, hashOf(example));
      clean(page);
      await page.context().close();
    }
  },

  'a check over its limit is named, above and in the proof': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    await changed(page, 'bevel-tables', ({verification}) => {
      verification.passed = false;
      verification.checks[0].value = 2 * verification.checks[0].limit;
    });
    await then(page, () => page.locator('#example').selectOption('mitre'));
    assert.match(await page.locator('#verdict').innerText(), /1 of \d+ checks failed/);
    assert.equal(await page.locator('.verdict.bad').count(), 1);
    assert.equal(await page.locator('tr.failed').count(), 1);
    await page.context().close();
  },

  'charts of near and far holes rise along their axis': async ({browser, origin, service}) => {
    const page = await open(browser, origin, '#/holes/through-brace');
    await answered(page);
    for (const chart of ['bevel-0', 'place-0', 'bevel-1', 'place-1', 'fit-1']) {
      const places = await walked(page, chart);
      assert.ok(places.every((x, i) => i === 0 || x > places[i - 1]), `${chart}: the cursor goes ${places}`);
      assert.ok(places[0] < 0.02 && places[places.length - 1] > 0.95, `${chart}: from ${places[0]} to ${places[places.length - 1]}`);
    }
    const {body} = (await examplesOf(service)).find(({name}) => name === 'through-brace');
    const {points} = JSON.parse((await service.post('/v1/holes', body)).text).result.holes[1];
    const [at, phi] = (await page.locator('#readout dd').allInnerTexts()).map(parseFloat);
    assert.equal(at, 350, 'where the walk ends');
    assert.ok(Math.abs(phi - points.phi_deg[points.branch_phi_deg.indexOf(at)]) < 0.06, `the far hole is read out, not ${phi}`);
    clean(page);
    await page.context().close();
  },

  'what cannot be drawn is said, beside the verdict': async ({browser, origin}) => {
    for (const [hash, spoil] of Object.entries({
      '#/parts/k-joint-brace': ({result}) => delete result.ends.finish.points,
      '#/holes/through-brace': ({result}) => delete result.holes[1].points,
    })) {
      const page = await open(browser, origin);
      await answered(page);
      await changed(page, hash.split('/')[1], spoil);
      await then(page, () => page.evaluate((to) => {
        location.hash = to;
      }, hash));
      assert.match(await page.locator('#trouble').innerText(), /^Not all of this answer could be drawn: ./, hash);
      assert.equal(await page.locator('#verdict .pill').innerText(), 'ok', hash);
      assert.equal(await page.locator('#panel table').count() > 0, true, `${hash}: the proof`);
      await page.unroute('**/v1/*');
      await then(page, () => page.locator('#endpoints [data-endpoint=bevel-tables]').click());
      assert.equal(await page.locator('#trouble').isVisible(), false);
      clean(page);
      await page.context().close();
    }
  },

  'a complaint stands under its own field, in the words of the service': async ({browser, origin}) => {
    for (const width of [1280, 390]) {
      const page = await open(browser, origin, undefined, {width, height: 800});
      await answered(page);
      await formed(page);
      const [wall, diameter] = [field(page, '/target/wall_mm'), field(page, '/target/outer_diameter_mm')];
      const radius = Number(await diameter.inputValue()) / 2;
      await then(page, () => wall.fill(String(radius + 1)));
      assert.equal(await wall.getAttribute('aria-invalid'), 'true');
      assert.equal(await diameter.getAttribute('aria-invalid'), null);
      const note = page.locator(`#${await wall.getAttribute('aria-describedby')}`);
      assert.equal(await note.innerText(), `Out of range: must be at most ${radius - 0.1} mm`);
      const [said, under, beside] = await Promise.all([note, wall, diameter].map((each) => each.boundingBox()));
      assert.ok(said.x <= under.x && said.x + said.width > under.x, 'in the column of the wall');
      assert.ok(said.y >= under.y + under.height && said.y < under.y + under.height + 20, 'right under the wall');
      if (beside.y === under.y) assert.ok(said.x > beside.x + beside.width, 'and not under the diameter');
      clean(page);
      await page.context().close();
    }
  },

  'values are shown whole at 1280 px': (given) => whole(given, 1280, 800),
  'values are shown whole at 390 px': (given) => whole(given, 390, 844),

  'a schedule shows its speed first, and every peak however long it is': async ({browser, origin, service}) => {
    const page = await open(browser, origin, '#/bevel-tables/mitre');
    await answered(page);
    const found = (await examplesOf(service)).filter(({name}) => ['source-002-offset-pair-on-the-crawler', 'square-cut-from-a-bare-contour'].includes(name));
    for (const example of found) {
      const {result} = JSON.parse((await service.post('/v1/pulse-schedules', example.body)).text);
      await then(page, () => page.evaluate((to) => {
        location.hash = to;
      }, hashOf(example)));
      const charts = await page.locator('#charts .chart').evaluateAll((all) => all.map(({id}) => id));
      assert.deepEqual(charts, ['chart-tip', 'chart-speed', 'chart-pulses', 'chart-positions']);
      const told = await page.locator('#chart-pulses .plot').getAttribute('aria-label');
      for (const axis of result.axes) {
        const [, low, high] = new RegExp(`${axis} from (-?\\d+) to (-?\\d+)`).exec(told);
        assert.equal(Math.max(-low, high), result.report.peak[axis], `${example.name}: ${axis} in ${told}`);
      }
      const [, fastest] = /to (\d+) mm\/min/.exec(await page.locator('#chart-tip .plot').getAttribute('aria-label'));
      const {mm_min: asked} = example.body.motion.speed;
      if (asked) assert.ok(Math.abs(fastest - asked) < 0.03 * asked, `${example.name}: ${fastest} of ${asked} mm/min`);
    }
    assert.equal(found.length, 2);
    clean(page);
    await page.context().close();
  },

  'a part’s schedule tells each cut with its rapid and pierce, and no event is written on another': async ({browser, origin, service}) => {
    const hash = 'pulse-schedules/two-ends-and-four-holes-of-a-part';
    const [endpoint, name] = hash.split('/');
    const body = await readFile(new URL(`../../../examples/${endpoint}/${name}.json`, import.meta.url), 'utf8');
    const {result} = JSON.parse((await service.post(`/v1/${endpoint}`, JSON.parse(body))).text);
    const page = await open(browser, origin, `#/${hash}`);
    await answered(page);
    const rows = await page.locator('#panel section', {has: page.locator('h3', {hasText: 'Cuts in their order'})}).locator('tbody tr').allInnerTexts();
    const cells = rows.map((row) => row.split('\t'));
    const seconds = ({from, to}) => (to - from) * result.period_us * 1e-6;
    const of = (kind) => result.segments.filter((s) => s.kind === kind);
    assert.deepEqual(cells.map(([cut]) => cut.toLowerCase()), of('cut').map((s) => s.name.toLowerCase()));
    for (const [i, [, , rapid, pierce, cut]] of cells.entries()) {
      for (const [shown, kind] of [[rapid, 'rapid'], [pierce, 'pierce'], [cut, 'cut']]) assert.ok(Math.abs(Number(shown) - seconds(of(kind)[i])) < 0.006 * seconds(of(kind)[i]), `${kind} ${i}: ${shown}`);
    }
    assert.match(await page.locator('#figures').innerText(), /In rapids/i);
    const keys = await page.locator('#chart-pulses figcaption').innerText();
    assert.match(keys, /rapid/);
    assert.doesNotMatch(keys, /torch on|cut start/);
    clean(page);
    await page.context().close();
  },

  'time is played and scrubbed, and the torch goes along': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/pulse-schedules/table-1-on-the-five-axis-cutter');
    await answered(page);
    const [slider, play] = [page.locator('#player input'), page.locator('#play')];
    const seconds = async () => parseFloat(await page.locator('#readout dd').first().innerText());
    assert.equal(await play.innerText(), 'Next event', 'where motion is unwanted');
    const places = [];
    const sums = new Set();
    for (let i = 0; i < 3; ++i) {
      await play.press('Enter');
      places.push(await seconds());
      sums.add((await pixels(page)).sum);
    }
    assert.ok(places.every((at, i) => i === 0 || at > places[i - 1]) && sums.size === 3, `events at ${places}`);
    await slider.press('Home');
    for (let i = 0; i < 3; ++i) await slider.press('PageUp');
    const there = await seconds();
    assert.ok(there > 8 && there < 11, `three tenths of 31.4 s is ${there} s`);
    assert.match(await slider.getAttribute('aria-valuetext'), /^9\.4\d? s, after cut start$/);
    const at = await page.locator('#chart-tip .u-cursor-x').evaluate((line) => (line.getBoundingClientRect().right - line.parentElement.getBoundingClientRect().left) / line.parentElement.clientWidth);
    assert.ok(Math.abs(at - there / 31.4) < 0.02, `the cursor stands at ${at}`);
    await page.emulateMedia({reducedMotion: 'no-preference'});
    await page.locator('#play', {hasText: 'Play'}).waitFor();
    await play.press('Enter');
    while (await seconds() < there + 0.5) await page.waitForTimeout(50);
    await play.press('Enter');
    const stopped = await seconds();
    await page.waitForTimeout(200);
    assert.equal(await seconds(), stopped, 'it stands still');
    clean(page);
    await page.context().close();
  },

  'the mill’s cone goes along the groove, and lies on it in the section': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/mill-paths/case-a-end-up');
    await answered(page);
    const rest = (await pixels(page)).sum;
    await page.locator('#chart-b .plot').focus();
    const sums = new Set([rest]);
    for (const steps of [1, 4, 11]) {
      for (let i = 0; i < steps; ++i) await page.keyboard.press('Shift+ArrowRight');
      sums.add((await pixels(page)).sum);
      const omega = await page.locator('#readout dd').first().innerText();
      assert.equal(await page.locator('#section b').innerText(), `Section at ω ${omega}`);
      const polygon = async (tone) => (await page.locator(`#section [data-tone=${tone}]`).getAttribute('points')).split(' ').map((point) => point.split(',').map(Number));
      const [wall, tool] = [await polygon('steel'), await polygon('after')];
      const off = ([x, y]) => Math.min(...tool.map(([u, v], i) => {
        const [p, q] = tool[(i + 1) % tool.length];
        const share = Math.min(1, Math.max(0, ((x - u) * (p - u) + (y - v) * (q - v)) / ((p - u) ** 2 + (q - v) ** 2)));
        return Math.hypot(x - u - share * (p - u), y - v - share * (q - v));
      }));
      // It touches 1 to 3° from the plane, for which it is corrected by up to 0.23 mm.
      for (const corner of [wall[2], wall[3]]) assert.ok(off(corner) < 0.25, `the flank is ${off(corner)} mm off the groove at ${omega}`);
    }
    await page.locator('#view-before').click();
    await page.locator('#view-before[aria-pressed=true]').waitFor();
    sums.add((await pixels(page)).sum);
    assert.equal(sums.size, 5, 'another picture at every place, and before the correction');
    clean(page);
    await page.context().close();
  },

  'one state at a time': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    await pixels(page);
    const pressed = () => page.locator('#switches .pair [aria-pressed=true]').allInnerTexts();
    assert.deepEqual(await pressed(), ['After']);
    const canvas = page.locator('.canvas canvas');
    assert.equal(await canvas.getAttribute('data-state'), 'after');
    await page.locator('#view-before').click();
    await page.locator('#view-before[aria-pressed=true]').waitFor();
    assert.deepEqual(await pressed(), ['Before']);
    assert.equal(await canvas.getAttribute('data-state'), 'before');
    clean(page);
    await page.context().close();
  },
};
