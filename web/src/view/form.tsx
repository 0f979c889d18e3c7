import {Fragment, type ComponentChildren} from 'preact';
import {useLayoutEffect, useRef} from 'preact/hooks';
import {roomy, runsOf, type Form} from '../form';
import {freeName} from '../frame/members';
import {called, hintOf} from '../hint';
import {at, isRow, join, put, type Json, type Row} from '../json';
import {t} from '../language';
import {brief} from '../names';
import type {Schema} from '../schema';
import {shownUnit} from '../units';
import {lastKey, sentence, unit} from '../words';
import {partnerTone, Swatch} from './controls';
import {Complaints, Field, Fields, Input, short, simple, texts, useForm, useTold, type Value} from './field';
import {followFocus} from './hint';

const aside = new Set(['log', 'numerics', 'columns']); // belong to programs
const folded = new Set(['sampling', 'reference', 'accept', 'expert', 'check', 'table']); // closed until opened

/** The request as a form, drawn from the contract's schema. */
export function RequestForm({form}: {form: Form}) {
  const root = useRef<HTMLFormElement>(null);
  const {schema, body, build} = form.drawn.value;
  const measuring = useRef(0);
  const room = () => roomy(root.current?.querySelectorAll('[data-pointer]') ?? []);
  /** Once, however many folds open together: measuring lays the page out. */
  const roomSoon = () => {
    cancelAnimationFrame(measuring.current);
    measuring.current = requestAnimationFrame(room);
  };
  useLayoutEffect(() => {
    room();
    form.stands();
  }, [form.drawn.value]);
  useLayoutEffect(() => {
    let width = 0;
    root.current?.addEventListener('toggle', roomSoon, true);
    new ResizeObserver(([entry]) => {
      if (entry?.contentRect.width === width) return;
      width = entry?.contentRect.width ?? 0;
      roomSoon();
    }).observe(root.current as HTMLFormElement);
  }, []);
  return (
    <form
      ref={root}
      id="form"
      autocomplete="off"
      noValidate
      onSubmit={(event) => event.preventDefault()}
      onInput={(event) => roomy([event.target as HTMLElement])}
      {...followFocus}
      onBlurCapture={() => form.history.settle()}
    >
      <datalist id="tube-sizes">
        {form.choices.size.map((size) => (
          <option key={size} value={size} />
        ))}
      </datalist>
      <Fields.Provider value={form}>
        <Fragment key={build}>
          <Parts schema={schema} value={body} pointer="" />
        </Fragment>
      </Fields.Provider>
    </form>
  );
}

/** The fields of one value of the request, after the choice of the way it is given in. */
function Parts({schema: given, value, pointer}: Value) {
  const form = useForm();
  const {contract} = form;
  const schema = contract.resolve(given);
  const branches = contract.branches(schema);
  if (branches.length < 2 || schema.properties) return <Inner schema={schema} value={value} pointer={pointer} />;
  const branch = branches[form.branchOf(branches, value)] as Schema;
  const shown = contract.together(branches, branch);
  const named = branches.map((each) => sentence(contract.branchName(branches, each)));
  const names = pointer ? named : [...new Set(named)];
  const change = (index: number) => {
    const alike = pointer ? [branches[index] as Schema] : branches.filter((_, i) => named[i] === names[index]);
    form.rewrite(pointer, alike[form.branchOf(alike, at(form.body, pointer))] as Schema);
  };
  const chosen = pointer ? branches.indexOf(branch) : names.indexOf(named[branches.indexOf(branch)] as string);
  return (
    <>
      <Way pointer={pointer} title={pointer ? hintOf(schema, pointer) : t('Form of the job.')} names={names} chosen={chosen} change={change} />
      <Inner schema={shown} value={value} pointer={pointer} />
    </>
  );
}

