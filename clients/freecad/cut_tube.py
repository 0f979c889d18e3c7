"""FreeCAD macro: cuts the first selected tube against the others by the tubecut service, and adds the profile and the cut solid.

Select the tube to be cut, then its partners (Part tubes, cylinders, any shape with a cylindrical wall), and run this macro. From a
script: `cut(document, target, partners, client, settings)`. Settings: the preferences group Mod/Tubecut, see README.md.
"""

import bisect
import dataclasses
import math
import os
import pathlib
import sys

import FreeCAD as App
import Part

for _folder in (pathlib.Path(__file__).resolve().parent, pathlib.Path(__file__).resolve().parents[1] / "python"):
    if (_folder / "tubecut.py").exists():
        sys.path.insert(0, str(_folder))
        break
import tubecut  # noqa: E402

COAXIAL_MM = 1e-6
MARGIN = 0.1  # of the wall: distance by which the tool extends beyond both walls
SAMPLING = {"uniform_points": 2880, "tolerance_mm": 0.01}


class CutError(Exception):
    """What the user can mend; shown as it is."""


@dataclasses.dataclass
class Settings:
    bevel: bool = True  # False: the edges of both walls lie on the partners
    request: dict = dataclasses.field(default_factory=lambda: {
        "root_surface": "inner", "groove": {"rule": "half_dihedral"}, "kerf_mm": 0, "contact": "inner",
        "smoothing": {"method": "envelope", "limits": {"machine": "five_axis_cutter", "speed_mm_min": 600}}})


# ---- the selection


@dataclasses.dataclass
class Tube:
    """A round tube in the world: centre-line, radii."""

    label: str
    start: App.Vector
    end: App.Vector
    up: App.Vector
    outer_radius: float
    inner_radius: float  # 0: solid


def _on_axis(point, surface):
    offset = point - surface.Center
    return (offset - surface.Axis * offset.dot(surface.Axis)).Length


def _cylinders(shape):
    return [face.Surface for face in shape.Faces if isinstance(face.Surface, Part.Cylinder)]


def tube_of(item):
    """The tube a document object shows, by its cylindrical faces."""
    walls = _cylinders(item.Shape)
    if not walls:
        raise CutError(f"{item.Label} has no cylindrical wall")
    outer = max(walls, key=lambda wall: wall.Radius)
    coaxial = [w.Radius for w in walls if _on_axis(w.Center, outer) < COAXIAL_MM and
               w.Axis.cross(outer.Axis).Length < 1e-9 and w.Radius < outer.Radius - COAXIAL_MM]
    along = [(vertex.Point - outer.Center).dot(outer.Axis) for vertex in item.Shape.Vertexes]
    up = item.getGlobalPlacement().Rotation.multVec(App.Vector(1, 0, 0))
    if up.cross(outer.Axis).Length < 1e-3:
        up = item.getGlobalPlacement().Rotation.multVec(App.Vector(0, 1, 0))
    return Tube(item.Label, outer.Center + outer.Axis * min(along), outer.Center + outer.Axis * max(along), up,
                outer.Radius, max(coaxial, default=0.0))


def _distance_to_axis(point, tube):
    along = (tube.end - tube.start).normalize()
    offset = point - tube.start
    return (offset - along * offset.dot(along)).Length


def cut_end(target, partners):
    """The end of the target that lies nearer to the partners' axes."""
    distances = {end: sum(_distance_to_axis(point, p) for p in partners)
                 for end, point in (("start", target.start), ("finish", target.end))}
    return min(distances, key=distances.get)


# ---- the request


def _member(name, tube, priority):
    # a partner's wall is not used
    wall = tube.outer_radius - tube.inner_radius if tube.inner_radius else tube.outer_radius / 2
    return {"id": name, "start_mm": list(tube.start), "end_mm": list(tube.end), "outer_diameter_mm": 2 * tube.outer_radius,
            "wall_mm": wall, "priority": priority}


def node_of(target, partners, end):
    """The node request: the target is cut by all partners at `end`. phi is 0 on the side of the target's own x."""
    members = [{**_member("target", target, 1), "up": list(target.up)}]
    members += [_member(f"partner {i}", partner, 0) for i, partner in enumerate(partners, 1)]
    return {"members": members, "connect": [{"member": "target", "end": end, "to": [m["id"] for m in members[1:]]}]}


def frame_of(client, node, end):
    """Placement of the target's frame in the world: z from the cut end into the kept tube."""
    answer = client.nodes(node)
    return placement_of(next(e["frame"] for e in answer.result["ends"] if e["member"] == "target" and e["end"] == end))


def placement_of(frame):
    rows = [*zip(frame["x"], frame["y"], frame["z"], frame["origin_mm"])]
    return App.Placement(App.Matrix(*rows[0], *rows[1], *rows[2], 0, 0, 0, 1))


