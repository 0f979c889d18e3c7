"""Programs that a machinist would run: leads on the scrap side, pierces off the part, heights, rapids over the clearance; replayed by a
reader of its own, for the examples and parts drawn by a seed."""

import itertools
import json
import math
import os
import random
import re

import drawn_parts
import numpy as np
import torch_program
from service import FormatTest, cutout_points, drawing_seed, examples, main, seam_row
from torch_program import Fault

PARTS = int(os.environ.get("TUBECUT_PARTS", "20"))
PIVOT, PIERCE, HEIGHT, DELAY, LEAD, OVERCUT, PIERCE_B = 150.0, 4.0, 1.5, 0.4, 3.0, 5.0, 20.0
LIT = {"speed_mm_min": 600, "torch": "on", "lead_mm": LEAD, "pivot_length_mm": PIVOT, "pierce_height_mm": PIERCE, "pierce_delay_s": DELAY,
       "cut_height_mm": HEIGHT}
TOUCH = 0.02 + 0.1  # mm a lead may reach behind the line: rounding of the tangent, and chords that leave the curve


def query(options, **more):
    return "&".join(["format=gcode"] + [f"{name}={value}" for name, value in {**options, **more}.items() if value is not None])


class Wall(list):
    """A line on one unrolled wall, its pieces also as arrays, because every place of a program is held against all of them."""

    def __init__(self, points):
        super().__init__(points)
        at = np.array(points, dtype=float)
        self.a, self.b, self.way = at[:-1], at[1:], np.diff(at, axis=0)
        self.square = np.einsum("ij,ij->i", self.way, self.way)

    def above(self, point):
        """How many pieces pass over a place, seen along the tube."""
        x, y = point
        over = (self.a[:, 0] <= x) != (self.b[:, 0] <= x)
        a, way = self.a[over], self.way[over]
        return int(np.count_nonzero(a[:, 1] + way[:, 1] * (x - a[:, 0]) / way[:, 0] > y))


class Line:
    """One cut of an answer: its torch line on both walls, unrolled on the outer and inner radius."""

    def __init__(self, result, step, outer, wall):
        self.hole = step["what"] in ("hole", "cutout")
        self.outer, self.wall, self.inner = outer, wall, outer - wall
        if self.hole:
            p = result["holes"][step["index"]]["points"] if step["what"] == "hole" else cutout_points(result, step["index"])
            rows = list(zip(p["torch_phi_deg"], p["torch_z_mm"], p["b_deg"], p.get("a_deg") or [0.0] * len(p["b_deg"])))
            self.rows = rows + rows[:1]
        else:
            p = result["ends"][step["what"]]["points"]
            tangents = seam_row(p["phi_deg"], [math.tan(math.radians(b)) for b in p["b_deg"]])
            self.rows = [(phi, z, math.degrees(math.atan(t)), 0.0) for (phi, z), (_, t) in
                         zip(seam_row(p["phi_deg"], p["torch_outer_mm"]), tangents)]
        self.side = {"start": -1, "finish": 1}.get(step["what"])
        self.walls = [Wall([self.flat(row, depth) for row in self.rows]) for depth in (False, True)]
        self.length = sum(math.dist(a, b) for a, b in zip(self.walls[0], self.walls[0][1:]))

    def flat(self, at, deep):
        """(round, along) on the outer wall, or where the beam comes out of the inner one."""
        phi, z, b, a = at
        if not deep:
            return self.outer * math.radians(phi), z
        across, rise = math.tan(math.radians(a)), math.tan(math.radians(b))
        between = self.outer**2 - self.inner**2
        h = between / (self.outer + math.sqrt(max(0.0, self.outer**2 - (1 + across**2) * between)))
        return self.inner * (math.radians(phi) - math.atan2(h * across, self.outer - h)), z - h * rise

    def off(self, at):
        """mm from the torch line, whole turns apart."""
        (x, y), girth = self.flat(at, False), 2 * math.pi * self.outer
        if self.hole:
            return distance((x, y), self.walls[0])
        return min(distance((x % girth + turn * girth, y), self.walls[0]) for turn in (-1, 0, 1))

    def into_part(self, at):
        """How far the beam at a place reaches into the kept part, on either wall; negative: off it."""
        return max(self.depth(self.flat(at, deep), line, 2 * math.pi * (self.inner if deep else self.outer))
                   for deep, line in enumerate(self.walls))

    def depth(self, point, line, girth):
        if self.hole:
            far = distance(point, line)
            return -far if inside(point, line) else far
        x, y = (point[0] - line[0][0]) % girth + line[0][0], point[1]
        far = min(distance((x + turn * girth, y), line) for turn in (-1, 0, 1))
        kept = line.above((x, y)) % 2 == (1 if self.side > 0 else 0)
        return far if kept else -far


