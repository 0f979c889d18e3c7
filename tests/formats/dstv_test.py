"""The DSTV file read by a parser of its own: header lines in the standard's order, contour points, bevel and B table."""

import json
import math
import re

from dxf_test import polylines, read
from service import HOSTILE, FormatTest, cutout_points, cutouts, examples, main, off_curve, rolled, seam_row

HEADER = ("order", "drawing", "phase", "piece", "grade", "quantity", "profile", "code", "length", "height", "flange_width",
          "flange", "web", "radius", "weight", "paint", "web_start", "web_end", "flange_start", "flange_end",
          "text1", "text2", "text3", "text4")
NUMBER = r"-?\d+\.\d+"
BORE = re.compile(rf"^  ([vouh])\s+({NUMBER})([ous])\s+({NUMBER})\s+({NUMBER})\s+({NUMBER})$")
POINT = re.compile(rf"^  ([ vouh])\s+({NUMBER})([ous ]?)\s+({NUMBER})\s+({NUMBER})(?:\s+({NUMBER})\s+({NUMBER})\s+({NUMBER})\s+({NUMBER}))?$")


def parse(text):
    """{"comments", "header", "AK": [[(x, y, bevel)]], "IK": ...}; refuses what the standard does not have."""
    lines = text.split("\r\n")
    if lines[0] != "ST" or lines[-2:] != ["EN", ""]:
        raise AssertionError("no ST ... EN")
    comments = [line[3:] for line in lines if line.startswith("** ")]
    plain = [line for line in lines[1:-2] if not line.startswith("**")]
    header, rest = dict(zip(HEADER, plain[:len(HEADER)])), plain[len(HEADER):]
    blocks, block = {}, None
    for line in rest:
        if re.fullmatch(r"[A-Z]{2}", line):
            block = []
            blocks.setdefault(line, []).append(block)
            continue
        found = BORE.match(line) if "BO" in blocks and block is blocks["BO"][-1] else POINT.match(line)
        if not found or block is None:
            raise AssertionError(f"no point: {line!r}")
        if found.re is BORE:
            block.append(tuple(float(found[k]) for k in (2, 4, 5, 6)))
            continue
        block.append((float(found[2]), float(found[4]), float(found[6] or 0)))
    return {"comments": comments, "header": {k: v.strip() for k, v in header.items()}, **blocks}


def rows_of(comments):
    """The B tables in the comments, each under the cut it follows."""
    out = {}
    cut = ""
    for line in comments:
        if line.startswith("cut "):
            cut = line[4:]
        elif line.startswith("B "):
            out.setdefault(cut, []).append(list(map(float, line.split()[1:])))
    return out


class Dstv(FormatTest):
    def file(self, body):
        return parse(self.service.text("bevel-tables", body, "format=nc1").decode("ascii"))

    def test_contour_lengths_and_table(self):
        for name, body in examples("bevel-tables").items():
            if "target" not in body or "dihedral" in body:  # as published: for comparison only
                continue
            with self.subTest(name):
                body = {**body, "target": {**body["target"], "length_mm": 5000}}
                table, file = self.service.answer("bevel-tables", body)["result"]["points"], self.file(body)
                radius = body["target"]["outer_diameter_mm"] / 2
                low = min(table["z_inner_mm"] + table["z_outer_mm"])
                header = file["header"]
                self.assertEqual(header["code"], "RO")
                self.assertAlmostEqual(float(header["height"]), 2 * radius, delta=1e-3)
                self.assertAlmostEqual(float(header["web"]), body["target"]["wall_mm"], delta=1e-3)
                over_all, saw = map(float, header["length"].split(","))
                self.assertAlmostEqual(over_all, 5000 - low, delta=2e-3)
                torch = min(table["torch_inner_mm"] + table["torch_outer_mm"])
                self.assertAlmostEqual(saw, 5000 - min(low, torch), delta=2e-3)
                [contour] = file["AK"]
                self.assertEqual(contour[0][:2], contour[-1][:2])
                wanted = [(z - low, radius * math.radians(360 - p)) for p, z in seam_row(table["phi_deg"], table["z_outer_mm"])]
                self.assertEqual(len(contour), len(wanted) + 3)
                for got, want in zip(contour, wanted):
                    self.assertLess(math.dist(got[:2], want), 2e-3)
                rows = rows_of(file["comments"])[""]
                self.assertEqual(len(rows), len(table["phi_deg"]))
                for row, phi, b in zip(rows, table["phi_deg"], table["b_deg"]):
                    self.assertAlmostEqual(row[0], phi, delta=2e-6)
                    self.assertAlmostEqual(row[5], b, delta=2e-4)

    def test_a_constant_bevel_stands_at_every_point_of_the_cut(self):
        body = {"target": {"outer_diameter_mm": 114.3, "wall_mm": 6.3, "length_mm": 1000},
                "cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 0, 1]}], "sampling": {"uniform_points": 36},
                "root_surface": "inner", "groove": {"rule": "fixed", "angle_deg": 30}, "kerf_mm": 2, "smoothing": {"method": "none"}}
        file = self.file(body)
        self.assertEqual([b for _, _, b in file["AK"][0]], [30.0] * 37 + [0.0] * 3)
        self.assertFalse([c for c in file["comments"] if "sidecar" in c])
        over_all, saw = map(float, file["header"]["length"].split(","))
        self.assertAlmostEqual(over_all, 1000.0, delta=1e-3)
        self.assertAlmostEqual(saw - over_all, 1.0 / math.cos(math.radians(30)), delta=2e-3)  # half the kerf, along the axis

    def test_a_varying_bevel_names_its_sidecar(self):
        file = self.file(examples("bevel-tables")["source-000-table-1"])
        self.assertTrue(any(re.search(r"sidecar [0-9a-f]{16}\.csv", c) for c in file["comments"]))
        self.assertTrue(any("far end is assumed" in c for c in file["comments"]))

    def test_open_text_stays_in_its_line(self):
        file = self.file({**examples("bevel-tables")["source-000-table-1"], "reference": HOSTILE})
        self.assertEqual(set(file) - {"comments", "header"}, {"AK"})


