#!/usr/bin/env python3
"""Draws docs/architecture.svg out of the includes of core, api and server: layers, rooms, who includes whom, and the way
of a request through them.

`tools/make_architecture_svg.py > docs/architecture.svg`; `--check FILE` ends with 1 when FILE is not what the tree
makes. A room without a line here, and rooms of core that include each other in a circle, are refused."""

import pathlib
import sys

import sources

HOLDS = {
    "server": ("process, App, config,", "access, admin port"),
    "server/http": ("listener, session, batch,", "framing, queue, memory"),
    "server/jobs": ("slots, capacity, helpers,", "memory of a job"),
    "server/observe": ("metrics, job log,", "job files"),
    "api": ("dispatch, pipeline,", "endpoint table"),
    "api/wire": ("reader, writer, JSON, CBOR,", "query, problems, columns"),
    "api/catalog": ("machines, posts, sizes,", "files of the catalogue"),
    "api/endpoints": ("a file an endpoint:", "decode and encode"),
    "api/formats": ("a writer a format: DXF, SVG,", "G-code, STEP, glTF, DSTV, ..."),
    "core/base": ("errors, angles,", "elementary functions"),
    "core/math": ("roots, fits, polygons,", "rotations"),
    "core/joint": ("where tubes meet: cutters,", "events, contour, node"),
    "core/bevel": ("the angle of the cut:", "groove, B, torch line, holes"),
    "core/part": ("a whole member: ends,", "holes, marks, order"),
    "core/frame": ("a whole frame:", "each joint once, its parts"),
    "core/motion": ("from a cut to pulses:", "path, plan, schedule, replay"),
    "core/torch": ("the torch round each cut:", "start, leads, pierce"),
    "core/cutoff": ("rotary cut-off:", "the feed curve"),
    "core/cutout": ("openings of their own:", "shapes, patterns, webs"),
    "core/plate": ("plates of a frame:", "outline, holes for tubes"),
    "core/section": ("tubes that are not round:", "outline, wall, standards"),
    "core/groove": ("equal-area groove", "and its mill path"),
}
LAYERS = ("server", "api", "core")
INK, FAINT, WAY = "#1c2733", "#66727f", "#c0392b"
FILL = {"server": "#efe6d3", "api": "#e2efe6", "core": "#dfeaf5"}
BOX = (168, 62)
COLUMN = 188  # from one level of core to the next
WIDTH = 1000  # at least: core takes as many columns as it has levels


def room_of(file):
    parts = file.split("/")
    if parts[0] == "core":
        return "/".join(parts[:2])
    return "/".join(parts[:-1][:2])


def rooms_and_edges(root):
    """Rooms with a source, and for each the other rooms of its layer that it includes; the layers that look down."""
    rooms, edges, down = set(), {}, set()
    for path in sources.cpp(root, LAYERS):
        file = path.relative_to(root).as_posix()
        here = room_of(file)
        rooms.add(here)
        for quoted, name in sources.includes(path.read_text()):
            layer = name.split("/")[0]
            if not quoted or layer not in LAYERS:
                continue
            if layer != here.split("/")[0]:
                down.add((here.split("/")[0], layer))
            elif (there := room_of(name)) != here:
                edges.setdefault(here, set()).add(there)
    return sorted(rooms), edges, down


def level(room, edges, above=()):
    """Longest way down from a room of core."""
    if room in above:
        sys.exit("rooms of core include each other: " + " -> ".join((*above, room)))
    return max((level(there, edges, (*above, room)) + 1 for there in edges.get(room, ())), default=0)


def reached(room, edges):
    out, todo = set(), list(edges.get(room, ()))
    while todo:
        here = todo.pop()
        if here not in out:
            out.add(here)
            todo += edges.get(here, ())
    return out


def needed(edges):
    """Core's edges without those that another way implies."""
    return {room: {there for there in to if not any(there in reached(other, edges) for other in to - {there})}
            for room, to in edges.items()}


class Picture:
    def __init__(self, width):
        self.out, self.width = [], width

    def text(self, x, y, words, size=12, colour=INK, weight="normal", anchor="middle"):
        self.out.append(f'<text x="{x:.0f}" y="{y:.0f}" font-size="{size}" font-weight="{weight}" fill="{colour}" '
                        f'text-anchor="{anchor}">{words}</text>')

    def band(self, layer, y, height):
        self.out.append(f'<rect x="20" y="{y}" width="{self.width - 40}" height="{height}" rx="8" fill="{FILL[layer]}"/>')
        self.text(36, y + 24, layer, 17, weight="bold", anchor="start")

    def box(self, room, x, y):
        w, h = BOX
        self.out.append(f'<rect x="{x - w / 2:.0f}" y="{y - h / 2:.0f}" width="{w}" height="{h}" rx="6" fill="#ffffff" '
                        f'stroke="{FAINT}"/>')
        self.text(x, y - 12, room, 14, weight="bold")
        for i, line in enumerate(HOLDS[room]):
            self.text(x, y + 6 + 15 * i, line, 11, FAINT)

    def arrow(self, a, b, colour=FAINT, both=False, width=1.4):
        """From the edge of the box around `a` to that around `b`."""
        def edge(here, there):
            dx, dy = there[0] - here[0], there[1] - here[1]
            share = min((BOX[0] / 2 + 3) / abs(dx) if dx else 9.0, (BOX[1] / 2 + 3) / abs(dy) if dy else 9.0)
            return here[0] + share * dx, here[1] + share * dy
        (x0, y0), (x1, y1) = edge(a, b), edge(b, a)
        start = f' marker-start="url(#tip-{colour[1:]})"' if both else ""
        self.out.append(f'<path d="M{x0:.0f} {y0:.0f}L{x1:.0f} {y1:.0f}" stroke="{colour}" stroke-width="{width}" '
                        f'marker-end="url(#tip-{colour[1:]})"{start}/>')

    def elbow(self, a, b):
        """From the right edge of the box around `a` up the gap before the column of `b` to its left edge."""
        gap, end = b[0] - BOX[0] / 2 - 9, b[0] - BOX[0] / 2 - 3
        self.out.append(f'<path d="M{a[0] + BOX[0] / 2:.0f} {a[1]}H{gap:.0f}V{b[1] + 14}H{end:.0f}" fill="none" '
                        f'stroke="{FAINT}" stroke-width="1.4" marker-end="url(#tip-{FAINT[1:]})"/>')

    def station(self, x, y, number, words):
        self.out.append(f'<circle cx="{x}" cy="{y}" r="11" fill="{WAY}"/>')
        self.text(x, y + 4, number, 12, "#ffffff", "bold")
        self.text(x + 17, y + 4, words, 12, WAY, "bold", "start")


