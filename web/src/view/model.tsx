import {useLayoutEffect, useRef, useState} from 'preact/hooks';
import {cause} from '../captions';
import type {Imported, ImportedPart} from '../importer';
import {clone, type Row} from '../json';
import {many, t} from '../language';
import {asksAgain, columnChoices, endings, kinds, type Answers, type Question} from '../model';
import type {Order, Reading} from '../reading';

interface Opened {
  name: string;
  /** Until the questions of its kind are known, or why they never are. */
  questions?: Question[];
  failure?: unknown;
  read?(answers: Answers): Promise<Imported | ImportedPart>;
  /** The questions as they are after some answers. */
  ask?(answers: Answers): Promise<Question[]>;
  /** A table is pasted here. */
  pasted?: boolean;
}
interface Given {
  schedules: string[];
  job: number;
  body: Row;
  shown: boolean;
  /** Is the page that of frames, which a table becomes? */
  frames: boolean;
  /** Begins a job of the page with this request. */
  take(page: 'frames' | 'parts', request: Row): void;
}

const said = (questions: Question[] = []): Answers => Object.fromEntries(questions.map(({key, value = ''}) => [key, value]));
const reason = (failure: unknown) => cause(failure instanceof Error ? failure.message : String(failure));

/** Of the page; the worker of the last model serves the next. */
let reader: Promise<Reading> | undefined;
const reading = (): Promise<Reading> => {
  reader ??= import('../reading').then(({Reading: Reader}) => new Reader());
  return reader;
};

async function opened(file: File, schedules: string[]): Promise<Opened> {
  const {name} = file;
  try {
    const ending = name.toLowerCase().replace(/^.*\./, '');
    if (!Object.hasOwn(kinds, ending)) throw new Error(t('Its ending is not one of {endings}.', {endings: endings.join(', ')}));
    const [worker, buffer] = await Promise.all([reading(), file.arrayBuffer()]);
    const order: Order = {ending, file: new Uint8Array(buffer), schedules};
    const told = await worker.ask(order);
    return {
      name,
      ...('questions' in told ? {questions: told.questions} : {}),
      read: async (answers) => {
        const found = await worker.ask({...order, answers});
        if (!('imported' in found)) throw new Error(t('There is no answer.'));
        return found.imported;
      },
      ask: async (answers) => {
        const again = await worker.ask({...order, answers, again: true});
        return 'questions' in again ? again.questions : [];
      },
    };
  } catch (failure) {
    return {name, failure};
  }
}

