// NC1 files as other programs write them, made here: the letters that cling to x and y, blank and
// missing header lines, two and eight columns, several blocks of a kind.
const number = (v) => v.toFixed(2).padStart(11);
const row = (face, x, letter, y, more = []) => `  ${face || ' '}${number(x)}${letter || ' '}${number(y)}${more.map(number).join('')}`;

/** The outline of a face: points [x, y, bevel, depth], with eight columns as most programs write them. */
export const outline = (face, points, code = 'AK', letter = 'u') =>
  [code, ...points.map(([x, y, bevel = 0, depth = 0], i) => row(i === 0 ? face : '', x, i === 0 ? letter : '', y, [0, bevel, depth, 0, 0]))].join('\n');
export const bores = (...rows) => ['BO', ...rows.map(([face, x, letter, y, ...more]) => row(face, x, letter, y, more))].join('\n');

export function file({code = 'M', profile = 'HSS 60x40x4', height = 60, width = 40, wall = 4, radius = 8, length = '1000.00', weight = 0, saw = [0, 0, 0, 0], head = ['A-12', '7', '1', 'R-3', 'S355J2H', '2'], blocks = [], end = ['EN', ''], texts = ['', '', '', '']} = {}) {
  const numbers = [height, width, wall, wall, radius].map((v) => `  ${number(v)}`);
  return ['ST', '** made by hand', ...head.map((each) => `  ${each}`), `  ${profile}`, `  ${code}`, `  ${length}`, ...numbers, `  ${weight.toFixed(3)}`, '  0.187',
    ...saw.map((v) => `  ${v.toFixed(3)}`), ...texts, ...blocks, ...end].join('\n');
}

/** The four outlines of a rectangular tube with ends square at 0 and `length`. */
export const squareFaces = (length = 1000, height = 60, width = 40) => [['v', height], ['o', width], ['u', width], ['h', height]].map(([face, across]) =>
  outline(face, [[0, 0], [length, 0], [length, across], [0, across], [0, 0]]));

/**
 * A saw's cut of the start: x = at (1 + y / height) on v, so that the side below is the longer one. Faces o and u lean, and their
 * outline is the larger one of both walls.
 */
export function mitredFaces(rise, length = 1000, height = 60, width = 40, wall = 4) {
  const bevel = (Math.atan(rise / height) * 180) / Math.PI;
  const top = (rise * (height - wall)) / height;
  return [
    outline('v', [[0, 0], [length, 0], [length, height], [rise, height], [0, 0]], 'AK', 'o'),
    outline('o', [[top, 0, bevel], [top, width], [length, width], [length, 0], [top, 0]], 'AK', 's'),
    outline('u', [[0, 0], [length, 0], [length, width], [0, width, -bevel, wall], [0, 0]], 'AK', 's'),
    outline('h', [[0, 0], [rise, height], [length, height], [length, 0], [0, 0]]),
  ];
}

export const pipe = {code: 'RO', profile: 'CHS 100x5', height: 100, width: 100, wall: 5, radius: 0};
/** A developed outline of a pipe whose start is x = rise (1 - cos phi) / 2. */
export function developed(rise, length = 1000, diameter = 100, steps = 72) {
  const girth = Math.PI * diameter;
  const start = Array.from({length: steps + 1}, (_, i) => [(rise * (1 - Math.cos((2 * Math.PI * i) / steps))) / 2, (girth * i) / steps]);
  return outline('v', [...start.reverse(), [length, 0], [length, girth], start[0]]);
}

/** A pipe as our service writes it, with the comments that state its end and its cut-outs. */
export const ours = ['ST', '** tubecut 0.1.0, input 0123456789abcdef', '** work points: x 0 and 1000', '** end start: square at x 0; kerf 1.5',
  '** end finish: plane at x 1000; normal 0.2 0.1 0.97; groove half the dihedral, cap 45; contact inner; root inner; root face 0; root gap 1; coating 0; kerf 1.5',
  '  -\n  -\n  1\n  P1\n  -\n  1\n  ROHR100.0x5.0\n  RO\n    1010.000,    1012.000\n     100.000\n     100.000\n       5.000\n       5.000\n       0.000\n      11.715\n       0.314\n       0.000\n       0.000\n       0.000\n       0.000\n  -\n  -\n  -\n  -',
  outline('v', [[0, 314.16], [0, 157], [0, 0], [1000, 0], [1000, 157], [1000, 314.16], [0, 314.16]]),
  '** cut-out bolt, square to the tube, a straight tool passes', '** shape: circle 18; wall through; tilt axial; at x 200; y 157', 'BO\n  v     200.000u     157.000      18.000       0.000',
  '** cut-out bolt far, square to the tube, a straight tool passes', 'BO\n  v     200.000u     314.159      18.000       0.000',
  '** cut-out door, its walls parallel', '** shape: contour of 3 pieces from -10 -5; as cut; mirrored; turned 30; wall normal; tilt free; at x 400; y 60', '** line to 10 -5', '** arc ccw to 0 8 about 3 1', '** line to -10 -5',
  outline('v', [[390, 55], [410, 55], [400, 68], [390, 55]], 'IK'), 'EN', ''].join('\r\n');

/** One of each kind, for files that are garbled. */
export const samples = [
  ours,
  file({saw: [-29.24, 0, 0, 0], blocks: [...mitredFaces(33.59), bores(['o', 89, 's', 20, 17.5], ['v', 300, 's', 30, 9, 0, 20, 0, 45]), outline('v', [[500, 20], [540, 20], [540, 40], [500, 20]], 'IK'), 'SI\n  v 200.00u 30.00 0.00 5 T1', 'KO\n  v 1.00 2.00']}),
  file({...pipe, blocks: [developed(40), bores(['v', 500, 'u', 78, 20])]}),
  file({...pipe, saw: [0, 30, 0, 0], blocks: [outline('v', [[0, 0], [1000, 0], [1000, 100], [0, 100], [0, 0]]), bores(['v', 500, 'u', 60, 10])]}),
];
