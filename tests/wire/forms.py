"""What every endpoint's answer can be asked for as, by the contract: each format in each of its views, on one sheet and tiled, and programs
with what makes them dearest. `targets()` gives the targets by endpoint, the plain JSON first."""

import functools

import yaml

from service import ROOT

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # libyaml reads the contract in a fifth of the time

NAMES = {"application/json": "json", "application/cbor": "cbor", "text/csv": "csv", "image/svg+xml": "svg", "application/pdf": "pdf", "image/vnd.dxf": "dxf",
         "model/gltf-binary": "glb", "model/stl": "stl", "model/step": "step", "application/x-dstv": "nc1", "text/x-gcode": "gcode",
         "text/x-iec61131-st": "st", "application/zip": "zip"}
PROGRAM = "&speed_mm_min=600&lead_mm=1000"  # the longest lead is halved most often
FILES = "&files=work-order,nc1,dxf,step,csv,gcode"


def options(says):
    """Query of the dearest ways that a format's options give."""
    reads = says.get("x-options", [])
    program = PROGRAM if "speed_mm_min" in reads else ""
    files = FILES if "files" in reads else ""
    lands = [files + program + "&passes=both"] if "passes" in reads else []  # refused if there is no land
    held = [files + program + "&tabs=12&tab_mm=20&tabs_of=all"] if "tabs" in reads else []  # refused where a cut is short
    return [files + program, *lands, *held, *(["&paper=a4"] if "paper" in reads else [])]


def forms(content):
    for media, says in content.items():
        if media not in NAMES:  # lines, that are an answer of another kind
            continue
        for view in says.get("x-views", [""]):
            for option in options(says):
                if view in ("template", "") or "paper" not in option:
                    yield f"format={NAMES[media]}" + (f"&view={view}" if view else "") + option


@functools.cache
def targets():
    paths = yaml.load((ROOT / "openapi.yaml").read_text(), LOADER)["paths"]
    posts = {path.removeprefix("/v1/"): item["post"]["responses"]["200"].get("content", {}) for path, item in paths.items() if "post" in item}
    out = {endpoint: [f"/v1/{endpoint}?{form}" for form in forms(content)] for endpoint, content in posts.items()}
    return {endpoint: ways for endpoint, ways in out.items() if ways}
