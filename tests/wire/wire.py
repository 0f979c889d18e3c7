#!/usr/bin/env python3
"""Runs the wire suite: `wire.py BINARY`. With `--must-fail` BINARY is the stock library, and every case marked as a trap
has to fail: the suite can fail."""

import collections
import sys

from cases import CASES
from service import Service, connect, get, receive

PROBE = get("/v1/version", "X-Request-Id: probe")


def run(port, case, ours):
    """What is wrong, or None."""
    patience = 5.0 if ours else 1.0  # stock waits that long for bytes that never come
    with connect(port) as sock:
        try:
            sock.sendall(case.data)
            if case.half_close:
                sock.shutdown(1)
        except OSError:
            pass  # ended while we wrote: the answer gives the reason
        wanted = case.statuses
        replies, rest, ended = [], b"", False
        if case.then:
            replies, rest, ended = receive(sock, enough=1, patience=patience)
            sock.sendall(case.then)
        more, rest, ended = receive(sock, enough=None if case.shut else len(wanted) - len(replies), bodiless=case.bodiless,
                                    patience=patience)
        replies += more
        statuses = [r.status for r in replies]
        if case.extra.get("or100") and statuses[:1] == [100]:
            if len(statuses) == 1:
                replies = receive(sock, enough=1)[0]
            statuses = [r.status for r in replies if r.status != 100]
        if statuses != wanted:
            return f"replies {statuses}, expected {wanted}"
        if rest:
            return f"{len(rest)} bytes that are no reply: {rest[:40]!r}"
        for reply in replies:
            if ours and reply.status >= 400 and not (reply.get("Content-Type") or "").startswith("application/problem+json"):
                return "a refusal that is no problem document"
        if case.check and not case.check(replies[-1]):
            return f"check failed: {replies[-1].headers}"
        if case.shut:
            return None if ended else "the connection stays open"
        sock.sendall(PROBE)
        after, rest, _ = receive(sock, enough=1, patience=patience)
        if [r.status for r in after] != [200] or rest:
            return f"the next request on the connection got {[r.status for r in after]} {rest[:40]!r}"
    return None


def main():
    must_fail = sys.argv[1] == "--must-fail"
    assert len(CASES) > 150 and len({(c.kind, c.name) for c in CASES}) == len(CASES)
    failed, missed, counts = [], [], collections.Counter()
    with Service(sys.argv[-1]) as service:
        for case in CASES:
            if must_fail and not case.trap:
                continue
            try:
                wrong = run(service.port, case, not must_fail)
            except OSError as error:
                wrong = f"no conversation: {error}"
            counts[case.kind] += 1
            if wrong:
                failed.append(f"{case.kind}: {case.name}: {wrong}")
            elif must_fail:
                missed.append(f"{case.kind}: {case.name}")
            if not service.alive():
                failed.append(f"{case.kind}: {case.name}: the server died")
                if not must_fail:
                    break
                service.__exit__()
                service.__init__(sys.argv[-1])
                service.__enter__()
    print("\n".join(failed))
    print(f"{sum(counts.values())} cases ({', '.join(f'{k} {n}' for k, n in counts.items())}): {len(failed)} failed")
    if must_fail:
        print("traps the stock library passes:", missed or "none")
    sys.exit(bool(missed) or not failed if must_fail else bool(failed))


main()
