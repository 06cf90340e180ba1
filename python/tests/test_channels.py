"""Channels: from arrays and files, through edits and files, and to exports."""
import struct
import warnings

import numpy as np
import pytest
import voxdag

COORDS = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 1, 2]])


def test_channels_of_voxels_come_back_in_their_types():
    kinds = {"u8": np.uint8, "u16": np.uint16, "i16": np.int16, "i32": np.int32, "f32": np.float32}
    given = {name: np.array([7, 0, 99, 3], kind) for name, kind in kinds.items()}
    dag = voxdag.from_coords(COORDS, channels=given)
    assert [row["name"] for row in dag.channels] == list(kinds)
    for name, kind in kinds.items():
        assert dag.channel(name, COORDS).tolist() == [7, 0, 99, 3]
        assert dag.channel(name).dtype == kind
        assert np.array_equal(dag.channel(name), dag.channel(name, dag.coords()))
    assert dag.channels[1] == {"name": "u16", "kind": "u16", "bound": 0.0, "least": 0.0, "greatest": 99.0}
    with pytest.raises(ValueError, match="no channel heat; it has u8, u16, i16, i32, f32"):
        dag.channel("heat")
    with pytest.raises(ValueError, match=r"no voxel is: \(3, 3, 3\)"):
        dag.channel("u8", [[3, 3, 3]])


def test_random_floats_are_exact_or_within_their_bound():
    rng = np.random.default_rng(5)
    coords = np.unique(rng.integers(0, 40, (5000, 3)), axis=0)
    values = rng.normal(0, 100, len(coords)).astype(np.float32)
    dag = voxdag.from_coords(coords, channels={"exact": values, "near": (values, 0.25)})
    assert np.array_equal(dag.channel("exact", coords), values)
    assert np.abs(dag.channel("near", coords).astype(float) - values).max() <= 0.25


def test_a_voxel_has_the_mean_of_its_points():
    points = [[0.1, 0, 0], [0.2, 0, 0], [0.3, 0, 0], [5.1, 0, 0]]
    dag = voxdag.from_points(points, pitch=1.0, channels={"heat": [1.0, 2.0, 6.0, 4.0], "count": [1, 2, 2, 9]})
    assert dag.channel("heat").tolist() == [3.0, 4.0]
    assert dag.channel("count").tolist() == [2, 9]


def test_dense_arrays_hold_channels():
    dense = np.zeros((3, 4, 5), np.float32)
    dense[1, 2, 3], dense[0, 0, 4] = 0.5, 2.25
    dag = voxdag.from_dense(dense > 0, channels={"density": dense})
    assert dag.channel("density", [[1, 2, 3], [0, 0, 4]]).tolist() == [0.5, 2.25]
    with pytest.raises(ValueError, match="shape of the dense array"):
        voxdag.from_dense(dense > 0, channels={"density": [1, 2]})


@pytest.mark.parametrize("channels, reason", [
    ({"a": [1, 2]}, "must have the shape"), ({"a b": [1] * 4}, "cannot have the name 'a b'"),
    ({"a": ([1] * 4, -1)}, "bound of a channel must be positive"), ({"a": [np.nan] * 4}, "channel 'a': has the value nan"),
    ({"a": [2 ** 40] * 4}, "kind i32"), ({str(i): [1] * 4 for i in range(17)}, "17 channels"),
])
def test_bad_channels_are_refused(channels, reason):
    with pytest.raises(ValueError, match=reason):
        voxdag.from_coords(COORDS, channels=channels)


def test_files_and_edits_keep_channels(tmp_path):
    dag = voxdag.from_coords(COORDS, channels={"heat": [1.5, 2.5, 3.5, 4.5]})
    for compact in (False, True):
        dag.save(tmp_path / "a.vdag", compact=compact)
        assert voxdag.open(tmp_path / "a.vdag").channel("heat", COORDS).tolist() == [1.5, 2.5, 3.5, 4.5]
    cropped = dag.crop(((1, 0, 0), (4, 4, 4)))
    assert cropped.channel("heat").tolist() == dag.channel("heat", cropped.coords()).tolist()
    shifted = voxdag.from_coords([[3, 3, 3]], channels={"heat": [9.0], "other": [1]}) | dag
    assert shifted.channel("heat", [[3, 3, 3], [1, 0, 0]]).tolist() == [9.0, 2.5]
    assert shifted.channel("other").tolist() == [1] * 5


