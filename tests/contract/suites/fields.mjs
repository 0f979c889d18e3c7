// The fields of every object of a request in the contract are those that its reader knows, in both
// directions: an unknown name gets the list of those known there. If a name is known only for
// another kind of the object, it must be refused.
import {branchOf, escape, selects} from '../edits.mjs';
import {drawn, fromSchema, sound} from '../generate.mjs';
import {each} from '../service.mjs';

const ANY = 100;   // bodies from only the schema, each endpoint
const MORE = 60000;  // of them looked through, at most, for objects not seen yet
const NESTED = 400;  // with another endpoint's request within, each way
const SOUND = 40;  // sound ones
const LISTED = 32;  // fields that a problem names
const AT_ONCE = 24;  // objects of one request
const STRANGE = 'Q'.repeat(65);  // too long to be taken for a name misspelt
const LIST = 'known here: ';

// Errors of a field's value.
const OF_VALUES = ['wrong_type', 'not_a_number', 'not_an_integer', 'out_of_range', 'bad_choice', 'bad_text', 'wrong_count', 'missing_field'];

// In the contract as the request by itself; inside of another one the whole member is refused.
const REFUSED_WHOLE = ['/cut/accept', '/part/accept', '/part/ends/start/end_tabs/*', '/mill_path/probe/*'];

const closed = (schema) => schema.properties && schema.additionalProperties === false;

// Every closed object a request may have: {schema, where}.
function* reachable(contract, given, where, seen = new Set()) {
  const schema = contract.resolve(given);
  if (schema === true || schema === undefined || seen.has(schema)) return;
  seen.add(schema);
  if (closed(schema)) yield {schema, where};
  for (const branch of schema.oneOf ?? []) yield* reachable(contract, branch, where, seen);
  for (const [name, property] of Object.entries(schema.properties ?? {})) yield* reachable(contract, property, `${where}/${name}`, seen);
  if (schema.items) yield* reachable(contract, schema.items, `${where}/*`, seen);
}

// The closed objects of a body: {object, pointer, schema}.
function* objects(contract, given, value, pointer = '') {
  if (given === undefined || given === true || value === null || typeof value !== 'object') return;
  const whole = contract.resolve(given);
  const schema = branchOf(contract, whole, value);
  if (Array.isArray(value)) {
    for (const [i, item] of value.entries()) yield* objects(contract, schema.items, item, `${pointer}/${i}`);
    return;
  }
  if (closed(schema)) yield {object: value, pointer, schema, whole};
  for (const [name, item] of Object.entries(value)) yield* objects(contract, schema.properties?.[name], item, `${pointer}/${escape(name)}`);
}

// Puts the strange name into some of a body's objects and returns the reader's list of known names
// for each.
async function asked(service, endpoint, body, some) {
  for (const {object} of some) object[STRANGE] = 1;
  const reply = await service.post(endpoint.path, body);
  for (const {object} of some) delete object[STRANGE];
  if (reply.status !== 422) return [];
  const hints = new Map(JSON.parse(reply.text).errors.map(({pointer, hint}) => [pointer, hint ?? '']));
  return some.map((place) => [place, hints.get(`${place.pointer}/${STRANGE}`)])
    .filter(([, hint]) => hint?.startsWith(LIST)).map(([place, hint]) => [place, hint.slice(LIST.length).split(', ')]);
}

// Returns whether a member that is not in the contract is refused there, because of its presence
// and not only of its value; undefined if the body has more errors than a problem names, or others by which its kind is unknown.
async function refused(service, endpoint, body, {object, pointer}, name) {
  const codes = [];
  let elsewhere = false;
  for (const value of [1, {}, [1, 2], 'text']) {
    object[name] = value;
    const reply = await service.post(endpoint.path, body);
    const errors = reply.status === 422 ? JSON.parse(reply.text).errors : [];
    const here = errors.filter((e) => e.pointer.startsWith(`${pointer}/`));
    if (errors.length >= LISTED) {
      delete object[name];
      return undefined;
    }
    elsewhere ||= here.length < errors.length;
    codes.push(here.map(({code}) => code));
  }
  delete object[name];
  const is = codes.every((all) => all.length > 0) && codes.flat().some((code) => !OF_VALUES.includes(code));
  return is || !elsewhere ? is : undefined;
}

class Known {
  lists = new Map();  // of names, by schema
  beside = new Map();  // names the contract has no place for, by schema
  compared = 0;

