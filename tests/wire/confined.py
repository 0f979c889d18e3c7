#!/usr/bin/env python3
"""The costliest jobs and the slowest readers within a container's memory: `confined.py BINARY [--mib 256,512,768] [--group]`. One slot;
replays as large as the replica takes, drawings of many samples, long answers in every format, all of them several at a time, and 17
clients that take nothing of 12 MB answers. With --group, or --heaviest, also all of heaviest.py and costly.py. The process lives, its
peak stays within the container, afterwards it has given the memory back, and small jobs are answered. With --group it runs in a control
group of that size (as root; version 1 or 2) and the kernel is the judge; without, --memory-bytes is what it would find there, and its
peak (VmHWM) is held against the size."""

import argparse
import collections
import contextlib
import json
import os
import pathlib
import stat
import sys
import tempfile
import threading
import time

import costly
import heaviest
from service import ROOT, Service, connect, exchange, head, post

SHARE = 0.6  # of the container, see server/jobs/capacity.cpp
# Resident once all is over: the program and the heaps of two slots and of the thread for short jobs (66 to 75 MiB seen). Far below the
# 130 MiB that the slow readers hold and the peak, because a server that kept either would have to fail here, and no other.
KEPT_MIB = 100
SLOW_READERS = 17
AT_ONCE = 4
HEAVIEST_MS = 2000


def example(name):
    return json.loads((ROOT / f"examples/{name}.json").read_text())


def edited(name, **changes):
    return json.dumps(example(name) | changes).encode()


def replay_of(size):
    """A square cut that then stands still, in about so many bytes."""
    body = example("replays/square-cut")
    counts = body["schedule"]["counts"]
    idle = max(0, size - len(json.dumps(body)) - 1000) // (2 * len(counts))
    for name in counts:
        counts[name] = counts[name] + [0] * idle
    return json.dumps(body, separators=(",", ":")).encode()


def curve(period_s):
    body = example("feed-curves/cut-off-194-mm-whole-cycle")
    body["cycle"]["period_s"] = period_s
    return json.dumps(body).encode()


def largest_replay(service):
    """Bytes of body that the replica takes of one, as its refusal says."""
    with connect(service.port, 5.0) as sock:
        sock.sendall(head("Content-Length: 8388608", target="/v1/replays"))
        sock.settimeout(0.5)
        try:
            text = sock.recv(1 << 16).decode()
        except TimeoutError:
            return 8 << 20
    return int(text.split("free memory of ")[1].split(" ")[0])


def drained(port, request, statuses, patience=120.0):
    """Sends a request and counts the status of its answer, which is read and dropped."""
    with contextlib.suppress(OSError), connect(port, patience) as sock:
        sock.sendall(request)
        first, size = b"", 0
        while b"\r\n\r\n" not in first and (more := sock.recv(1 << 16)):
            first += more
        if b"\r\n\r\n" not in first:
            statuses["none"] += 1
            return
        front, rest = first.split(b"\r\n\r\n", 1)
        length = int(front.lower().split(b"content-length: ")[1].split(b"\r\n")[0])
        size = len(rest)
        while size < length and (more := sock.recv(1 << 20)):
            size += len(more)
        statuses[int(front.split(b" ")[1]) if size == length else "broken"] += 1
        return
    statuses["broken"] += 1


def together(service, requests):
    statuses = collections.Counter()
    threads = [threading.Thread(target=drained, args=(service.port, request, statuses)) for request in requests]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return dict(statuses)


def long_answers():
    points = {"uniform_points": 20000}
    for name, formats in (("bevel-tables/zones", ("json", "cbor", "csv", "glb")), ("holes/through-brace", ("json", "cbor", "csv")),
                          ("intersections/source-000-table-1", ("dxf&view=tube",)), ("parts/chord-with-holes", ("csv", "dxf&view=tube"))):
        for form in formats:
            yield post(edited(name, sampling=points), target=f"/v1/{name.split('/')[0]}?format={form}")
    for form in ("csv", "glb"):
        yield post(edited("grooves/case-a-right-angle", sections=20000), target=f"/v1/grooves?format={form}")
    yield post(curve(2e-5), target="/v1/feed-curves?format=csv&view=samples")
    slow = example("pulse-schedules/source-001-mill-path")
    slow["motion"]["speed"] = {"mm_min": 2}
    yield post(json.dumps(slow).encode(), target="/v1/pulse-schedules?format=cbor")


def heaviest_requests():
    """What was thought of and what was found, with an everyday budget: what a job needs it has taken by then."""
    budget = f"Tubecut-Budget-Ms: {HEAVIEST_MS}"
    for endpoint, _, body in heaviest.requests():
        yield post(heaviest.text(body), budget, target=f"/v1/{endpoint}?format=cbor")
    for target, body in costly.requests():
        yield post(heaviest.text(body), budget, target=target)


def slow_readers(service):
    request = post(edited("holes/through-brace", sampling={"uniform_points": 20000}), target="/v1/holes")
    socks = []
    for _ in range(SLOW_READERS):
        sock = connect(service.port, 30.0)
        sock.sendall(request)
        socks.append(sock)
    time.sleep(6.0)
    held = service.memory("VmRSS")
    for sock in socks:
        sock.close()
    return held


