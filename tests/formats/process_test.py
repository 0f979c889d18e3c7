"""Process tables: a program of a machine and a material is that of the same values said one by one, and every gap is named."""

import io
import json
import pathlib
import subprocess
import tempfile
import zipfile

import torch_program
from service import ROOT, FormatTest, Service, examples, main

SAID = {"speed_mm_min": "speed_mm_min", "lead_mm": "shortest_lead_mm", "pierce_height_mm": "pierce_height_mm", "pierce_delay_s": "pierce_delay_s",
        "cut_height_mm": "cut_height_mm"}
OF_TABLE = {"format": "gcode", "machine": "five_axis_cutter", "material": "steel"}


def query(options):
    return "&".join(f"{name}={value}" for name, value in options.items() if value is not None)


def beams(part):
    """How much metal the beam goes through, of every row of every cut."""
    for end in part["ends"].values():
        yield from end["points"]["beam_mm"]
    for hole in part["holes"]:
        yield from hole["points"]["beam_mm"]


def blocks(program):
    return [line for line in program.splitlines() if not line.startswith("(")]


def entry_of(service, name):
    return {m["name"]: m for m in json.loads(service.get("/v1/machines"))["machines"]}[name]


def whole(entry):
    """The machine as its file has it."""
    return entry["machine"] | {"process": entry["process"]}


