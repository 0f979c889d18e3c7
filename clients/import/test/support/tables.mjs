// Tables of members drawn at random, as programs and people write them, each with its expected
// result.
import {between, pick, random} from './random.mjs';

const mm = {mm: 1, cm: 10, m: 1000, in: 25.4, ft: 304.8};
const axes = ['x', 'y', 'z'];
const namings = [
  (end, axis) => `${end}_${axis}`,
  (end, axis) => `${axis.toUpperCase()}${end === 'start' ? 1 : 2}`,
  (end, axis) => `${end === 'start' ? 'Start' : 'End'} ${axis.toUpperCase()}`,
  (end, axis) => `${axis}_${end === 'start' ? 'i' : 'j'}`,
  (end, axis) => `${end === 'start' ? 'from' : 'to'} ${axis}`,
];
const nodeNamings = [['node_a', 'node_b'], ['Node 1', 'Node 2'], ['start node', 'end node'], ['i', 'j'], ['JointI', 'JointJ'], ['From', 'To'], ['N1', 'N2']];
const withUnit = [(h, u) => `${h}_${u}`, (h, u) => `${h} [${u}]`, (h, u) => `${h} (${u})`, (h, u) => `${h} in ${u}`];

export function table(seed) {
  const next = random(seed + 5000);
  const unit = pick(next, Object.keys(mm));
  const thin = pick(next, ['mm', 'in', 'm', unit]); // of diameters and walls
  const stated = next() < 0.6; // units are in the headings
  const own = stated ? thin : unit;
  const comma = next() < 0.4;
  const mark = comma ? pick(next, [';', '\t', '|']) : pick(next, [',', ';', '\t', '|', ' ']);
  const byNodes = seed % 2 === 0;
  const style = pick(next, withUnit);
  const head = (name, u) => (stated ? style(name, u) : name);
  const number = (value) => {
    const text = String(Number(value.toFixed(7)));
    return comma ? text.replace('.', ',') : text;
  };
  // A number that shows its mark, so that the table leaves nothing open.
  const rounded = (value, per) => Number((value / per).toFixed(4)) + 0.00005 * (Math.floor(next() * 9) + 1);
  const points = Array.from({length: 6 + Math.floor(6 * next())}, () => axes.map(() => rounded(between(next, -9000, 9000), mm[unit])));
  const nodeName = pick(next, [(i) => String(i + 1), (i) => String((i + 1) * 10), (i) => `N${i + 1}`]);
  const sized = pick(next, ['od', 'radius', 'size', 'listed']);
  const members = [], rows = [];
  for (let i = 0; i + 1 < points.length; ++i) {
    const [outer, wall] = [rounded(between(next, 30, 300), mm[own]), rounded(between(next, 2, 9), mm[own])];
    const [a, b] = [points[i], points[i + 1]];
    const id = pick(next, [`M${i}`, `brace ${i}`.replace(' ', mark === ' ' ? '_' : ' '), `T-${i}`]);
    const millimetres = [Number((outer * mm[own]).toFixed(3)), Number((wall * mm[own]).toFixed(3))];
    const said = {
      od: {od: number(outer), wall: number(wall)}, radius: {radius: number(outer / 2), wall: number(wall)},
      size: {size: millimetres.map(number).join('x')}, listed: {size: mark === ' ' ? '60.3x3.2'.replace('.', comma ? ',' : '.').replace('.2', comma ? ',2' : '.2') : pick(next, ['NPS 2 SCH 40', 'chs 60.3x3.2', 'CHS 60.3x3.2'])},
    }[sized];
    rows.push({id, a: nodeName(i), b: nodeName(i + 1), start: a.map(number), end: b.map(number), ...said});
    const size = sized === 'listed' ? (/^nps/i.test(said.size) ? {size: 'NPS 2 SCH 40'} : mark === ' ' ? {outer_diameter_mm: 60.3, wall_mm: 3.2} : {size: 'CHS 60.3x3.2'})
      : sized === 'size' ? {outer_diameter_mm: millimetres[0], wall_mm: millimetres[1]} : {outer_diameter_mm: outer * mm[own], wall_mm: wall * mm[own]};
    members.push({id, ends: [a, b].map((p) => p.map((v) => v * mm[unit])), size});
  }
  const name = pick(next, namings);
  const joined = (cells) => (mark === '|' ? `| ${cells.join(' | ')} |` : cells.map((cell) => (mark === ',' && cell.includes(',') ? `"${cell}"` : cell)).join(mark === ' ' ? '   ' : mark));
  const columns = [
    ...(byNodes ? pick(next, nodeNamings).map((heading, i) => ({heading, of: (row) => (i === 0 ? row.a : row.b)}))
      : ['start', 'end'].flatMap((end) => axes.map((axis, i) => ({heading: head(name(end, axis), unit), of: (row) => row[end][i], field: `${end}_${axis}`})))),
    ...{
      od: [{heading: head(pick(next, ['OD', 'outer_diameter', 'Diameter', 'D']), own), of: ({od}) => od, field: 'outer_diameter'}, {heading: head(pick(next, ['wall', 't', 'Thickness']), own), of: ({wall}) => wall, field: 'wall'}],
      radius: [{heading: head(pick(next, ['radius', 'R']), own), of: ({radius}) => radius, field: 'outer_diameter'}, {heading: head('wall', own), of: ({wall}) => wall, field: 'wall'}],
      size: [{heading: pick(next, ['size', 'Section', 'profile']), of: ({size}) => size}],
      listed: [{heading: pick(next, ['size', 'Section', 'profile']), of: ({size}) => size}],
    }[sized],
  ];
  const all = [{heading: pick(next, ['id', 'Name', 'member', 'Mark']), of: ({id}) => id}, ...columns.sort(() => next() - 0.5)];
  const rule = mark === '|' ? [`|${all.map(() => '---').join('|')}|`] : [];
  // Words of one space only: a table with spaces as marks has no space in a heading.
  const spaced = (cell) => (mark === ' ' ? cell.replace(/ /g, '_') : cell);
  const member = (list = all) => [joined(list.map(({heading}) => spaced(heading))), ...rule, ...rows.map((row) => joined(list.map(({of}) => of(row))))];
  const nodes = [
    joined([pick(next, ['node', 'Node', 'Joint']), ...axes.map((axis) => spaced(head(axis.toUpperCase(), unit)))]),
    ...points.map((p, i) => joined([nodeName(i), ...p.map(number)])),
  ];
  const title = next() < 0.3 && mark !== ' ' && mark !== '|' ? ['Members of the frame'] : [];
  const placed = byNodes ? pick(next, ['before', 'after', 'apart']) : 'none';
  const end = pick(next, ['\n', '\r\n']);
  const text = [...title, ...(placed === 'before' ? [...nodes, ''] : []), ...member(), ...(placed === 'after' ? ['', ...nodes] : [])].join(end);
  return {
    seed, text, members, byNodes, nodes: placed === 'apart' ? nodes.join(end) : undefined, unit: stated ? undefined : unit, columns: all,
    without: (heading) => [...title, ...(placed === 'before' ? [...nodes, ''] : []), ...member(all.filter((each) => each.heading !== heading)), ...(placed === 'after' ? ['', ...nodes] : [])].join(end),
  };
}
