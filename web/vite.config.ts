import {fileURLToPath} from 'node:url';
import {defineConfig} from 'vite';

const page = (file: string) => fileURLToPath(new URL(file, import.meta.url));

// `npm run dev` beside a service started with ./dev serve.
const service = process.env['TUBECUT'] ?? 'http://127.0.0.1:8080';

export default defineConfig({
  base: '/',
  // Two pages: the console, and the API reference that shares nothing with it.
  build: {
    target: 'es2021',
    assetsInlineLimit: 0, // a data: address would need a wider Content-Security-Policy
    modulePreload: {polyfill: false},
    chunkSizeWarningLimit: 1600,
    rollupOptions: {input: {console: page('index.html'), docs: page('docs/index.html')}},
  },
  server: {proxy: {'/v1': service, '/openapi': service}},
});
