import type {Imported, LengthUnit, Size} from './importer';

export type Importer = typeof import('./importer');
/** What a file does not tell, by the name of its control. */
export type Answers = Record<string, string>;
export interface Question {
  key: string;
  text: string;
  choices?: [value: string, name: string][];
  value?: string;
  hint?: string;
}
export interface Kind {
  questions(importer: Importer, text: string, schedules: string[]): Question[];
  read(importer: Importer, file: Uint8Array, answers: Answers): Imported | Promise<Imported>;
}

export const text = (file: Uint8Array): string => new TextDecoder().decode(file);
const named = (list: readonly string[]): [string, string][] => list.map((each) => [each, each]);
const unitAnswer = (answers: Answers): {unit?: LengthUnit} => (answers['unit'] ? {unit: answers['unit'] as LengthUnit} : {});

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

function pointOf(said: string): [number, number, number] {
  const [x, y, z, ...rest] = said
    .split(/[\s,;]+/)
    .filter(Boolean)
    .map(Number);
  if (x === undefined || y === undefined || z === undefined || rest.length > 0 || ![x, y, z].every(Number.isFinite)) throw new Error(`"${said}" is no point.`);
  return [x, y, z];
}

export const kinds: Record<string, Kind> = {
  ifc: {
    questions: () => [
      {key: 'origin', text: 'Its point that is the origin here, mm', hint: '0, 0, 0'},
      {key: 'corner', text: 'Radius of square tubes’ sharp corners, mm', hint: 'none'},
    ],
    read: (importer, file, {origin, corner}) => {
      const more = {...(origin?.trim() ? {origin_mm: pointOf(origin)} : {}), ...(corner?.trim() ? {corner_radius_mm: positive(corner)} : {})};
      return importer.fromIfc(file, {wasm: importer.wasm, ...more});
    },
  },
  pcf: {
    questions: (_, __, schedules) => [
      {key: 'schedule', text: 'Schedule of pipes whose wall the file does not tell', choices: [['', 'none'], ...named(schedules)]},
    ],
    read: (importer, file, {schedule}) => importer.fromPcf(text(file), schedule ? {schedule} : {}),
  },
  csv: {
    questions: (importer, file) => {
      const {headings, columns} = importer.columnsOf(file);
      const choices: [string, string][] = [['', '–'], ...named(headings.map((each) => each.trim()).filter(Boolean))];
      return [
        {key: 'unit', text: 'Lengths in', choices: named(Object.keys(importer.lengths)), value: 'mm'},
        ...importer.fields.map((field) => ({key: field, text: `Column of ${field.replace(/_/g, ' ')}`, choices, value: columns[field]?.trim() ?? ''})),
        {key: 'all', text: 'Size of the other rows'},
      ];
    },
    read: (importer, file, answers) => {
      const columns = Object.fromEntries(importer.fields.flatMap((field) => (answers[field] ? [[field, answers[field]]] : [])));
      const size = sizeOf(answers['all']);
      return importer.fromCsv(text(file), {columns, ...unitAnswer(answers), ...(size ? {size} : {})});
    },
  },
  dxf: {
    questions: (importer, file) => [
      {key: 'unit', text: 'Drawn in', choices: [['', 'as it says'], ...named(Object.keys(importer.lengths))], value: ''},
      ...importer.layersOf(file).map((layer) => ({key: `layer ${layer}`, text: `Size of ${layer}`})),
    ],
    read: (importer, file, answers) => {
      const layers = Object.entries(answers).flatMap(([key, said]) => {
        const size = key.startsWith('layer ') && sizeOf(said);
        return size ? [[key.slice('layer '.length), size]] : [];
      });
      return importer.fromDxf(text(file), Object.fromEntries(layers), unitAnswer(answers));
    },
  },
};
export const endings = Object.keys(kinds).map((each) => `.${each}`);
