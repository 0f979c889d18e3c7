"""A whole part by two printings of one program: G-code along its torch lines and pulses of the five-axis cutter. The same places, order,
leads and time; rapids over the clearance, torch on from pierce to lead-out. Read by readers of their own: torch_program, and one here."""

import copy
import itertools
import json
import math
import re

import torch_program
from service import FormatTest, examples, main

EXAMPLE = "two-ends-and-four-holes-of-a-part"
PIVOT, CLEARANCE, PIERCE, DELAY, LEAD, SPEED = 150.0, 30.0, 4.0, 0.4, 4.0, 900.0
OPTIONS = (f"format=gcode&torch=on&speed_mm_min={SPEED}&lead_mm={LEAD}&pivot_length_mm={PIVOT}&pierce_height_mm={PIERCE}"
           f"&pierce_delay_s={DELAY}&clearance_mm={CLEARANCE}&cut_height_mm=0")
PULSES = {"C": 1000.0, "Y": 1000.0, "Z1": 1000.0, "B": 1000.0}  # of the five-axis cutter, by deg and mm
LIMITS = {"C": (60, 300, 6000), "Y": (200, 1000, 20000), "Z1": (100, 800, 16000), "B": (45, 300, 6000)}
MOST = 800  # pulses a period
PERIOD = 0.004


def big_part():
    """Two ends that others cut, 18 holes of two kinds all round it."""
    smoothing = {"method": "envelope", "limits": {"machine": "five_axis_cutter", "speed_mm_min": SPEED}}

    def end(**cutter):
        return {"cutters": [{"kind": "tube", **cutter}], "root_surface": "inner", "groove": {"rule": "half_dihedral"}, "smoothing": smoothing}
    holes = [{"branch": {"outer_diameter_mm": 60.3 + 5 * (k % 3), "wall_mm": 4, "inclination_deg": 60 + 10 * (k % 6), "clocking_deg": k * 47 % 360,
                         "offset_mm": 8 * (k % 3 - 1), "height_mm": 180 + 140 * k},
              "joint": {"kind": ("set_on", "set_in")[k % 2], "gap_mm": 1}, "groove": {"rule": ("half_dihedral", "none")[k % 2]}} for k in range(18)]
    return {"target": {"id": "chord", "outer_diameter_mm": 168.3, "wall_mm": 8, "length_mm": 2800},
            "ends": {"start": end(outer_diameter_mm=219.1, inclination_deg=70, clocking_deg=20, offset_mm=10),
                     "finish": end(outer_diameter_mm=193.7, inclination_deg=100, clocking_deg=100, offset_mm=-6)},
            "holes": holes, "kerf_mm": 1.5, "sampling": {"tolerance_mm": 0.05}}


def example():
    return copy.deepcopy(examples("pulse-schedules")[EXAMPLE])


def column(result, axis):
    return result["counts"].get(axis) or [0] * result["periods"]


def values(result):
    """{axis: its value at every period's end, the start first}"""
    return {axis: [result["start"][axis] + n / PULSES[axis] for n in itertools.accumulate(column(result, axis), initial=0)] for axis in PULSES}


def timed_program(text):
    """[(seconds, {letter: value}, lit, what)] of a schedule's G-code; the first place takes no time."""
    at, lit, what, out = {}, False, "", []
    for line in text.splitlines():
        words = {a: float(v) for a, v in re.findall(r"([A-Z])(-?\d+\.\d+)", line)}
        if line.startswith(("(rapid: ", "(cut: ", "(mark of ")):
            what = line[1:-1]
        elif line.startswith("M3"):
            lit = True
        elif line.startswith("M5"):
            lit = False
        elif line.startswith("G4 P"):
            out.append((float(line[4:]), dict(at), lit, what))
        elif line.startswith(("G0 ", "G1 ")):
            feed = words.pop("F", None)
            at.update(words)
            out.append((60 / feed if feed else 0.0, dict(at), lit, what))
    return out


def height(words, radius):
    """Of the tip over the tube."""
    return words["Z"] - PIVOT * math.cos(math.radians(words["B"])) - radius


