"""The 1:1 drawings drawn by librsvg and measured in its pixels."""

import json
import math
import re
import xml.etree.ElementTree as ElementTree

import cairo
import gi

gi.require_version("Rsvg", "2.0")
from gi.repository import Rsvg  # noqa: E402

from dxf_test import polylines, read  # noqa: E402
from service import HOSTILE, FormatTest, examples, main, off_curve, rolled, seam_row  # noqa: E402

DPI = 254  # ten pixels a millimetre
SVG = "{http://www.w3.org/2000/svg}"
BLUE = (0x1f, 0x5f, 0xbf)


def first_to_last(line):
    """Pixels from the middle of the first run of dark ones to the middle of the last."""
    dark = [i for i, d in enumerate(line) if d]
    starts = [i for i in dark if i - 1 not in dark]
    ends = [i for i in dark if i + 1 not in dark]
    return (starts[-1] + ends[-1] - starts[0] - ends[0]) / 2


class Drawing:
    def __init__(self, svg):
        self.root = ElementTree.fromstring(svg)
        self.height_mm = float(self.root.get("height").removesuffix("mm"))
        self.width_mm = float(self.root.get("width").removesuffix("mm"))
        handle = Rsvg.Handle.new_from_data(svg)
        handle.set_dpi(DPI)
        _, width, height = handle.get_intrinsic_size_in_pixels()
        self.width, self.height = round(width), round(height)
        surface = cairo.ImageSurface(cairo.FORMAT_RGB24, self.width, self.height)
        sheet = Rsvg.Rectangle()
        sheet.x, sheet.y, sheet.width, sheet.height = 0, 0, width, height
        handle.render_document(cairo.Context(surface), sheet)
        surface.flush()
        self.bytes, self.stride = bytes(surface.get_data()), surface.get_stride()

    def color(self, x, y):
        return tuple(reversed(self.bytes[y * self.stride + 4 * x:y * self.stride + 4 * x + 3]))

    def dark(self, x, y):
        return sum(self.color(x, y)) < 384

    def element(self, name):
        return next(e for e in self.root.iter() if e.get("id") == name)

    def blue_at(self, x):
        """y in mm of the middle of the blue pixels of column x, up from the lower edge."""
        found = [y for y in range(self.height) if math.dist(self.color(x, y), BLUE) < 60]
        return (self.height - (found[0] + found[-1] + 1) / 2) * 25.4 / DPI if found else None


