import {clean, exact, type Ask, names, type NotUnderstood} from '../frame.js';
import {limits} from '../limits.js';
import {type CornerOptions, cornersStated, cornersToState, type Section, standards, uncut} from '../sections.js';
import {endOfPart, type Reading} from './ends.js';
import {type Openings, openings, texts} from './openings.js';
import type {Frame} from './outlines.js';
import type {ImportedPart, Part} from './part.js';
import {type Stated, statedBy} from './stated.js';
import {headerNumber, type HeaderField, type Nc1, parsed, textOf, Trouble} from './text.js';

export interface Nc1Options extends CornerOptions {
  /** Fields of the request instead of ours: `kerf_mm`, `accept`, ... */
  fields?: Record<string, unknown>;
}

/** A rectangular tube whose corners the file does not state so that they can be cut. */
class Cornerless extends Trouble {}

const near = 1e-3; // mm: of two numbers of the header that must be the same
const tubes = 'this reader takes RO (round tube) and M (rectangular tube)';

function wallOf(file: Nc1): number {
  const [flange, web] = [headerNumber(file, 'flange'), headerNumber(file, 'web')];
  if (flange > 0 && web > 0 && Math.abs(flange - web) > near)
    throw new Trouble(`its walls are ${flange} mm and ${web} mm thick, and a tube has one wall thickness: state both alike`);
  const wall = web > 0 ? web : flange;
  if (!(wall > 0)) throw new Trouble('it states no wall thickness: without it the tube is not known');
  return wall;
}

interface Tube {
  target: Part['target'];
  frame: Omit<Frame, 'kind'>;
  area: number; // mm2, of the section
}

function roundTube(file: Nc1): Tube {
  const [height, width, wall] = [headerNumber(file, 'height'), headerNumber(file, 'width'), wallOf(file)];
  if (!(height > 0)) throw new Trouble('it states no diameter as its height');
  if (width > 0 && Math.abs(width - height) > 0.01) throw new Trouble(`its height of ${height} mm and its width of ${width} mm are not one diameter`);
  if (!(2 * wall < height)) throw new Trouble(`a wall of ${wall} mm is not less than half of the diameter of ${height} mm`);
  return {
    target: {outer_diameter_mm: height, wall_mm: wall, length_mm: 0},
    frame: {round: true, height, width: height, wall, girth: Math.PI * height},
    area: Math.PI * wall * (height - wall),
  };
}

/** The corners of the file if they can be cut; else those of the options. */
function cornersOf(file: Nc1, sides: {height_mm: number; width_mm: number; wall_mm: number}, stated: Stated, options: CornerOptions): Section {
  const radius = headerNumber(file, 'radius');
  const own = stated.corners && Math.abs(stated.corners.outside - radius) <= near ? stated.corners : undefined;
  const corner_radius_mm = own?.outside ?? radius;
  const least = Math.min(sides.height_mm, sides.width_mm);
  if (stated.ours && Math.abs(2 * corner_radius_mm - least) <= near && sides.height_mm !== sides.width_mm) return {kind: 'flat_oval_tube', ...sides};
  const concentric = !own || Math.abs(own.outside - sides.wall_mm - own.inside) <= 1e-9;
  const radii = {corner_radius_mm, ...(concentric ? {} : {inner_corner_radius_mm: own.inside})};
  const why = corner_radius_mm > 0 ? uncut(sides, radii) : 'it states no corner radius';
  if (why === undefined) return {kind: 'rectangular_tube', ...sides, ...radii};
  const given = cornersStated(options);
  if (!given) throw new Cornerless(`${why}: state --corner, ${cornersToState}`);
  const still = uncut(sides, given);
  if (still !== undefined) throw new Trouble(still);
  return {kind: 'rectangular_tube', ...sides, ...given};
}

