"""Printed sheets read by people at a machine: letters that can be read, words on their sides, names whole, one millimetre a millimetre."""

import json
import math
import random
import re
import xml.etree.ElementTree as ElementTree

import pdf_reader
from pictures_test import BIKE, LONG, PAPERS, end, hole
from service import HOSTILE, FormatTest, examples, main
from picture import UP, Picture, box_of, width  # of tests/support, where service looks

SVG = "{http://www.w3.org/2000/svg}"
LEAST = 2.2  # mm
SIZES = {"a4": (210, 297), "a3": (297, 420), "letter": (215.9, 279.4), "tabloid": (279.4, 431.8)}
BLUE = (0x1f, 0x5f, 0xbf)
BASE = {"root_surface": "inner", "kerf_mm": 0, "groove": {"rule": "half_dihedral"}, "contact": "inner", "smoothing": {"method": "none"}}
LONG_REFERENCE = {key: (LONG + " " + LONG)[:64] for key in ("part", "order", "drawing", "revision", "heat", "material", "customer_id")}


def outlines(page, name):
    """The curves of an SVG page whose id begins so, without the page's number at its end: [points]."""
    behind = "".join(e.get("id").removeprefix("window") for e in page.iter() if (e.get("id") or "").startswith("window-"))
    found = [(e.get("id").removesuffix(behind), e) for e in page.iter() if e.get("id") and e.get("points")]
    return [[tuple(map(float, p.split(","))) for p in e.get("points").split()] for id, e in found if re.fullmatch(name, id)]


