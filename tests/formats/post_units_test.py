"""Units of a post: programs in inches and with the turn as a length or in revolutions, read back to mm and degrees and held against the same program
in mm; and posts whose own words contradict their units."""

import json
import math
import random
import re
from urllib.parse import quote

from gcode_path_test import ROUNDING, SAMPLES, Torch, distance
from posts_test import ADDRESS, DARK, by_each_axis, linuxcnc, timed
from service import ROOT, FormatTest, examples, main, seam_row

FIELD = ROOT / "tests/field"
INCH = 25.4
CASES = 200
FEEDS = {  # of a move: how a control receives it, and how a reader converts it to minutes
    "F[#<speed_mm_min> / {length_mm}]": None, "F[#<speed_mm_min> / {length}]": None, "F{per_minute}": None,
    "F{linear_units_per_minute}": "path", "{axes_feeds}": by_each_axis}


def field(name):
    return json.loads((FIELD / name).read_text())


def along(straight):
    """A reader of feeds along the path of the axes that go straight, which a turn counted as a length is; without any, of those that turn. Minutes."""
    def minutes(before, at, feed):
        gone, turned = (math.dist([before[w] for w in of], [at[w] for w in of]) for of in ([w for w in at if w in straight], [w for w in at if w not in straight]))
        return (gone or turned) / float(feed[1:])
    return minutes


def degrees_of(turn, diameter):
    """How many degrees one unit of the turn's word is."""
    return {"deg": 1.0, "mm_girth": 360 / (math.pi * diameter), "inch_girth": 360 * INCH / (math.pi * diameter), "revolution": 360.0}[turn]


class Written:
    """How a post writes the axes; `back` undoes it."""

    def __init__(self, post, outer):
        self.mm = INCH if post.get("units") == "inch" else 1.0
        self.axes = post["axes"]
        turn = self.axes["turn"]
        own = ("inch_girth" if self.mm == INCH else "mm_girth") if turn["letter"] in "UVWXYZ" else "deg"
        self.turn = degrees_of(turn.get("unit", own), turn.get("diameter_mm", 2 * outer))

    def back(self, words):
        """{role: mm or deg} of the words of a block."""
        out = {}
        for role, axis in self.axes.items():
            if axis["letter"] not in words:
                continue
            straight = role in ("along", "out", "across")
            unit = self.mm if straight else self.turn if role == "turn" else 1.0
            value = words[axis["letter"]] * unit - axis.get("offset_mm" if straight else "offset_deg", 0.0)
            out[role] = -value if axis.get("reversed") else value
        return out

    def step(self, role):
        """Half the last decimal, mm or deg, and what its own reading rounds."""
        unit = self.mm if role in ("along", "out", "across") else self.turn if role == "turn" else 1.0
        return 0.5000001 * unit * 10.0 ** -self.axes[role]["decimals"] + 1e-9


