"""Point pairs: a program as JSON, read by a reader of its own: both edges on the contours of the answer, B again from their directions."""

import io
import json
import math
import zipfile
from urllib.parse import quote

import leads_test
from service import HOSTILE, FormatTest, examples, main, seam_row

ASKED = {"format": "gcode", "post": "point_pairs", "speed_mm_min": 600, "lead_mm": 3, "pierce_height_mm": 4, "pierce_delay_s": 0.4, "cut_height_mm": 1.5}
OVERCUT = 5.0  # mm, the default
MEDIA = "application/x-point-pairs+json"
NEAR = 1e-3  # mm


def query(options):
    return "&".join(f"{name}={quote(str(value))}" for name, value in options.items() if value is not None)


class Pair:
    """Both points as they stand, and what they say: phi on each wall, deg, and the torch's lean along and across."""

    def __init__(self, row):
        self.does, self.way, self.said = row["does"], row["way_mm"], (row["b_deg"], row["a_deg"])
        (xo, yo, self.z), (xi, yi, self.z_inner) = row["outer_mm"], row["inner_mm"]
        self.outer, self.inner = math.hypot(xo, yo), math.hypot(xi, yi)
        self.phi = math.radians(row["phi_deg"])
        assert abs(math.remainder(math.atan2(yo, xo) - self.phi, 2 * math.pi)) < 1e-6
        self.phi_inner = self.phi + math.remainder(math.atan2(yi, xi) - self.phi, 2 * math.pi)
        # From the inner point to the outer one, in the wall's own directions where the outer one is.
        dx, dy = xo - xi, yo - yi
        out = dx * math.cos(self.phi) + dy * math.sin(self.phi)
        around = -dx * math.sin(self.phi) + dy * math.cos(self.phi)
        self.b, self.a = (math.degrees(math.atan2(v, out)) for v in (self.z - self.z_inner, around))


def ends_contour(points, wall, radius):
    """The finished edge of an end, unrolled, from seam to seam."""
    return [(radius * math.radians(phi), z) for phi, z in seam_row(points["phi_deg"], points[f"z_{wall}_mm"])]


def off(point, line, girth=None):
    """mm from a line; of one round the tube, whole turns apart."""
    x, y = point
    turns = [0.0] if girth is None else [-girth, 0.0, girth]
    return min(leads_test.distance(((x % girth if girth else x) + turn, y), line) for turn in turns)


