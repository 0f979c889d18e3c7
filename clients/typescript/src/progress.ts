/** How far a batch or a frame is, on a terminal. */
import type {Progress} from './lines.js';

const REDRAWN_MS = 100;

/** Such as process.stderr. */
export interface Terminal {isTTY?: boolean; write(text: string): unknown}
export interface ProgressBarOptions {width?: number; now?: () => number}

/** A `progress` that draws `[#####     ] 1200/6000  3 refused  410/s  12 s left`, and nothing where `stream` is no terminal; `close` ends its line. */
export function progressBar(stream: Terminal, {width = 30, now = () => performance.now()}: ProgressBarOptions = {}): Progress & {close(): void} {
  const start = now();
  let next = start;
  const line = (done: number, total: number | undefined, refused: number): string => {
    const rate = 1000 * done / Math.max(now() - start, 1e-6);
    const tail = `  ${refused} refused  ${rate.toFixed(0)}/s`;
    if (!total) return `${done}${tail}`;
    const full = Math.floor(width * done / total);
    const left = done > 0 && done < total ? `  ${((total - done) / rate).toFixed(0)} s left` : '';
    return `[${'#'.repeat(full)}${' '.repeat(width - full)}] ${done}/${total}${tail}${left}`;
  };
  const draw: Progress = (done, total, refused) => {
    if (!stream.isTTY || (now() < next && done !== total)) return;
    next = now() + REDRAWN_MS;
    stream.write(`\r\x1b[K${line(done, total, refused)}`);
  };
  return Object.assign(draw, {close: () => { if (stream.isTTY) stream.write('\n'); }});
}
