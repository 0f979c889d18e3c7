// How fast the console is with a large frame: its first picture, each key until it is painted, and the frames of an orbit.
// usage: console_frame.mjs --server BINARY [--chromium BINARY] [--members 500] [--keys 60]; ./dev bench runs it
import {readFileSync} from 'node:fs';
import {parseArgs} from 'node:util';
import {Service} from '../tests/contract/service.mjs';
import {answered, launch, open, pixels, then} from '../tests/e2e/browser.mjs';

const {values} = parseArgs({options: {
  server: {type: 'string'}, chromium: {type: 'string', default: '/usr/bin/chromium-headless-shell'}, members: {type: 'string', default: '500'},
  keys: {type: 'string', default: '60'},
}});
const keys = Number(values.keys);
const truss = JSON.parse(readFileSync(new URL('../examples/frames/truss-of-19.json', import.meta.url)));

/** Trusses side by side, of 14 members each, no two diagonals alike: nearly every member is a part of its own. */
function trusses(count, bays = 12) {
  const chords = truss.members.filter(({id}) => id === 'top' || id === 'bottom').map((each) => ({...each, end_mm: [500 * bays + 200, ...each.end_mm.slice(1)]}));
  const members = Array.from({length: count}, (_, k) => {
    const diagonals = Array.from({length: bays}, (__, i) => ({id: `D${i}`, start_mm: [500 * i + 70, 0, 0], end_mm: [500 * i + 430 - 0.01 * (i + bays * k), 0, 500],
      outer_diameter_mm: 48.3, wall_mm: 3.2, priority: 1}));
    const moved = ([x, , z]) => [x, 1000 * k, z];
    return [...chords, ...diagonals].map((each) => ({...each, id: `${each.id} ${k}`, start_mm: moved(each.start_mm), end_mm: moved(each.end_mm)}));
  });
  return {...truss, members: members.flat()};
}
const frame = trusses(Math.round(Number(values.members) / 14));

const service = await Service.start(values.server);
const browser = await launch(values.chromium);
const page = await open(browser, `http://127.0.0.1:${service.port}`, '#/frames/truss-of-19', {width: 1280, height: 900});
await answered(page);
await pixels(page);

// From the answer until the picture is there: the service's own time is bench/frames'.
await page.evaluate(() => {
  const {fetch} = window;
  window.fetch = async (...given) => {
    const reply = await fetch(...given);
    const text = reply.text.bind(reply);
    reply.text = async () => {
      const got = await text();
      window.arrived = performance.now();
      return got;
    };
    return reply;
  };
  window.finished = () => {
    const gl = document.querySelector('.canvas canvas').getContext('webgl2');
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now();
  };
});
const start = performance.now();
await then(page, () => page.locator('#job-file').setInputFiles({name: 'frame.json', mimeType: 'application/json', buffer: Buffer.from(JSON.stringify(frame))}));
const whole = performance.now() - start;
const first = await page.evaluate(() => window.finished() - window.arrived);

/** Presses a key again and again; returns the times from each to the paint that follows it, as the browser measures them. */
async function pressed(selector, next, {settle = 120} = {}) {
  await page.locator(selector).first().focus();
  await page.evaluate(() => {
    window.times = [];
    window.watching = new PerformanceObserver((list) => list.getEntries().filter(({name}) => name === 'keydown').forEach(({duration}) => window.times.push(duration)));
    window.watching.observe({type: 'event', durationThreshold: 16});
  });
  for (let i = 0; i < keys; ++i) {
    await page.keyboard.press(next(i));
    await page.waitForTimeout(settle);
  }
  await page.waitForTimeout(500);
  const slow = await page.evaluate(() => {
    window.watching.disconnect();
    return window.times;
  });
  return [...slow, ...Array(Math.max(0, keys - slow.length)).fill(16)]; // those below the threshold are not reported
}

/** Turns the view by a key in each frame; returns the pictures per second, each finished. */
const orbit = (seconds) => page.evaluate(async (long) => {
  const canvas = document.querySelector('.canvas canvas');
  const begin = performance.now();
  let count = 0;
  while (performance.now() - begin < 1000 * long) {
    canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true, cancelable: true}));
    await new Promise((done) => requestAnimationFrame(() => setTimeout(done, 0)));
    window.finished();
    count += 1;
  }
  return count / ((performance.now() - begin) / 1000);
}, seconds);

const tail = (list) => [...list].sort((a, b) => a - b)[Math.ceil(0.95 * list.length) - 1];
const figures = {};
const told = (name, value, limit) => {
  figures[name] = value;
  console.log(`${`frame of ${frame.members.length}: ${name}`.padEnd(52)} ${value.padStart(10)}   ${limit}`);
};
told('opened until drawn, with the service', `${whole.toFixed(0)} ms`, '');
told('answer until first picture', `${first.toFixed(0)} ms`, 'under 1 000 ms');
await pixels(page);
told('key in the list of members, 95 %', `${tail(await pressed('#items', (i) => (i % 20 < 10 ? 'ArrowDown' : 'ArrowUp'))).toFixed(0)} ms`, 'under 100 ms');
told('key in the table of members, 95 %', `${tail(await pressed('#members .sheet', (i) => (i % 20 < 10 ? 'ArrowDown' : 'ArrowUp'))).toFixed(0)} ms`, 'under 100 ms');
const field = '#form [data-pointer$="/wall_mm"]';
told('key in a field, 95 %', `${tail(await pressed(field, (i) => (i % 2 ? 'Backspace' : '1'))).toFixed(0)} ms`, 'under 100 ms');
await answered(page);
told('orbit, pictures per second', (await orbit(4)).toFixed(1), 'at least 30');
await browser.close();
await service.stop();
