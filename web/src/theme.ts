import {computed, effect, signal} from '@preact/signals';

const system = matchMedia('(prefers-color-scheme: dark)');
const wished = signal(system.matches);
system.addEventListener('change', () => {
  wished.value = system.matches;
});

/** Without a storage nothing is remembered. */
function stored(): string | null {
  try {
    return localStorage.getItem('theme');
  } catch {
    return null;
  }
}
const chosen = signal(stored());

/** Paper is light, whatever the theme. */
export const onWhite = signal(false);

/** Dark or light: the last choice, else the system's. */
export const dark = computed(() => !onWhite.value && (chosen.value ? chosen.value === 'dark' : wished.value));
effect(() => {
  document.documentElement.dataset['theme'] = dark.value ? 'dark' : 'light';
});

export function turn(): void {
  chosen.value = dark.value ? 'light' : 'dark';
  try {
    localStorage.setItem('theme', chosen.value);
  } catch {
    /* not remembered */
  }
}
