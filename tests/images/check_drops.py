#!/usr/bin/env python3
"""assets/measure_drops.py finds the drops that a picture has. Usage: check_drops.py SOURCE_ROOT"""
import math
import sys
import unittest

ROOT = sys.argv.pop(1)
sys.path.insert(0, ROOT + "/assets")
import measure_drops # noqa: E402

WIDTH = 320


def picture():
    """It is lighter to the right, as what is behind the glass may be."""
    return [[100 + x // 16 for x in range(WIDTH)] for _ in range(measure_drops.ROWS)]


def add_ellipse(rows, x, y, wide, high, above, below):
    for row in range(y - high, y + high + 1):
        for column in range(x - wide, x + wide + 1):
            if ((column - x) / (wide + 0.5)) ** 2 + ((row - y) / (high + 0.5)) ** 2 <= 1:
                rows[row][column] += below if row > y else above


class Drops(unittest.TestCase):
    def test_a_drop_has_its_diameter_shape_and_contrast(self):
        rows = picture()
        add_ellipse(rows, 60, 60, 4, 8, 60, 60)
        (diameter, slender, contrast, area), = measure_drops.measure(rows)[0]
        self.assertAlmostEqual(area, math.pi * 4.5 * 8.5, delta=6)
        self.assertAlmostEqual(diameter, 2 * math.sqrt(4.5 * 8.5), delta=0.5)
        # As of a bar of the same area and moment: 3 / pi of an ellipse.
        self.assertAlmostEqual(slender, 8.5 / 4.5 * 3 / math.pi, delta=0.05)
        self.assertAlmostEqual(contrast, 60, delta=6)

    def test_each_drop_says_whether_it_is_lighter_below(self):
        rows = picture()
        add_ellipse(rows, 60, 60, 6, 6, -50, 50)
        add_ellipse(rows, 160, 60, 6, 6, 50, -50)
        add_ellipse(rows, 160, 160, 6, 6, 50, -50)
        found, below = measure_drops.measure(rows)
        self.assertEqual((len(found), sorted(below)), (3, [False, False, True]))

    def test_what_is_behind_is_no_drop(self):
        self.assertEqual(measure_drops.measure(picture()), ([], []))

    def test_specks_are_none(self):
        rows = picture()
        add_ellipse(rows, 60, 60, 0, 0, 100, 100)
        self.assertEqual(measure_drops.measure(rows), ([], []))


if __name__ == "__main__":
    unittest.main()
