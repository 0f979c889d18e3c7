/**
 * The names of wire names in docs/glossary.md: `fields`, `checks`, `limits` of an answer's
 * verification, and `values`; each has a name and a sentence.
 */
export type Words = Record<'fields' | 'checks' | 'limits' | 'values', Record<string, [string, string]>>;

const sections: [RegExp, keyof Words][] = [
  [/^Names (of fields|in answers)$/, 'fields'],
  [/^Names of checks$/, 'checks'],
  [/^Names of limits$/, 'limits'],
  [/^Names of warnings/, 'values'],
];

/** Rows of the sections with names: wire name, name, sentence, Chinese. */
function* rows(markdown: string): Generator<[into: keyof Words, key: string, name: string, about: string, chinese: string]> {
  let into: keyof Words | undefined;
  for (const line of markdown.split('\n')) {
    const heading = /^## (.*)$/.exec(line)?.[1];
    if (heading !== undefined) into = sections.find(([pattern]) => pattern.test(heading))?.[1];
    const [, key, name, about = '', chinese = ''] = /^\| `([^`]+)` \| ([^|]*) \| ([^|]*)\|(?: ([^|]*)\|)?$/.exec(line) ?? [];
    if (into && key && name) yield [into, key, name.trim(), about.trim(), chinese.trim()];
  }
}

const none = (): Words => ({fields: {}, checks: {}, limits: {}, values: {}});

export function words(markdown: string): Words {
  const out = none();
  for (const [into, key, name, about] of rows(markdown)) out[into][key] = [name, about];
  return out;
}

/** The same in Chinese: the name, and after a colon the sentence. */
export function chineseWords(markdown: string): Words {
  const out = none();
  for (const [into, key, , , chinese] of rows(markdown)) {
    const [, name = '', about = ''] = /^([^：]*)(?:：(.*))?$/.exec(chinese) ?? [];
    if (name) out[into][key] = [name, about];
  }
  return out;
}
