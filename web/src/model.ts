import type {Imported, ImportedPart, LengthUnit, Size} from './importer';
import {later, type Values} from './texts';

export type Importer = typeof import('./importer');
/** Values that a file lacks, by the name of their control. */
export type Answers = Record<string, string>;
export interface Question {
  key: string;
  /** A key of the page's texts, with its values. */
  text: string;
  of?: Values;
  choices?: [value: string, name: string][];
  value?: string;
  hint?: string;
  /** Yes or nothing. */
  check?: boolean;
  /** More lines than one. */
  lines?: boolean;
  /** A table whose columns are given a field each; its answer has them in the order of the columns, between commas. */
  table?: Preview;
}
export interface Preview {
  headings: string[];
  rows: string[][];
  /** Is a column missing without which no row can be read? */
  open: boolean;
}
export interface Kind {
  /** `answers`: those that change the questions, so that they are asked once more. */
  questions(importer: Importer, text: string, schedules: string[], answers?: Answers): Question[];
  read(importer: Importer, file: Uint8Array, answers: Answers): Imported | ImportedPart | Promise<Imported>;
}

export const text = (file: Uint8Array): string => new TextDecoder().decode(file);
const named = (list: readonly string[]): [string, string][] => list.map((each) => [each, each]);
const unitAnswer = (answers: Answers): {unit?: LengthUnit} => (answers['unit'] ? {unit: answers['unit'] as LengthUnit} : {});

const merge: Question = {key: 'merge', text: later('Members that go on in line are one piece'), check: true};
const merged = ({merge: said}: Answers): {merge_in_line?: true} => (said ? {merge_in_line: true} : {});
const most = 30; // number of bores that are offered one by one

/** "114.3x6.3" in mm, or a name that the service lists. */
function sizeOf(said: string | undefined): Size | undefined {
  const found = /^\s*(\d+(?:\.\d+)?)\s*[x×]\s*(\d+(?:\.\d+)?)\s*$/.exec(said ?? '');
  if (found) return {outer_diameter_mm: Number(found[1]), wall_mm: Number(found[2])};
  return said?.trim() ? {size: said.trim()} : undefined;
}

function positive(said: string): number {
  const value = Number(said);
  if (!(value > 0 && Number.isFinite(value))) throw new Error(`"${said}" is no length.`);
  return value;
}

const standards = ['en_10219', 'en_10210', 'astm_a500'] as const;
const corner: Question = {
  key: 'corner',
  text: later('Corners of square tubes that it does not state'),
  hint: later('en_10219, en_10210, astm_a500 or the radius, mm'),
};
function cornersOf({corner: said}: Answers): {corners?: (typeof standards)[number]; corner_radius_mm?: number} {
  const name = said?.trim();
  if (!name) return {};
  const corners = standards.find((each) => each === name.toLowerCase());
  return corners ? {corners} : {corner_radius_mm: positive(name)};
}

function pointOf(said: string): [number, number, number] {
  const [x, y, z, ...rest] = said
    .split(/[\s,;]+/)
    .filter(Boolean)
    .map(Number);
  if (x === undefined || y === undefined || z === undefined || rest.length > 0 || ![x, y, z].every(Number.isFinite)) throw new Error(`"${said}" is no point.`);
  return [x, y, z];
}

/** Bores that are not certain, with their probable meanings. */
function boreQuestions(importer: Importer, file: string): Question[] {
  const {asks} = importer.fromPcf(file);
  const bores = asks.filter(({option}) => option === 'bore').slice(0, most);
  return bores.map(({key = '', count, likely}) => ({
    key: `bore ${key}`,
    text: count === 1 ? later('Size of bore {key}, of {count} component') : later('Size of bore {key}, of {count} components'),
    of: {key, count},
    hint: likely.length > 0 ? `${likely.join(' / ')}?` : later('NPS 6, DN 150 or 168.3'),
  }));
}

function boresOf(answers: Answers): {bores?: Record<string, string>} {
  const said = Object.entries(answers).filter(([key, value]) => key.startsWith('bore ') && value.trim());
  return said.length > 0 ? {bores: Object.fromEntries(said.map(([key, value]) => [key.slice('bore '.length), value]))} : {};
}

const columnNames: Record<string, string> = {
  id: later('id'),
  start_x: later('start x'),
  start_y: later('start y'),
  start_z: later('start z'),
  end_x: later('end x'),
  end_y: later('end y'),
  end_z: later('end z'),
  node_a: later('node a'),
  node_b: later('node b'),
  outer_diameter: later('outer diameter'),
  inner_corner_radius: later('inner corner radius'),
  corner_radius: later('corner radius'),
  up_x: later('up x'),
  up_y: later('up y'),
  up_z: later('up z'),
  size: later('size'),
  wall: later('wall'),
  priority: later('priority'),
  radius: later('radius'),
  kind: later('kind'),
  height: later('height'),
  width: later('width'),
  corners: later('corners'),
};

