"""Tabs and marks in programs: a reader of its own finds every bridge as wide as asked on both walls, everything else cut, and the strokes where the
answer has the marks."""

import json
import math
import re
import urllib.parse

import lands_test
import leads_test
import torch_program
from service import FormatTest, cutout_name, cutouts, examples, main

WIDTH, COUNT, MARK_SPEED = 2.5, 3, 3000.0
TABS = leads_test.LIT | {"tabs": COUNT, "tab_mm": WIDTH, "tabs_of": "all"}
MARKS = leads_test.LIT | {"marks": "on", "mark_speed_mm_min": MARK_SPEED}
CROSS = 5.0  # mm, of an arm


def codes_of(answer):
    return ",".join(sorted({w["code"] for w in answer["warnings"] if w["severity"] == "cut"})) or None


def tube(program):
    """(outer radius, wall) that the program says"""
    diameter, wall = map(float, re.search(r"^\(tube ([\d.]+) x ([\d.]+) mm\)$", program, re.M).groups())
    return diameter / 2, wall


def gap(line, before, after, deep):
    """Of every place of either to the other, mm, on the outer wall or where the beam comes out of the inner one."""
    girth = 2 * math.pi * (line.inner if deep else line.outer)
    one, other = ([line.flat((p.phi, p.z, p.b, p.a), deep) for p in places] for places in (before, after))

    def near(points, way):
        return min(leads_test.distance((x - girth * round((x - way[0][0]) / girth), y), way) for x, y in points)
    return min(near(one, other), near(other, one))


def check_stretches(stretches, line, width, kerf, near=2e-4):
    """Of one cut with tabs: lit from pierce to tab, on its line, its way in clear of the part; each tab as wide as asked, and all else cut
    once. The least width, mm."""
    covered, least = 0.0, math.inf
    for cut, after in zip(stretches, stretches[1:] + stretches[:1]):
        first = leads_test.joins(cut)
        if not cut.lit or cut.dark:
            raise torch_program.Fault(f"{cut.name} is not lit from pierce to tab")
        places = [(p.phi, p.z, p.b, p.a) for p in cut.places]
        off = max(map(line.off, places[first:]))
        if off > 1e-3:
            raise torch_program.Fault(f"{cut.name} is {off:.2e} mm off its line")
        if max(map(line.into_part, places[:first])) > leads_test.TOUCH or line.into_part(places[0]) > -0.2 * torch_program.SHORTEST:
            raise torch_program.Fault(f"{cut.name}: its way in is not clear of the part")
        flat = [line.flat(at, False) for at in places[first:]]
        covered += sum(math.dist(a, b) for a, b in zip(flat, flat[1:]))
        left = min(gap(line, cut.places[first:][-12:], after.places[:leads_test.joins(after) + 12], deep) for deep in (False, True)) - kerf
        if left < width - near:
            raise torch_program.Fault(f"{cut.name}: a tab of {left:.4f} mm")
        least = min(least, left)
    missing, count = line.length - covered, len(stretches)
    if not count * (width + kerf) - 5 * near < missing < count * 2.5 * (width + kerf):
        raise torch_program.Fault(f"{stretches[0].name}: {missing:.3f} mm are not cut")
    return least


