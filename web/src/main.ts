import * as address from './address';
import {Board} from './charts';
import {byId, el} from './dom';
import {Form} from './form';
import {clone, type Row} from './json';
import {listen, point} from './links';
import {endpointName, endpointOrder, exampleName} from './names';
import * as panels from './panels';
import type {Picture} from './picture';
import {drawing} from './pictures';
import {without, type Context} from './pictures/context';
import {motionFacts, scheduleCharts} from './pictures/machine';
import {Contract} from './schema';
import {ask, fetched, Latest, path, type Answer, type Endpoint, type Example, type Reply} from './service';
import type {Stage} from './scene/stage';

interface State {
  endpoint: string;
  example: string | undefined;
  body: Row;
  edited: boolean;
  view: 'before' | 'after';
  partners: boolean;
  tab: string;
}

const firstJob = {endpoint: 'bevel-tables', example: 'source-000-table-1'};
const tabs: [string, string][] = [
  ['proof', 'Proof'],
  ['motion', 'Pulses and speed'],
  ['table', 'Table'],
  ['json', 'JSON'],
  ['downloads', 'Downloads'],
];

class Console {
  private readonly latest = new Latest();
  private readonly form: Form;
  private readonly charts = new Board(byId('charts'));
  private readonly motion = {root: el('div', {class: 'motion'}), board: null as Board | null, of: ''};
  private readonly context: Context;
  private state: State = {...firstJob, body: {}, edited: false, view: 'after', partners: true, tab: 'proof'};
  private stage: Promise<Stage | null> | null = null;
  private answer: Answer | undefined;
  private picture: Picture | undefined;
  private reply: Reply | undefined;
  private written = '';
  private writing = 0;
  private unlisten: (() => void) | null = null;

  constructor(
    private readonly contract: Contract,
    private readonly examples: Example[],
    private readonly endpoints: Endpoint[],
    machines: {name: string; machine: Row}[],
    tubes: {size: string; outer_diameter_mm: number; wall_mm: number}[],
  ) {
    const sizes = new Map(tubes.map((t) => [t.size, {outer: t.outer_diameter_mm, wall: t.wall_mm}]));
    const known = new Map<string, Promise<Answer | undefined>>();
    this.context = {
      sizes,
      machines: new Map(machines.map((m) => [m.name, m.machine])),
      ask: (endpoint, body) => {
        const key = endpoint + JSON.stringify(body);
        if (known.size > 20) known.clear();
        const found = known.get(key) ?? ask(endpoint, body).then((reply) => reply.answer);
        known.set(key, found);
        return found;
      },
    };
    this.form = new Form(byId('form'), contract, {machines: machines.map((m) => m.name), sizes: [...sizes.keys()]}, () => this.edited());
    byId<HTMLSelectElement>('example').addEventListener('change', (event) => this.open(this.state.endpoint, (event.target as HTMLSelectElement).value));
    byId('reset').addEventListener('click', () => this.open(this.state.endpoint, this.state.example));
    byId('share').addEventListener('click', () => void this.share());
    addEventListener('hashchange', (event) => new URL(event.newURL).hash !== this.written && void this.arrive());
    this.drawNavigation();
  }

  async arrive(): Promise<void> {
    clearTimeout(this.writing);
    const place = await address.read(location.hash);
    const endpoint = this.endpoints.some((e) => e.id === place?.endpoint) ? (place?.endpoint as string) : firstJob.endpoint;
    this.state.view = place?.view['view'] === 'before' ? 'before' : 'after';
    this.state.partners = place?.view['partners'] !== 'off';
    this.state.tab = place?.view['tab'] ?? 'proof';
    if (place?.body) this.begin(endpoint, undefined, place.body, true);
    else this.open(endpoint, place?.example);
  }

  private open(endpoint: string, name?: string): void {
    const own = this.examples.filter((example) => example.endpoint === endpoint);
    const example = own.find((each) => each.name === name) ?? own.find((each) => each.name === firstJob.example) ?? own[0];
    const schema = this.contract.request(path(endpoint));
    this.begin(endpoint, example?.name, example ? clone(example.body) : (this.contract.make(schema ?? {}) as Row), false);
  }

  private begin(endpoint: string, example: string | undefined, body: Row, edited: boolean): void {
    Object.assign(this.state, {endpoint, example, body, edited});
    point('cut', null);
    this.form.show(this.contract.request(path(endpoint)) ?? {}, body);
    this.drawPick();
    this.compute();
  }

  private edited(): void {
    this.state.edited = true;
    byId('reset').hidden = this.state.example === undefined;
    this.compute();
  }

