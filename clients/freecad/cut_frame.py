"""FreeCAD macro: sends the selected tubes to the tubecut service as one frame, and adds every finished part where it stands.

Select two tubes or more (Part tubes, any shape with an outer and an inner cylindrical wall) and run this macro. From a script:
`cut_frame(document, tubes, client, settings)`. Settings: the preferences group Mod/Tubecut, see README.md.
"""

import dataclasses
import itertools
import math
import pathlib
import sys
from typing import Optional

import FreeCAD as App
import Part

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from cut_tube import (CutError, Profile, client_from_preferences, corners_of, describe, message, placement_of,  # noqa: E402
                      preferences, settings_from_preferences, tube_of, waste)
import tubecut  # noqa: E402

SAMPLING = {"uniform_points": 360, "tolerance_mm": 0.01}
BEYOND_MM = 1.0  # distance by which a hole's tool extends beyond both walls


@dataclasses.dataclass
class Settings:
    # a tube's end joins every tube that it is in, or within this distance; None: only stated joints
    within_mm: Optional[float] = 1.0
    defaults: dict = dataclasses.field(default_factory=lambda: {  # joint of tubes that touch: of POST /v1/frames
        "root_surface": "inner", "groove": {"rule": "half_dihedral"}, "contact": "inner", "smoothing": {"method": "none"}})
    joints: list = dataclasses.field(default_factory=list)  # stated ones, between labels
    others: list = dataclasses.field(default_factory=list)  # planes and the like, which joints name
    kerf_mm: float = 0.0


# ---- the request


def names_of(targets):
    """A name each: its label, with the object's own name where two have one label."""
    labels = [target.Label for target in targets]
    return [label if labels.count(label) == 1 else f"{label} ({target.Name})" for label, target in zip(labels, targets)]


def request_of(targets, settings):
    """The frame request. phi is 0 on the side of each tube's own x."""
    if len(targets) < 2:
        raise CutError("select two tubes or more, those of the frame")
    members = []
    for name, target in zip(names_of(targets), targets):
        tube = tube_of(target)
        if not tube.inner_radius:
            raise CutError(f"{target.Label} has no bore: a tube with a wall is needed")
        members.append({"id": name, "start_mm": list(tube.start), "end_mm": list(tube.end), "up": list(tube.up),
                        "outer_diameter_mm": 2 * tube.outer_radius, "wall_mm": tube.outer_radius - tube.inner_radius})
    found = {} if settings.within_mm is None else {"connect": {"within_mm": settings.within_mm}}
    return {"members": members, "others": settings.others, "joints": settings.joints, **found,
            "defaults": settings.defaults, "kerf_mm": settings.kerf_mm, "sampling": SAMPLING}


# ---- the shape, in the part's frame


def end_profile(end):
    """phi of the rows ascends from the first one's for a whole turn, both ends given."""
    points = end["points"]
    first = min(range(len(points["phi_deg"])), key=points["phi_deg"].__getitem__)
    phi, inner, outer = ([*column[first:], *column[:first + 1]] for column in (points["phi_deg"], points["z_inner_mm"], points["z_outer_mm"]))
    phi[-1] += 360.0
    return Profile(phi, inner, outer, [phi[0] + (corner - phi[0]) % 360.0 for corner in corners_of(end["events"])])


def _reach(profile):
    heights = [*profile.z_inner, *profile.z_outer]
    return min(heights), max(heights)


def _is_square(profile):
    low, high = _reach(profile)
    return high - low < 1e-9


def _ring(points, parameters):
    curve = Part.BSplineCurve()
    curve.interpolate(Points=points, PeriodicFlag=True, Parameters=parameters)
    return Part.Wire([curve.toShape()])


def hole_tool(hole, radii):
    """The hole's wall, straight from edge to edge, prolonged beyond both walls and closed there by two lids."""
    p, (r_in, r_out) = hole["points"], radii
    low, high = [], []
    for phi, z, phi_in, z_in in zip(p["phi_deg"], p["z_mm"], p["phi_inner_deg"], p["z_inner_mm"]):
        outer, inner = (App.Vector(radius * math.cos(math.radians(at)), radius * math.sin(math.radians(at)), height)
                        for radius, at, height in ((r_out, phi, z), (r_in, phi_in, z_in)))
        along = (outer - inner).normalize() * BEYOND_MM
        low.append(inner - along)
        high.append(outer + along)
    out = sum((b - a for a, b in zip(low, high)), App.Vector()).normalize()
    bottom, top = min(v.dot(out) for v in low) - BEYOND_MM, max(v.dot(out) for v in high) + r_out  # above the wall that bulges in the ring
    levels = ([v + out * (bottom - v.dot(out)) for v in low], low, high, [v + out * (top - v.dot(out)) for v in high])
    turn = 1 if hole["side"] == "near" else -1  # the branch's phi runs the other way round where it leaves
    angles = p["branch_phi_deg"]
    parameters = list(itertools.accumulate((turn * (b - a) % 360.0 for a, b in zip(angles, angles[1:] + angles[:1])), initial=0.0))
    tool = Part.makeLoft([_ring(points, parameters) for points in levels], True, True)
    if tool.Volume < 0:
        tool.reverse()
    return tool


