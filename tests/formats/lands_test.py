"""Lands: a bevel's pass does not cut them, so a lit program says how it is meant; in two passes the land comes first, half a kerf off it."""

import json
import math
import re

import leads_test
import torch_program
from service import FormatTest, examples, main, seam_row

LIT = leads_test.LIT
SADDLE = {"target": {"outer_diameter_mm": 114.3, "wall_mm": 8}, "cutters": [{"kind": "tube", "outer_diameter_mm": 219.1, "inclination_deg": 70, "clocking_deg": 0, "offset_mm": 0}],
          "root_surface": "inner", "groove": {"rule": "half_dihedral"}, "contact": "inner", "root_face_mm": 2, "smoothing": {"method": "none"},
          "torch": {"min_deg": -70, "max_deg": 70}, "sampling": {"tolerance_mm": 0.005}, "kerf_mm": 1.6}
MITRE = SADDLE | {"cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 0.2, 1]}]}


def part(finish_land, start_land):
    cut = {key: SADDLE[key] for key in ("root_surface", "groove", "contact", "smoothing")}
    ends = {name: cut | {"cutters": SADDLE["cutters"], "root_face_mm": land} for name, land in (("start", start_land), ("finish", finish_land))}
    return {"target": SADDLE["target"] | {"length_mm": 900}, "ends": ends, "kerf_mm": 1.6, "datum": "seam", "seam_deg": 0, "torch": SADDLE["torch"], "sampling": SADDLE["sampling"]}


def codes_of(answer):
    return ",".join(sorted({w["code"] for w in answer["warnings"] if w["severity"] == "cut"})) or None


def rows(program, name):
    """(phi deg, z, B) of the cut of that name, without its leads."""
    cut = next(cut for cut in torch_program.replay(program, SADDLE["target"]["outer_diameter_mm"] / 2, leads_test.PIVOT) if cut.name == name)
    first = leads_test.joins(cut)
    return [(p.phi, p.z, p.b) for p in cut.places[first:]]


class Lands(FormatTest):
    outer = SADDLE["target"]["outer_diameter_mm"] / 2
    inner = outer - SADDLE["target"]["wall_mm"]

    def refused(self, endpoint, body, query):
        status, _, content = self.service.ask(endpoint, body, query)
        self.assertIn(status, (400, 422), content[:200])
        return [(e["pointer"], e["code"]) for e in json.loads(content)["errors"]]

    def program(self, endpoint, body, passes, **more):
        acknowledge = codes_of(self.service.answer(endpoint, body))
        return self.service.text(endpoint, body, leads_test.query(LIT, passes=passes, acknowledge=acknowledge, **more)).decode("ascii")

    def test_it_must_be_said(self):
        for endpoint, body, name in (("bevel-tables", SADDLE, "the cut"), ("parts", part(2, 0), "cut finish")):
            acknowledge = codes_of(self.service.answer(endpoint, body))
            self.assertEqual(self.refused(endpoint, body, leads_test.query(LIT, acknowledge=acknowledge)), [("?passes", "unsupported_combination")])
            self.assertIn(f"({name}: ONLY THE BEVEL, its land of 2 mm is left to a pass before it)", self.program(endpoint, body, "bevel"))
            dry = self.service.text(endpoint, body, leads_test.query(LIT, torch="off")).decode()
            self.assertNotIn("land", dry)
        self.assertEqual(self.refused("bevel-tables", SADDLE, leads_test.query(LIT, passes="land"))[0], ("?passes", "bad_choice"))
        square = SADDLE | {"root_face_mm": 0}
        plain = self.program("bevel-tables", square, None)
        self.assertEqual(plain, self.program("bevel-tables", square, "both"))
        self.assertEqual(plain, self.program("bevel-tables", square, "bevel"))

    def test_the_land_and_then_the_bevel(self):
        """On the inner wall the land's beam is half a kerf off the land, no nearer and hardly further; the bevel's pass is what it is alone."""
        for name, body in (("saddle", SADDLE), ("mitre", MITRE)):
            with self.subTest(name):
                program = self.program("bevel-tables", body, "both")
                self.assertEqual(re.findall(r"^\(cut: (.*)\)$", program, re.M), ["land", "bevel"])
                self.assertEqual(program.count("\nM3 S1\n"), 2)
                self.assertIn("(lands: a pass of their own before the bevel", program)
                points = self.service.answer("bevel-tables", body)["result"]["points"]
                land = rows(program, "land")
                edges = [[(rho * math.radians(phi), z) for phi, z in seam_row(points["phi_deg"], points[column])]
                         for rho, column in ((self.inner, "z_inner_mm"), (self.inner + 2, "z_face_mm"))]
                face = seam_row(points["phi_deg"], [math.tan(math.radians(b)) for b in points["b_face_deg"]])
                leads = len(land) - 1 - max(i for i, (phi, _, _) in enumerate(land) if phi <= land[0][0] + 360 + math.degrees(leads_test.OVERCUT / self.outer) + 0.01)
                nearest = []
                for phi, z, b in land[:len(land) - leads]:
                    want = next(t0 + (t1 - t0) * ((phi % 360) - p0) / (p1 - p0) for (p0, t0), (p1, t1) in zip(face, face[1:]) if p0 <= phi % 360 <= p1 and p1 > p0)
                    self.assertAlmostEqual(math.tan(math.radians(b)), want, delta=2e-4)
                    for (line, rho) in zip(edges, (self.inner, self.inner + 2)):
                        below = z - (self.outer - rho) * math.tan(math.radians(b))
                        at = rho * math.radians(phi % 360), below
                        girth = 2 * math.pi * rho
                        nearest.append(min(leads_test.distance((at[0] + turn * girth, below), line) for turn in (-1, 0, 1)) * math.cos(math.radians(b)))
                self.assertGreater(min(nearest), 0.8 - 0.012)
                self.assertLess(min(nearest), 0.8 + 0.012)
                self.assertLess(max(nearest), 0.8 + 0.12)
                alone = self.program("bevel-tables", body, "bevel")
                moves = [[line for line in text.splitlines() if line.startswith("G1")] for text in (program, alone)]
                self.assertEqual(moves[0][-len(moves[1]):], moves[1])

    def test_a_part_is_held_until_its_last_cut(self):
        body = part(2, 0)
        program = self.program("parts", body, "both")
        self.assertEqual(re.findall(r"^\(cut: (.*)\)$", program, re.M), ["finish, land", "finish, bevel", "start"])
        result = self.service.answer("parts", body)["result"]
        points = result["ends"]["finish"]["points"]
        # Of a finish the scrap lies at greater z: nowhere does the land's pass reach below its edge.
        edge = [(self.inner * math.radians(phi), z) for phi, z in seam_row(points["phi_deg"], points["z_inner_mm"])]
        for phi, z, b in rows(program, "finish, land")[:200]:
            x, below = self.inner * math.radians(phi % 360), z - (self.outer - self.inner) * math.tan(math.radians(b))
            self.assertGreater(leads_test.distance((x, below), edge), 0.8 - 0.02)
            self.assertGreater(below, next(z0 + (z1 - z0) * (x - x0) / (x1 - x0) for (x0, z0), (x1, z1) in zip(edge, edge[1:]) if x0 <= x <= x1 and x1 > x0))
        for body in (part(0, 2), part(2, 2)):
            self.assertEqual(self.refused("parts", body, leads_test.query(LIT, passes="both", acknowledge=codes_of(self.service.answer("parts", body)))),
                             [("?passes", "unsupported_combination")])
            self.program("parts", body, "bevel")

    def test_point_pairs_have_both(self):
        asked = {name: value for name, value in LIT.items() if name != "pivot_length_mm"}
        acknowledge = codes_of(self.service.answer("bevel-tables", SADDLE))
        program = json.loads(self.service.text("bevel-tables", SADDLE, leads_test.query(asked, post="point_pairs", passes="both", acknowledge=acknowledge)))
        self.assertEqual([cut["name"] for cut in program["cuts"]], ["land", "bevel"])

    def test_schedules(self):
        body = examples("pulse-schedules")
        name, job = next((name, job) for name, job in body.items() if "cut" in job and "root_surface" in job["cut"])
        job = job | {"cut": job["cut"] | {"root_surface": "inner", "contact": "inner", "root_face_mm": 0.5}}
        status, _, content = self.service.ask("pulse-schedules", job)
        self.assertEqual(status, 200, name + content[:300].decode())
        answer = json.loads(content)
        self.assertIn(("land_left", "/cut/root_face_mm"), [(one["code"], one["pointer"]) for one in answer["warnings"]])
        codes = codes_of(answer).split(",")
        others = [code for code in codes if code != "land_left"]
        for acknowledged in (others, codes):
            query = leads_test.query({"torch": "on", "acknowledge": ",".join(acknowledged) or None})
            status, _, content = self.service.ask("pulse-schedules", job, query)
            self.assertEqual(status, 200 if "land_left" in acknowledged else 422, content[:300].decode())


if __name__ == "__main__":
    main()
