import {dark, turn} from '../theme';

export const ThemeButton = () => (
  <button id="theme" type="button" aria-label={dark.value ? 'Switch to light' : 'Switch to dark'} onClick={turn}>
    {dark.value ? 'Light' : 'Dark'}
  </button>
);
