"""make_architecture_svg finds the rooms and their arrows, refuses a circle, and sees a picture that is out of date."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

from tool import TOOLS

import make_architecture_svg as picture

TREE = {
    "core/base/error.hpp": "",
    "core/math/root.hpp": '#include "core/base/error.hpp"\n',
    "core/joint/node/node.cpp": '#include "core/base/error.hpp"\n#include "core/math/root.hpp"\n',
    "api/dispatch.cpp": '#include "api/endpoints/all.hpp"\n#include "core/base/error.hpp"\n',
    "api/endpoints/all.hpp": '#include "core/joint/node/node.hpp"\n',
    "server/app.cpp": '#include "api/dispatch.hpp"\n',
}


def tree(folder, files):
    for path, text in files.items():
        file = pathlib.Path(folder, path)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return pathlib.Path(folder)


class Architecture(unittest.TestCase):
    def test_rooms_and_arrows_are_those_of_the_includes(self):
        with tempfile.TemporaryDirectory() as folder:
            rooms, edges, down = picture.rooms_and_edges(tree(folder, TREE))
        self.assertEqual(rooms, ["api", "api/endpoints", "core/base", "core/joint", "core/math", "server"])
        self.assertEqual(down, {("server", "api"), ("api", "core")})
        self.assertEqual(edges["core/joint"], {"core/base", "core/math"})
        self.assertEqual(picture.needed({r: to for r, to in edges.items() if r.startswith("core/")})["core/joint"], {"core/math"})
        self.assertEqual(picture.level("core/joint", edges), 2)

    def test_a_circle_of_rooms_is_refused(self):
        circle = {**TREE, "core/base/error.hpp": '#include "core/joint/node/node.hpp"\n'}
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(SystemExit, "include each other"):
            picture.svg(tree(folder, circle))

    def test_a_room_that_nobody_describes_is_refused(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(SystemExit, "core/new"):
            picture.svg(tree(folder, {**TREE, "core/new/x.cpp": ""}))

    def test_a_picture_out_of_date_is_seen(self):
        with tempfile.TemporaryDirectory() as folder:
            for text, status in ((picture.svg(), 0), (picture.svg() + "\n", 1)):
                file = pathlib.Path(folder, "x.svg")
                file.write_text(text)
                done = subprocess.run([sys.executable, "-B", TOOLS / "make_architecture_svg.py", "--check", file])
                self.assertEqual(done.returncode, status)


if __name__ == "__main__":
    unittest.main()