  constructor({service, contract, report}, posts, endpoint) {
    Object.assign(this, {service, contract, report, posts, endpoint});
    this.closed = [...reachable(contract, endpoint.request, '')].filter(({where}) => !REFUSED_WHOLE.includes(where));
  }

  missing(schema) {
    return Object.keys(schema.properties).filter((name) => !this.lists.get(schema)?.has(name));
  }

  // The pins of a body are checked before it is read.
  async learn({numerics: _, machine_sha256: __, ...body}, wanted = () => true) {
    const all = [...objects(this.contract, this.endpoint.request, body)].filter(({schema}) => wanted(schema));
    for (let i = 0; i < all.length && i < 4 * AT_ONCE; i += AT_ONCE) {
      for (const [place, list] of await asked(this.service, this.endpoint, body, all.slice(i, i + AT_ONCE))) {
        this.compared += 1;
        this.lists.set(place.schema, new Set([...(this.lists.get(place.schema) ?? []), ...list]));
        for (const name of list) if (!Object.hasOwn(place.schema.properties, name)) await this.judge(body, place, name);
      }
    }
  }

  async judge(body, place, name) {
    const judged = this.beside.get(place.schema) ?? new Set();
    if (judged.has(name) || selects(this.contract, place.whole, name)) return;
    this.beside.set(place.schema, judged.add(name));
    const is = await refused(this.service, this.endpoint, body, place, name);
    if (is === undefined) judged.delete(name);
    else this.report.expect(is, `${this.endpoint.id} ${place.pointer || '/'}`,
      `the reader knows ${name}, the contract does not, and it is not refused`);
  }

  // A request, and the kinds of it that another request may hold.
  branches(request) {
    return [request, ...(request.anyOf ?? []).map((branch) => this.contract.resolve(branch))];
  }

  // Bodies that hold another endpoint's request, as a schedule holds a part: the first of each way that has one, with others of
  // that endpoint's in its place.
  *nested(bodies, seed) {
    const had = new Set();
    for (const body of bodies) {
      const {properties = {}} = branchOf(this.contract, this.endpoint.request, body);
      for (const [name, property] of Object.entries(properties)) {
        const own = this.contract.resolve(property);
        const of = name in body && !had.has(property) && this.posts.find(({request}) => this.branches(request).includes(own));
        if (!of) continue;
        had.add(property);
        const any = fromSchema(this.contract, own).filter((inner) => !('accept' in inner) && of.validRequest(inner));
        // Examples first: a drawn request may have more errors than an answer lists, and the list then has none of the body around it.
        for (const inner of [...of.examples.map((example) => example.body), ...drawn(any, seed, NESTED)]) yield {...structuredClone(body), [name]: structuredClone(inner)};
      }
    }
  }

  async learnAll(seed) {
    const any = fromSchema(this.contract, this.endpoint.request).filter((body) => this.endpoint.validRequest(body));
    const examples = this.endpoint.examples.map(({body}) => structuredClone(body));
    const bodies = [...examples, ...drawn(any, seed, ANY)];
    await each([...bodies, ...drawn(sound(this.contract, this.endpoint), seed, SOUND)], (body) => this.learn(body));
    const wanted = (schema) => this.missing(schema).length > 0;
    for (const more of [this.nested(bodies, seed + 1), drawn(any, seed + 1, MORE)]) {
      for (const body of more) {
        if (!this.closed.some(({schema}) => wanted(schema))) return;
        await this.learn(body, wanted);
      }
    }
  }
}

export async function fields(context) {
  let compared = 0;
  let both = 0;
  let beside = 0;
  const posts = context.contract.posts();
  for (const endpoint of posts) {
    const known = new Known(context, posts, endpoint);
    await known.learnAll(context.seed);
    for (const {schema, where} of known.closed) {
      const missing = known.missing(schema);
      context.report.expect(missing.length === 0, `${endpoint.id} ${where || '/'}`,
        `${known.lists.has(schema) ? 'the reader does not know' : 'no request reached'} ${missing}`);
      both += Object.keys(schema.properties).length - missing.length;
    }
    for (const names of known.beside.values()) beside += names.size;
    compared += known.compared;
    context.report.expect(known.closed.length > 0, endpoint.id, 'has no closed object');
  }
  return [`${both} fields known to both sides, ${beside} to the reader alone, in ${compared} objects`];
}
