#!/usr/bin/env python3
"""Budgets and hang-ups with the costliest requests found, of every endpoint and in every format and view: `budget.py BINARY [--times]`. A job
over its budget is 504, and its slot is free again; a client that leaves frees its slot. With --times also: no job, whatever its answer, has
used more than 250 ms of CPU beyond its budget, a slot is free soon after its client left (a build with sanitizers: as many times more as it is
slower), and the sizes in ALLOWED are answered within what their endpoints have by default."""

import json
import select
import sys
import time

import costly
import forms
import heaviest
from service import Service, connect, post, read_to_the_end

LATE_MS = 250.0
FREED_MS = 350.0  # after a hang-up: 250 until a client that has closed one side is taken for gone, seen every 20, 20 until the job ends
BUDGETS_MS = (5, 50, 500)
ALL_MS = 120_000  # the budget of whoever has to end by itself
ALLOWED = {"mill-paths/90-annealed", "mill-paths/3600", "mill-paths/20000", "pulse-schedules/crawler-table", "pulse-schedules/5-m",
           "pulse-schedules/compare", "pulse-schedules/3600-positions"}


def cpu_ms(reply):
    """0 of what was refused before any work."""
    timing = dict(part.split(";dur=") for part in (reply.get("Server-Timing") or "cpu;dur=0").split(", "))
    return float(timing["cpu"])


def ask(service, body, target, budget_ms):
    reply = read_to_the_end(service.port, post(body, f"Tubecut-Budget-Ms: {budget_ms}", "Connection: close", target=target))
    if reply is None:
        sys.exit(f"{target}: no answer; {body[:200]!r}")
    return reply


def idle_again(service, seconds=5.0):
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if service.metric("tubecut_slots_busy ") == 0 and service.metric("tubecut_queue_depth ") == 0:
            return True
        time.sleep(0.01)
    return False


def jobs(times):
    """Name, target, body, budgets."""
    budgets, ways = BUDGETS_MS if times else BUDGETS_MS[:2], forms.targets()
    for endpoint, name, body in heaviest.requests():
        for target in ways[endpoint] if times else ways[endpoint][:1]:
            yield f"{name} {target}", target, heaviest.text(body), budgets
    for target, body in costly.requests():
        yield target, target, heaviest.text(body), budgets


# Heaviest for the reader, or refused because they would take too long.
REFUSED = ("star-500 ", "crossed ", "unknown-fields ", "full ")


class Watch:
    def __init__(self, service):
        self.service, self.over, self.worst, self.wrong = service, 0, 0.0, []
        self.late_ms = LATE_MS * service.slowdown()

    def see(self, name, reply, budget):
        late = cpu_ms(reply) - budget
        if late > self.late_ms:
            print(f"{name}: {reply.status}, budget {budget} ms, {late:.1f} ms of CPU beyond it", flush=True)
        self.worst = max(self.worst, late)
        if reply.status == 504:
            self.over += 1
            if json.loads(reply.body)["code"] != "over_budget":
                self.wrong.append(f"{name}: {reply.body}")
        elif reply.status == 422 and "compute;" not in reply.get("Server-Timing") and not name.startswith(REFUSED):
            self.wrong.append(f"{name}: refused before it took anything: {reply.body[:300]}")
        elif reply.status not in (200, 413, 422, 429):
            self.wrong.append(f"{name}: {reply.status} {reply.body[:200]}")
        if not idle_again(self.service):
            self.wrong.append(f"{name}: the slot stays busy")

    def hang_up(self, name, target, body):
        """The client leaves after 50 ms of its job: nobody waits for the answer, the slot is free soon."""
        before = self.service.metric("tubecut_clients_hung_up_total ")
        with connect(self.service.port) as sock:
            sock.sendall(post(body, f"Tubecut-Budget-Ms: {ALL_MS}", target=target))
            # Whose job has not begun yet would be counted while the next client is here.
            while not select.select([sock], [], [], 0.05)[0] and self.service.metric("tubecut_slots_busy ") == 0:
                pass
            busy = self.service.metric("tubecut_slots_busy ")
        start = time.perf_counter()
        if not idle_again(self.service):
            self.wrong.append(f"{name}: a client that hung up keeps its slot")
        freed = 1e3 * (time.perf_counter() - start)
        if busy == 1 and self.service.metric("tubecut_clients_hung_up_total ") > before + 1:
            self.wrong.append(f"{name}: the hang-up is not counted once")
        return freed if busy == 1 else 0.0


def allowed(service):
    """What is wrong: sizes that the contract allows, by name, are answered within their endpoints' own budgets."""
    for endpoint, name, body in heaviest.requests():
        if f"{endpoint}/{name}" not in ALLOWED:
            continue
        with connect(service.port, 300.0) as sock:
            sock.sendall(post(heaviest.text(body), "Connection: close", target=f"/v1/{endpoint}?format=cbor"))
            status = int(sock.recv(1 << 16).split(b" ")[1])
        if status != 200:
            yield f"{endpoint}/{name}: {status} by default"


def main():
    times = "--times" in sys.argv
    freed, wrong = 0.0, []
    if times:
        with Service(sys.argv[1], "--slots", "1") as service:
            wrong = list(allowed(service)) if service.slowdown() == 1 else []
    with Service(sys.argv[1], "--slots", "1", "--budget-s", "120") as service:
        watch = Watch(service)
        watch.wrong += wrong
        for name, target, body, budgets in jobs(times):
            for budget in budgets:
                reply = ask(service, body, target, budget)
                watch.see(name, reply, budget)
                if reply.status != 504:
                    break
        for endpoint, name, body in heaviest.requests():
            freed = max(freed, watch.hang_up(f"{endpoint}/{name}", f"/v1/{endpoint}", heaviest.text(body)))
    if times and freed > FREED_MS * watch.late_ms / LATE_MS:
        watch.wrong.append(f"a slot is free only {freed:.0f} ms after its client left")
    print("\n".join(watch.wrong))
    print(f"{watch.over} jobs over their budget, the latest by {watch.worst:.1f} ms of CPU (limit {watch.late_ms:g}); "
          f"slots free {freed:.0f} ms after their clients hung up")
    sys.exit(bool(watch.wrong) or watch.over < 50 or (times and watch.worst > watch.late_ms))


if __name__ == "__main__":
    main()