/** An opened model: its button, also a place to drop it, and its messages next to the form. */
export function useModel({schedules, job, body, shown, frames, take}: Given) {
  const [model, say] = useState<Opened | undefined>();
  const [found, find] = useState<Imported | ImportedPart | {failure: unknown} | undefined>();
  const [button, input] = [useRef<HTMLButtonElement>(null), useRef<HTMLInputElement>(null)];
  const answers = useRef<Answers>({});
  const turn = useRef(0); // of a file or an answer; late ones are dropped
  const given = useRef<Row | undefined>(undefined);

  const read = async ({read: of}: Opened) => {
    turn.current += 1;
    const mine = turn.current;
    const result = await of?.(answers.current).catch((failure: unknown) => ({failure}));
    if (mine !== turn.current || !result) return;
    find(result);
    if ('failure' in result) return;
    const request = 'part' in result ? result.part : result.frame;
    if (!request) return;
    given.current = clone(request as unknown as Row);
    take('part' in result ? 'parts' : 'frames', given.current);
  };
  const open = async (file: File) => {
    turn.current += 1;
    const mine = turn.current;
    say({name: file.name});
    find(undefined);
    const each = await opened(file, schedules);
    if (mine !== turn.current) return;
    answers.current = said(each.questions);
    say(each);
    await read(each);
  };
  const answer = async (each: Opened, key: string, value: string) => {
    answers.current = {...answers.current, [key]: value};
    let now = each;
    if (asksAgain.includes(key)) {
      const questions = await each.ask?.(answers.current).catch(() => undefined);
      if (!questions) return;
      answers.current = {...answers.current, columns: said(questions)['columns'] ?? ''};
      now = {...each, questions};
      say(now);
    }
    await read(now);
  };
  const end = () => {
    if (model) void reader?.then((each) => each.end());
    turn.current += 1;
    given.current = undefined;
    say(undefined);
  };
  const paste = () => {
    end();
    say({name: t('Pasted table'), pasted: true});
  };
  const close = () => {
    end();
    button.current?.focus();
  };

  // Another job has begun, so messages about a file disappear.
  useLayoutEffect(() => {
    if (body !== given.current) end();
  }, [job]);
  const dropped = useRef(open);
  dropped.current = open;
  useLayoutEffect(() => {
    const wanted = (event: DragEvent) => button.current?.hidden === false && event.dataTransfer?.types.includes('Files');
    const over = (on: boolean) => document.body.classList.toggle('dropping', on);
    addEventListener('dragover', (event) => {
      if (!wanted(event)) return;
      event.preventDefault();
      over(true);
    });
    addEventListener('dragleave', (event) => event.relatedTarget === null && over(false));
    addEventListener('drop', (event) => {
      if (!wanted(event)) return;
      event.preventDefault();
      over(false);
      const file = event.dataTransfer?.files[0];
      if (file && !/\.json$/i.test(file.name)) void dropped.current(file); // a job is opened as one
    });
  }, []);
  const chose = (event: {currentTarget: HTMLInputElement}) => {
    const file = event.currentTarget.files?.[0];
    if (file) void open(file);
    event.currentTarget.value = ''; // the same file once more is a change too
  };

  const way = (
    <>
      <button
        ref={button}
        id="model"
        type="button"
        title={t('IFC, PCF, DXF and CSV become a frame, NC1 becomes a part. A file can be dropped here too')}
        hidden={!shown}
        onClick={() => input.current?.click()}
      >
        {t('Open a model')}
      </button>
      <button id="paste-table" type="button" title={t('Members from a spreadsheet, in any order of columns')} hidden={!frames} onClick={paste}>
        {t('Paste a table')}
      </button>
      <input ref={input} type="file" id="model-file" accept={endings.join(',')} hidden aria-label={t('A model to open')} onChange={chose} />
    </>
  );
  const told = (
    <section id="imported" aria-label={t('The model')} aria-live="polite" hidden={!model}>
      {model && <Heading model={model} close={close} />}
      {model?.pasted && <Pasted take={(text) => void open(new File([text], `${t('Pasted table')}.txt`))} />}
      {model?.questions && (
        <div class="questions" key={model.name}>
          {model.questions.map((question) => (
            <Asked
              key={question.table ? question.value : question.key}
              question={question}
              value={answers.current[question.key] ?? ''}
              answer={(value) => void answer(model, question.key, value)}
            />
          ))}
        </div>
      )}
      {model?.failure !== undefined && <Refused failure={model.failure} />}
      {model?.questions && <div class="found">{found && ('failure' in found ? <Refused failure={found.failure} /> : <Found {...found} />)}</div>}
    </section>
  );
  return {way, told};
}

const Heading = ({model, close}: {model: Opened; close(): void}) =>
  model.questions || model.pasted || model.failure !== undefined ? (
    <h3>
      {model.name}
      <button type="button" class="right" aria-label={t('Close the messages about the model')} onClick={close}>
        {t('Close')}
      </button>
    </h3>
  ) : (
    <p class="soft">{t('Reading {file} …', {file: model.name})}</p>
  );

const Refused = ({failure}: {failure: unknown}) => <p role="alert">{t('It cannot be read. {why}', {why: reason(failure)})}</p>;

/** Where a table is pasted; it is read at once. */
function Pasted({take}: {take(text: string): void}) {
  const box = useRef<HTMLTextAreaElement>(null);
  useLayoutEffect(() => box.current?.focus(), []);
  return (
    <label class="pasted">
      <span>{t('Copy the rows of a spreadsheet and paste them here, with their headings or without')}</span>
      {/* A row that is typed is complete with its end, or when the box is left. */}
      <textarea
        ref={box}
        rows={4}
        onInput={({currentTarget: {value}}) => value.trimStart().includes('\n') && take(value)}
        onChange={({currentTarget: {value}}) => value.trim() && take(value)}
      />
    </label>
  );
}

const mostColumns = 60; // that are shown

