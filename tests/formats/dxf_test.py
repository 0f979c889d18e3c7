"""The DXF drawings read by ezdxf: its auditor, layers, units, lengths and texts."""

import math
import pathlib
import tempfile

import ezdxf
from ezdxf.lldxf.encoding import decode_dxf_unicode

from service import HOSTILE, FormatTest, cutout_points, cutouts, examples, main, seam_row

CALLED = {"customer_id": "customer"}  # docs/glossary.md
LAYERS = {"CUT_OUTER", "CUT_INNER", "TORCH", "SEAM", "DATUM", "TEXT"}


def read(content):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "cut.dxf")
        file.write_bytes(content)
        return ezdxf.readfile(file)


def polylines(drawing, layer):
    """[(points, closed)] in the order drawn."""
    out = []
    for entity in drawing.modelspace().query(f'LWPOLYLINE POLYLINE[layer=="{layer}"]'):
        if entity.dxftype() == "LWPOLYLINE":
            out.append(([(x, y) for x, y in entity.get_points("xy")], entity.closed))
        else:
            out.append(([tuple(v.dxf.location) for v in entity.vertices], entity.is_closed))
    return out


def length(points, closed):
    return sum(math.dist(a, b) for a, b in zip(points, points[1:] + points[:1] if closed else points[1:]))


def developed(phi_deg, z, radius):
    points = [(radius * math.radians(phi), z) for phi, z in seam_row(phi_deg, z)]
    return length(points, False)


