import {headed} from './key';

const first = 500; // ms
const longest = 5000; // ms between two looks at a service that is away

/** Waits for a service that is away, and says when it is back. */
export class Watch {
  private timer = 0;
  private wait = first;
  private again: (() => void) | undefined;

  constructor() {
    addEventListener('online', () => void this.look());
  }

  begin(again: () => void): void {
    this.again = again;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.look(), this.wait);
    this.wait = Math.min(longest, 1.5 * this.wait);
  }

  end(): void {
    this.again = undefined;
    clearTimeout(this.timer);
    this.wait = first;
  }

  private async look(): Promise<void> {
    const {again} = this;
    if (!again) return;
    const reply = await fetch('/v1/version', {headers: headed(), cache: 'no-store'}).catch(() => undefined);
    if (again !== this.again) return; // answered otherwise meanwhile
    if (!reply || reply.status >= 500) return this.begin(again); // a proxy without a service behind it answers 502 or 503
    this.end();
    again();
  }
}
