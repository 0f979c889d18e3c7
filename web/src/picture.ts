import type {Json, Row} from './json';
import type {Warning} from './service';
import type {Term} from './words';

/**
 * The visible content of an answer, as data: the pictures of one endpoint are a function from
 * request and answer to this.
 */
export interface Picture {
  solid?: Solid;
  charts: Chart[];
  figures: Figure[];
  tables?: Table[];
  /** Values at the cursor's point, for the strip under the solid. */
  readout?: (index: number, link: string) => [Term, string][];
  /** Summary of the answer, for the verdict. */
  said?: string;
  inspected?: Inspected;
  /** The path along which the cursor of a link is played. */
  played?: Played;
  section?: Section;
  /** There is a before and an after to switch between. */
  beforeAfter?: boolean;
}

/**
 * Selectable items in lists next to the solid and in it. Indices of items continue from list to
 * list: the cursor and the selection of `link` are such indices.
 */
export interface Inspected {
  link: string;
  lists: {id: string; title: string; items: Item[]}[];
}
export interface Item {
  name: string;
  detail: string;
  mark?: {text: string; tone: string}; // a colour of the style sheet
  facts(): Facts;
}
export interface Facts {
  said: string[];
  figures: Figure[];
  warnings: Warning[];
  /** Items that belong to this one. */
  leads: {name: string; to: number}[];
  /** A job of its own. */
  opens?: {name: string; endpoint: string; body: Row};
}

/** Section by a plane through the cursor's point, mm, in the box from `low` to `high`. */
export interface Section {
  link: string;
  count: number;
  low: [number, number];
  high: [number, number];
  at(index: number): {
    title: string;
    lines: SectionLine[];
    moved?: (place: [number, number]) => [number, number];
    points?: {at: [number, number]; text: string}[];
    note?: string;
  };
}
export interface SectionLine {
  points: [number, number][];
  tone: 'steel' | 'before' | 'after';
  dashed?: boolean;
}

/** The cursor's points in time, and the events at some of them. */
export interface Played {
  link: string;
  seconds: number[];
  events: {at: number; text: string}[];
  /** The time by its kinds: from and to in seconds. */
  segments?: {from: number; to: number; tone: string; text: string}[];
}

export interface Figure {
  name: string;
  value: string;
  unit?: string;
  about?: string;
}
export interface Table {
  title: string;
  head: Term[];
  rows: Term[][];
  id?: string;
  /** The first column holds names as they were given. */
  names?: true;
}

export interface Series {
  about?: string;
  name: string;
  values: (number | null)[];
  tone: string; // a colour of the style sheet
  dash?: number[];
  width?: number;
  dots?: boolean;
}
export interface Band {
  from: number;
  to: number;
  tone: string;
  text: string;
}
export interface Mark {
  x: number;
  y?: number;
  tone: string;
  text: string;
}

/** Charts of one `link` share their points: the cursor is an index into them. */
export interface Chart {
  id: string;
  title: string;
  link: string;
  x: {name: string; unit: string; values: number[]};
  /** Of a closed curve: x of the whole turn, where it meets its beginning. */
  period?: number;
  /** Length of a turn around a round tube, mm: x is a part of it, or an angle. */
  turn?: number;
  /** Seconds of a period, if x is time. */
  pace?: number;
  /** Of a chart over time: the angle at each of its points, which never goes back, and the developed length of a degree, mm. */
  round?: {phi: number[]; perDegree: number};
  unit: string;
  series: Series[];
  height?: number;
  bands?: Band[];
  marks?: Mark[];
  limits?: {y: number; text: string}[];
  /** Partner index per point: the strip under the curve. */
  partners?: number[];
  partnerNames?: string[];
  /** Millimetre for millimetre, kept side filled: the wrap. */
  wrap?: {lines: {x: number; text: string}[]};
  zero?: boolean; // the axis shows zero
  within?: number; // and this
}

export type Vector = [number, number, number];
export interface Frame {
  origin: Vector;
  x: Vector;
  y: Vector;
  z: Vector;
}

/**
 * Distances of the edges of a cut from their partner, mm; they tint the cut instead of the bevel,
 * up to `most`.
 */
export interface Gaps {
  inner: number[];
  outer: number[];
  most: number;
}

