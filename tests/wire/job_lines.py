"""The log's line of every job, whatever became of it: who computed it, what was asked, what came out; and that
`health` finds the admin port on either side of its name.

usage: job_lines.py SERVER (the binary)"""

import hashlib
import json
import pathlib
import queue
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from running import ROOT, Running  # noqa: E402

TABLE = json.loads((ROOT / "examples/bevel-tables/source-000-table-1.json").read_text())
SHA256 = re.compile(r"[0-9a-f]{64}")
OPEN = {**TABLE, "cutters": [{"kind": "tube", "outer_diameter_mm": 40, "inclination_deg": 60}]}
LONG = {**TABLE, "sampling": {"uniform_points": 20000}}
ASKED, RESULT, BODY = "input_sha256", "result_sha256", "body_sha256"

# (name, query, body, headers, status, the hashes of its line)
JOBS = [
    ("answered", "", TABLE, {}, 200, {ASKED, RESULT}),
    ("validated", "?validate_only=true", TABLE, {}, 200, {ASKED, RESULT}),
    ("as a document", "?format=csv", TABLE, {}, 200, {ASKED, RESULT}),
    ("refused where it cannot be cut", "", OPEN, {}, 422, {ASKED}),
    ("refused where a format cannot spell it", "?format=nc1", {**TABLE, "reference": {"part": "注"}}, {}, 422, {ASKED}),
    ("refused by its verdict", "?format=gcode&speed_mm_min=600&torch=on&dialect=qtplasmac&lead_mm=2", {**TABLE, "accept": {"max_b_deg": 1}}, {}, 422, {ASKED}),
    ("timed out", "", LONG, {"Tubecut-Budget-Ms": "10"}, 504, {ASKED}),
    ("refused by a field", "", {**TABLE, "kerf_mm": -1}, {}, 422, {BODY}),
    ("refused by its query", "?torch=yes", TABLE, {}, 400, {BODY}),
    ("no JSON", "", b"{", {}, 400, {BODY}),
]


class Logged(Running):
    """The service, and its lines as they come."""

    def __init__(self, binary):
        self.lines = queue.Queue()
        super().__init__(binary, "--replica", "cut-7")

    def read(self, log):
        for line in log:
            one = json.loads(line)
            if one["event"] == "job":
                self.lines.put(one)


def hold(line, what, status, hashes, version):
    """The members that every line has, and its hashes: those and no other."""
    assert (line["status"], line["replica"]) == (status, "cut-7"), (what, line)
    assert line["engine"] == version["engine"] and line["numerics"] == version["numerics"], (what, line)
    found = {name for name in (ASKED, RESULT, BODY) if line.get(name)}
    assert found == hashes, f"{what}: {found} instead of {hashes}"
    assert all(SHA256.fullmatch(line[name]) for name in found), (what, line)


def main(binary):
    with Logged(binary) as service:
        judge(service, json.loads(service.get("/v1/version")))
        either_order(binary, str(service.ready["admin_port"]))


def judge(service, version):
    for what, query, body, headers, wanted, hashes in JOBS:
        sent = body if isinstance(body, bytes) else json.dumps(body).encode()
        status, answered, content = service.post("/v1/bevel-tables" + query, sent, headers)
        assert status == wanted, (what, status, content[:300])
        line = service.lines.get(timeout=10)
        hold(line, what, status, hashes, version)
        assert line["request_id"] == answered["X-Request-Id"], what
        if status == 200:
            assert (line[ASKED], line[RESULT]) == (answered["Tubecut-Input-Sha256"], answered["Tubecut-Result-Sha256"]), what
        if BODY in hashes:
            assert line[BODY] == hashlib.sha256(sent).hexdigest(), what
        print(f"ok  {what}: {', '.join(sorted(hashes))}")
    lines = [{"id": "fine", "body": TABLE}, {"id": "file", "body": TABLE, "format": "csv"}, {"id": "open", "body": OPEN}, {"id": "wrong", "body": {}}]
    batch = "".join(json.dumps({"endpoint": "bevel-tables", **line}) + "\n" for line in lines).encode()
    assert service.post("/v1/batches", batch, media="application/x-ndjson")[0] == 200
    told = {line["job"]: line for line in (service.lines.get(timeout=10) for _ in range(5))}  # and that of the whole
    for id, status, hashes in (("fine", 200, {ASKED, RESULT}), ("file", 200, {ASKED, RESULT}), ("open", 422, {ASKED}), ("wrong", 422, {BODY})):
        hold(told[id], f"line {id} of a batch", status, hashes, version)
    print("ok  lines of a batch")


def either_order(binary, port):
    for words in (["health", "--admin-port", port], ["--admin-port", port, "health"]):
        assert subprocess.run([binary, *words], timeout=60).returncode == 0, words
        wrong = ["1" if word == port else word for word in words]  # nobody listens there
        assert subprocess.run([binary, *wrong], stderr=subprocess.DEVNULL, timeout=60).returncode == 1, wrong
    print("ok  health --admin-port in either order")


if __name__ == "__main__":
    main(sys.argv[1])
