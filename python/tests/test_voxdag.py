"""The Python module against NumPy: each answer is computed again from the coordinates."""
import _thread
import ast
import copy
import pickle
import threading
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

import voxdag


def random_coords(side, count, seed=1):
    coords = np.random.default_rng(seed).integers(0, side, (count, 3), dtype=np.int32)
    return np.unique(coords, axis=0)


def as_set(coords):
    return set(map(tuple, np.asarray(coords).tolist()))


CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
CUBE_FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7],
                       [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])


def test_meshes_and_rays_far_from_zero_keep_their_digits():
    place = np.array([500_000.0, 4_649_776.0, 100.0])
    near = voxdag.build(CUBE * 0.37 + 0.1125, CUBE_FACES, resolution=64, bounds=((0, 0, 0), (1, 1, 1)))
    far = voxdag.build(CUBE * 0.37 + 0.1125 + place, CUBE_FACES, resolution=64,
                       bounds=(tuple(place), tuple(place + 1)))
    assert as_set(near.coords()) == as_set(far.coords())
    centres = (near.coords() + 0.5) / 64
    assert far.contains(centres + place).all()
    along = np.array([[0.0, 0.0, 1.0]])
    start = centres * [1, 1, 0] - [0, 0, 1]
    assert (near.cast(start, along)["voxel"] == far.cast(start + place, along)["voxel"]).all()


def test_coords_come_back():
    coords = random_coords(64, 500)
    dag = voxdag.from_coords(coords, resolution=64)
    assert dag.resolution == 64 and len(dag) == len(coords)
    assert as_set(dag.coords()) == as_set(coords)
    window = ((3, 5, 7), (40, 41, 42))
    inside = np.all((coords >= window[0]) & (coords < window[1]), axis=1)
    assert as_set(dag.coords(window)) == as_set(coords[inside])


def test_dense_comes_back():
    dense = np.random.default_rng(2).random((20, 33, 9)) < 0.2
    dag = voxdag.from_dense(dense)
    assert dag.resolution == 64
    np.testing.assert_array_equal(dag.to_dense(((0, 0, 0), dense.shape)), dense)
    assert dag.to_dense().shape == (64, 64, 64)


def test_points_set_their_voxels():
    points = np.random.default_rng(3).uniform(-2, 5, (1000, 3))
    dag = voxdag.from_points(points, pitch=0.25, bounds=((-2, -2, -2), (5, 5, 5)))
    expected = np.floor((points - dag.origin) / 0.25).astype(int)
    assert as_set(dag.coords()) == as_set(expected)
    assert dag.contains(points).all()
    assert not dag.contains([[100, 0, 0], [np.nan, 0, 0], [-1e300, 0, 0]]).any()


def test_colors():
    coords = random_coords(16, 100)
    colors = np.random.default_rng(4).integers(0, 256, coords.shape, dtype=np.uint8)
    dag = voxdag.from_coords(coords, resolution=16, colors=colors)
    assert dag.info["has_colors"]
    # Colours are stored with a bounded error: see docs/attributes.md.
    assert np.abs(dag.colors(coords).astype(int) - colors).mean() < 12
    hits = dag.cast(coords + 0.5, [[0, 0, 1]])
    np.testing.assert_array_equal(hits["voxel"], coords)
    np.testing.assert_array_equal(hits["color"], dag.colors(coords))
    with pytest.raises(ValueError, match="no colours"):
        voxdag.from_coords(coords).colors(coords)


@pytest.mark.parametrize("colors", [
    np.array([[255, 0, 51]], np.uint8), np.array([[65535, 0, 13107]], np.uint16),
    np.array([[1, 0, 0.2]]), np.array([[1, 0, 0.2]], np.float32), np.array([[1.0000001, -1e-9, 0.2]]),
    np.array([[255, 0, 51]]), [[255, 0, 51]]])
def test_colors_of_every_type(colors):
    expected = voxdag.from_coords([[1, 2, 3]], colors=np.array([[255, 0, 51]], np.uint8)).colors([[1, 2, 3]])
    dag = voxdag.from_points([[1.5, 2.5, 3.5]], pitch=1, bounds=((0, 0, 0), (4, 4, 4)), colors=colors)
    np.testing.assert_array_equal(dag.colors([[1, 2, 3]]), expected)


