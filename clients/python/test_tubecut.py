#!/usr/bin/env python3
"""tubecut.py against the running service: test_tubecut.py --server BINARY [unittest options]"""

import base64
import contextlib
import doctest
import http.server
import inspect
import io
import itertools
import json
import os
import pathlib
import re
import socket
import socketserver
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock
import urllib.request

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples"
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import tubecut  # noqa: E402
from tubecut import Answer, BatchItem, BatchResult, Client, FrameSummary, HashError, ProblemError, ProtocolError, UnreachableError  # noqa: E402

BINARY = ""


class Service:
    def __init__(self, *options):
        self._child = subprocess.Popen([BINARY, "--host", "127.0.0.1", "--port", "0", "--admin-port", "0", "--budget-s", "300", *options],
                                       stdout=subprocess.PIPE, text=True)
        ready = json.loads(self._child.stdout.readline())
        assert ready["event"] == "ready", ready
        self.url = f"http://127.0.0.1:{ready['port']}"
        self._metrics = f"http://127.0.0.1:{ready['admin_port']}/metrics"
        threading.Thread(target=self._child.stdout.read, daemon=True).start()

    def answered(self):
        """Jobs, by its metrics."""
        with urllib.request.urlopen(self._metrics, timeout=10) as page:
            return sum(int(n) for n in re.findall(r'^tubecut_jobs_total{endpoint="intersections",.*} (\d+)$', page.read().decode(), re.M))

    def kill(self):
        self._child.kill()
        self._child.wait()

    def stop(self):
        self._child.terminate()
        return self._child.wait(timeout=30)


def example(path):
    return json.loads((EXAMPLES / path).read_text())


def joint(inclination_deg):
    """A small job: 8 points."""
    return {"target": {"outer_diameter_mm": 70, "wall_mm": 5},
            "cutters": [{"kind": "tube", "outer_diameter_mm": 110, "inclination_deg": inclination_deg}],
            "sampling": {"uniform_points": 8}}


def jobs(count):
    return [BatchItem(f"job {i}", "intersections", joint(40 + 100 * i / count)) for i in range(count)]


def options_by_endpoint(client):
    """{endpoint: the options of its formats} by the contract of the running service."""
    contract = json.loads(client._accepted(client._call("GET", "/openapi.json", None, {})))
    shared = contract["components"]["parameters"]
    told = {path[4:]: {shared[p["$ref"].rsplit("/", 1)[1]]["name"] for p in item["post"]["parameters"]
                       if shared[p["$ref"].rsplit("/", 1)[1]]["in"] == "query"}
            for path, item in contract["paths"].items() if "post" in item}
    return {endpoint: names - {"format", "validate_only"} for endpoint, names in told.items()}


def unused_url():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return f"http://127.0.0.1:{free.getsockname()[1]}"


class Watched(Client):
    """Keeps the path of each exchange but those of _streamed."""

    def __init__(self, *urls):
        super().__init__(*urls)
        self.paths = []

    def _exchange(self, url, method, path, *rest):
        self.paths.append(path)
        return super()._exchange(url, method, path, *rest)


class OneByOne(Watched):
    """As if the service had no /v1/batches."""

    def _has_batches(self, url):
        return False


class Batches(http.server.ThreadingHTTPServer):
    """A stand-in for POST /v1/batches, and for the lines of POST /v1/frames, by their contract, which asks the real service; it can be made to fail."""

    daemon_threads = True

    def __init__(self, service_url):
        super().__init__(("127.0.0.1", 0), BatchHandler)
        self.url = f"http://127.0.0.1:{self.server_address[1]}"
        self.engine = Client(service_url)
        self.received = []           # ids of each batch
        self.dies_after = None       # answers
        self.full_batches = 0        # refused with 503
        self.refused_once = set()    # ids answered with 503 the first time
        self.answers_as = {}         # id -> other id
        self.edit = lambda line: line
        self.hung_up = threading.Event()
        self.pause_s = 0.0
        threading.Thread(target=self.serve_forever, args=(0.02,), daemon=True).start()

    def handle_error(self, request, client_address):
        pass

    def close(self):
        self.shutdown()
        self.server_close()


class Turns(socketserver.ThreadingTCPServer):
    """One address before several services: each connection is the next one's."""

    daemon_threads = allow_reuse_address = True

    def __init__(self, urls):
        super().__init__(("127.0.0.1", 0), TurnsHandler)
        self.url = f"http://127.0.0.1:{self.server_address[1]}"
        self.turns = itertools.cycle(int(url.rsplit(":", 1)[1]) for url in urls)
        threading.Thread(target=self.serve_forever, args=(0.02,), daemon=True).start()

    def close(self):
        self.shutdown()
        self.server_close()


class TurnsHandler(socketserver.BaseRequestHandler):
    def handle(self):
        with socket.create_connection(("127.0.0.1", next(self.server.turns))) as service:
            back = threading.Thread(target=pass_on, args=(service, self.request), daemon=True)
            back.start()
            pass_on(self.request, service)
            back.join()


def pass_on(source, sink):
    with contextlib.suppress(OSError):
        while data := source.recv(65536):
            sink.sendall(data)
    with contextlib.suppress(OSError):
        sink.shutdown(socket.SHUT_WR)


