import {computed, signal} from '@preact/signals';
import type {Dictionary} from './chinese';
import {filled, type Values} from './texts';

export {later, type Values} from './texts';

export type Language = 'en' | 'zh';

const key = 'language';

/** Without a storage nothing is remembered. */
function stored(): string | null {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
}

/** Returns the language of a reader: the last choice, else that of the browser. */
export const languageOf = (chosen: string | null, browser: string | undefined): Language =>
  chosen === 'en' || chosen === 'zh' ? chosen : /^zh\b/i.test(browser ?? '') ? 'zh' : 'en';
export const wanted = (): Language => languageOf(stored(), globalThis.navigator?.language);

/** The Chinese texts, or nothing: the page is English then, because English texts are the keys. */
const spoken = signal<Dictionary | undefined>(undefined);
export const chinese = (): Dictionary | undefined => spoken.value;
export const language = computed<Language>(() => (spoken.value ? 'zh' : 'en'));
/** As Intl and the `lang` of an element name it. */
export const locale = (): string | undefined => (spoken.value ? 'zh-CN' : undefined);

/** Returns a text in the language of the page. */
export function t(text: string, values: Values = {}): string {
  const texts = spoken.value?.texts ?? {};
  return filled(Object.hasOwn(texts, text) ? (texts[text] as string) : text, values);
}
/** Returns a count in words: `{n}` is the number. */
export const many = (n: number, one: string, more: string, values: Values = {}): string => t(n === 1 ? one : more, {n, ...values});

/** Speaks a language. The Chinese texts come when they are first wanted, so that the English page loads without them. */
export async function speak(to: Language): Promise<void> {
  spoken.value = to === 'zh' ? (await import('./chinese')).dictionary : undefined;
  if (globalThis.document) document.documentElement.lang = to === 'zh' ? 'zh-CN' : 'en';
}

/** Speaks a language from now on, also when the page is loaded again. */
export async function choose(to: Language): Promise<void> {
  await speak(to);
  try {
    localStorage.setItem(key, to);
  } catch {
    /* not remembered */
  }
}
