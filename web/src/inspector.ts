import {swatch, tabBar} from './controls';
import {el} from './dom';
import type {Row} from './json';
import {chosen, listen, point, pointed} from './links';
import * as panels from './panels';
import type {Facts, Inspected, Item} from './picture';
import {sentence} from './words';

const most = 1000; // rows of a list; of more, the others are chosen in the picture

interface Ways {
  open(endpoint: string, body: Row): void;
  focus(pointer: string): void;
  chose(item: number | null): void;
}

/** Lists beside a picture: what is chosen in one of them or in the solid is told in full, and leads to what belongs to it. */
export class Inspector {
  private lists: Inspected['lists'] = [];
  private link = '';
  private shown = '';
  private forget: (() => void)[] = [];
  private readonly facts = el('div', {class: 'facts', 'aria-live': 'polite'});
  private box: HTMLElement = el('div');

  constructor(
    private readonly root: HTMLElement,
    private readonly ways: Ways,
  ) {}

  /** `item` is chosen where nothing is yet. */
  show(given: Inspected | undefined, item: number | null = null): void {
    this.forget.forEach((each) => each());
    this.forget = [];
    this.root.hidden = !given;
    this.lists = given?.lists ?? [];
    this.link = given?.link ?? '';
    if (!given) {
      this.root.replaceChildren();
      return;
    }
    if (!this.lists.some(({id}) => id === this.shown)) this.shown = this.lists[0]?.id ?? '';
    this.draw();
    const kept = chosen(this.link);
    const took = (index: number | null) => {
      this.choose(index);
      this.ways.chose(index);
    };
    this.forget = [listen(this.link, () => this.mark()), listen(kept, took)];
    if (pointed(kept) === null && this.item(item)) point(kept, item);
    else this.choose(pointed(kept));
  }

  private start(id: string): number {
    const at = this.lists.findIndex((list) => list.id === id);
    return this.lists.slice(0, at).reduce((sum, {items}) => sum + items.length, 0);
  }

  private item(index: number | null): Item | undefined {
    return index === null ? undefined : this.lists.flatMap(({items}) => items)[index];
  }

  private choose(index: number | null): void {
    const holder = index === null ? undefined : this.lists.find(({id, items}) => index >= this.start(id) && index < this.start(id) + items.length);
    if (!holder || holder.id === this.shown) this.mark();
    else this.turn(holder.id);
    const item = this.item(index);
    this.facts.replaceChildren(...(item ? this.told(item) : [el('p', {class: 'soft'}, 'Choose one in the list or in the picture.')]));
  }

  private turn(id: string): void {
    this.shown = id;
    this.draw();
  }

  private draw(): void {
    const tabs = this.lists.map(({id, title, items}): [string, string] => [id, `${title} (${items.length})`]);
    const turn = (id: string) => {
      this.turn(id);
      this.root.querySelector<HTMLElement>('[role=tab][aria-selected=true]')?.focus();
    };
    this.box = this.list();
    const count = this.lists.find(({id}) => id === this.shown)?.items.length ?? 0;
    const rest = count > most ? [el('p', {class: 'soft'}, `The first ${most} of ${count}; the others are chosen in the picture.`)] : [];
    this.root.replaceChildren(tabBar(tabs, this.shown, turn, {label: 'Lists', panel: 'items'}), this.box, ...rest, this.facts);
    this.mark();
  }

  private list(): HTMLElement {
    const items = this.lists.find(({id}) => id === this.shown)?.items ?? [];
    const first = this.start(this.shown);
    const options = items.slice(0, most).map(({name, detail, mark}, i) => {
      return el(
        'div',
        {
          role: 'option',
          id: `item-${first + i}`,
          onclick: () => point(chosen(this.link), first + i),
          onpointerenter: () => point(this.link, first + i),
          onpointerleave: () => point(this.link, null),
        },
        mark ? swatch(mark.tone) : null,
        el('b', {}, name),
        el('span', {class: 'soft'}, detail),
        mark ? el('span', {class: 'mark'}, mark.text) : null,
      );
    });
    const label = this.lists.find(({id}) => id === this.shown)?.title;
    return el(
      'div',
      {id: 'items', role: 'listbox', tabindex: '0', 'aria-label': label, onkeydown: (event: KeyboardEvent) => this.walk(event, first, options.length)},
      ...options,
    );
  }

  private walk(event: KeyboardEvent, first: number, count: number): void {
    const now = pointed(chosen(this.link));
    const at = now === null ? -1 : now - first;
    const to = {ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: count - 1}[event.key];
    if (event.key === 'Escape') point(chosen(this.link), null);
    if (to === undefined) return;
    event.preventDefault();
    point(chosen(this.link), first + Math.min(count - 1, Math.max(0, to)));
  }

  /** The rows of what is chosen and of what is pointed at. */
  private mark(): void {
    const [kept, over] = [pointed(chosen(this.link)), pointed(this.link)];
    for (const row of this.box.children) {
      row.setAttribute('aria-selected', String(row.id === `item-${kept}`));
      row.classList.toggle('pointed', row.id === `item-${over}`);
    }
    const row = this.box.querySelector<HTMLElement>('[aria-selected=true]');
    if (row) this.box.setAttribute('aria-activedescendant', row.id);
    else this.box.removeAttribute('aria-activedescendant');
    if (!row) return;
    // Not scrollIntoView: that moves the page as well.
    const {offsetTop: top, offsetHeight: height} = row;
    const {scrollTop: from, clientHeight: seen} = this.box;
    if (top < from) this.box.scrollTop = top;
    else if (top + height > from + seen) this.box.scrollTop = top + height - seen;
  }

  private told(item: Item): HTMLElement[] {
    const facts: Facts = item.facts();
    const figures = el('div', {class: 'figures'});
    panels.figures(figures, facts);
    const {opens, leads} = facts;
    return [
      el(
        'h3',
        {},
        item.mark ? swatch(item.mark.tone) : null,
        item.name,
        item.mark ? el('span', {class: 'soft'}, item.mark.text) : null,
        opens ? el('button', {type: 'button', class: 'right', id: 'open-item', onclick: () => this.ways.open(opens.endpoint, opens.body)}, opens.name) : null,
      ),
      ...facts.said.map((each) => el('p', {}, sentence(each))),
      figures,
      ...(facts.warnings.length ? [el('ul', {}, ...facts.warnings.map((warning) => panels.told(warning, this.ways.focus)))] : []),
      ...(leads.length ? [el('div', {class: 'offers'}, ...leads.map(({name, to}) => this.lead(name, to)))] : []),
    ];
  }

  private lead(name: string, to: number): HTMLElement {
    return el('button', {type: 'button', onclick: () => point(chosen(this.link), to)}, name);
  }
}