class BatchHandler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    busy = {"type": "", "title": "", "status": 503, "code": "overloaded", "detail": "", "request_id": "", "retryable": True,
            "action": "", "errors": []}

    def log_message(self, *_):
        pass

    def do_POST(self):
        try:
            (self.run_frame if self.path == "/v1/frames" else self.run_batch)(int(self.headers["Content-Length"]))
        except OSError:
            self.server.hung_up.set()

    def run_batch(self, length):
        if length == 0:
            return self.answer_whole(200, b'{"summary":{"items":0}}\n')
        server = self.server
        if server.full_batches:
            server.full_batches -= 1
            self.rfile.read(length)
            return self.answer_whole(503, json.dumps(self.busy).encode())
        self.begin_lines()
        ids, left = [], length
        server.received.append(ids)
        while left:
            raw = self.rfile.readline()
            left -= len(raw)
            item = json.loads(raw)
            ids.append(item["id"])
            if server.dies_after is not None and len(ids) > server.dies_after:
                return None  # no last chunk, no summary
            time.sleep(server.pause_s)
            self.chunk(server.edit(self.line(item)))
        self.chunk(json.dumps({"summary": {"items": len(ids)}}) + "\n")
        self.wfile.write(b"0\r\n\r\n")

    def run_frame(self, length):
        server, request = self.server, self.rfile.read(length)
        if server.full_batches:
            server.full_batches -= 1
            return self.answer_whole(503, json.dumps(self.busy).encode())
        reply = server.engine._exchange(server.engine._urls[0], "POST", "/v1/frames", request, {"Accept": "application/x-ndjson"})
        if reply.status != 200:
            return self.answer_whole(reply.status, reply.body)
        head, *parts, summary = reply.body.decode().splitlines(keepends=True)
        self.begin_lines()
        ids = []
        server.received.append(ids)
        self.chunk(head)
        for line in parts:
            if len(ids) == server.dies_after:
                return None
            part = json.loads(line)
            ids.append(part["id"])
            time.sleep(server.pause_s)
            if part["id"] in server.refused_once:
                server.refused_once.discard(part["id"])
                line = json.dumps({**part, "status": 503, "body": self.busy}) + "\n"
            self.chunk(server.edit(line))
        self.chunk(summary)
        self.wfile.write(b"0\r\n\r\n")

    def begin_lines(self):
        self.send_response(200)
        self.send_header("Transfer-Encoding", "chunked")
        self.send_header("Connection", "close")
        self.end_headers()
        self.close_connection = True

    def line(self, item):
        server = self.server
        status, body = 200, ""
        if item["id"] in server.refused_once:
            server.refused_once.discard(item["id"])
            status, body = 503, json.dumps(self.busy)
        else:
            reply = server.engine._exchange(server.engine._urls[0], "POST", f"/v1/{item['endpoint']}",
                                            json.dumps(item["body"]).encode(), {})
            status, body = reply.status, reply.body.decode()
        id_ = server.answers_as.get(item["id"], item["id"])
        return f'{{"id":{json.dumps(id_)},"status":{status},"body":{body}}}\n'

    def chunk(self, text):
        data = text.encode()
        self.wfile.write(f"{len(data):x}\r\n".encode() + data + b"\r\n")

    def answer_whole(self, status, body):
        self.send_response(status)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = Service()
        cls.client = Client(cls.service.url)

    @classmethod
    def tearDownClass(cls):
        if cls.service.stop() != 0:
            raise AssertionError("the service did not end with 0")

    def stand_in(self):
        batches = Batches(self.service.url)
        self.addCleanup(batches.close)
        return batches


def keyed_service(folder):
    """(service, key) of a service that asks for keys."""
    made = subprocess.run([BINARY, "new-key", "shop"], capture_output=True, text=True, check=True).stdout
    keys = pathlib.Path(folder, "keys")
    keys.write_text(next(line for line in made.splitlines() if line.startswith("shop ")) + "\n")
    return Service("--keys", str(keys)), re.search(r"tc_[A-Za-z0-9_-]+", made)[0]


class Readme(Case):
    text = (HERE / "README.md").read_text()

    def test_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            keyed, key = keyed_service(folder)
        self.addCleanup(keyed.stop)
        text = self.text
        for url, service in (("http://127.0.0.1:8080", self.service), ("https://tubecut.example:8443", keyed)):
            self.assertIn(f'Client("{url}"', text)
            text = text.replace(url, service.url)
        examples = doctest.DocTestParser().get_doctest(text, {}, "README", "README.md", 0)
        self.assertGreater(len(examples.examples), 12)
        output = io.StringIO()
        with unittest.mock.patch.dict(os.environ, TUBECUT_KEY=key):
            result = doctest.DocTestRunner(verbose=False).run(examples, out=output.write)
        self.assertEqual(result.failed, 0, output.getvalue())

    def test_commands_run(self):
        commands = re.findall("^python3 tubecut.py (.*)$", self.text, re.MULTILINE)
        self.assertEqual(len(commands), 4)
        table = example("bevel-tables/source-000-table-1.json")
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "request.json").write_text(json.dumps(table))
            pathlib.Path(folder, "my.key").write_text("any")
            pathlib.Path(folder, "frame.json").write_text(json.dumps(example("frames/truss-of-19.json")))
            lines = [*jobs(5), BatchItem("B1", "bevel-tables", table)]
            pathlib.Path(folder, "jobs.ndjson").write_bytes(b"".join(item.line() for item in lines))
            for command in commands:
                here = re.sub(r"http://[\d.:]+", self.service.url, command if "--url" in command else f"--url http://127.0.0.1:8080 {command}")
                done = subprocess.run(f"{sys.executable} -B {HERE}/tubecut.py {here}", shell=True, cwd=folder, capture_output=True, text=True,
                                      timeout=60)
                self.assertEqual(done.returncode, 0, done.stderr)
                if ">" not in command:
                    Answer.of(done.stdout)
            parts = pathlib.Path(folder, "parts.ndjson").read_text().splitlines()
            self.assertEqual(json.loads(parts[-1])["summary"]["answered"], len(parts) - 2)
            self.assertIn("G93", pathlib.Path(folder, "cut.ngc").read_text())
            answers = pathlib.Path(folder, "answers.ndjson").read_text().splitlines()
            self.assertEqual({json.loads(line)["id"] for line in answers}, {item.id for item in lines})