function rectangularTube(file: Nc1, stated: Stated, options: CornerOptions): Tube {
  const sides = {height_mm: headerNumber(file, 'height'), width_mm: headerNumber(file, 'width'), wall_mm: wallOf(file)};
  const {height_mm: height, width_mm: width, wall_mm: wall} = sides;
  if (!(height > 0 && width > 0)) throw new Trouble('it states no height and width of a rectangular tube');
  if (!(2 * wall < Math.min(height, width))) throw new Trouble(`a wall of ${wall} mm is not less than half of the side of ${Math.min(height, width)} mm`);
  const section = cornersOf(file, sides, stated, options);
  const outer = section.kind === 'flat_oval_tube' ? Math.min(height, width) / 2 : 'corner_radius_mm' in section ? section.corner_radius_mm : 2 * wall;
  const inner = 'inner_corner_radius_mm' in section ? (section.inner_corner_radius_mm ?? 0) : Math.max(0, outer - wall);
  const area = 2 * wall * (height + width) - 4 * wall * wall - (4 - Math.PI) * (outer * outer - inner * inner);
  return {target: {...section, length_mm: 0}, frame: {round: false, height, width, wall, girth: 2 * (height + width) - (8 - 2 * Math.PI) * outer}, area};
}

/** Returns the tube of a file, and refuses other profiles. */
function tubeOf(file: Nc1, stated: Stated, options: CornerOptions): Tube {
  const code = (file.header.get('code') ?? '').toUpperCase();
  if (code === 'RO') return roundTube(file);
  if (code === 'M') return rectangularTube(file, stated, options);
  const name = clean((file.header.get('profile') ?? '').slice(0, 40));
  throw new Trouble(
    `its profile code ${clean(code.slice(0, 10)) || 'is empty'}${name ? ` (${name})` : ''} is not a tube: ${tubes}; write the file with one of these codes if it is a tube`,
  );
}

/** A developed round tube is as high as its girth, one that is drawn face by face as its diameter. */
function kindOf(file: Nc1, {frame}: Tube): Frame['kind'] {
  if (!frame.round) return 'faces';
  const ys = file.blocks.filter(({code}) => code === 'AK').flatMap(({rows}) => rows.map(({values}) => values[1]?.value ?? 0));
  const high = ys.reduce((most, y) => Math.max(most, y), -Infinity) - ys.reduce((least, y) => Math.min(least, y), Infinity);
  const is = (size: number): boolean => Math.abs(high - size) <= 0.005 * size;
  if (is(frame.girth)) return 'developed';
  if (is(frame.height)) return 'faces';
  const found = ys.length === 0 ? 'it has no AK' : `its outline is ${exact(Number(high.toPrecision(6)))} mm high`;
  throw new Trouble(
    `${found}, so it is not known whether y is measured round the tube: an AK of a round tube is ${frame.height} mm (face by face) or ${frame.girth.toFixed(2)} mm high (developed)`,
  );
}

const words: Partial<Record<string, string>> = {
  KO: 'contours to be marked',
  PU: 'punch marks',
  KA: 'bends',
  SC: 'saw cuts',
  TO: 'tolerances',
  UE: 'camber',
  PR: 'sections of the profile',
};

/** Lists the blocks of other kinds with their counts. */
function others(file: Nc1, tell: (id: string, type: string, reason: string) => void): void {
  const counts = new Map<string, {count: number; line: number}>();
  for (const {code, line} of file.blocks) {
    if (['AK', 'IK', 'BO', 'SI'].includes(code)) continue;
    counts.set(code, {count: (counts.get(code)?.count ?? 0) + 1, line: counts.get(code)?.line ?? line});
  }
  for (const [code, {count, line}] of counts)
    tell(`line ${line}`, code, `${count} ${count === 1 ? 'block' : 'blocks'}${words[code] ? ` (${words[code]})` : ''} ${count === 1 ? 'is' : 'are'} not read`);
}

const given = (text: string | undefined): string | undefined => {
  const shown = clean((text ?? '').slice(0, 200))
    .trim()
    .slice(0, 64)
    .trim();
  return shown === '' || /^-+$/.test(shown) ? undefined : shown;
};

/**
 * Marks of our own files, which are comments for a person: the name of the target, in the middle of the datum line, and the number of
 * partners, whose exact places the comments do not have.
 */
function marksOf(file: Nc1): {name?: string; partners: number} {
  const line = file.comments.map((each) => /^mark "0" on the middle of face 1, x (\S+) to (\S+)$/.exec(each)).find(Boolean);
  const middle = (Number(line?.[1]) + Number(line?.[2])) / 2;
  let [name, partners]: [string | undefined, number] = [undefined, 0];
  for (const each of file.comments) {
    const round = /^mark by hand: (the name|partner) (.*) at phi /.exec(each);
    const face = /^mark "(.*)" on the middle of face 1, x (\S+)$/.exec(each);
    const isName = round ? round[1] === 'the name' : face && Math.abs(Number(face[2]) - middle) <= 2 * near;
    if (isName && name === undefined) name = (round?.[2] ?? face?.[1]) as string;
    else if (round || face) partners += 1;
  }
  return {...(name === undefined ? {} : {name}), partners};
}

