#!/usr/bin/env python3
"""Writes a C++ file that carries the built console inside the binary, each file gzipped.

usage: embed_web.py OUT.cpp DIST FILE...        files are named relative to DIST; without any the table is empty
"""
import gzip
import hashlib
import pathlib
import sys

TYPES = {".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8",
         ".svg": "image/svg+xml", ".png": "image/png", ".json": "application/json", ".woff2": "font/woff2", ".wasm": "application/wasm"}
CHUNK = 12000  # bytes; compilers bound the length of one literal
PLAIN = set(range(0x20, 0x7f)) - set(b'"\\?')


def literal(data: bytes) -> str:
    pieces = [data[i:i + CHUNK] for i in range(0, len(data), CHUNK)] or [b""]
    lines = "\n".join('"' + "".join(chr(c) if c in PLAIN else f"\\{c:03o}" for c in piece) + '"' for piece in pieces)
    return f"{{{lines}, {len(data)}}}"


def address(name: str) -> str:
    """index.html answers for its folder."""
    path = "/" + name
    return path[:-len("index.html")].rstrip("/") or "/" if path.endswith("/index.html") else path


def row(name: str, data: bytes) -> str:
    packed = gzip.compress(data, 9, mtime=0)
    kept = "true" if name.startswith("assets/") else "false"  # their names contain a hash of their content
    return (f'    {{"{address(name)}", "{TYPES.get(pathlib.Path(name).suffix, "application/octet-stream")}", '
            f'"\\"{hashlib.sha256(data).hexdigest()[:16]}\\"", {kept}, {{}},\n{literal(packed)}, {len(data)}}},')


def main() -> None:
    out, root, *files = sys.argv[1:]
    rows = [row(pathlib.Path(file).relative_to(root).as_posix(), pathlib.Path(file).read_bytes()) for file in sorted(files)]
    table = "  static constexpr StaticFile kFiles[] = {\n" + "\n".join(rows) + "\n  };\n  return kFiles;\n" if rows else "  return {};\n"
    pathlib.Path(out).write_text(
        '#include "server/http/static_files.hpp"\n\nnamespace tubecut::server {\n\n'
        f"std::span<const StaticFile> static_files() {{\n{table}}}\n\n}}  // namespace tubecut::server\n", encoding="ascii")


if __name__ == "__main__":
    main()
