import type * as WebIfc from 'web-ifc';
import {sizeMeasuring} from '../catalogue.js';
import {type Axis, exact, type Found, type FrameOptions, frameOf, full, type Imported, names, nothing, rounded, type Size} from '../frame.js';
import {distance, type Matrix, minus, times, unit, type Vector} from '../geometry.js';
import {limits} from '../limits.js';
import {type CornerOptions, cornersStated, usually} from '../sections.js';
import {Boxes, type Made, type Tube} from './boxes.js';
import {type Line, Model, told, Trouble} from './model.js';
import {inWorld} from './placement.js';
import {normalised} from './normalise.js';
import {bodies, type Body, type Reading} from './solids.js';
import {relations, structural} from './structure.js';
import {millimetres, radians} from './units.js';

export interface IfcOptions extends FrameOptions, CornerOptions {
  /** The address of web-ifc's WebAssembly; node finds it by itself. */
  wasm?: string;
}

/**
 * Tubes by their use, and fittings, of which only bends are read. IFC 2x3 has pipes as flow
 * segments.
 */
const segments = /^Ifc(Beam|Column|Member|PipeSegment|FlowSegment)(StandardCase)?$/;
const fittings = /^Ifc(Pipe|Flow)Fitting$/;

let loading: Promise<[typeof WebIfc, WebIfc.IfcAPI]> | undefined;

/** Large, so it comes when the first IFC file does. */
async function load(wasm: string | undefined): Promise<[typeof WebIfc, WebIfc.IfcAPI]> {
  const library = await import('web-ifc');
  const api = new library.IfcAPI();
  await api.Init(wasm === undefined ? undefined : () => wasm, true);
  api.SetLogLevel(library.LogLevel.LOG_LEVEL_OFF);
  return [library, api];
}

function opened(api: WebIfc.IfcAPI, bytes: Uint8Array): number {
  try {
    return api.OpenModel(bytes);
  } catch {
    return -1;
  }
}

const why = (failure: unknown): string => {
  if (failure instanceof Trouble) return failure.message;
  throw failure;
};

/** The body of a product, and where it lies. */
function shape(model: Model, product: Line): {items: Line[]; world: Matrix} {
  const placement = model.of(product, 'ObjectPlacement');
  const representations = model.list(model.of(product, 'Representation'), 'Representations');
  const body = representations.filter((each) => model.text(each, 'RepresentationIdentifier') === 'Body');
  if (body.length !== 1 || !body[0]) throw new Trouble(`${told(product)} has ${body.length === 0 ? 'no Body' : 'more than one Body'}`);
  return {items: model.list(body[0], 'Items'), world: inWorld(model, placement)};
}

const scaled = (v: Vector, mm: number): Vector => rounded(times(v, mm));

/** By its listed name if it is that of a listed size. */
function sized(outer: number, wall: number): Size {
  const listed = sizeMeasuring(outer, wall);
  return listed ? {size: listed.name} : {outer_diameter_mm: exact(outer), wall_mm: exact(wall)};
}

/** A rectangular tube as a member or, if its corners cannot be cut, as a body that cuts others. */
function addBox(found: Found, body: Tube, id: string, mm: number, from: {id: string; type: string; guid?: string}, made: Made): void {
  const [start_mm, end_mm, up] = [scaled(body.from, mm), scaled(body.to, mm), rounded(body.up)];
  if ('section' in made) {
    found.members.push({id, start_mm, end_mm, ...made.section, up});
    return;
  }
  const {corner_radius_mm, why} = made;
  const axis: Axis = {point_mm: start_mm, direction: rounded(unit(minus(body.to, body.from)) as Vector)};
  const [width_mm, height_mm] = [exact(body.width * mm), exact(body.height * mm)];
  const other = {kind: 'rectangular_tube' as const, id, width_mm, height_mm, corner_radius_mm, axis, up};
  found.others.push({other, length_mm: distance(body.from, body.to) * mm, from, why});
}

