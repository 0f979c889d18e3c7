"""Words of a client stay words: every format read with and without hostile ones differs in its texts alone, and there holds them."""

import csv
import html.parser
import io
import json
import re
import struct
import xml.etree.ElementTree as ElementTree
import zipfile

import pdf_reader
import step_reader
from dstv_test import parse
from dxf_test import read
from ezdxf.lldxf.encoding import decode_dxf_unicode
from service import ROOT, FormatTest, examples, main

# Characters that end, open or escape something in any of the formats.
HOSTILE = [
    "*) VAR evil : INT; END_VAR (*", "(* open", "(* (* *)", "*)", "*) ; //", "/* open", "*/", "{attribute 'x'}", "$'$N", "x) M3 S1 (",
    "MSG,hello", "PRINT,#1", "LOGOPEN,/tmp/x", "x)(MSG,hello)", ";py,import os", "#1=2 [1/0] o1 call", "%", "/G0 X0", "M3 S1", "** EN",
    "**", "EN", "AK", "  v 0.00u 0.00", "ST", "]]>", "</text><script>alert(1)</script>", "<script>alert(1)</script>", "&lt;&#x41;&amp;",
    "<!-- open", "--> <?php", "\" onload=\"alert(1)", "' onload='alert(1)", "<img src=x onerror=alert(1)>", "javascript:alert(1)",
    "%%u50%%c", "\\P\\U+0041\\", "^J^M", "{\\H9;big}", "  0", "=1+1", "=cmd|'/C calc'!A0", "+1", "-1", "@SUM(1)", "'=1", "''", " =1",
    "\"=1\"", "a;=1", "a,=1", "a|=1", "a;\"=1", "\",=1,\"", "\"", "a\"b", "solid x", "endsolid x", "\"}],\"x\":[{", "\\u0000\\", "\\",
    "~" * 64, "(" * 24, "\"" * 16,
] + [c + "x" for c in map(chr, range(0x21, 0x7f)) if not c.isalnum()]
SPREADSHEETS = (",", ";", "|", "\t")
FIELDS = ("part", "order", "drawing", "revision", "heat", "customer_id")
NUMBER = re.compile(r"-?\d+(\.\d+)?(e[+-]?\d+)?")
FILE = re.compile(r"(?![. ~-])[^/\\:*?\"<>|\x00-\x1f\x7f]+(?<![. ])")


def words_of(n):
    """Every word once, so many at a time; the last ones filled up."""
    for i in range(0, len(HOSTILE), n):
        yield (HOSTILE[i:i + n] + HOSTILE)[:n]


def commented(text):
    """What a control or a compiler is left with of a text all of whose signs act somewhere."""
    return re.sub(r"[^A-Za-z0-9+\-_.,:=/# ]", "_", text)


def stands_in(word, texts):
    """Whole in a text, or piece by piece in texts, because long ones wrap at their blanks, or shortened to at least six signs."""
    if any(word in text for text in texts) or all(any(piece in text for text in texts) for piece in word.split()):
        return True
    shortened = [text[:-3] for text in texts if text.endswith("...")]
    return any(text.endswith(word[:k]) for text in shortened for k in range(6, len(word)))


# One reader per format: its active elements, and its texts.
def is_module(tag, attributes):
    return tag.endswith("rect") and attributes.get("fill") == "#000000"


def xml(content):
    root = ElementTree.fromstring(content)
    tags = []

    class Html(html.parser.HTMLParser):
        def handle_starttag(self, tag, attributes):
            if not is_module(tag, dict(attributes)):
                tags.append((tag, sorted(name for name, _ in attributes)))
    Html().feed(content.decode())
    # Without the modules of a DataMatrix, which are as many as the text that it says needs.
    acts = [[e.tag, *sorted(e.keys())] for e in root.iter() if not is_module(e.tag, e.attrib)]

    def wrapped(elements, is_text):
        """The elements; those of text once for each kind, because a long text wraps into more lines."""
        return [one for one in elements if not is_text(one)] + sorted({str(one) for one in elements if is_text(one)})
    acts = wrapped(acts, lambda one: one[0].endswith("}text"))
    tags = wrapped(tags, lambda one: one[0] == "text")
    return (acts, tags), [e.text or "" for e in root.iter()] + [v for e in root.iter() for v in e.attrib.values()], str


