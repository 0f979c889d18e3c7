import * as address from './address';
import {Board} from './charts';
import * as controls from './controls';
import {byId, el} from './dom';
import {Form} from './form';
import {hints} from './hint';
import {Inspector} from './inspector';
import {clone, type Row} from './json';
import {keyed} from './key';
import {rest} from './links';
import {Model} from './model';
import {Motion} from './motion';
import {endpointName, endpointOrder, exampleName, tabs} from './names';
import * as onward from './onward';
import * as panels from './panels';
import type {Picture} from './picture';
import {Player} from './play';
import * as preset from './preset';
import {pictured} from './pictures';
import {contextOf, without, type Context} from './pictures/context';
import type {Contract} from './schema';
import {ask, away, Latest, path, type Answer, type Endpoint, type Example, type Reply} from './service';
import type {Stage} from './scene/stage';
import {SectionView} from './section';

interface State {
  endpoint: string;
  example: string | undefined;
  body: Row;
  edited: boolean;
  view: 'before' | 'after';
  partners: boolean;
  tab: string;
  item: number | null; // chosen in the picture or beside it
}

const firstJob = {endpoint: 'bevel-tables', example: 'source-000-table-1'};

/** The page: a job's form, its answer in pictures and tables, and the address that holds it. */
export class Console {
  private readonly latest = new Latest();
  private readonly form: Form;
  private readonly charts = new Board(byId('charts'));
  private readonly motion: Motion;
  private readonly player = new Player(byId('player'));
  private readonly section = new SectionView(byId('section'));
  private readonly inspector = new Inspector(byId('inspector'), {
    open: (endpoint, body) => void this.follow(endpoint, body),
    focus: (pointer) => this.seek(pointer),
    chose: (item) => {
      this.state.item = item;
      this.remember();
    },
  });
  private readonly context: Context;
  private readonly model: Model;
  private state: State = {...firstJob, body: {}, edited: false, view: 'after', partners: true, tab: 'proof', item: null};
  private stage: Promise<Stage | null> | null = null;
  private answer: Answer | undefined;
  private picture: Picture | undefined;
  private reply: Reply | undefined;
  private job = 0; // counts what was opened; edits are of the same job
  private askedJob = 0;
  private drawnJob = 0; // the one that the pictures are of
  private lost = false; // the address holds a link that cannot be read
  private written = '';
  private writtenJob = 0;
  private writing = 0;
  private unlisten: (() => void) | null = null;

  constructor(
    private readonly contract: Contract,
    private readonly examples: Example[],
    private readonly endpoints: Endpoint[],
    machines: {name: string; machine: Row}[],
    tubes: {size: string; outer_diameter_mm: number; wall_mm: number}[],
  ) {
    hints(byId('form'), byId('hint'));
    const sizes = new Map(tubes.map((t) => [t.size, {outer: t.outer_diameter_mm, wall: t.wall_mm}]));
    this.context = contextOf(sizes, new Map(machines.map((m) => [m.name, m.machine])));
    this.motion = new Motion(this.context);
    const schedules = [...sizes.keys()].flatMap((size) => /^NPS \S+ (.+)$/.exec(size)?.[1] ?? []);
    this.model = new Model([...new Set(schedules)], (frame) => this.begin('frames', undefined, frame, true));
    this.form = new Form(byId('form'), contract, {machines: machines.map((m) => m.name), sizes: [...sizes.keys()]}, () => this.edited());
    byId<HTMLSelectElement>('example').addEventListener('change', (event) => this.open(this.state.endpoint, (event.target as HTMLSelectElement).value));
    byId('preset').addEventListener('click', () => this.press());
    byId('blank').addEventListener('click', () => this.blank());
    byId('edit').addEventListener('click', () => this.formShown(byId('edit').getAttribute('aria-expanded') !== 'true'));
    byId('reset').addEventListener('click', () => this.open(this.state.endpoint, this.state.example));
    byId('share').addEventListener('click', () => void this.share());
    byId('forget').addEventListener('click', () => void this.forget());
    addEventListener('hashchange', ({newURL}) => {
      const {hash} = new URL(newURL);
      if (hash !== this.written) void this.arrive(hash);
    });
    this.drawNavigation();
  }

