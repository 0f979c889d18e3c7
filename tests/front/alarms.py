"""The shipped rules over scrapes that were recorded: which alerts fire, and when. Each scrape stands for one by the rules' clock, whatever
time lay between them: the rules ask for ratios, quantiles and whether there is any, which do not change with it."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import urllib.request

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
RULES = ROOT / "docker/prometheus-rules.yml"
INTERVAL_S = 15  # of scraping and evaluation, as in docker/prometheus.yml


def promtool():
    found = shutil.which("promtool", path=f"{os.environ['PATH']}:{ROOT / 'build'}")
    assert found, "no promtool: ./dev test fetches it"
    return found


def words(expressions):
    """The names of what they ask for are among these."""
    return set(re.findall(r"[a-z][a-z0-9_:]*", " ".join(expressions)))


def asked_for():
    return words(r["expr"] for group in yaml.safe_load(RULES.read_text())["groups"] for r in group["rules"])


class Record:
    """Scrapes of `targets`, {(job, instance): url}: of these names, else of what the rules ask for."""

    def __init__(self, targets, names=None):
        self._targets, self._names = targets, names or asked_for()
        self._values, self.steps = {}, 0  # {series: {step: value}}

    def scrape(self):
        for (job, instance), url in self._targets.items():
            own = f'job="{job}",instance="{instance}"'
            try:
                with urllib.request.urlopen(url, timeout=2) as reply:
                    lines = reply.read().decode().splitlines()
            except OSError:
                lines = []
            self._put(f"up{{{own}}}", "1" if lines else "0")
            for line in lines:
                name = re.match(r"[\w:]*", line)[0]
                if name in self._names:
                    series, _, value = line.rpartition(" ")
                    labels = series.removeprefix(name).strip("{}")
                    self._put(f"{name}{{{labels}{',' if labels else ''}{own}}}", f"{float(value):.12g}")
        self.steps += 1

    def _put(self, series, value):
        self._values.setdefault(series, {})[self.steps] = value

    def _line(self, values):
        """As promtool's tests write a series; one that is no longer served is marked so, as by Prometheus."""
        return " ".join(values.get(step) or ("stale" if step - 1 in values else "_") for step in range(self.steps))

    def fired(self, windows):
        """Of each range of steps, the end not in it, the set of alerts, with their instances, that fired in it at any time."""
        seen = self.values((f'count by (alertname, instance) (max_over_time(ALERTS{{alertstate="firing"}}[{INTERVAL_S * (end - first) - 1}s]))', end - 1)
                           for first, end in windows)
        return [{" ".join(re.findall(r'"(.*?)"', labels)) for labels in one} for one in seen]

    def values(self, expressions):
        """Of each (expression, step) its {labels: value}, as promtool writes them; {} where there is none."""
        asked = [{"expr": expression, "eval_time": f"{INTERVAL_S * step}s", "exp_samples": [{"labels": '{is="not"}', "value": -1}]}
                 for expression, step in expressions]
        series = [{"series": name, "values": self._line(values)} for name, values in self._values.items()]
        with tempfile.NamedTemporaryFile("w", suffix=".yml") as file:
            yaml.dump({"rule_files": [str(RULES)], "evaluation_interval": f"{INTERVAL_S}s",
                       "tests": [{"interval": f"{INTERVAL_S}s", "input_series": series, "promql_expr_test": asked}]}, file,
                      Dumper=getattr(yaml, "CSafeDumper", yaml.SafeDumper))
            file.flush()
            done = subprocess.run([promtool(), "test", "rules", file.name], capture_output=True, text=True)
        # promtool names the value that it saw instead, expression by expression.
        seen = re.findall(r"got: (.*)", done.stdout + done.stderr)
        assert len(seen) == len(asked), (done.stdout + done.stderr)[-4000:]
        return [{labels: float(value) for labels, value in re.findall(r"({.*?}) ([^ ,]+)", one)} for one in seen]
