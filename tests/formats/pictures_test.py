"""Everything that a picture shows lies within it: of every SVG of every example, of requests drawn by a seed, and on paper of every size."""

import json
import math
import random

import yaml

import drawn_parts
from service import HOSTILE, ROOT, FormatTest, examples, main
from picture import Picture  # of tests/support, where service looks

PAPERS = ("a4", "a3", "letter", "tabloid")
LONG = "Querträger-Knotenblech WWWWWWWWWW mit sehr langem Namen, Achse 14"
BIKE = json.loads((ROOT / "tests/field/bike-down-tube-two-mitres.intersection.json").read_text())
ENDPOINTS = ("bevel-tables", "intersections", "holes", "parts", "grooves", "mill-paths", "feed-curves", "pulse-schedules")


def partner(r, outer):
    kind = r.choice(["tube", "tube", "plane"])
    name = r.choice(["BB", "ST", LONG[:64], "chord 1"])
    if kind == "plane":
        turn, lean = r.uniform(0, 2 * math.pi), math.radians(r.uniform(0, 60))
        return {"kind": kind, "id": name, "point_mm": [0, 0, 0], "normal": [math.sin(lean) * math.cos(turn), math.sin(lean) * math.sin(turn), math.cos(lean)]}
    return {"kind": kind, "id": name, "outer_diameter_mm": 2 * outer * r.uniform(1.05, 4), "inclination_deg": r.uniform(25, 155), "clocking_deg": r.uniform(0, 360),
            "offset_mm": outer * r.uniform(-0.02, 0.02)}


def end(r):
    outer = math.exp(r.uniform(math.log(2.5), math.log(400)))
    cutters = [partner(r, outer) for _ in range(r.choice([1, 1, 2, 3]))]
    return {"target": {"outer_diameter_mm": 2 * outer, "wall_mm": max(0.5, 0.1 * outer)}, "cutters": cutters, "sampling": {"uniform_points": 72}}


def hole(r):
    outer = math.exp(r.uniform(math.log(10), math.log(300)))
    return {"chord": {"outer_diameter_mm": 2 * outer, "wall_mm": max(0.8, 0.08 * outer), "id": r.choice(["C1", LONG[:64]])},
            "branch": {"outer_diameter_mm": outer * r.uniform(0.3, 1.4), "wall_mm": max(0.5, 0.03 * outer), "id": r.choice(["B1", LONG[:64]]),
                       "inclination_deg": r.uniform(45, 135), "clocking_deg": r.uniform(0, 360)},
            "joint": {"kind": r.choice(["set_on", "set_in", "through"])}, "groove": {"rule": "none"}, "kerf_mm": 0,
            "sampling": {"uniform_points": 72}}


class Pictures(FormatTest):
    def outside(self, endpoint, body, query):
        """None if the request is refused."""
        status, _, content = self.service.ask(endpoint, body, query)
        if status != 200:
            self.assertLess(status, 500, content[:400])
            return None
        return Picture(content).outside()

    def test_of_every_example(self):
        contract, count = yaml.safe_load((ROOT / "openapi.yaml").read_text()), 0
        for endpoint in ENDPOINTS:
            about = contract["paths"][f"/v1/{endpoint}"]["post"]["responses"]["200"]["content"].get("image/svg+xml", {})
            for i, (name, body) in enumerate(examples(endpoint).items()):
                for view in about.get("x-views", [""]):
                    papers = PAPERS if i == 0 else PAPERS[:1]
                    for more in ("", *(f"&paper={paper}" for paper in papers), "&mirror=true") if view == "template" else ("",):
                        query = "format=svg" + (f"&view={view}" if view else "") + more
                        with self.subTest(f"{endpoint} {name} {query}"):
                            self.assertEqual(self.outside(endpoint, body | {"reference": HOSTILE}, query), [])
                            count += 1
        self.assertGreater(count, 130)

    def drawn(self, endpoint, make, views, count, seed):
        r, made, tried = random.Random(seed), 0, 0
        while made < count:
            tried += 1
            self.assertLess(tried, 8 * count)
            view = views[made % len(views)]
            more = r.choice(["", "", *(f"&paper={paper}" for paper in PAPERS), "&mirror=true"]) if view == "template" else ""
            body = make(r)
            faults = self.outside(endpoint, body, f"format=svg&view={view}{more}")
            if faults is None:
                continue
            with self.subTest(f"{endpoint} {view}{more} {json.dumps(body)}"):
                self.assertEqual(faults, [])
            made += 1

    def test_of_drawn_intersections(self):
        self.drawn("intersections", end, ("template", "section", "template", "chart"), 80, 1)

    def test_of_drawn_bevel_tables(self):
        base = {"groove": {"rule": "half_dihedral"}, "smoothing": {"method": "none"}, "contact": "auto", "root_surface": "inner", "kerf_mm": 0}
        self.drawn("bevel-tables", lambda r: end(r) | base, ("template", "section", "chart", "b_curve"), 60, 2)

    def test_of_drawn_holes(self):
        self.drawn("holes", hole, ("template", "section", "chart"), 45, 3)

    def test_of_drawn_parts(self):
        def make(r):
            body = drawn_parts.part(r) | {"sampling": {"uniform_points": 72}}
            return body | {"reference": r.choice([HOSTILE, {"part": "N-12"}])}
        self.drawn("parts", make, ("work_order", "template", "work_order"), 45, 4)

    def test_of_the_bike_tube(self):
        for paper in ("sheet", *PAPERS):
            self.assertEqual(self.outside("intersections", BIKE, f"format=svg&view=template&paper={paper}"), [], paper)


if __name__ == "__main__":
    main()
