// A frame in the console: its members in place, the selection, and the part to which it leads.
import {strict as assert} from 'node:assert';
import {readdirSync, readFileSync} from 'node:fs';
import {answered, open, pixels, then} from '../browser.mjs';

const folder = new URL('../../../examples/frames/', import.meta.url);
const names = readdirSync(folder).map((file) => file.replace('.json', ''));
const example = (name) => JSON.parse(readFileSync(new URL(`${name}.json`, folder)));
const answerTo = async (service, body) => JSON.parse((await service.post('/v1/frames', body)).text);

const clean = (page) => {
  assert.deepEqual(page.faults, [], 'errors in the browser');
  assert.deepEqual(page.strangers, [], 'requests to others');
};
const frame = async (browser, origin, name, size) => {
  const page = await open(browser, origin, `#/frames/${name}`, size);
  await answered(page);
  await pixels(page);
  return page;
};
const canvas = (page) => page.locator('.canvas canvas');
const facts = (page) => page.locator('.facts').innerText();
const figure = (page, name) => page.locator('.facts .figure', {has: page.getByText(name, {exact: true})}).locator('b').innerText();
const mm = (value) => `${Number(Number(value.toFixed(2)).toPrecision(6))}`;
const choose = async (page, index) => {
  await page.locator(`#item-${index}`).click();
  await pixels(page);
};

/**
 * Of the pixels in the selection's colour: their number, and their centre, as fractions of the
 * canvas.
 */
const lit = (page) => page.evaluate(() => {
  const from = document.querySelector('.canvas canvas');
  const copy = Object.assign(document.createElement('canvas'), {width: from.width, height: from.height});
  const pen = copy.getContext('2d');
  pen.drawImage(from, 0, 0);
  const {data} = pen.getImageData(0, 0, copy.width, copy.height);
  let count = 0, x = 0, y = 0;
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b, a] = data.slice(i, i + 4);
    if (a < 200 || b < 100 || b < 1.45 * g || b < 2 * r) continue;  // a blue that no verdict, edge or partner is
    count += 1;
    x += (i / 4) % copy.width;
    y += Math.floor(i / 4 / copy.width);
  }
  return {count, x: x / count / copy.width, y: y / count / copy.height};
});

/**
 * Number of pixels around a point of the canvas, up to two pixels off, in the selection's colour,
 * in the next picture.
 */
const litAt = (page, at) => page.evaluate(async ([x, y]) => {
  await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  const from = document.querySelector('.canvas canvas');
  const size = 4 * Math.round(from.width / from.clientWidth) + 1;
  const copy = Object.assign(document.createElement('canvas'), {width: size, height: size});
  const pen = copy.getContext('2d');
  pen.drawImage(from, Math.floor(x * from.width) - (size - 1) / 2, Math.floor(y * from.height) - (size - 1) / 2, size, size, 0, 0, size, size);
  const {data} = pen.getImageData(0, 0, size, size);
  const colours = Array.from({length: data.length / 4}, (_, i) => data.slice(4 * i, 4 * i + 3));
  return colours.filter(([r, g, b]) => b > 1.2 * g && b > 1.2 * r && b > 60).length / colours.length;
}, at);

/** The share of something solid at a place of the canvas and `reach` of the page's pixels round it. */
const solidAt = (page, at, reach) => page.evaluate(([x, y, far]) => {
  const from = document.querySelector('.canvas canvas');
  const size = 2 * far * Math.round(from.width / from.clientWidth) + 1;
  const copy = Object.assign(document.createElement('canvas'), {width: size, height: size});
  const pen = copy.getContext('2d');
  pen.drawImage(from, Math.floor(x * from.width) - (size - 1) / 2, Math.floor(y * from.height) - (size - 1) / 2, size, size, 0, 0, size, size);
  return pen.getImageData(0, 0, size, size).data.filter((value, i) => i % 4 === 3 && value > 250).length / size ** 2;
}, [...at, reach]);

/** The names that are seen, with the middle of each. */
const labels = (page) => page.locator('.labels .shown').evaluateAll((spans) => spans.map((span) => {
  const {x, y, width, height} = span.getBoundingClientRect();
  return {name: span.textContent, x: x + width / 2, y: y + height / 2, box: [x, y, x + width, y + height]};
}));

const apart = ([l, t, r, b], [left, top, right, bottom]) => left >= r || right <= l || top >= b || bottom <= t;

/** "48.3 × 3.2", "60 × 40 × 3" */
const sized = (cut) => ['outer_diameter_mm', 'height_mm', 'width_mm', 'wall_mm'].filter((name) => name in cut).map((name) => mm(cut[name])).join(' × ');

