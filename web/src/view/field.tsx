import {useComputed} from '@preact/signals';
import {createContext} from 'preact';
import {useContext, useEffect, useRef} from 'preact/hooks';
import {listed, nudge, scrub, typed, type Form} from '../form';
import {called, hintOf, offered} from '../hint';
import {at, isRow, type Json} from '../json';
import {t} from '../language';
import type {Schema} from '../schema';
import {entered, shownUnit} from '../units';
import {choice, lastKey, sentence, unit} from '../words';
import {Combo as Search} from './combo';

export const Fields = createContext<Form | null>(null);
export const useForm = () => useContext(Fields) as Form;

/** One value of the request, in place. */
export interface Value {
  schema: Schema;
  value: Json | undefined;
  pointer: string;
}

const inlineList = 6; // longer lists of numbers get a text area
const fileText = 4096; // texts that may be longer are files
const inlineText = 28; // and so do those of more characters, which a phone's line holds

export function simple(form: Form, schema: Schema): boolean {
  if (schema.oneOf) return form.contract.branches(schema).every((branch) => simple(form, branch));
  return schema.enum !== undefined || 'const' in schema || ['number', 'integer', 'string', 'boolean', 'null'].includes(schema.type ?? '');
}

/** Points, directions, pairs: a field like a number is. */
export function short(form: Form, schema: Schema): boolean {
  const item = schema.items && form.contract.resolve(schema.items);
  return schema.type === 'array' && item !== undefined && !item.properties && !item.oneOf && (schema.maxItems ?? 99) <= inlineList;
}

/** Texts, one a line. */
export const texts = (form: Form, schema: Schema): boolean => schema.type === 'array' && form.contract.resolve(schema.items ?? {}).type === 'string';

/** Complaints about the value of a pointer. */
export function Complaints({at: pointer}: {at: string}) {
  const {complaints} = useForm();
  const own = useComputed(() => complaints.value.get(pointer)).value;
  return own ? (
    <>
      {own.map(({id, text, original}) => (
        <p key={id} class="complaint" id={id}>
          {text}
          <Original text={original} />
        </p>
      ))}
    </>
  ) : null;
}

/** The service's own English words, small under their Chinese. */
export const Original = ({text}: {text: string}) =>
  text ? (
    <small class="original" lang="en">
      {text}
    </small>
  ) : null;

/** Links an element to its complaints for screen readers, without drawing anything anew. */
export function useTold(pointer: string) {
  const {complaints} = useForm();
  const ids = useComputed(() =>
    complaints.value
      .get(pointer)
      ?.map(({id}) => id)
      .join(' '),
  );
  return {'aria-describedby': ids, 'aria-invalid': useComputed(() => (ids.value ? 'true' : undefined))};
}

/** A field with its name, its unit and its complaints. */
export function Field({schema, value, pointer, required = false}: Value & {required?: boolean}) {
  const form = useForm();
  const mark = unit(lastKey(pointer));
  const wide = schema.type === 'array' || !simple(form, schema);
  return (
    <label class={`field${wide ? ' wide' : ''}${required ? ' required' : ''}`} title={hintOf(schema, pointer)}>
      <span class="name">{sentence(called(pointer))}</span>
      <span class="box">
        <Input schema={schema} value={value} pointer={pointer} name={called(pointer)} />
        {mark && (
          <span class="unit" title={t('Drag to change')} onPointerDown={scrub}>
            {shownUnit(mark)}
          </span>
        )}
      </span>
      <Complaints at={pointer} />
    </label>
  );
}

/** Returns the input for a value, by its type. */
export function Input(given: Value & {name: string}) {
  const {schema, value, pointer, name} = given;
  const form = useForm();
  const shared = {
    'data-pointer': pointer,
    'aria-label': [sentence(name), shownUnit(unit(lastKey(pointer)))].filter(Boolean).join(', '),
    ...useTold(pointer),
  };
  const names = schema.type === 'string' || typeof value === 'string' ? form.namesFor(pointer) : undefined;
  if (names?.length) return <Combo {...given} names={names} shared={shared} />;
  if (schema.type !== 'array' && schema.enum && !isRow(value)) return <Select {...given} choices={schema.enum} shared={shared} />;
  if (schema.type === 'boolean') {
    const checked = (value ?? schema.default) === true;
    return <input type="checkbox" {...shared} checked={checked} onChange={(event) => form.write(pointer, event.currentTarget.checked)} />;
  }
  if (texts(form, schema) && lined(value)) return <Lines {...given} shared={shared} />;
  if (schema.type === 'array' || isRow(value) || Array.isArray(value)) return <List value={value} pointer={pointer} shared={shared} />;
  return Number(given.schema.maxLength) >= fileText ? <FileText {...given} shared={shared} /> : <Text {...given} shared={shared} />;
}

const pause = 400; // ms after which what is typed is complete

/**
 * Writes typed text after a pause, or if the field is left, because half a number may be refused. A
 * step or a drag is written at once.
 */
