"""Where everything of an SVG lies: boxes in the units of its view box, with the widths that letters have in a wide font.

The widths are those of DejaVu Sans, a thousandth of the height each, from the blank to the tilde: the test needs no font."""

import math
import re
import xml.etree.ElementTree as ElementTree

PLAIN = (318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636, 636, 636, 636, 636, 636, 636, 636, 337, 337,
         838, 838, 838, 531, 1000, 684, 686, 698, 770, 632, 575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635, 611, 732, 684, 989,
         685, 611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352, 635, 634, 278, 278, 579, 278, 974, 634, 612, 635, 635, 411, 521,
         392, 634, 592, 818, 592, 592, 525, 636, 337, 636, 838)
BOLD = (348, 456, 521, 838, 696, 1002, 872, 306, 457, 457, 523, 838, 380, 415, 380, 365, 696, 696, 696, 696, 696, 696, 696, 696, 696, 696, 400, 400,
        838, 838, 838, 580, 1000, 774, 762, 734, 830, 683, 683, 821, 837, 372, 372, 775, 637, 995, 837, 850, 733, 850, 770, 720, 682, 812, 774, 1103,
        771, 724, 725, 457, 365, 457, 838, 500, 500, 675, 716, 593, 716, 678, 435, 716, 712, 343, 343, 665, 343, 1042, 712, 687, 716, 716, 493, 595,
        478, 712, 652, 924, 645, 652, 582, 712, 365, 712, 838)
LATIN, WIDE = 640, 1000  # beyond: letters of Europe, and those that fill a square
UP, DOWN = 0.76, 0.24  # of the height
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")
NOT_SEEN = {"title", "desc", "defs", "clipPath", "marker", "style", "metadata"}


def width(text, height, bold):
    table = BOLD if bold else PLAIN
    return height * 1e-3 * sum(table[ord(c) - 32] if 32 <= ord(c) < 127 else LATIN if ord(c) < 0x1100 else WIDE for c in text)


def times(a, b):
    """Two transforms (a b c d e f), the inner one last."""
    return (a[0] * b[0] + a[2] * b[1], a[1] * b[0] + a[3] * b[1], a[0] * b[2] + a[2] * b[3], a[1] * b[2] + a[3] * b[3],
            a[0] * b[4] + a[2] * b[5] + a[4], a[1] * b[4] + a[3] * b[5] + a[5])


def transform(text):
    out = (1, 0, 0, 1, 0, 0)
    for name, inner in re.findall(r"(\w+)\s*\(([^)]*)\)", text or ""):
        v = [float(n) for n in NUMBER.findall(inner)]
        if name == "translate":
            one = (1, 0, 0, 1, v[0], v[1] if len(v) > 1 else 0)
        elif name == "scale":
            one = (v[0], 0, 0, v[-1], 0, 0)
        elif name == "rotate":
            c, s = math.cos(math.radians(v[0])), math.sin(math.radians(v[0]))
            one = (c, s, -s, c, 0, 0)
            if len(v) == 3:
                one = times(times((1, 0, 0, 1, v[1], v[2]), one), (1, 0, 0, 1, -v[1], -v[2]))
        elif name == "matrix":
            one = tuple(v)
        else:
            raise AssertionError(f"transform {name}")
        out = times(out, one)
    return out


def path_points(d):
    """The points of a path, those that its curves are drawn by too: they hold it."""
    out, at, begin = [], (0.0, 0.0), (0.0, 0.0)
    for letter, inner in re.findall(r"([a-zA-Z])([^a-zA-Z]*(?:e[-+]?\d+[^a-zA-Z]*)*)", d):
        v = [float(n) for n in NUMBER.findall(inner)]
        base = at if letter.islower() else (0.0, 0.0)
        kind = letter.upper()
        if kind == "Z":
            at = begin
        elif kind == "H":
            for x in v:
                at = (base[0] + x, at[1])
                out.append(at)
        elif kind == "V":
            for y in v:
                at = (at[0], base[1] + y)
                out.append(at)
        elif kind == "A":
            for i in range(0, len(v), 7):
                rx, ry, end = v[i], v[i + 1], (base[0] + v[i + 5], base[1] + v[i + 6])
                out += [at, end] + [(p[0] + a * rx, p[1] + b * ry) for p in (at, end) for a in (-1, 1) for b in (-1, 1)]
                at = end
        elif kind in "MLCSQT":
            step = {"C": 6, "S": 4, "Q": 4}.get(kind, 2)
            for i in range(0, len(v), step):
                base = at if letter.islower() else (0.0, 0.0)
                points = [(base[0] + v[k], base[1] + v[k + 1]) for k in range(i, i + step, 2)]
                out += points
                at = points[-1]
                if kind == "M" and i == 0:
                    begin = at
        else:
            raise AssertionError(f"path command {letter}")
    return out


