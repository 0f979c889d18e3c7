#!/usr/bin/env python3
"""POST /v1/batches on the wire: `batches.py BINARY JOBS`. Jobs are drawn as source 002 describes (diameters 400-2 000 mm,
walls 20-50 mm, angles 30-90 deg, every one different), one bad line in the middle. Every id is answered once, each body is
what a request by itself with that Job-Id gets, memory stays flat, a single request gets its turn, a client that hangs up or
takes nothing, or a byte now and then, is dropped with its jobs, lines wait for their key's rate, the log has every line by its
id and the batch itself, and SIGTERM ends the stream with a summary of what is left."""

import collections
import http.client
import json
import random
import statistics
import subprocess
import sys
import tempfile
import threading
import time

from service import Service, connect, exchange, get, post

GROWTH = 16.0  # MiB over the whole run: answers held, working memory of the slots
SEED = 2
IN_FULL = 6000    # jobs of the run that also judges times
LATE_MS = 50      # of a request next to blank lines; one of a hundred may take longer
SMALL = 16 << 20  # bytes for bodies and answers: the least that there is


def job(random_, number):
    chord, branch = random_.uniform(400, 2000), random_.uniform(0.3, 0.95)
    wall = random_.uniform(20, 50)
    return {"id": f"job {number}", "endpoint": "bevel-tables", "body": {
        "target": {"outer_diameter_mm": round(branch * chord, 3), "wall_mm": round(min(wall, branch * chord / 6), 3)},
        "cutters": [{"kind": "tube", "outer_diameter_mm": round(chord, 3), "inclination_deg": round(random_.uniform(30, 90), 4),
                     "clocking_deg": 0, "offset_mm": 0}],
        "sampling": {"uniform_points": 360}, "root_surface": "inner", "contact": "inner",
        "groove": {"rule": "half_dihedral", "cap_deg": 45}, "kerf_mm": 0,
        "smoothing": {"method": "envelope", "limits": {"max_slope_deg_per_mm": 5, "max_curvature_deg_per_mm2": 1}}}}


