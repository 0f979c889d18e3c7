import {Board} from './charts';
import {el} from './dom';
import type {Row} from './json';
import * as panels from './panels';
import {usualMotion} from './onward';
import type {Context} from './pictures/context';
import {machineOf, motionFacts, scheduleCharts, wayOf} from './pictures/schedule';
import {ask, type Reply} from './service';

interface Ways {
  open(body: Row): void;
  focus(pointer: string): void;
  again(): void;
}

/** The pulses of a cut on a machine, at a speed: the next job in line, shown without leaving this one. */
export class Motion {
  private readonly root = el('div', {class: 'motion'});
  private board: Board | null = null;
  private of = '';

  constructor(private readonly context: Context) {}

  recolour(): void {
    this.board?.recolour();
  }

  async fill(panel: HTMLElement, cut: Row, ways: Ways): Promise<void> {
    const body = {cut, ...usualMotion};
    panel.append(
      el(
        'p',
        {class: 'soft'},
        'On the five-axis cutter at 600 mm/min. ',
        el('button', {type: 'button', id: 'open-pulses', onclick: () => ways.open(body)}, 'Change machine, speed, lead …'),
      ),
      this.root,
    );
    const key = JSON.stringify(body);
    if (this.of === key) return;
    this.of = key;
    this.board ??= new Board(this.root);
    const reply = await ask('pulse-schedules', body);
    if (this.of !== key) return;
    if (!reply.answer) this.of = ''; // asked again when next shown
    const way = reply.answer && (await wayOf(body, reply.answer, this.context));
    if (this.of !== key) return;
    this.root.querySelectorAll('.extra').forEach((node) => node.remove());
    this.board.show(reply.answer ? scheduleCharts(reply.answer, machineOf(usualMotion['machine'], this.context), way) : []);
    this.root.append(extra(reply, ways));
  }
}

function extra(reply: Reply, ways: Ways): HTMLElement {
  const root = el('div', {class: 'extra'});
  if (reply.answer) {
    const facts = motionFacts(reply.answer);
    const figures = el('div', {class: 'figures'});
    panels.figures(figures, facts);
    root.append(figures, el('div', {class: 'columns'}, ...(facts.tables ?? []).map(panels.table)));
  } else
    panels.verdict(
      root,
      undefined,
      reply.problem,
      0,
      (pointer) => ways.focus(pointer.replace(/^\/cut/, '')),
      () => ways.again(),
    );
  return root;
}
