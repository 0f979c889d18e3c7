import {el} from './dom';

/** A button that stays pressed. */
export const toggle = (text: string, pressed: boolean, id: string, act: () => void) =>
  el('button', {type: 'button', id: id, 'aria-pressed': String(pressed), onclick: act}, text);

/** Tabs, of which the arrow keys choose the neighbour. */
export const tabBar = (offered: [string, string][], chosen: string, choose: (id: string) => void, {label, panel} = {label: 'Details', panel: 'panel'}) =>
  el(
    'div',
    {role: 'tablist', class: 'tabs', 'aria-label': label},
    ...offered.map(([id, name], i) =>
      el(
        'button',
        {
          type: 'button',
          role: 'tab',
          id: `tab-${id}`,
          'aria-selected': String(id === chosen),
          'aria-controls': panel,
          tabindex: id === chosen ? '0' : '-1',
          onclick: () => choose(id),
          onkeydown: (event: KeyboardEvent) => {
            const by = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
            if (by) choose((offered[(i + by + offered.length) % offered.length] as [string, string])[0]);
          },
        },
        name,
      ),
    ),
  );

/** A colour of the style sheet beside what it stands for. */
export function swatch(tone: string): HTMLElement {
  const dot = el('span', {class: 'swatch'});
  dot.style.background = `var(--${tone})`;
  return dot;
}
export const key = (tone: string, text: string) => el('span', {class: 'key'}, swatch(tone), ` ${text}`);