@pytest.mark.parametrize("call, reason", [
    (lambda: voxdag.from_coords([[np.nan, 0, 0]]), "coords has nan, which must be a whole number"),
    (lambda: voxdag.from_coords([[1.9, 0, 0]]), "coords has 1.9"),
    (lambda: voxdag.from_coords([[2 ** 32 + 1, 0, 0]]), "coords has 4294967297"),
    (lambda: voxdag.from_coords(np.array([[2 ** 63 + 1, 0, 0]], np.uint64)), "coords has 9223372036854775809"),
    (lambda: voxdag.build(CUBE, CUBE_FACES + 0.5, resolution=8), "faces has 0.5"),
    (lambda: voxdag.from_coords([[1, 2, 3]], colors=[[256, 0, 0]]), "colors has 256"),
    (lambda: voxdag.from_coords([[1, 2, 3]], colors=[[-1, 0, 0]]), "colors has -1"),
    (lambda: voxdag.from_coords([[1, 2, 3]], colors=[[255.0, 0, 0]]), "colors has 255.0, .* 0 to 1"),
    (lambda: voxdag.from_coords([[1, 2, 3]], colors=[[np.nan, 0, 0]]), "colors has nan"),
    (lambda: voxdag.from_coords([[1, 2, 3]], pitch=0), "pitch must be positive"),
    (lambda: voxdag.from_coords([[1, 2, 3]], origin=(0, 0, np.inf)), "origin must be finite"),
])
def test_values_that_do_not_fit_are_refused(call, reason):
    with pytest.raises(ValueError, match=reason):
        call()


@pytest.mark.parametrize("call, reason", [
    (lambda: voxdag.from_points([["a", "b", "c"]], pitch=1), "points has the type <U1"),
    (lambda: voxdag.from_points(np.zeros((1, 3), complex), pitch=1), "points has the type complex"),
    (lambda: voxdag.from_coords([[True, False, True]]), "coords has the type bool"),
    (lambda: voxdag.from_coords([[1, 2, 3]], colors=[[True, False, True]]), "colors has the type bool"),
    (lambda: voxdag.from_dense(np.full((2, 2, 2), np.nan)), "compare real ones, dense > 0.5"),
    (lambda: voxdag.build(CUBE.astype(complex), CUBE_FACES, resolution=8), "vertices has the type"),
    (lambda: voxdag.from_coords([[1, 2, 3]]).nearest([[None, 1, 2]]), "points has the type object"),
    (lambda: voxdag.from_coords([[1, 2, 3]]).cast([[0, 0, 0]], [["x", "y", "z"]]), "directions has the type"),
    (lambda: voxdag.from_dense(np.ma.masked_equal(np.ones((2, 2, 2), int), 1)), "masked values"),
    (lambda: voxdag.from_points(np.ma.masked_greater([[1, 2, 3.0]], 2), pitch=1), "masked values"),
])
def test_types_that_do_not_fit_are_type_errors(call, reason):
    with pytest.raises(TypeError, match=reason):
        call()


def test_masked_arrays_without_masked_values_are_arrays():
    assert len(voxdag.from_dense(np.ma.masked_equal(np.ones((2, 2, 2), int), 7))) == 8


def test_coords_and_dense_arrays_have_a_place():
    for dag in (voxdag.from_dense(np.ones((2, 2, 2), bool), pitch=0.5, origin=(1, 2, 3)),
                voxdag.from_coords(np.argwhere(np.ones((2, 2, 2))), pitch=0.5, origin=(1, 2, 3))):
        assert dag.voxel_size == 0.5 and dag.origin == (1, 2, 3) and len(dag) == 8
        assert dag.contains([[1.9, 2.9, 3.9], [0.9, 2, 3]]).tolist() == [True, False]
    assert voxdag.from_dense(np.array([[[0, 3]]])).coords().tolist() == [[0, 0, 1]]


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
    for edit in (lambda: dag.dilate(), lambda: dag.fill_cavities(),
                 lambda: dag | voxdag.from_coords(coords, resolution=16)):
        with pytest.warns(UserWarning, match="no colours"):
            assert not edit().info["has_colors"]


def test_pickles():
    coords = random_coords(16, 100)
    dag = voxdag.from_coords(coords, colors=coords * 15, pitch=0.5)
    again = pickle.loads(pickle.dumps(dag))
    assert again == dag and again.origin == dag.origin
    np.testing.assert_array_equal(again.colors(coords), dag.colors(coords))
    assert copy.deepcopy(dag) == dag


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


