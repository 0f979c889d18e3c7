#!/usr/bin/env python3
"""Six floods from one socket each: `floods.py BINARY [MEGABYTES] [--must-fail]`. The peak of resident memory may grow by
16 MiB at most during each, and the probe answers meanwhile. With --must-fail, BINARY being the stock library, a flood has
to break that. Then a crowd of sockets that begin bodies and never end them: they may hold half of the memory for jobs, and
good jobs beside them are answered; one that only announces bodies, one that reads nothing of the console's files, and one that has
taken long answers and stays: these may hold nothing."""

import contextlib
import json
import pathlib
import socket
import sys
import time
import zlib

from service import BODY, ROOT, Service, connect, exchange, get, head, post, receive

LIMIT_MIB = 16
BLOCK = 1 << 18
CROWD = 120  # sockets, each with a body of 0.8 MB
TAKERS = 80  # sockets, each with an answer of 1.1 MB
GIVEN_BACK_S = 5.0  # memory that nobody takes again goes back to the system within
CONTAINER = 256 << 20


def bomb(megabytes):
    """Zeros that compress a thousandfold, until as many megabytes would come out."""
    squeeze = zlib.compressobj(9, zlib.DEFLATED, 31)
    for _ in range(megabytes * 4):
        yield squeeze.compress(bytes(BLOCK))
    yield squeeze.flush()


