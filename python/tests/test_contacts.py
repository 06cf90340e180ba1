"""Contacts: each answer is computed again from the coordinates."""
import numpy as np
import pytest

import voxdag
from shapes import random_coords

COORDS = random_coords(16, 40)
PITCH, ORIGIN = 0.25, np.array([-1.0, 2, 5])


def make():
    return voxdag.from_coords(COORDS, resolution=16, pitch=PITCH, origin=tuple(ORIGIN))


def random_points(count, seed):
    return ORIGIN + np.random.default_rng(seed).uniform(-4, 20, (count, 3)) * PITCH


def gaps(points):
    """Returns the distances from points to the nearest voxels, and the nearest points of these."""
    low = ORIGIN + COORDS * PITCH
    nearest = np.clip(points[:, None], low, low + PITCH)
    distances = np.linalg.norm(points[:, None] - nearest, axis=2)
    best = distances.argmin(axis=1)
    rows = np.arange(len(points))
    return distances[rows, best], nearest[rows, best]


def test_closest_and_overlap():
    dag, points = make(), random_points(200, 1)
    least, nearest = gaps(points)
    found = dag.closest(points, 0.3)
    np.testing.assert_allclose(found["distance"], least - 0.3, atol=1e-12)
    np.testing.assert_allclose(found["point"] + found["normal"] * least[:, None], points, atol=1e-12)
    np.testing.assert_array_equal(dag.overlap(points, 0.3), least <= 0.3)
    radii = np.linspace(0, 1, 200)
    np.testing.assert_array_equal(dag.overlap(points, radii), least <= radii)
    near = dag.closest(points.astype(np.float32), most=0.5)
    assert ((near["voxel"] >= 0).all(axis=1) == (gaps(points.astype(np.float32))[0] <= 0.5)).all()
    # A capsule touches what the spheres along it touch.
    ends = points[::-1]
    along = points[None] + np.linspace(0, 1, 50)[:, None, None] * (ends - points)
    spheres = np.array([dag.overlap(p, 0.3) for p in along]).any(axis=0)
    assert (dag.overlap(points, 0.3, to=ends) >= spheres).all()
    assert (dag.overlap(points, 0.29, to=ends) <= np.array([dag.overlap(p, 0.31) for p in along]).any(axis=0)).all()


def test_sweeps_end_in_contact():
    dag, points = make(), random_points(300, 2)
    motions = np.random.default_rng(3).uniform(-4, 4, (300, 3))
    hits = dag.sweep(points, motions, 0.2)
    is_hit = np.isfinite(hits["t"])
    starts_free = gaps(points)[0] > 0.2
    assert is_hit.sum() > 30
    ends = points + motions * np.minimum(hits["t"], 1)[:, None]
    np.testing.assert_allclose(gaps(ends)[0][is_hit & starts_free], 0.2, atol=1e-8)
    for part in np.linspace(0, 1, 30):
        before = points + motions * part * np.minimum(hits["t"], 1)[:, None]
        assert (gaps(before)[0][starts_free] > 0.2 - 1e-8).all()
    one = dag.sweep(points[:1], motions, 0.2)  # one row for all
    assert one["t"].shape == (300,) and one["normal"].shape == (300, 3)


def test_boxes():
    dag, points = make(), random_points(300, 4)
    half = np.array([[0.5, 0.25, 0.125]])
    low = ORIGIN + COORDS * PITCH
    apart = np.maximum(low - (points[:, None] + half), (points[:, None] - half) - (low + PITCH))
    np.testing.assert_array_equal(dag.overlap_box(points, half), (apart.max(axis=2) <= 0).any(axis=1))
    # A turn by 90 degrees about z swaps x and y.
    turned = dag.overlap_box(points, half, [[0, 0, 1, 1]])
    np.testing.assert_array_equal(turned, dag.overlap_box(points, half[:, [1, 0, 2]]))


def test_signed_distances():
    dag = voxdag.from_dense(np.ones((8, 8, 8), bool), pitch=0.5)
    points = np.array([[2, 2, 1.25], [2, 2, -3], [2, 2, 5.5], [0.5, 2, 2]])
    distances, gradients = dag.signed_distance(points, gradient=True)
    np.testing.assert_allclose(distances, [-1.25, 3, 1.5, -0.5])
    np.testing.assert_allclose(gradients, [[0, 0, -1], [0, 0, -1], [0, 0, 1], [-1, 0, 0]])
    np.testing.assert_allclose(dag.signed_distance(points, most=1), [-1, 1, 1, -0.5])
    # In windows: the points are the centres of the places.
    window = ((-2, 0, 1), (5, 6, 7))
    places = np.stack(np.meshgrid(*(np.arange(a, b) for a, b in zip(*window)), indexing="ij"), -1)
    centres = np.array(dag.origin) + (places.reshape(-1, 3) + 0.5) * dag.voxel_size
    field = dag.signed_distance(centres).reshape(places.shape[:3])
    np.testing.assert_allclose(field[2:], dag.distance_field(((0, 0, 1), (5, 6, 7)), signed=True), rtol=1e-6)


def test_snapshots_answer_as_their_dag():
    dag = voxdag.from_dense(np.ones((16, 16, 16), bool))
    with dag.edit() as edit:
        edit.remove_ball((8, 8, 16), 6)
        snapshot, edited = edit.snapshot(), edit.dag()
    points = np.random.default_rng(5).uniform(-2, 18, (300, 3))
    np.testing.assert_array_equal(snapshot.signed_distance(points), edited.signed_distance(points))
    np.testing.assert_array_equal(snapshot.sweep(points, [[0, 0, -9]], 1)["t"],
                                  edited.sweep(points, [[0, 0, -9]], 1)["t"])
    assert snapshot.overlap([[8, 8, 16]], 1)[0] == edited.overlap([[8, 8, 16]], 1)[0] == False  # noqa: E712


def test_wrong_shapes_are_refused():
    dag = make()
    with pytest.raises(ValueError, match="shape 1: a point is not finite"):
        dag.overlap([[0, 0, 0], [0, np.nan, 0]])
    with pytest.raises(ValueError, match="shape 0: the radius is negative"):
        dag.closest([[0, 0, 0]], -1)
    with pytest.raises(ValueError, match="points, radius and to must have as many rows"):
        dag.overlap(np.zeros((2, 3)), [1, 2, 3])
    with pytest.raises(ValueError, match="points and motion must have as many rows"):
        dag.sweep(np.zeros((2, 3)), np.zeros((3, 3)))
    with pytest.raises(ValueError, match="radius must be a number"):
        dag.overlap(np.zeros((2, 3)), [[1], [2]])
    with pytest.raises(ValueError, match="turn must have the shape"):
        dag.overlap_box([[0, 0, 0]], [[1, 1, 1]], [[0, 0, 1]])
    with pytest.raises(ValueError, match="quaternion"):
        dag.overlap_box([[0, 0, 0]], [[1, 1, 1]], [[0, 0, 0, 0]])
    with pytest.raises(TypeError, match="must be numbers"):
        dag.overlap(np.zeros((2, 3), complex))
    with pytest.raises(ValueError, match="limit of distances is negative"):
        dag.signed_distance([[0, 0, 0]], most=-1)