class WholePart(FormatTest):
    def test_outside_openings_lengths_and_tables(self):
        openings = 0
        for name, body in examples("parts").items():
            with self.subTest(name):
                body = {**body, "reference": HOSTILE}
                result = self.service.answer("parts", body)["result"]
                file = parse(self.service.text("parts", body, "format=nc1").decode("ascii"))
                start, finish = result["ends"]["start"]["points"], result["ends"]["finish"]["points"]
                header = file["header"]
                radius = float(header["height"]) / 2
                over_all, saw = map(float, header["length"].split(","))
                self.assertAlmostEqual(over_all, result["lengths"]["long_mm"], delta=1e-3)
                torch = [z for p in (start, finish) for c in ("torch_inner_mm", "torch_outer_mm") for z in p[c]]
                self.assertAlmostEqual(saw, max(over_all, *torch) - min(0, *torch), delta=2e-3)
                [outside] = file["AK"]
                lower, upper = (seam_row(p["phi_deg"], p["z_outer_mm"]) for p in (start, finish))
                wanted = [(z, radius * math.radians(360 - phi)) for phi, z in lower + upper[::-1] + lower[:1]]
                self.assertEqual(len(outside), len(wanted))
                for got, want in zip(outside, wanted):
                    self.assertLess(math.dist(got[:2], want), 2e-3)
                for got, p in zip(file.get("IK", []), self.outlines(body, result), strict=True):
                    wanted = [(z, radius * math.radians(360 - phi)) for phi, z in zip(p["phi_deg"], p["z_mm"])]
                    for a, b in zip(got, wanted + wanted[:1], strict=True):
                        self.assertLess(math.dist(a[:2], b), 2e-3)
                    openings += 1
                for [(x, y, diameter, depth)], (_, z, phi, asked) in zip(file.get("BO", []), self.bores(body, result), strict=True):
                    self.assertAlmostEqual(x, z, delta=2e-3)
                    off = (y - radius * math.radians(360 - phi)) / (2 * math.pi * radius)
                    self.assertAlmostEqual(off, round(off), delta=2e-3 / radius)
                    self.assertEqual((diameter, depth), (asked, 0))
                self.assertIn("AK: the tube itself, kept within; IK: an opening of it, kept outside", file["comments"])
                near = [one["id"] for group, one in cutouts(result) if group["side"] == "near"]
                self.assertEqual(len([c for c in file["comments"] if c.startswith("shape: ")]), len(near), "the near side of each states its shape")
                tables = rows_of(file["comments"])
                self.assertEqual(set(tables), {"start", "finish"} | {f"hole {i}" for i in range(len(result["holes"]))})
                for cut, rows in tables.items():
                    p = result["holes"][int(cut[5:])]["points"] if cut.startswith("hole") else result["ends"][cut]["points"]
                    for row, phi, b in zip(rows, p["phi_deg"], p["b_deg"], strict=True):
                        self.assertAlmostEqual(row[0], phi, delta=2e-6)
                        self.assertAlmostEqual(row[5], b, delta=2e-4)
        self.assertGreater(openings, 0)

    def test_seen_from_outside_it_is_the_part_in_space(self):
        """Face v is what the tool sees: rolled round the tube, print side out, it lies on the curves in space; mirrored it does not."""
        body = examples("parts")["chord-with-holes"]
        file = parse(self.service.text("parts", body, "format=nc1").decode("ascii"))
        drawing = read(self.service.text("parts", body, "format=dxf&view=tube"))
        curves = [points for points, _ in polylines(drawing, "CUT_OUTER")][2:]
        radius = float(file["header"]["height"]) / 2
        result = self.service.answer("parts", body)["result"]
        in_file = [step["index"] for step in result["sequence"] if step["what"] == "hole"]
        self.assertGreater(len(curves), 1)
        for contour, index in zip(file["IK"], in_file, strict=True):
            points = [(x, y) for x, y, _ in contour]
            self.assertLess(off_curve(rolled(points, radius), curves[index]), 0.02)
        self.assertGreater(max(off_curve(rolled([(x, -y) for x, y, _ in contour], radius), curves[index])
                               for contour, index in zip(file["IK"], in_file)), 5)

    def test_a_part_without_a_reference_is_named_after_its_member(self):
        body = examples("parts")["k-joint-brace"]
        member = {key: value for key, value in body.items() if key != "reference"}
        hostile = json.loads(json.dumps(member).replace('"B2"', json.dumps("Tr\u00e4ger\"*/ EN")))
        named = member | {"reference": {"part": "P-7"}}
        for asked, piece in ((member, "B2"), (hostile, "Traeger__/ EN"), (named, "P-7")):
            file = parse(self.service.text("parts", asked, "format=nc1").decode("ascii"))
            self.assertEqual(file["header"]["piece"], piece)

    def outlines(self, body, result):
        """The points of every opening that is no bore, in the order of the file."""
        bores = list(self.bores(body, result))
        for step in result["sequence"]:
            if step["what"] == "hole":
                yield result["holes"][step["index"]]["points"]
            elif step["what"] == "cutout" and step["index"] not in [index for index, *_ in bores]:
                yield cutout_points(result, step["index"])

    def bores(self, body, result):
        """(index, z, phi, diameter) of every circle that a straight drill makes, in the order of the file."""
        size = {one["id"]: one["shape"].get("diameter_mm") for one in body.get("cutouts", [])}
        for step in result["sequence"]:
            if step["what"] == "cutout":
                group, one = cutouts(result)[step["index"]]
                if size[group["id"]] and group["wall"] != "developed":
                    p = cutout_points(result, step["index"])
                    middle = (min(p["phi_deg"]) + max(p["phi_deg"])) / 2
                    yield step["index"], one["z_mm"], middle, size[group["id"]]

    def test_each_end_carries_its_own_constant_bevel(self):
        plane = {"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 0, 1]}
        start, finish = ({"cutters": [plane], "root_surface": "inner", "groove": {"rule": "fixed", "angle_deg": angle},
                          "smoothing": {"method": "none"}} for angle in (30, 20))
        body = {"target": {"outer_diameter_mm": 114.3, "wall_mm": 6.3, "length_mm": 1000}, "density_kg_m3": 2700,
                "ends": {"start": start, "finish": finish}, "datum": "seam", "seam_deg": 0, "sampling": {"uniform_points": 36}, "kerf_mm": 2}
        result = self.service.answer("parts", body)["result"]
        told = {end: set(result["ends"][end]["points"]["b_deg"]) for end in ("start", "finish")}
        file = parse(self.service.text("parts", body, "format=nc1").decode("ascii"))
        [outside] = file["AK"]
        n = len(result["ends"]["start"]["points"]["b_deg"]) + 1
        for end, rows in (("start", outside[:n - 1]), ("finish", outside[n:-2])):
            [b] = told[end]
            self.assertEqual({bevel for _, _, bevel in rows}, {round(b, 3)}, end)
            self.assertNotEqual(b, 0)
        self.assertNotEqual(told["start"], told["finish"])
        self.assertFalse([c for c in file["comments"] if "sidecar" in c])
        metre = math.pi / 4 * (114.3**2 - 101.7**2) * 1e-6 * 2700
        self.assertAlmostEqual(float(file["header"]["weight"]), metre, delta=1e-3)


if __name__ == "__main__":
    main()
