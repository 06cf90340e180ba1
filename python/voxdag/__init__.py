"""Sparse voxel DAGs: build them from meshes, points and arrays, ask them, cast rays at them, show them.

    import voxdag
    dag = voxdag.load("bunny.obj", resolution=1024)
    hits = dag.cast(origins, directions)
    dag.view()

Coordinates are in world units unless a name says voxel; voxel (i, j, k) is the cube from
origin + (i, j, k) * voxel_size. Bad arguments raise ValueError, files that cannot be read or written
OSError, both with the reason in one line.
"""
import base64 as _base64
import builtins as _builtins
import os as _os
import re as _re
import tempfile as _tempfile

import numpy as _numpy

from ._voxdag import Dag, __version__  # noqa: F401
from . import _pages, _voxdag
from ._edit import Edit, edit as _edit
from ._signatures import documented as _documented
from ._voxdag import Snapshot  # noqa: F401

__all__ = ["Dag", "Edit", "Snapshot", "build", "build_mesh", "carve_rays", "from_coords", "from_dense", "from_points",
           "import_file", "load", "open"]


build_mesh, carve_rays, from_coords, from_dense, import_file, open = map(_documented, (  # noqa: A001
    _voxdag.build_mesh, _voxdag.carve_rays, _voxdag.from_coords, _voxdag.from_dense, _voxdag.import_file,
    _voxdag.open))
for _name, _member in list(vars(Dag).items()):
    if callable(_member) and not _name.startswith("_"):
        setattr(Dag, _name, _documented(getattr(Dag, _name)))

#: Files that import_file() reads, and build_mesh() does not.
_IMPORTED = (".xyz", ".txt", ".csv", ".asc", ".pts", ".xyzrgb", ".las", ".pcd", ".npy", ".binvox", ".schem",
             ".schematic", ".litematic", ".nbt", ".bt", ".ot",
             ".nrrd", ".nhdr", ".nii", ".vdb", ".vox")


def load(path, *, resolution=None, **options):
    """Returns the DAG of any file that voxdag reads.

    path: a .vdag file, which it opens, a mesh, which it builds, or points, voxels or a volume, which it
    imports.
    resolution: voxels along the longest side of meshes and points, by default 1024; points that
    voxdag exported, voxels and volumes have a grid in their file.
    options: those of build_mesh() and import_file(), such as pitch, or colors=True for meshes: without
    it, the DAG of a mesh has no colours, as that of `voxdag build` without --color. Points and voxels
    keep theirs.
    """
    name = _os.fspath(path).lower()
    for packed in (".gz", ".zst"):
        name = name.removesuffix(packed)
    if name.endswith(".vdag"):
        return open(path, **options)
    if resolution is not None:
        options["resolution"] = resolution
    is_sized = "resolution" in options or "pitch" in options
    if not name.endswith(_IMPORTED) and not _os.path.isdir(path):
        try:
            return build_mesh(path, **options)
        except OSError as error:
            if not (name.endswith(".ply") and "'face' element" in str(error)):
                raise
    try:
        return import_file(path, **options)
    except (OSError, ValueError) as error:
        if is_sized or "resolution" not in str(error):
            raise
    return import_file(path, resolution=1024, **options)


def _mesh_arrays(mesh):
    """Returns vertices, faces and colours (or None) of a mesh of trimesh or Open3D."""
    faces = getattr(mesh, "faces", None)
    if faces is None:
        faces = getattr(mesh, "triangles", None)
    if not hasattr(mesh, "vertices") or faces is None:
        raise TypeError("build() takes vertices and faces, or an object with .vertices and .faces "
                        "(trimesh) or .triangles (Open3D)")
    colors = None
    if hasattr(mesh, "has_vertex_colors"):  # Open3D: 0 to 1
        if mesh.has_vertex_colors():
            colors = _numpy.asarray(mesh.vertex_colors)
    elif getattr(getattr(mesh, "visual", None), "kind", None) == "vertex":
        colors = _numpy.asarray(mesh.visual.vertex_colors)[:, :3]
    return _numpy.asarray(mesh.vertices), _numpy.asarray(faces), colors


def build(vertices, faces=None, *, resolution=None, pitch=None, bounds=None, solid=None,
          colors=None):
    """Builds the DAG of the voxels that triangles meet.

    vertices: (N, 3) float; faces: (M, 3) indices. Or one mesh of trimesh or Open3D.
    resolution: voxels along the longest side, 1 to 2^20, by default 1024; or pitch: side of a voxel.
    bounds: ((x0, y0, z0), (x1, y1, z1)), the box that the grid holds; default: that of the mesh.
    solid: also set the voxels inside: True or "parity" for closed meshes, "winding" for meshes with
    holes, "flood" for what the voxels enclose.
    colors: (N, 3), sRGB, of the vertices: uint8, uint16, or real numbers from 0 to 1; None: those of the mesh
    object. Voxels inside a solid take the colour of the nearest surface.
    """
    if faces is None:
        vertices, faces, found = _mesh_arrays(vertices)
        if colors is None and not solid:
            colors = found
    return _voxdag.build(vertices, faces, resolution=resolution, pitch=pitch, bounds=bounds,
                         solid=solid, colors=colors)


