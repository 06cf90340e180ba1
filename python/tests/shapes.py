"""Voxels and meshes that several tests use."""
import numpy as np


def random_coords(side, count, seed=1):
    coords = np.random.default_rng(seed).integers(0, side, (count, 3), dtype=np.int32)
    return np.unique(coords, axis=0)


def as_set(coords):
    return set(map(tuple, np.asarray(coords).tolist()))


CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
CUBE_FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7],
                       [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])


def write_cube(path):
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in CUBE) +
                    "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in CUBE_FACES))