@dataclasses.dataclass
class Profile:
    """The finished cut over phi: z on both walls, and where it has corners. phi ascends from 0 to 360 deg, both ends given."""

    phi_deg: list
    z_inner: list
    z_outer: list
    corners_deg: list


def _closed(phi, *columns):
    return [*phi, 360.0], *([*column, column[0]] for column in columns)


def corners_of(events):
    for event in events:
        if event["kind"] == "jump":
            raise CutError(f"the cut jumps by {abs(event['z_to_mm'] - event['z_from_mm']):.3f} mm at {event['phi_deg']:.3f} deg, "
                           "where a partner ends: its solid is not built")
    return sorted({event["phi_deg"] % 360.0 for event in events})


def _between(phi, z, corners, angle):
    """A closed column at an angle that is no node: the cubic through the four nearest nodes on this side of every corner."""
    first = bisect.bisect_left(phi, max([0.0, *(c for c in corners if c < angle)]) - 1e-9)
    last = bisect.bisect_right(phi, min([360.0, *(c for c in corners if c > angle)]) + 1e-9)
    begin = min(max(bisect.bisect_right(phi, angle) - 2, first), max(last - 4, first))
    nodes = range(begin, min(begin + 4, last))
    return sum(z[i] * math.prod((angle - phi[k]) / (phi[i] - phi[k]) for k in nodes if k != i) for i in nodes)


def bevelled_profile(result):
    points = result["points"]
    phi, inner, outer = _closed(points["phi_deg"], points["z_inner_mm"], points["z_outer_mm"])
    return Profile(phi, inner, outer, corners_of(result["events"]))


def plain_profile(result):
    """Both walls' own curves, on the nodes of both."""
    walls = {}
    for wall in result["profiles"]:
        phi, z = _closed(wall["points"]["phi_deg"], wall["points"]["z_mm"])
        walls[wall["surface"]] = phi, z, corners_of(wall["events"])
    both = sorted({phi for wall in walls.values() for phi in wall[0]})
    columns = {}
    for surface, (phi, z, corners) in walls.items():
        known = dict(zip(phi, z))
        columns[surface] = [known[angle] if angle in known else _between(phi, z, corners, angle) for angle in both]
    return Profile(both, columns["inner"], columns["outer"], sorted({c for wall in walls.values() for c in wall[2]}))


# ---- the shape


def _stretches(profile):
    """Index ranges between corners; both ends included."""
    cuts = [0]
    for corner in profile.corners_deg:
        i = min(range(len(profile.phi_deg)), key=lambda k: abs(profile.phi_deg[k] - corner))
        if abs(profile.phi_deg[i] - corner) > 1e-6:
            raise CutError(f"the corner at {corner} deg is no node of the table")
        cuts.append(i)
    cuts = sorted({*cuts, len(profile.phi_deg) - 1})
    return [(a, b) for a, b in zip(cuts, cuts[1:])]


def _curve(phi_deg, radius, z):
    """Interpolates (radius, phi, z) over phi, without corner."""
    angles = [math.radians(phi) for phi in phi_deg]
    points = [App.Vector(radius * math.cos(a), radius * math.sin(a), height) for a, height in zip(angles, z)]
    if len(points) == 2:
        return Part.LineSegment(*points).toBSpline()
    curve = Part.BSplineCurve()
    curve.interpolate(Points=points, Parameters=angles)
    return curve


@dataclasses.dataclass
class _Rails:
    """The same stretch of phi at the tool's inner and outer radius, on the cut and at the foot."""

    inner: object
    outer: object
    inner_foot: object
    outer_foot: object


def _rails(profile, radii, foot_z):
    """Every generator of the cut, straight in its axial plane, prolonged a little beyond both walls."""
    r_in, r_out = radii
    beyond = MARGIN * (r_out - r_in)
    slope = [(b - a) / (r_out - r_in) for a, b in zip(profile.z_inner, profile.z_outer)]
    low = [z - beyond * m for z, m in zip(profile.z_inner, slope)]
    high = [z + beyond * m for z, m in zip(profile.z_outer, slope)]
    for a, b in _stretches(profile):
        part = slice(a, b + 1)
        phi = profile.phi_deg[part]
        flat = [foot_z] * len(phi)
        yield _Rails(*(_curve(phi, radius, z).toShape() for radius, z in (
            (r_in - beyond, low[part]), (r_out + beyond, high[part]), (r_in - beyond, flat), (r_out + beyond, flat))))


def waste(profile, radii, foot_z):
    """The solid below the cut, from `foot_z` up, in the target's frame."""
    faces = []
    for rails in _rails(profile, radii, foot_z):
        for one, other in ((rails.inner, rails.outer), (rails.inner_foot, rails.inner), (rails.outer_foot, rails.outer),
                           (rails.inner_foot, rails.outer_foot)):
            faces.append(Part.makeRuledSurface(one, other))
    shell = Part.Shell(Part.makeShell(faces).Faces)
    shell.sewShape()
    solid = Part.Solid(shell)
    if solid.Volume < 0:
        solid.reverse()
    if not solid.isValid():
        raise CutError("the waste below the cut is not a valid solid")
    return solid


