"""The G-code by a reader of its own: where each block ends, at what speed, and that nothing lights the torch unasked."""

import itertools
import json
import math
import re

from service import HOSTILE, FormatTest, cutout_name, cutout_points, cutouts, examples, main, seam_row

WORD = re.compile(r"([A-Z])(-?\d+\.\d+)")
TIMED = re.compile(r"^G1 (.*) F\[#<speed_mm_min> / (\d+\.\d+)\]$")


def moves(program):
    """[({axis: value}, length or None)], as `standing` has them; refuses blocks that are neither moves nor modes."""
    out = []
    for line in program.splitlines():
        if line.startswith("("):
            if line.count("(") != 1 or line.count(")") != 1 or not line.endswith(")") or len(line) > 250:
                raise AssertionError(f"comment: {line!r}")
        elif line.startswith(("G0 ", "G1 ")):
            timed = TIMED.match(line)
            if line.startswith("G1 ") and not timed:
                raise AssertionError(f"no time: {line!r}")
            out.append(({a: float(v) for a, v in WORD.findall(timed[1] if timed else line[3:])}, float(timed[2]) if timed else None))
        elif not re.fullmatch(r"%|#<speed_mm_min> = [\d.]+|(?:[GTM]\d+(?: |$)|P[\d.]+ ?|H0 ?|\$0 ?|S1 ?)+", line):
            raise AssertionError(f"block: {line!r}")
    return standing(out)


def standing(blocks):
    """The moves with every axis said, and before each run of them where the rapids have left the machine."""
    out, at, arrived = [], {}, False
    for words, length in blocks:
        if length is not None and not arrived:
            out.append((at, None))
        at, arrived = {**at, **words}, length is not None
        if arrived:
            out.append((at, length))
    return out


def at_rows(got, rows):
    """The moves that end at the rows (phi, b), each in its order; others may end between."""
    out = []
    for move in got:
        if len(out) < len(rows) and abs(move[0]["A"] - rows[len(out)][0]) < 1e-6 and abs(move[0]["B"] - rows[len(out)][1]) < 1e-5:
            out.append(move)
    if len(out) < len(rows):
        raise AssertionError(f"no move ends at row {len(out)}: {rows[len(out)]}")
    return out


# Values that a program that lights the torch needs, by the control of its height.
LIT = {"linuxcnc": "&torch=on&lead_mm=5&pivot_length_mm=150&pierce_height_mm=3&pierce_delay_s=0.5&cut_height_mm=1.5",
       "qtplasmac": "&dialect=qtplasmac&torch=on&lead_mm=5"}


