import {isTabled, type Option, type Values} from '../files';
import {chinese, t} from '../language';
import {about, choice, label, plain, sentence, unit} from '../words';

interface Given {
  option: Option;
  values: Values;
  /** Names that the service lists, each with what it is. */
  listed: [value: string, text: string][] | undefined;
  complaint: string | undefined;
  change(value: string): void;
}

/** A description of the contract; if it is not translated, the sentence of the glossary. */
const explained = (description: string, name: string) => (chinese() && t(description) === description ? about(name, 'download') : plain(t(description)));

/** One option of a file: a choice, ticks or a value, and what is said against it. */
export function FileOption(given: Given) {
  const {option, complaint} = given;
  const {name, description, schema} = option;
  const id = complaint === undefined ? undefined : `file-complaint-${name}`;
  const told = complaint && (
    <p class="complaint" id={id}>
      {complaint}
    </p>
  );
  if (schema.items || name === 'acknowledge')
    return (
      <div class="ticks-of">
        <Ticks {...given} />
        {told}
      </div>
    );
  return (
    <label class="field" title={explained(description, name)}>
      <span class="name">{sentence(label(name, 'download'))}</span>
      <span class="box">
        <Entry {...given} described={id} />
        {unit(name) && <span class="unit">{unit(name)}</span>}
      </span>
      {told}
    </label>
  );
}

/** A list of choices: a box to tick for each. */
function Ticks({option: {name, description, schema}, values, listed, change}: Given) {
  const offered: [string, string][] = listed ?? ((schema.items as {enum: string[]}).enum.map((each) => [each, choice(each)]) as [string, string][]);
  const chosen = new Set((values[name] ?? '').split(',').filter(Boolean));
  const tick = (each: string) =>
    change(
      offered
        .map(([other]) => other)
        .filter((other) => chosen.has(other) !== (other === each))
        .join(','),
    );
  if (!offered.length) return null;
  return (
    <fieldset class="field ticks" title={explained(description, name)}>
      <legend class="name">{sentence(label(name, 'download'))}</legend>
      {offered.map(([each, text]) => (
        <label key={each} class="tick">
          <input type="checkbox" value={each} data-option={name} checked={chosen.has(each)} onChange={() => tick(each)} />
          {text}
        </label>
      ))}
    </fieldset>
  );
}

function Entry({option: {name, schema}, values, listed, complaint, change, described}: Given & {described: string | undefined}) {
  const value = values[name] ?? '';
  const choices: [string, string][] | undefined =
    listed ?? (schema.enum ?? (schema.type === 'boolean' ? ['false', 'true'] : undefined))?.map((each) => [String(each), choice(each)]);
  const shared = {'data-option': name, value, 'aria-invalid': complaint ? ('true' as const) : undefined, 'aria-describedby': described};
  if (choices)
    return (
      <select {...shared} onChange={(event) => change(event.currentTarget.value)}>
        <option value="">{schema.default === undefined ? '–' : t('{value} (default)', {value: choice(schema.default)})}</option>
        {choices.map(([each, text]) => (
          <option key={each} value={each}>
            {text}
          </option>
        ))}
      </select>
    );
  const otherwise = isTabled(name, values) ? t('from the table') : String(schema.default ?? '');
  const numeric = schema.type === 'number' || schema.type === 'integer';
  return (
    <input
      type="text"
      inputMode={numeric ? 'decimal' : 'text'}
      placeholder={otherwise}
      {...shared}
      onInput={({currentTarget}) => change(numeric ? currentTarget.value.replace(',', '.') : currentTarget.value)}
    />
  );
}
