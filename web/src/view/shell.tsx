import type {ComponentChildren} from 'preact';
import type {Console} from '../console';
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
      <a class="skip" href={console?.home.value ? '#start' : '#views'}>
        Skip to the result
      </a>
      <header class="top">
        <a class="brand" href="#/" title="Start">
          <img src="/mark.svg" width={26} height={26} alt="" /> <span>tubecut</span>
        </a>
        <nav id="endpoints" aria-label="What to compute">
          {console && <Pages />}
        </nav>
        <div class="tools">
          {console && <Links />}
          {console && <Units />}
          <ThemeButton />
          <a href="/glossary">Words</a>
          <a href="/docs">API</a>
        </div>
      </header>
      <main class={console?.home.value ? 'home' : ''}>
        {console && <Start />}
        {console && <Ask />}
        <section id="views" aria-label="Result" tabIndex={-1} hidden={console?.home.value}>
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

function Pages() {
  const {pages, contract, endpoint, home} = useConsole();
  return (
    <>
      {byTask(pages, ({id}) => id).map(({task, items}) => (
        <span key={task?.id} class="group-of" role="group" data-title={task?.name ?? 'More'} aria-label={task?.name ?? 'More'}>
          {items.map(({id, path}) => (
            <a
              key={id}
              href={`#/${id}`}
              data-endpoint={id}
              title={contract.summary(path)}
              aria-current={!home.value && id === endpoint.value ? 'page' : undefined}
            >
              {endpointName(id)}
            </a>
          ))}
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
        title="Copy a link to exactly this job"
        disabled={console.lost.value !== null || console.home.value}
        onClick={() => void console.share(copied)}
      >
        {console.linked.value}
      </button>
      <button id="forget" type="button" title="Load the page anew, without the key" hidden={!console.keyed.value} onClick={() => void console.forget()}>
        Forget key
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
    take: (page, request) => console.begin(page, undefined, request, true),
  });
  return (
    <section id="ask" aria-label="Request" class={shown ? 'open' : ''} hidden={console.home.value}>
      <div class="entry">
        <div class="pick">
          <label class="offscreen" for="example">
            Example
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
    <select id="example" title="Examples" value={example ?? ''} onChange={(event) => console.open(endpoint, event.currentTarget.value)}>
      {example === undefined && <option value="">A job of your own</option>}
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
      title={`Show lengths in ${inch ? 'mm' : 'inches'}; either is understood in every field: 2-3/8in, 1.75", 24.15*2`}
      onClick={turn}
    >
      {inch ? 'inch' : 'mm'}
    </button>
  );
}

function Undo() {
  const {form} = useConsole();
  const {undoable, redoable} = form.history;
  return (
    <span class="pair">
      <button type="button" id="undo" aria-label="Undo" title="Undo (Ctrl+Z)" disabled={!undoable.value} onClick={() => form.go(-1)}>
        ↶
      </button>
      <button type="button" id="redo" aria-label="Redo" title="Redo (Ctrl+Y)" disabled={!redoable.value} onClick={() => form.go(1)}>
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
        title="New job, from the fewest fields"
        hidden={endpoint === 'replays' /* of which another page's answer is a part */}
        onClick={() => console.blank()}
      >
        New
      </button>
      {children}
      <button
        id="preset"
        type="button"
        aria-pressed={pressed(console.body)}
        title="Cut square to the wall, and show the remaining gap"
        hidden={!console.presetOffered}
        onClick={() => console.press()}
      >
        Tube laser
      </button>
      <Jobs />
      <Undo />
      <button id="reset" type="button" hidden={example === undefined} disabled={!console.edited.value} onClick={() => console.open(endpoint, example)}>
        Reset
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
        {shown ? 'Back to the picture' : 'Change the job'}
      </button>
    </div>
  );
}
