// A model of another program in the console: dropped or chosen, its frame shown and continued, the
// omitted items reported.
import {strict as assert} from 'node:assert';
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {bores, file, squareFaces} from '../../../clients/import/test/support/nc1_files.mjs';
import {shift, Step} from '../../../clients/import/test/support/step.mjs';
import {answered, answers, open, pixels, then} from '../browser.mjs';
import {barred} from '../seen.mjs';

const beside = (path) => readFileSync(new URL(`../../../${path}`, import.meta.url), 'utf8');
const spool = beside('clients/import/test/data/pipe-spool.pcf');
const heavy = /import_worker-|web-ifc/;

/** A chord with two braces and a square tube, in metres; and a plate, which is no tube. */
function ifc() {
  const step = new Step('IFC4');
  step.units('metre');
  const ring = (radius, wall) => step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', radius, wall);
  const run = (type, name, profile, [x, y, z], [dx, dy, dz], long) => {
    const direction = (d) => step.direction(d);
    const size = Math.hypot(dx, dy, dz);
    const axes = step.add('IFCAXIS2PLACEMENT3D', step.point([x, y, z]), direction([dx / size, dy / size, dz / size]), direction([0, 1, 0]));
    const solid = step.add('IFCEXTRUDEDAREASOLID', profile, axes, direction([0, 0, 1]), long);
    step.product(type, name, step.placement(shift(0, 0, 0)), step.body([solid]));
  };
  run('IFCBEAM', 'chord', ring(0.0603, 0.005), [-1, 0, 0], [1, 0, 0], 2);
  run('IFCMEMBER', 'left', ring(0.03015, 0.004), [-0.2, 0, 0], [-1, 0, 1], 1);
  run('IFCMEMBER', 'right', ring(0.03015, 0.004), [0.2, 0, 0], [1, 0, 1], 1);
  const square = step.add('IFCRECTANGLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', 0.1, 0.1, 0.005, '$', '$');
  run('IFCBEAM', 'box', square, [-1, 0.5, 0], [1, 0, 0], 2);
  run('IFCMEMBER', 'on the box', ring(0.03015, 0.004), [0, 0.5, 0.05], [0, 0, 1], 1);
  run('IFCPLATE', 'gusset', ring(0.03015, 0.004), [0, 0, 0], [0, 0, 1], 1);
  return step.text();
}

const clean = (page) => {
  assert.deepEqual(page.faults, [], 'errors in the browser');
  assert.deepEqual(page.strangers, [], 'requests to others');
};
const frames = async (browser, origin, size) => {
  const page = await open(browser, origin, '#/frames/truss-of-19', size);
  page.fetched = [];
  page.context().on('request', (request) => page.fetched.push(new URL(request.url()).pathname));
  await answered(page);
  await pixels(page);
  return page;
};
// Also the worker's requests, which the page's own list does not contain.
const fetched = (page) => page.fetched;
const request = async (page) => {
  await page.locator('#tab-json').click();
  return JSON.parse(await page.locator('#request-json').innerText());
};
const missed = (page) => page.locator('#not-understood li').allInnerTexts();

async function drop(page, name, text) {
  const data = await page.evaluateHandle(([file, content]) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([content], file));
    return transfer;
  }, [name, text]);
  await page.dispatchEvent('body', 'dragover', {dataTransfer: data});
  assert.ok(await page.evaluate(() => document.body.classList.contains('dropping')), 'the place to drop it is seen');
  await page.dispatchEvent('body', 'drop', {dataTransfer: data});
}
const choose = (page, name, text) => page.locator('#model-file').setInputFiles({name, mimeType: 'application/octet-stream', buffer: Buffer.from(text)});

