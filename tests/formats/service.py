"""The running service, asked for the formats of one request; examples and hostile references."""

import copy
import json
import math
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from running import ROOT, Running  # noqa: E402

# Text that ends, opens or escapes something in XML, DXF, DSTV or RS-274; all that a reference may hold.
HOSTILE = {
    "part": "]]><script>alert(1)</script>&amp;<!--\"'",
    "order": "x)(MSG,hello) M3 S1 G0 X0 %",
    "drawing": "%%u50%%c \\U+0041 \\P ^J{\\H9;",
    "revision": ";py,import os #1=2 [1/0] o1 call",
    "heat": "** EN\\nAK  v 0.0u",
    "customer_id": "".join(chr(c) for c in range(0x20, 0x7f))[:64],
}


class Service(Running):
    def __init__(self, binary, *options):
        super().__init__(binary, "--host", "127.0.0.1", "--budget-s", "30", *options, stderr=subprocess.DEVNULL)

    def ask(self, endpoint, body, query=""):
        """(status, content type, bytes)"""
        status, headers, content = self.reply(endpoint, json.dumps(body).encode(), query)
        return status, headers["Content-Type"], content

    def reply(self, endpoint, body, query="", media="application/json"):
        """(status, headers, bytes)"""
        return self.post(f"/v1/{endpoint}?{query}", body, media=media)

    def text(self, endpoint, body, query):
        status, _, content = self.ask(endpoint, body, query)
        if status != 200:
            raise AssertionError(f"{endpoint}?{query}: {status} {content[:400]!r}")
        return content

    def answer(self, endpoint, body):
        return json.loads(self.text(endpoint, body, ""))


def is_round(body):
    """Returns whether the target, if there is one, is a round tube: only such are drawn."""
    target = body.get("target", {})
    return "outer_diameter_mm" in target or target.get("size", "CHS").startswith(("CHS", "NPS"))


MANY = int(os.environ.get("TUBECUT_CUTOUTS", "100"))  # of a grid that is taken whole; ./dev soak formats leaves none out


def thinned(body):
    """A request whose grids of more than MANY cut-outs have two along the tube: staggered, and all round it."""
    out = copy.deepcopy(body)
    for group in out.get("cutouts", []):
        pattern = group.get("pattern", {})
        if pattern.get("kind") == "grid" and pattern["along"]["count"] * pattern["round"]["count"] > MANY:
            pattern["along"]["count"] = 2
    return out


def examples(endpoint, drawn=True, whole=False):
    """{name: request}, never empty; if `drawn`, only those that every format prints; if not `whole`, thinned, because a file of 1 792 cut-outs takes
    its readers a hundred times as long as another."""
    found = {file.stem: json.loads(file.read_text()) for file in sorted((ROOT / "examples" / endpoint).glob("*.json"))}
    found = {name: body for name, body in found.items() if not drawn or is_round(body)}
    if not found:
        raise AssertionError(f"no examples for {endpoint}")
    return found if whole else {name: thinned(body) for name, body in found.items()}


def drawing_seed():
    """The seed of requests that are drawn: always the same one, because a change is tested by the same requests as the one before
    it, unless TUBECUT_SEED gives another; `./dev soak drawn` gives new ones."""
    seed = int(os.environ.get("TUBECUT_SEED", "1"))
    print(f"seed {seed}")
    return seed


class FormatTest(unittest.TestCase):
    """One service for all tests of a class."""

    binary = ""

    @classmethod
    def setUpClass(cls):
        cls.service = Service(FormatTest.binary)

    @classmethod
    def tearDownClass(cls):
        cls.service.stop()


def cutout_name(group, instance):
    """What files call a cut-out of an answer's part."""
    return f"cut-out {instance['id']}{' far' if group['side'] == 'far' else ''}{' countersink' if group['wall'] == 'countersink' else ''}"


def cutout_points(result, index):
    """The points of a cut-out: those of its group's first instance, moved."""
    group, one = cutouts(result)[index]
    turn, along = (one[name] - group["instances"][0][name] for name in ("phi_deg", "z_mm"))

    def moved(name, value):
        return value + (turn if "phi_" in name else along if "z_" in name else 0)
    return {name: [moved(name, v) for v in column] for name, column in group["points"].items()}


def cutouts(result):
    """[(group, instance)] of an answer's part."""
    return [(group, one) for group in result.get("cutouts", []) for one in group["instances"]]


def rolled(points, radius):
    """A sheet (right, up), print side out, laid round a tube of that radius about z with `right` along it: [(x, y, z)].

    Who looks at it sees right x up towards himself; there outwards is (cos, sin, 0), so up is outwards x z and turns against x to y."""
    return [(radius * math.cos(-up / radius), radius * math.sin(-up / radius), right) for right, up in points]


def off_curve(points, curve):
    """Largest distance of points to a closed polyline in space."""
    def to_segment(p, a, b):
        d = [v - u for u, v in zip(a, b)]
        square = sum(v * v for v in d)
        share = min(1.0, max(0.0, sum((w - u) * v for u, v, w in zip(a, d, p)) / square)) if square else 0.0
        return math.dist(p, [u + share * v for u, v in zip(a, d)])
    return max(min(to_segment(p, a, b) for a, b in zip(curve, curve[1:] + curve[:1])) for p in points)


def main():
    FormatTest.binary = sys.argv.pop(1)
    unittest.main()


def seam_row(phi_deg, column):
    """A closed column with its value at the seam: [(phi, value)], from 0 to 360 deg."""
    rows = list(zip(phi_deg, column))
    ahead = phi_deg[0] + 360.0 - phi_deg[-1]
    share = phi_deg[0] / ahead if ahead else 0.0
    seam = column[0] + share * (column[-1] - column[0])
    if phi_deg[0] > 0.0:
        rows.insert(0, (0.0, seam))
    return rows + [(360.0, seam)]
