"""Numbers that no double holds, and ids that show nothing: both are refused at their field, by every endpoint."""

import json
import re

from service import FormatTest, examples, main

TOO_LARGE = ("1e400", "-1e400", "1E+309", "9" * 400, "1" + "0" * 309, "123.5e999999999999")
TOO_SMALL = ("1e-400", "-1e-400", "0." + "0" * 400 + "1", "0." + "0" * 308 + "1", "2e-310", "1e-99999999999", "123e-10000000")
WHOLE = ("1" + "0" * 308, "-" + "1" + "0" * 308, "9007199254740993", "1" + "0" * 20)
HELD = ("0.0", "-0", "0e-400", "0e400", "0." + "0" * 400, "2.2250738585072014e-308", "1e2", "0." + "0" * 250 + "1")
BLANK = ("", " ", "   ", "\u00a0", "\u2003", "\u3000 ", "\u2800", "\u3164", "\u115f\u1160", "\ufe0f", "\u034f", "\u200b", "\u200d\u200d", "\u2060", "\ufeff",
         "\u00ad", "\u202e", "\t",
         "\n", "\u0000", "\U000e0041", "\U000e0100", "\u180e", "\u2028")
SHOWN = ("a", " a", "B 12", "\u00c4\u4e2d", "\u2714\ufe0f", "-", ".")
NUMBER = -123456789.25  # placeholder in a body for the literal


