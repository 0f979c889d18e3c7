"""The service's schedules against the torch that tools/oracle/replay.py rebuilds in space, and the oracle against mistakes.

`replay_oracle_test.py SERVER`: contours in closed form, densely sampled and hardly smoothed, so that every period's counts
must lie within half a pulse of a place on the exact curve."""

import copy
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "oracle"))
import replay  # noqa: E402

SERVER = None
JOBS = 50
EPS_TIP_MM, EPS_B_DEG = 1e-3, 0.01  # permitted error of smoothing: a small part of the coarse pulses below
SLACK = 0.1                         # pulses: those two on the longest arm, and the curve between the points
SEEN = 5.0                          # pulses: a planted mistake is no matter of rounding


def run(endpoint, body):
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(body, file)
        file.flush()
        done = subprocess.run([SERVER, "run", "--endpoint", endpoint, file.name], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{endpoint} refused: {done.stdout[:800]} {done.stderr[:300]}")
    return json.loads(done.stdout)["result"]


class Waves:
    """mean + sum of a cos(n phi + shift)."""

    def __init__(self, dice, mean, size, orders=(1, 2, 3)):
        self.mean = mean
        self.parts = [(dice.uniform(0.3, 1) * size / n**2, n, dice.uniform(0, 2 * math.pi)) for n in orders]

    def __call__(self, phi):
        return self.mean + sum(a * np.cos(n * phi + shift) for a, n, shift in self.parts)


def axis(dice, name, unit, speed, per_turn=False):
    count = {"pulses_per_turn": dice.choice([1440, 1800])} if per_turn else {"pulses_per_unit": dice.choice([3, 4, 5])}
    return {"name": name, "unit": unit, **count, "v_max": speed, "a_max": 5 * speed, "j_max": 100 * speed, "n_max": 800}


def five_axis_cutter(dice):
    return {"type": "five_axis_cutter", "pivot_length_mm": dice.choice([0, 40, 80]), "standoff_mm": dice.uniform(0, 4),
            "z2_share": dice.choice([0, 0.25]),
            "axes": [axis(dice, "C", "deg", 60, True), axis(dice, "Y", "mm", 200), axis(dice, "Z1", "mm", 100),
                     axis(dice, "Z2", "mm", 60), axis(dice, "B", "deg", 45)]}


def crawler(dice):
    center = dice.choice(["remote", "pivot"])
    return {"type": "crawler", "wheel_offset_mm": dice.uniform(30, 90), "swing_center": center,
            **({"pivot_length_mm": dice.uniform(5, 40)} if center == "pivot" else {}),
            "axes": [axis(dice, "S", "mm", 50), axis(dice, "E", "mm", 100), axis(dice, "B", "deg", 45)]}


def generic(dice):
    k = [dice.choice([-1, 1]) * dice.uniform(0.5, 2) for _ in range(3)]
    return {"type": "generic",
            "maps": [{"k_phi": k[0]}, {"k_z": k[1], "k_b": dice.uniform(-1, 1), "k_0": dice.uniform(-50, 50)}, {"k_b": k[2]}],
            "axes": [axis(dice, "C", "deg", 60), axis(dice, "Z", "mm", 200), axis(dice, "B", "deg", 45)]}


def contour_job(seed):
    """(request, wanted z and B in closed form)."""
    dice = random.Random(seed)
    machine = [five_axis_cutter, crawler, five_axis_cutter, generic][seed % 4](dice)
    machine.update(period_us=dice.choice([2000, 4000, 8000]),
                   b_positive=dice.choice(["outer_edge_into_part", "outer_edge_to_waste"]))
    outer = dice.uniform(20, 45)
    wall = dice.uniform(0.05, 0.15) * outer
    z, b = Waves(dice, 0, 0.4 * outer), Waves(dice, math.radians(dice.uniform(-25, 25)), math.radians(15))
    count = math.ceil(2 * math.pi * outer / 0.1)
    phi = 2 * np.pi * np.arange(count) / count
    contour = {"surface": dice.choice(["outer", "inner"]), "outer_diameter_mm": 2 * outer, "wall_mm": wall, "closed": True, "b_sign": "outer_edge_to_plus_z",
               "phi_deg": np.degrees(phi).tolist(), "z_mm": z(phi).tolist(), "b_deg": np.degrees(b(phi)).tolist()}
    motion = {"speed": {"mm_min": dice.uniform(300, 2000)}, "direction": dice.choice(["ccw", "cw"]),
              "eps_tip_mm": EPS_TIP_MM, "eps_b_deg": EPS_B_DEG}
    return {"contour": contour, "machine": machine, "motion": motion}, z, b


def mill_job(seed):
    """A cone mill's C, X, Z, B as columns in closed form of the length s."""
    dice = random.Random(seed)
    machine = {"type": "cone_mill", "period_us": 4000, "b_positive": "outer_edge_into_part",
               "axes": [axis(dice, "C", "deg", 60, True), axis(dice, "X", "mm", 100), axis(dice, "Z", "mm", 100),
                        axis(dice, "B", "deg", 45)]}
    curves = {"C": lambda phi: np.degrees(phi), "X": Waves(dice, 60, 8), "Z": Waves(dice, 0, 12), "B": Waves(dice, 30, 10)}
    phi = np.linspace(0, 2 * np.pi, 3000)
    axes = {name: curve(phi).tolist() for name, curve in curves.items()}
    return {"axes": {"s_mm": (40 * phi).tolist(), **axes}, "machine": machine,
            "motion": {"speed": {"mm_min": 400}, "eps_tip_mm": EPS_TIP_MM, "eps_b_deg": EPS_B_DEG}}, curves


def misses(request, z, b, result, machine=None, b_sign=1.0, every=1):
    """Worst miss of the periods in pulses, by a machine and a sign of B that may be wrong."""
    machine = machine or request["machine"]
    tube = replay.Tube(request["contour"])
    q = {name: values[::every] for name, values in replay.axis_values(request["machine"], result).items()}
    lead = machine["axes"][0]
    turn_per_unit = replay.demanded(machine, tube, np.ones(1), np.zeros(1), np.zeros(1))[lead["name"]][0]
    phi = (q[lead["name"]] - machine.get("maps", [{}])[0].get("k_0", 0.0)) / turn_per_unit
    reach = 1.0 / replay.pulses_per_unit(lead) / abs(turn_per_unit)
    wanted = lambda at: replay.demanded(machine, tube, at, z(at), b_sign * b(at))
    return replay.miss(machine, q, wanted, phi, np.full_like(phi, reach)).max()


class Oracle(unittest.TestCase):
    def test_fifty_schedules_within_half_a_pulse(self):
        worst, kinds = 0.0, {}
        for seed in range(JOBS - 4):
            request, z, b = contour_job(seed)
            result = run("pulse-schedules", request)
            pulses = misses(request, z, b, result)
            self.assertLessEqual(pulses, 0.5 + SLACK, seed)
            worst = max(worst, pulses)
            kinds[request["machine"]["type"]] = kinds.get(request["machine"]["type"], 0) + 1
            if request["machine"]["type"] != "generic":
                self.planted(request, z, b, result, seed)
        for seed in range(4):
            request, curves = mill_job(seed)
            result = run("pulse-schedules", request)
            worst = max(worst, self.mill(request, curves, result, seed))
            kinds["cone_mill"] = kinds.get("cone_mill", 0) + 1
        self.assertEqual(sum(kinds.values()), JOBS)
        print(f"{JOBS} schedules {kinds}, worst miss {worst:.4f} pulses")

    def planted(self, request, z, b, result, seed):
        """The same counts against a wrong sign of B, and against a machine that counts B the other way."""
        self.assertGreater(misses(request, z, b, result, b_sign=-1.0, every=50), SEEN, seed)
        other = copy.deepcopy(request["machine"])
        other["b_positive"] = {"outer_edge_into_part": "outer_edge_to_waste",
                               "outer_edge_to_waste": "outer_edge_into_part"}[other["b_positive"]]
        self.assertGreater(misses(request, z, b, result, machine=other, every=50), SEEN, seed)

    def mill(self, request, curves, result, seed):
        machine = request["machine"]
        q = replay.axis_values(machine, result)
        phi = np.radians(q["C"])
        reach = np.full_like(phi, np.radians(1.0 / replay.pulses_per_unit(machine["axes"][0])))
        miss = lambda sign: replay.miss(machine, q, lambda at: {n: (sign if n == "B" else 1) * c(at) for n, c in curves.items()},
                                        phi, reach).max()
        self.assertLessEqual(miss(1), 0.5 + SLACK, seed)
        self.assertGreater(miss(-1), SEEN, seed)
        return miss(1)

    def test_the_service_replays_what_the_oracle_rebuilds(self):
        for seed in range(0, 12):
            request, _, _ = contour_job(seed)
            result = run("pulse-schedules", request)
            path = run("replays", {**request, "schedule": result})["path"]
            tube, machine = replay.Tube(request["contour"]), request["machine"]
            beam, arm = replay.torch(machine, tube, replay.axis_values(machine, result))
            beam.height = np.hypot(*beam.point.T[:2])
            beam.point = beam.point - 10 * tube.outer * beam.direction
            phi, z, _ = beam.at(tube.contour)
            self.assertEqual(len(path["z_mm"]), result["periods"] + 1)
            self.assertLess(np.abs(np.degrees(phi) - path["phi_deg"]).max(), 1e-6, seed)
            # The replay takes the height as exact; the beam in space also feels its rounding.
            lift = 0.0
            if arm is not None:
                lift = np.tan(beam.b) * (beam.height - tube.outer - arm * np.cos(beam.b))
            self.assertLess(np.abs(z + lift - path["z_mm"]).max(), 1e-6, seed)
            self.assertLess(np.abs(np.degrees(beam.b) - path["b_deg"]).max(), 1e-6, seed)

    def test_the_cut_keeps_to_the_beams_line(self):
        """Coarse contours at the usual tolerances: what is measured is what the answer reports, and no more."""
        for seed in range(8):
            request, _, _ = contour_job(seed)
            for name in ("phi_deg", "z_mm", "b_deg"):
                request["contour"][name] = request["contour"][name][::8]
            request["motion"].update(eps_tip_mm=0.1, eps_b_deg=0.5)
            result = run("pulse-schedules", request)
            found, report = replay.measure(request, result), result["report"]
            pulse = max(1 / replay.pulses_per_unit(a) for a in request["machine"]["axes"])  # mm or deg
            arm = 1 + np.radians(request["machine"].get("pivot_length_mm", 0) + 20)
            self.assertLessEqual(found["contour_mm"], report["dev_tip_mm"] + report["sag_mm"] + pulse * arm, seed)
            self.assertLessEqual(found["b_deg"], report["dev_b_deg"] + report["sag_b_deg"] + pulse, seed)
            for sign in ("b_positive", "b_deg"):
                self.assertGreater(replay.measure(wrong(request, sign), result)["other_wall_mm"], 0.2, f"{seed} {sign}")

    def test_both_edges_keep_to_what_the_answer_says(self):
        """Fine pulses and kinks of B, which smoothing rounds: on the wall that is not the contour's, dev_tip_mm is far from the truth."""
        beyond = 0.0
        for seed in range(8):
            request, _, _ = contour_job(seed)
            contour, machine = request["contour"], request["machine"]
            count = 180
            contour.update(wall_mm=0.2 * contour["outer_diameter_mm"], phi_deg=[360 / count * i for i in range(count)],
                           z_mm=[5 * math.cos(math.radians(4 * i)) for i in range(count)], b_deg=[30 - abs(i % 60 - 30) for i in range(count)])
            for axis_ in machine["axes"]:
                axis_.pop("pulses_per_turn", None)
                axis_.update(pulses_per_unit=20000, n_max=1000000)
            request["motion"].update(eps_tip_mm=0.05, eps_b_deg=0.5)
            result = run("pulse-schedules", request)
            found, report = replay.measure(request, result), result["report"]
            for edge in ("outer_edge_mm", "inner_edge_mm"):
                told = report[f"dev_{edge}"]
                self.assertLessEqual(found[edge], told + 1e-3, f"{seed} {edge}")
                self.assertGreater(found[edge], 0.8 * told - 1e-3, f"{seed} {edge}: more than there is")
            worst = max(found["outer_edge_mm"], found["inner_edge_mm"])
            beyond = max(beyond, worst - report["dev_tip_mm"] - report["sag_mm"])
            print(f"contour on the {contour['surface']} wall: outer {found['outer_edge_mm']:.4f} (told {report['dev_outer_edge_mm']:.4f}), inner "
                  f"{found['inner_edge_mm']:.4f} (told {report['dev_inner_edge_mm']:.4f}), dev_tip_mm + sag_mm {report['dev_tip_mm'] + report['sag_mm']:.4f}")
        self.assertGreater(beyond, 0.05)


def wrong(request, sign):
    out = copy.deepcopy(request)
    if sign == "b_deg":
        out["contour"]["b_deg"] = [-b for b in out["contour"]["b_deg"]]
    else:
        now = out["machine"]["b_positive"]
        out["machine"]["b_positive"] = "outer_edge_to_waste" if now == "outer_edge_into_part" else "outer_edge_into_part"
    return out


if __name__ == "__main__":
    SERVER = sys.argv.pop(1)
    unittest.main()
