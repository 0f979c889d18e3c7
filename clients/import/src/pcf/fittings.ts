import {sizeNamed} from '../catalogue.js';
import {exact, type Found, type Joint, type Member, rounded} from '../frame.js';
import {distance, dot, length, minus, times, add, unit, type Vector} from '../geometry.js';
import {type Component, pointIn, Trouble, type Units} from './text.js';

/** mm: points of a file that are one, with the rounding of two programs. */
const touch = 0.5;

/** Of points at one position: only 0, 1 or more matter. */
const crowd = 16;

type End = {member: Member; end: 'start' | 'finish'; at: Vector; to: Vector};

/** Points by cells of two such distances, so that a file of many components is read in linear time. */
class Places<T> {
  private readonly cells = new Map<string, {at: Vector; value: T}[]>();

  add(at: Vector, value: T): void {
    const key = at.map((v) => Math.round(v / (2 * touch))).join();
    const cell = this.cells.get(key) ?? [];
    if (cell.length < crowd) cell.push({at, value});
    this.cells.set(key, cell);
  }

  near(at: Vector): T[] {
    const cell = at.map((v) => Math.round(v / (2 * touch)));
    const steps = [-1, 0, 1];
    const [x, y, z] = cell as Vector;
    const keys = steps.flatMap((i) => steps.flatMap((j) => steps.map((k) => `${x + i},${y + j},${z + k}`)));
    return keys.flatMap((key) => (this.cells.get(key) ?? []).filter((each) => distance(each.at, at) <= touch).map(({value}) => value));
  }
}

/** mm: no pipe of a nominal size is thicker. */
const outerMost = 1300;

const points = /^(END|BRANCH\d*)-POINT$/;
/** Things that are bought, and have no tube that could be cut. */
const fitting =
  /^(TEE|CROSS|REDUCER|VALVE|FLANGE|LAPJOINT|CAP|COUPLING|UNION|PLUG|INSTRUMENT|FILTER|TRAP|MISC-COMPONENT|MULTIPORT|GASKET|ELBOW|BEND|ELBOLET|OLET|SAFETY)(-|$)/;
const elbows = /^(ELBOW|BEND)$/;
/** Branches on a header: with a body between, or without. */
const onHeader = /^(OLET|TEE-SET-ON|TEE-STUB|CROSS-SET-ON|CROSS-STUB)$/;

interface Branch {
  line: number;
  type: string;
  header: Member | undefined; // if the file names it
  at: Vector; // on the header
  out: Vector; // where the branch's pipe begins
}

const outerOf = (member: Member): number =>
  'outer_diameter_mm' in member ? member.outer_diameter_mm : ('size' in member && sizeNamed(member.size)?.outer_diameter_mm) || Number.NaN;

/** How far a point is from a member's axis, and where its foot lies on it, from 0 to 1. */
function beside(member: Member, p: Vector): {off: number; along: number} {
  const run = minus(member.end_mm, member.start_mm);
  const along = dot(minus(p, member.start_mm), run) / dot(run, run);
  return {off: distance(p, add(member.start_mm, times(run, along))), along};
}

/** Connections of pipes with other things: use after all pipes are known. */
export class Fittings {
  private readonly ends = new Places<End>();
  private readonly others = new Places<Component>();
  private readonly joined = new Set<string>();

  constructor(
    private readonly found: Found,
    all: Component[],
    private readonly units: Units,
    private readonly pipeOf: Map<Component, Member>,
    /** mm: a branch that begins so near to its header's surface is joined to it; there is no fitting between. */
    private readonly within: number,
  ) {
    for (const member of found.members) {
      this.ends.add(member.start_mm, {member, end: 'start', at: member.start_mm, to: member.end_mm});
      this.ends.add(member.end_mm, {member, end: 'finish', at: member.end_mm, to: member.start_mm});
    }
    for (const component of all)
      if (!pipeOf.has(component) && fitting.test(component.type)) for (const at of this.pointsOf(component).slice(0, crowd)) this.others.add(at, component);
  }

  private pointsOf(component: Component): Vector[] {
    return component.attributes.flatMap((each) => {
      try {
        return points.test(each.name) ? [pointIn(each, this.units).at] : [];
      } catch (failure) {
        if (failure instanceof Trouble) return [];
        throw failure;
      }
    });
  }

  private state(joint: Joint): void {
    const key = [...joint.between].sort().join('\n');
    if (this.joined.has(key)) return;
    this.joined.add(key);
    this.found.joints.push(joint);
  }

