import {useLayoutEffect, useRef, useState} from 'preact/hooks';
import {language, later, t} from '../language';
import {listen} from '../links';
import {onPaper} from '../paper';
import type {Picture, Vector} from '../picture';
import type {Slice} from '../scene/slice';
import type {Stage} from '../scene/stage';
import {dark} from '../theme';
import {shownUnit, toShown} from '../units';
import {hint, number, sentence, text, withUnit} from '../words';
import {Swatch, Toggle} from './controls';

interface Given {
  picture: Picture | undefined;
  title: string;
  job: number;
  view: 'before' | 'after';
  partners: boolean;
  change(to: {view?: 'before' | 'after'; partners?: boolean}): void;
  failed(failure: unknown): void;
}

const sides = [
  ['front', later('Front'), later('Look from the front')],
  ['right', later('Right'), later('Look from the right')],
  ['top', later('Top'), later('Look from the top')],
] as const;
type Between = [Vector, Vector];

/** The distance of two points, and its parts along the axes. */
function distanceText([a, b]: Between): string {
  const [x, y, z] = [0, 1, 2].map((k) => Math.abs((b[k] as number) - (a[k] as number))) as Vector;
  const length = (value: number) => number(toShown(value, 'mm'), shownUnit('mm'));
  return `${withUnit(toShown(Math.hypot(x, y, z), 'mm'), shownUnit('mm'))}  (x ${length(x)}, y ${length(y)}, z ${length(z)})`;
}

/** The solid, its switches, and the cursor's values. */
export function Solid(given: Given) {
  const {picture, view, partners, change} = given;
  const solid = picture?.solid;
  const canvas = useRef<HTMLDivElement>(null);
  const [stage, none] = useStage(canvas, given);
  const [low, high] = solid?.scale ?? [];
  const [parallel, flatten] = useState(false);
  const [measure, setMeasure] = useState(false);
  const [between, found] = useState<Between | undefined>(undefined);
  useLayoutEffect(() => void stage.current?.then((made) => made?.parallel(parallel)), [parallel]);
  useLayoutEffect(() => {
    found(undefined);
    void stage.current?.then((made) => made?.measured(measure ? (points) => found(points && [points[0].toArray(), points[1].toArray()]) : null));
  }, [measure]);
  const [slice, setSlice] = useState<Slice | null>(null);
  const [place, setPlace] = useState<number | undefined>(undefined);
  useLayoutEffect(() => void stage.current?.then((made) => setPlace(made?.sliced(slice))), [slice, picture]);
  return (
    <div id="solid" hidden={!solid}>
      <div ref={canvas} class="canvas">
        {none && <p class="waiting">{t('No 3D here: {why}', {why: none})}</p>}
      </div>
      <div class="switches" id="switches">
        {picture?.beforeAfter && (
          <span class="pair" role="group" aria-label={t('Bevel before or after smoothing')}>
            <Toggle id="view-before" pressed={view === 'before'} act={() => change({view: 'before'})}>
              {t('Before')}
            </Toggle>
            <Toggle id="view-after" pressed={view === 'after'} act={() => change({view: 'after'})}>
              {t('After')}
            </Toggle>
          </span>
        )}
        {solid && solid.partners.length > 0 && (
          <Toggle id="view-partners" pressed={partners} act={() => change({partners: !partners})}>
            {t('Partners')}
          </Toggle>
        )}
        <button type="button" title={t('Back to the first view')} onClick={() => stage.current?.then((made) => made?.reset())}>
          {t('Reset view')}
        </button>
        <button type="button" id="print" title={t('The request, the pictures and the tables on paper, in light colours')} onClick={() => void onPaper()}>
          {t('Print')}
        </button>
      </div>
      <div class="views" role="group" aria-label={t('Views')}>
        {sides.map(([side, name, about]) => (
          <button type="button" key={side} data-side={side} title={t(about)} onClick={() => stage.current?.then((made) => made?.look(side))}>
            {t(name)}
          </button>
        ))}
        <Toggle id="view-parallel" pressed={parallel} act={() => flatten(!parallel)}>
          {t('Parallel')}
        </Toggle>
        <Toggle id="view-measure" pressed={measure} act={() => setMeasure(!measure)}>
          {t('Measure')}
        </Toggle>
        <Toggle id="view-section" pressed={slice !== null} act={() => setSlice(slice ? null : {axis: 'x', share: 0.5, other: false})}>
          {t('Section')}
        </Toggle>
        {slice && <Slicing slice={slice} place={place} change={setSlice} />}
        {measure && <output id="measured">{between ? distanceText(between) : t('Click two points of the model.')}</output>}
      </div>
      <div class="scale" id="scale" hidden={low === undefined && !solid?.legend}>
        {solid?.legend ? (
          solid.legend.map(({tone, text: said}) => (
            <span class="key" key={tone}>
              <Swatch tone={tone} /> {said}
            </span>
          ))
        ) : (
          <>
            {low}
            <i />
            {high}
          </>
        )}
      </div>
      {solid && picture && <Readout picture={picture} />}
    </div>
  );
}

