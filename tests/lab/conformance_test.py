#!/usr/bin/env python3
"""Tests the table of the conformance set and what is compared with it."""

import os
import tempfile
import unittest

import report_path  # noqa: F401

import conformance
from document import Error


def split_mix(count):
    """Yields the numbers of SplitMix64 with the state 0, as its authors' C code makes them."""
    state, mask = 0, (1 << 64) - 1
    for _ in range(count):
        state = (state + 0x9E3779B97F4A7C15) & mask
        z = state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        yield z ^ (z >> 31)


class Conformance(unittest.TestCase):
    def test_rays_are_those_of_the_page(self):
        rays = conformance.rays_into({"origin": [1, -2, 0], "voxel_size": 0.5, "levels": 4})
        numbers = [z >> 40 for z in split_mix(60000)]
        for i in (0, 1, 9999):
            u = [n / 2**24 for n in numbers[6 * i:6 * i + 6]]
            for axis, low in enumerate((1, -2, 0)):
                self.assertAlmostEqual(rays[i][axis], low + 8 * (2 * u[axis] - 0.5), delta=1e-5)
                self.assertAlmostEqual(rays[i][axis] + rays[i][4 + axis], low + 8 * u[3 + axis], delta=1e-5)
            self.assertEqual((rays[i][3], rays[i][7]), (0, float("inf")))

    def test_the_table_is_whole(self):
        table = conformance.read_table(conformance.TABLE)
        self.assertEqual(set(table), {(scene, str(grid)) for scene in conformance.SCENES for grid in conformance.GRIDS})
        for row in table.values():
            self.assertEqual(list(row), conformance.COLUMNS)
            self.assertTrue(all(row.values()))

    def rows(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.csv")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            return conformance.read_table(path)

    def test_values_that_differ_are_named(self):
        table = conformance.read_table(conformance.TABLE)
        right = table["sponge", "64"]["voxels"]
        rows = self.rows(f"scene,grid,voxels,hits\nsponge,64,{right},\nsponge,256,7,\nteapot,64,1,\n")
        self.assertEqual(list(conformance.differences(rows, table, "mine")), [
            f"mine: sponge at 256³: voxels is 7, in the table {table['sponge', '256']['voxels']}",
            "mine: teapot at 64³ is not in the table"])

    def test_a_broken_file_is_refused(self):
        for text in ("scene,grid\nsponge\n", "scene,grid\nsponge,64,1\n", "a,b\n1,2\n"):
            with self.assertRaisesRegex(Error, "line 2"):
                self.rows(text)
        with self.assertRaisesRegex(Error, "absent"):
            conformance.read_table("absent.csv")


if __name__ == "__main__":
    unittest.main()
