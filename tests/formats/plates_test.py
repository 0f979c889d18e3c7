"""The files of a frame's plates: DXF read by ezdxf, NC1 line by line, STEP by a reader of its own, all against the answer."""

import io
import json
import math
import pathlib
import tempfile
import zipfile

import ezdxf
import numpy as np

import step_reader
import step_volume
from service import FormatTest, examples, main

QUERY = "format=zip&files=dxf,nc1,work-order"


def read(content):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "plate.dxf")
        file.write_bytes(content)
        return ezdxf.readfile(file)


def area(points):
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1]))


def enclosed(entity):
    """Area of a circle or of a polyline with bulges."""
    if entity.dxftype() == "CIRCLE":
        return math.pi * entity.dxf.radius ** 2
    rows = list(entity.get_points("xyb"))
    out = area([(x, y) for x, y, _ in rows])
    for (x, y, bulge), (u, v, _) in zip(rows, rows[1:] + rows[:1]):
        if bulge:
            sweep = 4 * math.atan(bulge)
            radius = math.dist((x, y), (u, v)) / (2 * math.sin(abs(sweep) / 2))
            out += math.copysign(radius ** 2 * (abs(sweep) - math.sin(abs(sweep))) / 2, sweep)
    return out


def blocks(text):
    """[(name, lines)] of an NC1 file, without its comments."""
    out = []
    for line in text.replace("\r", "").splitlines():
        if line.startswith("**"):
            continue
        if not line.startswith(" ") and line[:2].isalpha():
            out.append((line[:2], []))
        elif out:
            out[-1][1].append(line)
    return out


def leaning():
    """A brace through a thick plate, running down."""
    return {
        "preset": "tube_laser", "kerf_mm": 0.2, "sampling": {"tolerance_mm": 0.1},
        "members": [{"id": "B", "start_mm": [300, 0, 300], "end_mm": [-300, 0, -400], "outer_diameter_mm": 60.3, "wall_mm": 4}],
        "plates": [{"id": "T", "point_mm": [0, 0, 0], "normal": [0, 0, 1], "up": [0, 1, 0], "thickness_mm": 30,
                    "outline": {"kind": "rectangle", "width_mm": 300, "height_mm": 200, "corner_radius_mm": 12}}],
        "joints": [{"between": ["B", "T"], "kind": "through", "gap_mm": 1}]}