class PartSchedule(FormatTest):
    kept = {}

    def schedule(self, body):
        key = json.dumps(body)
        if key not in self.kept:
            self.kept[key] = self.service.answer("pulse-schedules", body)
        return self.kept[key]

    def job(self):
        return {"part": big_part(), **{name: example()[name] for name in ("machine", "motion")}}

    def jobs(self):
        """(a schedule's request, what the same program is as G-code of the part)"""
        held = example()
        held["motion"] |= {"tabs": {"count": 2, "width_mm": 2, "of": "all"}, "marks": {"speed_mm_min": 3000}}
        return [(example(), OPTIONS), (self.job(), OPTIONS), (held, OPTIONS + "&tabs=2&tab_mm=2&tabs_of=all&marks=on&mark_speed_mm_min=3000")]

    def cuts(self, result):
        return [s for s in result["segments"] if s["kind"] == "cut"]

    def test_two_ends_and_18_holes_hold_every_invariant(self):
        """By the answer's own proof, and by differences of its counts alone."""
        answer = self.schedule(self.job())
        result, checks = answer["result"], {c["name"] for c in answer["verification"]["checks"]}
        self.assertLessEqual({"I1", "I2", "I4", "I5", "I6", "I7", "I8", "I9", "I10", "I11", "I12", "I13", "I14", "I15", "I16", "lead_clears_part",
                              "segments_join", "torch_lit", "pierce_place", "pierce_delay", "rapid_clearance"}, checks)
        self.assertEqual(len(self.cuts(result)), 20)
        for axis, (v, a, j) in LIMITS.items():
            counts = [0, 0, 0, *column(result, axis), 0, 0, 0]
            self.assertLessEqual(max(map(abs, counts)), MOST)
            one = [y - x for x, y in zip(counts, counts[1:])]
            two = [y - x for x, y in zip(one, one[1:])]
            for found, limit, more in ((counts, v * PERIOD, 1), (one, a * PERIOD**2, 2), (two, j * PERIOD**3, 4)):
                self.assertLess(max(map(abs, found)), limit * PULSES[axis] + more, axis)
            self.assertEqual(sum(counts), result["total"][axis])
        self.assertEqual([s["from"] for s in result["segments"]] + [result["periods"]], [0] + [s["to"] for s in result["segments"]])
        times = result["times"]
        self.assertAlmostEqual(times["cut_s"] + times["pierce_s"] + times["rapid_s"], times["total_s"], delta=1e-9)
        self.assertAlmostEqual(result["periods"] * PERIOD, times["total_s"], delta=1e-9)
        self.assertGreaterEqual(times["pierce_s"], 20 * DELAY)

    def test_texts_hold_every_invariant_at_fine_tolerances(self):
        """Letters turn sharply at few places, so their corners lie anywhere between two knots of the path."""
        for eps in (0.1, 0.03, 0.02, 0.01, 0.005):
            for text in ("M7", "NW-4", "X2/K"):
                job = example()
                job["part"]["texts"] = [{"id": "mark", "text": text, "at": {"z_mm": 190, "phi_deg": 133}, "height_mm": 8.5}]
                job["motion"] |= {"eps_tip_mm": eps, "marks": {"speed_mm_min": 2000}}
                answer = self.service.answer("pulse-schedules", job)
                self.assertTrue(all(c["value"] <= c["limit"] for c in answer["verification"]["checks"]), (text, eps))
                self.assertTrue(any(s["name"].startswith("mark of text mark") for s in answer["result"]["segments"] if "name" in s), (text, eps))

    def test_no_pulse_drifts(self):
        """At every pierce and every end of a cut each axis is within half a pulse of the laid way."""
        result = self.schedule(self.job())["result"]
        at, most = values(result), 0.0
        for pierce, cut in zip([s for s in result["segments"] if s["kind"] == "pierce"], self.cuts(result)):
            way = cut["way"]
            for period, k, off in ((pierce["from"], 0, PIERCE), (cut["from"], 0, 0.0), (cut["to"], -1, 0.0)):
                b, arm = way["b_deg"][k], PIVOT + off
                wanted = {"Y": way["z_mm"][k] + arm * math.sin(math.radians(b)), "Z1": 168.3 / 2 + arm * math.cos(math.radians(b)), "B": b}
                for axis, value in wanted.items():
                    most = max(most, abs(at[axis][period] - value) * PULSES[axis])
                turned = (at["C"][period] - way["phi_deg"][k]) / 360
                most = max(most, abs(turned - round(turned)) * 360 * PULSES["C"])
        self.assertLessEqual(most, 0.5 + 1e-4)
        self.assertGreater(most, 0.4)

    def test_gcode_and_pulses_are_two_printings_of_one_program(self):
        """The same cuts in the same order through the same places, within the fifth decimal that G-code prints and by no systematic 1e-6 mm;
        the same time for cut, delay and height, within 0.1 %."""
        for job, options in self.jobs():
            result = self.schedule(job)["result"]
            radius = job["part"]["target"]["outer_diameter_mm"] / 2
            whole = torch_program.replay(self.service.text("parts", job["part"], options).decode(), radius, PIVOT, CLEARANCE)
            drawn = [(cut.name, [(p.phi, p.z) for p in (cut.places[0], cut.places[-1])]) for cut in whole if cut.mark]
            laid = [(s["name"], [(s["way"]["phi_deg"][k], s["way"]["z_mm"][k]) for k in (0, -1)]) for s in result["segments"] if s["kind"] == "mark"]
            self.assertEqual([name for name, _ in drawn], [name for name, _ in laid])
            self.assertEqual(bool(drawn), "marks" in job["motion"])
            for (_, one), (_, other) in zip(drawn, laid):
                for (phi, z), (at, along) in zip(one, other):
                    self.assertLess(max(abs(phi - at), abs(z - along)), 2e-5)
            program = [cut for cut in whole if not cut.mark]
            cuts = self.cuts(result)
            self.assertEqual([cut.name for cut in program], [cut["name"] for cut in cuts])
            for printed, cut in zip(program, cuts):
                way = list(zip(*(cut["way"][name] for name in ("phi_deg", "z_mm", "b_deg"))))
                if re.search(r", \d+ of \d+$", cut["name"]):
                    del way[-1]  # before a tab the pulses end earlier, so that the tab on the counts is not too narrow
                off, places = [], iter(printed.places[1:])  # the first is the pierce, over the wall
                for phi, z, b in way:  # more are inserted between
                    place = next(p for p in places if abs(p.phi - phi) < 2e-7 and abs(p.z - z) < 3e-5 and abs(p.b - b) < 2e-6)
                    off.append((radius * math.radians(place.phi - phi), place.z - z))
                self.assertLess(max(abs(o) for o, _ in off), 1e-6)
                self.assertLess(abs(sum(z for _, z in off)) / len(off), 1e-6 + 6e-6 / math.sqrt(len(off)))
                length = sum(printed.lengths)
                self.assertAlmostEqual(length - PIERCE, cut["report"]["length_mm"], delta=1e-3 * length)
                self.assertAlmostEqual(60 * (length - PIERCE) / SPEED, cut["report"]["ideal_s"], delta=1e-3 * cut["report"]["ideal_s"])
                self.assertEqual(printed.dwell, DELAY)
            at_speed = sum(60 * sum(cut.lengths) / SPEED + cut.dwell for cut in program)
            ideal = sum(cut["report"]["ideal_s"] for cut in cuts) + len(cuts) * (DELAY + 60 * PIERCE / SPEED)
            self.assertAlmostEqual(at_speed, ideal, delta=1e-3 * ideal)

    def test_the_schedules_own_gcode(self):
        """Its time that of the counts, its places theirs; the tip over the clearance while anything but its height moves; lit where it should."""
        for job, _ in self.jobs():
            result = self.schedule(job)["result"]
            radius = job["part"]["target"]["outer_diameter_mm"] / 2
            moves = timed_program(self.service.text("pulse-schedules", job, "format=gcode&torch=on").decode())
            self.assertAlmostEqual(sum(seconds for seconds, *_ in moves), result["times"]["total_s"], delta=1e-6 * result["times"]["total_s"])
            self.assertEqual(set(moves[0][1]), {"Z"})
            self.assertAlmostEqual(moves[0][1]["Z"], radius + PIVOT + CLEARANCE, delta=1e-3)
            at, elapsed, travelled, lit = values(result), 0.0, 0, 0.0
            letters = {"C": "C", "Y": "Y", "Z1": "Z", "B": "B"}
            for (_, before, *_), (seconds, words, burning, what) in zip(moves, moves[1:]):
                elapsed += seconds
                period = elapsed / PERIOD
                self.assertAlmostEqual(period, round(period), delta=0.01)
                for axis, letter in letters.items():
                    self.assertAlmostEqual(words[letter], at[axis][round(period)], delta=1e-6)
                lit += seconds if burning else 0.0
                if what.startswith("rapid"):
                    self.assertTrue(not burning or "cut" in what or height(words, radius) < PIERCE + 1e-3, what)
                    if not burning and any(abs(words[a] - before[a]) > 1.5e-3 for a in "CYB" if a in before):
                        for share in (0.0, 0.25, 0.5, 0.75, 1.0):
                            here = {a: before[a] + share * (words[a] - before[a]) for a in "ZB"}
                            self.assertGreater(height(here, radius), CLEARANCE - 3e-3)
                        travelled += 1
            self.assertGreater(travelled, 10)
            burns = [e["period"] for e in result["events"] if e["what"] in ("torch_on", "torch_off")]
            self.assertAlmostEqual(lit, PERIOD * sum(off - on for on, off in zip(burns[::2], burns[1::2])), delta=1e-3)
            self.assertAlmostEqual(height(moves[-1][1], radius), PIVOT + CLEARANCE - PIVOT * math.cos(math.radians(moves[-1][1]["B"])), delta=3e-3)

    def test_a_replay_holds_it_and_sees_what_was_changed(self):
        job = example()
        result = self.schedule(job)["result"]

        def broken(schedule, **more):
            answer = self.service.answer("replays", {**job, **more, "schedule": schedule})["result"]
            self.assertEqual(len(answer["path"]["phi_deg"]), result["periods"] + 1)
            return {i["name"] for i in answer["invariants"] if not i["passed"]}
        self.assertEqual(broken(result), set())
        rapid = next(s for s in result["segments"][1:] if s["kind"] == "rapid")
        changed = copy.deepcopy(result)
        for k in range(rapid["from"], rapid["to"]):  # never lifted
            changed["counts"]["Z1"][k] = 0
        self.assertIn("rapid_clearance", broken(changed))
        changed = copy.deepcopy(result)
        changed["counts"]["B"] = [-n for n in changed["counts"]["B"]]
        self.assertIn("pierce_place", broken(changed))
        changed = copy.deepcopy(result)
        next(e for e in changed["events"] if e["what"] == "torch_off")["period"] += 50
        self.assertIn("torch_lit", broken(changed))
        changed = copy.deepcopy(result)
        changed["segments"][2]["to"] += 1
        self.assertIn("segments_join", broken(changed))
        self.assertIn("rapid_clearance", broken(result, motion={**job["motion"], "clearance_mm": 31}))

    def test_refused_by_pointer(self):
        def refused(change, endpoint="pulse-schedules"):
            body = example()
            change(body)
            status, _, content = self.service.ask(endpoint, body)
            self.assertEqual(status, 422, content[:300])
            return [(e["code"], e["pointer"]) for e in json.loads(content)["errors"]]
        self.assertEqual(refused(lambda b: b["part"]["holes"][1].update(tilt="free")), [("unsupported_combination", "/part/holes/1/tilt")])
        self.assertEqual(refused(lambda b: b["motion"].update(direction="cw")), [("unknown_field", "/motion/direction")])
        self.assertEqual(refused(lambda b: b["motion"].update(pierce_height_mm=31)), [("out_of_range", "/motion/pierce_height_mm")])
        self.assertEqual(refused(lambda b: b.update(machine="crawler")), [("unsupported_combination", "/motion/clearance_mm"),
                                                                          ("unsupported_combination", "/motion/pierce_height_mm")])
        self.assertEqual(refused(lambda b: b["part"]["ends"]["finish"].update(square_at_mm=2000)), [("member_consumed", "/part/target/length_mm")])
        self.assertIn("/part", [pointer for _, pointer in refused(lambda b: b.update(contour={}))])


if __name__ == "__main__":
    main()
