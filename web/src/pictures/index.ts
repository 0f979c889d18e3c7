import type {Draw} from './context';
import {bevelTable, intersection} from './cut';
import {generic, part} from './generic';
import {groove, millPath} from './groove';
import {hole} from './hole';
import {feedCurve, replay, schedule} from './machine';
import {node} from './node';

const known: Record<string, Draw> = {
  'bevel-tables': bevelTable,
  intersections: intersection,
  nodes: node,
  holes: hole,
  parts: part,
  'pulse-schedules': schedule,
  replays: replay,
  'feed-curves': feedCurve,
  grooves: groove,
  'mill-paths': millPath,
};

/** The pictures of an endpoint; one that this console does not know yet is shown as figures, tables and columns. */
export const drawing = (endpoint: string): Draw => known[endpoint] ?? generic;
