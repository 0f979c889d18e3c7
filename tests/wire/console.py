#!/usr/bin/env python3
"""The console's files, carried in the binary gzipped and in no other form: `console.py BINARY`. Each arrives as it was built, whether or not
its client takes gzip."""

import gzip
import pathlib
import sys

from service import ROOT, Service, connect, exchange, get, receive

DIST = ROOT / "web/dist"
LEAST = 4096  # bytes: of a smaller file the same bytes may well be elsewhere


def address(file):
    path = "/" + file.relative_to(DIST).as_posix()
    return path.removesuffix("index.html").rstrip("/") or "/" if file.name == "index.html" else path


def wrong_of(service, file):
    """What is not as it was built, by name."""
    built, target = file.read_bytes(), address(file)
    plain, packed = (exchange(service.port, get(target, f"Accept-Encoding: {coding}"))[0] for coding in ("identity", "gzip"))
    with connect(service.port) as sock:
        sock.sendall(get(target, method="HEAD"))
        length = receive(sock, enough=1, bodiless=True)[0][0].get("Content-Length")
    seen = {"as it is": plain.body == built, "coding": (plain.get("Content-Encoding"), packed.get("Content-Encoding")) == (None, "gzip"),
            "gzipped": gzip.decompress(packed.body) == built, "smaller": len(packed.body) < len(built) or len(built) < LEAST,
            "length": length == str(len(built))}
    return [name for name, good in seen.items() if not good]


def main():
    files = sorted(file for file in DIST.rglob("*") if file.is_file())
    binary = pathlib.Path(sys.argv[1]).read_bytes()
    twice = [file.name for file in files if (data := file.read_bytes())[-LEAST:] in binary and len(data) >= LEAST]
    with Service(sys.argv[1]) as service:
        wrong = {file.name: names for file in files if (names := wrong_of(service, file))}
    print(f"{len(files)} files of the console, {sum(f.stat().st_size for f in files) / 1e6:.1f} MB: not as built {wrong}, "
          f"in the binary as they are too {twice}")
    sys.exit(not files or bool(wrong) or bool(twice))


if __name__ == "__main__":
    main()
