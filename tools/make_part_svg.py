#!/usr/bin/env python3
"""Draws docs/part-table-1.svg: the first sheet of a work order as the service gives it, of source 000's Table 1 with a square far end.

`tools/make_part_svg.py SERVER_BINARY > docs/part-table-1.svg` starts the binary on free ports and posts the example to it."""

import json
import pathlib
import re
import subprocess
import sys
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "examples/parts/table-1-with-a-square-far-end.json"
REFERENCE = {"order": "4711", "drawing": "N-12", "revision": "B", "material": "S355J2H", "quantity": 4}


def work_order(binary):
    server = subprocess.Popen([binary, "--host", "127.0.0.1", "--port", "0", "--admin-port", "0"], stdout=subprocess.PIPE, text=True)
    try:
        port = next(json.loads(line)["port"] for line in server.stdout if '"ready"' in line)
        body = json.dumps({**json.loads(EXAMPLE.read_text()), "reference": REFERENCE}).encode()
        request = urllib.request.Request(f"http://127.0.0.1:{port}/v1/parts?format=svg", body, {"Content-Type": "application/json"})
        return urllib.request.urlopen(request, timeout=30).read().decode()
    finally:
        server.terminate()
        server.wait()


def first_sheet(svg):
    """Sheets stand one below the other, 297 mm each."""
    count = svg.count('<g id="sheet-')
    svg = re.sub(rf'height="{297 * count}\.000mm" viewBox="0 0 210\.000 {297 * count}\.000"', 'height="297mm" viewBox="0 0 210 297"', svg)
    return re.sub(r'<g id="sheet-2">.*(?=</svg>)', "", svg, flags=re.S)


if __name__ == "__main__":
    sys.stdout.write(first_sheet(work_order(sys.argv[1])))
