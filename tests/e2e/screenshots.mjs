// The pictures of the console in docs/. usage: screenshots.mjs --server BINARY --out DIR [--chromium BINARY]
// The switch of the language needs a Chinese font, such as Debian's fonts-wqy-microhei.
import {parseArgs} from 'node:util';
import {Service} from '../contract/service.mjs';
import {answered, launch, open, pixels} from './browser.mjs';

const {values} = parseArgs({options: {server: {type: 'string'}, chromium: {type: 'string', default: '/usr/bin/chromium-headless-shell'}, out: {type: 'string'}}});
const service = await Service.start(values.server);
const browser = await launch(values.chromium);
const origin = `http://127.0.0.1:${service.port}`;

async function shoot(name, hash, size, after = async () => {}) {
  const page = await open(browser, origin, hash, size);
  await answered(page);
  await pixels(page);
  await after(page);
  await pixels(page);
  await page.screenshot({path: `${values.out}/${name}.png`});
  await page.context().close();
}

/** The page of the own machine, which has no job and draws nothing: with an error, so that its way to the field is seen. */
async function machine(name, size) {
  const page = await open(browser, origin, '#/own-machine', {...size, draws: false});
  await page.locator('[data-download=post]:enabled').waitFor();
  await page.locator('[data-pointer="/machine/axes/0/v_max"]').fill('-3');
  await page.locator('[data-download=machine]:disabled').waitFor();
  await page.locator('[data-pointer="/machine/axes/0/v_max"]').blur();
  await page.screenshot({path: `${values.out}/${name}.png`});
  await page.context().close();
}

const pointAt = (chart, share) => async (page) => {
  const box = await page.locator(`#chart-${chart} .plot`).boundingBox();
  await page.mouse.move(box.x + 56 + share * (box.width - 68), box.y + box.height / 2);
};
/** The cursor on a chart below the window, while the window shows its top: by the keyboard. */
const walkTo = (chart, steps) => async (page) => {
  await page.locator(`#chart-${chart} .plot`).evaluate((plot) => plot.focus({preventScroll: true}));
  for (let i = 0; i < steps; ++i) await page.keyboard.press('Shift+ArrowRight');
  await page.evaluate(() => scrollTo(0, 0));
};
await shoot('console', '#/bevel-tables/source-000-table-1', {width: 1280, height: 900}, pointAt('bevel', 0.3));
await shoot('console-refused-dark', '#/bevel-tables/table-1-torch-45-deg?view=before', {width: 1280, height: 900, theme: 'dark'}, async (page) => {
  await page.locator('[data-pointer="/cutters/1/inclination_deg"]').fill('0');
  await answered(page, 2);
});
await shoot('console-phone', '#/holes/set-in-branch', {width: 390, height: 844}, walkTo('bevel-0', 9));
await shoot('console-frame', '#/frames/roll-cage-of-12', {width: 1280, height: 960}, async (page) => page.locator('#items [role=option]', {hasText: 'diagonal'}).first().click());
await shoot('console-part', '#/parts/table-1-with-a-square-far-end', {width: 1280, height: 960});
await shoot('console-pulses', '#/pulse-schedules/source-000-table-1-before-and-after', {width: 1280, height: 1180});
await shoot('console-section', '#/bevel-tables/source-000-table-1', {width: 1280, height: 900, theme: 'dark'}, async (page) => {
  await page.locator('#view-partners').click();
  await page.locator('#view-section').click();
  await page.locator('.slicing select').selectOption('x');
});
await machine('console-machine', {width: 1280, height: 960});
await browser.close();
await service.stop();
