#!/usr/bin/env python3
"""Checks that two programs write the same bytes: the command lines of two processors, compilers or systems.

    same_bytes.py "PROGRAM" "PROGRAM" [--list]

PROGRAM is a command, such as "qemu-aarch64-static -L build/arm64-system build/arm64/apps/voxdag/voxdag". Both run the commands
below in folders of their own, each file that they write must have one SHA-256, and what they print must be equal. --list prints
the sums. The meshes, DAGs, compact files, ESVOs, values, hits, answers, edits, exports and pictures are small, so that an emulator
takes minutes. Exit status: 0 if all bytes are equal, 1 if not, or if a command fails.
"""

import hashlib
import math
import pathlib
import random
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile

# A cube with a texture, a vertex colour and two materials; the pillar in it has none of them.
OBJ = """mtllib cube.mtl
v -1 -1 -1 0.9 0.2 0.1\nv 1 -1 -1 0.1 0.8 0.3\nv 1 1 -1 0.2 0.3 0.7\nv -1 1 -1 1 1 0\nv -1 -1 1 0 1 1\nv 1 -1 1 1 0 1\nv 1 1 1 0.5 0.5 0.5
v -1 1 1 0.1 0.2 0.3\nv 0.313 0.271 0.919\nv -0.771 0.133 -0.317\nv 0.191 -0.853 0.277
vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1
usemtl picture\nf 1/1 4/2 3/3 2/4\nf 5/1 6/2 7/3 8/4\nusemtl iron\nf 1 2 6 5\nf 4 8 7 3\nf 2 3 7 6\nusemtl glow\nf 9 10 11\nf 1 5 8 4
"""
MTL = """newmtl picture\nmap_Kd cube.png\nnewmtl iron\nKd 0.3 0.3 0.35\nKs 0.5 0.5 0.5\nNs 40\nnewmtl glow\nKd 0.9 0.7 0.1\nKe 0.5 0.4 0
"""
EDITS = """add,ball,0.2,0.3,0.1,0.55,#804020
remove,capsule,-1,-1,-1,0.9,0.8,0.7,0.18
paint,box,-1,-1,-1,0.3,0.4,1,#2060c0
add,turnedbox,0.5,-0.4,0.2,0.3,0.1,0.2,0.1,0.2,0.3,0.927
smooth,ball,0.2,0.3,0.1,0.6
copy,-0.5,-0.5,-0.5,0.25,0.25,0.25,-0.75,-0.25,-0.5
undo
grow,ball,-0.4,-0.4,0.3,0.3
"""
COMMANDS = """
scene courtyard --size 0.12 -o yard.ply
scene sponge --size 2 -o sponge.ply
scene terrain --size 40 -o terrain.ply
render sponge.ply -r 64 --size 64x64 --samples 1 --ao 4 -o cube.png
build yard.ply -r 700 -o yard.vdag
build yard.ply -r 300 --method sort --bounds -3,-1,-3,4,3,5 -o part.vdag
build yard.ply -r 300 --rotate y:33,x:12 --scale 1.7 -o turned.vdag
build yard.ply -r 16 --solid winding -o body.vdag
build sponge.ply -r 200 --solid -o sponge.vdag
build cube.obj -r 200 --color --normal --material-ids -o cube.vdag
build cube.obj -r 128 --color --color-bound 0 --normal --normal-bound 1 --alpha keep -o exact.vdag
build terrain.ply -r 256 --normal -o terrain.vdag
build cube.obj -r 128 -o cube.esvo
build yard.ply -r 200 --max-error 0.3 --normal-error 8 -o yard.esvo
build cube.obj -r 64 --displace stone:0.08:0.7 -o stone.esvo
build cube.obj -r 64 --bake-ao 16 -o shaded.esvo
import points.npy -r 300 -o points.vdag
convert yard.vdag --compact -o small.vdag
convert cube.vdag --compact --wire -o wire.vdag
convert cube.vdag --levels 6 --color-bound 0.04 --normal-bound 6 -o coarse.vdag
edit cube.vdag --script edits.csv -o edited.vdag
combine cube.vdag edited.vdag --xor -o xor.vdag
dilate sponge.vdag --steps 2 -o grown.vdag
hollow sponge.vdag --wall 0.02 -o hollow.vdag
rotate edited.vdag --axis z --turns 1 -o quarter.vdag
coarsen yard.vdag --by 2 -o quarter_yard.vdag
trace yard.vdag --rays rays.npy -o hits.npy
trace small.vdag --in-place --rays rays.npy -o hits_in_place.npy
trace cube.vdag --rays rays.npy -o hits_cube.npy
trace yard.esvo --rays rays.npy -o hits_esvo.npy
trace cube.esvo --rays rays.npy -o hits_cube_esvo.npy
query cube.vdag --points points.npy -o nearest.npy
query cube.vdag --segments segments.npy -o sight.npy
query sponge.vdag --distances --signed --window 0,0,0,64,64,64 -o distances.npy
query sponge.vdag --thickness --window 0,0,0,48,48,48 -o thickness.npy
query yard.vdag --heights y -o heights.npy
query cube.vdag --area
export edited.vdag -o edited.glb
export edited.vdag -o edited.vox
export edited.vdag -o edited.schem
export cube.vdag -o cube_out.obj --texture
coarsen sponge.vdag --by 2 -o little.vdag
export little.vdag -o little.stl --smooth
export little.vdag -o little.3mf --smooth
export cube.vdag -o cube.html
render yard.vdag --size 96x64 -o yard.png --pass normal=normal.exr --pass depth=depth.exr --ao 8
render cube.vdag --size 64x64 --bounces 2 --ao 8 --environment sunset -o paths.exr
render cube.esvo --size 64x64 --ao 8 --light sphere:0,3,0,0.3 --specular 0.4:30 --tone filmic -o esvo.png
render yard.vdag --mesh yard.ply --size 64x48 --ao 8 -o triangles.png
verify yard.vdag --mesh yard.ply
verify cube.vdag
info edited.vdag --json
"""


