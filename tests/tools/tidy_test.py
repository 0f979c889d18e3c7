#!/usr/bin/env python3
"""A source that clang-tidy found clean is known again, and only as long as nothing changes that the source depends on."""

import importlib.machinery
import importlib.util
import pathlib
import shutil
import sys
import tempfile
import unittest
import unittest.mock

sys.dont_write_bytecode = True
TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
loader = importlib.machinery.SourceFileLoader("tidy", str(TOOLS / "tidy"))
tidy = importlib.util.module_from_spec(importlib.util.spec_from_loader("tidy", loader))
loader.exec_module(tidy)

FILES = {"core/a.cpp": '#include "core/a.hpp"\n', "core/a.hpp": '#include "core/b.hpp"\n', "core/b.hpp": "int b();\n", "core/c.hpp": "int c();\n"}


class Fingerprint(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.clone("one")

    def clone(self, name):
        root = pathlib.Path(self.folder.name, name)
        for path, text in FILES.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
        return root

    def of(self, root, options="-DA", tool=b"16"):
        with unittest.mock.patch.object(tidy.sources, "ROOT", root):
            return tidy.fingerprint({"command": f"c++ -I{root} {options} -c {root}/core/a.cpp"}, root / "core/a.cpp", tool, {})

    def test_is_the_same_in_every_clone(self):
        self.assertEqual(self.of(self.clone("one")), self.of(self.clone("another")))

    def test_changes_with_all_that_the_source_depends_on(self):
        root = self.clone("one")
        before = self.of(root)
        self.assertNotEqual(before, self.of(root, options="-DB"))
        self.assertNotEqual(before, self.of(root, tool=b"17"))
        self.assertEqual(self.of(root, options="-DA -O1"), self.of(root, options="-DA -O2"))  # which clang-tidy does not read
        for path in FILES:
            with self.subTest(path):
                (root / path).write_text(FILES[path] + "// more\n")
                (self.assertEqual if path == "core/c.hpp" else self.assertNotEqual)(before, self.of(root))
                (root / path).write_text(FILES[path])
        shutil.rmtree(root)


unittest.main()
