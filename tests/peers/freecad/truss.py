"""A Warren truss of 20 members as /v1/parts requests: two chords with holes, 18 braces, two overlapped nodes, axes a little aside."""

PANELS, PANEL, HEIGHT = 9, 1200.0, 1000.0
OVERLAPPED = {3: 30.0, 6: 24.0}  # bottom nodes whose braces come nearer, mm
TABLE = {
    "root_surface": "inner",
    "groove": {"rule": "half_dihedral"},
    "kerf_mm": 1.5,
    "torch": {"min_deg": -85, "max_deg": 85},
    "sampling": {"tolerance_mm": 0.01},
    "smoothing": {"method": "envelope", "limits": {"max_slope_deg_per_mm": 5, "max_curvature_deg_per_mm2": 1}, "refine": False},
}


def members():
    span = PANELS * PANEL
    out = [
        {"id": "bottom", "start_mm": [-400, 0, 0], "end_mm": [span + 400, 0, 0], "outer_diameter_mm": 168.3, "wall_mm": 8, "priority": 0},
        {"id": "top", "start_mm": [PANEL / 2 - 400, 0, HEIGHT], "end_mm": [span - PANEL / 2 + 400, 0, HEIGHT],
         "outer_diameter_mm": 168.3, "wall_mm": 6.3, "priority": 0},
    ]
    for k in range(2 * PANELS):
        rising = k % 2 == 0
        foot = k // 2 if rising else k // 2 + 1
        nearer = OVERLAPPED.get(foot, 0.0)
        low = [foot * PANEL + (-nearer if rising else nearer), 7.0 - k % 3, 0.0]
        high = [(k // 2 + 0.5) * PANEL, 3.0 * (k % 4) - 4.0, HEIGHT]
        out.append({"id": f"brace {k + 1}", "start_mm": low if rising else high, "end_mm": high if rising else low,
                    "outer_diameter_mm": 76.1, "wall_mm": 4 if k % 2 else 5, "priority": 1 + k})
    return out


def requests():
    """One request a member: {id: body}."""
    node = {"members": members(), "connect": {"within_mm": 60}}
    out = {}
    for member in node["members"]:
        body = {**node, "member": member["id"], "datum": "up", "up": [0, 1, 0], **TABLE}
        if member["id"] in ("bottom", "top"):
            body["holes"] = [{"member": other["id"], "joint": {"kind": "set_on"}, "groove": {"rule": "half_dihedral"}}
                             for other in node["members"][2:]]
        out[member["id"]] = body
    return out
