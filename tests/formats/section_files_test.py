"""The files of tubes that are not round: DXF read by ezdxf, STL by admesh, templates at their size. Sizes, planes and tubes are drawn; every number
that a file is held to is computed here, from the section's own lengths."""

import io
import json
import math
import random
import re
import xml.etree.ElementTree as xml
import zipfile

import step_reader
import step_volume
from dstv_test import parse, rows_of
from dxf_test import length, polylines, read
from service import ROOT, FormatTest, drawing_seed, main
from stl_test import admesh, area, facets

SVG = "{http://www.w3.org/2000/svg}"
STANDARDS = {"en_10210": (1.5, 1.0), "en_10219": (2.0, 1.0), "astm_a500": (2.0, 1.0)}  # of walls up to 6 mm


def drawn_section(rng):
    wall = rng.choice([2, 3, 4, 5, 6])
    height, width = (rng.randrange(10 * wall, 160, 5) for _ in range(2))
    if rng.random() < 0.25 and height != width:
        corner = min(height, width) / 2
        return {"kind": "flat_oval_tube", "height_mm": height, "width_mm": width, "wall_mm": wall}, (height, width, wall, corner, corner - wall)
    standard = rng.choice(list(STANDARDS))
    outer, inner = (wall * factor for factor in STANDARDS[standard])
    return {"kind": "rectangular_tube", "height_mm": height, "width_mm": width, "wall_mm": wall, "corners": standard}, (height, width, wall, outer, inner)


def girth(height, width, corner):
    return 2 * (height + width) - (8 - 2 * math.pi) * corner


def wall_area(height, width, wall, outer, inner):
    return height * width - (height - 2 * wall) * (width - 2 * wall) - (4 - math.pi) * (outer**2 - inner**2)


def off_outline(x, y, height, width, corner):
    """The distance of a place from the outline of a rectangle with round corners."""
    u, v = abs(x) - height / 2 + corner, abs(y) - width / 2 + corner
    return math.hypot(max(u, 0), max(v, 0)) + min(max(u, v), 0) - corner


def cut_by_plane(rng):
    """A request whose cut is flush with a plane all round, the plane's height at the axis and its slopes."""
    target, lengths = drawn_section(rng)
    slopes = [rng.uniform(-0.6, 0.6) for _ in range(2)]
    height = rng.uniform(40, 90)
    return {"target": target, "root_surface": "inner", "contact": "inner", "groove": {"rule": "fixed", "angle_deg": 0}, "kerf_mm": 0,
            "sampling": {"uniform_points": 60, "tolerance_mm": 0.01}, "smoothing": {"method": "none"}, "torch": {"min_deg": -70, "max_deg": 70},
            "cutters": [{"kind": "plane", "id": "wall plate", "point_mm": [0, 0, height], "normal": [*slopes, 1]}]}, lengths, (height, *slopes)


def cut_by_tube(rng):
    target, lengths = drawn_section(rng)
    diameter = 1.5 * math.hypot(lengths[0], lengths[1])
    return {"target": target, "root_surface": "inner", "groove": {"rule": "half_dihedral"}, "kerf_mm": 2, "smoothing": {"method": "none"},
            "cutters": [{"kind": "tube", "id": "chord", "outer_diameter_mm": round(diameter, 1), "inclination_deg": rng.uniform(60, 120),
                         "clocking_deg": rng.uniform(0, 360), "offset_mm": rng.uniform(-5, 5)}], "torch": {"min_deg": -80, "max_deg": 80}}, lengths


