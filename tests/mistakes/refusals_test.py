"""What refusals and signals promise, clause by clause, against the running service: refusals_test.py SERVER (the binary)"""

import json
import pathlib
import random
import sys
import tempfile
import urllib.error

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "formats"))
from service import FormatTest, Service, examples, main  # noqa: E402
from mistakes import EXAMPLES, edited, stands  # noqa: E402

TABLE, SCHEDULE = "bevel-tables/source-000-table-1", "pulse-schedules/square-cut-from-a-bare-contour"
CYCLE, NODE = "feed-curves/cut-off-194-mm-whole-cycle", "nodes/k-joint-from-centre-lines"
INCHES = {"outer_diameter_mm": 8.625, "wall_mm": 0.322}  # NPS 8 SCH 40
# The parameters that are names, and the names in a refusal; a material is one of a machine's.
NAMES = {"post": ["linuxcnc", "qtplasmac", "fanuc_style", "siemens_style"], "machine": ["five_axis_cutter", "tube_table"], "material": ["no option of format json"]}


def example(name):
    return json.loads((EXAMPLES / f"{name}.json").read_text())


def places(value, pointer=""):
    """(pointer, value) of every place in it."""
    yield pointer, value
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, one in inner:
        yield from places(one, f"{pointer}/{key}")


def scaled(value, by, name="", digits=None):
    """With every length of it `by` times as long, rounded to so many digits."""
    if isinstance(value, dict):
        return {key: scaled(one, by, key, digits) for key, one in value.items()}
    if isinstance(value, list):
        return [scaled(one, by, name, digits) for one in value]
    if not name.endswith("_mm") or not isinstance(value, (int, float)):
        return value
    return value * by if digits is None else round(value * by, digits)