@pytest.mark.parametrize("resolution", [16, 4])
def test_coarser_grids_keep_the_means_of_their_cells(resolution):
    rng = np.random.default_rng(9)
    coords = np.unique(rng.integers(0, 64, (4000, 3)), axis=0)
    given = {"heat": rng.normal(0, 50, len(coords)).astype(np.float32), "count": rng.integers(-300, 300, len(coords)).astype(np.int16)}
    colors = rng.integers(0, 256, (len(coords), 3), np.uint8)
    dag = voxdag.from_coords(coords, resolution=64, colors=colors, channels=given)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        coarse = dag.coarsen(resolution)
    assert coarse.info["has_colors"] and [row["name"] for row in coarse.channels] == list(given)
    for name, values in given.items():
        # Level by level: a cell has the mean of its children, each with the weight of its voxels, in the channel's kind.
        places, means, weights = coords, values.astype(float), np.ones(len(coords))
        for _ in range(int(np.log2(64 // resolution))):
            places, of = np.unique(places // 2, axis=0, return_inverse=True)
            of = of.ravel()
            sums, weight = np.zeros(len(places)), np.zeros(len(places))
            np.add.at(sums, of, means * weights)
            np.add.at(weight, of, weights)
            means = sums / weight
            means = np.floor(means + 0.5) if values.dtype == np.int16 else means.astype(np.float32).astype(float)
            weights = weight
        stored = coarse.channel(name, places)
        assert stored.dtype == values.dtype and len(coarse.coords()) == len(places)
        # Sums in another order may round to the next float.
        np.testing.assert_allclose(stored.astype(float), means, rtol=0 if name == "count" else 1e-5, atol=0 if name == "count" else 1e-5)


@pytest.fixture
def metal(tmp_path):
    """Two triangles far from each other: a metal, and a material without these numbers."""
    (tmp_path / "a.mtl").write_text("newmtl metal\nPm 1\nPr 0.2\nKd 1 0.8 0.4\nnewmtl dull\n")
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 4\nv 1 0 4\nv 0 1 4\n"
                                    "usemtl metal\nf 1 2 3\nusemtl dull\nf 4 5 6\n")
    return tmp_path / "a.obj"


@pytest.mark.parametrize("options", [{}, {"colors": True}, {"solid": "flood"}])
def test_meshes_have_the_channels_of_their_materials(metal, options):
    dag = voxdag.build_mesh(metal, resolution=32, channels=["metallic", "roughness"], **options)
    assert dag == voxdag.build_mesh(metal, resolution=32, **options)
    assert [(row["name"], row["kind"]) for row in dag.channels] == [("metallic", "u8"), ("roughness", "u8")]
    assert dag.info["has_colors"] == ("colors" in options)
    is_metal = dag.coords()[:, 2] < 16
    assert np.array_equal(dag.channel("metallic"), np.where(is_metal, 255, 0))
    assert np.array_equal(dag.channel("roughness"), np.where(is_metal, 51, 255))


def test_channels_of_meshes_have_names(metal):
    for names in ("roughness", ["roughness"], ("roughness",)):
        assert [row["name"] for row in voxdag.build_mesh(metal, resolution=8, channels=names).channels] == ["roughness"]
    assert len(voxdag.load(metal, resolution=8, channels="metallic,roughness").channels) == 2
    with pytest.raises(ValueError, match='"gloss" is neither metallic nor roughness'):
        voxdag.build_mesh(metal, resolution=8, channels=["metallic", "gloss"])
    (metal.parent / "a.mtl").write_text("newmtl metal\nnewmtl dull\n")
    with pytest.warns(UserWarning, match="has no metallic and no roughness"):
        voxdag.build_mesh(metal, resolution=8, channels="metallic")


def test_exports_come_back(tmp_path):
    rng = np.random.default_rng(6)
    coords = np.unique(rng.integers(0, 30, (300, 3)), axis=0)
    heat, count = rng.random(len(coords)).astype(np.float32), rng.integers(0, 200, len(coords)).astype(np.uint8)
    dag = voxdag.from_coords(coords, channels={"heat": heat, "x": count})
    for name in ("points.ply", "points.npy"):
        dag.export(tmp_path / name)
    rows = np.load(tmp_path / "points.npy")
    assert np.array_equal(rows["voxel"], dag.coords()) and np.array_equal(rows["heat"], dag.channel("heat"))
    assert rows["x"].dtype == np.uint8
    for file, field in (("points.ply", "channel_x"), ("points.npy", "x")):
        again = voxdag.import_file(tmp_path / file, channels={"heat": "heat", "count": field})
        assert np.array_equal(again.channel("heat"), dag.channel("heat"))
        assert np.array_equal(again.channel("count"), dag.channel("x"))
    with pytest.raises(OSError, match="has no field 'cold'"):
        voxdag.import_file(tmp_path / "points.ply", channels=["cold"])


def test_volumes_keep_their_numbers(tmp_path):
    rng = np.random.default_rng(7)
    volume = rng.normal(0, 1, (7, 9, 5)).astype(np.float32)
    np.save(tmp_path / "v.npy", volume)
    dag = voxdag.import_file(tmp_path / "v.npy", threshold=0.5, channels={"density": "value"})
    assert dag.info["voxels"] == (volume >= 0.5).sum()
    assert np.array_equal(dag.channel("density"), volume[tuple(dag.coords().T)])
    boxes = rng.integers(0, 4000, (6, 7, 8)).astype("<u2")
    header = b"NRRD0004\ntype: uint16\ndimension: 3\nsizes: 6 7 8\nencoding: raw\nendian: little\nspacings: 1 1 2\n\n"
    (tmp_path / "b.nrrd").write_bytes(header + boxes.transpose(2, 1, 0).tobytes())
    with pytest.warns(UserWarning, match="boxes"):
        dag = voxdag.import_file(tmp_path / "b.nrrd", threshold=1000, channels="value")
    x, y, z = dag.coords().T
    assert len(x) == 2 * (boxes >= 1000).sum()
    assert np.array_equal(dag.channel("value"), boxes[x, y, z // 2])
    with pytest.raises(OSError, match="numbers of a volume are called 'value'"):
        voxdag.import_file(tmp_path / "v.npy", channels="density")


def test_rows_and_las_files_have_the_means_of_their_points(tmp_path):
    rng = np.random.default_rng(8)
    places, intensity, kind = rng.integers(0, 8, (900, 3)), rng.integers(0, 65536, 900), rng.integers(0, 31, 900)
    header = bytearray(227)
    header[0:4], header[24], header[25] = b"LASF", 1, 2
    struct.pack_into("<HI", header, 94, 227, 227)
    struct.pack_into("<HI", header, 105, 20, 900)
    struct.pack_into("<3d", header, 131, 1, 1, 1)
    (tmp_path / "p.las").write_bytes(bytes(header) + b"".join(
        struct.pack("<iiiHBBbBH", *map(int, place), int(i), 0, int(k), 0, 0, 0)
        for place, i, k in zip(places, intensity, kind)))
    rows = np.zeros(900, [("x", "<f8"), ("y", "<f8"), ("z", "<f8"), ("heat", "<f4"), ("wide", "<u2")])
    rows["x"], rows["y"], rows["z"] = places.T
    rows["heat"], rows["wide"] = rng.normal(0, 50, 900), intensity
    np.save(tmp_path / "p.npy", rows)
    with open(tmp_path / "p.csv", "w") as csv:
        csv.write("x,y,z,heat,wide\n")
        csv.writelines(f"{x},{y},{z},{float(h)!r},{w}\n" for x, y, z, h, w in rows.tolist())
    in_voxel = {}
    for row, place in enumerate(places):
        in_voxel.setdefault(tuple(place), []).append(row)
    las = voxdag.import_file(tmp_path / "p.las", pitch=1.0, channels=["intensity", "classification"])
    npy = voxdag.import_file(tmp_path / "p.npy", pitch=1.0, channels={"heat": "heat", "near": ("heat", 0.5), "wide": "wide"})
    voxels = las.coords()
    assert len(voxels) == len(in_voxel) and np.array_equal(npy.coords(), voxels)
    whole = lambda values: [int(np.floor(values[in_voxel[tuple(v)]].mean() + 0.5)) for v in voxels]
    assert las.channel("intensity").tolist() == npy.channel("wide").tolist() == whole(intensity)
    assert las.channel("classification").tolist() == whole(kind)
    means = [np.float32(sum(sorted(rows["heat"][in_voxel[tuple(v)]].astype(float))) / len(in_voxel[tuple(v)])) for v in voxels]
    assert npy.channel("heat").tolist() == means
    assert np.abs(npy.channel("near").astype(float) - npy.channel("heat")).max() <= 0.5
    csv = voxdag.import_file(tmp_path / "p.csv", pitch=1.0, channels={"heat": "heat", "wide": "5"})
    assert np.array_equal(csv.coords(), voxels) and csv.channel("heat").tolist() == means
    exact = [np.float32(intensity[in_voxel[tuple(v)]].mean()) for v in voxels]
    assert csv.channel("wide").tolist() == exact
