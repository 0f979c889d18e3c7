// PCF files drawn at random, each with its expected result. Sizes are copied here from ASME
// B36.10M, not taken from the import.
import {between, pick, random} from './random.mjs';

/** NPS in inches: DN, outside diameter in mm, how NPS is written. */
const sizes = {
  0.125: [6, 10.3, '1/8'], 0.5: [15, 21.3, '1/2'], 1.5: [40, 48.3, '1-1/2'], 2: [50, 60.3, '2'], 3: [80, 88.9, '3'], 4: [100, 114.3, '4'], 6: [150, 168.3, '6'], 8: [200, 219.1, '8'],
  10: [250, 273, '10'], 12: [300, 323.8, '12'], 16: [400, 406.4, '16'], 22: [550, 559, '22'], 24: [600, 610, '24'], 30: [750, 762, '30'], 36: [900, 914, '36'], 42: [1050, 1067, '42'], 48: [1200, 1219, '48'],
};
/** How programs write bores: the unit, the number, and whether a map is needed. */
const conventions = [
  {unit: 'INCH', of: (inches) => inches},
  {unit: 'INCH-SIXTEENTH', of: (inches) => inches * 16},
  {unit: 'MM', of: (inches) => sizes[inches][0]},
  {unit: 'MM', of: (inches) => inches * 25.4, mapped: true},
  {unit: 'MM', of: (inches) => sizes[inches][1], mapped: true, outside: true},
  {unit: 'INCH', of: (inches) => sizes[inches][1] / 25.4, mapped: true, outside: true},
];
const fittings = ['VALVE', 'FLANGE', 'COUPLING', 'REDUCER-CONCENTRIC', 'TEE', 'ELBOW', 'INSTRUMENT', 'FILTER', 'UNION', 'MISC-COMPONENT', 'CROSS'];
const plus = (p, d, k) => p.map((v, i) => v + k * d[i]);

