"""The running service, asked by HTTP whatever the status of its answer."""

import json
import pathlib
import subprocess
import threading
import urllib.error
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE = 60  # s for an answer


class Running:
    """`binary` on ports of its own until `stop` or the end of the with block; `ready` is its first line, `child` the process.

    `run`: what Popen is told beside its standard output."""

    def __init__(self, binary, *options, **run):
        self.child = subprocess.Popen([binary, "--port", "0", "--admin-port", "0", *options], stdout=subprocess.PIPE, **run)
        self.ready = json.loads(self.child.stdout.readline())
        self.port = self.ready["port"]
        self.reader = threading.Thread(target=self.read, args=(self.child.stdout,), daemon=True)
        self.reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()

    def stop(self):
        self.child.terminate()
        self.child.wait()
        self.reader.join()
        self.child.stdout.close()

    def read(self, log):
        """Its lines after the first, as they come: thrown away, so that it never waits for a reader."""
        for _ in log:
            pass

    def get(self, path):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}{path}", timeout=PATIENCE) as reply:
            return reply.read()

    def post(self, path, body, headers=(), media="application/json"):
        """(status, headers, bytes)"""
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", body, {"Content-Type": media, **dict(headers)})
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE) as reply:
                return reply.status, reply.headers, reply.read()
        except urllib.error.HTTPError as refused:
            with refused:
                return refused.code, refused.headers, refused.read()