/** The first rows of a table, with the meaning of each column above it. */
function Columns({question: {table, text}, value, answer}: {question: Question; value: string; answer(value: string): void}) {
  const [fields, setFields] = useState(value.split(','));
  const {headings, rows, open} = table ?? {headings: [], rows: [], open: false};
  const shown = fields.slice(0, mostColumns);
  const mean = (at: number, field: string) => {
    // A field has one column: it leaves the one that it had.
    const next = fields.map((each, i) => (i === at ? field : each === field ? '' : each));
    setFields(next);
    answer(next.join());
  };
  return (
    <details class="matched" open={open}>
      <summary>{t('{columns}: {n} of {all} have a meaning', {columns: t(text), n: fields.filter(Boolean).length, all: fields.length})}</summary>
      <div class="scroll" tabIndex={0} role="group" aria-label={t('The first rows')}>
        <table>
          <thead>
            <tr>
              {shown.map((field, at) => (
                <th key={at} scope="col">
                  {headings[at] ?? at + 1}
                  <select
                    data-column={at}
                    aria-label={t('Meaning of column {column}', {column: headings[at] || at + 1})}
                    value={field}
                    onChange={(event) => mean(at, event.currentTarget.value)}
                  >
                    {columnChoices.map(([each, name]) => (
                      <option key={each} value={each}>
                        {t(name)}
                      </option>
                    ))}
                  </select>
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {rows.map((cells, i) => (
              <tr key={i}>
                {shown.map((_, at) => (
                  <td key={at}>{cells[at]}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </details>
  );
}

function Asked({question, value, answer}: {question: Question; value: string; answer(value: string): void}) {
  const {key, text, of, choices, hint: given, check, lines, table} = question;
  if (table) return <Columns question={question} value={value} answer={answer} />;
  const [said, hint] = [t(text, {...of, ...(of?.['field'] ? {field: t(String(of['field']))} : {})}), given && t(given)];
  const shared = {'data-question': key, value, onChange: (event: Event) => answer((event.currentTarget as HTMLInputElement).value)};
  if (check)
    return (
      <label class="check">
        <input type="checkbox" data-question={key} checked={value !== ''} onChange={(event) => answer(event.currentTarget.checked ? 'yes' : '')} />
        <span>{said}</span>
      </label>
    );
  return (
    <label>
      <span>{said}</span>
      {choices ? (
        <select {...shared}>
          {choices.map(([each, name]) => (
            <option key={each} value={each}>
              {name === each ? name : t(name)}
            </option>
          ))}
        </select>
      ) : lines ? (
        <textarea rows={4} placeholder={hint} {...shared} />
      ) : (
        <input list={hint ? undefined : 'tube-sizes'} placeholder={hint ?? '114.3x6.3'} {...shared} />
      )}
    </label>
  );
}

function framed({frame}: Imported): string {
  if (!frame) return t('No member was found, so the job stays as it was.');
  const others = frame.others?.length ?? 0;
  const members = many(frame.members.length, '{n} member', '{n} members');
  return others ? t('{members} and {others}.', {members, others: many(others, '{n} other that cuts', '{n} others that cut')}) : t('{members}.', {members});
}
const parted = ({part}: ImportedPart): string =>
  part
    ? t('A part with {cutouts}.', {cutouts: many(part.cutouts?.length ?? 0, '{n} cut-out', '{n} cut-outs')})
    : t('No part was found, so the job stays as it was.');

type Missed = Imported['notUnderstood'][number];
/** Things of one kind that are omitted for one reason. */
function alike(missed: Missed[]): [Missed, ids: string[]][] {
  const groups = new Map<string, [Missed, string[]]>();
  for (const each of missed) {
    const key = `${each.type}: ${each.reason}`;
    const [first, ids] = groups.get(key) ?? [each, []];
    groups.set(key, [first, [...ids, each.id]]);
  }
  return [...groups.values()];
}
const namedIds = 5; // of the things in one line

/** One thing, or all of one kind that are omitted for one reason. */
function Missing({missed, ids}: {missed: Missed; ids: string[]}) {
  const [type, why] = [cause(missed.type), cause(missed.reason)];
  if (ids.length === 1)
    return (
      <li>
        <b>{ids[0]}</b> {t('{type}: {why}', {type, why})}
      </li>
    );
  const named = `${ids.slice(0, namedIds).join(t(', '))}${ids.length > namedIds ? ' …' : ''}`;
  return (
    <li>
      <b title={ids.join(', ')}>{`${ids.length} × ${type}`}</b>
      {t(': {why} ({ids})', {why, ids: named})}
    </li>
  );
}

/** How much of the file is in the request, and every thing that is not. */
function Found(found: Imported | ImportedPart) {
  const {notUnderstood} = found;
  const what = 'part' in found ? parted(found) : framed(found);
  const missed = notUnderstood.length;
  return (
    <>
      <p id="imported-said">{`${what} ${missed ? many(missed, '{n} thing was not understood:', '{n} things were not understood:') : t('Nothing was omitted.')}`}</p>
      {missed > 0 && (
        <ul id="not-understood" tabIndex={0} aria-label={t('Unsupported items')}>
          {alike(notUnderstood).map(([each, all], i) => (
            <Missing key={i} missed={each} ids={all.map(cause)} />
          ))}
        </ul>
      )}
    </>
  );
}
