import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {deflateRawSync} from 'node:zlib';
import {answered, openPlain as open} from '../browser.mjs';

const choose = (page, purpose) => page.locator(`#panel [name=purpose][value=${purpose}]`).check();

/** Every format that the contract lists for an endpoint, saved from the page: the bytes the service answers. */
async function downloads({browser, origin, service}, endpoint, name) {
  const contract = JSON.parse((await service.ask('/openapi.json', {method: 'GET'})).text);
  const offered = Object.keys(contract.paths[`/v1/${endpoint}`].post.responses['200'].content);
  const body = await readFile(new URL(`../../../examples/${endpoint}/${name}.json`, import.meta.url));
  const answer = await service.ask(`/v1/${endpoint}`, {body, headers: {Accept: 'application/json'}});
  const hash = JSON.parse(answer.body).job.input_sha256.slice(0, 8);
  const page = await open(browser, origin, `#/${endpoint}/${name}?tab=downloads`);
  await answered(page);
  const purposes = await page.locator('#panel [name=purpose]').evaluateAll((all) => all.map(({value}) => value));
  const media = [];
  for (const purpose of purposes) {
    await choose(page, purpose);
    for (const button of await page.locator('#panel [data-media]').all()) {
      const [type, view] = await Promise.all(['data-media', 'data-view'].map((name) => button.getAttribute(name)));
      media.push(type);
      await page.waitForTimeout(150);  // Chromium drops downloads beyond a burst of ten a second
      const [download] = await Promise.all([page.waitForEvent('download', {timeout: 60000}), button.click()])
        .catch(async () => assert.fail(`no download of ${type} ${view}: ${await page.locator('#panel [role=status]').innerText()}`));
      const saved = await readFile(await download.path());
      const query = new URLSearchParams(view ? {view} : {});
      const options = contract.paths[`/v1/${endpoint}`].post.responses['200'].content[type]['x-options'] ?? [];
      if (options.includes('speed_mm_min') && !options.includes('files')) query.set('speed_mm_min', '600');
      const {status, body: bytes} = await service.ask(`/v1/${endpoint}?${query}`, {body, headers: {Accept: type}});
      assert.equal(status, 200, `${type} ${view}`);
      // Lines come as they are done, in whatever order that is.
      const sorted = (/** @type {Buffer} */ lines) => (type === 'application/x-ndjson' ? Buffer.from(lines.toString().split('\n').sort().join('\n')) : lines);
      assert.ok(saved.length > 100 && sorted(saved).equals(sorted(bytes)), `${type} ${view}: ${saved.length} bytes saved, ${bytes.length} answered`);
      const reference = JSON.parse(body).reference;
      const words = [reference?.order, reference?.part].filter(Boolean).join('-').replace(/\s+/g, '_') || name;
      assert.equal(download.suggestedFilename().replace(/\.[a-z0-9]{2,6}$/, ''), [words, view, hash].filter(Boolean).join('-'));
    }
  }
  assert.deepEqual([...new Set(media)].sort(), offered.sort());
  assert.deepEqual(page.faults, []);
  await page.context().close();
}

/** Whatever an order and a part are called, the files of a job bear it, and of which input they are. */
async function named({browser, origin, service}) {
  const table1 = JSON.parse(await readFile(new URL('../../../examples/bevel-tables/source-000-table-1.json', import.meta.url)));
  const calls = [
    [{order: 'A-17', part: 'B 1/2'}, 'A-17-B_1_2'], [{part: 'Träger Ø60'}, 'Träger_Ø60'], [{order: '注文 7'}, '注文_7'], [{heat: 'H12'}, 'bevel-tables'],
  ];
  for (const [reference, words] of calls) {
    const body = {...table1, reference};
    const {job} = JSON.parse((await service.post('/v1/bevel-tables', body)).text);
    const link = deflateRawSync(JSON.stringify(body)).toString('base64url');
    const page = await open(browser, origin, `#/bevel-tables/~${link}?tab=downloads`);
    await answered(page);
    for (const [media, ending] of [['text/csv', 'csv'], ['application/x-dstv', 'nc1']]) {
      if (/注/.test(words) && ending === 'nc1') continue;  // refused: it is ASCII
      await choose(page, ending === 'csv' ? 'data' : 'model');
      await page.waitForTimeout(150);
      const [download] = await Promise.all([page.waitForEvent('download', {timeout: 60000}), page.locator(`#panel [data-media="${media}"]`).first().click()]);
      assert.equal(download.suggestedFilename(), `${words}-${job.input_sha256.slice(0, 8)}.${ending}`);
    }
    await page.context().close();
  }
}

