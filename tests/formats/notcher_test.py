"""A tube notcher's settings on the work order, and the columns that a template maker plots, against geometry of the test's own."""

import csv
import json
import math
import random
import xml.etree.ElementTree as ElementTree

from service import ROOT, FormatTest, examples, main

SVG = "{http://www.w3.org/2000/svg}"
HEADS = ["end", "hole saw", "angle from perpendicular", "offset", "depth", "rotation"]
BIKE = json.loads((ROOT / "tests/field/bike-down-tube-two-mitres.intersection.json").read_text())


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    length = math.hypot(*v)
    return tuple(c / length for c in v)


def height(point, direction, radius, x, y):
    """Where the line parallel to z through (x, y) leaves a cylinder, by the distance of its points to the axis; None if it misses."""
    d, p = unit(direction), (x - point[0], y - point[1], -point[2])
    a, b = cross(p, d), cross((0, 0, 1), d)  # distance^2 = |a + z b|^2
    bb, ab, aa = (sum(u * v for u, v in zip(m, n)) for m, n in ((b, b), (a, b), (a, a)))
    root = ab * ab - bb * (aa - radius * radius)
    return (-ab + math.sqrt(root)) / bb if root >= 0 else None


def depth(point, direction, radius, rho):
    """From the lowest to the highest height round the tube: 4000 phases, then a finer look about both."""
    def at(phi):
        return height(point, direction, radius, rho * math.cos(phi), rho * math.sin(phi))
    out = []
    for pick in (min, max):
        best, step = 0.0, math.pi / 2000
        grid = [step * i for i in range(4000)]
        best = pick(grid, key=at)
        for _ in range(5):
            best, step = pick((best + step * k / 10 for k in range(-10, 11)), key=at), step / 10
        out.append(at(best))
    return out[1] - out[0]


def settings(point, direction):
    """(angle from perpendicular, offset, phi on whose side the axis passes, phi towards which it rises into the member), deg and mm."""
    d = unit(direction)
    angle = math.degrees(math.asin(abs(d[2])))
    normal = unit((-d[1], d[0], 0.0))  # square to both axes
    off = sum(p * n for p, n in zip(point, normal))
    side = math.degrees(math.atan2(math.copysign(1, off) * normal[1], math.copysign(1, off) * normal[0]))
    up = d if d[2] > 0 else tuple(-c for c in d)
    return angle, abs(off), side, math.degrees(math.atan2(up[1], up[0]))


def turned(degrees, period=360.0):
    """In (-period / 2, period / 2]."""
    out = degrees % period
    return out - period if out > period / 2 else out


def end(r, outer, square):
    """An end by one round partner's axis, off the tube's; at right angles or not."""
    radius, turn = outer * r.uniform(1.15, 3), r.uniform(0, 2 * math.pi)
    rise = 0.0 if square else math.radians(r.uniform(2, 55)) * r.choice([-1, 1])
    direction = [math.cos(turn) * math.cos(rise), math.sin(turn) * math.cos(rise), math.sin(rise)]
    off = r.choice([0.0, r.uniform(-0.8, 0.8) * (radius - outer)])
    point = [-off * math.sin(turn), off * math.cos(turn), 0.0]
    return {"cutters": [{"kind": "tube", "id": "P", "outer_diameter_mm": 2 * radius, "axis": {"point_mm": point, "direction": direction}}],
            "root_surface": "inner", "groove": {"rule": "none"}, "contact": "auto", "smoothing": {"method": "none"}}