/** Order, drawing, grade and quantity; the piece names the target, of our files the part that the reference had. */
function referenceOf(file: Nc1, stated: Stated): {id?: string; reference?: Record<string, string | number>} {
  const reference: Record<string, string | number> = {};
  const of = (field: HeaderField): string | undefined => given(file.header.get(field));
  for (const [field, name] of [
    ['order', 'order'],
    ['drawing', 'drawing'],
    ['grade', 'material'],
  ] as const) {
    const text = of(field);
    if (text !== undefined) reference[name] = text;
  }
  const said = stated.ours ? Object.fromEntries(file.comments.map((each) => /^(part|revision|heat|customer): (.*)$/.exec(each)?.slice(1) ?? [])) : {};
  for (const [name, field] of [
    ['part', 'part'],
    ['revision', 'revision'],
    ['heat', 'heat'],
    ['customer', 'customer_id'],
  ] as const) {
    const text = given(said[name]);
    if (text !== undefined) reference[field] = text;
  }
  const quantity = Number(of('quantity') ?? 1);
  const askedFor = !stated.ours || file.comments.some((each) => each.startsWith('quantity: '));
  if (Number.isInteger(quantity) && quantity > 0 && quantity <= 99999 && askedFor && of('quantity') !== undefined) reference['quantity'] = quantity;
  const piece = of('piece');
  const name = stated.ours ? given(marksOf(file).name) : undefined;
  const id = name !== undefined ? {id: name} : piece !== undefined && reference['part'] !== piece ? {id: piece} : {};
  return {...id, ...(Object.keys(reference).length > 0 ? {reference} : {})};
}

/** Fields of the header that a request does not have, if they state something. */
function unused(file: Nc1, tell: (id: string, type: string, reason: string) => void, ours: boolean): void {
  const phase = given(file.header.get('phase'));
  if (!ours && phase !== undefined && phase !== '1' && phase !== '0') tell('header', 'phase', `${phase}: a request has no field for it`);
  const quantity = given(file.header.get('quantity'));
  if (quantity !== undefined && !/^[1-9]\d{0,4}$/.test(quantity)) tell('header', 'quantity', `${quantity} is not a whole number from 1 to 99999`);
  for (const text of file.texts) tell('header', 'text', `${clean(text.slice(0, 100))}: a request has no field for it`);
}

/** kg/m3 by the weight of a metre; undefined for steel, or if the header has no weight. */
function densityOf(file: Nc1, {area}: Tube, ours: boolean, tell: (id: string, type: string, reason: string) => void): number | undefined {
  const text = file.header.get('weight') ?? '';
  const weight = /^[\d.]+$/.test(text) ? Number(text) : 0;
  if (!(weight > 0)) return undefined;
  const density = (weight / area) * 1e6;
  const rounding = ours ? (0.001 / weight) * 7850 : 0.06 * 7850; // tables of others take corners and tolerances as they like
  if (Math.abs(density - 7850) <= rounding) return undefined;
  if (!(density >= 100 && density <= 25000)) {
    tell('header', 'weight', `${weight} kg/m is ${Math.round(density)} kg/m3, which no metal has: steel is assumed`);
    return undefined;
  }
  if (!ours) tell('header', 'weight', `assumed: a density of ${Number(density.toPrecision(3))} kg/m3 by its ${weight} kg/m`);
  // The roundest number that the header's three decimals mean.
  const digits = [2, 3, 4, 5, 6].find((each) => Math.abs(Number(density.toPrecision(each)) - density) <= (0.0006 / weight) * density);
  return Number(density.toPrecision(ours ? (digits ?? 6) : 3));
}

