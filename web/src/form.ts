import {el, partnerColour} from './dom';
import {at, isRow, join, put, type Json, type Row} from './json';
import {called, hintOf, offered, said} from './hint';
import {brief} from './names';
import type {Contract, Schema} from './schema';
import type {Issue} from './service';
import {unit} from './units';
import {choice, lastKey, sentence} from './words';

/** Names that a field can be filled with, besides what the contract says. */
export interface Choices {
  machines: string[];
  sizes: string[];
}

const aside = new Set(['log', 'numerics']); // belong to programs
const folded = new Set(['sampling', 'reference', 'accept', 'expert', 'check', 'table']); // closed until opened
const inlineList = 6; // longer lists of numbers get a text area
const inlineText = 28; // and so do those of more characters, which a phone's line holds

/** The request as a form, drawn from the contract's schema. Values are never checked here: the service is
 *  asked, and names the field. */
export class Form {
  private body: Row = {};
  private echo: Row = {};
  private schema: Schema = {};
  private inputs = new Map<string, HTMLElement>();
  private measuring = 0;
  private folds = new Map<string, boolean>(); // what was opened or closed by hand, by pointer

  constructor(
    private readonly root: HTMLElement,
    private readonly contract: Contract,
    private readonly choices: Choices,
    private readonly changed: () => void,
  ) {
    root.addEventListener('submit', (event) => event.preventDefault());
    root.append(el('datalist', {id: 'tube-sizes'}, ...choices.sizes.map((size) => el('option', {value: size}))));
    root.addEventListener('input', (event) => roomy([event.target as HTMLElement]));
    root.addEventListener('toggle', () => this.roomSoon(), true);
    let width = 0;
    new ResizeObserver(([entry]) => {
      if (entry?.contentRect.width === width) return;
      width = entry?.contentRect.width ?? 0;
      this.roomSoon();
    }).observe(root);
  }

  show(schema: Schema, body: Row): void {
    this.schema = schema;
    this.body = body;
    this.draw();
  }

  /** What the service filled in shows as the fields' placeholders. */
  understood(request: Row): void {
    this.echo = request;
    for (const [pointer, input] of this.inputs) {
      const value = at(request, pointer);
      if (input instanceof HTMLInputElement && value !== undefined && !isRow(value)) input.placeholder = offered(value);
      const other = input instanceof HTMLSelectElement && input.querySelector('option[value=""]');
      if (other && value !== undefined && typeof value !== 'object') other.textContent = `${choice(value)} (default)`;
    }
  }

  /** Marks the fields that a problem names. Returns how many found no field of their own. */
  complain(issues: Issue[]): number {
    this.root.querySelectorAll('.complaint').forEach((node) => node.remove());
    this.root.querySelectorAll('[aria-invalid]').forEach((node) => {
      node.removeAttribute('aria-invalid');
      node.removeAttribute('aria-describedby');
    });
    let lost = 0;
    issues.forEach((issue, index) => {
      const input = this.nearest(issue.pointer);
      if (!input) {
        lost += 1;
        return;
      }
      const note = el('p', {class: 'complaint', id: `complaint-${index}`}, said(issue));
      input.setAttribute('aria-invalid', 'true');
      input.setAttribute('aria-describedby', note.id);
      const [row, field] = [input.closest('tr'), input.closest('.field:not(.branch)')];
      if (row) row.after(el('tr', {class: 'complaint'}, el('td', {colspan: '20'}, note)));
      // in its own cell of the grid: after it, it stands under the neighbour
      else if (field) field.append(note);
      else (input.closest('.field, .group') ?? input).after(note);
    });
    return lost;
  }

  /** Brings the field of a pointer, or of what holds it, into view. */
  focus(pointer: string): void {
    const input = this.nearest(pointer);
    if (!input) return;
    for (let holder = input.closest('details'); holder; holder = holder.parentElement?.closest('details') ?? null) holder.open = true;
    input.scrollIntoView({block: 'center', behavior: 'instant'});
    input.focus();
  }

  private nearest(pointer: string): HTMLElement | undefined {
    for (let to = pointer; ; to = to.slice(0, to.lastIndexOf('/'))) {
      const found = this.inputs.get(to);
      if (found || to === '') return found;
    }
  }

