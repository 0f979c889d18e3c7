"""The costliest requests found so far: costly.jsonl, a line {"target", "cpu_ms", "bytes", "body"} each, the worst ten of every
endpoint, as bench/costly keeps them. `requests()` gives them as (target, body), and that none is there twice."""

import json
import pathlib

FILE = pathlib.Path(__file__).with_name("costly.jsonl")


def requests(file=FILE):
    found = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
    asked = [(one["target"], one["body"]) for one in found]
    if twice := [one for i, one in enumerate(asked) if one in asked[:i]]:
        raise ValueError(f"{file.name} has {len(twice)} requests twice, first {twice[0]}")
    return asked
