import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import {colour, partnerColour} from './dom';
import {t} from './language';
import {listen, point, pointed} from './links';
import type {Chart} from './picture';
import {number, ticks, withUnit} from './words';

const face = 'Inter, system-ui, "PingFang SC", "Microsoft YaHei", "Noto Sans CJK SC", sans-serif';
const left = 56,
  right = 12,
  named = 16, // the x axis' name
  ribbon = 7,
  dragged = 6; // px, from where on a drag is no click

/** One chart's curves, cursor and axes, in a place of the page. */
export class Plot {
  private readonly plot: uPlot;
  private readonly forget: () => void;
  private width = 0;
  private zoomed: [number, number] | undefined;
  private hidden: ReadonlySet<string> = new Set();

  constructor(
    private readonly frame: HTMLElement,
    private chart: Chart,
    /** Hears of an interval that is dragged over, or of none. */
    private readonly chose: (span: [number, number] | undefined) => void = () => {},
  ) {
    this.width = frame.clientWidth;
    this.plot = new uPlot(this.options(), this.data(), frame);
    this.forget = listen(chart.link, (index) => this.follow(index));
  }

  update(chart: Chart): void {
    if (chart === this.chart) return;
    this.chart = chart;
    this.fit();
    this.plot.setData(this.data());
  }

  /** Shows an interval of the axis, or the whole of it. */
  zoom(span: [number, number] | undefined): void {
    if (span?.join() === this.zoomed?.join()) return;
    this.zoomed = span;
    this.plot.setData(this.data());
  }

  hide(hidden: ReadonlySet<string>): void {
    this.hidden = hidden;
    this.chart.series.forEach(({name}, i) => {
      const show = !hidden.has(name);
      if (this.plot.series[i + 1]?.show !== show) this.plot.setSeries(i + 1, {show});
    });
    this.plot.redraw();
  }

  private whole(): null {
    this.chose(undefined);
    return null;
  }

  /** The width is read when it changes and not with each answer: reading it lays the whole page out. */
  measured(): void {
    this.width = this.frame.clientWidth;
    this.fit();
  }

  private fit(): void {
    const size = this.size();
    if (size.width !== this.plot.width || size.height !== this.plot.height) this.plot.setSize(size);
  }

  end(): void {
    this.forget();
    this.plot.destroy();
  }

  private data(): uPlot.AlignedData {
    const {x, series, period} = this.chart;
    const lines = [x.values, ...series.map((s) => s.values)];
    if (!closes(this.chart)) return lines as uPlot.AlignedData;
    return lines.map((values, i) => [...values, i ? (values[0] ?? null) : period]) as uPlot.AlignedData;
  }

  private size(): {width: number; height: number} {
    const width = Math.max(240, this.width);
    if (!this.chart.wrap) return {width, height: (this.chart.height ?? 190) + named};
    const [low, high] = extent(this.chart);
    const scale = (width - left - right) / span(this.chart);
    return {width, height: Math.round(Math.min(420, Math.max(90, (high - low) * scale)) + 34 + named)};
  }

  private options(): uPlot.Options {
    const {chart} = this;
    const axis = {
      stroke: () => colour('ink-soft'),
      grid: {stroke: () => colour('grid'), width: 1},
      ticks: {show: false},
      font: `11px ${face}`,
    };
    return {
      ...this.size(),
      padding: [8, right, 0, 0],
      legend: {show: false},
      cursor: {y: false, drag: {x: !chart.wrap, y: false, setScale: false}, bind: {dblclick: () => () => this.whole()}, points: {size: 7}},
      scales: {
        x: {time: false, range: () => this.across()},
        y: {range: (_, low, high) => this.room(low, high)},
      },
      axes: [
        {
          ...axis,
          size: 24,
          gap: 2,
          labelGap: 0,
          ...quarters(chart),
          label: [t(chart.x.name), t(chart.x.unit)].filter(Boolean).join(', '),
          labelSize: named,
          labelFont: axis.font,
          values: (_, v) => ticks(v),
        },
        {...axis, size: left, gap: 4, values: (_, v) => ticks(v)},
      ],
      series: [
        {},
        ...chart.series.map((s) => ({
          stroke: () => colour(s.tone),
          width: s.width ?? 1.5,
          points: {show: s.dots ?? false, size: 4},
          ...(s.dash ? {dash: s.dash} : {}),
        })),
      ],
      hooks: {
        drawClear: [(u) => this.under(u)],
        draw: [(u) => this.over(u)],
        setSelect: [
          (u) => {
            const {left: from, width} = u.select;
            if (width > dragged) this.chose([u.posToVal(from, 'x'), u.posToVal(from + width, 'x')]);
            if (width) u.setSelect({left: 0, width: 0, top: 0, height: 0}, false);
          },
        ],
        setCursor: [
          (u) => {
            if (u.cursor.left !== undefined && u.cursor.left >= 0 && u.cursor.idx !== null && u.cursor.idx !== undefined) point(this.chart.link, u.cursor.idx);
            else if (u.cursor.left !== undefined && u.cursor.left < 0) point(this.chart.link, null);
          },
        ],
      },
    };
  }

