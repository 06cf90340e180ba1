"""Labels: from arrays and files, their lists, and the voxels of some of them."""
import numpy as np
import pytest
import voxdag

COORDS = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 1, 2]])


def test_labels_of_voxels_come_back():
    dag = voxdag.from_coords(COORDS, labels=[5, 5, -1, 2 ** 40])
    assert dag.labels(COORDS).tolist() == [5, 5, -1, 2 ** 40]
    assert dag.labels([[3, 3, 3]]).tolist() == [-1]
    rows = dag.materials()
    assert [row["label"] for row in rows] == [-1, 5, 2 ** 40]
    assert [row["voxels"] for row in rows] == [1, 2, 1]
    assert rows[1]["window"] == ((0, 0, 0), (2, 1, 1))
    assert rows[1]["name"] == "5" and rows[1]["id"] == 1


def test_voxels_of_some_labels_stay():
    dag = voxdag.from_coords(COORDS, labels=[5, 5, 6, 7], colors=[[9, 8, 7]] * 4)
    kept = dag.keep_materials([5, "7"])
    assert kept.coords().tolist() == [[0, 0, 0], [1, 0, 0], [3, 1, 2]]
    assert kept.labels(kept.coords()).tolist() == [5, 5, 7]
    assert np.array_equal(kept.colors(kept.coords()), dag.colors(kept.coords()))
    assert dag.keep_materials(drop=[5, 7]).coords().tolist() == [[2, 0, 0]]
    with pytest.raises(ValueError, match="no material 8"):
        dag.keep_materials([8])
    with pytest.raises(ValueError, match="one of keep and drop"):
        dag.keep_materials()


def test_points_have_the_most_frequent_label():
    points = [[0.1, 0, 0], [0.2, 0, 0], [0.3, 0, 0], [5.1, 0, 0], [5.2, 0, 0]]
    dag = voxdag.from_points(points, pitch=1.0, labels=[3, 9, 9, 4, 2])
    assert sorted(dag.labels(dag.coords()).tolist()) == [2, 9]


def test_dense_arrays_hold_labels():
    dense = np.zeros((3, 4, 5), np.int16)
    dense[1, 2, 3], dense[0, 0, 4] = 300, -7
    dag = voxdag.from_dense(dense, labels=True)
    assert dag.labels([[1, 2, 3], [0, 0, 4]]).tolist() == [300, -7]
    assert voxdag.from_dense(dense.astype(bool), labels=True).labels([[1, 2, 3]]).tolist() == [1]
    with pytest.raises(ValueError, match="no materials"):
        voxdag.from_dense(dense).materials()
    with pytest.raises(ValueError, match="has the label 18446744073709551616"):
        voxdag.from_dense(np.full((1, 1, 1), 2 ** 64 - 1, np.uint64), labels=True)


def test_files_have_labels(tmp_path):
    (tmp_path / "p.csv").write_text("x,y,z,class,room\n0,0,0,2,11\n1,0,0,6,12\n2,0,0,7,12\n", encoding="utf-8")
    load = lambda **options: voxdag.import_file(tmp_path / "p.csv", pitch=1.0, **options)
    labels = lambda dag: dag.labels(dag.coords()).tolist()
    assert labels(load(labels=True)) == [2, 6, 7]
    assert labels(load(labels="room")) == [11, 12, 12]
    assert labels(load(keep=[2, "7"])) == [2, 7]
    assert labels(load(drop=[7])) == [2, 6]
    with pytest.raises(Exception, match="has no field 'floor'"):
        load(labels="floor")
    with pytest.raises(TypeError, match="labels must be"):
        load(labels=3)


@pytest.mark.parametrize("make, message", [
    (lambda: voxdag.from_coords(COORDS, labels=[1, 2]), "labels must have a value for each point"),
    (lambda: voxdag.from_coords(COORDS, labels=[1, 2, 3, 0.5]), "labels has 0.5"),
    (lambda: voxdag.from_coords(COORDS, labels=[[1, 2, 3, 4]]), r"labels must have the shape \(N,\)"),
    (lambda: voxdag.from_coords(COORDS, labels=[1, 2, 3, 2 ** 60]), "labels has 1152921504606846976"),
])
def test_labels_that_are_none_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
