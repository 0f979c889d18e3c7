// Chromium without a graphics card, and pages that record their messages and requests.
import {chromium} from 'playwright-core';

const flags = ['--no-sandbox', '--enable-unsafe-swiftshader'];

export const launch = (executablePath) => chromium.launch({executablePath, args: flags});

// Most tests want a job, and not the start page that a bare address shows.
const firstJob = '#/bevel-tables/source-000-table-1';

/** A browser that has no WebGL: without a graphics card each picture costs as much as the rest of the page. */
function withoutWebGl() {
  const {getContext} = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
    return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...rest);
  };
}

/** A page that draws no 3D. */
export const openPlain = (browser, origin, hash, given = {}) => open(browser, origin, hash, {...given, draws: false});

export async function open(browser, origin, hash = firstJob, {width = 1280, height = 800, theme = 'light', at = '/', draws = true, locale = 'en-US'} = {}) {
  const context = await browser.newContext({viewport: {width, height}, colorScheme: theme, acceptDownloads: true, reducedMotion: 'reduce', locale});
  const page = await context.newPage();
  page.faults = [];
  page.strangers = [];
  // A refused request (422, 401) is part of the game; the browser logs it as an error of its own.
  page.on('console', (message) => {
    const refused = /status of (422|401)/.test(message.text());
    const undrawn = !draws && message.text().startsWith('THREE.WebGLRenderer');
    if (message.type() === 'error' && !refused && !undrawn) page.faults.push(message.text());
  });
  page.on('pageerror', (error) => page.faults.push(error.message));
  page.on('request', (request) => {
    const {protocol} = new URL(request.url());
    if (!request.url().startsWith(origin) && protocol !== 'blob:' && protocol !== 'data:') page.strangers.push(request.url());
  });
  if (!draws) await context.addInitScript(withoutWebGl);
  await page.goto(origin + at + hash);
  return page;
}

/** Waits for `count` answers and for that to the last of at least `questions`, drawn in 3D too. */
export async function answered(page, count = 1, questions = 1) {
  // No waitForFunction: it evaluates text, which the page's Content-Security-Policy forbids.
  const arrived = await page.evaluate(async ([n, least]) => {
    const {dataset} = document.body;
    const end = Date.now() + 60000;
    const here = () => Number(dataset.answers ?? 0) >= n && Number(dataset.asked ?? 0) >= least && dataset.answered === dataset.asked;
    while (!here() && Date.now() < end) await new Promise((done) => setTimeout(done, 5));
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    return here();
  }, [count, questions]);
  if (!arrived) throw new Error(`no answer ${count} to question ${questions} in 60 s`);
}

export const answers = (page) => page.evaluate(() => Number(document.body.dataset.answers ?? 0));

/** Does something and waits for the answer to it: on a slow machine one to a question before it may arrive in between. */
export async function then(page, act) {
  const before = await page.evaluate(() => Number(document.body.dataset.asked ?? 0));
  await act();
  await answered(page, 1, before + 1);
}

/** The form, which a phone shows on demand. */
export async function formed(page) {
  const edit = page.locator('#edit');
  if (await edit.isVisible() && await edit.getAttribute('aria-expanded') === 'false') await edit.click();
}

/** Share of the canvas that something solid covers, and a sum that changes with the picture: the fine one, that stays, or any that is there. */
export async function pixels(page, ratio = 'fine') {
  await page.waitForSelector('.canvas canvas');
  return page.evaluate(async (wanted) => {
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const canvas = document.querySelector('.canvas canvas');
    const end = Date.now() + 60000;
    while (wanted === 'fine' && canvas.dataset.drawn !== 'fine' && Date.now() < end) await new Promise((done) => setTimeout(done, 10));
    const copy = document.createElement('canvas');
    copy.width = canvas.width;
    copy.height = canvas.height;
    const pen = copy.getContext('2d', {willReadFrequently: true});  // not drawn by a graphics card that is no card
    pen.drawImage(canvas, 0, 0);
    const {data} = pen.getImageData(0, 0, copy.width, copy.height);
    let covered = 0, sum = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] > 200) ++covered;
      sum = (sum * 31 + data[i] + 7 * data[i + 1] + 13 * data[i + 2]) % 1000000007;
    }
    return {share: covered / (data.length / 4), sum};
  }, ratio);
}

/** Texts whose contrast against their background is below 4.5 : 1, the bound of WCAG AA. */
export const faint = (page) => page.evaluate(() => {
  const channels = (colour) => (colour.match(/[\d.]+/g) ?? []).map(Number);
  const over = ([r, g, b, a = 1], [R, G, B]) => [r * a + R * (1 - a), g * a + G * (1 - a), b * a + B * (1 - a)];
  const light = (rgb) => rgb.map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4)).reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const grounds = new Map([[null, [255, 255, 255]]]);
  const behind = (node) => {
    if (!grounds.has(node)) grounds.set(node, over(channels(getComputedStyle(node).backgroundColor), behind(node.parentElement)));
    return grounds.get(node);
  };
  const wrong = new Set();
  for (const node of document.querySelectorAll('body *')) {
    const own = [...node.childNodes].some((each) => each.nodeType === 3 && /\S/.test(each.data));
    if (!(node instanceof HTMLElement) || !own || node.matches('option, script, :disabled') || node.closest('.labels') || !node.checkVisibility()) continue;
    const back = behind(node);
    const [a, b] = [light(over(channels(getComputedStyle(node).color), back)), light(back)].sort((x, y) => y - x);
    const ratio = (a + 0.05) / (b + 0.05);
    if (ratio < 4.5) wrong.add(`${ratio.toFixed(1)} : 1 ${node.className || node.tagName} ${node.textContent.slice(0, 40)}`);
  }
  return [...wrong];
});