class Gcode(FormatTest):
    def program(self, body, more=""):
        return self.service.text("bevel-tables", body, f"format=gcode&speed_mm_min=600{more}").decode("ascii")

    def test_ends_on_the_torch_line_at_one_speed_on_the_wall(self):
        for name, body in examples("bevel-tables").items():
            if "dihedral" in body:  # as published: for comparison only
                continue
            with self.subTest(name):
                answer = self.service.answer("bevel-tables", body)
                table = answer["result"]["points"]
                # Across the seam both edges are straight, so tan B is.
                slopes = seam_row(table["phi_deg"], [math.tan(math.radians(b)) for b in table["b_deg"]])
                wanted = list(zip(seam_row(table["phi_deg"], table["torch_outer_mm"]), [(phi, math.degrees(math.atan(t))) for phi, t in slopes]))
                got = moves(self.program(body))
                rows = at_rows(got, [(phi, b) for (phi, _), (_, b) in wanted])
                self.assertEqual((got[0], got[-1]), (rows[0], rows[-1]))
                for (axes, _), ((phi, z), (_, b)) in zip(rows, wanted):
                    self.assertAlmostEqual(axes["A"], phi, delta=1e-6)
                    self.assertAlmostEqual(axes["X"], z, delta=1e-4)
                    self.assertAlmostEqual(axes["B"], b, delta=1e-5)
                if "target" not in body:
                    continue
                radius = body["target"]["outer_diameter_mm"] / 2
                for (a, _), (b, length) in zip(got, got[1:]):
                    step = math.hypot(radius * math.radians(b["A"] - a["A"]), b["X"] - a["X"])
                    if step > 2e-3:
                        self.assertAlmostEqual(length, step, delta=1e-4)

    def test_a_pivot_moves_both_linear_axes_and_the_tip_stays(self):
        body = examples("bevel-tables")["source-000-table-1"]
        table = self.service.answer("bevel-tables", body)["result"]["points"]
        rows = seam_row(table["phi_deg"], table["b_deg"])
        tip = at_rows(moves(self.program(body)), rows)
        for axial, across in (("X", "Z"), ("Z", "X")):
            pivot = at_rows(moves(self.program(body, f"&pivot_length_mm=150&axial={axial.lower()}")), rows)
            for (axes, _), (at, _) in zip(pivot, tip, strict=True):
                b = math.radians(axes["B"])
                self.assertAlmostEqual(axes[axial] - 150 * math.sin(b), at["X"], delta=1e-4)
                self.assertAlmostEqual(axes[across] - 150 * math.cos(b), 35, delta=1e-4)

    def test_nothing_lights_the_torch_unasked(self):
        body = {**examples("bevel-tables")["source-000-table-1"], "reference": HOSTILE}
        for dialect, on, off in (("linuxcnc", "M3 S1", "M5"), ("qtplasmac", "M3 $0 S1", "M5 $0")):
            dark = self.program(body, f"&dialect={dialect}").splitlines()
            self.assertFalse([line for line in dark if re.search(r"M0?[34]\b", line) and not line.startswith("(")])
            lit = self.program(body, LIT[dialect]).splitlines()
            self.assertEqual(lit.count(on), 1)
            self.assertLess(lit.index(on), lit.index("G93"))
            self.assertGreater(lit.index(off), lit.index("G93"))
            self.assertIn("(THIS PROGRAM LIGHTS THE TORCH)", lit)
            moves("\n".join(dark))

    def test_header_names_hash_reference_and_units(self):
        body = {**examples("bevel-tables")["source-000-table-1"], "reference": {"part": "B1", "order": "4711"}}
        program = self.program(body)
        sha = self.service.answer("bevel-tables", body)["job"]["input_sha256"]
        for word in (f"(input sha256 {sha})", "(part: B1)", "(order: 4711)", "(units mm, deg, mm/min)", "(tool: torch, kerf"):
            self.assertIn(word, program)

    def test_the_header_says_what_the_program_does(self):
        """The way of X, the time and the length against the blocks; the side A turns to against where each row's line must come to lie."""
        body = examples("bevel-tables")["source-000-table-1"]
        program = self.program(body, LIT["linuxcnc"].replace("&torch=on", ""))
        timed = [(float(re.search(r"X(-?[\d.]+)", line)[1]), float(TIMED.match(line)[2])) for line in program.splitlines() if TIMED.match(line)]
        least, most = map(float, re.search(r"^\(X from (-?[\d.]+) to (-?[\d.]+) mm while cutting\)$", program, re.M).groups())
        self.assertAlmostEqual(least, min(x for x, _ in timed), delta=0.0051)
        self.assertAlmostEqual(most, max(x for x, _ in timed), delta=0.0051)
        length, time = map(float, re.search(r"^\(1 cut, ([\d.]+) mm in ([\d.]+) s ", program, re.M).groups())
        cut = sum(way for _, way in timed)  # the first goes from pierce to cutting height
        self.assertAlmostEqual(length, cut, delta=0.01)
        self.assertAlmostEqual(time, cut / 600 * 60 + 0.5, delta=0.051)
        # At A = phi the line phi lies under the torch, for example at +x: as A grows from 0 the line 1 deg comes there
        # from +y, against x to y. Seen from the cut into the tube, along +z, x to y is clockwise: so the tube turns
        # counter-clockwise.
        self.assertIn("growing A turns the tube counter-clockwise, seen from the cut)", program)
        for word in ("(feed 600 mm/min on the outer wall)", "(tube 70 x 5 mm)", "(X0: the work point, z 0, +X: from the cut into the kept tube)"):
            self.assertIn(word, program)

    def test_a_speed_must_be_named(self):
        status, _, content = self.service.ask("bevel-tables", examples("bevel-tables")["source-000-table-1"], "format=gcode")
        self.assertEqual(status, 400)
        self.assertIn(b"speed_mm_min", content)


