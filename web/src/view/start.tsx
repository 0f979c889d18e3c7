import {useEffect, useMemo, useState} from 'preact/hooks';
import type {Console} from '../console';
import {forget, recent, type Draft} from '../drafts';
import type {Row} from '../json';
import {locale, many, t} from '../language';
import {endpointName, exampleName} from '../names';
import {sketched, sketchSize} from '../sketch';
import {byTask, tasks, type Task} from '../tasks';
import {useConsole} from './page';

const shownJobs = 6;

/** The first page: the purpose of tubecut, its tasks, and the recent jobs. */
export function Start() {
  const console = useConsole();
  return (
    <section id="start" aria-label={t('Start')} tabIndex={-1} hidden={!console.home.value || console.place.value !== 'start'}>
      <h1>
        {t('tubecut computes how tubes are cut to fit each other, from one joint to a whole frame, and checks every answer before it leaves the service.')}
      </h1>
      <Recent />
      <div class="tasks">
        {tasks.map((task) => (
          <TaskCard key={task.id} task={task} />
        ))}
      </div>
    </section>
  );
}

function TaskCard({task}: {task: Task}) {
  const console = useConsole();
  const offered = useMemo(() => byTask(console.examples, ({endpoint}) => endpoint).find((each) => each.task === task)?.items ?? [], [console]);
  const [first = ''] = task.endpoints;
  const pictured = task.examples.flatMap((key) => offered.find(({endpoint, name}) => `${endpoint}/${name}` === key) ?? []);
  return (
    <section class="block task" data-task={task.id} aria-labelledby={`task-${task.id}`}>
      <h2 id={`task-${task.id}`}>{t(task.name)}</h2>
      <p>{t(task.about)}</p>
      <p class="ways">
        <button type="button" data-new={first} onClick={() => console.fresh(first)}>
          {t('New: {endpoint}', {endpoint: endpointName(first)})}
        </button>
        {task.endpoints.slice(1).map((id) => (
          <a key={id} href={`#/${id}`}>
            {endpointName(id)}
          </a>
        ))}
        {task.id === 'machine' && <a href="#/own-machine">{t('Own machine and post')}</a>}
      </p>
      <ul class="examples">
        {pictured.map(({endpoint, name, body}) => (
          <li key={name}>
            <a href={`#/${endpoint}/${name}`}>
              <Picture body={body} console={console} />
              <span>{exampleName(endpoint, name)}</span>
            </a>
          </li>
        ))}
      </ul>
      <details>
        <summary>{t('All {n} examples', {n: offered.length})}</summary>
        <ul class="names">
          {offered.map(({endpoint, name}) => (
            <li key={`${endpoint}/${name}`}>
              <a href={`#/${endpoint}/${name}`}>{exampleName(endpoint, name)}</a> <span class="soft">{endpointName(endpoint)}</span>
            </li>
          ))}
        </ul>
      </details>
    </section>
  );
}

/** A drawing of the tubes of a request; of one without tubes, such as a feed curve, a curve. */
function Picture({body, console}: {body: Row; console: Console}) {
  const sketch = useMemo(() => sketched(body, console.context.sizes), [body]);
  const [width, height] = sketchSize;
  return (
    <svg viewBox={`0 0 ${width} ${height}`} aria-hidden="true">
      {sketch ? (
        sketch.lines.flatMap(({from: [x1, y1], to: [x2, y2], width: wide, tone}, i) => [
          <line key={`e${i}`} {...{x1, y1, x2, y2}} stroke="var(--edge)" stroke-width={wide + 1.2} />,
          <line key={`t${i}`} {...{x1, y1, x2, y2}} stroke={`var(--${tone})`} stroke-width={wide} />,
          <line key={`l${i}`} {...{x1, y1, x2, y2}} stroke="#fff" stroke-opacity={tone === 'bore' ? 0 : 0.2} stroke-width={wide / 3} />,
        ])
      ) : (
        <>
          <path d="M14 82H150M14 82V12" stroke="var(--ink-soft)" />
          <path d="M14 74C50 74 54 26 84 26S118 66 150 58" stroke="var(--after)" stroke-width="3" />
        </>
      )}
    </svg>
  );
}

/** The subject of a job, by the names that its owner gave. */
export function subjectOf(body: Row): string {
  const of = (key: string) => (typeof body[key] === 'object' && body[key] !== null && !Array.isArray(body[key]) ? (body[key] as Row) : {});
  const inner = ['cut', 'part', 'mill_path', 'groove'].find((key) => Object.keys(of(key)).length);
  const members = Array.isArray(body['members']) ? body['members'].length : 0;
  const named = [of('reference')['order'], of('reference')['part'], body['member'], of('target')['id'], of('branch')['id']];
  const found = named.filter((each): each is string => typeof each === 'string').slice(0, 2);
  if (found.length) return found.join(', ');
  if (members) return many(members, '{n} member', '{n} members');
  return inner ? subjectOf(of(inner)) : '';
}

/** Jobs that were changed in this browser, the newest first. */
function Recent() {
  const console = useConsole();
  const [jobs, list] = useState<Draft[]>([]);
  const home = console.home.value;
  useEffect(() => {
    if (home) void recent().then((all) => list(all.slice(0, shownJobs)));
  }, [home]);
  if (!jobs.length) return null;
  const drop = (id: string) => {
    list(jobs.filter((each) => each.id !== id));
    void forget(id);
  };
  return (
    <section class="block" id="recent" aria-labelledby="recent-jobs">
      <h2 id="recent-jobs">{t('Recent jobs')}</h2>
      <ul>
        {jobs.map(({id, endpoint, body, changed}) => (
          <li key={id}>
            <a href={`#/${endpoint}/@${id}`}>
              <Picture body={body} console={console} />
              <span>
                {endpointName(endpoint)}
                {subjectOf(body) && `: ${subjectOf(body)}`}
              </span>
            </a>
            <time class="soft" dateTime={new Date(changed).toISOString()}>
              {new Date(changed).toLocaleString(locale(), {dateStyle: 'medium', timeStyle: 'short'})}
            </time>
            <button
              type="button"
              class="remove"
              aria-label={t('Forget {job}', {job: `${endpointName(endpoint)} ${subjectOf(body)}`})}
              title={t('Forget this job')}
              onClick={() => drop(id)}
            >
              ×
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
