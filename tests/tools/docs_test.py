"""What docs/architecture.md and docs/glossary.md name stands in the tree."""

import re
import unittest

from tool import TOOLS

ROOT = TOOLS.parent
PLACE = re.compile(r"`((?:core|api|server|web|tools)/[\w./-]+)`")


class Docs(unittest.TestCase):
    def test_every_place_named_is_there(self):
        for page in ("architecture.md", "glossary.md", *(f"adr/{p.name}" for p in (ROOT / "docs/adr").glob("*.md"))):
            places = set(PLACE.findall((ROOT / "docs" / page).read_text()))
            if not page.startswith("adr"):
                self.assertGreater(len(places), 10, page)
            for place in places:
                with self.subTest(page=page, place=place):
                    path = ROOT / place
                    self.assertTrue(path.exists() or list(path.parent.glob(path.name + ".*")), place)

    def test_every_file_of_the_map_is_there(self):
        """Where a row names files of a room without the room: one of them has that name."""
        rows = [line for line in (ROOT / "docs/architecture.md").read_text().partition("## Where to look")[2].splitlines() if line.startswith("| ")]
        seen = 0
        for row in rows:
            rooms = [ROOT / place for place in PLACE.findall(row)]
            stems = {path.stem for room in rooms for path in (room if room.is_dir() else room.parent).rglob("*")}
            for word in re.findall(r"`([a-z][a-z0-9_]*)`", row):
                with self.subTest(word=word):
                    self.assertIn(word, stems)
                    seen += 1
        self.assertGreater(seen, 20)

    def test_every_example_is_in_the_list(self):
        told = (ROOT / "examples/README.md").read_text()
        for path in (ROOT / "examples").rglob("*.json"):
            if "commissioning" not in path.parts:  # one row for its folder
                self.assertTrue(f"`{path.relative_to(ROOT / 'examples')}`" in told or f"`{path.stem}`" in told or f"`{path.name}`" in told, path)

    def test_both_clients_show_a_key_a_program_and_a_batch(self):
        """What they show is run: clients/python/test_tubecut.py, clients/typescript/test/main.mjs."""
        for client, call in (("python", "client.batch("), ("typescript", "batch('http")):
            blocks = re.findall(r"^```\w+\n(.*?)^```", (ROOT / f"clients/{client}/README.md").read_text(), re.MULTILINE | re.DOTALL)
            for words in (["TUBECUT_KEY"], ["gcode", "speed_mm_min"], [call], [call, "gcode", "options" if client == "typescript" else "BatchItem"]):
                self.assertTrue(any(all(word in block for word in words) for block in blocks), f"{client}: {words}")

    def test_every_folder_of_sources_is_in_the_map(self):
        """A row names the folder, or a folder or file within it."""
        named = PLACE.findall((ROOT / "docs/architecture.md").read_text().partition("## Where to look")[2])
        folders = {path.parent.relative_to(ROOT).as_posix() for layer in ("core", "api", "server") for path in (ROOT / layer).rglob("*.hpp")}
        for folder in folders - {"core/base", "core/math"}:  # used by every task
            with self.subTest(folder=folder):
                self.assertTrue(any(f"{place}/".startswith(f"{folder}/") for place in named), folder)


if __name__ == "__main__":
    unittest.main()
