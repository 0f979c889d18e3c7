import {strict as assert} from 'node:assert';
import {readFile} from 'node:fs/promises';
import {deflateRawSync} from 'node:zlib';
import {answered, open} from '../browser.mjs';

/** Every format that the contract lists for an endpoint, saved from the page: the bytes the service answers. */
async function downloads({browser, origin, service}, endpoint, name) {
  const contract = JSON.parse((await service.ask('/openapi.json', {method: 'GET'})).text);
  const offered = Object.keys(contract.paths[`/v1/${endpoint}`].post.responses['200'].content);
  const body = await readFile(new URL(`../../../examples/${endpoint}/${name}.json`, import.meta.url));
  const answer = await service.ask(`/v1/${endpoint}`, {body, headers: {Accept: 'application/json'}});
  const hash = JSON.parse(answer.body).job.input_sha256.slice(0, 8);
  const page = await open(browser, origin, `#/${endpoint}/${name}?tab=downloads`);
  await answered(page);
  const buttons = await page.locator('#panel [data-media]').all();
  const media = await Promise.all(buttons.map((button) => button.getAttribute('data-media')));
  assert.deepEqual([...new Set(media)].sort(), offered.sort());
  for (const [i, button] of buttons.entries()) {
    const view = await button.getAttribute('data-view');
    await page.waitForTimeout(150);  // Chromium drops downloads beyond a burst of ten a second
    const [download] = await Promise.all([page.waitForEvent('download', {timeout: 15000}), button.click()])
      .catch(async () => assert.fail(`no download of ${media[i]} ${view}: ${await page.locator('#panel [role=status]').innerText()}`));
    const saved = await readFile(await download.path());
    const query = new URLSearchParams(view ? {view} : {});
    const options = contract.paths[`/v1/${endpoint}`].post.responses['200'].content[media[i]]['x-options'] ?? [];
    if (options.includes('speed_mm_min') && !options.includes('files')) query.set('speed_mm_min', '600');
    const {status, body: bytes} = await service.ask(`/v1/${endpoint}?${query}`, {body, headers: {Accept: media[i]}});
    assert.equal(status, 200, `${media[i]} ${view}`);
    // Lines come as they are done, in whatever order that is.
    const sorted = (/** @type {Buffer} */ lines) => (media[i] === 'application/x-ndjson' ? Buffer.from(lines.toString().split('\n').sort().join('\n')) : lines);
    assert.ok(saved.length > 100 && sorted(saved).equals(sorted(bytes)), `${media[i]} ${view}: ${saved.length} bytes saved, ${bytes.length} answered`);
    const reference = JSON.parse(body).reference;
    const words = [reference?.order, reference?.part].filter(Boolean).join('-').replace(/\s+/g, '_') || name;
    assert.equal(download.suggestedFilename().replace(/\.[a-z0-9]{2,6}$/, ''), [words, view, hash].filter(Boolean).join('-'));
  }
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
      await page.waitForTimeout(150);
      const [download] = await Promise.all([page.waitForEvent('download', {timeout: 15000}), page.locator(`#panel [data-media="${media}"]`).first().click()]);
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
  for (const name of ['work-order', 'dxf', 'step', 'csv']) await page.locator(`#panel input[data-option=files][value="${name}"]`).uncheck();
  for (const query of ['files=nc1', 'files=nc1,gcode&speed_mm_min=600']) {
    await page.locator('#panel input[data-option=files][value=gcode]').setChecked(query.includes('gcode'));
    const [download] = await Promise.all([page.waitForEvent('download', {timeout: 15000}), page.locator('#panel [data-media="application/zip"]').click()]);
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

const jobs = {
  'bevel-tables': 'source-000-table-1', 'holes': 'set-in-branch', 'pulse-schedules': 'square-cut-from-a-bare-contour',
  'feed-curves': 'cut-off-194-mm-whole-cycle', 'grooves': 'case-a-right-angle', 'frames': 'jacket-node-with-set-in-stubs',
};
export const checks = {
  ...Object.fromEntries(Object.entries(jobs).map(([endpoint, name]) => [endpoint, (given) => downloads(given, endpoint, name)])),
  'named by reference and input': named,
  'a packet of a frame': packet,
};

