import {el} from './dom';

/** The key of a service that asks for one: in this page's memory alone, in no storage, address or link. */
let key = '';

export const keyed = () => key !== '';

/** A request's headers with the key in its own one, which leaves `Authorization` to a proxy in front. */
export const headed = (headers: Record<string, string> = {}): Record<string, string> => (key ? {...headers, 'X-Api-Key': key} : headers);

/** The service answered 401. */
export class KeyNeeded extends Error {}

/** Asks for the key where an answer would stand, then goes on. */
export function askForKey(root: HTMLElement, go: () => void): void {
  const input = el('input', {type: 'password', autocomplete: 'off', spellcheck: 'false', required: true});
  const button = el('button', {type: 'submit'}, 'Use this key');
  const title = el('b', {role: 'status'}, keyed() ? 'The service does not know this key.' : 'This service asks for a key.');
  const enter = (event: Event) => {
    event.preventDefault();
    const given = input.value.trim();
    if (!/^[!-~]+$/.test(given)) {
      title.textContent = given ? 'A key has no such characters.' : 'Enter a key.';
      return;
    }
    key = given;
    button.disabled = true;
    go();
  };
  root.replaceChildren(
    el(
      'form',
      {class: `verdict ${keyed() ? 'bad' : 'warn'} unlock`, novalidate: true, onsubmit: enter},
      el('p', {}, el('span', {class: 'pill'}, 'key'), title, el('label', {}, 'Key', input), button),
      el(
        'p',
        {class: 'soft'},
        'Whoever runs the service gives keys out. This page holds yours in its memory alone: another page asks again, and so does this one when it is loaded anew.',
      ),
    ),
  );
  if (document.activeElement === document.body) input.focus();
}
