import type {ComponentChildren} from 'preact';
import {got, originalOf, said} from '../hint';
import type {Json} from '../json';
import {tried} from '../key';
import {chinese, later, many, t} from '../language';
import {away, holds, type Answer, type Check, type Problem, type Reply, type Warning} from '../service';
import {beside, check as checkName, choice, place, plain, residual, saidOf, sentence, spelled} from '../words';
import {Original} from './field';
import {FrameWarnings} from './frame_warnings';
import {Unlock} from './unlock';

type Focus = (pointer: string) => void;

interface Given {
  reply: Partial<Reply>;
  focus: Focus;
  again(): void;
  /** Facts about the cut. */
  facts?: string;
  /** Has the independent checker look at the answer. */
  check?: () => void;
  /** Leads to the place of a warning in a chart, if one has it. */
  seen?: (warning: Warning) => (() => void) | undefined;
}
/** Verdict, reasons and failed checks, or the problem: in plain sight above the pictures. */
export function Verdict({reply: {answer, problem, milliseconds = 0}, focus, again, facts = '', check, seen}: Given) {
  if (problem?.code === away.code) return <Silence title={t(problem.title)} detail={problem.action && t(problem.action)} again={again} />;
  if (problem?.code === 'unauthorized') return <Unlock key={tried()} go={again} />;
  if (problem) return <Refusal problem={problem} focus={focus} />;
  return answer ? <Approval answer={answer} milliseconds={milliseconds} focus={focus} facts={facts} check={check} seen={seen} /> : null;
}

interface Silent {
  title: string;
  detail?: string | undefined;
  again?: () => void;
  pill?: string;
}
/** Where there is no verdict: a service that is away, a link that cannot be read. */
export const Silence = ({title, detail, again, pill = t('no answer')}: Silent) => (
  <div class="verdict bad">
    <p>
      <span class="pill">{pill}</span>
      <b>{title}</b>
      {again && (
        <button type="button" class="right" id="again" onClick={again}>
          {t('Try again')}
        </button>
      )}
    </p>
    {detail && <p class="soft">{detail}</p>}
  </div>
);

/** What it says may be more than there is room for. */
const scrolled = () => ({tabIndex: 0, role: 'group', 'aria-label': t('Verdict')}) as const;

/** Names a field, and leads to it. */
const Place = ({pointer, focus}: {pointer: string; focus: Focus}) => (
  <button type="button" data-to={pointer} title={t('Show this field')} onClick={() => focus(pointer)}>
    {place(pointer)}
  </button>
);

function Refusal({problem, focus}: {problem: Problem; focus: Focus}) {
  const issues = problem.errors ?? [];
  const [meaning, action] = saidOf('errors', problem.code) ?? [t(problem.title), problem.action && plain(problem.action)];
  const detail = problem.detail && !issues.length ? plain(problem.detail) : '';
  return (
    <div class="verdict bad" {...scrolled()}>
      <p>
        <span class="pill">{t('refused')}</span>
        <b>{meaning}</b>
        {detail && !chinese() ? ` ${detail}` : ''}
      </p>
      {issues.length > 0 && (
        <ul>
          {issues.map((issue) => (
            <li key={issue.pointer + issue.code}>
              <Place pointer={issue.pointer} focus={focus} /> {said(issue)}
              {chinese() || issue.got === undefined || issue.got === null || typeof issue.got === 'object' ? '' : ` – got ${got(issue.got as Json)}`}
              <Original text={originalOf(issue)} />
            </li>
          ))}
        </ul>
      )}
      {action && !(chinese() && issues.length) && <p class="soft">{action}</p>}
      {chinese() && <Original text={detail} />}
    </div>
  );
}

/** Sentence of the verdict, before the facts about the cut. */
const meanings = {
  made: {ok: later('Cuttable.'), review: later('Review before cutting.'), reject: later('Do not cut.')},
  known: {ok: later('Sound.'), review: later('Review first.'), reject: later('Do not use.')},
};
const made = new Set(['bevel-tables', 'holes', 'parts', 'frames', 'pulse-schedules', 'mill-paths', 'replays']);

