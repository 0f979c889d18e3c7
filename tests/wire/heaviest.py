"""The heaviest requests thought of that the contract allows, by endpoint; costly.py has those that were searched for."""

import copy
import json
import math

from service import ROOT


def example(path):
    return json.loads((ROOT / "examples" / (path + ".json")).read_text())


def bent(tube, count, pairs_far=False):
    """The branch on an elbow, its elbow `count` times."""
    body = example("bevel-tables/tube-on-elbow")
    body["target"] = tube
    elbow = body["cutters"][0]
    body["cutters"] = [elbow | {"id": f"e{i}", "bend_deg": 45 + 0.1 * i} for i in range(count)]
    return body


def joint(body):
    return {"target": body["target"], "cutters": body["cutters"], "sampling": body["sampling"]}


def many_tubes(count):
    """A branch cut by tubes of all sizes round about."""
    return [{"kind": "tube", "id": f"t{i}", "outer_diameter_mm": 182.88 + 7 * (i % 9), "inclination_deg": 40 + i % 50,
             "clocking_deg": 360 * i / count, "offset_mm": 3 * (i % 5), "height_mm": 4 * (i % 7)} for i in range(count)]


TUBE = {"outer_diameter_mm": 60.3, "wall_mm": 4}
TABLE = {"root_surface": "inner", "groove": {"rule": "half_dihedral"}, "kerf_mm": 1.5, "contact": "auto",
         "smoothing": {"method": "envelope", "limits": {"max_slope_deg_per_mm": 5, "max_curvature_deg_per_mm2": 1}}}
FINE = {"tolerance_mm": 0.0001}
POINTS = {"uniform_points": 20000}
KERF_POINTS = {"uniform_points": 7900}  # of a kerf as wide as a twelfth of the girth, nearly kerf_pairs_max of them


def bevel_tables():
    wide = {"outer_diameter_mm": 200, "wall_mm": 20}
    yield "kerf-of-50-mm", TABLE | {"target": wide, "cutters": many_tubes(1), "sampling": KERF_POINTS, "kerf_mm": 50}
    yield "64-elbows", bent(TUBE, 64) | {"sampling": {"uniform_points": 8}}
    yield "6-elbows", bent(TUBE, 6)
    yield "fine", example("bevel-tables/table-1-torch-45-deg") | {"sampling": FINE}
    yield "points", example("bevel-tables/table-1-torch-45-deg") | {"sampling": POINTS}
    yield "square-kerf", {"target": {"outer_diameter_mm": 219.1, "wall_mm": 10}, "cutters": [{"kind": "plane", "point_mm": [0, 0, 50], "normal": [0, 0, 1]}],
                          "root_surface": "inner", "groove": {"rule": "none"}, "kerf_mm": 50, "smoothing": {"method": "none"}, "sampling": KERF_POINTS}
    body = example("bevel-tables/table-1-five-axis-at-600-mm-min")
    yield "machine-points", body | {"sampling": POINTS}
    tubes = TABLE | {"target": {"outer_diameter_mm": 114.3, "wall_mm": 6.3}, "cutters": many_tubes(64)}
    yield "64-tubes", tubes | {"sampling": POINTS}
    yield "64-tubes-fine", tubes | {"sampling": FINE}
    yield "zones", example("bevel-tables/zones") | {"sampling": POINTS}
    other = example("bevel-tables/tube-on-rectangular-tube-and-reducer")
    yield "rectangular", other | {"sampling": FINE}
    other = copy.deepcopy(other)
    other["cutters"] = [c | {"id": f"c{i}"} for i, c in enumerate(other["cutters"] * 32)]
    yield "32-rectangular", other
    laser = example("bevel-tables/tube-laser-branch")
    yield "laser-points", laser | {"sampling": POINTS}
    yield "laser-64-tubes", laser | {"cutters": many_tubes(64), "sampling": POINTS}


