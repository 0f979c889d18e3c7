"""check_settings takes the settings as shipped, and sees each combination that would cut a job off or have it computed twice."""

import json
import pathlib
import re
import shutil
import tempfile
import unittest
import unittest.mock

from tool import TOOLS, load, run_on_tree

check_settings = load("check_settings")
ROOT = TOOLS.parent
DOCKER = ROOT / "docker"
HAPROXY, COMPOSE = (DOCKER / name for name in ("haproxy.cfg", "compose.yaml"))
BASE, OVERLAY, INGRESS = ("kubernetes/base/deployment.yaml", "kubernetes/overlays/example/trusted-proxy.yaml",
                          "kubernetes/overlays/example/ingress.yaml")

# The rule, the file, a text of it, and its spoilt form. Everything else must pass as before.
SPOILT = [
    ("timeout", "haproxy.cfg", "timeout server 10s", "timeout server 8s"),
    ("timeout", "haproxy.cfg", "set-timeout server 130s", "set-timeout server 120s"),
    ("timeout", "haproxy.cfg", "acl long path /v1/batches /v1/frames /v1/mill-paths", "acl long path /v1/batches"),
    ("timeout", "haproxy.cfg", "acl long path /v1/batches", "acl long path"),
    ("timeout, drain", "compose.yaml", "TUBECUT_KEYS: /etc", 'TUBECUT_BUDGET_S: "33"\n  TUBECUT_KEYS: /etc'),
    ("timeout", INGRESS, "timeout-server: 130s", "timeout-server: 100s"),
    ("timeout", INGRESS, "    haproxy.org/timeout-server: 130s\n", ""),
    ("timeout, grace", OVERLAY, "env:", 'args: [--budget-s=60, --drain-s, "240"]\n          env:'),
    ("repeats", "haproxy.cfg", "retry-on conn-failure", "retry-on response-timeout conn-failure"),
    ("repeats", "haproxy.cfg", "empty-response 503", "empty-response 503 504"),
    ("repeats", INGRESS, "empty-response 503", "empty-response 503 all-retryable-errors"),
    ("alike", "compose.yaml", "TUBECUT_REPLICA: tubecut-2", 'TUBECUT_REPLICA: tubecut-2, TUBECUT_BUDGET_S: "1.5"'),
    ("drain", "compose.yaml", 'TUBECUT_DRAIN_DELAY_S: "0.6"', 'TUBECUT_DRAIN_DELAY_S: "0.6"\n  TUBECUT_DRAIN_S: "5"'),
    ("drain", BASE, 'value: "8"', 'value: "7"'),
    ("drain", OVERLAY, "env:", "args: [--drain-s, '2']\n          env:"),
    ("grace", "compose.yaml", "stop_grace_period: 15s", "stop_grace_period: 13s"),
    ("grace", "compose.yaml", "stop_grace_period: 15s", "init: true"),
    ("grace", BASE, "terminationGracePeriodSeconds: 30", "terminationGracePeriodSeconds: 17"),
    ("grace", OVERLAY, "          env:\n", "          env:\n            - {name: TUBECUT_DRAIN_S, value: '21'}\n"),
    ("delay", "compose.yaml", '"0.6"', '"0.4"'),
    ("delay", "haproxy.cfg", "inter 200ms", "inter 1s"),
    ("delay", "haproxy.cfg", "fall 1", "fall 2"),
    ("delay", BASE, 'value: "5"', 'value: "1"'),
    ("reuse", "haproxy.cfg", "pool-purge-delay 5s", "pool-purge-delay 15s"),
    ("reuse", "compose.yaml", "TUBECUT_KEYS: /etc", 'TUBECUT_IDLE_S: "5"\n  TUBECUT_KEYS: /etc'),
    ("proxy's stop", "haproxy.cfg", "hard-stop-after 30s", "hard-stop-after 9s"),
    ("proxy's stop", "compose.yaml", "stop_grace_period: 35s", "stop_grace_period: 30s"),
]
# Both sides changed together.
SOUND = [
    [("compose.yaml", "TUBECUT_KEYS: /etc", 'TUBECUT_BUDGET_S: "1"\n  TUBECUT_KEYS: /etc'),
     ("compose.yaml", 'TUBECUT_DRAIN_DELAY_S: "0.6"', 'TUBECUT_DRAIN_DELAY_S: "0.6"\n  TUBECUT_DRAIN_S: "4"')],
    [("haproxy.cfg", "timeout server 10s", "timeout server 300s"), ("haproxy.cfg", "set-timeout server 130s", "set-timeout server 5m"),
     ("haproxy.cfg", "hard-stop-after 30s", "hard-stop-after 5m"), ("compose.yaml", "stop_grace_period: 35s", "stop_grace_period: 5m30s"),
     ("compose.yaml", "TUBECUT_KEYS: /etc", 'TUBECUT_BUDGET_S: "60"\n  TUBECUT_DRAIN_S: "240"\n  TUBECUT_KEYS: /etc'),
     ("compose.yaml", "stop_grace_period: 15s", "stop_grace_period: 4m10s")],
]


