"""Dag.edit(), against the same edits of dense arrays."""
import threading

import numpy as np
import pytest

import voxdag
from shapes import as_set, random_coords

SIDE = 32
CENTRES = np.stack(np.meshgrid(*[np.arange(SIDE) + 0.5] * 3, indexing="ij"), axis=-1)


def scene(colors=False):
    coords = random_coords(SIDE, 4000)
    rgb = np.random.default_rng(5).integers(0, 256, coords.shape, dtype=np.uint8) if colors else None
    return voxdag.from_coords(coords, resolution=SIDE, colors=rgb)


def in_ball(center, radius):
    return ((CENTRES - center) ** 2).sum(axis=-1) <= radius ** 2


def in_box(lo, hi):
    return ((CENTRES >= lo) & (CENTRES < hi)).all(axis=-1)


def in_capsule(start, end, radius):
    along = np.subtract(end, start)
    t = np.clip(((CENTRES - start) @ along) / (along @ along), 0, 1)
    return ((CENTRES - start - t[..., None] * along) ** 2).sum(axis=-1) <= radius ** 2


def test_each_shape_adds_and_removes_its_voxels():
    dag = scene()
    before = dag.to_dense()
    quarter = (0, 0, np.sin(np.pi / 4), np.cos(np.pi / 4))
    for shape, arguments, inside in (
            ("ball", ((10, 11, 12), 6.25), in_ball((10, 11, 12), 6.25)),
            ("box", ((3, 4, 5), (20, 9, 30)), in_box((3, 4, 5), (20, 9, 30))),
            ("capsule", ((4, 4, 4), (25, 20, 9), 3), in_capsule((4, 4, 4), (25, 20, 9), 3)),
            ("half_space", ((16, 16, 16), (1, 0, 1)), (CENTRES - 16) @ (1, 0, 1) < 0),
            ("turned_box", ((16, 16, 16), (9, 4, 2), quarter), in_box((12, 7, 14), (20, 25, 18)))):
        with dag.edit() as e:
            getattr(e, "remove_" + shape)(*arguments)
            assert np.array_equal(e.dag().to_dense(), before & ~inside), shape
            getattr(e, "add_" + shape)(*arguments)
            assert np.array_equal(e.dag().to_dense(), before | inside), shape
    assert np.array_equal(dag.to_dense(), before), "the Dag stays as it is"


def test_arrays_are_many_edits_in_one_call():
    dag = scene()
    rng = np.random.default_rng(3)
    # Shapes are rounded to 1/256 voxel.
    centers = np.round(rng.uniform(0, SIDE, (20, 3)) * 256) / 256
    radii = np.round(rng.uniform(0, 6, 20) * 256) / 256
    expected = dag.to_dense()
    for center, radius in zip(centers, radii):
        expected &= ~in_ball(center, radius)
    e = dag.edit()
    e.remove_ball(centers, radii)
    assert e.undo_count == 20
    assert np.array_equal(e.dag().to_dense(), expected)
    e = dag.edit(history=3)
    e.remove_ball(centers, 2)  # One radius for all.
    assert [e.undo() for _ in range(4)] == [True] * 3 + [False] and e.redo_count == 3


def test_undo_and_redo():
    dag = scene()
    with dag.edit() as e:
        e.remove_ball((16, 16, 16), 9)
        carved = e.dag()
        e.add_box((0, 0, 0), (9, 9, 9))
        assert e.undo() and e.dag() == carved
        assert e.undo() and e.dag() == dag
        assert not e.undo()
        assert e.redo() and e.redo() and not e.redo()
        assert e.undo_count == 2 and e.redo_count == 0


def test_colors_are_painted_and_kept():
    dag = scene(colors=True)
    coords = dag.coords()
    before = dag.colors(coords)
    inside = in_ball((16, 16, 16), 7)
    with dag.edit() as e:
        e.paint_ball((16, 16, 16), 7, color=(255, 128, 1))
        e.add_box((0, 0, 0), (4, 4, 4), color=[(1, 2, 3)])
        edited = e.dag()
    is_new = ~dag.to_dense() & in_box((0, 0, 0), (4, 4, 4))
    for voxel, color in zip(coords, before):
        expected = (255, 128, 1) if inside[tuple(voxel)] else tuple(color)
        assert tuple(edited.colors([voxel])[0]) == expected
    assert (edited.colors(np.argwhere(is_new)) == (1, 2, 3)).all()
    e = dag.edit()
    e.paint_ball([(8, 8, 8), (24, 24, 24)], 3, color=np.array([[255, 0, 0], [0, 255, 0]], np.uint8))
    for center, color in (((8, 8, 8), (255, 0, 0)), ((24, 24, 24), (0, 255, 0))):
        voxels = [v for v in coords if in_ball(center, 3)[tuple(v)]]
        assert (e.dag().colors(voxels) == color).all()


