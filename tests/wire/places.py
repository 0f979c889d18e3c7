#!/usr/bin/env python3
"""A key's limit of connections: `places.py BINARY`. It counts from the end of a request's head, so bodies that never come whole take no more
places than the limit, and other keys keep theirs, also behind a proxy whose address all of them share."""

import json
import subprocess
import sys
import tempfile

from service import BODY, Service, connect, head, post, receive

LIMIT = 4


def new_key(binary, name):
    """The key, and its line for --keys."""
    return subprocess.run([binary, "new-key", name], capture_output=True, text=True, check=True).stdout.split("\n")[1:4:2]


def main():
    binary = sys.argv[1]
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as keys:
        (ours, line), (theirs, other) = new_key(binary, "ours"), new_key(binary, "theirs")
        keys.write(f"{line}\n{other}\n")
        keys.flush()
        with Service(binary, "--keys", keys.name, "--connections-per-client", str(LIMIT), "--trusted-proxy", "127.0.0.1") as service:
            arriving = [connect(service.port) for _ in range(LIMIT)]
            for sock in arriving:
                sock.sendall(head(f"X-Api-Key: {ours}", "Expect: 100-continue", f"Content-Length: {len(BODY)}"))
                assert [reply.status for reply in receive(sock, enough=1)[0]] == [100]  # its head is read
            told = {}
            for name, key in (("ours", ours), ("theirs", theirs)):
                with connect(service.port) as sock:
                    sock.sendall(post(BODY, f"X-Api-Key: {key}"))
                    told[name] = [(reply.status, json.loads(reply.body).get("code")) for reply in receive(sock, enough=1)[0]]
            for sock in arriving:
                sock.sendall(BODY)
            whole = [[reply.status for reply in receive(sock, enough=1)[0]] for sock in arriving]
            for sock in arriving:
                sock.close()
    print(f"beside {LIMIT} bodies on their way: {told}; these then: {whole}")
    sys.exit(told != {"ours": [(429, "overloaded")], "theirs": [(200, None)]} or whole != [[200]] * LIMIT)


if __name__ == "__main__":
    main()
