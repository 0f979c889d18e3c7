import {useLayoutEffect, useMemo, useRef, useState} from 'preact/hooks';
import type {Row} from '../json';
import {t} from '../language';
import {chosen, listen, point, pointed} from '../links';
import type {Inspected, Item} from '../picture';
import {sentence} from '../words';
import {Swatch, TabBar, useCursor} from './controls';
import {Figures} from './tables';
import {Told} from './verdict';

const most = 1000; // rows of a list; of more, the others are chosen in the picture

interface Ways {
  open(endpoint: string, body: Row): void;
  focus(pointer: string): void;
  chose(item: number | null): void;
}

/** Lists next to a picture: an item selected in one of them or in the solid is shown in full, and
 * leads to related ones. `item` is selected by default.
 */
export function Inspector({given, item, ways}: {given: Inspected; item: number | null; ways: Ways}) {
  const {link, lists} = given;
  const kept = chosen(link);
  const [turned, turn] = useState('');
  const all = useMemo(() => lists.flatMap(({items}) => items), [lists]);
  const start = (id: string) => {
    const at = lists.findIndex((list) => list.id === id);
    return lists.slice(0, at).reduce((sum, {items}) => sum + items.length, 0);
  };
  const holding = (index: number) => lists.find(({id, items}) => index >= start(id) && index < start(id) + items.length)?.id;
  useLayoutEffect(() => {
    const took = (index: number | null) => {
      const holder = index === null ? undefined : holding(index);
      if (holder) turn(holder);
      ways.chose(index);
    };
    const forget = listen(kept, took);
    if (pointed(kept) === null && item !== null && all[item]) point(kept, item);
    return forget;
  }, [given]);
  const at = useCursor(kept);
  const told = at === null ? undefined : all[at];
  const shown = lists.find(({id}) => id === turned) ?? lists[0];
  if (!shown) return null;
  return (
    <>
      <TabBar
        offered={lists.map(({id, title, items}) => [id, `${title} (${items.length})`])}
        chosen={shown.id}
        choose={turn}
        label={t('Lists')}
        panel="items"
      />
      <List link={link} title={shown.title} items={shown.items.slice(0, most)} first={start(shown.id)} />
      {shown.items.length > most && (
        <p class="soft">{t('The first {most} of {all}; the others are chosen in the picture.', {most, all: shown.items.length})}</p>
      )}
      <div class="facts" aria-live="polite" tabIndex={0} role="group" aria-label={t('The chosen item')}>
        {told ? <Facts item={told} link={link} ways={ways} /> : <p class="soft">{t('Choose one in the list or in the picture.')}</p>}
      </div>
    </>
  );
}

/** Rows of which one is chosen, and one pointed at. */
function List({link, title, items, first}: {link: string; title: string; items: Item[]; first: number}) {
  const box = useRef<HTMLDivElement>(null);
  const kept = useCursor(chosen(link));
  const over = useCursor(link);
  const there = kept !== null && kept >= first && kept < first + items.length;
  useLayoutEffect(() => {
    const row = box.current?.querySelector<HTMLElement>('[aria-selected=true]');
    if (!row || !box.current) return;
    // Not scrollIntoView: that moves the page as well.
    const {offsetTop: top, offsetHeight: height} = row;
    const {scrollTop: from, clientHeight: seen} = box.current;
    if (top < from) box.current.scrollTop = top;
    else if (top + height > from + seen) box.current.scrollTop = top + height - seen;
  }, [kept, over, first]);
  const walk = (event: KeyboardEvent) => {
    const now = pointed(chosen(link));
    const at = now === null ? -1 : now - first;
    const to = {ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: items.length - 1}[event.key];
    if (event.key === 'Escape') point(chosen(link), null);
    if (to === undefined) return;
    event.preventDefault();
    point(chosen(link), first + Math.min(items.length - 1, Math.max(0, to)));
  };
  return (
    <div ref={box} id="items" role="listbox" tabIndex={0} aria-label={title} aria-activedescendant={there ? `item-${kept}` : undefined} onKeyDown={walk}>
      {items.map(({name, detail, mark}, i) => (
        <div
          role="option"
          key={i}
          id={`item-${first + i}`}
          class={first + i === over ? 'pointed' : undefined}
          aria-selected={first + i === kept}
          onClick={() => point(chosen(link), first + i)}
          onPointerEnter={() => point(link, first + i)}
          onPointerLeave={() => point(link, null)}
        >
          {mark && <Swatch tone={mark.tone} />}
          <b>{name}</b>
          <span class="soft">{detail}</span>
          {mark && <span class="mark">{mark.text}</span>}
        </div>
      ))}
    </div>
  );
}

function Facts({item, link, ways}: {item: Item; link: string; ways: Ways}) {
  const {said, figures, warnings, leads, opens} = useMemo(() => item.facts(), [item]);
  return (
    <>
      <h3>
        {item.mark && <Swatch tone={item.mark.tone} />}
        {item.name}
        {item.mark && <span class="soft">{item.mark.text}</span>}
        {opens && (
          <button type="button" class="right" id="open-item" onClick={() => ways.open(opens.endpoint, opens.body)}>
            {opens.name}
          </button>
        )}
      </h3>
      {said.map((each) => (
        <p key={each}>{sentence(each)}</p>
      ))}
      <div class="figures">
        <Figures figures={figures} />
      </div>
      {warnings.length > 0 && (
        <ul>
          {warnings.map((warning, i) => (
            <Told key={i} warning={warning} focus={ways.focus} />
          ))}
        </ul>
      )}
      {leads.length > 0 && (
        <div class="offers">
          {leads.map(({name, to}) => (
            <button type="button" key={to} onClick={() => point(chosen(link), to)}>
              {name}
            </button>
          ))}
        </div>
      )}
    </>
  );
}