class CheckSettings(unittest.TestCase):
    def found(self, changes, limits=None, clients=None):
        """The lines for a copy of docker/ with these changes."""
        with tempfile.TemporaryDirectory() as folder:
            there = pathlib.Path(folder, "docker")
            shutil.copytree(DOCKER, there)
            for file, old, new in changes:
                text = (there / file).read_text()
                self.assertIn(old, text, file)
                (there / file).write_text(text.replace(old, new))
            return list(check_settings.problems((there / "haproxy.cfg").read_text(), (there / "compose.yaml").read_text(), there / "kubernetes",
                                                limits or check_settings.default_walls(), clients or {}))

    def test_as_shipped(self):
        self.assertEqual(run_on_tree({}, "check_settings")[0], 0)

    def test_each_wrong_value_is_seen_and_no_other(self):
        for rule, *change in SPOILT:
            with self.subTest(rule=rule, change=change):
                self.assertEqual({line.partition(":")[0] for line in self.found([change])}, set(rule.split(", ")))

    def test_what_is_changed_on_both_sides_is_sound(self):
        for changes in SOUND:
            self.assertEqual(self.found(changes), [])
        for one, left_out in enumerate(changes):
            if "BUDGET" not in left_out[2]:  # longer waits are sound with any budget
                self.assertNotEqual(self.found(changes[:one] + changes[one + 1:]), [], f"without {left_out}")

    def test_a_client_waits_for_the_longest_job(self):
        self.assertEqual(self.found([], clients={"a client": 121.0}), [])
        self.assertEqual(len(self.found([], clients={"a client": 120.0})), 1)
        self.assertGreater(check_settings.clients_of(ROOT)["the Python client's timeout_s"], max(check_settings.default_walls().values()))

    def test_the_budgets_of_a_running_service(self):
        """Of an older one, or a site's own: an endpoint that takes longer than the proxy knows."""
        walls = check_settings.default_walls()
        budgets = {"budgets": {e: {"cpu_s": w / 4, "wall_s": w} for e, w in walls.items() if e != "batches"}}
        self.assertEqual(check_settings.walls_of(budgets), walls)
        budgets["budgets"]["holes"]["wall_s"] = 40
        status, said = run_on_tree({"limits.json": json.dumps(budgets)}, "check_settings", "--limits", "ROOT")
        self.assertEqual(status, 1, said)  # a folder is no answer
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "limits.json")
            file.write_text(json.dumps(budgets))
            status, said = run_on_tree({}, "check_settings", "--limits", str(file))
        self.assertEqual(status, 1)
        self.assertIn("timeout: HAProxy waits 10 s for holes", said)

    def test_durations(self):
        for text, value in (("200ms", 0.2), ("10s", 10), ("1m30s", 90), ("5", 5), (7, 7), ("1.5", 1.5), ("1h", 3600)):
            self.assertAlmostEqual(check_settings.seconds(text), value)

    def test_variables_of_compose(self):
        with unittest.mock.patch.dict("os.environ", A="1", B=""):
            self.assertEqual(check_settings.expanded("${A} ${A:-2} ${B:-2} ${C:-} ${C:?must be} ${A:?x}"), "1 1 2   1")

    def test_the_manual_has_a_row_for_each_rule(self):
        manual = (ROOT / "docs/operations.md").read_text()
        chapter = re.search(r"^## Settings that belong together\n(.*?)^## ", manual, re.M | re.S)[1]
        rows = set(re.findall(r"^\| `([^`]+)` \|", chapter, re.M))
        code = (TOOLS / "check_settings").read_text()
        rules = set(re.findall(r'f?"([a-z\' ]+): ', code[code.index("def stop_problems"):code.index("def read_limits")]))
        self.assertEqual(rows, rules)
        self.assertEqual({rule for rules, *_ in SPOILT for rule in rules.split(", ")} | {"client"}, rules)


if __name__ == "__main__":
    unittest.main()
