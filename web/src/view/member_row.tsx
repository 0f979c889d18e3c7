import {cellValue, columns, impliedOf, type Column, type Sizes} from '../frame/members';
import type {Row} from '../json';
import {later, t} from '../language';
import {entered, shownUnit} from '../units';
import {number, sentence, unit} from '../words';
import {Swatch} from './controls';

export const tall = 28; // px of a row

export interface RowActs {
  pick(row: number): void;
  edit(text: string): void;
  move(row: number, column: number, extend: boolean): void;
  begun(): void;
  commit(text: string): void;
  typing(event: KeyboardEvent & {currentTarget: HTMLInputElement}): void;
}
interface Given {
  row: number; // of the request
  place: number; // among the rows that are shown
  member: Row;
  sizes: Sizes;
  chosen: boolean;
  active: boolean;
  column: number | null; // of the active cell
  editing: string | null; // its text while it is changed
  tone: string;
  marked: ReadonlySet<string>; // pointers that the service refused
  acts: RowActs;
}

export function MemberRow({row, place, member, sizes, chosen, active, column, editing, tone, marked, acts}: Given) {
  return (
    <div role="row" aria-rowindex={place + 2} aria-selected={chosen} class={active ? 'active' : undefined} style={{transform: `translateY(${place * tall}px)`}}>
      <span role="gridcell" class="pick-row">
        <input type="checkbox" tabIndex={-1} aria-label={t('Choose row {row}', {row: row + 1})} checked={chosen} onChange={() => acts.pick(row)} />
        <Swatch tone={tone} />
      </span>
      {columns.map((each, k) => {
        const here = k === column;
        const pressed = (event: PointerEvent) => {
          if (event.button !== 0 || (here && editing !== null)) return;
          if (event.ctrlKey || event.metaKey) acts.pick(row);
          else if (here && active && event.pointerType === 'touch') acts.edit(cellText(member, each));
          else acts.move(row, k, event.shiftKey);
        };
        return (
          <span
            role="gridcell"
            key={each.id}
            id={`cell-${row}-${k}`}
            class={[here && 'here', cellValue(member, each) === undefined && 'implied', !each.textual && 'numeric'].filter(Boolean).join(' ')}
            aria-invalid={refused(marked, row, each) || undefined}
            onPointerDown={pressed}
            onDblClick={() => acts.edit(cellText(member, each))}
          >
            {here && editing !== null ? <Editor column={each} row={row} text={editing} acts={acts} /> : shown(member, each, sizes)}
          </span>
        );
      })}
    </div>
  );
}

const Editor = ({column, row, text, acts}: {column: Column; row: number; text: string; acts: RowActs}) => (
  <input
    ref={focused}
    aria-label={t('{column}, row {row}', {column: headOf(column), row: row + 1})}
    list={column.id === 'size' ? 'tube-sizes' : undefined}
    value={text}
    onFocus={acts.begun}
    onInput={(event) => acts.edit(event.currentTarget.value)}
    onKeyDown={acts.typing}
    onBlur={(event) => acts.commit(event.currentTarget.value)}
  />
);

/** A cell that is being changed has the focus. */
function focused(input: HTMLInputElement | null): void {
  if (input !== document.activeElement) input?.focus();
}

/** Whether the service refused the value of a cell, or the point that it is a part of. */
function refused(marked: ReadonlySet<string>, row: number, {key, axis}: Column): boolean {
  const pointer = `/members/${row}/${key}`;
  return marked.has(pointer) || (axis !== undefined && marked.has(`${pointer}/${axis}`));
}

const names: Record<string, string> = {
  id: later('name'),
  diameter: 'Ø',
  'start x': later('start x'),
  'start y': later('start y'),
  'start z': later('start z'),
  'end x': later('end x'),
  'end y': later('end y'),
  'end z': later('end z'),
  size: later('size'),
  wall: later('wall'),
  priority: later('priority'),
};
export function headOf({id, key, axis}: Column): string {
  const mark = unit(key);
  return sentence(t(names[id] ?? id)) + (mark && !axis ? ` ${shownUnit(mark)}` : '');
}

/** A cell's value in full, as it is edited. */
export function cellText(member: Row | undefined, column: Column | undefined): string {
  const value = column && cellValue(member ?? {}, column);
  return typeof value === 'number' && column ? entered(value, unit(column.key)) : String(value ?? '');
}

function shown(member: Row, column: Column, sizes: Sizes): string {
  const value = cellValue(member, column) ?? impliedOf(member, column, sizes);
  return typeof value === 'number' ? number(value, unit(column.key)) : value === undefined ? '' : String(value);
}