  private compute(): void {
    this.latest.run(async () => {
      const {endpoint} = this.state;
      const body = clone(this.state.body);
      // Not at once: one more frame of the page costs as much as most answers.
      const busy = setTimeout(() => document.body.classList.add('busy'), 200);
      try {
        const reply = await ask(endpoint, body);
        const picture = reply.answer ? await drawing(endpoint)(body, reply.answer, this.context) : undefined;
        if (endpoint === this.state.endpoint) this.take(reply, picture);
      } catch (failure) {
        this.take({problem: {code: 'unreachable', title: 'The service could not be asked.', status: 0, detail: String(failure)}, milliseconds: 0}, undefined);
      } finally {
        clearTimeout(busy);
        document.body.classList.remove('busy');
      }
    });
    this.remember();
  }

  /** An answer is drawn; a problem leaves the last pictures, faded, and marks its fields. */
  private take(reply: Reply, picture: Picture | undefined): void {
    this.reply = reply;
    document.body.classList.toggle('stale', !picture);
    this.form.complain(reply.problem?.errors ?? []);
    panels.verdict(byId('verdict'), reply.answer, reply.problem, reply.milliseconds, (pointer) => this.form.focus(pointer));
    if (reply.answer && picture) {
      this.answer = reply.answer;
      this.picture = picture;
      this.form.understood(reply.answer.request);
      this.draw();
    } else if (this.answer?.job.endpoint !== this.state.endpoint) this.clear();
    this.drawDetails();
    document.body.dataset['answers'] = String(Number(document.body.dataset['answers'] ?? 0) + 1);
  }

  private clear(): void {
    this.answer = this.picture = undefined;
    this.charts.show([]);
    byId('solid').hidden = true;
    byId('figures').replaceChildren();
  }

  private draw(): void {
    const {picture} = this;
    if (!picture) return;
    this.charts.show(picture.charts);
    panels.figures(byId('figures'), picture);
    byId('pictures').classList.toggle('alone', !picture.solid || picture.charts.length === 0);
    void this.drawSolid(picture);
    this.drawReadout(picture);
  }

  private async drawSolid(picture: Picture): Promise<void> {
    const root = byId('solid');
    root.hidden = !picture.solid;
    if (!picture.solid) return;
    this.stage ??= this.build(root);
    const stage = await this.stage;
    if (!stage || picture !== this.picture) return;
    this.drawSwitches(picture);
    stage.show(picture.solid, this.state.view === 'before' && picture.beforeAfter === true, `${endpointName(this.state.endpoint)} in 3D`);
    stage.partnersShown(this.state.partners);
  }

  /** The 3D code is large and comes when it is first needed. */
  private async build(root: HTMLElement): Promise<Stage | null> {
    const canvas = el('div', {class: 'canvas'});
    root.replaceChildren(
      canvas,
      el('div', {class: 'switches', id: 'switches'}),
      el('div', {class: 'scale', 'aria-hidden': 'true'}, 'B −30°', el('i'), '60°'),
      el('dl', {id: 'readout'}),
    );
    try {
      const {Stage: Made} = await import('./scene/stage');
      return new Made(canvas);
    } catch (failure) {
      canvas.append(el('p', {class: 'waiting'}, `No 3D here: ${String(failure)}`));
      return null;
    }
  }

  private drawSwitches(picture: Picture): void {
    const toggle = (text: string, pressed: boolean, act: () => void, id: string) =>
      el(
        'button',
        {
          type: 'button',
          id: id,
          'aria-pressed': String(pressed),
          onclick: () => {
            act();
            this.draw();
            this.remember();
            byId(id)?.focus();
          },
        },
        text,
      );
    const {state} = this;
    byId('switches').replaceChildren(
      ...(picture.beforeAfter
        ? [
            el(
              'span',
              {class: 'pair', role: 'group', 'aria-label': 'Bevel before or after smoothing'},
              ...(['before', 'after'] as const).map((view) =>
                toggle(
                  view === 'before' ? 'Before' : 'After',
                  state.view === view,
                  () => {
                    state.view = view;
                  },
                  `view-${view}`,
                ),
              ),
            ),
          ]
        : []),
      ...(picture.solid?.partners.length
        ? [
            toggle(
              'Partners',
              state.partners,
              () => {
                state.partners = !state.partners;
              },
              'view-partners',
            ),
          ]
        : []),
      el('button', {type: 'button', title: 'Back to the first view', onclick: () => void this.stage?.then((stage) => stage?.reset())}, 'Reset view'),
    );
    document.querySelector<HTMLElement>('#solid .scale')?.toggleAttribute('hidden', !picture.solid?.tubes.some((t) => t.b) && !picture.solid?.holed);
  }