  private across(): [number, number] {
    if (this.zoomed) return this.zoomed;
    const values = this.chart.x.values;
    const length = span(this.chart);
    const begin = values[0] ?? 0;
    const first = this.chart.period !== undefined && begin > 0 && begin < 0.02 * length ? 0 : begin; // a turn begins at 0, wherever its first point is
    const end = begin + length;
    return end > first ? [first, end] : [first - 1, first + 1];
  }

  private room(low: number, high: number): [number, number] {
    if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
    if (this.chart.wrap) {
      const [from] = extent(this.chart);
      const scale = span(this.chart) / Math.max(1, this.size().width - left - right);
      return [from, from + (this.size().height - 34 - named) * scale];
    }
    if (this.chart.zero) [low, high] = [Math.min(low, 0), Math.max(high, 0)];
    if (this.chart.within !== undefined) high = Math.max(high, this.chart.within);
    const flat = high - low < 1e-6 * Math.max(1, Math.abs(high)); // a straight line, not the rounding it is made of
    const space = flat ? 0.5 : (high - low) * 0.08;
    return [low - space * (this.chart.partners ? 1.8 : 1), high + space];
  }

  private under(u: uPlot): void {
    const {ctx, bbox} = u;
    ctx.save();
    if (this.chart.wrap) this.wrapped(u);
    for (const band of this.chart.bands ?? []) {
      if (this.hidden.has(band.text)) continue;
      const from = u.valToPos(band.from, 'x', true),
        to = u.valToPos(band.to, 'x', true);
      ctx.globalAlpha = 0.2;
      ctx.fillStyle = colour(band.tone);
      const [start, end] = [Math.max(from, bbox.left), Math.min(Math.max(to, from + 1), bbox.left + bbox.width)];
      if (end > start) ctx.fillRect(start, bbox.top, end - start, bbox.height);
    }
    ctx.restore();
  }

  /** Draws the kept side, and below the cut the material that each partner removes. */
  private wrapped(u: uPlot): void {
    const {ctx, bbox} = u;
    const z = this.chart.series[0]?.values as number[];
    const x = this.chart.x.values.map((value) => u.valToPos(value, 'x', true));
    const y = z.map((value) => u.valToPos(value, 'y', true));
    const end = bbox.left + bbox.width;
    const bottom = bbox.top + bbox.height;
    x.push(end);
    y.push(y[0] as number);
    const area = (from: number, to: number, edge: number, fill: string, alpha: number) => {
      ctx.beginPath();
      ctx.moveTo(x[from] as number, edge);
      for (let i = from; i <= to; ++i) ctx.lineTo(x[i] as number, y[i] as number);
      ctx.lineTo(x[to] as number, edge);
      ctx.globalAlpha = alpha;
      ctx.fillStyle = fill;
      ctx.fill();
    };
    area(0, x.length - 1, bbox.top, colour('steel'), 0.28);
    for (const [from, to, partner] of runs(this.chart.partners ?? [])) {
      area(from, Math.min(to + 1, x.length - 1), bottom, partnerColour(partner), 0.3);
    }
    ctx.globalAlpha = 1;
    ctx.textAlign = 'left';
    ctx.textBaseline = 'alphabetic';
    ctx.strokeStyle = colour('ink-soft');
    ctx.fillStyle = colour('ink-soft');
    ctx.font = `${11 * devicePixelRatio}px ${face}`;
    ctx.setLineDash([3 * devicePixelRatio, 3 * devicePixelRatio]);
    for (const line of this.chart.wrap?.lines ?? []) {
      const at = u.valToPos(line.x, 'x', true);
      ctx.beginPath();
      ctx.moveTo(at, bbox.top);
      ctx.lineTo(at, bottom);
      ctx.stroke();
      ctx.fillText(line.text, at + 4 * devicePixelRatio, bbox.top + 12 * devicePixelRatio);
    }
    ctx.setLineDash([]);
  }