  /** Where the reader went: by the time this is heard of, the job before may have written its own address over it. */
  async arrive(hash: string): Promise<void> {
    clearTimeout(this.writing);
    const place = await address.read(hash);
    if (!place && hash && this.job) return this.remember(); // a place in this page
    if (place && 'damage' in place) return this.lose(place.damage);
    const {endpoint, example, body, view} = place ?? {...firstJob, body: undefined, view: {} as Record<string, string>};
    if (!this.endpoints.some((e) => e.id === endpoint)) return this.lose(`Nothing here is called "${endpoint}".`);
    if (example && !this.examples.some((e) => e.endpoint === endpoint && e.name === example))
      return this.lose(`${endpointName(endpoint)} has no example called "${example}".`);
    this.state.view = view['view'] === 'before' ? 'before' : 'after';
    this.state.partners = view['partners'] !== 'off';
    this.state.tab = view['tab'] ?? 'proof';
    if (body) this.begin(endpoint, undefined, body, true);
    else this.open(endpoint, example);
    this.state.item = /^\d+$/.test(view['item'] ?? '') ? Number(view['item']) : null;
    this.writtenJob = this.job;
  }

  /** A link that cannot be read is said to be, and nothing of another job is shown in its place. */
  private lose(why: string): void {
    this.job += 1;
    this.lost = true;
    Object.assign(this.state, {endpoint: '', example: undefined, body: {}, edited: false});
    this.reply = undefined;
    this.clear();
    this.form.show({properties: {}}, {});
    this.drawPick();
    byId('details').replaceChildren();
    panels.silence(byId('verdict'), 'This link is damaged.', `${why} Ask for it anew, or choose above what to compute.`, undefined, 'no job');
    this.said();
  }

  private open(endpoint: string, name?: string): void {
    const own = this.examples.filter((example) => example.endpoint === endpoint);
    const example = own.find((each) => each.name === name) ?? own.find((each) => each.name === firstJob.example) ?? own[0];
    const schema = this.contract.request(path(endpoint));
    this.begin(endpoint, example?.name, example ? clone(example.body) : (this.contract.make(schema ?? {}) as Row), false);
  }

  /** The fewest fields that make a job, as the contract has them. */
  private blank(): void {
    const {endpoint} = this.state;
    const schema = this.contract.request(path(endpoint)) ?? {};
    this.begin(endpoint, undefined, this.contract.make(schema) as Row, true);
    this.formShown(true);
    byId('form').querySelector<HTMLElement>('input, select')?.focus();
  }

  /** On a phone the picture comes first, and the form when it is asked for. */
  private formShown(shown: boolean): void {
    byId('ask').classList.toggle('open', shown);
    byId('edit').setAttribute('aria-expanded', String(shown));
    byId('edit').textContent = shown ? 'Back to the picture' : 'Change the job';
  }

  private begin(endpoint: string, example: string | undefined, body: Row, edited: boolean): void {
    Object.assign(this.state, {endpoint, example, body, edited, item: null});
    this.job += 1;
    this.lost = false;
    this.model.began(endpoint, body);
    rest();
    this.form.show(this.contract.request(path(endpoint)) ?? {}, body);
    this.drawPick();
    this.compute();
  }

  /** Cuts square, or again as before. */
  private press(): void {
    const {body, endpoint} = this.state;
    preset.toggle(body, this.answer?.request);
    this.form.show(this.contract.request(path(endpoint)) ?? {}, body);
    this.edited();
  }

  private edited(): void {
    this.state.edited = true;
    this.drawPick();
    this.compute();
  }

  private compute(): void {
    const {job} = this;
    this.latest.run(async (signal) => {
      if (job !== this.job) return;
      const {endpoint} = this.state;
      const body = clone(this.state.body);
      // Not at once: one more frame of the page costs as much as most answers.
      const busy = setTimeout(() => document.body.classList.add('busy'), 200);
      try {
        const reply = await ask(endpoint, body, signal);
        const drawn = reply.answer && !signal.aborted ? await pictured(endpoint, body, reply.answer, this.context) : undefined;
        if (job === this.job && !signal.aborted) this.take(reply, drawn);
      } finally {
        clearTimeout(busy);
        document.body.classList.remove('busy');
      }
    }, job !== this.askedJob);
    this.askedJob = job;
    this.remember();
  }

  /** An answer is drawn; a problem leaves the last pictures, faded, and marks its fields. */
  private take(reply: Reply, drawn: Picture | Error | undefined): void {
    this.reply = reply;
    byId('forget').hidden = !keyed();
    document.body.classList.toggle('stale', !reply.answer);
    this.form.complain(reply.problem?.errors ?? []);
    panels.verdict(
      byId('verdict'),
      reply.answer,
      reply.problem,
      reply.milliseconds,
      (pointer) => this.seek(pointer),
      () => this.compute(),
      drawn instanceof Error ? '' : drawn?.said,
    );
    if (reply.answer) {
      if (drawn instanceof Error) this.clear();
      this.answer = reply.answer;
      this.form.understood(reply.answer.request);
      this.trouble(drawn instanceof Error ? drawn : undefined);
      this.leadOn(reply.answer, drawn instanceof Error);
      if (drawn && !(drawn instanceof Error)) {
        this.picture = drawn;
        this.draw();
      }
    } else if (this.drawnJob !== this.job) this.clear(); // no picture of another job beside a refusal
    this.drawDetails();
    this.said();
  }

