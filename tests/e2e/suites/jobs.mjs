// A job is never lost: drafts, files, Back, and a service that goes away.
import {strict as assert} from 'node:assert';
import {execFileSync} from 'node:child_process';
import {readFile} from 'node:fs/promises';
import {answered, faint, open, then} from '../browser.mjs';
import {barred, unseen} from '../seen.mjs';

const example = async (name) => JSON.parse(await readFile(new URL(`../../../examples/${name}.json`, import.meta.url)));
const field = (page, pointer) => page.locator(`[data-pointer="${pointer}"]`);
const endpoint = (page) => page.locator('#endpoints [aria-current]').getAttribute('data-endpoint');
const opened = (page, name, text) => page.locator('#job-file').setInputFiles({name, mimeType: 'application/json', buffer: Buffer.from(text)});
async function request(page) {
  const tab = page.locator('#tab-json');
  if (await tab.getAttribute('aria-selected') !== 'true') await tab.click();
  return JSON.parse(await page.locator('#request-json').innerText());
}
async function saved(page) {
  const [file] = await Promise.all([page.waitForEvent('download'), page.locator('#save-job').click()]);
  return {name: file.suggestedFilename(), text: await readFile(await file.path(), 'utf8')};
}

/** Tubes that stand apart, with names and places that no compression makes short: more than an address holds. */
const many = () => {
  let seed = 7;
  const random = () => {
    seed = (1103515245 * seed + 12345) % 2147483648;
    return seed / 2147483648;
  };
  const members = Array.from({length: 330}, (_, i) => {
    const [x, y] = [300 * (i % 25), 300 * Math.floor(i / 25)];
    const at = (z) => [x + 50 * random(), y + 50 * random(), z + 100 * random()].map((v) => Number(v.toFixed(5)));
    return {id: Array.from({length: 6}, () => Math.floor(1e15 * random()).toString(36)).join('-'), start_mm: at(0), end_mm: at(1000), outer_diameter_mm: 60.3, wall_mm: 4};
  });
  return {members};
};

