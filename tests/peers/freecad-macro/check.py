"""Runs inside freecadcmd. Table 1 of source 000 as a document: the macro's cuts against FreeCAD's own booleans and against rays."""

import json
import math
import os
import pathlib
import random
import sys
import time
import traceback
import types

import FreeCAD as App
import Part
from BasicShapes import Shapes

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "clients/freecad"), str(ROOT / "clients/python")]
import cut_tube  # noqa: E402
import tubecut  # noqa: E402

OUTER, INNER, LENGTH = 35.0, 30.0, 400.0
PARTNERS = [(110, 85, 0, 0), (70, 65, 90, 15), (70, 35, 245, -5), (70, 55, 320, 0)]  # diameter, inclination, clocking, offset
# Position of the tube in the document: nothing may depend on it being the origin.
PLACE = App.Placement(App.Vector(120, -40, 75), App.Rotation(App.Vector(1, 2, 3), 40))
SECTION_MM, ANGLE_DEG = 1e-3, 0.01
RAYS = 100

figures, failures = {}, []


def hold(name, value, limit, unit):
    figures[name] = f"{value:.3g} {unit}, limit {limit:g}"
    if not value <= limit:
        failures.append(f"{name}: {value:.3g} > {limit:g} {unit}")


def expect(name, truth):
    figures[name] = bool(truth)
    if not truth:
        failures.append(name)


def axis_of(inclination, clocking, offset):
    """Point and direction of a partner's axis in the target's frame."""
    a, b = math.radians(inclination), math.radians(clocking)
    return (App.Vector(-offset * math.cos(b), -offset * math.sin(b), 0),
            App.Vector(math.sin(a) * math.sin(b), -math.sin(a) * math.cos(b), math.cos(a)))


def tube(document, label, outer, inner, length, placement):
    item = Shapes.addTube(document, label)
    item.OuterRadius, item.InnerRadius, item.Height = outer, inner, length
    item.Placement = placement
    document.recompute()
    return item


def scene(document):
    target = tube(document, "Brace", OUTER, INNER, LENGTH, PLACE)
    turned = App.Placement(App.Vector(0, 0, LENGTH), App.Rotation(App.Vector(1, 0, 0), 180))
    reversed_target = tube(document, "Brace from its far end", OUTER, INNER, LENGTH, PLACE.multiply(turned))
    partners = []
    for i, (diameter, *angles) in enumerate(PARTNERS):
        point, direction = axis_of(*angles)
        local = App.Placement(point - direction * 300, App.Rotation(App.Vector(0, 0, 1), direction))
        partners.append(tube(document, f"Partner {i}", diameter / 2, diameter / 2 - 4, 600, PLACE.multiply(local)))
    return target, reversed_target, partners


def own_boolean():
    """The kept piece by FreeCAD alone, in the target's frame."""
    piece = Part.makeCylinder(OUTER, LENGTH).cut(Part.makeCylinder(INNER, LENGTH))
    for diameter, *angles in PARTNERS:
        point, direction = axis_of(*angles)
        piece = piece.cut(Part.makeCylinder(diameter / 2, 2000, point - direction * 1000, direction))
    return next(solid for solid in piece.Solids if solid.BoundBox.ZMax > LENGTH - 1e-6)


def cut_edges(shape, radius):
    """The edges of the cut on one wall: not the far end's circle, no seam."""
    found = []
    for edge in shape.Edges:
        points = edge.discretize(9)
        if max(abs(math.hypot(p.x, p.y) - radius) for p in points) > 1e-3:
            continue
        across = max(p.distanceToPoint(points[0]) for p in points)
        seam = max(math.hypot(p.x - points[0].x, p.y - points[0].y) for p in points) < 1e-6 and across > 10
        if not seam and max(p.z for p in points) < LENGTH - 1e-6:
            found.append(edge)
    return found


def largest_distance(edges, others, per_edge=40):
    """From points on `edges` to the nearest of `others`."""
    target = Part.Compound(others)
    return max(target.distToShape(Part.Vertex(point))[0] for edge in edges for point in edge.discretize(per_edge))


def length(edges):
    return sum(edge.Length for edge in edges)