def test_replace_gives_old_and_new_voxels_the_color_in_one_edit():
    dag = scene(colors=True)
    quarter = (0, 0, np.sin(np.pi / 4), np.cos(np.pi / 4))
    for shape, arguments, inside in (
            ("ball", ((10, 11, 12), 6.25), in_ball((10, 11, 12), 6.25)),
            ("box", ((3, 4, 5), (20, 9, 30)), in_box((3, 4, 5), (20, 9, 30))),
            ("capsule", ((4, 4, 4), (25, 20, 9), 3), in_capsule((4, 4, 4), (25, 20, 9), 3)),
            ("half_space", ((16, 16, 16), (1, 0, 1)), (CENTRES - 16) @ (1, 0, 1) < 0),
            ("turned_box", ((16, 16, 16), (9, 4, 2), quarter), in_box((12, 7, 14), (20, 25, 18)))):
        with dag.edit() as e:
            getattr(e, "replace_" + shape)(*arguments, color=(4, 5, 6))
            edited = e.dag()
            assert e.undo_count == 1 and e.undo() and e.dag() == dag
        assert np.array_equal(edited.to_dense(), dag.to_dense() | inside), shape
        coords = np.argwhere(edited.to_dense())
        is_inside = inside[tuple(coords.T)]
        assert (edited.colors(coords[is_inside]) == (4, 5, 6)).all()
        kept = coords[~is_inside]
        assert np.array_equal(edited.colors(kept), dag.colors(kept))


def test_filters_copies_stamps_and_voxels():
    dag = scene()
    before = dag.to_dense()
    with dag.edit() as e:
        e.grow((16, 16, 16), 100)
        padded = np.pad(before, 1)
        expected = before.copy()
        for axis in range(3):
            for step in (-1, 1):
                expected |= np.roll(padded, step, axis)[1:-1, 1:-1, 1:-1]
        assert np.array_equal(e.dag().to_dense(), expected)
        e.undo()
        e.smooth((16, 16, 16), 5)
        e.shrink((16, 16, 16), 5)
        e.undo(), e.undo()
        e.copy((0, 0, 0), (8, 9, 10), (20.3, 0, 0))
        expected = before.copy()
        expected[20:28, 0:9, 0:10] |= before[0:8, 0:9, 0:10]
        assert np.array_equal(e.dag().to_dense(), expected)
        e.undo()
        e.move((0, 0, 0), (8, 9, 10), (20, 0, 0))
        expected[0:8, 0:9, 0:10] = False
        assert np.array_equal(e.dag().to_dense(), expected)
    stamp = voxdag.from_coords([[5, 5, 5], [6, 5, 5], [7, 6, 5]], resolution=16)
    for mode, value in (("add", True), ("remove", False)):
        e = dag.edit()
        e.stamp(stamp, at=(1, 2, 3), mode=mode)
        expected = before.copy()
        for x, y in ((1, 2), (2, 2), (3, 3)):
            expected[x, y, 3] = value
        assert np.array_equal(e.dag().to_dense(), expected)
    e = dag.edit()
    e.stamp(stamp, at=(1, 2, 3), mirror="x", turn=("z", 1), mode="replace")
    expected = before.copy()
    expected[1:3, 2:5, 3] = False
    # Mirrored, it has (1,0), (2,0) and (0,1); the turn takes (x,y) to (1-y,x).
    for x, y in ((1, 1), (1, 2), (0, 0)):
        expected[1 + x, 2 + y, 3] = True
    assert np.array_equal(e.dag().to_dense(), expected)
    e = dag.edit()
    e.add_voxels([[0, 0, 0], [31, 31, 31]])
    e.remove_voxels(dag.coords()[:5])
    expected = before.copy()
    expected[0, 0, 0] = expected[31, 31, 31] = True
    expected[tuple(dag.coords()[:5].T)] = False
    assert np.array_equal(e.dag().to_dense(), expected)


