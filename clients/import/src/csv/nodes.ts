import {type Found, rounded} from '../frame.js';
import type {Vector} from '../geometry.js';
import {decimal, type LengthUnit} from '../units.js';
import {lengthSaid, type Mark, Trouble} from './numbers.js';
import {examples, type NodeField, nodeFields} from './columns.js';
import {cellsOf, type Table, unitIn} from './tables.js';

const key = (name: string): string => {
  const number = decimal(name);
  return Number.isNaN(number) ? name : `${number}`;
};

/** Points by the names that members have for them. */
export class Nodes {
  private readonly points = new Map<string, Vector>();
  private readonly doubtful = new Set<string>();
  constructor(readonly tables: Table<NodeField>[]) {}

  read(unit: LengthUnit, mark: Mark, found: Found): void {
    for (const table of this.tables) {
      const missing = nodeFields.filter((field) => table.columns[field] === undefined);
      for (const field of missing)
        found.notUnderstood.push({id: 'file', type: 'CSV', reason: `the table of nodes has no column for ${field} (such as ${examples(field)})`});
      if (missing.length > 0) continue;
      const cells = cellsOf(table);
      for (const row of table.rows) {
        const name = cells(row, 'node');
        try {
          if (name === undefined) throw new Trouble('it has no node');
          const at = (['x', 'y', 'z'] as const).map((field) => {
            const said = cells(row, field);
            if (said === undefined) throw new Trouble(`it has no ${field}`);
            return lengthSaid(said, field, unitIn(table, field) ?? unit, mark);
          });
          this.add(key(name), rounded(at as Vector));
        } catch (failure) {
          if (!(failure instanceof Trouble)) throw failure;
          found.notUnderstood.push({id: `row ${row.number}`, type: 'node', reason: failure.message});
        }
      }
    }
  }

  private add(name: string, at: Vector): void {
    const known = this.points.get(name);
    if (known?.some((v, i) => v !== at[i])) {
      this.doubtful.add(name);
      throw new Trouble(`node ${name} has other coordinates in another row`);
    }
    this.points.set(name, at);
  }

  at(said: string): Vector {
    const name = key(said);
    const point = this.points.get(name);
    if (!point) throw new Trouble(`there is no node ${said.slice(0, 80)}`);
    if (this.doubtful.has(name)) throw new Trouble(`node ${name} has two positions`);
    return point;
  }
}
