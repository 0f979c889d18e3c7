import {useState} from 'preact/hooks';
import {save} from '../dom';
import type {Row} from '../json';
import {headed} from '../key';
import {endpointName} from '../names';
import type {Format} from '../schema';
import {away, path, type Problem} from '../service';
import {choice, label, plain, unit} from '../words';

type Option = Format['options'][number];
type Values = Record<string, string>;

const endings: Record<string, [name: string, ending: string]> = {
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
  'application/zip': ['Shop packet (zip)', 'zip'],
  'application/x-ndjson': ['Lines (NDJSON)', 'ndjson'],
};
const known = (media: string): [string, string] => endings[media] ?? (/dstv|nc1/.test(media) ? ['DSTV', 'nc1'] : [media, 'txt']);

/** By the order of the reference and the part that is cut, else by the job's own name; then the drawing and the beginning of the input's hash. */
function fileName(name: string, body: Row, view: string | undefined, hash: string | null): string {
  const reference = (body['reference'] ?? {}) as Record<string, unknown>;
  const part = reference['part'] ?? body['member'];
  const words = [reference['order'], part].filter((word): word is string => typeof word === 'string');
  const parts = [...(words.length ? words : [name]), view ?? '', hash?.slice(0, 8) ?? ''].filter(Boolean);
  return parts.join('-').replace(/[\\/:*?"<>|\s]+/g, '_');
}

/** Returns the options for a format; `apart` are those of its own drawings. */
function queryOf({options}: Format, view: string | undefined, given: Values): URLSearchParams {
  const query = new URLSearchParams(view ? {view} : {});
  const files = options.some(({name}) => name === 'files') && given['files']?.split(',');
  for (const {name} of options) {
    const value = given[name];
    const apart = /^(mirror|paper)$/.test(name) && view !== 'template'; // drawings of other views refuse it
    // A packet's other options are its programs'.
    if (value && !apart && (!files || name === 'files' || files.includes('gcode'))) query.set(name, value);
  }
  return query;
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

/**
 * Returns the initial value of an option. A speed has no default; an initial one spares a refusal.
 */
const beginning = ({name, schema}: Option): string => (schema.items ? ((schema.default ?? []) as string[]).join(',') : name === 'speed_mm_min' ? '600' : '');

interface Asked {
  option: Option;
  users: string;
  value: string;
  change(value: string): void;
}

/** An option that is a list of choices: a box to tick for each. */
function ListField({option: {name, description, schema}, users, value, change}: Asked) {
  const offered = (schema.items as {enum: string[]}).enum;
  const chosen = new Set(value.split(','));
  const tick = (each: string) => change(offered.filter((other) => chosen.has(other) !== (other === each)).join(','));
  return (
    <fieldset class="field ticks" title={plain(description)}>
      <legend class="name">{`${label(name, 'download')} (${users})`}</legend>
      {offered.map((each) => (
        <label key={each} class="tick">
          <input type="checkbox" value={each} data-option={name} checked={chosen.has(each)} onChange={() => tick(each)} />
          {choice(each)}
        </label>
      ))}
    </fieldset>
  );
}

function OptionField(asked: Asked) {
  const {option, users, value, change} = asked;
  const {name, description, schema} = option;
  if (schema.items) return <ListField {...asked} />;
  const choices = schema.enum ?? (schema.type === 'boolean' ? ['false', 'true'] : undefined);
  const shared = {'aria-label': `${label(name, 'download')}, for ${users}`, 'data-option': name, value};
  return (
    <label class="field" title={plain(description)}>
      <span class="name">{`${label(name, 'download')} (${users})`}</span>
      <span class="box">
        {choices ? (
          <select {...shared} onChange={(event) => change(event.currentTarget.value)}>
            <option value="">{choice(schema.default ?? '')} (default)</option>
            {choices.map((each) => (
              <option key={String(each)} value={String(each)}>
                {choice(each)}
              </option>
            ))}
          </select>
        ) : (
          <input
            type="text"
            inputMode="decimal"
            placeholder={String(schema.default ?? '')}
            {...shared}
            onInput={(event) => change(event.currentTarget.value)}
          />
        )}
        {unit(name) && <span class="unit">{unit(name)}</span>}
      </span>
    </label>
  );
}

/**
 * A button for every format that the contract offers here, and a field for each of its options. The
 * file is the service's answer.
 */
export function Downloads({endpoint, name, body, formats}: {endpoint: string; name: string; body: Row; formats: Format[]}) {
  const options = [...new Map(formats.flatMap((format) => format.options).map((option) => [option.name, option])).values()];
  const [given, give] = useState<Values>(() => Object.fromEntries(options.map((option) => [option.name, beginning(option)])));
  const [status, say] = useState('');
  const [coming, come] = useState<number | null | undefined>(undefined); // a share, unknown, nothing
  const fetchFile = async (format: Format, view?: string) => {
    const {media} = format;
    const [title, ending] = known(media);
    const query = queryOf(format, view, given);
    say('');
    come(null); // not reported while it is computed
    const reply = await fetch(`${path(endpoint)}${query.size ? `?${query}` : ''}`, {
      method: 'POST',
      body: JSON.stringify(body),
      headers: headed({'Content-Type': 'application/json', Accept: media}),
    }).catch(() => undefined);
    if (!reply) say(`${title}: ${away.title}`);
    else if (!reply.ok) {
      const problem = (await reply.json().catch(() => ({title: `status ${reply.status}`}))) as Problem;
      say(`${title}: ${plain(`${problem.title} ${problem.detail ?? ''}`)}`);
    } else save(`${fileName(name, body, view, reply.headers.get('Tubecut-Input-Sha256'))}.${ending}`, await received(reply, come));
    come(undefined);
  };
  const users = (option: Option) =>
    formats
      .filter((format) => format.options.some((each) => each.name === option.name))
      .map(({media}) => known(media)[0])
      .join(', ');
  return (
    <section class="block">
      <h3>Download: {endpointName(endpoint)}</h3>
      {options.length > 0 && (
        <div class="options">
          {options.map((option) => (
            <OptionField
              key={option.name}
              option={option}
              users={users(option)}
              value={given[option.name] ?? ''}
              change={(value) => give((was) => ({...was, [option.name]: value}))}
            />
          ))}
        </div>
      )}
      <div class="offers">
        {formats.flatMap((format) =>
          (format.views.length ? format.views : [undefined]).map((view) => (
            <button type="button" key={`${format.media} ${view}`} data-media={format.media} data-view={view} onClick={() => void fetchFile(format, view)}>
              {view ? `${known(format.media)[0]}: ${choice(view)}` : known(format.media)[0]}
            </button>
          )),
        )}
      </div>
      <progress aria-label="Download" hidden={coming === undefined} {...(typeof coming === 'number' ? {value: coming} : {})} />
      <p class="soft" role="status">
        {status}
      </p>
    </section>
  );
}