  /** What cannot be drawn leads to its files alone. */
  private leadOn(answer: Answer, odd: boolean): void {
    const {endpoint, body} = this.state;
    const leads = odd ? [] : onward.leadsOf(endpoint, body, answer, this.context, this.contract);
    const offered = leads.filter((lead) => this.endpoints.some(({id}) => id === lead.endpoint));
    onward.show(
      byId('onward'),
      offered,
      (to, job) => void this.follow(to, job),
      () => this.choose('downloads'),
    );
  }

  /** Shows a field of the form. */
  private seek(pointer: string): void {
    this.formShown(true);
    this.form.focus(pointer);
  }

  /** Counts what the page came to say: those who wait for it see this. */
  private said(): void {
    document.body.dataset['answers'] = String(Number(document.body.dataset['answers'] ?? 0) + 1);
  }

  /** What goes wrong in drawing is said above the pictures. */
  private trouble(failure: unknown): void {
    const note = byId('trouble');
    note.hidden = failure === undefined;
    note.textContent = failure === undefined ? '' : `Not all of this answer could be drawn: ${failure instanceof Error ? failure.message : String(failure)}`;
  }

  private clear(): void {
    this.answer = this.picture = undefined;
    this.trouble(undefined);
    this.charts.show([]);
    this.inspector.show(undefined);
    this.player.show(undefined);
    this.section.show(undefined);
    byId('onward').hidden = true;
    byId('solid').hidden = true;
    byId('figures').replaceChildren();
  }

  private draw(): void {
    const {picture} = this;
    if (!picture) return;
    this.drawnJob = this.job;
    byId('pictures').classList.toggle('alone', !picture.solid || !(picture.charts.length || picture.inspected));
    byId('pictures').classList.toggle('inspected', picture.inspected !== undefined);
    panels.figures(byId('figures'), picture);
    this.drawSolid(picture).catch((failure) => this.trouble(failure)); // first: the readout stands under the solid
    try {
      this.charts.show(picture.charts);
      this.inspector.show(picture.inspected, this.state.item);
      this.player.show(picture.played);
      this.section.show(picture.section);
      this.unlisten?.();
      this.unlisten = panels.readout(picture);
    } catch (failure) {
      this.trouble(failure);
    }
  }

  private async drawSolid(picture: Picture): Promise<void> {
    const root = byId('solid');
    root.hidden = !picture.solid;
    if (!picture.solid) return;
    this.stage ??= this.build(root);
    const stage = await this.stage;
    if (!stage || picture !== this.picture) return;
    this.drawSwitches(picture);
    stage.show(picture.solid, this.state.view === 'before' && picture.beforeAfter === true, `${endpointName(this.state.endpoint)} in 3D`, this.job);
    stage.partnersShown(this.state.partners);
  }