def profile_wires(profile, radii):
    """Inner and outer edge of the cut, in the target's frame."""
    return [Part.Wire([_curve(profile.phi_deg[a:b + 1], radius, z[a:b + 1]).toShape() for a, b in _stretches(profile)])
            for radius, z in zip(radii, (profile.z_inner, profile.z_outer))]


@dataclasses.dataclass
class Cut:
    """What was added to the document, and what the service said."""

    profile: object
    solid: object
    table: Profile
    frame: App.Placement
    answer: tubecut.Answer


def describe(item, verdict, job, **more):
    """What the service said of it, as the item's properties."""
    for name, value in {"Verdict": verdict["status"], "InputSha256": job["input_sha256"], "ResultSha256": job["result_sha256"],
                        "Engine": job["engine"], **more}.items():
        item.addProperty("App::PropertyString", name, "Tubecut")
        setattr(item, name, value)
    return item


def _add(document, kind, label, shape, answer):
    item = document.addObject("Part::Feature", kind)
    item.Label = label
    item.Shape = shape
    return describe(item, answer.verdict, answer.job)


def cut(document, target, partners, client, settings=None, end=None):
    """Cuts document object `target` by `partners`. Both stay as they are; two objects are added."""
    settings = settings or Settings()
    if not partners:
        raise CutError("select the tube to be cut, then its partners")
    tube, others = tube_of(target), [tube_of(partner) for partner in partners]
    if not tube.inner_radius:
        raise CutError(f"{target.Label} has no bore: a tube with a wall is needed")
    end = end or cut_end(tube, others)
    node = node_of(tube, others, end)
    frame = frame_of(client, node, end)
    ends = {"node": {**node, "member": "target", "end": end}, "sampling": SAMPLING}
    if settings.bevel:
        answer = client.bevel_tables({**ends, **settings.request})
        profile = bevelled_profile(answer.result)
    else:
        answer = client.intersections({**ends, "surfaces": "both"})
        profile = plain_profile(answer.result)
    radii = (tube.inner_radius, tube.outer_radius)
    foot = min(0.0, *profile.z_inner, *profile.z_outer) - 5 * (radii[1] - radii[0])
    tool = waste(profile, radii, foot)
    tool.Placement = frame
    wires = Part.Compound(profile_wires(profile, radii))
    wires.Placement = frame
    solid = target.Shape.cut(tool)
    if len(solid.Solids) == 1:
        solid = solid.Solids[0]
    return Cut(_add(document, "CutProfile", f"{target.Label} cut profile", wires, answer),
               _add(document, "CutTube", f"{target.Label} cut", solid, answer), profile, frame, answer)


# ---- as a macro


def preferences():
    return App.ParamGet("User parameter:BaseApp/Preferences/Mod/Tubecut")


def settings_from_preferences():
    group = preferences()
    settings = Settings(bevel=group.GetBool("Bevel", True))
    settings.request["kerf_mm"] = group.GetFloat("KerfMm", 0.0)
    settings.request["contact"] = group.GetString("Contact", "inner")
    machine, speed = group.GetString("Machine", "five_axis_cutter"), group.GetFloat("SpeedMmMin", 600.0)
    settings.request["smoothing"] = {"method": "envelope", "limits": {"machine": machine, "speed_mm_min": speed}}
    return settings


def message(error):
    if not isinstance(error, tubecut.ProblemError):
        return str(error)
    return "\n".join([error.problem.detail, *(f"{e.pointer}: {e.hint or e.code}" for e in error.errors)])


def client_from_preferences():
    return tubecut.Client(preferences().GetString("Url", "http://127.0.0.1:8080"), key=os.environ.get("TUBECUT_KEY"), patience_s=5)


def run():
    import FreeCADGui as Gui

    selected = Gui.Selection.getSelection()
    client = client_from_preferences()
    App.ActiveDocument.openTransaction("Cut tube")
    try:
        made = cut(App.ActiveDocument, selected[0] if selected else None, selected[1:], client, settings_from_preferences())
        if selected[0].ViewObject:
            selected[0].ViewObject.Visibility = False
        App.ActiveDocument.commitTransaction()
        App.Console.PrintMessage(f"tubecut: verdict {made.answer.verdict['status']}\n")
        for warning in made.answer.warnings:
            App.Console.PrintWarning(f"tubecut: {warning['detail']}\n")
    except (CutError, tubecut.TubecutError) as error:
        App.ActiveDocument.abortTransaction()
        App.Console.PrintError(f"tubecut: {message(error)}\n")


if __name__ == "__main__" and App.GuiUp:
    run()
