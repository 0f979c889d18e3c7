import {clone, isRow, type Json, type Row} from './json';
import type {Contract, Schema} from './schema';

/** The one preset there is: cut square to the wall, as a tube laser does. */
const word = 'tube_laser';
const chosen = ['groove', 'contact', 'smoothing', 'root_face_mm', 'tilt', 'torch']; // by the preset

export const pressed = (body: Row) => body['preset'] === word;
export const offered = (contract: Contract, request: Schema | undefined) =>
  contract.branches(request ?? {}).some((branch) => branch.properties?.['preset'] !== undefined);

/**
 * Returns the objects of a request that define a cut: itself, its ends and holes; a frame's
 * defaults, joints and ends.
 */
function cuts(body: Row): Row[] {
  const within = (key: string) => (Array.isArray(body[key]) ? body[key] : isRow(body[key]) && key === 'ends' ? Object.values(body[key]) : []);
  return [body, body['defaults'] ?? null, ...['ends', 'holes', 'joints'].flatMap(within)].filter(isRow);
}

/** Leaves to the preset what it chooses. Returns the request, and what was there. */
export function press(request: Row): {body: Row; taken: Row[]} {
  const body = clone(request);
  const taken = cuts(body).map((cut): Row => {
    const own = Object.fromEntries(chosen.filter((key) => key in cut).map((key) => [key, cut[key] as Json]));
    for (const key of chosen) delete cut[key];
    return own;
  });
  body['preset'] = word;
  return {body, taken};
}

/** The request as it was before, or, of a job that came with the preset, as the service understood it. */
export function release(request: Row, taken: Row[] | undefined, understood: Row | undefined): Row {
  const body = clone(request);
  delete body['preset'];
  const accept = body['accept'];
  if (isRow(accept)) for (const key of Object.keys(accept)) if (!/^max_(root_gap|extra_bevel|b)_/.test(key)) delete accept[key];
  const echoed = understood ? cuts(understood) : [];
  cuts(body).forEach((cut, i) => {
    const whole =
      taken?.[i] ?? Object.fromEntries([...chosen, 'root_surface'].flatMap((key) => (key in (echoed[i] ?? {}) ? [[key, echoed[i]?.[key] as Json]] : [])));
    for (const [key, value] of Object.entries(whole)) if (!(key in cut)) cut[key] = value;
  });
  return body;
}