class FromTheTable(FormatTest):
    def machine(self, name="five_axis_cutter"):
        return entry_of(self.service, name)

    def test_the_table_and_whose_its_numbers_are(self):
        entry = self.machine()
        process, values = entry["process"], {v["member"]: v for v in entry["values"]}
        for i, row in enumerate(process["rows"]):
            for member in row.keys() - {"material"}:
                self.assertTrue(values[f"process/rows/{i}/{member}"]["assumption"])
        self.assertTrue(values["process/clearance_mm"]["assumption"])
        self.assertGreater(len(process["rows"]), 3)
        said = {m["name"]: m for m in json.loads(self.service.get("/v1/version"))["machines"]}
        self.assertEqual(said["five_axis_cutter"]["process_sha256"], entry["process_sha256"])
        self.assertNotIn("process", self.machine("crawler"))
        self.assertNotIn("process", entry["machine"])  # machine_sha256 is over its text

    def test_a_program_is_that_of_the_same_values_said(self):
        machine, count = whole(self.machine()), 0
        for name, body in examples("parts").items():
            answer = self.service.answer("parts", body)
            if answer["verdict"] == "reject":
                continue
            codes = sorted({w["code"] for w in answer["warnings"] if w["severity"] == "cut"})
            metal = max(beams(answer["result"]))
            rows = sorted((r for r in machine["process"]["rows"] if r["metal_max_mm"] >= metal), key=lambda r: r["metal_max_mm"])
            lit = {"torch": "on", "acknowledge": ",".join(codes) or None}
            status, _, content = self.service.ask("parts", body, query(OF_TABLE | lit))
            with self.subTest(name):
                if status != 200:
                    self.assertTrue(not rows or b"shortest lead" in content, content[:300])
                    continue
                program = content.decode()
                said = {option: rows[0][member] for option, member in SAID.items()}
                said |= {"format": "gcode", "pivot_length_mm": machine["pivot_length_mm"], "clearance_mm": machine["process"]["clearance_mm"]}
                self.assertEqual(blocks(program), blocks(self.service.text("parts", body, query(said | lit)).decode()))
                self.assertIn(f"(process: steel up to {rows[0]['metal_max_mm']:g} mm, the beam goes through {metal:.2f}".rstrip("0").rstrip("."), program)
                self.assertNotIn("of the request, not of the table", program)
                count += 1
        self.assertGreater(count, 3)

    def test_a_wall_as_thick_as_a_row_allows_takes_that_row(self):
        """Whatever the diameter: the metal between two radii is the wall but for rounding."""
        rows = self.machine("tube_table")["process"]["rows"]
        tubes = [{"outer_diameter_mm": d, "wall_mm": t} for d in (42.4, 48.3, 60.3, 76.1, 88.9, 101.6, 114.3, 168.3) for t in (2, 4, 6)]
        tubes += [{"kind": "rectangular_tube", "height_mm": 100, "width_mm": 60, "wall_mm": t, "corner_radius_mm": 2.5 * t} for t in (2, 4, 6)]
        for tube in tubes:
            body = {"preset": "tube_laser", "target": tube | {"length_mm": 400}, "ends": {end: {"square_at_mm": 0} for end in ("start", "finish")}, "kerf_mm": 0.2}
            row = min((r for r in rows if r["metal_max_mm"] >= tube["wall_mm"]), key=lambda r: r["metal_max_mm"])
            program = self.service.text("parts", body, query({"format": "gcode", "machine": "tube_table", "material": "steel"})).decode()
            self.assertIn(f"(process: steel up to {row['metal_max_mm']:g} mm,", program, tube)

    def test_what_is_said_goes_first(self):
        body = examples("parts")["chord-with-holes"]
        program = self.service.text("parts", body, query(OF_TABLE | {"speed_mm_min": 700, "pierce_delay_s": 0.9, "torch": "on"})).decode()
        self.assertIn("#<speed_mm_min> = 700.000", program)
        self.assertIn("G4 P0.900", program)
        self.assertIn("(of the request, not of the table: feed, pierce delay)", program)
        self.assertIn("(kerf of the request, in the table it is 2.2 mm)", program)
        radius = body["members"][0]["outer_diameter_mm"] / 2
        cuts = torch_program.replay(program, radius, 150.0)
        torch_program.check_heights(cuts, 5.0, 2.0)
        self.assertTrue(all(cut.lit and cut.dwell == 0.9 for cut in cuts) and len(cuts) == 4)
        by_control = self.service.text("parts", body, query(OF_TABLE | {"post": "qtplasmac", "torch": "on"})).decode()
        self.assertNotIn("\nG4 ", by_control)  # heights and delay are QtPlasmaC's

    def refused(self, body, service=None, **options):
        status, _, content = (service or self.service).ask("parts", body, query({"format": "gcode"} | options))
        self.assertIn(status, (400, 422), content[:300])
        return [(issue["pointer"], issue["code"]) for issue in json.loads(content)["errors"]]

    def test_what_is_wrong_is_named(self):
        body = examples("parts")["chord-with-holes"]
        five = {"machine": "five_axis_cutter", "material": "steel"}
        self.assertEqual(self.refused(body, machine="five_axis_cutter"), [("?material", "missing_field")])
        self.assertEqual(self.refused(body, material="steel"), [("?machine", "missing_field")])
        self.assertEqual(self.refused(body, **five | {"machine": "other"}), [("?machine", "unknown_machine")])
        self.assertEqual(self.refused(body, **five | {"machine": "crawler"}), [("?machine", "bad_choice")])
        self.assertEqual(self.refused(body, **five | {"material": "1.4301"}), [("?material", "bad_choice")])
        self.assertEqual(self.refused(body, **five, torch="on", lead_mm=0), [("?lead_mm", "missing_field")])
        self.assertEqual(self.refused(body, **five, post="qtplasmac", cut_height_mm=1), [("?cut_height_mm", "unsupported_combination")])
        status, _, content = self.service.ask("parts", body, query(five))
        self.assertEqual((status, {e["pointer"] for e in json.loads(content)["errors"]}), (400, {"?machine", "?material"}))

    def test_a_frame_takes_the_row_of_each_part(self):
        body = examples("frames")["gate"] if "gate" in examples("frames") else next(iter(examples("frames").values()))
        status, _, content = self.service.ask("frames", body, query(OF_TABLE | {"format": "zip", "files": "gcode"}))
        self.assertEqual(status, 200, content[:300])
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            programs = [archive.read(name).decode() for name in archive.namelist() if name.endswith(".ngc")]
        self.assertGreater(len(programs), 1)
        self.assertTrue(all("(process: steel up to " in program for program in programs))


