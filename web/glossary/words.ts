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

export function words(markdown: string): Words {
  const out: Words = {fields: {}, checks: {}, limits: {}, values: {}};
  let into: keyof Words | undefined;
  for (const line of markdown.split('\n')) {
    const heading = /^## (.*)$/.exec(line)?.[1];
    if (heading !== undefined) into = sections.find(([pattern]) => pattern.test(heading))?.[1];
    const [, key, name, about] = /^\| `([^`]+)` \| ([^|]*) \| ([^|]*)\|$/.exec(line) ?? [];
    if (into && key && name) out[into][key] = [name.trim(), (about ?? '').trim()];
  }
  return out;
}
