#!/usr/bin/env python3
"""Writes town.npy: a town of classes, int16 [x, y, z], z up. 2 ground, 5 tree, 6 building, 9 water, 11 road."""
import numpy as np
n = 384
x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
height = (36 + 14 * np.sin(x / 61) * np.cos(y / 53) + 6 * np.sin(x / 17 + y / 29)).astype(int)
town = np.zeros((n, n, 160), np.int16)
z = np.arange(160)
town[z[None, None] <= height[:, :, None]] = 2
town[(z[None, None] <= 30) & (town == 0)] = 9
numbers = np.random.default_rng(3)
road = (np.abs(x % 96 - 48) < 5) | (np.abs(y % 96 - 48) < 5)
for i, j in np.argwhere(road & (height > 30)):
    town[i, j, height[i, j] - 1:height[i, j] + 1] = 11
for _ in range(260):
    i, j = numbers.integers(12, n - 30, 2)
    w, d, h = numbers.integers(10, 22), numbers.integers(10, 22), numbers.integers(10, 46)
    if road[i - 2:i + w + 2, j - 2:j + d + 2].any() or height[i:i + w, j:j + d].min() < 31 or (town[i - 3:i + w + 3, j - 3:j + d + 3] == 6).any():
        continue
    town[i:i + w, j:j + d, height[i:i + w, j:j + d].min():height[i, j] + h] = 6
for _ in range(2600):
    i, j = numbers.integers(8, n - 8, 2)
    top, r = height[i, j], numbers.integers(3, 6)
    if road[i, j] or top < 31 or (town[i - r:i + r + 1, j - r:j + r + 1] == 6).any():
        continue
    a, b, c = np.mgrid[-r:r + 1, -r:r + 1, -r:r + 1]
    ball = a * a + b * b + c * c <= r * r
    town[i - r:i + r + 1, j - r:j + r + 1, top + 4:top + 5 + 2 * r][ball] = 5
    town[i, j, top:top + 5] = 5
np.save("town.npy", town)
