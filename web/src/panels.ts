import {byId, el, save} from './dom';
import {isRow, type Json, type Row} from './json';
import {askForKey, headed, keyed} from './key';
import {listen} from './links';
import {endpointName} from './names';
import type {Picture, Table} from './picture';
import type {Format} from './schema';
import {away, holds, path, type Answer, type Check, type Problem, type Warning} from './service';
import {beside, number, residual, shown, spelled, unit} from './units';
import {about, check as checkName, choice, hint, label, place, plain, sentence, term, text as textOf, type Term} from './words';
import {said} from './hint';

/** Verdict, reasons and failed checks, or the problem: in plain sight above the pictures. */
export function verdict(
  root: HTMLElement,
  answer: Answer | undefined,
  problem: Problem | undefined,
  milliseconds: number,
  focus: (pointer: string) => void,
  again?: () => void,
  facts = '',
): void {
  if (problem?.code === away.code) silence(root, problem.title, problem.action ?? '', again);
  else if (problem?.code === 'unauthorized' && again) askForKey(root, again);
  else if (problem) root.replaceChildren(...refusal(problem, focus));
  else if (answer) root.replaceChildren(...approval(answer, milliseconds, focus, facts));
}

/** Where there is no verdict: a service that is away, a link that cannot be read. */
export function silence(root: HTMLElement, title: string, detail: string, again?: () => void, pill = 'no answer'): void {
  root.replaceChildren(
    el(
      'div',
      {class: 'verdict bad'},
      el(
        'p',
        {},
        el('span', {class: 'pill'}, pill),
        el('b', {}, title),
        again ? el('button', {type: 'button', class: 'right', id: 'again', onclick: again}, 'Try again') : null,
      ),
      detail ? el('p', {class: 'soft'}, detail) : null,
    ),
  );
}

function refusal(problem: Problem, focus: (pointer: string) => void): HTMLElement[] {
  const rows = (problem.errors ?? []).map((issue) =>
    el(
      'li',
      {},
      placeButton(issue.pointer, focus),
      ' ',
      said(issue),
      issue.got === undefined || issue.got === null || typeof issue.got === 'object' ? '' : ` – got ${choice(issue.got)}`,
    ),
  );
  return [
    el(
      'div',
      {class: 'verdict bad'},
      el('p', {}, el('span', {class: 'pill'}, 'refused'), el('b', {}, problem.title), problem.detail && !rows.length ? ` ${plain(problem.detail)}` : ''),
      rows.length ? el('ul', {}, ...rows) : null,
      problem.action ? el('p', {class: 'soft'}, plain(problem.action)) : null,
    ),
  ];
}

/** Names a field, and leads to it. */
const placeButton = (pointer: string, focus: (pointer: string) => void) =>
  el('button', {type: 'button', 'data-to': pointer, title: 'Show this field', onclick: () => focus(pointer)}, place(pointer));

/** What the verdict comes to, before what is known of the cut. */
const meanings = {
  made: {ok: 'Cuttable.', review: 'Look before you cut.', reject: 'Not to be cut.'},
  known: {ok: 'Sound.', review: 'Look at this first.', reject: 'Not to be used.'},
};
const made = new Set(['bevel-tables', 'holes', 'parts', 'frames', 'pulse-schedules', 'mill-paths', 'replays']);

function approval(answer: Answer, milliseconds: number, focus: (pointer: string) => void, facts: string): HTMLElement[] {
  const {status, reasons} = answer.verdict;
  const failed = answer.verification.checks.filter((check) => !holds(check));
  const total = answer.verification.checks.length;
  const proof = answer.verification.passed ? `${total} of ${total} checks of its own proof hold` : `${Math.max(1, failed.length)} of ${total} checks failed`;
  const tone = answer.verification.passed ? {ok: 'good', review: 'warn', reject: 'bad'}[status] : 'bad';
  const meaning = meanings[made.has(answer.job.endpoint) ? 'made' : 'known'][answer.verification.passed ? status : 'reject'];
  const named = new Set(answer.warnings.map((w) => w.code));
  const said = [
    ...(answer.verification.passed ? [] : failed.map((check) => el('li', {}, overLimit(check)))),
    ...answer.warnings.filter((warning) => warning.severity === 'cut').map((warning) => told(warning, focus)),
    ...reasons.filter((reason) => !named.has(reason)).map((reason) => el('li', {}, sentence(choice(reason)))),
  ];
  // A note makes no verdict: it is there for who asks.
  const notes = answer.warnings.filter((warning) => warning.severity === 'note').map((warning) => told(warning, focus));
  return [
    el(
      'div',
      {class: `verdict ${tone}`},
      el('p', {}, el('span', {class: 'pill'}, status), el('span', {class: 'said'}, el('b', {}, meaning), ` ${facts}`)),
      el('p', {class: 'soft'}, el('span', {}, proof), el('span', {class: 'right'}, `answered in ${milliseconds.toFixed(0)} ms`)),
      said.length ? el('ul', {}, ...said) : null,
      notes.length ? el('details', {}, el('summary', {}, notes.length === 1 ? 'A note' : `${notes.length} notes`), el('ul', {}, ...notes)) : null,
    ),
  ];
}

