import type {Json, Row} from '../json';
import {keyed} from '../key';
import {t} from '../language';
import {path} from '../service';
import {Copier} from './controls';

const most = 60000; // characters

const quoted = (text: string) => `'${text.replace(/'/g, `'\\''`)}'`;
/** Names the key's variable instead of the key, because the copied text may be pasted anywhere. */
const curl = (endpoint: string, body: Row) =>
  `curl -s ${keyed() ? '-H "X-Api-Key: $TUBECUT_KEY" ' : ''}-H 'Content-Type: application/json' --data ${quoted(JSON.stringify(body))} ${location.origin}${path(endpoint)}`;

/** Numbers of a list on one line. */
const printed = (value: unknown) =>
  JSON.stringify(value, null, 1).replace(/\[\s+([-\d.e+,\s]+?)\s+\]/g, (_, inner: string) => `[${inner.replace(/\s+/g, ' ')}]`);

function Block({title, id, value, curl: line}: {title: string; id: string; value: unknown; curl?: () => string}) {
  const text = value === undefined ? '' : printed(value);
  return (
    <section class="block">
      <h3>
        {title}
        <Copier name={t('Copy JSON')} text={() => JSON.stringify(value, null, 2)} />
        {line && <Copier name={t('Copy as curl')} text={line} />}
      </h3>
      <pre id={id} tabIndex={0} role="group" aria-label={title}>
        {text.length > most ? `${text.slice(0, most)}\n… ${t('({length} characters; download it)', {length: text.length})}` : text}
      </pre>
    </section>
  );
}

export const Exchange = ({endpoint, body, reply}: {endpoint: string; body: Row; reply: Json | object | undefined}) => (
  <div class="columns">
    <Block title={t('Request')} id="request-json" value={body} curl={() => curl(endpoint, body)} />
    <Block title={t('Answer')} id="answer-json" value={reply} />
  </div>
);
