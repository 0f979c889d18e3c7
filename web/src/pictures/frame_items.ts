import {said as complaint} from '../hint';
import {isRow, rowsOf, type Json, type Row} from '../json';
import {later, many, t} from '../language';
import type {Facts, Inspected, Item} from '../picture';
import type {Answer, Issue, Warning} from '../service';
import {choice, measured, sentence, sentences} from '../words';
import {figures, text} from './facts';
import {plateItems, plateLights} from './frame_plates';

/** State of a member: its part's verdict, or the frame's if that is worse. From good to bad. */
export const standings = ['ok', 'review', 'reject', 'none'] as const;
type Standing = (typeof standings)[number];
export const toneOf = (standing: string) => `cut-${standing}`;

/** An answer with its lists at hand; a member, its row of the cut list and its part have each other's places. */
export interface Told {
  answer: Answer;
  members: Row[];
  joints: Row[];
  cuts: Row[];
  parts: Row[];
  part: number[]; // of each member
  standing: Standing[]; // of each member
}

export function told(answer: Answer): Told {
  const {result} = answer;
  const [members, cuts] = [rowsOf(result['members']), rowsOf(result['cut_list'])];
  const places = new Map(cuts.map((cut, i) => [cut['part'], i]));
  const part = members.map((member) => places.get(member['part'] as Json) as number);
  const named = new Set(answer.warnings.filter(({severity}) => severity === 'cut').map(({pointer}) => pointer.split('/').slice(0, 3).join('/')));
  const standing = part.map((at, i): Standing => {
    const own = (cuts[at] as Row)['verdict'] as Standing;
    return own === 'ok' && named.has(`/members/${i}`) ? 'review' : own;
  });
  return {answer, members, joints: rowsOf(result['joints']), cuts, parts: answer.parts ?? [], part, standing};
}

/** "48.3 × 3.2", "60 × 40 × 3" */
export const size = (row: Row) =>
  ['outer_diameter_mm', 'height_mm', 'width_mm', 'wall_mm']
    .filter((key) => key in row)
    .map((key) => text('wall_mm', row[key]))
    .join(' × ');

/** Returns members, joints and different parts, each with its facts. */
export function itemsOf(given: Told): Inspected['lists'] {
  const place = new Map(given.members.map((member, i) => [String(member['id']), i]));
  return [
    {id: 'members', title: t('Members'), items: given.members.map((_, i) => memberItem(given, i))},
    {id: 'joints', title: t('Joints'), items: given.joints.map((_, i) => jointItem(given, i, place))},
    {id: 'parts', title: t('Parts'), items: given.cuts.map((_, i) => partItem(given, i, place))},
    ...plateItems(given, place),
  ];
}

/** The members that each item lights up. */
export function lightsOf(given: Told): number[][] {
  const place = new Map(given.members.map((member, i) => [member['id'], i]));
  const placed = (ids: Json[]) => ids.map((id) => place.get(id)).filter((i) => i !== undefined);
  return [
    ...given.members.map((_, i) => [i]),
    ...given.joints.map((joint) => placed([joint['branch'] as Json, joint['chord'] as Json])),
    ...given.cuts.map((cut) => placed(cut['members'] as Json[])),
    ...plateLights(given, placed),
  ];
}

const mark = (standing: string) => ({text: choice(standing), tone: toneOf(standing)});
/** "48.3 × 3.2, 419.33 mm" */
const dimensions = (cut: Row) => [size(cut), ...(typeof cut['long_mm'] === 'number' ? [measured('long_mm', cut['long_mm'])] : [])].join(', ');

function memberItem(given: Told, i: number): Item {
  const id = String(given.members[i]?.['id']);
  const at = given.part[i] as number;
  const {answer, joints, members} = given;
  return {
    name: id,
    detail: dimensions(given.cuts[at] as Row),
    mark: mark(given.standing[i] as string),
    facts: () => {
      const open = rowsOf(answer.result['not_cut']).filter((row) => row['id'] === id);
      const own = partFacts(given, at);
      return {
        ...own,
        said: [...own.said, ...open.map((row) => t('{part}: {text}.', {part: sentence(row['end'] ? choice(row['end']) : t('it')), text: choice(row['why'])}))],
        warnings: [...about(answer.warnings, `/members/${i}`), ...own.warnings],
        leads: joints.flatMap((joint, j) => (joint['branch'] === id || joint['chord'] === id ? [{name: joined(joint), to: members.length + j}] : [])),
      };
    },
  };
}

