// Generates the types, builds dist/, and returns the faults of the type tests.
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import ts from 'typescript';

export const ROOT = dirname(dirname(fileURLToPath(import.meta.url)));
const WRONG = join(ROOT, 'test/wrong.ts');
const README = join(ROOT, 'test/readme.ts');  // in memory: the page's examples as one module
const DIRECTIVE = /^\s*\/\/ @ts-expect-error (\d+) (.+)$/;

function readmeExamples() {
  return Array.from(readFileSync(join(ROOT, 'README.md'), 'utf8').matchAll(/^```ts\n(.*?)^```/gms), ([, block]) => block).join('\n');
}

// Returns the page's examples as a module that runs, and their expected output from its comments.
export function readmeModule() {
  const text = readmeExamples();
  const printed = Array.from(text.matchAll(/console\.log\(.*\);  \/\/ (.+)$/gm), ([, line]) => line.split(' | ')).flat();
  const {outputText} = ts.transpileModule(text, {compilerOptions: {target: ts.ScriptTarget.ES2022, module: ts.ModuleKind.ES2022}});
  return {code: outputText.replace("'tubecut-client'", "'./index.js'"), printed};
}

function settings() {
  const path = join(ROOT, 'tsconfig.json');
  return ts.parseJsonConfigFileContent(ts.readConfigFile(path, ts.sys.readFile).config, ts.sys, ROOT, {}, path).options;
}

const message = (found) => ts.flattenDiagnosticMessageText(found.messageText, '\n');
const place = (found) => found.file ?
  `${found.file.fileName}:${found.file.getLineAndCharacterOfPosition(found.start).line + 1}` : 'options';

// Parses each file once for all programs.
const parsed = new Map();
function sharingHost(options, edit = (name, text) => text) {
  const host = ts.createCompilerHost(options);
  host.getSourceFile = (name, version) => {
    const text = name === README ? readmeExamples().replace("'tubecut-client'", "'../src/index.js'") : edit(name, ts.sys.readFile(name) ?? '');
    const key = `${name}\n${name === WRONG ? text : ''}`;
    if (!parsed.has(key)) parsed.set(key, ts.createSourceFile(name, text, version));
    return parsed.get(key);
  };
  return host;
}

// The code after each directive.
const withoutDirectives = (name, text) => name === WRONG ? text.replace(/@ts-expect-error/g, '(expected error)') : text;

const errorsOf = (program) => ts.getPreEmitDiagnostics(program).filter(({category}) => category === ts.DiagnosticCategory.Error);

function typeFaults(options) {
  const files = [join(ROOT, 'test/right.ts'), README, WRONG];
  const relaxed = {...options, noEmit: true, rootDir: ROOT, declaration: false};
  const program = ts.createProgram(files, relaxed, sharingHost(relaxed));
  const faults = errorsOf(program).map((found) => `${place(found)} ${message(found)}`);

  const behind = errorsOf(ts.createProgram(files, relaxed, sharingHost(relaxed, withoutDirectives)));
  const lines = readFileSync(WRONG, 'utf8').split('\n');
  let expected = 0;
  lines.forEach((line, i) => {
    const directive = DIRECTIVE.exec(line);
    if (!directive) return;
    expected += 1;
    const [, code, words] = directive;
    const here = behind.filter((found) => place(found) === `${WRONG}:${i + 2}`);
    if (here.length === 1 && String(here[0].code) === code && message(here[0]).includes(words)) return;
    const is = here.map((found) => `TS${found.code} ${message(found)}`).join('; ') || 'accepted';
    faults.push(`${WRONG}:${i + 2} should be only TS${code} with "${words}", is ${is}`);
  });
  if (expected < 10) faults.push(`only ${expected} wrong calls`);
  if (behind.length !== expected) faults.push(`${behind.length} errors for ${expected} wrong calls`);
  return {faults, expected};
}

export function compile() {
  execFileSync(process.execPath, [join(ROOT, 'node_modules/openapi-typescript/bin/cli.js'), join(ROOT, '../../openapi.yaml'),
    '--default-non-nullable=false', '-o', join(ROOT, 'src/schema.ts')], {stdio: ['ignore', 'ignore', 'inherit']});
  const options = settings();
  const program = ts.createProgram([join(ROOT, 'src/index.ts')], options, sharingHost(options));
  const faults = errorsOf(program).map((found) => `${place(found)} ${message(found)}`);
  program.emit();
  const types = typeFaults(options);
  return {faults: [...faults, ...types.faults], expected: types.expected};
}
