"""Texts of parts in files: G-code, DXF and NC1 hold the same strokes, each where formulas of its own place the letters."""

import json
import math
import re
import urllib.parse

import dxf_test
import leads_test
import torch_program
from section_program_test import Outline, torch
from service import FormatTest, main

PIVOT = 120.0
WORDS = ("A-12", "Rq@7 ~#", " b 8")
ROUND = {"target": {"outer_diameter_mm": 88.9, "wall_mm": 5, "length_mm": 400},
         "ends": {"start": {"square_at_mm": 0}, "finish": {"cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0.3, 0, 1]}],
                                                           "root_surface": "inner", "groove": {"rule": "none"}, "smoothing": {"method": "none"}}},
         "cutouts": [{"id": "hole", "shape": {"kind": "circle", "diameter_mm": 20}, "at": {"z_mm": 60, "phi_deg": 200}}],
         "kerf_mm": 1}
SQUARE = {"kind": "rectangular_tube", "height_mm": 80, "width_mm": 60, "wall_mm": 4, "corner_radius_mm": 8}
OVAL = {"kind": "flat_oval_tube", "height_mm": 50, "width_mm": 90, "wall_mm": 3}
LIT = {"speed_mm_min": 600, "torch": "on", "marks": "on", "lead_mm": 2, "pivot_length_mm": PIVOT, "pierce_height_mm": 4, "pierce_delay_s": 0.4,
       "cut_height_mm": 1.5}


def round_part():
    """Letters along the tube, round it across the datum line, and mirrored from the finish."""
    return {**ROUND, "texts": [
        {"id": "along", "at": {"z_mm": 100, "phi_deg": 90}, "text": WORDS[0], "height_mm": 7},
        {"id": "round", "at": {"z_mm": 200, "girth_mm": -30}, "angle_deg": 75, "text": WORDS[1], "height_mm": 12},
        {"id": "over", "at": {"z_mm": 90, "from": "finish", "phi_deg": 180, "opposite": True}, "mirrored": True, "text": WORDS[2], "height_mm": 9}]}


def section_part(target):
    places = [{"face": 3, "offset_mm": 3}, {"face": 1, "offset_mm": -4}, {"girth_mm": 5}]
    texts = [{"id": f"t{i}", "at": {"z_mm": 80 + 110 * i, **place}, "angle_deg": 40 * i, "text": word, "height_mm": 10, "over_corner": i > 0}
             for i, (place, word) in enumerate(zip(places, WORDS))]
    return {"target": {**target, "length_mm": 450}, "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "texts": texts,
            "preset": "tube_laser", "kerf_mm": 0.3}


def outline_of(target):
    corner = target.get("corner_radius_mm", min(target["height_mm"], target["width_mm"]) / 2)
    return Outline(target["height_mm"], target["width_mm"], corner)


def anchor_girth(at, girth, outline):
    """The way round of an anchor by its own formula: faces are a flat and a corner apart."""
    half = girth / 2 if at.get("opposite") else 0.0
    if "girth_mm" in at:
        return at["girth_mm"] + half
    if "phi_deg" in at:
        return at["phi_deg"] / 360 * girth + half
    flats = [2 * outline.y, 2 * outline.x] * 2
    face = at["face"]
    before = (flats[0] / 2 + sum(flats[1:face - 1]) + flats[face - 1] / 2 if face > 1 else 0.0) + (face - 1) * outline.corner * math.pi / 2
    return before + at.get("offset_mm", 0.0)


def stroke_places(blocks):
    """{axis: value} where the marking tool comes down, and at the end of each of its moves."""
    at, out = {}, []
    for move, words in re.findall(r"(?m)^(G[01]) (.*?)(?: F[\d.]+)?$", blocks):
        at = {**at, **{word[0]: float(word[1:]) for word in words.split()}}
        out = [at] if move == "G0" else [*out, at]
    return out


