#!/usr/bin/env python3
"""Stops under clients that keep their connections: `rolling.py BINARY [STOPS]`. Eight clients post without a pause while the service stops and
starts again on the same port, with and without a drain delay. A client connects again if an answer says `Connection: close` or if nobody
listens; every request that it has sent is answered. During the delay each answer says close, and a connection that is idle stays open."""

import socket
import sys
import threading
import time

from service import Service, connect, get, post, receive

CLIENTS = 8
EACH = 3  # answers of every client between two stops
PATIENCE = 60.0


def free_port():
    with socket.socket() as sock:
        sock.bind(("127.0.0.1", 0))
        return sock.getsockname()[1]


class Client(threading.Thread):
    """Posts on one connection at a time."""

    def __init__(self, port, over):
        super().__init__()
        self.port, self.over, self.answered, self.lost = port, over, 0, []

    def run(self):
        sock = None
        while not self.over.is_set():
            if sock is None:
                try:
                    sock = connect(self.port)
                except ConnectionRefusedError:
                    time.sleep(0.005)
                    continue
            try:
                sock.sendall(post())
                replies, _, ended = receive(sock, patience=PATIENCE, enough=1)
            except OSError as error:
                replies, ended = [], repr(error)
            if len(replies) != 1 or replies[0].status != 200:
                self.lost.append(f"{[reply.status for reply in replies]}, ended: {ended}")
            self.answered += len(replies)
            if not replies or replies[0].get("Connection") == "close":
                sock.close()
                sock = None
        if sock is not None:
            sock.close()


def rolls(binary, stops, delay):
    port, over = free_port(), threading.Event()
    clients = [Client(port, over) for _ in range(CLIENTS)]
    for client in clients:
        client.start()
    codes = []
    try:
        for _ in range(stops):
            with Service(binary, "--drain-delay-s", str(delay), port=port) as service:
                before = [client.answered for client in clients]
                end = time.monotonic() + PATIENCE
                while any(client.answered < b + EACH for client, b in zip(clients, before)) and time.monotonic() < end:
                    time.sleep(0.002)
                codes.append(service.stop(PATIENCE))
    finally:
        over.set()
        for client in clients:
            client.join()
    lost = [line for client in clients for line in client.lost]
    answered = sum(client.answered for client in clients)
    print(f"{stops} stops, delay {delay} s: {answered} answered, lost {lost[:5]}; ended with {set(codes)}")
    return not lost and set(codes) == {0} and answered >= CLIENTS * EACH * stops


def says_close(binary):
    """Between the signal and the end of the delay."""
    with Service(binary, "--drain-delay-s", "2") as service, connect(service.port) as idle, connect(service.port) as busy:
        for sock in (idle, busy):
            sock.sendall(get("/v1/version"))
            receive(sock, enough=1)
        service.process.terminate()
        while service.metric("tubecut_ready ") == 1:
            time.sleep(0.005)
        told = []
        for sock in (busy, idle):
            sock.sendall(get("/v1/version"))
            told += [(reply.status, reply.get("Connection")) for reply in receive(sock, enough=1)[0]]
        code = service.process.wait(PATIENCE)
    print(f"within the delay: {told}; ended with {code}")
    return told == [(200, "close")] * 2 and code == 0


def main():
    binary, stops = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 10
    done = [says_close(binary), rolls(binary, stops, 0.0), rolls(binary, stops, 0.3)]
    sys.exit(not all(done))


if __name__ == "__main__":
    main()
