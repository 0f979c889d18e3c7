#!/usr/bin/env python3
"""Closed standard descriptors: `closed.py BINARY`. Whichever of stdin, stdout and stderr are closed at the start, nothing that is
opened later takes their numbers, where log lines would go: jobs are answered, and SIGTERM ends it with 0."""

import itertools
import os
import signal
import socket
import subprocess
import sys
import time

from service import exchange, get, post


def free_port():
    with socket.socket() as sock:
        sock.bind(("127.0.0.1", 0))
        return sock.getsockname()[1]


def fault(binary, closed):
    port, admin_port = free_port(), free_port()

    def close():
        for descriptor in closed:
            os.close(descriptor)

    process = subprocess.Popen([binary, "--port", str(port), "--admin-port", str(admin_port)], preexec_fn=close,
                               stdout=None if 1 in closed else subprocess.DEVNULL)
    try:
        until = time.monotonic() + 10
        while time.monotonic() < until:
            try:
                if exchange(admin_port, get("/readyz"))[0].status == 200:
                    break
            except (OSError, IndexError):
                time.sleep(0.02)
        if process.poll() is not None:
            return f"ended with {process.returncode}"
        statuses = [exchange(port, post())[0].status for _ in range(5)]
        where = {n: os.readlink(f"/proc/{process.pid}/fd/{n}") for n in closed}
        if set(statuses) != {200} or set(where.values()) != {"/dev/null"}:
            return f"answers {statuses}, descriptors {where}"
        process.send_signal(signal.SIGTERM)
        code = process.wait(15)
        return "" if code == 0 else f"ended with {code}"
    finally:
        process.kill()
        process.wait()


def main():
    wrong = []
    ways = [closed for count in (1, 2, 3) for closed in itertools.combinations((0, 1, 2), count)]
    for closed in ways:
        if found := fault(sys.argv[1], closed):
            wrong.append(f"{closed} closed: {found}")
    print("\n".join(wrong) or f"{len(ways)} ways to close them, all answered")
    sys.exit(bool(wrong))


main()
