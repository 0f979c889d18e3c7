/** A second opinion on an answer of the tubecut service: `certify` recomputes what the answer states by formulas of its own. */
import {checkHashes, checkRequest} from './identity.js';
import type {Json} from './json.js';
import {checkFeed} from './feed.js';
import {checkFrame} from './frames.js';
import {checkGroove} from './grooves.js';
import {checkHoles} from './holes.js';
import {checkMill} from './mills.js';
import {checkNodes, cutOfNode} from './nodes.js';
import {boreOf, checkSection, outsideOf} from './outline.js';
import {checkPart} from './parts.js';
import {checkProfile} from './profiles.js';
import {type Check, Report, Scope} from './report.js';
import {checkReplay, checkSchedule} from './schedules.js';
import {checkSectionProfile} from './section_curves.js';
import {checkSectionEnd} from './section_ends.js';
import {checkSectionPart} from './section_parts.js';
import {type Body, isSection, type Section, sectionOf, type Size} from './solids.js';
import {checkEnd, cutOf, type Knowledge, machineOf} from './tables.js';

export type {Check} from './report.js';

/** What names in a request mean: the answers of GET /v1/tubes and GET /v1/machines. */
export interface Names {
  tubes?: Json;
  machines?: Json;
}

export interface Certificate {
  passed: boolean; // all checks that were made
  checks: Check[];
  /** Members of the answer that no check looks at, by pointer with `*` for any index; why, if there is a reason of its own. */
  notChecked: {pointer: string; why: string}[];
}

/** Checks the answer, as the service sent it, to the request; without a request that which the answer echoes. */
export function certify(answer: string, request?: string, names: Names = {}): Certificate {
  const body = JSON.parse(answer) as Body;
  const report = new Report();
  const know: Knowledge = {
    sizes: new Map(listOf(names.tubes, 'tubes').map((row) => [String(row.size), row as unknown as Size])),
    sections: new Map(listOf(names.tubes, 'rectangular_tubes').map((row) => [String(row.size), row as unknown as Section])),
    machines: new Map(listOf(names.machines, 'machines').map((row) => [String(row.name), row.machine as Body])),
  };
  checkHashes(new Scope(report, ''), answer);
  if (request !== undefined) checkRequest(new Scope(report, ''), JSON.parse(request) as Json, body.request);
  const job = body.job as Body | undefined;
  if (body.result && job) guarded(new Scope(report), String(job.endpoint), () => checkResult(new Scope(report), String(job.endpoint), body, know));
  return {passed: report.passed, checks: [...report.checks.values()], notChecked: uncovered(body, report)};
}

const listOf = (answer: Json | undefined, name: string): Body[] => ((answer as Body | undefined)?.[name] ?? []) as Body[];

/** If a result has not even the form that its checks read, that is a failed check, and no end of the program. */
function guarded(scope: Scope, endpoint: string, check: () => void): void {
  try {
    check();
  } catch (error) {
    scope.most('readable', 1, 0, '', `${endpoint}: ${(error as Error).message}`);
  }
}

/** The body that is cut, given by itself or as a member. */
function targetOf(request: Body): Body {
  const node = (request.node ?? request) as Body;
  const member = ((node.members ?? []) as Body[]).find(({id}) => id === node.member);
  return (request.target ?? member ?? {}) as Body;
}

function checkResult(scope: Scope, endpoint: string, answer: Body, know: Knowledge): void {
  const [request, result] = [answer.request as Body, answer.result as Body];
  const ids = (result.cutter_ids ?? []) as string[];
  if (isSection(targetOf(request))) {
    checkSectionResult(scope, endpoint, request, result, know);
    return;
  }
  switch (endpoint) {
    case 'intersections': {
      const cut = request.node ? cutOfNode(request, ids, know) : cutOf(request, know);
      for (const profile of result.profiles as Body[]) checkProfile(scope.under('profiles/*'), cut, profile, request.sampling);
      return;
    }
    case 'bevel-tables':
      checkEnd(scope, request.node ? cutOfNode(request, ids, know) : cutOf(request, know), result, know);
      return;
    case 'nodes':
      checkNodes(scope, request, result, know);
      return;
    case 'feed-curves':
      checkFeed(scope, request, result);
      return;
    case 'frames':
      checkFrame(scope, answer, know);
      return;
    case 'pulse-schedules':
      checkSchedule(scope, request, result, machineOf(request.machine, know));
      return;
    case 'replays':
      checkReplay(scope, request, result, machineOf(request.machine, know));
      return;
    case 'parts':
      checkPart(scope, request, result, know);
      return;
    case 'grooves':
      checkGroove(scope, request, result);
      return;
    case 'mill-paths':
      checkMill(scope, request, result);
      return;
    case 'holes':
      checkHoles(scope, request, result, know.sizes);
      return;
    default:
      scope.not('', `answers of ${endpoint} are not covered`);
  }
}

/** Of a target that is not round. */
function checkSectionResult(scope: Scope, endpoint: string, request: Body, result: Body, know: Knowledge): void {
  const ids = (result.cutter_ids ?? []) as string[];
  const target = sectionOf(targetOf(request), know.sections);
  if (endpoint === 'parts') {
    checkSectionPart(scope, request, result, know);
    return;
  }
  if (endpoint !== 'intersections' && endpoint !== 'bevel-tables') {
    scope.not('', `answers of ${endpoint} with a target that is not round are not covered`);
    return;
  }
  const cut = request.node ? cutOfNode(request, ids, know) : cutOf(request, know);
  const whole = {cut, outer: outsideOf(target), bore: boreOf(target)};
  checkSection(scope, target, result.section as Body);
  if (endpoint === 'bevel-tables') checkSectionEnd(scope, whole, result, know);
  else for (const profile of result.profiles as Body[]) checkSectionProfile(scope.under('profiles/*'), whole, profile);
}

/** Numbers of the result that no check covers. */
function uncovered(body: Body, report: Report): {pointer: string; why: string}[] {
  const found = new Map<string, string>();
  const walk = (value: Json, pointer: string) => {
    if (report.covered.has(pointer)) return;
    if (typeof value === 'number') found.set(pointer, '');
    else if (Array.isArray(value)) {
      if (value.every((item) => typeof item === 'number' || item === null) && value.length) {
        if (!report.covered.has(`${pointer}/*`)) found.set(pointer, '');
      } else for (const item of value) walk(item, `${pointer}/*`);
    } else if (value && typeof value === 'object') for (const [name, item] of Object.entries(value)) walk(item, `${pointer}/${name}`);
  };
  walk((body.result ?? null) as Json, '/result');
  for (const part of (body.parts ?? []) as Body[]) walk(((part.answer as Body | undefined)?.result ?? null) as Json, '/parts/*/answer/result');
  const reasons = [...report.notes];
  for (const pointer of found.keys()) found.set(pointer, reasons.find(([base]) => pointer.startsWith(base))?.[1] ?? '');
  return [...found].map(([pointer, why]) => ({pointer, why}));
}
