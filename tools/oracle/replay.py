#!/usr/bin/env python3
"""Rebuilds the torch in space from a schedule's pulses and measures the cut that its straight beam makes.

Written from docs/theory/pulse-schedules.md, sections 2.1, 3 and 3.1, alone: lines and cylinders, no formula of
core/motion. `replay.py REQUEST.json ANSWER.json`: the request's machine and contour are spelt out, the answer is that of
POST /v1/pulse-schedules. Numpy."""

import json
import sys

import numpy as np


class Tube:
    def __init__(self, contour):
        self.outer = contour["outer_diameter_mm"] / 2
        self.inner = self.outer - contour["wall_mm"]
        self.contour = self.outer if contour["surface"] == "outer" else self.inner
        self.other = self.inner if contour["surface"] == "outer" else self.outer


def pulses_per_unit(axis):
    return axis["pulses_per_turn"] / 360 if "pulses_per_turn" in axis else axis["pulses_per_unit"]


def axis_values(machine, result):
    """{axis: its value before the first period and after each}, in the axis' unit."""
    out = {}
    for axis in machine["axes"]:
        counts = result["counts"].get(axis["name"], [0] * result["periods"])
        sums = np.concatenate([[0], np.cumsum(np.asarray(counts, dtype=np.int64))])
        out[axis["name"]] = result["start"][axis["name"]] + sums / pulses_per_unit(axis)
    return out


def unit_vectors(phi):
    """Radial, tangential and axial directions at the angle phi."""
    zero, one = np.zeros_like(phi), np.ones_like(phi)
    return (np.stack([np.cos(phi), np.sin(phi), zero], -1), np.stack([-np.sin(phi), np.cos(phi), zero], -1),
            np.stack([zero, zero, one], -1))


def into_part(machine):
    """+1 where the machine counts B as the tables do, -1 where it counts the other way."""
    return {"outer_edge_into_part": 1.0, "outer_edge_to_waste": -1.0}[machine["b_positive"]]


class Beam:
    """Straight lines in the tube's frame: a point of each and its direction inwards."""

    def __init__(self, phi, point, b):
        radial, _, axial = unit_vectors(phi)
        self.phi, self.point, self.b = phi, point, b
        # B > 0: the outer edge lies further into the part, so inwards is towards -z.
        self.direction = -np.cos(b)[:, None] * radial - np.sin(b)[:, None] * axial

    def at(self, radius):
        """(phi unwrapped, z, way along the beam) where it enters the cylinder of that radius."""
        p, d = self.point, self.direction
        a = d[:, 0] ** 2 + d[:, 1] ** 2
        half = p[:, 0] * d[:, 0] + p[:, 1] * d[:, 1]
        c = p[:, 0] ** 2 + p[:, 1] ** 2 - radius**2
        way = (-half - np.sqrt(half**2 - a * c)) / a
        hit = p + way[:, None] * d
        raw = np.arctan2(hit[:, 1], hit[:, 0])
        return raw + 2 * np.pi * np.round((self.phi - raw) / (2 * np.pi)), hit[:, 2], way


def torch(machine, tube, q):
    """The beam that the axes' values make, and the arm from its point to the outer wall (None: no height axis)."""
    if machine["type"] == "five_axis_cutter":
        phi, height, along = np.radians(q["C"]), q["Z1"] + q.get("Z2", 0.0), q["Y"]
        arm = machine["pivot_length_mm"] + machine.get("standoff_mm", 0.0)
    elif machine["type"] == "crawler":
        phi, along, arm = q["S"] / (tube.outer + machine["wheel_offset_mm"]), q["E"], None
        pivot = machine["swing_center"] == "pivot"
        height = np.full_like(along, tube.outer + (machine["pivot_length_mm"] if pivot else 0.0))
    elif machine["type"] == "tube_table":
        up, arm = -np.radians(q["A"]), machine.get("pivot_length_mm", 0.0) + machine.get("standoff_mm", 0.0)
        radial, tangential, axial = unit_vectors(up)
        point = q["Z"][:, None] * radial + q["X"][:, None] * tangential + q["Y"][:, None] * axial
        return Beam(up, point, into_part(machine) * np.radians(q.get("B", np.zeros_like(up)))), arm
    else:
        phi, along, b = generic_place(machine, q)
        radial, _, axial = unit_vectors(phi)
        return Beam(phi, tube.contour * radial + along[:, None] * axial, b), None
    radial, _, axial = unit_vectors(phi)
    point = height[:, None] * radial + along[:, None] * axial
    return Beam(phi, point, into_part(machine) * np.radians(q["B"])), arm