def intersections():
    yield "64-elbows", {"target": TUBE, "cutters": bent(TUBE, 64)["cutters"], "sampling": FINE}
    yield "64-tubes", {"target": {"outer_diameter_mm": 114.3, "wall_mm": 6.3}, "cutters": many_tubes(64), "sampling": FINE}
    yield "64-tubes-points", {"target": {"outer_diameter_mm": 114.3, "wall_mm": 6.3}, "cutters": many_tubes(64), "sampling": POINTS}
    yield "fine", example("intersections/source-000-table-1") | {"sampling": FINE}


def holes():
    for kind in ("set-in-branch", "set-on-branch", "through-brace"):
        yield kind + "-fine", example("holes/" + kind) | {"sampling": FINE}
        yield kind + "-points", example("holes/" + kind) | {"sampling": POINTS}
    yield "untilted", example("holes/set-in-branch") | {"tilt": "none", "sampling": POINTS}


def grid(side, within=60.0):
    """A space frame: side^3 nodes, tubes along the axes."""
    step, members = 1000.0, []
    for i in range(side):
        for j in range(side):
            for k in range(side):
                here = [step * i, step * j, step * k]
                for axis in range(3):
                    there = list(here)
                    there[axis] += step
                    if there[axis] < step * side:
                        members.append({"id": f"m{len(members)}", "start_mm": here, "end_mm": there, "outer_diameter_mm": 60.3 + axis * 10,
                                        "wall_mm": 4, "priority": 2 - axis})
    return {"members": members, "connect": {"within_mm": within}, "include": ["profiles"]}


def star(count):
    """Members of one node."""
    members = []
    for i in range(count):
        z = 1 - 2 * (i + 0.5) / count
        r, a = math.sqrt(1 - z * z), 2.399963 * i
        members.append({"id": f"m{i}", "start_mm": [0, 0, 0], "end_mm": [1000 * r * math.cos(a), 1000 * r * math.sin(a), 1000 * z],
                        "outer_diameter_mm": 60.3, "wall_mm": 4, "priority": i % 1000})
    return {"members": members, "connect": {"within_mm": 10}, "include": ["profiles"]}


def apart(count):
    """Members that do not meet: each pair is looked at all the same."""
    return {"members": [{"id": f"m{i}", "start_mm": [100 * i, 0, 0], "end_mm": [100 * i, 0, 1000], "outer_diameter_mm": 60.3, "wall_mm": 4}
                        for i in range(count)], "connect": {"within_mm": 0}, "include": ["profiles"]}


def nodes():
    tables = dict(example("nodes/k-joint-with-tables")["tables"])
    yield "frame", grid(6)
    yield "frame-tables", grid(4) | {"include": ["tables"], "tables": tables, "sampling": POINTS}
    yield "star", star(60)
    yield "star-500", star(500)
    yield "apart", apart(10000)
    yield "crossed", crossed(10000)
    yield "k-fine", example("nodes/k-joint-with-tables") | {"sampling": FINE}


def crossed(count):
    """Members that run through one point and end elsewhere: all of them overlap."""
    return {"members": [{"id": f"m{i}", "start_mm": [-1000, i, -1000], "end_mm": [1000, -i, 1000], "outer_diameter_mm": 60.3, "wall_mm": 4}
                        for i in range(count)], "connect": {"within_mm": 0}, "include": ["profiles"]}


def chord(count, sampling):
    """A chord with holes all along."""
    body = example("parts/chord-with-holes")
    length = 200 * (count + 1)
    members = [body["members"][0] | {"start_mm": [0, 0, 0], "end_mm": [length, 0, 0], "joints": []}]
    connect, holes = [], []
    for i in range(count):
        at = 200 * (i + 1)
        members.append({"id": f"b{i}", "start_mm": [at, 15, 0], "end_mm": [at, 15, 700], "size": "CHS 114.3x6.3", "priority": 1})
        members[0]["joints"].append({"member": f"b{i}", "kind": "set_in", "gap_mm": 1.5})
        connect.append({"member": f"b{i}", "end": "start", "to": ["C1"]})
        holes.append({"member": f"b{i}", "groove": {"rule": "none"}, "tilt": "free"})
    return body | {"members": members, "connect": connect, "holes": holes, "sampling": sampling}


