import {rowsOf, type Json, type Row} from '../json';
import {t} from '../language';
import type {Warning} from '../service';
import {membersOf, squareName} from './members';

/** A change of the request that removes the cause of a warning. */
export interface Fix {
  name: string;
  apply(body: Row): void;
}
export interface Reported {
  warning: Warning;
  fixes: Fix[];
}
/** The warnings of one member, or of the frame as a whole. */
export interface Group {
  member?: number;
  name: string;
  reported: Reported[];
}
export interface Summary {
  counts: [code: Warning['code'], count: number][];
  groups: Group[];
}

const inLine = {angle: 0.5 * (Math.PI / 180), off: 2}; // as merge_in_line of the service

/** The warnings of a frame by member, the kinds counted, each pair reported once. */
export function summarise(warnings: Warning[], body: Row): Summary {
  const members = membersOf(body);
  const groups = new Map<number | undefined, Group>();
  const counts = new Map<Warning['code'], number>();
  const pairs = new Set<string>();
  for (const warning of warnings) {
    const at = memberOf(warning, body);
    const other = at === undefined ? undefined : otherOf(warning, members, at);
    if (at !== undefined && other !== undefined) {
      const pair = [warning.code, Math.min(at, other), Math.max(at, other)].join();
      if (perPair.has(warning.code) && pairs.has(pair)) continue;
      pairs.add(pair);
    }
    counts.set(warning.code, (counts.get(warning.code) ?? 0) + 1);
    const group = groups.get(at) ?? {...(at === undefined ? {} : {member: at}), name: at === undefined ? '' : String(members[at]?.['id'] ?? ''), reported: []};
    groups.set(at, group);
    group.reported.push({warning, fixes: fixesOf(warning, body, at, other)});
  }
  return {
    counts: [...counts].sort((a, b) => b[1] - a[1]),
    groups: [...groups.values()].sort((a, b) => (a.member ?? -1) - (b.member ?? -1)),
  };
}

/** Warnings that concern two members alike. */
const perPair = new Set<Warning['code']>(['members_overlap', 'mitre_steps', 'parallel_members']);

/** The member that a warning's pointer leads to. */
function memberOf({pointer}: Warning, body: Row): number | undefined {
  const [, list, index] = pointer.split('/');
  if (list === 'members' && index !== undefined) return Number(index);
  const named = list === 'joints' ? rowsOf(body['joints'])[Number(index)]?.['between'] : undefined;
  const names = Array.isArray(named) ? named : [rowsOf(body[list ?? ''])[Number(index)]?.['member']];
  const found = membersOf(body).findIndex(({id}) => names.includes(id as Json));
  return found < 0 ? undefined : found;
}

/** The other member that a detail names: the longest name in it that is not the member's own. */
function otherOf({detail}: Warning, members: Row[], own: number): number | undefined {
  let best: {at: number; length: number} | undefined;
  members.forEach(({id}, at) => {
    const name = String(id);
    if (at !== own && name !== '' && name.length > (best?.length ?? 0) && contains(detail, name)) best = {at, length: name.length};
  });
  return best?.at;
}

function contains(text: string, name: string): boolean {
  for (let at = text.indexOf(name); at >= 0; at = text.indexOf(name, at + 1)) {
    const around = (text[at - 1] ?? ' ') + (text[at + name.length] ?? ' ');
    if (!/[\p{L}\p{N}_]/u.test(around)) return true;
  }
  return false;
}

function fixesOf(warning: Warning, body: Row, at: number | undefined, other: number | undefined): Fix[] {
  if (at === undefined) return [];
  const end = /\/(start|end)_mm$/.exec(warning.pointer)?.[1];
  const missed = /misses .* by ([\d.]+(?:e[-+]?\d+)?) mm$/.exec(warning.detail)?.[1];
  const fixes: Fix[] = [];
  if (warning.code === 'free_end' && missed !== undefined) {
    const within = Math.ceil(Number(missed) + 0.5);
    fixes.push({name: t('Raise within to {within} mm', {within}), apply: (to) => raise(to, within)});
  }
  if (warning.code === 'ghost_contact' && other !== undefined && /; both end here, so state a mitre of the two/.test(warning.detail))
    fixes.push({name: t('Mitre the two'), apply: (to) => mitre(to, at, other)});
  const straight = other !== undefined && continues(membersOf(body)[at], membersOf(body)[other]);
  if (straight && body['merge_in_line'] !== true && perPair.has(warning.code)) {
    fixes.push({
      name: t('Merge in line'),
      apply: (to) => {
        to['merge_in_line'] = true;
      },
    });
  }
  if (end && ['free_end', 'end_open', 'parallel_members'].includes(warning.code)) {
    const side = end === 'end' ? 'finish' : 'start';
    fixes.push({name: t('Square the end'), apply: (to) => squareEnd(to, at, side)});
  }
  return fixes;
}

function raise(body: Row, within: number): void {
  const connect = body['connect'] as Row | undefined;
  body['connect'] = {...connect, within_mm: Math.max(within, Number(connect?.['within_mm'] ?? 0))};
}

/** Joins two members that end at one point by the plane between them. */
function mitre(body: Row, at: number, other: number): void {
  const between = [at, other].map((i) => membersOf(body)[i]?.['id'] as Json);
  const apart = (joint: Row) => !between.every((id) => (joint['between'] as Json[]).includes(id));
  body['joints'] = [...rowsOf(body['joints']).filter(apart), {between, kind: 'mitre'}];
}

/** Cuts an end by a plane across the member, at its work point. */
function squareEnd(body: Row, at: number, end: 'start' | 'finish'): void {
  const member = membersOf(body)[at];
  if (!member) return;
  const id = squareName(String(member['id']), end);
  if (rowsOf(body['others']).some((other) => other['id'] === id)) return;
  const [start, finish] = lineOf(member);
  const plane: Row = {kind: 'plane', id, point_mm: end === 'start' ? start : finish, normal: finish.map((v, i) => v - (start[i] as number))};
  body['others'] = [...rowsOf(body['others']), plane];
  body['joints'] = [...rowsOf(body['joints']), {between: [member['id'] as Json, id], kind: 'set_on', end}];
}

const lineOf = (member: Row) => ['start_mm', 'end_mm'].map((key) => (Array.isArray(member[key]) ? member[key].map(Number) : [])) as [number[], number[]];

/** Whether two members are alike and lie on one line. */
function continues(a: Row | undefined, b: Row | undefined): boolean {
  if (!a || !b || ['size', 'outer_diameter_mm', 'wall_mm'].some((key) => a[key] !== b[key])) return false;
  const [[p, q], [r, s]] = [lineOf(a), lineOf(b)];
  const along = unit(minus(q, p));
  if (!along) return false;
  const off = [r, s].map((point) => {
    const from = minus(point, p);
    const far = from.reduce((sum, v, i) => sum + v * (along[i] as number), 0);
    return Math.hypot(...from.map((v, i) => v - far * (along[i] as number)));
  });
  const other = unit(minus(s, r));
  const cosine = other ? Math.abs(other.reduce((sum, v, i) => sum + v * (along[i] as number), 0)) : 0;
  return cosine > Math.cos(inLine.angle) && Math.min(...off) <= inLine.off;
}
const minus = (a: number[], b: number[]) => a.map((v, i) => v - (b[i] as number));
function unit(v: number[]): number[] | undefined {
  const size = Math.hypot(...v);
  return size > 0 ? v.map((each) => each / size) : undefined;
}
