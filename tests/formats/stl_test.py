"""The STL of a cut end read by admesh: no defect, and the volume of the table within the stated facet error."""

import math
import pathlib
import re
import struct
import subprocess
import tempfile

from service import FormatTest, examples, main

DEFECTS = ("Total disconnected facets", "Degenerate facets", "Edges fixed", "Facets removed", "Facets added",
           "Facets reversed", "Backwards edges", "Normals fixed")


def admesh(content):
    """({defect: count}, parts, volume)"""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "cut.stl")
        file.write_bytes(content)
        # It prints the bytes after the 80 bytes of the header in its memory, too.
        said = subprocess.run(["admesh", file], capture_output=True, text=True, errors="replace", check=True).stdout
    counts = {name: int(re.search(rf"{name}\s*:\s*(\d+)", said)[1]) for name in DEFECTS}
    return counts, int(re.search(r"Number of parts\s*:\s*(\d+)", said)[1]), float(re.search(r"Volume\s*:\s*([-\d.]+)", said)[1])


def facets(content):
    count, = struct.unpack_from("<I", content, 80)
    if len(content) != 84 + 50 * count:
        raise AssertionError("a torn file")
    for i in range(count):
        v = struct.unpack_from("<12f", content, 84 + 50 * i)
        yield v[3:6], v[6:9], v[9:12]


def area(content):
    def one(a, b, c):
        u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
        return math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
    return sum(one(*f) for f in facets(content))


def wall_volume(table, inner, outer, far):
    """Of the wall between the cut, straight across it, and z = far; straight between rows."""
    def below(i):  # integral of z(r) r over the wall
        z0, slope = table["z_inner_mm"][i], (table["z_outer_mm"][i] - table["z_inner_mm"][i]) / (outer - inner)
        return (z0 - slope * inner) * (outer**2 - inner**2) / 2 + slope * (outer**3 - inner**3) / 3
    phi, n = [math.radians(p) for p in table["phi_deg"]], len(table["phi_deg"])
    total = 0.0
    for i in range(n):
        step = (phi[(i + 1) % n] + (2 * math.pi if i + 1 == n else 0.0)) - phi[i]
        total += step * (far * (outer**2 - inner**2) / 2 - (below(i) + below((i + 1) % n)) / 2)
    return total


class Stl(FormatTest):
    def check(self, name, body, volume=True):
        content = self.service.text("bevel-tables", body, "format=stl")
        header = content[:80].decode()
        self.assertIn("unit mm", header)
        error = float(re.search(r"facets within ([\d.]+) mm", header)[1])
        counts, parts, got = admesh(content)
        self.assertEqual({k: v for k, v in counts.items() if v}, {}, name)
        self.assertEqual(parts, 1)
        if not volume:
            return
        answer = self.service.answer("bevel-tables", body)
        target = answer["request"]["target"]
        outer = target["outer_diameter_mm"] / 2
        far = max(p[2] for f in facets(content) for p in f)
        wanted = wall_volume(answer["result"]["points"], outer - target["wall_mm"], outer, far)
        self.assertGreater(wanted, 0.0)
        self.assertLess(abs(got - wanted), error * area(content), name)
        print(f"{name}: volume {got:.1f} mm3, off by {abs(got - wanted):.2f}, allowed {error * area(content):.2f}")

    def test_every_example(self):
        for name, body in examples("bevel-tables").items():
            with self.subTest(name):
                plain = "target" in body and "root_face_mm" not in body
                self.check(name, body, plain)

    def test_a_jump_along_a_generator(self):
        """A partner lost at its silhouette: two rows at one phi."""
        tubes = ((110, 78, 10, 22, -4), (60, 50, 200, -18, 7), (30, 62, 290, 25, 85), (48, 118, 75, 12, -9))  # golden `eccentric`
        names = ("inclination_deg", "clocking_deg", "offset_mm", "height_mm")
        body = {"target": {"outer_diameter_mm": 120, "wall_mm": 6},
                "cutters": [{"kind": "tube", "outer_diameter_mm": 2 * r, **dict(zip(names, place))} for r, *place in tubes],
                "sampling": {"tolerance_mm": 0.05}, "root_surface": "outer", "contact": "none", "groove": {"rule": "half_dihedral"},
                "kerf_mm": 0, "smoothing": {"method": "none"}}
        phi = self.service.answer("bevel-tables", body)["result"]["points"]["phi_deg"]
        self.assertTrue(any(a == b for a, b in zip(phi, phi[1:])), "no jump in it")
        self.check("jump", body)

    def test_smallest_and_largest(self):
        base = examples("bevel-tables")["source-000-table-1"]
        for factor in (5 / 70, 5000 / 110):
            body = {**base, "target": {"outer_diameter_mm": 70 * factor, "wall_mm": min(200, max(0.5, 5 * factor))},
                    "cutters": [{**c, "outer_diameter_mm": c["outer_diameter_mm"] * factor, "offset_mm": c.get("offset_mm", 0) * factor}
                                for c in base["cutters"]], "sampling": {"uniform_points": 360}}
            self.check(f"times {factor:.3f}", body)


if __name__ == "__main__":
    main()