function read(file: Nc1, stated: Stated, tube: Tube, tell: (id: string, type: string, reason: string) => void): {part: Part; sources: ImportedPart['sources']} {
  const frame: Frame = {...tube.frame, kind: kindOf(file, tube)};
  const at = (line: number, type: string, reason: string): void => tell(`line ${line}`, type, reason);
  const reading: Reading = {file, frame, stated, tell};
  const [start, finish] = [endOfPart(reading, 'start'), endOfPart(reading, 'finish')];
  const [from, to] = stated.work && stated.start && stated.finish ? stated.work : [start.x, finish.x];
  if (!(to - from > 0)) throw new Trouble(`its ends lie ${exact(Number((to - from).toPrecision(6)))} mm apart, which must be more than 0`);
  const into: Openings = {
    frame,
    ours: stated.ours,
    start: from,
    name: names(),
    tell: at,
    cutouts: [],
    from: [],
    marks: [],
    texts: [],
    over: 0,
    slots: {line: 0, count: 0, turned: false},
  };
  // The near side of a cut-out through both walls comes before its far side.
  const isFar = ({comments}: Nc1['blocks'][0]): boolean => stated.ours && comments.some((each) => / far, /.test(each));
  const blocks = [...file.blocks.filter((each) => !isFar(each)), ...file.blocks.filter(isFar)];
  for (const block of blocks) {
    if (block.code === 'BO' || block.code === 'IK') openings(into, block);
    if (block.code === 'SI') texts(into, block);
  }
  const {slots, over} = into;
  if (over > 0) tell('file', 'NC1', `${over} more cut-outs are not in the part, because it has at most ${limits.cutouts}: split it`);
  if (slots.count > 0) {
    const sense = slots.turned ? ', and its angle grows from x to y' : '';
    at(slots.line, 'BO', `assumed: x and y of a slot are its middle${sense}; of ${slots.count} ${slots.count === 1 ? 'slot' : 'slots'}`);
  }
  others(file, tell);
  const {id, reference} = referenceOf(file, stated);
  const kerf_mm = into.kerf ?? start.kerf ?? 0;
  const density = densityOf(file, tube, stated.ours, tell);
  const part: Part = {
    target: {...(id === undefined ? {} : {id}), ...tube.target, length_mm: exact(to - from)},
    ends: {start: start.request(from, kerf_mm), finish: finish.request(to, kerf_mm)},
    ...(into.cutouts.length > 0 ? {cutouts: into.cutouts} : {}),
    ...(into.texts.length > 0 ? {texts: into.texts} : {}),
    ...(into.marks.length > 0 ? {marks: into.marks} : {}),
    kerf_mm,
    ...(density === undefined ? {} : {density_kg_m3: density}),
    ...(reference ? {reference} : {}),
  };
  return {part, sources: into.from.map(({id: name, line, type}) => ({id: name, entity: `line ${line}`, type}))};
}

/** Returns the request of POST /v1/parts of a tube's NC1 (DSTV) file, and the list of the items that are not in it. */
export function fromNc1(source: Uint8Array | string, options: Nc1Options = {}): ImportedPart {
  const notUnderstood: NotUnderstood[] = [];
  const asks: Ask[] = [];
  let unlisted = 0;
  const tell = (id: string, type: string, reason: string): void => {
    if (notUnderstood.length < limits.listed) notUnderstood.push({id, type, reason});
    else unlisted += 1;
  };
  let [part, sources]: [Part | null, ImportedPart['sources']] = [null, []];
  try {
    const file = parsed(textOf(source), (line, type, reason) => tell(`line ${line}`, type, reason));
    const stated = statedBy(file.comments);
    const found = read(file, stated, tubeOf(file, stated, options), tell);
    unused(file, tell, stated.ours);
    const {partners} = stated.ours ? marksOf(file) : {partners: 0};
    if (partners > 0) tell('comments', 'marks', `${partners} ${partners === 1 ? 'mark of a partner is' : 'marks of partners are'} not read`);
    if (!file.ended) tell('file', 'NC1', 'it has no EN at its end: its last lines may be missing');
    part = {...found.part, ...options.fields};
    sources = found.sources;
  } catch (failure) {
    if (!(failure instanceof Trouble)) throw failure;
    if (failure instanceof Cornerless) asks.push({option: 'corner', count: 1, likely: [...standards], text: failure.message});
    notUnderstood.push({id: 'file', type: 'NC1', reason: failure.message});
  }
  if (unlisted > 0) notUnderstood.push({id: 'file', type: 'list', reason: `${unlisted} more things are not in the part`});
  return {part, notUnderstood, asks, sources};
}
