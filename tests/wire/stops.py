#!/usr/bin/env python3
"""Stops at any moment: `stops.py BINARY [STOPS_A_REQUEST [SEED]]`. Every example with budgets drawn between nothing and all that the job
takes, and the heaviest requests with budgets up to LONGEST_MS. Each is answered or over its budget, by the same process; what a stop leaves half made is never read (the tests'
build has the standard library's checks on)."""

import collections
import json
import math
import random
import sys

import forms
import heaviest
from budget import ask, cpu_ms
from service import ROOT, Service

LONGEST_MS = 400  # of the heaviest: later samples are covered by others
SHEET, SHEET_MS = "/v1/parts?format=pdf&view=work_order", 40  # a longer format, stopped at every millisecond


def requests():
    """Targets, body, and whether it is one of the heaviest, most of which take longer than LONGEST_MS."""
    ways = forms.targets()
    for endpoint in ways:
        for file in sorted((ROOT / "examples" / endpoint).glob("*.json")):
            yield ways[endpoint], file.read_bytes(), False
    for endpoint, _, body in heaviest.requests():
        yield ways[endpoint][:1], heaviest.text(body), True


def main():
    asked = [int(word) for word in sys.argv[2:]] + [1, 1][len(sys.argv) - 2:]
    stops, rng = asked[0], random.Random(asked[1])
    told, wrong = collections.Counter(), []
    with Service(sys.argv[1], "--slots", "1", "--budget-s", "60") as service:
        for ways, body, heavy in requests():
            target, longest = rng.choice(ways), LONGEST_MS
            if not heavy:
                whole = ask(service, body, target, LONGEST_MS)
                longest = cpu_ms(whole) if whole.status in (200, 504) else 1.0
            for _ in range(stops):
                budget = max(1, math.floor(rng.uniform(0, longest)))
                reply = ask(service, body, target, budget)
                told[reply.status] += 1
                if reply.status not in (200, 413, 422, 429, 504):
                    wrong.append(f"{target} budget {budget}: {reply.status} {json.loads(reply.body)}")
        body = (ROOT / "examples/parts/table-1-with-a-square-far-end.json").read_bytes()
        for budget in [*range(1, SHEET_MS)] * 2:
            reply = ask(service, body, SHEET, budget)
            told[reply.status] += 1
            if reply.status not in (200, 429, 504):
                wrong.append(f"{SHEET} budget {budget}: {reply.status}")
    print("\n".join(wrong))
    print(f"{sum(told.values())} requests, {dict(told)}")
    sys.exit(bool(wrong) or told[504] < 50)


if __name__ == "__main__":
    main()