/** A frame's packet with the ticked files; the settings of its programs go only with those. */
async function packet({browser, origin, service}) {
  const body = await readFile(new URL('../../../examples/frames/truss-of-19.json', import.meta.url));
  const page = await open(browser, origin, '#/frames/truss-of-19?tab=downloads');
  await answered(page);
  await choose(page, 'packet');
  for (const name of ['work-order', 'dxf', 'step', 'csv']) await page.locator(`#panel input[data-option=files][value="${name}"]`).uncheck();
  for (const query of ['files=nc1', 'files=nc1,gcode&speed_mm_min=600']) {
    await page.locator('#panel input[data-option=files][value=gcode]').setChecked(query.includes('gcode'));
    const [download] = await Promise.all([page.waitForEvent('download', {timeout: 60000}), page.locator('#panel [data-media="application/zip"]').click()]);
    const {status, body: bytes} = await service.ask(`/v1/frames?format=zip&${query}`, {body});
    assert.equal(status, 200);
    assert.ok((await readFile(await download.path())).equals(bytes), query);
    assert.match(download.suggestedFilename(), /^truss-of-19-[0-9a-f]{8}\.zip$/);
    await page.waitForTimeout(150);
  }
  assert.ok(await page.locator('#panel progress').isHidden());
  assert.deepEqual(page.faults, []);
  await page.context().close();
}

/** The machine program: only what applies is asked, all that is missing is marked at once, a process table fills it, and the choice is remembered. */
async function program({browser, origin, service}) {
  const name = 'table-1-with-a-square-far-end';
  const page = await open(browser, origin, `#/parts/${name}?tab=downloads`);
  await answered(page);
  await choose(page, 'program');
  const option = (of) => page.locator(`#panel [data-option=${of}]`);
  const button = page.locator('#panel [data-media="text/x-gcode"]');
  for (const hidden of ['pierce_height_mm', 'tab_mm', 'mark_speed_mm_min', 'material', 'dialect']) assert.equal(await option(hidden).count(), 0, hidden);
  await option('torch').selectOption('on');
  await option('speed_mm_min').fill('');
  await button.click();
  const wrong = page.locator('#panel [aria-invalid=true]');
  await wrong.nth(5).waitFor();
  const marked = await wrong.evaluateAll((all) => all.map((node) => [node.dataset.option, document.getElementById(node.getAttribute('aria-describedby'))?.textContent]));
  assert.deepEqual(marked.map(([of]) => of).sort(), ['cut_height_mm', 'lead_mm', 'pierce_delay_s', 'pierce_height_mm', 'pivot_length_mm', 'speed_mm_min']);
  assert.ok(marked.every(([, text]) => /\w/.test(text)));
  assert.ok(await wrong.first().evaluate((node) => node === document.activeElement));
  assert.equal(await page.locator('#panel [role=status]').innerText(), 'G-code: 6 fields are marked.');
  await option('machine').selectOption('five_axis_cutter');
  await option('material').selectOption('steel');
  const [download] = await Promise.all([page.waitForEvent('download', {timeout: 60000}), button.click()]);
  const body = await readFile(new URL(`../../../examples/parts/${name}.json`, import.meta.url));
  const {body: bytes} = await service.ask('/v1/parts?machine=five_axis_cutter&material=steel&torch=on&format=gcode', {body});
  assert.ok((await readFile(await download.path())).equals(bytes));
  assert.equal(await wrong.count(), 0);
  await page.reload();
  await answered(page);
  assert.ok(await page.locator('#panel [name=purpose][value=program]').isChecked());
  await option('material').waitFor();
  await option('machine').locator('option[value=five_axis_cutter]').waitFor({state: 'attached'});  // the list is fetched
  assert.equal(await option('machine').inputValue(), 'five_axis_cutter');
  assert.deepEqual(page.faults.filter((fault) => !/status of 400/.test(fault)), []);
  await page.context().close();
}

const jobs = {
  'bevel-tables': 'source-000-table-1', 'holes': 'set-in-branch', 'pulse-schedules': 'square-cut-from-a-bare-contour',
  'feed-curves': 'cut-off-194-mm-whole-cycle', 'grooves': 'case-a-right-angle', 'frames': 'jacket-node-with-set-in-stubs',
};
/** The independent checker, in the page: of the answer as it was sent, so its hashes hold too. */
async function secondOpinion({browser, origin}) {
  const page = await open(browser, origin, '#/bevel-tables/source-000-table-1');
  await answered(page);
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    await page.setViewportSize({width, height});
    await page.locator('#check-independently').click();
    await page.locator('#opinion [data-passed]').waitFor();
    assert.equal(await page.locator('#opinion [data-passed]').getAttribute('data-passed'), 'true', await page.locator('#opinion').innerText());
    const rows = await page.locator('#opinion tbody tr').evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.innerText)));
    for (const name of ['Input sha256', 'Result sha256', 'Request echo', 'Beam', 'Active partner', 'Length']) {
      assert.ok(rows.some(([first, state]) => first === name && state === 'ok'), `${name}: ${JSON.stringify(rows)}`);
    }
    await page.locator('#opinion > button').click();
    assert.equal(await page.locator('#opinion').count(), 0);
  }
  assert.deepEqual(page.faults, []);
  await page.context().close();
}

export const checks = {
  'the independent checker certifies the answer': secondOpinion,
  ...Object.fromEntries(Object.entries(jobs).map(([endpoint, name]) => [endpoint, (given) => downloads(given, endpoint, name)])),
  'named by reference and input': named,
  'a packet of a frame': packet,
  'a machine program': program,
};

