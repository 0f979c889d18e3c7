import {signal} from '@preact/signals';
import frame from '../../../docs/frame.svg';
import {t} from '../language';
import {lastKey} from '../words';

// The four drawings of docs/frame.svg, and the names of the fields that each explains.
const drawings: [RegExp, string][] = [
  [/^(clocking_deg|offset_mm|phi_deg|start_phi_deg|from_phi_deg|to_phi_deg|seam_deg|datum|up)$/, '500,0,500,440'],
  [/^(inclination_deg|height_mm)$/, '0,440,500,440'],
  [/^(root_surface|rule|cap_deg|angle_deg|dihedral|contact|root_face_mm|root_gap_mm|kerf_mm|min_deg|max_deg|b_deg|max_b_deg|b_sign)$/, '500,440,500,440'],
  [/^(outer_diameter_mm|wall_mm|length_mm|size|id)$/, '0,0,500,440'],
];
const joints = /^(\/cut)?\/(cutters|target|ends|branch|chord|groove|torch|kerf_mm|root_|contact|dihedral|datum|seam_deg)/; // where the frame is the drawing's

const focused = signal<HTMLElement | null>(null);
/** For the form: which of its fields has the focus. */
export const followFocus = {
  onFocusIn: ({target}: FocusEvent) => {
    focused.value = target as HTMLElement;
  },
  onFocusOut: () => {
    focused.value = null;
  },
};

/** Explains the focused field under the form: its hint, and its drawing. */
export function Hint() {
  const field = focused.value;
  const told = field?.closest<HTMLElement>('[title]')?.title ?? '';
  const pointer = field?.dataset['pointer'] ?? '';
  const view = joints.test(pointer) ? drawings.find(([pattern]) => pattern.test(lastKey(pointer)))?.[1] : undefined;
  // Under the form and as high whatever it says: if it came and went with the focus, the form would move away under the pointer, or it would cover
  // what is clicked.
  return (
    <div id="hint">
      {view && <img src={`${frame}#svgView(viewBox(${view}))`} width={120} height={105} alt="" />}
      {told ? <p>{told}</p> : <p class="soft">{t('Choose a field to see its meaning.')}</p>}
    </div>
  );
}
