#!/usr/bin/env python3
"""A frame answered line by line: frames.py SERVER. Its parts are those of the whole answer, whatever becomes of one of them; a large frame
streams to its end, and frees its slots when its client hangs up."""

import http.client
import json
import socket
import sys
import time

from service import ROOT, Service

TRUSS = json.loads((ROOT / "examples/frames/truss-of-19.json").read_text())


def trusses(count, bays=12):
    """That many trusses side by side, no two diagonals alike."""
    members = []
    for k in range(count):
        chords = [m | {"end_mm": [500 * bays + 200, *m["end_mm"][1:]]} for m in TRUSS["members"] if m["id"] in ("top", "bottom")]
        x = [500 * i for i in range(bays)]
        diagonals = [{"id": f"D{i}", "start_mm": [at + 70, 0, 0], "end_mm": [at + 430 - 0.01 * (i + bays * k), 0, 500], "outer_diameter_mm": 48.3,
                      "wall_mm": 3.2, "priority": 1} for i, at in enumerate(x)]
        for m in chords + diagonals:
            members.append(m | {"id": f"{m['id']} {k}", "start_mm": [m["start_mm"][0], 1000 * k, m["start_mm"][2]],
                                "end_mm": [m["end_mm"][0], 1000 * k, m["end_mm"][2]]})
    return TRUSS | {"members": members}


def begin(service, body):
    """The answer's head, whose lines are still to be read."""
    connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=120)
    connection.request("POST", "/v1/frames", json.dumps(body), {"Content-Type": "application/json", "Accept": "application/x-ndjson"})
    return connection, connection.getresponse()


def streamed(service, body):
    """The frame, its parts by name, the summary."""
    connection, reply = begin(service, body)
    assert reply.status == 200 and reply.getheader("Content-Type") == "application/x-ndjson", (reply.status, reply.getheaders())
    frame, *parts, last = [json.loads(line) for line in reply.read().splitlines()]
    connection.close()
    return frame, {part["id"]: part for part in parts}, last["summary"]


def whole(service, body):
    connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=120)
    connection.request("POST", "/v1/frames", json.dumps(body), {"Content-Type": "application/json"})
    answer = json.loads(connection.getresponse().read())
    connection.close()
    return answer


def without_name(answer):
    return answer | {"job": {k: v for k, v in answer["job"].items() if k != "id"}}


def same_parts(service):
    """Every example, and one with a member that cannot be cut."""
    bodies = [json.loads(file.read_text()) for file in sorted((ROOT / "examples/frames").glob("*.json"))]
    long_name = "梁" * 64
    bodies.append(TRUSS | {"members": [m | ({"id": long_name} if m["id"] == "P0" else {}) for m in TRUSS["members"]]})
    spoiled = TRUSS | {"members": [m | ({"outer_diameter_mm": 120} if m["id"] == "P0" else {}) for m in TRUSS["members"]]}
    assert any("problem" in part for part in whole(service, spoiled)["parts"])
    for body in [*bodies, spoiled]:
        at_once, (frame, parts, summary) = whole(service, body), streamed(service, body)
        assert frame["request"] == at_once["request"]
        rows = [{k: row[k] for k in ("part", "count", "members")} for row in frame["result"]["cut_list"]]
        assert rows == [{k: row[k] for k in ("part", "count", "members")} for row in at_once["result"]["cut_list"]]
        assert [m["part"] for m in frame["result"]["members"]] == [m["part"] for m in at_once["result"]["members"]]
        assert set(parts) == {part["part"] for part in at_once["parts"]}
        for part in at_once["parts"]:
            line = parts[part["part"]]
            if "answer" in part:
                assert line["status"] == 200 and without_name(line["body"]) == without_name(part["answer"]), part["part"]
            else:
                assert line["status"] == 422 and line["body"]["code"] == part["problem"]["code"], line
        refused = sum("problem" in part for part in at_once["parts"])
        assert summary == {"items": len(parts), "answered": len(parts) - refused, "refused": refused, "unanswered": 0}, summary
    return len(bodies) + 1


