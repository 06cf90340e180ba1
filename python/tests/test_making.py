"""Making DAGs from arrays, points and meshes, against NumPy."""
import numpy as np
import pytest

import voxdag
from shapes import CUBE, CUBE_FACES, as_set, random_coords


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


def test_colors_of_8_bits_in_16():
    expected = voxdag.from_coords([[1, 2, 3]], colors=np.array([[255, 0, 51]], np.uint8)).colors([[1, 2, 3]])
    with pytest.warns(UserWarning, match="16-bit colours are taken as 0 to 255"):
        dag = voxdag.from_coords([[1, 2, 3]], colors=np.array([[255, 0, 51]], np.uint16))
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


@pytest.mark.parametrize("call, reason", [
    (lambda: voxdag.build(CUBE, CUBE_FACES, resolution=8, pitch=1), "resolution or pitch, not both"),
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


def test_rays_make_occupied_and_free_voxels():
    ends = np.array([[7.5, 0.5, 0.5], [0.5, 6.5, 0.5], [0.5, 0.5, 30.0]])
    box = ((0, 0, 0), (8, 8, 8))
    occupied, free = voxdag.carve_rays([0.5, 0.5, 0.5], ends, pitch=1.0, bounds=box)
    assert sorted(occupied.coords().tolist()) == [[0, 6, 0], [7, 0, 0]]
    assert len(free) == 7 + 5 + 7 and (occupied & free).coords().size == 0
    occupied, free = voxdag.carve_rays(np.full((3, 3), 0.5), ends, pitch=1.0, bounds=box, hits=[True, False, True])
    assert occupied.coords().tolist() == [[7, 0, 0]]
    assert free.contains([[0.5, 6.5, 0.5], [7.5, 0.5, 0.5]]).tolist() == [True, False]


@pytest.mark.parametrize("arguments, message", [
    (([[0, 0, 0]] * 2, [[1, 1, 1]] * 3, None), "an origin each"),
    (([0, 0, 0], [[1, 1, 1]], [True, False]), "whether they hit"),
    (([0, 0, 0], [[1, np.nan, 1]], None), "ray 0 is not finite"),
])
def test_rays_that_are_none_are_refused(arguments, message):
    origins, ends, hits = arguments
    with pytest.raises(ValueError, match=message):
        voxdag.carve_rays(origins, ends, pitch=1.0, hits=hits)


class OnlyDlpack:
    """A tensor of a library that NumPy does not know."""

    def __init__(self, array, device=(1, 0)):
        self.array, self.device = array, device

    def __dlpack__(self, **_):
        return self.array.__dlpack__()

    def __dlpack_device__(self):
        return self.device


class OnlyInterface:
    def __init__(self, array):
        self.array, self.__array_interface__ = array, array.__array_interface__


@pytest.mark.parametrize("tensor", [OnlyDlpack, OnlyInterface])
def test_tensors_of_other_libraries_are_arrays(tensor):
    coords = np.array([[1, 2, 3], [4, 5, 6]], np.int32)
    dag = voxdag.from_coords(tensor(coords), colors=tensor(np.full((2, 3), 9, np.uint8)))
    assert dag.coords().tolist() == coords.tolist()
    assert dag.contains(tensor(np.array([[1.5, 2.5, 3.5], [0, 0, 0]]))).tolist() == [True, False]


def test_arrays_go_to_other_libraries_without_a_copy():
    coords = voxdag.from_coords([[1, 2, 3]]).coords()
    assert np.shares_memory(np.from_dlpack(OnlyDlpack(coords)), coords)
