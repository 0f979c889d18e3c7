"""STEP files read by a reader of our own: one closed solid each, as the answer has it. `./dev peers` lets Open CASCADE read them."""

import json
import math
import os
import random
import re

import drawn_parts
import numpy as np
import step_reader
import step_volume
from service import FormatTest, cutouts, drawing_seed, examples, main, thinned

PARTS = int(os.environ.get("TUBECUT_PARTS", "24"))  # enough for every kind; ./dev soak drawn takes more
NEAR_CUT = 2e-3   # mm from the cut as answered
NEAR_ROWS = 1e-3  # mm from its rows, and from the exact cut where that is smooth between them
VOLUME_OFF = 1e-6  # of the answer's, by the file's own edges and cut faces
# mm of the cut faces in addition to that: half of a spline's permitted distance from the rows; matters in short thin
# tubes
MEAN_OFF = 5e-4
SMALL = 60_000    # bytes of a cut end
LEANING_OFF = 2e-5  # of a hole's volume, by rows up to 0.05 mm off their curve


def solid_of(content):
    return step_reader.Solid(step_reader.File(content.decode("ascii")))


def end_points(r, end, target, face, count):
    """Points of the cut as answered: straight in (phi, z) from row to row, straight across."""
    p = end["points"]
    outer, wall = target["outer_diameter_mm"] / 2, target["wall_mm"]
    radii = [outer - wall] + ([outer - wall + face] if face else []) + [outer]
    z = [p["z_inner_mm"]] + ([p["z_face_mm"]] if face else []) + [p["z_outer_mm"]]
    phi, n, out = np.radians(p["phi_deg"]), len(p["phi_deg"]), []
    for _ in range(count):
        i, share, strip, v = r.randrange(n), r.random(), r.randrange(len(radii) - 1), r.random()
        j = (i + 1) % n
        turn = phi[i] + share * (phi[j] - phi[i] + (2 * math.pi if j == 0 else 0.0))
        low, high = ((1 - share) * edge[i] + share * edge[j] for edge in z[strip:strip + 2])
        radius = (1 - v) * radii[strip] + v * radii[strip + 1]
        out.append((radius * math.cos(turn), radius * math.sin(turn), (1 - v) * low + v * high))
    return np.array(out)


def hole_points(r, hole, target, count):
    p, out = hole["points"], []
    outer, inner = target["outer_diameter_mm"] / 2, target["outer_diameter_mm"] / 2 - target["wall_mm"]
    n = len(p["phi_deg"])
    for _ in range(count):
        i, share, v = r.randrange(n), r.random(), r.random()
        j = (i + 1) % n

        def on(radius, phi, z):
            turn = math.radians((1 - share) * p[phi][i] + share * p[phi][j])
            return np.array([radius * math.cos(turn), radius * math.sin(turn), (1 - share) * p[z][i] + share * p[z][j]])
        out.append((1 - v) * on(inner, "phi_inner_deg", "z_inner_mm") + v * on(outer, "phi_deg", "z_mm"))
    return np.array(out)


def rows_of(body, result):
    """The rows of all edges, in space."""
    def on(radius, phi_deg, z):
        turn = np.radians(phi_deg)
        return np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)
    target, out = body["target"], []
    outer = target["outer_diameter_mm"] / 2
    inner = outer - target["wall_mm"]
    for end in result.get("ends", {"": result}).values():
        out += [on(inner, end["points"]["phi_deg"], end["points"]["z_inner_mm"]), on(outer, end["points"]["phi_deg"], end["points"]["z_outer_mm"])]
    for hole in result.get("holes", []):
        out += [on(inner, hole["points"]["phi_inner_deg"], hole["points"]["z_inner_mm"]), on(outer, hole["points"]["phi_deg"], hole["points"]["z_mm"])]
    return np.concatenate(out)


def off_cut(solid, points):
    ruled = [face["surface"] for face in solid.faces if face["surface"][0] == "ruled"]
    flat = [face["surface"] for face in solid.faces if face["surface"][0] == "plane"]
    return min(np.min([step_reader.off_surface(surface, points) for surface in ruled + flat], axis=0).max(), np.inf)


