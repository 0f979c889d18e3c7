// Builds dist/, then every suite by node's own runner: node test/main.mjs --server BINARY
import {spawnSync} from 'node:child_process';
import {readdirSync} from 'node:fs';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';

const here = dirname(fileURLToPath(import.meta.url));
const {values} = parseArgs({options: {server: {type: 'string'}}});
if (!values.server) throw new Error('usage: node test/main.mjs --server BINARY');
const node = (...given) => {
  const {status} = spawnSync(process.execPath, given, {cwd: dirname(here), stdio: 'inherit', env: {...process.env, TUBECUT_SERVER: resolve(values.server)}});
  if (status !== 0) process.exit(1);
};
node(join(here, '../node_modules/typescript/bin/tsc'), '-p', 'tsconfig.json');
const suites = readdirSync(here).filter((file) => file.endsWith('.test.mjs')).map((file) => join(here, file));
if (suites.length < 2) throw new Error('suites are missing');
node('--test', ...suites);
