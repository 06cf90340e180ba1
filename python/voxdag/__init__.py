"""Sparse voxel DAGs: build them from meshes, points and arrays, ask them, cast rays at them.

    import voxdag
    dag = voxdag.build_mesh("bunny.obj", resolution=1024)
    hits = dag.cast(origins, directions)

Coordinates are in world units unless a name says voxel; voxel (i, j, k) is the cube from
origin + (i, j, k) * voxel_size. Bad arguments raise ValueError, files that cannot be read or written
OSError, both with the reason in one line.
"""
import os as _os
import tempfile as _tempfile

import numpy as _numpy

from ._voxdag import Dag, build_mesh, from_coords, from_dense, import_file, open  # noqa: A004
from . import _voxdag

__all__ = ["Dag", "build", "build_mesh", "from_coords", "from_dense", "from_points", "import_file",
           "open"]


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
    resolution: voxels along the longest side, 1 to 2^20; or pitch: side of a voxel.
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


def from_points(points, *, resolution=None, pitch=None, bounds=None, colors=None):
    """Builds the DAG of the voxels that hold points: (N, 3) in world units, or a point cloud of
    Open3D.

    resolution, pitch, bounds: as for build(). Points outside of bounds are left out.
    colors: (N, 3), sRGB: uint8, uint16, or real numbers from 0 to 1; a voxel has the mean of its
    points, in linear light.
    """
    if hasattr(points, "points"):
        cloud, points = points, _numpy.asarray(points.points)
        if colors is None and cloud.has_colors():
            colors = _numpy.asarray(cloud.colors)
    return _voxdag.from_points(points, resolution=resolution, pitch=pitch, bounds=bounds,
                               colors=colors)


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
    """Pickles a Dag as its .vdag file, with colours, normals and materials."""
    return _from_bytes, (_file_bytes(dag.save, "dag.vdag"),)


def _repr(dag):
    info = dag.info
    return (f"<voxdag.Dag of {info['resolution']}³: {info['voxels']:,} voxels of side "
            f"{info['voxel_size']:g}, {info['bytes']:,} bytes>")


import builtins as _builtins  # noqa: E402

_io_open = _builtins.open
Dag._repr_png_ = lambda dag: _file_bytes(dag._write_png, "dag.png")
Dag.__reduce__ = _reduce
Dag.__repr__ = _repr
Dag.nodes = property(lambda dag: dag._nodes, doc="The nodes, a read-only view: docs/format.md.")
Dag.leaf_blocks = property(lambda dag: dag._leaf_blocks,
                           doc="The masks of 4³ voxels, a read-only view: docs/format.md.")
