import type {ComponentChildren} from 'preact';
import type {Figure, Table as Given} from '../picture';
import {beside, hint, sentence, text, type Term} from '../words';

export const Figures = ({figures}: {figures: Figure[]}) => (
  <>
    {figures.map(({name, value, unit, about}, i) => (
      <div key={i} class="figure" title={about}>
        <span>{sentence(name)}</span>
        <b>
          {value}
          <small>{unit ? beside('', unit) : ''}</small>
        </b>
      </div>
    ))}
  </>
);

const capital = (of: Term): Term => (typeof of === 'string' ? sentence(of) : {...of, text: sentence(of.text)});
const shape = (of: Term) => ({class: text(of).length > 40 ? 'words' : undefined, title: hint(of)});

interface SheetOf {
  title: string;
  head: Term[];
  children: ComponentChildren;
  id?: string | undefined;
  note?: string;
  whole?: boolean;
}
/** A table with its title, in a frame that scrolls. */
export const Sheet = ({title, head, children, id, note, whole}: SheetOf) => (
  <section class={whole ? 'block whole' : 'block'} id={id}>
    <h3>{title}</h3>
    {note && <p class="soft">{note}</p>}
    <div class="scroll" tabIndex={0} role="group" aria-label={title}>
      <table>
        {head.some((each) => each !== '') && (
          <thead>
            <tr>
              {head.map(capital).map((each, i) =>
                each === '' ? (
                  <td key={i} />
                ) : (
                  <th key={i} scope="col" {...shape(each)}>
                    {text(each)}
                  </th>
                ),
              )}
            </tr>
          </thead>
        )}
        <tbody>{children}</tbody>
      </table>
    </div>
  </section>
);

export const Table = ({title, head, rows, id, names}: Given) => (
  <Sheet title={title} head={head} id={id && `table-${id}`} whole={head.length > 4}>
    {rows.map((row, r) => (
      <tr key={r}>
        {row.map((each, i) => (
          <td key={i} {...shape(each)}>
            {text(i || names ? each : capital(each))}
          </td>
        ))}
      </tr>
    ))}
  </Sheet>
);
