"""Letters of any script: formats that can print them hold them, formats of ASCII spell them and say so, or refuse them by the field."""

import json

from service import FormatTest, examples, main
from text_test import READERS

LATIN = {"part": "Träger Ø60 – ⌀ 5 µ", "order": "Łódź, Žižkov, façade", "drawing": "Straße Ñ ĸ"}
SPELLED = {"part": "Traeger O60 - dia 5 u", "order": "Lodz, Zizkov, facade", "drawing": "Strasse N k"}
OTHERS = {"part": "注文 7", "order": "𠮷野", "drawing": "Тройник"}
NOTE = ", spelled in ASCII"
WHERE = {"bevel-tables": ("svg", "dxf", "gcode", "nc1", "glb", "step"), "parts": ("svg", "dxf", "gcode", "nc1", "step"), "feed-curves": ("svg", "st")}
ASCII = ("gcode", "nc1", "st")
UNSEEN = ["a\u200bb", "\u202egnol", "a\u2028b", "\u00ad", "a\ufeff", "\x7f", "a\u0085b", "\ufffe"]


def query(name):
    return f"format={name}" + ("&speed_mm_min=600" if name == "gcode" else "")


class Letters(FormatTest):
    def requests(self):
        for endpoint, formats in WHERE.items():
            name = {"bevel-tables": "source-000-table-1", "parts": "table-1-with-a-square-far-end"}.get(endpoint, "source-004-table-1-as-solved")
            yield endpoint, examples(endpoint)[name], formats

    def test_what_can_print_them_holds_them(self):
        for endpoint, body, formats in self.requests():
            for words in (LATIN, OTHERS):
                answer = self.service.answer(endpoint, body | {"reference": words})
                self.assertEqual(answer["request"]["reference"], words)
                for name in set(formats) - set(ASCII):
                    with self.subTest(f"{endpoint} {name} {words}"):
                        _, texts, _ = READERS[name](self.service.text(endpoint, body | {"reference": words}, query(name)))
                        texts = [text.encode("utf-16", "surrogatepass").decode("utf-16") for text in texts]
                        for word in words.values():
                            self.assertTrue(any(word in text for text in texts), f"{word} not in {texts[:40]}")

    def test_ascii_spells_them_and_says_so(self):
        for endpoint, body, formats in self.requests():
            for name in set(formats) & set(ASCII):
                with self.subTest(f"{endpoint} {name}"):
                    plain = self.service.text(endpoint, body | {"reference": SPELLED}, query(name))
                    spelled = self.service.text(endpoint, body | {"reference": LATIN}, query(name))
                    acts, texts, _ = READERS[name](spelled)
                    self.assertEqual(acts, READERS[name](plain)[0])
                    for word in SPELLED.values():
                        self.assertTrue(any(word in text for text in texts), f"{word} not in {texts}")
                    self.assertTrue(any(NOTE in text for text in texts))
                    self.assertNotIn(NOTE, plain.decode("ascii"))

    def test_what_has_no_spelling_is_refused_by_its_field(self):
        for endpoint, body, formats in self.requests():
            for name in set(formats) & set(ASCII):
                with self.subTest(f"{endpoint} {name}"):
                    status, _, content = self.service.ask(endpoint, body | {"reference": LATIN | OTHERS}, query(name))
                    problem = json.loads(content)
                    self.assertEqual((status, problem["code"]), (422, "bad_text"))
                    self.assertEqual([(e["pointer"], e["got"]) for e in problem["errors"]],
                                     [(f"/reference/{key}", word) for key, word in OTHERS.items()])

    def test_ids_are_kept_and_spelled_too(self):
        """Of members, in the answer, the drawings and the marks; not where a tape has no words for them."""
        for id in ("Träger 1", "支管"):
            body = json.loads(json.dumps(examples("parts")["chord-with-holes"], ensure_ascii=False).replace('"B1"', f'"{id}"'))
            answer = self.service.answer("parts", body)
            self.assertEqual([member["id"] for member in answer["request"]["members"]], ["C1", id, "B2"])
            self.assertIn(id, [mark["text"] for mark in answer["result"]["marks"]])
            for name in ("svg", "dxf"):
                _, texts, _ = READERS[name](self.service.text("parts", body, query(name)))
                self.assertTrue(any(id in text for text in texts), f"{name}: {texts[:40]}")
        latin = json.loads(json.dumps(examples("parts")["chord-with-holes"]).replace('"B1"', '"Träger 1"'))
        plain = json.loads(json.dumps(examples("parts")["chord-with-holes"]).replace('"B1"', '"Traeger 1"'))
        acts, texts, _ = READERS["gcode"](self.service.text("parts", latin, query("gcode")))
        self.assertEqual(acts, READERS["gcode"](self.service.text("parts", plain, query("gcode")))[0])
        self.assertTrue(any("Traeger 1" in text and text.endswith(NOTE) for text in texts), texts[:40])

    def test_an_id_is_refused_where_it_would_be_printed(self):
        body = json.loads(json.dumps(examples("parts")["chord-with-holes"]).replace('"B1"', '"支管"'))
        status, _, content = self.service.ask("parts", body, query("gcode"))
        problem = json.loads(content)
        self.assertEqual((status, problem["code"]), (422, "bad_text"))
        self.assertTrue(problem["errors"])
        for error in problem["errors"]:
            self.assertEqual(error["got"], "支管")
        self.assertEqual(self.service.ask("parts", body, query("svg"))[0], 200)

    def test_what_is_not_seen_is_no_text(self):
        body = examples("intersections")["two-tubes-by-axis"]
        for word in [*UNSEEN, "", "ä" * 65]:
            with self.subTest(word.encode("unicode_escape")):
                status, _, content = self.service.ask("intersections", body | {"reference": {"part": word}})
                self.assertEqual((status, json.loads(content)["errors"][0]["pointer"]), (422, "/reference/part"))
        self.assertEqual(self.service.ask("intersections", body | {"reference": {"part": "𠮷" * 64}})[0], 200)


if __name__ == "__main__":
    main()