def distance(point, line):
    line = line if isinstance(line, Wall) else Wall(line)
    from_a = np.asarray(point) - line.a
    along = np.einsum("ij,ij->i", from_a, line.way)
    share = np.clip(np.divide(along, line.square, out=np.zeros_like(along), where=line.square > 0), 0, 1)
    return float(np.sqrt(np.min(np.sum((from_a - share[:, None] * line.way)**2, axis=1))))


def inside(point, line):
    return line.above(point) % 2 == 1


def joins(cut):
    """The place at which its lead meets a cut: the first of those nearest to where it says it starts, within what is rounded there."""
    phi, z, b = cut.start
    far = [max(abs(p.phi - phi) / 6e-4, abs(p.z - z) / (0.006 if abs(z) < 1e4 else 0.06), abs(p.b - b) / 6e-4) for p in cut.places]
    at = min(range(1, len(far)), key=far.__getitem__)
    if far[at] > 1.0:
        raise Fault(f"{cut.name} does not start at {cut.start}")
    return at


def check_cut(cut, line, near=1e-3):
    """From its start on the torch line for all its length and the overcut; the leads clear of the part, the pierce well in the scrap.
    How far off the line it is, mm."""
    places = [(p.phi, p.z, p.b, p.a) for p in cut.places]
    flat = [line.flat(at, False) for at in places]
    first = joins(cut)
    behind = list(itertools.accumulate((math.dist(a, b) for a, b in zip(flat[first:], flat[first + 1:])), initial=0.0))
    length = line.length + OVERCUT
    last = first + min(range(len(behind)), key=lambda i: abs(behind[i] - length))
    if abs(behind[last - first] - length) > near + 1e-6 * length:
        raise Fault(f"{cut.name} is {behind[last - first]:.4f} mm long, not {length:.4f}")
    middle = line.hole and line.into_part(places[0]) < -LEAD / 2  # and it ends behind the overcut
    if (first < 2 or last == len(places) - 1) and not middle:
        raise Fault(f"{cut.name} has no leads")
    for at in places[:first] + places[last + 1:]:
        if line.into_part(at) > TOUCH:
            raise Fault(f"{cut.name}: a lead is {line.into_part(at):.3f} mm in the part")
    if line.into_part(places[0]) > -0.2 * torch_program.SHORTEST:
        raise Fault(f"{cut.name}: the pierce is {-line.into_part(places[0]):.3f} mm off the part")
    off = max(map(line.off, places[first:last + 1]))
    if off > 1e-3:
        raise Fault(f"{cut.name} is {off:.4f} mm off its line")
    return off


