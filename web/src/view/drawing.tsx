import {useLayoutEffect, useRef} from 'preact/hooks';
import {drawingOf, namesIn} from '../drawing';
import type {Row} from '../json';
import {language, t} from '../language';
import {printDrawing} from '../paper';

interface Given {
  /** SVG of the service. */
  text: string;
  name: string;
  body: Row;
  close(): void;
}

/** A drawing on the page, with the captions in its language: to look at and to print. */
export function Drawing({text, name, body, close}: Given) {
  const frame = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const drawing = drawingOf(text, namesIn(body));
    drawing?.setAttribute('aria-label', name);
    frame.current?.replaceChildren(...(drawing ? [drawing] : []));
    frame.current?.scrollIntoView({block: 'nearest'});
  }, [text, name, body, language.value]);
  const printed = () => {
    const drawing = frame.current?.querySelector('svg');
    if (drawing) printDrawing(drawing);
  };
  return (
    <figure id="drawing">
      <figcaption>
        <b>{name}</b>
        <button type="button" class="right" id="print-drawing" onClick={printed}>
          {t('Print')}
        </button>
        <button type="button" onClick={close}>
          {t('Close')}
        </button>
      </figcaption>
      <div ref={frame} class="sheet-of" tabIndex={0} role="group" aria-label={name} />
    </figure>
  );
}