def in_frame(made, shape):
    local = shape.copy()
    local.Placement = made.frame.inverse().multiply(local.Placement)
    return local


def tubes_of(target, partners):
    return cut_tube.tube_of(target), [cut_tube.tube_of(partner) for partner in partners]


def plain_cut(document, target, partners, client, own):
    expect("plain: at the tube's finish", cut_tube.cut_end(*tubes_of(target, partners)) == "finish")
    made = cut_tube.cut(document, target, partners, client, cut_tube.Settings(bevel=False))
    solid = in_frame(made, made.solid.Shape)
    expect("plain: valid, one solid", solid.isValid() and len(solid.Solids) == 1)
    wires = in_frame(made, made.profile.Shape)
    for name, radius in (("inner", INNER), ("outer", OUTER)):
        ours, theirs = cut_edges(solid, radius), cut_edges(own, radius)
        drawn = cut_edges(wires, radius)
        expect(f"plain {name}: edges found", len(ours) >= 5 and len(theirs) >= 5 and len(drawn) >= 5)
        hold(f"plain {name}: ours to FreeCAD's", largest_distance(ours, theirs), SECTION_MM, "mm")
        hold(f"plain {name}: FreeCAD's to ours", largest_distance(theirs, ours), SECTION_MM, "mm")
        hold(f"plain {name}: profile to FreeCAD's", largest_distance(drawn, theirs), SECTION_MM, "mm")
        hold(f"plain {name}: length", abs(length(ours) - length(theirs)), 10 * SECTION_MM, "mm")
    figures["plain: volume less FreeCAD's"] = f"{solid.Volume - own.Volume:.3f} mm3 of {own.Volume:.0f} (straight between the walls)"


def linear(phi, column, angle):
    i = next(k for k in range(len(phi) - 1) if phi[k] <= angle <= phi[k + 1])
    return column[i] + (angle - phi[i]) / (phi[i + 1] - phi[i]) * (column[i + 1] - column[i])


def bevel_of(face, point):
    """Elevation of the face's line in the axial plane, from its normal."""
    normal = face.normalAt(*face.Surface.parameter(point))
    radial = (normal.x * point.x + normal.y * point.y) / math.hypot(point.x, point.y)
    return math.degrees(math.atan(-radial / normal.z))


def rays(bevel, points, seed=9):
    """Rays along the tube from inside it, at random phase and radius: where they meet the bevel, and at what angle."""
    phi = [*points["phi_deg"], 360.0]
    b, z_in = ([*points[name], points[name][0]] for name in ("b_deg", "z_inner_mm"))
    dice = random.Random(seed)
    angles, heights, met = [], [], 0
    for _ in range(RAYS):
        at, radius = dice.uniform(0, 360), dice.uniform(INNER + 0.05, OUTER - 0.05)
        x, y = radius * math.cos(math.radians(at)), radius * math.sin(math.radians(at))
        ray = Part.makeLine(App.Vector(x, y, LENGTH - 1), App.Vector(x, y, -LENGTH))
        hits = [(face, pair[0]) for face in bevel for gap, pairs, _ in [face.distToShape(ray)] if gap < 1e-6 for pair in pairs]
        if not hits:
            continue
        met += 1
        face, point = max(hits, key=lambda hit: hit[1].z)
        expected = linear(phi, b, at)
        angles.append(abs(bevel_of(face, point) - expected))
        run, slope = radius - INNER, math.radians(expected)
        allowed = SECTION_MM + run * math.radians(ANGLE_DEG) / math.cos(slope) ** 2
        heights.append(abs(point.z - linear(phi, z_in, at) - run * math.tan(slope)) / allowed)
    return met, angles, heights


