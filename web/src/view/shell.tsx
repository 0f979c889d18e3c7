import type {ComponentChildren, ComponentType} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import type {Console} from '../console';
import {LanguageButton} from './language_button';
import {language, t} from '../language';
import {endpointName, exampleName} from '../names';
import {pressed} from '../preset';
import {byTask} from '../tasks';
import {choose, system} from '../units';
import {copied} from './controls';
import {RequestForm} from './form';
import {Jobs} from './jobs';
import {Hint} from './hint';
import {useModel} from './model';
import {Page, useConsole} from './page';
import {Result} from './result';
import {Start} from './start';
import {ThemeButton} from './theme';

/** The frame of every page: `console` once the service has sent its endpoints. */
export function Shell({console, children}: {console?: Console | undefined; children?: ComponentChildren}) {
  return (
    <Page.Provider value={console ?? null}>
      <a class="skip" href={console?.home.value ? `#${console.place.value}` : '#views'}>
        {t('Skip to the result')}
      </a>
      {console && <ToErrors />}
      <header class="top">
        <a class="brand" href="#/" title={t('Start')}>
          <img src="/mark.svg" width={26} height={26} alt="" /> <span>tubecut</span>
        </a>
        <nav id="endpoints" aria-label={t('What to compute')}>
          {console && <Pages />}
        </nav>
        <div class="tools">
          {console && <Links />}
          {console && <Units />}
          <ThemeButton />
          <LanguageButton console={console} />
          <a href="/glossary">{t('Words')}</a>
          <a href="/docs">API</a>
        </div>
      </header>
      <main class={console?.home.value ? 'home' : ''}>
        {console && <Start />}
        {console && (onOwn(console) ? <OwnMachine /> : <Ask />)}
        <section id="views" aria-label={t('Result')} tabIndex={-1} hidden={console?.home.value}>
          <h2 class="offscreen">{t('Result')}</h2>
          {console ? (
            <Result />
          ) : (
            <div id="verdict" role="status" aria-live="polite">
              {children}
            </div>
          )}
        </section>
      </main>
    </Page.Provider>
  );
}

/** From the start of the page to the list of errors, because many stops are before it. */
function ToErrors() {
  const console = useConsole();
  const errors = !console.home.value && console.lost.value === null && console.reply.value?.problem?.errors?.length;
  if (!errors && !(onOwn(console) && console.ownWrong.value)) return null;
  const list = onOwn(console) ? 'own-check' : 'verdict';
  const go = (event: Event) => {
    event.preventDefault();
    document.querySelector<HTMLElement>('#own-machine .errors [data-to], #verdict [data-to]')?.focus();
  };
  return (
    <a class="skip" id="to-errors" href={`#${list}`} onClick={go}>
      {t('Skip to the errors')}
    </a>
  );
}

const onOwn = ({home, place}: Console) => home.value && place.value === 'own-machine';

/** The page comes when it is first opened. */
function OwnMachine() {
  const [View, show] = useState<ComponentType>();
  useEffect(() => void import('./own_machine').then(({OwnMachinePage}) => show(() => OwnMachinePage)), []);
  return View ? <View /> : <p class="waiting">{t('Waiting for the service …')}</p>;
}

function Pages() {
  const console = useConsole();
  const {pages, contract, endpoint, home, place} = console;
  // On a phone the tabs are wider than the screen.
  useEffect(() => {
    const nav = document.getElementById('endpoints');
    const tab = nav?.querySelector('[aria-current]');
    if (!nav || !tab) return;
    const [outer, own] = [nav.getBoundingClientRect(), tab.getBoundingClientRect()];
    nav.scrollLeft += own.left + own.width / 2 - outer.left - outer.width / 2;
  }, [endpoint.value, home.value, place.value, language.value]);
  return (
    <>
      {byTask(pages, ({id}) => id).map(({task, items}) => (
        <span key={task?.id} class="group-of" role="group" data-title={t(task?.name ?? 'More')} aria-label={t(task?.name ?? 'More')}>
          {items.map(({id, path}) => (
            <a
              key={id}
              href={`#/${id}`}
              data-endpoint={id}
              title={t(contract.summary(path))}
              aria-current={!home.value && id === endpoint.value ? 'page' : undefined}
            >
              {endpointName(id)}
            </a>
          ))}
          {task?.id === 'machine' && (
            <a href="#/own-machine" title={t('Own machine and post')} aria-current={onOwn(console) ? 'page' : undefined}>
              {t('Set up')}
            </a>
          )}
        </span>
      ))}
    </>
  );
}