export const told = (warning: Warning, focus: (pointer: string) => void) =>
  el(
    'li',
    {class: warning.severity},
    el('b', {}, sentence(choice(warning.code))),
    warning.detail ? `: ${plain(warning.detail).replace(/\.$/, '')}. ` : ' ',
    warning.action ? `${plain(warning.action)} ` : null,
    warning.pointer ? placeButton(warning.pointer, focus) : null,
  );

function overLimit(check: Check): string {
  const mark = spelled(check.unit);
  return `${sentence(checkName(check.name).name)}: ${beside(residual(check.value, mark), mark)}, limit ${beside(residual(check.limit, mark), mark)}`;
}

export function figures(root: HTMLElement, picture: Pick<Picture, 'figures'>): void {
  root.replaceChildren(
    ...picture.figures.map((figure) =>
      el(
        'div',
        {class: 'figure', title: figure.about},
        el('span', {}, sentence(figure.name)),
        el('b', {}, figure.value, el('small', {}, figure.unit ? `${figure.unit === '°' ? '' : ' '}${figure.unit}` : '')),
      ),
    ),
  );
}

/** Writes the values under the cursor, until what it returns is called. Its rows stand there before, so that nothing moves. */
export function readout(picture: Picture): (() => void) | null {
  const links = [...new Set(picture.charts.map((chart) => chart.link))];
  if (!links.length || !picture.readout) {
    byId('readout')?.replaceChildren();
    return null;
  }
  const write = (index: number | null, link = links[0] as string) => {
    const root = byId('readout');
    if (!root) return;
    const rows = picture.readout?.(index ?? 0, link) ?? [];
    root.title = index === null ? 'Point at a chart or at the cut, or use the arrow keys: the cursor moves in every view.' : '';
    root.classList.toggle('idle', index === null);
    root.replaceChildren(
      ...rows.map(([name, value]) => el('div', {title: hint(name)}, el('dt', {}, sentence(textOf(name))), el('dd', {}, index === null ? '–' : value))),
    );
  };
  const forget = links.map((link) => listen(link, (index) => write(index, link)));
  write(null);
  return () => forget.forEach((each) => each());
}

const cell = (tag: 'td' | 'th', of: Term) =>
  el(tag, {scope: tag === 'th' ? 'col' : null, class: textOf(of).length > 40 ? 'words' : null, title: hint(of)}, textOf(of));

const capital = (of: Term): Term => (typeof of === 'string' ? sentence(of) : {...of, text: sentence(of.text)});

export function table(given: Table): HTMLElement {
  const bare = given.head.every((each) => each === '');
  return el(
    'section',
    {class: given.head.length > 4 ? 'block whole' : 'block', id: given.id ? `table-${given.id}` : null},
    el('h3', {}, given.title),
    el(
      'div',
      {class: 'scroll', tabindex: '0', role: 'group', 'aria-label': given.title},
      el(
        'table',
        {},
        bare ? null : el('thead', {}, el('tr', {}, ...given.head.map((each) => cell('th', capital(each))))),
        el('tbody', {}, ...given.rows.map((row) => el('tr', {}, ...row.map((each, i) => cell('td', i || given.names ? each : capital(each)))))),
      ),
    ),
  );
}

const active = 0.98; // of a limit that may be used up: the answer rests on it
const near = 0.5; // of one that may not

/** How a check stands to its limit: one that may be used up is active at it, a residual is near a failure. */
function standing(check: Check, kind: 'checks' | 'limits'): {tone: string; text: string; share: number} {
  const share = check.limit > 0 ? check.value / check.limit : check.value > 0 ? Infinity : 0;
  const part = Math.min(1, Math.max(0, share));
  if (!holds(check)) return {tone: 'failed', text: 'FAILED', share: part};
  if (kind === 'limits') return share >= active ? {tone: 'active', text: 'at its limit, as it may be', share: part} : {tone: '', text: 'holds', share: part};
  return share >= near ? {tone: 'near', text: 'holds, near its limit', share: part} : {tone: '', text: 'holds', share: part};
}

