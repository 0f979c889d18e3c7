import type {Imported, ImportedPart} from './importer';
import {t} from './language';
import type {Answers, Question} from './model';

/** An order to read a file: it returns the content, or the questions; without answers, for the first time. */
export interface Order {
  ending: string;
  file: Uint8Array;
  schedules: string[];
  answers?: Answers;
  again?: boolean; // the questions, as they are after the answers
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
      const timer = setTimeout(
        () => over(() => reject(new Error(t('Reading took longer than {patience} s and was stopped.', {patience}))), true),
        patience * 1000,
      );
      this.drop = () => clearTimeout(timer);
      worker.onmessage = ({data}: MessageEvent<Told>) => over(() => ('failure' in data ? reject(new Error(data.failure)) : resolve(data)), false);
      worker.onerror = (event) => over(() => reject(new Error(event.message || t('The reader of models could not be loaded.'))), true);
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
