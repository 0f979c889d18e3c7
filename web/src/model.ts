import {byId, el} from './dom';
import {clone, type Row} from './json';
import type {Imported, LengthUnit, Size} from './importer';

type Importer = typeof import('./importer');
/** What a file does not tell, by the name of its control. */
type Answers = Record<string, string>;
interface Question {
  key: string;
  text: string;
  choices?: [value: string, name: string][];
  value?: string;
  hint?: string;
}
interface Kind {
  questions(importer: Importer, text: string, schedules: string[]): Question[];
  read(importer: Importer, file: Uint8Array, answers: Answers): Imported | Promise<Imported>;
}

const text = (file: Uint8Array): string => new TextDecoder().decode(file);
const named = (list: readonly string[]): [string, string][] => list.map((each) => [each, each]);
const unitAnswer = (answers: Answers): {unit?: LengthUnit} => (answers['unit'] ? {unit: answers['unit'] as LengthUnit} : {});

/** "114.3x6.3" in mm, or a name that the service lists. */
function sizeOf(said: string | undefined): Size | undefined {
  const found = /^\s*(\d+(?:\.\d+)?)\s*[x×]\s*(\d+(?:\.\d+)?)\s*$/.exec(said ?? '');
  if (found) return {outer_diameter_mm: Number(found[1]), wall_mm: Number(found[2])};
  return said?.trim() ? {size: said.trim()} : undefined;
}

function positive(said: string): number {
  const value = Number(said);
  if (!(value > 0 && Number.isFinite(value))) throw new Error(`"${said}" is no length.`);
  return value;
}

function pointOf(said: string): [number, number, number] {
  const [x, y, z, ...rest] = said
    .split(/[\s,;]+/)
    .filter(Boolean)
    .map(Number);
  if (x === undefined || y === undefined || z === undefined || rest.length > 0 || ![x, y, z].every(Number.isFinite)) throw new Error(`"${said}" is no point.`);
  return [x, y, z];
}

const kinds: Record<string, Kind> = {
  ifc: {
    questions: () => [
      {key: 'origin', text: 'Its point that is the origin here, mm', hint: '0, 0, 0'},
      {key: 'corner', text: 'Radius of square tubes’ sharp corners, mm', hint: 'none'},
    ],
    read: (importer, file, {origin, corner}) => {
      const more = {...(origin?.trim() ? {origin_mm: pointOf(origin)} : {}), ...(corner?.trim() ? {corner_radius_mm: positive(corner)} : {})};
      return importer.fromIfc(file, {wasm: importer.wasm, ...more});
    },
  },
  pcf: {
    questions: (_, __, schedules) => [
      {key: 'schedule', text: 'Schedule of pipes whose wall the file does not tell', choices: [['', 'none'], ...named(schedules)]},
    ],
    read: (importer, file, {schedule}) => importer.fromPcf(text(file), schedule ? {schedule} : {}),
  },
  csv: {
    questions: (importer, file) => {
      const {headings, columns} = importer.columnsOf(file);
      const choices: [string, string][] = [['', '–'], ...named(headings.map((each) => each.trim()).filter(Boolean))];
      return [
        {key: 'unit', text: 'Lengths in', choices: named(Object.keys(importer.lengths)), value: 'mm'},
        ...importer.fields.map((field) => ({key: field, text: `Column of ${field.replace(/_/g, ' ')}`, choices, value: columns[field]?.trim() ?? ''})),
        {key: 'all', text: 'Size of the other rows'},
      ];
    },
    read: (importer, file, answers) => {
      const columns = Object.fromEntries(importer.fields.flatMap((field) => (answers[field] ? [[field, answers[field]]] : [])));
      const size = sizeOf(answers['all']);
      return importer.fromCsv(text(file), {columns, ...unitAnswer(answers), ...(size ? {size} : {})});
    },
  },
  dxf: {
    questions: (importer, file) => [
      {key: 'unit', text: 'Drawn in', choices: [['', 'as it says'], ...named(Object.keys(importer.lengths))], value: ''},
      ...importer.layersOf(file).map((layer) => ({key: `layer ${layer}`, text: `Size of ${layer}`})),
    ],
    read: (importer, file, answers) => {
      const layers = Object.entries(answers).flatMap(([key, said]) => {
        const size = key.startsWith('layer ') && sizeOf(said);
        return size ? [[key.slice('layer '.length), size]] : [];
      });
      return importer.fromDxf(text(file), Object.fromEntries(layers), unitAnswer(answers));
    },
  },
};
const endings = Object.keys(kinds).map((each) => `.${each}`);

/** The button, the place to drop a file, and what is said of it beside the form. */
export class Model {
  private readonly root = byId('imported');
  private readonly button = byId('model');
  private given: Row | undefined;
  private turn = 0; // of a file or an answer; what comes late is dropped

