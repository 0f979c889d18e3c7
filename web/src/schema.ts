import {clone, isRow, type Json, type Row} from './json';
import {t} from './language';
import {choice, label} from './words';

/** A format of an answer, its drawings (the first is the default) and the query parameters it reads. */
export interface Format {
  media: string;
  views: string[];
  options: {name: string; description: string; schema: Schema}[];
}

export interface Schema {
  $ref?: string;
  type?: string;
  const?: Json;
  enum?: Json[];
  default?: Json;
  description?: string;
  title?: string;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
  minItems?: number;
  maxItems?: number;
  maxLength?: number;
  items?: Schema;
  oneOf?: Schema[];
  anyOf?: Schema[];
  allOf?: Schema[];
  required?: string[];
  properties?: Record<string, Schema>;
  additionalProperties?: boolean | Schema;
}
interface Document {
  info: {version: string};
  paths: Record<
    string,
    {
      post?: {
        summary: string;
        description?: string;
        requestBody: {content: Record<string, {schema: Schema}>};
        parameters?: {$ref: string}[];
        responses: Record<string, {content: Record<string, {'x-views'?: string[]; 'x-options'?: string[]}>}>;
      };
    }
  >;
  components: {schemas: Record<string, Schema>; parameters: Record<string, {name: string; description?: string; schema: Schema}>};
}

/** Fields whose value names the kind of what they are in. */
const telling = ['kind', 'method', 'rule'];

// Initial value of a new field, if the contract leaves it open: a joint that can be computed.
const beginnings: Record<string, Json> = {
  outer_diameter_mm: 60,
  wall_mm: 4,
  inclination_deg: 60,
  size: 'CHS 60.3x4',
  point_mm: [0, 0, 0],
  direction: [1, 0, 0],
  normal: [0, 0, 1],
  up: [0, 1, 0],
  inwards: [0, 1, 0],
  width_mm: 80,
  height_mm: 80,
  corner_radius_mm: 8,
  half_angle_deg: 15,
  bend_radius_mm: 120,
  bend_deg: 90,
  start_mm: [0, 0, 0],
  end_mm: [0, 0, 1000],
  within_mm: 50,
  kerf_mm: 1.5,
  angle_deg: 30,
  max_slope_deg_per_mm: 5,
  max_curvature_deg_per_mm2: 1,
  speed_mm_min: 600,
  mm_min: 600,
  machine: 'five_axis_cutter',
  uniform_points: 360,
  tolerance_mm: 0.05,
  min_deg: -80,
  max_deg: 80,
  transition_points: 15,
  gap_mm: 2,
  bevel_deg: 45,
  area_mm2: 50,
  dihedral_deg: [90, 180],
  groove_deg: [45, 45],
  degree: 2,
  period_s: 0.002,
  id: 'new',
  members: [
    {id: 'chord', start_mm: [-500, 0, 0], end_mm: [500, 0, 0], outer_diameter_mm: 168.3, wall_mm: 8},
    {id: 'branch', start_mm: [0, 0, 0], end_mm: [300, 0, 600], outer_diameter_mm: 88.9, wall_mm: 5},
  ],
  member: 'branch',
  end: 'start',
  'rectangular_tube.size': 'SHS 60x60x4 EN 10219',
  'flat_oval_tube.width_mm': 40,
  'target.length_mm': 1000,
  'chord.outer_diameter_mm': 168.3,
  'chord.wall_mm': 8,
  'branch.outer_diameter_mm': 88.9,
  'branch.wall_mm': 8,
  'root_face.height_mm': 1,
  'root_face.width_mm': 2,
  'setup.pivot_length_mm': 500,
  'mill.half_angle_deg': 30,
  'mill.tip_radius_mm': 3,
  'mill.length_mm': 40,
  arm_mm: 430,
  pivot_distance_mm: 340,
  pivot_offset_mm: 90,
  rest_angle_rad: 1.3,
  slot_angle_rad: 1.69,
  rad_per_mm: 0.000486,
  start_feed_mm: 0,
  end_feed_mm: 30,
  feed_mm_s: 1,
};

/** The service's own description of itself: forms and downloads are drawn from it, not from a list here. */
export class Contract {
  constructor(readonly document: Document) {}

