"""Writes a GoogleTest source with the example of every header: header_examples.py SOURCE_DIR OUT HEADER...

An example is the indented code in the comment that begins a header. Each becomes a test. A number at the end of a
comment, as in `const double height = groove.height_min;  // mm: 8.46`, is asserted within half a unit of its last digit.
"""
import pathlib
import re
import sys

VALUE = re.compile(r"const (?:double|auto) (\w+) = .*;\s*// (?:.* )?(\d+(?:\.(\d+))?)$")
FLAG = re.compile(r"const bool (\w+) = ")


def code_of(header):
    """The lines of the example, or an error if the header has none at its top."""
    top = re.match(r"#pragma once\n\n((?://.*\n)+)", header.read_text())
    code = [line[7:] for line in top[1].splitlines() if line.startswith("//     ")] if top else []
    if not code:
        sys.exit(f"{header}: the comment that begins it has no example")
    return code


def checks_of(line):
    if value := VALUE.match(line.strip()):
        name, number, decimals = value.groups()
        return [f"EXPECT_NEAR(static_cast<double>({name}), {number}, 0.5e-{len(decimals or '')});"]
    if flag := FLAG.match(line.strip()):
        return [f"EXPECT_TRUE({flag.group(1)});"]
    return []


def test_of(name, header):
    code = code_of(header)
    checks = [check for line in code for check in checks_of(line)]
    if not checks:
        sys.exit(f"{header}: the example states no value that a test can check")
    test = "_".join(pathlib.PurePath(name).with_suffix("").parts[1:])
    return "\n".join([f"TEST(HeaderExamples, {test}) {{", *(f"  {line}" for line in code + checks), "}"])


def main(root, out, names):
    headers = [pathlib.Path(root) / name for name in names]
    parts = ["#include <gtest/gtest.h>", "#include <algorithm>", "#include <vector>", '#include "core/base/elementary.hpp"',
             *(f'#include "{name}"' for name in names), "namespace tubecut {",
             *(test_of(name, header) for name, header in zip(names, headers, strict=True)), "}  // namespace tubecut", ""]
    pathlib.Path(out).write_text("\n".join(parts))


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
