import {useEffect, useLayoutEffect, useMemo, useRef, useState} from 'preact/hooks';
import {described, narrowed, Plot, walk} from '../charts';
import {language, later, t} from '../language';
import {point, pointed} from '../links';
import type {Chart} from '../picture';
import {axesOf, chooseAxis, chosenAxis, over, usualAxis, warned, type Axis} from '../pictures/axis';
import {inShownUnits} from '../pictures/units';
import type {Warning} from '../service';
import {dark} from '../theme';
import {system} from '../units';
import {Caption, Under} from './legend';

interface Given {
  charts: Chart[];
  failed(failure: unknown): void;
  /** Shown where they apply. */
  warnings?: Warning[] | undefined;
  /** Of another job the axes are whole again. */
  job?: number;
  id?: string;
  class?: string;
}
type Attempt = (act: () => void) => void;
type Span = [number, number];

/** Charts of one kind are given new data instead of being made anew. */
const kind = ({id, link, x, series}: Chart) => [id, link, x.unit, dark.value, language.value, ...series.map((s) => s.name + s.tone)].join();
/** Charts with one axis are zoomed together. */
const axisOf = ({link, x, wrap}: Chart) => [link, x.name, x.unit, wrap ? 'wrap' : ''].join();
const axisNames: Record<Axis, string> = {mm: later('Developed length'), '°': later('Angle φ'), s: later('Time')};

/** A column of charts, which draw themselves. */
export function Charts({charts: given, failed, warnings, job, ...more}: Given) {
  const offered = useMemo(() => [...new Set(given.flatMap(axesOf))], [given]);
  const chosen = chosenAxis.value;
  const axis = chosen && offered.includes(chosen) ? chosen : usualAxis(given);
  const charts = useMemo(() => warned(given, warnings ?? []).map((chart) => inShownUnits(over(chart, axis))), [given, warnings, axis, system.value]);
  const [zooms, zoom] = useState<Record<string, Span | undefined>>({});
  useEffect(() => zoom({}), [job, axis, system.value]);
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
  /** The cursor stays where it is, though charts with another axis are made anew. */
  const turn = (to: Axis) => {
    const held = charts.map(({link}) => [link, pointed(link)] as const);
    chooseAxis(to);
    requestAnimationFrame(() => requestAnimationFrame(() => held.forEach(([link, at]) => point(link, at))));
  };
  return (
    <div ref={root} {...more}>
      {offered.length > 1 && (
        <span class="pair axes" role="group" aria-label={t('Axis of the charts')}>
          {offered.map((each) => (
            <button type="button" key={each} data-axis={each} aria-pressed={each === axis} onClick={() => turn(each)}>
              {t(axisNames[each])}
            </button>
          ))}
        </span>
      )}
      {charts.map((chart, i) => (
        <Figure
          key={kinds[i]}
          chart={chart}
          plots={plots.current}
          attempt={attempt}
          span={zooms[axisOf(chart)]}
          zoom={(span) => zoom({...zooms, [axisOf(chart)]: span})}
        />
      ))}
    </div>
  );
}

interface Framed {
  chart: Chart;
  plots: Set<Plot>;
  attempt: Attempt;
  span: Span | undefined;
  zoom(span: Span | undefined): void;
}
function Figure({chart, plots, attempt, span, zoom}: Framed) {
  const frame = useRef<HTMLDivElement>(null);
  const plot = useRef<Plot | undefined>(undefined);
  const latest = useRef(zoom);
  latest.current = zoom;
  const [hidden, hide] = useState<ReadonlySet<string>>(new Set());
  useLayoutEffect(() => {
    attempt(() => {
      plot.current = new Plot(frame.current as HTMLElement, chart, (next) => latest.current(next));
      plots.add(plot.current);
    });
    return () => {
      plot.current?.end();
      if (plot.current) plots.delete(plot.current);
    };
  }, []);
  useLayoutEffect(() => attempt(() => plot.current?.update(chart)), [chart]);
  useLayoutEffect(() => attempt(() => plot.current?.zoom(span)), [span]);
  useLayoutEffect(() => attempt(() => plot.current?.hide(hidden)), [hidden]);
  const toggle = (name: string) => hide(new Set(hidden.has(name) ? [...hidden].filter((each) => each !== name) : [...hidden, name]));
  return (
    <figure id={`chart-${chart.id}`} class="chart">
      <Caption chart={chart} hidden={hidden} hide={toggle} whole={span && (() => zoom(undefined))} />
      <div
        ref={frame}
        class="plot"
        tabIndex={0}
        role="img"
        aria-label={described(chart)}
        data-points={chart.x.values.length}
        data-span={span?.join(' ')}
        onKeyDown={(event) => walk(chart, event, (by) => chart.wrap || zoom(narrowed(chart, span, by)))}
      />
      <Under chart={chart} hidden={hidden} />
    </figure>
  );
}
