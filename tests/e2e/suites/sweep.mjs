// Every example with every tab, at both widths, light and dark, to axe too: some ten minutes, for ./dev soak pages.
import {strict as assert} from 'node:assert';
import {visited} from '../seen.mjs';

export const checks = {
  'every example, every tab, every look': async (given) => {
    const {wrong} = await visited(given, {every: true, tell: (example) => console.log(`      ${example}`)});
    assert.equal(wrong.join('\n'), '');
  },
};
