#!/usr/bin/env python3
"""The tables of `bench trace` say the geometric mean and the worst case."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "lab/report"))

from show import trace_table  # pylint: disable=wrong-import-position


def row(scene, rays, rate, theirs):
    return {"scene": scene, "resolution": 4096, "layout": "paper", "layout_bytes": 1, "device": "cpu", "rays": rays, "ray_count": 1,
            "hit_part": 1, "cells_per_ray": 1, "bytes_per_ray": 1, "mrays_per_s": rate, "rival": "other", "rival_mrays_per_s": theirs}


class TraceTable(unittest.TestCase):
    def test_means_are_geometric_and_leave_beams_out(self):
        rows = [row("a", "primary", 4, 1), row("a", "primary_beams", 100, 1), row("a", "ao", 1, 1),
                row("b", "primary", 1, 1), row("b", "primary_beams", 100, 1), row("b", "ao", 1, 4)]
        means = trace_table(rows).split("geometric mean")[1].split("\n")
        self.assertEqual([" ".join(line.split()) for line in means[2:6]],
                         ["primary 2.00 (1.00, b)", "primary_beams 100.00 (100.00, a)", "ao 0.50 (0.25, b)", "all 1.00 (0.25, b)"])

    def test_one_scene_has_no_mean(self):
        self.assertNotIn("geometric", trace_table([row("a", "primary", 4, 1)]))


if __name__ == "__main__":
    unittest.main()
