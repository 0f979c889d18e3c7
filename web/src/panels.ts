import {byId, el, save} from './dom';
import {isRow, type Json, type Row} from './json';
import {askForKey, headed, keyed} from './key';
import {listen} from './links';
import {endpointName, label, sentence, short4, spelled, unit} from './names';
import type {Picture, Table} from './picture';
import type {Format} from './schema';
import {away, holds, path, type Answer, type Problem} from './service';
import {said} from './form';

/** Verdict, reasons and failed checks, or the problem: in plain sight above the pictures. */
export function verdict(
  root: HTMLElement,
  answer: Answer | undefined,
  problem: Problem | undefined,
  milliseconds: number,
  focus: (pointer: string) => void,
  again?: () => void,
): void {
  if (problem?.code === away.code) silence(root, problem.title, problem.action ?? '', again);
  else if (problem?.code === 'unauthorized' && again) askForKey(root, again);
  else if (problem) root.replaceChildren(...refusal(problem, focus));
  else if (answer) root.replaceChildren(...approval(answer, milliseconds, focus));
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
      el('button', {type: 'button', onclick: () => focus(issue.pointer)}, issue.pointer || '/'),
      ' ',
      said(issue),
      issue.got === undefined || issue.got === null || typeof issue.got === 'object' ? '' : ` – got ${String(issue.got)}`,
    ),
  );
  return [
    el(
      'div',
      {class: 'verdict bad'},
      el('p', {}, el('span', {class: 'pill'}, 'refused'), el('b', {}, problem.title), problem.detail && !rows.length ? ` ${problem.detail}` : ''),
      rows.length ? el('ul', {}, ...rows) : null,
      problem.action ? el('p', {class: 'soft'}, problem.action) : null,
    ),
  ];
}

const titles = {ok: 'ok', review: 'review', reject: 'reject'};

function approval(answer: Answer, milliseconds: number, focus: (pointer: string) => void): HTMLElement[] {
  const {status, reasons} = answer.verdict;
  const failed = answer.verification.checks.filter((check) => !holds(check));
  const total = answer.verification.checks.length;
  const proof = answer.verification.passed ? `${total} of ${total} checks of its own proof hold` : `${Math.max(1, failed.length)} of ${total} checks failed`;
  const tone = answer.verification.passed ? {ok: 'good', review: 'warn', reject: 'bad'}[status] : 'bad';
  const named = new Set(answer.warnings.map((w) => w.code));
  const notes = [
    ...(answer.verification.passed
      ? []
      : failed.map((check) => el('li', {}, `${label(check.name)}: ${short4(check.value)} ${spelled(check.unit)}, limit ${short4(check.limit)}`))),
    ...answer.warnings.map((warning) =>
      el(
        'li',
        {class: warning.severity},
        el('b', {}, sentence(warning.code.replace(/_/g, ' '))),
        warning.detail ? `: ${warning.detail.replace(/\.$/, '')}. ` : ' ',
        warning.action ? `${warning.action} ` : null,
        warning.pointer ? el('button', {type: 'button', onclick: () => focus(warning.pointer)}, warning.pointer) : null,
      ),
    ),
    ...reasons.filter((reason) => !named.has(reason)).map((reason) => el('li', {}, sentence(reason.replace(/_/g, ' ')))),
  ];
  return [
    el(
      'div',
      {class: `verdict ${tone}`},
      el('p', {}, el('span', {class: 'pill'}, titles[status]), proof, el('span', {class: 'soft right'}, `answered in ${milliseconds.toFixed(0)} ms`)),
      notes.length ? el('ul', {}, ...notes) : null,
    ),
  ];
}

export function figures(root: HTMLElement, picture: Picture): void {
  root.replaceChildren(
    ...picture.figures.map((figure) =>
      el('div', {class: 'figure'}, el('span', {}, sentence(figure.name)), el('b', {}, figure.value, el('small', {}, figure.unit ? ` ${figure.unit}` : ''))),
    ),
  );
}

