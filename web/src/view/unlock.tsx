import {useState} from 'preact/hooks';
import {give, keyed} from '../key';
import {later, t} from '../language';

/** Requests the key in place of an answer, then continues. */
export function Unlock({go}: {go(): void}) {
  const [title, say] = useState(keyed() ? later('Invalid API key.') : later('This service requires an API key.'));
  const [text, type] = useState('');
  const [going, went] = useState(false);
  const enter = (event: Event) => {
    event.preventDefault();
    const given = text.trim();
    if (!/^[!-~]+$/.test(given)) return say(given ? later('A key cannot contain such characters.') : later('Enter a key.'));
    give(given);
    went(true);
    go();
  };
  return (
    <form class={`verdict ${keyed() ? 'bad' : 'warn'} unlock`} noValidate onSubmit={enter}>
      <p>
        <span class="pill">{t('key')}</span>
        <b role="status">{t(title)}</b>
        <label>
          {t('Key')}
          <input
            type="password"
            autocomplete="off"
            spellcheck={false}
            required
            value={text}
            onInput={(event) => type(event.currentTarget.value)}
            ref={(input) => {
              if (document.activeElement === document.body) input?.focus();
            }}
          />
        </label>
        <button type="submit" disabled={going}>
          {t('Use this key')}
        </button>
      </p>
      <p class="soft">
        {t(
          'Whoever runs the service gives keys out. This page holds yours only in its memory: another page requests it again, and so does this one when it is loaded anew.',
        )}
      </p>
    </form>
  );
}
