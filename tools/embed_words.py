#!/usr/bin/env python3
"""Writes a C++ file with what docs/glossary.md calls the names on the wire, as web/glossary/words.ts reads it.

usage: embed_words.py OUT.cpp GLOSSARY.md
"""
import json
import pathlib
import re
import sys

# Of fields and of values; drawings show no checks and no limits.
SECTIONS = {"Names of fields": "field", "Names in answers": "field", "Names of warnings and of values": "value"}


def words(markdown):
    """{(kind, name): called}"""
    found, kind = {}, None
    for line in markdown.split("\n"):
        if heading := re.match(r"## (.*)$", line):
            kind = SECTIONS.get(heading[1])
        if kind and (row := re.match(r"\| `([^`]+)` \| ([^|]*) \|(?: [^|]*\|)+$", line)):
            found[kind, row[1]] = row[2].strip()
    return found


def main():
    out, glossary = sys.argv[1:]
    rows = [f"    {{Term::{kind}, {json.dumps(name)}, {json.dumps(called, ensure_ascii=False)}}},"
            for (kind, name), called in sorted(words(pathlib.Path(glossary).read_text(encoding="utf-8")).items())]
    if len(rows) < 500:
        sys.exit(f"{glossary}: {len(rows)} names only")
    pathlib.Path(out).write_text(
        '#include "api/wire/words.hpp"\n\nnamespace tubecut::api {\n\nstd::span<const Word> glossary() {\n'
        "  static constexpr Word kWords[] = {\n" + "\n".join(rows) + "\n  };\n  return kWords;\n}\n\n}  // namespace tubecut::api\n",
        encoding="utf-8")


if __name__ == "__main__":
    main()