def generic_place(machine, q):
    """phi, z and B out of as many axes as there are maps, by least squares."""
    maps = machine["maps"]
    rows = np.array([[m.get("k_phi", 0.0), m.get("k_z", 0.0), m.get("k_b", 0.0)] for m in maps])
    values = np.stack([q[a["name"]] - m.get("k_0", 0.0) for a, m in zip(machine["axes"], maps)])
    phi, z, b = np.linalg.lstsq(rows, values, rcond=None)[0]
    return np.radians(phi), z, into_part(machine) * np.radians(b)


def demanded(machine, tube, phi, z, b):
    """{axis: value} that lays the beam through (phi, z) of the contour's surface at the angle B (radians)."""
    radial, _, axial = unit_vectors(phi)
    beam = Beam(phi, tube.contour * radial + z[:, None] * axial, b)
    far = beam.point - 10 * tube.outer * beam.direction  # outside, to look inwards from
    _, z_outer, _ = Beam(phi, far, b).at(tube.outer)
    outer = tube.outer * radial + z_outer[:, None] * axial
    counted = np.degrees(b) * into_part(machine)
    if machine["type"] == "five_axis_cutter":
        arm, share = machine["pivot_length_mm"] + machine.get("standoff_mm", 0.0), machine.get("z2_share", 0.0)
        pivot = outer - arm * beam.direction
        rise = np.hypot(pivot[:, 0], pivot[:, 1]) - tube.outer - arm  # against the upright torch
        return {"C": np.degrees(phi), "Y": pivot[:, 2], "B": counted, "Z2": share * rise,
                "Z1": tube.outer + arm + (1 - share) * rise}
    if machine["type"] == "tube_table":
        pivot = outer - (machine.get("pivot_length_mm", 0.0) + machine.get("standoff_mm", 0.0)) * beam.direction
        axes = {"A": -np.degrees(phi), "X": np.zeros_like(phi), "Y": pivot[:, 2], "Z": np.hypot(pivot[:, 0], pivot[:, 1]), "B": counted}
        return {a["name"]: axes[a["name"]] for a in machine["axes"]}
    if machine["type"] == "crawler":
        up = machine["pivot_length_mm"] if machine["swing_center"] == "pivot" else 0.0
        way = up / -np.einsum("ij,ij->i", beam.direction, radial)
        pivot = outer - way[:, None] * beam.direction
        return {"S": phi * (tube.outer + machine["wheel_offset_mm"]), "E": pivot[:, 2], "B": counted}
    return {a["name"]: m.get("k_phi", 0.0) * np.degrees(phi) + m.get("k_z", 0.0) * z + m.get("k_b", 0.0) * counted
            + m.get("k_0", 0.0) for a, m in zip(machine["axes"], machine["maps"])}


def miss(machine, q, wanted, around, reach):
    """Pulses by which each period's counts miss every place of a path, at the path's best place within `reach` of
    `around`; `wanted(place)` gives {axis: value}. Convex there, so thirds close in on it."""
    scale = {a["name"]: pulses_per_unit(a) for a in machine["axes"]}

    def worst(place):
        values = wanted(place)
        return np.max([np.abs(scale[n] * (values[n] - q[n])) for n in scale], axis=0)

    low, high = around - reach, around + reach
    for _ in range(20):
        third = (high - low) / 3
        left = worst(low + third) <= worst(high - third)
        low, high = np.where(left, low, low + third), np.where(left, high - third, high)
    return worst((low + high) / 2)


