#!/usr/bin/env python3
"""Writes the voxels of a .npy file twice, side by side and shuffled, as input for `voxdag import`.

  shuffled_voxels.py VOXELS.npy OUT.npy STEP

The second copy lies STEP voxels further along x. Blocks of 2^20 voxels follow each other in random
order, and so do the voxels of each block. Each run writes the same file. Memory: about 100 MB.
"""
import argparse

import numpy

BLOCK = 1 << 20


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("voxels", help="N x 3 of int32, from `voxdag export -o VOXELS.npy`")
    parser.add_argument("out")
    parser.add_argument("step", type=int)
    arguments = parser.parse_args()

    random = numpy.random.default_rng(1)
    voxels = numpy.load(arguments.voxels, mmap_mode="r")
    blocks = [(copy, start) for copy in range(2) for start in range(0, len(voxels), BLOCK)]
    random.shuffle(blocks)
    with open(arguments.out, "wb") as out:
        header = {"descr": "<i4", "fortran_order": False, "shape": (2 * len(voxels), 3)}
        numpy.lib.format.write_array_header_1_0(out, header)
        for copy, start in blocks:
            block = numpy.array(voxels[start:start + BLOCK])
            block = block[random.permutation(len(block))]
            block[:, 0] += copy * arguments.step
            block.tofile(out)


if __name__ == "__main__":
    main()
