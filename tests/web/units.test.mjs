// Numbers as people type them, in mm and in inches.
import {strict as assert} from 'node:assert';
import test from 'node:test';
import {load} from './load.mjs';

const {quantity, system, entered, shownUnit, toShown, toWire} = await load('src/units.ts');
const near = (a, b) => Math.abs(a - b) <= 1e-11 * Math.max(1, Math.abs(b));
const each = (cases, unit) => {
  for (const [text, expected] of Object.entries(cases)) {
    const found = quantity(text, unit);
    assert.ok(expected === undefined ? found === undefined : found !== undefined && near(found, expected), `${text} is ${found}, not ${expected}`);
  }
};
const everywhere = {
  '1.75in': 44.45, '1.75 "': 44.45, '2-3/8in': 60.325, '2 3/8"': 60.325, '3/8 in': 9.525, "5'": 1524, "5' 6\"": 1676.4, "5'6-1/2\"": 1689.1, '5 ft 6 in': 1676.4,
  "5'6": 1676.4, '1 m': 1000, '12cm': 120, '1in + 3mm': 28.4, '10mm-1in': -15.4, '2*(1in+1mm)': 52.8, '1in/2': 12.7, '-1in': -25.4,
  '': undefined, 'abc': undefined, '1in*1in': undefined, '2/(1in)': undefined, '(1': undefined, '1)': undefined, '1..2': undefined, '3 4': undefined, '1/0': undefined, '5 parsec': undefined, '--': undefined,
};

test('mm: bare numbers are mm, units are converted, arithmetic is done', () => {
  system.value = 'mm';
  each({...everywhere, '24.15*2': 48.3, '1,5': 1.5, '.5': 0.5, '2-3/8': 2.375, '10-3': 7, '1e3': 1000, '-4.5': -4.5, '(2+3)*4': 20, '100/8': 12.5, '1in+1': 26.4, '0': 0, '- 5 + 7': 2}, 'mm');
});

test('inch: bare numbers are inches', () => {
  system.value = 'inch';
  each({...everywhere, '24.15*2': 48.3 * 25.4, '1,5': 38.1, '2-3/8': 60.325, '3/8': 9.525, '1mm+1': 26.4, '1in+1': 50.8}, 'mm');
  each({'600/25.4': 600, '10in': undefined}, 'mm/min');
  each({'90-45': 45, '45': 45, '1in': undefined}, '°');
  system.value = 'mm';
});

test('what a field shows is its value to six digits', () => {
  system.value = 'inch';
  let seed = 11;
  for (let i = 0; i < 2000; ++i) {
    seed = (1103515245 * seed + 12345) % 2147483648;
    const value = Number((seed / 1e5).toFixed(i % 5));
    const back = quantity(entered(value, 'mm'), 'mm');
    assert.ok(Math.abs(back - value) <= 5e-6 * value, `${value} mm is ${entered(value, 'mm')} in is ${back} mm`);
  }
  assert.equal(shownUnit('mm'), 'in');
  assert.equal(shownUnit('°'), '°');
  for (const unit of ['mm', 'mm²', 'cm³', 'mm/min', 'm/min', '°/mm', '°/mm²']) assert.ok(near(toWire(toShown(7, unit), unit), 7), unit);
  assert.ok(near(toShown(25.4, 'mm'), 1) && near(toShown(1, '°/mm'), 25.4) && near(toShown(645.16, 'mm²'), 1));
  system.value = 'mm';
  assert.equal(entered(60.3, 'mm'), '60.3');
});