function Way({pointer, title, names, chosen, change}: {pointer: string; title: string; names: string[]; chosen: number; change(index: number): void}) {
  return (
    <>
      <div class="field branch">
        {pointer === '' && <span class="name">{t('Given by')}</span>}
        <select
          aria-label={pointer ? called(pointer) : t('Given by')}
          title={title}
          data-holds={pointer || undefined}
          value={String(chosen)}
          {...useTold(pointer)}
          onChange={(event) => change(event.currentTarget.selectedIndex)}
        >
          {names.map((name, i) => (
            <option key={i} value={String(i)}>
              {name}
            </option>
          ))}
        </select>
      </div>
      <Complaints at={pointer} />
    </>
  );
}

function Inner({schema, value, pointer}: Value) {
  if ('const' in schema || schema.type === 'null') return null;
  const open = schema.additionalProperties === true || isRow(schema.additionalProperties);
  if (schema.properties && !open) return <Members schema={schema} value={isRow(value) ? value : {}} pointer={pointer} />;
  return <Field schema={schema} value={value} pointer={pointer} />;
}

function Members({schema, value, pointer}: Value & {value: Row}) {
  const form = useForm();
  const small: ComponentChildren[] = [],
    large: ComponentChildren[] = [],
    absent: ComponentChildren[] = [];
  for (const [key, inner] of Object.entries(schema.properties ?? {})) {
    if (!(key in value) && (aside.has(key) || typeof inner === 'boolean')) continue;
    const member = {schema: form.contract.resolve(inner), value: value[key], pointer: join(pointer, key)};
    if ('const' in member.schema) continue;
    const required = schema.required?.includes(key) ?? false;
    if (simple(form, member.schema) || short(form, member.schema) || (required && texts(form, member.schema)))
      small.push(<Field key={key} {...member} required={required} />);
    else if (key in value || required) large.push(<Group key={key} {...member} required={required} />);
    else if (!form.contract.fixed(member.schema)) absent.push(<Offer key={key} schema={member.schema} pointer={member.pointer} />);
  }
  for (const key of Object.keys(value)) if (!Object.hasOwn(schema.properties ?? {}, key)) large.push(<Stranger key={key} pointer={join(pointer, key)} />);
  const parts = [small.length > 0 && <div class="grid">{small}</div>, large];
  // Tubes first, because people change them most.
  if (pointer === '') parts.reverse();
  return (
    <>
      {parts}
      {absent.length > 0 && <div class="offers">{absent}</div>}
    </>
  );
}

function Offer({schema, pointer}: {schema: Schema; pointer: string}) {
  const form = useForm();
  const add = () => {
    form.folds.set(pointer, true);
    form.put(pointer, form.contract.begun(schema, lastKey(pointer)));
  };
  return (
    <button type="button" title={hintOf(schema, pointer)} data-adds={pointer} onClick={add}>
      + {called(pointer)}
    </button>
  );
}

function Remover({name, pointer, act}: {name: string; pointer: string; act(): void}) {
  return (
    <button type="button" class="remove" aria-label={t('Remove {name}', {name})} title={t('Remove {name}', {name})} data-removes={pointer} onClick={act}>
      ×
    </button>
  );
}

/** What this form of a request does not have, from a file or a link: it is refused until it is removed. */
function Stranger({pointer}: {pointer: string}) {
  const form = useForm();
  return (
    <>
      <div class="group">
        <p class="stranger" tabIndex={-1} data-holds={pointer}>
          {sentence(called(pointer))} <span class="soft">{t('does not apply here')}</span>
        </p>
        <Remover name={called(pointer)} pointer={pointer} act={() => form.put(pointer, undefined)} />
      </div>
      <Complaints at={pointer} />
    </>
  );
}