class Sheets(FormatTest):
    def pages(self, endpoint, body, query):
        return pdf_reader.pages(self.service.text(endpoint, body, "format=pdf&" + query))

    def requests(self):
        """(endpoint, body, query) of every sheet: each example, hostile and long words, thin and large tubes."""
        for endpoint, views in (("bevel-tables", ("template", "section")), ("intersections", ("template", "section")),
                                ("holes", ("template", "section")), ("parts", ("work_order", "template"))):
            for i, body in enumerate(examples(endpoint).values()):
                for view in views:
                    for paper in ("sheet", *PAPERS[:1], PAPERS[i % 4]) if view == "template" else ("",):
                        words = ({}, {"reference": HOSTILE}, {"reference": LONG_REFERENCE})[i % 3]
                        yield endpoint, body | words, f"view={view}" + (f"&paper={paper}" if paper else "")
        for diameter in (5, 12, 20, 1000, 3000):
            body = {"target": {"outer_diameter_mm": diameter, "wall_mm": 0.5}, "sampling": {"tolerance_mm": 0.05}, "reference": LONG_REFERENCE,
                    "cutters": [{"kind": "tube", "id": LONG[:64], "outer_diameter_mm": 1.5 * diameter, "inclination_deg": 60},
                                {"kind": "plane", "id": "B", "point_mm": [0, 0, 0], "normal": [0, 1, 1]}]}
            for paper in ("sheet", *PAPERS):
                yield "intersections", body, f"view=template&paper={paper}"
        for paper in ("sheet", *PAPERS):
            yield "intersections", BIKE, f"view=template&paper={paper}"

    def test_every_text_can_be_read_and_is_on_its_page(self):
        texts, smallest = 0, math.inf
        for endpoint, body, query in self.requests():
            with self.subTest(f"{endpoint} {query} {list(body.get('reference', {}).values())[:1]}"):
                for page in self.pages(endpoint, body, query):
                    for text, x, y, height, c, s in page.texts:
                        self.assertGreaterEqual(height, LEAST - 5e-4, text)
                        wide = 0.8 * width(text, height, False)  # Helvetica is narrower
                        corners = [(x, y), (x + c * wide - s * UP * height, y + s * wide + c * UP * height)]
                        left, low, right, high = box_of(corners)
                        self.assertTrue(left >= 0 and low >= 0 and right <= page.width and high <= page.height, f"{text} at {left},{low},{right},{high}")
                        texts, smallest = texts + 1, min(smallest, height)
        print(f"{texts} texts, the smallest {smallest:.2f} mm")
        self.assertGreater(texts, 4000)

    def test_sheets_of_grooves_can_be_read_too(self):
        count = 0
        for body in examples("grooves").values():
            for query in ("", "&omega_deg=30"):
                root = ElementTree.fromstring(self.service.text("grooves", body | {"reference": LONG_REFERENCE}, "format=svg&view=section" + query))
                for e in root.iter(f"{SVG}text"):
                    self.assertGreaterEqual(float(e.get("font-size")), LEAST, e.text)
                    count += 1
        self.assertGreater(count, 100)

    def test_no_text_lies_on_another(self):
        for endpoint, body, query in self.requests():
            with self.subTest(f"{endpoint} {query}"):
                found = [(what, box) for what, box, _, _ in Picture(self.service.text(endpoint, body, "format=svg&" + query)).things
                         if what not in ("line", "rect", "polyline", "polygon", "path")]
                slack = 0.15
                found.sort(key=lambda one: one[1][1])
                for i, (a, p) in enumerate(found):
                    for b, q in found[i + 1:]:
                        if q[1] >= p[3]:
                            break
                        over = [min(p[k + 2], q[k + 2]) - max(p[k], q[k]) for k in (0, 1)]
                        self.assertFalse(over[0] > slack and over[1] > 0.45 * min(p[3] - p[1], q[3] - q[1]), f"{a} on {b}")

    def test_paper_has_its_size_and_a_millimetre_is_one(self):
        """Measured in the PDF: the page, the ruler, and the outer edge from seam to seam and from its lowest to its highest point."""
        for diameter in (5, 34.9, 70, 1000):
            rise = math.tan(math.radians(30)) * diameter
            body = {"target": {"outer_diameter_mm": diameter, "wall_mm": 0.5}, "sampling": {"uniform_points": 360},
                    "cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [math.sin(math.radians(30)), 0, math.cos(math.radians(30))]}]}
            for paper, size in SIZES.items():
                pages = self.pages("intersections", body, f"view=template&paper={paper}")
                edges = 0
                for page in pages:
                    self.assertIn((round(page.width, 3), round(page.height, 3)), (size, size[::-1]))
                    self.assertTrue(any(len(p) == 2 and abs(math.dist(*p) - 100) < 1e-3 for p, *_ in page.paths), "no ruler")
                    for points, _, how, colour in page.paths:
                        if colour == BLUE and how == "S" and len(points) > 100:
                            left, low, right, high = box_of(points)
                            self.assertAlmostEqual(right - left, math.pi * diameter, delta=2e-3)
                            self.assertAlmostEqual(high - low, rise, delta=2e-3 + 1e-4 * diameter)
                            edges += 1
                self.assertEqual(edges, len(pages))

    def sides(self, page, around, mirrored=False):
        """[(word, its box, the lowest and highest point of each cut above or below it)] of KEEP and SCRAP on a page."""
        for e in page.iter(f"{SVG}text"):
            if e.text in ("KEEP", "SCRAP"):
                height = float(e.get("font-size"))
                back = {"start": 0, "middle": 0.5, "end": 1}[e.get("text-anchor", "start")]
                wide = width(e.text, height, True)
                left = float(e.get("x")) - back * wide
                yield e.text, (left, float(e.get("y")) - UP * height, left + wide, float(e.get("y")))

    @staticmethod
    def heights(curve, left, right):
        """y of a curve between two x, its ends there too."""
        out = [y for x, y in curve if left <= x <= right]
        for (x0, y0), (x1, y1) in zip(curve, curve[1:]):
            for x in (left, right):
                if min(x0, x1) <= x <= max(x0, x1) and x0 != x1:
                    out.append(y0 + (y1 - y0) * (x - x0) / (x1 - x0))
        return out

    def sheets_of(self, content):
        root = ElementTree.fromstring(content)
        return [e for e in root.iter(f"{SVG}g") if re.fullmatch(r"sheet-\d+", e.get("id") or "")] or [root]

    def test_keep_and_scrap_stand_on_their_sides_of_an_end(self):
        r, count = random.Random(15), {"KEEP": 0, "SCRAP": 0}
        bodies = [BIKE, *examples("intersections").values()]
        while len(bodies) < 60:
            bodies.append(end(r))
        for body in bodies:
            paper = r.choice(["sheet", *PAPERS]) + r.choice(["", "&mirror=true"])
            status, _, content = self.service.ask("intersections", body, f"format=svg&view=template&paper={paper}")
            if status != 200:
                continue
            said = set()
            for page in self.sheets_of(content):
                curves = outlines(page, "cut-(outer|inner)")
                for word, (left, top, right, low) in self.sides(page, True):
                    said.add(word)
                    count[word] += 1
                    met = [y for curve in curves for y in self.heights(curve, left, right)]
                    with self.subTest(f"{word} {json.dumps(body)} {paper}"):
                        self.assertTrue(all(y > low if word == "KEEP" else y < top for y in met))  # y grows downwards
                        self.assertTrue(met)
            self.assertEqual(said, {"KEEP", "SCRAP"}, f"{json.dumps(body)} {paper}")
        self.assertGreater(min(count.values()), 50)

    def test_a_hole_is_scrap_and_what_is_round_it_is_kept(self):
        r, count = random.Random(16), 0
        for _ in range(30):
            body = hole(r)
            status, _, content = self.service.ask("holes", body, "format=svg&view=template")
            if status != 200:
                continue
            page = ElementTree.fromstring(content)
            openings = outlines(page, "cut-outer.*")
            words = dict(self.sides(page, False))
            self.assertEqual(set(words), {"KEEP", "SCRAP"}, json.dumps(body))
            for opening in openings:
                left, top, right, low = box_of(opening)
                keep = words["KEEP"]
                self.assertTrue(keep[3] < top or keep[1] > low or keep[2] < left or keep[0] > right, f"KEEP in the hole: {json.dumps(body)}")
            count += 1
        self.assertGreater(count, 15)

    def test_a_part_says_both_sides_of_both_ends(self):
        for name, body in examples("parts").items():
            for paper in ("sheet", "a4", "letter"):
                words = []
                for page in self.sheets_of(self.service.text("parts", body, f"format=svg&view=template&paper={paper}")):
                    starts, finishes = outlines(page, "cut-outer"), outlines(page, "cut-outer-2")
                    for word, (left, top, right, low) in self.sides(page, True):
                        words.append(word)
                        start = [y for c in starts for y in self.heights(c, left, right)]
                        finish = [y for c in finishes for y in self.heights(c, left, right)]
                        if word == "KEEP":
                            self.assertTrue(all(y > low for y in start) and all(y < top for y in finish), f"{name} {paper}")
                self.assertTrue(words.count("SCRAP") >= 2 and "KEEP" in words, f"{name} {paper}: {words}")

    def test_the_head_says_what_is_up_and_how_far_it_is_round(self):
        for paper in ("sheet", *PAPERS):
            for page in self.pages("intersections", BIKE, f"view=template&paper={paper}"):
                text = " ".join(t[0] for t in page.texts)
                for said in ("circumference 109.64 mm", "up: the kept side", "print side out", "KEEP", "SCRAP", "BB", "ST"):
                    self.assertIn(said, text, paper)

    def test_partners_stand_at_their_stretches_by_name(self):
        """Each name is there, whole or visibly shortened, and its middle, or the line that begins at it, lies on a stretch of its partner."""
        r, count = random.Random(17), 0
        for _ in range(40):
            body = end(r) | BASE
            for k, cutter in enumerate(body["cutters"]):
                cutter["id"] = r.choice([f"P{k}", f"{k}{LONG}"[:64]])
            status, _, content = self.service.ask("bevel-tables", body)
            if status != 200:
                continue
            points = json.loads(content)["result"]["points"]
            girth = math.pi * body["target"]["outer_diameter_mm"]
            page = ElementTree.fromstring(self.service.text("bevel-tables", body, "format=svg&view=template"))
            seam = float(next(e for e in page.iter() if e.get("id") == "seam-0").get("x1"))
            lines = [tuple(float(e.get(a)) for a in ("x1", "y1", "x2", "y2")) for e in page.iter(f"{SVG}line")]
            rows = [(seam + phi / 360 * girth, who) for phi, who in zip(points["phi_deg"], points["cutter"])]
            for who in set(points["cutter"]):
                name = body["cutters"][who]["id"]
                labels = [e for e in page.iter(f"{SVG}text") if e.text and (e.text == name or (e.text.endswith("...") and name.startswith(e.text[:-3]) and len(e.text) > 4))]
                with self.subTest(f"{name} {json.dumps(body)}"):
                    self.assertTrue(labels)
                    for e in labels:
                        self.assertGreaterEqual(float(e.get("font-size")), LEAST)
                        feet = [x for x, y, *_ in lines if abs(y - float(e.get("y"))) < 4 and abs(x - float(e.get("x"))) < 60 and x == _[0] if abs(y - _[1]) > 0.3]
                        places = [float(e.get("x")), *feet]
                        step = girth / 36 + 0.5
                        self.assertTrue(any(w == who and abs(x - at) <= step for at in places for x, w in rows))
                    count += 1
        self.assertGreater(count, 40)


if __name__ == "__main__":
    main()