function Links() {
  const console = useConsole();
  return (
    <>
      <button
        id="share"
        type="button"
        title={t('Copy a link to exactly this job')}
        disabled={console.lost.value !== null || console.home.value}
        onClick={() => void console.share(copied)}
      >
        {t(console.linked.value)}
      </button>
      <button id="forget" type="button" title={t('Load the page anew, without the key')} hidden={!console.keyed.value} onClick={() => void console.forget()}>
        {t('Forget key')}
      </button>
    </>
  );
}

/** The request: an example or a job of one's own, and its form. */
function Ask() {
  const console = useConsole();
  const {form, schedules, body} = console;
  const shown = console.formShown.value;
  const model = useModel({
    schedules,
    job: console.job.value,
    body,
    shown: ['frames', 'parts'].includes(console.endpoint.value),
    frames: console.endpoint.value === 'frames',
    take: (page, request) => console.begin(page, undefined, request, true),
  });
  return (
    <section id="ask" aria-label={t('Request')} class={shown ? 'open' : ''} hidden={console.home.value}>
      <h1 class="offscreen">{endpointName(console.endpoint.value)}</h1>
      <h2 class="offscreen">{t('Request')}</h2>
      <div class="entry">
        <div class="pick">
          <label class="offscreen" for="example">
            {t('Example')}
          </label>
          <Examples />
        </div>
        <Choices>{model.way}</Choices>
        {model.told}
        <RequestForm form={form} />
      </div>
      <Hint />
    </section>
  );
}

function Examples() {
  const console = useConsole();
  const [endpoint, example] = [console.endpoint.value, console.example.value];
  return (
    <select id="example" title={t('Examples')} value={example ?? ''} onChange={(event) => console.open(endpoint, event.currentTarget.value)}>
      {example === undefined && <option value="">{t('A job of your own')}</option>}
      {console.own.map(({name}) => (
        <option key={name} value={name}>
          {exampleName(endpoint, name)}
        </option>
      ))}
    </select>
  );
}

/** Lengths in mm or in inches, to enter and to read; requests and files stay in mm. */
function Units() {
  const console = useConsole();
  const inch = system.value === 'inch';
  const turn = () => {
    choose(inch ? 'mm' : 'inch');
    console.refresh();
  };
  return (
    <button
      type="button"
      id="units"
      title={t('Show lengths in {unit}; either is understood in every field: 2-3/8in, 1.75", 24.15*2', {unit: inch ? 'mm' : t('inches')})}
      onClick={turn}
    >
      {inch ? t('inch') : 'mm'}
    </button>
  );
}

function Undo() {
  const {form} = useConsole();
  const {undoable, redoable} = form.history;
  return (
    <span class="pair">
      <button type="button" id="undo" aria-label={t('Undo')} title={t('Undo (Ctrl+Z)')} disabled={!undoable.value} onClick={() => form.go(-1)}>
        ↶
      </button>
      <button type="button" id="redo" aria-label={t('Redo')} title={t('Redo (Ctrl+Y)')} disabled={!redoable.value} onClick={() => form.go(1)}>
        ↷
      </button>
    </span>
  );
}

function Choices({children}: {children: ComponentChildren}) {
  const console = useConsole();
  const [endpoint, example] = [console.endpoint.value, console.example.value];
  const shown = console.formShown.value;
  console.changes.value; // of the body, which determines whether the preset is pressed
  return (
    <div class="pick">
      <button
        id="blank"
        type="button"
        title={t('New job, from the fewest fields')}
        hidden={endpoint === 'replays' /* of which another page's answer is a part */}
        onClick={() => console.blank()}
      >
        {t('New')}
      </button>
      {children}
      <button
        id="preset"
        type="button"
        aria-pressed={pressed(console.body)}
        title={t('Cut square to the wall, and show the remaining gap')}
        hidden={!console.presetOffered}
        onClick={() => console.press()}
      >
        {t('Tube laser')}
      </button>
      <Jobs />
      <Undo />
      <button id="reset" type="button" hidden={example === undefined} disabled={!console.edited.value} onClick={() => console.open(endpoint, example)}>
        {t('Reset')}
      </button>
      <button
        id="edit"
        type="button"
        aria-controls="form"
        aria-expanded={shown}
        onClick={() => {
          console.formShown.value = !shown;
        }}
      >
        {/* On a phone the picture comes first, and the form on demand. */}
        {shown ? t('Back to the picture') : t('Change the job')}
      </button>
    </div>
  );
}
