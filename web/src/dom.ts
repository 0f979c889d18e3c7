type Child = Node | string | null | undefined | false;
type Attributes = Record<string, unknown>;

/** An element with attributes; `on…` members are listeners, booleans are present or not. */
export function el<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const node = document.createElement(tag);
  set(node, attributes, children);
  return node;
}

const space = 'http://www.w3.org/2000/svg';
export function svg(tag: string, attributes: Attributes = {}, ...children: Child[]): SVGElement {
  const node = document.createElementNS(space, tag);
  set(node, attributes, children);
  return node;
}

function set(node: Element, attributes: Attributes, children: Child[]): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value as EventListener);
    else node.setAttribute(name, value === true ? '' : String(value));
  }
  for (const child of children) if (child) node.append(child);
}

export const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

/** A colour of the style sheet, as it is now (light or dark). */
export function colour(name: string): string {
  const key = `${name} ${document.documentElement.dataset['theme']}`;
  const found = colours.get(key) ?? getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  colours.set(key, found); // a chart asks for hundreds, and each question is a computation of styles
  return found;
}
const colours = new Map<string, string>();

/** Partners keep their colour in every view. */
export const partnerColour = (index: number) => colour(`partner-${index % 6}`);

export function save(name: string, data: Blob): void {
  const address = URL.createObjectURL(data);
  el('a', {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}