/** Compares the page of an open frame with the answer. */
async function agrees(page, name, {result, verdict, parts}, width) {
  assert.equal(await page.locator('#verdict .pill').innerText(), verdict.status, name);
  assert.equal(await canvas(page).getAttribute('data-members'), String(result.members.length), name);
  assert.deepEqual(await page.locator('#items [role=option] b').allInnerTexts(), result.members.map(({id}) => id), name);
  assert.match(await canvas(page).getAttribute('aria-label'), new RegExp(`${result.members.length} members, ${parts.length} different parts?, ${result.joints.length} joints?`), name);
  assert.equal(await page.locator('#tab-joints').innerText(), `Joints (${result.joints.length})`, name);
  const rows = await page.locator('#table-cut_list tbody tr').evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  assert.deepEqual(rows, result.cut_list.map((cut) => [cut.part, String(cut.count), sized(cut),
    ...[cut.long_mm, cut.blank_mm, cut.girth_mm, cut.mass_kg, cut.weld_mm].map(mm), cut.verdict]), name);
  const seen = await labels(page);
  const named = result.members.length <= 60;  // of more, those that are looked at
  assert.ok(seen.length > 0 === named && seen.every(({box}, i) => seen.slice(i + 1).every((other) => apart(box, other.box))), `${name}: names over names`);
  const scroll = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(scroll <= width, `${name}: the page is ${scroll} px wide`);
}