function useTyping(write: (text: string) => void) {
  const form = useForm();
  const due = useRef<{timer: number; text: string} | undefined>(undefined);
  const latest = useRef(write);
  latest.current = write;
  const flush = () => {
    const {timer, text} = due.current ?? {};
    clearTimeout(timer);
    due.current = undefined;
    form.pending.delete(flush);
    if (text !== undefined) latest.current(text);
  };
  const latestFlush = useRef(flush);
  useEffect(
    () => () => {
      clearTimeout(due.current?.timer); // a field that is gone writes nothing into what came after it
      form.pending.delete(latestFlush.current);
    },
    [],
  );
  return {
    onInput: (event: Event) => {
      const text = (event.currentTarget as HTMLInputElement).value;
      clearTimeout(due.current?.timer);
      form.pending.delete(latestFlush.current);
      latestFlush.current = flush;
      form.pending.add(flush);
      due.current = {timer: window.setTimeout(flush, pause), text};
      if (!event.isTrusted) flush();
    },
    onBlur: flush,
  };
}

/** Returns the value that applies if nothing is entered. */
function useDefault({schema, pointer}: Value) {
  const form = useForm();
  return useComputed(() => {
    const echo = at(form.echo.value, pointer);
    const counts = echo === undefined || isRow(echo) ? schema.default : echo;
    return counts === undefined ? '' : offered(counts, unit(lastKey(pointer)));
  });
}

/** A name of something that the service lists. */
function Combo(given: Value & {names: string[]; shared: object}) {
  const {value, pointer} = given;
  const form = useForm();
  return <Search {...given} value={String(value ?? '')} placeholder={useDefault(given)} change={(name) => form.write(pointer, name)} />;
}

function Text(given: Value & {shared: object}) {
  const {schema, value, pointer, shared} = given;
  const form = useForm();
  const textual = schema.type === 'string' && !schema.oneOf;
  const mark = unit(lastKey(pointer));
  const placeholder = useDefault(given);
  return (
    <input
      type="text"
      inputMode={textual ? 'text' : 'decimal'}
      spellcheck={false}
      placeholder={placeholder}
      value={typeof value === 'number' ? entered(value, mark) : String(value ?? '')}
      {...shared}
      {...useTyping((text) => form.write(pointer, typed(text, textual, mark)))}
      onKeyDown={textual ? undefined : nudge}
    />
  );
}

/** A file as a text: opened, or pasted. */
function FileText({value, pointer, shared}: Value & {shared: object}) {
  const form = useForm();
  const input = useRef<HTMLInputElement>(null);
  const chose = async ({currentTarget}: {currentTarget: HTMLInputElement}) => {
    const file = currentTarget.files?.[0];
    if (file) form.write(pointer, await file.text());
    currentTarget.value = ''; // the same file once more is a change too
  };
  return (
    <>
      <textarea
        rows={4}
        spellcheck={false}
        placeholder={t('Paste the text of the file, or open it')}
        value={String(value ?? '')}
        {...shared}
        {...useTyping((text) => form.write(pointer, text === '' ? undefined : text))}
      />
      <button type="button" class="open-file" onClick={() => input.current?.click()}>
        {t('Open file')}
      </button>
      <input ref={input} type="file" hidden aria-label={t('A file for {field}', {field: lastKey(pointer)})} onChange={(event) => void chose(event)} />
    </>
  );
}

function Select({schema, value, pointer, choices, shared}: Value & {choices: Json[]; shared: object}) {
  const form = useForm();
  const otherwise = useComputed(() => {
    const echo = at(form.echo.value, pointer);
    const taken = at(form.body, pointer) === undefined && echo !== undefined && typeof echo !== 'object' ? echo : schema.default;
    return taken === undefined ? '' : t('{value} (default)', {value: choice(taken)});
  });
  const change = (text: string) => form.write(pointer, text === '' ? undefined : (JSON.parse(text) as Json));
  return (
    <select value={value === undefined ? '' : JSON.stringify(value)} {...shared} onChange={(event) => change(event.currentTarget.value)}>
      <option value="">{otherwise}</option>
      {choices.map((each) => (
        <option key={JSON.stringify(each)} value={JSON.stringify(each)}>
          {choice(each)}
        </option>
      ))}
    </select>
  );
}

const lined = (value: Json | undefined) => value === undefined || (Array.isArray(value) && value.every((each) => typeof each === 'string'));

function Lines({value, pointer, shared}: Value & {shared: object}) {
  const form = useForm();
  const all = Array.isArray(value) ? value : [];
  const typing = useTyping((text) => form.write(pointer, text.split('\n').filter(Boolean)));
  return <textarea rows={Math.min(8, Math.max(1, all.length))} spellcheck={false} {...shared} value={all.join('\n')} {...typing} />;
}

/** Lists: a few numbers on a line, many in a box. */
function List({value, pointer, shared}: {value: Json | undefined; pointer: string; shared: object}) {
  const form = useForm();
  const numbers = Array.isArray(value) && value.every((each) => typeof each === 'number');
  const mark = unit(lastKey(pointer));
  const text = value === undefined ? '' : numbers ? value.map((each) => entered(Number(each), mark)).join(', ') : JSON.stringify(value);
  const inline = value === undefined || (numbers && value.length <= inlineList && text.length <= inlineText);
  const bound = {
    value: text,
    ...shared,
    ...useTyping((given) => form.write(pointer, listed(given, mark))),
  };
  return inline ? <input type="text" {...bound} /> : <textarea rows={3} spellcheck={false} {...bound} />;
}
