/** What a check found: the worst value of all places it looked at, and the bound. Values are scaled by nothing: `unit` is theirs. */
export interface Check {
  name: string;
  value: number;
  limit: number;
  unit: string;
  passed: boolean;
  places: number; // that were looked at
  where: string; // the worst one
}

/** Checks by name, and the members of the answer that some check would see spoilt. */
export class Report {
  readonly checks = new Map<string, Check>();
  readonly covered = new Set<string>();
  readonly notes = new Map<string, string>();

  get passed(): boolean {
    return [...this.checks.values()].every((check) => check.passed);
  }
}

/** A part of an answer: names of checks begin with `title`, pointers of members with `base`. */
export class Scope {
  constructor(
    readonly report: Report,
    readonly base = '/result',
    readonly title = '',
  ) {}

  under(path: string, title = this.title): Scope {
    return new Scope(this.report, `${this.base}/${path}`, title);
  }

  covers(...members: string[]): this {
    for (const member of members) this.report.covered.add(member.startsWith('/') ? member : `${this.base}/${member}`);
    return this;
  }

  /** The value may be at most the limit; anything that is no number fails. The check keeps its worst place. */
  most(name: string, value: number, limit: number, unit: string, where: string | number = ''): void {
    const {checks} = this.report;
    const full = this.title + name;
    const passed = value <= limit;
    const before = checks.get(full);
    if (!before) checks.set(full, {name: full, value, limit, unit, passed, places: 1, where: passed ? '' : this.place(where)});
    else {
      before.places += 1;
      const worse = Number.isNaN(value) || value / (limit || 1e-300) > before.value / (before.limit || 1e-300);
      if (before.passed ? worse || !passed : !passed && worse) Object.assign(before, {value, limit, passed, where: passed ? '' : this.place(where)});
    }
  }

  same(name: string, value: number, expected: number, limit: number, unit: string, where: string | number = ''): void {
    this.most(name, Math.abs(value - expected), limit, unit, where);
  }

  equal(name: string, value: unknown, expected: unknown, where: string | number = ''): void {
    this.most(name, JSON.stringify(value) === JSON.stringify(expected) ? 0 : 1, 0, '', where);
  }

  /** States why something of the answer is not checked. */
  not(what: string, why: string): void {
    this.report.notes.set(`${this.base}/${what}`, why);
  }

  private place(where: string | number): string {
    return `${this.base}${where === '' ? '' : ` at ${where}`}`;
  }
}
