import type {Vector} from '../geometry.js';
import {clean} from '../frame.js';
import {decimal} from '../units.js';

/** Why a component is not in the frame. */
export class Trouble extends Error {}

export interface Attribute {
  name: string;
  words: string[];
  line: number;
}

export interface Component {
  line: number;
  type: string;
  attributes: Attribute[];
}

export interface Units {
  coordinates: number; // mm
  bore: 'INCH' | 'MM';
  perBore: number; // how many of that unit the file's numbers are
}

const coordinateUnits: Record<string, number> = {MM: 1, 'MM-HUNDREDTH': 0.01, INCH: 25.4};
const boreUnits: Record<string, Pick<Units, 'bore' | 'perBore'>> = {
  INCH: {bore: 'INCH', perBore: 1},
  'INCH-SIXTEENTH': {bore: 'INCH', perBore: 1 / 16},
  MM: {bore: 'MM', perBore: 1},
};

/** A component begins at the margin, its attributes are indented. */
export function components(text: string): Component[] {
  const out: Component[] = [];
  text.split(/\r\n|\n|\r/).forEach((line, i) => {
    const [name, ...words] = line.trim().split(/\s+/);
    if (!name) return;
    const component = out[out.length - 1];
    if (/^\s/.test(line) && component) component.attributes.push({name, words, line: i + 1});
    else out.push({line: i + 1, type: name, attributes: [{name, words, line: i + 1}]});
  });
  return out;
}

const known = (units: Record<string, unknown>): string => Object.keys(units).join(', ');

/** Returns the units that a file must state before its numbers have a meaning. */
export function unitsOf(all: Component[]): Units {
  const said = (name: string) => all.find(({type}) => type === name)?.attributes[0]?.words[0]?.toUpperCase();
  const [coordinates, bore] = [said('UNITS-CO-ORDS'), said('UNITS-BORE')];
  const mm = Object.hasOwn(coordinateUnits, coordinates ?? '') ? coordinateUnits[coordinates as string] : undefined;
  if (mm === undefined) throw new Trouble(`UNITS-CO-ORDS is ${coordinates ?? 'missing'}; known are ${known(coordinateUnits)}`);
  const of = Object.hasOwn(boreUnits, bore ?? '') ? boreUnits[bore as string] : undefined;
  if (of === undefined) throw new Trouble(`UNITS-BORE is ${bore ?? 'missing'}; known are ${known(boreUnits)}`);
  return {coordinates: mm, ...of};
}

/** A point and its bore; "6BW" is a bore and a kind of end without a space between. */
export function pointIn({name, words}: Attribute, units: Units): {at: Vector; bore: number} {
  const at = words.slice(0, 3).map((word) => decimal(word) * units.coordinates);
  if (at.length < 3 || !at.every(Number.isFinite)) throw new Trouble(`its ${name} is not a point: ${clean(words.join(' '))}`);
  const bore = /^([-+.\d]{1,64})(?:["A-Z]{0,9})$/i.exec(words[3] ?? '')?.[1];
  return {at: at as Vector, bore: decimal(bore) * units.perBore};
}

export function pointOf(component: Component, name: string, units: Units, nth = 0): {at: Vector; bore: number} {
  const attribute = component.attributes.filter((each) => each.name === name)[nth];
  if (!attribute) throw new Trouble(`it has no ${nth === 0 ? '' : 'second '}${name}`);
  return pointIn(attribute, units);
}
