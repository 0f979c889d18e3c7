#!/usr/bin/env python3
"""Draws docs/overflow-table-1.svg: source 000's claim, from the service's own answers.

Table 1 with B raw and with a transition of 20 points (tests/golden/pulse-schedules.json), 600 mm/min, the default five-axis cutter:
pulses per 4 ms that every contour segment would ask for at full speed, and those of the schedule.
`tools/make_claim_svg.py SERVER > docs/overflow-table-1.svg`."""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PERIOD, MOST = 0.004, 800
AXES = {"Y": "#1f5fbf", "Z1": "#1e8449", "B": "#c0392b"}
INK, GRID = "#1c2733", "#d5dbe1"
WIDTH, HEIGHT, LEFT, GAP = 470, 300, 70, 60
LOW, HIGH = 1.0, 10_000.0


def columns(points):
    table = json.loads((ROOT / "tests/golden/pulse-schedules.json").read_text())["table1_contour"]
    return table["phi_deg"], table["z_mm"], table["b_deg_by_transition_points"][str(points)]


def unplanned(answer):
    """[(time, {axis: pulses per period})] of every segment at full speed, and when the last one ends."""
    naive = answer["comparison"]["naive"]
    starts = [0.0, *naive["end_s"]]
    pulses = {axis["name"]: axis["pulses"] for axis in naive["axes"]}
    return [(t, {a: pulses[a][i] for a in AXES}) for i, t in enumerate(starts[:-1])], starts[-1]


def planned(server, phi, z, b):
    """The service's schedule. The source counts B towards the waste; a request counts it into the part."""
    shelf = machine(server)
    shelf["b_positive"] = "outer_edge_to_waste"
    body = {"contour": {"phi_deg": phi, "z_mm": z, "b_deg": [-v for v in b], "outer_diameter_mm": 70, "wall_mm": 5, "surface": "outer",
                        "closed": True, "b_sign": "outer_edge_to_plus_z"}, "machine": shelf, "motion": {"speed": {"mm_min": 600}, "direction": "ccw", "compare": True}}
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(body, file)
        file.flush()
        done = subprocess.run([server, "run", "--endpoint", "pulse-schedules", file.name], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["result"]


def machine(server):
    """The default machine, as a request that ran echoes it."""
    body = json.loads((ROOT / "examples/pulse-schedules/square-cut-from-a-bare-contour.json").read_text())
    return body["machine"]


class Panel:
    def __init__(self, column, row, title, seconds):
        self.x, self.y, self.seconds = LEFT + column * (WIDTH + GAP), 70 + row * (HEIGHT + 80), seconds
        self.out = []
        self.text(self.x + WIDTH / 2, self.y - 14, title, "middle", 15, "bold")
        for decade in (1, 10, 100, 1000, 10_000):
            self.line(0, decade, seconds, decade, GRID, 1)
            self.text(self.x - 8, self.py(decade) + 4, f"{decade:,}".replace(",", " "), "end")
        for t in range(0, int(seconds) + 1, 5):
            self.text(self.px(t), self.y + HEIGHT + 18, f"{t}", "middle")
        self.text(self.x + WIDTH, self.y + HEIGHT + 36, "time, s", "end")
        self.line(0, MOST, seconds, MOST, INK, 1.4, "6 4")
        self.text(self.x + WIDTH - 6, self.py(MOST) - 5, "the counter holds 800", "end")

    def px(self, t):
        return self.x + WIDTH * t / self.seconds

    def py(self, n):
        share = math.log(min(max(n, LOW), HIGH) / LOW) / math.log(HIGH / LOW)
        return self.y + HEIGHT * (1 - share)

    def text(self, x, y, words, anchor, size=12, weight="normal", colour=INK):
        self.out.append(f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" font-weight="{weight}" text-anchor="{anchor}" '
                        f'fill="{colour}">{words}</text>')

    def line(self, t0, n0, t1, n1, colour, width, dash=""):
        extra = f' stroke-dasharray="{dash}"' if dash else ""
        self.out.append(f'<line x1="{self.px(t0):.1f}" y1="{self.py(n0):.1f}" x2="{self.px(t1):.1f}" y2="{self.py(n1):.1f}" '
                        f'stroke="{colour}" stroke-width="{width}"{extra}/>')

    def curve(self, points, colour):
        d = " L".join(f"{self.px(t):.1f},{self.py(n):.1f}" for t, n in points)
        self.out.append(f'<path d="M{d}" fill="none" stroke="{colour}" stroke-width="1.3"/>')


def steps(segments, end, axis):
    times = [t for t, _ in segments] + [end]
    return [(t, pulses[axis]) for i, (_, pulses) in enumerate(segments) for t in times[i:i + 2]]


def thinned(counts, pixels=WIDTH):
    """The largest of each stretch that one pixel shows."""
    stride = max(1, len(counts) // pixels)
    return [(PERIOD * i, max(map(abs, counts[i:i + stride]))) for i in range(0, len(counts), stride)]


def drawing(server):
    """The picture's text."""
    panels, peaks = [], []
    for column, points in enumerate((0, 20)):
        phi, z, b = columns(points)
        answer = planned(server, phi, z, b)
        segments, end = unplanned(answer)
        seconds = answer["report"]["time_s"]
        name = "B raw" if points == 0 else f"B over {points} points"
        top = Panel(column, 0, f"{name}: every segment at 600 mm/min, {end:.1f} s", 33)
        below = Panel(column, 1, f"{name}: this schedule, {seconds:.1f} s", 33)
        for axis, colour in AXES.items():
            top.curve(steps(segments, end, axis), colour)
            below.curve(thinned(answer["counts"][axis]), colour)
        panels += [top, below]
        peaks.append({a: (round(max(p[a] for _, p in segments)), answer["report"]["peak"][a]) for a in AXES})
        for panel, which in ((top, 0), (below, 1)):
            words = "largest: " + ", ".join(f"{a} {peaks[-1][a][which]}" for a in AXES)
            panel.text(panel.x + 6, panel.y + 16, words, "start")
    width, height = LEFT + 2 * WIDTH + GAP + 20, 70 + 2 * (HEIGHT + 80) - 10
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    x = LEFT
    out.append(f'<text x="{x}" y="26" font-size="15" fill="{INK}">Pulses per period of 4 ms, Table 1 of source 000:</text>')
    for i, (axis, colour) in enumerate(AXES.items()):
        x = LEFT + 380 + 110 * i
        out.append(f'<line x1="{x}" y1="21" x2="{x + 30}" y2="21" stroke="{colour}" stroke-width="3"/>'
                   f'<text x="{x + 38}" y="26" font-size="15" fill="{INK}">{axis}</text>')
    for panel in panels:
        out += panel.out
    return "\n".join([*out, "</svg>", ""])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.stdout.write(drawing(sys.argv[1]))
