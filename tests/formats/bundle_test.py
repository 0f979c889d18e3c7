"""A frame's archive, opened by unzip and by Python: every file in it is what /v1/parts answers to the request beside it, the manifest
names each with its hash, and what is not there is said with why."""

import csv
import hashlib
import io
import json
import pathlib
import re
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree
import zipfile

from service import HOSTILE, FormatTest, examples, main

ALL = {"work-order": ("svg", "svg"), "nc1": ("nc1", "nc1"), "dxf": ("dxf", "dxf"), "step": ("step", "step"), "csv": ("csv", "csv"),
       "gcode": ("gcode", "ngc")}
CODE = "speed_mm_min=600&dialect=qtplasmac&lead_mm=2"


def frame(*ids):
    """Braces of these names on one chord, apart and each of another length."""
    members = [{"id": "chord", "start_mm": [0, 0, 0], "end_mm": [1000 + 400 * len(ids), 0, 0], "outer_diameter_mm": 168.3, "wall_mm": 8}]
    for i, one in enumerate(ids):
        x = 400 + 400 * i
        members.append({"id": one, "start_mm": [x, 0, 0], "end_mm": [x + 100, 0, 500 + 20 * i], "outer_diameter_mm": 60.3, "wall_mm": 4})
    cut = {"root_surface": "inner", "groove": {"rule": "half_dihedral"}, "smoothing": {"method": "none"}}
    return {"members": members, "defaults": cut, "kerf_mm": 1.5, "sampling": {"tolerance_mm": 0.1}, "joints": [{"between": [one, "chord"], "kind": "set_on"} for one in ids]}


def code_of(content):
    problem = json.loads(content)
    return problem["errors"][0]["pointer"] if problem.get("errors") else problem["code"]


