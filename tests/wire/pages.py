#!/usr/bin/env python3
"""Pages of memory, slow to come by in a virtual machine: `pages.py BINARY`. They are mapped in large ones where the system has
such, and what a job has freed the next one takes: for a second table of 20 000 points less than half as many are mapped as it
fills. What nobody takes goes back: a few seconds after them the process holds little more than before."""

import json
import os
import pathlib
import sys
import time

from service import ROOT, Service, post, read_to_the_end

TARGET = "/v1/bevel-tables?format=glb"
TABLE = json.loads((ROOT / "examples/bevel-tables/mitre.json").read_bytes())
BODY = json.dumps(TABLE | {"sampling": {"uniform_points": 20000}}).encode()
PART = 0.5  # of the filled pages; 1.5 without kept ones, with small ones
KEPT_MIB = 16.0  # caches of threads, pages of 2 MiB that are still used in part
BACK_S = 20.0
LARGE = pathlib.Path("/sys/kernel/mm/transparent_hugepage/enabled")


def faults(service):
    """Pages that the system has mapped for the process."""
    return int(pathlib.Path(f"/proc/{service.process.pid}/stat").read_text().rsplit(")", 1)[1].split()[7])


def ask(service):
    reply = read_to_the_end(service.port, post(BODY, "Tubecut-Budget-Ms: 60000", "Connection: close", target=TARGET))
    assert reply and reply.status == 200, reply and reply.body
    return faults(service)


def main():
    page = os.sysconf("SC_PAGE_SIZE")
    with Service(sys.argv[1]) as service:
        before = service.memory("VmRSS")
        first = ask(service)
        filled = (service.memory("VmHWM") - before) * (1 << 20) / page
        mapped = ask(service) - first
        deadline = time.monotonic() + BACK_S
        while (kept := service.memory("VmRSS") - before) > KEPT_MIB and time.monotonic() < deadline:
            time.sleep(0.1)
    print(f"a table that fills {filled:.0f} pages: {mapped} are mapped for a second one (limit {PART:g} of them); "
          f"{kept:.1f} MiB kept after (limit {KEPT_MIB:g})")
    large = LARGE.exists() and "[never]" not in LARGE.read_text()
    sys.exit(filled < 1000 or large and mapped > PART * filled or kept > KEPT_MIB)


if __name__ == "__main__":
    main()