  request(path: string): Schema | undefined {
    return this.document.paths[path]?.post?.requestBody.content['application/json']?.schema;
  }
  summary(path: string): string {
    return this.document.paths[path]?.post?.summary ?? '';
  }
  formats(path: string): Format[] {
    const post = this.document.paths[path]?.post;
    return Object.entries(post?.responses['200']?.content ?? {}).map(([media, about]) => ({
      media,
      views: about['x-views'] ?? [],
      options: (about['x-options'] ?? []).flatMap((name) => {
        const found = this.document.components.parameters[name];
        return found ? [{name: found.name, description: found.description ?? '', schema: this.resolve(found.schema)}] : [];
      }),
    }));
  }

  resolve(schema: Schema | boolean): Schema {
    if (typeof schema === 'boolean') return {}; // anything
    if (schema.anyOf) {
      const {anyOf, ...rest} = schema; // a form shows one branch, whether or not others would fit too
      return {...rest, oneOf: anyOf};
    }
    if (!schema.$ref) return schema;
    const {$ref, ...beside} = schema;
    return {...this.resolve(this.document.components.schemas[$ref.split('/').pop() as string] ?? {}), ...beside};
  }

  branches(schema: Schema): Schema[] {
    return (this.resolve(schema).oneOf ?? []).flatMap((inner) => {
      const branch = this.resolve(inner);
      return branch.oneOf ? this.branches(branch) : [branch];
    });
  }

  /** The branches that are called as one of them is. */
  alike(branches: Schema[], chosen: Schema): Schema[] {
    const name = this.branchName(branches, chosen);
    return branches.filter((branch) => this.branchName(branches, branch) === name);
  }

  /** Branches of one name as one: they differ by the tube that is cut, whose own choice has the kinds of all of them. */
  together(branches: Schema[], chosen: Schema): Schema {
    const tubes = this.alike(branches, chosen).flatMap(({properties}) => (properties?.['target'] ? [properties['target']] : []));
    return tubes.length > 1 ? {...chosen, properties: {...chosen.properties, target: {oneOf: tubes}}} : chosen;
  }

  /** The branch that a value is written in, or the first. */
  branchOf(branches: Schema[], value: Json | undefined): number {
    const scores = branches.map((branch) => this.score(branch, value));
    return Math.max(0, scores.indexOf(Math.max(...scores)));
  }

  private score(branch: Schema, value: Json | undefined): number {
    if ('const' in branch) return branch.const === value ? 100 : -100;
    if (branch.enum) return branch.enum.includes(value as Json) ? 100 : -100;
    if (branch.type === 'array') return Array.isArray(value) ? 50 : -100;
    if (branch.type === 'null') return value === null ? 50 : -100;
    if (!branch.properties) {
      const type = branch.type === 'integer' ? 'number' : branch.type;
      return typeof value === type ? 50 : -100;
    }
    if (!isRow(value)) return -100;
    let score = 0;
    for (const [key, inner] of Object.entries(branch.properties)) {
      const choices = this.resolve(inner);
      if (!(key in value)) continue;
      const decides = branch.required?.includes(key) || telling.includes(key);
      if ('const' in choices && decides) score += choices.const === value[key] ? 20 : -40;
      else if ('const' in choices) score += choices.const === value[key] ? 10 : -10;
      else if (choices.enum) score += choices.enum.includes(value[key] as Json) ? 10 : -10;
      else score += key === 'target' ? this.cuts(choices, value[key] as Json) : 1;
    }
    for (const key of branch.required ?? []) if (key in value) score += 2;
    for (const key of Object.keys(value)) if (!(key in branch.properties)) score -= 5;
    return score;
  }

  /** The tube that is cut decides more than all fields beside it, because those that its kind does not have are left out. */
  private cuts(schema: Schema, value: Json): number {
    const branches = this.branches(schema);
    return !branches.length || branches.some((branch) => this.score(branch, value) >= 0) ? 50 : -50;
  }

  /** Returns "tube · outer Ø, axis": the fields that distinguish a branch from the others. */
  branchName(branches: Schema[], branch: Schema): string {
    if (branch.title) return t(branch.title);
    if ('const' in branch) return choice(branch.const);
    if (branch.enum) return branch.enum.map(choice).join(' / ');
    if (!branch.properties) return branch.type === 'null' ? t('none') : t(branch.type ?? 'value');
    const kind = this.kind(branch);
    const like = branches.filter((other) => other.properties && this.kind(other) === kind);
    const alike = like.length === branches.length;
    if (like.length === 1 && kind) return kind;
    const shared = (key: string) => like.filter((other) => other.required?.includes(key)).length;
    const own = (branch.required ?? []).filter((key) => shared(key) < like.length);
    const fewest = Math.min(...own.map(shared));
    const by = own
      .filter((key) => shared(key) === fewest)
      .slice(0, 2)
      .map((key) => label(key))
      .join(t(', '));
    return [alike ? '' : kind, by].filter(Boolean).join(' · ') || t('no {field}', {field: label(this.telling(branches))});
  }

