"""Cut ends of rectangular tubes against Open CASCADE: compare.py SERVER_BINARY CUT

Filleted boxes and their partners are drawn here, answered by the service, and given to CUT as numbers; it knows nothing of our formulas."""

import math
import random
import sys

from opencascade import answered, compared, held

WANTED = {"tube": 80, "plane": 60, "box": 80, "cone": 40, "several": 40}  # ends answered
STATIONS = 48
MOST = 2_000.0  # mm, of a cone to either side of its point
BOUNDS = {
    "line": 1e-9,   # mm along a line of the tube, where the surface is steeper than 3 deg to it
    "curve": 5e-3,  # mm, to the curve of the two solids, which Open CASCADE approximates
}


def section(r):
    height, width = r.uniform(30, 200), r.uniform(30, 200)
    wall = min(height, width) * r.uniform(0.04, 0.12)
    corner = min(0.5 * min(height, width), wall * r.uniform(1.2, 3))
    return {"kind": "rectangular_tube", "height_mm": height, "width_mm": width, "wall_mm": wall, "corner_radius_mm": corner}


def lean(r, most):
    """A direction within `most` deg of square to z."""
    up, turn = math.radians(r.uniform(-most, most)), r.uniform(0, 2 * math.pi)
    return [math.cos(up) * math.cos(turn), math.cos(up) * math.sin(turn), math.sin(up)]


def partner(r, kind, reach):
    """A cutter that meets all of a tube that reaches so far from its axis."""
    def point(by):
        return [r.uniform(-by, by) * reach for _ in range(3)]
    if kind == "tube":
        return {"kind": kind, "outer_diameter_mm": 2 * reach * r.uniform(1.3, 3), "axis": {"point_mm": point(0.1), "direction": lean(r, 50)}}
    if kind == "cone":
        return {"kind": kind, "outer_diameter_mm": 2 * reach * r.uniform(1.6, 3), "half_angle_deg": r.choice([-1, 1]) * r.uniform(2, 20),
                "axis": {"point_mm": point(0.1), "direction": lean(r, 40)}}
    if kind == "plane":
        tilt, turn = math.radians(r.uniform(0, 60)), r.uniform(0, 2 * math.pi)
        return {"kind": kind, "point_mm": point(0.5), "normal": [math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), math.cos(tilt)]}
    width, height = (2 * reach * r.uniform(1.5, 3) for _ in range(2))
    return {"kind": "rectangular_tube", "width_mm": width, "height_mm": height, "corner_radius_mm": min(width, height) * r.uniform(0.02, 0.2),
            "axis": {"point_mm": point(0.1), "direction": lean(r, 40)}, "up": [r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(0.5, 1)]}


def request(r, what):
    target = section(r)
    reach = 0.5 * math.hypot(target["height_mm"], target["width_mm"])
    kinds = [what] if what != "several" else [r.choice(["tube", "plane", "box", "cone"]) for _ in range(r.randint(2, 3))]
    return {"target": target, "cutters": [partner(r, kind, reach) for kind in kinds], "sampling": {"uniform_points": STATIONS}}


def numbers(*all_of_them):
    return " ".join(repr(float(one)) for one in all_of_them)


def partner_line(cutter):
    if cutter["kind"] == "plane":
        return "plane " + numbers(*cutter["point_mm"], *cutter["normal"])
    axis = cutter["axis"]
    where = numbers(*axis["point_mm"], *axis["direction"])
    if cutter["kind"] == "tube":
        return f"tube {where} {numbers(cutter['outer_diameter_mm'] / 2)}"
    if cutter["kind"] == "cone":
        return f"cone {where} {numbers(cutter['outer_diameter_mm'] / 2, math.radians(cutter['half_angle_deg']), MOST)}"
    return f"box {where} {numbers(*cutter['up'], cutter['height_mm'], cutter['width_mm'], cutter['corner_radius_mm'])}"


def lines(body, result):
    """One case as CUT reads it: partners, then of each surface its box and its points."""
    out = [str(len(body["cutters"])), *map(partner_line, body["cutters"])]
    sizes = result["section"]
    for profile in result["profiles"]:
        less = 2 * sizes["wall_mm"] if profile["surface"] == "inner" else 0.0
        corner = sizes["inner_corner_radius_mm"] if profile["surface"] == "inner" else sizes["corner_radius_mm"]
        points = profile["points"]
        out.append(numbers(sizes["height_mm"] - less, sizes["width_mm"] - less, corner) + f" {len(points['z_mm'])}")
        out += [f"{numbers(x, y, z)} {cutter}" for x, y, z, cutter in zip(points["x_mm"], points["y_mm"], points["z_mm"], points["cutter"])]
    return "\n".join(out) + "\n"


def main(server, program):
    r = random.Random(52)
    worst, failed = dict.fromkeys(BOUNDS, 0.0), False

    def drawn(what):
        body = request(r, what)
        result = answered(server, "intersections", body)
        return None if result is None else lines(body, result)
    for what, wanted in WANTED.items():
        most, counts = compared(what, wanted, lambda: drawn(what), program, BOUNDS)
        for name in BOUNDS:
            worst[name] = max(worst[name], most[name])
            failed |= counts[name] < wanted * STATIONS
    sys.exit(not held(worst, BOUNDS) or failed)


if __name__ == "__main__":
    main(*sys.argv[1:])
