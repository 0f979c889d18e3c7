import type {Imported, ImportedPart} from './importer';
import type {Answers, Question} from './model';

/** An order to read a file: without answers it returns questions, else the content. */
export interface Order {
  ending: string;
  file: Uint8Array;
  schedules: string[];
  answers?: Answers;
}
export type Told = {questions: Question[]} | {imported: Imported | ImportedPart} | {failure: string};

const patience = 60; // s: models of thousands of tubes take a few

/** The worker that reads models. An order that comes while it is at another ends that one. */
export class Reading {
  private worker: Worker | undefined;
  private drop: (() => void) | undefined;

  async ask(order: Order): Promise<Told> {
    if (this.drop) this.end();
    this.worker ??= new Worker(new URL('./import_worker.ts', import.meta.url), {type: 'module'});
    const {worker} = this;
    return new Promise<Told>((resolve, reject) => {
      const over = (act: () => void, end: boolean) => {
        clearTimeout(timer);
        this.drop = undefined;
        if (end) this.end();
        act();
      };
      const timer = setTimeout(() => over(() => reject(new Error(`Reading took longer than ${patience} s and was stopped.`)), true), patience * 1000);
      this.drop = () => clearTimeout(timer);
      worker.onmessage = ({data}: MessageEvent<Told>) => over(() => ('failure' in data ? reject(new Error(data.failure)) : resolve(data)), false);
      worker.onerror = (event) => over(() => reject(new Error(event.message || 'The reader of models could not be loaded.')), true);
      worker.postMessage(order);
    });
  }

  /** Cancels the last order's answer. */
  end(): void {
    this.drop?.();
    this.drop = undefined;
    this.worker?.terminate();
    this.worker = undefined;
  }
}
