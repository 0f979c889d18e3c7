import type {Console} from '../console';
import {choose, language, t} from '../language';

/** The other language, in its own words, because who looks for it may not read those of the page. */
export function LanguageButton({console}: {console: Console | undefined}) {
  const chinese = language.value === 'zh';
  const turn = () => void (console ? console.speak(chinese ? 'en' : 'zh') : choose(chinese ? 'en' : 'zh'));
  return (
    <button
      id="language"
      type="button"
      lang={chinese ? 'en' : 'zh-CN'}
      title={t('The page in Chinese or in English; files and JSON stay as they are')}
      onClick={turn}
    >
      {chinese ? 'English' : '中文'}
    </button>
  );
}
