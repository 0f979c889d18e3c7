#!/usr/bin/env python3
"""Writes docs/theory/figures.md: what the sources print beside what the service answers; and the pictures in docs/ that the service draws.

`tools/make_figures.py SERVER_BINARY` writes them, `--check` says instead whether they are what it would write. What the sources print stands in
PRINTED; everything else is the service's answer, or the source's own formula where the page says so."""

import difflib
import json
import math
import pathlib
import subprocess
import sys

import make_claim_svg
import make_part_svg

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"

# Source 004, equations (9) and (10): the cylinder's speed a t^2 + b t + c in mm/s, and the ratio k of Tables 1 and 3 in rad/mm.
PRINTED = {
    "table 1": {"equation": "(9)", "speed": (5.07086486, 0.034573, -0.000309806), "k": 0.0079, "claim": "at most 0.5 %"},
    "table 3": {"equation": "(10)", "speed": (4.77309, 0.013353, -0.0001874), "k": 0.00486, "claim": "-"},
}
PAIR = {"R": 150.0, "r": 80.0, "t": 10.0, "alpha": 60.0, "e": 20.0}  # ours, because source 002 has only formulas


class Service:
    def __init__(self, binary):
        self.binary = binary

    def text(self, endpoint, body, *options):
        command = [self.binary, "run", "--endpoint", endpoint, *options, "-"]
        done = subprocess.run(command, input=json.dumps(body), capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{endpoint}: {done.stdout[:400]}{done.stderr[:400]}")
        return done.stdout

    def result(self, endpoint, body):
        return json.loads(self.text(endpoint, body))["result"]


def example(name):
    return json.loads((ROOT / f"examples/{name}.json").read_text())


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *("| " + " | ".join(map(str, row)) + " |" for row in rows)])


def number(value, digits=2):
    text = f"{value:.{digits}f}"
    return text.removeprefix("-") if float(text) == 0 else text


# Source 000

def uneven(answer):
    """Steps of B from each row to the next, the last to the first."""
    b = answer["points"]["b_raw_deg"]
    return [after - before for before, after in zip(b, b[1:] + b[:1])]


def junctions(service):
    """Of the printed formula and of the weld's side: B's step where another partner takes over, on the outer wall."""
    printed = example("bevel-tables/source-000-table-1-as-published")
    weld = {key: value for key, value in printed.items() if key != "dihedral"} | {"smoothing": {"method": "none"}}
    answers = [service.result("bevel-tables", body) for body in (printed, weld)]
    steps = [uneven(answer) for answer in answers]
    names = [cutter["id"] for cutter in printed["cutters"]]
    who = answers[0]["points"]["cutter"]
    at = [event["phi_deg"] for event in answers[0]["events"] if event["surface"] == "outer" and event["kind"] == "junction"]
    rows = []
    for i in range(len(who)):
        if who[i] == who[(i + 1) % len(who)]:
            continue
        phi = next(phi for phi in at if i <= phi <= i + 1)
        rows.append((number(phi, 3), f"{names[who[i]]} > {names[who[(i + 1) % len(who)]]}", f"{i} to {i + 1}", number(steps[0][i]), number(steps[1][i])))
    return table(["junction at phi, deg", "partners", "rows", "step of B by (2) as printed, deg", "step on the weld's side, deg"], rows)


def smoothing(service):
    rows = []
    for title, name in (("(2) as printed, windows of (5) and (6)", "source-000-table-1-as-published"), ("as cut: contact, least envelope", "source-000-table-1")):
        answer = service.result("bevel-tables", example("bevel-tables/" + name))
        points = answer["points"]
        b = points["b_deg"]
        before = points["b_raw_deg"] if "published" in name else list(map(max, points["b_raw_deg"], points["b_required_deg"]))
        largest = [max(abs(after - here) for here, after in zip(column, column[1:] + column[:1])) for column in (before, b)]
        rows.append((title, number(largest[0]), number(largest[1]), f"{number(min(b))} to {number(max(b))}"))
    return table(["B", "largest step before, deg", "after, deg", "B after, deg"], rows)


