// The style sheets of the console.
import {strict as assert} from 'node:assert';
import {readdirSync, readFileSync} from 'node:fs';
import test from 'node:test';

const folder = new URL('../../web/src/', import.meta.url);
const sheets = readdirSync(folder, {recursive: true}).filter((name) => name.endsWith('.css'));

test('no rule asks for an element anywhere in the page, because a browser then styles the whole page at each change', () => {
  assert.ok(sheets.length > 1);
  for (const name of sheets) assert.doesNotMatch(readFileSync(new URL(name, folder), 'utf8'), /(?:^|[\s,}])(?:body|html|main|:root|#page)[^\s,{>]*:has\(/m, name);
});
