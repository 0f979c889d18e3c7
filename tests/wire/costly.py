"""The costliest requests found so far: costly.jsonl, a line {"target", "cpu_ms", "bytes", "body"} each, the worst ten of every
endpoint, as bench/costly keeps them. `requests()` yields (target, body)."""

import json
import pathlib

FILE = pathlib.Path(__file__).with_name("costly.jsonl")


def requests(file=FILE):
    for line in file.read_text().splitlines() if file.exists() else ():
        one = json.loads(line)
        yield one["target"], one["body"]