  private draw(): void {
    this.root.querySelectorAll(':scope > :not(datalist)').forEach((node) => node.remove());
    this.inputs.clear();
    this.root.append(...this.parts(this.schema, this.body, ''));
    this.room();
  }

  private room(): void {
    roomy([...this.inputs.values()]);
  }

  /** Once, however many folds open together: measuring lays the page out. */
  private roomSoon(): void {
    cancelAnimationFrame(this.measuring);
    this.measuring = requestAnimationFrame(() => this.room());
  }

  /** `towards`: the first field in what was made, or what is nearest to what is gone; else the focus stays. */
  private redraw(towards?: string): void {
    const focused = [...this.inputs].find(([, node]) => node === document.activeElement)?.[0];
    this.draw();
    this.understood(this.echo);
    const first = [...this.inputs.keys()].find((pointer) => pointer.startsWith(`${towards}/`));
    const to = first ?? towards ?? focused;
    if (to !== undefined) this.nearest(to)?.focus();
    this.changed();
  }

  private write(pointer: string, value: Json | undefined): void {
    put(this.body, pointer, value);
    this.changed();
  }

  /** The nodes for one value of the request. */
  private parts(given: Schema, value: Json | undefined, pointer: string): HTMLElement[] {
    const schema = this.contract.resolve(given);
    const branches = this.contract.branches(schema);
    if (branches.length < 2 || schema.properties) return this.fields(schema, value, pointer);
    const chosen = this.contract.branchOf(branches, value);
    const select = el(
      'select',
      {
        'aria-label': pointer ? called(pointer) : 'Given by',
        title: pointer ? hintOf(schema, pointer) : 'In which way the job is given.',
        onchange: () => {
          const next = this.contract.make(branches[select.selectedIndex] as Schema, value, lastKey(pointer));
          if (pointer) put(this.body, pointer, next);
          else {
            for (const key of Object.keys(this.body)) delete this.body[key];
            Object.assign(this.body, next);
          }
          this.redraw();
        },
      },
      ...branches.map((branch, index) => el('option', {selected: index === chosen}, sentence(this.contract.branchName(branches, branch)))),
    );
    if (pointer) this.inputs.set(pointer, select);
    const row = el('div', {class: 'field branch'}, pointer ? null : el('span', {class: 'name'}, 'Given by'), select);
    return [row, ...this.fields(branches[chosen] as Schema, value, pointer)];
  }

  private fields(schema: Schema, value: Json | undefined, pointer: string): HTMLElement[] {
    if ('const' in schema || schema.type === 'null') return [];
    if (schema.properties && schema.additionalProperties !== true && !isRow(schema.additionalProperties)) {
      return this.members(schema, isRow(value) ? value : {}, pointer);
    }
    return [this.leaf(schema, value, pointer, called(pointer))];
  }

  private members(schema: Schema, value: Row, pointer: string): HTMLElement[] {
    const small: HTMLElement[] = [],
      large: HTMLElement[] = [],
      absent: HTMLElement[] = [];
    const offered = Object.entries(schema.properties ?? {}).filter(([key, inner]) => key in value || (!aside.has(key) && typeof inner !== 'boolean'));
    for (const [key, inner] of offered) {
      const to = join(pointer, key);
      const member = this.contract.resolve(inner);
      if ('const' in member) continue;
      const required = schema.required?.includes(key) ?? false;
      if (this.simple(member) || this.short(member)) small.push(this.leaf(member, value[key], to, called(to), required));
      else if (key in value || required) large.push(this.group(key, member, value[key], to, required));
      else absent.push(this.offer(key, member, to));
    }
    const out: HTMLElement[] = [];
    if (small.length) out.push(el('div', {class: 'grid'}, ...small));
    // Tubes first: they are what people change.
    if (pointer === '') out.reverse();
    out.unshift(...(pointer === '' ? large : []));
    if (pointer !== '') out.push(...large);
    if (absent.length) out.push(el('div', {class: 'offers'}, ...absent));
    return out;
  }

  /** Points, directions, pairs: a field like a number is. */
  private short(schema: Schema): boolean {
    const item = schema.items && this.contract.resolve(schema.items);
    return schema.type === 'array' && item !== undefined && !item.properties && !item.oneOf && (schema.maxItems ?? 99) <= inlineList;
  }