  private over(u: uPlot): void {
    const {ctx, bbox} = u;
    const scale = devicePixelRatio;
    ctx.save();
    ctx.textAlign = 'left';
    ctx.textBaseline = 'alphabetic';
    for (const mark of this.chart.marks ?? []) {
      const at = u.valToPos(mark.x, 'x', true);
      if (this.hidden.has(mark.text) || at < bbox.left - 1 || at > bbox.left + bbox.width + 1) continue;
      ctx.strokeStyle = ctx.fillStyle = colour(mark.tone);
      if (mark.y === undefined) {
        ctx.setLineDash([2 * scale, 4 * scale]);
        ctx.lineWidth = scale;
        ctx.beginPath();
        ctx.moveTo(at, bbox.top);
        ctx.lineTo(at, bbox.top + bbox.height);
        ctx.stroke();
      } else {
        ctx.beginPath();
        ctx.arc(at, u.valToPos(mark.y, 'y', true), 3.5 * scale, 0, 2 * Math.PI);
        ctx.fill();
      }
    }
    ctx.font = `${11 * scale}px ${face}`;
    if (lettered(this.chart)) this.letter(u);
    ctx.setLineDash([6 * scale, 4 * scale]);
    for (const limit of this.chart.limits ?? []) {
      const y = u.valToPos(limit.y, 'y', true);
      if (y < bbox.top || y > bbox.top + bbox.height) continue;
      ctx.strokeStyle = ctx.fillStyle = colour('bad');
      ctx.lineWidth = scale;
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
      // Events are named at both ends.
      ctx.textAlign = lettered(this.chart) ? 'center' : 'left';
      ctx.fillText(limit.text, bbox.left + (lettered(this.chart) ? bbox.width / 2 : 4 * scale), y + (y - bbox.top < 16 * scale ? 12 : -4) * scale);
    }
    ctx.setLineDash([]);
    if (this.chart.partners && !this.chart.wrap) this.ribbon(u);
    ctx.restore();
  }

  /** Names upright along the lines; of lines that lie together each below the one before. */
  private letter(u: uPlot): void {
    const {ctx, bbox} = u;
    const scale = devicePixelRatio;
    let [last, used] = [-Infinity, 0];
    for (const mark of this.chart.marks ?? []) {
      const at = u.valToPos(mark.x, 'x', true);
      if (at < bbox.left - 1 || at > bbox.left + bbox.width + 1) continue;
      if (at - last > 13 * scale) used = 0;
      const right = at + 13 * scale < bbox.left + bbox.width;
      ctx.save();
      ctx.translate(at + (right ? 11 : -4) * scale, bbox.top + bbox.height - (4 * scale + used));
      ctx.rotate(-Math.PI / 2);
      ctx.fillStyle = colour(mark.tone);
      ctx.fillText(mark.text, 0, 0);
      ctx.restore();
      used += ctx.measureText(mark.text).width + 8 * scale;
      last = at;
    }
  }

  private ribbon(u: uPlot): void {
    const {ctx, bbox} = u;
    const height = ribbon * devicePixelRatio;
    const inside = (at: number) => Math.min(Math.max(at, bbox.left), bbox.left + bbox.width);
    const x = [...this.chart.x.values.map((value) => inside(u.valToPos(value, 'x', true))), bbox.left + bbox.width];
    for (const [from, to, partner] of runs(this.chart.partners ?? [])) {
      ctx.fillStyle = partnerColour(partner);
      const start = x[from] as number;
      ctx.fillRect(start, bbox.top + bbox.height - height, (x[Math.min(to + 1, x.length - 1)] as number) - start, height);
    }
  }

