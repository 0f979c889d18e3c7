"""What a file is worth stands in its head: every format of a rejected and of a reviewed answer, each by a reader of its own, and what
may not be printed at all."""

import copy
import csv
import json
import re
import struct
import tempfile
import pathlib
import xml.etree.ElementTree as ElementTree

import ezdxf

import pdf_reader
import step_reader
from service import ROOT, FormatTest, examples, main

SVG = "{http://www.w3.org/2000/svg}"
SPEED = "speed_mm_min=600"


def lit(endpoint):
    """The query of a program that lights the torch: a schedule's has its leads in the request."""
    return "format=gcode&torch=on&dialect=qtplasmac" + ("" if endpoint == "pulse-schedules" else f"&lead_mm=2&{SPEED}")


def csv_head(content):
    lines = content.decode("ascii").split("\r\n")
    head = [line for line in lines if line.startswith("#")]
    rows = list(csv.reader(lines[len(head):-1]))
    if lines[:len(head)] != head or {len(row) for row in rows} != {len(rows[0])} or '"' in "".join(head) or "," in "".join(head):
        raise AssertionError("no head and a table below it")
    return [line[2:] for line in head]


def svg_head(content):
    """The texts as they stand on the page."""
    return [e.text or "" for e in ElementTree.fromstring(content).iter(f"{SVG}text")]


def pdf_head(content):
    return [text for page in pdf_reader.pages(content) for text, *_ in page.texts]


