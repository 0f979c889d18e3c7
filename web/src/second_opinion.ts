import {signal} from '@preact/signals';
import type {Certificate} from '../../clients/check/src/index';
import type {Json} from './json';
import {t} from './language';
import {fetched, type Reply} from './service';

/** An answer and its request as they were sent, and what names in the request mean. */
export interface Order {
  answer: string;
  request: string;
  names: {tubes: Json; machines: Json};
}
export type Told = {certificate: Certificate} | {failure: string};

/** The independent checker in its worker, and its certificate of one answer. */
export class SecondOpinion {
  readonly shown = signal<{of: Reply; told?: Told} | undefined>(undefined);
  private worker: Worker | undefined;

  async ask(reply: Reply): Promise<void> {
    this.close();
    const own = {of: reply};
    this.shown.value = own;
    const told = await this.told(reply).catch((failure: unknown): Told => ({failure: failure instanceof Error ? failure.message : String(failure)}));
    if (this.shown.value === own) this.shown.value = {of: reply, told};
  }

  /** Ends a check that is not done. */
  close(): void {
    this.worker?.terminate();
    this.worker = undefined;
    this.shown.value = undefined;
  }

  private async told({text = '', sent = ''}: Reply): Promise<Told> {
    const [tubes, machines] = await Promise.all([fetched<Json>('/v1/tubes'), fetched<Json>('/v1/machines')]);
    const worker = new Worker(new URL('./check_worker.ts', import.meta.url), {type: 'module'});
    this.worker = worker;
    return new Promise<Told>((resolve, reject) => {
      worker.onmessage = ({data}: MessageEvent<Told>) => resolve(data);
      worker.onerror = (event) => reject(new Error(event.message || t('The independent checker could not be loaded.')));
      worker.postMessage({answer: text, request: sent, names: {tubes, machines}} satisfies Order);
    }).finally(() => worker.terminate());
  }
}
