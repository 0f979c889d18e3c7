import {isRow, type Json, type Row} from './json';
import type {Contract, Schema} from './schema';
import {path, type Endpoint} from './service';

/** How well a value fits a schema: 1 for each field that may be there, less for one that may not or is missing. */
function fit(contract: Contract, given: Schema, value: Json | undefined, depth: number): number {
  const schema = contract.resolve(given);
  const branches = contract.branches(schema);
  if (branches.length && !schema.properties) return Math.max(...branches.map((each) => fit(contract, each, value, depth)));
  if ('const' in schema) return schema.const === value ? 1 : -4;
  if (schema.enum) return schema.enum.includes(value as Json) ? 1 : -4;
  if (Array.isArray(value) && schema.items && depth > 0) return value.length ? fit(contract, schema.items, value[0], depth - 1) / 2 : 0;
  if (!schema.properties || !isRow(value)) return 0;
  let sum = 0;
  for (const [key, inner] of Object.entries(value)) {
    const own = schema.properties[key];
    sum += own === undefined ? -4 : 1 + (depth > 0 ? Math.min(0, fit(contract, own, inner, depth - 1)) : 0);
  }
  for (const key of schema.required ?? []) if (!(key in value)) sum -= 4;
  return sum;
}

export interface Job {
  endpoint: string;
  body: Row;
}

/** The job that a file holds: a request, whose endpoint its fields tell, or an answer with the request in it. Null if it is no job. */
export function jobOf(text: string, contract: Contract, endpoints: Endpoint[], likely: string): Job | null {
  let read: unknown;
  try {
    read = JSON.parse(text);
  } catch {
    return null;
  }
  if (!isRow(read)) return null;
  const told = isRow(read['job']) && read['job']['endpoint'];
  if (typeof told === 'string' && isRow(read['request']) && endpoints.some(({id}) => id === told)) return {endpoint: told, body: read['request']};
  const body = read;
  const ranked = endpoints
    .map(({id}) => ({id, fits: fit(contract, contract.request(path(id)) ?? {}, body, 2) + (id === likely ? 0.5 : 0)}))
    .sort((a, b) => b.fits - a.fits);
  const best = ranked[0];
  return best && best.fits > 0 ? {endpoint: best.id, body} : null;
}
