// Files that web-ifc's own writer makes, with an extrusion of any placement and unit.
import * as WebIfc from 'web-ifc';
import {moved, product, rotation, shift} from './step.mjs';

const column = (m, j) => [m[0][j], m[1][j], m[2][j]];

async function write(schema, metres, place) {
  const api = new WebIfc.IfcAPI();
  await api.Init();
  api.SetLogLevel(WebIfc.LogLevel.LOG_LEVEL_OFF);
  const model = api.CreateModel({schema});
  const kind = WebIfc[schema];
  const put = (line) => {
    api.WriteLine(model, line);
    return line;
  };
  const text = (type, value) => new kind[type](value);
  const point = (p) => put(new kind.IfcCartesianPoint(p.map((v) => text('IfcLengthMeasure', v))));
  const direction = (d) => put(new kind.IfcDirection(d.map((v) => text('IfcReal', v))));
  const axes = (m) => put(new kind.IfcAxis2Placement3D(point(column(m, 3)), direction(column(m, 2)), direction(column(m, 0))));
  const unit = put(new kind.IfcSIUnit(kind.IfcUnitEnum.LENGTHUNIT, metres ? null : kind.IfcSIPrefix.MILLI, kind.IfcSIUnitName.METRE));
  const units = put(new kind.IfcUnitAssignment([unit]));
  put(new kind.IfcProject(text('IfcGloballyUniqueId', '0YvctVUKr0kugbFTf53O9L'), null, text('IfcLabel', 'P'), null, null, null, null, null, units));
  const k = metres ? 1000 : 1;
  const scaled = (m) => m.map((row, i) => row.map((v, j) => (j === 3 && i < 3 ? v / k : v)));
  const profile = put(new kind.IfcCircleHollowProfileDef(kind.IfcProfileTypeEnum.AREA, null, put(new kind.IfcAxis2Placement2D(point([0, 0]), null)),
    text('IfcPositiveLengthMeasure', 44.45 / k), text('IfcPositiveLengthMeasure', 5 / k)));
  const solid = put(new kind.IfcExtrudedAreaSolid(profile, axes(scaled(place.solid)), direction([0, 0, 1]), text('IfcPositiveLengthMeasure', 2345.678 / k)));
  const context = put(new kind.IfcGeometricRepresentationContext(null, text('IfcLabel', 'Model'), text('IfcDimensionCount', 3), null, axes(shift(0, 0, 0)), null));
  const body = put(new kind.IfcShapeRepresentation(context, text('IfcLabel', 'Body'), text('IfcLabel', 'SweptSolid'), [solid]));
  const outer = put(new kind.IfcLocalPlacement(null, axes(scaled(place.outer))));
  const inner = put(new kind.IfcLocalPlacement(outer, axes(scaled(place.inner))));
  const shape = put(new kind.IfcProductDefinitionShape(null, null, [body]));
  put(new kind.IfcBeam(text('IfcGloballyUniqueId', '0YvctVUKr0kugbFTf53O9M'), null, text('IfcLabel', 'W'), null, null, inner, shape, null, null));
  const bytes = api.SaveModel(model);
  api.CloseModel(model);
  return bytes;
}

const places = [
  {outer: product(shift(1200, -800.5, 30), rotation(2, 30)), inner: product(shift(5, 6000, 7), rotation(0, 41)), solid: product(shift(0, 0, -100), rotation(1, 77))},
  {outer: product(shift(-9000, 1, 2), rotation(1, -123)), inner: product(shift(10, 20, 30), rotation(2, 211)), solid: product(shift(1.5, 2.5, 3.5), rotation(0, 12))},
];
export const written = ['IFC4', 'IFC2X3'].flatMap((schema) =>
  places.map((place, i) => {
    const all = product(place.outer, place.inner, place.solid);
    return {
      name: `written by web-ifc, ${schema}, ${i === 0 ? 'metres' : 'millimetres'}`,
      bytes: () => write(schema, i === 0, place),
      members: [{id: 'W', ends: [moved(all, [0, 0, 0]), moved(all, [0, 0, 2345.678])], outer: 88.9, wall: 5}],
      others: [],
    };
  }));
