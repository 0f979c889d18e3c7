"""G-code around tubes that are not round, replayed along every block by formulas of its own: the tip on the outside, the cut on the table's line."""

import json
import math
import random
import re

import drawn_parts
from gcode_test import moves
from service import ROOT, FormatTest, main

SAG = 0.02  # mm, of a block between rows
LEAN = 1.0  # deg
SAMPLES = 7  # inside each block, at least; one every quarter of a mm


class Outline:
    """A rectangle that a disc is moved over."""

    def __init__(self, height, width, corner):
        self.corner, self.x, self.y = corner, height / 2 - corner, width / 2 - corner

    def foot(self, x, y):
        """(distance beyond the outside, direction of the normal in deg, girth)"""
        mx, my = max(-self.x, min(self.x, x)), max(-self.y, min(self.y, y))
        off, normal = math.hypot(x - mx, y - my), math.degrees(math.atan2(y - my, x - mx)) % 360
        return off - self.corner, normal, self.girth(mx, my, normal)

    def girth(self, mx, my, normal):
        """Each quarter of the normal's directions has passed one flat and one corner more; a flat adds the way along it."""
        quarter = self.corner * math.pi / 2
        flats, along = [2 * self.y, 2 * self.x, 2 * self.y, 2 * self.x], [my, -mx, -my, mx]
        face = round(normal / 90) % 4
        if abs((normal - 90 * face + 180) % 360 - 180) < 1e-9:
            before = (flats[0] / 2 + sum(flats[1:face]) + flats[face] / 2 if face else 0) + face * quarter
            return (before + along[face]) % (sum(flats) + 4 * quarter)
        corner = int(normal // 90)
        return flats[0] / 2 + sum(flats[1:corner + 1]) + self.corner * math.radians(normal)

    def whole(self):
        return 4 * self.x + 4 * self.y + 2 * math.pi * self.corner


def line_of(points, girth):
    """z of the torch line on the outside and tan B at any girth: both straight between rows."""
    s, z = points["girth_mm"], points["torch_outer_mm"]
    slope = [math.tan(math.radians(b)) for b in points["b_deg"]]
    rows = [(s[-1] - girth, z[-1], slope[-1]), *zip(s, z, slope), (s[0] + girth, z[0], slope[0])]

    def at(place):
        found = []
        for (a, za, ta), (b, zb, tb) in zip(rows, rows[1:]):
            if a - 1e-6 <= place <= b + 1e-6:
                share = (place - a) / (b - a) if b > a else 0.0
                found.append((za + share * (zb - za), ta + share * (tb - ta)))
        return found
    return at


def torch(at, length):
    """(x, y of the tip across the tube, z, B deg, angle of the torch's plane in deg): the pivot less the arm, turned back by A."""
    b, up = math.radians(at.get("B", 0.0)), math.radians(at["A"])
    across, out = -at["Y"], at["Z"] - length * math.cos(b)
    return (out * math.cos(up) - across * math.sin(up), out * math.sin(up) + across * math.cos(up), at["X"] - length * math.sin(b), math.degrees(b), at["A"])


def off(at, line):
    """mm from a place to a line of straight pieces."""
    def one(a, b):
        way = (b[0] - a[0], b[1] - a[1])
        square = way[0]**2 + way[1]**2
        share = max(0.0, min(1.0, ((at[0] - a[0]) * way[0] + (at[1] - a[1]) * way[1]) / square)) if square else 0.0
        return math.dist(at, (a[0] + share * way[0], a[1] + share * way[1]))
    return min(map(one, line, line[1:]))


def cuts_of(program):
    """[(title, the places of its blocks while the torch cuts)]"""
    texts = re.split(r"(?m)^(?=\(cut: )", program)[1:]
    return [(text.splitlines()[0], [at for at, took in moves(text) if took]) for text in texts]


LASER = {"preset": "tube_laser"}
BEVEL = {"root_surface": "inner", "groove": {"rule": "half_dihedral"}, "torch": {"min_deg": -60, "max_deg": 60},
         "smoothing": {"method": "envelope", "limits": {"max_slope_deg_per_mm": 5, "max_curvature_deg_per_mm2": 1}}}


def end_of(target, cut):
    return {"target": target, "cutters": [{"kind": "tube", "outer_diameter_mm": 168.3, "inclination_deg": 75, "clocking_deg": 20, "offset_mm": 0}],
            "kerf_mm": 0.4, **cut}


def drawn(dice, k):
    """The end of a rectangular tube, every fifth of a flat oval one; every third bevelled."""
    wall = dice.uniform(2, 8)
    corner = wall * dice.uniform(1.1, 2.5)
    target = {"kind": "rectangular_tube", "height_mm": 2 * corner + dice.uniform(5, 80), "width_mm": 2 * corner + dice.uniform(5, 80),
              "wall_mm": wall, "corner_radius_mm": corner}
    if k % 5 == 4:
        target = {"kind": "flat_oval_tube", "height_mm": dice.uniform(30, 60), "width_mm": dice.uniform(70, 120), "wall_mm": wall}
    return end_of(target, LASER if k % 3 else BEVEL)


class SectionProgram(FormatTest):
    def follow(self, name, body, length, more="", height=0.0):
        answer = self.service.answer("bevel-tables", body)
        s, points = answer["result"]["section"], answer["result"]["points"]
        outline = Outline(s["height_mm"], s["width_mm"], s["corner_radius_mm"])
        self.assertAlmostEqual(outline.whole(), s["girth_mm"], delta=1e-9)
        line = line_of(points, s["girth_mm"])
        program = self.service.text("bevel-tables", body, f"format=gcode&speed_mm_min=900&pivot_length_mm={length}{more}").decode("ascii")
        self.assertIn(f"(tube {round(s['height_mm'], 2):g} x {round(s['width_mm'], 2):g} x {round(s['wall_mm'], 2):g} mm, corners", program)
        blocks = [at for at, took in moves(program) if "A" in at]
        worst, leaned, seen = 0.0, 0.0, set()
        for before, after in zip(blocks, blocks[1:]):
            samples = max(SAMPLES, int(4 * math.dist(*([at[axis] for axis in "XYZ"] for at in (before, after)))))
            for k in range(samples + 1):
                share = (k + 1) / (samples + 1)
                at = {axis: before.get(axis, v) + share * (v - before.get(axis, v)) for axis, v in after.items()}
                x, y, z, b, up = torch(at, length + height)
                off, normal, girth = outline.foot(x, y)
                worst = max(worst, abs(off))
                leaned = max(leaned, abs((up - normal + 180) % 360 - 180))
                on_line = [(abs(z - wanted), abs(b - math.degrees(math.atan(slope)))) for wanted, slope in line(girth)]
                near = min(on_line, default=(9, 9))
                if near[0] <= SAG + 1e-3 and near[1] < 0.3:  # else on a lead, or a stretch that is then not seen
                    seen.add(int(girth))
        print(f"{name}: {len(blocks)} blocks, at most {worst:.4f} mm off, lean {leaned:.3f} deg")
        self.assertLessEqual(worst, SAG + 1e-3, name)
        self.assertLessEqual(leaned, LEAN + 1e-3, name)
        self.assertGreaterEqual(len(seen), int(s["girth_mm"]) - 2, f"{name}: a stretch of the girth is not cut")
        return program

    def test_the_tip_stays_on_the_outside_and_the_cut_on_its_line(self):
        dice = random.Random(52)
        for k in range(10):
            self.follow(f"{k}", drawn(dice, k), [0, 120][k % 2], "&lead_mm=3" if k % 2 else "")

    def test_flats_have_room_for_leads(self):
        dice, refused = random.Random(5), 0
        for k in range(60):
            status, _, content = self.service.ask("bevel-tables", drawn(dice, k), "format=gcode&speed_mm_min=900&pivot_length_mm=0&lead_mm=2")
            if status == 200:
                self.assertNotIn(b"has no room for more", content)
            else:
                self.assertIn(b"would enter the part", content)
                refused += 1
        self.assertEqual(refused, 0)

    def test_it_names_the_axes_and_lifts_clear_of_the_corners(self):
        body = end_of({"size": "SHS 100x100x5 EN 10219"}, LASER)
        program = self.follow("SHS 100", body, 0, "&clearance_mm=30&lead_mm=3&torch=on&acknowledge=root_opens&pierce_height_mm=1.5&pierce_delay_s=0.2&cut_height_mm=1.5", 1.5)
        self.assertIn("(A keeps the normal of the wall up, Y and Z follow the wall, Y0: over the axis of the tube, face 2 lies to -Y)", program)
        reach = math.hypot(40, 40) + 10
        self.assertIn(f"G0 Z{reach + 30:.5f}", program)
        self.assertEqual(program.count("M3 S1"), 1)

    def test_a_parts_program_cuts_its_openings_square_and_both_ends(self):
        """In the order of the answer: each opening on its torch line, square to its face, with the pierce within it; then the finish and the start."""
        dice = random.Random(11)
        for k in range(6):
            body = self.part(dice, k)
            result = self.service.answer("parts", body)["result"]
            s = result["section"]
            outline, girth = Outline(s["height_mm"], s["width_mm"], s["corner_radius_mm"]), s["girth_mm"]
            length = [0, 120][k % 2]
            program = self.service.text("parts", body, f"format=gcode&speed_mm_min=900&pivot_length_mm={length}&lead_mm=2").decode("ascii")
            cuts = cuts_of(program)
            groups = {(g["id"], one["id"], g["side"]): (g, one) for g in result["cutouts"] for one in g["instances"]}
            flat = [(g, one) for g in result["cutouts"] for one in g["instances"]]
            steps = [step for step in result["sequence"] if step["what"] != "mark"]
            self.assertEqual(len(cuts), len(steps))
            self.assertEqual(len(groups), len(flat))
            for step, (name, blocks) in zip(steps, cuts):
                self.assertIn({"cutout": "cut-out"}.get(step["what"], step["what"]), name)
                torches = [torch(at, length) for at in blocks]
                for x, y, *_ in torches:
                    self.assertLessEqual(abs(outline.foot(x, y)[0]), SAG + 1e-3, name)
                if step["what"] == "cutout":
                    self.opening(name, *flat[step["index"]], torches, outline, girth)
                else:
                    self.end(name, result["ends"][step["what"]], torches, outline, girth)

    def test_narrow_windows_have_leads(self):
        """Square corners, rounded by half the kerf or not at all, turned or not: there is no opening without room for its lead."""
        for kerf in (0.3, 1.5):
            shapes = [{"kind": "rectangle", "along_mm": length, "round_mm": width, "angle_deg": turn, **corner} for width in (3, 4, 8) for length in (width, 10, 40)
                      if length >= width for turn in (0, 90, 37) for corner in ({}, {"corners": "as_cut", "corner_radius_mm": 0})]
            body = {**LASER, "target": {"size": "SHS 100x100x5 EN 10219", "length_mm": 60 * len(shapes) + 60}, "kerf_mm": kerf,
                    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                    "cutouts": [{"id": str(k), "shape": shape, "at": {"z_mm": 60 * k + 60, "face": 1}} for k, shape in enumerate(shapes)]}
            groups = self.service.answer("parts", body)["result"]["cutouts"]
            program = self.service.text("parts", body, "format=gcode&speed_mm_min=900&pivot_length_mm=0&lead_mm=5").decode("ascii")
            cuts = {re.search(r"cut-out (\d+)", name).group(1): blocks for name, blocks in cuts_of(program) if "cut-out" in name}
            self.assertEqual(len(cuts), len(shapes))
            for group in groups:
                inside = [(s, z) for s, z in zip(group["points"]["torch_girth_mm"], group["points"]["torch_z_mm"])]
                low, high = ([pick(at[axis] for at in inside) for axis in (0, 1)] for pick in (min, max))
                for at in cuts[group["id"]]:
                    x, y, z, *_ = torch(at, 0)
                    self.assertTrue(low[0] - 0.12 <= y <= high[0] + 0.12 and low[1] - 0.12 <= z <= high[1] + 0.12, f"{group['id']}: {at}")

    def test_leads_of_windows_stay_off_the_window_that_was_drawn(self):
        """Its straight sides and arcs, not the rows: wherever the overcut ends, and however large the lead is against the corner."""
        dice, worst, middles, windows = random.Random(15), -9.0, 0, 150
        wanted = [({"kind": "rectangle", "along_mm": 12, "round_mm": 20, "corner_radius_mm": 2}, 0.2, 2, None),
                  ({"kind": "rectangle", "along_mm": 80, "round_mm": 30, "corner_radius_mm": 2}, 0.3, 4, 39.83)]
        for k in range(windows):
            shape, kerf, lead, overcut = wanted[k] if k < len(wanted) else drawn_parts.window(dice)
            tolerance = 0.01 if k < len(wanted) else dice.choice([0.002, 0.01, 0.05])
            body = {**LASER, "target": {"size": "SHS 100x100x5 EN 10219", "length_mm": 400}, "kerf_mm": kerf, "sampling": {"tolerance_mm": tolerance},
                    "ends": {"start": {"square_at_mm": 0}, "finish": {"square_at_mm": 0}},
                    "cutouts": [{"id": "w", "shape": shape, "at": {"z_mm": 200, "face": 1}}]}
            more = f"&lead_mm={lead}" + ("" if overcut is None else f"&overcut_mm={overcut}")
            with self.subTest(f"{more} {json.dumps(body)}"):
                program = self.service.text("parts", body, f"format=gcode&speed_mm_min=600&pivot_length_mm=0{more}").decode("ascii")
                places = [torch(at, 0) for at in next(blocks for name, blocks in cuts_of(program) if "cut-out" in name)]
                beyond = [drawn_parts.beyond_window(shape, z - 200, y) + kerf / 2 for _, y, z, *_ in places]
                middles += "from the middle of the scrap" in program
                worst = max(worst, *beyond)
                self.assertLess(max(beyond), 0.02 + tolerance + 1e-3)
        print(f"{windows} windows, {middles} from the middle; at most {worst:.4f} mm beyond the edge")
        self.assertLess(middles, 0.4 * windows)

    def opening(self, name, group, one, torches, outline, girth):
        first = group["instances"][0]
        line = [(s + one["girth_mm"] - first["girth_mm"], z + one["z_mm"] - first["z_mm"])
                for s, z in zip(group["points"]["torch_girth_mm"], group["points"]["torch_z_mm"])]
        line.append(line[0])
        face = [0, 90, 180, 270][one["face"] - 1]
        seen = 0
        for x, y, z, b, up in torches:
            self.assertLess(abs((up - face + 180) % 360 - 180), 1e-6, f"{name}: not square to its face")
            self.assertLess(abs(b), 1e-9)
            s = outline.foot(x, y)[2]
            near = min(off((s + turn * girth, z), line) for turn in (-1, 0, 1))
            seen += near < 2e-3
        self.assertGreater(seen, 4, f"{name}: the cut is not on its line")
        covered = [min(math.dist(at, ((outline.foot(x, y)[2] - at[0] + girth / 2) % girth - girth / 2 + at[0], z)) for x, y, z, *_ in torches) for at in line]
        self.assertLess(max(covered), 2e-3, f"{name}: a row is left out")

    def end(self, name, end, torches, outline, girth):
        line = line_of(end["points"], girth)
        seen = set()
        for x, y, z, *_ in torches:
            s = outline.foot(x, y)[2]
            if min((abs(z - wanted) for wanted, _ in line(s)), default=9) <= SAG + 1e-3:
                seen.add(int(4 * s / girth) % 4)
        self.assertEqual(seen, {0, 1, 2, 3}, f"{name}: a quarter of the girth is not cut")

    @staticmethod
    def part(dice, k):
        body = drawn(dice, 1 if k % 5 == 4 else k)
        target = body["target"] | {"height_mm": 70, "width_mm": 60, "length_mm": 700, "wall_mm": 3, "corner_radius_mm": 6}
        end = {key: value for key, value in body.items() if key not in ("target", "kerf_mm", "preset", "torch")}
        shapes = [{"kind": "circle", "diameter_mm": dice.choice([4.5, 5, dice.uniform(6, 20)])},
                  {"kind": "slot", "length_mm": 24, "width_mm": dice.uniform(6, 12), "angle_deg": dice.uniform(0, 360)},
                  {"kind": "rectangle", "along_mm": 30, "round_mm": 16, "corner_radius_mm": 2}]
        cutouts = [{"id": f"c{i}", "shape": shape, "wall": ["through", "normal"][i % 2],
                    "at": {"z_mm": 250 + 80 * i, "face": dice.randint(1, 4), "offset_mm": dice.uniform(-4, 4)}} for i, shape in enumerate(shapes)]
        return {"target": target, "ends": {"start": end, "finish": end}, "kerf_mm": 0.4, "cutouts": cutouts,
                **{key: body[key] for key in ("preset", "torch") if key in body}}

    def test_a_tube_tables_process_gives_what_the_request_leaves_out(self):
        body = json.loads((ROOT / "examples/parts/shs-base-post.json").read_text())
        table = next(m for m in json.loads(self.service.get("/v1/machines"))["machines"] if m["machine"]["name"] == "tube_table")
        taken = self.service.text("parts", body, "format=gcode&torch=on&acknowledge=root_opens&machine=tube_table&material=steel").decode("ascii")
        self.assertIn("(machine: tube_table, table ", taken)
        speed = float(re.search(r"#<speed_mm_min> = ([\d.]+)", taken).group(1))
        self.assertIn(speed, [row["speed_mm_min"] for row in table["process"]["rows"]])

    def test_what_it_needs_is_said_at_its_option(self):
        body = end_of({"size": "SHS 100x100x5 EN 10219"}, LASER)
        for query, option, word in [("", "?pivot_length_mm", "height of the wall"), ("&pivot_length_mm=0&tabs=2&tab_mm=2&lead_mm=3", "?tabs", "one pass"),
                                    ("&pivot_length_mm=0&start_deg=10", "?start_deg", "one pass"),
                                    ("&pivot_length_mm=0&passes=both", "?passes", "one pass"),
                                    ("&machine=five_axis_cutter&material=steel", "?machine", "five_axis_cutter has no axis across")]:
            status, _, content = self.service.ask("bevel-tables", body, "format=gcode&speed_mm_min=900" + query)
            error = json.loads(content)["errors"][0]
            self.assertEqual((status, error["pointer"]), (422, option), content)
            self.assertIn(word, error["hint"])


if __name__ == "__main__":
    main()
