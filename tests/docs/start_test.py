"""README.md and the pages of docs/start, run as they stand: each `sh` block runs, and prints what the `text` block below it shows."""

import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from running import ROOT, Running  # noqa: E402

START = sorted((ROOT / "docs/start").glob("*.md"))
BLOCK = re.compile(r"^```(sh|text)\n(.*?)^```", re.M | re.S)
README_LINES = 120


def free_port():
    with socket.socket() as sock:
        sock.bind(("127.0.0.1", 0))
        return sock.getsockname()[1]


class Pages(unittest.TestCase):
    binary = ""

    def run_page(self, page, folder, port, admin_port):
        """Runs the page's `sh` blocks in one shell; each must print all lines of the `text` block that follows it."""
        for name in ("examples", "clients", "docs"):
            os.symlink(ROOT / name, folder / name)
        blocks = BLOCK.findall(page.read_text())
        self.assertTrue([kind for kind, _ in blocks].count("sh") > 0, "the page has no command")
        script = "set -euo pipefail\n" + "".join(f"{text}echo '--- {i}'\n" for i, (kind, text) in enumerate(blocks) if kind == "sh")
        script = script.replace("127.0.0.1:8080", f"127.0.0.1:{port}").replace("127.0.0.1:9090", f"127.0.0.1:{admin_port}")
        script = script.replace("build/release/tubecut-server", self.binary).replace("python3 clients", f"{sys.executable} -B clients")
        ran = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(ran.returncode, 0, f"{ran.stdout}\n{ran.stderr}")
        printed = re.split(r"^--- (\d+)\n", ran.stdout, flags=re.M)
        by_block = {int(number): text for text, number in zip(printed[::2], printed[1::2])}
        for i, (kind, text) in enumerate(blocks):
            for line in text.splitlines() if kind == "text" else []:
                self.assertIn(line, by_block[i - 1].splitlines(), f"{page.name}, block {i}: {by_block[i - 1]}")

    def test_pages(self):
        self.assertEqual(len(START), 4)
        for page in [ROOT / "README.md", *START]:
            starts_service = "server=$!" in page.read_text()
            with self.subTest(page=page.name), tempfile.TemporaryDirectory() as place:
                service = None if starts_service else Running(self.binary, stderr=subprocess.DEVNULL)
                try:
                    ports = (service.port, service.ready["admin_port"]) if service else (free_port(), free_port())
                    self.run_page(page, pathlib.Path(place), *ports)
                finally:
                    if service:
                        service.stop()

    def test_readme_is_short_and_its_links_hold(self):
        text = (ROOT / "README.md").read_text()
        self.assertLessEqual(len(text.splitlines()), README_LINES)
        for page in [ROOT / "README.md", ROOT / "docs/tour.md", *START]:
            self.assertNotIn("@@", page.read_text(), f"{page}: a placeholder")
            links = re.findall(r"\]\((?!http)([^)#]+)", page.read_text())
            self.assertGreater(len(links), 0, page)
            for link in links:
                self.assertTrue((page.parent / link).exists(), f"{page.name}: {link}")


if __name__ == "__main__":
    Pages.binary = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
