// How fast the console is in a browser: first paint, first answer drawn, redraw after an angle changed, bytes over the wire.
// usage: console.mjs --server BINARY [--chromium BINARY] [--runs 20]; ./dev bench runs it
import {parseArgs} from 'node:util';
import {Service} from '../tests/contract/service.mjs';
import {answered, launch, open} from '../tests/e2e/browser.mjs';

const {values} = parseArgs({options: {
  server: {type: 'string'}, chromium: {type: 'string', default: '/usr/bin/chromium-headless-shell'}, runs: {type: 'string', default: '20'},
}});
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
const tail = (list) => [...list].sort((a, b) => a - b)[Math.ceil(0.95 * list.length) - 1];

const service = await Service.start(values.server);
const browser = await launch(values.chromium);
const origin = `http://127.0.0.1:${service.port}`;

const paints = [], firsts = [];
let bytes = {};
for (let run = 0; run < 5; ++run) {
  const page = await open(browser, origin);
  await answered(page);
  const seen = await page.evaluate(async () => ({
    now: performance.now(),
    paint: await new Promise((done) => new PerformanceObserver((list) => list.getEntriesByName('first-contentful-paint').forEach((e) => done(e.startTime)))
      .observe({type: 'paint', buffered: true})),
    files: performance.getEntriesByType('resource').concat(performance.getEntriesByType('navigation'))
      .filter(({name}) => /\/$|\.(js|css|svg)$|#/.test(name)).map(({name, encodedBodySize}) => [new URL(name).pathname, encodedBodySize]),
  }));
  paints.push(seen.paint);
  firsts.push(seen.now);
  bytes = Object.fromEntries(seen.files);
  await page.context().close();
}

const page = await open(browser, origin);
await answered(page);
await page.locator('#view-before').waitFor();
// From the keystroke until the curves are drawn and the solid's pixels are there: the answer is counted when the charts
// are drawn, the solid is rendered in the next frame, and reading a pixel waits for the picture to be finished.
const redraws = await page.evaluate(async (runs) => {
  const input = document.querySelector('[data-pointer="/cutters/0/inclination_deg"]');
  const frame = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 0)));
  const gl = document.querySelector('.canvas canvas').getContext('webgl2');
  const pixel = new Uint8Array(4);
  const times = [];
  for (let run = 0; run < runs; ++run) {
    const before = document.body.dataset.answers;
    const start = performance.now();
    input.value = String(70 + (run % 20));
    input.dispatchEvent(new Event('input', {bubbles: true}));
    while (document.body.dataset.answers === before) await new Promise((done) => setTimeout(done, 1));
    await frame();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    times.push(performance.now() - start);
    await new Promise((done) => setTimeout(done, 50));
  }
  return times;
}, Number(values.runs));

const print = (name, value, limit) => console.log(`${name.padEnd(44)} ${value.padStart(12)}   ${limit}`);
const total = Object.values(bytes).reduce((sum, each) => sum + each, 0);
print('console: first paint, median of 5', `${median(paints).toFixed(0)} ms`, 'under 1 000 ms');
print('console: first answer drawn, median of 5', `${median(firsts).toFixed(0)} ms`, '');
print(`console: angle to redraw, median of ${redraws.length}`, `${median(redraws).toFixed(0)} ms`, 'under 100 ms');
print(`console: angle to redraw, 95 % of ${redraws.length}`, `${tail(redraws).toFixed(0)} ms`, '');
print('console: first load, gzip', `${(total / 1000).toFixed(1)} kB`, 'at most 300 kB');
for (const [name, size] of Object.entries(bytes)) print(`  ${name}`, `${(size / 1000).toFixed(1)} kB`, '');
await browser.close();
await service.stop();
