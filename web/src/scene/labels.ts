import type {Camera, Vector3} from 'three';
import {el} from '../dom';
import type {Members} from './members';

const most = 60; // names at a time; of more, those that are chosen or pointed at

interface Label {
  node: HTMLElement;
  width: number;
  height: number;
}

/** Members' names in the picture, none over another: what is chosen first, then from near to far. */
export class Labels {
  private readonly root = el('div', {class: 'labels', 'aria-hidden': 'true'});
  private labels: Label[] = [];

  constructor(root: HTMLElement) {
    root.append(this.root);
  }

  show(names: string[]): void {
    const nodes = names.map((name) => el('span', {}, name));
    this.root.replaceChildren(...nodes);
    this.labels = nodes.map((node) => ({node, width: node.offsetWidth, height: node.offsetHeight}));
  }

  place(members: Members, camera: Camera, width: number, height: number, chosen: Set<number>, pointed: Set<number>): void {
    const all = [...this.labels.keys()].filter((i) => this.labels.length <= most || chosen.has(i) || pointed.has(i));
    const seen = new Map(all.map((i) => [i, members.place(i, camera.position).project(camera)]));
    const rank = (i: number) => (chosen.has(i) ? -2 : pointed.has(i) ? -1 : (seen.get(i) as Vector3).z);
    const offered = all.sort((a, b) => rank(a) - rank(b));
    const taken: [number, number, number, number][] = [];
    const shown = new Set<number>();
    for (const i of offered) {
      const {node, width: w, height: h} = this.labels[i] as Label;
      const {x, y, z} = seen.get(i) as Vector3;
      const lift = chosen.has(i) || pointed.has(i) ? h : 0; // above what is looked at
      const [left, top] = [((x + 1) * width - w) / 2, ((1 - y) * height - h) / 2 - lift];
      const free = taken.every(([l, t, r, b]) => left > r || left + w < l || top > b || top + h < t);
      if (z > 1 || left < 0 || top < 0 || left + w > width || top + h > height || !free) continue;
      taken.push([left, top, left + w, top + h]);
      shown.add(i);
      node.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
    }
    this.labels.forEach(({node}, i) => {
      node.classList.toggle('shown', shown.has(i));
      node.classList.toggle('chosen', chosen.has(i));
      node.classList.toggle('pointed', pointed.has(i));
    });
  }
}