class SingleJobs(Case):
    def test_every_endpoint_has_its_method(self):
        endpoints = [e["id"] for e in self.client.version()["endpoints"] if e["id"] != "batches"]
        self.assertGreater(len(endpoints), 5)
        for endpoint in endpoints:
            method = getattr(Client, endpoint.replace("-", "_"))
            self.assertIn(f'"{endpoint}"', inspect.getsource(method))

    def test_hashes_of_every_example(self):
        examples = self.client.catalogue("examples")["examples"]
        self.assertGreater(len(examples), 10)
        for one in examples:
            with self.subTest(endpoint=one["endpoint"], name=one["name"]):
                method = getattr(self.client, one["endpoint"].replace("-", "_"))
                answer = method(one["body"])
                self.assertTrue(answer.verification["passed"])
                self.assertTrue(answer.result)

    def test_reference_and_log_are_outside_the_hash(self):
        plain = self.client.intersections(joint(60))
        dressed = self.client.intersections({"log": "inline", "reference": {"part": 'B1 "a" \\ {x}, ]'}, **joint(60)})
        self.assertEqual(dressed.request["reference"]["part"], 'B1 "a" \\ {x}, ]')
        self.assertTrue(dressed.log)
        self.assertEqual(dressed.job["input_sha256"], plain.job["input_sha256"])
        self.assertEqual(dressed.job["result_sha256"], plain.job["result_sha256"])

    def test_a_changed_byte_is_seen(self):
        text = self.client.intersections(joint(60)).text
        Answer.of(text)
        result = text.index('"result":')
        for name, changed in {
            "result": text[:result] + text[result:].replace("1", "2", 1),
            "last digit": text.replace('"developed_length_mm":188.49555921538', '"developed_length_mm":188.49555921537', 1),
            "request": text.replace('"inclination_deg":60', '"inclination_deg":61', 1),
            "spacing": text.replace('"result":{', '"result":{ ', 1),
            "number format": text.replace('"inclination_deg":60', '"inclination_deg":60.0', 1),
            "hash": text.replace('"result_sha256":"', '"result_sha256":"0', 1),
        }.items():
            with self.subTest(name):
                self.assertNotEqual(changed, text)
                with self.assertRaises(HashError):
                    Answer.of(changed)
                Answer.of(changed, check_hashes=False)
        for cut in (0, 1, len(text) // 3, len(text) // 2, len(text) - 1):
            with self.assertRaises(ProtocolError):
                Answer.of(text[:cut])

    def test_decoy_members_inside_strings_and_objects(self):
        """Text that looks like the members the client slices."""
        decoy = '"result":{"x":1}}'
        answer = self.client.intersections({**joint(60), "target": {"id": decoy, "outer_diameter_mm": 70, "wall_mm": 5}})
        self.assertEqual(answer.request["target"]["id"], decoy)

    def test_problem(self):
        with self.assertRaises(ProblemError) as refused:
            self.client.bevel_tables({"target": {"outer_diameter_mm": 70, "wall_mm": 0}, "cutters": []})
        problem = refused.exception.problem
        self.assertEqual((problem.status, problem.code, problem.retryable), (422, "invalid_request", False))
        self.assertRegex(problem.request_id, "^[0-9a-f]{32}$")
        wall = next(e for e in refused.exception.errors if e.pointer == "/target/wall_mm")
        self.assertEqual((wall.code, wall.got, wall.limit, wall.unit), ("out_of_range", 0, 0.5, "mm"))

    def test_columns_that_are_named(self):
        body = example("bevel-tables/source-000-table-1.json")
        whole, some = self.client.bevel_tables(body), self.client.bevel_tables(body | {"columns": ["b_deg", "phi_deg"]})
        self.assertEqual(list(some.result["points"]), ["phi_deg", "b_deg"])
        self.assertEqual(some.result["points"]["b_deg"], whole.result["points"]["b_deg"])
        self.assertEqual(some.job["result_sha256"], whole.job["result_sha256"])

    def test_other_formats_and_catalogues(self):
        body = example("bevel-tables/source-000-table-1.json")
        self.assertIn(b"<svg", self.client.document("bevel-tables", body, "svg"))
        with self.assertRaises(ProblemError) as refused:
            self.client.document("bevel-tables", body, "docx")
        self.assertEqual(refused.exception.problem.status, 406)
        for name in ("errors", "limits", "machines", "tubes"):
            self.assertTrue(self.client.catalogue(name))

    def test_every_option_of_a_format_is_told_and_sent(self):
        names = set().union(*options_by_endpoint(self.client).values())
        self.assertGreater(len(names), 6)
        for name in names:
            self.assertIn(name, Client.document.__doc__)
            with self.assertRaises(ProblemError) as refused:  # each arrives: no format takes this value
                self.client.document("bevel-tables", joint(60), "csv", **{name: "never"})
            self.assertEqual(refused.exception.errors[0].pointer, "?" + name)
        body = example("bevel-tables/source-000-table-1.json")
        program = self.client.document("bevel-tables", body, "gcode", speed_mm_min=600, axial="z", lead_mm=2.5)
        self.assertEqual((program.media, program.verdict), ("text/x-gcode", self.client.post("bevel-tables", body).verdict["status"]))
        self.assertRegex(program.input_sha256 + program.result_sha256, "^[0-9a-f]{128}$")
        for bad in ("Träger Ø60", " x", "x" * 129, ""):
            with self.assertRaises(ValueError):
                self.client.post("bevel-tables", body, job_id=bad)
        self.assertIn(b"Z", program)
        plain, mirrored = (self.client.document("bevel-tables", body, "svg", view="template", mirror=m) for m in (False, True))
        self.assertNotEqual(plain, mirrored)

    def test_every_option_of_every_endpoint(self):
        """What the contract lists for an endpoint reaches it, by its method too."""
        examples = {one["endpoint"]: one["body"] for one in self.client.catalogue("examples")["examples"]}
        told = options_by_endpoint(self.client)
        self.assertEqual(told.pop("batches"), set())
        self.assertEqual(set(told), set(examples))
        for endpoint, names in told.items():
            body = examples[endpoint]
            dry = getattr(self.client, endpoint.replace("-", "_"))(body, validate_only=True, job_id="dry")
            self.assertEqual((dry.result, dry.job["id"]), ({}, "dry"))
            for name in names - {"view"}:  # JSON has no views to choose from
                with self.subTest(endpoint=endpoint, name=name), self.assertRaises(ProblemError) as refused:
                    self.client.document(endpoint, body, "json", **{name: "never"})
                self.assertEqual([error.pointer for error in refused.exception.errors], ["?" + name])

    def test_the_next_replica_answers_for_a_dead_one(self):
        self.assertEqual(Client(unused_url(), self.service.url).intersections(joint(60)).job["endpoint"], "intersections")

    def test_nobody_answers(self):
        self.assertRaises(UnreachableError, Client(unused_url(), unused_url(), patience_s=0.3).intersections, joint(60))
        client, start = Client("http://no-such-host.invalid:8080", patience_s=60), time.monotonic()
        for call in (client.version, lambda: list(client.batch([BatchItem("a", "bevel-tables", {})])), lambda: client.frames({})):
            self.assertRaisesRegex(UnreachableError, "no host of this name", call)
        self.assertLess(time.monotonic() - start, 20)  # a wrong name ends a call at once

    def test_a_full_replica_is_asked_again(self):
        statuses = []

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *_):
                pass

            def do_POST(self):
                self.rfile.read(int(self.headers["Content-Length"]))
                statuses.append(429)
                body = json.dumps({**BatchHandler.busy, "status": 429, "code": "rate_limited"}).encode()
                self.send_response(429)
                self.send_header("Retry-After", "0")
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as full:
            threading.Thread(target=full.serve_forever, args=(0.02,), daemon=True).start()
            url = f"http://127.0.0.1:{full.server_address[1]}"
            self.assertTrue(Client(url, self.service.url).intersections(joint(60)).result)
            with self.assertRaises(ProblemError):
                Client(url, patience_s=0.3).intersections(joint(60))
            full.shutdown()
        self.assertGreater(len(statuses), 2)

    def test_connections_are_kept_and_replaced(self):
        client = Client(self.service.url)
        client.intersections(joint(60))
        kept = client._connections.open[self.service.url]
        client.intersections(joint(61))
        self.assertIs(client._connections.open[self.service.url], kept)
        kept.sock.shutdown(socket.SHUT_RDWR)  # as after the service's idle time
        client.intersections(joint(62))
        self.assertIsNot(client._connections.open[self.service.url], kept)