export const checks = {
  'a frame of many members is drawn in a few calls, and each member can be clicked': async ({browser, origin}) => {
    const page = await frame(browser, origin, 'truss-of-19');
    const truss = example('truss-of-19');
    const members = [0, 1, 2, 3].flatMap((k) => truss.members.map((each) => {
      const moved = ([x, , z]) => [x, 1000 * k, z];
      return {...each, id: `${each.id} ${k}`, start_mm: moved(each.start_mm), end_mm: moved(each.end_mm)};
    }));
    await page.evaluate(() => {
      window.calls = 0;
      for (const name of ['drawElements', 'drawArrays', 'drawElementsInstanced', 'drawArraysInstanced']) {
        const draw = WebGL2RenderingContext.prototype[name];
        WebGL2RenderingContext.prototype[name] = function (...given) {
          window.calls += 1;
          return draw.apply(this, given);
        };
      }
    });
    const body = JSON.stringify({...truss, members});
    await then(page, () => page.locator('#job-file').setInputFiles({name: 'many.json', mimeType: 'application/json', buffer: Buffer.from(body)}));
    await pixels(page);
    assert.equal(await canvas(page).getAttribute('data-members'), '76');
    const calls = await page.evaluate(async () => {
      window.calls = 0;
      document.querySelector('.canvas canvas').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}));
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      return window.calls;
    });
    assert.ok(calls > 0 && calls <= 12, `${calls} calls for two pictures`);
    await pixels(page);
    await choose(page, 0);
    const seen = await lit(page);
    assert.ok(seen.count > 20, 'the chosen member is lit');
    const box = await canvas(page).boundingBox();
    await page.locator('#items').press('Escape');
    await page.mouse.click(box.x + seen.x * box.width, box.y + seen.y * box.height);
    assert.match(await page.locator('.facts h3').innerText(), new RegExp(`^${members[0].id}`));
    clean(page);
    await page.context().close();
  },

  // One view for each example, because a view takes 2 s; the other kind follows with the next example.
  'lists, cut list and picture tell of the members that the answer has, wide and light, or narrow and dark': async ({browser, origin, service}) => {
    assert.ok(names.length >= 6);
    const page = await open(browser, origin, undefined, {height: 844});
    await answered(page);
    const views = [[1280, 'light'], [390, 'dark']];
    for (const [i, name] of names.entries()) {
      const answer = await answerTo(service, example(name));
      await then(page, () => page.evaluate((to) => {
        location.hash = to;
      }, `#/frames/${name}`));
      const [width, theme] = views[i % 2];
      await page.setViewportSize({width, height: 844});
      await page.emulateMedia({colorScheme: theme});
      await page.locator(`:root[data-theme=${theme}]`).waitFor();
      await pixels(page);
      await agrees(page, name, answer, width);
    }
    clean(page);
    await page.context().close();
  },

  'every member lights up where it stands': async ({browser, origin, service}) => {
    for (const name of ['roll-cage-of-12', 'jacket-node-with-set-in-stubs']) {
      const page = await frame(browser, origin, name);
      assert.equal((await lit(page)).count, 0, 'before anything is chosen');
      for (let i = 0; i < example(name).members.length; ++i) {
        await choose(page, i);
        assert.ok((await lit(page)).count > 100, `${name}, member ${i}`);
      }
      await page.context().close();
    }
    // The posts of a truss follow one another, evenly but for the perspective.
    const page = await frame(browser, origin, 'truss-of-19');
    const {members} = (await answerTo(service, example('truss-of-19'))).result;
    const posts = members.flatMap(({id}, i) => (/^P/.test(id) ? [i] : []));
    const places = [];
    for (const i of posts) {
      await choose(page, i);
      places.push((await lit(page)).x);
    }
    const steps = places.slice(1).map((x, i) => x - places[i]);
    assert.ok(posts.length === 9 && Math.min(...steps) > 0.05 && Math.max(...steps) < 1.4 * Math.min(...steps), `posts at ${places}`);
    clean(page);
    await page.context().close();
  },

  'a member is chosen in the picture, where its name stands, and another by the keyboard': async ({browser, origin}) => {
    for (const [width, theme] of [[1280, 'light'], [390, 'dark']]) {
      const page = await frame(browser, origin, 'roll-cage-of-12', {width, height: 844, theme});
      await canvas(page).scrollIntoViewIfNeeded();
      const seen = await labels(page);
      assert.ok(seen.length >= (width > 1000 ? 9 : 5), `${seen.length} names`);
      for (const {name, x, y} of seen) {
        await page.mouse.click(x, y);
        assert.equal((await page.locator('.facts h3').innerText()).split('\n')[0].trim(), name);
        assert.equal(await page.locator('#items [aria-selected=true] b').innerText(), name);
      }
      const corner = await canvas(page).boundingBox();
      await page.mouse.click(corner.x + corner.width - 5, corner.y + 60);
      assert.match(await facts(page), /^Choose one/);
      const list = page.locator('#items');
      await list.focus();
      for (const key of ['ArrowDown', 'ArrowDown', 'ArrowUp', 'End']) await page.keyboard.press(key);
      const last = example('roll-cage-of-12').members.length - 1;
      assert.equal(await list.getAttribute('aria-activedescendant'), `item-${last}`);
      assert.ok((await facts(page)).includes('back right'));
      await page.keyboard.press('Escape');
      assert.match(await facts(page), /^Choose one/);
      clean(page);
      await page.context().close();
    }
  },

  'where one clicks is what one sees': async ({browser, origin}) => {
    for (const name of ['jacket-node-with-set-in-stubs', 'k-node-with-plate-and-square-brace']) {
      const page = await frame(browser, origin, name);
      const box = await canvas(page).boundingBox();
      const places = [];
      for (let i = 0; i < 14; ++i) for (let j = 0; j < 14; ++j) places.push([0.02 + 0.96 * i / 13, 0.12 + 0.8 * j / 13]);
      const shares = await Promise.all(places.map(async (at) => [await solidAt(page, at, 3), await solidAt(page, at, 12)]));
      const within = places.filter((_, i) => shares[i][0] === 1);
      const beside = places.filter((_, i) => shares[i][1] === 0);
      assert.ok(within.length > 20 && beside.length > 20, `${name}: ${within.length} places on it, ${beside.length} beside it`);
      for (const at of beside) {
        await page.mouse.click(box.x + at[0] * box.width, box.y + at[1] * box.height);
        assert.match(await facts(page), /^Choose one/, `${name}: nothing is at ${at}`);
      }
      for (const at of within) {
        await page.mouse.click(box.x + at[0] * box.width, box.y + at[1] * box.height);
        assert.ok(await litAt(page, at) > 0.3, `${name}: at ${at} stands no ${await facts(page)}`);  // at an edge about half
        await page.keyboard.press('Escape');
      }
      clean(page);
      await page.context().close();
    }
  },

  'a member tells its part, which opens as the answer that the cut list names': async ({browser, origin, service}) => {
    const name = 'roll-cage-of-12';
    const {result, parts, warnings} = await answerTo(service, example(name));
    const page = await frame(browser, origin, name);
    const i = result.members.findIndex(({id}) => id === 'pillar left');
    await choose(page, i);
    const cut = result.cut_list.find(({part}) => part === result.members[i].part);
    assert.equal(await figure(page, 'Tip to tip'), `${mm(cut.long_mm)} mm`);
    assert.equal(await figure(page, 'Mass'), `${mm(cut.mass_kg)} kg`);
    assert.match(await facts(page), /pillar left\s*review/, 'the frame warns of it');
    assert.match(await facts(page), /Its own verdict: ok\./);
    const own = warnings.filter(({pointer}) => pointer.startsWith(`/members/${i}/`));
    assert.ok(own.length > 0);
    assert.equal(await page.locator('.facts li').count(), own.length);
    await then(page, () => page.locator('#open-item').click());
    assert.match(page.url(), /#\/frames|#\/parts/);
    assert.equal(await page.locator('#verdict .pill').innerText(), 'ok');
    await page.locator('#tab-json').click();
    const shown = await page.locator('#answer-json').innerText();
    assert.ok(shown.includes('"endpoint": "parts"') && shown.includes(cut.result_sha256), 'the part’s own answer');
    assert.deepEqual(JSON.parse(await page.locator('#request-json').innerText()), parts.find(({part}) => part === cut.part).answer.request);
    await page.waitForURL(/#\/parts\/~/);
    await then(page, () => page.goBack());
    assert.match(page.url(), new RegExp(`#/frames/${name}\\?.*item=${i}`));
    assert.match(await facts(page), /^pillar left/, 'what was chosen is so again');
    clean(page);
    await page.context().close();
  },

  'a joint tells how its two are joined, lights both and leads to them': async ({browser, origin, service}) => {
    const name = 'jacket-node-with-set-in-stubs';
    const {result} = await answerTo(service, example(name));
    const page = await frame(browser, origin, name);
    await page.locator('#tab-joints').click();
    for (const [j, joint] of result.joints.entries()) {
      await choose(page, result.members.length + j);
      assert.equal(await figure(page, 'Gap'), `${mm(joint.gap_mm)} mm`);
      assert.equal(await figure(page, 'Weld length'), `${mm(joint.weld_mm)} mm`);
      assert.equal(await figure(page, 'Least gap'), `${mm(joint.fit_up.least_mm)} mm`);
      assert.equal(await figure(page, 'Widest root gap'), `${mm(joint.fit_up.greatest_root_mm)} mm`);
      assert.deepEqual(await page.locator('.labels .chosen').allInnerTexts(), [joint.branch, joint.chord].sort((a, b) =>
        result.members.findIndex(({id}) => id === a) - result.members.findIndex(({id}) => id === b)));
    }
    const {branch} = result.joints[0];
    await choose(page, result.members.length);
    await page.locator('.facts .offers button', {hasText: branch}).click();
    assert.equal((await page.locator('.facts h3').innerText()).split('\n')[0].trim(), branch);
    assert.equal(await page.locator('#tab-members').getAttribute('aria-selected'), 'true');
    await page.locator('.facts .offers button').first().click();
    assert.match(await facts(page), new RegExp(`^${branch} in leg`));
    clean(page);
    await page.context().close();
  },

  'a joint is chosen in the picture, by its dot, to its fit-up': async ({browser, origin, service}) => {
    for (const [name, size, least] of [['jacket-node-with-set-in-stubs', {}, 3], ['roll-cage-of-12', {width: 390, height: 844, theme: 'dark'}, 5]]) {
      const {result} = await answerTo(service, example(name));
      const page = await frame(browser, origin, name, size);
      await canvas(page).scrollIntoViewIfNeeded();
      const box = await canvas(page).boundingBox();
      const dots = await page.locator('.dots .shown').evaluateAll((all) => all.map((dot) => {
        const {x, y, width, height} = dot.getBoundingClientRect();
        return {item: Number(dot.dataset.item), x: x + width / 2, y: y + height / 2};
      }));
      assert.ok(dots.length >= least, `${name}: ${dots.length} dots`);
      for (const {item, x, y} of dots.slice(0, 4)) {
        // nothing: names move to the selection, over dots
        await page.mouse.click(box.x + box.width - 5, box.y + 60);
        await pixels(page);
        await page.mouse.click(x, y);
        const {branch, chord} = result.joints[item - result.members.length];
        const told = (await page.locator('.facts h3').innerText()).split('\n')[0].trim();
        assert.ok(told.startsWith(`${branch} `) && told.endsWith(` ${chord}`), `${told} is not ${branch} and ${chord}`);
        await page.mouse.move(box.x + box.width - 5, box.y + 60);
        await pixels(page);
        // Next to a bend the cut end is off the axis on which the dot lies.
        const round = [7, 14].flatMap((far) => Array.from({length: 16}, (_, i) => [x - box.x + far * Math.cos(i * Math.PI / 8), y - box.y + far * Math.sin(i * Math.PI / 8)]));
        const shares = await Promise.all(round.map(([u, v]) => litAt(page, [u / box.width, v / box.height])));
        assert.ok(Math.max(...shares) > 0.3, `${told} is not where its dot is`);
        assert.equal(await page.locator('#tab-joints').getAttribute('aria-selected'), 'true');
      }
      clean(page);
      await page.context().close();
    }
  },

  'a part lights all its members': async ({browser, origin, service}) => {
    const name = 'truss-of-19';
    const {result} = await answerTo(service, example(name));
    const page = await frame(browser, origin, name);
    await page.locator('#tab-parts').click();
    const last = result.members.length + result.joints.length;
    for (const [k, cut] of result.cut_list.entries()) {
      await choose(page, last + k);
      assert.equal((await page.locator('.facts h3').innerText()).split('\n')[0].trim(), cut.part);
      assert.deepEqual(await page.locator('.facts .offers button').allInnerTexts(), cut.members);
      assert.deepEqual(await page.locator('.labels .chosen').allInnerTexts(), cut.members);
    }
    clean(page);
    await page.context().close();
  },

  'a member without a part stands where it would, and says why': async ({browser, origin}) => {
    const page = await frame(browser, origin, 'truss-of-19');
    await page.route('**/v1/frames', async (route) => {
      const reply = await route.fetch();
      const answer = await reply.json();
      const {part, canonical_sha256, answer: made} = answer.parts[0];
      const issue = {code: 'no_contact', pointer: '/ends/start/cutters/0', got: null, limit: null, unit: '', hint: 'no partner here'};
      answer.parts[0] = {part, canonical_sha256, request: made.request, problem: {code: 'no_contact', errors: [issue]}};
      answer.result.cut_list[0].verdict = 'none';
      for (const key of ['long_mm', 'blank_mm', 'mass_kg', 'weld_mm', 'result_sha256']) delete answer.result.cut_list[0][key];
      delete answer.result.members[0].frame;
      await route.fulfill({response: reply, json: answer});
    });
    await page.reload();
    await answered(page);
    await pixels(page);
    assert.equal(await canvas(page).getAttribute('data-members'), '19');
    await choose(page, 0);
    assert.match(await facts(page), /It cannot be cut as requested\.[^]*no partner here/i);
    assert.ok((await lit(page)).count > 100);
    assert.equal(await page.locator('#open-item').innerText(), 'Open its request');
    clean(page);
    await page.context().close();
  },

  'a large frame names what is pointed at and what is chosen': async ({browser, origin}) => {
    const body = example('truss-of-19');
    const members = [0, 1, 2, 3].flatMap((k) => body.members.map((member) => ({...structuredClone(member), id: `${member.id}-${k}`,
      start_mm: member.start_mm.map((v, axis) => (axis === 1 ? v + 600 * k : v)), end_mm: member.end_mm.map((v, axis) => (axis === 1 ? v + 600 * k : v))})));
    const page = await frame(browser, origin, 'truss-of-19');
    await page.route('**/v1/frames', (route) => route.continue({postData: JSON.stringify({...body, members})}));
    await page.reload();
    await answered(page);
    await pixels(page);
    assert.equal(await canvas(page).getAttribute('data-members'), String(members.length));
    assert.deepEqual(await labels(page), []);
    await choose(page, 40);
    await page.locator('#item-41').hover();
    await pixels(page);
    assert.deepEqual((await labels(page)).map(({name}) => name).sort(), [members[40].id, members[41].id].sort());
    clean(page);
    await page.context().close();
  },

  'the plates of a frame are drawn, listed and lead to their members': async ({browser, origin, service}) => {
    const body = example('post-on-base-plate');
    const {result} = await answerTo(service, body);
    const page = await frame(browser, origin, 'post-on-base-plate');
    const drawn = () => page.evaluate(() => document.querySelector('.canvas canvas').dataset.plates);
    assert.equal(await drawn(), String(body.plates.length));
    await page.getByRole('tab', {name: `Plates (${result.plates.length})`}).click();
    const first = body.members.length + result.joints.length + result.cut_list.length;
    await choose(page, first);
    assert.equal(await figure(page, 'Thickness'), `${result.plates[0].thickness_mm} mm`);
    assert.ok((await lit(page)).count > 100, 'the members on it are lit');
    const leads = await page.locator('.facts button').allInnerTexts();
    assert.deepEqual(leads.filter((name) => /^P/.test(name)), ['P1', 'P2']);
    await page.getByRole('tab', {name: 'Table'}).click();
    assert.match(await page.locator('body').innerText(), /250 × 250 × 20/);
    clean(page);
    await page.context().close();
  },
};
