import {useEffect, useMemo, useRef, useState} from 'preact/hooks';
import {save} from '../dom';
import {said} from '../hint';
import {isRow} from '../json';
import {language, later, many, t} from '../language';
import {fileOf, OwnMachine, parts, type Part, type State} from '../own_machine';
import {system} from '../units';
import {place} from '../words';
import {Copier} from './controls';
import {RequestForm} from './form';
import {useConsole} from './page';
import './own_machine.css';

const names: Record<Part, string> = {machine: later('Machine'), post: later('Post')};
const starts: Record<Part, string> = {machine: later('Machine to start from'), post: later('Post to start from')};
const takes: Record<Part, string> = {machine: later('Start from this machine'), post: later('Start from this post')};
const downloads: Record<Part, string> = {machine: later('Download the machine'), post: later('Download the post')};
const command = 'tubecut-server --machines machines --posts posts';

/** A machine and a post of one's own, from data sheets to a first coupon: the steps of docs/machines.md. */
export function OwnMachinePage() {
  const console = useConsole();
  const own = useMemo(() => new OwnMachine(console.contract, console.examples), [console]);
  useEffect(() => void own.begin(), [own]);
  useEffect(() => own.refresh(), [system.value, language.value]);
  const wrong = parts.some((part) => own.states.value[part]?.length);
  useEffect(() => {
    console.ownWrong.value = wrong;
  }, [wrong]);
  useEffect(
    () => () => {
      console.ownWrong.value = false;
    },
    [console],
  );
  /** Undo is of this form, and not of the job's. */
  const keydown = (event: KeyboardEvent) => {
    const pressed = event.key.toLowerCase();
    if (!(event.ctrlKey || event.metaKey) || event.altKey || (pressed !== 'z' && pressed !== 'y')) return;
    event.stopPropagation();
    if ((event.target as HTMLElement).closest('.text textarea')) return; // it has an undo of its own
    event.preventDefault();
    own.form.go(pressed === 'y' || event.shiftKey ? 1 : -1);
  };
  return (
    <section id="own-machine" aria-label={t('Own machine and post')} tabIndex={-1} onKeyDown={keydown}>
      <h1>{t('Own machine and post')}</h1>
      <p class="lead">{t('From data sheets to the program of a first coupon: one file for the machine, one for the words of its control.')}</p>
      <div class="halves">
        <div>
          <Start own={own} />
          <RequestForm form={own.form} />
          {parts.map((part) => (
            <Text key={part} own={own} part={part} />
          ))}
        </div>
        <div>
          <Check own={own} />
          <Files own={own} />
          <Coupon own={own} />
        </div>
      </div>
    </section>
  );
}

function Start({own}: {own: OwnMachine}) {
  const input = useRef<HTMLInputElement>(null);
  return (
    <section class="block" aria-labelledby="own-start">
      <h2 id="own-start">{t('1. Machine and post')}</h2>
      <p>{t('Axes and limits are in the data sheets of the drives. The process table is the cut chart of the torch, from its handbook.')}</p>
      <p>{t('The post has the words of the control: letters, senses and zeros of the axes, comments, feeds, torch. Start from the most similar one.')}</p>
      <div class="starts">
        {parts.map((part) => (
          <Shelf key={part} own={own} part={part} />
        ))}
        <button type="button" onClick={() => input.current?.click()}>
          {t('Open file')}
        </button>
        <input
          ref={input}
          id="own-file"
          type="file"
          accept=".json"
          hidden
          aria-label={t('A file of a machine or a post')}
          onChange={({currentTarget}) => {
            const file = currentTarget.files?.[0];
            if (file) void own.open(file);
            currentTarget.value = ''; // the same file once more is a change too
          }}
        />
      </div>
      <Started own={own} />
    </section>
  );
}

/** The list acts by its button only, because the arrow keys pass through each of its names. */
function Shelf({own, part}: {own: OwnMachine; part: Part}) {
  const [name, choose] = useState('');
  return (
    <span class="start">
      <label>
        <span class="name">{t(starts[part])}</span>
        <select data-start={part} value={name} onChange={({currentTarget}) => choose(currentTarget.value)}>
          <option value="">–</option>
          {own.shelves.value[part].map((each) => (
            <option key={each.name}>{each.name}</option>
          ))}
        </select>
      </label>
      <button type="button" data-take={part} disabled={!name} onClick={() => own.startFrom(part, name)}>
        {t(takes[part])}
      </button>
    </span>
  );
}

/** Which one the form has begun with, and the way back. */
function Started({own}: {own: OwnMachine}) {
  const started = own.started.value;
  const undo = () => {
    document.querySelector<HTMLElement>(`[data-take=${started?.part}]`)?.focus(); // this button disappears
    own.form.go(-1);
  };
  return (
    <p class="started" role="status">
      {started && (
        <>
          {t('The form now has the values of {name}.', {name: started.name})}{' '}
          <button type="button" id="unstart" title={t('Undo (Ctrl+Z)')} onClick={undo}>
            {t('Undo')}
          </button>
        </>
      )}
    </p>
  );
}