class Plates(FormatTest):
    def packet(self, body):
        with zipfile.ZipFile(io.BytesIO(self.service.text("frames", body, QUERY))) as opened:
            return {name: opened.read(name) for name in opened.namelist()}

    def plates(self, body):
        """[(row of the answer, {format: content})]"""
        rows = {row["plate"]: row for row in self.service.answer("frames", body)["result"]["plates"]}
        files = self.packet(body)
        said = json.loads(files["manifest.json"])["plates"]
        self.assertEqual([one["plate"] for one in said], list(rows))
        for one in said:
            self.assertEqual([left["format"] for left in one["left_out"]], ["work-order"])
            self.assertEqual(one["quantity"], rows[one["plate"]]["count"])
        return [(rows[one["plate"]], {file["format"]: files[file["name"]] for file in one["files"]}) for one in said]

    def test_the_drawing_has_the_area_of_the_answer(self):
        looked = 0
        for body in (examples("frames")["post-on-base-plate"], leaning()):
            for row, files in self.plates(body):
                drawing = read(files["dxf"])
                audit = drawing.audit()
                self.assertEqual([e.message for e in audit.errors + audit.fixes], [])
                self.assertEqual(drawing.header["$INSUNITS"], 4)
                self.assertLessEqual({"CUT_OUTER", "CUT_INNER", "MARK", "TEXT"}, {layer.dxf.name for layer in drawing.layers})
                space = drawing.modelspace()
                [outline] = space.query('LWPOLYLINE CIRCLE[layer=="CUT_OUTER"]')
                holes = list(space.query('LWPOLYLINE CIRCLE[layer=="CUT_INNER"]'))
                marks = list(space.query('LWPOLYLINE CIRCLE[layer=="MARK"]'))
                self.assertEqual(len(holes), len(row["holes"]))
                self.assertEqual(len(marks), len(row["marks"]))
                self.assertAlmostEqual(enclosed(outline) - sum(map(enclosed, holes)), row["area_mm2"], delta=1e-3)
                looked += len(holes) + len(marks)
        self.assertGreater(looked, 6)

    def test_a_leaning_tube_has_room_through_the_whole_plate(self):
        [(row, files)] = self.plates(leaning())
        [hole] = read(files["dxf"]).modelspace().query('LWPOLYLINE[layer=="CUT_INNER"]')
        xs = [x for x, _ in hole.get_points("xy")]
        lean = math.atan2(600, 700)
        wide = 2 * (60.3 / 2 + 1) / math.cos(lean) + 30 * math.tan(lean)
        self.assertAlmostEqual(max(xs) - min(xs), wide, delta=1e-3)
        self.assertGreater(row["holes"][0]["greatest_gap_mm"], 10)

    def test_the_nc1_is_a_plate_with_bores_and_contours(self):
        for body in (examples("frames")["post-on-base-plate"], leaning()):
            for row, files in self.plates(body):
                text = files["nc1"].decode("ascii")
                said = blocks(text)
                head = [line.strip() for line in said[0][1]]
                self.assertEqual(head[7], "B")
                self.assertEqual([float(n) for n in head[8].split(",")], [row["width_mm"]] * 2)
                self.assertEqual(float(head[9]), row["height_mm"])
                self.assertEqual(float(head[12]), row["thickness_mm"])
                names = [name for name, _ in said]
                self.assertEqual((names[0], names[1], names[-1]), ("ST", "AK", "EN"))
                bores = [hole for hole in row["holes"] if hole.get("diameter_mm", 1e9) <= 200]
                self.assertEqual(names.count("BO"), len(bores))
                self.assertEqual(names.count("IK"), len(row["holes"]) - len(bores))
                left, low = (min(p[i] for p in self.places(row["outline"])) for i in (0, 1))
                for hole, (_, [line]) in zip(bores, (block for block in said if block[0] == "BO")):
                    x, y, diameter, _ = (float(n.rstrip("u")) for n in line.replace("v", " ").replace("u", " ").split())
                    self.assertAlmostEqual(x, hole["at_mm"][0] - left, delta=1e-3)
                    self.assertAlmostEqual(y, hole["at_mm"][1] - low, delta=1e-3)
                    self.assertAlmostEqual(diameter, hole["diameter_mm"], delta=1e-3)
                around = [self.outline(lines) for name, lines in said if name in ("AK", "IK")]
                for points in around:
                    self.assertEqual(points[0], points[-1])
                self.assertGreater(area(around[0]), 0)
                for points in around[1:]:
                    self.assertLess(area(points), 0)
                left_over = sum(map(area, around)) - sum(math.pi * hole["diameter_mm"] ** 2 / 4 for hole in bores)
                self.assertAlmostEqual(left_over, row["area_mm2"], delta=5)

    @staticmethod
    def places(contour):
        """Ends of its pieces, and of arcs those furthest to all sides that they pass."""
        out, last = [contour["start_mm"]], contour["start_mm"]
        for piece in contour["pieces"]:
            if piece["kind"] == "arc":
                (cx, cy), sense = piece["centre_mm"], 1 if piece["sense"] == "ccw" else -1
                radius = math.dist(last, (cx, cy))
                begin = math.atan2(last[1] - cy, last[0] - cx)
                sweep = sense * (math.atan2(piece["to_mm"][1] - cy, piece["to_mm"][0] - cx) - begin) % (2 * math.pi) or 2 * math.pi
                for k in range(101):
                    turn = begin + sense * sweep * k / 100
                    out.append([cx + radius * math.cos(turn), cy + radius * math.sin(turn)])
            out.append(piece["to_mm"])
            last = piece["to_mm"]
        return out

    @staticmethod
    def outline(lines):
        out = []
        for line in lines:
            x, y = line.replace("v", " ").replace("u", " ").split()[:2]
            out.append((float(x), float(y)))
        return out

    def test_the_cut_list_has_a_row_for_each_kind(self):
        body = examples("frames")["post-on-base-plate"]
        text = self.service.text("frames", body, "format=csv").decode()
        rows = [line for line in text.splitlines() if line.startswith(("BP1", "CP1", "W1"))]
        self.assertEqual([row.split(",")[1] for row in rows], ["2", "2", "1"])

    def test_the_assembly_has_a_solid_of_each_plate_at_its_place(self):
        for body in (examples("frames")["post-on-base-plate"], leaning()):
            rows = {name: row for row in self.service.answer("frames", body)["result"]["plates"] for name in row["ids"]}
            file = step_reader.File(self.service.text("frames", body, "format=step").decode("ascii"))
            used = {use[0]: use[1:] for use in step_reader.assembly(file)}
            self.assertEqual(set(used), {one["id"] for one in body["members"] + body["plates"]})
            for plate in body["plates"]:
                row, (product, brep, origin, axes) = rows[plate["id"]], used[plate["id"]]
                normal = np.array(plate["normal"]) / np.linalg.norm(plate["normal"])
                self.assertEqual(product, row["plate"])
                self.assertLess(np.abs(origin - plate["point_mm"]).max(), 1e-5)
                self.assertLess(np.abs(axes[2] - normal).max(), 1e-11)
                self.assertGreater(axes[1] @ plate["up"], 0)
                self.assertLess(abs(axes[0] @ plate["up"]), 1e-9)
                solid = step_reader.Solid(file, brep)
                self.assertEqual(step_reader.faults(solid, len(row["holes"])), [])
                self.assertAlmostEqual(step_volume.volume(solid) / (row["area_mm2"] * row["thickness_mm"]), 1, delta=1e-6)

    def test_a_plates_own_step_is_in_the_packet(self):
        body = leaning()
        with zipfile.ZipFile(io.BytesIO(self.service.text("frames", body, "format=zip&files=step"))) as opened:
            [text] = [opened.read(name) for name in opened.namelist() if name.startswith("T_") and name.endswith(".step")]
        [row] = self.service.answer("frames", body)["result"]["plates"]
        solid = step_reader.Solid(step_reader.File(text.decode("ascii")))
        self.assertEqual(step_reader.faults(solid, 1), [])
        self.assertEqual({face["name"] for face in solid.faces}, {"face", "back", "outline", "hole " + row["holes"][0]["part"]})


if __name__ == "__main__":
    main()