def nearest(line, points, chunk=256):
    """For each point, (distance, segment, share) of the nearest place on the polyline; columns (s, z)."""
    a, d = line[:-1].T, np.diff(line, axis=0).T
    square = np.maximum((d**2).sum(0), 1e-300)
    out = []
    for first in range(0, len(points), chunk):
        s, z = points[first:first + chunk].T[:, :, None]
        share = np.clip(((s - a[0]) * d[0] + (z - a[1]) * d[1]) / square, 0, 1)
        distance = np.hypot(s - a[0] - share * d[0], z - a[1] - share * d[1])
        best = distance.argmin(1)
        rows = np.arange(len(best))
        out.append((distance[rows, best], best, share[rows, best]))
    return tuple(np.concatenate(column) for column in zip(*out))


def contour_lines(contour):
    """(phi, z, B) of the contour in radians, the first point repeated at the end of a closed one."""
    phi, z, b = (np.array(contour[n], dtype=float) for n in ("phi_deg", "z_mm", "b_deg"))
    if contour["closed"] and phi[-1] - phi[0] < 360 - 1e-6:
        phi, z, b = np.append(phi, phi[0] + 360), np.append(z, z[0]), np.append(b, b[0])
    return np.radians(phi), z, np.radians(b)


def cut_periods(result):
    """The samples between the events cut_start and cut_end: leads lie off the contour."""
    when = {event["what"]: event["period"] for event in result["events"]}
    return slice(when.get("cut_start", 0), when.get("cut_end", result["periods"]) + 1)


def measure(request, result):
    """Largest distance of the cut to the beam's wanted straight line: on the contour's surface, on the other wall (mm),
    in B (deg), and of the tip's stand-off (mm, with a height axis)."""
    machine, contour = request["machine"], request["contour"]
    tube = Tube(contour)
    beam, arm = torch(machine, tube, axis_values(machine, result))
    far = Beam(beam.phi, beam.point - 10 * tube.outer * beam.direction, beam.b)
    cut = cut_periods(result)
    phi, z, _ = far.at(tube.contour)
    line_phi, line_z, line_b = contour_lines(contour)
    if contour["closed"] and line_phi[-1] - line_phi[0] > np.pi:  # overcuts go over the first points again
        phi = line_phi[0] + np.mod(phi - line_phi[0], 2 * np.pi)
    at = np.stack([tube.contour * phi, z], -1)[cut]
    distance, index, share = nearest(np.stack([tube.contour * line_phi, line_z], -1), at)
    wanted_b = line_b[index] + share * np.diff(line_b)[index]
    wanted_phi = line_phi[index] + share * np.diff(line_phi)[index]
    wanted_z = line_z[index] + share * np.diff(line_z)[index]
    radial, _, axial = unit_vectors(wanted_phi)
    wanted = Beam(wanted_phi, tube.contour * radial + wanted_z[:, None] * axial, wanted_b)
    wanted.point = wanted.point - 10 * tube.outer * wanted.direction
    _, other_z, _ = far.at(tube.other)
    _, other_wanted, _ = wanted.at(tube.other)
    walls = {"outer": tube.outer, "inner": min(tube.contour, tube.other)}
    at_points = Beam(line_phi, np.zeros((len(line_phi), 3)), line_b)
    at_points.point = tube.contour * unit_vectors(line_phi)[0] + line_z[:, None] * unit_vectors(line_phi)[2] - 10 * tube.outer * at_points.direction
    edges = {}
    for name, radius in walls.items():
        line = np.stack([radius * line_phi, at_points.at(radius)[1]], -1)
        edges[f"{name}_edge_mm"] = nearest(line, np.stack([radius * phi, far.at(radius)[1]], -1)[cut])[0].max()
    out = edges | {"contour_mm": distance.max(), "b_deg": np.degrees(np.abs(beam.b[cut] - wanted_b)).max(),
                   "other_wall_mm": np.hypot(distance, (other_z - z)[cut] - (other_wanted - wanted_z)).max()}
    if arm is not None:
        out["standoff_mm"] = np.abs(beam.at(tube.outer)[2] - arm)[cut].max()
    return out


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    request, answer = (json.load(open(name, encoding="utf-8")) for name in sys.argv[1:])
    for name, value in measure(request, answer.get("result", answer)).items():
        print(f"{name:16} {value:.6f}")


if __name__ == "__main__":
    main()
