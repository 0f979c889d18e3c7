import type {Row} from '../json';
import type {Picture} from '../picture';
import type {Answer} from '../service';
import type {Context, Draw} from './context';
import {bevelTable, intersection} from './cut';
import {wholeFrame} from './frame';
import {generic} from './generic';
import {groove, millPath} from './groove';
import {hole} from './hole';
import {feedCurve, replay} from './machine';
import {node} from './node';
import {part} from './part';
import {schedule} from './schedule';

const known: Record<string, Draw> = {
  'bevel-tables': bevelTable,
  intersections: intersection,
  nodes: node,
  holes: hole,
  parts: part,
  frames: wholeFrame,
  'pulse-schedules': schedule,
  replays: replay,
  'feed-curves': feedCurve,
  grooves: groove,
  'mill-paths': millPath,
};

/** The pictures of an endpoint; one that this console does not know yet is shown as figures, tables and columns. */
const drawing = (endpoint: string): Draw => known[endpoint] ?? generic;

/**
 * Returns the picture of an answer, or the reason why it cannot be drawn, to show next to the
 * answer.
 */
export async function pictured(endpoint: string, body: Row, answer: Answer, context: Context): Promise<Picture | Error> {
  try {
    return await drawing(endpoint)(body, answer, context);
  } catch (failure) {
    return failure instanceof Error ? failure : new Error(String(failure));
  }
}