async function dropsIfc({browser, origin}, width, theme) {
  const page = await frames(browser, origin, {width, height: 844, theme});
  assert.ok(!fetched(page).some((name) => heavy.test(name)), 'nothing of the parsers comes before they are needed');
  await then(page, () => drop(page, 'node.ifc', ifc()));
  await pixels(page);
  const came = fetched(page).filter((name) => heavy.test(name));
  assert.equal(came.filter((name) => name.endsWith('.wasm')).length, 1, `came: ${came}`);
  assert.match(await page.locator('#imported-said').innerText(), /^4 members\. 3 things were not understood:/);
  const told = await missed(page);
  for (const [i, words] of [/1 rectangular tube has corners that are not stated/, /^#\d+ IfcBeam: #\d+ IfcRectangleHollowProfileDef is a rectangular tube without OuterFilletRadius/,
    /^#\d+ IfcPlate: IfcPlate is not imported$/].entries()) assert.ok(told.some((line) => words.test(line)), `${i}: ${told}`);
  assert.equal(await page.locator('.canvas canvas').getAttribute('data-members'), '4');
  assert.deepEqual(await page.locator('#items [role=option] b').allInnerTexts(), ['chord', 'left', 'right', 'on the box']);
  await page.locator('.canvas canvas').scrollIntoViewIfNeeded();
  const label = page.locator('.labels .shown', {hasText: 'left'});
  const {x, y, width: w, height: h} = await label.boundingBox();
  await page.mouse.click(x + w / 2, y + h / 2);
  assert.equal((await page.locator('.facts h3').innerText()).split('\n')[0].trim(), 'left');
  assert.equal(await page.locator('#items [aria-selected=true] b').innerText(), 'left');
  const {members, connect} = await request(page);
  const cos = Math.SQRT1_2;
  assert.deepEqual(members[0], {id: 'chord', start_mm: [-1000, 0, 0], end_mm: [1000, 0, 0], outer_diameter_mm: 120.6, wall_mm: 5});
  assert.ok(members[1].end_mm.every((v, i) => Math.abs(v - [-200 - 1000 * cos, 0, 1000 * cos][i]) < 1e-6));
  assert.deepEqual(connect, {within_mm: 5});
  const shifted = page.locator('[data-question=origin]');
  await shifted.fill('here');
  await shifted.press('Enter');
  await page.locator('#imported [role=alert]', {hasText: '"here" is no point'}).waitFor();
  await shifted.fill('-1000, 0, 5');
  await then(page, () => shifted.press('Enter'));
  assert.deepEqual((await request(page)).members[0].end_mm, [2000, 0, -5]);
  const corner = page.locator('[data-question=corner]');
  await corner.fill('-3');
  await corner.press('Enter');
  await page.locator('#imported [role=alert]', {hasText: '"-3" is no length'}).waitFor();
  await corner.fill('7.5');
  await then(page, () => corner.press('Enter'));
  assert.deepEqual((await request(page)).members.filter(({kind}) => kind).map(({id, corner_radius_mm, up}) => [id, corner_radius_mm, up.length]), [['box', 7.5, 3]]);
  assert.equal((await missed(page)).length, 1);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= width, 'the page is as wide as the screen');
  assert.equal(await page.locator('#example option:checked').innerText(), 'A job of your own');
  await page.locator('#tab-downloads').click();
  await page.locator('#panel [name=purpose][value=packet]').check();
  await page.locator('#panel input[data-option=files][value=gcode]').uncheck();
  const [packet] = await Promise.all([page.waitForEvent('download', {timeout: 60000}), page.locator('#panel [data-media="application/zip"]').click()]);
  const listed = execFileSync('unzip', ['-Z1', await packet.path()], {encoding: 'utf8'}).trim().split('\n');
  execFileSync('unzip', ['-tqq', await packet.path()]);
  // The braces are alike: one part.
  for (const id of ['chord', 'left']) assert.equal(listed.filter((file) => new RegExp(`(^|/)${id}_[0-9a-f]{8}\\.nc1$`).test(file)).length, 1, `${id} in ${listed}`);
  clean(page);
  await page.context().close();
}

export const checks = {
  'an IFC file is dropped: its frame is seen, a member clicked, what was left out said': (given) => dropsIfc(given, 1280, 'light'),
  'the same at 390 px, dark': (given) => dropsIfc(given, 390, 'dark'),

  'in Chinese, the reasons for omitted things are Chinese': async ({browser, origin}) => {
    const page = await frames(browser, origin, {width: 390, locale: 'zh-CN'});
    await then(page, () => drop(page, 'node.ifc', ifc()));
    const told = await missed(page);
    assert.equal(told.length, 3);
    for (const line of told) {
      assert.match(line, /\p{Script=Han}/u);
      assert.doesNotMatch(line, /\p{Ll}{2,} \p{Ll}{2,}/u);
    }
    assert.ok(told.some((line) => /^#\d+ IfcPlate：不导入 IfcPlate$/.test(line)), `${told}`);
    clean(page);
    await page.context().close();
  },

  'a PCF file is chosen by the keyboard, the walls that it does not tell by a schedule': async ({browser, origin}) => {
    const page = await frames(browser, origin);
    page.on('filechooser', () => {});  // else the browser may open its own, which is intercepted from the first listener on
    await page.locator('#model').focus();
    assert.equal(await page.evaluate(() => document.activeElement.id), 'model');
    const chooser = page.waitForEvent('filechooser');
    await page.keyboard.press('Enter');
    await then(page, async () => (await chooser).setFiles({name: 'spool.PCF', mimeType: 'text/plain', buffer: Buffer.from(spool)}));
    assert.match(await page.locator('#imported-said').innerText(), /^1 member and \d others that cut\. 8 things were not understood:/);
    assert.ok((await missed(page)).some((line) => /^5 × PIPE: .*no schedule was given \(line 18, /.test(line)));
    await then(page, () => page.locator('[data-question=schedule]').selectOption('SCH 40'));
    assert.deepEqual(await missed(page), []);
    const {members, others, joints} = await request(page);
    const expected = JSON.parse(beside('examples/frames/pipe-spool-from-pcf.json'));
    assert.deepEqual({members, others, joints}, {members: expected.members, others: expected.others, joints: expected.joints});
    assert.equal(await page.locator('#verdict .pill').innerText(), 'ok');
    assert.ok(!fetched(page).some((name) => /web-ifc/.test(name)), 'the parser of IFC is for IFC');
    // The frame is edited and kept as any request; an edited field does not discard the list of
    // omitted items.
    await then(page, () => page.locator('[data-pointer="/members/0/end_mm/0"], [data-pointer="/members/0/id"]').first().fill('first'));
    assert.equal(await page.locator('#imported-said').count(), 1);
    clean(page);
    await page.context().close();
  },

  'a CSV file asks for its columns, a drawing for the sizes of its layers': async ({browser, origin}) => {
    const page = await frames(browser, origin);
    const csv = 'Name;start_x;start_y;start_z;end_x;end_y;end_z;across;gauge\nA;0;0;0;40;0;0;3.5;0.2\nB;20;0;0;20;30;0;2.375;0.154\n';
    await choose(page, 'tubes.csv', csv);
    await page.locator('#not-understood li').nth(1).waitFor();
    assert.match(await page.locator('#imported-said').innerText(), /^No member was found/);
    const meaning = (i) => page.locator(`[data-column="${i}"]`);
    assert.ok(await meaning(0).isVisible(), 'the columns are shown because one is missing');
    assert.deepEqual(await Promise.all([0, 1, 7].map((i) => meaning(i).inputValue())), ['id', 'start_x', '']);
    await page.locator('[data-question=unit]').selectOption('in');
    await meaning(7).selectOption('outer_diameter');
    await then(page, () => meaning(8).selectOption('wall'));
    assert.match(await page.locator('#imported-said').innerText(), /^2 members\. Nothing was omitted\./);
    const {members} = await request(page);
    assert.deepEqual(members, [
      {id: 'A', start_mm: [0, 0, 0], end_mm: [1016, 0, 0], outer_diameter_mm: 88.9, wall_mm: 5.08},
      {id: 'B', start_mm: [508, 0, 0], end_mm: [508, 762, 0], outer_diameter_mm: 60.325, wall_mm: 3.9116},
    ]);
    const pair = (...all) => all.map(([code, value]) => `${code}\n${value}\n`).join('');
    const line = (handle, layer, x, z) => pair([0, 'LINE'], [5, handle], [8, layer], [10, 0], [20, 0], [30, 0], [11, x], [21, 0], [31, z]);
    const dxf = `${pair([0, 'SECTION'], [2, 'HEADER'], [9, '$INSUNITS'], [70, 4], [0, 'ENDSEC'], [0, 'SECTION'], [2, 'ENTITIES'])}${
      line('1', 'CHORD', 1000, 0)}${line('2', 'BRACE', 0, 800)}${pair([0, 'ENDSEC'], [0, 'EOF'])}`;
    await choose(page, 'lines.dxf', dxf);
    await page.locator('[data-question="layer BRACE"]').waitFor();
    await then(page, async () => {
      await page.locator('[data-question="layer CHORD"]').fill('88.9x5');
      await page.locator('[data-question="layer CHORD"]').press('Enter');
    });
    await then(page, async () => {
      await page.locator('[data-question="layer BRACE"]').fill('CHS 48.3x3.2');
      await page.locator('[data-question="layer BRACE"]').press('Enter');
    });
    assert.deepEqual((await request(page)).members.map(({id, size, wall_mm}) => [id, size ?? wall_mm]), [['CHORD 1', 5], ['BRACE 2', 'CHS 48.3x3.2']]);
    clean(page);
    await page.context().close();
  },

  'a table without headings is pasted, its columns are matched by the keyboard, and the frame is there': async ({browser, origin}) => {
    for (const [size, theme] of [[1280, 'light'], [390, 'dark']]) {
      const page = await frames(browser, origin, {width: size, height: 844, theme});
      await page.locator('#paste-table').focus();
      await page.keyboard.press('Enter');
      const box = page.locator('#imported textarea');
      assert.ok(await box.evaluate((node) => node === document.activeElement), 'it is pasted at once');
      await box.fill(`post;48,3;0;0;0;0;0;1200,5;3,2\nrail;48,3;0;0;1200,5;900;0;1200,5;3,2\n${'lost;48,3;0;0;0;0;0;0;3,2\n'.repeat(30)}`);
      await page.locator('#imported table').waitFor();
      assert.equal(await page.locator('[data-question=headings]').isChecked(), false);
      assert.equal(await page.locator('.matched tbody tr').count(), 20);
      assert.match(await page.locator('.matched summary').innerText(), /0 of 9 have a meaning/);
      const fields = ['id', 'outer_diameter', 'start_x', 'start_y', 'start_z', 'end_x', 'end_y', 'end_z'];
      for (const [i, field] of fields.entries()) await page.locator(`[data-column="${i}"]`).selectOption(field);
      const last = page.locator('[data-column="8"]');
      await last.focus();
      await then(page, () => last.press('w'));
      assert.equal(await last.inputValue(), 'wall');
      assert.deepEqual((await request(page)).members, [
        {id: 'post', start_mm: [0, 0, 0], end_mm: [0, 0, 1200.5], outer_diameter_mm: 48.3, wall_mm: 3.2},
        {id: 'rail', start_mm: [0, 0, 1200.5], end_mm: [900, 0, 1200.5], outer_diameter_mm: 48.3, wall_mm: 3.2},
      ]);
      assert.deepEqual(await missed(page), ['30 × CSV: it has no length (row 3, row 4, row 5, row 6, row 7 …)']);
      // A field has one column, and what is not a heading is a row.
      await page.locator('[data-column="1"]').selectOption('wall');
      await page.locator('#not-understood', {hasText: 'no column for outer_diameter'}).waitFor();
      assert.equal(await last.inputValue(), '');
      await page.locator('[data-question=headings]').check();
      await page.locator('.matched th', {hasText: 'post'}).waitFor();
      assert.deepEqual(await barred(page), []);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= size, 'the page is as wide as the screen');
      clean(page);
      await page.context().close();
    }
  },

  'unknown bores are asked for by name, members in line are one piece if that is ticked': async ({browser, origin}) => {
    const page = await frames(browser, origin);
    await choose(page, 'line.pcf', beside('clients/import/test/data/field/pcf_bore_nps_times_25_4.pcf'));
    await page.locator('[data-question="bore 152.4"]').waitFor();
    assert.match((await missed(page)).join('; '), /152\.4 MM is the bore of 3 components, probably NPS 6/);
    await page.locator('[data-question=schedule]').selectOption('SCH 40');
    for (const [bore, size] of [['152.4', 'NPS 6'], ['101.6', 'NPS 4']]) {  // each is answered before the next is given
      await then(page, async () => {
        await page.locator(`[data-question="bore ${bore}"]`).fill(size);
        await page.locator(`[data-question="bore ${bore}"]`).press('Enter');
      });
    }
    assert.deepEqual((await request(page)).members.map(({size}) => size), ['NPS 6 SCH 40', 'NPS 6 SCH 40', 'NPS 4 SCH 40']);
    assert.deepEqual(await missed(page), []);
    clean(page);
    await page.context().close();
  },

  'an NC1 file becomes a part, on its own page': async ({browser, origin}) => {
    const page = await frames(browser, origin);
    const tube = file({blocks: [...squareFaces(), bores(['v', 300, 's', 30, 9], ['v', 340, 's', 30, 9]), 'PU\n  v 1.00 2.00']});
    await then(page, () => choose(page, 'rail.NC1', tube));
    assert.equal(await page.locator('#endpoints [aria-current=page]').getAttribute('data-endpoint'), 'parts');
    assert.match(await page.locator('#imported-said').innerText(), /^A part with 2 cut-outs\. 1 thing was not understood:/);
    assert.match((await missed(page)).join(), /PU: 1 block \(punch marks\) is not read/);
    assert.ok(await page.locator('#model').isVisible(), 'the next file can be opened here');
    const {target, cutouts} = await request(page);
    assert.deepEqual([target.id, target.length_mm, cutouts.map(({at}) => at.z_mm)], ['R-3', 1000, [300, 340]]);
    await then(page, () => choose(page, 'node.ifc', ifc()));
    assert.equal(await page.locator('#endpoints [aria-current=page]').getAttribute('data-endpoint'), 'frames');
    await choose(page, 'beam.nc', tube.replace('  M\n', '  I\n'));
    await page.locator('#imported', {hasText: 'No part was found'}).waitFor();
    assert.match((await missed(page)).join(), /profile code I .* is not a tube/);
    clean(page);
    await page.context().close();
  },

  'a file that cannot be read leaves the job as it was': async ({browser, origin}) => {
    const page = await frames(browser, origin);
    const before = await request(page);
    for (const [name, text, said] of [['bad.ifc', 'no model', /No member was found/], ['bad.dxf', '', /It cannot be read/], ['bad.step', 'x', /is not one of \.ifc, \.pcf, \.csv, \.dxf, \.tsv, \.txt/]]) {
      const count = await answers(page);
      await choose(page, name, text);
      await page.locator('#imported', {hasText: said}).waitFor();
      assert.deepEqual(await request(page), before, name);
      assert.equal(await answers(page), count, `${name}: nothing is asked`);
    }
    await page.locator('#imported button', {hasText: 'Close'}).click();
    assert.ok(await page.locator('#imported').isHidden());
    assert.equal(await page.evaluate(() => document.activeElement.id), 'model');
    clean(page);
    await page.context().close();
  },

  'another job ends it, and only frames and parts are imported': async ({browser, origin}) => {
    const page = await frames(browser, origin);
    await then(page, () => choose(page, 'node.ifc', ifc()));
    await then(page, () => page.locator('#example').selectOption('truss-of-19'));
    assert.ok(await page.locator('#imported').isHidden());
    await then(page, () => page.locator('#endpoints [data-endpoint=bevel-tables]').click());
    assert.ok(await page.locator('#model').isHidden());
    clean(page);
    await page.context().close();
  },
};