def dxf_head(content):
    """The comments before the first section, if the texts on the drawing say the same from above downwards."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "cut.dxf")
        file.write_bytes(content)
        texts = [e for e in ezdxf.readfile(file).modelspace().query("TEXT") if e.dxf.layer == "TEXT"]
    drawn = [e.dxf.text for e in sorted(texts, key=lambda e: -e.dxf.insert[1])]
    lines = content.decode("ascii").split("\r\n")
    head = [value for code, value in zip(lines[0:lines.index("SECTION"):2], lines[1::2]) if code == "999"]
    if plain(head[1:]) not in plain(drawn):
        raise AssertionError(f"drawn {drawn}, in the head {head}")
    return drawn


def glb_head(content):
    magic, _, _, size, kind = struct.unpack_from("<4sIIII", content)
    if (magic, kind) != (b"glTF", 0x4E4F534A):
        raise AssertionError("no glTF")
    extras = json.loads(content[20:20 + size])["asset"]["extras"]
    return ["verdict: " + extras["verdict"], "reasons: ", *extras["reasons"], *("warning: " + w for w in extras["warnings"])]


def stl_head(content):
    return [content[:80].decode("ascii")]


def step_head(content):
    return step_reader.File(content.decode("ascii")).header["FILE_DESCRIPTION"][0]


def nc1_head(content):
    lines = content.decode("ascii").split("\r\n")
    if lines[0] != "ST":
        raise AssertionError("no DSTV")
    return [line[3:] for line in lines[1:] if line.startswith("** ") and lines.index(line) < lines.index("AK")]


def gcode_head(content):
    lines = content.decode("ascii").splitlines()
    first = next(i for i, line in enumerate(lines) if not re.fullmatch(r"%|\(.*\)", line))
    if max(map(len, lines)) > 250:
        raise AssertionError("a line too long for a control")
    return [line[1:-1] for line in lines[1:first]]


def st_head(content):
    return re.findall(r"^\(\* (.*?) \*\)$", content.decode("ascii"), re.M)


READERS = {"text/csv": csv_head, "image/svg+xml": svg_head, "application/pdf": pdf_head, "image/vnd.dxf": dxf_head, "model/gltf-binary": glb_head,
           "model/stl": stl_head, "model/step": step_head, "application/x-dstv": nc1_head, "text/x-gcode": gcode_head, "text/x-iec61131-st": st_head}


def squeezed(texts):
    """Letters and digits alone: what every format can hold, whatever it makes of the rest."""
    joined = " ".join([texts] if isinstance(texts, str) else texts)
    return re.sub(r"[^a-z0-9]", "", joined.replace(" > ", " above ").lower())


# The first of a name: fields come before checks.
GLOSSARY = dict(reversed(re.findall(r"^\| `([^`]+)` \| ([^|]+?) \|", (ROOT / "docs/glossary.md").read_text(), re.M)))
# drawings and machine files use plain words
FOR_PEOPLE = ("image/svg+xml", "application/pdf", "image/vnd.dxf", "text/x-gcode", "application/x-dstv")


def called(pointer):
    """A name, or the names a pointer goes through, in words."""
    out, within = [], ""
    for key in pointer.strip("/").split("/"):
        if not key.isdigit():
            out.append(GLOSSARY.get(f"{within}.{key}", GLOSSARY.get(key, key)))
            within = key
    return " ".join(out)


def plain(text):
    """As drawings say it: names and pointers in words; the numbers, which they round, left out with their units."""
    text = re.sub(r"\\U\+00B0", "", " ".join([text] if isinstance(text, str) else text).replace(" > ", " above "))
    text = re.sub(r"/[a-z][a-z_0-9/]*|\b[a-z][a-z0-9]*_[a-z0-9_]+", lambda m: called(m[0]), text)
    return re.sub(r"[^a-z]", "", re.sub(r"(?<![A-Za-z])[\d.]+(e-?\d+)?( ?(deg|mm|s)\b)?", "", text).lower())


def cut_warnings(answer):
    return [w for w in answer["warnings"] if w["severity"] == "cut"]


def swinging_schedule():
    """A crawler that swings about a pivot above the wall: its stand-off grows, which is to be reviewed."""
    def axis(name, unit, v, a, j, **limits):
        return {"name": name, "unit": unit, "pulses_per_unit": 1000, "v_max": v, "a_max": a, "j_max": j, "n_max": 800, **limits}
    return examples("pulse-schedules")["source-002-offset-pair-on-the-crawler"] | {"machine": {
        "type": "crawler", "period_us": 4000, "b_positive": "outer_edge_into_part", "wheel_offset_mm": 60, "swing_center": "pivot",
        "pivot_length_mm": 20, "axes": [axis("S", "mm", 50, 200, 4000), axis("E", "mm", 100, 500, 10000),
                                        axis("B", "deg", 45, 300, 6000, soft_min=-80, soft_max=80)]}}


def rejected(endpoint, body):
    """The same with a bound that its own measures break."""
    out = copy.deepcopy(body)
    if endpoint == "pulse-schedules":
        out["motion"]["speed"] = {"mm_min": 20000}  # more than the machine follows
        out["accept"] = {"max_slow_s": 0}
    else:
        out["accept"] = {"max_b_deg": 0.5}
    return out


class Verdict(FormatTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.contract = json.loads(cls.service.get("/openapi.json"))

    def formats(self, endpoint):
        """[(media, query)] of every format in every view."""
        for media, about in self.contract["paths"][f"/v1/{endpoint}"]["post"]["responses"]["200"]["content"].items():
            if media in ("application/json", "application/cbor"):
                continue
            names = {"text/csv": "csv", "image/svg+xml": "svg", "application/pdf": "pdf", "image/vnd.dxf": "dxf", "model/gltf-binary": "glb", "model/stl": "stl",
                     "model/step": "step", "application/x-dstv": "nc1", "text/x-gcode": "gcode", "text/x-iec61131-st": "st"}
            speed = SPEED if SPEED.partition("=")[0] in about.get("x-options", []) else ""
            for view in about.get("x-views", [""]):
                yield media, "&".join(filter(None, [f"format={names[media]}", f"view={view}" if view else "", speed]))

    def look(self, endpoint, body, status):
        """Every file says what the answer says; returns how many were read."""
        answer = self.service.answer(endpoint, body)
        verdict = answer["verdict"]
        self.assertEqual(verdict["status"], status)
        codes = {w["code"] for w in cut_warnings(answer)}
        self.assertTrue(codes <= set(verdict["reasons"]))
        read = set()
        for media, query in self.formats(endpoint):
            got, headers, content = self.service.reply(endpoint, json.dumps(body).encode(), query)
            if got == 422 and "comparison_only" in codes:
                self.assertEqual(json.loads(content)["code"], "comparison_only")
                continue
            self.assertEqual(got, 200, f"{query}: {content[:300]}")
            with self.subTest(f"{endpoint} {query}"):
                self.assertEqual(headers["Tubecut-Verdict"].split(";")[0], status)
                for reason in verdict["reasons"]:
                    self.assertIn(reason, headers["Tubecut-Verdict"])
                words = READERS[media](content)
                say = plain if media in FOR_PEOPLE else squeezed
                head = say(words)
                self.assertIn(say(f"verdict: {status}"), head)
                if media == "model/stl":  # 80 bytes: the status, and the reasons for rejection first
                    first = [r for r in verdict["reasons"] if " > " in r] or verdict["reasons"] or [""]
                    self.assertIn(squeezed(first[0])[:14], head)
                    continue
                for reason in verdict["reasons"]:
                    self.assertIn(say(reason), head)
                for warning in cut_warnings(answer):
                    at = f" at {warning['pointer']}" if warning["pointer"] else ""
                    self.assertIn(say(f"warning: {warning['code']}{at}: {warning['detail']}"), head)
                read.add((media, query))
        return read

    def test_every_format_of_what_is_right(self):
        read = set()
        for endpoint, name in (("bevel-tables", "source-000-table-1"), ("parts", "chord-with-holes"), ("holes", "set-in-branch"),
                               ("pulse-schedules", "square-cut-from-a-bare-contour"), ("feed-curves", "source-004-table-1-as-solved"),
                               ("grooves", "case-a-right-angle"), ("mill-paths", "case-a-end-up"), ("intersections", "source-000-table-1")):
            read |= {(endpoint, *one) for one in self.look(endpoint, examples(endpoint)[name], "ok")}
        self.assertGreaterEqual(len(read), 29)

    def test_every_format_of_what_is_to_be_reviewed(self):
        part = copy.deepcopy(examples("parts")["table-1-with-a-square-far-end"])
        part["torch"] = {"max_deg": 45, "min_deg": -45}
        part["ends"]["start"]["contact"] = "auto"
        whole = copy.deepcopy(examples("feed-curves")["cut-off-194-mm-whole-cycle"])
        whole["cycle"]["target_per_hour"] = 500
        cases = [("bevel-tables", examples("bevel-tables")["table-1-torch-45-deg"]),
                 ("bevel-tables", examples("bevel-tables")["source-000-table-1-as-published"]), ("parts", part),
                 ("pulse-schedules", swinging_schedule()), ("feed-curves", whole),
                 ("mill-paths", examples("mill-paths")["case-b-end-down"])]
        read = set()
        for endpoint, body in cases:
            read |= {(endpoint, *one) for one in self.look(endpoint, body, "review")}
        self.assertEqual({media for _, media, _ in read} | {"model/stl"}, set(READERS))

    def test_every_format_of_what_is_rejected(self):
        read = set()
        for endpoint, name in (("bevel-tables", "table-1-torch-45-deg"), ("parts", "chord-with-holes"), ("holes", "set-in-branch"),
                               ("pulse-schedules", "")):
            body = examples(endpoint)[name] if name else swinging_schedule()
            bad = rejected(endpoint, body)
            read |= {(endpoint, *one) for one in self.look(endpoint, bad, "reject")}
        self.assertEqual({media for _, media, _ in read} | {"model/stl", "text/x-iec61131-st"}, set(READERS))

    def test_what_is_rejected_never_lights_the_torch(self):
        for endpoint, name in (("bevel-tables", "table-1-torch-45-deg"), ("parts", "chord-with-holes"),
                               ("pulse-schedules", "")):
            body = rejected(endpoint, examples(endpoint)[name] if name else swinging_schedule())
            answer = self.service.answer(endpoint, body)
            codes = ",".join(sorted({w["code"] for w in cut_warnings(answer)}))
            speed = f"&{SPEED}" if endpoint != "pulse-schedules" else ""
            for more in ("", f"&acknowledge={codes}" if codes else ""):
                status, _, content = self.service.ask(endpoint, body, f"{lit(endpoint)}{more}")
                problem = json.loads(content)
                self.assertEqual((status, problem["code"]), (422, "rejected"))
                self.assertIn(answer["verdict"]["reasons"][-1], problem["detail"])
                for error in problem["errors"]:
                    self.assertEqual(error["limit"], body["accept"][error["pointer"].removeprefix("/accept/")])
                    self.assertGreater(error["got"], error["limit"])
            dark = self.service.text(endpoint, body, f"format=gcode{speed}").decode()
            self.assertFalse(re.search(r"^M0?[34]\b", dark, re.M))

    def test_what_is_to_be_reviewed_lights_it_once_its_warnings_are_acknowledged(self):
        for endpoint, name in (("bevel-tables", "table-1-torch-45-deg"), ("pulse-schedules", "")):
            body = examples(endpoint)[name] if name else swinging_schedule()
            codes = sorted({w["code"] for w in cut_warnings(self.service.answer(endpoint, body))})
            self.assertTrue(codes)
            light = lit(endpoint)

            def refused(query):
                status, _, content = self.service.ask(endpoint, body, query)
                problem = json.loads(content)
                if status == 422:
                    self.assertEqual([(e["pointer"], sorted(e["limit"].split(","))) for e in problem["errors"]], [("?acknowledge", codes)])
                    self.assertIn("acknowledge=" + problem["errors"][0]["limit"], problem["errors"][0]["hint"])
                return status, problem["code"], problem["detail"]

            status, code, detail = refused(light)
            self.assertEqual((status, code), (422, "not_acknowledged"))
            for one in codes:
                self.assertIn(one, detail)
            status, code, detail = refused(f"{light}&acknowledge={','.join(codes)},free_end,made_up")
            self.assertEqual((status, code), (422, "not_acknowledged"))
            self.assertIn("free_end, made_up", detail)
            for one in codes:
                self.assertNotIn(one, detail)
            for wrong in (f"{light}&acknowledge=", f"{light}&acknowledge=a,,b", f"{light.replace('torch=on', 'torch=off')}&acknowledge={codes[0]}"):
                self.assertEqual(refused(wrong)[:2], (400, "bad_request"))
            for comma in (",", "%2C"):
                program = self.service.text(endpoint, body, f"{light}&acknowledge={comma.join(codes)}").decode()
                self.assertIn("(THIS PROGRAM LIGHTS THE TORCH)", program)
                self.assertTrue(re.search(r"^M3 ", program, re.M))

    def test_nothing_to_review_needs_no_acknowledgement_and_takes_none(self):
        body = examples("bevel-tables")["source-002-offset-pair"]
        self.assertIn(b"LIGHTS", self.service.text("bevel-tables", body, lit("bevel-tables")))
        status, _, content = self.service.ask("bevel-tables", body, lit("bevel-tables") + "&acknowledge=free_end")
        self.assertEqual((status, json.loads(content)["code"]), (422, "not_acknowledged"))

    def test_what_is_for_comparison_drives_no_machine(self):
        for dihedral in ("as_published", "inside"):
            body = {**examples("bevel-tables")["source-000-table-1-as-published"], "dihedral": dihedral}
            answer = self.service.answer("bevel-tables", body)
            self.assertIn("comparison_only", answer["verdict"]["reasons"])
            for query in (f"format=gcode&{SPEED}", lit("bevel-tables") + "&acknowledge=comparison_only", "format=nc1"):
                status, _, content = self.service.ask("bevel-tables", body, query)
                self.assertEqual((status, json.loads(content)["code"]), (422, "comparison_only"), query)
            drawn = squeezed(READERS["image/vnd.dxf"](self.service.text("bevel-tables", body, "format=dxf")))
            self.assertIn("comparisononly", drawn)
            motion = {"machine": "five_axis_cutter", "motion": {"speed": {"mm_min": 600}}}
            target = answer["request"]["target"]
            contour = {"surface": "outer", "outer_diameter_mm": target["outer_diameter_mm"], "wall_mm": target["wall_mm"], "closed": True,
                       "points": answer["result"]["points"], "b_sign": answer["result"]["b_sign"]}
            for way in ({"cut": body}, {"contour": contour}):
                status, _, content = self.service.ask("pulse-schedules", {**way, **motion})
                self.assertEqual((status, json.loads(content)["code"]), (422, "comparison_only"))

    def test_a_batch_line_says_it_beside_the_status(self):
        good = examples("bevel-tables")["source-002-offset-pair"]
        review = examples("bevel-tables")["table-1-torch-45-deg"]
        cases = {"good": good, "review": review, "reject": rejected("bevel-tables", review), "refused": {}}
        lines = "".join(json.dumps({"id": name, "endpoint": "bevel-tables", "body": body}) + "\n" for name, body in cases.items())
        status, _, content = self.service.reply("batches", lines.encode(), media="application/x-ndjson")
        self.assertEqual(status, 200)
        said = {line["id"]: line.get("verdict") for line in map(json.loads, content.splitlines()) if "id" in line}
        self.assertEqual(said, {"good": "ok", "review": "review", "reject": "reject", "refused": None})


if __name__ == "__main__":
    main()
