"""Tabs and slots of frames: both parts against numbers that are computed here from the request alone, and every file of a part with tabs."""

import copy
import json
import math
import re

import step_reader
import step_volume
from dstv_test import parse
from dxf_test import polylines, read
from service import ROOT, FormatTest, main

EXAMPLE = json.loads((ROOT / "examples/frames/sign-frame-with-tab-and-slot.json").read_text())
RHS = {"height": 60, "width": 40, "wall": 3, "corner": 6}  # EN 10219: twice the wall
KERF = 0.25


def leaning(angle_deg, face, proud=0):
    """A brace that meets a post at an angle from the post's axis; its face 1 is up, face 2 at the side."""
    run = 600 / math.tan(math.radians(angle_deg))
    return {"preset": "tube_laser", "kerf_mm": KERF, "sampling": {"tolerance_mm": 0.05},
            "members": [{"id": "post", "start_mm": [0, 0, -500], "end_mm": [0, 0, 1500], "size": "SHS 80x80x4 EN 10219", "up": [1, 0, 0]},
                        {"id": "brace", "start_mm": [0, 0, 0], "end_mm": [600, 0, run], "size": "RHS 60x40x3 EN 10219", "up": [-run, 0, 600],
                         "priority": 1}],
            "joints": [{"between": ["brace", "post"], "kind": "tab_slot", "end": "start", "clearance_mm": 0.2, "clearance_thickness_mm": 0.3,
                        "proud_mm": proud, "tab_slots": [{"face": face, "width_mm": 20}]}]}


def part(answer, name):
    [found] = [one for one in answer["parts"] if one["part"] == name]
    return found["answer"]


def steps(points, column):
    """[(girth, z, z)] where two rows lie at one place."""
    s, z = points["girth_mm"], points[column]
    return [(s[i], z[i], z[i + 1]) for i in range(len(s) - 1) if s[i] == s[i + 1] and z[i] != z[i + 1]]


def cuts_of(program):
    """{name: [{axis: value}]} of the moves with the torch lit."""
    at, cuts, name, lit = dict.fromkeys("XYZA", 0.0), {}, "", False
    for line in program.splitlines():
        if line.startswith("(cut: "):
            name = line[6:-1]
        if line.startswith("M3"):
            lit, cuts[name] = True, [dict(at)]
        lit = lit and not line.startswith("M5")
        if "(" in line:
            continue
        words = re.findall(r"([XYZA])(-?[0-9.]+)", line)
        at.update({axis: float(value) for axis, value in words})
        if words and lit:
            cuts[name].append(dict(at))
    return cuts


def off_line(p, a, b):
    d = b[0] - a[0], b[1] - a[1]
    share = min(1.0, max(0.0, ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] ** 2 + d[1] ** 2)))
    return math.hypot(p[0] - a[0] - share * d[0], p[1] - a[1] - share * d[1])


def area_of(outline):
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(outline, outline[1:] + outline[:1]))) / 2


