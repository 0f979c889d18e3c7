import {useLayoutEffect, useMemo, useRef} from 'preact/hooks';
import {described, lettered, Plot, walk} from '../charts';
import type {Chart} from '../picture';
import {inShownUnits} from '../pictures/units';
import {dark} from '../theme';
import {system} from '../units';

interface Given {
  charts: Chart[];
  failed(failure: unknown): void;
  id?: string;
  class?: string;
}
type Attempt = (act: () => void) => void;

/** Charts of one kind are given new data instead of being made anew. */
const kind = ({id, link, x, series}: Chart) => [id, link, x.unit, dark.value, ...series.map((s) => s.name + s.tone)].join();

/** A column of charts, which draw themselves. */
export function Charts({charts: given, failed, ...more}: Given) {
  const charts = useMemo(() => given.map(inShownUnits), [given, system.value]);
  const root = useRef<HTMLDivElement>(null);
  const plots = useRef(new Set<Plot>());
  const kinds = charts.map(kind);
  const attempt: Attempt = (act) => {
    try {
      act();
    } catch (failure) {
      failed(failure);
    }
  };
  const measure = () => plots.current.forEach((plot) => plot.measured());
  useLayoutEffect(() => new ResizeObserver(measure).observe(root.current as HTMLElement), []);
  useLayoutEffect(measure, [kinds.join()]); // each has made room for the next
  return (
    <div ref={root} {...more}>
      {charts.map((chart, i) => (
        <Figure key={kinds[i]} chart={chart} plots={plots.current} attempt={attempt} />
      ))}
    </div>
  );
}

function Figure({chart, plots, attempt}: {chart: Chart; plots: Set<Plot>; attempt: Attempt}) {
  const frame = useRef<HTMLDivElement>(null);
  const plot = useRef<Plot | undefined>(undefined);
  useLayoutEffect(() => {
    attempt(() => {
      plot.current = new Plot(frame.current as HTMLElement, chart);
      plots.add(plot.current);
    });
    return () => {
      plot.current?.end();
      if (plot.current) plots.delete(plot.current);
    };
  }, []);
  useLayoutEffect(() => attempt(() => plot.current?.update(chart)), [chart]);
  return (
    <figure id={`chart-${chart.id}`} class="chart">
      <Caption chart={chart} />
      <div
        ref={frame}
        class="plot"
        tabIndex={0}
        role="img"
        aria-label={described(chart)}
        data-points={chart.x.values.length}
        onKeyDown={(event) => walk(chart, event)}
      />
    </figure>
  );
}

/** The title, and the legend of lines and colours. */
function Caption({chart}: {chart: Chart}) {
  const {title, unit, series, bands = [], marks = []} = chart;
  const others = new Map([...bands, ...(lettered(chart) ? [] : marks)].map(({text, tone}) => [text, tone]));
  return (
    <figcaption>
      <b>
        {title}
        <small>{unit ? `, ${unit}` : ''}</small>
      </b>
      <span class="keys">
        {series.map(({name, tone, dash, about}) => (
          <span key={name} class="key" title={about}>
            <i class={dash ? 'dashed' : ''} style={{borderColor: `var(--${tone})`}} />
            {name}
          </span>
        ))}
        {[...others].map(([text, tone]) => (
          <span key={text} class="key">
            <i class="patch" style={{background: `var(--${tone})`}} />
            {text}
          </span>
        ))}
      </span>
    </figcaption>
  );
}
