import {exact, type NotUnderstood} from '../frame.js';
import {type Corners, cornersToState, type Section, type Sides, standards, uncut} from '../sections.js';
import {told, Trouble} from './model.js';
import {type Box, boxScaled} from './profiles.js';
import type {Body} from './solids.js';

export type Tube = Body & {kind: 'box'};

/** A member's section, or only the corners with which it cuts others and the reason why it is no member. */
export type Made = {section: Section; assumed?: string} | {corner_radius_mm: number; why: string};

/** Rectangular tubes of a file: by the corners that it states, else by those that the caller states. */
export class Boxes {
  /** How many could be members if their corners were stated. */
  open = 0;
  private readonly profiles = new Set<number>(); // whose assumptions are listed: once each, and not for every member

  constructor(private readonly stated: Corners | undefined) {}

  made(body: Tube, mm: number): Made {
    const {corner, inner, ...sides} = millimetres(body, mm);
    const own = corner === undefined ? undefined : {corner_radius_mm: corner, ...(inner === undefined ? {} : {inner_corner_radius_mm: inner})};
    const [wrong, alsoWrong] = [own && uncut(sides, own), this.stated && uncut(sides, this.stated)];
    if (own && wrong === undefined) {
      const concentric = `${told(body.profile)} has no InnerFilletRadius: the corners of its bore are concentric with those outside`;
      return {section: {kind: 'rectangular_tube', ...sides, ...own}, ...(inner === undefined ? {assumed: concentric} : {})};
    }
    if (this.stated && alsoWrong === undefined)
      return {
        section: {kind: 'rectangular_tube', ...sides, ...this.stated},
        ...(wrong === undefined ? {} : {assumed: `of ${told(body.profile)}, ${wrong}: its corners are those stated for such tubes`}),
      };
    if (!this.stated) ++this.open;
    const why = [wrong, alsoWrong].filter((each) => each !== undefined).join(', and ');
    if (own) return {corner_radius_mm: own.corner_radius_mm, why: this.stated ? why : `${why}: state --corner`};
    if (!this.stated)
      throw new Trouble(`${told(body.profile)} is a rectangular tube without OuterFilletRadius or with sharp corners, which are not cut: state --corner`);
    if ('corner_radius_mm' in this.stated) return {corner_radius_mm: this.stated.corner_radius_mm, why};
    throw new Trouble(`${told(body.profile)} is a rectangular tube of which ${why}`);
  }

  /** The item of the list for a section's assumption, if it is not there yet. */
  note({profile}: Tube, made: Made): NotUnderstood[] {
    if (!('assumed' in made) || made.assumed === undefined || this.profiles.has(profile.id)) return [];
    this.profiles.add(profile.id);
    return [{id: `#${profile.id}`, type: profile.type, reason: `assumed: ${made.assumed}`}];
  }

  /** One question for all of them. */
  ask(): {option: 'corner'; count: number; likely: string[]; text: string}[] {
    const {open} = this;
    if (open === 0) return [];
    const text = `${open} rectangular ${open === 1 ? 'tube has' : 'tubes have'} corners that are not stated or too sharp to be cut: state --corner, ${cornersToState}`;
    return [{option: 'corner', count: open, likely: [...standards], text}];
  }
}

function millimetres(box: Box, mm: number): Sides & {corner: number | undefined; inner: number | undefined} {
  const {width, height, wall, corner, inner} = boxScaled(box, mm);
  return {height_mm: exact(height), width_mm: exact(width), wall_mm: exact(wall), corner: corner && exact(corner), inner: inner && exact(inner)};
}
