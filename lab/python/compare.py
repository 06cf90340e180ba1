#!/usr/bin/env python3
"""Measures voxdag's Python module beside Open3D and OpenVDB's Python module, on one mesh.

  PYTHONPATH=BUILD/python compare.py [-r 256] [--repeat 3] [-o OUT.json] MESH

Each task of each library runs in a process of its own; the fastest of its repetitions counts, and
the peak memory of the process beyond that after reading the mesh. The libraries do not do the same
work: Open3D casts at triangles and decides with rays to triangles what is inside, and OpenVDB makes
a narrow band of distances. The table says what each does.
"""
import argparse
import json
import resource
import subprocess
import sys
import time

RAYS = POINTS = 1_000_000


def read(path):
    import numpy
    import open3d
    mesh = open3d.io.read_triangle_mesh(path)
    return mesh, numpy.asarray(mesh.vertices), numpy.asarray(mesh.triangles)


def rays_of(vertices):
    """Returns rays from a sphere around the mesh to random points in its bounding box."""
    import numpy
    random = numpy.random.default_rng(1)
    lo, hi = vertices.min(0), vertices.max(0)
    directions = random.normal(size=(RAYS, 3))
    directions /= numpy.linalg.norm(directions, axis=1)[:, None]
    origins = (lo + hi) / 2 + numpy.linalg.norm(hi - lo) * directions
    return (origins.astype(numpy.float32),
            (random.uniform(lo, hi, (RAYS, 3)) - origins).astype(numpy.float32))


def points_of(vertices):
    import numpy
    return numpy.random.default_rng(2).uniform(vertices.min(0), vertices.max(0),
                                               (POINTS, 3)).astype(numpy.float32)


def ray_scene(mesh):
    import numpy
    import open3d
    # Debian 12's Open3D hits nothing at all.
    box = open3d.t.geometry.RaycastingScene()
    box.add_triangles(open3d.t.geometry.TriangleMesh.from_legacy(
        open3d.geometry.TriangleMesh.create_box(1, 1, 1)))
    ray = open3d.core.Tensor(numpy.array([[0.5, 0.4, -1, 0, 0, 1]], numpy.float32))
    if not numpy.isfinite(box.cast_rays(ray)["t_hit"].numpy()).all():
        raise SystemExit("its RaycastingScene misses a box")
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(open3d.t.geometry.TriangleMesh.from_legacy(mesh))
    return scene


# Each returns what to measure: a function that returns a count. Preparations are not measured.

def voxdag_voxelize(mesh, vertices, faces, n):
    import voxdag
    return lambda: len(voxdag.build(vertices, faces, resolution=n))


def voxdag_solid(mesh, vertices, faces, n):
    import voxdag
    return lambda: len(voxdag.build(vertices, faces, resolution=n, solid=True))


def voxdag_cast(mesh, vertices, faces, n):
    import numpy
    import voxdag
    dag, rays = voxdag.build(vertices, faces, resolution=n), rays_of(vertices)
    return lambda: int(numpy.isfinite(dag.cast(*rays)["t_hit"]).sum())


def voxdag_contains(mesh, vertices, faces, n):
    import voxdag
    dag, points = voxdag.build(vertices, faces, resolution=n, solid=True), points_of(vertices)
    return lambda: int(dag.contains(points).sum())


def open3d_voxelize(mesh, vertices, faces, n):
    import open3d
    size = (vertices.max(0) - vertices.min(0)).max() / n
    return lambda: len(open3d.geometry.VoxelGrid.create_from_triangle_mesh(mesh, size).get_voxels())


def open3d_cast(mesh, vertices, faces, n):
    import numpy
    import open3d
    scene = ray_scene(mesh)
    rays = open3d.core.Tensor(numpy.concatenate(rays_of(vertices), axis=1))
    return lambda: int(numpy.isfinite(scene.cast_rays(rays)["t_hit"].numpy()).sum())


def open3d_contains(mesh, vertices, faces, n):
    import open3d
    scene, points = ray_scene(mesh), open3d.core.Tensor(points_of(vertices))
    return lambda: int(scene.compute_occupancy(points).numpy().sum())


def openvdb_voxelize(mesh, vertices, faces, n):
    import pyopenvdb
    size = (vertices.max(0) - vertices.min(0)).max() / n
    transform = pyopenvdb.createLinearTransform(voxelSize=size)
    return lambda: pyopenvdb.FloatGrid.createLevelSetFromPolygons(
        vertices, triangles=faces, transform=transform, halfWidth=1).activeVoxelCount()


TASKS = {
    "voxelize": [("voxdag", voxdag_voxelize, "exact cover, a DAG"),
                 ("Open3D", open3d_voxelize, "cubes that triangles meet, a hash table"),
                 ("OpenVDB", openvdb_voxelize, "distances in a band of 1 voxel")],
    "solid": [("voxdag", voxdag_solid, "exact cover and inside, a DAG")],
    "cast": [("voxdag", voxdag_cast, "first voxel"), ("Open3D", open3d_cast, "first triangle")],
    "contains": [("voxdag", voxdag_contains, "in a voxel of the solid"),
                 ("Open3D", open3d_contains, "inside the triangles")],
}


def peak_bytes():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def run_one(arguments):
    task = next(t for t in TASKS[arguments.task] if t[0] == arguments.library)
    mesh, vertices, faces = read(arguments.mesh)
    before = peak_bytes()
    work = task[1](mesh, vertices, faces, arguments.resolution)
    seconds = []
    for _ in range(arguments.repeat):
        begin = time.perf_counter()
        count = work()
        seconds.append(time.perf_counter() - begin)
    print(json.dumps({"seconds": min(seconds), "bytes": peak_bytes() - before, "count": count}))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("-r", "--resolution", type=int, default=256)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=60, help="time limit of each process")
    parser.add_argument("-o", "--output")
    parser.add_argument("--task", help=argparse.SUPPRESS)
    parser.add_argument("--library", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.task:
        return run_one(arguments)
    rows = []
    print(f"{'task':10}{'library':10}{'seconds':>9}{'x voxdag':>10}{'memory':>11}{'count':>12}  what")
    for task, entries in TASKS.items():
        for library, _, what in entries:
            command = [sys.executable, __file__, arguments.mesh, "-r", str(arguments.resolution),
                       "--repeat", str(arguments.repeat), "--task", task, "--library", library]
            row = {"task": task, "library": library, "what": what}
            try:
                result = subprocess.run(command, capture_output=True, text=True,
                                        timeout=arguments.seconds)
                if result.returncode != 0:
                    reason = result.stderr.strip().splitlines()[-1]
                    rows.append(row | {"failed": reason})
                    print(f"{task:10}{library:10}  failed: {reason}")
                    continue
                row |= json.loads(result.stdout)
            except subprocess.TimeoutExpired:
                rows.append(row | {"stopped_after": arguments.seconds})
                print(f"{task:10}{library:10}  stopped after {arguments.seconds:g} s  {what}")
                continue
            rows.append(row)
            ours = next(r for r in rows if r["task"] == task)["seconds"]
            print(f"{task:10}{library:10}{row['seconds']:9.3f}{row['seconds'] / ours:10.1f}"
                  f"{row['bytes'] / 2**20:8.0f} MiB{row['count']:12,}  {what}", flush=True)
    if arguments.output:
        with open(arguments.output, "w") as file:
            json.dump({"mesh": arguments.mesh.split("/")[-1], "resolution": arguments.resolution,
                       "rows": rows}, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    main()