class Tabs(FormatTest):
    def program(self, name, options, endpoint="parts", **more):
        body = examples(endpoint)[name]
        answer = self.service.answer(endpoint, body)
        text = self.service.text(endpoint, body, leads_test.query(options, acknowledge=codes_of(answer) if options.get("torch") == "on" else None, **more)).decode("ascii")
        return body, answer, text

    def replayed(self, text):
        cuts = torch_program.replay(text, tube(text)[0], leads_test.PIVOT)
        torch_program.check_heights([cut for cut in cuts if not cut.mark], leads_test.PIERCE, leads_test.HEIGHT)
        return cuts

    def refused(self, name, options):
        status, _, content = self.service.ask("parts", examples("parts")[name], leads_test.query(options))
        self.assertIn(status, (400, 422), content[:200])
        return [(e["pointer"], e["code"]) for e in json.loads(content)["errors"]]

    def stretches_of(self, step, result, cuts):
        name = step["what"]
        if name == "hole":
            name = f"hole {step['index']}"
        if name == "cutout":
            name = cutout_name(*cutouts(result)[step["index"]])
        own = [cut for cut in cuts if cut.name == name or cut.name.startswith((name + ",", name + " "))]
        return [cut for cut in own if not cut.name.startswith(f"{name} far")]  # the same shape in the other wall

    def test_every_tab_holds_and_all_else_is_cut(self):
        """Ends and holes of every example. A tab: from each place of the last millimetres of a stretch to each of the way in and the first of
        the next, on both walls. Cut: every place of the torch line that is no tab, once."""
        looked, narrow = 0, math.inf
        for name in examples("parts"):
            body = examples("parts")[name]
            answer = self.service.answer("parts", body)
            result = answer["result"]
            asked = leads_test.query(TABS, acknowledge=codes_of(answer))
            status, _, content = self.service.ask("parts", body, asked)
            if status != 200:  # a tube laser's square holes leave no room for its tabs, or no lead
                self.assertIn("?tab", json.loads(content)["errors"][0]["pointer"], name)
                continue
            cuts = self.replayed(content.decode("ascii"))
            outer, wall = tube(content.decode("ascii"))
            kerf = body.get("kerf_mm", 0.0)
            for step in [step for step in result["sequence"] if step["what"] != "mark"]:
                line = leads_test.Line(result, step, outer, wall)
                stretches = self.stretches_of(step, result, cuts)
                self.assertEqual([cut.name.rsplit(", ", 1)[-1] for cut in stretches], [f"{k + 1} of {COUNT}" for k in range(COUNT)], name)
                least = check_stretches(stretches, line, WIDTH, kerf)
                narrow, looked = min(narrow, least), looked + 1
        self.assertGreater(looked, 10)
        self.assertLess(narrow, WIDTH + 1e-3)

    def test_only_the_last_cut_has_them_where_nothing_is_said(self):
        _, _, text = self.program("chord-with-holes", TABS, tabs_of="last")
        body, _, plain = self.program("chord-with-holes", leads_test.LIT)
        names, before = ([cut.name for cut in self.replayed(program)] for program in (text, plain))
        self.assertEqual(names, before[:-1] + [f"{before[-1]}, {k + 1} of {COUNT}" for k in range(COUNT)])
        without = {name: value for name, value in TABS.items() if name not in ("tabs_of", "tab_mm")}
        _, _, text = self.program("chord-with-holes", without)
        self.assertIn("(tabs: 3 of 2 mm and more on both walls in each of 1 cut, each come onto square and without overcut: "
                      "break them off, then dress the edge)", text)

    def test_a_table_has_tabs_too(self):
        body, _, text = self.program("source-000-table-1", TABS, "bevel-tables", tabs_of=None)
        self.assertEqual([cut.name for cut in self.replayed(text)], [f"{k + 1} of {COUNT}" for k in range(COUNT)])

    def test_point_pairs_have_the_same_stretches(self):
        options = {name: value for name, value in TABS.items() if name != "pivot_length_mm"}
        _, _, text = self.program("set-in-branch", options, post="point_pairs")
        _, _, blocks = self.program("set-in-branch", TABS)
        printed = [line[len("(cut: "):-1] for line in blocks.splitlines() if line.startswith("(cut: ")]
        self.assertEqual([cut["name"] for cut in json.loads(text)["cuts"]], printed)

    def test_marks_are_drawn_where_the_answer_has_them(self):
        for name, post, off, pierce in (("chord-with-holes", None, leads_test.HEIGHT, True), ("k-joint-brace", None, leads_test.HEIGHT, True),
                                        ("chord-with-holes", "qtplasmac", 0.0, False)):
            with self.subTest(name, post=post):
                options = MARKS if pierce else {k: v for k, v in MARKS.items() if not k.startswith(("pierce_", "cut_height"))}
                body, answer, text = self.program(name, options, post=post)
                outer, _ = tube(text)
                cuts = torch_program.replay(text, outer, leads_test.PIVOT)
                strokes = [cut for cut in cuts if cut.mark]
                self.assertEqual(cuts[:len(strokes)], strokes)
                wanted = []
                for mark in answer["result"]["marks"]:
                    phi, low, high = mark["phi_deg"], mark["z_from_mm"], mark["z_to_mm"]
                    if mark["kind"] == "part_mark":
                        self.assertIn(f"(mark by hand: the name {mark['text']} ", text)
                    elif high > low:
                        wanted.append(((phi, low), (phi, high)))
                    else:
                        turned = math.degrees(CROSS / outer)
                        wanted += [((phi, low - CROSS), (phi, low + CROSS)), ((phi - turned, low), (phi + turned, low))]
                self.assertEqual(text.count("mark by hand"), 1)
                self.assertEqual(len(strokes), len(wanted))
                for stroke, ends in zip(strokes, wanted):
                    self.assertTrue(stroke.lit and not stroke.dark and stroke.dwell == 0.0, stroke.name)
                    for place, (phi, z) in zip((stroke.places[0], stroke.places[-1]), ends):
                        self.assertAlmostEqual(place.phi, phi, delta=1e-6)
                        self.assertAlmostEqual(place.z, z, delta=2e-5)
                    for place in stroke.places:
                        self.assertAlmostEqual(place.off, off, delta=2e-5)
                        self.assertEqual(place.b, 0.0)
                    length = math.dist(*[(math.radians(phi) * outer, z) for phi, z in ends])
                    self.assertAlmostEqual(sum(stroke.lengths) * MARK_SPEED, length, delta=1e-4 * length)
                self.assertIn(f"feed {MARK_SPEED:g} mm/min", text)
                plain = self.program(name, {k: v for k, v in options.items() if not k.startswith("mark")}, post=post)[2]
                self.assertEqual(text[text.index("(cut: "):], plain[plain.index("(cut: "):])

    def test_a_dry_run_marks_nothing(self):
        _, _, text = self.program("chord-with-holes", MARKS, torch="off")
        self.assertNotIn("M64", text)
        self.assertNotIn("M3 ", text)
        self.assertIn(", the tool stays off)", text)

    def test_what_cannot_be(self):
        for options, pointer, code in (
                ({"tab_mm": 2}, "?tab_mm", "unsupported_combination"), ({"tabs_of": "all"}, "?tabs_of", "unsupported_combination"),
                ({"tabs": 0}, "?tabs", "out_of_range"), ({"tabs": 13}, "?tabs", "out_of_range"), ({"tabs": 2.5}, "?tabs", "not_an_integer"),
                ({"tabs": 2, "tab_mm": 0.4}, "?tab_mm", "out_of_range"), ({"tabs": 2, "tabs_of": "start"}, "?tabs_of", "bad_choice"),
                ({"tabs": 2, "tabs_of": "holes"}, "?tabs_of", "unsupported_combination"), ({"tabs": 12, "tab_mm": 20}, "?tabs", "unsupported_combination"),
                ({"mark_speed_mm_min": 100}, "?mark_speed_mm_min", "unsupported_combination"),
                ({"marks": "on", "post": "fanuc_style"}, "?marks", "unsupported_combination"), ({"marks": "true"}, "?marks", "wrong_type")):
            with self.subTest(options):
                self.assertEqual(self.refused("set-in-branch", leads_test.LIT | options), [(pointer, code)])
        asked = leads_test.query(leads_test.LIT, torch="off", tabs=2, passes="both")
        status, _, content = self.service.ask("bevel-tables", lands_test.SADDLE, asked)
        self.assertEqual((status, json.loads(content)["errors"][0]["pointer"]), (422, "?tabs"))
        status, _, content = self.service.ask("bevel-tables", examples("bevel-tables")["source-000-table-1"], leads_test.query(leads_test.LIT, marks="on"))
        self.assertIn((status, json.loads(content)["errors"][0]["pointer"]), [(400, "?marks"), (422, "?marks"), (422, "?acknowledge")])


class Posts(FormatTest):
    def test_a_marking_tool_is_switched_on_and_off(self):
        posts = {p["name"]: p["post"] for p in json.loads(self.service.get("/v1/posts"))["posts"]}
        for name, other in (("mark_on", "mark_off"), ("mark_off", "mark_on")):
            half = {key: value for key, value in posts["linuxcnc"].items() if key != other} | {"name": "half"}
            query = leads_test.query(leads_test.LIT, torch="off") + "&post=" + urllib.parse.quote(json.dumps(half))
            status, _, content = self.service.ask("parts", examples("parts")["set-in-branch"], query)
            self.assertEqual(status, 400, content[:300])
            self.assertEqual([(e["pointer"], e["code"]) for e in json.loads(content)["errors"]], [(f"?post/{other}", "missing_field")], name)


if __name__ == "__main__":
    main()
