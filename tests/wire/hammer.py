#!/usr/bin/env python3
"""Load for a time: `hammer.py BINARY LOAD SECONDS`. Every example of every endpoint, refusals, chunks and catalogues over 16
connections; nothing may be lost, and the server ends well. Under a sanitizer its exit code tells what was found."""

import json
import pathlib
import subprocess
import sys
import tempfile

from memory import mixed
from service import ROOT, Service, exchange, post


def main():
    binary, load, seconds = sys.argv[1], sys.argv[2], sys.argv[3]
    with Service(binary, "--budget-s", "300") as service, tempfile.TemporaryDirectory() as folder:
        files = []
        examples = [post(path.read_bytes(), target=f"/v1/{path.parent.name}") for path in sorted(ROOT.glob("examples/*/*.json"))]
        refused = [data[:80] for data in examples if exchange(service.port, data, 60.0)[0].status != 200]
        assert examples and not refused, refused
        for i, data in enumerate([*mixed(), *examples]):
            path = pathlib.Path(folder) / str(i)
            path.write_bytes(data)
            files.append(str(path))
        told = json.loads(subprocess.run([load, seconds, "16", str(service.port), *files], check=True, capture_output=True, text=True).stdout)
        code = service.stop(60)
    statuses = told["statuses"]
    print(f"{sum(statuses.values())} requests of {len(files)} kinds in {seconds} s, {told['lost']} lost, statuses {statuses}, exit code {code}")
    sys.exit(code != 0 or told["lost"] > 0 or statuses.get("200", 0) == 0 or any(s.startswith("5") and s != "503" for s in statuses))


main()
