import {readFileSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import {defineConfig, type Plugin} from 'vite';
import {html} from './glossary/markdown';
import {chineseWords, words} from './glossary/words';

const page = (file: string) => fileURLToPath(new URL(file, import.meta.url));

// `npm run dev` next to a service started with ./dev serve.
const service = process.env['TUBECUT'] ?? 'http://127.0.0.1:8080';

// Its page needs no script.
const glossary: Plugin = {
  name: 'glossary',
  transformIndexHtml: (text) => text.replace('<!-- docs/glossary.md -->', () => html(readFileSync(page('../docs/glossary.md'), 'utf8'))),
};

/** The same page as data, for labels and hints; the Chinese part of it is a module of its own. */
const read = {'virtual:words': words, 'virtual:words-zh': chineseWords};
const dictionary: Plugin = {
  name: 'words',
  resolveId: (id) => (Object.hasOwn(read, id) ? `\0${id}` : undefined),
  load: (id) => {
    const of = read[id.slice(1) as keyof typeof read];
    return id.startsWith('\0') && of ? `export default ${JSON.stringify(of(readFileSync(page('../docs/glossary.md'), 'utf8')))}` : undefined;
  },
};

export default defineConfig({
  base: '/',
  plugins: [glossary, dictionary],
  // clients/import is the console's too, its parsers are those of this folder: `npm ci` here is all that a build needs.
  resolve: {dedupe: ['papaparse', 'web-ifc']},
  worker: {format: 'es'}, // the reader of models loads that of IFC when the first such file comes
  // Three pages: the console, the API reference that shares little with it, the words of both.
  build: {
    target: 'es2021',
    assetsInlineLimit: 0, // a data: address would need a wider Content-Security-Policy
    modulePreload: {polyfill: false},
    chunkSizeWarningLimit: 3600, // web-ifc, which comes with the first IFC file
    rollupOptions: {input: {console: page('index.html'), docs: page('docs/index.html'), glossary: page('glossary/index.html')}},
  },
  server: {proxy: {'/v1': service, '/openapi': service}, fs: {allow: [page('.'), page('../clients/import/src'), page('../clients/check/src')]}},
});