function add(found: Found, body: Exclude<Body, Tube>, id: string, mm: number, from: {id: string; type: string; guid?: string}): void {
  if (body.kind === 'tube') {
    found.members.push({id, start_mm: scaled(body.from, mm), end_mm: scaled(body.to, mm), ...sized(body.outer * mm, body.wall * mm)});
    return;
  }
  const axis: Axis = {point_mm: scaled(body.from, mm), direction: rounded(body.direction)};
  const [outer_diameter_mm, bend_radius_mm] = [exact(body.outer * mm), exact(body.radius * mm)];
  const bend_deg = exact((body.angle * 180) / Math.PI);
  found.others.push({other: {kind: 'elbow', id, outer_diameter_mm, bend_radius_mm, bend_deg, axis, inwards: rounded(body.inwards)}, from});
}

/** Marks that programs draw at random: no name for a person. */
const guid = /^(?:ID|_)?\{?(?:[0-9A-F]{8}-[0-9A-F]{4}-[0-9A-F]{4}-[0-9A-F]{4}-[0-9A-F]{12}|[0-3][0-9A-Z_$]{21})\}?$/i;
const isGuid = (text: string, own: string | undefined): boolean => text === own || guid.test(text.trim());

/** Its mark, else its name; a GUID is neither. */
function nameOf(model: Model, product: Line): string | undefined {
  const own = model.text(product, 'GlobalId');
  return ['Tag', 'Name'].map((attribute) => model.text(product, attribute)).find((text) => text !== undefined && !isGuid(text, own));
}

const guidOf = (model: Model, product: Line): {guid?: string} => {
  const own = model.text(product, 'GlobalId');
  return own === undefined ? {} : {guid: own};
};

interface Context extends Reading {
  boxes: Boxes;
}

type Part = {body: Exclude<Body, Tube>} | {body: Tube; made: Made};

/** One product: all of it or nothing, so that no half of it passes for the whole. */
function put({model, boxes}: Context, product: Line, list: Body[], found: Found, name: ReturnType<typeof names>, mm: number): void {
  const parts = list.map((body): Part => (body.kind === 'box' ? {body, made: boxes.made(body, mm)} : {body}));
  const called = nameOf(model, product);
  const from = {id: `#${product.id}`, type: product.type, ...guidOf(model, product)};
  let before = '';
  parts.forEach((part, i) => {
    const id = list.length === 1 ? name(called, `#${product.id}`) : name(called && `${called}/${i + 1}`, `#${product.id}/${i + 1}`);
    const {body} = part;
    if ('made' in part) {
      addBox(found, part.body, id, mm, from, part.made);
      found.notUnderstood.push(...boxes.note(part.body, part.made));
      if (part.body.turned === false) found.notUnderstood.push({...from, reason: `assumed: ${told(product)} has no Axis: ${usually}`});
    } else add(found, part.body, id, mm, from);
    found.sources.push({id, entity: from.id, type: from.type, ...guidOf(model, product)});
    if (body.kind === 'tube' && body.corner) found.joints.push({between: [before, id], kind: 'mitre'});
    before = id;
  });
}

function read(given: Context, product: Line, found: Found, name: ReturnType<typeof names>, mm: number): void {
  const context = {...given, notes: []};
  const {items, world} = shape(context.model, product);
  const list = bodies(context, items, world);
  if (fittings.test(product.type) && list.some(({kind}) => kind !== 'bend')) throw new Trouble(`${told(product)} is a fitting and no bend`);
  put(context, product, list, found, name, mm);
  found.notUnderstood.push(...context.notes);
}

/** The products and the structural members of a file, each tried in its turn. */
class File {
  readonly name = names();
  private readonly mm: number;
  private readonly context: Context;
  private readonly imported = new Set<number>();

