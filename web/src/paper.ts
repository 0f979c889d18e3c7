import {onWhite} from './theme';

const frames = (count: number): Promise<void> => new Promise((done) => requestAnimationFrame(() => (count > 1 ? void frames(count - 1).then(done) : done())));

/** Lays the page out as on paper and draws it so, because pictures that are only printed would keep their size and their colours. */
function lay(on: boolean): void {
  onWhite.value = on;
  document.body.classList.toggle('paper', on);
}

/** Prints the job: the request, the verdict and whole pictures in light colours. */
export async function onPaper(): Promise<void> {
  lay(true);
  await frames(3); // the pictures follow the size of their frames
  try {
    print();
  } finally {
    lay(false);
  }
}

/** Prints only a drawing, at its own size. */
export function printDrawing(drawing: SVGSVGElement): void {
  const sheet = Object.assign(document.createElement('div'), {id: 'sheet'});
  sheet.append(drawing.cloneNode(true));
  document.body.append(sheet);
  document.body.classList.add('sheeted');
  try {
    print();
  } finally {
    document.body.classList.remove('sheeted');
    sheet.remove();
  }
}

// By the browser's own command there is no time to draw anew; the colours follow.
addEventListener('beforeprint', () => lay(true));
addEventListener('afterprint', () => lay(false));
