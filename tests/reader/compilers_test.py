#!/usr/bin/env python3
"""Compiles include/voxdag.h with each compiler of the machine, as C and as C++, with many options.

    compilers_test.py VOXDAG

None may warn. Programs of all of them must give equal answers about a scene: digest.c prints a digest of these. Cross compilers for
other processors, one of which is big-endian, take part if QEMU runs their programs. Without a C library, the header may need memcpy,
fma, sqrtf and memset alone. Options that change results must be refused. The code of docs/reader.md must compile.
Exit status: 0 if all of this holds, 1 if not, 77 without a compiler.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parent
INCLUDE = SOURCE.parents[1] / "include"
STRICT = ["-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-pedantic", "-Werror", f"-I{INCLUDE}"]
SANITIZERS = ["-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
# Of each compiler: a standard, and options to compile with. -march=native may fuse products and sums.
WAYS = ((0, ["-O2"]), (0, ["-Os", "-DVOXDAG_BYTEWISE"]), (1, ["-O3", "-march=native", "-ffp-contract=fast"]), (1, SANITIZERS))
STANDARDS = {
    "gcc": ("c99", "gnu11"), "clang": ("c99", "gnu17"),
    "g++": ("c++11", "c++20"), "clang++": ("c++11", "gnu++20"),
}
# Compilers for other processors, and what runs their programs.
CROSS = {"aarch64-linux-gnu-gcc": "qemu-aarch64", "s390x-linux-gnu-gcc": "qemu-s390x"}
MATERIALS = "newmtl wood\nKd 0.6 0.4 0.2\nnewmtl iron\nKd 0.3 0.3 0.35\nnewmtl glass\nKd 0.9 1 0.9\n"
MESH = """mtllib scene.mtl
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
usemtl wood\nf 1 4 3 2\nf 5 6 7 8\nusemtl iron\nf 1 2 6 5\nf 4 8 7 3\nusemtl glass\nf 1 7 3
"""
PAGE = """
#include <stdlib.h>
{head}
int fail(const char* error, uint64_t at);
void place_marker(const int32_t voxel[3], int face, float t);
int use(void* bytes, size_t size);
int use(void* bytes, size_t size) {{
{body}  return 0;
}}
"""
FREESTANDING = """
#include <stddef.h>
void* own_copy(void* to, const void* from, size_t bytes);
double own_fma(double a, double b, double c);
float own_root(float x);
#define VOXDAG_MEMCPY own_copy
#define VOXDAG_FMA own_fma
#define VOXDAG_SQRTF own_root
#define VOXDAG_IMPLEMENTATION
#include "voxdag.h"
"""


def run(*command, check=True):
    """Returns what the command prints. Its failure ends the test, unless `check` is false."""
    process = subprocess.run([str(word) for word in command], text=True, check=False, capture_output=True)
    if check and process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nended with {process.returncode}:\n{process.stdout}{process.stderr}")
    return process.stdout + process.stderr


def language(compiler):
    return ["-x", "c++" if "++" in compiler else "c"]


def make_scene(voxdag, folder):
    """Returns a file with colours, normals and materials."""
    (folder / "scene.obj").write_text(MESH, encoding="utf-8")
    (folder / "scene.mtl").write_text(MATERIALS, encoding="utf-8")
    run(voxdag, "build", folder / "scene.obj", "-r", "100", "--color", "--normal", "--material-ids", "-o", folder / "scene.vdag")
    return folder / "scene.vdag"


def check_answers(compilers, scene, folder):
    """Checks that digest.c prints one line, however it is compiled."""
    digests = {}

    def compile_and_run(runner, *command):
        run(*command, *STRICT, *language(command[0]), SOURCE / "digest.c", "-o", folder / "digest", "-lm")
        digests.setdefault(run(*runner, folder / "digest", scene), " ".join(command))

    for compiler in compilers:
        for standard, options in WAYS:
            compile_and_run([], compiler, f"-std={STANDARDS[compiler][standard]}", *options)
    for compiler, name in CROSS.items():
        runner = shutil.which(name) or shutil.which(name + "-static")
        if runner and shutil.which(compiler):
            compile_and_run([runner], compiler, "-std=gnu99", "-O3", "-static")
            print(f"{compiler}, ", end="")
    if len(digests) != 1:
        sys.exit("\n".join(f"{command}\n  {digest}" for digest, command in digests.items()))
    print(f"{', '.join(compilers)}: {next(iter(digests))}", end="")


def check_freestanding(compiler, folder):
    """Checks which functions the header needs without a C library."""
    source = folder / "freestanding.c"
    source.write_text(FREESTANDING, encoding="utf-8")
    run(compiler, "-O2", "-ffreestanding", "-nostdlib", *STRICT, *language(compiler), "-c", source, "-o", folder / "free.o")
    needed = {line.split()[-1] for line in run("nm", "-u", folder / "free.o").splitlines()}
    own = {"own_copy", "own_fma", "own_root"}
    surplus = {name for name in needed if not any(text in name for text in own)} - {"memset", "memcpy", "_GLOBAL_OFFSET_TABLE_"}
    if surplus:
        sys.exit(f"{compiler}: a freestanding header needs {', '.join(sorted(surplus))}")


def check_page(compiler, folder):
    """Checks that the C code of docs/reader.md compiles."""
    page = (SOURCE.parents[1] / "docs/reader.md").read_text(encoding="utf-8")
    head, body = re.search(r"^```c\n(.*?\n)\n(.*?)^```$", page, re.MULTILINE | re.DOTALL).groups()
    (folder / "page.c").write_text(PAGE.format(head=head, body=body), encoding="utf-8")
    run(compiler, "-fsyntax-only", *STRICT, *language(compiler), folder / "page.c")


def check_refusals(compiler):
    """Checks that options that change results are refused with a message."""
    for options, text in ((["-ffast-math"], "fast mathematics"), (["-m32", "-mfpmath=387", "-mno-sse"], "-msse2 -mfpmath=sse")):
        output = run(compiler, "-ffreestanding", "-fsyntax-only", *options, "-DVOXDAG_IMPLEMENTATION", "-DVOXDAG_MEMCPY=a",
                     "-DVOXDAG_FMA=a", "-DVOXDAG_SQRTF=a", *language(compiler), INCLUDE / "voxdag.h", check=False)
        if text not in output and "unrecognized" not in output:
            sys.exit(f"{compiler} {' '.join(options)} does not end with a message about {text}:\n{output}")


def main():
    compilers = [compiler for compiler in STANDARDS if shutil.which(compiler)]
    if not compilers:
        print("skipped: there is no compiler")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_answers(compilers, make_scene(sys.argv[1], folder), folder)
        for compiler in compilers:
            check_freestanding(compiler, folder)
            check_refusals(compiler)
        check_page(compilers[0], folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
