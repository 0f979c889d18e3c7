#!/usr/bin/env python3
"""Memory over many mixed requests: `memory.py BINARY LOAD REQUESTS`. After a warm-up of a tenth of them, resident memory may
grow by 2 MiB at most over the rest."""

import json
import subprocess
import sys
import tempfile
import pathlib

from service import BODY, ROOT, Service, get, head, post

LIMIT_MIB = 2.0


def mixed():
    """Whole requests: answers, refusals, catalogues, other formats, chunks."""
    yield get("/v1/version")
    yield get("/v1/limits", "Cookie: a=b")
    yield get("/nowhere")
    yield post()
    yield post(b"{not json")
    yield post(b'{"a": 1}')
    yield post(BODY, "Accept: application/cbor", "Job-Id: soak")
    yield head("Transfer-Encoding: chunked") + b"%x\r\n%s\r\n0\r\n\r\n" % (len(BODY), BODY)
    for name in ("bevel-tables/mitre", "holes/set-on-branch", "nodes/k-joint-from-centre-lines"):
        body = (ROOT / f"examples/{name}.json").read_bytes()
        yield post(body, target="/v1/" + name.split("/")[0])


def main():
    binary, load, wanted = sys.argv[1], sys.argv[2], int(sys.argv[3])
    with Service(binary) as service, tempfile.TemporaryDirectory() as folder:
        files = []
        for i, data in enumerate(mixed()):
            path = pathlib.Path(folder) / str(i)
            path.write_bytes(data)
            files.append(str(path))

        def run(seconds):
            told = json.loads(subprocess.run([load, str(seconds), "16", str(service.port), *files], check=True,
                                             capture_output=True, text=True).stdout)
            return sum(told["statuses"].values()), told

        done, told = run(2)
        rate = max(1.0, done / 2)
        run(max(2.0, 0.1 * wanted / rate))
        before = service.memory("VmRSS")
        total, lost, statuses = 0, 0, {}
        while total < 0.9 * wanted:
            done, told = run(min(60.0, max(1.0, 0.9 * wanted / rate / 4)))
            total, lost = total + done, lost + told["lost"]
            for status, count in told["statuses"].items():
                statuses[status] = statuses.get(status, 0) + count
            print(f"{total} requests, resident {service.memory('VmRSS'):.1f} MiB", flush=True)
        growth = service.memory("VmRSS") - before
    print(f"{total} mixed requests after the warm-up: resident memory grows {growth:.2f} MiB (limit {LIMIT_MIB:g}), "
          f"{lost} lost, statuses {statuses}")
    sys.exit(growth > LIMIT_MIB or lost > 0 or statuses.get("500", 0) > 0)


if __name__ == "__main__":
    main()