/** Writes the values under the cursor, until what it returns is called. */
export function readout(picture: Picture): (() => void) | null {
  const links = [...new Set(picture.charts.map((chart) => chart.link))];
  if (!links.length || !picture.readout) {
    byId('readout')?.replaceChildren();
    return null;
  }
  const write = (index: number | null, link = '') => {
    const root = byId('readout');
    if (!root) return;
    const rows = index === null ? [] : (picture.readout?.(index, link) ?? []);
    root.replaceChildren(...rows.flatMap(([name, value]) => [el('div', {}, el('dt', {}, name), el('dd', {}, value))]));
    if (!rows.length)
      root.replaceChildren(el('div', {class: 'soft'}, el('dt', {}, 'Point at a chart or the cut end to read its values; the cursor moves in every view.')));
  };
  const forget = links.map((link) => listen(link, (index) => write(index, link)));
  write(null);
  return () => forget.forEach((each) => each());
}

export function table(given: Table): HTMLElement {
  const bare = given.head.every((each) => each === '');
  return el(
    'section',
    {class: 'block', id: given.id ? `table-${given.id}` : null},
    el('h3', {}, given.title),
    el(
      'div',
      {class: 'scroll', tabindex: '0', role: 'group', 'aria-label': given.title},
      el(
        'table',
        {},
        bare ? null : el('thead', {}, el('tr', {}, ...given.head.map((text) => el('th', {scope: 'col'}, text)))),
        el('tbody', {}, ...given.rows.map((row) => el('tr', {}, ...row.map((text) => el('td', {}, text))))),
      ),
    ),
  );
}

/** What was measured against what is allowed, as a share of the limit. */
export function proof(answer: Answer): HTMLElement {
  const rows = answer.verification.checks.map((check) => {
    const share = check.limit > 0 ? Math.min(1, Math.max(0, check.value / check.limit)) : 0;
    const held = holds(check);
    return el(
      'tr',
      {class: held ? '' : 'failed'},
      el('td', {}, label(check.name)),
      el('td', {}, short4(check.value)),
      el('td', {}, short4(check.limit)),
      el('td', {}, spelled(check.unit)),
      el('td', {}, el('meter', {min: '0', max: '1', value: share, 'aria-label': `${label(check.name)}: share of the limit`})),
      el('td', {}, held ? 'holds' : 'FAILED'),
    );
  });
  const job = answer.job;
  return el(
    'div',
    {class: 'columns'},
    el(
      'section',
      {class: 'block'},
      el('h3', {}, 'Proof'),
      el('p', {class: 'soft'}, 'Residuals computed from the answer by other formulas than those that made it.'),
      el(
        'div',
        {class: 'scroll', tabindex: '0', role: 'group', 'aria-label': 'Proof'},
        el(
          'table',
          {},
          el('thead', {}, el('tr', {}, ...['check', 'value', 'limit', '', 'of the limit', ''].map((t) => el('th', {scope: 'col'}, t)))),
          el('tbody', {}, ...rows),
        ),
      ),
    ),
    table({
      title: 'Job',
      head: ['', ''],
      rows: [
        ['engine', job.engine],
        ['job', job.id],
        ['input sha-256', job.input_sha256],
        ['result sha-256', job.result_sha256],
      ],
    }),
  );
}

/** Every column of the answer's points. */
export function columns(answer: Answer): HTMLElement {
  const found: [string, Row][] = [];
  const look = (row: Row, name: string) => {
    for (const [key, value] of Object.entries(row)) {
      const each = Array.isArray(value) && isRow(value[0]) ? value.map((v, i): [string, Json] => [`${key} ${i + 1}`, v]) : [[key, value] as [string, Json]];
      for (const [title, inner] of each) {
        if (!isRow(inner)) continue;
        const lists = Object.values(inner).filter((v) => Array.isArray(v) && typeof v[0] !== 'object');
        if (lists.length > 1 && (lists[0] as Json[]).length > 2) found.push([name ? `${name} ${title}` : title, inner]);
        else look(inner, title);
      }
    }
  };
  look(answer.result, '');
  const most = 1000;
  return el(
    'div',
    {},
    ...found.slice(0, 6).map(([name, row]) => {
      const cols = Object.entries(row).filter(([, v]) => Array.isArray(v)) as [string, Json[]][];
      const count = Math.min(most, cols[0]?.[1].length ?? 0);
      return table({
        title: `${sentence(label(name))}, ${cols[0]?.[1].length} rows${count === most ? ` (the first ${most} here)` : ''}`,
        head: cols.map(([key]) => `${label(key)} ${unit(key)}`.trim()),
        rows: Array.from({length: count}, (_, i) => cols.map(([, v]) => (typeof v[i] === 'number' ? short4(v[i] as number) : String(v[i] ?? '')))),
      });
    }),
  );
}

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
};
const known = (media: string): [string, string] => endings[media] ?? (/dstv|nc1/.test(media) ? ['DSTV', 'nc1'] : [media, 'txt']);