class PartGcode(FormatTest):
    """A whole part: each cut of its sequence on its torch line, the torch put out between them."""

    def cuts(self, result):
        """[(name, [(phi, z, b, a)])] in the order of the sequence."""
        out = []
        for step in result["sequence"]:
            if step["what"] == "hole":
                p = result["holes"][step["index"]]["points"]
                rows = list(zip(p["torch_phi_deg"], p["torch_z_mm"], p["b_deg"], p.get("a_deg") or [0] * len(p["b_deg"])))
                out.append((f"hole {step['index']}", rows + rows[:1]))
            elif step["what"] == "cutout":
                p = cutout_points(result, step["index"])
                rows = list(zip(p["torch_phi_deg"], p["torch_z_mm"], p["b_deg"], p["a_deg"]))
                out.append((cutout_name(*cutouts(result)[step["index"]]), rows + rows[:1]))
            elif step["what"] in ("finish", "start"):
                p = result["ends"][step["what"]]["points"]
                rows = [(phi, z, b, 0) for (phi, z), (_, b) in
                        zip(seam_row(p["phi_deg"], p["torch_outer_mm"]), seam_row(p["phi_deg"], p["b_deg"]))]
                out.append((step["what"], rows))
        return out

    def bodies(self):
        for name, body in examples("parts").items():
            yield name, body
            if "holes" in body and "preset" not in body:  # a preset sets the torch's tilt
                tilted = [{**hole, "tilt": "free"} for hole in body["holes"]]
                yield name + ", torch tilting across", {**body, "holes": tilted}

    def test_each_cut_in_its_order(self):
        holes = tilted = 0
        for name, body in self.bodies():
            with self.subTest(name):
                result = self.service.answer("parts", body)["result"]
                blocks = re.split(r"(?m)^\(cut: ", self.program(body))
                wanted = self.cuts(result)
                self.assertEqual([block.split(")")[0].split(" for ")[0] for block in blocks[1:]], [cut for cut, _ in wanted])
                for block, (cut, rows) in zip(blocks[1:], wanted):
                    lines = block.splitlines()[1:]
                    self.assertEqual(lines.count("M5"), 1)
                    got = moves("\n".join(line for line in lines if line != "M2"))
                    for (axes, _), (phi, z, b, a) in zip(at_rows(got, [(phi, b) for phi, _, b, _ in rows]), rows):
                        self.assertAlmostEqual(axes["A"], phi, delta=1e-6)
                        self.assertAlmostEqual(axes["X"], z, delta=1e-4)
                        self.assertAlmostEqual(axes["B"], b, delta=1e-5)
                        self.assertAlmostEqual(axes.get("C", 0), a, delta=1e-5)
                    holes += cut.startswith("hole")
                    tilted += any(abs(a) > 1 for _, _, _, a in rows)
        self.assertGreater(holes, 0)
        self.assertGreater(tilted, 0)

    def test_a_pivot_stands_on_the_torch_line(self):
        name, body = [each for each in self.bodies() if "across" in each[0]][0]
        radius = body["members"][0]["outer_diameter_mm"] / 2
        rows = [(phi, b) for _, cut in self.cuts(self.service.answer("parts", body)["result"]) for phi, _, b, _ in cut]
        # Growing phi is along x outwards: with the tube along X that is X x Z = -Y, along Z it is Z x X = +Y.
        for along, out, side in (("X", "Z", -1), ("Z", "X", 1)):
            option = f"&axial={along.lower()}"
            tip = at_rows(moves(self.program(body, option)), rows)
            pivot = at_rows(moves(self.program(body, "&pivot_length_mm=150" + option)), rows)
            for (t, _), (p, _) in zip(tip, pivot, strict=True):
                rise, across = math.tan(math.radians(t["B"])), math.tan(math.radians(t["C"]))
                size = math.sqrt(1 + rise**2 + across**2)
                self.assertAlmostEqual(p[along] - t[along], 150 * rise / size, delta=1e-4)
                self.assertAlmostEqual(p["Y"], side * 150 * across / size, delta=1e-4)
                self.assertAlmostEqual(p[out], radius + 150 / size, delta=1e-4)

    def program(self, body, more=""):
        return self.service.text("parts", body, f"format=gcode&speed_mm_min=600{more}").decode("ascii")

    def test_a_dry_run_stays_dark(self):
        for name, body in self.bodies():
            self.assertNotRegex(self.program({**body, "reference": HOSTILE}), r"(?m)^M0?[34]\b")
            self.assertIn("control must lift", self.program(body))


