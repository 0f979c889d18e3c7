import type {Signal} from '@preact/signals';
import {useId, useLayoutEffect, useRef, useState} from 'preact/hooks';
import {t} from '../language';
import {found, onlyOne} from '../search';

interface Given {
  value: string;
  names: string[];
  placeholder?: string | Signal<string>;
  shared: object;
  change(value: string | undefined): void;
}
const most = 60; // of a long list; what is typed makes it short

/** A name out of a list that is searched by what is typed. What is no name of the list is not taken, so that nobody has to spell one. */
export function Combo({value, names, placeholder, shared, change}: Given) {
  const input = useRef<HTMLInputElement>(null);
  const list = useRef<HTMLDivElement>(null);
  const [typed, type] = useState<string | null>(null); // null: nothing is searched for
  const [at, move] = useState(0);
  const [current, keep] = useState(value);
  const shown = typed === null ? [] : found(names, typed === current ? '' : typed).slice(0, most);
  const open = shown.length > 0;
  const id = useId();
  useLayoutEffect(() => keep(value), [value]);
  useLayoutEffect(() => {
    const [box, popup] = [input.current, list.current];
    if (!open || !box || !popup) return;
    const {left, top, bottom, width} = box.getBoundingClientRect();
    const under = innerHeight - bottom > 180 || top < 180;
    popup.showPopover();
    Object.assign(popup.style, {
      left: `${Math.min(left, innerWidth - 228)}px`,
      minWidth: `${Math.max(width, 220)}px`,
      top: under ? `${bottom + 2}px` : 'auto',
      bottom: under ? 'auto' : `${innerHeight - top + 2}px`,
    });
    popup.querySelector('[aria-selected=true]')?.scrollIntoView({block: 'nearest'});
  });
  const search = (text: string | null) => {
    type(text);
    move(text === null || text === current ? Math.max(0, names.indexOf(current)) : 0);
  };
  const take = (name: string | undefined) => {
    if (input.current) input.current.value = name ?? '';
    type(null);
    if ((name ?? '') === current) return;
    keep(name ?? '');
    change(name);
  };
  const leave = () => {
    if (typed === null) return;
    take(typed.trim() === '' ? undefined : (onlyOne(names, typed) ?? (current || undefined)));
  };
  const walk = (event: KeyboardEvent) => {
    const by = event.key === 'ArrowDown' ? 1 : event.key === 'ArrowUp' ? -1 : 0;
    if (by && typed === null) search(current);
    else if (by) move(Math.min(shown.length - 1, Math.max(0, at + by)));
    else if (event.key === 'Enter' && open) take(shown[at]);
    else if (event.key === 'Escape' && typed !== null) take(current || undefined);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <>
      <input
        ref={input}
        type="text"
        role="combobox"
        aria-expanded={open}
        aria-controls={id}
        aria-autocomplete="list"
        aria-activedescendant={open ? `${id}-${at}` : undefined}
        autocomplete="off"
        spellcheck={false}
        placeholder={placeholder}
        value={typed ?? current}
        {...shared}
        onInput={(event) => search(event.currentTarget.value)}
        onClick={() => typed === null && search(current)}
        onKeyDown={walk}
        onBlur={leave}
      />
      {open && (
        <div
          ref={list}
          id={id}
          class="choices"
          role="listbox"
          popover="manual"
          aria-label={t('Choices')}
          onPointerDown={(event) => event.preventDefault() /* the field keeps the focus */}
          onClick={(event) => event.preventDefault() /* and its label does not open the list again */}
        >
          {shown.map((name, i) => (
            <div key={name} id={`${id}-${i}`} role="option" aria-selected={i === at} onClick={() => take(name)}>
              {name}
            </div>
          ))}
        </div>
      )}
    </>
  );
}
