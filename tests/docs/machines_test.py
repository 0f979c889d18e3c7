"""docs/machines.md run as it stands: every command in an empty folder, what it prints, and every line that the page explains."""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from running import ROOT, Running  # noqa: E402

PAGE = (ROOT / "docs/machines.md").read_text()
BLOCKS = re.findall(r"^```(sh|text)\n(.*?)^```", PAGE, re.M | re.S)
SERVER, ADDRESS = "build/release/tubecut-server", "http://127.0.0.1:8080"
EXPLAINED = re.findall(r"^\| `(.*?)` \| ", PAGE.split("line by line", 1)[1].split("\n## ")[0], re.M)


class Page(unittest.TestCase):
    binary = ""

    def run_page(self, folder):
        """What each block printed; the service is started where the page does."""
        service, said, script = None, [], ""
        try:
            for kind, block in BLOCKS:
                if kind == "text":
                    self.assertIn(block.strip(), said[-1])
                    continue
                if SERVER in block:
                    service = Running(self.binary, *shlex.split(block.strip().rstrip("&"))[1:], cwd=folder, stderr=subprocess.DEVNULL)
                    continue
                told = [line for line in block.splitlines() if line.startswith(("ask=", "TUBECUT="))]
                block = script + block if service is None or told else script + "\n" + block
                if service is not None:
                    block = block.replace(ADDRESS, f"http://127.0.0.1:{service.port}")
                ran = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=folder, capture_output=True, text=True, timeout=120,
                                     env=os.environ | {"TUBECUT": str(ROOT)})
                self.assertEqual(ran.returncode, 0, block + ran.stderr)
                said.append(ran.stdout)
                script += "".join(line + "\n" for line in told)  # variables last to the next block
        finally:
            if service is not None:
                service.stop()
        return said

    def test_every_command_runs_and_every_line_is_there(self):
        self.assertGreater(len(BLOCKS), 5)
        self.assertGreater(len(EXPLAINED), 25)
        with tempfile.TemporaryDirectory() as place:
            folder = pathlib.Path(place)
            self.run_page(folder)
            lines = (folder / "saddle.ngc").read_text().splitlines()
            at = -1
            for wanted in EXPLAINED:
                found = next((i for i in range(at + 1, len(lines)) if lines[i] == wanted or (wanted[-1] == " " and lines[i].startswith(wanted))), None)
                self.assertIsNotNone(found, f"{wanted!r} is not in saddle.ngc behind line {at + 1}")
                at = found
            dry = (folder / "dry.ngc").read_text().splitlines()
            self.assertFalse([line for line in dry if line.startswith("M3")])
            self.assertEqual([line for line in dry if line[:2] in ("G0", "G1")], [line for line in lines if line[:2] in ("G0", "G1")])
            for coupon in ("1-square", "2-bevel-plus-30", "3-mitre-30", "4-saddle"):
                program = (folder / f"{coupon}.ngc").read_text()
                self.assertIn("(machine: five_axis_cutter, table ", program)
                self.assertGreater(program.count("\nG1 "), 20)


if __name__ == "__main__":
    Page.binary = os.path.abspath(sys.argv.pop(1))
    unittest.main()
