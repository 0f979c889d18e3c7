#!/usr/bin/env python3
"""Draws docs/part-table-1.svg from the service's own answer: the node of source 000, Table 1, as a part with a square far end.

`tools/make_part_svg.py SERVER_BINARY > docs/part-table-1.svg` starts the binary on free ports and posts the example to it."""

import json
import math
import pathlib
import subprocess
import sys
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "examples/parts/table-1-with-a-square-far-end.json"
WIDTH, HEIGHT = 1000, 600
INK, SOFT, TUBE, BORE, CUT, MARK, DIM = "#1c2733", "#66727f", "#cfdbe8", "#9fb2c6", "#e9b872", "#c0392b", "#1d7a46"
PARTNERS = ["#2f6fab", "#8e5ea2", "#3a9a7c", "#b06a2c"]
ALONG = math.radians(30)   # the tube runs to the right and back
ROLL = math.radians(-100)  # turned so that the deep cope shows


def answer(binary):
    server = subprocess.Popen([binary, "--host", "127.0.0.1", "--port", "0", "--admin-port", "0"], stdout=subprocess.PIPE, text=True)
    try:
        port = next(json.loads(line)["port"] for line in server.stdout if '"ready"' in line)
        request = urllib.request.Request(f"http://127.0.0.1:{port}/v1/parts", EXAMPLE.read_bytes(), {"Content-Type": "application/json"})
        return json.load(urllib.request.urlopen(request, timeout=30))
    finally:
        server.terminate()
        server.wait()


