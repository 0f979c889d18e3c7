import type {Section} from '../picture';
import {withUnit} from '../words';
import {useCursor} from './controls';

const thin = {'vector-effect': 'non-scaling-stroke'};

/** A plane cut through at the cursor, drawn at one scale: as high as it needs to be. */
export function SectionView({given: {link, low, high, at}}: {given: Section}) {
  const {title, lines} = at(useCursor(link) ?? 0);
  const [left, bottom] = low;
  const [width, height] = [high[0] - left, high[1] - bottom];
  const bar = width > 60 ? 10 : width > 12 ? 5 : 1;
  return (
    <>
      <figcaption>
        <b>{title}</b>
        <span class="soft">the bar is {withUnit(bar, 'mm')}</span>
      </figcaption>
      <svg viewBox={`0 0 ${width} ${height}`} role="img" aria-label={title}>
        {lines.map(({points, tone, dashed}, i) => (
          <polygon
            key={i}
            {...thin}
            points={points.map(([x, y]) => `${(x - left).toFixed(3)},${(high[1] - y).toFixed(3)}`).join(' ')}
            stroke-dasharray={dashed ? '5 4' : undefined}
            data-tone={tone}
          />
        ))}
        <line {...thin} class="ruler" x1={width - bar - 0.03 * width} x2={0.97 * width} y1={0.95 * height} y2={0.95 * height} />
      </svg>
    </>
  );
}
