"""Countersinks in the files of drawn parts: the solid of STEP, the edges of DXF, the lines of NC1; and slits as solids."""

import json
import math
import random

import step_reader
import step_volume
from dxf_test import polylines, read
from service import FormatTest, drawing_seed, main

PARTS = 12


def drawn(rng, round_tube):
    wall = rng.uniform(2, 6)
    hole = rng.uniform(4, 12)
    sink = {"diameter_mm": hole + rng.uniform(1, 14), "angle_deg": rng.uniform(40, 110)}
    target = {"outer_diameter_mm": rng.uniform(60, 150), "wall_mm": wall} if round_tube else {
        "kind": "rectangular_tube", "height_mm": 120, "width_mm": 80, "wall_mm": wall, "corners": "en_10219"}
    place = {"phi_deg": rng.uniform(0, 360)} if round_tube else {"face": rng.randint(1, 4), "offset_mm": rng.uniform(-4, 4)}
    return {"target": {**target, "length_mm": 500}, "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
            "kerf_mm": rng.choice([0, 1]), "torch": {"min_deg": -70, "max_deg": 70},
            "cutouts": [{"id": "bolt", "shape": {"kind": "circle", "diameter_mm": hole}, "wall": rng.choice(["normal", "through"]),
                         "at": {"z_mm": 150, **place}, "countersink": sink,
                         "pattern": {"kind": "linear", "count": 3, "pitch_mm": 60}}]}


class Countersinks(FormatTest):
    def each(self):
        rng, made = random.Random(drawing_seed()), 0
        while made < PARTS:
            body = drawn(rng, made % 2 == 0)
            status, _, content = self.service.ask("parts", body)
            if status == 200:
                made += 1
                with self.subTest(json.dumps(body)):
                    yield body, json.loads(content)["result"]

    def test_step_is_one_solid_with_the_answers_volume(self):
        solids, lands, worst = 0, 0, 0.0
        for body, result in self.each():
            for view in ("smooth", "straight"):
                status, _, content = self.service.ask("parts", body, f"format=step&view={view}")
                if status == 422 and b"does not go all round" in content:
                    continue
                self.assertEqual(status, 200, content[:300])
                solid = step_reader.Solid(step_reader.File(content.decode("ascii")))
                openings = sum(len(group["instances"]) for group in result["cutouts"] if group["wall"] != "countersink")
                self.assertEqual(step_reader.faults(solid, 1 + openings), [])
                wanted = result["lengths"]["volume_mm3"]
                worst = max(worst, abs(step_volume.volume(solid) / wanted - 1))
                solids += 1
                lands += max(group["countersink"]["land_mm"] for group in result["cutouts"] if "countersink" in group) > 0
        print(f"{solids} solids, {lands} with lands: volume within {worst:.1e}")
        self.assertLess(worst, 2e-6)
        self.assertGreater(solids, PARTS)
        self.assertGreater(lands, 2)

    def test_dxf_has_the_edges_of_the_cone_and_both_torch_lines(self):
        for body, result in self.each():
            drawing = read(self.service.text("parts", body, "format=dxf&view=tube"))
            edges = [points for points, _ in polylines(drawing, "CUT_OUTER")]
            cones = [group for group in result["cutouts"] if group["wall"] == "countersink"]
            self.assertEqual(len(cones), 1)
            bolts = sum(len(group["instances"]) for group in result["cutouts"] if group["wall"] != "countersink")
            self.assertEqual(len(edges), 2 + bolts)
            self.assertEqual(len(polylines(drawing, "TORCH")), 2 + bolts + len(cones[0]["instances"]))
            reach = body["cutouts"][0]["countersink"]["diameter_mm"]
            for instance in cones[0]["instances"]:
                tall = [line for line in edges if abs(max(p[2] for p in line) - instance["z_mm"] - reach / 2) < 1e-6]
                self.assertEqual(len(tall), 1)

    def test_slits_are_solids_with_the_answers_volume(self):
        for body, _ in self.each():
            round_tube, one = "outer_diameter_mm" in body["target"], body["cutouts"][0]
            del one["countersink"]
            one |= {"shape": {"kind": "slit", "length_mm": 20, "angle_deg": 50}, "tilt": "free"} if round_tube else {
                "shape": {"kind": "slit", "length_mm": 20, "angle_deg": 50, "pierce": "end"}}
            body["kerf_mm"] = 1.5
            result = self.service.answer("parts", body)["result"]
            solid = step_reader.Solid(step_reader.File(self.service.text("parts", body, "format=step").decode("ascii")))
            self.assertEqual(step_reader.faults(solid, 1 + sum(len(group["instances"]) for group in result["cutouts"])), [])
            self.assertAlmostEqual(step_volume.volume(solid) / result["lengths"]["volume_mm3"], 1, delta=1e-6)

    def test_nc1_states_each_and_bores_its_circle(self):
        for body, result in self.each():
            text = self.service.text("parts", body, "format=nc1").decode("ascii")
            sides = sum(len(group["instances"]) for group in result["cutouts"] if group["wall"] != "countersink")
            self.assertEqual(text.count("\r\nBO\r\n"), sides)
            stated = [line for line in text.splitlines() if "** countersink of bolt" in line]
            self.assertEqual(len(stated), 3)
            sink = body["cutouts"][0]["countersink"]
            depth = (sink["diameter_mm"] - body["cutouts"][0]["shape"]["diameter_mm"]) / 2 / math.tan(math.radians(sink["angle_deg"] / 2))
            for line in stated:
                self.assertAlmostEqual(float(line.split(",")[-1].split()[0]), depth, places=8)


if __name__ == "__main__":
    main()
