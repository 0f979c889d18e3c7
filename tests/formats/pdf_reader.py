"""The PDF sheets read again: by the cross-reference table to the pages, their paths and texts in millimetres."""

import re

POINT = 25.4 / 72  # mm
NUMBER = rb"([-+]?[0-9.]+)"
# A step of a path, because most of a page is such; a number; another operand; an operator.
TOKEN = re.compile(NUMBER + rb" " + NUMBER + rb" [ml]\b|" + NUMBER + rb"|(\((?:[^()\\]|\\.)*\)|\[[^\]]*\]|/[A-Za-z][A-Za-z0-9]*)|([A-Za-z][A-Za-z0-9]*)")


def text_of(literal):
    plain = re.sub(rb"\\([0-7]{3})", lambda m: bytes([int(m[1], 8)]), literal[1:-1])
    return plain.decode("cp1252")


class Page:
    """`paths`: (points in mm from the lower left corner, closed, how it is painted, its colour); `texts`: (text, x, y, height, turn's cos, sin)."""

    def __init__(self, width, height, content):
        self.width, self.height, self.paths, self.texts = width, height, [], []
        numbers, literals, points, closed, colour, at, size = [], [], [], False, None, None, 0.0
        for x, y, number, literal, token in TOKEN.findall(content):
            if x:
                if numbers or literals:
                    raise AssertionError("operands without an operator")
                points.append((float(x), float(y)))
                continue
            if number:
                numbers.append(float(number))
                continue
            if literal:
                literals.append(literal)
                continue
            if token == b"cm":
                if not all(abs(n - POINT ** -1) < 1e-6 for n in (numbers[0], numbers[3])):
                    raise AssertionError("not in millimetres")
            elif token == b"re":
                x, y, w, h = numbers
                points, closed = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)], True
            elif token == b"RG":
                colour = tuple(round(255 * n) for n in numbers)
            elif token == b"h":
                closed = True
            elif token in (b"S", b"B", b"f", b"n", b"W"):
                if token != b"W":
                    self.paths.append((points, closed, token.decode(), colour))
                    points, closed = [], False
            elif token == b"Tf":
                size = numbers[-1]
            elif token == b"Tm":
                at = numbers
            elif token == b"Tj":
                self.texts.append((text_of(literals[-1]), at[4], at[5], size, at[0], at[1]))
            elif token not in (b"q", b"Q", b"w", b"d", b"j", b"rg", b"BT", b"ET"):
                raise AssertionError(f"unknown operator {token}")
            numbers, literals = [], []


def pages(content):
    """[Page], through xref, catalogue and page tree."""
    if not content.startswith(b"%PDF-1.4\n") or not content.endswith(b"%%EOF\n"):
        raise AssertionError("no PDF")
    at = int(re.search(rb"startxref\n(\d+)\n%%EOF\n$", content)[1])
    head = re.match(rb"xref\n0 (\d+)\n", content[at:])
    begin = at + head.end()
    rows = [content[begin + 20 * i:begin + 20 * i + 20] for i in range(int(head[1]))]
    if any(len(row) != 20 or row[10:11] != b" " for row in rows):
        raise AssertionError("xref: rows of 20 bytes")

    def item(number):
        start = int(rows[number][:10])
        found = re.match(rb"%d 0 obj\n(.*?)\nendobj\n" % number, content[start:], re.S)
        if not found:
            raise AssertionError(f"object {number} is not where xref says")
        return found[1]
    root = int(re.search(rb"/Root (\d+) 0 R", content[at:])[1])
    tree = item(int(re.search(rb"/Pages (\d+) 0 R", item(root))[1]))
    out = []
    for number in re.findall(rb"(\d+) 0 R", re.search(rb"/Kids \[(.*?)\]", tree)[1]):
        page = item(int(number))
        width, height = (float(n) * POINT for n in re.search(rb"/MediaBox \[0 0 ([0-9.]+) ([0-9.]+)\]", page).groups())
        stream = item(int(re.search(rb"/Contents (\d+) 0 R", page)[1]))
        length, body = re.match(rb"<< /Length (\d+) >>\nstream\n(.*)endstream$", stream, re.S).groups()
        if len(body) != int(length):
            raise AssertionError("a stream of another length")
        out.append(Page(width, height, body))
    if len(out) != int(re.search(rb"/Count (\d+)", tree)[1]):
        raise AssertionError("pages lost")
    return out