export const checks = {
  'a change is kept though the page is left at once': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/bevel-tables/source-000-table-1');
    await answered(page);
    const wall = page.locator('[data-pointer="/target/wall_mm"]');
    await then(page, () => wall.fill('6'));
    await page.waitForTimeout(600);  // its address has the job now
    await Promise.all([page.waitForNavigation(), wall.evaluate((input) => {
      input.value = '7';
      input.dispatchEvent(new Event('input', {bubbles: true}));
      location.reload();
    })]);
    await answered(page);
    assert.equal(await wall.inputValue(), '7');
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'a job is saved as a file and opened again, whatever it is': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    for (const [id, name] of [['parts', 'chord-with-holes'], ['grooves', 'case-a'], ['frames', 'truss-of-19']]) {
      const body = await example(`${id}/${name}`).catch(() => undefined);
      if (!body) continue;
      await then(page, () => opened(page, 'any name.json', JSON.stringify(body)));
      assert.equal(await endpoint(page), id);
      assert.deepEqual(await request(page), body);
      const file = await saved(page);
      assert.match(file.name, /\.json$/);
      assert.deepEqual(JSON.parse(file.text), body);
    }
    await page.locator('#tab-downloads').click();
    await opened(page, 'drawing.json', '{"colour": "red"}');
    await page.locator('#trouble', {hasText: 'drawing.json is not a job'}).waitFor();
    assert.equal(await endpoint(page), 'frames', 'the job that was there stays');
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'the start page leads to tasks, to examples with pictures, and back to recent jobs': async ({browser, origin}) => {
    const page = await open(browser, origin, '', {at: '/'});
    await answered(page);
    assert.equal(await page.locator('#start h1').count(), 1);
    assert.deepEqual(await page.locator('#start [data-task] h2').allInnerTexts(), ['A joint', 'A part', 'A frame', 'My machine']);
    assert.ok(await page.locator('#views').isHidden());
    assert.equal(await page.locator('#recent').count(), 0, 'nothing was done here yet');
    assert.ok(await page.locator('.examples svg line').count() > 30, 'the examples are drawn');
    const came = await page.evaluate(() => performance.getEntriesByType('resource').map(({name}) => name).filter((name) => /stage-/.test(name)));
    assert.deepEqual(came, [], 'without the 3D, which a job loads');
    assert.deepEqual([...await barred(page), ...await unseen(page), ...await faint(page)], []);
    await then(page, () => page.locator('[data-new=parts]').click());
    assert.equal(await endpoint(page), 'parts');
    await page.waitForURL(/#\/parts\//);  // before it, Back would leave the console
    await then(page, () => page.goBack());
    await then(page, () => page.locator('[data-task=part] .examples a').first().click());
    await then(page, () => page.locator('[data-pointer="/target/id"]').fill('<b>rail</b> 7'));
    await page.waitForURL(/#\/parts\/~/);
    await then(page, () => page.locator('.brand').click());
    const job = page.locator('#recent li');
    await job.nth(1).waitFor();
    assert.match(await job.first().innerText(), /Part: <b>rail<\/b> 7/, 'the newest is the first');
    await then(page, () => job.first().locator('a').click());
    assert.equal(await page.locator('[data-pointer="/target/id"]').inputValue(), '<b>rail</b> 7');
    await then(page, () => page.goBack());
    assert.ok(await page.locator('#start').isVisible());
    await then(page, () => page.locator('[data-task=frame] .examples a').first().click());
    assert.match(page.url(), /#\/frames\/roll-cage-of-12/);
    assert.ok(await page.locator('#start').isHidden());
    await then(page, () => page.locator('.brand').click());
    await page.setViewportSize({width: 390, height: 844});
    assert.deepEqual(await unseen(page), []);
    await page.locator('#recent .remove').first().click();
    assert.equal(await job.count(), 1);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'a part of a round tube becomes one of another shape, and a round one again': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/parts/base-post');
    await answered(page);
    const tube = page.locator('select[data-holds="/target"]');
    const shape = async (name) => {
      await then(page, () => tube.selectOption({label: name}));
      assert.match(await page.locator('#verdict .pill').innerText(), /ok|review/, name);
      assert.equal(await page.locator('#trouble').innerText(), '', name);
      return request(page);
    };
    const round = await request(page);
    // Cut-outs are placed by phi, which the others do not have, so they go first, and with them what their kind of part alone may state.
    const plain = async () => {
      for (const field of ['cutouts', 'accept', 'datum', 'seam_deg']) {
        const remover = page.locator(`[data-removes="/${field}"]`);
        if (await remover.count()) await then(page, () => remover.click());
      }
    };
    await plain();
    for (const [name, kind] of [['Rectangular tube · corner radius', 'rectangular_tube'], ['Flat oval tube', 'flat_oval_tube'], ['Rectangular tube · size', 'rectangular_tube']]) {
      const {target, ends, cutouts} = await shape(name);
      assert.equal(target.kind, kind);
      assert.equal(cutouts, undefined);
      assert.deepEqual(ends, round.ends);
      await page.locator('[data-adds="/holes"]').waitFor();
      await page.locator('[data-adds="/cutouts"]').waitFor();
      await page.locator('#tab-proof').click();
      assert.equal(await page.locator('#table-faces tbody tr').count(), 4);
    }
    await page.locator('[data-onward=files]').click();
    await page.locator('input[name=purpose][value=model]').check();
    assert.deepEqual(await page.locator('#panel [data-media]').evaluateAll((nodes) => [...new Set(nodes.map((node) => node.dataset.media))]), ['image/vnd.dxf', 'model/step', 'application/x-dstv']);
    const {target} = await shape('Round · outer diameter, wall');
    assert.equal(target.kind, 'round');
    await page.locator('[data-adds="/cutouts"]').waitFor();
    await opened(page, 'mixed.json', JSON.stringify({...round, target: {size: 'SHS 60x60x4 EN 10219', length_mm: 1200}}));
    await page.locator('#form .complaint').first().waitFor();
    await plain();
    assert.match(await page.locator('#verdict .pill').innerText(), /ok|review/);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'a DXF file goes into a cut-out with its lines': async ({browser, origin}) => {
    const page = await open(browser, origin, '#/parts/base-post');
    await answered(page);
    const drawing = (radius) => ['0', 'SECTION', '2', 'ENTITIES', '0', 'CIRCLE', '10', '0', '20', '0', '40', String(radius), '0', 'ENDSEC', '0', 'EOF', ''].join('\n');
    const cutouts = [{id: 'window', shape: {kind: 'dxf', dxf: drawing(8)}, at: {z_mm: 300, phi_deg: 0}}];
    await opened(page, 'window.json', JSON.stringify({...(await request(page)), cutouts}));
    const box = page.locator('#form textarea');
    await box.waitFor();
    assert.equal(await box.inputValue(), drawing(8));
    await then(page, () => page.locator('#form input[type=file]').setInputFiles({name: 'window.dxf', mimeType: 'image/vnd.dxf', buffer: Buffer.from(drawing(9))}));
    assert.equal((await request(page)).cutouts[0].shape.dxf, drawing(9));
    assert.match(await page.locator('#verdict .pill').innerText(), /ok|review/);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },

  'the request of a packet is opened': async ({browser, origin, service}) => {
    const body = await example('frames/truss-of-19');
    const {body: bytes} = await service.ask('/v1/frames?format=zip', {body: JSON.stringify(body)});
    const name = execFileSync('sh', ['-c', 'f=$(mktemp); cat > "$f"; echo "$f"'], {input: bytes, encoding: 'utf8'}).trim();
    const text = execFileSync('unzip', ['-p', name, 'request.json'], {encoding: 'utf8'});
    execFileSync('rm', [name]);
    const page = await open(browser, origin);
    await answered(page);
    await then(page, () => opened(page, 'request.json', text));
    assert.equal(await endpoint(page), 'frames');
    assert.match(await page.locator('#verdict .pill').innerText(), /ok|review/);
    await page.context().close();
  },

  'a job too long for a link outlives the page and comes back by Back': async ({browser, origin}) => {
    const body = {...await example('frames/truss-of-19'), members: many().members};
    delete body.joints;
    delete body.ends;
    const page = await open(browser, origin);
    await answered(page);
    await then(page, () => opened(page, 'field.json', JSON.stringify(body)));
    await page.waitForURL(/#\/frames\/@\w+$/);
    await then(page, () => field(page, '/kerf_mm').fill('2.5'));
    await page.waitForTimeout(400);
    await page.reload();
    await answered(page);
    assert.equal(await field(page, '/kerf_mm').inputValue(), '2.5', 'after a reload');
    assert.equal(JSON.parse((await saved(page)).text).members.length, 330);
    await page.locator('#share').click();
    await page.getByText('Too long: save the job').waitFor();
    await then(page, () => page.locator('#endpoints [data-endpoint=holes]').click());
    await page.waitForURL(/#\/holes/);
    await then(page, () => page.goBack());
    assert.equal(await endpoint(page), 'frames');
    assert.equal(await field(page, '/kerf_mm').inputValue(), '2.5', 'after Back');
    const hash = new URL(page.url()).hash;
    await page.context().close();

    const stranger = await open(browser, origin, hash);
    await answered(stranger);
    assert.match(await stranger.locator('#verdict').innerText(), /This job is not here/);
    await stranger.context().close();
  },

  'a service that comes back is asked again, without a hand': async ({browser, origin}) => {
    const page = await open(browser, origin);
    await answered(page);
    const away = (route) => route.abort();
    await page.context().route('**/v1/**', away);
    await then(page, () => field(page, '/target/wall_mm').fill('6'));
    assert.match(await page.locator('#verdict').innerText(), /cannot be reached/);
    await then(page, () => page.context().unroute('**/v1/**', away));
    assert.match(await page.locator('#verdict .pill').innerText(), /ok|review/);
    assert.equal(await field(page, '/target/wall_mm').inputValue(), '6');

    await page.context().route('**/v1/**', away);
    await page.goto(`${origin}/`);
    await page.reload();
    await page.getByText('The console could not start.').waitFor();
    await page.context().unroute('**/v1/**', away);
    await answered(page);
    await page.context().close();
  },
};