  /** A plane at each pipe that begins at the fitting: its end is square there. */
  planes(component: Component, name: string): void {
    const at = this.pointsOf(component);
    if (at.length > crowd) throw new Trouble(`it has ${at.length} points, and at most ${crowd} are read`);
    const own = at.filter((p, i) => at.findIndex((q) => distance(p, q) <= touch) === i);
    const pipes = own.map((p) => this.ends.near(p));
    const alone = pipes.every((each) => each.length === 0) && own.every((p) => this.others.near(p).every((each) => each === component));
    if (alone && !elbows.test(component.type)) throw new Trouble('no pipe ends at it');
    const ends = pipes.filter((each) => each.length === 1).flat();
    ends.forEach((end, i) => {
      const id = ends.length === 1 ? name : `${name}/${i + 1}`;
      this.found.others.push({other: {kind: 'plane', id, point_mm: end.at, normal: rounded(unit(minus(end.to, end.at)) as Vector)}});
      this.state({between: [end.member.id, id], kind: 'set_on', end: end.end});
    });
    if (pipes.some((each) => each.length > 1) && !elbows.test(component.type)) throw new Trouble('more than one pipe ends at one of its points');
  }

  /** TAP-CONNECTION is among the attributes of a pipe; its point follows it. */
  taps(component: Component): void {
    component.attributes.forEach((each, i) => {
      if (each.name !== 'TAP-CONNECTION') return;
      const {line} = each;
      this.noting(line, 'TAP-CONNECTION', () => {
        const next = component.attributes[i + 1];
        const place = each.words.length >= 3 ? each : next?.name === 'CO-ORDS' ? next : undefined;
        if (!place) throw new Trouble('it has no CO-ORDS');
        const {at} = pointIn(place, this.units);
        const header = this.pipeOf.get(component);
        if (!header) throw new Trouble(`it is on a ${component.type} that is not a pipe of the frame: no hole is cut there`);
        this.branch({line, type: 'TAP-CONNECTION', header, at, out: at});
      });
    });
  }

  /**
   * A branch fitting: if a pipe is set on the header, it is cut by it and the header has a hole; an
   * olet's body lies between, so its pipe ends square.
   */
  onHeader(component: Component, name: string): void {
    const {line, type} = component;
    const [centre, outlet] = [/^CENTRE-POINT$/, /^BRANCH\d*-POINT$/].map((each) => component.attributes.find((one) => each.test(one.name)));
    if (!centre || !outlet) throw new Trouble(`it has no ${centre ? 'BRANCH1-POINT' : 'CENTRE-POINT'}`);
    const [at, out] = [centre, outlet].map((each) => pointIn(each, this.units).at) as [Vector, Vector];
    try {
      this.branch({line, type, header: undefined, at, out});
    } catch (failure) {
      if (!(failure instanceof Trouble)) throw failure;
      if (this.pointsOf(component).some((p) => this.ends.near(p).length === 1)) this.planes(component, name);
      throw failure;
    }
  }

  private headerAt(at: Vector, branch: Member): Member {
    const through = this.found.members.filter((each) => {
      const reach = outerMost + this.within;
      if (
        at.some((v, i) => v < Math.min(each.start_mm[i as 0], each.end_mm[i as 0]) - reach || v > Math.max(each.start_mm[i as 0], each.end_mm[i as 0]) + reach)
      )
        return false;
      const {off, along} = beside(each, at);
      return each !== branch && along > 0 && along < 1 && off <= Math.max(touch, outerOf(each) / 2 + this.within);
    });
    const nearest = through.map((each) => ({each, off: beside(each, at).off})).sort((a, b) => a.off - b.off)[0];
    if (!nearest) throw new Trouble('no pipe goes through its point on the header: its hole is not cut');
    return nearest.each;
  }

  private branch({header: given, at, out}: Branch): void {
    const ends = this.ends.near(out).filter(({member}) => member !== given);
    if (ends.length !== 1 || !ends[0]) throw new Trouble(`${ends.length === 0 ? 'no pipe begins' : 'more than one pipe begins'} at it: its hole is not cut`);
    const {member} = ends[0];
    const header = given ?? this.headerAt(at, member);
    const {off, along} = beside(header, out);
    const radius = outerOf(header) / 2;
    if (!(along > 0 && along < 1)) throw new Trouble(`it lies beyond the ends of ${header.id}: its hole is not cut`);
    if (off > radius + this.within)
      throw new Trouble(`${member.id} begins ${exact(off - radius)} mm off ${header.id}, where its fitting ends: the hole in ${header.id} is not cut`);
    const run = minus(member.end_mm, member.start_mm);
    const across = minus(header.end_mm, header.start_mm);
    if (Math.abs(dot(run, across)) > (1 - 1e-6) * length(run) * length(across)) throw new Trouble(`${member.id} is parallel to ${header.id}: no hole is cut`);
    this.state({between: [member.id, header.id], kind: 'set_on', hole: 'cut'});
  }

  private noting(line: number, type: string, act: () => void): void {
    try {
      act();
    } catch (failure) {
      if (!(failure instanceof Trouble)) throw failure;
      this.found.notUnderstood.push({id: `line ${line}`, type, reason: failure.message});
    }
  }

  read(component: Component, name: string): void {
    if (onHeader.test(component.type)) {
      this.onHeader(component, name);
      return;
    }
    this.planes(component, name);
    if (component.type === 'ELBOLET') throw new Trouble('the hole in its elbow is not cut');
    if (!fitting.test(component.type)) throw new Trouble(`${component.type} is not imported: the pipes that begin at it end square`);
  }
}
