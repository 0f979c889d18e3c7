#!/usr/bin/env python3
"""One client's long jobs beside everybody else's: `fair.py BINARY SECONDS`. Two of some seconds on a service that has answered nothing yet,
then a batch of long lines, then eight connections of long jobs, all from this address; meanwhile catalogues and small jobs are asked for
over connections of their own. None of those is refused. When the long ones are over, the service is idle and refuses nothing."""

import json
import sys
import threading
import time

import heaviest
from service import BODY, ROOT, Service, connect, exchange, get, head, post

HOGS = 8


def example(name):
    return json.loads((ROOT / f"examples/pulse-schedules/{name}.json").read_text())


def long_jobs():
    """A slow cut, and a slow part whose many cuts are each a schedule."""
    cut, part = example("table-1-on-the-five-axis-cutter"), example("two-ends-and-four-holes-of-a-part")
    yield cut | {"motion": cut.get("motion", {}) | {"speed": {"mm_min": 20}}}
    yield part | {"motion": part["motion"] | {"speed": {"mm_min": 100}}}


def batch_of(count):
    bodies = list(long_jobs())
    lines = b"".join(json.dumps({"id": f"long {n}", "endpoint": "pulse-schedules", "body": bodies[n % len(bodies)]}).encode() + b"\n"
                     for n in range(count))
    return head(f"Content-Length: {len(lines)}", target="/v1/batches").replace(b"application/json", b"application/x-ndjson") + lines


def hog(port, until):
    requests = [post(json.dumps(body).encode(), target="/v1/pulse-schedules") for body in long_jobs()]
    while time.monotonic() < until:
        for request in requests:
            exchange(port, request, patience=20.0)


def keep_reading(sock, until):
    while time.monotonic() < until:
        try:
            if not sock.recv(1 << 16):
                return
        except OSError:
            return


def victims(port, until, kinds):
    """Statuses and the longest wait in ms, by the request's name."""
    told = {name: ({}, [0.0]) for name, _ in kinds}
    while time.monotonic() < until:
        for name, request in kinds:
            start = time.monotonic()
            replies = exchange(port, request, patience=10.0)
            status = replies[0].status if replies else 0
            statuses, longest = told[name]
            statuses[status] = statuses.get(status, 0) + 1
            longest[0] = max(longest[0], 1e3 * (time.monotonic() - start))
        time.sleep(0.02)
    return told


def main():
    binary, seconds = sys.argv[1], float(sys.argv[2])
    kinds = [("catalogue", get("/v1/tubes")), ("small job", post(BODY))]
    wrong = []

    def judge(what, told):
        for name, (statuses, longest) in told.items():
            print(f"{what}, {name}: {statuses}, the longest {longest[0]:.0f} ms")
            if set(statuses) != {200}:
                wrong.append(f"{what}: {name}: {statuses}")

    first = post(heaviest.text(next(body for endpoint, name, body in heaviest.requests() if f"{endpoint}/{name}" == "mill-paths/20000")),
                 target="/v1/mill-paths")
    with Service(binary, "--slots", "1") as service, connect(service.port, 60.0) as sock, connect(service.port, 60.0) as other:
        for one in (sock, other):
            one.sendall(first)
        time.sleep(0.3)
        judge("beside the first jobs", victims(service.port, time.monotonic() + min(seconds, 3.0), kinds))
        if service.metric("tubecut_slots_busy ") < 1:
            wrong.append("the first job was over meanwhile")
    with Service(binary, "--slots", "1") as service:
        for _ in range(20):  # time of a small job
            exchange(service.port, post(BODY))
        until = time.monotonic() + seconds
        with connect(service.port, 60.0) as sock:
            sock.sendall(batch_of(200))
            threading.Thread(target=keep_reading, args=(sock, until), daemon=True).start()
            time.sleep(0.3)
            judge("beside a batch", victims(service.port, until, kinds))
        time.sleep(3.0)
        until = time.monotonic() + seconds
        hogs = [threading.Thread(target=hog, args=(service.port, until)) for _ in range(HOGS)]
        for one in hogs:
            one.start()
        time.sleep(0.3)
        judge(f"beside {HOGS} connections", victims(service.port, until, kinds))
        for one in hogs:
            one.join()
        judge("after them", victims(service.port, time.monotonic() + 1.0, kinds))
        long_ones = service.metric('tubecut_jobs_total{endpoint="pulse-schedules"')
    print("\n".join(wrong) or f"none refused beside {long_ones:.0f} long jobs")
    sys.exit(bool(wrong) or long_ones < 3)


main()
