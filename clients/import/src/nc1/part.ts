import type {Ask, NotUnderstood, Size, Source} from '../frame.js';
import type {Section} from '../sections.js';

export type Point = [number, number];
export type Piece = {kind: 'line'; to_mm: Point} | {kind: 'arc'; to_mm: Point; centre_mm: Point; sense: 'cw' | 'ccw'};

interface Turned {
  angle_deg?: number;
}
interface Cornered extends Turned {
  corners?: 'as_cut';
}
/** A shape as the contract has it. */
export type CutoutShape =
  | ({kind: 'circle'; diameter_mm: number} & Turned)
  | ({kind: 'slot'; length_mm: number; width_mm: number} & Turned)
  | ({kind: 'slit'; length_mm: number; pierce?: 'end'} & Turned)
  | ({kind: 'rectangle'; along_mm: number; round_mm: number; corner_radius_mm: number} & Cornered)
  | ({kind: 'contour'; start_mm: Point; pieces: Piece[]; mirrored?: boolean} & Cornered);

/** Round the tube: the angle on a round tube, or a face of a rectangular one. */
export type Round = {girth_mm: number} | {phi_deg: number} | {face: number; offset_mm: number};
export interface Countersink {
  diameter_mm: number;
  angle_deg: number;
}
export interface Cutout {
  id: string;
  shape: CutoutShape;
  at: {z_mm: number} & Round;
  wall?: string;
  tilt?: string;
  countersink?: Countersink;
}

export interface PlaneEnd {
  cutters: {kind: 'plane'; point_mm: [number, number, number]; normal: [number, number, number]}[];
  [field: string]: unknown;
}
export type PartEnd = {square_at_mm: number; kerf_mm?: number} | PlaneEnd;

export type Mark = {text: string; z_mm: number} & ({phi_deg: number} | {girth_mm: number});

/** A text that a tool draws, as the contract has it. */
export interface TextMark {
  id: string;
  at: {z_mm: number} & Round;
  text: string;
  height_mm: number;
  angle_deg?: number;
  mirrored?: boolean;
  over_corner?: boolean;
}

/** A request of POST /v1/parts. */
export interface Part {
  target: (Size | Section) & {id?: string; length_mm: number};
  ends: {start: PartEnd; finish: PartEnd};
  cutouts?: Cutout[];
  texts?: TextMark[];
  marks?: Mark[];
  kerf_mm: number;
  density_kg_m3?: number;
  reference?: Record<string, string | number>;
  [field: string]: unknown;
}

/** The result for one part, as that of the other importers: `part` is null if the file is refused. */
export interface ImportedPart {
  part: Part | null;
  notUnderstood: NotUnderstood[];
  asks: Ask[];
  sources: Source[];
}