  constructor(
    private readonly schedules: string[],
    private readonly taken: (frame: Row) => void,
  ) {
    const input = el('input', {type: 'file', id: 'model-file', accept: endings.join(','), hidden: true, 'aria-label': 'A model to open'});
    this.button.after(input);
    this.button.addEventListener('click', () => input.click());
    input.addEventListener('change', () => {
      const file = input.files?.[0];
      input.value = ''; // the same file once more is a change too
      if (file) void this.open(file);
    });
    const dropping = (event: DragEvent) => !this.button.hidden && event.dataTransfer?.types.includes('Files');
    addEventListener('dragover', (event) => {
      if (!dropping(event)) return;
      event.preventDefault();
      document.body.classList.add('dropping');
    });
    addEventListener('dragleave', (event) => event.relatedTarget === null && document.body.classList.remove('dropping'));
    addEventListener('drop', (event) => {
      if (!dropping(event)) return;
      event.preventDefault();
      document.body.classList.remove('dropping');
      const file = event.dataTransfer?.files[0];
      if (file) void this.open(file);
    });
  }

  /** Another job has begun: what was said of a file is said no more. */
  began(endpoint: string, body: Row): void {
    this.button.hidden = endpoint !== 'frames';
    if (body === this.given) return;
    this.turn += 1;
    this.given = undefined;
    this.root.hidden = true;
    this.root.replaceChildren();
  }

  private async open(file: File): Promise<void> {
    this.turn += 1;
    const {turn} = this;
    this.say(el('p', {class: 'soft'}, `Reading ${file.name} …`));
    try {
      const kind = kinds[file.name.toLowerCase().replace(/^.*\./, '')];
      if (!kind) throw new Error(`It is none of ${endings.join(', ')}.`);
      const [importer, bytes] = await Promise.all([import('./importer'), file.arrayBuffer()]);
      if (turn !== this.turn) return;
      const questions = kind.questions(importer, text(new Uint8Array(bytes)), this.schedules);
      const asked = el('div', {class: 'questions'}, ...questions.map((question) => field(question, () => void read().catch(failed))));
      const found = el('div', {class: 'found'});
      const failed = (failure: unknown) => found.replaceChildren(refused(failure));
      const read = async () => {
        this.turn += 1;
        const mine = this.turn;
        const imported = await kind.read(importer, new Uint8Array(bytes), answersOf(asked));
        if (mine !== this.turn) return;
        found.replaceChildren(...told(imported));
        if (!imported.frame) return;
        this.given = clone(imported.frame as unknown as Row);
        this.taken(this.given);
      };
      this.say(
        heading(file.name, () => this.close()),
        asked,
        found,
      );
      await read();
    } catch (failure) {
      const why = failure instanceof Error ? failure.message : String(failure);
      this.say(
        heading(file.name, () => this.close()),
        el('p', {role: 'alert'}, `It cannot be read. ${why}`),
      );
    }
  }

  private say(...nodes: HTMLElement[]): void {
    this.root.hidden = false;
    this.root.replaceChildren(...nodes);
  }

  private close(): void {
    this.turn += 1;
    this.root.hidden = true;
    this.root.replaceChildren();
    this.button.focus();
  }
}

const heading = (name: string, close: () => void): HTMLElement =>
  el('h3', {}, name, el('button', {type: 'button', class: 'right', 'aria-label': 'Close what is said of the model', onclick: close}, 'Close'));

const refused = (failure: unknown): HTMLElement =>
  el('p', {role: 'alert'}, `It cannot be read. ${failure instanceof Error ? failure.message : String(failure)}`);

function field({key, text: said, choices, value, hint}: Question, changed: () => void): HTMLElement {
  const shared = {'data-question': key, onchange: changed};
  const options = choices?.map(([each, name]) => el('option', {value: each, selected: each === (value ?? '')}, name)) ?? [];
  const input = choices
    ? el('select', shared, ...options)
    : el('input', {...shared, list: hint ? undefined : 'tube-sizes', placeholder: hint ?? '114.3x6.3', value: value ?? ''});
  return el('label', {}, el('span', {}, said), input);
}

const answersOf = (asked: HTMLElement): Answers =>
  Object.fromEntries(
    [...asked.querySelectorAll<HTMLInputElement | HTMLSelectElement>('[data-question]')].map((each) => [each.dataset['question'] ?? '', each.value]),
  );

const counted = (n: number, one: string, many: string): string => `${n} ${n === 1 ? one : many}`;

/** How much of the file is in the frame, and every thing that is not. */
function told({frame, notUnderstood}: Imported): HTMLElement[] {
  const others = frame?.others?.length ?? 0;
  const also = others ? ` and ${counted(others, 'other that cuts', 'others that cut')}` : '';
  const what = frame ? `${counted(frame.members.length, 'member', 'members')}${also}.` : 'No member was found, so the job stays as it was.';
  const all = notUnderstood.length === 0;
  const lines = notUnderstood.map(({id, type, reason}) => el('li', {}, el('b', {}, id), ` ${type}: ${reason}`));
  return [
    el('p', {id: 'imported-said'}, `${what} ${all ? 'Nothing was left out.' : `${counted(lines.length, 'thing was', 'things were')} not understood:`}`),
    ...(all ? [] : [el('ul', {id: 'not-understood', tabindex: '0', 'aria-label': 'What was not understood'}, ...lines)]),
  ];
}
