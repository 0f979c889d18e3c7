"""check_sizes finds what is too long, and what stands on its list for nothing."""

import pathlib
import tempfile
import unittest

from tool import load, run_on_tree

check_sizes = load("check_sizes")


def tree(folder, files):
    for path, lines in files.items():
        file = pathlib.Path(folder, path)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("\n" * lines)
    return pathlib.Path(folder)


class CheckSizes(unittest.TestCase):
    def test_each_kind_has_its_limit(self):
        for path, kind in (("core/x.hpp", "header"), ("api/x.cpp", "source"), ("tests/x_test.cpp", "test"),
                           ("tests/support/x.hpp", "test"), ("tests/x_test.py", "test"),
                           ("clients/python/test_x.py", "test"), ("web/src/x.ts", "module"), ("web/src/x.tsx", "module")):
            most = check_sizes.LIMITS[kind]
            for lines, status in ((most, 0), (most + 1, 1)):
                with self.subTest(path=path, lines=lines):
                    got, said = run_on_tree({path: "\n" * lines}, "check_sizes", "ROOT")
                    self.assertEqual(got, status, said)

    def test_the_comment_that_begins_a_header_is_free(self):
        for path, status in (("core/x.hpp", 0), ("core/x.cpp", 1)):
            with self.subTest(path=path):
                most = check_sizes.LIMITS[check_sizes.kind_of(pathlib.PurePath(path), path)]
                self.assertEqual(run_on_tree({path: "#pragma once\n\n" + "// x\n" * 20 + "\n" * (most - 2)}, "check_sizes", "ROOT")[0], status)

    def test_an_exception_bounds_and_goes_when_it_is_not_needed(self):
        for lines, words in ((450, None), (460, None), (461, "at most 460"), (400, "take it off")):
            with self.subTest(lines=lines), tempfile.TemporaryDirectory() as folder:
                found, _ = check_sizes.problems(tree(folder, {"core/x.cpp": lines}), {"core/x.cpp": 460})
                self.assertEqual(len(found), words is not None)
                self.assertTrue(all(words in line for line in found), found)

    def test_an_exception_for_no_file_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            found, _ = check_sizes.problems(tree(folder, {"core/x.cpp": 1}), {"core/y.cpp": 500})
            self.assertEqual(found, ["core/y.cpp: is on the list and no file"])

    def test_a_folder_has_a_limit(self):
        for folder, files, status in (("core/x", 40, 0), ("core/x", 41, 1), ("tests/x", 41, 0)):
            with self.subTest(folder=folder, files=files):
                got, said = run_on_tree({f"{folder}/f{i}.cpp": "\n" for i in range(files)}, "check_sizes", "ROOT")
                self.assertEqual(got, status, said)

    def test_an_exception_for_a_folder_goes_when_it_is_not_needed(self):
        with tempfile.TemporaryDirectory() as folder:
            root = tree(folder, {f"core/x/f{i}.cpp": 1 for i in range(41)})
            self.assertEqual(check_sizes.full_folders(root, {"core/x": 41}), [])
            self.assertEqual(len(check_sizes.full_folders(root, {"core/x": 41, "core/y": 45})), 1)

    def test_an_empty_tree_fails(self):
        self.assertEqual(run_on_tree({}, "check_sizes", "ROOT")[0], 1)


if __name__ == "__main__":
    unittest.main()
