import {exact} from '../frame.js';
import {type Line, type Model, told, Trouble} from './model.js';

// ISO 1000, as IfcSIPrefix names them: powers of ten.
const prefixes: Record<string, number> = {
  EXA: 18,
  PETA: 15,
  TERA: 12,
  GIGA: 9,
  MEGA: 6,
  KILO: 3,
  HECTO: 2,
  DECA: 1,
  DECI: -1,
  CENTI: -2,
  MILLI: -3,
  MICRO: -6,
  NANO: -9,
  PICO: -12,
  FEMTO: -15,
  ATTO: -18,
};

/** How many of the SI unit called `name` one of this unit is, as a number and a power of ten. */
function inSi(model: Model, unit: Line, name: string, depth = 0): {factor: number; power: number} {
  if (depth > 8) throw new Trouble(`${told(unit)} is given by itself`);
  if (unit.type === 'IfcSIUnit') {
    const prefix = model.text(unit, 'Prefix');
    const power = prefix === undefined ? 0 : prefixes[prefix];
    if (model.text(unit, 'Name') !== name || power === undefined) throw new Trouble(`${told(unit)} is no ${name}`);
    return {factor: 1, power};
  }
  if (!unit.type.startsWith('IfcConversionBasedUnit')) throw new Trouble(`${told(unit)} is no SI unit, nor one given by such`);
  const measure = model.of(unit, 'ConversionFactor');
  const {factor, power} = inSi(model, model.of(measure, 'UnitComponent'), name, depth + 1);
  return {factor: factor * model.positive(measure, 'ValueComponent'), power};
}

/** Returns the project's unit of a kind; undefined if it has no such unit. */
function unitOf(model: Model, project: Line, kind: string): Line | undefined {
  const assignment = model.maybe(project, 'UnitsInContext');
  if (!assignment) return undefined;
  return model.list(assignment, 'Units').find((unit) => model.text(unit, 'UnitType') === kind);
}

/** How many mm the project's unit of length is. */
export function millimetres(model: Model, project: Line): number {
  const unit = unitOf(model, project, 'LENGTHUNIT');
  if (!unit) throw new Trouble(`${told(project)} has no unit of length`);
  const {factor, power} = inSi(model, unit, 'METRE');
  return exact(factor * Number(`1e${power + 3}`));
}

/** Returns its unit of angle in rad; undefined if it has no such unit. */
export function radians(model: Model, project: Line): number | undefined {
  const unit = unitOf(model, project, 'PLANEANGLEUNIT');
  if (!unit) return undefined;
  const {factor, power} = inSi(model, unit, 'RADIAN');
  return factor * Number(`1e${power}`);
}
