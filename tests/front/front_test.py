#!/usr/bin/env python3
"""What stands in front of the service, docker/: the shipped HAProxy configuration before replicas that misbehave as told, and that
the files say the same as one another and as the code.   front_test.py SERVER"""

import contextlib
import gzip
import hashlib
import http.server
import importlib.machinery
import importlib.util
import json
import os
import pathlib
import re
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock
import urllib.error
import urllib.request

import yaml

sys.dont_write_bytecode = True

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCKER = ROOT / "docker"
SERVER = ""


def load(path):
    name = path.name.replace("-", "_")
    loader = importlib.machinery.SourceFileLoader(name, str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    sys.modules[name] = module  # dataclasses look for theirs there
    loader.exec_module(module)
    return module


restarts = load(ROOT / "bench/restarts")
CONFIG = (DOCKER / "haproxy.cfg").read_text()


def limit(name):
    return int(re.search(rf"X\({name}, ([0-9']+)\)", (ROOT / "api/limits.hpp").read_text())[1].replace("'", ""))


class Stub:
    """A replica that does what it is told: one port for requests, one for /readyz."""

    def __init__(self, behave, ready=True):
        self.asked, stub = [], self

        class Work(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_POST(self):
                body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
                stub.asked.append((self.path, list(self.headers.items()), body))
                behave(self)

            do_GET = do_POST

            def log_message(self, *_):
                pass

        class Ready(Work):
            def do_GET(self):
                reply(self, 200 if ready else 503)

        class Server(http.server.ThreadingHTTPServer):
            request_queue_size = 128

        self.servers = [Server(("127.0.0.1", 0), handler) for handler in (Work, Ready)]
        self.port, self.admin_port = (s.server_address[1] for s in self.servers)
        for s in self.servers:
            s.handle_error = lambda *_: None  # the proxy may leave early
            threading.Thread(target=s.serve_forever, args=(0.05,), daemon=True).start()

    def end(self):
        for s in self.servers:
            s.shutdown()
            s.server_close()


def reply(handler, status, body=b"{}", headers=()):
    handler.send_response(status)
    for name, value in (("Content-Length", str(len(body))), ("Content-Type", "application/json"), *headers):
        handler.send_header(name, value)
    handler.end_headers()
    handler.wfile.write(body)


def hang_up(handler, sent=b""):
    handler.wfile.write(sent)
    handler.wfile.flush()
    handler.close_connection = True
    handler.connection.shutdown(socket.SHUT_RDWR)


class Stubs(list):
    """The replicas, and what the proxy before them logged of requests."""

    def __init__(self, stubs, log):
        super().__init__(stubs)
        self.log = lambda: [line for line in pathlib.Path(log).read_text().splitlines() if '"event":"proxy"' in line]


@contextlib.contextmanager
def proxied(*behaviours, ready=True, environment=None):
    """(url, stubs) of HAProxy before stubs of these behaviours; the others of the three replicas are not there."""
    stubs = [Stub(b, ready) for b in behaviours]
    absent = type("Absent", (), {"port": 1})
    with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(restarts.Proxy, "environment", environment or {}):
        count = restarts.REPLICAS - len(stubs)
        proxy = restarts.Proxy(pathlib.Path(folder), stubs + [absent] * count, [s.admin_port for s in stubs] + [1] * count)
        try:
            checked = "L7OK" if ready else "L7STS"
            restarts.until(lambda: checks(proxy, len(stubs)) == [checked] * len(stubs), 10, "the stubs' state")
            yield f"https://127.0.0.1:{proxy.port}", Stubs(stubs, proxy.log.name)
        finally:
            proxy.end()
            for s in stubs:
                s.end()


def checks(proxy, count):
    with contextlib.suppress(OSError):
        rows = proxy.rows()
        return [rows[f"replica-{i + 1}"]["check_status"] for i in range(count)]
    return []


def ask(url, path="/v1/bevel-tables", body=b"{}", headers=()):
    """(status, headers, body)"""
    request = urllib.request.Request(url + path, body, {"Content-Type": "application/json", **dict(headers)})
    try:
        with urllib.request.urlopen(request, timeout=15, context=ssl._create_unverified_context()) as answer:
            return answer.status, answer.headers, answer.read()
    except urllib.error.HTTPError as problem:
        return problem.code, problem.headers, problem.read()


class Proxy(unittest.TestCase):
    def problem(self, answer, status, code):
        got, headers, body = answer
        self.assertEqual(got, status)
        self.assertEqual(headers["Content-Type"], "application/problem+json")
        document = json.loads(body)
        required = yaml.safe_load((ROOT / "openapi.yaml").read_text())["components"]["schemas"]["Problem"]["required"]
        self.assertEqual(sorted(document), sorted(required))
        self.assertEqual((document["status"], document["code"]), (status, code))
        self.assertEqual(document["request_id"], headers["X-Request-Id"])
        return document

    def test_repeats_only_what_is_safe(self):
        # Behaviour of the first replica, number of requests to both, and the answer to the client.
        cases = {
            "503": (lambda h: reply(h, 503), 200, 2),
            "closed without a byte": (hang_up, 200, 2),
            "429": (lambda h: reply(h, 429), 429, 1),
            "500": (lambda h: reply(h, 500), 500, 1),
            "504": (lambda h: reply(h, 504), 504, 1),
            "422": (lambda h: reply(h, 422), 422, 1),
        }
        next_ones = []  # answers of the next requests; then 200

        def behave(handler):
            (next_ones.pop() if next_ones else lambda h: reply(h, 200))(handler)

        body = b" " * 1_000_000
        with proxied(behave, behave) as (url, stubs):
            for name, (bad, status, times) in cases.items():
                with self.subTest(name):
                    for stub in stubs:
                        stub.asked.clear()
                    next_ones.append(bad)
                    self.assertEqual(ask(url, body=body)[0], status)
                    asked = [request for stub in stubs for request in stub.asked]
                    self.assertEqual(len(asked), times)
                    self.assertEqual({hashlib.sha256(b).digest() for _, _, b in asked}, {hashlib.sha256(body).digest()})

    def test_a_silent_replica_computes_and_is_asked_alone(self):
        silent = float(re.search(r"^  timeout server (\d+)s$", CONFIG, re.M)[1]) + 1.0
        with proxied(lambda h: time.sleep(silent), lambda h: time.sleep(silent)) as (url, stubs):
            self.problem(ask(url), 504, "over_budget")
            self.assertEqual(sum(len(stub.asked) for stub in stubs), 1)

    def test_a_broken_answer_is_a_problem(self):
        half = b"HTTP/1.1 200 OK\r\nContent-"
        with proxied(lambda h: hang_up(h, half)) as (url, stubs):
            document = self.problem(ask(url), 502, "unavailable")
            self.assertTrue(document["retryable"])
            self.assertGreaterEqual(len(stubs[0].asked), 1)

    def test_no_replica_ready(self):
        with proxied(lambda h: reply(h, 200), ready=False) as (url, stubs):
            answer = ask(url)
            self.assertTrue(self.problem(answer, 503, "unavailable")["retryable"])
            self.assertEqual(answer[1]["Retry-After"], "1")
            self.assertEqual(stubs[0].asked, [])

    def test_no_id_spoils_the_problem_or_the_log(self):
        ids = ['job"7\\', 'x","client":"6.6.6.6","a":"']
        with proxied(lambda h: reply(h, 200), ready=False) as (url, stubs):
            for one in ids:
                self.problem(ask(url, headers=[("X-Request-Id", one)]), 503, "unavailable")
            restarts.until(lambda: len(stubs.log()) == len(ids), 5, "the proxy's log")
            lines = [json.loads(line) for line in stubs.log()]
            self.assertEqual([line["request_id"] for line in lines], ids)
            self.assertEqual({line["client"] for line in lines}, {"127.0.0.1"})

    def test_every_line_of_its_log_is_json(self):
        """Of requests, of what was none, of replicas that come and go, of its own end."""
        trace = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"
        with tempfile.TemporaryDirectory() as folder:
            with restarts.everything(SERVER, pathlib.Path(folder), running=1) as (replicas, proxy):
                url = f"https://127.0.0.1:{proxy.port}"
                for sent in (trace, 'x","client":"6.6.6.6', trace.upper(), None):
                    ask(url, headers=[("traceparent", sent)] if sent else [])
                connect = lambda: socket.create_connection(("127.0.0.1", proxy.port), 5)
                for wrapped, nonsense in ((False, b"GET / HTTP/1.0\r\n\r\n"), (True, b'n"on\\sense\x00\r\n\r\n')):
                    with connect() as raw, (ssl._create_unverified_context().wrap_socket(raw) if wrapped else raw) as s:
                        s.sendall(nonsense)
                        s.recv(100)
                replicas[0].end(signal.SIGKILL)
                restarts.until(lambda: not proxy.up("replica-1"), 5, "the replica seen down")
                ask(url)
                replicas[0].start()  # a proxy whose first check finds it up reports nothing about it
                restarts.until(lambda: proxy.up("replica-1"), 20, "the replica seen up again")
                proxy.process.send_signal(signal.SIGUSR1)
                self.assertEqual(proxy.process.wait(timeout=10), 0)
                lines = [json.loads(line) for line in pathlib.Path(proxy.log.name).read_text().splitlines()]
            of = lambda event: [line for line in lines if line["event"] == event]
            self.assertEqual({line["event"] for line in lines}, {"proxy", "proxy_connection", "proxy_notice"})
            self.assertEqual([line["traceparent"] for line in of("proxy")], [trace, "-", "-", "-", "-"])
            self.assertEqual([line["status"] for line in of("proxy_connection")], [0, 400])
            told = " ".join(line["text"] for line in of("proxy_notice"))
            for word in ("replicas/replica-1 is UP", "replicas/replica-1 is DOWN", "Proxy tubecut stopped"):
                self.assertIn(word, told)

    def test_a_mistake_in_its_configuration_is_said(self):
        done = subprocess.run([DOCKER / "proxy", "-f", '/no"ne\n\\é'], capture_output=True, text=True, timeout=10)
        self.assertEqual(done.returncode, 1)
        self.assertIn('/no"ne', json.loads(done.stdout.splitlines()[-2])["text"])

    def test_bodies_beyond_the_limits_end_at_the_proxy(self):
        small, large = limit("body_max_bytes"), limit("body_large_max_bytes")
        with proxied(lambda h: reply(h, 200)) as (url, stubs):
            for path, length in (("/v1/bevel-tables", small), ("/v1/replays", large)):
                self.problem(announce(url, path, length + 1), 413, "body_too_large")
                self.assertEqual(stubs[0].asked, [])
            self.assertEqual(ask(url, body=b" " * small)[0], 200)

    def test_an_address_has_so_many_connections(self):
        most = int(re.search(r"sc0_conn_cur gt (\d+)", CONFIG)[1])
        with proxied(lambda h: reply(h, 200)) as (url, _), contextlib.ExitStack() as stack:
            port = int(url.rsplit(":", 1)[1])
            silent, closed = [], 0
            for _ in range(most + 40):
                try:
                    silent.append(stack.enter_context(socket.create_connection(("127.0.0.1", port), 5, ("127.0.0.11", 0))))
                except ConnectionError:
                    closed += 1
            time.sleep(0.3)
            for one in silent:
                one.setblocking(False)
                try:
                    closed += one.recv(1) == b""
                except BlockingIOError:
                    pass  # it is open
                except ConnectionError:
                    closed += 1
            self.assertEqual(closed, 40)  # of silent ones; others have their own
            for other in ("127.0.0.12", "127.0.0.13"):
                with socket.create_connection(("127.0.0.1", port), 5, (other, 0)) as raw:
                    with ssl._create_unverified_context().wrap_socket(raw) as sock:
                        sock.sendall(b"POST /v1/intersections HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n\r\n{}")
                        self.assertIn(b" 200 ", sock.recv(4096))

    def test_an_address_has_so_many_requests_at_a_time(self):
        """However it sends them: streams of HTTP/2 are not counted by its connections."""
        hard, most = (int(n) for n in re.findall(r"sc2_conn_cur gt (\d+)", CONFIG))
        requests = 100  # of a client
        self.assertTrue(most < requests < hard)
        lock, over, now, peak = threading.Lock(), threading.Event(), 0, 0

        def hold(handler):
            nonlocal now, peak
            if handler.path == "/v1/mill-paths":
                with lock:
                    now, peak = now + 1, max(peak, now + 1)
                over.wait(20)
                with lock:
                    now -= 1
            reply(handler, 200)

        def wanting(url):
            """A client that is held; it prints answers and statuses."""
            return subprocess.Popen(["curl", "-sk", "--http2", "-Z", "--parallel-max", str(requests), "--interface", "127.0.0.11", "-d", "{}",
                                     "-w", "\n%{http_code}\n", *[url + "/v1/mill-paths"] * requests], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)

        def other(url):
            return subprocess.run(["curl", "-sk", "--interface", "127.0.0.12", "-m", "10", "-d", "{}", "-o", os.devnull, "-w", "%{http_code}",
                                   url + "/v1/bevel-tables"], capture_output=True).stdout

        for clients in (1, 4):  # the second: more than any bound
            over.clear()
            now = peak = 0
            with self.subTest(clients=clients), proxied(hold, hold, hold) as (url, _):
                greedy = [wanting(url) for _ in range(clients)]
                try:
                    restarts.until(lambda: peak >= most, 10, "as many as may be")
                    self.assertEqual([other(url) for _ in range(20)], [b"200"] * 20)
                    self.assertEqual(peak, most)
                finally:
                    over.set()
                    answers = [line for one in greedy for line in one.communicate(timeout=30)[0].decode().splitlines()]
                problems = [json.loads(line) for line in answers if '"code"' in line]
                self.assertLessEqual({(429, "overloaded", True)}, {(p["status"], p["code"], p["retryable"]) for p in problems})
                if clients == 1:  # each gets an answer
                    self.assertEqual((answers.count("200"), answers.count("429")), (most, requests - most))

    def test_headers(self):
        with proxied(lambda h: reply(h, 200, headers=[("Tubecut-Replica", "a")])) as (url, stubs):
            status, back, _ = ask(url, headers={"X-Forwarded-For": "9.9.9.9", "X-Forwarded-Host": "x", "Forwarded": "for=9.9.9.9",
                                                "X-Real-IP": "9.9.9.9", "Via": "x", "Proxy": "x", "Content_Length": "1",
                                                "X-Request-Id": "bad id", "Job-Id": "order-17", "Authorization": "Bearer k"}.items())
            self.assertEqual(status, 200)
            sent = {}
            for name, value in stubs[0].asked[0][1]:
                sent.setdefault(name.lower(), []).append(value)
            for name in ("x-forwarded-host", "forwarded", "x-real-ip", "via", "proxy", "content_length"):
                self.assertNotIn(name, sent)
            self.assertEqual(sent["x-forwarded-for"], ["127.0.0.1"])
            self.assertEqual(sent["x-forwarded-proto"], ["https"])
            self.assertEqual((sent["job-id"], sent["authorization"]), (["order-17"], ["Bearer k"]))
            self.assertRegex(sent["x-request-id"][0], r"^[0-9a-f-]{36}$")
            self.assertEqual(back["Tubecut-Replica"], "a")
            self.assertIn("max-age", back["Strict-Transport-Security"])

    def test_a_key_has_its_rate_over_all_replicas(self):
        keys = {"cell": ("tc_cell", 4), "twice": ("tc_twice", 2), "free": ("tc_free", None)}
        with tempfile.TemporaryDirectory() as folder:
            rates = rates_of(folder, keys)
            with proxied(lambda h: reply(h, 200), lambda h: reply(h, 200), environment={"TUBECUT_RATES": rates, "TUBECUT_KEY_RATE": "3"}) as (url, stubs):
                passed = 0
                for name, told, most in (
                        ("its own, both ways", [[("Authorization", "Bearer tc_cell")], [("X-Api-Key", "tc_cell")]], 4),
                        ("another's", [[("Authorization", "bearer tc_twice"), ("X-Api-Key", "tc_free")]], 2),
                        ("no limit", [[("X-Api-Key", "tc_free")]], 12),
                        ("in no map", [[("X-Api-Key", "tc_other")]], 3),
                        ("none at all", [[]], 12)):
                    with self.subTest(name):
                        start = time.monotonic()
                        answers = [ask(url, headers=told[i % len(told)]) for i in range(12)]
                        statuses = [a[0] for a in answers]
                        passed += statuses.count(200)
                        self.assertEqual(statuses[:most], [200] * most)
                        if time.monotonic() - start < 0.5:  # else a new second may have begun on a busy machine
                            self.assertEqual(statuses[most:], [429] * (12 - most))
                        if statuses[-1] != 200:
                            self.assertTrue(self.problem(answers[-1], 429, "rate_limited")["retryable"])
                            self.assertEqual(answers[-1][1]["Retry-After"], "1")
                self.assertEqual(sum(len(stub.asked) for stub in stubs), passed)
                self.assertTrue(all(stub.asked for stub in stubs))
                # With a large body over HTTP/2 the refusal arrives as well.
                again = [ask_http2(url, "/v1/bevel-tables", 1_000_000, True, "X-Api-Key: tc_cell") for _ in range(8)]
                self.assertEqual(set(again), {b"2 200", b"2 429"})

    def test_who_asks_far_too_often_still_has_the_rate(self):
        with tempfile.TemporaryDirectory() as folder:
            with proxied(lambda h: reply(h, 200), environment={"TUBECUT_RATES": rates_of(folder, {"cell": ("tc_cell", 5)})}) as (url, stubs):
                end = time.monotonic() + 4
                while time.monotonic() < end:
                    ask(url, headers=[("X-Api-Key", "tc_cell")])
                # The first second's at once, then five a second.
                self.assertGreaterEqual(len(stubs[0].asked), 15)
                self.assertLessEqual(len(stubs[0].asked), 26)

    def test_three_replicas_give_a_key_its_rate_once(self):
        """What the shipped default lets through is three times as much, which is why."""
        with tempfile.TemporaryDirectory() as folder:
            rates = rates_of(folder, {"cell": ("tc_cell", 5)})
            got, lasted = {}, 0.0
            for name, environment in (("each replica's", {}), ("the fleet's", {"TUBECUT_RATES": rates})):
                with unittest.mock.patch.object(restarts.Replica, "options", ["--keys", str(pathlib.Path(folder, "keys"))]), \
                        unittest.mock.patch.object(restarts.Proxy, "environment", environment), \
                        restarts.everything(SERVER, pathlib.Path(folder)) as (_, proxy):
                    url, start = f"https://127.0.0.1:{proxy.port}", time.monotonic()
                    got[name] = [ask(url, "/v1/intersections", headers=[("X-Api-Key", "tc_cell")])[0] for _ in range(40)].count(422)
                    lasted = time.monotonic() - start
            self.assertGreaterEqual(got["each replica's"], 15)
            self.assertLess(got["the fleet's"], 5 * (1 + lasted) + 2)

    def test_rates_are_made_of_the_keys(self):
        lines = "# cells\r\n\nmes aa\r\n cell-3 bb 2.5 # slow\nfour cc 4\n"
        told = subprocess.run([DOCKER / "rates"], input=lines, check=True, capture_output=True, text=True).stdout
        self.assertEqual(told, "aa mes 0\nbb cell-3 3\ncc four 4\n")

    def test_the_service_behind_it_answers_the_same(self):
        with tempfile.TemporaryDirectory() as folder, restarts.everything(SERVER, pathlib.Path(folder)) as (replicas, proxy):
            body = (ROOT / "examples/bevel-tables/source-000-table-1.json").read_bytes()
            self.assertGreater(len(restarts.quiet_answer(replicas, proxy, body)), 100_000)
            wrong = ask(f"https://127.0.0.1:{proxy.port}", body=b"{")
            self.assertEqual((wrong[0], wrong[1]["Content-Type"]), (400, "application/problem+json"))

    @contextlib.contextmanager
    def client_of_a_batch(self, count):
        """(replicas, the Python client of them behind the proxy, items of its batch)."""
        tubecut = load(ROOT / "clients/python/tubecut.py")
        body = json.loads((ROOT / "examples/bevel-tables/source-000-table-1.json").read_text())
        items = [tubecut.BatchItem(f"job {i}", "bevel-tables", body) for i in range(count)]
        with tempfile.TemporaryDirectory() as folder, restarts.everything(SERVER, pathlib.Path(folder)) as (replicas, proxy), \
                unittest.mock.patch.dict(os.environ, SSL_CERT_FILE=f"{folder}/certificate.pem"):
            yield replicas, tubecut.Client(f"https://127.0.0.1:{proxy.port}"), items

    def test_a_batch_of_the_python_client_is_the_work_of_all_replicas(self):
        with self.client_of_a_batch(120) as (replicas, client, items):
            before = [r.cpu_seconds() for r in replicas]
            results = list(client.batch(items))
            used = [r.cpu_seconds() - b for r, b in zip(replicas, before)]
        self.assertEqual(sorted((r.id, r.status) for r in results), sorted((i.id, 200) for i in items))
        self.assertGreater(min(used), 0.15 * sum(used), used)

    def test_a_batch_of_the_python_client_outlives_its_replicas(self):
        """HAProxy has passed the first lines on, so it cannot repeat: the client does."""
        with self.client_of_a_batch(200) as (replicas, client, items):
            seen, told = [], []
            for one in client.batch(items, progress=lambda *numbers: told.append(numbers)):
                seen.append((one.id, one.status))
                if len(seen) in (30, 90, 150):
                    replica = replicas[len(seen) // 60]
                    replica.end(signal.SIGKILL)
                    replica.start()
        self.assertEqual(sorted(seen), sorted((i.id, 200) for i in items))
        self.assertEqual(told, [(n, 200, 0) for n in range(1, 201)])

    def test_bodies_beyond_the_limits_that_the_proxy_lets_through(self):
        small, large = limit("body_max_bytes"), limit("body_large_max_bytes")
        with tempfile.TemporaryDirectory() as folder, restarts.everything(SERVER, pathlib.Path(folder), running=1) as (_, proxy):
            url = f"https://127.0.0.1:{proxy.port}"
            self.problem(ask(url, body=iter([b" " * (small + 1)])), 413, "body_too_large")
            for path, length in (("/v1/bevel-tables", small + 1), ("/v1/replays", large + 1)):
                for announced in (True, False):
                    with self.subTest(path, announced=announced):
                        # About one in a hundred is reset all the same; with a refusal of the proxy's own, each of them.
                        self.assertIn(b"2 413", {ask_http2(url, path, length, announced) for _ in range(3)})


def rates_of(folder, keys):
    """The map for the proxy, by docker/rates from a file of keys as the service reads it: {owner: (key, rate or None)}."""
    lines = (f"{owner} {hashlib.sha256(key.encode()).hexdigest()} {rate or ''}\n" for owner, (key, rate) in keys.items())
    pathlib.Path(folder, "keys").write_text("".join(lines))
    rates = pathlib.Path(folder, "rates.map")
    rates.write_bytes(subprocess.run([DOCKER / "rates", pathlib.Path(folder, "keys")], check=True, capture_output=True).stdout)
    return str(rates)


def announce(url, path, length):
    """As ask, but the body is only announced."""
    host, port = url.removeprefix("https://").split(":")
    with ssl._create_unverified_context().wrap_socket(socket.create_connection((host, int(port)), timeout=10)) as s:
        s.sendall(f"POST {path} HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: {length}\r\n\r\n".encode())
        answer = b"".join(iter(lambda: s.recv(65536), b""))
    head, _, body = answer.partition(b"\r\n\r\n")
    status, *lines = head.decode().split("\r\n")
    names = {n.lower(): v for n, v in (line.split(": ", 1) for line in lines)}
    return int(status.split(" ")[1]), type("Headers", (), {"__getitem__": lambda _, n: names[n.lower()]})(), body


def ask_http2(url, path, length, announced, header="Accept: */*"):
    """Version and status of the answer to so many spaces, by curl: Python has no HTTP/2."""
    body = ["--data-binary", "@-"] if announced else ["-T", "-"]
    return subprocess.run(["curl", "-sk", "--http2", "-X", "POST", *body, "-H", "Content-Type: application/json", "-H", header, "-o", os.devnull,
                           "-w", "%{http_version} %{http_code}", url + path], input=b" " * length, capture_output=True, timeout=20).stdout


class Agreement(unittest.TestCase):
    """Files that must say the same."""

    def walls(self):
        """How long a job may take by the wall's clock, by endpoint: of the long ones, and of the others."""
        with subprocess.Popen([SERVER, "--port", "0", "--admin-port", "0"], stdout=subprocess.PIPE) as child:
            try:
                port = json.loads(child.stdout.readline())["port"]
                with urllib.request.urlopen(f"http://127.0.0.1:{port}/v1/limits", timeout=15) as answer:
                    walls = {name: budget["wall_s"] for name, budget in json.load(answer)["budgets"].items()}
            finally:
                child.kill()
        least = min(walls.values())
        return {p: w for p, w in walls.items() if w > least}, {p: w for p, w in walls.items() if w == least}

    def number(self, pattern):
        return int(re.search(pattern, CONFIG, re.M)[1])

    def test_haproxy_buffers(self):
        size = self.number(r"^  tune\.bufsize (\d+)$")
        self.assertGreaterEqual(size, limit("body_max_bytes") + 16384 + self.number(r"^  tune\.maxrewrite (\d+)$"))
        self.assertAlmostEqual(4 * size / 2**20, 4.25)  # the cost in the comment next to it
        self.assertAlmostEqual(4 * size * self.number(r"^  maxconn (\d+)$") / 2**30, 1.1, delta=0.05)

    def test_haproxy_limits(self):
        denied = [int(n) for n in re.findall(r"content-length\) gt (\d+)", CONFIG)]
        self.assertEqual(denied, [limit("body_large_max_bytes"), limit("body_max_bytes")])
        large = {"/v1/" + f.stem.replace("_", "-") for f in (ROOT / "api/endpoints").rglob("*.[ch]pp")
                 if "body_large_max_bytes" in f.read_text()}
        self.assertTrue(large)
        large.add("/v1/batches")
        self.assertEqual(set(re.search(r"acl large path (.*)", CONFIG)[1].split()), large)
        long, quick = self.walls()
        self.assertGreater(self.number(r"^  timeout server (\d+)s$"), max(quick.values()))
        self.assertEqual(set(re.search(r"acl long path (.*)", CONFIG)[1].split()), {"/v1/batches"} | {"/v1/" + e for e in long})
        self.assertGreater(self.number(r"set-timeout server (\d+)s if long$"), max(long.values()))
        ingress = (DOCKER / "kubernetes/overlays/example/ingress.yaml").read_text()
        self.assertGreater(int(re.search(r"timeout-server: (\d+)s", ingress)[1]), max(long.values()))

    def test_check_settings_knows_the_budgets(self):
        settings = load(ROOT / "tools/check_settings")
        long, quick = self.walls()
        self.assertEqual(settings.default_walls(), long | quick | {"batches": max(long.values())})
        told = subprocess.run([SERVER, "--print-config"], check=True, capture_output=True, text=True).stdout
        for option, value in settings.DEFAULTS.items():
            self.assertEqual(float(re.search(rf"^{option}=(.*)$", told, re.M)[1]), value)

    def test_kubernetes_names_its_image_by_version(self):
        version = re.search(r"project\(tubecut VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
        images = [image for f in (DOCKER / "kubernetes").rglob("*.yaml") for image in re.findall(r"^ *(?:- )?image: (\S+)$", f.read_text(), re.M)]
        self.assertTrue(images)
        tags = [tag for f in (DOCKER / "kubernetes").rglob("*.yaml") for tag in re.findall(r"^ *newTag: (\S+)$", f.read_text(), re.M)]
        told = re.findall(r"tubecut[:-](\d+\.\d+\.\d+)", re.search(r"^## Kubernetes\n(.*?)^## ", (ROOT / "docs/operations.md").read_text(), re.M | re.S)[1])
        self.assertGreater(len(told), 2)
        self.assertEqual(set(tags + told), {version})
        for image in images:
            self.assertTrue(image.endswith(f":{version}") or re.search(r"@sha256:[0-9a-f]{64}$", image), image)

    def test_nothing_is_repeated_because_it_takes_long(self):
        told = [CONFIG, *(f.read_text() for f in (DOCKER / "kubernetes").rglob("*.yaml"))]
        repeats = [line for text in told for line in re.findall(r"^ *retry-on (.*)$", text, re.M)]
        self.assertGreaterEqual(len(repeats), 2)
        for line in repeats:
            self.assertLessEqual(set(line.split()), {"conn-failure", "empty-response", "503"})

    def test_problems_of_the_proxy(self):
        subprocess.run([DOCKER / "errors/make", "--check"], check=True)
        named = set(re.findall(r"TUBECUT_ERRORS}/([\w.-]+)", CONFIG))
        self.assertEqual(named, {p.name for p in (DOCKER / "errors").iterdir() if p.suffix in (".http", ".json")})

    def test_the_proxy_calls_retryable_what_the_service_does(self):
        retryable = set(re.findall(r"status == (\d+)", (ROOT / "server/status.cpp").read_text()))
        self.assertEqual(len(retryable), 3)
        problems = {p.stem: json.loads(re.search(r"{.*}", p.read_text())[0])
                    for p in (DOCKER / "errors").iterdir() if p.suffix in (".http", ".json")}
        self.assertGreater(len(problems), 6)
        statuses = {str(problem["status"]) for problem in problems.values()}
        self.assertEqual(set(re.findall(r"(?:http-error|return) status (\d+) .* hdr Retry-After", CONFIG)), retryable & statuses)
        for name, problem in problems.items():
            self.assertEqual(str(problem["status"]), name.partition("-")[0])
            self.assertEqual(problem["retryable"], str(problem["status"]) in retryable, name)
            self.assertEqual("again" in problem["action"], problem["retryable"], name)

    def test_dockerfile_installs_what_dev_does(self):
        listed = re.search(r"^for_build=\((.*?)\)$", (ROOT / "dev").read_text(), re.M | re.S)[1].split()
        first = re.search(r"install -y --no-install-recommends \\\n(.*?)\nWORKDIR", (DOCKER / "Dockerfile").read_text(), re.S)[1]
        self.assertEqual(sorted(first.replace("\\", " ").split()), sorted(entry.split("/")[0] for entry in listed))

    def test_options_are_documented(self):
        told = subprocess.run([SERVER, "--help"], check=True, capture_output=True, text=True).stdout
        options = dict(re.findall(r"^  (?:-\w,)?(--[\w-]+)(?:.*?=([\w.]+) \(Env)?", told, re.M))
        self.assertGreater(len(options), 20)
        chapters = re.split(r"^## (\w+)\n", (ROOT / "docs/operations.md").read_text(), flags=re.M)
        commands, chapter = (chapters[chapters.index(name) + 1] for name in ("Commands", "Options"))
        table = {}
        for names, default in re.findall(r"^\| (`--.*?) \| (.*?) ?\|", chapter, re.M):
            table |= dict(zip(re.findall(r"--[\w-]+", names), default.split(", "), strict=True))
        elsewhere = {"--help", "--version", "--config"} | set(re.findall(r"`tubecut-server (--[\w-]+)`", commands))
        self.assertEqual(table.keys() | elsewhere, options.keys())
        for name, default in options.items():
            if default:
                self.assertEqual(table[name], default, name)

    def test_compose(self):
        services = yaml.safe_load((DOCKER / "compose.yaml").read_text())["services"]
        replicas = {name: s for name, s in services.items() if name.startswith("tubecut-")}
        hosts = re.findall(r"presetenv TUBECUT_\d ([\w-]+):8080", CONFIG)
        self.assertEqual(sorted(replicas), sorted(hosts))
        self.assertLessEqual({"cpus", "mem_limit", "pids_limit"}, services["haproxy"].keys())
        for name, s in replicas.items():
            with self.subTest(name):
                self.assertTrue(s["read_only"])
                self.assertEqual((s["cap_drop"], s["cpus"], s["mem_limit"], s["pids_limit"]), (["ALL"], 1, "256m", 64))
                self.assertNotIn("ports", s)
                self.assertEqual(s["networks"], ["inside"])
                delay = float(s["environment"]["TUBECUT_DRAIN_DELAY_S"])
                self.assertGreater(delay, 2 * 0.2)  # polls of the proxy
                self.assertGreater(float(s["stop_grace_period"].rstrip("s")), delay + 8 + 5)
                self.assertEqual(s["environment"]["TUBECUT_REPLICA"], name)
                self.assertEqual(s["entrypoint"], ["behind-proxy"])
                self.assertNotIn("TUBECUT_TRUSTED_PROXY", s["environment"])
        self.assertTrue(yaml.safe_load((DOCKER / "compose.yaml").read_text())["networks"]["inside"]["internal"])

    def test_compose_names_what_podman_may_ask_for(self):
        """As podman-compose reads them: soft and hard, after its variables."""
        read = load(ROOT / "tools/check_settings").expanded
        services = {name: s for file in ("compose.yaml", "compose.monitoring.yaml") for name, s in yaml.safe_load(read((DOCKER / file).read_text()))["services"].items()
                    if "image" in s}
        self.assertEqual(len(services), 5)
        for s in services.values():
            if "build" in s:  # on the base that ./dev image makes, of no registry
                self.assertEqual(s["build"]["args"]["BASE"], re.search(r"^base=(.*)$", (DOCKER / "image").read_text(), re.M)[1])
        least = int(re.search(r"connections=(\d+)", subprocess.run([SERVER, "--print-config"], check=True, capture_output=True, text=True).stdout)[1]) + 128
        for name, s in services.items():
            for limit_name, needed in (("nofile", least), ("nproc", s["pids_limit"])):
                soft, hard = (int(s["ulimits"][limit_name][part]) for part in ("soft", "hard"))
                self.assertEqual(soft, hard, name)
                self.assertGreater(soft, needed, name)
                self.assertLess(soft, 1 << 20, name)

    def test_compose_asks_for_no_addresses(self):
        """podman-compose 1.0 gives others."""
        self.assertNotRegex(re.sub("#.*", "", (DOCKER / "compose.yaml").read_text()), r"ipam|subnet|\d+\.\d+\.\d+\.\d+")

    def test_a_replica_believes_its_own_networks(self):
        heading = "Iface\tDestination\tGateway \tFlags\tRefCnt\tUse\tMetric\tMask\t\tMTU\tWindow\tIRTT\n"
        line = lambda destination, gateway, mask: f"eth0\t{destination}\t{gateway}\t0001\t0\t0\t0\t{mask}\t0\t0\t0\n"
        cases = {
            "none": ("", ""),
            "by way of another host": (line("00000000", "014D590A", "00000000") + line("000010AC", "014D590A", "0000F0FF"), ""),
            "10.89.77.0/24": (line("00000000", "014D590A", "00000000") + line("004D590A", "00000000", "00FFFFFF"), "10.89.77.0/24"),
            "two": (line("000010AC", "00000000", "0000F0FF") + line("80A8C0C0", "00000000", "80FFFFFF"), "172.16.0.0/12,192.192.168.128/25"),
        }
        with tempfile.TemporaryDirectory() as folder:
            server, routes = pathlib.Path(folder, "tubecut-server"), pathlib.Path(folder, "routes")
            run = {"env": os.environ | {"PATH": f"{folder}:{os.environ['PATH']}", "TUBECUT_ROUTES": str(routes)}, "stdout": subprocess.PIPE, "text": True}
            server.write_text('#!/bin/sh\necho "$TUBECUT_TRUSTED_PROXY" "$@"\n')
            server.chmod(0o755)
            for name, (text, networks) in cases.items():
                with self.subTest(name):
                    routes.write_text(heading + text)
                    self.assertEqual(subprocess.run([DOCKER / "behind-proxy", "--port", "0"], check=True, **run).stdout, f"{networks} --port 0\n")
            # The service itself then reports the client that the proxy names.
            server.unlink()
            server.symlink_to(SERVER)
            for text, client in ((line("0000007F", "00000000", "000000FF"), "9.9.9.9"), (line("004D590A", "00000000", "00FFFFFF"), "127.0.0.1")):
                routes.write_text(heading + text)
                with subprocess.Popen([DOCKER / "behind-proxy", "--port", "0", "--admin-port", "0"], **run) as child:
                    try:
                        port = json.loads(child.stdout.readline())["port"]
                        ask(f"http://127.0.0.1:{port}", headers=[("X-Forwarded-For", "9.9.9.9")])
                        lines = iter(child.stdout.readline, "")
                        self.assertEqual(next(job["client"] for job in map(json.loads, lines) if job["event"] == "job"), client)
                    finally:
                        child.kill()

    def test_list_of_packages(self):
        spdx = load(DOCKER / "spdx")
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "var/lib/dpkg").mkdir(parents=True)
            (root / "usr/share/tubecut").mkdir(parents=True)
            (root / "var/lib/dpkg/status").write_text(
                "Package: libstdc++6\nStatus: install ok installed\nSource: gcc-12 (12.2.0-14)\nVersion: 12.2.0-14+deb12u1\n"
                "Architecture: amd64\nDescription: x\n Package: not-this\n\n"
                "Package: gone\nStatus: deinstall ok config-files\nVersion: 1\nArchitecture: all\n\n"
                "Package: libc6\nStatus: install ok installed\nVersion: 2.36-9\nArchitecture: amd64\n")
            (root / "usr/share/tubecut/compiled-in").write_text("eigen3 3.4.0-4\ncli11 2.3.2+ds-1\n")
            machine = "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\nFiles: *\nCopyright: x\nLicense: "
            copyrights = {
                "share/doc/libc6": machine + "LGPL-2.1+\n\nFiles: a\nLicense: GPL-1+ or Artistic\n\nLicense: Artistic\n As Perl is.\n .\n Or not.\n",
                "share/doc/gcc-12-base": "This is GCC. See /usr/share/common-licenses/GPL-3.\n",
                "share/tubecut/copyright/cli11.gz": machine + "BSD-3-clause\n All of it.\n"}
            for path, text in copyrights.items():
                file = root / "usr" / path
                if "doc" in path:
                    file.mkdir(parents=True)
                    file /= "copyright"
                file.parent.mkdir(exist_ok=True)
                file.write_bytes(gzip.compress(text.encode()) if file.suffix == ".gz" else text.encode())
            (root / "usr/share/doc/libstdc++6").symlink_to("gcc-12-base")
            d = spdx.document(root, "1.2.3", "abc", "2026-01-01T00:00:00Z")
        declared = {p["name"]: p["licenseDeclared"] for p in d["packages"]}
        self.assertEqual([declared[name] for name in ("libc6", "libstdc++6", "cli11", "eigen3")],
                         ["(GPL-1.0-or-later OR LicenseRef-libc6-Artistic) AND LGPL-2.1-or-later", "LicenseRef-libstdc-6-copyright", "BSD-3-Clause",
                          "NOASSERTION"])
        extracted = {e["licenseId"]: e["extractedText"] for e in d["hasExtractedLicensingInfos"]}
        self.assertEqual(extracted, {"LicenseRef-libc6-Artistic": "As Perl is.\n\nOr not.", "LicenseRef-libstdc-6-copyright": copyrights["share/doc/gcc-12-base"]})
        console = json.loads((ROOT / "web/package.json").read_text())["dependencies"]  # versions pinned; carried in the binary
        self.assertGreaterEqual(len(console), 3)
        ids = [p["SPDXID"] for p in d["packages"]]
        inside = [p for p in d["packages"] if p["SPDXID"].startswith("SPDXRef-Npm-in-")]
        self.assertEqual([p["name"] for p in d["packages"] if p not in inside], ["tubecut", "libc6", "libstdc++6", "cli11", "eigen3", *console])
        swagger = next(p for p in d["packages"] if p["name"] == "swagger-ui-dist")
        held = [r["relatedSpdxElement"] for r in d["relationships"] if r["spdxElementId"] == swagger["SPDXID"] and r["relationshipType"] == "CONTAINS"]
        self.assertEqual(held, [p["SPDXID"] for p in inside])
        self.assertLessEqual({"react", "immutable", "dompurify"}, {p["name"] for p in inside})
        for p in d["packages"][5:5 + len(console)]:
            scoped = p["name"].replace("@", "%40")  # as purl writes a namespace
            self.assertEqual(p["externalRefs"][0]["referenceLocator"], f"pkg:npm/{scoped}@{console[p['name']]}")
            self.assertEqual(p["versionInfo"], console[p["name"]])
            self.assertIn(p["licenseDeclared"], ("MIT", "Apache-2.0", "MPL-2.0"))
            self.assertIn({"spdxElementId": ids[0], "relationshipType": "CONTAINS", "relatedSpdxElement": p["SPDXID"]}, d["relationships"])
        self.assertEqual(len(set(ids)), len(ids))
        for name in ids:
            self.assertRegex(name, r"^SPDXRef-[A-Za-z0-9.-]+$")
        for relation in d["relationships"]:
            self.assertIn(relation["relatedSpdxElement"], ids)
            self.assertIn(relation["spdxElementId"], [*ids, "SPDXRef-DOCUMENT"])
        self.assertEqual(d["spdxVersion"], "SPDX-2.3")
        self.assertEqual(d["packages"][2]["externalRefs"][0]["referenceLocator"],
                         "pkg:deb/debian/libstdc%2B%2B6@12.2.0-14%2Bdeb12u1?arch=amd64&distro=bookworm")
        for p in d["packages"]:
            for key in ("versionInfo", "downloadLocation", "filesAnalyzed", "licenseConcluded", "licenseDeclared", "copyrightText"):
                self.assertIn(key, p)

    def test_parts_inside_npm_packages(self):
        """What the installed ones' bundles say; another version needs another list."""
        spdx = load(DOCKER / "spdx")
        listed = json.loads((DOCKER / "npm-parts.json").read_text())
        locked = {f"{name}@{version}" for name, version, _ in spdx.console()}
        self.assertLessEqual(listed.keys(), locked)
        self.assertEqual(spdx.npm_parts(ROOT / "web/node_modules"), listed)
        self.assertGreater(sum(map(len, listed.values())), 50)

    def test_licences_of_every_package_here(self):
        """This Debian's own copyright files: each gives an expression of known names and of texts that are there."""
        spdx = load(DOCKER / "spdx")
        root, seen = pathlib.Path("/"), 0
        known = set(spdx.SPDX.values())
        for name, *_ in spdx.installed(root):
            text = spdx.copyright_of(root, name)
            if text is None:
                continue
            expression, refs = spdx.licences(name, text)
            words = set(re.findall(r"[^() ]+", expression)) - {"AND", "OR"}
            self.assertTrue(words, name)
            for word in words - known - refs.keys():
                self.assertRegex(word, r"^(A?GPL-[123]\.0|LGPL-(2\.[01]|3\.0)|GFDL-1\.[123](-no-invariants)?)-(only|or-later)$", name)
            self.assertEqual(words & refs.keys(), refs.keys())
            self.assertTrue(all(body.strip() for _, body in refs.values()), name)
            self.assertEqual(expression.count("("), expression.count(")"))
            seen += 1
        self.assertGreater(seen, 50)


if __name__ == "__main__":
    SERVER = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=2)
