// Generators of other people on our contract: each writes a client, its types compile, and every example is a request of these types.
// usage: main.mjs CONTRACT EXAMPLES_FOLDER
import {strict as assert} from 'node:assert';
import {spawnSync} from 'node:child_process';
import {copyFileSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

const [contract, examples] = process.argv.slice(2);
const here = import.meta.dirname;
const place = mkdtempSync(join(tmpdir(), 'tubecut-generators-'));
process.on('exit', () => rmSync(place, {recursive: true, force: true}));
copyFileSync(contract, join(place, 'openapi.yaml'));
symlinkSync(join(here, 'node_modules'), join(place, 'node_modules'));

function run(program, ...options) {
  const {status, stdout, stderr} = spawnSync(join(here, 'node_modules/.bin', program), options, {cwd: place, encoding: 'utf8', timeout: 300000});
  assert.equal(status, 0, `${program} ${options.join(' ')}:\n${stdout}\n${stderr}`);
}
const compile = (...files) => run('tsc', '--noEmit', '--strict', '--target', 'es2022', '--module', 'esnext', '--moduleResolution', 'bundler',
  '--lib', 'es2022,dom,dom.iterable', '--skipLibCheck', ...files);

/** The endpoint and the body of each example. */
const requests = readdirSync(examples, {withFileTypes: true}).filter((folder) => folder.isDirectory() && folder.name !== 'commissioning')
  .flatMap(({name: endpoint}) => readdirSync(join(examples, endpoint)).filter((file) => file.endsWith('.json'))
    .map((file) => ({endpoint, body: readFileSync(join(examples, endpoint, file), 'utf8')})));
assert.ok(requests.length > 40, 'no examples');

// Each generates a client and compiles it.
const generators = {
  'openapi-typescript': () => {
    run('openapi-typescript', 'openapi.yaml', '--default-non-nullable=false', '-o', 'paths.ts'); // else every field with a default is required
    const bodies = requests.map(({endpoint, body}) => `const _: Body<'/v1/${endpoint}'> = ${body};`).map((line, i) => line.replace('_', `example${i}`));
    writeFileSync(join(place, 'examples.ts'), `import type {paths} from './paths';
type Body<Path extends keyof paths> = paths[Path] extends {post: {requestBody: {content: {'application/json': infer Request}}}} ? Request : never;
${bodies.join('\n')}
export default [${bodies.map((_, i) => `example${i}`).join(', ')}];\n`);
    compile('examples.ts');
  },
  orval: () => {
    writeFileSync(join(place, 'orval.config.mjs'), "export default {tubecut: {input: './openapi.yaml', output: {target: './orval.ts', client: 'fetch'}}};\n");
    run('orval', '--config', 'orval.config.mjs');
    compile('orval.ts');
  },
  'hey-api': () => {
    run('openapi-ts', '-i', 'openapi.yaml', '-o', 'hey');
    compile('hey/index.ts');
  },
};

let failed = 0;
for (const [name, check] of Object.entries(generators)) {
  try {
    check();
    console.log(`ok    ${name}`);
  } catch (error) {
    failed += 1;
    console.log(`FAIL  ${name}\n${error.message.slice(0, 6000)}`);
  }
}
process.exit(failed ? 1 : 0);