def dxf(content):
    drawing = read(content)
    if drawing.audit().errors:
        raise AssertionError("an audit's errors")
    entities, texts = [], []
    for e in drawing.modelspace():
        entities.append((e.dxftype(), e.dxf.layer, list(e.get_points()) if e.dxftype() == "LWPOLYLINE" else len(list(getattr(e, "vertices", [])))))
        if e.dxftype() == "TEXT":
            texts.append(decode_dxf_unicode(e.dxf.text).replace("%%%", "%").replace("^ ", "^"))
    return (entities, [layer.dxf.name for layer in drawing.layers]), texts, str


def gcode(content):
    blocks, texts = [], []
    for line in content.decode("ascii").split("\n"):
        if len(line) > 255:
            raise AssertionError("a line longer than a control reads")
        found = re.fullmatch(r"\(([^()]*)\)", line)
        if not found:
            blocks.append(line)
            continue
        texts.append(found[1])
        if re.match(r"(?i) *(msg|debug|print|log\w*|probe\w*|py|axis)\b *,?", found[1]) and found[1].split(",")[0].strip().isupper():
            raise AssertionError(f"acts: {line}")
    return blocks, texts, commented


def dstv(content):
    text = content.decode("ascii")
    if any(not line.strip() for line in text.split("\r\n")[:-1]):
        raise AssertionError("a blank line")
    file = parse(text)
    texts = file.pop("comments")
    header = file.pop("header")
    for name in ("order", "drawing", "piece"):
        texts.append(header.pop(name))
    table = [t for t in texts if re.match(r"B +-?\d+\.\d+ ", t)]
    return (file, header, table), texts, lambda word: commented(word) if word.strip() else "-"


def structured_text(content):
    """Comments of both kinds of compiler: those that nest them and those that do not."""
    text = content.decode("ascii")
    left, comments, depth, at = "", [], 0, 0
    while at < len(text):
        two = text[at:at + 2]
        if two == "(*":
            depth, at = depth + 1, at + 2
            comments.append("")
        elif two == "*)" and depth:
            depth, at = depth - 1, at + 2
        else:
            if depth:
                comments[-1] += text[at]
            else:
                left += text[at]
            at += 1
    if depth or re.sub(r"(?s)\(\*.*?\*\)", "", text) != left or re.search(r"[{}$\"']|//|/\*", left):
        raise AssertionError("not what it was")
    return left, comments, commented


def table(content):
    text = content.decode()
    head = re.match(r"(# [^,;|\"\t\r\n]*\r\n)*", text)[0]
    text = text[len(head):]
    rows = list(csv.reader(io.StringIO(text, newline="")))
    if {len(row) for row in rows} != {len(rows[0])}:
        raise AssertionError("rows of different lengths")
    for separator in SPREADSHEETS:
        for quoting in (csv.QUOTE_MINIMAL, csv.QUOTE_NONE):
            for row in csv.reader(io.StringIO(text, newline=""), delimiter=separator, quoting=quoting):
                for cell in row if separator != "," or quoting != csv.QUOTE_NONE else []:
                    cell = cell.strip(' "')
                    if cell[:1] in tuple("=+-@") and not NUMBER.fullmatch(cell.split(",")[0]):
                        raise AssertionError(f"computes: {cell!r} with {separator!r}")
    texts = [re.sub(r"(^|[,;|])([ \"]*)'(?=[=+\-@'])", r"\1\2", cell) for row in rows for cell in row]
    return [[cell for cell in row if NUMBER.fullmatch(cell)] for row in rows], texts, str


def glb(content):
    length, kind = struct.unpack_from("<II", content, 12)
    document = json.loads(content[20:20 + length])
    title = document["asset"].pop("generator")
    return (kind, document, content[20 + length:]), [title], str


def stl(content):
    if not content[:80].decode("ascii").startswith("tubecut"):
        raise AssertionError("begins like an ASCII file")
    return re.sub(rb"input [0-9a-f]{16}", b"", content), [], None


