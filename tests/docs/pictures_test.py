"""Everything that a picture of the documentation or the console shows lies within its view box."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from picture import Picture  # noqa: E402


class Pictures(unittest.TestCase):
    def test_nothing_lies_outside(self):
        found = [*ROOT.glob("docs/**/*.svg"), *ROOT.glob("web/public/*.svg"), *ROOT.glob("examples/**/*.svg")]
        self.assertGreaterEqual(len(found), 6)
        for file in found:
            with self.subTest(file.relative_to(ROOT)):
                picture = Picture(file.read_bytes())
                self.assertGreater(len(picture.things), 2)
                self.assertEqual(picture.outside(), [])

    def test_what_lies_outside_is_found(self):
        svg = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 50" font-size="10">{}</svg>'
        for inner, faults in (('<text x="1" y="20">in it</text>', 0), ('<text x="90" y="20">too wide</text>', 1), ('<text x="-1" y="20">left</text>', 1),
                              ('<g transform="translate(10,0)"><rect x="-12" y="5" width="5" height="5"/></g>', 1),
                              ('<text transform="translate(5,20) rotate(-90)">much too long</text>', 1),
                              ('<path d="M0 0C50 -30 50 90 10 10"/>', 1), ('<line x1="5" y1="0.2" x2="50" y2="0.2" stroke="#000" stroke-width="2"/>', 1),
                              ('<clipPath id="c"><polygon points="0,0 40,0 40,40 0,40"/></clipPath><g clip-path="url(#c)"><line x1="-9" y1="5" x2="30" y2="5"/></g>', 0),
                              ('<clipPath id="c"><polygon points="0,0 40,0 40,40 0,40"/></clipPath><g clip-path="url(#c)"><text x="30" y="20">cut off</text></g>', 1)):
            self.assertEqual(len(Picture(svg.format(inner)).outside()), faults, inner)


if __name__ == "__main__":
    unittest.main()