class Page:
    def __init__(self):
        self.out = []

    def path(self, points, stroke="none", width=1.2, fill="none", dash="", close=False):
        d = "M" + " L".join(f"{x:.1f},{y:.1f}" for x, y in points) + ("Z" if close else "")
        extra = f' stroke-dasharray="{dash}"' if dash else ""
        self.out.append(f'<path d="{d}" fill="{fill}" stroke="{stroke}" stroke-width="{width}" stroke-linejoin="round"{extra}/>')

    def text(self, x, y, words, colour=INK, size=13, anchor="start", weight="normal", turn=0):
        spin = f' transform="rotate({turn} {x:.1f} {y:.1f})"' if turn else ""
        self.out.append(f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" font-size="{size}" text-anchor="{anchor}" font-weight="{weight}"{spin}>{words}</text>')

    def dot(self, x, y, colour, size=4):
        self.out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{size}" fill="{colour}"/>')

    def arrow(self, a, b, colour):
        """A dimension line with a head at both ends."""
        self.path([a, b], colour, 1.1)
        angle = math.atan2(b[1] - a[1], b[0] - a[0])
        for (x, y), back in ((a, 0), (b, math.pi)):
            wings = [(x + 7 * math.cos(angle + back + w), y + 7 * math.sin(angle + back + w)) for w in (0.35, -0.35)]
            self.path([wings[0], (x, y), wings[1]], colour, 1.1, colour, close=True)


class View:
    """The part in space, its axis to the right; seen from the front, parallel: right, up and towards the eye are right-handed."""

    def __init__(self, x, y, scale):
        self.x, self.y, self.scale = x, y, scale

    def turned(self, radius, phi, z):
        a, b = radius * math.cos(phi + ROLL), -radius * math.sin(phi + ROLL)
        right = z * math.cos(ALONG) + a * math.sin(ALONG)
        depth = z * math.sin(ALONG) - a * math.cos(ALONG)  # smaller is nearer
        return right, b, depth

    def __call__(self, radius, phi, z):
        right, up, _ = self.turned(radius, phi, z)
        return self.x + self.scale * right, self.y - self.scale * up

    def depth(self, radius, phi, z):
        return self.turned(radius, phi, z)[2]

    def faces(self, phi):
        """Cosine between the outward normal at phi and the line of sight towards the eye."""
        return -self.turned(1, phi, 0)[2]


def shade(colour, light):
    light = max(0.0, min(1.0, light))
    return "#" + "".join(f"{round(int(colour[i:i + 2], 16) * (0.55 + 0.45 * light)):02x}" for i in (1, 3, 5))


def solid(page, view, part):
    """The bore's far side, then the start's cut face, then the outside: nothing else is seen from the start."""
    start, finish, outer, inner = part["start"], part["finish"], part["outer"], part["inner"]
    n = len(start["phi"])
    bore, face, outside = [], [], []
    for i in range(n):
        j = (i + 1) % n
        p, q = start["phi"][i], start["phi"][j] + (2 * math.pi if j == 0 else 0)
        seen = view.faces((p + q) / 2)
        for radius, side, name, colour, quads in ((outer, 1, "z_outer", TUBE, outside), (inner, -1, "z_inner", BORE, bore)):
            corners = [(radius, p, start[name][i]), (radius, q, start[name][j]), (radius, q, finish[name][j]), (radius, p, finish[name][i])]
            if side * seen > 0:
                quads.append((corners, shade(colour, side * seen)))
        face.append(([(outer, p, start["z_outer"][i]), (outer, q, start["z_outer"][j]),
                      (inner, q, start["z_inner"][j]), (inner, p, start["z_inner"][i])], CUT))
    face.sort(key=lambda quad: -min(view.depth(*corner) for corner in quad[0]))
    for corners, colour in bore + face + outside:
        page.path([view(*c) for c in corners], colour, 0.6, colour, close=True)


def developed(page, part, box):
    """The outside laid flat as seen from outside: z to the right, so phi downwards."""
    x0, y0, scale = box
    girth = 2 * math.pi * part["outer"]
    at = lambda around, z: (x0 + scale * z, y0 - scale * (girth - around))
    start, finish, long_mm = part["start"], part["finish"], part["lengths"]["long_mm"]
    around = [part["outer"] * p for p in start["phi"]] + [girth]
    edge = {name: start[name] + start[name][:1] for name in ("z_outer", "z_inner", "torch_outer")}
    far = finish["z_outer"] + finish["z_outer"][:1]
    outline = [at(a, z) for a, z in zip(around, edge["z_outer"])] + [at(a, z) for a, z in reversed(list(zip(around, far)))]
    page.path(outline, "none", 0, "#eef3f8", close=True)
    page.path([at(0, 0), at(girth, 0)], SOFT, 0.8, dash="2 3")
    for k in range(5):
        a = girth * k / 4
        length = part["quarters"][k % 4]
        begin = edge["z_outer"][min(range(len(around)), key=lambda i: abs(around[i] - a))]
        page.path([at(a, begin), at(a, long_mm)], MARK if k in (0, 4) else SOFT, 1.4 if k in (0, 4) else 0.7, dash="" if k in (0, 4) else "5 4")
        page.text(x0 - 10, at(a, 0)[1] + 4, f"{90 * k}&#176;", MARK if k in (0, 4) else SOFT, 12, "end")
        if k < 4:
            page.text(x0 + scale * (begin + long_mm) / 2 + 40, at(a, 0)[1] + 13, f"{length:.1f}", DIM, 13, "middle")
    cutter = start["cutter"]
    for i in range(len(cutter)):
        page.path([at(around[i], edge["z_outer"][i]), at(around[i + 1], edge["z_outer"][i + 1])], PARTNERS[cutter[i]], 2.4)
    page.path([at(a, z) for a, z in zip(around, edge["z_inner"])], SOFT, 1, dash="5 3")
    page.path([at(a, z) for a, z in zip(around, far)], INK, 2)
    for which, name in (("long_point", "long point"), ("short_point", "short point")):
        point = part[which]
        x, y = at(point["girth_mm"], point["z_mm"])
        page.dot(x, y, DIM)
        page.text(x + 9, y + (14 if which == "long_point" else 1), f"{name}, {point['girth_mm']:.1f} round", DIM, 12)
    y = y0 + 26
    page.arrow((x0, y), (x0 + scale * long_mm, y), INK)
    page.text(x0 + scale * long_mm / 2, y + 17, f"{long_mm:.1f} tip to tip", INK, 13, "middle")
    x = x0 + scale * long_mm + 16
    page.arrow((x, y0), (x, y0 - scale * girth), INK)
    page.text(x + 16, y0 - scale * girth / 2, f"girth {girth:.1f}", INK, 13, "middle", turn=-90)


def table(page, dimensions, x, y):
    page.text(x, y, "Check dimensions, mm", INK, 14, weight="bold")
    page.text(x + 238, y, "changes with", SOFT, 12)
    for k, d in enumerate(dimensions):
        line = y + 24 + 20.5 * k
        page.text(x, line, d["name"].replace("_", " "), INK, 12.5)
        page.text(x + 222, line, f"{d['value_mm']:.1f}", DIM, 12.5, "end", "bold")
        page.text(x + 238, line, ", ".join(m.replace("_", " ") for m in d["changes_with"]), SOFT, 11.5)


def draw(body):
    result = body["result"]
    target = body["request"]["target"]
    outer = target["outer_diameter_mm"] / 2

    def end(name):
        points = result["ends"][name]["points"]
        return {"phi": [math.radians(p) for p in points["phi_deg"]], "cutter": points["cutter"],
                **{column: points[f"{column}_mm"] for column in ("z_outer", "z_inner", "torch_outer")}}

    part = {"start": end("start"), "finish": end("finish"), "outer": outer, "inner": outer - target["wall_mm"],
            "lengths": result["lengths"], "long_point": result["ends"]["start"]["long_point"],
            "short_point": result["ends"]["start"]["short_point"],
            "quarters": [next(d["value_mm"] for d in result["check_dimensions"] if d["name"] == f"length_at_{90 * k}") for k in range(4)]}
    page = Page()
    view = View(110, 128, 1.62)
    page.text(40, 34, "One request, one part: both ends in one frame, and the numbers to check it with a tape", INK, 17, weight="bold")
    solid(page, view, part)
    lines = [f"{target['outer_diameter_mm']:g} x {target['wall_mm']:g} tube, {result['lengths']['mass_kg']:.2f} kg",
             f"blank {result['lengths']['blank_mm']:.1f} mm, weld {result['lengths']['weld_mm']:.1f} mm",
             "z = 0 at the start's tip, phi = 0 on the datum line", "order: marks, then the finish, then the start"]
    for k, line in enumerate(lines):
        page.text(650, 98 + 22 * k, line, SOFT if k else INK, 13 if k else 15)
    developed(page, part, (80, 535, 1.22))
    page.text(80, 256, "Laid flat, seen from outside: the start's outer edge, one colour a partner; its inner edge dashed", SOFT, 13)
    table(page, result["check_dimensions"], 580, 278)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="system-ui, sans-serif">'
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>' + "\n".join(page.out) + "</svg>\n")


if __name__ == "__main__":
    sys.stdout.write(draw(answer(sys.argv[1])))
