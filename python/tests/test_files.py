"""Files that DAGs come from and go to, and pictures."""
import copy
import pickle

import numpy as np
import pytest

import voxdag
from shapes import CUBE, CUBE_FACES, as_set, random_coords, write_cube


def test_imports_files(tmp_path):
    coords = random_coords(16, 70)
    dag = voxdag.from_coords(coords, resolution=16, colors=coords * 15, pitch=0.5, origin=(1, 2, 3))
    dag.export(tmp_path / "a.ply")
    dag.export(tmp_path / "a.vox")
    assert voxdag.import_file(tmp_path / "a.ply") == dag
    again = voxdag.import_file(tmp_path / "a.vox")
    assert again == dag and again.info["has_colors"]
    assert not voxdag.import_file(tmp_path / "a.vox", colors=False).info["has_colors"]
    (tmp_path / "a.xyz").write_text("0 0 0\n1 0 nan\n2 0 0\n")
    with pytest.warns(UserWarning, match="a.xyz: 1 points left out"):
        dag = voxdag.import_file(tmp_path / "a.xyz", pitch=1)
    assert dag.coords().tolist() == [[0, 0, 0], [2, 0, 0]]
    with pytest.warns(UserWarning, match="points: 1 points left out"):
        assert len(voxdag.from_points([[0, 0, 0], [1, 0, np.nan]], pitch=1)) == 1
    with pytest.raises(OSError, match="a.xyz: holds points, which need"):
        voxdag.import_file(tmp_path / "a.xyz")
    np.save(tmp_path / "v.npy", np.arange(8).reshape(2, 2, 2))
    assert len(voxdag.import_file(tmp_path / "v.npy", threshold=5)) == 3


def test_exports(tmp_path):
    coords = random_coords(16, 70)
    dag = voxdag.from_coords(coords, resolution=16, colors=coords * 15)
    assert dag.export(tmp_path / "a.npy", colors=False) == [tmp_path / "a.npy"]
    assert as_set(np.load(tmp_path / "a.npy")) == as_set(coords)
    for name in ("a.glb", "a.obj", "a.stl", "a.vox", "a.binvox", "a.schem", "a.voxel.json", "a.ply"):
        dag.export(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 0
    dag.export(tmp_path / "slices", slices="z", window=((0, 0, 2), (16, 16, 5)))
    assert len(list((tmp_path / "slices").glob("*.png"))) == 3
    with pytest.raises(ValueError, match="the extension must be .*.glb"):
        dag.export(tmp_path / "a.xyz")


def test_files(tmp_path):
    dag = voxdag.from_coords(random_coords(64, 500), resolution=64)
    for compact in (False, True):
        dag.save(tmp_path / "a.vdag", compact=compact)
        assert voxdag.open(tmp_path / "a.vdag") == dag
    with pytest.raises(OSError, match="nothing.vdag: cannot open: No such file"):
        voxdag.open(tmp_path / "nothing.vdag")
    with pytest.raises(OSError, match="a.vdag: .*does not exist"):
        dag.save(tmp_path / "no" / "a.vdag")
    for name in ("a.glb", "a.GLB", "a.npy", "a.html", "a.esvo"):
        for compact in (False, True):
            with pytest.raises(OSError, match=name + ": .*voxdag export"):
                dag.save(tmp_path / name, compact=compact)
        assert not (tmp_path / name).exists()
    dag.save(tmp_path / "a.bin")
    (tmp_path / "bad.vdag").write_bytes(b"x" * 100)
    with pytest.raises(OSError, match="bad.vdag"):
        voxdag.open(tmp_path / "bad.vdag")


def test_mesh_files(tmp_path):
    lines = [f"v {x} {y} {z}" for x, y, z in CUBE] + [f"f {a + 1} {b + 1} {c + 1}"
                                                      for a, b, c in CUBE_FACES]
    path = tmp_path / "cube.obj"
    path.write_text("\n".join(lines) + "\n")
    assert voxdag.build_mesh(path, resolution=32) == voxdag.build(CUBE, CUBE_FACES, resolution=32)
    # The file says how to build it again: `voxdag verify --mesh` does.
    voxdag.build_mesh(path, pitch=0.1, solid="winding").save(tmp_path / "cube.vdag")
    about = (tmp_path / "cube.vdag").read_bytes()
    for part in (b'"scale_from":"voxel_size"', b'"solid":"winding"', b'"winding_threshold":"0.5"'):
        assert part in about
    path.write_text("v 0 0 0\nf 1 2 99\n")
    with pytest.raises(OSError, match=r"cube.obj: line 2"):
        voxdag.build_mesh(path, resolution=32)


def test_load_takes_any_file(tmp_path):
    write_cube(tmp_path / "cube.obj")
    mesh = voxdag.load(tmp_path / "cube.obj", resolution=16)
    assert mesh == voxdag.build_mesh(tmp_path / "cube.obj", resolution=16)
    mesh.save(tmp_path / "cube.vdag")
    assert voxdag.load(tmp_path / "cube.vdag") == mesh
    (tmp_path / "p.xyz").write_text("0 0 0\n1 2 3\n")
    assert voxdag.load(tmp_path / "p.xyz", resolution=8).resolution == 8
    assert len(voxdag.load(tmp_path / "p.xyz", pitch=1.0)) == 2
    assert voxdag.load(tmp_path / "p.xyz").resolution == 1024
    mesh.export(tmp_path / "points.ply")
    assert voxdag.load(tmp_path / "points.ply") == mesh
    mesh.export(tmp_path / "cube.vox")
    assert voxdag.load(tmp_path / "cube.vox") == mesh
    assert voxdag.load(tmp_path / "cube.obj", pitch=0.25).voxel_size == 0.25
    for read in (voxdag.load, voxdag.build_mesh):
        with pytest.raises(OSError, match="none.obj"):
            read(tmp_path / "none.obj")
    assert voxdag.build_mesh(tmp_path / "cube.obj").resolution == 1024
    assert voxdag.from_points([[0, 0, 0], [1, 2, 3]]).resolution == 1024
    assert voxdag.build(CUBE, CUBE_FACES).resolution == 1024


def test_pickles():
    coords = random_coords(16, 100)
    dag = voxdag.from_coords(coords, colors=coords * 15, pitch=0.5)
    again = pickle.loads(pickle.dumps(dag))
    assert again == dag and again.origin == dag.origin
    np.testing.assert_array_equal(again.colors(coords), dag.colors(coords))
    assert copy.deepcopy(dag) == dag


def test_pictures():
    dag = voxdag.build(CUBE, CUBE_FACES, resolution=16)
    picture = dag.render(width=80, height=60, eye=(3, 2, 4), target=(0.5, 0.5, 0.5))
    assert picture.shape == (60, 80, 3) and picture.dtype == np.uint8
    assert picture.std() > 10
    assert "16³" in repr(dag)