function Group({schema, value, pointer, required}: Value & {required: boolean}) {
  const form = useForm();
  const given = {schema, value, pointer};
  const told = useTold(pointer);
  const own = headed(form, schema, value);
  const open = form.folds.get(pointer) ?? !folded.has(lastKey(pointer));
  return (
    <>
      <div class="group">
        <details open={open} onToggle={(event) => form.folds.set(pointer, event.currentTarget.open)}>
          <summary title={hintOf(schema, pointer)} data-holds={pointer} {...(own ? told : {})}>
            {sentence(called(pointer))}
          </summary>
          {value === undefined ? (
            <Offer {...given} />
          ) : pointer === form.tabled ? (
            <ChosenRow {...given} value={value} />
          ) : schema.type === 'array' ? (
            <List {...given} value={value} />
          ) : (
            <Parts {...given} />
          )}
        </details>
        {!required && <Remover name={called(pointer)} pointer={pointer} act={() => form.put(pointer, undefined)} />}
      </div>
      {own && <Complaints at={pointer} />}
    </>
  );
}

/**
 * Returns whether a value has no field of its own, so that its complaints appear at its heading.
 */
function headed({contract}: Form, schema: Schema, value: Json | undefined): boolean {
  if (value === undefined || schema.properties) return true;
  const item = contract.resolve(schema.items ?? {});
  return schema.type === 'array' ? Boolean(item.properties ?? item.oneOf) : contract.branches(schema).length < 2 && contract.branches(schema).length > 0;
}

function List({schema, value, pointer}: Value & {value: Json}) {
  const form = useForm();
  const {contract} = form;
  const item = contract.resolve(schema.items ?? {});
  if (!item.properties && !item.oneOf) return <Field schema={schema} value={value} pointer={pointer} />;
  const items = Array.isArray(value) ? value : [];
  const branches = item.oneOf ? contract.branches(item) : [item];
  const kinds = items.map((each) => branches[form.branchOf(branches, each)] as Schema);
  const last = items.length - 1;
  const add = (branch: Schema) => {
    const typed = at(form.body, pointer); // what is drawn may be older
    const own = Array.isArray(typed) ? typed : [];
    const made = contract.make(branch, branch === kinds[last] ? withoutLists(own[last]) : undefined);
    const named =
      isRow(made) && typeof made['id'] === 'string' ? {...made, id: freeName(new Set(own.map((each) => String(at(each, '/id')))), made['id'])} : made;
    form.replace(put(form.body, pointer, [...own, named]), join(pointer, own.length));
  };
  const flat = (kind: Schema) => Object.values(kind.properties ?? {}).every((each) => simple(form, contract.resolve(each)));
  return (
    <>
      {runsOf(kinds).map(([kind, from, to]) =>
        flat(kind) ? (
          <Rows key={from} kind={kind} items={items.slice(from, to)} pointer={pointer} first={from} />
        ) : (
          items.slice(from, to).map((each, i) => <Card key={from + i} schema={item} value={each} pointer={join(pointer, from + i)} index={from + i} />)
        ),
      )}
      <div class="offers">
        {/* Not a list to choose from: by the keyboard its first choice would be made on the way to the others. */}
        {branches.map((branch) => {
          const name = branches.length === 1 ? t('add') : contract.branchName(branches, branch);
          const title = t('Add to {list}', {list: called(pointer)});
          return (
            <button
              type="button"
              key={name}
              class="adder"
              aria-label={`${title}: ${name}`}
              title={title}
              data-adds={join(pointer, items.length)}
              onClick={() => add(branches.length === 1 ? item : branch)}
            >
              + {name}
            </button>
          );
        })}
      </div>
    </>
  );
}

/** Places are not those of the row before: two bodies in one place are refused. */
const withoutLists = (value: Json | undefined) => JSON.parse(JSON.stringify(value ?? null, (_, each) => (Array.isArray(each) ? undefined : each))) as Json;

