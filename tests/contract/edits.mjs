// Single edits of a valid request that a schema refuses, each with the pointers its problem may name.

export const escape = (name) => name.replaceAll('~', '~0').replaceAll('/', '~1');
const typeOf = (value) => (value === null ? 'null' : Array.isArray(value) ? 'array' : typeof value);
const copy = (value) => JSON.parse(JSON.stringify(value));

const OTHERS = [null, true, false, 'text', '12', 7, [], [1, 2], {}, {value: 1}];
const NAMES = ['tolerence_mm', 'wall', 'Kind', 'x', 'a/b', 'm~n', 'größe', '', 'constructor', 'offset_in', 'a'.repeat(200)];

const ANY = ['null', 'array', 'boolean', 'number', 'string', 'object'];
const LONG = 4;  // elements of an array that are edited
const MOST = 30000;  // elements of an array that still fit in a body

function types(contract, schema) {
  if (schema === true) return ANY;
  if ('const' in schema) return [typeOf(schema.const)];
  if (schema.enum) return [...new Set(schema.enum.map(typeOf))];
  if (schema.oneOf) return schema.oneOf.flatMap((branch) => types(contract, contract.resolve(branch)));
  return [schema.type].flat().map((type) => (type === 'integer' ? 'number' : type));
}

// The branch of a oneOf that holds the value; of objects the one whose constants and required members are there, and that knows most of its names.
export function branchOf(contract, schema, value) {
  if (schema === true || !schema.oneOf) return schema;
  const fits = (branch, item) => {
    if (branch.oneOf) return branch.oneOf.some((b) => fits(contract.resolve(b), item));
    if (branch.type !== 'object') return types(contract, branch).includes(typeOf(item));
    if (typeOf(item) !== 'object') return false;
    return (branch.required ?? []).every((name) => name in item) &&
      Object.entries(branch.properties ?? {}).every(([name, p]) => !(name in item) || (words(p) ? words(p).includes(item[name]) : suits(p, item[name])));
  };
  // A choice within, such as the kind of a target, tells the branches apart too.
  const suits = (p, item) => typeOf(item) !== 'object' || !contract.resolve(p).oneOf || fits(contract.resolve(p), item);
  const strange = ({properties}) => (properties && value !== null && typeof value === 'object' ? Object.keys(value).filter((name) => !(name in properties)).length : 0);
  const [best] = schema.oneOf.map((b) => contract.resolve(b)).filter((b) => fits(b, value)).sort((a, b) => strange(a) - strange(b));
  return branchOf(contract, best, value);
}

const words = (schema) => ('const' in schema ? [schema.const] : schema.enum);

// Could one object be meant as either? Not when a member takes other words in each.
function alike(a, b) {
  if (!a.properties || !b.properties) return false;  // one of them is no object
  return a.type === b.type && Object.entries(a.properties ?? {}).every(([name, p]) => {
    const q = b.properties[name];
    return !q || !words(p) || !words(q) || words(p).some((word) => words(q).includes(word));
  });
}

// For branches that differ by an optional member, with {method: minimax} as default: that member,
// and those that only some have.
function impliedTag(contract, whole) {
  const branches = (whole.oneOf ?? []).map((b) => contract.resolve(b)).filter((b) => b.properties);
  const tag = Object.keys(branches[0]?.properties ?? {}).find((name) => branches.every((b) => b.properties[name] && words(b.properties[name])));
  if (!tag || branches.every((b) => b.required?.includes(tag))) return [];
  const names = new Set(branches.flatMap((b) => Object.keys(b.properties)));
  return [tag, ...[...names].filter((name) => !branches.every((b) => b.properties[name]))];
}

// Returns whether a member's single value distinguishes its branch from others without such a
// member, as a preset does. With it or without it, the object is another.
export const selects = (contract, whole, name) => {
  const branches = (whole.oneOf ?? []).map((b) => contract.resolve(b)).filter((b) => b.properties);
  const has = branches.filter((b) => b.properties[name] && 'const' in b.properties[name] && b.required?.includes(name));
  return has.length > 0 && branches.some((b) => !b.properties[name]) && branches.every((b) => !b.properties[name] || has.includes(b));
};

// The groups of members of which an object has exactly one, as allOf: [{oneOf: [{required: [a]}, {required: [b]}]}].
export const groups = (schema) => (schema.allOf ?? []).map(({oneOf}) => oneOf.map(({required}) => required[0]));

// Members that go with one another or exclude one another: naming any of them is naming the edit.
function companions(contract, whole, schema) {
  const branches = (whole.oneOf ?? []).map((b) => contract.resolve(b)).filter((b) => alike(b, schema));
  const required = branches.map((b) => new Set(b.required ?? []));
  const either = [...new Set(required.flatMap((set) => [...set]))].filter((name) => !required.every((set) => set.has(name)));
  const dependent = Object.entries(schema.dependentSchemas ?? {}).flatMap(([name, {anyOf}]) => [name, ...anyOf[0].required]);
  const exclusive = groups(schema).flat();
  const few = schema.maxProperties ? Object.keys(schema.properties) : [];
  return [...either, ...dependent, ...exclusive, ...few, ...impliedTag(contract, whole)];
}