def step(content):
    """Header and product apart; what is left are numbers and words of the standard."""
    file = step_reader.File(content.decode("ascii"))
    description, (name, *others) = file.header["FILE_DESCRIPTION"][0], file.header["FILE_NAME"]
    product = file.get(file.of("PRODUCT")[0], "PRODUCT")
    revision = file.get(file.of("PRODUCT_DEFINITION_FORMATION")[0], "PRODUCT_DEFINITION_FORMATION")
    texts = [*description, name, product[0], revision[0]]
    product[0] = revision[0] = None
    return (others, file.entities), texts, str


def pdf(content):
    """What is drawn apart from the texts, and how those look; letters beyond WinAnsiEncoding are spelled."""
    pages = pdf_reader.pages(content)
    for page in pages:  # modules of a DataMatrix, as above
        page.paths = [path for path in page.paths if path[2] != "f" or path[0][2][1] - path[0][0][1] > 0.6]
    return [(page.width, page.height, page.paths, len(page.texts)) for page in pages], [t[0] for page in pages for t in page.texts], str


def assembly(content):
    """All strings, the header's too, apart from the rest."""
    file, texts = step_reader.File(content.decode("ascii")), []

    def rest(value):
        if isinstance(value, str) and not isinstance(value, step_reader.Word):
            texts.append(value)
            return None
        if isinstance(value, dict):
            return {word: rest(one) for word, one in value.items()}
        if isinstance(value, tuple):  # a word of the standard, and its values
            return value[0], *map(rest, value[1:])
        return [rest(one) for one in value] if isinstance(value, list) else value
    return (rest(file.header), {number: rest(entity) for number, entity in file.entities.items()}), texts, str


def archive(content):
    """Its files, whose names lead nowhere else, each by its own reader."""
    acts, texts = [], []
    with zipfile.ZipFile(io.BytesIO(content)) as files:
        for name in files.namelist():
            if not all(FILE.fullmatch(part) for part in name.split("/")) or name.count("/") > 1:
                raise AssertionError(f"a file's name: {name!r}")
            kind = name.rsplit(".", 1)[1]
            if kind == "json":
                json.loads(files.read(name))
                continue
            of_file, its_texts, _ = READERS[kind](files.read(name))
            acts.append((kind, of_file))
            texts += its_texts
    return acts, texts, str


READERS = {"svg": xml, "pdf": pdf, "dxf": dxf, "gcode": gcode, "nc1": dstv, "st": structured_text, "csv": table, "glb": glb, "stl": stl, "step": step,
           "assembly": assembly, "zip": archive}