def solid_of(part):
    """The finished part: a tube less what is cut off its ends and out of its wall."""
    tube, result = part["request"]["target"], part["result"]
    r_out = tube["outer_diameter_mm"] / 2
    radii = (r_out - tube["wall_mm"], r_out)
    margin = 5 * tube["wall_mm"]
    profiles = [end_profile(result["ends"][end]) for end in ("start", "finish")]
    (start, _), (_, finish) = map(_reach, profiles)
    low, high = start - margin * (not _is_square(profiles[0])), finish + margin * (not _is_square(profiles[1]))
    base = App.Vector(0, 0, low)
    solid = Part.makeCylinder(r_out, high - low, base).cut(Part.makeCylinder(radii[0], high - low, base))
    for profile, foot in zip(profiles, (low - margin, high + margin)):
        if not _is_square(profile):
            solid = solid.cut(waste(profile, radii, foot))
    for hole in result["holes"]:
        solid = solid.cut(hole_tool(hole, radii))
    if len(solid.Solids) != 1 or not solid.isValid():
        raise CutError("its solid is not one valid piece")
    return solid.Solids[0]


# ---- into the document


@dataclasses.dataclass
class FrameCut:
    """What was added to the document, what could not be, and what the service said."""

    group: object
    items: dict  # by member's name
    missing: dict  # why, by part's name
    answer: tubecut.Answer


def _why(problem):
    return "; ".join(f"{e['pointer']}: {e['hint'] or e['code']}" for e in problem["errors"]) or problem["code"]


def cut_frame(document, targets, client, settings=None):
    """Adds a group with the finished part of each of the tubes, which stay as they are."""
    request = request_of(targets, settings or Settings())
    answer = client.frames(request)
    solids, missing = {}, {}
    for part in answer.parts:
        try:
            if "answer" not in part:
                raise CutError(_why(part["problem"]))
            solids[part["part"]] = solid_of(part["answer"])
        except CutError as error:
            missing[part["part"]] = str(error)
    if not solids:
        raise CutError("; ".join(f"{name}: {why}" for name, why in missing.items()))
    parts = {part["part"]: part.get("answer") for part in answer.parts}
    group = document.addObject("App::DocumentObjectGroup", "CutFrame")
    describe(group, answer.verdict, answer.job)
    items = {}
    for member, target in zip(answer.result["members"], targets):
        solid = solids.get(member["part"])
        if solid is None:
            continue
        item = document.addObject("Part::Feature", "CutTube")
        item.Label = f"{target.Label} cut"
        item.Shape = solid
        item.Placement = placement_of(member["frame"])
        made = parts[member["part"]]
        items[member["id"]] = describe(item, made["verdict"], made["job"], Part=member["part"])
        group.addObject(item)
    return FrameCut(group, items, missing, answer)


# ---- as a macro


def frame_settings_from_preferences():
    group, tube = preferences(), settings_from_preferences()
    defaults = {name: tube.request[name] for name in ("root_surface", "groove", "contact")}
    if not tube.bevel:
        defaults["groove"] = {"rule": "none"}
    defaults.update(smoothing={"method": "none"}, kind=group.GetString("JointKind", "set_on"), gap_mm=group.GetFloat("GapMm", 0.0))
    return Settings(group.GetFloat("WithinMm", 1.0), defaults, kerf_mm=tube.request["kerf_mm"])


def run():
    import FreeCADGui as Gui

    selected = Gui.Selection.getSelection()
    App.ActiveDocument.openTransaction("Cut frame")
    try:
        made = cut_frame(App.ActiveDocument, selected, client_from_preferences(), frame_settings_from_preferences())
        for name, target in zip(names_of(selected), selected):
            if target.ViewObject and name in made.items:
                target.ViewObject.Visibility = False
        App.ActiveDocument.commitTransaction()
        App.Console.PrintMessage(f"tubecut: {len(made.items)} of {len(selected)} members, verdict {made.answer.verdict['status']}\n")
        for warning in made.answer.warnings:
            App.Console.PrintWarning(f"tubecut: {warning['detail']}\n")
        for name, why in made.missing.items():
            App.Console.PrintError(f"tubecut: {name} is not made: {why}\n")
    except (CutError, tubecut.TubecutError) as error:
        App.ActiveDocument.abortTransaction()
        App.Console.PrintError(f"tubecut: {message(error)}\n")


if __name__ == "__main__" and App.GuiUp:
    run()