def exact_points(r, body, result, count):
    target, out = body["target"], []
    for name, end in result["ends"].items():
        out.append(end_points(r, end, target, body["ends"][name].get("root_face_mm", 0.0), count))
    return np.concatenate(out + [hole_points(r, hole, target, count) for hole in result["holes"]])


def length(phi_deg, z, radius):
    """Of a closed edge."""
    turn, rise = np.radians(np.append(phi_deg, phi_deg[0])), np.append(z, z[0])
    steps = np.diff(turn)
    return float(np.hypot(radius * ((steps + math.pi) % (2 * math.pi) - math.pi), np.diff(rise)).sum())


def meets_end(answer):
    """A hole that reaches an end is refused, or lies beyond it and is no hole of the solid."""
    return any(warning["code"] == "hole_meets_end" for warning in answer["warnings"])


def least_cut_area(target, result):
    """Of all cut faces, each at least as wide as the wall, mm2."""
    radius = target["outer_diameter_mm"] / 2
    edges = [length(end["points"]["phi_deg"], end["points"]["z_outer_mm"], radius) for end in result["ends"].values()]
    edges += [length(hole["points"]["phi_deg"], hole["points"]["z_mm"], radius) for hole in result["holes"]]
    return sum(edges) * target["wall_mm"]


def volume_off(target, result):
    """What a file's volume may differ by, mm3."""
    return VOLUME_OFF * result["lengths"]["volume_mm3"] + MEAN_OFF * least_cut_area(target, result)


def kinds(body):
    """What a part is drawn from."""
    out = {f"{name} {value}" for name, value in body["sampling"].items()}
    for end in body["ends"].values():
        cutters = end.get("cutters", [])
        out |= {f"end of {len(cutters)}"} | {cutter["kind"] for cutter in cutters}
        if cutters:
            out |= {f"end {end['groove']['rule']}", end["smoothing"]["method"], "land" if "root_face_mm" in end else "no land"}
    for hole in body.get("holes", []):
        out |= {hole["joint"]["kind"], hole["tilt"], f"{hole['joint']['kind']} {hole['groove']['rule']}"}
    return out


EVERY_KIND = {
    "tolerance_mm 0.001", "tolerance_mm 0.01", "tolerance_mm 0.05", "uniform_points 360", "end of 0", "end of 1", "end of 2", "plane", "tube",
    "end square", "end half_dihedral", "end none", "none", "envelope", "land", "no land", "axial", "free",
    "set_on", "set_on none", "set_on half_dihedral", "set_in", "set_in none", "set_in half_dihedral", "set_in square",
    "through", "through none", "through half_dihedral", "through square"}


NARROW_LAND = {  # its rulings are shorter than the way from one to the next, and slant
    "target": {"outer_diameter_mm": 32.89, "wall_mm": 0.83, "length_mm": 148},
    "ends": {"start": {"cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 0, 1]}], "root_surface": "inner",
                       "groove": {"rule": "none"}, "contact": "none", "smoothing": {"method": "none"}},
             "finish": {"cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0.3657727, 0.6011576, 0.7105068]}],
                        "root_surface": "inner", "groove": {"rule": "half_dihedral"}, "contact": "inner",
                        "smoothing": {"method": "none"}, "root_face_mm": 0.166}},
    "kerf_mm": 0, "datum": "seam", "seam_deg": 0, "torch": {"min_deg": -85, "max_deg": 85}, "sampling": {"tolerance_mm": 0.01}}


