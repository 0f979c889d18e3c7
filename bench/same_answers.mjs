// Compares two builds byte by byte: every example and COUNT generated requests of every endpoint,
// each in JSON, and alternately in its other formats.
// usage: same_answers.mjs OLD_BINARY NEW_BINARY [--count 2000] [--seed N] [--only
// bevel-tables,parts] [--contract openapi.yaml]
import {parseArgs} from 'node:util';
import {Contract} from '../tests/contract/schemas.mjs';
import {drawn, sound} from '../tests/contract/generate.mjs';
import {each, Service} from '../tests/contract/service.mjs';

const SHOWN = 12;
const NAMED = {'X-Request-Id': '0123456789abcdef0123456789abcdef'};  // a problem repeats it

const {values, positionals: [old, now]} = parseArgs({allowPositionals: true, options: {
  count: {type: 'string', default: '2000'}, seed: {type: 'string', default: '1'}, only: {type: 'string'},
  contract: {type: 'string', default: 'openapi.yaml'}}});
if (!old || !now) {
  console.error('usage: same_answers.mjs OLD_BINARY NEW_BINARY [--count N] [--seed N] [--only ENDPOINTS] [--contract FILE]');
  process.exit(2);
}
const [before, after] = await Promise.all([Service.start(old), Service.start(now)]);
const contract = await new Contract(values.contract).learn(before);
const only = values.only?.split(',').map((name) => `/v1/${name}`);
const posts = contract.posts().filter(({path}) => !only || only.includes(path));
const share = Math.ceil(Number(values.count) / posts.length);

// Times in a log are not part of the answer; everything else is.
const silent = ({log, ...body}) => body;
const {endpoints} = JSON.parse((await before.ask('/v1/version', {method: 'GET'})).text);
const formats = (path) => endpoints.find((e) => e.path === path).formats.filter((type) => type !== 'application/json');

// Each build writes its own commit, in CBOR with the length of the text before it. Zips are compressed, so only their status is compared.
const bytes = (answer) => answer.body.toString('latin1').replace(/(?:[\x60-\x77]|\x78.)?tubecut \d+\.\d+\.\d+\+[0-9a-f]{12}(-dirty)?/gs, 'tubecut');
const sameBytes = (a, b, format) => format === 'application/zip' || bytes(a) === bytes(b);

let differing = 0, asked = 0;
const formatsThatDiffer = {};
const statuses = {};
async function same(path, body, format) {
  const where = `${path} as ${format}`;
  const [a, b] = await Promise.all([before, after].map((service) => service.post(path, body, {headers: {Accept: format, ...NAMED}})));
  asked += 1;
  statuses[a.status] = (statuses[a.status] ?? 0) + 1;
  if (a.status === b.status && sameBytes(a, b, format)) return;
  differing += 1;
  formatsThatDiffer[format] = (formatsThatDiffer[format] ?? 0) + 1;
  if (differing > SHOWN) return;
  const at = [...a.text].findIndex((c, i) => c !== b.text[i]);
  console.log(`DIFFERS ${where}: ${a.status} ${a.text.slice(Math.max(0, at - 60), at + 80)}\n   now ${b.status} ${b.text.slice(Math.max(0, at - 60), at + 80)}`);
  console.log(`   body ${JSON.stringify(body).slice(0, 600)}`);
}

for (const endpoint of posts) {
  const kinds = formats(endpoint.path);
  for (const {body} of endpoint.examples) {
    for (const format of ['application/json', ...kinds]) await same(endpoint.path, silent(body), format);
  }
  await each(drawn(sound(contract, endpoint), Number(values.seed), share), async (body, k) => {
    await same(endpoint.path, silent(body), 'application/json');
    if (kinds.length) await same(endpoint.path, silent(body), kinds[k % kinds.length]);
  });
}
console.log(`${asked} requests, ${differing} differ ${JSON.stringify(formatsThatDiffer)}; answers ${JSON.stringify(statuses)}`);
await Promise.all([before.stop(), after.stop()]);
process.exitCode = differing || !asked ? 1 : 0;
