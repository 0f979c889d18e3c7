import frame from '../../docs/frame.svg';
import {el} from './dom';
import type {Json} from './json';
import type {Schema} from './schema';
import type {Issue} from './service';
import {number, unit} from './units';
import {about, choice, holder, label, lastKey, plain, sentence} from './words';

// The four drawings of docs/frame.svg: which of them shows what a field means, by its name.
const drawings: [RegExp, string][] = [
  [/^(clocking_deg|offset_mm|phi_deg|start_phi_deg|from_phi_deg|to_phi_deg|seam_deg|datum|up)$/, '500,0,500,440'],
  [/^(inclination_deg|height_mm)$/, '0,440,500,440'],
  [/^(root_surface|rule|cap_deg|angle_deg|dihedral|contact|root_face_mm|root_gap_mm|kerf_mm|min_deg|max_deg|b_deg|max_b_deg|b_sign)$/, '500,440,500,440'],
  [/^(outer_diameter_mm|wall_mm|length_mm|size|id)$/, '0,0,500,440'],
];
const joints = /^(\/cut)?\/(cutters|target|ends|branch|chord|groove|torch|kerf_mm|root_|contact|dihedral|datum|seam_deg)/; // where the frame is the drawing's

/** What the focused field means, under the form: its hint, and the drawing that shows it. */
export function hints(form: HTMLElement, place: HTMLElement): void {
  form.addEventListener('focusin', (event) => {
    const field = event.target as HTMLElement;
    const told = field.closest<HTMLElement>('[title]')?.title ?? '';
    const pointer = field.dataset['pointer'] ?? '';
    const view = joints.test(pointer) ? drawings.find(([pattern]) => pattern.test(lastKey(pointer)))?.[1] : undefined;
    place.hidden = told === '';
    place.replaceChildren(view ? el('img', {src: `${frame}#svgView(viewBox(${view}))`, width: '150', height: '132', alt: ''}) : '', el('p', {}, told));
  });
  form.addEventListener('focusout', () => {
    place.hidden = true;
  });
}

export const called = (pointer: string) => label(lastKey(pointer), holder(pointer));

/** What a field is, its range and its default. */
export function hintOf(schema: Schema, pointer: string): string {
  const mark = unit(lastKey(pointer));
  const of = (value: number) => `${Math.abs(value) < 1e-6 ? 0 : Number(value.toPrecision(4))}${mark && mark !== '°' ? ' ' : ''}${mark}`;
  const low = schema.minimum ?? schema.exclusiveMinimum,
    high = schema.maximum ?? schema.exclusiveMaximum;
  const range =
    low === undefined ? (high === undefined ? '' : `At most ${of(high)}.`) : high === undefined ? `At least ${of(low)}.` : `From ${of(low)} to ${of(high)}.`;
  const otherwise = schema.default === undefined || typeof schema.default === 'object' ? '' : `Without it: ${choice(schema.default)}.`;
  const told = schema.description ? plain(schema.description).replace(/\.?$/, '.') : '';
  return [`${sentence(called(pointer))}.`, about(lastKey(pointer), holder(pointer)), sentence(told), range, otherwise].filter(Boolean).join(' ');
}

/** What counts where nothing is entered. */
export const offered = (value: Json): string => {
  if (typeof value === 'number') return String(Number(value.toPrecision(6)));
  return Array.isArray(value) ? value.map(offered).join(', ') : choice(value);
};

/** What a problem says of a field. */
export function said(issue: Issue): string {
  const code = choice(issue.code);
  const bound = typeof issue.limit === 'number' ? number(issue.limit) : issue.limit;
  const limit = bound === null || bound === undefined || typeof bound === 'object' ? '' : ` (limit ${bound} ${issue.unit})`;
  return sentence(issue.hint ? `${code}: ${plain(issue.hint)}` : plain(`${code}${limit}`).trim());
}