interface Approved {
  answer: Answer;
  milliseconds: number;
  focus: Focus;
  facts: string;
  check: (() => void) | undefined;
  seen: Given['seen'];
}
function Approval({answer, milliseconds, focus, facts, check, seen}: Approved) {
  const {status, reasons} = answer.verdict;
  const {passed, checks} = answer.verification;
  const failed = passed ? [] : checks.filter((check) => !holds(check));
  const total = checks.length;
  const tone = passed ? {ok: 'good', review: 'warn', reject: 'bad'}[status] : 'bad';
  const named = new Set<string>(answer.warnings.map((w) => w.code));
  const unnamed = reasons.filter((reason) => !named.has(reason));
  const warnings = answer.warnings.filter((warning) => warning.severity === 'cut');
  // A note does not affect the verdict: it is shown on demand.
  const notes = answer.warnings.filter((warning) => warning.severity === 'note');
  const told = (given: Warning[]) => given.map((warning, i) => <Told key={i} warning={warning} focus={focus} show={seen?.(warning)} />);
  const grouped = answer.job.endpoint === 'frames' && warnings.length > 0;
  return (
    <div class={`verdict ${tone}`} {...scrolled()}>
      <p>
        <span class="pill">{choice(status)}</span>
        <span class="said">
          <b>{t(meanings[made.has(answer.job.endpoint) ? 'made' : 'known'][passed ? status : 'reject'])}</b> {facts}
        </span>
      </p>
      <p class="soft">
        <span>
          {passed
            ? t('{passed} of {total} checks of the answer passed', {passed: total, total})
            : t('{failed} of {total} checks failed', {failed: Math.max(1, failed.length), total})}
        </span>{' '}
        {check && (
          <button type="button" id="check-independently" title={t('Recompute the answer in this browser by another program')} onClick={check}>
            {t('Check independently')}
          </button>
        )}
        <span class="right">{t('answered in {time} ms', {time: milliseconds.toFixed(0)})}</span>
      </p>
      {grouped && <FrameWarnings warnings={warnings} />}
      {failed.length + (grouped ? 0 : warnings.length) + unnamed.length > 0 && (
        <ul>
          {failed.map((check) => (
            <li key={check.name}>{overLimit(check)}</li>
          ))}
          {!grouped && told(warnings)}
          {unnamed.map((reason) => (
            <li key={reason}>{sentence(choice(reason))}</li>
          ))}
        </ul>
      )}
      {notes.length > 0 && (
        <details>
          <summary>{many(notes.length, 'A note', '{n} notes')}</summary>
          <ul>{told(notes)}</ul>
        </details>
      )}
    </div>
  );
}

export function Told({
  warning: {code, severity, detail, action, pointer},
  focus,
  show,
}: {warning: Warning; focus: Focus; show?: (() => void) | undefined}): ComponentChildren {
  return (
    <li class={severity}>
      <b>{sentence(choice(code))}</b>
      <Cause warning={{code, detail, action}} />
      {pointer && <Place pointer={pointer} focus={focus} />}
      {show && (
        <button type="button" class="show" title={t('Show its place in the chart')} onClick={show}>
          {t('In the chart')}
        </button>
      )}
      {chinese() && <Original text={detail ? plain(detail) : ''} />}
    </li>
  );
}

/** Meaning and action of a warning, after its name. In Chinese they follow from its code, because the service's own words are English. */
export function Cause({warning: {code, detail, action}}: {warning: Pick<Warning, 'code' | 'detail' | 'action'>}): ComponentChildren {
  const said = saidOf('warnings', code);
  if (said) return `：${said.join('')} `;
  return `${detail ? `: ${plain(detail).replace(/\.$/, '')}. ` : ' '}${action ? `${plain(action)} ` : ''}`;
}

function overLimit(check: Check): string {
  const mark = spelled(check.unit);
  return t('{check}: {value}, limit {limit}', {
    check: sentence(checkName(check.name).name),
    value: beside(residual(check.value, mark), mark),
    limit: beside(residual(check.limit, mark), mark),
  });
}
