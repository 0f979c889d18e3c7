"""Tabs of a part's schedule, measured on its counts: the beam is put together from the axes' pulses, period by period, and every tab is as wide on both
walls as was requested, but for half a pulse of every axis on either side."""

import itertools
import json
import math
import os
import random

from service import ROOT, FormatTest, main

SCHEDULES = int(os.environ.get("TUBECUT_CASES", "16"))
NEAR = 4.0  # distance along a path, in widths of a tab and its kerf, beyond which points are not adjacent


class Beams:
    """Where the beam of a machine meets the outer and the inner wall, by lines and circles in the axial plane: [(s, z)] of each wall."""

    def __init__(self, machine, outer, wall, result):
        self.machine, self.walls = machine, (outer, outer - wall)
        self.axes = [a["name"] for a in machine["axes"]]
        self.units = {a["name"]: a.get("pulses_per_unit") or a["pulses_per_turn"] / 360 for a in machine["axes"]}
        self.sign = -1.0 if machine["b_positive"] == "outer_edge_to_waste" else 1.0
        self.values = {}
        for name in self.axes:
            sums = [0, *itertools.accumulate(result["counts"].get(name, []))]
            self.values[name] = [result["start"][name] + n / self.units[name] for n in sums] if len(sums) > 1 else [result["start"][name]] * (result["periods"] + 1)

    def at(self, period):
        q = {name: values[period] for name, values in self.values.items()}
        kind = self.machine["type"]
        rise = math.tan(math.radians(self.sign * q["B"]))  # mm along the tube for each mm outwards
        if kind == "five_axis_cutter":
            phi, height, z = q["C"], q["Z1"] + q["Z2"], q["Y"]
        elif kind == "crawler":
            phi, height, z = math.degrees(q["S"] / (self.walls[0] + self.machine["wheel_offset_mm"])), self.walls[0], q["E"]
        else:
            phi, height, z = q["C"], self.walls[0], q["Z"]
        return [(math.radians(phi) * rho, z + (rho - height) * rise) for rho in self.walls]

    def pulse(self, pivot):
        """What half a pulse of every axis moves an edge by, mm."""
        linear = sum(0.5 / self.units[name] for name in self.axes if name not in "CSB")
        turn = 0.5 / self.units.get("C", 1e9) * math.pi / 180 * self.walls[0] + 0.5 / self.units.get("S", 1e9)
        return linear + turn + 0.5 / self.units["B"] * math.pi / 180 * 4 * (pivot + self.walls[0] - self.walls[1])


def distance(p, a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    share = max(0.0, min(1.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy))) if dx or dy else 0.0
    return math.hypot(p[0] - a[0] - share * dx, p[1] - a[1] - share * dy)


def apart(one, other):
    return min(min(distance(p, a, b) for p in x for a, b in zip(y, y[1:])) for x, y in ((one, other), (other, one)))


def within(beams, periods, length):
    """The places of periods within so many mm of the first of them."""
    out, gone = [], 0.0
    for period in periods:
        place = beams.at(period)
        gone += math.dist(place[0], out[-1][0]) if out else 0.0
        out.append(place)
        if gone > length:
            break
    return out


def widths(beams, result, kerf, width):
    """mm of metal of every tab: {(cut, tab): least of both walls}."""
    cuts = {}
    for segment in result["segments"]:
        name, _, part = segment["name"].rpartition(", ")
        if segment["kind"] == "cut" and " of " in part:
            cuts.setdefault(name, []).append(segment)
    out, near = {}, NEAR * (width + kerf)
    for name, stretches in cuts.items():
        for k, (before, after) in enumerate(zip(stretches, stretches[1:] + stretches[:1])):
            lead = after.get("lead_radius_mm", 0.0) + 1.0
            end = within(beams, range(before["to"], before["from"] - 1, -1), near)
            start = within(beams, range(after["from"], after["to"] + 1), near + lead)
            least = math.inf
            for wall, rho in enumerate(beams.walls):
                girth = 2 * math.pi * rho
                turned = girth * round((end[0][wall][0] - start[0][wall][0]) / girth)
                least = min(least, apart([p[wall] for p in end], [(p[wall][0] + turned, p[wall][1]) for p in start]))
            out[name, k] = least - kerf
    return out


