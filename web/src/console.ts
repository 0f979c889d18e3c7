import {batch, signal} from '@preact/signals';
import * as address from './address';
import {byId, save} from './dom';
import {draftOf, keep, newId, takeOver} from './drafts';
import {remember, remembered, type Purpose} from './files';
import {Form} from './form';
import {clone, type Row} from './json';
import {keyed} from './key';
import {choose as speak, type Language, later, t} from './language';
import {point, rest} from './links';
import {endpointName, endpointOrder, tabs} from './names';
import {leadsOf, type Lead} from './onward';
import type {Picture} from './picture';
import {pictured} from './pictures';
import {shownAt} from './pictures/axis';
import {contextOf, without, type Context} from './pictures/context';
import * as preset from './preset';
import {jobOf} from './recognise';
import type {Contract} from './schema';
import type {Program} from './program';
import {ask, gone, Latest, path, type Answer, type Endpoint, type Example, type Machine, type Reply, type Tube} from './service';
import {SecondOpinion} from './second_opinion';
import {Watch} from './watch';

/** Pages without a job. */
type Place = 'start' | 'own-machine';
const firstJob = {endpoint: 'bevel-tables', example: 'source-000-table-1'};

/** Optional fields that a new job has: without `connect` no member of a frame would be cut. */
const usual: Record<string, Row> = {frames: {connect: {within_mm: 5}}};

/** Runs after the change is drawn. */
const drawn = (act: () => void) => queueMicrotask(act);

/** The state of the page, of which the views are drawn: a job, its answer, and the address that holds it. */
export class Console {
  readonly endpoint = signal(firstJob.endpoint);
  readonly example = signal<string | undefined>(firstJob.example);
  readonly edited = signal(false);
  readonly view = signal<'before' | 'after'>('after');
  readonly partners = signal(true);
  readonly tab = signal('proof');
  readonly item = signal<number | null>(null); // chosen in the picture or next to it
  readonly job = signal(0); // counts opened jobs; edits belong to the same job
  readonly changes = signal(0); // of the job
  readonly formShown = signal(false);
  readonly home = signal(false); // a page without a job is shown: the first one, or the one that `place` names
  readonly place = signal<Place>('start');
  readonly ownWrong = signal(false); // the page of the own machine lists errors
  readonly lost = signal<(() => string) | null>(null); // why the link in the address cannot be read
  readonly lostAs = signal('damaged');
  readonly reply = signal<Reply | undefined>(undefined);
  readonly opinion = new SecondOpinion();
  readonly answer = signal<Answer | undefined>(undefined);
  readonly picture = signal<Picture | undefined>(undefined);
  readonly program = signal<Program | undefined>(undefined); // previewed, of the request as it is
  readonly said = signal(''); // summary of the picture, for the verdict
  readonly trouble = signal(''); // error of the drawing
  readonly leads = signal<Lead[]>([]);
  readonly wanted = signal(0); // how often files of a purpose were asked for
  readonly linked = signal(later('Copy link')); // a key of the texts
  readonly keyed = signal(false);

  readonly form: Form;
  readonly context: Context;
  readonly schedules: string[];
  private readonly latest = new Latest();
  private readonly watch = new Watch();
  private draft = newId();
  private taken: Row[] | undefined; // out of the request, when the preset was pressed
  private askedJob = 0;
  private questions = 0;
  private drawnJob = 0; // the one that the pictures are of
  private redraw: (() => Promise<Picture | Error>) | undefined; // the last pictures
  private written = '';
  private writtenJob = 0;
  private writing = 0;

