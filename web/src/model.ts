import type {Imported, ImportedPart, LengthUnit, Size} from './importer';

export type Importer = typeof import('./importer');
/** Values that a file lacks, by the name of their control. */
export type Answers = Record<string, string>;
export interface Question {
  key: string;
  text: string;
  choices?: [value: string, name: string][];
  value?: string;
  hint?: string;
  /** Yes or nothing. */
  check?: boolean;
  /** More lines than one. */
  lines?: boolean;
}
export interface Kind {
  questions(importer: Importer, text: string, schedules: string[]): Question[];
  read(importer: Importer, file: Uint8Array, answers: Answers): Imported | ImportedPart | Promise<Imported>;
}

export const text = (file: Uint8Array): string => new TextDecoder().decode(file);
const named = (list: readonly string[]): [string, string][] => list.map((each) => [each, each]);
const unitAnswer = (answers: Answers): {unit?: LengthUnit} => (answers['unit'] ? {unit: answers['unit'] as LengthUnit} : {});

const merge: Question = {key: 'merge', text: 'Members that go on in line are one piece', check: true};
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
const corner: Question = {key: 'corner', text: 'Corners of square tubes that it does not state', hint: `${standards.join(', ')} or the radius, mm`};
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
    text: `Size of bore ${key}, of ${count} ${count === 1 ? 'component' : 'components'}`,
    hint: likely.length > 0 ? `${likely.join(' or ')}?` : 'NPS 6, DN 150 or 168.3',
  }));
}

function boresOf(answers: Answers): {bores?: Record<string, string>} {
  const said = Object.entries(answers).filter(([key, value]) => key.startsWith('bore ') && value.trim());
  return said.length > 0 ? {bores: Object.fromEntries(said.map(([key, value]) => [key.slice('bore '.length), value]))} : {};
}

function tableQuestions(importer: Importer, file: string): Question[] {
  const {headings, columns, nodes} = importer.columnsOf(file);
  const choices: [string, string][] = [['', '–'], ...named(headings.map((each) => each.trim()).filter(Boolean))];
  const open = importer.fromCsv(file).asks.map(({option}) => option);
  const marks: Question = {
    key: 'decimal',
    text: 'Mark of decimals',
    choices: [
      ['', 'not certain'],
      ['.', 'point'],
      [',', 'comma'],
    ],
  };
  return [
    {key: 'unit', text: 'Lengths in', choices: [['', 'as the table states, else mm'], ...named(Object.keys(importer.lengths))], value: ''},
    ...(open.includes('decimal') ? [marks] : []),
    ...importer.fields.map((field) => ({key: field, text: `Column of ${field.replace(/_/g, ' ')}`, choices, value: columns[field]?.trim() ?? ''})),
    {key: 'all', text: 'Size of the other rows'},
    corner,
    ...(nodes ? [] : [{key: 'nodes', text: 'Table of nodes: node, x, y, z', lines: true, hint: 'node, x, y, z'}]),
    merge,
  ];
}

export const kinds: Record<string, Kind> = {
  ifc: {
    questions: () => [{key: 'origin', text: 'Its point that is the origin here, mm', hint: '0, 0, 0'}, corner, merge],
    read: (importer, file, answers) => {
      const {origin} = answers;
      const more = {...(origin?.trim() ? {origin_mm: pointOf(origin)} : {}), ...cornersOf(answers)};
      return importer.fromIfc(file, {wasm: importer.wasm, ...more, ...merged(answers)});
    },
  },
  pcf: {
    questions: (importer, file, schedules) => [
      {key: 'schedule', text: 'Schedule of pipes without a wall in the file', choices: [['', 'none'], ...named(schedules)]},
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
      const columns = Object.fromEntries(importer.fields.flatMap((field) => (answers[field] ? [[field, answers[field]]] : [])));
      const {nodes, decimal} = answers;
      const size = sizeOf(answers['all']);
      const more = {...(size ? {size} : {}), ...(nodes?.trim() ? {nodes} : {}), ...(decimal ? {decimal: decimal as '.' | ','} : {})};
      return importer.fromCsv(text(file), {columns, ...unitAnswer(answers), ...cornersOf(answers), ...more, ...merged(answers)});
    },
  },
  dxf: {
    questions: (importer, file) => [
      {key: 'unit', text: 'Drawn in', choices: [['', 'as it says'], ...named(Object.keys(importer.lengths))], value: ''},
      ...importer.layersOf(file).map((layer) => ({key: `layer ${layer}`, text: `Size of ${layer}`})),
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