class ScheduleGcode(FormatTest):
    """Straight moves, uniform in time, against the integer pulses of the JSON answer."""

    LETTER = re.compile(r"^\(([A-Z]) = axis (\w+), (deg|mm)\)$", re.M)

    def axes_of(self, body, result):
        machines = {m["machine"]["name"]: m["machine"] for m in json.loads(self.service.get("/v1/machines"))["machines"]}
        machine = machines[body["machine"]] if isinstance(body["machine"], str) else body["machine"]
        per_unit = {a["name"]: a.get("pulses_per_unit") or a["pulses_per_turn"] / 360 for a in machine["axes"]}
        return {name: (result["start"][name], per_unit[name], result["counts"].get(name)) for name in result["start"]}

    def test_every_period_within_a_pulse(self):
        for name, body in examples("pulse-schedules").items():
            with self.subTest(name):
                result = self.service.answer("pulse-schedules", body)["result"]
                program = self.service.text("pulse-schedules", body, "format=gcode").decode("ascii")
                letters = {axis: letter for letter, axis, _ in self.LETTER.findall(program)}
                self.assertEqual(len(set(letters.values())), len(result["start"]))
                blocks = [line for line in program.splitlines() if line.startswith(("G0 ", "G1 ", "G4 "))]
                if blocks[1].startswith("G0 "):  # of a part: first off the tube, only by the height
                    self.assertRegex(blocks.pop(0), r"^G0 Z-?[\d.]+$")
                ends, period = [0], result["period_us"] * 1e-6
                for i, line in enumerate(blocks[1:], 1):
                    if line.startswith("G4 "):  # it stays where it is
                        took, blocks[i] = float(line[4:]) / period, blocks[i - 1]
                    else:
                        took = 60 / float(re.search(r"F([\d.]+)$", line)[1]) / period
                    self.assertAlmostEqual(took, round(took), delta=0.02 * max(1, took / 100))
                    ends.append(ends[-1] + round(took))
                self.assertEqual(ends[-1], result["periods"])
                self.assertLessEqual({e["period"] for e in result["events"]}, set(ends))
                for axis, (start, per_unit, counts) in self.axes_of(body, result).items():
                    sums = [0, *itertools.accumulate(counts)] if counts else [0] * (result["periods"] + 1)
                    at = [float(re.search(letters[axis] + r"(-?[\d.]+)", line)[1]) for line in blocks]
                    for value, end in zip(at, ends):
                        self.assertAlmostEqual(value, start + sums[end] / per_unit, delta=1e-6)
                    worst = 0.0
                    for a, b in zip(ends, ends[1:]):
                        for p in range(a, b):
                            worst = max(worst, abs(sums[a] + (sums[b] - sums[a]) * (p - a) / (b - a) - sums[p]))
                    self.assertLessEqual(worst, 1.0 + 1e-9, axis)
                print(f"{name}: {result['periods']} periods in {len(blocks) - 1} moves")

    def test_the_torch_is_lit_at_its_event_and_only_when_asked(self):
        body = examples("pulse-schedules")["table-1-on-the-five-axis-cutter"]
        dark = self.service.text("pulse-schedules", body, "format=gcode").decode()
        self.assertNotRegex(dark, r"(?m)^M[34]\b")
        lit = self.service.text("pulse-schedules", body, "format=gcode&torch=on").decode().splitlines()
        self.assertEqual(lit.count("M3 S1"), 1)
        self.assertLess(lit.index("M3 S1"), next(i for i, line in enumerate(lit) if line.startswith("G1")))
        self.assertGreater(lit.index("M5"), max(i for i, line in enumerate(lit) if line.startswith("G1")))
        mill = examples("pulse-schedules")["source-001-mill-path"]
        self.assertNotRegex(self.service.text("pulse-schedules", mill, "format=gcode").decode(), r"(?m)^M[345]\b")
        status, _, problem = self.service.ask("pulse-schedules", mill, "format=gcode&torch=on")
        self.assertEqual((status, json.loads(problem)["errors"][0]["pointer"]), (422, "?torch"))  # a mill has no torch


if __name__ == "__main__":
    main()
