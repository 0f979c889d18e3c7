#!/usr/bin/env python3
"""Same request, same bytes, whoever answers: `same_bytes.py BINARY [--all]`. Every example is answered once by `run`, without
a server; then all are posted over several connections at once to a server of one slot, to one of two, and to three replicas
in turn. Nothing in a body may differ. Without --all a few examples, and no replicas."""

import concurrent.futures
import contextlib
import itertools
import subprocess
import sys

from service import ROOT, Service, exchange, post

CONNECTIONS = 8
ROUNDS = 3  # each example runs next to others
FEW = ("bevel-tables/mitre", "bevel-tables/zones", "frames/gate-with-rails-through-uprights", "grooves/case-a-right-angle", "holes/through-brace",
       "intersections/source-000-table-1", "nodes/k-joint-with-tables", "parts/k-joint-brace", "replays/square-cut")
PATIENT = ("--budget-s", "60", "--queue", "64")  # compares the answers, not their times


def examples(every):
    """(endpoint, name, body); of a theme's folder the endpoint is the one above the file."""
    found = {f"{file.parent.name}/{file.stem}": file for file in sorted((ROOT / "examples").rglob("*.json"))}
    return [(name.split("/")[0], name, file.read_bytes()) for name, file in found.items() if every or name in FEW]


def alone(binary, endpoint, body):
    return subprocess.run([binary, "run", "--endpoint", endpoint, "-"], input=body, capture_output=True, check=True).stdout


def answers(ports, jobs, at_once):
    """What each job gets, in their order; the ports take turns."""
    turns = itertools.cycle(ports)

    def ask(job):
        (endpoint, _, body), port = job
        replies = exchange(port, post(body, "Connection: close", target=f"/v1/{endpoint}"), patience=120.0)
        return replies[0].body if replies and replies[0].status == 200 else b"%r" % [(r.status, r.body[:200]) for r in replies]

    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        return list(pool.map(ask, [(job, next(turns)) for job in jobs]))


def main():
    every = "--all" in sys.argv
    binary = next(word for word in sys.argv[1:] if not word.startswith("--"))
    few = examples(every)
    assert len(few) >= len(FEW), [name for _, name, _ in few]
    known = [alone(binary, endpoint, body) for endpoint, _, body in few]
    # One at a time, whoever is free helps with its pieces.
    ways = ({"one slot": (1, 1, CONNECTIONS), "two slots": (1, 2, CONNECTIONS), "three slots, one at a time": (1, 3, 1)}
            | ({"three replicas": (3, 1, CONNECTIONS)} if every else {}))
    differing = 0
    for way, (replicas, slots, at_once) in ways.items():
        with contextlib.ExitStack() as stack:
            services = [stack.enter_context(Service(binary, *PATIENT, "--slots", str(slots), "--replica", f"r{i}"))
                        for i in range(replicas)]
            # Turned by one each round: another replica, other neighbours.
            for n in range(ROUNDS):
                got = answers([service.port for service in services], few[n:] + few[:n], at_once)
                for (_, name, _), expected, body in zip(few[n:] + few[:n], known[n:] + known[:n], got):
                    if body != expected:
                        differing += 1
                        print(f"{way}: {name} differs: {len(body)} bytes {body[:120]!r}, alone {len(expected)} bytes")
        print(f"{way}: {len(few)} examples, {ROUNDS} times, {at_once} at once")
    print(f"{differing} answers differ from those of `run`")
    sys.exit(differing > 0)


main()
