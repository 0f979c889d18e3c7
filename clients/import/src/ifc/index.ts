import type * as WebIfc from 'web-ifc';
import {type Axis, exact, type Found, type FrameOptions, frameOf, type Imported, names, nothing, type NotUnderstood, rounded} from '../frame.js';
import {distance, type Matrix, minus, times, unit, type Vector} from '../geometry.js';
import type {Context} from './curves.js';
import {type Line, Model, told, Trouble} from './model.js';
import {inWorld} from './placement.js';
import {bodies, type Body} from './solids.js';
import {millimetres, radians} from './units.js';

export interface IfcOptions extends FrameOptions {
  /** Of the corners of rectangular tubes that the file draws sharp, in mm: the service takes no sharp ones. */
  corner_radius_mm?: number;
  /** The address of web-ifc's WebAssembly; node finds it by itself. */
  wasm?: string;
}

/** Tubes by what they are for, and fittings, of which only bends are read. IFC 2x3 knows pipes as flow segments. */
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

function add(found: Found, body: Body, id: string, mm: number): void {
  if (body.kind === 'tube') {
    const size = {outer_diameter_mm: exact(body.outer * mm), wall_mm: exact(body.wall * mm)};
    found.members.push({id, start_mm: scaled(body.from, mm), end_mm: scaled(body.to, mm), ...size});
    return;
  }
  const way = body.kind === 'box' ? (unit(minus(body.to, body.from)) as Vector) : body.direction;
  const axis: Axis = {point_mm: scaled(body.from, mm), direction: rounded(way)};
  if (body.kind === 'box') {
    const [width_mm, height_mm, corner_radius_mm] = [body.width, body.height, body.corner_radius].map((each) => exact(each * mm)) as [number, number, number];
    const other = {kind: 'rectangular_tube' as const, id, width_mm, height_mm, corner_radius_mm, axis, up: rounded(body.up)};
    found.others.push({other, length_mm: distance(body.from, body.to) * mm});
    return;
  }
  const [outer_diameter_mm, bend_radius_mm] = [exact(body.outer * mm), exact(body.radius * mm)];
  const bend_deg = exact((body.angle * 180) / Math.PI);
  found.others.push({other: {kind: 'elbow', id, outer_diameter_mm, bend_radius_mm, bend_deg, axis, inwards: rounded(body.inwards)}});
}

/** One product: all of it or nothing, so that no half of it passes for the whole. */
function read(context: Context & {corner: number | undefined}, product: Line, found: Found, name: ReturnType<typeof names>, mm: number): void {
  const {model} = context;
  const notes: NotUnderstood[] = [];
  const {items, world} = shape(model, product);
  const list = bodies({...context, notes}, items, world);
  if (fittings.test(product.type) && list.some(({kind}) => kind !== 'bend')) throw new Trouble(`${told(product)} is a fitting and no bend`);
  const called = model.text(product, 'Tag') ?? model.text(product, 'Name');
  let before = '';
  list.forEach((body, i) => {
    const id = list.length === 1 ? name(called, `#${product.id}`) : name(called && `${called}/${i + 1}`, `#${product.id}/${i + 1}`);
    add(found, body, id, mm);
    if (body.kind === 'tube' && body.corner) found.joints.push({between: [before, id], kind: 'mitre'});
    before = id;
  });
  found.notUnderstood.push(...notes);
}

function every(library: typeof WebIfc, model: Model, found: Found, {corner_radius_mm}: IfcOptions): void {
  const project = model.all(library.IFCPROJECT)[0];
  if (project === undefined) throw new Trouble('there is no IfcProject');
  const mm = millimetres(model, model.line(project));
  const codes = {line: library.IFCLINEINDEX, arc: library.IFCARCINDEX};
  const corner = corner_radius_mm === undefined ? undefined : corner_radius_mm / mm;
  const context = {model, radians: radians(model, model.line(project)), codes, corner};
  const name = names();
  for (const id of [...model.all(library.IFCELEMENT), ...model.all(library.IFCPROXY)]) {
    let type = '';
    try {
      const product = model.line(id);
      type = product.type;
      const known = segments.test(type) || fittings.test(type);
      if (!known && product.attributes['Representation'] == null) continue; // a group of others
      if (!known) throw new Trouble(`${type} is not imported`);
      read(context, product, found, name, mm);
    } catch (failure) {
      found.notUnderstood.push({id: `#${id}`, type, reason: why(failure)});
    }
  }
}

/** Beams, columns, members, pipes and bends of an IFC file (2x3, 4, 4x3) as a frame. */
export async function fromIfc(bytes: Uint8Array, options: IfcOptions = {}): Promise<Imported> {
  loading ??= load(options.wasm);
  const [library, api] = await loading.catch((failure) => {
    loading = undefined; // the network may be back the next time
    throw failure;
  });
  const found = nothing();
  const handle = opened(api, bytes);
  if (handle < 0) found.notUnderstood.push({id: 'file', type: 'IFC', reason: 'this is no IFC file of a known schema'});
  else
    try {
      every(library, new Model(api, handle), found, options);
    } catch (failure) {
      found.notUnderstood.push({id: 'file', type: 'IFC', reason: why(failure)});
    } finally {
      api.CloseModel(handle);
    }
  return frameOf(found, options);
}