/** The place of the section: its axis, its position, the half that is kept. */
function Slicing({slice, place, change}: {slice: Slice; place: number | undefined; change(to: Slice): void}) {
  const {axis, share, other} = slice;
  const said = place === undefined ? '' : withUnit(place, 'mm');
  return (
    <span class="slicing">
      <select aria-label={t('Axis of the section')} value={axis} onChange={({currentTarget}) => change({...slice, axis: currentTarget.value as Slice['axis']})}>
        {(['x', 'y', 'z'] as const).map((each) => (
          <option key={each}>{each}</option>
        ))}
      </select>
      <input
        type="range"
        min={0}
        max={1}
        step={0.005}
        value={share}
        aria-label={t('Place of the section')}
        aria-valuetext={said}
        onInput={({currentTarget}) => change({...slice, share: Number(currentTarget.value)})}
      />
      <output id="sliced">{said}</output>
      <Toggle id="view-other" pressed={other} act={() => change({...slice, other: !other})}>
        {t('Other half')}
      </Toggle>
    </span>
  );
}

/**
 * Draws the picture on the stage, whose code is large and loads at its first use. Returns the
 * reason if it cannot.
 */
function useStage(canvas: {current: HTMLElement | null}, {picture, title, job, view, partners, failed}: Given) {
  const stage = useRef<Promise<Stage | null> | undefined>(undefined);
  const latest = useRef(picture);
  const [none, say] = useState('');
  latest.current = picture;
  const build = async () => {
    try {
      const {Stage: Made} = await import('../scene/stage');
      return new Made(canvas.current as HTMLElement);
    } catch (failure) {
      say(String(failure));
      return null;
    }
  };
  useLayoutEffect(() => {
    const solid = picture?.solid;
    if (!solid) return;
    stage.current ??= build();
    stage.current
      .then((made) => {
        if (!made || latest.current !== picture) return;
        made.show(solid, view === 'before' && picture.beforeAfter === true, t('{title} in 3D', {title}), job);
        made.partnersShown(partners);
      })
      .catch(failed);
  }, [picture, view, partners, dark.value, language.value]);
  return [stage, none] as const;
}

/** The values under the cursor. Its rows exist from the start, so that nothing moves. */
function Readout({picture}: {picture: Picture}) {
  const links = [...new Set(picture.charts.map((chart) => chart.link))];
  const first = links[0] ?? '';
  const [{index, link, of}, move] = useState<{index: number | null; link: string; of?: Picture}>({index: null, link: first});
  useLayoutEffect(() => {
    const forget = links.map((each) => listen(each, (at) => move({index: at, link: each, of: picture})));
    return () => forget.forEach((each) => each());
  }, [picture]);
  const idle = index === null || of !== picture;
  const rows = links.length ? (picture.readout?.(idle ? 0 : index, idle ? first : link) ?? []) : [];
  return (
    <dl
      id="readout"
      class={idle ? 'idle' : ''}
      title={idle && rows.length ? t('Point at a chart or at the cut, or use the arrow keys: the cursor moves in every view.') : undefined}
    >
      {rows.map(([name, value], i) => (
        <div key={i} title={hint(name)}>
          <dt>{sentence(text(name))}</dt>
          <dd>{idle ? '–' : value}</dd>
        </div>
      ))}
    </dl>
  );
}