/** What was measured against what is allowed, as a share of the limit. */
export function proof(answer: Answer): HTMLElement {
  const rows = answer.verification.checks.map((check) => {
    const {name, about, kind} = checkName(check.name);
    const {tone, text, share} = standing(check, kind);
    const mark = spelled(check.unit);
    return el(
      'tr',
      {class: tone, title: about},
      el('td', {}, sentence(name)),
      el('td', {}, beside(residual(check.value, mark), mark)),
      el('td', {}, beside(residual(check.limit, mark), mark)),
      el(
        'td',
        {},
        el('meter', {min: '0', max: '1', value: share, 'aria-label': `${name}: share of the limit`}),
        ` ${share > 0 && share < 0.01 ? '< 1' : number(100 * share, '%')} %`,
      ),
      el('td', {}, text),
    );
  });
  const {job} = answer;
  return el(
    'div',
    {class: 'columns'},
    el(
      'section',
      {class: 'block whole'},
      el('h3', {}, 'Proof'),
      el('p', {class: 'soft'}, 'Residuals computed from the answer by other formulas than those that made it, and the limits that it keeps.'),
      el(
        'div',
        {class: 'scroll', tabindex: '0', role: 'group', 'aria-label': 'Proof'},
        el(
          'table',
          {},
          el('thead', {}, el('tr', {}, ...['Check', 'Value', 'Limit', 'Of the limit', ''].map((t) => el('th', {scope: 'col'}, t)))),
          el('tbody', {}, ...rows),
        ),
      ),
    ),
    table({
      title: 'Job',
      head: ['', ''],
      rows: [
        [term('engine'), job.engine],
        ['job', job.id],
        [{text: label('input_sha256'), about: about('input_sha256')}, `${job.input_sha256.slice(0, 12)} …`],
        [{text: label('result_sha256'), about: about('result_sha256')}, `${job.result_sha256.slice(0, 12)} …`],
      ],
    }),
  );
}

/** Every column of the answer's points. */
export function columns(answer: Answer): HTMLElement {
  const found: [string, Row, string][] = []; // title, columns, the name they stand under
  const look = (row: Row, name: string) => {
    for (const [key, value] of Object.entries(row)) {
      const each =
        Array.isArray(value) && isRow(value[0]) ? value.map((v, i): [string, Json] => [`${label(key)} ${i + 1}`, v]) : [[label(key), value] as [string, Json]];
      for (const [title, inner] of each) {
        if (!isRow(inner)) continue;
        const lists = Object.values(inner).filter((v) => Array.isArray(v) && typeof v[0] !== 'object');
        if (lists.length > 1 && (lists[0] as Json[]).length > 2) found.push([name ? `${name}: ${title}` : title, inner, key]);
        else look(inner, title);
      }
    }
  };
  look(answer.result, '');
  if (!found.length) return el('p', {class: 'soft'}, 'No curves in this answer: its tables stand with the proof.');
  const most = 1000;
  return el(
    'div',
    {},
    ...found.slice(0, 6).map(([name, row, within]) => {
      const cols = Object.entries(row).filter(([, v]) => Array.isArray(v)) as [string, Json[]][];
      const count = Math.min(most, cols[0]?.[1].length ?? 0);
      return table({
        title: `${sentence(name)}, ${cols[0]?.[1].length} rows${count === most ? ` (the first ${most} here)` : ''}`,
        head: cols.map(([key]) => term(key, within)),
        rows: Array.from({length: count}, (_, i) => cols.map(([key, v]) => textual(key, v[i]))),
      });
    }),
  );
}

const textual = (key: string, value: Json | undefined) =>
  typeof value === 'number' ? shown(key, value) : typeof value === 'boolean' ? (value ? 'yes' : 'no') : choice(value ?? '');

