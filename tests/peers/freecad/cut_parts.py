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
SAG = 0.01    # mm between a surface and the triangles a volume is taken of


def point(radius, phi, z):
    return FreeCAD.Vector(radius * math.cos(phi), radius * math.sin(phi), z)


def volume(shape, sag):
    """By its triangles: FreeCAD's own figure is an integral over trimmed faces, and off by parts in a thousand here."""
    points, triangles = shape.tessellate(sag)
    total = 0.0
    for a, b, c in triangles:
        total += points[a].dot(points[b].cross(points[c]))
    return abs(total) / 6.0


def curve(points, angles, whole):
    """A smooth edge through the points, one angle each; through the first again when it is a whole turn.

    Edges of one surface share their angles, so that it is ruled along the rows."""
    steps = [(b - a) % 360.0 for a, b in zip(angles, angles[1:] + (angles[:1] if whole else []))]
    parameters = [0.0]
    for step in steps:
        parameters.append(parameters[-1] + step)
    spline = Part.BSplineCurve()
    spline.interpolate(Points=points, PeriodicFlag=whole, Parameters=parameters)
    return spline.toShape()


def beyond(inner, outer, wall):
    """The wall's line from edge to edge, continued by the margin on both sides."""
    slope = (outer - inner) / wall
    return inner - MARGIN * slope, outer + MARGIN * slope


def stretches(rows, breaks):
    """The rows from corner to corner of the curve; [all of them] when there is none."""
    n = len(rows)
    corners = sorted(i for i, row in enumerate(rows) if any(abs(row[0] - phi) < 1e-9 for phi in breaks))
    if not corners:
        return [(rows, True)]
    out = []
    for i, j in zip(corners, corners[1:] + [corners[0] + n]):
        out.append(([rows[k % n] for k in range(i, j + 1)], False))
    return out


def end_tool(end, target, away):
    """What falls away at an end: the ruled surface through its two edges, swept off along the tube."""
    r_out = target["outer_diameter_mm"] / 2
    wall = target["wall_mm"]
    p = end["points"]
    rows = []
    for phi, low, high in zip(p["phi_deg"], p["z_inner_mm"], p["z_outer_mm"]):
        a, b = beyond(low, high, wall)
        turn = math.radians(phi)
        rows.append((phi, point(r_out - wall - MARGIN, turn, a), point(r_out + MARGIN, turn, b)))
    faces = []
    for part, whole in stretches(rows, [event["phi_deg"] for event in end["events"]]):
        angles = [row[0] for row in part]
        faces.append(Part.makeRuledSurface(*(curve([row[column] for row in part], angles, whole) for column in (1, 2))))
    surface = faces[0] if len(faces) == 1 else Part.makeShell(faces)
    return surface.extrude(FreeCAD.Vector(0, 0, away))


def hole_tool(hole, target):
    """The ruled wall of a hole, continued on both sides and closed by two planes square to it."""
    r_out = target["outer_diameter_mm"] / 2
    wall = target["wall_mm"]
    p = hole["points"]
    low, high = [], []
    for phi, z, phi_in, z_in in zip(p["phi_deg"], p["z_mm"], p["phi_inner_deg"], p["z_inner_mm"]):
        outer, inner = point(r_out, math.radians(phi), z), point(r_out - wall, math.radians(phi_in), z_in)
        along = (outer - inner) * (MARGIN / wall)
        low.append(inner - along)
        high.append(outer + along)
    out = sum((b - a for a, b in zip(low, high)), FreeCAD.Vector()).normalize()
    top = max(v.dot(out) for v in high) + MARGIN
    bottom = min(v.dot(out) for v in low) - MARGIN
    lid = [v + out * (top + r_out - v.dot(out)) for v in high]  # above the wall that bulges inside the ring
    floor = [v + out * (bottom - v.dot(out)) for v in low]
    angles = p["branch_phi_deg"] if hole["side"] == "near" else [-phi for phi in p["branch_phi_deg"]]
    rings = [curve(ring, angles, True) for ring in (floor, low, high, lid)]
    tool = Part.makeLoft([Part.Wire([ring]) for ring in rings], True, True)
    if tool.Volume < 0:  # inside out
        tool.reverse()
    return tool


def cut(body):
    request, result = body["request"], body["result"]
    target = next(m for m in request["members"] if m["id"] == request["member"])
    r_out, wall, length = target["outer_diameter_mm"] / 2, target["wall_mm"], result["lengths"]["long_mm"]
    groups = by_place(result["holes"])
    borders = [-40.0] + [(a[1] + b[0]) / 2 for a, b in zip(groups, groups[1:])] + [length + 40.0]
    pieces = [tube(r_out, wall, low, high) for low, high in zip(borders, borders[1:])]
    pieces[-1] = pieces[-1].cut(end_tool(result["ends"]["finish"], target, 400))
    pieces[0] = pieces[0].cut(end_tool(result["ends"]["start"], target, -400))
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


def shared_out(work, do):
    """do(item) for every item, by as many processes as there are processors; what each returned, in any order."""
    jobs = int(os.environ.get("JOBS", 0)) or os.cpu_count() or 1
    folder = os.path.dirname(os.environ["REPORT"])
    children = []
    for job in range(jobs):
        child = os.fork()
        if child == 0:
            out = [do(item) for item in work[job::jobs]]
            with open(f"{folder}/job-{job}", "w", encoding="utf-8") as file:
                json.dump(out, file)
            os._exit(0)
        children.append(child)
    for child in children:
        if os.waitpid(child, 0)[1] != 0:
            os._exit(1)
    out = []
    for job in range(jobs):
        with open(f"{folder}/job-{job}", encoding="utf-8") as file:
            out += json.load(file)
    return out


def main():
    with open(os.environ["PARTS"], encoding="utf-8") as file:
        bodies = json.load(file)
    folder = os.path.dirname(os.environ["REPORT"])
    names = list(bodies)

    def make(i):
        name, body = names[i], bodies[names[i]]
        begin = time.time()
        own = cut(body)
        told = body["result"]["lengths"]["volume_mm3"]
        taken = sum(volume(piece, SAG) for piece in own)
        whole = all(piece.isValid() and len(piece.Solids) == 1 for piece in own)
        for k, piece in enumerate(own):
            placed(piece, body["result"]["frame"]).exportBrep(f"{folder}/{i}-{k}.brep")
        print(f"{name}: {taken:.0f} mm^3, answered {told:.0f}, {time.time() - begin:.1f} s", flush=True)
        return [name, taken, told, whole, len(own)]

    made = shared_out(list(range(len(names))), make)
    pieces = {name: [Part.read(f"{folder}/{names.index(name)}-{k}.brep") for k in range(count)] for name, _, _, _, count in made}

    def compare(pair):
        a, b, k, m = pair
        both = volume(pieces[a][k].common(pieces[b][m]), SAG)
        print(f"{a} and {b} share {both:.3f} mm^3", flush=True)
        return [a, b, both]

    near = [(a, b, k, m) for i, a in enumerate(names) for b in names[i + 1:] for k, p in enumerate(pieces[a])
            for m, q in enumerate(pieces[b]) if p.BoundBox.intersect(q.BoundBox)]
    report = {"volumes": {name: [taken, told] for name, taken, told, _, _ in made},
              "invalid": [f"{name}: not one valid solid" for name, _, _, whole, _ in made if not whole],
              "common": shared_out(near, compare)}
    with open(os.environ["REPORT"], "w", encoding="utf-8") as file:
        json.dump(report, file)


main()
sys.stdout.flush()
os._exit(0)