def pulses(service):
    contour = json.loads((ROOT / "tests/golden/pulse-schedules.json").read_text())["table1_contour"]
    body = example("pulse-schedules/source-000-table-1-before-and-after")
    rows = []
    for points in (0, 10, 20):  # the source counts B towards the waste, a request into the part
        asked = body | {"contour": body["contour"] | {"b_deg": [-round(b, 6) for b in contour["b_deg_by_transition_points"][str(points)][:360]]}}
        answer = service.result("pulse-schedules", asked)
        naive = {axis["name"]: axis for axis in answer["comparison"]["naive"]["axes"]}
        planned = answer["report"]["peak"]
        three = ("B", "Y", "Z1")

        def each(member):
            return " / ".join(str(naive[axis][member]) for axis in three)
        rows.append(("raw" if points == 0 else f"transition of {points} points", each("peak_pulses"), each("periods_over"), each("largest_step_pulses"),
                     each("step_in_16_bits"), " / ".join(str(planned[axis]) for axis in three)))
    return table(["B", "peak at constant speed", "periods over 800", "largest step between points", "the step as 16 bits read it", "this schedule's peak"], rows)


# Source 002

def by_the_source(theta):
    """Its Z (7), dihedral (12), actual angle omega and Z' (19) at an angle of the branch, from its formulas: mm, deg."""
    radius, e, alpha = PAIR["r"] - PAIR["t"], PAIR["e"], math.radians(PAIR["alpha"])
    x, y = radius * math.cos(theta), radius * math.sin(theta)
    v = y - e
    root = math.sqrt(PAIR["R"] ** 2 - v * v)
    z = (x * math.cos(alpha) + root) / math.sin(alpha)
    u = x * math.cos(alpha) - z * math.sin(alpha)
    normal = (u * math.cos(alpha) / PAIR["R"], v / PAIR["R"])  # of the chord, the components across the branch
    psi = math.acos(-(normal[0] * math.cos(theta) + normal[1] * math.sin(theta)))
    groove = min(psi / 2, math.pi / 4)
    slope = (-y * math.cos(alpha) - v * x / root) / math.sin(alpha) / radius
    omega = math.atan(math.tan(math.pi / 2 - psi + groove) * math.hypot(1.0, slope))
    return z, math.degrees(psi), math.degrees(omega), z + PAIR["t"] * math.tan(omega)


def offset_pair(service):
    points = service.result("bevel-tables", example("bevel-tables/source-002-offset-pair"))["points"]
    ours = list(zip(*(points[name] for name in ("z_inner_mm", "dihedral_deg", "b_raw_deg", "z_outer_mm"))))
    theirs = [by_the_source(math.radians(phi)) for phi in points["phi_deg"]]
    held = [max(abs(a[i] - b[i]) for a, b in zip(ours, theirs)) for i in range(3)]
    rows = [(number(points["phi_deg"][i], 0), *(f"{number(a, 4)} / {number(b, 4)}" for a, b in zip(ours[i], theirs[i]))) for i in range(0, 360, 45)]
    said = table(["phi, deg", "Z (7), mm", "dihedral, deg", "omega, deg", "Z' (19), mm"], rows)
    return said, "1e-9" if max(held) < 1e-9 else f"{max(held):.0e}"


# Source 001

CASES = {"A": "case-a-right-angle", "B": "case-b-near-equal-diameters", "C": "case-c-oblique-offset"}
MILLED = {"A": "case-a-end-up", "B": "case-b-end-down", "C": "case-c-pivot-far-away"}