  private simple(schema: Schema): boolean {
    if (schema.oneOf) return this.contract.branches(schema).every((branch) => this.simple(branch));
    return schema.enum !== undefined || 'const' in schema || ['number', 'integer', 'string', 'boolean', 'null'].includes(schema.type ?? '');
  }

  private offer(key: string, schema: Schema, pointer: string): HTMLElement {
    return el(
      'button',
      {
        type: 'button',
        title: hintOf(schema, pointer),
        onclick: () => {
          put(this.body, pointer, this.contract.make(schema, undefined, key));
          this.folds.set(pointer, true);
          this.redraw(pointer);
        },
      },
      `+ ${called(pointer)}`,
    );
  }

  private group(key: string, schema: Schema, value: Json | undefined, pointer: string, required: boolean): HTMLElement {
    const inner =
      value === undefined
        ? [this.offer(key, schema, pointer)]
        : schema.type === 'array'
          ? this.list(schema, value, pointer)
          : this.parts(schema, value, pointer);
    const remove = required
      ? null
      : el(
          'button',
          {
            type: 'button',
            class: 'remove',
            'aria-label': `Remove ${called(pointer)}`,
            title: `Remove ${called(pointer)}`,
            onclick: () => {
              put(this.body, pointer, undefined);
              this.redraw(pointer);
            },
          },
          '×',
        );
    const title = el('summary', {title: hintOf(schema, pointer)}, sentence(called(pointer)));
    const node: HTMLDetailsElement = el(
      'details',
      {open: this.folds.get(pointer) ?? !folded.has(key), ontoggle: () => this.folds.set(pointer, node.open)},
      title,
      ...inner,
    );
    if (!this.inputs.has(pointer)) this.inputs.set(pointer, title);
    return el('div', {class: 'group'}, node, remove);
  }

  private list(schema: Schema, value: Json, pointer: string): HTMLElement[] {
    const item = this.contract.resolve(schema.items ?? {});
    const items = Array.isArray(value) ? value : [];
    if (!item.properties && !item.oneOf) return [this.leaf(schema, value, pointer, called(pointer))];
    const branches = item.oneOf ? this.contract.branches(item) : [item];
    const kinds = items.map((each) => branches[this.contract.branchOf(branches, each)] as Schema);
    const rows = runsOf(kinds).flatMap(([kind, from, to]) => {
      const own = items.slice(from, to);
      if (Object.values(kind.properties ?? {}).every((p) => this.simple(this.contract.resolve(p)))) return [this.table(kind, own, pointer, from)];
      return own.map((each, i) => this.card(item, each, join(pointer, from + i), from + i));
    });
    const add = (branch: Schema) => {
      items.push(this.contract.make(branch, branch === kinds[kinds.length - 1] ? items[items.length - 1] : undefined));
      if (!Array.isArray(value)) put(this.body, pointer, items);
      this.redraw(join(pointer, items.length - 1));
    };
    const names = branches.map((branch) => this.contract.branchName(branches, branch));
    // Not a list to choose from: by the keyboard its first choice would be made on the way to the others.
    const adders = branches.map((branch, i) => {
      const name = branches.length === 1 ? 'add' : (names[i] as string);
      const title = `Add to ${called(pointer)}`;
      return el(
        'button',
        {type: 'button', class: 'adder', 'aria-label': `${title}: ${name}`, title, onclick: () => add(branches.length === 1 ? item : branch)},
        `+ ${name}`,
      );
    });
    return [...rows, el('div', {class: 'offers'}, ...adders)];
  }

