"""words counts marker words in comments, texts and prose, and fails outside its limits."""

import unittest

from tool import run_on_tree

PLAIN = "// If the cut is closed, returns its length, because the caller needs it when it computes the time.\n"
MARKED = "// What stands beside it alone is said by none of what asks.\n"


class Words(unittest.TestCase):
    def test_plain_comments_pass(self):
        self.assertEqual(run_on_tree({"core/x.cpp": PLAIN * 200}, "words", "ROOT", "--max", "default")[0], 0)

    def test_marker_words_fail_by_their_names(self):
        status, output = run_on_tree({"core/x.cpp": PLAIN * 200 + MARKED * 20}, "words", "ROOT", "--max", "default")
        self.assertEqual(status, 1)
        for word in ("what", "beside", "stands", "asks", "says", "none", "alone"):
            self.assertIn(f"code: {word} is", output)

    def test_too_few_plain_words_fail(self):
        status, output = run_on_tree({"docs/x.md": "The tube is cut at the plane by the torch of the machine. " * 300}, "words", "ROOT", "--max", "default")
        self.assertEqual(status, 1)
        self.assertIn("prose: if is 0.0", output)

    def test_inline_code_does_not_count(self):
        self.assertEqual(run_on_tree({"core/x.cpp": PLAIN * 200 + "// Sets `none` or `what` if requested.\n" * 30}, "words", "ROOT", "--max", "default")[0], 0)

    def test_an_empty_tree_fails(self):
        self.assertEqual(run_on_tree({}, "words", "ROOT")[0], 1)


if __name__ == "__main__":
    unittest.main()