  constructor(
    private readonly library: typeof WebIfc,
    private readonly model: Model,
    private readonly found: Found,
    options: IfcOptions,
  ) {
    const project = model.all(library.IFCPROJECT)[0];
    if (project === undefined) throw new Trouble('there is no IfcProject');
    this.mm = millimetres(model, model.line(project));
    const codes = {line: library.IFCLINEINDEX, arc: library.IFCARCINDEX};
    const boxes = new Boxes(cornersStated(options));
    this.context = {model, radians: radians(model, model.line(project)), codes, boxes, notes: [], budget: {steps: limits.steps}};
  }

  /** Asks for what all of it leaves open. */
  ask(): void {
    this.found.asks.push(...this.context.boxes.ask());
  }

  private each(ids: number[], act: (line: Line) => void): void {
    for (const id of ids) {
      if (full(this.found)) return;
      let [type, more]: [string, {guid?: string}] = ['', {}];
      try {
        const line = this.model.line(id);
        type = line.type;
        more = guidOf(this.model, line);
        act(line);
      } catch (failure) {
        this.found.notUnderstood.push({id: `#${id}`, type, reason: why(failure), ...more});
      }
    }
  }

  products(): void {
    const {model, library} = this;
    this.each([...model.all(library.IFCELEMENT), ...model.all(library.IFCPROXY)], (product) => {
      const known = segments.test(product.type) || fittings.test(product.type);
      if (!known && product.attributes['Representation'] == null) return; // a group of others
      if (!known) throw new Trouble(`${product.type} is not imported`);
      read(this.context, product, this.found, this.name, this.mm);
      this.imported.add(product.id);
    });
  }

  /**
   * Reads members of an analysis model, except those that represent imported products, because
   * these exist already.
   */
  structure(): void {
    const ids = this.model.all(this.library.IFCSTRUCTURALCURVEMEMBER);
    if (ids.length === 0) return;
    const related = relations(this.model, this.library);
    const tubes = new Set(this.found.members.map(({start_mm, end_mm}) => segmentKey(start_mm, end_mm)));
    this.each(ids, (member) => {
      if ((related.products.get(member.id) ?? []).some((id) => this.imported.has(id))) return;
      const body = structural(this.context, member, related);
      if (body.kind !== 'bend' && tubes.has(segmentKey(scaled(body.from, this.mm), scaled(body.to, this.mm)))) return;
      put(this.context, member, [body], this.found, this.name, this.mm);
    });
  }
}

/** Of a line in any sense, to 0.1 mm. */
const segmentKey = (a: Vector, b: Vector): string =>
  [a, b]
    .map((each) => each.map((v) => Math.round(v * 10)).join())
    .sort()
    .join(' ');

function every(library: typeof WebIfc, model: Model, found: Found, options: IfcOptions): void {
  const file = new File(library, model, found, options);
  file.products();
  file.structure();
  file.ask();
}

/** Beams, columns, members, pipes, bends and structural members of an IFC file (2x3, 4, 4x3) as a frame. */
export async function fromIfc(bytes: Uint8Array, options: IfcOptions = {}): Promise<Imported> {
  loading ??= load(options.wasm);
  const [library, api] = await loading.catch((failure) => {
    loading = undefined; // the network may be back the next time
    throw failure;
  });
  const found = nothing();
  const {bytes: file, long} = normalised(bytes);
  const handle = opened(api, file);
  if (handle < 0) found.notUnderstood.push({id: 'file', type: 'IFC', reason: 'this is no IFC file of a known schema'});
  else
    try {
      every(library, new Model(api, handle, long), found, options);
      api.CloseModel(handle);
    } catch (failure) {
      if (failure instanceof Trouble) api.CloseModel(handle);
      else loading = undefined; // its memory is not to be relied on after a fault
      found.notUnderstood.push({id: 'file', type: 'IFC', reason: failure instanceof Trouble ? failure.message : `it cannot be read: ${String(failure)}`});
    }
  return frameOf(found, options, 'IFC');
}
