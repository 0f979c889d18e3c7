"""Posts: one path in the words of every control, read by readers of their own, and what no post may say."""

import json
import math
import pathlib
import re
import signal
import subprocess
import tempfile
import time
from urllib.parse import quote

from service import ROOT, FormatTest, Service, examples, main

SPEED = 600.0
LIT = ("format=gcode&speed_mm_min=600&torch=on&lead_mm=3&pivot_length_mm=150&pierce_height_mm=4&pierce_delay_s=0.4&cut_height_mm=2&acknowledge=" +
       "free_end")
DARK = "format=gcode&speed_mm_min=600&lead_mm=3&pivot_length_mm=150&pierce_height_mm=4&cut_height_mm=2"
SHIPPED = ("linuxcnc", "qtplasmac", "fanuc_style", "siemens_style", "point_pairs")
ADDRESS = re.compile(r"([A-Z])(-?\d+(?:\.\d*)?)")
HOSTILE = "x)(M3 S1; M30 %\\"


class Program:
    """The moves of a program: [(kind, axes after it, minutes)], and what switches."""

    def __init__(self):
        self.moves, self.switches, self.dwells, self.at, self.rates = [], [], [], {}, []

    def move(self, rapid, axes, rate):
        self.at = self.at | axes
        self.moves.append((rapid, dict(self.at)))
        self.rates.append(rate)


def linuxcnc(text):
    """Numbers, parameters and one division; by the words that rs274 knows."""
    out, parameters = Program(), {}
    for line in text.splitlines():
        if line == "%" or line.startswith("("):
            continue
        given = re.fullmatch(r"#<(\w+)> = ([\d.]+)", line)
        if given:
            parameters[given[1]] = float(given[2])
            continue
        rate = re.search(r" F\[#<(\w+)> / ([\d.]+)\]$", line)
        words = ADDRESS.findall(line[:rate.start()] if rate else line)
        plain = [float(value) for letter, value in words if letter == "F"]
        read(out, words, parameters[rate[1]] / float(rate[2]) if rate else plain[0] if plain else None)
    return out


def fanuc(text):
    """%, O and a number, then blocks N..., comments between brackets in capitals alone."""
    lines = text.splitlines()
    assert lines[0] == lines[-1] == "%" and re.fullmatch(r"O\d{4}", lines[1]), lines[:2]
    return blocks(lines[2:-1], lambda line: re.fullmatch(r"\([^()a-z]*\)", line))


def siemens(text):
    """Blocks N..., comments from a semicolon to the end of the line."""
    return blocks(text.splitlines(), lambda line: line.startswith(";"))


def blocks(lines, is_comment):
    out, last = Program(), 0
    for line in lines:
        if is_comment(line):
            continue
        block = re.fullmatch(r"N(\d+)((?: [A-Z]-?\d+(?:\.\d*)?)+)", line)
        assert block and int(block[1]) > last, line
        last = int(block[1])
        words = ADDRESS.findall(block[2])
        rate = [float(value) for letter, value in words if letter == "F"]
        if ("G", "4") in words or ("G", "04") in words:  # G4 F, G04 X: a time
            out.dwells.append(float(words[-1][1]))
            continue
        read(out, [word for word in words if word[0] != "F"], rate[0] if rate else None)
    return out


def read(out, words, rate):
    codes = [(letter, float(value)) for letter, value in words]
    axes = {letter: value for letter, value in codes if letter in "ABCUVWXYZ"}
    if ("G", 4.0) in codes:
        out.dwells.append(dict(codes)["P"])
    elif axes:
        assert ("G", 0.0) in codes or ("G", 1.0) in codes, words
        out.move(("G", 0.0) in codes, axes, rate)
    out.switches += [(value, len(out.moves)) for letter, value in codes if letter == "M" and value in (3.0, 5.0)]


def by_the_path(before, at, feed):
    """RS-274 in G94: mm/min along X, Y, Z, or where none of them moves deg/min of A, B, C. Minutes."""
    straight, turned = (math.dist([before[w] for w in of if w in at], [at[w] for w in of if w in at]) for of in ("XYZUVW", "ABC"))
    return (straight or turned) / float(feed[1:])


