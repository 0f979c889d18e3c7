// The console in Chinese and in English: chosen by the browser or by the switch, complete, and within its places.
import {strict as assert} from 'node:assert';
import {deflateRawSync} from 'node:zlib';
import {answered, faint, formed, openPlain, then} from '../browser.mjs';
import {barred, unfolded, unseen} from '../seen.mjs';

const field = (page, pointer) => page.locator(`#form [data-pointer="${pointer}"]`);
const verdict = (page) => page.locator('#verdict').innerText();
const inChinese = {locale: 'zh-CN'};
const han = /\p{Script=Han}/u;

/** Presses the switch as a reader without a mouse does. */
async function turn(page) {
  await page.locator('#language').focus();
  await then(page, () => page.keyboard.press('Enter'));
}

/** Returns texts of the page that are only English, except for names of jobs and of formats, and the service's own words. */
const islands = (page) => page.evaluate(async () => {
  const names = new Set();
  const collect = (value) => {
    if (typeof value === 'string') names.add(value);
    else if (value && typeof value === 'object') Object.values(value).forEach(collect);
  };
  collect((await (await fetch('/v1/examples')).json()).examples.map(({body}) => body));
  const own = 'input, textarea, option, pre, code, script, [lang=en], .brand, .labels, .unit, .listing';
  const known = /^(tubecut \d.*|[0-9a-f]{12,}( …)?|H\d+.*|.*\.\d+( far)?|\(.*\))$/;
  const formats = /\b(API|JSON|CAD|SVG|PDF|DXF|DSTV|STEP|STL|CBOR|CSV|G-code|glTF|NDJSON|IEC|ST|zip|mm|kg|min|ms|rad|in|deg|LinuxCNC|QtPlasmaC|NPS|SCH|CHS|SHS|RHS|HSS|EN)\b/g;
  const found = new Set();
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const text = node.data.trim();
    if (!node.parentElement?.checkVisibility() || node.parentElement.closest(own) || /\p{Script=Han}/u.test(text)) continue;
    if (names.has(text) || known.test(text) || !/[A-Za-z]{3}/.test(text.replace(formats, ''))) continue;
    found.add(text);
  }
  return [...found];
});

