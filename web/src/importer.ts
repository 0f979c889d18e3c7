// Comes with the worker, when the first model does: the parsers, and where the one of IFC has its WebAssembly.
import wasm from 'web-ifc/web-ifc.wasm?url';

export {columnsOf, fields, fromCsv, fromDxf, fromIfc, fromNc1, fromPcf, layersOf, lengths, unitOf} from '../../clients/import/src/index';
export type {Imported, ImportedPart, LengthUnit, Size} from '../../clients/import/src/index';
export {wasm};
