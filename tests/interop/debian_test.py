"""Opens exported meshes and points with Open3D, slices with Pillow, grids with OpenVDB's and NanoVDB's
own tools, and compares what they find with voxdag's counts.

  VOXDAG=program python3 debian_test.py

Ends with status 77 if one of them is not installed.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import matplotlib.image
    import numpy
    import open3d
    import pyopenvdb
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)
if not shutil.which("nanovdb_validate") or not shutil.which("vdb_print"):
    print("skipped: no nanovdb_validate, or no vdb_print")
    sys.exit(77)

PROGRAM = os.environ["VOXDAG"]


def voxdag(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True,
                          text=True).stdout


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name)
        mesh = open3d.geometry.TriangleMesh.create_torus(2, 0.7)
        places = numpy.asarray(mesh.vertices)
        mesh.vertex_colors = open3d.utility.Vector3dVector(places / 6 + 0.5)
        open3d.io.write_triangle_mesh(str(cls.path / "mesh.ply"), mesh)
        cls.dag = cls.path / "scene.vdag"
        voxdag("build", cls.path / "mesh.ply", "-r", 64, "--color", "-o", cls.dag, "-q")
        cls.surface = json.loads(voxdag("query", cls.dag, "--area", "--json"))
        voxdag("export", cls.dag, "-o", cls.path / "points.ply", "-q")
        cls.points = open3d.io.read_point_cloud(str(cls.path / "points.ply"))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def mesh(self, name, *options):
        voxdag("export", self.dag, "-o", self.path / name, "-q", *options)
        return open3d.io.read_triangle_mesh(str(self.path / name))

    def expect_surface(self, mesh):
        """Expects the area of the outer faces, at the place of the points."""
        self.assertAlmostEqual(mesh.get_surface_area() / self.surface["area"], 1, places=5)
        half = (self.surface["volume"] / self.surface["voxels"]) ** (1 / 3) / 2
        for corner, point in ((mesh.get_min_bound(), self.points.get_min_bound() - half),
                              (mesh.get_max_bound(), self.points.get_max_bound() + half)):
            numpy.testing.assert_allclose(corner, point, atol=half / 8)

    def expect_colors(self, colors):
        """Expects the colours of the points, all sRGB encoded."""
        def codes(values):
            return {tuple(c) for c in numpy.rint(numpy.asarray(values) * 255).astype(int)}
        found = codes(colors)
        self.assertGreater(len(found), 100)
        self.assertTrue(found <= codes(self.points.colors))

    def test_points(self):
        self.assertEqual(len(self.points.points), self.surface["voxels"])
        self.assertTrue(self.points.has_colors())

    def test_glb(self):
        mesh = self.mesh("a.glb")
        self.expect_surface(mesh)

        linear = numpy.asarray(mesh.vertex_colors)
        self.expect_colors(numpy.where(linear <= 0.0031308, 12.92 * linear,
                                       1.055 * linear ** (1 / 2.4) - 0.055))

    def test_obj(self):
        mesh = self.mesh("a.obj")
        self.expect_surface(mesh)
        self.expect_colors(mesh.vertex_colors)

    def test_faces_are_merged(self):
        grey = self.mesh("grey.glb", "--grey", "--merge")
        self.expect_surface(grey)
        self.assertLess(len(grey.triangles), 2 * 0.8 * sum(self.surface["faces"]))

    def test_stl(self):
        mesh = self.mesh("a.stl", "--watertight")
        self.expect_surface(mesh)
        # The volume that the triangles enclose, from their tetrahedra with the origin.
        corners = numpy.asarray(mesh.vertices)[numpy.asarray(mesh.triangles)]
        corners = corners - corners.mean(axis=(0, 1))
        volume = numpy.linalg.det(corners).sum() / 6
        self.assertAlmostEqual(volume / self.surface["volume"], 1, places=4)


    def test_slices(self):
        for options, is_set in (((), lambda pixel: pixel[..., 3] > 0),
                                (("--grey",), lambda pixel: pixel > 0)):
            folder = self.path / f"slices{len(options)}"
            voxdag("export", self.dag, "-o", folder, "--slices", "z", *options)
            slices = [matplotlib.image.imread(file) for file in sorted(folder.glob("*.png"))]
            voxdag("export", self.dag, "-o", self.path / "dense.npy", "--window",
                   "0,0,0,64,64,64")
            dense = numpy.load(self.path / "dense.npy")
            numpy.testing.assert_array_equal(is_set(numpy.stack(slices)), dense.T != 0)

    def test_open_vdb(self):
        voxdag("export", self.dag, "-o", self.path / "a.vdb", "-q")
        density, color = pyopenvdb.readAll(str(self.path / "a.vdb"))[0]
        self.assertEqual((density.name, color.name), ("density", "Cd"))
        points = numpy.asarray(self.points.points)
        places = sorted(tuple(density.transform.indexToWorld(item.min))
                        for item in density.citerOnValues())
        numpy.testing.assert_allclose(places, sorted(map(tuple, points)), atol=1e-4)
        self.assertEqual(color.activeVoxelCount(), len(points))
        printed = subprocess.run(["vdb_print", self.path / "a.vdb"], check=True,
                                 capture_output=True, text=True).stdout
        self.assertIn("density", printed)

    def test_vox(self):
        """Goxel puts the models of a scene together."""
        if not shutil.which("goxel") or not shutil.which("xvfb-run"):
            self.skipTest("no goxel, or no xvfb-run")
        large = self.path / "large.vdag"
        voxdag("build", self.path / "mesh.ply", "-r", 512, "--color", "-o", large, "-q")
        voxdag("export", large, "-o", self.path / "a.vox", "-q")
        voxdag("export", large, "-o", self.path / "a.npy", "-q", "--grey")
        subprocess.run(["xvfb-run", "-a", "goxel", self.path / "a.vox", "-e",
                        self.path / "goxel.txt"], check=True, capture_output=True)
        found = numpy.loadtxt(self.path / "goxel.txt", usecols=(0, 1, 2), dtype=int)
        expected = numpy.load(self.path / "a.npy") - numpy.array([256, 256, 0])
        self.assertEqual(set(map(tuple, found)), set(map(tuple, expected)))

    def test_nano_vdb(self):
        voxdag("export", self.dag, "-o", self.path / "a.nvdb", "-q")
        subprocess.run(["nanovdb_validate", self.path / "a.nvdb"], check=True, capture_output=True)
        subprocess.run(["nanovdb_convert", "-f", self.path / "a.nvdb", self.path / "back.vdb"],
                       check=True, capture_output=True)
        density = pyopenvdb.read(str(self.path / "back.vdb"), "density")
        self.assertEqual(density.activeVoxelCount(), self.surface["voxels"])


if __name__ == "__main__":
    unittest.main()
