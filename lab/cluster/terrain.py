#!/usr/bin/env python3
"""Writes a mesh of any size: a terrain of hills as a binary PLY file.

  terrain.py OUT.ply --side N

The terrain has N² vertices and 2 (N - 1)² triangles; the file has about 38 N² bytes. It needs little
memory, and gives equal bytes everywhere that NumPy's sine is equal.
"""
import argparse
import sys

import numpy

FACE = numpy.dtype([("count", "u1"), ("corners", "<u4", (3,))])


def heights(rows, side):
    """Returns the heights of some rows of vertices: hills of eight sizes, each half of the last."""
    y, x = numpy.meshgrid(rows / (side - 1), numpy.arange(side) / (side - 1), indexing="ij")
    height = numpy.zeros_like(x)
    for octave in range(8):
        waves, turn = 2.0 * numpy.pi * 2**octave, 1.0 + octave
        u, v = x * numpy.cos(turn) + y * numpy.sin(turn), y * numpy.cos(turn) - x * numpy.sin(turn)
        height += 0.1 / 2**octave * numpy.sin(waves * u + octave) * numpy.sin(waves * v + 2 * octave)
    return x, y, height


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output")
    parser.add_argument("--side", type=int, required=True, help="vertices along a side, 2 to 65535")
    arguments = parser.parse_args()
    side = arguments.side
    if not 2 <= side <= 65535:
        sys.exit(f"terrain.py: --side {side}: allowed are 2 to 65535")
    step = max(1, (1 << 22) // side)
    with open(arguments.output, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {side * side}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    f"element face {2 * (side - 1) ** 2}\n"
                    "property list uchar uint vertex_indices\nend_header\n").encode())
        for first in range(0, side, step):
            rows = numpy.arange(first, min(first + step, side))
            file.write(numpy.stack(heights(rows, side), axis=-1).astype("<f4").tobytes())
        for first in range(0, side - 1, step):
            rows = numpy.arange(first, min(first + step, side - 1), dtype=numpy.uint32)
            corner = rows[:, None] * numpy.uint32(side) + numpy.arange(side - 1, dtype=numpy.uint32)
            faces = numpy.empty((*corner.shape, 2), FACE)
            faces["count"] = 3
            below = corner + numpy.uint32(side)
            faces["corners"][..., 0, :] = numpy.stack([corner, corner + 1, below + 1], axis=-1)
            faces["corners"][..., 1, :] = numpy.stack([corner, below + 1, below], axis=-1)
            file.write(faces.tobytes())


main()