class SectionFiles(FormatTest):
    def setUp(self):
        self.rng = random.Random(drawing_seed())

    def test_solids_have_the_volume_over_a_plane(self):
        """Over a plane, a symmetric wall has its area times the height at the axis; facets take up to 0.01 mm of their own area."""
        for n in range(20):
            body, lengths, (height, *_) = cut_by_plane(self.rng)
            with self.subTest(n, target=body["target"]):
                content = self.service.text("bevel-tables", body, "format=stl")
                counts, parts, got = admesh(content)
                self.assertEqual({k: v for k, v in counts.items() if v}, {})
                self.assertEqual(parts, 1)
                far = max(p[2] for f in facets(content) for p in f)
                wanted = wall_area(*lengths) * (far - height)
                self.assertLess(abs(got - wanted), 0.012 * area(content))

    def test_solids_of_other_cuts_are_closed(self):
        for n in range(10):
            body, _ = cut_by_tube(self.rng)
            with self.subTest(n, target=body["target"]):
                for view in ("after", "before"):
                    counts, parts, _ = admesh(self.service.text("bevel-tables", body, f"format=stl&view={view}"))
                    self.assertEqual(({k: v for k, v in counts.items() if v}, parts), ({}, 1))

    def test_dxf_lies_flat_on_each_surface(self):
        for n in range(10):
            body, (height, width, wall, outer, inner) = cut_by_tube(self.rng)
            with self.subTest(n, target=body["target"]):
                table = self.service.answer("bevel-tables", body)["result"]["points"]
                drawing = read(self.service.text("bevel-tables", body, "format=dxf"))
                self.assertEqual(drawing.audit().errors, [])
                across = {"CUT_OUTER": girth(height, width, outer), "CUT_INNER": girth(height - 2 * wall, width - 2 * wall, inner)}
                for layer, column in (("CUT_OUTER", "z_outer_mm"), ("CUT_INNER", "z_inner_mm")):
                    [(points, closed)] = polylines(drawing, layer)
                    self.assertFalse(closed)
                    xs = [x for x, _ in points]
                    self.assertEqual(xs, sorted(xs))
                    self.assertAlmostEqual(xs[0], 0, delta=1e-6)
                    self.assertAlmostEqual(xs[-1], across[layer], delta=1e-5)
                    self.assertAlmostEqual(points[0][1], points[-1][1], delta=1e-6)
                    heights = [z for _, z in points]
                    self.assertTrue(all(min(abs(z - one) for one in heights) < 1e-5 for z in table[column]), "a row is not in the drawing")
                corner, half = math.pi / 2 * outer, width / 2 - outer  # half: of face 1's flat
                starts = (half, half + corner, half + corner + height - 2 * outer, half + 2 * corner + height - 2 * outer)
                faces = [points[0][0] for points, _ in polylines(drawing, "FACE")]
                if body["target"]["kind"] == "rectangular_tube":
                    self.assertTrue(all(min(abs(s - one) for one in faces) < 1e-4 for s in starts), f"{starts} are not at {faces}")

    def test_dxf_in_space_lies_on_the_tube_and_on_the_plane(self):
        for n in range(10):
            body, (height, width, wall, outer, inner), (z_0, a, b) = cut_by_plane(self.rng)
            with self.subTest(n, target=body["target"]):
                drawing = read(self.service.text("bevel-tables", body, "format=dxf&view=tube"))
                for layer, lengths in (("CUT_OUTER", (height, width, outer)), ("CUT_INNER", (height - 2 * wall, width - 2 * wall, inner))):
                    [(points, closed)] = polylines(drawing, layer)
                    self.assertTrue(closed)
                    for x, y, z in points:
                        self.assertLess(abs(off_outline(x, y, *lengths)), 1e-5)
                        self.assertLess(abs(z - (z_0 - a * x - b * y)), 0.02)  # rows stand within 0.01 mm of the curve
                    for (x, y, _), (u, v, _) in zip(points, points[1:] + points[:1]):
                        self.assertLess(abs(off_outline((x + u) / 2, (y + v) / 2, *lengths)), 0.011)

    def test_templates_have_the_girth_and_name_what_they_show(self):
        for n in range(10):
            body, (height, width, wall, outer, _) = cut_by_tube(self.rng)
            with self.subTest(n, target=body["target"]):
                for mirror in ("false", "true"):
                    root = xml.fromstring(self.service.text("bevel-tables", body, f"format=svg&view=template&mirror={mirror}"))
                    at = {e.get("id"): float(e.get("x1")) for e in root.iter(f"{SVG}line") if e.get("id") in ("seam-0", "seam-360")}
                    self.assertAlmostEqual(abs(at["seam-360"] - at["seam-0"]), girth(height, width, outer), delta=0.02)
                    texts = " | ".join("".join(e.itertext()) for e in root.iter(f"{SVG}text"))
                    for word in ("KEEP", "SCRAP", "chord", "girth, mm", f"{height} x {width} x {wall} mm"):
                        self.assertIn(word, texts)
                pages = self.service.text("bevel-tables", body, "format=pdf&view=template&paper=a4")
                self.assertEqual(pages[:5], b"%PDF-")
                self.service.text("intersections", {k: body[k] for k in ("target", "cutters")}, "format=pdf&view=template&paper=letter")

    def test_curves_are_printed_as_tables_are(self):
        body, _ = cut_by_tube(self.rng)
        curves = {"target": body["target"], "cutters": body["cutters"]}
        drawing = read(self.service.text("intersections", curves, "format=dxf"))
        for p in self.service.answer("intersections", curves)["result"]["profiles"]:
            [(points, _)] = polylines(drawing, "CUT_OUTER" if p["surface"] == "outer" else "CUT_INNER")
            s, z = p["points"]["girth_mm"], p["points"]["z_mm"]
            here = [*zip(s, z), (points[-1][0], z[0])]
            self.assertAlmostEqual(length(points, False), length(here, False), delta=1e-4)
        for chart in (self.service.text("intersections", curves, "format=svg"), self.service.text("bevel-tables", body, "format=svg")):
            self.assertTrue(re.search(rb"corner 1", chart))

    def test_everyday_cuts_are_in_every_file(self):
        """Sizes by name, in inches and with three decimals, a bore with sharp corners, an oval; a square cut of a laser, a land, a partner that is
        lost in a jump; one surface alone."""
        tube = {"kind": "tube", "id": "chord", "outer_diameter_mm": 168.3, "inclination_deg": 62.5, "clocking_deg": 30, "offset_mm": 3.125}
        small = {"kind": "tube", "id": "pin", "outer_diameter_mm": 30, "inclination_deg": 90, "clocking_deg": 90, "offset_mm": 12, "height_mm": 95}
        targets = {"name": {"size": "SHS 80x80x4 EN 10219"}, "hot": {"size": "RHS 100x50x4 EN 10210"},
                   "inch": {"kind": "rectangular_tube", "height_mm": 50.8, "width_mm": 76.2, "wall_mm": 4.78, "corners": "astm_a500"},
                   "decimals": {"kind": "rectangular_tube", "height_mm": 60.125, "width_mm": 40.375, "wall_mm": 2.951, "corner_radius_mm": 6.203},
                   "sharp bore": {"kind": "rectangular_tube", "height_mm": 60, "width_mm": 40, "wall_mm": 3, "corner_radius_mm": 3.2},
                   "oval": {"kind": "flat_oval_tube", "height_mm": 40, "width_mm": 90, "wall_mm": 3}}
        table = {"root_surface": "inner", "groove": {"rule": "half_dihedral"}, "kerf_mm": 1.2, "smoothing": {"method": "none"},
                 "torch": {"min_deg": -80, "max_deg": 80}}
        cuts = {"bevel": table, "land": table | {"root_face_mm": 1, "kerf_mm": 0}, "laser": {"preset": "tube_laser", "kerf_mm": 0},
                "jump": table | {"kerf_mm": 0, "contact": "none"}}
        jumps = 0
        for name, target in targets.items():
            for cut, options in cuts.items():
                with self.subTest(name, cut=cut):
                    cutters = [tube, small] if cut == "jump" else [tube]
                    body = {"target": target, "cutters": cutters} | options
                    answer = self.service.answer("bevel-tables", body)
                    jumps += any(event["kind"] == "jump" for event in answer["result"]["events"])
                    counts, parts, volume = admesh(self.service.text("bevel-tables", body, "format=stl"))
                    self.assertEqual(({k: v for k, v in counts.items() if v}, parts, volume > 0), ({}, 1, True))
                    outside = answer["result"]["section"]["girth_mm"]
                    for view in ("template", "tube"):
                        drawing = read(self.service.text("bevel-tables", body, f"format=dxf&view={view}"))
                        self.assertEqual(drawing.audit().errors, [])
                    root = xml.fromstring(self.service.text("bevel-tables", body, "format=svg&view=template"))
                    at = {e.get("id"): float(e.get("x1")) for e in root.iter(f"{SVG}line") if e.get("id") in ("seam-0", "seam-360")}
                    self.assertAlmostEqual(at["seam-360"] - at["seam-0"], outside, delta=0.02)
            for surfaces in ("inner", "outer", "both"):
                curves = {"target": target, "cutters": [tube], "surfaces": surfaces}
                for query in ("format=svg", "format=svg&view=template", "format=pdf&paper=a4", "format=dxf", "format=dxf&view=tube", "format=csv"):
                    self.service.text("intersections", curves, query)
        self.assertGreater(jumps, 0, "no partner is lost in a jump")

    def drawn_part(self):
        """A part flush with a plane at either end, its lengths, and the height of each plane over a place, in the part's frame."""
        start, lengths, (z_0, a, b) = cut_by_plane(self.rng)
        finish = cut_by_plane(self.rng)[0] | {"cutters": [{"kind": "plane", "point_mm": [0, 0, 50], "normal": [0.4, -0.3, 1]}]}
        end = ("cutters", "root_surface", "contact", "groove", "smoothing")
        body = {"target": start["target"] | {"length_mm": 800, "id": "rail <1>"}, "kerf_mm": 0, "sampling": {"tolerance_mm": 0.01},
                "torch": start["torch"], "ends": {name: {k: one[k] for k in end} for name, one in (("start", start), ("finish", finish))}}
        answer = self.service.answer("parts", body)["result"]
        long_point = answer["frame"]["origin_mm"][2]
        return body, lengths, answer, (lambda x, y: z_0 - a * x - b * y - long_point, lambda x, y: 800 - 50 + 0.4 * x + 0.3 * y - long_point)

    def test_parts_have_the_metal_between_their_planes(self):
        for n in range(10):
            body, lengths, answer, (start, finish) = self.drawn_part()
            with self.subTest(n, target=body["target"]):
                volume = wall_area(*lengths) * (finish(0, 0) - start(0, 0))
                self.assertAlmostEqual(answer["lengths"]["volume_mm3"] / volume, 1, delta=1e-4)
                self.assertAlmostEqual(answer["lengths"]["mass_kg"], volume * 7.85e-6, delta=1e-3)
                height, width = lengths[0] / 2, lengths[1] / 2
                for got, (x, y) in zip(answer["side_lengths"]["face_mm"], ((height, 0), (0, width), (-height, 0), (0, -width))):
                    self.assertAlmostEqual(got, finish(x, y) - start(x, y), delta=0.05)

    def test_step_is_one_solid_with_the_answers_volume(self):
        """Drawn parts by planes and tubes, with and without a land, rows by tolerance and on a bare grid."""
        holes = 0
        for number in range(5):
            with self.subTest(number):
                body = self.drawn_step_part()
                answer = self.service.answer("parts", body)
                solid = step_reader.Solid(step_reader.File(self.service.text("parts", body, "format=step").decode("ascii")))
                openings = sum(len(group["instances"]) for group in answer["result"].get("cutouts", []))
                self.assertEqual(step_reader.faults(solid, 1 + openings), [])
                wanted = answer["result"]["lengths"]["volume_mm3"]
                self.assertAlmostEqual(step_volume.volume(solid) / wanted, 1, delta=2e-6)
                names = {face["name"] for face in solid.faces}
                self.assertEqual({name for name in names if not name.startswith("cut-out ")}, {"outside", "bore", "start", "finish"})
                holes += openings
        self.assertGreater(holes, 10)

    def test_step_of_cut_outs_over_corners_is_one_solid_and_nc1_is_refused(self):
        """A hole in a corner, a window laid over two faces and a slot whose torch leans."""
        solids = 0
        for number in range(12):
            target, (_, width, wall, corner, _) = drawn_section(self.rng)
            middle = width / 2 - corner + corner * math.pi / 4
            cutouts = [{"id": "vent", "shape": {"kind": "circle", "diameter_mm": 2 * wall + 4}, "at": {"z_mm": 100, "girth_mm": middle}, "wall": "through", "tilt": "free"},
                       {"id": "window", "shape": {"kind": "rectangle", "along_mm": 30, "round_mm": 2 * corner + 10, "corner_radius_mm": 2},
                        "at": {"z_mm": 200, "girth_mm": middle + self.rng.uniform(-4, 4)}, "wall": "developed"},
                       {"id": "slot", "shape": {"kind": "slot", "length_mm": 30, "width_mm": 8, "angle_deg": self.rng.uniform(0, 30)},
                        "at": {"z_mm": 300, "girth_mm": middle + 1}, "tilt": "free"}]
            body = {"target": {**target, "length_mm": 400}, "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                    "cutouts": cutouts, "kerf_mm": 0.2}
            status, _, content = self.service.ask("parts", body)
            if status == 422:  # a bore too narrow for one of them
                continue
            answer = json.loads(content)
            with self.subTest(number, target=target):
                solid = step_reader.Solid(step_reader.File(self.service.text("parts", body, "format=step").decode("ascii")))
                self.assertEqual(step_reader.faults(solid, 1 + 4), [])
                self.assertAlmostEqual(step_volume.volume(solid) / answer["result"]["lengths"]["volume_mm3"], 1, delta=2e-5)
                status, _, content = self.service.ask("parts", body, "format=nc1")
                self.assertEqual(status, 422)
                self.assertIn(b"goes over a corner", content)
                solids += 1
        self.assertGreater(solids, 3)

    def test_step_of_holes_of_branches_over_corners_is_one_solid(self):
        """A branch as wide as the tube set on it, one that leans set in, one that passes through askew; the last also in a round tube."""
        solids = 0
        for number in range(6):
            target, (height, width, wall, _, _) = drawn_section(self.rng)
            bore = width - 2 * wall
            lean = [1, self.rng.uniform(-0.1, 0.1), self.rng.uniform(-1, 1)]

            def hole(name, size, z_mm, direction, joint):
                kind = {} if "outer_diameter_mm" in size else {"kind": "rectangular_tube", "corners": "en_10219", "up": [0, 1, 0.2]}
                return {"branch": {"id": name, **kind, **size, "wall_mm": 2, "axis": {"point_mm": [0, 0, z_mm], "direction": direction}}, "joint": joint}

            holes = [hole("post", {"outer_diameter_mm": width}, 200, [1, 0, 0], {"kind": "set_on"}),
                     hole("brace", {"height_mm": 0.9 * bore, "width_mm": 0.8 * bore}, 500, lean, {"kind": "set_in", "gap_mm": 0.3}),
                     hole("stay", {"outer_diameter_mm": 0.8 * bore}, 900, lean, {"kind": "through", "gap_mm": 0.2})]
            if number == 0:
                diameter = max(height, width)
                target, holes = {"outer_diameter_mm": diameter, "wall_mm": 3}, [
                    hole("brace", {"height_mm": 0.5 * diameter, "width_mm": 0.4 * diameter}, 500, lean, {"kind": "through", "gap_mm": 0.3})]
            body = {"preset": "tube_laser", "target": {**target, "length_mm": 1100}, "holes": holes, "kerf_mm": 0.2,
                    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "sampling": {"tolerance_mm": 0.1}}
            status, _, content = self.service.ask("parts", body)
            if status == 422:  # the branch reaches the tube's side, or its corner is too tight next to the tube's
                self.assertNotEqual(number, 0, content)
                self.assertTrue(b"open_profile" in content or b"a hollow tighter than the kerf" in content, content)
                continue
            answer = json.loads(content)
            with self.subTest(number, target=target):
                solid = step_reader.Solid(step_reader.File(self.service.text("parts", body, "format=step").decode("ascii")))
                self.assertEqual(step_reader.faults(solid, 1 + len(answer["result"]["cutouts"])), [])
                self.assertAlmostEqual(step_volume.volume(solid) / answer["result"]["lengths"]["volume_mm3"], 1, delta=2e-5)
                over = [one["id"] for one in answer["result"]["cutouts"] if one["wall"] == "developed"]
                if number:
                    status, _, content = self.service.ask("parts", body, "format=nc1")
                    self.assertEqual((status, b"goes over a corner" in content), (422, True) if over else (200, False))
                solids += 1
        self.assertGreater(solids, 2)

    def drawn_step_part(self):
        rng = self.rng
        target, lengths = drawn_section(rng)
        target["length_mm"] = 900

        def end():
            if rng.random() < 0.2:
                return {"square_at_mm": 5}
            across = [math.cos(turn := rng.uniform(0, 6.3)), math.sin(turn), rng.uniform(-0.4, 0.4)]
            chord = {"kind": "tube", "outer_diameter_mm": 1.5 * math.hypot(*lengths[:2]), "axis": {"point_mm": [0, 0, 0], "direction": across}}
            stub = {"kind": "tube", "outer_diameter_mm": 0.5 * min(lengths[:2]), "axis": {"point_mm": [0, 0, 40], "direction": across}}
            plane = {"kind": "plane", "point_mm": [0, 0, 0], "normal": [rng.uniform(-1, 1), rng.uniform(-1, 1), 1]}
            cut = rng.choice([{"groove": {"rule": "square"}, "contact": "auto"}, {"groove": {"rule": "none"}, "contact": "none"},
                              {"groove": {"rule": "fixed", "angle_deg": 30}, "contact": "inner", "root_face_mm": 0.4 * lengths[2]}])
            if rng.random() < 0.3 and "root_face_mm" not in cut:
                return {"cutters": [plane, stub], "root_surface": "inner", "smoothing": {"method": "none"}, **cut}
            return {"cutters": [rng.choice([chord, plane])], "root_surface": "inner", "smoothing": {"method": "none"}, **cut}
        sampling = rng.choice([{"tolerance_mm": 0.02}, {"uniform_points": 72}])
        return {"cutouts": self.drawn_cutouts(lengths), "target": target, "ends": {"start": end(), "finish": end()}, "kerf_mm": 0,
                "torch": {"min_deg": -85, "max_deg": 85}, "sampling": sampling}

    def drawn_cutouts(self, lengths):
        """One of each kind on faces with room for it, 80 mm apart in the middle of a tube 900 mm long."""
        rng = self.rng
        height, width, wall, corner, _ = lengths
        half = {face: (width if face % 2 else height) / 2 - max(corner, 2 * wall) for face in (1, 2, 3, 4)}
        face = max(half, key=half.get)
        room = half[face]
        if room < 6:
            return []
        size = min(room, 12)
        drawing = {"kind": "contour", "start_mm": [-size, -0.4 * size], "corners": "as_cut",
                   "pieces": [{"kind": "line", "to_mm": [size, -0.4 * size]}, {"kind": "line", "to_mm": [size, 0]},
                              {"kind": "arc", "to_mm": [0, 0], "centre_mm": [size / 2, 0], "sense": "ccw"},
                              {"kind": "line", "to_mm": [-size, 0]},
                              {"kind": "line", "to_mm": [-size, -0.4 * size]}]}
        shapes = [{"kind": "circle", "diameter_mm": size},
                  {"kind": "slot", "length_mm": 1.4 * size, "width_mm": 0.5 * size, "angle_deg": rng.uniform(0, 360)},
                  {"kind": "rectangle", "along_mm": size, "round_mm": 0.8 * size, "corner_radius_mm": 0.1 * size, "angle_deg": rng.uniform(0, 360)},
                  drawing]
        return [{"id": f"c{i}", "shape": shape, "wall": rng.choice(["normal", "through"]),
                 "at": {"z_mm": 320 + 80 * i, "face": rng.choice([face, (face + 1) % 4 + 1]), "offset_mm": rng.uniform(-1, 1) * (room - size)}}
                for i, shape in enumerate(shapes)]

    def test_nc1_and_dxf_have_each_cut_out_on_its_face(self):
        """A bore has its circle's place and diameter; another's outline is kept outside and has its area, length by length that of the shape."""
        seen = 0
        for number in range(6):
            body = self.drawn_step_part()
            if not body["cutouts"]:
                continue
            seen += 1
            with self.subTest(number, target=body["target"]):
                result = self.service.answer("parts", body)["result"]
                file = parse(self.service.text("parts", body, "format=nc1").decode("ascii"))
                section = result["section"]
                height, width = section["height_mm"], section["width_mm"]
                groups = {(group["id"], one["face"]): group for group in result["cutouts"] for one in group["instances"]}
                order = [step["index"] for step in result["sequence"] if step["what"] == "cutout"]
                flat = [(group["id"], one) for group in result["cutouts"] for one in group["instances"]]
                bores, contours = iter(file["BO"]), iter(file["IK"])
                for index in order:
                    name, one = flat[index]
                    # y counts along x of the section on faces 2 and 4, along y on 1 and 3; s grows along +y, -x, -y, +x.
                    sign = {1: 1, 2: -1, 3: -1, 4: 1}[one["face"]]
                    middle = (width if one["face"] % 2 else height) / 2
                    if name == "c0":
                        [(x, y, diameter, depth)] = next(bores)
                        shape = body["cutouts"][0]["shape"]
                        self.assertEqual(depth, 0)
                        self.assertAlmostEqual(diameter, shape["diameter_mm"], delta=6e-4)
                        self.assertAlmostEqual(x, one["z_mm"], delta=6e-4)
                        self.assertAlmostEqual(y, middle + sign * one["offset_mm"], delta=6e-4)
                        continue
                    points = next(contours)
                    twice = sum(x * v - u * y for (x, y, _), (u, v, _) in zip(points, points[1:]))
                    self.assertEqual(twice > 0, one["face"] in (1, 4), "the outline runs as that of its face")
                    area = groups[name, one["face"]]["area_outer_mm2"]
                    self.assertAlmostEqual(abs(twice) / 2 / area, 1, delta=0.02)
                drawing = read(self.service.text("parts", body, "format=dxf"))
                self.assertEqual(drawing.audit().errors, [])
                closed = [points for points, is_closed in polylines(drawing, "CUT_OUTER") if is_closed]
                self.assertEqual(len(closed), len(flat))
                for points, (name, one) in zip(closed, self.in_order(result)):
                    xs, zs = zip(*points)
                    self.assertAlmostEqual(min(xs), one["girth_from_mm"], delta=1e-5)
                    self.assertAlmostEqual(max(zs), one["z_to_mm"], delta=1e-5)
                space = read(self.service.text("parts", body, "format=dxf&view=tube"))
                lengths = (height, width, section["corner_radius_mm"])
                for points, _ in polylines(space, "CUT_OUTER"):
                    self.assertTrue(all(abs(off_outline(x, y, *lengths)) < 1e-4 for x, y, _ in points))
        self.assertGreater(seen, 2)

    @staticmethod
    def in_order(result):
        """Instances as they are drawn: request by request, the far side after each near one."""
        ids = sorted({group["id"] for group in result["cutouts"]})
        sides = {(group["id"], group["side"]): group["instances"] for group in result["cutouts"]}
        return [(name, one) for name in ids for side in ("near", "far") for one in sides.get((name, side), [])]

    def test_nc1_has_each_face_on_the_sharp_rectangle(self):
        """Each point of a face's outline lies on the outside of the tube, seen square to that face, and on the plane of its end."""
        for n in range(10):
            body, (height, width, wall, corner, _), _, planes = self.drawn_part()
            with self.subTest(n, target=body["target"]):
                text = self.service.text("parts", body, "format=nc1").decode("ascii")
                file = parse(text)
                header = file["header"]
                self.assertEqual((header["code"], float(header["height"]), float(header["flange_width"])), ("M", height, width))
                self.assertAlmostEqual(float(header["radius"]), corner, delta=1e-3)
                self.assertEqual(re.findall(r"^  ([vouh]) ", text, re.M), ["v", "o", "u", "h"])
                for face, points in zip("vouh", file["AK"]):
                    across, other = (height, width) if face in "vh" else (width, height)
                    self.assertEqual(points[0][:2], points[-1][:2])
                    ys = [y for _, y, _ in points]
                    self.assertAlmostEqual(min(ys), 0, delta=1e-3)
                    self.assertAlmostEqual(max(ys), across, delta=1e-3)
                    twice = sum(x * v - u * y for (x, y, _), (u, v, _) in zip(points, points[1:]))
                    self.assertEqual(twice > 0, face in "vu", "the outline runs the wrong way")
                    for x, y, _ in points:
                        beyond = max(abs(y - across / 2) - (across / 2 - corner), 0)
                        deep = other / 2 - corner + math.sqrt(max(corner**2 - beyond**2, 0))
                        place = {"v": (y - across / 2, deep), "h": (y - across / 2, -deep), "o": (deep, y - across / 2), "u": (-deep, y - across / 2)}[face]
                        self.assertLess(min(abs(x - plane(*place)) for plane in planes), 0.05)
                self.assertEqual(set(rows_of(file["comments"])), {"start", "finish"})

    def test_parts_are_in_every_file(self):
        for n in range(4):
            body, (height, width, wall, outer, _), answer, _ = self.drawn_part()
            with self.subTest(n, target=body["target"]):
                drawing = read(self.service.text("parts", body, "format=dxf"))
                self.assertEqual(drawing.audit().errors, [])
                curves = [points for points, _ in polylines(drawing, "CUT_OUTER")]
                self.assertEqual(len(curves), 2)
                for points in curves:
                    self.assertAlmostEqual(points[-1][0], girth(height, width, outer), delta=1e-5)
                self.assertEqual(read(self.service.text("parts", body, "format=dxf&view=tube")).audit().errors, [])
                for query in ("format=svg", "format=svg&view=template", "format=svg&view=template&mirror=true"):
                    sheet = xml.fromstring(self.service.text("parts", body, query))
                    texts = " | ".join("".join(e.itertext()) for e in sheet.iter(f"{SVG}text"))
                    self.assertIn("rail <1>", texts)
                order = xml.fromstring(self.service.text("parts", body, "format=svg"))
                texts = [" ".join(e.itertext()) for e in order.iter(f"{SVG}text")]
                for face, one in enumerate(answer["side_lengths"]["face_mm"], 1):
                    self.assertTrue(any(t.endswith(" mm") and abs(float(t[:-3]) - one) < 0.0051 for t in texts if re.fullmatch(r"[\d.]+ mm", t)), face)
                for query in ("format=pdf", "format=pdf&view=template&paper=a4"):
                    self.assertEqual(self.service.text("parts", body, query)[:5], b"%PDF-")
                rows = self.service.text("parts", body, "format=csv").decode().splitlines()
                wanted = sum(len(end["points"]["girth_mm"]) for end in answer["ends"].values())
                self.assertEqual(sum(row.startswith(("start,", "finish,")) for row in rows), wanted)

    def test_a_frames_packet_has_every_file_and_its_requests_give_its_parts(self):
        """The call that comes after: each part's own request in the packet is answered by the part that the packet names."""
        for name in ("rhs-gate", "shs-balcony-with-bolt-holes"):
            body = json.loads((ROOT / "examples/frames" / f"{name}.json").read_text())
            body.pop("reference", None)  # its quantity would multiply the pieces
            self.packet(body)

    def test_a_rail_wider_than_its_legs_is_the_same_part_in_the_call_that_comes_after(self):
        """Round, between square legs, turned in plan with three decimals, drawn from either end: files, and requests of their own."""
        turn = self.rng.uniform(0, 2 * math.pi)
        cos, sin = math.cos(turn), math.sin(turn)

        def at(x, z):
            return [round(cos * x, 3), round(sin * x, 3), z]
        lengths = []
        for ends in ((0, 1000), (1000, 0)):
            legs = [{"id": f"leg {x}", "start_mm": at(x, 0), "end_mm": at(x, 900), "up": [cos, sin, 0], "size": "SHS 40x40x3 EN 10219"} for x in (0, 1000)]
            rail = {"id": "rail", "start_mm": at(ends[0], 450), "end_mm": at(ends[1], 450), "outer_diameter_mm": 48.3, "wall_mm": 3.2}
            body = {"preset": "tube_laser", "kerf_mm": 0.3, "sampling": {"tolerance_mm": 0.05}, "members": [*legs, rail], "connect": {"within_mm": 5}}
            self.packet(body)
            cut_list = self.service.answer("frames", body)["result"]["cut_list"]
            lengths.append(next(row["blank_mm"] for row in cut_list if row["members"] == ["rail"]))
        self.assertAlmostEqual(lengths[0], lengths[1], delta=0.002)

    def packet(self, body):
        packet = zipfile.ZipFile(io.BytesIO(self.service.text("frames", body, "format=zip")))
        parts = json.loads(packet.read("manifest.json"))["parts"]
        self.assertEqual(sum(part["quantity"] for part in parts), len(body["members"]))
        for part in parts:
            with self.subTest(part["part"]):
                self.assertEqual(part["left_out"], [])
                self.assertEqual({f["format"] for f in part["files"]}, {"request", "work-order", "nc1", "dxf", "step", "csv"})
                request = json.loads(packet.read(next(f["name"] for f in part["files"] if f["format"] == "request")))
                self.assertEqual(self.service.answer("parts", request)["job"]["result_sha256"], part["result_sha256"])

    def test_what_shows_round_walls_is_refused_by_its_name(self):
        body, _ = cut_by_tube(self.rng)
        for query, name in (("format=svg&view=section", "view"), ("format=nc1", "format"), ("format=step", "format")):
            status, _, content = self.service.ask("bevel-tables", body, query)
            self.assertEqual((status, name in content.decode()), (422, True), content)

    def test_a_packet_says_which_file_cannot_carry_an_opening_over_a_corner(self):
        """A member drawn from either end; its other files and the other part are all there."""
        for ends in (([0, 0, 0], [0, 0, 900]), ([0, 0, 900], [0, 0, 0])):
            vent = {"id": "vent", "shape": {"kind": "circle", "diameter_mm": 12}, "at": {"z_mm": 60, "girth_mm": 37.8}}
            post = {"id": "post", "start_mm": ends[0], "end_mm": ends[1], "up": [1, 0, 0], "size": "SHS 80x80x4 EN 10219", "cutouts": [vent]}
            rail = {"id": "rail", "start_mm": [0, 0, 450], "end_mm": [700, 0, 450], "up": [0, 0, 1], "size": "SHS 40x40x3 EN 10219"}
            body = {"preset": "tube_laser", "kerf_mm": 0.3, "sampling": {"tolerance_mm": 0.05}, "members": [post, rail], "connect": {"within_mm": 5}}
            content = self.service.text("frames", body, "format=zip&files=nc1,step,dxf")
            with zipfile.ZipFile(io.BytesIO(content)) as packet:
                parts = {row["part"]: row for row in json.loads(packet.read("manifest.json"))["parts"]}
            files = {name: {file["format"] for file in row["files"]} for name, row in parts.items()}
            self.assertLessEqual({"step", "dxf"}, files["post"])
            self.assertLessEqual({"nc1", "step", "dxf"}, files["rail"])
            [left] = parts["post"]["left_out"]
            self.assertEqual((left["format"], parts["rail"]["left_out"]), ("nc1", []))
            self.assertIn("vent goes over a corner", left["errors"][0]["hint"])


if __name__ == "__main__":
    main()
