import {point} from '../links';
import type {CutTube, HoledTube, Picture, Played, Solid, Vector} from '../picture';
import type {Move, Program} from '../program';
import {bounds, onTube, radians} from './geometry';

export const programLink = 'program';
const tones: Record<Move['kind'], string> = {cut: 'after', rapid: 'ink-soft', pierce: 'mark'};
const lifted = 0.25; // of the radius, by which rapids are drawn above the tube

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

/** The picture of a part or a cut with a program on it: the tube turns under the torch, the moves have the colour of their kind. */
export function programmed(picture: Picture, {moves}: Program): Picture {
  const {solid} = picture;
  const tube = solid?.holed?.[0] ?? solid?.tubes[0];
  if (!solid || !tube || !moves.length) return picture;
  const zero = zeroOf(tube);
  const at = (radius: number, {x, phi, b}: Move): Vector => onTube(radius, phi, zero + x - (tube.outer - radius) * Math.tan(b * radians));
  const parts = stretches(moves);
  const lines = parts
    .filter(([from]) => moves[from]?.kind !== 'pierce')
    .map(([from, to]) => {
      const kind = (moves[from] as Move).kind;
      const radius = tube.outer * (kind === 'rapid' ? 1 + lifted : 1.004);
      const path = moves.slice(Math.max(0, from - 1), to + 1);
      return {points: path.length > 1 ? path.map((move) => onTube(radius, move.phi, zero + move.x)) : [], tone: tones[kind]};
    })
    .filter(({points}) => points.length > 1);
  const tool: Solid['tool'] = {
    kind: 'torch',
    inner: moves.map((move) => at(tube.inner, move)),
    outer: moves.map((move) => at(tube.outer, move)),
    size: tube.outer,
    turn: moves.map(({phi}) => phi),
  };
  return {...picture, solid: {...solid, link: programLink, lines: [...(solid.lines ?? []), ...lines], tool}, played: playedOf(moves, parts)};
}

/** X0 of the program along the axis: a part's long point at its start, the work point of a cut. */
const zeroOf = (tube: HoledTube | CutTube): number => ('from' in tube ? bounds([...tube.from.zOuter, ...tube.from.zInner])[0] : 0);

function playedOf(moves: Move[], parts: [number, number][]): Played {
  const seconds: number[] = [];
  for (const move of moves) seconds.push((seconds[seconds.length - 1] ?? 0) + move.seconds);
  const begins = parts.filter(
    ([from]) => moves[from]?.kind === 'cut' && moves.slice(0, from).every(({kind, cut}) => kind !== 'cut' || cut !== moves[from]?.cut),
  );
  return {
    link: programLink,
    seconds,
    events: begins.map(([from]) => ({at: from, text: moves[from]?.cut || 'cut'})),
    segments: parts.map(([from, to]) => ({
      from: from === 0 ? 0 : (seconds[from - 1] as number),
      to: seconds[to] as number,
      tone: tones[(moves[from] as Move).kind],
      text: [moves[from]?.kind, moves[from]?.cut].filter(Boolean).join(', '),
    })),
  };
}

/** Moves the cursor to the first move that a line of the program makes, or to the next one. */
export function pointLine({moves}: Program, line: number): void {
  const found = moves.findIndex((move) => move.line >= line);
  if (found >= 0) point(programLink, found);
}