class Own(FormatTest):
    """Machines of a folder."""

    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        five = Service(FormatTest.binary)
        cls.machine = whole(entry_of(five, "five_axis_cutter"))
        five.stop()
        row = cls.machine["process"]["rows"][0] | {"material": "1.4301", "metal_max_mm": 12.0}
        generic = {"type": "generic", "name": "no_pivot", "period_us": 4000, "b_positive": "outer_edge_into_part", "axes": cls.machine["axes"], "process": {"rows": [row]}}
        long_lead = cls.machine | {"name": "long_lead", "process": {"rows": [row | {"metal_max_mm": 30.0, "shortest_lead_mm": 60.0}]}}
        for machine in (cls.machine | {"name": "thin", "process": {"rows": [row]}}, generic, long_lead):
            pathlib.Path(cls.place.name, f"{machine['name']}.json").write_text(json.dumps(machine))
        cls.service = Service(FormatTest.binary, "--machines", cls.place.name)

    @classmethod
    def tearDownClass(cls):
        cls.service.stop()
        cls.place.cleanup()

    refused = FromTheTable.refused

    def test_what_the_table_does_not_reach(self):
        body = examples("parts")["chord-with-holes"]  # the beam goes through 13.98 mm
        self.assertEqual(self.refused(body, machine="thin", material="1.4301"), [("?material", "unsupported_combination")])
        self.assertEqual(self.refused(body, machine="no_pivot", material="1.4301", torch="on"), [("?pivot_length_mm", "missing_field")])
        self.assertEqual(self.refused(body, machine="long_lead", material="1.4301"), [("?lead_mm", "unsupported_combination")])
        program = self.service.text("parts", body, query({"format": "gcode", "machine": "long_lead", "material": "1.4301", "lead_mm": 3})).decode()
        self.assertIn("(of the request, not of the table: lead)", program)

    def test_a_table_moves_no_axis(self):
        """Its hash is apart: a schedule by name is the same job with another table."""
        shelf = {m["name"]: m for m in json.loads(self.service.get("/v1/machines"))["machines"]}
        self.assertNotEqual(shelf["thin"]["process_sha256"], shelf["long_lead"]["process_sha256"])
        with tempfile.TemporaryDirectory() as folder:
            plain = {key: value for key, value in self.machine.items() if key != "process"} | {"name": "thin"}
            pathlib.Path(folder, "thin.json").write_text(json.dumps(plain))
            other = Service(FormatTest.binary, "--machines", folder)
            try:
                bare = {m["name"]: m for m in json.loads(other.get("/v1/machines"))["machines"]}["thin"]
                version = json.loads(other.get("/v1/version"))["configuration_sha256"]
            finally:
                other.stop()
        self.assertEqual(bare["machine_sha256"], shelf["thin"]["machine_sha256"])
        self.assertNotIn("process_sha256", bare)
        self.assertNotEqual(version, json.loads(self.service.get("/v1/version"))["configuration_sha256"])

    def test_an_inline_machine_may_have_one(self):
        body = examples("pulse-schedules")["square-cut-from-a-bare-contour"]
        with_table, plain = (self.service.answer("pulse-schedules", body | {"machine": machine}) for machine in
                             (self.machine, {key: value for key, value in self.machine.items() if key != "process"}))
        self.assertEqual(with_table["result"], plain["result"])
        self.assertEqual(with_table["request"]["machine"]["process"], self.machine["process"])

    def test_faults_of_a_table_are_named_at_the_start(self):
        process, row = self.machine["process"], self.machine["process"]["rows"][0]
        cases = ((process | {"clearance": 5}, "/process/clearance: "), ({"rows": []}, "/process/rows: "), ({}, "/process/rows: "),
                 ({"rows": [row | {"feed": 1}]}, "/process/rows/0/feed: "), ({"rows": [row | {"speed_mm_min": 0}]}, "/process/rows/0/speed_mm_min: "),
                 ({"rows": [row, row]}, "/process/rows/1/metal_max_mm: "), ({"rows": [row | {"material": "Stähle"}]}, "/process/rows/0/material: "),
                 ({"rows": [{key: row[key] for key in row if key != "pierce_delay_s"}]}, "/process/rows/0/pierce_delay_s: "),
                 ({"rows": [row | {"shortest_lead_mm": 0}]}, "/process/rows/0/shortest_lead_mm: "))
        for table, wanted in cases:
            with tempfile.TemporaryDirectory() as folder, self.subTest(wanted):
                pathlib.Path(folder, "mine.json").write_text(json.dumps(self.machine | {"name": "mine", "process": table}))
                ran = subprocess.run([FormatTest.binary, "run", "--machines", folder, "--endpoint", "bevel-tables",
                                      str(ROOT / "examples/bevel-tables/mitre.json")], capture_output=True, text=True)
                self.assertEqual(ran.returncode, 1)
                self.assertIn(f"mine.json: {wanted}", ran.stderr)


if __name__ == "__main__":
    main()
