"""Cuts parts by FreeCAD from /v1/parts answers alone, places them in the world by their frames, and measures what they share.

`freecadcmd cut_parts.py`, with the files in PARTS (answers, {id: body}) and REPORT (what was found)."""

import json
import math
import os
import sys
import time

import FreeCAD
import Part

MARGIN = 1.0  # mm by which a tool reaches beyond the wall


def point(radius, phi, z):
    return FreeCAD.Vector(radius * math.cos(phi), radius * math.sin(phi), z)


def triangle(a, b, c):
    return Part.Face(Part.makePolygon([a, b, c, a]))


def patch(a, b, c, d):
    """Four triangles about the middle: a ruled patch bends, its middle lies where it should."""
    middle = (a + b + c + d) * 0.25
    return [triangle(a, b, middle), triangle(b, c, middle), triangle(c, d, middle), triangle(d, a, middle)]


def closed(faces):
    solid = Part.Solid(Part.makeShell(faces))
    if solid.Volume < 0:
        solid.reverse()
    return solid


def beyond(inner, outer, wall):
    """The wall's line from edge to edge, continued by the margin on both sides."""
    slope = (outer - inner) / wall
    return inner - MARGIN * slope, outer + MARGIN * slope


def end_tool(end, target, floor):
    """All that falls away at an end: below (or above) the ruled surface through its two edges."""
    r_out = target["outer_diameter_mm"] / 2
    wall = target["wall_mm"]
    p = end["points"]
    rows = []
    for phi, low, high in zip(p["phi_deg"], p["z_inner_mm"], p["z_outer_mm"]):
        a, b = beyond(low, high, wall)
        turn = math.radians(phi)
        rows.append((point(r_out - wall - MARGIN, turn, a), point(r_out + MARGIN, turn, b),
                     point(r_out + MARGIN, turn, floor), point(r_out - wall - MARGIN, turn, floor)))
    faces = []
    for here, there in zip(rows, rows[1:] + rows[:1]):
        for k in range(4):
            a, b = here[k], here[(k + 1) % 4]
            c, d = there[(k + 1) % 4], there[k]
            if k == 0:
                faces += patch(a, b, c, d)
            else:
                faces.append(Part.Face(Part.makePolygon([a, b, c, d, a])))
    return closed(faces)


def hole_tool(hole, target):
    r_out = target["outer_diameter_mm"] / 2
    wall = target["wall_mm"]
    p = hole["points"]
    low, high = [], []
    for phi, z, phi_in, z_in in zip(p["phi_deg"], p["z_mm"], p["phi_inner_deg"], p["z_inner_mm"]):
        outer, inner = point(r_out, math.radians(phi), z), point(r_out - wall, math.radians(phi_in), z_in)
        along = (outer - inner) * (3.0 / wall)
        low.append(inner - along)
        high.append(outer + along)
    faces = []
    n = len(low)
    for i in range(n):
        j = (i + 1) % n
        faces += patch(low[i], low[j], high[j], high[i])
    for ring in (low, high):
        middle = sum(ring, FreeCAD.Vector()) * (1.0 / n)
        faces += [triangle(ring[i], ring[(i + 1) % n], middle) for i in range(n)]
    return closed(faces)


def cut(body):
    request, result = body["request"], body["result"]
    target = next(m for m in request["members"] if m["id"] == request["member"])
    r_out, wall, length = target["outer_diameter_mm"] / 2, target["wall_mm"], result["lengths"]["long_mm"]
    groups = by_place(result["holes"])
    borders = [-40.0] + [(a[1] + b[0]) / 2 for a, b in zip(groups, groups[1:])] + [length + 40.0]
    pieces = [tube(r_out, wall, low, high) for low, high in zip(borders, borders[1:])]
    pieces[-1] = pieces[-1].cut(end_tool(result["ends"]["finish"], target, length + 60))
    pieces[0] = pieces[0].cut(end_tool(result["ends"]["start"], target, -60))
    for i, (_, _, holes) in enumerate(groups):
        for hole in holes:
            pieces[i] = pieces[i].cut(hole_tool(hole, target))
    return pieces


def tube(r_out, wall, low, high):
    along, base = FreeCAD.Vector(0, 0, 1), FreeCAD.Vector(0, 0, low)
    return Part.makeCylinder(r_out, high - low, base, along).cut(Part.makeCylinder(r_out - wall, high - low, base, along))


def by_place(holes):
    """[(from, to, holes)] along the part, apart from each other; a long chord is cut piece by piece, for speed."""
    groups = [(0.0, 0.0, [])]
    for hole in sorted(holes, key=lambda h: min(h["points"]["z_mm"])):
        low, high = min(hole["points"]["z_mm"]), max(hole["points"]["z_mm"])
        if groups[-1][2] and low < groups[-1][1] + 100:
            groups[-1] = (groups[-1][0], max(high, groups[-1][1]), groups[-1][2] + [hole])
        elif not groups[-1][2]:
            groups[-1] = (low, high, [hole])
        else:
            groups.append((low, high, [hole]))
    return groups


def placed(solid, frame):
    x, y, z, o = frame["x"], frame["y"], frame["z"], frame["origin_mm"]
    matrix = FreeCAD.Matrix(x[0], y[0], z[0], o[0], x[1], y[1], z[1], o[1], x[2], y[2], z[2], o[2], 0, 0, 0, 1)
    return solid.transformed(matrix)


def main():
    bodies = json.load(open(os.environ["PARTS"], encoding="utf-8"))
    solids, report = {}, {"volumes": {}, "common": [], "invalid": []}
    for name, body in bodies.items():
        begin = time.time()
        own = cut(body)
        volume = sum(piece.Volume for piece in own)
        report["volumes"][name] = [volume, body["result"]["lengths"]["volume_mm3"]]
        if not all(piece.isValid() and len(piece.Solids) == 1 for piece in own):
            report["invalid"].append(f"{name}: not one valid solid")
        solids[name] = [placed(piece, body["result"]["frame"]) for piece in own]
        print(f"{name}: {volume:.0f} mm^3, answered {body['result']['lengths']['volume_mm3']:.0f}, {time.time() - begin:.1f} s", flush=True)
    names = list(solids)
    for i, a in enumerate(names):
        for b in names[i + 1:]:
            near = [(p, q) for p in solids[a] for q in solids[b] if p.BoundBox.intersect(q.BoundBox)]
            if near:
                report["common"].append([a, b, sum(p.common(q).Volume for p, q in near)])
                print(f"{a} and {b} share {report['common'][-1][2]:.3f} mm^3", flush=True)
    json.dump(report, open(os.environ["REPORT"], "w", encoding="utf-8"))


main()
sys.stdout.flush()
os._exit(0)