  private drawReadout(picture: Picture): void {
    this.unlisten?.();
    const link = picture.charts[0]?.link;
    if (!link || !picture.readout) {
      byId('readout')?.replaceChildren();
      return;
    }
    const write = (index: number | null) => {
      const root = byId('readout');
      if (!root) return;
      const rows = index === null ? [] : (picture.readout?.(index) ?? []);
      root.replaceChildren(...rows.flatMap(([name, value]) => [el('div', {}, el('dt', {}, name), el('dd', {}, value))]));
      if (!rows.length)
        root.replaceChildren(el('div', {class: 'soft'}, el('dt', {}, 'Point at a chart or the cut end to read its values; the cursor moves in every view.')));
    };
    this.unlisten = listen(link, write);
    write(null);
  }

  private drawNavigation(): void {
    const rank = (id: string) => (endpointOrder.indexOf(id) + 100) % 100;
    const offered = this.endpoints.filter((e) => this.contract.request(e.path)).sort((a, b) => rank(a.id) - rank(b.id));
    byId('endpoints').replaceChildren(
      ...offered.map((e) => el('a', {href: `#/${e.id}`, 'data-endpoint': e.id, title: this.contract.summary(e.path)}, endpointName(e.id))),
    );
  }

  private drawPick(): void {
    const {endpoint, example, edited} = this.state;
    const own = this.examples.filter((each) => each.endpoint === endpoint);
    byId<HTMLSelectElement>('example').replaceChildren(
      ...(example ? [] : [el('option', {selected: true, value: ''}, 'From a link')]),
      ...own.map((each) => el('option', {value: each.name, selected: each.name === example}, exampleName(each.name))),
    );
    byId('reset').hidden = !edited || example === undefined;
    for (const link of byId('endpoints').querySelectorAll('a')) link.toggleAttribute('aria-current', link.dataset['endpoint'] === endpoint);
    document.title = `${endpointName(endpoint)} – tubecut`;
  }