class Dxf(FormatTest):
    def drawing(self, endpoint, body, view="template"):
        drawing = read(self.service.text(endpoint, body, f"format=dxf&view={view}"))
        audit = drawing.audit()
        self.assertEqual([e.message for e in audit.errors], [])
        self.assertEqual([e.message for e in audit.fixes], [])
        self.assertEqual(drawing.dxfversion, "AC1015")
        self.assertEqual(drawing.header["$INSUNITS"], 4)
        self.assertLessEqual(LAYERS, {layer.dxf.name for layer in drawing.layers})
        return drawing

    def test_bevel_tables_lie_flat_with_the_lengths_of_the_table(self):
        for name, body in examples("bevel-tables").items():
            with self.subTest(name):
                drawing = self.drawing("bevel-tables", body)
                if "target" not in body:
                    continue
                table, target = self.service.answer("bevel-tables", body)["result"]["points"], body["target"]
                radius = {"CUT_OUTER": target["outer_diameter_mm"] / 2,
                          "CUT_INNER": target["outer_diameter_mm"] / 2 - target["wall_mm"]}
                radius["TORCH"] = radius["CUT_OUTER"]
                for layer, column in (("CUT_OUTER", "z_outer_mm"), ("CUT_INNER", "z_inner_mm"), ("TORCH", "torch_outer_mm")):
                    [(points, closed)] = polylines(drawing, layer)
                    self.assertFalse(closed)
                    self.assertAlmostEqual(points[0][0], 0.0, delta=1e-6)
                    self.assertAlmostEqual(points[-1][0], 2 * math.pi * radius[layer], delta=1e-6)
                    self.assertAlmostEqual(points[0][1], points[-1][1], delta=1e-6)
                    self.assertAlmostEqual(length(points, False), developed(table["phi_deg"], table[column], radius[layer]),
                                           delta=1e-6 * len(points))

    def test_holes_have_the_torch_where_the_answer_has_it(self):
        for name, body in examples("holes").items():
            with self.subTest(name):
                if "chord" not in body:
                    continue
                radius = body["chord"]["outer_diameter_mm"] / 2
                holes = self.service.answer("holes", body)["result"]["holes"]
                drawn = polylines(self.drawing("holes", body), "TORCH")
                self.assertEqual(len(drawn), len(holes))
                for (points, closed), hole in zip(drawn, holes):
                    rows = hole["points"]
                    self.assertTrue(closed)
                    for phi, z in zip(rows["torch_phi_deg"], rows["torch_z_mm"]):
                        self.assertLess(min(math.dist((radius * math.radians(phi), z), point) for point in points), 1e-5)

    def test_the_outline_closes_with_seam_and_datum(self):
        drawing = self.drawing("bevel-tables", examples("bevel-tables")["source-000-table-1"])
        [(cut, _)] = polylines(drawing, "CUT_OUTER")
        [(datum, _)] = polylines(drawing, "DATUM")
        seams = polylines(drawing, "SEAM")
        self.assertEqual(len(seams), 2)
        for (seam, _), corner, end in zip(seams, (cut[0], cut[-1]), datum):
            for got, wanted in zip(seam, (corner, end)):
                self.assertLess(math.dist(got, wanted), 1e-5)

    def test_true_lengths_of_an_intersection(self):
        for name, body in examples("intersections").items():
            with self.subTest(name):
                body = {**body, "sampling": {"tolerance_mm": 0.001, "metric": "developed"}}
                result = self.service.answer("intersections", body)["result"]
                drawing = self.drawing("intersections", body)
                for profile in result["profiles"]:
                    [(points, _)] = polylines(drawing, f"CUT_{profile['surface'].upper()}")
                    # A chord that sags by s over a length c is shorter by less than 4 s^2 / c.
                    short = profile["length_mm"] - length(points, False)
                    self.assertGreater(short, -1e-6)
                    self.assertLess(short, 4 * 0.001**2 * len(points)**2 / profile["length_mm"])

    def test_on_the_tube_curves_are_closed_and_stay_on_the_wall(self):
        for endpoint in ("bevel-tables", "intersections", "holes", "parts"):
            for name, body in examples(endpoint).items():
                with self.subTest(f"{endpoint} {name}"):
                    drawing = self.drawing(endpoint, body, "tube")
                    drawn = polylines(drawing, "CUT_OUTER") + polylines(drawing, "CUT_INNER")
                    self.assertTrue(drawn)
                    for points, closed in drawn:
                        self.assertTrue(closed)
                        radius = math.hypot(*points[0][:2])
                        for a, b in zip(points, points[1:] + points[:1]):
                            self.assertAlmostEqual(math.hypot(*a[:2]), radius, delta=2e-6)
                            middle = math.hypot((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
                            self.assertGreater(middle, radius - 0.0101)

    def test_holes_are_closed(self):
        for name, body in examples("holes").items():
            with self.subTest(name):
                holes = self.service.answer("holes", body)["result"]["holes"]
                radius = body["chord"]["outer_diameter_mm"] / 2
                drawn = polylines(self.drawing("holes", body), "CUT_OUTER")
                self.assertEqual(len(drawn), len(holes))
                for (points, closed), hole in zip(drawn, holes):
                    self.assertTrue(closed)
                    ours = [(radius * math.radians(p), z) for p, z in zip(hole["points"]["phi_deg"], hole["points"]["z_mm"])]
                    self.assertAlmostEqual(length(points, True), length(ours, True), delta=1e-6 * len(ours))

    def test_it_says_of_what_it_is_and_which_side_is_kept(self):
        kept = {"holes": ("openings of the chord", "kept outside the contour"), "bevel-tables": ("tube ", "kept side up")}
        for endpoint, (whose, side) in kept.items():
            for name, body in examples(endpoint).items():
                for view in ("template", "tube"):
                    with self.subTest(f"{endpoint} {name} {view}"):
                        texts = [t.dxf.text for t in self.drawing(endpoint, body, view).modelspace().query("TEXT")]
                        self.assertTrue(any(text.startswith(whose) for text in texts), texts)
                        self.assertTrue(any(side in text for text in texts), texts)
                        for other in {side for _, side in kept.values()} - {side}:
                            self.assertFalse(any(other in text for text in texts), texts)

    def test_a_part_is_one_closed_outline_with_its_holes(self):
        for name, body in examples("parts").items():
            with self.subTest(name):
                result = self.service.answer("parts", body)["result"]
                drawing = self.drawing("parts", body)
                outer = polylines(drawing, "CUT_OUTER")
                openings = result["holes"] + [{"points": cutout_points(result, i)} for i in range(len(cutouts(result)))]
                self.assertEqual([closed for _, closed in outer], [False, False] + [True] * len(openings))
                girth = next(d["value_mm"] for d in result["check_dimensions"] if d["name"] == "girth")
                (start, _), (finish, _) = outer[:2]
                ends = result["ends"]
                for points, end in ((start, ends["start"]), (finish, ends["finish"])):
                    self.assertAlmostEqual(points[-1][0], girth, delta=1e-5)
                    p = end["points"]
                    self.assertAlmostEqual(length(points, False), developed(p["phi_deg"], p["z_outer_mm"], girth / (2 * math.pi)),
                                           delta=1e-6 * len(points))
                for (seam, _), a, b in zip(polylines(drawing, "SEAM"), (start[0], start[-1]), (finish[0], finish[-1]), strict=True):
                    self.assertLess(math.dist(seam[0], a) + math.dist(seam[1], b), 1e-5)
                for points, _ in outer[2:]:
                    self.assertTrue(any(all(math.dist(got, (girth * phi / 360 + turn, z)) < 1e-5
                                            for got, phi, z in zip(points, hole["points"]["phi_deg"], hole["points"]["z_mm"], strict=True))
                                        for hole in openings if len(hole["points"]["z_mm"]) == len(points) for turn in (-girth, 0, girth)))
                boxes = [(min(x for x, _ in points), min(z for _, z in points), max(x for x, _ in points), max(z for _, z in points))
                         for points, _ in outer[2:]]
                self.marked(result, girth, [points for points, _ in polylines(drawing, "MARK")], drawing, boxes)
                in_space = self.drawing("parts", body, "tube")
                turned = [[(girth * (math.atan2(y, x) / (2 * math.pi) % 1), z) for x, y, z in points] for points, _ in polylines(in_space, "MARK")]
                self.marked(result, girth, turned, in_space)
                self.assertAlmostEqual(max(y for _, y in finish + start), max(ends["finish"]["points"]["z_outer_mm"]), delta=1e-6)

    def marked(self, result, girth, drawn, drawing, boxes=()):
        """Every mark: a line from end to end, or a cross of two on its place; and its name somewhere in the text."""
        texts = " ".join(t.dxf.text for t in drawing.modelspace().query("TEXT"))
        wanted = 0
        for mark in result["marks"]:
            line = mark["z_to_mm"] > mark["z_from_mm"]
            wanted += 1 if line else 2
            places = [(mark["girth_mm"] + turn * girth, (mark["z_from_mm"] + mark["z_to_mm"]) / 2) for turn in (0, -1, 1)]
            # In space all turns are equal; developed, a mark lies in the contour of its hole.
            held = [place for place in places if any(box[0] <= place[0] <= box[2] and box[1] <= place[1] <= box[3] for box in boxes)]
            middle = (held or places)[0]
            near = [points for points in drawn if any(
                math.hypot((p[0] + q[0]) / 2 - middle[0], (p[1] + q[1]) / 2 - middle[1]) < 1e-4 for p, q in ((points[0], points[-1]),))]
            across = [points for points in drawn if len(points) == 3 and math.dist(points[1], middle) < 1e-4]
            self.assertTrue(near)
            self.assertEqual(bool(across), not line or bool(across))
            if mark["kind"] != "datum_line":
                self.assertIn(mark["text"], texts)
        self.assertEqual(len(drawn), wanted)

    def test_open_text_arrives_as_written(self):
        body = {**examples("bevel-tables")["source-000-table-1"], "reference": HOSTILE}
        drawing = self.drawing("bevel-tables", body)
        texts = [decode_dxf_unicode(t.dxf.text).replace("%%%", "%").replace("^ ", "^") for t in drawing.modelspace().query("TEXT")]
        for key, value in HOSTILE.items():
            self.assertIn(f"{CALLED.get(key, key)}: {value}", texts)


if __name__ == "__main__":
    main()
