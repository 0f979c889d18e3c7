import type {ComponentChildren} from 'preact';
import {got, said} from '../hint';
import type {Json} from '../json';
import {tried} from '../key';
import {away, holds, type Answer, type Check, type Problem, type Reply, type Warning} from '../service';
import {beside, check as checkName, choice, place, plain, residual, sentence, spelled} from '../words';
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
  if (problem?.code === away.code) return <Silence title={problem.title} detail={problem.action} again={again} />;
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
export const Silence = ({title, detail, again, pill = 'no answer'}: Silent) => (
  <div class="verdict bad">
    <p>
      <span class="pill">{pill}</span>
      <b>{title}</b>
      {again && (
        <button type="button" class="right" id="again" onClick={again}>
          Try again
        </button>
      )}
    </p>
    {detail && <p class="soft">{detail}</p>}
  </div>
);

/** What it says may be more than there is room for. */
const scrolled = {tabIndex: 0, role: 'group', 'aria-label': 'Verdict'} as const;

/** Names a field, and leads to it. */
const Place = ({pointer, focus}: {pointer: string; focus: Focus}) => (
  <button type="button" data-to={pointer} title="Show this field" onClick={() => focus(pointer)}>
    {place(pointer)}
  </button>
);

function Refusal({problem, focus}: {problem: Problem; focus: Focus}) {
  const issues = problem.errors ?? [];
  return (
    <div class="verdict bad" {...scrolled}>
      <p>
        <span class="pill">refused</span>
        <b>{problem.title}</b>
        {problem.detail && !issues.length ? ` ${plain(problem.detail)}` : ''}
      </p>
      {issues.length > 0 && (
        <ul>
          {issues.map((issue) => (
            <li key={issue.pointer + issue.code}>
              <Place pointer={issue.pointer} focus={focus} /> {said(issue)}
              {issue.got === undefined || issue.got === null || typeof issue.got === 'object' ? '' : ` – got ${got(issue.got as Json)}`}
            </li>
          ))}
        </ul>
      )}
      {problem.action && <p class="soft">{plain(problem.action)}</p>}
    </div>
  );
}

/** Sentence of the verdict, before the facts about the cut. */
const meanings = {
  made: {ok: 'Cuttable.', review: 'Review before cutting.', reject: 'Do not cut.'},
  known: {ok: 'Sound.', review: 'Review first.', reject: 'Do not use.'},
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
    <div class={`verdict ${tone}`} {...scrolled}>
      <p>
        <span class="pill">{status}</span>
        <span class="said">
          <b>{meanings[made.has(answer.job.endpoint) ? 'made' : 'known'][passed ? status : 'reject']}</b> {facts}
        </span>
      </p>
      <p class="soft">
        <span>{passed ? `${total} of ${total} checks of the answer passed` : `${Math.max(1, failed.length)} of ${total} checks failed`}</span>{' '}
        {check && (
          <button type="button" id="check-independently" title="Recompute the answer in this browser by another program" onClick={check}>
            Check independently
          </button>
        )}
        <span class="right">answered in {milliseconds.toFixed(0)} ms</span>
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
          <summary>{notes.length === 1 ? 'A note' : `${notes.length} notes`}</summary>
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
      {detail ? `: ${plain(detail).replace(/\.$/, '')}. ` : ' '}
      {action ? `${plain(action)} ` : null}
      {pointer && <Place pointer={pointer} focus={focus} />}
      {show && (
        <button type="button" class="show" title="Show its place in the chart" onClick={show}>
          In the chart
        </button>
      )}
    </li>
  );
}

function overLimit(check: Check): string {
  const mark = spelled(check.unit);
  return `${sentence(checkName(check.name).name)}: ${beside(residual(check.value, mark), mark)}, limit ${beside(residual(check.limit, mark), mark)}`;
}