export const checks = {
  'a Chinese browser gets a Chinese page, and an error is said with its value': async ({browser, origin}) => {
    const page = await openPlain(browser, origin, undefined, inChinese);
    await answered(page);
    assert.equal(await page.locator('html').getAttribute('lang'), 'zh-CN');
    assert.equal(await page.title(), '切割与坡口 – tubecut');
    assert.match(await verdict(page), /合格\s*可以切割。 B 从 18\.7° 到 72\.6°，割炬限值 80°。/);
    assert.equal(await page.locator('#tab-proof').innerText(), '校验');
    await then(page, () => field(page, '/cutters/1/inclination_deg').fill('200'));
    const said = '数值超出允许范围（给定值 200°，限值 180°）。请输入限值以内的数值。';
    assert.match(await verdict(page), /被拒绝/);
    assert.ok((await verdict(page)).includes(`相贯管 2，夹角`) && (await verdict(page)).includes(said), await verdict(page));
    const complaint = page.locator('#form p.complaint');
    assert.ok((await complaint.innerText()).startsWith(said), await complaint.innerText());
    const original = complaint.locator('.original');
    assert.equal(await original.getAttribute('lang'), 'en');
    assert.match(await original.innerText(), /180°/);
    const [above, below] = await Promise.all([complaint.boundingBox(), original.boundingBox()]);
    assert.ok(below.y > above.y + 10, 'the service’s own words are under the Chinese ones');
    assert.deepEqual(page.faults, []);
    assert.deepEqual(page.strangers, []);
    await page.context().close();
  },

  'the switch turns the language by the keyboard, is remembered, and keeps job, draft and undo': async ({browser, origin}) => {
    const page = await openPlain(browser, origin, undefined, inChinese);
    await answered(page);
    await then(page, () => field(page, '/target/outer_diameter_mm').fill('75.5'));
    await then(page, () => field(page, '/target/wall_mm').fill('40'));
    assert.match(await verdict(page), /被拒绝/);
    await turn(page);
    assert.equal(await page.locator('html').getAttribute('lang'), 'en');
    assert.equal(await page.title(), 'Cut and bevel – tubecut');
    assert.match(await verdict(page), /refused/);
    assert.deepEqual((await page.locator('body').innerText()).split('\n').filter((line) => han.test(line)), ['中文'], 'English throughout');
    assert.equal(await field(page, '/target/outer_diameter_mm').inputValue(), '75.5');
    assert.equal(await field(page, '/target/wall_mm').inputValue(), '40');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'language', 'the focus stays');
    await then(page, () => page.locator('#undo').click());
    assert.equal(await field(page, '/target/wall_mm').inputValue(), '5');
    assert.match(await verdict(page), /Cuttable/);
    await page.waitForURL(/~/);
    await page.reload();
    await answered(page);
    assert.match(await verdict(page), /Cuttable/, `English is remembered, though the browser is Chinese: ${await verdict(page)}`);
    assert.equal(await field(page, '/target/outer_diameter_mm').inputValue(), '75.5');
    await turn(page);
    assert.match(await verdict(page), /可以切割/);
    assert.equal(await field(page, '/target/outer_diameter_mm').inputValue(), '75.5');
    await page.locator('.brand').click();
    await page.locator('#recent').waitFor();
    assert.match(await page.locator('#recent').innerText(), /最近的任务[^]*切割与坡口/);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'the English page loads no Chinese texts, the Chinese one loads them once': async ({browser, origin}) => {
    for (const [locale, parts] of [['en-US', 0], ['zh-CN', 1]]) {
      const page = await openPlain(browser, origin, undefined, {locale});
      await answered(page);
      const scripts = await page.evaluate(async () => {
        const names = performance.getEntriesByType('resource').map(({name}) => name).filter((name) => /\/assets\/[^/]+\.js$/.test(name));
        return Promise.all(names.map(async (name) => (await (await fetch(name)).text())));
      });
      assert.ok(scripts.length > 1);
      const chinese = scripts.filter((script) => (script.match(/\p{Script=Han}/gu) ?? []).length > 1000);
      assert.equal(chinese.length, parts, locale);
      await page.context().close();
    }
  },

  'everything is Chinese, readable and in its place, on a desk and on a phone, light and dark': async ({browser, origin}) => {
    const wrong = [];
    const jobs = ['', 'bevel-tables/source-000-table-1', 'nodes/k-joint-with-tables', 'holes/set-in-branch', 'parts/chord-with-holes', 'frames/roll-cage-of-12',
      'pulse-schedules/table-1-on-the-five-axis-cutter', 'replays/square-cut', 'feed-curves/cut-off-194-mm-whole-cycle', 'grooves/case-a-right-angle', 'mill-paths/case-a-end-up'];
    const axed = new Set(['', 'bevel-tables/source-000-table-1', 'frames/roll-cage-of-12', 'mill-paths/case-a-end-up']); // of each kind of page one
    for (const [width, theme] of [[1280, 'light'], [390, 'dark']]) {
      const page = await openPlain(browser, origin, `#/${jobs[0]}`, {...inChinese, width, theme});
      await answered(page);
      for (const job of jobs) {
        if (job) {
          await then(page, () => page.evaluate((to) => {
            location.hash = to;
          }, `#/${job}`));
          await formed(page);
          await unfolded(page);
        }
        const faults = [...await unseen(page), ...await faint(page), ...await islands(page), ...(axed.has(job) ? await barred(page) : [])];
        wrong.push(...faults.map((fault) => `${job || 'start'} at ${width}: ${fault}`));
      }
      wrong.push(...page.faults);
      await page.context().close();
    }
    assert.deepEqual(wrong, []);
  },

  'files, downloads and paper are said in Chinese; what goes to other programs stays as it is': async ({browser, origin}) => {
    const page = await openPlain(browser, origin, '#/parts/chord-with-holes?tab=downloads', inChinese);
    await answered(page);
    assert.match(await page.locator('#panel').innerText(), /文件：零件[^]*机床程序[^]*图纸与样板/);
    for (const purpose of ['drawing', 'model', 'data', 'program']) {
      await page.locator(`input[value=${purpose}]`).check();
      assert.deepEqual(await islands(page), [], purpose);
    }
    await page.locator('#tab-json').click();
    const request = JSON.parse(await page.locator('#request-json').innerText());
    assert.ok(!han.test(JSON.stringify(request)) && 'members' in request);
    await page.evaluate(() => {
      globalThis.print = () => {
        document.body.dataset.printed = document.querySelector('#paper').textContent;
      };
    });
    await page.locator('#print').click();
    await page.locator('body[data-printed]').waitFor();
    assert.match(await page.evaluate(() => document.body.dataset.printed), /tubecut: 零件，开有两个相贯孔的主管.*任务/);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'work orders and templates are shown and printed with Chinese captions, and names stay as they are': async ({browser, origin}) => {
    const page = await openPlain(browser, origin, '#/parts/chord-with-holes?tab=downloads', inChinese);
    await answered(page);
    await page.evaluate(() => {
      globalThis.print = () => {
        document.body.dataset.printed = [...document.body.children].filter((each) => each.checkVisibility()).map((each) => each.textContent).join();
      };
    });
    for (const example of ['parts/base-post', 'parts/table-1-with-a-square-far-end', 'parts/gate-rail-of-60x40-mitred']) {
      await then(page, () => page.evaluate((to) => {
        location.hash = to;
      }, `#/${example}?tab=downloads`));
      await page.locator('input[value=drawing]').check();
      assert.match(await page.locator('#panel').innerText(), /下载的文件（含 PDF）为英文/);
      for (const view of ['template', 'work_order']) {
        await page.locator(`[data-shows=${view}]`).click();
        await page.locator('#drawing', {hasText: view === 'template' ? '展开样板' : '加工单'}).locator('svg').waitFor();
        assert.deepEqual(await islands(page), [], `${example} ${view}`);
      }
    }
    await page.locator('#print-drawing').click();
    const printed = await page.evaluate(() => document.body.dataset.printed);
    assert.match(printed, /加工单[^]*检验尺寸/);
    assert.ok(!printed.includes('新建'), 'nothing but the drawing');
    assert.equal(await page.locator('#sheet').count(), 0);
    await page.locator('#language').click();
    await page.locator('#drawing text', {hasText: 'Check dimensions'}).waitFor();
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'a name in a drawing is a text, whatever is in it': async ({browser, origin}) => {
    const name = '<img src=x onerror=alert(1)>';
    const body = {target: {id: name, outer_diameter_mm: 60, wall_mm: 4, length_mm: 500}, ends: {start: {square_at_mm: 0}, finish: {square_at_mm: 0}}, kerf_mm: 1.5, reference: {order: 'wall'}};
    const page = await openPlain(browser, origin, `#/parts/~${deflateRawSync(JSON.stringify(body)).toString('base64url')}?tab=downloads`, inChinese);
    await answered(page);
    await page.locator('input[value=drawing]').check();
    await page.locator('[data-shows=work_order]').click();
    await page.locator('#drawing svg').waitFor();
    assert.equal(await page.locator('#drawing text', {hasText: name}).count() > 0, true);
    assert.equal(await page.locator('#drawing img, #drawing image, #drawing script, #drawing foreignObject').count(), 0);
    assert.ok((await page.locator('#drawing text').allTextContents()).includes('wall'), 'the order’s name is not translated');
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },
};
