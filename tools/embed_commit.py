#!/usr/bin/env python3
"""Writes the commit of a build as C++: `tools/embed_commit.py commit.cpp ROOT`. It is that of `git describe`; without a
repository that of TUBECUT_REVISION, which the image's build sets; else empty. The file is written only if it changes, so
that a build without a new commit compiles nothing."""

import os
import pathlib
import re
import subprocess
import sys

ABBREVIATED = 12


def described(root):
    """The commit, with "-dirty" if a tracked file differs from it; empty without git or repository."""
    if not (root / ".git").exists():
        return ""
    try:
        done = subprocess.run(["git", "-C", str(root), "describe", "--always", "--dirty", f"--abbrev={ABBREVIATED}", "--exclude", "*"],
                              capture_output=True, text=True, check=False)
    except OSError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def revision():
    """The revision that the caller states, cut as git does; empty if it is no hash."""
    found = re.fullmatch(r"([0-9a-f]{7,40})(-dirty)?", os.environ.get("TUBECUT_REVISION", ""))
    return found[1][:ABBREVIATED] + (found[2] or "") if found else ""


def main(out, root):
    commit = described(pathlib.Path(root)) or revision()
    text = ('// Made by tools/embed_commit.py.\n#include "api/api.hpp"\n\nnamespace tubecut::api {\n\n'
            f'std::string_view commit() {{ return "{commit}"; }}\n\n}}  // namespace tubecut::api\n')
    path = pathlib.Path(out)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