def parts():
    yield "64-holes", chord(64, {"tolerance_mm": 0.1})
    yield "8-holes-points", chord(8, POINTS)
    yield "brace-fine", example("parts/k-joint-brace") | {"sampling": FINE}
    yield "brace-points", example("parts/k-joint-brace") | {"sampling": POINTS}
    laser = example("parts/tube-laser-chord")
    yield "laser-points", laser | {"sampling": POINTS}
    square = {k: v for k, v in chord(64, {"tolerance_mm": 0.1}).items() if k not in ("root_surface", "groove", "smoothing")}
    yield "laser-64-holes", square | {"preset": "tube_laser", "holes": [{"member": hole["member"]} for hole in square["holes"]]}


def frames():
    truss = example("frames/truss-of-19")
    whole = {k: truss[k] for k in ("connect", "defaults", "kerf_mm", "sampling")}
    yield "truss-points", truss | {"sampling": POINTS}
    yield "cage-fine", example("frames/roll-cage-of-12") | {"sampling": FINE}
    yield "grid", whole | {"members": grid(6)["members"]}
    yield "star", whole | {"members": star(60)["members"]}
    yield "crossed", whole | {"members": crossed(2000)["members"]}
    different = [m | {"end_mm": [*m["end_mm"][:2], 1000 + 0.1 * i]} for i, m in enumerate(apart(10000)["members"])]
    yield "apart", whole | {"members": different}


def contour(points, diameter, wave=0.0, lobes=4, b=0.0):
    phi = [360 * i / points for i in range(points)]
    return {"surface": "outer", "outer_diameter_mm": diameter, "wall_mm": 4, "closed": True, "b_sign": "outer_edge_to_plus_z", "scrap": "-z",
            "phi_deg": [round(v, 9) for v in phi], "z_mm": [round(wave * math.sin(math.radians(lobes * v)), 6) for v in phi],
            "b_deg": [round(b * math.sin(math.radians(lobes * v)), 6) for v in phi]}


def generic(period_us=4000, **more):
    axis = {"v_max": 240, "a_max": 300, "j_max": 6000, "n_max": None}
    return {"type": "generic", "period_us": period_us, "b_positive": "outer_edge_into_part", "axes": [
        {"name": "C", "unit": "deg", "pulses_per_turn": 360000} | axis, {"name": "Z", "unit": "mm", "pulses_per_unit": 1000} | axis,
        {"name": "B", "unit": "deg", "pulses_per_unit": 1000} | axis]} | more


