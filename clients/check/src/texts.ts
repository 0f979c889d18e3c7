/** Texts of parts: their strokes against the grid of the font (docs/theory/cutouts.md, section 7). */
import type {Scope} from './report.js';
import type {Body, Numbers} from './solids.js';
import {RAD} from './space.js';

const list = (v: unknown) => (v ?? []) as Body[];
const num = (v: unknown): number => (typeof v === 'number' ? v : 0);

/** The strokes of a text: as requested, from end to end, and each from grid to grid of its letter. */
function checkLettering(scope: Scope, texts: Body[], mark: Body): void {
  const drawn = mark.lettering as Body & Numbers;
  const text = texts.find(({id}) => id === drawn.id);
  const name = String(mark.text);
  scope.same('texts', text?.text === name && (text?.mirrored ?? false) === drawn.mirrored ? 0 : 1, 0, 0, '', name);
  scope.same('texts', drawn.angle_deg, num(text?.angle_deg as number), 1e-9, 'deg', name);
  scope.same('texts', drawn.height_mm, num(text?.height_mm as number), 1e-12, 'mm', name);
  const strokes = list(drawn.strokes) as unknown as {[column: string]: number[]}[];
  const z = strokes.flatMap((stroke) => stroke.z_mm);
  scope.same('texts', mark.z_from_mm as number, Math.min(...z), 1e-10, 'mm', name);
  scope.same('texts', mark.z_to_mm as number, Math.max(...z), 1e-10, 'mm', name);
  const half = drawn.height_mm / 14; // of a unit of the grid
  const [c, s] = [Math.cos(drawn.angle_deg * RAD), Math.sin(drawn.angle_deg * RAD)];
  for (const {z_mm, girth_mm} of strokes)
    for (const i of [0, z_mm.length - 1]) {
      const [dz, ds] = [z_mm[i] - drawn.z_mm, girth_mm[i] - (mark.girth_mm as number)];
      for (const way of [dz * c + ds * s, ds * c - dz * s]) scope.most('texts', Math.abs(way - half * Math.round(way / half)), 1e-7, 'mm', name);
    }
  scope.covers(...['z_mm', 'angle_deg', 'height_mm', 'strokes/*/z_mm', 'strokes/*/girth_mm'].map((field) => `marks/*/lettering/${field}`));
}

export function checkTexts(scope: Scope, request: Body, result: Body): void {
  for (const mark of list(result.marks).filter(({kind}) => kind === 'text')) checkLettering(scope, list(request.texts), mark);
}
