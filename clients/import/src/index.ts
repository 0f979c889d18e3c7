export {boreMap, bores} from './bores.js';
export {catalogue} from './catalogue.js';
export {columnsOf, type CsvMapping, type Field, fields, fromCsv} from './csv/index.js';
export {type DxfOptions, fromDxf, layersOf, unitOf} from './dxf.js';
export {
  type Ask,
  type Frame,
  type FrameOptions,
  type Imported,
  type Joint,
  type Member,
  type NotUnderstood,
  type Other,
  printed,
  type Size,
  type Source,
} from './frame.js';
export {fromIfc, type IfcOptions} from './ifc/index.js';
export {type CornerOptions, type Corners, type Section, type Sides, type Standard, standards} from './sections.js';
export {fromNc1, type Nc1Options} from './nc1/index.js';
export type {ImportedPart, Part} from './nc1/part.js';
export {fromPcf, type PcfOptions} from './pcf/index.js';
export {lengths, type LengthUnit} from './units.js';
