#!/usr/bin/env python3
"""What watches the service: the scrape configurations, the alerts by the labels that these give, the dashboard.   monitoring_test.py SERVER"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import urllib.request

import yaml

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import alarms  # noqa: E402
import front_test  # noqa: E402
from alarms import promtool  # noqa: E402
from front_test import ask, DOCKER, ROOT  # noqa: E402

BASE, MONITORING = DOCKER / "kubernetes/base", DOCKER / "kubernetes/monitoring"
RULES, TRIED = DOCKER / "prometheus-rules.yml", ROOT / "tests/front/prometheus-rules-test.yml"


def served_series(begun=lambda name: True):
    """What a replica serves from its start, of those `begun` what it serves after requests too, and what HAProxy does: (name, labels)."""
    def scraped(port):
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics") as answer:
            return [s for line in answer.read().decode().splitlines() for s in series(line) if line[0] != "#"]

    with tempfile.TemporaryDirectory() as folder, front_test.restarts.everything(front_test.SERVER, pathlib.Path(folder), running=1) as (replicas, proxy):
        admin_port = re.findall(r"--admin-port (\d+)", " ".join(replicas[0].command))[0]
        fresh = scraped(admin_port)
        for body in (b"{}", (ROOT / "examples/bevel-tables/source-000-table-1.json").read_bytes()):
            ask(f"https://127.0.0.1:{proxy.port}", body=body)
        return fresh + [s for s in scraped(admin_port) if begun(s[0])] + scraped(proxy.stats_port)


def labels(text):
    return dict(re.findall(r'(\w+)="(.*?)"', text))


def series(text):
    """(name, {label: value}) of what is ours or HAProxy's."""
    for name, of in re.findall(r"\b(?<!:)((?:tubecut|http_server|process|haproxy)_\w+)\b(?!:)(?:{(.*?)})?", text):
        yield name, labels(of)


def read(path):
    return yaml.safe_load(path.read_text())


def relabelled(target, steps):
    """The labels of a target by the steps of a scrape configuration, its own (snake case) or the operator's; none when it is dropped.
    Source  prometheus.io, Configuration, relabel_config."""
    target = dict(target)
    for step in steps:
        of = lambda name, default: step.get(name, step.get(re.sub(r"_(\w)", lambda m: m[1].upper(), name), default))
        value = of("separator", ";").join(target.get(name, "") for name in of("source_labels", []))
        regex, action = f"^(?:{of('regex', '(.*)')})$", of("action", "replace")
        if action == "labeldrop":
            target = {name: v for name, v in target.items() if not re.match(regex, name)}
        elif action in ("keep", "drop"):
            if bool(re.match(regex, value)) != (action == "keep"):
                return None
        elif action == "replace":
            if found := re.match(regex, value):
                target[of("target_label", "")] = found.expand(re.sub(r"\$\{?(\d)\}?", r"\\\1", of("replacement", "$1")))
        else:
            raise ValueError(action)
    return {name: v for name, v in target.items() if not name.startswith("__")}


def of_compose():
    """{job: labels of a target}"""
    out = {}
    for job in read(DOCKER / "prometheus.yml")["scrape_configs"]:
        address = job["static_configs"][0]["targets"][0]
        start = {"__address__": address, "instance": address, "job": job["job_name"]}
        out[job["job_name"]] = relabelled(start, job.get("relabel_configs", []))
    return out


def pod(container_port):
    """What service discovery knows of a pod of the deployment, for one of its ports."""
    template = read(BASE / "deployment.yaml")["spec"]["template"]
    meta = {"namespace": "tubecut", "pod_name": "tubecut-5d9-x7x2q", "pod_phase": "Running", "pod_container_name": "tubecut",
            "pod_container_port_name": container_port["name"]}
    meta |= {"pod_label_" + re.sub(r"\W", "_", name): value for name, value in template["metadata"]["labels"].items()}
    meta |= {"pod_annotation_" + re.sub(r"\W", "_", name): value for name, value in template["metadata"].get("annotations", {}).items()}
    address = f"10.244.1.7:{container_port['containerPort']}"
    return {"__address__": address, "instance": address} | {"__meta_kubernetes_" + name: value for name, value in meta.items()}


