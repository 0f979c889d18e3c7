// ISO 10303-21 written by hand, line by line, and its axes by plain 4x4 matrices, without any code
// of the reader.

/** Products of rows of numbers; a point is [x, y, z, 1]. */
export const multiply = (a, b) => a.map((row) => b[0].map((_, j) => row.reduce((sum, value, k) => sum + value * b[k][j], 0)));
export const moved = (m, [x, y, z]) => multiply(m, [[x], [y], [z], [1]]).slice(0, 3).map(([value]) => value);
export const rotation = (axis, degrees) => {
  const t = (degrees * Math.PI) / 180, [c, s] = [Math.cos(t), Math.sin(t)];
  const [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
  const m = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
  [m[i][i], m[i][j], m[j][i], m[j][j]] = [c, -s, s, c];
  return m;
};
export const shift = (x, y, z) => [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]];
export const stretch = (k) => [[k, 0, 0, 0], [0, k, 0, 0], [0, 0, k, 0], [0, 0, 0, 1]];
export const product = (...all) => all.reduce(multiply);
const column = (m, j) => [m[0][j], m[1][j], m[2][j]];

const real = (v) => {
  const text = String(v);
  if (/e/i.test(text)) return text.replace('e', 'E').replace(/^(-?\d+)E/, '$1.E');
  return text.includes('.') ? text : `${text}.`;
};

/** One file's lines; `add` gives a line's number as #n. */
export class Step {
  lines = [];
  constructor(schema = 'IFC4') {
    this.schema = schema;
  }

  add(type, ...values) {
    this.lines.push(`#${this.lines.length + 1}=${type}(${values.map((v) => (typeof v === 'number' ? real(v) : v)).join(',')});`);
    return `#${this.lines.length}`;
  }

  list = (values) => `(${values.map((v) => (typeof v === 'number' ? real(v) : v)).join(',')})`;
  point = (p) => this.add('IFCCARTESIANPOINT', this.list(p));
  direction = (d) => this.add('IFCDIRECTION', this.list(d));
  axes = (m) => this.add('IFCAXIS2PLACEMENT3D', this.point(column(m, 3)), this.direction(column(m, 2)), this.direction(column(m, 0)));
  placement = (m, parent = '$') => this.add('IFCLOCALPLACEMENT', parent, this.axes(m));

  /** metre, millimetre, inch, foot. */
  units(name) {
    const si = (prefix) => this.add('IFCSIUNIT', '*', '.LENGTHUNIT.', prefix, '.METRE.');
    const angle = this.add('IFCSIUNIT', '*', '.PLANEANGLEUNIT.', '$', '.RADIAN.');
    const by = (factor) => {
      const measure = this.add('IFCMEASUREWITHUNIT', `IFCLENGTHMEASURE(${real(factor)})`, si('.MILLI.'));
      const dimensions = this.add('IFCDIMENSIONALEXPONENTS', '1', '0', '0', '0', '0', '0', '0');
      return this.add('IFCCONVERSIONBASEDUNIT', dimensions, '.LENGTHUNIT.', `'${name.toUpperCase()}'`, measure);
    };
    const unit = {metre: () => si('$'), millimetre: () => si('.MILLI.'), centimetre: () => si('.CENTI.'), inch: () => by(25.4), foot: () => by(304.8)}[name]();
    const all = this.add('IFCUNITASSIGNMENT', `(${unit},${angle})`);
    return this.add('IFCPROJECT', "'0YvctVUKr0kugbFTf53O9L'", '$', "'P'", '$', '$', '$', '$', '$', all);
  }

  body(items) {
    const kind = this.add('IFCSHAPEREPRESENTATION', '$', "'Body'", "'SweptSolid'", `(${items.join(',')})`);
    return this.add('IFCPRODUCTDEFINITIONSHAPE', '$', '$', `(${kind})`);
  }

  product(type, name, placement, shape) {
    const guid = `'${String(this.lines.length + 1).padStart(22, '0')}'`;
    const tail = this.schema === 'IFC4' && !/(BEAM|COLUMN|MEMBER|SEGMENT|FITTING|PLATE)$/.test(type) ? [] : this.schema === 'IFC4' ? ['$'] : [];
    return this.add(type, guid, '$', name ? `'${name}'` : '$', '$', '$', placement, shape, '$', ...tail);
  }

  text() {
    return `ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('ViewDefinition [CoordinationView]'),'2;1');\nFILE_NAME('t.ifc','2026-11-24T00:00:00',(''),(''),'','','');\n` +
      `FILE_SCHEMA(('${this.schema}'));\nENDSEC;\nDATA;\n${this.lines.join('\n')}\nENDSEC;\nEND-ISO-10303-21;\n`;
  }
}

export const bytes = (text) => new TextEncoder().encode(text);
