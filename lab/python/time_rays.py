#!/usr/bin/env python3
"""Times voxdag.carve_rays: random rays from 100 places in the middle of a cube, at a resolution.

    PYTHONPATH=build/release/python lab/python/time_rays.py [RAYS] [RESOLUTION]
"""
import sys
import time

import numpy as np
import voxdag

rays, resolution = (int(word) for word in (sys.argv[1:] + ["100000", "256"][len(sys.argv) - 1:]))
numbers = np.random.default_rng(0)
origins = np.repeat(numbers.random((100, 3)) * 10 + 45, -(-rays // 100), axis=0)[:rays]
ends = numbers.random((rays, 3)) * 100
start, processor = time.perf_counter(), time.process_time()
occupied, free = voxdag.carve_rays(origins, ends, resolution=resolution, bounds=((0, 0, 0), (100, 100, 100)))
print(f"{rays} rays at {resolution}³: {len(occupied)} occupied and {len(free)} free voxels in "
      f"{time.perf_counter() - start:.2f} s, {time.process_time() - processor:.2f} s of processor time")
