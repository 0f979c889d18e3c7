import type {Signal} from '@preact/signals';
import {useEffect, useLayoutEffect, useRef, useState} from 'preact/hooks';
import {listed, type Listed} from '../catalogue';
import {save} from '../dom';
import {groupsOf, known, printable, purposeNames, purposesOf, queryOf, remember, remembered, type Option, type Purpose, type Values} from '../files';
import {originalOf, refusalOf, said} from '../hint';
import type {Row} from '../json';
import {headed} from '../key';
import {chinese, many, t} from '../language';
import {endpointName} from '../names';
import {acrossTube} from '../onward';
import {isSection} from '../pictures/section';
import {parseProgram, type Program} from '../program';
import type {Format} from '../schema';
import {away, path, type Answer, type Issue, type Problem} from '../service';
import {choice, withUnit} from '../words';
import {Drawing} from './drawing';
import {FileOption} from './file_option';
import {ProgramPreview} from './preview';

/** By the order of the reference and the part that is cut, else by the job's own name; then the drawing and the beginning of the input's hash. */
export function fileName(name: string, body: Row, view: string | undefined, hash: string | null): string {
  const reference = (body['reference'] ?? {}) as Record<string, unknown>;
  const part = reference['part'] ?? body['member'];
  const words = [reference['order'], part].filter((word): word is string => typeof word === 'string');
  const parts = [...(words.length ? words : [name]), view ?? '', hash?.slice(0, 8) ?? ''].filter(Boolean);
  return parts.join('-').replace(/[\\/:*?"<>|\s]+/g, '_');
}

/** The whole of a reply; `tell` hears which share of it has come. */
async function received(reply: Response, tell: (share: number) => void): Promise<Blob> {
  const all = Number(reply.headers.get('Content-Length'));
  const pieces: BlobPart[] = [];
  const reader = reply.body?.getReader();
  for (let seen = 0; reader; ) {
    const {done, value} = await reader.read();
    if (done) break;
    pieces.push(value);
    seen += value.length;
    if (all > 0) tell(seen / all);
  }
  return new Blob(pieces, {type: reply.headers.get('Content-Type') ?? ''});
}

/** What an option begins with. A speed has no default; one to begin with spares a refusal. */
const beginning = ({name, schema}: Option): string => (schema.items ? ((schema.default ?? []) as string[]).join(',') : name === 'speed_mm_min' ? '600' : '');

/** Returns the text of a complaint, and the service's own words if they are others. */
const complaint = (issue: Issue) => [said(issue), originalOf(issue)].filter(Boolean).join(' ');

/** The options that a problem names, each with its complaint. */
const complaintsOf = ({errors = []}: Problem): Map<string, string> =>
  new Map(
    errors.flatMap((issue) =>
      issue.pointer.startsWith('?') ? [[issue.pointer.slice(1), complaint({...issue, hint: issue.hint.replace(/^[a-z]+: /, '')})] as [string, string]] : [],
    ),
  );

/** What the service lists for an option. */
function choicesOf(name: string, lists: Listed | undefined, given: Values, answer: Answer): [string, string][] | undefined {
  const section = isSection(answer); // cut by machines that move the torch across the tube
  const tabled = lists?.machines.filter(({process, machine}) => process && (!section || machine.type === acrossTube)) ?? [];
  if (name === 'machine') return tabled.map((each) => [each.name, choice(each.name)]);
  if (name === 'material') {
    const rows = tabled.find((each) => each.name === given['machine'])?.process?.rows ?? [];
    const most = new Map<string, number>();
    for (const {material, metal_max_mm} of rows) most.set(material, Math.max(metal_max_mm, most.get(material) ?? 0));
    return [...most].map(([material, upTo]) => [material, t('{material}, up to {metal}', {material, metal: withUnit(upTo, 'mm')})]);
  }
  if (name === 'post') return lists?.posts.map((each) => [each.name, t(each.post.what)]) ?? [];
  if (name === 'acknowledge')
    return [...new Set(answer.warnings.filter(({severity}) => severity === 'cut').map(({code}) => code))].map((code) => [code, choice(code)]);
  return undefined;
}

/** Drawings that the page shows itself, where they have its language. */
function Drawings({formats, shown, show}: {formats: Format[]; shown: boolean; show(format: Format, view: string): Promise<void>}) {
  const drawn = formats.filter(({media}) => media === 'image/svg+xml');
  if (!shown || !drawn.length) return null;
  return (
    <>
      <div class="offers">
        <span class="soft">{t('Show on this page')}</span>
        {drawn.flatMap((format) =>
          format.views.map((view) => (
            <button type="button" key={view} data-shows={view} onClick={() => void show(format, view)}>
              {choice(view)}
            </button>
          )),
        )}
      </div>
      {chinese() && <p class="soft">{t('Files are in English. Drawings that are shown and printed here are in Chinese.')}</p>}
    </>
  );
}

interface Given {
  endpoint: string;
  name: string;
  body: Row;
  formats: Format[];
  answer: Answer;
  /** The program that is previewed here and played in the picture. */
  program: Signal<Program | undefined>;
}

/** The files of an answer, by what they are for: the options of that purpose, and a button for every format and drawing. The file is the service's. */
export function Downloads({endpoint, name, body, formats: all, answer, program}: Given) {
  const formats = printable(all, !isSection(answer), endpoint === 'parts');
  const offered = purposesOf(formats);
  const options = formats.flatMap((format) => format.options);
  const [given, give] = useState<Values>(() => ({...Object.fromEntries(options.map((option) => [option.name, beginning(option)])), ...remembered()}));
  const [lists, list] = useState<Listed | undefined>(undefined);
  const [complaints, complain] = useState<ReadonlyMap<string, string>>(new Map());
  const [status, say] = useState('');
  const [coming, come] = useState<number | null | undefined>(undefined); // a share, unknown, nothing
  const [drawing, draw] = useState<{text: string; view: string} | undefined>(undefined);
  const root = useRef<HTMLElement>(null);
  const purpose = offered.find((each) => each === given['purpose']) ?? (offered[0] as Purpose);
  useEffect(() => {
    if (options.some((option) => option.name === 'machine')) void listed().then(list, () => {});
  }, []);
  useLayoutEffect(() => {
    if (complaints.size) root.current?.querySelector<HTMLElement>('[aria-invalid=true]')?.focus();
  }, [complaints]);
  useEffect(() => draw(undefined), [answer]);
  const change = (key: string, value: string) => {
    const next = {...given, [key]: value, ...(key === 'machine' ? {material: ''} : {})};
    if (complaints.has(key)) complain(new Map([...complaints].filter(([other]) => other !== key)));
    give(next);
    remember(next);
  };
  /** The file of a format. A refusal marks the options that it names. */
  const requested = async (format: Format, view?: string): Promise<Response | undefined> => {
    const title = t(known(format.media)[0]);
    const query = queryOf(format, view, given);
    say('');
    complain(new Map());
    come(null); // unknown while it is computed
    const reply = await fetch(`${path(endpoint)}${query.size ? `?${query}` : ''}`, {
      method: 'POST',
      body: JSON.stringify(body),
      headers: headed({'Content-Type': 'application/json', Accept: format.media}),
    }).catch(() => undefined);
    if (reply?.ok) return reply;
    come(undefined);
    const problem = reply ? ((await reply.json().catch(() => ({title: t('status {status}', {status: reply.status})}))) as Problem) : away;
    const found = complaintsOf(problem);
    complain(found);
    const why = found.size ? many(found.size, 'one field is marked.', '{n} fields are marked.') : refusalOf(problem);
    say(`${title}: ${why}`);
    return undefined;
  };
  const fetchFile = async (format: Format, view?: string) => {
    const reply = await requested(format, view);
    if (!reply) return;
    save(`${fileName(name, body, view, reply.headers.get('Tubecut-Input-Sha256'))}.${known(format.media)[1]}`, await received(reply, come));
    come(undefined);
  };
  const preview = async (format: Format) => {
    const reply = await requested(format);
    if (!reply) return;
    program.value = parseProgram(await reply.text());
    come(undefined);
  };
  const shown = async (format: Format, view: string) => {
    const reply = await requested(format, view);
    if (!reply) return;
    draw({text: await reply.text(), view});
    come(undefined);
  };
  /** A process table is chosen only if a machine that suits has one. */
  const has = ({name}: Option) => !isSection(answer) || !lists || name !== 'machine' || choicesOf(name, lists, given, answer)?.length;
  const shownProgram = formats.find(({media}) => media === 'text/x-gcode' && purpose === 'program');
  return (
    <section class="block" ref={root}>
      <h3>{t('Files: {endpoint}', {endpoint: endpointName(endpoint)})}</h3>
      {offered.length > 1 && (
        <fieldset class="purposes">
          <legend class="offscreen">{t('Purpose of the files')}</legend>
          {offered.map((each) => (
            <label key={each}>
              <input type="radio" name="purpose" value={each} checked={each === purpose} onChange={() => change('purpose', each)} />
              {t(purposeNames[each])}
            </label>
          ))}
        </fieldset>
      )}
      {groupsOf(formats, purpose, given, new Set(complaints.keys())).map(([title, shown]) => (
        <fieldset class="asked" key={title}>
          <legend>{t(title)}</legend>
          <div class="options">
            {shown.filter(has).map((option) => (
              <FileOption
                key={option.name}
                option={option}
                values={given}
                listed={choicesOf(option.name, lists, given, answer)}
                complaint={complaints.get(option.name)}
                change={(value) => change(option.name, value)}
              />
            ))}
          </div>
        </fieldset>
      ))}
      <div class="offers">
        {formats
          .filter((format) => known(format.media)[2] === purpose)
          .flatMap((format) =>
            (format.views.length ? format.views : [undefined]).map((view) => (
              <button type="button" key={`${format.media} ${view}`} data-media={format.media} data-view={view} onClick={() => void fetchFile(format, view)}>
                {view ? `${t(known(format.media)[0])}: ${choice(view)}` : t(known(format.media)[0])}
              </button>
            )),
          )}
        {shownProgram && (
          <button type="button" id="preview" title={t('The lines and the time; the picture plays the program')} onClick={() => void preview(shownProgram)}>
            {t('Preview')}
          </button>
        )}
      </div>
      <Drawings formats={formats} shown={purpose === 'drawing'} show={shown} />
      <progress aria-label={t('Download')} hidden={coming === undefined} {...(typeof coming === 'number' ? {value: coming} : {})} />
      <p class="soft" role="status">
        {status}
      </p>
      {purpose === 'drawing' && drawing && <Drawing text={drawing.text} name={choice(drawing.view)} body={body} close={() => draw(undefined)} />}
      {purpose === 'program' && program.value && <ProgramPreview program={program.value} />}
    </section>
  );
}
