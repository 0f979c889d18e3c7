import type {ComponentChildren} from 'preact';
import {useLayoutEffect, useRef, useState} from 'preact/hooks';
import {later, t} from '../language';
import {listen, pointed} from '../links';

interface Pressed {
  id: string;
  pressed: boolean;
  act(): void;
  children: ComponentChildren;
}
/** A button that stays pressed. */
export const Toggle = ({id, pressed, act, children}: Pressed) => (
  <button type="button" id={id} aria-pressed={pressed} onClick={act}>
    {children}
  </button>
);

interface Tabs {
  offered: [id: string, name: string][];
  chosen: string;
  choose(id: string): void;
  label?: string;
  panel?: string;
}
/** Tabs, of which the arrow keys choose the neighbour. */
export function TabBar({offered, chosen, choose, label = t('Details'), panel = 'panel'}: Tabs) {
  const root = useRef<HTMLDivElement>(null);
  const took = useRef(false);
  const take = (id: string) => {
    took.current = id !== chosen;
    choose(id);
  };
  useLayoutEffect(() => {
    if (took.current) root.current?.querySelector<HTMLElement>('[aria-selected=true]')?.focus();
    took.current = false;
  }, [chosen]);
  const walk = (event: KeyboardEvent, i: number) => {
    const by = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
    if (by) take((offered[(i + by + offered.length) % offered.length] as [string, string])[0]);
  };
  return (
    <div ref={root} role="tablist" class="tabs" aria-label={label}>
      {offered.map(([id, name], i) => (
        <button
          type="button"
          role="tab"
          key={id}
          id={`tab-${id}`}
          aria-selected={id === chosen}
          aria-controls={panel}
          tabIndex={id === chosen ? 0 : -1}
          onClick={() => take(id)}
          onKeyDown={(event) => walk(event, i)}
        >
          {name}
        </button>
      ))}
    </div>
  );
}

/** A colour of the style sheet next to its meaning. */
export const Swatch = ({tone}: {tone: string}) => <span class="swatch" style={{background: `var(--${tone})`}} />;
/** Partners keep their colour in every view. */
export const partnerTone = (index: number) => `partner-${index % 6}`;

/** Returns the position of a link's cursor. */
export function useCursor(link: string): number | null {
  const [at, move] = useState(() => pointed(link));
  useLayoutEffect(() => {
    move(pointed(link));
    return listen(link, move);
  }, [link]);
  return at;
}

/** A button that copies, and reports whether it did. */
export function Copier({name, text}: {name: string; text(): string}) {
  const [said, say] = useState<string | null>(null);
  const copy = async () => {
    say((await copied(text())) ? later('Copied') : later('Could not copy'));
    setTimeout(() => say(null), 1500);
  };
  return (
    <button type="button" onClick={copy}>
      {said === null ? name : t(said)}
    </button>
  );
}

export async function copied(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    // not a secure context: the old way
    const area = Object.assign(document.createElement('textarea'), {className: 'offscreen', value: text});
    document.body.append(area);
    area.select();
    const done = document.execCommand('copy');
    area.remove();
    return done;
  }
}