  /** Returns the field that distinguishes some branches. */
  private telling(branches: Schema[]): string {
    const told = (branch: Schema) => (branch.required ?? []).find((key) => 'const' in this.resolve(branch.properties?.[key] ?? {}));
    return branches.map(told).find((key) => key !== undefined) ?? 'kind';
  }

  kind(branch: Schema): string {
    for (const [key, inner] of Object.entries(branch.properties ?? {})) {
      const schema = this.resolve(inner);
      if (!branch.required?.includes(key) && !telling.includes(key)) continue;
      if ('const' in schema && typeof schema.const === 'string') return choice(schema.const);
    }
    for (const [key, inner] of Object.entries(branch.properties ?? {})) {
      const schema = this.resolve(inner);
      if (schema.enum && telling.includes(key)) return schema.enum.map(choice).join(' / ');
    }
    return '';
  }

  /** Whether there is nothing to fill in: one value is all that it may have. */
  fixed(given: Schema): boolean {
    const schema = this.resolve(given);
    if ('const' in schema) return true;
    const inner = Object.values(schema.properties ?? {});
    return inner.length > 0 && inner.every((each) => this.fixed(each));
  }

  /** Returns an initial value; keeps the values of `old` under the same names. */
  make(given: Schema, old?: Json, name = '', within = ''): Json {
    const schema = this.resolve(given);
    if ('const' in schema) return schema.const as Json;
    const branches = this.branches(schema);
    if (branches.length > 0 && !schema.properties) return this.make(branches[this.branchOf(branches, old)] as Schema, old, name, within);
    if (schema.enum) return (old !== undefined && schema.enum.includes(old) ? old : (schema.default ?? schema.enum[0])) as Json;
    if (schema.properties) return this.makeRow(schema, isRow(old) ? old : {}, name);
    if (old !== undefined && typeof old === (schema.type === 'integer' ? 'number' : schema.type)) return old;
    if (schema.type === 'array' && Array.isArray(old) && old.length >= (schema.minItems ?? 0) && old.length <= (schema.maxItems ?? Infinity))
      return old.map((each) => this.make(schema.items ?? {}, each, name));
    const beginning = beginnings[`${within}.${name}`] ?? beginnings[name];
    if (beginning !== undefined) return clone(beginning);
    if (schema.type === 'array') {
      return Array.from({length: schema.minItems ?? 0}, () => this.make(schema.items ?? {}, undefined, name));
    }
    if (schema.default !== undefined) return schema.default;
    if (schema.type === 'null') return null;
    if (schema.type === 'boolean') return false;
    return schema.type === 'string' ? '' : (schema.minimum ?? 1);
  }

  /** The value of an optional field that is added: a list of objects begins with one, because an empty list has no fields to fill in. */
  begun(given: Schema, name: string): Json {
    const schema = this.resolve(given);
    const made = this.make(schema, undefined, name);
    const item = this.resolve(schema.items ?? {});
    return Array.isArray(made) && !made.length && (item.properties ?? item.oneOf) ? [this.make(item)] : made;
  }

  private makeRow(schema: Schema, old: Row, name: string): Row {
    const made: Row = {};
    // Of alternative fields the first, unless another is present.
    const ways = (schema.allOf ?? []).flatMap(({oneOf}) =>
      oneOf?.some((way) => way.required?.every((key) => key in old)) ? [] : (oneOf?.[0]?.required ?? []),
    );
    const asked = [...(schema.required ?? []), ...ways];
    const kind = this.resolve(schema.properties?.['kind'] ?? {}).const;
    for (const [key, inner] of Object.entries(schema.properties ?? {})) {
      const one = this.resolve(inner);
      const implied = 'const' in one && one.const === one.default && !telling.includes(key);
      const own = asked.includes(key) || ('const' in one && !implied);
      const within = typeof kind === 'string' && `${kind}.${key}` in beginnings ? kind : name;
      if (own || (key in old && !implied)) made[key] = this.make(inner, old[key], key, within);
    }
    return made;
  }
}
