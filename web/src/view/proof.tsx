import {isRow, type Json, type Row} from '../json';
import {later, t} from '../language';
import {holds, type Answer, type Check} from '../service';
import {about, beside, check as checkName, choice, label, number, residual, sentence, shown, spelled, term} from '../words';
import {Sheet, Table} from './tables';

const active = 0.98; // of a limit that may be used up: the answer rests on it
const near = 0.5; // of one that may not

/**
 * Returns the state of a check relative to its limit: a limit that may be used up is active at it,
 * a residual is near a failure.
 */
function standing(check: Check, kind: 'checks' | 'limits'): {tone: string; text: string; share: number} {
  const whole = check.limit > 0 ? check.value / check.limit : check.value > 0 ? Infinity : 0;
  const share = Math.min(1, Math.max(0, whole));
  if (!holds(check)) return {tone: 'failed', text: t('FAILED'), share};
  if (kind === 'limits' && whole >= active) return {tone: 'active', text: t('at its limit, which is permitted'), share};
  if (kind === 'checks' && whole >= near) return {tone: 'near', text: t('passes, near its limit'), share};
  return {tone: '', text: t('holds'), share};
}

function Measured({check}: {check: Check}) {
  const {name, about, kind} = checkName(check.name);
  const {tone, text, share} = standing(check, kind);
  const mark = spelled(check.unit);
  return (
    <tr class={tone} title={about}>
      <td>{sentence(name)}</td>
      <td>{beside(residual(check.value, mark), mark)}</td>
      <td>{beside(residual(check.limit, mark), mark)}</td>
      <td>
        <meter min={0} max={1} value={share} aria-label={t('{name}: share of the limit', {name})} />{' '}
        {share > 0 && share < 0.01 ? '< 1' : number(100 * share, '%')} %
      </td>
      <td>{text}</td>
    </tr>
  );
}

const proven = later('Residuals computed from the answer by other formulas than those that made it, and its limits.');

/** Measured against permitted values, as a fraction of the limit. */
export function Proof({answer: {job, verification}}: {answer: Answer}) {
  const hash = (name: 'input_sha256' | 'result_sha256') => [{text: label(name), about: about(name)}, `${job[name].slice(0, 12)} …`];
  return (
    <div class="columns">
      <Sheet title={t('Proof')} head={[t('Check'), t('Value'), t('Limit'), t('Of the limit'), '']} note={t(proven)} whole>
        {verification.checks.map((check) => (
          <Measured key={check.name} check={check} />
        ))}
      </Sheet>
      <Table title={t('Job')} head={['', '']} rows={[[term('engine'), job.engine], [t('job'), job.id], hash('input_sha256'), hash('result_sha256')]} />
    </div>
  );
}

const most = 1000; // rows that are shown
const textual = (key: string, value: Json | undefined) =>
  typeof value === 'number' ? shown(key, value) : typeof value === 'boolean' ? (value ? t('yes') : t('no')) : choice(value ?? '');

/** Returns the parts of an answer with columns of points: title, columns, name. */
function curvesOf(row: Row, name = ''): [string, Row, string][] {
  return Object.entries(row).flatMap(([key, value]) => {
    const each: [string, Json][] = Array.isArray(value) && isRow(value[0]) ? value.map((v, i) => [`${label(key)} ${i + 1}`, v]) : [[label(key), value]];
    return each.flatMap(([title, inner]): [string, Row, string][] => {
      if (!isRow(inner)) return [];
      const lists = Object.values(inner).filter((v) => Array.isArray(v) && typeof v[0] !== 'object');
      if (lists.length > 1 && (lists[0] as Json[]).length > 2) return [[name ? `${name}: ${title}` : title, inner, key]];
      return curvesOf(inner, title);
    });
  });
}

/** Every column of the answer's points. */
export function Columns({answer}: {answer: Answer}) {
  const found = curvesOf(answer.result);
  if (!found.length) return <p class="soft">{t('No curves in this answer: its tables are with the proof.')}</p>;
  return (
    <div>
      {found.slice(0, 6).map(([name, row, within]) => {
        const columns = Object.entries(row).filter(([, v]) => Array.isArray(v)) as [string, Json[]][];
        const all = columns[0]?.[1].length ?? 0;
        const count = Math.min(most, all);
        return (
          <Table
            key={name}
            title={
              count === most
                ? t('{name}, {all} rows (the first {most} here)', {name: sentence(name), all, most})
                : t('{name}, {all} rows', {name: sentence(name), all})
            }
            head={columns.map(([key]) => term(key, within))}
            rows={Array.from({length: count}, (_, i) => columns.map(([key, v]) => textual(key, v[i])))}
          />
        );
      })}
    </div>
  );
}