export function spool(seed) {
  const next = random(seed);
  const way = conventions[seed % conventions.length];
  // The outside diameters of NPS 3, 16 and 30 in inches are nominal sizes themselves: no question
  // is expected. DN 6 may be 6 in: a question is expected.
  const [unit, perUnit, digits] = pick(next, [['MM', 1, 4], ['MM', 1, 1], ['MM-HUNDREDTH', 0.01, 2], ['INCH', 25.4, 6]]);
  const inches = Number(pick(next, Object.keys(sizes).filter((n) => !(way.unit === 'INCH' && way.outside && ['3', '16', '30'].includes(n)) && !(way === conventions[2] && n === '0.125'))));
  const [, outer, nps] = sizes[inches];
  const wall = Math.round(outer * between(next, 0.04, 0.12) * 100) / 100;
  const lines = [pick(next, ['ISOGEN-FILES ISOGEN.FLS', 'PIPELINE-REFERENCE A']), `UNITS-BORE ${way.unit}`, `UNITS-CO-ORDS ${unit}`];
  const bore = (n = inches) => String(Number(way.of(n).toFixed(5)));
  // Returns the point that a file's digits can express, in mm.
  const rounded = (p) => p.map((v) => Number((v / perUnit).toFixed(digits)) * perUnit);
  const point = (name, p, n) => `    ${name} ${p.map((v) => (v / perUnit).toFixed(digits)).join(' ')} ${bore(n)}${pick(next, ['', ' BW', 'BW'])}`;
  const members = [], planes = [], free = [], branches = [], listed = [];
  let count = 0;
  const pipe = (a, b, {n = inches, od = outer, w = wall, taps = []} = {}) => {
    const told = pick(next, [`${w} MM`, `${w}MM`, `${(w / 25.4).toFixed(9)} INCH`]);
    lines.push('PIPE', point('END-POINT', a, n), point('END-POINT', b, n), `    WALL-THICKNESS ${told}`);
    for (const at of taps) {
      lines.push('    TAP-CONNECTION', `    CO-ORDS ${at.map((v) => (v / perUnit).toFixed(digits)).join(' ')} ${bore()}`);
    }
    members.push({id: `pipe ${++count}`, ends: [rounded(a), rounded(b)], outer: od, wall: w});
    return `pipe ${count}`;
  };
  const away = rounded([0, 1, 2].map(() => between(next, -3e4, 3e4)));
  let [at, d] = [away, pick(next, [[1, 0, 0], [0, 1, 0], [0, 0, -1], [0.6, 0.8, 0]])];
  const long = () => Math.ceil(outer * between(next, 8, 20));
  let last = null;
  const side = (dir) => (Math.abs(dir[2]) > 0.5 ? [1, 0, 0] : [0, 0, 1]);
  for (let i = 0; i < 3 + (seed % 4); ++i) {
    const end = plus(at, d, long());
    const here = pipe(at, end);
    if (last === null) free.push([here, 'start']);
    else planes.push({member: here, end: 'start', at: rounded(at)});
    if (i === 2 + (seed % 4)) { free.push([here, 'finish']); break; }
    planes.push({member: here, end: 'finish', at: rounded(end)});
    const kind = pick(next, fittings);
    const body = Math.ceil(outer * 2);
    if (kind === 'ELBOW') {
      const turn = side(d);
      const corner = plus(end, d, body);
      const out = plus(corner, turn, body);
      lines.push(pick(next, ['ELBOW', 'BEND']), point('END-POINT', end), point('END-POINT', out), point('CENTRE-POINT', corner));
      [at, d] = [out, turn];
    } else {
      const out = plus(end, d, body);
      const more = [];
      const arms = kind === 'TEE' ? 1 : kind === 'CROSS' ? 2 : 0;
      for (let arm = 0; arm < arms; ++arm) {
        const from = plus(plus(end, d, body / 2), side(d), (arm === 0 ? 1 : -1) * body / 2);
        more.push({from, to: plus(from, side(d), (arm === 0 ? 1 : -1) * long())});
      }
      lines.push(kind, point('END-POINT', end), point('END-POINT', out), ...(arms ? [point('CENTRE-POINT', plus(end, d, body / 2))] : []),
        ...more.map(({from}, arm) => point(`BRANCH${arm + 1}-POINT`, from)), '    SKEY XXBW');
      for (const {from, to} of more) {
        const arm = pipe(from, to);
        planes.push({member: arm, end: 'start', at: rounded(from)});
        free.push([arm, 'finish']);
      }
      at = out;
    }
    last = here;
  }
  // A header with taps and olets, far from the rest.
  const [n, od, w] = [2, 60.3, 3.9];
  if (inches >= 4) {
    const from = plus(away, [0, 0, 1], 5e4);
    const [radius, run] = [outer / 2, outer * 8];
    const surface = (k, lift) => [from[0] + run * k, from[1], from[2] + radius + lift];
    const kinds = [0.2, 0.4, 0.6, 0.8].map((k) => ({k, kind: pick(next, ['tap with a pipe', 'tap alone', 'olet on the surface', 'olet with a body', 'set-on tee', 'tap on the axis'])}));
    const taps = kinds.filter(({kind}) => /^tap/.test(kind)).map(({k, kind}) => (kind === 'tap on the axis' ? [from[0] + run * k, from[1], from[2]] : surface(k, 0.05)));
    const header = pipe(from, plus(from, [1, 0, 0], run), {taps});
    free.push([header, 'start'], [header, 'finish']);
    for (const {k, kind} of kinds) {
      const foot = [from[0] + run * k, from[1], from[2]];
      const out = kind === 'tap on the axis' ? foot : surface(k, kind === 'olet with a body' ? 40 : 0.05);
      if (kind === 'tap alone') { listed.push('TAP-CONNECTION'); continue; }
      const type = kind === 'set-on tee' ? pick(next, ['TEE-SET-ON', 'TEE-STUB']) : 'OLET';
      if (!/^tap/.test(kind)) lines.push(type, point('CENTRE-POINT', foot), point('BRANCH1-POINT', out, n));
      const arm = pipe(out, plus(out, [0, 0, 1], 500), {n, od, w});
      if (kind === 'olet with a body') {
        listed.push('OLET');
        planes.push({member: arm, end: 'start', at: rounded(out)});
      } else branches.push([arm, header]);
      free.push([arm, 'finish']);
    }
  }
  const used = inches >= 4 && members.some(({outer: each}) => each === od) && inches !== n ? [inches, n] : [inches];
  const map = way.mapped ? Object.fromEntries(used.map((each) => [bore(each), way.outside && next() < 0.5 ? String(sizes[each][1]) : `NPS ${sizes[each][2]}`])) : undefined;
  return {seed, text: `${lines.join(pick(next, ['\n', '\r\n']))}\n`, members, planes, branches, listed, map, used: used.map((each) => [Number(bore(each)), `NPS ${sizes[each][2]}`]), nps};
}