def grooves(service):
    rows = []
    for case, name in CASES.items():
        answer = service.result("grooves", example("grooves/" + name))
        s = answer["sections"]
        rest = max(abs(s["area_a_mm2"][i] + s["area_b_mm2"][i] + s["area_c_mm2"][i] + s["area_d_mm2"][i] - s["area_e_mm2"][i]) for i in range(len(s["omega_deg"])))
        filler = s["area_d_mm2"]
        rows.append((case, f"{number(min(filler), 4)} to {number(max(filler), 4)}", "below 1e-9" if rest < 1e-9 else f"{rest:.0e}",
                     f"{number(answer['height_min_mm'])} to {number(answer['height_max_mm'])}", number(max(map(abs, s["twist_deg"])))))
    return table(["case", "filler area D of all sections, mm²", "A + B + C + D - E (11), mm²", "height h, mm", "twist of the surface (12), at most, deg"], rows)


def milling(service):
    rows = []
    for case, name in MILLED.items():
        body = example("mill-paths/" + name)
        ways = {way: service.result("mill-paths", body | {"optimise": {"method": way}})["positions"] for way in ("annealing", "chebyshev")}
        p = ways["chebyshev"]
        means = [sum(column) / len(column) for column in (p["gap_before_mm"], ways["annealing"]["gap_mm"], p["gap_mm"])]
        count = sum(over > 0.5 for over in p["overcut_before_mm"])
        rows.append((case, f"{number(max(p['overcut_before_mm']), 4)} / {number(max(p['undercut_before_mm']), 4)}", f"{count} of {len(p['omega_deg'])}",
                     f"{number(max(p['overcut_mm']), 4)} / {number(max(p['undercut_mm']), 4)}", " / ".join(number(mean, 4) for mean in means)))
    return table(["case", "overcut / undercut first, mm", "over 0.5 mm", "the same after, mm", "mean of (16) first / by annealing / ours, mm"], rows)


# Source 004

def feed_curves(service):
    rows = []
    for name, printed in PRINTED.items():
        asked = example(f"feed-curves/source-004-{name.replace(' ', '-')}-as-solved")
        nodes, feed, start = asked["fit"]["nodes_s"], asked["cut"]["feed_mm_s"], asked["cut"]["start_feed_mm"]
        whole = service.result("feed-curves", asked)["fit"]
        within = asked | {"cut": asked["cut"] | {"start_feed_mm": start + feed * nodes[0], "end_feed_mm": start + feed * nodes[-1]},
                          "fit": {"method": "three_point"}}
        between = service.result("feed-curves", within)["fit"]
        ratio = service.result("feed-curves", asked)["geometry"]["rad_per_mm"]
        for i, power in enumerate(("constant", "t", "t²")):
            rows.append((printed["equation"] if i == 0 else "", power, f"{printed['speed'][i]:.9g}", f"{whole['seconds'][i]:.9g}", "", ""))
        rows[-3] = (*rows[-3][:4], f"{printed['k']:g} / {ratio:.6f}", f"{printed['claim']} / {100 * between['max_relative_error']:.4f} %")
    return table(["equation", "coefficient of", "printed", "ours", "k, rad/mm: printed / solved", "error between the nodes: claimed / ours"], rows)


def cut_off(service):
    answer = service.result("feed-curves", example("feed-curves/cut-off-194-mm-whole-cycle"))
    cycle, tool = answer["cycle"], answer["tool"]
    return table(["Table 2, wall of 10 mm", "printed", "ours"], [
        ("pieces per hour", "120 on average", f"{number(cycle['pieces_per_hour'], 1)} at 1 mm/s; 120 need {number(cycle['feed_for_target_mm_s'], 3)} mm/s"),
        ("largest feed, mm", "39", f"{number(cycle['stop_feed_mm'])} reached"),
        ("blades, disc", "3; 150 to 450 rev/min",
         f"3; 300 rev/min: {number(tool['feed_per_blade_mm'], 4)} mm a blade, {number(tool['cutting_speed_outside_m_min'], 1)} m/min outside"),
    ])


