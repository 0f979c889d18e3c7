#!/usr/bin/env python3
"""Our own source files by kind, one per line: `tools/sources.py c++|headers|shell|typescript|python`. Also the module the other tools share."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CODE = ("core", "api", "server", "tests", "bench")
SCRIPTS = ("dev", ".ci", "tools", "tests", "bench", "docker")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)


def _files(root, folders):
    for folder in folders:
        top = root / folder
        paths = [top] if top.is_file() else sorted(top.rglob("*"))
        yield from (p for p in paths if p.is_file() and "node_modules" not in p.parts)


def cpp(root=ROOT, folders=CODE):
    return [p for p in _files(root, folders) if p.suffix in (".cpp", ".hpp")]


def headers(root=ROOT):
    return [p for p in cpp(root) if p.suffix == ".hpp"]


def shell(root=ROOT):
    return [p for p in _files(root, SCRIPTS) if re.match(rb"#!.*\b(ba)?sh\b", p.open("rb").readline())]


def typescript(root=ROOT, folders=("web/src", "clients/typescript", "clients/import", "clients/check", "tests/e2e", "tests/front", "tests/contract", "tests/generators")):
    """What the client's own build writes (schema.ts and dist) is none of ours."""
    return [p for p in _files(root, folders) if p.suffix in (".ts", ".tsx") and p.name != "schema.ts" and "dist" not in p.parts]


def python(root=ROOT):
    """Modules and scripts; what another tool made is none of ours."""
    return [p for p in _files(root, (*SCRIPTS, "clients"))
            if p.suffix == ".py" or re.match(rb"#!.*\bpython3\b", p.open("rb").readline())]


def includes(text):
    """(quoted?, name) of every include in the text."""
    return [(mark == '"', name) for mark, name in INCLUDE.findall(text)]


def modules(path, text):
    """Files of ours that a TypeScript module imports by a relative name, types included."""
    for name in re.findall(r"""(?:\bfrom|\bimport)\s*\(?\s*['"](\.[^'"]+)['"]""", text):
        at = (path.parent / name).resolve()
        yield from [p for p in (at, at.with_name(at.name + ".ts"), at.with_name(at.name + ".tsx"), at / "index.ts") if p.is_file()][:1]


def without_comments(text):
    """The text with comments and the insides of literals blanked; line numbers stay."""
    token = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'""", re.S)
    return token.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)


if __name__ == "__main__":
    kinds = {"c++": cpp, "headers": headers, "shell": shell, "typescript": typescript, "python": python}
    if len(sys.argv) != 2 or sys.argv[1] not in kinds:
        sys.exit("usage: tools/sources " + "|".join(kinds))
    for path in kinds[sys.argv[1]]():
        print(path.relative_to(ROOT))
