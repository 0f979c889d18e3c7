"""The numbers that pages of docs/ state, held against the running service: numbers_test.py BINARY"""

import json
import math
import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from running import ROOT, Running  # noqa: E402

BINARY = ""


class Service(unittest.TestCase):
    """One service for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.service = Running(BINARY, "--budget-s", "30")

    @classmethod
    def tearDownClass(cls):
        cls.service.stop()

    def get(self, name):
        return json.loads(self.service.get("/v1/" + name))

    def post(self, endpoint, body, wanted=200):
        status, _, content = self.service.post("/v1/" + endpoint, json.dumps(body).encode())
        self.assertEqual(status, wanted, content[:400])
        return json.loads(content)


def section(page, title):
    """The text under a heading of the page, to the next one of its depth."""
    found = re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", (ROOT / "docs" / page).read_text(), re.MULTILINE | re.DOTALL)
    if not found:
        raise AssertionError(f"docs/{page} has no section {title}")
    return found[1]


def names(text):
    return re.findall(r"`([^`]+)`", text)


def rows(text):
    """The cells of a table's rows, without its head."""
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines[1:]]


class Limits(Service):
    def setUp(self):
        self.limits = self.get("limits")

    def test_every_member_has_its_section(self):
        for member in self.limits:
            self.assertTrue(section("limits.md", f"`{member}`"), member)

    def test_every_limit_with_its_value(self):
        told = {}
        for called, values, *meaning in rows(section("limits.md", "`limits`")):
            self.assertTrue(len(meaning) == 2 and all(meaning), called)
            told.update(zip(names(called), (float(value.replace(" ", "")) for value in values.split(", ")), strict=True))
        self.assertGreater(len(told), 20)
        self.assertEqual(told, self.limits["limits"])

    def test_every_budget(self):
        said = names(section("limits.md", "`budgets`"))
        self.assertEqual(set().union(*self.limits["budgets"].values()) - set(said), set())

    def test_every_check(self):
        said = set(names(section("limits.md", "`verification`")))
        checks = {one["name"] for each in self.limits["verification"].values() for one in each}
        self.assertGreater(len(checks), 90)
        self.assertEqual(checks - said, set())


def member_of(result, path):
    """`min a.b.0` of the result: the value there, or the least or largest of a column."""
    how, _, where = path.rpartition(" ")
    for step in where.split("."):
        result = result[int(step) if isinstance(result, list) else step]
    return {"": lambda value: value, "min": min, "max": max}[how](result)


class WorkedPart(Service):
    """docs/joints.md: the part whose request stands on the page."""

    def test_its_answer(self):
        text = section("joints.md", "A part between a square tube, a plate and a bend")
        asked = json.loads(re.search(r"^```json\n(.*?)^```", text, re.MULTILINE | re.DOTALL)[1])
        partners = [one["kind"] for end in asked["ends"].values() for one in end["cutters"]]
        self.assertEqual(sorted(partners), ["elbow", "plane", "rectangular_tube"])
        answer = self.post("parts", asked)
        self.assertEqual((answer["verdict"]["status"], answer["warnings"]), ("ok", []))
        self.assertIn(f"{len(answer['verification']['checks'])} checks", " ".join(text.split()))
        result = answer["result"]
        told = rows(text)
        self.assertGreater(len(told), 15)
        for path, value, _ in told:
            with self.subTest(path):
                decimals = len(value.partition(".")[2])
                self.assertEqual(f"{member_of(result, path.strip('`')):.{decimals}f}", value)
        bench = text.partition("**On the bench.**")[2]
        dimensions = {one["name"]: one for one in result["check_dimensions"]}
        for name in ("girth", "length_at_0", "length_at_90", "length_at_180", "length_at_270", "start_overhang"):
            self.assertIn(f"{dimensions[name]['value_mm']:.2f}", bench)
        self.assertLessEqual({"clocking", "mirror"}, set(dimensions["length_at_90"]["changes_with"]))
        for quarter in (0, 90, 180, 270):
            self.assertIn("b_sign", dimensions[f"length_at_{quarter}"]["changes_with"])
        self.assertEqual([one["what"] for one in result["sequence"]], ["mark", "mark", "finish", "start"])


