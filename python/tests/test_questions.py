"""Questions about voxels: each answer is computed again from the coordinates."""
import numpy as np
import pytest

import voxdag
from shapes import CUBE, CUBE_FACES, as_set, random_coords


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
