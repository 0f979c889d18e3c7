// Modules of the console (web/src) in Node, bundled as its build does, for tests of pure functions.
import {readFile} from 'node:fs/promises';
import {createRequire} from 'node:module';
import {fileURLToPath} from 'node:url';

const web = new URL('../../web/', import.meta.url);
const {build} = createRequire(new URL('package.json', web))('esbuild');

async function bundled(path, plugins = []) {
  const paths = [path].flat();
  const contents = paths.map((each) => `export * from './${each}';`).join('\n');
  const {outputFiles: [{text}]} = await build({stdin: {contents, resolveDir: fileURLToPath(web), loader: 'ts'}, bundle: true, write: false, format: 'esm', platform: 'neutral',
    mainFields: ['module', 'main'], target: 'es2021', plugins, logLevel: 'error'});
  return import(`data:text/javascript;base64,${Buffer.from(text).toString('base64')}`);
}

/** The names of docs/glossary.md, which the build has as two modules. */
const dictionary = {
  name: 'words',
  setup(of) {
    of.onResolve({filter: /^virtual:words/}, ({path}) => ({path, namespace: 'words'}));
    of.onLoad({filter: /.*/, namespace: 'words'}, async ({path}) => {
      const {chineseWords, words} = await bundled('glossary/words.ts');
      const markdown = await readFile(new URL('../docs/glossary.md', web), 'utf8');
      return {contents: JSON.stringify((path === 'virtual:words-zh' ? chineseWords : words)(markdown)), loader: 'json'};
    });
  },
};

/** A module of the console, or several that share their state. */
export const load = (...paths) => bundled(paths, [dictionary]);
