#!/usr/bin/env python3
"""Measures what solid builds make of damaged meshes.

  open_meshes.py [options] MESH.obj

Writes variants of a closed OBJ mesh: with a hole, with triangles missing at random, and with
triangles turned over at random. Each program fills the whole mesh and all variants, and its own
results are compared: how many voxels of the whole body are missing, and how many are extra. The
variants are the same in each run.

A rival is a shell command that writes a .vox or .binvox file: {mesh}, {resolution} and {out} stand
for the mesh, the voxels per side, and a path without an ending.
"""
import argparse
import json
import random
import shlex
import subprocess
import tempfile
from pathlib import Path

OURS = {"voxdag winding": ["--solid", "winding"], "voxdag parity": ["--solid"],
        "voxdag flood": ["--solid", "flood"]}


class Mesh:
    """The lines of an OBJ file, with its vertices and faces."""

    def __init__(self, path):
        self.other, self.faces, self.vertices = [], [], []
        for line in Path(path).read_text().splitlines():
            words = line.split()
            if words[:1] == ["f"]:
                self.faces.append(words[1:])
                continue
            if words[:1] == ["v"]:
                self.vertices.append([float(w) for w in words[1:4]])
            if words[:1] != ["mtllib"]:
                self.other.append(line)

    def centre(self, face):
        corners = [self.vertices[int(c.split("/")[0]) - 1] for c in face]
        return [sum(axis) / len(corners) for axis in zip(*corners)]

    def write(self, path, faces):
        lines = self.other + ["f " + " ".join(face) for face in faces]
        path.write_text("\n".join(lines) + "\n")


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


def variants(mesh):
    """Returns (name, faces) of the whole mesh and of its variants."""
    low = [min(axis) for axis in zip(*mesh.vertices)]
    high = [max(axis) for axis in zip(*mesh.vertices)]
    diagonal = distance(low, high)
    # Holes are where the mesh is nearest to its middle: they do not change its bounding box.
    inside = [(a + b) / 2 for a, b in zip(low, high)]
    middle = min(mesh.vertices, key=lambda v: distance(v, inside))
    result = [("whole", mesh.faces)]
    for percent in (3, 10):
        radius = percent / 100 * diagonal
        result.append((f"hole of {percent}%", [f for f in mesh.faces
                                               if distance(mesh.centre(f), middle) > radius]))
    rng = random.Random(1)
    result.append(("1% missing", [f for f in mesh.faces if rng.random() >= 0.01]))
    result.append(("1% turned", [f[::-1] if rng.random() < 0.01 else f for f in mesh.faces]))
    return result


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


class Bench:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder

    def build(self, options, mesh, out):
        """Builds with voxdag. Returns why there is no result, or an empty text."""
        done = run([self.arguments.voxdag, "build", mesh, "-r", str(self.arguments.resolution),
                    *options, "-o", out, "-q"])
        return "" if done.returncode == 0 else "refused"

    def rival(self, command, mesh, out):
        for name, value in (("{mesh}", mesh), ("{resolution}", self.arguments.resolution),
                            ("{out}", out.with_suffix(""))):
            command = command.replace(name, shlex.quote(str(value)))
        work = Path(tempfile.mkdtemp(dir=self.folder))
        if run(["/bin/sh", "-c", command], cwd=work).returncode != 0:
            return "failed"
        for ending in (".vox", ".binvox"):
            made = out.with_suffix(ending)
            if made.exists():
                levels = ["-r", "2048"]  # The same grid for all, whatever the models' sizes.
                done = run([self.arguments.voxdag, "import", made, *levels, "--no-color", "-o",
                            out, "-q"])
                made.unlink()
                return "" if done.returncode == 0 else "unread"
        return "no file"

    def difference(self, whole, part):
        """Returns the voxels of `whole`, and how many are missing and extra in `part`."""
        done = run([self.arguments.voxdag, "diff", whole, part, "--json"])
        if done.returncode != 0:
            return {"failure": done.stderr.strip()}
        found = json.loads(done.stdout)
        return {"voxels": found["only_in_first"] + found["in_both"],
                "missing": found["only_in_first"], "extra": found["only_in_second"]}

    def measure(self):
        mesh = Mesh(self.arguments.mesh)
        files = []
        for name, faces in variants(mesh):
            files.append((name, self.folder / f"{len(files)}.obj"))
            mesh.write(files[-1][1], faces)
        programs = {name: lambda mesh, out, o=options: self.build(o, mesh, out)
                    for name, options in OURS.items()}
        for text in self.arguments.rival:
            name, command = text.split("=", 1)
            programs[name] = lambda mesh, out, c=command: self.rival(c, mesh, out)
        rows = []
        for program, make in programs.items():
            whole = self.folder / "whole.vdag"
            for name, file in files:
                out = whole if name == "whole" else self.folder / "variant.vdag"
                failure = make(file, out)
                row = {"program": program, "mesh": name}
                row.update({"failure": failure} if failure else self.difference(whole, out))
                rows.append(row)
                print(table_row(row), flush=True)
        return rows


def table_row(row):
    start = f"{row['program']:<24} {row['mesh']:<12}"
    if "failure" in row:
        return start + " " + row["failure"]
    wrong = row["missing"] + row["extra"]
    return (f"{start} {row['voxels']:>12,} {row['missing']:>10,} {row['extra']:>10,}"
            f" {100 * wrong / max(row['voxels'], 1):>8.3f}%")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", help="a closed mesh, OBJ")
    parser.add_argument("-r", "--resolution", type=int, default=256, help="voxels per side")
    parser.add_argument("--voxdag", default="voxdag", help="the program (default: that in PATH)")
    parser.add_argument("--rival", action="append", default=[], metavar="NAME=COMMAND")
    parser.add_argument("-o", "--output", help="also write the rows as JSON")
    arguments = parser.parse_args()
    print(f"{'program':<24} {'mesh':<12} {'whole':>12} {'missing':>10} {'extra':>10} {'wrong':>9}")
    with tempfile.TemporaryDirectory() as folder:
        rows = Bench(arguments, Path(folder)).measure()
    if arguments.output:
        Path(arguments.output).write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
