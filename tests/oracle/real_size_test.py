"""A cut of real size through the service, and its CBOR read by a decoder that is not ours: `real_size_test.py SERVER`.

Source 002's scale: a tube of 2 000 x 50 mm on a chord of 2 400 mm at 300 mm/min, some 21 minutes of cut, on a crawler."""

import http.client
import json
import os
import re
import subprocess
import sys
import unittest

import cbor2
import numpy as np

SERVER = None
TYPED = {77: "<i2", 78: "<i4"}  # RFC 8746: sint16 and sint32, little endian


def axis(name, unit, v, a, j):
    return {"name": name, "unit": unit, "pulses_per_unit": 1000, "v_max": v, "a_max": a, "j_max": j, "n_max": 800}


def job(period_us):
    return {"cut": {"target": {"outer_diameter_mm": 2000, "wall_mm": 50},
                    "cutters": [{"kind": "tube", "outer_diameter_mm": 2400, "inclination_deg": 90, "clocking_deg": 0, "offset_mm": 0}],
                    "sampling": {"tolerance_mm": 0.05}, "root_surface": "inner", "groove": {"rule": "half_dihedral", "cap_deg": 45},
                    "contact": "inner", "kerf_mm": 0,
                    "smoothing": {"method": "envelope", "limits": {"max_slope_deg_per_mm": 2, "max_curvature_deg_per_mm2": 0.5}}},
            "machine": {"type": "crawler", "period_us": period_us, "b_positive": "outer_edge_into_part", "wheel_offset_mm": 60,
                        "swing_center": "remote", "axes": [axis("S", "mm", 50, 200, 4000), axis("E", "mm", 100, 500, 10000),
                                                           axis("B", "deg", 45, 300, 6000)]},
            "motion": {"speed": {"mm_min": 300}}}


def counts(item):
    """A column as cbor2 leaves it: a typed array under its tag."""
    return np.frombuffer(item.value, dtype=TYPED[item.tag])


class Service:
    def __enter__(self):
        self.child = subprocess.Popen([SERVER, "--port", "0", "--admin-port", "0", "--budget-s", "300"], stdout=subprocess.PIPE, text=True)
        self.port = json.loads(self.child.stdout.readline())["port"]
        return self

    def __exit__(self, *_):
        self.child.terminate()
        self.child.communicate()

    def post(self, body, accept):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=600)
        begin = self.cpu_ms()
        connection.request("POST", "/v1/pulse-schedules", json.dumps(body), {"Content-Type": "application/json", "Accept": accept})
        reply = connection.getresponse()
        data = reply.read()
        connection.close()
        return reply.status, data, self.cpu_ms() - begin, reply.getheader("Server-Timing")

    def cpu_ms(self):
        """Of the service: what the job costs whatever else the machine does."""
        with open(f"/proc/{self.child.pid}/stat", encoding="ascii") as file:
            user, system = file.read().rsplit(")", 1)[1].split()[11:13]
        return 1e3 * (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def peak_mib(self):
        with open(f"/proc/{self.child.pid}/status", encoding="ascii") as file:
            status = file.read()
        return int(re.search(r"VmHWM:\s+(\d+)", status)[1]) / 1024


class RealSize(unittest.TestCase):
    def show(self, what, status, data, ms, timing, peak):
        self.assertEqual(status, 200, data[:500])
        print(f"{what}: {len(data)} bytes, {ms:.0f} ms of CPU ({timing}), peak {peak:.0f} MiB")

    def test_at_4_ms_in_json_and_cbor_alike(self):
        with Service() as service:
            first = service.post(job(4000), "application/json")
            self.show("4 ms, JSON", *first, service.peak_mib())
            second = service.post(job(4000), "application/cbor")
            self.show("4 ms, CBOR", *second, service.peak_mib())
        plain, packed = json.loads(first[1])["result"], cbor2.loads(second[1])["result"]
        self.cut_of_21_minutes(plain)
        self.assertEqual(plain["periods"], packed["periods"])
        self.assertEqual(set(plain["counts"]), set(packed["counts"]))
        for name, column in plain["counts"].items():
            self.assertEqual(counts(packed["counts"][name]).tolist(), column, name)
        self.assertEqual(plain["report"], packed["report"])

    def test_at_1_ms_in_cbor(self):
        with Service() as service:
            idle = service.peak_mib()
            refused = service.post(job(1000), "application/json")
            self.assertEqual((refused[0], json.loads(refused[1])["code"]), (422, "too_many_periods"))
            before = service.peak_mib() - idle
            answer = service.post(job(1000), "application/cbor")
            self.show("1 ms, CBOR", *answer, service.peak_mib())
            after = service.peak_mib() - idle
            print(f"1 ms, JSON: refused with {before:.0f} MiB more, CBOR took {after:.0f}")
            self.assertLess(before, 0.5 * after)  # before the periods took memory
        result = cbor2.loads(answer[1])["result"]
        self.cut_of_21_minutes(result)
        for name, column in result["counts"].items():
            column = counts(column)
            self.assertEqual(len(column), result["periods"], name)
            self.assertEqual(int(column.sum(dtype=np.int64)), result["total"][name], name)
            self.assertEqual(int(np.abs(column).max()), result["report"]["peak"][name], name)

    def cut_of_21_minutes(self, result):
        self.assertAlmostEqual(result["report"]["time_s"] / 60, 21, delta=3)
        self.assertEqual(result["report"]["stretch"], 1)
        self.assertEqual(result["report"]["slow"], [])

    def test_a_value_that_does_not_fit_16_bits_is_sent_in_32(self):
        body = job(20000)
        body["machine"]["axes"][0].update(pulses_per_unit=1e6, n_max=None)
        with Service() as service:
            status, data, _, _ = service.post(body, "application/cbor")
        self.assertEqual(status, 200, data[:500])
        result = cbor2.loads(data)["result"]
        self.assertEqual({name: column.tag for name, column in result["counts"].items()}, {"S": 78, "E": 77, "B": 77})
        self.assertEqual(int(counts(result["counts"]["S"]).sum(dtype=np.int64)), result["total"]["S"])


if __name__ == "__main__":
    SERVER = sys.argv.pop(1)
    unittest.main()
