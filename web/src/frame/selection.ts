import {batch, effect, signal} from '@preact/signals';
import {rowsOf, type Row} from '../json';
import {chooseTogether, chosen, listen, point, pointed} from '../links';
import type {Answer} from '../service';
import {membersOf} from './members';

const link = 'frame'; // that of the picture

/** The members that are chosen, as rows of the request: one choice for the table, the form and the picture. */
export class Selection {
  /** The row that the form shows. */
  readonly row = signal<number | null>(null);
  readonly rows = signal<ReadonlySet<number>>(new Set());

  choose(row: number | null, rows: Iterable<number> = row === null ? [] : [row]): void {
    batch(() => {
      this.row.value = row;
      this.rows.value = new Set(rows);
    });
  }

  /** Follows the picture's choice and leads it, while an answer is shown. Returns how to end that. */
  bind(body: Row, answer: Answer): () => void {
    const {rowOf, itemOf, items} = places(body, answer);
    const take = (item: number | null) => {
      if (item !== null && item >= items) return; // a joint or a part
      const was = this.row.peek();
      // A row that the answer does not have yet stays chosen; so does another piece of the same member.
      if ((was === null ? null : (itemOf.get(was) ?? null)) === item) return;
      this.choose(item === null ? null : (rowOf.get(item) ?? null));
    };
    const forget = listen(chosen(link), take);
    const now = pointed(chosen(link));
    if (now !== null && this.row.peek() === null) take(now);
    const lead = effect(() => {
      const item = this.row.value === null ? null : (itemOf.get(this.row.value) ?? null);
      const was = pointed(chosen(link));
      if (item !== null || (was !== null && was < items)) point(chosen(link), item);
      chooseTogether(link, this.rows.value.size > 1 ? [...this.rows.value].flatMap((row) => itemOf.get(row) ?? []) : []);
    });
    return () => {
      forget();
      lead();
    };
  }
}

/** Which member of the answer a row of the request is in, and the other way round: pieces in line may be one member. */
function places(body: Row, {result}: Answer) {
  const made = rowsOf(result['members']);
  const itemByName = new Map(made.map((member, item) => [member['id'], item]));
  for (const merged of rowsOf(result['merged'])) {
    const item = itemByName.get(merged['id']);
    if (item !== undefined && Array.isArray(merged['members'])) for (const piece of merged['members']) itemByName.set(piece, item);
  }
  const itemOf = new Map<number, number>();
  const rowOf = new Map<number, number>();
  membersOf(body).forEach(({id}, row) => {
    const item = itemByName.get(id);
    if (item === undefined) return;
    itemOf.set(row, item);
    if (!rowOf.has(item)) rowOf.set(item, row);
  });
  return {rowOf, itemOf, items: made.length};
}