def test_a_cube():
    shell = voxdag.build(CUBE, CUBE_FACES, resolution=16)
    solid = voxdag.build(CUBE, CUBE_FACES, resolution=16, solid=True)
    assert len(solid) == 16 ** 3 and len(shell) == 16 ** 3 - 14 ** 3
    inside = solid - shell
    assert len(inside) == 14 ** 3
    assert (shell | inside) == solid and (solid & inside) == inside and len(solid ^ solid) == 0
    assert shell.fill_cavities() == solid
    assert inside.dilate() == solid and solid.erode() == inside
    for rule in ("parity", "winding", "flood"):
        assert voxdag.build(CUBE, CUBE_FACES, resolution=16, solid=rule) == solid


def test_operators_align_grids():
    a = voxdag.from_coords(np.array([[1, 2, 3]]), resolution=8)
    b = voxdag.from_coords(np.array([[1, 2, 3], [15, 0, 0]]), resolution=16)
    assert as_set((a | b).coords()) == {(1, 2, 3), (15, 0, 0)}
    assert as_set((b - a).coords()) == {(15, 0, 0)}
    with pytest.raises(ValueError, match="the grids do not align"):
        a | voxdag.build(CUBE, CUBE_FACES, resolution=8)


def test_rays():
    dag = voxdag.build(CUBE, CUBE_FACES, resolution=64)
    size = dag.voxel_size
    hits = dag.cast([[0.5, 0.5, -2], [0.5, 0.5, 3], [5, 5, -2]], [[0, 0, 1], [0, 0, -2], [0, 0, 1]])
    np.testing.assert_allclose(hits["t_hit"], [2, (3 - 64 * size) / 2, np.inf], rtol=1e-6)
    np.testing.assert_array_equal(hits["face"], [4, 5, -1])
    np.testing.assert_array_equal(hits["voxel"][:, 2], [0, 63, -1])
    assert dag.cast([[0.5, 0.5, -2]], [[0, 0, 1]], t_max=1)["t_hit"][0] == np.inf
    np.testing.assert_array_equal(
        dag.occluded([[0.5, 0.5, -2]], [[0.5, 0.5, -1], [0.5, 0.5, 0.5]]), [False, True])


