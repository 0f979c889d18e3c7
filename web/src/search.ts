/** Words and numbers of a text: "CHS 114.3x6.3" has chs, 114.3 and 6.3. */
const parts = (text: string) => text.toLowerCase().match(/\d+(?:[.,/-]\d+)*|[^\d\s.,;x×_-]+/g) ?? [];
const same = (text: string) => parts(text).join(' ').replace(/,/g, '.');

/** The names that have every part of what is typed, in any order: those that have it as a whole part come first. */
export function found(names: string[], typed: string): string[] {
  const wanted = same(typed).split(' ').filter(Boolean);
  const whole: string[] = [];
  const begun: string[] = [];
  for (const name of names) {
    const own = same(name).split(' ');
    if (wanted.every((each) => own.includes(each))) whole.push(name);
    else if (wanted.every((each) => own.some((part) => part.includes(each)))) begun.push(name);
  }
  return [...whole, ...begun];
}

/** The one name that is meant, however it is spelled; of several, the one that has no other part. */
export function onlyOne(names: string[], typed: string): string | undefined {
  const exact = names.filter((name) => same(name) === same(typed));
  if (exact.length) return exact[0];
  const all = found(names, typed);
  return all.length === 1 ? all[0] : undefined;
}
