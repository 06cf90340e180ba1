"""Gaussian splats, and the space that a capsule can reach among voxels."""
import numpy as np
import pytest

import voxdag

NAMES = ["x", "y", "z", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]


def write_splats(path, rows):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n"
    header += "".join(f"property float {name}\n" for name in NAMES) + "end_header\n"
    path.write_bytes(header.encode() + np.asarray(rows, "<f4").tobytes())


def test_splats_set_the_voxels_where_they_are_opaque(tmp_path):
    # Two balls with deviations of 2 and 1, and an opacity of 0.5 at their centres.
    rows = [[16, 16, 16, 0] + [np.log(2)] * 3 + [1, 0, 0, 0], [18, 16, 16, 0] + [0] * 3 + [2, 0, 0, 0]]
    write_splats(tmp_path / "s.ply", rows)
    options = {"resolution": 32, "bounds": ((0, 0, 0), (32, 32, 32)), "max_scale": 10}
    dag = voxdag.import_file(tmp_path / "s.ply", opacity=0.3, **options)
    places = np.stack(np.meshgrid(*[np.arange(32) + 0.5] * 3, indexing="ij"), -1)
    total = np.zeros((32, 32, 32))
    for x, deviation in ((16, 2), (18, 1)):
        squared = (((places - (x, 16, 16)) / deviation)**2).sum(-1)
        total += np.where(squared <= 9, np.log(2) * np.exp(-squared / 2), 0)
    np.testing.assert_array_equal(dag.to_dense(), total >= -np.log(0.7))
    assert len(voxdag.import_file(tmp_path / "s.ply", points=True, resolution=32)) == 2
    with pytest.warns(UserWarning, match="1 splats left out"):
        voxdag.import_file(tmp_path / "s.ply", **{**options, "max_scale": 1.5})
    for wrong in ({"opacity": 0}, {"min_scale": -1}, {"max_scale": np.inf}):
        with pytest.raises(ValueError):
            voxdag.import_file(tmp_path / "s.ply", **{**options, **wrong})


def test_a_capsule_carves_its_room():
    room = np.zeros((32, 32, 32), bool)
    room[2:20, 2:20, 2:20] = True
    room[4:18, 4:18, 4:18] = False
    dag = voxdag.from_dense(room)
    wall = dag.carve((10, 10, 10), (4, 1)).to_dense()
    expected = np.zeros_like(room)
    expected[3:19, 3:19, 3:19] = True
    expected[4:18, 4:18, 4:18] = False
    np.testing.assert_array_equal(wall, expected)
    np.testing.assert_array_equal(dag.carve((10, 10, 10), (4, 1), up="z", solid=True).to_dense(), expected)
    for wrong in ({"capsule": (0, 1)}, {"capsule": (40, 1)}, {"start": (3, 3, 3)}, {"up": "w"}):
        with pytest.raises(ValueError):
            dag.carve(**{"start": (10, 10, 10), "capsule": (4, 1), **wrong})
