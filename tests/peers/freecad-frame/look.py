"""Run within FreeCAD: opens the assembly of a frame, cuts nothing, and measures between its solids. STEP, MEMBERS, REPORT and TURN in the environment:
MEMBERS is JSON, [{id, volume_mm3, from, to}] in the order of the file; TURN names one that is first turned by 1 deg about its own axis."""

import itertools
import json
import os

import FreeCAD
import Part

members = json.loads(os.environ["MEMBERS"])
joints = {tuple(sorted(pair)) for pair in json.loads(os.environ["JOINTS"])}
solids = Part.read(os.environ["STEP"]).Solids
faults = []
if len(solids) != len(members):
    raise SystemExit(f"{len(solids)} solids of {len(members)} members")


def vector(xyz):
    return FreeCAD.Vector(*xyz)


placed, volumes = {}, {}
for solid, member in zip(solids, members):
    if not solid.isValid() or not solid.isClosed():
        faults.append(f"{member['id']} is no closed valid solid")
    volumes[member["id"]] = solid.Volume / member["volume_mm3"] - 1
    start, end = vector(member["from"]), vector(member["to"])
    along = (end - start).normalize()
    off = solid.CenterOfMass - start
    # Holes and slanted ends pull it aside by less than a radius.
    if (off - along * off.dot(along)).Length > member["radius"]:
        faults.append(f"{member['id']} is not where it was told to be")
    if os.environ.get("TURN") == member["id"]:
        solid = solid.copy()
        solid.rotate(start, along, 1.0)
    placed[member["id"]] = solid
common, gaps = {}, {}
only = os.environ.get("TURN")
for a, b in itertools.combinations(placed, 2):
    if only and only not in (a, b):
        continue
    box = placed[a].BoundBox
    box.enlarge(5.0)
    if not box.intersect(placed[b].BoundBox):
        continue
    common[f"{a} & {b}"] = placed[a].common(placed[b]).Volume
    if tuple(sorted((a, b))) in joints:
        gaps[f"{a} & {b}"] = placed[a].distToShape(placed[b])[0]
with open(os.environ["REPORT"], "w") as out:
    json.dump({"faults": faults, "volumes": volumes, "common": common, "gaps": gaps}, out)