class Refusals(FormatTest):
    def told(self, name, body, query=""):
        """(status, {pointer: issues}) of errors and warnings, in the order of the answer; every pointer stands in the request."""
        status, _, content = self.service.ask(name.split("/")[0], body, query)
        answer, said = json.loads(content), {}
        for one in answer.get("errors", []) + answer.get("warnings", []):
            said.setdefault(one["pointer"], []).append(one)
            if not one["pointer"].startswith("?"):
                self.assertTrue(stands(body, one["pointer"]), one)
        return status, said

    def refused(self, name, edits, query=""):
        """The one error of the example with these edits."""
        _, _, content = self.service.ask(name.split("/")[0], edited(example(name), edits), query)
        [error] = json.loads(content)["errors"]
        return error

    def parameters(self):
        """(endpoint, query parameter, its schema), by the contract; a batch has none."""
        contract = json.loads(self.service.get("/openapi.json"))
        shared = contract["components"]["parameters"]
        for path, item in contract["paths"].items():
            for one in item.get("post", {}).get("parameters", []):
                told = shared[one["$ref"].rsplit("/", 1)[1]]
                if told["in"] == "query":
                    yield path[4:], told["name"], told["schema"]

    def test_a_wrong_value_of_every_parameter_is_named_with_what_is_allowed(self):
        count = 0
        for endpoint, name, schema in self.parameters():
            if name in ("format", "view", "acknowledge"):  # names of things, of which a format has its own
                continue
            body = next(iter(examples(endpoint).values()))
            with self.subTest(f"{endpoint}?{name}"):
                status, said = self.told(endpoint, body, f"{name}=never")
                self.assertEqual((status, list(said)), (400, [f"?{name}"]))
                [error] = said[f"?{name}"]
                self.assertEqual(error["got"], "never")
                self.assertNotEqual(error["code"], "unknown_field")
                kinds = {"boolean": ["true or false"], "number": ["number"], "integer": ["whole number"], "string": NAMES.get(name)}
                for word in schema.get("enum") or schema.get("items", {}).get("enum") or kinds[schema["type"]]:
                    self.assertIn(word, error["hint"])
                count += 1
        self.assertGreater(count, 15)

    def test_every_parameter_given_twice_is_refused(self):
        count = 0
        for endpoint, name, _ in self.parameters():
            body = next(iter(examples(endpoint).values()))
            with self.subTest(f"{endpoint}?{name}"):
                status, said = self.told(endpoint, body, f"{name}=json&{name}=json")
                self.assertEqual((status, said[f"?{name}"][0]["code"]), (400, "repeated_parameter"))
                count += 1
        self.assertGreater(count, 40)

    def test_metres_are_suspected_by_every_endpoint(self):
        """Whatever is said of a request in metres, each of its fields that is refused for its size says so."""
        for folder in sorted(path for path in EXAMPLES.iterdir() if path.is_dir() and path.name != "commissioning"):
            for name, body in examples(folder.name).items():
                with self.subTest(f"{folder.name} {name}"):
                    _, said = self.told(folder.name, scaled(body, 1e-3))
                    issues = [one for every in said.values() for one in every]
                    suspected = [one for one in issues if "metres" in one.get("hint", "") + one.get("detail", "")]
                    self.assertTrue(suspected, said)
                    self.assertEqual([one for one in issues if one["code"] == "out_of_range" and one not in suspected], [])

    def test_inches_are_suspected_by_every_endpoint(self):
        """Every tube that a request describes, as NPS 8 SCH 40 in inches: its diameter is named, taken or refused."""
        count = 0
        for folder in sorted(path for path in EXAMPLES.iterdir() if path.is_dir() and path.name != "commissioning"):
            for name, body in examples(folder.name).items():
                for pointer, tube in places(body):
                    if not isinstance(tube, dict) or "outer_diameter_mm" not in tube:
                        continue
                    edits = [(f"{pointer}/{key}", value) for key, value in INCHES.items() if key in tube]
                    with self.subTest(f"{folder.name} {name} {pointer}"):
                        _, said = self.told(folder.name, edited(body, edits))
                        words = " ".join(one.get("hint", "") + one.get("detail", "") for one in said.get(f"{pointer}/outer_diameter_mm", []))
                        self.assertIn("looks like inches: 219.075 mm", words, said)
                        count += 1
        self.assertGreater(count, 40)

    def test_a_metric_design_in_inches_is_suspected(self):
        """Grooves, feed curves and frames with every length in inches to three decimals: their sizes are in no catalogue."""
        count = 0
        for folder in ("grooves", "feed-curves", "mill-paths", "nodes"):
            for name, body in examples(folder).items():
                inches = scaled(body, 1 / 25.4, digits=3)
                if inches.get("linkage", {}).get("rad_per_mm", 1) < 1e-9:
                    continue
                with self.subTest(f"{folder} {name}"):
                    _, said = self.told(folder, inches)
                    words = " ".join(one.get("detail", "") for issues in said.values() for one in issues)
                    self.assertIn("looks like inches", words, said)
                    count += 1
        self.assertGreater(count, 12)

    def test_a_metric_design_is_not_suspected_of_inches(self):
        """Every example; and lengths of any digits, which are near half millimetres as inches only by chance (four of six: one in ten thousand)."""
        for folder in sorted(path.name for path in EXAMPLES.iterdir() if path.is_dir() and path.name != "commissioning"):
            for name, body in examples(folder).items():
                _, _, content = self.service.ask(folder, body)
                self.assertNotIn(b"unit_suspicion", content, name)
        random_ = random.Random(2)
        suspected = 0
        for _ in range(400):
            body = example("grooves/case-b-near-equal-diameters")
            body["chord"] = {"outer_diameter_mm": random_.uniform(250, 400), "wall_mm": random_.uniform(8, 16)}
            body["branch"] = {"outer_diameter_mm": random_.uniform(150, 240), "wall_mm": random_.uniform(8, 12)}
            body["root_face"] = {"height_mm": random_.uniform(1, 3), "width_mm": random_.uniform(1, 2)}
            _, _, content = self.service.ask("grooves", body, "validate_only=true")
            suspected += b"unit_suspicion" in content
        self.assertLessEqual(suspected, 1)

    def test_a_catalogue_reads_no_parameters(self):
        for page in ("errors", "limits", "version", "tubes", "machines", "examples"):
            with self.subTest(page):
                self.assertTrue(json.loads(self.service.get(f"/v1/{page}")))
                with self.assertRaises(urllib.error.HTTPError) as refused:
                    self.service.get(f"/v1/{page}?size=CHS%20114.3x6.3&page=2")
                with refused.exception as answer:
                    problem = json.loads(answer.read())
                self.assertEqual((refused.exception.code, [(e["code"], e["pointer"]) for e in problem["errors"]]),
                                 (400, [("unknown_field", "?size"), ("unknown_field", "?page")]))

    def test_a_profile_left_open_by_inches_says_so(self):
        cutter = {"kind": "tube", "outer_diameter_mm": 8.625, "inclination_deg": 60}
        for name in (TABLE, "intersections/source-000-table-1"):
            status, said = self.told(name, edited(example(name), [("/cutters", [cutter])]))
            self.assertEqual((status, [e["code"] for e in said["/cutters"]]), (422, ["open_profile"]))
            self.assertIn("219.075 mm", said["/cutters/0/outer_diameter_mm"][0]["detail"])

    def test_members_in_metres_are_not_only_consumed(self):
        for name in ("parts/k-joint-brace", NODE):
            body = edited(example(name), "metres")
            status, said = self.told(name, body)
            codes = {one["code"] for every in said.values() for one in every}
            self.assertIn("member_consumed" if status == 422 else "end_consumed", codes)
            for i in range(len(body["members"])):
                self.assertIn("metres", " ".join(one.get("detail", "") for one in said[f"/members/{i}/end_mm"]))

    def test_the_unit_suspected_is_the_right_one(self):
        wrong = self.refused(TABLE, [("/target/outer_diameter_mm", 0.2191)])
        self.assertIn("metres: 219.1 mm", wrong["hint"])
        self.assertNotIn("inches", wrong["hint"])
        size = [("/target/outer_diameter_mm", None), ("/target/wall_mm", None), ("/target/size", "DN100 SCH 40")]
        self.assertEqual(self.refused(TABLE, size)["hint"], "did you mean NPS 4 SCH 40?")
        self.assertEqual(self.told(TABLE, edited(example(TABLE), [*size[:2], ("/target/size", "NPS 4 SCH 40")]))[1].get("/target/size"), None)

    def test_a_missing_up_says_so(self):
        cutter = self.refused("bevel-tables/tube-on-rectangular-tube-and-reducer", [("/cutters/0/up", None)])
        self.assertEqual((cutter["code"], cutter["pointer"]), ("missing_field", "/cutters/0/up"))
        datum = self.refused("parts/chord-with-holes", [("/members/0/up", None), ("/datum", "up")])
        self.assertEqual((datum["pointer"], datum["got"]), ("/datum", "up"))
        self.assertIn("needs an `up`", datum["hint"])

    def test_a_duplicate_says_so(self):
        self.assertIn("duplicate", self.refused(NODE, [("/members/1/id", "C1")])["hint"])
        self.assertIn("duplicate", self.refused(NODE, [("/members/2/id", "B1")])["hint"])

    def test_no_other_name_is_offered_for_one_that_is_not_similar(self):
        for edits in ([("/colour", 1)], [("/target/grade", "S355")], [("/cutters/0/material", "steel")]):
            hint = self.refused(TABLE, edits)["hint"]
            self.assertIn("known here: ", hint)
            self.assertNotIn("did you mean", hint)
        self.assertEqual(self.refused("parts/k-joint-brace", [("/member", "spare")])["hint"], "no member has this id")
        self.assertEqual(self.refused("parts/k-joint-brace", [("/member", "B11")])["hint"], "did you mean B1?")

    def test_joined_by_distance_is_as_ok_as_by_a_list(self):
        near = self.service.answer("nodes", example(NODE))
        listed = self.service.answer("nodes", {**example(NODE), "connect": [{"member": "B1", "end": "start", "to": ["C1"]},
                                                                            {"member": "B2", "end": "start", "to": ["C1", "B1"]}]})
        self.assertEqual((near["verdict"], near["warnings"]), ({"status": "ok", "reasons": []}, []))
        for part in ("verdict", "warnings", "result"):
            self.assertEqual(near[part], listed[part], part)

    def test_what_was_got_is_in_the_unit_of_its_field(self):
        slot = self.refused(CYCLE, [("/linkage/rest_angle_rad", 2.2)])
        self.assertEqual([slot[key] for key in ("code", "pointer", "got", "unit")], ["slot_off_rod", "/linkage/slot_angle_rad", 1.69, "rad"])
        rest = self.refused(CYCLE, [("/linkage/arm_mm", 300)])
        self.assertEqual([rest[key] for key in ("code", "pointer", "got", "unit")], ["reversed", "/linkage/rest_angle_rad", 1.3, "rad"])

    def test_a_field_of_the_machine_is_named_as_in_the_request(self):
        machines = {one["name"]: one["machine"] for one in json.loads(self.service.get("/v1/machines"))["machines"]}
        swung = {**machines["crawler"], "swing_center": "pivot", "pivot_length_mm": 20, "standoff_max_mm": 3}
        name = "pulse-schedules/source-002-offset-pair-on-the-crawler"
        wrong = self.refused(name, [("/machine", swung)])
        self.assertEqual([wrong[key] for key in ("code", "pointer", "limit", "unit")], ["standoff_too_large", "/machine/standoff_max_mm", 3, "mm"])

    def test_a_machine_that_is_named_is_pointed_to_whole(self):
        """The request has its name alone, not its fields."""
        machines = {one["name"]: one["machine"] for one in json.loads(self.service.get("/v1/machines"))["machines"]}
        narrow = json.loads(json.dumps(machines["five_axis_cutter"]))
        next(axis for axis in narrow["axes"] if axis["name"] == "B").update(soft_min=-5, soft_max=5)
        swung = {**machines["crawler"], "swing_center": "pivot", "pivot_length_mm": 20, "standoff_max_mm": 3}
        with tempfile.TemporaryDirectory() as folder:
            for name, machine in (("narrow", narrow), ("swung", swung)):
                pathlib.Path(folder, f"{name}.json").write_text(json.dumps({**machine, "name": name}))
            own = Service(self.binary, "--machines", folder)
            self.addCleanup(own.stop)
            for name, post, code in (("swung", "source-002-offset-pair-on-the-crawler", "standoff_too_large"),
                                     ("narrow", "table-1-on-the-five-axis-cutter", "soft_limit")):
                _, _, content = own.ask("pulse-schedules", {**example(f"pulse-schedules/{post}"), "machine": name})
                self.assertEqual([(e["code"], e["pointer"]) for e in json.loads(content)["errors"]], [(code, "/machine")])

    def test_a_warning_points_at_what_the_answer_says_was_asked(self):
        """At the request as it is echoed: whoever sends that gets the same bytes."""
        for one in json.loads(self.service.get("/v1/examples"))["examples"]:
            answer = json.loads(self.service.text(one["endpoint"], one["body"], "validate_only=true"))
            for warning in answer["warnings"]:
                self.assertTrue(stands(answer["request"], warning["pointer"]), f"{one['endpoint']} {one['name']}: {warning}")

    def test_names_without_likeness_are_not_offered(self):
        for name, edits in ((TABLE, [("/foo", 1)]), ("parts/k-joint-brace", [("/member", "Z9")]), (TABLE, [
                ("/target/outer_diameter_mm", None), ("/target/wall_mm", None), ("/target/size", "RHS 100x100")])):
            self.assertNotIn("did you mean", self.refused(name, edits)["hint"])
        self.assertEqual(self.refused("parts/k-joint-brace", [("/member", "c1")])["hint"], "did you mean C1?")

    def test_an_unknown_format_is_named(self):
        error = self.refused(TABLE, [], "format=xml")
        self.assertEqual((error["pointer"], error["got"]), ("?format", "xml"))
        self.assertIn("csv", error["hint"])
        _, _, content = self.service.reply("batches", b"{}\n", "format=csv", media="application/x-ndjson")
        self.assertEqual([e["pointer"] for e in json.loads(content)["errors"]], ["?format"])

    def test_an_option_that_does_not_go_is_shown_as_it_was_got(self):
        self.assertEqual(self.refused(TABLE, [], "format=csv&lead_mm=3")["got"], 3)

    def test_a_short_branch_is_as_ok_by_distance_as_by_a_list(self):
        short = edited(example(NODE), [("/members/1/end_mm", [-240, 12, 400])])
        listed = {**short, "connect": [{"member": "B1", "end": "start", "to": ["C1"]}, {"member": "B2", "end": "start", "to": ["C1", "B1"]}]}
        for body in (listed, short):
            self.assertEqual(self.service.answer("nodes", body)["verdict"]["status"], "ok")

    def test_ordinary_small_tubes_are_not_suspected(self):
        cut = {"cutters": [{"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 0, 1]}]}
        for diameter in (14, 16, 18, 20, 24):  # of EN 10305, in mm
            answer = self.service.answer("intersections", {**cut, "target": {"outer_diameter_mm": diameter, "wall_mm": 2}})
            self.assertEqual(answer["warnings"], [], diameter)

    def test_a_wall_in_inches_is_told_beside_a_diameter_in_inches(self):
        for name in ("bevel-tables/source-002-offset-pair", "nodes/source-002-offset-pair"):
            _, said = self.told(name, scaled(example(name), 1 / 25.4))
            self.assertIn("inches", json.dumps(said))

    def test_a_column_of_another_length_says_how_many(self):
        self.assertIn("36", self.refused(SCHEDULE, [("/contour/b_deg", [0, 0, 0])])["hint"])

    def test_a_duplicate_is_not_called_a_text_of_bad_characters(self):
        error = self.refused(NODE, [("/members/1/id", "C1")])
        self.assertEqual((error["code"] == "bad_text", error["got"]), (False, "C1"))

    def test_every_number_is_echoed_as_it_was_sent(self):
        for angle in (102, 101.99999999999999, 35.3, 57.29577951308232):
            answer = self.service.answer("bevel-tables", edited(example(TABLE), [("/cutters/0/inclination_deg", angle)]))
            self.assertEqual(answer["request"]["cutters"][0]["inclination_deg"], angle)
        count = 0
        for one in json.loads(self.service.get("/v1/examples"))["examples"]:
            echo = dict(places(json.loads(self.service.text(one["endpoint"], one["body"], "validate_only=true"))["request"]))
            for pointer, value in places(one["body"]):
                if isinstance(value, (int, float)) and pointer in echo:
                    self.assertEqual(echo[pointer], value, f"{one['endpoint']} {one['name']} {pointer}")
                    count += 1
        self.assertGreater(count, 800)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main()
