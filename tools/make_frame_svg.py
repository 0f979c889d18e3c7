#!/usr/bin/env python3
"""Draws docs/frame.svg: the frame, the sense of phi, clocking, offset, inclination, height, B and the kept side.

The curves are computed, not sketched: z of the upper sheet after docs/theory/intersections-and-bevels.md, section 1.
`tools/make_frame_svg.py > docs/frame.svg`."""

import math

RADIUS, WALL = 30.0, 6.0  # target
PARTNER = {"r": 44.0, "alpha": math.radians(60), "beta": math.radians(125), "s": 11.0, "h": 14.0}
INK, AXIS, TARGET, TUBE, MARK, ANGLE = "#1c2733", "#66727f", "#2f6fab", "#b9a27c", "#c0392b", "#1d7a46"


def upper_sheet(phi, rho=RADIUS):
    r, alpha, beta, s, h = PARTNER.values()
    u, v = rho * math.cos(phi - beta), rho * math.sin(phi - beta)
    return h + (math.sqrt(r * r - (u + s) ** 2) - v * math.cos(alpha)) / math.sin(alpha)


def turn(count=120):
    return [2 * math.pi * i / count for i in range(count + 1)]


class Panel:
    """Part of the picture with its own origin (px), scale (px per mm) and y upwards."""

    def __init__(self, x, y, scale=2.0):
        self.x, self.y, self.scale, self.out = x, y, scale, []

    def at(self, p):
        return f"{self.x + self.scale * p[0]:.1f},{self.y - self.scale * p[1]:.1f}"

    def path(self, points, stroke="none", width=1.5, fill="none", dash="", close=False, arrow=False, opacity=1.0):
        d = "M" + " L".join(self.at(p) for p in points) + ("Z" if close else "")
        extra = f' stroke-dasharray="{dash}"' if dash else ""
        extra += f' marker-end="url(#tip-{stroke[1:]})"' if arrow else ""
        extra += f' opacity="{opacity}"' if opacity != 1.0 else ""
        self.out.append(f'<path d="{d}" fill="{fill}" stroke="{stroke}" stroke-width="{width}"{extra}/>')

    def arc(self, centre, radius, begin, end, stroke, arrow=True):
        """Angles in radians, counter-clockwise from the panel's x."""
        steps = [begin + (end - begin) * i / 40 for i in range(41)]
        self.path([(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in steps], stroke, 1.8, arrow=arrow)

    def text(self, p, words, colour=INK, anchor="middle", size=14, weight="normal", style="normal"):
        x, y = self.at(p).split(",")
        self.out.append(f'<text x="{x}" y="{y}" fill="{colour}" text-anchor="{anchor}" font-size="{size}" '
                        f'font-weight="{weight}" font-style="{style}">{words}</text>')

    def dot(self, p, colour, size=3.5):
        x, y = self.at(p).split(",")
        self.out.append(f'<circle cx="{x}" cy="{y}" r="{size}" fill="{colour}"/>')

    def title(self, number, words, below):
        x, y = (250, 750)[self.x > 500], (36, 476)[self.y > 400]
        self.out.append(f'<text x="{x}" y="{y}" fill="{INK}" text-anchor="middle" font-size="16" '
                        f'font-weight="bold">{number}. {words}</text>')
        self.out.append(f'<text x="{x}" y="{y + 20}" fill="{AXIS}" text-anchor="middle" '
                        f'font-size="13">{below}</text>')


# 1: the joint in space -------------------------------------------------------------------------------------------------
class Camera:
    def __init__(self, azimuth, elevation):
        ca, sa, ce, se = math.cos(azimuth), math.sin(azimuth), math.cos(elevation), math.sin(elevation)
        self.right, self.up, self.to_eye = (-sa, ca, 0), (-ca * se, -sa * se, ce), (ca * ce, sa * ce, se)

    def __call__(self, p):
        return tuple(sum(a * b for a, b in zip(axis, p)) for axis in (self.right, self.up))

    def facing(self, normal):
        return sum(a * b for a, b in zip(self.to_eye, normal))


def shaded(colour, light):
    channels = (int(colour[i:i + 2], 16) for i in (1, 3, 5))
    return "#" + "".join(f"{round(255 - (255 - c) * (0.85 - 0.45 * light)):02x}" for c in channels)


def draw_space(panel):
    camera = Camera(math.radians(-60), math.radians(24))
    r, alpha, beta, s, h = PARTNER.values()
    sa, ca, sb, cb = math.sin(alpha), math.cos(alpha), math.sin(beta), math.cos(beta)
    along, across = (sa * sb, -sa * cb, ca), (cb, sb, 0)
    upward = (-ca * sb, ca * cb, sa)  # completes the partner's own frame: across x upward = along
    foot = (-s * cb, -s * sb, h)

    def on_partner(angle, w):
        c, t = r * math.cos(angle), r * math.sin(angle)
        return tuple(foot[i] + c * across[i] + t * upward[i] + w * along[i] for i in range(3))

    def on_target(phi, z, rho=RADIUS):
        return (rho * math.cos(phi), rho * math.sin(phi), z)

    ends, top = (-78, 74), 118
    steps = turn(60)
    for a, b in zip(steps, steps[1:]):
        normal = tuple(math.cos((a + b) / 2) * across[i] + math.sin((a + b) / 2) * upward[i] for i in range(3))
        if (light := camera.facing(normal)) > -0.02:
            quad = [on_partner(a, ends[0]), on_partner(b, ends[0]), on_partner(b, ends[1]), on_partner(a, ends[1])]
            colour = shaded(TUBE, light)
            panel.path([camera(p) for p in quad], colour, 0.7, colour, close=True)
    for w in ends:
        front = camera.facing(tuple(c * math.copysign(1, w) for c in along)) > 0
        ring = [camera(on_partner(a, w)) for a in turn()]
        panel.path(ring, "#8a7550", 1.3, shaded(TUBE, 0.2) if front else "none", close=True) if front else None
    for a, b in zip(steps, steps[1:]):  # the bore, seen through the open end
        if camera.facing((-math.cos((a + b) / 2), -math.sin((a + b) / 2), 0)) > -0.02:
            inner = RADIUS - WALL
            quad = [on_target(a, top - 30, inner), on_target(b, top - 30, inner), on_target(b, top, inner), on_target(a, top, inner)]
            panel.path([camera(p) for p in quad], "#2c557d", 0.7, "#2c557d", close=True)
    for a, b in zip(steps, steps[1:]):
        if (light := camera.facing((math.cos((a + b) / 2), math.sin((a + b) / 2), 0))) > -0.02:
            quad = [on_target(a, upper_sheet(a)), on_target(b, upper_sheet(b)), on_target(b, top), on_target(a, top)]
            colour = shaded(TARGET, light)
            panel.path([camera(p) for p in quad], colour, 0.7, colour, close=True)
    rings = [[camera(on_target(a, top, rho)) for a in turn()] for rho in (RADIUS, RADIUS - WALL)]
    panel.path(rings[0] + rings[1][::-1], "none", 0, "#dbe8f4", close=True)
    for ring in rings:
        panel.path(ring, TARGET, 1.3, close=True)
    seen = [a for a in turn(240) if camera.facing((math.cos(a), math.sin(a), 0)) > 0]
    seen.sort(key=lambda a: camera(on_target(a, 0))[0])
    panel.path([camera(on_target(a, upper_sheet(a))) for a in seen], MARK, 3)

    panel.path([camera((0, 0, top - 6)), camera((0, 0, top + 42))], INK, 1.8, arrow=True)
    panel.text((5, camera((0, 0, top + 40))[1]), "z", INK, "start", 16, "bold", "italic")
    for name, tip, shift in (("x", (60, 0), (4, -3)), ("y", (0, 62), (3, 1))):
        begin = (tip[0] * 0.55, tip[1] * 0.55, top)
        panel.path([camera((0, 0, top)), camera(begin)], AXIS, 1, dash="3 3")
        panel.path([camera(begin), camera((*tip, top))], INK, 1.8, arrow=True)
        end = camera((*tip, top))
        panel.text((end[0] + shift[0], end[1] + shift[1]), name, INK, "start", 16, "bold", "italic")
    sweep = [camera(on_target(math.radians(a), top, 40)) for a in range(4, 74, 2)]
    panel.path(sweep, ANGLE, 2, arrow=True)
    middle = camera(on_target(math.radians(32), top, 47))
    panel.text((middle[0] + 3, middle[1] - 4), "phi", ANGLE, "start", 15, "bold")
    kept = camera(on_target(math.radians(-60), 88))
    panel.text((kept[0], kept[1] - 2), "kept", "#ffffff", "middle", 16, "bold")
    panel.text((kept[0], kept[1] - 12), "z &gt; z_cut", "#ffffff", "middle", 13)
    axis_end = tuple(foot[i] + 100 * along[i] for i in range(3))
    axis_begin = tuple(foot[i] + ends[1] * along[i] for i in range(3))
    panel.path([camera(axis_begin), camera(axis_end)], "#8a7550", 1.8, arrow=True)
    tip = camera(axis_end)
    panel.text((tip[0] + 4, tip[1]), "d", "#8a7550", "start", 16, "bold", "italic")
    panel.text((-40, -38), "partner tube", "#6d5a38", "middle", 14)
    cut = camera(on_target(math.radians(-120), upper_sheet(math.radians(-120))))
    panel.text((cut[0] - 22, cut[1] + 6), "cut", MARK, "end", 15, "bold")
    panel.path([(cut[0] - 20, cut[1] + 7), (cut[0] - 4, cut[1] + 2)], MARK, 1.2)
    panel.title(1, "The joint", "z: the target's axis, from the cut end into the kept part")


# 2: seen from the tip of z -----------------------------------------------------------------------------------------------------
def dimension(panel, a, b, words, where, colour=MARK):
    panel.path([a, b], colour, 1.8, arrow=True)
    panel.text(where, words, colour, "start", 14, "bold")


def draw_top(panel):
    r, _, beta, s, _ = PARTNER.values()
    across, along = (math.cos(beta), math.sin(beta)), (math.sin(beta), -math.cos(beta))

    def place(x, w):  # x along the common perpendicular, w along the partner
        return (x * across[0] + w * along[0], x * across[1] + w * along[1])

    reach = 70
    band = [place(-s - r, -reach), place(-s - r, reach), place(-s + r, reach), place(-s + r, -reach)]
    panel.path(band, "none", 0, "#efe6d3", close=True)
    for edge in (-s - r, -s + r):
        panel.path([place(edge, -reach), place(edge, reach)], "#8a7550", 1.3)
    circle = [(math.cos(a), math.sin(a)) for a in turn()]
    outer, inner = ([(rho * x, rho * y) for x, y in circle] for rho in (RADIUS, RADIUS - WALL))
    panel.path(outer + inner[::-1], "none", 0, "#a9c8e4", close=True)
    for ring in (outer, inner):
        panel.path(ring, TARGET, 1.4, close=True)
    panel.path([place(-s, -reach - 6), place(-s, reach + 10)], "#8a7550", 1.8, dash="12 4 2 4", arrow=True)
    tip = place(-s, reach + 10)
    panel.text((tip[0] + 3, tip[1] - 6), "d", "#8a7550", "start", 16, "bold", "italic")
    for end, name, shift in (((62, 0), "x", (3, -2)), ((0, 62), "y", (3, -2))):
        panel.path([(0, 0), end], INK, 1.8, arrow=True)
        panel.text((end[0] + shift[0], end[1] + shift[1]), name, INK, "start", 16, "bold", "italic")
    panel.text((64, -11), "phi = 0", AXIS, "middle", 12)
    panel.path([(0, 0), place(66, 0)], MARK, 1.6, dash="5 4", arrow=True)
    end = place(70, 0)
    panel.text((end[0], end[1] + 7), "common perpendicular", MARK, "middle", 13)
    panel.text((end[0], end[1] + 1), "(cos beta, sin beta)", MARK, "middle", 12)
    panel.arc((0, 0), 45, 0, beta - 0.02, ANGLE)
    panel.text((28, 42), "clocking beta", ANGLE, "start", 14, "bold")
    panel.arc((0, 0), 54, math.radians(-62), math.radians(-14), ANGLE)
    panel.text((48, -34), "phi", ANGLE, "start", 15, "bold")
    panel.path([place(-s, 0), (0, 0)], MARK, 3.2, arrow=True)
    panel.dot(place(-s, 0), "#8a7550")
    panel.dot((0, 0), INK)
    panel.path([(2.5, -6.5), (-30, -55)], MARK, 0.9)
    panel.text((-31, -60), "offset s &gt; 0", MARK, "end", 14, "bold")
    panel.text((-31, -67.5), "from the partner's axis", MARK, "end", 12)
    panel.text((-31, -74), "to the target's axis", MARK, "end", 12)
    panel.title(2, "Clocking and offset", "seen from the tip of z: phi turns from x towards y")


# 3: seen from the tip of the common perpendicular --------------------------------------------------------------------------------
def draw_side(panel):
    r, alpha, beta, _, h = PARTNER.values()
    along, up = (-math.sin(alpha), math.cos(alpha)), (math.cos(alpha), math.sin(alpha))

    def place(y, w):
        return (y * up[0] + w * along[0], h + y * up[1] + w * along[1])

    band = [place(-r, -70), place(-r, 78), place(r, 78), place(r, -70)]
    panel.path(band, "none", 0, "#efe6d3", close=True)
    top = 112
    near = [a for a in turn(720) if math.cos(a - beta) >= 0]  # the half towards the eye
    near.sort(key=lambda a: math.sin(a - beta))
    far = [a for a in turn(720) if math.cos(a - beta) <= 0]
    far.sort(key=lambda a: math.sin(a - beta))
    front, back = ([(RADIUS * math.sin(a - beta), upper_sheet(a)) for a in half] for half in (near, far))
    panel.path(front + [(RADIUS, top), (-RADIUS, top)], TARGET, 1.4, "#a9c8e4", close=True)
    for edge in (-r, r):
        panel.path([place(edge, -70), place(edge, 78)], "#8a7550", 1.3)
    panel.path(back, MARK, 1.6, dash="4 3")
    panel.path(front, MARK, 3)
    panel.path([(0, -34), (0, top + 24)], INK, 1.8, dash="12 4 2 4", arrow=True)
    panel.text((4, top + 20), "z", INK, "start", 16, "bold", "italic")
    panel.path([place(0, -70), place(0, 88)], "#8a7550", 1.8, dash="12 4 2 4", arrow=True)
    tip = place(0, 88)
    panel.text((tip[0] - 4, tip[1] + 1), "d", "#8a7550", "end", 16, "bold", "italic")
    panel.arc((0, h), 27, math.radians(90), math.radians(90) + alpha - 0.03, ANGLE)
    panel.path([(-15, h + 25), (-46, h + 74)], ANGLE, 0.9)
    panel.text((-48, h + 76), "inclination alpha", ANGLE, "end", 14, "bold")
    panel.dot((0, 0), INK)
    panel.dot((0, h), "#8a7550")
    for z in (0, h):
        panel.path([(0, z), (52, z)], AXIS, 1, dash="3 3")
    panel.path([(48, 0), (48, h)], MARK, 1.8, arrow=True)
    panel.text((53, h / 2 - 2), "height h &gt; 0", MARK, "start", 14, "bold")
    panel.text((50, -7), "z = 0", AXIS, "start", 12)
    panel.text((15, 93), "kept", TARGET, "middle", 16, "bold")
    panel.text((42, 66), "cut", MARK, "start", 15, "bold")
    panel.text((42, 59), "dashed: far half", MARK, "start", 12)
    panel.path([(41, 66), (30.5, 50)], MARK, 1.2)
    panel.text(place(-r + 9, -44), "partner", "#6d5a38", "middle", 14)
    panel.title(3, "Inclination and height", "seen from the tip of the common perpendicular")


# 4: section at one phi -------------------------------------------------------------------------------------------------
def draw_section(panel):
    inner, outer, root, bevel, top = 0.0, 52.0, 0.0, math.radians(33), 78.0
    rise = (outer - inner) * math.tan(bevel)
    panel.path([(inner, root), (outer, root + rise), (outer, top), (inner, top)], "none", 0, "#a9c8e4", close=True)
    for x, low in ((inner, root), (outer, root + rise)):
        panel.path([(x, low), (x, top)], TARGET, 1.6)
    break_line = [(inner + (outer - inner) * i / 40, top + 1.8 * math.sin(i * math.pi / 10)) for i in range(41)]
    panel.path(break_line, TARGET, 1.2)
    surface = [(x, root + 0.04 * x - 0.0045 * x * x) for x in range(-36, 84, 2)]
    panel.path(surface + [(82, -36), (-36, -36)], "none", 0, "#efe6d3", close=True)
    panel.path(surface, "#8a7550", 1.5)
    panel.text((-2, -24), "partner", "#6d5a38", "middle", 14)
    groove = [(inner, root), (outer, root + rise)] + [p for p in reversed(surface) if 0 <= p[0] <= outer]
    panel.path(groove, "none", 0, "#f8dfc0", close=True)
    panel.text((37, 5), "groove", "#9a5b10", "middle", 13)
    panel.path([(outer, root + rise), (outer + 34, root + rise + 34 * math.tan(bevel))], MARK, 1.4, dash="7 4")
    panel.path([(inner, root), (outer, root + rise)], MARK, 3)
    panel.text((outer + 36, root + rise + 34 * math.tan(bevel) - 2), "torch", MARK, "start", 14, "bold")
    panel.path([(inner, root), (80, root)], AXIS, 1.2, dash="4 3")
    panel.path([(-66, -20), (-66, 20)], INK, 1.8, arrow=True)
    panel.text((-63, 19), "z", INK, "start", 16, "bold", "italic")
    panel.path([(-66, -20), (-44, -20)], INK, 1.8, arrow=True)
    panel.text((-54, -28), "radius", INK, "middle", 13)
    panel.arc((inner, root), 62, 0, bevel - 0.02, ANGLE)
    panel.text((66, 13), "B &gt; 0", ANGLE, "start", 15, "bold")
    down = math.radians(-16)
    panel.path([(54, 54 * math.tan(down)), (72, 72 * math.tan(down))], AXIS, 1.2, dash="2 4")
    panel.arc((inner, root), 66, 0, down + 0.02, AXIS)
    panel.text((72, -11), "B &lt; 0", AXIS, "start", 14)
    panel.dot((inner, root), MARK)
    panel.dot((outer, root + rise), MARK)
    panel.text((inner - 3, root + 5), "z_inner", MARK, "end", 14)
    panel.path([(outer + 1.5, root + rise + 1), (outer + 9, root + rise + 21)], MARK, 0.9)
    panel.text((outer + 7, root + rise + 23), "z_outer", MARK, "start", 14)
    panel.text((26, 58), "kept", TARGET, "middle", 16, "bold")
    panel.text((inner - 3, 66), "bore", AXIS, "end", 13)
    panel.text((outer + 4, 66), "outside", AXIS, "start", 13)
    panel.title(4, "B, at one phi", "positive: the outer edge lies further into the kept part")


def main():
    panels = [Panel(245, 312, 1.66), Panel(760, 248, 2.15), Panel(255, 760, 1.78), Panel(690, 752, 2.6)]
    for panel, draw in zip(panels, (draw_space, draw_top, draw_side, draw_section)):
        draw(panel)
    tips = "".join(
        f'<marker id="tip-{c[1:]}" viewBox="0 0 10 10" refX="9" refY="5" markerUnits="userSpaceOnUse" markerWidth="11" '
        f'markerHeight="11" orient="auto"><path d="M0 1 L10 5 L0 9Z" fill="{c}"/></marker>'
        for c in (INK, AXIS, MARK, ANGLE, "#8a7550"))
    print('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 880" width="1000" height="880" '
          'font-family="DejaVu Sans, Verdana, Arial, sans-serif" stroke-linejoin="round" stroke-linecap="round">')
    print("<title>tubecut's frame: z, phi, clocking, offset, inclination, height, B and the kept side</title>")
    print(f'<defs>{tips}</defs><rect width="1000" height="880" fill="#ffffff"/>')
    print('<path d="M500 20V860M20 440H980" stroke="#d5dbe1" stroke-width="1"/>')
    for panel in panels:
        print("<g>" + "\n".join(panel.out) + "</g>")
    print("</svg>")


if __name__ == "__main__":
    main()