def test_snapshots_are_read_while_edits_go_on():
    dag = scene(colors=True)
    view = {"eye": (60, 50, 70), "target": (16, 16, 16), "width": 320, "height": 240, "occlusion": 4}  # voxels, no coarser cells
    e = dag.edit()
    old = e.snapshot()
    shown = old.render(**view)
    e.remove_ball((16, 16, 16), 12)
    e.paint_box((0, 0, 0), (32, 32, 9), color=(255, 0, 0))
    assert np.array_equal(old.render(**view), shown)
    assert np.array_equal(shown, dag.render(**view))
    new, edited = e.snapshot(), e.dag()
    assert np.array_equal(new.render(**view), edited.render(**view))
    origins = np.random.default_rng(1).uniform(0, 32, (500, 3)) + (0, 0, 60)
    a, b = new.cast(origins, [(0.1, 0, -1)]), edited.cast(origins, [(0.1, 0, -1)])
    for key in a:
        np.testing.assert_array_equal(a[key], b[key])
    assert not np.array_equal(old.cast(origins, [(0.1, 0, -1)])["t_hit"], a["t_hit"])

    def look():
        for _ in range(20):
            np.testing.assert_array_equal(new.cast(origins, [(0.1, 0, -1)])["t_hit"], a["t_hit"])

    reader = threading.Thread(target=look)
    reader.start()
    for i in range(200):
        e.add_ball((i % 32, 5, 5), 3)
    reader.join()


def test_a_tiny_dag_grows():
    dag = voxdag.from_coords([[0, 0, 0]], resolution=8)
    e = dag.edit()
    e.add_box((0, 0, 0), (8, 8, 4))
    hits = e.snapshot().cast([(4.5, 4.5, 20)], [(0, 0, -1)])
    assert hits["voxel"].tolist() == [[4, 4, 3]]
    e.remove_half_space((0, 0, 100), (0, 0, 1))
    assert len(e.dag()) == 0
    assert np.isinf(e.snapshot().cast([(4.5, 4.5, 20)], [(0, 0, -1)])["t_hit"]).all()


def test_a_dag_without_voxels_is_edited_and_has_colors():
    dag = scene(colors=True)
    for _ in range(2):
        e = dag.edit()
        e.remove_box((0, 0, 0), (SIDE, SIDE, SIDE))
        dag = e.dag()
        e = dag.edit()
        e.add_ball((16, 16, 16), 5, color=(1, 2, 3))
        edited = e.dag()
        assert np.array_equal(edited.to_dense(), in_ball((16, 16, 16), 5))
        assert (edited.colors(edited.coords()) == (1, 2, 3)).all()
        assert e.snapshot().cast([(16.5, 16.5, 40)], [(0, 0, -1)])["voxel"].tolist() == [[16, 16, 20]]
        assert len(dag) == 0 and e.undo() and e.dag() == dag
        dag = edited
    with pytest.raises(ValueError, match="the DAG has no colours"):
        voxdag.from_coords(np.empty((0, 3), int), resolution=8).edit().add_ball((1, 2, 3), 1, color=(1, 2, 3))


def test_bad_arguments_change_nothing():
    dag = scene()
    e = dag.edit()
    for call, text in (
            (lambda: e.remove_ball((1, 2), 3), r"center must have the shape \(3,\) or \(n, 3\)"),
            (lambda: e.remove_ball((1, 2, 3), ((1, 2),)), r"radius must have the shape a number or"),
            (lambda: e.remove_ball(np.zeros((2, 3)), (1, 2, 3)), "must have as many rows"),
            (lambda: e.remove_ball([(1, 2, 3), (4, 5, 6)], (1, -1)), "radius is negative"),
            (lambda: e.remove_ball((1, 2, float("nan")), 1), "not a number"),
            (lambda: e.paint_ball((1, 2, 3), 1), "needs a colour"),
            (lambda: e.paint_ball((1, 2, 3), 1, color=(1, 2, 3)), "the DAG has no colours"),
            (lambda: e.replace_ball((1, 2, 3), 1), "replace needs a colour"),
            (lambda: e.replace_ball((1, 2, 3), 1, color=(1, 2, 3)), "the DAG has no colours"),
            (lambda: e.add_ball((1, 2, 3), 1, color=np.zeros((2, 3), np.uint8)), "one for each"),
            (lambda: e.add_box((1, 2, 3), (0, 5, 5)), "max is less than its min"),
            (lambda: e.smooth((1, 2, 3), 1e5), "radius"),
            (lambda: e.stamp(dag, mode="join"), "mode must be"),
            (lambda: e.stamp(dag, turn=("w", 1)), "axis must be"),
            (lambda: e.add_voxels([[0, 0, 32]]), "outside of the grid")):
        with pytest.raises(ValueError, match=text):
            call()
    assert e.undo_count == 0 and as_set(e.dag().coords()) == as_set(dag.coords())
