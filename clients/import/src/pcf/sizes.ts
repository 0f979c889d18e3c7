import {type Bore, boreMap, boreOf, mapped, unrecognised} from '../bores.js';
import {sizeNamed} from '../catalogue.js';
import {type Ask, clean, exact, type Size} from '../frame.js';
import {decimal} from '../units.js';
import {type Component, pointOf, Trouble, type Units} from './text.js';

export interface SizeOptions {
  /** Of pipes whose wall the file does not state: 'SCH 40', 'STD', 'XS', ... as GET /v1/tubes has them. */
  schedule?: string;
  /** The attribute that states a pipe's wall; WALL-THICKNESS without it. */
  wallAttribute?: string;
  /**
   * Meaning of a bore of the file, by its number: {'152.4': 'NPS 6'}; also 'DN 150', '168.3'
   * (outside diameter in mm), '168.3x7.11'.
   */
  bores?: Record<string, string>;
}

/** The sizes of one file, and its open questions. */
export class Sizes {
  private readonly counts = new Map<number, number>();
  private readonly map: Map<number, Bore>;
  private readonly uncertain: Set<number>;
  private withoutWall = 0;

  constructor(
    all: Component[],
    private readonly units: Units,
    private readonly options: SizeOptions,
    tubes: RegExp,
  ) {
    this.map = boreMap(options.bores ?? {});
    for (const component of all.filter(({type}) => tubes.test(type)))
      try {
        const [a, b] = this.ends(component);
        if (a === b && !mapped(this.map, a)) this.counts.set(a, (this.counts.get(a) ?? 0) + 1);
      } catch (failure) {
        if (!(failure instanceof Trouble)) throw failure; // it is listed when it is read
      }
    this.uncertain = new Set(unrecognised(this.counts, units.bore).map(({value}) => value));
  }

  private ends(component: Component): [number, number] {
    const [a, b] = [0, 1].map((nth) => pointOf(component, 'END-POINT', this.units, nth).bore) as [number, number];
    if (Number.isNaN(a) || Number.isNaN(b)) throw new Trouble('it has no nominal bore');
    return [a, b];
  }

  bore(component: Component): Bore {
    const [a, b] = this.ends(component);
    if (a !== b) throw new Trouble(`its ends have different bores, ${exact(a)} and ${exact(b)}`);
    const bore = mapped(this.map, a) ?? (this.uncertain.has(a) ? undefined : boreOf(a, this.units.bore));
    if (!bore) throw new Trouble(`its bore ${exact(a)} ${this.units.bore} is not a nominal size that is certain: state --bore "${exact(a)}=SIZE"`);
    return bore;
  }

  /** By the wall that the file has, else by the map of bores, else by the schedule that was requested. */
  of(component: Component): Size {
    const attribute = this.options.wallAttribute ?? 'WALL-THICKNESS';
    const words = component.attributes.find(({name}) => name === attribute)?.words;
    const bore = this.sizeless(words, component);
    if (words) return {outer_diameter_mm: bore.outer_diameter_mm, wall_mm: this.wall(words, bore, attribute)};
    if (bore.wall_mm !== undefined) return {outer_diameter_mm: bore.outer_diameter_mm, wall_mm: bore.wall_mm};
    if (!this.options.schedule) throw new Trouble(`it has no ${attribute}, and no schedule was given`);
    const name = `NPS ${bore.nps ?? '?'} ${this.options.schedule}`;
    const size = bore.nps === undefined ? undefined : sizeNamed(name);
    if (!size) throw new Trouble(`GET /v1/tubes lists no ${this.options.schedule} for ${bore.name}: state its outside diameter and wall with --bore`);
    return {size: size.name};
  }

  /** Its bore; that it lacks a wall is counted even if its bore is not known, so that both are requested at once. */
  private sizeless(words: string[] | undefined, component: Component): Bore {
    const before = this.withoutWall;
    if (!words) this.withoutWall += 1;
    const bore = this.bore(component);
    if (bore.wall_mm !== undefined) this.withoutWall = before;
    return bore;
  }

  private wall(words: string[], bore: Bore, attribute: string): number {
    const [, number, unitName] = /^([\d.]{1,64}) ?(MM|INCH|IN|")?$/i.exec(words.join(' ')) ?? [];
    const inches = unitName ? unitName.toUpperCase() !== 'MM' : this.units.bore === 'INCH';
    const wall = decimal(number) * (inches ? 25.4 : 1);
    if (!(wall > 0) || wall >= bore.outer_diameter_mm / 2) throw new Trouble(`its ${attribute} is no wall of ${bore.name}: ${clean(words.join(' '))}`);
    return exact(wall);
  }

  /** All that is missing, in one go: sizes of bores, and a schedule. */
  asks(): Ask[] {
    const out: Ask[] = unrecognised(this.counts, this.units.bore).map(({value, count, likely}) => {
      const key = `${exact(value)}`;
      const sizes = likely.map(({size, because}) => `${size} (${because})`).join(' or ');
      const probably = sizes ? `probably ${sizes}` : 'of no size that is known';
      const text = `${key} ${this.units.bore} is the bore of ${count} ${count === 1 ? 'component' : 'components'}, ${probably}`;
      return {option: 'bore', key, count, likely: likely.map(({size}) => size), text: `${text}: state --bore "${key}=${likely[0]?.size ?? 'SIZE'}"`};
    });
    if (this.withoutWall > 0 && !this.options.schedule) {
      const text = `${this.withoutWall} ${this.withoutWall === 1 ? 'pipe has' : 'pipes have'} no wall: state --schedule, for example "SCH 40"`;
      out.push({option: 'schedule', count: this.withoutWall, likely: [], text});
    }
    return out;
  }
}