def test_nearest():
    coords = random_coords(32, 60)
    dag = voxdag.from_coords(coords, resolution=32)
    points = np.random.default_rng(5).uniform(-10, 40, (200, 3))
    found = dag.nearest(points)
    below, above = coords[None] - points[:, None], points[:, None] - (coords[None] + 1)
    distances = np.linalg.norm(np.maximum(0, np.maximum(below, above)), axis=2)
    np.testing.assert_allclose(found["distance"], distances.min(axis=1), atol=1e-12)
    empty = voxdag.from_coords(np.zeros((0, 3)), resolution=8).nearest([[0, 0, 0]])
    assert empty["distance"][0] == np.inf and (empty["voxel"] == -1).all()


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
    assert dag.rotate("z", -3) == dag.rotate("z") and dag.rotate("x", 4) == dag
    coarse = dag.coarsen(8)
    assert as_set(coarse.coords()) == as_set(coords // 4)
    assert coarse.voxel_size == 4 * dag.voxel_size and coarse.origin == dag.origin


def test_components():
    coords = np.array([[0, 0, 0], [1, 1, 1], [5, 5, 5], [5, 5, 6], [5, 6, 6], [9, 0, 9]])
    dag = voxdag.from_coords(coords, resolution=16)
    np.testing.assert_array_equal(dag.components(), [[3, 1], [2, 1], [1, 1]])
    np.testing.assert_array_equal(dag.components(neighbours=6), [[3, 1], [1, 3]])
    assert as_set(dag.keep_components(2).coords()) == as_set(coords[:5])


def test_heights_and_surface():
    coords = random_coords(16, 70)
    dag = voxdag.from_coords(coords, resolution=16)
    dense = dag.to_dense()
    for axis, name in enumerate("xyz"):
        columns = np.moveaxis(dense, axis, 2)
        low = np.where(columns.any(axis=2), columns.argmax(axis=2), -1)
        high = np.where(columns.any(axis=2), 15 - columns[:, :, ::-1].argmax(axis=2), -1)
        np.testing.assert_array_equal(dag.heights(name, low=True), low)
        np.testing.assert_array_equal(dag.heights(name), high)
    padded = np.pad(dense, 1)
    faces = tuple(int(np.abs(np.diff(padded.astype(np.int8), axis=axis)).sum()) for axis in range(3))
    assert dag.surface() == {"faces": faces, "area": sum(faces), "volume": len(dag)}


def test_distance_field():
    coords = random_coords(16, 12)
    points = voxdag.from_points(coords * 0.5, pitch=0.5, bounds=((0, 0, 0), (8, 8, 8)))
    window = ((2, 3, 4), (9, 16, 8))
    field = points.distance_field(window)
    places = np.stack(np.meshgrid(*(np.arange(a, b) for a, b in zip(*window)), indexing="ij"), -1)
    away = np.abs(places[..., None, :] - points.coords()) - 0.5
    distances = np.linalg.norm(np.maximum(away, 0), axis=-1).min(axis=-1) * points.voxel_size
    np.testing.assert_allclose(field, distances, rtol=1e-6)
    assert field.shape == (7, 13, 4) and field.flags.c_contiguous


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
    with pytest.raises(OSError, match="a.vdag: .*No such file"):
        dag.save(tmp_path / "no" / "a.vdag")
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


def test_meshes_of_other_libraries():
    class Trimesh:
        vertices, faces = CUBE, CUBE_FACES

    class Open3D:
        vertices, triangles = CUBE, CUBE_FACES
        vertex_colors = CUBE

        def has_vertex_colors(self):
            return True

    expected = voxdag.build(CUBE, CUBE_FACES, resolution=16)
    assert voxdag.build(Trimesh(), resolution=16) == expected
    colored = voxdag.build(Open3D(), resolution=16)
    assert colored == expected and colored.info["has_colors"]
    corner = colored.colors([[15, 15, 15]])[0]
    assert (corner > 200).all()
    with pytest.raises(TypeError, match="trimesh"):
        voxdag.build(3, resolution=16)


def test_pictures():
    dag = voxdag.build(CUBE, CUBE_FACES, resolution=16)
    picture = dag.render(width=80, height=60, eye=(3, 2, 4), target=(0.5, 0.5, 0.5))
    assert picture.shape == (60, 80, 3) and picture.dtype == np.uint8
    assert picture.std() > 10
    assert dag._repr_png_().startswith(b"\x89PNG")
    assert "16³" in repr(dag)


def test_views_of_the_nodes_are_read_only():
    dag = voxdag.from_coords(random_coords(64, 500), resolution=64)
    assert dag.nodes.dtype == np.uint32 and dag.leaf_blocks.dtype == np.uint64
    assert dag.nodes.nbytes + dag.leaf_blocks.nbytes == dag.info["bytes"]
    nodes = dag.nodes
    first = int(nodes[0])
    del dag
    assert int(nodes[0]) == first  # the view keeps the DAG
    with pytest.raises(ValueError):
        nodes[0] = 0


@pytest.mark.parametrize("call, reason", [
    (lambda: voxdag.build(CUBE, CUBE_FACES), "exactly one of resolution and pitch"),
    (lambda: voxdag.build(CUBE, CUBE_FACES, resolution=2**20 + 1), "from 1 to 1048576"),
    (lambda: voxdag.build(CUBE, CUBE_FACES, resolution=-4), "from 1 to 1048576"),
    (lambda: voxdag.build(CUBE, CUBE_FACES, pitch=0), "pitch must be positive"),
    (lambda: voxdag.build(CUBE[:, :2], CUBE_FACES, resolution=8), "vertices must have the shape"),
    (lambda: voxdag.build(CUBE, CUBE_FACES + 7, resolution=8), "has the index"),
    (lambda: voxdag.build(CUBE * np.nan, CUBE_FACES, resolution=8), "is not finite"),
    (lambda: voxdag.build(CUBE, CUBE_FACES, resolution=8, solid="x"), "solid must be"),
    (lambda: voxdag.build(CUBE, CUBE_FACES[1:], resolution=8, solid=True), "not closed"),
    (lambda: voxdag.from_coords([[9, 0, 0]], resolution=8), "outside of the grid"),
    (lambda: voxdag.from_dense(np.ones((3, 3))), "three dimensions"),
    (lambda: voxdag.from_points(np.zeros((0, 3)), resolution=8), "no points"),
    (lambda: voxdag.from_points([[0, 0, np.inf]], resolution=8), "not finite"),
    (lambda: voxdag.from_coords([[0, 0, 0]]).coords(((0, 0, 0), (9, 9, 9))), "window must be"),
    (lambda: voxdag.from_coords([[0, 0, 0]]).render(width=0), "width and height"),
    (lambda: voxdag.from_coords([[0, 0, 0]]).mirror("xy"), "axis must be"),
    (lambda: voxdag.from_coords([[0, 0, 0]]).coarsen(3), "resolution must be a power of two"),
    (lambda: voxdag.from_coords([[0, 0, 0]]).coarsen(8), "resolution exceeds"),
    (lambda: voxdag.from_coords([[0, 0, 0]]).crop(((0, 0, 0), (0, 1, 1))), "window must be"),
])
def test_bad_arguments_are_value_errors(call, reason):
    with pytest.raises(ValueError, match=reason):
        call()


def test_the_stubs_name_everything():
    stubs = ast.parse((Path(voxdag.__file__).parent / "__init__.pyi").read_text())
    functions = {node.name for node in stubs.body if isinstance(node, ast.FunctionDef)}
    assert functions | {"Dag"} == set(voxdag.__all__)
    dag = next(n for n in stubs.body if isinstance(n, ast.ClassDef) and n.name == "Dag")
    members = {n.name for n in dag.body if not n.name.startswith("_")}
    assert members == {name for name in dir(voxdag.Dag) if not name.startswith("_")}


def test_other_threads_run_and_ctrl_c_works():
    coords = random_coords(1 << 12, 200_000)
    ticks = []

    def tick():
        while len(ticks) < 5:
            ticks.append(time.monotonic())
            time.sleep(0.01)
        _thread.interrupt_main()

    points = np.random.default_rng(6).uniform(0, 1 << 12, (4_000_000, 3))
    dag = voxdag.from_coords(coords, resolution=1 << 12)
    thread = threading.Thread(target=tick)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        dag.nearest(points)
    thread.join()
    assert len(ticks) == 5


def write_cube(path):
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in CUBE) +
                    "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in CUBE_FACES))


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
    with pytest.raises(OSError, match="none.obj"):
        voxdag.load(tmp_path / "none.obj")


