"""How long /v1/intersections takes for a pair of tubes and for a node of five, to 0.001 mm, beside Open CASCADE: times.py SERVER_BINARY INTERSECT

The service's time is that of its answer's `compute`, both surfaces with events, rows and labels; Open CASCADE's that of its curves of each
surface with each partner (GeomAPI_IntSS), which are still to be cut with each other. Medians, one thread each, in one run."""

import http.client
import json
import pathlib
import statistics
import subprocess
import sys

import compare

ROOT = pathlib.Path(__file__).resolve().parents[3]
TOLERANCE_MM = 0.001
ROUNDS = 51


def bodies():
    """Table 1 of source 000: its chord, which all generators meet, alone, and all four tubes."""
    table = json.loads((ROOT / "examples/bevel-tables/source-000-table-1.json").read_text())
    for name, cutters in (("pair", table["cutters"][:1]), ("node", table["cutters"])):
        yield name, {"target": table["target"], "cutters": cutters, "surfaces": "both", "sampling": {"tolerance_mm": TOLERANCE_MM}}


def answered(port, body):
    """The answer's result and median ms of its compute."""
    connection, took = http.client.HTTPConnection("127.0.0.1", port), []
    for _ in range(ROUNDS):
        connection.request("POST", "/v1/intersections", json.dumps(body), {"Content-Type": "application/json"})
        answer = connection.getresponse()
        text = answer.read()
        if answer.status != 200:
            sys.exit(text.decode())
        timing = dict(part.split(";dur=") for part in answer.getheader("Server-Timing").split(", "))
        took.append(float(timing["compute"]))
    return json.loads(text)["result"], statistics.median(took)


def main(server, program):
    service = subprocess.Popen([server, "--port", "0", "--admin-port", "0", "--slots", "1"], stdout=subprocess.PIPE)
    try:
        port = json.loads(service.stdout.readline())["port"]
        for name, body in bodies():
            result, ours = answered(port, body)
            ran = subprocess.run([program, "--time", str(TOLERANCE_MM)], input=compare.lines(body, result), capture_output=True, text=True, check=True)
            theirs, points, apart = map(float, ran.stdout.split())
            print(f"{name}: {ours:.3f} ms beside {theirs:.3f} ms of Open CASCADE's curves, {theirs / ours:.0f} times; "
                  f"{points:.0f} points, apart by {apart:.2g} mm at most")
            if not points or apart > TOLERANCE_MM:
                sys.exit(f"{name}: further apart than {TOLERANCE_MM} mm")
    finally:
        service.terminate()
        service.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
