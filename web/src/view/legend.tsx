import {lettered} from '../charts';
import {t} from '../language';
import type {Chart} from '../picture';
import {number, withUnit} from '../words';
import {useCursor} from './controls';

interface Given {
  chart: Chart;
  hidden: ReadonlySet<string>;
  /** Hides an entry, or shows it again. */
  hide(name: string): void;
  /** Ends the zoom, if there is one. */
  whole: (() => void) | undefined;
}

/** The title, and the legend of lines and colours: an entry that is clicked is hidden, and clicked again shown. */
export function Caption({chart, hidden, hide, whole}: Given) {
  const {title, unit, series, bands = [], marks = []} = chart;
  const others = new Map([...bands, ...(lettered(chart) ? [] : marks)].map(({text, tone}) => [text, tone]));
  const turned = (name: string) => (hidden.has(name) ? t('Click to show it.') : t('Click to hide it.'));
  const pressed = (name: string) => ({type: 'button' as const, class: 'key', 'aria-pressed': !hidden.has(name), onClick: () => hide(name)});
  return (
    <figcaption>
      <b>
        {title}
        <small>{unit ? `, ${t(unit)}` : ''}</small>
      </b>
      <span class="keys">
        {series.map(({name, tone, dash, about}) => (
          <button key={name} {...pressed(name)} title={[about, turned(name)].filter(Boolean).join(' ')}>
            <i class={dash ? 'dashed' : ''} style={{borderColor: `var(--${tone})`}} />
            {name}
          </button>
        ))}
        {[...others].map(([text, tone]) => (
          <button key={text} {...pressed(text)} title={turned(text)}>
            <i class="patch" style={{background: `var(--${tone})`}} />
            {text}
          </button>
        ))}
      </span>
      {whole && (
        <button type="button" class="unzoom" title={t('Show the whole axis again (double click, or 0)')} onClick={whole}>
          {t('Whole axis')}
        </button>
      )}
    </figcaption>
  );
}

/** The values under the cursor, on the side of the chart that the cursor leaves free. */
export function Under({chart, hidden}: {chart: Chart; hidden: ReadonlySet<string>}) {
  const {link, x, unit, series} = chart;
  const at = useCursor(link);
  const count = x.values.length;
  if (at === null || !count || at > count) return null;
  const index = at === count ? 0 : at; // a closed curve ends where it begins
  const shown = series.filter(({name, values}) => !hidden.has(name) && typeof values[index] === 'number');
  return (
    <output class={`under ${index > count / 2 ? 'left' : 'right'}`}>
      <span>{withUnit(x.values[index] as number, x.unit)}</span>
      {shown.map(({name, tone, values}) => (
        <span key={name}>
          <i style={{background: `var(--${tone})`}} /> {number(values[index] as number, unit)}
        </span>
      ))}
    </output>
  );
}
