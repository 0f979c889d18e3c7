#!/usr/bin/env python3
"""Requests in whatever pieces they come: `pipelines.py BINARY ROUNDS`. Draws runs of requests (answers, refusals, bodies by length and in
chunks, batches, empty ones, bodies beyond one read), sends each run over one connection cut at random places, and compares every
answer with what the same request gets alone. The order of a batch's lines is its own affair."""

import json
import random
import sys
import time

from service import BODY, ROOT, Service, connect, get, head, post, receive

SEED = 8
MOST = 12  # requests in a run
READ = 65536  # bytes the port reads at a time
ID = "X-Request-Id: the-same"
MITRE = (ROOT / "examples/nodes/mitre.json").read_bytes()


def lines(*bodies):
    data = b"".join(json.dumps({"id": str(n), "endpoint": "intersections", "body": json.loads(body)}).encode() + b"\n"
                    for n, body in enumerate(bodies))
    return head(f"Content-Length: {len(data)}", ID, target="/v1/batches").replace(b"application/json", b"application/x-ndjson") + data


def chunked(body, size):
    parts = [body[i:i + size] for i in range(0, len(body), size)]
    return head("Transfer-Encoding: chunked", ID) + b"".join(b"%x\r\n%s\r\n" % (len(p), p) for p in parts) + b"0\r\n\r\n"


KINDS = [
    get("/v1/version", ID), get("/v1/tubes", ID), get("/nowhere", ID), get("/v1/nodes", ID, method="PUT"), post(BODY, ID),
    b"\r\n" + post(BODY, ID), post(b"{", ID), post(b"", ID), chunked(BODY, 7), chunked(BODY.ljust(90_000), 40_000),
    post(BODY.ljust(READ), ID), post(BODY.ljust(2 * READ), ID), post(MITRE, ID, target="/v1/nodes"), post(b"[" * 40, ID),
    lines(), lines(), lines(BODY), lines(BODY, b"{}", BODY),
]


def told(reply):
    """What an answer says: its status, its body, and the headers that are not of the moment."""
    body = sorted(reply.body.splitlines()) if "ndjson" in (reply.get("Content-Type") or "") else reply.body
    headers = [(name, value) for name, value in reply.headers if name not in ("Date", "Server-Timing")]
    return reply.status, body, headers


def cuts(random_, data):
    """Where it is cut: nowhere, here and there, or into many small pieces at its front."""
    how = random_.randrange(3)
    if how == 0:
        return []
    at = range(1, len(data)) if how == 1 else range(1, min(len(data), 400))
    return sorted(random_.sample(at, min(len(at), random_.randint(1, 6 if how == 1 else 40))))


def main():
    binary, rounds = sys.argv[1], int(sys.argv[2])
    random_ = random.Random(SEED)
    wrong = requests = 0
    with Service(binary, "--budget-s", "60", "--queue", "1000") as service:
        alone = []
        for data in KINDS:
            with connect(service.port, 60.0) as sock:
                sock.sendall(data)
                alone.append(told(receive(sock, enough=1, patience=60.0)[0][0]))
        for number in range(rounds):
            run = [random_.randrange(len(KINDS)) for _ in range(random_.randint(1, MOST))]
            data = b"".join(KINDS[kind] for kind in run)
            at = cuts(random_, data)
            with connect(service.port, 60.0) as sock:
                for begin, end in zip([0, *at], [*at, len(data)]):
                    sock.sendall(data[begin:end])
                    if random_.random() < 0.2:
                        time.sleep(0.001)
                replies, rest, _ = receive(sock, enough=len(run), patience=60.0)
            requests += len(run)
            if [told(reply) for reply in replies] != [alone[kind] for kind in run] or rest:
                wrong += 1
                print(f"run {number}: {run} cut at {at}: {[r.status for r in replies]}, {len(rest)} bytes besides")
                if not service.alive():
                    break
    print(f"{requests} requests in {rounds} runs over one connection each: {wrong} runs answered otherwise than alone")
    sys.exit(wrong > 0 or requests < rounds)


main()
