import type {Json, Row} from '../json';
import type {Answer} from '../service';
import type {Sizes} from './geometry';

/** What a picture may need besides request and answer: sizes by name, and further (pure) answers. */
export interface Context {
  sizes: Sizes;
  /** Machines by name. */
  machines: Map<string, Row>;
  ask(endpoint: string, body: Json): Promise<Answer | undefined>;
}
export type Draw = (body: Row, answer: Answer, context: Context) => Promise<import('../picture').Picture>;

export const common = new Set(['reference', 'log', 'numerics', 'accept']);
export const without = (body: Row, names = common): Row => Object.fromEntries(Object.entries(body).filter(([key]) => !names.has(key)));
