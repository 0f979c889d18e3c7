"""Sections of a groove: what is drawn is measured on the sheet and held against the answer."""

import math
import random
import re
import xml.etree.ElementTree as ElementTree

from service import FormatTest, examples, main

SVG = "{http://www.w3.org/2000/svg}"
FILLER = "#f3d9c5"
DRAWN = 0.002  # of an area: points to 0.001 mm of paper, chords of the chord's ellipse


def shoelace(points):
    return 0.5 * abs(sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(points, points[1:] + points[:1])))


class Sheet:
    def __init__(self, svg):
        root = ElementTree.fromstring(svg)
        self.size = root.get("width"), root.get("height")
        self.texts = ["".join(e.itertext()) for e in root.iter(SVG + "text")]
        over, under = next(re.fullmatch(r"scale: (\d+):(\d+)", t) for t in self.texts if t.startswith("scale")).groups()
        self.scale = int(over) / int(under)
        self.fillers = [[tuple(map(float, p.split(","))) for p in e.get("points").split()]
                        for e in root.iter(SVG + "polygon") if e.get("fill") == FILLER]

    def areas(self):
        return [shoelace(points) / self.scale**2 for points in self.fillers]


class GrooveSection(FormatTest):
    def sheet(self, body, more=""):
        return Sheet(self.service.text("grooves", body, "format=svg&view=section" + more))

    def test_eight_sections_hold_the_filler_area_at_the_named_scale(self):
        for name, body in examples("grooves").items():
            with self.subTest(name):
                sheet, sections = self.sheet(body), self.service.answer("grooves", body)["result"]["sections"]
                self.assertEqual(sheet.size, ("210.000mm", "297.000mm"))
                self.assertEqual(len(sheet.fillers), 8)
                count = len(sections["omega_deg"])
                wanted = [sections["area_d_mm2"][(k * count + 4) // 8 % count] for k in range(8)]
                for got, area in zip(sheet.areas(), wanted):
                    self.assertAlmostEqual(got / area, 1, delta=DRAWN)

    def test_the_section_at_an_angle_is_that_of_the_answer_there(self):
        r = random.Random(7)
        for name, body in examples("grooves").items():
            with self.subTest(name):
                sections = self.service.answer("grooves", body)["result"]["sections"]
                i = r.randrange(len(sections["omega_deg"]))
                sheet = self.sheet(body, f"&omega_deg={sections['omega_deg'][i] - 360}")
                self.assertAlmostEqual(sheet.areas()[0] / sections["area_d_mm2"][i], 1, delta=DRAWN)
                (x1, y1), (x3, y3), (x2, y2) = sheet.fillers[0][:3]
                for number, across, up in ((2, x2 - x1, y1 - y2), (3, x3 - x1, y1 - y3)):
                    wanted = [sections[f"p{number}_{axis}_mm"][i] - sections[f"p1_{axis}_mm"][i] for axis in "xy"]
                    self.assertLess(math.dist((across / sheet.scale, up / sheet.scale), wanted), 0.003 / sheet.scale)

    def test_between_the_reported_sections_the_area_is_the_same(self):
        body = examples("grooves")["case-c-oblique-offset"]
        area = self.service.answer("grooves", body)["result"]["filler_area_mm2"]
        for omega in (7.3, 123.45, -200.01):
            self.assertAlmostEqual(self.sheet(body, f"&omega_deg={omega}").areas()[0] / area, 1, delta=DRAWN)

    def test_an_angle_without_its_view_is_refused(self):
        body = examples("grooves")["case-a-right-angle"]
        for query in ("format=svg&omega_deg=3", "format=csv&omega_deg=3", "format=svg&view=section&omega_deg=361"):
            status, _, content = self.service.ask("grooves", body, query)
            self.assertEqual((status // 100, b"?omega_deg" in content), (4, True), query)


if __name__ == "__main__":
    main()