  constructor(
    readonly contract: Contract,
    readonly examples: Example[],
    private readonly endpoints: Endpoint[],
    machines: Machine[],
    {tubes, rectangular_tubes}: {tubes: Tube[]; rectangular_tubes: {size: string}[]},
  ) {
    takeOver();
    const sizes = new Map(tubes.map((t) => [t.size, {outer: t.outer_diameter_mm, wall: t.wall_mm}]));
    this.context = contextOf(sizes, new Map(machines.map((m) => [m.name, m.machine])));
    this.schedules = [...new Set([...sizes.keys()].flatMap((size) => /^NPS \S+ (.+)$/.exec(size)?.[1] ?? []))];
    this.form = new Form(
      contract,
      {machine: machines.map((m) => m.name), size: [...sizes.keys()], rectangular_size: rectangular_tubes.map(({size}) => size)},
      () => this.changed(),
    );
    addEventListener('hashchange', ({newURL}) => {
      const {hash} = new URL(newURL);
      if (hash !== this.written) void this.arrive(hash);
    });
    addEventListener('keydown', (event) => this.shortcut(event));
  }

  /** The endpoints, in the order of the pages. */
  get pages(): Endpoint[] {
    const rank = (id: string) => (endpointOrder.indexOf(id) + 100) % 100;
    return this.endpoints.filter((each) => this.contract.request(each.path)).sort((a, b) => rank(a.id) - rank(b.id));
  }

  get own(): Example[] {
    return this.examples.filter((each) => each.endpoint === this.endpoint.value);
  }

  get presetOffered(): boolean {
    return preset.offered(this.contract, this.schema);
  }

  get details(): [string, string][] {
    const motion = this.endpoint.value === 'bevel-tables' && this.endpoints.some((each) => each.id === 'pulse-schedules');
    return tabs.filter(([id]) => id !== 'motion' || motion);
  }

  get body(): Row {
    return this.form.body;
  }

  private get schema() {
    return this.contract.request(path(this.endpoint.value));
  }