class TabWidth(FormatTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.machines = {m["machine"]["name"]: m["machine"] for m in json.loads(cls.service.get("/v1/machines"))["machines"]}

    def measured(self, body):
        """(least width less the requested one, tabs, what half a pulse on both sides is) or nothing if it is refused."""
        status, _, content = self.service.ask("pulse-schedules", body)
        self.assertLess(status, 500, content[:400])
        if status != 200:
            return None
        answer = json.loads(content)
        stated = next(c for c in answer["verification"]["checks"] if c["name"] == "tab_width")
        machine = self.machines[body["machine"]] if isinstance(body["machine"], str) else body["machine"]
        target = body["part"]["target"]
        beams = Beams(machine, target["outer_diameter_mm"] / 2, target["wall_mm"], answer["result"])
        width, kerf = body["motion"]["tabs"]["width_mm"], body["part"]["kerf_mm"]
        found = widths(beams, answer["result"], kerf, width)
        pulse = 2 * beams.pulse(machine.get("pivot_length_mm", 0.0))
        self.assertLess(stated["limit"], pulse + 1e-3)
        self.assertLessEqual(stated["value"], stated["limit"])
        return min(found.values()) - width, max(found.values()) - width, len(found), pulse

    def test_the_field_input(self):
        over, _, count, pulse = self.measured(json.loads((ROOT / "tests/field/tab-narrower.pulse-schedule.json").read_text()))
        print(f"{count} tabs, the least {over:+.4f} mm of what was requested, half a pulse of every axis {pulse:.4f}")
        self.assertEqual(count, 8)
        self.assertGreater(over, -1e-4)

    def machine(self, seeded):
        """A drawn machine: kind, pulses, limits of acceleration and jerk, sign of B."""
        machine = json.loads(json.dumps(self.machines[seeded.choice(("five_axis_cutter", "five_axis_cutter", "crawler", "generic"))])) | {"name": "drawn"}
        slow = seeded.choice((0.3, 1.0, 3.0))
        for axis in machine["axes"]:
            if "pulses_per_unit" in axis:
                axis["pulses_per_unit"] = seeded.choice((400, 1000, 5000))
            axis["a_max"] *= slow
            axis["j_max"] = seeded.choice((None, axis["j_max"] * slow, axis["j_max"] * 5))
        machine["b_positive"] = seeded.choice(("outer_edge_into_part", "outer_edge_to_waste"))
        return machine

    def test_drawn_schedules(self):
        seeded, tabs, worst, widest, answered = random.Random(17), 0, math.inf, 0.0, 0
        for _ in range(4 * SCHEDULES):
            if answered == SCHEDULES:
                break
            outer, wall = seeded.choice(((76.1, 5), (88.9, 10), (114.3, 8)))
            ends = [{"cutters": [{"kind": "tube", "outer_diameter_mm": outer * seeded.uniform(1, 2), "inclination_deg": seeded.uniform(45, 135),
                                  "clocking_deg": seeded.uniform(0, 360), "offset_mm": 0}], "root_surface": "inner", "groove": {"rule": rule},
                     "contact": "none", "smoothing": {"method": "none"}} for rule in (seeded.choice(("square", "half_dihedral")) for _ in range(2))]
            hole = {"branch": {"outer_diameter_mm": outer * seeded.uniform(0.5, 0.7), "wall_mm": 4, "inclination_deg": seeded.uniform(60, 120), "height_mm": 200,
                               "clocking_deg": seeded.uniform(0, 360)}, "joint": {"kind": seeded.choice(("set_on", "set_in")), "gap_mm": 1.0},
                    "groove": {"rule": seeded.choice(("square", "half_dihedral"))}, "tilt": "axial"}
            body = {"part": {"target": {"outer_diameter_mm": outer, "wall_mm": wall, "length_mm": 500}, "ends": {"start": ends[0], "finish": ends[1]},
                             "kerf_mm": 1.2, "sampling": {"tolerance_mm": 0.05}, "holes": [hole]}, "machine": self.machine(seeded),
                    "motion": {"speed": {"mm_min": seeded.choice((1500, 3200))}, "clearance_mm": 20, "pierce_height_mm": 4,
                               "eps_tip_mm": seeded.choice((0.02, 0.1, 0.3)), "eps_b_deg": seeded.choice((0.1, 0.5, 2)),
                               "tabs": {"count": seeded.randint(4, 6), "width_mm": seeded.choice((1.0, 1.5, 2.0)), "of": "all"}}}
            if seeded.random() < 0.7:
                body["motion"]["lead"] = {"radius_mm": 4}
            if body["machine"]["type"] != "five_axis_cutter":
                del body["motion"]["pierce_height_mm"], body["motion"]["clearance_mm"]
            found = self.measured(body)
            if found is None:
                continue
            over, wide, count, pulse = found
            answered, tabs, worst, widest = answered + 1, tabs + count, min(worst, over), max(widest, wide)
            with self.subTest(machine=body["machine"]["type"], motion=body["motion"]):
                self.assertGreater(over, -pulse)
        print(f"{answered} schedules, {tabs} tabs: the narrowest {worst:+.4f} mm, the widest {widest:+.4f} mm of what was requested")
        self.assertEqual(answered, SCHEDULES)
        self.assertGreater(tabs, 12 * SCHEDULES)


if __name__ == "__main__":
    main()