class BatchesOfJobs(Case):
    def whole(self, client, items, **options):
        """Asserts that each id came once."""
        results = list(client.batch(items, **options))
        self.assertEqual(sorted(r.id for r in results), sorted(i.id for i in items))
        return {r.id: r for r in results}

    def assert_as_single(self, results, items):
        for item in items:
            single = self.client.post(item.endpoint, item.body, job_id=item.id)
            got = results[item.id].unwrap()
            self.assertEqual(got.job["result_sha256"], single.job["result_sha256"])
            self.assertEqual(got.result, single.result)

    def test_one_by_one(self):
        items = jobs(40) + [BatchItem("bad", "intersections", joint(200)), BatchItem("größer than latin: ≥", "intersections", joint(50))]
        results = self.whole(OneByOne(self.service.url), items)
        self.assert_as_single(results, items[:3])
        self.assertEqual((results["bad"].status, results["bad"].problem.errors[0].pointer), (422, "/cutters/0/inclination_deg"))
        with self.assertRaises(ProblemError):
            results["bad"].unwrap()

    def test_the_service_as_it_is(self):
        self.whole(self.client, jobs(40))

    def test_streamed(self):
        batches = self.stand_in()
        items = jobs(60) + [BatchItem("bad", "intersections", joint(200))]
        results = self.whole(Client(batches.url), items)
        self.assertEqual(batches.received, [[i.id for i in items]])
        self.assert_as_single(results, items[:3])
        self.assertEqual(results["bad"].problem.errors[0].pointer, "/cutters/0/inclination_deg")

    def test_items_that_name_a_format(self):
        """Beside others, by the stream and one by one; the same bytes as of document()."""
        table = example("bevel-tables/source-000-table-1.json")
        gcode = {"speed_mm_min": 600, "axial": "z", "lead_mm": 2.5}
        wall = {**table, "target": {"outer_diameter_mm": 70, "wall_mm": 0}}
        items = [*jobs(3), BatchItem("csv", "bevel-tables", table, "csv"), BatchItem("gcode", "bevel-tables", table, "gcode", gcode),
                 BatchItem("mirrored", "bevel-tables", table, "svg", {"view": "template", "mirror": True}),
                 BatchItem("glb", "bevel-tables", table, "glb"), BatchItem("no speed", "bevel-tables", table, "gcode"),
                 BatchItem("no wall", "bevel-tables", wall, "csv"), BatchItem("json", "bevel-tables", table, "json")]
        dead = unused_url()
        for client, paths in ((Watched(self.service.url), ["/v1/batches"]), (Watched(dead, self.service.url), ["/v1/batches"]),
                              (OneByOne(self.service.url), [item.path() for item in items])):
            results = self.whole(client, items)
            self.assertEqual(sorted(client.paths), sorted(paths))
            self.assert_as_single(results, [items[-1]])
            self.assertEqual({r.status for r in results.values()}, {200, 400, 422})
            for item in items[3:7]:
                alone = self.client.document("bevel-tables", table, item.format, job_id=item.id, **item.options)
                self.assertEqual(results[item.id].unwrap_document(), alone)
                self.assertEqual((results[item.id].verdict, results[item.id].media), (alone.verdict, alone.media))
                with self.assertRaises(ValueError):
                    results[item.id].unwrap()
            self.assertEqual([results[id].media for id in ("csv", "gcode", "glb")], ["text/csv", "text/x-gcode", "model/gltf-binary"])
            self.assertTrue(results["job 0"].unwrap().result)
            with self.assertRaises(ValueError):
                results["job 0"].unwrap_document()
            for id, pointer in (("no speed", "?speed_mm_min"), ("no wall", "/target/wall_mm")):
                with self.assertRaises(ProblemError) as refused:
                    results[id].unwrap_document()
                self.assertEqual(refused.exception.errors[0].pointer, pointer)
        with self.assertRaises(ValueError):
            BatchItem("options only", "bevel-tables", table, options={"view": "template"})

    def test_a_document_that_cannot_be_read(self):
        batches = self.stand_in()
        for media, name, content in (("model/stl", "document_base64", "a"), ("model/stl", "document_base64", "YQ=?="), ("model/stl", "document_base64", None),
                                     ("text/csv", "document", 1), ("text/csv", "document", "\ud800"), (None, "document", "a")):
            line = {"id": "job 0", "line": 1, "status": 200, **({"media": media} if media else {}), name: content}
            batches.edit = lambda _, line=line: json.dumps(line) + "\n"
            with self.subTest(**line), self.assertRaises(ProtocolError):
                list(Client(batches.url).batch(jobs(1)))

    def test_a_second_replica_completes_what_the_first_left(self):
        first, second = self.stand_in(), self.stand_in()
        first.dies_after = 13
        items = jobs(50)
        self.whole(Client(first.url, second.url), items, streams=1)
        self.assertEqual(len(first.received[0]), 14)
        self.assertEqual(sorted(second.received[0]), sorted(i.id for i in items[13:]))

    def test_several_addresses_share_a_batch(self):
        replicas = [self.stand_in() for _ in range(3)]
        for one in replicas:
            one.pause_s = 0.01
        items = jobs(90)
        told = []
        results = self.whole(Client(*(r.url for r in replicas)), items, progress=lambda *numbers: told.append(numbers))
        self.assert_as_single(results, items[::40])
        shares = [sum(map(len, r.received)) for r in replicas]
        self.assertEqual(sum(shares), 90)
        self.assertGreater(min(shares), 20, shares)
        self.assertEqual(told, [(n, 90, 0) for n in range(1, 91)])

    def test_a_slow_replica_gets_fewer(self):
        quick, slow = self.stand_in(), self.stand_in()
        quick.pause_s, slow.pause_s = 0.001, 0.1
        self.whole(Client(quick.url, slow.url), jobs(90))
        self.assertLess(sum(map(len, slow.received)), 45)

    def test_replicas_behind_one_address_share_a_batch(self):
        replicas = [Service("--replica", f"r{i}", "--slots", "1") for i in range(3)]
        for one in replicas:
            self.addCleanup(one.stop)
        proxy = Turns([r.url for r in replicas])
        self.addCleanup(proxy.close)
        items = jobs(300)
        self.whole(Client(proxy.url), items)
        counts = [r.answered() for r in replicas]
        self.assertEqual(sum(counts), 300)
        self.assertGreater(min(counts), 20, counts)
        self.whole(Client(proxy.url), jobs(90), streams=1)
        self.assertEqual(sum(r.answered() - n > 0 for r, n in zip(replicas, counts)), 1)

    def test_one_replica_gets_a_batch_whole(self):
        self.assertEqual(Client(self.service.url)._replicas(), 1)
        batches = self.stand_in()
        self.whole(Client(batches.url), jobs(90))
        self.assertEqual([len(ids) for ids in batches.received], [90])

    def test_all_but_one_of_several_die_and_one_is_full(self):
        first, second, third = replicas = [self.stand_in() for _ in range(3)]
        first.dies_after, second.full_batches = 5, 2
        third.refused_once = {f"job {i}" for i in range(0, 120, 7)}
        self.whole(Client(*(r.url for r in replicas)), jobs(120))
        self.assertGreater(len(first.received[0]), 0)

    def test_faults_of_one_part_end_the_batch(self):
        for spoil, error in ((lambda b: setattr(b, "answers_as", {"job 61": "job 99"}), ProtocolError),
                             (lambda b: setattr(b, "edit", lambda line: line.replace('"radius_mm":35', '"radius_mm":36')), HashError)):
            replicas = [self.stand_in() for _ in range(2)]
            for one in replicas:
                spoil(one)
            with self.assertRaises(error):
                list(Client(*(r.url for r in replicas)).batch(jobs(62)))
        start = time.monotonic()
        for one in replicas:
            one.dies_after = 0
        with self.assertRaises(UnreachableError):
            list(Client(*(r.url for r in replicas), patience_s=0.5).batch(jobs(60)))
        self.assertLess(time.monotonic() - start, 10)

    def test_items_are_read_by_the_caller_and_no_further_than_needed(self):
        replicas = [self.stand_in() for _ in range(2)]
        lines, tubecut._BATCH_LINES = tubecut._BATCH_LINES, 20
        self.addCleanup(setattr, tubecut, "_BATCH_LINES", lines)
        taken = []

        def endless():
            for item in jobs(10_000):
                taken.append(threading.get_ident())
                yield item

        results = Client(*(r.url for r in replicas)).batch(endless())
        got = [next(results).id for _ in range(60)]
        results.close()
        self.assertEqual(len(set(got)), 60)
        self.assertEqual(set(taken), {threading.get_ident()})
        self.assertLess(len(taken), 500)
        deadline = time.monotonic() + 10
        while any(t.name == "tubecut" for t in threading.enumerate()):
            self.assertLess(time.monotonic(), deadline, "a part goes on after its caller has left")
            time.sleep(0.02)

    def test_a_replica_killed_midway(self):
        first, second = Service(), Service()
        self.addCleanup(second.stop)
        self.addCleanup(first.kill)
        items = jobs(200)
        seen = []
        for one in Client(first.url, second.url).batch(items):
            seen.append(one.id)
            if len(seen) == 20:
                first.kill()
        self.assertEqual(sorted(seen), sorted(i.id for i in items))

    def test_full_replicas_and_refused_items_are_asked_again(self):
        batches = self.stand_in()
        batches.full_batches = 2
        batches.refused_once = {"job 3", "job 7"}
        self.whole(Client(batches.url), jobs(10))
        self.assertEqual([len(ids) for ids in batches.received], [10, 2])

    def test_gives_up(self):
        batches = self.stand_in()
        batches.dies_after = 0
        start = time.monotonic()
        with self.assertRaises(UnreachableError):
            list(Client(batches.url, patience_s=0.5).batch(jobs(3)))
        self.assertLess(time.monotonic() - start, 10)

    def test_an_answer_nobody_asked_for(self):
        batches = self.stand_in()
        batches.answers_as = {"job 1": "job 99"}
        with self.assertRaises(ProtocolError):
            list(Client(batches.url).batch(jobs(3)))

    def test_a_changed_byte_in_a_line(self):
        batches = self.stand_in()
        batches.edit = lambda line: line.replace('"radius_mm":35', '"radius_mm":36')
        with self.assertRaises(HashError):
            list(Client(batches.url).batch(jobs(3)))

    def test_a_caller_that_stops_hangs_up(self):
        for count in (1, 2):
            replicas = [self.stand_in() for _ in range(count)]
            for one in replicas:
                one.pause_s = 0.05
            results = Client(*(r.url for r in replicas)).batch(jobs(200))
            next(results)
            results.close()
            for one in replicas:
                self.assertTrue(one.hung_up.wait(10))
                self.assertLess(len(one.received[0]), 40)

    def test_large_batches_go_in_parts_and_are_read_lazily(self):
        batches = self.stand_in()
        taken = []

        def endless():
            for item in jobs(10_000):
                taken.append(item.id)
                yield item

        lines, tubecut._BATCH_LINES = tubecut._BATCH_LINES, 25
        self.addCleanup(setattr, tubecut, "_BATCH_LINES", lines)
        results = Client(batches.url).batch(endless())
        got = [next(results).id for _ in range(60)]
        results.close()
        self.assertEqual(len(set(got)), 60)
        self.assertEqual([len(ids) for ids in batches.received[:2]], [25, 25])
        self.assertLess(len(taken), 100)

    def test_an_id_that_comes_twice(self):
        with self.assertRaises(ValueError):
            list(self.client.batch([jobs(1)[0], jobs(1)[0]]))


