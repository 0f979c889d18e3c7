// Our own NC1, read back: the same part within the file's decimals, by its comments, and by its blocks
// alone as far as these state it. TUBECUT_SERVER is the binary, TUBECUT_PARTS the number of parts.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Service} from '../../../tests/contract/service.mjs';
import {fromNc1} from '../dist/index.js';
import {drawnPart} from './support/nc1_parts.mjs';

const parts = Number(process.env.TUBECUT_PARTS ?? 24);
const seed = Number(process.env.TUBECUT_SEED ?? 1);
let service;
before(async () => {
  service = await Service.start(process.env.TUBECUT_SERVER);
});
after(() => service.stop());

const posted = async (body, query = '') => {
  const {status, text} = await service.ask(`/v1/parts${query}`, {body: JSON.stringify(body)});
  assert.equal(status, 200, `${text.slice(0, 600)}\n${JSON.stringify(body).slice(0, 1500)}`);
  return text;
};
const answerOf = async (body) => JSON.parse(await posted(body)).result;
const instances = ({cutouts = []}) =>
  cutouts.flatMap((group) => group.instances.map((one) => ({...one, side: group.side, wall: group.wall, volume: group.volume_mm3, area: group.area_outer_mm2})));
const close = (a, b, by, told) => assert.ok(Math.abs(a - b) <= by, `${told}: ${a}, ${b}`);
/** Round the tube, where 0 and the girth are one place. */
const closeRound = (a, b, girth, by, told) => close((((a - b + girth / 2) % girth) + girth) % girth, girth / 2, by, told);
const girthOf = ({section, target}, body) => section?.girth_mm ?? Math.PI * (body.target.outer_diameter_mm ?? target);

/** Compares the outer and the inner edges of both ends, row by row. */
function sameEnds(one, other, by, told) {
  for (const end of ['start', 'finish'])
    for (const edge of ['z_inner_mm', 'z_outer_mm', 'b_deg']) {
      const [a, b] = [one.ends[end].points[edge], other.ends[end].points[edge]];
      assert.equal(a.length, b.length, `${told} ${end}`);
      a.forEach((v, i) => close(v, b[i], by, `${told} ${end} ${edge} ${i}`));
    }
}

test(`${parts} drawn parts: the imported request gives the same part`, async (of) => {
  const seen = {round: 0, planes: 0, cutouts: 0, contours: 0, through: 0, sunk: 0, slits: 0};
  for (let number = 0; number < parts; ++number) {
    const body = drawnPart(seed, number);
    const told = `seed ${seed}, part ${number}`;
    const {part, notUnderstood, asks} = fromNc1(await posted(body, '?format=nc1'));
    assert.deepEqual([notUnderstood, asks], [[], []], told);
    const [asked, read] = [await answerOf(body), await answerOf({...part, sampling: body.sampling})];
    const name = ['order', 'part', 'material', 'quantity'].map((each) => part.reference?.[each]);
    assert.deepEqual(name, ['order', 'part', 'material', 'quantity'].map((each) => body.reference?.[each]), told);
    assert.equal(part.target.id, body.target.id, told);
    for (const length of ['work_point_mm', 'long_mm', 'short_mm', 'volume_mm3', 'mass_kg']) close(asked.lengths[length], read.lengths[length], Math.max(2e-6 * asked.lengths[length], 2e-6), `${told} ${length}`);
    sameEnds(asked, read, 1e-5, told);
    const before = instances(asked);
    const after = instances(read);
    assert.equal(after.length, before.length, told);
    for (const one of before) {
      const other = after.find(({id, side, wall}) => id === one.id.replace('ü', 'ue') && side === one.side && (wall === 'countersink') === (one.wall === 'countersink'));
      assert.ok(other, `${told}: ${one.id}`);
      assert.equal(other.wall, one.wall, told);
      for (const size of ['volume', 'area']) close(one[size] / other[size], 1, 1e-7, `${told} ${one.id} ${size}`);
      for (const place of ['z_mm', 'z_from_mm', 'z_to_mm']) close(one[place], other[place], 1e-5, `${told} ${one.id} ${place}`);
      closeRound(one.girth_from_mm, other.girth_from_mm, girthOf(asked, body), 1e-5, `${told} ${one.id} girth`);
    }
    seen.round += body.target.kind ? 0 : 1;
    seen.planes += Object.values(body.ends).filter(({cutters}) => cutters).length;
    seen.cutouts += before.length;
    seen.contours += (body.cutouts ?? []).filter(({shape}) => shape.kind === 'contour').length;
    seen.slits += (body.cutouts ?? []).filter(({shape}) => shape.kind === 'slit').length;
    seen.sunk += before.filter(({wall}) => wall === 'countersink').length;
    seen.through += (body.cutouts ?? []).filter(({wall}) => wall === 'through').length;
  }
  of.diagnostic(JSON.stringify(seen));
  assert.ok(Object.values(seen).every((count) => count >= parts / 8), JSON.stringify(seen));
});

