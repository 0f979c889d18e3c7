"""The G-code by a reader of its own: where each block ends, at what speed, and that nothing lights the torch unasked."""

import itertools
import json
import math
import re

from service import HOSTILE, FormatTest, examples, main, seam_row

WORD = re.compile(r"([A-Z])(-?\d+\.\d+)")
TIMED = re.compile(r"^G1 (.*) F\[#<speed_mm_min> / (\d+\.\d+)\]$")


def moves(program):
    """[({axis: value}, length or None)], comments left out; refuses blocks that are neither moves nor modes."""
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
    return out


class Gcode(FormatTest):
    def program(self, body, more=""):
        return self.service.text("bevel-tables", body, f"format=gcode&speed_mm_min=600{more}").decode("ascii")

    def test_ends_on_the_torch_line_at_one_speed_on_the_wall(self):
        for name, body in examples("bevel-tables").items():
            with self.subTest(name):
                answer = self.service.answer("bevel-tables", body)
                table = answer["result"]["points"]
                sign = -1 if answer["result"]["b_sign"] == "inward" else 1
                wanted = list(zip(seam_row(table["phi_deg"], table["torch_outer_mm"]), seam_row(table["phi_deg"], table["b_deg"])))
                got = moves(self.program(body))
                self.assertEqual(len(got), len(wanted))
                for (axes, _), ((phi, z), (_, b)) in zip(got, wanted):
                    self.assertAlmostEqual(axes["A"], phi, delta=1e-6)
                    self.assertAlmostEqual(axes["X"], z, delta=1e-4)
                    self.assertAlmostEqual(axes["B"], sign * b, delta=1e-5)
                if "target" not in body:
                    continue
                radius = body["target"]["outer_diameter_mm"] / 2
                for (a, _), (b, length) in zip(got, got[1:]):
                    step = math.hypot(radius * math.radians(b["A"] - a["A"]), b["X"] - a["X"])
                    if step > 2e-3:
                        self.assertAlmostEqual(length, step, delta=1e-4)

    def test_a_pivot_moves_both_linear_axes_and_the_tip_stays(self):
        body = examples("bevel-tables")["source-000-table-1"]
        tip = moves(self.program(body))
        for axial, across in (("X", "Z"), ("Z", "X")):
            for (axes, _), (at, _) in zip(moves(self.program(body, f"&pivot_length_mm=150&axial={axial.lower()}")), tip):
                b = math.radians(axes["B"])
                self.assertAlmostEqual(axes[axial] - 150 * math.sin(b), at["X"], delta=1e-4)
                self.assertAlmostEqual(axes[across] - 150 * math.cos(b), 35, delta=1e-4)

    def test_nothing_lights_the_torch_unasked(self):
        body = {**examples("bevel-tables")["source-000-table-1"], "reference": HOSTILE}
        for dialect, on, off in (("linuxcnc", "M3 S1", "M5"), ("qtplasmac", "M3 $0 S1", "M5 $0")):
            dark = self.program(body, f"&dialect={dialect}").splitlines()
            self.assertFalse([line for line in dark if re.search(r"M0?[34]\b", line) and not line.startswith("(")])
            lit = self.program(body, f"&dialect={dialect}&torch=on&lead_mm=5").splitlines()
            self.assertEqual(lit.count(on), 1)
            self.assertLess(lit.index(on), lit.index("G93"))
            self.assertGreater(lit.index(off), lit.index("G93"))
            self.assertIn("(THIS PROGRAM LIGHTS THE TORCH)", lit)
            moves("\n".join(dark))

    def test_the_run_in_comes_from_the_scrap_side(self):
        body = examples("bevel-tables")["source-000-table-1"]
        (start, _), (first, length), *_ = moves(self.program(body, "&lead_mm=5"))
        self.assertAlmostEqual(first["X"] - start["X"], 5, delta=1e-4)
        self.assertAlmostEqual(length, 5, delta=1e-6)
        self.assertEqual((first["A"], first["B"]), (start["A"], start["B"]))

    def test_header_names_hash_reference_and_units(self):
        body = {**examples("bevel-tables")["source-000-table-1"], "reference": {"part": "B1", "order": "4711"}}
        program = self.program(body)
        sha = self.service.answer("bevel-tables", body)["job"]["input_sha256"]
        for word in (f"(input sha256 {sha})", "(part: B1)", "(order: 4711)", "(units mm, deg, mm/min)", "(tool: torch, kerf"):
            self.assertIn(word, program)

    def test_a_speed_must_be_named(self):
        status, _, content = self.service.ask("bevel-tables", examples("bevel-tables")["source-000-table-1"], "format=gcode")
        self.assertEqual(status, 400)
        self.assertIn(b"speed_mm_min", content)


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
                blocks = [line for line in program.splitlines() if line.startswith(("G0 ", "G1 "))]
                ends, period = [0], result["period_us"] * 1e-6
                for line in blocks[1:]:
                    minutes = 1 / float(re.search(r"F([\d.]+)$", line)[1])
                    took = minutes * 60 / period
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
        self.assertNotRegex(self.service.text("pulse-schedules", mill, "format=gcode&torch=on").decode(), r"(?m)^M[345]\b")


if __name__ == "__main__":
    main()