  /** The 3D code is large and comes when it is first needed. */
  private async build(root: HTMLElement): Promise<Stage | null> {
    const canvas = el('div', {class: 'canvas'});
    root.replaceChildren(canvas, el('div', {class: 'switches', id: 'switches'}), el('div', {class: 'scale', id: 'scale'}), el('dl', {id: 'readout'}));
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
      controls.toggle(text, pressed, id, () => {
        act();
        this.draw();
        this.remember();
        byId(id)?.focus();
      });
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
      el('button', {type: 'button', title: 'The picture, the curves and the tables on paper', onclick: () => print()}, 'Print'),
    );
    const [low, high] = picture.solid?.scale ?? [];
    const legend = picture.solid?.legend?.map(({tone, text}) => controls.key(tone, text));
    byId('scale').replaceChildren(...(legend ?? [low ?? '', el('i'), high ?? '']));
    byId('scale').hidden = low === undefined && !legend;
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
      ...(example ? [] : [el('option', {selected: true, value: ''}, 'A job of your own')]),
      ...own.map((each) => el('option', {value: each.name, selected: each.name === example}, exampleName(endpoint, each.name))),
    );
    byId('blank').hidden = endpoint === 'replays'; // of which another page's answer is a part
    byId('reset').hidden = !edited || example === undefined;
    byId('preset').hidden = !preset.offered(this.contract, this.contract.request(path(endpoint)));
    byId('preset').setAttribute('aria-pressed', String(preset.pressed(this.state.body)));
    byId<HTMLButtonElement>('share').disabled = this.lost;
    for (const link of byId('endpoints').querySelectorAll('a')) link.toggleAttribute('aria-current', link.dataset['endpoint'] === endpoint);
    document.title = endpoint ? `${endpointName(endpoint)} – tubecut` : 'tubecut';
  }

  private drawDetails(): void {
    const offered = tabs.filter(
      ([id]) => id !== 'motion' || (this.state.endpoint === 'bevel-tables' && this.endpoints.some((e) => e.id === 'pulse-schedules')),
    );
    if (!offered.some(([id]) => id === this.state.tab)) this.state.tab = 'proof';
    const bar = controls.tabBar(offered, this.state.tab, (id) => this.choose(id));
    const panel = el('div', {role: 'tabpanel', id: 'panel', 'aria-labelledby': `tab-${this.state.tab}`});
    byId('details').replaceChildren(bar, panel);
    this.fill(panel);
  }

  private choose(tab: string): void {
    this.state.tab = tab;
    this.drawDetails();
    this.remember();
    byId(`tab-${tab}`).focus();
  }

  private fill(panel: HTMLElement): void {
    const {answer, state, reply} = this;
    const name = state.example ?? state.endpoint;
    if (state.tab === 'json') panel.append(panels.exchange(state.endpoint, state.body, (reply?.answer ?? reply?.problem) as never));
    else if (!answer)
      panel.append(
        el('p', {class: 'soft'}, reply?.problem?.code === away.code ? 'Nothing yet: the service did not answer.' : 'Nothing yet: the request was refused.'),
      );
    else if (state.tab === 'proof')
      panel.append(...(this.picture?.tables?.length ? [el('div', {class: 'columns'}, ...this.picture.tables.map(panels.table))] : []), panels.proof(answer));
    else if (state.tab === 'table') panel.append(panels.columns(answer));
    else if (state.tab === 'downloads') panel.append(panels.downloads(state.endpoint, name, state.body, this.contract.formats(path(state.endpoint))));
    else if (state.tab === 'motion')
      this.motion
        .fill(panel, without(state.body), {
          open: (body) => void this.follow('pulse-schedules', body),
          focus: (pointer) => this.form.focus(pointer),
          again: () => this.drawDetails(),
        })
        .catch((failure) => this.trouble(failure));
  }

  /** Goes on to the next job in line; this one is a step to go back to, as it is seen now. */
  private async follow(endpoint: string, body: Row): Promise<void> {
    clearTimeout(this.writing);
    await this.writeHash();
    this.state.tab = 'proof';
    this.begin(endpoint, undefined, clone(body), true);
    byId('views').focus({preventScroll: true}); // what was pressed is gone
    scrollTo(0, 0);
  }

  /** The hash follows a moment after the last change. */
  private remember(): void {
    clearTimeout(this.writing);
    this.writing = window.setTimeout(() => void this.writeHash(), 250);
  }

  private async writeHash(): Promise<void> {
    if (this.lost) return;
    const {endpoint, example, edited, body, view, partners, tab, item} = this.state;
    const {job} = this;
    const shown = {
      ...(view === 'before' ? {view} : {}),
      ...(partners ? {} : {partners: 'off'}),
      ...(tab === 'proof' ? {} : {tab}),
      ...(item === null ? {} : {item: String(item)}),
    };
    const was = location.hash;
    const hash = await address.written({endpoint, view: shown, ...(edited || !example ? {body} : {example})});
    if (location.hash !== was) return; // somebody went elsewhere meanwhile
    const another = this.writtenJob !== job;
    this.written = hash;
    this.writtenJob = job;
    if (location.hash === hash) return;
    const before = location.hash.split(/[~?]/)[0],
      now = hash.split(/[~?]/)[0];
    // Another job is a step to go back to; a change of this one is not.
    history[another && before !== now ? 'pushState' : 'replaceState'](null, '', hash);
  }

  private async share(): Promise<void> {
    await this.writeHash();
    const button = byId('share');
    const long = address.tooLong(location.hash);
    const done = !long && (await panels.copied(location.href));
    button.textContent = long ? 'Too long for a link' : done ? 'Link copied' : 'Copy the address';
    setTimeout(() => {
      button.textContent = 'Copy link';
    }, 1500);
  }

  /** The page's memory is all that holds the key; the job is in the address. */
  private async forget(): Promise<void> {
    await this.writeHash();
    location.reload();
  }

  recolour(): void {
    this.charts.recolour();
    this.motion.recolour();
    if (this.lost) return;
    this.form.show(this.contract.request(path(this.state.endpoint)) ?? {}, this.state.body);
    if (this.answer) this.form.understood(this.answer.request);
    this.form.complain(this.reply?.problem?.errors ?? []);
    if (this.picture) void this.drawSolid(this.picture);
  }
}