  /** Where the reader went: by the time this is heard of, the job before may have written its own address over it. */
  async arrive(hash: string): Promise<void> {
    clearTimeout(this.writing);
    if (/^#\/?own-machine$/.test(hash)) return this.goHome('own-machine');
    const place = await address.read(hash);
    if (!place && hash && hash !== '#/' && this.job.value) return this.remember(); // a place in this page
    if (!place) return this.goHome();
    if (place && 'damage' in place) return this.lose(() => t(place.damage));
    const draft = place.draft ?? (history.state as {draft?: string} | null)?.draft;
    const stored = draft && !place.example ? await draftOf(draft) : undefined;
    const kept = stored?.endpoint === place.endpoint ? stored : undefined;
    if (place.draft && !kept)
      return this.lose(() => t('This job is kept in the browser that it was made in. Save it there as a file, and open the file here.'), 'not here');
    // The draft may be newer than its address, which follows a moment after each change.
    const {endpoint, example, body, view} = {...place, body: kept?.body ?? place.body};
    if (!this.endpoints.some((e) => e.id === endpoint)) return this.lose(() => t('There is no page called "{endpoint}".', {endpoint}));
    if (example && !this.examples.some((e) => e.endpoint === endpoint && e.name === example))
      return this.lose(() => t('{endpoint} has no example called "{example}".', {endpoint: endpointName(endpoint), example}));
    batch(() => {
      this.view.value = view['view'] === 'before' ? 'before' : 'after';
      this.partners.value = view['partners'] !== 'off';
      this.tab.value = view['tab'] ?? 'proof';
      if (body) this.begin(endpoint, undefined, body, true, draft);
      else this.open(endpoint, example);
      this.item.value = /^\d+$/.test(view['item'] ?? '') ? Number(view['item']) : null;
    });
    this.writtenJob = this.job.value;
  }

  private goHome(place: Place = 'start'): void {
    this.form.flush();
    batch(() => {
      this.place.value = place;
      this.home.value = true;
      this.lost.value = null;
    });
    this.written = '';
    this.entitle();
    this.told(this.countQuestion());
  }

  /** Reports that a link cannot be read, and shows nothing of another job in its place. */
  private lose(why: () => string, what = 'damaged'): void {
    batch(() => {
      this.job.value += 1;
      this.home.value = false;
      this.lost.value = why;
      this.lostAs.value = what;
      this.endpoint.value = '';
      this.example.value = this.reply.value = undefined;
      this.edited.value = false;
      this.clear();
      this.form.show({properties: {}}, {});
    });
    this.entitle();
    this.told(this.countQuestion());
  }

  open(endpoint: string, name?: string): void {
    const own = this.examples.filter((example) => example.endpoint === endpoint);
    const example = own.find((each) => each.name === name) ?? own.find((each) => each.name === firstJob.example) ?? own[0];
    const schema = this.contract.request(path(endpoint));
    this.begin(endpoint, example?.name, example ? clone(example.body) : (this.contract.make(schema ?? {}) as Row), false);
  }

  /** The fewest fields that make a job, as the contract has them. */
  blank(): void {
    this.start(this.endpoint.value, {...(this.contract.make(this.schema ?? {}) as Row), ...usual[this.endpoint.value]});
    this.formShown.value = true;
    drawn(() => byId('form').querySelector<HTMLElement>('input, select')?.focus());
  }

  /** A job from the fewest fields, of any endpoint. */
  fresh(endpoint: string): void {
    this.endpoint.value = endpoint;
    this.blank();
  }

  /** `draft`: of a job that has one; else it gets one with its first change. */
  begin(endpoint: string, example: string | undefined, body: Row, edited: boolean, draft?: string): void {
    this.form.flush();
    this.draft = draft ?? newId();
    batch(() => {
      this.endpoint.value = endpoint;
      this.example.value = example;
      this.edited.value = edited;
      this.taken = undefined;
      this.home.value = false;
      this.item.value = this.lost.value = null;
      this.job.value += 1;
      rest();
      this.form.tabled = endpoint === 'frames' ? '/members' : undefined;
      this.form.show(this.schema ?? {}, body);
    });
    this.entitle();
    this.compute();
  }

  private entitle(): void {
    const shown = !this.home.value && this.lost.value === null;
    const own = this.home.value && this.place.value === 'own-machine';
    const name = shown ? endpointName(this.endpoint.value) : own ? t('Own machine and post') : '';
    document.title = name ? `${name} – tubecut` : 'tubecut';
  }

  /** The same page in another language: draws the last answer again, without a request. */
  async speak(to: Language): Promise<void> {
    await speak(to);
    this.entitle();
    const asked = this.countQuestion();
    const {redraw} = this;
    const picture = await redraw?.();
    batch(() => {
      this.form.refresh();
      if (redraw === this.redraw && picture && !(picture instanceof Error)) this.show(picture);
    });
    this.form.complain(this.reply.value?.problem?.errors ?? []);
    this.told(asked);
  }

  private show(picture: Picture): void {
    this.picture.value = picture;
    this.said.value = picture.said ?? '';
    this.leads.value = this.leadsOn();
  }

  /** The same job and answer in other units or words. */
  refresh(): void {
    this.form.refresh();
    this.compute();
  }

  /** A job of one's own, which is kept from its beginning. */
  start(endpoint: string, body: Row): void {
    this.begin(endpoint, undefined, body, true);
    this.keep();
  }

  private keep(): void {
    keep({id: this.draft, endpoint: this.endpoint.value, body: this.body, changed: Date.now()});
  }

  /** The request as a file; it is opened again here, or sent to the service as it is. */
  saveJob(name: string): void {
    this.form.flush();
    save(`${name}.json`, new Blob([JSON.stringify(this.body, null, 2)], {type: 'application/json'}));
  }

  /** A file with a request, or with an answer that has one in it. */
  async openJob(file: File): Promise<void> {
    const job = jobOf(await file.text(), this.contract, this.pages, this.endpoint.value);
    if (job) this.start(job.endpoint, clone(job.body));
    else this.trouble.value = t('{file} is not a job: it must hold a request of this service as JSON.', {file: file.name});
  }

  /** Cuts square, or again as before. */
  press(): void {
    if (preset.pressed(this.body)) this.form.replace(preset.release(this.body, this.taken, this.answer.value?.request));
    else {
      const {body, taken} = preset.press(this.body);
      this.taken = taken;
      this.form.replace(body);
    }
  }

  /** Ctrl+Z, and Ctrl+Y or Ctrl+Shift+Z. A field that is no part of the form keeps its own. */
  private shortcut(event: KeyboardEvent): void {
    const key = event.key.toLowerCase();
    if (!(event.ctrlKey || event.metaKey) || event.altKey || (key !== 'z' && key !== 'y')) return;
    const {target} = event;
    if (target instanceof HTMLElement && target.matches('input, textarea') && !target.closest('#form')) return;
    event.preventDefault();
    this.form.go(key === 'y' || event.shiftKey ? 1 : -1);
  }

  private changed(): void {
    this.edited.value = true;
    this.changes.value += 1;
    this.keep();
    this.compute();
  }

  compute(): void {
    const job = this.job.value;
    const asked = this.countQuestion();
    this.program.value = undefined;
    this.latest.run(async (signal) => {
      if (job !== this.job.value) return;
      const endpoint = this.endpoint.value;
      const body = clone(this.body);
      // Not at once: one more frame of the page costs as much as most answers.
      const busy = setTimeout(() => document.body.classList.add('busy'), 200);
      try {
        const reply = await ask(endpoint, body, signal);
        const {answer} = body['columns'] ? await ask(endpoint, without(body, new Set(['columns'])), signal) : reply; // of some columns no picture can be drawn
        const draw = answer && !signal.aborted ? () => pictured(endpoint, body, answer, this.context) : undefined;
        const picture = await draw?.();
        if (job !== this.job.value || signal.aborted) return;
        if (draw) this.redraw = draw;
        batch(() => this.take(reply, picture, asked));
      } finally {
        clearTimeout(busy);
        document.body.classList.remove('busy');
      }
    }, job !== this.askedJob);
    this.askedJob = job;
    this.remember();
  }

  /** An answer is drawn; a problem leaves the last pictures, faded, and marks its fields. */
  private take(reply: Reply, picture: Picture | Error | undefined, asked: number): void {
    this.reply.value = reply;
    if (gone(reply)) this.watch.begin(() => this.compute());
    else this.watch.end();
    this.keyed.value = keyed();
    document.body.classList.toggle('stale', !reply.answer);
    this.form.complain(reply.problem?.errors ?? []);
    if (reply.answer) {
      const odd = picture instanceof Error;
      if (odd) this.clear();
      this.answer.value = reply.answer;
      this.form.echo.value = reply.answer.request as Row;
      this.said.value = '';
      this.trouble.value = '';
      if (odd) this.failed(picture);
      // If it cannot be drawn, it leads only to its files.
      this.leads.value = odd ? [] : this.leadsOn();
      if (picture && !odd) {
        this.show(picture);
        this.drawnJob = this.job.value;
      }
      // no picture of another job next to a refusal
    } else if (this.drawnJob !== this.job.value) this.clear();
    this.told(asked);
  }

  /** Numbers a question; the page shows the last one, because a test waits until that one, and not an earlier one, is answered. */
  private countQuestion(): number {
    this.questions += 1;
    document.body.dataset['asked'] = String(this.questions);
    return this.questions;
  }

  /** Counts the page's messages, and says which question the last of them answers. */
  private told(asked: number): void {
    const {dataset} = document.body;
    dataset['answers'] = String(Number(dataset['answers'] ?? 0) + 1);
    dataset['answered'] = String(asked);
  }

  /** Shows an error of the drawing above the pictures. */
  readonly failed = (failure: unknown): void => {
    this.trouble.value = t('Not all of this answer could be drawn: {why}', {why: failure instanceof Error ? failure.message : String(failure)});
  };

  private leadsOn(): Lead[] {
    const answer = this.answer.value;
    const leads = answer ? leadsOf(this.endpoint.value, this.body, answer, this.context, this.contract) : [];
    return leads.filter((lead) => this.endpoints.some(({id}) => id === lead.endpoint));
  }

  private clear(): void {
    this.answer.value = this.picture.value = undefined;
    this.trouble.value = '';
  }

  change({view, partners}: {view?: 'before' | 'after'; partners?: boolean}): void {
    this.view.value = view ?? this.view.value;
    this.partners.value = partners ?? this.partners.value;
    this.remember();
  }

  choose(tab: string): void {
    this.tab.value = tab;
    this.remember();
  }

  /** The files of the answer, among the details under it; `purpose`: their use. */
  files(purpose?: Purpose): void {
    if (purpose) remember({...remembered(), purpose});
    this.wanted.value += 1;
    this.choose('downloads');
    drawn(() => byId('tab-downloads').focus());
  }

  /** Shows a field of the form. */
  seek(pointer: string): void {
    this.formShown.value = true;
    this.form.select(pointer);
    drawn(() => this.form.focus(pointer));
  }

  /** Leads to the place of a warning in the charts, if one has it: the cursor is there. */
  shows(warning: Answer['warnings'][number]): (() => void) | undefined {
    const found = shownAt(this.picture.value?.charts ?? [], warning);
    return (
      found &&
      (() => {
        point(found.chart.link, found.index);
        document.getElementById(`chart-${found.chart.id}`)?.scrollIntoView({block: 'nearest'});
      })
    );
  }

  /** Goes on to the next job in line; this one is a step to go back to, as it is seen now. */
  async follow(endpoint: string, body: Row): Promise<void> {
    clearTimeout(this.writing);
    await this.writeHash();
    this.tab.value = 'proof';
    this.start(endpoint, clone(body));
    byId('views').focus({preventScroll: true}); // the pressed button is gone
    scrollTo(0, 0);
  }

  /** The hash follows a moment after the last change, and at once if the job is another: Back must lead to the page before it. */
  remember(): void {
    clearTimeout(this.writing);
    this.writing = window.setTimeout(() => void this.writeHash(), this.writtenJob === this.job.value ? 250 : 0);
  }

  private async writeHash(): Promise<void> {
    if (this.lost.value !== null || this.home.value) return;
    const job = this.job.value;
    const [tab, item, example] = [this.tab.value, this.item.value, this.example.value];
    const view = {
      ...(this.view.value === 'before' ? {view: 'before'} : {}),
      ...(this.partners.value ? {} : {partners: 'off'}),
      ...(tab === 'proof' ? {} : {tab}),
      ...(item === null ? {} : {item: String(item)}),
    };
    const was = location.hash;
    const {draft} = this;
    const hash = await address.written({endpoint: this.endpoint.value, view, draft, ...(this.edited.value || !example ? {body: this.body} : {example})});
    if (location.hash !== was) return; // somebody went elsewhere meanwhile
    const another = this.writtenJob !== job;
    this.written = hash;
    this.writtenJob = job;
    const state = this.edited.value ? {draft} : null;
    if (location.hash === hash) return history.replaceState(state, '');
    const before = location.hash.split(/[~?]/)[0],
      now = hash.split(/[~?]/)[0];
    // Another job is a step to go back to; a change of this one is not.
    history[another && before !== now ? 'pushState' : 'replaceState'](state, '', hash);
  }

  async share(copied: (text: string) => Promise<boolean>): Promise<void> {
    await this.writeHash();
    const long = address.tooLong(location.hash);
    const done = !long && (await copied(location.href));
    this.linked.value = long ? later('Too long: save the job') : done ? later('Link copied') : later('Copy the address');
    setTimeout(() => {
      this.linked.value = later('Copy link');
    }, 1500);
  }

  /** The page's memory is all that holds the key; the job is in the address. */
  async forget(): Promise<void> {
    await this.writeHash();
    location.reload();
  }
}