def lines_of(count):
    random_ = random.Random(SEED)
    jobs = [job(random_, n) for n in range(count)]
    lines = [json.dumps(one).encode() for one in jobs]
    lines[count // 2] = b'{"id": "job of no kind", "endpoint": oops'
    return jobs, b"\n".join(lines) + b"\n"


def batch(port, body, **headers):
    """The answer's lines, as they come."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120)
    sent = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request("POST", "/v1/batches", body, {"Content-Type": "application/x-ndjson"} | sent)
    reply = connection.getresponse()
    assert reply.status == 200, reply.status
    assert all(reply.headers[name] == value for name, value in sent.items() if name != "X-Api-Key"), reply.headers
    for line in reply:
        yield json.loads(line)


def head(body):
    return (b"POST /v1/batches HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/x-ndjson\r\n"
            b"Content-Length: %d\r\n\r\n" % len(body))


class Suite:
    def __init__(self, binary, count):
        self.binary, self.count, self.faults = binary, count, []
        self.jobs, self.body = lines_of(count)

    def check(self, holds, what):
        if not holds:
            self.faults.append(what)

    def whole(self):
        with Service(self.binary) as service:
            list(batch(service.port, lines_of(20)[1]))  # memory that a first job keeps for good
            before = service.memory("VmRSS")
            times, stop = [], threading.Event()

            def singles():
                while not stop.is_set():
                    start = time.monotonic()
                    reply = exchange(service.port, post())[0]
                    self.check(reply.status == 200, f"a single request beside the batch: {reply.status}")
                    times.append(1e3 * (time.monotonic() - start))
                    time.sleep(0.01)

            beside = threading.Thread(target=singles)
            beside.start()
            start = time.monotonic()
            ids, bad, samples, summary = collections.Counter(), [], [], None
            for line in batch(service.port, self.body):
                if "summary" in line:
                    summary = line["summary"]
                elif line["id"] is None:
                    bad.append(line)
                else:
                    ids[line["id"]] += 1
                    self.check(line["status"] == 200, f"{line['id']}: status {line['status']}")
                    if line["line"] % (self.count // 5) == 1:
                        samples.append(line)
            seconds = time.monotonic() - start
            stop.set()
            beside.join()
            grown = service.memory("VmHWM") - before
            self.check(len(ids) == self.count - 1 and set(ids.values()) == {1}, "an id is not answered once")
            self.check([(b["line"], b["status"]) for b in bad] == [(self.count // 2 + 1, 400)], f"the bad line: {bad}")
            self.check(summary == {"items": self.count, "answered": self.count - 1, "refused": 1, "unanswered": 0}, f"{summary}")
            self.check(grown <= GROWTH, f"{grown:.1f} MiB more than before")
            for line in samples:
                asked = json.dumps(self.jobs[line["line"] - 1]["body"]).encode()
                alone = exchange(service.port, post(asked, f"Job-Id: {line['id']}", target="/v1/bevel-tables"))[0]
                self.check(json.loads(alone.body) == line["body"], f"{line['id']} is answered otherwise by itself")
            self.check(len(samples) >= 4 and len(times) >= 2, "too few samples")
            print(f"{self.count} jobs in {seconds:.1f} s, {grown:.1f} MiB more at most, {len(times)} single requests beside it "
                  f"p50 {statistics.median(times):.1f} ms, worst {max(times):.1f} ms")

    def idle_after(self, service, sock):
        start = time.monotonic()
        sock.close()
        while time.monotonic() - start < 5 and service.metric("tubecut_slots_busy") + service.metric("tubecut_queue_depth") > 0:
            time.sleep(0.005)
        return time.monotonic() - start

    def given_back(self, service):
        until = time.monotonic() + 5
        while time.monotonic() < until and service.metric("tubecut_memory_reserved_bytes") > 0:
            time.sleep(0.01)
        return service.metric("tubecut_memory_reserved_bytes") == 0

    def hang_up(self):
        with Service(self.binary) as service:
            sock = connect(service.port)
            sock.sendall(head(self.body) + self.body)
            got = 0
            while got < 200000:
                got += len(sock.recv(65536))
            until = time.monotonic() + 1
            while time.monotonic() < until and service.metric("tubecut_slots_busy") == 0:
                pass
            self.check(time.monotonic() < until, "nothing runs before the client hangs up")
            seconds = self.idle_after(service, sock)
            self.check(seconds <= 1.0, f"work went on for {seconds:.1f} s after the client hung up")
            self.check(self.given_back(service), "memory set aside is not given back")
            print(f"hang-up: idle after {1e3 * seconds:.0f} ms")

    def takes_little(self, at_a_time):
        with Service(self.binary, "--write-s", "1") as service:
            sock = connect(service.port)
            sock.sendall(head(self.body) + self.body)
            start = time.monotonic()
            while time.monotonic() - start < 8 and service.metric("tubecut_clients_too_slow_total") == 0:
                time.sleep(0.05)
                if at_a_time > 0:
                    sock.recv(at_a_time)
            self.check(service.metric("tubecut_clients_too_slow_total") == 1, f"a client that takes {at_a_time} bytes is not cut off")
            peak = service.memory()
            self.check(self.given_back(service), "memory set aside is not given back")
            print(f"takes {at_a_time} bytes at a time: cut off after {time.monotonic() - start:.1f} s, peak {peak:.0f} MiB")
            sock.close()

    def is_logged(self):
        """Every line by its id, and the batch."""
        lines = lines_of(20)[1] + b'{"id":"of no endpoint","endpoint":"nodez","body":{}}\n'
        process = subprocess.Popen([self.binary, "--port", "0", "--admin-port", "0"], stdout=subprocess.PIPE)
        try:
            port = json.loads(process.stdout.readline())["port"]
            list(batch(port, lines, Job_Id="night shift", Idempotency_Key="n-1"))
        finally:
            process.terminate()
        told = {event["job"]: event for event in map(json.loads, process.stdout) if event["event"] == "job"}
        missing = [one["id"] for n, one in enumerate(self.jobs[:20]) if n != 10 and told.get(one["id"], {}).get("status") != 200]
        self.check(not missing, f"not in the log: {missing}")
        self.check(told.get("of no endpoint", {}).get("code") == "bad_choice", f"{told.get('of no endpoint')}")
        whole = told.get("night shift", {})
        self.check([whole.get(name) for name in ("endpoint", "status", "items", "answered", "refused")] == ["batches", 200, 21, 19, 2]
                   and "sent" in whole.get("at_ms", {}), f"{whole}")
        process.wait(10)

    def minds_the_rate(self):
        """A key's lines wait for its rate: 10 at once, the others 10 a second."""
        _, key, _, line = subprocess.run([self.binary, "new-key", "cell"], check=True, capture_output=True, text=True).stdout.splitlines()
        with tempfile.NamedTemporaryFile("w") as keys:
            keys.write(f"{line} 10\n")
            keys.flush()
            with Service(self.binary, "--keys", keys.name) as service:
                start = time.monotonic()
                answers = list(batch(service.port, lines_of(25)[1], X_Api_Key=key))
                seconds = time.monotonic() - start
                self.check(answers[-1]["summary"]["answered"] == 24, f"{answers[-1]}")
                self.check(1.4 <= seconds, f"25 lines took {seconds:.2f} s at 10 a second")
                print(f"25 lines at 10 a second: {seconds:.2f} s")

    @staticmethod
    def six_beside(service, lines):
        """The end of each of six batches at a time: its summary, or its status."""
        ended = []

        def one():
            try:
                ended.append(list(batch(service.port, lines))[-1]["summary"])
            except AssertionError as refused:
                ended.append({"status": refused.args[0]})

        beside = [threading.Thread(target=one) for _ in range(6)]
        for each in beside:
            each.start()
        for each in beside:
            each.join(60)
        return ended

    def shares_memory(self):
        """Batches whose lines have room only one at a time, or only when another's are through: all come to their end."""
        large = b'{"id":"large","endpoint":"bevel-tables","body":{"x":"' + b"a" * 50_000 + b'"}}'
        lines = b"\n".join([json.dumps(one).encode() for one in self.jobs[:2]] + [large] * 11)
        with Service(self.binary, "--memory-bytes", str(SMALL), "--slots", "1", "--budget-s", "1") as service:
            # On a busy machine one may have all the room before the next one comes: then they are sent again.
            for _ in range(5):
                ended = self.six_beside(service, lines)
                begun = [s for s in ended if "items" in s]
                self.check(len(ended) == 6 and all(s.get("status", 429) == 429 for s in ended), f"{ended}")
                self.check(all(s["items"] == 13 and s["unanswered"] == 0 for s in begun), f"{begun}")
                if len(begun) >= 2:
                    break
            self.check(len(begun) >= 2, f"{begun}")
            self.check(self.given_back(service), "memory set aside is not given back")
            print(f"6 batches in {SMALL >> 20} MiB: {ended}")

    def idle_after_all(self, service):
        until = time.monotonic() + 5
        while time.monotonic() < until and service.metric("tubecut_slots_busy ") + service.metric("tubecut_queue_depth ") > 0:
            time.sleep(0.01)
        return service.metric("tubecut_slots_busy ") + service.metric("tubecut_queue_depth ") == 0

    def short_then_long(self):
        """Lines are begun ahead while they are short. Long ones among them are not refused for having waited for each other, though each
        takes a quarter of its budget; nor are any of batches that take each other's places in a queue of four."""
        short = [job(random.Random(n), n) for n in range(60)]
        body = short[1]["body"] | {"sampling": {"uniform_points": 10000}, "kerf_mm": 3}
        long = [short[1] | {"id": f"long {n}", "body": body} for n in range(8)]
        with Service(self.binary, "--slots", "1", "--budget-s", "30") as service:
            one = exchange(service.port, post(json.dumps(body).encode(), target="/v1/bevel-tables"), 60)[0]
            self.check(one.status == 200, one.body[:300])
            needs = float(dict(part.split(";dur=") for part in one.get("Server-Timing").split(", "))["cpu"]) / 1e3
        lines = b"\n".join(json.dumps(one).encode() for one in short + long)
        with Service(self.binary, "--slots", "1", "--budget-s", f"{4 * needs:.3f}") as service:
            replies = list(batch(service.port, lines))
            self.check(replies[-1]["summary"] == {"items": 68, "answered": 68, "refused": 0, "unanswered": 0},
                       f"long lines behind short ones: {replies[-1]} {[r for r in replies[:-1] if r['status'] != 200][:1]}")
        # An eighth, or the least that may be set, because the same work takes up to three times as long while another program runs beside it on the core.
        with Service(self.binary, "--slots", "1", "--budget-s", f"{max(0.01, needs / 8):.4f}") as service:
            over = [r["status"] for r in list(batch(service.port, lines))[60:68]]
            self.check(set(over) <= {429, 504} and 504 in over, f"long lines over their budget, begun ahead: {over}")
            self.check(self.idle_after_all(service), "a slot stays busy behind lines over their budget")
        with Service(self.binary, "--slots", "1", "--queue", "4") as service:
            ended = []
            lines = b"\n".join(json.dumps(one).encode() for one in short)
            beside = [threading.Thread(target=lambda: ended.append(list(batch(service.port, lines))[-1]["summary"])) for _ in range(6)]
            for each in beside:
                each.start()
            for each in beside:
                each.join(60)
            self.check([s["answered"] for s in ended] == 6 * [60], f"six batches in a queue of four: {ended}")
        print(f"short lines, then eight of {needs:.2f} s within four times that: {replies[-1]['summary']}; six batches in a queue of four: "
              f"{sum(s['answered'] for s in ended)} of 360")

    def drains(self):
        with Service(self.binary) as service:
            lines = []
            for line in batch(service.port, self.body):
                lines.append(line)
                if len(lines) == 5:
                    threading.Thread(target=service.stop).start()
            summary = lines[-1].get("summary", {})
            self.check(summary.get("unanswered", 0) > 0, f"drained without a summary: {summary}")
            self.check(summary.get("answered", 0) + summary.get("refused", 0) == len(lines) - 1, f"{summary}, {len(lines) - 1} lines")
            self.check(service.process.wait(15) == 0, "did not end with 0")
            print(f"SIGTERM: {summary}")

    def odd_ones(self):
        with Service(self.binary) as service:
            self.check(list(batch(service.port, b""))[-1]["summary"]["items"] == 0, "an empty batch")
            one = json.dumps(self.jobs[0]).encode()
            answers = list(batch(service.port, b"\r\n \n" + one + b"\r\n\n" + one))
            self.check([a.get("status") for a in answers[:-1]] == [200, 200], "blank lines, CR LF, no last line feed")
            odd = {b'{"id":"","endpoint":"nodes","body":{}}': "/id", b'{"id":"a","endpoint":"batches","body":{}}': "/endpoint",
                   b'{"id":"a","endpoint":"nodes"}': "/body", b'{"id":"a","endpoint":"nodes","body":{},"x":1}': "/x",
                   b'{"id":"a","endpoint":"nodes","body":[]}': "", b'{"id":7,"endpoint":"nodes","body":{}}': "/id"}
            for line, pointer in odd.items():
                answer = list(batch(service.port, line))[0]
                self.check(answer["status"] == 422 and answer["body"]["errors"][0]["pointer"].startswith(pointer), f"{line}: {answer}")
            # Two batches in one connection, and a request after them.
            with connect(service.port) as sock:
                sock.sendall(2 * (head(one) + one) + post())
                data = b""
                while data.count(b"HTTP/1.1 200") < 3:
                    data += sock.recv(65536)
                self.check(data.count(b'"summary"') == 2, "pipelined batches")

    def bounds(self):
        """Lines that are not jobs are answered and counted, and good ones behind them too; blank ones cost their bytes, and the port goes on
        meanwhile."""
        with Service(self.binary) as service:
            bad = 20_000
            answers = list(batch(service.port, b"x\n" * bad + json.dumps(self.jobs[0]).encode() + b"\n"))
            summary = answers.pop()["summary"]
            self.check([answer["status"] for answer in answers].count(400) == bad, "lines that are not jobs are answered as such")
            self.check([answer["id"] for answer in answers if answer["status"] == 200] == [self.jobs[0]["id"]], "a job behind them is answered")
            self.check(summary == {"items": bad + 1, "answered": 1, "refused": bad, "unanswered": 0}, f"{bad} lines that are not jobs: {summary}")
            blank = b"\n" * (8 << 20)
            waits, others, over = [], [], threading.Event()

            def probes():
                while not over.is_set():
                    start = time.monotonic()
                    replies = exchange(service.port, get("/v1/version"))
                    waits.append(1e3 * (time.monotonic() - start))
                    if [reply.status for reply in replies] != [200]:
                        others.append(replies)

            beside = threading.Thread(target=probes)
            beside.start()
            for _ in range(8):
                self.check(list(batch(service.port, blank))[-1]["summary"]["items"] == 0, "blank lines are no items")
            over.set()
            beside.join()
            waits.sort()
            self.check(waits and not others, f"beside blank lines {len(waits)} requests are answered but for {others[:3]}")
            late = sum(w > LATE_MS for w in waits)
            self.check(self.count < IN_FULL or late <= len(waits) / 100, f"beside blank lines {late} of {len(waits)} requests take over {LATE_MS} ms")
            print(f"{bad} lines that are not jobs: {summary}; beside 8 times 8 MiB of blank lines {len(waits)} requests, "
                  f"p99 {waits[int(0.99 * (len(waits) - 1))]:.1f} ms, {late} over {LATE_MS}")

    def run(self):
        for part in (self.whole, self.hang_up, lambda: self.takes_little(0), lambda: self.takes_little(10_000), self.is_logged,
                     self.minds_the_rate, self.shares_memory, self.short_then_long, self.drains, self.odd_ones, self.bounds):
            part()
        for fault in self.faults[:20]:
            print(fault)
        sys.exit(bool(self.faults))


Suite(sys.argv[1], int(sys.argv[2])).run()