const quoted = (text: string) => `'${text.replace(/'/g, `'\\''`)}'`;
/** The key goes by its variable's name: what is copied is pasted anywhere. */
export const curl = (endpoint: string, body: Row) =>
  `curl -s ${keyed() ? '-H "X-Api-Key: $TUBECUT_KEY" ' : ''}-H 'Content-Type: application/json' --data ${quoted(JSON.stringify(body))} ${location.origin}${path(endpoint)}`;

export function exchange(endpoint: string, body: Row, reply: Json | undefined): HTMLElement {
  const block = (title: string, id: string, value: Json | undefined, ...buttons: HTMLElement[]) => {
    const text =
      value === undefined ? '' : JSON.stringify(value, null, 1).replace(/\[\s+([-\d.e+,\s]+?)\s+\]/g, (_, inner: string) => `[${inner.replace(/\s+/g, ' ')}]`);
    return el(
      'section',
      {class: 'block'},
      el('h3', {}, title, ...buttons),
      el(
        'pre',
        {id: id, tabindex: '0', role: 'group', 'aria-label': title},
        text.length > 60000 ? `${text.slice(0, 60000)}\n… (${text.length} characters; download it)` : text,
      ),
    );
  };
  return el(
    'div',
    {class: 'columns'},
    block(
      'Request',
      'request-json',
      body,
      copier('Copy JSON', () => JSON.stringify(body, null, 2)),
      copier('Copy as curl', () => curl(endpoint, body)),
    ),
    block(
      'Answer',
      'answer-json',
      reply,
      copier('Copy JSON', () => JSON.stringify(reply, null, 2)),
    ),
  );
}

export function copier(name: string, text: () => string): HTMLElement {
  const button = el(
    'button',
    {
      type: 'button',
      onclick: async () => {
        const done = await copied(text());
        button.textContent = done ? 'Copied' : 'Could not copy';
        setTimeout(() => {
          button.textContent = name;
        }, 1500);
      },
    },
    name,
  );
  return button;
}

export async function copied(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    // not a secure context: the old way
    const area = el('textarea', {class: 'offscreen'});
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand('copy');
    area.remove();
    return done;
  }
}

const endings: Record<string, [string, string]> = {
  'application/json': ['JSON', 'json'],
  'application/cbor': ['CBOR', 'cbor'],
  'text/csv': ['CSV', 'csv'],
  'image/svg+xml': ['SVG', 'svg'],
  'image/vnd.dxf': ['DXF', 'dxf'],
  'model/gltf-binary': ['glTF (3D)', 'glb'],
  'model/stl': ['STL (3D)', 'stl'],
  'model/step': ['STEP (CAD)', 'step'],
  'text/x-gcode': ['G-code', 'ngc'],
  'text/x-iec61131-st': ['IEC 61131-3 ST', 'st'],
  'text/html': ['HTML', 'html'],
  'application/pdf': ['PDF', 'pdf'],
  'application/zip': ['Shop packet (zip)', 'zip'],
  'application/x-ndjson': ['Lines (NDJSON)', 'ndjson'],
};
const known = (media: string): [string, string] => endings[media] ?? (/dstv|nc1/.test(media) ? ['DSTV', 'nc1'] : [media, 'txt']);

/** By the order of the reference and the part that is cut, else by the job's own name; then the drawing and the beginning of the input's hash. */
function fileName(name: string, body: Row, view: string | undefined, hash: string | null): string {
  const reference = (body['reference'] ?? {}) as Record<string, unknown>;
  const part = reference['part'] ?? body['member'];
  const words = [reference['order'], part].filter((word): word is string => typeof word === 'string');
  const parts = [...(words.length ? words : [name]), view ?? '', hash?.slice(0, 8) ?? ''].filter(Boolean);
  return parts.join('-').replace(/[\\/:*?"<>|\s]+/g, '_');
}

/** The whole of a reply; the bar tells how much of it has come. */
async function received(reply: Response, bar: HTMLProgressElement): Promise<Blob> {
  const all = Number(reply.headers.get('Content-Length'));
  const pieces: BlobPart[] = [];
  const reader = reply.body?.getReader();
  if (all > 0) bar.max = all;
  for (let seen = 0; reader; ) {
    const {done, value} = await reader.read();
    if (done) break;
    pieces.push(value);
    seen += value.length;
    if (all > 0) bar.value = seen;
  }
  return new Blob(pieces, {type: reply.headers.get('Content-Type') ?? ''});
}

/** An option that is a list of choices: a box to tick for each. */
function listField(option: Format['options'][number], users: string, given: Map<string, () => string>): HTMLElement {
  const chosen = (option.schema.default ?? []) as unknown as string[];
  const boxes = (option.schema.items as {enum: string[]}).enum.map((value) => {
    const box = el('input', {type: 'checkbox', value, 'data-option': option.name});
    box.checked = chosen.includes(value);
    return {box, view: el('label', {class: 'tick'}, box, choice(value))};
  });
  given.set(option.name, () =>
    boxes
      .filter(({box}) => box.checked)
      .map(({box}) => box.value)
      .join(','),
  );
  return el(
    'fieldset',
    {class: 'field ticks', title: plain(option.description)},
    el('legend', {class: 'name'}, `${label(option.name, 'download')} (${users})`),
    ...boxes.map(({view}) => view),
  );
}

/** A button for every format that the contract offers here, and a field for what a format asks. The file is what the service answers. */
export function downloads(endpoint: string, name: string, body: Row, formats: Format[]): HTMLElement {
  const status = el('p', {class: 'soft', role: 'status'});
  const given = new Map<string, () => string>();
  const bar = el('progress', {'aria-label': 'Download', hidden: true});
  const fetchFile = async ({media, options}: Format, view?: string) => {
    status.textContent = '';
    const query = new URLSearchParams(view ? {view} : {});
    const files = options.find(({name: of}) => of === 'files') && given.get('files')?.().split(',');
    for (const option of options) {
      const value = given.get(option.name)?.();
      const apart = /^(mirror|paper)$/.test(option.name) && view !== 'template'; // drawings of other views refuse it
      // What else a packet reads is its programs'.
      if (value && !apart && (!files || option.name === 'files' || files.includes('gcode'))) query.set(option.name, value);
    }
    bar.hidden = false;
    bar.removeAttribute('value'); // not to be told while it is computed
    const reply = await fetch(`${path(endpoint)}${query.size ? `?${query}` : ''}`, {
      method: 'POST',
      body: JSON.stringify(body),
      headers: headed({'Content-Type': 'application/json', Accept: media}),
    }).catch(() => undefined);
    if (!reply) {
      bar.hidden = true;
      status.textContent = `${known(media)[0]}: ${away.title}`;
      return;
    }
    if (!reply.ok) {
      bar.hidden = true;
      const problem = (await reply.json().catch(() => ({title: `status ${reply.status}`}))) as Problem;
      status.textContent = `${known(media)[0]}: ${plain(`${problem.title} ${problem.detail ?? ''}`)}`;
      return;
    }
    save(`${fileName(name, body, view, reply.headers.get('Tubecut-Input-Sha256'))}.${known(media)[1]}`, await received(reply, bar));
    bar.hidden = true;
  };
  const button = (format: Format, view?: string) =>
    el(
      'button',
      {type: 'button', 'data-media': format.media, 'data-view': view, onclick: () => void fetchFile(format, view)},
      view ? `${known(format.media)[0]}: ${choice(view)}` : known(format.media)[0],
    );
  const buttons = formats.flatMap((format) => (format.views.length ? format.views.map((view) => button(format, view)) : [button(format)]));
  const options = new Map(formats.flatMap((format) => format.options).map((option) => [option.name, option]));
  const fields = [...options.values()].map((option) => {
    const users = formats
      .filter((format) => format.options.some((each) => each.name === option.name))
      .map(({media}) => known(media)[0])
      .join(', ');
    if (option.schema.items) return listField(option, users, given);
    const choices = option.schema.enum ?? (option.schema.type === 'boolean' ? ['false', 'true'] : undefined);
    const input = choices
      ? el(
          'select',
          {},
          el('option', {value: ''}, `${choice(option.schema.default ?? '')} (default)`),
          ...choices.map((c) => el('option', {value: c}, choice(c))),
        )
      : // A speed has no default; one to begin with spares a refusal.
        el('input', {type: 'text', inputmode: 'decimal', value: option.name === 'speed_mm_min' ? '600' : '', placeholder: option.schema.default ?? ''});
    input.setAttribute('aria-label', `${label(option.name, 'download')}, for ${users}`);
    input.dataset['option'] = option.name;
    given.set(option.name, () => input.value);
    return el(
      'label',
      {class: 'field', title: plain(option.description)},
      el('span', {class: 'name'}, `${label(option.name, 'download')} (${users})`),
      el('span', {class: 'box'}, input, unit(option.name) ? el('span', {class: 'unit'}, unit(option.name)) : null),
    );
  });
  return el(
    'section',
    {class: 'block'},
    el('h3', {}, `Download: ${endpointName(endpoint)}`),
    fields.length ? el('div', {class: 'options'}, ...fields) : null,
    el('div', {class: 'offers'}, ...buttons),
    bar,
    status,
  );
}
