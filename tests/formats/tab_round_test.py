"""Tabs of rectangular members in slots of a round one: both parts placed in the world from the request's members and the parts' own requests, and
compared point by point; every file of both; what is refused."""

import copy
import json
import math
import os
import random

import step_reader
import step_volume
from dxf_test import read
from service import ROOT, FormatTest, main

SHELF = json.loads((ROOT / "examples/frames/shelf-arms-on-a-round-post.json").read_text())
BRACE = {"id": "brace", "start_mm": [0, 0, 500], "end_mm": [450, 0, 800], "size": "SHS 40x40x3 EN 10219", "up": [-300, 0, 450], "priority": 1}
EXAMPLE = SHELF | {"members": SHELF["members"] + [BRACE], "joints": SHELF["joints"] + [
    {"between": ["brace", "post"], "kind": "tab_slot", "end": "start", "clearance_mm": 0.2, "clearance_thickness_mm": 0.3,
     "tab_slots": [{"face": 1, "width_mm": 16}, {"face": 3, "width_mm": 16}]}]}
CASES = int(os.environ.get("TUBECUT_CASES", "16"))
TILTING = {"defaults": {"root_surface": "inner", "groove": {"rule": "square"}, "smoothing": {"method": "none"}}}
FACES = ((1, 0), (0, 1), (-1, 0), (0, -1))


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def add(a, b, k=1.0):
    return [x + k * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


class Frame:
    """A member's own: z from its start to its finish, x on the side of `up`."""

    def __init__(self, member):
        self.origin = member["start_mm"]
        self.z = unit(sub(member["end_mm"], self.origin))
        self.x = unit(add(member["up"], self.z, -dot(member["up"], self.z)))
        self.y = cross(self.z, self.x)

    def world(self, x, y):
        return add([x * k for k in self.x], self.y, y)

    def local(self, p):
        off = sub(p, self.origin)
        return dot(off, self.x), dot(off, self.y), dot(off, self.z)


def part_of(answer, name):
    [found] = [one["answer"] for one in answer["parts"] if one["part"] == name]
    return found


def free_of(body, answer):
    """{slot: (least way across the tube, least way along it, least way to a round corner)} of tabs in their slots, mm, at 33 radii of the wall."""
    members = {one["id"]: one for one in body["members"]}
    out = {}
    for joint in body["joints"]:
        branch, chord = members["arm"], members["post"]
        own, there = Frame(branch), Frame(chord)
        height, width, wall, outer, inner = (joint["sizes"][k] for k in ("height", "width", "t", "R", "r"))
        asked = part_of(answer, branch["id"])["request"]["ends"][joint["end"]]["end_tabs"]
        slots = {one["id"]: one for one in part_of(answer, chord["id"])["request"]["cutouts"]}
        for k, tab in enumerate(asked):
            n = FACES[tab["face"] - 1]
            normal, round_ = own.world(*n), own.world(-n[1], n[0])
            face = (height if n[0] else width) / 2
            d = [-x for x in own.z] if joint["end"] == "start" else own.z
            base = branch["start_mm"] if joint["end"] == "start" else branch["end_mm"]
            slot = slots[f"{branch['id']}.{k}"]
            turn, z, shape = math.radians(slot["at"]["phi_deg"]), slot["at"]["z_mm"], slot["shape"]
            developed = slot["wall"] == "developed"
            least = [1e9, 1e9, 1e9]
            # The tab's four sides, as lines along its axis; where each passes the radii of the wall, coming from outside.
            sides = [(a / 20 - 0.5, b) for a in range(21) for b in (0, 1)] + [(a, b / 20) for a in (-0.5, 0.5) for b in range(21)]
            for a, b in sides:
                p = add(add(base, normal, face - b * wall), round_, tab["offset_mm"] + a * tab["width_mm"])
                x, y, at = there.local(p)
                dx, dy, dz = (dot(d, axis) for axis in (there.x, there.y, there.z))
                for i in range(33):
                    rho = outer + i / 32 * (inner - outer)
                    qa, qb, qc = dx * dx + dy * dy, x * dx + y * dy, x * x + y * y - rho * rho
                    way = (-qb - math.sqrt(qb * qb - qa * qc)) / qa
                    px, py, pz = x + way * dx, y + way * dy, at + way * dz
                    phi = math.remainder(math.atan2(py, px) - turn, 2 * math.pi)
                    half = shape["round_mm"] / 2
                    # Across the branch's axis, on the radius of the place.
                    lean = math.atan2(-dy, -dx)
                    if developed:
                        edges = [rho * math.sin(turn + side * half / outer - lean) for side in (-1, 1)]
                    else:
                        edges = [-half, half]
                    across = rho * math.sin(math.remainder(phi + turn - lean, 2 * math.pi))
                    least[0] = min(least[0], across - edges[0], edges[1] - across)
                    least[1] = min(least[1], shape["along_mm"] / 2 - abs(pz - z))
                    u = abs(outer * phi if developed else across) - (half - shape["corner_radius_mm"])
                    v = abs(pz - z) - (shape["along_mm"] / 2 - shape["corner_radius_mm"])
                    if u > 0 and v > 0:
                        least[2] = min(least[2], shape["corner_radius_mm"] - math.hypot(u, v))
            out[slot["id"]] = least
    return out


class TabRound(FormatTest):
    def drawn(self, seeded):
        """A rectangular member on a round one: turned in plan, at any angle, off its middle, from either end, in any order, with three decimals."""
        outer, wall = seeded.choice(((60.3, 3.2), (88.9, 4), (114.3, 5), (168.3, 6.3)))
        height, width = seeded.choice(((40, 20), (60, 40), (40, 40), (50, 30)))
        t = seeded.choice((2, 3))
        plan, angle = seeded.uniform(0, 2 * math.pi), math.radians(seeded.choice((90, 90, 75, 60, 45, 120)))
        run = [math.cos(plan) * math.sin(angle), math.sin(plan) * math.sin(angle), math.cos(angle)]
        side = cross([0, 0, 1], run)
        room = max(0, outer / 2 * 0.8 - width / 2 - 1)
        aside = seeded.choice((0, 0, seeded.uniform(-room, room) / math.sqrt(dot(side, side))))
        foot = [round(x, 3) for x in add([100, -50, 700], side, aside)]
        tip = [round(x, 3) for x in add(foot, run, 500)]
        up = unit(cross(run, side))
        kerf, c, ct = seeded.choice((0.2, 0.25, 0.4)), round(seeded.uniform(0.1, 0.5), 2), round(seeded.uniform(0.1, 0.5), 2)
        end = seeded.choice(("start", "finish"))
        faces = seeded.sample((1, 2, 3, 4), seeded.randint(1, 4))
        branch = {"id": "arm", "start_mm": foot if end == "start" else tip, "end_mm": tip if end == "start" else foot, "up": [round(x, 6) for x in up],
                  "size": f"RHS {height}x{width}x{t} EN 10219" if height != width else f"SHS {height}x{width}x{t} EN 10219", "priority": 1}
        chord = {"id": "post", "start_mm": [100, -50, 0], "end_mm": [100, -50, 1500], "size": f"CHS {outer}x{wall}", "up": [1, 0, 0]}
        flats = {face: (width, height)[face % 2 == 0] - 4 * t for face in faces}
        joint = {"between": ["arm", "post"], "kind": "tab_slot", "end": end, "clearance_mm": c, "clearance_thickness_mm": ct,
                 "proud_mm": seeded.choice((0, 1.5)), "tab_slots": [{"face": face, "width_mm": round(seeded.uniform(4, flats[face] - kerf), 3)} for face in faces]}
        if seeded.random() < 0.5:
            chord["start_mm"], chord["end_mm"] = chord["end_mm"], chord["start_mm"]
        members = [branch, chord]
        seeded.shuffle(members)
        seeded.shuffle(joint["between"])
        sizes = {"height": height, "width": width, "t": t, "R": outer / 2, "r": outer / 2 - wall}
        return {"preset": "tube_laser", "kerf_mm": kerf, "sampling": {"tolerance_mm": 0.05}, "members": members, "joints": [joint]}, sizes

    def test_drawn_tabs_keep_their_clearances_in_space(self):
        seeded, answered, refused = random.Random(91), 0, 0
        for _ in range(20 * CASES):
            if answered == 2 * CASES:
                break
            body, sizes = self.drawn(seeded)
            status, _, content = self.service.ask("frames", body)
            answer = json.loads(content)
            with self.subTest(body=json.dumps(body)[:400]):
                if status != 200:
                    self.assertEqual(status, 422)
                    for issue in answer["errors"]:
                        self.assertIn(issue["code"], ("out_of_range", "slot_too_narrow", "open_profile"), issue)
                        self.assertTrue(issue["pointer"].startswith("/joints/0/") and issue["hint"], issue)
                    refused += 1
                    continue
                lost = [one["detail"] for one in answer["warnings"] if one["code"] == "no_part"]
                if any("cutouts_cross at /joints/0/tab_slots/" in one for one in lost):  # tabs of two faces that meet at a corner
                    refused += 1
                    continue
                self.assertEqual(lost, [])
                joint = body["joints"][0]
                limits = joint["clearance_mm"], joint["clearance_thickness_mm"]
                solid = copy.deepcopy(body)
                solid["joints"][0]["sizes"] = sizes
                for k, (name, free) in enumerate(sorted(free_of(solid, answer).items())):
                    # `up` is square to the post: faces 1 and 3 have their width across it.
                    across, along = limits if joint["tab_slots"][k]["face"] in (1, 3) else limits[::-1]
                    self.assertGreater(free[0], across - 2e-5, name)
                    self.assertGreater(free[1], along - 2e-5, name)
                    self.assertGreater(free[2], -2e-5, name)
                    self.assertLess(free[0], across + 0.01, name)
                for check in answer["verification"]["checks"]:
                    self.assertLessEqual(check["value"], check["limit"], check["name"])
                warned = [one["code"] for one in answer["warnings"]]
                self.assertEqual("shoulder_off" in warned, joint["clearance_mm"] < body["kerf_mm"] / 2, warned)
                answered += 1
        print(f"{answered} joints in round walls, {refused} refused at their fields")
        self.assertEqual(answered, 2 * CASES)

    def test_the_example_has_the_short_forms(self):
        answer = self.service.answer("frames", SHELF)
        self.assertEqual((answer["verdict"]["status"], answer["warnings"]), ("ok", []))
        answer = self.service.answer("frames", EXAMPLE)
        self.assertEqual([one["code"] for one in answer["warnings"]], ["root_opens"])  # a leaning end that is cut square
        self.assertEqual([(row["part"], row["count"]) for row in answer["result"]["cut_list"]], [("post", 1), ("upper arm", 2), ("brace", 1)])
        outer, inner = 88.9 / 2, 88.9 / 2 - 4
        slots = {one["id"]: one for one in part_of(answer, "post")["request"]["cutouts"]}
        across, along = slots["upper arm.0"]["shape"], slots["upper arm.1"]["shape"]
        self.assertAlmostEqual(across["round_mm"], 2 * outer * math.asin(10.2 / inner), delta=1e-6)
        self.assertAlmostEqual(across["along_mm"], 3.4, delta=1e-6)
        self.assertAlmostEqual(along["round_mm"], outer * (math.asin(20.2 / inner) - math.asin(16.8 / outer)), delta=1e-6)
        self.assertAlmostEqual(along["along_mm"], 30.4, delta=1e-6)
        tabs = part_of(answer, "upper arm")["request"]["ends"]["start"]["end_tabs"]
        self.assertAlmostEqual(tabs[0]["length_mm"], 4, delta=1e-6)
        self.assertAlmostEqual(tabs[1]["length_mm"], math.sqrt(outer ** 2 - 17 ** 2) - math.sqrt(inner ** 2 - 17 ** 2), delta=1e-6)
        angle = math.atan2(450, 300)
        brace = slots["brace.0"]["shape"]
        self.assertAlmostEqual(brace["along_mm"], 3 / math.sin(angle) + (outer - math.sqrt(inner ** 2 - 8.2 ** 2)) / math.tan(angle) + 0.6, delta=1e-6)

    def test_every_file_of_both_parts(self):
        answer = self.service.answer("frames", EXAMPLE)
        for name, cuts in (("upper arm", 2), ("brace", 2), ("post", 2)):
            made = part_of(answer, name)
            body, result = made["request"], made["result"]
            with self.subTest(part=name):
                self.assertEqual(read(self.service.text("parts", body, "format=dxf")).audit().errors, [])
                self.assertGreater(len(self.service.text("parts", body, "format=nc1")), 300)
                solid = step_reader.Solid(step_reader.File(self.service.text("parts", body, "format=step").decode("ascii")))
                self.assertAlmostEqual(step_volume.volume(solid) / result["lengths"]["volume_mm3"], 1, delta=2e-5)
                for wanted in ("format=gcode&torch=off&speed_mm_min=3000&pivot_length_mm=0", "format=pdf", "format=svg", "format=csv"):
                    self.assertGreater(len(self.service.text("parts", body, wanted)), 1000, wanted)
                again = self.service.answer("parts", body)
                self.assertEqual(again["result"], result)

    def refused(self, change, body=EXAMPLE):
        body = copy.deepcopy(body)
        change(body)
        status, _, content = self.service.ask("frames", body)
        self.assertEqual(status, 422, content[:300])
        issues = json.loads(content)["errors"]
        self.assertTrue(all(issue.get("hint") for issue in issues), issues)
        return sorted((issue["pointer"], issue["code"]) for issue in issues)

    def test_what_does_not_fit_is_refused_at_its_field(self):
        def joint(**fields):
            return lambda body: body["joints"][0].update(fields)

        def tab(**fields):
            return lambda body: body["joints"][0]["tab_slots"][1].update(fields)

        def askew(body):
            body["members"][1]["up"] = [0, 1, 5]
        at = "/joints/0"
        self.assertEqual(self.refused(askew), [(f"{at}/tab_slots/{k}/face", "unsupported_combination") for k in range(4)])
        self.assertEqual(self.refused(joint(proud_mm=75)), [(f"{at}/proud_mm", "out_of_range")])
        self.assertEqual(self.refused(joint(slot_wall="along")), [(f"{at}/slot_wall", "unsupported_combination")])
        self.assertEqual(self.refused(joint(clearance_mm=0.03)), [(f"{at}/clearance_mm", "slot_too_narrow")])
        self.assertEqual(self.refused(tab(width_mm=50)), [(f"{at}/tab_slots/1/width_mm", "out_of_range")])

        def narrow(body):
            body["members"][0]["size"] = "CHS 48.3x3.2"
        self.assertIn((f"{at}/tab_slots/1/offset_mm", "out_of_range"), self.refused(narrow))

        def round_arm(body):
            body["members"][1]["size"] = "CHS 48.3x3.2"
        self.assertEqual(self.refused(round_arm), [(f"{at}/between/0", "unsupported_combination")])

    def test_walls_along_the_tab(self):
        def made(**fields):
            body = copy.deepcopy(EXAMPLE) | TILTING
            del body["preset"]
            body["members"] = body["members"][:2]
            body["joints"] = [body["joints"][0] | {"slot_wall": "along"} | fields]
            return body
        faces = {"tab_slots": [{"face": 1, "width_mm": 20}, {"face": 3, "width_mm": 20}]}
        answer = self.service.answer("frames", made(**faces))
        [first, _] = part_of(answer, "post")["request"]["cutouts"]
        self.assertEqual((first["wall"], first["tilt"]), ("normal", "free"))
        self.assertAlmostEqual(first["shape"]["round_mm"], 20.4, delta=1e-6)
        self.assertAlmostEqual(first["shape"]["along_mm"], 3.4, delta=1e-6)
        for check in answer["verification"]["checks"]:
            self.assertLessEqual(check["value"], check["limit"], check["name"])
        self.assertEqual(self.refused(lambda _: None, made()), [("/joints/0/slot_wall", "unsupported_combination")])
        leaning = made(**faces)
        leaning["members"][1]["end_mm"][2] += 200
        self.assertEqual(self.refused(lambda _: None, leaning), [("/joints/0/slot_wall", "unsupported_combination")])


if __name__ == "__main__":
    main()
