#!/usr/bin/env python3
"""A machine that others keep busy: `loaded.py BINARY`. The service has one CPU beside three threads that take a fourth of it each.
Ordinary schedules with three times the CPU they need are answered, although they take longer than that by the wall's clock; one with
half of what it needs is 504 all the same."""

import contextlib
import json
import os
import statistics
import subprocess
import sys
import time

from service import ROOT, Service, exchange, post

TARGET = "/v1/pulse-schedules"
BODY = (ROOT / "examples/pulse-schedules/table-1-on-the-five-axis-cutter.json").read_bytes()
TRIES = 10
SLOT_NICE = 5  # a job's thread gives way to the port's


def cpu_ms(reply):
    return float(dict(part.split(";dur=") for part in reply.get("Server-Timing").split(", "))["cpu"])


def ask(service, budget_ms):
    """Status, and how long the answer took in ms."""
    start = time.perf_counter()
    reply = exchange(service.port, post(BODY, f"Tubecut-Budget-Ms: {budget_ms}", target=TARGET), patience=60.0)[0]
    return reply, 1e3 * (time.perf_counter() - start)


@contextlib.contextmanager
def busy(cpu, threads):
    spin = f"import os; os.nice({SLOT_NICE}); os.sched_setaffinity(0, {{{cpu}}})\nwhile True: pass"
    others = [subprocess.Popen([sys.executable, "-c", spin]) for _ in range(threads)]
    try:
        yield
    finally:
        for other in others:
            other.kill()
            other.wait()


def main():
    everywhere = os.sched_getaffinity(0)
    cpu = min(everywhere)
    os.sched_setaffinity(0, {cpu})  # the service inherits it
    with Service(sys.argv[1]) as service:
        os.sched_setaffinity(0, everywhere)
        ask(service, 60000)  # the first finds cold caches and costs up to twice as much
        needs = statistics.median(cpu_ms(ask(service, 60000)[0]) for _ in range(5))
        budget = round(3 * needs)
        with busy(cpu, threads=3):
            tries = [ask(service, budget) for _ in range(TRIES)]
            short, _ = ask(service, max(1, round(needs / 2)))
    answered = sum(reply.status == 200 for reply, _ in tries)
    longer = sum(took > budget for _, took in tries)
    print(f"a schedule of {needs:.0f} ms of CPU, budget {budget} ms: {answered} of {TRIES} answered, "
          f"{longer} after more than that; with {round(needs / 2)} ms: {short.status}")
    sys.exit(answered < TRIES or longer < TRIES / 2 or short.status != 504 or json.loads(short.body)["code"] != "over_budget")


main()
