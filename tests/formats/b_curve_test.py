"""Source 000's picture of B over phi, measured: its curves are the answer's columns, its strips tell who cuts where, its limits are the torch's."""

import re
import xml.etree.ElementTree as ElementTree

from service import ROOT, FormatTest, examples, main

SVG = "{http://www.w3.org/2000/svg}"


def tones():
    """The console's colours of partners, by day."""
    found = re.findall(r"--partner-(\d): (#[0-9a-f]{6})", (ROOT / "web/src/tokens.css").read_text())
    return [colour for _, colour in found[:6]]


class Curve:
    def __init__(self, content):
        root = ElementTree.fromstring(content)
        self.texts = [(e.text, float(e.get("x", 0)), float(e.get("y", 0)), e.get("text-anchor")) for e in root.iter(f"{SVG}text")]
        self.lines = [e for e in root.iter(f"{SVG}line")]
        self.curves = [[tuple(map(float, p.split(","))) for p in e.get("points").split()] for e in root.iter(f"{SVG}polyline")]
        self.strips = [(float(e.get("x")), float(e.get("x")) + float(e.get("width")), e.get("fill"))
                       for e in root.iter(f"{SVG}rect") if e.get("height") == "7.00"]
        self.left, self.right = (f(x for x, _ in self.curves[0]) for f in (min, max))
        ticks = [(float(text), y - 4) for text, _, y, anchor in self.texts if anchor == "end" and re.fullmatch(r"-?\d+", text)]
        (low, y0), (high, y1) = ticks[0], ticks[-1]
        self.b = lambda y: low + (y - y0) * (high - low) / (y1 - y0)
        self.phi = lambda x: 360 * (x - self.left) / (self.right - self.left)
        self.pixel = abs((high - low) / (y1 - y0))  # degrees


class BCurve(FormatTest):
    def drawn(self, body):
        return Curve(self.service.text("bevel-tables", body, "format=svg&view=b_curve"))

    def tables(self):
        for name, body in examples("bevel-tables").items():
            yield name, body, self.service.answer("bevel-tables", body)

    def test_its_curves_are_the_columns_from_seam_to_seam(self):
        for name, body, answer in self.tables():
            with self.subTest(name):
                drawn, points = self.drawn(body), answer["result"]["points"]
                self.assertEqual(len(drawn.curves), 3)
                for curve, column in zip(drawn.curves, ("b_raw_deg", "b_required_deg", "b_deg")):
                    values = points[column]
                    self.assertEqual((curve[0][0], curve[-1][0]), (drawn.left, drawn.right))
                    self.assertAlmostEqual(curve[0][1], curve[-1][1], delta=0.011)  # closed
                    got = [drawn.b(y) for _, y in curve]
                    for extreme in (min, max):  # thinned to pixels, with all extremes kept
                        self.assertAlmostEqual(extreme(got), extreme(values), delta=0.02 * drawn.pixel)
                    first = points["phi_deg"][0]
                    for phi, value in list(zip(points["phi_deg"], values))[::17]:
                        near = [(drawn.phi(x), drawn.b(y)) for x, y in curve if abs(drawn.phi(x) + first - phi) < 1]
                        self.assertTrue(min(b for _, b in near) - drawn.pixel <= value <= max(b for _, b in near) + drawn.pixel, f"{column} at {phi}")

    def test_strips_tell_who_cuts_where_and_end_at_the_axis(self):
        colours, count = tones(), 0
        self.assertEqual(len(colours), 6)
        for name, body, answer in self.tables():
            with self.subTest(name):
                drawn, points = self.drawn(body), answer["result"]["points"]
                who = points["cutter"]
                wanted = [who[i] for i in range(len(who)) if i == 0 or who[i] != who[i - 1]]
                self.assertEqual([colour for *_, colour in drawn.strips], [colours[i % 6] for i in wanted])
                self.assertEqual((drawn.strips[0][0], drawn.strips[-1][1]), (drawn.left, drawn.right))
                for before, after in zip(drawn.strips, drawn.strips[1:]):
                    self.assertAlmostEqual(before[1], after[0], delta=0.02)
                names = answer["result"].get("cutter_ids") or [c.get("id", f"partner {i + 1}") for i, c in enumerate(body["cutters"])]
                said = [text for text, *_ in drawn.texts]
                for i in set(wanted):
                    self.assertEqual(said.count(names[i]), wanted.count(i))
                count += len(wanted)
        self.assertGreater(count, 20)

    def test_the_nearer_limit_of_the_torch_is_in_the_picture(self):
        base = examples("bevel-tables")["source-000-table-1"]
        for torch, wanted in (({"min_deg": -80, "max_deg": 80}, [80]), ({"min_deg": 10, "max_deg": 85}, [10]), ({"min_deg": -30, "max_deg": 75}, [75])):
            drawn = self.drawn(base | {"torch": torch})
            limits = [e for e in drawn.lines if e.get("stroke") == "#b3261e"]
            self.assertEqual([round(drawn.b(float(e.get("y1"))), 1) for e in limits], wanted)
            for e in limits:
                self.assertEqual((float(e.get("x1")), float(e.get("x2"))), (drawn.left, drawn.right))
            self.assertEqual([text for text, *_ in drawn.texts if text.startswith("torch limit")], [f"torch limit {b}°" for b in wanted])
        both = self.drawn({key: value for key, value in base.items() if key != "smoothing"} | {
            "cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 1, 1]}], "smoothing": {"method": "none"}, "groove": {"rule": "none"}})
        self.assertEqual([text for text, *_ in both.texts if text.startswith("torch limit")], ["torch limit -80°", "torch limit 80°"])

    def test_jumps_are_those_of_the_answer(self):
        count = 0
        for name, body, answer in self.tables():
            with self.subTest(name):
                said = [float(text.removeprefix("jump of ").removesuffix("°")) for text, *_ in self.drawn(body).texts if text.startswith("jump of ")]
                self.assertEqual(said, [round(m["step_deg"], 1) for m in answer["result"]["mutations"]])
                count += len(said)
        self.assertGreater(count, 5)

    def test_labels_are_whole(self):
        for name, body, _ in self.tables():
            named = body if "cutters" not in body else body | {"cutters": [c | {"id": "W" * 60 + str(i)} for i, c in enumerate(body["cutters"])]}
            for text, x, y, anchor in self.drawn(named).texts:
                if text.startswith("WW"):
                    self.assertTrue(x >= 78 and x + 6.0 * len(text) < 960, f"{name}: {text} at {x}")
                    self.assertTrue(0 < y < 400)


if __name__ == "__main__":
    main()
