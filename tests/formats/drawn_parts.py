"""Parts drawn by a seed: requests to /v1/parts, both ends and up to six holes, from 5 mm to 2 m across."""

import math


def plane_or_tube(r, outer):
    """What an end is cut by: a mitre plane, or a tube larger than the part."""
    turn = r.uniform(0, 2 * math.pi)
    if r.random() < 0.35:
        lean = math.radians(r.uniform(2, 45))
        normal = [math.sin(lean) * math.cos(turn), math.sin(lean) * math.sin(turn), math.cos(lean)]
        return {"kind": "plane", "point_mm": [0, 0, 0], "normal": normal}
    return {"kind": "tube", "outer_diameter_mm": 2 * outer * r.uniform(1.25, 3), "inclination_deg": r.uniform(40, 140),
            "clocking_deg": r.uniform(0, 360), "offset_mm": outer * r.uniform(-0.15, 0.15)}


def end(r, outer, wall):
    if r.random() < 0.25:
        return {"square_at_mm": round(r.uniform(0, outer), 3)}
    cutters = [plane_or_tube(r, outer)]
    if r.random() < 0.3:
        cutters.append(plane_or_tube(r, outer))
    out = {"cutters": cutters, "root_surface": "inner", "groove": r.choice([{"rule": "square"}, {"rule": "half_dihedral"}, {"rule": "none"}]),
           "contact": "inner",
           "smoothing": r.choice([{"method": "none"}, {"method": "envelope", "limits": {"max_slope_deg_per_mm": 100 / outer, "max_curvature_deg_per_mm2": 1000 / outer**2}}])}
    if r.random() < 0.2:
        out["root_face_mm"] = round(0.2 * wall, 3)
    return out


def hole(r, outer, wall, at):
    share = r.uniform(max(0.2, 2.6 / outer), 0.75)
    kind = r.choice(["set_on", "set_in", "through"])
    branch = 2 * outer * share
    out = {"branch": {"outer_diameter_mm": branch, "wall_mm": min(0.2 * branch, wall), "inclination_deg": r.uniform(60, 120),
                      "clocking_deg": r.uniform(0, 360), "offset_mm": outer * r.uniform(-0.1, 0.1), "height_mm": at},
           "joint": {"kind": kind, "gap_mm": round(0.02 * wall, 4)}, "tilt": r.choice(["axial", "free"]),
           "groove": {"rule": r.choice(["none", "half_dihedral"] if kind == "set_on" else ["none", "half_dihedral", "square"])}}
    return out, branch / math.sin(math.radians(60)) + 1.2 * outer


def part(r):
    """One request; the sampling's tolerance is its own, so that rows are near each other or far apart."""
    outer = math.exp(r.uniform(math.log(2.5), math.log(1000)))
    wall = max(0.5, outer * r.uniform(0.04, 0.25))
    count = r.choice([0, 0, 1, 1, 2, 3, 4, 5, 6]) if outer > 4 else 0
    holes, at = [], 4.5 * outer
    for _ in range(count):
        one, room = hole(r, outer, wall, at)
        holes.append(one)
        at += room
    out = {"target": {"outer_diameter_mm": 2 * outer, "wall_mm": wall, "length_mm": at + 4.5 * outer},
           "ends": {"start": end(r, outer, wall), "finish": end(r, outer, wall)}, "kerf_mm": 0.0,
           "datum": "seam", "seam_deg": 0,
           "torch": {"min_deg": -85, "max_deg": 85},
           "sampling": r.choice([{"tolerance_mm": 0.001}, {"tolerance_mm": 0.001}, {"tolerance_mm": 0.01}, {"tolerance_mm": 0.05}, {"uniform_points": 360}])}
    if holes:
        out["holes"] = holes
    return out


def window(r):
    """(a rectangle with rounded corners, kerf_mm, lead_mm, overcut_mm or None): often an overcut that ends in a corner."""
    along, wide, corner, kerf = r.choice([12, 20, 30, 40, 60, 80]), r.choice([12, 20, 30, 40, 60]), r.choice([1, 2, 3, 4, 5, 6]), r.choice([0.2, 0.3, 1, 1.5])
    corner = max(corner, kerf)  # half of it would leave the beam no room on the inner wall
    lead = r.choice([1, 2, 3, 4, 6, corner, 1.1 * corner, 1.5 * corner, 2 * corner])
    overcut = r.choice([None, r.uniform(0, 30), along / 2 - corner + 1.6 * corner * r.random(), wide / 2 - corner + 1.6 * corner * r.random()])
    return {"kind": "rectangle", "along_mm": along, "round_mm": wide, "corner_radius_mm": corner}, kerf, round(lead, 3), overcut


def beyond_window(shape, x, y):
    """How far a place from the middle of a drawn window, along and round, is beyond its edge, by its sides and arcs; negative: within it."""
    corner = shape["corner_radius_mm"]
    qx, qy = abs(x) - (shape["along_mm"] / 2 - corner), abs(y) - (shape["round_mm"] / 2 - corner)
    return math.hypot(max(qx, 0), max(qy, 0)) + min(max(qx, qy), 0) - corner
