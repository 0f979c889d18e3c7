// docker/grafana-dashboard.json checked against Grafana's own types of a dashboard, by the
// compiler: no unknown field, no other type. `npm ci` here comes first.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import ts from 'typescript';

const HERE = dirname(fileURLToPath(import.meta.url));
const FILE = join(HERE, 'dashboard.ts');  // in memory
const TYPES = `import type {Dashboard} from '@grafana/schema';
type Json<T> = T extends string ? \`\${T}\` : T extends number | boolean ? T : T extends object ? {[K in keyof T]: Json<T[K]>} : T;
export const dashboard: Json<Dashboard> = `;  // an enumeration is its values there

const options = {strict: true, noEmit: true, skipLibCheck: true, types: [], target: ts.ScriptTarget.ES2022, module: ts.ModuleKind.NodeNext};
const parsed = new Map();

function faults(json) {
  const host = ts.createCompilerHost(options);
  const read = host.getSourceFile;
  host.getSourceFile = (name, version) => {
    if (name === FILE) return ts.createSourceFile(name, TYPES + json, version);
    if (!parsed.has(name)) parsed.set(name, read(name, version));
    return parsed.get(name);
  };
  const exists = host.fileExists;
  host.fileExists = (name) => name === FILE || exists(name);
  return ts.getPreEmitDiagnostics(ts.createProgram([FILE], options, host)).map(({messageText}) => ts.flattenDiagnosticMessageText(messageText, ' '));
}

const json = readFileSync(join(HERE, '../../docker/grafana-dashboard.json'), 'utf8');
assert.deepEqual(faults(json), []);
for (const [from, to] of [
  ['"schemaVersion"', '"schemaVersions"'], ['"w": 3', '"w": "3"'], ['"type": "stat"', '"type": "stat", "tilte": ""'], ['"mode": "absolute"', '"mode": "absolut"'],
]) {
  assert.ok(json.includes(from), from);
  assert.notEqual(faults(json.replace(from, to)).length, 0, to);
}
console.log(`${JSON.parse(json).panels.length} panels as Grafana knows them; four spoilt ones are not`);
