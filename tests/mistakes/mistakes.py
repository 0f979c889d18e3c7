"""Plausible mistakes of a caller, each against the service: does it name the field, and say what a
user needs to hear? Rows of mistakes.jsonl: an example with edits (pointer, value; null takes the
member out, "metres" divides the ends of all members by 1000), the field to be named, words of its hint.

usage: mistakes.py SERVER (the binary)"""

import copy
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from running import Running  # noqa: E402

HERE = pathlib.Path(__file__).parent
EXAMPLES = HERE.parent.parent / "examples"
LEAST_RIGHT = 190  # of 200


def edited(body, edits):
    body = copy.deepcopy(body)
    if edits == "metres":
        for member in body["members"]:
            for end in ("start_mm", "end_mm"):
                member[end] = [x / 1000 for x in member[end]]
        return body
    for pointer, value in edits:
        *way, last = pointer.strip("/").split("/")
        at = body
        for step in way:
            at = at[int(step)] if isinstance(at, list) else at[step]
        if isinstance(at, list):
            last = int(last)
        if value is None:
            del at[last]
        else:
            at[last] = value
    return body


def told(service, path, body):
    """What an answer says of each field."""
    told_by = json.loads(service.post(path, json.dumps(body).encode())[2])
    said = {}
    for one in told_by.get("errors", []) + told_by.get("warnings", []):
        text = " ".join(str(one.get(part, "")) for part in ("code", "limit", "hint", "detail"))
        said.setdefault(one["pointer"], []).append(text)
    return said


def stands(body, pointer):
    """Whether the request has the place, or the object in which a member is missing."""
    *way, last = pointer.split("/")[1:] or [""]
    for step in way:
        if isinstance(body, list):
            body = body[int(step)] if step.isdigit() and int(step) < len(body) else None
        else:
            body = body.get(step) if isinstance(body, dict) else None
    if isinstance(body, list):
        return last.isdigit() and int(last) < len(body)
    return pointer == "" or isinstance(body, dict)


def main(binary):
    with Running(binary) as service:
        judge(service)


def judge(service):
    rows = [json.loads(line) for line in (HERE / "mistakes.jsonl").read_text().splitlines()]
    assert len(rows) >= 200, "the table holds at least 200 mistakes"
    assert all(row["says"] for row in rows), "each row has words that its hint holds"
    silent, unhelpful, nowhere = [], [], []
    for row in rows:
        example = json.loads((EXAMPLES / (row["post"] + ".json")).read_text())
        path = "/v1/" + row["post"].split("/")[0]
        body = edited(example, row["edit"])
        said = told(service, path, body)
        nowhere += [(row, pointer) for pointer in said if not stands(body, pointer)]
        words = said.get(row["names"], [])
        if not words:
            silent.append((row, said))
        elif not any(row["says"].lower() in text.lower() for text in words):
            unhelpful.append((row, said))
    right = len(rows) - len(silent) - len(unhelpful)
    for what, which in (("does not name it", silent), ("names it without the hint", unhelpful)):
        for row, said in which:
            print(f"{what}: {row['mistake']} {row['names']} ({row['says']}) of {row['post']}: {said}")
    print(f"{right} of {len(rows)} mistakes are named with their hint")
    for row, pointer in nowhere:
        print(f"points to nowhere: {pointer} of {row['post']} with {row['edit']}")
    wrong = [row for row, said in silent if said] + nowhere
    if right * 200 < LEAST_RIGHT * len(rows) or wrong:
        sys.exit(f"too few, or another field is named instead ({len(wrong)})")


if __name__ == "__main__":
    main(sys.argv[1])