def ports():
    return read(BASE / "deployment.yaml")["spec"]["template"]["spec"]["containers"][0]["ports"]


def of_operator():
    """Labels of the targets of the PodMonitor: what the operator sets (its generated configuration), then our own steps."""
    monitor = read(MONITORING / "podmonitor.yaml")
    (endpoint,) = monitor["spec"]["podMetricsEndpoints"]
    label = "__meta_kubernetes_pod_label_" + re.sub(r"\W", "_", monitor["spec"].get("jobLabel", "none"))
    steps = [
        {"action": "keep", "source_labels": ["__meta_kubernetes_pod_container_port_name"], "regex": endpoint["port"]},
        {"source_labels": ["__meta_kubernetes_namespace"], "target_label": "namespace"},
        {"source_labels": ["__meta_kubernetes_pod_container_name"], "target_label": "container"},
        {"source_labels": ["__meta_kubernetes_pod_name"], "target_label": "pod"},
        {"target_label": "job", "replacement": f"tubecut/{monitor['metadata']['name']}"},
        {"source_labels": [label], "target_label": "job", "regex": "(.+)"},
        {"target_label": "endpoint", "replacement": endpoint["port"]},
    ]
    return [found for port in ports() if (found := relabelled(pod(port), steps + endpoint.get("relabelings", [])))]


def of_cluster():
    """Those of docker/prometheus-kubernetes.yml."""
    (job,) = read(DOCKER / "prometheus-kubernetes.yml")["scrape_configs"]
    found = [relabelled(pod(port) | {"job": job["job_name"]}, job["relabel_configs"]) for port in ports()]
    return [target for target in found if target]


def fired(target):
    """The alerts of the rules when everything goes wrong, with the series of the replicas by these labels."""
    tests = read(TRIED)
    loud = next(t for t in tests["tests"] if t["name"] == "everything goes wrong")
    for one in loud["input_series"]:
        replica = re.search(r'job="tubecut",instance="(\w)"', one["series"])
        if replica:
            told = ",".join(f'{name}="{value}{replica[1] if name in ("instance", "pod") else ""}"' for name, value in target.items())
            one["series"] = one["series"].replace(replica[0], told)
    names = [s["labels"] for s in loud["promql_expr_test"][1]["exp_samples"]]
    loud["promql_expr_test"] = [{"expr": f'count(ALERTS{{alertstate="firing",alertname={re.search(chr(34) + "(.*)" + chr(34), n)[0]}}}) or vector(0)',
                                 "eval_time": "40m", "exp_samples": [{"labels": "{}", "value": -1}]} for n in names]
    with tempfile.NamedTemporaryFile("w", suffix=".yml") as file:
        yaml.safe_dump({"rule_files": [str(RULES)], "evaluation_interval": "15s", "tests": [loud]}, file)
        file.flush()
        done = subprocess.run([promtool(), "test", "rules", file.name], capture_output=True, text=True)
    # promtool names the value that it saw instead of -1.
    seen = dict(re.findall(r'alertname=\\?"(\w+)\\?".*?got:.*?(\d+)', done.stdout + done.stderr, re.S))
    assert len(seen) == len(names), done.stdout + done.stderr
    return {name for name, count in seen.items() if int(count) > 0}


