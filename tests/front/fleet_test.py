#!/usr/bin/env python3
"""Replicas of two engines and of two machine folders behind the shipped proxy: fleet_test.py SERVER NEXT, where NEXT is the service with
other numerics. What is pinned is answered by who has it, though the fleet changes under load; what nobody has is refused."""

import contextlib
import copy
import json
import os
import pathlib
import signal
import sys
import tempfile
import threading
import unittest
import unittest.mock

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))

from front_test import ROOT, load, restarts  # noqa: E402

SERVER = NEXT = ""
tubecut = load(ROOT / "clients/python/tubecut.py")


def example(endpoint, name):
    return json.loads((ROOT / "examples" / endpoint / f"{name}.json").read_text())


@contextlib.contextmanager
def fleet(engines, *options):
    """(replicas, url) of a replica of each engine behind the proxy, the certificate trusted."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with unittest.mock.patch.object(restarts.Replica, "options", list(options)), \
                restarts.everything(SERVER, folder, running=0) as (replicas, proxy), \
                unittest.mock.patch.dict(os.environ, SSL_CERT_FILE=f"{folder}/certificate.pem"):
            for replica, engine in zip(replicas, engines):
                become(replica, engine, proxy)
            yield replicas, proxy


def become(replica, engine, proxy):
    """Starts the replica as that engine, and waits until the proxy sees it."""
    replica.command[0] = engine
    replica.start()
    restarts.until(lambda: proxy.up(replica.name), 20, f"{replica.name} seen ready by the proxy")


class Ports(unittest.TestCase):
    def test_a_replica_that_begins_again_finds_its_port_free(self):
        """No client was given it meanwhile."""
        lowest = int(pathlib.Path("/proc/sys/net/ipv4/ip_local_port_range").read_text().split()[0])
        ports = restarts.free_ports(50)
        self.assertEqual(len(set(ports)), 50)
        self.assertLess(max(ports), lowest)


class Numerics(unittest.TestCase):
    JOB = example("intersections", "two-tubes-by-axis")

    def numerics(self, engine):
        with fleet([engine]) as (_, proxy):
            return tubecut.Client(f"https://127.0.0.1:{proxy.port}").version()["numerics"]

    def setUp(self):
        self.old, self.new = self.numerics(SERVER), self.numerics(NEXT)
        self.assertNotEqual(self.old, self.new)

    def test_a_pinned_job_finds_its_engine(self):
        with fleet([SERVER, NEXT, NEXT]) as (_, proxy):
            client = tubecut.Client(f"https://127.0.0.1:{proxy.port}")
            for pin in (self.old, self.new) * 10:
                self.assertEqual(client.intersections({**self.JOB, "numerics": pin}).job["numerics"], pin)
            self.assertEqual({client.intersections(self.JOB).job["numerics"] for _ in range(9)}, {self.old, self.new})  # who answered is seen
            with self.assertRaises(tubecut.ProblemError) as refused:
                client.intersections({**self.JOB, "numerics": 77})
            self.assertEqual(refused.exception.problem.code, "numerics_mismatch")

    def test_and_where_the_client_knows_the_replicas(self):
        with fleet([SERVER, NEXT]) as (replicas, _):
            client = tubecut.Client(*[f"http://127.0.0.1:{r.port}" for r in replicas[:2]])
            for pin in (self.old, self.new) * 5:
                self.assertEqual(client.intersections({**self.JOB, "numerics": pin}).job["numerics"], pin)

    def test_a_pinned_batch_is_of_one_engine(self):
        with fleet([SERVER, NEXT, SERVER]) as (_, proxy):
            client = tubecut.Client(f"https://127.0.0.1:{proxy.port}")
            for pin in (self.old, self.new):
                items = [tubecut.BatchItem(f"job {i}", "intersections", {**self.JOB, "numerics": pin}) for i in range(200)]
                results = list(client.batch(items))
                self.assertEqual(sorted(r.id for r in results), sorted(i.id for i in items))
                self.assertEqual({r.unwrap().job["numerics"] for r in results}, {pin})
            nobody = [tubecut.BatchItem(f"job {i}", "intersections", {**self.JOB, "numerics": 77}) for i in range(50)]
            self.assertEqual([r.problem.code for r in client.batch(nobody)], ["numerics_mismatch"] * 50)

    def test_none_is_lost_while_the_fleet_changes(self):
        """Replica by replica to the next engine and back under load: the last of each stays until there is another."""
        with fleet([SERVER, SERVER, NEXT]) as (replicas, proxy):
            client, stop = tubecut.Client(f"https://127.0.0.1:{proxy.port}"), threading.Event()
            answered, wrong = {self.old: 0, self.new: 0}, []

            def ask(pin):
                while not stop.is_set():
                    try:
                        numerics = client.intersections({**self.JOB, "numerics": pin}).job["numerics"]
                    except tubecut.TubecutError as failed:
                        wrong.append(failed)
                        continue
                    answered[pin] += 1
                    if numerics != pin:
                        wrong.append(numerics)

            clients = [threading.Thread(target=ask, args=(pin,)) for pin in (self.old, self.new) for _ in range(2)]
            for one in clients:
                one.start()
            try:
                for replica, engine in ((0, NEXT), (0, SERVER), (1, NEXT), (1, SERVER)):
                    self.assertEqual(replicas[replica].end(signal.SIGTERM), 0)
                    become(replicas[replica], engine, proxy)
            finally:
                stop.set()
                for one in clients:
                    one.join()
            self.assertEqual(wrong, [])
            self.assertGreater(min(answered.values()), 20, answered)
            print(f"{answered} pinned jobs answered while two replicas changed twice", file=sys.stderr)


class Machines(unittest.TestCase):
    def test_a_pinned_machine_is_found(self):
        job = example("pulse-schedules", "square-cut-from-a-bare-contour")
        with tempfile.TemporaryDirectory() as name:
            folders = [pathlib.Path(name) / side for side in ("a", "b")]
            with fleet([SERVER]) as (_, proxy):
                client = tubecut.Client(f"https://127.0.0.1:{proxy.port}")
                cell = copy.deepcopy(next(m["machine"] for m in client.catalogue("machines")["machines"] if m["machine"]["type"] == "five_axis_cutter"))
            for folder, pivot in zip(folders, (150.0, 151.0)):
                folder.mkdir()
                (folder / "cell.json").write_text(json.dumps({**cell, "name": "cell-7", "pivot_length_mm": pivot}))
            with fleet([]) as (replicas, proxy):
                for replica, folder in zip(replicas, folders):
                    replica.command += ["--machines", str(folder)]
                    become(replica, SERVER, proxy)
                alone = [tubecut.Client(f"http://127.0.0.1:{r.port}").pulse_schedules({**job, "machine": "cell-7"}) for r in replicas[:2]]
                pins = [answer.request["machine_sha256"] for answer in alone]
                self.assertNotEqual(*pins)
                client = tubecut.Client(f"https://127.0.0.1:{proxy.port}")
                for pin, answer in list(zip(pins, alone)) * 4:
                    found = client.pulse_schedules({**job, "machine": "cell-7", "machine_sha256": pin})
                    self.assertEqual(found.job["result_sha256"], answer.job["result_sha256"])


if __name__ == "__main__":
    SERVER, NEXT = [str(pathlib.Path(p).resolve()) for p in sys.argv[1:3]]
    del sys.argv[1:3]
    unittest.main(verbosity=2)
