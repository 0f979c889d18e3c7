export {bores} from './bores.js';
export {columnsOf, type CsvMapping, type Field, fields, fromCsv} from './csv.js';
export {type DxfOptions, fromDxf, layersOf, unitOf} from './dxf.js';
export {type Frame, type FrameOptions, type Imported, type Joint, type Member, type NotUnderstood, type Other, printed, type Size} from './frame.js';
export {fromIfc, type IfcOptions} from './ifc/index.js';
export {fromPcf, type PcfOptions} from './pcf.js';
export {lengths, type LengthUnit} from './units.js';