class Scraping(unittest.TestCase):
    def test_promtool_reads_the_configurations(self):
        subprocess.run([promtool(), "check", "config", DOCKER / "prometheus.yml"], check=True, stdout=subprocess.DEVNULL)
        # Debian's promtool knows no clusters, so the rest of that one.
        text = (DOCKER / "prometheus-kubernetes.yml").read_text()
        plain, count = re.subn(r"    kubernetes_sd_configs:\n(      .*\n)+", "    static_configs: [{targets: [a:1]}]\n", text)
        self.assertEqual(count, 1)
        with tempfile.NamedTemporaryFile("w", suffix=".yml", dir=DOCKER) as file:
            file.write(plain)
            file.flush()
            subprocess.run([promtool(), "check", "config", file.name], check=True, stdout=subprocess.DEVNULL)

    def test_each_target_of_compose_is_there(self):
        compose, beside = (read(DOCKER / name)["services"] for name in ("compose.yaml", "compose.monitoring.yaml"))
        self.assertIn("inside", beside["prometheus"]["networks"])
        self.assertTrue(all(port.startswith("127.0.0.1:") for port in beside["prometheus"]["ports"]))
        targets = {job["job_name"]: job["static_configs"][0]["targets"] for job in read(DOCKER / "prometheus.yml")["scrape_configs"]}
        self.assertEqual(targets["tubecut"], [f"{name}:9090" for name in compose if name.startswith("tubecut-")])
        (stats,) = targets["tubecut-haproxy"]
        self.assertEqual(beside["haproxy"]["environment"]["TUBECUT_STATS"], ":" + stats.removeprefix("haproxy:"))
        for name in ("tubecut-1", "haproxy"):
            self.assertIn("inside", compose[name]["networks"])
        self.assertEqual(of_compose()["tubecut"]["instance"], compose["tubecut-1"]["environment"]["TUBECUT_REPLICA"])

    def test_one_target_a_pod(self):
        monitor = read(MONITORING / "podmonitor.yaml")
        self.assertEqual(monitor["spec"]["selector"]["matchLabels"], read(BASE / "deployment.yaml")["spec"]["template"]["metadata"]["labels"])
        for found in (of_operator(), of_cluster()):
            self.assertEqual([(t["job"], t["instance"]) for t in found], [("tubecut", "tubecut-5d9-x7x2q")])

    def test_no_label_of_a_target_is_one_of_the_service(self):
        """Prometheus would rename the service's: exported_endpoint."""
        served = {label for _, of in served_series() for label in of}
        self.assertLessEqual({"endpoint", "code", "reason", "http_route"}, served)
        for target in (*of_compose().values(), *of_operator(), *of_cluster()):
            self.assertEqual(target.keys() & served, set())

    def test_alerts_fire_as_scraped(self):
        alerts = {r["alert"] for g in read(RULES)["groups"] for r in g["rules"] if "alert" in r}
        for target in (of_compose()["tubecut"], *of_operator(), *of_cluster()):
            with self.subTest(**target):
                self.assertEqual(fired(target), alerts)
        # As it is where pods are scraped by their annotations.
        lost = alerts - fired({"job": "kubernetes-pods", "instance": "10.244.1.7:9090"})
        self.assertLessEqual({"TubecutDown", "TubecutBusy"}, lost)

    def test_haproxy_is_the_job_the_dashboard_asks_for(self):
        self.assertEqual(set(of_compose()), {"tubecut", "tubecut-haproxy"})

    def test_the_operator_has_the_same_rules(self):
        subprocess.run([MONITORING / "make", "--check"], check=True)
        self.assertEqual(read(MONITORING / "rules.yaml")["spec"], read(RULES))