class Words(FormatTest):
    def formats(self, endpoint):
        offered = json.loads(self.service.ask(endpoint, {}, "format=none")[2])["detail"]
        for name in re.findall(r"\((\w+)\)", offered):
            if name in ("json", "cbor"):
                continue
            detail = json.loads(self.service.ask(endpoint, {}, f"format={name}&view=none" + self.more(endpoint, name))[2])["detail"]
            for view in [v for v in detail.split("offered: ")[1].split(", ") if v != "none"] or [""]:
                yield name, f"format={name}" + (f"&view={view}" if view else "") + self.more(endpoint, name)

    @staticmethod
    def more(endpoint, name):
        return "&speed_mm_min=600" if name == "gcode" and endpoint != "pulse-schedules" else ""

    def both(self, endpoint, plain, make, where, longest=64, few=False):
        """Each format of the request with every word against it with a plain one; `where` tells which formats hold the words. The
        others get two words, for they print none."""
        count = 0
        for name, query in self.formats(endpoint):
            read = READERS["assembly" if (endpoint, name) == ("frames", "step") else name]
            acts, _, _ = read(self.service.text(endpoint, make(plain), query))
            for words in list(words_of(len(plain)))[:2 if few or name not in where else None]:
                if "view=section" in query or name == "zip":  # a long title or step goes on in another line, which moves the rest
                    words = [word[:16] for word in words]
                with self.subTest(f"{endpoint} {query} {words}"):
                    got, texts, meant = read(self.service.text(endpoint, make(words), query))
                    self.assertEqual(got, acts)
                    for word in words if name in where else []:
                        self.assertTrue(stands_in(meant(word[:longest]), texts), f"{word!r} not in {sorted(set(texts))[:40]}")
                        count += 1
        return count

    def smallest(self, endpoint):
        name = {"bevel-tables": "source-000-table-1", "holes": "set-on-branch", "intersections": "source-000-table-1",
                "parts": "table-1-with-a-square-far-end", "feed-curves": "source-004-table-1-as-solved", "grooves": "case-a-right-angle",
                "mill-paths": "case-a-end-up", "pulse-schedules": "square-cut-from-a-bare-contour"}[endpoint]
        body = examples(endpoint)[name]
        if "sampling" in body:
            body["sampling"] = {"uniform_points": 36}
        if "sections" in body:
            body["sections"] = {"count": 36}
        return body

    def test_references(self):
        every = {"bevel-tables": ("svg", "dxf", "gcode", "nc1", "glb", "step", "pdf"), "parts": ("svg", "gcode", "nc1", "step"), "feed-curves": ("svg", "st"),
                 "pulse-schedules": ("gcode",)}
        some = {"holes": ("svg", "dxf"), "intersections": ("svg", "dxf"), "parts": ("dxf",), "grooves": ("svg", "glb"),
                "mill-paths": ("svg", "glb"), "pulse-schedules": ("svg",)}
        for shown, few in ((every, False), (some, True)):
            for endpoint, where in shown.items():
                body = self.smallest(endpoint)
                count = self.both(endpoint, [f"plain{i}" for i in range(6)],
                                  lambda words: {**body, "reference": dict(zip(FIELDS, words))}, where, few=few)
                self.assertGreaterEqual(count, 12 if few else len(HOSTILE))

    def test_zones(self):
        body = examples("bevel-tables")["zones"] | {"sampling": {"uniform_points": 36}}
        zones = body["groove"]["zones"]
        # Each word separately, because the ids must not be equal, and a zone may contain no row.
        count = self.both("bevel-tables", ["plain"], lambda words: {**body, "groove": {**body["groove"], "zones": [
            {**zone, "id": words[0]} if zone["id"] == "C" else zone for zone in zones]}}, ("csv",))
        self.assertGreaterEqual(count, len(HOSTILE))

    def test_machines_and_their_axes(self):
        shelf = json.loads(self.service.get("/v1/machines"))["machines"]
        generic = next(m["machine"] for m in shelf if m["machine"]["type"] == "generic")

        def body(words):
            axis = {**generic["axes"][0], "name": words[0][:16], "soft_min": None, "soft_max": None}
            way = {axis["name"]: [0, 2, 4, 6, 7], "s_mm": [0, 2, 4, 6, 7]}
            return {"machine": {**generic, "name": words[0], "maps": generic["maps"][:1], "axes": [axis]}, "axes": way, "motion": {"speed": {"mm_min": 300}}}
        count = self.both("pulse-schedules", ["plain"], body, ("gcode",))
        count += self.both("pulse-schedules", ["plain"], body, ("csv", "svg"), 16)
        self.assertGreaterEqual(count, 3 * len(HOSTILE))

    def test_members_of_a_part(self):
        body = examples("parts")["chord-with-holes"] | {"sampling": {"uniform_points": 36}}

        def named(words):
            text = json.dumps(body)
            for old, new in zip(("B1", "C1"), words):
                text = text.replace(f'"{old}"', json.dumps(new))
            return json.loads(text)
        count = self.both("parts", ["brace", "chord"], named, ("gcode",))
        self.assertGreaterEqual(count, len(HOSTILE))

    def test_members_of_a_frame(self):
        body = examples("frames")["k-node-with-plate-and-square-brace"]

        def named(words):
            text = json.dumps(body)
            for old, new in zip(("C1", "B3"), words):
                text = text.replace(f'"{old}"', json.dumps(new))
            return json.loads(text)
        count = self.both("frames", ["chord", "brace"], named, ("csv", "step", "zip"))
        self.assertGreaterEqual(count, 3 * len(HOSTILE))

    def test_the_console_makes_no_markup_of_text(self):
        sources = sorted((ROOT / "web" / "src").rglob("*.ts"))
        self.assertTrue(sources)
        for source in sources:
            # drawing.ts reads the service's SVG as XML and keeps only shapes and texts, without handlers and links.
            parser = "" if source.name == "drawing.ts" else "|DOMParser"
            self.assertNotRegex(source.read_text(), r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|ContextualFragment|srcdoc" + parser)


if __name__ == "__main__":
    main()