function partItem(given: Told, at: number, place: Map<string, number>): Item {
  const cut = given.cuts[at] as Row;
  const leads = (cut['members'] as string[]).map((name) => ({name, to: place.get(name) as number}));
  return {
    name: String(cut['part']),
    detail: [dimensions(cut), many(Number(cut['count']), '{n} piece', '{n} pieces')].join(t(', ')),
    mark: mark(String(cut['verdict'])),
    facts: () => ({...partFacts(given, at), leads}),
  };
}

/** Returns the facts of a part by itself; it leads nowhere. */
function partFacts(given: Told, at: number): Facts {
  const [cut, part] = [given.cuts[at] as Row, given.parts[at]];
  const made = part?.['answer'] as unknown as Answer | undefined;
  const request = made?.request ?? part?.['request'];
  const warnings = (made?.warnings ?? []).map((each) => ({...each, pointer: ''})); // of the part's request, not of this one
  const named = new Set<string>(warnings.map(({code}) => code));
  const lengths = {...cut, ...(made?.result['lengths'] as Row | undefined)};
  return {
    said: [
      partSaid(cut, made),
      ...(made?.verdict.reasons ?? []).filter((reason) => !named.has(reason)).map((reason) => sentence(choice(reason))),
      ...problemSaid(part?.['problem']),
    ],
    figures: figures(lengths, ['long_mm', 'short_mm', 'blank_mm', 'girth_mm', 'weld_mm', 'mass_kg'], 'cut_list'),
    warnings,
    leads: [],
    ...(isRow(request) ? {opens: {name: made ? t('Open this part') : t('Open its request'), endpoint: 'parts', body: request}} : {}),
  };
}

/** "9 alike, made as P0. Its own verdict: ok." */
function partSaid(cut: Row, made: Answer | undefined): string {
  return sentences(
    cut['count'] === 1 ? t('The only one of its kind.') : t('{n} alike, made as {part}.', {n: Number(cut['count']), part: String(cut['part'])}),
    made ? t('Its own verdict: {verdict}.', {verdict: choice(made.verdict.status)}) : t('It cannot be cut as requested.'),
  );
}

const problemSaid = (problem: Json | undefined) => (isRow(problem) ? rowsOf(problem['errors']).map((issue) => complaint(issue as unknown as Issue)) : []);

const about = (warnings: Warning[], pointer: string) => warnings.filter((each) => each.pointer === pointer || each.pointer.startsWith(`${pointer}/`));

const joinings: Record<string, string> = {
  set_on: later('{branch} on {chord}'),
  set_in: later('{branch} in {chord}'),
  through: later('{branch} through {chord}'),
};
/** "P0 on top", "left with top" */
const joined = (joint: Row) =>
  t(joinings[String(joint['kind'])] ?? later('{branch} with {chord}'), {branch: String(joint['branch']), chord: String(joint['chord'])});

function jointItem(given: Told, j: number, place: Map<string, number>): Item {
  const joint = given.joints[j] as Row;
  const sides = [joint['branch'], joint['chord']].map(String);
  return {
    name: joined(joint),
    detail: t('{kind}, gap {gap}', {kind: choice(joint['kind']), gap: measured('gap_mm', Number(joint['gap_mm']))}),
    facts: () => ({
      said: [
        joint['stated']
          ? t('{kind}; stated by the request.', {kind: sentence(choice(joint['kind']))})
          : t('{kind}; found by nearness.', {kind: sentence(choice(joint['kind']))}),
      ],
      figures: [...figures(joint, ['gap_mm', 'depth_mm', 'weld_mm', 'groove_mm3', 'hole'], 'joints'), ...fitUp(joint['fit_up'])],
      warnings: joint['stated'] ? about(given.answer.warnings, `/joints/${j}`) : [],
      leads: sides.flatMap((name) => (place.has(name) ? [{name, to: place.get(name) as number}] : [])),
    }),
  };
}

const fitUp = (given: Json | undefined) => (isRow(given) ? figures(given, ['least_mm', 'greatest_root_mm'], 'fit_up') : []);