/** By the order and part of the reference, else by the job's own name; then the drawing and the beginning of the input's hash. */
function fileName(name: string, body: Row, view: string | undefined, hash: string | null): string {
  const reference = (body['reference'] ?? {}) as Record<string, unknown>;
  const words = [reference['order'], reference['part']].filter((word): word is string => typeof word === 'string');
  const parts = [...(words.length ? words : [name]), view ?? '', hash?.slice(0, 8) ?? ''].filter(Boolean);
  return parts.join('-').replace(/[\\/:*?"<>|\s]+/g, '_');
}

/** A button for every format that the contract offers here, and a field for what a format asks. The file is what the service answers. */
export function downloads(endpoint: string, name: string, body: Row, formats: Format[]): HTMLElement {
  const status = el('p', {class: 'soft', role: 'status'});
  const given = new Map<string, HTMLInputElement | HTMLSelectElement>();
  const fetchFile = async ({media, options}: Format, view?: string) => {
    status.textContent = '';
    const query = new URLSearchParams(view ? {view} : {});
    for (const option of options) {
      const value = given.get(option.name)?.value;
      if (value) query.set(option.name, value);
    }
    const reply = await fetch(`${path(endpoint)}${query.size ? `?${query}` : ''}`, {
      method: 'POST',
      body: JSON.stringify(body),
      headers: headed({'Content-Type': 'application/json', Accept: media}),
    }).catch(() => undefined);
    if (!reply) {
      status.textContent = `${known(media)[0]}: ${away.title}`;
      return;
    }
    if (!reply.ok) {
      const problem = (await reply.json().catch(() => ({title: `status ${reply.status}`}))) as Problem;
      status.textContent = `${known(media)[0]}: ${problem.title} ${problem.detail ?? ''}`;
      return;
    }
    save(`${fileName(name, body, view, reply.headers.get('Tubecut-Input-Sha256'))}.${known(media)[1]}`, await reply.blob());
  };
  const button = (format: Format, view?: string) =>
    el(
      'button',
      {type: 'button', 'data-media': format.media, 'data-view': view, onclick: () => void fetchFile(format, view)},
      view ? `${known(format.media)[0]} ${view}` : known(format.media)[0],
    );
  const buttons = formats.flatMap((format) => (format.views.length ? format.views.map((view) => button(format, view)) : [button(format)]));
  const options = new Map(formats.flatMap((format) => format.options).map((option) => [option.name, option]));
  const fields = [...options.values()].map((option) => {
    const users = formats
      .filter((format) => format.options.some((each) => each.name === option.name))
      .map(({media}) => known(media)[0])
      .join(', ');
    const choices = option.schema.enum ?? (option.schema.type === 'boolean' ? ['false', 'true'] : undefined);
    const input = choices
      ? el(
          'select',
          {},
          el('option', {value: ''}, `${String(option.schema.default ?? '')} (default)`),
          ...choices.map((c) => el('option', {value: c}, String(c))),
        )
      : // A speed has no default; one to begin with spares a refusal.
        el('input', {type: 'text', inputmode: 'decimal', value: option.name === 'speed_mm_min' ? '600' : '', placeholder: option.schema.default ?? ''});
    input.setAttribute('aria-label', `${label(option.name)}, for ${users}`);
    input.dataset['option'] = option.name;
    given.set(option.name, input);
    return el(
      'label',
      {class: 'field', title: option.description},
      el('span', {class: 'name'}, `${label(option.name)} (${users})`),
      el('span', {class: 'box'}, input, unit(option.name) ? el('span', {class: 'unit'}, unit(option.name)) : null),
    );
  });
  return el(
    'section',
    {class: 'block'},
    el('h3', {}, `Download: ${endpointName(endpoint)}`),
    fields.length ? el('div', {class: 'options'}, ...fields) : null,
    el('div', {class: 'offers'}, ...buttons),
    status,
  );
}
