"""One cut by every way through the service: nested, as points, as a bare contour out of its CSV, as a part, in a batch, without a server,
and in every format that holds B. The same sign of B, the same motion."""

import base64
import csv
import itertools
import json
import math
import pathlib
import re
import subprocess
import tempfile
import urllib.parse

from service import FormatTest, examples, main, seam_row

MOTION = {"machine": "five_axis_cutter", "motion": {"speed": {"mm_min": 600}}}
END = ("cutters", "root_surface", "groove", "contact", "root_face_mm", "root_gap_mm", "coating_mm", "smoothing")


def cuts():
    """Every example that may be cut, without what is judged of it alone."""
    for name, body in examples("bevel-tables").items():
        if "dihedral" not in body:  # as published: for comparison only
            yield name, {k: v for k, v in body.items() if k != "accept"}


def path(schedule):
    """{axis: its pulses since the start, period by period}"""
    return {axis: list(itertools.accumulate(counts)) for axis, counts in schedule["counts"].items()}


def table_of(content):
    """(remarks, {column: cells}) of a CSV."""
    lines = content.decode("ascii").split("\r\n")
    remarks = dict(line[2:].partition(": ")[::2] for line in lines if line.startswith("# "))
    rows = list(csv.reader(line for line in lines if line and not line.startswith("#")))
    return remarks, {name: list(cells) for name, *cells in zip(*rows)}


def numbers(cells):
    return [float(cell) for cell in cells]