  private drawDetails(): void {
    const offered = tabs.filter(
      ([id]) => id !== 'motion' || (this.state.endpoint === 'bevel-tables' && this.endpoints.some((e) => e.id === 'pulse-schedules')),
    );
    if (!offered.some(([id]) => id === this.state.tab)) this.state.tab = 'proof';
    const choose = (id: string) => {
      this.state.tab = id;
      this.drawDetails();
      this.remember();
      byId(`tab-${id}`).focus();
    };
    const bar = el(
      'div',
      {role: 'tablist', class: 'tabs', 'aria-label': 'Details'},
      ...offered.map(([id, name], i) =>
        el(
          'button',
          {
            type: 'button',
            role: 'tab',
            id: `tab-${id}`,
            'aria-selected': String(id === this.state.tab),
            'aria-controls': 'panel',
            tabindex: id === this.state.tab ? '0' : '-1',
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
    const panel = el('div', {role: 'tabpanel', id: 'panel', 'aria-labelledby': `tab-${this.state.tab}`});
    byId('details').replaceChildren(bar, panel);
    this.fill(panel);
  }

  private fill(panel: HTMLElement): void {
    const {answer, state, reply} = this;
    const name = state.example ?? state.endpoint;
    if (state.tab === 'json') panel.append(panels.exchange(state.endpoint, state.body, (reply?.answer ?? reply?.problem) as never));
    else if (!answer) panel.append(el('p', {class: 'soft'}, 'Nothing yet: the request was refused.'));
    else if (state.tab === 'proof')
      panel.append(...(this.picture?.tables?.length ? [el('div', {class: 'columns'}, ...this.picture.tables.map(panels.table))] : []), panels.proof(answer));
    else if (state.tab === 'table') panel.append(panels.columns(answer));
    else if (state.tab === 'downloads') panel.append(this.offers(name));
    else if (state.tab === 'motion') void this.fillMotion(panel);
  }

  private offers(name: string): HTMLElement {
    const {endpoint, body} = this.state;
    return panels.downloads(endpoint, name, body, this.contract.formats(path(endpoint)));
  }

  /** The pulses of this cut on a machine, at a speed: the next job in line, shown without leaving this one. */
  private async fillMotion(panel: HTMLElement): Promise<void> {
    const body = {cut: without(this.state.body), machine: 'five_axis_cutter', motion: {speed: {mm_min: 600}}};
    panel.append(
      el(
        'p',
        {class: 'soft'},
        'On the five-axis cutter at 600 mm/min. ',
        el(
          'button',
          {
            type: 'button',
            id: 'open-pulses',
            onclick: () => {
              this.state.tab = 'proof';
              this.begin('pulse-schedules', undefined, clone(body) as unknown as Row, true);
            },
          },
          'Change machine, speed, lead …',
        ),
      ),
      this.motion.root,
    );
    const key = JSON.stringify(body);
    if (this.motion.of === key) return;
    this.motion.of = key;
    this.motion.board ??= new Board(this.motion.root);
    const reply = await ask('pulse-schedules', body as never);
    if (this.motion.of !== key) return;
    this.motion.root.querySelectorAll('.extra').forEach((node) => node.remove());
    this.motion.board.show(reply.answer ? scheduleCharts(reply.answer.result, this.context.machines.get(body.machine)) : []);
    const extra = el('div', {class: 'extra'});
    if (reply.answer) {
      const facts = motionFacts(reply.answer.result);
      const figures = el('div', {class: 'figures'});
      panels.figures(figures, {charts: [], ...facts});
      extra.append(figures, el('div', {class: 'columns'}, ...(facts.tables ?? []).map(panels.table)));
    } else panels.verdict(extra, undefined, reply.problem, 0, (pointer) => this.form.focus(pointer.replace(/^\/cut/, '')));
    this.motion.root.append(extra);
  }

  /** The hash follows a moment after the last change. */
  private remember(): void {
    clearTimeout(this.writing);
    this.writing = window.setTimeout(() => void this.writeHash(), 250);
  }

  private async writeHash(): Promise<void> {
    const {endpoint, example, edited, body, view, partners, tab} = this.state;
    const shown = {...(view === 'before' ? {view} : {}), ...(partners ? {} : {partners: 'off'}), ...(tab === 'proof' ? {} : {tab})};
    const was = location.hash;
    const hash = await address.written({endpoint, view: shown, ...(edited || !example ? {body} : {example})});
    if (location.hash !== was) return; // somebody went elsewhere meanwhile
    this.written = hash;
    if (location.hash === hash) return;
    const before = location.hash.split(/[~?]/)[0],
      now = hash.split(/[~?]/)[0];
    // Another job is a step to go back to; a change of this one is not.
    history[before === now || edited ? 'replaceState' : 'pushState'](null, '', hash);
  }

  private async share(): Promise<void> {
    await this.writeHash();
    const done = await panels.copied(location.href);
    const button = byId('share');
    button.textContent = done ? 'Link copied' : 'Copy the address';
    setTimeout(() => {
      button.textContent = 'Copy link';
    }, 1500);
  }

  recolour(): void {
    this.charts.recolour();
    this.motion.board?.recolour();
    this.form.show(this.contract.request(path(this.state.endpoint)) ?? {}, this.state.body);
    if (this.answer) this.form.understood(this.answer.request);
    this.form.complain(this.reply?.problem?.errors ?? []);
    if (this.picture) void this.drawSolid(this.picture);
  }
}

/** Light or dark: what was chosen last, else what the system says. */
function themed(page: () => Console | undefined): void {
  const system = matchMedia('(prefers-color-scheme: dark)');
  const button = byId('theme');
  const apply = () => {
    let chosen: string | null = null;
    try {
      chosen = localStorage.getItem('theme');
    } catch {
      /* no storage: the system's */
    }
    const dark = chosen ? chosen === 'dark' : system.matches;
    document.documentElement.dataset['theme'] = dark ? 'dark' : 'light';
    button.textContent = dark ? 'Light' : 'Dark';
    button.setAttribute('aria-label', dark ? 'Switch to light' : 'Switch to dark');
    page()?.recolour();
  };
  button.addEventListener('click', () => {
    try {
      localStorage.setItem('theme', document.documentElement.dataset['theme'] === 'dark' ? 'light' : 'dark');
    } catch {
      /* not remembered */
    }
    apply();
  });
  system.addEventListener('change', apply);
  apply();
}

async function begin(): Promise<void> {
  let page: Console | undefined;
  themed(() => page);
  try {
    const [contract, examples, version, machines, tubes] = await Promise.all([
      fetched<ConstructorParameters<typeof Contract>[0]>('/openapi.json'),
      fetched<{examples: Example[]}>('/v1/examples'),
      fetched<{endpoints: Endpoint[]}>('/v1/version'),
      fetched<{machines: {name: string; machine: Row}[]}>('/v1/machines'),
      fetched<{tubes: {size: string; outer_diameter_mm: number; wall_mm: number}[]}>('/v1/tubes'),
    ]);
    page = new Console(new Contract(contract), examples.examples, version.endpoints, machines.machines, tubes.tubes);
    await page.arrive();
  } catch (failure) {
    byId('verdict').replaceChildren(el('div', {class: 'verdict bad'}, el('p', {}, `The console could not start: ${String(failure)}`)));
  }
}

void begin();
