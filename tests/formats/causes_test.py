"""A refusal names its first cause: what it points at, changed within its range, cures it or brings another one to light. Drawn laterals and ends of tubes."""

import collections
import copy
import json
import os
import random

from service import ROOT, FormatTest, main

CASES = int(os.environ.get("TUBECUT_CASES", "200"))
SIZES = ((33.7, 3.2), (60.3, 3.9), (88.9, 5), (114.3, 6.3), (168.3, 7.1), (219.1, 8.2), (273, 9.3), (323.9, 12.5))
WIDE = {"min_deg": -89, "max_deg": 89}


def changed(body, **members):
    out = copy.deepcopy(body)
    for path, value in members.items():
        *steps, last = path.split("__")
        at = out
        for step in steps:
            at = at.setdefault(step, {})
        at[last] = value
    return out


class Causes(FormatTest):
    def refusal(self, endpoint, body):
        """The first error, or nothing."""
        status, _, content = self.service.ask(endpoint, body)
        self.assertLess(status, 500, content[:400])
        return None if status == 200 else json.loads(content)["errors"][0]

    def cures(self, endpoint, body, error):
        """What a reader of the error would try: bodies of which one at least must not meet the same refusal."""
        pointer, limit = error["pointer"], error["limit"]
        if pointer.startswith("/kerf_mm"):
            return [changed(body, kerf_mm=0)]
        if pointer.startswith("/groove"):
            return [changed(body, **{"groove__" + pointer.rsplit("/", 1)[1]: limit})] if pointer.count("/") == 2 else [changed(body, groove__cap_deg=limit)]
        if pointer.startswith("/torch") and error["code"] == "out_of_range":
            return [changed(body, torch__max_deg=limit), changed(body, torch__min_deg=limit)]
        if pointer.startswith("/torch"):
            return [changed(body, torch=WIDE)]
        if pointer == "/tilt":
            return [changed(body, tilt=tilt) for tilt in ("free", "axial", "none") if tilt != body.get("tilt")]
        if pointer.startswith("/branch"):
            return [changed(body, branch__offset_mm=0), changed(body, branch__inclination_deg=90), changed(body, branch__offset_mm=0, branch__inclination_deg=90)]
        if pointer == "/contact":
            return [changed(body, contact=contact) for contact in ("inner", "auto", "none")]
        if pointer.startswith("/cutters"):
            return [changed(body, cutters=[{**body["cutters"][0], "inclination_deg": 90, "offset_mm": 0}])]
        if pointer.startswith("/groove") or pointer.startswith("/root_surface"):
            return [changed(body, groove={"rule": "none"})]
        raise AssertionError(f"a refusal that points at {pointer}: {error}")

    def check(self, endpoint, body, told):
        error = self.refusal(endpoint, body)
        if error is None:
            told["answered"] += 1
            return
        told[error["pointer"], error["code"]] += 1
        after = [self.refusal(endpoint, other) for other in self.cures(endpoint, body, error)]
        same = [(e["pointer"].split("/")[1], e["code"]) for e in after if e]
        here = (error["pointer"].split("/")[1], error["code"])
        with self.subTest(body=json.dumps(body), error=error):
            self.assertTrue(len(same) < len(after) or any(each != here for each in same), after)
            if error["code"] == "out_of_range" and not error["pointer"].startswith("/kerf_mm"):
                self.assertIn(None, after)  # it names a value that can be cut

    def test_the_field_input(self):
        body = json.loads((ROOT / "tests/field/lateral-stub-in-37-5-deg.hole.json").read_text())
        error = self.refusal("holes", body)
        self.assertEqual((error["pointer"], error["code"]), ("/groove/angle_deg", "out_of_range"))
        self.assertIsNone(self.refusal("holes", changed(body, groove__angle_deg=error["limit"])))
        self.assertIn("lean up to 80 deg", error["hint"])

    def test_drawn_holes(self):
        seeded, told = random.Random(29), collections.Counter()
        for _ in range(CASES):
            outer, wall = seeded.choice(SIZES[2:])
            branch, branch_wall = seeded.choice([s for s in SIZES if s[0] < 0.95 * outer])
            body = {"chord": {"outer_diameter_mm": outer, "wall_mm": wall},
                    "branch": {"outer_diameter_mm": branch, "wall_mm": branch_wall, "inclination_deg": seeded.choice((30, 35, 40, 45, 50, 60, 75, 90, 120, 140)),
                               "offset_mm": round(seeded.choice((0, 0, 0.2, 0.7)) * (outer - branch) / 2, 2)},
                    "joint": {"kind": seeded.choice(("set_in", "set_in", "set_on", "through")), "gap_mm": seeded.choice((0, 1, 2))},
                    "groove": seeded.choice(({"rule": "fixed", "angle_deg": seeded.choice((20, 30, 37.5, 45, 60))}, {"rule": "half_dihedral", "cap_deg": 45},
                                             {"rule": "square"}, {"rule": "none"})),
                    "tilt": seeded.choice(("free", "free", "axial", "none")), "kerf_mm": seeded.choice((0.3, 1, 2, 3)), "sampling": {"uniform_points": 72}}
            if seeded.random() < 0.3:
                body["torch"] = {"min_deg": -seeded.choice((45, 60)), "max_deg": seeded.choice((45, 60))}
            self.check("holes", body, told)
        print(dict(told))
        self.assertGreater(told["answered"], CASES // 3)
        self.assertGreater(len(told), 4)

    def test_drawn_ends(self):
        seeded, told = random.Random(31), collections.Counter()
        for _ in range(CASES):
            outer, _ = seeded.choice(SIZES[2:])
            tube, wall = seeded.choice([s for s in SIZES if s[0] <= outer])
            inner = seeded.random() < 0.8
            body = {"target": {"outer_diameter_mm": tube, "wall_mm": wall},
                    "cutters": [{"kind": "tube", "outer_diameter_mm": outer, "inclination_deg": seeded.choice((20, 25, 30, 35, 40, 45, 50, 60, 75, 90, 120, 140, 155)),
                                 "clocking_deg": seeded.choice((0, 30, 90)), "offset_mm": round(seeded.choice((0, 0, 0.2, 0.9)) * (outer - tube) / 2, 2)}],
                    "root_surface": "inner" if inner else "outer", "contact": seeded.choice(("inner", "auto", "none")) if inner else "none",
                    "groove": seeded.choice(({"rule": "fixed", "angle_deg": seeded.choice((20, 30, 37.5, 45, 60))}, {"rule": "half_dihedral", "cap_deg": 45},
                                             {"rule": "square"}, {"rule": "none"})),
                    "kerf_mm": seeded.choice((0.3, 1, 2, 4, 6)), "sampling": {"uniform_points": 72}, "smoothing": {"method": "none"}}
            if seeded.random() < 0.4:
                body["smoothing"] = {"method": "envelope", "limits": {"max_slope_deg_per_mm": 3, "max_curvature_deg_per_mm2": 0.4}}
            if seeded.random() < 0.5:
                body["torch"] = {"min_deg": -seeded.choice((45, 60, 65)), "max_deg": seeded.choice((45, 50, 60, 65))}
            self.check("bevel-tables", body, told)
        print(dict(told))
        self.assertGreater(told["answered"], CASES // 2)
        self.assertGreater(told["/torch/max_deg", "torch_range"], CASES // 60)


if __name__ == "__main__":
    main()
