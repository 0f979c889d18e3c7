// How the picture follows an angle that is changed by the keyboard. usage: live.mjs --server BINARY [--chromium BINARY] [HASH POINTER]
import {parseArgs} from 'node:util';
import {Service} from '../contract/service.mjs';
import {answered, launch, open, pixels} from './browser.mjs';

const {values, positionals: [hash = '#/bevel-tables/source-000-table-1', pointer = '/cutters/0/inclination_deg']} = parseArgs({allowPositionals: true, options: {
  server: {type: 'string'}, chromium: {type: 'string', default: '/usr/bin/chromium-headless-shell'},
}});
const service = await Service.start(values.server);
const browser = await launch(values.chromium);
const page = await open(browser, `http://127.0.0.1:${service.port}`, hash);
await answered(page);
await pixels(page);
await page.locator(`[data-pointer="${pointer}"]`).focus();

/**
 * Steps the focused field, each `every` ms or when the last one is drawn; returns the time of each
 * step and the drawn ones.
 */
const stepped = (count, every) => page.evaluate(async ([most, pause]) => {
  const field = document.activeElement;
  const drawn = () => Number(document.body.dataset.answers);
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  const begin = performance.now();
  const waits = [];
  const first = drawn();
  let frames = 0, running = true;
  const counting = (async () => {
    for (; running; ++frames) await frame();
  })();
  for (let i = 0; i < most; ++i) {
    const [asked, was] = [performance.now(), drawn()];
    field.dispatchEvent(new KeyboardEvent('keydown', {key: i % 20 < 10 ? 'ArrowUp' : 'ArrowDown', altKey: true, bubbles: true}));
    if (pause) await new Promise((done) => setTimeout(done, pause));
    else {
      while (drawn() === was) await frame();
      await frame();
      waits.push(performance.now() - asked);
    }
  }
  running = false;
  await counting;
  return {waits, seconds: (performance.now() - begin) / 1000, drawn: drawn() - first, frames};
}, [count, every]);

await stepped(10, 0);  // code that is compiled at its first use
const {waits} = await stepped(100, 0);
waits.sort((a, b) => a - b);
const held = await stepped(120, 33);
console.log(JSON.stringify({redraw_ms: {median: waits[50], p95: waits[95], most: waits[99]}, held: {pictures_s: held.drawn / held.seconds, frames_s: held.frames / held.seconds}}));
await browser.close();
await service.stop();
process.exit(0);
