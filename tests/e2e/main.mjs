// The console and the API reference in a browser, against the running service.
// usage: main.mjs SUITE --server BINARY --chromium BINARY [--seed WORD]
import {strict as assert} from 'node:assert';
import {parseArgs} from 'node:util';
import {Service} from '../contract/service.mjs';
import {launch} from './browser.mjs';

const {values, positionals: [suite]} = parseArgs({allowPositionals: true, options: {
  server: {type: 'string'}, chromium: {type: 'string', default: '/usr/bin/chromium-headless-shell'}, seed: {type: 'string'},
}});
const {checks} = await import(`./suites/${suite}.mjs`);
assert.ok(Object.keys(checks).length > 0, 'an empty suite');

const service = await Service.start(values.server);
const browser = await launch(values.chromium);
const origin = `http://127.0.0.1:${service.port}`;
let failed = 0;
for (const [name, check] of Object.entries(checks)) {
  const start = performance.now();
  try {
    await check({browser, origin, service, ...values});
    console.log(`ok    ${name} (${Math.round(performance.now() - start)} ms)`);
  } catch (error) {
    failed += 1;
    console.log(`FAIL  ${name}\n${error.stack}`);
  }
}
await browser.close();
await service.stop();
process.exit(failed ? 1 : 0);