class TubeLaser(Service):
    """docs/joints.md: the branch that a tube laser cuts, and what its preset chooses."""

    def test_its_answer(self):
        text = section("joints.md", "Cut by a tube laser")
        asked = json.loads((ROOT / "examples/bevel-tables/tube-laser-branch.json").read_text())
        answer = self.post("bevel-tables", asked)
        chosen, told = text.split("**The gap that stays open.**")
        self.assertEqual(len(rows(chosen)), 5)
        for field in ("groove", "smoothing", "root_face_mm", "contact", "root_surface", "torch"):
            self.assertIn(field, names(chosen))
            self.assertIn(field, answer["request"])
        self.assertEqual(len(rows(told)), 5)
        for path, value, _ in rows(told):
            with self.subTest(path):
                self.assertEqual(f"{member_of(answer['result'], path.strip('`')):.{len(value.partition('.')[2])}f}", value)
        limits = {name for name in names(told) if re.match("(max|min)_[a-z_]+_mm$", name)}
        chord = json.loads((ROOT / "examples/parts/tube-laser-chord.json").read_text())
        self.assertEqual(limits, set(chord["accept"]))
        self.assertEqual(self.post("parts", chord)["verdict"]["status"], "ok")


class Readme(Service):
    """README.md: the request that it shows, and the refusal."""

    def test_they_are_what_the_service_takes_and_says(self):
        request, refusal = map(json.loads, re.findall(r"^```json\n(.*?)^```", (ROOT / "README.md").read_text(), re.MULTILINE | re.DOTALL))
        self.assertEqual(self.post("bevel-tables", request)["verdict"]["status"], "ok")
        request["target"]["wall_mm"] = 0
        self.assertEqual(self.post("bevel-tables", request, 422)["errors"], [refusal])


class Joints(Service):
    """docs/joints.md: what it quotes of the answers to examples."""

    def answer(self, name, **more):
        endpoint = name.partition("/")[0]
        return self.post(endpoint, {**json.loads((ROOT / f"examples/{name}.json").read_text()), **more})

    def says(self, title, *quotes):
        told = " ".join(section("joints.md", title).split())
        for quote in quotes:
            with self.subTest(quote):
                self.assertIn(quote, told)

    def test_k_joint(self):
        asked = json.loads((ROOT / "examples/nodes/k-joint-with-tables.json").read_text())
        whole = self.post("nodes", asked)
        ends = {(one["member"], one["end"]): one for one in whole["result"]["ends"]}
        chord, brace = (one["placement"] for one in ends["B2", "start"]["cut_by"])
        bound = next(one["detail"] for one in whole["warnings"] if one["pointer"].startswith("/members/1/"))
        first, last, lost = re.fullmatch(r"phi (.*) to (.*) deg, up to (.*) deg of groove lost, root open up to 0 mm", bound).groups()
        self.says("K joint from centre-lines",
                  f"C1 (inclination {chord['inclination_deg']:.3f} deg, offset {chord['offset_mm']:.0f} mm",
                  f"B1 ({brace['inclination_deg']:.3f} deg, offset {brace['offset_mm']:.0f} mm)",
                  f"between phi {first} and {last} deg of B1 up to {float(lost):.2f} deg of groove are lost")
        # The recipe of the page: one end of that node, with the fields of `tables`.
        node = {"members": asked["members"], "connect": asked["connect"], "member": "B2", "end": "start"}
        alone = self.post("bevel-tables", {"node": node, "sampling": asked["sampling"], **asked["tables"]})
        self.assertEqual(alone["result"]["points"], ends["B2", "start"]["table"]["points"])

    def test_offset_pair(self):
        result = self.answer("bevel-tables/source-002-offset-pair")["result"]
        b, z = result["points"]["b_deg"], result["points"]["z_inner_mm"]
        self.says("Offset pair of source 002", f"B runs from {min(b):.3f} to {max(b):.3f} deg",
                  f"z on the inner wall from {min(z):.3f} to {max(z):.3f} mm, length {result['length_mm']:.3f} mm")

    def test_set_in_branch(self):
        fit = self.answer("holes/set-in-branch")["result"]["holes"][0]["fit_up"]
        self.assertEqual((round(min(fit["root_mm"]), 9), round(max(fit["root_mm"]), 9)), (2, 2))
        self.says("Set-in branch with its hole", f"never less than {fit['least_between_nodes_mm']:.3f} mm between rows")

    def test_a_torch_that_does_not_reach(self):
        answer = self.answer("bevel-tables/table-1-torch-45-deg")
        points = answer["result"]["points"]
        gap, phi = max(zip(points["gap_mm"], points["phi_deg"], strict=True))
        self.says("Problems of a joint", f"the root opens by {gap:.3f} mm at phi {phi:.3f} deg")
        self.assertEqual(answer["verdict"]["status"], "review")
        stricter = self.answer("bevel-tables/table-1-torch-45-deg", accept={"max_root_gap_mm": 2})
        self.assertEqual(stricter["verdict"]["status"], "reject")


