"""The volume of a solid that step_reader has read, by integrals over its faces."""

import numpy as np
from step_reader import PLACES, WEIGHTS, Malformed, arc_of


def along_curve(edge, forward):
    """Places of an edge for an integral along it, and the weighted ways there, both as (x, y, z)."""
    kind, *about = edge["curve"]
    a, b = edge["points"]
    if kind == "spline":
        at, slope = about[0].at(about[0].within(PLACES))
        ways = slope * (np.diff(about[0].knots)[:, None] * WEIGHTS[None]).ravel()[:, None]
    elif kind in ("arc", "circle"):
        if kind == "arc":
            origin, _, x, y, radius, first, last = arc_of(edge)
        else:
            (origin, radius), (x, y, _) = about, np.eye(3)
            first, last = (np.arctan2(*(p - origin)[1::-1]) for p in (a, b))
            last += 2 * np.pi * (last < first + 1e-9)
        turn = (first + (last - first) * (np.arange(8)[:, None] + PLACES) / 8).ravel()[:, None]
        at = origin + radius * (np.cos(turn) * x + np.sin(turn) * y)
        ways = radius * (np.cos(turn) * y - np.sin(turn) * x) * np.tile(WEIGHTS, 8)[:, None] * (last - first) / 8
    else:
        at, ways = a + PLACES[:, None] * (b - a), WEIGHTS[:, None] * (b - a)
    return at, ways if forward else -ways


def under_plane(face, solid):
    """Integral of z over a plane's shadow, by Green's theorem along its loops, which run as seen from outside."""
    point, normal = face["surface"][1:]
    if abs(normal[2]) < 1e-9:
        return 0.0
    b, c = -normal[:2] / normal[2]
    total, a = 0.0, point[2] - b * point[0] - c * point[1]
    for loop in face["loops"]:
        for edge, forward in loop:
            at, ways = along_curve(solid.edges[edge], forward)
            x, y = at[:, 0], at[:, 1]
            total += np.sum((a * x + b * x * x / 2 + c * x * y) * ways[:, 1])
    return total


def under_bore(face, solid):
    """Integral of z over the shadow of a cylinder across the tube, between two arcs that lie straight over each other."""
    arcs = [solid.edges[edge] for edge, _ in face["loops"][0] if solid.edges[edge]["curve"][0] == "arc"]
    if len(arcs) != 2:
        raise Malformed("a cylinder across the tube that is not between two arcs")
    origin, z, x, y, radius, first, last = arc_of(arcs[0])
    turn = (first + (last - first) * (np.arange(8)[:, None] + PLACES) / 8).ravel()[:, None]
    weights = np.tile(WEIGHTS, 8) * (last - first) / 8
    out = np.cos(turn) * x + np.sin(turn) * y
    deep = abs((arc_of(arcs[1])[0] - origin) @ face["surface"][2])
    return np.sum(weights * (origin + radius * out)[:, 2] * out[:, 2]) * radius * deep


def under_cone(face, solid):
    """Integral of z over the shadow of a cone between two arcs about its axis, as if its normal left the axis."""
    arcs = [solid.edges[edge] for edge, _ in face["loops"][0] if solid.edges[edge]["curve"][0] == "arc"]
    if len(arcs) != 2:
        raise Malformed("a cone that is not between two arcs")
    origin, axis, _, radius, half = face["surface"][1:]
    heights = sorted((arc_of(arc)[0] - origin) @ axis for arc in arcs)
    _, z, x, y, _, first, last = arc_of(arcs[0])
    turn = (first + (last - first) * (np.arange(8)[:, None] + PLACES) / 8).ravel()[:, None]
    weights = np.tile(WEIGHTS, 8) * (last - first) / 8
    out = np.cos(turn) * x + np.sin(turn) * y
    total = 0.0
    for place, weight in zip(PLACES, WEIGHTS):
        height = heights[0] + place * (heights[1] - heights[0])
        wide = radius + height * np.tan(half)
        normal = wide * (out - np.tan(half) * axis)
        total += weight * (heights[1] - heights[0]) * np.sum(weights * (origin + height * axis + wide * out)[:, 2] * normal[:, 2])
    return total


def volume(solid):
    """Integral of z over the border's shadow: cylinders about z have none."""
    total = 0.0
    for face in solid.faces:
        kind, *about = face["surface"]
        sign = 1.0 if face["same"] else -1.0
        if kind == "plane":
            total += under_plane(face, solid)
        if kind == "bore":
            total += sign * under_bore(face, solid)
        if kind == "cone":
            total += sign * under_cone(face, solid)
        if kind == "ruled":
            p, d = about[0].at(about[0].within(PLACES))
            weights = (np.diff(about[0].knots)[:, None] * WEIGHTS[None]).ravel()
            across = p[:, 1] - p[:, 0]
            for v, weight in zip(PLACES, WEIGHTS):
                z = (1 - v) * p[:, 0, 2] + v * p[:, 1, 2]
                along = (1 - v) * d[:, 0] + v * d[:, 1]
                total += sign * weight * np.sum(weights * z * (along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0]))
    return total
