"""What people read in drawings: words instead of names of the contract, short numbers, and no label on another."""

import json
import math
import re
import xml.etree.ElementTree as ElementTree

import cairo
import yaml

import pdf_reader
from dxf_test import read
from ezdxf.lldxf.encoding import decode_dxf_unicode
from service import ROOT, FormatTest, examples, main

CONTRACT = yaml.load((ROOT / "openapi.yaml").read_text(), getattr(yaml, "CSafeLoader", yaml.SafeLoader))  # libyaml takes a fifth of the time
SVG = "{http://www.w3.org/2000/svg}"
ENDPOINTS = ("bevel-tables", "intersections", "holes", "parts", "grooves", "mill-paths", "feed-curves", "pulse-schedules")
LONG = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?!\d|[\w.]*[a-df-zA-Z_])")
ODD = re.compile(r"(?<!\w)\d+(?:\.\d+)?e[-+]?\d+(?!\w)|(?<![\w.])-0(?:\.0*)?(?![\w.])|\b(?:nan|inf)\b")


def wire_names():
    """Every name of the contract that no text for people would have: those of more words than one."""
    names = set()

    def walk(value):
        if isinstance(value, list):
            for one in value:
                walk(one)
        if not isinstance(value, dict):
            return
        properties = value.get("properties")
        for name in [*(properties if isinstance(properties, dict) else ()), *(value.get("enum") or ()), value.get("const")]:
            if isinstance(name, str) and "_" in name:
                names.add(name)
        for one in value.values():
            walk(one)
    walk(CONTRACT)
    return names


NAMES = wire_names()


def faults(text):
    out = [word for word in re.findall(r"\b[a-z0-9]+(?:_[a-z0-9]+)+\b", text) if word in NAMES]
    for number in LONG.findall(text):
        digits = number.lstrip("-").replace(".", "").lstrip("0")
        if len(digits if "." in number else digits.rstrip("0")) > 6:
            out.append(number)
    return out + ODD.findall(text)


class Label:
    """Where a text stands: its box, in a frame turned with it."""
    pen = cairo.Context(cairo.ImageSurface(cairo.FORMAT_RGB24, 1, 1))

    def __init__(self, text, x, y, height, anchor, turn, bold):
        self.text = text
        self.pen.select_font_face("DejaVu Sans", cairo.FONT_SLANT_NORMAL, cairo.FONT_WEIGHT_BOLD if bold else cairo.FONT_WEIGHT_NORMAL)
        self.pen.set_font_size(100)  # measured large: hinting rounds small sizes
        e = self.pen.text_extents(text)
        scale, back = height / 100, {"start": 0.0, "middle": 0.5, "end": 1.0}[anchor]
        left, low = scale * (e.x_bearing - back * e.x_advance), scale * e.y_bearing
        corners = [(left, low), (left + scale * e.width, low), (left + scale * e.width, low + scale * e.height), (left, low + scale * e.height)]
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        self.corners = [(x + c * u - s * v, y + s * u + c * v) for u, v in corners]

    def overlaps(self, other, slack):
        """By more than `slack`, on the axes of the sheet: labels stand upright or lie."""
        boxes = [(min(p[k] for p in one.corners), max(p[k] for p in one.corners)) for k in (0, 1) for one in (self, other)]
        return all(min(a[1], b[1]) - max(a[0], b[0]) > slack for a, b in (boxes[:2], boxes[2:]))


def labels(content):
    root = ElementTree.fromstring(content)
    for e in root.iter(f"{SVG}text"):
        if not (e.text or "").strip():
            continue
        x, y, turn = float(e.get("x", 0)), float(e.get("y", 0)), 0.0
        if e.get("transform"):
            x, y, turn = map(float, re.fullmatch(r"translate\(([-\d.]+),([-\d.]+)\) rotate\(([-\d.]+)\)", e.get("transform")).groups())
        yield Label(e.text, x, y, float(e.get("font-size", root.get("font-size", 12))), e.get("text-anchor", "start"), turn, e.get("font-weight") == "600")


