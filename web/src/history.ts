import {computed, signal} from '@preact/signals';
import type {Row} from './json';

interface Step {
  body: Row;
  /** The field that the step before this one was changed in. */
  field?: string | undefined;
}
const most = 500; // steps; they share what they have in common

/** The states of one job, to go back to and to come forward from. Changes of one field that follow each other are one step. */
export class History {
  private readonly steps = signal<Step[]>([]);
  private readonly at = signal(0);
  private open: string | undefined; // the field that is being changed
  readonly undoable = computed(() => this.at.value > 0);
  readonly redoable = computed(() => this.at.value < this.steps.value.length - 1);

  begin(body: Row): void {
    this.steps.value = [{body}];
    this.at.value = 0;
    this.open = undefined;
  }

  record(body: Row, field?: string): void {
    const kept = this.steps.value.slice(0, this.at.value + (field !== undefined && field === this.open ? 0 : 1));
    this.steps.value = [...kept, {body, field}].slice(-most);
    this.at.value = this.steps.value.length - 1;
    this.open = field;
  }

  /** What is typed next is a step of its own. */
  settle(): void {
    this.open = undefined;
  }

  /** The state before (-1) or after (1) this one, and the field that is another in it. */
  go(by: 1 | -1): Step | undefined {
    const to = this.steps.value[this.at.value + by];
    const changed = this.steps.value[by > 0 ? this.at.value + 1 : this.at.value];
    if (!to) return undefined;
    this.at.value += by;
    this.open = undefined;
    return {body: to.body, field: changed?.field};
  }
}
