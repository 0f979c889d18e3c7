"""A whole part that is not round by two printings of one program: G-code along its torch lines and pulses of a tube table. The same cuts in the
same order through the same places; the pulses are rebuilt here by formulas of their own."""

import itertools
import math
import random

import section_program_test as programs
from section_program_test import Outline, cuts_of, torch
from service import FormatTest, main

PIVOT, STANDOFF, CLEARANCE, PIERCE, DELAY, LEAD, SPEED = 120.0, 1.5, 30.0, 4.0, 0.2, 2.0, 1500.0
PLACE = 4e-5  # mm, of the fifth decimal that G-code prints, turned about a corner
TIP = 0.1  # mm, eps_tip_mm
PULSE = 0.01  # mm, what pulses and the bend of a corner's chords add


def table(swings):
    """A tube table that carries its torch on a pivot; without a swing the head is square."""
    def axis(name, unit, per, v, a, j):
        return {"name": name, "unit": unit, **per, "v_max": v, "a_max": a, "j_max": j}
    axes = [axis("A", "deg", {"pulses_per_turn": 360000}, 120, 900, 9000), *(axis(name, "mm", {"pulses_per_unit": 1000}, 150, 1500, 20000) for name in "XYZ")]
    if swings:
        axes.append(axis("B", "deg", {"pulses_per_unit": 1000}, 60, 500, 6000))
    return {"type": "tube_table", "name": "t", "period_us": 4000, "pivot_length_mm": PIVOT, "standoff_mm": STANDOFF, "b_positive": "outer_edge_into_part", "axes": axes}


def tips(result):
    """(x, y of the tip across the tube, z, its height over the axis) at the end of every period, the start first."""
    def values(axis):
        start = result["start"].get(axis, 0.0)
        counts = result["counts"].get(axis) or [0] * result["periods"]
        return [start + n / 1000 for n in itertools.accumulate(counts, initial=0)]
    out = []
    for a, x, y, z, b in zip(*map(values, "AXYZB")):
        up, over = math.radians(-a), z - (PIVOT + STANDOFF) * math.cos(math.radians(b))
        out.append((over * math.cos(up) - x * math.sin(up), over * math.sin(up) + x * math.cos(up),
                    y - (PIVOT + STANDOFF) * math.sin(math.radians(b)), over))
    return out


def apart(a, b, girth):
    return abs((a - b + girth / 2) % girth - girth / 2)


class SectionSchedule(FormatTest):
    def job(self, dice, k):
        part = programs.SectionProgram.part(dice, k)
        square = "preset" in part
        part["cutouts"].append({"id": "over", "shape": {"kind": "circle", "diameter_mm": 11}, "wall": ["normal", "developed"][k // 2 % 2],
                                "tilt": "none" if square else ["free", "axial"][k % 2], "at": {"z_mm": 520, "girth_mm": 24 + 3 * math.pi / 2}})
        part["texts"] = [{"id": "t", "at": {"z_mm": 180, "face": 1, "offset_mm": -3}, "text": "K4", "height_mm": 6}]
        motion = {"speed": {"mm_min": SPEED}, "lead": {"radius_mm": LEAD}, "clearance_mm": CLEARANCE, "pierce_height_mm": PIERCE, "pierce_delay_s": DELAY,
                  "marks": {"speed_mm_min": 3000}}
        return {"part": part, "machine": table(not square), "motion": motion}

    def test_gcode_and_pulses_go_through_the_same_places(self):
        dice, bevelled = random.Random(31), 0
        for k in range(8):
            job = self.job(dice, k)
            answer = self.service.answer("pulse-schedules", job)
            self.assertTrue(answer["verification"]["passed"])
            result, s = answer["result"], self.service.answer("parts", job["part"])["result"]["section"]
            outline, girth = Outline(s["height_mm"], s["width_mm"], s["corner_radius_mm"]), s["girth_mm"]
            program = self.service.text("parts", job["part"], f"format=gcode&speed_mm_min={SPEED}&lead_mm={LEAD}&pivot_length_mm={PIVOT}&cut_height_mm={STANDOFF}"
                                        f"&pierce_height_mm={PIERCE}&pierce_delay_s={DELAY}&clearance_mm={CLEARANCE}").decode("ascii")
            cuts, at = [one for one in result["segments"] if one["kind"] == "cut"], tips(result)
            printed = cuts_of(program)
            self.assertEqual(len(printed), len(cuts))
            for (title, blocks), cut in zip(printed, cuts):
                self.assertTrue(title.startswith(f"(cut: {cut['name']}"), f"{title} {cut['name']}")
                self.places(cut, [torch(place, PIVOT + STANDOFF) for place in blocks], outline, girth)
                self.follows(cut, at, blocks, outline)
                bevelled += any(abs(b) > 1 for b in cut["way"]["b_deg"])
        self.assertGreater(bevelled, 2)

    def places(self, cut, torches, outline, girth):
        """Every place of the schedule's way is one of the program's, in their order."""
        laid = [(outline.foot(x, y)[2], z, b) for x, y, z, b, _ in torches]
        rest = iter(laid)
        way = list(zip(*(cut["way"][name] for name in ("girth_mm", "z_mm", "b_deg"))))
        for s, z, b in way:
            found = next((p for p in rest if apart(p[0], s, girth) < PLACE and abs(p[1] - z) < PLACE and abs(p[2] - b) < 1e-4), None)
            self.assertIsNotNone(found, f"{cut['name']}: {s}, {z}, {b}")

    def follows(self, cut, at, blocks, outline):
        """The tip of the pulses keeps to the program's moves, and to the outside."""
        line = [torch(place, PIVOT + STANDOFF)[:3] for place in blocks]
        allowed, near, worst = TIP + cut["report"]["sag_mm"] + PULSE, 0, 0.0
        for x, y, z, _ in at[cut["from"]:cut["to"] + 1:5]:
            self.assertLess(abs(outline.foot(x, y)[0]), 0.05, cut["name"])
            pieces = range(max(0, near - 30), min(len(line) - 1, near + 60))
            off, near = min((self.off((x, y, z), line[i], line[i + 1]), i) for i in pieces)
            worst = max(worst, off)
        self.assertLess(worst, allowed, cut["name"])

    @staticmethod
    def off(p, a, b):
        way = [v - u for u, v in zip(a, b)]
        square = sum(w * w for w in way)
        share = max(0.0, min(1.0, sum((q - u) * w for q, u, w in zip(p, a, way)) / square)) if square else 0.0
        return math.dist(p, [u + share * w for u, w in zip(a, way)])

    def test_nothing_but_the_height_moves_below_the_clearance_over_the_corners(self):
        dice = random.Random(3)
        for k in range(4):
            job = self.job(dice, k)
            result = self.service.answer("pulse-schedules", job)["result"]
            target = job["part"]["target"]
            corner = target["corner_radius_mm"]
            reach = math.hypot(target["height_mm"] / 2 - corner, target["width_mm"] / 2 - corner) + corner
            at, moved = tips(result), 0
            for segment in result["segments"]:
                for i in range(segment["from"], segment["to"] if segment["kind"] == "rapid" else 0):
                    if any(result["counts"].get(axis, [0] * (i + 1))[i] for axis in "AXYB"):
                        self.assertGreater(min(at[i][3], at[i + 1][3]), reach + CLEARANCE - STANDOFF - 0.01)
                        moved += 1
            self.assertGreater(moved, 100)


if __name__ == "__main__":
    main()
