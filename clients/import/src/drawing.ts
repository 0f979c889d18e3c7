import {decimal} from './units.js';

/** The parsed values of a drawing's entity; lengths in its unit, angles in degrees. */
export interface Drawn {
  type: string;
  handle: string;
  layer: string;
  inPaperSpace: boolean;
  points: {x: number; y: number; z: number; bulge: number}[];
  end?: [number, number, number]; // of a line
  radius: number;
  angles: [number, number];
  flags: number;
  elevation: number;
  extrusion: [number, number, number];
}
export interface Drawing {
  unit: number; // $INSUNITS
  entities: Drawn[];
}

interface Group {
  code: number;
  value: string;
}

/** Pairs of lines, a code and a value. */
function groupsOf(text: string): Group[] {
  const lines = text.replace(/^\uFEFF/, '').split(/\r\n|\n|\r/);
  const out: Group[] = [];
  for (let i = 0; i + 1 < lines.length; i += 2) {
    const code = (lines[i] as string).trim();
    if (!/^-?\d{1,5}$/.test(code)) throw new Error(`line ${i + 1} is no group code`);
    out.push({code: Number(code), value: (lines[i + 1] as string).trim()});
  }
  return out;
}

const begun = (type: string): Drawn => ({
  type,
  handle: '',
  layer: '0',
  inPaperSpace: false,
  points: [],
  radius: Number.NaN,
  angles: [Number.NaN, Number.NaN],
  flags: 0,
  elevation: 0,
  extrusion: [0, 0, 1],
});

/** One group of an entity. A LWPOLYLINE has many points, each begins at its x; others have one. */
function take(entity: Drawn, {code, value}: Group): void {
  const number = decimal(value);
  const last = entity.points[entity.points.length - 1];
  const many = entity.type === 'LWPOLYLINE';
  if (code === 5) entity.handle = value;
  else if (code === 8) entity.layer = value;
  else if (code === 67) entity.inPaperSpace = number !== 0;
  else if (code === 70) entity.flags = Number.isInteger(number) ? number : 0;
  else if (code === 10 && (many || !last)) entity.points.push({x: number, y: 0, z: 0, bulge: 0});
  else if (code === 20 && last) last.y = number;
  else if (code === 30 && last) last.z = number;
  else if (code === 42 && last) last.bulge = number;
  else if (code >= 11 && code <= 31 && code % 10 === 1) {
    entity.end ??= [0, 0, 0];
    entity.end[Math.floor(code / 10) - 1] = number;
  } else if (code === 38) entity.elevation = number;
  else if (code === 40) entity.radius = number;
  else if (code === 50 || code === 51) entity.angles[code - 50] = number;
  else if (code >= 210 && code <= 230 && code % 10 === 0) entity.extrusion[Math.floor(code / 10) - 21] = number;
}

/**
 * Returns the entities of a drawing in DXF, in one pass; without those within blocks and tables.
 */
export function drawingOf(text: string): Drawing {
  const drawing: Drawing = {unit: Number.NaN, entities: []};
  let [section, variable] = ['', ''];
  let entity: Drawn | undefined;
  let whole: Drawn | undefined; // the polyline whose vertices come as entities of their own
  let sections = 0;
  for (const group of groupsOf(text)) {
    const {code, value} = group;
    if (code === 0) {
      entity = undefined;
      if (value === 'SECTION') section = 'next';
      else if (value === 'ENDSEC') section = '';
      else if (value === 'EOF') break;
      else if (section === 'ENTITIES' && value === 'SEQEND') whole = undefined;
      else if (section === 'ENTITIES') {
        entity = begun(value);
        if (value === 'VERTEX' && whole) continue;
        whole = value === 'POLYLINE' ? entity : undefined;
        drawing.entities.push(entity);
      }
    } else if (section === 'next' && code === 2) {
      section = value;
      ++sections;
    } else if (section === 'HEADER') {
      if (code === 9) variable = value;
      else if (variable === '$INSUNITS') drawing.unit = decimal(value);
    } else if (entity && entity.type === 'VERTEX' && whole) {
      vertex(entity, whole, group);
    } else if (entity) take(entity, group);
  }
  if (sections === 0) throw new Error('it has no sections');
  return drawing;
}

/** A vertex's point goes to its polyline, of which the own point only states the elevation. */
function vertex(entity: Drawn, whole: Drawn, group: Group): void {
  const before = entity.points.length;
  take(entity, group);
  if (before === 0 && entity.points[0]) {
    if (whole.end === undefined) {
      whole.elevation = whole.points[0]?.z ?? 0;
      whole.points = [];
      whole.end = [0, 0, 0];
    }
    whole.points.push(entity.points[0]);
  }
}