class Coupons(Service):
    """docs/commissioning.md: the verdicts of the four schedules."""

    def test_verdicts(self):
        told = (ROOT / "docs/commissioning.md").read_text()
        for name in ("1-square", "2-bevel-plus-30", "3-mitre-30", "4-saddle"):
            request = json.loads((ROOT / f"examples/commissioning/pulse-schedules/{name}.json").read_text())
            answer = self.post("pulse-schedules", request)
            self.assertEqual(answer["verdict"], {"status": "review", "reasons": ["enters_partner"]} if name.startswith("2") else
                             {"status": "ok", "reasons": []}, name)
            for warning in answer["warnings"]:
                depth = float(re.search(r"by up to (\S+) mm", warning["detail"])[1])
                self.assertIn(f"`{warning['code']}`, by {depth:.3f} mm", told)


class OmegaAndPhi(Service):
    """docs/theory/grooves-and-milling.md, 5.1: curve 3 of a groove and the intersection of the same pair."""

    def apart(self, groove, sign, turn):
        """The largest difference of curve 3 and the intersection's curve, mm."""
        asked = groove["request"]
        ring = asked["branch"]["outer_diameter_mm"] - 2 * asked["branch"]["wall_mm"] + 2 * asked["root_face"]["width_mm"]
        chord = {"kind": "tube", "outer_diameter_mm": asked["chord"]["outer_diameter_mm"], "inclination_deg": asked["inclination_deg"],
                 "offset_mm": sign * asked["eccentricity_mm"]}
        curves = self.post("intersections", {"target": {"outer_diameter_mm": ring, "wall_mm": 1}, "cutters": [chord],
                                             "sampling": {"uniform_points": 360}})["result"]["profiles"]
        points = next(curve["points"] for curve in curves if curve["surface"] == "outer")
        height = dict(zip(map(round, points["phi_deg"]), points["z_mm"], strict=True))
        sections, root = groove["result"]["sections"], groove["result"]["curves"]["c3"]
        for omega, phi, x, y in zip(sections["omega_deg"], sections["phi_deg"], root["x_mm"], root["y_mm"], strict=True):
            self.assertAlmostEqual((omega + 270 - phi + 180) % 360, 180, delta=1e-9)
            self.assertAlmostEqual(-x, ring / 2 * math.cos(math.radians(phi)), delta=1e-9)
            self.assertAlmostEqual(-y, ring / 2 * math.sin(math.radians(phi)), delta=1e-9)
        return max(abs(height[round(omega + turn) % 360] - z) for omega, z in zip(sections["omega_deg"], root["z_mm"], strict=True))

    def test_curve_3_is_the_intersection(self):
        told = " ".join((ROOT / "docs/theory/grooves-and-milling.md").read_text().split())
        self.assertIn("phi = omega + 270 deg, offset_mm = eccentricity_mm", told)
        for case in ("case-a-right-angle", "case-b-near-equal-diameters", "case-c-oblique-offset"):
            request = json.loads((ROOT / f"examples/grooves/{case}.json").read_text())
            groove = self.post("grooves", {**request, "sections": 360})
            self.assertLess(self.apart(groove, 1, 270), 2e-13)
        self.assertIn(f"up to {self.apart(groove, -1, 270):.2f} mm apart", told)
        self.assertIn(f"omega + 90 deg up to {self.apart(groove, 1, 90):.2f} mm", told)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    BINARY = sys.argv.pop(1)
    unittest.main()