def places(value, wanted, path=()):
    """The paths of all members and elements of a body that `wanted(name, value)` takes."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for name, inner in items:
        if wanted(name, inner):
            yield (*path, name)
        yield from places(inner, wanted, (*path, name))


def with_value(body, path, value):
    out = json.loads(json.dumps(body))
    at = out
    for step in path[:-1]:
        at = at[step]
    at[path[-1]] = value
    return out


def pointer_of(path):
    return "".join("/" + str(step).replace("~", "~0").replace("/", "~1") for step in path)


class NumbersAndIds(FormatTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.endpoints = sorted(json.loads(cls.service.get("/v1/examples"))["examples"], key=lambda e: (e["endpoint"], e["name"]))

    def post(self, endpoint, text, query=""):
        status, _, content = self.service.reply(endpoint, text.encode(), query)
        return status, json.loads(content)

    def first_of_each(self):
        seen = {}
        for example in self.endpoints:
            seen.setdefault(example["endpoint"], example["body"])
        self.assertGreater(len(seen), 8)
        return seen

    def test_a_number_that_no_double_holds_is_out_of_range_at_its_field(self):
        count = 0
        for endpoint, body in self.first_of_each().items():
            paths = list(places(body, lambda _, v: isinstance(v, (int, float)) and not isinstance(v, bool)))[:6]
            self.assertTrue(paths, endpoint)
            for path in paths:
                for literal in (*TOO_LARGE[:2], *TOO_SMALL[:4], *WHOLE[:1]):
                    text = json.dumps(with_value(body, path, NUMBER)).replace(str(NUMBER), literal)
                    status, answer = self.post(endpoint, text, "validate_only=true")
                    got = [(e["pointer"], e["code"], e["got"]) for e in answer.get("errors", [])]
                    self.assertEqual((status, answer.get("code"), got), (422, "out_of_range", [(pointer_of(path), "out_of_range",
                                     literal if len(literal) <= 80 else literal[:80] + "...")]), (endpoint, path, literal[:20]))
                    count += 1
        print(f"{count} numbers")
        self.assertGreater(count, 200)

    def test_which_numbers_they_are(self):
        def asked(literal):
            text = json.dumps({**examples("bevel-tables")["mitre"], "x/y~": [1, {"n": NUMBER}]}).replace(str(NUMBER), literal)
            status, answer = self.post("bevel-tables", text)
            return status, [(e["pointer"], e["code"], e["limit"]) for e in answer["errors"]]
        for literals, limit in ((TOO_LARGE, 1.7976931348623157e308), (TOO_SMALL, 2.2250738585072014e-308), (WHOLE[2:], 2.0 ** 53)):
            for literal in literals:
                self.assertEqual(asked(literal), (422, [("/x~1y~0/1/n", "out_of_range", limit)]), literal[:30])
        for literal in HELD:
            self.assertEqual([code for _, code, _ in asked(literal)[1]], ["unknown_field"], literal[:30])

    def test_bytes_that_are_no_json_stay_unreadable(self):
        for text in ('{"a":1e400', '{"a":1e400x}', '{"a":[1e}', '{"a":-}', '{"a":NaN}', '[1e400', '{"a" 1e400}'):
            status, answer = self.post("bevel-tables", text)
            first = json.loads(json.dumps(answer))
            self.assertIn((status, first["code"]), ((400, "unreadable_json"), (422, "out_of_range")), text)
        self.assertEqual(self.post("bevel-tables", '{"a":[1e}')[1]["code"], "unreadable_json")

    def test_a_batch_line_and_a_post_say_where_too(self):
        line = '{"id": "1", "endpoint": "bevel-tables", "body": {"kerf_mm": 1e-400}}\n'
        status, _, content = self.service.post("/v1/batches", line.encode(), media="application/x-ndjson")
        self.assertEqual(status, 200, content[:300])
        self.assertIn(b'"/body/kerf_mm"', content)
        status, answer = self.post("bevel-tables", json.dumps(examples("bevel-tables")["mitre"]), "format=gcode&speed_mm_min=600&post=%7B%22block_numbers%22:1e-400%7D")
        self.assertEqual((status, answer["errors"][0]["pointer"], answer["errors"][0]["code"]), (400, "?post/block_numbers", "out_of_range"))

    def test_an_id_shows_something(self):
        """Every id of every example, one at a time."""
        ids = 0
        for example in self.endpoints:
            body, endpoint = example["body"], example["endpoint"]
            for path in list(places(body, lambda name, v: name == "id" and isinstance(v, str)))[:4]:
                ids += 1
                for blank in (BLANK if ids <= 6 else BLANK[1:3] + BLANK[6:9]):
                    status, answer = self.post(endpoint, json.dumps(with_value(body, path, blank)), "validate_only=true")
                    got = [(e["pointer"], e["code"]) for e in answer.get("errors", [])]
                    self.assertEqual((status, got[:1]), (422, [(pointer_of(path), "bad_text")]), (endpoint, path, ascii(blank)))
                for shown in SHOWN:
                    _, answer = self.post(endpoint, json.dumps(with_value(body, path, shown)), "validate_only=true")
                    self.assertNotIn((pointer_of(path), "bad_text"), [(e["pointer"], e["code"]) for e in answer.get("errors", [])], (endpoint, path, shown))
        print(f"{ids} ids")
        self.assertGreater(ids, 10)

    def test_ids_of_every_endpoint_that_takes_them(self):
        for endpoint, extra in (("bevel-tables", ("target", "id")), ("bevel-tables", ("cutters", 0, "id")), ("intersections", ("cutters", 0, "id")),
                                ("holes", ("chord", "id")), ("holes", ("branch", "id")), ("bevel-tables", ("reference", "part")), ("bevel-tables", ("reference", "customer_id"))):
            body = json.loads(json.dumps(next(b for b in examples(endpoint).values() if extra[0] in b or extra[0] == "reference")))
            if extra[0] == "reference":
                body["reference"] = {}
            for blank in BLANK:
                status, answer = self.post(endpoint, json.dumps(with_value(body, extra, blank)), "validate_only=true")
                self.assertEqual((status, [(e["pointer"], e["code"]) for e in answer.get("errors", [])]), (422, [(pointer_of(extra), "bad_text")]), (endpoint, extra, ascii(blank)))

    def test_the_contract_has_the_same_texts(self):
        contract = self.service.get("/openapi.yaml").decode()
        pattern = re.search(r"^    Text:\n(?:      .*\n)*?      pattern: '(.*)'", contract, re.M)[1]
        text = re.compile(re.sub(r"\\u([0-9A-F]{4})", lambda m: re.escape(chr(int(m[1], 16))) if int(m[1], 16) < 0xd800 or int(m[1], 16) > 0xdfff else m[0], pattern)
                          .replace(r"\uD800-\uDFFF", ""))
        for blank in (b for b in BLANK if b < "\U00010000"):
            self.assertIsNone(text.fullmatch(blank), ascii(blank))
        for shown in SHOWN:
            self.assertIsNotNone(text.fullmatch(shown), shown)


if __name__ == "__main__":
    main()
