import type {Row} from '../json';
import {locale, t} from '../language';
import {linesOf} from '../lines';
import {endpointName, exampleName} from '../names';
import {onWhite} from '../theme';
import {useConsole} from './page';

const most = 160; // lines of a request; a longer one is a file

/** The head of a print: the job's name and its request. On the screen the form has both. */
export function Paper() {
  const console = useConsole();
  if (!onWhite.value) return null;
  const [endpoint, example] = [console.endpoint.value, console.example.value];
  const lines = linesOf(console.body as Row);
  return (
    <section id="paper" aria-label={t('Request')}>
      <h1>
        tubecut: {endpointName(endpoint)}
        {example && t(', ') + exampleName(endpoint, example)}
      </h1>
      <p class="soft">
        {new Date().toLocaleString(locale(), {dateStyle: 'medium', timeStyle: 'short'})}
        {console.answer.value && t(', job {id}', {id: console.answer.value.job.id})}
      </p>
      <dl>
        {lines.slice(0, most).map(([name, value], i) => (
          <div key={i}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
      {lines.length > most && <p class="soft">{t('and {n} more values, in the file of the job', {n: lines.length - most})}</p>}
    </section>
  );
}
