// Files that would take long, or go on without end, if nothing bounded them.
import {file, ours, outline, squareFaces} from './nc1_files.mjs';
import {shift, Step} from './step.mjs';

const ifc = (edit) => {
  const step = new Step('IFC4');
  step.units('millimetre');
  const ring = () => step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', 50, 5);
  const solid = () => step.add('IFCEXTRUDEDAREASOLID', ring(), '$', step.direction([0, 0, 1]), 1000);
  const beam = (item) => step.product('IFCBEAM', 'X', step.placement(shift(0, 0, 0)), step.body([item]));
  edit({step, solid, beam, next: (ahead = 1) => `#${step.lines.length + ahead}`});
  return step.text();
};
const map = (step, items) => {
  const inner = step.add('IFCSHAPEREPRESENTATION', '$', "'Body'", "'SweptSolid'", `(${items.join(',')})`);
  return step.add('IFCREPRESENTATIONMAP', step.axes(shift(0, 0, 0)), inner);
};
const target = (step) => step.add('IFCCARTESIANTRANSFORMATIONOPERATOR3D', '$', '$', step.point([0, 0, 0]), '$', '$');
const many = (n, of) => Array.from({length: n}, (_, i) => of(i));
const pairs = (...all) => all.map(([code, value]) => `${code}\n${value}\n`).join('');
const drawing = (entities) => `${pairs([0, 'SECTION'], [2, 'HEADER'], [9, '$INSUNITS'], [70, 4], [0, 'ENDSEC'], [0, 'SECTION'], [2, 'ENTITIES'])}${entities}${pairs([0, 'ENDSEC'], [0, 'EOF'])}`;
const line = (layer, x) => pairs([0, 'LINE'], [5, 'A'], [8, layer], [10, 0], [20, 0], [30, 0], [11, x], [21, 0], [31, 0]);
const digits = '1'.repeat(1000000);
const pcf = (body) => `UNITS-BORE INCH\nUNITS-CO-ORDS MM\n${body}`;
const heads = 'id,x1,y1,z1,x2,y2,z2,od,wall\n';

