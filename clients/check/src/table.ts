import type {Certificate} from './index.js';

const figure = (value: number): string => (Number.isInteger(value) && Math.abs(value) < 1e6 ? String(value) : value.toPrecision(3));

/** The certificate in lines: of each check the worst value found and its bound; then what no check covers. */
export function table({passed, checks, notChecked}: Certificate): string {
  const rows = checks.map(({name, value, limit, unit, passed: held, places, where}) => [
    held ? 'ok' : 'FAILS',
    name,
    figure(value),
    figure(limit),
    unit,
    String(places),
    where,
  ]);
  const head = ['', 'check', 'found', 'at most', 'unit', 'places', ''];
  const width = head.map((text, i) => Math.max(text.length, ...rows.map((row) => row[i].length)));
  const line = (row: string[]) =>
    row
      .map((text, i) => ((i >= 2 && i <= 3) || i === 5 ? text.padStart(width[i]) : text.padEnd(width[i])))
      .join('  ')
      .trimEnd();
  const missing = notChecked.map(({pointer, why}) => `not checked  ${pointer}${why ? `: ${why}` : ''}`);
  const failed = checks.filter((check) => !check.passed).length;
  const last = passed ? `all ${checks.length} checks hold` : `${failed} of ${checks.length} checks fail`;
  return [line(head), ...rows.map(line), ...missing, last].join('\n');
}
