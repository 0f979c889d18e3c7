import {t} from '../language';
import type {Section} from '../picture';
import {withUnit} from '../words';
import {useCursor} from './controls';

const thin = {'vector-effect': 'non-scaling-stroke'};

/** A plane cut through at the cursor, drawn at one scale: as high as it needs to be. */
export function SectionView({given: {link, low, high, at}}: {given: Section}) {
  const {title, lines, points, note} = at(useCursor(link) ?? 0);
  const [left, bottom] = low;
  const [width, height] = [high[0] - left, high[1] - bottom];
  const bar = width > 60 ? 10 : width > 12 ? 5 : 1;
  return (
    <>
      <figcaption>
        <b>{title}</b>
        {note && <span>{note}</span>}
        <span class="soft">{t('the bar is {length}', {length: withUnit(bar, 'mm')})}</span>
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
        {points?.map(({at: [x, y], text}) => (
          <g key={text} data-point={text}>
            <circle cx={x - left} cy={high[1] - y} r={height / 90} />
            <text x={x - left + height / 45} y={high[1] - y - height / 60} font-size={height / 17}>
              {text}
            </text>
          </g>
        ))}
        <line {...thin} class="ruler" x1={width - bar - 0.03 * width} x2={0.97 * width} y1={0.95 * height} y2={0.95 * height} />
      </svg>
    </>
  );
}