class PointPairs(FormatTest):
    def program(self, endpoint, body, **more):
        status, headers, content = self.service.reply(endpoint, json.dumps(body).encode(), query(ASKED | more))
        self.assertEqual(status, 200, content[:300])
        self.assertEqual(headers["Content-Type"], MEDIA)
        return json.loads(content), headers

    def test_both_edges_of_a_table(self):
        count = 0
        for name, body in examples("bevel-tables").items():
            if "outer_diameter_mm" not in body.get("target", {}) or "dihedral" in body or body.get("root_face_mm"):
                continue
            body = body | {"kerf_mm": 0}
            answer = self.service.answer("bevel-tables", body)
            result, target = answer["result"], answer["request"]["target"]
            outer = target["outer_diameter_mm"] / 2
            inner = outer - target["wall_mm"]
            try:
                program, _ = self.program("bevel-tables", body)
            except AssertionError as refused:
                self.assertIn("would enter the part", str(refused))
                continue
            with self.subTest(name):
                self.assertEqual(program["tube"], {"outer_diameter_mm": round(2 * outer, 6), "wall_mm": round(target["wall_mm"], 6)})
                pairs = [Pair(row) for row in program["cuts"][0]["pairs"]]
                cut = [p for p in pairs if p.does == "cut"]
                lines = [ends_contour(result["points"], wall, radius) for wall, radius in (("outer", outer), ("inner", inner))]
                for p in cut:
                    self.assertLess(max(abs(p.outer - outer), abs(p.inner - inner)), 1e-5)
                    self.assertLess(off((outer * p.phi, p.z), lines[0], 2 * math.pi * outer), NEAR)
                    self.assertLess(off((inner * p.phi_inner, p.z_inner), lines[1], 2 * math.pi * inner), NEAR)
                    self.assertAlmostEqual(p.b, p.said[0], delta=1e-3)
                    self.assertAlmostEqual(p.a, 0, delta=1e-3)
                self.nodes(cut, [(phi, b) for phi, b in zip(result["points"]["phi_deg"], result["points"]["b_deg"])])
                length = sum(math.dist(a, b) for a, b in zip(lines[0], lines[0][1:]))
                self.assertAlmostEqual(sum(p.way for p in cut), length + OVERCUT, delta=0.01 + 1e-4 * length)
                count += 1
        self.assertGreater(count, 4)

    def nodes(self, cut, table):
        """B of every row of the table, found again where a pair has its phi."""
        found = 0
        for phi, b in table:
            at = [p.b for p in cut if abs(math.remainder(math.degrees(p.phi) - phi, 360)) < 1e-5]
            found += any(abs(one - b) < 2e-3 for one in at)
        self.assertEqual(found, len(table))

    def test_every_cut_of_a_part(self):
        """In the order of the sequence, on the torch's line on both walls, from the pierce to where the torch is put out."""
        cuts = leaning = 0
        for name, change in (("chord-with-holes", {}), ("chord-with-holes", {"tilt": "free"}), ("k-joint-brace", {}), ("table-1-with-a-square-far-end", {})):
            body = examples("parts")[name]
            if change:
                body = body | {"holes": [hole | change for hole in body["holes"]]}
            answer = self.service.answer("parts", body)
            result = answer["result"]
            outer = next(d["value_mm"] for d in result["check_dimensions"] if d["name"] == "girth") / (2 * math.pi)
            program, _ = self.program("parts", body)
            wall = program["tube"]["wall_mm"]
            steps = [step for step in result["sequence"] if step["what"] != "mark"]
            with self.subTest(name):
                self.assertEqual(len(program["cuts"]), len(steps))
                for cut, step in zip(program["cuts"], steps):
                    line = leads_test.Line(result, step, outer, wall)
                    girths = (None, None) if line.hole else (2 * math.pi * line.outer, 2 * math.pi * line.inner)
                    pairs = [Pair(row) for row in cut["pairs"]]
                    does = [p.does for p in pairs]
                    first, last = does.index("cut"), len(does) - 1 - does[::-1].index("cut")
                    self.assertEqual(does, ["pierce"] + ["lead_in"] * (first - 1) + ["cut"] * (last + 1 - first) + ["lead_out"] * (len(does) - 1 - last))
                    self.assertTrue(1 < first and last < len(does) - 1)
                    self.assertEqual((cut["torch_on_at"], cut["torch_off_at"]), (0, len(pairs) - 1))
                    for p in pairs[first - 1:last + 1]:
                        self.assertLess(off((line.outer * p.phi, p.z), line.walls[0], girths[0]), NEAR)
                        self.assertLess(off((line.inner * p.phi_inner, p.z_inner), line.walls[1], girths[1]), 2e-3)
                        self.assertAlmostEqual(p.b, p.said[0], delta=1e-3)
                        self.assertAlmostEqual(p.a, p.said[1], delta=1e-3)
                        leaning += abs(p.a) > 1
                    for before, p in zip(pairs, pairs[1:]):
                        way = math.hypot(line.outer * (p.phi - before.phi), p.z - before.z)
                        if way > 2e-3:
                            self.assertAlmostEqual(p.way, way, delta=1e-4)
                    self.assertGreater(-line.into_part((math.degrees(pairs[0].phi), pairs[0].z, *pairs[0].said)), 0.2)
                    cuts += 1
        self.assertGreater(cuts, 10)
        self.assertGreater(leaning, 20)

    def test_what_it_says(self):
        body = examples("parts")["k-joint-brace"] | {"reference": HOSTILE}
        program, headers = self.program("parts", body)
        answer = self.service.answer("parts", body)
        self.assertEqual({key: program[key] for key in ("reference", "input_sha256", "result_sha256", "lights_torch", "feed_mm_min", "pierce_height_mm",
                                                        "pierce_delay_s", "cut_height_mm", "post")},
                         {"reference": HOSTILE, "input_sha256": answer["job"]["input_sha256"], "result_sha256": headers["Tubecut-Result-Sha256"],
                          "lights_torch": False, "feed_mm_min": 600, "pierce_height_mm": 4, "pierce_delay_s": 0.4, "cut_height_mm": 1.5, "post": "point_pairs"})
        self.assertEqual(program["verdict"], {"status": answer["verdict"]["status"], "reasons": answer["verdict"]["reasons"]})
        self.assertIn(f"verdict: {answer['verdict']['status']}", program["notes"][0])
        self.assertRegex(headers["Content-Disposition"], r'^attachment; filename="part-[A-Za-z0-9._-]+-' + headers["Tubecut-Input-Sha256"][:8] + r'\.json"$')
        self.assertLess(program["sag_mm"], 0.021)
        program, headers = self.program("parts", body | {"reference": {"part": "注文 7"}})  # JSON has every letter, a file's name has not
        self.assertEqual(program["reference"], {"part": "注文 7"})
        self.assertIn('"part-___7-none-', headers["Content-Disposition"])

    def test_by_the_table_and_lit(self):
        body = examples("parts")["chord-with-holes"]
        said = {name: None for name in ("speed_mm_min", "lead_mm", "pierce_height_mm", "pierce_delay_s", "cut_height_mm")}
        program, _ = self.program("parts", body, **said, machine="five_axis_cutter", material="steel", torch="on")
        machines = {m["name"]: m for m in json.loads(self.service.get("/v1/machines"))["machines"]}
        rows = machines["five_axis_cutter"]["process"]["rows"]
        found = [row for row in rows if all(row[name] == program[of] for name, of in (
            ("speed_mm_min", "feed_mm_min"), ("pierce_height_mm", "pierce_height_mm"), ("pierce_delay_s", "pierce_delay_s"), ("cut_height_mm", "cut_height_mm")))]
        self.assertEqual((len(found), program["lights_torch"]), (1, True))
        self.assertTrue(any(line.startswith("process: steel up to") for line in program["notes"]))
        self.assertIn("THIS PROGRAM LIGHTS THE TORCH", program["notes"])

    def test_what_has_no_use_or_is_missing(self):
        body = examples("parts")["chord-with-holes"]

        def refused(endpoint, asked, **more):
            status, _, content = self.service.ask(endpoint, asked, query(ASKED | more))
            self.assertIn(status, (400, 422), content[:200])
            return sorted((error["pointer"], error["code"]) for error in json.loads(content)["errors"])
        for name, value in (("pivot_length_mm", 150), ("clearance_mm", 50), ("axial", "z")):
            self.assertEqual(refused("parts", body, **{name: value}), [(f"?{name}", "unsupported_combination")])
        lacks = dict.fromkeys(("lead_mm", "pierce_height_mm", "pierce_delay_s", "cut_height_mm"))
        self.assertEqual(refused("parts", body, **lacks, torch="on"), sorted((f"?{name}", "missing_field") for name in lacks))
        schedule = {"format": "gcode", "post": "point_pairs"}
        status, _, content = self.service.ask("pulse-schedules", examples("pulse-schedules")["square-cut-from-a-bare-contour"], query(schedule))
        self.assertEqual((status, json.loads(content)["errors"][0]["pointer"]), (422, "?post"))
        own = {"name": "mine", "kind": "point_pairs", "what": "a", "checked_with": [], "not_checked": []}
        self.assertEqual(self.program("parts", body, post=json.dumps(own))[0]["post"], "mine")
        self.assertEqual(refused("parts", body, post=json.dumps(own | {"rapid": "G0 {axes}"})), [("?post/rapid", "unknown_field")])

    def test_in_a_packet_and_in_a_batch(self):
        frame = examples("frames")["truss-of-19"]
        content = self.service.text("frames", frame, "format=zip&files=gcode&post=point_pairs&speed_mm_min=600")
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            manifest = json.loads(archive.read("manifest.json"))
            files = [file for part in manifest["parts"] for file in part["files"] if file["format"] == "gcode"]
            self.assertGreater(len(files), 3)
            for file in files:
                self.assertEqual((file["name"].rpartition(".")[2], file["media"]), ("json", MEDIA))
                self.assertIn("cuts", json.loads(archive.read(file["name"])))
        line = {"id": "a", "endpoint": "bevel-tables", "format": "gcode", "options": {"post": "point_pairs", "speed_mm_min": 600}, "body": examples("bevel-tables")["mitre"]}
        status, _, content = self.service.post("/v1/batches", json.dumps(line).encode() + b"\n", media="application/x-ndjson")
        reply = json.loads(content.splitlines()[0])
        self.assertEqual((status, reply["status"], reply["media"]), (200, 200, MEDIA))
        self.assertEqual(json.loads(reply["document"])["post"], "point_pairs")


if __name__ == "__main__":
    main()
