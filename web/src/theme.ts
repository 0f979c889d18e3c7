import {byId} from './dom';

/** Light or dark: what was chosen last, else what the system says. */
export function themed(recolour: () => void): void {
  const system = matchMedia('(prefers-color-scheme: dark)');
  const button = byId('theme');
  const apply = () => {
    let chosen: string | null = null;
    try {
      chosen = localStorage.getItem('theme');
    } catch {
      /* no storage: the system's */
    }
    const dark = chosen ? chosen === 'dark' : system.matches;
    document.documentElement.dataset['theme'] = dark ? 'dark' : 'light';
    button.textContent = dark ? 'Light' : 'Dark';
    button.setAttribute('aria-label', dark ? 'Switch to light' : 'Switch to dark');
    recolour();
  };
  button.addEventListener('click', () => {
    try {
      localStorage.setItem('theme', document.documentElement.dataset['theme'] === 'dark' ? 'light' : 'dark');
    } catch {
      /* not remembered */
    }
    apply();
  });
  system.addEventListener('change', apply);
  apply();
}
