/** How wire names read on the page: `max_slope_deg_per_mm` is "max slope" in "°/mm". */
const units: [string, string][] = [
  ['_deg_per_mm2', '°/mm²'],
  ['_deg_per_mm', '°/mm'],
  ['_rad_per_mm', 'rad/mm'],
  ['_per_hour', '1/h'],
  ['_rev_min', '1/min'],
  ['_mm_min', 'mm/min'],
  ['_m_min', 'm/min'],
  ['_mm_s3', 'mm/s³'],
  ['_mm_s2', 'mm/s²'],
  ['_mm_s', 'mm/s'],
  ['_mm3_s', 'mm³/s'],
  ['_mm3', 'mm³'],
  ['_mm2', 'mm²'],
  ['_mm', 'mm'],
  ['_deg', '°'],
  ['_rad', 'rad'],
  ['_ms', 'ms'],
  ['_us', 'µs'],
  ['_um', 'µm'],
  ['_kg', 'kg'],
  ['_pulses', 'pulses'],
  ['_s', 's'],
];
const words: Record<string, string> = {
  outer_diameter: 'outer Ø',
  id: 'name',
  cap: 'groove cap',
  mm_min: 'speed',
  b: 'B',
  b_raw: 'B raw',
  b_required: 'B required',
  eps_b: 'B tolerance',
  eps_tip: 'tip tolerance',
  weld: 'weld length',
  long: 'long side',
  short: 'short side',
};
const short: Record<string, string> = {
  outer_diameter: 'Ø',
  inclination: 'incl.',
  clocking: 'clock',
  offset: 'offset',
  height: 'height',
  id: 'name',
  wall: 'wall',
};

export function unit(name: string): string {
  if (name === 'mm_min') return 'mm/min';
  return units.find(([ending]) => name.endsWith(ending))?.[1] ?? '';
}

function stem(name: string): string {
  const ending = units.find(([text]) => name.endsWith(text))?.[0] ?? '';
  return ending && name !== 'mm_min' ? name.slice(0, -ending.length) : name;
}

export const label = (name: string) => words[stem(name)] ?? stem(name).replace(/_/g, ' ');
export const brief = (name: string) => short[stem(name)] ?? label(name);

/** The service's short unit names, as in `verification`. */
export const spelled = (text: string) => unit(`_${text}`) || (text === 'deg' ? '°' : text);

export const endpointNames: Record<string, string> = {
  'bevel-tables': 'Cut and bevel',
  intersections: 'Intersection',
  nodes: 'Node',
  holes: 'Hole',
  parts: 'Part',
  'pulse-schedules': 'Pulses',
  replays: 'Replay',
  'feed-curves': 'Feed curve',
  grooves: 'Groove',
  'mill-paths': 'Mill path',
};
export const endpointOrder = Object.keys(endpointNames);
export const endpointName = (id: string) => endpointNames[id] ?? sentence(id.replace(/-/g, ' '));

export const sentence = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);

const kept: [RegExp, string][] = [
  [/^case ([a-z]) /, 'case $1: '],
  [/^source (\d+) /, 'Source $1: '],
  [/(\d+) mm min/g, '$1 mm/min'],
  [/(\d+) deg\b/g, '$1°'],
  [/(as printed|as published|as solved)/, '($1)'],
];
export function exampleName(name: string): string {
  return sentence(kept.reduce((text, [from, to]) => text.replace(from, to), name.replace(/-/g, ' ')));
}

/** Four significant digits, without the trailing zeros of toPrecision. */
export function short4(value: number): string {
  if (!Number.isFinite(value)) return String(value);
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-4) return value.toExponential(1).replace('e+', 'e');
  return String(Number(value.toPrecision(size >= 1000 ? 6 : 4)));
}

/** What stands under the pictures. */
export const tabs: [string, string][] = [
  ['proof', 'Proof'],
  ['motion', 'Pulses and speed'],
  ['table', 'Table'],
  ['json', 'JSON'],
  ['downloads', 'Downloads'],
];
