"""check_hardened passes a program built as what is shipped, and names each protection that is left out."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools/check_hardened"
# Buffers that are guarded, one of several pages, and copies whose room is known: without them there is nothing to guard or to fortify.
SOURCE = """#include <stdio.h>
#include <string.h>
int main(int n, char** a) {
  char b[64], pages[1 << 16];
  strcpy(b, a[n - 1]);
  strcpy(pages, a[0]);
  return puts(b) == puts(pages);
}
"""
SHIPPED = {
    "position-independent (PIE)": ["-fPIE", "-pie"],
    "relocations read-only (RELRO)": ["-Wl,-z,relro"],
    "all of them, before it starts (BIND_NOW)": ["-Wl,-z,now"],
    "a stack that is no code": ["-Wl,-z,noexecstack"],
    "stack protector": ["-fstack-protector-strong"],
    "stack clash protection": ["-fstack-clash-protection"],
    "fortified calls": ["-U_FORTIFY_SOURCE", "-D_FORTIFY_SOURCE=2"],
}
LEFT_OUT = {
    "position-independent (PIE)": ["-fno-pie", "-no-pie"],
    "relocations read-only (RELRO)": ["-Wl,-z,norelro"],
    "all of them, before it starts (BIND_NOW)": ["-Wl,-z,lazy"],
    "a stack that is no code": ["-Wl,-z,execstack"],
    "stack protector": ["-fno-stack-protector"],
    "stack clash protection": ["-fno-stack-clash-protection"],
    "fortified calls": ["-U_FORTIFY_SOURCE"],
}


class CheckHardened(unittest.TestCase):
    def missing(self, options):
        with tempfile.TemporaryDirectory() as folder:
            source, program = pathlib.Path(folder, "x.c"), pathlib.Path(folder, "x")
            source.write_text(SOURCE)
            subprocess.run(["cc", "-O2", "-w", source, "-o", program, *options], check=True)
            told = subprocess.run([sys.executable, "-B", TOOL, program], capture_output=True, text=True)
        names = [line.removeprefix("missing: ") for line in told.stdout.splitlines() if line.startswith("missing: ")]
        self.assertEqual(told.returncode, 1 if names else 0, told.stdout)
        return names

    def test_what_is_shipped_passes(self):
        self.assertEqual(self.missing(sum(SHIPPED.values(), [])), [])

    def test_each_protection_left_out_is_named(self):
        for name, without in LEFT_OUT.items():
            with self.subTest(name):
                others = sum((options for other, options in SHIPPED.items() if other != name), [])
                self.assertIn(name, self.missing(others + without))


if __name__ == "__main__":
    unittest.main()
