#!/usr/bin/env python3
"""Slow and idle clients: `slow.py BINARY LOAD SECONDS HALVES IDLE [--must-fail]`. HALVES sockets send a head byte by byte, as many a body,
IDLE kept-alive ones do nothing; up to 200 send half a head to the admin port. Each that is closed comes back. Meanwhile the probe's p99
is at most 50 ms and good traffic loses nothing. With --must-fail, BINARY being the stock library, one of these has to break."""

import json
import subprocess
import sys
import tempfile
import time

from service import Service, connect, exchange, get, head, post, receive

P99_MS = 50.0
PATIENCE_S = 1.0
COME_BACK = 16  # connections in one step
AT_ADMIN = 200  # half-sent heads that the admin port must bear


def probe(port):
    """Milliseconds to its answer; infinite when none comes in time."""
    start = time.perf_counter()
    try:
        replies = exchange(port, get("/readyz"), patience=PATIENCE_S)
    except OSError:
        replies = []
    if not replies:
        return float("inf")
    assert replies[0].status == 200, replies[0].status
    return 1e3 * (time.perf_counter() - start)


class Slow:
    """A socket that sends `first`, then `rest` at each step; with no rest it takes its answer and is idle."""

    def __init__(self, port, first, rest):
        self.port, self.first, self.rest = port, first, rest
        self.begin()

    def begin(self):
        self.sock = connect(self.port)
        self.sock.sendall(self.first)
        if not self.rest:  # one after the other, because requests for all answers at once would fill the queue
            receive(self.sock, enough=1, patience=PATIENCE_S)
        self.sock.setblocking(False)

    def step(self):
        """Sends a byte; says whether the server had ended the connection."""
        try:
            if self.rest:
                self.sock.send(self.rest)
            if self.sock.recv(4096) == b"":
                raise ConnectionError
        except BlockingIOError:
            return False
        except OSError:
            self.sock.close()
            return True
        return False


def main():
    must_fail = "--must-fail" in sys.argv
    binary, load, seconds, halves, idle = (word for word in sys.argv[1:] if not word.startswith("--"))
    seconds, halves, idle = float(seconds), int(halves), int(idle)
    probes, ended, away = [], 0, []
    with Service(binary) as service, tempfile.NamedTemporaryFile() as good:
        good.write(post())
        good.flush()
        crowd = [Slow(service.port, b"GET /v1/version HTTP/1.1\r\nHost: x\r\nX: ", b"a") for _ in range(halves)]
        crowd += [Slow(service.port, head("Content-Length: 100000"), b" ") for _ in range(halves)]
        crowd += [Slow(service.port, get("/v1/version"), b"") for _ in range(idle)]
        at_admin = 0 if service.stock else min(halves, AT_ADMIN)
        crowd += [Slow(service.admin_port, b"GET /livez HTTP/1.1\r\nHost: x\r\nX: ", b"a") for _ in range(at_admin)]
        traffic = subprocess.Popen([load, str(seconds), "4", str(service.port), good.name, "--rate", "200"],
                                   stdout=subprocess.PIPE, text=True)
        until = time.monotonic() + seconds
        step = 0
        while time.monotonic() < until:
            probes.append(probe(service.admin_port))
            for member in away[:COME_BACK]:
                member.begin()
                crowd.append(member)
            away = away[COME_BACK:]
            for member in crowd[step % 10::10]:  # each about once in ten steps
                if member.step():
                    crowd.remove(member)
                    away.append(member)
                    ended += 1
            step += 1
        told = json.loads(traffic.communicate()[0])
        resident = service.memory("VmRSS")
        refused = {} if service.stock else service.refused()
    probes.sort()
    p99 = probes[int(0.99 * (len(probes) - 1))]
    good_ones = told["statuses"].get("200", 0)
    others = sum(told["statuses"].values()) - good_ones
    print(f"{2 * halves} slow and {idle} idle sockets, {at_admin} at the admin port, for {seconds:g} s, {ended} ended by the server: {len(probes)} probes, "
          f"p50 {probes[len(probes) // 2]:.1f} ms, p99 {p99:.1f} ms (limit {P99_MS:g}); good traffic {good_ones} answered, "
          f"{others} otherwise of {told['statuses']}, {told['lost']} lost, p99 {told['accepted_ms']['p99']:.1f} ms; resident {resident:.1f} MiB; "
          f"refused {refused}")
    sound = p99 <= P99_MS and told["lost"] == 0 and others == 0 and good_ones > 0 and len(probes) > 20
    sys.exit(p99 <= P99_MS if must_fail else not sound)


main()
