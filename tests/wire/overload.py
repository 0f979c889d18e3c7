#!/usr/bin/env python3
"""Five times the capacity: `overload.py BINARY LOAD SECONDS [--record]`. The capacity is what as many connections as there
are slots get done; then requests come at five times that rate over many connections. Goodput stays at 90 % of the capacity,
the rest is 429 or 503 with Retry-After, and 99 of 100 refusals take at most 10 ms. --record: prints, judges only what holds on
a machine others use too (no loss, Retry-After everywhere, no other status)."""

import json
import subprocess
import sys
import tempfile

from service import ROOT, Service, post

EXAMPLE = ROOT / "examples/bevel-tables/table-1-torch-45-deg.json"


def run(load, *words):
    return json.loads(subprocess.run([load, *map(str, words)], check=True, capture_output=True, text=True).stdout)


def main():
    record = "--record" in sys.argv
    binary, load, seconds = sys.argv[1], sys.argv[2], float(sys.argv[3])
    body = json.dumps(json.loads(EXAMPLE.read_text()), separators=(",", ":")).encode()
    with Service(binary) as service, tempfile.NamedTemporaryFile() as request:
        request.write(post(body, target="/v1/bevel-tables"))
        request.flush()
        slots = int(service.metric("tubecut_slots "))
        capacity = 0.0
        for connections in (slots, 2 * slots, 8 * slots):
            told = run(load, min(seconds, 10), connections, service.port, request.name)
            capacity = max(capacity, told["statuses"].get("200", 0) / told["seconds"])
        told = run(load, seconds, 400, service.port, request.name, "--rate", 5 * capacity)
        alive = service.alive()
    statuses = told["statuses"]
    goodput = statuses.get("200", 0) / seconds
    refused = sum(n for status, n in statuses.items() if status in ("429", "503"))
    others = sum(statuses.values()) - refused - statuses.get("200", 0)
    late = told["refused_ms"]
    print(f"{slots} slots: capacity {capacity:.0f}/s, offered {5 * capacity:.0f}/s for {seconds:g} s: goodput {goodput:.0f}/s "
          f"({100 * goodput / capacity:.0f} %), {refused} refused in p50 {late['p50']:.1f}, p99 {late['p99']:.1f}, max {late['max']:.1f} ms ({late['over_10_ms']} over 10), "
          f"{told['without_retry_after']} without Retry-After, {others} otherwise, {told['lost']} lost; "
          f"accepted p99 {told['accepted_ms']['p99']:.0f} ms")
    sound = alive and refused > 0 and goodput > 0 and others == 0 and told["lost"] == 0 and told["without_retry_after"] == 0
    sys.exit(not (sound and (record or (goodput >= 0.9 * capacity and late["p99"] <= 10.0))))


main()