/** Of a list that a table shows in full: the fields of the row that is chosen there, else of the first. */
function ChosenRow({schema, value, pointer}: Value & {value: Json}) {
  const form = useForm();
  const items = Array.isArray(value) ? value : [];
  const {row} = form.selection;
  const at = Math.min(row.value ?? 0, items.length - 1);
  if (at < 0) return <p class="soft">{t('Add one in the table.')}</p>;
  return (
    <>
      <p class="walker">
        <button
          type="button"
          aria-label={t('Previous row')}
          title={t('Show the previous row')}
          disabled={at === 0}
          onClick={() => form.selection.choose(at - 1)}
        >
          ‹
        </button>
        <span class="soft">{t('{row} of {rows}; all of them are in the table', {row: at + 1, rows: items.length})}</span>
        <button
          type="button"
          aria-label={t('Next row')}
          title={t('Show the next row')}
          disabled={at === items.length - 1}
          onClick={() => form.selection.choose(at + 1)}
        >
          ›
        </button>
      </p>
      <Parts key={at} schema={schema.items ?? {}} value={items[at]} pointer={join(pointer, at)} />
    </>
  );
}

interface Column {
  key: string;
  schema: Schema;
}

/** Rows from `first` on, of one kind. */
function Rows({kind, items, pointer, first}: {kind: Schema; items: Json[]; pointer: string; first: number}) {
  const form = useForm();
  const columns: Column[] = Object.entries(kind.properties ?? {})
    .map(([key, inner]) => ({key, schema: form.contract.resolve(inner)}))
    .filter(({schema}) => !('const' in schema));
  const head = join(pointer, first);
  return (
    <div class="scroll" tabIndex={0} role="group" aria-label={called(pointer)}>
      <table class="tubes">
        <thead>
          <tr>
            <td />
            {columns.map(({key, schema}) => (
              <th key={key} scope="col" title={hintOf(schema, join(head, key))}>
                {sentence(t(brief(key, called(join(head, key)))))}
                <small>{shownUnit(unit(key))}</small>
              </th>
            ))}
            <td />
          </tr>
        </thead>
        <tbody>
          {items.map((item, i) => (
            <Line key={first + i} item={item} columns={columns} pointer={join(pointer, first + i)} index={first + i} />
          ))}
        </tbody>
      </table>
    </div>
  );
}

function Line({item, columns, pointer, index}: {item: Json; columns: Column[]; pointer: string; index: number}) {
  const form = useForm();
  return (
    <>
      <tr>
        <td class="dot">
          <Swatch tone={partnerTone(index)} />
        </td>
        {columns.map(({key, schema}) => {
          const to = join(pointer, key);
          return (
            <td key={key} class={schema.type === 'string' ? 'text' : ''} title={hintOf(schema, to)}>
              <Input schema={schema} value={isRow(item) ? item[key] : undefined} pointer={to} name={`${called(to)} ${index + 1}`} />
            </td>
          );
        })}
        <td>
          <Remover name={t('row {row}', {row: index + 1})} pointer={pointer} act={() => form.removeRow(pointer)} />
        </td>
      </tr>
      <LineComplaints pointer={pointer} />
    </>
  );
}

/** Apart from the fields, which are not drawn anew while something is typed. */
function LineComplaints({pointer}: {pointer: string}) {
  const {complaints} = useForm();
  const own = [...complaints.value.keys()].filter((key) => key.startsWith(`${pointer}/`));
  return own.length ? (
    <tr class="complaint">
      <td colSpan={20}>
        {own.map((each) => (
          <Complaints key={each} at={each} />
        ))}
      </td>
    </tr>
  ) : null;
}

function Card({schema, value, pointer, index}: Value & {value: Json; index: number}) {
  const form = useForm();
  const name = isRow(value) && typeof value['id'] === 'string' ? value['id'] : String(index + 1);
  return (
    <div class="card">
      <div class="card-head" tabIndex={-1} data-holds={pointer}>
        <Swatch tone={partnerTone(index)} />
        <b>{name}</b>
        <Remover name={t('row {row}', {row: index + 1})} pointer={pointer} act={() => form.removeRow(pointer)} />
      </div>
      {headed(form, form.contract.resolve(schema), value) && <Complaints at={pointer} />}
      <Parts schema={schema} value={value} pointer={pointer} />
    </div>
  );
}
