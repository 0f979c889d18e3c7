#!/usr/bin/env python3
"""Machines of a shop over replicas: `machines.py BINARY`. Two replicas that mean other machines by one name give one request other
identities, each refuses the other's pin with 409, and both tell the other configuration; SIGHUP reads the folder again, all of it or
nothing, while jobs run: each answer is of the machine whose hash it states."""

import copy
import json
import pathlib
import signal
import sys
import tempfile
import threading
import time

from service import ROOT, Service, exchange, get, post

ASKED = json.loads((ROOT / "examples/pulse-schedules/square-cut-from-a-bare-contour.json").read_bytes())
TARGET = "/v1/pulse-schedules"


def schedule(port, **more):
    body = json.dumps({**ASKED, "machine": "cell-7", **more}).encode()
    reply = exchange(port, post(body, target=TARGET), patience=20.0)[0]
    return reply.status, json.loads(reply.body)


def page(port, name):
    return json.loads(exchange(port, get(f"/v1/{name}"))[0].body)


def cell(machines, pivot):
    made = copy.deepcopy(next(m["machine"] for m in machines if m["machine"]["type"] == "five_axis_cutter"))
    return {**made, "name": "cell-7", "pivot_length_mm": pivot}


def told(service):
    """The configuration as page, probe and metric tell it."""
    ready = exchange(service.admin_port, get("/readyz"))[0].body.decode().split()
    shown = [line.split('"')[1] for line in service.metrics().splitlines() if line.startswith("tubecut_configuration_info{")]
    return {page(service.port, "version")["configuration_sha256"], ready[1], *shown}


def until(holds, patience=10.0):
    end = time.monotonic() + patience
    while not holds() and time.monotonic() < end:
        time.sleep(0.02)
    return holds()


def two_replicas(first, second, check):
    (status, one), (other_status, other) = schedule(first.port), schedule(second.port)
    check((status, other_status) == (200, 200), f"both answer: {status}, {other_status}")
    for name in ("id", "input_sha256", "result_sha256"):
        check(one["job"][name] != other["job"][name], f"job.{name} differs")
    pin = one["request"]["machine_sha256"]
    check(pin == one["result"]["machine_sha256"] == {m["name"]: m["machine_sha256"] for m in page(first.port, "version")["machines"]}["cell-7"],
          "request, result and /v1/version tell one hash")
    status, again = schedule(first.port, machine_sha256=pin)
    check(status == 200 and again["job"] == one["job"], f"the pinned request is the same job: {status}")
    status, refused = schedule(second.port, machine_sha256=pin)
    named = [(e["code"], e["pointer"], e["limit"]) for e in refused.get("errors", [])]
    check(status == 409 and named == [("machine_mismatch", "/machine_sha256", other["request"]["machine_sha256"])], f"the other refuses: {status} {named}")
    table = json.loads((ROOT / "examples/bevel-tables/table-1-five-axis-at-600-mm-min.json").read_bytes())
    table["smoothing"]["limits"].update(machine="cell-7", machine_sha256=pin)
    inside = {"cut": table, "machine": "cell-7", "motion": ASKED["motion"]}
    reply = exchange(second.port, post(json.dumps(inside).encode(), target=TARGET), patience=20.0)[0]
    named = [(e["code"], e["pointer"]) for e in json.loads(reply.body).get("errors", [])]
    check((reply.status, named) == (409, [("machine_mismatch", "/cut/smoothing/limits/machine_sha256")]), f"a pin inside holds: {reply.status} {named}")
    inline = schedule(second.port, machine=other_machine(second), machine_sha256=other["request"]["machine_sha256"])
    check(inline[0] == 200, f"a machine in the request is pinned too: {inline[0]}")
    status, refused = schedule(second.port, machine_sha256="cell-7")
    check(status == 422 and refused["errors"][0]["code"] == "bad_text", f"what is no hash is refused: {status}")
    check(len(told(first)) == len(told(second)) == 1, "each tells one configuration")
    check(told(first) != told(second), "replicas that differ tell another one")


def other_machine(service):
    return next(m["machine"] for m in page(service.port, "machines")["machines"] if m["name"] == "cell-7")


def reload(service, folder, check):
    """The machine changes back and forth while three clients ask; a broken file beside it changes nothing."""
    machines = page(service.port, "machines")["machines"]
    wrong, answered, stop = [], [0], threading.Event()

    def client():
        while not stop.is_set():
            status, answer = schedule(service.port)
            if status != 200 or answer["request"]["machine_sha256"] != answer["result"]["machine_sha256"]:
                wrong.append(status)
            answered[0] += 1

    clients = [threading.Thread(target=client) for _ in range(3)]
    for one in clients:
        one.start()
    seen = set()
    for turn in range(6):
        before, had = told(service), answered[0]
        (folder / "cell.json").write_text(json.dumps(cell(machines, 150.0 + (turn + 1) % 2)))
        service.process.send_signal(signal.SIGHUP)
        check(until(lambda: told(service) != before), f"turn {turn}: the configuration changes")
        seen |= told(service)
        check(until(lambda: answered[0] > had + 1), f"turn {turn}: clients are answered")
    stop.set()
    for one in clients:
        one.join()
    check(not wrong and answered[0] > 10, f"{answered[0]} answers meanwhile, {len(wrong)} of another machine than they state or refused")
    check(len(seen) == 2, f"two configurations: {len(seen)}")
    before, listed = told(service), page(service.port, "machines")
    for text in ("{", json.dumps({**cell(machines, 170.0), "axes": []}), json.dumps(cell(machines, 170.0))):  # the last: a name twice
        (folder / "z.json").write_text(text)
        failed = service.metric("tubecut_reloads_failed_total")
        service.process.send_signal(signal.SIGHUP)
        check(until(lambda: service.metric("tubecut_reloads_failed_total") == failed + 1), "a failed reload is counted")
        check(told(service) == before and page(service.port, "machines") == listed, "and changes nothing")
    (folder / "z.json").unlink()


def shipped(binary, check):
    """The example of a site's machines is one."""
    with Service(binary, "--machines", str(ROOT / "docker/kubernetes/overlays/example/machines")) as service:
        check("cell-7" in [m["name"] for m in page(service.port, "version")["machines"]], "the shipped example is no machine")


def main():
    faults = []

    def check(holds, what):
        if not holds:
            faults.append(what)

    with tempfile.TemporaryDirectory() as name:
        folders = [pathlib.Path(name) / side for side in ("a", "b")]
        with Service(sys.argv[1]) as plain:
            machines = page(plain.port, "machines")["machines"]
        for folder, pivot in zip(folders, (150.0, 151.0)):
            folder.mkdir()
            (folder / "cell.json").write_text(json.dumps(cell(machines, pivot)))
        with Service(sys.argv[1], "--machines", str(folders[0])) as first, Service(sys.argv[1], "--machines", str(folders[1])) as second:
            two_replicas(first, second, check)
            reload(first, folders[0], check)
    shipped(sys.argv[1], check)
    print("\n".join(faults) or "other machines of one name: other jobs, other configurations; reloaded six times, and not where a file is wrong")
    sys.exit(bool(faults))


main()
