import {t} from '../language';
import {dark, turn} from '../theme';

export const ThemeButton = () => (
  <button id="theme" type="button" aria-label={dark.value ? t('Switch to light') : t('Switch to dark')} onClick={turn}>
    {dark.value ? t('Light') : t('Dark')}
  </button>
);