test('the same by the blocks alone: ends that are square or flush, circles, outlines', async (of) => {
  const seen = {planes: 0, bores: 0, outlines: 0};
  for (let number = 0; number < Math.ceil(parts / 2); ++number) {
    const body = drawnPart(seed, number, true);
    const told = `seed ${seed}, plain part ${number}`;
    const text = (await posted(body, '?format=nc1')).split('\r\n').filter((line) => !line.startsWith('**')).join('\n');
    const {part, notUnderstood} = fromNc1(text, {fields: {kerf_mm: body.kerf_mm, sampling: body.sampling}});
    const planes = Object.values(body.ends).filter(({cutters}) => cutters).length;
    const others = notUnderstood.filter(({reason}) => !/^assumed: (the (start|finish) is cut flush|a density)/.test(reason));
    assert.deepEqual(others, [], told);
    const [asked, read] = [await answerOf(body), await answerOf(part)];
    close(asked.lengths.long_mm, read.lengths.long_mm, 0.02, `${told} long`);
    if (!body.target.kind) sameEnds(asked, read, 0.05, told);
    const after = instances(read);
    const before = instances(asked);
    assert.equal(after.length, before.length, told);
    for (const one of before) {
      const girth = girthOf(asked, body);
      const apart = (other) => Math.hypot(other.z_from_mm - one.z_from_mm, ((((other.girth_from_mm - one.girth_from_mm + girth / 2) % girth) + girth) % girth) - girth / 2);
      const other = after.reduce((best, each) => (apart(each) < apart(best) ? each : best));
      assert.ok(apart(other) < 0.03, `${told} ${one.id}: ${apart(other)} mm`);
      close(one.area / other.area, 1, 5e-3, `${told} ${one.id} area`);
      close(one.volume / other.volume, 1, 5e-3, `${told} ${one.id} volume`);
    }
    seen.planes += planes;
    seen.bores += part.cutouts?.filter(({shape}) => shape.kind === 'circle').length ?? 0;
    seen.outlines += part.cutouts?.filter(({shape}) => shape.kind === 'contour').length ?? 0;
  }
  of.diagnostic(JSON.stringify(seen));
  assert.ok(Object.values(seen).every((count) => count > 0), JSON.stringify(seen));
});

test('texts come back whole, and a text that a hand changed is listed', async () => {
  const ends = {start: {square_at_mm: 0}, finish: {square_at_mm: 0}};
  const own = (at, more) => ({id: 'Ü 1, id 2', at, text: ' a "b" 5; id x', height_mm: 8, ...more});
  for (const [told, target, texts] of [
    ['round', {outer_diameter_mm: 88.9, wall_mm: 5, length_mm: 600}, [own({z_mm: 60, phi_deg: 300}, {angle_deg: 30}), {...own({z_mm: 200, from: 'finish', girth_mm: 12}, {angle_deg: 180}), id: 'b'}]],
    ['square', {kind: 'rectangular_tube', height_mm: 80, width_mm: 60, wall_mm: 4, corner_radius_mm: 8, length_mm: 600}, [own({z_mm: 60, face: 3, offset_mm: 2}), {...own({z_mm: 300, face: 4}, {angle_deg: 60, over_corner: true}), id: 'b'}]],
  ]) {
    const body = {target, ends, texts, kerf_mm: 1};
    const file = await posted(body, '?format=nc1');
    const {part, notUnderstood} = fromNc1(file);
    assert.deepEqual(notUnderstood, [], told);
    assert.deepEqual(part.texts.map(({id, text}) => [id, text]), texts.map(({id, text}) => [id.replace('Ü', 'Ue'), text]), told);
    const lettering = ({marks}) => marks.flatMap((mark) => (mark.lettering ? [mark.lettering] : []));
    const [asked, read] = [lettering(await answerOf(body)), lettering(await answerOf(part))];
    assert.equal(read.length, asked.length, told);
    asked.forEach((one, k) =>
      one.strokes.forEach((stroke, i) => {
        for (const column of ['z_mm', 'girth_mm']) stroke[column].forEach((v, n) => close(v, read[k].strokes[i][column][n], 1e-6, `${told} ${column}`));
      }),
    );
    const changed = fromNc1(file.replace(/(SI\r\n {2}[vouh] +)60\.000/, '$170.000'));
    assert.deepEqual(changed.notUnderstood.map(({reason}) => reason.slice(0, 60)), ['its comment states another text than the block: the block is', 'assumed: "a "b" 5; id x" is a mark at this place, because it'], told);
    assert.equal(changed.part.texts.length, 1, told);
    assert.equal(changed.part.marks[0].z_mm, 70, told);
  }
});
