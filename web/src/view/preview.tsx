import {useLayoutEffect, useRef, useState} from 'preact/hooks';
import {t} from '../language';
import {point} from '../links';
import {pointLine, programLink} from '../pictures/programmed';
import {rapidSpeed, type Program} from '../program';
import {withUnit} from '../words';
import {useCursor} from './controls';

const tall = 18; // px of a line
const high = 324; // px of the text
const spare = 10; // lines drawn beyond those that are seen

/** The text of a program with its time; the line of the cursor is marked, and a line that is clicked moves the cursor. */
export function ProgramPreview({program}: {program: Program}) {
  const {lines, moves, time, length} = program;
  const box = useRef<HTMLDivElement>(null);
  const [top, scrolled] = useState(0);
  const at = useCursor(programLink);
  const line = at === null ? null : (moves[at]?.line ?? null);
  useLayoutEffect(() => {
    if (line === null || !box.current) return;
    const {scrollTop} = box.current;
    if (line * tall < scrollTop || (line + 2) * tall > scrollTop + high) box.current.scrollTop = line * tall - high / 2;
  }, [line]);
  const walk = (event: KeyboardEvent) => {
    const by = {ArrowDown: 1, ArrowUp: -1, PageDown: 20, PageUp: -20}[event.key];
    if (!by || !moves.length) return;
    event.preventDefault();
    point(programLink, Math.min(moves.length - 1, Math.max(0, (at ?? -1) + by)));
  };
  const first = Math.max(0, Math.floor(top / tall) - spare);
  const shown = lines.slice(first, first + Math.ceil(high / tall) + 2 * spare);
  return (
    <figure id="program">
      <figcaption>
        {moves.length > 0 && (
          <>
            <b id="program-time">{withUnit(time.cut + time.pierce, 's')}</b>{' '}
            {t('for {length} of cut and {pierces} pierces; rapids take about {rapids} at {speed}.', {
              length: withUnit(length, 'mm'),
              pierces: moves.filter(({kind}) => kind === 'pierce').length,
              rapids: withUnit(Math.round(time.rapid), 's'),
              speed: withUnit(rapidSpeed.mm_s, 'mm/s'),
            })}{' '}
          </>
        )}
        <span class="soft">{t('{n} lines', {n: lines.length})}</span>
      </figcaption>
      <div
        ref={box}
        class="listing"
        tabIndex={0}
        role="group"
        aria-label={t('Program. Up and down move the cursor, also in the picture.')}
        style={{height: `${high}px`}}
        onScroll={(event) => scrolled(event.currentTarget.scrollTop)}
        onKeyDown={walk}
      >
        <ol style={{height: `${lines.length * tall}px`}}>
          {shown.map((text, i) => (
            <li
              key={first + i}
              style={{top: `${(first + i) * tall}px`}}
              aria-current={first + i === line ? 'true' : undefined}
              onClick={() => pointLine(program, first + i)}
            >
              <span class="soft">{first + i + 1}</span> {text}
            </li>
          ))}
        </ol>
      </div>
    </figure>
  );
}