def refusals(service):
    """What is no frame is refused as always, and lines are for frames alone."""
    _, reply = begin(service, TRUSS | {"members": []})
    assert reply.status == 422 and reply.getheader("Content-Type") == "application/problem+json"
    connection = http.client.HTTPConnection("127.0.0.1", service.port)
    connection.request("POST", "/v1/parts", "{}", {"Content-Type": "application/json", "Accept": "application/x-ndjson"})
    assert connection.getresponse().status == 406


def seams(service):
    """A client that takes no chunks, one that only asks whether the frame is sound, one with no time, and names that want escaping."""
    body = TRUSS | {"members": [m | ({"id": '"<b>\\'} if m["id"] == "P0" else {}) for m in TRUSS["members"]]}
    text = json.dumps(body).encode()
    with socket.create_connection(("127.0.0.1", service.port), timeout=60) as sock:
        sock.sendall(b"POST /v1/frames HTTP/1.0\r\nHost: localhost\r\nContent-Type: application/json\r\nAccept: application/x-ndjson\r\n"
                     b"Content-Length: %d\r\n\r\n" % len(text) + text)
        head, lines = b"".join(iter(lambda: sock.recv(1 << 16), b"")).split(b"\r\n\r\n", 1)
    assert b"chunked" not in head, head
    frame, *parts, last = [json.loads(line) for line in lines.splitlines()]
    assert last["summary"]["answered"] == len(parts) == 4 and '"<b>\\' in {part["id"] for part in parts}, last
    for query, headers, status in (("?validate_only=true", {}, 200), ("", {"Tubecut-Budget-Ms": "30"}, 504)):
        connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=60)
        asked = json.dumps(trusses(100) if status == 504 else body)
        connection.request("POST", "/v1/frames" + query, asked, {"Content-Type": "application/json", "Accept": "application/x-ndjson", **headers})
        reply = connection.getresponse()
        answer = json.loads(reply.read())
        assert reply.status == status and "result" not in answer, (reply.status, list(answer))
        connection.close()


def idle(service):
    until = time.monotonic() + 5
    while service.metric("tubecut_slots_busy ") or service.metric("tubecut_queue_depth "):
        assert time.monotonic() < until, "slots are not free again"
        time.sleep(0.01)


def hung_up(service):
    """Slots of a frame of 100 trusses whose client leaves after its first part."""
    connection, reply = begin(service, trusses(100))
    frame, part = json.loads(reply.readline()), json.loads(reply.readline())
    assert len(frame["result"]["cut_list"]) > 300 and part["status"] == 200
    connection.sock.close()
    reply.close()
    idle(service)


def helped(service):
    """A whole frame, which free slots help with: its budget ends it, whoever asks beside it has a slot, and it ends when its client hangs up."""
    body, rest = json.dumps(trusses(60)), service.metric("tubecut_memory_reserved_bytes ")
    connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=60)
    connection.request("POST", "/v1/frames", body, {"Content-Type": "application/json", "Tubecut-Budget-Ms": "400"})
    late = connection.getresponse()
    assert late.status == 504 and json.loads(late.read())["code"] == "over_budget", late.status
    idle(service)
    connection.request("POST", "/v1/frames", body, {"Content-Type": "application/json"})
    while not service.metric("tubecut_slots_busy "):
        time.sleep(0.001)
    beside = http.client.HTTPConnection("127.0.0.1", service.port, timeout=60)
    for name in ("bevel-tables/mitre", "parts/k-joint-brace"):
        beside.request("POST", "/v1/" + name.split("/")[0], (ROOT / f"examples/{name}.json").read_bytes(), {"Content-Type": "application/json"})
        reply = beside.getresponse()
        assert reply.status == 200 and reply.read(), name
    assert service.metric("tubecut_slots_busy "), "the frame was done before"
    connection.sock.close()
    beside.close()
    idle(service)
    until = time.monotonic() + 5
    while service.metric("tubecut_memory_reserved_bytes ") > rest:
        assert time.monotonic() < until, "what helpers took is not given back"
        time.sleep(0.01)


def main():
    with Service(sys.argv[1], "--slots", "2") as service:
        count = same_parts(service)
        refusals(service)
        seams(service)
        hung_up(service)
        helped(service)
        frame, parts, summary = streamed(service, trusses(20))
        assert summary["answered"] == len(parts) == len(frame["result"]["cut_list"]) > 50, summary
        print(f"{count} frames alike in lines and at once; {len(parts)} different parts in lines")


if __name__ == "__main__":
    main()
