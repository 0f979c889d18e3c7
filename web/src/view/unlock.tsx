import {useState} from 'preact/hooks';
import {give, keyed} from '../key';

/** Requests the key in place of an answer, then continues. */
export function Unlock({go}: {go(): void}) {
  const [title, say] = useState(keyed() ? 'Invalid API key.' : 'This service requires an API key.');
  const [text, type] = useState('');
  const [going, went] = useState(false);
  const enter = (event: Event) => {
    event.preventDefault();
    const given = text.trim();
    if (!/^[!-~]+$/.test(given)) return say(given ? 'A key cannot contain such characters.' : 'Enter a key.');
    give(given);
    went(true);
    go();
  };
  return (
    <form class={`verdict ${keyed() ? 'bad' : 'warn'} unlock`} noValidate onSubmit={enter}>
      <p>
        <span class="pill">key</span>
        <b role="status">{title}</b>
        <label>
          Key
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
          Use this key
        </button>
      </p>
      <p class="soft">
        Whoever runs the service gives keys out. This page holds yours in its memory alone: another page asks again, and so does this one when it is loaded
        anew.
      </p>
    </form>
  );
}