class Texts(FormatTest):
    def letters(self, word):
        """{index of a letter: its strokes on a grid of a seventh of its height}, as drawn plainly from z 10 on girth 70 of a large tube."""
        body = {"target": {"outer_diameter_mm": 500, "wall_mm": 5, "length_mm": 900}, "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                "texts": [{"id": "t", "at": {"z_mm": 10, "girth_mm": 70}, "text": word, "height_mm": 7}], "kerf_mm": 0}
        strokes = self.service.answer("parts", body)["result"]["marks"][-1]["lettering"]["strokes"]
        return [[(z - 10, 70 - s) for z, s in zip(stroke["z_mm"], stroke["girth_mm"])] for stroke in strokes]

    def wanted(self, body, outline=None):
        """{id: [strokes as (z, girth)]}: the letters laid by formulas of this file."""
        target = body["target"]
        girth = outline.whole() if outline else math.pi * target["outer_diameter_mm"]
        out = {}
        for text in body["texts"]:
            at, turn = text["at"], math.radians(text.get("angle_deg", 0))
            length = target["length_mm"]
            z0 = length - at["z_mm"] if at.get("from") == "finish" else at["z_mm"]
            s0 = anchor_girth(at, girth, outline) % girth
            unit, up = text["height_mm"] / 7, 1 if text.get("mirrored") else -1
            out[text["id"]] = [[(z0 + unit * (x * math.cos(turn) - up * y * math.sin(turn)), s0 + unit * (x * math.sin(turn) + up * y * math.cos(turn)))
                                for x, y in stroke] for stroke in self.letters(text["text"])]
        return out, girth

    def same(self, got, wanted, within, girth):
        """Strokes of a file, as (z, girth) modulo the girth: they end where wanted, and every place of them lies on the wanted line."""
        self.assertEqual(len(got), len(wanted))
        for places, line in zip(got, wanted):
            turn = girth * round((line[0][1] - places[0][1]) / girth)
            moved = [(z, s + turn) for z, s in places]
            for a, b in ((moved[0], line[0]), (moved[-1], line[-1])):
                self.assertLess(math.dist(a, b), within)
            for place in moved:
                self.assertLess(leads_test.distance(place, leads_test.Wall(line)) if len(line) > 1 else 0.0, within)
            for corner in line:
                self.assertLess(min(math.dist(corner, place) for place in moved), within)

    def answered(self, body, outline=None):
        answer = self.service.answer("parts", body)["result"]
        wanted, girth = self.wanted(body, outline)
        drawn = {mark["lettering"]["id"]: mark["lettering"]["strokes"] for mark in answer["marks"] if mark["kind"] == "text"}
        self.assertEqual(list(drawn), list(wanted))
        for name, strokes in drawn.items():
            self.same([list(zip(s["z_mm"], s["girth_mm"])) for s in strokes], wanted[name], 1e-6, girth)
        return wanted, girth

    def parts(self):
        yield "round", round_part(), None
        for name, target in (("square", SQUARE), ("oval", OVAL)):
            yield name, section_part(target), outline_of(target)

    def test_the_answer_has_every_stroke_where_formulas_place_it(self):
        for name, body, outline in self.parts():
            with self.subTest(name):
                self.answered(body, outline)

    def program(self, body, **more):
        options = urllib.parse.urlencode({"format": "gcode", **LIT, **more})
        return self.service.text("parts", body, options).decode("ascii")

    def test_a_program_of_a_round_part_draws_them(self):
        body = round_part()
        wanted, girth = self.answered(body)
        cuts = torch_program.replay(self.program(body), body["target"]["outer_diameter_mm"] / 2, PIVOT)
        for name, strokes in wanted.items():
            own = [cut for cut in cuts if cut.name.startswith(f"mark of text {name}, stroke ")]
            self.assertTrue(all(cut.mark and cut.lit and not cut.dark for cut in own))
            self.same([[(p.z, p.phi / 360 * girth) for p in cut.places] for cut in own], strokes, 1e-4, girth)
            self.assertTrue(all(abs(p.off - 1.5) < 2e-5 and p.b == 0.0 for cut in own for p in cut.places))
        first_cut = next(i for i, cut in enumerate(cuts) if not cut.mark)
        self.assertTrue(all(not cut.mark for cut in cuts[first_cut:]))

    def test_a_program_around_a_section_draws_them(self):
        for name, body, outline in list(self.parts())[1:]:
            with self.subTest(name):
                wanted, girth = self.answered(body, outline)
                program = self.program(body)
                for text, strokes in wanted.items():
                    places = []
                    for each in re.findall(rf"(?ms)^\(mark of text {text}, stroke \d+\)$(.*?)^M65 P0$", program):
                        self.assertIn("M64 P0", each)
                        at = [torch(at, PIVOT + 1.5) for at in stroke_places(each)]
                        feet = [(z, outline.foot(x, y), b, up) for x, y, z, b, up in at]
                        self.assertTrue(all(abs(off) < 0.021 and b == 0.0 for _, (off, _, _), b, _ in feet))
                        places.append(self.unrolled([(z, foot[2]) for z, foot, _, _ in feet], girth))
                    self.same(places, strokes, 0.025, girth)
                self.assertNotIn("mark by hand: the text", program)
                self.assertIn("mark by hand: the text A-12, 10 mm high", self.program(body, marks="off"))

    @staticmethod
    def unrolled(places, girth):
        """Without the jump at the datum line."""
        out = [places[0]]
        for z, s in places[1:]:
            out.append((z, s + girth * round((out[-1][1] - s) / girth)))
        return out

    def test_drawings_have_them_on_their_layer(self):
        for name, body, outline in self.parts():
            with self.subTest(name):
                wanted, girth = self.answered(body, outline)
                every = [stroke for strokes in wanted.values() for stroke in strokes]
                flat = [[(z, s) for s, z in points] for points, _ in dxf_test.polylines(dxf_test.read(self.service.text(
                    "parts", body, "format=dxf&view=template")), "MARK")]
                self.same(flat[-len(every):], every, 1e-5, girth)
                space = dxf_test.polylines(dxf_test.read(self.service.text("parts", body, "format=dxf&view=tube")), "MARK")[-len(every):]
                self.same([self.unrolled([self.developed(p, body, outline) for p in points], girth) for points, _ in space], every, 1e-4, girth)

    def developed(self, point, body, outline):
        """(z, girth) of a point of the outside."""
        x, y, z = point
        if outline:
            off, _, girth = outline.foot(x, y)
            self.assertLess(abs(off), 1e-5)
            return z, girth
        radius = body["target"]["outer_diameter_mm"] / 2
        self.assertLess(abs(math.hypot(x, y) - radius), 1e-5)
        return z, radius * (math.atan2(y, x) % (2 * math.pi))

    def test_an_nc1_file_states_each(self):
        """But a mirrored one, which the format has not."""
        for name, body, outline in self.parts():
            body = body | {"texts": [text for text in body["texts"] if not text.get("mirrored")]}
            with self.subTest(name):
                _, girth = self.answered(body, outline)
                file = self.service.text("parts", body, "format=nc1").decode("ascii")
                blocks = re.findall(r"\*\* text: at x (\S+); girth (\S+); angle (\S+); height (\S+?)((?:; over corner)?); id (.*)\r\n"
                                    r"SI\r\n  ([vouh]) *(\S+)u *(\S+) +(\S+) +(\S+) (.*)\r\n", file)
                self.assertEqual(len(blocks), len(body["texts"]))
                for text, (x, s, angle, height, over, id, face, at_x, at_y, at_angle, at_height, word) in zip(body["texts"], blocks):
                    at, length = text["at"], body["target"]["length_mm"]
                    self.assertEqual((id, word), (text["id"], text["text"]))
                    self.assertAlmostEqual(float(x), length - at["z_mm"] if at.get("from") == "finish" else at["z_mm"], delta=1e-6)
                    self.assertAlmostEqual(float(s), anchor_girth(at, girth, outline) % girth, delta=1e-6)
                    self.assertAlmostEqual(float(angle), text.get("angle_deg", 0), delta=1e-9)
                    self.assertEqual(float(height), text["height_mm"])
                    self.assertEqual(bool(over), text.get("over_corner", False))
                    self.assertAlmostEqual(float(at_x), float(x), delta=6e-4)
                    self.assertEqual(float(at_height), text["height_mm"])
                    if outline:
                        self.assertEqual(face, {1: "o", 2: "v", 3: "u", 4: "h"}[at.get("face", 1)])
                        self.assertAlmostEqual(float(at_angle), float(angle) * (1 if face in "oh" else -1), delta=6e-4)
                    else:
                        self.assertAlmostEqual(float(at_y), girth - float(s), delta=6e-4)
                        self.assertAlmostEqual(float(at_angle), -float(angle), delta=6e-4)

    def test_work_orders_state_every_place_whole(self):
        """A step that is too long for its column goes on below; its last words are where the text begins and ends."""
        body = {"preset": "tube_laser", "target": {"outer_diameter_mm": 60.3, "wall_mm": 3, "length_mm": 900}, "kerf_mm": 0.2,
                "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                "texts": [{"id": "a", "at": {"z_mm": 703, "phi_deg": 90}, "text": "A-12345678 REV B", "height_mm": 7},
                          {"id": "b", "at": {"z_mm": 611, "phi_deg": 345}, "text": "TOP", "height_mm": 10, "angle_deg": 90}]}
        order = self.service.text("parts", body, "format=svg&view=work_order").decode()
        for place in ("703", "611"):
            self.assertRegex(order, rf">[^<]*\b{place}\b")

    def test_work_orders_and_templates_show_them(self):
        for name, body, _ in self.parts():
            with self.subTest(name):
                order = self.service.text("parts", body, "format=svg&view=work_order").decode()
                self.assertIn("text A-12", order)
                plain = {**body, "texts": []}
                for view in ("template", *(("work_order",) if name == "round" else ())):
                    drawn, without = (len(re.findall(r"<(?:polyline|path|line)", self.service.text("parts", one, f"format=svg&view={view}").decode()))
                                      for one in (body, plain))
                    self.assertGreaterEqual(drawn - without, sum(len(self.letters(t["text"])) for t in body["texts"]))

    def test_a_pulse_schedule_marks_them(self):
        part = round_part()
        part["texts"] = part["texts"][:1]
        example = json.loads((dxf_test.pathlib.Path(__file__).parents[2] / "examples/pulse-schedules/two-ends-and-four-holes-of-a-part.json").read_text())
        body = {**example, "part": part, "motion": {**example["motion"], "marks": {"speed_mm_min": 3000}}}
        segments = self.service.answer("pulse-schedules", body)["result"]["segments"]
        named = [s for s in segments if s["kind"] == "mark"]
        self.assertEqual(len(named), 1 + len(self.letters("A-12")))

    def test_marks_have_no_slow_zones(self):
        """Nothing burns while the torch is off, so a short stroke that an axis slows down is no warning."""
        part = {"target": {"outer_diameter_mm": 60.3, "wall_mm": 3, "length_mm": 300}, "kerf_mm": 1.5,
                "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                "texts": [{"id": "t", "at": {"z_mm": 100, "phi_deg": 10}, "text": "A1", "height_mm": 8}]}
        for speed in (300, 1200, 3000):
            motion = {"speed": {"mm_min": 1200}, "lead": {"radius_mm": 3}, "pierce_delay_s": 0.2, "marks": {"speed_mm_min": speed}}
            answer = self.service.answer("pulse-schedules", {"part": part, "machine": "generic", "motion": motion})
            self.assertNotIn("slow_zone", [warning["code"] for warning in answer["warnings"]], speed)
            self.assertEqual(answer["verdict"]["status"], "ok", speed)


if __name__ == "__main__":
    main()
