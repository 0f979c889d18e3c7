"""A program along torch lines read and replayed, by a reader of its own: where the tip is, how far off the wall, when the torch burns.
It raises Fault where a machine would come to harm: a rapid below the clearance, a torch lit on the way, a tip at the wrong height."""

import math
import re

WORD = re.compile(r"([A-Z])(-?\d+\.\d+)")
TIMED = re.compile(r"^G1 (.*) F\[#<speed_mm_min> / (\d+\.\d+)\]$")
STROKE = re.compile(r"^G1 (.*) F(\d+\.\d+)$")  # of a mark: blocks a minute
ON, OFF = ("M3 S1", "M3 $0 S1"), ("M5", "M5 $0")
MARK_ON, MARK_OFF = ("M64 P0", "M3 $1 S1"), ("M65 P0", "M5 $1")
STARTS = re.compile(r"^\(starts at A (-?[\d.]+), B (-?[\d.]+), (-?[\d.]+) mm from X0\)$")
SHORTEST = 1.0  # mm, radius of a lead
STEPS = 20  # places looked at along a rapid


class Fault(Exception):
    pass


class Cut:
    def __init__(self, name):
        self.name, self.places, self.lengths, self.dwell, self.lit, self.start = name, [], [], 0.0, False, None
        self.dark = 0  # moves with the torch out
        self.mark = False  # a stroke, whose lengths are minutes


class Pose:
    """Words of a pivot `arm` mm behind the tip's reach; phi, b, a in deg, z and off in mm."""

    def __init__(self, words, radius, pivot):
        self.phi, self.b, self.a = (words.get(w, 0.0) for w in "ABC")
        rise, across = math.tan(math.radians(self.b)), math.tan(math.radians(self.a))
        size = math.sqrt(1 + rise**2 + across**2)
        arm = (words["Z"] - radius) * size
        self.off, self.z = arm - pivot, words.get("X", 0.0) - arm * rise / size
        if abs(words.get("Y", 0.0) + arm * across / size) > 1e-3:
            raise Fault(f"Y{words['Y']} is not where a pivot of {arm} mm is")


def words_of(line):
    return {a: float(v) for a, v in WORD.findall(line)}


def tip_height(words, pivot):
    """Of the tip over the tube's axis, by what B and C say now."""
    size = math.sqrt(1 + math.tan(math.radians(words.get("B", 0.0)))**2 + math.tan(math.radians(words.get("C", 0.0)))**2)
    return words["Z"] - pivot / size


def check_rapid(before, to, radius, pivot, clearance):
    """A rapid that turns the tube or swings or travels is all over the clearance; one that only goes up or down may end at the wall."""
    if "Z" not in before:
        if set(to) != {"Z"} or to["Z"] < radius + pivot + clearance - 1e-3:
            raise Fault(f"the first rapid is no retract: {to}")
        return
    turns = any(abs(to.get(w, 0.0) - before.get(w, 0.0)) > 1e-6 for w in "XYABC")
    for k in range(STEPS + 1):
        at = {w: before.get(w, to[w]) + (to[w] - before.get(w, to[w])) * k / STEPS for w in to}
        if tip_height(at, pivot) < radius + (clearance - 1e-3 if turns else -1e-3):
            raise Fault(f"a rapid {'at' if turns else 'to'} {tip_height(at, pivot) - radius:.2f} mm over the tube")


def events(program):
    """What the blocks of a program say, in their order."""
    for line in program.splitlines():
        if line.startswith("(cut: "):
            yield "cut", line[len("(cut: "):-1]
        elif line.startswith("(mark of "):
            yield "mark", line[1:-1]
        elif starts := STARTS.match(line):
            phi, b, z = map(float, starts.groups())
            yield "start", (phi, z, b)
        elif line in ON:
            yield "on", None
        elif line in OFF:
            yield "off", None
        elif line in MARK_ON:
            yield "mark_on", None
        elif line in MARK_OFF:
            yield "mark_off", None
        elif line.startswith("G4 P"):
            yield "dwell", float(line[4:])
        elif line.startswith("G0 "):
            yield "rapid", words_of(line)
        elif timed := TIMED.match(line):
            yield "move", (words_of(timed[1]), float(timed[2]))
        elif stroke := STROKE.match(line):
            yield "move", (words_of(stroke[1]), 1 / float(stroke[2]))


def follow(what_happens, radius, pivot, clearance=50.0):
    """The cuts of a program with a pivot; each as poses from its pierce on, the first of them the pierce."""
    at, cuts, burning, marking, name, start, mark = {}, [], False, False, "", None, False
    for kind, value in what_happens:
        if kind in ("cut", "mark"):
            name, mark = value, kind == "mark"
        elif kind == "start":
            start = value
        elif kind in ("mark_on", "mark_off"):
            if mark != cuts[-1].mark or not mark or burning:
                raise Fault(f"{name} is marked")
            marking = kind == "mark_on"
            cuts[-1].lit = cuts[-1].lit or marking
        elif kind == "on":
            if mark:
                raise Fault("the torch burns a mark")
            cuts[-1].lit = burning = True
            cuts[-1].places.append(Pose(at, radius, pivot))
        elif kind == "off":
            burning = False
        elif kind == "dwell":
            cuts[-1].dwell += value
        elif kind == "rapid":
            if burning or marking:
                raise Fault("a rapid with the torch lit" if burning else "a rapid while marking")
            to = {**at, **value}
            check_rapid(at, to, radius, pivot, clearance)
            if "Z" in at and to["Z"] < at["Z"]:
                cuts.append(Cut(name))
                cuts[-1].start, cuts[-1].mark = start, mark
            at = to
        elif kind == "move":
            words, length = value
            if not cuts:
                raise Fault("a move before any approach")
            if not cuts[-1].places:
                cuts[-1].places.append(Pose(at, radius, pivot))
            at.update(words)
            cuts[-1].places.append(Pose(at, radius, pivot))
            cuts[-1].lengths.append(length)
            cuts[-1].dark += not (marking if mark else burning)
    if tip_height(at, pivot) < radius + clearance - 1e-3:
        raise Fault("the torch is left at the tube")
    return cuts


def replay(program, radius, pivot, clearance=50.0):
    return follow(events(program), radius, pivot, clearance)


def check_heights(cuts, pierce, cutting, near=0.02):
    for cut in cuts:
        if abs(cut.places[0].off - pierce) > near:
            raise Fault(f"{cut.name} pierces {cut.places[0].off:.3f} mm off")
        for place in cut.places[1:]:
            if abs(place.off - cutting) > near:
                raise Fault(f"{cut.name} cuts {place.off:.3f} mm off")
