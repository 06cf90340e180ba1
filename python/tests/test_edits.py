"""Edits of DAGs, against the same edits of coordinates."""
import warnings

import numpy as np
import pytest

import voxdag
from shapes import CUBE, CUBE_FACES, as_set, random_coords


def test_edits_keep_colors():
    coords = random_coords(16, 300)
    colors = np.random.default_rng(7).integers(0, 256, coords.shape, dtype=np.uint8)
    dag = voxdag.from_coords(coords, resolution=16, colors=colors)
    stored = {tuple(c): tuple(v) for c, v in zip(coords.tolist(), dag.colors(coords).tolist())}

    def check(edited, source_of):
        voxels = edited.coords()
        assert len(voxels) > 0
        expected = [stored[tuple(source_of(v).tolist())] for v in voxels]
        np.testing.assert_array_equal(edited.colors(voxels), expected)

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check(dag.crop(((0, 0, 0), (16, 9, 16))), lambda v: v)
        check(dag.shift((3, -2, 0), drop_outside=True), lambda v: v - (3, -2, 0))
        check(dag.mirror("y"), lambda v: v * (1, -1, 1) + (0, 15, 0))
        check(dag.rotate("z"), lambda v: np.array([v[1], 15 - v[0], v[2]]))
        check(dag.keep_components(2), lambda v: v)
        check(dag - voxdag.from_coords(coords[:50], resolution=16), lambda v: v)
        check(dag.crop(((0, 0, 0), (16, 9, 16))) | dag.crop(((0, 5, 0), (16, 16, 16))), lambda v: v)
        coarse = dag.coarsen(4)
        assert coarse.info["has_colors"] and as_set(coarse.coords()) == as_set(coords // 4)
        check(dag | voxdag.from_coords(coords, resolution=16), lambda v: v)


def linear(srgb):
    srgb = np.asarray(srgb) / 255
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def test_coarser_voxels_have_the_mean_color_and_the_most_frequent_label():
    rng = np.random.default_rng(11)
    coords = np.unique(rng.integers(0, 32, (6000, 3)), axis=0)
    cells, of = np.unique(coords // 2, axis=0, return_inverse=True)
    of = of.ravel()
    colors, labels = rng.integers(0, 256, coords.shape, np.uint8), rng.integers(0, 9, len(coords))
    coarse = voxdag.from_coords(coords, resolution=32, colors=colors, labels=labels).coarsen(16)
    sums, counts = np.zeros(cells.shape), np.zeros((len(cells), 9))
    np.add.at(sums, of, linear(colors))
    np.add.at(counts, (of, labels), 1)
    means = sums / np.bincount(of)[:, None]
    means = 255 * np.where(means <= 0.0031308, 12.92 * means, 1.055 * means ** (1 / 2.4) - 0.055)
    # Colours are stored within a bound: no channel differs by more than 5 %.
    errors = np.abs(coarse.colors(cells) - means)
    assert errors.max() <= 0.05 * 255 + 0.5 and errors.mean() < 1
    found = coarse.labels(cells)
    assert (counts[np.arange(len(cells)), found] == counts.max(axis=1)).all()


def test_new_voxels_take_the_nearest_or_a_given_color():
    coords = np.array([[2, 2, 2], [12, 12, 12]])
    dag = voxdag.from_coords(coords, resolution=16, colors=np.array([[255, 0, 0], [0, 0, 255]], np.uint8))
    red, blue = dag.colors(coords)
    grown = dag.dilate(2)
    for voxel, color in zip(grown.coords(), grown.colors(grown.coords())):
        np.testing.assert_array_equal(color, red if voxel[0] < 8 else blue)
    given = dag.dilate(2, color=(1, 2, 3))
    for voxel, color in zip(given.coords(), given.colors(given.coords())):
        old = {(2, 2, 2): red, (12, 12, 12): blue}.get(tuple(voxel.tolist()), (1, 2, 3))
        np.testing.assert_array_equal(color, old)
    assert dag.fill_cavities(color=(1, 2, 3)).info["has_colors"]
    with pytest.raises(ValueError, match="there are no materials"):
        dag.dilate(material=1)
    with pytest.raises(ValueError, match="needs colours"):
        voxdag.from_coords(coords, resolution=16).dilate(color=(1, 2, 3))


def test_operators_align_grids():
    a = voxdag.from_coords(np.array([[1, 2, 3]]), resolution=8)
    b = voxdag.from_coords(np.array([[1, 2, 3], [15, 0, 0]]), resolution=16)
    assert as_set((a | b).coords()) == {(1, 2, 3), (15, 0, 0)}
    assert as_set((b - a).coords()) == {(15, 0, 0)}
    with pytest.raises(ValueError, match="the grids do not align"):
        a | voxdag.build(CUBE, CUBE_FACES, resolution=8)


def test_moves():
    coords = random_coords(32, 90)
    dag = voxdag.from_coords(coords, resolution=32)
    lo, hi = (3, 0, 9), (20, 31, 32)
    kept = coords[((coords >= lo) & (coords < hi)).all(axis=1)]
    assert as_set(dag.crop((lo, hi)).coords()) == as_set(kept)
    moved = coords + (5, -7, 0)
    inside = moved[((moved >= 0) & (moved < 32)).all(axis=1)]
    assert as_set(dag.shift((5, -7, 0), drop_outside=True).coords()) == as_set(inside)
    with pytest.raises(ValueError, match=f"{len(moved) - len(inside)} voxels would leave the grid"):
        dag.shift((5, -7, 0))
    assert as_set(dag.mirror("y").coords()) == as_set(coords * (1, -1, 1) + (0, 31, 0))
    assert as_set(dag.rotate("z").coords()) == as_set(coords[:, [1, 0, 2]] * (-1, 1, 1) + (31, 0, 0))
    assert dag.rotate("z", -3) == dag.rotate("z")
    for turns in (4, -4, 90):
        with pytest.raises(ValueError, match="turns must be -3 to 3"):
            dag.rotate("z", turns)
    coarse = dag.coarsen(8)
    assert as_set(coarse.coords()) == as_set(coords // 4)
    assert coarse.voxel_size == 4 * dag.voxel_size and coarse.origin == dag.origin