function badNumbers({minimum, maximum, exclusiveMinimum, exclusiveMaximum, type}) {
  const out = [];
  if (minimum !== undefined) out.push(minimum - Math.max(1e-6, Math.abs(minimum) * 1e-12), minimum - 1, -1e300);
  if (maximum !== undefined) out.push(maximum + Math.max(1e-6, Math.abs(maximum) * 1e-12), maximum + 1, 1e300);
  if (exclusiveMinimum !== undefined) out.push(exclusiveMinimum, exclusiveMinimum - 1e-9, -1e300);
  if (exclusiveMaximum !== undefined) out.push(exclusiveMaximum, exclusiveMaximum + 1e-9, 1e300);
  if ([type].flat().includes('integer')) out.push(12.5, 40.000001);
  return out;
}

const badWords = (word) => ['nonsense', '', word.toUpperCase(), ` ${word}`, 'x'.repeat(300)];
const badTexts = ['', 'x'.repeat(65), '\u202Eab', 'a\nb', '\u0000', 'tab\t'];

// Every edit of one value: {kind, pointers (first: the edited field), apply(body) -> the edited body}.
export function edits(contract, requestSchema, body) {
  const out = [];
  const add = (kind, path, change, ...pointers) => out.push({kind, pointers, apply: () => {
    const edited = copy(body);
    const parent = path.slice(0, -1).reduce((node, step) => node[step], edited);
    change(parent, path.at(-1));
    return edited;
  }});
  const put = (kind, path, pointer, value) => add(kind, path, (parent, name) => { parent[name] = copy(value); }, pointer);

  const walk = (given, value, path, pointer) => {
    if (given === true) return;
    const whole = contract.resolve(given);
    const schema = branchOf(contract, whole, value);
    const allowed = types(contract, whole);
    if (path.length) for (const other of OTHERS) if (!allowed.includes(typeOf(other))) put('type', path, pointer, other);
    if (typeof value === 'number') for (const bad of badNumbers(schema)) put('range', path, pointer, bad);
    if (typeof value === 'string') {
      for (const bad of schema.pattern ? badTexts : badWords(value)) put('choice', path, pointer, bad);
    }
    if (Array.isArray(value)) {
      const counts = [...Array(schema.minItems ?? 0).keys()];
      if (schema.maxItems < MOST) counts.push(schema.maxItems + 1);
      for (const n of counts) put('count', path, pointer, Array.from({length: n}, (_, i) => value[i % value.length]));
      value.slice(0, LONG).forEach((item, i) => walk(schema.items, item, [...path, i], `${pointer}/${i}`));
    }
    if (typeOf(value) === 'object') walkObject(whole, schema, value, path, pointer);
  };

  // Returns whether this member determines the object. Without it, the object would be of another
  // branch with fewer required members, in which all its special members would be unknown.
  const makes = (whole, schema, value, name) => (schema.required ?? []).includes(name) && (whole.oneOf ?? []).map((b) => contract.resolve(b))
    .some((b) => b !== schema && b.properties && !b.properties[name] && alike(b, schema) && (b.required ?? []).every((other) => other in value));

  const walkObject = (whole, schema, value, path, pointer) => {
    const either = companions(contract, whole, schema);
    const at = (name) => `${pointer}/${escape(name)}`;
    const group = (name) => (either.includes(name) ? either.filter((n) => n !== name).map(at) : []);
    for (const name of Object.keys(value)) {
      if (!selects(contract, whole, name) && !makes(whole, schema, value, name)) add('missing', [...path, name], (parent, key) => { delete parent[key]; }, at(name), ...group(name));
    }
    const known = Object.keys(schema.properties ?? {});
    const strange = known.map((name) => `${name.slice(0, -1)}${name.endsWith('x') ? 'y' : 'x'}`);
    for (const name of schema.additionalProperties === false ? [...NAMES, ...strange, ...either] : []) {
      if (Object.hasOwn(value, name) || known.includes(name)) continue;
      add(either.includes(name) ? 'exclusive' : 'unknown', [...path, name], (parent, key) => { parent[key] = 1; }, at(name), ...group(name));
    }
    for (const [name, item] of Object.entries(value)) walk(schema.properties?.[name] ?? schema.additionalProperties, item, [...path, name], at(name));
  };

  walk(requestSchema, body, [], '');
  for (const root of [null, [], [body], 'text', 3, true]) out.push({kind: 'root', pointers: [''], apply: () => root});
  return out;
}