class Frames(Case):
    def setUp(self):
        self.roof = example("frames/truss-of-500.json")
        self.cage = example("frames/roll-cage-of-12.json")
        self.spoiled = example("frames/truss-of-19.json")
        post = next(m for m in self.spoiled["members"] if m["id"] == "P0")
        post["outer_diameter_mm"] = 120  # wider than its chords

    def whole(self, client, request):
        """The lines, each part once, as of the answer at once."""
        head, *parts, summary = client.frame_lines(request)
        self.assertIsInstance(head, Answer)
        self.assertIsInstance(summary, FrameSummary)
        made = {p["part"]: p for p in self.client.frames(request).parts}
        self.assertEqual(sorted(p.id for p in parts), sorted(made))
        for part in parts:
            self.assertIsInstance(part, BatchResult)
            if part.answer:
                self.assertEqual(part.answer.job["result_sha256"], made[part.id]["answer"]["job"]["result_sha256"])
            else:
                self.assertEqual(part.problem.code, made[part.id]["problem"]["code"])
        self.assertEqual(summary, FrameSummary(len(parts), sum(p.problem is None for p in parts), sum(p.answer is None for p in parts)))
        return parts

    def test_every_example(self):
        for file in sorted((EXAMPLES / "frames").glob("*.json")):
            with self.subTest(file.stem):
                self.whole(self.client, json.loads(file.read_text()))

    def test_the_frame_and_its_progress(self):
        told = []
        frame = self.client.frame(self.roof, job_id="roof", progress=lambda *numbers: told.append(numbers))
        items = len(frame.parts)
        self.assertGreater(items, 10)
        self.assertEqual(told, [(n, items, 0) for n in range(items + 1)])
        self.assertEqual((frame.head.job["id"], len(frame.head.result["members"])), ("roof", 500))
        rows = {row["part"]: row for row in frame.head.result["cut_list"]}
        for member in ("A top 1", "H top 2", "GH bottom 18", "C post 7"):
            self.assertIn(member, rows[frame.part_of(member).id]["members"])
        with self.assertRaises(KeyError):
            frame.part_of("I top 1")

    def test_parts_that_cannot_be_cut(self):
        told = []
        frame = self.client.frame(self.spoiled, progress=lambda *numbers: told.append(numbers))
        self.assertEqual((frame.summary.refused, told[-1][2]), (1, 1))
        with self.assertRaises(ProblemError):
            frame.part_of("P0").unwrap()
        self.assertTrue(frame.part_of("P1").unwrap().result)

    def test_a_frame_that_is_refused(self):
        with self.assertRaises(ProblemError) as refused:
            self.client.frame({**self.cage, "kerf_mm": -1})
        self.assertEqual(refused.exception.errors[0].pointer, "/kerf_mm")
        with self.assertRaises(ProblemError) as refused:
            self.client.frame({**self.cage, "numerics": 999})
        self.assertEqual(refused.exception.problem.code, "numerics_mismatch")
        with self.assertRaises(UnreachableError):
            Client(unused_url(), patience_s=0.3).frame(self.cage)

    def test_replicas_that_die_or_are_full(self):
        first, second = self.stand_in(), self.stand_in()
        first.dies_after, second.full_batches, second.refused_once = 5, 1, {"harness", "main top"}
        parts = self.whole(Client(unused_url(), first.url, second.url), self.cage)
        self.assertEqual([p.id for p in parts[:5]], first.received[0])
        self.assertEqual(sum("harness" in ids for ids in second.received), 2)
        for one in (first, second):
            one.dies_after = 0
        start = time.monotonic()
        with self.assertRaises(UnreachableError):
            Client(first.url, second.url, patience_s=0.5).frame(self.cage)
        self.assertLess(time.monotonic() - start, 10)

    def test_a_changed_byte_of_a_part(self):
        stand_in = self.stand_in()
        stand_in.edit = lambda line: line.replace('"wall_mm":2.5', '"wall_mm":2.6', 1)
        with self.assertRaises(HashError):
            Client(stand_in.url).frame(self.cage)
        text = self.client.frames(self.cage).text
        at = text.index('"developed_length_mm":') + len('"developed_length_mm":')
        changed = f"{text[:at]}{(int(text[at]) + 1) % 10}{text[at + 1:]}"
        with self.assertRaises(HashError):
            Answer.of(changed)
        Answer.of(changed, check_hashes=False)

    def test_a_caller_that_stops_hangs_up(self):
        stand_in = self.stand_in()
        stand_in.pause_s = 0.1
        lines = Client(stand_in.url).frame_lines(self.cage)
        next(lines)
        next(lines)
        lines.close()
        self.assertTrue(stand_in.hung_up.wait(10))
        self.assertLess(len(stand_in.received[0]), 10)


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Progress(unittest.TestCase):
    def test_bar(self):
        now = [0.0]
        terminal = Terminal()
        bar = tubecut.ProgressBar(terminal, width=10, clock=lambda: now[0])
        now[0] = 2.0
        bar(500, 1000, 3)
        bar(501, 1000, 3)  # too soon to be drawn
        now[0] = 4.0
        bar(1000, 1000, 3)
        bar.close()
        self.assertEqual(terminal.getvalue(),
                         "\r\x1b[K[#####     ] 500/1000  3 refused  250/s  2 s left"
                         "\r\x1b[K[##########] 1000/1000  3 refused  250/s\n")

    def test_silent_elsewhere(self):
        file = io.StringIO()
        bar = tubecut.ProgressBar(file)
        bar(1, 2, 0)
        bar.close()
        self.assertEqual(file.getvalue(), "")


