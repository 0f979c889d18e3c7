import type {Json, Row} from '../json';
import {ask, type Answer} from '../service';
import type {Sizes} from './geometry';

/**
 * Data that a picture may need in addition to request and answer: sizes by name, and further (pure)
 * answers.
 */
export interface Context {
  sizes: Sizes;
  /** Machines by name. */
  machines: Map<string, Row>;
  ask(endpoint: string, body: Json): Promise<Answer>;
}
export type Draw = (body: Row, answer: Answer, context: Context) => Promise<import('../picture').Picture>;

export const common = new Set(['reference', 'log', 'numerics', 'accept']);
export const without = (body: Row, names = common): Row => Object.fromEntries(Object.entries(body).filter(([key]) => !names.has(key)));

/**
 * Keeps answers, because they are pure; repeats requests without an answer, and reports an error
 * for the picture that needs them.
 */
export function contextOf(sizes: Sizes, machines: Map<string, Row>): Context {
  const known = new Map<string, Promise<Answer>>();
  const answered = async (endpoint: string, body: Json): Promise<Answer> => {
    const {answer, problem} = await ask(endpoint, body);
    if (!answer) throw new Error(`${endpoint}: ${problem?.detail ?? problem?.title ?? 'no answer'}`);
    return answer;
  };
  return {
    sizes,
    machines,
    ask: (endpoint, body) => {
      const key = endpoint + JSON.stringify(body);
      if (known.size > 20) known.clear();
      const found = known.get(key) ?? answered(endpoint, body);
      known.set(key, found);
      found.catch(() => known.delete(key));
      return found;
    },
  };
}
