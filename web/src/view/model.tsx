import {useLayoutEffect, useRef, useState} from 'preact/hooks';
import type {Imported, ImportedPart} from '../importer';
import {clone, type Row} from '../json';
import {endings, kinds, type Answers, type Question} from '../model';
import type {Order, Reading} from '../reading';

interface Opened {
  name: string;
  /** Until the questions of its kind are known, or why they never are. */
  questions?: Question[];
  failure?: unknown;
  read?(answers: Answers): Promise<Imported | ImportedPart>;
}
interface Given {
  schedules: string[];
  job: number;
  body: Row;
  shown: boolean;
  /** Begins a job of the page with this request. */
  take(page: 'frames' | 'parts', request: Row): void;
}

const reason = (failure: unknown) => (failure instanceof Error ? failure.message : String(failure));

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
    if (!Object.hasOwn(kinds, ending)) throw new Error(`Its ending is not one of ${endings.join(', ')}.`);
    const [worker, buffer] = await Promise.all([reading(), file.arrayBuffer()]);
    const order: Order = {ending, file: new Uint8Array(buffer), schedules};
    const told = await worker.ask(order);
    return {
      name,
      ...('questions' in told ? {questions: told.questions} : {}),
      read: async (answers) => {
        const found = await worker.ask({...order, answers});
        if (!('imported' in found)) throw new Error('There is no answer.');
        return found.imported;
      },
    };
  } catch (failure) {
    return {name, failure};
  }
}

/** An opened model: its button, also a place to drop it, and its messages next to the form. */
export function useModel({schedules, job, body, shown, take}: Given) {
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
    answers.current = Object.fromEntries((each.questions ?? []).map(({key, value = ''}) => [key, value]));
    say(each);
    await read(each);
  };
  const end = () => {
    if (model) void reader?.then((each) => each.end());
    turn.current += 1;
    given.current = undefined;
    say(undefined);
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
        title="IFC, PCF, DXF and CSV become a frame, NC1 becomes a part. A file can be dropped here too"
        hidden={!shown}
        onClick={() => input.current?.click()}
      >
        Open a model
      </button>
      <input ref={input} type="file" id="model-file" accept={endings.join(',')} hidden aria-label="A model to open" onChange={chose} />
    </>
  );
  const told = (
    <section id="imported" aria-label="The model" aria-live="polite" hidden={!model}>
      {model && <Heading model={model} close={close} />}
      {model?.questions && (
        <div class="questions" key={model.name}>
          {model.questions.map((question) => (
            <Asked
              key={question.key}
              question={question}
              value={answers.current[question.key] ?? ''}
              answer={(value) => {
                answers.current = {...answers.current, [question.key]: value};
                void read(model);
              }}
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
  model.questions || model.failure !== undefined ? (
    <h3>
      {model.name}
      <button type="button" class="right" aria-label="Close the messages about the model" onClick={close}>
        Close
      </button>
    </h3>
  ) : (
    <p class="soft">Reading {model.name} …</p>
  );

const Refused = ({failure}: {failure: unknown}) => <p role="alert">It cannot be read. {reason(failure)}</p>;

function Asked({question: {key, text: said, choices, hint, check, lines}, value, answer}: {question: Question; value: string; answer(value: string): void}) {
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
              {name}
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

const counted = (n: number, one: string, many: string): string => `${n} ${n === 1 ? one : many}`;

function framed({frame}: Imported): string {
  const others = frame?.others?.length ?? 0;
  const also = others ? ` and ${counted(others, 'other that cuts', 'others that cut')}` : '';
  return frame ? `${counted(frame.members.length, 'member', 'members')}${also}.` : 'No member was found, so the job stays as it was.';
}
const parted = ({part}: ImportedPart): string =>
  part ? `A part with ${counted(part.cutouts?.length ?? 0, 'cut-out', 'cut-outs')}.` : 'No part was found, so the job stays as it was.';

/** How much of the file is in the request, and every thing that is not. */
function Found(found: Imported | ImportedPart) {
  const {notUnderstood} = found;
  const what = 'part' in found ? parted(found) : framed(found);
  const missed = notUnderstood.length;
  return (
    <>
      <p id="imported-said">{`${what} ${missed ? `${counted(missed, 'thing was', 'things were')} not understood:` : 'Nothing was omitted.'}`}</p>
      {missed > 0 && (
        <ul id="not-understood" tabIndex={0} aria-label="Unsupported items">
          {notUnderstood.map(({id, type, reason: why}, i) => (
            <li key={i}>
              <b>{id}</b>
              {` ${type}: ${why}`}
            </li>
          ))}
        </ul>
      )}
    </>
  );
}