def page(service):
    pair, held = offset_pair(service)
    return f"""# Figures and tables of the sources, compared with ours

Made by `tools/make_figures.py` from the service's answers to `examples/`; `ctest -R docs.figures` fails if a number here is not the
service's. The differences and their reasons are in [intersections-and-bevels.md](intersections-and-bevels.md) (section 0),
[grooves-and-milling.md](grooves-and-milling.md) (section 0) and [feed-curves.md](feed-curves.md) (section 7). Sources as in the
[glossary](../glossary.md).

## 000, Table 1 and Figure 3: where B jumps

Five junctions on the outer wall, 360 rows. The source says of its Figure 3 that B jumps only at junctions and not at every one by more than
the torch can swing, "such as point 263". With (2) as printed that is the step after row 260, the smallest of the five; on the weld's side it would be
another, because the authors took the dihedral inside the tube.

{junctions(service)}

Figure 3, before and after: as published, with a window of 15 points where B jumps by more than 10 deg, and as cut.

{smoothing(service)}

![B of Table 1 over phi: by the groove rule, clear of the partners, as cut](../b-curve-table-1.svg)

(`POST /v1/bevel-tables?format=svg&view=b_curve` of `examples/bevel-tables/source-000-table-1.json`. Figure 4, the end in space before and after, is
the same request's `format=glb`: nodes `before` and `after`.)

## 000, section 2.2: the counter that overflows

B as printed, 600 mm/min on every segment, 4 ms a period, at most 800 pulses in one; axes B / Y / Z1 of the default five-axis cutter
(`comparison.naive` of a schedule with `compare: true`). [pulse-schedules.md](pulse-schedules.md), section 10, shows them over time.

{pulses(service)}

## 002: two tubes whose axes pass each other

The source prints formulas and no numbers. R = 150, r = 80, t = 10 mm, alpha = 60 deg, e = 20 mm: ours / by its own formulas. Of Z, dihedral and omega the
largest difference over 360 rows is below {held}. Omega is B before contact and smoothing.

{pair}

## 001: grooves of equal area

The source prints no numbers; the three parameter sets are ours ([grooves-and-milling.md](grooves-and-milling.md)). Its Figures 1 and 2 are the
console's groove page and `format=svg&view=section`.

{grooves(service)}

The cone mill at its first positions, each with the whole generatrix on its ruling, and after (16) is minimised, by the source's annealing and by ours.
The source calls a position qualified within 0.5 mm.

{milling(service)}

## 004, Tables 1 to 3: the feed curve

The printed k gives neither of the printed polynomials; with the k that is solved from their shape both come out digit by digit.

{feed_curves(service)}

{cut_off(service)}

Servo limits and handling are not in the source; those of the example are assumptions.
"""


def main(binary, check):
    service = Service(binary)
    wanted = {DOCS / "theory/figures.md": page(service),
              DOCS / "b-curve-table-1.svg": service.text("bevel-tables", example("bevel-tables/source-000-table-1"), "--format", "svg", "--option", "view=b_curve"),
              DOCS / "overflow-table-1.svg": make_claim_svg.drawing(binary),
              DOCS / "part-table-1.svg": make_part_svg.first_sheet(make_part_svg.work_order(binary))}
    if not check:
        for file, text in wanted.items():
            file.write_text(text)
        return 0
    changed = 0
    for file, text in wanted.items():
        there = file.read_text() if file.exists() else ""
        if there != text:
            changed += 1
            print(f"{file.relative_to(ROOT)} is not what the service answers; mend by: tools/make_figures.py {binary}")
            sys.stdout.writelines(list(difflib.unified_diff(there.splitlines(True), text.splitlines(True), "there", "answered", n=0))[:40])
    return 1 if changed else 0


if __name__ == "__main__":
    arguments = [argument for argument in sys.argv[1:] if argument != "--check"]
    if len(arguments) != 1:
        sys.exit(__doc__)
    sys.exit(main(arguments[0], "--check" in sys.argv))
