import {later} from './language';
import type {Format} from './schema';

/** What a file is wanted for. */
export type Purpose = 'program' | 'drawing' | 'model' | 'packet' | 'data';
export const purposeNames: Record<Purpose, string> = {
  packet: later('Shop packet'),
  program: later('Machine program'),
  drawing: later('Drawings and templates'),
  model: 'CAD',
  data: later('Data'),
};

const media: Record<string, [name: string, ending: string, purpose: Purpose]> = {
  'application/json': ['JSON', 'json', 'data'],
  'application/cbor': ['CBOR', 'cbor', 'data'],
  'text/csv': ['CSV', 'csv', 'data'],
  'image/svg+xml': ['SVG', 'svg', 'drawing'],
  'image/vnd.dxf': ['DXF', 'dxf', 'model'],
  'model/gltf-binary': ['glTF (3D)', 'glb', 'model'],
  'model/stl': ['STL (3D)', 'stl', 'model'],
  'model/step': ['STEP (CAD)', 'step', 'model'],
  'text/x-gcode': ['G-code', 'ngc', 'program'],
  'text/x-iec61131-st': ['IEC 61131-3 ST', 'st', 'program'],
  'application/pdf': ['PDF', 'pdf', 'drawing'],
  'application/zip': [later('Shop packet (zip)'), 'zip', 'packet'],
  'application/x-ndjson': [later('Lines (NDJSON)'), 'ndjson', 'data'],
};
export function known(type: string): [name: string, ending: string, purpose: Purpose] {
  return media[type] ?? (/dstv|nc1/.test(type) ? ['DSTV', 'nc1', 'model'] : [type, 'txt', 'data']);
}

/** Options without a use in a program around a tube that is not round: it is cut in one pass, without tabs, from a flat. */
const ofRound = new Set(['passes', 'tabs', 'tab_mm', 'tabs_of', 'start_deg']);

const ofParts = new Set(['marks', 'mark_speed_mm_min']);

/** The formats, views and options of an answer: sections of the wall are of round tubes only, STEP and NC1 also of `whole` parts. */
export const printable = (formats: Format[], round: boolean, whole = false): Format[] =>
  round
    ? formats
    : formats
        .filter(({media: type}) => whole || !/dstv|nc1|step/.test(type))
        .map((format) => ({
          ...format,
          views: format.views.filter((view) => view !== 'section'),
          options: format.options.filter(({name}) => !ofRound.has(name) && (whole || !ofParts.has(name))),
        }));

/** The purposes that an endpoint has files for. */
export const purposesOf = (formats: Format[]): Purpose[] =>
  (Object.keys(purposeNames) as Purpose[]).filter((each) => formats.some((format) => known(format.media)[2] === each));

export type Values = Record<string, string>;
export type Option = Format['options'][number];

/** Options by the question that they answer. */
const groups: [title: string, names: string[]][] = [
  [later('Contents'), ['files', 'paper', 'mirror', 'omega_deg']],
  [later('Machine and material'), ['machine', 'material', 'speed_mm_min', 'post']],
  [later('Torch'), ['torch', 'acknowledge', 'pierce_height_mm', 'pierce_delay_s', 'cut_height_mm', 'passes']],
  [later('Leads'), ['lead_mm', 'overcut_mm', 'start_deg', 'pierce_b_deg']],
  [later('Tabs and marks'), ['tabs', 'tab_mm', 'tabs_of', 'marks', 'mark_speed_mm_min']],
  [later('Axes'), ['axial', 'pivot_length_mm', 'clearance_mm']],
];
const drawn = new Set(['files', 'paper', 'mirror', 'omega_deg']);
/** `post` names what `dialect` named before. */
const retired = new Set(['dialect']);
const fromTable = new Set(['speed_mm_min', 'pierce_height_mm', 'pierce_delay_s', 'cut_height_mm', 'lead_mm', 'pivot_length_mm', 'clearance_mm']);

/** Whether a process table gives the value of an option that is left empty. */
export const isTabled = (name: string, given: Values) => fromTable.has(name) && Boolean(given['machine'] && given['material']);

/** Whether an option means something with the others as they are. */
export function applies(name: string, given: Values, program: boolean): boolean {
  const led = Number(given['lead_mm']) > 0 || Boolean(given['machine'] && given['material']);
  if (!drawn.has(name) && !program) return false;
  switch (name) {
    case 'material':
      return Boolean(given['machine']);
    case 'acknowledge':
    case 'pierce_height_mm':
    case 'pierce_delay_s':
    case 'cut_height_mm':
    case 'marks':
      return given['torch'] === 'on';
    case 'mark_speed_mm_min':
      return given['torch'] === 'on' && given['marks'] === 'on';
    case 'overcut_mm':
    case 'pierce_b_deg':
      return led;
    case 'tab_mm':
    case 'tabs_of':
      return Boolean(given['tabs']);
    case 'clearance_mm':
      return Boolean(given['pivot_length_mm']) || led;
    default:
      return !retired.has(name);
  }
}

/** Whether programs are among what is asked for: of a packet only if it is to hold them. */
export const hasProgram = (purpose: Purpose, given: Values): boolean =>
  purpose === 'program' || (purpose === 'packet' && Boolean(given['files']?.split(',').includes('gcode')));

/** The options to show for a purpose, in their groups; those that were refused are shown whatever the others are. */
export function groupsOf(formats: Format[], purpose: Purpose, given: Values, refused: ReadonlySet<string>): [title: string, options: Option[]][] {
  const own = formats.filter((format) => known(format.media)[2] === purpose).flatMap((format) => format.options);
  const options = new Map(own.map((option) => [option.name, option]));
  const program = hasProgram(purpose, given);
  const named = new Set(groups.flatMap(([, names]) => names));
  const others: [string, string[]] = [later('More'), [...options.keys()].filter((name) => !named.has(name))];
  return [...groups, others].flatMap(([title, names]) => {
    const shown = names.flatMap((name) => {
      const option = options.get(name);
      return option && (refused.has(name) || applies(name, given, program)) ? [option] : [];
    });
    return shown.length ? [[title, shown] as [string, Option[]]] : [];
  });
}

/** The query of a format: what is given and means something there. */
export function queryOf({media: type, options}: Format, view: string | undefined, given: Values): URLSearchParams {
  const query = new URLSearchParams(view ? {view} : {});
  const program = hasProgram(known(type)[2], given);
  for (const {name} of options) {
    const value = given[name];
    const apart = /^(mirror|paper)$/.test(name) && view !== 'template'; // drawings of other views refuse it
    if (value && !apart && applies(name, given, program)) query.set(name, value);
  }
  return query;
}

const key = 'files';
const passing = new Set(['acknowledge']); // belongs to one answer

/** What was chosen last, on whatever page. Without a storage nothing is remembered. */
export function remembered(): Values {
  try {
    return JSON.parse(localStorage.getItem(key) ?? '{}') as Values;
  } catch {
    return {};
  }
}
export function remember(given: Values): void {
  const kept = Object.fromEntries(Object.entries(given).filter(([name]) => !passing.has(name)));
  try {
    localStorage.setItem(key, JSON.stringify(kept));
  } catch {
    /* not remembered */
  }
}
