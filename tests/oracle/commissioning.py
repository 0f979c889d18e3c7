"""What the four coupons of examples/commissioning show when one number of the machine file is wrong.

The counts of each coupon's schedule, planned with the file, drive a machine that differs from the file in one field; its beam is
rebuilt in space by tools/oracle/replay.py. The machine was set up with the torch upright: B = 0, tip at its stand-off, the beam on
z = 0 and phi = 0, so that axes count from there. `commissioning.py SERVER` prints the table of docs/commissioning.md."""

import copy
import json
import pathlib
import subprocess
import sys

import numpy as np

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "oracle"))
import replay  # noqa: E402

COUPONS = ("1-square", "2-bevel-plus-30", "3-mitre-30", "4-saddle")


def scaled(name):
    """The axis truly moves 1 % further per pulse than the file says (its pulses per unit or turn are 1 % too high)."""
    def change(machine, upright, q):
        q[name] = upright[name] + 1.01 * (q[name] - upright[name])
    return change


def reversed_axis(name):
    def change(machine, upright, q):
        q[name] = 2 * upright[name] - q[name]
    return change


def swing_zero(machine, upright, q):
    q["B"] = q["B"] + 1.0


def longer_pivot(machine, upright, q):
    machine["pivot_length_mm"] += 1.0
    q["Z1"] = q["Z1"] + 1.0  # set up by the tip, so the pivot is higher by that


FAULTS = {
    "none": lambda machine, upright, q: None,
    "`C.pulses_per_turn` 1 % too high": scaled("C"),
    "`Y.pulses_per_unit` 1 % too high": scaled("Y"),
    "`Z1.pulses_per_unit` 1 % too high": scaled("Z1"),
    "`B.pulses_per_unit` 1 % too high": scaled("B"),
    "zero of B off by +1 deg": swing_zero,
    "`pivot_length_mm` 1 mm too short": longer_pivot,
    "`b_positive` the wrong way": reversed_axis("B"),
    "C counts the other way": reversed_axis("C"),
}


def planned(server, coupon):
    file = ROOT / "examples" / "commissioning" / "pulse-schedules" / f"{coupon}.json"
    done = subprocess.run([server, "run", "--endpoint", "pulse-schedules", file], capture_output=True, text=True, check=True)
    return json.loads(file.read_text()), json.loads(done.stdout)["result"]


def machine_of(server, name):
    """The built-in machine of that name, by GET /v1/machines."""
    import http.client
    child = subprocess.Popen([server, "--port", "0", "--admin-port", "0"], stdout=subprocess.PIPE, text=True)
    try:
        ready = json.loads(child.stdout.readline())
        connection = http.client.HTTPConnection("127.0.0.1", ready["port"], timeout=10)
        connection.request("GET", "/v1/machines")
        shelf = json.loads(connection.getresponse().read())["machines"]
    finally:
        child.terminate()
        child.communicate()
    return next(entry.get("machine", entry) for entry in shelf if entry.get("machine", entry).get("name") == name)


class Cut:
    """The cut of one coupon on both walls, by a machine with one fault."""

    def __init__(self, machine, request, result, fault):
        target = request["cut"]["target"]
        tube = replay.Tube({**target, "surface": "outer"})
        upright = {"C": 0.0, "Y": 0.0, "B": 0.0, "Z1": tube.outer + machine["pivot_length_mm"], "Z2": 0.0}
        q = replay.axis_values(machine, result)
        machine = copy.deepcopy(machine)
        fault(machine, upright, q)
        beam, _ = replay.torch(machine, tube, q)
        beam.point = beam.point - 10 * tube.outer * beam.direction
        when = replay.cut_periods(result)
        one_turn = slice(when.start, when.stop)
        self.phi, self.z, _ = (column[one_turn] for column in beam.at(tube.outer))
        inner = beam.at(tube.inner)[1][one_turn]
        self.face = np.degrees(np.arctan2(self.z - inner, tube.outer - tube.inner))  # edge from square, + outer further in
        self.around = tube.outer * (abs(self.phi[-1] - self.phi[0]) - 2 * np.pi) - request["motion"]["lead"]["overcut_mm"]

    def at(self, phi_deg, column):
        here = np.mod(np.degrees(self.phi), 360)
        return column[np.argmin(np.abs((here - phi_deg + 180) % 360 - 180))]


def readings(cuts):
    """{what is measured: (value, unit)} of the four coupons."""
    square, bevel, mitre, saddle = cuts
    upper = mitre.phi[mitre.z > mitre.z.max() - 5.0]
    high = np.degrees(upper.min() + upper.max()) / 2 % 360  # halved between equal heights
    return {
        "1 overlap of the cut's ends": square.around,
        "1 face from square": np.median(square.face),
        "2 face": np.median(bevel.face),
        "2 ring 1-2 along the outer edge": np.median(bevel.z) - np.median(square.z),
        "3 longest less shortest": mitre.z.max() - mitre.z.min(),
        "3 face at the long side": mitre.at(high, mitre.face),
        "3 long side at": high,
        "4 crown less flank, outer edge": saddle.z.max() - saddle.z.min(),
        "4 face at phi 0": saddle.at(0, saddle.face),
    }


def table(server):
    """{fault: {reading: value}}; the first is the sound machine."""
    machine = machine_of(server, "five_axis_cutter")
    plans = [planned(server, coupon) for coupon in COUPONS]
    return {name: readings([Cut(machine, request, result, fault) for request, result in plans])
            for name, fault in FAULTS.items()}


def markdown(rows):
    sound = rows["none"]
    out = ["| off by | " + " | ".join(sound) + " |", "|---" * (len(sound) + 1) + "|"]
    out.append("| nothing: read | " + " | ".join(f"{v:.2f}" for v in sound.values()) + " |")
    for name, row in list(rows.items())[1:]:
        # no "-0.00"
        cells = [f"{round(row[k] - sound[k], 2) + 0.0:+.2f}" for k in sound]
        out.append(f"| {name} | " + " | ".join("." if float(c) == 0 else c for c in cells) + " |")
    return "\n".join(out)


if __name__ == "__main__":
    print(markdown(table(sys.argv[1])))
