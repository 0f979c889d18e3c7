"""Every format of the smallest, largest and farthest cuts: printed, finite, and still what it claims to be."""

import json
import math
import re
import xml.etree.ElementTree as ElementTree

from dxf_test import read
from service import HOSTILE, FormatTest, examples, main
from stl_test import admesh

SIDES = {"kerf_mm": 2.4, "groove": {"rule": "half_dihedral"}, "root_surface": "inner", "smoothing": {"method": "none"}}


def tube(diameter, inclination, **more):
    return {"kind": "tube", "outer_diameter_mm": diameter, "inclination_deg": inclination, "clocking_deg": 0, "offset_mm": 0, **more}


def cuts():
    yield "smallest", {"target": {"outer_diameter_mm": 5, "wall_mm": 0.5}, "cutters": [tube(6, 60)], "sampling": {"tolerance_mm": 0.01}}
    yield "largest", {"target": {"outer_diameter_mm": 5000, "wall_mm": 200}, "cutters": [tube(5000, 90)], "sampling": {"tolerance_mm": 0.5}}
    yield "far", {"target": {"outer_diameter_mm": 100, "wall_mm": 10}, "cutters": [tube(200, 60, height_mm=1e6)],
                  "sampling": {"tolerance_mm": 0.05}}
    yield "flat", {"target": {"outer_diameter_mm": 100, "wall_mm": 10}, "cutters": [tube(300, 6)], "sampling": {"uniform_points": 8},
                   "contact": "auto"}
    yield "few points", {"target": {"outer_diameter_mm": 300, "wall_mm": 20, "length_mm": 1e4}, "cutters": [tube(400, 80)],
                         "sampling": {"uniform_points": 8}, "root_face_mm": 2}
    yield "square", {"target": {"outer_diameter_mm": 60, "wall_mm": 29.9}, "cutters": [{"kind": "plane", "point_mm": [0, 0, -7], "normal": [0, 0, 1]}],
                     "sampling": {"uniform_points": 8}, "groove": {"rule": "square"}, "length_mm": 10}


class Extremes(FormatTest):
    def formats(self, endpoint):
        listed = self.service.ask(endpoint, {}, "format=none")[2]
        return re.findall(r"\((\w+)\)", json.loads(listed)["detail"])

    def views(self, endpoint, name, body):
        detail = json.loads(self.service.ask(endpoint, body, f"format={name}&view=none")[2])["detail"]
        return [v for v in detail.split("offered: ")[1].split(", ") if v != "none"] or [""]

    def prints(self, endpoint, body):
        for name in self.formats(endpoint):
            if name in ("json", "cbor"):
                continue
            for view in self.views(endpoint, name, body):
                query = f"format={name}" + (f"&view={view}" if view else "") + ("&speed_mm_min=600" if name == "gcode" else "")
                yield name, query, self.service.text(endpoint, body, query)

    def check(self, name, content):
        if name == "svg":
            root = ElementTree.fromstring(content)
            self.assertTrue(all(math.isfinite(float(root.get(a).removesuffix("mm"))) for a in ("width", "height")))
        if name == "dxf":
            audit = read(content).audit()
            self.assertEqual([e.message for e in audit.errors + audit.fixes], [])
        if name == "stl":
            counts, parts, volume = admesh(content)
            self.assertEqual({k: v for k, v in counts.items() if v}, {})
            self.assertEqual(parts, 1)
            self.assertGreater(volume, 0)
        if name == "pdf":
            self.assertTrue(content.startswith(b"%PDF-"))
        elif name not in ("stl", "glb"):
            # Machine files have no letter beyond ASCII; drawings have degree signs.
            self.assertNotRegex(content.decode("utf-8" if name == "svg" else "ascii"), r"(?i)\b-?(nan|inf)\b")

    def test_bevel_tables(self):
        count = 0
        for label, cut in cuts():
            body = {**SIDES, **{k: v for k, v in cut.items() if k != "length_mm"}, "reference": HOSTILE}
            for name, query, content in self.prints("bevel-tables", body):
                with self.subTest(f"{label} {query}"):
                    self.check(name, content)
                    count += 1
        self.assertGreaterEqual(count, 6 * 11)

    def test_intersections_on_one_wall_only(self):
        for label, cut in cuts():
            for surfaces in ("inner", "outer", "both"):
                body = {"target": cut["target"], "cutters": cut["cutters"], "sampling": cut["sampling"], "surfaces": surfaces,
                        "reference": HOSTILE}
                for name, query, content in self.prints("intersections", body):
                    with self.subTest(f"{label} {surfaces} {query}"):
                        self.check(name, content)

    def test_holes(self):
        for label, body in examples("holes").items():
            for name, query, content in self.prints("holes", {**body, "reference": HOSTILE}):
                with self.subTest(f"{label} {query}"):
                    self.check(name, content)


if __name__ == "__main__":
    main()