def floods(megabytes):
    many = megabytes * 4
    yield "endless header line", get("/v1/version")[:-2] + b"X: ", lambda: (b"a" * BLOCK for _ in range(many))
    yield "endless header count", get("/v1/version")[:-2], lambda: (b"X-A: b\r\n" * (BLOCK // 8) for _ in range(many))
    yield "endless chunked body", head("Transfer-Encoding: chunked"), lambda: (b"40000\r\n" + b" " * BLOCK + b"\r\n" for _ in range(many))
    yield "endless chunk extension", head("Transfer-Encoding: chunked") + b"5;", lambda: (b"a" * BLOCK for _ in range(many))
    yield "chunk of size -2", head("Transfer-Encoding: chunked") + b"-2\r\n", lambda: (b"a" * BLOCK for _ in range(many))
    yield "gzip bomb", head("Content-Encoding: gzip", "Transfer-Encoding: chunked"), lambda: (
        b"%x\r\n%s\r\n" % (len(part), part) for part in bomb(megabytes) if part)
    yield "pipelined requests, answers never read", b"", lambda: (get("/v1/version") * (BLOCK // 44) for _ in range(many))


def flood(service, first, blocks):
    """Sends until all is sent, the connection breaks, or nothing moves for 5 s."""
    sent = 0
    with connect(service.port, 5.0) as sock:
        try:
            sock.sendall(first)
            for block in blocks():
                sock.sendall(block)
                sent += len(block)
        except (OSError, socket.timeout):
            pass
    return sent


def begin_body(service, number):
    """A socket with all of a body but its end, by its length or in chunks."""
    sock = connect(service.port, 1.0)
    body = b" " * 800_000
    start = head("Transfer-Encoding: chunked", target="/v1/nodes") + b"c8000\r\n" if number % 2 else head(
        "Content-Length: 800001", target="/v1/nodes")
    try:
        sock.sendall(start + body)
    except OSError:
        pass
    return sock


def crowd(binary):
    """True when it holds its share, and what is asked meanwhile is answered."""
    share = 0.6 * CONTAINER
    with Service(binary, "--memory-bytes", str(int(share)), "--slots", "1") as service:
        exchange(service.port, post())
        before = service.memory("VmHWM")
        sockets, statuses = [], []
        for number in range(CROWD):
            sockets.append(begin_body(service, number))
            statuses.append(exchange(service.port, post())[0].status)
        growth = service.memory("VmHWM") - before
        refused = service.metric('tubecut_refused_total{reason="memory"}')
        for sock in sockets:
            sock.close()
        most = service.bytes_per_byte() * (share / 2 / (1 << 20) + LIMIT_MIB)
        print(f"{CROWD} bodies of 0.8 MB begun: {refused:.0f} turned away, peak grows {growth:.1f} MiB (limit {most:.0f}), "
              f"{statuses.count(200)} of {CROWD} good jobs meanwhile answered")
        return growth <= most and refused > 0 and statuses.count(200) == CROWD


def all_there(service, count):
    """Whether the service has so many connections open, now or soon."""
    end = time.monotonic() + 5.0
    while service.metric("tubecut_connections") < count:
        if time.monotonic() >= end:
            return False
        time.sleep(0.05)
    return True


def announcers(binary):
    """True when bodies that are announced, and of which a byte comes, take no memory before the rest."""
    with Service(binary, "--memory-bytes", str(int(0.6 * CONTAINER)), "--slots", "1") as service, contextlib.ExitStack() as stack:
        most = LIMIT_MIB * service.bytes_per_byte()
        exchange(service.port, post())
        before = service.memory("VmRSS")
        for _ in range(CROWD):
            sock = stack.enter_context(connect(service.port))
            sock.sendall(head("Content-Length: 800000", target="/v1/nodes") + b" ")
        there = all_there(service, CROWD)
        growth = service.memory("VmRSS") - before
        print(f"{CROWD} bodies of 0.8 MB announced, a byte of each sent: {growth:.1f} MiB (limit {most})")
        return growth <= most and there


def readers(binary):
    """True when clients that ask for the console's largest file, and read nothing of it, take no copy of it."""
    file = max((ROOT / "web/dist/assets").iterdir(), key=lambda path: path.stat().st_size)
    with Service(binary, "--slots", "1") as service, contextlib.ExitStack() as stack:
        most = LIMIT_MIB * service.bytes_per_byte()
        before = service.memory("VmRSS")
        for _ in range(CROWD):
            stack.enter_context(connect(service.port)).sendall(get(f"/assets/{file.name}"))
        there = all_there(service, CROWD)
        time.sleep(0.5)  # those who take nothing are cut later than that
        growth = service.memory("VmHWM") - before
        print(f"{CROWD} clients that take nothing of {file.stat().st_size / 1e6:.1f} MB of the console: peak grows {growth:.1f} MiB (limit {most})")
        return growth <= most and there


def takers(binary):
    """True when clients that have taken long answers, and keep their connections, hold nothing of them."""
    body = json.loads(BODY)
    body["sampling"] = {"uniform_points": 20000}
    with Service(binary, "--slots", "1") as service, contextlib.ExitStack() as stack:
        most = LIMIT_MIB * service.bytes_per_byte()
        request = post(json.dumps(body).encode())
        size = len(exchange(service.port, request)[0].body)
        before = service.memory("VmRSS")
        for _ in range(TAKERS):
            sock = stack.enter_context(connect(service.port))
            sock.sendall(request)
            if receive(sock, enough=1)[0][0].status != 200:
                return False
        end = time.monotonic() + GIVEN_BACK_S
        while (growth := service.memory("VmRSS") - before) > most and time.monotonic() < end:
            time.sleep(0.2)
        print(f"{TAKERS} answers of {size / 1e6:.1f} MB taken, connections kept: {growth:.1f} MiB held (limit {most})")
        return TAKERS * size > 4 * (most << 20) / service.bytes_per_byte() and growth <= most and all_there(service, TAKERS)


def oversize_line(binary):
    """True when a batch of one line of 8 MB, which would take 48 times that to read, is refused within the memory."""
    share = 0.6 * CONTAINER
    line = b'{"id":"a","endpoint":"bevel-tables","body":{"x":[' + b"[]," * 2_600_000 + b"[]]}}\n"
    with Service(binary, "--memory-bytes", str(int(share)), "--slots", "1") as service:
        exchange(service.port, post())
        before = service.memory("VmHWM")
        request = head(f"Content-Length: {len(line)}", target="/v1/batches").replace(b"application/json", b"application/x-ndjson") + line
        with connect(service.port) as sock:
            sock.sendall(request)
            reply = receive(sock, enough=1)[0][0]
        growth = service.memory("VmHWM") - before
        most = service.bytes_per_byte() * (5 * len(line) / (1 << 20) + LIMIT_MIB)
    print(f"a batch's line of {len(line) / 1e6:.1f} MB: {reply.body[:60]}, peak grows {growth:.1f} MiB (limit {most:.0f})")
    return growth <= most and b'"line":1,"status":413' in reply.body and b'"refused":1' in reply.body


def main():
    must_fail = "--must-fail" in sys.argv
    words = [w for w in sys.argv[1:] if not w.startswith("--")]
    megabytes = int(words[1]) if len(words) > 1 else 200
    worst = 0.0
    for name, first, blocks in floods(megabytes):
        with Service(words[0]) as service:
            for _ in range(20):
                exchange(service.port, get("/v1/version"))
            pathlib.Path(f"/proc/{service.process.pid}/clear_refs").write_text("5")  # reset the peak
            before = service.memory("VmHWM")
            sent = flood(service, first, blocks)
            alive = service.alive()
            growth = service.memory("VmHWM") - before if alive else float("inf")
            replies = exchange(service.port, get("/v1/version")) if alive else []
            ok = alive and len(replies) == 1 and replies[0].status == 200
            worst = max(worst, growth if ok else float("inf"))
            print(f"{name}: {sent / 1e6:.1f} of {megabytes} MB taken or dropped, peak grows {growth:.1f} MiB, "
                  f"{'answers after it' if ok else 'DEAD'}", flush=True)
    print(f"worst growth {worst:.1f} MiB, limit {LIMIT_MIB}")
    if must_fail:
        sys.exit(worst <= LIMIT_MIB)
    sys.exit(not (worst <= LIMIT_MIB and all(part(words[0]) for part in (crowd, announcers, readers, takers, oversize_line))))


main()