/** Name, kind, the file, and the expected text of its list. */
export const hostile = [
  ['mapped items nested ten thousand deep', 'ifc', () => ifc(({step, solid, beam}) => {
    let item = solid();
    for (let i = 0; i < 10000; ++i) item = step.add('IFCMAPPEDITEM', map(step, [item]), target(step));
    beam(item);
  }), /nested more than/],
  ['mapped items of ten, in ten, in ten ...', 'ifc', () => ifc(({step, solid, beam}) => {
    let item = solid();
    for (let i = 0; i < 12; ++i) item = step.add('IFCMAPPEDITEM', map(step, Array(10).fill(item)), target(step));
    beam(item);
  }), /one of more than/],
  ['an item within itself', 'ifc', () => ifc(({step, beam}) => {
    const to = target(step);
    const axes = step.axes(shift(0, 0, 0));
    const own = `#${step.lines.length + 3}`;
    step.add('IFCSHAPEREPRESENTATION', '$', "'Body'", "'SweptSolid'", `(${own})`);
    const source = step.add('IFCREPRESENTATIONMAP', axes, `#${step.lines.length}`);
    beam(step.add('IFCMAPPEDITEM', source, to));
  }), /nested more than/],
  ['20 000 clips', 'ifc', () => ifc(({step, solid, beam}) => {
    const half = step.add('IFCHALFSPACESOLID', step.add('IFCPLANE', step.axes(shift(0, 0, 0))), '.F.');
    let item = solid();
    for (let i = 0; i < 20000; ++i) item = step.add('IFCBOOLEANCLIPPINGRESULT', '.DIFFERENCE.', item, half);
    beam(item);
  }), /more than 1000 cuts/],
  ['a clip of itself', 'ifc', () => ifc(({step, beam}) => {
    const half = step.add('IFCHALFSPACESOLID', step.add('IFCPLANE', step.axes(shift(0, 0, 0))), '.F.');
    beam(step.add('IFCBOOLEANCLIPPINGRESULT', '.DIFFERENCE.', `#${step.lines.length + 1}`, half));
  }), /more than 1000 cuts/],
  ['a polyline of 300 000 points', 'ifc', () => ifc(({step, beam}) => {
    const points = many(300000, (i) => step.point([i, 0, i % 2]));
    beam(step.add('IFCSWEPTDISKSOLID', step.add('IFCPOLYLINE', `(${points.join(',')})`), 5, 4, '$', '$'));
  }), /longer than|at most/],
  ['a list of 300 000 points', 'ifc', () => ifc(({step, beam}) => {
    const list = step.add('IFCCARTESIANPOINTLIST3D', `(${many(300000, (i) => `(${i}.,0.,${i % 2}.)`).join(',')})`);
    beam(step.add('IFCSWEPTDISKSOLID', step.add('IFCINDEXEDPOLYCURVE', list, '$', '.F.'), 5, 4, '$', '$'));
  }), /longer than/],
  ['a curve within itself', 'ifc', () => ifc(({step, beam}) => {
    const own = `#${step.lines.length + 2}`;
    const segment = step.add('IFCCOMPOSITECURVESEGMENT', '.CONTINUOUS.', '.T.', own);
    beam(step.add('IFCSWEPTDISKSOLID', step.add('IFCCOMPOSITECURVE', `(${segment},${segment})`, '.F.'), 5, 4, '$', '$'));
  }), /nested more than/],
  ['a profile derived from itself', 'ifc', () => ifc(({step, beam}) => {
    const operator = step.add('IFCCARTESIANTRANSFORMATIONOPERATOR2D', '$', '$', step.point([0, 0]), '$');
    const profile = step.add('IFCDERIVEDPROFILEDEF', '.AREA.', '$', `#${step.lines.length + 1}`, operator, '$');
    beam(step.add('IFCEXTRUDEDAREASOLID', profile, '$', step.direction([0, 0, 1]), 1000));
  }), /nested too deep/],
  ['a number without end in IFC', 'ifc', () => ifc(({step, beam}) => {
    const profile = step.add('IFCCIRCLEHOLLOWPROFILEDEF', '.AREA.', '$', '$', `${digits}.`, 5);
    beam(step.add('IFCEXTRUDEDAREASOLID', profile, '$', step.direction([0, 0, 1]), 1000));
  }), /longer than|has no Radius|has a Radius|is no tube|a wall of/],
  ['brackets without end', 'ifc', () => ifc(({step, beam}) => beam(step.add('IFCPOLYLINE', `${'('.repeat(200000)}#1${')'.repeat(200000)}`))), /./],
  ['12 000 beams', 'ifc', () => ifc(({solid, step}) => {
    const body = step.body([solid()]);
    const place = step.placement(shift(0, 0, 0));
    for (let i = 0; i < 12000; ++i) step.product('IFCBEAM', `B${i}`, place, body);
  }), /more than 10000 tubes/],
  ['digits without end in PCF', 'pcf', () => pcf(`PIPE\n    END-POINT ${digits}x 0 0 4\n    END-POINT 1 0 0 ${digits}x\n    WALL-THICKNESS ${digits}.${digits}.\n`), /is not a point/],
  ['a bore without end', 'pcf', () => pcf(`PIPE\n    END-POINT 0 0 0 ${digits}BW\n    END-POINT 100 0 0 ${'B'.repeat(1000000)}4\n`), /no nominal bore/],
  ['20 000 fittings at one point', 'pcf', () => pcf(`PIPE\n    END-POINT 0 0 0 4\n    END-POINT 900 0 0 4\n    WALL-THICKNESS 6 MM\n${'VALVE\n    END-POINT 5000 0 0 4\n    END-POINT 5100 0 0 4\n'.repeat(20000)}VALVE\n    END-POINT 9000 0 0 4\n`), /no pipe ends at it/],
  ['20 000 pipes from one point', 'pcf', () => pcf(many(20000, (i) => `PIPE\n    END-POINT 0 0 0 4\n    END-POINT ${i + 1} 900 0 4\n    WALL-THICKNESS 6 MM\n`).join('')), /more than 10000 tubes/],
  ['olets on 3 000 pipes', 'pcf', () => pcf(many(3000, (i) => `PIPE\n    END-POINT 0 ${i * 300} 0 4\n    END-POINT 900 ${i * 300} 0 4\n    WALL-THICKNESS 6 MM\nOLET\n    CENTRE-POINT 400 ${i * 300} 0 4\n    BRANCH1-POINT 400 ${i * 300} 57 2\n`).join('')), /no pipe begins at it/],
  ['a fitting of 100 000 points', 'pcf', () => pcf(`PIPE\n    END-POINT 0 0 0 4\n    END-POINT 900 0 0 4\n    WALL-THICKNESS 6 MM\nVALVE\n${many(100000, (i) => `    END-POINT ${i} 0 0 4\n`).join('')}`), /100000 points/],
  ['attributes without end', 'pcf', () => pcf(`PIPE\n${'    END-POINT 0 0 0 4\n'.repeat(300000)}`), /no length/],
  ['digits without end in a table', 'csv', () => `${heads}A,${digits}x,0,0,1,0,0,60,3\nB,${'1,'.repeat(0)}"${'1,234,'.repeat(200000)}",0,0,1,0,0,60,3\n`, /is no number/],
  ['a heading without end', 'csv', () => `${'x_'.repeat(500000)} in ${'m '.repeat(500000)},y\n1,2\n`, /no column/],
  ['100 000 columns', 'csv', () => `${many(100000, (i) => `c${i}`).join(',')}\n${many(100000, (i) => i).join(',')}\n`, /no column/],
  ['300 000 rows that lack a column', 'csv', () => `id,x1,y1,z1,x2,y2,od,wall\n${'A,1,2,3,4,5,60,3\n'.repeat(300000)}`, /no column for end_z.*299995 more/],
  ['12 000 rows from one point', 'csv', () => heads + many(9000, (i) => `A,0,0,0,${i + 1},900,0,60,3\n`).join('') + 'B,0,0,0,0,0,0,60,3\n', /no length/],
  ['rows of one name', 'csv', () => heads + many(9000, (i) => `A,0,${i},0,900,${i},0,60,3\n`).join('') + 'B,0,0,0,0,0,0,60,3\n', /no length/],
  ['fields named __proto__', 'csv', () => 'id,x1,y1,z1,x2,y2,z2,od,wall,__proto__,constructor\nA,0,0,0,1,0,0,60,,1,1\n', /no wall/],
  ['a layer named __proto__', 'dxf', () => drawing(line('__proto__', 500) + line('constructor', 500) + line('L', 500)), /no size was given for layer (__proto__|constructor)/],
  ['a polyline of 300 000 vertices', 'dxf', () => drawing(`${pairs([0, 'LWPOLYLINE'], [5, 'B'], [8, 'L'], [90, 300000])}${many(300000, (i) => `10\n${i}\n20\n${i % 2}\n`).join('')}`), /300000 points/],
  ['12 000 lines', 'dxf', () => drawing(many(12000, (i) => line('L', i + 1)).join('')), /more than 10000 tubes/],
  ['a number without end in DXF', 'dxf', () => drawing(line('L', `${digits}`) + line('L', '0')), /./],
  ['an NC1 file without end', 'nc1', () => `${file({end: ['']})}${'  v 1.00 2.00 3.00\n'.repeat(1100000)}`, /more than 1000000 lines/],
  ['300 000 blocks of NC1', 'nc1', () => file({blocks: [...squareFaces(), ...many(300000, () => 'KO')]}), /300000 blocks/],
  ['digits without end in NC1', 'nc1', () => file({blocks: [...squareFaces(), `BO\n  v ${digits} 1.00 2.00\n  v ${'1'.repeat(80)} 1.00 2.00`]}), /at most 400 are read/],
  ['20 000 holes in a tube', 'nc1', () => file({blocks: [...squareFaces(), `BO\n${many(20000, (i) => `  v ${i}.00 30.00 2.00\n`).join('')}`]}), /18000 more cut-outs are not in the part, because it has at most 2000/],
  ['an opening of 60 000 points', 'nc1', () => file({blocks: [...squareFaces(), outline('v', [...many(60000, (i) => [i, 10 + (i % 2)]), [0, 10]], 'IK')]}), /at most 10000 are read/],
  ['an outline of 60 000 points', 'nc1', () => file({blocks: [outline('v', [...many(60000, (i) => [i % 2, (60 * i) / 59999]).reverse(), [1000, 0], [1000, 60], [1, 60]])]}), /mm off the nearest plane/],
  ['fields named __proto__ in our own comments', 'nc1', () => ours.replace('shape: circle 18; wall through', 'shape: __proto__ 18; constructor 1; wall through').replace('EN\r\n', 'PU\r\nEN\r\n'), /punch marks/],
  ['comments without end', 'nc1', () => ours.replace('** work points', `** end start: ${'square at x 0; '.repeat(100000)}\r\n** shape: ${'9'.repeat(1000000)}\r\n** work points`).replace('EN\r\n', 'PU\r\nEN\r\n'), /punch marks/],
];
