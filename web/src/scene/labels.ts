import type {Camera, Vector3} from 'three';
import type {Joint, Members} from './members';

const most = 60; // names at a time; of more, those that are chosen or pointed at
const reach = 10; // pixels from a joint's dot that are still on it

interface Label {
  node: HTMLElement;
  width: number;
  height: number;
}
type Box = [number, number, number, number];

/**
 * Members' names in the picture without overlaps: the selection first, then from near to far; and a
 * dot at each joint.
 */
export class Labels {
  private readonly root = layer('labels');
  private readonly places = layer('dots');
  private labels: Label[] = [];
  private dots: {node: HTMLElement; joint: Joint}[] = [];
  private taken: Box[] = [];
  private seen: {item: number; x: number; y: number}[] = [];

  constructor(root: HTMLElement) {
    root.append(this.places, this.root);
  }

  show(names: string[], joints: Joint[]): void {
    const nodes = names.map((name) => Object.assign(document.createElement('span'), {textContent: name}));
    this.dots = joints.map((joint) => ({node: document.createElement('i'), joint}));
    for (const {node, joint} of this.dots) node.dataset['item'] = String(joint.item);
    this.root.replaceChildren(...nodes);
    this.places.replaceChildren(...this.dots.map(({node}) => node));
    this.labels = nodes.map((node) => ({node, width: node.offsetWidth, height: node.offsetHeight}));
  }

  place(members: Members, camera: Camera, width: number, height: number, chosen: Set<number>, pointed: Set<number>, item: number | null): void {
    const wanted = [...this.labels.keys()].filter((i) => this.labels.length <= most || chosen.has(i) || pointed.has(i));
    const places = wanted.map((i) => [i, members.place(i, camera.position)?.project(camera)] as const);
    const seen = new Map(places.flatMap(([i, at]) => (at ? [[i, at] as const] : [])));
    const all = [...seen.keys()];
    const lifted = (i: number) => chosen.has(i) || pointed.has(i); // above the highlighted ones
    const depth = (i: number) => (seen.get(i) as Vector3).z;
    const laid = (rank: (i: number) => number, lift: (i: number) => boolean, dots: {x: number; y: number}[]) => {
      const boxes = new Map<number, Box>();
      for (const i of all.sort((a, b) => rank(a) - rank(b))) {
        const {width: w, height: h} = this.labels[i] as Label;
        const {x, y, z} = seen.get(i) as Vector3;
        const [left, middle] = [((x + 1) * width - w) / 2, ((1 - y) * height - h) / 2];
        const free = (top: number) =>
          z <= 1 &&
          left >= 0 &&
          top >= 0 &&
          left + w <= width &&
          top + h <= height &&
          [...boxes.values()].every(([l, t, r, b]) => left > r || left + w < l || top > b || top + h < t) &&
          !dots.some((dot) => within([[left, top, left + w, top + h]], dot.x, dot.y, 5));
        const top = (lift(i) ? [middle - h, middle + h, middle] : [middle]).find(free);
        if (top !== undefined) boxes.set(i, [left, top, left + w, top + h]);
      }
      return boxes;
    };
    // Dots stay at their places with any selection; highlighted names avoid them, so that a click
    // hits its target.
    const rest = laid(depth, () => false, []);
    this.dot(members, camera, [width, height], [...rest.values()], (of) => this.labels.length <= most || of.some((i) => chosen.has(i) || pointed.has(i)), item);
    const shown = all.some(lifted) ? laid((i) => (chosen.has(i) ? -2 : pointed.has(i) ? -1 : depth(i)), lifted, this.seen) : rest;
    for (const [i, [left, top]] of shown) (this.labels[i] as Label).node.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
    this.labels.forEach(({node}, i) => {
      node.classList.toggle('shown', shown.has(i));
      node.classList.toggle('chosen', chosen.has(i));
      node.classList.toggle('pointed', pointed.has(i));
    });
    this.taken = [...shown.values()];
  }

  /** A dot is drawn if no name is there and nothing else hides its joint. */
  private dot(members: Members, camera: Camera, [width, height]: [number, number], rest: Box[], wanted: (of: number[]) => boolean, item: number | null): void {
    this.seen = [];
    for (const {node, joint} of this.dots) {
      const at = wanted(joint.of) ? members.joint(joint, camera.position)?.project(camera) : undefined;
      const [x, y] = at ? [((at.x + 1) * width) / 2, ((1 - at.y) * height) / 2] : [-1, -1];
      const shown = x > 0 && y > 0 && x < width && y < height && (at?.z ?? 2) < 1 && !within(rest, x, y, 5) && this.nearest(x, y, reach) === null;
      if (shown) {
        this.seen.push({item: joint.item, x, y});
        node.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
      }
      node.classList.toggle('shown', shown);
      node.classList.toggle('chosen', joint.item === item);
    }
  }

  /** The item of the joint that is seen at a place of the picture. */
  under(x: number, y: number): number | null {
    return within(this.taken, x, y, 0) ? null : this.nearest(x, y, reach);
  }

  private nearest(x: number, y: number, within: number): number | null {
    const off = (each: {x: number; y: number}) => Math.hypot(each.x - x, each.y - y);
    const near = this.seen.filter((each) => off(each) <= within).sort((a, b) => off(a) - off(b));
    return near[0]?.item ?? null;
  }
}

/** Names and dots are only visual: the lists next to the picture have the same content. */
function layer(name: string): HTMLElement {
  const node = Object.assign(document.createElement('div'), {className: name});
  node.setAttribute('aria-hidden', 'true');
  return node;
}

const within = (boxes: Box[], x: number, y: number, margin: number) =>
  boxes.some(([l, t, r, b]) => x > l - margin && x < r + margin && y > t - margin && y < b + margin);