/** One of the files as its text; a change of it is one of the form. */
function Text({own, part}: {own: OwnMachine; part: Part}) {
  const [typed, type] = useState<string>();
  const [wrong, fault] = useState('');
  own.changes.value;
  own.form.drawn.value;
  const write = (text: string) => {
    try {
      const read: unknown = JSON.parse(text);
      if (!isRow(read)) throw new Error(t('It is no object.'));
      fault('');
      own.put(part, read);
    } catch (failure) {
      fault(failure instanceof Error ? failure.message : String(failure));
    }
  };
  return (
    <details class="text">
      <summary>{t('{part} as JSON', {part: t(names[part])})}</summary>
      <textarea
        rows={14}
        spellcheck={false}
        data-text={part}
        aria-label={t('{part} as JSON', {part: t(names[part])})}
        aria-invalid={wrong ? 'true' : undefined}
        aria-describedby={wrong ? `wrong-${part}` : undefined}
        value={typed ?? JSON.stringify(own.part(part), null, 2)}
        onInput={({currentTarget}) => type(currentTarget.value)}
        onChange={({currentTarget}) => write(currentTarget.value)}
        onBlur={() => !wrong && type(undefined)}
      />
      {wrong && (
        <p class="complaint" id={`wrong-${part}`}>
          {wrong}
        </p>
      )}
    </details>
  );
}

const stateOf = (state: State) =>
  state === undefined ? t('not checked') : state.length ? many(state.length, '{n} error, at its field', '{n} errors, at their fields') : t('ok');
const sound = (state: State) => state?.length === 0;

function Check({own}: {own: OwnMachine}) {
  const [states, program, others] = [own.states.value, own.program.value, own.others.value];
  return (
    <section class="block" aria-labelledby="own-check">
      <h2 id="own-check">{t('2. Check')}</h2>
      <p>{t('The service checks both after each change, and makes the program of a coupon: a saddle of 48.3 × 3.2 on a tube of 60.3.')}</p>
      <div role="status">
        {parts.map((part) => (
          <p key={part} data-state={part} class={states[part]?.length ? 'wrong' : ''}>
            <b>{t(names[part])}</b> {stateOf(states[part])}
          </p>
        ))}
        {parts.some((part) => states[part]?.length) && (
          <ul class="errors">
            {parts.flatMap((part) =>
              (states[part] ?? []).map((issue) => (
                <li key={issue.pointer + issue.code}>
                  <button type="button" data-to={issue.pointer} title={t('Show this field')} onClick={() => own.form.focus(issue.pointer)}>
                    {place(issue.pointer)}
                  </button>{' '}
                  {said(issue)}
                </li>
              )),
            )}
          </ul>
        )}
        {own.trouble.value && <p class="wrong">{own.trouble.value}</p>}
      </div>
      {others.length > 0 && (
        <ul class="wrong" aria-label={t('Why the coupon is refused')}>
          {others.map((issue) => (
            <li key={issue.pointer + issue.code}>{`${place(issue.pointer.replace(/^\?/, '/'))}: ${said(issue)}`}</li>
          ))}
        </ul>
      )}
      {program && (
        <>
          {own.stale.value && (
            <p class="wrong" id="own-stale">
              {t('This program is out of date: it is of the last values without errors.')}
            </p>
          )}
          <pre
            class={own.stale.value ? 'listing old' : 'listing'}
            id="own-program"
            tabIndex={0}
            role="group"
            aria-label={t('Program of the coupon')}
            aria-describedby={own.stale.value ? 'own-stale' : undefined}
          >
            {program}
          </pre>
        </>
      )}
    </section>
  );
}

function Files({own}: {own: OwnMachine}) {
  const states = own.states.value;
  own.changes.value;
  const download = (part: Part) => {
    own.form.flush();
    const [name, text] = fileOf(part, own.part(part));
    save(name, new Blob([text], {type: 'application/json'}));
  };
  return (
    <section class="block" aria-labelledby="own-files">
      <h2 id="own-files">{t('3. Files')}</h2>
      <p class="ways">
        {parts.map((part) => (
          <button key={part} type="button" data-download={part} disabled={!sound(states[part])} onClick={() => download(part)}>
            {t(downloads[part])}
          </button>
        ))}
      </p>
      {parts.map(
        (part) =>
          own.taken(part) && (
            <p key={part}>{t('The service lists "{name}" already. If it is built in, choose another name.', {name: String(own.part(part)['name'])})}</p>
          ),
      )}
      <p>{t('Put the files into the folders machines and posts, and start the service with both:')}</p>
      <pre tabIndex={0} role="group" aria-label={t('Command')}>
        {command}
      </pre>
      <p class="ways">
        <Copier name={t('Copy')} text={() => command} />
      </p>
      <p class="soft">
        {t('If a file has an error, the service does not start, and names file, field and reason. After a change, SIGHUP reads the folders again.')}
      </p>
    </section>
  );
}

function Coupon({own}: {own: OwnMachine}) {
  const console = useConsole();
  return (
    <section class="block" aria-labelledby="own-coupon">
      <h2 id="own-coupon">{t('4. First coupon')}</h2>
      <ol>
        <li>{t('Run the program without a tube and without torch=on: no axis leaves the range that the head of the program states.')}</li>
        <li>{t('Run it with a tube, and a pen in place of the torch: one turn draws a line as long as the circumference.')}</li>
        <li>{t('Cut it, set the branch on its chord, and measure the kerf: it goes into the request and into the process table.')}</li>
        <li>{t('If the torch tilts, cut the four coupons of docs/commissioning.md.')}</li>
      </ol>
      <p class="ways">
        <button
          type="button"
          id="own-pulses"
          disabled={!sound(own.states.value.machine)}
          onClick={() => console.start('pulse-schedules', own.job(own.part('machine')))}
        >
          {t('Pulses of the coupon on this machine')}
        </button>
      </p>
    </section>
  );
}
