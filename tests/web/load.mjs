// Modules of the console (web/src) in Node, bundled as its build does, for tests of pure functions.
import {readFile} from 'node:fs/promises';
import {createRequire} from 'node:module';
import {fileURLToPath} from 'node:url';

const web = new URL('../../web/', import.meta.url);
const {build} = createRequire(new URL('package.json', web))('esbuild');

async function bundled(path, plugins = []) {
  const {outputFiles: [{text}]} = await build({entryPoints: [fileURLToPath(new URL(path, web))], bundle: true, write: false, format: 'esm', platform: 'neutral',
    mainFields: ['module', 'main'], target: 'es2021', plugins, logLevel: 'error'});
  return import(`data:text/javascript;base64,${Buffer.from(text).toString('base64')}`);
}

/** The names of docs/glossary.md, which the build has as a module. */
const dictionary = {
  name: 'words',
  setup(of) {
    of.onResolve({filter: /^virtual:words$/}, () => ({path: 'words', namespace: 'words'}));
    of.onLoad({filter: /.*/, namespace: 'words'}, async () => {
      const {words} = await bundled('glossary/words.ts');
      return {contents: JSON.stringify(words(await readFile(new URL('../docs/glossary.md', web), 'utf8'))), loader: 'json'};
    });
  },
};

export const load = (path) => bundled(path, [dictionary]);