@contextlib.contextmanager
def group_of(mib):
    """A control group of the caller's own with so much memory; its folder."""
    for line in pathlib.Path("/proc/self/cgroup").read_text().splitlines():
        _, controllers, path = line.split(":", 2)
        if controllers in ("", "memory"):
            base = "/sys/fs/cgroup" + ("/memory" if controllers else "") + path
            if not controllers and not (pathlib.Path(base) / "memory.max").exists() and path == "/":
                continue  # version 2 without the controller, next to version 1
            folder = pathlib.Path(base) / f"tubecut-{os.getpid()}"
            folder.mkdir()
            (folder / ("memory.limit_in_bytes" if controllers else "memory.max")).write_text(str(mib << 20))
            try:
                yield folder
            finally:
                time.sleep(0.3)
                folder.rmdir()
            return
    raise OSError("no control group for memory")


def of_group(folder):
    """(peak in MiB, kills) as the kernel counted them."""
    peak = next(f for f in ("memory.max_usage_in_bytes", "memory.peak", "memory.current") if (folder / f).exists())
    counts = next(f for f in ("memory.oom_control", "memory.events") if (folder / f).exists())
    kills = next(int(line.split()[1]) for line in (folder / counts).read_text().splitlines() if line.startswith("oom_kill "))
    return int((folder / peak).read_text()) / 2**20, kills


def run(command, mib, options, folder=None, heavy=False):
    """What is wrong."""
    wrong = []
    with Service(command, "--slots", "1", "--budget-s", "120", "--write-s", "4", *options) as service:
        parts = []

        def part(name, told):
            parts.append(f"{name} {told}, peak {service.memory():.0f} MiB")
            if {"none", "broken", 500} & set(told if isinstance(told, dict) else ()):
                wrong.append(f"{mib} MiB: {name}: {told}")
            return told

        def answered(told, least, what):
            if told.get(200, 0) < least:
                wrong.append(f"{mib} MiB: of {what} fewer than {least} are answered: {told}")

        largest = largest_replay(service)
        answered(part(f"replays of {largest} bytes", together(service, [post(replay_of(largest), target="/v1/replays")] * 2)), 1, "replays of the size it takes")
        for step, fits in ((5e-5, 0), (1e-5, 512)):
            told = part(f"drawings of {10 / step:.0f} samples", together(service, [post(curve(step), target="/v1/feed-curves?format=svg")] * AT_ONCE))
            answered(told, int(mib >= fits), "drawings")
        everything, told = list(long_answers()), collections.Counter()
        for at in range(0, len(everything), AT_ONCE):
            told += collections.Counter(part("long answers", together(service, everything[at:at + AT_ONCE])))
        answered(told, len(everything) * (3 if mib >= 512 else 2) // 4, "long answers")
        if heavy:
            everything, told = list(heaviest_requests()), collections.Counter()
            for at in range(0, len(everything), AT_ONCE):
                told += collections.Counter(together(service, everything[at:at + AT_ONCE]))
            part(f"{len(everything)} heaviest", dict(told))
        part("slow readers hold", f"{slow_readers(service):.0f} MiB")
        time.sleep(1.0)
        part("small jobs", together(service, [post()] * AT_ONCE))
        if service.alive() and exchange(service.port, post())[0].status != 200:
            wrong.append(f"{mib} MiB: a small job is refused when all is over")
        kept, peak = service.memory("VmRSS"), service.memory()
        print(f"{mib} MiB: " + "; ".join(parts) + f"; then {kept:.0f} MiB resident")
        if not service.alive() or peak > mib:
            wrong.append(f"{mib} MiB: peak {peak:.0f} MiB, alive {service.alive()}")
        if kept > KEPT_MIB:
            wrong.append(f"{mib} MiB: {kept:.0f} MiB kept (limit {KEPT_MIB})")
        if folder is not None:
            of_kernel, kills = of_group(folder)
            print(f"{mib} MiB: the group's peak {of_kernel:.0f} MiB, {kills} kills")
            if kills:
                wrong.append(f"{mib} MiB: {kills} kills")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary")
    parser.add_argument("--mib", default="256")
    parser.add_argument("--group", action="store_true")
    parser.add_argument("--heaviest", action="store_true")
    a = parser.parse_args()
    wrong = []
    for mib in (int(word) for word in a.mib.split(",")):
        if not a.group:
            wrong += run(a.binary, mib, ["--memory-bytes", str(int(SHARE * (mib << 20)))], heavy=a.heaviest)
            continue
        with group_of(mib) as folder, tempfile.TemporaryDirectory() as own:
            joins = pathlib.Path(own) / "joins"
            joins.write_text(f"#!/bin/sh\necho $$ >{folder}/cgroup.procs && exec {pathlib.Path(a.binary).resolve()} \"$@\"\n")
            joins.chmod(joins.stat().st_mode | stat.S_IXUSR)
            wrong += run(str(joins), mib, [], folder, heavy=True)
    print("\n".join(wrong) or "within the memory")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
