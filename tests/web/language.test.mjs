// The console in Chinese: which language is spoken, and that every text, code and name of it has its Chinese.
import {strict as assert} from 'node:assert';
import {readdirSync, readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import test from 'node:test';
import {load} from './load.mjs';

const root = new URL('../../', import.meta.url);
const ts = createRequire(new URL('web/package.json', root))('typescript');
const {parse} = createRequire(new URL('../contract/', import.meta.url))('yaml');
const text = (path) => readFileSync(new URL(path, root), 'utf8');
const files = (folder, ending) => readdirSync(new URL(folder, root), {recursive: true}).filter((name) => ending.test(name)).map((name) => `${folder}/${name}`);

const {languageOf, t, many, speak, language} = await load('src/language.ts');
const {dictionary} = await load('src/chinese/index.ts');
const {texts, codes} = dictionary;
const han = /\p{Script=Han}/u;
const contract = parse(text('openapi.yaml'));

/** String literals of an expression: of both branches of a choice. */
function literals(node, into = []) {
  if (ts.isStringLiteralLike(node)) into.push(node.text);
  else if (ts.isConditionalExpression(node)) [node.whenTrue, node.whenFalse].forEach((each) => literals(each, into));
  else if (ts.isBinaryExpression(node) && ['??', '||', '&&'].includes(node.operatorToken.getText())) [node.left, node.right].forEach((each) => literals(each, into));
  return into;
}

function parsed(path) {
  return ts.createSourceFile(path, text(path), ts.ScriptTarget.Latest, true, path.endsWith('x') ? ts.ScriptKind.TSX : ts.ScriptKind.TS);
}
const sources = files('web/src', /\.tsx?$/).map(parsed);
const walk = (node, act) => {
  act(node);
  ts.forEachChild(node, (each) => walk(each, act));
};

/** The texts of the page's source: those of t, later and many. */
const written = new Set();
for (const source of sources) {
  walk(source, (node) => {
    const called = ts.isCallExpression(node) ? node.expression.getText() : '';
    if (!['t', 'later', 'many'].includes(called)) return;
    const given = called === 'many' ? node.arguments.slice(1, 3) : node.arguments.slice(0, 1);
    given.forEach((each) => literals(each).forEach((found) => written.add(found)));
  });
}

/** Every string at a key of the contract, with the schemas that a request has. */
function under(value, key, seen = new Set(), into = new Set()) {
  if (typeof value !== 'object' || value === null || seen.has(value)) return into;
  seen.add(value);
  if (typeof value.$ref === 'string') under(value.$ref.split('/').slice(1).reduce((at, part) => at[part], contract), key, seen, into);
  for (const [name, inner] of Object.entries(value)) {
    if (name === key && typeof inner === 'string') into.add(inner);
    else if (name === key && Array.isArray(inner)) inner.filter((each) => typeof each === 'string').forEach((each) => into.add(each));
    else under(inner, key, seen, into);
  }
  return into;
}
const posts = Object.values(contract.paths).flatMap(({post}) => post ?? []);
const bodies = posts.map(({requestBody}) => requestBody);
const options = contract.components.parameters;
const descriptions = new Set([...under(bodies, 'description'), ...under(options, 'description')]);
const summaries = posts.map(({summary}) => summary);
const spaced = (name) => name.replace(/_/g, ' ');
const choices = new Set([...['const', 'enum', 'type'].flatMap((key) => [...under(contract.components, key)]), ...under(contract.paths, 'x-views')].map(spaced));

test('the language is the chosen one, else that of the browser', () => {
  assert.equal(languageOf('en', 'zh-CN'), 'en');
  assert.equal(languageOf('zh', 'en-US'), 'zh');
  for (const chinese of ['zh', 'zh-CN', 'zh-Hant-TW', 'ZH-cn']) assert.equal(languageOf(null, chinese), 'zh', chinese);
  for (const other of ['en-US', 'de', 'zha', '', undefined]) assert.equal(languageOf(null, other), 'en', other);
  assert.equal(languageOf('fr', 'zh-CN'), 'zh', 'a setting that this page does not have');
});

test('a text has its values, and is Chinese only while Chinese is spoken', async () => {
  assert.equal(language.value, 'en');
  assert.equal(t('Delete {n}', {n: 3}), 'Delete 3');
  assert.equal(t('The name "{name}" is taken.', {name: '{n} $& <b>'}), 'The name "{n} $& <b>" is taken.', 'a value is no pattern');
  assert.equal(t('nobody translated {this}', {that: 1}), 'nobody translated {this}');
  assert.equal(many(1, '{n} member', '{n} members'), '1 member');
  assert.equal(many(2, '{n} member', '{n} members'), '2 members');
  await speak('zh');
  assert.equal(language.value, 'zh');
  assert.equal(t('Delete {n}', {n: 3}), '删除 3 行');
  assert.equal(many(1, '{n} member', '{n} members'), '1 根杆件');
  assert.equal(t('constructor'), 'constructor', 'no text of the dictionary’s prototype');
  await speak('en');
  assert.equal(t('Delete {n}', {n: 3}), 'Delete 3');
});

test('every text of the page has its Chinese', () => {
  assert.ok(written.size > 500, `${written.size} texts found`);
  assert.deepEqual([...written].filter((each) => /\p{L}{2}/u.test(each.replace(/\{\w+\}/g, '')) && !Object.hasOwn(texts, each)), []);
});

test('what the service lists has its Chinese', () => {
  const whats = files('posts', /\.json$/).map((path) => JSON.parse(text(path)).what);
  assert.ok(whats.length > 3 && summaries.length > 10);
  const views = [...under(contract.paths, 'x-views')].filter((name) => !Object.hasOwn(dictionary.words.values, name)).map(spaced);
  assert.ok(views.length > 8);
  assert.deepEqual([...summaries, ...whats, ...views].filter((each) => !Object.hasOwn(texts, each)), []);
  const translated = [...descriptions].filter((each) => Object.hasOwn(texts, each)).length;
  // A new description may be ahead of its Chinese, because the hint is then without it.
  assert.ok(descriptions.size > 200 && translated >= 0.9 * descriptions.size, `${translated} of ${descriptions.size} descriptions are translated`);
});

test('every example has a Chinese name', async () => {
  const {exampleName, speak: tell} = await load('src/names.ts', 'src/language.ts');
  await tell('zh');
  const names = files('examples', /^[a-z-]+\/[^/]+\.json$/).map((path) => path.slice('examples/'.length, -'.json'.length).split('/'));
  assert.ok(names.length > 60);
  const own = names.filter(([endpoint]) => endpoint !== 'commissioning' && endpoint !== 'machines');
  assert.deepEqual(own.filter(([endpoint, name]) => !han.test(exampleName(endpoint, name))), []);
});

test('no Chinese text is of an English one that nobody shows', async () => {
  const {exampleName} = await load('src/names.ts');
  const examples = files('examples', /\.json$/).map((path) => path.slice('examples/'.length, -'.json'.length).split('/')).map(([endpoint, name]) => exampleName(endpoint, name ?? ''));
  const whats = files('posts', /\.json$/).map((path) => JSON.parse(text(path)).what);
  const shown = new Set([...written, ...descriptions, ...summaries, ...choices, ...examples, ...whats, 'true', 'false', 'pulses', 'deg', 'periods']);
  assert.deepEqual(Object.keys(texts).filter((each) => !shown.has(each)), []);
});

test('a text and its Chinese have the same places for values', () => {
  const places = (of) => (of.match(/\{\w+\}/g) ?? []).sort().join();
  for (const all of [texts, dictionary.captions]) {
    assert.deepEqual(Object.entries(all).filter(([english, chinese]) => /\{\w+\}/.test(english) && places(english) !== places(chinese)), []);
    assert.deepEqual(Object.entries(all).filter(([, chinese]) => chinese.trim() === ''), []);
  }
});

test('every code of an error and of a warning has its sentences, and there is no other', () => {
  for (const [kind, header] of [['errors', 'core/base/error_codes.hpp'], ['warnings', 'core/base/warning_codes.hpp']]) {
    const rows = [...text(header).matchAll(/^ {2}X\((\w+),/gm)].map(([, code]) => code);
    assert.ok(rows.length > 30, header);
    assert.deepEqual(Object.keys(codes[kind]).sort(), rows.sort(), header);
    for (const [code, said] of Object.entries(codes[kind])) {
      assert.equal(said.length, 2, code);
      for (const sentence of said) assert.ok(han.test(sentence) && sentence.endsWith('。'), `${code}: ${sentence}`);
    }
  }
});

test('every name of the glossary has its Chinese, with a meaning where the English has one', async () => {
  const {words, chineseWords} = await load('glossary/words.ts');
  const [english, chinese] = [words, chineseWords].map((of) => of(text('docs/glossary.md')));
  for (const [section, rows] of Object.entries(english)) {
    assert.ok(Object.keys(rows).length > 15, section);
    for (const [key, [name, about]] of Object.entries(rows)) {
      const [called = '', meaning = ''] = chinese[section][key] ?? [];
      assert.ok(called !== '', `${section}: ${key}`);
      assert.ok(han.test(called) || /^[\p{Lu}\p{Script=Greek}A-Za-z0-9 -]{1,10}$/u.test(called), `${key}: ${called}`);
      assert.equal(meaning !== '', about !== '', `${key} (${name}): ${meaning}`);
    }
  }
  const terms = text('docs/glossary.md').split('\n## Names of fields')[0].split('\n').filter((line) => /^\| (?!symbol|word)/.test(line));
  assert.ok(terms.length > 130);
  for (const line of terms) assert.ok(han.test(line.split('|').at(-3)), line);
});

test('an error is said by its code, with its value, limit and unit, and the service’s own words beside it', async () => {
  const {said, originalOf, place, speak: tell} = await load('src/hint.ts', 'src/words.ts', 'src/language.ts');
  const issue = {pointer: '/cutters/1/wall_mm', code: 'out_of_range', got: 200, limit: 35, unit: 'mm', hint: 'must be less than the radius', alternatives: []};
  assert.equal(originalOf(issue), '');
  await tell('zh');
  assert.equal(place(issue.pointer), '相贯管 2，壁厚');
  assert.equal(said(issue), '数值超出允许范围（给定值 200 mm，限值 35 mm）。请输入限值以内的数值。');
  assert.equal(originalOf({...issue, hint: 'wall_mm must be less than 35.00000001 mm'}), 'wall must be less than 35 mm', 'in English throughout');
  assert.match(said({...issue, got: undefined, limit: null, code: 'missing_field'}), /^缺少必填字段。/);
  assert.doesNotMatch(said({...issue, got: {a: 1}, limit: [1, 2]}), /object/i);
});

test('a caption of a drawing is translated with its values, and a name is not', async () => {
  const {caption, speak: tell} = await load('src/captions.ts', 'src/language.ts');
  const {namesIn} = await load('src/drawing.ts');
  const english = '3  cut the finish, scrap towards the free end, from 1335.02 to 1441.21';
  assert.equal(caption(english), english);
  await tell('zh');
  assert.equal(caption(english), '3 切末端，废料在自由端，从 1335.02 到 1441.21');
  assert.equal(caption('reasons: torch range binds, root opens'), '理由：受割炬摆角限制，根部间隙加大');
  assert.equal(caption('warning: root opens at contact: by up to 2.17 mm'), '警告：根部间隙加大（接触缘）：by up to 2.17 mm');
  assert.equal(caption('start by $& {n} (x.*)'), '起端由 $& {n} (x.*) 切割');
  assert.equal(caption('tubecut 0.1.0, input 1dbd, result 72cd'), 'tubecut 0.1.0，输入 1dbd，结果 72cd');
  for (const name of ['B1', 'bolt.0', 'P-7 for B', '', 'constructor']) assert.equal(caption(name), name);
  const names = namesIn({target: {id: 'wall', kind: 'tube'}, members: [{id: 'B1', joints: [{member: 'C1', kind: 'set_on'}]}], reference: {order: 'girth'}, surfaces: ['outer']});
  assert.deepEqual([...names].sort(), ['B1', 'C1', 'girth', 'wall']);
});

test('no view shows a text that is only English', () => {
  const ours = new Set(['tubecut', 'tubecut:', 'API', 'English']);
  const named = new Set(['title', 'aria-label', 'placeholder', 'alt', 'aria-valuetext']);
  const found = [];
  for (const source of sources.filter(({fileName}) => fileName.endsWith('.tsx'))) {
    walk(source, (node) => {
      const shown = ts.isJsxText(node) ? [node.text.trim()]
        : ts.isJsxAttribute(node) && named.has(node.name.getText()) && node.initializer ? literals(ts.isJsxExpression(node.initializer) ? node.initializer.expression : node.initializer)
          : ts.isJsxExpression(node) && node.expression && !ts.isJsxAttribute(node.parent) ? literals(node.expression) : [];
      found.push(...shown.filter((each) => /[A-Za-z]{3}/.test(each) && !ours.has(each)).map((each) => `${source.fileName}: ${each}`));
    });
  }
  assert.deepEqual(found, []);
});
