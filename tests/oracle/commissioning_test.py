"""The numbers of docs/commissioning.md are those the coupons' own schedules give: `commissioning_test.py SERVER`."""

import math
import sys
import unittest

sys.dont_write_bytecode = True
import commissioning  # noqa: E402

SERVER = None
READ = 0.02  # mm or deg: finer than the page's use of them


def listed():
    """[[cell]] of the page's table of faults."""
    text = (commissioning.ROOT / "docs" / "commissioning.md").read_text()
    rows = [line for line in text.splitlines() if line.startswith("| ")]
    first = next(i for i, line in enumerate(rows) if line.startswith("| off by |"))
    return [[cell.strip() for cell in line.strip("| ").split("|")] for line in rows[first:first + len(commissioning.FAULTS) + 1]]


class Commissioning(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = commissioning.table(SERVER)

    def test_the_page_lists_what_the_coupons_show(self):
        head, *rows = listed()
        sound = self.table["none"]
        self.assertEqual(head[1:], list(sound))
        self.assertEqual([row[0] for row in rows], ["nothing: read"] + list(self.table)[1:])
        for row, values in zip(rows, self.table.values()):
            for name, cell in zip(sound, row[1:]):
                value = values[name] - (0 if row is rows[0] else sound[name])
                self.assertAlmostEqual(0.0 if cell == "." else float(cell), value, delta=READ, msg=f"{row[0]}, {name}")

    def test_by_hand(self):
        """Errors small enough for a formula: a pivot too short, a carriage and a turn scaled, a swing's zero."""
        sound = self.table["none"]
        off = {fault: {name: row[name] - sound[name] for name in sound} for fault, row in self.table.items()}
        tan = math.tan(math.radians(30))
        self.assertAlmostEqual(off["`pivot_length_mm` 1 mm too short"]["2 ring 1-2 along the outer edge"], -tan, delta=1e-6)
        self.assertAlmostEqual(off["`pivot_length_mm` 1 mm too short"]["3 longest less shortest"], -2 * tan, delta=0.01)
        self.assertAlmostEqual(off["`Y.pulses_per_unit` 1 % too high"]["2 ring 1-2 along the outer edge"],
                               0.01 * (60 + 150 * math.sin(math.radians(30))), delta=1e-6)
        self.assertAlmostEqual(off["`C.pulses_per_turn` 1 % too high"]["1 overlap of the cut's ends"],
                               0.01 * (math.pi * 88.9 + 5), delta=0.01)
        self.assertAlmostEqual(off["zero of B off by +1 deg"]["1 face from square"], 1.0, delta=1e-6)

    def test_every_fault_shows_and_no_two_look_alike(self):
        sound, *others = self.table.values()
        shown = [tuple(round(row[name] - sound[name], 1) for name in sound) for row in others]
        for row in shown:
            self.assertGreater(max(map(abs, row)), 0.3)
        self.assertEqual(len(set(shown)), len(shown))


if __name__ == "__main__":
    SERVER = sys.argv.pop(1)
    unittest.main()