class PostUnits(FormatTest):
    document = json.loads((ROOT / "posts/linuxcnc.json").read_text())
    inch = document | {"name": "inch", "units": "inch", "modes": ["G20 G40 G49 G90 G94 G17", "G64 P0.0004"]}

    def program(self, endpoint, body, query, post):
        return self.service.text(endpoint, body, f"{query}&post={quote(json.dumps(post))}").decode("ascii")

    def issues(self, body, post, query=DARK):
        status, _, content = self.service.ask("parts", body, f"{query}&post={quote(json.dumps(post))}")
        return status, [(e["pointer"], e["code"]) for e in json.loads(content)["errors"]] if status != 200 else []

    def held(self, text, wanted, minutes, post, outer, minutes_of, near=1e-3):
        """Every block of a program, read back, against those of the program in mm: places to the last decimal, and the time of each move."""
        written = Written(post, outer)
        rapids = []
        for line in text.splitlines():
            if line[:3] in ("G0 ", "G1 "):
                words = {letter: float(value) for letter, value in ADDRESS.findall(line.split(" F")[0]) if letter in "ABCUVWXYZ"}
                rapids.append((line[1] == "0", written.back(words)))
        self.assertEqual(len(rapids), len(wanted))
        for (rapid, got), (plain_rapid, at) in zip(rapids, wanted):
            self.assertEqual((rapid, sorted(got)), (plain_rapid, sorted(at)))
            for role, value in at.items():
                off = got[role] - value
                if role == "turn" and post["axes"]["turn"].get("within_turn"):
                    off = (off + 180) % 360 - 180
                self.assertLessEqual(abs(off), written.step(role) + 2e-5, (role, got, at))
        if minutes_of is None:
            got_minutes = [1 / rate for (rapid, _), rate in zip(linuxcnc(text).moves, linuxcnc(text).rates) if not rapid]
        else:
            girth = "girth" in post["axes"]["turn"].get("unit", "")
            by_the_path = along("XYZUVW" + (post["axes"]["turn"]["letter"] if girth else ""))
            got_minutes = [took for _, took in timed(text, by_the_path if minutes_of == "path" else minutes_of)]
        self.assertEqual(len(got_minutes), len(minutes))
        for got, took in zip(got_minutes, minutes):
            self.assertAlmostEqual(got / took, 1.0, delta=near)

    def plain(self, endpoint, body, query):
        """The program in mm by the shipped post: [(rapid, {role: value} of the block's own words)], minutes of each move."""
        text = self.service.text(endpoint, body, query).decode("ascii")
        written, wanted = Written(self.document, 1.0), []
        for line in text.splitlines():
            if line[:3] in ("G0 ", "G1 "):
                words = {letter: float(value) for letter, value in ADDRESS.findall(line.split(" F")[0]) if letter in "ABCXYZ"}
                wanted.append((line[1] == "0", written.back(words)))
        read = linuxcnc(text)
        return wanted, [1 / rate for (rapid, _), rate in zip(read.moves, read.rates) if not rapid]

    def test_programs_of_every_unit_say_the_same(self):
        """Drawn posts: units, turn, senses, offsets, decimals and feeds."""
        seeded = random.Random(7)
        jobs = []
        for endpoint, name, outer in (("bevel-tables", "mitre", None), ("parts", "tube-laser-chord", None)):
            body = examples(endpoint)[name]
            text = self.service.text(endpoint, body, DARK).decode("ascii")
            outer = float(re.search(r"^\(tube ([\d.]+) x", text, re.M)[1]) / 2
            jobs.append((endpoint, body, outer, *self.plain(endpoint, body, DARK)))
        feeds, turns = 0, set()
        for case in range(CASES):
            endpoint, body, outer, wanted, minutes = jobs[case % len(jobs)]
            units = seeded.choice(("mm", "inch"))
            letter, turn = seeded.choice((("A", None), ("A", "deg"), ("A", "mm_girth"), ("A", "inch_girth"), ("A", "revolution"), ("Y", None), ("Y", "revolution"),
                                          ("Y", "deg"), ("Y", "inch_girth" if units == "inch" else "mm_girth")))
            axes = {"along": {"letter": "X"}, "out": {"letter": "Z"}, "turn": {"letter": letter}, "swing": {"letter": "B"}}
            for role, axis in axes.items():
                axis |= {"decimals": seeded.randint(6, 8), "reversed": seeded.random() < 0.5}
                axis["offset_mm" if role in ("along", "out") else "offset_deg"] = seeded.choice((0, 0, 12.5, -250))
            if turn:
                axes["turn"]["unit"] = turn
            if (turn or "").endswith("girth") and seeded.random() < 0.5:
                axes["turn"]["diameter_mm"] = seeded.choice((100.0, 63.662, 2 * outer))
            feed = seeded.choice(list(FEEDS))
            post = self.document | {"name": "drawn", "units": units, "modes": ["G20 G90 G17" if units == "inch" else "G21 G90 G17"], "axes": axes,
                                    "cut_begin": ["G93"] if FEEDS[feed] is None else ["G94"], "cut_move": f"G1 {{axes}} {feed}"}
            post["mark_on"], post["mark_off"] = ["M64 P0"], ["M65 P0"]
            with self.subTest(case=case, units=units, axes=axes, feed=feed):
                self.held(self.program(endpoint, body, DARK, post), wanted, minutes, post, outer, FEEDS[feed])
            feeds, turns = feeds + (FEEDS[feed] is not None), turns | {(letter, turn)}
        self.assertGreater(feeds, 50)
        self.assertEqual(len(turns), 10)

    def test_feeds_of_all_axes_together(self):
        """One unit of length as one degree, whatever the unit."""
        body = examples("parts")["chord-with-holes"]
        _, minutes = self.plain("parts", body, DARK)
        for units, factor in (("mm", 1.0), ("inch", 1 / INCH)):
            post = self.document | {"name": "own", "units": units, "modes": ["G90"], "cut_begin": ["G94"], "cut_move": "G1 {axes} F{units_per_minute}"}
            before, got = {}, []
            for line in self.program("parts", body, DARK, post).splitlines():
                words = {letter: float(value) for letter, value in ADDRESS.findall(line.split(" F")[0]) if letter in "ABCXYZ"} if line[:3] in ("G0 ", "G1 ") else {}
                if words and line[1] == "1":
                    way = math.dist([words[k] for k in sorted(words)], [before[k] for k in sorted(words)])
                    got.append((way, float(line.split(" F")[1])))
                before = before | words
            self.assertEqual(len(got), len(minutes))
            for (way, feed), took in zip(got, minutes):
                self.assertAlmostEqual(feed, max(way / took, 1e-3 * factor), delta=2e-3 * factor + 1e-3 * feed)

    def test_the_path_is_followed_in_every_unit(self):
        """The whole of every block, by the interpreter of formats.gcode_path, within what the head says in its own unit."""
        body = {"target": {"outer_diameter_mm": 114.3, "wall_mm": 6.3},
                "cutters": [{"kind": "tube", "outer_diameter_mm": 121, "inclination_deg": 60, "clocking_deg": 0, "offset_mm": 0}],
                "root_surface": "inner", "groove": {"rule": "half_dihedral"}, "kerf_mm": 1.5, "smoothing": {"method": "none"}}
        table = self.service.answer("bevel-tables", body)["result"]["points"]
        outer, inner = (seam_row(table["phi_deg"], table[c]) for c in ("torch_outer_mm", "torch_inner_mm"))
        torch = Torch(57.15, 57.15 - 6.3, 200)
        for units, letter, turn, decimals in (("mm", "A", "deg", 5), ("inch", "A", "deg", 5), ("inch", "A", "inch_girth", 6), ("mm", "Y", "mm_girth", 5),
                                              ("mm", "A", "revolution", 8), ("inch", "A", "deg", 4), ("mm", "A", "deg", 3)):
            axes = {"along": {"letter": "X"}, "out": {"letter": "Z"}, "turn": {"letter": letter, "unit": turn}, "swing": {"letter": "B"}}
            for axis in axes.values():
                axis["decimals"] = decimals
            post = self.document | {"name": "own", "units": units, "modes": ["G90"], "axes": axes}
            text = self.program("bevel-tables", body, "format=gcode&speed_mm_min=600&pivot_length_mm=200", post)
            written = Written(post, 57.15)
            said = re.search(r"within ([\d.]+) (mm|in) of straight lines", text)
            bound = float(said[1]) * (INCH if said[2] == "in" else 1.0)
            self.assertEqual(said[2], "in" if units == "inch" else "mm")
            places = []
            for line in text.splitlines():
                if line.startswith("G1 "):
                    at = written.back({a: float(v) for a, v in ADDRESS.findall(line.split(" F")[0])})
                    places.append({"A": at["turn"], "X": at["along"], "Z": at["out"], "B": at["swing"]})
            worst, row = 0.0, 0
            for before, after in zip(places, places[1:]):
                for k in range(1, SAMPLES + 1):
                    at = {axis: before[axis] + (after[axis] - before[axis]) * k / (SAMPLES + 1) for axis in after}
                    on_outer, on_inner, off = torch.edges(at)
                    worst = max(worst, off, *(min(distance(radius, on, rows[i], rows[i + 1]) for i in range(max(0, row - 1), min(row + 3, len(rows) - 1)))
                                              for radius, on, rows in ((torch.outer, on_outer, outer), (torch.inner, on_inner, inner))))
                while row + 2 < len(outer) and after["A"] >= outer[row + 1][0] - 1e-2:
                    row += 1
            self.assertLessEqual(worst, bound + ROUNDING, (units, turn, decimals))

    def test_a_tube_with_corners_turns_in_revolutions_too(self):
        """It has no girth of a circle to count a turn by, but a revolution is an angle."""
        body = {"preset": "tube_laser", "target": {"size": "SHS 60x60x4 EN 10219", "length_mm": 300}, "kerf_mm": 0.3,
                "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                "cutouts": [{"id": "c", "shape": {"kind": "circle", "diameter_mm": 30}, "at": {"z_mm": 150, "face": 1, "offset_mm": 8}}]}
        query = "format=gcode&speed_mm_min=900&lead_mm=2&pivot_length_mm=0"
        wanted, minutes = self.plain("parts", body, query)
        for unit, decimals in (("revolution", 8), ("deg", 5)):
            axes = self.document["axes"] | {"turn": {"letter": "A", "unit": unit, "decimals": decimals}}
            post = self.document | {"name": "own", "axes": axes}
            self.held(self.program("parts", body, query, post), wanted, minutes, post, 30, None)
        for unit in ("mm_girth", "inch_girth"):
            post = self.document | {"name": "own", "axes": self.document["axes"] | {"turn": {"letter": "A", "unit": unit, "decimals": 5}}}
            status, _, content = self.service.ask("parts", body, f"{query}&post={quote(json.dumps(post))}")
            self.assertNotEqual(status, 200)
            self.assertIn("along its circumference", json.loads(content)["errors"][0]["hint"])

    def test_the_head_is_in_the_unit_of_the_post(self):
        body = examples("parts")["chord-with-holes"]
        mm, inch = self.service.text("parts", body, DARK).decode(), self.program("parts", body, DARK, self.inch)
        self.assertIn("(units inch, deg, inch/min)", inch)
        self.assertIn("(feed 23.62 in/min on the outer wall)", inch)
        number = re.compile(r"(?<![\w.#-])(-?\d+(?:\.\d+)?) (mm|in)\b")
        comments = [[line for line in text.splitlines() if line.startswith("(")] for text in (mm, inch)]
        self.assertEqual(*map(len, comments))
        count = 0
        for ours, theirs in zip(*comments):
            if "verdict" in ours or ours.startswith("(review") or "post" in ours:
                continue  # quotes the answer
            a, b = number.findall(ours), number.findall(theirs)
            self.assertEqual(len(a), len(b), (ours, theirs))
            for (value, _), (said, unit) in zip(a, b):
                self.assertEqual(unit, "in", theirs)
                self.assertAlmostEqual(float(said) * INCH, float(value), delta=0.0052 + 0.13 * ("feed" in ours) + 1e-3 * ("moves" in ours))
                count += 1
        self.assertGreater(count, 15)
        girth = self.document | {"name": "girth", "axes": self.document["axes"] | {"turn": {"letter": "A", "decimals": 4, "unit": "mm_girth"}}}
        self.assertRegex(self.program("parts", body, DARK, girth), r"\(A counts mm of circumference of a diameter of [\d.]+ mm, a turn is [\d.]+\)")

    def test_a_schedule_in_inches(self):
        body = examples("pulse-schedules")["square-cut-from-a-bare-contour"]
        mm, inch = (linuxcnc(self.program("pulse-schedules", body, "format=gcode", post)) for post in (self.document, self.inch))
        self.assertEqual(len(mm.moves), len(inch.moves))
        for (rapid, at), (inch_rapid, got), rate, inch_rate in zip(mm.moves, inch.moves, mm.rates, inch.rates):
            self.assertEqual((rapid, rate, sorted(at)), (inch_rapid, inch_rate, sorted(got)))
            for letter, value in at.items():
                self.assertAlmostEqual(got[letter] * (INCH if letter in "XYZUVW" else 1.0), value, delta=2e-6)
        girth = self.document | {"name": "girth", "axes": self.document["axes"] | {"turn": {"letter": "A", "decimals": 4, "unit": "mm_girth"}}}
        status, _, content = self.service.ask("pulse-schedules", body, f"format=gcode&post={quote(json.dumps(girth))}")
        self.assertEqual((status, json.loads(content)["errors"][0]["pointer"]), (422, "?post"))

    def test_words_that_contradict_the_units(self):
        body = field("hole-30-in-60.part.json")
        for line in ("G20", "G20 G90", "g20", "N10G20G90", "G 20", "G020", "G20.0", "G90 (mm) G70", "G700", "BEGIN PGM TUBE INCH"):
            for units in ({}, {"units": "mm"}):
                for name in ("begin", "modes", "tool", "cut_begin", "end", "torch_off"):
                    post = self.document | units | {"name": "own", name: ["G90", line]}
                    if not units:
                        post.pop("units")
                    self.assertEqual(self.issues(body, post), (400, [(f"?post/{name}/1", "unsupported_combination")]), (line, units))
        for line in ("G21", "G71", "G710", "G90G21", "BEGIN PGM TUBE MM"):
            self.assertEqual(self.issues(body, self.inch | {"modes": [line]}), (400, [("?post/modes/0", "unsupported_combination")]), line)
        self.assertEqual(self.issues(body, self.document | {"name": "own", "rapid": "G20 G0 {axes}"})[1], [("?post/rapid", "unsupported_combination")])
        for line in ("(G20)", "G90 (was G20) G17", "G90 ; G20", "G200", "G2 X0", "MSG(\"G20\")", "#<G20> = 1", "ORIG20", "G20.1", "G17 X20"):
            self.assertEqual(self.issues(body, self.document | {"name": "own", "tool": [line]})[0], 200, line)
        for axis, code in (({"letter": "Y", "decimals": 4, "unit": "inch_girth"}, ("?post/axes/turn/unit", "unsupported_combination")),
                           ({"letter": "A", "decimals": 4, "unit": "degree"}, ("?post/axes/turn/unit", "bad_choice")),
                           ({"letter": "A", "decimals": 4, "diameter_mm": 50}, ("?post/axes/turn/diameter_mm", "unsupported_combination")),
                           ({"letter": "A", "decimals": 3, "unit": "revolution"}, ("?post/axes/turn/decimals", "out_of_range"))):
            status, issues = self.issues(body, self.document | {"name": "own", "axes": {"along": {"letter": "X", "decimals": 4}, "turn": axis}})
            self.assertEqual((status, issues[:1]), (400, [code]))
        self.assertEqual(self.issues(body, self.document | {"units": "inches"})[1][:1], [("?post/units", "bad_choice")])
        coarse = self.inch | {"axes": self.document["axes"] | {"along": {"letter": "X", "decimals": 2}}}
        self.assertEqual(self.issues(body, coarse)[1], [("?post/axes/along/decimals", "out_of_range")])

    def test_posts_of_the_field(self):
        """A control that counts inches, whose post did not say so; a rotary axis on a letter that counts lengths."""
        body, query = field("hole-30-in-60.part.json"), "format=gcode&speed_mm_min=600"
        control = field("inch-control.post.json")
        self.assertEqual(self.issues(body, control, query), (400, [("?post/modes/0", "unsupported_combination")]))
        wanted, minutes = self.plain("parts", body, query)
        stated = control | {"units": "inch"}
        self.held(self.program("parts", body, query, stated), wanted, minutes, stated, 30.15, None)
        rotary = field("rotary-on-y.post.json")
        text = self.program("parts", body, query, rotary)
        self.held(text, wanted, minutes, rotary, 30.15, None)
        self.assertIn("(Y counts mm of circumference of a diameter of 60.3 mm, a turn is 189.4380)", text)
        shelf = json.loads(self.service.get("/v1/posts"))["posts"]
        self.assertEqual({p["post"].get("units") for p in shelf if p["name"] != "point_pairs"}, {"mm"})


if __name__ == "__main__":
    main()