class TabSlots(FormatTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.sign = cls.service.answer("frames", EXAMPLE)

    def test_the_sign_frame_is_two_parts_whose_checks_hold(self):
        self.assertEqual([(row["part"], row["count"]) for row in self.sign["result"]["cut_list"]], [("left post", 2), ("top rail", 2)])
        self.assertEqual(self.sign["verdict"]["status"], "ok")
        checks = {check["name"]: check for check in self.sign["verification"]["checks"]}
        for name in ("tab_in_slot", "tab_corners", "tab_beam", "tab_area"):
            self.assertLessEqual(checks[name]["value"], checks[name]["limit"], name)
        for joint in self.sign["result"]["joints"]:
            name = joint["branch"].split()[0]
            self.assertEqual((joint["kind"], joint["slots"]), ("tab_slot", [f"{name}.0", f"{name}.1"]))

    def test_a_square_rail_has_its_shoulders_on_the_posts_and_its_tips_flush_with_their_bores(self):
        result = part(self.sign, "top rail")["result"]
        self.assertAlmostEqual(result["lengths"]["short_mm"], 1500 - 60, delta=1e-6)
        self.assertAlmostEqual(result["lengths"]["long_mm"], 1440 + 2 * 3, delta=1e-6)
        self.assertAlmostEqual(result["lengths"]["blank_mm"], 1446 + 2 * KERF, delta=1e-6)
        girth = 2 * (60 + 40) - (8 - 2 * math.pi) * 6
        for end in ("start", "finish"):
            points = result["ends"][end]["points"]
            for column, off in (("z_outer_mm", 0), ("z_inner_mm", 0), ("torch_outer_mm", KERF / 2)):
                places = [((s + girth / 4) % girth, a, b) for s, a, b in steps(points, column)]
                wanted = sorted(side + middle + girth / 4 for middle in (0, girth / 2) for side in (-10 - off, 10 + off))
                self.assertEqual(len(places), 4, column)
                for (s, a, b), at in zip(sorted(places), wanted):
                    self.assertAlmostEqual(s, at, delta=1e-6)
                    self.assertAlmostEqual(abs(a - b), 3, delta=1e-6)

    def test_slots_lie_where_the_tabs_of_a_square_rail_meet_the_post(self):
        result = part(self.sign, "left post")["result"]
        groups = {group["id"]: group for group in result["cutouts"]}
        self.assertEqual(sorted(groups), ["bottom.0", "bottom.1", "top.0", "top.1"])
        for name, z in (("top.0", 2450 + 28.5), ("top.1", 2450 - 28.5), ("bottom.0", 1450 + 28.5), ("bottom.1", 1450 - 28.5)):
            [one] = groups[name]["instances"]
            self.assertEqual((one["face"], round(one["offset_mm"], 6)), (1, 0))
            self.assertAlmostEqual(one["z_mm"], z, delta=1e-6)
            rows = groups[name]["points"] if "points" in groups[name] else one["points"]
            for column, size in (("z_mm", 3 + 0.4), ("girth_mm", 20 + 0.4)):
                self.assertAlmostEqual(max(rows[column]) - min(rows[column]), size, delta=1e-6)

    def test_a_leaning_brace_has_the_short_forms(self):
        for angle in (35, 50, 90, 120):
            for face in (1, 2):
                with self.subTest(angle=angle, face=face):
                    body = leaning(angle, face, proud=2)
                    answer = self.service.answer("frames", body)
                    request = {one["part"]: one["answer"]["request"] for one in answer["parts"]}
                    sine, slide = math.sin(math.radians(angle)), abs(4 / math.tan(math.radians(angle)))
                    [tab] = request["brace"]["ends"]["start"]["end_tabs"]
                    self.assertAlmostEqual(tab["length_mm"], 6 / sine, delta=2e-6)
                    [slot] = request["post"]["cutouts"]
                    sides = slot["shape"]["along_mm"], slot["shape"]["round_mm"]
                    wanted = (3 / sine + slide + 0.6, 20 + 0.4) if face == 1 else (20 / sine + slide + 0.4, 3 + 0.6)
                    for got, side in zip(sides, wanted):
                        self.assertAlmostEqual(got, side, delta=2e-6)
                    checks = {check["name"]: check["value"] for check in answer["verification"]["checks"]}
                    self.assertLess(checks["tab_in_slot"], 1e-5)

    def test_the_files_show_the_tabs(self):
        made = part(self.sign, "top rail")
        body, result = made["request"], made["result"]
        girth = 2 * (60 + 40) - (8 - 2 * math.pi) * 6
        drawing = read(self.service.text("parts", body, "format=dxf"))
        self.assertEqual(drawing.audit().errors, [])
        tips = {round(z, 4) for points, _ in polylines(drawing, "CUT_OUTER") for _, z in points}
        for z in (0, 3, 1443, 1446):
            self.assertIn(z, tips)
        corners = [(x, z) for points, _ in polylines(drawing, "CUT_OUTER") for x, z in points]
        for s in (10, girth / 2 - 10, girth / 2 + 10, girth - 10):
            for z in (0, 3):
                self.assertTrue(any(math.hypot(x - s, y - z) < 1e-4 for x, y in corners), (s, z))
        file = parse(self.service.text("parts", body, "format=nc1").decode("ascii"))
        outlines = sorted(area_of([(x, y) for x, y, _ in outline[:-1]]) for outline in file["AK"])
        # Faces 1 and 3 are 40 wide, with tabs at both ends, faces 2 and 4 are 60 wide.
        for got, wanted in zip(outlines, sorted([40 * 1440 + 2 * 20 * 3] * 2 + [60 * 1440] * 2)):
            self.assertAlmostEqual(got, wanted, delta=2)
        solid = step_reader.Solid(step_reader.File(self.service.text("parts", body, "format=step").decode("ascii")))
        self.assertEqual(step_reader.faults(solid, 1 + 10), [])
        self.assertAlmostEqual(step_volume.volume(solid) / result["lengths"]["volume_mm3"], 1, delta=2e-6)
        for wanted in ("format=gcode&torch=off&speed_mm_min=3000&pivot_length_mm=0", "format=pdf", "format=svg", "format=csv"):
            self.assertGreater(len(self.service.text("parts", body, wanted)), 1000, wanted)

    def test_a_program_runs_half_a_kerf_off_the_tabs(self):
        """On the faces with tabs the lit torch is nowhere nearer to the finished edge than half a kerf, and as near next to each side."""
        options = "format=gcode&torch=on&speed_mm_min=3000&pivot_length_mm=0&lead_mm=3&pierce_height_mm=3&cut_height_mm=1.5&pierce_delay_s=0.3&clearance_mm=30"
        cuts = cuts_of(self.service.text("parts", part(self.sign, "top rail")["request"], options).decode("ascii"))
        for end, shoulder, out in (("start", 3, -1), ("finish", 1443, 1)):
            tip = shoulder + 3 * out
            edge = [(shoulder, -14), (shoulder, -10), (tip, -10), (tip, 10), (shoulder, 10), (shoulder, 14)]
            for face in (0, 180):
                moves = [(a, b) for a, b in zip(cuts[end], cuts[end][1:]) if all(abs((p["A"] - face + 180) % 360 - 180) < 1e-6 for p in (a, b))]
                places = [tuple(a[axis] + share / 50 * (b[axis] - a[axis]) for axis in "XY") for a, b in moves for share in range(51)]
                places = [p for p in places if abs(p[1]) < 13.9]
                for p in places:
                    self.assertGreater(min(off_line(p, a, b) for a, b in zip(edge, edge[1:])), KERF / 2 - 1e-4, (end, face, p))
                    self.assertFalse(p[0] * out < shoulder * out or (abs(p[1]) < 10 and p[0] * out < tip * out), (end, face, p))
                for middle in ((shoulder + 1.5 * out, -10), (shoulder + 1.5 * out, 10), (tip, 0)):
                    self.assertLess(min(math.dist(p, middle) for p in places), KERF / 2 + 0.05, (end, face, middle))

    def test_a_part_by_itself_is_that_of_the_frame(self):
        made = part(self.sign, "top rail")
        again = self.service.answer("parts", made["request"])
        self.assertEqual(again["result"], made["result"])

    def refused(self, change, endpoint="frames", body=EXAMPLE):
        body = copy.deepcopy(body)
        change(body)
        status, _, content = self.service.ask(endpoint, body)
        self.assertEqual(status, 422, content[:300])
        return sorted((issue["pointer"], issue["code"]) for issue in json.loads(content)["errors"])

    def test_what_does_not_fit_is_refused_at_its_field(self):
        def joint(**fields):
            return lambda body: body["joints"][0].update(fields)

        def tab(**fields):
            return lambda body: body["joints"][0]["tab_slots"][1].update(fields)
        at = "/joints/0"
        self.assertEqual(self.refused(tab(width_mm=28)), [(f"{at}/tab_slots/1/width_mm", "out_of_range")])
        self.assertEqual(self.refused(tab(offset_mm=5)), [(f"{at}/tab_slots/1/width_mm", "out_of_range")])
        self.assertEqual(self.refused(tab(face=1)), [(f"{at}/tab_slots/1/offset_mm", "out_of_range")])
        self.assertEqual(self.refused(tab(face=5)), [(f"{at}/tab_slots/1/face", "out_of_range")])
        self.assertEqual(self.refused(joint(clearance_mm=0.03)), [(f"{at}/clearance_mm", "slot_too_narrow")])
        self.assertEqual(self.refused(joint(proud_mm=60)), [(f"{at}/proud_mm", "out_of_range")])
        self.assertEqual(self.refused(joint(gap_mm=1)), [(f"{at}/gap_mm", "unknown_field")])
        self.assertEqual(self.refused(joint(slot_wall="across")), [(f"{at}/slot_wall", "bad_choice")])
        self.assertEqual(self.refused(lambda body: body["joints"][0].pop("tab_slots")), [(f"{at}/tab_slots", "missing_field")])
        self.assertEqual(self.refused(lambda body: body.update(merge_in_line=True)), [("/merge_in_line", "unsupported_combination")])
        self.assertEqual(self.refused(lambda body: body["joints"][2].update(id="top")), [("/joints/2/id", "duplicate_id")])

        def several(body):
            body["joints"][0]["tab_slots"][0]["width_mm"] = 30
            body["joints"][3]["tab_slots"][1]["width_mm"] = 30
        self.assertEqual(self.refused(several), [("/joints/0/tab_slots/0/width_mm", "out_of_range"), ("/joints/3/tab_slots/1/width_mm", "out_of_range")])

    def test_the_member_with_the_tabs_may_come_second(self):
        body = copy.deepcopy(EXAMPLE)
        for joint in body["joints"]:
            joint["between"].reverse()
        answer = self.service.answer("frames", body)
        self.assertEqual(answer["result"], self.sign["result"])
        for name in ("top rail", "left post"):
            self.assertEqual(part(answer, name)["request"], part(self.sign, name)["request"])

    def test_a_narrow_clearance_holds_the_shoulder_off(self):
        """The slot's edge, c next to the tab, touches the fillet's circle of half a kerf: the shoulder is off by what is left of it."""
        for clearance in (0.05, 0.1, 0.124):
            body = copy.deepcopy(EXAMPLE)
            body["joints"][0].update(clearance_mm=clearance, clearance_thickness_mm=0.2)
            answer = self.service.answer("frames", body)
            [warning] = answer["warnings"]
            self.assertEqual((warning["code"], warning["pointer"], answer["verdict"]["status"]), ("shoulder_off", "/joints/0/clearance_mm", "review"))
            off = float(re.match(r"by ([0-9.e-]+) mm", warning["detail"]).group(1))
            self.assertAlmostEqual(math.hypot(KERF / 2 - clearance, KERF / 2 - off), KERF / 2, delta=1e-6)
            checks = {check["name"]: check for check in answer["verification"]["checks"]}
            self.assertLessEqual(checks["tab_in_slot"]["value"], checks["tab_in_slot"]["limit"])
        body["joints"][0].update(clearance_mm=KERF / 2)
        self.assertEqual(self.service.answer("frames", body)["warnings"], [])

    def test_what_is_too_narrow_states_the_clearance_that_suffices(self):
        body = copy.deepcopy(EXAMPLE)
        body["joints"][0].update(clearance_mm=0.01)
        _, _, content = self.service.ask("frames", body)
        [issue] = json.loads(content)["errors"]
        self.assertEqual((issue["pointer"], issue["code"]), ("/joints/0/clearance_mm", "slot_too_narrow"))
        body["joints"][0].update(clearance_mm=issue["limit"])
        self.assertEqual(self.service.answer("frames", body)["verdict"]["status"], "review")

    def test_walls_along_a_tab_are_those_of_a_tab_at_a_right_angle(self):
        plain, along = leaning(90, 1), leaning(90, 1)
        along["joints"][0]["slot_wall"] = "along"
        slots = [part(self.service.answer("frames", body), "post")["request"]["cutouts"] for body in (plain, along)]
        self.assertEqual(*slots)
        self.assertEqual(self.refused(lambda body: body["joints"][0].update(slot_wall="along"), body=leaning(60, 1)),
                         [("/joints/0/slot_wall", "unsupported_combination")])

    def test_round_members_take_tabs_and_have_none(self):
        def rounded(name):
            def change(body):
                [member] = [one for one in body["members"] if one["id"] == name]
                member["size"] = "CHS 60.3x3.2"
                member.pop("cutouts", None)
            return change
        body = copy.deepcopy(EXAMPLE)
        rounded("left post")(body)
        answer = self.service.answer("frames", body)
        self.assertEqual(answer["verdict"]["status"], "ok", answer["warnings"])
        self.assertEqual({one["wall"] for one in part(answer, "left post")["request"]["cutouts"]}, {"developed"})
        self.assertEqual(self.refused(rounded("top rail")),
                         [("/joints/0/between/0", "unsupported_combination"), ("/joints/1/between/0", "unsupported_combination")])

    def test_tabs_of_a_part_are_refused_at_their_field(self):
        body = part(self.sign, "top rail")["request"]

        def tab(**fields):
            return lambda one: one["ends"]["start"]["end_tabs"][0].update(fields)
        at = "/ends/start/end_tabs/0"
        self.assertEqual(self.refused(tab(width_mm=28), "parts", body), [(f"{at}/width_mm", "out_of_range")])
        self.assertEqual(self.refused(tab(phi_deg=0), "parts", body), [(f"{at}/phi_deg", "unknown_field")])

        def square(one):
            one["ends"]["start"] = {"square_at_mm": 0, "end_tabs": one["ends"]["start"]["end_tabs"]}
        self.assertEqual(self.refused(square, "parts", body), [("/ends/start/end_tabs", "unsupported_combination")])


if __name__ == "__main__":
    main()