def bevelled_cut(document, target, partners, client, own):
    start = time.monotonic()
    made = cut_tube.cut(document, target, partners, client)
    figures["bevelled: time with the service"] = f"{time.monotonic() - start:.1f} s"
    solid = in_frame(made, made.solid.Shape)
    expect("bevelled: valid, closed, one solid", solid.isValid() and len(solid.Solids) == 1 and solid.Shells[0].isClosed())
    bevel = [face for face in solid.Faces if not isinstance(face.Surface, (Part.Cylinder, Part.Plane))]
    expect("bevelled: faces", len(bevel) >= 5)

    inner = cut_edges(solid, INNER)
    points = made.answer.result["points"]
    table = [Part.Vertex(INNER * math.cos(math.radians(phi)), INNER * math.sin(math.radians(phi)), z)
             for phi, z in [*zip(points["phi_deg"], points["z_inner_mm"])][::5]]
    edge = Part.Compound(inner)
    hold("bevelled: table's root to the inner edge", max(edge.distToShape(v)[0] for v in table), SECTION_MM, "mm")
    hold("bevelled: inner edge to FreeCAD's own", largest_distance(inner, cut_edges(own, INNER)), SECTION_MM, "mm")
    hold("bevelled: length of the inner edge", abs(length(inner) - made.answer.result["length_mm"]), 10 * SECTION_MM, "mm")

    met, angles, heights = rays(bevel, points)
    expect(f"rays that meet the bevel: {met}", met == RAYS)
    hold("rays: bevel angle less B", max(angles, default=math.inf), ANGLE_DEG, "deg")
    hold("rays: height, of what both limits make there", max(heights, default=math.inf), 1.0, "")
    figures["B of the table"] = f"{min(points['b_deg']):.2f} to {max(points['b_deg']):.2f} deg, {len(points['b_deg'])} nodes"
    return made


def refusals(document, target, partners, client):
    """What the macro does not build, it says."""
    solid = document.addObject("Part::Cylinder", "Bar")
    box = document.addObject("Part::Box", "Box")
    document.recompute()
    for name, tube_, others, word in (("solid target", solid, partners, "bore"), ("no tube", target, [box], "cylindrical"),
                                      ("no partner", target, [], "partners")):
        before = len(document.Objects)
        try:
            cut_tube.cut(document, tube_, others, client)
            expect(f"refuses: {name}", False)
        except cut_tube.CutError as error:
            expect(f"refuses: {name}", word in str(error) and len(document.Objects) == before)
    try:
        # The small one is set on the large one and is narrower than the tube: at its sides the cut falls to the large
        # one.
        across = App.Rotation(App.Vector(0, 1, 0), 90)
        small, large = (tube(document, name, radius, radius - 2, 600, PLACE.multiply(App.Placement(App.Vector(-300, 0, z), across)))
                        for name, radius, z in (("Small", 20, 60), ("Large", 60, 0)))
        cut_tube.cut(document, target, [small, large], client, cut_tube.Settings(bevel=False))
        expect("refuses: a cut with jumps", False)
    except cut_tube.CutError as error:
        expect("refuses: a cut with jumps", "jumps by" in str(error))


def as_macro(document, target, partners):
    """run() with a selection, as from the menu; then without partners."""
    selection = [target, *partners]
    sys.modules["FreeCADGui"] = types.SimpleNamespace(Selection=types.SimpleNamespace(getSelection=lambda: selection))
    App.ParamGet("User parameter:BaseApp/Preferences/Mod/Tubecut").SetString("Url", os.environ["TUBECUT_URL"])
    before = len(document.Objects)
    cut_tube.run()
    added = document.Objects[before:]
    expect("macro: adds profile and solid", [item.Label for item in added] == ["Brace cut profile001", "Brace cut001"])
    expect("macro: names verdict and hash", all(item.Verdict == "ok" and len(item.ResultSha256) == 64 for item in added))
    del selection[1:]
    cut_tube.run()
    expect("macro: refuses a tube alone", len(document.Objects) == before + 2)


def main():
    document = App.newDocument()
    document.UndoMode = 1
    target, reversed_target, partners = scene(document)
    client = tubecut.Client(os.environ["TUBECUT_URL"])
    own = own_boolean()
    plain_cut(document, reversed_target, partners, client, own)
    made = bevelled_cut(document, target, partners, client, own)
    as_macro(document, target, partners)
    refusals(document, target, partners, client)
    if os.environ.get("TUBECUT_STL"):
        made.solid.Shape.exportStl(os.environ["TUBECUT_STL"])


try:
    main()
except BaseException:
    failures.append(traceback.format_exc())
pathlib.Path(os.environ["TUBECUT_REPORT"]).write_text(json.dumps({**figures, "failures": failures}))
sys.stdout.flush()
os._exit(0)