def npy(shape, values, letter):
    """Returns an array of little-endian floats as the bytes of a .npy file."""
    head = f"{{'descr': '<{letter}', 'fortran_order': False, 'shape': {shape}, }}"
    head += " " * (-(len(head) + 11) % 64) + "\n"
    kind = {"f4": "f", "f8": "d"}[letter]
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head.encode() + struct.pack(f"<{len(values)}{kind}", *values)


def write_inputs(folder):
    """Writes what the commands read beside their own files."""
    numbers = random.Random(7)
    point = lambda reach: [numbers.uniform(-reach, reach) for _ in range(3)]
    rays = [value for _ in range(3000) for value in (*point(5), 0, *point(1), math.inf)]
    for i in range(1000):  # along axes and in their planes, from corners of voxels
        direction = [0.0 if (i >> axis & 1) or i % 3 == axis else numbers.uniform(-1, 1) for axis in range(3)]
        rays += (*(round(x * 8) / 8 for x in point(2)), 0, *(direction if any(direction) else (1, 0, -0.0)), math.inf)
    points = [value for _ in range(3000) for value in point(1.4)]
    for name, text in (("cube.obj", OBJ), ("cube.mtl", MTL), ("edits.csv", EDITS)):
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "rays.npy").write_bytes(npy((4000, 8), rays, "f4"))
    (folder / "points.npy").write_bytes(npy((3000, 3), points, "f8"))
    (folder / "segments.npy").write_bytes(npy((1500, 6), points, "f8"))


def sums(program, folder):
    """Runs all commands, and returns the SHA-256 of each file and of what each command printed, and the commands."""
    write_inputs(folder)
    found, makers = {}, {}
    for command in COMMANDS.strip().splitlines():
        quiet = [] if command.split()[0] in ("info", "verify") or "--area" in command else ["-q"]
        process = subprocess.run([*program, *command.split(), *quiet], cwd=folder, check=False, capture_output=True)
        if process.returncode != 0:
            sys.exit(f"{shlex.join(program)} {command}\nended with {process.returncode}: {process.stderr.decode(errors='replace')}")
        if quiet == []:
            found[f"output of {command.split()[0]} {command.split()[1]}"] = hashlib.sha256(process.stdout).hexdigest()
        for file in sorted(folder.rglob("*")):
            name = str(file.relative_to(folder))
            if file.is_file() and name not in found:
                found[name] = hashlib.sha256(file.read_bytes()).hexdigest()
                makers[name] = command
    return found, makers


def main():
    programs = [shlex.split(word) for word in sys.argv[1:] if word != "--list"]
    if len(programs) != 2:
        sys.exit(__doc__)
    results = []
    for program in programs:
        words = [str(pathlib.Path(word).resolve()) if pathlib.Path(word).exists() else shutil.which(word) or word for word in program]
        with tempfile.TemporaryDirectory() as folder:
            results.append(sums(words, pathlib.Path(folder)))
    (first, makers), (second, _) = results
    different = [name for name in first if second.get(name) != first[name]]
    for name, digest in first.items():
        if "--list" in sys.argv or name in different:
            print(digest[:16], second.get(name, "missing")[:16], name, f"({makers.get(name, 'printed')})")
    print(f"{len(first)} files and outputs, {len(different)} different")
    sys.exit(1 if different or len(first) != len(second) else 0)


if __name__ == "__main__":
    main()