def box_of(points):
    return (min(x for x, _ in points), min(y for _, y in points), max(x for x, _ in points), max(y for _, y in points))


class Picture:
    """`view`: its view box (left, top, right, low); `things`: (what, its box, the box that clips it or None)."""

    def __init__(self, content):
        root = ElementTree.fromstring(content)
        x, y, w, h = (float(n) for n in root.get("viewBox").split())
        self.view, self.things, self.texts = (x, y, x + w, y + h), [], []
        self.clips = {e.get("id"): box_of([tuple(map(float, p.split(","))) for p in e[0].get("points").split()])
                      for e in root.iter() if e.tag.endswith("clipPath") and e[0].get("points")}
        self.walk(root, (1, 0, 0, 1, 0, 0), {"font-size": "16", "text-anchor": "start", "font-weight": "normal", "stroke": "none", "stroke-width": "1"}, None, "")

    def walk(self, e, outer, style, clip, sheet):
        name = e.tag.split("}")[-1]
        if name in NOT_SEEN:
            return
        style = style | {key: e.get(key) for key in style if e.get(key)}
        at = times(outer, transform(e.get("transform")))
        if found := re.fullmatch(r"url\(#(.*)\)", e.get("clip-path") or ""):
            inner = self.clips[found[1]]
            clip = inner if clip is None else (max(inner[0], clip[0]), max(inner[1], clip[1]), min(inner[2], clip[2]), min(inner[3], clip[3]))
        if re.fullmatch(r"sheet-\d+", e.get("id") or ""):
            sheet = e.get("id")
        if name in ("svg", "g", "a", "switch"):
            for child in e:
                self.walk(child, at, style, clip, sheet)
            return
        points, words = self.points(name, e, style)
        if not points:
            return
        drawn = [(at[0] * x + at[2] * y + at[4], at[1] * x + at[3] * y + at[5]) for x, y in points]
        pen = 0.0 if name == "text" or style["stroke"] == "none" else 0.5 * float(style["stroke-width"])
        left, top, right, low = box_of(drawn)
        self.things.append((words, (left - pen, top - pen, right + pen, low + pen), clip, sheet))

    @staticmethod
    def points(name, e, style):
        def number(key, default=0.0):
            return float(NUMBER.match(e.get(key, str(default)))[0])
        if name == "text":
            text = "".join(e.itertext())
            height = float(NUMBER.match(style["font-size"])[0])
            wide = width(text, height, style["font-weight"] in ("bold", "600", "700"))
            x = number("x") - {"start": 0.0, "middle": 0.5, "end": 1.0}[style["text-anchor"]] * wide
            y = number("y")
            return ([(x, y - UP * height), (x + wide, y + DOWN * height), (x, y + DOWN * height), (x + wide, y - UP * height)], text) if text.strip() else ([], "")
        if name == "rect":
            if e.get("width") == "100%":
                return [], ""
            x, y = number("x"), number("y")
            return [(x, y), (x + number("width"), y + number("height"))], name
        if name == "line":
            return [(number("x1"), number("y1")), (number("x2"), number("y2"))], name
        if name in ("polyline", "polygon"):
            v = [float(n) for n in NUMBER.findall(e.get("points", ""))]
            return list(zip(v[::2], v[1::2])), name
        if name in ("circle", "ellipse"):
            rx, ry = (number("r"), number("r")) if name == "circle" else (number("rx"), number("ry"))
            return [(number("cx") - rx, number("cy") - ry), (number("cx") + rx, number("cy") + ry)], name
        if name == "path":
            return path_points(e.get("d", "")), name
        raise AssertionError(f"no way to tell where a {name} lies")

    def outside(self, slack=0.01):
        """What leaves the view box, or its own sheet of several; and every text that is cut off by the rectangle that clips it."""
        sheets = sorted({sheet for *_, sheet in self.things if sheet}, key=lambda s: int(s.split("-")[1]))
        left, top, right, low = self.view
        tall = (low - top) / max(1, len(sheets))
        out = []
        for what, box, clip, sheet in self.things:
            if clip is not None:
                if what not in ("rect", "line", "polyline", "polygon", "path", "circle", "ellipse") and not within(box, clip, slack) and meets(box, clip):
                    out.append((what, box))
                box = (max(box[0], clip[0]), max(box[1], clip[1]), min(box[2], clip[2]), min(box[3], clip[3]))
                if box[0] > box[2] or box[1] > box[3]:
                    continue
            begin = top + tall * sheets.index(sheet) if sheet else top
            if not within(box, (left, begin, right, begin + tall if sheet else low), slack):
                out.append((what, box))
        return out


def within(box, room, slack):
    return box[0] >= room[0] - slack and box[1] >= room[1] - slack and box[2] <= room[2] + slack and box[3] <= room[3] + slack


def meets(box, room):
    return box[0] < room[2] and box[2] > room[0] and box[1] < room[3] and box[3] > room[1]