class Ways(FormatTest):
    def tube(self, answer):
        """(outer diameter, wall) of what is cut."""
        outer = answer["result"]["developed_length_mm"] / math.pi
        target = answer["request"].get("target")
        if target is None:
            node = answer["request"]["node"]
            target = next(m for m in node["members"] if m["id"] == node["member"])
        if "size" in target:
            if not hasattr(self, "sizes"):
                type(self).sizes = {t["size"]: t for t in json.loads(self.service.get("/v1/tubes"))["tubes"]}
            target = self.sizes[target["size"]]
        wall = target["wall_mm"]
        self.assertAlmostEqual(target["outer_diameter_mm"], outer + (2 * wall if answer["request"]["root_surface"] == "inner" else 0), delta=1e-6)
        return target["outer_diameter_mm"], wall

    known = {}  # schedules requested before

    def schedule(self, way):
        asked = json.dumps({**way, **MOTION})
        if asked not in self.known:
            self.known[asked] = self.service.answer("pulse-schedules", {**way, **MOTION})["result"]
        return self.known[asked]

    def same(self, got, wanted, what):
        for name in ("counts", "total", "events"):
            self.assertEqual(got[name], wanted[name], f"{what}: {name}")
        for axis, start in wanted["start"].items():  # degrees there and back: the last digit
            self.assertAlmostEqual(got["start"][axis], start, delta=1e-9, msg=f"{what}: {axis}")

    def test_nested_as_points_and_out_of_its_csv(self):
        compared, swung = 0, 0.0
        for name, body in cuts():
            with self.subTest(name):
                answer = self.service.answer("bevel-tables", body)
                result = answer["result"]
                outer, wall = self.tube(answer)
                surface = answer["request"]["root_surface"]
                wanted = self.schedule({"cut": body})
                tube = {"surface": surface, "outer_diameter_mm": outer, "wall_mm": wall, "closed": True}
                points = {**tube, "points": result["points"], "b_sign": result["b_sign"]}
                self.same(self.schedule({"contour": points}), wanted, "points")
                remarks, columns = table_of(self.service.text("bevel-tables", body, "format=csv"))
                bare = {**tube, "b_sign": remarks["b_sign"], "phi_deg": numbers(columns["phi_deg"]), "z_mm": numbers(columns[f"torch_{surface}_mm"]),
                        "b_deg": numbers(columns["b_deg"]), "beam_mm": numbers(columns["beam_mm"]),
                        "corner": [cell == "true" for cell in columns["corner"]]}
                self.same(self.schedule({"contour": bare}), wanted, "CSV")
                # The sign itself, by nothing of ours: the torch's axis passes both walls.
                for b, low, high in zip(result["points"]["b_deg"], result["points"]["torch_inner_mm"], result["points"]["torch_outer_mm"]):
                    self.assertAlmostEqual(high - low, wall * math.tan(math.radians(b)), delta=1e-6)
                turned = [(wanted["start"]["B"] + p / 1000) for p in path(wanted).get("B", [])]
                if turned:
                    self.assertAlmostEqual(max(turned), max(result["points"]["b_deg"]), delta=1.0)
                    self.assertAlmostEqual(min(turned), min(result["points"]["b_deg"]), delta=1.0)
                    swung = max(swung, *map(abs, turned))
                compared += 1
        self.assertGreaterEqual(compared, 8)
        self.assertGreater(swung, 20.0)

    def test_points_are_refused_with_the_other_sign_another_wall_or_none(self):
        body = dict(cuts())["source-000-table-1"]
        result = self.service.answer("bevel-tables", body)["result"]
        contour = {"surface": "inner", "outer_diameter_mm": 70, "wall_mm": 5, "closed": True, "points": result["points"], "b_sign": result["b_sign"]}
        other = {**result["points"], "b_deg": [-b for b in result["points"]["b_deg"]]}
        cases = [("missing_field", "/contour/b_sign", {k: v for k, v in contour.items() if k != "b_sign"}),
                 ("unsupported_combination", "/contour/b_sign", {**contour, "points": other}),
                 ("unsupported_combination", "/contour/wall_mm", {**contour, "wall_mm": 5.01}),
                 ("unsupported_combination", "/contour/b_sign", {**contour, "scrap": "+z"}),
                 ("comparison_only", "/contour/b_sign", {**contour, "b_sign": "inward"})]
        for code, pointer, wrong in cases:
            status, _, content = self.service.ask("pulse-schedules", {"contour": wrong, **MOTION})
            issues = [(e["code"], e["pointer"]) for e in json.loads(content)["errors"]]
            self.assertEqual((status, issues), (422, [(code, pointer)]))

    def test_a_bare_contour_states_its_sign(self):
        body = json.loads(json.dumps(examples("pulse-schedules")["square-cut-from-a-bare-contour"]))
        del body["contour"]["b_sign"]
        status, _, content = self.service.ask("pulse-schedules", body)
        self.assertEqual((status, json.loads(content)["errors"][0]["pointer"]), (422, "/contour/b_sign"))

    def test_as_an_end_of_a_part(self):
        """The part's frame begins at the long point, so lengths are rounded to other pulses; B is not."""
        compared = 0
        for name, body in cuts():
            if "target" not in body or "cutters" not in body:
                continue
            with self.subTest(name):
                part = {"target": {**body["target"], "length_mm": 3000}, "kerf_mm": body["kerf_mm"], "datum": "seam", "seam_deg": 0,
                        "ends": {"start": {k: body[k] for k in END if k in body}, "finish": {"square_at_mm": 0}}}
                part |= {k: body[k] for k in ("torch", "sampling", "preset") if k in body}
                answer = self.service.answer("bevel-tables", body)
                outer, wall = self.tube(answer)
                end = self.service.answer("parts", part)["result"]["ends"]["start"]
                self.assertEqual(end["points"]["b_deg"], answer["result"]["points"]["b_deg"])
                contour = {"outer_diameter_mm": outer, "wall_mm": wall, "closed": True,
                           **{name: end[name] for name in ("points", "b_sign", "scrap", "surface")}}
                got, wanted = self.schedule({"contour": contour}), self.schedule({"cut": body})
                self.assertEqual(got["counts"].keys(), wanted["counts"].keys())
                self.assertEqual(got["periods"], wanted["periods"])
                for axis, went in path(got).items():
                    self.assertLessEqual(max(abs(a - b) for a, b in zip(went, path(wanted)[axis])), 2, axis)
                program = self.service.text("parts", part, "format=gcode&speed_mm_min=600").decode()
                start = program[program.index("(cut: start)"):]
                swings = [float(b) for b in re.findall(r"^G1 .*? B(-?[\d.]+)", start, re.M)]
                self.assertAlmostEqual(max(swings), max(end["points"]["b_deg"]), delta=1e-4)
                self.assertAlmostEqual(min(swings), min(end["points"]["b_deg"]), delta=1e-4)
                compared += 1
        self.assertGreaterEqual(compared, 5)

    def test_in_a_batch_and_without_a_server(self):
        jobs = {name: {"cut": body, **MOTION} for name, body in cuts()} | dict(examples("pulse-schedules"))
        alone = {name: self.service.answer("pulse-schedules", body) for name, body in jobs.items()}
        lines = "".join(json.dumps({"id": name, "endpoint": "pulse-schedules", "body": body}) + "\n" for name, body in jobs.items())
        status, _, content = self.service.reply("batches", lines.encode(), media="application/x-ndjson")
        self.assertEqual(status, 200)
        with tempfile.NamedTemporaryFile("w", suffix=".ndjson") as file:
            file.write(lines)
            file.flush()
            run = subprocess.run([FormatTest.binary, "run", file.name], capture_output=True, check=True).stdout
        for what, answered in (("batch", content), ("run", run)):
            answers = {line["id"]: line for line in map(json.loads, answered.splitlines()) if "id" in line}
            self.assertEqual(answers.keys(), jobs.keys())
            for name, line in answers.items():
                self.assertEqual(line["body"]["result"], alone[name]["result"], f"{what}: {name}")
                self.assertEqual(line["verdict"], alone[name]["verdict"]["status"])

    def test_documents_in_a_batch_and_without_a_server(self):
        """The bytes of one request alone, by lines and words that name the format and its options."""
        body = dict(cuts())["source-000-table-1"]
        asked = {"csv": {}, "gcode": {"speed_mm_min": 600, "axial": "z", "lead_mm": 2.5}, "svg": {"view": "template", "mirror": True},
                 "stl": {"view": "before"}, "step": {"view": "smooth"}}

        def words(options):
            return {name: str(value).lower() for name, value in options.items()}
        lines = [json.dumps({"id": name, "endpoint": "bevel-tables", "body": body, "format": name, "options": options}) for name, options in asked.items()]
        with tempfile.TemporaryDirectory() as folder:
            batch, single = pathlib.Path(folder, "jobs.ndjson"), pathlib.Path(folder, "cut.json")
            batch.write_text("\n".join(lines))
            single.write_text(json.dumps(body))

            def run(*arguments):
                return subprocess.run([FormatTest.binary, "run", *arguments], capture_output=True, check=True).stdout
            status, _, content = self.service.reply("batches", batch.read_bytes(), media="application/x-ndjson")
            self.assertEqual(status, 200)
            answers = [{line["id"]: line for line in map(json.loads, text.splitlines()) if "id" in line} for text in (content, run(batch))]
            for name, options in asked.items():
                with self.subTest(name):
                    alone = self.service.text("bevel-tables", body, urllib.parse.urlencode({"format": name, **words(options)}))
                    given = [word for option in words(options).items() for word in ("--option", "=".join(option))]
                    self.assertEqual(run("--endpoint", "bevel-tables", "--format", name, *given, single), alone)
                    for answer in answers:
                        line = answer[name]
                        got = line["document"].encode() if "document" in line else base64.b64decode(line["document_base64"])
                        self.assertEqual((line["status"], got), (200, alone))

    def test_every_format_that_holds_b(self):
        """G-code and DSTV along the cut against the JSON, and the schedule's own G-code against its counts."""
        compared = 0
        for name, body in cuts():
            with self.subTest(name):
                answer = self.service.answer("bevel-tables", body)
                points = answer["result"]["points"]
                wanted = [b for _, b in seam_row(points["phi_deg"], points["b_deg"])]
                _, columns = table_of(self.service.text("bevel-tables", body, "format=csv"))
                for got, b in zip(numbers(columns["b_deg"]), points["b_deg"], strict=True):
                    self.assertAlmostEqual(got, b, delta=1e-9)
                nc1 = self.service.text("bevel-tables", body, "format=nc1").decode()
                self.assertIn("** bevel angles: positive where the outer edge lies further towards +x", nc1)
                for line, b in zip(re.findall(r"^\*\* B (.*)\r$", nc1, re.M), points["b_deg"], strict=True):
                    self.assertAlmostEqual(float(line.split()[5]), b, delta=1e-4)
                program = self.service.text("bevel-tables", body, "format=gcode&speed_mm_min=600").decode()
                self.assertIn("growing B leans its upper end towards +X, the outer edge then lies further that way", program)
                swings = [float(b) for b in re.findall(r"^G[01] .*? B(-?[\d.]+)", program, re.M)]
                self.assertAlmostEqual(max(swings), max(wanted), delta=1e-4)
                self.assertAlmostEqual(min(swings), min(wanted), delta=1e-4)
                schedule = self.schedule({"cut": body})
                timed = self.service.text("pulse-schedules", {"cut": body, **MOTION}, "format=gcode").decode()
                turned = [schedule["start"]["B"] + p / 1000 for p in path(schedule).get("B", [0])]
                ends = [float(b) for b in re.findall(r"^G[01] .*?B(-?[\d.]+)", timed, re.M)]
                if ends:
                    self.assertAlmostEqual(max(ends), max(turned), delta=2e-3)
                    self.assertAlmostEqual(min(ends), min(turned), delta=2e-3)
                compared += 1
        self.assertGreaterEqual(compared, 8)


if __name__ == "__main__":
    main()
