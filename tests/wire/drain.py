#!/usr/bin/env python3
"""SIGTERM with work in flight: `drain.py BINARY [--must-fail]`. One long job holds the only slot, so 20 requests wait behind it
on a machine of any speed when the signal comes. Each is answered all the same, and the program ends with 0 once they are. With
--must-fail, BINARY is the stock library, which sleeps for a fixed time per job and stops by its own stop(): some must be lost."""

import json
import select
import signal
import sys
import time

import heaviest
from service import ROOT, Service, connect, get, post, receive

REQUESTS = 20
POINTS = 600
LONG = (64 << 10) + 1  # bytes of a body: the job is of the long class, so that one takes the only slot and the others wait
LEAST = 10  # of them unanswered at the signal, else nothing is shown
SECONDS = 10.0  # without progress
WORK_SECONDS = 120.0  # for all accepted work, on a slow and loaded machine too
KEPT = 900  # connections


def job():
    body = json.loads((ROOT / "examples/bevel-tables/source-000-table-1.json").read_text())
    body["sampling"] = {"uniform_points": POINTS}
    return post(json.dumps(body).encode().ljust(LONG), target="/v1/bevel-tables")


def kept_alive(binary):
    """Requests on connections kept alive that reach the socket just before the signal: more than the port reads before it yields."""
    with Service(binary, "--queue", str(KEPT), "--budget-s", "60") as service:
        socks = [connect(service.port) for _ in range(KEPT)]
        request = get("/v1/version")
        for sock in socks:
            sock.sendall(request)
            receive(sock, enough=1)
        service.process.send_signal(signal.SIGSTOP)
        for sock in socks:
            sock.sendall(request)
        service.process.terminate()
        service.process.send_signal(signal.SIGCONT)
        answered = sum([r.status for r in receive(sock, enough=1)[0]] == [200] for sock in socks)
        code = service.process.wait(SECONDS)
    print(f"SIGTERM beside {KEPT} requests on connections kept alive: {answered} answered; ended with {code}")
    return answered == KEPT and code == 0


def beyond_its_time(binary):
    """A job that would take longer than there is for accepted work ends where it is, and nothing waits for it."""
    job = next(body for endpoint, name, body in heaviest.requests() if f"{endpoint}/{name}" == "mill-paths/20000")
    with Service(binary, "--slots", "1", "--budget-s", "120", "--drain-s", "0.5") as service, connect(service.port) as sock:
        sock.sendall(post(heaviest.text(job), target="/v1/mill-paths"))
        until = time.monotonic() + SECONDS
        while service.metric("tubecut_slots_busy ") == 0 and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(0.1)
        service.process.terminate()
        statuses = [reply.status for reply in receive(sock, enough=1, patience=SECONDS)[0]]
        code = service.process.wait(SECONDS)
    print(f"SIGTERM beside a job of some seconds: {statuses}; ended with {code}")
    return statuses == [503] and code == 0


def until(condition, seconds=WORK_SECONDS):
    """Waits until the condition holds; returns whether it does."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.005)
    return True


def long_job():
    """Takes longer than 20 requests take to arrive, by some hundred times."""
    body = json.loads((ROOT / "examples/bevel-tables/table-1-torch-45-deg.json").read_text())
    body["sampling"] = {"uniform_points": 20000}
    return post(json.dumps(body).encode().ljust(LONG), target="/v1/bevel-tables")


def work_in_flight(service, holder):
    """The connections of 20 requests that wait behind the holder's job, and of the holder."""
    holder.sendall(long_job())
    until(lambda: service.metric("tubecut_slots_busy ") == 1)
    socks = [connect(service.port) for _ in range(REQUESTS)]
    request = job()
    for sock in socks:
        sock.sendall(request)
    waiting = until(lambda: service.metric("tubecut_queue_depth ") == REQUESTS)
    return socks if waiting else []


def drains(binary):
    """All accepted work is answered after SIGTERM."""
    with Service(binary, "--slots", "1", "--budget-s", "60", "--drain-s", str(WORK_SECONDS)) as service, connect(service.port) as holder:
        socks = work_in_flight(service, holder)
        busy = service.metric("tubecut_slots_busy ") == 1
        service.process.terminate()
        statuses = [[r.status for r in receive(sock, enough=1, patience=WORK_SECONDS)[0]] for sock in [holder, *socks]]
        answered = statuses.count([200])
        code = service.process.wait(SECONDS)
    print(f"SIGTERM with {len(socks)} requests behind a long job: {answered} answered, "
          f"others {[s for s in statuses if s != [200]]}; ended with {code}")
    return busy and len(socks) == REQUESTS and answered == REQUESTS + 1 and code == 0


def stock_loses_work(binary):
    """The same signal to the stock server, whose jobs sleep: fewer than half are done after 20 ms on any machine."""
    with Service(binary) as service:
        socks = [connect(service.port) for _ in range(REQUESTS)]
        for sock in socks:
            sock.sendall(job())
        time.sleep(0.02)
        early = len(select.select(socks, [], [], 0)[0])
        service.process.terminate()
        answered = [[r.status for r in receive(sock, enough=1, patience=SECONDS)[0]] for sock in socks].count([200])
    print(f"stock: SIGTERM with {REQUESTS - early} of {REQUESTS} in flight: {answered} answered")
    return REQUESTS - early >= LEAST and answered < REQUESTS


def main():
    if "--must-fail" in sys.argv:
        sys.exit(not stock_loses_work(sys.argv[1]))
    sys.exit(not all([drains(sys.argv[1]), kept_alive(sys.argv[1]), beyond_its_time(sys.argv[1])]))


if __name__ == "__main__":
    main()