class People(FormatTest):
    def drawings(self, media, name):
        """(title, content) of every view of every example that has the format."""
        for endpoint in ENDPOINTS:
            about = CONTRACT["paths"][f"/v1/{endpoint}"]["post"]["responses"]["200"]["content"].get(media)
            if about is None:
                continue
            for example, body in examples(endpoint).items():
                for view in about.get("x-views", [""]):
                    query = f"format={name}" + (f"&view={view}" if view else "")
                    yield f"{endpoint} {example} {query}", self.service.text(endpoint, body, query)

    def test_the_rules_find_what_they_look_for(self):
        self.assertGreater(len(NAMES), 300)
        self.assertEqual(faults("wall_mm is 1234.5678 or 7.1e-15 mm, -0 or -0.00"), ["wall_mm", "1234.5678", "7.1e-15", "-0", "-0.00"])
        self.assertEqual(faults("0.01 mm, 123456, 12000000, a1b2c3d4e5f6, < 0.001, -0.5, B_1 of 123.456°"), [])

    def test_svg(self):
        count = 0
        for title, content in self.drawings("image/svg+xml", "svg"):
            with self.subTest(title):
                texts = [e.text or "" for e in ElementTree.fromstring(content).iter() if e.tag in (f"{SVG}text", f"{SVG}title")]
                self.assertEqual([(text, *faults(text)) for text in texts if faults(text)], [])
                count += len(texts)
        self.assertGreater(count, 2000)

    def test_pdf(self):
        count = 0
        for title, content in self.drawings("application/pdf", "pdf"):
            with self.subTest(title):
                texts = [text for page in pdf_reader.pages(content) for text, *_ in page.texts]
                self.assertEqual([(text, *faults(text)) for text in texts if faults(text)], [])
                count += len(texts)
        self.assertGreater(count, 200)

    def test_dxf(self):
        count = 0
        for title, content in self.drawings("image/vnd.dxf", "dxf"):
            with self.subTest(title):
                texts = [decode_dxf_unicode(e.dxf.text) for e in read(content).modelspace().query("TEXT")]
                self.assertEqual([(text, *faults(text)) for text in texts if faults(text)], [])
                count += len(texts)
        self.assertGreater(count, 100)

    def comments(self, endpoint, begins, query):
        """(title, texts) of the comments of every example that has the format."""
        for example, body in examples(endpoint).items():
            body = body | {"reference": {"part": "B1", "customer_id": "4", "revision": "C"}}
            status, media, content = self.service.ask(endpoint, body, query)
            if status != 200:  # for comparison only, or no room for the leads
                self.assertIn(b'"comparison_only"' if b'"comparison_only"' in content else b"lead_mm", content, f"{endpoint} {example} {query}")
                continue
            yield f"{endpoint} {example} {query}", [line[len(begins):].rstrip(")") for line in content.decode("ascii").splitlines() if line.startswith(begins)]

    def test_gcode(self):
        count, posts = 0, {p["name"]: p["post"] for p in json.loads(self.service.get("/v1/posts"))["posts"] if "comment_begin" in p["post"]}
        self.assertGreaterEqual(len(posts), 4)
        for name, post in posts.items():
            plain, pierced = (f"format=gcode&post={name}&speed_mm_min=600" + more for more in ("", "&lead_mm=1.5&pivot_length_mm=150"))
            for endpoint, query in (("bevel-tables", plain), ("bevel-tables", pierced), ("parts", plain), ("parts", pierced),
                                    ("pulse-schedules", f"format=gcode&post={name}")):
                for title, texts in self.comments(endpoint, post["comment_begin"], query):
                    with self.subTest(title):
                        texts = [text for text in texts if not re.match("(?i)machine: ", text)]  # its name
                        self.assertEqual([(text, *faults(text.lower())) for text in texts if faults(text.lower())], [])
                        self.assertTrue({"part", "customer", "revision", "verdict"} <= {text.split(":")[0].lower() for text in texts})
                        self.assertTrue(all("_" not in text for text in texts if not re.match("(?i)tubecut|reasons|warning|.* axis ", text)), texts)
                        count += len(texts)
        self.assertGreater(count, 3000)

    def test_notes_of_point_pairs(self):
        count = 0
        for body in examples("parts").values():
            body = body | {"reference": {"part": "B1"}}
            program = json.loads(self.service.text("parts", body, "format=gcode&post=point_pairs&speed_mm_min=600&machine=five_axis_cutter&material=steel&lead_mm=0"))
            texts = [*(text for text in program["notes"] if not text.startswith("machine: ")), program["frame"]["zero"], program["frame"]["phi"], program["frame"]["z"]]
            self.assertEqual([(text, *faults(text)) for text in texts if faults(text)], [])
            count += len(texts)
        self.assertGreater(count, 40)

    def test_dstv(self):
        count = 0
        for endpoint in ("bevel-tables", "parts"):
            for title, texts in self.comments(endpoint, "** ", "format=nc1"):
                texts = [text for text in texts if not re.match(r"B +-?[\d.]+ |(?:end|shape|line|arc|work points|corner radii)\b", text)]  # the tables themselves
                with self.subTest(title):
                    self.assertEqual([(text, *faults(text)) for text in texts if faults(text)], [])
                    count += len(texts)
        self.assertGreater(count, 250)

    def test_no_label_lies_on_another(self):
        for title, content in self.drawings("image/svg+xml", "svg"):
            found = list(labels(content))
            slack = 0.15 if b'mm" viewBox' in content else 1.0  # mm; px of charts
            with self.subTest(title):
                self.assertEqual([(a.text, b.text) for i, a in enumerate(found) for b in found[:i] if a.overlaps(b, slack)], [])


if __name__ == "__main__":
    main()