/** The fields of a table's columns, as a row of choices. */
export const columnChoices: [string, string][] = [['', '–'], ...Object.entries(columnNames)];
/** Answers whose change asks the questions once more. */
export const asksAgain = ['headings'];

function columnsQuestion(importer: Importer, file: string, headed: boolean | undefined): [headings: boolean, question: Question, nodes: boolean] {
  const {headings, places, rows, nodes} = importer.columnsOf(file, headed === undefined ? {} : {headings: headed});
  const width = [headings, ...rows].reduce((most, {length}) => Math.max(most, length), 0);
  const fields = Array.from({length: width}, () => '');
  for (const [field, at] of Object.entries(places)) fields[at] = field;
  const open = importer.fromCsv(file, headed === undefined ? {} : {headings: headed}).frame === null;
  return [headings.length > 0, {key: 'columns', text: later('Columns'), value: fields.join(), table: {headings, rows, open}}, nodes];
}

function tableQuestions(importer: Importer, file: string, _: string[], answers?: Answers): Question[] {
  const [headings, columns, nodes] = columnsQuestion(importer, file, answers && answers['headings'] !== '');
  return [
    {key: 'unit', text: later('Lengths in'), choices: [['', later('as the table states, else mm')], ...named(Object.keys(importer.lengths))], value: ''},
    {
      key: 'decimal',
      text: later('Mark of decimals'),
      choices: [
        ['', later('as its numbers show')],
        ['.', later('point')],
        [',', later('comma')],
      ],
    },
    {key: 'headings', text: later('A row has the names of the columns'), check: true, value: headings ? 'yes' : ''},
    columns,
    {key: 'all', text: later('Size of the other rows')},
    corner,
    ...(nodes ? [] : [{key: 'nodes', text: later('Table of nodes: node, x, y, z'), lines: true, hint: 'node, x, y, z'}]),
    merge,
  ];
}

/** By index; a field without a column has none, also if a heading looks like it. */
function columnsOf(importer: Importer, said: string): Record<string, number | null> {
  const fields = said.split(',');
  return Object.fromEntries(
    importer.fields.map((field) => {
      const at = fields.indexOf(field);
      return [field, at < 0 ? null : at];
    }),
  );
}

export const kinds: Record<string, Kind> = {
  ifc: {
    questions: () => [{key: 'origin', text: later('Its point that is the origin here, mm'), hint: '0, 0, 0'}, corner, merge],
    read: (importer, file, answers) => {
      const {origin} = answers;
      const more = {...(origin?.trim() ? {origin_mm: pointOf(origin)} : {}), ...cornersOf(answers)};
      return importer.fromIfc(file, {wasm: importer.wasm, ...more, ...merged(answers)});
    },
  },
  pcf: {
    questions: (importer, file, schedules) => [
      {key: 'schedule', text: later('Schedule of pipes without a wall in the file'), choices: [['', later('none')], ...named(schedules)]},
      ...boreQuestions(importer, file),
      merge,
    ],
    read: (importer, file, answers) => {
      const {schedule} = answers;
      return importer.fromPcf(text(file), {...(schedule ? {schedule} : {}), ...boresOf(answers), ...merged(answers)});
    },
  },
  csv: {
    questions: tableQuestions,
    read: (importer, file, answers) => {
      const columns = columnsOf(importer, answers['columns'] ?? '');
      const headings = answers['headings'] !== '';
      const {nodes, decimal} = answers;
      const size = sizeOf(answers['all']);
      const more = {...(size ? {size} : {}), ...(nodes?.trim() ? {nodes} : {}), ...(decimal ? {decimal: decimal as '.' | ','} : {})};
      return importer.fromCsv(text(file), {columns, headings, ...unitAnswer(answers), ...cornersOf(answers), ...more, ...merged(answers)});
    },
  },
  dxf: {
    questions: (importer, file) => [
      {key: 'unit', text: later('Drawn in'), choices: [['', later('as it says')], ...named(Object.keys(importer.lengths))], value: ''},
      ...importer.layersOf(file).map((layer) => ({key: `layer ${layer}`, text: later('Size of {layer}'), of: {layer}})),
      corner,
      merge,
    ],
    read: (importer, file, answers) => {
      const layers = Object.entries(answers).flatMap(([key, said]) => {
        const size = key.startsWith('layer ') && sizeOf(said);
        return size ? [[key.slice('layer '.length), size]] : [];
      });
      return importer.fromDxf(text(file), Object.fromEntries(layers), {...unitAnswer(answers), ...cornersOf(answers), ...merged(answers)});
    },
  },
};
// A table may have other names.
kinds['tsv'] = kinds['csv'] as Kind;
kinds['txt'] = kinds['csv'] as Kind;
// One tube, which becomes a part.
const nc1: Kind = {
  questions: () => [corner],
  read: (importer, file, answers) => importer.fromNc1(file, cornersOf(answers)),
};
kinds['nc1'] = nc1;
kinds['nc'] = nc1;
kinds['dstv'] = nc1;
export const endings = Object.keys(kinds).map((each) => `.${each}`);