class Step(FormatTest):
    def test_narrow_land(self):
        self.assertEqual(step_reader.faults(solid_of(self.service.text("parts", NARROW_LAND, "format=step")), 1), [])

    def test_drawn_parts(self):
        seed = drawing_seed()
        r, read, refused, worst, farthest, holes, missing = random.Random(seed), 0, 0, 0.0, 0.0, 0, set(EVERY_KIND)
        while read < PARTS:
            body = drawn_parts.part(r)
            status, _, answer = self.service.ask("parts", body)
            if status != 200:
                refused += 1
                self.assertLess(refused, 2 * PARTS)
                continue
            status, _, content = self.service.ask("parts", body, "format=step&view=straight")
            if status == 422 and b"step prints no such solid" in content:
                continue
            self.assertEqual(status, 200, content[:300])
            result = json.loads(answer)["result"]
            if meets_end(json.loads(answer)):
                continue
            with self.subTest(f"seed {seed}, part {read}: {json.dumps(body)}"):
                solid = solid_of(content)
                self.assertEqual(step_reader.faults(solid, 1 + len(result["holes"])), [])
                volume = result["lengths"]["volume_mm3"]
                off = abs(step_volume.volume(solid) - volume)
                self.assertLess(off, volume_off(body["target"], result))
                far = off_cut(solid, exact_points(r, body, result, 60))
                self.assertLess(far, NEAR_CUT)
                smooth = solid_of(self.service.text("parts", body, "format=step"))
                self.assertEqual(step_reader.faults(smooth, 1 + len(result["holes"])), [])
                rows = rows_of(body, result)
                self.assertLess(off_cut(smooth, rows[r.sample(range(len(rows)), min(60, len(rows)))]), NEAR_ROWS)
                worst, farthest, holes = max(worst, off / volume), max(farthest, far), holes + len(result["holes"])
            missing -= kinds(body)
            read += 1
        print(f"{read} parts, {holes} holes: volume within {worst:.1e}, cut within {farthest:.1e} mm")
        self.assertGreater(holes, PARTS / 4)
        self.assertEqual(missing, set(), "kinds that no part was of")

    def test_every_example_and_view(self):
        count = 0
        for endpoint in ("bevel-tables", "holes", "parts"):
            for name, whole in examples(endpoint, whole=True).items():
                body = thinned(whole)
                if body != whole:
                    with self.subTest(f"{endpoint} {name}, whole"):
                        told = cutouts(self.service.answer(endpoint, whole)["result"])
                        file = step_reader.File(self.service.text(endpoint, whole, "format=step").decode("ascii"))
                        few = step_reader.File(self.service.text(endpoint, body, "format=step").decode("ascii"))
                        left_out = len(told) - len(cutouts(self.service.answer(endpoint, body)["result"]))
                        edges = {"circle": 6, "slot": 10}[whole["cutouts"][0]["shape"]["kind"]]  # a slot's rims are of two pieces in each half
                        for kind, of_one in (("ADVANCED_FACE", 2), ("EDGE_CURVE", edges)):  # a wall of two halves
                            self.assertEqual(len(file.of(kind)) - len(few.of(kind)), left_out * of_one)
                result = self.service.answer(endpoint, body)["result"]
                for view in ("", "&view=straight"):
                    with self.subTest(f"{endpoint} {name} {view}"):
                        content = self.service.text(endpoint, body, f"format=step{view}")
                        solid = solid_of(content)
                        self.assertEqual(step_reader.faults(solid, 1 + len(result.get("holes", [])) + len(cutouts(result))), [])
                        if endpoint == "bevel-tables" and not view:
                            self.assertLess(len(content), SMALL)
                        count += 1
        self.assertGreaterEqual(count, 32)

    def test_a_cut_of_near_rows_is_smooth_and_small(self):
        """At a tolerance of a micrometre the file has few spans, in both views, and stays at the cut; up to 2 m across."""
        for scale in (0.2, 1.0, 14.0):
            body = {"target": {"outer_diameter_mm": 140 * scale, "wall_mm": 8 * scale}, "kerf_mm": 0,
                    "cutters": [{"kind": "tube", "outer_diameter_mm": 220 * scale, "inclination_deg": 60, "clocking_deg": 10}],
                    "root_surface": "inner", "groove": {"rule": "half_dihedral"}, "smoothing": {"method": "none"}, "sampling": {"tolerance_mm": 0.001}}
            result = self.service.answer("bevel-tables", body)["result"]
            points = end_points(random.Random(7), result, body["target"], 0.0, 1000)
            # The tolerance applies to the root's rows; the outer edge's lie further from the exact curve.
            for view, near, size in (("straight", NEAR_CUT, 110_000), ("smooth", 5e-3, SMALL)):
                with self.subTest(f"{scale} {view}"):
                    content = self.service.text("bevel-tables", body, f"format=step&view={view}")
                    self.assertLess(len(content), size)
                    self.assertLess(off_cut(solid_of(content), points), near)

    def test_the_default_keeps_to_the_exact_cut(self):
        """Of a smooth cut: every row of a closer sampling lies on the solid, of few rows too."""
        for scale, sampling in ((0.1, {"tolerance_mm": 0.001}), (1.0, {"uniform_points": 180}), (1.0, {"tolerance_mm": 0.001}), (6.0, {"tolerance_mm": 0.001})):
            body = {"target": {"outer_diameter_mm": 140 * scale, "wall_mm": 8 * scale}, "kerf_mm": 0,
                    "cutters": [{"kind": "tube", "outer_diameter_mm": 220 * scale, "inclination_deg": 60, "clocking_deg": 10}],
                    "root_surface": "inner", "groove": {"rule": "none"}, "contact": "inner", "smoothing": {"method": "none"}}
            exact = self.service.answer("bevel-tables", body | {"sampling": {"uniform_points": 3000}})["result"]
            content = self.service.text("bevel-tables", body | {"sampling": sampling}, "format=step")
            with self.subTest(f"{scale} {sampling}"):
                self.assertLess(off_cut(solid_of(content), rows_of(body, exact)[::7]), NEAR_ROWS)

    def test_a_corner_between_rows_stays_one(self):
        """Where an end goes from one partner to the next between two rows, the default does not swing beside it."""
        body = {"target": {"outer_diameter_mm": 60, "wall_mm": 4}, "kerf_mm": 0,
                "cutters": [{"kind": "plane", "id": turn, "point_mm": [0, 0, 0], "normal": [x, y, 1.0]} for turn, x, y in (("a", 0.7, 0.1), ("b", -0.7, 0.2))],
                "root_surface": "inner", "groove": {"rule": "none"}, "contact": "inner", "smoothing": {"method": "none"}, "sampling": {"uniform_points": 150}}
        answer = self.service.answer("bevel-tables", body)["result"]
        self.assertEqual({(event["kind"], event["surface"]) for event in answer["events"]}, {("junction", "inner"), ("junction", "outer")})
        content = self.service.text("bevel-tables", body, "format=step")
        self.assertLess(off_cut(solid_of(content), end_points(random.Random(3), answer, body["target"], 0.0, 2000)), 5e-3)

    def test_the_volume_of_a_hole_that_leans_across_by_few_rows(self):
        """Its wall is straight across between the rows too, and volume_mm3 says so."""
        hole = {"branch": {"outer_diameter_mm": 7, "wall_mm": 0.5, "inclination_deg": 65, "clocking_deg": 40, "offset_mm": 0.45, "height_mm": 30},
                "joint": {"kind": "set_in", "gap_mm": 0.01}, "groove": {"rule": "none"}, "tilt": "free"}
        body = {"target": {"outer_diameter_mm": 9.6, "wall_mm": 0.56, "length_mm": 60}, "kerf_mm": 0, "sampling": {"tolerance_mm": 0.05},
                "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}}
        whole = self.service.answer("parts", body)["result"]["lengths"]["volume_mm3"]
        told = self.service.answer("parts", body | {"holes": [hole]})["result"]["lengths"]["volume_mm3"]
        own = step_volume.volume(solid_of(self.service.text("parts", body | {"holes": [hole]}, "format=step&view=straight")))
        self.assertLess(abs(own - told), LEANING_OFF * (whole - told))

    def test_header_and_product(self):
        body = examples("parts")["k-joint-brace"] | {"reference": {"part": "Träger 'A'\\", "order": "𠮷 7", "revision": "C"}}
        _, headers, content = self.service.reply("parts", json.dumps(body).encode(), "format=step")
        file = step_reader.File(content.decode("ascii"))
        lines = file.header["FILE_DESCRIPTION"][0]
        for wanted in (f"input_sha256: {headers['Tubecut-Input-Sha256']}", f"result_sha256: {headers['Tubecut-Result-Sha256']}",
                       "part: Träger 'A'\\", "order: 𠮷 7", "revision: C"):
            self.assertIn(wanted, lines)
        self.assertEqual(file.get(file.of("PRODUCT")[0], "PRODUCT")[0], "Träger 'A'\\")
        self.assertEqual(file.header["FILE_SCHEMA"], [["AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"]])
        self.assertEqual(len(file.of("COLOUR_RGB")), 2)

    def test_a_frame_is_an_assembly(self):
        for name in ("k-node-with-plate-and-square-brace", "jacket-node-with-set-in-stubs", "truss-of-19"):
            body = examples("frames")[name]
            answer = self.service.answer("frames", body)
            file = step_reader.File(self.service.text("frames", body, "format=step&view=straight").decode("ascii"))
            used = {use[0]: use[1:] for use in step_reader.assembly(file)}
            members = answer["result"]["members"]
            self.assertEqual(set(used), {m["id"] for m in members})
            parts = {p["part"]: p["answer"] for p in answer["parts"]}
            self.assertEqual(len(file.of("MANIFOLD_SOLID_BREP")), len(parts))
            for member in members:
                product, brep, origin, rows = used[member["id"]]
                self.assertEqual(product, member["part"])
                place = member["frame"]
                self.assertLess(np.abs(origin - place["origin_mm"]).max(), 1e-5)
                self.assertLess(np.abs(rows - [place[axis] for axis in "xyz"]).max(), 1e-11)
            for brep, part in {use[1]: parts[use[0]] for use in used.values()}.items():
                solid = step_reader.Solid(file, brep)
                self.assertEqual(step_reader.faults(solid, 1 + len(part["result"]["holes"])), [])
                volume = part["result"]["lengths"]["volume_mm3"]
                self.assertLess(abs(step_volume.volume(solid) - volume), VOLUME_OFF * volume)

    def test_what_is_no_solid_of_this_kind_is_refused(self):
        def hole(at):
            return {"branch": {"outer_diameter_mm": 60, "wall_mm": 4, "inclination_deg": 90, "clocking_deg": 0, "height_mm": at},
                    "joint": {"kind": "set_in", "gap_mm": 1}, "groove": {"rule": "none"}, "tilt": "free"}
        for places in ((300, 330), (10,)):
            body = {"target": {"outer_diameter_mm": 140, "wall_mm": 8, "length_mm": 900}, "kerf_mm": 0,
                    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "holes": [hole(at) for at in places]}
            self.assertEqual(self.service.ask("parts", body)[0], 200)
            status, _, content = self.service.ask("parts", body, "format=step")
            self.assertEqual((status, [e["pointer"] for e in json.loads(content)["errors"]]), (422, ["?format"]))

    def test_controls(self):
        """A vertex's edge moved, a face turned inside out, a wrong unit: each is seen."""
        body = examples("parts")["chord-with-holes"]
        text = self.service.text("parts", body, "format=step").decode("ascii")
        result = self.service.answer("parts", body)["result"]
        genus = 1 + len(result["holes"])
        self.assertEqual(step_reader.faults(solid_of(text.encode()), genus), [])

        # Only one edge: its curve, but not the adjacent surface, has another point in the middle.
        curve = re.search(r"(=B_SPLINE_CURVE_WITH_KNOTS\('',3,\(#\d+,#\d+,#\d+,)#(\d+)", text)
        x, rest = re.search(rf"#{curve[2]}=CARTESIAN_POINT\('',\(([-\d.]+),(.*)\)\);", text).groups()
        moved = text[:curve.start()] + curve[1] + "#999999" + text[curve.end():]
        moved = moved.replace("ENDSEC;\nEND-ISO", f"#999999=CARTESIAN_POINT('',({float(x) + 0.02:.6f},{rest}));\nENDSEC;\nEND-ISO")
        self.assertTrue(any("off face" in fault for fault in step_reader.faults(solid_of(moved.encode()), genus)))

        face = re.search(r"=ADVANCED_FACE\('[^']*',\([^)]*\),#\d+,(\.[TF]\.)\)", text)
        turned = text[:face.start(1)] + (".F." if face[1] == ".T." else ".T.") + text[face.end(1):]
        self.assertTrue(step_reader.faults(solid_of(turned.encode()), genus))
        with self.assertRaises(step_reader.Malformed):
            solid_of(text.replace(".MILLI.,.METRE.", "$,.METRE.", 1).encode())


if __name__ == "__main__":
    main()
