#!/usr/bin/env python3
"""Writes a C++ file that carries text files inside the binary.

usage: embed.py OUT.cpp ROOT FILE...        files are named relative to ROOT; openapi.yaml is carried as JSON too
"""
import json
import pathlib
import sys

import yaml

CHUNK = 12000  # characters; compilers bound the length of one literal


def literal(text: str) -> str:
    pieces = [text[i:i + CHUNK] for i in range(0, len(text), CHUNK)] or [""]
    # sv: the compiler knows how long it is, and clang does not count it character by character, which has a bound.
    return "\n".join(f'R"~~~({piece})~~~"' for piece in pieces) + "sv"


def main() -> None:
    out, root, *files = sys.argv[1:]
    entries = []
    for file in sorted(files):
        name = pathlib.Path(file).relative_to(root).as_posix()
        text = pathlib.Path(file).read_text(encoding="utf-8")
        if name.startswith("examples/"):  # bodies are answered inside a JSON list: no white space
            text = json.dumps(json.loads(text), separators=(",", ":"))
        entries.append((name, text))
        if name == "openapi.yaml":
            entries.append(("openapi.json", json.dumps(yaml.safe_load(text), separators=(",", ":"))))
    rows = "\n".join(f'    {{"{name}", {literal(text)}}},' for name, text in entries)
    pathlib.Path(out).write_text(
        '#include "api/catalog/catalogue.hpp"\n\nnamespace tubecut::api {\n\n'
        "std::span<const Embedded> embedded_files() {\n  using namespace std::string_view_literals;\n  static constexpr Embedded kFiles[] = {\n"
        f"{rows}\n  }};\n  return kFiles;\n}}\n\n}}  // namespace tubecut::api\n", encoding="utf-8")


if __name__ == "__main__":
    main()
