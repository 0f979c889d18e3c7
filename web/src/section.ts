import {el, svg} from './dom';
import {listen, pointed} from './links';
import type {Section} from './picture';

/** A plane cut through at the cursor, drawn at one scale: as high as it needs to be. */
export class SectionView {
  private forget: (() => void) | null = null;

  constructor(private readonly root: HTMLElement) {}

  show(given: Section | undefined): void {
    this.forget?.();
    this.forget = given ? listen(given.link, (index) => this.draw(given, index ?? 0)) : null;
    this.root.hidden = !given;
    if (given) this.draw(given, pointed(given.link) ?? 0);
  }

  private draw(given: Section, index: number): void {
    const {title, lines} = given.at(index);
    const [left, bottom] = given.low;
    const [width, height] = [given.high[0] - left, given.high[1] - bottom];
    const drawn = lines.map(({points, tone, dashed}) =>
      svg('polygon', {
        points: points.map(([x, y]) => `${(x - left).toFixed(3)},${(given.high[1] - y).toFixed(3)}`).join(' '),
        'stroke-dasharray': dashed ? '5 4' : null,
        'vector-effect': 'non-scaling-stroke',
        'data-tone': tone,
      }),
    );
    const bar = width > 60 ? 10 : width > 12 ? 5 : 1;
    const ruler = svg('line', {
      x1: width - bar - 0.03 * width,
      x2: 0.97 * width,
      y1: 0.95 * height,
      y2: 0.95 * height,
      class: 'ruler',
      'vector-effect': 'non-scaling-stroke',
    });
    this.root.replaceChildren(
      el('figcaption', {}, el('b', {}, title), el('span', {class: 'soft'}, `the bar is ${bar} mm`)),
      svg('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': title}, ...drawn, ruler),
    );
  }
}