/** One cut end, in its own frame: z along the axis into the kept member, phi from x towards y. Degrees, mm. */
export interface CutTube {
  frame?: Frame;
  outer: number; // radii
  inner: number;
  phi: number[];
  zInner: number[];
  zOuter: number[];
  before?: {zInner: number[]; zOuter: number[]; b: number[]};
  b?: number[];
  gaps?: Gaps;
  far: number;
  marks: {phi: number; z: number; radius: number}[];
  tone: number | 'target';
}
/** Both edges of an end by phi, in degrees. */
export interface EndCurve {
  phi: number[];
  zInner: number[];
  zOuter: number[];
  b?: number[];
  gaps?: Gaps;
}
/** A member between two ends, with its holes; in the frame of the curves. */
export interface HoledTube {
  outer: number; // radii
  inner: number;
  from: EndCurve;
  to: EndCurve;
  holes: {outer: {phi: number[]; z: number[]}; inner: {phi: number[]; z: number[]}; b: number[]; gaps?: Gaps}[];
}
/** A member that is not round: both ends of each wall, column by column, and the cuts from the outer wall to the bore. */
export interface Shell {
  reach: number; // from the axis
  walls: {outer: [from: Vector[], to: Vector[]]; bore: [from: Vector[], to: Vector[]]};
  cuts: [start: ShellCut, finish: ShellCut];
  /** Cut-outs, by their edges slightly outside. */
  openings?: Vector[][];
}
export interface ShellCut {
  outer: Vector[];
  inner: Vector[];
}
export type MemberPart = HoledTube | Shell;

/** z of the points of both ends. */
export const heightsOf = (part: MemberPart): [start: number[], finish: number[]] =>
  'cuts' in part
    ? (part.cuts.map(({outer, inner}) => [...outer, ...inner].map((p) => p[2])) as [number[], number[]])
    : ([part.from, part.to].map(({zOuter, zInner}) => [...zOuter, ...zInner]) as [number[], number[]]);
export const reachOf = (part: MemberPart): number => ('cuts' in part ? part.reach : part.outer);

/** Members of a frame: parts, each in its own frame, and their positions. */
export interface Assembly {
  parts: MemberPart[];
  members: {name: string; part: number; frame: Frame; tone: string}[];
  /** The members that each item lights up. */
  lights: number[][];
  /** Where items that are no members are chosen in the picture: seen where one of the members is. */
  joints?: {at: Vector; item: number; of: number[]}[];
}
export type Partner =
  | {kind: 'tube'; point: Vector; direction: Vector; radius: number; half: number; tone: number}
  | {kind: 'cone'; point: Vector; direction: Vector; radius: number; slope: number; half: number; tone: number}
  | {kind: 'box'; point: Vector; direction: Vector; up: Vector; width: number; height: number; corner: number; half: number; tone: number}
  | {kind: 'elbow'; point: Vector; direction: Vector; inwards: Vector; radius: number; bend: number; angle: number; half: [number, number]; tone: number}
  | {kind: 'plane'; point: Vector; normal: Vector; half: number; tone: number};
/** A flat plate: contours in its own plane, the metal below it. */
export interface Plate {
  frame: Frame;
  thickness: number;
  outline: [number, number][];
  holes: [number, number][][];
}
export interface Ribbon {
  a: Vector[];
  b: Vector[];
  tone: string;
  /** Of a cut, from its inner edge to its outer one: what it is tinted by. */
  bevel?: number[];
  gaps?: Gaps;
}
/** The tool at every point of the cursor: a torch along a line of the wall, or a cone. */
export type Tool =
  | {kind: 'torch'; inner: Vector[]; outer: Vector[]; size: number; turn?: number[]} // `turn`: the angle of the tube that is under the torch, degrees
  | {kind: 'cone'; tip: number; back: number; length: number; poses: {tip: Vector; axis: Vector}[]; before?: {tip: Vector; axis: Vector}[]}; // radii at the face and at the spindle's end

export interface Solid {
  link: string;
  tool?: Tool;
  tubes: CutTube[];
  holed?: HoledTube[];
  assembly?: Assembly;
  plates?: Plate[];
  partners: Partner[];
  ribbons?: Ribbon[];
  closed?: true; // the ribbons are the whole surface of a body
  /** Openings in flat walls, each by its closed edge, drawn over the wall. */
  openings?: Vector[][];
  lines?: {points: Vector[]; tone: string}[];
  /** Initial view: the direction to the eye, and the upward direction. */
  eye?: Vector;
  up?: Vector;
  centre: Vector;
  size: number;
  /** Text alternative of the picture. */
  told?: string;
  /** Meaning of its colours. */
  legend?: {tone: string; text: string}[];
  /** Texts of the two ends of the tint. */
  scale?: [string, string];
  /** The bevels that the tint spans, in degrees. */
  tint?: [number, number];
}

/** Columns of the answer as numbers. */
export const column = (value: Json | undefined): number[] => (Array.isArray(value) ? (value as number[]) : []);