def by_each_axis(before, at, feeds):
    """Every axis that moves at its own feed, FX and a number; all arrive together. Minutes."""
    rates = {word[1]: float(word[2:]) for word in feeds.split()}
    moved = {letter: abs(at[letter] - before[letter]) for letter in at if at[letter] != before[letter]}
    assert moved.keys() == rates.keys(), (moved, rates)
    minutes = [moved[letter] / rates[letter] for letter in moved]
    assert max(minutes) <= min(minutes) * 1.001, (moved, rates)
    return max(minutes)


def timed(program, minutes_of):
    """[(axes, minutes)] of each G1."""
    out, at = [], {}
    for line in program.splitlines():
        block, _, feed = line.partition(" F")
        words = {w: float(v) for w, v in ADDRESS.findall(block) if w in "ABCXYZUVW"}
        if block[:3] not in ("G0 ", "G1 ") or not words:
            continue
        before, at = at, at | words
        if block[1] == "1":
            out.append((at, minutes_of(before, at, "F" + feed)))
    return out


READERS = {"linuxcnc": linuxcnc, "qtplasmac": linuxcnc, "fanuc_style": fanuc, "siemens_style": siemens}


class Posts(FormatTest):
    def shelf(self):
        return {entry["name"]: entry["post"] for entry in json.loads(self.service.get("/v1/posts"))["posts"]}

    def test_what_is_shipped(self):
        shelf = self.shelf()
        self.assertEqual(tuple(shelf), SHIPPED)
        for name, post in shelf.items():
            self.assertTrue(post["checked_with"] and post["not_checked"], name)
            document = json.loads((ROOT / "posts" / f"{name}.json").read_text())
            self.assertEqual({key: post[key] for key in document if key != "axes"}, {key: document[key] for key in document if key != "axes"})
        version = json.loads(self.service.get("/v1/version"))
        self.assertEqual([post["name"] for post in version["posts"]], list(SHIPPED))

    def test_a_dialect_is_the_post_of_its_name(self):
        body = examples("bevel-tables")["mitre"]
        for name in ("linuxcnc", "qtplasmac"):
            of = {query: self.service.text("bevel-tables", body, f"format=gcode&speed_mm_min=600&{query}={name}") for query in ("dialect", "post")}
            self.assertEqual(of["dialect"], of["post"])

    def test_one_path_in_the_words_of_each(self):
        count = 0
        for endpoint, name in (("bevel-tables", "mitre"), ("parts", "chord-with-holes"), ("parts", "k-joint-brace")):
            body = examples(endpoint)[name] | {"reference": {"part": HOSTILE, "order": HOSTILE}}
            wanted = linuxcnc(self.service.text(endpoint, body, DARK).decode())
            self.assertGreater(len(wanted.moves), 50)
            for post in ("fanuc_style", "siemens_style"):
                with self.subTest(f"{name} {post}"):
                    near = 0.6 * 10.0 ** -self.shelf()[post]["axes"]["along"]["decimals"]
                    got = READERS[post](self.service.text(endpoint, body, f"{DARK}&post={post}").decode())
                    self.assertEqual(len(got.moves), len(wanted.moves))
                    self.assertEqual(got.switches, wanted.switches)
                    for (rapid, at), (wanted_rapid, wanted_at), rate, wanted_rate in zip(got.moves, wanted.moves, got.rates, wanted.rates):
                        self.assertEqual((rapid, sorted(at)), (wanted_rapid, sorted(wanted_at)))
                        self.assertLessEqual(max(abs(at[letter] - wanted_at[letter]) for letter in at), near)
                        if not rapid:
                            self.assertAlmostEqual(rate / wanted_rate, 1.0, delta=1e-5)  # lengths have six decimals
                    count += 1
        self.assertEqual(count, 6)

    def test_the_torch_and_its_delay(self):
        body = examples("bevel-tables")["mitre"]
        status, _, content = self.service.ask("bevel-tables", body, LIT.replace("&acknowledge=free_end", ""))
        self.assertEqual(status, 200, content[:300])
        for name in ("linuxcnc", "fanuc_style", "siemens_style"):
            got = READERS[name](self.service.text("bevel-tables", body, LIT.replace("&acknowledge=free_end", "") + f"&post={name}").decode())
            self.assertEqual([value for value, _ in got.switches], [3.0, 5.0], name)
            self.assertEqual(got.dwells, [0.4], name)
            lit_from, lit_to = (after for _, after in got.switches)
            self.assertEqual({rapid for rapid, _ in got.moves[lit_from:lit_to]}, {False})
            self.assertEqual({rapid for rapid, _ in got.moves[:lit_from] + got.moves[lit_to:]}, {True})

    def test_a_schedule_in_the_words_of_each(self):
        body = examples("pulse-schedules")["square-cut-from-a-bare-contour"]
        wanted = None
        for name in ("linuxcnc", "fanuc_style", "siemens_style"):
            text = self.service.text("pulse-schedules", body, f"format=gcode&post={name}").decode()
            got = READERS[name](text)
            wanted = wanted or got
            self.assertEqual((got.moves, got.rates), (wanted.moves, wanted.rates), name)
        self.assertGreater(len(wanted.moves), 10)


