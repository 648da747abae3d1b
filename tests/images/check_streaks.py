#!/usr/bin/env python3
"""assets/measure_streaks.py finds the bars that a picture has, and nothing else. Usage: check_streaks.py SOURCE_ROOT"""
import random
import sys
import unittest

ROOT = sys.argv.pop(1)
sys.path.insert(0, ROOT + "/assets")
import measure_streaks # noqa: E402

WIDTH, HEIGHT = 160, 120


def picture(seed=1, right=0):
    """Two grey halves with a little noise, all moved to the right."""
    noise = random.Random(seed)
    return [[(50 if x - right < 80 else 150) + noise.randint(-1, 1) for x in range(WIDTH)] for _ in range(HEIGHT)]


def add(rows, left, top, width, height, codes):
    for y in range(top, top + height):
        for x in range(left, left + width):
            rows[y][x] += codes


def measure(*pictures):
    return measure_streaks.measure(*([bytes(row) for row in rows] for rows in pictures))[0]


class Streaks(unittest.TestCase):
    def test_a_bar_has_its_width_length_and_contrast(self):
        here = picture(2)
        add(here, 30, 40, 3, 20, 15)
        (behind, width, length, contrast), = measure(picture(1), here, picture(3))
        self.assertAlmostEqual(behind, 50, delta=1)
        self.assertAlmostEqual(width, 3, delta=0.1)
        self.assertAlmostEqual(length, 20, delta=0.2)
        self.assertAlmostEqual(contrast, 15, delta=1)

    def test_each_bar_counts_before_its_own_background(self):
        here = picture(2)
        for i in range(5):
            add(here, 12 + 12 * i, 20, 2, 16, 12)
        add(here, 120, 30, 2, 16, 12)
        self.assertEqual(sorted(round(s[0], -1) for s in measure(picture(1), here, picture(3))), [50] * 5 + [150])

    def test_a_camera_that_shakes_makes_no_streaks(self):
        self.assertEqual(measure(picture(1, 2), picture(2), picture(3, -3)), [])

    def test_an_edge_that_moves_by_half_a_pixel_is_no_streak(self):
        here = picture(2)
        add(here, 79, 0, 1, HEIGHT, 50)
        self.assertEqual(measure(picture(1), here, picture(3)), [])

    def test_what_is_round_or_darker_is_no_streak(self):
        here = picture(2)
        add(here, 30, 40, 4, 4, 20)
        add(here, 50, 40, 2, 20, -20)
        self.assertEqual(measure(picture(1), here, picture(3)), [])

    def test_what_stays_is_no_streak(self):
        pictures = [picture(i) for i in range(3)]
        for rows in pictures:
            add(rows, 30, 40, 2, 20, 20)
        self.assertEqual(measure(*pictures), [])


unittest.main()