def pulse_schedules():
    square = example("pulse-schedules/square-cut-from-a-bare-contour")
    crawler = example("pulse-schedules/source-002-offset-pair-on-the-crawler")
    five = example("pulse-schedules/table-1-on-the-five-axis-cutter")
    quick = square["machine"] | {"period_us": 50}
    yield "5-m", square | {"contour": contour(2000, 1600), "motion": {"speed": {"mm_min": 600}}}
    yield "5-m-slow", square | {"contour": contour(2000, 1600), "motion": {"speed": {"mm_min": 60}}}
    yield "16-m", square | {"contour": contour(20000, 5000, 20, 40, 5), "motion": {"speed": {"mm_min": 3000}}}
    yield "points", square | {"contour": contour(100000, 1600, 5, 400, 3), "motion": {"speed": {"mm_min": 3000}}}
    yield "short-period", square | {"machine": quick, "motion": {"speed": {"mm_min": 60}}}
    yield "compare", five | {"motion": {"speed": {"mm_min": 300}, "compare": True}}
    yield "compare-points", square | {"contour": contour(3000, 300, 20, 40, 25), "motion": {"speed": {"mm_min": 600}, "compare": True}}
    table = {"table": [[0.1 + 0.05 * i, 1800 - i] for i in range(1000)]}
    yield "crawler-table", crawler | {"motion": {"speed": table}}
    yield "crawler-fine", crawler | {"cut": crawler["cut"] | {"sampling": FINE}, "motion": {"speed": table}}
    yield "start-auto", five | {"motion": {"speed": {"mm_min": 300}, "start_phi_deg": "auto", "lead": {}}}
    yield "lead-points", square | {"contour": contour(20000, 300, 5, 40, 3), "motion": {"speed": {"mm_min": 600}, "lead": {}}}
    yield "slow", five | {"motion": {"speed": {"mm_min": 20}}}
    part = example("pulse-schedules/two-ends-and-four-holes-of-a-part")
    holes = chord(64, {"tolerance_mm": 0.1})
    yield "part-slow", part | {"motion": part["motion"] | {"speed": {"mm_min": 100}}}
    yield "part-points", part | {"part": part["part"] | {"sampling": POINTS}}
    yield "part-64-holes", part | {"part": holes | {"holes": [hole | {"tilt": "axial"} for hole in holes["holes"]]}}
    body = example("pulse-schedules/source-001-mill-path")
    yield "mill", body
    yield "3600-positions", body | {"mill_path": body["mill_path"] | {"positions": 3600}}
    yield "64-elbows", five | {"cut": {k: v for k, v in bent(TUBE, 64).items()}}
    yield "unknown-fields", square | {f"x{i}": [1, 2, 3] for i in range(200000)}
    n = 100000
    axes = {"s_mm": [0.01 * i for i in range(n)], "C": [0.01 * i for i in range(n)], "Z": [round(math.sin(0.01 * i), 6) for i in range(n)],
            "B": [0] * n}
    yield "axes", {"axes": axes, "machine": generic(), "motion": {"speed": {"mm_min": 600}}}


def replays():
    body = example("replays/square-cut")
    for name, count in (("full", 8_380_000 // 2 // 3), ("columns", 1_300_000)):
        counts = {"C": [1] * count, "Y": [0] * count, "Z1": [0] * count}
        if name == "full":
            counts = {"C": [1] * (3 * count - 3000)}
        yield name, body | {"schedule": body["schedule"] | {"counts": counts}}


def feed_curves():
    body = example("feed-curves/cut-off-194-mm-whole-cycle")
    yield "short-period", body | {"cycle": body["cycle"] | {"period_s": 0.0002}}
    yield "table", body | {"table": {"points": 20000}}
    yield "comparison", body | {"comparison": {"first_degree": 1, "last_degree": 8}, "fit": {"method": "auto", "tolerance_ratio": 1e-6}}


def grooves():
    for name in ("case-a-right-angle", "case-b-near-equal-diameters", "case-c-oblique-offset"):
        yield name, example("grooves/" + name) | {"sections": 20000}
    yield "normal-sections", example("grooves/case-c-oblique-offset") | {"sections": 20000, "area_in": "normal"}


def mill_paths():
    for name, more in (("90-annealed", {"positions": 90, "optimise": {"method": "annealing"}}), ("3600", {"positions": 3600}),
                       ("20000", {"positions": 20000}), ("720", {"positions": 720}), ("720-annealed", {"positions": 720, "optimise": {"method": "annealing"}}),
                       ("none", {"positions": 20000, "optimise": {"method": "none"}})):
        yield name, example("mill-paths/case-a-end-up") | more
    yield "c-3600", example("mill-paths/case-c-pivot-far-away") | {"positions": 3600}
    yield "probed", example("mill-paths/case-c-pivot-far-away") | {"probe": [{"omega_deg": 0.36 * i, "ruling_deg": 0.36 * i, "v": 0.5} for i in range(1000)]}


def requests():
    """Endpoint, name, body."""
    for endpoint in (bevel_tables, intersections, holes, nodes, parts, frames, pulse_schedules, replays, feed_curves, grooves, mill_paths):
        for name, body in endpoint():
            yield endpoint.__name__.replace("_", "-"), name, body


def text(body):
    return json.dumps(body, separators=(",", ":")).encode()
