#!/usr/bin/env python3
"""Writes a scene of Gaussian splats as a PLY file of a trainer: a yard with eight houses, and floaters far around it.

    splat_scene.py OUT.ply SPLATS

The splats lie on the ground and on the walls, floors and roofs of the houses, as a training leaves them: flat, turned with their
surface, some of them faint. One in a hundred floats in the box of 179.2 x 85.52 x 157.8 around. At a voxel size of 0.01 the grid of
splat-transform has 17,920 x 8,552 x 15,780 voxels. y is up; (27, 1, 27) is a place in a house.
"""
import sys

import numpy as np

BOX = np.array([179.2, 85.52, 157.8])
YARD = 60.0


def rectangles():
    """Returns the corners and the two sides of the surfaces."""
    found = [((0, 0, 0), (YARD, 0, 0), (0, 0, YARD))]
    for i in range(8):
        x, z = 8 + 14 * (i % 4), 12 + 24 * (i // 4)
        width, depth, height = 8 + i % 3, 10, 3.0 * (1 + i % 3)
        for level in np.arange(0, height + 1, 3):
            found.append(((x, level, z), (width, 0, 0), (0, 0, depth)))
        for dx, dz in ((0, 0), (width, 0)):
            found.append(((x + dx, 0, z + dz), (0, height, 0), (0, 0, depth)))
        # Two walls have an opening of 2 x 2.4 in the middle.
        for dz in (0, depth):
            half = (width - 2) / 2
            found.append(((x, 0, z + dz), (half, 0, 0), (0, height, 0)))
            found.append(((x + half + 2, 0, z + dz), (half, 0, 0), (0, height, 0)))
            found.append(((x + half, 2.4, z + dz), (2, 0, 0), (0, height - 2.4, 0)))
    return [np.array(r, float) for r in found]


def write(path, count):
    rng = np.random.default_rng(1)
    surfaces = rectangles()
    areas = np.array([np.linalg.norm(np.cross(r[1], r[2])) for r in surfaces])
    spacing = np.sqrt(areas.sum() / count)
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", *(f"f_rest_{i}" for i in range(45)), "opacity",
             *(f"scale_{i}" for i in range(3)), *(f"rot_{i}" for i in range(4))]
    with open(path, "wb") as file:
        file.write(("ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % count).encode())
        file.write("".join(f"property float {name}\n" for name in names).encode() + b"end_header\n")
        for begin in range(0, count, 1 << 17):
            size = min(1 << 17, count - begin)
            row = np.zeros((size, len(names)), "<f4")
            which = rng.choice(len(surfaces), size, p=areas / areas.sum())
            chosen = np.array(surfaces)[which]
            place = rng.random((size, 2))
            row[:, :3] = chosen[:, 0] + chosen[:, 1] * place[:, :1] + chosen[:, 2] * place[:, 1:]
            normal = np.cross(chosen[:, 1], chosen[:, 2])
            axis = np.abs(normal).argmax(1)
            row[:, :3] += rng.normal(0, 0.003, (size, 3))
            row[:, 3:6] = np.array([0.3, 0.1, -0.4])[None] * (1 + which[:, None] % 5) / 3 + rng.normal(0, 0.2, (size, 3))
            row[:, 6:51] = rng.normal(0, 0.1, (size, 45))
            row[:, 51] = rng.normal(1, 2, size)
            scales = np.log(spacing * np.exp(rng.normal(-0.2, 0.4, (size, 3))))
            # The splat's z is its normal, which the rotation turns to x, y or z.
            scales[:, 2] = np.log(0.002 * np.exp(rng.normal(0, 0.7, size)))
            row[:, 52:55] = scales
            spin = rng.random(size) * np.pi
            s = np.sqrt(0.5)
            turn = np.array([(s, 0, s, 0), (s, -s, 0, 0), (1, 0, 0, 0)])[axis]
            w, x, y, z = turn.T
            c, k = np.cos(spin), np.sin(spin)
            row[:, 55:59] = np.stack([w * c - z * k, x * c + y * k, y * c - x * k, z * c + w * k], 1)
            row[:, 55:59] += rng.normal(0, 0.02, (size, 4))
            floats = rng.random(size) < 0.01
            far = int(floats.sum())
            row[floats, :3] = (rng.random((far, 3)) - [0.3, 0.1, 0.3]) * BOX
            row[floats, 52:55] = np.log(0.05 * np.exp(rng.normal(0, 0.7, (far, 3))))
            row.tofile(file)


if __name__ == "__main__":
    write(sys.argv[1], int(sys.argv[2]))