def places(rooms, edges):
    """Centre of each room, the lower edge of core, the picture's width: server and api in a row, core by levels from the right."""
    at, columns = {}, {}
    for room in (r for r in rooms if r.startswith("core/")):
        columns.setdefault(level(room, edges), []).append(room)
    width = max(WIDTH, 2 * (BOX[0] // 2 + 32) + COLUMN * max(columns, default=0))
    for layer, y in (("server", 74), ("api", 206)):
        row = sorted((r for r in rooms if r.split("/")[0] == layer), reverse=layer == "server")
        pitch = min(270, (width - 220 - BOX[0] // 2 - 32) // max(1, len(row) - 1))
        for i, room in enumerate(row):
            at[room] = (220 + pitch * i, y)
    for step, column in columns.items():
        deep = sorted(column, key=lambda r: (-sum(r in reached(o, edges) for o in rooms), r))
        for i, room in enumerate(deep):
            at[room] = (width - BOX[0] // 2 - 32 - COLUMN * step, 364 + 86 * i)
    return at, 364 + 86 * max(map(len, columns.values())) - 32, width


def svg(root=sources.ROOT):
    rooms, edges, down = rooms_and_edges(root)
    if unknown := [room for room in rooms if room not in HOLDS]:
        sys.exit(f"make_architecture_svg: say what they hold: {', '.join(unknown)}")
    at, bottom, width = places(rooms, edges)
    p = Picture(width)
    p.band("server", 24, 100)
    p.band("api", 156, 100)
    p.band("core", 288, bottom - 288)
    for above, below in sorted(down):
        y = {("server", "api"): 124, ("api", "core"): 256, ("server", "core"): 124}[above, below]
        end = 156 if below == "api" else 288
        x = width - 100 if LAYERS.index(below) - LAYERS.index(above) == 1 else width - 70
        p.out.append(f'<path d="M{x} {y}V{end - 3}" stroke="{INK}" stroke-width="2" marker-end="url(#tip-{INK[1:]})"/>')
    core = needed({room: to for room, to in edges.items() if room.startswith("core/")})
    beside = {room: to for room, to in edges.items() if not room.startswith("core/")}
    drawn = set()
    for room, to in sorted({**beside, **core}.items()):
        for there in sorted(to):
            if (there, room) in drawn:
                continue
            drawn.add((room, there))
            if at[there][1] < at[room][1]:
                p.elbow(at[room], at[there])
                continue
            apart = abs(at[room][0] - at[there][0]) > 300 and at[room][1] == at[there][1]
            if apart:  # over the head of the room between them
                x0, x1, y = at[room][0], at[there][0], at[room][1] - BOX[1] / 2
                both = f' marker-start="url(#tip-{FAINT[1:]})"' if room in edges.get(there, ()) else ""
                p.out.append(f'<path d="M{x0} {y - 3:.0f}C{x0} {y - 22:.0f} {x1} {y - 22:.0f} {x1} {y - 3:.0f}" fill="none" '
                             f'stroke="{FAINT}" stroke-width="1.4" marker-end="url(#tip-{FAINT[1:]})"{both}/>')
            else:
                p.arrow(at[room], at[there], both=room in edges.get(there, ()))
    for room in rooms:
        p.box(room, *at[room])
    x, y = at["api"]
    p.station(x - 60, y + 42, 1, "parse")
    x, y = at["api/endpoints"]
    p.station(x - 78, y + 42, 2, "decode")
    p.station(x + 12, y + 42, 4, "encode")
    p.station(x - 78, 313, 3, "compute, verify")
    tips = "".join(f'<marker id="tip-{c[1:]}" viewBox="0 0 10 10" refX="9" refY="5" markerUnits="userSpaceOnUse" '
                   f'markerWidth="10" markerHeight="10" orient="auto-start-reverse"><path d="M0 1 L10 5 L0 9Z" fill="{c}"/>'
                   f'</marker>' for c in (INK, FAINT))
    height = bottom + 20
    return "\n".join((
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
        f'font-family="DejaVu Sans, Verdana, Arial, sans-serif">',
        "<title>tubecut's layers and rooms by their includes, and the way of a request</title>",
        f'<defs>{tips}</defs><rect width="{width}" height="{height}" fill="#ffffff"/>',
        *p.out, "</svg>", ""))


def main():
    if len(sys.argv) == 1:
        sys.stdout.write(svg())
        return 0
    if len(sys.argv) != 3 or sys.argv[1] != "--check":
        sys.exit(__doc__)
    path = pathlib.Path(sys.argv[2])
    if path.read_text() == svg():
        return 0
    print(f"make_architecture_svg: {path} is not what the includes make; tools/make_architecture_svg.py > {path}")
    return 1


if __name__ == "__main__":
    sys.exit(main())
