#!/usr/bin/env python3
"""SIGTERM with work in flight: `drain.py BINARY [--must-fail]`. 20 requests are sent whole, then the signal, before most of
them are answered. Each is answered all the same, and the program ends with 0 within 10 s. With --must-fail, BINARY being the
stock library, which stops by its own stop(), some have to be lost."""

import json
import select
import signal
import subprocess
import sys
import time

import heaviest
from service import ROOT, Service, connect, get, post, receive

REQUESTS = 20
POINTS = 600  # some 10 ms of a slot on an idle machine
LEAST = 10  # of them unanswered at the signal, else nothing is shown
SECONDS = 10.0
KEPT = 900  # connections


def job():
    body = json.loads((ROOT / "examples/bevel-tables/source-000-table-1.json").read_text())
    body["sampling"] = {"uniform_points": POINTS}
    return post(json.dumps(body).encode(), target="/v1/bevel-tables")


def kept_alive(binary):
    """Requests on connections kept alive that reach the socket just before the signal: more than the port looks at in a turn."""
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


def main():
    must_fail = "--must-fail" in sys.argv
    request = job()
    # A budget for slow builds too. The stock server takes its time by sleeping.
    with Service(sys.argv[1], "--slots", "1", "--budget-s", "30") as service:
        socks = [connect(service.port) for _ in range(REQUESTS)]
        for sock in socks:
            sock.sendall(request)
        time.sleep(0.02)
        early = len(select.select(socks, [], [], 0)[0])
        start = time.monotonic()
        until = start + SECONDS
        service.process.terminate()
        statuses = [[r.status for r in receive(sock, enough=1, patience=until - time.monotonic())[0]] for sock in socks]
        answered = statuses.count([200])
        try:
            code = service.process.wait(max(0.0, until - time.monotonic()))
        except subprocess.TimeoutExpired:
            code = None
        seconds = time.monotonic() - start
    print(f"SIGTERM with {REQUESTS - early} of {REQUESTS} in flight: {answered} answered, "
          f"others {[s for s in statuses if s != [200]]}; ended with {code} after {seconds:.1f} s (limit {SECONDS:g})")
    shown = REQUESTS - early >= LEAST
    sys.exit(not (shown and answered < REQUESTS) if must_fail else
             not (shown and answered == REQUESTS and code == 0 and kept_alive(sys.argv[1]) and beyond_its_time(sys.argv[1])))


if __name__ == "__main__":
    main()
