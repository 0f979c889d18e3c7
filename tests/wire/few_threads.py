#!/usr/bin/env python3
"""A system without threads to give: `few_threads.py BINARY SHIM`. However many it still gives, the service starts with all it needs
or ends with 71 and says why: never by a signal, never half started. Once it is ready it asks for none: it answers."""

import json
import os
import subprocess
import sys

from service import exchange, get, post

NO_THREAD = 71  # EX_OSERR
PATIENCE_S = 20


def started(binary, shim, given):
    """Its ports, or what became of it."""
    process = subprocess.Popen([binary, "--port", "0", "--admin-port", "0", "--slots", "2"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               env={**os.environ, "LD_PRELOAD": shim, "FEW_THREADS": str(given)}, text=True)
    first, second = process.stdout.readline(), process.stdout.readline()
    if second:
        ready = json.loads(first)
        try:
            answers = [exchange(ready["port"], post())[0].status for _ in range(20)] + [exchange(ready["admin_port"], get("/readyz"))[0].status]
        except (OSError, IndexError):
            answers = []
        if process.poll() is None and answers:
            process.terminate()
            return answers, process.wait(PATIENCE_S), process.stderr.read()
    return [], process.wait(PATIENCE_S), process.stderr.read()


def main():
    binary, shim = sys.argv[1:]
    wrong, refused = [], 0
    for given in range(200):
        answers, code, said = started(binary, shim, given)
        if answers:
            if set(answers) != {200} or code != 0:
                wrong.append(f"{given} threads: answers {set(answers)}, ended with {code}: {said}")
            break
        refused += 1
        if code != NO_THREAD or "thread" not in said:
            wrong.append(f"{given} threads: ended with {code}: {said!r}")
    else:
        wrong.append("it never started")
    print("\n".join(wrong) or f"with {refused} numbers of threads too few it says so and ends with {NO_THREAD}; with {given} it answers")
    sys.exit(bool(wrong) or refused < 5)


main()