  private follow(index: number | null): void {
    const {x, period} = this.chart;
    const value = index === null ? undefined : index === x.values.length ? period : x.values[index];
    this.plot.setCursor(value === undefined ? {left: -10, top: -10} : {left: this.plot.valToPos(value, 'x'), top: 4});
  }
}

/** The interval of an axis, narrower or wider about the cursor; nothing for the whole of it. */
export function narrowed({link, x, period}: Chart, now: [number, number] | undefined, by: number): [number, number] | undefined {
  const [first, last] = [x.values[0] ?? 0, period ?? x.values[x.values.length - 1] ?? 1];
  const [from, to] = now ?? [first, last];
  const middle = x.values[pointed(link) ?? -1] ?? (from + to) / 2;
  const half = (by * (to - from)) / 2;
  if (!by || 2 * half >= last - first) return undefined;
  const start = Math.min(Math.max(middle - half, first), last - 2 * half);
  return [start, start + 2 * half];
}

/** The arrow keys move the cursor along a chart; plus, minus and 0 zoom about it. */
export function walk({link, x}: Chart, event: KeyboardEvent, zoom: (by: number) => void): void {
  const count = x.values.length;
  const now = pointed(link);
  const by = event.shiftKey ? 10 : 1;
  if (event.key === 'ArrowRight') point(link, now === null ? 0 : Math.min(count - 1, now + by));
  else if (event.key === 'ArrowLeft') point(link, now === null ? count - 1 : Math.max(0, now - by));
  else if (event.key === 'Escape') point(link, null);
  else if (event.key === '+' || event.key === '=') zoom(0.5);
  else if (event.key === '-') zoom(2);
  else if (event.key === '0') zoom(0);
  else return;
  event.preventDefault();
}

/** Returns the text alternative of a chart. */
export const described = ({title, unit, x, series}: Chart) =>
  t('{title}: {lines} over {axis}; {n} points. Left and right move the cursor, plus and minus zoom.', {
    title,
    lines: series.map((s) => `${s.name} ${spread(s.values, unit)}`).join(t(', ')),
    axis: t(x.name),
    n: x.values.length,
  });

/** "from 18.7 to 72.6°", for those who do not see it. */
function spread(values: (number | null)[], of: string): string {
  const known = values.filter((v): v is number => v !== null);
  if (!known.length) return '';
  const [low, high] = [known.reduce((a, b) => Math.min(a, b)), known.reduce((a, b) => Math.max(a, b))];
  return t('from {low} to {high}', {low: number(low, of), high: withUnit(high, of)});
}

function extent(chart: Chart): [number, number] {
  const all = chart.series.flatMap((s) => s.values).filter((v): v is number => v !== null);
  const low = all.reduce((a, b) => Math.min(a, b), Infinity),
    high = all.reduce((a, b) => Math.max(a, b), -Infinity);
  const space = Math.max((high - low) * 0.15, 0.02 * span(chart));
  return [low - space, high + space];
}

function span(chart: Chart): number {
  const {values} = chart.x;
  const last = values[values.length - 1] ?? 1;
  return (closes(chart) ? (chart.period as number) : last) - (values[0] ?? 0);
}

/** Marks of several kinds are named on their lines, those of one kind in the key. */
export const lettered = ({marks = []}: Chart) => new Set(marks.map((mark) => mark.text)).size > 1 && marks.every((mark) => mark.y === undefined);

/** Of a whole turn, its quarters are the ticks. */
function quarters({x, period}: Chart): Pick<uPlot.Axis, 'splits'> {
  if (period === undefined || x.unit !== '°') return {};
  return {splits: (_, __, low, high) => Array.from({length: 33}, (_, i) => 90 * (i - 16)).filter((at) => at >= low - 1e-9 && at <= high + 1e-9)};
}

/** Whether the curve goes on from its last point to where it began. */
function closes({x, period}: Chart): boolean {
  return period !== undefined && period > (x.values[x.values.length - 1] ?? Infinity);
}

/** Stretches of one partner: first and last point, partner. */
function runs(partners: number[]): [number, number, number][] {
  const out: [number, number, number][] = [];
  partners.forEach((partner, index) => {
    const run = out[out.length - 1];
    if (run && run[2] === partner) run[1] = index;
    else out.push([index, index, partner]);
  });
  return out;
}
