"""The 1:1 drawings drawn by librsvg and measured in its pixels."""

import itertools
import json
import math
import pathlib
import re
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree

import cairo
import gi

gi.require_version("Rsvg", "2.0")
from gi.repository import Rsvg  # noqa: E402

import pdf_reader  # noqa: E402
from dxf_test import polylines, read  # noqa: E402
from service import HOSTILE, ROOT, FormatTest, cutouts, examples, main, off_curve, rolled, seam_row  # noqa: E402

# Names in a work order (docs/glossary.md), and the mistakes.
CALLED = dict(re.findall(r"^\| `(length_at_\w+|\w+_(?:girth|chord|overhang))` \| ([^|]+) \|", (ROOT / "docs/glossary.md").read_text(), re.M))
MISTAKES = {"diameter": "another diameter", "wall": "another wall", "clocking": "an end turned", "mirror": "an end mirrored",
            "b_sign": "B the wrong way", "pivot_length": "pivot length off"}
DPI = 254  # ten pixels a millimetre
SVG = "{http://www.w3.org/2000/svg}"
BLUE = (0x1f, 0x5f, 0xbf)


def first_to_last(line):
    """Pixels from the middle of the first run of dark ones to the middle of the last."""
    dark = [i for i, d in enumerate(line) if d]
    starts = [i for i in dark if i - 1 not in dark]
    ends = [i for i in dark if i + 1 not in dark]
    return (starts[-1] + ends[-1] - starts[0] - ends[0]) / 2


def off_line(point, line):
    """Distance of a point of the sheet to a polyline on it."""
    best = math.inf
    for (x0, y0), (x1, y1) in zip(line, line[1:]):
        dx, dy = x1 - x0, y1 - y0
        square = dx * dx + dy * dy
        share = min(1.0, max(0.0, ((point[0] - x0) * dx + (point[1] - y0) * dy) / square)) if square else 0.0
        best = min(best, math.dist(point, (x0 + share * dx, y0 + share * dy)))
    return best


class Drawing:
    def __init__(self, svg):
        self.root = ElementTree.fromstring(svg)
        self.height_mm = float(self.root.get("height").removesuffix("mm"))
        self.width_mm = float(self.root.get("width").removesuffix("mm"))
        handle = Rsvg.Handle.new_from_data(svg)
        handle.set_dpi(DPI)
        _, width, height = handle.get_intrinsic_size_in_pixels()
        self.width, self.height = round(width), round(height)
        surface = cairo.ImageSurface(cairo.FORMAT_RGB24, self.width, self.height)
        sheet = Rsvg.Rectangle()
        sheet.x, sheet.y, sheet.width, sheet.height = 0, 0, width, height
        handle.render_document(cairo.Context(surface), sheet)
        surface.flush()
        self.bytes, self.stride = bytes(surface.get_data()), surface.get_stride()

    def color(self, x, y):
        return tuple(reversed(self.bytes[y * self.stride + 4 * x:y * self.stride + 4 * x + 3]))

    def dark(self, x, y):
        return sum(self.color(x, y)) < 384

    def element(self, name):
        return next(e for e in self.root.iter() if e.get("id") == name)

    def blue_at(self, x):
        """y in mm of the middle of the blue pixels of column x, up from the lower edge."""
        found = [y for y in range(self.height) if math.dist(self.color(x, y), BLUE) < 60]
        return (self.height - (found[0] + found[-1] + 1) / 2) * 25.4 / DPI if found else None