class Notcher(FormatTest):
    def rows(self, body):
        """The lines of the table, by their heads; [] if there is none."""
        root = ElementTree.fromstring(self.service.text("parts", body, "format=svg&view=work_order"))
        words = [e.text or "" for e in root.iter(f"{SVG}text")]
        if "Settings of a tube notcher, in mm" not in words:
            return []
        at = words.index("Settings of a tube notcher, in mm") + 1
        self.assertEqual(words[at:at + 6], HEADS)
        at, out = at + 6, []
        while words[at].startswith(("start by ", "finish by ")):
            out.append(dict(zip(HEADS, words[at:at + 6])))
            at += 6
        return out

    def test_settings_are_those_of_the_geometry(self):
        r, seen, squares = random.Random(161), 0, 0
        for i in range(110):
            outer, both_square = math.exp(r.uniform(math.log(6), math.log(200))), i % 5 == 0
            ends = {"start": end(r, outer, both_square), "finish": end(r, outer, both_square)}
            body = {"target": {"outer_diameter_mm": 2 * outer, "wall_mm": 0.08 * outer, "length_mm": 30 * outer}, "ends": ends, "kerf_mm": 0,
                    "datum": "seam", "seam_deg": 0, "torch": {"min_deg": -85, "max_deg": 85}, "sampling": {"uniform_points": 72}}
            status, _, content = self.service.ask("parts", body)
            if status != 200:
                self.assertLess(status, 500, content[:300])
                continue
            rows = self.rows(body)
            self.assertEqual([row["end"] for row in rows], ["start by P", "finish by P"])
            sides, perpendiculars = [], []
            for row, name in zip(rows, ("start", "finish")):
                cutter = ends[name]["cutters"][0]
                point, direction, radius = cutter["axis"]["point_mm"], cutter["axis"]["direction"], cutter["outer_diameter_mm"] / 2
                angle, off, side, lean = settings(point, direction)
                way = 1 if name == "start" else -1  # phi of the part runs the other way from the finish
                sides.append(way * lean)
                perpendiculars.append(way * (math.degrees(math.atan2(direction[1], direction[0])) + 90))
                with self.subTest(f"{name} of {json.dumps(body)}"):
                    self.assertAlmostEqual(float(row["hole saw"]), 2 * radius, delta=0.00501)
                    self.assertAlmostEqual(float(row["angle from perpendicular"].removesuffix("°")), angle, delta=0.0501)
                    self.assertAlmostEqual(float(row["depth"]), depth(point, direction, radius, outer), delta=0.0051 + 1e-6 * outer)
                    said, _, towards = row["offset"].partition(" towards phi ")
                    self.assertAlmostEqual(float(said), off, delta=0.00501)
                    if off > 0.01:
                        self.assertAlmostEqual(turned(float(towards.removesuffix("°")) - way * side), 0, delta=0.0501)
                    seen += 1
            self.assertEqual(rows[0]["rotation"], "0°")
            rotation = float(rows[1]["rotation"].removesuffix("°"))
            wanted = perpendiculars[1] - perpendiculars[0] if both_square else sides[1] - sides[0]
            period = 180 if both_square else 360
            self.assertAlmostEqual(turned(rotation - wanted, period), 0, delta=0.0501)
            self.assertTrue(-period / 2 - 0.05 <= rotation <= period / 2)
            squares += both_square
        self.assertGreaterEqual(seen, 200)
        self.assertGreater(squares, 15)

    def test_an_end_that_is_not_set_on_a_tube_has_no_settings(self):
        self.assertEqual(self.rows(examples("parts")["chord-with-holes"]), [])
        plain = {"target": {"outer_diameter_mm": 100, "wall_mm": 5, "length_mm": 800}, "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                 "kerf_mm": 0, "datum": "seam", "seam_deg": 0, "sampling": {"uniform_points": 72}}
        self.assertEqual(self.rows(plain), [])

    def test_a_template_maker_plots_the_csv(self):
        """girth_mm over the outside and drop_mm from the long point, in every row of both walls."""
        r, count = random.Random(162), 0
        bodies = [BIKE, *examples("intersections").values()]
        for _ in range(60):
            outer = r.uniform(5, 200)
            bodies.append({"target": {"outer_diameter_mm": 2 * outer, "wall_mm": 0.1 * outer}, "cutters": end(r, outer, r.random() < 0.2)["cutters"],
                           "sampling": r.choice([{"uniform_points": 36}, {"tolerance_mm": 0.05}]), "surfaces": r.choice(["both", "outer", "inner"])})
        for body in bodies:
            text = self.service.text("intersections", body, "format=csv").decode()
            rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
            girth = math.pi * body["target"]["outer_diameter_mm"]
            lead = [float(row["z_mm"]) for row in rows if row["surface"] == "outer"] or [float(row["z_mm"]) for row in rows]
            for row in rows:
                self.assertAlmostEqual(float(row["girth_mm"]), float(row["phi_deg"]) / 360 * girth, delta=1e-9 * girth)
                self.assertAlmostEqual(float(row["drop_mm"]), float(row["z_mm"]) - min(lead), delta=1e-9)
                count += 1
            self.assertEqual(min(float(row["drop_mm"]) for row in rows if row["surface"] == ("outer" if any(x["surface"] == "outer" for x in rows) else "inner")), 0)
        self.assertGreater(count, 2000)


if __name__ == "__main__":
    main()
