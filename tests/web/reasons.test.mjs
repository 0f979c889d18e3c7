// The reasons of the readers of models (clients/import) in Chinese: the console finds them by their English, with places for values.
import {strict as assert} from 'node:assert';
import {readdirSync, readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import test from 'node:test';
import {load} from './load.mjs';

const root = new URL('../../', import.meta.url);
const ts = createRequire(new URL('web/package.json', root))('typescript');
const folder = new URL('clients/import/src/', root);
const read = (url, name) => ts.createSourceFile(name, readFileSync(url, 'utf8'), ts.ScriptTarget.Latest, true);
const sources = readdirSync(folder, {recursive: true}).filter((name) => name.endsWith('.ts') && name !== 'main.ts') // the texts of a command line
  .map((name) => read(new URL(name, folder), name))
  .concat(['model.ts', 'import_worker.ts'].map((name) => read(new URL(`web/src/${name}`, root), name))); // the worker that runs them, which knows no language
const {cause, speak} = await load('src/captions.ts', 'src/language.ts');

const walk = (node, act) => {
  act(node);
  ts.forEachChild(node, (each) => walk(each, act));
};
const textual = (node) => ts.isStringLiteralLike(node) || ts.isTemplateExpression(node)
  || (ts.isConditionalExpression(node) && textual(node.whenTrue) && textual(node.whenFalse));

/** Constants that hold a phrase, with the block in which each is known; exported ones are known everywhere. */
const constants = [];
for (const source of sources) {
  walk(source, (node) => {
    if (!ts.isVariableDeclaration(node) || !node.initializer || !textual(node.initializer) || !node.initializer.getText().includes(' ')) return;
    const statement = node.parent.parent;
    constants.push({name: node.name.getText(), text: node.initializer, block: statement.getText().startsWith('export ') ? undefined : statement.parent});
  });
}

const isWithin = (node, block) => Boolean(node) && (node === block || isWithin(node.parent, block));

/** All texts of an expression, of one thing or of several, with a sample for each value that only a file has. */
function textsOf(node, sample, single) {
  const of = (each) => textsOf(each, sample, single);
  if (ts.isStringLiteralLike(node)) return [node.text];
  if (ts.isParenthesizedExpression(node)) return of(node.expression);
  if (ts.isConditionalExpression(node) && node.condition.getText().endsWith('=== 1')) return of(single ? node.whenTrue : node.whenFalse);
  if (ts.isConditionalExpression(node)) return [node.whenTrue, node.whenFalse].flatMap(of);
  if (ts.isBinaryExpression(node) && ['??', '||'].includes(node.operatorToken.getText())) return [node.left, node.right].flatMap(of);
  if (ts.isTemplateExpression(node)) {
    return node.templateSpans.reduce((texts, span) => {
      const values = of(span.expression);
      return texts.flatMap((text) => values.map((value) => text + value + span.literal.text));
    }, [node.head.text]);
  }
  const constant = ts.isIdentifier(node) && constants.find(({name, block}) => name === node.text && (!block || isWithin(node, block)));
  if (constant) return of(constant.text);
  return [/\btold\(|^who$/.test(node.getText()) ? '#12 IFCBEAM' : sample];
}

/** Every expression that is a reason, the place of one, or a part of it. */
function reasons() {
  const found = [];
  const named = new Set(['reason', 'text', 'why', 'assumed', 'id']);
  for (const source of sources) {
    walk(source, (node) => {
      if (ts.isNewExpression(node) && /Trouble|Cornerless|Error/.test(node.expression.getText())) found.push(...(node.arguments ?? []));
      if (ts.isCallExpression(node) && /^(?:at|tell|lost|.*\.tell)$/.test(node.expression.getText())) found.push(...node.arguments.filter(textual));
      if (ts.isPropertyAssignment(node) && named.has(node.name.getText()) && textual(node.initializer)) found.push(node.initializer);
      if (ts.isFunctionDeclaration(node) && node.name?.text === 'uncut') walk(node, (each) => ts.isReturnStatement(each) && each.expression && found.push(each.expression));
    });
  }
  return found;
}

const samples = ['7', 'NPS 6', 'row 7', 'a thread', 'NPS 6 (DN) or NPS 4 (DN)'];
const untranslated = (text) => /\p{Ll}{2,} \p{Ll}{2,}/u.test(text) || !/\p{Script=Han}/u.test(text);

test('each reason of a reader has its Chinese, with its values', async () => {
  await speak('zh');
  const missing = new Set();
  let count = 0;
  for (const node of reasons()) {
    const bySample = samples.map((sample) => [true, false].flatMap((single) => textsOf(node, sample, single)));
    bySample[0].forEach((text, i) => {
      if (!/[a-z]{2,} /.test(text)) return; // a name
      count += 1;
      if (bySample.every((texts) => untranslated(cause(texts[i])))) missing.add(text);
    });
  }
  assert.ok(count > 190, `${count}`);
  assert.deepEqual([...missing], []);
});

test('a reason keeps its values, and an unknown one is said as it is', async () => {
  await speak('zh');
  assert.equal(cause('#12 IFCBEAM has more than one Body'), '#12 IFCBEAM 有多个实体（Body）');
  assert.equal(cause('assumed: no up_x, up_y and up_z for rows 3, 4: the height lies along +z, and of a tube within 1 deg of the vertical along +x'),
    '假定：第 3, 4 行没有 up_x、up_y、up_z：截面高度沿 +z；与竖直方向相差不到 1° 的管沿 +x');
  assert.equal(cause('a rectangular tube of 100 x 50 mm, named box: it is not in the frame, because it is no member'), '矩形管 100 x 50 mm，名称 box：它不在框架中；原因：它不是杆件');
  assert.equal(cause('2 INCH is the bore of 3 components, probably NPS 6 (DN) or NPS 4 (its outside diameter in inches): state --bore "2=NPS 6"'),
    '2 INCH 是 3 个元件的口径，可能是 NPS 6（DN） 或 NPS 4（外径，英寸）：请给出此口径的尺寸');
  for (const text of ['line 12', 'row 12', 'layer TUBES', 'file']) assert.match(cause(text), /\p{Script=Han}/u);
  for (const text of ['PIPE', '#12', 'a reason of the future']) assert.equal(cause(text), text);
  await speak('en');
  assert.equal(cause('row 12'), 'row 12');
});