class Svg(FormatTest):
    def drawing(self, endpoint, body, view, more=""):
        return Drawing(self.service.text(endpoint, body, f"format=svg&view={view}{more}"))

    def test_the_ruler_is_100_mm_both_ways(self):
        for endpoint, name in (("bevel-tables", "source-000-table-1"), ("holes", "set-on-branch"),
                               ("intersections", "source-000-table-1")):
            with self.subTest(endpoint):
                d = self.drawing(endpoint, examples(endpoint)[name], "template")
                self.assertAlmostEqual(d.width, d.width_mm * DPI / 25.4, delta=1)
                self.assertAlmostEqual(d.height, d.height_mm * DPI / 25.4, delta=1)
                across, up = d.element("ruler-x"), d.element("ruler-y")
                y, x = (round(float(e.get(a)) * DPI / 25.4) for e, a in ((across, "y1"), (up, "x1")))
                # One millimetre off the line only its ticks are met, the first and the last at its ends.
                for pixels in (first_to_last(d.dark(i, y - 10) for i in range(d.width)),
                               first_to_last(d.dark(x + 10, i) for i in range(d.height))):
                    print(f"{endpoint}: a ruler of {pixels * 25.4 / DPI:.2f} mm")
                    self.assertAlmostEqual(pixels * 25.4 / DPI, 100.0, delta=0.051)

    def test_the_outer_edge_is_where_the_table_has_it(self):
        body = examples("bevel-tables")["source-000-table-1"]
        points = self.service.answer("bevel-tables", body)["result"]["points"]
        for mirror in (False, True):
            d = self.drawing("bevel-tables", body, "template", "&mirror=true" if mirror else "")
            seam = {k: float(d.element(k).get("x1")) for k in ("seam-0", "seam-360")}
            self.assertAlmostEqual(abs(seam["seam-360"] - seam["seam-0"]), math.pi * 70, delta=2e-3)
            self.assertEqual(seam["seam-360"] < seam["seam-0"], mirror)
            rows, offsets = seam_row(points["phi_deg"], points["z_outer_mm"]), []
            for column in range(0, d.width, 37):
                middle = (column + 0.5) * 25.4 / DPI
                phi = (middle - seam["seam-0"]) / (seam["seam-360"] - seam["seam-0"]) * 360
                if not 2 < phi < 358:
                    continue
                (p, u), (q, v) = next(pair for pair in zip(rows, rows[1:]) if pair[0][0] <= phi <= pair[1][0])
                offsets.append(d.blue_at(column) - (u + (phi - p) / (q - p) * (v - u)))
            self.assertGreater(len(offsets), 40)
            self.assertLess(max(offsets) - min(offsets), 0.2)

    def test_open_text_is_text(self):
        for endpoint, view in (("bevel-tables", "template"), ("bevel-tables", "section"), ("bevel-tables", "chart"),
                               ("intersections", "template"), ("holes", "section")):
            body = {**next(iter(examples(endpoint).values())), "reference": HOSTILE}
            root = ElementTree.fromstring(self.service.text(endpoint, body, f"format=svg&view={view}"))
            self.assertEqual([e.tag for e in root.iter() if "script" in e.tag], [])
            text = " ".join(e.text or "" for e in root.iter(f"{SVG}text"))
            for value in HOSTILE.values():
                self.assertIn(value, text)

    def test_sections_are_a4(self):
        for endpoint in ("bevel-tables", "intersections", "holes"):
            for name, body in examples(endpoint).items():
                with self.subTest(f"{endpoint} {name}"):
                    root = ElementTree.fromstring(self.service.text(endpoint, body, "format=svg&view=section"))
                    self.assertEqual((root.get("width"), root.get("height")), ("210.000mm", "297.000mm"))
                    corners = [tuple(map(float, p.split(","))) for e in root.iter(f"{SVG}polygon") for p in e.get("points").split()]
                    self.assertGreaterEqual(len(corners), 8 * 4)
                    for x, y in corners:
                        self.assertTrue(10 <= x <= 200 and 10 <= y <= 287, f"{x},{y}")

    def test_sections_say_the_bevel_they_show(self):
        count = 0
        for endpoint in ("bevel-tables", "intersections", "holes"):
            for name, body in examples(endpoint).items():
                wall = body.get("chord", body.get("target", {})).get("wall_mm")
                if wall is None or "root_face_mm" in body.get("groove", {}) or "root_face" in json.dumps(body):
                    continue
                root = ElementTree.fromstring(self.service.text(endpoint, body, "format=svg&view=section"))
                words = [e.text or "" for e in root.iter(f"{SVG}text")]
                at = words.index("outer edge, mm") + 1
                for k in range(at, at + 32, 4):
                    angle, inner, outer = (float(w.removesuffix("°")) for w in words[k + 1:k + 4])
                    with self.subTest(f"{endpoint} {name} {words[k]}"):
                        self.assertAlmostEqual(abs(angle), math.degrees(math.atan(abs(outer - inner) / wall)), delta=0.15)
                        count += 1
        self.assertGreaterEqual(count, 8 * 8)

    def order(self, body):
        """(texts, {id: points in mm}, the drawing's scale) of a work order."""
        root = ElementTree.fromstring(self.service.text("parts", body, "format=svg&view=work_order"))
        self.assertEqual(root.get("width"), "210.000mm")
        self.assertEqual(float(root.get("height").removesuffix("mm")) % 297, 0)
        words = [e.text or "" for e in root.iter(f"{SVG}text")]
        curves = {e.get("id"): [tuple(map(float, p.split(","))) for p in e.get("points").split()] for e in root.iter() if e.get("id") and e.get("points")}
        up, down = next(re.search(r", (\d+):(\d+)", w) for w in words if "developed" in w).groups()
        return words, curves, float(up) / float(down)

    def test_work_orders_say_what_the_answer_does(self):
        for name, body in examples("parts").items():
            with self.subTest(name):
                result = self.service.answer("parts", body)["result"]
                words, _, _ = self.order({**body, "reference": HOSTILE | {"material": "S355J2H", "quantity": 12}})
                for value in (*HOSTILE.values(), "S355J2H", "12"):
                    self.assertIn(value, words)
                for check in result["check_dimensions"]:
                    at = max(i for i, w in enumerate(words) if w == CALLED.get(check["name"], check["name"].replace("_", " ")))
                    self.assertAlmostEqual(float(words[at + 1]), check["value_mm"], delta=0.00501)
                    self.assertEqual(words[at + 2], check["tool"])
                    said = [MISTAKES[m] for m in check["changes_with"]]
                    self.assertEqual(words[at + 3], ", ".join(said) or "no mistake changes it by more than 1 mm")
                for step in range(self.steps(result)):
                    self.assertTrue(any(w.startswith(f"{step + 1}  ") for w in words), step)
                for i, hole in enumerate(result["holes"]):
                    at = words.index(f"H{i + 1}", words.index("size along x round"))
                    z = hole["points"]["z_mm"]
                    low, high = map(float, words[at + 2].split(" to "))
                    self.assertAlmostEqual(low, min(z), delta=0.00501)
                    self.assertAlmostEqual(high, max(z), delta=0.00501)
                    long, wide = map(float, words[at + 4].split(" x "))
                    self.assertAlmostEqual(long, max(z) - min(z), delta=0.00501)
                    girth = result["check_dimensions"][0]["value_mm"]
                    phi = hole["points"]["phi_deg"]
                    self.assertAlmostEqual(wide, (max(phi) - min(phi)) / 360 * girth, delta=0.00501)

    def steps(self, result):
        """How many lines the sequence has: three and more cut-outs of one request in a row are one."""
        def key(numbered):
            i, step = numbered
            return cutouts(result)[step["index"]][0]["id"] if step["what"] == "cutout" else i
        runs = [len(list(run)) for _, run in itertools.groupby(enumerate(result["sequence"]), key)]
        return sum(1 if run > 2 else run for run in runs)

    def test_work_orders_are_true_to_shape(self):
        """Both ends as the answer has them, each by its own place on the paper: what is plain between them may be left out."""
        for name, body in examples("parts").items():
            with self.subTest(name):
                result = self.service.answer("parts", body)["result"]
                girth = result["check_dimensions"][0]["value_mm"]
                _, curves, scale = self.order(body)
                for end in ("start", "finish"):
                    rows, drawn = result["ends"][end]["points"], curves[f"{end}_outer"]
                    wanted = {}
                    for phi, z in zip(rows["phi_deg"], rows["z_outer_mm"]):
                        wanted.setdefault(round(phi % 360 / 360 * girth, 3) % girth, []).append(z)
                    top = min(y for _, y in drawn)
                    self.assertAlmostEqual((max(y for _, y in drawn) - top) / scale, girth, delta=2e-3 / scale)
                    best = min(self.worst(drawn, wanted, girth, scale, top, turn) for turn in range(0, 360, 15))
                    self.assertLess(best, 3e-3 / scale)

    @staticmethod
    def worst(drawn, wanted, girth, scale, top, turn):
        """How far the drawn points that are rows are off them, were the surface cut open at `turn`."""
        offsets = []
        for around, heights in wanted.items():
            y = (around - girth * turn / 360) % girth
            x, where = min(((x, abs((v - top) / scale - y)) for x, v in drawn), key=lambda p: p[1])
            if where > 3e-3 / scale:
                return math.inf
            offsets.append(x / scale - min(heights, key=lambda z: abs(x / scale - z - (offsets[0] if offsets else x / scale - z))))
        return max(offsets) - min(offsets)

    def test_a_work_order_seen_from_outside_is_the_part_in_space(self):
        """Laid round the tube with its print side out the holes lie on the curves in space; mirrored they do not."""
        body = examples("parts")["chord-with-holes"]
        words, curves, scale = self.order(body)
        self.assertTrue(any("seen from outside" in w for w in words))
        result = self.service.answer("parts", body)["result"]
        radius = next(d["value_mm"] for d in result["check_dimensions"] if d["name"] == "girth") / (2 * math.pi)
        z0 = result["ends"]["start"]["points"]["z_outer_mm"][0]
        x0, top = curves["start_outer"][0]
        space = [points for points, _ in polylines(read(self.service.text("parts", body, "format=dxf&view=tube")), "CUT_OUTER")][2:]
        holes = [points for name, points in curves.items() if re.fullmatch(r"hole-\d+", name)]
        self.assertEqual(len(holes), len(result["holes"]))

        def off(side):
            """The best of all places where the surface may be cut open."""
            return min(max(min(off_curve(rolled([((x - x0) / scale + z0, side * ((top - y) / scale - radius * math.radians(turn))) for x, y in hole], radius),
                                         curve) for curve in space) for hole in holes) for turn in range(0, 360, 15))
        self.assertLess(off(1), 0.1)  # a hundredth of a mm on paper
        self.assertGreater(off(-1), 5)

    def test_holes_of_a_work_order_are_whole(self):
        """The surface is cut open off the holes: each is drawn once, within the outline."""
        count = 0
        for name, body in examples("parts").items():
            _, curves, _ = self.order(body)
            self.assertFalse([name for name in curves if "again" in name])
            ys = [y for _, y in curves["start_outer"]]
            for name, points in curves.items():
                if name.startswith("hole-"):
                    inside = {min(ys) <= y <= max(ys) for _, y in points}
                    self.assertEqual(len(inside), 1)  # a long part has more strips
                    count += 1
        self.assertGreaterEqual(count, 8)

    def test_a_work_order_has_the_same_sheets_as_pdf(self):
        count = 0
        for name, body in examples("parts").items():
            with self.subTest(name):
                root = ElementTree.fromstring(self.service.text("parts", body, "format=svg"))
                pages = pdf_reader.pages(self.service.text("parts", body, "format=pdf"))
                sheets = [e for e in root.iter(f"{SVG}g") if (e.get("id") or "").startswith("sheet-")]
                self.assertEqual(len(pages), max(1, len(sheets)))
                for page, sheet in zip(pages, sheets or [root]):
                    self.assertAlmostEqual(page.width, 210, delta=1e-3)
                    self.assertAlmostEqual(page.height, 297, delta=1e-3)
                    self.assertEqual([t[0] for t in page.texts], [e.text for e in sheet.iter(f"{SVG}text")])
                    lines = [e for e in sheet.iter(f"{SVG}polyline")]
                    drawn = [len(p) for p, closed, how, _ in page.paths if how == "S" and not closed and len(p) != 2]
                    self.assertEqual(drawn, [len(e.get("points").split()) for e in lines])
                    count += len(drawn)
        self.assertGreater(count, 50)

    def test_a_scanner_reads_part_and_result_of_a_work_order(self):
        """dmtxread, of the head of a sheet printed at 254 dots an inch; DataMatrix has the characters of ISO 8859-1."""
        for name, part in (("k-joint-brace", "B-12"), ("shs-base-post", "Stütze 7/2 \"links\" & co"), ("chord-with-holes", HOSTILE["part"])):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                body = json.loads((ROOT / f"examples/parts/{name}.json").read_text()) | {"reference": {"part": part}}
                answer = self.service.answer("parts", body)
                drawing = self.drawing("parts", body, "work_order")
                image = pathlib.Path(folder) / "sheets.png"
                whole = cairo.ImageSurface.create_for_data(bytearray(drawing.bytes), cairo.FORMAT_RGB24, drawing.width, drawing.height, drawing.stride)
                wide = round(90 * DPI / 25.4)  # the head's right end
                head = cairo.ImageSurface(cairo.FORMAT_RGB24, wide, round(20 * DPI / 25.4))
                context = cairo.Context(head)
                context.set_source_surface(whole, wide - drawing.width, -8 * DPI / 25.4)
                context.paint()
                head.write_to_png(str(image))
                read = subprocess.run(["dmtxread", "-m20000", "-N1", str(image)], capture_output=True, check=True)
                self.assertEqual(read.stdout.decode("latin-1"), f"{part}\n{answer['job']['result_sha256']}")

    def test_a_mark_of_a_point_is_drawn(self):
        root = ElementTree.fromstring(self.service.text("parts", examples("parts")["chord-with-holes"], "format=svg&view=work_order"))
        for e in root.iter(f"{SVG}line"):
            self.assertNotEqual((e.get("x1"), e.get("y1")), (e.get("x2"), e.get("y2")))

    def tiles(self, endpoint, body, query):
        """[(the page's group, its window, where on the developed surface the window begins)] of a tiled template, and the paper's size."""
        content = self.service.text(endpoint, body, f"format=svg&view=template&{query}")
        root = ElementTree.fromstring(content)
        groups = [e for e in root.iter(f"{SVG}g") if re.fullmatch(r"sheet-\d+", e.get("id") or "")] or [root]
        width, height = float(root.get("width").removesuffix("mm")), float(root.get("height").removesuffix("mm")) / len(groups)
        out = []
        for k, page in enumerate(groups):
            window = next(e for e in page.iter(f"{SVG}rect") if e.get("id") == f"window-{k + 1}")
            left, top, wide, tall = (float(window.get(a)) for a in ("x", "y", "width", "height"))
            words = [e.text or "" for e in page.iter(f"{SVG}text")]
            around, along = next(re.match(r"round (\S+) to \S+ mm, along (\S+) to", w) for w in words if w.startswith("round ")).groups()
            out.append((page, (left, top, left + wide, top + tall), (float(around), float(along))))
        return content, out, (width, height)

    CASES = (("bevel-tables", "source-000-table-1", "z_outer_mm"), ("holes", "set-on-branch", None), ("intersections", "source-000-table-1", None),
             ("parts", "chord-with-holes", "z_outer_mm"), ("parts", "k-joint-brace", "z_outer_mm"))

    def test_tiles_are_pages_with_rulers_and_crop_marks(self):
        for endpoint, name, _ in self.CASES:
            for paper, sizes in (("a4", {(210, 297), (297, 210)}), ("a3", {(297, 420), (420, 297)})):
                with self.subTest(f"{endpoint} {name} {paper}"):
                    content, pages, size = self.tiles(endpoint, examples(endpoint)[name], f"paper={paper}")
                    self.assertIn(size, sizes)
                    again = pdf_reader.pages(self.service.text(endpoint, examples(endpoint)[name], f"format=pdf&view=template&paper={paper}"))
                    self.assertEqual(len(again), len(pages))
                    for k, (page, (left, top, right, low), _) in enumerate(pages):
                        self.assertAlmostEqual(again[k].width, size[0], delta=1e-3)
                        for axis, way in (("x", "x"), ("y", "y")):
                            ruler = next(e for e in page.iter(f"{SVG}line") if e.get("id") == f"ruler-{axis}-{k + 1}")
                            self.assertAlmostEqual(abs(float(ruler.get(f"{way}2")) - float(ruler.get(f"{way}1"))), 100.0, delta=1e-3)
                            x1, y1, x2, y2 = (float(ruler.get(a)) for a in ("x1", "y1", "x2", "y2"))
                            printed = [(x1, (k + 1) * size[1] - y1), (x2, (k + 1) * size[1] - y2)]
                            self.assertTrue(any(len(p) == 2 and math.dist(p[0], printed[0]) < 2e-3 and math.dist(p[1], printed[1]) < 2e-3
                                                for p, *_ in again[k].paths), "the PDF's ruler")
                        crops = [e for e in page.iter(f"{SVG}line") if e.get("stroke-width") == "0.15" and any(
                            math.dist((float(e.get("x1")), float(e.get("y1"))), corner) < 0.51 for corner in ((left, top), (right, top), (left, low), (right, low)))]
                        self.assertGreaterEqual(len(crops), 8)
                        self.assertTrue(0 < left < right < size[0] and k * size[1] < top < low < (k + 1) * size[1])
                        words = " ".join(e.text or "" for e in page.iter(f"{SVG}text"))
                        self.assertIn(f"page {k + 1} of {len(pages)}", words)
                        self.assertIn("verdict: ", words)

    def test_tiles_reassembled_give_the_whole_outline(self):
        """Every point of the outer edges is on a page, where the page says that it is; and the page draws nothing else there."""
        for endpoint, name, column in self.CASES:
            body, count = examples(endpoint)[name], 0
            result = self.service.answer(endpoint, body)["result"]
            if endpoint == "parts":
                radius = result["check_dimensions"][0]["value_mm"] / (2 * math.pi)
                curves = [list(zip(result["ends"][end]["points"]["phi_deg"], result["ends"][end]["points"][column])) for end in ("start", "finish")]
                curves += [list(zip(hole["points"]["phi_deg"], hole["points"]["z_mm"])) for hole in result["holes"]]
            else:
                radius = body.get("target", body.get("chord"))["outer_diameter_mm"] / 2
                table = result["points"] if "points" in result else result["holes"][0]["points"] if "holes" in result else \
                    next(p for p in result["profiles"] if p["surface"] == "outer")["points"]
                curves = [list(zip(table["phi_deg"], table[column or "z_mm"]))]
            for paper in ("a4", "a3"):
                _, pages, _ = self.tiles(endpoint, body, f"paper={paper}")
                pieces = []  # (window on the surface, polyline on the surface)
                for page, (left, top, right, low), (around, along) in pages:
                    for e in page.iter():
                        if (e.get("id") or "").startswith("cut-outer"):
                            line = [tuple(map(float, p.split(","))) for p in e.get("points").split()]
                            line += line[:1] if e.tag == f"{SVG}polygon" else []
                            pieces.append(((around, along, around + right - left, along + low - top), [(x - left + around, low - y + along) for x, y in line]))
                with self.subTest(f"{endpoint} {name} {paper}"):
                    self.assertTrue(pieces)
                    worst = 0.0
                    for curve in curves:
                        for phi, z in curve[::max(1, len(curve) // 150)]:
                            places = [(radius * math.radians(p), z) for p in ((phi, phi % 360) if endpoint == "parts" else (phi,))]
                            seen = [off_line(place, line) for place in places for (x0, z0, x1, z1), line in pieces
                                    if x0 - 0.01 <= place[0] <= x1 + 0.01 and z0 - 0.01 <= place[1] <= z1 + 0.01]
                            self.assertTrue(seen, f"{phi}, {z} is on no page")
                            worst = max(worst, min(seen))
                            count += 1
                    print(f"{endpoint} {name} on {paper}: {len(pages)} pages, {worst:.4f} mm off")
                    self.assertLess(worst, 0.1)
            self.assertGreater(count, 100)

    def test_what_is_drawn_on_a_tile_is_there_in_pixels(self):
        content, pages, size = self.tiles("bevel-tables", examples("bevel-tables")["source-000-table-1"], "paper=a4")
        d = Drawing(content)
        page, (left, top, right, low), _ = pages[0]
        edge = next(e for e in page.iter() if (e.get("id") or "").startswith("cut-outer"))
        inside = [(x, y) for x, y in (tuple(map(float, p.split(","))) for p in edge.get("points").split()) if left + 1 < x < right - 1 and top + 1 < y < low - 1]
        self.assertGreater(len(inside), 100)
        for x, y in inside[::7]:
            near = [d.color(round(x * DPI / 25.4) + i, round(y * DPI / 25.4) + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
            self.assertLess(min(math.dist(c, BLUE) for c in near), 60)

    def test_paper_goes_with_templates_only(self):
        for endpoint, view in (("bevel-tables", "chart"), ("bevel-tables", "section"), ("parts", "work_order"), ("holes", "chart")):
            body = next(iter(examples(endpoint).values()))
            status, _, content = self.service.ask(endpoint, body, f"format=svg&view={view}&paper=a4")
            self.assertEqual((status, json.loads(content)["errors"][0]["pointer"]), (422, "?paper"))
        status, _, content = self.service.ask("parts", next(iter(examples("parts").values())), "format=pdf&view=template&paper=a5")
        self.assertEqual((status, json.loads(content)["errors"][0]["pointer"]), (400, "?paper"))

    def test_templates_of_the_smallest_and_the_largest_tube(self):
        for diameter in (5, 5000):
            body = {"target": {"outer_diameter_mm": diameter, "wall_mm": 0.5},
                    "cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 1, 1]}],
                    "sampling": {"tolerance_mm": 0.05}}
            root = ElementTree.fromstring(self.service.text("intersections", body, "format=svg&view=template"))
            points = next(e for e in root.iter() if e.get("id") == "cut-outer").get("points").split()
            x = [float(p.split(",")[0]) for p in points]
            self.assertAlmostEqual(x[-1] - x[0], math.pi * diameter, delta=2e-3)
            y = [float(p.split(",")[1]) for p in points]
            self.assertAlmostEqual(max(y) - min(y), diameter, delta=0.01 * diameter)
            self.assertLess(max(x), float(root.get("width").removesuffix("mm")))


if __name__ == "__main__":
    main()