class Key(unittest.TestCase):
    def test_a_service_with_keys(self):
        with tempfile.TemporaryDirectory() as folder:
            service, key = keyed_service(folder)
            self.addCleanup(service.stop)
            mine = pathlib.Path(folder, "mine")
            mine.write_text(key + "\n")
            with self.assertRaises(ProblemError) as refused:
                Client(service.url).intersections(joint(60))
            self.assertEqual(refused.exception.problem.code, "unauthorized")
            self.assertTrue(Client(service.url, key=key).intersections(joint(60)).result)
            command = [sys.executable, "-B", HERE / "tubecut.py", "--url", service.url]
            post = ["post", "intersections", "-"]
            for extra, environment, status in (([], {}, 1), (["--key-file", mine], {}, 0), ([], {"TUBECUT_KEY": key}, 0)):
                done = subprocess.run([*command, *extra, *post], input=json.dumps(joint(60)), capture_output=True, text=True, timeout=60,
                                      env={**os.environ, **environment})
                self.assertEqual(done.returncode, status, done.stderr)


class Program(Case):
    def run_program(self, *arguments, text=""):
        command = [sys.executable, "-B", HERE / "tubecut.py", "--url", self.service.url, *arguments]
        return subprocess.run(command, input=text, capture_output=True, text=True, timeout=60)

    def test_document(self):
        gcode = ["post", "bevel-tables", EXAMPLES / "bevel-tables/source-000-table-1.json", "--format", "gcode"]
        done = self.run_program(*gcode, "--option", "speed_mm_min=600", "--option", "dialect=qtplasmac")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("G", done.stdout)
        done = self.run_program(*gcode, "--option", "speed_mm_min=600", "--option", "dialect=fanuc")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("?dialect: bad_choice one of linuxcnc|qtplasmac", done.stderr)
        self.assertEqual(self.run_program(*gcode[:3], "--option", "speed_mm_min=600").returncode, 2)
        given = {"speed_mm_min": "600", "dialect": "linuxcnc", "torch": "on", "axial": "z", "lead_mm": "3", "pivot_length_mm": "200",
                 "pierce_height_mm": "4", "pierce_delay_s": "0.5", "cut_height_mm": "1.5"}
        done = self.run_program(*gcode, *(word for name in given for word in ("--option", f"{name}={given[name]}")))
        self.assertEqual(done.returncode, 0, done.stderr)
        body = example("bevel-tables/source-000-table-1.json")
        self.assertEqual(done.stdout, self.client.document("bevel-tables", body, "gcode", **given).decode())
        wrong = set().union(*options_by_endpoint(self.client).values()) - {"view", "acknowledge", "material"}  # any text may be one of these
        done = self.run_program(*gcode, *(word for name in wrong for word in ("--option", f"{name}=never")))
        for name in wrong:
            self.assertIn(f"  ?{name}: ", done.stderr)

    def test_post(self):
        done = self.run_program("post", "bevel-tables", EXAMPLES / "bevel-tables/source-000-table-1.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        Answer.of(done.stdout)
        done = self.run_program("post", "intersections", "-", text=json.dumps(joint(200)))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("/cutters/0/inclination_deg", done.stderr)

    def test_frame(self):
        done = self.run_program("frame", EXAMPLES / "frames/bike-frame-with-mitres.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        head, *parts, summary = done.stdout.splitlines()
        rows = Answer.of(head).result["cut_list"]
        self.assertEqual(sorted(json.loads(p)["id"] for p in parts), sorted(row["part"] for row in rows))
        for part in parts:
            Answer.of(part[part.index('"body":') + 7:-1])
        self.assertEqual(json.loads(summary), {"summary": {"items": len(rows), "answered": len(rows), "refused": 0}})
        spoiled = example("frames/truss-of-19.json")
        spoiled["members"][2]["outer_diameter_mm"] = 120
        self.assertEqual(self.run_program("frame", "-", text=json.dumps(spoiled)).returncode, 1)
        done = self.run_program("frame", "-", text=json.dumps({**spoiled, "kerf_mm": -1}))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("/kerf_mm", done.stderr)
        self.assertEqual(self.run_program("frame", "-", text="{").returncode, 2)

    def test_batch(self):
        lines = [item.line().decode() for item in jobs(20)] + [BatchItem("bad", "intersections", joint(200)).line().decode()]
        done = self.run_program("batch", "-", text="".join(lines))
        self.assertEqual(done.returncode, 1, done.stderr)
        answers = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual(len({a["id"] for a in answers}), 21)
        self.assertEqual([a["status"] for a in answers if a["id"] == "bad"], [422])

    def test_batch_of_documents(self):
        table = example("bevel-tables/source-000-table-1.json")
        line = {"endpoint": "bevel-tables", "body": table}
        lines = [{"id": "json", **line}, {"id": "cut", **line, "format": "gcode", "options": {"speed_mm_min": 600, "dialect": "qtplasmac"}},
                 {"id": "solid", **line, "format": "stl", "options": {"view": "before"}}]
        done = self.run_program("batch", "-", text="".join(json.dumps(one) + "\n" for one in lines))
        self.assertEqual(done.returncode, 0, done.stderr)
        answers = {a["id"]: a for a in map(json.loads, done.stdout.splitlines())}
        self.assertEqual(answers["json"]["body"]["verdict"]["status"], "ok")
        program = self.client.document("bevel-tables", table, "gcode", job_id="cut", speed_mm_min=600, dialect="qtplasmac")
        self.assertEqual(answers["cut"], {"id": "cut", "status": 200, "media": "text/x-gcode", "document": program.decode()})
        solid = self.client.document("bevel-tables", table, "stl", job_id="solid", view="before")
        self.assertEqual(base64.b64decode(answers["solid"]["document_base64"]), solid)
        for wrong, told in (({"options": {"view": "template"}}, "options without a format"), ({"fromat": "csv"}, "unknown: fromat")):
            done = self.run_program("batch", "-", text=json.dumps({"id": "wrong", **line, **wrong}) + "\n")
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn("line 1: ValueError", done.stderr)
            self.assertIn(told, done.stderr)


if __name__ == "__main__":
    if "--server" not in sys.argv:
        sys.exit(__doc__)
    at = sys.argv.index("--server")
    BINARY = sys.argv[at + 1]
    del sys.argv[at:at + 2]
    unittest.main()
