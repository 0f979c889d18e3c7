import type {Figure, Table as Given} from '../picture';
import {hint, sentence, text, type Term} from '../words';

export const Figures = ({figures}: {figures: Figure[]}) => (
  <>
    {figures.map(({name, value, unit, about}, i) => (
      <div key={i} class="figure" title={about}>
        <span>{sentence(name)}</span>
        <b>
          {value}
          <small>{unit ? `${unit === '°' ? '' : ' '}${unit}` : ''}</small>
        </b>
      </div>
    ))}
  </>
);

const capital = (of: Term): Term => (typeof of === 'string' ? sentence(of) : {...of, text: sentence(of.text)});
const shape = (of: Term) => ({class: text(of).length > 40 ? 'words' : undefined, title: hint(of)});

export function Table({title, head, rows, id, names}: Given) {
  return (
    <section class={head.length > 4 ? 'block whole' : 'block'} id={id && `table-${id}`}>
      <h3>{title}</h3>
      <div class="scroll" tabIndex={0} role="group" aria-label={title}>
        <table>
          {head.some((each) => each !== '') && (
            <thead>
              <tr>
                {head.map(capital).map((each, i) => (
                  <th key={i} scope="col" {...shape(each)}>
                    {text(each)}
                  </th>
                ))}
              </tr>
            </thead>
          )}
          <tbody>
            {rows.map((row, r) => (
              <tr key={r}>
                {row.map((each, i) => (
                  <td key={i} {...shape(each)}>
                    {text(i || names ? each : capital(each))}
                  </td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}
