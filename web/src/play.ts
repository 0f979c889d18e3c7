import {el} from './dom';
import {listen, point, pointed} from './links';
import type {Played} from './picture';
import {withUnit} from './units';

const longest = 20; // s that a whole schedule plays for; a shorter one in its own time
const calm = matchMedia('(prefers-reduced-motion: reduce)');

/** A time axis to play and to scrub: it moves the cursor of its link, and with it every view. Where motion is unwanted it steps from event to event. */
export class Player {
  private given: Played | undefined;
  private running = 0;
  private forget: (() => void) | null = null;
  private readonly start = el('button', {type: 'button', id: 'play', onclick: () => this.press()});
  private readonly slider = el('input', {
    type: 'range',
    min: '0',
    'aria-label': 'Time',
    title: 'The time in the schedule: the cursor and the tool follow.',
    oninput: () => this.go(Number(this.slider.value)),
  });
  private readonly told = el('output', {class: 'soft'});

  constructor(private readonly root: HTMLElement) {
    root.append(this.start, this.slider, this.told);
    calm.addEventListener('change', () => this.stop());
  }

  show(given: Played | undefined): void {
    this.stop();
    this.forget?.();
    this.forget = given ? listen(given.link, (index) => this.follow(index)) : null;
    this.given = given;
    this.root.hidden = !given;
    if (!given) return;
    this.slider.max = String(given.seconds.length - 1);
    this.follow(pointed(given.link));
  }

  private go(index: number): void {
    if (!this.given) return;
    point(this.given.link, index);
    this.follow(index);
  }

  private follow(index: number | null): void {
    const seconds = this.given?.seconds ?? [];
    const at = Math.min(index ?? 0, seconds.length - 1);
    this.slider.value = String(at);
    const event = [...(this.given?.events ?? [])].reverse().find((each) => each.at <= at);
    const time = withUnit(Number((seconds[at] ?? 0).toFixed(1)), 's');
    this.slider.setAttribute('aria-valuetext', [time, event?.text].filter(Boolean).join(', after '));
    this.told.textContent = [`${(seconds[at] ?? 0).toFixed(1)} of ${(seconds[seconds.length - 1] ?? 0).toFixed(1)} s`, event?.text].filter(Boolean).join(' · ');
  }

  private press(): void {
    if (calm.matches) this.step();
    else if (this.running) this.stop();
    else this.play();
  }

  private step(): void {
    const now = Number(this.slider.value);
    const stops = [...(this.given?.events.map(({at}) => at) ?? []), Number(this.slider.max)];
    this.go(stops.find((at) => at > now) ?? 0);
  }

  private play(): void {
    const seconds = this.given?.seconds ?? [];
    const whole = seconds[seconds.length - 1] ?? 0;
    const speed = Math.max(1, whole / longest);
    const from = Number(this.slider.value) >= seconds.length - 1 ? 0 : (seconds[Number(this.slider.value)] ?? 0);
    const began = performance.now();
    const next = (now: number) => {
      const time = from + (Math.max(0, now - began) / 1000) * speed;
      const at = seconds.findIndex((each) => each >= time);
      this.go(at < 0 ? seconds.length - 1 : at);
      if (at < 0) this.stop();
      else this.running = requestAnimationFrame(next);
    };
    this.running = requestAnimationFrame(next);
    this.label();
  }

  private stop(): void {
    cancelAnimationFrame(this.running);
    this.running = 0;
    this.label();
  }

  private label(): void {
    this.start.textContent = calm.matches ? 'Next event' : this.running ? 'Pause' : 'Play';
  }
}