  /** Rows from `first` on, of one kind. */
  private table(kind: Schema, items: Json[], pointer: string, first: number): HTMLElement {
    const columns = Object.entries(kind.properties ?? {})
      .map(([key, inner]) => ({key, schema: this.contract.resolve(inner)}))
      .filter(({schema}) => !('const' in schema));
    const head = columns.map(({key, schema}) => {
      const to = join(join(pointer, first), key);
      return el('th', {scope: 'col', title: hintOf(schema, to)}, sentence(brief(key, called(to))), el('small', {}, unit(key)));
    });
    const rows = items.map((item, i) => {
      const index = first + i;
      const to = join(pointer, index);
      const cells = columns.map(({key, schema}) =>
        el(
          'td',
          {class: schema.type === 'string' ? 'text' : '', title: hintOf(schema, join(to, key))},
          this.input(schema, isRow(item) ? item[key] : undefined, join(to, key), `${called(join(to, key))} ${index + 1}`),
        ),
      );
      return el('tr', {}, this.swatch(index), ...cells, el('td', {}, this.remover(to, index)));
    });
    return el(
      'div',
      {class: 'scroll', tabindex: '0', role: 'group', 'aria-label': called(pointer)},
      el('table', {class: 'tubes'}, el('thead', {}, el('tr', {}, el('td'), ...head, el('td'))), el('tbody', {}, ...rows)),
    );
  }

  private swatch(index: number): HTMLElement {
    const dot = el('span', {class: 'swatch'});
    dot.style.background = partnerColour(index);
    return el('td', {class: 'dot'}, dot);
  }

  private remover(pointer: string, index: number): HTMLElement {
    return el(
      'button',
      {
        type: 'button',
        class: 'remove',
        'aria-label': `Remove row ${index + 1}`,
        title: `Remove row ${index + 1}`,
        onclick: () => {
          put(this.body, pointer, undefined);
          if (at(this.echo, pointer) !== undefined) put(this.echo, pointer, undefined); // another row's hints are not those of the next
          this.redraw(pointer);
        },
      },
      '×',
    );
  }

  private card(schema: Schema, value: Json, pointer: string, index: number): HTMLElement {
    const dot = el('span', {class: 'swatch'});
    dot.style.background = partnerColour(index);
    const name = isRow(value) && typeof value['id'] === 'string' ? value['id'] : String(index + 1);
    const head = el('div', {class: 'card-head', tabindex: '-1'}, dot, el('b', {}, name), this.remover(pointer, index));
    const node = el('div', {class: 'card'}, head, ...this.parts(schema, value, pointer));
    if (!this.inputs.has(pointer)) this.inputs.set(pointer, head);
    return node;
  }

  private leaf(schema: Schema, value: Json | undefined, pointer: string, name: string, required = false): HTMLElement {
    const wide = schema.type === 'array' || !this.simple(schema);
    const input = this.input(schema, value, pointer, name);
    const mark = unit(lastKey(pointer));
    const grip = mark ? el('span', {class: 'unit', title: 'Drag to change'}, mark) : null;
    if (grip && input instanceof HTMLInputElement) this.scrub(grip, input);
    return el(
      'label',
      {class: `field${wide ? ' wide' : ''}${required ? ' required' : ''}`, title: hintOf(schema, pointer)},
      el('span', {class: 'name'}, sentence(name)),
      el('span', {class: 'box'}, input, grip),
    );
  }

  private input(schema: Schema, value: Json | undefined, pointer: string, name: string): HTMLElement {
    const node = this.control(schema, value, pointer);
    node.setAttribute('aria-label', [sentence(name), unit(lastKey(pointer))].filter(Boolean).join(', '));
    node.dataset['pointer'] = pointer;
    this.inputs.set(pointer, node);
    return node;
  }

  private control(schema: Schema, value: Json | undefined, pointer: string): HTMLElement {
    const key = lastKey(pointer);
    if (schema.type === 'array') return this.numbers(value, pointer);
    const choices = schema.enum ?? (key === 'machine' && this.choices.machines.length ? this.choices.machines : undefined);
    if (choices && !isRow(value)) return this.select(choices, value, schema, pointer);
    if (schema.type === 'boolean') {
      const node = el('input', {type: 'checkbox', checked: (value ?? schema.default) === true, onchange: () => this.write(pointer, node.checked)});
      return node;
    }
    if (isRow(value) || Array.isArray(value)) return this.numbers(value, pointer);
    const textual = schema.type === 'string' && !schema.oneOf;
    const node = el('input', {
      type: 'text',
      inputmode: textual ? 'text' : 'decimal',
      spellcheck: 'false',
      list: key === 'size' ? 'tube-sizes' : null,
      placeholder: schema.default === undefined ? null : offered(schema.default),
      value: value ?? '',
      oninput: () => this.write(pointer, typed(node.value, textual)),
    });
    if (!textual) node.addEventListener('keydown', (event) => this.nudge(event, node));
    return node;
  }