class Svg(FormatTest):
    def drawing(self, endpoint, body, view, more=""):
        return Drawing(self.service.text(endpoint, body, f"format=svg&view={view}{more}"))

    def test_the_ruler_is_100_mm_both_ways(self):
        for endpoint, name in (("bevel-tables", "source-000-table-1"), ("holes", "set-on-branch"),
                               ("intersections", "source-000-table-1")):
            with self.subTest(endpoint):
                d = self.drawing(endpoint, examples(endpoint)[name], "template")
                self.assertAlmostEqual(d.width, d.width_mm * DPI / 25.4, delta=1)
                self.assertAlmostEqual(d.height, d.height_mm * DPI / 25.4, delta=1)
                across, up = d.element("ruler-x"), d.element("ruler-y")
                y, x = (round(float(e.get(a)) * DPI / 25.4) for e, a in ((across, "y1"), (up, "x1")))
                # One millimetre off the line only its ticks are met, the first and the last at its ends.
                for pixels in (first_to_last(d.dark(i, y - 10) for i in range(d.width)),
                               first_to_last(d.dark(x + 10, i) for i in range(d.height))):
                    print(f"{endpoint}: a ruler of {pixels * 25.4 / DPI:.2f} mm")
                    self.assertAlmostEqual(pixels * 25.4 / DPI, 100.0, delta=0.051)

    def test_the_outer_edge_is_where_the_table_has_it(self):
        body = examples("bevel-tables")["source-000-table-1"]
        points = self.service.answer("bevel-tables", body)["result"]["points"]
        for mirror in (False, True):
            d = self.drawing("bevel-tables", body, "template", "&mirror=true" if mirror else "")
            seam = {k: float(d.element(k).get("x1")) for k in ("seam-0", "seam-360")}
            self.assertAlmostEqual(abs(seam["seam-360"] - seam["seam-0"]), math.pi * 70, delta=2e-3)
            self.assertEqual(seam["seam-360"] < seam["seam-0"], mirror)
            rows, offsets = seam_row(points["phi_deg"], points["z_outer_mm"]), []
            for column in range(0, d.width, 37):
                middle = (column + 0.5) * 25.4 / DPI
                phi = (middle - seam["seam-0"]) / (seam["seam-360"] - seam["seam-0"]) * 360
                if not 2 < phi < 358:
                    continue
                (p, u), (q, v) = next(pair for pair in zip(rows, rows[1:]) if pair[0][0] <= phi <= pair[1][0])
                offsets.append(d.blue_at(column) - (u + (phi - p) / (q - p) * (v - u)))
            self.assertGreater(len(offsets), 40)
            self.assertLess(max(offsets) - min(offsets), 0.2)

    def test_open_text_is_text(self):
        for endpoint, view in (("bevel-tables", "template"), ("bevel-tables", "section"), ("bevel-tables", "chart"),
                               ("intersections", "template"), ("holes", "section")):
            body = {**next(iter(examples(endpoint).values())), "reference": HOSTILE}
            root = ElementTree.fromstring(self.service.text(endpoint, body, f"format=svg&view={view}"))
            self.assertEqual([e.tag for e in root.iter() if "script" in e.tag], [])
            text = " ".join(e.text or "" for e in root.iter(f"{SVG}text"))
            for value in HOSTILE.values():
                self.assertIn(value, text)

    def test_sections_are_a4(self):
        for endpoint in ("bevel-tables", "intersections", "holes"):
            for name, body in examples(endpoint).items():
                with self.subTest(f"{endpoint} {name}"):
                    root = ElementTree.fromstring(self.service.text(endpoint, body, "format=svg&view=section"))
                    self.assertEqual((root.get("width"), root.get("height")), ("210.000mm", "297.000mm"))
                    corners = [tuple(map(float, p.split(","))) for e in root.iter(f"{SVG}polygon") for p in e.get("points").split()]
                    self.assertGreaterEqual(len(corners), 8 * 4)
                    for x, y in corners:
                        self.assertTrue(10 <= x <= 200 and 10 <= y <= 287, f"{x},{y}")

    def test_sections_say_the_bevel_they_show(self):
        count = 0
        for endpoint in ("bevel-tables", "intersections", "holes"):
            for name, body in examples(endpoint).items():
                wall = body.get("chord", body.get("target", {})).get("wall_mm")
                if wall is None or "root_face_mm" in body.get("groove", {}) or "root_face" in json.dumps(body):
                    continue
                root = ElementTree.fromstring(self.service.text(endpoint, body, "format=svg&view=section"))
                words = [e.text or "" for e in root.iter(f"{SVG}text")]
                at = words.index("outer edge, mm") + 1
                for k in range(at, at + 32, 4):
                    angle, inner, outer = map(float, words[k + 1:k + 4])
                    with self.subTest(f"{endpoint} {name} {words[k]}"):
                        self.assertAlmostEqual(abs(angle), math.degrees(math.atan(abs(outer - inner) / wall)), delta=0.02)
                        count += 1
        self.assertGreaterEqual(count, 8 * 8)

    def test_work_orders(self):
        for name, body in examples("parts").items():
            with self.subTest(name):
                result = self.service.answer("parts", body)["result"]
                asked = {**body, "reference": HOSTILE}
                root = ElementTree.fromstring(self.service.text("parts", asked, "format=svg&view=work_order"))
                self.assertEqual((root.get("width"), root.get("height")), ("210.000mm", "297.000mm"))
                words = [e.text or "" for e in root.iter(f"{SVG}text")]
                for value in HOSTILE.values():
                    self.assertIn(value, " ".join(words))
                for check in result["check_dimensions"]:
                    at = words.index(check["name"])
                    self.assertAlmostEqual(float(words[at + 1]), check["value_mm"], delta=0.05)
                    for mistake in check["changes_with"]:
                        self.assertIn(mistake, words[at + 3])
                for step in range(len(result["sequence"])):
                    self.assertTrue(any(w.startswith(f"{step + 1}  ") for w in words), step)
                along, round_ = (float(scale.split(":")[0]) / float(scale.split(":")[1]) for scale in
                                 re.search(r"along (\S+), round (\S+)", next(w for w in words if "developed" in w)).groups())
                for end in ("start", "finish"):
                    rows = result["ends"][end]["points"]
                    drawn = next(e for e in root.iter() if e.get("id") == f"{end}_outer").get("points").split()
                    xy = [tuple(map(float, p.split(","))) for p in drawn]
                    self.assertEqual(len(xy), len(rows["phi_deg"]) + 1)
                    z = rows["z_outer_mm"]
                    order = sorted(range(len(z)), key=lambda i: rows["phi_deg"][i] % 360)
                    girth = result["check_dimensions"][0]["value_mm"]
                    x0, y0 = xy[0]
                    for (x, y), i in zip(xy, order):
                        self.assertAlmostEqual((x - x0) / along, z[i] - z[order[0]], delta=2e-3 / along)
                        turn = (rows["phi_deg"][i] - rows["phi_deg"][order[0]]) / 360
                        self.assertAlmostEqual((y - y0) / round_, turn * girth, delta=2e-3 / round_)

    def test_a_work_order_seen_from_outside_is_the_part_in_space(self):
        """Laid round the tube with its print side out the holes lie on the curves in space; mirrored they do not."""
        body = examples("parts")["chord-with-holes"]
        root = ElementTree.fromstring(self.service.text("parts", body, "format=svg&view=work_order"))
        title = next(e.text for e in root.iter(f"{SVG}text") if "developed" in (e.text or ""))
        self.assertIn("seen from outside", title)
        along, around = (float(a) / float(b) for a, b in re.findall(r"(\d+):(\d+)", title))
        result = self.service.answer("parts", body)["result"]
        radius = next(d["value_mm"] for d in result["check_dimensions"] if d["name"] == "girth") / (2 * math.pi)
        start = next(e for e in root.iter() if e.get("id") == "start_outer").get("points").split()[0].split(",")
        first = min(zip((p % 360 for p in result["ends"]["start"]["points"]["phi_deg"]), result["ends"]["start"]["points"]["z_outer_mm"]))

        def sheet(polygon, side):
            """(z, up) on the tube, up from phi = 0."""
            xy = [tuple(map(float, p.split(","))) for p in polygon.get("points").split()]
            return [((x - float(start[0])) / along + first[1], side * ((float(start[1]) - y) / around - radius * math.radians(first[0]))) for x, y in xy]
        holes = [e for e in root.iter(f"{SVG}polygon") if e.get("stroke-dasharray") is None]
        self.assertEqual(len(holes), 3 * len(result["holes"]))
        curves = [points for points, _ in polylines(read(self.service.text("parts", body, "format=dxf&view=tube")), "CUT_OUTER")][2:]
        off = {side: max(min(off_curve(rolled(sheet(hole, side), radius), curve) for curve in curves) for hole in holes) for side in (1, -1)}
        self.assertLess(off[1], 0.1)  # a hundredth of a mm on paper is 0.05 mm on the tube here
        self.assertGreater(off[-1], 5)

    def test_marks_of_a_work_order_stand_in_their_contours(self):
        """The name of each partner is where one of the rings of its hole is."""
        count = 0
        for name, body in examples("parts").items():
            result = self.service.answer("parts", body)["result"]
            root = ElementTree.fromstring(self.service.text("parts", body, "format=svg&view=work_order"))
            rings = [[tuple(map(float, p.split(","))) for p in e.get("points").split()]
                     for e in root.iter(f"{SVG}polygon") if e.get("stroke-dasharray") is None]
            for i, hole in enumerate(result["holes"]):
                for mark in (one for one in result["marks"] if one["kind"] == "partner" and one["text"] == hole["branch"]):
                    [place] = [(float(e.get("x")) - 0.5, float(e.get("y"))) for e in root.iter(f"{SVG}text") if e.text == mark["text"]]
                    mine = rings[3 * i:3 * i + 3]
                    with self.subTest(f"{name} {mark['text']}"):
                        self.assertTrue(any(all(min(p[k] for p in ring) - 3 <= place[k] <= max(p[k] for p in ring) + 3 for k in (0, 1)) for ring in mine))
                        for other in (ring for j in range(len(result["holes"])) if j != i for ring in rings[3 * j:3 * j + 3]):
                            self.assertFalse(min(x for x, _ in other) <= place[0] <= max(x for x, _ in other))
                        count += 1
        self.assertGreaterEqual(count, 2)

    def test_a_mark_of_a_point_is_drawn(self):
        root = ElementTree.fromstring(self.service.text("parts", examples("parts")["chord-with-holes"], "format=svg&view=work_order"))
        for e in root.iter(f"{SVG}line"):
            self.assertNotEqual((e.get("x1"), e.get("y1")), (e.get("x2"), e.get("y2")))

    def test_templates_of_the_smallest_and_the_largest_tube(self):
        for diameter in (5, 5000):
            body = {"target": {"outer_diameter_mm": diameter, "wall_mm": 0.5},
                    "cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 1, 1]}],
                    "sampling": {"tolerance_mm": 0.05}}
            root = ElementTree.fromstring(self.service.text("intersections", body, "format=svg&view=template"))
            points = next(e for e in root.iter() if e.get("id") == "cut-outer").get("points").split()
            x = [float(p.split(",")[0]) for p in points]
            self.assertAlmostEqual(x[-1] - x[0], math.pi * diameter, delta=2e-3)
            y = [float(p.split(",")[1]) for p in points]
            self.assertAlmostEqual(max(y) - min(y), diameter, delta=0.01 * diameter)
            self.assertLess(max(x), float(root.get("width").removesuffix("mm")))


if __name__ == "__main__":
    main()
