"""Whoever has the drawing of a hole in his hands reads of which part it is and for which branch: SVG, PDF, DXF and DSTV."""

import re
import xml.etree.ElementTree as ElementTree

import pdf_reader
from dxf_test import polylines, read
from ezdxf.lldxf.encoding import decode_dxf_unicode
from service import HOSTILE, FormatTest, examples, main

SVG = "{http://www.w3.org/2000/svg}"
REFERENCE = {"part": "N-12", "order": "4711"}


def spelled(text):
    return decode_dxf_unicode(text).replace("%%%", "%").replace("^ ", "^")


class HoleSheets(FormatTest):
    def texts(self, endpoint, body, query):
        content = self.service.text(endpoint, body, query)
        if "format=pdf" in query:
            return [text[0] for page in pdf_reader.pages(content) for text in page.texts]
        if "format=dxf" in query:
            return [spelled(text.dxf.text) for text in read(content).modelspace().query("TEXT")]
        return [e.text or "" for e in ElementTree.fromstring(content).iter(f"{SVG}text")]

    def named(self, name, chord, branch):
        body = examples("holes")[name]
        return {**body, "chord": body["chord"] | {"id": chord}, "branch": body["branch"] | {"id": branch}, "reference": REFERENCE}

    def test_a_hole_names_its_part_its_chord_and_its_branch(self):
        count = 0
        for name in examples("holes"):
            body = self.named(name, "C7", "B3")
            for query in ("format=svg", "format=svg&view=template", "format=svg&view=template&paper=a4", "format=svg&view=section",
                          "format=pdf", "format=pdf&view=section", "format=dxf", "format=dxf&view=tube"):
                with self.subTest(f"{name} {query}"):
                    said = self.texts("holes", body, query)
                    self.assertTrue(any("N-12" in text for text in said), said)
                    self.assertTrue(any("for B3" in text or text == "hole for: B3" for text in said), said)
                    if "template" not in query and query != "format=pdf":  # a template is of the part
                        self.assertTrue(any("C7" in text for text in said), said)
                    count += 1
            without = self.texts("holes", {**self.named(name, "C7", "B3"), "reference": {}}, "format=svg&view=template")
            self.assertTrue(any(text.startswith("Wrap template, C7: ") for text in without), without)
        self.assertGreaterEqual(count, 24)

    def test_both_holes_of_a_brace_are_told_apart(self):
        said = self.texts("holes", self.named("through-brace", "C7", "B3"), "format=dxf")
        self.assertIn("hole for B3", said)
        self.assertIn("far hole for B3", said)

    def test_without_names_nothing_is_made_up(self):
        body = {key: value for key, value in self.named("through-brace", "C7", "B3").items() if key != "reference"}
        for tube in ("chord", "branch"):
            body[tube] = {key: value for key, value in body[tube].items() if key != "id"}
        for query in ("format=svg", "format=svg&view=template", "format=svg&view=section", "format=dxf"):
            for text in self.texts("holes", body, query):
                self.assertNotRegex(text, r"\bfor\s*$|, ,|: $")

    def test_names_are_text(self):
        for value in HOSTILE.values():
            body = self.named("set-on-branch", value[:64], value[:64])
            for query in ("format=svg", "format=svg&view=template", "format=svg&view=section", "format=dxf"):
                self.assertTrue(any(value in text for text in self.texts("holes", body, query)), query)

    def test_a_label_stands_in_its_hole(self):
        count = 0
        for name, body in examples("parts").items():
            holes = self.service.answer("parts", body)["result"]["holes"]
            if not holes:
                continue
            drawing = read(self.service.text("parts", body, "format=dxf"))
            openings = [points for points, closed in polylines(drawing, "CUT_OUTER") if closed]
            labels = {spelled(t.dxf.text): t.dxf.insert for t in drawing.modelspace().query('TEXT[layer=="TEXT"]')}
            for i, points in enumerate(openings):
                [at] = [at for text, at in labels.items() if re.fullmatch(rf"H{i + 1} for \S+", text)]
                self.assertTrue(min(x for x, _ in points) < at[0] < max(x for x, _ in points), f"{name} H{i + 1}")
                self.assertTrue(min(z for _, z in points) < at[1] < max(z for _, z in points), f"{name} H{i + 1}")
                count += 1
        self.assertGreaterEqual(count, 5)

    def test_a_label_is_whole_on_a_template(self):
        count = 0
        for name, body in examples("parts").items():
            for query in ("format=svg&view=template", "format=svg&view=template&mirror=true"):
                root = ElementTree.fromstring(self.service.text("parts", body, query))
                seams = sorted(float(e.get("x1")) for e in root.iter(f"{SVG}line") if e.get("id") in ("seam-0", "seam-360"))
                for e in root.iter(f"{SVG}text"):
                    if re.match(r"H\d+ for ", e.text or ""):
                        half = 0.5 * 0.5 * float(e.get("font-size")) * len(e.text)
                        self.assertTrue(seams[0] <= float(e.get("x")) - half and float(e.get("x")) + half <= seams[1], f"{name}: {e.text}")
                        count += 1
        self.assertGreaterEqual(count, 10)

    def test_every_file_of_a_part_calls_a_hole_alike(self):
        body = examples("parts")["tube-laser-chord"]
        wanted = {f"H{i + 1} for {hole['branch']}" for i, hole in enumerate(self.service.answer("parts", body)["result"]["holes"])}
        self.assertEqual(len(wanted), 3)
        for query in ("format=svg&view=template", "format=pdf&view=template", "format=dxf"):
            self.assertLessEqual(wanted, set(self.texts("parts", body, query)), query)
        dstv = self.service.text("parts", body, "format=nc1").decode()
        self.assertEqual(set(re.findall(r"\*\* hole \d+ is (.*?)\r\n", dstv)), wanted)


if __name__ == "__main__":
    main()