  private select(choices: Json[], value: Json | undefined, schema: Schema, pointer: string): HTMLElement {
    const options = choices.map((each) => el('option', {value: JSON.stringify(each), selected: each === value}, choice(each)));
    const none = el('option', {value: '', selected: value === undefined}, schema.default === undefined ? '' : `${choice(schema.default)} (default)`);
    const node = el('select', {onchange: () => this.write(pointer, node.value === '' ? undefined : (JSON.parse(node.value) as Json))}, none, ...options);
    return node;
  }

  /** Lists: a few numbers on a line, many in a box, as JSON or separated by commas. */
  private numbers(value: Json | undefined, pointer: string): HTMLElement {
    const plain = Array.isArray(value) && value.every((each) => typeof each === 'number');
    const text = value === undefined ? '' : plain ? (value as number[]).join(', ') : JSON.stringify(value);
    const read = (typedText: string): Json | undefined => {
      if (!typedText.trim()) return undefined;
      try {
        return JSON.parse(/^\s*[[{"]/.test(typedText) ? typedText : `[${typedText}]`) as Json;
      } catch {
        return typedText;
      }
    };
    if ((plain && (value as number[]).length <= inlineList && text.length <= inlineText) || value === undefined) {
      const node = el('input', {type: 'text', value: text, oninput: () => this.write(pointer, read(node.value))});
      return node;
    }
    const area = el('textarea', {rows: '3', spellcheck: 'false', oninput: () => this.write(pointer, read(area.value))});
    area.value = text;
    return area;
  }

  /** Up and down change a number by 1, with Shift by 10, with Alt by 0.1. */
  private nudge(event: KeyboardEvent, input: HTMLInputElement): void {
    if (event.key !== 'ArrowUp' && event.key !== 'ArrowDown') return;
    event.preventDefault();
    step(input, (event.key === 'ArrowUp' ? 1 : -1) * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1));
  }

  private scrub(grip: HTMLElement, input: HTMLInputElement): void {
    let from = 0,
      taken = 0;
    grip.addEventListener('pointerdown', (event) => {
      event.preventDefault();
      grip.setPointerCapture(event.pointerId);
      from = event.clientX;
      taken = 0;
    });
    grip.addEventListener('pointermove', (event) => {
      if (!grip.hasPointerCapture(event.pointerId)) return;
      const steps = Math.round((event.clientX - from) / 4);
      if (steps !== taken) step(input, steps - taken);
      taken = steps;
    });
  }
}

/** Stretches of one kind: what it is, from where, up to where. */
function runsOf<T>(kinds: T[]): [T, number, number][] {
  const out: [T, number, number][] = [];
  kinds.forEach((kind, i) => {
    const last = out[out.length - 1];
    if (last && last[0] === kind) last[2] = i + 1;
    else out.push([kind, i, i + 1]);
  });
  return out;
}

/** Gives every value the room to be read whole: a field the whole line, a cell of a table what it needs. */
function roomy(inputs: HTMLElement[]): void {
  const texts = inputs.filter((input): input is HTMLInputElement => input instanceof HTMLInputElement && input.type === 'text');
  for (const input of texts) {
    if (input.closest('td')) input.style.minWidth = '';
    input.closest('.field')?.classList.remove('roomy');
  }
  const clipped = texts.filter((input) => input.scrollWidth > input.clientWidth).map((input) => [input, input.scrollWidth] as const);
  for (const [input, needed] of clipped) {
    if (input.closest('td')) input.style.minWidth = `${needed + 2}px`;
    input.closest('.field')?.classList.add('roomy');
  }
}

function step(input: HTMLInputElement, by: number): void {
  const now = Number(input.value || input.placeholder);
  if (!Number.isFinite(now)) return;
  input.value = String(Number((now + by).toFixed(6)));
  input.dispatchEvent(new Event('input', {bubbles: true}));
}

/** A number where one was typed; anything else goes to the service as it is, to be refused by name. */
function typed(text: string, textual: boolean): Json | undefined {
  if (text === '') return undefined;
  if (textual) return text;
  const value = Number(text.replace(',', '.'));
  return text.trim() !== '' && Number.isFinite(value) ? value : text;
}