def from_points(points, *, resolution=None, pitch=None, bounds=None, colors=None, labels=None,
                channels=None):
    """Builds the DAG of the voxels that hold points.

    points: (N, 3) real numbers in world units, or a point cloud of Open3D.
    resolution, pitch, bounds: as for build(). Points outside of bounds are left out.
    colors: (N, 3), sRGB: uint8, uint16, or real numbers from 0 to 1; a voxel has the mean of its
    points, in linear light.
    labels: (N,) whole numbers, which become materials; a voxel has the one that is most frequent in
    it, the smallest of equally frequent ones.
    channels: a dict from names to (N,) numbers, or to pairs of such an array and a bound, the largest
    error of a value; without a bound, values are exact. A voxel has the mean of its points.
    """
    if hasattr(points, "points"):
        cloud, points = points, _numpy.asarray(points.points)
        if colors is None and cloud.has_colors():
            colors = _numpy.asarray(cloud.colors)
    return _voxdag.from_points(points, resolution=resolution, pitch=pitch, bounds=bounds,
                               colors=colors, labels=labels, channels=channels)


_io_open = _builtins.open


def _file_bytes(write, name):
    """Returns the bytes of the file that write(path) writes."""
    with _tempfile.TemporaryDirectory() as folder:
        path = _os.path.join(folder, name)
        write(path)
        with _io_open(path, "rb") as file:
            return file.read()


def _from_bytes(file_bytes):
    """Returns the Dag of the bytes of a .vdag file."""
    with _tempfile.TemporaryDirectory() as folder:
        path = _os.path.join(folder, "dag.vdag")
        with _io_open(path, "wb") as file:
            file.write(file_bytes)
        return open(path)


def _reduce(dag):
    """Pickles a Dag as its .vdag file, with colours, normals, materials and channels."""
    return _from_bytes, (_file_bytes(dag.save, "dag.vdag"),)


def _array(dag, dtype=None, copy=None):
    """numpy.asarray(dag): to_dense() of the whole grid."""
    if copy is False:
        raise ValueError("the array of a Dag is always a copy")
    dense = dag.to_dense()
    return dense if dtype is None else dense.astype(dtype)


def _to_mesh(self, window=None):
    """Returns the outer faces of the voxels as vertices and triangles.

    vertices: (N, 3) float64 in world units; those within a block of 4³ voxels are shared.
    triangles: (M, 3) int64, two for each face, counter-clockwise from outside.
    window: as for coords().
    """
    file = _file_bytes(lambda path: self.export(path, faces=True, colors=False, window=window),
                       "faces.ply")
    head, body = file.split(b"end_header\n", 1)
    head = head.decode()
    vertices, quads = (int(n) for n in _re.findall(r"element \w+ (\d+)", head))
    number = "<f8" if "property double x" in head else "<f4"
    places = _numpy.frombuffer(body, number, 3 * vertices).reshape(-1, 3).astype(float)
    quad = _numpy.dtype([("count", "u1"), ("corners", "<u4", 4)])
    rows = _numpy.frombuffer(body, quad, quads, places.size * _numpy.dtype(number).itemsize)
    corners = rows["corners"].astype(_numpy.int64)
    return places, corners[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def _to_trimesh(self, window=None):
    """Returns to_mesh() as a trimesh.Trimesh.

    window: as for coords().
    """
    import trimesh
    vertices, faces = _to_mesh(self, window)
    return trimesh.Trimesh(vertices, faces)


def _page(dag, title, colors):
    return _file_bytes(lambda path: dag.export(path, title=title, colors=colors), "page.html")


def _show(self, *, title="", colors=True, width="100%", height=540):
    """Returns the viewer's page of the DAG in a frame, which a notebook displays.

    The notebook holds the page, so that it also works after the kernel has ended: some 800 KB, and
    the scene. coarsen() makes large scenes smaller.
    title: of the page. colors: show those of the DAG.
    width, height: of the frame, in pixels, or texts such as "100%".
    """
    return _pages.Frame(_page(self, title, colors).decode(), width, height)


def _view(self, *, title="", colors=True, open_browser=True):
    """Opens the viewer's page of the DAG in the browser, and returns at once.

    Returns an object with url, the address, and close(), which ends the server of the page. The page
    is for browsers of this machine. Without a display, a UserWarning names the address.
    title: of the page. colors: show those of the DAG.
    open_browser: False only serves the page.
    """
    return _pages.View(_page(self, title, colors), open_browser)


def _repr_html(dag):
    """Returns a picture and the counts, some 30 KB."""
    info = dag.info
    picture = _base64.b64encode(dag._jpeg()).decode()
    size = f"{info['voxel_size']:.4g} {info['unit']}".rstrip()
    return (f'<img width="640" height="360" alt="" src="data:image/jpeg;base64,{picture}"><br>'
            f"{info['resolution']:,}³ grid, {info['voxels']:,} voxels of {size}, "
            f"{info['bytes']:,} bytes")


def _repr(dag):
    info = dag.info
    return (f"<voxdag.Dag of {info['resolution']}³: {info['voxels']:,} voxels of side "
            f"{info['voxel_size']:g}, {info['bytes']:,} bytes>")


Dag._repr_html_ = _repr_html
Dag.show = _show
Dag.view = _view
Dag.__array__ = _array
Dag.__reduce__ = _reduce
Dag.shape = property(lambda dag: (dag.resolution,) * 3, doc="The shape of to_dense().")
Dag.edit = _edit
Dag.to_mesh = _to_mesh
Dag.to_trimesh = _to_trimesh
Dag.__repr__ = _repr
for _name in ("show", "to_mesh", "to_trimesh", "view"):
    getattr(Dag, _name).__name__ = _name
Dag.nodes = property(lambda dag: dag._nodes, doc="The nodes, a read-only view: docs/format.md.")
Dag.leaf_blocks = property(lambda dag: dag._leaf_blocks,
                           doc="The masks of 4³ voxels, a read-only view: docs/format.md.")