class Own(FormatTest):
    """Posts of a folder."""

    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.place.name)
        cls.document = json.loads((ROOT / "posts/linuxcnc.json").read_text())
        cls.turned = cls.document | {"name": "turned", "cut_move": "G1 {axes} F{units_per_minute}", "cut_begin": ["G94"], "axes": cls.document["axes"] | {
            "along": {"letter": "X", "decimals": 6, "reversed": True, "offset_mm": 1000.5}, "turn": {"letter": "C", "decimals": 8, "offset_deg": 90},
            "tilt": {"letter": "A", "decimals": 8, "reversed": True}}}
        cls.plain = cls.document | {"name": "three_axes", "axes": {role: cls.document["axes"][role] for role in ("along", "turn", "swing")}}
        cls.mirrored = cls.document | {"name": "mirrored", "axes": cls.document["axes"] | {
            role: cls.document["axes"][role] | {"reversed": True} for role in ("turn", "swing", "along")}}
        for post in (cls.turned, cls.plain, cls.mirrored):
            (cls.folder / f"{post['name']}.json").write_text(json.dumps(post))
        cls.service = Service(FormatTest.binary, "--posts", str(cls.folder))

    @classmethod
    def tearDownClass(cls):
        cls.service.stop()
        cls.place.cleanup()

    def test_signs_offsets_letters_and_feeds(self):
        body = examples("parts")["chord-with-holes"]
        wanted = linuxcnc(self.service.text("parts", body, DARK).decode())
        text = self.service.text("parts", body, f"{DARK}&post=turned").decode()
        self.assertIn("(X1000.5: the long point of the start, z 0, -X: from the start to the finish)", text)
        self.assertIn("(C90: the datum line, phi 0, under the torch, growing C turns the tube counter-clockwise, seen from the start)", text)
        got, before = Program(), None
        for line in text.splitlines():
            if line[:2] in ("G0", "G1") and ADDRESS.findall(line)[1:]:
                words = dict(ADDRESS.findall(line))
                got.move(words["G"] == "0", {letter: float(value) for letter, value in words.items() if letter in "ABCXYZ"}, float(words.get("F", 0)))
        self.assertEqual(len(got.moves), len(wanted.moves))
        for (rapid, at), (_, plain), rate, inverse in zip(got.moves, wanted.moves, got.rates, wanted.rates):
            back = {"X": 1000.5 - at["X"], "A": at["C"] - 90.0, "B": at["B"], "Z": at["Z"]} if "X" in at else {"Z": at["Z"]}
            for letter, value in back.items():
                self.assertAlmostEqual(value, plain[letter], delta=2e-5)
            if "C" in plain:
                self.assertAlmostEqual(-at["A"], plain["C"], delta=2e-5)
            if not rapid:
                way = math.dist([at[letter] for letter in sorted(at)], [before[letter] for letter in sorted(at)])
                self.assertAlmostEqual(rate, max(way * inverse, 1e-3), delta=2e-3 + 1e-3 * rate)
            before = at

    def test_a_feed_by_the_path_and_by_each_axis(self):
        """The same path in the same time, every block of it, whatever the control counts a feed by."""
        turning = 0
        for endpoint, name, query in (("bevel-tables", "mitre", DARK), ("parts", "chord-with-holes", DARK), ("parts", "tube-laser-chord", DARK),
                                      ("pulse-schedules", "square-cut-from-a-bare-contour", "format=gcode")):
            body = examples(endpoint)[name]
            plain = linuxcnc(self.service.text(endpoint, body, query).decode())
            wanted = [(at, 1 / rate) for (rapid, at), rate in zip(plain.moves, plain.rates) if not rapid]
            self.assertGreater(len(wanted), 10)
            for value, minutes_of in (("F{linear_units_per_minute}", by_the_path), ("{axes_feeds}", by_each_axis)):
                post = self.document | {"name": "own", "cut_begin": ["G94"], "cut_move": f"G1 {{axes}} {value}", "timed_move": f"G1 {{axes}} {value}"}
                got = timed(self.service.text(endpoint, body, f"{query}&post={quote(json.dumps(post))}").decode(), minutes_of)
                with self.subTest(f"{name} {value}"):
                    self.assertEqual(len(got), len(wanted))
                    for (at, minutes), (plain_at, plain_minutes) in zip(got, wanted):
                        self.assertEqual(at, plain_at)
                        self.assertAlmostEqual(minutes / plain_minutes, 1, delta=1e-3)
            turning += sum(a["X"] == b["X"] and a["A"] != b["A"] for (a, _), (b, _) in zip(wanted, wanted[1:]) if "X" in a and "A" in a)
        self.assertGreater(turning, 10)  # blocks that go by deg/min

    def test_feeds_by_axes_of_a_turn_that_starts_again(self):
        """Over 360 the turn goes the short way, and so its feed."""
        body = examples("parts")["chord-with-holes"]
        plain = linuxcnc(self.service.text("parts", body, DARK).decode())
        wanted = [1 / rate for (rapid, _), rate in zip(plain.moves, plain.rates) if not rapid]
        rolling = self.document | {"name": "rolling", "cut_move": "G1 {axes} {axes_feeds}", "axes": self.document["axes"] | {
            "turn": {"letter": "A", "decimals": 7, "within_turn": True, "offset_deg": 350}}}

        def short_way(before, at, feeds):
            over = (at["A"] - before["A"] + 180) % 360 - 180
            return by_each_axis(before, at | {"A": round(before["A"] + over, 7) if over else before["A"]}, feeds)
        got = timed(self.service.text("parts", body, f"{DARK}&post={quote(json.dumps(rolling))}").decode(), short_way)
        self.assertEqual(len(got), len(wanted))
        for (_, minutes), plain_minutes in zip(got, wanted):
            self.assertAlmostEqual(minutes / plain_minutes, 1, delta=1e-3)

    def named(self, template, reference, endpoint="bevel-tables", example="mitre", query=DARK):
        """The file name that an answer says."""
        body = examples(endpoint)[example] | ({"reference": reference} if reference else {})
        post = quote(json.dumps(self.document | {"name": "own", "file_name": template}))
        status, headers, content = self.service.reply(endpoint, json.dumps(body).encode(), f"{query}&post={post}")
        self.assertEqual(status, 200, content[:300])
        found = re.fullmatch(r'attachment; filename="([A-Za-z0-9._-]{1,200})"', headers["Content-Disposition"])
        self.assertTrue(found, headers["Content-Disposition"])
        return found[1], headers

    def test_a_file_name(self):
        said = {"part": "T 1/2", "revision": "B", "order": "4711", "drawing": "Träger"}
        name, headers = self.named("{order}-{part}.{revision}.{cut}.{input}.ngc", said)
        self.assertEqual(name, f"4711-T_1_2.B.cut.{headers['Tubecut-Input-Sha256'][:8]}.ngc")
        self.assertEqual(self.named("{reference}.nc", said)[0], "4711_Traeger_T_1_2_B.nc")
        self.assertEqual(self.named("{part}-{revision}.nc", None)[0], "none-none.nc")
        self.assertEqual(self.named("{cut}.nc", None, "parts", "chord-with-holes")[0], "part.nc")
        self.assertEqual(self.named("{cut}.nc", None, "pulse-schedules", "square-cut-from-a-bare-contour", "format=gcode")[0], "schedule.nc")
        for part, wanted in (("con", "_con.nc"), ("COM1", "_COM1.nc"), ("..", "_..nc"), ("-rf", "_rf.nc"), ('a";b', "a__b.nc"),
                             (HOSTILE, "x__M3_S1__M30___.nc"), ("%2e%2e/", "_2e_2e_.nc")):
            self.assertEqual(self.named("{part}.nc", {"part": part})[0], wanted, part)
        for i in range(1, 65):
            name, _ = self.named("{part}{revision}{order}{drawing}{reference}.ngc", dict.fromkeys(said, "x" * i))
            self.assertTrue(name.endswith(".ngc"))
        _, headers, _ = self.service.reply("bevel-tables", json.dumps(examples("bevel-tables")["mitre"]).encode(), DARK)
        self.assertNotIn("Content-Disposition", headers)

    def test_a_post_within_the_request(self):
        body = examples("parts")["chord-with-holes"]
        sent = quote(json.dumps(self.turned))
        self.assertEqual(self.service.text("parts", body, f"{DARK}&post={sent}"), self.service.text("parts", body, f"{DARK}&post=turned"))
        axes = self.document["axes"]
        for name, code in (("{parts}.ngc", "bad_choice"), ("../{part}.ngc", "bad_text"), ("a b", "bad_text"), (".{part}", "bad_text"), ("{part", "bad_text"),
                           ("{part}{part}", "duplicate_id"), ("{axes}", "bad_choice"), ("é", "bad_text"), ('a"b', "bad_text")):
            status, _, content = self.service.ask("parts", body, f"{DARK}&post={quote(json.dumps(self.document | {'file_name': name}))}")
            self.assertEqual((status, *[json.loads(content)["errors"][0][key] for key in ("pointer", "code")]), (400, "?post/file_name", code), name)
        for changes, wanted in (({"rapids": "G0"}, [("?post/rapids", "unknown_field")]), ({"rapid": "G0 {axis}"}, [("?post/rapid", "bad_choice")] * 1),
                                ({"rapid": "G0 {axes} {axes}"}, [("?post/rapid", "duplicate_id")]),
                                ({"axes": axes | {"turn": {"letter": "F", "decimals": 4}}}, [("?post/axes/turn/letter", "bad_choice")]),
                                ({"cut_move": "G1 {axes} F{feed}"}, [("?post/cut_move", "bad_choice")]), ({"cut_move": "G1 {axes_feeds}"}, [("?post/cut_move", "bad_text")]),
                                ({"rapid": "G0 {axes} {axes_feeds}"}, [("?post/rapid", "bad_choice")]), ({"kind": "blocs"}, [("?post/kind", "bad_choice")]),
                                ({"timed_move": "G1 {axes} F{linear_feed}"}, [("?post/timed_move", "bad_choice")]),
                                ({"axes": axes | {"swing": axes["swing"] | {"within_turn": True}}}, [("?post/axes/swing/within_turn", "unknown_field")]),
                                ({"axes": {role: axes[role] for role in axes if role != "turn"}}, [("?post/axes/turn", "missing_field")])):
            status, _, content = self.service.ask("parts", body, f"{DARK}&post={quote(json.dumps(self.document | changes))}")
            got = [(e["pointer"], e["code"]) for e in json.loads(content)["errors"]]
            self.assertEqual((status, got[:1]), (400, wanted))
        for text in ("{", '{"name": "a"', "{}", "[1]", "{" * 70):
            self.assertEqual(self.service.ask("parts", body, f"{DARK}&post={quote(text)}")[0], 400, text)
        three = {role: axes[role] for role in ("along", "turn", "swing")}
        status, _, content = self.service.ask("parts", body, f"{DARK}&post={quote(json.dumps(self.document | {'axes': three}))}")
        self.assertEqual([e["pointer"] for e in json.loads(content)["errors"]], ["?pivot_length_mm"])

    def test_what_a_request_calls_its_post_stays_a_comment(self):
        """A post's lines are the client's own code; its name is not."""
        body, plain = examples("parts")["chord-with-holes"], None
        for name in ("plain", "a) M3 S1 G0 X0 (", "b;M3", "%", "*) EVIL ("):
            program = self.service.text("parts", body, f"{DARK}&post={quote(json.dumps(self.document | {'name': name}))}").decode("ascii").splitlines()
            said = [line for line in program if line.startswith("(")]
            for line in said:
                self.assertEqual((line.count("("), line.count(")"), line[-1]), (1, 1, ")"))
            code = [line for line in program if not line.startswith("(")]
            plain = plain or code
            self.assertEqual(code, plain, name)

    def test_an_axis_that_counts_within_a_turn(self):
        """0 to below 360 whatever the way round, and by the short way the same path: no move goes as far as half a turn while it cuts."""
        body = examples("parts")["chord-with-holes"]
        rolling = self.document | {"name": "rolling", "axes": self.document["axes"] | {"turn": {"letter": "A", "decimals": 4, "within_turn": True, "offset_deg": 350}}}
        got = linuxcnc(self.service.text("parts", body, f"{DARK}&post={quote(json.dumps(rolling))}").decode())
        wanted = linuxcnc(self.service.text("parts", body, DARK).decode())
        near, crossed = 1e-4, 0
        for (rapid, at), (_, plain), before in zip(got.moves, wanted.moves, [({}, {})] + list(zip(got.moves, wanted.moves))):
            if "A" not in at:
                continue
            self.assertTrue(0 <= at["A"] < 360, at)
            self.assertAlmostEqual((at["A"] - 350 - plain["A"] + 180) % 360 - 180, 0, delta=near)
            if not rapid and "A" in before[0][1]:
                way = (at["A"] - before[0][1]["A"] + 180) % 360 - 180
                self.assertAlmostEqual(way, plain["A"] - before[1][1]["A"], delta=2 * near)
                crossed += abs(at["A"] - before[0][1]["A"]) > 180
        self.assertGreater(crossed, 2)

    def test_the_header_follows_the_signs(self):
        text = self.service.text("parts", examples("parts")["chord-with-holes"], f"{DARK}&post=mirrored").decode()
        for line in ("(X0: the long point of the start, z 0, -X: from the start to the finish)",
                     "(A0: the datum line, phi 0, under the torch, falling A turns the tube counter-clockwise, seen from the start)",
                     "(B0: the torch square to the tube, falling B leans its upper end towards -X, the outer edge then lies further that way)"):
            self.assertIn(line, text)
        x = [float(v) for v in re.findall(r"^G1 X(-?[\d.]+)", text, re.M)]
        least, most = map(float, re.search(r"\(X from (-?[\d.]+) to (-?[\d.]+) mm while cutting\)", text).groups())
        self.assertAlmostEqual(least, min(x), delta=0.0051)
        self.assertAlmostEqual(most, max(x), delta=0.0051)

    def test_what_a_post_lacks_is_refused(self):
        def refused(body, query):
            status, _, content = self.service.ask("parts", body, f"format=gcode&speed_mm_min=600&{query}")
            self.assertIn(status, (400, 422), content[:200])
            return [(error["pointer"], error["code"]) for error in json.loads(content)["errors"]]
        brace, chord = examples("parts")["k-joint-brace"], examples("parts")["chord-with-holes"]
        self.assertEqual(self.service.ask("parts", brace, "format=gcode&speed_mm_min=600&post=three_axes")[0], 200)
        self.assertEqual(refused(brace, "post=three_axes&pivot_length_mm=150"), [("?pivot_length_mm", "unsupported_combination")])
        self.assertEqual(refused(brace, "post=three_axes&axial=z"), [("?axial", "unsupported_combination")])
        square = {role: self.document["axes"][role] for role in ("along", "out", "turn")}
        table = f"post={quote(json.dumps(self.document | {'axes': square}))}&pivot_length_mm=0"
        self.assertEqual(refused(brace, table), [("?post", "unsupported_combination")])
        program = self.service.text("parts", examples("parts")["tube-laser-chord"], f"format=gcode&speed_mm_min=600&{table}").decode()
        words = {letter for line in program.splitlines() if line[:2] in ("G0", "G1") for letter, _ in ADDRESS.findall(line[3:].split(" F")[0])}
        self.assertEqual(words, {"A", "X", "Z"})
        leaning = dict(chord, holes=[dict(hole, tilt="free") for hole in chord["holes"]])
        self.assertEqual(refused(leaning, "post=three_axes"), [("?post", "unsupported_combination")])
        self.assertEqual(refused(brace, "post=other"), [("?post", "bad_choice")])
        self.assertEqual(refused(brace, "post=turned&dialect=linuxcnc"), [("?dialect", "unsupported_combination")])

    def test_faults_of_a_post_are_named_at_the_start(self):
        def without(name):
            return {key: value for key, value in self.document.items() if key != name}
        axes = self.document["axes"]
        cases = (
            (self.document, "/name: "),
            (self.document | {"name": "a", "rapids": "G0"}, "/rapids: "),
            (self.document | {"name": "a", "rapid": "G0 {axis}"}, "/rapid: "),
            (self.document | {"name": "a", "rapid": "G0"}, "/rapid: "),
            (self.document | {"name": "a", "dwell": "G4 P{seconds"}, "/dwell: "),
            (self.document | {"name": "a", "torch_on": ["M3", "S{speed_mm_min}"]}, "/torch_on/1: "),
            (self.document | {"name": "a", "cut_move": "G1 {axes}"}, "/cut_move: "),
            (self.document | {"name": "a", "begin": ["%", "Träger"]}, "/begin/1: "),
            (self.document | {"name": "a", "comment_end": "."}, "/comment_end: "),
            (self.document | {"name": "a", "file_name": "{piece}.ngc"}, "/file_name: "),
            (self.document | {"name": "a", "kind": "point_pairs"}, "/units: "),
            (self.document | {"name": "a", "cut_move": "G1 {axes} F{axis_feeds}"}, "/cut_move: "),
            (self.document | {"name": "a", "block_numbers": -1}, "/block_numbers: "),
            (self.document | {"name": "a", "axes": axes | {"swing": {"letter": "A", "decimals": 4}}}, "/axes/swing/letter: "),
            (self.document | {"name": "a", "axes": axes | {"turn": {"letter": "F", "decimals": 4}}}, "/axes/turn/letter: "),
            (self.document | {"name": "a", "axes": axes | {"turn": {"letter": "A", "decimals": 4, "offset_mm": 1}}}, "/axes/turn/offset_mm: "),
            (self.document | {"name": "a", "axes": {role: axes[role] for role in axes if role != "turn"}}, "/axes/turn: "),
            (without("end") | {"name": "a"}, "/end: "))
        for document, wanted in cases:
            with tempfile.TemporaryDirectory() as folder, self.subTest(wanted):
                pathlib.Path(folder, "mine.json").write_text(json.dumps(document))
                ran = subprocess.run([FormatTest.binary, "run", "--posts", folder, "--endpoint", "bevel-tables", str(ROOT / "examples/bevel-tables/mitre.json")],
                                     capture_output=True, text=True)
                self.assertEqual(ran.returncode, 1)
                self.assertIn(f"mine.json: {wanted}", ran.stderr)

    def test_read_again_all_or_nothing(self):
        def names():
            return [post["name"] for post in json.loads(self.service.get("/v1/posts"))["posts"]]

        def within(holds):
            end = time.monotonic() + 20
            while not holds() and time.monotonic() < end:
                time.sleep(0.05)
            return holds()
        before, configuration = names(), json.loads(self.service.get("/v1/version"))["configuration_sha256"]
        file = self.folder / "zz.json"
        file.write_text(json.dumps(self.document | {"name": "late"}))
        self.service.child.send_signal(signal.SIGHUP)
        self.assertTrue(within(lambda: names() == before + ["late"]))
        self.assertNotEqual(json.loads(self.service.get("/v1/version"))["configuration_sha256"], configuration)
        file.write_text(json.dumps(self.document | {"name": "broken", "rapid": "G0"}))
        self.service.child.send_signal(signal.SIGHUP)
        time.sleep(0.5)
        self.assertEqual(names(), before + ["late"])
        file.unlink()
        self.service.child.send_signal(signal.SIGHUP)
        self.assertTrue(within(lambda: names() == before))


if __name__ == "__main__":
    main()
