import {caption} from './captions';
import {isRow, type Json} from './json';
import {named} from './lines';

// Elements of the service's drawings. Others are left out, because a drawing also shows texts that its reader did not write.
const shapes = new Set(['svg', 'g', 'defs', 'clipPath', 'rect', 'line', 'path', 'circle', 'ellipse', 'polyline', 'polygon', 'text', 'tspan', 'title', 'desc']);
const chinese = '"PingFang SC", "Microsoft YaHei", "Noto Sans CJK SC"';

/** Returns the names in a request, which stay as their owner gave them. */
export function namesIn(value: Json, key = '', into = new Set<string>()): Set<string> {
  if (typeof value === 'string' && named.has(key)) into.add(value);
  else if (Array.isArray(value)) for (const each of value) namesIn(each, key, into);
  else if (isRow(value)) for (const [inner, each] of Object.entries(value)) namesIn(each, inner, into);
  return into;
}

/** Keeps shapes and texts, which run and load nothing. */
function cleaned(node: Element): void {
  for (const child of [...node.children]) {
    if (shapes.has(child.localName)) cleaned(child);
    else child.remove();
  }
  for (const {name, value} of [...node.attributes]) {
    if (/^on|^style$|href$/i.test(name) || (/url\(/i.test(value) && !/^url\(#[\w-]+\)$/.test(value))) node.removeAttribute(name);
  }
}

/** Returns a drawing of the service as nodes, its captions in the language of the page; undefined if it is not SVG. `given`: texts that are no captions. */
export function drawingOf(text: string, given: ReadonlySet<string>): SVGSVGElement | undefined {
  const read = new DOMParser().parseFromString(text, 'image/svg+xml').documentElement;
  if (read.localName !== 'svg') return undefined;
  const drawing = document.importNode(read, true) as unknown as SVGSVGElement;
  cleaned(drawing);
  for (const node of drawing.querySelectorAll('text, tspan, title')) {
    const own = node.textContent ?? '';
    if (node.children.length === 0 && !given.has(own)) node.textContent = caption(own);
  }
  drawing.setAttribute('font-family', `Arial, "Liberation Sans", Helvetica, "DejaVu Sans", ${chinese}, sans-serif`);
  drawing.setAttribute('role', 'img');
  return drawing;
}
