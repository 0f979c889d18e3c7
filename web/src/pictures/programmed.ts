import {later, t} from '../language';
import {point} from '../links';
import type {Picture, Played, Solid, Vector} from '../picture';
import {placeOf, type Move, type Program} from '../program';
import {radians} from './geometry';

export const programLink = 'program';
const tones: Record<Move['kind'], string> = {cut: 'after', rapid: 'ink-soft', pierce: 'mark'};
const kindNames: Record<Move['kind'], string> = {cut: later('cut'), rapid: later('rapid'), pierce: later('pierce')};
const lifted = 1.25; // of the tube's reach, at which rapids are drawn
const turn = 6; // degrees of a rapid that are drawn straight

/** Moves of one kind that follow each other in one cut: first and last. */
function stretches(moves: Move[]): [number, number][] {
  const out: [number, number][] = [];
  moves.forEach(({kind, cut}, i) => {
    const last = out[out.length - 1];
    const before = moves[i - 1];
    if (last && before?.kind === kind && before.cut === cut) last[1] = i;
    else out.push([i, i]);
  });
  return out;
}

/** A rapid while the tube turns under it. */
function turned(from: Move, to: Move): Move[] {
  const steps = Math.max(1, Math.ceil(Math.abs(to.phi - from.phi) / turn));
  const between = (key: 'x' | 'phi' | 'out' | 'across', i: number) => from[key] + ((to[key] - from[key]) * i) / steps;
  return Array.from({length: steps}, (_, i) => ({
    ...to,
    x: between('x', i + 1),
    phi: between('phi', i + 1),
    out: between('out', i + 1),
    across: between('across', i + 1),
  }));
}

/** The picture of a part or a cut with a program on it: the tube turns under the torch, the moves have the colour of their kind. */
export function programmed(picture: Picture, {moves, tube}: Program): Picture {
  const {solid} = picture;
  if (!solid || !moves.length) return picture;
  const {reach, round, wall, zero} = tube;
  const high = lifted * reach;
  /** `deep` below the tip, along the torch. */
  const below = (move: Move, deep: number): Vector => placeOf({...move, out: Math.min(move.out, high) - deep}, zero - deep * Math.tan(move.b * radians));
  const over = (move: Move): Vector => placeOf(round ? {...move, out: high} : {...move, out: Math.min(move.out, high)}, zero);
  const on = (move: Move): Vector => placeOf({...move, out: 1.004 * move.out, across: 1.004 * move.across}, zero);
  const parts = stretches(moves);
  const lines = parts
    .filter(([from]) => moves[from]?.kind !== 'pierce')
    .map(([from, to]) => {
      const kind = (moves[from] as Move).kind;
      const path = moves.slice(Math.max(0, from - 1), to + 1);
      const whole = kind === 'rapid' ? path.flatMap((move, i) => (i ? turned(path[i - 1] as Move, move) : [move])) : path;
      return {points: path.length > 1 ? whole.map(kind === 'rapid' ? over : on) : [], tone: tones[kind]};
    })
    .filter(({points}) => points.length > 1);
  const tool: Solid['tool'] = {
    kind: 'torch',
    inner: moves.map((move) => below(move, wall)),
    outer: moves.map((move) => below(move, 0)),
    size: reach,
    turn: moves.map(({phi}) => phi),
  };
  return {...picture, solid: {...solid, link: programLink, lines: [...(solid.lines ?? []), ...lines], tool}, played: playedOf(moves, parts)};
}

function playedOf(moves: Move[], parts: [number, number][]): Played {
  const seconds: number[] = [];
  for (const move of moves) seconds.push((seconds[seconds.length - 1] ?? 0) + move.seconds);
  const begins = parts.filter(
    ([from]) => moves[from]?.kind === 'cut' && moves.slice(0, from).every(({kind, cut}) => kind !== 'cut' || cut !== moves[from]?.cut),
  );
  return {
    link: programLink,
    seconds,
    events: begins.map(([from]) => ({at: from, text: moves[from]?.cut || t('cut')})),
    segments: parts.map(([from, to]) => ({
      from: from === 0 ? 0 : (seconds[from - 1] as number),
      to: seconds[to] as number,
      tone: tones[(moves[from] as Move).kind],
      text: [kindNames[(moves[from] as Move).kind], moves[from]?.cut].flatMap((each) => (each ? [t(each)] : [])).join(', '),
    })),
  };
}

/** Moves the cursor to the first move that a line of the program makes, or to the next one. */
export function pointLine({moves}: Program, line: number): void {
  const found = moves.findIndex((move) => move.line >= line);
  if (found >= 0) point(programLink, found);
}
