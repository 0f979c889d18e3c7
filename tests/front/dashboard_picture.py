"""docker/grafana-dashboard.json drawn over scrapes that were recorded, panel by panel in its grid: where there is no Grafana to look at it in."""

import html
import json
import pathlib
import re

from alarms import words

FILE = json.loads((pathlib.Path(__file__).resolve().parents[2] / "docker/grafana-dashboard.json").read_text())
VARIABLES = {"$__rate_interval": "5m", "$instance": ".*"}
COLUMN, ROW, POINTS = 62, 34, 100
COLOURS = ("#3274d9", "#e0762f", "#2f9e5a", "#c23b6e", "#7a4fc0", "#937014", "#0f8f9c", "#8c3b1f")
SUFFIXES = {"percentunit": (100, " %"), "s": (1000, " ms"), "bytes": (1 / 1048576, " MiB"), "reqps": (1, "/s"), "ops": (1, "/s"), "short": (1, "")}


def expressions():
    """(panel, target, expression with the variables' values)"""
    for panel in FILE["panels"]:
        for target in panel["targets"]:
            expression = target["expr"]
            for name, value in VARIABLES.items():
                expression = expression.replace(name, value)
            yield panel, target, expression


def names():
    return words(expression for _, _, expression in expressions())


def legend(target, labels):
    of = dict(re.findall(r'(\w+)="(.*?)"', labels))
    return re.sub(r"{{(\w+)}}", lambda m: of.get(m[1], ""), target.get("legendFormat") or "")


def curves(record):
    """{panel id: {legend: {step: value}}}"""
    steps = sorted({round(i * (record.steps - 1) / POINTS) for i in range(POINTS + 1)})
    every = [(panel, target, expression, step) for panel, target, expression in expressions() for step in steps]
    found = {}
    for (panel, target, _, step), values in zip(every, record.values((expression, step) for *_, expression, step in every)):
        for labels, value in values.items():
            if value == value:
                found.setdefault(panel["id"], {}).setdefault(legend(target, labels), {})[step] = value
    return found


def text(x, y, words_, size=12, extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" {extra}>{html.escape(words_)}</text>'


def shown(value, unit):
    factor, suffix = SUFFIXES[unit]
    return f"{value * factor:.3g}{suffix}"


def stat(lines, unit, width, height, steps):
    last = {name: of[steps - 1] for name, of in lines.items() if steps - 1 in of}
    for i, (name, value) in enumerate(last.items()):
        words_ = f"{name} {shown(value, unit)}" if len(last) > 1 else shown(value, unit)
        yield text(width / 2, height / 2 + 22 + 24 * (i - (len(last) - 1) / 2), words_, 26 if len(last) == 1 else 15, 'text-anchor="middle" fill="#1f6f43"')


def series(lines, unit, width, height, steps):
    most = max((v for of in lines.values() for v in of.values()), default=0.0) or 1.0
    left, right, top, bottom = 62, width - 8, 34, height - 40
    for part in (0, 0.5, 1):
        y = bottom - part * (bottom - top)
        yield f'<path d="M{left} {y:.1f}H{right}" stroke="#ddd"/>' + text(left - 4, y + 4, shown(part * most, unit), 10, 'text-anchor="end" fill="#666"')
    at = left
    for i, (name, of) in enumerate(sorted(lines.items())):
        colour, points, before = COLOURS[i % len(COLOURS)], [], None
        for step, value in sorted(of.items()):
            x, y = left + (right - left) * step / max(steps - 1, 1), bottom - value / most * (bottom - top)
            gap = before is None or step - before > 2 * steps / POINTS + 1
            points.append(f"{'M' if gap else 'L'}{x:.1f} {y:.1f}")
            before = step
        yield f'<path d="{"".join(points)}" fill="none" stroke="{colour}" stroke-width="1.5"/>'
        if at < right - 40:
            yield text(at, height - 14, name[:28], 10, f'fill="{colour}"')
        at += 12 + 5.6 * len(name[:28])


def draw(record):
    """SVG."""
    found = curves(record)
    out, depth = [], 0
    for panel in FILE["panels"]:
        g, lines, unit = panel["gridPos"], found.get(panel["id"], {}), panel["fieldConfig"]["defaults"]["unit"]
        width, height = g["w"] * COLUMN - 8, g["h"] * ROW - 8
        depth = max(depth, (g["y"] + g["h"]) * ROW)
        body = (stat if panel["type"] == "stat" else series)(lines, unit, width, height, record.steps)
        out += [f'<g transform="translate({g["x"] * COLUMN + 4} {g["y"] * ROW + 4})"><rect width="{width}" height="{height}" fill="#fff" stroke="#ccc"/>',
                text(8, 18, panel["title"], 13, 'font-weight="600"'), *(body if lines else [text(8, 40, "no data")]), "</g>"]
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{24 * COLUMN}" height="{depth}" font-family="sans-serif">'
            f'<rect width="100%" height="100%" fill="#f4f5f7"/>{"".join(out)}</svg>\n')
