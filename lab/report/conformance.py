"""`voxdag bench conformance`: voxels, nodes, files and hits of fixed scenes, against the table that is in the repository.
docs/conformance.md describes the table, so that other builders and tracers can be checked against it, too."""

import csv
import hashlib
import io
import json
import os
import struct
import subprocess

import numpy

from cells import write_whole
from child import ScratchFolder
from commands import Parser
from document import Error

TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "conformance.csv")
COLUMNS = ["scene", "grid", "voxels", "nodes", "dag", "compact", "hits"]
# Options of `voxdag scene`; the grids of each.
SCENES = {"sponge": ["--size", "3"], "hairball": ["--size", "20"], "city": ["--size", "1"], "terrain": ["--size", "128"],
          "courtyard": ["--size", "0.25"]}
GRIDS = [64, 256, 1024, 4096]
RAYS = 10000


def chunks_of(data):
    """Returns the chunks of a .vdag file by their ids: see docs/format.md."""
    count = struct.unpack_from("<I", data, 12)[0]
    entries = (struct.unpack_from("<4sIQQ", data, 64 + 32 * i) for i in range(count))
    return {name.decode(): data[begin:begin + length] for name, _, begin, length in entries}


def digest(data):
    return hashlib.sha256(data).hexdigest()


def rays_into(grid):
    """Returns the rays of the table for a grid: RAYS rows of origin, t_min, direction, t_max."""
    with numpy.errstate(over="ignore"):
        # SplitMix64 from 0.
        z = numpy.arange(1, 6 * RAYS + 1, dtype=numpy.uint64) * numpy.uint64(0x9E3779B97F4A7C15)
        z = (z ^ (z >> numpy.uint64(30))) * numpy.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> numpy.uint64(27))) * numpy.uint64(0x94D049BB133111EB)
        z ^= z >> numpy.uint64(31)
    parts = (z >> numpy.uint64(40)).astype(numpy.float64).reshape(RAYS, 6) / 2**24
    low, side = numpy.array(grid["origin"]), grid["voxel_size"] * 2 ** grid["levels"]
    origins = (low + side * (2 * parts[:, :3] - 0.5)).astype(numpy.float32)
    targets = low + side * parts[:, 3:]
    rays = numpy.zeros((RAYS, 8), numpy.float32)
    rays[:, :3] = origins
    rays[:, 4:7] = targets - origins
    rays[:, 7] = numpy.inf
    return rays


def hit_digest(hits):
    """Returns the digest of four int32 for each ray: voxel and face."""
    return digest(numpy.column_stack([hits["voxel"], hits["face"]]).astype("<i4").tobytes())


class Measure:
    """Makes the rows of the table with a program in a scratch folder."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def voxdag(self, *arguments):
        done = subprocess.run([self.program.path, *arguments], cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Error(done.stderr.strip().removeprefix("voxdag: "))
        return done.stdout

    def read(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read()

    def rows(self, scene):
        self.voxdag("scene", scene, *SCENES[scene], "-o", "mesh.ply", "-q")
        for grid in GRIDS:
            self.voxdag("build", "mesh.ply", "-r", str(grid), "-o", "a.vdag", "-q")
            self.voxdag("convert", "a.vdag", "--compact", "-o", "compact.vdag", "-q")
            plain, compact = chunks_of(self.read("a.vdag")), chunks_of(self.read("compact.vdag"))
            head = json.loads(plain["META"])
            numpy.save(os.path.join(self.folder, "rays.npy"), rays_into(head["grid"]))
            self.voxdag("trace", "a.vdag", "--rays", "rays.npy", "-o", "hits.npy", "-q")
            hits = numpy.load(os.path.join(self.folder, "hits.npy"))
            yield {"scene": scene, "grid": str(grid), "voxels": str(head["counts"]["voxels"]),
                   "nodes": " ".join(map(str, head["counts"]["dag_nodes_per_level"])),
                   "dag": digest(plain["NODE"] + plain["LEAF"]),
                   "compact": digest(b"".join(data for name, data in sorted(compact.items()) if name != "META")),
                   "hits": hit_digest(hits)}


def read_table(path):
    """Returns the rows of a CSV file by scene and grid."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError) as error:
        raise Error(f"{path}: {getattr(error, 'strerror', None) or 'is no UTF-8 text'}") from error
    for number, row in enumerate(rows, 2):
        if None in row or not row.get("scene") or not row.get("grid"):
            raise Error(f"{path}: line {number}: a row needs a scene, a grid, and one value for each column")
    return {(row["scene"], row["grid"]): row for row in rows}


def differences(rows, table, source):
    """Yields a line for each value that differs from the table. Columns that the rows lack are not compared."""
    for key, row in rows.items():
        if key not in table:
            yield f"{source}: {key[0]} at {key[1]}³ is not in the table"
            continue
        for column, value in row.items():
            if column in COLUMNS[2:] and value and value != table[key][column]:
                yield f"{source}: {key[0]} at {key[1]}³: {column} is {value}, in the table {table[key][column]}"


def run(arguments, program):
    parser = Parser("conformance", "Check voxels, nodes, files and hits of fixed scenes against the table of docs/conformance.md",
                    "--scene sponge")
    parser.add_argument("--scene", metavar="NAME", choices=list(SCENES), action="append", help="Only this scene; may be repeated")
    parser.add_argument("--check", metavar="FILE.csv", help="Check the rows of this file, which another program has made, "
                        "instead of those of voxdag")
    parser.add_argument("--write", metavar="FILE.csv", help="Write the rows of voxdag to this file instead of checking them")
    options = parser.parse_args(arguments)
    if options.check and (options.write or options.scene):
        parser.error("--check excludes --write and --scene")
    if options.check:
        rows, source = read_table(options.check), options.check
    else:
        with ScratchFolder() as scratch:
            measure = Measure(program, scratch.path)
            made = [row for scene in options.scene or SCENES for row in measure.rows(scene)]
        rows, source = {(row["scene"], row["grid"]): row for row in made}, "voxdag"
    if options.write:
        text = io.StringIO()
        writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows.values())
        return write_whole(options.write, text.getvalue())
    wrong = list(differences(rows, read_table(TABLE), source))
    print("\n".join(wrong) if wrong else f"{source}: all {len(rows)} rows are those of the table")
    if wrong:
        raise Error(f"{len(wrong)} values differ from the table")
    return None
