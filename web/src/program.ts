/** A move of a program: from the place of the one before to its own. */
export interface Move {
  line: number; // of the text, from 0
  kind: 'rapid' | 'cut' | 'pierce';
  seconds: number;
  x: number; // of the torch's tip along the tube, mm from the program's zero
  phi: number; // of the tube under the torch, degrees
  out: number; // of the tip over the axis of the tube, mm
  across: number; // and to the left of it, seen along the tube
  b: number; // lean of the torch, degrees
  cut: string; // that it belongs to
}
export interface Program {
  lines: string[];
  moves: Move[];
  /** Seconds of cutting and piercing, and of rapids at the speeds below; length that is cut, mm. */
  time: {cut: number; pierce: number; rapid: number};
  length: number;
  tube: Tube;
}
/** The tube that a program states: its size across, and the place of X0 along it. */
export interface Tube {
  round: boolean;
  reach: number; // from the axis to the outermost place, mm
  wall: number;
  zero: number;
}

// Programs leave rapids to the control; these speeds are typical of a tube cutter, and stated with the time.
export const rapidSpeed = {mm_s: 200, deg_s: 180};

const radians = Math.PI / 180;
const word = /([A-Z])\s*(\[[^\]]*\]|[-+]?(?:\d+\.?\d*|\.\d+))/g;

/** The values of a line's words. `names` are the variables that were set: `F[#<speed_mm_min> / 0.5]`. */
function wordsOf(code: string, names: Map<string, number>): Map<string, number[]> {
  const out = new Map<string, number[]>();
  for (const [, letter = '', text = ''] of code.matchAll(word)) {
    const [, name = '', by = '1'] = /^\[#<([^>]+)>(?:\s*\/\s*([\d.]+))?\]$/.exec(text) ?? [];
    const value = text.startsWith('[') ? (names.get(name) ?? NaN) / Number(by) : Number(text);
    out.set(letter, [...(out.get(letter) ?? []), value]);
  }
  return out;
}

const commentOf = (line: string) => /^\s*(?:N\d+\s*)?(?:\((.*)\)|;(.*))\s*$/.exec(line)?.slice(1).find(Boolean);

/** A place over the wall, in the tube's own frame. */
export function placeOf({out, across, phi, x}: Pick<Move, 'out' | 'across' | 'phi' | 'x'>, zero = 0): [number, number, number] {
  const [c, s] = [Math.cos(phi * radians), Math.sin(phi * radians)];
  return [out * c - across * s, out * s + across * c, zero + x];
}

/** "tube 80 x 40 x 3 mm, corners 6 mm outside", or "tube 60 x 4 mm" if it is round. */
function tubeOf(comments: string): Tube {
  const sizes = (/^tube ([\d.]+(?: x [\d.]+)+) mm/m.exec(comments)?.[1] ?? '').split(' x ').map(Number);
  const round = sizes.length < 3;
  const zero = Number(/^x0: [^,]*, z ([-\d.]+)/m.exec(comments)?.[1] ?? 0);
  return {round, reach: round ? (sizes[0] ?? 0) / 2 : Math.hypot(sizes[0] as number, sizes[1] as number) / 2, wall: sizes[sizes.length - 1] ?? 0, zero};
}

function wayBetween(from: Move, to: Move, {round, reach}: Tube): number {
  if (round) return Math.hypot(to.x - from.x, reach * radians * (to.phi - from.phi));
  const [a, b] = [placeOf(from), placeOf(to)];
  return Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

/** The moves of a G-code program of this service in mm and degrees, with X along the tube; of another program the lines alone. */
export function parseProgram(text: string): Program {
  const lines = text.replace(/\r/g, '').replace(/\n$/, '').split('\n');
  const comments = lines.flatMap((line) => commentOf(line) ?? []).map((line) => line.toLowerCase());
  const metric = comments.includes('units mm, deg, mm/min') && comments.some((line) => line.startsWith('x0: '));
  const tube = tubeOf(comments.join('\n'));
  const program: Program = {lines, moves: [], time: {cut: 0, pierce: 0, rapid: 0}, length: 0, tube};
  if (!metric) return program;
  const pivot = Number(/pivot of the torch, ([\d.]+) mm from its tip/.exec(comments.join('\n'))?.[1] ?? 0);
  const names = new Map<string, number>();
  const at = new Map<string, number>();
  let [mode, inverse, cut, feed, known] = [0, false, '', 0, false];
  lines.forEach((line, i) => {
    const comment = commentOf(line);
    const named = comment && /^cut: (.*)$/i.exec(comment)?.[1];
    if (named) cut = named;
    const assigned = /#<([^>]+)>\s*=\s*([\d.]+)/.exec(line);
    if (assigned) names.set(assigned[1] as string, Number(assigned[2]));
    if (comment !== undefined || assigned) return;
    const words = wordsOf(line.replace(/\([^)]*\)|;.*$/g, ''), names);
    const g = words.get('G') ?? [];
    for (const code of g) {
      if (code === 0 || code === 1) mode = code;
      if (code === 93) inverse = true;
      if (code === 94) inverse = false;
    }
    const add = (kind: Move['kind'], seconds: number) => {
      const b = at.get('B') ?? 0;
      const [x, phi] = [(at.get('X') ?? 0) - pivot * Math.sin(b * radians), at.get('A') ?? 0];
      // Around a section Y and Z follow the wall; of a round tube the wall is always as far from the axis.
      const [out, across] = tube.round ? [tube.reach, 0] : [(at.get('Z') ?? 0) - pivot * Math.cos(b * radians), -(at.get('Y') ?? 0)];
      const move: Move = {line: i, kind, seconds, x, phi, out, across, b, cut};
      const before = program.moves[program.moves.length - 1];
      if (kind === 'cut' && before) program.length += wayBetween(before, move, tube);
      program.moves.push(move);
      program.time[kind] += seconds;
    };
    if (g.includes(4)) return add('pierce', (words.get('P') ?? words.get('X') ?? words.get('F') ?? [0])[0] ?? 0);
    if (words.get('M')?.includes(3) && known) add('pierce', 0);
    const before = new Map(at);
    let moved = false;
    for (const letter of 'XYZABC') {
      const value = words.get(letter)?.[0];
      if (value === undefined || g.includes(4)) continue;
      moved = true;
      at.set(letter, value);
    }
    feed = words.get('F')?.[0] ?? feed;
    if (!moved) return;
    const by = (letter: string) => Math.abs((at.get(letter) ?? 0) - (before.get(letter) ?? at.get(letter) ?? 0));
    const way = Math.hypot(by('X'), by('Y'), by('Z'));
    if (mode === 0) add('rapid', Math.max(way / rapidSpeed.mm_s, Math.max(by('A'), by('B')) / rapidSpeed.deg_s));
    else add('cut', feed > 0 ? (inverse ? 60 / feed : (60 * way) / feed) : 0);
    known = true;
  });
  return program;
}