def texts(svg):
    return [e.text or "" for e in ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text")]


class Bundles(FormatTest):
    def archive(self, body, query):
        """{name: bytes} as Python reads it, once unzip finds no fault."""
        content = self.service.text("frames", body, "format=zip" + query)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "frame.zip"
            file.write_bytes(content)
            said = subprocess.run(["unzip", "-t", file], capture_output=True)
            self.assertEqual(said.returncode, 0, said)
        with zipfile.ZipFile(io.BytesIO(content)) as opened:
            self.assertIsNone(opened.testzip())
            names = opened.namelist()
            self.assertEqual(len(names), len(set(name.lower() for name in names)))
            return {name: opened.read(name) for name in names}

    def manifest(self, files):
        """The manifest, every file of the archive in it, by its hash and size."""
        said = json.loads(files["manifest.json"])
        listed = said["files"] + [file for part in said["parts"] for file in part.get("files", [])]
        self.assertEqual(sorted([*(file["name"] for file in listed), "manifest.json"]), sorted(files))
        for file in listed:
            content = files[file["name"]]
            self.assertEqual((file["sha256"], file["bytes"]), (hashlib.sha256(content).hexdigest(), len(content)))
        return said

    def test_every_file_is_what_parts_answers(self):
        looked = 0
        for name in ("k-node-with-plate-and-square-brace", "roll-cage-of-12"):
            body = examples("frames")[name] | {"reference": {"part": "F7", "order": "A-1"}}
            whole = self.service.answer("frames", body)
            files = self.archive(body, "&files=" + ",".join(ALL) + "&" + CODE)
            said = self.manifest(files)
            self.assertEqual(said["result_sha256"], whole["result"] and whole["job"]["result_sha256"])
            self.assertEqual(json.loads(files["request.json"]), {k: v for k, v in whole["request"].items() if k != "reference"})
            self.assertEqual([p["part"] for p in said["parts"]], [row["part"] for row in whole["result"]["cut_list"]])
            for part, row in zip(said["parts"], whole["result"]["cut_list"]):
                self.assertEqual((part["members"], part["verdict"], part["result_sha256"]), (row["members"], row["verdict"], row["result_sha256"]))
                self.assertEqual(part["left_out"], [])
                by_format = {file["format"]: file["name"] for file in part["files"]}
                self.assertEqual(set(by_format), {"request", *ALL})
                request = json.loads(files[by_format["request"]]) | {
                    "reference": {"part": "F7 " + part["part"], "order": "A-1", "quantity": len(part["members"])}}
                for file, (form, ending) in ALL.items():
                    self.assertEqual(by_format[file], by_format["request"].replace(".request.json", "." + ending))
                    query = f"format={form}" + ("&" + CODE if form == "gcode" else "")
                    got, wanted = files[by_format[file]], self.service.text("parts", request, query)
                    if file == "work-order":  # which also names the owners of the pieces
                        got, wanted = [text for text in texts(got) if not text.startswith("For member")], texts(wanted)
                    self.assertEqual(got, wanted, f"{name} {by_format[file]}")
                    looked += 1
        self.assertGreaterEqual(looked, 60)

    def test_every_file_says_how_many_and_for_which_members(self):
        body = examples("frames")["roll-cage-of-12"]
        rows = {row["part"]: row["members"] for row in self.service.answer("frames", body)["result"]["cut_list"]}
        self.assertGreater(max(map(len, rows.values())), 1)
        for frames in (None, 3):
            files = self.archive(body | ({"reference": {"quantity": frames}} if frames else {}), "&files=work-order,nc1,dxf")
            for part in self.manifest(files)["parts"]:
                members = rows[part["part"]]
                pieces = len(members) * (frames or 1)
                self.assertEqual((part["members"], part["quantity"]), (members, pieces))
                content = {file["format"]: files[file["name"]] for file in part["files"]}
                order = texts(content["work-order"])
                self.assertEqual(order[order.index("quantity") + 1], str(pieces))
                whose = "For member" + "s" * (len(members) > 1) + " " + ", ".join(members) + ": one piece each"
                self.assertIn(whose + (f", for each of {frames} frames" if frames else ""), order)
                header = [line for line in content["nc1"].decode().splitlines() if not line.startswith("**")]
                self.assertEqual(header[6].strip(), str(pieces))  # behind ST, order, drawing, phase, piece and grade
                self.assertIn(f"quantity: {pieces}", content["dxf"].decode())
            said = [line for line in files["cut-list.csv"].decode().splitlines() if line.startswith("# quantity: ")]
            self.assertEqual(said, [f"# quantity: {frames} frames (count is of one frame)"] if frames else [])

    def test_members_beyond_three_lines_are_counted(self):
        ids = [f"brace number {i} of the lower row" for i in range(60)]
        members = [{"id": one, "start_mm": [300 * i, 0, 0], "end_mm": [300 * i, 0, 500], "outer_diameter_mm": 60.3, "wall_mm": 4}
                   for i, one in enumerate(ids)]
        files = self.archive({**frame(), "members": members}, "&files=work-order")
        [part] = self.manifest(files)["parts"]
        self.assertEqual(part["quantity"], 60)
        order = texts(next(content for name, content in files.items() if name.endswith(".svg")))
        at = next(i for i, text in enumerate(order) if text.startswith("For members"))
        said = " ".join(text.strip() for text in order[at:at + 3])
        left = int(re.search(r"and (\d+) more, see the cut list: one piece each$", said)[1])
        self.assertTrue(0 < left < 60)
        for one in ids[:60 - left]:
            self.assertIn(one, said)
        self.assertNotIn(ids[60 - left] + ",", said)

    def test_the_cut_list_is_that_of_the_answer(self):
        body = examples("frames")["roll-cage-of-12"]
        rows = self.service.answer("frames", body)["result"]["cut_list"]
        alone = self.service.text("frames", body, "format=csv")
        self.assertEqual(self.archive(body, "&files=nc1")["cut-list.csv"], alone)
        read = list(csv.DictReader(line for line in alone.decode().splitlines() if not line.startswith("#")))
        self.assertEqual(len(read), len(rows))
        for got, row in zip(read, rows):
            self.assertEqual(set(got), set(row))
            for name, value in row.items():
                cell = got[name].lstrip("'")
                if isinstance(value, list):
                    self.assertEqual(cell.split(", "), value)
                else:
                    self.assertEqual(float(cell) if isinstance(value, (int, float)) else cell, value)

    def test_the_same_request_gives_the_same_bytes(self):
        body = frame("a", "b")
        self.assertEqual(*(self.service.text("frames", body, "format=zip") for _ in range(2)))

    def test_names_lead_nowhere_and_never_meet(self):
        ids = ["../../etc/passwd", "..", ".hidden", "a/b", "a:b", "a_b", "A_B", "C:\\x", "-rf", "Rohr Ä 管", "%00", "x" * 64, "管" * 64, "con"]
        body = frame(*ids) | {"reference": HOSTILE | {"part": "..\\..\\<x>|?*\"" + "ü" * 20}}
        for query in ("&files=work-order", "&files=csv,step"):
            files = self.archive(body, query)
            said = self.manifest(files)
            self.assertEqual({p["part"] for p in said["parts"]}, {"chord", *ids})
            for name in files:
                self.assertLessEqual(max(len(piece.encode()) for piece in name.split("/")), 200)
                self.assertRegex(name, r"^[^/\\:*?\"<>|\x00-\x1f.\-][^/\\:*?\"<>|\x00-\x1f]*(/[^/\\:*?\"<>|\x00-\x1f.\-][^/\\:*?\"<>|\x00-\x1f]*)?$")
        plain = self.manifest(self.archive(frame("D1"), "&files=nc1"))
        for part in plain["parts"]:
            for file in part["files"]:
                self.assertRegex(file["name"], rf"^{re.escape(part['part'])}_{part['result_sha256'][:8]}/{re.escape(part['part'])}_")

    def test_what_is_left_out_is_said(self):
        files = self.archive(frame("D1", "管"), "&files=nc1,step")  # DSTV is ASCII
        said = {p["part"]: p for p in self.manifest(files)["parts"]}
        self.assertEqual([(out["format"], out["code"]) for out in said["管"]["left_out"]], [("nc1", "bad_text")])
        self.assertEqual({file["format"] for file in said["管"]["files"]}, {"request", "step"})
        self.assertEqual(said["D1"]["left_out"], [])

    def test_only_what_may_be_cut_is_lit(self):
        rejected = self.archive(frame("D1") | {"accept": {"max_b_deg": 0.5}}, "&files=gcode,nc1&speed_mm_min=600&torch=on&dialect=qtplasmac&lead_mm=2")
        for part in self.manifest(rejected)["parts"]:
            if part["verdict"] == "reject":
                self.assertEqual([(out["format"], out["code"]) for out in part["left_out"]], [("gcode", "rejected")])
        self.assertTrue(any(part["left_out"] for part in self.manifest(rejected)["parts"]))

    def test_what_the_frame_warns_of_is_acknowledged_for_every_lit_program(self):
        bars = [{"id": one, "size": "SHS 40x40x3 EN 10219", "up": [0, 0, 1], "start_mm": start, "end_mm": end} for one, start, end in
                (("long", [0, 0, 0], [1000, 0, 0]), ("across", [500, -300, 15], [500, 300, 15]))]
        body = {"preset": "tube_laser", "kerf_mm": 0.2, "members": bars, "connect": {"within_mm": 1}}
        self.assertEqual({w["code"] for w in self.service.answer("frames", body)["warnings"]}, {"members_overlap"})
        lit = "&files=gcode&speed_mm_min=600&torch=on&lead_mm=2&pivot_length_mm=0&pierce_height_mm=3&cut_height_mm=1&pierce_delay_s=0.2"
        for part in self.manifest(self.archive(body, lit))["parts"]:
            self.assertEqual([(out["format"], out["code"]) for out in part["left_out"]], [("gcode", "not_acknowledged")])
        for part in self.manifest(self.archive(body, lit + "&acknowledge=members_overlap"))["parts"]:
            self.assertEqual(part["left_out"], [])
        status, _, content = self.service.ask("frames", body, "format=zip" + lit + "&acknowledge=free_cut")
        self.assertEqual((status, code_of(content)), (422, "?acknowledge"))

    def test_tabs_of_holes_are_of_the_parts_that_have_any(self):
        body = examples("frames")["gate-with-rails-through-uprights"]
        asked = "&files=gcode&" + CODE + "&tabs=2&tab_mm=1"
        held = [0, 0]
        for part in self.manifest(files := self.archive(body, asked + "&tabs_of=holes"))["parts"]:
            self.assertEqual(part["left_out"], [])
            by_format = {file["format"]: file["name"] for file in part["files"]}
            program = files[by_format["gcode"]].decode()
            holes = re.findall(r"^\(cut: hole (.*)\)$", program, re.M)
            self.assertEqual(holes != [], "(tabs: 2 of 1 mm" in program)
            self.assertTrue(all(name.endswith((", 1 of 2", ", 2 of 2")) for name in holes), holes)
            held[holes != []] += 1
        self.assertTrue(all(held), held)
        status, _, content = self.service.ask("frames", examples("frames")["roll-cage-of-12"], "format=zip" + asked + "&tabs_of=holes")
        self.assertEqual((status, code_of(content)), (422, "?tabs_of"))

    def test_a_part_that_is_not_there_is_said(self):
        truss = examples("frames")["truss-of-19"]
        body = truss | {"members": [m | ({"outer_diameter_mm": 120} if m["id"] == "P0" else {}) for m in truss["members"]]}
        whole = self.service.answer("frames", body)
        none = [row["part"] for row in whole["result"]["cut_list"] if row["verdict"] == "none"]
        self.assertEqual(none, ["P0"])
        said = {p["part"]: p for p in self.manifest(self.archive(body, "&files=nc1"))["parts"]}
        self.assertIn("code", said["P0"]["problem"])
        self.assertNotIn("files", said["P0"])

    def test_options_are_read_or_refused(self):
        body = frame("D1")
        for query, pointer in (("&files=gcode", "?speed_mm_min"), ("&files=nc1&speed_mm_min=600", "?speed_mm_min"), ("&files=nc1,nc1", "?files"),
                               ("&files=", "?files"), ("&files=nc1,pdf", "?files"), ("&dialect=linuxcnc", "?dialect"), ("&view=x", "?view"),
                               ("&files=gcode&speed_mm_min=600&torch=on&dialect=qtplasmac&lead_mm=2&acknowledge=free_cut", "?acknowledge")):
            status, media, content = self.service.ask("frames", body, "format=zip" + query)
            self.assertGreaterEqual(status, 400, query)
            self.assertEqual(media, "application/problem+json")
            self.assertEqual(code_of(content), pointer, content)
        status, _, content = self.service.ask("frames", body, "files=nc1")
        self.assertEqual((status, code_of(content)), (400, "?files"), content)
        status, _, content = self.service.ask("parts", examples("parts")["chord-with-holes"], "format=nc1&files=nc1")
        self.assertEqual((status, code_of(content)), (400, "?files"), content)


if __name__ == "__main__":
    main()