def test_bounds_centre_volume_and_arrays():
    coords = random_coords(30, 200) + 2
    dag = voxdag.from_coords(coords, resolution=64, pitch=0.5, origin=(10, 0, -5))
    low, high = dag.bounds
    np.testing.assert_allclose(low, np.array([10, 0, -5]) + coords.min(0) * 0.5)
    np.testing.assert_allclose(high, np.array([10, 0, -5]) + (coords.max(0) + 1) * 0.5)
    np.testing.assert_allclose(dag.centre, np.array([10, 0, -5]) + (coords.mean(0) + 0.5) * 0.5)
    assert dag.volume == len(coords) / 8 and dag.shape == (64, 64, 64)
    np.testing.assert_array_equal(np.asarray(dag), dag.to_dense())
    empty = dag - dag
    assert empty.bounds is None and empty.centre is None and empty.volume == 0
    assert voxdag.__version__.count(".") == 2


def test_the_mesh_of_a_dag_encloses_its_voxels():
    dag = voxdag.from_coords(random_coords(16, 300), resolution=16, pitch=0.25, origin=(3, 4, 5))
    vertices, faces = dag.to_mesh()
    assert len(faces) == 2 * sum(dag.surface()["faces"])
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(dag.volume)
    window = ((0, 0, 0), (8, 16, 16))
    assert dag.to_mesh(window)[0][:, 0].max() <= 3 + 8 * 0.25


def test_signed_distances_are_negative_in_voxels():
    dag = voxdag.from_dense(np.ones((4, 4, 4), bool))
    signed = dag.crop(((0, 0, 0), (3, 4, 4))).distance_field(signed=True)
    assert signed[3, 0, 0] == 0.5 and signed[0, 0, 0] == -0.5 and signed[1, 1, 1] == -1.5
    assert (dag.distance_field() == np.maximum(dag.distance_field(signed=True), 0)).all()


def test_unknown_arguments_are_answered_with_the_nearest(tmp_path):
    write_cube(tmp_path / "cube.obj")
    with pytest.raises(TypeError, match=r"build_mesh\(\) has no argument 'resolutoin': did you mean 'resolution'\?"):
        voxdag.build_mesh(tmp_path / "cube.obj", resolutoin=8)
    dag = voxdag.build_mesh(tmp_path / "cube.obj", resolution=8)
    with pytest.raises(TypeError, match=r"dilate\(\) has no argument 'neighbors': did you mean 'neighbours'\?"):
        dag.dilate(neighbors=6)
    with pytest.raises(TypeError, match="incompatible"):
        dag.dilate("two")