class Dashboard(unittest.TestCase):
    FILE = json.loads((DOCKER / "grafana-dashboard.json").read_text())
    VARIABLES = {"$__rate_interval": "5m", "$instance": ".*"}

    def expressions(self):
        for panel in self.FILE["panels"]:
            for target in panel["targets"]:
                expression = target["expr"]
                for name, value in self.VARIABLES.items():
                    expression = expression.replace(name, value)
                yield panel["title"], expression, target["legendFormat"]

    def test_is_one_that_grafana_takes(self):
        d = self.FILE
        self.assertLessEqual({"uid", "title", "schemaVersion", "panels", "templating", "time"}, d.keys())
        self.assertRegex(d["uid"], r"^[A-Za-z0-9_-]{1,40}$")
        self.assertNotIn("id", d)  # of one installation
        variables = {v["name"] for v in d["templating"]["list"]}
        used = set(re.findall(r"\$\{?(\w+)\}?", json.dumps(d["panels"])))
        self.assertEqual(used - {"__rate_interval"}, variables)
        ids, taken = [p["id"] for p in d["panels"]], set()
        self.assertEqual(len(set(ids)), len(ids))
        self.assertGreater(len(ids), 15)
        for p in d["panels"]:
            with self.subTest(p["title"]):
                self.assertIn(p["type"], ("stat", "timeseries"))
                g = p["gridPos"]
                cells = {(x, y) for x in range(g["x"], g["x"] + g["w"]) for y in range(g["y"], g["y"] + g["h"])}
                self.assertLessEqual(g["x"] + g["w"], 24)
                self.assertEqual(cells & taken, set())
                taken |= cells
                self.assertIn(p["fieldConfig"]["defaults"]["unit"], ("short", "reqps", "ops", "percentunit", "s", "bytes"))
                self.assertEqual(len({t["refId"] for t in p["targets"]}), len(p["targets"]))
                for t in p["targets"]:
                    self.assertEqual(t["datasource"], {"type": "prometheus", "uid": "${datasource}"})
        self.assertEqual(len(taken), 24 * (1 + max(y for _, y in taken)), "holes")

    def test_promtool_reads_every_expression(self):
        rules = [{"record": f"panel:{i}", "expr": expression} for i, (_, expression, _) in enumerate(self.expressions())]
        self.assertGreater(len(rules), 20)
        with tempfile.NamedTemporaryFile("w", suffix=".yml") as file:
            yaml.safe_dump({"groups": [{"name": "dashboard", "rules": [dict(r, record=re.sub(r"\d+", lambda m: "x" * (1 + int(m[0])), r["record"]))
                                                                       for r in rules]}]}, file)
            file.flush()
            done = subprocess.run([promtool(), "check", "rules", file.name], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_every_expression_has_data(self):
        """Of a fleet that has answered and refused."""
        asked = [expression for _, expression, _ in self.expressions()]
        with tempfile.TemporaryDirectory() as folder, front_test.restarts.everything(front_test.SERVER, pathlib.Path(folder)) as (replicas, proxy):
            targets = {("tubecut", r.name): f"http://127.0.0.1:{r.command[r.command.index('--admin-port') + 1]}/metrics" for r in replicas}
            targets["tubecut-haproxy", "haproxy"] = f"http://127.0.0.1:{proxy.stats_port}/metrics"
            record = alarms.Record(targets, alarms.words(asked))
            for step in range(6):
                for body in (b"{}", (ROOT / "examples/intersections/source-000-table-1.json").read_bytes()) * 3:
                    ask(f"https://127.0.0.1:{proxy.port}", "/v1/intersections", body)
                record.scrape()
        self.assertGreater(len(asked), 20)
        for expression, values in zip(asked, record.values((one, 5) for one in asked)):
            with self.subTest(expression=expression):
                self.assertTrue(values)
                self.assertTrue(all(value == value for value in values.values()), values)  # not NaN

    def test_asks_for_series_there_are(self):
        served = served_series()
        names = {name for name, _ in served}
        jobs = of_compose()
        queries = [v["query"]["query"] for v in self.FILE["templating"]["list"] if v["type"] == "query"]
        told = [*self.expressions(), *(("variable", q, "") for q in queries)]
        for title, expression, legend in told:
            with self.subTest(title, expression=expression):
                asked = list(series(expression))
                words = set(re.findall(r"(?<![\w$\"])[a-z]\w*_\w+(?=[{\[])", expression))
                self.assertEqual(words, {name for name, _ in asked})  # no metric that `series` does not know
                self.assertTrue(asked or "up{" in expression)
                for name, wanted in asked:
                    self.assertIn(name, names)
                    job = wanted.pop("job")
                    self.assertEqual(job, "tubecut-haproxy" if name.startswith("haproxy") else "tubecut")
                    matching = [of for n, of in served if n == name and wanted.items() <= of.items()]
                    self.assertTrue(matching, f"{name}{wanted}")
                    known = set().union(*matching) | jobs[job].keys()
                    grouped = {label for group in re.findall(r"by \((.*?)\)", expression) for label in group.split(", ")}
                    self.assertLessEqual(grouped, known)
                    self.assertLessEqual(set(re.findall(r"(\w+)!?=~?\"", expression)) - {"job"}, known)
                shown = set(re.findall(r"{{(\w+)}}", legend))
                outer = re.search(r"by \((.*?)\)", expression)
                self.assertLessEqual(shown, set(outer[1].split(", ")) if outer else set())


class Alerts(unittest.TestCase):
    def test_promtool_reads_them(self):
        subprocess.run([promtool(), "check", "rules", RULES], check=True, stdout=subprocess.DEVNULL)

    def test_each_says_what_to_do(self):
        for rule in (r for g in yaml.safe_load(RULES.read_text())["groups"] for r in g["rules"] if "alert" in r):
            self.assertEqual(rule["annotations"].keys(), {"summary", "description"}, rule["alert"])

    def test_each_fires_and_is_silent(self):
        subprocess.run([promtool(), "test", "rules", TRIED], check=True, stdout=subprocess.DEVNULL)
        alerts = {r["alert"] for g in yaml.safe_load(RULES.read_text())["groups"] for r in g["rules"] if "alert" in r}
        quiet, loud, _ = yaml.safe_load(TRIED.read_text())["tests"]
        self.assertEqual({t["alertname"] for t in quiet["alert_rule_test"]}, alerts)
        fired = {re.search(r'"(\w+)"', s["labels"])[1] for s in loud["promql_expr_test"][1]["exp_samples"]}
        self.assertEqual(fired, alerts)

    def test_they_ask_for_series_there_are(self):
        rules = [r for g in yaml.safe_load(RULES.read_text())["groups"] for r in g["rules"]]
        recorded = {r["record"]: next(series(r["expr"])) for r in rules if "record" in r}
        asked = [s for r in rules for s in series(r["expr"])]
        for r in rules:
            for name, text in re.findall(r"\b(\w+:[\w:]+)(?:{(.*?)})?", r["expr"]):
                asked.append((recorded[name][0], recorded[name][1] | labels(text)))
        self.assertGreater(len({name for name, _ in asked}), 10)
        self.assertEqual(labels('a="1",b="x"'), {"a": "1", "b": "x"})

        # A failure is counted from a zero that was there before it; only the times of requests begin with requests.
        served = served_series(lambda name: name.startswith("http_server_request_duration_seconds"))
        for name, wanted in asked:
            wanted = {label: value for label, value in wanted.items() if label != "job"}
            self.assertTrue(any(n == name and wanted.items() <= l.items() for n, l in served), f"{name}{wanted}")

        # The inputs of promtool have the service's own labels and values, except for versions and hashes that must
        # differ.
        values = {}
        for _, of in served:
            for label, value in of.items():
                values.setdefault(label, set()).add(value)
        values["http_route"] = {f"/v1/{e}" for e in values["endpoint"]}
        values["code"] |= set(re.findall(r"X\((\w+),", (ROOT / "core/base/error_codes.hpp").read_text()))
        tried = [s["series"] for t in yaml.safe_load(TRIED.read_text())["tests"] for s in t["input_series"]]
        self.assertGreater(len(tried), 30)
        for name, of in (s for text in tried for s in series(text)):
            self.assertLessEqual(of.keys() - {"job", "instance"}, {label for n, l in served if n == name for label in l}, name)
            for label in of.keys() - {"job", "instance", "version", "sha256"}:
                self.assertIn(of[label], values[label], name)


if __name__ == "__main__":
    front_test.SERVER = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=2)
