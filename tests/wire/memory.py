#!/usr/bin/env python3
"""Memory over many mixed requests: `memory.py BINARY LOAD REQUESTS`. After a warm-up of a tenth of them, and 10 000 at least,
resident memory may grow by 2 MiB at most over the rest, or else over as many again. Every endpoint has its part but the milling of a groove, which takes
longer than all others together (hammer.py has it)."""

import json
import subprocess
import sys
import tempfile
import pathlib

from service import BODY, ROOT, Service, get, head, post

LIMIT_MIB = 2.0
WARM_UP = 10_000
PARTS = 4
ROUNDS = 2
MITRE = (ROOT / "examples/nodes/mitre.json").read_bytes()


def example(name, *headers):
    return post((ROOT / f"examples/{name}.json").read_bytes(), *headers, target="/v1/" + name.split("/")[0])


def mixed():
    """Whole requests: answers, refusals, catalogues, other formats, chunks, connections that end."""
    yield get("/v1/version")
    yield get("/v1/limits", "Cookie: a=b")
    yield get("/v1/tubes", "Accept-Encoding: gzip, br")
    yield get("/v1/machines", "Connection: close")
    yield get("/nowhere")
    yield get("/v1/nodes", method="PUT")
    yield post(json.dumps(json.loads(BODY) | {"sampling": {"uniform_points": 36}}).encode())
    yield post(b"{not json")
    yield post(b'{"a": 1}')
    yield post(b"{}", "Content-Encoding: gzip")
    yield post(b'{"a": ' + b"[" * 40)
    yield post(BODY.replace(b"{", b'{"unknown": [1, 2, {"deep": 1e-400}], ', 1))
    yield example("nodes/mitre", "Accept: application/cbor", "Job-Id: soak")
    yield head("Transfer-Encoding: chunked", target="/v1/nodes") + b"%x\r\n%s\r\n0\r\n\r\n" % (len(MITRE), MITRE)
    yield example("bevel-tables/mitre")
    yield example("holes/set-on-branch")
    yield example("nodes/k-joint-from-centre-lines", "traceparent: 00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01")


def heavy():
    """Requests that take 2 to 20 ms each: one of every endpoint that `mixed` leaves out."""
    yield example("parts/k-joint-brace")
    yield example("replays/square-cut")
    yield example("grooves/case-b-near-equal-diameters")
    yield example("feed-curves/calibrated-from-one-measurement")
    yield example("pulse-schedules/square-cut-from-a-bare-contour")


def main():
    binary, load, wanted = sys.argv[1], sys.argv[2], int(sys.argv[3])
    with Service(binary) as service, tempfile.TemporaryDirectory() as folder:
        files = []
        for i, data in enumerate([*mixed(), *heavy()]):
            path = pathlib.Path(folder) / str(i)
            path.write_bytes(data)
            files.append(str(path))
        # The heavy ones come once in this many turns, so that they are a fifth of the work.
        light = len(list(mixed()))
        files = files[:light] * 40 + files[light:]

        def run(seconds):
            told = json.loads(subprocess.run([load, str(seconds), "16", str(service.port), *files], check=True,
                                             capture_output=True, text=True).stdout)
            return sum(told["statuses"].values()), told

        done, told = run(2)
        rate = max(1.0, done / 2)
        # The most of it: pages come and go by 2 MiB, and one that is away at the moment is no growth when it is back.
        before = 0.0
        for _ in range(PARTS):
            run(max(1.0, 0.1 * wanted / rate / PARTS, WARM_UP / rate / PARTS))
            before = max(before, service.memory("VmRSS"))
        print(f"after the warm-up {before:.1f} MiB at most", flush=True)
        total, lost, statuses, growth = 0, 0, {}, LIMIT_MIB + 1
        # One more page of 2 MiB may come at any time, but a leak goes on: it grows in each round.
        for _ in range(ROUNDS):
            if growth <= LIMIT_MIB:
                break
            until, most = total + 0.9 * wanted, before
            while total < until:
                done, told = run(min(60.0, max(1.0, 0.9 * wanted / rate / PARTS)))
                total, lost = total + done, lost + told["lost"]
                for status, count in told["statuses"].items():
                    statuses[status] = statuses.get(status, 0) + count
                most = max(most, service.memory("VmRSS"))
                print(f"{total} requests, resident {service.memory('VmRSS'):.1f} MiB", flush=True)
            growth, before = service.memory("VmRSS") - before, most
    print(f"{total} mixed requests after the warm-up: resident memory grows {growth:.2f} MiB (limit {LIMIT_MIB:g}), "
          f"{lost} lost, statuses {statuses}")
    sys.exit(growth > LIMIT_MIB or lost > 0 or statuses.get("500", 0) > 0)


if __name__ == "__main__":
    main()
