// Every example with every tab, at both widths, light and dark, to axe too: a quarter of an hour, for ./dev soak pages.
import {strict as assert} from 'node:assert';
import {visited} from '../seen.mjs';

const cases = [[1280, 800, 'light'], [1280, 800, 'dark'], [390, 844, 'light'], [390, 844, 'dark']];
export const checks = Object.fromEntries(cases.map(([width, height, theme]) => [`${width} px, ${theme}`, async (given) => {
  const {wrong} = await visited(given, {width, height, theme, whole: true, tell: (example) => console.log(`      ${example}`)});
  assert.equal(wrong.join('\n'), '');
}]));