class Leads(FormatTest):
    def bodies(self):
        for name, body in examples("parts").items():
            if "target" in body and "tube_laser" not in json.dumps(body):
                yield name, body
        seed = drawing_seed()
        dice = random.Random(seed)
        for i in range(PARTS):
            body = drawn_parts.part(dice)
            yield f"drawn {i}", {**body, "kerf_mm": round(dice.choice([0.0, 0.1]) * body["target"]["wall_mm"], 3)}

    def test_every_cut_of_a_part(self):
        cuts = holes = shortened = blocked = 0
        for name, body in self.bodies():
            status, _, content = self.service.ask("parts", body)
            if status != 200:
                continue
            result = json.loads(content)["result"]
            outer, wall = body["target"]["outer_diameter_mm"] / 2, body["target"]["wall_mm"]
            status, _, program = self.service.ask("parts", body, query(LIT, torch="off"))
            if status != 200:
                self.assertIn(b"would enter the part", program)
                blocked += 1
                continue
            program = program.decode("ascii")
            with self.subTest(f"{name} {json.dumps(body)}"):
                steps = [step for step in result["sequence"] if step["what"] != "mark"]
                found = torch_program.replay(program, outer, PIVOT)
                torch_program.check_heights(found, PIERCE, HEIGHT)
                self.assertEqual(len(found), len(steps))
                for cut, step in zip(found, steps):
                    line = Line(result, step, outer, wall)
                    self.check(cut, line)
                    cuts, holes = cuts + 1, holes + line.hole
                shortened += "has no room" in program
        print(f"{cuts} cuts, {holes} of them holes; leads shortened in {shortened} parts, {blocked} without room for any")
        self.assertGreater(cuts, PARTS)
        self.assertGreater(holes, 0)
        self.assertLess(blocked, 0.3 * PARTS + 2)

    def test_narrow_openings_and_windows_have_leads(self):
        """Each pierces within itself and stays there until it is on its line: by arcs, from the middle, or straight."""
        shapes = [{"kind": kind, **size, **more} for width in (3, 5, 8, 20) for length in (width, 10, 40) if length >= width for turn in (0, 90, 37)
                  for kind, size, more in (("slot", {"length_mm": length, "width_mm": width}, {"angle_deg": turn}),
                                           ("rectangle", {"along_mm": length, "round_mm": width}, {"angle_deg": turn}),
                                           ("rectangle", {"along_mm": length, "round_mm": width}, {"angle_deg": turn, "corners": "as_cut", "corner_radius_mm": 0}))]
        body = {"preset": "tube_laser", "target": {"outer_diameter_mm": 114.3, "wall_mm": 5, "length_mm": 60 * len(shapes) + 60},
                "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "sampling": {"tolerance_mm": 0.05},
                "cutouts": [{"id": str(k), "shape": shape, "at": {"z_mm": 60 * k + 60, "phi_deg": 30}} for k, shape in enumerate(shapes)]}
        for kerf in (0.3, 1.5):
            request = {**body, "kerf_mm": kerf}
            result = self.service.answer("parts", request)["result"]
            program = self.service.text("parts", request, query(LIT, torch="off", pivot_length_mm=0)).decode("ascii")
            steps = [step for step in result["sequence"] if step["what"] != "mark"]
            found = torch_program.replay(program, 57.15, 0)
            self.assertEqual(len(found), len(shapes) + 2)
            for cut, step in zip(found, steps):
                if step["what"] != "cutout":
                    continue
                with self.subTest(f"{cut.name} {shapes[int(cut.name.split()[-1])]} kerf {kerf}"):
                    line = Line(result, step, 57.15, 5)
                    places, first = [(p.phi, p.z, p.b, p.a) for p in cut.places], joins(cut)
                    self.assertLess(max(map(line.into_part, places[:first])), TOUCH)
                    self.assertLess(max(map(line.off, places[first:first + 4])), 2e-3)

    def test_windows_begin_on_a_side_and_bolt_holes_in_their_middle(self):
        """Whatever the corner radius, the lead that was asked for fits; a hole that it does not fit is pierced where it is widest."""
        windows = [{"kind": "rectangle", "along_mm": along, "round_mm": wide, "corner_radius_mm": radius, "angle_deg": turn}
                   for along, wide, turn in ((200, 80, 0), (100, 60, 0), (80, 60, 90)) for radius in (2, 3, 4, 5, 6, 8, 10)]
        holes = [{"kind": "circle", "diameter_mm": d} for d in (6, 8, 10, 12, 14)]
        shapes = windows + holes
        square = {"kind": "rectangular_tube", "height_mm": 120, "width_mm": 120, "corners": "en_10219"}
        for target, at in (({"outer_diameter_mm": 114.3}, {"phi_deg": 30}), (square, {"face": 1, "offset_mm": 0})):
            body = {"preset": "tube_laser", "target": {**target, "wall_mm": 5, "length_mm": 260 * len(shapes) + 260}, "kerf_mm": 1.5,
                    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "sampling": {"tolerance_mm": 0.05},
                    "cutouts": [{"id": str(k), "shape": shape, "wall": "developed", "at": {"z_mm": 260 * k + 260, **at}}
                                for k, shape in enumerate(shapes)]}
            program = self.service.text("parts", body, query(LIT, torch="off", pivot_length_mm=0)).decode("ascii")
            cuts = dict(re.findall(r"\(cut: cut-out (\d+)\)\n((?:\(.*\n|[^(].*\n)*?)(?=\(cut: )", program))
            self.assertEqual(len(cuts), len(shapes))
            for k, shape in enumerate(shapes):
                with self.subTest(f"{target} {shape}"):
                    self.assertNotIn("leads of", cuts[str(k)])
                    middle = "from the middle of the scrap" in cuts[str(k)]
                    self.assertFalse(middle and shape in windows)
                    self.assertTrue(middle or shape in windows or shape["diameter_mm"] > 10)

    def test_leads_of_windows_stay_off_the_window_that_was_drawn(self):
        """Its straight sides and arcs, not the rows: wherever the overcut ends, and however large the lead is against the corner."""
        dice, worst, middles, windows = random.Random(drawing_seed() + 4), -9.0, 0, 150
        for k in range(windows):
            shape, kerf, lead, overcut = drawn_parts.window(dice)
            tolerance = dice.choice([0.002, 0.01, 0.05])
            body = {"preset": "tube_laser", "target": {"outer_diameter_mm": 114.3, "wall_mm": 5, "length_mm": 400}, "kerf_mm": kerf,
                    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}}, "sampling": {"tolerance_mm": tolerance},
                    "cutouts": [{"id": "w", "shape": shape, "wall": "developed", "at": {"z_mm": 200, "phi_deg": 30}}]}
            options = {"speed_mm_min": 600, "lead_mm": lead, "overcut_mm": overcut, "pivot_length_mm": 0}
            with self.subTest(f"{options} {json.dumps(body)}"):
                program = self.service.text("parts", body, query(options)).decode("ascii")
                cut = torch_program.replay(program, 57.15, 0)[0]
                beyond = [drawn_parts.beyond_window(shape, p.z - 200, 57.15 * math.radians((p.phi + 150) % 360 - 180)) + kerf / 2 for p in cut.places]
                middles += "from the middle of the scrap" in program
                worst = max(worst, *beyond)
                self.assertLess(max(beyond), 0.02 + tolerance + 1e-3)
        print(f"{windows} windows, {middles} from the middle; at most {worst:.4f} mm beyond the edge")
        self.assertLess(middles, 0.4 * windows)

    def check(self, cut, line):
        check_cut(cut, line)
        flat = [line.flat((p.phi, p.z, p.b, p.a), False) for p in cut.places]
        self.assertEqual(cut.dwell, DELAY)
        for a, b, length in zip(flat[1:], flat[2:], cut.lengths[1:]):
            if math.dist(a, b) > 2e-3:
                self.assertAlmostEqual(length, math.dist(a, b), delta=1e-4)

    def test_the_lead_meets_the_cut_along_it(self):
        for name, body in examples("parts").items():
            if "target" not in body:
                continue
            result = self.service.answer("parts", body)["result"]
            outer, wall = body["target"]["outer_diameter_mm"] / 2, body["target"]["wall_mm"]
            for cut, step in zip(torch_program.replay(self.program(body), outer, PIVOT), [s for s in result["sequence"] if s["what"] != "mark"]):
                line = Line(result, step, outer, wall)
                places, first = [(p.phi, p.z, p.b, p.a) for p in cut.places], joins(cut)
                a, b, c = (line.flat(places[i], False) for i in (first - 1, first, first + 1))
                turn = math.degrees(math.atan2(c[1] - b[1], c[0] - b[0]) - math.atan2(b[1] - a[1], b[0] - a[0]))
                chord = 180 / len(line.rows) if step["what"] == "cutout" else 0  # between two rows of a small circle
                self.assertLess(abs((turn + 180) % 360 - 180), 6 + chord, f"{name} {cut.name}")

    def program(self, body, **more):
        answer = self.service.answer("parts", body)
        codes = sorted({w["code"] for w in answer["warnings"] if w["severity"] == "cut"})
        return self.service.text("parts", body, query(LIT, **({"acknowledge": ",".join(codes)} if codes else {}), **more)).decode("ascii")

    def lit(self):
        body = examples("parts")["table-1-with-a-square-far-end"]
        return body, body["target"]["outer_diameter_mm"] / 2

    def test_the_torch_burns_from_pierce_to_the_end_of_the_lead_out(self):
        body, outer = self.lit()
        cuts = torch_program.replay(self.program(body), outer, PIVOT)
        self.assertEqual([(cut.lit, cut.dwell) for cut in cuts], [(True, DELAY)] * 2)
        lines = self.program(body).splitlines()
        self.assertTrue(lines[-3].startswith("G0 Z"), "a retract at the end")

    def test_a_start_and_a_bevel_of_the_pierce_as_asked(self):
        body, outer = self.lit()
        swung = 0
        for cut in torch_program.replay(self.program(body, start_deg=50, pierce_b_deg=PIERCE_B, overcut_mm=0), outer, PIVOT):
            at = cut.places[joins(cut)]
            self.assertAlmostEqual(at.phi % 360, 50, delta=1e-6)
            self.assertAlmostEqual(cut.places[0].b, min(max(at.b, -PIERCE_B), PIERCE_B), delta=1e-6)
            swung += abs(at.b) > PIERCE_B
        self.assertEqual(swung, 1)

    def test_it_starts_off_the_seam_at_the_least_bevel_there_is(self):
        body, outer = self.lit()
        result = self.service.answer("parts", body)["result"]
        program = self.program(body)
        at = [(float(a), float(b)) for a, b in re.findall(r"^\(starts at A (-?[\d.]+), B (-?[\d.]+), -?[\d.]+ mm from X0\)$", program, re.M)]
        self.assertEqual(len(at), 2)
        for (phi, b), what in zip(at, ("finish", "start")):
            self.assertGreater(outer * math.radians(abs((phi + 180) % 360 - 180)), 5)
            self.assertLess(abs(b), min(abs(v) for v in result["ends"][what]["points"]["b_deg"]) + 8)

    def test_faults_are_seen(self):
        body, outer = self.lit()
        program = self.program(body)
        lines = program.splitlines()

        def fails(changed, text):
            with self.assertRaisesRegex(Fault, text):
                torch_program.check_heights(torch_program.replay("\n".join(changed), outer, PIVOT), PIERCE, HEIGHT)
        torch_program.check_heights(torch_program.replay(program, outer, PIVOT), PIERCE, HEIGHT)
        retracts = [i for i, line in enumerate(lines) if re.match(r"^G0 Z[\d.]+$", line) and float(line[4:]) > outer + PIVOT + 40]
        self.assertEqual(len(retracts), 3)
        fails(lines[:retracts[1]] + lines[retracts[1] + 1:], "a rapid at")
        fails(lines[:retracts[0]] + lines[retracts[0] + 1:], "no retract")
        fails(lines[:retracts[2]] + lines[retracts[2] + 1:], "left at the tube")
        moved = [re.sub(r" Z([\d.]+)", lambda m: f" Z{float(m[1]) + 0.05:.5f}", line) if line.startswith("G1") else line for line in lines]
        fails(moved, "cuts")
        lit_early = [line for line in lines if line != "M5"]
        fails(lit_early, "with the torch lit")
        # A sign of B: the tip is then off its line.
        result = self.service.answer("parts", body)["result"]
        wrong = torch_program.replay("\n".join(re.sub(r" B(-?)([\d.]+)", lambda m: f" B{'' if m[1] else '-'}{m[2]}", line) for line in lines), outer, PIVOT)
        line = Line(result, {"what": "start"}, outer, body["target"]["wall_mm"])
        self.assertGreater(max(line.off((p.phi, p.z, p.b, p.a)) for p in wrong[1].places), 10)

    def refused(self, body, **options):
        status, _, content = self.service.ask("parts", body, query(options))
        self.assertEqual(status, 400, content[:300])
        return [(issue["pointer"], issue["code"]) for issue in json.loads(content)["errors"]]

    def test_a_lit_program_says_all_that_it_lacks(self):
        body, _ = self.lit()
        missing = ["lead_mm", "pivot_length_mm", "pierce_height_mm", "pierce_delay_s", "cut_height_mm"]
        self.assertEqual(self.refused(body, torch="on", speed_mm_min=600), [(f"?{name}", "missing_field") for name in missing])
        self.assertEqual(self.refused(body, torch="on"), [(f"?{name}", "missing_field") for name in ["speed_mm_min", *missing]])
        self.assertEqual(self.refused(body, torch="on", speed_mm_min=600, dialect="qtplasmac"), [("?lead_mm", "missing_field")])
        for name in missing:
            self.assertEqual(self.refused(body, **{**LIT, name: None}), [(f"?{name}", "missing_field")])

    def test_what_has_no_use_is_refused(self):
        body, _ = self.lit()
        dry = {"speed_mm_min": 600}
        for name in ("overcut_mm", "pierce_b_deg", "pierce_height_mm", "cut_height_mm", "clearance_mm"):
            self.assertEqual(self.refused(body, **dry, **{name: 5}), [(f"?{name}", "unsupported_combination")])
        for name in ("pierce_height_mm", "pierce_delay_s", "cut_height_mm"):
            self.assertEqual(self.refused(body, **dry, dialect="qtplasmac", pivot_length_mm=150, **{name: 5}), [(f"?{name}", "unsupported_combination")])


if __name__ == "__main__":
    main()
