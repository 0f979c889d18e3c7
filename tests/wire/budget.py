#!/usr/bin/env python3
"""Budgets and hang-ups with the heaviest examples: `budget.py BINARY [--times]`. A job over its budget is 504 and its slot is
free again; a client that leaves frees its slot. With --times also: it stops within 50 ms of its budget, at every budget."""

import json
import sys
import time

from service import ROOT, Service, connect, exchange, get, head, post

LATE_MS = 50.0


def bodies():
    """Requests that compute for long, by endpoint."""
    for endpoint, name, edit in (
            ("mill-paths", "case-a-end-up", lambda b: b.update(positions=720)),
            ("pulse-schedules", "source-001-mill-path", lambda b: None),
            ("bevel-tables", "table-1-torch-45-deg", lambda b: b["sampling"].update(uniform_points=20000)),
            ("intersections", "source-000-table-1", lambda b: b.update(sampling={"tolerance_mm": 0.0001})),
            ("holes", "through-brace", lambda b: b.update(sampling={"tolerance_mm": 0.0001})),
            ("feed-curves", "cut-off-194-mm-whole-cycle", lambda b: b["cycle"].update(period_s=0.0002)),
            ("pulse-schedules", "table-1-on-the-five-axis-cutter", lambda b: b.setdefault("motion", {}).update(speed={"mm_min": 20}))):
        body = json.loads((ROOT / f"examples/{endpoint}/{name}.json").read_text())
        edit(body)
        yield f"{endpoint}/{name}", f"/v1/{endpoint}", json.dumps(body).encode()


def idle_again(service):
    until = time.monotonic() + 5
    while time.monotonic() < until:
        if service.metric("tubecut_slots_busy ") == 0 and service.metric("tubecut_queue_depth ") == 0:
            return True
        time.sleep(0.01)
    return False


def main():
    times = "--times" in sys.argv
    worst, over, wrong = 0.0, 0, []
    with Service(sys.argv[1], "--slots", "1") as service:
        for name, target, body in bodies():
            for budget in (1, 5, 20, 60, 150, 400):
                request = post(body, f"Tubecut-Budget-Ms: {budget}", target=target)
                start = time.perf_counter()
                reply = exchange(service.port, request, patience=20.0)[0]
                late = 1e3 * (time.perf_counter() - start) - budget
                if reply.status == 504:
                    over += 1
                    worst = max(worst, late)
                    print(f"{name}: budget {budget} ms: 504, {late:.1f} ms late")
                    if json.loads(reply.body)["code"] != "over_budget":
                        wrong.append(f"{name}: {reply.body}")
                elif reply.status not in (200, 413, 422, 429):
                    wrong.append(f"{name}: {reply.status} {reply.body[:200]}")
                if not idle_again(service):
                    wrong.append(f"{name}: the slot stays busy")
        name, target, body = next(bodies())
        before = service.metric("tubecut_clients_hung_up_total ")
        with connect(service.port) as sock:
            sock.sendall(post(body, target=target))
            time.sleep(0.05)
            busy = service.metric("tubecut_slots_busy ")
        start = time.perf_counter()
        if busy != 1 or not idle_again(service):
            wrong.append("a client that hung up keeps its slot")
        freed = 1e3 * (time.perf_counter() - start)
        if service.metric("tubecut_clients_hung_up_total ") != before + 1:
            wrong.append("the hang-up is not counted")
    print("\n".join(wrong))
    print(f"{over} jobs over their budget, the latest {worst:.1f} ms after it (limit {LATE_MS:g}); "
          f"slot free {freed:.0f} ms after its client hung up")
    sys.exit(bool(wrong) or over < 5 or (times and worst > LATE_MS))


main()
