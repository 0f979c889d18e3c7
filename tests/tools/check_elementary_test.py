"""check_elementary finds transcendental calls of core, in text and in objects."""

import pathlib
import subprocess
import tempfile
import unittest

from tool import TOOLS, run_on_tree

SOUND = {
    "core/base/elementary.cpp": "double sin(double x) { return std::sin(x); }\n",
    "core/x.cpp": """// std::sin(x) in words
using elementary::cos;
const char* text = "atan2(y, x)";
double f(double x) { return elementary::sin(x) + tubecut::elementary::pow(x, 2) + cos(x) + std::sqrt(x) + s.sin + arcsin(x); }
""",
}
BAD = """std::sin(x)|std::cos (x)|std::tan(x)|std::asin(x)|std::acos(x)|std::atan(x)|std::atan2(y, x)|std::exp(x)|std::log(x)
std::pow(x, 2)|std::hypot(x, y)|std::cbrt(x)|::sin(x)|sin(x)|sinl(x)|std::atan2l(y, x)|powf(x, y)|a.array().sin()|std::polar(1.0, x)
Eigen::AngleAxisd(x, axis)""".replace("\n", "|").split("|")


class CheckElementary(unittest.TestCase):
    def test_a_sound_tree_passes(self):
        status, said = run_on_tree(SOUND, "check_elementary", "--root", "ROOT")
        self.assertEqual(status, 0, said)

    def test_each_call_is_found(self):
        for call in BAD:
            with self.subTest(call):
                bad = {**SOUND, "core/bad.cpp": f"auto y = {call};\n"}
                status, said = run_on_tree(bad, "check_elementary", "--root", "ROOT")
                self.assertEqual(status, 1, said)
                self.assertIn("core/bad.cpp:1", said)

    def test_an_empty_tree_fails(self):
        self.assertEqual(run_on_tree({}, "check_elementary", "--root", "ROOT")[0], 1)

    def test_what_text_cannot_show_is_found_in_the_object(self):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "x.cpp")
            source.write_text("#include <complex>\ndouble f(std::complex<double> z) { return std::abs(z); }\n")
            subprocess.run(["c++", "-c", "-o", "x.cpp.o", source], cwd=folder, check=True)
            subprocess.run(["ar", "rc", "libx.a", "x.cpp.o"], cwd=folder, check=True)
            command = [TOOLS / "check_elementary", "--library", pathlib.Path(folder, "libx.a")]
            done = subprocess.run(command, capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn("x.cpp.o) calls cabs", done.stdout)


if __name__ == "__main__":
    unittest.main()
