"""Starts a server for a suite of raw sockets, talks to it byte by byte, and reads its memory."""

import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BODY = (ROOT / "examples/intersections/two-tubes-by-axis.json").read_bytes()


class Service:
    """`command` until the end of the with block; its log is thrown away after the ready line, its standard error goes to `said`."""

    def __init__(self, *command, said=None, port=0):
        stock = command[0].endswith("stock_server")
        words = [command[0]] if stock else [command[0], "--port", str(port), "--admin-port", "0", *command[1:]]
        # An address sanitizer keeps freed memory aside, 256 MiB of it unless told: what is held could not be seen.
        own = {name: value for name, value in os.environ.items() if not name.startswith("TUBECUT_")}  # those are of the tests
        aside = os.environ.get("ASAN_OPTIONS", "") + ":quarantine_size_mb=1:thread_local_quarantine_size_kb=64"
        self.process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=said, env={**own, "ASAN_OPTIONS": aside})
        self.stock = stock

    def __enter__(self):
        ready = json.loads(self.process.stdout.readline())
        self.port, self.admin_port = ready["port"], ready["admin_port"]
        subprocess.Popen(["cat"], stdin=self.process.stdout, stdout=subprocess.DEVNULL)
        deadline = time.monotonic() + 10
        while time.monotonic() < deadline:
            try:
                if exchange(self.admin_port, get("/readyz"))[0].status == 200:
                    break
            except OSError:
                pass
            time.sleep(0.01)
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def stop(self, seconds=12):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(seconds)

    def alive(self):
        return self.process.poll() is None

    def memory(self, field="VmHWM"):
        """MiB; VmHWM is the peak, VmRSS what is resident now."""
        text = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(field + r":\s+(\d+)", text).group(1)) / 1024

    def bytes_per_byte(self):
        """Resident bytes per byte in use: a build with ThreadSanitizer keeps four of its own beside each."""
        return 5 if "libtsan" in pathlib.Path(f"/proc/{self.process.pid}/maps").read_text() else 1

    def slowdown(self):
        """How many times more CPU than without its sanitizer, if it has one, a job takes."""
        maps = pathlib.Path(f"/proc/{self.process.pid}/maps").read_text()
        return 10 if "libtsan" in maps else 4 if "libasan" in maps else 1

    def metrics(self):
        return exchange(self.admin_port, get("/metrics"))[0].body.decode()

    def metric(self, name):
        return sum(float(line.rsplit(" ", 1)[1]) for line in self.metrics().splitlines() if line.startswith(name))

    def refused(self):
        """Requests turned away, by the reason that the metrics name."""
        found = re.findall(r'^tubecut_refused_total\{reason="(\w+)"\} (\d+)$', self.metrics(), re.MULTILINE)
        return {reason: int(count) for reason, count in found if count != "0"}


class Reply:
    def __init__(self, head, body):
        lines = head.decode("latin-1").split("\r\n")
        self.status = int(lines[0].split(" ")[1])
        self.version = lines[0].split(" ")[0]
        self.headers = [tuple(part.strip() for part in line.split(":", 1)) for line in lines[1:] if line]
        self.body = body

    def get(self, name):
        return next((value for key, value in self.headers if key.lower() == name.lower()), None)


def connect(port, timeout=5.0):
    return socket.create_connection(("127.0.0.1", port), timeout)


def get(target, *headers, method="GET"):
    return f"{method} {target} HTTP/1.1\r\nHost: localhost\r\n{''.join(h + chr(13) + chr(10) for h in headers)}\r\n".encode()


def post(body=BODY, *headers, target="/v1/intersections"):
    return head(*headers, f"Content-Length: {len(body)}", target=target) + body


def head(*headers, target="/v1/intersections", version="1.1", host="Host: localhost"):
    lines = [f"POST {target} HTTP/{version}", *([host] if host else []), "Content-Type: application/json", *headers]
    return "".join(line + "\r\n" for line in lines).encode("latin-1") + b"\r\n"


def split_chunks(data):
    """The body in chunks at the front of `data` and what is left over; (None, data) when it is not whole."""
    body, rest = b"", data
    while b"\r\n" in rest:
        size, rest = rest.split(b"\r\n", 1)
        length = int(size, 16)
        if len(rest) < length + 2:
            break
        assert rest[length:length + 2] == b"\r\n", "a chunk does not end where it says"
        body, rest = body + rest[:length], rest[length + 2:]
        if length == 0:
            return body, rest
    return None, data


def split_replies(data, bodiless=False, ended=False):
    """The replies in `data` and what is left over. `bodiless`: the first is to a HEAD."""
    replies = []
    while b"\r\n\r\n" in data and data.startswith(b"HTTP/"):
        front, rest = data.split(b"\r\n\r\n", 1)
        reply = Reply(front, b"")
        length = reply.get("Content-Length")
        if bodiless and not replies or reply.status == 100:
            reply.body = b""
        elif reply.get("Transfer-Encoding") == "chunked":
            reply.body, rest = split_chunks(rest)
        elif length is None and reply.get("Connection") == "close":
            reply.body, rest = (rest, b"") if ended else (None, rest)
        else:
            whole = len(rest) >= int(length or 0)
            reply.body, rest = (rest[:int(length or 0)], rest[int(length or 0):]) if whole else (None, rest)
        if reply.body is None:
            break
        data = rest
        replies.append(reply)
    return replies, data


def receive(sock, quiet=0.4, patience=5.0, enough=None, bodiless=False):
    """Reads until the end, `quiet` seconds of silence after a whole reply, or `enough` replies. Returns replies, rest, ended."""
    data, ended, until = b"", False, time.monotonic() + patience
    while time.monotonic() < until:
        replies, rest = split_replies(data, bodiless)
        if enough is not None and len(replies) >= enough:
            break
        sock.settimeout(quiet if replies and not rest else max(0.01, until - time.monotonic()))
        try:
            more = sock.recv(1 << 16)
        except socket.timeout:
            break
        except ConnectionError:
            ended = True
            break
        if not more:
            ended = True
            break
        data += more
    replies, rest = split_replies(data, bodiless, ended)
    return replies, rest, ended


def read_to_the_end(port, data, patience=120.0):
    """The reply to a request that asks the server to close behind it, None without one; its body as it came, chunks and all. A long
    answer is not looked through again and again for its end, as `receive` does."""
    with connect(port, patience) as sock:
        sock.sendall(data)
        parts = []
        while part := sock.recv(1 << 20):
            parts.append(part)
    reply = b"".join(parts)
    return Reply(*reply.split(b"\r\n\r\n", 1)) if b"\r\n\r\n" in reply else None


def exchange(port, data, patience=5.0):
    with connect(port, patience) as sock:
        sock.sendall(data)
        return receive(sock, enough=1, patience=patience)[0]
