import {useLayoutEffect, useMemo, useRef, useState} from 'preact/hooks';
import {save} from '../dom';
import {
  addMember,
  cellsOf,
  columns,
  copyCells,
  fillDown,
  foundRows,
  membersOf,
  nameRefused,
  parseCell,
  pasteCells,
  removeMembers,
  renameMember,
  sortRows,
  cellValue,
  writeCell,
  type Column,
} from '../frame/members';
import type {Row} from '../json';
import {standings, told, toneOf} from '../pictures/frame_items';
import {many, t} from '../language';
import {quantity} from '../units';
import {choice, unit} from '../words';
import {cellText, headOf, MemberRow, tall, type RowActs} from './member_row';
import {useConsole} from './page';

const spare = 6; // rows drawn above and below those that are seen

interface Cell {
  row: number;
  column: number;
}
interface Order {
  column: Column;
  falling: boolean;
}

/** All members of a frame as a table: searched, sorted, pasted into, with one choice for the table, the form and the picture. */
export function MembersTable() {
  const console = useConsole();
  const {body, form, context} = console;
  const {sizes} = context;
  const {selection} = form;
  const answer = console.answer.value;
  console.changes.value; // of the body
  form.drawn.value;
  const [search, find] = useState('');
  const [standing, filter] = useState('');
  const [order, sort] = useState<Order | null>(null);
  const [at, go] = useState<Cell>({row: 0, column: 0});
  const [editing, edit] = useState<string | null>(null);
  const [said, say] = useState('');
  const [removed, keep] = useState<Row | null>(null); // the state after a removal
  const box = useRef<HTMLDivElement>(null);
  const ended = useRef(false); // by a key: leaving the cell then changes nothing
  const made = useMemo(() => (answer && Array.isArray(answer.result['members']) ? standingsOf(answer) : new Map<string, string>()), [answer]);
  const members = membersOf(body);
  const standingOf = (row: number) => made.get(String(members[row]?.['id']));
  const rows = useMemo(() => {
    const found = foundRows(body, search, (row) => choice(standingOf(row) ?? '')).filter((row) => !standing || standingOf(row) === standing);
    return order ? sortRows(body, found, order.column, order.falling, sizes) : found;
  }, [body, search, standing, order, made]);
  const chosen = selection.rows.value;
  const marked = useMemo(() => new Set(console.reply.value?.problem?.errors?.map(({pointer}) => pointer)), [console.reply.value]);

  useLayoutEffect(() => (answer ? selection.bind(body, answer) : undefined), [answer, body]);
  // What the picture or the form chooses is the active row here.
  const active = selection.row.value;
  useLayoutEffect(() => {
    if (active !== null && active !== at.row) go({row: active, column: at.column});
  }, [active]);
  const place = rows.indexOf(at.row);
  const [top, scrolled] = useState(0);
  useLayoutEffect(() => {
    const frame = box.current;
    if (!frame || place < 0) return;
    const from = place * tall;
    if (from < frame.scrollTop) frame.scrollTop = from;
    else if (from + 2 * tall > frame.scrollTop + frame.clientHeight - 12) frame.scrollTop = from + 2 * tall - frame.clientHeight + 12;
  }, [place]);

  const picked = () => rows.filter((row) => chosen.has(row));
  const move = (row: number, column: number, extend = false) => {
    const to = {row, column: Math.min(columns.length - 1, Math.max(0, column))};
    go(to);
    if (extend) {
      const [a, b] = [rows.indexOf(active ?? at.row), rows.indexOf(row)].sort((p, q) => p - q) as [number, number];
      selection.choose(active ?? at.row, rows.slice(a, b + 1));
    } else if (row !== active) selection.choose(row);
    else if (chosen.size !== 1) selection.choose(row);
  };
  const toggle = (row: number) => {
    const next = new Set(chosen);
    if (!next.delete(row)) next.add(row);
    selection.choose(next.has(row) ? row : ([...next][0] ?? null), next);
    go({row, column: at.column});
  };
  const commit = (text: string) => {
    edit(null);
    const column = columns[at.column] as Column;
    const member = members[at.row];
    const value = (column.textual ? undefined : quantity(text, unit(column.key))) ?? parseCell(text, column);
    if (!member || value === cellValue(member, column)) return;
    const refused = column.id === 'id' ? nameRefused(body, at.row, String(value ?? '')) : undefined;
    say(refused ?? '');
    if (refused) return;
    form.change((copy) => {
      if (column.id === 'id') renameMember(copy, at.row, String(value));
      else writeCell(membersOf(copy)[at.row] as Row, column, value, sizes);
    });
  };
  const add = () => {
    find('');
    filter('');
    form.change((copy) => addMember(copy, active ?? undefined));
    selection.choose(members.length);
    say('');
  };
  const remove = () => {
    const gone = new Set(picked());
    if (!gone.size) return;
    if (gone.size === members.length) return say(t('A frame has at least one member.'));
    const next = rows.find((row) => row > Math.max(...gone));
    selection.choose(next === undefined ? null : next - gone.size);
    form.change((copy) => removeMembers(copy, gone));
    keep(form.body);
    say(many(gone.size, '{n} member removed, with their joints.', '{n} members removed, with their joints.'));
  };
  const restore = () => {
    form.go(-1);
    say('');
  };
  const fill = () => {
    const column = columns[at.column] as Column;
    form.change((copy) => fillDown(copy, picked(), column, sizes));
    say(t('{column} filled down in {n} rows.', {column: headOf(column), n: picked().length}));
  };
  const paste = (text: string) => {
    const cells = cellsOf(text);
    let written: number[] = [];
    form.change((copy) => {
      written = pasteCells(copy, cells, rows, at, sizes);
    });
    selection.choose(written[0] as number, written);
    say(many(written.length, '{n} row pasted.', '{n} rows pasted.'));
  };

  const keydown = (event: KeyboardEvent) => {
    if (editing !== null || event.target instanceof HTMLInputElement) return;
    const by = event.ctrlKey || event.metaKey;
    const step = (n: number) => move(rows[Math.min(rows.length - 1, Math.max(0, place + n))] ?? at.row, at.column, event.shiftKey);
    const keys: Record<string, () => void> = by
      ? {a: () => selection.choose(at.row, rows), d: fill, Home: () => step(-rows.length), End: () => step(rows.length)}
      : {
          ArrowUp: () => step(-1),
          ArrowDown: () => step(1),
          PageUp: () => step(-10),
          PageDown: () => step(10),
          ArrowLeft: () => move(at.row, at.column - 1),
          ArrowRight: () => move(at.row, at.column + 1),
          Home: () => move(at.row, 0),
          End: () => move(at.row, columns.length - 1),
          Enter: () => edit(cellText(members[at.row], columns[at.column])),
          F2: () => edit(cellText(members[at.row], columns[at.column])),
          Delete: remove,
          ' ': () => toggle(at.row),
          Escape: () => selection.choose(null),
        };
    const act = keys[event.key] ?? (!by && !event.altKey && event.key.length === 1 ? () => edit(event.key) : undefined);
    if (!act || !members[at.row]) return;
    event.preventDefault();
    act();
  };
  const typing = (event: KeyboardEvent & {currentTarget: HTMLInputElement}) => {
    const to = {Enter: [event.shiftKey ? -1 : 1, 0], Tab: [0, event.shiftKey ? -1 : 1], Escape: [0, 0]}[event.key];
    if (!to) return;
    event.preventDefault();
    event.stopPropagation();
    ended.current = true;
    if (event.key === 'Escape') edit(null);
    else commit(event.currentTarget.value);
    box.current?.focus({preventScroll: true});
    move(rows[place + (to[0] as number)] ?? at.row, at.column + (to[1] as number));
  };

  const acts: RowActs = {
    pick: toggle,
    edit,
    move: (row, column, extend) => move(row, column, extend),
    commit: (text) => ended.current || commit(text),
    typing,
    begun: () => {
      ended.current = false;
    },
  };
  const first = Math.max(0, Math.floor(top / tall) - spare);
  const last = Math.min(rows.length, first + Math.ceil((box.current?.clientHeight || 330) / tall) + 2 * spare);
  const there = [...new Set(made.values())];
  const heading = (column: Column) => () => sort((was) => (was?.column !== column ? {column, falling: false} : was.falling ? null : {column, falling: true}));
  return (
    <section id="members" class="block" aria-label={t('Members')}>
      <h3>
        {t('Members')}
        <span class="soft">{rows.length === members.length ? rows.length : t('{some} of {all}', {some: rows.length, all: members.length})}</span>
      </h3>
      <div class="bar">
        <input
          type="search"
          aria-label={t('Search members')}
          placeholder={t('Search name or size')}
          value={search}
          onInput={(event) => find(event.currentTarget.value)}
        />
        <select aria-label={t('Show members by verdict')} value={standing} onChange={(event) => filter(event.currentTarget.value)}>
          <option value="">{t('all verdicts')}</option>
          {standings
            .filter((each) => there.includes(each))
            .map((each) => (
              <option key={each} value={each}>
                {choice(each)}
              </option>
            ))}
        </select>
        <button type="button" id="member-add" onClick={add}>
          {t('Add')}
        </button>
        <button
          type="button"
          id="member-fill"
          title={t('Copies the column of the active cell from the first chosen row (Ctrl+D)')}
          disabled={chosen.size < 2}
          onClick={fill}
        >
          {t('Fill down')}
        </button>
        <button type="button" id="member-delete" disabled={chosen.size === 0} onClick={remove}>
          {chosen.size > 1 ? t('Delete {n}', {n: chosen.size}) : t('Delete')}
        </button>
        <button
          type="button"
          id="member-save"
          title={t('As text for a spreadsheet')}
          onClick={() => save('members.tsv', new Blob([copyCells(body, rows)], {type: 'text/tab-separated-values'}))}
        >
          {t('Save table')}
        </button>
        <span class="soft" role="status">
          {said}
          {removed === body && (
            <button type="button" id="member-undo" onClick={restore}>
              {t('Undo')}
            </button>
          )}
        </span>
      </div>
      <div
        ref={box}
        class="sheet"
        role="grid"
        tabIndex={0}
        aria-label={t('Members. Enter changes a cell, Space chooses a row, Ctrl+V pastes from a spreadsheet.')}
        aria-multiselectable="true"
        aria-rowcount={rows.length + 1}
        aria-activedescendant={place >= first && place < last ? `cell-${at.row}-${at.column}` : undefined}
        onKeyDown={keydown}
        onScroll={(event) => scrolled(event.currentTarget.scrollTop)}
        onPaste={(event) => {
          if (editing !== null) return;
          event.preventDefault();
          paste(event.clipboardData?.getData('text/plain') ?? '');
        }}
        onCopy={(event) => {
          if (editing !== null || !chosen.size) return;
          event.preventDefault();
          event.clipboardData?.setData('text/plain', copyCells(body, picked()));
        }}
      >
        <div role="row" class="head" aria-rowindex={1}>
          <span role="columnheader">
            <span class="offscreen">{t('Chosen')}</span>
          </span>
          {columns.map((column) => {
            const sorted = order?.column === column ? (order.falling ? 'descending' : 'ascending') : 'none';
            return (
              <span role="columnheader" key={column.id} aria-sort={sorted} class={column.textual ? undefined : 'numeric'}>
                <button type="button" tabIndex={-1} title={t('Sort by {column}', {column: headOf(column)})} onClick={heading(column)}>
                  {headOf(column)}
                </button>
              </span>
            );
          })}
        </div>
        <div role="rowgroup" class="rows" style={{height: `${rows.length * tall}px`}}>
          {rows.slice(first, last).map((row, i) => (
            <MemberRow
              key={row}
              row={row}
              place={first + i}
              member={members[row] ?? {}}
              sizes={sizes}
              chosen={chosen.has(row)}
              active={row === active}
              column={row === at.row ? at.column : null}
              editing={row === at.row ? editing : null}
              tone={toneOf(standingOf(row) ?? 'none')}
              marked={marked}
              acts={acts}
            />
          ))}
        </div>
      </div>
      <p class="soft">{t('Of two members that join, the smaller priority number cuts the other; of two alike, the earlier one.')}</p>
    </section>
  );
}

/** The verdict of each member by its name. */
function standingsOf(answer: Parameters<typeof told>[0]): Map<string, string> {
  const given = told(answer);
  return new Map(given.members.map(({id}, i) => [String(id), given.standing[i] as string]));
}
