import {useEffect, useRef, useState} from 'preact/hooks';
import {t} from '../language';
import {point} from '../links';
import type {Played} from '../picture';
import {withUnit} from '../words';
import {useCursor} from './controls';

const longest = 20; // s that a whole schedule plays for; a shorter one in its own time
const calm = matchMedia('(prefers-reduced-motion: reduce)');

/** A time axis to play and to scrub: it moves the cursor of its link, and with it every view. Where motion is unwanted it steps from event to event. */
export function Player({given: {link, seconds, events, segments}}: {given: Played}) {
  const running = useRef(0);
  const [playing, tell] = useState(false);
  const [, look] = useState(calm.matches);
  const last = seconds.length - 1;
  const whole = seconds[last] ?? 0;
  const at = Math.min(useCursor(link) ?? 0, last);
  const event = [...events].reverse().find((each) => each.at <= at);
  const now = seconds[at] ?? 0;
  const stop = () => {
    cancelAnimationFrame(running.current);
    tell(false);
  };
  useEffect(() => stop, [seconds]);
  useEffect(() => {
    const changed = () => {
      stop();
      look(calm.matches);
    };
    calm.addEventListener('change', changed);
    return () => calm.removeEventListener('change', changed);
  }, []);
  const step = () => point(link, [...events.map((each) => each.at), last].find((each) => each > at) ?? 0);
  const play = () => {
    const speed = Math.max(1, whole / longest);
    const from = at >= last ? 0 : now;
    const began = performance.now();
    const next = (time: number) => {
      const reached = seconds.findIndex((each) => each >= from + (Math.max(0, time - began) / 1000) * speed);
      point(link, reached < 0 ? last : reached);
      if (reached < 0) stop();
      else running.current = requestAnimationFrame(next);
    };
    running.current = requestAnimationFrame(next);
    tell(true);
  };
  const time = withUnit(Number(now.toFixed(1)), 's');
  return (
    <>
      <button type="button" id="play" onClick={calm.matches ? step : playing ? stop : play}>
        {calm.matches ? t('Next event') : playing ? t('Pause') : t('Play')}
      </button>
      <input
        type="range"
        min={0}
        max={last}
        value={at}
        aria-label={t('Time')}
        aria-valuetext={event ? t('{time}, after {event}', {time, event: event.text}) : time}
        title={t('The time in the schedule: the cursor and the tool follow.')}
        onInput={({currentTarget}) => point(link, Number(currentTarget.value))}
      />
      {segments && (
        <div class="timeline" role="img" aria-label={t('Time line: {events}', {events: events.map((each) => each.text).join(', ')})}>
          {segments.map(({from, to, tone, text}, i) => (
            <i
              key={i}
              title={text}
              style={{flexGrow: to - from, background: `var(--${tone})`}}
              onClick={() =>
                point(
                  link,
                  seconds.findIndex((each) => each >= from),
                )
              }
            />
          ))}
        </div>
      )}
      <output class="soft">{[t('{now} of {whole} s', {now: now.toFixed(1), whole: whole.toFixed(1)}), ...(event ? [event.text] : [])].join(' · ')}</output>
    </>
  );
}
